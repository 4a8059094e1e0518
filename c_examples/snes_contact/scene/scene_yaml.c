/* The YAML file of a scene: one walk with libyaml that collects every key with its line and refuses what PETSc's reader
 * would choke on or silently misread; then PETSc reads it. Also the check for keys that nobody asked for. */
#include "scene/scene_private.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

static const char *const solver_maps[] = {"snes", "ksp", "pc", "mat"};

static PetscBool is_solver_key(const char *dotted)
{
  for (size_t k = 0; k < sizeof(solver_maps) / sizeof(solver_maps[0]); k++) {
    size_t length = strlen(solver_maps[k]);
    if (!strncmp(dotted, solver_maps[k], length) && dotted[length] == '.') return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* line 0: the key came from the command line */
static void fail_at(Scene *scene, size_t line, const char *dotted, const char *text)
{
  char sentence[PETSC_MAX_PATH_LEN + 2048], place[PETSC_MAX_PATH_LEN + 32] = "command line";
  if (line) snprintf(place, sizeof(place), "%s:%d", scene->file, (int)line);
  snprintf(sentence, sizeof(sentence), "%s: %s%s%s", place, dotted, dotted[0] ? ": " : "", text);
  scene_end_run(scene, sentence);
}

static void add_key(Scene *scene, const char *dotted, size_t line)
{
  SceneKey *key;
  for (PetscInt k = 0; k < scene->n_keys; k++) {
    if (!strcmp(scene->keys[k].dotted, dotted)) fail_at(scene, line, dotted, "this key is given twice.");
  }
  scene->keys = realloc(scene->keys, (size_t)(scene->n_keys + 1) * sizeof(SceneKey));
  key         = &scene->keys[scene->n_keys++];
  key->dotted = strdup(dotted);
  key->flat   = strdup(dotted);
  key->line   = (PetscInt)line;
  for (char *c = key->flat; *c; c++) {
    if (*c == '.') *c = '_';
  }
}

static void walk(Scene *scene, yaml_document_t *document, yaml_node_t *map, const char *prefix, PetscBool solver)
{
  for (yaml_node_pair_t *pair = map->data.mapping.pairs.start; pair < map->data.mapping.pairs.top; pair++) {
    yaml_node_t *key   = yaml_document_get_node(document, pair->key),
                *value = yaml_document_get_node(document, pair->value);
    size_t      line   = key->start_mark.line + 1;
    char        dotted[256];
    const char *word;

    if (key->type != YAML_SCALAR_NODE) fail_at(scene, line, prefix, "a key must be a single word.");
    word = (const char *)key->data.scalar.value;
    snprintf(dotted, sizeof(dotted), "%s%s%.100s", prefix, prefix[0] ? "." : "", word);
    if (!word[0] || strspn(word, "abcdefghijklmnopqrstuvwxyz0123456789_") != strlen(word))
      fail_at(scene, line, dotted, "a key may hold only the characters a-z, 0-9 and _.");
    if (!prefix[0] && strchr(word, '_'))
      fail_at(
          scene, line, dotted,
          "a key at the top level may not hold an underscore (write maps: 'block: {young: 1}', not 'block_young: 1').");
    if (value->type == YAML_MAPPING_NODE) {
      PetscBool to_solver = solver;
      if (prefix[0] && !solver) fail_at(scene, line, dotted, "maps go one level deep only; a value is expected here.");
      for (size_t k = 0; k < sizeof(solver_maps) / sizeof(solver_maps[0]) && !prefix[0]; k++)
        to_solver = (PetscBool)(to_solver || !strcmp(word, solver_maps[k]));
      if (value->data.mapping.pairs.start == value->data.mapping.pairs.top)
        fail_at(scene, line, dotted, "this map is empty.");
      walk(scene, document, value, dotted, to_solver);
      continue;
    }
    if (value->type == YAML_SEQUENCE_NODE) {
      if (value->data.sequence.items.start == value->data.sequence.items.top)
        fail_at(scene, line, dotted, "this list is empty; leave the key out instead.");
      for (yaml_node_item_t *item = value->data.sequence.items.start; item < value->data.sequence.items.top; item++) {
        yaml_node_t *entry = yaml_document_get_node(document, *item);
        if (entry->type != YAML_SCALAR_NODE || !entry->data.scalar.length)
          fail_at(scene, line, dotted, "a list may hold only numbers or words (no lists, no maps, nothing empty).");
        if (strchr((const char *)entry->data.scalar.value, ','))
          fail_at(scene, line, dotted, "an entry of a list may not hold a comma.");
      }
    } else if (!value->data.scalar.length || !strcmp((const char *)value->data.scalar.value, "~") ||
               !strcmp((const char *)value->data.scalar.value, "null")) {
      fail_at(scene, line, dotted, "this key has no value.");
    }
    add_key(scene, dotted, line);
  }
}

PetscErrorCode scene_open(const char *file, int argc, char **argv, Scene **out)
{
  Scene          *scene;
  FILE           *stream;
  yaml_parser_t   parser;
  yaml_document_t document;
  yaml_node_t    *root;

  PetscFunctionBegin;
  scene = calloc(1, sizeof(*scene));
  snprintf(scene->file, sizeof(scene->file), "%s", file);
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &scene->rank));
  stream = fopen(file, "rb");
  if (!stream) scene_fail(scene, NULL, NULL, "cannot open this scene file.");
  PetscCheck(yaml_parser_initialize(&parser), PETSC_COMM_SELF, PETSC_ERR_MEM, "libyaml");
  yaml_parser_set_input_file(&parser, stream);
  if (!yaml_parser_load(&parser, &document))
    fail_at(scene, parser.problem_mark.line + 1, "this is no valid YAML",
            parser.problem ? parser.problem : "unknown reason");
  root = yaml_document_get_root_node(&document);
  if (!root || root->type != YAML_MAPPING_NODE) fail_at(scene, 1, "", "a scene is a YAML map of keys and values.");
  walk(scene, &document, root, "", PETSC_FALSE);
  yaml_document_delete(&document);
  yaml_parser_delete(&parser);
  fclose(stream);

  PetscCall(PetscOptionsInsertFileYAML(PETSC_COMM_WORLD, NULL, file, PETSC_TRUE));
  PetscCall(PetscOptionsInsert(NULL, &argc, &argv, NULL)); /* again, so that the command line wins */
  *out = scene;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode scene_close(Scene **scene)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < (*scene)->n_keys; k++) {
    free((*scene)->keys[k].dotted);
    free((*scene)->keys[k].flat);
  }
  for (PetscInt k = 0; k < (*scene)->n_asked; k++)
    free((*scene)->asked[k]);
  for (PetscInt k = 0; k < (*scene)->n_names; k++)
    free((*scene)->names[k]);
  free((*scene)->keys);
  free((*scene)->asked);
  free((*scene)->names);
  free(*scene);
  *scene = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

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

/* The maps that every scene may have, the first N_OWN of them not PETSc's */
static const char *const MAPS[] = {"frame", "steps", "output", "snes", "ksp", "pc", "mat"};
enum { N_OWN = 3, N_MAPS = sizeof(MAPS) / sizeof(MAPS[0]) };

/* The lists of names, which are no maps */
static const char *const LISTS[] = {"bodies", "surfaces", "supports", "loads", "interfaces", "probes"};
enum { N_LISTS = sizeof(LISTS) / sizeof(LISTS[0]) };

static void fail_unread(Scene *scene, const SceneKey *key)
{
  char        allowed[1024] = "", text[1400], map[256] = "";
  const char *word = strchr(key->dotted, '.'), *closest = NULL;
  size_t      best     = 3, length; /* three wrong letters are no typo */
  PetscBool   declared = PETSC_FALSE;

  if (is_solver_key(key->dotted))
    fail_at(scene, (size_t)key->line, key->dotted,
            "PETSc read no such option (see the list of -snes, -ksp, -pc and -mat options in PETSc's manual).");
  word   = word ? word + 1 : key->dotted;
  length = (size_t)(word - key->dotted); /* of "block_" in the flat names */
  snprintf(map, sizeof(map), "%.*s", length ? (int)length - 1 : 0, key->dotted);
  for (PetscInt k = 0; k < scene->n_asked; k++) {
    const char *name = scene->asked[k] + length;
    if (strncmp(scene->asked[k], key->flat, length) || (!length && strchr(name, '_'))) continue;
    declared = PETSC_TRUE;
    if (distance(word, name) < best) {
      best    = distance(word, name);
      closest = name;
    }
    snprintf(allowed + strlen(allowed), sizeof(allowed) - strlen(allowed), "%s%s", allowed[0] ? ", " : "", name);
  }
  for (int k = 0; k < N_LISTS && length; k++) {
    if (!strcmp(map, LISTS[k]))
      fail_at(scene, (size_t)key->line, map, "a list of names is expected here, and a map for each at the top level.");
  }
  if (!declared) {
    for (PetscInt k = 0; k < N_MAPS + scene->n_names; k++) {
      const char *name = k < N_MAPS ? MAPS[k] : scene->names[k - N_MAPS];
      if (distance(map, name) < best) {
        best    = distance(map, name);
        closest = name;
      }
    }
    if (closest)
      snprintf(text, sizeof(text), "nothing is called '%s'; did you mean '%s'?", map, closest);
    else
      snprintf(text, sizeof(text),
               "nothing is called '%s': list the name in bodies, surfaces, supports, loads, interfaces or probes.",
               map);
  } else if (closest) {
    snprintf(text, sizeof(text), "unknown key; did you mean '%.*s%s'? Allowed here: %s.", (int)length, key->dotted,
             closest, allowed);
  } else {
    snprintf(text, sizeof(text), "unknown key. Allowed here: %s.", allowed);
  }
  fail_at(scene, (size_t)key->line, key->dotted, text);
}

/* An option like -base_frictoin speaks to a map of the scene; PETSc would only list it as unused. */
static void check_command_line(Scene *scene)
{
  char   **options, **values;
  PetscInt n;

  PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsLeftGet(NULL, &n, &options, &values));
  for (PetscInt k = 0; k < n; k++) {
    for (PetscInt j = 0; j < N_OWN + scene->n_names; j++) {
      const char *map    = j < N_OWN ? MAPS[j] : scene->names[j - N_OWN];
      size_t      length = strlen(map);
      char        dotted[256];
      if (strncmp(options[k], map, length) || options[k][length] != '_') continue;
      snprintf(dotted, sizeof(dotted), "%s.%.120s", map, options[k] + length + 1);
      fail_unread(scene, &(SceneKey){.dotted = dotted, .flat = options[k], .line = 0});
    }
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
    fail_at(scene, 0, name, text);
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
    if (is_solver_key(scene->keys[k].dotted) != solver) continue;
    PetscCallAbort(PETSC_COMM_WORLD, PetscOptionsUsed(NULL, scene->keys[k].flat, &used));
    if (!used) fail_unread(scene, &scene->keys[k]);
  }
  if (solver)
    check_arguments(scene);
  else
    check_command_line(scene);
}
