/* A cell of finite strain at both ends of a step: forces of a second Piola-Kirchhoff stress S at the place between, P = F S, and their derivatives. */
#include "physics/elasticity_step.h"

void step_place(const StepPoints *points, PetscInt q, PetscReal F[9])
{
  const PetscReal alpha_f = points->step->alpha_f;
  for (int k = 0; k < 9; k++)
    F[k] = (k % 4 == 0) + alpha_f * points->before[q].H[k] + (1 - alpha_f) * points->after[q].H[k];
}

/* A_iJkL = F_iM D_MJNL R_kN + part delta_ik S_JL */
static void moduli(const StepStress *stress, PetscReal A[81])
{
  const PetscReal *F = stress->F, *D = stress->D, *R = stress->R;
  PetscReal        DR[81];
  for (int MJ = 0; MJ < 9; MJ++) {
    for (int k = 0; k < 3; k++) {
      for (int L = 0; L < 3; L++)
        DR[9 * MJ + 3 * k + L] = D[9 * MJ + L] * R[3 * k] + D[9 * MJ + 3 + L] * R[3 * k + 1] + D[9 * MJ + 6 + L] * R[3 * k + 2];
    }
  }
  for (int i = 0; i < 3; i++) {
    for (int JkL = 0; JkL < 27; JkL++)
      A[27 * i + JkL] = F[3 * i] * DR[JkL] + F[3 * i + 1] * DR[27 + JkL] + F[3 * i + 2] * DR[54 + JkL] +
                        (JkL / 3 % 3 == i) * stress->part * stress->S[3 * (JkL / 9) + JkL % 3];
  }
}

static void times(const PetscReal F[9], const PetscReal S[9], PetscReal P[9])
{
  for (int i = 0; i < 3; i++) {
    for (int J = 0; J < 3; J++)
      P[3 * i + J] = F[3 * i] * S[J] + F[3 * i + 1] * S[3 + J] + F[3 * i + 2] * S[6 + J];
  }
}

void step_add(const StepPoints *points, PetscInt q, StepStress *stress, PetscReal f[], PetscReal K[])
{
  PetscReal P[9], A[81];
  times(stress->F, stress->S, P);
  point_add_forces(points->element, &points->after[q], P, f);
  if (!K) return;
  moduli(stress, A);
  point_add_stiffness(points->element, &points->after[q], A, K);
}

void step_add_mean(const StepPoints *points, PetscInt q, const StepStress *stress, const PetscReal V[9], PetscReal of_force[], PetscReal of_mean[])
{
  PetscReal P[9];
  times(stress->F, V, P);
  point_add_forces(points->element, &points->after[q], P, of_force);
  times(stress->R, V, P);
  point_add_forces(points->element, &points->after[q], P, of_mean);
}

void step_add_product(const StepPoints *points, PetscReal factor, const PetscReal of_force[], const PetscReal of_mean[], PetscReal K[])
{
  const PetscInt n = 3 * cell_nodes(points->element->kind);
  for (PetscInt k = 0; k < n * n; k++)
    K[k] += factor / points->whole * of_force[k / n] * of_mean[k % n];
}
