/* The diagnosis: worst pairs, states and their changes, suspects with their causes, sentences; refusals. */
#include "scene.h"

enum { ROOM = 40 };

static scene s;
static int32_t state[N1], causes[ROOM];
static int64_t nodes[ROOM];
static double directions[3 * ROOM], ratios[ROOM];
static char text[1000];

static stickslip_diagnosis diagnosis_of_all(void) {
  stickslip_diagnosis d;
  memset(&d, 0, sizeof d);
  d.struct_size = sizeof d;
  d.state = state;
  d.suspect_nodes = nodes;
  d.suspect_directions = directions;
  d.suspect_ratios = ratios;
  d.suspect_causes = causes;
  d.suspect_capacity = ROOM;
  d.text = text;
  d.text_capacity = sizeof text;
  return d;
}

static int32_t diagnose(stickslip_diagnosis *d) {
  return stickslip_interface_diagnose(s.interface, s.x1, s.x2, s.lambda, NULL, d);
}

/* A scene with all states and nothing amiss. */
static void sound(int64_t base) {
  scene_init_base(&s, base);
  scene_create(&s);
  for (int a = 0; a < N1; ++a) state[a] = -1;
  stickslip_diagnosis d = diagnosis_of_all();
  CHECK_OK(diagnose(&d));
  CHECK(d.state_changes == N1 && d.suspects == 0 && d.nodes_gap + d.nodes_stick + d.nodes_slip == N1);
  int32_t expected[N1];
  stickslip_states states;
  memset(&states, 0, sizeof states);
  states.struct_size = sizeof states;
  states.state = expected;
  CHECK_OK(stickslip_interface_states(s.interface, s.x1, s.x2, s.lambda, NULL, &states));
  CHECK(memcmp(state, expected, sizeof state) == 0);
  CHECK(d.covered_node >= base && d.covered_node < base + N1 && d.covered_fraction > 0.1);
  CHECK(d.overlap > 0.0 && d.overlap <= 1.0 && d.error >= 0.0 && d.error < 1e-12);
  CHECK(d.overlap_facets[0] >= base && d.overlap_facets[0] < base + 4);
  CHECK(d.overlap_facets[1] >= base && d.overlap_facets[1] < base + 9);
  /* The sides are tilted against each other by 0.03, and flat. */
  CHECK_NEAR(d.angle, 0.03, 1e-14);
  CHECK(d.warp < 1e-14);
  CHECK(strstr(text, "in gap") != NULL && strstr(text, "singular") == NULL);
  /* Once more: nothing has changed since. Then one node has. */
  CHECK_OK(diagnose(&d));
  CHECK(d.state_changes == 0);
  state[3] = state[3] == STICKSLIP_STATE_GAP ? STICKSLIP_STATE_SLIP : STICKSLIP_STATE_GAP;
  CHECK_OK(diagnose(&d));
  CHECK(d.state_changes == 1 && state[3] == expected[3]);
  /* Nothing but numbers, for a caller who wants no arrays. */
  stickslip_diagnosis few;
  memset(&few, 0, sizeof few);
  few.struct_size = sizeof few;
  CHECK_OK(diagnose(&few));
  CHECK(few.state_changes == 0 && few.overlap == d.overlap && few.nodes_stick == d.nodes_stick);
  scene_destroy(&s);
}

/* Both sides held along x, the multipliers there left in: closed nodes cannot stick. (Frozen weights: those of now turn
 * with the facets, whose normals have a part along x.) */
static void prescribed(void) {
  scene_init(&s);
  for (int a = 0; a < N1; ++a) s.equations1[3 * a] = -1;
  for (int c = 0; c < N2; ++c) s.equations2[3 * c] = -1;
  s.options.mu = 1e6;
  s.method.weights = STICKSLIP_WEIGHTS_REFERENCE;
  scene_create(&s);
  for (int a = 0; a < N1; ++a) state[a] = -1;
  stickslip_diagnosis d = diagnosis_of_all();
  CHECK_OK(diagnose(&d));
  CHECK(d.nodes_stick > 0 && d.suspects == d.nodes_stick);
  for (int k = 0; k < (int)d.suspects; ++k) {
    CHECK(state[nodes[k]] == STICKSLIP_STATE_STICK && causes[k] == STICKSLIP_CAUSE_PRESCRIBED && ratios[k] < 1e-7);
    CHECK_NEAR(directions[3 * k], 1.0, 1e-12);
  }
  CHECK(strstr(text, "no displacement there has an equation") != NULL);
  /* Less room than suspects: the first ones, and how many there are. */
  FILL(nodes);
  d.suspect_capacity = 1;
  CHECK_OK(diagnose(&d));
  CHECK(d.suspects == d.nodes_stick && nodes[0] >= 0);
  check_untouched(nodes + 1, sizeof nodes - sizeof nodes[0], __FILE__, __LINE__, "nodes");
  scene_destroy(&s);
}

static int32_t diagnose_at(stickslip_interface *i, const double *x1, const double *x2, const double *lambda,
                           const double *sums, stickslip_diagnosis *d) {
  return stickslip_interface_diagnose(i, x1, x2, lambda, sums, d);
}

static void refusals(void) {
  scene_init(&s);
  scene_create(&s);
  for (int a = 0; a < N1; ++a) state[a] = -1;
  stickslip_diagnosis d = diagnosis_of_all();
  FILL(ratios);
  CHECK_REFUSED(diagnose_at(NULL, s.x1, s.x2, s.lambda, NULL, &d), STICKSLIP_NULL_POINTER, "interface");
  CHECK_REFUSED(diagnose_at(s.interface, NULL, s.x2, s.lambda, NULL, &d), STICKSLIP_NULL_POINTER, "x1");
  CHECK_REFUSED(diagnose_at(s.interface, s.x1, NULL, s.lambda, NULL, &d), STICKSLIP_NULL_POINTER, "x2");
  CHECK_REFUSED(diagnose_at(s.interface, s.x1, s.x2, NULL, NULL, &d), STICKSLIP_NULL_POINTER, "lambda");
  CHECK_REFUSED(diagnose(NULL), STICKSLIP_NULL_POINTER, "stickslip_diagnosis");
  d.text_capacity = 0;
  CHECK_REFUSED(diagnose(&d), STICKSLIP_INVALID_SIZE, "text_capacity");
  d = diagnosis_of_all();
  d.suspect_capacity = -1;
  CHECK_REFUSED(diagnose(&d), STICKSLIP_INVALID_SIZE, "suspect_capacity");
  d = diagnosis_of_all();
  d.struct_size = sizeof d - 8;
  CHECK_REFUSED(diagnose(&d), STICKSLIP_STRUCT_SIZE, "stickslip_diagnosis");
  d = diagnosis_of_all();
  state[2] = 3;
  CHECK_REFUSED(diagnose(&d), STICKSLIP_INVALID_VALUE, "state[2]");
  state[2] = -1;
  s.lambda[4] = NAN;
  CHECK_REFUSED(diagnose(&d), STICKSLIP_NOT_FINITE, "lambda");
  CHECK_UNTOUCHED(ratios);
  scene_destroy(&s);
}

int main(void) {
  sound(0);
  sound(1);
  prescribed();
  refusals();
  return 0;
}
