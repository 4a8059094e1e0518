/* Whether the interface is in contact equilibrium: the worst that any part finds, with tractions compared with the largest of all parts. */
#include "internal.h"
#include <stdlib.h>

/* A violation, what to compare it with, and its node, as members of the library's answer. */
typedef struct {
  size_t value, scale, node;
} Finding;

#define AT(name) offsetof(stickslip_equilibrium, name)
#define FINDING(name, scale) {AT(name), AT(scale), AT(name##_node)}
/* `turn` is an angle: it has no scale, and stands for its own. */
static const Finding FINDINGS[] = {FINDING(gap, gap_scale), FINDING(traction, traction_scale), FINDING(slip, slip_scale),
                                   FINDING(slide, slide_scale), FINDING(lag, traction_scale), FINDING(penetration, penetration_scale),
                                   FINDING(apart, apart_scale), FINDING(turn, turn)};
enum { N_FINDINGS = sizeof(FINDINGS) / sizeof(FINDINGS[0]), TURN = N_FINDINGS - 1 };

static double *real(const stickslip_equilibrium *e, size_t at)
{
  return (double *)(void *)((char *)(uintptr_t)e + at);
}

static int64_t *node(const stickslip_equilibrium *e, size_t at)
{
  return (int64_t *)(void *)((char *)(uintptr_t)e + at);
}

/* Is what `a` finds worse than what `b` does? Where nothing is violated the smaller scale counts; of equals the first node, as in one
 * handle. */
static int is_worse(int k, const stickslip_equilibrium *a, const stickslip_equilibrium *b)
{
  const double va = *real(a, FINDINGS[k].value), sa = *real(a, FINDINGS[k].scale);
  const double vb = *real(b, FINDINGS[k].value), sb = *real(b, FINDINGS[k].scale);
  const int    first = *node(a, FINDINGS[k].node) < *node(b, FINDINGS[k].node);
  if (va == 0 && vb == 0) return k != TURN && sa < sb;
  if (k == TURN) return va > vb || (va == vb && first);
  return va * sb > vb * sa || (va * sb == vb * sa && first);
}

/* Of a part, its nodes by the host's numbers. */
static void number(const stickslip_mpi_interface *interface, stickslip_equilibrium *e)
{
  const Part *part = &interface->part;
  for (int k = 0; k < N_FINDINGS; k++) {
    int64_t      *of    = node(e, FINDINGS[k].node);
    const int64_t local = *of - interface->options.index_base;
    if (*of >= 0 && local >= 0 && local < part->n_nodes[0]) *of = interface->whole[0].numbers[part->nodes[0][local]];
  }
}

/* The parts' answers to one. */
static void join(int n, const stickslip_equilibrium all[], const int has[], stickslip_equilibrium *out)
{
  int first = 1;
  for (int r = 0; r < n; r++) {
    if (!has[r]) continue;
    if (first) {
      *out  = all[r];
      first = 0;
      continue;
    }
    for (int k = 0; k < N_FINDINGS; k++) {
      if (!is_worse(k, &all[r], out)) continue;
      *real(out, FINDINGS[k].value) = *real(&all[r], FINDINGS[k].value);
      *real(out, FINDINGS[k].scale) = *real(&all[r], FINDINGS[k].scale);
      *node(out, FINDINGS[k].node)  = *node(&all[r], FINDINGS[k].node);
    }
    out->lag_force += all[r].lag_force;
    out->lag_force_scale += all[r].lag_force_scale;
  }
}

int32_t stickslip_mpi_interface_equilibrium(stickslip_mpi_interface *interface, stickslip_equilibrium *out)
{
  Part                  *part = &interface->part;
  const int              has  = part->handle != NULL;
  stickslip_equilibrium  mine, *all;
  double                 largest;
  int                   *there;
  int32_t                status = STICKSLIP_OK;
  if (!out || out->struct_size != sizeof(*out))
    status = out ? refuse(STICKSLIP_STRUCT_SIZE, "struct_size of out is %llu; %zu is allowed.", (unsigned long long)out->struct_size, sizeof(*out))
                 : refuse(STICKSLIP_NULL_POINTER, "out is NULL.");
  status = agree(interface->comm, status);
  if (status) return status;
  largest = out->least_traction;
  for (int pass = 0; pass < (interface->size > 1 ? 2 : 1); pass++) {
    mine = (stickslip_equilibrium){.struct_size = sizeof(mine), .modulus = out->modulus, .least_traction = largest};
    if (has) status = refuse_by_library(interface, stickslip_interface_equilibrium(part->handle, part->x[0], part->x[1], part->lambda, NULL, &mine));
    status = agree(interface->comm, status);
    if (status) return status;
    largest = mine.traction_scale;
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, interface->comm);
  }
  if (has) number(interface, &mine);
  all   = allocate(interface->size, sizeof(*all));
  there = allocate(interface->size, sizeof(*there));
  MPI_Allgather(&mine, (int)sizeof(mine), MPI_BYTE, all, (int)sizeof(mine), MPI_BYTE, interface->comm);
  MPI_Allgather(&has, 1, MPI_INT, there, 1, MPI_INT, interface->comm);
  {
    const double least = out->least_traction;
    join(interface->size, all, there, out);
    out->least_traction = least;
  }
  free(there);
  free(all);
  return STICKSLIP_OK;
}
