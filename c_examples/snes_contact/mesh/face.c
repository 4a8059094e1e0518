/* Shape functions and Gauss points of faces. */
#include "mesh/cell.h"

/* Of a tri6: six points, for polynomials of degree 4, such as a function times the normal of a curved face: two orbits of
 * points (a, a, 1 - 2 a) with their weights (D. A. Dunavant, Int. J. Numer. Meth. Engng 21, 1985). */
static const PetscReal TRI6_PLACES[2]  = {0.44594849091596488632, 0.09157621350977074346};
static const PetscReal TRI6_WEIGHTS[2] = {0.22338158967801146570, 0.10995174365532186764};

PetscInt face_quadrature_points(PetscInt nodes)
{
  return nodes == 3 ? 1 : nodes == 4 ? 4 : nodes == 6 ? 6 : 9;
}

PetscReal face_quadrature_point(PetscInt nodes, PetscInt q, PetscReal xi[2])
{
  PetscReal weight = 1;
  if (nodes == 3) { /* linear functions on a flat triangle: its centre is exact */
    xi[0] = xi[1] = 1.0 / 3;
    return 0.5;
  }
  if (nodes == 6) {
    const PetscReal a = TRI6_PLACES[q / 3];
    for (int k = 0; k < 2; k++)
      xi[k] = q % 3 == k ? 1 - 2 * a : a;
    return 0.5 * TRI6_WEIGHTS[q / 3];
  }
  for (int k = 0; k < 2; k++) {
    if (nodes == 4) {
      xi[k] = CELL_GAUSS * CELL_HEX[q][k];
    } else {
      const PetscInt place = k ? q / 3 - 1 : q % 3 - 1;
      xi[k] = CELL_GAUSS_3 * place;
      weight *= (place == 0 ? 8.0 : 5.0) / 9;
    }
  }
  return weight;
}

static void tri6_functions(const PetscReal xi[2], PetscReal N[], PetscReal d[][2])
{
  const PetscReal L[3] = {1 - xi[0] - xi[1], xi[0], xi[1]};
  for (PetscInt node = 0; node < 6; node++) {
    PetscInt       c[4];
    const PetscInt n = face_node_corners(6, node, c);
    N[node] = n == 1 ? L[c[0]] * (2 * L[c[0]] - 1) : 4 * L[c[0]] * L[c[1]];
    for (int k = 0; k < 2; k++) {
      const PetscReal da = c[0] ? c[0] - 1 == k : -1, db = n == 1 ? 0 : c[1] ? c[1] - 1 == k : -1;
      d[node][k] = n == 1 ? (4 * L[c[0]] - 1) * da : 4 * (L[c[0]] * db + da * L[c[1]]);
    }
  }
}

/* where a node of a quad8 or quad9 lies: the lower four corners of the reference hexahedron are its quadrilateral */
static void quad_place(PetscInt nodes, PetscInt node, PetscReal p[2])
{
  PetscInt       c[4];
  const PetscInt n = face_node_corners(nodes, node, c);
  p[0] = p[1] = 0;
  for (PetscInt k = 0; k < n; k++) {
    p[0] += CELL_HEX[c[k]][0] / (PetscReal)n;
    p[1] += CELL_HEX[c[k]][1] / (PetscReal)n;
  }
}

static void quadratic_quad_functions(PetscInt nodes, const PetscReal xi[2], PetscReal N[], PetscReal d[][2])
{
  for (PetscInt node = 0; node < nodes; node++) {
    PetscReal  p[2], f[2], df[2], sum = -1;
    const int  corner = node < 4;
    quad_place(nodes, node, p);
    for (int k = 0; k < 2; k++) {
      const PetscReal x = xi[k];
      if (p[k] == 0) {
        f[k]  = 1 - x * x;
        df[k] = -2 * x;
      } else if (nodes == 9) {
        f[k]  = x * (x + p[k]) / 2;
        df[k] = x + p[k] / 2;
      } else {
        f[k]  = (1 + p[k] * x) / 2;
        df[k] = p[k] / 2;
      }
      sum += p[k] * x;
    }
    if (nodes == 9 || !corner) sum = 1;
    N[node] = f[0] * f[1] * sum;
    for (int k = 0; k < 2; k++)
      d[node][k] = f[1 - k] * (df[k] * sum + (nodes == 8 && corner ? f[k] * p[k] : 0));
  }
}

void face_functions(PetscInt nodes, const PetscReal xi[2], PetscReal N[], PetscReal d[][2])
{
  if (nodes == 6) {
    tri6_functions(xi, N, d);
  } else if (nodes > 4) {
    quadratic_quad_functions(nodes, xi, N, d);
  } else if (nodes == 3) {
    for (int a = 0; a < 3; a++) {
      N[a]    = 1.0 / 3; /* at its only point */
      d[a][0] = a == 0 ? -1 : (a == 1);
      d[a][1] = a == 0 ? -1 : (a == 2);
    }
  } else {
    for (int a = 0; a < 4; a++) {
      const PetscReal s = 1 + CELL_HEX[a][0] * xi[0], t = 1 + CELL_HEX[a][1] * xi[1];
      N[a]    = 0.25 * s * t;
      d[a][0] = 0.25 * CELL_HEX[a][0] * t;
      d[a][1] = 0.25 * CELL_HEX[a][1] * s;
    }
  }
}
