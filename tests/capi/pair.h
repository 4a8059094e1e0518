/* One pair of facets for the tests of the stateless calls. */
#ifndef PAIR_H
#define PAIR_H

#include "check.h"

/* Weights and their derivatives, large enough for two quadrilaterals. */
typedef struct {
  double ab[16], ac[16], dab[16 * 24], dac[16 * 24];
} weights;

static inline stickslip_pair make_pair(int32_t n1, const double *x1, int32_t n2, const double *x2) {
  stickslip_pair pair;
  memset(&pair, 0, sizeof pair);
  pair.struct_size = sizeof pair;
  pair.n1 = n1;
  pair.n2 = n2;
  pair.x1 = x1;
  pair.x2 = x2;
  return pair;
}

static inline void pair_weights(const stickslip_pair *pair, weights *w) {
  CHECK_OK(stickslip_pair_weights(pair, w->ab, w->ac, w->dab, w->dac));
}

/* Facets of the unit size that overlap in part. Non-mortar: its body above, so clockwise seen from above. */
static const double quad1[12] = {0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 0.0};
static const double tri1[9] = {0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0};
static const double quad2[12] = {0.3, -0.4, -0.02, 1.4, 0.1, 0.01, 1.1, 1.2, 0.04, 0.0, 0.7, 0.01};
static const double tri2[9] = {-0.3, -0.2, -0.02, 0.8, 0.1, 0.01, 0.2, 0.9, 0.02};

#endif
