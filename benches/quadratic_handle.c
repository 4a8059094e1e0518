/* What quadratic facets cost a caller of a handle: residual, values of the tangent by a plan, commit, and the plan, of N x N tri6, quad8
 * or quad9 under 1.13 N x 1.13 N of the same kind, over those of the linear facets between the same nodes. Standard multipliers
 * at the corners and at all nodes, dual ones at the corners; linear facets have them at all nodes. Times are of this thread, the
 * least of several passes; all interfaces of a kind alternate.
 *
 *   quadratic_handle [N ...]   sizes; by default 40 */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <stickslip.h>

enum { PASSES = 6, FACET = 9, PARTS = 5, WAYS = 4, ROWS = 4 };
static const char *const names[ROWS] = {"residual", "values, active pairs", "commit", "plan"};

#define CHECK(call)                                                       \
  do {                                                                    \
    if (call) {                                                           \
      fprintf(stderr, "%s: %s\n", #call, stickslip_last_error_message()); \
      exit(1);                                                            \
    }                                                                     \
  } while (0)

/* A kind: facets a cell of the grid, their nodes on the cell's 3 x 3 points, and the linear facets between its nodes. */
typedef struct {
  const char *name;
  int n, facets, corners, at[2][FACET], parts, part[PARTS][4];
} kind;

static const kind kinds[] = {
    {"tri6", 6, 2, 3, {{0, 2, 8, 1, 5, 4}, {0, 8, 6, 4, 7, 3}}, 4, {{0, 3, 5, -1}, {3, 1, 4, -1}, {5, 4, 2, -1}, {3, 4, 5, -1}}},
    {"quad8", 8, 1, 4, {{0, 2, 8, 6, 1, 5, 7, 3}}, 5, {{0, 4, 7, -1}, {4, 1, 5, -1}, {5, 2, 6, -1}, {6, 3, 7, -1}, {4, 5, 6, 7}}},
    {"quad9", 9, 1, 4, {{0, 2, 8, 6, 1, 5, 7, 3, 4}}, 4, {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}}},
};

typedef struct {
  int64_t nodes, facets, *offsets, *list;
  double *x;
  char *corner; /* per node */
} side;

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
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

static void push(side *s, int n, const int64_t *nodes, int up) {
  const int corners = n == 3 || n == 6 ? 3 : 4;
  int64_t *to = s->list + s->offsets[s->facets];
  for (int k = 0; k < n; ++k) { /* from below: corners backwards, and mid nodes between them */
    int of = k;
    if (!up) of = k < corners ? corners - 1 - k : k < 2 * corners ? corners + (2 * corners - 2 - (k - corners)) % corners : k;
    to[k] = nodes[of];
  }
  s->offsets[s->facets + 1] = s->offsets[s->facets] + n;
  s->facets++;
}

/* n x n cells over a square, curved; as the kind's facets or as their linear parts. */
static side grid(const kind *of, int64_t n, double from, double to, int up, int is_linear) {
  const int64_t line = 2 * n + 1, most = n * n * of->facets * (is_linear ? of->parts : 1);
  side s = {.offsets = room(most + 1, 8), .list = room(FACET * most, 8), .x = room(3 * line * line, 8), .corner = room(line * line, 1)};
  int64_t *number = room(line * line, 8);
  for (int64_t k = 0; k < line * line; ++k) {
    const int64_t i = k % line, j = k / line;
    const double h = (to - from) / (double)n, u = from + 0.5 * h * (double)i, v = from + 0.5 * h * (double)j;
    number[k] = -1;
    if (of->n == 8 && i % 2 && j % 2) continue;
    number[k] = s.nodes;
    s.corner[s.nodes] = i % 2 == 0 && j % 2 == 0;
    s.x[3 * s.nodes] = u, s.x[3 * s.nodes + 1] = v;
    s.x[3 * s.nodes + 2] = 0.02 * sin(3 * u) * cos(2 * v) - (up ? 0.0 : 1e-3 * h);
    s.nodes++;
  }
  for (int64_t c = 0; c < n * n; ++c) {
    for (int f = 0; f < of->facets; ++f) {
      int64_t nodes[FACET], part[4];
      for (int k = 0; k < of->n; ++k) {
        const int at = of->at[f][k];
        nodes[k] = number[(2 * (c / n) + at / 3) * line + 2 * (c % n) + at % 3];
      }
      if (!is_linear) push(&s, of->n, nodes, up);
      for (int p = 0; is_linear && p < of->parts; ++p) {
        const int m = of->part[p][3] < 0 ? 3 : 4;
        for (int k = 0; k < m; ++k) part[k] = nodes[of->part[p][k]];
        push(&s, m, part, up);
      }
    }
  }
  free(number);
  return s;
}

static void drop(side *s) { free(s->offsets), free(s->list), free(s->x), free(s->corner); }

/* One way of having multipliers, with what it takes. */
typedef struct {
  stickslip_interface *interface;
  side one, two;
  double *x1, *lambda, *force1, *force2, *rows, *values, time[ROWS];
} way;

static way make(const kind *of, int64_t n, int is_linear, int32_t space, int32_t basis) {
  way w = {.one = grid(of, n, 0.0, 1.0, 0, is_linear), .two = grid(of, 113 * n / 100, -0.001, 1.001, 1, is_linear)};
  const int64_t n1 = w.one.nodes, n2 = w.two.nodes;
  int64_t *equations = room(3 * (2 * n1 + n2), 8);
  for (int64_t k = 0; k < 3 * (2 * n1 + n2); ++k) equations[k] = k;
  w.x1 = room(3 * n1, 8), w.lambda = room(3 * n1, 8), w.force1 = room(3 * n1, 8), w.rows = room(3 * n1, 8), w.force2 = room(3 * n2, 8);
  for (int64_t k = 0; k < 3 * n1; ++k) {
    const int has = is_linear || space == STICKSLIP_SPACE_SUB || w.one.corner[k / 3];
    if (!has) equations[3 * (n1 + n2) + k] = -1;
    w.lambda[k] = !has ? 0.0 : k % 3 == 2 ? -1.0 : 0.1;
  }
  for (int r = 0; r < ROWS; ++r) w.time[r] = 1e300;
  const stickslip_surface one = {.struct_size = sizeof one, .n_nodes = n1, .n_facets = w.one.facets, .coordinates = w.one.x,
      .facet_offsets = w.one.offsets, .facet_nodes = w.one.list, .equations = equations, .multiplier_equations = equations + 3 * (n1 + n2)};
  const stickslip_surface two = {.struct_size = sizeof two, .n_nodes = n2, .n_facets = w.two.facets, .coordinates = w.two.x,
      .facet_offsets = w.two.offsets, .facet_nodes = w.two.list, .equations = equations + 3 * n1};
  stickslip_options options;
  stickslip_method method = {.struct_size = sizeof method, .multiplier_space = space, .multiplier_basis = basis};
  CHECK(stickslip_options_init(&options, sizeof options));
  options.method = &method, options.modulus = 1000.0, options.mu = 0.3;
  CHECK(stickslip_interface_create(&one, &two, &options, &w.interface));
  free(equations);
  return w;
}

static void least(double *of, double start) { *of = fmin(*of, now() - start); }

static void pass(way *w, int64_t n, int number) {
  const double h = 1.0 / (double)n;
  int64_t rows, count;
  for (int64_t k = 0; k < 3 * w->one.nodes; ++k) {
    w->x1[k] = w->one.x[k] + (k % 3 == 0 ? 0.01 * h * (1 + 0.01 * number) : k % 3 == 2 ? 1e-3 * h * sin((double)k) : 0.0);
  }
  double start = now();
  CHECK(stickslip_interface_residual(w->interface, w->x1, w->two.x, w->lambda, NULL, w->force1, w->force2, w->rows));
  least(&w->time[0], start);
  start = now();
  CHECK(stickslip_interface_plan(w->interface, w->x1, w->two.x, STICKSLIP_PLAN_ACTIVE, &rows, &count));
  least(&w->time[3], start);
  free(w->values);
  w->values = room(count, sizeof(double));
  for (int again = 0; again < 2; ++again) {
    start = now();
    CHECK(stickslip_interface_plan_values(w->interface, w->x1, w->two.x, w->lambda, NULL, count, w->values));
    least(&w->time[1], start);
  }
  start = now();
  CHECK(stickslip_interface_commit(w->interface, w->x1, w->two.x, w->lambda, NULL));
  least(&w->time[2], start);
}

static void measure(const kind *of, int64_t n) {
  way ways[WAYS + 1] = {make(of, n, 1, STICKSLIP_SPACE_CORNER, STICKSLIP_BASIS_STANDARD), make(of, n, 0, STICKSLIP_SPACE_CORNER, STICKSLIP_BASIS_STANDARD),
      make(of, n, 0, STICKSLIP_SPACE_SUB, STICKSLIP_BASIS_STANDARD), make(of, n, 1, STICKSLIP_SPACE_CORNER, STICKSLIP_BASIS_DUAL),
      make(of, n, 0, STICKSLIP_SPACE_CORNER, STICKSLIP_BASIS_DUAL)};
  for (int p = 0; p < PASSES; ++p)
    for (int k = 0; k <= WAYS; ++k) pass(&ways[k], n, p);
  for (int row = 0; row < ROWS; ++row) {
    const double standard = ways[0].time[row], dual = ways[3].time[row];
    printf("%-6s %-24s %12.0f %10.2f %10.2f %12.0f %10.2f\n", of->name, names[row], standard, ways[1].time[row] / standard,
        ways[2].time[row] / standard, dual, ways[4].time[row] / dual);
  }
  for (int k = 0; k <= WAYS; ++k) {
    way *w = &ways[k];
    CHECK(stickslip_interface_destroy(&w->interface));
    drop(&w->one), drop(&w->two);
    free(w->x1), free(w->lambda), free(w->force1), free(w->force2), free(w->rows), free(w->values);
  }
}

int main(int argc, char **argv) {
  for (int k = 1; k < argc || k == 1; ++k) {
    const int64_t n = argc > 1 ? atoll(argv[k]) : 40;
    printf("\n%lld x %lld cells: microseconds of linear facets between the same nodes, and how many times that quadratic ones take\n", (long long)n, (long long)n);
    printf("%-31s %12s %10s %10s %12s %10s\n", "", "linear", "corner", "sub", "linear, dual", "corner");
    for (size_t of = 0; of < sizeof kinds / sizeof *kinds; ++of) measure(&kinds[of], n);
  }
  return 0;
}
