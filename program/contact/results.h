/* What is known of the nodes of an interface: their results, how the surface is covered, and what may be wrong there. */
#ifndef STICKSLIP_PROGRAM_RESULTS_H
#define STICKSLIP_PROGRAM_RESULTS_H
#include "physics/physics.h"
#include <stickslip.h>

/* part.h, interface.h, contact.h */
typedef struct ContactPart ContactPart;
typedef struct Interface   Interface;
typedef struct Contact     Contact;

/* What becomes of a node of what lies between the surfaces. */
enum { LAYER_WORN, LAYER_VOLUME, LAYER_DAMAGE, LAYER_LOSS, N_LAYER_RESULTS };

/* of a part's nodes, N_RESULTS each */
enum {
  RESULT_STATE,
  RESULT_NORMAL,
  RESULT_MULTIPLIER  = RESULT_NORMAL + 3,
  RESULT_GAP         = RESULT_MULTIPLIER + 3,
  RESULT_SLIP,
  RESULT_COVERAGE    = RESULT_SLIP + 3,
  RESULT_AREA,
  RESULT_DISSIPATION,
  RESULT_CLOSED,
  RESULT_LAYER, /* depth and volume worn off, damage, work that a bond has lost an area */
  N_RESULTS = RESULT_LAYER + N_LAYER_RESULTS
};

/* nodal results of the nodes at home; every array has n1 entries, vectors 3 n1, in the plane too */
typedef struct {
  int32_t *state;
  double  *normal, *multiplier, *gap, *slip, *coverage, *area, *dissipation; /* multiplier: as a vector */
  double  *closed; /* of what is covered of a node, the part that is closed; by nodes 0 or 1 */
  double  *layer;  /* N_LAYER_RESULTS n1 */
} ContactStates;

/* How the non-mortar side is covered, as the library finds it. */
typedef struct {
  char      text[1024];
  int32_t   finding; /* STICKSLIP_FINDING_... */
  PetscBool mistaken; /* the finding is a mistake in the scene */
  PetscReal penetration;
} ContactCover;

/* What may be wrong with an interface (diagnose.c): the worst pairs, facets in the interface's numbers, -1: none; how many
 * nodes are in each state; the nodes where the matrix may be singular, the worst first. */
enum { PAIR_OVERLAP, PAIR_WARP, PAIR_ANGLE, PAIR_ERROR, N_PAIRS_FOUND };
enum { SUSPECTS_KEPT = 20 };

typedef struct {
  double  value;
  int64_t facets[2];
} PairFound;

typedef struct {
  PetscInt vertex;
  double   position[3], direction[3], ratio;
  int32_t  cause; /* STICKSLIP_CAUSE_... */
} Suspect;

typedef struct {
  char      text[1024];
  PetscBool found;
  PairFound pairs[N_PAIRS_FOUND];
  PetscInt  states[3], n_suspects, n_weak, n_new; /* suspects in all, those hardly covered; nodes not covered before */
  Suspect   suspects[SUSPECTS_KEPT];
} ContactDiagnosis;

/* states.c: of a part, RESULT_... of each node; at the place of the last evaluation, of the nodes at home */
PetscErrorCode contact_results(const ContactPart *part, double results[]);
PetscErrorCode contact_states_destroy(ContactStates *states);
PetscErrorCode contact_collect(Contact *contact);

/* cover.c: on every rank; `handle`: the part's, or NULL; `facets` (n1 of the part, or NULL): of the mortar side over those
 * around each node */
PetscErrorCode contact_cover(const Interface *interface, stickslip_interface *handle, PetscMPIInt rank, ContactCover *cover,
                             int64_t facets[]);

/* diagnose.c: on every rank; rank 0 gets the answer */
PetscErrorCode contact_diagnose(const Interface *interface, PetscMPIInt rank, ContactDiagnosis *diagnosis);
#endif
