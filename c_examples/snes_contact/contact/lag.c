/* With normals of t_n a pressure acts along those although a step has turned the surface. Where that shows, a converged step is solved again
 * with the normals that it has reached, as the host's own (stickslip_interface_set_normals), and again, until they stay. Each solution
 * begins at the last one and takes few iterations. What the library knows of normals at a place is what a commit there would make of them: it
 * is asked so, and the commit rolled back. */
#include "contact/contact.h"

/* Part of the forces that normals may still be wrong by: so much less than is told that friction, which may be a tenth of the pressure, is
 * right to what is told. */
static const PetscReal LEFT = 1e-3;
/* A lag from which a step is solved again: what is told. */
static const PetscReal LAGS = 0.01;

/* Do its normals follow, could others, and are they for this interface wrong by more than they may? Where it solves in time, normals of t_n are
 * part of what keeps the energy (docs/dynamics.md). */
static PetscBool may_be_corrected(const Contact *contact, const Interface *interface)
{
  const stickslip_options *options = &interface->options;
  return (PetscBool)(interface->lag_corrects && !contact->physics->dynamics && options->friction != STICKSLIP_FRICTION_TIED &&
                     options->normals == STICKSLIP_NORMALS_COMMITTED && options->weights != STICKSLIP_WEIGHTS_REFERENCE);
}

/* At a converged state that the interfaces have been judged at. */
PetscErrorCode lag_wants_correction(const Contact *contact, PetscBool *wants)
{
  PetscReal forces[2];
  PetscFunctionBegin;
  *wants = PETSC_FALSE;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface             *interface = &contact->interfaces[i];
    const stickslip_equilibrium *e         = &interface->equilibrium;
    if (!may_be_corrected(contact, interface)) continue;
    if (interface->normals) {
      *wants = (PetscBool)(*wants || interface->lag_left > LEFT);
      continue;
    }
    forces[0] = interface->part.handle ? e->lag_force : 0;
    forces[1] = interface->part.handle ? e->lag_force_scale : 0;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, forces, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    *wants = (PetscBool)(*wants || forces[0] > LAGS * forces[1] || (interface->part.handle && e->lag > LAGS * e->traction_scale));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, wants, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a part: normals of now, in place of `normals`, and what these are wrong by: sums of the tractions times the change, and of the tractions, by
 * area. Returns the library's status. */
static int32_t find(ContactPart *part, double normals[], PetscReal sums[2])
{
  stickslip_interface *handle = part->handle;
  const PetscInt       d = part->dimension, n1 = part->n1;
  stickslip_states     used = {.struct_size = sizeof(used)}, now = {.struct_size = sizeof(now)};
  int32_t              status;
  PetscCallAbort(PETSC_COMM_SELF, PetscMalloc3(d * n1, &used.normal, d * n1, &used.traction, n1, &used.coverage));
  now.normal = normals;
  status     = stickslip_interface_states(handle, STATE_OF(part), NULL, &used);
  if (!status) status = stickslip_interface_commit(handle, STATE_OF(part), NULL);
  if (!status) {
    status = stickslip_interface_set_normals(handle, NULL);
    if (!status) status = stickslip_interface_states(handle, STATE_OF(part), NULL, &now);
    PetscCallStickslip(stickslip_interface_rollback(handle));
  }
  for (PetscInt a = 0; a < n1 && !status; a++) {
    double p[3], before[3], after[3], change = 0, traction = 0;
    contact_vector(d, used.traction, a, p);
    contact_vector(d, used.normal, a, before);
    contact_vector(d, normals, a, after);
    for (int k = 0; k < 3; k++) {
      traction += p[k] * p[k];
      change += (after[k] - before[k]) * (after[k] - before[k]);
    }
    if (part->owned[a] != STICKSLIP_NODE_OWN) continue;
    sums[0] += PetscSqrtReal(traction * change) * used.coverage[a];
    sums[1] += PetscSqrtReal(traction) * used.coverage[a];
  }
  PetscCallAbort(PETSC_COMM_SELF, PetscFree3(used.normal, used.traction, used.coverage));
  return status;
}

/* Of any handle of the interface's part: the normals of the step, from homes. */
PetscErrorCode lag_set(const Interface *interface, stickslip_interface *handle, int32_t *refused)
{
  const ContactPart *part = &interface->part;
  const PetscInt     d    = part->dimension;
  double            *normals;
  PetscFunctionBegin;
  *refused = 0;
  if (!interface->normals) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(d * part->n1, &normals));
  PetscCall(parts_send(part, d, interface->normals, normals));
  PetscCall(parts_share(part, d, normals));
  if (handle) *refused = stickslip_interface_set_normals(handle, normals);
  PetscCall(PetscFree(normals));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At a converged state: normals of now for what comes, on all ranks. `done`: they have been found; else all is as it was. */
PetscErrorCode lag_take_normals(Contact *contact, PetscBool *done)
{
  PetscInt refused = 0;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces && !refused; i++) {
    Interface   *interface = &contact->interfaces[i];
    ContactPart *part      = &interface->part;
    PetscReal    sums[2]   = {0, 0};
    double      *normals;
    int32_t      status = 0;
    if (!may_be_corrected(contact, interface)) continue;
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    PetscCall(PetscCalloc1(part->dimension * part->n1, &normals));
    if (part->handle) status = find(part, normals, sums);
    PetscCall(contact_agree(contact, interface, status, &refused));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    if (!refused) {
      if (!interface->normals) PetscCall(PetscMalloc1(part->dimension * interface->n1, &interface->normals));
      PetscCall(parts_collect(part, part->dimension, normals, interface->normals));
      interface->lag_left = sums[1] > 0 ? sums[0] / sums[1] : 0;
    }
    PetscCall(PetscFree(normals));
    PetscCall(lag_set(interface, part->handle, &status));
    PetscCheck(!status, PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s", stickslip_last_error_message());
  }
  *done = (PetscBool)!refused;
  contact->refusal[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step is over: normals of t_n from now on. */
PetscErrorCode lag_forget(Contact *contact)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    if (!interface->normals) continue;
    PetscCall(PetscFree(interface->normals));
    interface->lag_left = 0;
    if (interface->part.handle) PetscCallStickslip(stickslip_interface_set_normals(interface->part.handle, NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
