/* A rank's part of an interface, and what is asked of the library's handle there. */
#ifndef STICKSLIP_PROGRAM_PART_H
#define STICKSLIP_PROGRAM_PART_H
#include "contact/halo.h"
#include "contact/results.h"

/* Rigid bodies in a part (rigid_part.c) */
typedef struct RigidPart RigidPart;

/* General contact (skin.h): what the scene says of it, and the library's handle of it */
typedef struct Skin Skin;
typedef struct SkinPart SkinPart;

/* A rank's part of an interface, with a handle of the library's own (parts.c): the non-mortar nodes that the rank owns, the
 * facets around them as far as these need them, and the mortar facets that may come near. Nodes and facets are numbered as they are here. */
struct ContactPart {
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
};

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

/* parts.c: of multipliers or vectors, `width` numbers a non-mortar node: all nodes here get their owners' values; so do those at home;
 * owners get what is at home */
PetscErrorCode parts_share(const ContactPart *part, PetscInt width, double values[]);
PetscErrorCode parts_collect(const ContactPart *part, PetscInt width, const double values[], double home[]);
PetscErrorCode parts_send(const ContactPart *part, PetscInt width, const double home[], double values[]);
/* the library's sentence in the interface's numbers and the scene's words; key_words.c: one of these, see there */
void        parts_translate(const ContactPart *part, const char *from, char to[], size_t length);
const char *key_word(const char *from, char to[], size_t length);
/* what the parts of an interface know of their nodes, at homes, so many numbers a node; it is freed where it goes back to them, or to
 * new parts, at t_n (share_out.c) */
PetscErrorCode parts_knowledge(const Interface *interface, PetscInt *n_a_node, double **all);
PetscErrorCode parts_hand_out(const Interface *interface, double *all);

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

/* exchange.c */
void           contact_positions(ContactPart *part);
/* of a node, from vectors of so many numbers; the third component is 0 in the plane */
void           contact_vector(PetscInt dimension, const PetscScalar vectors[], PetscInt node, PetscReal v[3]);
PetscErrorCode contact_fetch(PetscSF sf, Vec local, PetscScalar *to);
PetscErrorCode contact_scatter(const ContactPart *part, const PetscScalar *from, Vec local, MPI_Op operation);

/* along.c: it must then be held by one support, a component, all of it */
PetscBool      contact_mortar_stays(const ContactPart *part); /* then all of it must be held by one support, a component */

/* rigid_part.c */
PetscErrorCode rigid_part_create(const Contact *contact, const Interface *interface, PetscInt first_number, ContactPart *part);
PetscErrorCode rigid_part_destroy(ContactPart *part);
PetscErrorCode rigid_part_plan(const Contact *contact, ContactPart *part, int64_t count);
PetscErrorCode rigid_part_values(const Contact *contact, ContactPart *part, const PetscScalar *forces);
Entries        rigid_part_entries(const ContactPart *part, int64_t count);
#endif
