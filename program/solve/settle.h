/* What the files that lay bodies down share (settle.c). */
#ifndef STICKSLIP_PROGRAM_SETTLE_H
#define STICKSLIP_PROGRAM_SETTLE_H
#include "solve/held.h"

typedef struct {
  Motions    m;
  PetscBool  rubs;                 /* friction is counted: not in models with rigid bodies, whose places at rest would depend on the form of the system */
  PetscInt   n;                    /* motions that supports leave free, the first rows of m.gram */
  PetscReal *load, *move, *before; /* n: the move that nothing stops; the next one, the last one */
  PetscReal *turned;               /* 3 per part: by how much in all, about three axes */
  PetscReal  edge, most, eager, depth; /* the shortest of the interfaces' longest edges; a move's length, at most; `load` over that; of
                                          touching nodes */
  PetscReal  limit;                /* of `eager`, for now */
  PetscInt   n_alike;              /* moves in one direction */
  PetscInt   n_gaps;
  Gap       *gaps;                 /* of all ranks */
  PetscReal *open, *force;         /* n_gaps x n: G; n_gaps: l */
  PetscReal *slide, *rub;          /* n_gaps x 2 x n: how motions slide along two tangents; n_gaps x 2: friction along these */
  PetscReal *opens, *slides;       /* n_gaps: squares of rows of both */
  PetscReal  pushed;               /* the load that the forces belong to */
} Settle;

PetscReal settle_dot(PetscInt n, const PetscReal a[], const PetscReal b[]);

/* settle_gaps.c: gaps of all ranks at the place of the last evaluation; the next move; do the normals of the nodes that stopped the last one
 * leave a motion to friction? */
PetscErrorCode settle_find_gaps(Solve *solve, Settle *s);
PetscErrorCode settle_forget_gaps(Settle *s);
void           settle_find_move(Settle *s, PetscReal accuracy);
PetscErrorCode settle_wants_friction(const Settle *s, PetscBool *wants);
#endif
