/* The times that steps must meet: those of the scene, those at which supports change, and with automatic steps the kinks of curves. */
#include "solve/solve.h"

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
  steps->initial = steps->largest;
  scene_real(scene, "steps", "initial", &steps->initial);
  if (steps->initial > steps->largest)
    scene_fail(scene, "steps", "initial", "it must be no more than the largest, %g.", (double)steps->largest);
  scene_int(scene, "steps", "iterations", &steps->iterations);
}

/* `times`, each of them; `stages`, pairs of a time and the number of equal steps up to it; or `end` and `count` */
static PetscErrorCode read_targets(Scene *scene, Steps *steps)
{
  static const char *const equal[] = {"end", "count"};
  const PetscBool          staged  = scene_has(scene, "steps", "stages");
  PetscReal      *stages, whole[2] = {0, 0}, start = 0;
  PetscInt        n_stages, count = 0, n = 0;

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

PetscErrorCode times_read(Scene *scene, Steps *steps)
{
  PetscFunctionBegin;
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
  scene_real(scene, "steps", "lever", &steps->lever);
  read_automatic(scene, steps);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Calls `visit` for the curves of every load and support. */
static void each_curve(const Physics *physics, void (*visit)(const Curve *, void *), void *context)
{
  for (PetscInt l = 0; l < physics->n_loads; l++)
    visit(&physics->loads[l].curve, context);
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    visit(&physics->supports[s].curve, context);
    visit(&physics->supports[s].rotate_curve, context);
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
PetscBool times_bend(const Physics *physics, PetscReal t)
{
  Kink kink = {t, PETSC_FALSE};
  each_curve(physics, look_for_kink, &kink);
  return (PetscBool)(kink.bends || timed_bend(physics, t));
}

static void count_points(const Curve *curve, void *context)
{
  *(PetscInt *)context += curve->n;
}

/* A time within the run, unless it is one already. */
static void add_time(PetscReal t, Steps *steps)
{
  for (PetscInt j = 0; j < steps->n_targets; j++) {
    if (curve_same_time(steps->targets[j], t)) return;
  }
  if (t > 0 && t < steps->end) steps->targets[steps->n_targets++] = t;
}

/* Kinks within the run are times to meet. */
static void add_kinks(const Curve *curve, void *context)
{
  Steps *steps = context;
  for (PetscInt k = 0; k < curve->n; k++) {
    if (curve_bends(curve, curve->points[2 * k])) add_time(curve->points[2 * k], steps);
  }
}

/* All times to meet, in order, and which of them the scene asked for. */
PetscErrorCode times_add_kinks(const Physics *physics, Steps *steps)
{
  PetscInt   n_points = 0, next = 0, n_asked = steps->n_targets;
  PetscReal *asked    = steps->targets, *changes;
  PetscInt   n_changes;

  PetscFunctionBegin;
  each_curve(physics, count_points, &n_points);
  PetscCall(PetscMalloc1(n_asked + n_points + 2 * physics->n_supports, &steps->targets));
  PetscCall(PetscMalloc1(2 * physics->n_supports, &changes));
  n_changes = timed_times(physics, changes);
  PetscCall(PetscArraycpy(steps->targets, asked, n_asked));
  for (PetscInt k = 0; k < n_changes; k++)
    add_time(changes[k], steps);
  if (steps->automatic) each_curve(physics, add_kinks, steps);
  PetscCall(PetscSortReal(steps->n_targets, steps->targets));
  PetscCall(PetscCalloc1(steps->n_targets, &steps->asked));
  for (PetscInt k = 0; k < steps->n_targets; k++) {
    steps->asked[k] = (PetscBool)(next < n_asked && steps->targets[k] == asked[next]);
    if (steps->asked[k]) next++;
  }
  PetscCall(PetscFree(changes));
  PetscCall(PetscFree(asked));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode times_destroy(Steps *steps)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(steps->targets));
  PetscCall(PetscFree(steps->asked));
  PetscFunctionReturn(PETSC_SUCCESS);
}
