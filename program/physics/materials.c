/* The laws. Strains are taken from H, not from F, so that small ones keep their digits beside the identity. */
#include "physics/materials.h"
#include <math.h>

static PetscReal shear_modulus(const Material *material)
{
  return material->young / (2 * (1 + material->poisson));
}

static PetscReal lame(const Material *material)
{
  return material->young * material->poisson / ((1 + material->poisson) * (1 - 2 * material->poisson));
}

PetscReal material_confined(const Material *material)
{
  return lame(material) + 2 * shear_modulus(material);
}

static PetscReal trace(const PetscReal H[9])
{
  return H[0] + H[4] + H[8];
}

/* cofactors: d det M / dM */
static void cofactors(const PetscReal M[9], PetscReal C[9])
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      C[3 * i + j] = M[3 * i1 + j1] * M[3 * i2 + j2] - M[3 * i1 + j2] * M[3 * i2 + j1];
    }
  }
}

/* F = I + H */
static void deformation_gradient(const PetscReal H[9], PetscReal F[9])
{
  for (int k = 0; k < 9; k++)
    F[k] = H[k] + (k % 4 == 0);
}

/* E = (H + H^T + H^T H) / 2, Green and Lagrange's strain */
void green_strain(const PetscReal H[9], PetscReal E[9])
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      E[3 * i + j] = 0.5 * (H[3 * i + j] + H[3 * j + i] + H[i] * H[j] + H[3 + i] * H[3 + j] + H[6 + i] * H[6 + j]);
  }
}

/* det(I + H) - 1 = tr H + tr cof H + det H */
PetscReal volume_ratio_minus_one(const PetscReal H[9])
{
  PetscReal C[9];
  cofactors(H, C);
  return trace(H) + trace(C) + (H[0] * C[0] + H[1] * C[1] + H[2] * C[2]);
}

/* U = lambda v^2 / 2 */
static void quadratic_pressure(const Material *material, PetscReal v, PetscReal *p, PetscReal *dp)
{
  *dp = lame(material);
  *p  = *dp * v;
}

/* --- linear, small strain: W = G e:e + lambda (tr e)^2 / 2, e = (H + H^T) / 2 --- */
static void linear_stress(const Material *material, const PetscReal H[9], PetscReal p, PetscReal dp, PetscReal P[9],
                          PetscReal V[9], PetscReal A[81])
{
  const PetscReal G = shear_modulus(material);
  for (int i = 0; i < 3; i++) {
    for (int J = 0; J < 3; J++) {
      V[3 * i + J] = (i == J);
      P[3 * i + J] = G * (H[3 * i + J] + H[3 * J + i]) + p * (i == J);
    }
  }
  if (!A) return;
  for (int i = 0; i < 3; i++) {
    for (int J = 0; J < 3; J++) {
      for (int k = 0; k < 3; k++) {
        for (int L = 0; L < 3; L++)
          A[9 * (3 * i + J) + 3 * k + L] = (i == J && k == L) * dp + ((i == k && J == L) + (i == L && J == k)) * G;
      }
    }
  }
}

static PetscReal linear_energy(const Material *material, const PetscReal H[9], PetscReal v)
{
  PetscReal squares = 0;
  for (int k = 0; k < 9; k++)
    squares += PetscSqr(H[k] + H[3 * (k % 3) + k / 3]) / 4;
  return shear_modulus(material) * squares + lame(material) * v * v / 2;
}

/* --- St. Venant and Kirchhoff: W = G E:E + lambda (tr E)^2 / 2 --- */
static PetscReal green_trace(const PetscReal H[9])
{
  PetscReal squares = 0;
  for (int k = 0; k < 9; k++)
    squares += H[k] * H[k];
  return trace(H) + 0.5 * squares;
}

static void st_venant_kirchhoff_stress(const Material *material, const PetscReal H[9], PetscReal p, PetscReal dp,
                                       PetscReal P[9], PetscReal V[9], PetscReal A[81])
{
  const PetscReal G = shear_modulus(material);
  PetscReal       E[9], S[9]; /* S: second Piola-Kirchhoff stress */
  deformation_gradient(H, V); /* d tr E / dF = F */
  green_strain(H, E);
  for (int k = 0; k < 9; k++)
    S[k] = 2 * G * E[k] + p * (k % 4 == 0);
  for (int i = 0; i < 3; i++) {
    for (int J = 0; J < 3; J++)
      P[3 * i + J] = V[3 * i] * S[J] + V[3 * i + 1] * S[3 + J] + V[3 * i + 2] * S[6 + J];
  }
  if (!A) return;
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) {
      const PetscReal left_cauchy_green = V[3 * i] * V[3 * k] + V[3 * i + 1] * V[3 * k + 1] +
                                          V[3 * i + 2] * V[3 * k + 2];
      for (int J = 0; J < 3; J++) {
        for (int L = 0; L < 3; L++)
          A[9 * (3 * i + J) + 3 * k + L] = (i == k) * S[3 * L + J] + (J == L) * G * left_cauchy_green +
                                           G * V[3 * i + L] * V[3 * k + J] + dp * V[3 * i + J] * V[3 * k + L];
      }
    }
  }
}

static PetscReal strain_trace(const PetscReal E[9])
{
  return trace(E);
}

static void st_venant_kirchhoff_second_stress(const Material *material, const PetscReal E[9], PetscReal p, PetscReal dp, PetscReal S[9],
                                              PetscReal V[9], PetscReal D[81])
{
  const PetscReal G = shear_modulus(material);
  for (int k = 0; k < 9; k++) {
    V[k] = (k % 4 == 0);
    S[k] = 2 * G * E[k] + p * V[k];
  }
  if (!D) return;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++)
          D[9 * (3 * i + j) + 3 * k + l] = G * ((i == k && j == l) + (i == l && j == k)) + dp * V[3 * i + j] * V[3 * k + l];
      }
    }
  }
}

static PetscReal st_venant_kirchhoff_energy(const Material *material, const PetscReal H[9], PetscReal v)
{
  PetscReal E[9], squares = 0;
  green_strain(H, E);
  for (int k = 0; k < 9; k++)
    squares += E[k] * E[k];
  return shear_modulus(material) * squares + lame(material) * v * v / 2;
}

/* --- compressible neo-Hooke: W = G (tr F^T F - 3) / 2 - G ln J + lambda (ln J)^2 / 2, J = det F = 1 + v --- */
static void logarithmic_pressure(const Material *material, PetscReal v, PetscReal *p, PetscReal *dp)
{
  const PetscReal logarithm = log1p(v), J = 1 + v;
  *p  = lame(material) * logarithm / J;
  *dp = lame(material) * (1 - logarithm) / (J * J);
}

static void neo_hooke_stress(const Material *material, const PetscReal H[9], PetscReal p, PetscReal dp, PetscReal P[9],
                             PetscReal V[9], PetscReal A[81])
{
  const PetscReal v = volume_ratio_minus_one(H), G_J = shear_modulus(material) / (1 + v);
  PetscReal       F[9], C[9];
  deformation_gradient(H, F);
  cofactors(F, V); /* dJ / dF */
  cofactors(H, C);
  for (int i = 0; i < 3; i++) {
    for (int J = 0; J < 3; J++) {
      /* G (F - cof F / J), with F - cof F = H + H^T - I tr H - cof H */
      const PetscReal difference = H[3 * i + J] + H[3 * J + i] - (i == J) * trace(H) - C[3 * i + J];
      P[3 * i + J]               = G_J * (v * F[3 * i + J] + difference) + p * V[3 * i + J];
    }
  }
  if (!A) return;
  for (int i = 0; i < 3; i++) {
    for (int J = 0; J < 3; J++) {
      for (int k = 0; k < 3; k++) {
        for (int L = 0; L < 3; L++)
          A[9 * (3 * i + J) + 3 * k + L] = (i == k && J == L) * G_J * (1 + v) +
                                           (dp + G_J / (1 + v)) * V[3 * i + J] * V[3 * k + L];
        /* d cof_iJ / dF_kL = +F_mN where (i, k, m) and (J, L, N) turn the same way, -F_mN where they do not */
        if (k == i) continue;
        for (int turn = 1; turn < 3; turn++) {
          const int       L = (J + turn) % 3, m = 3 - i - k, N = 3 - J - L;
          const PetscReal sign = (k == (i + 1) % 3) == (turn == 1) ? 1 : -1;
          A[9 * (3 * i + J) + 3 * k + L] += sign * (p - G_J) * F[3 * m + N];
        }
      }
    }
  }
}

/* J - 1 of J^2 = det(I + 2 E) */
static PetscReal strained_volume(const PetscReal E[9])
{
  PetscReal C[9], change;
  for (int k = 0; k < 9; k++)
    C[k] = 2 * E[k];
  change = volume_ratio_minus_one(C);
  return change / (1 + PetscSqrtReal(1 + change));
}

/* S = G (I - C^-1) + p J C^-1, with J^2 (I - C^-1) = I (tr cof B + det B) + B - cof B for C = I + B */
static void neo_hooke_second_stress(const Material *material, const PetscReal E[9], PetscReal p, PetscReal dp, PetscReal S[9], PetscReal V[9],
                                    PetscReal D[81])
{
  const PetscReal G = shear_modulus(material), J = 1 + strained_volume(E);
  PetscReal       B[9], cofactor[9], inverse[9], change;
  for (int k = 0; k < 9; k++)
    B[k] = 2 * E[k];
  cofactors(B, cofactor);
  change = trace(cofactor) + (B[0] * cofactor[0] + B[1] * cofactor[1] + B[2] * cofactor[2]);
  for (int k = 0; k < 9; k++) {
    const PetscReal less = ((k % 4 == 0) * change + B[k] - cofactor[k]) / (J * J);
    inverse[k]           = (k % 4 == 0) - less;
    V[k]                 = J * inverse[k];
    S[k]                 = G * less + p * V[k];
  }
  if (!D) return;
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++) {
      for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++)
          D[9 * (3 * i + j) + 3 * k + l] = D[9 * (3 * j + i) + 3 * k + l] =
              (G - p * J) * (inverse[3 * i + k] * inverse[3 * j + l] + inverse[3 * i + l] * inverse[3 * j + k]) + (p / J + dp) * V[3 * i + j] * V[3 * k + l];
      }
    }
  }
}

static PetscReal neo_hooke_energy(const Material *material, const PetscReal H[9], PetscReal v)
{
  const PetscReal logarithm = log1p(volume_ratio_minus_one(H)), mean = log1p(v);
  PetscReal       squares = 0;
  for (int k = 0; k < 9; k++)
    squares += H[k] * H[k];
  return shear_modulus(material) * (trace(H) + squares / 2 - logarithm) + lame(material) * mean * mean / 2;
}

const MaterialLaw MATERIAL_LINEAR              = {"linear", PETSC_FALSE, trace, quadratic_pressure, linear_stress, linear_energy, NULL, NULL, 0};
/* S is linear in E: its mean is that of one point. That of neo-Hooke with six is off by the twelfth power of a change of strain: where a step strains
 * by a fifth, energies by 1e-11; with four by 1e-7. */
const MaterialLaw MATERIAL_ST_VENANT_KIRCHHOFF = {"st_venant_kirchhoff", PETSC_TRUE, green_trace, quadratic_pressure,
                                                  st_venant_kirchhoff_stress, st_venant_kirchhoff_energy, strain_trace,
                                                  st_venant_kirchhoff_second_stress, 1};
const MaterialLaw MATERIAL_NEO_HOOKE           = {"neo_hooke", PETSC_TRUE, volume_ratio_minus_one, logarithmic_pressure,
                                                  neo_hooke_stress, neo_hooke_energy, strained_volume, neo_hooke_second_stress, 6};

void cauchy_stress(const Material *material, const PetscReal H[9], const PetscReal P[9], PetscReal sigma[9])
{
  PetscReal F[9], J = 1;
  for (int k = 0; k < 9; k++)
    F[k] = (k % 4 == 0);
  if (material->law->finite) {
    deformation_gradient(H, F);
    J = 1 + volume_ratio_minus_one(H);
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      sigma[3 * i + j] = (P[3 * i] * F[3 * j] + P[3 * i + 1] * F[3 * j + 1] + P[3 * i + 2] * F[3 * j + 2]) / J;
  }
}
