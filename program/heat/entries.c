/* Entries of a matrix, gathered before PETSc is told where they are. */
#include "heat/heat.h"

PetscErrorCode entries_add(HeatEntries *entries, PetscInt row, PetscInt column, PetscScalar value)
{
  PetscFunctionBeginHot;
  if (row < 0 || column < 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (entries->n == entries->room) {
    const PetscCount room = 2 * entries->room + 1024;
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)room, &entries->rows));
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)room, &entries->columns));
    PetscCall(PetscRealloc(sizeof(PetscScalar) * (size_t)room, &entries->values));
    entries->room = room;
  }
  entries->rows[entries->n]     = row;
  entries->columns[entries->n]  = column;
  entries->values[entries->n++] = value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode entries_destroy(HeatEntries *entries)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(entries->rows));
  PetscCall(PetscFree(entries->columns));
  PetscCall(PetscFree(entries->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
