/* Conditions of contact that follow from others: which ones, and that they are left out (redundant.c, dependent.c). */
#ifndef SNES_CONTACT_REDUNDANT_H
#define SNES_CONTACT_REDUNDANT_H
#include "solve/solve.h"

/* A multiplier that may be redundant: its equation, of which component of which node of which interface; where that is, and what is
 * covered of the node. */
struct Multiplier {
  PetscInt  equation, interface, number, component;
  PetscBool tied;
  PetscReal X[3], coverage;
};

/* dependent.c: of `n` multipliers, which to leave out; S (n x n, overwritten): products of their forces */
PetscErrorCode dependent_find(PetscInt n, const Multiplier multipliers[], PetscReal S[], PetscBool dependent[]);
#endif
