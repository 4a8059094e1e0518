/* Pseudo-time: predictor, Newton's method, cut-back, commit. */
#include "model.h"

/* `automatic` and what goes with it; lengths of steps are times. */
static void read_automatic(Scene *scene, Steps *steps)
{
  static const char *const keys[] = {"initial", "largest", "iterations"};
  scene_bool(scene, "steps", "automatic", &steps->automatic);
  for (int k = 0; k < 3 && !steps->automatic; k++) {
    if (scene_has(scene, "steps", keys[k])) scene_fail(scene, "steps", keys[k], "it is for `automatic: true` only.");
  }
  steps->largest = 0.1 * steps->end;
  scene_real(scene, "steps", "largest", &steps->largest);
  if (steps->largest <= 0) scene_fail(scene, "steps", "largest", "it must be positive.");
  steps->initial = steps->largest;
  scene_real(scene, "steps", "initial", &steps->initial);
  if (steps->initial <= 0 || steps->initial > steps->largest)
    scene_fail(scene, "steps", "initial", "it must be positive, and no more than the largest, %g.",
               (double)steps->largest);
  steps->iterations = 6;
  scene_int(scene, "steps", "iterations", &steps->iterations);
  if (steps->iterations < 1) scene_fail(scene, "steps", "iterations", "at least one iteration is needed.");
}

/* `times`, each of them; `stages`, pairs of a time and the number of equal steps up to it; or `end` and `count` */
static PetscErrorCode read_targets(Scene *scene, Steps *steps)
{
  static const char *const equal[] = {"end", "count"};
  const PetscBool          staged  = scene_has(scene, "steps", "stages");
  PetscReal      *stages, whole[2] = {1, 1}, start = 0;
  PetscInt        n_stages, count = 1, n = 0;

  PetscFunctionBegin;
  scene_reals(scene, "steps", "times", &steps->n_targets, &steps->targets);
  if (steps->n_targets && staged) scene_fail(scene, "steps", "stages", "give either this or `times`.");
  for (int k = 0; k < 2 && (steps->n_targets || staged); k++) {
    if (scene_has(scene, "steps", equal[k]))
      scene_fail(scene, "steps", equal[k], "`%s` says already when the steps end; give either that, or `end` and `count`.",
                 staged ? "stages" : "times");
  }
  if (steps->n_targets) PetscFunctionReturn(PETSC_SUCCESS);
  scene_reals(scene, "steps", "stages", &n_stages, &stages);
  if (!staged) {
    scene_int(scene, "steps", "count", &count);
    scene_real(scene, "steps", "end", &whole[0]);
    if (count < 1) scene_fail(scene, "steps", "count", "at least one step is needed.");
    if (whole[0] <= 0) scene_fail(scene, "steps", "end", "it must be positive.");
    whole[1] = count;
    n_stages = 2;
  }
  if (n_stages % 2)
    scene_fail(scene, "steps", "stages", "pairs are expected, of a time and the number of steps up to it.");
  for (PetscInt k = 0; k < n_stages; k += 2) {
    const PetscReal *stage = staged ? stages + k : whole;
    if (stage[1] < 1 || stage[1] != PetscFloorReal(stage[1]))
      scene_fail(scene, "steps", "stages", "%g is no number of steps.", (double)stage[1]);
    steps->n_targets += (PetscInt)stage[1];
  }
  PetscCall(PetscMalloc1(steps->n_targets, &steps->targets));
  for (PetscInt k = 0; k < n_stages; k += 2) {
    const PetscReal *stage = staged ? stages + k : whole;
    count                  = (PetscInt)stage[1];
    for (PetscInt j = 0; j < count; j++)
      steps->targets[n++] = j + 1 < count ? start + (stage[0] - start) * (j + 1) / count : stage[0];
    start = stage[0];
  }
  PetscCall(PetscFree(stages));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode steps_read(Model *model)
{
  Scene *scene = model->scene;
  Steps *steps = &model->steps;

  PetscFunctionBegin;
  steps->predictor = PETSC_TRUE;
  steps->cycles    = PETSC_TRUE;
  steps->closing   = PETSC_TRUE;
  steps->smallest  = 1.0 / 1024;
  PetscCall(read_targets(scene, steps));
  for (PetscInt k = 0; k < steps->n_targets; k++) {
    if (steps->targets[k] <= (k ? steps->targets[k - 1] : 0))
      scene_fail(scene, "steps", scene_has(scene, "steps", "stages") ? "stages" : "times",
                 "times must increase, from above 0; %g does not.", (double)steps->targets[k]);
  }
  steps->end = steps->targets[steps->n_targets - 1];
  scene_bool(scene, "steps", "predictor", &steps->predictor);
  scene_bool(scene, "steps", "cycles", &steps->cycles);
  scene_bool(scene, "steps", "closing", &steps->closing);
  scene_real(scene, "steps", "smallest", &steps->smallest);
  if (steps->smallest <= 0 || steps->smallest > 1)
    scene_fail(scene, "steps", "smallest", "it is a fraction of a step: above 0, at most 1.");
  read_automatic(scene, steps);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Calls `visit` for the curves of every load and support. */
static void each_curve(const Model *model, void (*visit)(const Curve *, void *), void *context)
{
  for (PetscInt l = 0; l < model->n_loads; l++)
    visit(&model->loads[l].curve, context);
  for (PetscInt s = 0; s < model->n_supports; s++) {
    visit(&model->supports[s].curve, context);
    visit(&model->supports[s].rotate_curve, context);
  }
}

typedef struct {
  PetscReal t;
  PetscBool bends;
} Kink;

static void look_for_kink(const Curve *curve, void *context)
{
  Kink *kink  = context;
  kink->bends = (PetscBool)(kink->bends || curve_bends(curve, kink->t));
}

/* Does a load or a prescribed displacement change its rate at t? Then the past says nothing about the next step. */
static PetscBool bends(const Model *model, PetscReal t)
{
  Kink kink = {t, PETSC_FALSE};
  each_curve(model, look_for_kink, &kink);
  return kink.bends;
}

static void count_points(const Curve *curve, void *context)
{
  *(PetscInt *)context += curve->n;
}

/* A kink within the run is a time to meet, unless it is one already. */
static void add_kinks(const Curve *curve, void *context)
{
  Steps *steps = context;
  for (PetscInt k = 0; k < curve->n; k++) {
    const PetscReal t = curve->points[2 * k];
    PetscBool       known = PETSC_FALSE;
    for (PetscInt j = 0; j < steps->n_targets; j++)
      known = (PetscBool)(known || curve_same_time(steps->targets[j], t));
    if (t > 0 && t < steps->end && !known && curve_bends(curve, t)) steps->targets[steps->n_targets++] = t;
  }
}

/* With automatic steps: all times to meet, in order, and which of them the scene asked for. */
static PetscErrorCode add_targets(Model *model)
{
  Steps    *steps    = &model->steps;
  PetscInt  n_points = 0, next = 0, n_asked = steps->n_targets;
  PetscReal *asked   = steps->targets;

  PetscFunctionBegin;
  each_curve(model, count_points, &n_points);
  PetscCall(PetscMalloc1(n_asked + n_points, &steps->targets));
  PetscCall(PetscArraycpy(steps->targets, asked, n_asked));
  if (steps->automatic) each_curve(model, add_kinks, steps);
  PetscCall(PetscSortReal(steps->n_targets, steps->targets));
  PetscCall(PetscCalloc1(steps->n_targets, &steps->asked));
  for (PetscInt k = 0; k < steps->n_targets; k++) {
    steps->asked[k] = (PetscBool)(next < n_asked && steps->targets[k] == asked[next]);
    if (steps->asked[k]) next++;
  }
  PetscCall(PetscFree(asked));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  Vec       x, start, last, before; /* the iterate; where it starts; the last two converged states, at: */
  PetscReal t_last, t_before;
  PetscBool have_before; /* on the same branch of all curves */
  PetscBool tried;       /* a step has been solved, or tried */
  PetscBool converged;   /* the last attempt had, so that its commit was refused if the library refused */
} History;

static PetscErrorCode history_create(Model *model, History *history)
{
  PetscFunctionBegin;
  *history = (History){0};
  PetscCall(DMCreateGlobalVector(model->dm, &history->x));
  PetscCall(VecDuplicate(history->x, &history->start));
  PetscCall(VecDuplicate(history->x, &history->last));
  PetscCall(VecDuplicate(history->x, &history->before));
  PetscCall(VecZeroEntries(history->last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode history_destroy(History *history)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&history->x));
  PetscCall(VecDestroy(&history->start));
  PetscCall(VecDestroy(&history->last));
  PetscCall(VecDestroy(&history->before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode predict(Model *model, History *history, PetscReal t)
{
  PetscFunctionBegin;
  PetscCall(VecCopy(history->last, history->start));
  if (model->steps.predictor && history->have_before) {
    const PetscReal factor = (t - history->t_last) / (history->t_last - history->t_before);
    PetscCall(VecAXPY(history->start, factor, history->last));
    PetscCall(VecAXPY(history->start, -factor, history->before));
  } else {
    PetscCall(carry_supports(model, history->t_last, history->start));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solve at t and commit; `last`: t is the end of the run. */
static PetscErrorCode step_to(Model *model, Summary *summary, History *history, PetscInt step, PetscReal t,
                              PetscBool asked, PetscBool last, PetscBool *done)
{
  PetscInt refused;
  PetscFunctionBegin;
  model->t = t;
  PetscCall(supports_values(model, t));
  PetscCall(loads_values(model, t));
  PetscCall(predict(model, history, t));
  PetscCall(newton_solve(model, history->start, history->x, done));
  model->iterations += model->newton.iterations;
  history->tried     = PETSC_TRUE;
  history->converged = *done;
  if (*done) {
    PetscCall(summary_step(model, summary, step, PETSC_TRUE, asked, last));
    PetscCall(contact_commit(model, &refused));
    *done = (PetscBool)!refused;
    PetscCall(summary_settle_step(model, summary, *done));
    if (refused) {
      model->newton.refused_commit = PETSC_TRUE;
      PetscCall(PetscSNPrintf(model->newton.why, sizeof(model->newton.why), "converged, but refused at its commit: %s",
                              model->refusal));
    }
  }
  if (!*done) PetscCall(summary_failed_attempt(model, summary, history->t_last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode accept(Model *model, History *history)
{
  PetscFunctionBegin;
  /* How a gap closes is no rate, either. */
  history->have_before = (PetscBool)(!bends(model, model->t) && !model->closing.ever_cut);
  PetscCall(VecCopy(history->last, history->before));
  PetscCall(VecCopy(history->x, history->last));
  history->t_before        = history->t_last;
  history->t_last          = model->t;
  model->iterations        = 0;
  parts_accept(model);
  equilibrium_accept(model);
  PetscCall(solver_refresh_pattern(model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The run has ended before its end. */
static PetscErrorCode give_up(Model *model, const History *history, int *exit_code)
{
  char held[1024];
  PetscFunctionBegin;
  PetscCall(held_describe(model, held, sizeof(held)));
  *exit_code = model->refusal[0] ? 3 : 2;
  if (model->refusal[0] && !history->tried)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "snes_contact: refused by the library: %s. That is so at t = 0, before the first step.\n",
                           model->refusal));
  else if (model->refusal[0] && history->converged)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "snes_contact: refused by the library: %s. That is the commit of the step from t = %.6g to "
                           "%.6g, which had converged.\n",
                           model->refusal, (double)history->t_last, (double)model->t));
  else if (model->refusal[0])
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "snes_contact: refused by the library: %s. Newton's iterates may have run away to there: %s\n",
                           model->refusal, held));
  else
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "snes_contact: not converged beyond t = %.6g, not even by a step of %.2g: %s. %s See "
                           "scenes/README.md.\n",
                           (double)history->t_last, (double)(model->t - history->t_last), model->newton.why, held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode steps_run(Model *model, int *exit_code)
{
  Steps    *steps = &model->steps;
  StepSize  size;
  History   history;
  Summary  *summary;
  PetscInt  status, cutbacks = 0, step = 0;
  PetscBool failed, checked = PETSC_FALSE, done;

  PetscFunctionBegin;
  *exit_code = 0;
  PetscCall(add_targets(model));
  PetscCall(summary_create(model, &summary));
  PetscCall(history_create(model, &history));
  PetscCall(supports_values(model, 0));
  PetscCall(contact_start(model, history.last, &status));
  failed = (PetscBool)(status != 0);
  step_size_start(steps, &size);
  while (!failed && history.t_last < steps->end) {
    const PetscReal t = step_size_next(steps, &size, history.t_last), target = steps->targets[size.next];
    PetscCall(step_to(model, summary, &history, step + 1, t, (PetscBool)(t == target && steps->asked[size.next]),
                      (PetscBool)(t == steps->end), &done));
    if (done) {
      if (model->iterations && !checked) { /* the solvers have read their options by now */
        scene_check_unread(model->scene, PETSC_TRUE);
        checked = PETSC_TRUE;
      }
      step_size_accept(steps, &size, history.t_last, t, &model->newton, bends(model, t));
      PetscCall(accept(model, &history));
      step++;
    } else {
      cutbacks++;
      failed = (PetscBool)!step_size_cut(steps, &size, t - history.t_last);
    }
  }
  if (failed) {
    PetscCall(summary_step(model, summary, step + 1, PETSC_FALSE, PETSC_FALSE, PETSC_TRUE));
    PetscCall(give_up(model, &history, exit_code));
  }
  PetscCall(summary_write(model, &summary, history.last, cutbacks,
                          *exit_code == 2 ? model->newton.why : model->refusal));
  PetscCall(history_destroy(&history));
  PetscFunctionReturn(PETSC_SUCCESS);
}
