/* Pseudo-time: predictor, Newton, cut-back, commit. */
#include "model.h"

PetscErrorCode steps_read(Model *model)
{
  Scene   *scene = model->scene;
  Steps   *steps = &model->steps;
  PetscInt count = 1;

  PetscFunctionBegin;
  steps->predictor = PETSC_TRUE;
  steps->smallest  = 1.0 / 1024;
  scene_reals(scene, "steps", "times", &steps->n_times, &steps->times);
  if (!steps->n_times) {
    scene_int(scene, "steps", "count", &count);
    steps->end = 1;
    scene_real(scene, "steps", "end", &steps->end);
    if (count < 1) scene_fail(scene, "steps", "count", "at least one step is needed.");
    if (steps->end <= 0) scene_fail(scene, "steps", "end", "it must be positive.");
    steps->n_times = count;
    PetscCall(PetscMalloc1(count, &steps->times));
    for (PetscInt k = 0; k < count; k++)
      steps->times[k] = steps->end * (k + 1) / count;
  }
  for (PetscInt k = 0; k < steps->n_times; k++) {
    if (steps->times[k] <= (k ? steps->times[k - 1] : 0))
      scene_fail(scene, "steps", "times", "times must increase, from above 0; %g does not.", (double)steps->times[k]);
  }
  steps->end = steps->times[steps->n_times - 1];
  PetscCall(PetscOptionsHasName(NULL, NULL, "-snes_linesearch_type", &steps->fixed_line_search));
  scene_bool(scene, "steps", "predictor", &steps->predictor);
  scene_real(scene, "steps", "smallest", &steps->smallest);
  if (steps->smallest <= 0 || steps->smallest > 1)
    scene_fail(scene, "steps", "smallest", "it is a fraction of a step: above 0, at most 1.");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a load or a prescribed displacement change its rate at t? Then the past says nothing about the next step. */
static PetscBool bends(const Model *model, PetscReal t)
{
  for (PetscInt l = 0; l < model->n_loads; l++) {
    if (curve_bends(&model->loads[l].curve, t)) return PETSC_TRUE;
  }
  for (PetscInt s = 0; s < model->n_supports; s++) {
    if (curve_bends(&model->supports[s].curve, t)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

typedef struct {
  Vec       x, last, before; /* the iterate; the last two converged states, at: */
  PetscReal t_last, t_before;
  PetscBool have_before; /* on the same branch of all curves */
} History;

static PetscErrorCode predict(Model *model, History *history, PetscReal t)
{
  PetscFunctionBegin;
  PetscCall(VecCopy(history->last, history->x));
  if (model->steps.predictor && history->have_before) {
    const PetscReal factor = (t - history->t_last) / (history->t_last - history->t_before);
    PetscCall(VecAXPY(history->x, factor, history->last));
    PetscCall(VecAXPY(history->x, -factor, history->before));
  } else {
    PetscCall(carry_supports(model, history->t_last, history->x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solve at t; afterwards u_local and f_local belong to the last iterate.
 *
 * Full Newton steps find the states of the nodes fastest, although the residual may grow on the way; a monotone line search
 * can crawl along a kink there. But full steps can also cycle (block scenes at 100 times the default augmentation). So a
 * second attempt backtracks, unless the user chose a line search. */
static PetscErrorCode solve(Model *model, History *history, PetscReal t, PetscBool *converged)
{
  static const SNESLineSearchType types[] = {SNESLINESEARCHBASIC, SNESLINESEARCHBT};
  SNESConvergedReason             reason;
  SNESLineSearch                  line_search;
  PetscInt                        iterations;
  Vec                             r;

  PetscFunctionBegin;
  model->t          = t;
  model->refusal[0] = model->inverted[0] = 0;
  *converged                             = PETSC_FALSE;
  PetscCall(supports_values(model, t));
  PetscCall(loads_values(model, t));
  PetscCall(SNESGetLineSearch(model->snes, &line_search));
  for (int attempt = 0; attempt < (model->steps.fixed_line_search ? 1 : 2) && !*converged; attempt++) {
    if (!model->steps.fixed_line_search) PetscCall(SNESLineSearchSetType(line_search, types[attempt]));
    PetscCall(predict(model, history, t));
    PetscCall(SNESSolve(model->snes, NULL, history->x));
    PetscCall(SNESGetConvergedReason(model->snes, &reason));
    PetscCall(SNESGetIterationNumber(model->snes, &iterations));
    model->iterations += iterations;
    *converged = (PetscBool)(reason > 0);
  }
  if (!*converged) {
    const char *says = model->refusal[0] ? "; the library says: " : "";
    if (!model->quiet)
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, "     t %-10.6g not converged: %s%s%s%s%s\n", (double)t,
                            SNESConvergedReasons[reason], says, model->refusal, model->inverted[0] ? "; " : "",
                            model->inverted));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SNESGetFunction(model->snes, &r, NULL, NULL));
  PetscCall(SNESComputeFunction(model->snes, history->x, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode accept(Model *model, History *history)
{
  PetscFunctionBegin;
  history->have_before = (PetscBool)!bends(model, model->t);
  PetscCall(VecCopy(history->last, history->before));
  PetscCall(VecCopy(history->x, history->last));
  history->t_before        = history->t_last;
  history->t_last          = model->t;
  model->largest_reference = PetscMax(model->largest_reference, model->reference_force);
  PetscCall(solver_refresh_pattern(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode steps_run(Model *model, int *exit_code)
{
  const Steps *steps   = &model->steps;
  History      history = {0};
  Summary     *summary;
  PetscInt     status, cutbacks = 0, step = 0;
  PetscBool    failed = PETSC_FALSE, checked = PETSC_FALSE;

  PetscFunctionBegin;
  *exit_code = 0;
  PetscCall(summary_create(model, &summary));
  PetscCall(DMCreateGlobalVector(model->dm, &history.x));
  PetscCall(VecDuplicate(history.x, &history.last));
  PetscCall(VecDuplicate(history.x, &history.before));
  PetscCall(VecZeroEntries(history.last));
  PetscCall(supports_values(model, 0));
  PetscCall(contact_start(model, history.last, &status));
  if (status) failed = PETSC_TRUE;

  for (PetscInt k = 0; k < steps->n_times && !failed; k++) {
    const PetscReal target = steps->times[k], whole = target - history.t_last;
    PetscReal       fraction = 1; /* of `whole`, halved by cut-backs */
    while (history.t_last < target && !failed) {
      const PetscReal rest      = target - history.t_last;
      PetscBool       converged = PETSC_FALSE, finished = (PetscBool)(fraction * whole > (1 - 1e-9) * rest);
      PetscCall(solve(model, &history, finished ? target : history.t_last + fraction * whole, &converged));
      if (converged) {
        PetscBool last = (PetscBool)(finished && k == steps->n_times - 1);
        PetscCall(summary_step(model, summary, step + 1, PETSC_TRUE, last));
        PetscCall(contact_commit(model, &status));
        converged = (PetscBool)!status;
        if (status) PetscCall(summary_drop_step(model, summary));
      }
      if (converged) {
        step++;
        PetscCall(accept(model, &history));
        if (model->iterations && !checked) { /* the solvers have read their options by now */
          scene_check_unread(model->scene, PETSC_TRUE);
          checked = PETSC_TRUE;
        }
        model->iterations = 0;
        fraction          = PetscMin(1, 2 * fraction);
      } else {
        cutbacks++;
        fraction *= 0.5;
        if (fraction < steps->smallest) failed = PETSC_TRUE;
      }
    }
  }
  if (failed) {
    *exit_code = model->refusal[0] ? 3 : 2;
    PetscCall(summary_step(model, summary, step + 1, PETSC_FALSE, PETSC_TRUE));
    if (model->refusal[0])
      PetscCall(
          PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                       "snes_contact: refused by the library: %s. If Newton's iterates ran away to there: is every body "
                       "held, by supports or by a surface that it touches?\n",
                       model->refusal));
    else
      PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                             "snes_contact: not converged beyond t = %.6g, not even by steps of %.2g times the wanted ones%s%s. If this is "
                             "the beginning: is every body held, by supports or by a surface that it touches? See "
                             "scenes/README.md.\n",
                             (double)history.t_last, (double)(2 * steps->smallest), model->inverted[0] ? ": " : "",
                             model->inverted));
  }
  PetscCall(summary_write(model, &summary, cutbacks, model->refusal[0] ? model->refusal : model->inverted));
  PetscCall(VecDestroy(&history.x));
  PetscCall(VecDestroy(&history.last));
  PetscCall(VecDestroy(&history.before));
  PetscFunctionReturn(PETSC_SUCCESS);
}
