/* Two surfaces for the tests, made whole on every rank: a strip that lies on a longer one, both waved, so that there are nodes in gap
 * and in contact. Each rank hands over its share of them to the library, and the whole to a handle that the parts are compared with. */
#ifndef SURFACES_H
#define SURFACES_H

#include "../../mpi/stickslip_mpi.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum { QUAD4, TRI3, QUAD8, QUAD9, TRI6, LINE2, LINE3, N_KINDS } kind;

/* Nodes and facets ascend as the library orders them, so that one handle adds up in the same order. */
typedef struct {
  int      d, n_nodes, n_facets, nx, ny, order, n_lattice;
  int     *node;    /* of each place of the lattice; -1: none */
  int     *corner;  /* of each node: does a facet have it as a corner? */
  double  *X;
  int64_t *offsets, *nodes, *equations, *multipliers;
} surface;

static const struct {
  int order, corners, mids, centre, two; /* two facets a cell */
} KINDS[N_KINDS] = {[QUAD4] = {1, 4, 0, 0, 0}, [TRI3] = {1, 3, 0, 0, 1},  [QUAD8] = {2, 4, 1, 0, 0}, [QUAD9] = {2, 4, 1, 1, 0},
                    [TRI6] = {2, 3, 1, 0, 1},  [LINE2] = {1, 2, 0, 0, 0}, [LINE3] = {2, 2, 1, 0, 0}};

static inline void *room(size_t n, size_t bytes) {
  void *found = calloc(n ? n : 1, bytes);
  if (!found) abort();
  return found;
}

static inline int at_place(surface *s, int i, int j) { return j * (s->order * s->nx + 1) + i; }

/* The places that a facet of cell (i, j) has on the lattice, seen from above or from below. Returns how many. */
static inline int places_of(surface *s, kind k, int i, int j, int second, int up, int places[9]) {
  const int p = s->order, c = KINDS[k].corners;
  const int quad[4][2] = {{0, 0}, {p, 0}, {p, p}, {0, p}}, tri[2][3] = {{0, 1, 2}, {0, 2, 3}};
  int x[4], y[4], n = 0;
  for (int a = 0; a < c; a++) {
    const int turned = up ? a : (c - a) % c, of = c == 3 ? tri[second][turned] : turned;
    x[a] = p * i + (c == 2 ? (up ? p * (1 - a) : p * a) : quad[of][0]);
    y[a] = c == 2 ? 0 : p * j + quad[of][1];
    places[n++] = at_place(s, x[a], y[a]);
  }
  for (int a = 0; KINDS[k].mids && a < (c == 2 ? 1 : c); a++)
    places[n++] = at_place(s, (x[a] + x[(a + 1) % c]) / 2, (y[a] + y[(a + 1) % c]) / 2);
  if (KINDS[k].centre) places[n++] = at_place(s, p * i + 1, p * j + 1);
  return n;
}

static inline void make_surface(surface *s, kind k, int nx, int ny, double x0, double length, double width, int up, double phase) {
  int most, places[9];
  *s = (surface){.d = k >= LINE2 ? 2 : 3, .nx = nx, .ny = k >= LINE2 ? 1 : ny, .order = KINDS[k].order};
  const int wide = s->order * nx + 1, high = k >= LINE2 ? 1 : s->order * s->ny + 1;
  s->n_lattice = wide * high;
  most = nx * s->ny * (1 + KINDS[k].two);
  s->node    = room((size_t)s->n_lattice, sizeof(int));
  s->offsets = room((size_t)most + 1, sizeof(int64_t));
  s->nodes   = room((size_t)(9 * most), sizeof(int64_t));
  for (int f = 0; f < most; f++) { /* places first */
    const int cell = f / (1 + KINDS[k].two), n = places_of(s, k, cell % nx, cell / nx, f % (1 + KINDS[k].two), up, places);
    s->offsets[f + 1] = s->offsets[f] + n;
    for (int a = 0; a < n; a++) {
      s->nodes[s->offsets[f] + a] = places[a];
      s->node[places[a]] |= a < KINDS[k].corners ? 2 : 1;
    }
  }
  s->n_facets = most;
  s->corner   = room((size_t)s->n_lattice, sizeof(int));
  s->X        = room((size_t)(s->d * s->n_lattice), sizeof(double));
  for (int at = 0; at < s->n_lattice; at++) {
    const int used = s->node[at];
    s->node[at]    = used ? s->n_nodes : -1;
    if (!used) continue;
    double *X = s->X + s->d * s->n_nodes;
    X[0]      = x0 + length * (at % wide) / (wide - 1);
    if (s->d == 3) X[1] = (up ? -0.1 : 0) + width * (at / wide) / (high - 1);
    X[s->d - 1]          = 0.02 * sin(0.9 * X[0] + phase);
    s->corner[s->n_nodes++] = used >> 1;
  }
  for (int64_t a = 0; a < s->offsets[most]; a++) s->nodes[a] = s->node[s->nodes[a]];
  s->equations   = room((size_t)(s->d * s->n_nodes), sizeof(int64_t));
  s->multipliers = room((size_t)(s->d * s->n_nodes), sizeof(int64_t));
}

static inline void free_surface(surface *s) {
  free(s->node), free(s->corner), free(s->X), free(s->offsets), free(s->nodes), free(s->equations), free(s->multipliers);
}

/* Numbers of all unknowns: displacements of both sides, then c multipliers a node. */
static inline int64_t number_unknowns(surface sides[2], int c) {
  int64_t n = 0;
  for (int s = 0; s < 2; s++)
    for (int k = 0; k < sides[s].d * sides[s].n_nodes; k++) sides[s].equations[k] = n++;
  for (int a = 0; a < sides[0].n_nodes; a++)
    for (int i = 0; i < c; i++) sides[0].multipliers[c * a + i] = sides[0].corner[a] ? n++ : -1;
  return n;
}

/* Of a node, what the host calls it. */
static inline int64_t host_number(int index) { return 10 * (int64_t)index + 3; }

/* A rank's share, in an order of its own. `spread`: nodes are dealt out one by one; else each rank has a stretch along the strip.
 * Rank 0 has nothing where there are three ranks or more. */
typedef struct {
  stickslip_mpi_share share;
  int                *index; /* of its nodes */
} own_share;

static inline int owner_of(const surface *s, int node, int size, int spread) {
  const int first = size > 2, n = size - first;
  if (spread) return first + (7 * node + 2) % n;
  const double low = s->X[0], high = s->X[s->d * (s->n_nodes - 1)];
  const int    at  = (int)(n * (s->X[s->d * node] - low) / (high - low) * 0.999999);
  return first + (at < n ? at : n - 1);
}

static inline void make_share(const surface *s, int side, int c, int rank, int size, int spread, own_share *own) {
  const int d = s->d;
  int64_t  *nodes, *equations, *multipliers, *offsets, *facet_nodes, n = 0, m = 0;
  double   *X;
  own->index  = room((size_t)s->n_nodes, sizeof(int));
  nodes       = room((size_t)s->n_nodes, sizeof(int64_t));
  equations   = room((size_t)(d * s->n_nodes), sizeof(int64_t));
  multipliers = room((size_t)(c * s->n_nodes), sizeof(int64_t));
  X           = room((size_t)(d * s->n_nodes), sizeof(double));
  offsets     = room((size_t)s->n_facets + 1, sizeof(int64_t));
  facet_nodes = room((size_t)s->offsets[s->n_facets], sizeof(int64_t));
  for (int a = s->n_nodes - 1; a >= 0; a--) {
    if (owner_of(s, a, size, spread) != rank) continue;
    own->index[n] = a;
    nodes[n]      = host_number(a);
    memcpy(X + d * n, s->X + d * a, (size_t)d * sizeof(double));
    memcpy(equations + d * n, s->equations + d * a, (size_t)d * sizeof(int64_t));
    if (side == 0) memcpy(multipliers + c * n, s->multipliers + c * a, (size_t)c * sizeof(int64_t));
    n++;
  }
  own->share = (stickslip_mpi_share){.struct_size = sizeof(own->share), .n_nodes = n, .nodes = nodes, .coordinates = X,
    .equations = equations, .multiplier_equations = side == 0 ? multipliers : NULL, .facet_offsets = offsets, .facet_nodes = facet_nodes};
  for (int f = s->n_facets - 1; f >= 0; f--) {
    if (owner_of(s, (int)s->nodes[s->offsets[f]], size, spread) != rank) continue;
    for (int64_t k = s->offsets[f]; k < s->offsets[f + 1]; k++) facet_nodes[m++] = host_number((int)s->nodes[k]);
    offsets[++own->share.n_facets] = m;
  }
}

static inline void free_share(own_share *own) {
  free(own->index), free((void *)own->share.nodes), free((void *)own->share.coordinates), free((void *)own->share.equations);
  free((void *)own->share.multiplier_equations), free((void *)own->share.facet_offsets), free((void *)own->share.facet_nodes);
}

/* The own nodes' part of an array of the whole surface: w numbers a node. */
static inline double *own_values(const own_share *own, int w, const double *whole) {
  double *found = room((size_t)(w * own->share.n_nodes), sizeof(double));
  for (int64_t k = 0; k < own->share.n_nodes; k++) memcpy(found + w * k, whole + w * own->index[k], (size_t)w * sizeof(double));
  return found;
}

/* Where the strip is at step t: slid along, pressed and lifted in waves; the lower surface moves a little, too. */
static inline void positions(const surface *s, int side, double t, double slide, double *x) {
  for (int a = 0; a < s->n_nodes; a++) {
    const double *X = s->X + s->d * a;
    double       *p = x + s->d * a;
    memcpy(p, X, (size_t)s->d * sizeof(double));
    p[0] += side == 0 ? slide * t : -0.02 * t;
    if (s->d == 3) p[1] += side == 0 ? 0.011 * t : -0.004 * t;
    p[s->d - 1] += side == 0 ? -0.01 + 0.02 * sin(0.7 * X[0] + t) : 0.003 * t;
  }
}

static inline double random_at(uint64_t k) {
  k = (k + 1) * 6364136223846793005u + 1442695040888963407u;
  k ^= k >> 33, k *= 0xff51afd7ed558ccdu, k ^= k >> 33;
  return (double)(k >> 11) / 4503599627370496.0 - 1;
}

#endif
