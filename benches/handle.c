/* What an interface costs a caller, over the C++ baseline's weights of a pair in the same run: residual, values of the
 * tangent by a plan of active pairs and by one with a skin, commit, making plans, memory. Warped N x N facets under a
 * 1.13 N x 1.13 N mortar side, Coulomb friction, both sides move. Standard and dual multipliers, normals of t_n and of now.
 *
 *   handle [N ...]       sizes; by default 50 100 200 500
 *   handle -o N          standard multipliers and active pairs alone, two passes: for sizes that fill the memory
 *   handle -o -d N       the same of dual multipliers
 *   handle -t 2 [N ...]  with two threads, in time on the wall; beside it `-t 1`
 *
 * Else times are of this thread, the least of several passes; passes of the baseline alternate with them. Without the
 * baseline (it is no part of this project) times are in microseconds a pair. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <stickslip.h>

#ifdef BASELINE
void baseline_pairs(int n, double *coordinates);
double baseline_pass(int n, const double *coordinates);
#endif

enum { BASELINE_PAIRS = 2000 };
enum { RESIDUAL, ACTIVE, SKIN, COMMIT, PLAN_ACTIVE, PLAN_SKIN, ROWS };
static const char *const names[ROWS] = {"residual", "values, active pairs", "values, with a skin",
    "commit", "plan, active pairs", "plan, with a skin"};

#define CHECK(call)                                                       \
  do {                                                                    \
    if (call) {                                                           \
      fprintf(stderr, "%s: %s\n", #call, stickslip_last_error_message()); \
      exit(1);                                                            \
    }                                                                     \
  } while (0)

typedef struct {
  int64_t n, n1, n2, f1, f2;
  double *x1, *x2, *reference1, *reference2, *lambda, *force1, *force2, *rows, *values;
  int64_t *offsets1, *nodes1, *offsets2, *nodes2, *equations1, *equations2, *multipliers;
} scene;

static int threads = 0;

static double now(void) {
  struct timespec t;
  clock_gettime(threads ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

static void *room(int64_t n, size_t size) {
  void *p = calloc((size_t)n, size);
  if (!p) {
    fprintf(stderr, "no memory for %lld values\n", (long long)n);
    exit(1);
  }
  return p;
}

/* Facets n x n over a square, warped, seen from below or from above. */
static void grid(int64_t n, double from, double to, int up, double *x, int64_t *offsets, int64_t *nodes) {
  for (int64_t k = 0; k < (n + 1) * (n + 1); ++k) {
    const double h = (to - from) / (double)n, s = from + h * (double)(k % (n + 1)), t = from + h * (double)(k / (n + 1));
    const double noise = 0.05 * h * sin(12.9898 * (double)k + (up ? 1.0 : 0.0));
    x[3 * k] = s + noise, x[3 * k + 1] = t - noise, x[3 * k + 2] = 0.02 * sin(3 * s) * cos(2 * t) + 0.2 * noise - (up ? 0.0 : 1e-3 * h);
  }
  for (int64_t f = 0; f <= n * n; ++f) offsets[f] = 4 * f;
  for (int64_t f = 0; f < n * n; ++f) {
    const int64_t a = f / n * (n + 1) + f % n, quad[4] = {a, a + 1, a + n + 2, a + n + 1};
    for (int k = 0; k < 4; ++k) nodes[4 * f + k] = quad[up ? k : 3 - k];
  }
}

static scene make(int64_t n) {
  const int64_t m = (113 * n) / 100;
  scene s = {.n = n, .n1 = (n + 1) * (n + 1), .n2 = (m + 1) * (m + 1), .f1 = n * n, .f2 = m * m};
  s.x1 = room(3 * s.n1, 8), s.reference1 = room(3 * s.n1, 8), s.lambda = room(3 * s.n1, 8), s.force1 = room(3 * s.n1, 8);
  s.x2 = room(3 * s.n2, 8), s.reference2 = room(3 * s.n2, 8), s.force2 = room(3 * s.n2, 8), s.rows = room(3 * s.n1, 8);
  s.offsets1 = room(s.f1 + 1, 8), s.nodes1 = room(4 * s.f1, 8), s.offsets2 = room(s.f2 + 1, 8), s.nodes2 = room(4 * s.f2, 8);
  s.equations1 = room(3 * s.n1, 8), s.equations2 = room(3 * s.n2, 8), s.multipliers = room(3 * s.n1, 8);
  grid(n, 0.0, 1.0, 0, s.reference1, s.offsets1, s.nodes1);
  grid(m, -0.001, 1.001, 1, s.reference2, s.offsets2, s.nodes2);
  for (int64_t k = 0; k < 3 * s.n1; ++k) {
    s.equations1[k] = k, s.multipliers[k] = 3 * (s.n1 + s.n2) + k, s.lambda[k] = k % 3 == 2 ? -1.0 : 0.1;
  }
  for (int64_t k = 0; k < 3 * s.n2; ++k) s.equations2[k] = 3 * s.n1 + k;
  memcpy(s.x2, s.reference2, 3 * (size_t)s.n2 * sizeof(double));
  return s;
}

static void drop(scene *s) {
  void *all[] = {s->x1, s->x2, s->reference1, s->reference2, s->lambda, s->force1, s->force2, s->rows, s->values, s->offsets1,
      s->nodes1, s->offsets2, s->nodes2, s->equations1, s->equations2, s->multipliers};
  for (size_t k = 0; k < sizeof all / sizeof *all; ++k) free(all[k]);
}

static void move(scene *s, int pass) {
  const double h = 1.0 / (double)s->n;
  for (int64_t k = 0; k < 3 * s->n1; ++k) {
    s->x1[k] = s->reference1[k] + (k % 3 == 0 ? 0.01 * h * (1 + 0.01 * pass) : k % 3 == 2 ? 1e-3 * h * sin((double)k) : 0.0);
  }
}

static stickslip_interface *create(const scene *s, int32_t basis, int32_t normals) {
  const stickslip_surface one = {.struct_size = sizeof one, .n_nodes = s->n1, .n_facets = s->f1, .coordinates = s->reference1,
      .facet_offsets = s->offsets1, .facet_nodes = s->nodes1, .equations = s->equations1, .multiplier_equations = s->multipliers};
  const stickslip_surface two = {.struct_size = sizeof two, .n_nodes = s->n2, .n_facets = s->f2, .coordinates = s->reference2,
      .facet_offsets = s->offsets2, .facet_nodes = s->nodes2, .equations = s->equations2};
  stickslip_options options;
  stickslip_method method = {.struct_size = sizeof method, .multiplier_basis = basis, .normals = normals, .threads = threads};
  stickslip_interface *interface = NULL;
  CHECK(stickslip_options_init(&options, sizeof options));
  options.method = &method;
  options.modulus = 1000.0, options.mu = 0.3;
  CHECK(stickslip_interface_create(&one, &two, &options, &interface));
  return interface;
}

static stickslip_counters counters(stickslip_interface *interface) {
  stickslip_counters c = {.struct_size = sizeof c};
  CHECK(stickslip_interface_counters(interface, &c));
  return c;
}

static void least(double *of, double start) { *of = fmin(*of, now() - start); }

typedef struct {
  double time[ROWS], pairs, entries[2], bytes, plan_bytes[2];
} costs;

static double baseline = 1e300;

static void time_baseline(void) {
#ifdef BASELINE
  static double pairs[24 * BASELINE_PAIRS];
  static double sink;
  if (pairs[0] == 0.0) baseline_pairs(BASELINE_PAIRS, pairs);
  const double start = now();
  sink += baseline_pass(BASELINE_PAIRS, pairs);
  baseline = fmin(baseline, (now() - start) / BASELINE_PAIRS);
#else
  baseline = 1.0;
#endif
}

/* All rows of one interface. */
static costs measure(scene *s, int32_t basis, int32_t normals, int passes, int plans) {
  costs c = {.pairs = 0};
  for (int k = 0; k < ROWS; ++k) c.time[k] = 1e300;
  stickslip_interface *interface = create(s, basis, normals);
  int64_t rows, count[2];
  static const int32_t kinds[2] = {STICKSLIP_PLAN_ACTIVE, STICKSLIP_PLAN_SKIN};
  for (int pass = 0; pass < passes; ++pass) {
    for (int k = 0; k < 3; ++k) time_baseline();
    move(s, pass);
    double start = now();
    CHECK(stickslip_interface_residual(interface, s->x1, s->x2, s->lambda, NULL, s->force1, s->force2, s->rows));
    least(&c.time[RESIDUAL], start);
    if (pass == 0) c.bytes = (double)counters(interface).bytes / (double)s->f1;
    for (int kind = 0; kind < plans; ++kind) {
      free(s->values);
      s->values = NULL;
      start = now();
      CHECK(stickslip_interface_plan(interface, s->x1, s->x2, kinds[kind], &rows, &count[kind]));
      least(&c.time[PLAN_ACTIVE + kind], start);
      if (pass == 0) c.plan_bytes[kind] = (double)counters(interface).bytes / (double)s->f1 - c.bytes;
      s->values = room(count[kind], sizeof(double));
      CHECK(stickslip_interface_plan_values(interface, s->x1, s->x2, s->lambda, NULL, count[kind], s->values));
      for (int again = 0; again < 2; ++again) {
        start = now();
        CHECK(stickslip_interface_plan_values(interface, s->x1, s->x2, s->lambda, NULL, count[kind], s->values));
        least(&c.time[ACTIVE + kind], start);
      }
      c.entries[kind] = (double)count[kind] / (double)s->f1;
    }
    c.pairs = (double)counters(interface).pairs_active;
  }
  /* The first three commits take memory that later ones use again. */
  for (int pass = 0; pass < passes + 3; ++pass) {
    move(s, passes + pass);
    CHECK(stickslip_interface_residual(interface, s->x1, s->x2, s->lambda, NULL, s->force1, s->force2, s->rows));
    const double start = now();
    CHECK(stickslip_interface_commit(interface, s->x1, s->x2, s->lambda, NULL));
    least(&c.time[COMMIT], start);
  }
  CHECK(stickslip_interface_destroy(&interface));
  return c;
}

int main(int argc, char **argv) {
  int64_t sizes[16] = {50, 100, 200, 500};
  int n_sizes = 4, only = 0, first = 0;
  if (argc > 1) {
    n_sizes = 0;
    for (int k = 1; k < argc && n_sizes < 16; ++k) {
      if (strcmp(argv[k], "-o") == 0) only = 1;
      else if (strcmp(argv[k], "-d") == 0) first = 1;
      else if (strcmp(argv[k], "-t") == 0 && k + 1 < argc) threads = atoi(argv[++k]);
      else sizes[n_sizes++] = atoll(argv[k]);
    }
    if (!n_sizes) n_sizes = 4;
  }
  static const struct {
    const char *name;
    int32_t basis, normals;
  } kinds[] = {{"standard", STICKSLIP_BASIS_STANDARD, STICKSLIP_NORMALS_COMMITTED}, {"dual", STICKSLIP_BASIS_DUAL, STICKSLIP_NORMALS_COMMITTED},
      {"standard, normals of now", STICKSLIP_BASIS_STANDARD, STICKSLIP_NORMALS_CURRENT}, {"dual, normals of now", STICKSLIP_BASIS_DUAL, STICKSLIP_NORMALS_CURRENT}};
  enum { KINDS = sizeof kinds / sizeof *kinds };
  for (int k = 0; k < n_sizes; ++k) {
    scene s = make(sizes[k]);
    const int passes = only ? 2 : sizes[k] > 250 ? 3 : sizes[k] > 60 ? 8 : 20, used = only ? 1 : KINDS - first;
    costs c[KINDS];
    for (int kind = 0; kind < used; ++kind) c[kind] = measure(&s, kinds[first + kind].basis, kinds[first + kind].normals, passes, only ? 1 : 2);
#ifdef BASELINE
    printf("\n%lld x %lld facets, a pair's times over the baseline's (%.2f us)\n%-28s", (long long)s.n, (long long)s.n, baseline, "");
#else
    printf("\n%lld x %lld facets, microseconds a pair\n%-28s", (long long)s.n, (long long)s.n, "");
#endif
    for (int kind = 0; kind < used; ++kind) printf(" %24s", kinds[first + kind].name);
    for (int row = 0; row < ROWS; ++row) {
      if (only && (row == SKIN || row == PLAN_SKIN)) continue;
      printf("\n%-28s", names[row]);
      for (int kind = 0; kind < used; ++kind) printf(" %24.3f", c[kind].time[row] / c[kind].pairs / baseline);
    }
    printf("\n%-28s", "ns an entry, active pairs");
    for (int kind = 0; kind < used; ++kind) printf(" %24.3f", 1e3 * c[kind].time[ACTIVE] / c[kind].entries[0] / (double)s.f1);
    printf("\n%-28s", "entries a facet, active");
    for (int kind = 0; kind < used; ++kind) printf(" %24.1f", c[kind].entries[0]);
    printf("\n%-28s", "entries a facet, skin");
    for (int kind = 0; kind < used; ++kind) printf(" %24.1f", c[kind].entries[1]);
    printf("\n%-28s", "bytes a facet");
    for (int kind = 0; kind < used; ++kind) printf(" %24.0f", c[kind].bytes);
    printf("\n%-28s", "plan, bytes, active");
    for (int kind = 0; kind < used; ++kind) printf(" %24.0f", c[kind].plan_bytes[0]);
    printf("\n%-28s", "plan, bytes, skin");
    for (int kind = 0; kind < used; ++kind) printf(" %24.0f", c[kind].plan_bytes[1]);
    printf("\n%-28s", "pairs a facet");
    for (int kind = 0; kind < used; ++kind) printf(" %24.2f", c[kind].pairs / (double)s.f1);
    printf("\n");
    drop(&s);
  }
  return 0;
}
