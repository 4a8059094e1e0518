/* What a pair of quadratic facets costs a caller: stickslip_pair_weights of two tri6, quad8 or quad9, curved and turned against
 * each other, over that of all pairs of the linear facets between the same nodes. Times are of this thread, the least of
 * several passes; the two alternate. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <stickslip.h>

enum { PASSES = 40, CALLS = 50, NODES = 9, PARTS = 5 };

static const double triangle[6][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};
static const double square[NODES][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, 0}};

/* A kind, and the linear facets between its nodes; of a triangle the fourth node is -1. */
typedef struct {
  const char *name;
  int n, parts, part[PARTS][4];
} kind;

static const kind kinds[] = {
    {"tri6", 6, 4, {{0, 3, 5, -1}, {3, 1, 4, -1}, {5, 4, 2, -1}, {3, 4, 5, -1}}},
    {"quad8", 8, 5, {{0, 4, 7, -1}, {4, 1, 5, -1}, {5, 2, 6, -1}, {6, 3, 7, -1}, {4, 5, 6, 7}}},
    {"quad9", 9, 4, {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}}},
};

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

/* A curved facet of so many nodes, seen from above (up) or from below, turned by an angle. */
static void make(int n, int up, double angle, double *x) {
  for (int k = 0; k < n; ++k) {
    const double u = n == 6 ? 2 * triangle[k][0] - 0.7 : square[k][0];
    const double v = (up ? 1 : -1) * (n == 6 ? 2 * triangle[k][1] - 0.7 : square[k][1]);
    x[3 * k] = cos(angle) * u - sin(angle) * v;
    x[3 * k + 1] = sin(angle) * u + cos(angle) * v;
    x[3 * k + 2] = 0.03 * u * u + 0.02 * v - (up ? 0.05 : 0.0);
  }
}

static void weights(int n1, const double *x1, int n2, const double *x2, int derivatives) {
  static double ab[NODES * NODES], ac[NODES * NODES], dab[6 * NODES * NODES * NODES], dac[6 * NODES * NODES * NODES];
  const stickslip_pair pair = {.struct_size = sizeof pair, .n1 = n1, .n2 = n2, .x1 = x1, .x2 = x2};
  if (stickslip_pair_weights(&pair, ab, ac, derivatives ? dab : NULL, derivatives ? dac : NULL)) {
    fprintf(stderr, "%s\n", stickslip_last_error_message());
    exit(1);
  }
}

/* The nodes of a part; gives how many. */
static int part(const kind *of, int k, const double *x, double *to) {
  const int n = of->part[k][3] < 0 ? 3 : 4;
  for (int i = 0; i < 3 * n; ++i) to[i] = x[3 * of->part[k][i / 3] + i % 3];
  return n;
}

static void linear(const kind *of, const double *x1, const double *x2, int derivatives) {
  double y1[12], y2[12];
  for (int i = 0; i < of->parts; ++i) {
    const int n1 = part(of, i, x1, y1);
    for (int j = 0; j < of->parts; ++j) weights(n1, y1, part(of, j, x2, y2), y2, derivatives);
  }
}

int main(void) {
  printf("\n%-26s %14s %14s %8s\n", "a pair, microseconds", "quadratic", "linear parts", "ratio");
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
    double x1[3 * NODES], x2[3 * NODES];
    make(kinds[k].n, 0, 0.0, x1);
    make(kinds[k].n, 1, 0.3, x2);
    for (int derivatives = 0; derivatives < 2; ++derivatives) {
      double least[2] = {1e300, 1e300};
      for (int pass = 0; pass < PASSES; ++pass) {
        const double start = now();
        for (int call = 0; call < CALLS; ++call) weights(kinds[k].n, x1, kinds[k].n, x2, derivatives);
        const double middle = now();
        for (int call = 0; call < CALLS; ++call) linear(&kinds[k], x1, x2, derivatives);
        least[0] = fmin(least[0], (middle - start) / CALLS);
        least[1] = fmin(least[1], (now() - middle) / CALLS);
      }
      printf("%-6s %-19s %14.2f %14.2f %8.2f\n", kinds[k].name, derivatives ? "with derivatives" : "weights", least[0], least[1], least[0] / least[1]);
    }
  }
  return 0;
}
