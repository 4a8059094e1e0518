/* Who works on which non-mortar nodes: shares by recursive bisection of the first configuration, across the longest extent, so that each
 * rank has as much of the weight. A node's weight is what it costs: hardly anything where nothing covers it.
 *
 * The host's owners are no good in general: a mesh partition knows nothing of the contact, and may leave all of it to one rank. */
#include "internal.h"
#include <stdlib.h>
#include <string.h>

/* Of a node that nothing covers, over a covered one: it is searched, and its row is its multiplier. */
static const double UNCOVERED = 0.05;
/* More than this times the mean on one rank: other shares may be worth their making. */
static const double IMBALANCE = 1.2;
/* What they must save of the largest, at least: shares of few nodes cannot be even. */
static const double SAVES = 0.1;

typedef struct {
  double  at;
  int32_t node;
} Item;

static int along(const void *a, const void *b)
{
  const Item *x = a, *y = b;
  if (x->at != y->at) return x->at < y->at ? -1 : 1;
  return (x->node > y->node) - (x->node < y->node);
}

static int longest(int64_t n, const Item items[], int dimension, const double X[])
{
  double most = -1;
  int    axis = 0;
  for (int i = 0; i < dimension; i++) {
    double low = X[dimension * (int64_t)items[0].node + i], high = low;
    for (int64_t k = 1; k < n; k++) {
      const double v = X[dimension * (int64_t)items[k].node + i];
      low            = v < low ? v : low;
      high           = v > high ? v : high;
    }
    if (high - low > most) most = high - low, axis = i;
  }
  return axis;
}

static void split(int64_t n, Item items[], int dimension, const double X[], const double weights[], int first, int parts, int32_t part[])
{
  double  sum = 0, before = 0, wanted;
  int64_t cut = 0;
  int     axis;
  if (parts == 1 || n == 0) {
    for (int64_t k = 0; k < n; k++) part[items[k].node] = first;
    return;
  }
  axis = longest(n, items, dimension, X);
  for (int64_t k = 0; k < n; k++) {
    items[k].at = X[dimension * (int64_t)items[k].node + axis];
    sum += weights[items[k].node];
  }
  qsort(items, (size_t)n, sizeof(*items), along);
  wanted = sum * (parts / 2) / parts;
  while (cut < n && before + weights[items[cut].node] / 2 <= wanted) before += weights[items[cut++].node];
  split(cut, items, dimension, X, weights, first, parts / 2, part);
  split(n - cut, items + cut, dimension, X, weights, first + parts / 2, parts - parts / 2, part);
}

void bisect(int64_t n, int dimension, const double X[], const double weights[], int parts, int32_t part[])
{
  Item *items = allocate(n, sizeof(*items));
  for (int64_t k = 0; k < n; k++) items[k].node = (int32_t)k;
  split(n, items, dimension, X, weights, 0, parts, part);
  free(items);
}

/* Nothing is known of the contact yet. */
void shares_first(stickslip_mpi_interface *interface)
{
  const Whole *whole = &interface->whole[0];
  double      *ones;
  interface->worker = allocate(whole->n_nodes, sizeof(*interface->worker));
  if (interface->method.shares == STICKSLIP_MPI_SHARES_OF_HOST) {
    memcpy(interface->worker, whole->owners, (size_t)whole->n_nodes * sizeof(*interface->worker));
    return;
  }
  ones = allocate(whole->n_nodes, sizeof(*ones));
  for (int64_t k = 0; k < whole->n_nodes; k++) ones[k] = 1;
  bisect(whole->n_nodes, interface->dimension, whole->X, ones, interface->size, interface->worker);
  free(ones);
}

/* the largest share over the mean; `own` weights are of the own nodes */
static double imbalance(const stickslip_mpi_interface *interface, const int32_t worker[], const double own[])
{
  const Whole *whole = &interface->whole[0];
  double      *sums  = allocate(interface->size, sizeof(*sums)), all = 0, most = 0;
  for (int64_t k = 0; k < whole->n_own; k++) sums[worker[whole->own[k]]] += own[k];
  MPI_Allreduce(MPI_IN_PLACE, sums, interface->size, MPI_DOUBLE, MPI_SUM, interface->comm);
  for (int r = 0; r < interface->size; r++) {
    most = sums[r] > most ? sums[r] : most;
    all += sums[r];
  }
  free(sums);
  MPI_Bcast(&most, 1, MPI_DOUBLE, 0, interface->comm); /* sums may be rounded otherwise elsewhere */
  MPI_Bcast(&all, 1, MPI_DOUBLE, 0, interface->comm);
  return all > 0 ? most * interface->size / all : 1;
}

/* Collective. By what covers the own nodes: takes better shares, and gives those before them; 0 where those of now may stay. */
int shares_better(stickslip_mpi_interface *interface, const double coverage[], int32_t **before)
{
  const Whole *whole = &interface->whole[0];
  double      *own, *weights, now;
  int32_t     *worker;
  int          better;
  if (interface->size == 1 || interface->method.shares == STICKSLIP_MPI_SHARES_OF_HOST) return 0;
  own = allocate(whole->n_own, sizeof(*own));
  for (int64_t k = 0; k < whole->n_own; k++) own[k] = coverage[k] > 0 ? 1 : UNCOVERED;
  now = imbalance(interface, interface->worker, own);
  if (now <= IMBALANCE || now <= interface->endured) {
    free(own);
    return 0;
  }
  weights = whole_values(interface->comm, whole, 1, own);
  worker  = allocate(whole->n_nodes, sizeof(*worker));
  bisect(whole->n_nodes, interface->dimension, whole->X, weights, interface->size, worker);
  better             = imbalance(interface, worker, own) < (1 - SAVES) * now;
  interface->endured = better ? 0 : now;
  if (better) {
    *before           = interface->worker;
    interface->worker = worker;
  } else {
    free(worker);
  }
  free(weights);
  free(own);
  return better;
}
