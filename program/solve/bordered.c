/* A preconditioner of a matrix with the equations of rigid bodies, six a body at most, each of which couples with all that the body touches:
 *
 *   J = [A B; C D],   J^-1 ~ [1 -V; 0 1] [A' 0; 0 S'] [1 0; -C A' 1],   V = A' B,   S = D - C V,
 *
 * A' another preconditioner, to which rigid bodies are held (reduced.c, saddle.c), S' by LU. A multigrid that knows nothing of such rows would
 * have each of them in one aggregate with half of the model. V is made anew with each matrix, by an A' for each equation. */
#include "solve/bordered.h"
#include <petscblaslapack.h>

typedef struct {
  PC            inner;
  PetscInt      n, *equations;
  Vec          *columns, free, image; /* V; without the bodies' entries; J times a vector */
  PetscScalar  *S, *y;
  PetscBLASInt *pivots;
  PetscBool     singular;
} Bordered;

/* The bodies' entries of a vector, on every rank. */
static PetscErrorCode fetch(const Bordered *bordered, Vec x, PetscScalar values[])
{
  const PetscScalar *array;
  PetscInt           first, end;
  PetscFunctionBegin;
  PetscCall(VecGetOwnershipRange(x, &first, &end));
  PetscCall(VecGetArrayRead(x, &array));
  for (PetscInt k = 0; k < bordered->n; k++)
    values[k] = bordered->equations[k] >= first && bordered->equations[k] < end ? array[bordered->equations[k] - first] : 0;
  PetscCall(VecRestoreArrayRead(x, &array));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, (PetscMPIInt)bordered->n, MPIU_SCALAR, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* NULL: zeros */
static PetscErrorCode put(const Bordered *bordered, const PetscScalar values[], Vec x)
{
  PetscScalar *array;
  PetscInt     first, end;
  PetscFunctionBegin;
  PetscCall(VecGetOwnershipRange(x, &first, &end));
  PetscCall(VecGetArray(x, &array));
  for (PetscInt k = 0; k < bordered->n; k++)
    if (bordered->equations[k] >= first && bordered->equations[k] < end) array[bordered->equations[k] - first] = values ? values[k] : 0;
  PetscCall(VecRestoreArray(x, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u = A' f, and what of J u is in the bodies' rows; f has no entries of theirs */
static PetscErrorCode solve_others(Bordered *bordered, Mat J, Vec f, Vec u, PetscScalar rows[])
{
  PetscFunctionBegin;
  PetscCall(PCApply(bordered->inner, f, u));
  PetscCall(put(bordered, NULL, u));
  PetscCall(MatMult(J, u, bordered->image));
  PetscCall(fetch(bordered, bordered->image, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode create(Bordered *bordered, Mat J)
{
  const PetscInt n = bordered->n;
  PetscFunctionBegin;
  PetscCall(MatCreateVecs(J, &bordered->free, &bordered->image));
  PetscCall(VecDuplicateVecs(bordered->free, n, &bordered->columns));
  PetscCall(PetscMalloc3(n * n, &bordered->S, 2 * n, &bordered->y, n, &bordered->pivots));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode set_up(PC pc)
{
  Bordered    *bordered;
  PetscBLASInt n, info;
  PetscScalar *rows;
  Mat          J;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &bordered));
  PetscCall(PCGetOperators(pc, &J, NULL));
  PetscCall(PCSetOperators(bordered->inner, J, J));
  PetscCall(PCSetUp(bordered->inner));
  if (!bordered->free) PetscCall(create(bordered, J));
  rows = bordered->y + bordered->n;
  for (PetscInt k = 0; k < bordered->n; k++) {
    PetscScalar *column = bordered->S + bordered->n * k;
    PetscCall(VecZeroEntries(bordered->free));
    for (PetscInt j = 0; j < bordered->n; j++)
      rows[j] = j == k;
    PetscCall(put(bordered, rows, bordered->free));
    PetscCall(MatMult(J, bordered->free, bordered->image));
    PetscCall(fetch(bordered, bordered->image, column));
    PetscCall(VecCopy(bordered->image, bordered->free));
    PetscCall(put(bordered, NULL, bordered->free));
    PetscCall(solve_others(bordered, J, bordered->free, bordered->columns[k], rows));
    for (PetscInt j = 0; j < bordered->n; j++)
      column[j] -= rows[j];
  }
  PetscCall(PetscBLASIntCast(bordered->n, &n));
  PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&n, &n, bordered->S, &n, bordered->pivots, &info));
  bordered->singular = (PetscBool)(info != 0);
  PetscCall(PCSetFailedReason(pc, info ? PC_SUBPC_ERROR : PC_NOERROR));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode apply(PC pc, Vec r, Vec u)
{
  Bordered          *bordered;
  PetscBLASInt       n, one = 1, info;
  PetscScalar       *y, *rows;
  Mat                J;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &bordered));
  PetscCall(PCGetOperators(pc, &J, NULL));
  y    = bordered->y;
  rows = bordered->y + bordered->n;
  PetscCall(VecCopy(r, bordered->free));
  PetscCall(put(bordered, NULL, bordered->free));
  PetscCall(fetch(bordered, r, y));
  PetscCall(solve_others(bordered, J, bordered->free, u, rows));
  if (bordered->singular) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < bordered->n; k++)
    y[k] -= rows[k];
  PetscCall(PetscBLASIntCast(bordered->n, &n));
  PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_("N", &n, &one, bordered->S, &n, bordered->pivots, y, &n, &info));
  for (PetscInt k = 0; k < bordered->n; k++)
    rows[k] = -y[k];
  PetscCall(VecMAXPY(u, bordered->n, rows, bordered->columns));
  PetscCall(put(bordered, y, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode destroy(PC pc)
{
  Bordered *bordered;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &bordered));
  PetscCall(PCDestroy(&bordered->inner));
  if (bordered->free) PetscCall(VecDestroyVecs(bordered->n, &bordered->columns));
  PetscCall(VecDestroy(&bordered->free));
  PetscCall(VecDestroy(&bordered->image));
  PetscCall(PetscFree3(bordered->S, bordered->y, bordered->pivots));
  PetscCall(PetscFree(bordered->equations));
  PetscCall(PetscFree(bordered));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bordered_set(PC pc, const Physics *physics, PC *inner)
{
  Bordered *bordered;
  PetscInt  n = 0, *equations;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(RIGID_UNKNOWNS * physics->n_rigids, &equations));
  for (PetscInt k = 0; k < RIGID_UNKNOWNS * physics->n_rigids; k++) {
    const PetscInt equation = physics->rigids[k / RIGID_UNKNOWNS].equations[k % RIGID_UNKNOWNS];
    if (equation >= 0) equations[n++] = equation;
  }
  *inner = pc;
  if (!n) PetscCall(PetscFree(equations));
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&bordered));
  bordered->n         = n;
  bordered->equations = equations;
  PetscCall(PCCreate(PETSC_COMM_WORLD, &bordered->inner));
  *inner = bordered->inner;
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetName(pc, "rigid bodies by LU, beside"));
  PetscCall(PCShellSetContext(pc, bordered));
  PetscCall(PCShellSetSetUp(pc, set_up));
  PetscCall(PCShellSetApply(pc, apply));
  PetscCall(PCShellSetDestroy(pc, destroy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
