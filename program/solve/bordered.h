/* A preconditioner beside the equations of rigid bodies (bordered.c). */
#ifndef STICKSLIP_PROGRAM_BORDERED_H
#define STICKSLIP_PROGRAM_BORDERED_H
#include "physics/physics.h"
#include <petscpc.h>

/* Makes pc this preconditioner; `inner` gets the matrix's other equations, and is to be made by the caller. It is pc itself where no rigid body has
 * an equation. */
PetscErrorCode bordered_set(PC pc, const Physics *physics, PC *inner);
#endif
