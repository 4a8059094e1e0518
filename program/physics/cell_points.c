/* Gradients, strains, forces and stiffness at the Gauss points of a cell.
 *
 * A warm body of finite strain grows by theta = 1 + alpha (T - T_0) where it is free: F = theta F_e. Its energy is that of F_e per volume that it
 * has without stress, theta^3 W(F_e), so that Cauchy's stress is that of F_e. With H_e = F_e - I for H, dN / theta for dN and theta^3 dV for dV
 * all formulas hold as they are. */
#include "physics/cell_points.h"

static PetscBool is_ring(const Element *element)
{
  return (PetscBool)(element->space->kind == SPACE_AXISYMMETRIC);
}

/* From the undeformed cell to the grown one. */
static void grow(const Element *element, const PetscReal N[], Point *point)
{
  const PetscInt nodes = cell_nodes(element->kind);
  PetscReal      theta;
  point->swell = 0;
  for (PetscInt a = 0; a < nodes && element->swell; a++)
    point->swell += N[a] * element->swell[a];
  if (point->swell == 0) return;
  theta = 1 + point->swell;
  point->weight *= theta * theta * theta;
  for (PetscInt a = 0; a < nodes; a++) {
    for (int i = 0; i < 3; i++)
      point->dN[a][i] /= theta;
    if (is_ring(element)) point->around[a] /= theta;
  }
}

void point_gradient(const Element *element, const Point *point, const PetscReal u[], PetscReal H[9])
{
  const PetscInt nodes = cell_nodes(element->kind);
  for (int k = 0; k < 9; k++)
    H[k] = 0;
  for (PetscInt a = 0; a < nodes; a++) {
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++)
        H[3 * i + j] += u[3 * a + i] * point->dN[a][j];
    }
  }
  for (PetscInt a = 0; a < nodes && is_ring(element); a++)
    H[8] += u[3 * a] * point->around[a];
}

PetscBool point_strain(const Element *element, const PetscReal u[], const PetscReal xi[3], Point *point)
{
  const PetscInt     nodes    = cell_nodes(element->kind);
  const MaterialLaw *law      = element->material->law;
  PetscReal          N[CELL_NODES], r = 0;
  cell_functions(element->kind, xi, N, point->dN);
  point->weight = cell_physical_gradients(element->kind, element->X, point->dN);
  for (PetscInt a = 0; a < nodes; a++)
    r += N[a] * element->X[3 * a];
  point->weight *= space_measure(element->space, r);
  for (PetscInt a = 0; a < nodes && is_ring(element); a++)
    point->around[a] = r == 0 ? 0 : N[a] / r; /* only in the frame of an analytic body, which has no stiffness */
  grow(element, N, point);
  if (point->swell <= -1) return PETSC_FALSE;
  point_gradient(element, point, u, point->H);
  for (int k = 0; k < 9 && point->swell != 0; k += 4)
    point->H[k] -= point->swell / (1 + point->swell);
  if (element->space->kind == SPACE_PLANE_STRESS && !plane_stress_stretch(element->material, point->H)) return PETSC_FALSE;
  return (PetscBool)(!law->finite || volume_ratio_minus_one(point->H) > -1);
}

PetscBool cell_points(const Element *element, const PetscReal u[], Point points[], PetscInt *n, PetscReal *mean, PetscReal *whole)
{
  *n    = cell_quadrature_points(element->kind);
  *mean = *whole = 0;
  for (PetscInt q = 0; q < *n; q++) {
    PetscReal       xi[3];
    const PetscReal weight = cell_quadrature_point(element->kind, q, xi);
    if (!point_strain(element, u, xi, &points[q])) return PETSC_FALSE;
    points[q].weight *= weight;
    *mean += points[q].weight * element->material->law->volume(points[q].H);
    *whole += points[q].weight;
  }
  *mean /= *whole;
  return PETSC_TRUE;
}

void point_add_stiffness(const Element *element, const Point *point, const PetscReal A[81], PetscReal K[])
{
  const PetscInt   nodes = cell_nodes(element->kind), n = 3 * nodes;
  const PetscBool  ring  = is_ring(element);
  const PetscReal(*dN)[3] = point->dN;
  PetscReal AdN[9][3 * CELL_NODES];
  for (int iJ = 0; iJ < 9; iJ++) {
    for (PetscInt b = 0; b < nodes; b++) {
      for (int k = 0; k < 3; k++)
        AdN[iJ][3 * b + k] = point->weight * (A[9 * iJ + 3 * k] * dN[b][0] + A[9 * iJ + 3 * k + 1] * dN[b][1] +
                                              A[9 * iJ + 3 * k + 2] * dN[b][2]);
      if (ring) AdN[iJ][3 * b] += point->weight * A[9 * iJ + 8] * point->around[b];
    }
  }
  for (PetscInt a = 0; a < nodes; a++) {
    for (int i = 0; i < 3; i++) {
      for (PetscInt kb = 0; kb < n; kb++)
        K[n * (3 * a + i) + kb] += dN[a][0] * AdN[3 * i][kb] + dN[a][1] * AdN[3 * i + 1][kb] +
                                   dN[a][2] * AdN[3 * i + 2][kb];
    }
    for (PetscInt kb = 0; kb < n && ring; kb++)
      K[n * 3 * a + kb] += point->around[a] * AdN[8][kb];
  }
}

void point_add_forces(const Element *element, const Point *point, const PetscReal P[9], PetscReal f[])
{
  for (PetscInt a = 0; a < cell_nodes(element->kind); a++) {
    const PetscReal *dN = point->dN[a];
    for (int i = 0; i < 3; i++)
      f[3 * a + i] += point->weight * (P[3 * i] * dN[0] + P[3 * i + 1] * dN[1] + P[3 * i + 2] * dN[2]);
    if (is_ring(element)) f[3 * a] += point->weight * P[8] * point->around[a];
  }
}
