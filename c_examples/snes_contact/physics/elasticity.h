/* Bulk elements: 8-node hexahedra (2x2x2 Gauss points) and 4-node tetrahedra. What they are made of: materials.h. */
#ifndef SNES_CONTACT_ELASTICITY_H
#define SNES_CONTACT_ELASTICITY_H
#include "mesh/cell.h"
#include "physics/materials.h"

/* corners: 8 or 4; X, u, f: 3 per corner; K: (3 corners)^2 row-major or NULL. f and K are overwritten.
 * `inverted`: det F <= 0 at a Gauss point, where a law of finite strain has no stress; f and K then mean nothing. */
PetscErrorCode cell_forces(PetscInt corners, const Material *material, const PetscReal X[], const PetscReal u[],
                           PetscReal f[], PetscReal K[], PetscBool *inverted);
/* of the displacements, H = du/dX */
void           cell_centre_gradient(PetscInt corners, const PetscReal X[], const PetscReal u[], PetscReal H[9]);
/* Cauchy's stress; zeros where det F <= 0 */
void           cell_centre_stress(PetscInt corners, const Material *material, const PetscReal X[], const PetscReal u[],
                                  PetscReal sigma[9]);

/* consistent nodal forces of a dead traction on a reference face with 3 or 4 corners: sum over a in f (3 per corner).
 * `pressure` acts against the normal of the face as its vertices turn. */
void face_forces(PetscInt corners, const PetscReal X[], const PetscReal traction[3], PetscReal pressure, PetscReal f[]);
#endif
