/* Bulk elements: tetrahedra with 4 or 10 nodes, hexahedra with 8, 20 or 27 (mesh/cell.h). What they are made of:
 * materials.h. */
#ifndef SNES_CONTACT_ELASTICITY_H
#define SNES_CONTACT_ELASTICITY_H
#include "mesh/cell.h"
#include "physics/materials.h"

/* nodes: how many the cell has; X, u, f: 3 per node; K: (3 nodes)^2 row-major or NULL. f and K are overwritten.
 * `inverted`: det F <= 0 at a Gauss point, where a law of finite strain has no stress; f and K then mean nothing. */
PetscErrorCode cell_forces(PetscInt nodes, const Material *material, const PetscReal X[], const PetscReal u[],
                           PetscReal f[], PetscReal K[], PetscBool *inverted);
/* of the displacements, H = du/dX */
void           cell_centre_gradient(PetscInt nodes, const PetscReal X[], const PetscReal u[], PetscReal H[9]);
/* Cauchy's stress; zeros where det F <= 0 */
void           cell_centre_stress(PetscInt nodes, const Material *material, const PetscReal X[], const PetscReal u[],
                                  PetscReal sigma[9]);

/* consistent nodal forces of a dead traction on a reference face (3, 4, 6, 8 or 9 nodes), in f (3 per node).
 * `pressure` acts against the normal of the face as its vertices turn. */
void face_forces(PetscInt nodes, const PetscReal X[], const PetscReal traction[3], PetscReal pressure, PetscReal f[]);
#endif
