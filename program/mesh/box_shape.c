/* Boxes that are bent: `ball` (a disc in the plane) and `cylinder` make them round, `polar` takes x for a radius and y for an
 * angle. */
#include "mesh/mesh.h"

void box_shape_read(Scene *scene, const Space *space, const char *body, const PetscInt n[3], PetscReal *const planes[3],
                    BoxShape *shape)
{
  static const char *const axes[]  = {"x", "y", "z", NULL};
  const PetscBool          ball    = space_vector(scene, space, body, "ball", shape->centre);
  const PetscBool          solid   = (PetscBool)(space_dimension(space) == 3);
  const PetscBool          rod     = (PetscBool)(solid && scene_vector(scene, body, "cylinder", 3, shape->centre));
  const PetscBool          axial   = scene_has(scene, body, "axis");
  PetscBool                polar   = PETSC_FALSE;
  PetscInt                 axis    = 2;

  scene_bool(scene, body, "polar", &polar);
  scene_choice(scene, body, "axis", axes, &axis);
  if (ball + rod + polar > 1)
    scene_fail(scene, body, ball ? "ball" : "cylinder", "one of ball, cylinder, polar at a time.");
  if (!solid && scene_has(scene, body, "cylinder"))
    scene_fail(scene, body, "cylinder", "only in space; in a plane model `ball` is a disc.");
  if (axial && !rod) scene_fail(scene, body, "axis", "only of `cylinder`.");
  shape->kind   = ball ? BOX_BALL : rod ? BOX_CYLINDER : polar ? BOX_POLAR : BOX_STRAIGHT;
  shape->axis   = rod ? (int)axis : solid ? -1 : 2;
  shape->closed = PETSC_FALSE;
  if (!polar) return;
  if (planes[0][0] <= 0)
    scene_fail(scene, body, "polar", "x is a radius and must be positive; it begins at %g.", (double)planes[0][0]);
  if (planes[1][n[1]] - planes[1][0] > 360)
    scene_fail(scene, body, "polar", "y is an angle in degrees; from %g to %g is more than 360.", (double)planes[1][0],
               (double)planes[1][n[1]]);
  shape->closed = (PetscBool)(planes[1][n[1]] - planes[1][0] == 360);
  for (PetscInt j = 0; j < n[1]; j++) {
    if (planes[1][j + 1] - planes[1][j] >= 180)
      scene_fail(scene, body, "polar", "a cell cannot span 180 degrees or more; take more cells along y.");
  }
}

/* The cube (square, across an axis) of half-width s about the centre becomes the sphere (circle) of radius s: along
 * rays, so planes through the centre stay. */
static void make_round(const PetscReal centre[3], int axis, PetscReal x[3])
{
  PetscReal largest = 0, squared = 0;
  for (int i = 0; i < 3; i++) {
    if (i == axis) continue;
    largest = PetscMax(largest, PetscAbsReal(x[i] - centre[i]));
    squared += PetscSqr(x[i] - centre[i]);
  }
  for (int i = 0; i < 3 && squared > 0; i++) {
    if (i != axis) x[i] = centre[i] + (x[i] - centre[i]) * largest / PetscSqrtReal(squared);
  }
}

void box_shape_bend(const BoxShape *shape, PetscReal x[3])
{
  if (shape->kind == BOX_POLAR) {
    const PetscReal radius = x[0], angle = x[1] * PETSC_PI / 180;
    x[0] = radius * PetscCosReal(angle);
    x[1] = radius * PetscSinReal(angle);
  } else if (shape->kind != BOX_STRAIGHT) {
    make_round(shape->centre, shape->axis, x);
  }
}
