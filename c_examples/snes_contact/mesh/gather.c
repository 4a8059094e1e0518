/* A surface of all pieces, on rank 0, where the contact cuts it into parts. */
#include "mesh/mesh.h"

/* Numbers of all ranks, one rank after the other, on rank 0. */
static PetscErrorCode gather(const Mesh *mesh, PetscInt n, const PetscInt mine[], PetscInt *n_all, PetscInt **all)
{
  PetscMPIInt n_mine = (PetscMPIInt)n, *counts = NULL, *starts = NULL;
  PetscFunctionBegin;
  if (mesh->rank == 0) PetscCall(PetscMalloc2(mesh->size, &counts, mesh->size + 1, &starts));
  PetscCallMPI(MPI_Gather(&n_mine, 1, MPI_INT, counts, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  if (mesh->rank == 0) {
    starts[0] = 0;
    for (PetscMPIInt r = 0; r < mesh->size; r++)
      starts[r + 1] = starts[r] + counts[r];
  }
  *n_all = mesh->rank ? 0 : starts[mesh->size];
  PetscCall(PetscMalloc1(*n_all, all));
  PetscCallMPI(MPI_Gatherv(mine, n_mine, MPIU_INT, *all, counts, starts, MPIU_INT, 0, PETSC_COMM_WORLD));
  PetscCall(PetscFree2(counts, starts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Distinct numbers, as they are first met, in place of the numbers; `order`: sorted, `place`: of each of them. */
static PetscErrorCode number_nodes(PetscInt n, PetscInt numbers[], PetscInt *n_nodes, PetscInt **nodes)
{
  PetscInt *sorted, *place, n_sorted = n, at;
  PetscFunctionBegin;
  PetscCall(PetscMalloc2(n, &sorted, n, &place));
  PetscCall(PetscArraycpy(sorted, numbers, n));
  PetscCall(PetscSortRemoveDupsInt(&n_sorted, sorted));
  for (PetscInt k = 0; k < n_sorted; k++)
    place[k] = -1;
  PetscCall(PetscMalloc1(n_sorted, nodes));
  *n_nodes = 0;
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(PetscFindInt(numbers[k], n_sorted, sorted, &at));
    if (place[at] < 0) {
      (*nodes)[*n_nodes] = numbers[k];
      place[at]          = (*n_nodes)++;
    }
    numbers[k] = place[at];
  }
  PetscCall(PetscFree2(sorted, place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Faces, each as its number, how many vertices it has, and these: in the order of the former. */
static PetscErrorCode sort_faces(PetscInt n, const PetscInt packed[], Surface *whole)
{
  PetscInt n_faces = 0, n_vertices = 0, *number, *start;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; k += 2 + packed[k + 1])
    n_faces++, n_vertices += packed[k + 1];
  PetscCall(PetscMalloc2(n_faces + 1, &whole->offsets, n_vertices, &whole->vertices));
  PetscCall(PetscMalloc2(n_faces, &number, n_faces, &start));
  for (PetscInt k = 0, f = 0; k < n; k += 2 + packed[k + 1], f++) {
    number[f] = packed[k];
    start[f]  = k;
  }
  PetscCall(PetscSortIntWithArray(n_faces, number, start));
  whole->offsets[0] = 0;
  for (PetscInt f = 0; f < n_faces; f++)
    surface_push(whole, packed[start[f] + 1], packed + start[f] + 2);
  PetscCall(PetscFree2(number, start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode surface_gather(const Mesh *mesh, const Surface *surface, Surface *whole, PetscInt *n_nodes, PetscInt **nodes)
{
  PetscInt  n = 0, n_all, *mine, *all;
  PetscFunctionBegin;
  *whole          = *surface;
  whole->n_faces  = 0;
  whole->numbers  = NULL;
  PetscCall(PetscMalloc1(2 * surface->n_faces + surface->offsets[surface->n_faces], &mine));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    mine[n++] = surface->numbers ? surface->numbers[f] : f;
    mine[n++] = surface->offsets[f + 1] - surface->offsets[f];
    for (PetscInt k = surface->offsets[f]; k < surface->offsets[f + 1]; k++)
      mine[n++] = mesh->numbers[surface->vertices[k]];
  }
  PetscCall(gather(mesh, n, mine, &n_all, &all));
  PetscCall(sort_faces(n_all, all, whole));
  PetscCall(PetscFree(mine));
  PetscCall(PetscFree(all));
  if (surface->analytic && mesh->rank == 0) { /* its frame */
    *n_nodes = mesh->dimension + 1;
    PetscCall(PetscMalloc1(*n_nodes, nodes));
    for (PetscInt k = 0; k < *n_nodes; k++)
      (*nodes)[k] = surface->frame + k;
  } else {
    PetscCall(number_nodes(whole->offsets[whole->n_faces], whole->vertices, n_nodes, nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
