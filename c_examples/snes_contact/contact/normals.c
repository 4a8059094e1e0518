/* Interfaces whose normals follow the motion (`normals: current`): which normals their evaluations use, and multipliers that
 * turn with the surface to start a step with. */
#include "contact/contact.h"

static PetscBool follows(const Interface *interface)
{
  return (PetscBool)(interface->options.normals == STICKSLIP_NORMALS_CURRENT);
}

PetscBool normals_follow(const Contact *contact)
{
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    if (follows(&contact->interfaces[i])) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* For the evaluations that come: those of the start of the step, or the current ones. */
PetscErrorCode normals_use(Contact *contact, int32_t normals)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces && contact->mesh->rank == 0; i++) {
    if (follows(&contact->interfaces[i]))
      PetscCallStickslip(stickslip_interface_use_normals(contact->interfaces[i].handle, normals));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turns the multipliers of x, which are those of the last step, as the surfaces turn from there to x. Where they cannot be
 * turned they stay: this chooses where Newton's method starts, not what it solves. */
PetscErrorCode normals_turn_multipliers(Contact *contact, Vec x)
{
  Physics *physics = contact->physics;
  PetscFunctionBegin;
  if (!normals_follow(contact)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(unknowns_to_local(physics, x));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    if (!follows(interface)) continue;
    PetscCall(contact_gather(contact, interface, physics->u_local));
    if (contact->mesh->rank == 0) {
      double *of_x = MULTIPLIERS_OF(interface, interface->gathered);
      (void)stickslip_interface_turn_multipliers(interface->handle, interface->x,
                                                 contact->condensed ? interface->lambda_start : of_x);
    }
    if (!contact->condensed) PetscCall(contact_scatter(interface, interface->gathered, physics->u_local, MPI_REPLACE));
  }
  if (!contact->condensed) {
    PetscCall(DMLocalToGlobalBegin(contact->mesh->dm, physics->u_local, INSERT_VALUES, x));
    PetscCall(DMLocalToGlobalEnd(contact->mesh->dm, physics->u_local, INSERT_VALUES, x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
