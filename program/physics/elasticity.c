/* Internal forces f_a = int P : dH/du_a dV and stiffness K_ab = int dH/du_a : A : dH/du_b dV of cells of any kind. H = du/dX, so that dH/du_a is dN_a/dX; in a ring the strain around, H_33 = u_r / r, adds
 * N_a / r. dV has the thickness, or 2 pi r. Units: whatever the scene uses; forces are F, stresses F/L^2.
 *
 * Mean dilatation: the energy of a cell of reference volume V is int W0 dV + V U(m), where m is the cell's mean of v.
 * Then P = P0 + U'(m) dv/dH everywhere in the cell, and K gains U''(m) / V b b^T with b = int dv/dH : dH/du dV: a
 * symmetric tangent, one condition on the volume per hexahedron instead of eight (with v = J - 1 this is the mean
 * dilatation of Nagtegaal, Parks and Rice, Comput. Methods Appl. Mech. Engrg 4, 1974). A tet4 has one Gauss point:
 * there it changes nothing. */
#include "physics/cell_points.h"

PetscErrorCode cell_forces(const Element *element, const PetscReal u[], PetscReal f[], PetscReal K[], PetscBool *inverted)
{
  const Material *material = element->material;
  const PetscInt  n        = 3 * cell_nodes(element->kind);
  const PetscBool is_mean  = material->mean_dilatation;
  Point           points[CELL_POINTS];
  PetscInt        n_points;
  PetscReal       P[9], V[9], A[81], b[3 * CELL_NODES] = {0}, mean, whole, p, dp;

  PetscFunctionBeginHot;
  PetscCall(PetscArrayzero(f, n));
  if (K) PetscCall(PetscArrayzero(K, n * n));
  *inverted = (PetscBool)!cell_points(element, u, points, &n_points, &mean, &whole);
  if (*inverted) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt q = 0; q < n_points; q++) {
    const Point *point = &points[q];
    material->law->pressure(material, is_mean ? mean : material->law->volume(point->H), &p, &dp);
    material->law->stress(material, point->H, p, is_mean ? 0 : dp, P, V, K ? A : NULL);
    point_add_forces(element, point, P, f);
    if (!K) continue;
    if (element->space->kind == SPACE_PLANE_STRESS) plane_stress_condense(A);
    point_add_stiffness(element, point, A, K);
    if (is_mean) point_add_forces(element, point, V, b);
  }
  for (PetscInt ai = 0; ai < n && K && is_mean; ai++) {
    for (PetscInt bk = 0; bk < n; bk++)
      K[n * ai + bk] += dp / whole * b[ai] * b[bk];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal cell_energy(const Element *element, const PetscReal u[])
{
  const Material *material = element->material;
  Point           points[CELL_POINTS];
  PetscInt        n_points;
  PetscReal       mean, whole, energy = 0;
  if (!cell_points(element, u, points, &n_points, &mean, &whole)) return PETSC_INFINITY;
  for (PetscInt q = 0; q < n_points; q++)
    energy += points[q].weight *
              material->law->energy(material, points[q].H, material->mean_dilatation ? mean : material->law->volume(points[q].H));
  return energy;
}

void cell_centre_gradient(const Element *element, const PetscReal u[], PetscReal H[9])
{
  PetscReal centre[3];
  Point     point;
  cell_centre(element->kind, centre);
  (void)point_strain(element, u, centre, &point);
  for (int k = 0; k < 9; k++)
    H[k] = point.H[k];
}

void cell_stresses(const Element *element, const PetscReal u[], PetscInt n, const PetscReal xi[], PetscReal sigma[])
{
  const Material *material = element->material;
  Point           points[CELL_POINTS];
  PetscInt        n_points;
  PetscReal       P[9], V[9], mean, whole, p, dp;
  for (PetscInt k = 0; k < 9 * n; k++)
    sigma[k] = 0;
  if (!cell_points(element, u, points, &n_points, &mean, &whole)) return;
  for (PetscInt k = 0; k < n; k++) {
    Point point;
    if (!point_strain(element, u, xi + 3 * k, &point)) continue;
    material->law->pressure(material, material->mean_dilatation ? mean : material->law->volume(point.H), &p, &dp);
    material->law->stress(material, point.H, p, dp, P, V, NULL);
    cauchy_stress(material, point.H, P, sigma + 9 * k);
  }
}
