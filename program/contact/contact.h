/* The contact interfaces of the scene: the binding to the stickslip library, and whether they are in equilibrium. */
#ifndef STICKSLIP_PROGRAM_CONTACT_H
#define STICKSLIP_PROGRAM_CONTACT_H
#include "contact/interface.h"

/* How the search for equilibrium goes (equilibrium.c) */
typedef struct {
  char      unsettled[256]; /* forces balance, but this in the contact does not; empty: nothing */
  PetscReal violation;      /* its size, and how many iterations it has not changed for */
  PetscInt  n_still;
} Settling;

/* contact/reduction.c */
enum { REDUCTION_ROWS, REDUCTION_COLUMNS, REDUCTION_CONSTRAINED, REDUCTION_DIAGONAL, N_REDUCTION };

struct Contact {
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
};

/* contact_scene.c */
PetscErrorCode contact_read(Scene *scene, Contact *contact);
PetscErrorCode contact_label(Contact *contact);
PetscErrorCode contact_fields(const Contact *contact, Field **fields); /* of the multipliers, one an interface */

/* reach.c: of the model's parts, over all that interfaces may join to them */
PetscErrorCode reach_measure(Contact *contact);

/* share_out.c: before an evaluation at u_local, or on the way from there; after a step */
PetscErrorCode contact_renew(Contact *contact, PetscInt number, Vec to, PetscInt *status);
PetscErrorCode contact_share_out(Contact *contact);
PetscErrorCode contact_share_out_at_t_n(Contact *contact, PetscInt number, double *all, PetscInt *status);
/* restart.c: a local vector, one of unknowns; t_n and all that comes from before it */
PetscErrorCode contact_archive_vector(Contact *contact, const char *name, Vec local, Archive *archive);
PetscErrorCode contact_archive_unknowns(Contact *contact, const char *name, Vec x, Archive *archive);
PetscErrorCode contact_archive(Contact *contact, Archive *archive);

/* contact_setup.c, contact.c: `status` > 0 on every rank if the library refused on any, for the reason in contact->refusal */
PetscErrorCode contact_create(Contact *contact, Scene *scene, PetscBool quiet, PetscInt *status);
PetscErrorCode contact_destroy(Contact *contact);
/* store.c: on every rank; at the place of the last evaluation, converged */
PetscErrorCode contact_store(const Contact *contact, PetscReal *store);
/* exchange.c */
PetscErrorCode contact_agree(Contact *contact, const Interface *interface, int32_t refused, PetscInt *status);
PetscErrorCode contact_largest(const Mesh *mesh, PetscReal *value, size_t bytes, void *what);
PetscErrorCode contact_gather(Contact *contact, Interface *interface, Vec local);
/* on every vertex here, of all ranks and interfaces, at the place of the last evaluation */
PetscErrorCode contact_on_vertices(const Contact *contact, Vec local);
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

/* states.c: of all interfaces at u_local */
PetscErrorCode contact_tendencies(Contact *contact, int32_t *state, double *tangential); /* 3 a node */
PetscErrorCode contact_scale_augmentation(Contact *contact, const PetscBool *marked, PetscReal factor);
PetscErrorCode contact_reset_augmentation(Contact *contact);

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
/* slopes.c */
PetscErrorCode slopes_tell(const Contact *contact, const Interface *interface);
/* lonely.c */
PetscInt       lonely_few(PetscInt dimension);
PetscErrorCode lonely_tell(const Interface *interface, const Mesh *mesh);
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
