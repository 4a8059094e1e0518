/* Lines of plane and axisymmetric models in a handle: two components a node in every array. Two non-mortar lines over one with a node
 * in the middle, under a constant pressure. */
#include "check.h"

enum { N1 = 3, N2 = 3, X1 = 2 * N1, X2 = 2 * N2, ALL = 2 * X1 + X2 };
/* Rounding of a dozen products. */
#define ROUNDING 1e-14
#define DIFFERENCES 1e-7
#define STEP 1e-6
static const double two_pi = 6.283185307179586;

/* The body of nonmortar is above, that of mortar below: seen from outside, lines run with the body to their left. */
static const double x1[X1] = {0, 0, 0.4, 0, 1, 0}, x2[X2] = {2, 0, 0, 0, 1, 0};
static const int64_t offsets1[3] = {0, 2, 4}, nodes1[4] = {0, 1, 1, 2}, offsets2[2] = {0, 3}, nodes2[3] = {0, 1, 2};
static int64_t equations[ALL];

static int32_t create(int32_t model, double thickness, int32_t basis, const double *x, stickslip_interface **interface) {
  for (int64_t k = 0; k < ALL; ++k) equations[k] = k;
  const stickslip_surface one = {.struct_size = sizeof one, .n_nodes = N1, .n_facets = 2, .coordinates = x,
      .facet_offsets = offsets1, .facet_nodes = nodes1, .equations = equations, .multiplier_equations = equations + X1 + X2};
  const stickslip_surface two = {.struct_size = sizeof two, .n_nodes = N2, .n_facets = 1, .coordinates = x2,
      .facet_offsets = offsets2, .facet_nodes = nodes2, .equations = equations + X1};
  stickslip_options options;
  stickslip_method method;
  CHECK_OK(stickslip_options_init(&options, sizeof options));
  CHECK_OK(stickslip_options_paper(&options));
  method = *options.method, options.method = &method;
  CHECK(options.model == STICKSLIP_MODEL_SOLID && options.thickness == 0.0);
  options.modulus = 1000.0, options.mu = 0.3, options.model = model, options.thickness = thickness;
  method.multiplier_basis = basis;
  return stickslip_interface_create(&one, &two, &options, interface);
}

/* A pressure of 1 gives its consistent loads on both sides. */
static void press(int32_t model, double thickness, int32_t basis) {
  stickslip_interface *interface = NULL;
  double lambda[X1 + 1], force1[X1 + 1], force2[X2 + 1], rows[X1 + 1], area[N1], normal[X1 + 1], traction[X1 + 1], slip[X1 + 1];
  CHECK_OK(create(model, thickness, basis, x1, &interface));
  for (int a = 0; a < N1; ++a) lambda[2 * a] = 0.0, lambda[2 * a + 1] = -1.0;
  FILL(force1), FILL(force2), FILL(rows), FILL(normal), FILL(traction), FILL(slip);
  CHECK_OK(stickslip_interface_residual(interface, x1, x2, lambda, NULL, force1, force2, rows));
  stickslip_states states = {.struct_size = sizeof states, .area = area, .normal = normal, .traction = traction, .slip = slip};
  CHECK_OK(stickslip_interface_states(interface, x1, x2, lambda, NULL, &states));
  /* Two components a node, and no number behind them. */
  CHECK_UNTOUCHED(force1[X1]), CHECK_UNTOUCHED(force2[X2]), CHECK_UNTOUCHED(rows[X1]);
  CHECK_UNTOUCHED(normal[X1]), CHECK_UNTOUCHED(traction[X1]), CHECK_UNTOUCHED(slip[X1]);
  const int ring = model == STICKSLIP_MODEL_AXISYMMETRIC;
  const double rho = thickness == 0.0 ? 1.0 : thickness;
  const double plane[N1] = {0.2, 0.5, 0.3}, rings[N1] = {0.08 / 3, 0.7 / 3, 0.24};
  double total = 0.0, whole = 0.0;
  for (int a = 0; a < N1; ++a) {
    CHECK_NEAR(area[a], ring ? two_pi * rings[a] : rho * plane[a], ROUNDING);
    CHECK_NEAR(force1[2 * a + 1], -area[a], ROUNDING);
    CHECK_NEAR(force1[2 * a], 0.0, ROUNDING);
    CHECK_NEAR(normal[2 * a + 1], 1.0, ROUNDING);
    CHECK_NEAR(traction[2 * a + 1], -1.0, ROUNDING);
    CHECK_NEAR(max_abs(rows, X1), 0.0, ROUNDING);
    whole += area[a];
  }
  for (int c = 0; c < N2; ++c) total += force2[2 * c + 1];
  CHECK_NEAR(whole, ring ? two_pi / 2 : rho, ROUNDING);
  CHECK_NEAR(total, whole, ROUNDING);
  stickslip_report report = {.struct_size = sizeof report};
  CHECK_OK(stickslip_interface_report(interface, x1, x2, &report));
  CHECK(report.nodes_full == N1 && report.nodes_none == 0);
  double initial[X1 + 1];
  FILL(initial);
  CHECK_OK(stickslip_interface_initial_multipliers(interface, initial));
  CHECK(initial[1] < 0.0 && initial[0] == 0.0);
  CHECK_UNTOUCHED(initial[X1]);
  CHECK_OK(stickslip_interface_destroy(&interface));
}

/* Every column of the tangent against a difference of the residual, at a point where nodes stick and slip. */
static void differentiate(int32_t model, int32_t basis) {
  stickslip_interface *interface = NULL;
  double z[ALL], r[2][ALL], k[ALL * ALL] = {0}, values[4 * ALL * ALL];
  int64_t row[4 * ALL * ALL], column[4 * ALL * ALL], count;
  CHECK_OK(create(model, 0.0, basis, x1, &interface));
  for (int i = 0; i < ALL; ++i) z[i] = i < X1 ? x1[i] : i < X1 + X2 ? x2[i - X1] : i % 2 ? -1.0 : 0.25 * (i - X1 - X2);
  for (int i = 0; i < X1 + X2; i += 2) z[i] += 0.5; /* no node reaches the axis */
  z[0] += 0.05, z[2] += 0.04, z[3] -= 0.001, z[5] += 0.002, z[4] += 0.06;
  CHECK_OK(stickslip_interface_tangent_coo(interface, z, z + X1, z + X1 + X2, NULL, 4 * ALL * ALL, row, column, values, &count));
  for (int64_t e = 0; e < count; ++e) k[row[e] * ALL + column[e]] += values[e];
  const double largest = max_abs(k, ALL * ALL);
  for (int j = 0; j < ALL; ++j) {
    const double at = z[j];
    for (int side = 0; side < 2; ++side) {
      z[j] = at + (side ? -STEP : STEP);
      CHECK_OK(stickslip_interface_residual(interface, z, z + X1, z + X1 + X2, NULL, r[side], r[side] + X1, r[side] + X1 + X2));
    }
    z[j] = at;
    for (int i = 0; i < ALL; ++i) CHECK_NEAR(k[i * ALL + j], (r[0][i] - r[1][i]) / (2 * STEP), DIFFERENCES * largest);
  }
  CHECK_OK(stickslip_interface_commit(interface, z, z + X1, z + X1 + X2, NULL));
  CHECK_OK(stickslip_interface_rollback(interface));
  CHECK_OK(stickslip_interface_destroy(&interface));
}

int main(void) {
  for (int32_t basis = STICKSLIP_BASIS_STANDARD; basis <= STICKSLIP_BASIS_DUAL; ++basis) {
    press(STICKSLIP_MODEL_PLANE, 0.0, basis);
    press(STICKSLIP_MODEL_PLANE, 0.7, basis);
    press(STICKSLIP_MODEL_AXISYMMETRIC, 0.0, basis);
    differentiate(STICKSLIP_MODEL_PLANE, basis);
    differentiate(STICKSLIP_MODEL_AXISYMMETRIC, basis);
  }
  const double behind[X1] = {-0.1, 0, 0.4, 0, 1, 0};
  stickslip_interface *interface = NULL;
  CHECK_REFUSED(create(STICKSLIP_MODEL_AXISYMMETRIC, 0.0, 0, behind, &interface), STICKSLIP_INVALID_VALUE, "node 0 has r = -1e-1");
  CHECK_REFUSED(create(STICKSLIP_MODEL_AXISYMMETRIC, 1.0, 0, x1, &interface), STICKSLIP_INVALID_VALUE, "options.thickness");
  CHECK(interface == NULL);
  return 0;
}
