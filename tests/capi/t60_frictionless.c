/* STICKSLIP_FRICTION_NONE: one multiplier a node, along the normal. The arrays are n1 long, the answers those of
 * Coulomb's law with mu = 0 computed in full, and there is no slip history. */
#include "scene.h"

/* Rounding of a few operations on numbers of size 1. */
static const double ROUNDING = 1e-14;

static triplets t;
static history whole, shorter, now;
static double normal[X1];

/* What lies behind the n1 entries stays as it is. */
typedef struct {
  double values[N1], behind[2 * N1];
} guarded;

static void normals(scene *s, const double *lambda) {
  stickslip_states out;
  memset(&out, 0, sizeof out);
  out.struct_size = sizeof out;
  out.normal = normal;
  CHECK_OK(stickslip_interface_states(s->interface, s->x1, s->x2, lambda, NULL, &out));
}

static void create(scene *s, int32_t weights) {
  scene_init(s);
  s->options.friction = STICKSLIP_FRICTION_NONE;
  s->options.mu = 0.0;
  s->method.weights = weights;
  for (int a = 0; a < X1; ++a) s->multipliers[a] = a < N1 ? X1 + X2 + a : INT64_MIN; /* not to be read */
  scene_create(s);
}

int main(void) {
  static scene one, three;
  guarded lambda, rows;
  double f1[X1], f2[X2], r[UNKNOWNS];
  for (int32_t weights = STICKSLIP_WEIGHTS_CURRENT; weights <= STICKSLIP_WEIGHTS_REFERENCE; ++weights) {
    create(&one, weights);
    scene_init(&three);
    three.options.mu = 0.0;
    three.method.weights = weights;
    three.method.no_shortcuts = STICKSLIP_SHORTCUT_FRICTIONLESS | STICKSLIP_SHORTCUT_RIGID |
                                 STICKSLIP_SHORTCUT_APART | STICKSLIP_SHORTCUT_UNCOVERED;
    scene_create(&three);

    FILL(lambda);
    CHECK_OK(stickslip_interface_initial_multipliers(one.interface, lambda.values));
    CHECK_UNTOUCHED(lambda.behind);
    CHECK_OK(stickslip_interface_initial_multipliers(three.interface, r));
    normals(&one, lambda.values);
    for (int i = 0; i < X1; ++i) CHECK_NEAR(r[i], lambda.values[i / 3] * normal[i], 1e-20);

    /* Residual: the same forces, and the rows along the normal. */
    uint64_t random = 3;
    for (int a = 0; a < N1; ++a) {
      lambda.values[a] = -0.5 + 0.7 * random_number(&random);
      for (int i = 3 * a; i < 3 * a + 3; ++i) three.lambda[i] = lambda.values[a] * normal[i];
    }
    FILL(rows);
    CHECK_OK(stickslip_interface_residual(one.interface, one.x1, one.x2, lambda.values, NULL, f1, f2, rows.values));
    CHECK_UNTOUCHED(rows.behind);
    scene_residual(&three, r);
    for (int i = 0; i < X1; ++i) CHECK_NEAR(f1[i], r[i], ROUNDING);
    for (int i = 0; i < X2; ++i) CHECK_NEAR(f2[i], r[X1 + i], ROUNDING);
    for (int i = 0; i < X1; ++i) CHECK_NEAR(rows.values[i / 3] * normal[i], r[X1 + X2 + i], ROUNDING);

    /* Tangent: against a difference in one direction of all unknowns; 9 multiplier equations and no more. */
    const int64_t unknowns = X1 + X2 + N1;
    static double k[UNKNOWNS], moved1[X1], moved2[X2], plus[UNKNOWNS], minus[UNKNOWNS];
    double direction[UNKNOWNS], moved_lambda[N1];
    const double h = 1e-6;
    for (int i = 0; i < unknowns; ++i) direction[i] = random_number(&random);
    CHECK_OK(stickslip_interface_tangent_coo(one.interface, one.x1, one.x2, lambda.values, NULL, MOST_ENTRIES, t.rows,
                                             t.columns, t.values, &t.n));
    memset(k, 0, sizeof k);
    for (int64_t e = 0; e < t.n; ++e) {
      CHECK(0 <= t.rows[e] && t.rows[e] < unknowns && 0 <= t.columns[e] && t.columns[e] < unknowns);
      k[t.rows[e]] += t.values[e] * direction[t.columns[e]];
    }
    for (int sign = -1; sign <= 1; sign += 2) {
      double *out = sign > 0 ? plus : minus;
      for (int i = 0; i < X1; ++i) moved1[i] = one.x1[i] + sign * h * direction[i];
      for (int i = 0; i < X2; ++i) moved2[i] = one.x2[i] + sign * h * direction[X1 + i];
      for (int a = 0; a < N1; ++a) moved_lambda[a] = lambda.values[a] + sign * h * direction[X1 + X2 + a];
      CHECK_OK(stickslip_interface_residual(one.interface, moved1, moved2, moved_lambda, NULL, out, out + X1,
                                            out + X1 + X2));
    }
    for (int i = 0; i < unknowns; ++i) CHECK_NEAR(k[i], (plus[i] - minus[i]) / (2.0 * h), 1e-7);

    /* History: shorter, undone and continued with the same bits; another interface's is refused by name. */
    history_take(three.interface, &whole);
    history_take(one.interface, &shorter);
    CHECK(shorter.n_reals == whole.n_reals - 6 * N1 - (weights == STICKSLIP_WEIGHTS_CURRENT ? 32 * whole.integers[HISTORY_PAIRS] : 0));
    CHECK(shorter.integers[HISTORY_PAIRS] == (weights == STICKSLIP_WEIGHTS_CURRENT ? 0 : whole.integers[HISTORY_PAIRS]));
    CHECK_OK(stickslip_interface_commit(one.interface, one.x1, one.x2, lambda.values, NULL));
    CHECK_OK(stickslip_interface_rollback(one.interface));
    history_take(one.interface, &now);
    CHECK(history_equal(&now, &shorter));
    CHECK_OK(stickslip_interface_commit(one.interface, one.x1, one.x2, lambda.values, NULL));
    CHECK_OK(stickslip_interface_history_import(one.interface, now.n_integers, now.integers, now.n_reals, now.reals));
    CHECK_OK(stickslip_interface_residual(one.interface, one.x1, one.x2, lambda.values, NULL, plus, plus + X1,
                                          plus + X1 + X2));
    CHECK(memcmp(plus, f1, sizeof f1) == 0 && memcmp(plus + X1, f2, sizeof f2) == 0);
    CHECK(memcmp(plus + X1 + X2, rows.values, sizeof rows.values) == 0);
    CHECK_REFUSED(stickslip_interface_history_import(one.interface, whole.n_integers, whole.integers, whole.n_reals,
                                                     whole.reals),
                  STICKSLIP_HISTORY_MISMATCH, "Coulomb's law");
    CHECK_REFUSED(stickslip_interface_history_import(three.interface, now.n_integers, now.integers, now.n_reals,
                                                     now.reals),
                  STICKSLIP_HISTORY_MISMATCH, "no friction");

    /* No slip is computed. There is no coefficient to set, and none to give. */
    stickslip_counters counters;
    counters.struct_size = sizeof counters;
    CHECK_OK(stickslip_interface_counters(one.interface, &counters));
    CHECK(counters.nodes_slipping == 0 && counters.multipliers == N1);
    CHECK(counters.nodes_frictionless == N1 && counters.nodes_frictional == 0);
    const double mu[N1] = {0};
    CHECK_REFUSED(stickslip_interface_set_friction(one.interface, mu), STICKSLIP_INVALID_VALUE, "friction");
    CHECK_OK(stickslip_interface_counters(three.interface, &counters));
    CHECK(counters.nodes_slipping > 0 && counters.multipliers == X1);
    scene_destroy(&one);
    scene_destroy(&three);
  }
  return 0;
}
