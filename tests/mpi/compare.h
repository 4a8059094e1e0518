/* An interface in parts beside one handle of all of it, on every rank, and what differs between them. */
#ifndef COMPARE_H
#define COMPARE_H

#include "surfaces.h"

/* Sums of parts are in another order: the last digits of the largest. */
static const double ROUNDING = 1e-12;
/* Equilibrium forgives 8 last digits of the largest coordinate that a handle has, which is another one in each part: 4e-14 here, and
 * modulus / h times that in a traction. */
static const double FORGIVEN = 2e-11;
/* The tangent times so many vectors of random numbers stands for all of its entries. */
enum { VECTORS = 3 };

typedef struct {
  const char       *name;
  kind              kind[2];
  stickslip_method  method;
  stickslip_options options; /* what differs from the defaults */
  int               renews;  /* parts must have been renewed on the way */
  int32_t           shares;
  double            mortar; /* its length; 0: beyond the strip's way */
  double            width;  /* its width; 0: beyond the strip's */
} scene;

static int rank, size, failures;

static inline void stop(const char *what, const char *message) {
  printf("FAILED rank %d: %s: %s\n", rank, what, message);
  MPI_Abort(MPI_COMM_WORLD, 1);
}
#define ONE(call) ((call) ? stop(#call, stickslip_last_error_message()) : (void)0)
#define ALL(call) ((call) ? stop(#call, stickslip_mpi_last_error_message()) : (void)0)

/* What is worst over the ranks and all steps. */
typedef struct {
  double force, rows, tangent, equilibrium, bits; /* bits: nodes that differ in any digit */
} differences;

static inline void worst(double *of, double value) { *of = value > *of || value != value ? value : *of; }

typedef struct {
  const scene             *scene;
  int                      d, c;
  int64_t                  n; /* unknowns */
  surface                  side[2];
  own_share                own[2];
  double                  *x[2], *lambda;        /* whole */
  double                  *own_x[2], *own_lambda;
  stickslip_interface     *one;
  stickslip_mpi_interface *all;
  differences              found;
} run;

static inline void place(run *r, double t, double slide) {
  for (int s = 0; s < 2; s++) positions(&r->side[s], s, t, slide, r->x[s]);
  for (int a = 0; a < r->side[0].n_nodes; a++)
    for (int i = 0; i < r->c; i++) {
      const double random = random_at((uint64_t)(1000 * t) * 100000 + (uint64_t)(r->c * a + i));
      r->lambda[r->c * a + i] = !r->side[0].corner[a] ? 0 : i == r->c - 1 ? -1 - random : 0.3 * random;
    }
  for (int s = 0; s < 2; s++) {
    free(r->own_x[s]);
    r->own_x[s] = own_values(&r->own[s], r->d, r->x[s]);
  }
  free(r->own_lambda);
  r->own_lambda = own_values(&r->own[0], r->c, r->lambda);
  ALL(stickslip_mpi_interface_update(r->all, r->own_x[0], r->own_x[1], r->own_lambda));
}

/* the largest difference of the own nodes, over the largest number of the whole */
static inline double apart(const own_share *own, int w, int64_t n, const double *parts, const double *whole) {
  double most = 0, scale = 0;
  for (int64_t k = 0; k < n; k++) scale = fmax(scale, fabs(whole[k]));
  for (int64_t k = 0; k < own->share.n_nodes; k++)
    for (int i = 0; i < w; i++) worst(&most, fabs(parts[w * k + i] - whole[w * own->index[k] + i]));
  return scale > 0 ? most / scale : most;
}

static inline void compare_residual(run *r) {
  const int n1 = r->side[0].n_nodes, n2 = r->side[1].n_nodes, d = r->d, c = r->c;
  double   *f1 = room((size_t)(d * n1), 8), *f2 = room((size_t)(d * n2), 8), *rows = room((size_t)(c * n1), 8);
  double   *g1 = room((size_t)(d * n1), 8), *g2 = room((size_t)(d * n2), 8), *rest = room((size_t)(c * n1), 8);
  ONE(stickslip_interface_residual(r->one, r->x[0], r->x[1], r->lambda, NULL, f1, f2, rows));
  ALL(stickslip_mpi_interface_residual(r->all, g1, g2, rest));
  worst(&r->found.force, apart(&r->own[0], d, d * n1, g1, f1));
  worst(&r->found.force, apart(&r->own[1], d, d * n2, g2, f2));
  worst(&r->found.rows, apart(&r->own[0], c, c * n1, rest, rows));
  free(f1), free(f2), free(rows), free(g1), free(g2), free(rest);
}

/* y += A v of a list of entries, for some v; and the sizes of A's rows. */
static inline void multiply(int64_t n, int base, int64_t count, const int64_t *i, const int64_t *j, const double *a, double *y, double *sizes) {
  for (int64_t e = 0; e < count; e++) {
    sizes[i[e] - base] += fabs(a[e]);
    for (int v = 0; v < VECTORS; v++) y[v * n + i[e] - base] += a[e] * random_at((uint64_t)(v * n + j[e] - base));
  }
}

/* once as triplets, and by the plan */
static inline void compare_tangent(run *r, int planned) {
  const int base = r->scene->options.index_base;
  int64_t   n = r->n, count, m = 0, *i, *j;
  double   *a, *y = room((size_t)(VECTORS * n), 8), *z = room((size_t)(VECTORS * n), 8), *sizes = room((size_t)n, 8), *other = room((size_t)n, 8);
  int32_t   status;
  ONE(stickslip_interface_tangent_coo(r->one, r->x[0], r->x[1], r->lambda, NULL, 0, NULL, NULL, NULL, &count));
  i = room((size_t)count, 8), j = room((size_t)count, 8), a = room((size_t)count, 8);
  ONE(stickslip_interface_tangent_coo(r->one, r->x[0], r->x[1], r->lambda, NULL, count, i, j, a, &count));
  multiply(n, base, count, i, j, a, y, sizes);
  free(i), free(j), free(a);
  if (planned) {
    a      = room(1, 8);
    status = stickslip_mpi_interface_plan_values(r->all, 0, a);
    free(a);
    if (status != STICKSLIP_MISSING_ENTRY && status != STICKSLIP_BUFFER_TOO_SMALL) stop("plan_values", stickslip_mpi_last_error_message());
    ALL(stickslip_mpi_interface_plan(r->all, STICKSLIP_PLAN_SKIN, &m));
    i = room((size_t)m, 8), j = room((size_t)m, 8), a = room((size_t)m, 8);
    ALL(stickslip_mpi_interface_plan_coo(r->all, m, i, j));
    ALL(stickslip_mpi_interface_plan_values(r->all, m, a));
  } else {
    ALL(stickslip_mpi_interface_tangent_coo(r->all, 0, NULL, NULL, NULL, &m));
    i = room((size_t)m, 8), j = room((size_t)m, 8), a = room((size_t)m, 8);
    ALL(stickslip_mpi_interface_tangent_coo(r->all, m, i, j, a, &m));
  }
  multiply(n, base, m, i, j, a, z, other);
  free(i), free(j), free(a);
  MPI_Allreduce(MPI_IN_PLACE, z, (int)(VECTORS * n), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  for (int64_t k = 0; k < VECTORS * n; k++)
    if (sizes[k % n] > 0 || z[k] != 0) worst(&r->found.tangent, sizes[k % n] > 0 ? fabs(z[k] - y[k]) / sizes[k % n] : 1);
  free(y), free(z), free(sizes), free(other);
}

static inline void compare_states(run *r) {
  const int n = r->side[0].n_nodes, d = r->d;
  int32_t  *state = room((size_t)n, 4), *own_state = room((size_t)n, 4);
  double   *values[8];
  for (int k = 0; k < 8; k++) values[k] = room((size_t)(d * n), 8);
  const stickslip_states one = {.struct_size = sizeof(one), .state = state, .normal = values[0], .slip = values[1], .area = values[2],
    .coverage = values[3]};
  const stickslip_states all = {.struct_size = sizeof(all), .state = own_state, .normal = values[4], .slip = values[5], .area = values[6],
    .coverage = values[7]};
  ONE(stickslip_interface_states(r->one, r->x[0], r->x[1], r->lambda, NULL, &one));
  ALL(stickslip_mpi_interface_states(r->all, &all));
  for (int64_t k = 0; k < r->own[0].share.n_nodes; k++) {
    const int a    = r->own[0].index[k];
    int       same = state[a] == own_state[k];
    for (int m = 0; m < 4; m++) {
      const int w = m < 2 ? d : 1;
      same        = same && !memcmp(values[m] + w * a, values[4 + m] + w * k, (size_t)w * 8);
    }
    r->found.bits += !same;
  }
  for (int k = 0; k < 8; k++) free(values[k]);
  free(state), free(own_state);
}

static inline void compare_equilibrium(run *r) {
  stickslip_equilibrium one = {.struct_size = sizeof(one), .modulus = 100}, all = one;
  ONE(stickslip_interface_equilibrium(r->one, r->x[0], r->x[1], r->lambda, NULL, &one));
  ALL(stickslip_mpi_interface_equilibrium(r->all, &all));
  const double a[] = {one.gap, one.gap_scale, one.traction, one.traction_scale, one.slip, one.slip_scale, one.slide, one.lag};
  const double b[] = {all.gap, all.gap_scale, all.traction, all.traction_scale, all.slip, all.slip_scale, all.slide, all.lag};
  for (int k = 0; k < 8; k++) /* what lags is a traction, and small beside the largest: that is what its rounding is of */
    worst(&r->found.equilibrium, fabs(a[k] - b[k]) / (k == 7 ? one.traction_scale : fabs(a[k]) + 1e-3));
  const int64_t base = r->scene->options.index_base;
  if (one.traction_node >= 0) worst(&r->found.equilibrium, all.traction_node == host_number((int)(one.traction_node - base)) ? 0 : 1);
}

static inline void compare(run *r, int planned) {
  compare_residual(r);
  compare_tangent(r, planned);
  compare_states(r);
  compare_equilibrium(r);
}

static inline void begin(run *r, const scene *s, int spread) {
  stickslip_options    options;
  stickslip_method     method = s->method;
  stickslip_mpi_method parts  = {.struct_size = sizeof(parts), .margin = 0.5, .shares = s->shares};
  *r                          = (run){.scene = s};
  ONE(stickslip_options_init(&options, sizeof(options)));
  method.struct_size = sizeof(method);
  options.method = &method, options.friction = s->options.friction, options.mu = s->options.mu, options.model = s->options.model;
  options.search_distance = s->options.search_distance, options.small_displacements = s->options.small_displacements;
  options.index_base = s->options.index_base, options.modulus = 100;
  make_surface(&r->side[0], s->kind[0], 48, 2, 1, 12, 0.8, 0, 0);
  make_surface(&r->side[1], s->kind[1], 56, 3, 0, s->mortar > 0 ? s->mortar : 16, s->width > 0 ? s->width : 1.1, 1, 0.2);
  r->d = r->side[0].d, r->c = options.friction == STICKSLIP_FRICTION_NONE ? 1 : r->d;
  r->n = number_unknowns(r->side, r->c);
  if (options.index_base) {
    for (int k = 0; k < 2; k++)
      for (int e = 0; e < r->d * r->side[k].n_nodes; e++) {
        r->side[k].equations[e]++;
        if (k == 0 && r->side[0].multipliers[e] >= 0) r->side[0].multipliers[e]++;
      }
  }
  stickslip_surface whole[2];
  int64_t          *nodes[2];
  for (int k = 0; k < 2; k++) {
    const surface *of = &r->side[k];
    make_share(of, k, r->c, rank, size, spread, &r->own[k]);
    nodes[k] = room((size_t)of->offsets[of->n_facets], 8);
    for (int64_t e = 0; e < of->offsets[of->n_facets]; e++) nodes[k][e] = of->nodes[e] + options.index_base;
    whole[k] = (stickslip_surface){.struct_size = sizeof(whole[k]), .n_nodes = of->n_nodes, .n_facets = of->n_facets, .coordinates = of->X,
      .facet_offsets = of->offsets, .facet_nodes = nodes[k], .equations = of->equations, .multiplier_equations = k ? NULL : of->multipliers};
    r->x[k] = room((size_t)(r->d * of->n_nodes), 8);
  }
  r->lambda = room((size_t)(r->c * r->side[0].n_nodes), 8);
  ONE(stickslip_interface_create(&whole[0], &whole[1], &options, &r->one));
  ALL(stickslip_mpi_interface_create(MPI_COMM_WORLD, &r->own[0].share, &r->own[1].share, &options, &parts, &r->all));
  free(nodes[0]), free(nodes[1]);
}

static inline void compare_first(run *r) {
  const int n     = r->c * r->side[0].n_nodes;
  double   *whole = room((size_t)n, 8), *parts = room((size_t)n, 8);
  ONE(stickslip_interface_initial_multipliers(r->one, whole));
  ALL(stickslip_mpi_interface_initial_multipliers(r->all, parts));
  for (int64_t k = 0; k < r->own[0].share.n_nodes; k++)
    r->found.bits += memcmp(parts + r->c * k, whole + r->c * r->own[0].index[k], (size_t)r->c * 8) != 0;
  free(whole), free(parts);
}

static inline void end(run *r) {
  stickslip_mpi_counts counts = {.struct_size = sizeof(counts)};
  int64_t              most[2];
  differences          all;
  ALL(stickslip_mpi_interface_counts(r->all, &counts));
  most[0] = counts.part_facets[0], most[1] = counts.part_facets[1];
  MPI_Allreduce(MPI_IN_PLACE, most, 2, MPI_INT64_T, MPI_MAX, MPI_COMM_WORLD);
  MPI_Allreduce(&r->found, &all, 5, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  const int equal  = all.force <= ROUNDING && all.rows <= ROUNDING && all.tangent <= ROUNDING && all.equilibrium <= FORGIVEN && all.bits == 0;
  const int parted = size < 2 || !r->scene->renews || counts.renewed > 0;
  if (rank == 0)
    printf("%-6s %-34s force %.1e rows %.1e tangent %.1e equilibrium %.1e nodes not to the bit %g; facets %lld + %lld of %lld + %lld, renewed %lld, rebalanced %lld\n",
           equal && parted ? "ok" : "FAILED", r->scene->name, all.force, all.rows, all.tangent, all.equilibrium, all.bits, (long long)most[0],
           (long long)most[1], (long long)counts.facets[0], (long long)counts.facets[1], (long long)counts.renewed,
           (long long)counts.rebalanced);
  failures += !(equal && parted);
  ONE(stickslip_interface_destroy(&r->one));
  ALL(stickslip_mpi_interface_destroy(&r->all));
  for (int s = 0; s < 2; s++) free_share(&r->own[s]), free_surface(&r->side[s]), free(r->x[s]), free(r->own_x[s]);
  free(r->lambda), free(r->own_lambda);
}

#endif
