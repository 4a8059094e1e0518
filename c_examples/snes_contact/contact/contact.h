/* The contact interfaces of the scene: the binding to the stickslip library, and whether they are in equilibrium. */
#ifndef SNES_CONTACT_CONTACT_H
#define SNES_CONTACT_CONTACT_H
#include "physics/physics.h"
#include <stickslip.h>

/* Where surfaces are beside their meshes (offsets.c): `offset` of all nodes of the non-mortar side and of some, each node's, the
 * factor on them; of round sides their shape, and each node's; at time t; what `adjust` has done (adjust.c). */
typedef struct {
  PetscBool any;
  PetscReal all;
  PetscInt  n_points;
  PetscReal *points, *nodal;
  Curve      curve;
  PetscReal  radius[2], centre[3], axis[3]; /* 0: a side is not round */
  int32_t    shape;
  double    *round[2], *now;
  PetscReal  adjust; /* tolerance; 0: nothing is adjusted */
  double    *gaps;
  int32_t   *moved;
} Offsets;

/* One contact interface; the library's handle and all its arrays live on rank 0 (see contact.c). */
typedef struct {
  char                 name[NAME_LENGTH];
  const Surface       *surface[2]; /* non-mortar, mortar */
  PetscInt             n1, n2;     /* their numbers of nodes */
  PetscInt            *nodes;      /* n1 + n2 mesh vertices */
  PetscInt             dimension;  /* numbers a node of every vector here: 3, in the plane 2 */
  PetscInt             components; /* multipliers a node: 1, along the normal, without friction; else `dimension` */
  PetscInt            *removed;    /* n1: mask of directions without a multiplier, see read_surfaces() */
  PetscBool           *middle;     /* n1: no multiplier, since it is no corner of a face */
  stickslip_options    options;
  PetscBool            initial_contact; /* nodes that touch start slightly compressed: contact_start() */
  double              *X, *x;     /* n1 + n2 vectors: reference coordinates; current ones, see contact_positions() */
  PetscScalar         *gathered;  /* n1 + n2 displacement vectors, components n1 multipliers */
  PetscScalar         *forces;    /* same layout: f1, f2, multiplier rows */
  int64_t             *equations; /* same layout */
  PetscSF              sf;        /* from the local vectors of all ranks to `gathered` */
  stickslip_interface *handle;
  /* condensed.c: multipliers, now and at the start of the step, of the last two; as `forces`, those of bodies and loads
   * and what condensing adds to the residual; where the last matrix was made, the former and the positions */
  double              *lambda, *lambda_start, *lambda_last, *lambda_before, *host, *rows, *host_there, *x_there;
  int64_t              coo_capacity, *coo_rows, *coo_columns;
  int64_t              planned; /* the entries of the library's plan, which lie in these arrays; 0: there is none */
  double              *coo_values;
  double               friction_work; /* up to the last converged step */
  double               young, largest_traction; /* of the softer body; up to the last converged step */
  Offsets               offsets;
  stickslip_equilibrium equilibrium;  /* as last judged (equilibrium.c) */
  int64_t              bytes;         /* of the library's, the most at the end of a step */
} Interface;

/* In the interface's arrays: where the mortar's vectors begin, where the multipliers do. */
#define MORTAR_OF(interface, array) ((array) + (interface)->dimension * (interface)->n1)
#define MULTIPLIERS_OF(interface, array) ((array) + (interface)->dimension * ((interface)->n1 + (interface)->n2))
/* The library takes x1, x2 and the multipliers: */
#define STATE_OF(interface)                                                                                            \
  (interface)->x, MORTAR_OF(interface, (interface)->x), MULTIPLIERS_OF(interface, (interface)->gathered)

/* nodal results of one interface; every array has n1 entries, vectors 3 n1, in the plane too */
typedef struct {
  int32_t *state;
  double  *normal, *multiplier, *gap, *slip, *coverage, *area, *dissipation; /* multiplier: as a vector */
} ContactStates;

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
  PetscBool  reduced;   /* the solver takes its reduced form: E_L - I, E_R - I, Q, s D Q, as REDUCTION_... */
  Mat        reduction[N_REDUCTION];
  Settling   settling;
  char       refusal[1024]; /* the library's last message, if it refused an evaluation */
  PetscLogDouble seconds_forces, seconds_tangent;
} Contact;

/* contact_scene.c */
PetscErrorCode contact_read(Scene *scene, Contact *contact);
PetscErrorCode contact_label(Contact *contact);
PetscErrorCode contact_fields(const Contact *contact, Field **fields); /* of the multipliers, one an interface */

/* symmetry.c */
PetscErrorCode symmetry_mask(const Physics *physics, const Interface *interface, PetscInt *mask);

/* reach.c: of the model's parts, over all that interfaces may join to them */
PetscErrorCode reach_measure(Contact *contact);

/* contact_setup.c, contact.c: `status` > 0 on every rank if the library refused, for the reason in contact->refusal */
PetscErrorCode contact_create(Contact *contact, Scene *scene, PetscBool quiet, PetscInt *status);
PetscErrorCode contact_destroy(Contact *contact);
/* rank 0: a side from `x` and `equations` of the interface; `facet_nodes` is the caller's to free */
PetscErrorCode contact_surface(const Contact *contact, const Interface *interface, int side, stickslip_surface *out,
                               int64_t **facet_nodes);
/* adjust.c, rank 0 */
PetscErrorCode contact_adjust(Scene *scene, Contact *contact, Interface *interface);
/* offsets.c; place and create on rank 0 */
PetscErrorCode offsets_read(Scene *scene, const Physics *physics, Interface *interface);
PetscErrorCode offsets_place(Scene *scene, const Mesh *mesh, Interface *interface);
int32_t        offsets_create(const Mesh *mesh, Interface *interface);
int32_t        offsets_set(const Interface *interface, stickslip_interface *handle, PetscReal t);
PetscErrorCode offsets_values(Contact *contact, PetscReal t, PetscInt *status);
PetscErrorCode offsets_destroy(Interface *interface);
PetscErrorCode contact_agree(Contact *contact, int32_t refused, PetscInt *status);
void           contact_positions(Interface *interface);
/* of a node, from vectors of the interface; the third component is 0 in the plane */
void           contact_vector(const Interface *interface, const PetscScalar vectors[], PetscInt node, PetscReal v[3]);
PetscErrorCode contact_fetch(const Interface *interface, Vec local, PetscScalar *to);
PetscErrorCode contact_gather(Contact *contact, Interface *interface, Vec local);
PetscErrorCode contact_start(Contact *contact, Vec x, PetscInt *status);
PetscErrorCode contact_forces(Contact *contact, Vec f_local, PetscInt *status); /* adds, to the parts' squares, too */
PetscErrorCode contact_tangent(Contact *contact, Mat matrix, PetscInt *status);
PetscErrorCode contact_pattern(Contact *contact, Mat matrix);
void           contact_forget_plans(Contact *contact);
PetscErrorCode contact_commit(Contact *contact, PetscInt *status);

/* rank 0: into the interface's arrays: a piece of the condensed matrix, STICKSLIP_CONDENSED_... */
PetscErrorCode contact_entries(Interface *interface, int32_t piece, int64_t *count, int32_t *refused);
PetscErrorCode contact_scatter(Interface *interface, const PetscScalar *from, Vec local, MPI_Op operation);

/* condensed.c: nothing happens where multipliers are unknowns */
PetscErrorCode condensed_check(const Contact *contact, char why[], size_t length); /* rank 0 */
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

/* states.c */
PetscErrorCode contact_states_create(const Interface *interface, ContactStates *states); /* rank 0 */
PetscErrorCode contact_states_destroy(ContactStates *states);
/* of all interfaces at u_local */
PetscErrorCode contact_tendencies(Contact *contact, int32_t *state, double *tangential); /* 3 a node */
PetscErrorCode contact_scale_augmentation(Contact *contact, const PetscBool *marked, PetscReal factor);

/* equilibrium.c */
PetscErrorCode equilibrium_judge(Contact *contact, PetscReal rtol, PetscBool *holds, PetscBool *stuck);
void           equilibrium_restart(Contact *contact);
void           equilibrium_accept(Contact *contact);

/* The library's status as a PETSc error, where a refusal is not something to recover from. */
#define PetscCallStickslip(...)                                                                                        \
  do {                                                                                                                 \
    const int32_t status_of_call = (__VA_ARGS__);                                                                      \
    PetscCheck(status_of_call == 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s", stickslip_last_error_message());  \
  } while (0)
#endif
