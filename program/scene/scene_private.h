/* What the files of this room share. */
#ifndef STICKSLIP_PROGRAM_SCENE_PRIVATE_H
#define STICKSLIP_PROGRAM_SCENE_PRIVATE_H
#include "scene/keys.h"
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
  const char **lists; /* which of these each name is of */
};

_Noreturn void scene_end_run(Scene *scene, const char *sentence);
/* a sentence about a key, then exit code 1; line 0: the key came from the command line */
_Noreturn void scene_fail_at(Scene *scene, size_t line, const char *dotted, const char *text);
/* whose keys a map has, in the words of the table of keys (keys.h); NULL: it is not declared yet */
const char    *scene_item(const Scene *scene, const char *map);
PetscBool      scene_is_solver_key(const char *dotted); /* is it for PETSc's solvers? */
#endif
