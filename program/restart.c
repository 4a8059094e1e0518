/* Restart files: all that the next step depends on, to the last bit. `contents` is the list of it; what a room keeps is in its restart.c.
 * Multigrid is left out, which serves for several matrices: where it solves, bits differ, and answers to its tolerance only. So they do on
 * several ranks, where no two runs have the same bits. */
#include "model.h"
#include "solve/sensitivity.h"
#include <stdio.h>

static PetscErrorCode contents(Model *model, Run *state, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(physics_agree(&model->physics, archive));
  PetscCall(archive_ints(archive, "cutbacks", 1, &state->n_cutbacks));
  PetscCall(physics_archive(&model->physics, archive));
  PetscCall(contact_archive(&model->contact, archive));
  PetscCall(solve_archive(&model->solve, &state->past, &state->size, archive));
  PetscCall(heat_archive(&model->heat, archive));
  PetscCall(sensitivity_archive(&model->solve, archive));
  PetscCall(energy_archive(&model->output, archive));
  PetscCall(summary_archive(state->summary, archive));
  PetscCall(solve_archive_pattern(&model->solve, archive)); /* the last one: runs on several ranks do not look at it */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of the file of a step */
static void name_file(const Model *model, PetscInt step, char path[], size_t length)
{
  snprintf(path, length, "%s/restart_%d.bin", model->output.directory, (int)step);
}

/* What the scene says, before the first step. */
static PetscErrorCode keep_scene(Model *model)
{
  PetscFunctionBegin;
  if (model->mesh.rank == 0 && !model->effective) PetscCall(scene_effective(model->scene, &model->effective));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A file that cannot be written does not end the run: it is told, and the one before is kept. */
PetscErrorCode restart_write(Model *model, Run *state, PetscBool last)
{
  const Output *output  = &model->output;
  Archive       archive = {.rank = model->mesh.rank, .n_ranks = model->mesh.size};
  char          path[2 * PETSC_MAX_PATH_LEN];
  PetscInt      before;

  PetscFunctionBegin;
  if (!output->restart_every || (state->step % output->restart_every && !last)) PetscFunctionReturn(PETSC_SUCCESS);
  name_file(model, state->step, path, sizeof(path));
  PetscCall(contents(model, state, &archive));
  if (!archive.bad) PetscCall(archive_write(&archive, path, state->step, state->past.t_last, model->effective));
  if (archive.bad) {
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR, "stickslip: warning: '%s' is not written: %s\n", path, archive.fault));
  } else {
    for (before = state->step - 1; before > 0 && before % output->restart_every; before--)
      continue;
    before -= (output->restart_keep - 1) * output->restart_every;
    name_file(model, before, path, sizeof(path));
    if (output->restart_keep && before > 0 && model->mesh.rank == 0) (void)remove(path);
  }
  PetscCall(archive_destroy(&archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends the run if a fault has been found. */
static void judge(Model *model, const Archive *archive)
{
  if (archive->bad)
    scene_fail(model->scene, NULL, "restart", "'%s' cannot be used: %s.", model->restart, archive->fault);
}

PetscErrorCode restart_read(Model *model, Run *state)
{
  const Steps  *steps = &model->solve.steps;
  const char   *name  = model->restart;
  char          path[PETSC_MAX_PATH_LEN], difference[160] = "", fault[200], *text;
  Archive       archive;
  ArchiveHeader header;

  PetscFunctionBegin;
  if (name[0] || model->output.restart_every) PetscCall(keep_scene(model));
  if (!name[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(scene_relative_path(model->scene, name, path, sizeof(path)));
  PetscCall(archive_read(&archive, path, &header, &text));
  judge(model, &archive);
  if (model->mesh.rank == 0) scene_difference(text, model->effective, difference, sizeof(difference));
  PetscCall(PetscFree(text));
  PetscCall(PetscSNPrintf(fault, sizeof(fault), "it is of another scene: %s", difference));
  PetscCall(archive_fault(&archive, difference[0] ? fault : NULL));
  judge(model, &archive);
  if (header.t >= steps->end)
    scene_fail(model->scene, NULL, "restart", "'%s' is of t = %g, and the steps end at %g.", name, header.t, (double)steps->end);
  state->step = (PetscInt)header.step;
  PetscCall(contents(model, state, &archive));
  judge(model, &archive);
  PetscCall(archive_destroy(&archive));
  PetscCall(supports_values(&model->physics, model->physics.t));
  if (!model->output.quiet)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "goes on from step %" PetscInt_FMT ", t = %g\n", state->step, header.t));
  PetscFunctionReturn(PETSC_SUCCESS);
}
