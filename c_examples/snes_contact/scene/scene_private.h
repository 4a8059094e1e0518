/* What scene.c and scene_yaml.c share. */
#ifndef SNES_CONTACT_SCENE_PRIVATE_H
#define SNES_CONTACT_SCENE_PRIVATE_H
#include "scene/scene.h"
#include "scene/petsc_compat.h"

typedef struct {
  char    *dotted; /* as the user thinks of it: block.young */
  char    *flat;   /* as PETSc stores it: block_young */
  PetscInt line;
} SceneKey;

struct Scene {
  char        file[PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;
  PetscBool   root_only;
  PetscInt    n_keys, n_asked, n_names;
  SceneKey   *keys;  /* every value in the file */
  char      **asked; /* flat names of everything the program can read */
  char      **names; /* of bodies, surfaces, supports, ... */
};

_Noreturn void scene_end_run(Scene *scene, const char *sentence);
#endif
