/* The binding to the contact library. Rank 0 drives it: positions and multipliers of the interface's nodes are gathered
 * there, forces are sent back and added, tangent entries go into the matrix by their equation numbers. */
#include "contact/contact.h"

/* All ranks learn whether the library refused on rank 0; its message is kept for the report. */
PetscErrorCode contact_agree(Contact *contact, int32_t refused, PetscInt *status)
{
  PetscFunctionBegin;
  *status = refused;
  if (contact->mesh->rank == 0 && refused)
    PetscCall(PetscSNPrintf(contact->refusal, sizeof(contact->refusal), "%s", stickslip_last_error_message()));
  PetscCallMPI(MPI_Bcast(status, 1, MPIU_INT, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(contact->refusal, sizeof(contact->refusal), MPI_CHAR, 0, PETSC_COMM_WORLD));
  PetscCheck(*status >= 0, PETSC_COMM_WORLD, PETSC_ERR_LIB, "stickslip is at fault: %s", contact->refusal);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Current positions, from the interface's first node: far from the origin X + u would round u away. A radius counts from
 * the axis. */
void contact_positions(Interface *interface)
{
  const PetscInt  d    = interface->dimension;
  const PetscBool ring = (PetscBool)(interface->options.model == STICKSLIP_MODEL_AXISYMMETRIC);
  for (PetscInt k = 0; k < d * (interface->n1 + interface->n2); k++)
    interface->x[k] = interface->X[k] - (ring && k % d == 0 ? 0 : interface->X[k % d]) + PetscRealPart(interface->gathered[k]);
}

void contact_vector(const Interface *interface, const PetscScalar vectors[], PetscInt node, PetscReal v[3])
{
  for (int i = 0; i < 3; i++)
    v[i] = i < interface->dimension ? PetscRealPart(vectors[interface->dimension * node + i]) : 0;
}

/* The interface's entries of a local vector, each as its owner has it, to rank 0. */
PetscErrorCode contact_fetch(const Interface *interface, Vec local, PetscScalar *to)
{
  const PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(local, &array));
  PetscCall(PetscSFBcastBegin(interface->sf, MPIU_SCALAR, array, to, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(interface->sf, MPIU_SCALAR, array, to, MPI_REPLACE));
  PetscCall(VecRestoreArrayRead(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_gather(Contact *contact, Interface *interface, Vec local)
{
  PetscFunctionBegin;
  PetscCall(contact_fetch(interface, local, interface->gathered));
  if (contact->mesh->rank == 0) contact_positions(interface);
  if (contact->mesh->rank == 0 && contact->condensed)
    PetscCall(PetscArraycpy(MULTIPLIERS_OF(interface, interface->gathered), interface->lambda,
                            interface->components * interface->n1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_scatter(Interface *interface, const PetscScalar *from, Vec local, MPI_Op operation)
{
  PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArray(local, &array));
  PetscCall(PetscSFReduceBegin(interface->sf, MPIU_SCALAR, from, array, operation));
  PetscCall(PetscSFReduceEnd(interface->sf, MPIU_SCALAR, from, array, operation));
  PetscCall(VecRestoreArray(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_forces(Contact *contact, Vec f_local, PetscInt *status)
{
  Physics *physics = contact->physics;
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(contact, interface, physics->u_local));
    if (contact->mesh->rank == 0) {
      PetscScalar   *f = interface->forces;
      const PetscInt d = interface->dimension;
      refused = stickslip_interface_residual(interface->handle, STATE_OF(interface), NULL, f, MORTAR_OF(interface, f),
                                             MULTIPLIERS_OF(interface, f));
      for (PetscInt k = 0; k < d * (interface->n1 + interface->n2) && !refused; k++)
        physics->parts.squares[N_SQUARES * physics->parts.of_mesh[interface->nodes[k / d]] + SQUARES_CONTACT] +=
            PetscSqr(PetscAbsScalar(interface->forces[k]));
    }
    PetscCall(contact_agree(contact, refused, status));
    if (!*status) PetscCall(contact_scatter(interface, interface->forces, f_local, MPIU_SUM));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode reserve(Interface *interface, int64_t count)
{
  PetscFunctionBegin;
  if (count > interface->coo_capacity) {
    interface->coo_capacity = count + count / 4;
    PetscCall(PetscFree3(interface->coo_rows, interface->coo_columns, interface->coo_values));
    PetscCall(PetscMalloc3(interface->coo_capacity, &interface->coo_rows, interface->coo_capacity,
                           &interface->coo_columns, interface->coo_capacity, &interface->coo_values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do n entries lie in one column, and in the rows of the n entries at the head of their block? */
static PetscBool repeats(const int64_t *head, const int64_t *rows, const int64_t *columns, PetscInt n)
{
  for (PetscInt i = 0; i < n; i++) {
    if (rows[i] != head[i] || columns[i] != columns[0]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Entries of a plan come row after row, those of a piece block after block, each by columns: one call for a row or a block,
 * which ends where its rows do not repeat. */
static PetscErrorCode insert(const Interface *interface, int64_t count, const double *values, Mat matrix)
{
  enum { LONGEST = 64 };
  static const double zeros[LONGEST * LONGEST];
  PetscInt            rows[LONGEST], columns[LONGEST], n, m;

  PetscFunctionBegin;
  for (int64_t k = 0; k < count; k += (int64_t)n * m) {
    const int64_t *r = interface->coo_rows + k, *c = interface->coo_columns + k, left = count - k;
    for (n = 0; n < LONGEST && n < left && c[n] == c[0]; n++)
      rows[n] = (PetscInt)r[n];
    for (m = 0; m < LONGEST && n * (m + 1) <= left && (!m || repeats(r, r + n * m, c + n * m, n)); m++)
      columns[m] = (PetscInt)c[n * m];
    PetscCall(MatSetValues(matrix, n, rows, m, columns, values ? values + k : zeros, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which entries the tangent has here; kept until values lack one. */
static PetscErrorCode plan(Interface *interface, int32_t pairs, int32_t *refused)
{
  int64_t n_rows;

  PetscFunctionBegin;
  *refused = stickslip_interface_plan(interface->handle, interface->x, MORTAR_OF(interface, interface->x), pairs, &n_rows,
                                      &interface->planned);
  if (*refused) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(reserve(interface, interface->planned));
  *refused = stickslip_interface_plan_coo(interface->handle, STICKSLIP_ENTRIES_TANGENT, interface->coo_capacity,
                                          interface->coo_rows, interface->coo_columns);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which entries the forces of a condensed system have, with pairs that may come: into the arrays, and their number. */
static PetscErrorCode condensed_plan(Interface *interface, int64_t *count)
{
  int64_t rows[2], counts[2];
  PetscFunctionBegin;
  PetscCallStickslip(stickslip_interface_condensed_plan(interface->handle, interface->x, MORTAR_OF(interface, interface->x),
                                                        STICKSLIP_PLAN_SKIN, rows, counts));
  *count = counts[0];
  if (!*count) PetscFunctionReturn(PETSC_SUCCESS); /* with frozen weights forces do not depend on displacements */
  PetscCall(reserve(interface, *count));
  PetscCallStickslip(stickslip_interface_plan_coo(interface->handle, STICKSLIP_ENTRIES_FORCES, interface->coo_capacity,
                                                  interface->coo_rows, interface->coo_columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int32_t plan_values(Interface *interface)
{
  return stickslip_interface_plan_values(interface->handle, STATE_OF(interface), NULL, interface->coo_capacity,
                                         interface->coo_values);
}

/* Where pairs have come that the plan does not have, one of the pairs of now takes its place. */
static PetscErrorCode tangent(Interface *interface, int32_t *refused)
{
  PetscFunctionBegin;
  *refused = interface->planned ? plan_values(interface) : STICKSLIP_MISSING_ENTRY;
  if (*refused == STICKSLIP_MISSING_ENTRY) {
    PetscCall(plan(interface, STICKSLIP_PLAN_ACTIVE, refused));
    if (!*refused) *refused = plan_values(interface);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int32_t entries(Interface *interface, int32_t piece, int64_t capacity, int64_t *rows, int64_t *columns,
                       double *values, int64_t *count)
{
  return stickslip_interface_condensed_coo(interface->handle, STATE_OF(interface), piece, capacity, rows, columns, values,
                                           count);
}

/* A piece into the arrays as they are; counted first where they turn out too small. */
PetscErrorCode contact_entries(Interface *interface, int32_t piece, int64_t *count, int32_t *refused)
{
  PetscFunctionBegin;
  *refused = STICKSLIP_BUFFER_TOO_SMALL;
  for (int attempt = 0; attempt < 2 && *refused == STICKSLIP_BUFFER_TOO_SMALL; attempt++) {
    if (attempt || !interface->coo_capacity) {
      *refused = entries(interface, piece, 0, NULL, NULL, NULL, count);
      if (*refused) break;
      PetscCall(reserve(interface, *count));
    }
    *refused = entries(interface, piece, interface->coo_capacity, interface->coo_rows, interface->coo_columns,
                       interface->coo_values, count);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a condensed system what the forces depend on the displacements by; condensed_matrix() does the rest. */
PetscErrorCode contact_tangent(Contact *contact, Mat matrix, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  PetscCall(MatSetOption(matrix, MAT_ROW_ORIENTED, PETSC_FALSE)); /* as insert() has them; all ranks must call this */
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    int32_t    refused   = 0;
    int64_t    count     = 0;
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    if (contact->mesh->rank == 0) {
      if (contact->condensed) {
        PetscCall(contact_entries(interface, STICKSLIP_CONDENSED_FORCES, &count, &refused));
      } else {
        PetscCall(tangent(interface, &refused));
        count = interface->planned;
      }
      if (!refused) PetscCall(insert(interface, count, interface->coo_values, matrix));
    }
    PetscCall(contact_agree(contact, refused, status));
  }
  PetscCall(MatSetOption(matrix, MAT_ROW_ORIENTED, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With the pairs that may come while the surfaces slide by less than a quarter of a facet. Of a condensed system what is
 * inserted before it is condensed; condensed_matrix() makes a pattern of its own of it. */
PetscErrorCode contact_pattern(Contact *contact, Mat matrix)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    int32_t    refused;
    int64_t    count;
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    if (contact->mesh->rank) continue;
    if (contact->condensed) {
      PetscCall(condensed_plan(interface, &count));
    } else {
      PetscCall(plan(interface, STICKSLIP_PLAN_SKIN, &refused));
      PetscCallStickslip(refused);
      count = interface->planned;
    }
    PetscCall(insert(interface, count, NULL, matrix));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What plans hold beyond the pairs of now would come into a matrix that has not got it. */
void contact_forget_plans(Contact *contact)
{
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    contact->interfaces[i].planned = 0;
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
    Interface *interface = &contact->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(contact, interface, physics->u_local));
    if (mesh->rank == 0 && interface->initial_contact)
      refused = stickslip_interface_initial_multipliers(interface->handle, MULTIPLIERS_OF(interface, interface->gathered));
    PetscCall(contact_agree(contact, refused, status));
    if (!*status) PetscCall(contact_scatter(interface, interface->gathered, physics->u_local, MPI_REPLACE));
  }
  PetscCall(DMLocalToGlobalBegin(mesh->dm, physics->u_local, INSERT_VALUES, x));
  PetscCall(DMLocalToGlobalEnd(mesh->dm, physics->u_local, INSERT_VALUES, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before the commit: with the weights of now beside those of t_n, where both are needed. */
static int32_t measure_memory(Interface *interface)
{
  stickslip_counters counters = {.struct_size = sizeof(counters)};
  const int32_t      status   = stickslip_interface_counters(interface->handle, &counters);
  interface->bytes            = PetscMax(interface->bytes, counters.bytes);
  return status;
}

/* rank 0, of a converged step of a condensed system: the multipliers are the projected tractions, from which they differ by rounding of the
 * bodies' forces. Nodes that slip are then on the cone to the last digits, and the next step does not begin with guesses
 * of who sticks. */
static int32_t settle_multipliers(Interface *interface)
{
  stickslip_states wanted = {.struct_size = sizeof(wanted), .traction = interface->rows, .normal = interface->host};
  const int32_t    status = stickslip_interface_states(interface->handle, STATE_OF(interface), NULL, &wanted);
  const PetscInt   d      = interface->dimension;
  for (PetscInt a = 0; a < interface->n1 && !status; a++) {
    PetscReal p[3], n[3];
    contact_vector(interface, interface->rows, a, p);
    contact_vector(interface, interface->host, a, n);
    if (interface->components > 1)
      PetscCallAbort(PETSC_COMM_SELF, PetscArraycpy(interface->lambda + d * a, p, d));
    else
      interface->lambda[a] = p[0] * n[0] + p[1] * n[1] + p[2] * n[2];
  }
  return status;
}

/* All interfaces accept the step, or none: what was committed before a refusal is rolled back. */
PetscErrorCode contact_commit(Contact *contact, PetscInt *status)
{
  const Mesh *mesh      = contact->mesh;
  PetscInt    committed = 0;
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    if (mesh->rank == 0) refused = measure_memory(interface);
    if (mesh->rank == 0 && !refused && contact->condensed) refused = settle_multipliers(interface);
    if (contact->condensed) PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    if (mesh->rank == 0 && !refused)
      refused = stickslip_interface_commit(interface->handle, STATE_OF(interface), NULL);
    PetscCall(contact_agree(contact, refused, status));
    if (!*status) committed++;
  }
  for (PetscInt i = 0; i < committed && *status && mesh->rank == 0; i++)
    PetscCallStickslip(stickslip_interface_rollback(contact->interfaces[i].handle));
  PetscFunctionReturn(PETSC_SUCCESS);
}
