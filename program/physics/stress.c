/* Stresses of a cell to look at. They are best known between its corners and its centre: at the Gauss points of reduced
 * integration (J. Barlow, Int. J. Numer. Meth. Engng 10, 1976). From there they are continued linearly to the nodes. */
#include "physics/elasticity.h"

/* How far from the centre they lie, as a part of the way to the corners: 1/sqrt(3) in a product of lines, the three points of
 * degree 2 in a triangle, the four in a tetrahedron. A linear simplex has one stress. */
static PetscReal part_of_the_way(CellKind kind)
{
  if (!cell_is_simplex(kind)) return 1 / PetscSqrtReal(3);
  if (kind == TRI6) return 0.5;
  return kind == TET10 ? 1 / PetscSqrtReal(5) : 0;
}

void cell_centre_stress(const Element *element, const PetscReal u[], PetscReal sigma[9])
{
  PetscReal centre[3];
  cell_centre(element->kind, centre);
  cell_stresses(element, u, 1, centre, sigma);
}

void cell_nodal_stresses(const Element *element, const PetscReal u[], PetscReal sigma[])
{
  const CellKind  kind    = element->kind;
  const PetscInt  corners = cell_corners(kind);
  const CellKind  linear  = cell_kind(cell_dimension(kind), corners);
  const PetscReal part    = part_of_the_way(kind);
  PetscReal       centre[3], xi[3 * CELL_CORNERS], known[9 * CELL_CORNERS];
  cell_centre(kind, centre);
  for (PetscInt c = 0; c < corners; c++) {
    cell_node_position(linear, c, xi + 3 * c);
    for (int i = 0; i < 3; i++)
      xi[3 * c + i] = centre[i] + part * (xi[3 * c + i] - centre[i]);
  }
  cell_stresses(element, u, corners, xi, known);
  for (PetscInt a = 0; a < cell_nodes(kind); a++) {
    PetscReal at[3], N[CELL_NODES], dN[CELL_NODES][3];
    cell_node_position(kind, a, at);
    for (int i = 0; i < 3; i++)
      at[i] = centre[i] + (part > 0 ? (at[i] - centre[i]) / part : 0);
    cell_functions(linear, at, N, dN);
    for (int k = 0; k < 9; k++) {
      sigma[9 * a + k] = 0;
      for (PetscInt c = 0; c < corners; c++)
        sigma[9 * a + k] += N[c] * known[9 * c + k];
    }
  }
}
