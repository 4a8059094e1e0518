/* Conditions of contact that follow from others: which ones, and that they are left out (redundant.c, suspects.c, suspects_judge.c, dependent.c). */
#ifndef STICKSLIP_PROGRAM_REDUNDANT_H
#define STICKSLIP_PROGRAM_REDUNDANT_H
#include "solve/solve.h"

/* A multiplier that may be redundant: its equation, of which component of which node of which interface; whether that is tied, held by
 * supports (of contact: wholly), and of a node that several surfaces have; where that is, what is covered of the node, and how far that is
 * open, in steps too small to count. */
struct Multiplier {
  PetscInt  equation, interface, number, component;
  PetscBool tied, held, shared;
  PetscReal X[3], coverage, steps_open;
};

/* suspects.c: may an interface have any: are its forces a multiplier's times weights? All of them, of all ranks, in order; to be freed */
PetscBool      suspects_may_be(const Interface *interface);
PetscErrorCode suspects_find(const Contact *contact, PetscInt *n, Multiplier **all);
int            suspects_order(const void *one, const void *two); /* for qsort */
/* suspects_judge.c: which are redundant, at u_local */
PetscErrorCode suspects_judge(Solve *solve, PetscInt n, const Multiplier suspects[], PetscBool redundant[]);

/* dependent.c: of `n` multipliers, which follow from those before them; S (n x n, overwritten): products of their forces */
void dependent_find(PetscInt n, const Multiplier multipliers[], PetscReal S[], PetscBool dependent[]);

/* torn.c: ties that supports tear where their conditions are left out, in words */
PetscErrorCode torn_find(Solve *solve, char why[], size_t size);
#endif
