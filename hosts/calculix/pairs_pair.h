/* A pair: its two sides, where their unknowns are, and what it remembers. For the files pairs*.c alone. */
#ifndef PAIRS_PAIR_H
#define PAIRS_PAIR_H

#include <stdint.h>
#include <stickslip.h>
#include "pairs.h"

enum { SLAVE, MASTER, SIDES, DIM = 3, FACE_NODES = 8 };

typedef struct {
  ITG n_nodes, n_facets;
  int64_t *offsets, *facets, *equations;
  ITG *nodes; /* CalculiX' numbers */
  double *reference, *x, *force;
  char *corner; /* has a multiplier, on the slave side */
} Side;

typedef struct {
  stickslip_interface *contact;
  stickslip_options options;
  Side side[SIDES];
  int64_t *multipliers, first; /* equations; and the first one among all multipliers */
  double *lambda, *lambda_begin, *rows, *normal, *gap;
  int32_t *state;
  double largest_traction; /* of the steps so far */
} Pair;

/* Ends CalculiX with a sentence. */
void pairs_stop(const char *what, const char *why);
/* The same where the library refuses. */
void pairs_must(const char *what, int32_t status);
void *pairs_zeros(size_t count, size_t size);

/* The facets of a surface, by its label in CalculiX' sets. */
void pairs_read_side(const PairsModel *model, const char *label, Side *side);

/* The unknowns of now; values_per_node: of v, and of nactdof. */
void pairs_number(PairsNumbers numbers, ITG values_per_node);
enum { PAIRS_MOST_TERMS = 4096 };
/* What a displacement of a node depends on: unknowns from 0 and their factors; how many. */
ITG pairs_terms(ITG node, ITG direction, ITG *unknown, double *factor);
/* x = X + v of a side */
void pairs_positions(Side *side, const double *v);

/* job.stickslip, and a block in the .frd */
void pairs_open(const char *jobname);
void pairs_write(const Pair *pairs, ITG n_pairs, ITG increment, double time);
void pairs_write_frd(const Pair *pairs, ITG n_pairs, ITG kode, double time, ITG istep, ITG iinc, ITG nmethod, const char *output);

#endif
