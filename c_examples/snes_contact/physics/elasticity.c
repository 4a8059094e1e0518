/* Internal forces f_a = int P : dH/du_a dV and stiffness K_ab = int dH/du_a : A : dH/du_b dV of cells of any kind. H = du/dX, so that dH/du_a is dN_a/dX; in a ring the strain around, H_33 = u_r / r, adds
 * N_a / r. dV has the thickness, or 2 pi r. Units: whatever the scene uses; forces are F, stresses F/L^2.
 *
 * Mean dilatation: the energy of a cell of reference volume V is int W0 dV + V U(m), where m is the cell's mean of v.
 * Then P = P0 + U'(m) dv/dH everywhere in the cell, and K gains U''(m) / V b b^T with b = int dv/dH : dH/du dV: a
 * symmetric tangent, one condition on the volume per hexahedron instead of eight (with v = J - 1 this is the mean
 * dilatation of Nagtegaal, Parks and Rice, Comput. Methods Appl. Mech. Engrg 4, 1974). A tet4 has one Gauss point:
 * there it changes nothing. */
#include "physics/elasticity.h"

/* One point of a cell: gradients of the shape functions, in a ring N / r; weight, strain */
typedef struct {
  PetscReal dN[CELL_NODES][3], around[CELL_NODES], weight, H[9];
} Point;

/* The gradients and the measure there, without the weight of a Gauss point, and the strain of u; false: the law has no
 * stress there. */
static PetscBool strain(CellKind kind, const Space *space, const Material *material, const PetscReal X[],
                        const PetscReal u[], const PetscReal xi[3], Point *point)
{
  const PetscInt nodes = cell_nodes(kind);
  PetscReal      N[CELL_NODES], r = 0;
  cell_functions(kind, xi, N, point->dN);
  point->weight = cell_physical_gradients(kind, X, point->dN);
  for (int k = 0; k < 9; k++)
    point->H[k] = 0;
  for (PetscInt a = 0; a < nodes; a++) {
    r += N[a] * X[3 * a];
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++)
        point->H[3 * i + j] += u[3 * a + i] * point->dN[a][j];
    }
  }
  point->weight *= space_measure(space, r);
  for (PetscInt a = 0; a < nodes && space->kind == SPACE_AXISYMMETRIC; a++) {
    point->around[a] = r == 0 ? 0 : N[a] / r; /* only in the frame of an analytic body, which has no stiffness */
    point->H[8] += u[3 * a] * point->around[a];
  }
  if (space->kind == SPACE_PLANE_STRESS && !plane_stress_stretch(material, point->H)) return PETSC_FALSE;
  return (PetscBool)(!material->law->finite || volume_ratio_minus_one(point->H) > -1);
}

/* All points of the cell, their number, the mean of v and the volume; false where the law has no stress at one. */
static PetscBool strains(CellKind kind, const Space *space, const Material *material, const PetscReal X[],
                         const PetscReal u[], Point points[], PetscInt *n, PetscReal *mean, PetscReal *whole)
{
  *n    = cell_quadrature_points(kind);
  *mean = *whole = 0;
  for (PetscInt q = 0; q < *n; q++) {
    PetscReal       xi[3];
    const PetscReal weight = cell_quadrature_point(kind, q, xi);
    if (!strain(kind, space, material, X, u, xi, &points[q])) return PETSC_FALSE;
    points[q].weight *= weight;
    *mean += points[q].weight * material->law->volume(points[q].H);
    *whole += points[q].weight;
  }
  *mean /= *whole;
  return PETSC_TRUE;
}

/* K += weight dH/du_a : A : dH/du_b */
static void add_stiffness(PetscInt nodes, PetscBool ring, const Point *point, const PetscReal A[81], PetscReal K[])
{
  const PetscInt   n = 3 * nodes;
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

/* f += weight P : dH/du */
static void add_forces(PetscInt nodes, PetscBool ring, const Point *point, const PetscReal P[9], PetscReal f[])
{
  for (PetscInt a = 0; a < nodes; a++) {
    const PetscReal *dN = point->dN[a];
    for (int i = 0; i < 3; i++)
      f[3 * a + i] += point->weight * (P[3 * i] * dN[0] + P[3 * i + 1] * dN[1] + P[3 * i + 2] * dN[2]);
    if (ring) f[3 * a] += point->weight * P[8] * point->around[a];
  }
}

PetscErrorCode cell_forces(CellKind kind, const Space *space, const Material *material, const PetscReal X[],
                           const PetscReal u[], PetscReal f[], PetscReal K[], PetscBool *inverted)
{
  const PetscInt  nodes = cell_nodes(kind), n = 3 * nodes;
  const PetscBool is_mean = material->mean_dilatation, ring = (PetscBool)(space->kind == SPACE_AXISYMMETRIC);
  Point           points[CELL_POINTS];
  PetscInt        n_points;
  PetscReal       P[9], V[9], A[81], b[3 * CELL_NODES] = {0}, mean, whole, p, dp;

  PetscFunctionBeginHot;
  PetscCall(PetscArrayzero(f, n));
  if (K) PetscCall(PetscArrayzero(K, n * n));
  *inverted = (PetscBool)!strains(kind, space, material, X, u, points, &n_points, &mean, &whole);
  if (*inverted) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt q = 0; q < n_points; q++) {
    const Point *point = &points[q];
    material->law->pressure(material, is_mean ? mean : material->law->volume(point->H), &p, &dp);
    material->law->stress(material, point->H, p, is_mean ? 0 : dp, P, V, K ? A : NULL);
    add_forces(nodes, ring, point, P, f);
    if (!K) continue;
    if (space->kind == SPACE_PLANE_STRESS) plane_stress_condense(A);
    add_stiffness(nodes, ring, point, A, K);
    if (is_mean) add_forces(nodes, ring, point, V, b);
  }
  for (PetscInt ai = 0; ai < n && K && is_mean; ai++) {
    for (PetscInt bk = 0; bk < n; bk++)
      K[n * ai + bk] += dp / whole * b[ai] * b[bk];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal cell_energy(CellKind kind, const Space *space, const Material *material, const PetscReal X[], const PetscReal u[])
{
  const PetscBool is_mean = material->mean_dilatation;
  Point           points[CELL_POINTS];
  PetscInt        n_points;
  PetscReal       mean, whole, energy = 0;
  if (!strains(kind, space, material, X, u, points, &n_points, &mean, &whole)) return PETSC_INFINITY;
  for (PetscInt q = 0; q < n_points; q++)
    energy += points[q].weight * material->law->energy(material, points[q].H, is_mean ? mean : material->law->volume(points[q].H));
  return energy;
}

void cell_centre_gradient(CellKind kind, const Space *space, const Material *material, const PetscReal X[],
                          const PetscReal u[], PetscReal H[9])
{
  PetscReal centre[3];
  Point     point;
  cell_centre(kind, centre);
  (void)strain(kind, space, material, X, u, centre, &point);
  for (int k = 0; k < 9; k++)
    H[k] = point.H[k];
}

void cell_stresses(CellKind kind, const Space *space, const Material *material, const PetscReal X[], const PetscReal u[],
                   PetscInt n, const PetscReal xi[], PetscReal sigma[])
{
  Point     points[CELL_POINTS];
  PetscInt  n_points;
  PetscReal P[9], V[9], mean, whole, p, dp;
  for (PetscInt k = 0; k < 9 * n; k++)
    sigma[k] = 0;
  if (!strains(kind, space, material, X, u, points, &n_points, &mean, &whole)) return;
  for (PetscInt k = 0; k < n; k++) {
    Point point;
    if (!strain(kind, space, material, X, u, xi + 3 * k, &point)) continue;
    material->law->pressure(material, material->mean_dilatation ? mean : material->law->volume(point.H), &p, &dp);
    material->law->stress(material, point.H, p, dp, P, V, NULL);
    cauchy_stress(material, point.H, P, sigma + 9 * k);
  }
}
