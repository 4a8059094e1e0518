/* The direct solver, wherever one is used: of whole systems, in place of multigrid, of the first iterate, of multipliers. */
#include "solve/direct.h"

#if defined(PETSC_HAVE_MUMPS)
static const char *const LU = MATSOLVERMUMPS;
#else
static const char *const LU = MATSOLVERPETSC; /* of one rank */
#endif

PetscErrorCode direct_set(KSP ksp)
{
  PC pc;
  PetscFunctionBegin;
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, LU));
  PetscFunctionReturn(PETSC_SUCCESS);
}
