/* Weakly covered nodes that neighbours carry: which and how many, balance, the tangent along one direction against
 * differences, the pattern, refusals. */
#include "scene.h"

static scene s;
static triplets t;
static char entry[UNKNOWNS][UNKNOWNS];

/* Committed where nodes hang over, then moved a little. */
static void hang_over(double weak_coverage, int32_t form) {
  scene_init(&s);
  CHECK(s.method.weak_coverage == 0.0);
  s.method.weak_coverage = weak_coverage;
  s.method.form = form;
  scene_create(&s);
  scene_slide(&s, 0.9);
  scene_commit(&s);
  scene_slide(&s, 0.04);
}

static stickslip_counters counters(void) {
  stickslip_counters c;
  memset(&c, 0, sizeof c);
  c.struct_size = sizeof c;
  CHECK_OK(stickslip_interface_counters(s.interface, &c));
  return c;
}

/* The state of the scene, moved by h along a direction of all unknowns. */
static void residual_along(const double *d, double h, double r[UNKNOWNS]) {
  scene moved = s;
  for (int k = 0; k < X1; ++k) moved.x1[k] += h * d[k];
  for (int k = 0; k < X2; ++k) moved.x2[k] += h * d[X1 + k];
  for (int k = 0; k < X1; ++k) moved.lambda[k] += h * d[X1 + X2 + k];
  scene_residual(&moved, r);
}

static void carried(int32_t form) {
  static double own[UNKNOWNS], r[UNKNOWNS], plus[UNKNOWNS], minus[UNKNOWNS], d[UNKNOWNS];
  hang_over(0.0, form);
  scene_residual(&s, own);
  CHECK(counters().nodes_carried == 0);
  scene_destroy(&s);

  hang_over(0.5, form);
  scene_residual(&s, r);
  const stickslip_counters c = counters();
  CHECK(c.nodes_carried > 0 && memcmp(r, own, sizeof r) != 0);
  CHECK(c.nodes_carried + c.nodes_frictional + c.nodes_frictionless + c.nodes_new + c.nodes_tied + c.nodes_uncovered +
            c.nodes_left_out == N1);
  double force[3] = {0.0, 0.0, 0.0}, scale = 0.0;
  for (int k = 0; k < X1 + X2; ++k) {
    force[k % 3] += r[k];
    scale += fabs(r[k]);
  }
  for (int i = 0; i < 3; ++i) CHECK_NEAR(force[i] / scale, 0.0, 1e-14);

  /* Step and tolerance as of central differences in double precision; facets of size 0.5. */
  const double h = 1e-6, tolerance = 1e-8;
  uint64_t random = 3;
  for (int k = 0; k < UNKNOWNS; ++k) d[k] = random_number(&random);
  scene_tangent(&s, &t);
  residual_along(d, h, plus);
  residual_along(d, -h, minus);
  double largest = 0.0, product[UNKNOWNS] = {0.0};
  for (int64_t e = 0; e < t.n; ++e) product[t.rows[e]] += t.values[e] * d[t.columns[e]];
  for (int k = 0; k < UNKNOWNS; ++k) largest = larger(largest, fabs(product[k]));
  for (int k = 0; k < UNKNOWNS; ++k) CHECK_NEAR((plus[k] - minus[k]) / (2.0 * h) / largest, product[k] / largest, tolerance);

  int64_t count;
  CHECK_OK(stickslip_interface_pattern_coo(s.interface, s.x1, s.x2, MOST_ENTRIES, t.rows, t.columns, &count));
  memset(entry, 0, sizeof entry);
  for (int64_t e = 0; e < count; ++e) entry[t.rows[e]][t.columns[e]] = 1;
  scene_slide(&s, 0.05);
  scene_tangent(&s, &t);
  for (int64_t e = 0; e < t.n; ++e) CHECK(entry[t.rows[e]][t.columns[e]]);
  scene_destroy(&s);
}

static void refusals(void) {
  const double wrong[] = {-1e-12, 1.0 + 1e-12, 2.0};
  for (int k = 0; k < COUNT(wrong); ++k) {
    scene_init(&s);
    s.method.weak_coverage = wrong[k];
    CHECK_REFUSED(stickslip_interface_create(&s.nonmortar, &s.mortar, &s.options, &s.interface),
                  STICKSLIP_INVALID_VALUE, "method.weak_coverage");
  }
  static double sums[STICKSLIP_SUMS_PER_NODE * N1], r[UNKNOWNS];
  hang_over(0.5, STICKSLIP_FORM_MULTIPLIER);
  CHECK_OK(stickslip_interface_sums(s.interface, s.x1, s.x2, sums));
  FILL(r);
  CHECK_REFUSED(stickslip_interface_residual(s.interface, s.x1, s.x2, s.lambda, sums, r, r + X1, r + X1 + X2),
                STICKSLIP_UNSUPPORTED, "weak_coverage");
  CHECK_UNTOUCHED(r);
  scene_destroy(&s);
}

int main(void) {
  carried(STICKSLIP_FORM_MULTIPLIER);
  carried(STICKSLIP_FORM_AUGMENTED);
  refusals();
  return 0;
}
