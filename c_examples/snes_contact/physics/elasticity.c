/* Internal forces f_a = int P . dN_a/dX dV and stiffness K_ab = int dN_a/dX . A . dN_b/dX dV of cells of any kind, and the
 * consistent loads of their faces. Units: whatever the scene uses; forces are F, stresses F/L^2.
 *
 * Mean dilatation: the energy of a cell of reference volume V is int W0 dV + V U(m), where m is the cell's mean of v.
 * Then P = P0 + U'(m) dv/dH everywhere in the cell, and K gains U''(m) / V b b^T with b = int dv/dH . dN/dX dV: a
 * symmetric tangent, one condition on the volume per hexahedron instead of eight (with v = J - 1 this is the mean
 * dilatation of Nagtegaal, Parks and Rice, Comput. Methods Appl. Mech. Engrg 4, 1974). A tet4 has one Gauss point:
 * there it changes nothing. */
#include "physics/elasticity.h"

static void displacement_gradient(PetscInt nodes, PetscReal dN[][3], const PetscReal u[], PetscReal H[9])
{
  for (int k = 0; k < 9; k++)
    H[k] = 0;
  for (PetscInt a = 0; a < nodes; a++) {
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++)
        H[3 * i + j] += u[3 * a + i] * dN[a][j];
    }
  }
}

/* One Gauss point: gradients of the shape functions, weight, strain */
typedef struct {
  PetscReal dN[CELL_NODES][3], weight, H[9];
} Point;

/* All points of the cell, their number, the mean of v and the volume; false where det F <= 0 at one. */
static PetscBool strains(PetscInt nodes, const Material *material, const PetscReal X[], const PetscReal u[],
                         Point points[], PetscInt *n, PetscReal *mean, PetscReal *whole)
{
  *n    = cell_quadrature_points(nodes);
  *mean = *whole = 0;
  for (PetscInt q = 0; q < *n; q++) {
    Point    *point = &points[q];
    PetscReal xi[3];
    point->weight = cell_quadrature_point(nodes, q, xi);
    cell_reference_gradients(nodes, xi, point->dN);
    point->weight *= cell_physical_gradients(nodes, X, point->dN);
    displacement_gradient(nodes, point->dN, u, point->H);
    if (material->law->finite && !(volume_ratio_minus_one(point->H) > -1)) return PETSC_FALSE;
    *mean += point->weight * material->law->volume(point->H);
    *whole += point->weight;
  }
  *mean /= *whole;
  return PETSC_TRUE;
}

/* K += weight dN_a . A . dN_b */
static void add_stiffness(PetscInt nodes, const Point *point, const PetscReal A[81], PetscReal K[])
{
  const PetscInt   n = 3 * nodes;
  const PetscReal(*dN)[3] = point->dN;
  PetscReal AdN[9][3 * CELL_NODES];
  for (int iJ = 0; iJ < 9; iJ++) {
    for (PetscInt b = 0; b < nodes; b++) {
      for (int k = 0; k < 3; k++)
        AdN[iJ][3 * b + k] = point->weight * (A[9 * iJ + 3 * k] * dN[b][0] + A[9 * iJ + 3 * k + 1] * dN[b][1] +
                                              A[9 * iJ + 3 * k + 2] * dN[b][2]);
    }
  }
  for (PetscInt a = 0; a < nodes; a++) {
    for (int i = 0; i < 3; i++) {
      for (PetscInt kb = 0; kb < n; kb++)
        K[n * (3 * a + i) + kb] += dN[a][0] * AdN[3 * i][kb] + dN[a][1] * AdN[3 * i + 1][kb] +
                                   dN[a][2] * AdN[3 * i + 2][kb];
    }
  }
}

/* f += weight P . dN_a */
static void add_forces(PetscInt nodes, const Point *point, const PetscReal P[9], PetscReal f[])
{
  for (PetscInt a = 0; a < nodes; a++) {
    const PetscReal *dN = point->dN[a];
    for (int i = 0; i < 3; i++)
      f[3 * a + i] += point->weight * (P[3 * i] * dN[0] + P[3 * i + 1] * dN[1] + P[3 * i + 2] * dN[2]);
  }
}

PetscErrorCode cell_forces(PetscInt nodes, const Material *material, const PetscReal X[], const PetscReal u[],
                           PetscReal f[], PetscReal K[], PetscBool *inverted)
{
  const PetscInt  n       = 3 * nodes;
  const PetscBool is_mean = material->mean_dilatation;
  Point           points[CELL_POINTS];
  PetscInt        n_points;
  PetscReal       P[9], V[9], A[81], b[3 * CELL_NODES] = {0}, mean, whole, p, dp;

  PetscFunctionBeginHot;
  PetscCall(PetscArrayzero(f, n));
  if (K) PetscCall(PetscArrayzero(K, n * n));
  *inverted = (PetscBool)!strains(nodes, material, X, u, points, &n_points, &mean, &whole);
  if (*inverted) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt q = 0; q < n_points; q++) {
    const Point *point = &points[q];
    material->law->pressure(material, is_mean ? mean : material->law->volume(point->H), &p, &dp);
    material->law->stress(material, point->H, p, is_mean ? 0 : dp, P, V, K ? A : NULL);
    add_forces(nodes, point, P, f);
    if (!K) continue;
    add_stiffness(nodes, point, A, K);
    if (is_mean) add_forces(nodes, point, V, b);
  }
  for (PetscInt ai = 0; ai < n && K && is_mean; ai++) {
    for (PetscInt bk = 0; bk < n; bk++)
      K[n * ai + bk] += dp / whole * b[ai] * b[bk];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void cell_centre_gradient(PetscInt nodes, const PetscReal X[], const PetscReal u[], PetscReal H[9])
{
  PetscReal centre[3], dN[CELL_NODES][3];
  cell_centre(nodes, centre);
  cell_reference_gradients(nodes, centre, dN);
  cell_physical_gradients(nodes, X, dN);
  displacement_gradient(nodes, dN, u, H);
}

void cell_centre_stress(PetscInt nodes, const Material *material, const PetscReal X[], const PetscReal u[],
                        PetscReal sigma[9])
{
  Point     points[CELL_POINTS];
  PetscInt  n_points;
  PetscReal H[9], P[9], V[9], mean, whole, p, dp;
  cell_centre_gradient(nodes, X, u, H);
  for (int k = 0; k < 9; k++)
    sigma[k] = 0;
  if (!strains(nodes, material, X, u, points, &n_points, &mean, &whole)) return;
  if (material->law->finite && !(volume_ratio_minus_one(H) > -1)) return;
  material->law->pressure(material, material->mean_dilatation ? mean : material->law->volume(H), &p, &dp);
  material->law->stress(material, H, p, dp, P, V, NULL);
  cauchy_stress(material, H, P, sigma);
}

void face_forces(PetscInt nodes, const PetscReal X[], const PetscReal traction[3], PetscReal pressure, PetscReal f[])
{
  for (PetscInt k = 0; k < 3 * nodes; k++)
    f[k] = 0;
  for (PetscInt q = 0; q < face_quadrature_points(nodes); q++) {
    PetscReal       N[FACE_NODES], d[FACE_NODES][2], xi[2], tangent[2][3] = {{0}}, normal[3], area;
    const PetscReal weight = face_quadrature_point(nodes, q, xi);
    face_functions(nodes, xi, N, d);
    for (PetscInt a = 0; a < nodes; a++) {
      for (int i = 0; i < 3; i++) {
        tangent[0][i] += d[a][0] * X[3 * a + i];
        tangent[1][i] += d[a][1] * X[3 * a + i];
      }
    }
    for (int i = 0; i < 3; i++)
      normal[i] = tangent[0][(i + 1) % 3] * tangent[1][(i + 2) % 3] - tangent[0][(i + 2) % 3] * tangent[1][(i + 1) % 3];
    area = PetscSqrtReal(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (PetscInt a = 0; a < nodes; a++) {
      for (int i = 0; i < 3; i++)
        f[3 * a + i] += weight * N[a] * (traction[i] * area - pressure * normal[i]);
    }
  }
}
