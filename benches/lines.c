/* What a pair of lines of a plane or axisymmetric model costs a caller: stickslip_pair_weights with derivatives, and
 * stickslip_pair_tangent, of two line2 or two line3 over those of two quad4. Times are of this thread, the least of several
 * passes; the three alternate. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <stickslip.h>

enum { PASSES = 40, CALLS = 500, NODES = 4, KINDS = 3, STAGES = 3 };

static const char *const kinds[KINDS] = {"line2", "line3", "quad4"}, *const stages[STAGES] = {"weights", "with derivatives", "tangent"};
/* Non-mortar and mortar side; the quad4 are those of the lines, one across. */
static const double line1[6] = {1, 0, 2, 0.1, 1.5, 0}, line2[6] = {2.3, -0.02, 1.3, 0.01, 1.8, 0};
static const double quad1[12] = {1, 0, 0, 2, 0, 0.1, 2, 1, 0.1, 1, 1, 0}, quad2[12] = {2.3, 0.3, -0.02, 1.3, 0.1, 0.01, 1.4, 1.2, 0.03, 2.4, 1.1, 0};

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

static void must(int32_t status) {
  if (status == STICKSLIP_OK) return;
  fprintf(stderr, "%s\n", stickslip_last_error_message());
  exit(1);
}

static void call(int kind, int stage, const stickslip_node_response *responses) {
  static double ab[16], ac[16], dab[16 * 24], dac[16 * 24], k[36 * 36];
  const int n = kind == 0 ? 2 : kind == 1 ? 3 : 4, is_quad = kind == 2;
  const double traction[12] = {0.1, -1, 0.1, -1, 0.1, -1, 0.1, -1, 0.1, -1, 0.1, -1};
  const stickslip_pair pair = {.struct_size = sizeof pair, .n1 = n, .n2 = n, .x1 = is_quad ? quad1 : line1,
      .x2 = is_quad ? quad2 : line2, .multiplier_space = STICKSLIP_SPACE_SUB,
      .model = is_quad ? STICKSLIP_MODEL_SOLID : STICKSLIP_MODEL_AXISYMMETRIC};
  if (stage < 2) {
    must(stickslip_pair_weights(&pair, ab, ac, stage ? dab : NULL, stage ? dac : NULL));
  } else { /* with the weights of the stage before */
    must(stickslip_pair_tangent(&pair, ab, ac, dab, dac, ab, ac, traction, responses, NULL, k, (is_quad ? 9 : 6) * n));
  }
}

int main(void) {
  stickslip_node_response responses[NODES];
  for (int a = 0; a < NODES; ++a) {
    const stickslip_node node = {.struct_size = sizeof node, .augmentation = 1, .mu = 0.3, .coverage = 1, .coverage_previous = 1,
        .lambda = {0.1, -1, 0}, .normal = {0, 1, 0}};
    responses[a] = (stickslip_node_response){.struct_size = sizeof responses[a]};
    must(stickslip_node_respond(&node, &responses[a]));
  }
  double least[STAGES][KINDS];
  for (int s = 0; s < STAGES; ++s) {
    for (int k = 0; k < KINDS; ++k) least[s][k] = 1e300;
  }
  for (int pass = 0; pass < PASSES; ++pass) {
    for (int k = 0; k < KINDS; ++k) {
      for (int s = 0; s < STAGES; ++s) {
        const double start = now();
        for (int c = 0; c < CALLS; ++c) call(k, s, responses);
        least[s][k] = fmin(least[s][k], (now() - start) / CALLS);
      }
    }
  }
  printf("\n%-20s %10s %10s %10s %14s %14s\n", "a pair, microseconds", kinds[0], kinds[1], kinds[2], "line2 / quad4", "line3 / quad4");
  for (int s = 0; s < STAGES; ++s) {
    const double *of = least[s];
    printf("%-20s %10.3f %10.3f %10.3f %14.3f %14.3f\n", stages[s], of[0], of[1], of[2], of[0] / of[2], of[1] / of[2]);
  }
  return 0;
}
