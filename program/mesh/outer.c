/* The outer faces of bodies: those of one cell alone; of a rigid body, which has no cells, those of its surfaces. They are numbered by their
 * cells, so that they have one order on any number of ranks. */
#include "mesh/mesh.h"
#include <string.h>

/* A face: its corners in increasing order, by which others are the same; its number, and where it comes from. */
typedef struct {
  PetscInt corners[4], number, body, source, face;
  PetscBool dropped;
} Face;

enum { OF_CELLS = -1 };

static int by_corners(const void *a, const void *b, void *context)
{
  const Face *one = a, *two = b;
  (void)context;
  for (int k = 0; k < 4; k++) {
    if (one->corners[k] != two->corners[k]) return one->corners[k] < two->corners[k] ? -1 : 1;
  }
  return (one->number > two->number) - (one->number < two->number);
}

static int by_number(const void *a, const void *b, void *context)
{
  const Face *one = a, *two = b;
  (void)context;
  return (one->number > two->number) - (one->number < two->number);
}

static PetscErrorCode add(PetscInt n, const PetscInt vertices[], Face face, PetscInt *n_faces, Face **faces)
{
  PetscFunctionBegin;
  if ((*n_faces & (*n_faces - 1)) == 0) PetscCall(PetscRealloc(sizeof(Face) * (size_t)PetscMax(1, 2 * *n_faces), faces));
  for (PetscInt k = 0; k < 4; k++)
    face.corners[k] = k < n ? vertices[k] : -1;
  PetscCall(PetscSortInt(4, face.corners));
  (*faces)[(*n_faces)++] = face;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt corners_of(const Mesh *mesh, PetscInt n)
{
  return cell_corners(cell_kind(mesh->dimension - 1, n));
}

/* nodes of a face; returns how many */
static PetscInt nodes_of(const Mesh *mesh, const Face *face, PetscInt vertices[FACE_NODES])
{
  const Surface *surface;
  PetscInt       at, n;
  if (face->source == OF_CELLS) {
    const PetscInt *cell = mesh->cell_vertices + mesh->cell_offsets[face->face / CELL_CORNERS];
    return cell_face(mesh_cell_kind(mesh, face->face / CELL_CORNERS), face->face % CELL_CORNERS, cell, vertices);
  }
  surface = &mesh->surfaces[face->source];
  at      = surface->offsets[face->face];
  n       = surface->offsets[face->face + 1] - at;
  for (PetscInt k = 0; k < n; k++)
    vertices[k] = surface->vertices[at + k];
  return n;
}

/* The number of a face of a surface, of all ranks. */
static PetscInt number_in(const Surface *surface, PetscInt f)
{
  return surface->numbers ? surface->numbers[f] : f;
}

static PetscErrorCode collect(const Mesh *mesh, const PetscBool wanted[], const PetscBool without[], PetscInt *n, Face **faces)
{
  PetscInt vertices[FACE_NODES], first = CELL_CORNERS * mesh->n_all_cells; /* numbers of faces of cells are below */
  PetscFunctionBegin;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Body *body = &mesh->bodies[mesh->cell_body[c]];
    for (PetscInt f = 0; f < cell_faces(mesh_cell_kind(mesh, c)) && wanted[mesh->cell_body[c]] && !body->analytic && !body->rigid; f++) {
      const Face face = {.number = CELL_CORNERS * mesh->cell_numbers[c] + f, .body = mesh->cell_body[c], .source = OF_CELLS,
                         .face = CELL_CORNERS * c + f};
      PetscCall(add(corners_of(mesh, nodes_of(mesh, &face, vertices)), vertices, face, n, faces));
    }
  }
  for (PetscInt s = 0; s < mesh->n_surfaces; s++) {
    const Surface *surface = &mesh->surfaces[s];
    PetscInt       end     = 0;
    for (PetscInt f = 0; f < surface->n_faces; f++) {
      Face face = {.number = first + number_in(surface, f), .source = s, .face = f, .dropped = without[s]};
      end       = PetscMax(end, number_in(surface, f) + 1);
      face.body = mesh_body_of(mesh, mesh->numbers[surface->vertices[surface->offsets[f]]]);
      if (face.body < 0 || !wanted[face.body] || (!mesh->bodies[face.body].rigid && !without[s])) continue;
      PetscCall(add(corners_of(mesh, nodes_of(mesh, &face, vertices)), vertices, face, n, faces));
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &end, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
    first += end;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of faces with the same corners the first one, if it is outer. Returns how many are left. */
static PetscInt select_outer(const Mesh *mesh, PetscInt n, Face faces[])
{
  PetscInt kept = 0;
  for (PetscInt k = 0, end; k < n; k = end) {
    PetscInt  cells   = 0;
    PetscBool dropped = PETSC_FALSE;
    for (end = k; end < n && !memcmp(faces[end].corners, faces[k].corners, sizeof(faces[k].corners)); end++) {
      cells += faces[end].source == OF_CELLS;
      dropped = (PetscBool)(dropped || faces[end].dropped);
    }
    if (!dropped && (cells == 1 || mesh->bodies[faces[k].body].rigid)) faces[kept++] = faces[k];
  }
  return kept;
}

/* Whether all corners of a face are in several pieces: then another piece may have the cell behind it. */
static PetscBool on_border(const Face *face, const PetscInt pieces[])
{
  for (int k = 0; k < 4; k++) {
    if (face->corners[k] >= 0 && pieces[face->corners[k]] < 2) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The faces between pieces, of all ranks, with the numbers of their vertices; those that two ranks have are inner ones. Returns how many of the
 * n faces here are left. */
static PetscErrorCode drop_shared(const Mesh *mesh, PetscInt *n, Face faces[])
{
  enum { WIDTH = 4 };
  PetscInt    *pieces, *mine, *all, n_mine = 0, n_all = 0, kept = 0, m = 0;
  PetscMPIInt *counts, *starts, count;
  Face        *others = NULL;
  PetscFunctionBegin;
  if (mesh->size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(mesh->n_vertices, &pieces));
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    pieces[v] = 1;
  PetscCall(pieces_unite(mesh, pieces, MPI_SUM));
  PetscCall(PetscMalloc1(WIDTH * *n, &mine));
  for (PetscInt f = 0; f < *n; f++) {
    if (!on_border(&faces[f], pieces)) continue;
    for (int k = 0; k < WIDTH; k++)
      mine[n_mine++] = faces[f].corners[k] < 0 ? -1 : mesh->numbers[faces[f].corners[k]];
  }
  count = (PetscMPIInt)n_mine;
  PetscCall(PetscMalloc2(mesh->size, &counts, mesh->size, &starts));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0; r < mesh->size; r++) {
    starts[r] = (PetscMPIInt)n_all;
    n_all += counts[r];
  }
  PetscCall(PetscMalloc1(n_all, &all));
  PetscCallMPI(MPI_Allgatherv(mine, count, MPIU_INT, all, counts, starts, MPIU_INT, PETSC_COMM_WORLD));
  for (PetscInt k = 0; k < n_all; k += WIDTH)
    PetscCall(add(WIDTH, all + k, (Face){0}, &m, &others));
  if (m > 1) PetscCall(PetscTimSort(m, others, sizeof(*others), by_corners, NULL));
  for (PetscInt f = 0; f < *n; f++) {
    Face     key   = {.number = -1};
    PetscInt low   = 0, high = m;
    for (int k = 0; k < 4; k++)
      key.corners[k] = faces[f].corners[k] < 0 ? -1 : mesh->numbers[faces[f].corners[k]];
    while (low < high) {
      const PetscInt middle = (low + high) / 2;
      if (by_corners(&others[middle], &key, NULL) < 0) low = middle + 1;
      else high = middle;
    }
    if (low + 1 < m && !memcmp(others[low + 1].corners, key.corners, sizeof(key.corners))) continue; /* it is there twice */
    faces[kept++] = faces[f];
  }
  *n = kept;
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscFree(pieces));
  PetscCall(PetscFree(mine));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(others));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mesh_outer(const Mesh *mesh, const PetscBool wanted[], const PetscBool without[], Surface *outer)
{
  PetscInt n = 0;
  Face    *faces = NULL;
  PetscFunctionBegin;
  PetscCall(collect(mesh, wanted, without, &n, &faces));
  if (n > 1) PetscCall(PetscTimSort(n, faces, sizeof(*faces), by_corners, NULL));
  n = select_outer(mesh, n, faces);
  PetscCall(drop_shared(mesh, &n, faces));
  if (n > 1) PetscCall(PetscTimSort(n, faces, sizeof(*faces), by_number, NULL));
  *outer = (Surface){0};
  PetscCall(PetscMalloc2(n + 1, &outer->offsets, FACE_NODES * n, &outer->vertices));
  PetscCall(PetscMalloc1(n, &outer->numbers));
  outer->offsets[0] = 0;
  for (PetscInt k = 0; k < n; k++) {
    PetscInt       vertices[FACE_NODES];
    const PetscInt m  = nodes_of(mesh, &faces[k], vertices);
    outer->numbers[k] = faces[k].number;
    surface_push(outer, m, vertices);
  }
  PetscCall(PetscFree(faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
