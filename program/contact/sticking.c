/* Coulomb friction so large, for a while, that what touches sticks: a first phase of a step (newton.c). A body that friction alone
 * holds has no stiffness along the surface where all its nodes are taken to slip; where they stick it has. */
#include "contact/contact.h"

/* Nothing slips under this coefficient, but for nodes that are about to open. */
static const PetscReal STICKS = 1e6;

static PetscBool can_stick(const Interface *interface)
{
  return (PetscBool)(!interface->skin && interface->options.friction == STICKSLIP_FRICTION_COULOMB && interface->law.kind == STICKSLIP_LAW_COULOMB &&
                     interface->options.mu > 0);
}

PetscBool sticking_possible(const Contact *contact)
{
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    if (can_stick(&contact->interfaces[i])) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Of any handle of the interface's part: the friction of the phase, or the scene's. */
int32_t sticking_set(const Contact *contact, const Interface *interface, stickslip_interface *handle)
{
  const PetscInt n = interface->part.n1;
  double        *mu;
  int32_t        status;
  if (!can_stick(interface)) return STICKSLIP_OK;
  PetscCallAbort(PETSC_COMM_SELF, PetscMalloc1(n, &mu));
  for (PetscInt a = 0; a < n; a++)
    mu[a] = contact->sticks ? STICKS : interface->options.mu;
  status = stickslip_interface_set_friction(handle, mu);
  PetscCallAbort(PETSC_COMM_SELF, PetscFree(mu));
  return status;
}

/* For the evaluations that come. */
PetscErrorCode sticking_use(Contact *contact, PetscBool sticks)
{
  PetscFunctionBegin;
  contact->sticks = sticks;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    stickslip_interface *handle = contact->interfaces[i].part.handle;
    if (handle) PetscCallStickslip(sticking_set(contact, &contact->interfaces[i], handle));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
