/* The binding to the contact library. Rank 0 drives it: positions and multipliers of the interface's nodes are gathered
 * there, forces are sent back and added, tangent entries go into the matrix by their equation numbers. */
#include "model.h"

/* All ranks learn whether the library refused on rank 0; its message is kept for the report. */
PetscErrorCode contact_agree(Model *model, int32_t refused, PetscInt *status)
{
  PetscFunctionBegin;
  *status = refused;
  if (model->rank == 0 && refused)
    PetscCall(PetscSNPrintf(model->refusal, sizeof(model->refusal), "%s", stickslip_last_error_message()));
  PetscCallMPI(MPI_Bcast(status, 1, MPIU_INT, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(model->refusal, sizeof(model->refusal), MPI_CHAR, 0, PETSC_COMM_WORLD));
  PetscCheck(*status >= 0, PETSC_COMM_WORLD, PETSC_ERR_LIB, "stickslip is at fault: %s", model->refusal);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Current positions, from the interface's first node: far from the origin X + u would round u away. */
void contact_positions(Interface *interface)
{
  for (PetscInt k = 0; k < 3 * (interface->n1 + interface->n2); k++)
    interface->x[k] = interface->X[k] - interface->X[k % 3] + PetscRealPart(interface->gathered[k]);
}

PetscErrorCode contact_gather(Model *model, Interface *interface, Vec local)
{
  const PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(local, &array));
  PetscCall(PetscSFBcastBegin(interface->sf, MPIU_SCALAR, array, interface->gathered, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(interface->sf, MPIU_SCALAR, array, interface->gathered, MPI_REPLACE));
  PetscCall(VecRestoreArrayRead(local, &array));
  if (model->rank == 0) contact_positions(interface);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode scatter(Interface *interface, const PetscScalar *from, Vec local, MPI_Op operation)
{
  PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArray(local, &array));
  PetscCall(PetscSFReduceBegin(interface->sf, MPIU_SCALAR, from, array, operation));
  PetscCall(PetscSFReduceEnd(interface->sf, MPIU_SCALAR, from, array, operation));
  PetscCall(VecRestoreArray(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_forces(Model *model, Vec f_local, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < model->n_interfaces && !*status; i++) {
    Interface *interface = &model->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank == 0) {
      PetscScalar *f1 = interface->forces, *f2 = f1 + 3 * interface->n1, *rows = f2 + 3 * interface->n2;
      refused = stickslip_interface_residual(interface->handle, STATE_OF(interface), NULL, f1, f2, rows);
      for (PetscInt k = 0; k < 3 * (interface->n1 + interface->n2) && !refused; k++)
        model->squares[N_SQUARES * model->mesh_part[interface->nodes[k / 3]] + SQUARES_CONTACT] +=
            PetscSqr(PetscAbsScalar(interface->forces[k]));
    }
    PetscCall(contact_agree(model, refused, status));
    if (!*status) PetscCall(scatter(interface, interface->forces, f_local, MPIU_SUM));
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

/* Entries come block after block, each by columns: one call for a block, which ends where its rows do not repeat. */
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

/* rank 0: into the arrays as they are; counted first where they turn out too small */
static PetscErrorCode evaluate_tangent(Interface *interface, int64_t *count, int32_t *refused)
{
  PetscFunctionBegin;
#define TANGENT(capacity, rows, columns, values)                                                                       \
  stickslip_interface_tangent_coo(interface->handle, STATE_OF(interface), NULL, capacity, rows, columns, values, count)
  *refused = STICKSLIP_BUFFER_TOO_SMALL;
  for (int attempt = 0; attempt < 2 && *refused == STICKSLIP_BUFFER_TOO_SMALL; attempt++) {
    if (attempt || !interface->coo_capacity) {
      *refused = TANGENT(0, NULL, NULL, NULL);
      if (*refused) break;
      PetscCall(reserve(interface, *count));
    }
    *refused = TANGENT(interface->coo_capacity, interface->coo_rows, interface->coo_columns, interface->coo_values);
  }
#undef TANGENT
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_tangent(Model *model, Mat matrix, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  PetscCall(MatSetOption(matrix, MAT_ROW_ORIENTED, PETSC_FALSE)); /* as insert() has them; all ranks must call this */
  for (PetscInt i = 0; i < model->n_interfaces && !*status; i++) {
    Interface *interface = &model->interfaces[i];
    int32_t    refused   = 0;
    int64_t    count     = 0;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank == 0) {
      PetscCall(evaluate_tangent(interface, &count, &refused));
      if (!refused) PetscCall(insert(interface, count, interface->coo_values, matrix));
    }
    PetscCall(contact_agree(model, refused, status));
  }
  PetscCall(MatSetOption(matrix, MAT_ROW_ORIENTED, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_pattern(Model *model, Mat matrix)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < model->n_interfaces; i++) {
    Interface *interface = &model->interfaces[i];
    int64_t    count;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank) continue;
    PetscCallStickslip(stickslip_interface_pattern_coo(interface->handle, interface->x,
                                                       interface->x + 3 * interface->n1, 0, NULL, NULL, &count));
    PetscCall(reserve(interface, count));
    PetscCallStickslip(stickslip_interface_pattern_coo(interface->handle, interface->x,
                                                       interface->x + 3 * interface->n1, interface->coo_capacity,
                                                       interface->coo_rows, interface->coo_columns, &count));
    PetscCall(insert(interface, count, NULL, matrix));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A slightly compressive multiplier on nodes that touch: without it a body held by contact alone starts without support. */
PetscErrorCode contact_start(Model *model, Vec x, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  PetscCall(unknowns_to_local(model, x));
  for (PetscInt i = 0; i < model->n_interfaces && !*status; i++) {
    Interface *interface = &model->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank == 0 && interface->initial_contact)
      refused = stickslip_interface_initial_multipliers(interface->handle,
                                                        interface->gathered + 3 * (interface->n1 + interface->n2));
    PetscCall(contact_agree(model, refused, status));
    if (!*status) PetscCall(scatter(interface, interface->gathered, model->u_local, MPI_REPLACE));
  }
  PetscCall(DMLocalToGlobalBegin(model->dm, model->u_local, INSERT_VALUES, x));
  PetscCall(DMLocalToGlobalEnd(model->dm, model->u_local, INSERT_VALUES, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_states_create(const Interface *interface, ContactStates *states)
{
  const PetscInt     n1     = interface->n1;
  const PetscScalar *lambda = interface->gathered + 3 * (n1 + interface->n2);
  stickslip_states   wanted = {.struct_size = sizeof(wanted)};

  PetscFunctionBegin;
  PetscCall(PetscMalloc7(n1, &states->state, 3 * n1, &states->normal, n1, &states->gap, 3 * n1, &states->slip, n1,
                         &states->coverage, n1, &states->area, n1, &states->dissipation));
  PetscCall(PetscMalloc1(3 * n1, &states->multiplier));
  wanted.state       = states->state;
  wanted.normal      = states->normal;
  wanted.gap         = states->gap;
  wanted.slip        = states->slip;
  wanted.coverage    = states->coverage;
  wanted.area        = states->area;
  wanted.dissipation = states->dissipation;
  PetscCallStickslip(stickslip_interface_states(interface->handle, STATE_OF(interface), NULL, &wanted));
  for (PetscInt k = 0; k < 3 * n1; k++)
    states->multiplier[k] = interface->components == 3 ? PetscRealPart(lambda[k])
                                                       : PetscRealPart(lambda[k / 3]) * states->normal[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0, over the nodes of all interfaces, one interface after the other, at u_local: states; tangential parts of the
 * projected tractions */
PetscErrorCode contact_tendencies(Model *model, int32_t *state, double *tangential)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < model->n_interfaces; i++) {
    Interface       *interface = &model->interfaces[i];
    stickslip_states wanted    = {.struct_size = sizeof(wanted), .state = state, .traction = tangential};
    double          *normal;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank) continue;
    PetscCall(PetscMalloc1(3 * interface->n1, &normal));
    wanted.normal = normal;
    PetscCallStickslip(stickslip_interface_states(interface->handle, STATE_OF(interface), NULL, &wanted));
    for (PetscInt a = 0; a < interface->n1; a++, tangential += 3) {
      const double *n = normal + 3 * a, p = tangential[0] * n[0] + tangential[1] * n[1] + tangential[2] * n[2];
      for (int k = 0; k < 3; k++)
        tangential[k] -= p * n[k];
      if (interface->removed[a] == 7) state[a] = STICKSLIP_STATE_GAP; /* no multiplier: it acts on nothing */
    }
    PetscCall(PetscFree(normal));
    state += interface->n1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The augmentation of the nodes marked (rank 0; all interfaces, one after the other) times `factor`; NULL: back to the
 * scene's. The answer does not depend on it. */
PetscErrorCode contact_scale_augmentation(Model *model, const PetscBool *marked, PetscReal factor)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < model->n_interfaces && model->rank == 0; i++) {
    Interface       *interface = &model->interfaces[i];
    stickslip_states wanted    = {.struct_size = sizeof(wanted)};
    double          *r;
    if (!marked) {
      PetscCallStickslip(stickslip_interface_set_augmentation(interface->handle, NULL));
      continue;
    }
    PetscCall(PetscMalloc1(interface->n1, &r));
    wanted.augmentation = r;
    PetscCallStickslip(stickslip_interface_states(interface->handle, STATE_OF(interface), NULL, &wanted));
    for (PetscInt a = 0; a < interface->n1; a++) {
      if (marked[a]) r[a] *= factor;
    }
    PetscCallStickslip(stickslip_interface_set_augmentation(interface->handle, r));
    PetscCall(PetscFree(r));
    marked += interface->n1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_states_destroy(ContactStates *states)
{
  PetscFunctionBegin;
  PetscCall(PetscFree7(states->state, states->normal, states->gap, states->slip, states->coverage, states->area,
                       states->dissipation));
  PetscCall(PetscFree(states->multiplier));
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

/* All interfaces accept the step, or none: what was committed before a refusal is rolled back. */
PetscErrorCode contact_commit(Model *model, PetscInt *status)
{
  PetscInt committed = 0;
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < model->n_interfaces && !*status; i++) {
    Interface *interface = &model->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank == 0) refused = measure_memory(interface);
    if (model->rank == 0 && !refused)
      refused = stickslip_interface_commit(interface->handle, STATE_OF(interface), NULL);
    PetscCall(contact_agree(model, refused, status));
    if (!*status) committed++;
  }
  for (PetscInt i = 0; i < committed && *status && model->rank == 0; i++)
    PetscCallStickslip(stickslip_interface_rollback(model->interfaces[i].handle));
  PetscFunctionReturn(PETSC_SUCCESS);
}
