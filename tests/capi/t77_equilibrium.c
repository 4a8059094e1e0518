/* How far a point is from contact equilibrium: independent of augmentation, row scale and form; one node by itself;
 * several handles with sums; what is refused. */
#include "scene.h"

/* Rounding of a few operations; the positions' own is taken off by the library, 8 eps of 2 times the modulus over h. */
static const double ROUNDING = 1e-11;
/* Of the order of the multipliers times h over the gaps, so that neither hides the other. */
static const double MODULUS = 5.0;

static stickslip_equilibrium measured(const scene *s, double modulus, double least) {
  stickslip_equilibrium e;
  memset(&e, 0, sizeof e);
  e.struct_size = sizeof e;
  e.modulus = modulus;
  e.least_traction = least;
  CHECK_OK(stickslip_interface_equilibrium(s->interface, s->x1, s->x2, s->lambda, NULL, &e));
  CHECK(e.struct_size == sizeof e && e.modulus == modulus && e.least_traction == least);
  return e;
}

/* The same bits, but for what asks which nodes slip: far from equilibrium the augmentation decides that. */
static int same(stickslip_equilibrium found, stickslip_equilibrium expected) {
  found.lag_force = expected.lag_force;
  found.lag_force_scale = expected.lag_force_scale;
  return memcmp(&found, &expected, sizeof found) == 0;
}

/* Equal bits at a point with all states, whatever the method's parameters. */
static void independence(void) {
  static scene s, other;
  static const double augmentations[] = {1e-9, 15.0, 1e7};
  scene_init(&s);
  scene_create(&s);
  const stickslip_equilibrium expected = measured(&s, MODULUS, 0.0);
  CHECK(expected.traction > 0.01 * expected.traction_scale && expected.gap + expected.slip > 0.0);
  CHECK(expected.traction_node >= 0 && expected.traction_node < N1 && expected.gap_scale > 0.0);
  for (int k = 0; k < COUNT(augmentations); ++k) {
    for (int form = 0; form < 2; ++form) {
      double r[N1];
      scene_init(&other);
      other.method.augmentation = augmentations[k];
      other.method.form = form;
      other.method.row_scale = form ? STICKSLIP_ROW_SCALE_NONE : STICKSLIP_ROW_SCALE_FORCE;
      scene_create(&other);
      stickslip_equilibrium found = measured(&other, MODULUS, 0.0);
      CHECK(same(found, expected));
      for (int a = 0; a < N1; ++a) r[a] = pow(10.0, a);
      CHECK_OK(stickslip_interface_set_augmentation(other.interface, r));
      found = measured(&other, MODULUS, 0.0);
      CHECK(same(found, expected));
      scene_destroy(&other);
    }
  }
  /* A larger traction of an earlier step loosens all scales; without a modulus lengths count against the facet. */
  const stickslip_equilibrium loose = measured(&s, MODULUS, 100.0), bare = measured(&s, 0.0, 0.0);
  CHECK(loose.traction_scale == 100.0 && loose.gap_scale > expected.gap_scale);
  CHECK_NEAR(bare.gap_scale * bare.traction_scale, expected.gap_scale * MODULUS, bare.gap_scale * bare.traction_scale);
  CHECK(bare.traction_scale == expected.traction_scale);
  scene_destroy(&s);
}

/* Nodes counted from 1; a node that lacks something; a point that lacks nothing. */
static void solution(void) {
  static scene s;
  scene_init_base(&s, 1);
  scene_create(&s);
  memcpy(s.x1, s.reference1, sizeof s.x1);
  double normal[X1];
  stickslip_states states;
  memset(&states, 0, sizeof states);
  states.struct_size = sizeof states;
  states.normal = normal;
  CHECK_OK(stickslip_interface_states(s.interface, s.x1, s.x2, s.lambda, NULL, &states));
  for (int k = 0; k < X1; ++k) s.lambda[k] = -2.0 * normal[k];
  stickslip_equilibrium e = measured(&s, MODULUS, 0.0);
  CHECK(e.gap == 0.0 && e.traction == 0.0 && e.slip == 0.0 && e.traction_scale >= 2.0 - ROUNDING);
  CHECK(e.gap_node == -1 && e.traction_node == -1 && e.slip_node == -1);
  /* Tension at the fifth of them. */
  for (int k = 12; k < 15; ++k) s.lambda[k] = 0.25 * normal[k];
  e = measured(&s, MODULUS, 0.0);
  CHECK(e.traction_node == 5);
  CHECK_NEAR(e.traction, 0.25, ROUNDING);
  scene_destroy(&s);
}

/* Two handles with one half of the mortar facets each: both find what one handle does, with their sums. */
static void sums(void) {
  static scene whole, half;
  double sums[STICKSLIP_SUMS_PER_NODE * N1];
  stickslip_equilibrium e;
  scene_init(&whole);
  scene_create(&whole);
  CHECK_OK(stickslip_interface_sums(whole.interface, whole.x1, whole.x2, sums));
  const stickslip_equilibrium expected = measured(&whole, MODULUS, 0.0);
  scene_init(&half);
  half.mortar.n_facets = 5;
  half.mortar.n_nodes = 11;
  scene_create(&half);
  memset(&e, 0, sizeof e);
  e.struct_size = sizeof e;
  e.modulus = MODULUS;
  CHECK_OK(stickslip_interface_equilibrium(half.interface, half.x1, half.x2, half.lambda, sums, &e));
  CHECK_NEAR(e.gap, expected.gap, ROUNDING);
  CHECK_NEAR(e.traction, expected.traction, ROUNDING);
  CHECK_NEAR(e.slip, expected.slip, ROUNDING);
  CHECK(e.traction_node == expected.traction_node);
  scene_destroy(&whole);
  scene_destroy(&half);
}

/* A node by itself: nu along z, closed, mu 0.5. */
static void one_node(void) {
  double gap, traction, slip;
  stickslip_node n;
  memset(&n, 0, sizeof n);
  n.struct_size = sizeof n;
  n.augmentation = 1e30; /* has no part in it */
  n.normal[2] = 1.0;
  n.mu = 0.5;
  n.coverage = 2.0;
  n.coverage_previous = 4.0;
  n.lambda[2] = -2.0;
  CHECK_OK(stickslip_node_equilibrium(&n, 10.0, 0.0, &gap, &traction, &slip));
  CHECK(gap == 0.0 && traction == 0.0 && slip == 0.0);
  n.gap_now[2] = -0.02; /* over the covered area: a penetration of 0.01 */
  n.gap_previous[0] = 0.04;
  CHECK_OK(stickslip_node_equilibrium(&n, 10.0, 0.0, &gap, &traction, &slip));
  CHECK(gap == 0.01 && traction == 0.0 && slip == 0.01);
  n.lambda[0] = 1.0; /* on the cone, and the slip along it */
  CHECK_OK(stickslip_node_equilibrium(&n, 10.0, 0.0, &gap, &traction, &slip));
  CHECK(gap == 0.01 && traction == 0.0 && slip == 0.0);
  n.lambda[0] = -1.0; /* against it */
  CHECK_OK(stickslip_node_equilibrium(&n, 10.0, 0.001, &gap, &traction, &slip));
  CHECK_NEAR(gap, 0.009, 1e-15);
  CHECK_NEAR(slip, 0.009, 1e-15);
  CHECK(traction == 0.0);
  n.coverage = 0.0; /* open, with a multiplier */
  CHECK_OK(stickslip_node_equilibrium(&n, 10.0, 0.0, NULL, &traction, NULL));
  CHECK_NEAR(traction, sqrt(5.0), 1e-15);

  FILL(gap);
  CHECK_REFUSED(stickslip_node_equilibrium(NULL, 1.0, 0.0, &gap, NULL, NULL), STICKSLIP_NULL_POINTER, "stickslip_node");
  CHECK_REFUSED(stickslip_node_equilibrium(&n, -1.0, 0.0, &gap, NULL, NULL), STICKSLIP_INVALID_VALUE, "stiffness");
  CHECK_REFUSED(stickslip_node_equilibrium(&n, 1.0, NAN, &gap, NULL, NULL), STICKSLIP_NOT_FINITE, "rounding");
  n.mu = -1.0;
  CHECK_REFUSED(stickslip_node_equilibrium(&n, 1.0, 0.0, &gap, NULL, NULL), STICKSLIP_INVALID_VALUE, "mu");
  CHECK_UNTOUCHED(gap);
}

static void refusals(void) {
  static scene s;
  stickslip_equilibrium e, before;
  scene_init(&s);
  scene_create(&s);
  memset(&e, 0, sizeof e);
  e.struct_size = sizeof e;
#define CALL(x1) stickslip_interface_equilibrium(s.interface, x1, s.x2, s.lambda, NULL, &e)
#define REFUSED(call, status, word) before = e, CHECK_REFUSED(call, status, word), CHECK(!memcmp(&before, &e, sizeof e))
  REFUSED(stickslip_interface_equilibrium(NULL, s.x1, s.x2, s.lambda, NULL, &e), STICKSLIP_NULL_POINTER, "interface");
  REFUSED(CALL(NULL), STICKSLIP_NULL_POINTER, "x1");
  CHECK_REFUSED(stickslip_interface_equilibrium(s.interface, s.x1, s.x2, s.lambda, NULL, NULL), STICKSLIP_NULL_POINTER,
                "stickslip_equilibrium");
  e.modulus = -1.0;
  REFUSED(CALL(s.x1), STICKSLIP_INVALID_VALUE, "modulus");
  e.modulus = HUGE_VAL;
  REFUSED(CALL(s.x1), STICKSLIP_NOT_FINITE, "modulus");
  e.modulus = 0.0;
  e.least_traction = -1e-300;
  REFUSED(CALL(s.x1), STICKSLIP_INVALID_VALUE, "least_traction");
  e.least_traction = 0.0;
  e.struct_size = 88;
  REFUSED(CALL(s.x1), STICKSLIP_STRUCT_SIZE, "stickslip_equilibrium");
  e.struct_size = sizeof e;
  s.lambda[3] = NAN;
  REFUSED(CALL(s.x1), STICKSLIP_NOT_FINITE, "lambda");
  scene_destroy(&s);
}

int main(void) {
  independence();
  solution();
  sums();
  one_node();
  refusals();
  return 0;
}
