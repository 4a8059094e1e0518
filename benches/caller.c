/* What dual multipliers and normals of now cost a caller: residual and tangent of an interface against standard multipliers
 * and normals of t_n in the same run. Bases by the handle and by the stages, over the distinct entries that the tangent has.
 *
 * 16 x 16 facets over 19 x 19, which move between evaluations, with friction. Times are of this thread, the least of
 * several passes; passes of both bases alternate. Memory that a call has given back stays with the program: by default
 * the sizes of all calls so far decide whether the system takes it, and to fault it in again can cost as much as a tangent. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <stickslip.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

enum { ONE = 16, TWO = 19, N1 = (ONE + 1) * (ONE + 1), N2 = (TWO + 1) * (TWO + 1), F1 = ONE * ONE, F2 = TWO * TWO };
enum { X1 = 3 * N1, X2 = 3 * N2, PASSES = 15, MOST = 4000000, OVER = 9, ROWS = 24 + 12 * OVER };

#define CHECK(call)                                                          \
  do {                                                                       \
    if (call) {                                                              \
      fprintf(stderr, "%s: %s\n", #call, stickslip_last_error_message());    \
      exit(1);                                                               \
    }                                                                        \
  } while (0)

static double x1[X1], x2[X2], reference1[X1], reference2[X2], lambda[X1], force1[X1], force2[X2], rows[X1];
static int64_t offsets1[F1 + 1], nodes1[4 * F1], offsets2[F2 + 1], nodes2[4 * F2];
static int64_t equations1[X1], equations2[X2], multipliers[X1];
static int64_t entry_rows[MOST], entry_columns[MOST], keys[MOST];
static double values[MOST];

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void grid(int n, double from, double to, int up, double *x, int64_t *offsets, int64_t *nodes) {
  for (int k = 0; k < (n + 1) * (n + 1); ++k) {
    const double s = from + (to - from) * (k % (n + 1)) / n, t = from + (to - from) * (k / (n + 1)) / n;
    x[3 * k] = s, x[3 * k + 1] = t, x[3 * k + 2] = 0.02 * sin(3 * s) * cos(2 * t) - (up ? 0.0 : 1e-3);
  }
  for (int f = 0; f <= n * n; ++f) offsets[f] = 4 * f;
  for (int f = 0; f < n * n; ++f) {
    const int64_t a = f / n * (n + 1) + f % n, quad[4] = {a, a + 1, a + n + 2, a + n + 1};
    for (int k = 0; k < 4; ++k) nodes[4 * f + k] = quad[up ? k : 3 - k];
  }
}

static void move(int pass) {
  for (int k = 0; k < X1; ++k) x1[k] = reference1[k] + (k % 3 == 0 ? 1e-3 + 1e-4 * pass : 0.0);
}

static int ascending(const void *a, const void *b) {
  const int64_t p = *(const int64_t *)a, q = *(const int64_t *)b;
  return (p > q) - (p < q);
}

static stickslip_interface *create(int32_t basis, int32_t normals) {
  const stickslip_surface one = {.struct_size = sizeof one, .n_nodes = N1, .n_facets = F1, .coordinates = reference1,
      .facet_offsets = offsets1, .facet_nodes = nodes1, .equations = equations1, .multiplier_equations = multipliers};
  const stickslip_surface two = {.struct_size = sizeof two, .n_nodes = N2, .n_facets = F2, .coordinates = reference2,
      .facet_offsets = offsets2, .facet_nodes = nodes2, .equations = equations2};
  stickslip_options options;
  stickslip_interface *interface = NULL;
  CHECK(stickslip_options_init(&options, sizeof options));
  options.multiplier_basis = basis;
  options.normals = normals;
  options.modulus = 1000.0;
  options.mu = 0.3;
  CHECK(stickslip_interface_create(&one, &two, &options, &interface));
  return interface;
}

/* Residual and tangent at new positions [ns]; `distinct`: entries. */
static double by_handle(stickslip_interface *interface, int pass, int64_t *distinct) {
  int64_t count;
  move(pass);
  const double start = now();
  CHECK(stickslip_interface_residual(interface, x1, x2, lambda, NULL, force1, force2, rows));
  CHECK(stickslip_interface_tangent_coo(interface, x1, x2, lambda, NULL, MOST, entry_rows, entry_columns, values, &count));
  const double spent = now() - start;
  if (*distinct) return spent;
  for (int64_t k = 0; k < count; ++k) keys[k] = entry_rows[k] * (2 * X1 + X2) + entry_columns[k];
  qsort(keys, (size_t)count, sizeof *keys, ascending);
  for (int64_t k = 0; k < count; ++k) *distinct += k == 0 || keys[k] != keys[k - 1];
  return spent;
}

/* Facets of a facet, by the reference: all that may overlap with it. */
static int over(int f, int64_t found[OVER]) {
  int n = 0;
  const double h = 0.5 / ONE + 0.55 * 1.2 / TWO, *a = reference1 + 3 * nodes1[4 * f], *b = reference1 + 3 * nodes1[4 * f + 2];
  for (int g = 0; g < F2 && n < OVER; ++g) {
    const double *c = reference2 + 3 * nodes2[4 * g], *d = reference2 + 3 * nodes2[4 * g + 2];
    if (fabs(a[0] + b[0] - c[0] - d[0]) < 2 * h && fabs(a[1] + b[1] - c[1] - d[1]) < 2 * h) found[n++] = g;
  }
  return n;
}

/* The same by the stages, with the weights of now for those of t_n and the node's part left aside. */
static double by_stages(int dual, int pass) {
  static double dn_ab[4 * 4 * 24], dn_ac[4 * 4 * 24], tangent[ROWS * ROWS];
  stickslip_node_response responses[4];
  memset(responses, 0, sizeof responses);
  double traction[12] = {0}, start, spent = 0.0;
  for (int k = 0; k < 4; ++k) {
    responses[k].struct_size = sizeof responses[k];
    for (int i = 0; i < 9; ++i) responses[k].drow_dnow[i] = responses[k].drow_dprevious[i] = i % 4 == 0 ? 1.0 : 0.1;
    traction[3 * k + 2] = -1.0;
  }
  move(pass);
  for (int f = 0; f < F1; ++f) {
    int64_t found[OVER];
    const int n = over(f, found);
    double own[12], other[OVER][12], ab[OVER][16], ac[OVER][16], mass[16] = {0}, dual_ab[OVER][16], dual_ac[OVER][16];
    double gap[12], force[24];
    const int32_t corners[OVER] = {4, 4, 4, 4, 4, 4, 4, 4, 4};
    for (int k = 0; k < 4; ++k) memcpy(own + 3 * k, x1 + 3 * nodes1[4 * f + k], 3 * sizeof(double));
    for (int q = 0; q < n; ++q)
      for (int k = 0; k < 4; ++k) memcpy(other[q] + 3 * k, x2 + 3 * nodes2[4 * found[q] + k], 3 * sizeof(double));
    start = now();
    for (int q = 0; q < n; ++q) {
      const stickslip_pair pair = {.struct_size = sizeof pair, .n1 = 4, .n2 = 4, .x1 = own, .x2 = other[q]};
      CHECK(stickslip_pair_weights(&pair, ab[q], ac[q], dual ? NULL : dn_ab, dual ? NULL : dn_ac));
      for (int k = 0; k < 16; ++k) mass[k] += ab[q][k];
      if (dual) continue;
      CHECK(stickslip_pair_gap(&pair, ab[q], ac[q], gap));
      CHECK(stickslip_pair_residual(&pair, ab[q], ac[q], traction, force));
      CHECK(stickslip_pair_tangent(&pair, ab[q], ac[q], dn_ab, dn_ac, ab[q], ac[q], traction, responses, NULL, tangent, 36));
    }
    for (int q = 0; q < n && dual; ++q) {
      const stickslip_pair pair = {.struct_size = sizeof pair, .n1 = 4, .n2 = 4, .x1 = own, .x2 = other[q]};
      CHECK(stickslip_pair_dual(&pair, mass, ab[q], ac[q], dual_ab[q], dual_ac[q]));
      CHECK(stickslip_pair_gap(&pair, dual_ab[q], dual_ac[q], gap));
      CHECK(stickslip_pair_residual(&pair, dual_ab[q], dual_ac[q], traction, force));
    }
    if (dual) {
      const stickslip_facet facet = {.struct_size = sizeof facet, .n1 = 4, .n_pairs = n, .x1 = own, .n2 = corners, .x2 = other[0]};
      CHECK(stickslip_facet_tangent(&facet, ab[0], ac[0], dual_ab[0], dual_ac[0], traction, responses, NULL, tangent, 24 + 12 * n));
    }
    spent += now() - start;
  }
  return spent;
}

int main(void) {
  double least[3][2] = {{1e300, 1e300}, {1e300, 1e300}, {1e300, 1e300}};
  int64_t distinct[2] = {0, 0}, turning[2] = {0, 0};
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20); /* the largest that is allowed */
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
  grid(ONE, 0.0, 1.0, 0, reference1, offsets1, nodes1);
  grid(TWO, -0.1, 1.1, 1, reference2, offsets2, nodes2);
  memcpy(x2, reference2, sizeof x2);
  for (int k = 0; k < X1; ++k) equations1[k] = k, multipliers[k] = X1 + X2 + k, lambda[k] = k % 3 == 2 ? -1.0 : 0.1;
  for (int k = 0; k < X2; ++k) equations2[k] = X1 + k;
  stickslip_interface *interfaces[2][2];
  for (int dual = 0; dual < 2; ++dual) {
    interfaces[dual][0] = create(dual ? STICKSLIP_BASIS_DUAL : STICKSLIP_BASIS_STANDARD, STICKSLIP_NORMALS_COMMITTED);
    interfaces[dual][1] = create(dual ? STICKSLIP_BASIS_DUAL : STICKSLIP_BASIS_STANDARD, STICKSLIP_NORMALS_CURRENT);
  }
  for (int pass = 0; pass < PASSES; ++pass) {
    for (int dual = 0; dual < 2; ++dual) {
      least[0][dual] = fmin(least[0][dual], by_handle(interfaces[dual][0], pass, &distinct[dual]));
      least[1][dual] = fmin(least[1][dual], by_stages(dual, pass));
      least[2][dual] = fmin(least[2][dual], by_handle(interfaces[dual][1], pass, &turning[dual]));
    }
  }
  printf("%-42s %10s %10s %8s\n", "residual and tangent", "standard", "dual", "ratio");
  printf("%-42s %10lld %10lld %8.3f\n", "distinct entries", (long long)distinct[0], (long long)distinct[1],
         (double)distinct[1] / (double)distinct[0]);
  for (int how = 0; how < 2; ++how) {
    double a[2];
    for (int dual = 0; dual < 2; ++dual) a[dual] = least[how][dual] / (double)distinct[dual];
    printf("%-42s %10.0f %10.0f %8.3f\n", how ? "stages: ns a facet" : "handle: ns a facet", least[how][0] / F1, least[how][1] / F1,
           least[how][1] / least[how][0]);
    printf("%-42s %10.3f %10.3f %8.3f\n", how ? "stages: ns a distinct entry" : "handle: ns a distinct entry", a[0], a[1],
           a[1] / a[0]);
  }
  printf("%-42s %10s %10s %8s\n", "handle: ns a facet", "normals", "normals", "");
  printf("%-42s %10s %10s %8s\n", "", "of t_n", "of now", "ratio");
  for (int dual = 0; dual < 2; ++dual) {
    printf("%-42s %10.0f %10.0f %8.3f\n", dual ? "dual multipliers" : "standard multipliers", least[0][dual] / F1,
           least[2][dual] / F1, least[2][dual] / least[0][dual]);
    printf("%-42s %10lld %10lld %8.3f\n", "  distinct entries", (long long)distinct[dual], (long long)turning[dual],
           (double)turning[dual] / (double)distinct[dual]);
    for (int k = 0; k < 2; ++k) CHECK(stickslip_interface_destroy(&interfaces[dual][k]));
  }
  return 0;
}
