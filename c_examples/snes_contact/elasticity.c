/* Internal forces f_a = int P . dN_a/dX dV and stiffness K_ab = int dN_a/dX . A . dN_b/dX dV of hex8 and tet4, and the
 * consistent loads of their faces. Units: whatever the scene uses; forces are F, stresses F/L^2.
 *
 * Mean dilatation: the energy of a cell of reference volume V is int W0 dV + V U(m), where m is the cell's mean of v.
 * Then P = P0 + U'(m) dv/dH everywhere in the cell, and K gains U''(m) / V b b^T with b = int dv/dH . dN/dX dV: a
 * symmetric tangent, one condition on the volume per hexahedron instead of eight (with v = J - 1 this is the mean
 * dilatation of Nagtegaal, Parks and Rice, Comput. Methods Appl. Mech. Engrg 4, 1974). A tetrahedron has one Gauss
 * point: there it changes nothing. */
#include "elasticity.h"

#define MAX_CORNERS 8
#define MAX_POINTS  8

static const PetscReal GAUSS = 0.57735026918962576451; /* 1/sqrt(3) */
/* corners of the reference hexahedron [-1,1]^3 in VTK's order */
static const PetscReal HEX[8][3] = {
    {-1, -1, -1},
    {1,  -1, -1},
    {1,  1,  -1},
    {-1, 1,  -1},
    {-1, -1, 1 },
    {1,  -1, 1 },
    {1,  1,  1 },
    {-1, 1,  1 }
};

/* dN/dxi of all corners at a reference point */
static void reference_gradients(PetscInt corners, const PetscReal xi[3], PetscReal dN[][3])
{
  if (corners == 4) {
    for (int k = 0; k < 3; k++) {
      dN[0][k] = -1;
      for (int a = 1; a < 4; a++)
        dN[a][k] = (a - 1 == k);
    }
    return;
  }
  for (int a = 0; a < 8; a++) {
    const PetscReal s = 1 + HEX[a][0] * xi[0], t = 1 + HEX[a][1] * xi[1], r = 1 + HEX[a][2] * xi[2];
    dN[a][0] = 0.125 * HEX[a][0] * t * r;
    dN[a][1] = 0.125 * HEX[a][1] * s * r;
    dN[a][2] = 0.125 * HEX[a][2] * s * t;
  }
}

/* dN/dxi -> dN/dX in place; returns det dX/dxi */
static PetscReal physical_gradients(PetscInt corners, const PetscReal X[], PetscReal dN[][3])
{
  PetscReal J[3][3] = {{0}}, inverse[3][3], det;
  for (PetscInt a = 0; a < corners; a++) {
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
  for (PetscInt a = 0; a < corners; a++) {
    PetscReal g[3];
    for (int i = 0; i < 3; i++)
      g[i] = (dN[a][0] * inverse[0][i] + dN[a][1] * inverse[1][i] + dN[a][2] * inverse[2][i]) / det;
    for (int i = 0; i < 3; i++)
      dN[a][i] = g[i];
  }
  return det;
}

static void displacement_gradient(PetscInt corners, PetscReal dN[][3], const PetscReal u[], PetscReal H[9])
{
  for (int k = 0; k < 9; k++)
    H[k] = 0;
  for (PetscInt a = 0; a < corners; a++) {
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++)
        H[3 * i + j] += u[3 * a + i] * dN[a][j];
    }
  }
}

/* Gauss point q of the cell; returns its weight. One point suffices for the constant gradients of a tet4. */
static PetscReal quadrature_point(PetscInt corners, PetscInt q, PetscReal xi[3])
{
  for (int k = 0; k < 3; k++)
    xi[k] = corners == 4 ? 0.25 : GAUSS * HEX[q][k];
  return corners == 4 ? 1.0 / 6 : 1.0;
}

/* One Gauss point: gradients of the shape functions, weight, strain */
typedef struct {
  PetscReal dN[MAX_CORNERS][3], weight, H[9];
} Point;

/* All points of the cell, their number, the mean of v and the volume; false where det F <= 0 at one. */
static PetscBool strains(PetscInt corners, const Material *material, const PetscReal X[], const PetscReal u[],
                         Point points[], PetscInt *n, PetscReal *mean, PetscReal *whole)
{
  *n    = corners == 4 ? 1 : 8;
  *mean = *whole = 0;
  for (PetscInt q = 0; q < *n; q++) {
    Point    *point = &points[q];
    PetscReal xi[3];
    point->weight = quadrature_point(corners, q, xi);
    reference_gradients(corners, xi, point->dN);
    point->weight *= physical_gradients(corners, X, point->dN);
    displacement_gradient(corners, point->dN, u, point->H);
    if (material->law->finite && !(volume_ratio_minus_one(point->H) > -1)) return PETSC_FALSE;
    *mean += point->weight * material->law->volume(point->H);
    *whole += point->weight;
  }
  *mean /= *whole;
  return PETSC_TRUE;
}

/* K += weight dN_a . A . dN_b */
static void add_stiffness(PetscInt corners, const Point *point, const PetscReal A[81], PetscReal K[])
{
  const PetscInt   n = 3 * corners;
  const PetscReal(*dN)[3] = point->dN;
  PetscReal AdN[9][3 * MAX_CORNERS];
  for (int iJ = 0; iJ < 9; iJ++) {
    for (PetscInt b = 0; b < corners; b++) {
      for (int k = 0; k < 3; k++)
        AdN[iJ][3 * b + k] = point->weight * (A[9 * iJ + 3 * k] * dN[b][0] + A[9 * iJ + 3 * k + 1] * dN[b][1] +
                                              A[9 * iJ + 3 * k + 2] * dN[b][2]);
    }
  }
  for (PetscInt a = 0; a < corners; a++) {
    for (int i = 0; i < 3; i++) {
      for (PetscInt kb = 0; kb < n; kb++)
        K[n * (3 * a + i) + kb] += dN[a][0] * AdN[3 * i][kb] + dN[a][1] * AdN[3 * i + 1][kb] +
                                   dN[a][2] * AdN[3 * i + 2][kb];
    }
  }
}

/* f += weight P . dN_a */
static void add_forces(PetscInt corners, const Point *point, const PetscReal P[9], PetscReal f[])
{
  for (PetscInt a = 0; a < corners; a++) {
    const PetscReal *dN = point->dN[a];
    for (int i = 0; i < 3; i++)
      f[3 * a + i] += point->weight * (P[3 * i] * dN[0] + P[3 * i + 1] * dN[1] + P[3 * i + 2] * dN[2]);
  }
}

PetscErrorCode cell_forces(PetscInt corners, const Material *material, const PetscReal X[], const PetscReal u[],
                           PetscReal f[], PetscReal K[], PetscBool *inverted)
{
  const PetscInt  n       = 3 * corners;
  const PetscBool is_mean = material->mean_dilatation;
  Point           points[MAX_POINTS];
  PetscInt        n_points;
  PetscReal       P[9], V[9], A[81], b[3 * MAX_CORNERS] = {0}, mean, whole, p, dp;

  PetscFunctionBeginHot;
  PetscCall(PetscArrayzero(f, n));
  if (K) PetscCall(PetscArrayzero(K, n * n));
  *inverted = (PetscBool)!strains(corners, material, X, u, points, &n_points, &mean, &whole);
  if (*inverted) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt q = 0; q < n_points; q++) {
    const Point *point = &points[q];
    material->law->pressure(material, is_mean ? mean : material->law->volume(point->H), &p, &dp);
    material->law->stress(material, point->H, p, is_mean ? 0 : dp, P, V, K ? A : NULL);
    add_forces(corners, point, P, f);
    if (!K) continue;
    add_stiffness(corners, point, A, K);
    if (is_mean) add_forces(corners, point, V, b);
  }
  for (PetscInt ai = 0; ai < n && K && is_mean; ai++) {
    for (PetscInt bk = 0; bk < n; bk++)
      K[n * ai + bk] += dp / whole * b[ai] * b[bk];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void cell_centre_gradient(PetscInt corners, const PetscReal X[], const PetscReal u[], PetscReal H[9])
{
  const PetscReal centre[3] = {0, 0, 0}; /* of the hexahedron; gradients of a tet are the same everywhere */
  PetscReal       dN[MAX_CORNERS][3];
  reference_gradients(corners, centre, dN);
  physical_gradients(corners, X, dN);
  displacement_gradient(corners, dN, u, H);
}

void cell_centre_stress(PetscInt corners, const Material *material, const PetscReal X[], const PetscReal u[],
                        PetscReal sigma[9])
{
  Point     points[MAX_POINTS];
  PetscInt  n_points;
  PetscReal H[9], P[9], V[9], mean, whole, p, dp;
  cell_centre_gradient(corners, X, u, H);
  for (int k = 0; k < 9; k++)
    sigma[k] = 0;
  if (!strains(corners, material, X, u, points, &n_points, &mean, &whole)) return;
  if (material->law->finite && !(volume_ratio_minus_one(H) > -1)) return;
  material->law->pressure(material, material->mean_dilatation ? mean : material->law->volume(H), &p, &dp);
  material->law->stress(material, H, p, dp, P, V, NULL);
  cauchy_stress(material, H, P, sigma);
}

PetscReal cell_smallest_jacobian(PetscInt corners, const PetscReal X[])
{
  PetscReal dN[MAX_CORNERS][3], smallest = PETSC_MAX_REAL;
  for (PetscInt a = 0; a < corners; a++) { /* at the corners: the strictest place */
    const PetscReal origin[3] = {0, 0, 0};
    PetscReal       determinant;
    reference_gradients(corners, corners == 8 ? HEX[a] : origin, dN);
    determinant = physical_gradients(corners, X, dN); /* once: PetscMin evaluates its arguments twice */
    smallest    = PetscMin(smallest, determinant);
  }
  return smallest;
}

void face_forces(PetscInt corners, const PetscReal X[], const PetscReal traction[3], PetscReal pressure, PetscReal f[])
{
  const PetscInt n_points = corners == 3 ? 1 : 4; /* linear shape functions on a flat triangle: its centre is exact */
  for (PetscInt k = 0; k < 3 * corners; k++)
    f[k] = 0;
  for (PetscInt q = 0; q < n_points; q++) {
    PetscReal N[4], d[4][2], tangent[2][3] = {{0}}, normal[3], area, weight = 1;
    if (corners == 3) {
      weight = 0.5;
      for (int a = 0; a < 3; a++) {
        N[a]    = 1.0 / 3;
        d[a][0] = a == 0 ? -1 : (a == 1);
        d[a][1] = a == 0 ? -1 : (a == 2);
      }
    } else {
      for (int a = 0; a < 4; a++) { /* the lower four corners of the reference hexahedron are its quadrilateral */
        const PetscReal s = 1 + HEX[a][0] * GAUSS * HEX[q][0], t = 1 + HEX[a][1] * GAUSS * HEX[q][1];
        N[a]    = 0.25 * s * t;
        d[a][0] = 0.25 * HEX[a][0] * t;
        d[a][1] = 0.25 * HEX[a][1] * s;
      }
    }
    for (PetscInt a = 0; a < corners; a++) {
      for (int i = 0; i < 3; i++) {
        tangent[0][i] += d[a][0] * X[3 * a + i];
        tangent[1][i] += d[a][1] * X[3 * a + i];
      }
    }
    for (int i = 0; i < 3; i++)
      normal[i] = tangent[0][(i + 1) % 3] * tangent[1][(i + 2) % 3] - tangent[0][(i + 2) % 3] * tangent[1][(i + 1) % 3];
    area = PetscSqrtReal(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (PetscInt a = 0; a < corners; a++) {
      for (int i = 0; i < 3; i++)
        f[3 * a + i] += weight * N[a] * (traction[i] * area - pressure * normal[i]);
    }
  }
}
