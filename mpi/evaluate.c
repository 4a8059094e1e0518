/* Residual, tangent and states at the place of the last update: each part's, brought to where they belong. */
#include "internal.h"
#include <stdlib.h>
#include <string.h>

/* what a part is asked with */
#define PLACE_OF(part) (part)->handle, (part)->x[0], (part)->x[1], (part)->lambda, NULL

int32_t stickslip_mpi_interface_initial_multipliers(stickslip_mpi_interface *interface, double *lambda)
{
  Part   *part   = &interface->part;
  int32_t status = interface->whole[0].n_own && !lambda ? refuse(STICKSLIP_NULL_POINTER, "lambda is NULL.") : STICKSLIP_OK;
  if (!status && part->handle)
    status = refuse_by_library(interface, stickslip_interface_initial_multipliers(part->handle, part->lambda));
  status = agree(interface->comm, status);
  if (status) return status;
  exchange_give(&part->worked, interface->components * (int64_t)sizeof(double), part->lambda, lambda);
  return STICKSLIP_OK;
}

int32_t stickslip_mpi_interface_residual(stickslip_mpi_interface *interface, double *force1, double *force2, double *rows)
{
  Part         *part   = &interface->part;
  const int64_t d      = interface->dimension;
  int32_t       status = STICKSLIP_OK;
  if ((interface->whole[0].n_own && (!force1 || !rows)) || (interface->whole[1].n_own && !force2))
    status = refuse(STICKSLIP_NULL_POINTER, "force1, force2 and rows must not be NULL.");
  if (!status && part->handle)
    status = refuse_by_library(interface, stickslip_interface_residual(PLACE_OF(part), part->force[0], part->force[1], part->rows));
  status = agree(interface->comm, status);
  if (status) return status;
  if (interface->whole[0].n_own) memset(force1, 0, (size_t)(d * interface->whole[0].n_own) * sizeof(double));
  if (interface->whole[1].n_own) memset(force2, 0, (size_t)(d * interface->whole[1].n_own) * sizeof(double));
  exchange_add(&part->copies[0], interface->dimension, part->force[0], force1);
  exchange_add(&part->copies[1], interface->dimension, part->force[1], force2);
  exchange_give(&part->worked, interface->components * (int64_t)sizeof(double), part->rows, rows);
  return STICKSLIP_OK;
}

int32_t stickslip_mpi_interface_tangent_coo(stickslip_mpi_interface *interface, int64_t capacity, int64_t *rows, int64_t *columns,
                                            double *values, int64_t *count)
{
  Part   *part   = &interface->part;
  int32_t status = count ? STICKSLIP_OK : refuse(STICKSLIP_NULL_POINTER, "count is NULL.");
  if (!status) *count = 0;
  if (!status && part->handle)
    status = refuse_by_library(interface, stickslip_interface_tangent_coo(PLACE_OF(part), capacity, rows, columns, values, count));
  return agree(interface->comm, status);
}

int32_t stickslip_mpi_interface_plan(stickslip_mpi_interface *interface, int32_t pairs, int64_t *count)
{
  Part   *part   = &interface->part;
  int64_t n_rows, n = 0;
  int32_t status = count ? STICKSLIP_OK : refuse(STICKSLIP_NULL_POINTER, "count is NULL.");
  if (!status && part->handle)
    status = refuse_by_library(interface, stickslip_interface_plan(part->handle, part->x[0], part->x[1], pairs, &n_rows, &n));
  status = agree(interface->comm, status);
  if (status) return status;
  part->planned = 1;
  *count        = n;
  return STICKSLIP_OK;
}

int32_t stickslip_mpi_interface_plan_coo(stickslip_mpi_interface *interface, int64_t capacity, int64_t *rows, int64_t *columns)
{
  stickslip_interface *handle = interface->part.handle;
  accept();
  if (!handle) return STICKSLIP_OK;
  return refuse_by_library(interface, stickslip_interface_plan_coo(handle, STICKSLIP_ENTRIES_TANGENT, capacity, rows, columns));
}

int32_t stickslip_mpi_interface_plan_coo32(stickslip_mpi_interface *interface, int64_t capacity, int32_t *rows, int32_t *columns)
{
  stickslip_interface *handle = interface->part.handle;
  accept();
  if (!handle) return STICKSLIP_OK;
  return refuse_by_library(interface, stickslip_interface_plan_coo32(handle, STICKSLIP_ENTRIES_TANGENT, capacity, rows, columns));
}

int32_t stickslip_mpi_interface_plan_values(stickslip_mpi_interface *interface, int64_t capacity, double *values)
{
  Part   *part   = &interface->part;
  int32_t status = STICKSLIP_OK;
  if (!part->planned)
    status = refuse(STICKSLIP_MISSING_ENTRY, "There is no plan of these parts: make it (again).");
  else if (part->handle)
    status = refuse_by_library(interface, stickslip_interface_plan_values(PLACE_OF(part), capacity, values));
  return agree(interface->comm, status);
}

/* A member of the states: where its pointer is, and what it has a node. */
typedef struct {
  size_t at;
  int    width; /* numbers; 0: a vector's */
} Member;

#define MEMBER(name, width) {offsetof(stickslip_states, name), width}
static const Member MEMBERS[] = {MEMBER(normal, 0), MEMBER(traction, 0), MEMBER(slip, 0), MEMBER(gap, 1), MEMBER(coverage, 1),
                                 MEMBER(area, 1), MEMBER(dissipation, 1), MEMBER(augmentation, 1), MEMBER(share, 1), MEMBER(worn, 1),
                                 MEMBER(worn_volume, 1), MEMBER(damage, 1), MEMBER(bond_loss, 1)};
enum { N_MEMBERS = sizeof(MEMBERS) / sizeof(MEMBERS[0]) };

static double **pointer(const stickslip_states *states, int m)
{
  return (double **)(void *)((char *)(uintptr_t)states + MEMBERS[m].at);
}

static int width_of(const stickslip_mpi_interface *interface, int m)
{
  return MEMBERS[m].width ? MEMBERS[m].width : interface->dimension;
}

/* Collective. From the parts that work on nodes to these nodes' owners. */
static void give(const stickslip_mpi_interface *interface, int64_t bytes, const void *here, void *wanted)
{
  void *own = allocate(interface->whole[0].n_own, (size_t)bytes);
  exchange_give(&interface->part.worked, bytes, here, own);
  if (wanted && interface->whole[0].n_own) memcpy(wanted, own, (size_t)(bytes * interface->whole[0].n_own));
  free(own);
}

int32_t stickslip_mpi_interface_states(stickslip_mpi_interface *interface, const stickslip_states *states)
{
  Part            *part   = &interface->part;
  stickslip_states all    = {.struct_size = sizeof(all)};
  int32_t          status = STICKSLIP_OK;
  int64_t          wanted = 1; /* bits: the states, and the members that any rank wants */
  if (!states || states->struct_size != sizeof(*states))
    status = states ? refuse(STICKSLIP_STRUCT_SIZE, "struct_size of states is %llu; %zu is allowed.", (unsigned long long)states->struct_size,
                             sizeof(*states))
                    : refuse(STICKSLIP_NULL_POINTER, "states is NULL.");
  status = agree(interface->comm, status);
  if (status) return status;
  for (int m = 0; m < N_MEMBERS; m++) wanted |= (int64_t)(*pointer(states, m) != NULL) << (m + 1);
  MPI_Allreduce(MPI_IN_PLACE, &wanted, 1, MPI_INT64_T, MPI_BOR, interface->comm);
  all.state = allocate(part->n_nodes[0], sizeof(*all.state));
  for (int m = 0; m < N_MEMBERS; m++)
    if (wanted >> (m + 1) & 1) *pointer(&all, m) = allocate(width_of(interface, m) * part->n_nodes[0], sizeof(double));
  if (part->handle) status = refuse_by_library(interface, stickslip_interface_states(PLACE_OF(part), &all));
  status = agree(interface->comm, status);
  if (!status) give(interface, sizeof(*all.state), all.state, states->state);
  for (int m = 0; m < N_MEMBERS; m++) {
    if (!status && *pointer(&all, m)) give(interface, width_of(interface, m) * (int64_t)sizeof(double), *pointer(&all, m), *pointer(states, m));
    free(*pointer(&all, m));
  }
  free(all.state);
  return status;
}

int32_t stickslip_mpi_interface_step_limit(stickslip_mpi_interface *interface, const double *dx1, const double *dx2, double penetration,
                                           double *fraction)
{
  Part         *part   = &interface->part;
  const int64_t d      = interface->dimension;
  double       *dx[SIDES], least = 1;
  int32_t       status = STICKSLIP_OK;
  if (!fraction || (interface->whole[0].n_own && !dx1) || (interface->whole[1].n_own && !dx2))
    status = refuse(STICKSLIP_NULL_POINTER, "dx1, dx2 and fraction must not be NULL.");
  status = agree(interface->comm, status);
  if (status) return status;
  for (int s = 0; s < SIDES; s++) {
    dx[s] = allocate(d * part->n_nodes[s], sizeof(**dx));
    exchange_bring(&part->copies[s], d * (int64_t)sizeof(double), s ? dx2 : dx1, dx[s]);
  }
  if (part->handle)
    status = refuse_by_library(interface,
                               stickslip_interface_step_limit(part->handle, part->x[0], part->x[1], dx[0], dx[1], penetration, &least));
  for (int s = 0; s < SIDES; s++) free(dx[s]);
  status = agree(interface->comm, status);
  if (status) return status;
  MPI_Allreduce(&least, fraction, 1, MPI_DOUBLE, MPI_MIN, interface->comm);
  return STICKSLIP_OK;
}
