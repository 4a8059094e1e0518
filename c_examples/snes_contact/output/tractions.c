/* Nodal tractions: the force of the mortar on a node of the non-mortar side over the node's covered area, or over the
 * whole one where nothing is covered.
 *
 * On quadratic faces a uniform traction has nodal forces of either sign. There the force of a node in the middle of
 * corners goes to these in equal parts, which makes of a corner's force the integral of the traction with the corner's
 * linear function; the middle has the mean of its corners' tractions. */
#include "output/output.h"

/* Of each node of the non-mortar side: how many corners it is in the middle of, 1: it is one, and their numbers. */
static void find_corners(const Mesh *mesh, const Surface *surface, PetscInt n[], PetscInt (*corners)[4])
{
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const PetscInt *face = surface->vertices + surface->offsets[f];
    const CellKind  kind = mesh_face_kind(mesh, surface, f);
    for (PetscInt k = 0; k < cell_nodes(kind); k++) {
      PetscInt       its[CELL_CORNERS];
      const PetscInt a = face[k];
      n[a] = cell_node_corners(kind, k, its);
      for (PetscInt c = 0; c < n[a]; c++)
        corners[a][c] = face[its[c]];
    }
  }
}

/* rank 0: 3 per node of the non-mortar side */
PetscErrorCode nodal_tractions(const Mesh *mesh, const Interface *interface, const ContactStates *states,
                               double tractions[])
{
  const PetscBool everywhere = (PetscBool)(interface->options.multiplier_space == STICKSLIP_SPACE_SUB);
  double         *area;
  PetscInt       *n, (*corners)[4];

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(interface->n1, &n, interface->n1, &corners, interface->n1, &area));
  find_corners(mesh, interface->surface[0], n, corners);
  for (PetscInt a = 0; a < interface->n1; a++) {
    area[a] = states->coverage[a] > 0 ? states->coverage[a] : states->area[a];
    contact_vector(interface->dimension, interface->forces, a, tractions + 3 * a);
    for (int i = 0; i < 3; i++)
      tractions[3 * a + i] = -tractions[3 * a + i];
  }
  for (PetscInt a = 0; a < interface->n1; a++) {
    for (PetscInt c = 0; c < n[a] && n[a] > 1; c++) {
      for (int i = 0; i < 3; i++)
        tractions[3 * corners[a][c] + i] += tractions[3 * a + i] / (double)n[a];
      if (everywhere) area[corners[a][c]] += area[a] / (double)n[a];
    }
  }
  for (PetscInt k = 0; k < 3 * interface->n1; k++)
    tractions[k] = n[k / 3] == 1 ? tractions[k] / area[k / 3] : 0;
  for (PetscInt a = 0; a < interface->n1; a++) {
    for (PetscInt c = 0; c < n[a] && n[a] > 1; c++) {
      for (int i = 0; i < 3; i++)
        tractions[3 * a + i] += tractions[3 * corners[a][c] + i] / (double)n[a];
    }
  }
  PetscCall(PetscFree3(n, corners, area));
  PetscFunctionReturn(PETSC_SUCCESS);
}
