/* Multigrid (GAMG) on a matrix of whole nodes, its defaults by what the bodies are. */
#include "solve/multigrid.h"

/* A coarse level may have rows without entries, where a node that is alone has three components and the modes of a body are
 * six: this much of a typical diagonal is added when Gauss-Seidel divides. */
static const PetscReal DIAGONAL_SHIFT = 1e-12;

PetscErrorCode multigrid_typical(Mat matrix, PetscReal *typical)
{
  Vec      diagonal;
  PetscInt n;
  PetscFunctionBegin;
  PetscCall(MatCreateVecs(matrix, &diagonal, NULL));
  PetscCall(MatGetDiagonal(matrix, diagonal));
  PetscCall(VecNorm(diagonal, NORM_1, typical));
  PetscCall(VecGetSize(diagonal, &n));
  *typical /= PetscMax(n, 1);
  PetscCall(VecDestroy(&diagonal));
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

/* Options of the multigrid that nobody has given. */
static PetscErrorCode set_defaults(const Physics *physics, Mat P)
{
  char              shift[32];
  PetscReal         typical;
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
  PetscCall(multigrid_typical(P, &typical));
  PetscCall(PetscSNPrintf(shift, sizeof(shift), "%.3e", (double)(DIAGONAL_SHIFT * typical)));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-reduced_mg_levels_pc_type", &given));
  if (given) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(factorises(physics, &ilu));
  for (int k = 0; k < 4; k++) {
    const char *const *option = ilu ? factors[k] : sweeps[k];
    PetscCall(PetscOptionsHasName(NULL, NULL, option[0], &given));
    if (!given) PetscCall(PetscOptionsSetValue(NULL, option[0], option[1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode multigrid_create(const Physics *physics, Mat P, PC *pc)
{
  PetscFunctionBegin;
  PetscCall(set_defaults(physics, P));
  PetscCall(PCCreate(PETSC_COMM_WORLD, pc));
  PetscCall(PCSetOptionsPrefix(*pc, "reduced_"));
  PetscCall(PCSetType(*pc, PCGAMG));
  PetscCall(PCSetOperators(*pc, P, P));
  PetscCall(PCSetFromOptions(*pc));
  PetscCall(PCSetUp(*pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}
