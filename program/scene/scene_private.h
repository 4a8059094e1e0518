/* What the files of this room share. */
#ifndef STICKSLIP_PROGRAM_SCENE_PRIVATE_H
#define STICKSLIP_PROGRAM_SCENE_PRIVATE_H
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
/* a sentence about a key, then exit code 1; line 0: the key came from the command line */
_Noreturn void scene_fail_at(Scene *scene, size_t line, const char *dotted, const char *text);
PetscBool      scene_is_solver_key(const char *dotted); /* is it for PETSc's solvers? */
#endif
