/* A misaligned pointer is refused like NULL: reading through it would be undefined. */
#include "calls.h"

/* One byte into an array, through a type that hides it from the compiler. */
static void *crooked(void *p) { return (char *)p + 1; }

#define CROOKED_IS_REFUSED(call, name) CHECK_REFUSED((call), STICKSLIP_NULL_POINTER, (name))

int main(void) {
  static element e;
  element_init(&e);
  CROOKED_IS_REFUSED(stickslip_pair_weights(crooked(&e.pair), e.w_out.ab, NULL, NULL, NULL), "stickslip_pair");
  CROOKED_IS_REFUSED(stickslip_pair_weights(&e.pair, crooked(e.w_out.ab), NULL, NULL, NULL), "n_ab");
  CROOKED_IS_REFUSED(stickslip_pair_weights(&e.pair, NULL, crooked(e.w_out.ac), NULL, NULL), "n_ac");
  CROOKED_IS_REFUSED(stickslip_pair_weights(&e.pair, e.w_out.ab, NULL, crooked(e.w_out.dab), NULL), "dn_ab");
  CROOKED_IS_REFUSED(stickslip_pair_weights(&e.pair, e.w_out.ab, NULL, NULL, crooked(e.w_out.dac)), "dn_ac");
  CROOKED_IS_REFUSED(stickslip_pair_gap(&e.pair, e.w.ab, e.w.ac, crooked(e.gap)), "gap");
  CROOKED_IS_REFUSED(stickslip_pair_gap(&e.pair, crooked(e.w.ab), e.w.ac, e.gap), "n_ab");
  CROOKED_IS_REFUSED(stickslip_pair_residual(&e.pair, e.w.ab, e.w.ac, crooked(e.traction), e.force), "traction");
  CROOKED_IS_REFUSED(stickslip_pair_residual(&e.pair, e.w.ab, e.w.ac, e.traction, crooked(e.force)), "force");
  CROOKED_IS_REFUSED(stickslip_pair_tangent(&e.pair, e.w.ab, e.w.ac, NULL, NULL, NULL, NULL, e.traction,
                                            crooked(e.responses), NULL, e.k, 36), "responses");
  CROOKED_IS_REFUSED(stickslip_pair_tangent(&e.pair, e.w.ab, e.w.ac, NULL, NULL, NULL, NULL, e.traction, e.responses,
                                            crooked(e.row_scale), e.k, 36), "row_scale");
  CROOKED_IS_REFUSED(stickslip_pair_tangent(&e.pair, e.w.ab, e.w.ac, NULL, NULL, NULL, NULL, e.traction, e.responses,
                                            NULL, crooked(e.k), 36), "k");
  CROOKED_IS_REFUSED(stickslip_node_respond(crooked(&e.node), &e.responses[3]), "stickslip_node");
  CROOKED_IS_REFUSED(stickslip_node_respond(&e.node, crooked(&e.responses[3])), "stickslip_node_response");
  CROOKED_IS_REFUSED(stickslip_node_block(&e.responses[0], 1.0, 0, crooked(e.row), e.block), "row");
  CROOKED_IS_REFUSED(stickslip_node_block(&e.responses[0], 1.0, 0, e.row, crooked(e.block)), "block");
  CROOKED_IS_REFUSED(stickslip_facet_geometry(4, crooked(e.x1), e.normals, e.areas), "x");
  CROOKED_IS_REFUSED(stickslip_facet_geometry(4, e.x1, crooked(e.normals), e.areas), "normals");
  CROOKED_IS_REFUSED(stickslip_facet_geometry(4, e.x1, e.normals, crooked(e.areas)), "areas");
  e.pair.x2 = crooked(e.x2);
  CROOKED_IS_REFUSED(call_weights(&e), "pair.x2");
  element_untouched(&e);

  static handle h;
  handle_init(&h);
  scene *s = &h.s;
  stickslip_interface *i = s->interface;
  double *x1 = s->x1, *x2 = s->x2, *l = s->lambda;
  CROOKED_IS_REFUSED(stickslip_interface_rollback(crooked(i)), "interface");
  CROOKED_IS_REFUSED(stickslip_interface_destroy(crooked(&s->interface)), "interface");
  stickslip_interface *crooked_handle = crooked(i);
  CROOKED_IS_REFUSED(stickslip_interface_destroy(&crooked_handle), "interface");
  CHECK(crooked_handle == crooked(i));
  CROOKED_IS_REFUSED(stickslip_interface_residual(i, crooked(x1), x2, l, NULL, h.force1, h.force2, h.rows), "x1");
  CROOKED_IS_REFUSED(stickslip_interface_residual(i, x1, x2, l, crooked(x1), h.force1, h.force2, h.rows), "sums");
  CROOKED_IS_REFUSED(stickslip_interface_residual(i, x1, x2, l, NULL, h.force1, h.force2, crooked(h.rows)), "rows");
  CROOKED_IS_REFUSED(stickslip_interface_sums(i, x1, x2, crooked(h.sums)), "sums");
  CROOKED_IS_REFUSED(stickslip_interface_set_augmentation(i, crooked(x1)), "r");
  CROOKED_IS_REFUSED(stickslip_interface_set_normals(i, crooked(x1)), "normals");
  CROOKED_IS_REFUSED(stickslip_interface_tangent_coo(i, x1, x2, l, NULL, MOST_ENTRIES, crooked(h.row_numbers),
                                                     h.columns, h.values, &h.count), "rows");
  CROOKED_IS_REFUSED(stickslip_interface_tangent_coo(i, x1, x2, l, NULL, MOST_ENTRIES, h.row_numbers, h.columns,
                                                     h.values, crooked(h.row_numbers)), "count");
  CROOKED_IS_REFUSED(stickslip_interface_tangent_csr(i, x1, x2, l, NULL, UNKNOWNS, h.offsets, h.csr_columns,
                                                     crooked(h.csr)), "values");
  h.states.normal = crooked(h.normal);
  CROOKED_IS_REFUSED(call_interface_states(&h), "stickslip_states");
  h.states.normal = h.normal;
  h.states.state = crooked(h.state);
  CROOKED_IS_REFUSED(call_interface_states(&h), "stickslip_states.state");
  handle_untouched(&h);
  stickslip_interface *out;
  FILL(out);
  s->nonmortar.coordinates = crooked(s->reference1);
  CROOKED_IS_REFUSED(stickslip_interface_create(&s->nonmortar, &s->mortar, &s->options, &out), "nonmortar.coordinates");
  CHECK_UNTOUCHED(out);
  scene_destroy(s);
  return 0;
}
