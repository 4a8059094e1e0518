/* Memory. A rank without it cannot go on, and the others would wait for it: the program ends. */
#include "internal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *allocate(int64_t n, size_t bytes)
{
  void *found = calloc(n > 0 ? (size_t)n : 1, bytes);
  if (!found) {
    fprintf(stderr, "stickslip_mpi: no memory is left for %lld numbers.\n", (long long)n);
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  return found;
}

void *copied(const void *from, int64_t n, size_t bytes)
{
  void *to = allocate(n, bytes);
  if (n > 0) memcpy(to, from, (size_t)n * bytes);
  return to;
}
