/* Cells and faces of all kinds by themselves, in every space: functions, Gauss points, which nodes faces have, stiffness,
 * consistent loads. Prints a line per check; exit code 1 if one fails. */
#include "physics/elasticity.h"
#include "physics/element_loads.h"
#include <math.h>
#include <petscblaslapack.h>
#include <stdio.h>

/* Central differences with steps of 3e-6: truncation 1e-11 of third derivatives, which are some hundreds in a small curved
 * cell, and rounding 1e-16 / 3e-6. */
static const double STEP = 3e-6, DIFFERENCE_BOUND = 1e-8;
/* What is the same by algebra: some hundreds of roundings of numbers of order one. */
static const double ROUNDING_BOUND = 1e-13;
/* An eigenvalue over the largest one: a deformation without energy has rounding only, others have far more. */
static const double FREE = 1e-10;
/* Where cells of rings begin: away from the axis. */
static const double RADIUS = 2;

static const char *const        NAMES[]  = {"line2", "line3", "tri3",  "tri6", "quad4", "quad8",
                                            "quad9", "tet4",  "tet10", "hex8", "hex20", "hex27"}; /* by CellKind */
static const char *const        SPACES[] = {"solid", "plane strain", "plane stress", "ring"}; /* by SpaceKind */
static const MaterialLaw *const LAWS[]   = {&MATERIAL_LINEAR, &MATERIAL_ST_VENANT_KIRCHHOFF, &MATERIAL_NEO_HOOKE};
enum { N_LAWS = 3 };
static int failures = 0;

static void check(CellKind kind, const char *what, double error, double bound)
{
  const int passed = error <= bound; /* not a number fails */
  printf("%-6s %-82s %9.2e <= %.0e  %s\n", NAMES[kind], what, error, bound, passed ? "ok" : "FAILED");
  failures += !passed;
}

static void check_in(CellKind kind, const Space *space, const char *what, double error, double bound)
{
  char text[128];
  snprintf(text, sizeof(text), "%s: %s", SPACES[space->kind], what);
  check(kind, text, error, bound);
}

/* numbers in [-1, 1], the same in every run */
static double pseudo_random(void)
{
  static unsigned state = 12345;
  state                 = state * 1664525u + 1013904223u;
  return 2.0 * (state >> 8) / (double)(1u << 24) - 1;
}

/* the cell of reference, each node moved: its edges and faces are curved */
static void curved_cell(CellKind kind, const Space *space, double amount, double X[])
{
  for (PetscInt a = 0; a < cell_nodes(kind); a++) {
    cell_node_position(kind, a, X + 3 * a);
    for (int i = 0; i < cell_dimension(kind); i++)
      X[3 * a + i] += amount * pseudo_random() + (i == 0 && space->kind == SPACE_AXISYMMETRIC ? RADIUS : 0);
  }
}

/* The functions of a kind hold these monomials x^a y^b z^c: of degree 1 or 2 together, or in each variable where they are
 * whole products. */
static int holds(CellKind kind, const int e[3])
{
  const int degree = cell_nodes(kind) > cell_corners(kind) ? 2 : 1, product = !cell_is_simplex(kind) && kind != QUAD8 && kind != HEX20;
  int       together = 0, most = 0;
  for (int k = 0; k < 3; k++) {
    if (e[k] && k >= cell_dimension(kind)) return 0;
    together += e[k];
    most = e[k] > most ? e[k] : most;
  }
  return (product ? most : together) <= degree;
}

static double power(double x, int n)
{
  return n == 0 ? 1 : n == 1 ? x : x * x;
}

/* monomials that are interpolated at the nodes, and their gradients, at a point */
static void test_functions(CellKind kind)
{
  PetscReal xi[3] = {0.21, 0.13, 0.37}, N[CELL_NODES], dN[CELL_NODES][3];
  double    error = 0;
  for (int k = cell_dimension(kind); k < 3; k++)
    xi[k] = 0;
  cell_functions(kind, xi, N, dN);
  for (int m = 0; m < 27; m++) {
    const int e[3] = {m % 3, m / 3 % 3, m / 9};
    if (!holds(kind, e)) continue;
    for (int k = -1; k < 3; k++) { /* -1: the function itself */
      double exact = k < 0 ? power(xi[0], e[0]) : e[k] * power(xi[k], e[k] - 1), sum = 0;
      for (int i = 1; i < 3; i++)
        exact *= power(xi[(PetscMax(k, 0) + i) % 3], e[(PetscMax(k, 0) + i) % 3]);
      for (PetscInt a = 0; a < cell_nodes(kind); a++) {
        PetscReal p[3];
        cell_node_position(kind, a, p);
        sum += (k < 0 ? N[a] : dN[a][k]) * power(p[0], e[0]) * power(p[1], e[1]) * power(p[2], e[2]);
      }
      error = fmax(error, fabs(sum - (k >= 0 && !e[k] ? 0 : exact)));
    }
  }
  check(kind, "polynomials that the functions hold, and their gradients", error, ROUNDING_BOUND);
}

/* int N_a n dA over the faces against int dN_a/dX dV, in rings with N_a / r, node by node: what a uniform pressure does to a
 * curved cell. It needs the right nodes of each face, outward, and points enough on faces and within. */
static void test_divergence(CellKind kind, const Space *space)
{
  const PetscInt nodes = cell_nodes(kind);
  PetscReal      X[3 * CELL_NODES], sum[3 * CELL_NODES] = {0}, N[CELL_NODES], dN[CELL_NODES][3], xi[3], error = 0;
  PetscInt       own[CELL_NODES];
  curved_cell(kind, space, 0.07, X);
  for (PetscInt q = 0; q < cell_quadrature_points(kind); q++) {
    PetscReal weight = cell_quadrature_point(kind, q, xi), r = 0;
    cell_functions(kind, xi, N, dN);
    for (PetscInt a = 0; a < nodes; a++)
      r += N[a] * X[3 * a];
    weight *= cell_physical_gradients(kind, X, dN) * space_measure(space, r);
    for (PetscInt k = 0; k < 3 * nodes; k++)
      sum[k] += weight * (dN[k / 3][k % 3] + (space->kind == SPACE_AXISYMMETRIC && k % 3 == 0 ? N[k / 3] / r : 0));
  }
  for (PetscInt a = 0; a < nodes; a++)
    own[a] = a;
  for (PetscInt face = 0; face < cell_faces(kind); face++) {
    PetscInt        its[FACE_NODES];
    PetscReal       of_face[3 * FACE_NODES], f[3 * FACE_NODES];
    const PetscInt  n = cell_face(kind, face, own, its);
    for (PetscInt k = 0; k < 3 * n; k++)
      of_face[k] = X[3 * its[k / 3] + k % 3];
    face_pressure(cell_kind(cell_dimension(kind) - 1, n), space, of_face, 1, f, NULL); /* against the outward normal */
    for (PetscInt k = 0; k < 3 * n; k++)
      sum[3 * its[k / 3] + k % 3] += f[k];
  }
  for (PetscInt k = 0; k < 3 * nodes; k++)
    error = PetscMax(error, PetscAbsReal(sum[k]));
  check_in(kind, space, "pressure on all faces of a curved cell against its volume", error,
           ROUNDING_BOUND * (space->kind == SPACE_AXISYMMETRIC ? 2 * PETSC_PI * RADIUS : 1));
}

/* Displacements have no third component in the plane. */
static int is_unknown(CellKind kind, PetscInt k)
{
  return k % 3 < cell_dimension(kind);
}

static void test_stiffness(CellKind kind, const Space *space, const MaterialLaw *law, PetscBool mean)
{
  const PetscInt n = 3 * cell_nodes(kind);
  const Material m = {.young = 3, .poisson = 0.3, .law = law, .mean_dilatation = mean};
  static double  X[81], u[81], f[81], high[81], low[81], K[81 * 81], swell[27];
  const Element  element = {.kind = kind, .space = space, .material = &m, .X = X, .swell = swell};
  const double   size  = m.young * space_measure(space, RADIUS);
  double         error = 0, asymmetry = 0;
  char           what[80];
  PetscBool      inverted, any = PETSC_FALSE;
  curved_cell(kind, space, 0.05, X);
  for (PetscInt k = 0; k < n; k++)
    u[k] = is_unknown(kind, k) ? 0.05 * pseudo_random() : 0;
  for (PetscInt a = 0; a < cell_nodes(kind); a++)
    swell[a] = law->finite ? 0.05 * pseudo_random() : 0;
  if (cell_forces(&element, u, f, K, &inverted) || inverted) failures++;
  for (PetscInt k = 0; k < n; k++) {
    const double value = u[k];
    if (!is_unknown(kind, k)) continue;
    u[k] = value + STEP;
    if (cell_forces(&element, u, high, NULL, &inverted) || inverted) any = PETSC_TRUE;
    u[k] = value - STEP;
    if (cell_forces(&element, u, low, NULL, &inverted) || inverted) any = PETSC_TRUE;
    u[k] = value;
    for (PetscInt j = 0; j < n; j++) {
      error = fmax(error, fabs(K[n * j + k] - (high[j] - low[j]) / (2 * STEP)));
      if (is_unknown(kind, j)) asymmetry = fmax(asymmetry, fabs(K[n * j + k] - K[n * k + j]));
    }
  }
  failures += any;
  snprintf(what, sizeof(what), "%s, %s: stiffness against differences", law->name, mean ? "mean" : "pointwise");
  check_in(kind, space, what, error / size, DIFFERENCE_BOUND);
  snprintf(what, sizeof(what), "%s, %s: stiffness is symmetric", law->name, mean ? "mean" : "pointwise");
  check_in(kind, space, what, asymmetry / size, ROUNDING_BOUND);
}

/* Work of a step over the strain energy of a cell: rounding, and what four points leave of the mean of neo-Hooke's stress, whose step is small. */
static const double WORK_BOUND = 1e-11, SMALL_STEP = 0.01;
/* A small strain, and what its square may be of it in a small cell. */
static const double TINY = 1e-8, SQUARED = 1e-6;

/* A step of `dynamics`: forces that work what the energy changes by, their derivatives, and none where nothing moves but the static ones. */
static void test_step(CellKind kind, const Space *space, const MaterialLaw *law, PetscBool mean, double alpha_f, PetscBool damped)
{
  const PetscInt n = 3 * cell_nodes(kind);
  const Material m = {.young = 3, .poisson = 0.3, .law = law, .mean_dilatation = mean};
  static double  X[81], from[81], to[81], rate[81], still[81], f[81], high[81], low[81], K[81 * 81];
  const Element  element = {.kind = kind, .space = space, .material = &m, .X = X};
  const double   size = m.young * space_measure(space, RADIUS), ahead = 0.7, change = law == &MATERIAL_NEO_HOOKE ? SMALL_STEP : 0.05;
  CellStep       step = {.from = from, .to = to, .rate = damped ? rate : NULL, .alpha_f = alpha_f, .ahead = ahead};
  double         error = 0, work = 0;
  char           what[96];
  PetscBool      inverted, any = PETSC_FALSE;
  curved_cell(kind, space, 0.05, X);
  for (PetscInt k = 0; k < n; k++) {
    from[k] = is_unknown(kind, k) ? 0.05 * pseudo_random() : 0;
    to[k]   = is_unknown(kind, k) ? from[k] + change * pseudo_random() : 0;
    still[k] = is_unknown(kind, k) ? 0.1 * pseudo_random() : 0;
    rate[k] = still[k] + ahead * to[k];
  }
  if (cell_step_forces(&element, &step, PETSC_FALSE, f, K, &inverted) || inverted) failures++;
  for (PetscInt k = 0; k < n; k++)
    work += f[k] * (to[k] - from[k]);
  for (PetscInt k = 0; k < n; k++) {
    const double value = to[k];
    if (!is_unknown(kind, k)) continue;
    for (int side = 0; side < 2; side++) {
      to[k]   = value + (side ? -STEP : STEP);
      rate[k] = still[k] + ahead * to[k];
      if (cell_step_forces(&element, &step, PETSC_FALSE, side ? low : high, NULL, &inverted) || inverted) any = PETSC_TRUE;
    }
    to[k]   = value;
    rate[k] = still[k] + ahead * to[k];
    for (PetscInt j = 0; j < n; j++)
      error = fmax(error, is_unknown(kind, j) ? fabs(K[n * j + k] - (high[j] - low[j]) / (2 * STEP)) : 0);
  }
  failures += any;
  snprintf(what, sizeof(what), "%s, %s, alpha_f %g%s: derivatives of a step", law->name, mean ? "mean" : "pointwise", alpha_f, damped ? ", damped" : "");
  check_in(kind, space, what, error / size, DIFFERENCE_BOUND);
  if (damped) return;
  if (alpha_f == 0.5) {
    const double stored = cell_energy(&element, to) - cell_energy(&element, from);
    snprintf(what, sizeof(what), "%s, %s: the work of a step is the energy", law->name, mean ? "mean" : "pointwise");
    check_in(kind, space, what, fabs(work - stored) / (cell_energy(&element, to) + cell_energy(&element, from)), WORK_BOUND);
  }
  step.from = to;
  if (cell_step_forces(&element, &step, PETSC_FALSE, f, NULL, &inverted) || cell_forces(&element, to, high, NULL, &inverted)) failures++;
  error = 0;
  for (PetscInt j = 0; j < n; j++)
    error = fmax(error, is_unknown(kind, j) ? fabs(f[j] - high[j]) : 0);
  snprintf(what, sizeof(what), "%s, %s, alpha_f %g: a step that moves nothing", law->name, mean ? "mean" : "pointwise", alpha_f);
  check_in(kind, space, what, error / size, ROUNDING_BOUND);
}

/* A turn about z at the mean place has no damping; a small strain that of linear bodies. */
static void test_damping(CellKind kind, const Space *space, const MaterialLaw *law, PetscBool mean)
{
  const PetscInt n = 3 * cell_nodes(kind);
  const Material m = {.young = 3, .poisson = 0.3, .law = law, .mean_dilatation = mean};
  Material       linear = m;
  static double  X[81], still[81], to[81], f[81], exact[81];
  const Element  element = {.kind = kind, .space = space, .material = &m, .X = X};
  const Element  likeness = {.kind = kind, .space = space, .material = &linear, .X = X};
  const CellStep step = {.from = still, .to = to, .rate = to, .alpha_f = 0.5};
  const double   size = m.young * space_measure(space, RADIUS), angle = 0.7;
  double         error = 0;
  char           what[96];
  PetscBool      inverted;
  linear.law = &MATERIAL_LINEAR;
  curved_cell(kind, space, 0.05, X);
  for (PetscInt k = 0; k < n; k++)
    to[k] = is_unknown(kind, k) ? TINY * pseudo_random() : 0;
  if (cell_step_forces(&element, &step, PETSC_TRUE, f, NULL, &inverted) || cell_forces(&likeness, to, exact, NULL, &inverted)) failures++;
  for (PetscInt k = 0; k < n; k++)
    error = fmax(error, is_unknown(kind, k) ? fabs(f[k] - exact[k]) : 0);
  snprintf(what, sizeof(what), "%s, %s: damping of small strains", law->name, mean ? "mean" : "pointwise");
  check_in(kind, space, what, error / size / TINY, SQUARED);
  if (space->kind == SPACE_AXISYMMETRIC) return;
  for (PetscInt k = 0; k < n; k += 3) {
    to[k]     = (cos(angle) - 1) * X[k] - sin(angle) * X[k + 1];
    to[k + 1] = sin(angle) * X[k] + (cos(angle) - 1) * X[k + 1];
    to[k + 2] = 0;
  }
  error = 0;
  if (cell_step_forces(&element, &step, PETSC_TRUE, f, NULL, &inverted)) failures++;
  for (PetscInt k = 0; k < n; k++)
    error = fmax(error, is_unknown(kind, k) ? fabs(f[k]) : 0);
  snprintf(what, sizeof(what), "%s, %s: a turn is not damped", law->name, mean ? "mean" : "pointwise");
  check_in(kind, space, what, error / size, ROUNDING_BOUND);
}

/* A free body that is warm grows, and is without stress: closed form. Held, it has that of F_e = I / theta. */
static void test_swell(CellKind kind, const Space *space, const MaterialLaw *law, PetscBool mean)
{
  const PetscInt n = 3 * cell_nodes(kind);
  const Material m = {.young = 3, .poisson = 0.3, .law = law, .mean_dilatation = mean};
  static double  X[81], u[81], f[81], swell[27], s[9];
  const Element  element = {.kind = kind, .space = space, .material = &m, .X = X, .swell = swell};
  const double   size = m.young * space_measure(space, RADIUS), grown = 0.1, e = 1 / (1 + grown);
  const double   G = m.young / (2 * (1 + m.poisson)), lambda = 2 * G * m.poisson / (1 - 2 * m.poisson), E = (e * e - 1) / 2;
  const double   held = law == &MATERIAL_NEO_HOOKE ? (G * (e * e - 1) + 3 * lambda * log(e)) / (e * e * e) : (2 * G + 3 * lambda) * E / e;
  double         error = 0;
  char           what[96];
  PetscBool      inverted;
  curved_cell(kind, space, 0.05, X);
  for (PetscInt a = 0; a < cell_nodes(kind); a++)
    swell[a] = grown;
  for (PetscInt k = 0; k < n; k++)
    u[k] = is_unknown(kind, k) ? grown * X[k] : 0;
  if (space->kind != SPACE_PLANE_STRAIN) {
    if (cell_forces(&element, u, f, NULL, &inverted) || inverted) failures++;
    for (PetscInt k = 0; k < n; k++)
      error = fmax(error, fabs(f[k]));
    snprintf(what, sizeof(what), "%s, %s: warm and free, no stress", law->name, mean ? "mean" : "pointwise");
    check_in(kind, space, what, error / size, ROUNDING_BOUND);
  }
  if (space->kind == SPACE_PLANE_STRESS) return;
  for (PetscInt k = 0; k < n; k++)
    u[k] = 0;
  cell_centre_stress(&element, u, s);
  for (int k = 0; k < 9; k++)
    s[k] -= k % 4 ? 0 : held;
  error = 0;
  for (int k = 0; k < 9; k++)
    error = fmax(error, fabs(s[k]));
  snprintf(what, sizeof(what), "%s, %s: warm and held, Cauchy's stress", law->name, mean ? "mean" : "pointwise");
  check_in(kind, space, what, error / m.young, ROUNDING_BOUND);
}

static void test_finite(CellKind kind, const Space *space, const MaterialLaw *law, PetscBool mean)
{
  if (!law->finite) return;
  for (int k = 0; k < 3; k++) {
    test_step(kind, space, law, mean, 0.25 * k, PETSC_FALSE);
    test_step(kind, space, law, mean, 0.25 * k, PETSC_TRUE);
  }
  test_damping(kind, space, law, mean);
  test_swell(kind, space, law, mean);
}

/* Rigid motions are without energy, and nothing else: there are points enough. A ring has one, along its axis. */
static void test_rank(CellKind kind, const Space *space)
{
  static const int rigid[] = {6, 3, 3, 1}; /* by SpaceKind */
  const PetscInt   all     = 3 * cell_nodes(kind);
  const Material   m       = {.young = 1, .poisson = 0.3, .law = &MATERIAL_LINEAR};
  const double     u[81]   = {0};
  static double    X[81], f[81], K[81 * 81], values[81], work[1024];
  const Element    element = {.kind = kind, .space = space, .material = &m, .X = X};
  PetscBLASInt     n = 0, length = 1024, info;
  PetscBool        inverted;
  int              n_free = 0, entry = 0;
  curved_cell(kind, space, 0, X);
  if (cell_forces(&element, u, f, K, &inverted)) failures++;
  for (PetscInt k = 0; k < all * all; k++) {
    if (is_unknown(kind, k / all) && is_unknown(kind, k % all)) K[entry++] = K[k];
    n += k < all && is_unknown(kind, k);
  }
  LAPACKsyev_("N", "U", &n, K, &n, values, work, &length, &info);
  for (int k = 0; k < n; k++)
    n_free += fabs(values[k]) <= FREE * values[n - 1];
  check_in(kind, space, "motions without energy, less the rigid ones", abs(n_free - rigid[space->kind]) + abs((int)info), 0);
}

/* A layer of hexahedra that nothing lets move across is in plane strain. */
static void test_layer(const MaterialLaw *law)
{
  const Space    plane = {SPACE_PLANE_STRAIN, 0.7}, solid = {SPACE_SOLID, 1};
  const Material m     = {.young = 3, .poisson = 0.3, .law = law, .mean_dilatation = PETSC_TRUE};
  double         X[24], u[24], f[12], whole[24], error = 0;
  const Element  element = {.kind = QUAD4, .space = &plane, .material = &m, .X = X}, layer = {.kind = HEX8, .space = &solid, .material = &m, .X = X};
  PetscBool      inverted;
  curved_cell(QUAD4, &plane, 0.1, X);
  for (int k = 0; k < 12; k++) {
    u[k]      = k % 3 < 2 ? 0.1 * pseudo_random() : 0;
    u[12 + k] = u[k];
    X[12 + k] = X[k] + (k % 3 == 2 ? plane.thickness : 0);
  }
  if (cell_forces(&element, u, f, NULL, &inverted) || inverted) failures++;
  if (cell_forces(&layer, u, whole, NULL, &inverted) || inverted) failures++;
  for (int k = 0; k < 12; k++)
    error = fmax(error, k % 3 < 2 ? fabs(f[k] - whole[k] - whole[12 + k]) : 0);
  check_in(QUAD4, &plane, law->name, error / m.young, ROUNDING_BOUND);
}

/* Nothing pulls across the plane: Cauchy's stress, and of the linear law Young's modulus along a bar. */
static void test_plane_stress(const MaterialLaw *law)
{
  const Space    space = {SPACE_PLANE_STRESS, 0.7};
  const Material m     = {.young = 3, .poisson = 0.3, .law = law};
  double         X[12], u[12] = {0}, s[9];
  const Element  element = {.kind = QUAD4, .space = &space, .material = &m, .X = X};
  curved_cell(QUAD4, &space, 0, X);
  for (int a = 0; a < 4; a++) {
    u[3 * a]     = 0.1 * X[3 * a];
    u[3 * a + 1] = -0.03 * X[3 * a + 1];
  }
  cell_centre_stress(&element, u, s);
  check_in(QUAD4, &space, law->name, fabs(s[8]) / m.young, ROUNDING_BOUND);
  if (law->finite) return;
  check_in(QUAD4, &space, "a bar has Young's modulus", fabs(s[0] - 0.1 * m.young) + fabs(s[4]), ROUNDING_BOUND);
}

/* Nodal forces of a uniform traction on a flat cell of reference, over the whole: corner, middle of an edge, centre. */
static void test_loads(CellKind kind, const Space *space, double corner, double edge, double centre)
{
  const PetscReal traction[3] = {1, -2, cell_dimension(kind) == 2 ? 3 : 0};
  const PetscInt  corners     = cell_corners(kind), edges = cell_dimension(kind) == 1 ? 1 : corners;
  const double    area = (cell_dimension(kind) == 1 ? 2 : cell_is_simplex(kind) ? 0.5 : 4) * space_measure(space, 0);
  PetscReal       X[3 * FACE_NODES], f[3 * FACE_NODES], error = 0;
  curved_cell(kind, space, 0, X);
  face_pressure(kind, space, X, 0, f, NULL);
  face_traction(kind, space, X, traction, f);
  for (PetscInt k = 0; k < 3 * cell_nodes(kind); k++) {
    const double part = k / 3 < corners ? corner : k / 3 < corners + edges ? edge : centre;
    error             = PetscMax(error, PetscAbsReal(f[k] - area * part * traction[k % 3]));
  }
  check_in(kind, space, "nodal forces of a uniform traction", error, ROUNDING_BOUND);
}

/* A pressure that follows its face: derivatives against differences. */
static void test_follower(CellKind kind, const Space *space)
{
  const PetscInt n = 3 * cell_nodes(kind);
  double         x[3 * FACE_NODES], f[3 * FACE_NODES], high[3 * FACE_NODES], low[3 * FACE_NODES], K[9 * FACE_NODES * FACE_NODES];
  double         error = 0;
  curved_cell(kind, space, 0.1, x);
  for (PetscInt k = 2; k < n && space->kind == SPACE_SOLID; k += 3)
    x[k] += 0.1 * pseudo_random();
  face_pressure(kind, space, x, 1.3, f, K);
  for (PetscInt k = 0; k < n; k++) {
    const double value = x[k];
    if (k % 3 == 2 && space->kind != SPACE_SOLID) continue;
    x[k] = value + STEP;
    face_pressure(kind, space, x, 1.3, high, NULL);
    x[k] = value - STEP;
    face_pressure(kind, space, x, 1.3, low, NULL);
    x[k] = value;
    for (PetscInt j = 0; j < n; j++)
      error = fmax(error, fabs(K[n * j + k] - (high[j] - low[j]) / (2 * STEP)));
  }
  check_in(kind, space, "a pressure's derivatives against differences", error / space_measure(space, RADIUS), DIFFERENCE_BOUND);
}

/* Forces of gravity add up to the weight, and those of a turn have the moments of the mass: int rho X_i X_j dV. */
static void test_body_forces(CellKind kind, const Space *space)
{
  const Acceleration gravity = {.uniform = {1, -2, 3}};
  const Acceleration spin    = {.spin = {0, 0, 2}, .origin = {0.3, 0.2, 0}}; /* outward: 4 (X - origin), but along z */
  double             X[81], f[81], sum[3] = {0}, volume = 0, first[2] = {0}, error = 0, N[CELL_NODES], dN[CELL_NODES][3], xi[3];
  curved_cell(kind, space, 0.05, X);
  for (PetscInt q = 0; q < cell_quadrature_points(kind); q++) {
    double weight = cell_quadrature_point(kind, q, xi), x[3] = {0};
    cell_functions(kind, xi, N, dN);
    for (PetscInt k = 0; k < 3 * cell_nodes(kind); k++)
      x[k % 3] += N[k / 3] * X[k];
    weight *= cell_physical_gradients(kind, X, dN) * space_measure(space, x[0]);
    volume += weight;
    for (int i = 0; i < 2; i++)
      first[i] += 4 * weight * (x[i] - spin.origin[i]);
  }
  cell_body_forces(kind, space, 0.7, &gravity, X, f);
  for (PetscInt k = 0; k < 3 * cell_nodes(kind); k++)
    sum[k % 3] += f[k];
  for (int i = 0; i < 3; i++)
    error = fmax(error, fabs(sum[i] - 0.7 * volume * gravity.uniform[i]));
  cell_body_forces(kind, space, 0.7, &spin, X, f);
  sum[0] = sum[1] = sum[2] = 0;
  for (PetscInt k = 0; k < 3 * cell_nodes(kind); k++)
    sum[k % 3] += f[k];
  for (int i = 0; i < 3; i++)
    error = fmax(error, fabs(sum[i] - (i < 2 ? 0.7 * first[i] : 0)));
  check_in(kind, space, "forces of gravity and of a turn add up", error / volume, ROUNDING_BOUND);
}

int main(int argc, char **argv)
{
  const Space solid = {SPACE_SOLID, 1}, strain = {SPACE_PLANE_STRAIN, 0.7}, stress = {SPACE_PLANE_STRESS, 0.7},
              ring     = {SPACE_AXISYMMETRIC, 1};
  const Space *all[][3] = {{&solid}, {&strain, &stress, &ring}};
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (int kind = 0; kind < CELL_KINDS; kind++) {
    const int plane = cell_dimension(kind) == 2;
    test_functions((CellKind)kind);
    for (int s = 0; s < (plane ? 3 : 1) && cell_dimension(kind) > 1; s++) {
      const Space *space = all[plane][s];
      test_divergence((CellKind)kind, space);
      test_body_forces((CellKind)kind, space);
      test_rank((CellKind)kind, space);
      for (int k = 0; k < 2 * N_LAWS; k++) {
        if (k % 2 && space->kind == SPACE_PLANE_STRESS) continue;
        test_stiffness((CellKind)kind, space, LAWS[k / 2], (PetscBool)(k % 2));
        test_finite((CellKind)kind, space, LAWS[k / 2], (PetscBool)(k % 2));
      }
    }
  }
  for (int kind = LINE2; kind <= QUAD9; kind++) {
    if (cell_dimension((CellKind)kind) == 2) test_follower((CellKind)kind, &solid);
    if (cell_dimension((CellKind)kind) == 1) test_follower((CellKind)kind, &strain);
    if (cell_dimension((CellKind)kind) == 1) test_follower((CellKind)kind, &ring);
  }
  for (int k = 0; k < N_LAWS; k++) {
    test_layer(LAWS[k]);
    test_plane_stress(LAWS[k]);
  }
  test_loads(TRI3, &solid, 1.0 / 3, 0, 0);
  test_loads(QUAD4, &solid, 1.0 / 4, 0, 0);
  test_loads(TRI6, &solid, 0, 1.0 / 3, 0);
  test_loads(QUAD8, &solid, -1.0 / 12, 1.0 / 3, 0);
  test_loads(QUAD9, &solid, 1.0 / 36, 1.0 / 9, 4.0 / 9);
  test_loads(LINE2, &strain, 1.0 / 2, 0, 0);
  test_loads(LINE3, &strain, 1.0 / 6, 2.0 / 3, 0);
  PetscCall(PetscFinalize());
  return failures ? 1 : 0;
}
