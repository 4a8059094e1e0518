/* Pseudo-time: Newton's method, cut-back, commit, report. */
#include "model.h"

typedef struct {
  Vec       x; /* the iterate */
  Past      past;
  PetscBool tried;     /* a step has been solved, or tried */
  PetscBool converged; /* the last attempt had, so that its commit was refused if the library refused */
} History;

static PetscErrorCode history_create(Model *model, History *history)
{
  PetscFunctionBegin;
  *history = (History){0};
  PetscCall(DMCreateGlobalVector(model->mesh.dm, &history->x));
  PetscCall(VecDuplicate(history->x, &history->past.last));
  PetscCall(VecDuplicate(history->x, &history->past.before));
  PetscCall(VecZeroEntries(history->past.last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode history_destroy(History *history)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&history->x));
  PetscCall(VecDestroy(&history->past.last));
  PetscCall(VecDestroy(&history->past.before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mechanics, and in turns with them the temperatures, until what bodies expand by has settled. */
static PetscErrorCode solve_in_turns(Model *model, History *history, PetscBool *done)
{
  Heat           *heat = &model->heat;
  const PetscReal dt   = model->physics.t - history->past.t_last;
  PetscReal       change;
  PetscInt        refused;
  PetscFunctionBegin;
  for (;;) {
    PetscCall(loads_values(&model->physics));
    PetscCall(newton_solve(&model->solve, &history->past, history->x, done));
    model->solve.iterations += model->solve.newton.iterations;
    if (!*done || !heat->on) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(heat_solve(heat, dt, &change, &refused));
    if (refused) break;
    if (!heat->two_way || change <= heat->tolerance) PetscFunctionReturn(PETSC_SUCCESS);
    if (heat->turns < heat->most) continue;
    PetscCall(PetscSNPrintf(model->contact.refusal, sizeof(model->contact.refusal),
                            "temperatures and displacements do not settle: after %d turns the temperatures change by %.2g of their range",
                            (int)heat->turns, (double)change));
    break;
  }
  PetscCall(PetscSNPrintf(model->solve.newton.why, sizeof(model->solve.newton.why), "heat: %s", model->contact.refusal));
  *done = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solve at t and commit; `last`: t is the end of the run. */
static PetscErrorCode step_to(Model *model, Summary *summary, History *history, PetscInt step, PetscReal t,
                              PetscBool asked, PetscBool last, PetscBool *done)
{
  Newton  *newton = &model->solve.newton;
  PetscInt refused;
  PetscFunctionBegin;
  model->physics.t = t;
  PetscCall(supports_values(&model->physics, t));
  PetscCall(heat_begin(&model->heat, t));
  PetscCall(offsets_values(&model->contact, t, &refused));
  if (refused) {
    *done = PETSC_FALSE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(solve_in_turns(model, history, done));
  history->tried     = PETSC_TRUE;
  history->converged = *done;
  if (*done) {
    PetscCall(summary_step(&model->output, summary, step, PETSC_TRUE, asked, last));
    PetscCall(contact_commit(&model->contact, &refused));
    *done = (PetscBool)!refused;
    PetscCall(summary_settle_step(&model->output, summary, *done));
    if (refused) {
      newton->refused_commit = PETSC_TRUE;
      PetscCall(PetscSNPrintf(newton->why, sizeof(newton->why), "converged, but refused at its commit: %s",
                              model->contact.refusal));
    }
  }
  if (!*done) PetscCall(summary_failed_attempt(&model->output, summary, history->past.t_last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode accept(Model *model, History *history)
{
  PetscFunctionBegin;
  /* How a gap closes is no rate, either. */
  history->past.have_before = (PetscBool)(!times_bend(&model->physics, model->physics.t) && !model->solve.closing.ever_cut);
  PetscCall(VecCopy(history->past.last, history->past.before));
  PetscCall(VecCopy(history->x, history->past.last));
  PetscCall(rigids_accept(&model->physics, model->physics.t, history->past.last, history->past.before));
  history->past.t_before        = history->past.t_last;
  history->past.t_last          = model->physics.t;
  model->solve.iterations        = 0;
  parts_accept(&model->physics);
  PetscCall(heat_accept(&model->heat));
  equilibrium_accept(&model->contact);
  condensed_accept(&model->contact);
  PetscCall(contact_share_out(&model->contact));
  PetscCall(solver_refresh_pattern(&model->solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The run has ended before its end. */
static PetscErrorCode give_up(Model *model, const History *history, int *exit_code)
{
  const char *refusal = model->contact.refusal;
  char        held[1024];
  PetscFunctionBegin;
  PetscCall(held_describe(&model->solve, held, sizeof(held)));
  *exit_code = refusal[0] ? 3 : 2;
  if (refusal[0] && !history->tried)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "snes_contact: refused by the library: %s. That is so at t = 0, before the first step.\n",
                           refusal));
  else if (refusal[0] && history->converged)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "snes_contact: refused by the library: %s. That is the commit of the step from t = %.6g to "
                           "%.6g, which had converged.\n",
                           refusal, (double)history->past.t_last, (double)model->physics.t));
  else if (refusal[0])
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "snes_contact: refused by the library: %s. Newton's iterates may have run away to there: %s\n",
                           refusal, held));
  else
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "snes_contact: not converged beyond t = %.6g, not even by a step of %.2g: %s. %s See "
                           "scenes/README.md.\n",
                           (double)history->past.t_last, (double)(model->physics.t - history->past.t_last),
                           model->solve.newton.why, held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode run(Model *model, int *exit_code)
{
  Steps    *steps = &model->solve.steps;
  StepSize  size;
  History   history;
  Summary  *summary;
  PetscInt  status, cutbacks = 0, step = 0;
  PetscBool failed, checked = PETSC_FALSE, done;

  PetscFunctionBegin;
  *exit_code = 0;
  PetscCall(times_add_kinks(&model->physics, &model->solve.steps));
  PetscCall(summary_create(&model->output, &summary));
  for (PetscInt i = 0; i < model->contact.n_interfaces; i++)
    PetscCall(csv_adjusted(&model->output, &model->contact.interfaces[i]));
  PetscCall(history_create(model, &history));
  PetscCall(supports_values(&model->physics, 0));
  PetscCall(contact_start(&model->contact, history.past.last, &status));
  failed = (PetscBool)(status != 0);
  step_size_start(steps, &size);
  while (!failed && history.past.t_last < steps->end) {
    const PetscReal t = step_size_next(steps, &size, history.past.t_last), target = steps->targets[size.next];
    PetscCall(step_to(model, summary, &history, step + 1, t, (PetscBool)(t == target && steps->asked[size.next]),
                      (PetscBool)(t == steps->end), &done));
    if (done) {
      if (model->solve.iterations && !checked) { /* the solvers have read their options by now */
        scene_root_begin(model->scene); /* rank 0 alone has read keys of meshes */
        if (model->mesh.rank == 0) scene_check_unread(model->scene, PETSC_TRUE);
        PetscCall(scene_root_end(model->scene));
        checked = PETSC_TRUE;
      }
      step_size_accept(steps, &size, history.past.t_last, t, &model->solve.newton, times_bend(&model->physics, t));
      PetscCall(accept(model, &history));
      step++;
    } else {
      cutbacks++;
      failed = (PetscBool)!step_size_cut(steps, &size, t - history.past.t_last);
    }
  }
  if (failed) {
    PetscCall(summary_step(&model->output, summary, step + 1, PETSC_FALSE, PETSC_FALSE, PETSC_TRUE));
    PetscCall(give_up(model, &history, exit_code));
  }
  PetscCall(summary_write(&model->output, &summary, history.past.last, cutbacks,
                          *exit_code == 2 ? model->solve.newton.why : model->contact.refusal));
  PetscCall(history_destroy(&history));
  PetscFunctionReturn(PETSC_SUCCESS);
}
