/* What general contact makes of a step that has failed: where facets have met that were out of reach, the library looks for them from then
 * on, and the same step is solved once more; where a step fails however short it is, the other sides may do. */
#include "contact/skin.h"

/* What has the multipliers in part->gathered, into x and the local vector. */
PetscErrorCode skin_hand_over(Contact *contact, const Interface *interface, Vec x)
{
  Vec local = contact->physics->u_local;
  PetscFunctionBegin;
  PetscCall(contact_scatter(&interface->part, interface->part.gathered, local, MPI_REPLACE));
  PetscCall(DMLocalToGlobalBegin(contact->mesh->dm, local, INSERT_VALUES, x));
  PetscCall(DMLocalToGlobalEnd(contact->mesh->dm, local, INSERT_VALUES, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has the library begun to look for more, since it was last asked? */
PetscErrorCode contact_looks_anew(Contact *contact, PetscBool *anew)
{
  stickslip_skin_summary found = {.struct_size = sizeof(found)};
  PetscFunctionBegin;
  *anew = PETSC_FALSE;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    ContactPart *part = &contact->interfaces[i].part;
    if (!part->skin) continue;
    PetscCallStickslip(stickslip_skin_report(part->skin->handle, &found));
    if (found.missed == part->skin->missed) continue;
    part->skin->missed = found.missed;
    *anew              = PETSC_TRUE;
    PetscCall(skin_look(part));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, anew, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The other sides of a part's skin; `done`: it has some, and its multipliers are in part->gathered. */
static PetscErrorCode exchange(ContactPart *part, PetscBool *done)
{
  stickslip_skin_summary found = {.struct_size = sizeof(found)};
  PetscFunctionBegin;
  *done = PETSC_FALSE;
  if (!part->skin || part->skin->exchanged) PetscFunctionReturn(PETSC_SUCCESS);
  skin_point(part);
  part->skin->exchanged = PETSC_TRUE;
  if (stickslip_skin_exchange(part->skin->handle, part->skin->lambda)) PetscFunctionReturn(PETSC_SUCCESS);
  skin_to_part(part, part->dimension, part->skin->lambda, MULTIPLIERS_OF(part, part->gathered));
  PetscCall(skin_look(part));
  PetscCallStickslip(stickslip_skin_report(part->skin->handle, &found));
  *done = (PetscBool)(found.pieces > 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The other sides, once a step, from x, which is t_n; `any`: there are some, and it is another x. */
PetscErrorCode contact_exchange(Contact *contact, Vec x, PetscBool *any)
{
  PetscFunctionBegin;
  *any = PETSC_FALSE;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    PetscBool  done;
    if (!interface->skin) continue;
    PetscCall(unknowns_to_local(contact->physics, x));
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    PetscCall(exchange(&interface->part, &done));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &done, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
    if (done) PetscCall(skin_hand_over(contact, interface, x));
    *any = (PetscBool)(*any || done);
  }
  if (*any) contact->refusal[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
