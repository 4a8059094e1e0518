/* What general contact costs over the same pairs named: residual and values of the tangent of the skin of two boxes, N x N facets over 1.13 N x
 * 1.13 N warped ones that touch, against an interface of these two faces. Both move between evaluations. Coulomb friction, dual multipliers.
 *
 *   skin [N]              by default 60; times of this thread, the least of several passes, which alternate
 *   skin -count skin N    ten evaluations of the skin, and `-count pair N` of the interface, alone: for callgrind
 */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <stickslip.h>

enum { PASSES = 15, COUNTED = 10 };
/* Both ways are sums of the same numbers. */
static const double SAME = 1e-12;

#define CHECK(call)                                                       \
  do {                                                                    \
    if (call) {                                                           \
      fprintf(stderr, "%s: %s\n", #call, stickslip_last_error_message()); \
      exit(1);                                                            \
    }                                                                     \
  } while (0)

static void *room(int64_t n, size_t size) {
  void *p = calloc((size_t)n, size);
  if (!p) exit(1);
  return p;
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

/* A box of n x n x 1 cells as all its facets. Nodes: (n + 1)^2 below, so many above, from `first` on. */
typedef struct {
  int64_t n, first, n_facets, *nodes;
} box;

static int64_t number(const box *b, int64_t i, int64_t j, int64_t k) { return b->first + i + (b->n + 1) * (j + (b->n + 1) * k); }

static void add(box *b, int64_t a, int64_t c, int64_t d, int64_t e) {
  int64_t *f = b->nodes + 4 * b->n_facets++;
  f[0] = a, f[1] = c, f[2] = d, f[3] = e;
}

/* Below come first, then above. */
static void make(box *b, int64_t n, int64_t first, int64_t *nodes) {
  *b = (box){n, first, 0, nodes};
  for (int64_t j = 0; j < n; ++j)
    for (int64_t i = 0; i < n; ++i) add(b, number(b, i, j, 0), number(b, i, j + 1, 0), number(b, i + 1, j + 1, 0), number(b, i + 1, j, 0));
  for (int64_t j = 0; j < n; ++j)
    for (int64_t i = 0; i < n; ++i) add(b, number(b, i, j, 1), number(b, i + 1, j, 1), number(b, i + 1, j + 1, 1), number(b, i, j + 1, 1));
  for (int64_t i = 0; i < n; ++i) {
    add(b, number(b, i, 0, 0), number(b, i + 1, 0, 0), number(b, i + 1, 0, 1), number(b, i, 0, 1));
    add(b, number(b, i + 1, n, 0), number(b, i, n, 0), number(b, i, n, 1), number(b, i + 1, n, 1));
    add(b, number(b, 0, i + 1, 0), number(b, 0, i, 0), number(b, 0, i, 1), number(b, 0, i + 1, 1));
    add(b, number(b, n, i, 0), number(b, n, i + 1, 0), number(b, n, i + 1, 1), number(b, n, i, 1));
  }
}

static int64_t n_nodes, n_facets, n_copies, pair_capacity, skin_capacity, face_nodes[2];
static int64_t *offsets, *nodes, *equations, *bodies, *originals, *of_side[2];
static double *X, *x[2], *lambda, *force, *rows, *values, *face_x[2][2], *face_lambda, *face_force[2], *face_rows;
static stickslip_skin *skin;
static stickslip_interface *pair;

/* Touches with a wave of both faces, so that facets are warped. */
static void place(const box *b, double low, double high, int is_low) {
  for (int64_t k = 0; k < 2; ++k)
    for (int64_t j = 0; j <= b->n; ++j)
      for (int64_t i = 0; i <= b->n; ++i) {
        double *p = X + 3 * number(b, i, j, k);
        p[0] = (double)i / (double)b->n, p[1] = (double)j / (double)b->n, p[2] = k ? high : low;
        if ((k == 1) == is_low) p[2] += 0.02 * sin(5 * p[0]) * cos(4 * p[1]);
      }
}

static void options_of(stickslip_options *options) {
  CHECK(stickslip_options_init(options, sizeof *options));
  options->mu = 0.3;
  options->modulus = 100;
}

static void create_skin(int64_t n, int64_t m) {
  box low, high;
  n_nodes  = 2 * ((n + 1) * (n + 1) + (m + 1) * (m + 1));
  n_facets = 2 * (n * n + m * m) + 4 * (n + m);
  X = room(3 * n_nodes, sizeof *X), nodes = room(4 * n_facets, sizeof *nodes), offsets = room(n_facets + 1, sizeof *offsets);
  equations = room(3 * n_nodes, sizeof *equations), bodies = room(n_facets, sizeof *bodies);
  make(&low, m, 0, nodes);
  make(&high, n, 2 * (m + 1) * (m + 1), nodes + 4 * low.n_facets);
  place(&low, -0.2, 0, 1);
  place(&high, 0, 0.2, 0);
  for (int64_t f = 0; f < n_facets; ++f) offsets[f + 1] = 4 * (f + 1), bodies[f] = f >= low.n_facets;
  for (int64_t k = 0; k < 3 * n_nodes; ++k) equations[k] = k;
  for (int side = 0; side < 2; ++side) {
    x[side] = room(3 * n_nodes, sizeof(double));
    memcpy(x[side], X, 3 * (size_t)n_nodes * sizeof(double));
    for (int64_t a = 2 * (m + 1) * (m + 1); a < n_nodes; ++a) x[side][3 * a] += 1e-3 * (1 + side), x[side][3 * a + 2] -= 1e-4 * (1 + side);
  }
  const stickslip_surface surface = {.struct_size = sizeof surface, .n_nodes = n_nodes, .n_facets = n_facets, .coordinates = X,
      .facet_offsets = offsets, .facet_nodes = nodes, .equations = equations};
  stickslip_options options;
  int64_t multipliers;
  options_of(&options);
  CHECK(stickslip_skin_create(&surface, bodies, 3 * n_nodes, &options, &skin));
  CHECK(stickslip_skin_copies(skin, 0, NULL, NULL, &n_copies, &multipliers));
  originals = room(n_copies, sizeof *originals);
  int64_t *of_copies = room(3 * n_copies, sizeof *of_copies);
  CHECK(stickslip_skin_copies(skin, n_copies, originals, of_copies, &n_copies, &multipliers));
  lambda = room(3 * n_copies, sizeof *lambda), force = room(3 * n_nodes, sizeof *force), rows = room(3 * n_copies, sizeof *rows);
  for (int64_t a = 0; a < n_copies; ++a) lambda[3 * a + 2] = 0.5, lambda[3 * a] = 0.01;
  free(of_copies);
  (void)high;
}

/* The facets with this side of the skin as a surface of their own. */
static void face(const int32_t side[], int32_t which, int s, stickslip_surface *out) {
  int64_t *local = room(n_nodes, sizeof *local), *own = room(4 * n_facets, sizeof *own), *ends = room(n_facets + 1, sizeof *ends), count = 0;
  of_side[s] = room(n_nodes, sizeof *of_side[s]);
  for (int64_t a = 0; a < n_nodes; ++a) local[a] = -1;
  for (int64_t f = 0; f < n_facets; ++f) {
    if (side[f] != which) continue;
    for (int k = 0; k < 4; ++k) {
      const int64_t a = nodes[4 * f + k];
      if (local[a] < 0) of_side[s][face_nodes[s]] = a, local[a] = face_nodes[s]++;
      own[4 * count + k] = local[a];
    }
    ends[count + 1] = 4 * (count + 1);
    ++count;
  }
  double *reference = room(3 * face_nodes[s], sizeof *reference);
  int64_t *numbers = room(3 * face_nodes[s], sizeof *numbers);
  for (int64_t k = 0; k < 3 * face_nodes[s]; ++k) {
    numbers[k]   = 3 * of_side[s][k / 3] + k % 3;
    reference[k] = X[numbers[k]];
  }
  for (int state = 0; state < 2; ++state) {
    face_x[state][s] = room(3 * face_nodes[s], sizeof(double));
    for (int64_t k = 0; k < 3 * face_nodes[s]; ++k) face_x[state][s][k] = x[state][numbers[k]];
  }
  face_force[s] = room(3 * face_nodes[s], sizeof(double));
  *out = (stickslip_surface){.struct_size = sizeof *out, .n_nodes = face_nodes[s], .n_facets = count, .coordinates = reference,
      .facet_offsets = ends, .facet_nodes = own, .equations = numbers};
}

static void create_pair(void) {
  int32_t *side = room(n_facets, sizeof *side);
  stickslip_surface sides[2];
  stickslip_options options;
  CHECK(stickslip_skin_facets(skin, &(stickslip_skin_sides){.struct_size = sizeof(stickslip_skin_sides), .side = side}));
  face(side, STICKSLIP_SKIN_NONMORTAR, 0, &sides[0]);
  face(side, STICKSLIP_SKIN_MORTAR, 1, &sides[1]);
  int64_t *multipliers = room(3 * face_nodes[0], sizeof *multipliers);
  for (int64_t k = 0; k < 3 * face_nodes[0]; ++k) multipliers[k] = 3 * n_nodes + k;
  sides[0].multiplier_equations = multipliers;
  options_of(&options);
  CHECK(stickslip_interface_create(&sides[0], &sides[1], &options, &pair));
  face_lambda = room(3 * face_nodes[0], sizeof *face_lambda), face_rows = room(3 * face_nodes[0], sizeof *face_rows);
  for (int64_t a = 0; a < face_nodes[0]; ++a) face_lambda[3 * a + 2] = 0.5, face_lambda[3 * a] = 0.01;
}

static void skin_residual(int state) { CHECK(stickslip_skin_residual(skin, x[state], lambda, force, rows)); }
static void skin_values(int state) { CHECK(stickslip_skin_plan_values(skin, x[state], lambda, skin_capacity, values)); }
static void pair_residual(int state) {
  CHECK(stickslip_interface_residual(pair, face_x[state][0], face_x[state][1], face_lambda, NULL, face_force[0], face_force[1], face_rows));
}
static void pair_values(int state) {
  CHECK(stickslip_interface_plan_values(pair, face_x[state][0], face_x[state][1], face_lambda, NULL, pair_capacity, values));
}

/* Beyond what the interface commits: the search over the whole skin, sides and pieces. */
static void skin_commit(int state) { CHECK(stickslip_skin_commit(skin, x[state], lambda)); }
static void pair_commit(int state) { CHECK(stickslip_interface_commit(pair, face_x[state][0], face_x[state][1], face_lambda, NULL)); }

static double time_of(void (*call)(int), int state) {
  const double start = now();
  call(state);
  return now() - start;
}

static double apart(void) {
  double most = 0, largest = 0;
  for (int s = 0; s < 2; ++s)
    for (int64_t k = 0; k < 3 * face_nodes[s]; ++k) {
      most    = fmax(most, fabs(face_force[s][k] - force[3 * of_side[s][k / 3] + k % 3]));
      largest = fmax(largest, fabs(face_force[s][k]));
    }
  return most / largest;
}

int main(int argc, char **argv) {
  const int counts = argc > 3 && !strcmp(argv[1], "-count"), of_skin = counts && !strcmp(argv[2], "skin");
  const int64_t n = counts ? atoi(argv[3]) : argc > 1 ? atoi(argv[1]) : 60;
  void (*const calls[6])(int) = {skin_residual, pair_residual, skin_values, pair_values, skin_commit, pair_commit};
  double least[6] = {1e99, 1e99, 1e99, 1e99, 1e99, 1e99};
  int64_t ignored;
  create_skin(n, (int64_t)(1.13 * (double)n));
  create_pair();
  CHECK(stickslip_skin_plan(skin, x[0], STICKSLIP_PLAN_SKIN, &skin_capacity));
  CHECK(stickslip_interface_plan(pair, face_x[0][0], face_x[0][1], STICKSLIP_PLAN_SKIN, &ignored, &pair_capacity));
  values = room(skin_capacity > pair_capacity ? skin_capacity : pair_capacity, sizeof *values);
  for (int pass = 0; pass < COUNTED && counts; ++pass) {
    calls[!of_skin](pass % 2);
    calls[2 + !of_skin](pass % 2);
  }
  if (counts) return 0;
  for (int pass = 0; pass < PASSES; ++pass) {
    for (int k = 0; k < 4; ++k) least[k] = fmin(least[k], time_of(calls[k], pass % 2));
  }
  const double difference = apart();
  printf("%lld facets on %lld nodes; entries of the skin's plan over the pair's %.3f; forces differ by %.1e\n",
      (long long)n_facets, (long long)n_nodes,
      (double)skin_capacity / (double)pair_capacity, difference);
  printf("residual: skin %.3f ms, pair %.3f ms, ratio %.3f\nvalues:   skin %.3f ms, pair %.3f ms, ratio %.3f\n",
      least[0], least[1], least[0] / least[1],
      least[2], least[3], least[2] / least[3]);
  printf("both:     ratio %.3f\n", (least[0] + least[2]) / (least[1] + least[3]));
  for (int pass = 0; pass < PASSES; ++pass) {
    for (int k = 4; k < 6; ++k) least[k] = fmin(least[k], time_of(calls[k], pass % 2));
  }
  printf("commit:   skin %.3f ms, pair %.3f ms: search, sides and pieces take %.2f us a facet\n",
      least[4], least[5], 1e3 * (least[4] - least[5]) / (double)n_facets);
  stickslip_skin_destroy(&skin);
  stickslip_interface_destroy(&pair);
  return difference < SAME ? 0 : 1;
}
