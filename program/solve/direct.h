/* LU, MUMPS' unless the options say otherwise, or PETSc has been built without it (direct.c). */
#ifndef STICKSLIP_PROGRAM_DIRECT_H
#define STICKSLIP_PROGRAM_DIRECT_H
#include "scene/petsc_compat.h"
#include <petscksp.h>

PetscErrorCode direct_set(KSP ksp);
#endif
