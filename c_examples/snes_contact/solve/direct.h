/* LU, MUMPS' unless the options say otherwise, or PETSc has been built without it (direct.c). */
#ifndef SNES_CONTACT_DIRECT_H
#define SNES_CONTACT_DIRECT_H
#include "scene/petsc_compat.h"
#include <petscksp.h>

PetscErrorCode direct_set(KSP ksp);
#endif
