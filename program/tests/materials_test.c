/* The bulk's materials and elements by themselves: stresses against differences of an energy written down here once
 * more, moduli against differences of the stresses, closed forms, rigid rotations, and the mean dilatation of a cell.
 * Prints a line per check; exit code 1 if one fails. */
#include "physics/elasticity.h"
#include <math.h>
#include <stdio.h>

/* Central differences with steps of 1e-5: truncation 1e-10 of third derivatives, rounding 1e-16 / 1e-5. */
static const double STEP = 1e-5, DIFFERENCE_BOUND = 1e-8;
/* Closed forms, symmetry, and what is the same by algebra: some dozens of roundings of numbers of order one. */
static const double ROUNDING_BOUND = 1e-13;
/* A rigid rotation, relative to E: rounding of F^T F. */
static const double ROTATION_BOUND = 1e-12;

static const MaterialLaw *const LAWS[] = {&MATERIAL_LINEAR, &MATERIAL_ST_VENANT_KIRCHHOFF, &MATERIAL_NEO_HOOKE};
enum { N_LAWS = 3 };
static const Space SOLID = {SPACE_SOLID, 1};
static int failures = 0;

static void check(const char *law, const char *what, double error, double bound)
{
  const int passed = error <= bound; /* not a number fails */
  printf("%-20s %-62s %9.2e <= %.0e  %s\n", law, what, error, bound, passed ? "ok" : "FAILED");
  failures += !passed;
}

/* numbers in [-1, 1], the same in every run */
static double pseudo_random(void)
{
  static unsigned state = 12345;
  state                 = state * 1664525u + 1013904223u;
  return 2.0 * (state >> 8) / (double)(1u << 24) - 1;
}

static double determinant(const double M[9])
{
  return M[0] * (M[4] * M[8] - M[5] * M[7]) - M[1] * (M[3] * M[8] - M[5] * M[6]) + M[2] * (M[3] * M[7] - M[4] * M[6]);
}

/* the energies as textbooks have them, in F */
static double energy(const Material *m, const double H[9])
{
  const double G = m->young / (2 * (1 + m->poisson)), lame = 2 * G * m->poisson / (1 - 2 * m->poisson);
  double       F[9], tr = 0, squares = 0;
  for (int k = 0; k < 9; k++)
    F[k] = H[k] + (k % 4 == 0);
  if (m->law == &MATERIAL_NEO_HOOKE) {
    const double logarithm = log(determinant(F));
    for (int k = 0; k < 9; k++)
      squares += F[k] * F[k];
    return 0.5 * G * (squares - 3) - G * logarithm + 0.5 * lame * logarithm * logarithm;
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      double e = 0.5 * (H[3 * i + j] + H[3 * j + i]);
      if (m->law == &MATERIAL_ST_VENANT_KIRCHHOFF)
        e = 0.5 * (F[i] * F[j] + F[3 + i] * F[3 + j] + F[6 + i] * F[6 + j] - (i == j));
      squares += e * e;
      tr += e * (i == j);
    }
  }
  return G * squares + 0.5 * lame * tr * tr;
}

static void evaluate(const Material *m, const double H[9], double P[9], double A[81])
{
  double p, dp, V[9];
  m->law->pressure(m, m->law->volume(H), &p, &dp);
  m->law->stress(m, H, p, dp, P, V, A);
}

static void test_derivatives(const Material *m)
{
  double H[9], P[9], A[81], high[9], low[9], stress_error = 0, modulus_error = 0;
  for (int k = 0; k < 9; k++)
    H[k] = 0.3 * pseudo_random();
  evaluate(m, H, P, A);
  for (int k = 0; k < 9; k++) {
    const double h = H[k];
    double       difference;
    H[k]       = h + STEP;
    difference = energy(m, H);
    evaluate(m, H, high, NULL);
    H[k] = h - STEP;
    difference -= energy(m, H);
    evaluate(m, H, low, NULL);
    H[k]         = h;
    stress_error = fmax(stress_error, fabs(P[k] - difference / (2 * STEP)));
    for (int j = 0; j < 9; j++)
      modulus_error = fmax(modulus_error, fabs(A[9 * j + k] - (high[j] - low[j]) / (2 * STEP)));
  }
  check(m->law->name, "the energy as textbooks have it", fabs(m->law->energy(m, H, m->law->volume(H)) - energy(m, H)) / m->young, ROUNDING_BOUND);
  check(m->law->name, "P against differences of the energy", stress_error / m->young, DIFFERENCE_BOUND);
  check(m->law->name, "dP/dF against differences of P", modulus_error / m->young, DIFFERENCE_BOUND);
}

static double largest_difference(int n, const double a[], const double b[])
{
  double largest = 0;
  for (int k = 0; k < n; k++)
    largest = fmax(largest, fabs(a[k] - b[k]));
  return largest;
}

/* S and D of a strain: F S is P; D against differences of S, E_IJ and E_JI together as S has them. */
static void test_second_stress(const Material *m)
{
  double H[9], P[9], E[9], S[9], V[9], D[81], FS[9] = {0}, high[9], low[9], p, dp, error = 0;
  for (int k = 0; k < 9; k++)
    H[k] = 0.3 * pseudo_random();
  evaluate(m, H, P, NULL);
  green_strain(H, E);
  check(m->law->name, "v of a strain", fabs(m->law->volume_of_strain(E) - m->law->volume(H)), ROUNDING_BOUND);
  m->law->pressure(m, m->law->volume_of_strain(E), &p, &dp);
  m->law->second_stress(m, E, p, dp, S, V, D);
  for (int k = 0; k < 27; k++)
    FS[3 * (k / 9) + k % 3] += (H[k / 3] + (k / 9 == k / 3 % 3)) * S[3 * (k / 3 % 3) + k % 3];
  check(m->law->name, "F S is P", largest_difference(9, FS, P) / m->young, ROUNDING_BOUND);
  for (int k = 0; k < 9; k++) {
    const int    transposed = 3 * (k % 3) + k / 3;
    const double kept       = E[k];
    double      *of[2]      = {high, low};
    for (int side = 0; side < 2; side++) {
      E[k] = E[transposed] = kept + (side ? -STEP : STEP);
      m->law->pressure(m, m->law->volume_of_strain(E), &p, &dp);
      m->law->second_stress(m, E, p, dp, of[side], V, NULL);
    }
    E[k] = E[transposed] = kept;
    for (int j = 0; j < 9; j++) {
      const double both = k == transposed ? D[9 * j + k] : D[9 * j + k] + D[9 * j + transposed];
      error             = fmax(error, fabs(both - (high[j] - low[j]) / (2 * STEP)));
    }
  }
  check(m->law->name, "dS/dE against differences of S", error / m->young, DIFFERENCE_BOUND);
}

/* x = R X with a rotation of two radians about a skew axis (Rodrigues) */
static void rotation(double H[9])
{
  const double n[3] = {2.0 / 3, -1.0 / 3, 2.0 / 3}, c = cos(2.0), s = sin(2.0);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    H[3 * i + i] = (1 - c) * (n[i] * n[i] - 1);
    H[3 * i + j] = (1 - c) * n[i] * n[j] - s * n[k];
    H[3 * j + i] = (1 - c) * n[i] * n[j] + s * n[k];
  }
}

static void test_closed_forms(const Material *m)
{
  const double E = m->young, G = E / (2 * (1 + m->poisson)), lame = 2 * G * m->poisson / (1 - 2 * m->poisson);
  const double s = 1.7, gamma = 0.8, strain = 0.5 * (s * s - 1), g = 0.5 * gamma * gamma;
  const double stretched[9] = {s - 1, 0, 0, 0, 0, 0, 0, 0, 0}, sheared[9] = {0, gamma, 0, 0, 0, 0, 0, 0, 0};
  const int    neo_hooke = m->law == &MATERIAL_NEO_HOOKE;
  /* P_11, P_22 of x = s X; P_11, P_12, P_21, P_22 of x = X + gamma Y */
  const double stretch[2] = {neo_hooke ? G * (s - 1 / s) + lame * log(s) / s : s * (lame + 2 * G) * strain,
                             neo_hooke ? lame * log(s) : lame * strain};
  const double shear[4]   = {neo_hooke ? 0 : (lame * g + G * gamma * gamma),
                             neo_hooke ? G * gamma : G * gamma + gamma * (lame * g + 2 * G * g),
                             G * gamma,
                             neo_hooke ? 0 : lame * g + 2 * G * g};
  double       P[9], H[9], sigma[9], largest = 0;
  evaluate(m, stretched, P, NULL);
  check(m->law->name, "uniaxial stretch by 1.7", fmax(fabs(P[0] - stretch[0]), fabs(P[4] - stretch[1])) / E,
        ROUNDING_BOUND);
  evaluate(m, sheared, P, NULL);
  for (int k = 0; k < 4; k++)
    largest = fmax(largest, fabs(P[3 * (k / 2) + k % 2] - shear[k]));
  check(m->law->name, "simple shear by 0.8", largest / E, ROUNDING_BOUND);
  cauchy_stress(m, sheared, P, sigma);
  check(m->law->name, "simple shear: Cauchy's stress is symmetric", fabs(sigma[1] - sigma[3]) / E, ROUNDING_BOUND);
  if (neo_hooke)
    check(m->law->name, "simple shear: Cauchy's normal stress G gamma^2", fabs(sigma[0] - G * gamma * gamma) / E,
          ROUNDING_BOUND);
  rotation(H);
  evaluate(m, H, P, NULL);
  largest = 0;
  for (int k = 0; k < 9; k++)
    largest = fmax(largest, fabs(P[k]));
  check(m->law->name, "rotation by two radians: stress", largest / E, ROTATION_BOUND);
}

/* a distorted cell of about unit size, and displacements */
static void random_cell(int corners, double amount, double X[24], double u[24])
{
  static const double HEX[8][3] = {
      {0, 0, 0},
      {1, 0, 0},
      {1, 1, 0},
      {0, 1, 0},
      {0, 0, 1},
      {1, 0, 1},
      {1, 1, 1},
      {0, 1, 1}
  };
  static const int TET[4] = {0, 1, 3, 4};
  for (int k = 0; k < 3 * corners; k++) {
    X[k] = HEX[corners == 8 ? k / 3 : TET[k / 3]][k % 3] + 0.15 * pseudo_random();
    u[k] = amount * pseudo_random();
  }
}

static void test_cell(Material m, PetscBool mean)
{
  const char *kind   = mean ? "mean dilatation: " : "pointwise: ";
  double      X[24], u[24], f[24], K[576], high[24], low[24], error = 0, asymmetry = 0;
  char        what[80];
  PetscBool     inverted, any = PETSC_FALSE;
  const Element element = {.kind = HEX8, .space = &SOLID, .material = &m, .X = X};
  m.mean_dilatation = mean;
  random_cell(8, 0.1, X, u);
  if (cell_forces(&element, u, f, K, &inverted) || inverted) failures++;
  for (int k = 0; k < 24; k++) {
    const double value = u[k];
    u[k]               = value + STEP;
    if (cell_forces(&element, u, high, NULL, &inverted) || inverted) any = PETSC_TRUE;
    u[k] = value - STEP;
    if (cell_forces(&element, u, low, NULL, &inverted) || inverted) any = PETSC_TRUE;
    u[k] = value;
    for (int j = 0; j < 24; j++) {
      error     = fmax(error, fabs(K[24 * j + k] - (high[j] - low[j]) / (2 * STEP)));
      asymmetry = fmax(asymmetry, fabs(K[24 * j + k] - K[24 * k + j]));
    }
  }
  failures += any;
  snprintf(what, sizeof(what), "%sstiffness of a hexahedron against differences", kind);
  check(m.law->name, what, error / m.young, DIFFERENCE_BOUND);
  snprintf(what, sizeof(what), "%sstiffness is symmetric", kind);
  check(m.law->name, what, asymmetry / m.young, ROUNDING_BOUND);
}

static double product(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Where v is the same at every point (a tetrahedron; a homogeneous deformation of any cell) the mean changes nothing. */
static void test_mean_is_pointwise(Material m)
{
  double    X[24], u[24], f[2][24], K[2][576], H[9];
  PetscBool inverted;
  for (int corners = 4; corners <= 8; corners += 4) {
    const Element element = {.kind = corners == 4 ? TET4 : HEX8, .space = &SOLID, .material = &m, .X = X};
    random_cell(corners, 0.1, X, u);
    for (int k = 0; k < 9; k++)
      H[k] = 0.3 * pseudo_random();
    for (int k = 0; k < 24 && corners == 8; k++)
      u[k] = product(H + 3 * (k % 3), X + k - k % 3);
    for (int mean = 0; mean < 2; mean++) {
      m.mean_dilatation = (PetscBool)mean;
      if (cell_forces(&element, u, f[mean], K[mean], &inverted) || inverted) failures++;
    }
    check(m.law->name,
          corners == 4 ? "tetrahedron: mean = pointwise, forces" : "homogeneous: mean = pointwise, forces",
          largest_difference(3 * corners, f[0], f[1]) / m.young, ROUNDING_BOUND);
    if (corners == 4)
      check(m.law->name, "tetrahedron: mean = pointwise, stiffness", largest_difference(144, K[0], K[1]) / m.young,
            ROUNDING_BOUND);
  }
}

/* The last corner is pulled through the opposite face: small strain does not mind, finite strain must say so. */
static void test_inverted(Material m)
{
  double    X[24], u[24], f[24];
  PetscBool inverted;
  for (int corners = 4; corners <= 8; corners += 4) {
    const Element element = {.kind = corners == 4 ? TET4 : HEX8, .space = &SOLID, .material = &m, .X = X};
    random_cell(corners, 0, X, u);
    for (int k = 3 * (corners - 4) + (corners == 4 ? 9 : 0); k < 3 * corners; k++)
      u[k] = k % 3 == 2 ? -2 : 0;
    if (cell_forces(&element, u, f, NULL, &inverted)) failures++;
    check(m.law->name, corners == 4 ? "inverted tetrahedron is told" : "inverted hexahedron is told",
          inverted == m.law->finite ? 0 : 1, 0);
  }
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (int k = 0; k < N_LAWS; k++) {
    const Material m = {.young = 3, .poisson = 0.3, .law = LAWS[k]};
    test_derivatives(&m);
    if (m.law->finite) test_second_stress(&m);
    if (m.law->finite) test_closed_forms(&m);
    test_cell(m, PETSC_FALSE);
    test_cell(m, PETSC_TRUE);
    test_mean_is_pointwise(m);
    test_inverted(m);
  }
  PetscCall(PetscFinalize());
  return failures ? 1 : 0;
}
