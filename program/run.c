/* Pseudo-time: Newton's method, cut-back, commit, report. */
#include "model.h"
#include "physics/dynamics.h"
#include "physics/fluid.h"
#include "solve/redundant.h"
#include "solve/sensitivity.h"

/* Normals of a step are found anew so often at most: each time they change by some per cent of the last change. */
enum { CORRECTIONS = 8 };

static PetscErrorCode run_create(Model *model, Run *run)
{
  PetscFunctionBegin;
  *run = (Run){0};
  PetscCall(DMCreateGlobalVector(model->mesh.dm, &run->x));
  PetscCall(VecDuplicate(run->x, &run->past.last));
  PetscCall(VecDuplicate(run->x, &run->past.before));
  PetscCall(VecZeroEntries(run->past.last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode run_destroy(Run *run)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&run->x));
  PetscCall(VecDestroy(&run->past.last));
  PetscCall(VecDestroy(&run->past.before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mechanics, and in turns with them the temperatures, until what bodies expand by has settled. */
static PetscErrorCode solve_in_turns(Model *model, Run *run, PetscBool *done)
{
  Heat           *heat = &model->heat;
  const PetscReal dt   = model->physics.t - run->past.t_last;
  PetscReal       change;
  PetscInt        refused;
  PetscFunctionBegin;
  for (;;) {
    if (!model->physics.dynamics) PetscCall(loads_values(&model->physics));
    else if (heat->two_way) PetscCall(dynamics_loads(&model->physics));
    PetscCall(newton_solve(&model->solve, &run->past, run->x, done));
    model->solve.iterations += model->solve.newton.iterations;
    if (!*done || !heat->on) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(heat_solve(heat, dt, &change, &refused));
    if (refused) break;
    if (!heat->two_way || change <= heat->tolerance) PetscFunctionReturn(PETSC_SUCCESS);
    if (heat->turns < heat->most) continue;
    PetscCall(PetscSNPrintf(heat->refusal, sizeof(heat->refusal),
                            "temperatures and displacements do not settle: after %d turns the temperatures change by %.2g of their range",
                            (int)heat->turns, (double)change));
    break;
  }
  PetscCall(PetscSNPrintf(model->solve.newton.why, sizeof(model->solve.newton.why), "heat: %s", heat->refusal));
  *done = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Until every multiplier is determined, or none of those that are not can be left out. */
static PetscErrorCode solve_determined(Model *model, Run *run, PetscBool *done)
{
  Solve   *solve = &model->solve;
  PetscInt n_found;
  PetscFunctionBegin;
  PetscCall(redundant_begin(solve, run->past.last));
  do {
    n_found = 0;
    PetscCall(solve_in_turns(model, run, done));
    if (*done) PetscCall(undetermined_find(solve, solve->newton.why, sizeof(solve->newton.why)));
    if (!*done || !solve->newton.why[0]) continue;
    PetscCall(redundant_find(solve, run->x, &n_found));
    *done = PETSC_FALSE;
  } while (n_found);
  if (*done) PetscCall(torn_find(solve, solve->newton.why, sizeof(solve->newton.why)));
  if (solve->newton.why[0]) *done = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has the front of a fluid moved, now that the step has converged? */
static PetscErrorCode let_fluids_on(Model *model, PetscBool first, PetscBool *moved)
{
  Physics *physics = &model->physics;
  Vec      forces;
  PetscFunctionBegin;
  *moved = PETSC_FALSE;
  if (!fluids_any(physics)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(physics->u_local, &forces));
  PetscCall(contact_on_vertices(&model->contact, forces));
  PetscCall(fluid_advance(physics, forces, first, moved));
  PetscCall(VecDestroy(&forces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step has converged: again from there. */
static PetscErrorCode solve_again(Model *model, Run *run, PetscBool *done)
{
  Newton *newton = &model->solve.newton;
  PetscFunctionBegin;
  newton->goes_on = PETSC_TRUE;
  PetscCall(solve_determined(model, run, done));
  newton->goes_on = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step has converged: again with the normals that it has reached, and where fluids have come to, until both stay. */
static PetscErrorCode solve_on(Model *model, Run *run, PetscBool *done)
{
  Newton        *newton     = &model->solve.newton;
  const PetscInt iterations = newton->iterations;
  PetscBool      lags = PETSC_FALSE, first = PETSC_TRUE, moved = *done;
  PetscFunctionBegin;
  while (*done && moved) {
    PetscCall(lag_shows(&model->contact, &lags));
    for (int k = 0; lags && *done; k++) {
      PetscCall(lag_take_normals(&model->contact, (PetscBool)(k < CORRECTIONS), &lags));
      if (lags) PetscCall(solve_again(model, run, done));
    }
    if (*done) PetscCall(let_fluids_on(model, first, &moved));
    first = PETSC_FALSE;
    if (*done && moved) PetscCall(solve_again(model, run, done));
  }
  if (*done) newton->iterations = iterations; /* what the length of the next step goes by */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the converged step count? newton->why: why not. */
static PetscErrorCode check(Model *model, Run *run, PetscBool last)
{
  Contact       *contact = &model->contact;
  Newton        *newton  = &model->solve.newton;
  PetscLogDouble start, end;
  PetscFunctionBegin;
  PetscCall(PetscTime(&start));
  PetscCall(slide_check(contact, &newton->slid, newton->why, sizeof(newton->why)));
  if (!newton->why[0]) PetscCall(unseen_check(contact, last, &run->late, &newton->slid, newton->why, sizeof(newton->why)));
  if (!newton->why[0]) PetscCall(newly_check(contact, newton->why, sizeof(newton->why)));
  newton->refused_commit = (PetscBool)(newton->why[0] != 0);
  PetscCall(PetscTime(&end));
  contact->seconds_checks += end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the converged step follows. Where the library has no derivatives, no shorter step helps. */
static PetscErrorCode find_influences(Model *model, Run *run, PetscBool *done)
{
  PetscInt refused;
  PetscFunctionBegin;
  PetscCall(sensitivity_solve(&model->solve, run->x, &refused));
  if (!refused) PetscFunctionReturn(PETSC_SUCCESS);
  *done          = PETSC_FALSE;
  run->late      = PETSC_TRUE;
  run->no_slopes = PETSC_TRUE;
  PetscCall(PetscSNPrintf(model->solve.newton.why, sizeof(model->solve.newton.why), "`parameters`: %s", model->contact.refusal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solve at t and commit; `last`: t is the end of the run. */
static PetscErrorCode step_to(Model *model, Run *run, PetscReal t, PetscBool asked, PetscBool last, PetscBool *done)
{
  Newton   *newton = &model->solve.newton;
  PetscInt  refused;
  PetscBool changed;
  PetscFunctionBegin;
  model->physics.t = t;
  run->tried       = PETSC_TRUE;
  run->late        = PETSC_FALSE;
  run->converged   = PETSC_FALSE;
  PetscCall(timed_begin(&model->physics, t, &changed));
  if (changed) {
    PetscCall(held_create(&model->solve));
    closing_find(&model->solve);
  }
  PetscCall(supports_values(&model->physics, t));
  PetscCall(offsets_values(&model->contact, t, &refused));
  run->offsets = (PetscBool)(refused != 0);
  if (refused) {
    *done                  = PETSC_FALSE;
    newton->refused_commit = PETSC_FALSE;
    newton->iterations     = 0;
    PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "offsets: %s", model->contact.refusal));
    PetscCall(summary_failed_attempt(&model->output, run->summary, run->past.t_last));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(settle_loose(&model->solve, &run->past)); /* what is warm turns, too */
  PetscCall(heat_begin(&model->heat, t));
  PetscCall(fluid_begin(&model->physics));
  if (model->physics.dynamics) {
    PetscCall(dynamics_begin(&model->physics));
    PetscCall(contact_reset_augmentation(&model->contact));
  }
  PetscCall(solve_determined(model, run, done));
  PetscCall(solve_on(model, run, done));
  if (*done) PetscCall(timed_catch(&model->physics));
  if (*done) PetscCall(remote_check(&model->physics, newton->why, sizeof(newton->why)));
  if (*done && !newton->why[0]) PetscCall(check(model, run, last));
  if (*done && newton->why[0]) *done = PETSC_FALSE;
  run->converged = *done;
  if (*done) PetscCall(find_influences(model, run, done));
  if (*done) {
    PetscCall(summary_step(&model->output, run->summary, run->step + 1, PETSC_TRUE, asked, last));
    PetscCall(energy_check(&model->output, &run->late, newton->why, sizeof(newton->why)));
    newton->refused_commit = (PetscBool)(newton->why[0] != 0);
    if (!newton->why[0]) PetscCall(contact_commit(&model->contact, run->x, &refused));
    *done = (PetscBool)(!refused && !newton->why[0]);
    PetscCall(summary_settle_step(&model->output, run->summary, *done));
    if (refused) {
      newton->refused_commit = PETSC_TRUE;
      PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "converged, but refused at its commit: %s",
                              model->contact.refusal));
    }
  }
  PetscCall(lag_forget(&model->contact));
  if (!*done) PetscCall(summary_failed_attempt(&model->output, run->summary, run->past.t_last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode accept(Model *model, Run *run)
{
  PetscFunctionBegin;
  PetscCall(dynamics_accept(&model->physics));
  PetscCall(timed_accept(&model->physics));
  /* How a gap closes is no rate, either. */
  run->past.have_before = (PetscBool)(!times_bend(&model->physics, model->physics.t) && !model->solve.closing.ever_cut);
  PetscCall(VecCopy(run->past.last, run->past.before));
  PetscCall(VecCopy(run->x, run->past.last));
  PetscCall(rigids_accept(&model->physics, model->physics.t, run->past.last, run->past.before));
  run->past.t_before        = run->past.t_last;
  run->past.t_last          = model->physics.t;
  model->solve.iterations        = 0;
  parts_accept(&model->physics);
  PetscCall(heat_accept(&model->heat));
  PetscCall(fluid_accept(&model->physics, model->solve.quiet));
  PetscCall(sensitivity_accept(&model->solve));
  equilibrium_accept(&model->contact);
  PetscCall(slide_accept(&model->contact));
  PetscCall(unseen_accept(&model->contact));
  condensed_accept(&model->contact);
  PetscCall(contact_share_out(&model->contact));
  PetscCall(solver_refresh_pattern(&model->solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The run has ended before its end. */
static PetscErrorCode give_up(Model *model, const Run *run, int *exit_code)
{
  const char *refusal = model->contact.refusal;
  char        held[2048], springs[1024];
  PetscReal   rtol;
  PetscFunctionBegin;
  PetscCall(held_describe(&model->solve, held, sizeof(held)));
  PetscCall(SNESGetTolerances(model->solve.snes, NULL, &rtol, NULL, NULL, NULL));
  PetscCall(held_describe_springs(&model->solve, rtol, springs, sizeof(springs)));
  PetscCall(PetscStrlcat(held, springs, sizeof(held)));
  *exit_code = refusal[0] ? 3 : 2;
  if (refusal[0] && !run->tried)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: refused by the library: %s. That is so at t = 0, before the first step.\n",
                           refusal));
  else if (refusal[0] && model->heat.refusal[0])
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: refused by the library: %s. That is the heat of the step from t = %.6g to %.6g, whose "
                           "mechanics had converged.\n",
                           refusal, (double)run->past.t_last, (double)model->physics.t));
  else if (refusal[0] && run->no_slopes)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: refused by the library: %s. That is what `parameters` ask for; the step had converged.\n", refusal));
  else if (refusal[0] && run->offsets)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: refused by the library: %s. Those are the offsets of the scene at t = %.6g.\n", refusal,
                           (double)model->physics.t));
  else if (refusal[0] && run->converged)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: refused by the library: %s. That is the commit of the step from t = %.6g to "
                           "%.6g, which had converged.\n",
                           refusal, (double)run->past.t_last, (double)model->physics.t));
  else if (refusal[0])
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: refused by the library: %s. Newton's iterates may have run away to there: %s\n",
                           refusal, held));
  else
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: not converged beyond t = %.6g, not even by a step of %.2g: %s. %s See "
                           "scenes/convergence.md.\n",
                           (double)run->past.t_last, (double)(model->physics.t - run->past.t_last),
                           model->solve.newton.why, held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where no step is short enough general contact may have other sides to offer: then it has not failed yet. */
static PetscErrorCode exchange(Model *model, Run *run, PetscBool *failed)
{
  PetscBool any;
  PetscFunctionBegin;
  PetscCall(contact_exchange(&model->contact, run->past.last, &any));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  *failed               = PETSC_FALSE;
  run->past.have_before = PETSC_FALSE;
  step_size_anew(&model->solve.steps, &run->size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode run(Model *model, int *exit_code)
{
  Steps    *steps = &model->solve.steps;
  Run       run;
  PetscInt  status;
  PetscBool failed, checked = PETSC_FALSE, done, again;

  PetscFunctionBegin;
  *exit_code = 0;
  timed_fade(&model->physics, steps->n_targets, steps->targets, steps->automatic ? steps->initial : steps->end);
  PetscCall(times_add_kinks(&model->physics, &model->solve.steps));
  PetscCall(run_create(model, &run));
  PetscCall(summary_create(&model->output, &run.summary));
  for (PetscInt i = 0; i < model->contact.n_interfaces; i++)
    PetscCall(csv_adjusted(&model->output, &model->contact.interfaces[i]));
  PetscCall(supports_values(&model->physics, 0));
  PetscCall(contact_start(&model->contact, run.past.last, &status));
  failed = (PetscBool)(status != 0);
  step_size_start(steps, &run.size);
  if (!failed) PetscCall(restart_read(model, &run));
  while (!failed && run.past.t_last < steps->end) {
    const PetscReal t = step_size_next(steps, &run.size, run.past.t_last), target = steps->targets[run.size.next];
    PetscCall(step_to(model, &run, t, (PetscBool)(t == target && steps->asked[run.size.next]), (PetscBool)(t == steps->end), &done));
    if (done) {
      if (model->solve.iterations && !checked) { /* the solvers have read their options by now */
        scene_root_begin(model->scene); /* rank 0 alone has read keys of meshes */
        if (model->mesh.rank == 0) scene_check_unread(model->scene, PETSC_TRUE);
        PetscCall(scene_root_end(model->scene));
        checked = PETSC_TRUE;
      }
      run.again = PETSC_FALSE;
      step_size_accept(steps, &run.size, run.past.t_last, t, &model->solve.newton, times_bend(&model->physics, t));
      PetscCall(accept(model, &run));
      run.step++;
      PetscCall(restart_write(model, &run, (PetscBool)(t == steps->end)));
    } else {
      PetscCall(contact_looks_anew(&model->contact, &again));
      run.again = (PetscBool)(again && !run.again);
      if (run.again) continue;
      run.n_cutbacks++;
      failed = (PetscBool)(run.late || !step_size_cut(steps, &run.size, t - run.past.t_last, &model->solve.newton));
      if (failed && !run.late) PetscCall(exchange(model, &run, &failed));
    }
  }
  if (failed) {
    PetscCall(summary_step(&model->output, run.summary, run.step + 1, PETSC_FALSE, PETSC_FALSE, PETSC_TRUE));
    PetscCall(give_up(model, &run, exit_code));
  }
  if (!failed) PetscCall(unseen_end(&model->contact));
  PetscCall(summary_write(&model->output, &run.summary, run.past.last, run.n_cutbacks,
                          *exit_code == 2 ? model->solve.newton.why : model->contact.refusal));
  PetscCall(run_destroy(&run));
  PetscFunctionReturn(PETSC_SUCCESS);
}
