/* What the files of the look-out for motions that nothing holds share (held.c). */
#ifndef STICKSLIP_PROGRAM_HELD_H
#define STICKSLIP_PROGRAM_HELD_H
#include "solve/motions.h"
#include "solve/solve.h"

/* held_contact.c: what an interface's closed nodes hold, at the place of the last evaluation; before motions_sum() */
PetscErrorCode motions_add_contact(const Mesh *mesh, const Interface *interface, Motions *m);
/* Appends what a node may close by, of those that are owned here: which parts of the model; where, now; along
 * which normal, how far it is open, and how much friction there is. Ties are left out. */
typedef struct {
  PetscInt  part[2];
  PetscReal at[3], normal[3], gap, friction;
} Gap;
PetscErrorCode held_gaps(const Solve *solve, const Interface *interface, Gap gaps[], PetscInt *n);
/* held_words.c: the first n_free rows of m->gram, part by part; `json`, unless NULL, gets them by name */
PetscErrorCode held_words(const Solve *solve, const Motions *m, PetscInt n_free, const char *verb, struct cJSON *json, char text[], size_t length);
#endif
