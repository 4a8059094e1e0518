/* Stages 1 and 3 of a pair with a state in the caller's memory: what the separate calls give. */
#include "calls.h"

int main(void) {
  static element e;
  element_init(&e);
  const int64_t needed = stickslip_pair_state_size();
  CHECK(needed > 0 && needed <= STATE_SIZE);

  for (int layout = 0; layout < 2; ++layout) {
    for (int far = 0; far < 2; ++far) {
      weights w, with_state;
      double gap[12], same_gap[12], force[24], same_force[24], k[36 * 36], same_k[36 * 36], largest = 0.0;
      for (int c = 0; c < 4; ++c) e.x2[3 * c] = quad2[3 * c] + 100.0 * far;
      e.pair.layout = layout;
      /* Exactly as much memory as is needed. */
      CHECK_OK(stickslip_pair_begin(&e.pair, needed, e.state, with_state.ab, with_state.ac, same_gap));
      pair_weights(&e.pair, &w);
      CHECK(memcmp(w.ab, with_state.ab, sizeof w.ab) == 0 && memcmp(w.ac, with_state.ac, sizeof w.ac) == 0);
      CHECK_OK(stickslip_pair_gap(&e.pair, w.ab, w.ac, gap));
      CHECK(memcmp(gap, same_gap, sizeof gap) == 0);
      CHECK_OK(stickslip_pair_state_gap(e.state, NULL, NULL, same_gap));
      CHECK(memcmp(gap, same_gap, sizeof gap) == 0);
      CHECK_OK(stickslip_pair_gap(&e.pair, e.w.ab, e.w.ac, gap));
      CHECK_OK(stickslip_pair_state_gap(e.state, e.w.ab, e.w.ac, same_gap));
      CHECK(memcmp(gap, same_gap, sizeof gap) == 0);
      CHECK_OK(stickslip_pair_residual(&e.pair, w.ab, w.ac, e.traction, force));
      CHECK_OK(stickslip_pair_state_residual(e.state, e.traction, same_force));
      CHECK(memcmp(force, same_force, sizeof force) == 0);
      CHECK_OK(stickslip_pair_tangent(&e.pair, w.ab, w.ac, w.dab, w.dac, e.w.ab, e.w.ac, e.traction, e.responses,
                                      e.row_scale, k, 36));
      CHECK_OK(stickslip_pair_state_tangent(e.state, e.w.ab, e.w.ac, e.traction, e.responses, e.row_scale, same_k, 36));
      for (int i = 0; i < 36 * 36; ++i) largest = fmax(largest, fabs(k[i]));
      for (int i = 0; i < 36 * 36; ++i) CHECK_NEAR(same_k[i], k[i], 1e-15 * largest);
    }
  }
  return 0;
}
