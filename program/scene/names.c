/* Names that a scene declares: of bodies, surfaces, supports, loads, springs, interfaces and probes. */
#include "scene/scene_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Does the scene, or the command line, have a key in this map? */
PetscBool scene_has_map(const char *name)
{
  char     *all, start[NAME_LENGTH + 4];
  PetscBool found;
  snprintf(start, sizeof(start), "-%s_", name);
  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsGetAll(NULL, &all));
  found = (PetscBool)(strstr(all, start) != NULL);
  PetscCallAbort(PETSC_COMM_WORLD, PetscFree(all));
  return found;
}

void scene_names(Scene *scene, const char *list, PetscInt *n, char ***names)
{
  static const char *const reserved[] = {"schema",
                                         "bodies",
                                         "surfaces",
                                         "supports",
                                         "loads",
                                         "springs",
                                         "interfaces",
                                         "probes",
                                         "parameters",
                                         "frame",
                                         "steps",
                                         "dynamics",
                                         "output",
                                         "snes",
                                         "ksp",
                                         "pc",
                                         "mat",
                                         "vec",
                                         "dm",
                                         "options",
                                         "scene",
                                         "log",
                                         "help",
                                         "malloc",
                                         "mpi",
                                         "petscpartitioner"};
  const char              *map = NULL, *key = list; /* for the messages of scene_fail() */
  scene_strings(scene, NULL, list, n, names);
  for (PetscInt k = 0; k < *n; k++) {
    const char *name  = (*names)[k];
    size_t      valid = strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789");
    if (!name[0] || name[valid] || strlen(name) > 30)
      scene_fail(scene, map, key, "'%s' is no valid name: use up to 30 of the characters a-z and 0-9.", name);
    for (size_t r = 0; r < sizeof(reserved) / sizeof(reserved[0]); r++) {
      if (!strcmp(reserved[r], name)) scene_fail(scene, map, key, "the name '%s' is reserved; choose another.", name);
    }
    for (PetscInt j = 0; j < scene->n_names; j++) {
      if (!strcmp(scene->names[j], name))
        scene_fail(scene, map, key, "the name '%s' is given twice; names must be unique in the whole scene.", name);
    }
    if (!scene_has_map(name))
      scene_fail(scene, map, key, "'%s' is listed and has no map: write `%s: {KEY: VALUE, ...}` at the top level.", name,
                 name);
    scene->names                   = realloc(scene->names, (size_t)(scene->n_names + 1) * sizeof(*scene->names));
    scene->names[scene->n_names++] = strdup(name);
  }
}
