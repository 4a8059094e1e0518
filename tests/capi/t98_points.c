/* STICKSLIP_DECISION_POINTS: the tangent against a difference in one direction of all unknowns, shares beside states, forces that add up to
 * nothing, and what is refused by name. */
#include "scene.h"

/* Of sums of some dozen products of numbers of size 1. */
static const double ROUNDING = 1e-13;

static triplets t;

static void create(scene *s, int32_t weights) {
  scene_init(s);
  s->options.friction = STICKSLIP_FRICTION_NONE;
  s->options.mu = 0.0;
  s->method.weights = weights;
  s->method.multiplier_basis = STICKSLIP_BASIS_DUAL;
  s->method.decision = STICKSLIP_DECISION_POINTS;
  s->method.augmentation = 0.0;
  s->options.modulus = 10.0;
  for (int a = 0; a < X1; ++a) s->multipliers[a] = a < N1 ? X1 + X2 + a : INT64_MIN; /* not to be read */
}

int main(void) {
  static scene one;
  const int64_t unknowns = X1 + X2 + N1;
  static double k[UNKNOWNS], moved1[X1], moved2[X2], plus[UNKNOWNS], minus[UNKNOWNS];
  double direction[UNKNOWNS], lambda[N1], moved_lambda[N1], share[N1];
  int32_t state[N1];
  int cut = 0;
  for (int32_t weights = STICKSLIP_WEIGHTS_CURRENT; weights <= STICKSLIP_WEIGHTS_REFERENCE; ++weights) {
    create(&one, weights);
    scene_create(&one);
    uint64_t random = 3;
    for (int a = 0; a < N1; ++a) lambda[a] = -0.2 + 0.5 * random_number(&random);
    for (int i = 0; i < unknowns; ++i) direction[i] = random_number(&random);

    stickslip_states out;
    memset(&out, 0, sizeof out);
    out.struct_size = sizeof out;
    out.state = state;
    out.share = share;
    CHECK_OK(stickslip_interface_states(one.interface, one.x1, one.x2, lambda, NULL, &out));
    for (int a = 0; a < N1; ++a) {
      CHECK(-ROUNDING <= share[a] && share[a] <= 1.0 + ROUNDING);
      CHECK((state[a] == STICKSLIP_STATE_GAP) == (share[a] == 0.0));
      cut += share[a] > 0.01 && share[a] < 0.99;
    }

    CHECK_OK(stickslip_interface_tangent_coo(one.interface, one.x1, one.x2, lambda, NULL, MOST_ENTRIES, t.rows, t.columns,
                                             t.values, &t.n));
    memset(k, 0, sizeof k);
    for (int64_t e = 0; e < t.n; ++e) k[t.rows[e]] += t.values[e] * direction[t.columns[e]];
    const double h = 1e-6;
    for (int sign = -1; sign <= 1; sign += 2) {
      double *to = sign > 0 ? plus : minus;
      for (int i = 0; i < X1; ++i) moved1[i] = one.x1[i] + sign * h * direction[i];
      for (int i = 0; i < X2; ++i) moved2[i] = one.x2[i] + sign * h * direction[X1 + i];
      for (int a = 0; a < N1; ++a) moved_lambda[a] = lambda[a] + sign * h * direction[X1 + X2 + a];
      CHECK_OK(stickslip_interface_residual(one.interface, moved1, moved2, moved_lambda, NULL, to, to + X1, to + X1 + X2));
    }
    for (int i = 0; i < unknowns; ++i) CHECK_NEAR(k[i], (plus[i] - minus[i]) / (2.0 * h), 1e-7);
    for (int i = 0; i < 3; ++i) {
      double sum = 0.0;
      for (int a = 0; a < N1 + N2; ++a) sum += plus[3 * a + i];
      CHECK_NEAR(sum, 0.0, ROUNDING);
    }

    CHECK_OK(stickslip_interface_commit(one.interface, one.x1, one.x2, lambda, NULL));
    CHECK_OK(stickslip_interface_rollback(one.interface));
    scene_destroy(&one);
  }
  CHECK(cut > 0);

  create(&one, STICKSLIP_WEIGHTS_REFERENCE);
  one.method.normals = STICKSLIP_NORMALS_CURRENT;
  CHECK_REFUSED(stickslip_interface_create(&one.nonmortar, &one.mortar, &one.options, &one.interface), STICKSLIP_UNSUPPORTED,
                "normals of now");
  create(&one, STICKSLIP_WEIGHTS_REFERENCE);
  one.options.modulus = 0.0;
  one.method.augmentation = 15.0;
  CHECK_REFUSED(stickslip_interface_create(&one.nonmortar, &one.mortar, &one.options, &one.interface),
                STICKSLIP_MISSING_STIFFNESS, "E*");
  return 0;
}
