/* A border of the mortar surface that follows the edge between two non-mortar facets, in planes of their own: by itself
 * each facet may claim it, or neither. With the normals of its neighbours a pair agrees with the other one, and with the
 * handle to the last bit. */
#include "scene.h"

enum { FRAMES = 200, ONE = 6, TWO = 4 };

/* Two quads with the line x = 1 in common; a mortar quad that ends on it, but for rounding. */
static const double nonmortar[3 * ONE] = {0, 0, 0.3, 1, 0, 0, 2, 0, 0.2, 0, 1, 0.3, 1, 1, 0, 2, 1, 0.2};
static const double mortar[3 * TWO] = {-0.5, -0.4, 0.1, 1, -0.4, 0, 1, 1.7, 0, -0.5, 1.7, 0.1};
static const int64_t nodes1[8] = {0, 3, 4, 1, 1, 4, 5, 2}, nodes2[4] = {0, 1, 2, 3};

/* Of the length of the border over the facets, 1: rates at which their planes see it sweep, the cosines of their slopes. */
#define RATE_0 (1.0 / sqrt(1.0 + 0.3 * 0.3))
#define RATE_1 (1.0 / sqrt(1.0 + 0.2 * 0.2))
/* Twenty times the rounding of coordinates of size 2 over edges of size 1. */
#define ROUNDING 1e-13

static double x1[3 * ONE], x2[3 * TWO], along[3];

static void place(uint64_t *random) {
  double axis[3] = {random_number(random), random_number(random), random_number(random)};
  const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  const double angle = 3.0 * random_number(random);
  for (int i = 0; i < 3; ++i) axis[i] /= length;
  memcpy(x1, nonmortar, sizeof x1);
  memcpy(x2, mortar, sizeof x2);
  const double x[3] = {1, 0, 0};
  memcpy(along, x, sizeof x);
  for (int k = 0; k < ONE; ++k) scene_turn(x1 + 3 * k, axis, angle);
  for (int k = 0; k < TWO; ++k) scene_turn(x2 + 3 * k, axis, angle);
  scene_turn(along, axis, angle);
}

/* The covered area's rate while the mortar facet slides across the line; the weights of both pairs. */
static double rate(int informed, double ab[2][16], double ac[2][16]) {
  double facets[2][12], normals[2][12] = {{0}}, sum = 0.0;
  for (int f = 0; f < 2; ++f) {
    for (int k = 0; k < 4; ++k) memcpy(facets[f] + 3 * k, x1 + 3 * nodes1[4 * f + k], 3 * sizeof(double));
  }
  /* The line is the third edge of facet 0, from its node 2 to 3, and the first of facet 1. */
  CHECK_OK(stickslip_facet_normal(4, facets[1], normals[0] + 6));
  CHECK_OK(stickslip_facet_normal(4, facets[0], normals[1]));
  for (int f = 0; f < 2; ++f) {
    double dab[16 * 24], dac[16 * 24];
    stickslip_pair pair;
    memset(&pair, 0, sizeof pair);
    pair.struct_size = sizeof pair;
    pair.n1 = pair.n2 = 4;
    pair.x1 = facets[f];
    pair.x2 = x2;
    pair.neighbour_normals = informed ? normals[f] : NULL;
    CHECK_OK(stickslip_pair_weights(&pair, ab[f], ac[f], dab, dac));
    for (int row = 0; row < 16; ++row) {
      for (int k = 4; k < 8; ++k) {
        for (int i = 0; i < 3; ++i) sum += dab[24 * row + 3 * k + i] * along[i];
      }
    }
  }
  return sum;
}

static int is_one_of_both(double rate) {
  return fabs(rate - RATE_0) < ROUNDING || fabs(rate - RATE_1) < ROUNDING;
}

/* The handle's weights, from its history: they come last. */
static void check_handle(double ab[2][16], double ac[2][16]) {
  static history h;
  int64_t equations1[3 * ONE], equations2[3 * TWO], multipliers[3 * ONE];
  const int64_t offsets[3] = {0, 4, 8};
  for (int k = 0; k < 3 * ONE; ++k) equations1[k] = k, multipliers[k] = 100 + k;
  for (int k = 0; k < 3 * TWO; ++k) equations2[k] = 50 + k;
  stickslip_surface one, two;
  stickslip_options options;
  stickslip_method method;
  stickslip_interface *interface = NULL;
  memset(&one, 0, sizeof one);
  one.struct_size = sizeof one;
  two = one;
  one.n_nodes = ONE, one.n_facets = 2, one.coordinates = x1, one.facet_offsets = offsets, one.facet_nodes = nodes1;
  one.equations = equations1, one.multiplier_equations = multipliers;
  two.n_nodes = TWO, two.n_facets = 1, two.coordinates = x2, two.facet_offsets = offsets, two.facet_nodes = nodes2;
  two.equations = equations2;
  CHECK_OK(stickslip_options_init(&options, sizeof options));
  CHECK_OK(stickslip_options_paper(&options));
  method = *options.method, options.method = &method;
  options.modulus = 1.0;
  options.mu = 0.3;
  method.no_shortcuts = STICKSLIP_SHORTCUT_APART;
  CHECK_OK(stickslip_interface_create(&one, &two, &options, &interface));
  history_take(interface, &h);
  const int64_t pairs = h.integers[HISTORY_PAIRS];
  CHECK(pairs == 1 || pairs == 2);
  for (int64_t p = 0; p < pairs; ++p) {
    const int64_t f = h.integers[HISTORY_FACETS + 2 * p];
    const double *weights = h.reals + h.n_reals - 32 * (pairs - p);
    CHECK(memcmp(weights, ab[f], sizeof ab[f]) == 0 && memcmp(weights + 16, ac[f], sizeof ac[f]) == 0);
  }
  CHECK_OK(stickslip_interface_destroy(&interface));
}

static void bad_input(void) {
  double out[3], ab[16], ac[16], normals[12] = {0};
  stickslip_pair pair;
  memset(&pair, 0, sizeof pair);
  pair.struct_size = sizeof pair;
  pair.n1 = pair.n2 = 4;
  pair.x1 = pair.x2 = x2;
  pair.neighbour_normals = normals;
  FILL(out);
  FILL(ab);
  normals[4] = 2.0;
  CHECK_REFUSED(stickslip_pair_weights(&pair, ab, ac, NULL, NULL), STICKSLIP_INVALID_VALUE, "neighbour_normals of edge 1");
  normals[4] = NAN;
  CHECK_REFUSED(stickslip_pair_weights(&pair, ab, ac, NULL, NULL), STICKSLIP_NOT_FINITE, "pair.neighbour_normals");
  CHECK_REFUSED(stickslip_facet_normal(5, x2, out), STICKSLIP_INVALID_SIZE, "x");
  CHECK_REFUSED(stickslip_facet_normal(4, NULL, out), STICKSLIP_NULL_POINTER, "x");
  CHECK_REFUSED(stickslip_facet_normal(4, x2, NULL), STICKSLIP_NULL_POINTER, "normal");
  const double line[9] = {0, 0, 0, 1, 0, 0, 2, 0, 0};
  CHECK_REFUSED(stickslip_facet_normal(3, line, out), STICKSLIP_DEGENERATE_FACET, "x");
  CHECK_UNTOUCHED(out);
  CHECK_UNTOUCHED(ab);
}

int main(void) {
  uint64_t random = 16;
  int disagree = 0;
  double ab[2][16], ac[2][16];
  for (int k = 0; k < FRAMES; ++k) {
    place(&random);
    disagree += !is_one_of_both(rate(0, ab, ac));
    CHECK(is_one_of_both(rate(1, ab, ac)));
    check_handle(ab, ac);
  }
  /* Or nothing was tried. */
  CHECK(disagree > FRAMES / 10);
  bad_input();
  return 0;
}
