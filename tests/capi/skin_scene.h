/* Two unit cubes as one skin: eight nodes and six quads each, in a rotated frame. The upper one is pushed 0.3 to the side, so that no
 * edges coincide, and lies 1e-3 deep in the lower one. Unknowns: x, then multipliers of the copies. */
#ifndef SKIN_SCENE_H
#define SKIN_SCENE_H

#include "scene.h"

enum {
  CUBE_NODES = 8,
  CUBE_FACETS = 6,
  CUBE_COPIES = 24, /* each node once for each of its three faces */
  SKIN_NODES = 2 * CUBE_NODES,
  SKIN_FACETS = 2 * CUBE_FACETS,
  SKIN_COPIES = 2 * CUBE_COPIES,
  SKIN_X = 3 * SKIN_NODES,
  SKIN_LAMBDA = 3 * SKIN_COPIES,
  SKIN_UNKNOWNS = SKIN_X + SKIN_LAMBDA,
  SKIN_PLAN = 2000 /* more than the entries of its plans */
};
/* Facets that touch: of the lower cube its top, of the upper one its bottom. */
enum { LOWER_TOP = 1, UPPER_BOTTOM = CUBE_FACETS, LOWER_BODY = 7, UPPER_BODY = -3 };

static const double SKIN_OVERLAP = 1e-3;

/* The surface points into the struct: set one up in place and do not copy it. */
typedef struct {
  double reference[SKIN_X], x[SKIN_X], lambda[SKIN_LAMBDA];
  int64_t offsets[SKIN_FACETS + 1], nodes[4 * SKIN_FACETS], equations[SKIN_X], bodies[SKIN_FACETS], first_multiplier;
  stickslip_surface surface;
  stickslip_options options;
  stickslip_skin *skin;
} skin_scene;

/* Moves the nodes of the upper cube in the scene's frame. */
static inline void skin_move(double *x, double right, double back, double up) {
  double d[3] = {right, back, up};
  scene_frame(d);
  for (int k = SKIN_X / 2; k < SKIN_X; ++k) x[k] += d[k % 3];
}

/* Fills everything but the handle. x: the first configuration with a small motion of every node; lambda presses and shears. */
static inline void skin_init_base(skin_scene *s, int64_t base) {
  static const int quads[CUBE_FACETS][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  uint64_t random = 11;
  memset(s, 0, sizeof *s);
  for (int a = 0; a < SKIN_NODES; ++a) {
    const int corner = a % CUBE_NODES;
    double *p = s->reference + 3 * a;
    for (int i = 0; i < 3; ++i) p[i] = corner >> i & 1;
    scene_frame(p);
  }
  skin_move(s->reference, 0.24, 0.18, 1.0 - SKIN_OVERLAP);
  for (int f = 0; f < SKIN_FACETS; ++f) {
    s->offsets[f + 1] = 4 * (f + 1);
    s->bodies[f] = f < CUBE_FACETS ? LOWER_BODY : UPPER_BODY;
    for (int k = 0; k < 4; ++k) s->nodes[4 * f + k] = base + quads[f % CUBE_FACETS][k] + f / CUBE_FACETS * CUBE_NODES;
  }
  for (int k = 0; k < SKIN_X; ++k) {
    s->x[k] = s->reference[k] + 1e-4 * random_number(&random);
    s->equations[k] = base + k;
  }
  for (int a = 0; a < SKIN_COPIES; ++a) {
    double *l = s->lambda + 3 * a;
    l[0] = 0.1 * random_number(&random);
    l[1] = 0.1 * random_number(&random);
    l[2] = random_number(&random);
    scene_frame(l);
  }
  s->first_multiplier = base + SKIN_X;
  s->surface = (stickslip_surface){.struct_size = sizeof s->surface, .n_nodes = SKIN_NODES, .n_facets = SKIN_FACETS,
      .coordinates = s->reference, .facet_offsets = s->offsets, .facet_nodes = s->nodes, .equations = s->equations};
  CHECK_OK(stickslip_options_init(&s->options, sizeof s->options));
  s->options.index_base = (int32_t)base;
  s->options.mu = 0.4;
  s->options.modulus = 100.0;
}

static inline void skin_create(skin_scene *s) {
  CHECK_OK(stickslip_skin_create(&s->surface, s->bodies, s->first_multiplier, &s->options, &s->skin));
}

static inline void skin_destroy(skin_scene *s) {
  CHECK_OK(stickslip_skin_destroy(&s->skin));
  CHECK(s->skin == NULL);
}

/* r: forces, rows. */
static inline void skin_residual(const skin_scene *s, double r[SKIN_UNKNOWNS]) {
  CHECK_OK(stickslip_skin_residual(s->skin, s->x, s->lambda, r, r + SKIN_X));
}

/* What a skin's history is made of, to the bit. */
static inline void skin_history(stickslip_skin *skin, history *h) {
  memset(h, 0, sizeof *h);
  CHECK_OK(stickslip_skin_history_size(skin, &h->n_integers, &h->n_reals));
  CHECK(h->n_integers <= COUNT(h->integers) && h->n_reals <= COUNT(h->reals));
  CHECK_OK(stickslip_skin_history_export(skin, h->n_integers, h->integers, h->n_reals, h->reals));
}

#endif
