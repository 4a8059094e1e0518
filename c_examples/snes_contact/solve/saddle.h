/* The preconditioner of systems with multipliers (saddle.c). */
#ifndef SNES_CONTACT_SADDLE_H
#define SNES_CONTACT_SADDLE_H
#include "contact/contact.h"
#include <petscksp.h>

PetscErrorCode saddle_set(PC pc, const Contact *contact);
#endif
