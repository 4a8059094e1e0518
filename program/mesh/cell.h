/* Geometry of one cell: nodes, shape functions and Gauss points of lines, triangles, quadrilaterals, tetrahedra and
 * hexahedra, linear and quadratic. The faces of a cell are of a kind with one dimension less. Nodes come in VTK's order:
 * corners, then those in the middle of edges, of faces, of the cell. Points of reference and gradients have three
 * components; those beyond a kind's dimension are zero. */
#ifndef STICKSLIP_PROGRAM_CELL_H
#define STICKSLIP_PROGRAM_CELL_H
#include "scene/petsc_compat.h"

typedef enum { LINE2, LINE3, TRI3, TRI6, QUAD4, QUAD8, QUAD9, TET4, TET10, HEX8, HEX20, HEX27, CELL_KINDS } CellKind;

enum { CELL_NODES = 27, CELL_CORNERS = 8, CELL_POINTS = 27, FACE_NODES = 9 }; /* the most that there are */

/* cell_nodes.c */
CellKind  cell_kind(PetscInt dimension, PetscInt nodes);
PetscInt  cell_dimension(CellKind kind);
PetscInt  cell_nodes(CellKind kind);
PetscInt  cell_corners(CellKind kind);
PetscBool cell_is_simplex(CellKind kind);
PetscInt  cell_faces(CellKind kind);
/* a node lies in the middle of these corners of its cell, a corner of itself; returns how many */
PetscInt  cell_node_corners(CellKind kind, PetscInt node, PetscInt corners[CELL_CORNERS]);
void      cell_node_position(CellKind kind, PetscInt node, PetscReal xi[3]);
/* nodes of a face, in the order of the face's kind and with its normal outward: as the right hand turns, or to the right
 * of a line; returns how many */
PetscInt  cell_face(CellKind kind, PetscInt face, const PetscInt cell[], PetscInt vertices[FACE_NODES]);

/* cell.c */
/* N and dN/dxi of all nodes at a point of reference */
void      cell_functions(CellKind kind, const PetscReal xi[3], PetscReal N[], PetscReal dN[][3]);
/* dN/dxi -> dN/dX in place; returns det dX/dxi. In two dimensions cells lie in a plane z = const. */
PetscReal cell_physical_gradients(CellKind kind, const PetscReal X[], PetscReal dN[][3]);
void      cell_centre(CellKind kind, PetscReal xi[3]);
PetscInt  cell_quadrature_points(CellKind kind);
/* Gauss point q; returns its weight */
PetscReal cell_quadrature_point(CellKind kind, PetscInt q, PetscReal xi[3]);
PetscReal cell_smallest_jacobian(CellKind kind, const PetscReal X[]);
#endif
