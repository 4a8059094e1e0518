/* What the files of supports that change share (timed.c). */
#ifndef STICKSLIP_PROGRAM_TIMED_H
#define STICKSLIP_PROGRAM_TIMED_H
#include "physics/physics.h"

struct Timed {
  PetscBool *held;                   /* of the entries of a local vector */
  Vec        place, let_go, caught;  /* local: p less what the support says; reactions that fade, complete at owned entries; the last ones */
};

/* Calls for each entry of a local vector that is a component which a support holds of this rank's vertices; of a rigid body turns are
 * components 3 to 5. */
typedef void (*EntryVisit)(const Support *support, PetscInt entry, int component, PetscBool owned, void *context);
PetscErrorCode support_visit(const Physics *physics, const Support *support, EntryVisit action, void *context);

/* The same for those that are unknowns: of others the equation is negative, for they are prescribed from start to end. */
PetscErrorCode timed_visit(const Physics *physics, const Support *support, EntryVisit action, void *context);

/* Adds what is left at physics->t of a support that was let go, at entries that this rank owns. */
PetscErrorCode timed_fading(const Physics *physics, const Support *support, PetscScalar *forces, PetscBool *fades);

typedef struct {
  const PetscScalar *from;
  PetscScalar       *to;
} EntryCopies;

/* A step ends at such a time: is t beyond it? */
PetscBool timed_past(PetscReal t, PetscReal time);
#endif
