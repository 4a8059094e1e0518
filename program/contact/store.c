/* What contact has stored where points decide. There K keeps a gap (docs/formulation 16.2), as a thin elastic layer would; what it takes by
 * that it gives back, which is no gain. With the weights of a step the forces of the normal part have the potential
 *
 *   Psi = 1/2 int t sum_A N_A gh_A da = 1/2 sum_A gh_A int N_A t da = 1/2 sum_A g_A tau_A,      (docs/dynamics.md)
 *
 * where tau_A is the mean of t that the library says. Where nodes decide nothing is stored. */
#include "contact/contact.h"

static PetscErrorCode add_part(const ContactPart *part, PetscReal *store)
{
  const PetscInt   n1     = part->n1, d = part->dimension;
  stickslip_states wanted = {.struct_size = sizeof(wanted)};
  PetscFunctionBegin;
  if (!verb_there(part)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(n1, &wanted.gap, d * n1, &wanted.traction, d * n1, &wanted.normal));
  PetscCallStickslip(verb_states(part, &wanted));
  for (PetscInt a = 0; a < n1; a++) {
    if (part->owned[a] != STICKSLIP_NODE_OWN) continue;
    for (PetscInt i = 0; i < d; i++)
      *store += 0.5 * wanted.gap[a] * wanted.traction[d * a + i] * wanted.normal[d * a + i];
  }
  PetscCall(PetscFree3(wanted.gap, wanted.traction, wanted.normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_store(const Contact *contact, PetscReal *store)
{
  PetscFunctionBegin;
  *store = 0;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    if (decision_is_points(&contact->interfaces[i])) PetscCall(add_part(&contact->interfaces[i].part, store));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, store, 1, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
