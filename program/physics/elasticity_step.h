/* For elasticity_step.c and elasticity_damping.c: a cell at both ends of a step (step_points.c). */
#ifndef STICKSLIP_PROGRAM_ELASTICITY_STEP_H
#define STICKSLIP_PROGRAM_ELASTICITY_STEP_H
#include "physics/cell_points.h"

typedef struct {
  const Element  *element;
  const CellStep *step;
  PetscInt        n;
  PetscReal       whole; /* its volume */
  Point           before[CELL_POINTS], after[CELL_POINTS];
  PetscReal       start[CELL_POINTS][9], end[CELL_POINTS][9]; /* E */
} StepPoints;

/* At a point: P = F S, and dP/dF' = F (dS/dE) R + part S, where dE = sym(R^T dF') */
typedef struct {
  PetscReal F[9], R[9], S[9], D[81], part;
} StepStress;

/* F = I + H where the forces are */
void           step_place(const StepPoints *points, PetscInt q, PetscReal F[9]);
/* f and, but for NULL, K gain it; D of plane stress is condensed */
void           step_add(const StepPoints *points, PetscInt q, StepStress *stress, PetscReal f[], PetscReal K[]);
/* of a stress V by each unit of a cell's mean: what the mean's forces are made of, what the mean changes by */
void           step_add_mean(const StepPoints *points, PetscInt q, const StepStress *stress, const PetscReal V[9], PetscReal of_force[], PetscReal of_mean[]);
void           step_add_product(const StepPoints *points, PetscReal factor, const PetscReal of_force[], const PetscReal of_mean[], PetscReal K[]);
/* elasticity_damping.c */
void           step_add_damping(const StepPoints *points, PetscReal f[], PetscReal K[]);
#endif
