/* With `dynamics` an interface takes weights that conserve (docs/dynamics.md), unless its scene says which it wants, or the library does not have
 * them beside all else that the interface does. The library is asked by creating it. Then weights are those that it chooses elsewhere, and the
 * run says why. */
#include "contact/contact.h"

/* Otherwise, and why. */
static void yield_to(Interface *interface, const char *why)
{
  interface->method.weights          = interface->otherwise.weights;
  interface->method.normals          = interface->otherwise.normals;
  interface->method.multiplier_basis = interface->otherwise.multiplier_basis;
  interface->conserves               = PETSC_FALSE;
  snprintf(interface->conserves_not, sizeof(interface->conserves_not), "%s", why);
}

PetscErrorCode conserving_choose(const Contact *contact, Interface *interface)
{
  stickslip_method *method  = &interface->method;
  const PetscBool   is_open = (PetscBool)(method->weights == STICKSLIP_WEIGHTS_AUTO && interface->options.friction != STICKSLIP_FRICTION_TIED);
  const PetscBool   lags    = (PetscBool)(method->normals == STICKSLIP_NORMALS_COMMITTED);
  PetscFunctionBegin;
  interface->otherwise = *method;
  PetscCallStickslip(stickslip_options_method(&interface->options, &interface->otherwise));
  interface->conserves = (PetscBool)(contact->physics->dynamics && is_open);
  if (interface->conserves) method->weights = STICKSLIP_WEIGHTS_CONSERVING;
  PetscCallStickslip(stickslip_options_method(&interface->options, method));
  if (interface->conserves && lags) yield_to(interface, "`normals: committed` are not of now");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a support turn the analytic mortar side? */
static PetscErrorCode frame_turns(const Contact *contact, const Interface *interface, PetscBool *turns)
{
  const Physics *physics = contact->physics;
  const PetscInt number  = interface->body[1];
  const Body    *body    = &contact->mesh->bodies[number];
  PetscFunctionBegin;
  *turns = PETSC_FALSE;
  for (PetscInt s = 0; s < physics->n_supports && body->analytic; s++) {
    const Support  *support = &physics->supports[s];
    const PetscReal w[3]    = {support->rotate[0], support->rotate[1], support->rotate[2]};
    PetscBool       of      = (PetscBool)(support->rigid >= 0 && physics->rigids[support->rigid].body == number);
    for (PetscInt k = 0; k < support->n_vertices; k++)
      of = (PetscBool)(of || (support->vertices[k] >= body->first_here && support->vertices[k] < body->end_here));
    *turns = (PetscBool)(*turns || (of && (w[0] != 0 || w[1] != 0 || w[2] != 0)));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, turns, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode conserving_look(const Contact *contact, Interface *interface)
{
  PetscBool turns;
  PetscFunctionBegin;
  if (!interface->conserves) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(frame_turns(contact, interface, &turns));
  if (turns) yield_to(interface, "a support turns the analytic mortar side");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool conserving_yields(Contact *contact, Interface *interface)
{
  if (!interface->conserves) return PETSC_FALSE;
  yield_to(interface, contact->refusal);
  contact->refusal[0] = 0;
  return PETSC_TRUE;
}
