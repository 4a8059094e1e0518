/* Values of nodes between the ranks that own them and those that have copies: messages between neighbours alone. Sums go in the order
 * of ranks, so that they are the same in every run. */
#include "internal.h"
#include <stdlib.h>
#include <string.h>

enum { TAG = 7 };

/* ranks with a count, and where theirs begins */
static int peers(int size, const int counts[], int **ranks, int64_t **starts)
{
  int n = 0;
  for (int r = 0; r < size; r++) n += counts[r] > 0;
  *ranks  = allocate(n, sizeof(**ranks));
  *starts = allocate(n + 1, sizeof(**starts));
  n       = 0;
  for (int r = 0; r < size; r++) {
    if (!counts[r]) continue;
    (*ranks)[n]      = r;
    (*starts)[n + 1] = (*starts)[n] + counts[r];
    n++;
  }
  return n;
}

/* Item k is at places[k] of owners[k]'s share, and here at here[k] (NULL: k). */
void exchange_create(MPI_Comm comm, int64_t n, const int32_t owners[], const int32_t places[], const int32_t here[], Exchange *exchange)
{
  int          size, *counts, *theirs;
  int32_t     *asked;
  int64_t     *next;
  MPI_Request *requests;
  MPI_Comm_size(comm, &size);
  counts = allocate(size, sizeof(*counts));
  theirs = allocate(size, sizeof(*theirs));
  for (int64_t k = 0; k < n; k++) counts[owners[k]]++;
  MPI_Alltoall(counts, 1, MPI_INT, theirs, 1, MPI_INT, comm);
  *exchange           = (Exchange){.comm = comm};
  exchange->n_owners  = peers(size, counts, &exchange->owner, &exchange->copy_starts);
  exchange->n_holders = peers(size, theirs, &exchange->holder, &exchange->own_starts);
  exchange->copies    = allocate(n, sizeof(*exchange->copies));
  exchange->own       = allocate(exchange->own_starts[exchange->n_holders], sizeof(*exchange->own));
  asked               = allocate(n, sizeof(*asked));
  next                = allocate(size, sizeof(*next));
  for (int p = 0; p < exchange->n_owners; p++) next[exchange->owner[p]] = exchange->copy_starts[p];
  for (int64_t k = 0; k < n; k++) {
    const int64_t at     = next[owners[k]]++;
    exchange->copies[at] = here ? here[k] : (int32_t)k;
    asked[at]            = places[k];
  }
  requests = allocate(exchange->n_owners + exchange->n_holders, sizeof(*requests));
  for (int p = 0; p < exchange->n_holders; p++)
    MPI_Irecv(exchange->own + exchange->own_starts[p], (int)(exchange->own_starts[p + 1] - exchange->own_starts[p]), MPI_INT32_T,
              exchange->holder[p], TAG, comm, &requests[p]);
  for (int p = 0; p < exchange->n_owners; p++)
    MPI_Isend(asked + exchange->copy_starts[p], (int)(exchange->copy_starts[p + 1] - exchange->copy_starts[p]), MPI_INT32_T,
              exchange->owner[p], TAG, comm, &requests[exchange->n_holders + p]);
  MPI_Waitall(exchange->n_owners + exchange->n_holders, requests, MPI_STATUSES_IGNORE);
  free(requests);
  free(next);
  free(asked);
  free(theirs);
  free(counts);
}

void exchange_destroy(Exchange *exchange)
{
  free(exchange->owner);
  free(exchange->copy_starts);
  free(exchange->copies);
  free(exchange->holder);
  free(exchange->own_starts);
  free(exchange->own);
  *exchange = (Exchange){0};
}

/* one end of an exchange: whom it sends to or receives from, and what */
typedef struct {
  int            n;
  const int     *ranks;
  const int64_t *starts;
  const int32_t *items;
} End;

static End end_of_copies(const Exchange *exchange)
{
  return (End){exchange->n_owners, exchange->owner, exchange->copy_starts, exchange->copies};
}

static End end_of_own(const Exchange *exchange)
{
  return (End){exchange->n_holders, exchange->holder, exchange->own_starts, exchange->own};
}

/* What has come, in the order of the receiving end; the caller frees it. */
static char *carry(MPI_Comm comm, End from, End to, int64_t bytes, const char *values)
{
  char        *sent = allocate(from.starts[from.n], (size_t)bytes), *come = allocate(to.starts[to.n], (size_t)bytes);
  MPI_Request *requests = allocate(from.n + to.n, sizeof(*requests));
  MPI_Datatype item;
  MPI_Type_contiguous((int)bytes, MPI_BYTE, &item);
  MPI_Type_commit(&item);
  for (int p = 0; p < to.n; p++)
    MPI_Irecv(come + bytes * to.starts[p], (int)(to.starts[p + 1] - to.starts[p]), item, to.ranks[p], TAG, comm, &requests[p]);
  for (int64_t k = 0; k < from.starts[from.n]; k++) memcpy(sent + bytes * k, values + bytes * from.items[k], (size_t)bytes);
  for (int p = 0; p < from.n; p++)
    MPI_Isend(sent + bytes * from.starts[p], (int)(from.starts[p + 1] - from.starts[p]), item, from.ranks[p], TAG, comm,
              &requests[to.n + p]);
  MPI_Waitall(from.n + to.n, requests, MPI_STATUSES_IGNORE);
  MPI_Type_free(&item);
  free(requests);
  free(sent);
  return come;
}

static void put(End to, int64_t bytes, const char *come, char *values)
{
  for (int64_t k = 0; k < to.starts[to.n]; k++) memcpy(values + bytes * to.items[k], come + bytes * k, (size_t)bytes);
}

void exchange_bring(const Exchange *exchange, int64_t bytes, const void *own, void *copies)
{
  char *come = carry(exchange->comm, end_of_own(exchange), end_of_copies(exchange), bytes, own);
  put(end_of_copies(exchange), bytes, come, copies);
  free(come);
}

/* Of exchanges in which every own node has one copy. */
void exchange_give(const Exchange *exchange, int64_t bytes, const void *copies, void *own)
{
  char *come = carry(exchange->comm, end_of_copies(exchange), end_of_own(exchange), bytes, copies);
  put(end_of_own(exchange), bytes, come, own);
  free(come);
}

void exchange_add(const Exchange *exchange, int width, const double copies[], double own[])
{
  const End to   = end_of_own(exchange);
  char     *come = carry(exchange->comm, end_of_copies(exchange), to, width * (int64_t)sizeof(double), (const char *)copies);
  for (int64_t k = 0; k < to.starts[to.n]; k++)
    for (int i = 0; i < width; i++) own[width * (int64_t)to.items[k] + i] += ((const double *)(const void *)come)[width * k + i];
  free(come);
}
