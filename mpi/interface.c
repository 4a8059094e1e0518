/* An interface from its beginning to its end, and where it is. */
#include "internal.h"
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int32_t check(const stickslip_options *options, const stickslip_mpi_method *method, stickslip_mpi_interface **out)
{
  if (!out || !options) return refuse(STICKSLIP_NULL_POINTER, "%s is NULL.", out ? "options" : "out");
  if (options->struct_size != sizeof(*options))
    return refuse(STICKSLIP_STRUCT_SIZE, "struct_size of options is %" PRIu64 "; %zu is allowed.", options->struct_size, sizeof(*options));
  if (options->method && options->method->struct_size != sizeof(*options->method))
    return refuse(STICKSLIP_STRUCT_SIZE, "struct_size of options.method is %" PRIu64 "; %zu is allowed.", options->method->struct_size,
                  sizeof(*options->method));
  if (!method) return STICKSLIP_OK;
  if (method->struct_size != sizeof(*method))
    return refuse(STICKSLIP_STRUCT_SIZE, "struct_size of method is %" PRIu64 "; %zu is allowed.", method->struct_size, sizeof(*method));
  if (method->shares != STICKSLIP_MPI_SHARES_BALANCED && method->shares != STICKSLIP_MPI_SHARES_OF_HOST)
    return refuse(STICKSLIP_INVALID_VALUE, "method.shares is %" PRId32 "; STICKSLIP_MPI_SHARES_BALANCED and _OF_HOST are allowed.",
                  method->shares);
  if (method->further_rings < 0 || !(method->margin >= 0 && method->margin < INFINITY))
    return refuse(STICKSLIP_INVALID_VALUE, "method.further_rings is %" PRId32 " and method.margin %g; 0 or more are allowed.",
                  method->further_rings, method->margin);
  return STICKSLIP_OK;
}

/* What the surfaces must have, as all ranks see it. */
static int32_t check_whole(const stickslip_mpi_interface *interface)
{
  const int analytic = interface->options.mortar_side == STICKSLIP_MORTAR_ANALYTIC;
  if (!interface->whole[0].n_facets || (!interface->whole[1].n_facets && !analytic))
    return refuse(STICKSLIP_INVALID_VALUE, "%s has no facet on any rank; one at least is needed.",
                  interface->whole[0].n_facets ? "mortar" : "nonmortar");
  if (interface->choices.decision == STICKSLIP_DECISION_POINTS && interface->options.friction != STICKSLIP_FRICTION_NONE && interface->size > 1)
    return refuse(STICKSLIP_UNSUPPORTED,
                  "method.decision is STICKSLIP_DECISION_POINTS with friction on %d ranks: what points remember does not migrate; "
                  "on several ranks STICKSLIP_FRICTION_NONE or STICKSLIP_DECISION_NODES is allowed.",
                  interface->size);
  return STICKSLIP_OK;
}

static double longest_edge(const Whole *whole, int dimension)
{
  double longest = 0;
  for (int64_t f = 0; f < whole->n_facets; f++) {
    const int64_t first = whole->offsets[f], n = whole->offsets[f + 1] - first;
    const int64_t corners = dimension == 2 ? 2 : n == 3 || n == 6 ? 3 : 4;
    for (int64_t k = 0; k < corners && k < n; k++) {
      const double *a = whole->X + dimension * (int64_t)whole->nodes[first + k];
      const double *b = whole->X + dimension * (int64_t)whole->nodes[first + (k + 1) % corners];
      double        square = 0;
      for (int i = 0; i < dimension; i++) square += (a[i] - b[i]) * (a[i] - b[i]);
      longest = fmax(longest, square);
    }
  }
  return sqrt(longest);
}

/* What is known of the own nodes when nothing has moved. */
static void set_own(stickslip_mpi_interface *interface, const stickslip_mpi_share *const shares[SIDES])
{
  const int d = interface->dimension;
  double   *zero;
  for (int s = 0; s < SIDES; s++) {
    interface->equations[s] = copied(shares[s]->equations, d * shares[s]->n_nodes, sizeof(int64_t));
    interface->x[s]         = copied(shares[s]->coordinates, d * shares[s]->n_nodes, sizeof(double));
  }
  interface->multipliers = copied(shares[0]->multiplier_equations, interface->components * shares[0]->n_nodes, sizeof(int64_t));
  interface->lambda      = allocate(interface->components * shares[0]->n_nodes, sizeof(double));
  zero                   = allocate(d * shares[0]->n_nodes, sizeof(*zero));
  state_set(interface, 0, interface->x[0], interface->x[1], zero, &interface->t_n);
  free(zero);
}

/* The first parts; then others, if what covers what says so. */
static int32_t share_out(stickslip_mpi_interface *interface)
{
  const At at = {{interface->t_n.x[0], interface->t_n.x[1]}};
  double  *coverage;
  int32_t  status;
  interface->longest_edge = longest_edge(&interface->whole[1], interface->dimension);
  shares_first(interface);
  status = parts_renew(interface, &interface->t_n, &at);
  if (status || interface->size == 1) return status;
  coverage                 = allocate(interface->whole[0].n_own, sizeof(*coverage));
  stickslip_states states = {.struct_size = sizeof(states), .coverage = coverage};
  status                   = stickslip_mpi_interface_states(interface, &states);
  if (!status) status = balance(interface, coverage);
  free(coverage);
  return status;
}

int32_t stickslip_mpi_interface_create(MPI_Comm comm, const stickslip_mpi_share *nonmortar, const stickslip_mpi_share *mortar,
                                       const stickslip_options *options, const stickslip_mpi_method *method,
                                       stickslip_mpi_interface **out)
{
  const stickslip_mpi_share *const shares[SIDES] = {nonmortar, mortar};
  stickslip_mpi_interface         *interface;
  int32_t                          status = agree(comm, check(options, method, out));
  if (status) return status;
  interface = allocate(1, sizeof(*interface));
  MPI_Comm_dup(comm, &interface->comm);
  MPI_Comm_rank(comm, &interface->rank);
  MPI_Comm_size(comm, &interface->size);
  interface->options        = *options;
  interface->choices        = options->method ? *options->method : (stickslip_method){.struct_size = sizeof(stickslip_method)};
  interface->options.method = &interface->choices;
  if (method) interface->method = *method;
  interface->dimension  = options->model == STICKSLIP_MODEL_SOLID ? 3 : 2;
  interface->components = options->friction == STICKSLIP_FRICTION_NONE ? 1 : interface->dimension;
  for (int s = 0; s < SIDES && !status; s++) status = whole_gather(interface->comm, shares[s], s, interface->dimension, &interface->whole[s]);
  if (!status) status = check_whole(interface);
  if (!status) {
    set_own(interface, shares);
    status = share_out(interface);
  }
  if (status)
    stickslip_mpi_interface_destroy(&interface);
  else
    *out = interface;
  return status;
}

int32_t stickslip_mpi_interface_destroy(stickslip_mpi_interface **pointer)
{
  stickslip_mpi_interface *interface = pointer ? *pointer : NULL;
  if (!interface) return STICKSLIP_OK;
  part_destroy(&interface->part);
  halo_destroy(&interface->halo);
  state_destroy(&interface->t_n);
  state_destroy(&interface->before);
  for (int s = 0; s < SIDES; s++) {
    whole_destroy(&interface->whole[s]);
    free(interface->equations[s]);
    free(interface->x[s]);
    free(interface->offsets[s]);
  }
  free(interface->multipliers);
  free(interface->lambda);
  free(interface->worker);
  free(interface->friction);
  MPI_Comm_free(&interface->comm);
  free(interface);
  *pointer = NULL;
  return STICKSLIP_OK;
}

/* n numbers that must be there and finite */
static int32_t check_numbers(const char *name, int64_t n, const double values[])
{
  if (n && !values) return refuse(STICKSLIP_NULL_POINTER, "%s is NULL.", name);
  for (int64_t k = 0; k < n; k++)
    if (!isfinite(values[k]))
      return refuse(STICKSLIP_NOT_FINITE, "%s: number %" PRId64 " of this rank's is %g; finite ones are allowed.", name, k, values[k]);
  return STICKSLIP_OK;
}

int32_t stickslip_mpi_interface_update(stickslip_mpi_interface *interface, const double *x1, const double *x2, const double *lambda)
{
  const double *const x[SIDES] = {x1, x2};
  const int64_t       d = interface->dimension, n = interface->components * interface->whole[0].n_own;
  int32_t             status   = check_numbers("x1", d * interface->whole[0].n_own, x1);
  if (!status) status = check_numbers("x2", d * interface->whole[1].n_own, x2);
  if (!status) status = check_numbers("lambda", n, lambda);
  status = agree(interface->comm, status);
  if (status) return status;
  for (int s = 0; s < SIDES; s++)
    if (interface->whole[s].n_own) memcpy(interface->x[s], x[s], (size_t)(d * interface->whole[s].n_own) * sizeof(double));
  if (n) memcpy(interface->lambda, lambda, (size_t)n * sizeof(double));
  {
    const At now = {{interface->x[0], interface->x[1]}};
    part_bring(interface, &interface->part, &now, interface->lambda);
    if (halo_covers(interface, 0)) return STICKSLIP_OK;
    status = parts_renew(interface, &interface->t_n, &now);
    interface->renewed += !status;
  }
  return status;
}

int32_t stickslip_mpi_interface_set_friction(stickslip_mpi_interface *interface, const double *mu)
{
  const int64_t n      = interface->whole[0].n_own;
  Part         *part   = &interface->part;
  int32_t       status = check_numbers("mu", n, mu);
  double       *here;
  for (int64_t k = 0; k < n && !status; k++)
    if (mu[k] < 0) status = refuse(STICKSLIP_INVALID_VALUE, "mu: number %" PRId64 " of this rank's is %g; 0 or more is allowed.", k, mu[k]);
  status = agree(interface->comm, status);
  if (status) return status;
  here = allocate(part->n_nodes[0], sizeof(*here));
  exchange_bring(&part->copies[0], sizeof(*here), mu, here);
  if (part->handle) status = refuse_by_library(interface, stickslip_interface_set_friction(part->handle, here));
  free(here);
  status = agree(interface->comm, status);
  if (status) return status;
  free(interface->friction);
  interface->friction = copied(mu, n, sizeof(*mu));
  return STICKSLIP_OK;
}

int32_t stickslip_mpi_interface_set_offsets(stickslip_mpi_interface *interface, const double *offsets1, const double *offsets2)
{
  const double *const given[SIDES] = {offsets1, offsets2};
  double             *before[SIDES];
  const int           wider = !interface->offsets[0] && interface->options.search_distance > 0;
  int32_t             status = check_numbers("offsets1", interface->whole[0].n_own, offsets1);
  if (!status) status = check_numbers("offsets2", interface->whole[1].n_own, offsets2);
  status = agree(interface->comm, status);
  if (status) return status;
  for (int s = 0; s < SIDES; s++) {
    before[s]             = interface->offsets[s];
    interface->offsets[s] = copied(given[s], interface->whole[s].n_own, sizeof(double));
  }
  if (wider) { /* pairs are sought farther than search_distance now */
    const At now = {{interface->x[0], interface->x[1]}};
    if (!interface->t_n.commits) state_set(interface, 0, interface->t_n.x[0], interface->t_n.x[1], interface->t_n.slip, &interface->t_n);
    status = parts_renew(interface, &interface->t_n, &now);
  } else {
    part_offsets(&interface->part, interface->offsets, &status);
    status = agree(interface->comm, refuse_by_library(interface, status));
  }
  for (int s = 0; s < SIDES; s++) {
    free(status ? interface->offsets[s] : before[s]);
    if (status) interface->offsets[s] = before[s];
  }
  return status;
}

int32_t stickslip_mpi_interface_counts(const stickslip_mpi_interface *interface, stickslip_mpi_counts *counts)
{
  const Part        *part     = &interface->part;
  stickslip_counters counters = {.struct_size = sizeof(counters)};
  accept();
  if (counts->struct_size != sizeof(*counts))
    return refuse(STICKSLIP_STRUCT_SIZE, "struct_size of counts is %" PRIu64 "; %zu is allowed.", counts->struct_size, sizeof(*counts));
  *counts = (stickslip_mpi_counts){.struct_size = sizeof(*counts), .worked = part->n_worked, .renewed = interface->renewed,
                                   .rebalanced = interface->rebalanced};
  for (int s = 0; s < SIDES; s++) {
    counts->nodes[s]       = interface->whole[s].n_nodes;
    counts->facets[s]      = interface->whole[s].n_facets;
    counts->part_nodes[s]  = part->n_nodes[s];
    counts->part_facets[s] = part->n_facets[s];
    counts->bytes_whole += whole_bytes(&interface->whole[s], interface->dimension);
    counts->bytes_part += part->n_nodes[s] * (int64_t)(2 * interface->dimension * (int)sizeof(double) + 3 * (int)sizeof(int32_t)) +
                          part->offsets[s][part->n_facets[s]] * (int64_t)sizeof(int64_t);
  }
  counts->bytes_whole += interface->whole[0].n_nodes * (int64_t)sizeof(int32_t);
  if (part->handle && !stickslip_interface_counters(part->handle, &counters)) counts->bytes_part += counters.bytes;
  return STICKSLIP_OK;
}

stickslip_interface *stickslip_mpi_interface_handle(const stickslip_mpi_interface *interface)
{
  return interface->part.handle;
}
