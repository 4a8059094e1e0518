/* The linear system of displacements and multipliers: entries are collected, summed by column, and handed to CalculiX' solver. */
#ifndef PAIRS_SYSTEM_H
#define PAIRS_SYSTEM_H

#include <stdint.h>
#include "CalculiX.h"

typedef struct {
  ITG size;
  int64_t count, capacity;
  ITG *rows, *columns; /* from 0 */
  double *values;
} System;

void system_add(System *system, ITG row, ITG column, double value);

/* CalculiX' own matrix: diagonal ad, columns of the lower triangle in au, and with nasym the upper one from au + upper on. */
void system_add_host(System *system, const double *ad, const double *au, const ITG *icol, const ITG *irow, ITG neq, ITG upper,
                     ITG nasym);

/* b becomes the solution, by CalculiX' solver of this number (0: SPOOLES, 7: PARDISO, 8: PaStiX). 0: it is not there. */
ITG system_solve(const System *system, double *b, ITG solver);

void system_free(System *system);

#endif
