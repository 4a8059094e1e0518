/* LU, MUMPS' unless the options say otherwise (direct.c). */
#ifndef SNES_CONTACT_DIRECT_H
#define SNES_CONTACT_DIRECT_H
#include "scene/petsc_compat.h"
#include <petscksp.h>

PetscErrorCode direct_set(KSP ksp);
#endif
