/* Residual and tangent of a whole interface: against central differences in every form and with every kind of weights;
 * COO and CSR; missing equations; 1-based indices. */
#include "scene.h"

static double k[UNKNOWNS * UNKNOWNS], fd[UNKNOWNS * UNKNOWNS];
static triplets t;

static void differences(scene *s) {
  const double step = 1e-6;
  double plus[UNKNOWNS], minus[UNKNOWNS];
  for (int j = 0; j < UNKNOWNS; ++j) {
    double *x = j < X1 ? s->x1 + j : j < X1 + X2 ? s->x2 + j - X1 : s->lambda + j - X1 - X2;
    const double at = *x;
    *x = at + step;
    scene_residual(s, plus);
    *x = at - step;
    scene_residual(s, minus);
    *x = at;
    for (int i = 0; i < UNKNOWNS; ++i) fd[i * UNKNOWNS + j] = (plus[i] - minus[i]) / (2.0 * step);
  }
}

static void dense(scene *s, int64_t base) {
  memset(k, 0, sizeof k);
  scene_tangent(s, &t);
  triplets_add(&t, base, k);
}

int main(void) {
  static scene s;
  static double csr[UNKNOWNS * UNKNOWNS];
  static int64_t offsets[UNKNOWNS + 1], columns[UNKNOWNS * UNKNOWNS];

  for (int32_t form = 0; form < 2; ++form) {
    for (int32_t weights = STICKSLIP_WEIGHTS_CURRENT; weights <= STICKSLIP_WEIGHTS_REFERENCE; ++weights) {
      for (int32_t slip = 0; slip < 3; ++slip) {
        scene_init(&s);
        s.method.form = form;
        s.method.weights = weights;
        s.method.slip = slip;
        scene_create(&s);
        dense(&s, 0);
        differences(&s);
        /* Affine facets: rounding 1e-16 / 1e-6 and truncation. */
        CHECK(block_difference(k, fd, 1e-2 * max_abs(k, UNKNOWNS * UNKNOWNS)) < 1e-7);

        /* With all three arrays NULL the same number is counted. */
        int64_t count = -1;
        CHECK_OK(stickslip_interface_tangent_coo(s.interface, s.x1, s.x2, s.lambda, NULL, 0, NULL, NULL, NULL, &count));
        CHECK(count == t.n);

        /* A full CSR matrix whose rows list their columns backwards: the tangent is added to what is there. */
        for (int i = 0; i <= UNKNOWNS; ++i) offsets[i] = (int64_t)i * UNKNOWNS;
        for (int i = 0; i < UNKNOWNS * UNKNOWNS; ++i) {
          columns[i] = UNKNOWNS - 1 - i % UNKNOWNS;
          csr[i] = 0.5;
        }
        for (int twice = 0; twice < 2; ++twice) {
          CHECK_OK(stickslip_interface_tangent_csr(s.interface, s.x1, s.x2, s.lambda, NULL, UNKNOWNS, offsets, columns, csr));
        }
        for (int i = 0; i < UNKNOWNS; ++i) {
          for (int j = 0; j < UNKNOWNS; ++j) {
            const double value = csr[i * UNKNOWNS + UNKNOWNS - 1 - j], expected = 0.5 + 2.0 * k[i * UNKNOWNS + j];
            CHECK_NEAR(value, expected, 1e-13 * (1.0 + fabs(expected)));
          }
        }
        scene_destroy(&s);
      }
    }
  }

  /* Components without an equation are left out of the tangent, not of the residual. */
  scene_init(&s);
  for (int c = 0; c < X2; ++c) s.equations2[c] = -1;
  s.multipliers[4] = -1;
  scene_create(&s);
  dense(&s, 0);
  CHECK(t.n > 0);
  for (int64_t e = 0; e < t.n; ++e) {
    CHECK(t.rows[e] < X1 || t.rows[e] >= X1 + X2);
    CHECK(t.rows[e] != X1 + X2 + 4 && t.columns[e] != X1 + X2 + 4);
  }
  double r[UNKNOWNS];
  scene_residual(&s, r);
  CHECK(max_abs(r + X1, X2) > 0.0);
  scene_destroy(&s);

  /* Index base 1: node numbers, equations, rows, columns and CSR offsets; facet offsets start at 0 all the same. */
  static double one_based[UNKNOWNS * UNKNOWNS];
  scene_init(&s);
  scene_create(&s);
  dense(&s, 0);
  memcpy(one_based, k, sizeof k);
  scene_destroy(&s);
  scene_init_base(&s, 1);
  scene_create(&s);
  dense(&s, 1);
  CHECK(memcmp(one_based, k, sizeof k) == 0);
  for (int i = 0; i <= UNKNOWNS; ++i) offsets[i] = 1 + (int64_t)i * UNKNOWNS;
  for (int i = 0; i < UNKNOWNS * UNKNOWNS; ++i) columns[i] = 1 + i % UNKNOWNS;
  memset(csr, 0, sizeof csr);
  CHECK_OK(stickslip_interface_tangent_csr(s.interface, s.x1, s.x2, s.lambda, NULL, UNKNOWNS, offsets, columns, csr));
  CHECK(memcmp(csr, k, sizeof k) == 0);
  scene_destroy(&s);
  return 0;
}
