/* Stage 3: a pair's forces balance, in force and in moment about the normal gap. */
#include "pair.h"

int main(void) {
  weights w;
  uint64_t random = 5;
  double traction[12], force[24], gap[12];
  const struct {
    int n1, n2;
    const double *x1, *x2;
  } kinds[4] = {{4, 4, quad1, quad2}, {4, 3, quad1, tri2}, {3, 4, tri1, quad2}, {3, 3, tri1, tri2}};
  for (int k = 0; k < 4; ++k) {
    const int n1 = kinds[k].n1, n2 = kinds[k].n2;
    const stickslip_pair pair = make_pair(n1, kinds[k].x1, n2, kinds[k].x2);
    pair_weights(&pair, &w);
    for (int i = 0; i < 3 * n1; ++i) traction[i] = random_number(&random);
    CHECK_OK(stickslip_pair_residual(&pair, w.ab, w.ac, traction, force));

    /* The definition: f1_B = sum_A n_AB t_A, f2_C = -sum_A n_AC t_A. */
    for (int i = 0; i < 3; ++i) {
      for (int b = 0; b < n1; ++b) {
        double f = 0.0;
        for (int a = 0; a < n1; ++a) f += w.ab[a * n1 + b] * traction[3 * a + i];
        CHECK_NEAR(force[3 * b + i], f, 1e-16);
      }
      for (int c = 0; c < n2; ++c) {
        double f = 0.0;
        for (int a = 0; a < n1; ++a) f -= w.ac[a * n2 + c] * traction[3 * a + i];
        CHECK_NEAR(force[3 * (n1 + c) + i], f, 1e-16);
      }
    }

    /* Sum of forces: zero. Sum of moments: sum_A g_A x t_A. */
    CHECK_OK(stickslip_pair_gap(&pair, w.ab, w.ac, gap));
    double sum[3] = {0.0, 0.0, 0.0}, moment[3] = {0.0, 0.0, 0.0};
    for (int node = 0; node < n1 + n2; ++node) {
      const double *x = node < n1 ? kinds[k].x1 + 3 * node : kinds[k].x2 + 3 * (node - n1), *f = force + 3 * node;
      for (int i = 0; i < 3; ++i) {
        sum[i] += f[i];
        moment[i] += x[(i + 1) % 3] * f[(i + 2) % 3] - x[(i + 2) % 3] * f[(i + 1) % 3];
      }
    }
    for (int a = 0; a < n1; ++a) {
      const double *g = gap + 3 * a, *t = traction + 3 * a;
      for (int i = 0; i < 3; ++i) moment[i] -= g[(i + 1) % 3] * t[(i + 2) % 3] - g[(i + 2) % 3] * t[(i + 1) % 3];
    }
    for (int i = 0; i < 3; ++i) {
      CHECK_NEAR(sum[i], 0.0, 1e-15);
      CHECK_NEAR(moment[i], 0.0, 1e-15);
    }
  }
  return 0;
}
