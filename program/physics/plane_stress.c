/* Plane stress: the stretch across the plane is an unknown of each point of a cell, which P_33 = 0 determines. The body is
 * symmetric about its plane, so that H_13, H_23 and P_13, P_23 are zero. */
#include "physics/materials.h"

/* Newton's method doubles the digits: laws that are linear need one iteration, others about five. */
enum { MOST_ITERATIONS = 30 };
/* A change of a stretch of one: some roundings. */
static const PetscReal SETTLED = 8 * PETSC_MACHINE_EPSILON;
/* One iteration may bring the stretch down to this part of itself, so that it stays positive. */
static const PetscReal LEAST_PART = 0.5;

PetscBool plane_stress_stretch(const Material *material, PetscReal H[9])
{
  PetscReal P[9], V[9], A[81], p, dp;
  H[8] = 0;
  if (material->young == 0) return PETSC_TRUE; /* the frame of an analytic body, which has no stiffness */
  if (material->law->finite && !(volume_ratio_minus_one(H) > -1)) return PETSC_FALSE;
  for (int k = 0; k < MOST_ITERATIONS; k++) {
    PetscReal change;
    material->law->pressure(material, material->law->volume(H), &p, &dp);
    material->law->stress(material, H, p, dp, P, V, A);
    if (!(A[80] > 0)) return PETSC_FALSE; /* it would not resist */
    change = -P[8] / A[80];
    if (material->law->finite) change = PetscMax(change, (LEAST_PART - 1) * (1 + H[8]));
    H[8] += change;
    if (PetscAbsReal(change) <= SETTLED * (1 + PetscAbsReal(H[8]))) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscBool plane_stress_strain(const Material *material, PetscReal E[9])
{
  PetscReal S[9], V[9], D[81], p, dp;
  for (int k = 0; k < MOST_ITERATIONS; k++) {
    const PetscReal squared = 1 + 2 * E[8]; /* of the stretch */
    PetscReal       change;
    material->law->pressure(material, material->law->volume_of_strain(E), &p, &dp);
    material->law->second_stress(material, E, p, dp, S, V, D);
    if (!(D[80] > 0)) return PETSC_FALSE; /* it would not resist */
    change = PetscMax(-S[8] / D[80], (LEAST_PART - 1) * squared / 2);
    E[8] += change;
    if (PetscAbsReal(change) <= SETTLED * squared) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

void plane_stress_condense(PetscReal A[81])
{
  PetscReal row[9], column[9];
  if (A[80] == 0) return; /* no stiffness at all */
  for (int k = 0; k < 9; k++) {
    row[k]    = A[72 + k] / A[80];
    column[k] = A[9 * k + 8];
  }
  for (int k = 0; k < 81; k++)
    A[k] -= column[k / 9] * row[k % 9];
}
