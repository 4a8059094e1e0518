/* Which parts have which nodes and facets of a side of an interface: marks, one bit a rank, that spread over facets in rings. */
#include "contact/packet.h"

PetscErrorCode side_create(const Interface *interface, int which, Side *side)
{
  const Surface  *surface = interface->surface[which];
  static PetscInt none    = 0;
  PetscFunctionBegin;
  *side = (Side){.which = which, .n_nodes = which ? interface->n2 : interface->n1, .offsets = &none};
  side->corners = interface->corners[which];
  if (!surface->analytic) {
    side->n_facets = surface->n_faces;
    side->offsets  = surface->offsets;
  }
  PetscCall(PetscCalloc3(interface->n1 + interface->n2, &side->of_both, side->n_facets, &side->facets,
                         side->offsets[side->n_facets], &side->marks));
  side->nodes = side->of_both + (which ? interface->n1 : 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode side_destroy(Side *side)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(side->of_both, side->facets, side->marks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode side_clear(const Interface *interface, Side *side)
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(side->of_both, interface->n1 + interface->n2));
  PetscCall(PetscArrayzero(side->facets, side->n_facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode side_mark_rings(Side *side, PetscInt rings)
{
  PetscFunctionBegin;
  for (PetscInt ring = 0; ring < rings; ring++) {
    PetscCall(PetscSFBcastBegin(side->corners, MPIU_INT, side->of_both, side->marks, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(side->corners, MPIU_INT, side->of_both, side->marks, MPI_REPLACE));
    for (PetscInt f = 0; f < side->n_facets; f++) {
      for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1]; k++)
        side->facets[f] |= side->marks[k];
      for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1]; k++)
        side->marks[k] = side->facets[f];
    }
    PetscCall(PetscSFReduceBegin(side->corners, MPIU_INT, side->marks, side->of_both, MPI_BOR));
    PetscCall(PetscSFReduceEnd(side->corners, MPIU_INT, side->marks, side->of_both, MPI_BOR));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
