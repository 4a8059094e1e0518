/* Nodal forces of what acts on a cell (mesh/cell.h) or on a face of it, in every space (scene/space.h). Forces are those of
 * the thickness, or of the whole ring. */
#ifndef STICKSLIP_PROGRAM_ELEMENT_LOADS_H
#define STICKSLIP_PROGRAM_ELEMENT_LOADS_H
#include "mesh/cell.h"
#include "scene/space.h"

/* An acceleration: the same everywhere, and that of a body which turns about an axis through `origin` at |spin| radians per
 * unit of time: -w x (w x (X - origin)), from the axis outward. */
typedef struct {
  PetscReal uniform[3], spin[3], origin[3];
} Acceleration;

/* consistent nodal forces of mass with this density, in f (3 per node), at the places X of the undeformed body */
void cell_body_forces(CellKind kind, const Space *space, PetscReal density, const Acceleration *acceleration,
                      const PetscReal X[], PetscReal f[]);

/* nodal forces of a pressure against the normal of a face at x, in f (3 per node), and their derivatives by x, in K
 * ((3 nodes)^2, row-major) unless NULL. The normal: as the right hand turns with the nodes, or to the right of a line. */
void face_pressure(CellKind kind, const Space *space, const PetscReal x[], PetscReal pressure, PetscReal f[],
                   PetscReal K[]);

/* consistent nodal forces of a dead traction on a reference face, added to f (3 per node) */
void face_traction(CellKind kind, const Space *space, const PetscReal X[], const PetscReal traction[3], PetscReal f[]);

/* int N_a N_b dA of a reference face, in M (nodes^2) */
void face_products(CellKind kind, const Space *space, const PetscReal X[], PetscReal M[]);
#endif
