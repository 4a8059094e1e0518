/* Which time comes next: the times of the scene, and with `steps: {automatic: true}` the steps between them.
 *
 * All times given and all kinks of curves are met exactly. Fixed steps go from one to the next, and a step that
 * fails is halved until it succeeds. Automatic steps aim at n* = `iterations` of Newton's method: a step that took n
 * is followed by one sqrt(n* / n) times as long (the root, for one step's number says little about the next), within
 * the bounds below. */
#include "solve/solve.h"

/* No step is more than GROWTH times as long as the one before, or SEARCHING times where the residual rose on the
 * way: then Newton's method was looking for the states of the nodes, and might not find them from farther away. */
static const PetscReal GROWTH = 2, SEARCHING = 1.25, SHRINKAGE = 0.5, CUT = 0.5;
/* Where IN_VAIN steps in a row were made shorter and took no fewer iterations, their length is not to blame: the next
 * one is as long as before. (A tube drawn over a coarse mesh takes 7 iterations at any length; aiming at 6, the steps
 * would shrink for ever.) */
enum { IN_VAIN = 3 };
/* Where surfaces with frozen weights slide, a step aims at so much of what they may: slides are even, if anything. */
static const PetscReal SLIDE_AIM = 0.9;
/* After a cut-back this many steps do not grow, else every other step would fail. */
enum { HELD = 3 };
/* Times closer than this fraction of a step are one. */
static const PetscReal SAME = 1e-9;

void step_size_start(const Steps *steps, StepSize *size)
{
  *size         = (StepSize){0};
  size->length  = steps->automatic ? steps->initial : steps->targets[0];
  size->longest = steps->automatic ? steps->largest : size->length;
}

/* As long as it may be, after a step that could not be short enough. */
void step_size_anew(const Steps *steps, StepSize *size)
{
  size->length = steps->automatic ? steps->initial : size->longest;
  size->held   = 0;
}

PetscReal step_size_next(const Steps *steps, const StepSize *size, PetscReal t)
{
  const PetscReal target = steps->targets[size->next], rest = target - t;
  if (size->length > (1 - SAME) * rest) return target;
  if (steps->automatic && 2 * size->length > rest) return t + rest / 2; /* no sliver before the target */
  return t + size->length;
}

/* After the step from t_last to t. `bends`: a curve has a kink at t, so the past says nothing about what comes. */
static void keep_slide(StepSize *size, PetscReal tried, const Newton *newton)
{
  if (newton->slid > 0) size->length = PetscMin(size->length, SLIDE_AIM / newton->slid * tried);
}

void step_size_accept(const Steps *steps, StepSize *size, PetscReal t_last, PetscReal t, const Newton *newton,
                      PetscBool bends)
{
  const PetscReal taken = t - t_last;
  const PetscBool there = (PetscBool)(t == steps->targets[size->next]);

  if (there && size->next + 1 < steps->n_targets) size->next++;
  if (!steps->automatic) {
    if (there) size->longest = steps->targets[size->next] - t;
    size->length = there ? size->longest : PetscMin(size->longest, 2 * size->length);
    keep_slide(size, taken, newton);
    return;
  }
  {
    PetscReal factor = newton->iterations ? PetscSqrtReal((PetscReal)steps->iterations / newton->iterations) : GROWTH;
    factor           = PetscMax(SHRINKAGE, PetscMin(factor, newton->monotone ? GROWTH : SEARCHING));
    if (size->n_shorter == IN_VAIN && factor < 1) {
      if (newton->iterations >= size->iterations_before) factor = size->length_before / taken;
      size->n_shorter = 0;
    } else if (factor < 1) {
      if (size->n_shorter++ == 0) size->iterations_before = newton->iterations, size->length_before = taken;
    } else {
      size->n_shorter = 0;
    }
    if (factor < 1) {
      size->length = PetscMin(size->length, factor * taken);
    } else if (size->held > 0) { /* one cut short by a target says nothing against the length that was wanted */
      size->length = PetscMax(size->length, taken);
    } else {
      size->length = PetscMax(size->length, factor * taken);
    }
    size->held   = PetscMax(0, size->held - 1);
    size->length = PetscMax(steps->smallest * steps->largest, size->length);
    size->length = PetscMin(size->length, bends ? steps->initial : steps->largest);
    keep_slide(size, taken, newton);
  }
}

PetscBool step_size_cut(const Steps *steps, StepSize *size, PetscReal tried, const Newton *newton)
{
  size->length = CUT * tried;
  keep_slide(size, tried, newton);
  size->held   = HELD;
  return (PetscBool)(size->length >= (1 - SAME) * steps->smallest * size->longest);
}
