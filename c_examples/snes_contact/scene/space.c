/* What space a scene is in, as numbers. */
#include "scene/space.h"

PetscInt space_dimension(const Space *space)
{
  return space->kind == SPACE_SOLID ? 3 : 2;
}

PetscReal space_measure(const Space *space, PetscReal x)
{
  return space->kind == SPACE_AXISYMMETRIC ? 2 * PETSC_PI * x : space->thickness;
}
