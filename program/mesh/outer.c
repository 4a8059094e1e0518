/* The outer faces of bodies: those of one cell alone; of a rigid body, which has no cells, those of its surfaces. */
#include "mesh/mesh.h"
#include <string.h>

/* A face: its corners in increasing order, by which others are the same; which of the order it was met in, and where it comes from. */
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
  face.number          = *n_faces;
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

static PetscErrorCode collect(const Mesh *mesh, const PetscBool wanted[], const PetscBool without[], PetscInt *n, Face **faces)
{
  PetscInt vertices[FACE_NODES];
  PetscFunctionBegin;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const Body *body = &mesh->bodies[mesh->cell_body[c]];
    for (PetscInt f = 0; f < cell_faces(mesh_cell_kind(mesh, c)) && wanted[mesh->cell_body[c]] && !body->analytic && !body->rigid; f++) {
      const Face face = {.body = mesh->cell_body[c], .source = OF_CELLS, .face = CELL_CORNERS * c + f};
      PetscCall(add(corners_of(mesh, nodes_of(mesh, &face, vertices)), vertices, face, n, faces));
    }
  }
  for (PetscInt s = 0; s < mesh->n_surfaces; s++) {
    const Surface *surface = &mesh->surfaces[s];
    for (PetscInt f = 0; f < surface->n_faces; f++) {
      Face face = {.source = s, .face = f, .dropped = without[s]};
      face.body = mesh_body_of(mesh, mesh->numbers[surface->vertices[surface->offsets[f]]]);
      if (face.body < 0 || !wanted[face.body] || (!mesh->bodies[face.body].rigid && !without[s])) continue;
      PetscCall(add(corners_of(mesh, nodes_of(mesh, &face, vertices)), vertices, face, n, faces));
    }
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

PetscErrorCode mesh_outer(const Mesh *mesh, const PetscBool wanted[], const PetscBool without[], Surface *outer)
{
  PetscInt n = 0;
  Face    *faces = NULL;
  PetscFunctionBegin;
  PetscCheck(mesh->size == 1, PETSC_COMM_WORLD, PETSC_ERR_SUP, "outer faces of a mesh in pieces");
  PetscCall(collect(mesh, wanted, without, &n, &faces));
  PetscCall(PetscTimSort(n, faces, sizeof(*faces), by_corners, NULL));
  n = select_outer(mesh, n, faces);
  PetscCall(PetscTimSort(n, faces, sizeof(*faces), by_number, NULL));
  *outer = (Surface){0};
  PetscCall(PetscMalloc2(n + 1, &outer->offsets, FACE_NODES * n, &outer->vertices));
  outer->offsets[0] = 0;
  for (PetscInt k = 0; k < n; k++) {
    PetscInt       vertices[FACE_NODES];
    const PetscInt m = nodes_of(mesh, &faces[k], vertices);
    surface_push(outer, m, vertices);
  }
  PetscCall(PetscFree(faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
