/* Multigrid on the reduced form of a condensed matrix (reduced.c). */
#ifndef STICKSLIP_PROGRAM_REDUCED_H
#define STICKSLIP_PROGRAM_REDUCED_H
#include "contact/contact.h"
#include <petscpc.h>

/* Makes pc this preconditioner. What it needs of the contact must belong to pc's matrix: condensed_matrix() sees to it. */
PetscErrorCode reduced_set(PC pc, const Contact *contact);
/* After a solve: was the multigrid made for an earlier matrix, and is too slow now? Then the next set-up makes it anew. */
PetscErrorCode reduced_judge(PC pc, PetscInt iterations, PetscBool converged, PetscBool *stale);
#endif
