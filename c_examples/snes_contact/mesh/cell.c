/* Shape functions and Gauss points of cells. The points integrate dN/dX exactly, whatever the places of the nodes, so that
 * cells with curved edges pass the patch test, too: a product of dN/dxi and of cofactors of dX/dxi, of degree 3 in
 * quadratic tetrahedra (for which four points, of degree 2, are usual: they fail there), and of degree 5 in each
 * direction in quadratic hexahedra. */
#include "mesh/cell.h"

/* Eight points of equal weight on the lines from the centre (0) to the corners (1) of a tetrahedron, the same two places on
 * each line: the mean of their squares is 1/5, of their cubes 1/15, which makes degree 3 exact. */
static const PetscReal TET10_PLACES[2] = {0.54817282194995588522, -0.31544659972081164160};

/* N = L (2 L - 1) at corners and 4 L_a L_b at edges, in the barycentric coordinates L */
static void tet10_gradients(const PetscReal xi[3], PetscReal dN[][3])
{
  const PetscReal L[4] = {1 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
  for (PetscInt node = 0; node < 10; node++) {
    PetscInt       c[8];
    const PetscInt n = cell_node_corners(10, node, c);
    for (int k = 0; k < 3; k++) {
      const PetscReal da = c[0] ? c[0] - 1 == k : -1, db = n == 1 ? 0 : c[1] ? c[1] - 1 == k : -1;
      dN[node][k] = n == 1 ? (4 * L[c[0]] - 1) * da : 4 * (L[c[0]] * db + da * L[c[1]]);
    }
  }
}

/* Serendipity functions: N = s t r (p . xi - 2) / 8 at a corner p, with s = 1 + p_0 xi_0 and so on, and at the middle of
 * an edge (1 - xi_k^2) / 4 times the two factors across it. */
static void hex20_gradients(const PetscReal xi[3], PetscReal dN[][3])
{
  for (int a = 0; a < 20; a++) {
    const PetscReal *p = CELL_HEX[a];
    PetscReal        f[3], df[3], sum = -2;
    for (int k = 0; k < 3; k++) {
      f[k]  = p[k] == 0 ? 1 - xi[k] * xi[k] : 1 + p[k] * xi[k];
      df[k] = p[k] == 0 ? -2 * xi[k] : p[k];
      sum += p[k] * xi[k];
    }
    for (int k = 0; k < 3; k++) {
      const PetscReal across = f[(k + 1) % 3] * f[(k + 2) % 3];
      dN[a][k] = a < 8 ? across * (df[k] * sum + f[k] * p[k]) / 8 : across * df[k] / 4;
    }
  }
}

/* products of the quadratic functions of a line */
static void hex27_gradients(const PetscReal xi[3], PetscReal dN[][3])
{
  for (int a = 0; a < 27; a++) {
    const PetscReal *p = CELL_HEX[a];
    PetscReal        f[3], df[3];
    for (int k = 0; k < 3; k++) {
      f[k]  = p[k] == 0 ? 1 - xi[k] * xi[k] : xi[k] * (xi[k] + p[k]) / 2;
      df[k] = p[k] == 0 ? -2 * xi[k] : xi[k] + p[k] / 2;
    }
    for (int k = 0; k < 3; k++)
      dN[a][k] = df[k] * f[(k + 1) % 3] * f[(k + 2) % 3];
  }
}

void cell_reference_gradients(PetscInt nodes, const PetscReal xi[3], PetscReal dN[][3])
{
  if (nodes == 10) {
    tet10_gradients(xi, dN);
    return;
  }
  if (nodes > 8) {
    (nodes == 20 ? hex20_gradients : hex27_gradients)(xi, dN);
    return;
  }
  if (nodes == 4) {
    for (int k = 0; k < 3; k++) {
      dN[0][k] = -1;
      for (int a = 1; a < 4; a++)
        dN[a][k] = (a - 1 == k);
    }
    return;
  }
  for (int a = 0; a < 8; a++) {
    const PetscReal s = 1 + CELL_HEX[a][0] * xi[0], t = 1 + CELL_HEX[a][1] * xi[1], r = 1 + CELL_HEX[a][2] * xi[2];
    dN[a][0] = 0.125 * CELL_HEX[a][0] * t * r;
    dN[a][1] = 0.125 * CELL_HEX[a][1] * s * r;
    dN[a][2] = 0.125 * CELL_HEX[a][2] * s * t;
  }
}

PetscReal cell_physical_gradients(PetscInt nodes, const PetscReal X[], PetscReal dN[][3])
{
  PetscReal J[3][3] = {{0}}, inverse[3][3], det;
  for (PetscInt a = 0; a < nodes; a++) {
    for (int i = 0; i < 3; i++) {
      for (int k = 0; k < 3; k++)
        J[i][k] += X[3 * a + i] * dN[a][k];
    }
  }
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

void cell_centre(PetscInt nodes, PetscReal xi[3])
{
  for (int k = 0; k < 3; k++)
    xi[k] = cell_corners(nodes) == 4 ? 0.25 : 0;
}

PetscInt cell_quadrature_points(PetscInt nodes)
{
  return nodes == 4 ? 1 : nodes == 8 ? 8 : nodes == 10 ? 8 : 27;
}

PetscReal cell_quadrature_point(PetscInt nodes, PetscInt q, PetscReal xi[3])
{
  if (nodes == 10) {
    const PetscReal along = TET10_PLACES[q / 4];
    for (int k = 0; k < 3; k++)
      xi[k] = (q % 4 - 1 == k ? 1 + 3 * along : 1 - along) / 4;
    return 1.0 / 48;
  }
  if (nodes > 8) { /* at each node of the 27 that is no middle along an axis: 5/9, at a middle 8/9 */
    PetscReal weight = 1;
    for (int k = 0; k < 3; k++) {
      xi[k] = CELL_GAUSS_3 * CELL_HEX[q][k];
      weight *= (CELL_HEX[q][k] == 0 ? 8.0 : 5.0) / 9;
    }
    return weight;
  }
  for (int k = 0; k < 3; k++)
    xi[k] = nodes == 4 ? 0.25 : CELL_GAUSS * CELL_HEX[q][k];
  return nodes == 4 ? 1.0 / 6 : 1.0;
}

static PetscReal jacobian(PetscInt nodes, const PetscReal X[], const PetscReal xi[3])
{
  PetscReal dN[CELL_NODES][3];
  cell_reference_gradients(nodes, xi, dN);
  return cell_physical_gradients(nodes, X, dN);
}

/* At the nodes: of a hexahedron with straight edges the corners are the strictest place. A quadratic cell must have it
 * positive where it is evaluated, too. */
PetscReal cell_smallest_jacobian(PetscInt nodes, const PetscReal X[])
{
  PetscReal xi[3], smallest = PETSC_MAX_REAL;
  for (PetscInt a = 0; a < nodes; a++) {
    PetscReal determinant;
    cell_node_position(nodes, a, xi);
    determinant = jacobian(nodes, X, xi); /* once: PetscMin evaluates its arguments twice */
    smallest    = PetscMin(smallest, determinant);
  }
  for (PetscInt q = 0; q < cell_quadrature_points(nodes) && nodes > 8; q++) {
    PetscReal determinant;
    (void)cell_quadrature_point(nodes, q, xi);
    determinant = jacobian(nodes, X, xi);
    smallest    = PetscMin(smallest, determinant);
  }
  return smallest;
}
