/* The parts of an interface, one a rank: values between the ranks that own nodes, those that have them too, and homes; and
 * what the library says of a part in the numbers of the interface and the words of the scene. */
#include "contact/contact.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

PetscErrorCode parts_share(const ContactPart *part, PetscInt width, double values[])
{
  double *theirs;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(width * part->n1, &theirs));
  PetscCall(PetscArraycpy(theirs, values, width * part->n1));
  PetscCall(homes_bcast(part->owners, width, theirs, values));
  PetscCall(PetscFree(theirs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode parts_collect(const ContactPart *part, PetscInt width, const double values[], double home[])
{
  PetscFunctionBegin;
  PetscCall(homes_bcast(part->homes, width, values, home));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode parts_send(const ContactPart *part, PetscInt width, const double home[], double values[])
{
  MPI_Datatype node;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)width, MPI_DOUBLE, &node));
  PetscCallMPI(MPI_Type_commit(&node));
  PetscCall(PetscSFReduceBegin(part->homes, node, home, values, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(part->homes, node, home, values, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the library calls things that it numbers. "non-mortar node" ends with "mortar node", and comes first. */
static const struct {
  const char *name;
  int         side;
  PetscBool   facet;
} NUMBERED[] = {{"non-mortar node", 0, PETSC_FALSE},
                {"non-mortar facet", 0, PETSC_TRUE},
                {"nonmortar node", 0, PETSC_FALSE}, /* as the argument is called */
                {"nonmortar facet", 0, PETSC_TRUE},
                {"mortar node", 1, PETSC_FALSE},
                {"mortar facet", 1, PETSC_TRUE}};

enum { N_NUMBERED = sizeof(NUMBERED) / sizeof(NUMBERED[0]) };

/* the number in the interface of what has number k here; itself where it is none */
static long translated(const ContactPart *part, int which, long k)
{
  const int      side = NUMBERED[which].side;
  const PetscInt n    = NUMBERED[which].facet ? part->n_facets[side] : side ? part->n2 : part->n1;
  if (k < 0 || k >= n) return k;
  if (NUMBERED[which].facet) return (long)part->facets[side][k];
  return side ? (long)(part->nodes[part->n1 + k] - part->first_mortar) : (long)part->nodes[k];
}

/* "mortar facets 3 and 5" at `from`: to its end; NULL: there is no such thing there */
static const char *translate_one(const ContactPart *part, const char *from, char to[], size_t length)
{
  static const char *const between[] = {" ", "s ", " and "};
  for (int w = 0; w < N_NUMBERED; w++) {
    const char *rest = from + strlen(NUMBERED[w].name);
    size_t      used = 0;
    int         found = 0;
    if (strncmp(from, NUMBERED[w].name, (size_t)(rest - from))) continue;
    used = (size_t)snprintf(to, length, "%s", NUMBERED[w].name);
    for (int b = 0; b < 3 && used < length; b++) {
      const size_t n   = strlen(between[b]);
      char        *end = NULL;
      const long   k   = strncmp(rest, between[b], n) ? 0 : strtol(rest + n, &end, 10);
      if (!end || end == rest + n || (b == 2 && !found)) continue;
      used += (size_t)snprintf(to + used, length - used, "%s%ld", between[b], translated(part, w, k));
      rest  = end;
      found = 1;
    }
    if (found) return rest;
  }
  return NULL;
}

void parts_translate(const ContactPart *part, const char *from, char to[], size_t length)
{
  size_t used = 0;
  while (*from && used + 1 < length) {
    const char *rest = translate_one(part, from, to + used, length - used);
    if (!rest) rest = key_word(from, to + used, length - used);
    if (rest)
      used += strlen(to + used);
    else
      to[used++] = *from;
    from = rest ? rest : from + 1;
  }
  to[used] = 0;
}
