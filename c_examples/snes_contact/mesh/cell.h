/* Geometry of one cell: nodes, shape functions and Gauss points of tetrahedra and hexahedra, linear (tet4, hex8) and
 * quadratic (tet10, hex20, hex27), and of their faces (tri3, quad4, tri6, quad8, quad9). A kind is known by its number
 * of nodes. Nodes come in VTK's order: corners, then those in the middle of edges, of faces, of the cell. */
#ifndef SNES_CONTACT_CELL_H
#define SNES_CONTACT_CELL_H
#include "scene/petsc_compat.h"

enum { CELL_NODES = 27, CELL_POINTS = 27, FACE_NODES = 9, FACE_POINTS = 9 }; /* the most that there are */

/* 1/sqrt(3) and sqrt(3/5) */
#define CELL_GAUSS 0.57735026918962576451
#define CELL_GAUSS_3 0.77459666924148337704
/* nodes of the reference hexahedron [-1,1]^3 */
extern const PetscReal CELL_HEX[27][3];

/* cell_nodes.c */
PetscInt  cell_corners(PetscInt nodes);
PetscInt  cell_faces(PetscInt nodes);
/* a node lies in the middle of these corners of its cell, a corner of itself; returns how many */
PetscInt  cell_node_corners(PetscInt nodes, PetscInt node, PetscInt corners[8]);
void      cell_node_position(PetscInt nodes, PetscInt node, PetscReal xi[3]);
/* nodes of face 0..5 of a hexahedron, 0..3 of a tetrahedron: corners, outward as the right hand turns, then node k
 * between corner k and the next one, then the centre; returns how many */
PetscInt  cell_face(PetscInt nodes, PetscInt face, const PetscInt cell[], PetscInt vertices[FACE_NODES]);
PetscInt  face_corners(PetscInt nodes);
PetscInt  face_node_corners(PetscInt nodes, PetscInt node, PetscInt corners[4]);

/* cell.c */
/* dN/dxi of all nodes at a reference point */
void      cell_reference_gradients(PetscInt nodes, const PetscReal xi[3], PetscReal dN[][3]);
/* dN/dxi -> dN/dX in place; returns det dX/dxi */
PetscReal cell_physical_gradients(PetscInt nodes, const PetscReal X[], PetscReal dN[][3]);
void      cell_centre(PetscInt nodes, PetscReal xi[3]);
PetscInt  cell_quadrature_points(PetscInt nodes);
/* Gauss point q of the cell; returns its weight */
PetscReal cell_quadrature_point(PetscInt nodes, PetscInt q, PetscReal xi[3]);
PetscReal cell_smallest_jacobian(PetscInt nodes, const PetscReal X[]);

/* face.c */
PetscInt  face_quadrature_points(PetscInt nodes);
PetscReal face_quadrature_point(PetscInt nodes, PetscInt q, PetscReal xi[2]);
/* N and dN/dxi of all nodes */
void      face_functions(PetscInt nodes, const PetscReal xi[2], PetscReal N[], PetscReal d[][2]);
#endif
