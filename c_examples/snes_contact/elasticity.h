/* Bulk elements: 8-node hexahedra (2x2x2 Gauss points) and 4-node tetrahedra. The material enters through one function, so
 * that a large-strain law is another function, not another element. */
#ifndef SNES_CONTACT_ELASTICITY_H
#define SNES_CONTACT_ELASTICITY_H
#include "petsc_compat.h"

typedef struct Material Material;
/* H = du/dX (row-major) -> first Piola-Kirchhoff stress P (row-major) and, unless NULL, A[9 (3i+J) + 3k+L] = dP_iJ/dH_kL */
typedef void (*MaterialLaw)(const Material *material, const PetscReal H[9], PetscReal P[9], PetscReal A[81]);
struct Material {
  PetscReal   young, poisson;
  MaterialLaw law;
};
void linear_elastic(const Material *material, const PetscReal H[9], PetscReal P[9], PetscReal A[81]);

/* corners: 8 or 4; X, u, f: 3 per corner; K: (3 corners)^2 row-major or NULL. f and K are overwritten. */
PetscErrorCode cell_forces(PetscInt corners, const Material *material, const PetscReal X[], const PetscReal u[],
                           PetscReal f[], PetscReal K[]);
void           cell_centre_stress(PetscInt corners, const Material *material, const PetscReal X[], const PetscReal u[],
                                  PetscReal P[9]);
PetscReal      cell_smallest_jacobian(PetscInt corners, const PetscReal X[]);

/* consistent nodal forces of a dead traction on a reference face with 3 or 4 corners: sum over a in f (3 per corner).
 * `pressure` acts against the normal of the face as its vertices turn. */
void face_forces(PetscInt corners, const PetscReal X[], const PetscReal traction[3], PetscReal pressure, PetscReal f[]);
#endif
