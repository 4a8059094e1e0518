/* The space of a scene, and vectors of it. */
#include "scene/space.h"

void space_read(Scene *scene, Space *space)
{
  static const char *const kinds[] = {"solid", "plane_strain", "plane_stress", "axisymmetric", NULL}; /* by SPACE_... */
  PetscInt                 kind    = SPACE_SOLID;
  scene_choice(scene, NULL, "model", kinds, &kind);
  space->kind = (SpaceKind)kind;
  scene_real(scene, NULL, "thickness", &space->thickness);
  if (!scene_has(scene, NULL, "thickness")) return;
  if (kind != SPACE_PLANE_STRAIN && kind != SPACE_PLANE_STRESS)
    scene_fail(scene, NULL, "thickness", "only of `model: plane_strain` and `plane_stress`.");
}

/* `rows` vectors one after the other, each with two numbers in the plane, into three each */
static PetscBool read_rows(Scene *scene, const Space *space, const char *map, const char *key, PetscInt rows,
                           PetscReal values[])
{
  const PetscInt  d = space_dimension(space);
  PetscReal       given[9];
  const PetscBool set = scene_vector(scene, map, key, d * rows, given);
  for (PetscInt k = 0; k < 3 * rows && set; k++)
    values[k] = k % 3 < d ? given[d * (k / 3) + k % 3] : 0;
  return set;
}

PetscBool space_vector(Scene *scene, const Space *space, const char *map, const char *key, PetscReal x[3])
{
  return read_rows(scene, space, map, key, 1, x);
}

PetscBool space_box(Scene *scene, const Space *space, const char *map, const char *key, PetscReal box[6])
{
  return read_rows(scene, space, map, key, 2, box);
}

PetscBool space_matrix(Scene *scene, const Space *space, const char *map, const char *key, PetscReal matrix[9])
{
  return read_rows(scene, space, map, key, space_dimension(space), matrix);
}

PetscBool space_turn(Scene *scene, const Space *space, const char *map, const char *key, PetscReal turn[3])
{
  if (space->kind == SPACE_AXISYMMETRIC && scene_has(scene, map, key))
    scene_fail(scene, map, key, "an axisymmetric model cannot turn.");
  if (space->kind == SPACE_SOLID) return scene_vector(scene, map, key, 3, turn);
  return scene_vector(scene, map, key, 1, turn + 2);
}
