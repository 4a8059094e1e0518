/* The mesh's arrays: what the readers of one body add to, and its rotation as a whole. */
#include "mesh/mesh.h"

/* faces of a hexahedron and a tetrahedron in VTK's order of corners, right-hand normal outward */
static const PetscInt HEX_FACES[6][4] = {
    {0, 3, 2, 1},
    {4, 5, 6, 7},
    {0, 1, 5, 4},
    {1, 2, 6, 5},
    {2, 3, 7, 6},
    {3, 0, 4, 7}
};
static const PetscInt TET_FACES[4][3] = {
    {0, 2, 1},
    {0, 1, 3},
    {1, 2, 3},
    {2, 0, 3}
};

PetscInt cell_face(PetscInt corners, PetscInt face, const PetscInt cell[], PetscInt vertices[4])
{
  const PetscInt n = corners == 8 ? 4 : 3;
  for (PetscInt k = 0; k < n; k++)
    vertices[k] = cell[corners == 8 ? HEX_FACES[face][k] : TET_FACES[face][k]];
  return n;
}

PetscErrorCode mesh_append(Mesh *mesh, PetscInt n_vertices, const PetscReal *coordinates, PetscInt n_cells,
                           PetscInt corners, const PetscInt *cells)
{
  const PetscInt used = mesh->n_cells ? mesh->cell_offsets[mesh->n_cells] : 0;
  PetscFunctionBegin;
  PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)(3 * (mesh->n_vertices + n_vertices)), &mesh->coordinates));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(mesh->n_cells + n_cells + 1), &mesh->cell_offsets));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(mesh->n_cells + n_cells), &mesh->cell_body));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(used + n_cells * corners), &mesh->cell_vertices));
  PetscCall(PetscArraycpy(mesh->coordinates + 3 * mesh->n_vertices, coordinates, 3 * n_vertices));
  for (PetscInt k = 0; k < n_cells * corners; k++)
    mesh->cell_vertices[used + k] = cells[k] + mesh->n_vertices;
  for (PetscInt c = 0; c < n_cells; c++) {
    mesh->cell_offsets[mesh->n_cells + c] = used + c * corners;
    mesh->cell_body[mesh->n_cells + c]    = mesh->n_bodies; /* the body being read */
  }
  mesh->n_cells += n_cells;
  mesh->n_vertices += n_vertices;
  mesh->cell_offsets[mesh->n_cells] = used + n_cells * corners;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mesh_add_surface(Mesh *mesh, const char *name, PetscInt max_faces, Surface **out)
{
  Surface *surface;
  PetscFunctionBegin;
  PetscCall(PetscRealloc(sizeof(Surface) * (size_t)(mesh->n_surfaces + 1), &mesh->surfaces));
  surface = &mesh->surfaces[mesh->n_surfaces++];
  PetscCall(PetscMemzero(surface, sizeof(*surface)));
  PetscCall(PetscSNPrintf(surface->name, sizeof(surface->name), "%s", name));
  PetscCall(PetscMalloc2(max_faces + 1, &surface->offsets, 4 * max_faces, &surface->vertices));
  surface->offsets[0] = 0;
  *out                = surface;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void surface_push(Surface *surface, PetscInt n, const PetscInt vertices[])
{
  PetscInt at = surface->offsets[surface->n_faces++];
  for (PetscInt k = 0; k < n; k++)
    surface->vertices[at + k] = vertices[k];
  surface->offsets[surface->n_faces] = at + n;
}

void mesh_rotate_vector(const Mesh *mesh, PetscReal v[3])
{
  const PetscReal *Q = mesh->rotation, w[3] = {v[0], v[1], v[2]};
  if (!mesh->rotated) return;
  for (int i = 0; i < 3; i++)
    v[i] = Q[3 * i] * w[0] + Q[3 * i + 1] * w[1] + Q[3 * i + 2] * w[2];
}

PetscErrorCode mesh_rotate(Mesh *mesh)
{
  PetscFunctionBegin;
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    mesh_rotate_vector(mesh, mesh->coordinates + 3 * v);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mesh_destroy(Mesh *mesh)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < mesh->n_surfaces; s++)
    PetscCall(PetscFree2(mesh->surfaces[s].offsets, mesh->surfaces[s].vertices));
  PetscCall(PetscFree(mesh->surfaces));
  PetscCall(PetscFree(mesh->bodies));
  PetscCall(PetscFree(mesh->coordinates));
  PetscCall(PetscFree(mesh->cell_offsets));
  PetscCall(PetscFree(mesh->cell_vertices));
  PetscCall(PetscFree(mesh->cell_body));
  PetscCall(PetscFree(mesh->original));
  PetscCall(DMDestroy(&mesh->dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
