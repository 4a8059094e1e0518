/* Steps that are accepted or undone on all ranks, and what a restart needs of them. */
#include "internal.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Between steps parts get new mortar facets where less than this part of the margin is left. */
static const double SPARE = 0.5;

void state_destroy(State *state)
{
  for (int s = 0; s < SIDES; s++) {
    free(state->x[s]);
    free(state->offsets[s]);
  }
  free(state->slip);
  *state = (State){0};
}

/* Of the own nodes, with the offsets of now; the arrays may be the state's own. */
void state_set(const stickslip_mpi_interface *interface, int64_t commits, const double *x1, const double *x2, const double *slip,
               State *state)
{
  const int64_t d = interface->dimension, n1 = interface->whole[0].n_own, n2 = interface->whole[1].n_own;
  State         made = {.commits = commits,
                        .x       = {copied(x1, d * n1, sizeof(double)), copied(x2, d * n2, sizeof(double))},
                        .slip    = copied(slip, d * n1, sizeof(double))};
  for (int s = 0; s < SIDES; s++)
    if (interface->offsets[s]) made.offsets[s] = copied(interface->offsets[s], interface->whole[s].n_own, sizeof(double));
  state_destroy(state);
  *state = made;
}

/* Collective. New parts at t_n; where the library refuses, those of now go on. */
static void renew_at_t_n(stickslip_mpi_interface *interface, int64_t *count)
{
  const At at = {{interface->t_n.x[0], interface->t_n.x[1]}};
  if (!parts_renew(interface, &interface->t_n, &at)) ++*count;
}

/* Collective. Other shares, where those of now are no longer balanced by what covers the own nodes. */
int32_t balance(stickslip_mpi_interface *interface, const double coverage[])
{
  int32_t      *before;
  const int64_t n = interface->rebalanced;
  if (!shares_better(interface, coverage, &before)) return STICKSLIP_OK;
  renew_at_t_n(interface, &interface->rebalanced);
  if (interface->rebalanced == n) {
    free(interface->worker);
    interface->worker = before;
  } else {
    free(before);
  }
  return STICKSLIP_OK;
}

/* Collective. After a commit: slip and coverage at the own nodes; parts for what comes. */
static int32_t settle(stickslip_mpi_interface *interface)
{
  const int64_t    d = interface->dimension, n = interface->whole[0].n_own, rebalanced = interface->rebalanced;
  double          *slip = allocate(d * n, sizeof(*slip)), *coverage = allocate(n, sizeof(*coverage));
  stickslip_states states = {.struct_size = sizeof(states), .slip = slip, .coverage = coverage};
  int32_t          status = stickslip_mpi_interface_states(interface, &states);
  if (!status) {
    state_destroy(&interface->before);
    interface->before = interface->t_n;
    interface->t_n    = (State){0};
    state_set(interface, interface->before.commits + 1, interface->x[0], interface->x[1], slip, &interface->t_n);
    interface->undoable = interface->native = 1;
    halo_settle(interface, &interface->part, &interface->t_n, &interface->halo);
    balance(interface, coverage);
    if (interface->rebalanced == rebalanced && !halo_covers(interface, SPARE)) renew_at_t_n(interface, &interface->renewed);
    accept();
  }
  free(coverage);
  free(slip);
  return status;
}

int32_t stickslip_mpi_interface_commit(stickslip_mpi_interface *interface)
{
  const Part *part = &interface->part;
  int32_t     own  = STICKSLIP_OK, status;
  if (part->handle) own = stickslip_interface_commit(part->handle, part->x[0], part->x[1], part->lambda, NULL);
  status = agree(interface->comm, refuse_by_library(interface, own));
  if (!status) status = settle(interface);
  if (status) { /* the parts that have committed go back; the commit before it is known, if not to them */
    interface->native = 0;
    if (part->handle && !own) (void)stickslip_interface_rollback(part->handle);
  }
  return status;
}

int32_t stickslip_mpi_interface_rollback(stickslip_mpi_interface *interface)
{
  const At at     = {{interface->before.x[0], interface->before.x[1]}};
  int32_t  status = STICKSLIP_OK;
  if (!interface->undoable) return agree(interface->comm, refuse(STICKSLIP_NOTHING_TO_ROLL_BACK, "There is no commit to roll back."));
  if (interface->native) {
    if (interface->part.handle) status = stickslip_interface_rollback(interface->part.handle);
    status = agree(interface->comm, refuse_by_library(interface, status));
  } else {
    status = parts_renew(interface, &interface->before, &at);
  }
  if (status) return status;
  state_destroy(&interface->t_n);
  interface->t_n      = interface->before;
  interface->before   = (State){0};
  interface->undoable = interface->native = 0;
  halo_settle(interface, &interface->part, &interface->t_n, &interface->halo);
  return STICKSLIP_OK;
}

static int32_t check(const stickslip_mpi_history *history)
{
  if (!history) return refuse(STICKSLIP_NULL_POINTER, "history is NULL.");
  if (history->struct_size != sizeof(*history))
    return refuse(STICKSLIP_STRUCT_SIZE, "struct_size of history is %" PRIu64 "; %zu is allowed.", history->struct_size, sizeof(*history));
  return STICKSLIP_OK;
}

int32_t stickslip_mpi_interface_history_export(const stickslip_mpi_interface *interface, stickslip_mpi_history *history)
{
  const State *t_n    = &interface->t_n;
  const size_t bytes1 = (size_t)(interface->dimension * interface->whole[0].n_own) * sizeof(double);
  const size_t bytes2 = (size_t)(interface->dimension * interface->whole[1].n_own) * sizeof(double);
  int32_t      status;
  accept();
  status = check(history);
  if (!status && ((bytes1 && (!history->x1 || !history->slip)) || (bytes2 && !history->x2)))
    status = refuse(STICKSLIP_NULL_POINTER, "x1, x2 and slip of history must not be NULL.");
  if (status) return status;
  history->commits = t_n->commits;
  if (bytes1) memcpy(history->x1, t_n->x[0], bytes1);
  if (bytes1) memcpy(history->slip, t_n->slip, bytes1);
  if (bytes2) memcpy(history->x2, t_n->x[1], bytes2);
  return STICKSLIP_OK;
}

int32_t stickslip_mpi_interface_history_import(stickslip_mpi_interface *interface, const stickslip_mpi_history *history)
{
  int32_t status = check(history);
  int64_t range[2];
  State   before = interface->t_n;
  if (!status && ((interface->whole[0].n_own && (!history->x1 || !history->slip)) || (interface->whole[1].n_own && !history->x2)))
    status = refuse(STICKSLIP_NULL_POINTER, "x1, x2 and slip of history must not be NULL.");
  status = agree(interface->comm, status);
  if (status) return status;
  range[0] = history->commits;
  range[1] = -history->commits;
  MPI_Allreduce(MPI_IN_PLACE, range, 2, MPI_INT64_T, MPI_MAX, interface->comm);
  if (history->commits < 0 || range[0] != -range[1])
    status = refuse(STICKSLIP_INVALID_VALUE, "commits of history are %" PRId64 " to %" PRId64 "; one number of 0 or more is allowed.",
                    -range[1], range[0]);
  status = agree(interface->comm, status);
  if (status) return status;
  interface->t_n = (State){0};
  state_set(interface, history->commits, history->x1, history->x2, history->slip, &interface->t_n);
  {
    const At at = {{interface->t_n.x[0], interface->t_n.x[1]}};
    status      = parts_renew(interface, &interface->t_n, &at);
  }
  if (status) {
    state_destroy(&interface->t_n);
    interface->t_n = before;
    return status;
  }
  state_destroy(&before);
  state_destroy(&interface->before);
  interface->undoable = 0;
  return STICKSLIP_OK;
}
