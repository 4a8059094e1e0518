/* NaN and infinity, in every entry of every array: refused with the argument's name, nothing written. */
#include "calls.h"

static double bad[3];

/* Spoils one entry after the other of values, each with NaN and both infinities. */
#define NOT_FINITE(values, n, call, name)                          \
  for (int entry = 0; entry < (int)(n); ++entry) {                 \
    const double kept = (values)[entry];                           \
    for (int b = 0; b < 3; ++b) {                                  \
      (values)[entry] = bad[b];                                    \
      CHECK_REFUSED((call), STICKSLIP_NOT_FINITE, (name));         \
    }                                                              \
    (values)[entry] = kept;                                        \
  }

static void stateless(void) {
  static element e;
  element_init(&e);
  int32_t (*const pair_calls[])(element *) = {call_weights, call_gap, call_residual, call_tangent};
  for (int k = 0; k < COUNT(pair_calls); ++k) {
    NOT_FINITE(e.x1, 12, pair_calls[k](&e), "pair.x1");
    NOT_FINITE(e.x2, 12, pair_calls[k](&e), "pair.x2");
    if (k == 0) continue;
    NOT_FINITE(e.w.ab, 16, pair_calls[k](&e), "n_ab");
    NOT_FINITE(e.w.ac, 16, pair_calls[k](&e), "n_ac");
  }
  NOT_FINITE(e.traction, 12, call_residual(&e), "traction");
  NOT_FINITE(e.traction, 12, call_tangent(&e), "traction");
  NOT_FINITE(e.w.dab, 16 * 24, call_tangent(&e), "dn_ab");
  NOT_FINITE(e.w.dac, 16 * 24, call_tangent(&e), "dn_ac");
  NOT_FINITE(e.row_scale, 4, call_tangent(&e), "row_scale");
  for (int a = 0; a < 4; ++a) {
    NOT_FINITE(e.responses[a].drow_dnow, 9, call_tangent(&e), "drow_dnow");
    NOT_FINITE(e.responses[a].drow_dprevious, 9, call_tangent(&e), "drow_dprevious");
  }
  NOT_FINITE(e.responses[0].drow_dlambda, 9, call_block(&e), "drow_dlambda");
  NOT_FINITE(e.responses[0].row, 3, call_block(&e), "row");
  NOT_FINITE(e.x1, 12, call_facet(&e), "x");
  NOT_FINITE(e.sum, 3, call_normal(&e), "sum");
  element_untouched(&e);

  NOT_FINITE(e.node.lambda, 3, call_respond(&e), "lambda");
  NOT_FINITE(e.node.normal, 3, call_respond(&e), "normal");
  NOT_FINITE(e.node.gap_now, 3, call_respond(&e), "gap_now");
  NOT_FINITE(e.node.gap_previous, 3, call_respond(&e), "gap_previous");
  NOT_FINITE(e.node.gap_committed, 3, call_respond(&e), "gap_committed");
  NOT_FINITE(&e.node.augmentation, 1, call_respond(&e), "augmentation");
  NOT_FINITE(&e.node.mu, 1, call_respond(&e), "mu");
  NOT_FINITE(&e.node.coverage, 1, call_respond(&e), "coverage");
  NOT_FINITE(&e.node.coverage_previous, 1, call_respond(&e), "coverage_previous");
  NOT_FINITE(&e.node.coverage_min, 1, call_respond(&e), "coverage_min");
  e.node.n_directions = 2;
  e.node.directions[0] = e.node.directions[4] = 1.0;
  NOT_FINITE(e.node.directions, 6, call_respond(&e), "directions");
  response_untouched(&e);
}

static void handles(void) {
  static handle h;
  handle_init(&h);
  scene *s = &h.s;
  for (int k = 0; k < COUNT(evaluations); ++k) {
    NOT_FINITE(s->x1, X1, evaluations[k](&h), "x1");
    NOT_FINITE(s->x2, X2, evaluations[k](&h), "x2");
    if (k < LAMBDA_CALLS) NOT_FINITE(s->lambda, X1, evaluations[k](&h), "lambda");
  }
  double values[STICKSLIP_SUMS_PER_NODE * N1];
  CHECK_OK(stickslip_interface_sums(s->interface, s->x1, s->x2, values));
  NOT_FINITE(values, COUNT(values),
             stickslip_interface_residual(s->interface, s->x1, s->x2, s->lambda, values, h.force1, h.force2, h.rows),
             "sums");
  NOT_FINITE(values, COUNT(values), stickslip_interface_commit(s->interface, s->x1, s->x2, s->lambda, values), "sums");
  for (int a = 0; a < N1; ++a) {
    values[a] = 1.0;
    memcpy(values + N1 + 3 * a, s->lambda, 3 * sizeof *values);
  }
  NOT_FINITE(values, N1, stickslip_interface_set_friction(s->interface, values), "mu");
  NOT_FINITE(values, N1, stickslip_interface_set_augmentation(s->interface, values), "r");
  NOT_FINITE(s->lambda, X1, stickslip_interface_set_normals(s->interface, s->lambda), "normals");
  const int64_t nodes[1] = {4};
  NOT_FINITE(values, 3, stickslip_interface_set_constraints(s->interface, 1, nodes, values), "directions");
  static history imported;
  imported = h.before;
  NOT_FINITE(imported.reals, imported.n_reals,
             stickslip_interface_history_import(s->interface, imported.n_integers, imported.integers, imported.n_reals,
                                                imported.reals),
             "reals");
  handle_untouched(&h);

  NOT_FINITE(s->reference1, X1, call_create(s), "nonmortar.coordinates");
  NOT_FINITE(s->reference2, X2, call_create(s), "mortar.coordinates");
  NOT_FINITE(&s->options.mu, 1, call_create(s), "options.mu");
  NOT_FINITE(&s->options.augmentation, 1, call_create(s), "options.augmentation");
  NOT_FINITE(&s->options.modulus, 1, call_create(s), "options.modulus");
  NOT_FINITE(&s->options.search_distance, 1, call_create(s), "options.search_distance");
  NOT_FINITE(&s->options.coverage_min, 1, call_create(s), "options.coverage_min");
  NOT_FINITE(&s->options.weak_coverage, 1, call_create(s), "options.weak_coverage");
  NOT_FINITE(&s->options.turn_max, 1, call_create(s), "options.turn_max");
  scene_destroy(s);
}

int main(void) {
  bad[0] = NAN;
  bad[1] = INFINITY;
  bad[2] = -INFINITY;
  stateless();
  handles();
  return 0;
}
