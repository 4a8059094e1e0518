/* Which of the suspects are redundant: the forces of all multipliers on what can move are the columns of C; of C^T C all others are eliminated. */
#include "solve/redundant.h"
#include "solve/direct.h"

/* Equations that this rank owns, of displacements and of multipliers */
static PetscErrorCode split(const Solve *solve, IS *displacements, IS *multipliers)
{
  const PetscScalar *is_displacement;
  PetscInt           n, first, counts[2] = {0, 0}, *equations[2];
  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(solve->closing.displacements, &n));
  PetscCall(VecGetOwnershipRange(solve->closing.displacements, &first, NULL));
  PetscCall(PetscMalloc1(n, &equations[0]));
  PetscCall(PetscMalloc1(n, &equations[1]));
  PetscCall(VecGetArrayRead(solve->closing.displacements, &is_displacement));
  for (PetscInt k = 0; k < n; k++) {
    const int kind                  = PetscRealPart(is_displacement[k]) == 0;
    equations[kind][counts[kind]++] = first + k;
  }
  PetscCall(VecRestoreArrayRead(solve->closing.displacements, &is_displacement));
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, counts[0], equations[0], PETSC_OWN_POINTER, displacements));
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, counts[1], equations[1], PETSC_OWN_POINTER, multipliers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* C^T C at u_local, in the order of `multipliers`; NULL: the library refuses */
static PetscErrorCode products(Solve *solve, IS displacements, IS multipliers, Mat *N)
{
  PetscInt status;
  Mat      tangent, C;
  PetscFunctionBegin;
  *N = NULL;
  PetscCall(MatDuplicate(solve->pattern, MAT_DO_NOT_COPY_VALUES, &tangent));
  PetscCall(contact_tangent(solve->contact, tangent, &status));
  PetscCall(MatAssemblyBegin(tangent, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(tangent, MAT_FINAL_ASSEMBLY));
  if (!status) {
    PetscCall(MatCreateSubMatrix(tangent, displacements, multipliers, MAT_INITIAL_MATRIX, &C));
    PetscCall(MatTransposeMatMult(C, C, MAT_INITIAL_MATRIX, PETSC_DEFAULT, N));
    PetscCall(MatDestroy(&C));
  }
  PetscCall(MatDestroy(&tangent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows and columns of N: the suspects', and the others' that cover anything. `order`: of each suspect its number among them, as they lie on
 * the ranks */
static PetscErrorCode divide(Mat N, IS multipliers, PetscInt n, const Multiplier suspects[], PetscInt order[], IS *suspect, IS *others)
{
  const PetscInt    *equations;
  const PetscScalar *values;
  PetscInt           n_mine, first, n_suspects = 0, n_others = 0, before = 0, *rows[2], *suspect_at;
  Vec                diagonal;
  PetscFunctionBegin;
  PetscCall(ISGetLocalSize(multipliers, &n_mine));
  PetscCall(ISGetIndices(multipliers, &equations));
  PetscCall(MatGetOwnershipRange(N, &first, NULL));
  PetscCall(MatCreateVecs(N, &diagonal, NULL));
  PetscCall(MatGetDiagonal(N, diagonal));
  PetscCall(VecGetArrayRead(diagonal, &values));
  PetscCall(PetscMalloc1(n, &rows[0]));
  PetscCall(PetscMalloc1(n_mine, &rows[1]));
  PetscCall(PetscMalloc1(n_mine, &suspect_at));
  for (PetscInt k = 0; k < n_mine; k++)
    suspect_at[k] = -1;
  for (PetscInt k = 0; k < n; k++) {
    PetscInt at;
    order[k] = -1;
    PetscCall(PetscFindInt(suspects[k].equation, n_mine, equations, &at));
    if (at >= 0) suspect_at[at] = k;
  }
  for (PetscInt k = 0; k < n_mine; k++) { /* PETSc wants rows and columns in order */
    if (suspect_at[k] >= 0) {
      order[suspect_at[k]]  = n_suspects;
      rows[0][n_suspects++] = first + k;
    } else if (PetscRealPart(values[k]) > 0) {
      rows[1][n_others++] = first + k;
    }
  }
  PetscCallMPI(MPI_Exscan(&n_suspects, &before, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt k = 0; k < n; k++)
    order[k] = order[k] < 0 ? 0 : order[k] + before;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, order, (PetscMPIInt)n, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, n_suspects, rows[0], PETSC_OWN_POINTER, suspect));
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, n_others, rows[1], PETSC_OWN_POINTER, others));
  PetscCall(PetscFree(suspect_at));
  PetscCall(VecRestoreArrayRead(diagonal, &values));
  PetscCall(VecDestroy(&diagonal));
  PetscCall(ISRestoreIndices(multipliers, &equations));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* S <- S - B^T A^-1 B with the others' A: what no combination of them gives */
static PetscErrorCode eliminate_others(Mat N, IS suspects, IS others, Mat S)
{
  Mat A, sparse, B, X, taken;
  KSP ksp;
  PetscFunctionBegin;
  PetscCall(MatCreateSubMatrix(N, others, others, MAT_INITIAL_MATRIX, &A));
  PetscCall(MatCreateSubMatrix(N, others, suspects, MAT_INITIAL_MATRIX, &sparse));
  PetscCall(MatConvert(sparse, MATDENSE, MAT_INITIAL_MATRIX, &B));
  PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(direct_set(ksp));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPMatSolve(ksp, B, X));
  PetscCall(MatTransposeMatMult(B, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &taken));
  PetscCall(MatAXPY(S, -1, taken, SAME_NONZERO_PATTERN));
  PetscCall(MatDestroy(&taken));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(MatDestroy(&X));
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&sparse));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A dense matrix on all ranks, its rows and columns in this order; by rows */
static PetscErrorCode gather(Mat S, PetscInt n, const PetscInt order[], PetscReal values[])
{
  PetscFunctionBegin;
  for (PetscInt j = 0; j < n; j++) {
    const PetscScalar *entries;
    VecScatter         scatter;
    Vec                column, all;
    PetscCall(MatDenseGetColumnVecRead(S, order[j], &column));
    PetscCall(VecScatterCreateToAll(column, &scatter, &all));
    PetscCall(VecScatterBegin(scatter, column, all, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterEnd(scatter, column, all, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecGetArrayRead(all, &entries));
    for (PetscInt i = 0; i < n; i++)
      values[n * i + j] = PetscRealPart(entries[order[i]]);
    PetscCall(VecRestoreArrayRead(all, &entries));
    PetscCall(VecScatterDestroy(&scatter));
    PetscCall(VecDestroy(&all));
    PetscCall(MatDenseRestoreColumnVecRead(S, order[j], &column));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode suspects_judge(Solve *solve, PetscInt n, const Multiplier suspects[], PetscBool redundant[])
{
  IS         displacements, multipliers, suspect, others;
  PetscInt  *order, n_others;
  PetscReal *values;
  Mat        N, sparse, S;
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(redundant, n));
  PetscCall(split(solve, &displacements, &multipliers));
  PetscCall(products(solve, displacements, multipliers, &N));
  if (N) {
    PetscCall(PetscMalloc2(n, &order, n * n, &values));
    PetscCall(divide(N, multipliers, n, suspects, order, &suspect, &others));
    PetscCall(MatCreateSubMatrix(N, suspect, suspect, MAT_INITIAL_MATRIX, &sparse));
    PetscCall(MatConvert(sparse, MATDENSE, MAT_INITIAL_MATRIX, &S));
    PetscCall(ISGetSize(others, &n_others));
    if (n_others) PetscCall(eliminate_others(N, suspect, others, S));
    PetscCall(gather(S, n, order, values));
    dependent_find(n, suspects, values, redundant);
    PetscCallMPI(MPI_Bcast(redundant, (PetscMPIInt)n, MPIU_BOOL, 0, PETSC_COMM_WORLD)); /* sums may be rounded otherwise elsewhere */
    PetscCall(MatDestroy(&S));
    PetscCall(MatDestroy(&sparse));
    PetscCall(ISDestroy(&suspect));
    PetscCall(ISDestroy(&others));
    PetscCall(PetscFree2(order, values));
    PetscCall(MatDestroy(&N));
  }
  PetscCall(ISDestroy(&displacements));
  PetscCall(ISDestroy(&multipliers));
  PetscFunctionReturn(PETSC_SUCCESS);
}
