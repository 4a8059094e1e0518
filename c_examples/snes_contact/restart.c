/* Restart files: all that the next step depends on, to the last bit. `contents` is the list of it; what a room keeps is in its restart.c. */
#include "model.h"
#include <stdio.h>

static PetscErrorCode contents(Model *model, Run *run, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(physics_agree(&model->physics, archive));
  PetscCall(archive_ints(archive, "cutbacks", 1, &run->n_cutbacks));
  PetscCall(physics_archive(&model->physics, archive));
  PetscCall(contact_archive(&model->contact, archive));
  PetscCall(solve_archive(&model->solve, &run->past, &run->size, archive));
  PetscCall(summary_archive(run->summary, model->mesh.rank, archive));
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

/* A fault that any rank has found, the first of them, on all. */
static PetscErrorCode agree(char fault[], size_t length)
{
  PetscMPIInt size, rank, first;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  first = fault[0] ? rank : size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  if (first < size) PetscCallMPI(MPI_Bcast(fault, (PetscMPIInt)length, MPI_CHAR, first, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A file that cannot be written does not end the run: it is told, and the one before is kept. */
PetscErrorCode restart_write(Model *model, Run *run, PetscBool last)
{
  const Output *output = &model->output;
  Archive       archive = {0};
  char          path[2 * PETSC_MAX_PATH_LEN], fault[256];
  PetscInt      before;

  PetscFunctionBegin;
  if (!output->restart_every || (run->step % output->restart_every && !last)) PetscFunctionReturn(PETSC_SUCCESS);
  name_file(model, run->step, path, sizeof(path));
  PetscCall(iterative_renew(&model->solve)); /* as it is where the run goes on from the file */
  PetscCall(contents(model, run, &archive));
  PetscCall(PetscSNPrintf(fault, sizeof(fault), "%s", archive.fault));
  PetscCall(agree(fault, sizeof(fault)));
  if (!fault[0])
    PetscCall(archive_write(&archive, path, run->step, run->past.t_last, model->effective, fault, sizeof(fault)));
  PetscCall(archive_destroy(&archive));
  if (model->mesh.rank) PetscFunctionReturn(PETSC_SUCCESS);
  if (fault[0]) {
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "snes_contact: warning: '%s' is not written: %s\n", path, fault));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (before = run->step - 1; before > 0 && before % output->restart_every; before--)
    continue;
  before -= (output->restart_keep - 1) * output->restart_every;
  if (!output->restart_keep || before <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  name_file(model, before, path, sizeof(path));
  (void)remove(path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode restart_read(Model *model, Run *run)
{
  const char   *name = model->restart;
  char          path[PETSC_MAX_PATH_LEN], fault[1024] = "", *text;
  Archive       archive;
  ArchiveHeader header;

  PetscFunctionBegin;
  if (name[0] || model->output.restart_every) PetscCall(keep_scene(model));
  if (!name[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(scene_relative_path(model->scene, name, path, sizeof(path)));
  PetscCall(archive_read(path, &archive, &header, &text, fault, sizeof(fault)));
  if (!fault[0] && model->mesh.rank == 0) scene_difference(text, model->effective, fault, sizeof(fault));
  PetscCall(agree(fault, sizeof(fault)));
  if (fault[0]) scene_fail(model->scene, NULL, "restart", "'%s' cannot be used: %s.", name, fault);
  PetscCall(PetscFree(text));
  if (header.t >= model->solve.steps.end)
    scene_fail(model->scene, NULL, "restart", "'%s' is of t = %g, and the steps end at %g.", name, header.t, (double)model->solve.steps.end);
  run->step = (PetscInt)header.step;
  PetscCall(contents(model, run, &archive));
  PetscCall(PetscSNPrintf(fault, sizeof(fault), "%s", archive.fault));
  PetscCall(agree(fault, sizeof(fault)));
  if (fault[0]) scene_fail(model->scene, NULL, "restart", "'%s' cannot be used: %s.", name, fault);
  PetscCall(archive_destroy(&archive));
  PetscCall(supports_values(&model->physics, model->physics.t));
  if (!model->output.quiet)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "goes on from step %" PetscInt_FMT ", t %g\n", run->step, header.t));
  PetscFunctionReturn(PETSC_SUCCESS);
}
