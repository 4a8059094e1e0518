/* Geometry of one cell: the shape functions of 8-node hexahedra and 4-node tetrahedra, and their Gauss points. */
#ifndef SNES_CONTACT_CELL_H
#define SNES_CONTACT_CELL_H
#include "scene/petsc_compat.h"

enum { CELL_CORNERS = 8, CELL_POINTS = 8 }; /* the most that a cell has */

/* 1/sqrt(3) */
#define CELL_GAUSS 0.57735026918962576451
/* corners of the reference hexahedron [-1,1]^3 in VTK's order */
extern const PetscReal CELL_HEX[8][3];

/* dN/dxi of all corners at a reference point */
void      cell_reference_gradients(PetscInt corners, const PetscReal xi[3], PetscReal dN[][3]);
/* dN/dxi -> dN/dX in place; returns det dX/dxi */
PetscReal cell_physical_gradients(PetscInt corners, const PetscReal X[], PetscReal dN[][3]);
/* Gauss point q of the cell; returns its weight. One point suffices for the constant gradients of a tet4. */
PetscReal cell_quadrature_point(PetscInt corners, PetscInt q, PetscReal xi[3]);
PetscReal cell_smallest_jacobian(PetscInt corners, const PetscReal X[]);
#endif
