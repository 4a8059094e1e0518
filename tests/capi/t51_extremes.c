/* Sizes and numbers far from 1. Units must not matter: scaling by a power of two scales the results exactly, until
 * squares of lengths leave the range of doubles; from there on the answer is a refusal. */
#include "calls.h"

static weights base, scaled;

static int exactly_scaled(const double *v, const double *reference, int n, int power) {
  for (int k = 0; k < n; ++k) {
    if (v[k] != ldexp(reference[k], power)) return 0;
  }
  return 1;
}

static void units(void) {
  static element e;
  element_init(&e);
  pair_weights(&e.pair, &base);
  double gap[12], areas[4], base_areas[4];
  CHECK_OK(call_gap(&e));
  memcpy(gap, e.gap, sizeof gap);
  CHECK_OK(stickslip_facet_geometry(4, quad2, NULL, base_areas));
  /* 2^240 is 1e72. */
  for (int power = -240; power <= 240; power += 10) {
    element_init(&e);
    for (int i = 0; i < 12; ++i) {
      e.x1[i] = ldexp(quad1[i], power);
      e.x2[i] = ldexp(quad2[i], power);
    }
    pair_weights(&e.pair, &scaled);
    CHECK(exactly_scaled(scaled.ab, base.ab, 16, 2 * power) && exactly_scaled(scaled.ac, base.ac, 16, 2 * power));
    CHECK(exactly_scaled(scaled.dab, base.dab, 16 * 24, power) && exactly_scaled(scaled.dac, base.dac, 16 * 24, power));
    e.w = scaled;
    CHECK_OK(call_gap(&e));
    CHECK(exactly_scaled(e.gap, gap, 12, 3 * power));
    CHECK_OK(stickslip_facet_geometry(4, e.x2, NULL, areas));
    CHECK(exactly_scaled(areas, base_areas, 4, 2 * power));
  }
  for (int power = 260; power <= 1000; power += 20) {
    for (int sign = -1; sign <= 1; sign += 2) {
      element_init(&e);
      for (int i = 0; i < 12; ++i) {
        e.x1[i] = ldexp(quad1[i], sign * (power + 10));
        e.x2[i] = ldexp(quad2[i], sign * (power + 10));
      }
      const int32_t status = call_weights(&e);
      CHECK(status == STICKSLIP_DEGENERATE_FACET || status == STICKSLIP_DUPLICATE_NODE);
      element_untouched(&e);
    }
  }
}

/* The tangential part of a node in any unit of stress, from the smallest numbers to the largest. */
static void stresses(void) {
  static element e;
  for (int power = -900; power <= 900; power += 100) {
    element_init(&e);
    e.node.lambda[0] = ldexp(3.0, power);
    e.node.lambda[1] = ldexp(4.0, power);
    e.node.lambda[2] = ldexp(-2.0, power);
    e.node.augmentation = ldexp(1.0, power);
    CHECK_OK(call_respond(&e));
    CHECK(e.responses[3].state == STICKSLIP_STATE_SLIP);
    const double *p = e.responses[3].traction;
    CHECK_NEAR(ldexp(p[0], -power), 0.6, 1e-15);
    CHECK_NEAR(ldexp(p[1], -power), 0.8, 1e-15);
    CHECK(p[2] == e.node.lambda[2]);
  }
  /* A coefficient of friction as large as it gets: stick, not an overflow. */
  element_init(&e);
  e.node.mu = 1.7e308;
  e.node.lambda[0] = 1e6;
  CHECK_OK(call_respond(&e));
  CHECK(e.responses[3].state == STICKSLIP_STATE_STICK);
}

/* No limit to the search distance, however it is said, on facets along the axes. */
static void distances(void) {
  const double table[12] = {-1, -1, 0, 2, -1, 0, 2, 2, 0, -1, 2, 0};
  const int64_t offsets[2] = {0, 4}, nodes[4] = {0, 1, 2, 3};
  int64_t equations[36];
  for (int i = 0; i < 36; ++i) equations[i] = i;
  const stickslip_surface one = {sizeof one, 4, 1, quad1, offsets, nodes, equations, equations + 24, NULL};
  const stickslip_surface two = {sizeof two, 4, 1, table, offsets, nodes, equations + 12, NULL, NULL};
  const double far[] = {1e-300, 1.0, 1e30, 1e155, 1e300, 1.7e308};
  for (int k = 0; k < COUNT(far); ++k) {
    stickslip_interface *interface = NULL;
    stickslip_options options;
    stickslip_method method;
    double coverage[4], lambda[12] = {0.0};
    stickslip_states out;
    CHECK_OK(stickslip_options_init(&options, sizeof options));
    CHECK_OK(stickslip_options_paper(&options));
    method = *options.method, options.method = &method;
    method.augmentation = 1.0;
    options.search_distance = far[k];
    CHECK_OK(stickslip_interface_create(&one, &two, &options, &interface));
    memset(&out, 0, sizeof out);
    out.struct_size = sizeof out;
    out.coverage = coverage;
    CHECK_OK(stickslip_interface_states(interface, quad1, table, lambda, NULL, &out));
    for (int a = 0; a < 4; ++a) CHECK_NEAR(coverage[a], 0.25, 1e-15);
    CHECK_OK(stickslip_interface_destroy(&interface));
  }
}

/* All nodes at one place, or far away, or one node astray: refused or out of contact, never a number that
 * is not one. */
static void positions(void) {
  static handle h;
  const double factors[] = {0.0, 5e-324, 1e-300, 1e-160, 1e8, 1e16, 1e30, 1e75};
  for (int all = 0; all < 2; ++all) {
    for (int side = 0; side < 2; ++side) {
      for (int k = 0; k < COUNT(factors); ++k) {
        handle_init(&h);
        double *x = side == 0 ? h.s.x1 : h.s.x2;
        const int n = side == 0 ? X1 : X2;
        for (int i = 0; i < n; ++i) {
          if (all || i / 3 == 4) x[i] *= factors[k];
        }
        if (call_interface_residual(&h) == STICKSLIP_OK) {
          CHECK(isfinite(max_abs(h.force1, X1)) && isfinite(max_abs(h.force2, X2)) && isfinite(max_abs(h.rows, X1)));
          CHECK_OK(call_interface_coo(&h));
          CHECK(isfinite(max_abs(h.values, (int)h.count)));
        } else {
          handle_untouched(&h);
        }
        if (call_interface_commit(&h) != STICKSLIP_OK) {
          handle_fill(&h);
          handle_untouched(&h);
        }
        scene_destroy(&h.s);
      }
    }
  }
}

int main(void) {
  units();
  stresses();
  distances();
  positions();
  return 0;
}
