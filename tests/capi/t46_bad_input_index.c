/* Indices out of range, in either base: nodes of facets, equations, nodes of constraints. */
#include "calls.h"

int main(void) {
  static scene s;
  for (int64_t base = 0; base < 2; ++base) {
    const int64_t extreme[] = {INT64_MIN, INT64_MIN + 1, -2, base - 1, INT64_MAX, INT64_MAX - 1};
    for (int k = 0; k < COUNT(extreme); ++k) {
      scene_init_base(&s, base);
      s.nodes1[5] = extreme[k];
      CHECK_REFUSED(call_create(&s), STICKSLIP_INDEX_OUT_OF_RANGE, "nonmortar");
      scene_init_base(&s, base);
      s.nodes2[35] = extreme[k];
      CHECK_REFUSED(call_create(&s), STICKSLIP_INDEX_OUT_OF_RANGE, "mortar");

      /* Equations may be as large as the host likes; -1 means none. */
      if (extreme[k] > 0 || extreme[k] == -1) continue;
      scene_init_base(&s, base);
      s.equations1[7] = extreme[k];
      CHECK_REFUSED(call_create(&s), STICKSLIP_INDEX_OUT_OF_RANGE, "nonmortar.equations[7]");
      scene_init_base(&s, base);
      s.equations2[0] = extreme[k];
      CHECK_REFUSED(call_create(&s), STICKSLIP_INDEX_OUT_OF_RANGE, "mortar.equations[0]");
      scene_init_base(&s, base);
      s.multipliers[26] = extreme[k];
      CHECK_REFUSED(call_create(&s), STICKSLIP_INDEX_OUT_OF_RANGE, "nonmortar.multiplier_equations[26]");
    }
    /* A multiplier's equation is nobody else's: of a displacement of either side, or of another multiplier. */
    scene_init_base(&s, base);
    s.multipliers[26] = s.equations1[4];
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE,
                  "nonmortar.multiplier_equations[26] and nonmortar.equations[4] are the same equation");
    scene_init_base(&s, base);
    s.multipliers[2] = s.equations2[47];
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE,
                  "nonmortar.multiplier_equations[2] and mortar.equations[47] are the same equation");
    scene_init_base(&s, base);
    s.multipliers[8] = s.multipliers[3];
    CHECK_REFUSED(call_create(&s), STICKSLIP_INVALID_VALUE,
                  "nonmortar.multiplier_equations[3] and nonmortar.multiplier_equations[8] are the same equation");
    /* Displacements may share theirs, and several components may have none. */
    scene_init_base(&s, base);
    s.equations1[7] = s.equations1[4];
    s.equations2[3] = s.equations1[4];
    s.multipliers[4] = s.multipliers[5] = -1;
    scene_create(&s);
    scene_destroy(&s);

    /* One beyond the last. */
    scene_init_base(&s, base);
    s.nodes1[0] = base + N1;
    CHECK_REFUSED(call_create(&s), STICKSLIP_INDEX_OUT_OF_RANGE, "nonmortar");

    scene_init_base(&s, base);
    scene_create(&s);
    const double direction[3] = {0.0, 1.0, 0.0};
    const int64_t nodes[] = {INT64_MIN, -1, base - 1, base + N1, INT64_MAX};
    for (int k = 0; k < COUNT(nodes); ++k) {
      CHECK_REFUSED(stickslip_interface_set_constraints(s.interface, 1, nodes + k, direction),
                    STICKSLIP_INDEX_OUT_OF_RANGE, "nodes[0]");
    }
    scene_destroy(&s);
  }

  /* Equations near the end of the integers come back as they are; a matrix without their rows is refused. */
  static handle h;
  handle_init(&h);
  scene_destroy(&h.s);
  h.s.equations1[4] = INT64_MAX;
  scene_create(&h.s);
  scene_commit(&h.s);
  history_take(h.s.interface, &h.before);
  const int32_t status = call_interface_csr(&h);
  CHECK(status == STICKSLIP_INDEX_OUT_OF_RANGE || status == STICKSLIP_MISSING_ENTRY);
  CHECK(strstr(stickslip_last_error_message(), "9223372036854775807") != NULL);
  handle_untouched(&h);
  CHECK_OK(call_interface_coo(&h));
  int seen = 0;
  for (int64_t e = 0; e < h.count; ++e) seen += h.row_numbers[e] == INT64_MAX;
  CHECK(seen > 0);
  scene_destroy(&h.s);
  return 0;
}
