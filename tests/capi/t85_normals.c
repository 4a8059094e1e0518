/* Normals of the current configuration, over a non-mortar surface that is curved in both directions, and partly off the
 * mortar surface, where a facet without pairs shares nodes with one that has them. The stages assemble the residual and the
 * tangent of a handle, with what follows from the derivative of the normals. Multipliers turn with the surface. A step may
 * begin with the normals of its start, and is not accepted with them. */
#include "pair.h"
#include "scene.h"

#include <stddef.h>

enum { FACETS = 4, PAIRS = 9 };

/* Rounding of the same sums in another order, relative to the largest number of a block. */
static const double SAME = 1e-12;
/* Part of a matrix that is the difference of two: their own rounding, relative to the larger one. */
static const double DIFFERENCE = 1e-13;
/* A vector that is turned, of length 1. */
static const double TURNED = 1e-14;

/* A facet with its pairs at one configuration. */
typedef struct {
  double x1[12], x2[PAIRS][12];
  stickslip_pair pairs[PAIRS];
  weights w[PAIRS];
} patch;
typedef struct {
  double x1[X1], x2[X2];
  patch patches[FACETS];
} configuration;

static scene s;
static configuration now, before;
static triplets t;
static int64_t seen[3], lone_facets;

/* Bends the non-mortar surface up at its borders; facets stay parallelograms. */
static void bend(double *x, double along, double across, double up) {
  for (int a = 0; a < N1; ++a) {
    double d[3] = {0.0, 0.0, up + along * (a % 3 != 1) + across * (a / 3 != 1)};
    scene_frame(d);
    for (int i = 0; i < 3; ++i) x[3 * a + i] += d[i];
  }
}

/* Stage 1, where the scene is. */
static void integrate(configuration *c) {
  memcpy(c->x1, s.x1, sizeof c->x1);
  memcpy(c->x2, s.x2, sizeof c->x2);
  for (int f = 0; f < FACETS; ++f) {
    patch *p = &c->patches[f];
    for (int k = 0; k < 4; ++k) memcpy(p->x1 + 3 * k, c->x1 + 3 * s.nodes1[4 * f + k], 3 * sizeof(double));
    for (int q = 0; q < PAIRS; ++q) {
      for (int k = 0; k < 4; ++k) memcpy(p->x2[q] + 3 * k, c->x2 + 3 * s.nodes2[4 * q + k], 3 * sizeof(double));
      p->pairs[q] = make_pair(4, p->x1, 4, p->x2[q]);
      pair_weights(&p->pairs[q], &p->w[q]);
    }
  }
}

/* An interface at t_n, moved within the step: slid by `by` and bent further. */
static void set_up(double by, int32_t normals, int32_t form) {
  scene_init(&s);
  s.options.mu = 0.4;
  s.method.normals = normals;
  s.method.form = form;
  bend(s.reference1, 0.05, 0.04, -0.035);
  bend(s.x1, 0.05, 0.04, -0.035);
  scene_create(&s);
  scene_slide(&s, by);
  scene_commit(&s);
  integrate(&before);
  bend(s.x1, 0.03, -0.02, -0.005);
  scene_slide(&s, 0.015);
  integrate(&now);
}

/* Gaps with weights of one configuration at the positions of another. */
static void add_gap(const patch *weights_of, const patch *at, int f, size_t member, stickslip_node *nodes) {
  for (int q = 0; q < PAIRS; ++q) {
    double share[12];
    CHECK_OK(stickslip_pair_gap(&at->pairs[q], weights_of->w[q].ab, weights_of->w[q].ac, share));
    for (int i = 0; i < 12; ++i) {
      double *gap = (double *)((char *)&nodes[s.nodes1[4 * f + i / 3]] + member);
      gap[i % 3] += share[i];
    }
  }
}

/* Stages 1 and 2: the sums of the corner normals, the nodes and their answers. */
static void respond(double sums[X1], double scale[N1], stickslip_node nodes[N1], stickslip_node_response responses[N1]) {
  double areas[N1] = {0}, of_normals[12], of_areas[4];
  memset(nodes, 0, N1 * sizeof *nodes);
  memset(sums, 0, X1 * sizeof *sums);
  for (int f = 0; f < FACETS; ++f) {
    const patch *p = &now.patches[f], *old = &before.patches[f];
    CHECK_OK(stickslip_facet_geometry(4, p->x1, of_normals, NULL));
    CHECK_OK(stickslip_facet_geometry(4, old->x1, NULL, of_areas));
    for (int i = 0; i < 12; ++i) sums[3 * s.nodes1[4 * f + i / 3] + i % 3] += of_normals[i];
    for (int b = 0; b < 4; ++b) areas[s.nodes1[4 * f + b]] += of_areas[b];
    for (int k = 0; k < 16 * PAIRS; ++k) {
      stickslip_node *node = &nodes[s.nodes1[4 * f + k % 16 / 4]];
      node->coverage += p->w[k / 16].ab[k % 16];
      node->coverage_previous += old->w[k / 16].ab[k % 16];
    }
    add_gap(p, p, f, offsetof(stickslip_node, gap_now), nodes);
    add_gap(old, p, f, offsetof(stickslip_node, gap_previous), nodes);
    add_gap(old, old, f, offsetof(stickslip_node, gap_committed), nodes);
  }
  for (int a = 0; a < N1; ++a) {
    stickslip_node *node = &nodes[a];
    node->struct_size = sizeof *node;
    node->coverage_min = 1e-8 * areas[a];
    node->mu = node->coverage_previous > node->coverage_min ? s.options.mu : 0.0;
    node->augmentation = s.method.augmentation / areas[a];
    scale[a] = node->augmentation * areas[a];
    memcpy(node->lambda, s.lambda + 3 * a, sizeof node->lambda);
    CHECK_OK(stickslip_node_normal(sums + 3 * a, node->normal));
    responses[a].struct_size = sizeof responses[a];
    CHECK_OK(stickslip_node_respond(node, &responses[a]));
  }
}

/* dnu/ds, dp/dnu and dc/dnu of a node, row by row. */
static void turn_of(const stickslip_node *node, const double *sum, double turn[27]) {
  double columns[27];
  CHECK_OK(stickslip_node_turn(node, sum, STICKSLIP_LAYOUT_ROW_MAJOR, turn, turn + 9, turn + 18));
  CHECK_OK(stickslip_node_turn(node, sum, STICKSLIP_LAYOUT_COLUMN_MAJOR, columns, columns + 9, columns + 18));
  for (int k = 0; k < 27; ++k) CHECK(columns[k] == turn[k / 9 * 9 + k % 3 * 3 + k % 9 / 3]);
}

/* What the nodes' normals add to the tangent: to the multipliers' rows, and to forces of p where `augmented`. */
static void add_turns(const double *sums, const double *scale, const stickslip_node *nodes, int augmented, double *k) {
  static double d[N1][N1], m[N1][N2];
  memset(d, 0, sizeof d);
  memset(m, 0, sizeof m);
  for (int f = 0; f < FACETS; ++f) {
    for (int e = 0; e < 16 * PAIRS; ++e) {
      const weights *w = &now.patches[f].w[e / 16];
      const int64_t a = s.nodes1[4 * f + e % 16 / 4];
      d[a][s.nodes1[4 * f + e % 4]] += w->ab[e % 16];
      m[a][s.nodes2[4 * (e / 16) + e % 4]] += w->ac[e % 16];
    }
  }
  for (int f = 0; f < FACETS; ++f) {
    double dm[144];
    CHECK_OK(stickslip_facet_normal_derivatives(4, now.patches[f].x1, dm));
    for (int corner = 0; corner < 4; ++corner) {
      const int64_t a = s.nodes1[4 * f + corner];
      double turn[27];
      turn_of(&nodes[a], sums + 3 * a, turn);
      for (int column = 0; column < 12; ++column) {
        const int64_t at = 3 * s.nodes1[4 * f + column / 3] + column % 3;
        double dnu[3] = {0}, dp[3] = {0}, row[3] = {0};
        for (int e = 0; e < 9; ++e) dnu[e / 3] += turn[e] * dm[(3 * corner + e % 3) * 12 + column];
        for (int e = 0; e < 9; ++e) dp[e / 3] += turn[9 + e] * dnu[e % 3];
        for (int e = 0; e < 9; ++e) row[e / 3] += turn[18 + e] * dnu[e % 3];
        for (int i = 0; i < 3; ++i) {
          k[(X1 + X2 + 3 * a + i) * UNKNOWNS + at] += scale[a] * row[i];
          for (int b = 0; augmented && b < N1; ++b) k[(3 * b + i) * UNKNOWNS + at] += d[a][b] * dp[i];
          for (int c = 0; augmented && c < N2; ++c) k[(X1 + 3 * c + i) * UNKNOWNS + at] -= m[a][c] * dp[i];
        }
      }
    }
  }
}

/* Stages 3 and 4 in the multiplier form. */
static void assemble(double *r, double *k) {
  double sums[X1], scale[N1];
  stickslip_node nodes[N1];
  stickslip_node_response responses[N1];
  respond(sums, scale, nodes, responses);
  memset(r, 0, UNKNOWNS * sizeof *r);
  memset(k, 0, UNKNOWNS * UNKNOWNS * sizeof *k);
  for (int f = 0; f < FACETS; ++f) {
    const patch *p = &now.patches[f], *old = &before.patches[f];
    double lambda[12], row_scale[4], force[24], tangent[36 * 36];
    stickslip_node_response of_facet[4];
    int overlaps = 0, covered = 0;
    for (int b = 0; b < 4; ++b) {
      const int64_t a = s.nodes1[4 * f + b];
      memcpy(lambda + 3 * b, s.lambda + 3 * a, 3 * sizeof(double));
      of_facet[b] = responses[a];
      row_scale[b] = scale[a];
      covered |= nodes[a].coverage > nodes[a].coverage_min;
    }
    for (int q = 0; q < PAIRS; ++q) {
      const weights *w = &p->w[q], *w_old = &old->w[q];
      int u[36];
      for (int i = 0; i < 36; ++i) {
        const int node = i / 3;
        const int64_t first = node < 4   ? 3 * s.nodes1[4 * f + node]
                              : node < 8 ? X1 + 3 * s.nodes2[4 * q + node - 4]
                                         : X1 + X2 + 3 * s.nodes1[4 * f + node - 8];
        u[i] = (int)first + i % 3;
      }
      CHECK_OK(stickslip_pair_residual(&p->pairs[q], w->ab, w->ac, lambda, force));
      CHECK_OK(stickslip_pair_tangent(&p->pairs[q], w->ab, w->ac, w->dab, w->dac, w_old->ab, w_old->ac, lambda, of_facet,
                                      row_scale, tangent, 36));
      for (int i = 0; i < 24; ++i) r[u[i]] += force[i];
      for (int e = 0; e < 36 * 36; ++e) k[u[e / 36] * UNKNOWNS + u[e % 36]] += tangent[e];
      overlaps |= max_abs(w->ab, 16) > 0.0 || max_abs(w_old->ab, 16) > 0.0;
    }
    lone_facets += covered && !overlaps;
  }
  for (int a = 0; a < N1; ++a) {
    double block[9];
    const int first = X1 + X2 + 3 * a;
    CHECK_OK(stickslip_node_block(&responses[a], scale[a], STICKSLIP_LAYOUT_ROW_MAJOR, r + first, block));
    for (int i = 0; i < 9; ++i) k[(first + i / 3) * UNKNOWNS + first + i % 3] += block[i];
    ++seen[responses[a].state];
  }
  add_turns(sums, scale, nodes, 0, k);
}

/* (x1, x2, lambda) by the handle. */
static void handle_tangent(double *k) {
  memset(k, 0, UNKNOWNS * UNKNOWNS * sizeof *k);
  scene_tangent(&s, &t);
  triplets_add(&t, 0, k);
}

static void check_stages(double by) {
  static double r[UNKNOWNS], k[UNKNOWNS * UNKNOWNS], handle_r[UNKNOWNS], handle_k[UNKNOWNS * UNKNOWNS];
  set_up(by, STICKSLIP_NORMALS_CURRENT, STICKSLIP_FORM_MULTIPLIER);
  assemble(r, k);
  scene_residual(&s, handle_r);
  handle_tangent(handle_k);
  for (int i = 0; i < UNKNOWNS; ++i) CHECK_NEAR(r[i], handle_r[i], SAME * max_abs(handle_r, UNKNOWNS));
  CHECK_NEAR(block_difference(k, handle_k, 0.01 * max_abs(handle_k, UNKNOWNS * UNKNOWNS)), 0.0, SAME);
  scene_destroy(&s);
}

/* In the augmented form: the tangent is that with the same normals as data, and what they add. */
static void check_augmented(double by) {
  static double with[UNKNOWNS * UNKNOWNS], without[UNKNOWNS * UNKNOWNS];
  double sums[X1], scale[N1], normals[X1];
  stickslip_node nodes[N1];
  stickslip_node_response responses[N1];
  set_up(by, STICKSLIP_NORMALS_CURRENT, STICKSLIP_FORM_AUGMENTED);
  handle_tangent(with);
  scene_destroy(&s);
  set_up(by, STICKSLIP_NORMALS_COMMITTED, STICKSLIP_FORM_AUGMENTED);
  respond(sums, scale, nodes, responses);
  for (int a = 0; a < N1; ++a) memcpy(normals + 3 * a, nodes[a].normal, 3 * sizeof(double));
  CHECK_OK(stickslip_interface_set_normals(s.interface, normals));
  handle_tangent(without);
  const double largest = max_abs(with, UNKNOWNS * UNKNOWNS);
  double added = 0.0;
  for (int e = 0; e < UNKNOWNS * UNKNOWNS; ++e) added = larger(added, fabs(with[e] - without[e]));
  CHECK(added > 0.01 * largest); /* or nothing would be compared */
  add_turns(sums, scale, nodes, 1, without);
  for (int e = 0; e < UNKNOWNS * UNKNOWNS; ++e) CHECK_NEAR(without[e], with[e], DIFFERENCE * largest);
  scene_destroy(&s);
}

/* The normals at the scene's positions. */
static void normals_at(double normals[X1]) {
  stickslip_states states = {.struct_size = sizeof states, .normal = normals};
  CHECK_OK(stickslip_interface_states(s.interface, s.x1, s.x2, s.lambda, NULL, &states));
}

/* About an axis within the surface at a node the smallest rotation is the whole one. */
static void check_turn_of_multipliers(void) {
  const double angle = 70.0 * 3.14159265358979 / 180.0;
  double normals[X1], turned[X1], lambda[X1];
  set_up(0.0, STICKSLIP_NORMALS_CURRENT, STICKSLIP_FORM_MULTIPLIER);
  memcpy(s.x1, before.x1, sizeof s.x1);
  normals_at(normals);
  for (int a = 0; a < N1; ++a) {
    const double *nu = normals + 3 * a, length = sqrt(nu[1] * nu[1] + nu[2] * nu[2]);
    const double axis[3] = {0.0, nu[2] / length, -nu[1] / length};
    memcpy(turned, before.x1, sizeof turned);
    for (int b = 0; b < N1; ++b) scene_turn(turned + 3 * b, axis, angle);
    memcpy(lambda, s.lambda, sizeof lambda);
    CHECK_OK(stickslip_interface_turn_multipliers(s.interface, turned, lambda));
    double expected[3];
    memcpy(expected, s.lambda + 3 * a, sizeof expected);
    scene_turn(expected, axis, angle);
    for (int i = 0; i < 3; ++i) CHECK_NEAR(lambda[3 * a + i], expected[i], TURNED);
    for (int b = 0; b < X1; b += 3) {
      CHECK_NEAR(hypot(hypot(lambda[b], lambda[b + 1]), lambda[b + 2]),
                 hypot(hypot(s.lambda[b], s.lambda[b + 1]), s.lambda[b + 2]), TURNED);
    }
  }
  /* Folded along its middle the surface has no normals there. */
  for (int a = 0; a < N1; a += 3) memcpy(turned + 3 * a + 6, turned + 3 * a, 3 * sizeof(double));
  memcpy(lambda, s.lambda, sizeof lambda);
  CHECK_REFUSED(stickslip_interface_turn_multipliers(s.interface, turned, lambda), STICKSLIP_UNDEFINED_NORMAL, "node 1");
  CHECK(memcmp(lambda, s.lambda, sizeof lambda) == 0);
  scene_destroy(&s);
  /* Where normals do not turn, multipliers stay. */
  set_up(0.0, STICKSLIP_NORMALS_COMMITTED, STICKSLIP_FORM_MULTIPLIER);
  CHECK_OK(stickslip_interface_turn_multipliers(s.interface, now.x1, lambda));
  CHECK(memcmp(lambda, s.lambda, sizeof lambda) == 0);
  scene_destroy(&s);
}

/* The first phase of a step has the normals of its start; a commit needs those of now. */
static void check_phases(void) {
  double committed[UNKNOWNS], current[UNKNOWNS], found[UNKNOWNS], normals[X1];
  set_up(0.0, STICKSLIP_NORMALS_COMMITTED, STICKSLIP_FORM_MULTIPLIER);
  scene_residual(&s, committed);
  CHECK_OK(stickslip_interface_use_normals(s.interface, STICKSLIP_NORMALS_COMMITTED));
  CHECK_REFUSED(stickslip_interface_use_normals(s.interface, STICKSLIP_NORMALS_CURRENT), STICKSLIP_INVALID_VALUE, "created");
  scene_residual(&s, found);
  CHECK(memcmp(found, committed, sizeof found) == 0);
  normals_at(normals);
  CHECK_OK(stickslip_interface_set_normals(s.interface, normals));
  scene_destroy(&s);

  set_up(0.0, STICKSLIP_NORMALS_CURRENT, STICKSLIP_FORM_MULTIPLIER);
  scene_residual(&s, current);
  CHECK(memcmp(current, committed, sizeof found) != 0);
  CHECK_OK(stickslip_interface_use_normals(s.interface, STICKSLIP_NORMALS_COMMITTED));
  scene_residual(&s, found);
  CHECK(memcmp(found, committed, sizeof found) == 0);
  CHECK_REFUSED(stickslip_interface_commit(s.interface, s.x1, s.x2, s.lambda, NULL), STICKSLIP_INVALID_VALUE, "use_normals");
  CHECK_OK(stickslip_interface_use_normals(s.interface, STICKSLIP_NORMALS_CURRENT));
  scene_residual(&s, found);
  CHECK(memcmp(found, current, sizeof found) == 0);
  scene_commit(&s);
  /* The phase ends with the step. */
  CHECK_OK(stickslip_interface_use_normals(s.interface, STICKSLIP_NORMALS_COMMITTED));
  CHECK_OK(stickslip_interface_rollback(s.interface));
  scene_residual(&s, found);
  CHECK(memcmp(found, current, sizeof found) == 0);

  /* Normals of the host would not follow. */
  CHECK_REFUSED(stickslip_interface_set_normals(s.interface, normals), STICKSLIP_UNSUPPORTED, "STICKSLIP_NORMALS_CURRENT");
  CHECK_OK(stickslip_interface_set_normals(s.interface, NULL));
  scene_residual(&s, found);
  CHECK(memcmp(found, current, sizeof found) == 0);
  scene_destroy(&s);
}

int main(void) {
  const double slides[] = {0.0, 1.1};
  for (int n = 0; n < COUNT(slides); ++n) {
    check_stages(slides[n]);
    check_augmented(slides[n]);
  }
  CHECK(seen[STICKSLIP_STATE_GAP] > 0 && seen[STICKSLIP_STATE_STICK] > 0 && seen[STICKSLIP_STATE_SLIP] > 0);
  CHECK(lone_facets > 0);
  check_turn_of_multipliers();
  check_phases();
  return 0;
}
