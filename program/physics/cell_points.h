/* The Gauss points of a cell, for elasticity.c and elasticity_step.c. */
#ifndef STICKSLIP_PROGRAM_CELL_POINTS_H
#define STICKSLIP_PROGRAM_CELL_POINTS_H
#include "physics/elasticity.h"

/* One point: gradients of the shape functions, in a ring N / r; weight; what it would have grown by if it were free; strain */
typedef struct {
  PetscReal dN[CELL_NODES][3], around[CELL_NODES], weight, swell, H[9];
} Point;

/* The gradients there, the measure without the weight of a Gauss point, and the strain of u; false: the law has no stress there. */
PetscBool point_strain(const Element *element, const PetscReal u[], const PetscReal xi[3], Point *point);
/* of any field of the nodes, without a strain across the plane of plane stress */
void      point_gradient(const Element *element, const Point *point, const PetscReal u[], PetscReal H[9]);
/* All points of the cell, their number, the mean of v and the volume; false where the law has no stress at one. */
PetscBool cell_points(const Element *element, const PetscReal u[], Point points[], PetscInt *n, PetscReal *mean, PetscReal *whole);
/* f += weight P : dH/du */
void      point_add_forces(const Element *element, const Point *point, const PetscReal P[9], PetscReal f[]);
/* K += weight dH/du_a : A : dH/du_b */
void      point_add_stiffness(const Element *element, const Point *point, const PetscReal A[81], PetscReal K[]);
#endif
