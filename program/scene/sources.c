/* Which files a scene is read from: nothing may be written in their place. */
#include "scene/scene_private.h"
#include <string.h>
#include <sys/stat.h>

/* Do both paths lead to one file? */
static PetscBool same_file(const char *one, const char *two)
{
  struct stat a, b;
  return (PetscBool)(!stat(one, &a) && !stat(two, &b) && a.st_dev == b.st_dev && a.st_ino == b.st_ino);
}

/* Is it what the key `file` of some map says, in the scene or on the command line? */
static PetscBool says(const Scene *scene, const char *flat, const char *path)
{
  static const char key[] = "_file";
  const size_t      n = strlen(flat), m = strlen(key);
  char              option[2 * NAME_LENGTH + 3], name[PETSC_MAX_PATH_LEN], from[PETSC_MAX_PATH_LEN];
  PetscBool         set = PETSC_FALSE;
  if (n <= m || strcmp(flat + n - m, key) || n + 2 > sizeof(option)) return PETSC_FALSE;
  PetscCallAbort(PETSC_COMM_SELF, PetscSNPrintf(option, sizeof(option), "-%s", flat));
  PetscCallAbort(PETSC_COMM_SELF, PetscOptionsGetString(NULL, NULL, option, name, sizeof(name), &set));
  if (!set) return PETSC_FALSE;
  PetscCallAbort(PETSC_COMM_SELF, scene_relative_path(scene, name, from, sizeof(from)));
  return same_file(from, path);
}

PetscBool scene_is_source(const Scene *scene, const char *path)
{
  PetscBool is = same_file(scene->file, path);
  for (PetscInt k = 0; k < scene->n_keys; k++)
    is = (PetscBool)(is || says(scene, scene->keys[k].flat, path));
  for (PetscInt k = 0; k < scene->n_asked; k++)
    is = (PetscBool)(is || says(scene, scene->asked[k], path));
  return is;
}
