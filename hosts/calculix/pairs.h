/* Contact pairs of the library stickslip in CalculiX: what nonlingeo.c calls, in the order of a step. */
#ifndef PAIRS_H
#define PAIRS_H

#include "CalculiX.h"

/* Where a displacement of a node is an unknown, prescribed, or depends on others. CalculiX numbers anew now and then, so each call
   gets it. */
typedef struct {
  const ITG *nactdof, *ipompc, *nodempc;
  const double *coefmpc;
} PairsNumbers;

typedef struct {
  ITG ntie, nset, ne, ncmat, ntmat, *mi, istep;
  const char *tieset, *set, *lakon, *jobname;
  const double *tietol, *elcon, *co;
  const ITG *istartset, *iendset, *ialset, *kon, *ipkon, *nelcon, *ielmat;
  ITG nmethod, ithermal, ncont, mcs, iexpl; /* of the step: what pairs do not go with is refused */
} PairsModel;

/* At the start of a step: finds the pairs, creates or takes over their interfaces. */
void pairs_begin(const PairsModel *model, PairsNumbers numbers);

/* Takes the contact forces at displacements v off the residual b = fext - f. */
void pairs_forces(double *b, const double *v, PairsNumbers numbers);

/* In place of the solver: the system with the multipliers beside the displacements. b becomes the increment of displacements. 0: there
   are no pairs, and nothing was done. */
ITG pairs_solve(const double *ad, const double *au, double *b, const ITG *icol, const ITG *irow, ITG neq, ITG upper, ITG nasym,
                ITG solver);

/* Before CalculiX judges: iflagact = 1 while contact is not in equilibrium, qa[2] > 0 where a smaller increment is needed. */
void pairs_judge(ITG iteration, ITG *iflagact, double *qa);

/* After the iterations of an increment: the step is committed, or lambda goes back to that of its start. */
void pairs_end(ITG converged, ITG increment, double time);

/* Beside the results in the .frd. */
void pairs_frd(ITG kode, double time, ITG istep, ITG iinc, ITG nmethod, char *output);

#endif
