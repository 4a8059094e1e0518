/* Whole surfaces, gathered on every rank: numbers, owners, coordinates of the first configuration and facets. That is 66 bytes a
 * facet of quadrilaterals, a thirtieth of what a handle keeps of it, and spares all talk between ranks when parts are cut. Positions and
 * forces stay where they are. */
#include "internal.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char *const NAMES[SIDES] = {"nonmortar", "mortar"};

/* A number of a side, and where it came from. */
typedef struct {
  int64_t number;
  int32_t owner, place;
} Entry;

static int by_number(const void *a, const void *b)
{
  const int64_t x = ((const Entry *)a)->number, y = ((const Entry *)b)->number;
  return (x > y) - (x < y);
}

/* A facet to be put in order: its nodes sorted, and as they were given. */
typedef struct {
  const int64_t *sorted, *given;
  int64_t        n;
} Facet;

static int by_nodes(const void *a, const void *b)
{
  const Facet *x = a, *y = b;
  for (int64_t k = 0; k < x->n && k < y->n; k++)
    if (x->sorted[k] != y->sorted[k]) return x->sorted[k] < y->sorted[k] ? -1 : 1;
  return (x->n > y->n) - (x->n < y->n);
}

static int by_value(const void *a, const void *b)
{
  const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
  return (x > y) - (x < y);
}

static int32_t check(const stickslip_mpi_share *share, int side)
{
  const char *name = NAMES[side];
  if (!share) return refuse(STICKSLIP_NULL_POINTER, "%s is NULL.", name);
  if (share->struct_size != sizeof(*share))
    return refuse(STICKSLIP_STRUCT_SIZE, "struct_size of %s is %" PRIu64 "; %zu is allowed.", name, share->struct_size, sizeof(*share));
  if (share->n_nodes < 0 || share->n_facets < 0)
    return refuse(STICKSLIP_INVALID_SIZE, "%s has %" PRId64 " nodes and %" PRId64 " facets; 0 or more are allowed.", name,
                  share->n_nodes, share->n_facets);
  if (share->n_nodes && (!share->nodes || !share->coordinates || !share->equations || (side == 0 && !share->multiplier_equations)))
    return refuse(STICKSLIP_NULL_POINTER, "nodes, coordinates, equations%s of %s must not be NULL.",
                  side ? "" : ", multiplier_equations", name);
  if (side == 1 && share->multiplier_equations) return refuse(STICKSLIP_INVALID_VALUE, "multiplier_equations of mortar must be NULL.");
  if (!share->n_facets) return STICKSLIP_OK;
  if (!share->facet_offsets || !share->facet_nodes)
    return refuse(STICKSLIP_NULL_POINTER, "facet_offsets and facet_nodes of %s must not be NULL.", name);
  for (int64_t f = 0; f < share->n_facets; f++)
    if (share->facet_offsets[0] || share->facet_offsets[f + 1] < share->facet_offsets[f])
      return refuse(STICKSLIP_INVALID_SIZE, "facet_offsets of %s must begin with 0 and not decrease; they do at facet %" PRId64 ".",
                    name, f);
  return STICKSLIP_OK;
}

/* `n` items of `bytes` each from every rank, one after the other; counts how many from each. */
static void *gather(MPI_Comm comm, int64_t n, size_t bytes, const void *mine, int **counts, int64_t *total)
{
  int          size, here = (int)n, *starts;
  void        *all;
  MPI_Datatype item;
  MPI_Comm_size(comm, &size);
  *counts = allocate(size, sizeof(**counts));
  starts  = allocate(size + 1, sizeof(*starts));
  MPI_Allgather(&here, 1, MPI_INT, *counts, 1, MPI_INT, comm);
  for (int r = 0; r < size; r++) starts[r + 1] = starts[r] + (*counts)[r];
  *total = starts[size];
  all    = allocate(*total, bytes);
  MPI_Type_contiguous((int)bytes, MPI_BYTE, &item);
  MPI_Type_commit(&item);
  MPI_Allgatherv(mine, here, item, all, *counts, starts, item, comm);
  MPI_Type_free(&item);
  free(starts);
  return all;
}

int64_t whole_find(const Whole *whole, int64_t number)
{
  int64_t low = 0, high = whole->n_nodes;
  while (low < high) {
    const int64_t middle = (low + high) / 2;
    if (whole->numbers[middle] < number)
      low = middle + 1;
    else
      high = middle;
  }
  return low < whole->n_nodes && whole->numbers[low] == number ? low : -1;
}

/* Nodes in the order of their numbers. The refusals below are the same everywhere, for all have the same. */
static int32_t gather_nodes(MPI_Comm comm, const stickslip_mpi_share *share, int side, Whole *whole)
{
  int      rank, size, *counts;
  int64_t *numbers = gather(comm, share->n_nodes, sizeof(*numbers), share->nodes, &counts, &whole->n_nodes), k = 0;
  Entry   *entries = allocate(whole->n_nodes, sizeof(*entries));
  int32_t  status  = STICKSLIP_OK;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  for (int r = 0; r < size; r++)
    for (int32_t place = 0; place < counts[r]; place++, k++) entries[k] = (Entry){numbers[k], r, place};
  qsort(entries, (size_t)whole->n_nodes, sizeof(*entries), by_number);
  whole->numbers = numbers;
  whole->owners  = allocate(whole->n_nodes, sizeof(*whole->owners));
  whole->places  = allocate(whole->n_nodes, sizeof(*whole->places));
  whole->n_own   = share->n_nodes;
  whole->own     = allocate(whole->n_own, sizeof(*whole->own));
  for (k = 0; k < whole->n_nodes; k++) {
    whole->numbers[k] = entries[k].number;
    whole->owners[k]  = entries[k].owner;
    whole->places[k]  = entries[k].place;
    if (entries[k].owner == rank) whole->own[entries[k].place] = (int32_t)k;
    if (k && entries[k].number == entries[k - 1].number && !status)
      status = refuse(STICKSLIP_INVALID_VALUE, "%s: node %" PRId64 " is owned by ranks %d and %d; one owner is allowed.", NAMES[side],
                      entries[k].number, (int)entries[k - 1].owner, (int)entries[k].owner);
  }
  free(entries);
  free(counts);
  return status;
}

/* Facets in the order of their nodes. */
static int32_t gather_facets(MPI_Comm comm, const stickslip_mpi_share *share, int side, Whole *whole)
{
  const int64_t n_mine = share->n_facets ? share->facet_offsets[share->n_facets] : 0;
  int64_t      *lengths = allocate(share->n_facets, sizeof(*lengths)), *all_lengths, *given, *sorted, n, at = 0;
  int          *counts;
  Facet        *facets;
  int32_t       status = STICKSLIP_OK;
  for (int64_t f = 0; f < share->n_facets; f++) lengths[f] = share->facet_offsets[f + 1] - share->facet_offsets[f];
  all_lengths = gather(comm, share->n_facets, sizeof(*lengths), lengths, &counts, &whole->n_facets);
  free(counts);
  given = gather(comm, n_mine, sizeof(*given), share->facet_nodes, &counts, &n);
  free(counts);
  sorted = copied(given, n, sizeof(*given));
  facets = allocate(whole->n_facets, sizeof(*facets));
  for (int64_t f = 0; f < whole->n_facets; at += all_lengths[f++]) {
    qsort(sorted + at, (size_t)all_lengths[f], sizeof(*sorted), by_value);
    facets[f] = (Facet){sorted + at, given + at, all_lengths[f]};
  }
  qsort(facets, (size_t)whole->n_facets, sizeof(*facets), by_nodes);
  whole->offsets = allocate(whole->n_facets + 1, sizeof(*whole->offsets));
  whole->nodes   = allocate(n, sizeof(*whole->nodes));
  for (int64_t f = 0; f < whole->n_facets && !status; f++) {
    whole->offsets[f + 1] = whole->offsets[f] + facets[f].n;
    if (f && !by_nodes(&facets[f - 1], &facets[f]))
      status = refuse(STICKSLIP_INVALID_VALUE, "%s: the facet of the nodes %" PRId64 ", %" PRId64 ", ... is given twice; once is allowed.",
                      NAMES[side], facets[f].given[0], facets[f].n > 1 ? facets[f].given[1] : 0);
    for (int64_t k = 0; k < facets[f].n && !status; k++) {
      const int64_t found = whole_find(whole, facets[f].given[k]);
      if (found < 0)
        status = refuse(STICKSLIP_INVALID_VALUE, "%s: node %" PRId64 " of a facet is owned by no rank; one is needed.", NAMES[side],
                        facets[f].given[k]);
      whole->nodes[whole->offsets[f] + k] = (int32_t)found;
    }
  }
  free(facets);
  free(sorted);
  free(given);
  free(all_lengths);
  free(lengths);
  return status;
}

double *whole_values(MPI_Comm comm, const Whole *whole, int width, const double own[])
{
  int      rank, size, *counts;
  int64_t  n, *starts;
  double  *all = gather(comm, whole->n_own, (size_t)width * sizeof(double), own, &counts, &n), *values;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  values = allocate(width * n, sizeof(*values));
  starts = allocate(size + 1, sizeof(*starts));
  for (int r = 0; r < size; r++) starts[r + 1] = starts[r] + counts[r];
  for (int64_t k = 0; k < n; k++)
    memcpy(values + width * k, all + width * (starts[whole->owners[k]] + whole->places[k]), (size_t)width * sizeof(*values));
  free(starts);
  free(counts);
  free(all);
  return values;
}

int32_t whole_gather(MPI_Comm comm, const stickslip_mpi_share *share, int side, int dimension, Whole *whole)
{
  const int32_t status = agree(comm, check(share, side));
  int64_t       n;
  if (status) return status;
  n = share->n_nodes;
  MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPI_INT64_T, MPI_SUM, comm);
  if (n > INT32_MAX) return refuse(STICKSLIP_INDEX_OUT_OF_RANGE, "%s has %" PRId64 " nodes; 2^31 - 1 are allowed.", NAMES[side], n);
  {
    const int32_t refused = gather_nodes(comm, share, side, whole);
    if (refused) return refused;
  }
  whole->X = whole_values(comm, whole, dimension, share->coordinates);
  return gather_facets(comm, share, side, whole);
}

void whole_destroy(Whole *whole)
{
  free(whole->numbers);
  free(whole->owners);
  free(whole->places);
  free(whole->X);
  free(whole->offsets);
  free(whole->nodes);
  free(whole->own);
}

int64_t whole_bytes(const Whole *whole, int dimension)
{
  const int64_t corners = whole->offsets ? whole->offsets[whole->n_facets] : 0;
  return whole->n_nodes * (int64_t)(sizeof(int64_t) + 2 * sizeof(int32_t) + (size_t)dimension * sizeof(double)) +
         (whole->n_facets + 1) * (int64_t)sizeof(int64_t) + corners * (int64_t)sizeof(int32_t);
}
