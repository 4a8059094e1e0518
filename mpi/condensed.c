/* Systems without multipliers (docs/host_condensed.md): each part eliminates those of the nodes that it works on. */
#include "internal.h"
#include <stdlib.h>
#include <string.h>

/* Collective. The residual of the host's own forces at the part's nodes. */
static double *host_of(const stickslip_mpi_interface *interface, const double *host1)
{
  const Part *part = &interface->part;
  double     *host = allocate(interface->dimension * part->n_nodes[0], sizeof(*host));
  exchange_bring(&part->copies[0], interface->dimension * (int64_t)sizeof(*host), host1, host);
  return host;
}

int32_t stickslip_mpi_interface_condensed_multipliers(stickslip_mpi_interface *interface, const double *host1, double *lambda)
{
  Part         *part  = &interface->part;
  const int64_t n     = interface->whole[0].n_own, bytes = interface->components * (int64_t)sizeof(double);
  int32_t       status = n && (!host1 || !lambda) ? refuse(STICKSLIP_NULL_POINTER, "host1 and lambda must not be NULL.") : STICKSLIP_OK;
  double       *host, *here;
  status = agree(interface->comm, status);
  if (status) return status;
  host = host_of(interface, host1);
  here = allocate(interface->components * part->n_nodes[0], sizeof(*here));
  if (part->handle)
    status = refuse_by_library(interface, stickslip_interface_condensed_multipliers(part->handle, part->x[0], part->x[1], host, here));
  status = agree(interface->comm, status);
  if (!status) { /* right at the nodes that a part works on: from there to all that have them */
    exchange_give(&part->worked, bytes, here, lambda);
    if (n) memcpy(interface->lambda, lambda, (size_t)(bytes * n));
    exchange_bring(&part->copies[0], bytes, interface->lambda, part->lambda);
  }
  free(here);
  free(host);
  return status;
}

int32_t stickslip_mpi_interface_condensed_residual(stickslip_mpi_interface *interface, const double *host1, double *rows1, double *force2)
{
  Part         *part = &interface->part;
  const int64_t d = interface->dimension, n1 = interface->whole[0].n_own, n2 = interface->whole[1].n_own;
  int32_t       status = STICKSLIP_OK;
  double       *host;
  if ((n1 && (!host1 || !rows1)) || (n2 && !force2)) status = refuse(STICKSLIP_NULL_POINTER, "host1, rows1 and force2 must not be NULL.");
  status = agree(interface->comm, status);
  if (status) return status;
  host = host_of(interface, host1);
  if (part->handle)
    status = refuse_by_library(interface, stickslip_interface_condensed_residual(part->handle, part->x[0], part->x[1], part->lambda, host,
                                                                                 part->force[0], part->force[1]));
  free(host);
  status = agree(interface->comm, status);
  if (status) return status;
  if (n1) memset(rows1, 0, (size_t)(d * n1) * sizeof(double));
  if (n2) memset(force2, 0, (size_t)(d * n2) * sizeof(double));
  exchange_add(&part->copies[0], interface->dimension, part->force[0], rows1);
  exchange_add(&part->copies[1], interface->dimension, part->force[1], force2);
  return STICKSLIP_OK;
}

int32_t stickslip_mpi_interface_condensed_coo(stickslip_mpi_interface *interface, int32_t piece, int64_t capacity, int64_t *rows,
                                              int64_t *columns, double *values, int64_t *count)
{
  Part   *part   = &interface->part;
  int32_t status = count ? STICKSLIP_OK : refuse(STICKSLIP_NULL_POINTER, "count is NULL.");
  if (!status) *count = 0;
  if (!status && part->handle)
    status = refuse_by_library(interface, stickslip_interface_condensed_coo(part->handle, part->x[0], part->x[1], part->lambda, piece, capacity,
                                                                            rows, columns, values, count));
  return agree(interface->comm, status);
}
