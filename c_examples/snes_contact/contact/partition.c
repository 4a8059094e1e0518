/* Which rank owns which non-mortar nodes: recursive bisection across the longest extent. Halves differ by one node where ranks
 * are a power of two, and follow each other on lines of equal coordinates, so that parts are compact on regular meshes, too. */
#include "contact/contact.h"

typedef struct {
  PetscInt      dimension, axis;
  const double *x;
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

static PetscInt longest_axis(const Order *order, PetscInt n, const PetscInt nodes[])
{
  PetscInt axis    = 0;
  double   longest = -1;
  for (PetscInt i = 0; i < order->dimension; i++) {
    double low = PETSC_MAX_REAL, high = -PETSC_MAX_REAL;
    for (PetscInt k = 0; k < n; k++) {
      low  = PetscMin(low, order->x[order->dimension * nodes[k] + i]);
      high = PetscMax(high, order->x[order->dimension * nodes[k] + i]);
    }
    if (high - low > longest) longest = high - low, axis = i;
  }
  return axis;
}

static PetscErrorCode bisect(Order *order, PetscInt n, PetscInt nodes[], PetscMPIInt first, PetscMPIInt n_ranks,
                             PetscInt owner[])
{
  const PetscMPIInt half = n_ranks / 2;
  const PetscInt    cut  = (PetscInt)((PetscInt64)n * half / n_ranks);
  PetscFunctionBegin;
  for (PetscInt k = 0; k < n && n_ranks == 1; k++)
    owner[nodes[k]] = first;
  if (n_ranks == 1) PetscFunctionReturn(PETSC_SUCCESS);
  order->axis = longest_axis(order, n, nodes);
  PetscCall(PetscTimSort(n, nodes, sizeof(*nodes), compare, order));
  PetscCall(bisect(order, cut, nodes, first, half, owner));
  PetscCall(bisect(order, n - cut, nodes + cut, first + half, n_ranks - half, owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode partition_nodes(PetscInt dimension, PetscInt n, const double coordinates[], PetscMPIInt n_ranks,
                               PetscInt owner[])
{
  Order     order = {.dimension = dimension, .x = coordinates};
  PetscInt *nodes;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &nodes));
  for (PetscInt a = 0; a < n; a++)
    nodes[a] = a;
  PetscCall(bisect(&order, n, nodes, 0, n_ranks, owner));
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
