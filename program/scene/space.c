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

void space_cross(const PetscReal a[3], const PetscReal b[3], PetscReal c[3])
{
  for (int i = 0; i < 3; i++)
    c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}
