/* The YAML file of a scene: one walk with libyaml that collects every key with its line and refuses what PETSc's reader
 * would choke on or silently misread; then PETSc reads it. */
#include "scene/scene_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

static const char *const solver_maps[] = {"snes", "ksp", "pc", "mat"};

PetscBool scene_is_solver_key(const char *dotted)
{
  for (size_t k = 0; k < sizeof(solver_maps) / sizeof(solver_maps[0]); k++) {
    size_t length = strlen(solver_maps[k]);
    if (!strncmp(dotted, solver_maps[k], length) && dotted[length] == '.') return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

void scene_fail_at(Scene *scene, size_t line, const char *dotted, const char *text)
{
  char sentence[PETSC_MAX_PATH_LEN + 2048], place[PETSC_MAX_PATH_LEN + 32] = "command line";
  if (line) snprintf(place, sizeof(place), "%s:%d", scene->file, (int)line);
  snprintf(sentence, sizeof(sentence), "%s: %s%s%s", place, dotted, dotted[0] ? ": " : "", text);
  scene_end_run(scene, sentence);
}

/* In this map keys are pairs of names, as `steel.rubber`; PETSc keeps their dots. */
static const char PAIRS[] = "friction";

static void add_key(Scene *scene, const char *dotted, size_t line)
{
  const PetscBool pair = (PetscBool)(!strncmp(dotted, PAIRS, sizeof(PAIRS) - 1) && dotted[sizeof(PAIRS) - 1] == '.');
  SceneKey       *key;
  for (PetscInt k = 0; k < scene->n_keys; k++) {
    if (!strcmp(scene->keys[k].dotted, dotted)) scene_fail_at(scene, line, dotted, "this key is given twice.");
  }
  scene->keys = realloc(scene->keys, (size_t)(scene->n_keys + 1) * sizeof(SceneKey));
  key         = &scene->keys[scene->n_keys++];
  key->dotted = strdup(dotted);
  key->flat   = strdup(dotted);
  key->line   = (PetscInt)line;
  for (char *c = key->flat; *c; c++) {
    if (*c != '.') continue;
    *c = '_';
    if (pair) break;
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

    if (key->type != YAML_SCALAR_NODE) scene_fail_at(scene, line, prefix, "a key must be a single word.");
    word = (const char *)key->data.scalar.value;
    snprintf(dotted, sizeof(dotted), "%s%s%.100s", prefix, prefix[0] ? "." : "", word);
    if (!word[0] || strspn(word, "abcdefghijklmnopqrstuvwxyz0123456789_" /* and: */ ".") != strlen(word) ||
        (strchr(word, '.') && strcmp(prefix, PAIRS)))
      scene_fail_at(scene, line, dotted, "a key may hold only the characters a-z, 0-9 and _.");
    if (!prefix[0] && strchr(word, '_'))
      scene_fail_at(
          scene, line, dotted,
          "a key at the top level may not hold an underscore (write maps: 'block: {young: 1}', not 'block_young: 1').");
    if (value->type == YAML_MAPPING_NODE) {
      PetscBool to_solver = solver;
      if (prefix[0] && !solver) scene_fail_at(scene, line, dotted, "maps go one level deep only; a value is expected here.");
      for (size_t k = 0; k < sizeof(solver_maps) / sizeof(solver_maps[0]) && !prefix[0]; k++)
        to_solver = (PetscBool)(to_solver || !strcmp(word, solver_maps[k]));
      if (value->data.mapping.pairs.start == value->data.mapping.pairs.top)
        scene_fail_at(scene, line, dotted, "this map is empty.");
      walk(scene, document, value, dotted, to_solver);
      continue;
    }
    if (value->type == YAML_SEQUENCE_NODE) {
      if (value->data.sequence.items.start == value->data.sequence.items.top)
        scene_fail_at(scene, line, dotted, "this list is empty; leave the key out instead.");
      for (yaml_node_item_t *item = value->data.sequence.items.start; item < value->data.sequence.items.top; item++) {
        yaml_node_t *entry = yaml_document_get_node(document, *item);
        if (entry->type != YAML_SCALAR_NODE || !entry->data.scalar.length)
          scene_fail_at(scene, line, dotted, "a list may hold only numbers or words (no lists, no maps, nothing empty).");
        if (strchr((const char *)entry->data.scalar.value, ','))
          scene_fail_at(scene, line, dotted, "an entry of a list may not hold a comma.");
      }
    } else if (!value->data.scalar.length || !strcmp((const char *)value->data.scalar.value, "~") ||
               !strcmp((const char *)value->data.scalar.value, "null")) {
      scene_fail_at(scene, line, dotted, "this key has no value.");
    }
    add_key(scene, dotted, line);
  }
}

/* PETSc's table holds some hundreds of keys, and says no more than that there is no room. */
static PetscErrorCode insert(Scene *scene, const char *file)
{
  PetscErrorCode full;
  PetscFunctionBegin;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  full = PetscOptionsInsertFileYAML(PETSC_COMM_WORLD, NULL, file, PETSC_TRUE);
  PetscCall(PetscPopErrorHandler());
  if (full == PETSC_ERR_MEM)
    scene_fail(scene, NULL, NULL,
               "its %d keys are more than PETSc's table of options has room for. Bodies of one material can be one mesh: in a Gmsh file they "
               "need not hang together.",
               (int)scene->n_keys);
  PetscCall(full);
  PetscFunctionReturn(PETSC_SUCCESS);
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
    scene_fail_at(scene, parser.problem_mark.line + 1, "this is no valid YAML",
            parser.problem ? parser.problem : "unknown reason");
  root = yaml_document_get_root_node(&document);
  if (!root || root->type != YAML_MAPPING_NODE) scene_fail_at(scene, 1, "", "a scene is a YAML map of keys and values.");
  walk(scene, &document, root, "", PETSC_FALSE);
  yaml_document_delete(&document);
  yaml_parser_delete(&parser);
  fclose(stream);

  PetscCall(insert(scene, file));
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
  free((*scene)->lists);
  free(*scene);
  *scene = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
