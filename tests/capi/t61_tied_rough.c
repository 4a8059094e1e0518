/* STICKSLIP_FRICTION_TIED: neither opens nor slips; closed surfaces are linear. STICKSLIP_FRICTION_ROUGH: Coulomb's law
 * with a coefficient that nothing exceeds. */
#include "scene.h"

static triplets t, u;

static void create(scene *s, int32_t friction, double mu) {
  scene_init(s);
  s->options.friction = friction;
  s->options.mu = mu;
  scene_create(s);
}

/* The states of all nodes; how many are in the given one. */
static int count_states(scene *s, int32_t wanted) {
  int32_t state[N1];
  int count = 0;
  stickslip_states out;
  memset(&out, 0, sizeof out);
  out.struct_size = sizeof out;
  out.state = state;
  CHECK_OK(stickslip_interface_states(s->interface, s->x1, s->x2, s->lambda, NULL, &out));
  for (int a = 0; a < N1; ++a) count += state[a] == wanted;
  return count;
}

static void refused(int32_t friction) {
  static scene s;
  const double mu[N1] = {0};
  scene_init(&s);
  s.options.friction = friction;
  CHECK_REFUSED(stickslip_interface_create(&s.nonmortar, &s.mortar, &s.options, &s.interface), STICKSLIP_INVALID_VALUE,
                "options.mu");
  s.options.mu = 0.0;
  scene_create(&s);
  CHECK_REFUSED(stickslip_interface_set_friction(s.interface, mu), STICKSLIP_INVALID_VALUE, "mu");
  scene_destroy(&s);
}

int main(void) {
  static scene s, other;
  double r[UNKNOWNS], q[UNKNOWNS], up[3] = {0.0, 0.0, 1.0};
  scene_frame(up);

  /* Tied: pulled and far apart it holds, and a commit anywhere changes no bit. */
  create(&s, STICKSLIP_FRICTION_TIED, 0.0);
  for (int i = 0; i < X1; ++i) s.lambda[i] += 9.0 * up[i % 3];
  CHECK(count_states(&s, STICKSLIP_STATE_STICK) == N1);
  scene_residual(&s, r);
  scene_tangent(&s, &t);
  scene_slide(&s, 0.8);
  CHECK(count_states(&s, STICKSLIP_STATE_STICK) == N1);
  scene_commit(&s);
  scene_slide(&s, 50.0);
  CHECK(count_states(&s, STICKSLIP_STATE_STICK) == N1);
  scene_commit(&s);
  scene_init(&other);
  memcpy(s.x1, other.x1, sizeof s.x1);
  scene_residual(&s, q);
  scene_tangent(&s, &u);
  CHECK(memcmp(r, q, sizeof r) == 0);
  CHECK(t.n == u.n && memcmp(t.values, u.values, (size_t)t.n * sizeof *t.values) == 0);

  /* Linear: residual(z + d) - residual(z) is the tangent times d, however large d is. */
  double d[UNKNOWNS], expected[UNKNOWNS];
  uint64_t random = 3;
  for (int i = 0; i < UNKNOWNS; ++i) d[i] = 3.0 * random_number(&random);
  memset(expected, 0, sizeof expected);
  for (int64_t e = 0; e < t.n; ++e) expected[t.rows[e]] += t.values[e] * d[t.columns[e]];
  for (int i = 0; i < X1; ++i) s.x1[i] += d[i];
  for (int i = 0; i < X2; ++i) s.x2[i] += d[X1 + i];
  for (int i = 0; i < X1; ++i) s.lambda[i] += d[X1 + X2 + i];
  scene_residual(&s, q);
  for (int i = 0; i < UNKNOWNS; ++i) CHECK_NEAR(q[i] - r[i], expected[i], 1e-13);

  stickslip_counters counters;
  counters.struct_size = sizeof counters;
  CHECK_OK(stickslip_interface_counters(s.interface, &counters));
  CHECK(counters.searches == 1 && counters.nodes_slipping == 0 && counters.pairs_linearised == 0);
  CHECK(counters.pairs_reused > 0);
  scene_destroy(&s);

  /* Rough: sticks where it is closed, opens, and equals Coulomb's law without limit over steps. */
  create(&s, STICKSLIP_FRICTION_ROUGH, 0.0);
  create(&other, STICKSLIP_FRICTION_COULOMB, 1e30);
  for (int step = 0; step < 3; ++step) {
    const int open = count_states(&s, STICKSLIP_STATE_GAP);
    CHECK(0 < open && open < N1 && count_states(&s, STICKSLIP_STATE_STICK) == N1 - open);
    scene_residual(&s, r);
    scene_residual(&other, q);
    CHECK(memcmp(r, q, sizeof r) == 0);
    scene_tangent(&s, &t);
    scene_tangent(&other, &u);
    CHECK(t.n == u.n && memcmp(t.values, u.values, (size_t)t.n * sizeof *t.values) == 0);
    scene_commit(&s);
    scene_commit(&other);
    scene_slide(&s, 0.05);
    scene_slide(&other, 0.05);
  }
  scene_destroy(&s);
  scene_destroy(&other);

  /* A coefficient belongs to Coulomb's law alone. */
  refused(STICKSLIP_FRICTION_TIED);
  refused(STICKSLIP_FRICTION_ROUGH);
  return 0;
}
