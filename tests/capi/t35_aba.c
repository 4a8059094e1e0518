/* Residual and tangent are functions of their inputs and the committed history: evaluating at A, B, A gives equal bits,
 * whatever was evaluated in between, together or apart. */
#include "scene.h"

static triplets first, second;

int main(void) {
  static scene s;
  double r[UNKNOWNS], q[UNKNOWNS], saved[X1];
  for (int32_t form = 0; form < 2; ++form) {
    for (int32_t weights = STICKSLIP_WEIGHTS_CURRENT; weights <= STICKSLIP_WEIGHTS_REFERENCE; ++weights) {
      scene_init(&s);
      s.method.form = form;
      s.method.weights = weights;
      scene_create(&s);
      scene_residual(&s, r);
      scene_tangent(&s, &first);
      memcpy(saved, s.x1, sizeof saved);
      /* Within the search's skin, out of it, and out of contact. */
      const double slides[3] = {0.05, 0.9, 50.0};
      for (int k = 0; k < 3; ++k) {
        int64_t count;
        scene_slide(&s, slides[k]);
        scene_residual(&s, q);
        CHECK_OK(stickslip_interface_pattern_coo(s.interface, s.x1, s.x2, 0, NULL, NULL, &count));
        memcpy(s.x1, saved, sizeof saved);
        /* Tangent before residual this time. */
        memset(&second, 0, sizeof second);
        scene_tangent(&s, &second);
        scene_residual(&s, q);
        CHECK(memcmp(r, q, sizeof r) == 0);
        CHECK(memcmp(&first, &second, sizeof first) == 0);
      }
      memset(&first, 0, sizeof first);
      scene_destroy(&s);
    }
  }
  return 0;
}
