/* Rigid motions of some parts of the model, constraints on them, and which motions none of these feels (motions.c). */
#ifndef STICKSLIP_PROGRAM_MOTIONS_H
#define STICKSLIP_PROGRAM_MOTIONS_H
#include "physics/physics.h"

enum { MODES = 6 };

/* Motions of some parts, [part][translations, turns about its middle by size], and their constraints */
typedef struct {
  PetscInt   n_parts, *place; /* parts that may move; place of each part of the model among them, -1: none */
  PetscReal *middle, *size;   /* 3 per part of the model; of each */
  PetscInt   n;               /* MODES n_parts */
  PetscReal *gram;            /* n x n: sum of the constraints' products; then its eigenvectors, one a row */
  PetscReal *values;          /* its eigenvalues, in increasing order */
} Motions;

/* At the displacements of a local vector, NULL: none; `include`: which parts may move. Every rank gets the motions, and what
 * prescribed components of its own vertices constrain in `gram`, which motions_sum() adds up for all. */
PetscErrorCode motions_create(const Physics *physics, Vec u_local, const PetscBool *include, Motions *m);
/* held_springs.c: what springs hold, before motions_sum(). `by_stiffness`: each row counts by its stiffness, so that the sum is the
 * stiffness of the springs against the motions; else as what supports hold. */
PetscErrorCode motions_add_springs(const Physics *physics, Vec u_local, PetscBool by_stiffness, Motions *m);
/* of an axisymmetric model, after motions_sum() */
void           motions_add_rings(const Physics *physics, Motions *m);
PetscErrorCode motions_sum(Motions *m);
PetscErrorCode motions_destroy(Motions *m);
/* One row of a constraint, of n entries so far: what the motions of a part move a point by along d, times `sign`. */
void           motions_row(const Motions *m, PetscInt part, const PetscReal x[3], const PetscReal d[3], PetscReal sign,
                           PetscInt columns[], PetscReal values[], int *n);
void           motions_constrain(Motions *m, int n, const PetscInt columns[], const PetscReal values[]);
/* Eigenvalues of a symmetric matrix, the least first; it is replaced by its eigenvectors, one a row. */
PetscErrorCode motions_eigen(PetscInt n, PetscReal *gram, PetscReal *values);
/* The number of free motions, which are the first rows of m->gram from then on. */
PetscErrorCode motions_find_free(Motions *m, PetscInt *n_free);
/* "move along x, z and turn about y", or nothing: what the part in this place does in the free motions */
PetscErrorCode motions_words(const Motions *m, PetscInt n_free, PetscInt place, char words[], size_t length);
#endif
