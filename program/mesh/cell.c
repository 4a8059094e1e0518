/* Shape functions and Gauss points of all kinds of cells.
 *
 * The points integrate dN/dX exactly over a cell, whatever the places of its nodes, so that cells with curved edges pass
 * the patch test, too: a product of dN/dxi and of cofactors of dX/dxi, of degree 3 in quadratic tetrahedra (for which four
 * points, of degree 2, are usual: they fail there), of degree 2 in quadratic triangles, and of degree 5 in each direction
 * in quadratic hexahedra. Over faces they integrate a function times the normal, in rings times the radius. A tri3 has
 * three points for the sake of rings: the strain around varies in them, and one point would leave a motion without energy. */
#include "mesh/cell.h"

/* 1/sqrt(3) and sqrt(3/5) */
static const PetscReal GAUSS_2 = 0.57735026918962576451, GAUSS_3 = 0.77459666924148337704;
/* Eight points of equal weight on the lines from the centre (0) to the corners (1) of a tetrahedron, the same two places on
 * each line: the mean of their squares is 1/5, of their cubes 1/15, which makes degree 3 exact. */
static const PetscReal TET10_PLACES[2] = {0.54817282194995588522, -0.31544659972081164160};
/* Of a tri6: six points, for polynomials of degree 4, such as a function times the normal of a curved face: two orbits of
 * points (a, a, 1 - 2 a) with their weights (D. A. Dunavant, Int. J. Numer. Meth. Engng 21, 1985). */
static const PetscReal TRI6_PLACES[2]  = {0.44594849091596488632, 0.09157621350977074346};
static const PetscReal TRI6_WEIGHTS[2] = {0.22338158967801146570, 0.10995174365532186764};

static PetscBool is_quadratic(CellKind kind)
{
  return (PetscBool)(cell_nodes(kind) > cell_corners(kind));
}

/* In the barycentric coordinates L: N = L, or L (2 L - 1) at corners and 4 L_a L_b at edges. */
static void simplex_functions(CellKind kind, const PetscReal xi[3], PetscReal N[], PetscReal dN[][3])
{
  const PetscInt dimension = cell_dimension(kind);
  PetscReal      L[4]      = {1, xi[0], xi[1], xi[2]};
  for (int k = 0; k < dimension; k++)
    L[0] -= xi[k];
  for (PetscInt node = 0; node < cell_nodes(kind); node++) {
    PetscInt        c[CELL_CORNERS];
    const PetscBool edge = (PetscBool)(cell_node_corners(kind, node, c) == 2);
    const PetscReal a = L[c[0]], b = edge ? L[c[1]] : 0;
    N[node] = edge ? 4 * a * b : is_quadratic(kind) ? a * (2 * a - 1) : a;
    for (int k = 0; k < 3; k++) {
      const PetscReal da = c[0] ? c[0] - 1 == k : -1, db = !edge ? 0 : c[1] ? c[1] - 1 == k : -1;
      dN[node][k] = k >= dimension ? 0 : edge ? 4 * (a * db + da * b) : is_quadratic(kind) ? (4 * a - 1) * da : da;
    }
  }
}

/* Products of functions of a line, where p is the node's position: (1 + p x) / 2, or of degree 2 in each direction. The
 * serendipity functions of quad8 and hex20 are linear across an edge, and have at a corner the factor p . x - (d - 1) in d
 * dimensions. */
static void product_functions(CellKind kind, const PetscReal xi[3], PetscReal N[], PetscReal dN[][3])
{
  const PetscInt  dimension   = cell_dimension(kind);
  const PetscBool serendipity = (PetscBool)(kind == QUAD8 || kind == HEX20);
  for (PetscInt node = 0; node < cell_nodes(kind); node++) {
    PetscReal p[3], f[3] = {1, 1, 1}, df[3] = {0}, factor = 1 - (PetscReal)dimension;
    cell_node_position(kind, node, p);
    for (int k = 0; k < dimension; k++) {
      const PetscReal x = xi[k];
      if (p[k] == 0) { /* the middle of an edge along k, of a face or of the cell */
        f[k]  = 1 - x * x;
        df[k] = -2 * x;
      } else if (is_quadratic(kind) && !serendipity) {
        f[k]  = x * (x + p[k]) / 2;
        df[k] = x + p[k] / 2;
      } else {
        f[k]  = (1 + p[k] * x) / 2;
        df[k] = p[k] / 2;
      }
      factor += p[k] * x;
    }
    if (!serendipity || node >= cell_corners(kind)) {
      factor = 1;
      p[0] = p[1] = p[2] = 0; /* its derivatives */
    }
    N[node] = f[0] * f[1] * f[2] * factor;
    for (int k = 0; k < 3; k++)
      dN[node][k] = k < dimension ? f[(k + 1) % 3] * f[(k + 2) % 3] * (df[k] * factor + f[k] * p[k]) : 0;
  }
}

void cell_functions(CellKind kind, const PetscReal xi[3], PetscReal N[], PetscReal dN[][3])
{
  (cell_is_simplex(kind) ? simplex_functions : product_functions)(kind, xi, N, dN);
}

PetscReal cell_physical_gradients(CellKind kind, const PetscReal X[], PetscReal dN[][3])
{
  const PetscInt nodes = cell_nodes(kind);
  PetscReal      J[3][3] = {{0}}, inverse[3][3], det;
  for (PetscInt a = 0; a < nodes; a++) {
    for (int i = 0; i < 3; i++) {
      for (int k = 0; k < 3; k++)
        J[i][k] += X[3 * a + i] * dN[a][k];
    }
  }
  if (cell_dimension(kind) == 2) J[2][2] = 1;
  for (int i = 0; i < 3; i++) { /* adjugate by cyclic indices */
    for (int k = 0; k < 3; k++) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      inverse[k][i] = J[i1][k1] * J[i2][k2] - J[i1][k2] * J[i2][k1];
    }
  }
  det = J[0][0] * inverse[0][0] + J[0][1] * inverse[1][0] + J[0][2] * inverse[2][0];
  for (PetscInt a = 0; a < nodes; a++) {
    PetscReal g[3];
    for (int i = 0; i < 3; i++)
      g[i] = (dN[a][0] * inverse[0][i] + dN[a][1] * inverse[1][i] + dN[a][2] * inverse[2][i]) / det;
    for (int i = 0; i < 3; i++)
      dN[a][i] = g[i];
  }
  return det;
}

void cell_centre(CellKind kind, PetscReal xi[3])
{
  for (int k = 0; k < 3; k++)
    xi[k] = cell_is_simplex(kind) && k < cell_dimension(kind) ? 1 / (PetscReal)cell_corners(kind) : 0;
}

/* points in each direction of a product */
static PetscInt points_along(CellKind kind)
{
  return is_quadratic(kind) ? 3 : 2;
}

PetscInt cell_quadrature_points(CellKind kind)
{
  PetscInt n = 1;
  if (cell_is_simplex(kind)) return kind == TRI3 ? 3 : kind == TRI6 ? 6 : kind == TET4 ? 1 : 8;
  for (int k = 0; k < cell_dimension(kind); k++)
    n *= points_along(kind);
  return n;
}

static PetscReal simplex_point(CellKind kind, PetscInt q, PetscReal xi[3])
{
  cell_centre(kind, xi);
  if (kind == TRI6) {
    const PetscReal a = TRI6_PLACES[q / 3];
    for (int k = 0; k < 2; k++)
      xi[k] = q % 3 == k ? 1 - 2 * a : a;
    return 0.5 * TRI6_WEIGHTS[q / 3];
  }
  if (kind == TET10) {
    const PetscReal along = TET10_PLACES[q / 4];
    for (int k = 0; k < 3; k++)
      xi[k] = (q % 4 - 1 == k ? 1 + 3 * along : 1 - along) / 4;
    return 1.0 / 48;
  }
  if (kind == TET4) return 1.0 / 6;
  for (int k = 0; k < 2; k++) /* a tri3: degree 2 */
    xi[k] = q == k ? 2.0 / 3 : 1.0 / 6;
  return 1.0 / 6;
}

PetscReal cell_quadrature_point(CellKind kind, PetscInt q, PetscReal xi[3])
{
  const PetscInt n      = points_along(kind);
  PetscReal      weight = 1;
  if (cell_is_simplex(kind)) return simplex_point(kind, q, xi);
  for (int k = 0; k < 3; k++, q /= n) {
    const PetscReal place = (PetscReal)(2 * (q % n) - n + 1) / (PetscReal)(n - 1); /* -1, 0 or 1 */
    xi[k]                 = k < cell_dimension(kind) ? place * (n == 2 ? GAUSS_2 : GAUSS_3) : 0;
    if (n == 3 && k < cell_dimension(kind)) weight *= (place == 0 ? 8.0 : 5.0) / 9;
  }
  return weight;
}

static PetscReal jacobian(CellKind kind, const PetscReal X[], const PetscReal xi[3])
{
  PetscReal N[CELL_NODES], dN[CELL_NODES][3];
  cell_functions(kind, xi, N, dN);
  return cell_physical_gradients(kind, X, dN);
}

/* At the nodes: of a cell with straight edges the corners are the strictest place. A quadratic cell must have it positive
 * where it is evaluated, too. */
PetscReal cell_smallest_jacobian(CellKind kind, const PetscReal X[])
{
  PetscReal xi[3], smallest = PETSC_MAX_REAL;
  for (PetscInt a = 0; a < cell_nodes(kind); a++) {
    PetscReal determinant;
    cell_node_position(kind, a, xi);
    determinant = jacobian(kind, X, xi); /* once: PetscMin evaluates its arguments twice */
    smallest    = PetscMin(smallest, determinant);
  }
  for (PetscInt q = 0; q < cell_quadrature_points(kind) && is_quadratic(kind); q++) {
    PetscReal determinant;
    (void)cell_quadrature_point(kind, q, xi);
    determinant = jacobian(kind, X, xi);
    smallest    = PetscMin(smallest, determinant);
  }
  return smallest;
}
