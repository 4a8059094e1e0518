/* Implicit dynamics, `dynamics` in a scene: inertia, damping and the time integration of the bodies (docs/dynamics.md).
 *
 * PETSc's TSALPHA2 is not used: it evaluates all forces at the middle of a step, where contact would neither end a step with closed
 * gaps nor be unable to give energy, and its stages know nothing of Newton's attempts, of a commit that the library refuses and
 * of a step that is taken back for that. Here the same scheme is a residual and a tangent in the driver's own steps. */
#ifndef STICKSLIP_PROGRAM_DYNAMICS_H
#define STICKSLIP_PROGRAM_DYNAMICS_H
#include "physics/physics.h"
#include <petscksp.h>

/* At the end of a step; what has done work has done so since t = 0, on the bodies that have mass. */
typedef struct {
  PetscReal kinetic, strain;
  PetscReal external, supports, contact; /* work of loads, supports, contact */
  PetscReal given;                       /* of that of contact the steps in which it gave energy that it had not stored, where nothing
                                            without mass moves */
  PetscReal store;                       /* what contact has stored: no part of that of the bodies */
  PetscReal friction, lost;              /* that of friction, as the library counts it; what contact has taken beside it, where nothing
                                            without mass moves */
  PetscReal damping;                     /* energy that is gone by it */
  PetscReal largest;                     /* energy of the bodies so far, without what came from nowhere */
  PetscReal momentum[3], angular[3];     /* the latter about the origin */
} Balance;

/* Energy that should not come or go (output/energy_told.c): in the step to which it was told, 0: never; how much, over that of the bodies */
enum { ENERGY_CONTACT, ENERGY_TIME, ENERGY_IMPACT, N_ENERGIES };
typedef struct {
  PetscReal t, part;
} EnergyTold;

/* The masses of a cell: n x n of the nodes that have them; n is 0 of a cell without any. With `contact_mass: spread` these are not all of the
 * cell's, and others, and the arrays are its own (mass_spread.c). */
typedef struct {
  PetscInt   n, *dofs; /* local offset of each node */
  PetscReal *X, *m;    /* undeformed places; masses */
  PetscBool  own;
} CellMass;

/* A node without mass, which goes with nodes inside, its donors: as an affine field does */
enum { DONORS = 4, MASS_NODES = CELL_NODES * DONORS }; /* a cell has masses of so many nodes at most */
typedef struct {
  PetscInt  dof, n, donors[DONORS]; /* local offsets */
  PetscReal weights[DONORS];
} Bare;

struct Dynamics {
  PetscReal rho_inf, alpha_m, alpha_f, beta, gamma;
  PetscReal scale; /* kappa: the residual is divided by it, so that contact forces are what the library says */
  PetscReal mass_damping, stiffness_damping;
  PetscReal *velocity; /* of each body at t = 0: velocity, spin, the point that it turns about; MOTION_NUMBERS */
  PetscReal  t_n, dt;
  CellMass  *cells; /* of each of this rank's */
  PetscReal *mass;  /* of those that have no arrays of their own */
  PetscBool  spread;
  PetscInt   n_bare;
  Bare      *bare;
  char      *entries; /* of a local vector, MASS_... */
  /* local vectors: at t_n displacements, velocities, M times accelerations without those of contact, accelerations where they are
   * prescribed */
  Vec     u, v, force, prescribed;
  Vec     v_next, force_next, prescribed_next; /* the same at the end of the step: what is prescribed from its start on, else by dynamics_measure() */
  Vec     middle, work, smooth, impulse; /* the place of the forces; work space; forces but those of contact; 2 M v / dt */
  Vec     rate;                          /* velocities at the time of the forces, times the stiffness_damping */
  Balance start, last, now;
  PetscBool told; /* that contact gives energy at all */
  EnergyTold energies[N_ENERGIES];
  Vec     thermal; /* local: what warm bodies are pushed apart by at t_n; NULL: none expands */
  Mat     matrix; /* of the masses, and what solves with it; NULL where rho_inf is 1 */
  KSP     solver;
};

enum { MASS_NONE, MASS_FREE, MASS_PRESCRIBED };

/* Local vectors of a step: displacements of now and of t_n, velocities and prescribed accelerations of both */
typedef struct {
  const PetscScalar *now, *u, *v, *a, *v_next, *a_next;
} StepView;

enum { MOTION_NUMBERS = 9 };

/* dynamics_scene.c */
PetscErrorCode dynamics_read(Scene *scene, Physics *physics);
/* dynamics_state.c: after bulk_create() and loads_assemble(); a step from t_n is accepted */
PetscErrorCode dynamics_create(Scene *scene, Physics *physics);
PetscErrorCode dynamics_accept(Physics *physics);
PetscErrorCode dynamics_destroy(Physics *physics);
/* dynamics.c: at the start of a step to physics->t; then in place of bulk_forces(), bulk_stiffness() and the loads */
PetscErrorCode dynamics_begin(Physics *physics);
PetscErrorCode dynamics_warm(Physics *physics); /* before that: physics->f_thermal is that of t_n */
PetscErrorCode dynamics_loads(Physics *physics); /* of the middle of the step, once more: physics->f_thermal has changed */
PetscErrorCode dynamics_hold(Physics *physics); /* which displacements are held in the step that begins */
PetscErrorCode dynamics_forces(Physics *physics, Vec f_local, PetscInt *status);
PetscErrorCode dynamics_stiffness(Physics *physics, Mat matrix, PetscInt *status);
BulkStep       dynamics_bulk(const Physics *physics); /* the step up to u_local, with what is in `rate` */
PetscErrorCode dynamics_look(const Physics *physics, StepView *step);
PetscErrorCode dynamics_looked(const Physics *physics, StepView *step);
/* of entry k: what M is multiplied with in the residual; the velocity that damping takes, at the time of the forces */
PetscReal      dynamics_rate(const Dynamics *dynamics, const StepView *step, PetscInt k);
PetscReal      dynamics_velocity(const Dynamics *dynamics, const StepView *step, PetscInt k);
void           dynamics_swap(Vec *a, Vec *b); /* no copy */
/* dynamics_balance.c: at a converged state, before the step is accepted; `f_local` of the last evaluation; what contact has stored, what friction has
 * taken up to here */
PetscErrorCode dynamics_measure(Physics *physics, PetscReal store, PetscReal friction);
PetscReal      dynamics_numerical(const Dynamics *dynamics, const Balance *balance); /* what has come from nowhere */
PetscErrorCode dynamics_energies(Physics *physics, Vec u, Vec v, PetscBool end, Balance *balance); /* end: of rigid bodies, the motion of now */
/* mass.c: f += factor M v, of the cells here; the matrix of the equations, and what solves with it */
PetscErrorCode mass_create(Physics *physics);
void           mass_multiply(const Physics *physics, const PetscScalar *v, PetscReal factor, PetscScalar *f);
PetscErrorCode mass_insert(const Physics *physics, PetscReal factor, Mat matrix);
PetscErrorCode mass_matrix(Physics *physics);
PetscErrorCode mass_destroy(Physics *physics);
/* mass_spread.c: takes the masses of non-mortar nodes to nodes inside; where a matrix needs room for that; puts such nodes where an affine motion
 * of their donors from one local vector to another takes them */
PetscErrorCode mass_spread(Scene *scene, Physics *physics);
PetscErrorCode mass_pattern(const Physics *physics, Mat matrix);
void           mass_follow(const Physics *physics, const PetscScalar *from, PetscScalar *to);
#endif
