/* `solver: iterative`: GMRES, preconditioned by multigrid: of a condensed system on its reduced form (reduced.c), of one with
 * multipliers on the bodies (saddle.c); the equations of rigid bodies are beside it (bordered.c). Where it does not converge, the system is given to the direct solver, and the run says so. To SNES both are one preconditioner that
 * solves the system. */
#include "solve/solve.h"
#include "solve/reduced.h"
#include "solve/saddle.h"
#include "solve/bordered.h"
#include "solve/direct.h"

/* Of the true residual. Newton's method then takes the steps of a direct solver: its own tolerance is 1e-11. */
static const PetscReal RTOL = 1e-10;
/* Where multigrid works, it takes some 30; from here on LU is faster. */
enum { MOST_ITERATIONS = 250, RESTART = 60 };

typedef struct {
  Solve *solve;
  KSP    krylov, direct; /* the latter: NULL until it is needed */
  PC     bodies;         /* multigrid: the preconditioner of krylov, or within that of rigid bodies */
} Iterative;

/* Where to look, once a run. */
static PetscErrorCode tell(Iterative *iterative, KSPConvergedReason reason, PetscInt iterations)
{
  Solve *solve = iterative->solve;
  PetscFunctionBegin;
  if (solve->linear.n_direct++ || solve->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "multigrid does not solve a linear system (%s after %" PetscInt_FMT " iterations): the direct solver "
                        "does instead, here and wherever this happens (`direct` under `linear_solver` in summary.json)\n",
                        KSPConvergedReasons[reason], iterations));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode solve_directly(Iterative *iterative, Mat J, Vec r, Vec u, KSPConvergedReason *reason)
{
  PC pc;
  PetscFunctionBegin;
  if (!iterative->direct) {
    PetscCall(KSPCreate(PETSC_COMM_WORLD, &iterative->direct));
    PetscCall(KSPSetOptionsPrefix(iterative->direct, "direct_"));
    PetscCall(direct_set(iterative->direct));
    PetscCall(KSPSetFromOptions(iterative->direct));
  }
  PetscCall(KSPSetOperators(iterative->direct, J, J));
  PetscCall(KSPSolve(iterative->direct, r, u));
  PetscCall(KSPGetConvergedReason(iterative->direct, reason));
  if (*reason < 0)
    PetscCall(refusal_describe(iterative->direct, iterative->solve->linear.refusal, REFUSAL_LENGTH));
  PetscCall(KSPGetPC(iterative->direct, &pc));
  PetscCall(PCReset(pc)); /* its factors are large, and serve this once */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode iterate(Iterative *iterative, Mat J, Vec r, Vec u, KSPConvergedReason *reason, PetscInt *iterations,
                              PetscBool *stale)
{
  PetscFunctionBegin;
  PetscCall(KSPSetOperators(iterative->krylov, J, J));
  PetscCall(KSPSolve(iterative->krylov, r, u));
  PetscCall(KSPGetConvergedReason(iterative->krylov, reason));
  PetscCall(KSPGetIterationNumber(iterative->krylov, iterations));
  *stale = PETSC_FALSE;
  if (iterative->solve->contact->condensed) PetscCall(reduced_judge(iterative->bodies, *iterations, (PetscBool)(*reason > 0), stale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode apply(PC pc, Vec r, Vec u)
{
  Iterative         *iterative;
  Linear            *linear;
  KSPConvergedReason reason;
  PetscInt           n, iterations = 0;
  PetscBool          stale;
  Mat                J;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &iterative));
  linear = &iterative->solve->linear;
  PetscCall(PCGetOperators(pc, &J, NULL));
  do {
    PetscCall(iterate(iterative, J, r, u, &reason, &n, &stale));
    iterations += n;
  } while (stale && reason < 0);
  linear->n_solves++;
  linear->iterations += iterations;
  linear->most = PetscMax(linear->most, iterations);
  if (reason > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(tell(iterative, reason, iterations));
  PetscCall(solve_directly(iterative, J, r, u, &reason));
  if (reason < 0) PetscCall(PCSetFailedReason(pc, PC_SUBPC_ERROR));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode set_up(PC pc)
{
  PetscFunctionBegin;
  PetscCall(PCSetFailedReason(pc, PC_NOERROR)); /* of the matrix before */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode destroy(PC pc)
{
  Iterative *iterative;
  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &iterative));
  PetscCall(KSPDestroy(&iterative->krylov));
  PetscCall(KSPDestroy(&iterative->direct));
  PetscCall(PetscFree(iterative));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode iterative_set(Solve *solve, KSP ksp)
{
  Iterative *iterative;
  PC         pc;
  PetscFunctionBegin;
  PetscCall(PetscNew(&iterative));
  iterative->solve = solve;
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &iterative->krylov));
  PetscCall(KSPSetOptionsPrefix(iterative->krylov, "iterative_"));
  PetscCall(KSPSetType(iterative->krylov, KSPGMRES));
  PetscCall(KSPGMRESSetRestart(iterative->krylov, RESTART));
  PetscCall(KSPGMRESSetCGSRefinementType(iterative->krylov, KSP_GMRES_CGS_REFINE_IFNEEDED));
  PetscCall(KSPSetPCSide(iterative->krylov, PC_RIGHT));
  PetscCall(KSPSetTolerances(iterative->krylov, RTOL, 0, PETSC_DEFAULT, MOST_ITERATIONS));
  PetscCall(KSPGetPC(iterative->krylov, &pc));
  PetscCall(bordered_set(pc, solve->physics, &iterative->bodies));
  PetscCall((solve->contact->condensed ? reduced_set : saddle_set)(iterative->bodies, solve->contact));
  PetscCall(progress_watch(solve, NULL, iterative->krylov));
  PetscCall(KSPSetFromOptions(iterative->krylov));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetName(pc, "GMRES with multigrid"));
  PetscCall(PCShellSetContext(pc, iterative));
  PetscCall(PCShellSetSetUp(pc, set_up));
  PetscCall(PCShellSetApply(pc, apply));
  PetscCall(PCShellSetDestroy(pc, destroy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `solver`. */
PetscErrorCode iterative_read(Scene *scene, Solve *solve)
{
  static const char *const kinds[] = {"direct", "iterative", "auto", NULL};
  Contact                 *contact = solve->contact;
  PetscInt                 kind    = SOLVER_DIRECT;
  PetscFunctionBegin;
  scene_choice(scene, NULL, "solver", kinds, &kind);
  solve->linear.kind = (SolverKind)kind;
  contact->reduced = (PetscBool)(kind != SOLVER_DIRECT && contact->condensed);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With multipliers among the unknowns, multigrid on the bodies needs these to be held; rigid ones are beside it. */
void iterative_check(Scene *scene, const Solve *solve)
{
  const Contact *contact = solve->contact;
  PetscBool      held    = PETSC_TRUE;
  if (solve->linear.kind != SOLVER_ITERATIVE || contact->condensed) return;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    if (contact->interfaces[i].method.form == STICKSLIP_FORM_AUGMENTED) return;
  }
  for (PetscInt b = 0; b < solve->mesh->n_bodies; b++)
    held = (PetscBool)(held && (solve->mesh->bodies[b].rigid || !held_free(solve, b)));
  if (!held)
    scene_fail(scene, NULL, "solver", "a body is held by contact alone, and multigrid with multipliers needs supports that hold each body: "
                                      "write `unknowns: displacements`, and `basis: dual` in every interface; or take `direct`.");
}

/* Below, LU takes less time; solves of three-dimensional bodies break even between 1e4 and 3e4 unknowns, plane ones far above. */
enum { AUTO_FROM = 30000 };

/* What `auto` means for this model. */
void iterative_choose(Solve *solve, PetscInt n_unknowns)
{
  Linear *linear = &solve->linear;
  if (linear->kind == SOLVER_AUTO)
    linear->kind = solve->contact->reduced && n_unknowns >= AUTO_FROM && solve->mesh->dimension == 3 ? SOLVER_ITERATIVE : SOLVER_DIRECT;
  solve->contact->reduced = (PetscBool)(linear->kind == SOLVER_ITERATIVE);
}
