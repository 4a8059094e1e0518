/* How much of a step may be taken before the surfaces pass through each other: gaps of all sizes, either multiplier, all
 * weights, a rigid and an analytic mortar side, parts of the mortar surface on several handles. */
#include "scene.h"

/* The shortest edge of the non-mortar facets, and the default of how much of it a node may go deeper. */
static const double EDGE = 0.5, DEPTH = 0.1;
/* An advance may end a quarter of the depth before the limit. */
static const double SHARPNESS = 0.25;
/* How far beyond it a fraction may end, over the depth: rounding. */
static const double BEYOND = 1e-5;

static scene s;
static double dx1[X1], dx2[X2];

/* Where the scene's frame has v. */
static void fill(double *x, int n, double v0, double v1, double v2) {
  double v[3] = {v0, v1, v2};
  scene_frame(v);
  for (int k = 0; k < n; ++k) x[k] = v[k % 3];
}

/* Both surfaces flat, with a gap between them, committed so. */
static void apart_by(double gap) {
  double up[X1];
  fill(up, X1, 0.0, 0.0, gap);
  for (int k = 0; k < X1; ++k) s.x1[k] = s.reference1[k] + up[k];
  memcpy(s.x2, s.reference2, sizeof s.x2);
}

static double limit(double penetration) {
  double fraction = -1.0;
  CHECK_OK(stickslip_interface_step_limit(s.interface, s.x1, s.x2, dx1, dx2, penetration, &fraction));
  CHECK(fraction > 0.0 && fraction <= 1.0);
  return fraction;
}

/* A gap closes by a motion of this length: it ends in a slight penetration. */
static void closes(double gap, double motion, double penetration) {
  const double depth = (penetration > 0.0 ? penetration : DEPTH) * EDGE;
  apart_by(gap);
  fill(dx1, X1, 0.0, 0.0, -motion);
  fill(dx2, X2, 0.0, 0.0, 0.0);
  const double moved = motion * limit(penetration), most = gap + depth;
  if (motion <= most) {
    CHECK_NEAR(moved, motion, BEYOND * depth);
  } else {
    CHECK(moved <= most + BEYOND * depth && moved >= most - SHARPNESS * depth);
  }
  /* The same where the other side moves, and where each moves a half. */
  fill(dx1, X1, 0.0, 0.0, 0.0);
  fill(dx2, X2, 0.0, 0.0, motion);
  CHECK_NEAR(motion * limit(penetration), moved, SHARPNESS * depth);
  fill(dx1, X1, 0.0, 0.0, -0.5 * motion);
  fill(dx2, X2, 0.0, 0.0, 0.5 * motion);
  CHECK_NEAR(motion * limit(penetration), moved, SHARPNESS * depth);
  /* The surfaces part; both go the same way. */
  fill(dx1, X1, 0.0, 0.0, motion);
  fill(dx2, X2, 0.0, 0.0, 0.0);
  CHECK(limit(penetration) == 1.0);
  fill(dx1, X1, motion, 2.0 * motion, -motion);
  fill(dx2, X2, motion, 2.0 * motion, -motion);
  CHECK(limit(penetration) == 1.0);
}

static void closing(void) {
  const double gaps[] = {0.0, 1e-3, 0.05, 0.5, 5.0, 500.0}, motions[] = {1e-4, 0.3, 1.0, 1e3, 1e9};
  for (int i = 0; i < COUNT(gaps); ++i) {
    for (int k = 0; k < COUNT(motions); ++k) {
      closes(gaps[i], motions[k], 0.0);
      closes(gaps[i], motions[k], 0.03);
      closes(gaps[i], motions[k], 1.0);
    }
  }
}

/* Only what is closed already: a node that is deep may go on by the depth, one that slides may slide. */
static void closed(void) {
  apart_by(-0.2);
  fill(dx1, X1, 0.0, 0.0, -1.0);
  fill(dx2, X2, 0.0, 0.0, 0.0);
  const double moved = limit(0.0);
  CHECK(moved <= DEPTH * EDGE * (1.0 + BEYOND) && moved >= (1.0 - SHARPNESS) * DEPTH * EDGE);
  fill(dx1, X1, 0.3, 0.2, 0.0);
  CHECK(limit(0.0) == 1.0);
}

static void sides(void) {
  scene_init(&s);
  scene_create(&s);
  closing();
  closed();
  scene_destroy(&s);
  /* Surfaces that nothing covers after the motion, however long it is. */
  scene_init(&s);
  scene_create(&s);
  apart_by(0.1);
  fill(dx1, X1, 1e6, 0.0, 0.0);
  fill(dx2, X2, 0.0, 0.0, 0.0);
  limit(0.0);
  scene_destroy(&s);
  /* Without friction; a rigid mortar side; frozen weights, of which the gap is linear. */
  scene_init(&s);
  s.options.friction = STICKSLIP_FRICTION_NONE;
  s.options.mu = 0.0;
  scene_create(&s);
  closing();
  scene_destroy(&s);
  scene_init(&s);
  for (int k = 0; k < X2; ++k) s.equations2[k] = -1;
  s.options.mortar_side = STICKSLIP_MORTAR_RIGID;
  scene_create(&s);
  closing();
  scene_destroy(&s);
  const int32_t frozen[] = {STICKSLIP_WEIGHTS_COMMITTED, STICKSLIP_WEIGHTS_REFERENCE};
  for (int k = 0; k < COUNT(frozen); ++k) {
    scene_init(&s);
    s.method.weights = frozen[k];
    scene_create(&s);
    closing();
    scene_destroy(&s);
  }
  /* Tied: as it likes. */
  scene_init(&s);
  s.options.friction = STICKSLIP_FRICTION_TIED;
  s.options.mu = 0.0;
  scene_create(&s);
  apart_by(0.1);
  fill(dx1, X1, 0.0, 0.0, -9.0);
  CHECK(limit(0.0) == 1.0);
  scene_destroy(&s);
}

/* A plane in closed form, under the non-mortar side. */
static void analytic(void) {
  double frame[12] = {0.5, 0.5, 0.0, 0.5, 0.5, 1.0, 1.5, 0.5, 0.0, 0.5, 1.5, 0.0}, d[12], x[12], fraction = -1.0;
  for (int k = 0; k < 4; ++k) scene_frame(frame + 3 * k);
  scene_init(&s);
  s.mortar.n_nodes = 4;
  s.mortar.n_facets = 0;
  s.mortar.coordinates = frame;
  s.mortar.facet_offsets = NULL;
  s.mortar.facet_nodes = NULL;
  s.mortar.equations = NULL;
  s.options.mortar_side = STICKSLIP_MORTAR_ANALYTIC;
  scene_create(&s);
  apart_by(0.7);
  fill(dx1, X1, 0.0, 0.0, -100.0);
  fill(d, 12, 0.0, 0.0, 50.0);
  CHECK_OK(stickslip_interface_step_limit(s.interface, s.x1, frame, dx1, d, 0.0, &fraction));
  const double most = 0.7 + DEPTH * EDGE;
  CHECK(150.0 * fraction <= most + BEYOND && 150.0 * fraction >= most - SHARPNESS * DEPTH * EDGE);
  /* A frame that turns is no rigid body on the way. */
  const double axis[3] = {0.0, 0.0, 1.0};
  memcpy(x, frame, sizeof x);
  for (int k = 0; k < 4; ++k) scene_turn(x + 3 * k, axis, 0.5);
  for (int k = 0; k < 12; ++k) d[k] = x[k] - frame[k];
  CHECK_REFUSED(stickslip_interface_step_limit(s.interface, s.x1, frame, dx1, d, 0.0, &fraction),
                STICKSLIP_INVALID_VALUE, "mortar");
  scene_destroy(&s);
}

/* The least that the handles of a mortar surface in parts allow is allowed for the whole. */
static void parts(void) {
  double least = 1.0, fraction;
  scene_init(&s);
  scene_create(&s);
  apart_by(0.3);
  /* Tilted, so that the parts are not alike. */
  for (int a = 0; a < N1; ++a) {
    double p[3] = {0.0, 0.0, -2.0 - (a % 3) - 0.5 * (a / 3)};
    scene_frame(p);
    for (int i = 0; i < 3; ++i) dx1[3 * a + i] = p[i];
  }
  fill(dx2, X2, 0.0, 0.0, 0.0);
  const double whole = limit(0.0);
  scene_destroy(&s);
  for (int row = 0; row < 3; ++row) {
    scene_init(&s);
    apart_by(0.3);
    /* Three facets; their nodes are the two rows of four from 4 row on. */
    s.mortar.n_nodes = 8;
    s.mortar.n_facets = 3;
    s.mortar.coordinates = s.reference2 + 12 * row;
    scene_create(&s);
    CHECK_OK(stickslip_interface_step_limit(s.interface, s.x1, s.reference2 + 12 * row, dx1, dx2, 0.0, &fraction));
    least = fraction < least ? fraction : least;
    scene_destroy(&s);
  }
  CHECK(least <= whole * (1.0 + SHARPNESS));
  scene_init(&s);
  scene_create(&s);
  apart_by(0.3);
  /* From there the whole may go on by no more than is left. */
  for (int k = 0; k < X1; ++k) dx1[k] *= least;
  CHECK(limit(0.0) == 1.0);
  scene_destroy(&s);
}

/* Asked in between, everything that follows has the same bits. */
static void nothing_changes(void) {
  static history before, after;
  double expected[UNKNOWNS], r[UNKNOWNS];
  scene_init(&s);
  scene_create(&s);
  scene_commit(&s);
  scene_residual(&s, expected);
  history_take(s.interface, &before);
  fill(dx1, X1, 0.1, 0.2, -3.0);
  fill(dx2, X2, 0.0, 0.1, 1.0);
  const double first = limit(0.0);
  scene_residual(&s, r);
  CHECK(memcmp(r, expected, sizeof r) == 0);
  CHECK(limit(0.0) == first);
  history_take(s.interface, &after);
  CHECK(history_equal(&before, &after));
  scene_slide(&s, 0.01);
  scene_residual(&s, expected);
  scene_destroy(&s);
  /* A handle that was never asked. */
  scene_init(&s);
  scene_create(&s);
  scene_commit(&s);
  scene_slide(&s, 0.01);
  scene_residual(&s, r);
  CHECK(memcmp(r, expected, sizeof r) == 0);
  scene_destroy(&s);
}

static void refusals(void) {
  double fraction;
  scene_init(&s);
  scene_create(&s);
  fill(dx1, X1, 0.0, 0.0, -1.0);
  fill(dx2, X2, 0.0, 0.0, 0.0);
  FILL(fraction);
#define LIMIT(handle, x1, x2, dx1, dx2, c, out) stickslip_interface_step_limit(handle, x1, x2, dx1, dx2, c, out)
  CHECK_REFUSED(LIMIT(NULL, s.x1, s.x2, dx1, dx2, 0.0, &fraction), STICKSLIP_NULL_POINTER, "interface");
  CHECK_REFUSED(LIMIT(s.interface, NULL, s.x2, dx1, dx2, 0.0, &fraction), STICKSLIP_NULL_POINTER, "x1");
  CHECK_REFUSED(LIMIT(s.interface, s.x1, NULL, dx1, dx2, 0.0, &fraction), STICKSLIP_NULL_POINTER, "x2");
  CHECK_REFUSED(LIMIT(s.interface, s.x1, s.x2, NULL, dx2, 0.0, &fraction), STICKSLIP_NULL_POINTER, "dx1");
  CHECK_REFUSED(LIMIT(s.interface, s.x1, s.x2, dx1, NULL, 0.0, &fraction), STICKSLIP_NULL_POINTER, "dx2");
  CHECK_REFUSED(LIMIT(s.interface, s.x1, s.x2, dx1, dx2, 0.0, NULL), STICKSLIP_NULL_POINTER, "fraction");
  const double wrong[] = {-0.1, 1.1, NAN, INFINITY};
  for (int k = 0; k < COUNT(wrong); ++k) {
    CHECK_REFUSED(LIMIT(s.interface, s.x1, s.x2, dx1, dx2, wrong[k], &fraction), STICKSLIP_INVALID_VALUE, "penetration");
  }
  dx1[5] = NAN;
  CHECK_REFUSED(LIMIT(s.interface, s.x1, s.x2, dx1, dx2, 0.0, &fraction), STICKSLIP_NOT_FINITE, "dx1");
  dx1[5] = 0.0;
  dx2[7] = INFINITY;
  CHECK_REFUSED(LIMIT(s.interface, s.x1, s.x2, dx1, dx2, 0.0, &fraction), STICKSLIP_NOT_FINITE, "dx2");
  dx2[7] = 0.0;
  for (int k = 0; k < X1; ++k) dx1[k] = s.x1[k] = 1e308;
  CHECK_REFUSED(LIMIT(s.interface, s.x1, s.x2, dx1, dx2, 0.0, &fraction), STICKSLIP_NOT_FINITE, "x1 + dx1");
  CHECK_UNTOUCHED(fraction);
  scene_destroy(&s);
}

int main(void) {
  sides();
  analytic();
  parts();
  nothing_changes();
  refusals();
  return 0;
}
