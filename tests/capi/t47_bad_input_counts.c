/* Counts and offsets: negative, too small, far too large, decreasing. */
#include "calls.h"

int main(void) {
  static scene s;
  const int64_t counts[] = {INT64_MIN, -1, 0, INT64_MAX, INT64_MAX / 3 + 1, INT64_MAX / 24 + 1, (int64_t)1 << 62};
  for (int k = 0; k < COUNT(counts); ++k) {
    scene_init(&s);
    s.nonmortar.n_nodes = counts[k];
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_SIZE, "nonmortar.n_nodes");
    scene_init(&s);
    s.nonmortar.n_facets = counts[k];
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_SIZE, "nonmortar.n_facets");
    scene_init(&s);
    s.mortar.n_nodes = counts[k];
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_SIZE, "mortar.n_nodes");
    scene_init(&s);
    s.mortar.n_facets = counts[k];
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_SIZE, "mortar.n_facets");
  }
  for (int64_t n = 1; n < 3; ++n) {
    scene_init(&s);
    s.nonmortar.n_nodes = n;
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_SIZE, "nonmortar.n_nodes");
  }

  /* Facets have 3 or 4 nodes, so offsets grow by 3 or 4 from 0. */
  const int64_t first[] = {1, -4, INT64_MIN, INT64_MAX};
  const int64_t second[] = {-4, 0, 2, 5, 8, INT64_MAX, INT64_MIN};
  for (int k = 0; k < COUNT(first); ++k) {
    scene_init(&s);
    s.offsets1[0] = first[k];
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_SIZE, "nonmortar.facet_offsets[0]");
  }
  for (int k = 0; k < COUNT(second); ++k) {
    scene_init(&s);
    s.offsets2[1] = second[k];
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_SIZE, "mortar.facet_offsets[1]");
    scene_init(&s);
    s.offsets2[9] = second[k] == 2 ? 0 : second[k]; /* decreasing at the end */
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_SIZE, "mortar.facet_offsets[9]");
  }

  static handle h;
  handle_init(&h);
  stickslip_interface *i = h.s.interface;
  double *x1 = h.s.x1, *x2 = h.s.x2, *l = h.s.lambda;
  const int64_t wrong[] = {INT64_MIN, -1, INT64_MAX, INT64_MAX / 8 + 1};
  for (int k = 0; k < COUNT(wrong); ++k) {
    CHECK_REFUSED(stickslip_interface_set_constraints(i, wrong[k], h.s.nodes1, l), STICKSLIP_INVALID_SIZE, "n");
    CHECK_REFUSED(stickslip_interface_tangent_csr(i, x1, x2, l, NULL, wrong[k], h.offsets, h.csr_columns, h.csr),
                  STICKSLIP_INVALID_SIZE, "n_rows");
    CHECK_REFUSED(stickslip_interface_history_import(i, wrong[k], h.before.integers, 9, h.before.reals),
                  STICKSLIP_INVALID_SIZE, "n_integers");
    CHECK_REFUSED(stickslip_interface_history_import(i, 9, h.before.integers, wrong[k], h.before.reals),
                  STICKSLIP_INVALID_SIZE, "n_reals");
  }
  CHECK_REFUSED(stickslip_interface_tangent_csr(i, x1, x2, l, NULL, 0, h.offsets, h.csr_columns, h.csr),
                STICKSLIP_INVALID_SIZE, "n_rows");

  /* CSR offsets: not from the base, decreasing, huge. */
  const struct {
    int at;
    int64_t value;
  } offsets[] = {{0, 1}, {0, -1}, {7, 3}, {7, INT64_MAX}, {7, INT64_MIN}, {UNKNOWNS, INT64_MAX}, {UNKNOWNS, 5}};
  for (int k = 0; k < COUNT(offsets); ++k) {
    const int64_t kept = h.offsets[offsets[k].at];
    h.offsets[offsets[k].at] = offsets[k].value;
    /* Of two numbers that decrease the second one is named; after the largest integer any does. */
    char name[40];
    const int named = offsets[k].value == INT64_MAX && offsets[k].at < UNKNOWNS ? offsets[k].at + 1 : offsets[k].at;
    if (offsets[k].at == UNKNOWNS && offsets[k].value == INT64_MAX) {
      snprintf(name, sizeof name, "row_offsets[n_rows]");
    } else {
      snprintf(name, sizeof name, "row_offsets[%d] is ", named);
    }
    CHECK_REFUSED(call_interface_csr(&h), STICKSLIP_INVALID_SIZE, name);
    h.offsets[offsets[k].at] = kept;
  }
  handle_untouched(&h);

  static element e;
  element_init(&e);
  const int64_t ld[] = {INT64_MIN, -36, 0, 35, INT64_MAX, INT64_MAX / 36 + 1};
  for (int k = 0; k < COUNT(ld); ++k) {
    CHECK_REFUSED(stickslip_pair_tangent(&e.pair, e.w.ab, e.w.ac, NULL, NULL, NULL, NULL, e.traction, e.responses, NULL,
                                         e.k, ld[k]), STICKSLIP_INVALID_SIZE, "ld");
  }
  element_untouched(&e);
  scene_destroy(&h.s);
  return 0;
}
