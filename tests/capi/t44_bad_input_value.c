/* Numbers and options outside their range: mu < 0, r <= 0, neither stiffness, lengths of normals and directions. */
#include "calls.h"

/* Every number that is not an option, and those that are named but not there yet. */
static void options(void) {
  static scene s;
  scene_init(&s);
  const struct {
    int32_t *option;
    const char *name;
    int32_t available, named;
  } all[] = {
      {&s.options.form, "options.form", 2, 2},
      {&s.options.slip, "options.slip", 3, 3},
      {&s.options.weights, "options.weights", 3, 3},
      {&s.options.friction, "options.friction", 5, 5},
      {&s.options.mortar_side, "options.mortar_side", 3, 3},
      {&s.options.multiplier_basis, "options.multiplier_basis", 1, 2},
      {&s.options.quadrature, "options.quadrature", 6, 6},
      {&s.options.row_scale, "options.row_scale", 2, 2},
      {&s.options.new_contact, "options.new_contact", 2, 2},
      {&s.options.index_base, "options.index_base", 2, 2},
      {&s.options.integration, "options.integration", 3, 3},
      {&s.options.tangent, "options.tangent", 3, 3},
  };
  for (int k = 0; k < COUNT(all); ++k) {
    const int32_t kept = *all[k].option;
    for (*all[k].option = all[k].available; *all[k].option < all[k].named; ++*all[k].option) {
      CHECK_REFUSED(call_create(&s), STICKSLIP_UNSUPPORTED, all[k].name);
    }
    const int32_t wrong[] = {-1, all[k].named, INT32_MAX, INT32_MIN};
    for (int w = 0; w < COUNT(wrong); ++w) {
      *all[k].option = wrong[w];
      CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, all[k].name);
    }
    *all[k].option = kept;
  }

  s.options.mu = -1e-300;
  CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, "options.mu");
  s.options.mu = 0.3;
  s.options.augmentation = -1.0;
  CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, "options.augmentation");
  s.options.augmentation = 0.0;
  CHECK_REFUSED(call_create(&s), STICKSLIP_MISSING_STIFFNESS, "modulus");
  s.options.modulus = -5.0;
  CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, "options.modulus");
  s.options.modulus = 5.0;
  s.options.search_distance = -1.0;
  CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, "options.search_distance");
  s.options.search_distance = 0.0;
  const double coverage[] = {-1e-12, 1.0, 2.0};
  for (int k = 0; k < COUNT(coverage); ++k) {
    s.options.coverage_min = coverage[k];
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, "options.coverage_min");
  }
  s.options.coverage_min = 0.0;
  /* Points along a side: none with cells, 2 to 10 else. */
  const int64_t points[] = {-1, 1, 11, INT64_MAX, INT64_MIN};
  for (int k = 0; k < COUNT(points); ++k) {
    for (int32_t integration = 0; integration < 3; ++integration) {
      s.options.integration = integration;
      s.options.element_points = points[k];
      CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, "options.element_points");
    }
  }
  s.options.integration = STICKSLIP_INTEGRATION_SEGMENTS;
  s.options.element_points = 4;
  CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, "options.element_points");
  s.options.element_points = 0;
  /* The other stiffness is wrong too, if it is not needed. */
  s.options.augmentation = 1.0;
  s.options.modulus = -5.0;
  CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE, "options.modulus");
}

static void nodes(void) {
  static element e;
  element_init(&e);
  const stickslip_node good = e.node;

  e.node.mu = -1e-9;
  CHECK_REFUSED(call_respond(&e), STICKSLIP_INVALID_VALUE, "node.mu");
  e.node = good;
  const double r[] = {0.0, -0.0, -1.0};
  for (int k = 0; k < COUNT(r); ++k) {
    e.node.augmentation = r[k];
    CHECK_REFUSED(call_respond(&e), STICKSLIP_INVALID_VALUE, "node.augmentation");
  }
  e.node = good;
  const double lengths[] = {0.0, 1e-3, 0.999, 1.001, 1e100};
  for (int k = 0; k < COUNT(lengths); ++k) {
    e.node.normal[2] = lengths[k];
    CHECK_REFUSED(call_respond(&e), STICKSLIP_INVALID_VALUE, "node.normal");
  }
  e.node = good;
  const int32_t wrong[] = {-1, 3, INT32_MAX, INT32_MIN};
  for (int k = 0; k < COUNT(wrong); ++k) {
    e.node = good;
    e.node.n_directions = wrong[k];
    CHECK_REFUSED(call_respond(&e), STICKSLIP_INVALID_VALUE, "node.n_directions");
    e.node = good;
    e.node.slip = wrong[k];
    CHECK_REFUSED(call_respond(&e), STICKSLIP_INVALID_VALUE, "node.slip");
  }
  /* Not unit, twice the same, not orthogonal to the normal, not orthogonal to each other. */
  const double directions[5][6] = {{2.0, 0.0, 0.0, 0.0, 1.0, 0.0},
                                   {1.0, 0.0, 0.0, 1.0, 0.0, 0.0},
                                   {1.0, 0.0, 0.0, 0.0, 0.0, 1.0},
                                   {0.8, 0.0, 0.6, 0.0, 1.0, 0.0},
                                   {1.0, 0.0, 0.0, 0.5, 1.0, 0.0}};
  for (int k = 0; k < 5; ++k) {
    e.node = good;
    e.node.n_directions = 2;
    memcpy(e.node.directions, directions[k], sizeof directions[k]);
    CHECK_REFUSED(call_respond(&e), STICKSLIP_INVALID_VALUE, "node.directions");
  }
  e.node = good;
  e.node.coverage_min = -1.0;
  CHECK_REFUSED(call_respond(&e), STICKSLIP_INVALID_VALUE, "node.coverage_min");
  response_untouched(&e);

  e.node = good;
  const int32_t layouts[] = {-1, 2, INT32_MAX}, rules[] = {-1, 6, INT32_MAX}, points[] = {-1, 1, 11};
  for (int k = 0; k < COUNT(layouts); ++k) {
    element_init(&e);
    e.pair.layout = layouts[k];
    CHECK_REFUSED(call_tangent(&e), STICKSLIP_INVALID_VALUE, "pair.layout");
    e.pair.layout = 0;
    e.pair.quadrature = rules[k];
    CHECK_REFUSED(call_weights(&e), STICKSLIP_INVALID_VALUE, "pair.quadrature");
    e.pair.quadrature = 0;
    e.pair.element_points = points[k];
    CHECK_REFUSED(call_weights(&e), STICKSLIP_INVALID_VALUE, "pair.element_points");
    element_untouched(&e);
  }
}

static void handles(void) {
  static handle h;
  handle_init(&h);
  stickslip_interface *i = h.s.interface;
  double values[X1];
  CHECK_OK(call_interface_residual(&h));
  static handle expected;
  memcpy(expected.rows, h.rows, sizeof h.rows);

  for (int k = 0; k < X1; ++k) values[k] = 1.0;
  values[5] = -1e-9;
  CHECK_REFUSED(stickslip_interface_set_friction(i, values), STICKSLIP_INVALID_VALUE, "mu");
  CHECK_REFUSED(stickslip_interface_set_augmentation(i, values), STICKSLIP_INVALID_VALUE, "augmentation");
  values[5] = 0.0;
  CHECK_REFUSED(stickslip_interface_set_augmentation(i, values), STICKSLIP_INVALID_VALUE, "augmentation");
  CHECK_REFUSED(stickslip_interface_set_normals(i, values), STICKSLIP_INVALID_VALUE, "normal");

  /* Zero length; a direction given twice; a third direction; the normal left without a free part. */
  const int64_t same[3] = {4, 4, 4};
  double directions[9] = {0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0};
  CHECK_REFUSED(stickslip_interface_set_constraints(i, 1, same, directions), STICKSLIP_INVALID_VALUE, "constraint");
  CHECK_REFUSED(stickslip_interface_set_constraints(i, 3, same, directions), STICKSLIP_INVALID_VALUE, "constraint");
  directions[1] = 1.0;
  CHECK_REFUSED(stickslip_interface_set_constraints(i, 2, same, directions), STICKSLIP_INVALID_VALUE, "constraint");
  directions[1] = 0.0;
  directions[0] = 1.0;
  CHECK_REFUSED(stickslip_interface_set_constraints(i, 3, same, directions), STICKSLIP_UNDEFINED_NORMAL, "node 4");
  double normal[X1];
  stickslip_states out;
  memset(&out, 0, sizeof out);
  out.struct_size = sizeof out;
  out.normal = normal;
  CHECK_OK(stickslip_interface_states(i, h.s.x1, h.s.x2, h.s.lambda, NULL, &out));
  CHECK_REFUSED(stickslip_interface_set_constraints(i, 1, same, normal + 12), STICKSLIP_UNDEFINED_NORMAL, "node 4");

  /* None of the refused overrides has acted. */
  CHECK_OK(call_interface_residual(&h));
  CHECK(memcmp(expected.rows, h.rows, sizeof h.rows) == 0);
  handle_fill(&h);
  handle_untouched(&h);
  scene_destroy(&h.s);
}

int main(void) {
  options();
  nodes();
  handles();
  return 0;
}
