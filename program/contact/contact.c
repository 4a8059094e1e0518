/* The binding to the contact library. Each rank drives its part of an interface: positions and multipliers of the part's
 * nodes are gathered from their owners, forces are sent back and added. */
#include "contact/skin.h"

/* Adds the forces of all parts to f_local, and once a node their squares to those of the model's parts, and what passes between the sides. */
static PetscErrorCode add_forces(Physics *physics, Interface *interface, Vec f_local)
{
  ContactPart   *part = &interface->part;
  const PetscInt d    = part->dimension;
  PetscScalar   *total;
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(interface->between, 4));
  PetscCall(VecZeroEntries(physics->f_sum));
  PetscCall(contact_scatter(part, part->forces, physics->f_sum, MPIU_SUM));
  PetscCall(PetscMalloc1(d * (part->n1 + part->n2) + part->components * part->n1, &total));
  PetscCall(contact_fetch(part->sf, physics->f_sum, total));
  for (PetscInt k = 0; k < d * (part->n1 + part->n2); k++) {
    if (!part->counts[k / d]) continue;
    physics->parts.squares[N_SQUARES * part->piece[k / d] + SQUARES_CONTACT] += PetscSqr(PetscAbsScalar(total[k]));
    interface->between[k % d] += PetscRealPart(total[k]);
    interface->between[3] += PetscAbsScalar(total[k]);
  }
  PetscCall(PetscFree(total));
  PetscCall(VecAXPY(f_local, 1, physics->f_sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_forces(Contact *contact, Vec f_local, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface   *interface = &contact->interfaces[i];
    ContactPart *part      = &interface->part;
    int32_t      refused   = 0;
    PetscCall(contact_renew(contact, i, NULL, status));
    if (*status) break;
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    part->processor -= work_clock();
    refused = verb_residual(part);
    part->processor += work_clock();
    PetscCall(contact_agree(contact, interface, refused, status));
    if (!*status) PetscCall(add_forces(contact->physics, interface, f_local));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A slightly compressive multiplier on nodes that touch: without it a body held by contact alone starts without support. */
PetscErrorCode contact_start(Contact *contact, Vec x, PetscInt *status)
{
  const Mesh *mesh    = contact->mesh;
  Physics    *physics = contact->physics;
  PetscFunctionBegin;
  *status = 0;
  PetscCall(unknowns_to_local(physics, x));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface   *interface = &contact->interfaces[i];
    ContactPart *part      = &interface->part;
    int32_t      refused   = 0;
    PetscCall(contact_gather(contact, interface, physics->u_local));
    if (interface->initial_contact) refused = verb_initial_multipliers(part, MULTIPLIERS_OF(part, part->gathered));
    PetscCall(contact_agree(contact, interface, refused, status));
    if (!*status) PetscCall(kept_tell(contact, interface));
    if (!*status) PetscCall(chords_tell(interface));
    PetscCall(parts_share(part, part->components, MULTIPLIERS_OF(part, part->gathered)));
    if (!*status) PetscCall(contact_scatter(part, part->gathered, physics->u_local, MPI_REPLACE));
  }
  PetscCall(DMLocalToGlobalBegin(mesh->dm, physics->u_local, INSERT_VALUES, x));
  PetscCall(DMLocalToGlobalEnd(mesh->dm, physics->u_local, INSERT_VALUES, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The way of the step must be within the halo. Where it has to grow for that, the forces of the last evaluation are found again. */
static PetscErrorCode renew_on_the_way(Contact *contact, PetscInt number, Vec step, int32_t *refused)
{
  ContactPart   *part   = &contact->interfaces[number].part;
  const PetscInt before = contact->interfaces[number].n_grown;
  PetscInt       status;
  Vec            to;
  PetscFunctionBegin;
  PetscCall(DMGetLocalVector(contact->mesh->dm, &to));
  PetscCall(VecWAXPY(to, 1, contact->physics->u_local, step));
  PetscCall(contact_renew(contact, number, to, &status));
  PetscCall(DMRestoreLocalVector(contact->mesh->dm, &to));
  *refused = (int32_t)status;
  PetscCall(contact_gather(contact, &contact->interfaces[number], contact->physics->u_local));
  if (*refused || before == contact->interfaces[number].n_grown) PetscFunctionReturn(PETSC_SUCCESS);
  *refused = verb_residual(part);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_step_limit(Contact *contact, PetscInt number, Vec step, PetscReal depth, PetscReal *fraction)
{
  ContactPart *part = &contact->interfaces[number].part;
  PetscReal    answer[2] = {1, 1}; /* the fraction, and 0 where the library refuses */
  PetscScalar *dx;
  int32_t      refused = 0;

  PetscFunctionBegin;
  PetscCall(renew_on_the_way(contact, number, step, &refused));
  PetscCall(PetscMalloc1(part->dimension * (part->n1 + part->n2) + part->components * part->n1, &dx));
  PetscCall(contact_fetch(part->sf, step, dx));
  if (refused || verb_step_limit(part, dx, depth, &answer[0]))
    answer[1] = 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, answer, 2, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  PetscCall(PetscFree(dx));
  /* Where the library refuses, so it will the evaluation that follows, and this attempt ends there. */
  *fraction = answer[1] > 0 ? answer[0] : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before the commit: with the weights of now beside those of t_n, where both are needed. */
static int32_t measure_memory(ContactPart *part)
{
  stickslip_counters counters = {.struct_size = sizeof(counters)};
  const int32_t      status   = stickslip_interface_counters(part->handle, &counters);
  part->bytes                 = PetscMax(part->bytes, counters.bytes);
  return status;
}

/* Of a converged step of a condensed system: the multipliers are the projected tractions, from which they differ by
 * rounding of the bodies' forces. Nodes that slip are then on the cone to the last digits, and the next step does not begin
 * with guesses of who sticks. */
static int32_t settle_multipliers(ContactPart *part)
{
  stickslip_states wanted = {.struct_size = sizeof(wanted), .traction = part->rows, .normal = part->host};
  const int32_t    status = stickslip_interface_states(part->handle, STATE_OF(part), NULL, &wanted);
  const PetscInt   d      = part->dimension;
  for (PetscInt a = 0; a < part->n1 && !status; a++) {
    PetscReal p[3], n[3];
    contact_vector(d, part->rows, a, p);
    contact_vector(d, part->host, a, n);
    if (part->components > 1)
      PetscCallAbort(PETSC_COMM_SELF, PetscArraycpy(part->lambda + d * a, p, d));
    else
      part->lambda[a] = p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
  }
  return status;
}

/* The slip that the commit is about to take over, into `rows`: settle() copies it. */
static int32_t keep_slip(ContactPart *part)
{
  stickslip_states wanted = {.struct_size = sizeof(wanted), .slip = part->rows};
  return stickslip_interface_states(part->handle, STATE_OF(part), NULL, &wanted);
}

/* t_n is u_local. */
static PetscErrorCode settle(Contact *contact)
{
  PetscFunctionBegin;
  contact->t_committed = contact->physics->t;
  contact->n_commits++;
  PetscCall(VecCopy(contact->physics->u_local, contact->committed));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface   *interface = &contact->interfaces[i];
    ContactPart *part      = &interface->part;
    if (interface->n_parts < 2) continue;
    PetscCall(PetscArraycpy(part->slip, part->rows, part->dimension * part->n1));
    PetscCall(parts_share(part, part->dimension, part->slip));
    PetscCallStickslip(law_keep(interface, part));
    if (interface->n_states) PetscCall(parts_share(part, interface->n_states, part->way));
    if (interface->halo.n_places) PetscCall(halo_settle(contact, interface));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Commits one interface on all ranks, or tells that one of them refuses; `done`: this rank has. */
static PetscErrorCode commit(Contact *contact, Interface *interface, PetscBool *done, PetscInt *status)
{
  ContactPart *part    = &interface->part;
  int32_t      refused = 0;
  PetscFunctionBegin;
  PetscCall(contact_gather(contact, interface, contact->physics->u_local));
  if (part->handle) refused = measure_memory(part);
  if (part->handle && !refused && contact->condensed) refused = settle_multipliers(part);
  if (contact->condensed) {
    PetscCall(parts_share(part, part->components, part->lambda));
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
  }
  if (part->handle && !refused && interface->n_parts > 1) refused = keep_slip(part);
  part->processor -= work_clock();
  if (verb_there(part) && !refused) {
    refused = verb_commit(part);
    *done   = (PetscBool)!refused;
  }
  part->processor += work_clock();
  PetscCall(contact_agree(contact, interface, refused, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All interfaces accept the step on all ranks, or none: what was committed beside a refusal is rolled back. */
PetscErrorCode contact_commit(Contact *contact, Vec x, PetscInt *status)
{
  PetscBool *done;
  PetscFunctionBegin;
  *status = 0;
  PetscCall(PetscCalloc1(contact->n_interfaces, &done));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++)
    PetscCall(commit(contact, &contact->interfaces[i], &done[i], status));
  for (PetscInt i = 0; i < contact->n_interfaces && *status; i++) {
    if (done[i]) PetscCallStickslip(verb_rollback(&contact->interfaces[i].part));
  }
  if (!*status) PetscCall(settle(contact));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    if (contact->interfaces[i].skin) PetscCall(skin_hand_over(contact, &contact->interfaces[i], x));
  }
  PetscCall(PetscFree(done));
  PetscFunctionReturn(PETSC_SUCCESS);
}
