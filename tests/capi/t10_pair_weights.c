/* Stage 1: mortar weights of a pair, their derivative, and what does not overlap. */
#include "pair.h"

/* Worst error of the derivatives against central differences, relative to the largest derivative. */
static double difference_error(int n1, const double *x1, int n2, const double *x2) {
  const double step = 1e-6;
  const int columns = 3 * (n1 + n2);
  double x[24], error = 0.0, scale = 0.0;
  weights w, plus, minus;
  memcpy(x, x1, 3 * (size_t)n1 * sizeof *x);
  memcpy(x + 3 * n1, x2, 3 * (size_t)n2 * sizeof *x);
  const stickslip_pair pair = make_pair(n1, x, n2, x + 3 * n1);
  pair_weights(&pair, &w);
  for (int j = 0; j < columns; ++j) {
    const double at = x[j];
    x[j] = at + step;
    pair_weights(&pair, &plus);
    x[j] = at - step;
    pair_weights(&pair, &minus);
    x[j] = at;
    for (int i = 0; i < n1 * n1; ++i) {
      const double exact = w.dab[i * columns + j];
      error = fmax(error, fabs((plus.ab[i] - minus.ab[i]) / (2.0 * step) - exact));
      scale = fmax(scale, fabs(exact));
    }
    for (int i = 0; i < n1 * n2; ++i) {
      const double exact = w.dac[i * columns + j];
      error = fmax(error, fabs((plus.ac[i] - minus.ac[i]) / (2.0 * step) - exact));
      scale = fmax(scale, fabs(exact));
    }
  }
  CHECK(scale > 0.01);
  return error / scale;
}

/* Each row of n_AB and of n_AC sums to the covered part of int N_A: both sides share their quadrature points. */
static void check_rows(int n1, int n2, const weights *w, double area) {
  double total = 0.0;
  for (int a = 0; a < n1; ++a) {
    double b = 0.0, c = 0.0;
    for (int k = 0; k < n1; ++k) b += w->ab[a * n1 + k];
    for (int k = 0; k < n2; ++k) c += w->ac[a * n2 + k];
    CHECK_NEAR(b, c, 1e-15);
    total += b;
    for (int k = 0; k < a; ++k) CHECK(w->ab[a * n1 + k] == w->ab[k * n1 + a]);
  }
  if (area > 0.0) CHECK_NEAR(total, area, 1e-15);
}

int main(void) {
  const struct {
    int n1, n2;
    const double *x1, *x2;
  } kinds[4] = {{4, 4, quad1, quad2}, {4, 3, quad1, tri2}, {3, 4, tri1, quad2}, {3, 3, tri1, tri2}};
  weights w, v;

  for (int k = 0; k < 4; ++k) {
    stickslip_pair pair = make_pair(kinds[k].n1, kinds[k].x1, kinds[k].n2, kinds[k].x2);
    pair_weights(&pair, &w);
    check_rows(kinds[k].n1, kinds[k].n2, &w, 0.0);
    /* The degree-10 rule serves quadrilaterals that are no parallelograms. */
    pair.quadrature = STICKSLIP_QUADRATURE_DEGREE_10;
    pair_weights(&pair, &v);
    for (int i = 0; i < kinds[k].n1 * kinds[k].n2; ++i) CHECK_NEAR(v.ac[i], w.ac[i], kinds[k].n2 == 3 ? 1e-15 : 1e-7);
    /* Each output alone, and none. */
    double alone[16];
    CHECK_OK(stickslip_pair_weights(&pair, NULL, alone, NULL, NULL));
    CHECK(memcmp(alone, v.ac, sizeof(double) * (size_t)(kinds[k].n1 * kinds[k].n2)) == 0);
    CHECK_OK(stickslip_pair_weights(&pair, NULL, NULL, NULL, NULL));
  }

  /* Differences: rounding 1e-16 / 1e-6; the mortar quad is distorted, which leaves the rule's own error. */
  CHECK(difference_error(4, quad1, 3, tri2) < 1e-8);
  CHECK(difference_error(3, tri1, 3, tri2) < 1e-8);
  CHECK(difference_error(4, quad1, 4, quad2) < 1e-5);
  CHECK(difference_error(3, tri1, 4, quad2) < 1e-5);

  /* A known overlap: the unit square over a square shifted by (0.5, 0.5) at a distance. */
  const double square2[12] = {0.5, 0.5, -0.1, 1.5, 0.5, -0.1, 1.5, 1.5, -0.1, 0.5, 1.5, -0.1};
  stickslip_pair pair = make_pair(4, quad1, 4, square2);
  pair_weights(&pair, &w);
  check_rows(4, 4, &w, 0.25);
  /* int of (1-x)^2 (1-y)^2 over [0.5, 1]^2 = (1/24)^2 for the node at the origin. */
  CHECK_NEAR(w.ab[0], 1.0 / 576.0, 1e-16);

  /* The weights do not depend on the side a mortar facet is seen from, nor on its first node. */
  const double turned[12] = {1.5, 1.5, -0.1, 1.5, 0.5, -0.1, 0.5, 0.5, -0.1, 0.5, 1.5, -0.1};
  const int place[4] = {2, 1, 0, 3};
  pair.x2 = turned;
  pair_weights(&pair, &v);
  for (int a = 0; a < 4; ++a) {
    for (int c = 0; c < 4; ++c) CHECK_NEAR(v.ac[4 * a + c], w.ac[4 * a + place[c]], 1e-16);
  }

  /* No overlap is no error: all zero, also beside, and for facets that only touch at a corner. */
  for (int apart = 0; apart < 2; ++apart) {
    double far2[12];
    for (int i = 0; i < 12; ++i) far2[i] = square2[i] + (i % 3 < 2 ? (apart ? 7.0 : 0.5) : 0.0);
    pair.x2 = far2;
    FILL(w);
    pair_weights(&pair, &w);
    CHECK(max_abs(w.ab, 16) == 0.0 && max_abs(w.ac, 16) == 0.0);
    if (apart) CHECK(max_abs(w.dab, 16 * 24) == 0.0 && max_abs(w.dac, 16 * 24) == 0.0);
  }
  return 0;
}
