/* Quadratic facets in a handle: one of eight nodes over a linear one, under a constant pressure. */
#include "check.h"

#include <stickslip.h>
#include <string.h>

enum { NODES = 8, CORNERS = 4, X1 = 3 * NODES, X2 = 12 };
/* Rounding of a dozen products. */
#define ROUNDING 1e-14

static const double x1[X1] = {0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 0, 0.5, 0, 0.5, 1, 0, 1, 0.5, 0, 0.5, 0, 0};
static const double x2[X2] = {-1, -1, 0, 2, -1, 0, 2, 2, 0, -1, 2, 0};
static const int64_t offsets1[2] = {0, NODES}, nodes1[NODES] = {0, 1, 2, 3, 4, 5, 6, 7}, offsets2[2] = {0, 4},
                     nodes2[4] = {0, 1, 2, 3};
static int64_t equations[X1 + X2 + X1];

static int32_t create(int32_t space, int32_t basis, int64_t with_multipliers, stickslip_interface **interface) {
  for (int64_t k = 0; k < X1 + X2 + X1; ++k) equations[k] = k < X1 + X2 + 3 * with_multipliers ? k : -1;
  const stickslip_surface one = {.struct_size = sizeof one, .n_nodes = NODES, .n_facets = 1, .coordinates = x1,
      .facet_offsets = offsets1, .facet_nodes = nodes1, .equations = equations, .multiplier_equations = equations + X1 + X2};
  const stickslip_surface two = {.struct_size = sizeof two, .n_nodes = 4, .n_facets = 1, .coordinates = x2,
      .facet_offsets = offsets2, .facet_nodes = nodes2, .equations = equations + X1};
  stickslip_options options;
  stickslip_method method;
  CHECK_OK(stickslip_options_init(&options, sizeof options));
  CHECK_OK(stickslip_options_paper(&options));
  method = *options.method, options.method = &method;
  options.modulus = 1000.0, options.mu = 0.3, method.multiplier_space = space, method.multiplier_basis = basis;
  return stickslip_interface_create(&one, &two, &options, interface);
}

/* A pressure of 1 gives the nodal forces of the quadratic functions, whatever the multipliers are. */
static void press(int32_t space, int32_t basis, int multipliers) {
  stickslip_interface *interface = NULL;
  double lambda[X1] = {0}, force1[X1], force2[X2], rows[X1], area[NODES], coverage[NODES], total = 0.0;
  CHECK_OK(create(space, basis, multipliers, &interface));
  for (int a = 0; a < multipliers; ++a) lambda[3 * a + 2] = -1.0;
  CHECK_OK(stickslip_interface_residual(interface, x1, x2, lambda, NULL, force1, force2, rows));
  for (int a = 0; a < NODES; ++a) CHECK_NEAR(force1[3 * a + 2], a < CORNERS ? 1.0 / 12 : -1.0 / 3, ROUNDING);
  for (int c = 0; c < 4; ++c) total += force2[3 * c + 2];
  CHECK_NEAR(total, 1.0, ROUNDING);
  stickslip_states states = {.struct_size = sizeof states, .area = area, .coverage = coverage};
  CHECK_OK(stickslip_interface_states(interface, x1, x2, lambda, NULL, &states));
  total = 0.0;
  for (int a = 0; a < NODES; ++a) {
    CHECK_NEAR(coverage[a], a < multipliers ? area[a] : 0.0, ROUNDING);
    total += coverage[a];
  }
  CHECK_NEAR(total, 1.0, ROUNDING);
  stickslip_report report = {.struct_size = sizeof report};
  CHECK_OK(stickslip_interface_report(interface, x1, x2, &report));
  CHECK(report.nodes_full == multipliers && report.nodes_none == 0);
  CHECK_OK(stickslip_interface_destroy(&interface));
}

int main(void) {
  press(STICKSLIP_SPACE_CORNER, STICKSLIP_BASIS_STANDARD, CORNERS);
  press(STICKSLIP_SPACE_CORNER, STICKSLIP_BASIS_DUAL, CORNERS);
  press(STICKSLIP_SPACE_SUB, STICKSLIP_BASIS_STANDARD, NODES);
  stickslip_interface *interface = NULL;
  CHECK_REFUSED(create(STICKSLIP_SPACE_CORNER, STICKSLIP_BASIS_DUAL, NODES, &interface), STICKSLIP_INVALID_VALUE, "node 4");
  CHECK_REFUSED(create(STICKSLIP_SPACE_SUB, STICKSLIP_BASIS_DUAL, NODES, &interface), STICKSLIP_UNSUPPORTED, "dual");
  CHECK_REFUSED(create(2, STICKSLIP_BASIS_STANDARD, NODES, &interface), STICKSLIP_INVALID_VALUE, "multiplier_space");
  CHECK(interface == NULL);
  return 0;
}
