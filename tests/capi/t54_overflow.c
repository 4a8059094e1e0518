/* Finite inputs whose results leave the range of doubles: refused, as stickslip_node_respond does for its row. An
 * infinity that goes out with a success ends in the host's linear solver, far from its cause. */
#include "calls.h"

static int all_finite(const double *v, int64_t n) {
  for (int64_t k = 0; k < n; ++k) {
    if (!isfinite(v[k])) return 0;
  }
  return 1;
}

#define REFUSED_OR_FINITE(status, values, n) CHECK((status) > STICKSLIP_OK || all_finite((values), (n)))

int main(void) {
  static element e;
  element_init(&e);
  for (int i = 0; i < 16; ++i) e.w.ab[i] = 1e308;
  for (int i = 0; i < 12; ++i) e.traction[i] = 1e10;
  for (int i = 0; i < 4; ++i) e.row_scale[i] = 1e300;
  REFUSED_OR_FINITE(call_gap(&e), e.gap, 12);
  REFUSED_OR_FINITE(call_residual(&e), e.force, 24);
  REFUSED_OR_FINITE(call_tangent(&e), e.k, 36 * 36);
  REFUSED_OR_FINITE(call_facet_tangent(&e), e.facet_k, 36 * 36);
  REFUSED_OR_FINITE(call_pair_dual(&e), e.dual_ab, 16 + 16);

  element_init(&e);
  for (int i = 0; i < 16; ++i) e.mass[i] *= 4e306;
  REFUSED_OR_FINITE(call_facet_dual(&e), e.dual_areas, 4 + 16);

  element_init(&e);
  for (int i = 0; i < 4; ++i) e.row_scale[i] = 1e308;
  REFUSED_OR_FINITE(call_facet_tangent(&e), e.facet_k, 36 * 36);

  element_init(&e);
  e.responses[0].row[0] = 1e300;
  REFUSED_OR_FINITE(stickslip_node_block(&e.responses[0], 1e300, 0, e.row, e.block), e.row, 3);

  /* A facet so small that the derivatives of its normals overflow; a node whose traction turns beyond all numbers. */
  element_init(&e);
  for (int i = 0; i < 12; ++i) e.x1[i] *= 1e-155;
  REFUSED_OR_FINITE(call_normal_derivatives(&e), e.normal_derivatives, 144);
  element_init(&e);
  e.node.gap_now[2] = -1e300;
  e.node.augmentation = 1e10;
  REFUSED_OR_FINITE(call_turn(&e), e.turn, 27);

  /* 1 / r overflows. */
  element_init(&e);
  e.node.augmentation = 1e-310;
  e.node.lambda[2] = 0.0;
  e.node.gap_now[2] = 1.0;
  REFUSED_OR_FINITE(call_respond(&e), e.responses[3].drow_dlambda, 9);

  /* A mortar side that a diverging iteration has thrown far out: squares of its facets' areas overflow. */
  const double sizes[] = {1e75, 1e80, 1e120, 1e154, 1e200};
  static handle h;
  for (int k = 0; k < COUNT(sizes); ++k) {
    element_init(&e);
    for (int i = 0; i < 12; ++i) e.x2[i] *= sizes[k];
    const int32_t status = call_weights(&e);
    REFUSED_OR_FINITE(status, e.w_out.ab, 16 * (2 + 2 * 24));

    handle_init(&h);
    for (int i = 0; i < X2; ++i) h.s.x2[i] *= sizes[k];
    REFUSED_OR_FINITE(call_interface_residual(&h), h.force1, X1 + X2 + X1);
    REFUSED_OR_FINITE(call_interface_coo(&h), h.values, h.count);
    scene_destroy(&h.s);
  }

  /* A stiffness for which the handle's tangent overflows while its residual does not. */
  const double stiffness[] = {1e-320, 1e-310, 1e300, 1.7e308};
  for (int k = 0; k < COUNT(stiffness); ++k) {
    memset(&h, 0, sizeof h);
    scene_init(&h.s);
    h.s.method.augmentation = stiffness[k];
    if (stickslip_interface_create(&h.s.nonmortar, &h.s.mortar, &h.s.options, &h.s.interface) != STICKSLIP_OK) continue;
    double lambda[X1];
    memset(lambda, 0, sizeof lambda);
    REFUSED_OR_FINITE(stickslip_interface_initial_multipliers(h.s.interface, lambda), lambda, X1);
    memset(h.s.lambda, 0, sizeof h.s.lambda);
    REFUSED_OR_FINITE(call_interface_residual(&h), h.rows, X1);
    REFUSED_OR_FINITE(call_interface_coo(&h), h.values, h.count);
    scene_destroy(&h.s);
  }
  return 0;
}
