/* One load step by Newton's method: attempts from the same start.
 *
 * Full Newton steps find the states of the nodes fastest, although the residual may grow on the way; a monotone line
 * search can crawl along a kink there. But full steps can also cycle between guesses of the states, where the
 * augmentation is large (slip that turns round; block scenes at 1e2 times its default and more) or small
 * (klarbring.yaml). The answer does not depend on it, so where cycling.c finds a cycle, the augmentation of the
 * nodes that cycle is changed, CHANGES times at most in one attempt:
 *   1. full steps; a cycle divides the augmentation by 100;
 *   2. backtracking; a cycle divides it, too;
 *   3. if there were cycles, full steps; a cycle multiplies it by 100;
 *   4. where the supports leave a body free to move, the attempt of closing.c: the first one, if such a body is loose
 *      at the start of the step, else the last;
 *   5. if all fail, the caller takes a shorter step in time.
 * Where the user chose a line search it serves in 1, 3 and 4, and 2 is left out. Converged is what has converged with
 * the scene's own augmentation: the multiplier rows are forces of the augmentation, and would look small with a
 * small one. (Tried as well: a step damped by 1/2, 1/4, 1/8. It ends the cycles of fewer scenes, and later.)
 *
 * A failed attempt leaves nothing behind: the library's history changes on commit only, the augmentation is the
 * scene's again, and the matrix gets back the pattern that it had, so that the next factorisation is that of a run
 * in which the attempt never was. */
#include "model.h"
#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

enum { CHANGES = 3, FULL = 0, BACKTRACKING = 1, LARGER = 2, CLOSING = 3, N_ATTEMPTS = 4 };
/* Iterations of the closing attempt: each closes a gap by part of a facet. Other attempts: -snes_max_it. */
enum { CLOSING_ITERATIONS = 60 };
static const struct {
  SNESLineSearchType line_search;
  PetscReal          factor; /* of the augmentation of nodes that cycle */
} ATTEMPTS[N_ATTEMPTS] = {[FULL]         = {SNESLINESEARCHBASIC, 0.01},
                         [BACKTRACKING] = {SNESLINESEARCHBT, 0.01},
                         [LARGER]       = {SNESLINESEARCHBASIC, 100},
                         [CLOSING]      = {SNESLINESEARCHBASIC, 0.01}};

/* rank 0: a cycle for the report, and as a sentence */
static PetscErrorCode report_cycle(Model *model, PetscInt period, PetscInt iteration)
{
  Newton *newton = &model->newton;
  cJSON  *json   = cJSON_CreateObject();
  char    nodes[768];
  PetscFunctionBegin;
  cJSON_AddNumberToObject(json, "t", model->t);
  cJSON_AddNumberToObject(json, "iteration", iteration);
  PetscCall(cycling_describe(model, period, json, nodes, sizeof(nodes)));
  PetscCall(PetscSNPrintf(newton->cycle, sizeof(newton->cycle),
                          "the states of nodes repeat every %" PetscInt_FMT " iterations:%s", period, nodes));
  if (!newton->cycles) newton->cycles = cJSON_CreateArray();
  cJSON_AddItemToArray(newton->cycles, json);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After an iteration that has not converged: does it cycle, and what now? */
PetscErrorCode newton_watch(Model *model, PetscInt iteration, PetscReal norm, SNESConvergedReason *reason)
{
  Newton  *newton = &model->newton;
  PetscInt period;
  PetscFunctionBegin;
  if (model->closing.away[0]) {
    *reason = SNES_DIVERGED_LOCAL_MIN;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (model->closing.cut) PetscCall(cycling_restart(model)); /* states of steps that were cut come back */
  PetscCall(cycling_record(model, norm, &period));
  if (!period || !model->steps.cycles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(report_cycle(model, period, iteration));
  if (newton->n_changes == CHANGES) {
    *reason         = SNES_DIVERGED_LOCAL_MIN; /* of PETSc's names the nearest; the report has its own words */
    newton->stopped = PETSC_TRUE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(cycling_change_augmentation(model, period, newton->factor));
  PetscCall(cycling_restart(model));
  newton->n_changes++;
  newton->changed = newton->stale = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The iterate has converged. With the scene's augmentation, too? Returns the norm of that residual. */
PetscErrorCode newton_confirm(Model *model, PetscReal *norm)
{
  Vec x, r;
  PetscFunctionBegin;
  if (!model->newton.changed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(contact_scale_augmentation(model, NULL, 1));
  PetscCall(cycling_restart(model));
  PetscCall(SNESGetSolution(model->snes, &x));
  PetscCall(VecDuplicate(x, &r));
  PetscCall(SNESComputeFunction(model->snes, x, r));
  PetscCall(VecNorm(r, NORM_2, norm));
  PetscCall(VecDestroy(&r));
  model->newton.changed = PETSC_FALSE;
  model->newton.stale   = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SNES calls it before each iteration: residual and tangent must speak of the same augmentation. */
static PetscErrorCode before_iteration(SNES snes, PetscInt iteration)
{
  Model *model;
  Vec    x, r;
  PetscFunctionBegin;
  (void)iteration;
  PetscCall(SNESGetApplicationContext(snes, &model));
  if (!model->newton.stale) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetSolution(snes, &x));
  PetscCall(SNESGetFunction(snes, &r, NULL, NULL));
  PetscCall(SNESComputeFunction(snes, x, r));
  model->newton.stale = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode newton_create(Model *model)
{
  SNESLineSearch line_search;
  PetscFunctionBegin;
  PetscCall(SNESSetApplicationContext(model->snes, model));
  PetscCall(SNESGetLineSearch(model->snes, &line_search));
  PetscCall(closing_limit_steps(model, line_search));
  PetscCall(SNESSetUpdate(model->snes, before_iteration));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-snes_linesearch_type", &model->newton.fixed_line_search));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-snes_max_it", &model->newton.fixed_max_it));
  PetscCall(cycling_create(model));
  PetscCall(closing_create(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode newton_destroy(Model *model)
{
  PetscFunctionBegin;
  PetscCall(cycling_destroy(model));
  PetscCall(closing_destroy(model));
  cJSON_Delete(model->newton.cycles);
  cJSON_Delete(model->newton.state_changes);
  model->newton.cycles = model->newton.state_changes = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *in_words(SNESConvergedReason reason)
{
  switch (reason) {
  case SNES_DIVERGED_LINE_SEARCH:
    return "no step along Newton's direction lowers the residual";
  case SNES_DIVERGED_MAX_IT:
    return "too many iterations";
  case SNES_DIVERGED_LINEAR_SOLVE:
    return "the matrix is singular";
  case SNES_DIVERGED_FNORM_NAN:
    return "the residual is no number any more";
  default:
    return "Newton's method failed";
  }
}

/* Why it ended: the library or a cell refused; a cycle, in this attempt or an earlier one; or what SNES says, with
 * the nodes that still changed state. */
static PetscErrorCode explain(Model *model, SNESConvergedReason reason)
{
  Newton *newton = &model->newton;
  cJSON  *json;
  char    nodes[768];
  PetscFunctionBegin;
  if (model->closing.away[0]) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "%s", model->closing.away));
  } else if (model->refusal[0]) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "the library says: %s", model->refusal));
  } else if (model->inverted[0]) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "%s", model->inverted));
  } else if (newton->cycle[0]) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "%s%s%s", newton->cycle,
                            newton->stopped ? "" : "; at last: ", newton->stopped ? "" : in_words(reason)));
  } else if (newton->drowned >= 0) {
    const Part *part = &model->parts[newton->drowned];
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why),
                            "the loads on a body with E = %.3g, %.2g in all, are lost in the rounding of its own forces, "
                            "%.2g: make it less stiff, or `type: analytic`, or load it by a prescribed displacement",
                            (double)part->young, (double)part->loads, (double)part->residual));
  } else if (newton->unsettled[0] && reason != SNES_DIVERGED_LINEAR_SOLVE) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why),
                            "the forces balance, but the contact is not in equilibrium (%s); where augmentation_scale is "
                            "small, raise it; where the node is hardly covered, give weak_coverage: 0.5",
                            newton->unsettled));
  } else {
    json = cJSON_CreateObject();
    PetscCall(cycling_describe(model, 0, json, nodes, sizeof(nodes)));
    cJSON_Delete(json);
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "%s (%s)%s%s", in_words(reason),
                            SNESConvergedReasons[reason], nodes[0] ? "; states in the last iterations:" : "", nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Attempt k from x, which becomes the last iterate. */
static PetscErrorCode attempt(Model *model, int k, Vec x, PetscBool *converged)
{
  Newton             *newton = &model->newton;
  SNESConvergedReason reason;
  SNESLineSearch      line_search;
  PetscReal          *norms;
  PetscReal           atol, rtol, stol;
  PetscInt            iterations, n, max_it, max_f;

  PetscFunctionBegin;
  PetscCall(SNESGetLineSearch(model->snes, &line_search));
  if (!newton->fixed_line_search) PetscCall(SNESLineSearchSetType(line_search, ATTEMPTS[k].line_search));
  PetscCall(SNESGetTolerances(model->snes, &atol, &rtol, &stol, &max_it, &max_f));
  if (k == CLOSING && !newton->fixed_max_it)
    PetscCall(SNESSetTolerances(model->snes, atol, rtol, stol, CLOSING_ITERATIONS, max_f));
  closing_begin(model, (PetscBool)(k == CLOSING));
  PetscCall(cycling_restart(model));
  equilibrium_restart(model);
  newton->drowned   = -1;
  model->refusal[0] = model->inverted[0] = newton->why[0] = 0;
  newton->stopped = newton->stale = newton->changed = newton->refused_commit = PETSC_FALSE;
  newton->monotone                                  = PETSC_TRUE;
  newton->n_changes                                 = 0;
  cJSON_Delete(newton->state_changes);
  newton->state_changes = cJSON_CreateArray();
  newton->factor                                    = ATTEMPTS[k].factor;
  PetscCall(SNESSolve(model->snes, NULL, x));
  PetscCall(SNESSetTolerances(model->snes, atol, rtol, stol, max_it, max_f));
  PetscCall(SNESGetConvergedReason(model->snes, &reason));
  PetscCall(SNESGetIterationNumber(model->snes, &iterations));
  PetscCall(SNESGetConvergenceHistory(model->snes, &norms, NULL, &n));
  for (PetscInt j = 1; j < n; j++) {
    if (norms[j] >= norms[j - 1]) newton->monotone = PETSC_FALSE;
  }
  newton->iterations += iterations;
  *converged = (PetscBool)(reason > 0);
  if (newton->changed) PetscCall(contact_scale_augmentation(model, NULL, 1));
  if (!*converged) {
    PetscCall(explain(model, reason));
    if (reason == SNES_DIVERGED_LINEAR_SOLVE) PetscCall(solver_forget_factors(model));
    PetscCall(solver_restore_pattern(model));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode newton_solve(Model *model, Vec start, Vec x, PetscBool *converged)
{
  Newton   *newton = &model->newton;
  PetscBool first;
  Vec       r;

  PetscFunctionBegin;
  newton->iterations = 0;
  newton->cycle[0]   = 0;
  *converged         = PETSC_FALSE;
  closing_begin(model, PETSC_FALSE);
  PetscCall(closing_needed(model, start, &first));
  for (int i = 0; i < N_ATTEMPTS && !*converged; i++) {
    const int k = first ? (i + CLOSING) % N_ATTEMPTS : i;
    if (k == BACKTRACKING && newton->fixed_line_search) continue;
    if (k == LARGER && !newton->cycle[0]) continue;
    if (k == CLOSING && !model->closing.possible) continue;
    if (model->closing.away[0]) break; /* whatever the attempt, nothing stops that body */
    PetscCall(VecCopy(start, x));
    PetscCall(attempt(model, k, x, converged));
  }
  if (!*converged) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetFunction(model->snes, &r, NULL, NULL));
  PetscCall(SNESComputeFunction(model->snes, x, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}
