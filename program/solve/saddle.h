/* The preconditioner of systems with multipliers (saddle.c). */
#ifndef STICKSLIP_PROGRAM_SADDLE_H
#define STICKSLIP_PROGRAM_SADDLE_H
#include "contact/contact.h"
#include <petscksp.h>

PetscErrorCode saddle_set(PC pc, const Contact *contact);
#endif
