/* Matrices that the library makes of the multipliers' rows: pieces of all interfaces, as matrices of the whole system. */
#include "contact/contact.h"

/* entries of a matrix, in PETSc's integers */
typedef struct {
  PetscInt     n, capacity, *rows, *columns;
  PetscScalar *values;
} List;

/* adds a piece of a part's matrix to the entries */
static PetscErrorCode add_piece(const Contact *contact, ContactPart *part, int32_t piece, List *entries, int32_t *refused)
{
  Entries found;
  PetscFunctionBegin;
  part->processor -= work_clock();
  PetscCall(contact_entries(contact, part, piece, &found, refused));
  part->processor += work_clock();
  if (*refused) PetscFunctionReturn(PETSC_SUCCESS);
  if (entries->n + found.n > entries->capacity) {
    List larger = {.n = entries->n, .capacity = (PetscInt)(2 * entries->capacity + found.n)};
    PetscCall(PetscMalloc3(larger.capacity, &larger.rows, larger.capacity, &larger.columns, larger.capacity, &larger.values));
    PetscCall(PetscArraycpy(larger.rows, entries->rows, entries->n));
    PetscCall(PetscArraycpy(larger.columns, entries->columns, entries->n));
    PetscCall(PetscArraycpy(larger.values, entries->values, entries->n));
    PetscCall(PetscFree3(entries->rows, entries->columns, entries->values));
    *entries = larger;
  }
  for (int64_t k = 0; k < found.n; k++) {
    entries->rows[entries->n]     = (PetscInt)found.rows[k];
    entries->columns[entries->n]  = (PetscInt)found.columns[k];
    entries->values[entries->n++] = found.values[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode condensed_piece(Contact *contact, int32_t piece, Mat like, Mat *matrix, PetscInt *status)
{
  List     entries = {0};
  PetscInt n;
  PetscFunctionBegin;
  *matrix = NULL;
  *status = 0;
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    if (interface->part.handle) PetscCall(add_piece(contact, &interface->part, piece, &entries, &refused));
    PetscCall(contact_agree(contact, interface, refused, status));
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
