/* Which rank owns which non-mortar nodes: recursive bisection across the direction in which the work is spread most, into halves
 * of equal work. Nodes follow each other on lines of equal coordinates, so that parts are compact on regular meshes, too. Each rank has
 * some of the nodes, and nobody all: where to cut is found as a weighted median of all ranks. */
#include "contact/contact.h"

/* Spreads that differ by less are alike: the first direction is taken. */
static const double ALIKE = 1e-9;

/* A node as others compare it with theirs. */
typedef struct {
  double x[3], number, work, many; /* many: how many nodes it stands for */
} Key;

typedef struct {
  MPI_Comm      comm;
  PetscMPIInt   size;
  PetscInt      dimension, axis, first; /* number of the first node here */
  const double *x, *work; /* of each node */
  Key          *proposed; /* one of each rank */
} Order;

static int compare_keys(const Order *order, const Key *p, const Key *q)
{
  for (PetscInt k = 0; k < order->dimension; k++) {
    const PetscInt i = (order->axis + k) % order->dimension;
    if (p->x[i] != q->x[i]) return p->x[i] < q->x[i] ? -1 : 1;
  }
  return p->number < q->number ? -1 : p->number > q->number;
}

static Key key_of(const Order *order, PetscInt node)
{
  Key key = {.number = (double)(order->first + node), .work = order->work[node]};
  for (PetscInt i = 0; i < order->dimension; i++)
    key.x[i] = order->x[order->dimension * node + i];
  return key;
}

/* along the axis, then along the others, then by number */
static int compare(const void *a, const void *b, void *context)
{
  const Key p = key_of(context, *(const PetscInt *)a), q = key_of(context, *(const PetscInt *)b);
  return compare_keys(context, &p, &q);
}

/* across which the work is spread most: the largest sum of squares of distances from the centre */
static PetscErrorCode widest_axis(const Order *order, PetscInt n, const PetscInt nodes[], PetscInt *axis)
{
  double sums[4] = {0, 0, 0, 0}, spread[3] = {0, 0, 0}, widest = -1;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; k++) {
    sums[3] += order->work[nodes[k]];
    for (PetscInt i = 0; i < order->dimension; i++)
      sums[i] += order->work[nodes[k]] * order->x[order->dimension * nodes[k] + i];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 4, MPI_DOUBLE, MPI_SUM, order->comm));
  for (PetscInt k = 0; k < n; k++) {
    for (PetscInt i = 0; i < order->dimension; i++)
      spread[i] += order->work[nodes[k]] * PetscSqr(order->x[order->dimension * nodes[k] + i] - sums[i] / sums[3]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, spread, 3, MPI_DOUBLE, MPI_SUM, order->comm));
  *axis = 0;
  for (PetscInt i = 0; i < order->dimension; i++) {
    /* rounding does not choose */
    if (spread[i] > (1 + ALIKE) * widest) widest = spread[i], *axis = i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first of some nodes in order that do not come before the pivot. */
static PetscInt first_from(const Order *order, PetscInt low, PetscInt high, const PetscInt nodes[], const Key *pivot)
{
  while (low < high) {
    const PetscInt middle = (low + high) / 2;
    const Key      key    = key_of(order, nodes[middle]);
    if (compare_keys(order, &key, pivot) < 0)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* A pivot amid the nodes that are still in question: of each rank its middle one, and of these the median by how many they stand for. */
static PetscErrorCode choose_pivot(const Order *order, PetscInt low, PetscInt high, const PetscInt nodes[], Key *pivot, PetscBool *any)
{
  Key    mine = {.many = 0};
  double least = 0, all = 0;
  PetscFunctionBegin;
  if (low < high) mine = key_of(order, nodes[(low + high) / 2]);
  mine.many = (double)(high - low);
  PetscCallMPI(MPI_Allgather(&mine, sizeof(Key), MPI_BYTE, order->proposed, sizeof(Key), MPI_BYTE, order->comm));
  for (PetscMPIInt r = 0; r < order->size; r++)
    all += order->proposed[r].many;
  *any = (PetscBool)(all > 0);
  for (PetscMPIInt r = 0; r < order->size && *any; r++) { /* the one that half of all come up to */
    const Key *candidate = &order->proposed[r];
    double     upto      = 0;
    for (PetscMPIInt s = 0; s < order->size && candidate->many > 0; s++) {
      if (compare_keys(order, &order->proposed[s], candidate) <= 0) upto += order->proposed[s].many;
    }
    if (2 * upto >= all && (least == 0 || upto < least)) least = upto, *pivot = *candidate;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many of the nodes here, in their order, are among the first `part` of the work of all. */
static PetscErrorCode find_cut(const Order *order, PetscInt n, const PetscInt nodes[], double part, PetscInt *cut)
{
  PetscInt  low = 0, high = n; /* those before `low` are among them, those from `high` on are not */
  double   *before, all;
  PetscBool any;
  Key       pivot = {.many = 0};
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n + 1, &before));
  before[0] = 0;
  for (PetscInt k = 0; k < n; k++)
    before[k + 1] = before[k] + order->work[nodes[k]];
  all = before[n];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_DOUBLE, MPI_SUM, order->comm));
  for (;;) {
    PetscInt at;
    double   some;
    PetscCall(choose_pivot(order, low, high, nodes, &pivot, &any));
    if (!any) break;
    at   = first_from(order, low, high, nodes, &pivot);
    some = before[at];
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &some, 1, MPI_DOUBLE, MPI_SUM, order->comm));
    if (some + pivot.work / 2 < part * all) { /* the pivot is among them */
      low = at;
      if (at < high) {
        const Key key = key_of(order, nodes[at]);
        low += compare_keys(order, &key, &pivot) == 0;
      }
    } else {
      high = at;
    }
  }
  *cut = low;
  PetscCall(PetscFree(before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode bisect(Order *order, PetscInt n, PetscInt nodes[], PetscMPIInt first, PetscMPIInt n_parts, PetscInt owner[])
{
  const PetscMPIInt half = n_parts / 2;
  PetscInt          cut;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < n && n_parts == 1; k++)
    owner[nodes[k]] = first;
  if (n_parts == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(widest_axis(order, n, nodes, &order->axis));
  if (n > 1) PetscCall(PetscTimSort(n, nodes, sizeof(*nodes), compare, order)); /* of none it compares two */
  PetscCall(find_cut(order, n, nodes, (double)half / n_parts, &cut));
  PetscCall(bisect(order, cut, nodes, first, half, owner));
  PetscCall(bisect(order, n - cut, nodes + cut, first + half, n_parts - half, owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode partition_nodes(MPI_Comm comm, PetscInt dimension, PetscInt n, PetscInt first, const double coordinates[],
                               const double work[], PetscMPIInt n_parts, PetscInt owner[])
{
  Order     order = {.comm = comm, .dimension = dimension, .first = first, .x = coordinates, .work = work};
  PetscInt *nodes;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &order.size));
  PetscCall(PetscMalloc1(n, &nodes));
  PetscCall(PetscMalloc1(order.size, &order.proposed));
  for (PetscInt a = 0; a < n; a++)
    nodes[a] = a;
  PetscCall(bisect(&order, n, nodes, 0, n_parts, owner));
  PetscCall(PetscFree(nodes));
  PetscCall(PetscFree(order.proposed));
  PetscFunctionReturn(PETSC_SUCCESS);
}
