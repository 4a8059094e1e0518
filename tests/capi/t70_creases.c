/* A punch with a sharp edge: its surface is split along it, and presses on the floor and the wall of a channel. The
 * split is by what the C call returns; the contact is compared with two interfaces, one a face. */
#include "check.h"

enum { NODES = 6, SPLIT = 8, CHANNEL = 8 };

/* A floor of 1 x 1 in z = 0, looking down, and a wall of 1 x 1 in x = 0, looking left; nodes 0 and 1 on the edge. */
static const double punch[3 * NODES] = {0, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1};
static const int64_t offsets[3] = {0, 4, 8}, facets[8] = {0, 1, 2, 3, 0, 4, 5, 1};
/* Looking up and to the right. */
static const double channel[3 * CHANNEL] = {-1, -1, 0, 2, -1, 0, 2, 2, 0, -1, 2, 0,
                                            0, -1, -1, 0, 2, -1, 0, 2, 2, 0, -1, 2};
static const int64_t channel_facets[8] = {0, 1, 2, 3, 4, 5, 6, 7};

static stickslip_surface surface_of(const double *x, int64_t n, const int64_t *nodes, int64_t n_facets) {
  stickslip_surface s;
  memset(&s, 0, sizeof s);
  s.struct_size = sizeof s;
  s.n_nodes = n;
  s.n_facets = n_facets;
  s.coordinates = x;
  s.facet_offsets = offsets;
  s.facet_nodes = nodes;
  return s;
}

static void numbering(void) {
  const stickslip_surface s = surface_of(punch, NODES, facets, 2);
  int64_t count = -1, nodes[8], originals[SPLIT + 1];
  CHECK_OK(stickslip_surface_split_creases(&s, 0.7, 0, 0, NULL, NULL, &count));
  CHECK(count == SPLIT);
  originals[SPLIT] = -7;
  CHECK_OK(stickslip_surface_split_creases(&s, 0.7, 0, SPLIT, nodes, originals, &count));
  /* The first facet keeps its nodes; the copies follow, in the order of what they copy. */
  const int64_t expected[8] = {0, 1, 2, 3, 6, 4, 5, 7}, copied[SPLIT + 1] = {0, 1, 2, 3, 4, 5, 0, 1, -7};
  CHECK(memcmp(nodes, expected, sizeof nodes) == 0 && memcmp(originals, copied, sizeof originals) == 0);
  /* From 1, in place. */
  int64_t in_place[8];
  for (int k = 0; k < 8; ++k) in_place[k] = facets[k] + 1;
  const stickslip_surface one = surface_of(punch, NODES, in_place, 2);
  CHECK_OK(stickslip_surface_split_creases(&one, 0.7, 1, SPLIT, in_place, originals, &count));
  for (int k = 0; k < 8; ++k) CHECK(in_place[k] == expected[k] + 1 && originals[k] == copied[k] + 1);
  /* An angle beyond the edge's splits nothing. */
  CHECK_OK(stickslip_surface_split_creases(&s, 1.6, 0, SPLIT, nodes, originals, &count));
  CHECK(count == NODES && memcmp(nodes, facets, sizeof nodes) == 0);
}

/* Two lines at a right angle, in place: the second one gets a node of its own. */
static void lines(void) {
  const double corner[9] = {0, 0, 1, 0, 1, -1}; /* room for the three of a surface */
  const int64_t starts[] = {0, 2, 4};
  int64_t of[] = {0, 1, 1, 2}, originals[4], count = 0;
  const stickslip_surface s = {.struct_size = sizeof s, .n_nodes = 3, .n_facets = 2, .coordinates = corner,
                               .facet_offsets = starts, .facet_nodes = of};
  CHECK_OK(stickslip_lines_split_creases(&s, 1.6, 0, 0, NULL, NULL, &count));
  CHECK(count == 3);
  CHECK_OK(stickslip_lines_split_creases(&s, 0.7, 0, 4, of, originals, &count));
  const int64_t expected[] = {0, 1, 3, 2}, copied[] = {0, 1, 2, 1};
  CHECK(count == 4 && memcmp(of, expected, sizeof of) == 0 && memcmp(originals, copied, sizeof copied) == 0);
  /* A surface has three coordinates a node and facets of three nodes at least. */
  CHECK_REFUSED(stickslip_surface_split_creases(&s, 0.7, 0, 4, of, originals, &count), STICKSLIP_INVALID_SIZE, "facet_offsets");
}

static void refusals(void) {
  stickslip_surface s = surface_of(punch, NODES, facets, 2);
  int64_t count, nodes[8], originals[SPLIT];
  FILL(count);
  FILL(nodes);
  FILL(originals);
  const double angles[] = {0.0, -0.7, 3.2, 40.0, NAN, INFINITY};
  for (int k = 0; k < COUNT(angles); ++k) {
    CHECK_REFUSED(stickslip_surface_split_creases(&s, angles[k], 0, SPLIT, nodes, originals, &count),
                  STICKSLIP_INVALID_VALUE, "angle");
  }
  CHECK_REFUSED(stickslip_surface_split_creases(&s, 0.7, 2, SPLIT, nodes, originals, &count), STICKSLIP_INVALID_VALUE,
                "index_base");
  CHECK_REFUSED(stickslip_surface_split_creases(&s, 0.7, 0, SPLIT - 1, nodes, originals, &count),
                STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  CHECK_REFUSED(stickslip_surface_split_creases(NULL, 0.7, 0, SPLIT, nodes, originals, &count), STICKSLIP_NULL_POINTER,
                "surface");
  CHECK_REFUSED(stickslip_surface_split_creases(&s, 0.7, 0, SPLIT, NULL, originals, &count), STICKSLIP_NULL_POINTER,
                "facet_nodes");
  CHECK_REFUSED(stickslip_surface_split_creases(&s, 0.7, 0, SPLIT, nodes, NULL, &count), STICKSLIP_NULL_POINTER,
                "originals");
  CHECK_REFUSED(stickslip_surface_split_creases(&s, 0.7, 0, SPLIT, nodes, originals, NULL), STICKSLIP_NULL_POINTER,
                "count");
  CHECK_REFUSED(stickslip_surface_split_creases(&s, 0.7, 1, SPLIT, nodes, originals, &count),
                STICKSLIP_INDEX_OUT_OF_RANGE, "node");
  /* The second facet the other way round: no surface of a body. */
  const int64_t reversed[8] = {0, 1, 2, 3, 1, 5, 4, 0};
  s.facet_nodes = reversed;
  CHECK_REFUSED(stickslip_surface_split_creases(&s, 0.7, 0, SPLIT, nodes, originals, &count), STICKSLIP_INVALID_VALUE,
                "facets 0 and 1");
  s.facet_nodes = facets;
  s.struct_size = 3;
  CHECK_REFUSED(stickslip_surface_split_creases(&s, 0.7, 0, SPLIT, nodes, originals, &count), STICKSLIP_STRUCT_SIZE,
                "stickslip_surface");
  CHECK_UNTOUCHED(count);
  CHECK_UNTOUCHED(nodes);
  CHECK_UNTOUCHED(originals);
}

/* Pressed by 0.01 on both faces, with a pressure of 1 on each: a quarter of it at every corner. */
static void contact(void) {
  const stickslip_surface whole = surface_of(punch, NODES, facets, 2);
  int64_t count, nodes[8], originals[SPLIT], equations[3 * SPLIT], multipliers[3 * SPLIT], none[3 * CHANNEL];
  double x[3 * SPLIT], x1[3 * SPLIT], lambda[3 * SPLIT], mu[SPLIT], normal[3 * SPLIT];
  CHECK_OK(stickslip_surface_split_creases(&whole, 0.7, 0, SPLIT, nodes, originals, &count));
  for (int a = 0; a < SPLIT; ++a) {
    int copies = 0;
    for (int b = 0; b < SPLIT; ++b) copies += originals[b] == originals[a];
    mu[a] = copies > 1 ? 0.0 : 0.3;
    for (int i = 0; i < 3; ++i) {
      x[3 * a + i] = punch[3 * originals[a] + i];
      x1[3 * a + i] = x[3 * a + i] - (i == 1 ? 0.0 : 0.01);
      equations[3 * a + i] = 3 * originals[a] + i;
      multipliers[3 * a + i] = 3 * NODES + 3 * a + i;
    }
  }
  for (int i = 0; i < 3 * CHANNEL; ++i) none[i] = -1;
  stickslip_surface one = surface_of(x, SPLIT, nodes, 2), two = surface_of(channel, CHANNEL, channel_facets, 2);
  one.equations = equations;
  one.multiplier_equations = multipliers;
  two.equations = none;
  stickslip_options options;
  CHECK_OK(stickslip_options_init(&options, sizeof options));
  CHECK_OK(stickslip_options_paper(&options));
  options.modulus = 100.0;
  options.mu = 0.3;
  stickslip_interface *interface = NULL;
  CHECK_OK(stickslip_interface_create(&one, &two, &options, &interface));
  CHECK_OK(stickslip_interface_set_friction(interface, mu));
  memset(lambda, 0, sizeof lambda);
  stickslip_states states;
  memset(&states, 0, sizeof states);
  states.struct_size = sizeof states;
  states.normal = normal;
  CHECK_OK(stickslip_interface_states(interface, x1, channel, lambda, NULL, &states));
  for (int a = 0; a < SPLIT; ++a) {
    const int down = a < 4; /* the floor's; 4, 5 and the copies are the wall's */
    CHECK_NEAR(normal[3 * a + 2], down ? 1.0 : 0.0, 1e-15);
    CHECK_NEAR(normal[3 * a], down ? 0.0 : 1.0, 1e-15);
    lambda[3 * a + (down ? 2 : 0)] = -1.0;
  }
  double force1[3 * SPLIT], force2[3 * CHANNEL], rows[3 * SPLIT], sum[3 * NODES] = {0};
  CHECK_OK(stickslip_interface_residual(interface, x1, channel, lambda, NULL, force1, force2, rows));
  for (int k = 0; k < 3 * SPLIT; ++k) sum[3 * originals[k / 3] + k % 3] += force1[k];
  for (int a = 0; a < NODES; ++a) {
    const int floor = a < 4, wall = a < 2 || a > 3;
    CHECK_NEAR(sum[3 * a], wall ? -0.25 : 0.0, 1e-15);
    CHECK_NEAR(sum[3 * a + 1], 0.0, 1e-15);
    CHECK_NEAR(sum[3 * a + 2], floor ? -0.25 : 0.0, 1e-15);
  }
  /* Entries of both copies go to the same equations. */
  CHECK_OK(stickslip_interface_tangent_coo(interface, x1, channel, lambda, NULL, 0, NULL, NULL, NULL, &count));
  CHECK(count > 0);
  CHECK_OK(stickslip_interface_destroy(&interface));
}

int main(void) {
  numbering();
  lines();
  refusals();
  contact();
  return 0;
}
