/* Dual multipliers from the stages, by a host: 2 x 2 non-mortar quads with nine pairs each. Stage 1b turns each pair's
 * weights; then the calls of pairs and nodes go on as with the standard basis, and the tangent is assembled facet by facet.
 * Residual and tangent equal those of an interface handle, and central differences of the host's own residual. The surfaces
 * slide until facets are covered in part, hardly, and not at all. */
#include "pair.h"
#include "scene.h"

enum { FACETS = 4, PAIRS = 9, ROWS = 24 + 12 * PAIRS, LD = ROWS + 5 };

/* Rounding of the same sums in another order, relative to the largest number of a block. */
#define SAME 1e-12
/* Central differences at a step of 1e-6: truncation 1e-9 of the largest entry, and 1e-8 where a facet fades out. */
#define STEP 1e-6
#define DIFFERENCES 1e-7

/* A facet with its pairs at one configuration. */
typedef struct {
  double x1[12], x2[PAIRS][12], mass[16];
  double n_ab[PAIRS][16], n_ac[PAIRS][16], dual_ab[PAIRS][16], dual_ac[PAIRS][16];
  stickslip_pair pairs[PAIRS];
} patch;

typedef struct {
  double x1[X1], x2[X2];
  patch patches[FACETS];
} configuration;

/* Where component i of a facet's k-th node stands among the unknowns; nodes of the mortar facets come after its own. */
static int unknown(const scene *s, int f, int k, int i) {
  if (k < 4) return 3 * (int)s->nodes1[4 * f + k] + i;
  if (k < 4 + 4 * PAIRS) return X1 + 3 * (int)s->nodes2[k - 4] + i;
  return X1 + X2 + 3 * (int)s->nodes1[4 * f + k - 4 - 4 * PAIRS] + i;
}

/* Stages 1 and 1b. */
static void integrate(const scene *s, configuration *c) {
  for (int f = 0; f < FACETS; ++f) {
    patch *p = &c->patches[f];
    memset(p->mass, 0, sizeof p->mass);
    for (int k = 0; k < 4; ++k) memcpy(p->x1 + 3 * k, c->x1 + 3 * s->nodes1[4 * f + k], 3 * sizeof(double));
    for (int q = 0; q < PAIRS; ++q) {
      for (int k = 0; k < 4; ++k) memcpy(p->x2[q] + 3 * k, c->x2 + 3 * s->nodes2[4 * q + k], 3 * sizeof(double));
      p->pairs[q] = make_pair(4, p->x1, 4, p->x2[q]);
      CHECK_OK(stickslip_pair_weights(&p->pairs[q], p->n_ab[q], p->n_ac[q], NULL, NULL));
      for (int k = 0; k < 16; ++k) p->mass[k] += p->n_ab[q][k];
    }
    for (int q = 0; q < PAIRS; ++q) {
      CHECK_OK(stickslip_pair_dual(&p->pairs[q], p->mass, p->n_ab[q], p->n_ac[q], p->dual_ab[q], p->dual_ac[q]));
    }
  }
}

/* What a facet's dual basis says of itself is what it makes of the pairs' weights. Gives phi. */
static double check_basis(const patch *p) {
  double fade, areas[4], coefficients[16], sum[16] = {0};
  CHECK_OK(stickslip_facet_dual(4, p->x1, p->mass, &fade, areas, coefficients));
  CHECK(0.0 <= fade && fade <= 1.0);
  const double scale = max_abs(p->mass, 16), largest = max_abs(coefficients, 16);
  for (int q = 0; q < PAIRS; ++q) {
    double in_place[16], row[2];
    memcpy(in_place, p->n_ac[q], sizeof in_place);
    CHECK_OK(stickslip_pair_dual(&p->pairs[q], p->mass, p->n_ab[q], in_place, NULL, in_place));
    CHECK(memcmp(in_place, p->dual_ac[q], sizeof in_place) == 0);
    for (int a = 0; a < 4; ++a) {
      row[0] = row[1] = 0.0;
      for (int c = 0; c < 4; ++c) {
        double turned = 0.0;
        for (int b = 0; b < 4; ++b) turned += coefficients[4 * a + b] * p->n_ac[q][4 * b + c];
        CHECK_NEAR(p->dual_ac[q][4 * a + c], turned, 1e-15 * (1.0 + largest) * scale);
        row[0] += p->dual_ac[q][4 * a + c];
        row[1] += p->dual_ab[q][4 * a + c];
        sum[4 * a + c] += p->dual_ab[q][4 * a + c];
      }
      CHECK_NEAR(row[0], row[1], 1e-15 * (1.0 + largest) * scale); /* pair by pair: no momentum is lost */
    }
  }
  for (int k = 0; k < 16; ++k) {
    CHECK_NEAR(sum[k], k % 5 == 0 ? areas[k / 5] : 0.0, 1e-15 * (1.0 + largest) * scale);
  }
  return fade;
}

/* What a facet adds to the tangent: its own, or that of its pairs where weights are frozen. */
static void add_tangent(const scene *s, int f, const patch *p, const patch *old, int frozen, int32_t layout,
                        const double *lambda, const stickslip_node_response *responses, const double *scale, double *k) {
  static double tangent[ROWS * LD];
  const int32_t n2[PAIRS] = {4, 4, 4, 4, 4, 4, 4, 4, 4};
  const int rows = frozen ? 36 : ROWS, ld = frozen ? 36 : LD;
  stickslip_facet facet;
  memset(&facet, 0, sizeof facet);
  facet.struct_size = sizeof facet;
  facet.n1 = 4;
  facet.layout = layout;
  facet.n_pairs = PAIRS;
  facet.x1 = p->x1;
  facet.n2 = n2;
  facet.x2 = p->x2[0];
  for (int q = 0; q < (frozen ? PAIRS : 1); ++q) {
    for (int i = 0; i < ROWS * LD; ++i) tangent[i] = 12345.0;
    if (frozen) {
      stickslip_pair pair = p->pairs[q];
      pair.layout = layout;
      CHECK_OK(stickslip_pair_tangent(&pair, old->dual_ab[q], old->dual_ac[q], NULL, NULL, old->dual_ab[q],
                                      old->dual_ac[q], lambda, responses, scale, tangent, ld));
    } else {
      CHECK_OK(stickslip_facet_tangent(&facet, p->n_ab[0], p->n_ac[0], old->dual_ab[0], old->dual_ac[0], lambda,
                                       responses, scale, tangent, ld));
    }
    int u[ROWS];
    for (int i = 0; i < rows; ++i) {
      const int node = i / 3;
      u[i] = unknown(s, f, !frozen || node < 4 ? node : node < 8 ? node + 4 * q : node - 4 + 4 * PAIRS, i % 3);
    }
    for (int i = 0; i < rows; ++i) {
      for (int j = rows; j < ld; ++j) CHECK(tangent[i * ld + j] == 12345.0);
      for (int j = 0; j < rows; ++j) {
        k[u[i] * UNKNOWNS + u[j]] += tangent[layout == STICKSLIP_LAYOUT_ROW_MAJOR ? i * ld + j : j * ld + i];
      }
    }
  }
}

/* Stages 2 to 4 from the configurations of now and of t_n, with the weights of now or, frozen, those of t_n; k may be
 * NULL. */
static void assemble(const scene *s, const configuration *now, const configuration *before, int frozen, int32_t layout,
                     double *r, double *k) {
  double normals[X1] = {0}, areas[N1] = {0}, scale[N1], share[24];
  stickslip_node nodes[N1];
  stickslip_node_response responses[N1];
  memset(nodes, 0, sizeof nodes);
  for (int f = 0; f < FACETS; ++f) {
    const patch *p = &now->patches[f], *old = &before->patches[f], *w = frozen ? old : p;
    double of_normals[12], of_areas[4];
    CHECK_OK(stickslip_facet_geometry(4, old->x1, of_normals, of_areas));
    for (int b = 0; b < 4; ++b) areas[s->nodes1[4 * f + b]] += of_areas[b];
    for (int i = 0; i < 12; ++i) normals[unknown(s, f, i / 3, i % 3)] += of_normals[i];
    for (int q = 0; q < PAIRS; ++q) {
      for (int b = 0; b < 16; ++b) {
        stickslip_node *node = &nodes[s->nodes1[4 * f + b / 4]];
        node->coverage += w->dual_ab[q][b];
        node->coverage_previous += old->dual_ab[q][b];
      }
      CHECK_OK(stickslip_pair_gap(&p->pairs[q], w->dual_ab[q], w->dual_ac[q], share));
      for (int i = 0; i < 12; ++i) nodes[s->nodes1[4 * f + i / 3]].gap_now[i % 3] += share[i];
      CHECK_OK(stickslip_pair_gap(&p->pairs[q], old->dual_ab[q], old->dual_ac[q], share));
      for (int i = 0; i < 12; ++i) nodes[s->nodes1[4 * f + i / 3]].gap_previous[i % 3] += share[i];
      CHECK_OK(stickslip_pair_gap(&old->pairs[q], old->dual_ab[q], old->dual_ac[q], share));
      for (int i = 0; i < 12; ++i) nodes[s->nodes1[4 * f + i / 3]].gap_committed[i % 3] += share[i];
    }
  }
  for (int a = 0; a < N1; ++a) {
    stickslip_node *node = &nodes[a];
    node->struct_size = sizeof *node;
    node->slip = frozen ? STICKSLIP_SLIP_INCREMENT : STICKSLIP_SLIP_OBJECTIVE; /* what the handle measures then */
    node->coverage_min = 1e-8 * areas[a];
    node->mu = node->coverage_previous > node->coverage_min ? s->options.mu : 0.0;
    node->augmentation = s->method.augmentation / areas[a];
    scale[a] = node->augmentation * areas[a];
    memcpy(node->lambda, s->lambda + 3 * a, sizeof node->lambda);
    CHECK_OK(stickslip_node_normal(normals + 3 * a, node->normal));
    responses[a].struct_size = sizeof responses[a];
    CHECK_OK(stickslip_node_respond(node, &responses[a]));
  }
  memset(r, 0, UNKNOWNS * sizeof *r);
  if (k) memset(k, 0, UNKNOWNS * UNKNOWNS * sizeof *k);
  for (int f = 0; f < FACETS; ++f) {
    const patch *p = &now->patches[f], *old = &before->patches[f], *w = frozen ? old : p;
    double lambda[12], row_scale[4];
    stickslip_node_response of_facet[4];
    for (int b = 0; b < 4; ++b) {
      const int64_t a = s->nodes1[4 * f + b];
      memcpy(lambda + 3 * b, s->lambda + 3 * a, 3 * sizeof(double));
      of_facet[b] = responses[a];
      row_scale[b] = scale[a];
    }
    for (int q = 0; q < PAIRS; ++q) {
      CHECK_OK(stickslip_pair_residual(&p->pairs[q], w->dual_ab[q], w->dual_ac[q], lambda, share));
      for (int i = 0; i < 24; ++i) r[unknown(s, f, i < 12 ? i / 3 : 4 * q + i / 3, i % 3)] += share[i];
    }
    if (k) add_tangent(s, f, p, old, frozen, layout, lambda, of_facet, row_scale, k);
  }
  for (int a = 0; a < N1; ++a) {
    double block[9];
    const int first = X1 + X2 + 3 * a;
    CHECK_OK(stickslip_node_block(&responses[a], scale[a], STICKSLIP_LAYOUT_ROW_MAJOR, r + first, block));
    for (int i = 0; k && i < 9; ++i) k[(first + i / 3) * UNKNOWNS + first + i % 3] += block[i];
  }
}

/* Number of nodes in each state, and the smallest phi of a facet. */
typedef struct {
  int states[3];
  double fade;
} found;

static found check_slide(double by, int frozen) {
  static scene s;
  static configuration now, before;
  static double r[UNKNOWNS], k[UNKNOWNS * UNKNOWNS], handle_r[UNKNOWNS], handle_k[UNKNOWNS * UNKNOWNS];
  static double plus[UNKNOWNS], minus[UNKNOWNS];
  static triplets t;
  int32_t state[N1];
  found result = {{0, 0, 0}, 1.0};
  scene_init(&s);
  s.method.multiplier_basis = STICKSLIP_BASIS_DUAL;
  s.method.weak_coverage = 0.0;
  s.method.weights = frozen ? STICKSLIP_WEIGHTS_COMMITTED : STICKSLIP_WEIGHTS_CURRENT;
  scene_create(&s);
  CHECK_OK(stickslip_interface_commit(s.interface, s.x1, s.x2, s.lambda, NULL));
  memcpy(before.x1, s.x1, sizeof s.x1);
  memcpy(before.x2, s.x2, sizeof s.x2);
  integrate(&s, &before);
  scene_slide(&s, by);
  memcpy(now.x1, s.x1, sizeof s.x1);
  memcpy(now.x2, s.x2, sizeof s.x2);
  integrate(&s, &now);
  for (int f = 0; f < FACETS; ++f) result.fade = fmin(result.fade, check_basis(&now.patches[f]));

  stickslip_states out;
  memset(&out, 0, sizeof out);
  out.struct_size = sizeof out;
  out.state = state;
  CHECK_OK(stickslip_interface_states(s.interface, s.x1, s.x2, s.lambda, NULL, &out));
  for (int a = 0; a < N1; ++a) ++result.states[state[a]];
  scene_residual(&s, handle_r);
  memset(handle_k, 0, sizeof handle_k);
  scene_tangent(&s, &t);
  triplets_add(&t, 0, handle_k);
  for (int32_t layout = 0; layout < 2; ++layout) {
    assemble(&s, &now, &before, frozen, layout, r, k);
    for (int i = 0; i < UNKNOWNS; ++i) CHECK_NEAR(r[i], handle_r[i], SAME * max_abs(handle_r, UNKNOWNS));
    CHECK_NEAR(block_difference(k, handle_k, 0.01 * max_abs(handle_k, UNKNOWNS * UNKNOWNS)), 0.0, SAME);
  }

  const double largest = max_abs(k, UNKNOWNS * UNKNOWNS);
  for (int j = 0; j < UNKNOWNS; ++j) {
    double *x = j < X1 ? now.x1 + j : j < X1 + X2 ? now.x2 + j - X1 : s.lambda + j - X1 - X2;
    const double at = *x;
    *x = at + STEP;
    integrate(&s, &now);
    assemble(&s, &now, &before, frozen, 0, plus, NULL);
    *x = at - STEP;
    integrate(&s, &now);
    assemble(&s, &now, &before, frozen, 0, minus, NULL);
    *x = at;
    for (int i = 0; i < UNKNOWNS; ++i) {
      CHECK_NEAR(k[i * UNKNOWNS + j], (plus[i] - minus[i]) / (2.0 * STEP), DIFFERENCES * largest);
    }
  }
  scene_destroy(&s);
  return result;
}

int main(void) {
  const double slides[] = {0.0, 0.3, 0.8, 0.89, 1.1};
  int states[3] = {0, 0, 0}, uncovered = 0, partly = 0;
  for (int n = 0; n < COUNT(slides); ++n) {
    const found found = check_slide(slides[n], 0);
    for (int state = 0; state < 3; ++state) states[state] += found.states[state];
    uncovered += found.fade == 0.0;
    partly += 0.0 < found.fade && found.fade < 1.0;
  }
  CHECK(states[STICKSLIP_STATE_GAP] > 0 && states[STICKSLIP_STATE_STICK] > 0 && states[STICKSLIP_STATE_SLIP] > 0);
  CHECK(uncovered > 0 && partly > 0);
  check_slide(0.05, 1);
  return 0;
}
