/* Bulk elements of all kinds of cells (mesh/cell.h), in every space (scene/space.h). What they are made of: materials.h. */
#ifndef SNES_CONTACT_ELASTICITY_H
#define SNES_CONTACT_ELASTICITY_H
#include "mesh/cell.h"
#include "physics/materials.h"
#include "scene/space.h"

/* X, u, f: 3 per node; K: (3 nodes)^2 row-major or NULL. f and K are overwritten. Forces are those of the thickness, or of the
 * whole ring. But in a solid, what K has for the third component is for nobody.
 * `inverted`: det F <= 0 at a Gauss point, where a law of finite strain has no stress; f and K then mean nothing. */
PetscErrorCode cell_forces(CellKind kind, const Space *space, const Material *material, const PetscReal X[],
                           const PetscReal u[], PetscReal f[], PetscReal K[], PetscBool *inverted);
/* its strain energy; infinite where det F <= 0 */
PetscReal      cell_energy(CellKind kind, const Space *space, const Material *material, const PetscReal X[], const PetscReal u[]);
/* of the displacements, H = du/dX, with the strain across the plane */
void           cell_centre_gradient(CellKind kind, const Space *space, const Material *material, const PetscReal X[],
                                    const PetscReal u[], PetscReal H[9]);
/* Cauchy's stress at n points of reference, 9 each; zeros where det F <= 0 */
void           cell_stresses(CellKind kind, const Space *space, const Material *material, const PetscReal X[],
                             const PetscReal u[], PetscInt n, const PetscReal xi[], PetscReal sigma[]);
/* stress.c: the same at the centre; and at all nodes, from the places within the cell where it is best known */
void           cell_centre_stress(CellKind kind, const Space *space, const Material *material, const PetscReal X[],
                                  const PetscReal u[], PetscReal sigma[9]);
void           cell_nodal_stresses(CellKind kind, const Space *space, const Material *material, const PetscReal X[],
                                   const PetscReal u[], PetscReal sigma[]);
#endif
