/* `stiffness_damping` of finite strain: S = D : sym(F_a^T G), with D of the undeformed body and G the gradient of `rate`, the velocity where the
 * forces are times the damping. With alpha_f = 1/2 it is D : (E' - E) b / dt. What turns has no rate of E, and is not braked. At small
 * strains it is that of linear bodies. */
#include "physics/elasticity_step.h"

/* sym(F^T G), in plane stress with what S_33 = 0 makes of the third direction */
static void rate_of_strain(const Element *element, const PetscReal F[9], const PetscReal G[9], PetscReal rate[9])
{
  const PetscReal nu = element->material->poisson;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      rate[3 * i + j] = 0;
      for (int k = 0; k < 3; k++)
        rate[3 * i + j] += (F[3 * k + i] * G[3 * k + j] + F[3 * k + j] * G[3 * k + i]) / 2;
    }
  }
  if (element->space->kind == SPACE_PLANE_STRESS) rate[8] = -nu / (1 - nu) * (rate[0] + rate[4]);
}

void step_add_damping(const StepPoints *points, PetscReal f[], PetscReal K[])
{
  const Element     *element = points->element;
  const MaterialLaw *law     = &MATERIAL_ST_VENANT_KIRCHHOFF; /* S is D times what it gets */
  const PetscBool    is_mean = element->material->mean_dilatation;
  PetscReal rate[CELL_POINTS][9], F[9], G[9], V[9], of_force[3 * CELL_NODES] = {0}, of_mean[3 * CELL_NODES] = {0}, mean = 0, p, dp = 0;
  for (PetscInt q = 0; q < points->n; q++) {
    step_place(points, q, F);
    point_gradient(element, &points->after[q], points->step->rate, G);
    rate_of_strain(element, F, G, rate[q]);
    mean += points->after[q].weight / points->whole * law->volume_of_strain(rate[q]);
  }
  for (PetscInt q = 0; q < points->n; q++) {
    StepStress stress = {.part = 1 - points->step->alpha_f};
    step_place(points, q, stress.F);
    point_gradient(element, &points->after[q], points->step->rate, G);
    for (int k = 0; k < 9; k++)
      stress.R[k] = (1 - points->step->alpha_f) * G[k] + points->step->ahead * stress.F[k];
    law->pressure(element->material, is_mean ? mean : law->volume_of_strain(rate[q]), &p, &dp);
    law->second_stress(element->material, rate[q], p, is_mean ? 0 : dp, stress.S, V, stress.D);
    if (element->space->kind == SPACE_PLANE_STRESS) plane_stress_condense(stress.D);
    step_add(points, q, &stress, f, K);
    if (K && is_mean) step_add_mean(points, q, &stress, V, of_force, of_mean);
  }
  if (K && is_mean) step_add_product(points, dp, of_force, of_mean, K);
}
