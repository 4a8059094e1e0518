/* Creation and destruction; initial multipliers; states; counters. */
#include "scene.h"

int main(void) {
  static scene s;
  scene_init(&s);

  /* NULL, a pointer to NULL, and destroying once are fine. */
  CHECK_OK(stickslip_interface_destroy(NULL));
  CHECK_OK(stickslip_interface_destroy(&s.interface));
  scene_create(&s);
  scene_destroy(&s);
  CHECK_OK(stickslip_interface_destroy(&s.interface));

  /* Surfaces are copied: the host's arrays may go. */
  scene_create(&s);
  double r[UNKNOWNS], again[UNKNOWNS];
  scene_residual(&s, r);
  memset(s.reference1, 0, sizeof s.reference1);
  memset(s.nodes2, 0, sizeof s.nodes2);
  memset(s.multipliers, 0, sizeof s.multipliers);
  scene_residual(&s, again);
  CHECK(memcmp(r, again, sizeof r) == 0);
  scene_destroy(&s);

  /* The start: a slight compression on all covered closed nodes, -1e-6 rhat sqrt(M) nu. */
  scene_init(&s);
  scene_create(&s);
  double lambda[X1], normal[X1], area[N1], gap[N1], coverage[N1], augmentation[N1], slip[X1], traction[X1], dissipation[N1];
  int32_t state[N1];
  stickslip_states out = {.struct_size = sizeof out, .state = state, .normal = normal, .traction = traction, .gap = gap, .slip = slip,
                          .coverage = coverage, .area = area, .dissipation = dissipation, .augmentation = augmentation};
  CHECK_OK(stickslip_interface_initial_multipliers(s.interface, lambda));
  CHECK_OK(stickslip_interface_states(s.interface, s.reference1, s.reference2, lambda, NULL, &out));
  double total = 0.0, up[3] = {0.0, 0.0, 1.0};
  scene_frame(up);
  for (int a = 0; a < N1; ++a) {
    for (int i = 0; i < 3; ++i) {
      CHECK_NEAR(normal[3 * a + i], up[i], 1e-15);
      CHECK_NEAR(lambda[3 * a + i], -1e-6 * 15.0 * sqrt(area[a]) * up[i], 1e-20);
    }
    CHECK(state[a] == STICKSLIP_STATE_STICK);
    CHECK_NEAR(gap[a], 0.0, 1e-15);
    CHECK_NEAR(coverage[a], area[a], 1e-15);
    CHECK_NEAR(augmentation[a] * area[a], 15.0, 1e-13);
    total += area[a];
  }
  CHECK_NEAR(total, 1.0, 1e-14);
  CHECK(max_abs(slip, X1) < 1e-15);

  /* A modulus gives rhat = 0.1 E / sqrt(M). */
  stickslip_options by_modulus = s.options;
  stickslip_method without = s.method;
  without.augmentation = 0.0;
  by_modulus.method = &without;
  by_modulus.modulus = 200.0;
  stickslip_interface *other = NULL;
  CHECK_OK(stickslip_interface_create(&s.nonmortar, &s.mortar, &by_modulus, &other));
  stickslip_states only_r;
  memset(&only_r, 0, sizeof only_r);
  only_r.struct_size = sizeof only_r;
  only_r.augmentation = augmentation;
  CHECK_OK(stickslip_interface_states(other, s.reference1, s.reference2, lambda, NULL, &only_r));
  for (int a = 0; a < N1; ++a) CHECK_NEAR(augmentation[a] * pow(area[a], 1.5), 20.0, 1e-12);
  CHECK_OK(stickslip_interface_destroy(&other));

  /* All three states occur once the scene has moved. */
  int seen[3] = {0, 0, 0};
  CHECK_OK(stickslip_interface_states(s.interface, s.x1, s.x2, s.lambda, NULL, &out));
  for (int a = 0; a < N1; ++a) {
    CHECK(0 <= state[a] && state[a] <= 2);
    ++seen[state[a]];
  }
  CHECK(seen[0] > 0 && seen[1] > 0 && seen[2] > 0);

  stickslip_counters counters;
  memset(&counters, 0, sizeof counters);
  counters.struct_size = sizeof counters;
  CHECK_OK(stickslip_interface_counters(s.interface, &counters));
  CHECK(counters.struct_size == sizeof counters);
  CHECK(counters.pairs_active > 4 && counters.pairs_clipped <= counters.pairs_tested);
  CHECK(counters.searches >= 1 && counters.bytes > 0 && counters.seconds_search >= 0.0);

  /* Initial multipliers belong before the first step. */
  scene_commit(&s);
  FILL(lambda);
  CHECK_REFUSED(stickslip_interface_initial_multipliers(s.interface, lambda), STICKSLIP_INVALID_VALUE, "first step");
  CHECK_UNTOUCHED(lambda);
  scene_destroy(&s);
  return 0;
}
