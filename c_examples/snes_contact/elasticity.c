/* Internal forces f_a = int P . dN_a/dX dV and stiffness K_ab = int dN_a/dX . A . dN_b/dX dV of hex8 and tet4, and the
 * consistent loads of their faces. Units: whatever the scene uses; forces are F, stresses F/L^2. */
#include "elasticity.h"

#define MAX_CORNERS 8

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

void linear_elastic(const Material *material, const PetscReal H[9], PetscReal P[9], PetscReal A[81])
{
  const PetscReal E = material->young, nu = material->poisson;
  const PetscReal lame = E * nu / ((1 + nu) * (1 - 2 * nu)), shear = E / (2 * (1 + nu)), trace = H[0] + H[4] + H[8];
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      P[3 * i + j] = shear * (H[3 * i + j] + H[3 * j + i]) + (i == j) * lame * trace;
  }
  if (!A) return;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++)
          A[9 * (3 * i + j) + 3 * k + l] = (i == j && k == l) * lame +
                                           ((i == k && j == l) + (i == l && j == k)) * shear;
      }
    }
  }
}

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

PetscErrorCode cell_forces(PetscInt corners, const Material *material, const PetscReal X[], const PetscReal u[],
                           PetscReal f[], PetscReal K[])
{
  const PetscInt n = 3 * corners, n_points = corners == 4 ? 1 : 8;
  PetscReal      dN[MAX_CORNERS][3], xi[3], H[9], P[9], A[81], AdN[9][3 * MAX_CORNERS];

  PetscFunctionBeginHot;
  PetscCall(PetscArrayzero(f, n));
  if (K) PetscCall(PetscArrayzero(K, n * n));
  for (PetscInt q = 0; q < n_points; q++) {
    PetscReal weight = quadrature_point(corners, q, xi);
    reference_gradients(corners, xi, dN);
    weight *= physical_gradients(corners, X, dN);
    displacement_gradient(corners, dN, u, H);
    material->law(material, H, P, K ? A : NULL);
    for (PetscInt a = 0; a < corners; a++) {
      for (int i = 0; i < 3; i++)
        f[3 * a + i] += weight * (P[3 * i] * dN[a][0] + P[3 * i + 1] * dN[a][1] + P[3 * i + 2] * dN[a][2]);
    }
    if (!K) continue;
    for (int iJ = 0; iJ < 9; iJ++) {
      for (PetscInt b = 0; b < corners; b++) {
        for (int k = 0; k < 3; k++)
          AdN[iJ][3 * b + k] = weight * (A[9 * iJ + 3 * k] * dN[b][0] + A[9 * iJ + 3 * k + 1] * dN[b][1] +
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
  PetscFunctionReturn(PETSC_SUCCESS);
}

void cell_centre_stress(PetscInt corners, const Material *material, const PetscReal X[], const PetscReal u[],
                        PetscReal P[9])
{
  const PetscReal centre[3] = {0, 0, 0}; /* of the hexahedron; gradients of a tet are the same everywhere */
  PetscReal       dN[MAX_CORNERS][3], H[9];
  reference_gradients(corners, centre, dN);
  physical_gradients(corners, X, dN);
  displacement_gradient(corners, dN, u, H);
  material->law(material, H, P, NULL);
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
