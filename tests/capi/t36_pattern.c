/* The pattern holds every entry that a tangent writes while nothing moves out of the search's skin. */
#include "scene.h"

static char entry[UNKNOWNS][UNKNOWNS];
static triplets t;

int main(void) {
  static scene s;
  for (int32_t form = 0; form < 2; ++form) {
    for (int32_t weights = STICKSLIP_WEIGHTS_CURRENT; weights <= STICKSLIP_WEIGHTS_REFERENCE; ++weights) {
      scene_init(&s);
      s.method.form = form;
      s.method.weights = weights;
      scene_create(&s);
      scene_commit(&s);

      int64_t count, written;
      CHECK_OK(stickslip_interface_pattern_coo(s.interface, s.x1, s.x2, 0, NULL, NULL, &count));
      CHECK(0 < count && count <= MOST_ENTRIES);
      CHECK_OK(stickslip_interface_pattern_coo(s.interface, s.x1, s.x2, count, t.rows, t.columns, &written));
      CHECK(written == count);
      memset(entry, 0, sizeof entry);
      for (int64_t e = 0; e < count; ++e) entry[t.rows[e]][t.columns[e]] = 1;

      /* Slides within the skin, a quarter of a facet: 0.125 here. */
      const double slides[4] = {0.0, 0.05, 0.05, -0.18};
      for (int k = 0; k < 4; ++k) {
        scene_slide(&s, slides[k]);
        scene_tangent(&s, &t);
        for (int64_t e = 0; e < t.n; ++e) CHECK(entry[t.rows[e]][t.columns[e]]);
      }
      scene_destroy(&s);
    }
  }
  return 0;
}
