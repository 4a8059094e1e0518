/* Keys of the scene and options of the command line that nobody asked for, with what was meant perhaps. */
#include "scene/scene_private.h"
#include <stdio.h>
#include <string.h>

/* Levenshtein distance of two short words */
static size_t distance(const char *a, const char *b)
{
  size_t row[128], n = strlen(b);
  if (n > 126) return 1000;
  for (size_t j = 0; j <= n; j++)
    row[j] = j;
  for (size_t i = 1; a[i - 1]; i++) {
    size_t diagonal = row[0];
    row[0]          = i;
    for (size_t j = 1; j <= n; j++) {
      size_t above = row[j], best = diagonal + (a[i - 1] != b[j - 1]);
      if (above + 1 < best) best = above + 1;
      if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
      diagonal = above;
      row[j]   = best;
    }
  }
  return row[n];
}

/* Is it a map, or a list, of the scene itself? */
static PetscBool is_of_scene(const char *name, KeyKind kind)
{
  const Key *row = keys_find("scene", name, NULL);
  return (PetscBool)(row && row->kind == kind);
}

static PetscBool is_declared(const Scene *scene, const char *name)
{
  for (PetscInt k = 0; k < scene->n_names; k++) {
    if (!strcmp(scene->names[k], name)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static void take_closer(const char *word, const char *name, size_t *best, const char **closest)
{
  const size_t d = distance(word, name);
  if (d >= *best) return;
  *best    = d;
  *closest = name;
}

/* A map that nothing declares. */
static void say_undeclared(const Scene *scene, const char *map, char text[], size_t length)
{
  const char     *closest = NULL;
  size_t          best    = 3, used = 0; /* three wrong letters are no typo */
  char            lists[256] = "";
  const KeyTable *table;
  for (PetscInt k = 0; k < scene->n_names; k++)
    take_closer(map, scene->names[k], &best, &closest);
  for (size_t t = 0; (table = keys_table(t)); t++) {
    for (size_t k = 0; k < table->n && !strcmp(table->item, "scene"); k++) {
      const Key *row = &table->keys[k];
      if (row->kind == KEY_MAP) take_closer(map, row->key, &best, &closest);
      if (row->kind == KEY_LIST) used += (size_t)snprintf(lists + used, sizeof(lists) - used, "%s%s", used ? ", " : "", row->key);
    }
  }
  if (closest)
    snprintf(text, length, "nothing is called '%s'; did you mean '%s'?", map, closest);
  else
    snprintf(text, length, "nothing is called '%s': list the name in one of %s.", map, lists);
}

/* A key that the table has, but that is not read here, where other keys say otherwise; false: the table has none. */
static PetscBool say_elsewhere(const char *item, const char *word, char text[], size_t length)
{
  const KeyTable *table;
  const Key      *row = item ? keys_find(item, word, &table) : NULL;
  if (row) snprintf(text, length, "it is a key of \"%s\" (%s), and what else is said here does not ask for it.", table->title, table->page);
  return (PetscBool)(row != NULL);
}

static void fail_unread(Scene *scene, const SceneKey *key)
{
  char            allowed[1024] = "", text[1800], where[256], map[256] = "";
  const char     *word = strchr(key->dotted, '.'), *closest = NULL, *item;
  size_t          best     = 3, length;
  PetscBool       declared = PETSC_FALSE;
  const KeyTable *table;

  if (scene_is_solver_key(key->dotted))
    scene_fail_at(scene, (size_t)key->line, key->dotted,
            "PETSc read no such option (see the list of -snes, -ksp, -pc and -mat options in PETSc's manual).");
  word   = word ? word + 1 : key->dotted;
  length = (size_t)(word - key->dotted); /* of "block_" in the flat names */
  snprintf(map, sizeof(map), "%.*s", length ? (int)length - 1 : 0, key->dotted);
  for (PetscInt k = 0; k < scene->n_asked; k++) {
    const char *name = scene->asked[k] + length;
    if (strncmp(scene->asked[k], key->flat, length) || (!length && strchr(name, '_'))) continue;
    declared = PETSC_TRUE;
    take_closer(word, name, &best, &closest);
    snprintf(allowed + strlen(allowed), sizeof(allowed) - strlen(allowed), "%s%s", allowed[0] ? ", " : "", name);
  }
  if (length && is_of_scene(map, KEY_LIST))
    scene_fail_at(scene, (size_t)key->line, map, "a list of names is expected here, and a map for each at the top level.");
  item = scene_item(scene, length ? map : NULL);
  for (size_t t = 0; item && (table = keys_table(t)); t++) {
    for (size_t k = 0; k < table->n && !strcmp(table->item, item); k++)
      take_closer(word, table->keys[k].key, &best, &closest);
  }
  if (!declared)
    say_undeclared(scene, map, text, sizeof(text));
  else if (say_elsewhere(item, word, where, sizeof(where)))
    snprintf(text, sizeof(text), "nothing reads this key: %s Allowed here: %s.", where, allowed);
  else if (closest)
    snprintf(text, sizeof(text), "unknown key; did you mean '%.*s%s'? Allowed here: %s.", (int)length, key->dotted, closest, allowed);
  else
    snprintf(text, sizeof(text), "unknown key. Allowed here: %s.", allowed);
  scene_fail_at(scene, (size_t)key->line, key->dotted, text);
}

/* An option like -base_frictoin speaks to a map of the scene; PETSc would only list it as unused. */
static void check_command_line(Scene *scene)
{
  char   **options, **values;
  PetscInt n;

  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsLeftGet(NULL, &n, &options, &values));
  for (PetscInt k = 0; k < n; k++) {
    const size_t length = strcspn(options[k], "_");
    char         map[128], dotted[256];
    if (!options[k][length] || length >= sizeof(map)) continue;
    snprintf(map, sizeof(map), "%.*s", (int)length, options[k]);
    snprintf(dotted, sizeof(dotted), "%s.%.120s", map, options[k] + length + 1);
    if (scene_is_solver_key(dotted) || !(is_of_scene(map, KEY_MAP) || is_declared(scene, map))) continue;
    fail_unread(scene, &(SceneKey){.dotted = dotted, .flat = options[k], .line = 0});
  }
  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsLeftRestore(NULL, &n, &options, &values));
}

/* What PETSc asks for when it ends, or in runs that end otherwise. */
static PetscBool is_asked_late(const char *option)
{
  static const char *const late[] = {"options_left", "options_view",    "objects_dump",      "malloc_dump",
                                     "malloc_view",  "memory_view",     "malloc_view_threshold", "citations",
                                     "mpidump",      "show_citations",  "nox",               "on_error_abort"};
  for (size_t k = 0; k < sizeof(late) / sizeof(late[0]); k++) {
    if (!strcmp(option, late[k])) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Was it given on the command line? Other options come from files and variables that serve many programs. */
static PetscBool is_argument(const char *option)
{
  int    argc;
  char **argv;
  PetscCallAbort(PETSC_COMM_WORLD, PetscGetArgs(&argc, &argv));
  for (int k = 1; k < argc; k++) {
    const char *name = argv[k] + (argv[k][0] == '-') + (argv[k][0] == '-' && argv[k][1] == '-');
    if (argv[k][0] == '-' && !strcmp(name, option)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Options that neither the driver nor, by now, PETSc has asked for. */
static void check_arguments(Scene *scene)
{
  char   **options, **values;
  PetscInt n;

  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsLeftGet(NULL, &n, &options, &values));
  for (PetscInt k = 0; k < n; k++) {
    char name[256], text[512];
    if (is_asked_late(options[k]) || !is_argument(options[k])) continue;
    snprintf(name, sizeof(name), "-%.200s", options[k]);
    snprintf(text, sizeof(text),
             "nothing reads this option: it is `-MAP_KEY` of no map of the scene, and none that PETSc asked for.");
    scene_fail_at(scene, 0, name, text);
  }
  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsLeftRestore(NULL, &n, &options, &values));
}

void scene_check_unread_of(Scene *scene, const char *map)
{
  const size_t length = strlen(map);
  for (PetscInt k = 0; k < scene->n_keys; k++) {
    PetscBool used;
    if (strncmp(scene->keys[k].dotted, map, length) || scene->keys[k].dotted[length] != '.') continue;
    PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsUsed(NULL, scene->keys[k].flat, &used));
    if (!used) fail_unread(scene, &scene->keys[k]);
  }
}

void scene_check_unread(Scene *scene, PetscBool solver)
{
  for (PetscInt k = 0; k < scene->n_keys; k++) {
    PetscBool used;
    if (scene_is_solver_key(scene->keys[k].dotted) != solver) continue;
    PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsUsed(NULL, scene->keys[k].flat, &used));
    if (!used) fail_unread(scene, &scene->keys[k]);
  }
  if (solver)
    check_arguments(scene);
  else
    check_command_line(scene);
}
