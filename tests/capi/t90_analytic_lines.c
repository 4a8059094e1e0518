/* Lines over a straight line and over a circle: the mortar side has a frame of three points and two numbers each. */
#include "check.h"

enum { N1 = 3, X1 = 2 * N1, X2 = 6, ALL = 2 * X1 };
/* Rounding of a dozen products. */
#define ROUNDING 1e-14
#define DIFFERENCES 1e-7
#define STEP 1e-6
/* Its rule of degree 10 on a chord of 0.1 of the radius, against Simpson's rule with many points; degree 5 is off by 1.3e-10. */
#define RULE 1e-12
static const double two_pi = 6.283185307179586;

/* The body of nonmortar is above: seen from outside, lines run with the body to their left. */
static const double x1[X1] = {0, 0, 0.1, 0, 0.2, 0};
/* A point of the straight line or the circle's centre, the normal, one more. */
static const double line[X2] = {5, 0, 5, 1, 6, 0}, circle[X2] = {0.1, -1, 0.1, 0, 1.1, -1};
static const int64_t offsets[3] = {0, 2, 4}, nodes[4] = {0, 1, 1, 2};
static int64_t equations[ALL];

static stickslip_surface two = {.struct_size = sizeof two, .n_nodes = 3};

static int32_t create(int32_t model, int32_t basis, int32_t shape, double radius, stickslip_interface **interface) {
  for (int64_t k = 0; k < ALL; ++k) equations[k] = k;
  const stickslip_surface one = {.struct_size = sizeof one, .n_nodes = N1, .n_facets = 2, .coordinates = x1,
      .facet_offsets = offsets, .facet_nodes = nodes, .equations = equations, .multiplier_equations = equations + X1};
  stickslip_options options;
  stickslip_method method;
  CHECK_OK(stickslip_options_init(&options, sizeof options));
  CHECK_OK(stickslip_options_paper(&options));
  method = *options.method, options.method = &method;
  options.modulus = 1000.0, options.mu = 0.3, options.model = model, method.multiplier_basis = basis;
  method.quadrature = STICKSLIP_QUADRATURE_DEGREE_10;
  options.mortar_side = STICKSLIP_MORTAR_ANALYTIC, options.shape = shape, options.radius = radius;
  two.coordinates = shape == STICKSLIP_SHAPE_PLANE ? line : circle;
  return stickslip_interface_create(&one, &two, &options, interface);
}

/* A pressure of 1 gives its consistent loads; those on the frame are equivalent to them. */
static void press(int32_t model, int32_t basis) {
  stickslip_interface *interface = NULL;
  double lambda[X1 + 1], force1[X1 + 1], force2[X2 + 1], rows[X1 + 1];
  CHECK_OK(create(model, basis, STICKSLIP_SHAPE_PLANE, 0.0, &interface));
  for (int a = 0; a < N1; ++a) lambda[2 * a] = 0.0, lambda[2 * a + 1] = -1.0;
  FILL(force1), FILL(force2), FILL(rows);
  CHECK_OK(stickslip_interface_residual(interface, x1, line, lambda, NULL, force1, force2, rows));
  CHECK_UNTOUCHED(force1[X1]), CHECK_UNTOUCHED(force2[X2]), CHECK_UNTOUCHED(rows[X1]);
  const int ring = model == STICKSLIP_MODEL_AXISYMMETRIC;
  const double plane[N1] = {0.05, 0.1, 0.05}, rings[N1] = {0.01 / 6, 0.01, 0.05 / 6};
  double sum[2] = {0, 0}, moment = 0.0;
  for (int a = 0; a < N1; ++a) {
    CHECK_NEAR(force1[2 * a + 1], ring ? -two_pi * rings[a] : -plane[a], ROUNDING);
    CHECK_NEAR(force1[2 * a], 0.0, ROUNDING);
    sum[0] += force1[2 * a] + force2[2 * a], sum[1] += force1[2 * a + 1] + force2[2 * a + 1];
    moment += x1[2 * a] * force1[2 * a + 1] + line[2 * a] * force2[2 * a + 1] - line[2 * a + 1] * force2[2 * a];
  }
  CHECK_NEAR(max_abs(rows, X1), 0.0, ROUNDING);
  CHECK_NEAR(max_abs(sum, 2), 0.0, ROUNDING);
  CHECK_NEAR(moment, 0.0, 10 * ROUNDING);
  CHECK_OK(stickslip_interface_destroy(&interface));
}

/* Lines that stand for a circle with the body outside: it lies in their plane, as a cylinder along z or as a sphere. */
static void round_shapes(void) {
  stickslip_interface *interface = NULL;
  const double centre[3] = {0.1, -1e3, 0}, above[3] = {0.1, -1e3, 1}, z[3] = {0, 0, 2}, tilted[3] = {0, 0.1, 1};
  double out[N1], ball[N1];
  CHECK_OK(create(STICKSLIP_MODEL_PLANE, STICKSLIP_BASIS_STANDARD, STICKSLIP_SHAPE_PLANE, 0.0, &interface));
  CHECK_OK(stickslip_interface_shape_offsets(interface, STICKSLIP_SIDE_NONMORTAR, STICKSLIP_SHAPE_CYLINDER, -1e3, centre, z, out));
  CHECK_OK(stickslip_interface_shape_offsets(interface, STICKSLIP_SIDE_NONMORTAR, STICKSLIP_SHAPE_SPHERE, -1e3, centre, tilted, ball));
  for (int a = 0; a < N1; ++a) CHECK_NEAR(out[a], ball[a], ROUNDING * 1e3);
  CHECK_REFUSED(stickslip_interface_shape_offsets(interface, STICKSLIP_SIDE_NONMORTAR, STICKSLIP_SHAPE_CYLINDER, 1e3, above, z, out),
                STICKSLIP_INVALID_VALUE, "point[2]");
  CHECK_REFUSED(stickslip_interface_shape_offsets(interface, STICKSLIP_SIDE_NONMORTAR, STICKSLIP_SHAPE_SPHERE, 1e3, above, z, out),
                STICKSLIP_INVALID_VALUE, "point[2]");
  CHECK_REFUSED(stickslip_interface_shape_offsets(interface, STICKSLIP_SIDE_NONMORTAR, STICKSLIP_SHAPE_CYLINDER, -1e3, centre, tilted, out),
                STICKSLIP_INVALID_VALUE, "along z");
  CHECK_OK(stickslip_interface_destroy(&interface));
}

/* int N_A (x - y) over the first line against a circle, by Simpson's rule: the gap of node 0. */
static void gap_over_circle(double gap[2]) {
  enum { INTERVALS = 200 };
  gap[0] = gap[1] = 0.0;
  for (int i = 0; i <= INTERVALS; ++i) {
    const double s = (double)i / INTERVALS, weight = (i == 0 || i == INTERVALS ? 1.0 : i % 2 ? 4.0 : 2.0) * 0.1 / (3 * INTERVALS);
    const double d[2] = {0.1 * s - circle[0], 0.0 - circle[1]}, norm = hypot(d[0], d[1]);
    for (int k = 0; k < 2; ++k) gap[k] += weight * (1 - s) * d[k] / norm * (norm - 1.0);
  }
}

static void hover(void) {
  stickslip_interface *interface = NULL;
  double sums[N1 * STICKSLIP_SUMS_PER_NODE], expected[2];
  CHECK_OK(create(STICKSLIP_MODEL_PLANE, STICKSLIP_BASIS_STANDARD, STICKSLIP_SHAPE_SPHERE, 1.0, &interface));
  CHECK_OK(stickslip_interface_sums(interface, x1, circle, sums));
  gap_over_circle(expected);
  CHECK_NEAR(sums[0], 0.05, ROUNDING);
  for (int k = 0; k < 2; ++k) CHECK_NEAR(sums[1 + k], expected[k], RULE);
  CHECK_OK(stickslip_interface_destroy(&interface));
}

/* Every column of the tangent against a difference of the residual, and back to the history of before. */
static void differentiate(int32_t model, int32_t basis, int32_t shape, double radius) {
  stickslip_interface *interface = NULL;
  double z[ALL], r[2][ALL], k[ALL * ALL] = {0}, values[4 * ALL * ALL], force2[X2];
  int64_t row[4 * ALL * ALL], column[4 * ALL * ALL], count;
  CHECK_OK(create(model, basis, shape, radius, &interface));
  for (int i = 0; i < ALL; ++i) z[i] = i < X1 ? x1[i] : i % 2 ? -1.0 : 0.25 * (i - X1);
  z[0] += 0.01, z[2] += 0.005, z[3] -= 0.001, z[5] += 0.0002, z[4] += 0.02;
  const double *const x2 = two.coordinates;
  CHECK_OK(stickslip_interface_tangent_coo(interface, z, x2, z + X1, NULL, 4 * ALL * ALL, row, column, values, &count));
  for (int64_t e = 0; e < count; ++e) k[row[e] * ALL + column[e]] += values[e];
  const double largest = max_abs(k, ALL * ALL);
  for (int j = 0; j < ALL; ++j) {
    const double at = z[j];
    for (int side = 0; side < 2; ++side) {
      z[j] = at + (side ? -STEP : STEP);
      CHECK_OK(stickslip_interface_residual(interface, z, x2, z + X1, NULL, r[side], force2, r[side] + X1));
    }
    z[j] = at;
    for (int i = 0; i < ALL; ++i) CHECK_NEAR(k[i * ALL + j], (r[0][i] - r[1][i]) / (2 * STEP), DIFFERENCES * largest);
  }
  CHECK_OK(stickslip_interface_commit(interface, z, x2, z + X1, NULL));
  CHECK_OK(stickslip_interface_rollback(interface));
  CHECK_OK(stickslip_interface_destroy(&interface));
}

int main(void) {
  round_shapes();
  for (int32_t basis = STICKSLIP_BASIS_STANDARD; basis <= STICKSLIP_BASIS_DUAL; ++basis) {
    for (int32_t model = STICKSLIP_MODEL_PLANE; model <= STICKSLIP_MODEL_AXISYMMETRIC; ++model) {
      press(model, basis);
      differentiate(model, basis, STICKSLIP_SHAPE_PLANE, 0.0);
      differentiate(model, basis, STICKSLIP_SHAPE_SPHERE, 1.0);
      differentiate(model, basis, STICKSLIP_SHAPE_CYLINDER, 1.0);
    }
  }
  hover();

  stickslip_interface *interface = NULL;
  const int32_t model = STICKSLIP_MODEL_PLANE;
  two.n_nodes = 4;
  CHECK_REFUSED(create(model, 0, STICKSLIP_SHAPE_PLANE, 0.0, &interface), STICKSLIP_INVALID_SIZE,
                "an analytic surface has 3 nodes");
  two.n_nodes = 3;
  CHECK_REFUSED(create(model, 0, STICKSLIP_SHAPE_SPHERE, 0.0, &interface), STICKSLIP_INVALID_VALUE, "options.radius is 0");
  CHECK(interface == NULL);

  /* A frame that is no rigid motion of the first one is refused, and nothing is lost. */
  CHECK_OK(create(model, 0, STICKSLIP_SHAPE_SPHERE, 1.0, &interface));
  double lambda[X1] = {0, -1, 0, -1, 0, -1}, r[2][2 * X1 + X2], bent[X2];
  memcpy(bent, circle, sizeof bent);
  bent[2] += 0.1;
  CHECK_OK(stickslip_interface_residual(interface, x1, circle, lambda, NULL, r[0], r[0] + X1, r[0] + X1 + X2));
  CHECK_REFUSED(stickslip_interface_residual(interface, x1, bent, lambda, NULL, r[1], r[1] + X1, r[1] + X1 + X2),
                STICKSLIP_INVALID_VALUE, "must move as a rigid body");
  CHECK_OK(stickslip_interface_residual(interface, x1, circle, lambda, NULL, r[1], r[1] + X1, r[1] + X1 + X2));
  CHECK(memcmp(r[0], r[1], sizeof r[0]) == 0);
  CHECK_OK(stickslip_interface_destroy(&interface));
  return 0;
}
