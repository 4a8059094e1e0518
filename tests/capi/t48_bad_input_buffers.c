/* Buffers that are too small, and a matrix that lacks an entry: nothing is written, nothing is added. */
#include "calls.h"

int main(void) {
  static handle h;
  handle_init(&h);
  scene *s = &h.s;
  stickslip_interface *i = s->interface;
  int64_t n = 0;

  CHECK_OK(stickslip_interface_tangent_coo(i, s->x1, s->x2, s->lambda, NULL, 0, NULL, NULL, NULL, &n));
  const int64_t capacities[] = {n - 1, 1, 0, -1, INT64_MIN};
  for (int k = 0; k < COUNT(capacities); ++k) {
    CHECK_REFUSED(stickslip_interface_tangent_coo(i, s->x1, s->x2, s->lambda, NULL, capacities[k], h.row_numbers,
                                                  h.columns, h.values, &h.count), STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  }
  CHECK_OK(stickslip_interface_pattern_coo(i, s->x1, s->x2, 0, NULL, NULL, &n));
  const int64_t fewer[] = {n - 1, 0, -1, INT64_MIN};
  for (int k = 0; k < COUNT(fewer); ++k) {
    CHECK_REFUSED(stickslip_interface_pattern_coo(i, s->x1, s->x2, fewer[k], h.row_numbers, h.columns, &h.count),
                  STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  }
  const history *b = &h.before;
  CHECK_REFUSED(stickslip_interface_history_export(i, b->n_integers - 1, h.columns, b->n_reals, h.values),
                STICKSLIP_BUFFER_TOO_SMALL, "n_integers");
  CHECK_REFUSED(stickslip_interface_history_export(i, b->n_integers, h.columns, b->n_reals - 1, h.values),
                STICKSLIP_BUFFER_TOO_SMALL, "n_reals");
  CHECK_REFUSED(stickslip_interface_history_export(i, -1, h.columns, -1, h.values), STICKSLIP_BUFFER_TOO_SMALL,
                "n_integers");

  /* Each entry that the tangent needs, missing once; then too few rows; then an empty matrix. */
  static triplets t;
  scene_tangent(s, &t);
  for (int64_t e = 0; e < t.n; e += 1 + t.n / 40) {
    const int64_t row = t.rows[e], at = row * UNKNOWNS + t.columns[e];
    h.csr_columns[at] = row == 0 ? 1 : 0; /* twice in its row: allowed, but another one is gone */
    if (t.columns[e] == h.csr_columns[at]) h.csr_columns[at] = 2;
    CHECK_REFUSED(call_interface_csr(&h), STICKSLIP_MISSING_ENTRY, "pattern");
    h.csr_columns[at] = t.columns[e];
  }
  CHECK_REFUSED(stickslip_interface_tangent_csr(i, s->x1, s->x2, s->lambda, NULL, UNKNOWNS - 1, h.offsets,
                                                h.csr_columns, h.csr), STICKSLIP_INDEX_OUT_OF_RANGE, "rows");
  memset(h.offsets, 0, sizeof h.offsets);
  CHECK_REFUSED(call_interface_csr(&h), STICKSLIP_MISSING_ENTRY, "pattern");
  handle_untouched(&h);
  scene_destroy(s);
  return 0;
}
