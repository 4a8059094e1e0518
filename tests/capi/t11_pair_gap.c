/* Stage 1: the weighted gap of a pair. */
#include "pair.h"

int main(void) {
  weights w;
  double gap[12];

  /* Parallel at the distance d: g_A = d e m_A, e out of the non-mortar body; nu = -e, so d < 0 below is a gap > 0. */
  double x2[12] = {-1.0, -1.0, 0.0, 2.0, -1.0, 0.0, 2.0, 2.0, 0.0, -1.0, 2.0, 0.0};
  const double distances[3] = {-0.125, 0.0, 0.25};
  for (int k = 0; k < 3; ++k) {
    for (int c = 0; c < 4; ++c) x2[3 * c + 2] = distances[k];
    const stickslip_pair pair = make_pair(4, quad1, 4, x2);
    pair_weights(&pair, &w);
    CHECK_OK(stickslip_pair_gap(&pair, w.ab, w.ac, gap));
    for (int a = 0; a < 4; ++a) {
      CHECK_NEAR(gap[3 * a], 0.0, 1e-16);
      CHECK_NEAR(gap[3 * a + 1], 0.0, 1e-16);
      CHECK_NEAR(gap[3 * a + 2], -distances[k] * 0.25, 1e-16);
    }
  }

  /* The definition, with any weights: g_A = sum_B n_AB x_B - sum_C n_AC x_C. */
  const stickslip_pair pair = make_pair(3, tri1, 4, quad2);
  pair_weights(&pair, &w);
  CHECK_OK(stickslip_pair_gap(&pair, w.ab, w.ac, gap));
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < 3; ++i) {
      double g = 0.0;
      for (int b = 0; b < 3; ++b) g += w.ab[3 * a + b] * tri1[3 * b + i];
      for (int c = 0; c < 4; ++c) g -= w.ac[4 * a + c] * quad2[3 * c + i];
      CHECK_NEAR(gap[3 * a + i], g, 1e-16);
    }
  }

  /* Far from the origin no digit is lost: the gap is taken relative to a node. */
  double there1[9], there2[12], moved[12];
  const double offset = 1048576.0;
  for (int i = 0; i < 9; ++i) there1[i] = tri1[i] + offset;
  for (int i = 0; i < 12; ++i) there2[i] = floor(quad2[i] * 1024.0) / 1024.0;
  stickslip_pair here = make_pair(3, tri1, 4, there2);
  pair_weights(&here, &w);
  CHECK_OK(stickslip_pair_gap(&here, w.ab, w.ac, gap));
  for (int i = 0; i < 12; ++i) there2[i] += offset;
  const stickslip_pair there = make_pair(3, there1, 4, there2);
  pair_weights(&there, &w);
  CHECK_OK(stickslip_pair_gap(&there, w.ab, w.ac, moved));
  for (int i = 0; i < 9; ++i) CHECK(moved[i] == gap[i]);
  return 0;
}
