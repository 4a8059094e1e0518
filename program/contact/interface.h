/* One contact interface: what the scene says of it, and what follows from that. */
#ifndef STICKSLIP_PROGRAM_INTERFACE_H
#define STICKSLIP_PROGRAM_INTERFACE_H
#include "contact/part.h"

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

/* How far surfaces with frozen weights have slid, over the size of facets, or turned, in radians (slide.c); what is allowed; in
 * words, where that is more; and whether it was told. */
typedef struct {
  PetscReal amount, most;
  char      words[256];
  PetscBool told;
} Frozen;

/* One contact interface: what the scene says of it, this rank's part, and what is known of the nodes that are at home here. */
struct Interface {
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
  double         young, density, largest_traction; /* of the softer body; of the lighter one against a rigid one, else 0; up to the last converged step */
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
};

/* contact_surfaces.c: an interface's surfaces and nodes; and where these have been put, in the pieces, too */
PetscErrorCode surfaces_read(Scene *scene, Contact *contact, Interface *interface);
PetscErrorCode surfaces_move(Contact *contact, const Interface *interface);
PetscErrorCode surfaces_destroy(Interface *interface);
PetscErrorCode surfaces_have_middles(const Mesh *mesh, const Interface *interface, PetscBool *any); /* nodes that are no corners of faces */

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
PetscErrorCode decision_settle(const Contact *contact, Interface *interface);
/* offsets.c; `fetch` through an SF from homes to the nodes of the part */
PetscErrorCode offsets_read(Scene *scene, const Physics *physics, Interface *interface);
PetscErrorCode offsets_place(Scene *scene, Interface *interface);
PetscErrorCode offsets_fetch(PetscSF sf, Interface *interface);
int32_t        offsets_set(const Interface *interface, stickslip_interface *handle, PetscReal t);
PetscErrorCode offsets_values(Contact *contact, PetscReal t, PetscInt *status);
PetscErrorCode offsets_destroy(Interface *interface);
#endif
