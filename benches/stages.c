/* What the stages of one pair cost a caller of the C ABI, over the plain C++ weights of the same pairs (baseline.cpp): weights,
 * weights with all derivatives, and residual and tangent by all stages, with the stateless calls and with a pair state.
 *
 * A few hundred different pairs, each with what a host passes. Times are of this thread, the least of several passes; passes
 * of all ways alternate within this program, for times drift with the machine. The tangents of both ways are compared, too. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <stickslip.h>

void   baseline_pairs(int n, double *coordinates);
double baseline_pass(int n, const double *coordinates);

/* The pairs fit into the second cache with what belongs to them. A pass takes about a millisecond. */
enum { PAIRS = 400, PASSES = 201, STATE = 512 };

#define CHECK(call)                                                       \
  do {                                                                    \
    if (call) {                                                           \
      fprintf(stderr, "%s: %s\n", #call, stickslip_last_error_message()); \
      exit(1);                                                            \
    }                                                                     \
  } while (0)

static double coordinates[24 * PAIRS], normals[3 * PAIRS];
static double ab[16], ac[16], dab[16 * 24], dac[16 * 24], force[24], tangents[2][36 * 36], row[3], block[9], state[STATE];
static volatile double sink;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static stickslip_pair pair_of(int p) {
  const stickslip_pair pair = {.struct_size = sizeof pair, .n1 = 4, .n2 = 4, .x1 = coordinates + 24 * p,
      .x2 = coordinates + 24 * p + 12};
  return pair;
}

/* A node of a pair with these gaps: closed, with friction and some tangential traction. */
static stickslip_node node_of(int p, const double gap[3]) {
  stickslip_node node = {.struct_size = sizeof node, .lambda = {0.1, 0.2, -1.0}, .augmentation = 3.0, .mu = 0.3,
      .coverage = 1.0, .coverage_previous = 1.0, .coverage_min = 1e-8};
  for (int i = 0; i < 3; ++i) {
    node.normal[i] = -normals[3 * p + i];
    node.gap_now[i] = gap[i];
    node.gap_previous[i] = 1.01 * gap[i];
  }
  return node;
}

static void weights(void) {
  for (int p = 0; p < PAIRS; ++p) {
    const stickslip_pair pair = pair_of(p);
    CHECK(stickslip_pair_weights(&pair, ab, ac, NULL, NULL));
    sink = ab[1];
  }
}

static void derivatives(void) {
  for (int p = 0; p < PAIRS; ++p) {
    const stickslip_pair pair = pair_of(p);
    CHECK(stickslip_pair_weights(&pair, ab, ac, dab, dac));
    sink = dab[1];
  }
}

static void one_by_one(int p, double *k) {
  const stickslip_pair pair = pair_of(p);
  double gap[12], traction[12];
  stickslip_node_response responses[4];
  CHECK(stickslip_pair_weights(&pair, ab, ac, dab, dac));
  CHECK(stickslip_pair_gap(&pair, ab, ac, gap));
  for (int a = 0; a < 4; ++a) {
    const stickslip_node node = node_of(p, gap + 3 * a);
    responses[a].struct_size = sizeof responses[a];
    CHECK(stickslip_node_respond(&node, &responses[a]));
    memcpy(traction + 3 * a, node.lambda, sizeof node.lambda);
  }
  CHECK(stickslip_pair_residual(&pair, ab, ac, traction, force));
  CHECK(stickslip_pair_tangent(&pair, ab, ac, dab, dac, ab, ac, traction, responses, NULL, k, 36));
  for (int a = 0; a < 4; ++a) CHECK(stickslip_node_block(&responses[a], 1.0, STICKSLIP_LAYOUT_ROW_MAJOR, row, block));
}

static void stateless(void) {
  for (int p = 0; p < PAIRS; ++p) {
    one_by_one(p, tangents[0]);
    sink = tangents[0][0];
  }
}

static void by_state(int p, double *k) {
  const stickslip_pair pair = pair_of(p);
  double gap[12], traction[12];
  stickslip_node_response responses[4];
  CHECK(stickslip_pair_begin(&pair, STATE, state, ab, ac, gap));
  for (int a = 0; a < 4; ++a) {
    const stickslip_node node = node_of(p, gap + 3 * a);
    responses[a].struct_size = sizeof responses[a];
    CHECK(stickslip_node_respond(&node, &responses[a]));
    memcpy(traction + 3 * a, node.lambda, sizeof node.lambda);
  }
  CHECK(stickslip_pair_state_residual(state, traction, force));
  CHECK(stickslip_pair_state_tangent(state, ab, ac, traction, responses, NULL, k, 36));
  for (int a = 0; a < 4; ++a) CHECK(stickslip_node_block(&responses[a], 1.0, STICKSLIP_LAYOUT_ROW_MAJOR, row, block));
}

static void with_state(void) {
  for (int p = 0; p < PAIRS; ++p) {
    by_state(p, tangents[1]);
    sink = tangents[1][0];
  }
}

static void baseline(void) { sink = baseline_pass(PAIRS, coordinates); }

int main(void) {
  static const struct {
    const char *name;
    void (*pass)(void);
  } ways[] = {
      {"baseline: weights in C++", baseline},
      {"pair_weights", weights},
      {"pair_weights with all derivatives", derivatives},
      {"residual and tangent, stateless calls", stateless},
      {"residual and tangent, pair state", with_state},
  };
  enum { WAYS = sizeof ways / sizeof *ways };
  double least[WAYS];
  baseline_pairs(PAIRS, coordinates);
  for (int p = 0; p < PAIRS; ++p) CHECK(stickslip_facet_normal(4, coordinates + 24 * p, normals + 3 * p));
  for (int w = 0; w < WAYS; ++w) least[w] = HUGE_VAL;
  for (int pass = 0; pass < PASSES; ++pass) {
    for (int w = 0; w < WAYS; ++w) {
      const double start = now();
      ways[w].pass();
      least[w] = fmin(least[w], now() - start);
    }
  }
  printf("%-40s %10s %8s\n", "", "ns a pair", "ratio");
  for (int w = 0; w < WAYS; ++w) printf("%-40s %10.0f %8.3f\n", ways[w].name, least[w] / PAIRS, least[w] / least[0]);
  double difference = 0.0;
  for (int p = 0; p < PAIRS; ++p) {
    double largest = 0.0, apart = 0.0;
    one_by_one(p, tangents[0]);
    by_state(p, tangents[1]);
    for (int k = 0; k < 36 * 36; ++k) {
      largest = fmax(largest, fabs(tangents[0][k]));
      apart = fmax(apart, fabs(tangents[0][k] - tangents[1][k]));
    }
    difference = fmax(difference, apart / largest);
  }
  printf("tangents of both ways: %.1e of the largest entry apart\n", difference);
  return 0;
}
