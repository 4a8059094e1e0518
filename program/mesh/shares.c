/* A surface of all pieces, dealt out: each rank gets the faces of a range of numbers, and of their nodes those that no face before
 * has. Nodes are numbered as they are met in the order of the faces, as on one rank. */
#include "mesh/mesh.h"

/* Faces, each as its number, how many vertices it has, and these: in the order of the former. */
static PetscErrorCode sort_faces(PetscInt n, const PetscInt packed[], Surface *share)
{
  PetscInt n_faces = 0, n_vertices = 0, *number, *start;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; k += 2 + packed[k + 1])
    n_faces++, n_vertices += packed[k + 1];
  PetscCall(PetscMalloc2(n_faces + 1, &share->offsets, n_vertices, &share->vertices));
  PetscCall(PetscMalloc2(n_faces, &number, n_faces, &start));
  for (PetscInt k = 0, f = 0; k < n; k += 2 + packed[k + 1], f++) {
    number[f] = packed[k];
    start[f]  = k;
  }
  PetscCall(PetscSortIntWithArray(n_faces, number, start));
  share->offsets[0] = 0;
  for (PetscInt f = 0; f < n_faces; f++)
    surface_push(share, packed[start[f] + 1], packed + start[f] + 2);
  PetscCall(PetscFree2(number, start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt number_of(const Surface *surface, PetscInt f)
{
  return surface->numbers ? surface->numbers[f] : f;
}

/* the rank that gets a face, of numbers from 0 to n */
static PetscMPIInt rank_of(const Mesh *mesh, PetscInt n, PetscInt number)
{
  return (PetscMPIInt)((PetscInt64)number * mesh->size / n);
}

/* The faces of the piece to the ranks that get them. */
static PetscErrorCode deal_faces(const Mesh *mesh, const Surface *surface, Surface *share)
{
  PetscInt     n = 0, n_received, *packed, *at, *received;
  PetscMPIInt *counts;
  PetscFunctionBegin;
  for (PetscInt f = 0; f < surface->n_faces; f++)
    n = PetscMax(n, number_of(surface, f) + 1);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(PetscCalloc2(mesh->size, &counts, mesh->size + 1, &at));
  PetscCall(PetscMalloc1(2 * surface->n_faces + surface->offsets[surface->n_faces], &packed));
  for (PetscInt f = 0; f < surface->n_faces; f++)
    counts[rank_of(mesh, n, number_of(surface, f))] += (PetscMPIInt)(2 + surface->offsets[f + 1] - surface->offsets[f]);
  for (PetscMPIInt r = 0; r < mesh->size; r++)
    at[r + 1] = at[r] + counts[r];
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    PetscInt *to = &at[rank_of(mesh, n, number_of(surface, f))];
    packed[(*to)++] = number_of(surface, f);
    packed[(*to)++] = surface->offsets[f + 1] - surface->offsets[f];
    for (PetscInt k = surface->offsets[f]; k < surface->offsets[f + 1]; k++)
      packed[(*to)++] = mesh->numbers[surface->vertices[k]];
  }
  PetscCall(numbers_deal(mesh, counts, packed, &n_received, &received));
  PetscCall(sort_faces(n_received, received, share));
  PetscCall(PetscFree2(counts, at));
  PetscCall(PetscFree(packed));
  PetscCall(PetscFree(received));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sum of the ranks before */
static PetscErrorCode sum_before(PetscInt n, PetscInt *before)
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Scan(&n, before, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  *before -= n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* through a directory, so that all corners of a vertex have the least, or the largest, of theirs */
static PetscErrorCode unite(PetscSF directory, PetscInt n_here, PetscInt values[], MPI_Op operation, PetscInt start)
{
  PetscInt *kept;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n_here, &kept));
  for (PetscInt k = 0; k < n_here; k++)
    kept[k] = start;
  PetscCall(PetscSFReduceBegin(directory, MPIU_INT, values, kept, operation));
  PetscCall(PetscSFReduceEnd(directory, MPIU_INT, values, kept, operation));
  PetscCall(PetscSFBcastBegin(directory, MPIU_INT, kept, values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(directory, MPIU_INT, kept, values, MPI_REPLACE));
  PetscCall(PetscFree(kept));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the corners of all faces, one after the other, the first of each vertex makes a node, of each copy of a vertex where there are
 * `copies` (one number a corner, the first one 0). `vertices`: of the corners; their nodes' numbers take the place of share->vertices. */
PetscErrorCode surface_split(const Mesh *mesh, const PetscInt vertices[], const PetscInt copies[], Surface *share, PetscInt *n_nodes,
                             PetscInt **nodes, PetscInt **node_copies)
{
  const PetscInt n = share->offsets[share->n_faces];
  PetscInt       n_here, before, first, most = 0, *values, *some, *asked;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < n && copies; k++)
    most = PetscMax(most, copies[k]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(PetscMalloc3(n, &values, n, &some, n, &asked));
  PetscCall(PetscMalloc1(n, nodes));
  if (node_copies) PetscCall(PetscMalloc1(n, node_copies));
  PetscCall(sum_before(n, &before));
  for (PetscInt k = 0; k < n; k++)
    values[k] = before + k;
  *n_nodes = 0;
  for (int turn = 0; turn < 2; turn++) {
    for (PetscInt copy = 0; copy <= most; copy++) {
      PetscInt m = 0;
      PetscSF  directory;
      for (PetscInt k = 0; k < n; k++) {
        if ((copies ? copies[k] : 0) != copy) continue;
        asked[m]  = vertices[k];
        some[m++] = values[k];
      }
      PetscCall(directory_create(mesh, m, asked, &n_here, &directory));
      PetscCall(unite(directory, n_here, some, turn ? MPI_MAX : MPI_MIN, turn ? -1 : PETSC_MAX_INT));
      PetscCall(PetscSFDestroy(&directory));
      for (PetscInt k = n; k-- > 0;) {
        if ((copies ? copies[k] : 0) == copy) values[k] = some[--m];
      }
    }
    if (turn) break;
    for (PetscInt k = 0; k < n; k++) {
      if (values[k] != before + k) continue;
      if (node_copies) (*node_copies)[*n_nodes] = copies ? copies[k] : 0;
      (*nodes)[(*n_nodes)++] = vertices[k];
    }
    PetscCall(sum_before(*n_nodes, &first));
    for (PetscInt k = 0; k < n; k++)
      values[k] = values[k] == before + k ? first++ : -1;
  }
  PetscCall(PetscArraycpy(share->vertices, values, n));
  PetscCall(PetscFree3(values, some, asked));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode surface_share(const Mesh *mesh, const Surface *surface, Surface *share, PetscInt *n_nodes, PetscInt **nodes)
{
  PetscFunctionBegin;
  *share         = *surface;
  share->n_faces = 0;
  share->numbers = NULL;
  PetscCall(deal_faces(mesh, surface, share));
  PetscCall(sum_before(share->n_faces, &share->first));
  if (!surface->analytic) {
    PetscInt *vertices;
    PetscCall(PetscMalloc1(share->offsets[share->n_faces], &vertices));
    PetscCall(PetscArraycpy(vertices, share->vertices, share->offsets[share->n_faces]));
    PetscCall(surface_split(mesh, vertices, NULL, share, n_nodes, nodes, NULL));
    PetscCall(PetscFree(vertices));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *n_nodes = mesh->rank ? 0 : mesh->dimension + 1; /* its frame */
  PetscCall(PetscMalloc1(*n_nodes, nodes));
  for (PetscInt k = 0; k < *n_nodes; k++)
    (*nodes)[k] = surface->frame + k;
  PetscFunctionReturn(PETSC_SUCCESS);
}
