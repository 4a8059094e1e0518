/* Interfaces whose normals follow the motion (`normals: current`): which normals their evaluations use, and multipliers that
 * turn with the surface to start a step with. */
#include "contact/contact.h"

static PetscBool follows(const Interface *interface)
{
  return (PetscBool)(interface->method.normals == STICKSLIP_NORMALS_CURRENT);
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
  contact->settles = (PetscBool)(normals == STICKSLIP_NORMALS_COMMITTED);
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    if (follows(&contact->interfaces[i])) PetscCallStickslip(verb_use_normals(&contact->interfaces[i].part, normals));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turns a part's multipliers, on all ranks or on none. */
static PetscErrorCode turn(Interface *interface, double multipliers[])
{
  ContactPart *part = &interface->part;
  PetscInt     n = part->components * part->n1, refused = 0;
  double      *given;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &given));
  PetscCall(PetscArraycpy(given, multipliers, n));
  refused = verb_turn_multipliers(part, multipliers) != 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &refused, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  if (refused) PetscCall(PetscArraycpy(multipliers, given, n));
  PetscCall(parts_share(part, part->components, multipliers));
  PetscCall(PetscFree(given));
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
    Interface   *interface = &contact->interfaces[i];
    ContactPart *part      = &interface->part;
    if (!follows(interface)) continue;
    PetscCall(contact_gather(contact, interface, physics->u_local));
    PetscCall(turn(interface, contact->condensed ? part->lambda_start : MULTIPLIERS_OF(part, part->gathered)));
    if (!contact->condensed) PetscCall(contact_scatter(part, part->gathered, physics->u_local, MPI_REPLACE));
  }
  if (!contact->condensed) {
    PetscCall(DMLocalToGlobalBegin(contact->mesh->dm, physics->u_local, INSERT_VALUES, x));
    PetscCall(DMLocalToGlobalEnd(contact->mesh->dm, physics->u_local, INSERT_VALUES, x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
