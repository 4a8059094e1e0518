/* Multigrid on the reduced form of a condensed matrix (reduced.c). */
#ifndef SNES_CONTACT_REDUCED_H
#define SNES_CONTACT_REDUCED_H
#include "contact/contact.h"
#include <petscpc.h>

/* Makes pc this preconditioner. What it needs of the contact must belong to pc's matrix: condensed_matrix() sees to it. */
PetscErrorCode reduced_set(PC pc, const Contact *contact);
#endif
