/* A NULL where something is needed: refused by name, nothing written. */
#include "calls.h"

#define NULL_IS_REFUSED(call, name) CHECK_REFUSED((call), STICKSLIP_NULL_POINTER, (name))

static void stateless(void) {
  static element e;
  element_init(&e);
  double *ab = e.w.ab, *ac = e.w.ac, *dab = e.w.dab, *dac = e.w.dac, *t = e.traction;
  const stickslip_pair *pair = &e.pair;

  NULL_IS_REFUSED(stickslip_pair_weights(NULL, e.w_out.ab, e.w_out.ac, NULL, NULL), "stickslip_pair");
  NULL_IS_REFUSED(stickslip_pair_gap(NULL, ab, ac, e.gap), "stickslip_pair");
  NULL_IS_REFUSED(stickslip_pair_gap(pair, NULL, ac, e.gap), "n_ab");
  NULL_IS_REFUSED(stickslip_pair_gap(pair, ab, NULL, e.gap), "n_ac");
  NULL_IS_REFUSED(stickslip_pair_gap(pair, ab, ac, NULL), "gap");
  NULL_IS_REFUSED(stickslip_pair_residual(NULL, ab, ac, t, e.force), "stickslip_pair");
  NULL_IS_REFUSED(stickslip_pair_residual(pair, NULL, ac, t, e.force), "n_ab");
  NULL_IS_REFUSED(stickslip_pair_residual(pair, ab, NULL, t, e.force), "n_ac");
  NULL_IS_REFUSED(stickslip_pair_residual(pair, ab, ac, NULL, e.force), "traction");
  NULL_IS_REFUSED(stickslip_pair_residual(pair, ab, ac, t, NULL), "force");
  stickslip_node_response *r = e.responses;
  NULL_IS_REFUSED(stickslip_pair_tangent(NULL, ab, ac, dab, dac, ab, ac, t, r, NULL, e.k, 36), "stickslip_pair");
  NULL_IS_REFUSED(stickslip_pair_tangent(pair, NULL, ac, dab, dac, ab, ac, t, r, NULL, e.k, 36), "n_ab");
  NULL_IS_REFUSED(stickslip_pair_tangent(pair, ab, NULL, dab, dac, ab, ac, t, r, NULL, e.k, 36), "n_ac");
  NULL_IS_REFUSED(stickslip_pair_tangent(pair, ab, ac, NULL, dac, ab, ac, t, r, NULL, e.k, 36), "dn_ab");
  NULL_IS_REFUSED(stickslip_pair_tangent(pair, ab, ac, dab, NULL, ab, ac, t, r, NULL, e.k, 36), "dn_ac");
  NULL_IS_REFUSED(stickslip_pair_tangent(pair, ab, ac, dab, dac, NULL, ac, t, r, NULL, e.k, 36), "n_ab_previous");
  NULL_IS_REFUSED(stickslip_pair_tangent(pair, ab, ac, dab, dac, ab, NULL, t, r, NULL, e.k, 36), "n_ac_previous");
  NULL_IS_REFUSED(stickslip_pair_tangent(pair, ab, ac, dab, dac, ab, ac, NULL, r, NULL, e.k, 36), "traction");
  NULL_IS_REFUSED(stickslip_pair_tangent(pair, ab, ac, dab, dac, ab, ac, t, NULL, NULL, e.k, 36), "responses");
  NULL_IS_REFUSED(stickslip_pair_tangent(pair, ab, ac, dab, dac, ab, ac, t, r, NULL, NULL, 36), "k");
  NULL_IS_REFUSED(stickslip_node_respond(NULL, r), "stickslip_node");
  NULL_IS_REFUSED(stickslip_node_respond(&e.node, NULL), "stickslip_node_response");
  NULL_IS_REFUSED(stickslip_node_block(NULL, 1.0, 0, e.row, e.block), "stickslip_node_response");
  NULL_IS_REFUSED(stickslip_facet_geometry(4, NULL, e.normals, e.areas), "x");
  NULL_IS_REFUSED(stickslip_node_normal(NULL, e.normal), "sum");
  NULL_IS_REFUSED(stickslip_node_normal(e.sum, NULL), "normal");
  NULL_IS_REFUSED(stickslip_options_init(NULL, sizeof(stickslip_options)), "options");

  const double *kept = e.pair.x1;
  e.pair.x1 = NULL;
  NULL_IS_REFUSED(call_weights(&e), "pair.x1");
  e.pair.x1 = kept;
  e.pair.x2 = NULL;
  NULL_IS_REFUSED(call_weights(&e), "pair.x2");
  element_untouched(&e);
}

static void creation(void) {
  static scene s;
  scene_init(&s);
  stickslip_interface *out;
  FILL(out);
  NULL_IS_REFUSED(stickslip_interface_create(NULL, &s.mortar, &s.options, &out), "nonmortar");
  NULL_IS_REFUSED(stickslip_interface_create(&s.nonmortar, NULL, &s.options, &out), "mortar");
  NULL_IS_REFUSED(stickslip_interface_create(&s.nonmortar, &s.mortar, NULL, &out), "options");
  NULL_IS_REFUSED(stickslip_interface_create(&s.nonmortar, &s.mortar, &s.options, NULL), "out");
  for (int side = 0; side < 2; ++side) {
    stickslip_surface surfaces[2] = {s.nonmortar, s.mortar};
    stickslip_surface *spoilt = &surfaces[side];
    const stickslip_surface good = *spoilt;
    const char *names[4] = {"mortar.coordinates", "mortar.facet_offsets", "mortar.facet_nodes", "mortar.equations"};
    for (int member = 0; member < 4; ++member) {
      *spoilt = good;
      if (member == 0) spoilt->coordinates = NULL;
      if (member == 1) spoilt->facet_offsets = NULL;
      if (member == 2) spoilt->facet_nodes = NULL;
      if (member == 3) spoilt->equations = NULL;
      NULL_IS_REFUSED(stickslip_interface_create(&surfaces[0], &surfaces[1], &s.options, &out), names[member]);
      /* Which of the two: "nonmortar.x" holds "mortar.x" as well. */
      CHECK((strncmp(stickslip_last_error_message(), "non", 3) == 0) == (side == 0));
    }
  }
  s.nonmortar.multiplier_equations = NULL;
  NULL_IS_REFUSED(stickslip_interface_create(&s.nonmortar, &s.mortar, &s.options, &out),
                  "nonmortar.multiplier_equations");
  CHECK_UNTOUCHED(out);
}

static void handles(void) {
  static handle h;
  handle_init(&h);
  scene *s = &h.s;
  stickslip_interface *i = s->interface;
  double *x1 = s->x1, *x2 = s->x2, *l = s->lambda;

  /* No handle. */
  s->interface = NULL;
  for (int k = 0; k < COUNT(evaluations); ++k) NULL_IS_REFUSED(evaluations[k](&h), "interface");
  stickslip_counters counters;
  FILL(counters);
  counters.struct_size = sizeof counters;
  NULL_IS_REFUSED(stickslip_interface_counters(NULL, &counters), "interface");
  NULL_IS_REFUSED(stickslip_interface_rollback(NULL), "interface");
  NULL_IS_REFUSED(stickslip_interface_set_friction(NULL, l), "interface");
  NULL_IS_REFUSED(stickslip_interface_set_augmentation(NULL, l), "interface");
  NULL_IS_REFUSED(stickslip_interface_set_normals(NULL, l), "interface");
  NULL_IS_REFUSED(stickslip_interface_set_constraints(NULL, 0, NULL, NULL), "interface");
  NULL_IS_REFUSED(stickslip_interface_initial_multipliers(NULL, h.rows), "interface");
  NULL_IS_REFUSED(stickslip_interface_history_size(NULL, &h.count, &h.count), "interface");
  NULL_IS_REFUSED(stickslip_interface_history_export(NULL, 9, h.columns, 9, h.values), "interface");
  NULL_IS_REFUSED(stickslip_interface_history_import(NULL, 9, h.columns, 9, h.values), "interface");
  s->interface = i;

  /* No argument. */
  NULL_IS_REFUSED(stickslip_interface_counters(i, NULL), "stickslip_counters");
  NULL_IS_REFUSED(stickslip_interface_set_friction(i, NULL), "mu");
  NULL_IS_REFUSED(stickslip_interface_set_constraints(i, 1, NULL, l), "nodes");
  NULL_IS_REFUSED(stickslip_interface_set_constraints(i, 1, s->nodes1, NULL), "directions");
  NULL_IS_REFUSED(stickslip_interface_set_previous(i, NULL, x2), "x1");
  NULL_IS_REFUSED(stickslip_interface_set_previous(i, x1, NULL), "x2");
  NULL_IS_REFUSED(stickslip_interface_initial_multipliers(i, NULL), "lambda");
  NULL_IS_REFUSED(stickslip_interface_sums(i, NULL, x2, h.sums), "x1");
  NULL_IS_REFUSED(stickslip_interface_sums(i, x1, NULL, h.sums), "x2");
  NULL_IS_REFUSED(stickslip_interface_sums(i, x1, x2, NULL), "sums");
  NULL_IS_REFUSED(stickslip_interface_states(i, NULL, x2, l, NULL, &h.states), "x1");
  NULL_IS_REFUSED(stickslip_interface_states(i, x1, NULL, l, NULL, &h.states), "x2");
  NULL_IS_REFUSED(stickslip_interface_states(i, x1, x2, NULL, NULL, &h.states), "lambda");
  NULL_IS_REFUSED(stickslip_interface_states(i, x1, x2, l, NULL, NULL), "stickslip_states");
  NULL_IS_REFUSED(stickslip_interface_residual(i, NULL, x2, l, NULL, h.force1, h.force2, h.rows), "x1");
  NULL_IS_REFUSED(stickslip_interface_residual(i, x1, NULL, l, NULL, h.force1, h.force2, h.rows), "x2");
  NULL_IS_REFUSED(stickslip_interface_residual(i, x1, x2, NULL, NULL, h.force1, h.force2, h.rows), "lambda");
  NULL_IS_REFUSED(stickslip_interface_residual(i, x1, x2, l, NULL, NULL, h.force2, h.rows), "force1");
  NULL_IS_REFUSED(stickslip_interface_residual(i, x1, x2, l, NULL, h.force1, NULL, h.rows), "force2");
  NULL_IS_REFUSED(stickslip_interface_residual(i, x1, x2, l, NULL, h.force1, h.force2, NULL), "rows");
  NULL_IS_REFUSED(stickslip_interface_commit(i, NULL, x2, l, NULL), "x1");
  NULL_IS_REFUSED(stickslip_interface_commit(i, x1, NULL, l, NULL), "x2");
  NULL_IS_REFUSED(stickslip_interface_commit(i, x1, x2, NULL, NULL), "lambda");
  NULL_IS_REFUSED(stickslip_interface_history_size(i, NULL, &h.count), "n_integers");
  NULL_IS_REFUSED(stickslip_interface_history_size(i, &h.count, NULL), "n_reals");
  NULL_IS_REFUSED(stickslip_interface_history_export(i, MOST_ENTRIES, NULL, MOST_ENTRIES, h.values), "integers");
  NULL_IS_REFUSED(stickslip_interface_history_export(i, MOST_ENTRIES, h.columns, MOST_ENTRIES, NULL), "reals");
  NULL_IS_REFUSED(stickslip_interface_history_import(i, 5, NULL, 9, l), "integers");
  NULL_IS_REFUSED(stickslip_interface_history_import(i, 5, s->nodes1, 9, NULL), "reals");
  int64_t *rows = h.row_numbers, *columns = h.columns, n = MOST_ENTRIES;
  double *values = h.values;
  NULL_IS_REFUSED(stickslip_interface_tangent_coo(i, x1, x2, l, NULL, n, NULL, columns, values, &h.count), "rows");
  NULL_IS_REFUSED(stickslip_interface_tangent_coo(i, x1, x2, l, NULL, n, rows, NULL, values, &h.count), "columns");
  NULL_IS_REFUSED(stickslip_interface_tangent_coo(i, x1, x2, l, NULL, n, rows, columns, NULL, &h.count), "values");
  NULL_IS_REFUSED(stickslip_interface_tangent_coo(i, x1, x2, l, NULL, n, rows, columns, values, NULL), "count");
  NULL_IS_REFUSED(stickslip_interface_tangent_coo(i, x1, x2, NULL, NULL, n, rows, columns, values, &h.count), "lambda");
  NULL_IS_REFUSED(stickslip_interface_pattern_coo(i, x1, x2, n, NULL, columns, &h.count), "rows");
  NULL_IS_REFUSED(stickslip_interface_pattern_coo(i, x1, x2, n, rows, NULL, &h.count), "columns");
  NULL_IS_REFUSED(stickslip_interface_pattern_coo(i, x1, x2, n, rows, columns, NULL), "count");
  NULL_IS_REFUSED(stickslip_interface_pattern_coo(i, NULL, x2, n, rows, columns, &h.count), "x1");
  NULL_IS_REFUSED(stickslip_interface_tangent_csr(i, x1, x2, l, NULL, 3, NULL, columns, h.csr), "row_offsets");
  NULL_IS_REFUSED(stickslip_interface_tangent_csr(i, x1, x2, l, NULL, UNKNOWNS, h.offsets, NULL, h.csr), "columns");
  NULL_IS_REFUSED(stickslip_interface_tangent_csr(i, x1, x2, l, NULL, UNKNOWNS, h.offsets, h.csr_columns, NULL), "values");
  check_untouched(&counters.pairs_tested, sizeof counters - 8, __FILE__, __LINE__, "counters");
  handle_untouched(&h);
  scene_destroy(s);
}

int main(void) {
  stateless();
  creation();
  handles();
  return 0;
}
