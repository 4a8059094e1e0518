/* Kinds of scenes for tests that go through all calls: every form, law, side, integration and kind of weights. */
#ifndef KINDS_H
#define KINDS_H

#include "every_call.h"

/* A kind of scene. */
typedef struct {
  const char *name;
  int32_t form, friction, weights, integration, basis, normals;
  double weak_coverage, slide, lift, shear_limit;
  int rigid, analytic;
  int points; /* that decide, and remember their friction */
  int unseen; /* the history is not looked at before the end: what a commit has left out is then made up for by a call */
} kind;

static const kind kinds[] = {
    {.name = "deformable"},
    {.name = "augmented", .form = STICKSLIP_FORM_AUGMENTED},
    {.name = "frictionless", .friction = STICKSLIP_FRICTION_NONE},
    {.name = "frictionless, augmented", .friction = STICKSLIP_FRICTION_NONE, .form = STICKSLIP_FORM_AUGMENTED},
    {.name = "tied", .friction = STICKSLIP_FRICTION_TIED},
    {.name = "tied over a gap", .friction = STICKSLIP_FRICTION_TIED, .lift = 0.1},
    {.name = "rough", .friction = STICKSLIP_FRICTION_ROUGH},
    {.name = "shear limit", .friction = STICKSLIP_FRICTION_TRESCA, .shear_limit = 0.5},
    {.name = "committed weights", .weights = STICKSLIP_WEIGHTS_COMMITTED},
    {.name = "reference weights", .weights = STICKSLIP_WEIGHTS_REFERENCE},
    {.name = "weak coverage", .weak_coverage = 0.5, .slide = 0.9},
    {.name = "weak coverage, augmented", .weak_coverage = 0.5, .slide = 0.9, .form = STICKSLIP_FORM_AUGMENTED},
    {.name = "dual", .basis = STICKSLIP_BASIS_DUAL},
    {.name = "dual, augmented", .basis = STICKSLIP_BASIS_DUAL, .form = STICKSLIP_FORM_AUGMENTED},
    {.name = "dual, frictionless", .basis = STICKSLIP_BASIS_DUAL, .friction = STICKSLIP_FRICTION_NONE},
    {.name = "dual, weak coverage", .basis = STICKSLIP_BASIS_DUAL, .weak_coverage = 0.5, .slide = 0.9},
    {.name = "elements", .integration = STICKSLIP_INTEGRATION_ELEMENTS},
    {.name = "hybrid", .integration = STICKSLIP_INTEGRATION_HYBRID, .slide = 0.5},
    {.name = "dual, elements", .basis = STICKSLIP_BASIS_DUAL, .integration = STICKSLIP_INTEGRATION_ELEMENTS},
    {.name = "dual, hybrid", .basis = STICKSLIP_BASIS_DUAL, .integration = STICKSLIP_INTEGRATION_HYBRID},
    {.name = "current normals", .normals = STICKSLIP_NORMALS_CURRENT},
    {.name = "current normals, augmented", .normals = STICKSLIP_NORMALS_CURRENT, .form = STICKSLIP_FORM_AUGMENTED},
    {.name = "current normals, frictionless", .normals = STICKSLIP_NORMALS_CURRENT, .friction = STICKSLIP_FRICTION_NONE},
    {.name = "current normals, dual, weak coverage", .normals = STICKSLIP_NORMALS_CURRENT, .basis = STICKSLIP_BASIS_DUAL,
     .weak_coverage = 0.5, .slide = 0.9},
    {.name = "points", .basis = STICKSLIP_BASIS_DUAL, .weights = STICKSLIP_WEIGHTS_COMMITTED, .points = 1},
    {.name = "points, reference weights", .basis = STICKSLIP_BASIS_DUAL, .weights = STICKSLIP_WEIGHTS_REFERENCE, .points = 1},
    {.name = "rigid", .rigid = 1},
    {.name = "apart", .slide = 50.0},
    {.name = "apart, unseen", .slide = 50.0, .unseen = 1},
    {.name = "analytic", .analytic = 1},
    {.name = "dual, analytic", .basis = STICKSLIP_BASIS_DUAL, .analytic = 1},
    {.name = "analytic, frictionless", .analytic = 1, .friction = STICKSLIP_FRICTION_NONE},
};

static inline void set_up(const kind *k, every *c) {
  memset(c, 0, sizeof *c);
  scene *s = &c->h.s;
  scene_init(s);
  s->method.form = k->form;
  s->options.friction = k->friction;
  s->method.weights = k->weights;
  s->method.integration = k->integration;
  /* What a kind does not say is the paper's. */
  if (k->basis) s->method.multiplier_basis = k->basis;
  if (k->normals) s->method.normals = k->normals;
  s->method.weak_coverage = k->weak_coverage;
  s->options.shear_limit = k->shear_limit;
  if (!has_mu(k->friction)) s->options.mu = 0.0;
  if (k->points) {
    s->method.decision = STICKSLIP_DECISION_POINTS;
    if (s->options.modulus == 0.0) s->options.modulus = 100.0;
  }
  if (k->rigid || k->analytic) {
    s->options.mortar_side = k->analytic ? STICKSLIP_MORTAR_ANALYTIC : STICKSLIP_MORTAR_RIGID;
    for (int i = 0; i < X2; ++i) s->equations2[i] = -1;
  }
  if (k->analytic) {
    /* A plane through the origin, its normal up in the scene's frame. */
    static const double frame[12] = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0};
    s->mortar.n_nodes = 4;
    s->mortar.n_facets = 0;
    s->mortar.facet_offsets = s->mortar.facet_nodes = NULL;
    memcpy(s->reference2, frame, sizeof frame);
    for (int a = 0; a < 4; ++a) scene_frame(s->reference2 + 3 * a);
    memcpy(s->x2, s->reference2, sizeof s->x2);
  }
  double up[3] = {0.0, 0.0, k->lift};
  scene_frame(up);
  for (int i = 0; i < X1; ++i) {
    s->reference1[i] += up[i % 3];
    s->x1[i] += up[i % 3];
  }
  if (k->slide != 0.0) scene_slide(s, k->slide);
  every_init(c);
}

/* What points that decide do not go with. */
static inline int is_of_nodes(const entry_point *entry) {
  static int32_t (*const all[])(every *) = {every_law, every_threshold, every_set_law_states, every_heat, every_heat_coo, every_committed, every_with_sums};
  for (int k = 0; k < COUNT(all); ++k) {
    if (entry->call == all[k]) return 1;
  }
  return is_condensed(entry->name);
}

/* A skin has options of its own: once is enough. */
static inline int belongs(const kind *k, const entry_point *entry) {
  if (is_of_skin(entry->name)) return k == kinds;
  if (k->points && is_of_nodes(entry)) return 0;
  if (entry->call == every_friction) return has_mu(k->friction);
  if (entry->call == every_normals) return k->normals != STICKSLIP_NORMALS_CURRENT;
  if (is_condensed(entry->name)) return k->basis == STICKSLIP_BASIS_DUAL && k->form == STICKSLIP_FORM_MULTIPLIER;
  return entry->call != every_with_sums || (k->weak_coverage == 0.0 && k->basis != STICKSLIP_BASIS_DUAL);
}

static inline void end(every *c) {
  CHECK_OK(stickslip_interface_destroy(&c->other));
  CHECK_OK(stickslip_skin_destroy(&c->skin.skin));
  scene_destroy(&c->h.s);
}

#endif
