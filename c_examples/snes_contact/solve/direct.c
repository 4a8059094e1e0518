/* The direct solver, wherever one is used: of whole systems, in place of multigrid, of the first iterate, of multipliers. */
#include "solve/direct.h"

PetscErrorCode direct_set(KSP ksp)
{
  PC pc;
  PetscFunctionBegin;
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscFunctionReturn(PETSC_SUCCESS);
}
