/* One load step by Newton's method: attempts, from the same start but for one.
 *
 * Full Newton steps find the states of the nodes fastest, although the residual may grow on the way; a monotone line
 * search can crawl along a kink there. But full steps can also cycle between guesses of the states, where the
 * augmentation is large (slip that turns round; block scenes at 1e2 times its default and more) or small
 * (klarbring.yaml). The answer does not depend on it, so where cycling.c finds a cycle, the augmentation of the
 * nodes that cycle is changed, a few times at most in one attempt:
 *   1. full steps; a cycle divides the augmentation by 100. Where nothing but what is open makes a difference there may be as many as
 *      that can take, for thin bodies open node by node, and in a shorter step in time as many nodes do;
 *      if they have thrown the bodies about, damped ones with a hundredth of the augmentation of all nodes. The default one is that of
 *      a solid body: where a thin one is curved, gaps of second order in a step of Newton's method open all of its nodes. A step after
 *      one that was solved so begins so, by full steps where the start is extrapolated;
 *   2. in the first step, where the supports leave a body free to move, the same without the slight compression that nodes which touch
 *      start with (contact_start()): where another interface holds the body away from them, they seem to stick;
 *   3. if normals follow the motion, the same in two phases: with the normals of the start of the step, and from there with
 *      the current ones. Deep contact over facets that turn much needs it;
 *   4. if the start was extrapolated, as 1 from the start that is not (first_iterate.c);
 *   5. backtracking; a cycle divides it, too;
 *   6. if there were cycles, full steps; a cycle multiplies it by 100;
 *   7. where the supports leave a body free to move, the attempt of closing.c: the first one, if such a body is loose
 *      at the start of the step, else the last;
 *   8. where friction holds such a body, in two phases: under friction that lets nothing slip, and from there under the scene's.
 *      Where all nodes that touch are taken to slip at the start, nothing else has a stiffness along the surface;
 *   9. if all fail, the caller takes a shorter step in time.
 * Where contact alone holds a body, Newton's method may throw it out of contact, and there it is in equilibrium. So an
 * attempt after which a body is loose that was not loose before counts if no other one converges with it in contact. One that
 * moves a body further than anything could have pushed it there, without any force, counts for nothing (thrown.c).
 * An extrapolated start may lie beyond the friction cone although the answer does not. Full steps fail there, and
 * damped ones lead to another equilibrium, in which the nodes have slid: hence 4, and before 5. From the start of 4
 * damped steps crawl where bodies strain much (rounded sliders of the press fit: 15 cut-backs instead of 4). So the
 * others have the first start again. Where the user chose a line search it serves in all but 5, which is left out.
 * Converged is what has converged with the scene's own augmentation: the multiplier rows are forces of the
 * augmentation, and would look small with a small one. (Tried as well: a step damped by 1/2, 1/4, 1/8. It ends the
 * cycles of fewer scenes, and later.)
 *
 * A failed attempt leaves nothing behind: the library's history changes on commit only, the augmentation is the
 * scene's again, and the matrix gets back the pattern that it had, so that the next factorisation is that of a run
 * in which the attempt never was. */
#include "solve/solve.h"
#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

enum { FULL, SOFTER, BARE, SETTLING, PLAIN, BACKTRACKING, LARGER, CLOSING, STICKING, N_ATTEMPTS };
/* Of the augmentation of all nodes in one attempt: what the default is too large by for facets three times as long as the body is thick,
 * which bend like the third power of that. */
static const PetscReal SOFT = 0.01;
/* Iterations of the closing attempt: each closes a gap by part of a facet. Other attempts: -snes_max_it. */
enum { CLOSING_ITERATIONS = 60 };
/* Iterations of full steps, for each node of the contact, where bodies are linear and nothing rubs: no set of states comes twice then, or
 * it is a cycle, and as a rule a node changes its mind no more often. */
enum { ITERATIONS_A_NODE = 2 };
static const struct {
  SNESLineSearchType line_search;
  PetscReal          factor; /* of the augmentation of nodes that cycle */
} ATTEMPTS[N_ATTEMPTS] = {[FULL]         = {SNESLINESEARCHNONE, 0.01},
                         [SOFTER]       = {SNESLINESEARCHBT, 0.01},
                         [BARE]         = {SNESLINESEARCHNONE, 0.01},
                         [SETTLING]     = {SNESLINESEARCHNONE, 0.01},
                         [PLAIN]        = {SNESLINESEARCHNONE, 0.01},
                         [BACKTRACKING] = {SNESLINESEARCHBT, 0.01},
                         [LARGER]       = {SNESLINESEARCHNONE, 100},
                         [CLOSING]      = {SNESLINESEARCHNONE, 0.01},
                         [STICKING]     = {SNESLINESEARCHNONE, 0.01}};

/* SNES calls it before each iteration: residual and tangent must speak of the same augmentation. */
static PetscErrorCode before_iteration(SNES snes, PetscInt iteration)
{
  Solve *solve;
  Vec    x, r;
  PetscFunctionBegin;
  (void)iteration;
  PetscCall(SNESGetApplicationContext(snes, &solve));
  if (!solve->newton.stale) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetSolution(snes, &x));
  PetscCall(SNESGetFunction(snes, &r, NULL, NULL));
  PetscCall(SNESComputeFunction(snes, x, r));
  solve->newton.stale = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode newton_create(Solve *solve)
{
  SNESLineSearch line_search;
  PetscFunctionBegin;
  PetscCall(solver_create(solve));
  PetscCall(SNESSetConvergenceTest(solve->snes, convergence_test, solve, NULL));
  PetscCall(solver_configure(solve));
  PetscCall(SNESSetApplicationContext(solve->snes, solve));
  PetscCall(SNESGetLineSearch(solve->snes, &line_search));
  PetscCall(closing_limit_steps(solve, line_search));
  PetscCall(SNESSetUpdate(solve->snes, before_iteration));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-snes_linesearch_type", &solve->newton.fixed_line_search));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-snes_max_it", &solve->newton.fixed_max_it));
  PetscCall(cycling_create(solve));
  PetscCall(closing_create(solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode newton_destroy(Solve *solve)
{
  PetscFunctionBegin;
  PetscCall(cycling_destroy(solve));
  PetscCall(closing_destroy(solve));
  cJSON_Delete(solve->newton.cycles);
  cJSON_Delete(solve->newton.state_changes);
  solve->newton.cycles = solve->newton.state_changes = NULL;
  PetscCall(solver_destroy(solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `linear`: what refusal_describe() says of a linear system that is not solved */
static const char *in_words(SNESConvergedReason reason, const char *linear)
{
  switch (reason) {
  case SNES_DIVERGED_LINE_SEARCH:
    return "no step along Newton's direction lowers the residual";
  case SNES_DIVERGED_MAX_IT:
    return "too many iterations";
  case SNES_DIVERGED_LINEAR_SOLVE:
    return linear;
  case SNES_DIVERGED_DTOL:
    return "bodies are thrown out of the model";
  case SNES_DIVERGED_FUNCTION_NANORINF:
    return "the residual is no number any more";
  default:
    return "Newton's method failed";
  }
}

/* Where nothing may slip, a node that pulls where it sticks and overlaps where it is open has no state. */
static const char *of_rough(const Contact *contact)
{
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    if (contact->interfaces[i].options.friction == STICKSLIP_FRICTION_ROUGH)
      return ". With `law: rough` a node that would pull where it sticks, and overlap where it is open, has no state of rest; with "
             "`law: coulomb` and `friction: 10` it has";
  }
  return "";
}

/* Why it ended: the library or a cell refused; loads that rounding hides, under which nodes may cycle as well; a cycle, in this attempt
 * or an earlier one; or what SNES says, with the nodes that still changed state. */
static PetscErrorCode explain(Solve *solve, SNESConvergedReason reason)
{
  Physics *physics = solve->physics;
  Contact *contact = solve->contact;
  Newton  *newton  = &solve->newton;
  cJSON   *json;
  char     nodes[768], linear[REFUSAL_LENGTH] = "";
  KSP      ksp;
  PetscFunctionBegin;
  PetscCall(SNESGetKSP(solve->snes, &ksp));
  if (solve->linear.refusal[0]) {
    PetscCall(PetscSNPrintf(linear, sizeof(linear), "%s", solve->linear.refusal));
  } else if (reason == SNES_DIVERGED_LINEAR_SOLVE) {
    PetscCall(refusal_describe(ksp, linear, sizeof(linear)));
  }
  if (solve->closing.away[0]) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "%s", solve->closing.away));
  } else if (contact->refusal[0]) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "the library says: %s", contact->refusal));
  } else if (physics->inverted[0]) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "%s", physics->inverted));
  } else if (newton->drowned >= 0) {
    const Part *part = &physics->parts.part[newton->drowned];
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why),
                            "the loads on a body with E = %.3g, %.2g in all, are lost in the rounding of its own forces, "
                            "%.2g: make it less stiff, or `type: analytic`, or load it by a prescribed displacement",
                            (double)part->young, (double)part->loads, (double)part->residual));
  } else if (newton->unsound[0]) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "%s", newton->unsound));
  } else if (newton->cycle[0]) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "%s%s%s%s", newton->cycle,
                            newton->stopped ? "" : "; at last: ", newton->stopped ? "" : in_words(reason, linear), of_rough(contact)));
  } else if (contact->settling.unsettled[0] && reason != SNES_DIVERGED_LINEAR_SOLVE) {
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why),
                            "the forces balance, but the contact is not in equilibrium (%s); where augmentation_scale (with "
                            "decision: points, modulus) is small, raise it; where the node is hardly covered, give weak_coverage: 0.5",
                            contact->settling.unsettled));
  } else {
    json = cJSON_CreateObject();
    PetscCall(cycling_describe(solve, 0, json, nodes, sizeof(nodes)));
    cJSON_Delete(json);
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "%s (%s)%s%s", in_words(reason, linear),
                            SNESConvergedReasons[reason], nodes[0] ? "; states in the last iterations:" : "", nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves from x, which becomes the last iterate, and counts. Where a solver asks for more workspace it goes on from there. */
static PetscErrorCode solve_from(Solve *solve, Vec x, SNESConvergedReason *reason)
{
  Newton    *newton = &solve->newton;
  PetscReal *norms;
  PetscInt   iterations, n;
  PetscBool  again = PETSC_TRUE;
  PetscFunctionBegin;
  while (again) {
    PetscCall(cycling_restart(solve));
    equilibrium_restart(solve->contact);
    PetscCall(SNESSolve(solve->snes, NULL, x));
    PetscCall(SNESGetConvergedReason(solve->snes, reason));
    PetscCall(SNESGetIterationNumber(solve->snes, &iterations));
    PetscCall(SNESGetConvergenceHistory(solve->snes, &norms, NULL, &n));
    for (PetscInt j = 1; j < n; j++) {
      if (norms[j] >= norms[j - 1]) newton->monotone = PETSC_FALSE;
      if (convergence_throws(norms[0], norms[j])) newton->threw = PETSC_TRUE;
    }
    newton->iterations += iterations;
    again = PETSC_FALSE;
    if (*reason == SNES_DIVERGED_LINEAR_SOLVE) PetscCall(solver_give_room(solve, &again));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is which nodes are open all that makes the model nonlinear? */
static PetscBool only_opens(const Solve *solve)
{
  const Contact *contact = solve->contact;
  for (PetscInt b = 0; b < solve->mesh->n_bodies; b++) {
    if (solve->physics->materials[b].law->finite) return PETSC_FALSE;
  }
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    if (contact->interfaces[i].options.friction != STICKSLIP_FRICTION_NONE) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* of all interfaces and ranks */
static PetscErrorCode count_nodes(const Contact *contact, PetscInt *n)
{
  PetscFunctionBegin;
  *n = 0;
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    *n += contact->interfaces[i].n1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, n, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Attempt k at the step from `past`, from x, which becomes the last iterate. */
static PetscErrorCode attempt(Solve *solve, int k, const Past *past, Vec x, PetscBool *converged)
{
  Contact            *contact = solve->contact;
  Newton             *newton  = &solve->newton;
  SNESConvergedReason reason = SNES_CONVERGED_ITS;
  SNESLineSearch      line_search;
  PetscReal           atol, rtol, stol;
  PetscInt            max_it, max_f, n_nodes;
  PetscBool           thrown = PETSC_FALSE, opens;

  PetscFunctionBegin;
  PetscCall(SNESGetLineSearch(solve->snes, &line_search));
  if (!newton->fixed_line_search)
    PetscCall(SNESLineSearchSetType(line_search, k == SOFTER && first_iterate_extrapolates(solve, past) ? SNESLINESEARCHNONE :
                                                                                                          ATTEMPTS[k].line_search));
  PetscCall(SNESGetTolerances(solve->snes, &atol, &rtol, &stol, &max_it, &max_f));
  opens            = (PetscBool)(k == FULL && only_opens(solve));
  newton->gives_up = (PetscBool)((k == FULL && !opens) || (k == CLOSING && newton->laid)); /* then nothing has to be closed */
  newton->soft     = k == SOFTER ? SOFT : 1;
  if (opens) PetscCall(count_nodes(contact, &n_nodes));
  if (!newton->fixed_max_it && (k == CLOSING || opens))
    PetscCall(SNESSetTolerances(solve->snes, atol, rtol, stol,
                                opens ? PetscMax(max_it, ITERATIONS_A_NODE * n_nodes) : CLOSING_ITERATIONS, max_f));
  closing_begin(solve, (PetscBool)(k == CLOSING));
  newton->drowned   = -1;
  newton->n_unsound = 0;
  newton->unsound[0] = 0;
  newton->slid      = 0;
  solve->linear.refusal[0] = 0;
  contact->refusal[0] = solve->physics->inverted[0] = newton->why[0] = 0;
  newton->stopped = newton->stale = newton->changed = newton->refused_commit = PETSC_FALSE;
  newton->monotone                                  = PETSC_TRUE;
  newton->n_changes                                 = 0;
  cJSON_Delete(newton->state_changes);
  newton->state_changes = cJSON_CreateArray();
  newton->factor                                    = ATTEMPTS[k].factor;
  if (!newton->goes_on) PetscCall(condensed_begin(contact));
  if (k == SETTLING) {
    PetscCall(normals_use(contact, STICKSLIP_NORMALS_COMMITTED));
    PetscCall(solve_from(solve, x, &reason));
    PetscCall(normals_use(contact, STICKSLIP_NORMALS_CURRENT));
  }
  if (k == STICKING) {
    PetscCall(sticking_use(contact, PETSC_TRUE));
    PetscCall(solve_from(solve, x, &reason));
    PetscCall(sticking_use(contact, PETSC_FALSE));
  }
  if (reason > 0) PetscCall(solve_from(solve, x, &reason));
  PetscCall(SNESSetTolerances(solve->snes, atol, rtol, stol, max_it, max_f));
  if (newton->changed) PetscCall(contact_reset_augmentation(contact));
  if (reason > 0) PetscCall(thrown_check(solve, past->last, past->t_last, x, &thrown, newton->why, sizeof(newton->why)));
  *converged = (PetscBool)(reason > 0 && !thrown);
  if (!*converged) {
    if (!thrown) PetscCall(explain(solve, reason));
    if (reason == SNES_DIVERGED_LINEAR_SOLVE) PetscCall(solver_forget_factors(solve));
    PetscCall(solver_restore_pattern(solve));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The attempt that comes as number i, where `first` comes first. */
static int order(int first, int i)
{
  return i > first ? i : i ? i - 1 : first;
}

/* x without multipliers; `any`: it had some */
static PetscErrorCode make_bare(const Solve *solve, Vec x, PetscBool *any)
{
  PetscReal before, after;
  PetscFunctionBegin;
  PetscCall(VecNorm(x, NORM_1, &before));
  PetscCall(VecPointwiseMult(x, x, solve->closing.displacements));
  PetscCall(VecNorm(x, NORM_1, &after));
  *any = (PetscBool)(after != before);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode evaluate_there(Solve *solve, Vec x)
{
  Vec r;
  PetscFunctionBegin;
  PetscCall(SNESGetFunction(solve->snes, &r, NULL, NULL));
  PetscCall(SNESComputeFunction(solve->snes, x, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode newton_solve(Solve *solve, Past *past, Vec x, PetscBool *converged)
{
  Newton         *newton       = &solve->newton;
  PetscBool       extrapolates, closing_first, loose, at_start = PETSC_TRUE;
  int             lost = -1; /* the first attempt that let a body go */

  PetscFunctionBegin;
  newton->iterations = 0;
  newton->cycle[0]   = 0;
  newton->threw      = PETSC_FALSE;
  PetscCall(progress_begin(solve));
  *converged         = PETSC_FALSE;
  closing_begin(solve, PETSC_FALSE);
  if (newton->goes_on) {
    PetscCall(attempt(solve, FULL, past, x, converged));
    if (*converged) PetscCall(evaluate_there(solve, x));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  extrapolates = first_iterate_extrapolates(solve, past);
  PetscCall(first_iterate(solve, past, extrapolates, x));
  PetscCall(closing_needed(solve, x, &closing_first));
  closing_first = (PetscBool)((closing_first && !newton->begins_soft) || newton->laid); /* softer than it is, contact may well hold the body */
  for (int i = 0; i < N_ATTEMPTS && !*converged; i++) {
    const int k = order(closing_first ? CLOSING : newton->begins_soft ? SOFTER : FULL, i);
    if (k == SOFTER && !newton->begins_soft && (extrapolates || !(newton->threw || solve->contact->refusal[0]))) continue;
    if (k == BARE && (solve->contact->n_commits || !solve->closing.possible)) continue;
    if (k == SETTLING && !normals_follow(solve->contact)) continue;
    if (k == PLAIN && !extrapolates) continue;
    if (k == BACKTRACKING && newton->fixed_line_search) continue;
    if (k == LARGER && !newton->cycle[0]) continue;
    if (k == CLOSING && !solve->closing.possible) continue;
    if (k == STICKING && !(solve->closing.possible && sticking_possible(solve->contact))) continue;
    if (solve->closing.away[0] && !solve->closing.met) break; /* whatever the attempt, nothing stops that body */
    if (!at_start) PetscCall(first_iterate(solve, past, (PetscBool)(extrapolates && k != PLAIN), x));
    at_start = PETSC_FALSE;
    if (k == BARE) {
      PetscBool any;
      PetscCall(make_bare(solve, x, &any));
      if (!any) continue;
    }
    PetscCall(attempt(solve, k, past, x, converged));
    if (*converged) newton->begins_soft = (PetscBool)(k == SOFTER);
    if (!*converged || closing_first || k == CLOSING) continue;
    PetscCall(closing_needed(solve, x, &loose));
    if (!loose) continue;
    if (lost < 0) lost = k;
    *converged = PETSC_FALSE;
    PetscCall(solver_restore_pattern(solve));
  }
  if (!*converged && lost >= 0) {
    PetscBool any;
    PetscCall(first_iterate(solve, past, (PetscBool)(extrapolates && lost != PLAIN), x));
    if (lost == BARE) PetscCall(make_bare(solve, x, &any));
    PetscCall(attempt(solve, lost, past, x, converged));
  }
  if (*converged) PetscCall(evaluate_there(solve, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
