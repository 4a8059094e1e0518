/* The contact interfaces of the scene: the binding to the stickslip library, and whether they are in equilibrium. */
#ifndef SNES_CONTACT_CONTACT_H
#define SNES_CONTACT_CONTACT_H
#include "physics/physics.h"
#include <stickslip.h>
#include "contact/halo.h"

/* Where surfaces are beside their meshes (offsets.c): `offset` of all nodes of the non-mortar side and of some, the factor on them;
 * of round sides their shape. Of the n1 + n2 nodes at home: those that the factor is on, and those of round sides; what `adjust`
 * has done (adjust.c). Where the handle is: the same of the nodes of its part, and their sum at time t. */
typedef struct {
  PetscBool  any;
  PetscReal  all;
  PetscInt   n_points;
  PetscReal *points;
  Curve      curve;
  PetscReal  radius[2], centre[3], axis[3]; /* 0: a side is not round */
  int32_t    shape;
  double    *nodal, *round;
  double    *part_nodal, *part_round, *now;
  PetscReal  adjust; /* tolerance; 0: nothing is adjusted */
  double    *gaps;
  int32_t   *moved;
} Offsets;

/* Rigid bodies in a part (rigid_part.c) */
typedef struct RigidPart RigidPart;

/* General contact (skin.h): what the scene says of it, and the library's handle of it */
typedef struct Skin Skin;
typedef struct SkinPart SkinPart;

/* A rank's part of an interface, with a handle of the library's own (parts.c): the non-mortar nodes that the rank owns, the
 * facets around them as far as these need them, and the mortar facets that may come near. Nodes and facets are numbered as they are here. */
typedef struct {
  PetscInt  dimension, components; /* as the interface's */
  PetscInt  n1, n2;                /* numbers of nodes; 0: nothing is owned here, and there is no handle */
  PetscInt *vertices;              /* n1 + n2: of the mesh */
  PetscInt *nodes;                 /* n1 + n2: their numbers in the interface, where those of the mortar side begin with */
  PetscInt  first_mortar;          /* this one */
  PetscInt *piece;                 /* n1 + n2: the model's part (physics.h) that each belongs to */
  PetscInt *counts;                /* n1 + n2: is it this rank that counts it where each counts once? */
  PetscInt *owner, *index;         /* n1: which rank owns the node, and its number in the part there */
  PetscInt  *removed, *copies;     /* n1: as the interface's */
  PetscBool *middle;               /* n1: likewise */
  PetscInt  n_facets[2], *facets[2], *offsets[2], *facet_nodes[2]; /* by side; facets: their numbers in the interface */
  int32_t  *owned;                 /* n1: STICKSLIP_NODE_... */
  double    origin[3];             /* positions count from there */
  double   *X, *x;                 /* n1 + n2 vectors: reference coordinates; current ones, see contact_positions() */
  PetscScalar *gathered;           /* n1 + n2 displacement vectors, components n1 multipliers */
  PetscScalar *forces;             /* same layout: f1, f2, multiplier rows; those of all ranks add up */
  int64_t     *equations;          /* same layout */
  PetscSF      sf;                 /* from the local vectors of all ranks to `gathered` */
  PetscSF      owners;             /* from the non-mortar nodes of all ranks to the nodes here that others own */
  PetscSF      homes;              /* from their owners to the interface's nodes at home */
  stickslip_interface *handle;
  SkinPart            *skin;       /* in its place, of general contact */
  /* condensed.c: multipliers, now and at the start of the step, of the last two; as `forces`, those of bodies and loads
   * and what condensing adds to the residual; where the last matrix was made, the former and the positions */
  double  *lambda, *lambda_start, *lambda_last, *lambda_before, *host, *rows, *host_there, *x_there;
  int64_t  coo_capacity, *coo_rows, *coo_columns;
  int64_t  planned; /* the entries of the library's plan, which lie in these arrays; 0: there is none */
  double  *coo_values;
  int64_t  bytes;   /* of the library's, the most at the end of a step */
  double   processor; /* seconds that the library took for residuals, matrices and commits, of this processor */
  RigidPart *rigid; /* rigid_part.c; NULL: no rigid body moves here */

  double  *slip, *augmentation; /* n1: vectors up to t_n; what contact_scale_augmentation() has set */
  double  *way;                 /* n_states n1: what law and layer of the interface remember of t_n, if anything */
  stickslip_counters spent;     /* of handles before this one: part_counters() */
} ContactPart;

/* Entries of a matrix. */
typedef struct {
  int64_t        n;
  const int64_t *rows, *columns;
  const double  *values;
} Entries;

/* In the arrays of a part: where the mortar's vectors begin, where the multipliers do. */
#define MORTAR_OF(part, array) ((array) + (part)->dimension * (part)->n1)
#define MULTIPLIERS_OF(part, array) ((array) + (part)->dimension * ((part)->n1 + (part)->n2))
/* The library takes x1, x2 and the multipliers: */
#define STATE_OF(part) (part)->x, MORTAR_OF(part, (part)->x), MULTIPLIERS_OF(part, (part)->gathered)

/* How far surfaces with frozen weights have slid, over the size of facets, or turned, in radians (slide.c); what is allowed; in
 * words, where that is more; and whether it was told. */
typedef struct {
  PetscReal amount, most;
  char      words[256];
  PetscBool told;
} Frozen;

/* What becomes of a node of what lies between the surfaces. */
enum { LAYER_WORN, LAYER_VOLUME, LAYER_DAMAGE, LAYER_LOSS, N_LAYER_RESULTS };

/* nodal results of the nodes at home; every array has n1 entries, vectors 3 n1, in the plane too */
typedef struct {
  int32_t *state;
  double  *normal, *multiplier, *gap, *slip, *coverage, *area, *dissipation; /* multiplier: as a vector */
  double  *closed; /* of what is covered of a node, the part that is closed; by nodes 0 or 1 */
  double  *layer;  /* N_LAYER_RESULTS n1 */
} ContactStates;

/* One contact interface: what the scene says of it, this rank's part, and what is known of the nodes that are at home here. */
typedef struct {
  char           name[NAME_LENGTH];
  Skin          *skin;       /* NULL: its two sides are named */
  Surface        share[2];   /* non-mortar, mortar: the faces dealt out to this rank; vertices are numbers of nodes of the side */
  const Surface *surface[2]; /* these */
  PetscInt       n1, n2;     /* nodes that are at home on this rank, see homes.c: so is all that follows up to `options` */
  PetscInt       first[2], all[2]; /* of either side: the number of the first of them; how many nodes all ranks have */
  PetscInt      *starts[2];  /* the first of each rank; then how many there are */
  PetscSF        corners[2]; /* from the nodes at home on all ranks to the corners of the faces here */
  PetscInt       body[2];    /* of either side */
  PetscInt      *nodes;      /* n1 + n2 mesh vertices */
  PetscReal     *place;      /* 3 (n1 + n2): where they are, in the axes of the scene file; then X */
  PetscInt      *copies;     /* n1: which copy of its vertex each is, on creases (creases.c); else 0 */
  PetscInt       n_copies;   /* of all ranks, beside the first ones */
  PetscBool      blunted;    /* there would be some, but the scene wants none */
  PetscInt      *prescribed, *part_of; /* n1 + n2: mask of prescribed displacements; the model's part (physics.h) */
  PetscSF        pieces;     /* from the vertices of the mesh's pieces to the nodes, until the mesh is distributed */
  PetscInt      *removed;    /* n1: mask of directions without a multiplier, see read_surfaces() */
  PetscInt      *has_been;   /* n1: the same, before any that is redundant was left out */
  PetscBool     *middle;     /* n1: no multiplier, since it is no corner of a face */
  /* n1 + n2 vectors: coordinates; at the place of the last contact_collect() displacements and forces; equations */
  double        *X;
  PetscScalar   *displacements, *forces;
  int64_t       *equations;
  ContactStates  states;     /* likewise */
  PetscSF        sf;         /* from the local vectors of all ranks to `displacements` */
  Offsets        offsets;
  stickslip_options options; /* its method is the next member */
  stickslip_method  method;
  stickslip_method  otherwise;     /* conserving.c: the method but for weights that conserve, if the library refuses them */
  PetscBool         conserves;     /* they are this program's choice */
  char              conserves_not[1024]; /* why they are not, where they would be; empty: nothing is to be said */
  stickslip_law  law;        /* in place of Coulomb's, if it is of another kind */
  stickslip_layer layer;     /* what lies between the surfaces; its table is the interface's */
  PetscInt       n_states;   /* numbers that law and layer remember of a node */
  PetscInt       dimension;  /* numbers a node of every vector here: 3, in the plane 2 */
  PetscInt       components; /* multipliers a node: 1, along the normal, without friction; else `dimension` */
  PetscBool      initial_contact; /* nodes that touch start slightly compressed: contact_start() */
  PetscInt       n_parts;    /* ranks that have a part with nodes */
  PetscInt      *owner;      /* n1: of which rank's part each node is */
  PetscInt       further_rings;         /* of the non-mortar side, for bodies that are deep in each other */
  PetscReal      longest_edge;          /* of the mortar side */
  PetscBool      middles;               /* facets have nodes in the middle of their edges */
  PetscBool      uncut, frozen, grown;  /* parts have all of the mortar side; weights are of the reference; the halo has grown in
                                           the step */
  PetscInt       n_grown, n_renewed, n_rebalanced; /* how often parts got more mortar facets within a step; others after one; other nodes */
  double         endured;               /* an imbalance of pairs that no partition was better for */
  ContactPart    part;
  Halo           halo;
  double         friction_work;           /* of all ranks, up to the last converged step */
  double         young, largest_traction; /* of the softer body; up to the last converged step */
  double         confined;                /* modulus of the softer side where it cannot widen; PETSC_MAX_REAL: both are rigid */
  PetscReal      between[4];              /* forces on the nodes that this rank counts: their sum, and that of their sizes */
  char           modulus_from[64];        /* with decisions at points: what the modulus of both bodies is made of */
  stickslip_equilibrium equilibrium;      /* of this part, as last judged (equilibrium.c) */
  Frozen                slide, turn;
  Frozen                overlap, apart, lag; /* over the library's scales, see unseen.c */
  PetscReal             lag_force;           /* of all nodes, over what they press with */
  PetscBool             lag_corrects;        /* a step that lags is solved again: lag.c */
  double               *normals, *lag_change; /* with these, at home, `dimension` numbers each; NULL: those of t_n serve. 3 each: those of
                                                 now less them, when they were found */
  PetscReal             depth;               /* how far the bodies overlap there */
  PetscReal             tied_gap; /* of tied surfaces that are farther apart at the start than is told (kept.c); 0: none are */
} Interface;

/* How the search for equilibrium goes (equilibrium.c) */
typedef struct {
  char      unsettled[256]; /* forces balance, but this in the contact does not; empty: nothing */
  PetscReal violation;      /* its size, and how many iterations it has not changed for */
  PetscInt  n_still;
} Settling;

/* contact/reduction.c */
enum { REDUCTION_ROWS, REDUCTION_COLUMNS, REDUCTION_CONSTRAINED, REDUCTION_DIAGONAL, N_REDUCTION };

typedef struct {
  Mesh      *mesh;
  Physics   *physics;
  PetscInt   n_interfaces;
  Interface *interfaces;
  PetscBool  condensed; /* `unknowns: displacements`: no multiplier is an unknown */
  Mat        linear;    /* of the forces, before condensing; NULL: there is none yet in this attempt */
  Vec        place;     /* where it was made */
  Vec        committed; /* local: displacements at t_n */
  PetscReal  t_committed;
  PetscInt   n_commits;
  PetscBool  scaled;    /* some nodes have another augmentation than the scene's */
  PetscBool  settles;   /* the first phase of a step in two: with normals of its start */
  PetscBool  sticks;    /* likewise: under friction that lets nothing slip */
  PetscBool  reduced;   /* the solver takes its reduced form: E_L - I, E_R - I, Q, s D Q, as REDUCTION_... */
  Mat        reduction[N_REDUCTION];
  Settling   settling;
  PetscReal  lag_left, lag_part; /* lag.c: what the normals in use were wrong by when last looked at; the part of the way that they went then */
  char       refusal[1024]; /* the library's last message, if it refused an evaluation */
  PetscLogDouble seconds_forces, seconds_tangent;
  PetscLogDouble seconds_checks; /* of what forces and weighted gaps do not know: is the contact in equilibrium, sound, seen, in time? */
} Contact;

/* contact_scene.c */
PetscErrorCode contact_read(Scene *scene, Contact *contact);
PetscErrorCode contact_label(Contact *contact);
PetscErrorCode contact_fields(const Contact *contact, Field **fields); /* of the multipliers, one an interface */

/* contact_surfaces.c: an interface's surfaces and nodes; and where these have been put, in the pieces, too */
PetscErrorCode surfaces_read(Scene *scene, Contact *contact, Interface *interface);
PetscErrorCode surfaces_move(Contact *contact, const Interface *interface);
PetscErrorCode surfaces_destroy(Interface *interface);

/* creases.c: the nodes of the non-mortar surface, those on sharp edges once for each side: `nodes`, in place of the homes that there are */
PetscErrorCode creases_split(Scene *scene, const Contact *contact, Interface *interface, PetscInt **nodes); /* NULL: none is split */
PetscErrorCode creases_join(const Mesh *mesh, const Interface *interface, PetscInt owner[]); /* copies of a vertex have one owner */

/* homes.c: the number of a node here in the interface, where those of the mortar side follow the others; from homes to the nodes of these
 * numbers, `width` numbers a node; coordinates of these */
PetscErrorCode homes_create(const Mesh *mesh, Interface *interface);
PetscErrorCode homes_destroy(Interface *interface);
PetscInt       homes_number(const Interface *interface, PetscInt k);
PetscErrorCode homes_fetch_create(const Interface *interface, PetscInt n, const PetscInt numbers[], PetscSF *sf);
PetscErrorCode homes_bcast(PetscSF sf, PetscInt width, const double from[], double to[]);
PetscErrorCode homes_coordinates(const Interface *interface, PetscInt n, const PetscInt numbers[], double X[]);
PetscLogDouble homes_bytes(const Interface *interface); /* that this rank keeps */

/* conserving.c: the method, with the weights that a scene leaves open; once its surfaces are known; after a refusal: is it to be asked anew? */
PetscErrorCode conserving_choose(const Contact *contact, Interface *interface);
PetscErrorCode conserving_look(const Contact *contact, Interface *interface);
PetscBool      conserving_yields(Contact *contact, Interface *interface);

/* weak.c: what becomes of hardly covered nodes; `created`: there is a handle to be asked, and `chosen`: it is to be made anew */
PetscErrorCode weak_choose(Interface *interface, PetscBool created, PetscBool *chosen);

/* symmetry.c: of the non-mortar nodes */
PetscErrorCode symmetry_walls(const Physics *physics, PetscInt axes[], PetscReal *tolerance);
PetscErrorCode symmetry_mask(const Physics *physics, const Interface *interface, PetscInt mask[]);

/* reach.c: of the model's parts, over all that interfaces may join to them */
PetscErrorCode reach_measure(Contact *contact);

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

/* So many facets deep the bodies may be in each other at the start, where an interface is cut into parts. */
enum { PARTS_DEPTH = 1 };

/* partition.c: n nodes of each rank of `comm`, numbered from `first` on, with their coordinates and what each costs: which of so many
 * parts each belongs to */
PetscErrorCode partition_nodes(MPI_Comm comm, PetscInt dimension, PetscInt n, PetscInt first, const double coordinates[],
                               const double work[], PetscMPIInt n_parts, PetscInt owner[]);

/* parts_cut.c: every rank gets the non-mortar side of its part of an interface, by interface->owner; mortar_cut.c: and the mortar side,
 * what its halo asks for. `ends`: where each place of the halo begins */
PetscErrorCode parts_cut(Contact *contact, Interface *interface);
PetscErrorCode parts_destroy(ContactPart *part);
PetscErrorCode mortar_cut(Contact *contact, Interface *interface, PetscInt n_ends, const Vec ends[]);

/* halo.c: a place or a way is one local vector of displacements, or two; the second may be NULL */
PetscErrorCode halo_watch(Contact *contact, Interface *interface);
PetscErrorCode halo_begin(Contact *contact, Interface *interface);
PetscErrorCode halo_settle(Contact *contact, Interface *interface);
PetscErrorCode halo_add(Interface *interface, const Vec ends[2]);
PetscErrorCode halo_covers(const Interface *interface, const Vec ends[2], PetscReal spare, PetscBool *enough);
void           halo_forget(Halo *halo);
PetscErrorCode halo_end(Halo *halo);
PetscErrorCode halo_destroy(Halo *halo);

/* verbs.c: what is asked of the handle of a part, of two sides or of a skin; the library's status */
PetscBool verb_there(const ContactPart *part); /* is there one? */
PetscInt  verb_opposite(const ContactPart *part, PetscInt a); /* of a skin, where it lies near another node; -1: there is none */
int32_t   verb_residual(ContactPart *part);
int32_t   verb_initial_multipliers(ContactPart *part, double lambda[]);
int32_t   verb_step_limit(ContactPart *part, const double dx[], double depth, double *fraction);
int32_t   verb_states(const ContactPart *part, const stickslip_states *wanted);
int32_t   verb_equilibrium(ContactPart *part, stickslip_equilibrium *e);
int32_t   verb_plan(ContactPart *part, int32_t pairs, int64_t *count);
int32_t   verb_plan_coo(ContactPart *part);
int32_t   verb_plan_values(ContactPart *part);
int32_t   verb_use_normals(ContactPart *part, int32_t normals);
int32_t   verb_turn_multipliers(ContactPart *part, double lambda[]);
int32_t   verb_commit(ContactPart *part);
int32_t   verb_rollback(ContactPart *part);
int32_t   verb_history_size(const ContactPart *part, int64_t n[2]);
int32_t   verb_history_export(const ContactPart *part, const int64_t n[2], int64_t integers[], double reals[]);
int32_t   verb_history_import(ContactPart *part, const int64_t n[2], const int64_t integers[], const double reals[]);

/* part.c */
PetscErrorCode part_create(Contact *contact, PetscInt number, PetscInt n, const Vec ways[][2]);
PetscErrorCode part_destroy(ContactPart *part);
PetscErrorCode part_handle(const ContactPart *part, const stickslip_options *options, stickslip_interface **handle,
                           int32_t *refused);
int32_t        part_counters(const ContactPart *part, stickslip_counters *counters);
PetscErrorCode contact_equations(const Contact *contact, PetscSF sf, PetscInt n, int64_t equations[]);

/* work.c */
double         work_clock(void); /* seconds of the processor */
PetscLogDouble work_bytes(const ContactPart *part); /* of a part beside the handle */
PetscErrorCode work_measure(const Interface *interface, PetscMPIInt rank, double work[], PetscReal *depth,
                            PetscReal *shortest);

/* share_out.c: before an evaluation at u_local, or on the way from there; after a step */
PetscErrorCode contact_renew(Contact *contact, PetscInt number, Vec to, PetscInt *status);
PetscErrorCode contact_share_out(Contact *contact);
/* what the parts of an interface know of their nodes, at homes, so many numbers a node; it is freed where it goes back to them, or to new parts, at t_n */
PetscErrorCode parts_knowledge(const Interface *interface, PetscInt *n_a_node, double **all);
PetscErrorCode parts_hand_out(const Interface *interface, double *all);
PetscErrorCode contact_share_out_at_t_n(Contact *contact, PetscInt number, double *all, PetscInt *status);
/* restart.c: a local vector, one of unknowns; t_n and all that comes from before it */
PetscErrorCode contact_archive_vector(Contact *contact, const char *name, Vec local, Archive *archive);
PetscErrorCode contact_archive_unknowns(Contact *contact, const char *name, Vec x, Archive *archive);
PetscErrorCode contact_archive(Contact *contact, Archive *archive);

/* parts.c: of multipliers or vectors, `width` numbers a non-mortar node: all nodes here get their owners' values; so do those at home;
 * owners get what is at home */
PetscErrorCode parts_share(const ContactPart *part, PetscInt width, double values[]);
PetscErrorCode parts_collect(const ContactPart *part, PetscInt width, const double values[], double home[]);
PetscErrorCode parts_send(const ContactPart *part, PetscInt width, const double home[], double values[]);
/* the library's sentence in the interface's numbers and the scene's words; key_words.c: one of these, see there */
void        parts_translate(const ContactPart *part, const char *from, char to[], size_t length);
const char *key_word(const char *from, char to[], size_t length);

/* contact_setup.c, contact.c: `status` > 0 on every rank if the library refused on any, for the reason in contact->refusal */
PetscErrorCode contact_create(Contact *contact, Scene *scene, PetscBool quiet, PetscInt *status);
PetscErrorCode contact_destroy(Contact *contact);
/* adjust.c */
PetscErrorCode contact_adjust(Scene *scene, const Mesh *mesh, Interface *interface);
/* law.c */
void    law_read(Scene *scene, const Space *space, Interface *interface);
int32_t law_set(const Interface *interface, stickslip_interface *handle);
/* what it remembers, out of a part's handle after a commit, and into a new one */
int32_t law_keep(const Interface *interface, ContactPart *part);
int32_t law_restore(const Interface *interface, const ContactPart *part);
/* layer.c; `layer_read` before `law_read` */
void      layer_read(Scene *scene, Interface *interface);
PetscBool layer_slips(Scene *scene, const char *name);
PetscBool layer_is_there(const Interface *interface);
int32_t   layer_set(const Interface *interface, stickslip_interface *handle);
/* decision.c; `settle` when bodies are known */
void           decision_read(Scene *scene, Interface *interface);
PetscBool      decision_is_points(const Interface *interface);
PetscErrorCode decision_hold(Scene *scene, const Contact *contact, Interface *interface);
PetscErrorCode contact_has_middles(const Mesh *mesh, const Interface *interface, PetscBool *any); /* contact_setup.c */
PetscErrorCode decision_settle(const Contact *contact, Interface *interface);
/* store.c: on every rank; at the place of the last evaluation, converged */
PetscErrorCode contact_store(const Contact *contact, PetscReal *store);
/* offsets.c; `fetch` through an SF from homes to the nodes of the part */
PetscErrorCode offsets_read(Scene *scene, const Physics *physics, Interface *interface);
PetscErrorCode offsets_place(Scene *scene, Interface *interface);
PetscErrorCode offsets_fetch(PetscSF sf, Interface *interface);
int32_t        offsets_set(const Interface *interface, stickslip_interface *handle, PetscReal t);
PetscErrorCode offsets_values(Contact *contact, PetscReal t, PetscInt *status);
PetscErrorCode offsets_destroy(Interface *interface);
/* exchange.c */
PetscErrorCode contact_agree(Contact *contact, const Interface *interface, int32_t refused, PetscInt *status);
PetscErrorCode contact_largest(const Mesh *mesh, PetscReal *value, size_t bytes, void *what);
void           contact_positions(ContactPart *part);
/* of a node, from vectors of so many numbers; the third component is 0 in the plane */
void           contact_vector(PetscInt dimension, const PetscScalar vectors[], PetscInt node, PetscReal v[3]);
PetscErrorCode contact_fetch(PetscSF sf, Vec local, PetscScalar *to);
PetscErrorCode contact_gather(Contact *contact, Interface *interface, Vec local);
PetscErrorCode contact_scatter(const ContactPart *part, const PetscScalar *from, Vec local, MPI_Op operation);
/* contact.c */
PetscErrorCode contact_start(Contact *contact, Vec x, PetscInt *status);
PetscErrorCode contact_forces(Contact *contact, Vec f_local, PetscInt *status); /* adds, to the parts' squares, too */
PetscErrorCode contact_commit(Contact *contact, Vec x, PetscInt *status); /* in x multipliers may change, of general contact */
/* along.c: adds what forces and rows change by where all of this changes; at the place of the last evaluation */
typedef struct {
  PetscInt  interface;                     /* of which friction, limit and offset are */
  PetscReal friction, shear_limit, offset; /* of all its non-mortar nodes */
  Vec       previous, now;                 /* local: displacements at t_n, of now; NULL: they stay */
  PetscBool multipliers;                   /* those of `now` change the forces, too */
} ContactDirection;
PetscErrorCode contact_along(Contact *contact, const ContactDirection *direction, Vec f_local, PetscInt *status);
PetscBool      contact_mortar_stays(const ContactPart *part); /* then all of it must be held by one support, a component */
/* skin.c: of node a of the part, by what lies opposite in a skin */
PetscReal contact_friction(const Mesh *mesh, const Interface *interface, PetscInt a);
/* joints.c: bodies that contact joins at these states of all interfaces' nodes at home, or could; to be freed */
typedef struct {
  PetscInt  bodies[2];
  PetscBool joined;
} Joint;

PetscErrorCode contact_joints(const Contact *contact, const int32_t states[], PetscInt *n, Joint **joints);
/* again.c */
PetscErrorCode contact_looks_anew(Contact *contact, PetscBool *anew);
PetscErrorCode contact_exchange(Contact *contact, Vec x, PetscBool *any);
/* the fraction of a step that one interface allows, which leads `depth` deep at most; `step`: local, of u_local */
PetscErrorCode contact_step_limit(Contact *contact, PetscInt number, Vec step, PetscReal depth, PetscReal *fraction);

/* rigid_part.c */
PetscErrorCode rigid_part_create(const Contact *contact, const Interface *interface, PetscInt first_number, ContactPart *part);
PetscErrorCode rigid_part_destroy(ContactPart *part);
PetscErrorCode rigid_part_plan(const Contact *contact, ContactPart *part, int64_t count);
PetscErrorCode rigid_part_values(const Contact *contact, ContactPart *part, const PetscScalar *forces);
Entries        rigid_part_entries(const ContactPart *part, int64_t count);

/* tangent.c */
PetscErrorCode contact_tangent(Contact *contact, Mat matrix, PetscInt *status);
PetscErrorCode contact_pattern(Contact *contact, Mat matrix);
void           contact_forget_plans(Contact *contact);
/* into the part's arrays: a piece of the condensed matrix, STICKSLIP_CONDENSED_... */
PetscErrorCode contact_entries(const Contact *contact, ContactPart *part, int32_t piece, Entries *found, int32_t *refused);

/* supported.c: nothing happens where multipliers are unknowns */
PetscErrorCode condensed_refuse_supported(Scene *scene, const Contact *contact, const Interface *interface);
/* condensed.c: likewise */
PetscErrorCode condensed_check(const Contact *contact, char why[], size_t length);
PetscErrorCode condensed_create(Contact *contact, PetscInt *status);
PetscErrorCode condensed_destroy(Contact *contact);
void           condensed_predict(Contact *contact, PetscReal factor);
PetscErrorCode condensed_begin(Contact *contact);
PetscErrorCode condensed_eliminate(Contact *contact, Vec x, PetscInt *status);
PetscErrorCode condensed_residual(Contact *contact, Vec r, PetscInt *status);
PetscErrorCode condensed_matrix(Contact *contact, Vec x, Mat J, PetscInt *status);
void           condensed_accept(Contact *contact);

/* pieces.c: a piece of all interfaces, STICKSLIP_CONDENSED_..., in a matrix like another one */
PetscErrorCode condensed_piece(Contact *contact, int32_t piece, Mat like, Mat *matrix, PetscInt *status);

/* reduction.c: nothing happens where nobody wants it */
PetscErrorCode reduction_make(Contact *contact, Mat like, PetscInt *status);
PetscErrorCode reduction_destroy(Contact *contact);

/* normals.c */
PetscBool      normals_follow(const Contact *contact); /* those of any interface */
PetscErrorCode normals_use(Contact *contact, int32_t normals); /* STICKSLIP_NORMALS_..., where they follow */
PetscErrorCode normals_turn_multipliers(Contact *contact, Vec x);

/* sticking.c: friction that lets nothing slip, for a while */
PetscBool      sticking_possible(const Contact *contact); /* is there Coulomb friction? */
PetscErrorCode sticking_use(Contact *contact, PetscBool sticks);
int32_t        sticking_set(const Contact *contact, const Interface *interface, stickslip_interface *handle);

/* states.c: at the place of the last evaluation, of the nodes at home */
PetscErrorCode contact_collect(Contact *contact);
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
PetscErrorCode contact_results(const ContactPart *part, double results[]);
PetscErrorCode contact_states_destroy(ContactStates *states);
/* of all interfaces at u_local */
PetscErrorCode contact_tendencies(Contact *contact, int32_t *state, double *tangential); /* 3 a node */
PetscErrorCode contact_scale_augmentation(Contact *contact, const PetscBool *marked, PetscReal factor);
PetscErrorCode contact_reset_augmentation(Contact *contact);

/* cover.c: on every rank; `handle`: the part's, or NULL; `facets` (n1 of the part, or NULL): of the mortar side over those
 * around each node */
PetscErrorCode contact_cover(const Interface *interface, stickslip_interface *handle, PetscMPIInt rank, ContactCover *cover,
                             int64_t facets[]);

/* diagnose.c: on every rank; rank 0 gets the answer */
PetscErrorCode contact_diagnose(const Interface *interface, PetscMPIInt rank, ContactDiagnosis *diagnosis);

/* equilibrium.c */
PetscErrorCode equilibrium_judge(Contact *contact, PetscReal rtol, PetscBool *holds, PetscBool *stuck);
void           equilibrium_restart(Contact *contact);
void           equilibrium_accept(Contact *contact);

/* sound.c: at the place of the last evaluation, in equilibrium: what no contact can be, in words; empty: nothing */
PetscErrorCode contact_sound(Contact *contact, char why[], size_t length);
/* newly.c: nodes that a step newly covers; does the law rub? */
PetscBool      newly_rubs(const stickslip_options *options);
PetscErrorCode newly_check(const Contact *contact, char why[], size_t length);

/* slide.c */
PetscBool      weights_are_of_now(const Interface *interface);
PetscErrorCode slide_check(Contact *contact, PetscReal *slid, char why[], size_t length);
PetscErrorCode slide_accept(Contact *contact);
PetscErrorCode slide_find(const Interface *interface, const Mesh *mesh, double found, int64_t node, Frozen *frozen, PetscReal where[4]);

/* unseen.c */
PetscErrorCode unseen_check(Contact *contact, PetscBool last, PetscBool *late, PetscReal *ratio, char why[], size_t length);
PetscErrorCode unseen_accept(Contact *contact);
PetscErrorCode unseen_end(const Contact *contact);
/* lag.c: a converged step is solved again with the normals that it has reached */
PetscErrorCode lag_shows(const Contact *contact, PetscBool *shows);
PetscErrorCode lag_take_normals(Contact *contact, PetscBool may, PetscBool *changed);
PetscErrorCode lag_set(const Interface *interface, stickslip_interface *handle, int32_t *refused);
PetscErrorCode lag_forget(Contact *contact);
/* kept.c: overlaps at the start that conserving weights leave, and across what gap surfaces are tied, after contact_gather() */
PetscErrorCode kept_tell(const Contact *contact, Interface *interface);
/* chords.c: facets that do not touch though the curved surfaces may; there, too */
PetscErrorCode chords_tell(const Interface *interface);

/* The library's status as a PETSc error, where a refusal is not something to recover from. */
#define PetscCallStickslip(...)                                                                                        \
  do {                                                                                                                 \
    const int32_t status_of_call = (__VA_ARGS__);                                                                      \
    PetscCheck(status_of_call == 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s", stickslip_last_error_message());  \
  } while (0)
#endif
