/* SNES: residual, tangent, the matrix and its pattern, and the linear solver's defaults.
 *
 * Residual = internal forces of the bodies + contact - loads, and the multiplier rows (which the library scales to
 * forces). When it is small enough: convergence.c. */
#include "solve/solve.h"
#include "solve/direct.h"
#include "physics/dynamics.h"

static PetscErrorCode residual(SNES snes, Vec x, Vec r, void *context)
{
  Solve         *solve = context;
  PetscInt       inverted, refused = 0;
  PetscLogDouble start, end;

  PetscFunctionBegin;
  PetscCall(unknowns_to_local(solve->physics, x));
  if (!solve->physics->dynamics && loads_follow(solve->physics)) PetscCall(loads_values(solve->physics));
  PetscCall(VecZeroEntries(solve->physics->f_local));
  PetscCall(PetscArrayzero(solve->physics->parts.squares, N_SQUARES * solve->physics->parts.n));
  PetscCall((solve->physics->dynamics ? dynamics_forces : bulk_forces)(solve->physics, solve->physics->f_local, &inverted));
  PetscCall(PetscTime(&start));
  if (!inverted) PetscCall(condensed_eliminate(solve->contact, x, &refused));
  if (solve->physics->rigid_refused) inverted = PETSC_TRUE; /* the attempt ends alike */
  if (!inverted && !refused) PetscCall(contact_forces(solve->contact, solve->physics->f_local, &refused));
  PetscCall(PetscTime(&end));
  solve->contact->seconds_forces += end - start;
  PetscCall(rigids_collect(solve->physics, solve->physics->f_local, PETSC_TRUE));
  PetscCall(VecAXPY(solve->physics->f_local, -1, solve->physics->f_external));
  PetscCall(VecZeroEntries(r));
  PetscCall(DMLocalToGlobalBegin(solve->mesh->dm, solve->physics->f_local, ADD_VALUES, r));
  PetscCall(DMLocalToGlobalEnd(solve->mesh->dm, solve->physics->f_local, ADD_VALUES, r));
  PetscCall(parts_measure(solve->physics));
  if (!inverted && !refused) PetscCall(condensed_residual(solve->contact, r, &refused));
  PetscCall(timed_residual(solve->physics, solve->stiffness, r));
  PetscCall(redundant_residual(solve, x, r));
  solve->outside = (PetscBool)(inverted || refused);
  if (solve->outside) PetscCall(SNESSetFunctionDomainError(snes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode tangent(SNES snes, Vec x, Mat J, Mat P, void *context)
{
  Solve         *solve = context;
  PetscInt       inverted, refused;
  PetscLogDouble start, end;

  PetscFunctionBegin;
  PetscCall(unknowns_to_local(solve->physics, x));
  PetscCall(MatZeroEntries(P));
  if (solve->physics->dynamics) {
    PetscCall(dynamics_stiffness(solve->physics, P, &inverted));
  } else {
    PetscCall(bulk_stiffness(solve->physics, P, &inverted));
    PetscCall(loads_stiffness(solve->physics, P));
  }
  PetscCall(PetscTime(&start));
  PetscCall(contact_tangent(solve->contact, P, &refused));
  PetscCall(PetscTime(&end));
  solve->contact->seconds_tangent += end - start;
  PetscCall(redundant_rows(solve, P));
  PetscCall(MatAssemblyBegin(P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(P, MAT_FINAL_ASSEMBLY));
  if (!inverted && !refused) PetscCall(closing_shift(solve, P));
  if (!inverted && !refused) PetscCall(condensed_matrix(solve->contact, x, P, &refused));
  PetscCall(timed_rows(solve->physics, solve->stiffness, P));
  if (inverted || refused) PetscCall(SNESSetJacobianDomainError(snes));
  if (J != P) {
    PetscCall(MatAssemblyBegin(J, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(J, MAT_FINAL_ASSEMBLY));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode solve_begins(KSP ksp, Vec b, Vec x, void *context)
{
  Solve *solve = context;
  PetscFunctionBegin;
  (void)ksp, (void)b, (void)x;
  PetscCall(PetscTime(&solve->started));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc's own LU exchanges no rows: its pivots, the least over the largest of a matrix, say how far it went well. */
static PetscErrorCode look_at_pivots(Solve *solve, KSP ksp)
{
  MatSolverType solver = NULL;
  PetscBool     lu, own;
  PetscReal     least, largest;
  PC            pc;
  Mat           factors;
  Vec           pivots;
  PetscFunctionBegin;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCLU, &lu));
  if (lu) PetscCall(PCFactorGetMatSolverType(pc, &solver));
  PetscCall(PetscStrcmp(solver, MATSOLVERPETSC, &own));
  if (!own) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCFactorGetMatrix(pc, &factors));
  PetscCall(MatCreateVecs(solve->jacobian, &pivots, NULL));
  PetscCall(MatGetDiagonal(factors, pivots));
  PetscCall(VecAbs(pivots));
  PetscCall(VecMin(pivots, NULL, &least));
  PetscCall(VecMax(pivots, NULL, &largest));
  PetscCall(VecDestroy(&pivots));
  if (solve->least_pivot == 0 || least < solve->least_pivot * largest) solve->least_pivot = least / largest;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode solve_ends(KSP ksp, Vec b, Vec x, void *context)
{
  Solve         *solve = context;
  PetscLogDouble now;
  PetscFunctionBegin;
  (void)b, (void)x;
  PetscCall(look_at_pivots(solve, ksp));
  PetscCall(PetscTime(&now));
  solve->seconds += now - solve->started;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The model's size, and a stiffness (the largest E times it; of rigid bodies alone any will do). */
static PetscErrorCode measure(Solve *solve)
{
  PetscReal low[3], high[3], squared = 0, young = 0;
  PetscFunctionBegin;
  PetscCall(DMGetBoundingBox(solve->mesh->dm, low, high));
  for (int i = 0; i < 3; i++)
    squared += PetscSqr(high[i] - low[i]);
  for (PetscInt b = 0; b < solve->mesh->n_bodies; b++)
    young = PetscMax(young, solve->physics->materials[b].young);
  solve->size      = PetscSqrtReal(squared);
  solve->stiffness = young > 0 ? young * solve->size : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Did PETSc allocate entry by entry, for pairs beyond the pattern? */
static PetscErrorCode outgrown(const Solve *solve, PetscBool *grown)
{
  MatInfo info;
  PetscFunctionBegin;
  PetscCall(MatGetInfo(solve->jacobian, MAT_GLOBAL_MAX, &info));
  *grown = (PetscBool)(info.mallocs > 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode solver_use_matrix(Solve *solve)
{
  PetscFunctionBegin;
  PetscCall(SNESSetJacobian(solve->snes, solve->jacobian, solve->jacobian, tangent, solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* New pairs in the last step: start the next one with a fresh pattern. */
PetscErrorCode solver_refresh_pattern(Solve *solve)
{
  PetscBool grown = PETSC_FALSE;
  PetscFunctionBegin;
  PetscCall(outgrown(solve, &grown));
  if (!grown) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatDestroy(&solve->jacobian));
  PetscCall(MatDestroy(&solve->pattern));
  PetscCall(pattern_create(solve, NULL, &solve->jacobian));
  PetscCall(MatDuplicate(solve->jacobian, MAT_DO_NOT_COPY_VALUES, &solve->pattern));
  PetscCall(solver_use_matrix(solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After a linear system that could not be solved: the next one starts with a new analysis. PETSc takes MUMPS' refusal of a
 * singular matrix (INFOG(1) = -10), which MUMPS remembers, for one of the analysis: it would not factorise the next
 * matrix, and MUMPS stops the program for being asked to solve without (INFOG(1) = -3). */
PetscErrorCode solver_forget_factors(Solve *solve)
{
  KSP ksp;
  PC  pc;
  PetscFunctionBegin;
  PetscCall(SNESGetKSP(solve->snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCReset(pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode solver_restore_pattern(Solve *solve)
{
  PetscBool grown = PETSC_FALSE;
  PetscFunctionBegin;
  PetscCall(outgrown(solve, &grown));
  if (!grown) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatDestroy(&solve->jacobian));
  PetscCall(MatDuplicate(solve->pattern, MAT_DO_NOT_COPY_VALUES, &solve->jacobian));
  contact_forget_plans(solve->contact);
  PetscCall(solver_use_matrix(solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MUMPS' pivoting may take so many per cent more workspace than its analysis estimates (icntl 14). The rows of multipliers that
 * stick have no diagonal, and may double it; but all that is allowed is allocated at once, which a machine may not have. So it
 * gets twice as much whenever it asks for more; a user may say where to begin. */
enum { FIRST_ROOM = 30, MOST_ROOM = 1000 };

static PetscErrorCode set_option(const char *name, PetscInt value)
{
  char text[16];
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(text, sizeof(text), "%" PetscInt_FMT, value));
  PetscCall(PetscOptionsSetValue(NULL, name, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the user has not set. The analysis must see the pattern only, not the values of the first matrix (icntl 6): else the
 * factors after a cut-back would carry a trace of the attempt that failed. */
static PetscErrorCode set_up_mumps(Solve *solve, PC pc)
{
  MatSolverType solver = NULL;
  PetscBool     lu, mumps, given;
  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCLU, &lu));
  if (lu) PetscCall(PCFactorGetMatSolverType(pc, &solver));
  PetscCall(PetscStrcmp(solver, MATSOLVERMUMPS, &mumps));
  if (!mumps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscOptionsHasName(NULL, NULL, "-mat_mumps_icntl_6", &given));
  if (!given) PetscCall(set_option("-mat_mumps_icntl_6", 0));
  solve->room = FIRST_ROOM;
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-mat_mumps_icntl_14", &solve->room, &given));
  if (!given) PetscCall(set_option("-mat_mumps_icntl_14", solve->room));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode solver_give_room(Solve *solve, PetscBool *given)
{
  PetscBool wanted;
  KSP       ksp;
  PetscFunctionBegin;
  PetscCall(SNESGetKSP(solve->snes, &ksp));
  PetscCall(refusal_wants_room(ksp, &wanted));
  *given = (PetscBool)(wanted && solve->room < MOST_ROOM);
  if (!*given) PetscFunctionReturn(PETSC_SUCCESS);
  solve->room = PetscMax(2 * solve->room, FIRST_ROOM);
  solve->n_raised++;
  PetscCall(set_option("-mat_mumps_icntl_14", solve->room));
  PetscCall(solver_forget_factors(solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What it was given, so that it need not ask again. */
PetscErrorCode solver_archive_room(Solve *solve, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(archive_ints(archive, "room", 1, &solve->room));
  PetscCall(archive_ints(archive, "n_raised", 1, &solve->n_raised));
  if (archive->reading && solve->n_raised) PetscCall(set_option("-mat_mumps_icntl_14", solve->room));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode solver_create(Solve *solve)
{
  SNESLineSearch line_search;
  KSP            ksp;
  Vec            r;
  PetscInt       n_unknowns;

  PetscFunctionBegin;
  PetscCall(measure(solve));
  PetscCall(pattern_create(solve, NULL, &solve->jacobian));
  PetscCall(MatDuplicate(solve->jacobian, MAT_DO_NOT_COPY_VALUES, &solve->pattern));
  PetscCall(DMCreateGlobalVector(solve->mesh->dm, &r));
  PetscCall(SNESCreate(PETSC_COMM_WORLD, &solve->snes));
  PetscCall(SNESSetDM(solve->snes, solve->mesh->dm));
  PetscCall(SNESSetFunction(solve->snes, r, residual, solve));
  PetscCall(SNESSetJacobian(solve->snes, solve->jacobian, solve->jacobian, tangent, solve));
  PetscCall(SNESSetConvergenceHistory(solve->snes, NULL, NULL, PETSC_DECIDE, PETSC_TRUE)); /* anew for each step */
  PetscCall(SNESSetType(solve->snes, SNESNEWTONLS));
  PetscCall(SNESSetTolerances(solve->snes, 0, 1e-11, 0, 25, PETSC_DEFAULT)); /* -snes_rtol: see convergence.c */
  PetscCall(SNESGetLineSearch(solve->snes, &line_search));
  /* No absolute limit on the length of a step (PETSc's is 1e8): iterations must not depend on the system of units. */
  PetscCall(SNESLineSearchSetTolerances(line_search, PETSC_DEFAULT, PETSC_MAX_REAL, PETSC_DEFAULT, PETSC_DEFAULT,
                                        PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(SNESGetKSP(solve->snes, &ksp));
  PetscCall(VecGetSize(r, &n_unknowns));
  iterative_choose(solve, n_unknowns);
  if (solve->linear.kind == SOLVER_ITERATIVE) {
    PetscCall(iterative_set(solve, ksp));
  } else {
    PetscCall(direct_set(ksp));
  }
  PetscCall(progress_watch(solve, solve->snes, NULL));
  PetscCall(KSPSetPreSolve(ksp, solve_begins, solve));
  PetscCall(KSPSetPostSolve(ksp, solve_ends, solve));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* When all defaults are set. */
PetscErrorCode solver_configure(Solve *solve)
{
  KSP ksp;
  PC  pc;
  PetscFunctionBegin;
  PetscCall(SNESSetFromOptions(solve->snes));
  PetscCall(SNESGetKSP(solve->snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(set_up_mumps(solve, pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode solver_destroy(Solve *solve)
{
  PetscFunctionBegin;
  PetscCall(MatDestroy(&solve->jacobian));
  PetscCall(MatDestroy(&solve->pattern));
  PetscCall(SNESDestroy(&solve->snes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
