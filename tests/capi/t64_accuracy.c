/* What accuracy may cost: rules, points in place of cells, frozen tangents. The defaults are 0; each choice acts, says
 * so, and costs what it should; every rule keeps the balance of forces, not every one meets a patch test. */
#include "scene.h"

/* Sums of a few hundred products of numbers of size 1. */
static const double ROUNDING = 1e-13;
/* Rows of facets that are parallelograms: what a rule of degree 1 or 2 leaves, points across mortar edges. */
static const double COARSE = 1e-4;

static int says(scene *s, const char *words) {
  char text[1000];
  CHECK_OK(stickslip_interface_effects(s->interface, text, sizeof text));
  CHECK(strlen(text) < sizeof text - 1); /* not cut */
  return strstr(text, words) != NULL;
}

static double difference(const double *a, const double *b) {
  double worst = 0.0;
  for (int i = 0; i < UNKNOWNS; ++i) worst = fmax(worst, fabs(a[i] - b[i]));
  return worst;
}

int main(void) {
  static scene s;
  static triplets t;
  double exact[UNKNOWNS], r[UNKNOWNS];
  stickslip_counters counters;
  counters.struct_size = sizeof counters;

  scene_init(&s);
  CHECK(s.method.quadrature == STICKSLIP_QUADRATURE_DEGREE_5 && s.method.element_points == 0);
  CHECK(s.method.integration == STICKSLIP_INTEGRATION_SEGMENTS && s.method.tangent == STICKSLIP_TANGENT_EXACT);
  scene_create(&s);
  scene_residual(&s, exact);
  scene_tangent(&s, &t);
  const int64_t entries = t.n;
  CHECK(says(&s, "7 points a triangle."));
  scene_destroy(&s);

  /* Facets are parallelograms: rules from degree 4 on agree. All keep forces in balance. */
  const struct {
    int32_t rule;
    const char *words;
    int agrees;
  } rules[] = {
      {STICKSLIP_QUADRATURE_DEGREE_1, "1 points a triangle, not exact on any facet", 0},
      {STICKSLIP_QUADRATURE_DEGREE_2, "3 points a triangle, not exact on any facet", 0},
      {STICKSLIP_QUADRATURE_DEGREE_4, "6 points a triangle.", 1},
      {STICKSLIP_QUADRATURE_DEGREE_6, "12 points a triangle.", 1},
      {STICKSLIP_QUADRATURE_DEGREE_10, "36 points a triangle.", 1},
  };
  for (int k = 0; k < COUNT(rules); ++k) {
    scene_init(&s);
    s.method.quadrature = rules[k].rule;
    scene_create(&s);
    scene_residual(&s, r);
    CHECK(says(&s, rules[k].words));
    CHECK(rules[k].agrees ? difference(r, exact) < ROUNDING : difference(r, exact) > COARSE);
    for (int i = 0; i < 3; ++i) {
      double sum = 0.0;
      for (int n = 0; n < N1 + N2; ++n) sum += r[3 * n + i];
      CHECK(fabs(sum) < ROUNDING);
    }
    scene_destroy(&s);
  }

  /* Points: nothing is clipped, more points come closer; wholly covered facets leave hybrid no point. */
  double error[2];
  const int32_t by_points[] = {STICKSLIP_INTEGRATION_ELEMENTS, STICKSLIP_INTEGRATION_HYBRID};
  for (int i = 0; i < COUNT(by_points); ++i) {
    for (int k = 0; k < 2; ++k) {
      scene_init(&s);
      s.method.integration = by_points[i];
      s.method.element_points = k ? 10 : 2;
      scene_create(&s);
      scene_residual(&s, r);
      error[k] = difference(r, exact);
      CHECK_OK(stickslip_interface_counters(s.interface, &counters));
      CHECK(counters.pairs_integrated > 0 && counters.pairs_clipped == 0);
      CHECK(says(&s, k ? "10 x 10 points" : "2 x 2 points") && says(&s, "patch tests fail"));
      scene_destroy(&s);
    }
    CHECK(error[0] > COARSE && error[1] < 0.5 * error[0] && error[1] > ROUNDING);
  }
  scene_init(&s);
  s.method.integration = STICKSLIP_INTEGRATION_ELEMENTS;
  scene_create(&s);
  CHECK(says(&s, "4 x 4 points"));
  scene_destroy(&s);

  /* Tangents: frozen weights have no blocks of forces by positions; the answer is the same. */
  for (int32_t tangent = STICKSLIP_TANGENT_FROZEN_WEIGHTS; tangent <= STICKSLIP_TANGENT_FROZEN_NORMALS; ++tangent) {
    scene_init(&s);
    s.method.tangent = tangent;
    scene_create(&s);
    scene_residual(&s, r);
    CHECK(memcmp(r, exact, sizeof r) == 0);
    scene_tangent(&s, &t);
    CHECK(tangent == STICKSLIP_TANGENT_FROZEN_WEIGHTS ? t.n < entries : t.n == entries);
    CHECK_OK(stickslip_interface_counters(s.interface, &counters));
    CHECK((counters.pairs_linearised == 0) == (tangent == STICKSLIP_TANGENT_FROZEN_WEIGHTS));
    CHECK(says(&s, "not quadratic"));
    scene_destroy(&s);
  }

  /* A pair alone: points that fall on the mortar facet. The unit square over its lower left quarter. */
  const double x1[12] = {0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0}, x2[12] = {-1, -1, 0, 0.5, -1, 0, 0.5, 0.5, 0, -1, 0.5, 0};
  double ab[16], sum = 0.0;
  stickslip_pair pair = {sizeof pair, 4, 4, x1, x2, STICKSLIP_QUADRATURE_DEGREE_5, STICKSLIP_LAYOUT_ROW_MAJOR, 2,
                          NULL, 0, STICKSLIP_MODEL_SOLID, 0.0};
  CHECK_OK(stickslip_pair_weights(&pair, ab, NULL, NULL, NULL));
  for (int k = 0; k < 16; ++k) sum += ab[k];
  CHECK(fabs(sum - 0.25) < ROUNDING); /* one point of four */
  return 0;
}
