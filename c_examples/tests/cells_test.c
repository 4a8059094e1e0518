/* Cells and faces of all kinds by themselves: functions, Gauss points, which nodes faces have, stiffness, consistent loads.
 * Prints a line per check; exit code 1 if one fails. */
#include "physics/elasticity.h"
#include <math.h>
#include <petscblaslapack.h>
#include <stdio.h>

/* Central differences with steps of 1e-5: truncation 1e-10 of third derivatives, rounding 1e-16 / 1e-5. */
static const double STEP = 1e-5, DIFFERENCE_BOUND = 1e-8;
/* What is the same by algebra: some hundreds of roundings of numbers of order one. */
static const double ROUNDING_BOUND = 1e-13;
/* An eigenvalue over the largest one: a deformation without energy has rounding only, others have far more. */
static const double FREE = 1e-10;

static const PetscInt           KINDS[] = {4, 8, 10, 20, 27};
static const char *const        NAMES[] = {"tet4", "hex8", "tet10", "hex20", "hex27"};
static const MaterialLaw *const LAWS[]  = {&MATERIAL_LINEAR, &MATERIAL_ST_VENANT_KIRCHHOFF, &MATERIAL_NEO_HOOKE};
enum { N_KINDS = 5, N_LAWS = 3, RIGID_MOTIONS = 6 };
static int failures = 0;

static void check(const char *kind, const char *what, double error, double bound)
{
  const int passed = error <= bound; /* not a number fails */
  printf("%-8s %-72s %9.2e <= %.0e  %s\n", kind, what, error, bound, passed ? "ok" : "FAILED");
  failures += !passed;
}

/* numbers in [-1, 1], the same in every run */
static double pseudo_random(void)
{
  static unsigned state = 12345;
  state                 = state * 1664525u + 1013904223u;
  return 2.0 * (state >> 8) / (double)(1u << 24) - 1;
}

/* the cell of reference, each node moved: its edges and faces are curved */
static void curved_cell(PetscInt nodes, double amount, double X[])
{
  for (PetscInt a = 0; a < nodes; a++) {
    cell_node_position(nodes, a, X + 3 * a);
    for (int i = 0; i < 3; i++)
      X[3 * a + i] += amount * pseudo_random();
  }
}

/* The functions of a kind hold these monomials x^a y^b z^c: of degree 1 or 2 (tetrahedra), of degree 1 or 2 in each variable
 * (hex8, hex27), of degree 2 (hex20). */
static int holds(PetscInt nodes, int a, int b, int c)
{
  const int each = a > b ? (a > c ? a : c) : (b > c ? b : c);
  if (nodes == 8 || nodes == 27) return each <= (nodes == 8 ? 1 : 2);
  return a + b + c <= (nodes == 4 ? 1 : 2);
}

static double power(double x, int n)
{
  return n == 0 ? 1 : n == 1 ? x : x * x;
}

/* gradients at a point of monomials that are interpolated at the nodes */
static void test_functions(int kind)
{
  const PetscInt  nodes = KINDS[kind];
  const PetscReal xi[3] = {0.21, 0.13, 0.37};
  PetscReal       dN[CELL_NODES][3];
  double          error = 0;
  cell_reference_gradients(nodes, xi, dN);
  for (int m = 0; m < 27; m++) {
    const int e[3] = {m % 3, m / 3 % 3, m / 9};
    if (!holds(nodes, e[0], e[1], e[2])) continue;
    for (int k = 0; k < 3; k++) {
      double exact = e[k] * power(xi[k], e[k] - 1), sum = 0;
      for (int i = 1; i < 3; i++)
        exact *= power(xi[(k + i) % 3], e[(k + i) % 3]);
      for (PetscInt a = 0; a < nodes; a++) {
        PetscReal p[3];
        cell_node_position(nodes, a, p);
        sum += dN[a][k] * power(p[0], e[0]) * power(p[1], e[1]) * power(p[2], e[2]);
      }
      error = fmax(error, fabs(sum - (e[k] ? exact : 0)));
    }
  }
  check(NAMES[kind], "gradients of the polynomials that the functions hold", error, ROUNDING_BOUND);
}

/* int N_a n dA over the faces against int dN_a/dX dV, node by node: what a uniform pressure does to a curved cell. It needs
 * the right nodes of each face, outward, and points enough on faces and within. */
static void test_divergence(int kind)
{
  const PetscInt nodes = KINDS[kind];
  PetscReal      X[3 * CELL_NODES], sum[3 * CELL_NODES] = {0}, dN[CELL_NODES][3], xi[3], error = 0;
  PetscInt       own[CELL_NODES];
  curved_cell(nodes, 0.07, X);
  for (PetscInt q = 0; q < cell_quadrature_points(nodes); q++) {
    PetscReal weight = cell_quadrature_point(nodes, q, xi);
    cell_reference_gradients(nodes, xi, dN);
    weight *= cell_physical_gradients(nodes, X, dN);
    for (PetscInt k = 0; k < 3 * nodes; k++)
      sum[k] += weight * dN[k / 3][k % 3];
  }
  for (PetscInt a = 0; a < nodes; a++)
    own[a] = a;
  for (PetscInt face = 0; face < cell_faces(nodes); face++) {
    const PetscReal nothing[3] = {0, 0, 0};
    PetscInt        its[FACE_NODES];
    PetscReal       of_face[3 * FACE_NODES], f[3 * FACE_NODES];
    const PetscInt  n = cell_face(nodes, face, own, its);
    for (PetscInt k = 0; k < 3 * n; k++)
      of_face[k] = X[3 * its[k / 3] + k % 3];
    face_forces(n, of_face, nothing, 1, f); /* against the outward normal */
    for (PetscInt k = 0; k < 3 * n; k++)
      sum[3 * its[k / 3] + k % 3] += f[k];
  }
  for (PetscInt k = 0; k < 3 * nodes; k++)
    error = PetscMax(error, PetscAbsReal(sum[k]));
  check(NAMES[kind], "pressure on all faces of a curved cell against its volume", error, ROUNDING_BOUND);
}

static void test_stiffness(int kind, const MaterialLaw *law, PetscBool mean)
{
  const PetscInt nodes = KINDS[kind], n = 3 * nodes;
  const Material m = {.young = 3, .poisson = 0.3, .law = law, .mean_dilatation = mean};
  static double  X[81], u[81], f[81], high[81], low[81], K[81 * 81];
  double         error = 0, asymmetry = 0;
  char           what[80];
  PetscBool      inverted, any = PETSC_FALSE;
  curved_cell(nodes, 0.05, X);
  for (PetscInt k = 0; k < n; k++)
    u[k] = 0.05 * pseudo_random();
  if (cell_forces(nodes, &m, X, u, f, K, &inverted) || inverted) failures++;
  for (PetscInt k = 0; k < n; k++) {
    const double value = u[k];
    u[k]               = value + STEP;
    if (cell_forces(nodes, &m, X, u, high, NULL, &inverted) || inverted) any = PETSC_TRUE;
    u[k] = value - STEP;
    if (cell_forces(nodes, &m, X, u, low, NULL, &inverted) || inverted) any = PETSC_TRUE;
    u[k] = value;
    for (PetscInt j = 0; j < n; j++) {
      error     = fmax(error, fabs(K[n * j + k] - (high[j] - low[j]) / (2 * STEP)));
      asymmetry = fmax(asymmetry, fabs(K[n * j + k] - K[n * k + j]));
    }
  }
  failures += any;
  snprintf(what, sizeof(what), "%s, %s: stiffness against differences", law->name, mean ? "mean" : "pointwise");
  check(NAMES[kind], what, error / m.young, DIFFERENCE_BOUND);
  snprintf(what, sizeof(what), "%s, %s: stiffness is symmetric", law->name, mean ? "mean" : "pointwise");
  check(NAMES[kind], what, asymmetry / m.young, ROUNDING_BOUND);
}

/* Six rigid motions are without energy, and nothing else: there are points enough. */
static void test_rank(int kind)
{
  const PetscInt nodes = KINDS[kind];
  const Material m     = {.young = 1, .poisson = 0.3, .law = &MATERIAL_LINEAR};
  const double   u[81] = {0};
  static double  X[81], f[81], K[81 * 81], values[81], work[1024];
  PetscBLASInt   n = (PetscBLASInt)(3 * nodes), length = 1024, info;
  PetscBool      inverted;
  int            n_free = 0;
  curved_cell(nodes, 0, X);
  if (cell_forces(nodes, &m, X, u, f, K, &inverted)) failures++;
  LAPACKsyev_("N", "U", &n, K, &n, values, work, &length, &info);
  for (int k = 0; k < n; k++)
    n_free += fabs(values[k]) <= FREE * values[n - 1];
  check(NAMES[kind], "motions without energy, less the six rigid ones", abs(n_free - RIGID_MOTIONS) + abs((int)info), 0);
}

/* Nodal forces of a uniform traction on a flat square or triangle, over the whole: corner, middle of an edge, centre. */
static void test_loads(const char *name, PetscInt nodes, double corner, double edge, double centre)
{
  const PetscReal traction[3] = {1, -2, 3};
  PetscReal       X[3 * FACE_NODES] = {0}, f[3 * FACE_NODES], error = 0;
  const double    area = face_corners(nodes) == 4 ? 4 : 0.5;
  for (PetscInt a = 0; a < nodes; a++) {
    PetscInt       its[4];
    const PetscInt n = face_node_corners(nodes, a, its);
    for (PetscInt k = 0; k < 2 * n; k++)
      X[3 * a + k % 2] += (face_corners(nodes) == 4 ? CELL_HEX[its[k / 2]][k % 2] : its[k / 2] == 1 + k % 2) / (double)n;
  }
  face_forces(nodes, X, traction, 0, f);
  for (PetscInt k = 0; k < 3 * nodes; k++) {
    const PetscInt corners = face_corners(nodes);
    const double   part    = k / 3 < corners ? corner : k / 3 < 2 * corners ? edge : centre;
    error                  = PetscMax(error, PetscAbsReal(f[k] - area * part * traction[k % 3]));
  }
  check(name, "nodal forces of a uniform traction", error, ROUNDING_BOUND);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  for (int kind = 0; kind < N_KINDS; kind++) {
    test_functions(kind);
    test_divergence(kind);
    test_rank(kind);
    for (int k = 0; k < 2 * N_LAWS; k++)
      test_stiffness(kind, LAWS[k / 2], (PetscBool)(k % 2));
  }
  test_loads("tri3", 3, 1.0 / 3, 0, 0);
  test_loads("quad4", 4, 1.0 / 4, 0, 0);
  test_loads("tri6", 6, 0, 1.0 / 3, 0);
  test_loads("quad8", 8, -1.0 / 12, 1.0 / 3, 0);
  test_loads("quad9", 9, 1.0 / 36, 1.0 / 9, 4.0 / 9);
  PetscCall(PetscFinalize());
  return failures ? 1 : 0;
}
