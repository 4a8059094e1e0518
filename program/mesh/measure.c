/* What a rank holds of the mesh, in bytes, array by array. */
#include "mesh/mesh.h"

PetscLogDouble mesh_bytes_of_piece(const Mesh *mesh)
{
  const PetscInt n_entries = mesh->n_cells ? mesh->cell_offsets[mesh->n_cells] : 0;
  PetscLogDouble bytes     = (PetscLogDouble)mesh->n_vertices * (sizeof(PetscInt) + 3 * sizeof(PetscReal));
  bytes += ((PetscLogDouble)3 * mesh->n_cells + n_entries) * sizeof(PetscInt);
  for (PetscInt s = 0; s < mesh->n_surfaces; s++) {
    const Surface *surface = &mesh->surfaces[s];
    bytes += ((PetscLogDouble)2 * surface->n_faces + surface->offsets[surface->n_faces]) * sizeof(PetscInt);
  }
  return bytes;
}

/* Cones with orientations, supports, coordinates, and the arrays beside them; labels, which have surfaces and supports, are left
 * out. */
PetscErrorCode mesh_measure(Mesh *mesh)
{
  PetscInt pEnd, cEnd, n, n_numbers = 0;
  Vec      coordinates;
  PetscFunctionBegin;
  PetscCall(DMPlexGetChart(mesh->dm, NULL, &pEnd));
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, NULL, &cEnd));
  for (PetscInt p = 0; p < pEnd; p++) {
    PetscCall(DMPlexGetConeSize(mesh->dm, p, &n));
    n_numbers += 2 * n;
    PetscCall(DMPlexGetSupportSize(mesh->dm, p, &n));
    n_numbers += n;
  }
  n_numbers += 2 * 2 * pEnd; /* sections of cones and supports: size and offset */
  n_numbers += 3 * pEnd + cEnd; /* points, original, here, original_cell */
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &coordinates));
  PetscCall(VecGetLocalSize(coordinates, &n));
  mesh->bytes.kept = (PetscLogDouble)n_numbers * sizeof(PetscInt) + (PetscLogDouble)n * sizeof(PetscScalar);
  PetscFunctionReturn(PETSC_SUCCESS);
}
