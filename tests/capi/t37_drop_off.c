/* A facet slides over the edge of its partner within one step: until it is gone the slip is how far it went, the forces
 * balance, and nothing blows up as the covered area vanishes. */
#include "pair.h"

int main(void) {
  const double table[12] = {-1, -1, 0, 1, -1, 0, 1, 2, 0, -1, 2, 0};
  const int64_t offsets[2] = {0, 4}, nodes[4] = {0, 1, 2, 3};
  int64_t equations[36];
  for (int i = 0; i < 36; ++i) equations[i] = i;
  const stickslip_surface one = {sizeof one, 4, 1, quad1, offsets, nodes, equations, equations + 24, NULL};
  const stickslip_surface two = {sizeof two, 4, 1, table, offsets, nodes, equations + 12, NULL, NULL};
  stickslip_options options;
  stickslip_method method;
  CHECK_OK(stickslip_options_init(&options, sizeof options));
  CHECK_OK(stickslip_options_paper(&options));
  method = *options.method, options.method = &method;
  method.augmentation = 10.0;
  options.mu = 0.1;

  const double moved[] = {0.1, 0.5, 0.9, 0.9999, 1.0 - 1e-6, 1.0 - 1e-9, 1.0 - 1e-15, 1.0, 1.0 + 1e-12, 7.0};
  for (int k = 0; k < COUNT(moved); ++k) {
    stickslip_interface *interface = NULL;
    double x1[12], lambda[12], slip[12], coverage[4], dissipation[4], f1[12], f2[12], rows[12];
    int32_t state[4];
    stickslip_states out;
    CHECK_OK(stickslip_interface_create(&one, &two, &options, &interface));
    memcpy(x1, quad1, sizeof x1);
    memset(lambda, 0, sizeof lambda);
    for (int a = 0; a < 4; ++a) {
      x1[3 * a] += moved[k];
      lambda[3 * a + 2] = -1.0;
    }
    memset(&out, 0, sizeof out);
    out.struct_size = sizeof out;
    out.state = state;
    out.slip = slip;
    out.coverage = coverage;
    out.dissipation = dissipation;
    CHECK_OK(stickslip_interface_states(interface, x1, table, lambda, NULL, &out));
    CHECK_OK(stickslip_interface_residual(interface, x1, table, lambda, NULL, f1, f2, rows));
    double covered = 0.0;
    for (int a = 0; a < 4; ++a) {
      /* A node that is uncovered in the end is open, and an open node does not slip. */
      CHECK_NEAR(slip[3 * a], state[a] == STICKSLIP_STATE_GAP ? 0.0 : moved[k], 1e-14 * moved[k]);
      CHECK(state[a] != STICKSLIP_STATE_GAP || coverage[a] <= 1e-8 * 0.25);
      CHECK_NEAR(slip[3 * a + 1], 0.0, 1e-15);
      CHECK_NEAR(slip[3 * a + 2], 0.0, 1e-15);
      CHECK(dissipation[a] >= 0.0);
      covered += coverage[a];
    }
    CHECK_NEAR(covered, fmax(0.0, 1.0 - moved[k]), 1e-15);
    CHECK_NEAR(f1[2] + f1[5] + f1[8] + f1[11], -covered, 1e-15);
    CHECK_NEAR(f2[2] + f2[5] + f2[8] + f2[11], covered, 1e-15);

    /* What was reported is what a commit keeps. */
    double kept[12];
    CHECK_OK(stickslip_interface_commit(interface, x1, table, lambda, NULL));
    out.slip = kept;
    CHECK_OK(stickslip_interface_states(interface, x1, table, lambda, NULL, &out));
    for (int i = 0; i < 12; ++i) CHECK_NEAR(kept[i], slip[i], 1e-15 * (1.0 + fabs(slip[i])));
    CHECK_OK(stickslip_interface_destroy(&interface));
  }
  return 0;
}
