/* A system without multipliers (`unknowns: displacements`): the multipliers follow from the displacements, by the balance of
 * the non-mortar nodes, and the library says what to add and to multiply. They stay in the local vectors, as entries
 * that are no unknowns, and each interface keeps their values between evaluations.
 *
 * Cold start: undeformed bodies exert no forces, so their multipliers would be 0 and touching nodes open. The first
 * evaluation of the first step takes the library's initial multipliers instead, and so does the matrix there. */
#include "contact/contact.h"

/* rank 0: entries of a matrix, in PETSc's integers */
typedef struct {
  PetscInt     n, capacity, *rows, *columns;
  PetscScalar *values;
} Entries;

/* An interface cannot share nodes with another one, where these have multipliers in either. */
PetscErrorCode condensed_check(const Contact *contact, char why[], size_t length)
{
  int64_t *offsets[2], *nodes[2], n[2] = {0, 0}, found;
  int32_t  status;

  PetscFunctionBegin;
  why[0] = 0;
  for (int side = 0; side < 2; side++) {
    PetscInt total = 0;
    for (PetscInt i = 0; i < contact->n_interfaces; i++)
      total += side ? contact->interfaces[i].n2 : contact->interfaces[i].n1;
    PetscCall(PetscCalloc2(contact->n_interfaces + 1, &offsets[side], total, &nodes[side]));
    for (PetscInt i = 0; i < contact->n_interfaces; i++) {
      const Interface *interface = &contact->interfaces[i];
      const PetscInt   first = side ? interface->n1 : 0, count = side ? interface->n2 : interface->n1;
      for (PetscInt k = 0; k < count; k++)
        nodes[side][n[side]++] = interface->nodes[first + k];
      offsets[side][i + 1] = n[side];
    }
  }
  status = stickslip_crosspoints_find(contact->n_interfaces, offsets[0], nodes[0], offsets[1], nodes[1], 0, NULL, NULL,
                                      NULL, &found);
  if (!status && found)
    PetscCall(PetscSNPrintf(why, length,
                            "%" PRId64 " nodes belong to several interfaces, and have a multiplier in one of them: their "
                            "multipliers cannot be condensed; take `unknowns: multipliers`",
                            found));
  for (int side = 0; side < 2; side++)
    PetscCall(PetscFree2(offsets[side], nodes[side]));
  PetscCheck(!status, PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s", stickslip_last_error_message());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before the first commit each attempt starts with the library's initial multipliers. */
PetscErrorCode condensed_start(Contact *contact, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  if (!contact->condensed || contact->committed) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    int32_t    refused   = 0;
    if (contact->mesh->rank == 0 && interface->initial_contact)
      refused = stickslip_interface_initial_multipliers(interface->handle, interface->lambda);
    PetscCall(contact_agree(contact, refused, status));
  }
  contact->cold = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The multipliers that balance the forces of the bodies, which f_local has so far, and the loads. */
PetscErrorCode condensed_eliminate(Contact *contact, PetscInt *status)
{
  Physics           *physics = contact->physics;
  const PetscScalar *forces;
  Vec                host;
  PetscFunctionBegin;
  *status = 0;
  if (!contact->condensed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMGetLocalVector(contact->mesh->dm, &host));
  PetscCall(VecWAXPY(host, -1, physics->f_external, physics->f_local));
  PetscCall(unknowns_sum(physics, host));
  PetscCall(DMRestoreLocalVector(contact->mesh->dm, &host));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(VecGetArrayRead(physics->f_sum, &forces));
    PetscCall(PetscSFBcastBegin(interface->sf, MPIU_SCALAR, forces, interface->host, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(interface->sf, MPIU_SCALAR, forces, interface->host, MPI_REPLACE));
    PetscCall(VecRestoreArrayRead(physics->f_sum, &forces));
    PetscCall(contact_gather(contact, interface, physics->u_local));
    if (contact->mesh->rank == 0 && !contact->cold)
      refused = stickslip_interface_condensed_multipliers(
        interface->handle, interface->x, interface->x + 3 * interface->n1, interface->host, interface->lambda);
    PetscCall(contact_agree(contact, refused, status));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes of the forces' residual that of the system without multipliers. */
PetscErrorCode condensed_residual(Contact *contact, Vec r, PetscInt *status)
{
  Physics *physics = contact->physics;
  PetscFunctionBegin;
  *status = 0;
  if (!contact->condensed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecZeroEntries(physics->f_sum));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface     *interface = &contact->interfaces[i];
    const PetscInt n1 = 3 * interface->n1, n2 = 3 * interface->n2;
    int32_t        refused = 0;
    PetscCall(contact_gather(contact, interface, physics->u_local));
    if (contact->mesh->rank == 0) {
      double *rows = interface->rows;
      refused = stickslip_interface_condensed_residual(interface->handle, STATE_OF(interface), interface->host, rows, rows + n1);
      for (PetscInt k = 0; k < n1 + n2 && !refused; k++)
        rows[k] -= interface->forces[k] + (k < n1 ? interface->host[k] : 0);
    }
    PetscCall(contact_agree(contact, refused, status));
    if (!*status) PetscCall(contact_scatter(interface, interface->rows, physics->f_sum, MPIU_SUM));
  }
  PetscCall(DMLocalToGlobalBegin(contact->mesh->dm, physics->f_sum, ADD_VALUES, r));
  PetscCall(DMLocalToGlobalEnd(contact->mesh->dm, physics->f_sum, ADD_VALUES, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: adds a piece of an interface's matrix to the entries */
static PetscErrorCode add_piece(Interface *interface, int32_t piece, Entries *entries, int32_t *refused)
{
  int64_t count;
  PetscFunctionBegin;
  PetscCall(contact_entries(interface, piece, &count, refused));
  if (*refused) PetscFunctionReturn(PETSC_SUCCESS);
  if (entries->n + count > entries->capacity) {
    Entries larger = {.n = entries->n, .capacity = (PetscInt)(2 * entries->capacity + count)};
    PetscCall(PetscMalloc3(larger.capacity, &larger.rows, larger.capacity, &larger.columns, larger.capacity, &larger.values));
    PetscCall(PetscArraycpy(larger.rows, entries->rows, entries->n));
    PetscCall(PetscArraycpy(larger.columns, entries->columns, entries->n));
    PetscCall(PetscArraycpy(larger.values, entries->values, entries->n));
    PetscCall(PetscFree3(entries->rows, entries->columns, entries->values));
    *entries = larger;
  }
  for (int64_t k = 0; k < count; k++) {
    entries->rows[entries->n]     = (PetscInt)interface->coo_rows[k];
    entries->columns[entries->n]  = (PetscInt)interface->coo_columns[k];
    entries->values[entries->n++] = interface->coo_values[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A piece of all interfaces, a matrix like another one. */
static PetscErrorCode assemble(Contact *contact, int32_t piece, Mat like, Mat *matrix, PetscInt *status)
{
  Entries  entries = {0};
  PetscInt n;
  PetscFunctionBegin;
  *matrix = NULL;
  *status = 0;
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    int32_t refused = 0;
    PetscCall(contact_gather(contact, &contact->interfaces[i], contact->physics->u_local));
    if (contact->mesh->rank == 0) PetscCall(add_piece(&contact->interfaces[i], piece, &entries, &refused));
    PetscCall(contact_agree(contact, refused, status));
  }
  if (!*status) {
    PetscCall(MatGetLocalSize(like, &n, NULL));
    PetscCall(MatCreate(PETSC_COMM_WORLD, matrix));
    PetscCall(MatSetSizes(*matrix, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
    PetscCall(MatSetType(*matrix, MATAIJ));
    PetscCall(MatSetPreallocationCOO(*matrix, entries.n, entries.rows, entries.columns));
    PetscCall(MatSetValuesCOO(*matrix, entries.values, ADD_VALUES));
  }
  PetscCall(PetscFree3(entries.rows, entries.columns, entries.values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* J becomes J + E J + G: E eliminates the multipliers, G has the constraints. */
PetscErrorCode condensed_matrix(Contact *contact, Mat J, PetscInt *status)
{
  Mat E = NULL, G = NULL, EJ;
  PetscFunctionBegin;
  *status = 0;
  if (!contact->condensed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(assemble(contact, STICKSLIP_CONDENSED_ELIMINATION, J, &E, status));
  if (!*status) PetscCall(assemble(contact, STICKSLIP_CONDENSED_CONSTRAINTS, J, &G, status));
  if (!*status) {
    PetscCall(MatMatMult(E, J, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &EJ));
    PetscCall(MatAXPY(EJ, 1, G, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatAXPY(J, 1, EJ, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatSetOption(J, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE)); /* it has become another matrix */
    PetscCall(MatDestroy(&EJ));
  }
  PetscCall(MatDestroy(&E));
  PetscCall(MatDestroy(&G));
  contact->cold = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
