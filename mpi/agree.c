/* A refusal of one part is a refusal of all, in the same words. Words of the library name nodes and facets of a part: they are put into
 * the host's numbers here. */
#include "internal.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static _Thread_local char sentence[SENTENCE];

const char *stickslip_mpi_last_error_message(void)
{
  return sentence;
}

void accept(void)
{
  sentence[0] = 0;
}

int32_t refuse(int32_t status, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(sentence, sizeof(sentence), format, arguments);
  va_end(arguments);
  return status;
}

/* A missing entry is mended by a new plan, which another part's refusal would refuse, too: that one is the news. */
int32_t agree(MPI_Comm comm, int32_t status)
{
  int rank, size, speaker;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  speaker = status == STICKSLIP_OK ? 2 * size : status == STICKSLIP_MISSING_ENTRY ? size + rank : rank;
  MPI_Allreduce(MPI_IN_PLACE, &speaker, 1, MPI_INT, MPI_MIN, comm);
  if (speaker == 2 * size) {
    accept();
    return STICKSLIP_OK;
  }
  MPI_Bcast(&status, 1, MPI_INT32_T, speaker % size, comm);
  MPI_Bcast(sentence, SENTENCE, MPI_CHAR, speaker % size, comm);
  return status;
}

/* What the library calls things that it numbers, arguments by their names. "non-mortar node" ends with "mortar node", and comes first. */
static const struct {
  const char *name;
  int         side, facet;
} NUMBERED[] = {{"non-mortar node", 0, 0}, {"non-mortar facet", 0, 1}, {"nonmortar node", 0, 0},
                {"nonmortar facet", 0, 1}, {"mortar node", 1, 0},      {"mortar facet", 1, 1}};

enum { N_NUMBERED = sizeof(NUMBERED) / sizeof(NUMBERED[0]) };

/* Writes the host's word for what has number k in the part; a facet is named by its nodes. */
static size_t translate(const stickslip_mpi_interface *interface, int which, long k, char to[], size_t length)
{
  const int    side = NUMBERED[which].side;
  const Part  *part = &interface->part;
  const Whole *whole = &interface->whole[side];
  size_t       used = 0;
  if (k < 0 || k >= (NUMBERED[which].facet ? part->n_facets[side] : part->n_nodes[side])) return (size_t)snprintf(to, length, "%ld", k);
  if (!NUMBERED[which].facet) return (size_t)snprintf(to, length, "%lld", (long long)whole->numbers[part->nodes[side][k]]);
  for (int64_t c = part->offsets[side][k]; c < part->offsets[side][k + 1] && used < length; c++)
    used += (size_t)snprintf(to + used, length - used, "%s%lld", c == part->offsets[side][k] ? "(" : " ",
                             (long long)whole->numbers[part->nodes[side][part->facet_nodes[side][c]]]);
  if (used < length) used += (size_t)snprintf(to + used, length - used, ")");
  return used;
}

/* "mortar facets 3 and 5" at `from`: to its end; NULL: there is no such thing there */
static const char *translate_one(const stickslip_mpi_interface *interface, const char *from, char to[], size_t length)
{
  static const char *const between[] = {" ", "s ", " and "};
  for (int w = 0; w < N_NUMBERED; w++) {
    const char *rest = from + strlen(NUMBERED[w].name);
    size_t      used = 0;
    int         found = 0;
    if (strncmp(from, NUMBERED[w].name, strlen(NUMBERED[w].name))) continue;
    used = (size_t)snprintf(to, length, "%s", NUMBERED[w].name);
    for (int b = 0; b < 3 && used < length; b++) {
      const size_t n   = strlen(between[b]);
      char        *end = NULL;
      const long   k   = strncmp(rest, between[b], n) ? 0 : strtol(rest + n, &end, 10);
      if (!end || end == rest + n || (b == 2 && !found)) continue;
      used += (size_t)snprintf(to + used, length - used, "%s", between[b]);
      if (used < length) used += translate(interface, w, k, to + used, length - used);
      rest  = end;
      found = 1;
    }
    if (found) return rest;
  }
  return NULL;
}

/* The status of a call of the library, with its sentence in the host's words. */
int32_t refuse_by_library(const stickslip_mpi_interface *interface, int32_t status)
{
  const char *from = stickslip_last_error_message();
  size_t      used = 0;
  if (status == STICKSLIP_OK) return status;
  while (*from && used + 1 < sizeof(sentence)) {
    const char *rest = translate_one(interface, from, sentence + used, sizeof(sentence) - used);
    if (rest) {
      used = strlen(sentence);
      from = rest;
    } else {
      sentence[used++] = *from++;
      sentence[used]   = 0;
    }
  }
  sentence[used] = 0;
  return status;
}
