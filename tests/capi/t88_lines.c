/* Lines of plane and axisymmetric models: weights, gap, forces and tangent of two of them, and what is refused. */
#include "check.h"

#include <stickslip.h>
#include <string.h>

/* Two nodes and two multipliers a line, two components each: x1, x2, lambda. */
enum { NODES = 2, X = 2 * NODES, UNKNOWNS = 3 * X };
/* Rounding of a dozen products. */
#define ROUNDING 1e-14
/* Central differences of numbers of some tens: rounding 1e-15 / STEP, and the step's square times a third derivative. */
#define STEP 1e-6
#define DIFFERENCES 1e-7

static const double pi = 3.14159265358979323846;
/* x1 along the first axis with its body above it, x2 below it with its body below: the middle three quarters overlap. */
static const double start[UNKNOWNS] = {0.0, 0.0, 1.0, 0.0, 0.875, -0.1, 0.125, -0.1, 0.02, -1.0, 0.01, -0.9};

static stickslip_pair pair_at(const double *u, int32_t model) {
  const stickslip_pair pair = {.struct_size = sizeof pair, .n1 = NODES, .n2 = NODES, .x1 = u, .x2 = u + X, .model = model};
  return pair;
}

typedef struct {
  double ab[NODES * NODES], ac[NODES * NODES], dab[NODES * NODES * 2 * X], dac[NODES * NODES * 2 * X];
} weights;

/* Forces, then rows of the multipliers; k: the tangent, or NULL. The weights of t_n are those of the start. */
static void evaluate(const double *u, int32_t model, double *residual, double *k) {
  const stickslip_pair pair = pair_at(u, model), begun = pair_at(start, model);
  const double *lambda = u + 2 * X;
  weights now, before;
  double gap[X], gap_before[X];
  stickslip_node_response responses[NODES];
  CHECK_OK(stickslip_pair_weights(&pair, now.ab, now.ac, now.dab, now.dac));
  CHECK_OK(stickslip_pair_weights(&begun, before.ab, before.ac, NULL, NULL));
  CHECK_OK(stickslip_pair_gap(&pair, now.ab, now.ac, gap));
  CHECK_OK(stickslip_pair_gap(&pair, before.ab, before.ac, gap_before));
  CHECK_OK(stickslip_pair_residual(&pair, now.ab, now.ac, lambda, residual));
  for (int a = 0; a < NODES; ++a) {
    /* A node of such a model: the third direction is prescribed, the third components are 0. */
    stickslip_node node = {.struct_size = sizeof node, .augmentation = 20, .mu = 0.3, .coverage = 1, .coverage_previous = 1,
        .n_directions = 1, .directions = {0, 0, 1}, .normal = {0, 1, 0}, .lambda = {lambda[2 * a], lambda[2 * a + 1], 0},
        .gap_now = {gap[2 * a], gap[2 * a + 1], 0}, .gap_previous = {gap_before[2 * a], gap_before[2 * a + 1], 0}};
    responses[a].struct_size = sizeof responses[a];
    CHECK_OK(stickslip_node_respond(&node, &responses[a]));
    CHECK(responses[a].row[2] == 0.0 && responses[a].traction[2] == 0.0);
    memcpy(residual + 2 * X + 2 * a, responses[a].row, 2 * sizeof *residual);
  }
  if (!k) return;
  CHECK_OK(stickslip_pair_tangent(&pair, now.ab, now.ac, now.dab, now.dac, before.ab, before.ac, lambda, responses, NULL, k, UNKNOWNS));
  for (int a = 0; a < NODES; ++a) {
    double block[9];
    CHECK_OK(stickslip_node_block(&responses[a], 1.0, STICKSLIP_LAYOUT_ROW_MAJOR, NULL, block));
    for (int e = 0; e < 4; ++e) k[(2 * X + 2 * a + e / 2) * UNKNOWNS + 2 * X + 2 * a + e % 2] += block[3 * (e / 2) + e % 2];
  }
}

static void tangent(int32_t model) {
  double u[UNKNOWNS], residual[UNKNOWNS], k[UNKNOWNS * UNKNOWNS], plus[UNKNOWNS], less[UNKNOWNS];
  /* Somewhat further than the start, so that the nodes have slid; the axis is not passed. */
  for (int i = 0; i < UNKNOWNS; ++i) u[i] = start[i] + 0.01 * (i % 3) * (i < 2 * X);
  FILL(k);
  evaluate(u, model, residual, k);
  double axial = 0.0, radial = 0.0;
  for (int i = 0; i < 2 * X; i += 2) radial += residual[i], axial += residual[i + 1];
  CHECK_NEAR(axial, 0.0, 10 * ROUNDING);
  CHECK_NEAR(radial, 0.0, 10 * ROUNDING);
  for (int j = 0; j < UNKNOWNS; ++j) {
    const double kept = u[j];
    u[j] = kept + STEP, evaluate(u, model, plus, NULL);
    u[j] = kept - (j == 0 ? 0.0 : STEP), evaluate(u, model, less, NULL);
    u[j] = kept;
    /* A node on the axis has a difference to one side only, of the first order. */
    const double step = j == 0 ? STEP : 2 * STEP, allowed = j == 0 ? 100 * STEP : 10 * DIFFERENCES;
    for (int i = 0; i < UNKNOWNS; ++i) CHECK_NEAR(k[i * UNKNOWNS + j], (plus[i] - less[i]) / step, allowed);
  }
}

int main(void) {
  weights w;
  double gap[X];
  stickslip_pair pair = pair_at(start, STICKSLIP_MODEL_PLANE);
  /* The sums of both sides are those of int N_A over the overlap, three quarters of the line: 3/8 each, times the thickness. */
  for (int thick = 0; thick < 2; ++thick) {
    pair.thickness = 0.5 * thick;
    CHECK_OK(stickslip_pair_weights(&pair, w.ab, w.ac, NULL, NULL));
    for (int a = 0; a < NODES; ++a) {
      const double area = 0.375 * (thick ? 0.5 : 1.0);
      CHECK_NEAR(w.ab[2 * a] + w.ab[2 * a + 1], area, ROUNDING);
      CHECK_NEAR(w.ac[2 * a] + w.ac[2 * a + 1], area, ROUNDING);
    }
  }
  pair.thickness = 0.0;
  CHECK_OK(stickslip_pair_weights(&pair, w.ab, w.ac, w.dab, w.dac));
  CHECK_OK(stickslip_pair_gap(&pair, w.ab, w.ac, gap));
  for (int a = 0; a < NODES; ++a) {
    CHECK_NEAR(gap[2 * a], 0.0, ROUNDING);
    CHECK_NEAR(gap[2 * a + 1], 0.0375, ROUNDING); /* 3/8 of the line, 0.1 apart */
  }
  tangent(STICKSLIP_MODEL_PLANE);

  /* A ring from the axis on: int 2 pi r N_A over the overlap, 0.125 to 0.875; the node on the axis has the smaller part. */
  pair.model = STICKSLIP_MODEL_AXISYMMETRIC;
  CHECK_OK(stickslip_pair_weights(&pair, w.ab, w.ac, NULL, NULL));
  const double second = 2 * pi * (0.875 * 0.875 * 0.875 - 0.125 * 0.125 * 0.125) / 3;
  const double whole = pi * (0.875 * 0.875 - 0.125 * 0.125);
  CHECK_NEAR(w.ab[0] + w.ab[1], whole - second, ROUNDING);
  CHECK_NEAR(w.ab[2] + w.ab[3], second, ROUNDING);
  CHECK(whole - second > 0.0 && whole - second < second);
  tangent(STICKSLIP_MODEL_AXISYMMETRIC);

  /* Nothing lies beyond the axis, and nothing is written then. */
  const double beyond[X] = {-0.5, 0.0, 1.0, 0.0};
  FILL(w);
  pair.x1 = beyond;
  CHECK_REFUSED(stickslip_pair_weights(&pair, w.ab, w.ac, w.dab, w.dac), STICKSLIP_INVALID_VALUE, "pair.x1: node 0 has r = -0.5;");
  pair.x1 = start, pair.x2 = beyond;
  CHECK_REFUSED(stickslip_pair_weights(&pair, w.ab, w.ac, w.dab, w.dac), STICKSLIP_INVALID_VALUE, "pair.x2: node 0 has r = -0.5;");
  pair.x2 = start + X, pair.n1 = 4;
  CHECK_REFUSED(stickslip_pair_weights(&pair, w.ab, w.ac, w.dab, w.dac), STICKSLIP_INVALID_SIZE, "2 (line2) or 3 (line3)");
  pair.n1 = NODES, pair.thickness = 1.0;
  CHECK_REFUSED(stickslip_pair_weights(&pair, w.ab, w.ac, w.dab, w.dac), STICKSLIP_INVALID_VALUE, "pair.thickness");
  CHECK_UNTOUCHED(w);
  pair.model = STICKSLIP_MODEL_PLANE, pair.x1 = beyond;
  CHECK_OK(stickslip_pair_weights(&pair, w.ab, w.ac, w.dab, w.dac));
  CHECK_REFUSED(stickslip_pair_begin(&pair, 1000, w.dab, NULL, NULL, NULL), STICKSLIP_UNSUPPORTED, "pair.model");
  return 0;
}
