/* Multigrid on matrices of whole nodes (multigrid.c). */
#ifndef STICKSLIP_PROGRAM_MULTIGRID_H
#define STICKSLIP_PROGRAM_MULTIGRID_H
#include "solve/node_blocks.h"
#include <petscpc.h>

/* The bodies' coarse functions, whatever touches them. */
typedef struct {
  PetscInt n_levels;
  Mat     *to_finer; /* of each level but the finest, the coarsest first */
} Coarse;

/* `like`: a matrix of equations */
PetscErrorCode coarse_create(Physics *physics, const NodeBlocks *blocks, Mat like, Coarse *coarse);
PetscErrorCode coarse_destroy(Coarse *coarse);
/* Q: what is constrained at the nodes, and not to be coarse; NULL: nothing */
PetscErrorCode multigrid_create(const Coarse *coarse, Mat Q, Mat P, PC *pc);
/* From the next one on a smoother that is dearer and gets through more; `more`: it is another one */
PetscErrorCode multigrid_fill(PetscBool *more);
#endif
