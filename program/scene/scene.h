/* A scene: one YAML file in PETSc's options format, read with checks.
 *
 * The file is walked once with libyaml, so that every key is known by its dotted name and line; then PETSc flattens it into
 * its options database ("block: {young: 1}" becomes -block_young 1), where the command line overrides it. Every reader
 * below takes a map (NULL: top level) and a key, finds its row in the table of keys (keys.h), checks kind and range by it, and
 * remembers what it asked for. At the end scene_check_unread() refuses every key that nobody asked for.
 *
 * A wrong scene ends the program with exit code 1 and one sentence; no reader returns a half-read value. */
#ifndef STICKSLIP_PROGRAM_SCENE_H
#define STICKSLIP_PROGRAM_SCENE_H
#include <petscsys.h>

#define NAME_LENGTH 64 /* of bodies, surfaces, loads ... and of "body.surface" */

typedef struct Scene Scene;

PetscErrorCode scene_open(const char *file, int argc, char **argv, Scene **scene);
PetscErrorCode scene_close(Scene **scene);
const char    *scene_file(const Scene *scene);
/* path of a file named in the scene, relative to the scene's own folder */
PetscErrorCode scene_relative_path(const Scene *scene, const char *name, char path[], size_t length);
/* is it the scene's own file, or one that a `file` of it names? */
PetscBool scene_is_source(const Scene *scene, const char *path);

/* one clear sentence about map.key, then exit code 1 on every rank; does not return */
_Noreturn void scene_fail(Scene *scene, const char *map, const char *key, const char *format, ...)
    PETSC_ATTRIBUTE_FORMAT(4, 5);

/* Where each rank looks for a fault in what it has: of those that have found one (number >= 0) the one with the least number
 * speaks, and ends the run on all. */
PetscErrorCode scene_fail_first(Scene *scene, PetscInt number, const char *map, const char *key, const char *text);

/* Between these two only rank 0 works; scene_fail() then ends the waiting ranks too. */
void           scene_root_begin(Scene *scene);
PetscErrorCode scene_root_end(Scene *scene);

/* Is the key there? Counts as asked for. */
PetscBool scene_has(Scene *scene, const char *map, const char *key);

/* ... or a key of this map? */
PetscBool scene_has_map(const char *map);

/* When the key is missing, readers of one value give the default of its row; where that is said in words, they leave what is there.
 * The *_required ones fail instead. */
void scene_real(Scene *scene, const char *map, const char *key, PetscReal *value);
void scene_real_required(Scene *scene, const char *map, const char *key, PetscReal *value);
void scene_int(Scene *scene, const char *map, const char *key, PetscInt *value);
void scene_bool(Scene *scene, const char *map, const char *key, PetscBool *value);
void scene_choice(Scene *scene, const char *map, const char *key, const char *const choices[], PetscInt *value);
void scene_string(Scene *scene, const char *map, const char *key, char value[], size_t length);
void scene_string_required(Scene *scene, const char *map, const char *key, char value[], size_t length);
/* exactly n numbers; false when the key is missing */
PetscBool scene_vector(Scene *scene, const char *map, const char *key, PetscInt n, PetscReal values[]);
PetscBool scene_counts(Scene *scene, const char *map, const char *key, PetscInt n, PetscInt values[]);
/* any number of numbers or words, freed with PetscFree / strings_destroy; n = 0 when missing */
void scene_reals(Scene *scene, const char *map, const char *key, PetscInt *n, PetscReal **values);
void scene_strings(Scene *scene, const char *map, const char *key, PetscInt *n, char ***values);
void strings_destroy(PetscInt n, char ***values);
/* a list that declares names, each with a map of its own: [a-z0-9]+, unique in the whole scene, not reserved */
void scene_names(Scene *scene, const char *list, PetscInt *n, char ***names);
/* refuses values and lists where the table of keys has a map */
void scene_check_maps(Scene *scene);

/* what the scene says, the command line included: a line for each key that was asked for and is given, but for those that may change
 * between a run and its continuation; freed with PetscFree */
PetscErrorCode scene_effective(const Scene *scene, char **text);
/* the first key in which two such texts differ, in words; empty: in none */
void scene_difference(const char *before, const char *now, char words[], size_t length);

/* keys nobody asked for; `solver`: those handed to PETSc's solvers (snes, ksp, pc, mat), which are read late */
void scene_check_unread(Scene *scene, PetscBool solver);
/* those of one map, of which every key has been asked for that it may have */
void scene_check_unread_of(Scene *scene, const char *map);
#endif
