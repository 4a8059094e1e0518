/* Forces of finite strain in a step of `dynamics`, from F to F' (a prime: its end), with the mean of the stresses between both strains:
 *
 *   P = F_a S,   S = mean of S(E + tau (E' - E)) over tau from 1 - 2 alpha_f to 1,   F_a = alpha_f F + (1 - alpha_f) F'.
 *
 * With alpha_f = 1/2 that is P : (F' - F) = S : (E' - E) = W' - W, so that the energy is kept whatever turns (J. C. Simo and N. Tarnow, ZAMP 43,
 * 1992). The moment is, because S is symmetric. dP/dF' is F_a (dS/dE') F' + (1 - alpha_f) S, which is not symmetric. The mean is Gauss's: of an S
 * that is linear in E one point is exact. With smaller alpha_f the scheme is one of second order as before, and the strains are not
 * those of the place between, where all that turns is shorter.
 *
 * Mean dilatation: W is that of the cell, so that p is of the cell's mean of v at each tau. Plane stress: E_33 is such that S_33 = 0, at each tau. */
#include "physics/elasticity_step.h"
#include <petscdt.h>

enum { MOST_MEANS = 6 };

/* Places tau and their weights; with mean dilatation p and dp there. */
typedef struct {
  PetscInt  n;
  PetscReal tau[MOST_MEANS], weight[MOST_MEANS], p[MOST_MEANS], dp[MOST_MEANS];
  PetscReal of_force[MOST_MEANS][3 * CELL_NODES], of_mean[MOST_MEANS][3 * CELL_NODES];
} Means;

/* E at a place; false: there is none in plane stress */
static PetscBool strain_at(const StepPoints *points, PetscInt q, PetscReal tau, PetscReal E[9])
{
  for (int k = 0; k < 9; k++)
    E[k] = points->start[q][k] + tau * (points->end[q][k] - points->start[q][k]);
  return (PetscBool)(points->element->space->kind != SPACE_PLANE_STRESS || plane_stress_strain(points->element->material, E));
}

/* Gauss's rule on [0, 1], worked once for each number of points */
typedef struct {
  PetscBool known;
  PetscReal place[MOST_MEANS], weight[MOST_MEANS];
} Rule;

static PetscErrorCode find_rule(PetscInt n, const Rule **rule)
{
  static Rule rules[MOST_MEANS + 1];
  PetscFunctionBeginHot;
  if (!rules[n].known) PetscCall(PetscDTGaussQuadrature(n, 0, 1, rules[n].place, rules[n].weight));
  rules[n].known = PETSC_TRUE;
  *rule          = &rules[n];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode set_means(const StepPoints *points, Means *means)
{
  const Material *material = points->element->material;
  const Rule     *rule     = NULL;
  PetscFunctionBeginHot;
  means->n = material->law->mean_points;
  PetscCall(find_rule(means->n, &rule));
  for (PetscInt k = 0; k < means->n; k++) {
    means->tau[k]    = 1 - 2 * points->step->alpha_f * (1 - rule->place[k]);
    means->weight[k] = rule->weight[k];
  }
  for (PetscInt k = 0; k < means->n && material->mean_dilatation; k++) {
    PetscReal mean = 0, E[9];
    for (PetscInt q = 0; q < points->n; q++) {
      (void)strain_at(points, q, means->tau[k], E);
      mean += points->after[q].weight / points->whole * material->law->volume_of_strain(E);
    }
    material->law->pressure(material, mean, &means->p[k], &means->dp[k]);
    PetscCall(PetscArrayzero(means->of_force[k], 3 * cell_nodes(points->element->kind)));
    PetscCall(PetscArrayzero(means->of_mean[k], 3 * cell_nodes(points->element->kind)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* S and, with K, tau D in the mean; false: there is none in plane stress */
static PetscBool mean_stress(const StepPoints *points, PetscInt q, Means *means, StepStress *stress, PetscBool K)
{
  const Material *material = points->element->material;
  const PetscBool is_mean  = material->mean_dilatation;
  for (PetscInt k = 0; k < means->n; k++) {
    PetscReal E[9], V[9], S[9], D[81], p = means->p[k], dp = 0;
    if (!strain_at(points, q, means->tau[k], E)) return PETSC_FALSE;
    if (!is_mean) material->law->pressure(material, material->law->volume_of_strain(E), &p, &dp);
    material->law->second_stress(material, E, p, dp, S, V, K ? D : NULL);
    for (int i = 0; i < 9; i++)
      stress->S[i] += means->weight[k] * S[i];
    if (!K) continue;
    if (points->element->space->kind == SPACE_PLANE_STRESS) plane_stress_condense(D);
    for (int i = 0; i < 81; i++)
      stress->D[i] += means->weight[k] * means->tau[k] * D[i];
    if (is_mean) step_add_mean(points, q, stress, V, means->of_force[k], means->of_mean[k]);
  }
  return PETSC_TRUE;
}

static PetscErrorCode add_elastic(const StepPoints *points, PetscReal f[], PetscReal K[], PetscBool *inverted)
{
  Means means;
  PetscFunctionBeginHot;
  PetscCall(set_means(points, &means));
  for (PetscInt q = 0; q < points->n && !*inverted; q++) {
    StepStress stress = {.part = 1 - points->step->alpha_f};
    step_place(points, q, stress.F);
    for (int k = 0; k < 9; k++)
      stress.R[k] = (k % 4 == 0) + points->after[q].H[k];
    *inverted = (PetscBool)!mean_stress(points, q, &means, &stress, (PetscBool)(K != NULL));
    step_add(points, q, &stress, f, K);
  }
  for (PetscInt k = 0; k < means.n && K && points->element->material->mean_dilatation; k++)
    step_add_product(points, means.weight[k] * means.tau[k] * means.dp[k], means.of_force[k], means.of_mean[k], K);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode cell_step_forces(const Element *element, const CellStep *step, PetscBool damping_only, PetscReal f[], PetscReal K[], PetscBool *inverted)
{
  const PetscInt n      = 3 * cell_nodes(element->kind);
  StepPoints     points; /* not all of it is used, nor set */
  PetscReal      mean;
  PetscFunctionBeginHot;
  points.element = element;
  points.step    = step;
  PetscCall(PetscArrayzero(f, n));
  if (K) PetscCall(PetscArrayzero(K, n * n));
  *inverted = (PetscBool)(!cell_points(element, step->from, points.before, &points.n, &mean, &points.whole) ||
                          !cell_points(element, step->to, points.after, &points.n, &mean, &points.whole));
  if (*inverted) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt q = 0; q < points.n; q++) {
    green_strain(points.before[q].H, points.start[q]);
    green_strain(points.after[q].H, points.end[q]);
  }
  if (!damping_only) PetscCall(add_elastic(&points, f, K, inverted));
  if (step->rate) step_add_damping(&points, f, K);
  PetscFunctionReturn(PETSC_SUCCESS);
}
