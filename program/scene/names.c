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

/* Lists and maps of the scene itself have a name already, and what begins so on the command line is PETSc's. */
static PetscBool is_reserved(const char *name)
{
  static const char *const others[] = {"schema", "scene", "vec", "dm", "options", "log", "help", "malloc", "mpi", "petscpartitioner"};
  const Key               *row      = keys_find("scene", name, NULL);
  for (size_t r = 0; r < sizeof(others) / sizeof(others[0]); r++) {
    if (!strcmp(others[r], name)) return PETSC_TRUE;
  }
  return (PetscBool)(row && (row->kind == KEY_LIST || row->kind == KEY_MAP));
}

void scene_check_maps(Scene *scene)
{
  const KeyTable *table;
  for (size_t t = 0; (table = keys_table(t)); t++) {
    for (size_t k = 0; k < table->n && !strcmp(table->item, "scene"); k++) {
      if (table->keys[k].kind == KEY_MAP && scene_has(scene, NULL, table->keys[k].key))
        scene_fail(scene, NULL, table->keys[k].key, "a map is expected here, not a single value or a list.");
    }
  }
}

void scene_names(Scene *scene, const char *list, PetscInt *n, char ***names)
{
  const char *map = NULL, *key = list; /* for the messages of scene_fail() */
  scene_strings(scene, NULL, list, n, names);
  for (PetscInt k = 0; k < *n; k++) {
    const char *name  = (*names)[k];
    size_t      valid = strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789");
    if (!name[0] || name[valid] || strlen(name) > 30)
      scene_fail(scene, map, key, "'%s' is no valid name: use up to 30 of the characters a-z and 0-9.", name);
    if (is_reserved(name)) scene_fail(scene, map, key, "the name '%s' is reserved; choose another.", name);
    for (PetscInt j = 0; j < scene->n_names; j++) {
      if (!strcmp(scene->names[j], name))
        scene_fail(scene, map, key, "the name '%s' is given twice; names must be unique in the whole scene.", name);
    }
    if (!scene_has_map(name))
      scene_fail(scene, map, key, "'%s' is listed and has no map: write `%s: {KEY: VALUE, ...}` at the top level.", name,
                 name);
    scene->names                   = realloc(scene->names, (size_t)(scene->n_names + 1) * sizeof(*scene->names));
    scene->lists                   = realloc(scene->lists, (size_t)(scene->n_names + 1) * sizeof(*scene->lists));
    scene->lists[scene->n_names]   = keys_find("scene", list, NULL)->key;
    scene->names[scene->n_names++] = strdup(name);
  }
}
