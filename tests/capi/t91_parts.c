/* A parallel host whose handles own nodes: each holds the facets around its own nodes, and the multipliers of others act
 * elsewhere. Residuals and tangents add up to those of one handle, without any sums, and so do the pieces of a condensed system. */
#include "scene.h"

static int owner(int a) { return a < 5 ? 0 : 1; }

/* Condensed rows of a handle and what its mortar nodes gain, and the piece ELIMINATION, added to r and m. */
static void add_condensed(const scene *s, const double *host, double r[X1 + X2], double *m) {
  static triplets t;
  double rows[X1], gains[X2];
  CHECK_OK(stickslip_interface_condensed_residual(s->interface, s->x1, s->x2, s->lambda, host, rows, gains));
  for (int i = 0; i < X1; ++i) r[i] += rows[i];
  for (int i = 0; i < X2; ++i) r[X1 + i] += gains[i];
  CHECK_OK(stickslip_interface_condensed_coo(s->interface, s->x1, s->x2, s->lambda, STICKSLIP_CONDENSED_ELIMINATION,
                                             MOST_ENTRIES, t.rows, t.columns, t.values, &t.n));
  for (int64_t e = 0; e < t.n; ++e) m[t.rows[e] * (X1 + X2) + t.columns[e]] += t.values[e];
}

/* Multipliers are eliminated where they act. */
static void check_condensed(void) {
  enum { N = X1 + X2 };
  static scene whole, parts[2];
  static int32_t owned[2][N1];
  static double m[N * N], m_sum[N * N];
  double r[N] = {0}, r_sum[N] = {0}, host[X1], lambda[X1];
  scene_init(&whole);
  whole.method.multiplier_basis = STICKSLIP_BASIS_DUAL;
  scene_create(&whole);
  for (int i = 0; i < X1; ++i) host[i] = 0.05 * ((7 * i) % 11 - 5);
  CHECK_OK(stickslip_interface_condensed_multipliers(whole.interface, whole.x1, whole.x2, host, whole.lambda));
  add_condensed(&whole, host, r, m);
  for (int p = 0; p < 2; ++p) {
    scene_init(&parts[p]);
    for (int a = 0; a < N1; ++a) owned[p][a] = owner(a) == p ? STICKSLIP_NODE_OWN : STICKSLIP_NODE_ELSEWHERE;
    parts[p].nonmortar.owned = owned[p];
    parts[p].method.multiplier_basis = STICKSLIP_BASIS_DUAL;
    scene_create(&parts[p]);
    CHECK_OK(stickslip_interface_condensed_multipliers(parts[p].interface, whole.x1, whole.x2, host, lambda));
    for (int i = 0; i < X1; ++i) CHECK(owner(i / 3) != p || lambda[i] == whole.lambda[i]);
    memcpy(parts[p].lambda, whole.lambda, sizeof whole.lambda);
    add_condensed(&parts[p], host, r_sum, m_sum);
  }
  CHECK(max_abs(m, N * N) > 0.0);
  for (int i = 0; i < N; ++i) CHECK_NEAR(r_sum[i], r[i], 1e-14 * max_abs(r, N));
  for (int e = 0; e < N * N; ++e) CHECK_NEAR(m_sum[e], m[e], 1e-13 * max_abs(m, N * N));
  /* A row of a matrix in place belongs to one handle alone. */
  int64_t count;
  const int64_t offsets[N + 1] = {0};
  CHECK_REFUSED(stickslip_interface_condensed_pattern(parts[0].interface, whole.x1, whole.x2, N, offsets, &count, 0, NULL, NULL,
                                                      &count),
                STICKSLIP_UNSUPPORTED, "take the pieces (stickslip_interface_condensed_coo)");
  for (int p = 0; p < 2; ++p) scene_destroy(&parts[p]);
  scene_destroy(&whole);
}

int main(void) {
  static scene whole, parts[2];
  static double k[UNKNOWNS * UNKNOWNS], k_sum[UNKNOWNS * UNKNOWNS];
  static triplets t;
  static int32_t owned[2][N1];
  double r[UNKNOWNS], r_sum[UNKNOWNS], part[UNKNOWNS];

  scene_init(&whole);
  scene_create(&whole);
  for (int p = 0; p < 2; ++p) {
    scene_init(&parts[p]);
    for (int a = 0; a < N1; ++a) owned[p][a] = owner(a) == p ? STICKSLIP_NODE_OWN : STICKSLIP_NODE_ELSEWHERE;
    parts[p].nonmortar.owned = owned[p];
    scene_create(&parts[p]);
  }

  for (int step = 0; step < 3; ++step) {
    scene_residual(&whole, r);
    memset(k, 0, sizeof k);
    memset(k_sum, 0, sizeof k_sum);
    memset(r_sum, 0, sizeof r_sum);
    scene_tangent(&whole, &t);
    triplets_add(&t, 0, k);
    for (int p = 0; p < 2; ++p) {
      memcpy(parts[p].x1, whole.x1, sizeof whole.x1);
      scene_residual(&parts[p], part);
      for (int i = 0; i < UNKNOWNS; ++i) r_sum[i] += part[i];
      for (int a = 0; a < N1; ++a) {
        for (int i = 0; i < 3; ++i) CHECK(owner(a) == p || part[X1 + X2 + 3 * a + i] == 0.0);
      }
      scene_tangent(&parts[p], &t);
      for (int64_t e = 0; e < t.n; ++e) CHECK(t.rows[e] < X1 + X2 || owner((int)(t.rows[e] - X1 - X2) / 3) == p);
      triplets_add(&t, 0, k_sum);
    }
    for (int i = 0; i < UNKNOWNS; ++i) CHECK_NEAR(r_sum[i], r[i], 1e-14 * max_abs(r, UNKNOWNS));
    CHECK(block_difference(k_sum, k, 1e-3) < 1e-12);
    scene_commit(&whole);
    for (int p = 0; p < 2; ++p) scene_commit(&parts[p]);
    scene_slide(&whole, 0.11);
  }

  /* A new handle goes on from where another one committed, with its slip. */
  static stickslip_states states = {.struct_size = sizeof states};
  static scene again;
  double slip[X1], moved[X1];
  states.slip = slip;
  CHECK_OK(stickslip_interface_states(whole.interface, whole.x1, whole.x2, whole.lambda, NULL, &states));
  memcpy(moved, whole.x1, sizeof moved);
  scene_commit(&whole);
  scene_init(&again);
  scene_create(&again);
  memcpy(again.lambda, whole.lambda, sizeof again.lambda);
  CHECK_OK(stickslip_interface_set_committed(again.interface, moved, again.x2, slip, 4));
  scene_slide(&whole, 0.07);
  memcpy(again.x1, whole.x1, sizeof again.x1);
  scene_residual(&whole, r);
  scene_residual(&again, part);
  CHECK(memcmp(part, r, sizeof r) == 0);
  double later[X1];
  CHECK_OK(stickslip_interface_states(whole.interface, whole.x1, whole.x2, whole.lambda, NULL, &states));
  memcpy(later, slip, sizeof slip);
  CHECK_OK(stickslip_interface_states(again.interface, again.x1, again.x2, again.lambda, NULL, &states));
  CHECK(max_abs(slip, X1) > 0.0 && memcmp(later, slip, sizeof slip) == 0);

  /* What `owned` may say. */
  stickslip_interface *none;
  owned[0][3] = 3;
  CHECK_REFUSED(stickslip_interface_create(&parts[0].nonmortar, &parts[0].mortar, &parts[0].options, &none),
                STICKSLIP_INVALID_VALUE, "nonmortar.owned[3] is 3; a STICKSLIP_NODE_... constant is expected");
  check_condensed();
  scene_destroy(&again);
  for (int p = 0; p < 2; ++p) scene_destroy(&parts[p]);
  scene_destroy(&whole);
  return 0;
}
