/* General contact: the skin of all bodies in place of two sides (docs/general_contact.md). To the rest of the driver it is an interface whose
 * non-mortar side is the whole skin, and which has no mortar side; the library's handle is another one. */
#ifndef STICKSLIP_PROGRAM_SKIN_H
#define STICKSLIP_PROGRAM_SKIN_H
#include "contact/contact.h"

/* Where the library cuts a skin, in degrees: at 0.7 radians. */
#define SKIN_CREASE (0.7 * 180 / PETSC_PI)

/* How many numbers a run counts: interfaces made, facets that have exchanged their sides, steps solved again. */
enum { SKIN_COUNTS = 3 };

/* Two bodies, or one twice: their coefficient of friction, or STICKSLIP_SKIN_APART. */
typedef struct {
  PetscInt  bodies[2];
  PetscReal mu;
} SkinPair;

/* What the scene says of a skin. */
struct Skin {
  Surface   outer;    /* its facets, in the vertices of the piece, until the mesh is distributed */
  PetscInt  n_pairs;
  SkinPair *pairs;
  PetscInt *symmetry; /* of the piece's vertices: axes across which planes of symmetry hold them */
  PetscInt  n_left;   /* facets that lie in such planes, and are left out */
  PetscReal rubs;     /* the largest friction of any pair */
};

/* The handle of a part, and the ways between the library's numbers and the part's. */
struct SkinPart {
  stickslip_skin *handle;
  PetscInt        n_nodes, n_copies, n_facets;
  PetscInt       *node, *copy;      /* the part's node of each of the library's nodes and copies */
  PetscInt       *first;            /* of each node of the part the library's node */
  int64_t        *numbers;          /* the part's entry of each of the library's equations */
  int64_t         n_numbers;
  double         *x, *lambda, *force, *rows, *dx; /* as the library has them */
  PetscInt       *opposite;         /* of each node of the part: one that lies opposite in this step; -1: none */
  int64_t         missed;           /* steps refused since facets met out of reach, that have been noticed */
  PetscBool       exchanged;        /* its sides, in this step */
  int64_t         before[SKIN_COUNTS]; /* what skin_counts() tells of the runs that this one goes on from */
};

/* Who may touch whom in this step, facet by facet of the part. */
typedef struct {
  int32_t *side;
  int64_t *piece, *partner, *body;
  double  *distance;
} SkinFacets;

/* What is known of a node of the part, at home on any rank (ContactStates); vectors have three numbers. */
typedef struct {
  double state, gap, coverage, multiplier[3], normal[3], displacement[3];
} SkinNode;

/* skin_scene.c */
PetscBool      skin_wanted(Scene *scene);
PetscErrorCode skin_read(Scene *scene, const Contact *contact, Interface *interface);
PetscErrorCode skin_find(Scene *scene, const Contact *contact, Interface *interface);
PetscErrorCode skin_symmetry(const Interface *interface, PetscInt mask[]);
PetscErrorCode skin_destroy(Interface *interface);

/* again.c: the multipliers that a commit or an exchange has changed, to x */
PetscErrorCode skin_hand_over(Contact *contact, const Interface *interface, Vec x);

/* skin.c */
PetscErrorCode skin_part_create(const Contact *contact, Interface *interface, int32_t *refused);
PetscErrorCode skin_part_destroy(ContactPart *part);
void           skin_point(ContactPart *part); /* the library's arrays from the part's, at the place of now */
void           skin_to_part(const ContactPart *part, PetscInt width, const double copies[], double nodes[]);
void           skin_counts(const ContactPart *part, int64_t counts[SKIN_COUNTS]);
PetscErrorCode skin_look(ContactPart *part); /* what lies opposite of each node */
PetscErrorCode skin_facets(const ContactPart *part, SkinFacets *facets);
PetscErrorCode skin_facets_destroy(SkinFacets *facets);
/* On every rank, when the states have been collected: of the part's nodes; to be freed. */
PetscErrorCode skin_nodes(const Interface *interface, SkinNode **nodes);
PetscReal      skin_pressure(const SkinNode *node);
#endif
