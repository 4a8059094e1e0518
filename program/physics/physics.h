/* What the bodies are made of and what acts on them: materials, supports, loads, the unknowns, this rank's cells, and
 * the parts on which forces must balance.
 *
 * Unknowns live in two kinds of vectors, as PETSc has them: a *local* vector holds 3 displacements per vertex of this rank
 * and the multipliers of its vertices, prescribed ones included; a *global* vector holds the equations only. In a plane or
 * axisymmetric model the third displacement is prescribed to be zero. */
#ifndef STICKSLIP_PROGRAM_PHYSICS_H
#define STICKSLIP_PROGRAM_PHYSICS_H
#include "mesh/mesh.h"
#include "physics/elasticity.h"
#include "physics/element_loads.h"
#include "scene/archive.h"
#include "scene/curve.h"
#include <stickslip.h>

struct cJSON;
typedef struct Dynamics Dynamics; /* dynamics.h */
typedef struct Springs  Springs;  /* springs.h */
typedef struct Timed    Timed;    /* timed.h */

/* x - origin = R (X - origin + factor(t) (value + given + gradient (X - origin))) in the components of the mask (bit i:
 * axis i); R turns about `rotate` by rotate_factor(t) |rotate| radians */
typedef struct {
  char      name[NAME_LENGTH];
  PetscInt  mask;
  PetscInt  rigid, turns; /* the rigid body that it is of, -1: none; which of its turns it prescribes, as `mask` */
  PetscReal value[3], gradient[9], origin[3], rotate[3];
  Curve     curve, rotate_curve;
  PetscInt  n_vertices, *vertices; /* of the piece of the mesh; forgotten once it is distributed */
  PetscBool  from_file;
  PetscReal *given; /* from a file, 3 per vertex of the piece, once it is distributed of those here */
  PetscBool timed, active;       /* it does not hold from start to end; it does in the step of now. Others are active always. */
  PetscReal from, until, fade;   /* timed: it holds from one time to the other; how long its reaction takes to fade, -1: not said */
  /* of the last evaluation, summed over ranks by supports_reactions(); the moment is about `origin`, of a rigid body that of the
   * turns that are prescribed */
  PetscReal reaction[3], moment[3];
} Support;

/* fluid.h */
typedef struct Fluid Fluid;

typedef struct {
  char            name[NAME_LENGTH];
  PetscReal       traction[3], pressure;
  Fluid          *fluid;   /* the pressure gets between the surfaces of interfaces; NULL: it does not */
  PetscBool       follows; /* the pressure acts on the surface as it is now */
  PetscReal       turned;  /* by how much a surface under a pressure that does not follow it has turned (loads_turned.c) [rad] */
  Acceleration    acceleration;
  PetscReal       force[3], moment[3], point[3]; /* at the reference points of rigid bodies; at a point, spread over the surfaces; on a node */
  PetscBool       remote, given_point; /* spread over the surfaces; from `point`, not from their middle */
  PetscInt        vertex;              /* number of the node that the force is on; -1: none */
  PetscBool      *bodies; /* per body: is it loaded? NULL: a load on surfaces */
  Curve           curve;
  PetscInt        n_surfaces;
  const Surface **surfaces;        /* of the piece */
  PetscInt        n_faces, *faces; /* this rank's, as points of the DMPlex */
  Vec             forces;   /* local vector of the nodal forces at factor 1, but for a follower; ranks add up */
} Load;

/* A rigid body (rigids.c). Arrays of six: displacement of the reference point, rotation; force, moment. */
enum { RIGID_UNKNOWNS = 6 };

typedef struct {
  PetscInt  body, first_vertex, end_vertex; /* of the mesh */
  PetscReal mass;
  /* with `dynamics`, where `inertial`: it is not held in all, and moves by its inertia: about the reference point along the axes of the first
   * configuration; at t_n the displacement, velocity and, along the axes that turn with the body, spin */
  PetscBool inertial, has_inertia, lag_told; /* lag_told: that it turns too slowly */
  PetscReal inertia[9], place[3], velocity[3], spin[3];
  /* of its unknowns those whose rate supports give at the end of the step, of turns all or none; these rates, of turns along the axes of space */
  PetscInt  led;
  PetscReal rate[RIGID_UNKNOWNS];
  PetscInt  part;                     /* among the model's parts; -1: none of its cells is here */
  PetscInt  held, turned_by;          /* mask of prescribed unknowns; of rotations (from bit 3 on) that a support turns by an angle */
  PetscInt  support[RIGID_UNKNOWNS];  /* which one prescribes each; -1: none */
  PetscReal point[3], length;         /* reference point; the largest distance of a node from it */
  PetscInt  equations[RIGID_UNKNOWNS]; /* -1: prescribed */
  double    turned[9];                /* row by row, up to the last step */
  PetscReal motion[RIGID_UNKNOWNS];   /* of now; the rotation vector of the step */
  PetscReal sum[3];                   /* of these vectors, over the steps before */
  PetscReal contact[RIGID_UNKNOWNS];  /* the forces of this rank's nodes, at the last evaluation */
  PetscReal on_body[RIGID_UNKNOWNS], reaction[RIGID_UNKNOWNS]; /* rigids_reactions(): by contact, by supports */
  PetscBool owned;                    /* this rank owns its two vertices */
  PetscInt  at[2];                    /* their places in a local vector; -1: none of the body is here */
  PetscInt  n_nodes, *dofs;           /* the nodes here: places in a local vector */
  double   *arms;                     /* of each, from the reference point, undeformed */
} Rigid;

/* What a vertex may have beside its displacement. A label of the mesh says which vertices have it. The label's value
 * says which components are no unknowns (bit i: component i); FIELD_COPY times how many more copies of it the vertex has. */
enum { FIELD_COPY = 8 };

typedef struct {
  char     name[NAME_LENGTH], label[2 * NAME_LENGTH];
  PetscInt components;
} Field;

typedef struct {
  PetscInt        n_fields; /* beside the displacement, which is field 0 */
  Field          *fields;   /* field 1 + i at [i] */
  PetscSection    section;
  PetscInt        n_local;
  const PetscInt *equations; /* of each local entry, -1: prescribed */
  PetscInt       *owner;     /* of a range of the mesh's vertices: rank, then the local offset of each field there */
  PetscBool      *ghost;     /* per vertex here: another rank owns it */
  PetscSF         ghosts;    /* from its entries there to those here; NULL on a single rank */
} Unknowns;

/* This rank's cells */
typedef struct {
  PetscInt   n, *offsets, *dofs, *body, *part; /* dofs: local offset of each node */
  PetscReal *X, *stiffness;                    /* coordinates of the nodes; stiffness at rest */
  PetscReal *swell;                            /* of each node: strain without stress; NULL: nothing of finite strain expands */
} Cells;

/* Connected cells: bodies, or pieces of them, that nothing but contact joins to others */
typedef struct {
  PetscInt  first, cluster;         /* number of its first vertex; which parts interfaces may join to it: reach_measure() */
  PetscReal young, size, reach;     /* the stiffest E; its size, and of all that contact may join to it */
  PetscReal reference, felt;        /* its forces at the last evaluation; the largest of a converged step */
  PetscReal faint;                  /* a first reference, too small to matter */
  PetscReal loads, residual, noise; /* at the last evaluation */
  PetscReal carried, exerted;       /* likewise: what it carries, whatever contact says (balance.c); reactions and contact forces */
} Part;

/* Sums of squares of a part's nodal forces */
enum { SQUARES_LOADS, SQUARES_REACTIONS, SQUARES_CONTACT, SQUARES_ROUNDING, SQUARES_RESIDUAL, SQUARES_CARRIED, N_SQUARES };

typedef struct {
  PetscInt   n, *of_piece, *of_vertex; /* part of each vertex of the piece; of each vertex here */
  Part      *part;
  PetscReal *squares;         /* N_SQUARES per part, of the last evaluation */
  PetscReal  reference_force; /* of all of them */
  /* of a system without multipliers: the parts that each interface joins, from group_starts[g] on in `grouped` */
  PetscInt   n_groups, *group_starts, *grouped;
} Parts;

/* What a body of the linear material was strained and turned by, up to now (range.c) */
typedef struct {
  PetscReal strain, rotation;
  PetscBool told;
} Range;

typedef struct {
  Mesh     *mesh;
  PetscReal end, t; /* of the run; the time that the values below belong to */
  Material *materials; /* per body */
  PetscInt  n_supports, n_loads;
  Support  *supports;
  Load     *loads;
  PetscInt *prescribed; /* mask of prescribed displacements per vertex of the piece */
  PetscInt  n_rigids;
  Rigid    *rigids;
  PetscReal t_turned;      /* the time of the last step, from which their rotations count */
  PetscBool rigid_refused; /* the library takes no such motion; why: `inverted` */
  Unknowns  unknowns;
  Cells     cells;
  Parts     parts;
  Range    *ranges; /* per body */
  Vec       u_local, f_local, prescribed_local; /* local vectors: state, forces, values of prescribed entries at t */
  Vec       f_external;                         /* local, at t */
  Vec       f_thermal;                          /* local: what warm bodies are pushed apart by; NULL: none expands */
  Vec       f_sum;                              /* local: work space of unknowns_sum() */
  char      inverted[256];                      /* which cell the last attempt at a step has turned inside out, or the like */
  PetscLogDouble seconds;                       /* in bulk_forces() and bulk_stiffness() */
  Dynamics      *dynamics;                      /* NULL: statics */
  Springs       *springs;                       /* NULL: none */
  Timed         *timed;                         /* NULL: every support holds from start to end */
} Physics;

/* material_scene.c */
PetscErrorCode materials_read(Scene *scene, Physics *physics);

/* supports_scene.c, supports.c */
PetscErrorCode supports_read(Scene *scene, Physics *physics);
PetscErrorCode supports_label(Physics *physics);
/* at a vertex of the piece, or any place if no file says what is prescribed there */
PetscBool supports_agree(const Physics *physics, const Support *a, const Support *b, PetscInt vertex, const PetscReal X[3],
                         int component);
PetscErrorCode supports_values(Physics *physics, PetscReal t); /* into prescribed_local */
/* velocities or accelerations of what is prescribed: at a kink of a curve the mean of before and after, where a support begins or ceases to
 * hold what is within its time; of vertices of rigid bodies none */
typedef enum { SUPPORT_PLACE, SUPPORT_VELOCITY, SUPPORT_ACCELERATION } SupportMotion;
PetscErrorCode supports_rates(Physics *physics, PetscReal t, SupportMotion motion, Vec local);
/* of which rate that is at t: 0 before, 1 after, 2 the mean */
int            support_sides(const Physics *physics, const Support *support, PetscReal t);
PetscErrorCode supports_reactions(Physics *physics);
/* reactions.c */
PetscErrorCode supports_shared(const Physics *physics, PetscBool shared[], PetscReal twice[3]);
PetscErrorCode supports_fading(const Physics *physics, const Support *support, PetscReal force[3], PetscBool *fades);
/* which support turns each part, -1: none; a position turned as that support does from t0 to t */
PetscErrorCode supports_turning(const Physics *physics, PetscInt support_of[]);
void           supports_turn(const Support *support, PetscReal t0, PetscReal t, PetscReal x[3]);

/* timed_scene.c, timed.c, timed_rows.c, timed_change.c: supports that hold for a part of the run. Their displacements are unknowns, in whose rows stands, while they hold, u = what the
 * support says. All of these are for no such support, too. */
PetscErrorCode timed_read(Scene *scene, Physics *physics, Support *support);
PetscErrorCode timed_check(Scene *scene, const Physics *physics); /* once their vertices are known */
const Support *timed_first(const Physics *physics);               /* NULL: none */
/* of an interface: its name and surfaces, whether it has multipliers of normals alone, and whether these are no unknowns */
typedef struct {
  const char    *interface;
  const Surface *surface[2];
  PetscBool      normal_only, condensed;
} TimedSides;
PetscErrorCode timed_refuse(Scene *scene, const Physics *physics, const TimedSides *sides); /* on nodes with multipliers */
PetscErrorCode timed_create(Physics *physics);                    /* once there are unknowns */
PetscErrorCode timed_destroy(Physics *physics);
/* for the step that ends at t: which hold, `changed`: others than before; after a converged solve; once it is accepted */
PetscErrorCode timed_begin(Physics *physics, PetscReal t, PetscBool *changed);
PetscErrorCode timed_catch(Physics *physics);
PetscErrorCode timed_accept(Physics *physics);
PetscErrorCode timed_place(Physics *physics, Vec x);                    /* puts what is held where it belongs */
PetscErrorCode timed_residual(Physics *physics, PetscReal scale, Vec r); /* in place of what their rows say */
PetscErrorCode timed_rows(Physics *physics, PetscReal scale, Mat matrix);
PetscErrorCode timed_identity(Physics *physics, Mat matrix);            /* rows and columns of what is held: the identity's */
PetscErrorCode timed_forces(Physics *physics, PetscScalar *forces);     /* adds reactions that fade, at physics->t */
PetscBool      timed_bend(const Physics *physics, PetscReal t);         /* is one let go or activated at t, or has faded? */
PetscInt       timed_times(const Physics *physics, PetscReal times[]);  /* of such changes, but for fading, 2 a support at most */
/* where the scene does not say: to the next of these, and not longer than that */
void           timed_fade(Physics *physics, PetscInt n, const PetscReal times[], PetscReal longest);
PetscErrorCode timed_values(Physics *physics);                          /* for supports_values() */
void           timed_vectors(const Physics *physics, Vec *place, Vec *let_go); /* local: what restart files keep */
/* Is an entry of a local vector prescribed now, as no unknown or by a support that holds? */
PetscBool      entry_held(const Physics *physics, PetscInt entry);

/* rigids_scene.c, rigids.c, rigids_step.c */
PetscErrorCode rigids_read(Scene *scene, Physics *physics);
PetscErrorCode rigids_named(Scene *scene, const Physics *physics, const char *map, PetscInt *rigid);
PetscBool      rigids_names(Scene *scene, const Physics *physics, const char *map);
void           rigids_support(Scene *scene, Physics *physics, PetscInt number);
void           rigids_mark(Physics *physics);
PetscBool      rigids_read_load(Scene *scene, const Physics *physics, Load *load);
void           rigids_check_load(Scene *scene, const Physics *physics, const Load *load, const char *body, PetscBool forces,
                                 PetscBool gravity, PetscBool spins);
PetscErrorCode rigids_create(Physics *physics);
PetscErrorCode rigids_destroy(Physics *physics);
PetscErrorCode rigids_prescribe(Physics *physics, PetscReal t, Vec local);
PetscErrorCode rigids_place(Physics *physics, Vec local);
PetscErrorCode rigids_step(Physics *physics, PetscReal most, Vec step, PetscReal *fraction);
PetscErrorCode rigids_collect(Physics *physics, Vec f_local, PetscBool keep); /* keep: in rigid->contact */
PetscErrorCode rigids_load(const Physics *physics, const Load *load, PetscScalar *forces);
PetscErrorCode rigids_reactions(Physics *physics);
PetscReal      rigids_work_before(const Physics *physics, const PetscScalar *f_external);
PetscErrorCode rigids_accept(Physics *physics, PetscReal t, Vec last, Vec before);
const Support *rigid_holder(const Physics *physics, const Rigid *rigid, int unknown); /* who prescribes it now; NULL: nobody */
stickslip_rigid_motion rigids_motion(const Rigid *rigid); /* of now */
PetscErrorCode rigids_displacements(const Rigid *rigid, PetscInt n, const PetscReal X[], PetscScalar u[]);
void           rigids_turned(const Rigid *rigid, PetscReal turned[9]);
PetscInt       rigids_of_vertex(const Physics *physics, PetscInt vertex); /* of the mesh; -1: it is of none */
PetscInt       rigids_node_mask(const Rigid *rigid);
PetscBool      rigids_moves(const Physics *physics, PetscInt vertex, int component);

/* rigids_mass.c: before the scene is turned into a frame, before and after supports are read */
PetscErrorCode rigids_read_mass(Scene *scene, const Mesh *mesh, Rigid *rigid);
void           rigids_read_inertia(Scene *scene, const Physics *physics, Rigid *rigid);
/* rigids_inertia.c: with `dynamics`, of the bodies that are not held in all */
typedef struct {
  PetscReal external, supports, contact, damping; /* of a step, this rank's */
} RigidWork;
void           rigid_inertia_start(Rigid *rigid, const PetscReal velocity[3], const PetscReal spin[3]);
void           rigids_lead(Physics *physics, PetscReal t);    /* how supports move them at t */
void           rigids_start(Physics *physics);                /* what supports say at t = 0 goes before what the bodies do */
void           rigids_add_impulse(const Physics *physics, PetscReal dt, PetscScalar *impulse);
void           rigids_add_inertia(const Physics *physics, PetscReal dt, PetscReal damping, PetscScalar *f);
PetscErrorCode rigids_insert_inertia(const Physics *physics, PetscReal dt, PetscReal damping, Mat matrix);
PetscErrorCode rigids_pattern(const Physics *physics, Mat matrix);
PetscReal      rigid_rounding(const Rigid *rigid, PetscReal dt); /* of its inertial force, squared */
void           rigids_add_work(const Physics *physics, PetscReal dt, PetscReal damping, const PetscScalar *external, const PetscScalar *forces,
                               RigidWork *work);
void           rigids_add_motion(const Physics *physics, PetscReal dt, PetscBool end, PetscReal *kinetic, PetscReal momentum[3],
                                 PetscReal angular[3]);
PetscErrorCode rigids_accept_inertia(Physics *physics, PetscReal dt); /* and tells of one that turns too slowly */

/* supports_file.c */
PetscErrorCode supports_file_read(Scene *scene, const Mesh *mesh, Support *support);
PetscErrorCode supports_file_move(Physics *physics); /* once the mesh is distributed */

/* loads_scene.c, loads.c */
PetscErrorCode loads_read(Scene *scene, Physics *physics);
PetscErrorCode loads_label(Physics *physics);
PetscErrorCode loads_assemble(Physics *physics);
/* remote.c: nodal forces of a load that is spread over its surfaces; and, of all of them at u_local, whether one has turned too far: why */
PetscErrorCode remote_assemble(const Physics *physics, const Load *load, PetscScalar *forces);
PetscErrorCode remote_check(Physics *physics, char why[], size_t length);
/* load_faces.c: a face of a load: its nodes and their places, and 1, or -1 where DMPlex sees it from inside */
typedef struct {
  CellKind  kind;
  PetscInt  n, dofs[FACE_NODES];
  PetscReal X[3 * FACE_NODES], sign;
} Face;
PetscErrorCode face_look_at(const Physics *physics, PetscInt point, Face *face);
void           face_move(Face *face, const PetscScalar u[]); /* by the displacements of a local vector */
PetscBool      loads_follow(const Physics *physics); /* is there a follower pressure? */
PetscErrorCode loads_values(Physics *physics);       /* at physics->t and u_local, into f_external */
PetscErrorCode loads_stiffness(Physics *physics, Mat matrix); /* adds what forces of followers differ by */

/* springs_scene.c, after supports and loads; then springs_label(), before the mesh is distributed */
PetscErrorCode springs_read(Scene *scene, Physics *physics);
PetscErrorCode springs_label(Physics *physics);
PetscErrorCode springs_create(Scene *scene, Physics *physics); /* springs_create.c, once there are unknowns and parts */
PetscErrorCode springs_destroy(Physics *physics);
/* springs.c: as bulk_forces() and the like; called by these */
PetscErrorCode springs_forces(Physics *physics, Vec f_local);
PetscErrorCode springs_stiffness(Physics *physics, Mat matrix);
PetscErrorCode springs_pattern(Physics *physics, Mat matrix);
/* for the evaluations that follow, with `dynamics`: the step from one local vector to another */
PetscErrorCode springs_step(Physics *physics, Vec from, Vec to, PetscReal alpha_f);
PetscErrorCode springs_total(Physics *physics);                                   /* of `force`, on all ranks */
PetscErrorCode springs_energy(const Physics *physics, const PetscScalar *u, PetscReal *energy); /* adds this rank's part */

/* unknowns.c: takes the fields over */
PetscErrorCode unknowns_create(Physics *physics, PetscInt n_fields, Field *fields);
PetscErrorCode unknowns_gather_create(Physics *physics, PetscInt n, const PetscInt *n_vertices, const PetscInt *const *vertices,
                                      const PetscInt *const *copies, const PetscInt *fields, const PetscInt *components, PetscSF *sf);
/* into u_local, prescribed entries filled in */
PetscErrorCode unknowns_to_local(Physics *physics, Vec x);
/* into f_sum: what all ranks hold, complete at owned vertices */
PetscErrorCode unknowns_sum(Physics *physics, Vec local);
PetscErrorCode unknowns_to_ghosts(const Unknowns *unknowns, Vec local); /* what the vertices' owners have */
PetscErrorCode unknowns_share(Physics *physics, Vec local); /* the sum, in place, for all ranks that have the vertex */

/* on every rank: of a vertex by its number */
PetscErrorCode unknowns_displacement(const Physics *physics, PetscInt number, const PetscScalar *local, PetscReal u[3]);
/* of the k-th vertex here: its place, and where its displacement lies in a local vector; `coordinates`: the DM's local ones */
PetscErrorCode unknowns_place(const Physics *physics, PetscInt k, const PetscScalar *coordinates, PetscReal X[3], PetscInt *at);

/* A step of `dynamics`, for bodies of finite strain: local vectors of displacements at its start and end, CellStep. `linear`: over what their
 * derivatives by `to` are given, since those of linear bodies by their own place are multiplied with it afterwards */
typedef struct {
  Vec       from, to, rate; /* rate: NULL: none */
  PetscReal alpha_f, ahead, linear;
  PetscBool damping_only;
} BulkStep;

/* laid.c: the body of a part that is laid down, and turned, knows turns from now on; was it linear? */
PetscBool      laid_turn(Physics *physics, PetscInt part);
PetscErrorCode laid_archive(Physics *physics, Archive *archive);

/* bulk.c */
PetscErrorCode bulk_create(Physics *physics);
Element        bulk_element(const Physics *physics, PetscInt cell); /* of this rank */
/* `status` > 0 on every rank if a cell is turned inside out somewhere, named in physics->inverted */
PetscErrorCode bulk_forces(Physics *physics, Vec f_local, PetscInt *status); /* adds, to the parts' squares, too */
PetscErrorCode bulk_stiffness(Physics *physics, Mat matrix, PetscInt *status);         /* adds */
PetscErrorCode bulk_stiffness_at_rest(Physics *physics, Mat matrix);                  /* the same, wherever the bodies are */
/* the same; with a step bodies of finite strain have those of elasticity_step.c, the others those of u_local */
PetscErrorCode bulk_step_forces(Physics *physics, const BulkStep *step, Vec f_local, PetscInt *status);
PetscErrorCode bulk_step_stiffness(Physics *physics, const BulkStep *step, Mat matrix, PetscInt *status);
PetscErrorCode bulk_extension(Physics *physics, Vec u_local, Vec f_local, Mat matrix); /* adds to both */
PetscErrorCode bulk_pattern(Physics *physics, Mat matrix);                             /* adds zeros */
PetscErrorCode bulk_along(Physics *physics, Vec change, Vec f_local);                  /* adds K times a local vector, prescribed entries too */
PetscErrorCode bulk_per_young(Physics *physics, PetscInt body, Vec f_local);           /* adds the forces of a body over its E, in which they are linear */

/* parts.c. Between parts_label() and parts_create() the contact sets each part's `reach`. */
PetscErrorCode parts_label(Physics *physics);
PetscErrorCode parts_create(Physics *physics);
PetscErrorCode parts_add_squares(Physics *physics, Vec local, int prescribed, int free);
PetscErrorCode parts_name(const Physics *physics, PetscInt part, char name[], size_t length);
void           parts_accept(Physics *physics);

/* balance.c: at the end of an evaluation; do the forces on every part balance? */
typedef struct {
  PetscBool balance, relative; /* relative: to rtol, so that neither noise nor atol was asked */
  PetscInt  drowned;           /* a part whose loads are below the rounding of its own stiffness: it has no answer; -1: none */
  PetscInt  hidden;            /* a part whose forces would balance if those of contact counted in full; -1: none */
} Judgement;
PetscErrorCode parts_measure(Physics *physics);
Judgement      parts_judge(const Physics *physics, PetscReal rtol, PetscReal atol, PetscBool exact);
PetscErrorCode parts_hidden_words(const Physics *physics, PetscInt part, char why[], size_t length);
PetscErrorCode parts_resultants(Physics *physics, char why[], size_t length); /* of each part as a whole; empty: they balance */
/* loads_turned.c: pressures that do not follow surfaces that turn */
PetscErrorCode loads_check_turn(Physics *physics, Vec u_local);
void           loads_report_turn(const Physics *physics, struct cJSON *root);

/* range.c: do bodies with the linear material stay where it is right? */
PetscErrorCode range_check(Physics *physics, Vec u_local);
PetscErrorCode range_report(const Physics *physics, struct cJSON *root);

/* restart.c: which model it is; what the physics knows of the steps before */
PetscErrorCode physics_agree(const Physics *physics, Archive *archive);
PetscErrorCode physics_archive(Physics *physics, Archive *archive);

/* physics.c */
PetscErrorCode physics_destroy(Physics *physics);
#endif
