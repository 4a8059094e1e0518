/* Parts on their way from homes to the ranks that get them: the nodes and facets of a side that are at home here, which parts have them
 * (side.c), and these packed as whole numbers (packet.c). */
#ifndef STICKSLIP_PROGRAM_PACKET_H
#define STICKSLIP_PROGRAM_PACKET_H
#include "contact/contact.h"

/* What parts have is marked in bits, of so many ranks at a time: memory does not grow with the number of ranks. */
enum { RANKS_AT_ONCE = 30 };

typedef struct {
  int             which; /* 0: non-mortar, 1: mortar */
  PetscInt        n_nodes, n_facets;
  const PetscInt *offsets;          /* of the corners of each facet */
  PetscSF         corners;          /* from nodes to corners; its nodes are those of both sides */
  PetscInt       *of_both, *nodes;  /* n1 + n2; its entries of this side: the parts that have each node */
  PetscInt       *facets, *marks;   /* likewise of each facet; of its corners */
} Side;

PetscErrorCode side_create(const Interface *interface, int which, Side *side);
PetscErrorCode side_destroy(Side *side);
/* nothing is marked */
PetscErrorCode side_clear(const Interface *interface, Side *side);
/* marks so many rings of facets around the nodes marked, and these facets' nodes */
PetscErrorCode side_mark_rings(Side *side, PetscInt rings);

/* The marked nodes and facets of RANKS_AT_ONCE ranks from `first` on, from all homes to these. `counts`: bits of the nodes that are to be
 * counted. `received` (NULL on other ranks) is to be freed. */
PetscErrorCode side_deal(const Mesh *mesh, const Interface *interface, const Side *side, const PetscInt counts[], PetscMPIInt first,
                         PetscInt *n, PetscInt **received);
/* into the part: its nodes and facets in the order of their numbers */
PetscErrorCode side_unpack(PetscInt n, const PetscInt received[], int which, const Interface *interface, ContactPart *part);
#endif
