/* The report of covered nodes: covers, fractions, layers, claims, penetration, sentences, and what it finds where
 * nothing overlaps. */
#include "scene.h"

static scene s;
static int32_t cover[N1], layers[N1];
static double fraction[N1];
static int64_t facets[N1];
static char text[1000];

static stickslip_report report_of_all(void) {
  stickslip_report r;
  memset(&r, 0, sizeof r);
  r.struct_size = sizeof r;
  r.cover = cover;
  r.fraction = fraction;
  r.layers = layers;
  r.facets = facets;
  r.text = text;
  r.text_capacity = sizeof text;
  return r;
}

/* Where all is covered; slid until the surfaces meet in part and some nodes hang over. */
static void covered(double slid) {
  scene_init(&s);
  scene_create(&s);
  scene_slide(&s, slid);
  stickslip_report r = report_of_all();
  CHECK_OK(stickslip_interface_report(s.interface, s.x1, s.x2, &r));
  int64_t counts[4] = {0};
  double area[N1], coverage[N1];
  stickslip_states states;
  memset(&states, 0, sizeof states);
  states.struct_size = sizeof states;
  states.area = area;
  states.coverage = coverage;
  CHECK_OK(stickslip_interface_states(s.interface, s.x1, s.x2, s.lambda, NULL, &states));
  for (int a = 0; a < N1; ++a) {
    CHECK(cover[a] >= STICKSLIP_COVER_NONE && cover[a] <= STICKSLIP_COVER_SEVERAL);
    ++counts[cover[a]];
    CHECK_NEAR(fraction[a], coverage[a] / area[a], 1e-15);
    CHECK(cover[a] != STICKSLIP_COVER_FULL || fraction[a] > 0.99);
    CHECK(layers[a] == (cover[a] == STICKSLIP_COVER_NONE ? 0 : 1) && facets[a] >= layers[a]);
  }
  CHECK(r.nodes_none == counts[0] && r.nodes_part == counts[1] && r.nodes_full == counts[2] && r.nodes_several == 0);
  CHECK(slid > 0.0 ? counts[0] > 0 && counts[1] > 0 : counts[2] == N1);
  CHECK(r.finding == STICKSLIP_FINDING_NONE && (slid > 0.0 || r.penetration > 0.0));
  CHECK(strncmp(text, "Of 9 non-mortar nodes ", 22) == 0);
  /* Only what is wanted, and a text that is cut. */
  char cut[8];
  memset(cut, 'x', sizeof cut);
  stickslip_report few;
  memset(&few, 0, sizeof few);
  few.struct_size = sizeof few;
  few.text = cut;
  few.text_capacity = 5;
  CHECK_OK(stickslip_interface_report(s.interface, s.x1, s.x2, &few));
  CHECK(memcmp(cut, "Of 9\0xxx", 8) == 0 && few.cover == NULL && few.nodes_full == counts[2]);
  CHECK(few.struct_size == sizeof few);
  /* The handle's history is as before. */
  static history before, after;
  history_take(s.interface, &before);
  CHECK_OK(stickslip_interface_report(s.interface, s.reference1, s.x2, &r));
  history_take(s.interface, &after);
  CHECK(history_equal(&before, &after));
  scene_destroy(&s);
}

/* The sides' node orders, and how far the mortar side is moved away along the frame's normal. */
static int32_t finding_of(int reverse1, int reverse2, double gap, double aside) {
  scene_init(&s);
  for (int f = 0; f < 4 && reverse1; ++f) {
    const int64_t swap = s.nodes1[4 * f + 1];
    s.nodes1[4 * f + 1] = s.nodes1[4 * f + 3];
    s.nodes1[4 * f + 3] = swap;
  }
  for (int f = 0; f < 9 && reverse2; ++f) {
    const int64_t swap = s.nodes2[4 * f + 1];
    s.nodes2[4 * f + 1] = s.nodes2[4 * f + 3];
    s.nodes2[4 * f + 3] = swap;
  }
  double away[3] = {aside, 0.0, -gap};
  scene_frame(away);
  for (int k = 0; k < X2; ++k) s.reference2[k] += away[k % 3];
  scene_create(&s);
  stickslip_report r = report_of_all();
  CHECK_OK(stickslip_interface_report(s.interface, s.reference1, s.reference2, &r));
  CHECK(r.finding == STICKSLIP_FINDING_NONE || r.finding == STICKSLIP_FINDING_INSIDE_OUT || r.nodes_none == N1);
  scene_destroy(&s);
  return r.finding;
}

static void findings(void) {
  const double gaps[] = {0.01, 2.0, 40.0};
  for (int k = 0; k < COUNT(gaps); ++k) {
    CHECK(finding_of(0, 0, gaps[k], 0.0) == STICKSLIP_FINDING_NONE);
    CHECK(finding_of(1, 0, gaps[k], 0.0) == STICKSLIP_FINDING_SAME_WAY);
    CHECK(strstr(text, "reversed") != NULL);
    CHECK(finding_of(0, 1, gaps[k], 0.0) == STICKSLIP_FINDING_SAME_WAY);
    CHECK(finding_of(0, 0, gaps[k], 9.0) == STICKSLIP_FINDING_NO_OVERLAP);
    /* A shallow one is a pair: an open gap reads as a penetration. */
    CHECK(finding_of(1, 1, gaps[k], 0.0) == (gaps[k] < 0.5 ? STICKSLIP_FINDING_NONE : STICKSLIP_FINDING_BEHIND));
  }
}

/* x1 and x2 swapped, of sides with as many nodes; open gaps of a tenth of a facet seen from inside. */
static void mistakes(void) {
  CHECK(finding_of(1, 1, 0.1, 0.0) == STICKSLIP_FINDING_INSIDE_OUT);
  CHECK(strstr(text, "both sides are reversed") != NULL);
  CHECK(finding_of(0, 0, 0.1, 0.0) == STICKSLIP_FINDING_NONE);

  scene_init(&s);
  scene_grid(2, 0.0, 1.3, 1, 0, s.reference2, s.offsets2, s.nodes2);
  for (int c = 0; c < N1; ++c) scene_frame(s.reference2 + 3 * c);
  s.mortar.n_nodes = N1;
  s.mortar.n_facets = 4;
  scene_create(&s);
  stickslip_report r = report_of_all();
  CHECK_OK(stickslip_interface_report(s.interface, s.reference2, s.reference1, &r));
  CHECK(r.finding == STICKSLIP_FINDING_SWAPPED && strstr(text, "x1 and x2 are swapped") != NULL);
  CHECK_OK(stickslip_interface_report(s.interface, s.reference1, s.reference2, &r));
  CHECK(r.finding == STICKSLIP_FINDING_NONE);
  scene_destroy(&s);
}

static void refusals(void) {
  scene_init(&s);
  scene_create(&s);
  stickslip_report r = report_of_all();
  FILL(cover);
  FILL(fraction);
  CHECK_REFUSED(stickslip_interface_report(NULL, s.x1, s.x2, &r), STICKSLIP_NULL_POINTER, "interface");
  CHECK_REFUSED(stickslip_interface_report(s.interface, NULL, s.x2, &r), STICKSLIP_NULL_POINTER, "x1");
  CHECK_REFUSED(stickslip_interface_report(s.interface, s.x1, NULL, &r), STICKSLIP_NULL_POINTER, "x2");
  CHECK_REFUSED(stickslip_interface_report(s.interface, s.x1, s.x2, NULL), STICKSLIP_NULL_POINTER, "stickslip_report");
  r.text_capacity = 0;
  CHECK_REFUSED(stickslip_interface_report(s.interface, s.x1, s.x2, &r), STICKSLIP_INVALID_SIZE, "text_capacity");
  r = report_of_all();
  r.struct_size = 103;
  CHECK_REFUSED(stickslip_interface_report(s.interface, s.x1, s.x2, &r), STICKSLIP_STRUCT_SIZE, "stickslip_report");
  r = report_of_all();
  s.x1[4] = NAN;
  CHECK_REFUSED(stickslip_interface_report(s.interface, s.x1, s.x2, &r), STICKSLIP_NOT_FINITE, "x1");
  CHECK_UNTOUCHED(cover);
  CHECK_UNTOUCHED(fraction);
  scene_destroy(&s);
}

int main(void) {
  covered(0.0);
  covered(1.2);
  findings();
  mistakes();
  refusals();
  return 0;
}
