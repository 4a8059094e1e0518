/* Elastic materials, each an energy per reference volume W(H) = W0(H) + U(v(H)): a part that shears, and a part U that
 * knows the strain only by one measure of the change of volume, v. Split like this, U can be taken at every point
 * (`pointwise`) or at a cell's mean of v (`mean`, for nearly incompressible bodies); see cell_forces() in elasticity.c.
 *
 * H = du/dX, F = I + H, row-major; stresses in F/L^2. lambda and G are Lame's constants. */
#ifndef STICKSLIP_PROGRAM_MATERIALS_H
#define STICKSLIP_PROGRAM_MATERIALS_H
#include "scene/petsc_compat.h"

typedef struct Material Material;

typedef struct {
  const char *name;
  PetscBool   finite; /* strain: needs det F > 0 */
  /* v, zero in the undeformed state */
  PetscReal (*volume)(const PetscReal H[9]);
  /* p = U'(v) and dp = U''(v) */
  void (*pressure)(const Material *material, PetscReal v, PetscReal *p, PetscReal *dp);
  /* P = dW0/dH + p V with V = dv/dH, the first Piola-Kirchhoff stress where p is U'(v);
   * unless NULL, A[9 (3i+J) + 3k+L] = dP_iJ/dH_kL at fixed p, plus dp V_iJ V_kL */
  void (*stress)(const Material *material, const PetscReal H[9], PetscReal p, PetscReal dp, PetscReal P[9],
                 PetscReal V[9], PetscReal A[81]);
  PetscReal (*energy)(const Material *material, const PetscReal H[9], PetscReal v); /* W0(H) + U(v) */
  /* Of finite strain, the same by Green and Lagrange's strain E = (H + H^T + H^T H) / 2: v; S = dW0/dE + p V with V = dv/dE, the second
   * Piola-Kirchhoff stress; D[9 (3I+J) + 3K+L] = dS_IJ/dE_KL at fixed p, plus dp V_IJ V_KL; Gauss points that the mean of S between two strains takes */
  PetscReal (*volume_of_strain)(const PetscReal E[9]);
  void (*second_stress)(const Material *material, const PetscReal E[9], PetscReal p, PetscReal dp, PetscReal S[9], PetscReal V[9], PetscReal D[81]);
  PetscInt mean_points;
} MaterialLaw;

struct Material {
  PetscReal          young, poisson;
  PetscReal          density; /* of the undeformed body; 0: not given */
  const MaterialLaw *law;
  PetscBool          small_strain; /* the linear theory is meant, however large strains are */
  PetscBool          mean_dilatation;
};

/* stress over a small strain of what cannot widen */
PetscReal material_confined(const Material *material);

extern const MaterialLaw MATERIAL_LINEAR, MATERIAL_ST_VENANT_KIRCHHOFF, MATERIAL_NEO_HOOKE;

/* plane_stress.c: H_33 for which nothing pulls across the plane, P_33 = 0, in place of the given one; the other components
 * with a 3 are zero. False: there is none. Only with the pressure taken pointwise. */
PetscBool plane_stress_stretch(const Material *material, PetscReal H[9]);
/* likewise E_33 for which S_33 = 0, from a start on; D = dS/dE */
PetscBool plane_stress_strain(const Material *material, PetscReal E[9]);
/* A = dP/dH at such a stretch, which follows the other components; D at such a strain */
void      plane_stress_condense(PetscReal A[81]);

/* det F - 1, without the cancellation of small strains */
PetscReal volume_ratio_minus_one(const PetscReal H[9]);
/* E of H */
void      green_strain(const PetscReal H[9], PetscReal E[9]);

/* Cauchy's stress of P: P F^T / det F; of the linear law, which does not tell them apart, P itself */
void cauchy_stress(const Material *material, const PetscReal H[9], const PetscReal P[9], PetscReal sigma[9]);
#endif
