/* Stages 1 to 4 put together by a host: one non-mortar quad that slides over two mortar quads. Residual and tangent
 * assembled pair by pair and node by node equal those of an interface handle, and central differences of its residual.
 * In the last case the first pair overlapped at t_n only. */
#include "pair.h"

enum { ONE = 12, TWO = 18, ALL = 2 * ONE + TWO, PAIR = 36 };

static const double at_t_n[ONE] = {0.1, 0.2, 0.0, 0.1, 0.8, 0.0, 0.9, 0.8, 0.0, 0.9, 0.2, 0.0};
static const double ground[TWO] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0,
                                   0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 2.0, 1.0, 0.0};
static const int64_t mortar_nodes[8] = {0, 1, 4, 3, 1, 2, 5, 4};

typedef struct {
  stickslip_interface *interface;
  double x[ALL]; /* x1, x2, lambda */
} scene;

static void create(scene *s, double slide, double friction) {
  const int64_t offsets[3] = {0, 4, 8}, nodes[4] = {0, 1, 2, 3};
  int64_t equations[ALL];
  for (int k = 0; k < ALL; ++k) equations[k] = k;
  stickslip_surface one, two;
  stickslip_options options;
  stickslip_method method;
  memset(&one, 0, sizeof one);
  one.struct_size = sizeof one;
  one.n_nodes = 4;
  one.n_facets = 1;
  one.coordinates = at_t_n;
  one.facet_offsets = offsets;
  one.facet_nodes = nodes;
  one.equations = equations;
  one.multiplier_equations = equations + ONE + TWO;
  memset(&two, 0, sizeof two);
  two.struct_size = sizeof two;
  two.n_nodes = 6;
  two.n_facets = 2;
  two.coordinates = ground;
  two.facet_offsets = offsets;
  two.facet_nodes = mortar_nodes;
  two.equations = equations + ONE;
  CHECK_OK(stickslip_options_init(&options, sizeof options));
  CHECK_OK(stickslip_options_paper(&options));
  method = *options.method, options.method = &method;
  options.mu = friction;
  method.augmentation = 20.0;
  CHECK_OK(stickslip_interface_create(&one, &two, &options, &s->interface));

  memcpy(s->x, at_t_n, sizeof at_t_n);
  memcpy(s->x + ONE, ground, sizeof ground);
  for (int a = 0; a < 4; ++a) {
    s->x[3 * a] += slide;
    s->x[3 * a + 1] += 0.02;
    s->x[3 * a + 2] = -0.01 + 0.004 * a; /* tilted about one edge direction: not flat against the ground */
    s->x[ONE + TWO + 3 * a] = 0.1;
    s->x[ONE + TWO + 3 * a + 1] = -0.05 * a;
    s->x[ONE + TWO + 3 * a + 2] = -1.0;
  }
}

static void handle_residual(scene *s, double *r) {
  CHECK_OK(stickslip_interface_residual(s->interface, s->x, s->x + ONE, s->x + ONE + TWO, NULL, r, r + ONE,
                                        r + ONE + TWO));
}

/* The unknowns of a pair: its non-mortar nodes, its four mortar nodes, its multipliers. */
static int unknown(int facet, int k) {
  if (k < ONE) return k;
  if (k < 2 * ONE) return ONE + 3 * (int)mortar_nodes[4 * facet + (k - ONE) / 3] + k % 3;
  return ONE + TWO + k - 2 * ONE;
}

/* What a host without the handle does. */
static void assemble(scene *s, int32_t layout, double *r, double *k) {
  double x2[2][ONE], old2[2][ONE], share[ONE];
  weights now[2], previous[2];
  stickslip_pair pairs[2], old[2];
  int active[2], before[2];
  stickslip_node nodes[4];
  memset(nodes, 0, sizeof nodes);

  /* Stage 1: weights of now and of t_n; coverage and gaps summed over the pairs. */
  for (int f = 0; f < 2; ++f) {
    for (int i = 0; i < ONE; ++i) {
      x2[f][i] = s->x[unknown(f, ONE + i)];
      old2[f][i] = ground[unknown(f, ONE + i) - ONE];
    }
    pairs[f] = make_pair(4, s->x, 4, x2[f]);
    pairs[f].layout = layout;
    old[f] = make_pair(4, at_t_n, 4, old2[f]);
    pair_weights(&pairs[f], &now[f]);
    pair_weights(&old[f], &previous[f]);
    active[f] = max_abs(now[f].ab, 16) > 0.0;
    before[f] = max_abs(previous[f].ab, 16) > 0.0;
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        nodes[a].coverage += now[f].ab[4 * a + b];
        nodes[a].coverage_previous += previous[f].ab[4 * a + b];
      }
    }
    CHECK_OK(stickslip_pair_gap(&pairs[f], now[f].ab, now[f].ac, share));
    for (int i = 0; i < ONE; ++i) nodes[i / 3].gap_now[i % 3] += share[i];
    CHECK_OK(stickslip_pair_gap(&pairs[f], previous[f].ab, previous[f].ac, share));
    for (int i = 0; i < ONE; ++i) nodes[i / 3].gap_previous[i % 3] += share[i];
  }

  /* Stage 2: the law at every node. */
  double normals[ONE], areas[4], scale[4];
  stickslip_node_response responses[4];
  CHECK_OK(stickslip_facet_geometry(4, at_t_n, normals, areas));
  for (int a = 0; a < 4; ++a) {
    nodes[a].struct_size = sizeof nodes[a];
    nodes[a].coverage_min = 1e-8 * areas[a];
    nodes[a].mu = 0.5;
    nodes[a].augmentation = 20.0 / areas[a];
    memcpy(nodes[a].lambda, s->x + ONE + TWO + 3 * a, sizeof nodes[a].lambda);
    CHECK_OK(stickslip_node_normal(normals + 3 * a, nodes[a].normal));
    responses[a].struct_size = sizeof responses[a];
    CHECK_OK(stickslip_node_respond(&nodes[a], &responses[a]));
    scale[a] = nodes[a].augmentation * areas[a];
  }

  /* Stage 3: forces and tangents of the pairs of now and of t_n. */
  memset(r, 0, ALL * sizeof *r);
  memset(k, 0, ALL * ALL * sizeof *k);
  for (int f = 0; f < 2; ++f) {
    double force[24], tangent[PAIR * PAIR];
    if (active[f]) {
      CHECK_OK(stickslip_pair_residual(&pairs[f], now[f].ab, now[f].ac, s->x + ONE + TWO, force));
      for (int i = 0; i < 24; ++i) r[unknown(f, i)] += force[i];
    }
    if (!active[f] && !before[f]) continue;
    CHECK_OK(stickslip_pair_tangent(&pairs[f], active[f] ? now[f].ab : NULL, active[f] ? now[f].ac : NULL,
                                    active[f] ? now[f].dab : NULL, active[f] ? now[f].dac : NULL,
                                    before[f] ? previous[f].ab : NULL, before[f] ? previous[f].ac : NULL,
                                    s->x + ONE + TWO, responses, scale, tangent, PAIR));
    for (int i = 0; i < PAIR; ++i) {
      for (int j = 0; j < PAIR; ++j) {
        k[unknown(f, i) * ALL + unknown(f, j)] += layout == STICKSLIP_LAYOUT_ROW_MAJOR ? tangent[i * PAIR + j]
                                                                                       : tangent[j * PAIR + i];
      }
    }
  }

  /* Stage 4: the nodes' own rows and blocks. */
  for (int a = 0; a < 4; ++a) {
    double block[9];
    const int first = ONE + TWO + 3 * a;
    CHECK_OK(stickslip_node_block(&responses[a], scale[a], STICKSLIP_LAYOUT_ROW_MAJOR, r + first, block));
    for (int i = 0; i < 9; ++i) k[(first + i / 3) * ALL + first + i % 3] += block[i];
  }
}

static void check_case(double slide, double friction, int32_t state) {
  static double r[ALL], k[ALL * ALL], handle_r[ALL], handle_k[ALL * ALL], plus[ALL], minus[ALL], values[20000];
  static int64_t rows[20000], columns[20000];
  int64_t n;
  scene s;
  create(&s, slide, friction);
  int32_t states[4];
  stickslip_states out;
  memset(&out, 0, sizeof out);
  out.struct_size = sizeof out;
  out.state = states;
  CHECK_OK(stickslip_interface_states(s.interface, s.x, s.x + ONE, s.x + ONE + TWO, NULL, &out));
  for (int a = 0; a < 4; ++a) CHECK(states[a] == state);

  memset(handle_k, 0, sizeof handle_k);
  handle_residual(&s, handle_r);
  CHECK_OK(stickslip_interface_tangent_coo(s.interface, s.x, s.x + ONE, s.x + ONE + TWO, NULL, 20000, rows, columns,
                                           values, &n));
  for (int64_t e = 0; e < n; ++e) handle_k[rows[e] * ALL + columns[e]] += values[e];

  for (int32_t layout = 0; layout < 2; ++layout) {
    assemble(&s, layout, r, k);
    /* The same sums in nearly the same order. */
    for (int i = 0; i < ALL; ++i) CHECK_NEAR(r[i], handle_r[i], 1e-15 * max_abs(handle_r, ALL));
    for (int i = 0; i < ALL * ALL; ++i) CHECK_NEAR(k[i], handle_k[i], 1e-14 * max_abs(handle_k, ALL * ALL));
  }

  for (int j = 0; j < ALL; ++j) {
    const double at = s.x[j], step = 1e-6;
    s.x[j] = at + step;
    handle_residual(&s, plus);
    s.x[j] = at - step;
    handle_residual(&s, minus);
    s.x[j] = at;
    for (int i = 0; i < ALL; ++i) {
      CHECK_NEAR(k[i * ALL + j], (plus[i] - minus[i]) / (2.0 * step), 1e-8 * max_abs(k, ALL * ALL));
    }
  }
  CHECK_OK(stickslip_interface_destroy(&s.interface));
}

/* A tangent inside a larger matrix: only its own entries are written, in either layout. */
static void check_leading_dimension(void) {
  enum { SIZE = 6 * 3 + 3 * 3, LD = SIZE + 5 };
  static double row_major[SIZE * SIZE], inside[SIZE * LD], lambda[9] = {0.1, 0.2, -1.0, 0.0, 0.1, -1.0, 0.3, 0.0, -1.0};
  weights w;
  stickslip_node_response responses[3];
  uint64_t random = 3;
  memset(responses, 0, sizeof responses);
  for (int a = 0; a < 3; ++a) {
    responses[a].struct_size = sizeof responses[a];
    for (int i = 0; i < 9; ++i) {
      responses[a].drow_dnow[i] = random_number(&random);
      responses[a].drow_dprevious[i] = random_number(&random);
    }
  }
  stickslip_pair pair = make_pair(3, tri1, 3, tri2);
  pair_weights(&pair, &w);
  CHECK_OK(stickslip_pair_tangent(&pair, w.ab, w.ac, w.dab, w.dac, w.ab, w.ac, lambda, responses, NULL, row_major, SIZE));
  for (int32_t layout = 0; layout < 2; ++layout) {
    pair.layout = layout;
    for (int i = 0; i < SIZE * LD; ++i) inside[i] = 12345.0;
    CHECK_OK(stickslip_pair_tangent(&pair, w.ab, w.ac, w.dab, w.dac, w.ab, w.ac, lambda, responses, NULL, inside, LD));
    for (int i = 0; i < SIZE; ++i) {
      for (int j = 0; j < LD; ++j) {
        if (j >= SIZE) CHECK(inside[i * LD + j] == 12345.0);
        else CHECK(inside[i * LD + j] == (layout == 0 ? row_major[i * SIZE + j] : row_major[j * SIZE + i]));
      }
    }
  }

  /* Previous-only: the rows' dependence on x through the weights of t_n, and nothing else. */
  pair.layout = STICKSLIP_LAYOUT_ROW_MAJOR;
  CHECK_OK(stickslip_pair_tangent(&pair, NULL, NULL, NULL, NULL, w.ab, w.ac, lambda, responses, NULL, row_major, SIZE));
  for (int i = 0; i < SIZE; ++i) {
    for (int j = 0; j < SIZE; ++j) {
      double expected = 0.0;
      if (i >= 18 && j < 18) {
        const int a = (i - 18) / 3, node = j / 3;
        const double n = node < 3 ? w.ab[3 * a + node] : -w.ac[3 * a + node - 3];
        expected = responses[a].drow_dprevious[3 * (i % 3) + j % 3] * n;
      }
      CHECK_NEAR(row_major[i * SIZE + j], expected, 1e-16);
    }
  }

  /* Frozen weights: no derivative of the forces with respect to positions. */
  CHECK_OK(stickslip_pair_tangent(&pair, w.ab, w.ac, NULL, NULL, w.ab, w.ac, lambda, responses, NULL, row_major, SIZE));
  for (int i = 0; i < 18; ++i) {
    for (int j = 0; j < 18; ++j) CHECK(row_major[i * SIZE + j] == 0.0);
  }
}

int main(void) {
  check_case(0.0, 0.5, STICKSLIP_STATE_STICK);
  check_case(0.5, 0.5, STICKSLIP_STATE_SLIP);  /* both pairs now, one at t_n */
  check_case(1.03, 0.5, STICKSLIP_STATE_SLIP); /* one pair at t_n only, the other now only */
  check_leading_dimension();
  return 0;
}
