/* The binding to the contact library. Each rank drives its part of an interface: positions and multipliers of the part's
 * nodes are gathered from their owners, forces are sent back and added. */
#include "contact/contact.h"

/* All ranks learn whether the library refused on any. The first of these says why, in the interface's numbers. */
PetscErrorCode contact_agree(Contact *contact, const Interface *interface, int32_t refused, PetscInt *status)
{
  struct {
    int refuses_not, rank;
  } first = {.refuses_not = !refused, .rank = contact->mesh->rank};
  PetscFunctionBegin;
  *status = refused;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_2INT, MPI_MINLOC, PETSC_COMM_WORLD));
  if (first.refuses_not) PetscFunctionReturn(PETSC_SUCCESS);
  if (contact->mesh->rank == first.rank)
    parts_translate(&interface->part, stickslip_last_error_message(), contact->refusal, sizeof(contact->refusal));
  PetscCallMPI(MPI_Bcast(status, 1, MPIU_INT, first.rank, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(contact->refusal, sizeof(contact->refusal), MPI_CHAR, first.rank, PETSC_COMM_WORLD));
  PetscCheck(*status >= 0, PETSC_COMM_WORLD, PETSC_ERR_LIB, "stickslip is at fault: %s", contact->refusal);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Current positions, from the part's origin. */
void contact_positions(ContactPart *part)
{
  const PetscInt d = part->dimension;
  for (PetscInt k = 0; k < d * (part->n1 + part->n2); k++)
    part->x[k] = part->X[k] - part->origin[k % d] + PetscRealPart(part->gathered[k]);
}

void contact_vector(PetscInt dimension, const PetscScalar vectors[], PetscInt node, PetscReal v[3])
{
  for (int i = 0; i < 3; i++)
    v[i] = i < dimension ? PetscRealPart(vectors[dimension * node + i]) : 0;
}

/* Entries of local vectors, each as its owner has it. */
PetscErrorCode contact_fetch(PetscSF sf, Vec local, PetscScalar *to)
{
  const PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(local, &array));
  PetscCall(PetscSFBcastBegin(sf, MPIU_SCALAR, array, to, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_SCALAR, array, to, MPI_REPLACE));
  PetscCall(VecRestoreArrayRead(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_gather(Contact *contact, Interface *interface, Vec local)
{
  ContactPart *part = &interface->part;
  PetscFunctionBegin;
  PetscCall(contact_fetch(part->sf, local, part->gathered));
  contact_positions(part);
  if (contact->condensed)
    PetscCall(PetscArraycpy(MULTIPLIERS_OF(part, part->gathered), part->lambda, part->components * part->n1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_scatter(const ContactPart *part, const PetscScalar *from, Vec local, MPI_Op operation)
{
  PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArray(local, &array));
  PetscCall(PetscSFReduceBegin(part->sf, MPIU_SCALAR, from, array, operation));
  PetscCall(PetscSFReduceEnd(part->sf, MPIU_SCALAR, from, array, operation));
  PetscCall(VecRestoreArray(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the forces of all parts to f_local, and their squares, once a node, to those of the model's parts. */
static PetscErrorCode add_forces(Physics *physics, const ContactPart *part, Vec f_local)
{
  const PetscInt d = part->dimension;
  PetscScalar   *total;
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(physics->f_sum));
  PetscCall(contact_scatter(part, part->forces, physics->f_sum, MPIU_SUM));
  PetscCall(PetscMalloc1(d * (part->n1 + part->n2) + part->components * part->n1, &total));
  PetscCall(contact_fetch(part->sf, physics->f_sum, total));
  for (PetscInt k = 0; k < d * (part->n1 + part->n2); k++) {
    if (part->counts[k / d])
      physics->parts.squares[N_SQUARES * part->piece[k / d] + SQUARES_CONTACT] += PetscSqr(PetscAbsScalar(total[k]));
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
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    if (part->handle)
      refused = stickslip_interface_residual(part->handle, STATE_OF(part), NULL, part->forces,
                                             MORTAR_OF(part, part->forces), MULTIPLIERS_OF(part, part->forces));
    PetscCall(contact_agree(contact, interface, refused, status));
    if (!*status) PetscCall(add_forces(contact->physics, part, f_local));
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
    if (part->handle && interface->initial_contact)
      refused = stickslip_interface_initial_multipliers(part->handle, MULTIPLIERS_OF(part, part->gathered));
    PetscCall(contact_agree(contact, interface, refused, status));
    PetscCall(parts_share(part, part->components, MULTIPLIERS_OF(part, part->gathered)));
    if (!*status) PetscCall(contact_scatter(part, part->gathered, physics->u_local, MPI_REPLACE));
  }
  PetscCall(DMLocalToGlobalBegin(mesh->dm, physics->u_local, INSERT_VALUES, x));
  PetscCall(DMLocalToGlobalEnd(mesh->dm, physics->u_local, INSERT_VALUES, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_step_limit(Contact *contact, Interface *interface, Vec step, PetscReal depth, PetscReal *fraction)
{
  ContactPart *part = &interface->part;
  PetscReal    answer[2] = {1, 1}; /* the fraction, and 0 where the library refuses */
  PetscScalar *dx;

  PetscFunctionBegin;
  PetscCall(contact_gather(contact, interface, contact->physics->u_local));
  PetscCall(PetscMalloc1(part->dimension * (part->n1 + part->n2) + part->components * part->n1, &dx));
  PetscCall(contact_fetch(part->sf, step, dx));
  if (part->handle && stickslip_interface_step_limit(part->handle, part->x, MORTAR_OF(part, part->x), dx,
                                                     MORTAR_OF(part, dx), depth, &answer[0]))
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
  if (part->handle && !refused) {
    refused = stickslip_interface_commit(part->handle, STATE_OF(part), NULL);
    *done   = (PetscBool)!refused;
  }
  PetscCall(contact_agree(contact, interface, refused, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All interfaces accept the step on all ranks, or none: what was committed beside a refusal is rolled back. */
PetscErrorCode contact_commit(Contact *contact, PetscInt *status)
{
  PetscBool *done;
  PetscFunctionBegin;
  *status = 0;
  PetscCall(PetscCalloc1(contact->n_interfaces, &done));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++)
    PetscCall(commit(contact, &contact->interfaces[i], &done[i], status));
  for (PetscInt i = 0; i < contact->n_interfaces && *status; i++) {
    if (done[i]) PetscCallStickslip(stickslip_interface_rollback(contact->interfaces[i].part.handle));
  }
  PetscCall(PetscFree(done));
  PetscFunctionReturn(PETSC_SUCCESS);
}
