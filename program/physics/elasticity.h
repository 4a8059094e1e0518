/* Bulk elements of all kinds of cells (mesh/cell.h), in every space (scene/space.h). What they are made of: materials.h. */
#ifndef STICKSLIP_PROGRAM_ELASTICITY_H
#define STICKSLIP_PROGRAM_ELASTICITY_H
#include "mesh/cell.h"
#include "physics/materials.h"
#include "scene/space.h"

/* An undeformed cell. X: 3 per node. swell: of each node the strain that it has without stress, of laws of finite strain; NULL: none */
typedef struct {
  CellKind         kind;
  const Space     *space;
  const Material  *material;
  const PetscReal *X, *swell;
} Element;

/* u, f: 3 per node; K: (3 nodes)^2 row-major or NULL. f and K are overwritten. Forces are those of the thickness, or of the
 * whole ring. But in a solid, what K has for the third component is for nobody.
 * `inverted`: det F <= 0 at a Gauss point, where a law of finite strain has no stress; f and K then mean nothing. */
PetscErrorCode cell_forces(const Element *element, const PetscReal u[], PetscReal f[], PetscReal K[], PetscBool *inverted);
/* its strain energy; infinite where det F <= 0 */
PetscReal      cell_energy(const Element *element, const PetscReal u[]);
/* of the displacements, H = du/dX, with the strain across the plane */
void           cell_centre_gradient(const Element *element, const PetscReal u[], PetscReal H[9]);
/* Cauchy's stress at n points of reference, 9 each; zeros where det F <= 0 */
void           cell_stresses(const Element *element, const PetscReal u[], PetscInt n, const PetscReal xi[], PetscReal sigma[]);
/* stress.c: the same at the centre; and at all nodes, from the places within the cell where it is best known */
void           cell_centre_stress(const Element *element, const PetscReal u[], PetscReal sigma[9]);
void           cell_nodal_stresses(const Element *element, const PetscReal u[], PetscReal sigma[]);

/* A step of `dynamics`, of finite strain: displacements at its start and its end, and how much of the start is in the forces. rate: velocities at
 * the time of the forces times the `stiffness_damping`, NULL: none; ahead: its derivative by `to`. */
typedef struct {
  const PetscReal *from, *to, *rate;
  PetscReal        alpha_f, ahead;
} CellStep;
/* elasticity_step.c: forces by which the work of a step is what the strain energy changes by, and what damping takes; K: by `to`, not symmetric.
 * damping_only: without those of the strain energy */
PetscErrorCode cell_step_forces(const Element *element, const CellStep *step, PetscBool damping_only, PetscReal f[], PetscReal K[], PetscBool *inverted);
#endif
