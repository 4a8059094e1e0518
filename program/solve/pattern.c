/* Which entries the matrix has room for. The factors of a matrix depend on it to their last bits, and it depends on where the surfaces were
 * when it was made; so a restart file keeps the rows that contact touches. The others are those of the bodies. */
#include "physics/dynamics.h"
#include "solve/solve.h"

static PetscErrorCode add_rows(const PatternRows *rows, Mat counter)
{
  PetscScalar *zeros;
  PetscInt     longest = 0;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < rows->n; k++)
    longest = PetscMax(longest, rows->offsets[k + 1] - rows->offsets[k]);
  PetscCall(PetscCalloc1(longest, &zeros));
  for (PetscInt k = 0; k < rows->n; k++)
    PetscCall(MatSetValues(counter, 1, &rows->row[k], rows->offsets[k + 1] - rows->offsets[k], rows->columns + rows->offsets[k], zeros,
                           ADD_VALUES));
  PetscCall(PetscFree(zeros));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With room for the bodies and for every pair of facets that may touch before the next search. */
PetscErrorCode pattern_create(Solve *solve, const PatternRows *rows, Mat *matrix)
{
  Mat      counter;
  Vec      x;
  PetscInt n, first, end;

  PetscFunctionBegin;
  PetscCall(DMGetGlobalVector(solve->mesh->dm, &x));
  PetscCall(VecGetLocalSize(x, &n));
  PetscCall(VecGetOwnershipRange(x, &first, &end));
  PetscCall(DMRestoreGlobalVector(solve->mesh->dm, &x));
  PetscCall(MatCreate(PETSC_COMM_WORLD, &counter));
  PetscCall(MatSetSizes(counter, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(counter, MATPREALLOCATOR));
  PetscCall(MatSetUp(counter));
  for (PetscInt row = first; row < end; row++)
    PetscCall(MatSetValue(counter, row, row, 0, ADD_VALUES));
  PetscCall(bulk_pattern(solve->physics, counter));
  PetscCall(rigids_pattern(solve->physics, counter));
  PetscCall(mass_pattern(solve->physics, counter));
  if (rows)
    PetscCall(add_rows(rows, counter));
  else
    PetscCall(contact_pattern(solve->contact, counter));
  PetscCall(MatAssemblyBegin(counter, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(counter, MAT_FINAL_ASSEMBLY));
  PetscCall(MatCreate(PETSC_COMM_WORLD, matrix));
  PetscCall(MatSetSizes(*matrix, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*matrix, MATAIJ));
  PetscCall(MatSetFromOptions(*matrix));
  PetscCall(MatPreallocatorPreallocate(counter, PETSC_TRUE, *matrix));
  PetscCall(MatSetOption(*matrix, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE)); /* motion may outrun the pattern */
  PetscCall(MatDestroy(&counter));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Not zero in the equations of all nodes of interfaces, their multipliers, and rigid bodies. */
static PetscErrorCode mark(Solve *solve, Vec touched)
{
  Physics     *physics = solve->physics;
  PetscScalar *array;
  Vec          local;
  PetscFunctionBegin;
  PetscCall(DMGetLocalVector(solve->mesh->dm, &local));
  PetscCall(VecZeroEntries(local));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++) {
    const ContactPart *part = &solve->contact->interfaces[i].part;
    const PetscInt     n    = part->dimension * (part->n1 + part->n2) + part->components * part->n1;
    PetscScalar       *ones;
    PetscCall(PetscMalloc1(n, &ones));
    for (PetscInt k = 0; k < n; k++)
      ones[k] = 1;
    PetscCall(contact_scatter(part, ones, local, MPIU_SUM));
    PetscCall(PetscFree(ones));
  }
  PetscCall(VecGetArray(local, &array));
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    for (int k = 0; k < RIGID_UNKNOWNS && physics->rigids[r].at[0] >= 0; k++)
      array[physics->rigids[r].at[k / 3] + k % 3] = 1;
  }
  PetscCall(VecRestoreArray(local, &array));
  PetscCall(VecZeroEntries(touched));
  PetscCall(DMLocalToGlobalBegin(solve->mesh->dm, local, ADD_VALUES, touched));
  PetscCall(DMLocalToGlobalEnd(solve->mesh->dm, local, ADD_VALUES, touched));
  PetscCall(DMRestoreLocalVector(solve->mesh->dm, &local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rows of this rank that are marked. */
static PetscErrorCode look_up(Mat matrix, Vec touched, PatternRows *rows)
{
  const PetscScalar *marks;
  PetscInt           first, end, n_columns = 0, n;
  const PetscInt    *columns;
  PetscFunctionBegin;
  *rows = (PatternRows){0};
  PetscCall(VecGetOwnershipRange(touched, &first, &end));
  PetscCall(VecGetArrayRead(touched, &marks));
  for (PetscInt row = first; row < end; row++) {
    if (PetscRealPart(marks[row - first]) == 0) continue;
    PetscCall(MatGetRow(matrix, row, &n, NULL, NULL));
    n_columns += n;
    rows->n++;
    PetscCall(MatRestoreRow(matrix, row, &n, NULL, NULL));
  }
  PetscCall(PetscMalloc3(rows->n, &rows->row, rows->n + 1, &rows->offsets, n_columns, &rows->columns));
  rows->offsets[0] = rows->n = 0;
  for (PetscInt row = first; row < end; row++) {
    if (PetscRealPart(marks[row - first]) == 0) continue;
    PetscCall(MatGetRow(matrix, row, &n, &columns, NULL));
    PetscCall(PetscArraycpy(rows->columns + rows->offsets[rows->n], columns, n));
    rows->row[rows->n++]   = row;
    rows->offsets[rows->n] = rows->offsets[rows->n - 1] + n;
    PetscCall(MatRestoreRow(matrix, row, &n, &columns, NULL));
  }
  PetscCall(VecRestoreArrayRead(touched, &marks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `matrix` becomes another one when it is read. */
static PetscErrorCode archive_matrix(Solve *solve, Vec touched, Archive *archive, Mat *matrix)
{
  PatternRows rows = {0};
  PetscInt    sizes[2];
  PetscFunctionBegin;
  if (!archive->reading) PetscCall(look_up(*matrix, touched, &rows));
  sizes[0] = rows.n;
  sizes[1] = rows.n ? rows.offsets[rows.n] : 0;
  PetscCall(archive_ints(archive, "pattern.sizes", 2, sizes));
  if (archive->reading) {
    rows.n = sizes[0];
    PetscCall(PetscMalloc3(sizes[0], &rows.row, sizes[0] + 1, &rows.offsets, sizes[1], &rows.columns));
  }
  PetscCall(archive_ints(archive, "pattern.row", sizes[0], rows.row));
  PetscCall(archive_ints(archive, "pattern.offsets", sizes[0] + 1, rows.offsets));
  PetscCall(archive_ints(archive, "pattern.columns", sizes[1], rows.columns));
  if (archive->reading && !archive->bad) {
    PetscCall(MatDestroy(matrix));
    PetscCall(pattern_create(solve, &rows, matrix));
  }
  PetscCall(PetscFree3(rows.row, rows.offsets, rows.columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Equations have other numbers on several ranks, in each run: these begin with a pattern of t_n. */
PetscErrorCode pattern_archive(Solve *solve, Archive *archive)
{
  const PetscBool alone = (PetscBool)(solve->mesh->size == 1 && archive->n_ranks == 1);
  Vec             touched;
  PetscFunctionBegin;
  if (!alone && !archive->reading) PetscFunctionReturn(PETSC_SUCCESS);
  if (alone) {
    PetscCall(DMGetGlobalVector(solve->mesh->dm, &touched));
    PetscCall(mark(solve, touched));
    PetscCall(archive_matrix(solve, touched, archive, &solve->jacobian));
    if (solve->contact->condensed) /* which makes the matrix another one while a step is solved */
      PetscCall(archive_matrix(solve, touched, archive, &solve->pattern));
    PetscCall(DMRestoreGlobalVector(solve->mesh->dm, &touched));
  } else if (!archive->bad) {
    PetscCall(MatDestroy(&solve->jacobian));
    PetscCall(pattern_create(solve, NULL, &solve->jacobian));
  }
  if (!archive->reading) PetscFunctionReturn(PETSC_SUCCESS);
  if (!alone || !solve->contact->condensed) {
    PetscCall(MatDestroy(&solve->pattern));
    PetscCall(MatDuplicate(solve->jacobian, MAT_DO_NOT_COPY_VALUES, &solve->pattern));
  }
  if (alone) contact_forget_plans(solve->contact);
  PetscFunctionReturn(PETSC_SUCCESS);
}
