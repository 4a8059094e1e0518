/* Why a linear system is not solved, and what to do next: memory, a limit of iterations, or a singular matrix. */
#include "solve/solve.h"

/* INFOG(1) where MUMPS has too little memory: an allocation is refused (-5, -7, -13), its workspace is smaller than what
 * pivoting needs (-8, -9, -11, -12, -14, -15), a buffer for messages is too small (-17, -18, -20), or so is the limit of
 * icntl_23 (-19). */
static PetscBool wants_memory(PetscInt info)
{
  static const PetscInt codes[] = {-5, -7, -8, -9, -11, -12, -13, -14, -15, -17, -18, -19, -20};
  for (size_t k = 0; k < sizeof(codes) / sizeof(codes[0]); k++) {
    if (info == codes[k]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Of these: it would take more than icntl_14 allows, and may get it. */
static PetscBool wants_room(PetscInt info)
{
  static const PetscInt codes[] = {-8, -9, -11, -12, -14, -15, -17, -18, -20};
  for (size_t k = 0; k < sizeof(codes) / sizeof(codes[0]); k++) {
    if (info == codes[k]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* INFOG(1) of MUMPS; 0 where another solver works, or where nothing is factorised. */
static PetscErrorCode mumps_info(PC pc, PetscInt *info)
{
#if defined(PETSC_HAVE_MUMPS)
  MatSolverType  solver = NULL;
  PCFailedReason failed;
  PetscBool      lu, mumps;
  Mat            factors;
  PetscFunctionBegin;
  *info = 0;
  PetscCall(PCGetFailedReason(pc, &failed));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCLU, &lu));
  if (lu && failed) PetscCall(PCFactorGetMatSolverType(pc, &solver));
  PetscCall(PetscStrcmp(solver, MATSOLVERMUMPS, &mumps));
  if (!mumps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCFactorGetMatrix(pc, &factors));
  PetscCall(MatMumpsGetInfog(factors, 1, info));
#else
  PetscFunctionBegin;
  (void)pc;
  *info = 0;
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode refusal_wants_room(KSP ksp, PetscBool *wants)
{
  PetscInt info;
  PC       pc;
  PetscFunctionBegin;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(mumps_info(pc, &info));
  *wants = wants_room(info);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In words, after KSPSolve() and before the factors are forgotten. A solver with a prefix of options of its own stands in for
 * multigrid that did not converge: `solver: iterative` would be no advice there. */
PetscErrorCode refusal_describe(KSP ksp, char why[], size_t size)
{
  KSPConvergedReason reason;
  const char        *prefix;
  PetscInt           info, limit;
  PC                 pc;
  PetscFunctionBegin;
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(KSPGetOptionsPrefix(ksp, &prefix));
  PetscCall(mumps_info(pc, &info));
  if (wants_memory(info)) {
    PetscCall(PetscSNPrintf(why, size,
                            "the direct solver has too little memory (MUMPS: INFOG(1) = %" PetscInt_FMT
                            "): take %sfewer unknowns, more ranks, or factors on disk "
                            "(-%smat_mumps_icntl_22 1)",
                            info, prefix ? "" : "`solver: iterative`, ", prefix ? prefix : ""));
  } else if (reason == KSP_DIVERGED_ITS) {
    PetscCall(KSPGetTolerances(ksp, NULL, NULL, NULL, &limit));
    PetscCall(PetscSNPrintf(why, size,
                            "the linear solver does not converge within %" PetscInt_FMT
                            " iterations: raise -ksp_max_it, or take `solver: direct` without -ksp_type",
                            limit));
  } else {
    PetscCall(PetscSNPrintf(why, size, "the matrix is singular"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
