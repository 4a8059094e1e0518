/* A small interface for the tests: 2 x 2 non-mortar quads over 3 x 3 turned mortar quads, in a rotated frame. Moved from
 * its first configuration it has nodes in gap, stick and slip. Unknowns: x1, x2, lambda in this order. */
#ifndef SCENE_H
#define SCENE_H

#include "check.h"

enum { N1 = 9, N2 = 16, X1 = 3 * N1, X2 = 3 * N2, UNKNOWNS = 2 * X1 + X2, MOST_ENTRIES = 100000 };

/* Surfaces point into the struct: set one up in place and do not copy it. */
typedef struct {
  double reference1[X1], reference2[X2];
  int64_t offsets1[5], offsets2[10], nodes1[16], nodes2[36];
  int64_t equations1[X1], equations2[X2], multipliers[X1];
  stickslip_surface nonmortar, mortar;
  stickslip_options options;
  stickslip_method method; /* of the options; the paper's where a test does not ask for another */
  stickslip_interface *interface;
  double x1[X1], x2[X2], lambda[X1];
} scene;

/* Turns p about the unit axis. */
static inline void scene_turn(double *p, const double *axis, double angle) {
  const double c = cos(angle), s = sin(angle);
  const double d = (axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2]) * (1.0 - c);
  const double q[3] = {axis[1] * p[2] - axis[2] * p[1], axis[2] * p[0] - axis[0] * p[2], axis[0] * p[1] - axis[1] * p[0]};
  for (int i = 0; i < 3; ++i) p[i] = c * p[i] + s * q[i] + d * axis[i];
}

/* The frame that the scene is built in: nothing is aligned with the axes. */
static inline void scene_frame(double *p) {
  const double axis[3] = {2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0};
  scene_turn(p, axis, 1.1);
}

/* n x n quads on [a, b] squared; counter-clockwise from above, or from below. */
static inline void scene_grid(int n, double a, double b, int up, int64_t base, double *x, int64_t *offsets,
                              int64_t *nodes) {
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      double *p = x + 3 * (j * (n + 1) + i);
      p[0] = a + (b - a) * i / n;
      p[1] = a + (b - a) * j / n;
      p[2] = 0.0;
    }
  }
  for (int f = 0; f <= n * n; ++f) offsets[f] = 4 * f;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int64_t first = base + j * (n + 1) + i;
      const int64_t quad[4] = {first, first + 1, first + n + 2, first + n + 1};
      for (int k = 0; k < 4; ++k) nodes[4 * (j * n + i) + k] = quad[up ? k : 3 - k];
    }
  }
}

/* Fills everything but the handle; options may be changed before scene_create. */
static inline void scene_init_base(scene *s, int64_t base) {
  const double up[3] = {0.0, 0.0, 1.0}, across[3] = {0.6, 0.8, 0.0};
  uint64_t random = 7;
  memset(s, 0, sizeof *s);
  scene_grid(2, 0.0, 1.0, 0, base, s->reference1, s->offsets1, s->nodes1);
  scene_grid(3, -0.45, 1.5, 1, base, s->reference2, s->offsets2, s->nodes2);
  for (int c = 0; c < N2; ++c) scene_turn(s->reference2 + 3 * c, up, 0.3);
  memcpy(s->x1, s->reference1, sizeof s->x1);
  memcpy(s->x2, s->reference2, sizeof s->x2);
  for (int a = 0; a < N1; ++a) {
    /* Tilted, so that gaps of both signs occur, and slid. Facets stay parallelograms. */
    scene_turn(s->x1 + 3 * a, across, 0.03);
    s->x1[3 * a] += 0.008;
    s->x1[3 * a + 1] += 0.006;
    s->x1[3 * a + 2] += 0.004;
    s->lambda[3 * a] = 0.3 * random_number(&random);
    s->lambda[3 * a + 1] = 0.3 * random_number(&random);
    s->lambda[3 * a + 2] = -0.5 + 0.7 * random_number(&random);
    scene_frame(s->reference1 + 3 * a);
    scene_frame(s->x1 + 3 * a);
    scene_frame(s->lambda + 3 * a);
  }
  for (int c = 0; c < N2; ++c) {
    scene_frame(s->reference2 + 3 * c);
    scene_frame(s->x2 + 3 * c);
  }
  for (int k = 0; k < X1; ++k) s->equations1[k] = base + k;
  for (int k = 0; k < X2; ++k) s->equations2[k] = base + X1 + k;
  for (int k = 0; k < X1; ++k) s->multipliers[k] = base + X1 + X2 + k;
  s->nonmortar.struct_size = sizeof s->nonmortar;
  s->nonmortar.n_nodes = N1;
  s->nonmortar.n_facets = 4;
  s->nonmortar.coordinates = s->reference1;
  s->nonmortar.facet_offsets = s->offsets1;
  s->nonmortar.facet_nodes = s->nodes1;
  s->nonmortar.equations = s->equations1;
  s->nonmortar.multiplier_equations = s->multipliers;
  s->mortar.struct_size = sizeof s->mortar;
  s->mortar.n_nodes = N2;
  s->mortar.n_facets = 9;
  s->mortar.coordinates = s->reference2;
  s->mortar.facet_offsets = s->offsets2;
  s->mortar.facet_nodes = s->nodes2;
  s->mortar.equations = s->equations2;
  CHECK_OK(stickslip_options_init(&s->options, sizeof s->options));
  CHECK_OK(stickslip_options_paper(&s->options));
  s->method = *s->options.method;
  s->options.method = &s->method;
  s->options.index_base = (int32_t)base;
  s->options.mu = 0.7;
  s->method.augmentation = 15.0;
}

/* Laws that take a coefficient. */
static inline int has_mu(int32_t friction) {
  return friction == STICKSLIP_FRICTION_COULOMB || friction == STICKSLIP_FRICTION_TRESCA;
}

static inline void scene_init(scene *s) { scene_init_base(s, 0); }

static inline void scene_create(scene *s) {
  CHECK_OK(stickslip_interface_create(&s->nonmortar, &s->mortar, &s->options, &s->interface));
}

static inline void scene_destroy(scene *s) {
  CHECK_OK(stickslip_interface_destroy(&s->interface));
  CHECK(s->interface == NULL);
}

/* Slides the non-mortar side in its plane. */
static inline void scene_slide(scene *s, double by) {
  double d[3] = {0.8 * by, 0.6 * by, 0.0};
  scene_frame(d);
  for (int a = 0; a < N1; ++a) {
    for (int i = 0; i < 3; ++i) s->x1[3 * a + i] += d[i];
  }
}

/* Lifts the non-mortar side off, out of reach. */
static inline void scene_lift(scene *s, double by) {
  double d[3] = {0.0, 0.0, by};
  scene_frame(d);
  for (int a = 0; a < N1; ++a) {
    for (int i = 0; i < 3; ++i) s->x1[3 * a + i] += d[i];
  }
}

static inline void scene_commit(scene *s) {
  CHECK_OK(stickslip_interface_commit(s->interface, s->x1, s->x2, s->lambda, NULL));
}

/* r: force1, force2, rows. */
static inline void scene_residual(scene *s, double r[UNKNOWNS]) {
  CHECK_OK(stickslip_interface_residual(s->interface, s->x1, s->x2, s->lambda, NULL, r, r + X1, r + X1 + X2));
}

/* The tangent's triplets; their number. */
typedef struct {
  int64_t n, rows[MOST_ENTRIES], columns[MOST_ENTRIES];
  double values[MOST_ENTRIES];
} triplets;

static inline void scene_tangent(scene *s, triplets *t) {
  CHECK_OK(stickslip_interface_tangent_coo(s->interface, s->x1, s->x2, s->lambda, NULL, MOST_ENTRIES, t->rows,
                                           t->columns, t->values, &t->n));
  CHECK(t->n > 0);
}

/* k (UNKNOWNS squared, row by row) += the triplets. */
static inline void triplets_add(const triplets *t, int64_t base, double *k) {
  for (int64_t e = 0; e < t->n; ++e) {
    const int64_t row = t->rows[e] - base, column = t->columns[e] - base;
    CHECK(0 <= row && row < UNKNOWNS && 0 <= column && column < UNKNOWNS);
    k[row * UNKNOWNS + column] += t->values[e];
  }
}

/* The larger one; NaN if either is (fmax would drop it). */
static inline double larger(double a, double b) {
  return a > b || isnan(a) ? a : b;
}

/* Worst difference over the blocks (f1, f2, rows) x (x1, x2, lambda), relative to the block's largest entry, or to
 * `floor` where a block is smaller than that. */
static inline double block_difference(const double *k, const double *expected, double floor) {
  const int ends[4] = {0, X1, X1 + X2, UNKNOWNS};
  double worst = 0.0;
  for (int p = 0; p < 3; ++p) {
    for (int q = 0; q < 3; ++q) {
      double error = 0.0, scale = floor;
      for (int i = ends[p]; i < ends[p + 1]; ++i) {
        for (int j = ends[q]; j < ends[q + 1]; ++j) {
          const int at = i * UNKNOWNS + j;
          error = larger(error, fabs(k[at] - expected[at]));
          scale = larger(scale, fabs(expected[at]));
        }
      }
      worst = larger(worst, error / scale);
    }
  }
  return worst;
}

/* What the history is made of, to the bit. */
typedef struct {
  int64_t n_integers, n_reals, integers[256];
  double reals[4096];
} history;

static inline void history_take(stickslip_interface *interface, history *h) {
  memset(h, 0, sizeof *h);
  CHECK_OK(stickslip_interface_history_size(interface, &h->n_integers, &h->n_reals));
  CHECK(h->n_integers <= COUNT(h->integers) && h->n_reals <= COUNT(h->reals));
  CHECK_OK(stickslip_interface_history_export(interface, h->n_integers, h->integers, h->n_reals, h->reals));
}

/* Places among its integers; the pairs' facets come last. */
enum {
  HISTORY_CHECKSUM = 1,
  HISTORY_COORDINATES = 9, /* of the first configuration, the last word of the meaning */
  HISTORY_COMMITS = 10,
  HISTORY_PAIRS = 13,
  HISTORY_FACETS = 14
};

static inline uint64_t history_mix(uint64_t sum, uint64_t word) {
  uint64_t z = (sum ^ word) + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/* Gives a history that was changed the checksum that fits it, so that what lies behind it is looked at. */
static inline void history_seal(history *h) {
  uint64_t sum = history_mix(history_mix(0x9e3779b97f4a7c15u, (uint64_t)h->n_integers), (uint64_t)h->n_reals);
  for (int64_t k = 0; k < h->n_integers; ++k) {
    if (k != HISTORY_CHECKSUM) sum = history_mix(sum, (uint64_t)h->integers[k]);
  }
  for (int64_t k = 0; k < h->n_reals; ++k) {
    uint64_t bits;
    memcpy(&bits, &h->reals[k], sizeof bits);
    sum = history_mix(sum, bits);
  }
  h->integers[HISTORY_CHECKSUM] = (int64_t)sum;
}

static inline int history_equal(const history *a, const history *b) { return memcmp(a, b, sizeof *a) == 0; }

#endif
