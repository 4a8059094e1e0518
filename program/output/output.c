/* What the scene says of the results: which files, where, and the probes. */
#include "output/output.h"
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

/* with its parents; true if it can be written to */
static PetscBool make_folder(const char *path)
{
  struct stat status;
  char        part[PETSC_MAX_PATH_LEN];
  for (size_t k = 1; path[k - 1] && k < sizeof(part); k++) {
    if (path[k] && path[k] != '/') continue;
    snprintf(part, sizeof(part), "%.*s", (int)k, path);
    (void)mkdir(part, 0777); /* those that are there already stay */
  }
  return (PetscBool)(!stat(path, &status) && S_ISDIR(status.st_mode) && access(path, W_OK) == 0);
}

/* `restart_every`, `restart_keep` */
static void read_restart(Scene *scene, Output *output)
{
  scene_int(scene, "output", "restart_every", &output->restart_every);
  scene_int(scene, "output", "restart_keep", &output->restart_keep);
  if (!output->restart_every && scene_has(scene, "output", "restart_keep"))
    scene_fail(scene, "output", "restart_keep", "there are no restart files: give `restart_every`.");
}

/* A file of the folder: there is none yet, or one that can be written over. */
static PetscBool can_write(const char *folder, const char *name)
{
  struct stat status;
  char        path[PETSC_MAX_PATH_LEN];
  snprintf(path, sizeof(path), "%s/%s", folder, name);
  return (PetscBool)(stat(path, &status) || (S_ISREG(status.st_mode) && access(path, W_OK) == 0));
}

PetscErrorCode output_read(Scene *scene, Output *output)
{
  const Mesh              *mesh   = output->mesh;
  static const char *const when[] = {"none", "last", "times", "all", NULL};
  PetscInt                 vtu    = WRITE_ALL, csv = WRITE_ALL;
  char                   **names;

  PetscFunctionBegin;
  output->scene = scene_file(scene);
  scene_choice(scene, "output", "vtu", when, &vtu);
  scene_choice(scene, "output", "csv", when, &csv);
  scene_bool(scene, "output", "quiet", &output->quiet);
  read_restart(scene, output);
  output->write_vtu = (WriteWhen)vtu;
  output->write_csv = (WriteWhen)csv;
  scene_names(scene, "probes", &output->n_probes, &names);
  PetscCall(PetscCalloc1(output->n_probes, &output->probes));
  for (PetscInt k = 0; k < output->n_probes; k++) {
    PetscCall(PetscSNPrintf(output->probes[k].name, NAME_LENGTH, "%s", names[k]));
    PetscCall(mesh_nearest_vertex(scene, mesh, names[k], &output->probes[k].vertex));
  }
  scene_root_begin(scene);
  if (mesh->rank == 0 && !make_folder(output->directory))
    scene_fail(scene, NULL, NULL, "cannot write to the output folder '%s'.", output->directory);
  if (mesh->rank == 0 && !can_write(output->directory, "summary.json"))
    scene_fail(scene, NULL, NULL, "cannot write '%s/summary.json': there is something else of that name, or it is not yours.", output->directory);
  PetscCall(scene_root_end(scene));
  strings_destroy(output->n_probes, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode output_destroy(Output *output)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(output->probes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
