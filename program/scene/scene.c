/* Reading the options of a scene: typed readers, and the sentence that ends a run on a wrong scene. The YAML file itself
 * is walked in scene_yaml.c. */
#include "scene/scene_private.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An error of PETSc itself while reading options cannot be explained to the user: end the run with its traceback. */
#define Must(...) PetscCallAbort(PETSC_COMM_WORLD, __VA_ARGS__)

static void flat_name(const char *map, const char *key, char name[], size_t length)
{
  if (map)
    snprintf(name, length, "-%s_%s", map, key);
  else
    snprintf(name, length, "-%s", key);
}

void scene_end_run(Scene *scene, const char *sentence)
{
  PetscMPIInt failed = 1;
  if (scene->rank == 0) {
    fflush(stdout);
    fprintf(stderr, "stickslip: %s\n", sentence);
  }
  if (scene->root_only)
    (void)MPI_Bcast(&failed, 1, MPI_INT, 0, PETSC_COMM_WORLD); /* tell the ranks that wait in scene_root_end() */
  (void)PetscFinalize();
  exit(1);
}

/* Does this key stand in the map itself? Its word then, else NULL. */
static const char *word_in(const SceneKey *key, const char *map)
{
  const size_t length = strlen(map);
  return !strncmp(key->dotted, map, length) && key->dotted[length] == '.' ? key->dotted + length + 1 : NULL;
}

/* Of a key that does not stand in its map: the line of the map (0: there is none), and the first word there that is no key,
 * which may have been meant for it. */
static PetscInt look_around(const Scene *scene, const char *map, char told[], size_t length)
{
  const char *item = scene_item(scene, map);
  PetscInt    line = 0;
  for (PetscInt k = 0; k < scene->n_keys; k++) {
    const char *word = word_in(&scene->keys[k], map);
    if (!word) continue;
    if (!line) line = scene->keys[k].line;
    if (!item || strchr(word, '.') || keys_find(item, word, NULL)) continue;
    snprintf(told, length, " '%s' (line %d) is no key.", word, (int)scene->keys[k].line);
    break;
  }
  return line;
}

void scene_fail(Scene *scene, const char *map, const char *key, const char *format, ...)
{
  char     sentence[PETSC_MAX_PATH_LEN + 2048], text[1024], dotted[2 * NAME_LENGTH + 2] = "", around[2 * NAME_LENGTH + 64] = "";
  PetscInt line = 0;
  va_list  arguments;
  if (key)
    snprintf(dotted, sizeof(dotted), "%s%s%s", map ? map : "", map ? "." : "", key);
  else if (map)
    snprintf(dotted, sizeof(dotted), "%s", map);
  for (PetscInt k = 0; k < scene->n_keys && !line; k++) {
    if (!strcmp(scene->keys[k].dotted, dotted)) line = scene->keys[k].line;
  }
  if (!line && map && key) line = look_around(scene, map, around, sizeof(around));
  va_start(arguments, format);
  vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  if (line)
    snprintf(sentence, sizeof(sentence), "%s:%d: %s: %s%s", scene->file, (int)line, dotted, text, around);
  else
    snprintf(sentence, sizeof(sentence), "%s: %s%s%s", scene->file, dotted, dotted[0] ? ": " : "", text);
  scene_end_run(scene, sentence);
}

void scene_root_begin(Scene *scene)
{
  scene->root_only = PETSC_TRUE;
}

PetscErrorCode scene_root_end(Scene *scene)
{
  PetscMPIInt failed = 0;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  if (failed) {
    PetscCall(PetscFinalize());
    exit(1);
  }
  scene->root_only = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *scene_item(const Scene *scene, const char *map)
{
  if (!map) return "scene";
  for (PetscInt k = 0; k < scene->n_names; k++) {
    if (!strcmp(scene->names[k], map)) return scene->lists[k];
  }
  if (!strcmp(map, "all")) return "interfaces"; /* of general contact */
  return keys_has_item(map) ? map : NULL;
}

/* The row of a key; NULL: the item is not known yet. A key without a row is a fault of the program. */
static const Key *find_row(Scene *scene, const char *map, const char *key)
{
  const char *item = scene_item(scene, map);
  const Key  *row  = item ? keys_find(item, key, NULL) : NULL;
  if (item && !row && strchr(key, '.')) row = keys_find(item, "default", NULL); /* a pair of names */
  if (item && !row)
    scene_fail(scene, map, key, "a fault of the program: it asks for this key, which is not in its table of keys, among those of `%s`.", item);
  return row;
}

/* The row of a key that is read as one of these kinds. */
static const Key *row_of(Scene *scene, const char *map, const char *key, KeyKind from, KeyKind to)
{
  const Key *row = find_row(scene, map, key);
  if (row && (row->kind < from || row->kind > to))
    scene_fail(scene, map, key, "a fault of the program: it reads this key as something else than its table of keys says.");
  return row;
}

/* The default, where the table has it as a number. */
static PetscBool default_of(const Key *row, double *value)
{
  return (PetscBool)(row && keys_default(row, value));
}

PetscBool scene_has(Scene *scene, const char *map, const char *key)
{
  char      name[2 * NAME_LENGTH + 3];
  PetscBool set, seen = PETSC_FALSE;
  (void)find_row(scene, map, key);
  flat_name(map, key, name, sizeof(name));
  for (PetscInt k = 0; k < scene->n_asked && !seen; k++)
    seen = (PetscBool)!strcmp(scene->asked[k], name + 1);
  if (!seen) {
    scene->asked                   = realloc(scene->asked, (size_t)(scene->n_asked + 1) * sizeof(*scene->asked));
    scene->asked[scene->n_asked++] = strdup(name + 1);
  }
  Must(PetscOptionsHasName(NULL, NULL, name, &set)); /* marks it as used, too */
  return set;
}

static void need(Scene *scene, const char *map, const char *key)
{
  if (!scene_has(scene, map, key)) scene_fail(scene, map, key, "this key is missing.");
}

/* PETSc's own conversions, with its traceback replaced by our sentence. */
#define READ(call, ...)                                                                                                \
  do {                                                                                                                 \
    PetscErrorCode failed;                                                                                             \
    Must(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));                                                        \
    failed = (call);                                                                                                   \
    Must(PetscPopErrorHandler());                                                                                      \
    if (failed) scene_fail(scene, map, key, __VA_ARGS__);                                                              \
  } while (0)

static const char *raw(const char *map, const char *key)
{
  static char value[512];
  char        name[2 * NAME_LENGTH + 3];
  PetscBool   set;
  flat_name(map, key, name, sizeof(name));
  value[0] = 0;
  Must(PetscOptionsGetString(NULL, NULL, name, value, sizeof(value), &set));
  return value;
}

static size_t count_items(const char *text)
{
  size_t n = text[0] ? 1 : 0;
  for (; *text; text++)
    n += *text == ',';
  return n;
}

/* the list's name for PETSc, its text and its length; NULL and 0 where the key is not given */
static const char *find_list(Scene *scene, const char *map, const char *key, const char *what, size_t length,
                             char name[], PetscInt *n)
{
  const char *text = NULL;
  PetscBool   set;
  *n = 0;
  if (!scene_has(scene, map, key)) return NULL;
  flat_name(map, key, name, length);
  Must(PetscOptionsFindPair(NULL, NULL, name, &text, &set));
  *n = text ? (PetscInt)count_items(text) : 0;
  if (!*n) scene_fail(scene, map, key, "a list of %s is expected, but nothing was given.", what);
  return text;
}

void scene_reals(Scene *scene, const char *map, const char *key, PetscInt *n, PetscReal **values)
{
  char        name[2 * NAME_LENGTH + 3];
  const Key  *row  = row_of(scene, map, key, KEY_NUMBER, KEY_CURVE);
  const char *text = find_list(scene, map, key, "numbers", sizeof(name), name, n);
  PetscBool   set;
  *values = NULL;
  if (!text) return;
  Must(PetscMalloc1(*n, values));
  READ(PetscOptionsGetRealArray(NULL, NULL, name, *values, n, &set), "numbers are expected, not '%s'.", raw(map, key));
  if (*n != (PetscInt)count_items(text)) scene_fail(scene, map, key, "numbers are expected, not '%s'.", raw(map, key));
  for (PetscInt k = 0; k < *n; k++) {
    if (PetscIsInfOrNanReal((*values)[k]))
      scene_fail(scene, map, key, "finite numbers are expected, not '%s'.", raw(map, key));
    if (row && !keys_allows(row, (double)(*values)[k])) {
      char range[128];
      keys_say_range(&row->range, range, sizeof(range));
      scene_fail(scene, map, key, "%g is not allowed; it must be %s.", (double)(*values)[k], range);
    }
  }
}

PetscBool scene_vector(Scene *scene, const char *map, const char *key, PetscInt n, PetscReal values[])
{
  PetscReal *given;
  PetscInt   n_given;
  scene_reals(scene, map, key, &n_given, &given);
  if (!n_given) return PETSC_FALSE;
  if (n_given != n)
    scene_fail(scene, map, key, "%d number%s expected, but there %s %d.", (int)n, n == 1 ? " is" : "s are",
               n_given == 1 ? "is" : "are", (int)n_given);
  Must(PetscArraycpy(values, given, n));
  Must(PetscFree(given));
  return PETSC_TRUE;
}

PetscBool scene_counts(Scene *scene, const char *map, const char *key, PetscInt n, PetscInt values[])
{
  PetscReal *real;
  PetscBool  set;
  Must(PetscMalloc1(n, &real));
  set = scene_vector(scene, map, key, n, real);
  for (PetscInt k = 0; set && k < n; k++) {
    values[k] = (PetscInt)real[k];
    if ((PetscReal)values[k] != real[k])
      scene_fail(scene, map, key, "a whole number is expected, not '%g'.", (double)real[k]);
  }
  Must(PetscFree(real));
  return set;
}

void scene_real(Scene *scene, const char *map, const char *key, PetscReal *value)
{
  double otherwise;
  if (!scene_vector(scene, map, key, 1, value) && default_of(find_row(scene, map, key), &otherwise)) *value = (PetscReal)otherwise;
}

void scene_real_required(Scene *scene, const char *map, const char *key, PetscReal *value)
{
  need(scene, map, key);
  scene_real(scene, map, key, value);
}

void scene_int(Scene *scene, const char *map, const char *key, PetscInt *value)
{
  double otherwise;
  if (!scene_counts(scene, map, key, 1, value) && default_of(find_row(scene, map, key), &otherwise)) *value = (PetscInt)otherwise;
}

void scene_bool(Scene *scene, const char *map, const char *key, PetscBool *value)
{
  const Key *row = row_of(scene, map, key, KEY_SWITCH, KEY_SWITCH);
  char       name[2 * NAME_LENGTH + 3];
  PetscBool  set;
  double     otherwise;
  if (default_of(row, &otherwise)) *value = (PetscBool)(otherwise != 0);
  if (!scene_has(scene, map, key)) return;
  flat_name(map, key, name, sizeof(name));
  READ(PetscOptionsGetBool(NULL, NULL, name, value, &set), "true or false is expected, not '%s'.", raw(map, key));
}

void scene_string(Scene *scene, const char *map, const char *key, char value[], size_t length)
{
  char      name[2 * NAME_LENGTH + 3];
  PetscBool set;
  (void)row_of(scene, map, key, KEY_WORD, KEY_FILE);
  if (!scene_has(scene, map, key)) return;
  flat_name(map, key, name, sizeof(name));
  Must(PetscOptionsGetString(NULL, NULL, name, value, length, &set));
  if (!value[0]) scene_fail(scene, map, key, "a word is expected, but nothing was given.");
  if (strlen(value) + 1 >= length) scene_fail(scene, map, key, "this is longer than %d characters.", (int)length - 2);
}

void scene_string_required(Scene *scene, const char *map, const char *key, char value[], size_t length)
{
  need(scene, map, key);
  scene_string(scene, map, key, value, length);
}

/* Of words to choose from, which must all be in the key's row, the number of the row's default; -1: that is said in words. */
static PetscInt default_choice(Scene *scene, const char *map, const char *key, const char *const choices[])
{
  const Key *row    = row_of(scene, map, key, KEY_WORD, KEY_WORD);
  PetscInt   number = -1;
  for (PetscInt k = 0; choices[k] && row; k++) {
    if (!keys_has_word(row, choices[k])) scene_fail(scene, map, key, "a fault of the program: its table of keys lacks '%s'.", choices[k]);
    if (!strcmp(row->otherwise, choices[k])) number = k;
  }
  return number;
}

void scene_choice(Scene *scene, const char *map, const char *key, const char *const choices[], PetscInt *value)
{
  const PetscInt otherwise = default_choice(scene, map, key, choices);
  char           word[512] = "", allowed[512] = "";
  if (otherwise >= 0) *value = otherwise;
  if (!scene_has(scene, map, key)) return;
  scene_string(scene, map, key, word, sizeof(word));
  for (PetscInt k = 0; choices[k]; k++) {
    if (!strcmp(choices[k], word)) {
      *value = k;
      return;
    }
    snprintf(allowed + strlen(allowed), sizeof(allowed) - strlen(allowed), "%s%s", k ? ", " : "", choices[k]);
  }
  scene_fail(scene, map, key, "'%s' is not allowed; choose from: %s.", word, allowed);
}

void scene_strings(Scene *scene, const char *map, const char *key, PetscInt *n, char ***values)
{
  char      name[2 * NAME_LENGTH + 3];
  PetscBool set;
  *values = NULL;
  (void)row_of(scene, map, key, KEY_WORD, KEY_LIST);
  if (!find_list(scene, map, key, "names", sizeof(name), name, n)) return;
  Must(PetscCalloc1(*n, values));
  Must(PetscOptionsGetStringArray(NULL, NULL, name, *values, n, &set));
}

void strings_destroy(PetscInt n, char ***values)
{
  for (PetscInt k = 0; k < n; k++)
    Must(PetscFree((*values)[k]));
  Must(PetscFree(*values));
}

const char *scene_file(const Scene *scene)
{
  return scene->file;
}

PetscErrorCode scene_relative_path(const Scene *scene, const char *name, char path[], size_t length)
{
  const char *slash = strrchr(scene->file, '/');
  PetscFunctionBegin;
  if (name[0] == '/' || !slash)
    snprintf(path, length, "%s", name);
  else
    snprintf(path, length, "%.*s/%s", (int)(slash - scene->file), scene->file, name);
  PetscFunctionReturn(PETSC_SUCCESS);
}
