/* The arrays of a piece of the mesh: what the readers of one body add to, and its rotation as a whole. */
#include "mesh/mesh.h"

CellKind mesh_cell_kind(const Mesh *mesh, PetscInt cell)
{
  return cell_kind(mesh->dimension, mesh->cell_offsets[cell + 1] - mesh->cell_offsets[cell]);
}

CellKind mesh_face_kind(const Mesh *mesh, const Surface *surface, PetscInt face)
{
  return cell_kind(mesh->dimension - 1, surface->offsets[face + 1] - surface->offsets[face]);
}

/* A plane cell that turns clockwise, as meshes drawn from behind have them, the other way: its corners from the last to the
 * second; a node in the middle of corners follows these. */
void mesh_turn_cell(const Mesh *mesh, CellKind kind, PetscInt vertices[])
{
  const PetscInt nodes = cell_nodes(kind), corners = cell_corners(kind);
  PetscInt       given[CELL_NODES];
  PetscReal      area = 0;
  if (cell_dimension(kind) != 2) return;
  for (PetscInt a = 0; a < corners; a++) {
    const PetscReal *x = mesh->coordinates + 3 * vertices[a], *y = mesh->coordinates + 3 * vertices[(a + 1) % corners];
    area += (x[0] * y[1] - x[1] * y[0]) / 2;
  }
  if (area >= 0) return;
  for (PetscInt a = 0; a < nodes; a++)
    given[a] = vertices[a];
  for (PetscInt a = 1; a < nodes; a++) { /* edges from the last to the first; a node in the centre stays */
    if (a < corners) vertices[a] = given[corners - a];
    if (a >= corners && a < 2 * corners) vertices[a] = given[3 * corners - 1 - a];
  }
}

PetscErrorCode mesh_append(Mesh *mesh, PetscInt n_vertices, const PetscInt *numbers, const PetscReal *coordinates,
                           PetscInt n_cells, const PetscInt *cell_numbers, CellKind kind, const PetscInt *cells)
{
  const PetscInt nodes = cell_nodes(kind);
  const PetscInt used = mesh->n_cells ? mesh->cell_offsets[mesh->n_cells] : 0;
  PetscFunctionBegin;
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(mesh->n_vertices + n_vertices), &mesh->numbers));
  PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)(3 * (mesh->n_vertices + n_vertices)), &mesh->coordinates));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(mesh->n_cells + n_cells + 1), &mesh->cell_offsets));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(mesh->n_cells + n_cells), &mesh->cell_numbers));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(mesh->n_cells + n_cells), &mesh->cell_body));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(used + n_cells * nodes), &mesh->cell_vertices));
  PetscCall(PetscArraycpy(mesh->coordinates + 3 * mesh->n_vertices, coordinates, 3 * n_vertices));
  for (PetscInt v = 0; v < n_vertices; v++)
    mesh->numbers[mesh->n_vertices + v] = mesh->n_all_vertices + (numbers ? numbers[v] : v);
  for (PetscInt k = 0; k < n_cells * nodes; k++)
    mesh->cell_vertices[used + k] = cells[k] + mesh->n_vertices;
  for (PetscInt c = 0; c < n_cells; c++) {
    mesh->cell_numbers[mesh->n_cells + c] = mesh->n_all_cells + (cell_numbers ? cell_numbers[c] : c);
    mesh->cell_offsets[mesh->n_cells + c] = used + c * nodes;
    mesh->cell_body[mesh->n_cells + c]    = mesh->n_bodies; /* the body being read */
    mesh_turn_cell(mesh, kind, mesh->cell_vertices + used + c * nodes);
  }
  if (!numbers) mesh->n_all_vertices += n_vertices;
  if (!cell_numbers) mesh->n_all_cells += n_cells;
  mesh->n_cells += n_cells;
  mesh->n_vertices += n_vertices;
  mesh->cell_offsets[mesh->n_cells] = used + n_cells * nodes;
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
  PetscCall(PetscMalloc2(max_faces + 1, &surface->offsets, FACE_NODES * max_faces, &surface->vertices));
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
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    for (PetscInt v = 0; v < mesh->bodies[b].shell.n_vertices; v++)
      mesh_rotate_vector(mesh, mesh->bodies[b].shell.coordinates + 3 * v);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode surface_destroy(Surface *surface)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(surface->offsets, surface->vertices));
  PetscCall(PetscFree(surface->numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mesh_forget_pieces(Mesh *mesh)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < mesh->n_surfaces; s++)
    PetscCall(surface_destroy(&mesh->surfaces[s]));
  PetscCall(PetscFree(mesh->surfaces));
  PetscCall(PetscFree(mesh->numbers));
  PetscCall(PetscFree(mesh->coordinates));
  PetscCall(PetscFree(mesh->cell_numbers));
  PetscCall(PetscFree(mesh->cell_offsets));
  PetscCall(PetscFree(mesh->cell_vertices));
  PetscCall(PetscFree(mesh->cell_body));
  PetscCall(PetscFree(mesh->owners));
  PetscCall(PetscSFDestroy(&mesh->shared));
  mesh->n_vertices = mesh->n_cells = mesh->n_surfaces = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mesh_destroy(Mesh *mesh)
{
  PetscFunctionBegin;
  PetscCall(mesh_forget_pieces(mesh));
  for (PetscInt b = 0; mesh->bodies && b < mesh->n_bodies; b++) { /* of rank 0 */
    PetscCall(PetscFree2(mesh->bodies[b].shell.offsets, mesh->bodies[b].shell.vertices));
    PetscCall(PetscFree(mesh->bodies[b].shell.coordinates));
  }
  PetscCall(PetscFree(mesh->bodies));
  PetscCall(PetscFree(mesh->points));
  PetscCall(PetscFree3(mesh->original, mesh->here, mesh->original_cell));
  PetscCall(DMDestroy(&mesh->dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
