/* What space a scene is in (`model`, `thickness`), and its vectors, which have two numbers where it is plane. Everything
 * else in this program has three components everywhere: in a plane or axisymmetric model the third one is zero and no
 * unknown. In an axisymmetric model x is the radius, and y the axis. */
#ifndef STICKSLIP_PROGRAM_SPACE_H
#define STICKSLIP_PROGRAM_SPACE_H
#include "scene/scene.h"

typedef enum { SPACE_SOLID, SPACE_PLANE_STRAIN, SPACE_PLANE_STRESS, SPACE_AXISYMMETRIC } SpaceKind;

typedef struct {
  SpaceKind kind;
  PetscReal thickness; /* of plane models, else 1 */
} Space;

/* space.c */
PetscInt  space_dimension(const Space *space);
/* of what an area of a model stands for, at its radius x: the thickness, or 2 pi x; 1 in a solid */
PetscReal space_measure(const Space *space, PetscReal x);

/* c = a x b */
void space_cross(const PetscReal a[3], const PetscReal b[3], PetscReal c[3]);

/* space_read.c */
void space_read(Scene *scene, Space *space);

/* As scene_vector(), of `space`: a vector; lower and upper corner of a box; the rows of a matrix; the axis of a turn, with
 * its angle as length, which in the plane is the angle alone. */
PetscBool space_vector(Scene *scene, const Space *space, const char *map, const char *key, PetscReal x[3]);
PetscBool space_box(Scene *scene, const Space *space, const char *map, const char *key, PetscReal box[6]);
PetscBool space_matrix(Scene *scene, const Space *space, const char *map, const char *key, PetscReal matrix[9]);
PetscBool space_turn(Scene *scene, const Space *space, const char *map, const char *key, PetscReal turn[3]);
#endif
