/* When is an iterate converged, and what if it is not?
 *
 * Converged: the forces on each part of the model balance, measured by its own forces (balance.c), and every interface is in
 * contact equilibrium, measured by its own tractions (equilibrium.c). The multiplier rows are not asked: they are as
 * small as the augmentation. -snes_rtol sets the tolerance of both, -snes_atol a limit in units of force. What is converged so must be sound
 * beside: forces and moments balance on each part as a whole (balance.c), and contact is what contact can be (sound.c).
 *
 * An iterate that is not converged is watched for cycles (cycling.c): the augmentation of nodes that cycle is changed,
 * CHANGES times at most in one attempt. One that has converged so must do so with the scene's augmentation, too. */
#include "solve/solve.h"
#include <cjson/cJSON.h>

enum { CHANGES = 3 };
/* Iterations in a row at which all is well but that contact forces hide a residual, or that a part does not balance as a whole: Newton's
 * method has ended at its rounding. */
enum { UNSOUND = 3 };
/* An attempt that has thrown the bodies about goes on while in so many iterations the residual has come below its least before by this
 * part of it. */
enum { SPAN = 8 };
static const PetscReal NEARER = 0.01;
/* An iteration that leaves less than this of a residual is not at its rounding. */
static const PetscReal GAINS = 0.01;
/* A residual that grows by this has thrown the bodies about. */
static const PetscReal THROWN = 100;
/* Bodies that are thrown as far as this do not come back, and what they may touch is looked for all over the model, which takes long. */
static const PetscReal GONE = 1e12;

/* rank 0: a cycle for the report, and as a sentence */
static PetscErrorCode report_cycle(Solve *solve, PetscInt period, PetscInt iteration)
{
  Newton *newton = &solve->newton;
  cJSON  *json   = cJSON_CreateObject();
  char    nodes[768];
  PetscFunctionBegin;
  cJSON_AddNumberToObject(json, "t", solve->physics->t);
  cJSON_AddNumberToObject(json, "iteration", iteration);
  PetscCall(cycling_describe(solve, period, json, nodes, sizeof(nodes)));
  PetscCall(PetscSNPrintf(newton->cycle, sizeof(newton->cycle),
                          "the states of nodes repeat every %" PetscInt_FMT " iterations:%s", period, nodes));
  if (!newton->cycles) newton->cycles = cJSON_CreateArray();
  cJSON_AddItemToArray(newton->cycles, json);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool convergence_throws(PetscReal first, PetscReal norm)
{
  return (PetscBool)(norm >= THROWN * first);
}

/* Has the attempt thrown the bodies about, and does not come back? */
static PetscErrorCode is_lost(SNES snes, PetscBool *lost)
{
  PetscReal *norms, before, least = PETSC_MAX_REAL, largest = 0;
  PetscInt   n;
  PetscFunctionBegin;
  *lost = PETSC_FALSE;
  PetscCall(SNESGetConvergenceHistory(snes, &norms, NULL, &n));
  if (n < SPAN + 2) PetscFunctionReturn(PETSC_SUCCESS);
  before = norms[1]; /* without the start, where loads have not moved anything */
  for (PetscInt j = 1; j < n; j++) {
    largest = PetscMax(largest, norms[j]);
    if (j < n - SPAN)
      before = PetscMin(before, norms[j]);
    else
      least = PetscMin(least, norms[j]);
  }
  *lost = (PetscBool)(convergence_throws(norms[0], largest) && least >= (1 - NEARER) * before);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After an iteration that has not converged: does it cycle, and what now? */
static PetscErrorCode watch(Solve *solve, PetscInt iteration, PetscReal norm, SNESConvergedReason *reason)
{
  Newton  *newton = &solve->newton;
  PetscInt period;
  PetscFunctionBegin;
  if (solve->closing.away[0]) {
    *reason = SNES_DIVERGED_LOCAL_MIN;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (solve->closing.cut) PetscCall(cycling_restart(solve)); /* states of steps that were cut come back */
  PetscCall(cycling_record(solve, norm, &period));
  if (!period || !solve->steps.cycles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(report_cycle(solve, period, iteration));
  if (newton->n_changes == CHANGES) {
    *reason         = SNES_DIVERGED_LOCAL_MIN; /* of PETSc's names the nearest; the report has its own words */
    newton->stopped = PETSC_TRUE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(cycling_change_augmentation(solve, period, newton->factor));
  PetscCall(cycling_restart(solve));
  newton->n_changes++;
  newton->changed = newton->stale = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The start of an attempt with another augmentation, which the library has taken. */
static PetscErrorCode soften(Solve *solve)
{
  PetscFunctionBegin;
  PetscCall(contact_scale_augmentation(solve->contact, NULL, solve->newton.soft));
  solve->newton.changed = solve->newton.stale = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The iterate has converged. With the scene's augmentation, too? Returns the norm of that residual. */
static PetscErrorCode confirm(Solve *solve, PetscReal *norm)
{
  Vec x, r;
  PetscFunctionBegin;
  PetscCall(contact_reset_augmentation(solve->contact));
  PetscCall(cycling_restart(solve));
  PetscCall(SNESGetSolution(solve->snes, &x));
  PetscCall(VecDuplicate(x, &r));
  PetscCall(SNESComputeFunction(solve->snes, x, r));
  PetscCall(VecNorm(r, NORM_2, norm));
  PetscCall(VecDestroy(&r));
  solve->newton.changed = PETSC_FALSE;
  solve->newton.stale   = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An iterate looks converged and is not: newton->unsound says why. `at_once`: iterating on changes nothing. */
static PetscErrorCode refuse(Newton *newton, PetscBool at_once, SNESConvergedReason *reason)
{
  PetscFunctionBegin;
  newton->n_unsound++;
  /* of PETSc's names the nearest; the report has newton->unsound */
  if (at_once || newton->n_unsound > UNSOUND) *reason = SNES_DIVERGED_LOCAL_MIN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces balance: is the contact in equilibrium, and is newton->unsound left empty? `mistaken`: iterating on changes nothing of that. */
static PetscErrorCode judge_contact(Solve *solve, PetscReal rtol, PetscBool *holds, PetscBool *stuck, PetscBool *mistaken)
{
  Newton        *newton = &solve->newton;
  PetscLogDouble start, end;
  PetscFunctionBegin;
  PetscCall(PetscTime(&start));
  *mistaken = PETSC_FALSE;
  PetscCall(equilibrium_judge(solve->contact, rtol, holds, stuck));
  if (*holds) {
    PetscCall(contact_sound(solve->contact, newton->unsound, sizeof(newton->unsound)));
    *mistaken = (PetscBool)(newton->unsound[0] != 0);
    if (!*mistaken) PetscCall(parts_resultants(solve->physics, newton->unsound, sizeof(newton->unsound)));
  }
  PetscCall(PetscTime(&end));
  solve->contact->seconds_checks += end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With `dynamics` rounding ends no step while Newton's method gains: what is left adds up over thousands of them. */
static PetscErrorCode gains(SNES snes, const Solve *solve, PetscReal norm, PetscBool *gain)
{
  PetscReal *norms;
  PetscInt   n;
  PetscFunctionBegin;
  PetscCall(SNESGetConvergenceHistory(snes, &norms, NULL, &n)); /* the last one is that of now */
  *gain = (PetscBool)(solve->physics->dynamics && n > 1 && norm <= GAINS * norms[n - 2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode judge(SNES snes, Solve *solve, PetscReal norm, SNESConvergedReason *reason)
{
  Newton         *newton = &solve->newton;
  PetscReal       atol, rtol;
  PetscBool       holds, stuck, mistaken, gain = PETSC_FALSE;
  Judgement       forces;
  const PetscBool flies = (PetscBool)(solve->closing.active && solve->closing.loose >= 0);
  PetscFunctionBegin;
  PetscCall(gains(snes, solve, norm, &gain));
  PetscCall(SNESGetTolerances(snes, &atol, &rtol, NULL, NULL, NULL));
  *reason = SNES_CONVERGED_ITERATING;
  if (PetscIsInfOrNanReal(norm)) {
    *reason = SNES_DIVERGED_FUNCTION_NANORINF;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  newton->unsound[0] = 0;
  forces             = parts_judge(solve->physics, rtol, atol, (PetscBool)(flies || gain));
  newton->drowned    = forces.drowned;
  if (!forces.balance) {
    equilibrium_restart(solve->contact);
    if (forces.hidden < 0) {
      newton->n_unsound = 0;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    PetscCall(parts_hidden_words(solve->physics, forces.hidden, newton->unsound, sizeof(newton->unsound)));
    PetscCall(refuse(newton, PETSC_FALSE, reason));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(judge_contact(solve, rtol, &holds, &stuck, &mistaken));
  if (!holds) {
    if (stuck) *reason = SNES_DIVERGED_LOCAL_MIN; /* likewise; contact->settling.unsettled has words */
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (newton->unsound[0])
    PetscCall(refuse(newton, mistaken, reason));
  else
    *reason = forces.relative ? SNES_CONVERGED_FNORM_RELATIVE : SNES_CONVERGED_FNORM_ABS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode convergence_test(SNES snes, PetscInt iteration, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                                SNESConvergedReason *reason, void *context)
{
  Solve *solve = context;
  PetscFunctionBegin;
  (void)xnorm, (void)snorm;
  PetscCall(judge(snes, solve, fnorm, reason));
  if (*reason > 0 && !closing_settled(solve)) *reason = SNES_CONVERGED_ITERATING;
  if (*reason > 0 && solve->newton.changed) {
    PetscCall(confirm(solve, &fnorm));
    PetscCall(judge(snes, solve, fnorm, reason));
  }
  if (!*reason) PetscCall(watch(solve, iteration, fnorm, reason));
  if (!*reason && iteration == 0 && solve->newton.soft != 1) PetscCall(soften(solve));
  if (!*reason && iteration > 1) {
    PetscReal *norms;
    PetscCall(SNESGetConvergenceHistory(snes, &norms, NULL, NULL));
    if (fnorm > GONE * PetscMax(norms[0], norms[1])) *reason = SNES_DIVERGED_DTOL;
  }
  if (!*reason && solve->newton.gives_up) {
    PetscBool lost;
    PetscCall(is_lost(snes, &lost));
    if (lost) *reason = SNES_DIVERGED_MAX_IT;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
