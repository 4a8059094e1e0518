/* SNES: residual, tangent, the convergence test in units of force, and the linear solver's defaults.
 *
 * Residual = internal forces of the bodies + contact - loads, and the multiplier rows (which the library scales to forces).
 * Converged: the forces on each part of the model balance, measured by its own forces (parts.c), and every interface is in
 * contact equilibrium, measured by its own tractions (equilibrium.c). The multiplier rows are not asked: they are as
 * small as the augmentation.
 * -snes_rtol sets the tolerance of both, -snes_atol a limit in units of force. */
#include "model.h"

static PetscErrorCode residual(SNES snes, Vec x, Vec r, void *context)
{
  Model         *model      = context;
  PetscInt       inverted, refused = 0;
  PetscLogDouble start, end;

  PetscFunctionBegin;
  PetscCall(unknowns_to_local(model, x));
  PetscCall(VecZeroEntries(model->f_local));
  PetscCall(PetscArrayzero(model->squares, N_SQUARES * model->n_parts));
  PetscCall(bulk_forces(model, model->f_local, &inverted));
  PetscCall(PetscTime(&start));
  if (!inverted) PetscCall(contact_forces(model, model->f_local, &refused));
  PetscCall(PetscTime(&end));
  model->timers.contact_forces += end - start;
  if (inverted || refused) PetscCall(SNESSetFunctionDomainError(snes));
  PetscCall(VecAXPY(model->f_local, -1, model->f_external));
  PetscCall(VecZeroEntries(r));
  PetscCall(DMLocalToGlobalBegin(model->dm, model->f_local, ADD_VALUES, r));
  PetscCall(DMLocalToGlobalEnd(model->dm, model->f_local, ADD_VALUES, r));
  PetscCall(parts_measure(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode tangent(SNES snes, Vec x, Mat J, Mat P, void *context)
{
  Model         *model = context;
  PetscInt       inverted, refused;
  PetscLogDouble start, end;

  PetscFunctionBegin;
  PetscCall(unknowns_to_local(model, x));
  PetscCall(MatZeroEntries(P));
  PetscCall(bulk_stiffness(model, P, &inverted));
  PetscCall(PetscTime(&start));
  PetscCall(contact_tangent(model, P, &refused));
  PetscCall(PetscTime(&end));
  model->timers.contact_tangent += end - start;
  if (inverted || refused) PetscCall(SNESSetJacobianDomainError(snes));
  PetscCall(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  if (!inverted && !refused) PetscCall(closing_shift(model, P));
  if (J != P) {
    PetscCall(MatAssemblyBegin(J, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(J, MAT_FINAL_ASSEMBLY));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode judge(SNES snes, Model *model, PetscReal norm, SNESConvergedReason *reason)
{
  PetscReal atol, rtol;
  PetscBool balance, relative, holds, stuck;
  PetscFunctionBegin;
  PetscCall(SNESGetTolerances(snes, &atol, &rtol, NULL, NULL, NULL));
  *reason = SNES_CONVERGED_ITERATING;
  if (PetscIsInfOrNanReal(norm)) {
    *reason = SNES_DIVERGED_FNORM_NAN;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  parts_judge(model, rtol, atol, &balance, &relative);
  if (!balance) {
    equilibrium_restart(model);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(equilibrium_judge(model, rtol, &holds, &stuck));
  if (holds)
    *reason = relative ? SNES_CONVERGED_FNORM_RELATIVE : SNES_CONVERGED_FNORM_ABS;
  else if (stuck)
    *reason = SNES_DIVERGED_LOCAL_MIN; /* of PETSc's names the nearest; newton.unsettled has words */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode converged(SNES snes, PetscInt iteration, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                                SNESConvergedReason *reason, void *context)
{
  Model *model = context;
  PetscFunctionBegin;
  (void)xnorm, (void)snorm;
  PetscCall(judge(snes, model, fnorm, reason));
  if (*reason > 0 && !closing_settled(model)) *reason = SNES_CONVERGED_ITERATING;
  if (*reason > 0) {
    PetscCall(newton_confirm(model, &fnorm));
    PetscCall(judge(snes, model, fnorm, reason));
  }
  if (!*reason) PetscCall(newton_watch(model, iteration, fnorm, reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode solve_begins(KSP ksp, Vec b, Vec x, void *context)
{
  Model *model = context;
  PetscFunctionBegin;
  (void)ksp, (void)b, (void)x;
  PetscCall(PetscTime(&model->timers.started));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode solve_ends(KSP ksp, Vec b, Vec x, void *context)
{
  Model         *model = context;
  PetscLogDouble now;
  PetscFunctionBegin;
  (void)ksp, (void)b, (void)x;
  PetscCall(PetscTime(&now));
  model->timers.linear_solve += now - model->timers.started;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The model's size, and a stiffness (the largest E times it). */
static PetscErrorCode measure(Model *model)
{
  PetscReal low[3], high[3], squared = 0, young = 0;
  PetscFunctionBegin;
  PetscCall(DMGetBoundingBox(model->dm, low, high));
  for (int i = 0; i < 3; i++)
    squared += PetscSqr(high[i] - low[i]);
  for (PetscInt b = 0; b < model->mesh.n_bodies; b++)
    young = PetscMax(young, model->mesh.bodies[b].material.young);
  model->size      = PetscSqrtReal(squared);
  model->stiffness = young * model->size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A matrix with room for the bodies and for every pair of facets that may touch before the next search. */
static PetscErrorCode create_matrix(Model *model, Mat *matrix)
{
  Mat      counter;
  Vec      x;
  PetscInt n, first, end;

  PetscFunctionBegin;
  PetscCall(DMGetGlobalVector(model->dm, &x));
  PetscCall(VecGetLocalSize(x, &n));
  PetscCall(VecGetOwnershipRange(x, &first, &end));
  PetscCall(DMRestoreGlobalVector(model->dm, &x));
  PetscCall(MatCreate(PETSC_COMM_WORLD, &counter));
  PetscCall(MatSetSizes(counter, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(counter, MATPREALLOCATOR));
  PetscCall(MatSetUp(counter));
  for (PetscInt row = first; row < end; row++)
    PetscCall(MatSetValue(counter, row, row, 0, ADD_VALUES));
  PetscCall(bulk_pattern(model, counter));
  PetscCall(contact_pattern(model, counter));
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

/* Did PETSc allocate entry by entry, for pairs beyond the pattern? */
static PetscErrorCode outgrown(const Model *model, PetscBool *grown)
{
  MatInfo info;
  PetscFunctionBegin;
  PetscCall(MatGetInfo(model->jacobian, MAT_GLOBAL_MAX, &info));
  *grown = (PetscBool)(info.mallocs > 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* New pairs in the last step: start the next one with a fresh pattern. */
PetscErrorCode solver_refresh_pattern(Model *model)
{
  PetscBool grown;
  PetscFunctionBegin;
  PetscCall(outgrown(model, &grown));
  if (!grown) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatDestroy(&model->jacobian));
  PetscCall(MatDestroy(&model->pattern));
  PetscCall(create_matrix(model, &model->jacobian));
  PetscCall(MatDuplicate(model->jacobian, MAT_DO_NOT_COPY_VALUES, &model->pattern));
  PetscCall(SNESSetJacobian(model->snes, model->jacobian, model->jacobian, tangent, model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After a linear system that could not be solved: the next one starts with a new analysis. PETSc takes MUMPS' refusal of a
 * singular matrix (INFOG(1) = -10), which MUMPS remembers, for one of the analysis: it would not factorise the next
 * matrix, and MUMPS stops the program for being asked to solve without (INFOG(1) = -3). */
PetscErrorCode solver_forget_factors(Model *model)
{
  KSP ksp;
  PC  pc;
  PetscFunctionBegin;
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCReset(pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode solver_restore_pattern(Model *model)
{
  PetscBool grown;
  PetscFunctionBegin;
  PetscCall(outgrown(model, &grown));
  if (!grown) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatDestroy(&model->jacobian));
  PetscCall(MatDuplicate(model->pattern, MAT_DO_NOT_COPY_VALUES, &model->jacobian));
  PetscCall(SNESSetJacobian(model->snes, model->jacobian, model->jacobian, tangent, model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MUMPS refuses when its pivoting outgrows the memory it has estimated by more than 20 %. The rows of multipliers that
 * stick have no diagonal, and their pivoting may double it. Room that stays unused is not touched. (icntl 14)
 *
 * Its analysis must see the pattern only, not the values of the first matrix (icntl 6): else the factors after a
 * cut-back would carry a trace of the attempt that failed. */
static PetscErrorCode set_up_mumps(PC pc)
{
  static const char *const options[][2] = {{"-mat_mumps_icntl_14", "200"}, {"-mat_mumps_icntl_6", "0"}};
  MatSolverType            solver       = NULL;
  PetscBool                lu, mumps, given;
  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCLU, &lu));
  if (lu) PetscCall(PCFactorGetMatSolverType(pc, &solver));
  PetscCall(PetscStrcmp(solver, MATSOLVERMUMPS, &mumps));
  for (int k = 0; k < 2 && mumps; k++) {
    PetscCall(PetscOptionsHasName(NULL, NULL, options[k][0], &given));
    if (!given) PetscCall(PetscOptionsSetValue(NULL, options[k][0], options[k][1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode solver_create(Model *model)
{
  SNESLineSearch line_search;
  KSP            ksp;
  PC             pc;
  Vec            r;

  PetscFunctionBegin;
  PetscCall(measure(model));
  PetscCall(create_matrix(model, &model->jacobian));
  PetscCall(MatDuplicate(model->jacobian, MAT_DO_NOT_COPY_VALUES, &model->pattern));
  PetscCall(DMCreateGlobalVector(model->dm, &r));
  PetscCall(SNESCreate(PETSC_COMM_WORLD, &model->snes));
  PetscCall(SNESSetDM(model->snes, model->dm));
  PetscCall(SNESSetFunction(model->snes, r, residual, model));
  PetscCall(SNESSetJacobian(model->snes, model->jacobian, model->jacobian, tangent, model));
  PetscCall(SNESSetConvergenceHistory(model->snes, NULL, NULL, PETSC_DECIDE, PETSC_TRUE)); /* anew for each step */
  PetscCall(SNESSetConvergenceTest(model->snes, converged, model, NULL));
  PetscCall(SNESSetType(model->snes, SNESNEWTONLS));
  PetscCall(SNESSetTolerances(model->snes, 0, 1e-11, 0, 25, PETSC_DEFAULT)); /* -snes_rtol: see the head of this file */
  PetscCall(SNESGetLineSearch(model->snes, &line_search));
  /* No absolute limit on the length of a step (PETSc's is 1e8): iterations must not depend on the system of units. */
  PetscCall(SNESLineSearchSetTolerances(line_search, PETSC_DEFAULT, PETSC_MAX_REAL, PETSC_DEFAULT, PETSC_DEFAULT,
                                        PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(SNESGetKSP(model->snes, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSetPreSolve(ksp, solve_begins, model));
  PetscCall(KSPSetPostSolve(ksp, solve_ends, model));
  PetscCall(SNESSetFromOptions(model->snes));
  PetscCall(set_up_mumps(pc));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}
