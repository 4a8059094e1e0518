/* Keys of steps, of the solution of their equations, and of where a run goes on. */
#include "scene/keys.h"

static const char PAGE[] = "c_examples/scenes/steps.md";

static const Key STEPS[] = {
  {"end", KEY_NUMBER, "T", ABOVE(0), "1", "where the last of `count` equal steps ends"},
  {"count", KEY_WHOLE, "", FROM(1), "1", "how many there are"},
  {"times", KEY_NUMBERS, "list [T]", ANY, "", "instead: the times at which steps end"},
  {"stages", KEY_NUMBERS, "list", ANY, "", "instead: pairs of a time and the number of equal steps up to it, `[1, 10, 2, 500]`"},
  {"automatic", KEY_SWITCH, "", ANY, "false",
   "`true`: step lengths from Newton's behaviour between these times: [automatic steps](#automatic-steps)"},
  {"largest", KEY_NUMBER, "T", ABOVE(0), "a tenth of the end", "the largest automatic step"},
  {"initial", KEY_NUMBER, "T", ABOVE(0), "`largest`", "the first automatic step, and the first one after a kink of a curve"},
  {"iterations", KEY_WHOLE, "", FROM(1), "6", "of Newton's method that an automatic step aims at"},
  {"predictor", KEY_SWITCH, "", ANY, "true",
   "extrapolate from the last two steps (not across a kink of a curve). Where it does not, and where full steps from there fail, the start is the "
   "last state, in bodies of finite strain moved with the supports (`solve/first_iterate.c`)"},
  {"cycles", KEY_SWITCH, "", ANY, "true", "look for nodes that cycle, and end that: [nodes that cycle](convergence.md#nodes-that-cycle)"},
  {"closing", KEY_SWITCH, "", ANY, "true",
   "bodies that contact alone holds and that do not touch yet are closed by their loads: [bodies closed by "
   "force](convergence.md#bodies-closed-by-force)"},
  {"smallest", KEY_NUMBER, "", ABOVE_TO(0, 1), "1/1024",
   "a step that does not converge is halved, down to this fraction of the step that was wanted, or of `largest`"},
  {"lever", KEY_NUMBER, "", FROM(1), "2",
   "a body that contact alone holds, and that nothing presses in the end, may be moved so many times as far as all else; farther it counts as "
   "thrown out, and the step as failed. More for a slim wedge that is pressed out: at 10 degrees from its axis it goes 5.7 times as far"},
};

static const Key SOLVER[] = {
  {"unknowns", KEY_WORD, "multipliers displacements", ANY, "multipliers",
   "`multipliers`, beside the displacements; or `displacements` alone: multipliers are condensed (dual ones, and `form: multiplier`, in every "
   "interface). Newton's iterates are the same. The matrix has no zero on its diagonal: `-pc_factor_mat_solver_type petsc`, which exchanges no "
   "rows, gets through (`least_pivot` in summary.json is its least pivot over the largest). Where a support prescribes a component of a node that "
   "has a multiplier there, it is refused"},
  {"solver", KEY_WORD, "direct iterative auto", ANY, "direct",
   "`direct`: MUMPS. `iterative`: GMRES with multigrid. With `unknowns: displacements` about 15 iterations a solve at any size, and linear in time "
   "and memory; with multipliers 30 to 70, which grow with the size, and each body must be held by supports, or the form be `augmented`. Where it "
   "does not converge, the direct solver takes that system, and the run says so. `auto`: `iterative` for bodies in space from 30 000 unknowns on "
   "without multipliers, else `direct`. Options of PETSc: `-iterative_ksp_...`, `-reduced_...` for the multigrid, `-direct_...`; figures in "
   "[scaling](../../docs/scaling.md)"},
  {"snes", KEY_MAP, "", ANY, "", "handed to PETSc's Newton method: `snes: {max_it: 40, linesearch: {type: bt}}`"},
  {"ksp", KEY_MAP, "", ANY, "", "to its linear solvers"},
  {"pc", KEY_MAP, "", ANY, "", "to its preconditioners"},
  {"mat", KEY_MAP, "", ANY, "", "to its matrices"},
};

static const Key RESTART[] = {
  {"restart", KEY_FILE, "", ANY, "", "a restart file that the run goes on from"},
};

const KeyTable KEYS_STEPS[] = {
  KEY_TABLE("steps", "steps", "Steps", PAGE, STEPS),
  KEY_TABLE("solver", "scene", "Equations and solver", PAGE, SOLVER),
  KEY_TABLE("restart", "scene", "Restart files", PAGE, RESTART),
  KEY_TABLES_END};
