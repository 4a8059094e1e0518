/* Multigrid on matrices of whole nodes (multigrid.c). */
#ifndef SNES_CONTACT_MULTIGRID_H
#define SNES_CONTACT_MULTIGRID_H
#include "solve/node_blocks.h"
#include <petscpc.h>

PetscErrorCode multigrid_typical(Mat matrix, PetscReal *typical); /* entry of its diagonal */
PetscErrorCode multigrid_create(const Physics *physics, Mat P, PC *pc);
#endif
