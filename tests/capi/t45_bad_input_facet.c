/* Facets without an area, folded or not convex, with a node twice, too warped or too steep to be projected. */
#include "calls.h"

/* A needle thinner than 1e-12, a line; a bow tie, an arrow head, an edge that runs back over the first one. */
static const double shapes[][12] = {
    {0, 0, 0, 1, 0, 0, 1, 1e-13, 0, 0, 1e-13, 0}, {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0},
    {0, 0, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0},         {0, 0, 0, 1, 0, 0, 0.1, 0.1, 0, 0, 1, 0},
    {0, 0, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0},
};

static void stateless(void) {
  static element e;
  element_init(&e);
  for (int k = 0; k < COUNT(shapes); ++k) {
    memcpy(e.x1, shapes[k], sizeof e.x1);
    CHECK_REFUSED(call_weights(&e), STICKSLIP_DEGENERATE_FACET, "facet");
    CHECK_REFUSED(call_facet(&e), STICKSLIP_DEGENERATE_FACET, "facet");
    CHECK_REFUSED(call_tangent(&e), STICKSLIP_DEGENERATE_FACET, "facet");
  }
  memcpy(e.x1, quad1, sizeof quad1);

  /* On the mortar side a facet that is not convex in the plane is refused; one seen edge-on covers nothing. */
  for (int k = 2; k < 4; ++k) {
    memcpy(e.x2, shapes[k], sizeof e.x2);
    if (k == 2) e.x2[7] = 0.2; /* a bow tie with an area */
    CHECK_REFUSED(call_weights(&e), STICKSLIP_PROJECTION_NOT_CONVEX, "mortar facet");
  }
  element_untouched(&e);
  const double steep[12] = {0.2, 0.2, 0, 0.8, 0.2, 0, 0.8, 0.2, 1, 0.2, 0.2, 1};
  memcpy(e.x2, steep, sizeof steep);
  CHECK_OK(call_weights(&e));
  CHECK(max_abs(e.w_out.ab, 16) == 0.0);

  /* Two nodes at one place, next to each other or not. */
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < k; ++j) {
      element_init(&e);
      memcpy(e.x1 + 3 * k, e.x1 + 3 * j, 3 * sizeof(double));
      CHECK_REFUSED(call_weights(&e), STICKSLIP_DUPLICATE_NODE, "pair.x1");
      CHECK_REFUSED(call_gap(&e), STICKSLIP_DUPLICATE_NODE, "pair.x1");
      CHECK_REFUSED(call_residual(&e), STICKSLIP_DUPLICATE_NODE, "pair.x1");
      CHECK_REFUSED(call_tangent(&e), STICKSLIP_DUPLICATE_NODE, "pair.x1");
      CHECK_REFUSED(call_facet(&e), STICKSLIP_DUPLICATE_NODE, "x");
      memcpy(e.x1, quad1, sizeof quad1);
      memcpy(e.x2 + 3 * k, e.x2 + 3 * j, 3 * sizeof(double));
      CHECK_REFUSED(call_weights(&e), STICKSLIP_DUPLICATE_NODE, "pair.x2");
      element_untouched(&e);
    }
  }

  /* Facets have 3 or 4 nodes. */
  const int32_t wrong[] = {-1, 0, 1, 2, 5, 8, INT32_MAX, INT32_MIN};
  for (int k = 0; k < COUNT(wrong); ++k) {
    element_init(&e);
    e.pair.n1 = wrong[k];
    CHECK_REFUSED(call_weights(&e), STICKSLIP_INVALID_SIZE, "pair.x1");
    e.pair.n1 = 4;
    e.pair.n2 = wrong[k];
    CHECK_REFUSED(call_residual(&e), STICKSLIP_INVALID_SIZE, "pair.x2");
    CHECK_REFUSED(stickslip_facet_geometry(wrong[k], e.x1, e.normals, e.areas), STICKSLIP_INVALID_SIZE, "x");
    element_untouched(&e);
  }
}

static void surfaces(void) {
  static scene s;
  double centre[3];
  for (int side = 0; side < 2; ++side) {
    /* A node of a facet in contact moves onto the opposite one, or beyond it: the facet is folded. */
    for (int folded = 0; folded < 2; ++folded) {
      scene_init(&s);
      double *x = side == 0 ? s.reference1 : s.reference2 + 15, *opposite = x + (side == 0 ? 12 : 15);
      memcpy(centre, opposite, sizeof centre);
      for (int i = 0; i < 3; ++i) x[i] = folded ? 2.5 * centre[i] - 1.5 * x[i] : centre[i];
      CHECK_REFUSED(call_create(&s), STICKSLIP_DEGENERATE_FACET, side == 0 ? "nonmortar facet 0" : "mortar facet");
    }
    /* A facet names a node twice. */
    scene_init(&s);
    int64_t *nodes = side == 0 ? s.nodes1 : s.nodes2;
    nodes[2] = nodes[0];
    CHECK_REFUSED(call_create(&s), STICKSLIP_DUPLICATE_NODE, side == 0 ? "nonmortar: facet 0" : "mortar: facet 0");
  }

  /* A node of the surface that no facet uses. */
  scene_init(&s);
  s.nonmortar.n_facets = 3;
  CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, "nonmortar: node 8");

  /* Facets that lie on each other, along all their edges. */
  const int64_t offsets[3] = {0, 3, 6}, folded[6] = {0, 1, 2, 0, 2, 1}, facing[6] = {0, 1, 4, 2, 3, 4};
  scene_init(&s);
  s.nonmortar.n_nodes = 3;
  s.nonmortar.n_facets = 2;
  s.nonmortar.facet_offsets = offsets;
  s.nonmortar.facet_nodes = folded;
  memcpy(s.reference1 + 6, s.reference1 + 12, 3 * sizeof(double)); /* not in line */
  CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, "facets 0 and 1");

  /* Facets that look in opposite directions around a node, their only one in common: its normal has no direction. */
  scene_init(&s);
  s.nonmortar.n_nodes = 5;
  s.nonmortar.n_facets = 2;
  s.nonmortar.facet_offsets = offsets;
  s.nonmortar.facet_nodes = facing;
  CHECK_REFUSED(call_create(&s), STICKSLIP_UNDEFINED_NORMAL, "non-mortar node 4");
}

/* Within Newton the same is a domain error: refused, and the handle goes on. */
static void evaluation(void) {
  static handle h;
  handle_init(&h);
  scene *s = &h.s;
  double kept[3];
  for (int k = 0; k < COUNT(evaluations); ++k) {
    memcpy(kept, s->x1 + 12, sizeof kept);
    memcpy(s->x1 + 12, s->x1, sizeof kept);
    CHECK_REFUSED(evaluations[k](&h), STICKSLIP_DEGENERATE_FACET, "nonmortar facet");
    memcpy(s->x1 + 12, kept, sizeof kept);

    memcpy(kept, s->x2 + 15, sizeof kept);
    for (int i = 0; i < 3; ++i) s->x2[15 + i] = 0.5 * (s->x2[30 + i] + s->x2[15 + i]) + 1.5 * (s->x2[30 + i] - kept[i]);
    CHECK_REFUSED(evaluations[k](&h), STICKSLIP_PROJECTION_NOT_CONVEX, "mortar facet");
    memcpy(s->x2 + 15, kept, sizeof kept);
  }
  handle_untouched(&h);
  for (int k = 0; k < COUNT(evaluations); ++k) CHECK_OK(evaluations[k](&h));
  scene_destroy(s);
}

int main(void) {
  stateless();
  surfaces();
  evaluation();
  return 0;
}
