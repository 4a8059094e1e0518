/* Multigrid on matrices of whole nodes. Coarse functions are those of the bodies alone, made once (GAMG), and coarse matrices are
 * Galerkin's of each matrix: aggregates of a matrix with contact in it reach across the interface, and no function that is coarse
 * lets one body slide on the other. */
#include "solve/multigrid.h"

/* A coarse level may have rows without entries, where a node that is alone has three components and the modes of a body are
 * six: this much of the least diagonal is added when Gauss-Seidel divides. */
static const PetscReal DIAGONAL_SHIFT = 1e-12;

/* Above 0 */
static PetscErrorCode least_diagonal(Mat matrix, PetscReal *least)
{
  const PetscScalar *array;
  Vec                diagonal;
  PetscInt           n;
  PetscFunctionBegin;
  *least = PETSC_MAX_REAL;
  PetscCall(MatCreateVecs(matrix, &diagonal, NULL));
  PetscCall(MatGetDiagonal(matrix, diagonal));
  PetscCall(VecGetLocalSize(diagonal, &n));
  PetscCall(VecGetArrayRead(diagonal, &array));
  for (PetscInt k = 0; k < n; k++)
    if (PetscRealPart(array[k]) > 0) *least = PetscMin(*least, PetscRealPart(array[k]));
  PetscCall(VecRestoreArrayRead(diagonal, &array));
  PetscCall(VecDestroy(&diagonal));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, 1, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Richardson's method with an incomplete factorisation takes half of the time of Chebyshev's with Gauss-Seidel. It is not the
 * smoother for blocks of several ranks, nor for bodies that are nearly incompressible. */
static const PetscReal NEARLY_INCOMPRESSIBLE = 0.4;

static PetscErrorCode factorises(const Physics *physics, PetscBool *yes)
{
  PetscMPIInt size;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  *yes = (PetscBool)(size == 1);
  for (PetscInt b = 0; b < physics->mesh->n_bodies; b++)
    *yes = (PetscBool)(*yes && physics->materials[b].poisson < NEARLY_INCOMPRESSIBLE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode set_option(const char name[], const char value[], PetscBool *given)
{
  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, name, given));
  if (!*given) PetscCall(PetscOptionsSetValue(NULL, name, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Aggregates of three cells a side, not of five, where cells are stretched: longest over shortest distance between two corners, the
 * geometric mean of all cells; 1.7 of cubes. Of cubes smaller aggregates take two iterations less, and five times as long. */
static const PetscReal STRETCHED = 3;

static PetscReal log_aspect(PetscInt n, const PetscReal X[])
{
  PetscReal shortest = PETSC_MAX_REAL, longest = 0;
  for (PetscInt a = 0; a < n; a++) {
    for (PetscInt b = 0; b < a; b++) {
      PetscReal squared = 0;
      for (int i = 0; i < 3; i++)
        squared += PetscSqr(X[3 * a + i] - X[3 * b + i]);
      if (squared > 0) shortest = PetscMin(shortest, squared);
      longest  = PetscMax(longest, squared);
    }
  }
  return PetscLogReal(longest / shortest) / 2;
}

static PetscErrorCode set_aggregates(const Physics *physics)
{
  const Cells *cells  = &physics->cells;
  PetscReal    sum[2] = {0, 0};
  PetscBool    given;
  PetscFunctionBegin;
  for (PetscInt c = 0; c < cells->n; c++) {
    if (physics->mesh->bodies[cells->body[c]].rigid) continue;
    sum[0] += log_aspect(cells->offsets[c + 1] - cells->offsets[c], cells->X + 3 * cells->offsets[c]);
    sum[1]++;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  if (sum[0] > PetscLogReal(STRETCHED) * sum[1]) PetscCall(set_option("-reduced_pc_gamg_aggressive_coarsening", "0", &given));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options of the multigrid that nobody has given. */
static PetscErrorCode set_defaults(const Physics *physics, Mat bodies)
{
  char              shift[32];
  PetscReal         least;
  PetscBool         given, ilu = PETSC_FALSE;
  const char *const factors[][2]     = {{"-reduced_mg_levels_ksp_type", "richardson"},
                                        {"-reduced_mg_levels_ksp_max_it", "1"},
                                        {"-reduced_mg_levels_pc_type", "ilu"},
                                        {"-reduced_mg_levels_pc_factor_shift_type", "nonzero"}};
  const char *const sweeps[][2]      = {{"-reduced_mg_levels_ksp_type", "chebyshev"},
                                        {"-reduced_mg_levels_ksp_max_it", "2"},
                                        {"-reduced_mg_levels_pc_type", "sor"},
                                        {"-reduced_mg_levels_pc_sor_diagonal_shift", shift}};
  PetscFunctionBegin;
  PetscCall(set_aggregates(physics));
  if (physics->mesh->size == 1) PetscCall(set_option("-matptap_via", "rap", &given)); /* Galerkin's products in two thirds of the time */
  PetscCall(least_diagonal(bodies, &least));
  PetscCall(PetscSNPrintf(shift, sizeof(shift), "%.3e", (double)(DIAGONAL_SHIFT * least)));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-reduced_mg_levels_pc_type", &given));
  if (given) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(factorises(physics, &ilu));
  for (int k = 0; k < 4; k++) {
    const char *const *option = ilu ? factors[k] : sweeps[k];
    PetscCall(set_option(option[0], option[1], &given));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An incomplete factorisation that leaves less out takes half as long again for each cycle. */
PetscErrorCode multigrid_fill(PetscBool *more)
{
  char      smoother[32] = "";
  PetscBool ilu, given;
  PetscFunctionBegin;
  *more = PETSC_FALSE;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-reduced_mg_levels_pc_type", smoother, sizeof(smoother), &given));
  PetscCall(PetscStrcmp(smoother, PCILU, &ilu));
  if (!ilu) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(set_option("-reduced_mg_levels_pc_factor_levels", "2", &given));
  *more = (PetscBool)!given;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode create(const char type[], Mat matrix, PC *pc)
{
  PetscFunctionBegin;
  PetscCall(PCCreate(PETSC_COMM_WORLD, pc));
  PetscCall(PCSetOptionsPrefix(*pc, "reduced_"));
  PetscCall(PCSetType(*pc, type));
  PetscCall(PCSetOperators(*pc, matrix, matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The bodies' matrix of whole nodes, at rest, that knows their motions. */
static PetscErrorCode make_bodies(Physics *physics, const NodeBlocks *blocks, Mat like, Mat *bodies)
{
  const PetscReal nothing_left_out = 0;
  Mat             equations, whole;
  MatNullSpace    motions;
  PetscFunctionBegin;
  PetscCall(MatDuplicate(like, MAT_DO_NOT_COPY_VALUES, &equations));
  PetscCall(bulk_stiffness_at_rest(physics, equations));
  PetscCall(MatAssemblyBegin(equations, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(equations, MAT_FINAL_ASSEMBLY));
  PetscCall(MatPtAP(equations, blocks->place, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &whole));
  PetscCall(MatDestroy(&equations));
  PetscCall(node_blocks_matrix(blocks, whole, nothing_left_out, bodies));
  PetscCall(MatDestroy(&whole));
  PetscCall(MatNullSpaceCreateRigidBody(blocks->coordinates, &motions));
  PetscCall(MatSetNearNullSpace(*bodies, motions));
  PetscCall(MatNullSpaceDestroy(&motions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode coarse_create(Physics *physics, const NodeBlocks *blocks, Mat like, Coarse *coarse)
{
  Mat bodies;
  Vec free;
  PC  pc;
  PetscFunctionBegin;
  PetscCall(make_bodies(physics, blocks, like, &bodies));
  PetscCall(set_defaults(physics, bodies));
  PetscCall(create(PCGAMG, bodies, &pc));
  PetscCall(PCSetFromOptions(pc));
  PetscCall(PCSetUp(pc));
  PetscCall(PCGetInterpolations(pc, &coarse->n_levels, &coarse->to_finer));
  PetscCall(PCDestroy(&pc));
  PetscCall(MatDestroy(&bodies));
  if (coarse->n_levels > 1) {
    PetscCall(VecDuplicate(blocks->prescribed, &free));
    PetscCall(VecCopy(blocks->prescribed, free));
    PetscCall(VecScale(free, -1));
    PetscCall(VecShift(free, 1));
    PetscCall(MatDiagonalScale(coarse->to_finer[coarse->n_levels - 2], free, NULL));
    PetscCall(VecDestroy(&free));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode coarse_destroy(Coarse *coarse)
{
  PetscFunctionBegin;
  for (PetscInt level = 0; level + 1 < coarse->n_levels; level++)
    PetscCall(MatDestroy(&coarse->to_finer[level]));
  PetscCall(PetscFree(coarse->to_finer));
  coarse->n_levels = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (I - Q) of the finest interpolation */
static PetscErrorCode unconstrained(Mat finest, Mat Q, Mat *projected)
{
  PetscFunctionBegin;
  PetscCall(MatMatMult(Q, finest, MAT_INITIAL_MATRIX, PETSC_DEFAULT, projected));
  PetscCall(MatAYPX(*projected, -1, finest, DIFFERENT_NONZERO_PATTERN));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode multigrid_create(const Coarse *coarse, Mat Q, Mat P, PC *pc)
{
  const PetscInt n = coarse->n_levels;
  PetscFunctionBegin;
  PetscCall(create(PCMG, P, pc));
  PetscCall(PCMGSetLevels(*pc, n, NULL));
  PetscCall(PCMGSetGalerkin(*pc, PC_MG_GALERKIN_BOTH));
  for (PetscInt level = 1; level < n; level++) {
    Mat projected = NULL;
    if (level == n - 1 && Q) PetscCall(unconstrained(coarse->to_finer[level - 1], Q, &projected));
    PetscCall(PCMGSetInterpolation(*pc, level, projected ? projected : coarse->to_finer[level - 1]));
    PetscCall(MatDestroy(&projected));
  }
  PetscCall(PCSetFromOptions(*pc));
  PetscCall(PCSetUp(*pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}
