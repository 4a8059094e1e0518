/* Shape functions of hex8 and tet4. */
#include "mesh/cell.h"

const PetscReal CELL_HEX[8][3] = {
    {-1, -1, -1},
    {1,  -1, -1},
    {1,  1,  -1},
    {-1, 1,  -1},
    {-1, -1, 1 },
    {1,  -1, 1 },
    {1,  1,  1 },
    {-1, 1,  1 }
};

void cell_reference_gradients(PetscInt corners, const PetscReal xi[3], PetscReal dN[][3])
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
    const PetscReal s = 1 + CELL_HEX[a][0] * xi[0], t = 1 + CELL_HEX[a][1] * xi[1], r = 1 + CELL_HEX[a][2] * xi[2];
    dN[a][0] = 0.125 * CELL_HEX[a][0] * t * r;
    dN[a][1] = 0.125 * CELL_HEX[a][1] * s * r;
    dN[a][2] = 0.125 * CELL_HEX[a][2] * s * t;
  }
}

PetscReal cell_physical_gradients(PetscInt corners, const PetscReal X[], PetscReal dN[][3])
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

PetscReal cell_quadrature_point(PetscInt corners, PetscInt q, PetscReal xi[3])
{
  for (int k = 0; k < 3; k++)
    xi[k] = corners == 4 ? 0.25 : CELL_GAUSS * CELL_HEX[q][k];
  return corners == 4 ? 1.0 / 6 : 1.0;
}

PetscReal cell_smallest_jacobian(PetscInt corners, const PetscReal X[])
{
  PetscReal dN[CELL_CORNERS][3], smallest = PETSC_MAX_REAL;
  for (PetscInt a = 0; a < corners; a++) { /* at the corners: the strictest place */
    const PetscReal origin[3] = {0, 0, 0};
    PetscReal       determinant;
    cell_reference_gradients(corners, corners == 8 ? CELL_HEX[a] : origin, dN);
    determinant = cell_physical_gradients(corners, X, dN); /* once: PetscMin evaluates its arguments twice */
    smallest    = PetscMin(smallest, determinant);
  }
  return smallest;
}
