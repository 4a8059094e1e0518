/* Offsets of the nodes: a clearance and an interference, gaps closed at the start, the shape of a faceted surface. */
#include "scene.h"

/* Two ways to the same number. */
static const double SAME_NUMBER = 1e-12;

static double normal_gap(scene *s, int a) {
  static double sums[STICKSLIP_SUMS_PER_NODE * N1], normal[X1];
  stickslip_states out = {.struct_size = sizeof out, .normal = normal};
  CHECK_OK(stickslip_interface_states(s->interface, s->reference1, s->reference2, s->lambda, NULL, &out));
  CHECK_OK(stickslip_interface_sums(s->interface, s->reference1, s->reference2, sums));
  double gap = 0.0;
  for (int i = 0; i < 3; ++i) gap += normal[3 * a + i] * sums[STICKSLIP_SUMS_PER_NODE * a + 1 + i];
  return gap / sums[STICKSLIP_SUMS_PER_NODE * a];
}

int main(void) {
  static scene s;
  scene_init(&s);
  double one[N1], two[N2], x[X1], gaps[N1], offsets[N1];
  int32_t moved[N1];

  /* A uniform offset is a gap of as much, whichever side it belongs to; none is none. */
  scene_create(&s);
  for (int a = 0; a < N1; ++a) one[a] = 0.02;
  for (int c = 0; c < N2; ++c) two[c] = -0.05;
  CHECK_OK(stickslip_interface_set_offsets(s.interface, one, NULL));
  for (int a = 0; a < N1; ++a) CHECK(fabs(normal_gap(&s, a) - 0.02) < SAME_NUMBER);
  CHECK_OK(stickslip_interface_set_offsets(s.interface, one, two));
  for (int a = 0; a < N1; ++a) CHECK(fabs(normal_gap(&s, a) + 0.03) < SAME_NUMBER);
  CHECK_OK(stickslip_interface_set_offsets(s.interface, NULL, NULL));
  for (int a = 0; a < N1; ++a) CHECK(fabs(normal_gap(&s, a)) < SAME_NUMBER);

  /* Nodes a little off the mortar surface are put onto it; one that is too far stays; a tolerance beyond a facet is refused. */
  double up[3] = {0.0, 0.0, 1.0};
  scene_frame(up);
  scene_destroy(&s);
  for (int a = 0; a < N1; ++a) {
    for (int i = 0; i < 3; ++i) s.reference1[3 * a + i] += (a == 4 ? 0.2 : 0.01) * up[i];
  }
  scene_create(&s);
  CHECK_OK(stickslip_interface_adjust(s.interface, 0.05, x, gaps, moved));
  for (int a = 0; a < N1; ++a) {
    CHECK(moved[a] == (a == 4 ? STICKSLIP_ADJUST_LEFT : STICKSLIP_ADJUST_MOVED));
    double height = 0.0;
    for (int i = 0; i < 3; ++i) height += (x[3 * a + i]) * up[i];
    if (a != 4) CHECK(fabs(height) < SAME_NUMBER);
    CHECK(gaps[a] > 0.005);
  }
  CHECK_OK(stickslip_interface_adjust(s.interface, 0.05, NULL, NULL, NULL));
  scene_destroy(&s);
  for (int a = 0; a < N1; ++a) {
    for (int i = 0; i < 3; ++i) s.reference1[3 * a + i] += 0.8 * up[i];
  }
  scene_create(&s);
  CHECK_REFUSED(stickslip_interface_adjust(s.interface, 1.5, x, gaps, moved), STICKSLIP_INVALID_VALUE, "shortest edge");
  CHECK_REFUSED(stickslip_interface_adjust(s.interface, 0.0, x, gaps, moved), STICKSLIP_INVALID_VALUE, "tolerance");

  /* Facets that lie on no sphere; on a huge one the offsets are their sagitta's mean. */
  scene_destroy(&s);
  scene_init(&s);
  scene_create(&s);
  double centre[3] = {0.0, 0.0, 1.0}, axis[3] = {0.0, 0.0, 1.0};
  scene_frame(centre);
  for (int i = 0; i < 3; ++i) centre[i] *= 1e3;
  CHECK_OK(stickslip_interface_shape_offsets(s.interface, STICKSLIP_SIDE_NONMORTAR, STICKSLIP_SHAPE_SPHERE, 1e3, centre, axis,
                                             offsets));
  for (int a = 0; a < N1; ++a) CHECK(offsets[a] > 0.0 && offsets[a] < 2e-3); /* of the plane from the sphere that it touches */
  CHECK_REFUSED(stickslip_interface_shape_offsets(s.interface, STICKSLIP_SIDE_NONMORTAR, STICKSLIP_SHAPE_SPHERE, 1.0, centre, axis,
                                                  offsets), STICKSLIP_INVALID_VALUE, "longest edge");
  CHECK_REFUSED(stickslip_interface_shape_offsets(s.interface, STICKSLIP_SIDE_NONMORTAR, STICKSLIP_SHAPE_SPHERE, -1e3, centre, axis,
                                                  offsets), STICKSLIP_INVALID_VALUE, "looks into the body of the shape");
  CHECK_REFUSED(stickslip_interface_shape_offsets(s.interface, 2, STICKSLIP_SHAPE_SPHERE, 1e3, centre, axis, offsets),
                STICKSLIP_INVALID_VALUE, "side");
  CHECK_REFUSED(stickslip_interface_set_offsets(NULL, one, NULL), STICKSLIP_NULL_POINTER, "interface");
  scene_destroy(&s);
  return 0;
}
