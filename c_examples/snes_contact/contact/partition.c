/* Which rank owns which non-mortar nodes: recursive bisection across the direction in which the work is spread most, into halves
 * of equal work. Nodes follow each other on lines of equal coordinates, so that parts are compact on regular meshes, too. */
#include "contact/contact.h"

/* Spreads that differ by less are alike: the first direction is taken. */
static const double ALIKE = 1e-9;

typedef struct {
  PetscInt      dimension, axis;
  const double *x, *work; /* of each node */
} Order;

/* along the axis, then along the others, then by number */
static int compare(const void *a, const void *b, void *context)
{
  const Order   *order = context;
  const PetscInt one = *(const PetscInt *)a, two = *(const PetscInt *)b;
  for (PetscInt k = 0; k < order->dimension; k++) {
    const PetscInt i = (order->axis + k) % order->dimension;
    const double   p = order->x[order->dimension * one + i], q = order->x[order->dimension * two + i];
    if (p != q) return p < q ? -1 : 1;
  }
  return one < two ? -1 : one > two;
}

/* across which the work is spread most: the largest sum of squares of distances from the centre */
static PetscInt widest_axis(const Order *order, PetscInt n, const PetscInt nodes[])
{
  PetscInt axis   = 0;
  double   widest = -1;
  for (PetscInt i = 0; i < order->dimension; i++) {
    double work = 0, centre = 0, spread = 0;
    for (PetscInt k = 0; k < n; k++) {
      work += order->work[nodes[k]];
      centre += order->work[nodes[k]] * order->x[order->dimension * nodes[k] + i];
    }
    for (PetscInt k = 0; k < n; k++)
      spread += order->work[nodes[k]] * PetscSqr(order->x[order->dimension * nodes[k] + i] - centre / work);
    /* rounding does not choose */
    if (spread > (1 + ALIKE) * widest) widest = spread, axis = i;
  }
  return axis;
}

/* how many of the nodes, in their order, have the first `part` of the work */
static PetscInt find_cut(const Order *order, PetscInt n, const PetscInt nodes[], double part)
{
  double   all = 0, some = 0;
  PetscInt cut = 0;
  for (PetscInt k = 0; k < n; k++)
    all += order->work[nodes[k]];
  while (cut < n && some + order->work[nodes[cut]] / 2 < part * all)
    some += order->work[nodes[cut++]];
  return cut;
}

static PetscErrorCode bisect(Order *order, PetscInt n, PetscInt nodes[], PetscMPIInt first, PetscMPIInt n_ranks,
                             PetscInt owner[])
{
  const PetscMPIInt half = n_ranks / 2;
  PetscInt          cut;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < n && n_ranks == 1; k++)
    owner[nodes[k]] = first;
  if (n_ranks == 1) PetscFunctionReturn(PETSC_SUCCESS);
  order->axis = widest_axis(order, n, nodes);
  if (n > 1) PetscCall(PetscTimSort(n, nodes, sizeof(*nodes), compare, order)); /* of none it compares two */
  cut = find_cut(order, n, nodes, (double)half / n_ranks);
  PetscCall(bisect(order, cut, nodes, first, half, owner));
  PetscCall(bisect(order, n - cut, nodes + cut, first + half, n_ranks - half, owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode partition_nodes(PetscInt dimension, PetscInt n, const double coordinates[], const double work[],
                               PetscMPIInt n_ranks, PetscInt owner[])
{
  Order     order = {.dimension = dimension, .x = coordinates, .work = work};
  PetscInt *nodes;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &nodes));
  for (PetscInt a = 0; a < n; a++)
    nodes[a] = a;
  PetscCall(bisect(&order, n, nodes, 0, n_ranks, owner));
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
