/* Everything a run knows: the scene's supports, loads, interfaces and steps, the distributed mesh with its unknowns, and
 * the forces assembled on it.
 *
 * Unknowns live in two kinds of vectors, as PETSc has them: a *local* vector holds 3 displacements per vertex of this rank
 * and the multipliers (3, without friction 1) per non-mortar vertex, prescribed ones included; a *global* vector holds the
 * equations only. */
#ifndef SNES_CONTACT_MODEL_H
#define SNES_CONTACT_MODEL_H
#include "curve.h"
#include "mesh.h"
#include <petscdmplex.h>
#include <petscsf.h>
#include <petscsnes.h>
#include <stickslip.h>

/* x - origin = R (X - origin + factor(t) (value + gradient (X - origin))) in the components of the mask (bit i: axis i);
 * R turns about `rotate` by rotate_factor(t) |rotate| radians */
typedef struct {
  char      name[NAME_LENGTH];
  PetscInt  mask;
  PetscReal value[3], gradient[9], origin[3], rotate[3];
  Curve     curve, rotate_curve;
  PetscInt  n_vertices, *vertices; /* rank 0 */
  PetscReal reaction[3];           /* of the last evaluation, summed over ranks by supports_reactions() */
} Support;

typedef struct {
  char            name[NAME_LENGTH];
  PetscReal       traction[3], pressure;
  Curve           curve;
  PetscInt        n_surfaces;
  const Surface **surfaces; /* rank 0 */
  Vec             forces;   /* local vector of the nodal forces at factor 1; ranks add up */
} Load;

/* One contact interface; the library's handle and all its arrays live on rank 0 (see contact.c). */
typedef struct {
  char                 name[NAME_LENGTH];
  const Surface       *surface[2]; /* non-mortar, mortar */
  PetscInt             n1, n2;     /* their numbers of nodes */
  PetscInt            *nodes;      /* n1 + n2 mesh vertices */
  PetscInt             components; /* multipliers a node: 1, along the normal, without friction; else 3 */
  PetscInt            *removed;    /* n1: mask of directions without a multiplier, see read_surfaces() */
  stickslip_options    options;
  PetscBool            initial_contact; /* nodes that touch start slightly compressed: contact_start() */
  double              *X, *x;     /* 3 (n1 + n2): reference coordinates; current ones, see contact_positions() */
  PetscScalar         *gathered;  /* 3 (n1 + n2) displacements, components n1 multipliers */
  PetscScalar         *forces;    /* same layout: f1, f2, multiplier rows */
  int64_t             *equations; /* same layout */
  PetscSF              sf;        /* from the local vectors of all ranks to `gathered` */
  stickslip_interface *handle;
  int64_t              coo_capacity, *coo_rows, *coo_columns;
  double              *coo_values;
  double               friction_work; /* up to the last converged step */
  double               young, largest_traction; /* of the softer body; up to the last converged step */
  stickslip_equilibrium equilibrium;  /* as last judged (equilibrium.c) */
  int64_t              bytes;         /* of the library's, the most at the end of a step */
} Interface;

/* The library takes x1, x2 and the multipliers: */
#define STATE_OF(interface)                                                                                            \
  (interface)->x, (interface)->x + 3 * (interface)->n1, (interface)->gathered + 3 * ((interface)->n1 + (interface)->n2)

/* nodal results of one interface; every array has n1 entries, vectors 3 n1 */
typedef struct {
  int32_t *state;
  double  *normal, *multiplier, *gap, *slip, *coverage, *area, *dissipation; /* multiplier: as a vector */
} ContactStates;

typedef struct {
  char     name[NAME_LENGTH];
  PetscInt vertex; /* rank 0 */
} Probe;

typedef struct {
  PetscInt   n_targets;
  PetscReal *targets; /* times to meet */
  PetscBool *asked;   /* for each: the scene names it; else it is a kink of a curve */
  PetscReal  end, smallest; /* step, as a fraction of the largest */
  PetscBool  predictor, automatic, cycles; /* cycles: of nodes are looked for and ended */
  PetscBool  closing;                      /* bodies that contact alone holds are closed by force: closing.c */
  PetscReal  initial, largest; /* automatic steps */
  PetscInt   iterations;       /* of Newton's method: what they aim at */
} Steps;

/* The step that is wanted next (step_size.c). */
typedef struct {
  PetscInt  next, held;      /* target; steps for which it must not grow */
  PetscInt  n_shorter, iterations_before; /* steps in a row made shorter; the last one before them: its iterations, */
  PetscReal length_before;                /* and length */
  PetscReal length, longest; /* wanted; whose fraction Steps.smallest is */
} StepSize;

typedef struct Cycling Cycling;

/* Connected cells: bodies, or pieces of them, that nothing but contact joins to others (parts.c) */
typedef struct {
  PetscReal young, reach;               /* the stiffest E; size of all that contact may join to it */
  PetscReal reference, felt;            /* its forces at the last evaluation; the largest of a converged step */
  PetscReal faint;                      /* a first reference, too small to matter */
  PetscReal loads, residual, noise;     /* at the last evaluation */
} Part;

/* What a body of the linear material was strained and turned by, up to now (range.c) */
typedef struct {
  PetscReal strain, rotation;
  PetscBool told;
} Range;

/* Sums of squares of a part's nodal forces */
enum { SQUARES_LOADS, SQUARES_REACTIONS, SQUARES_CONTACT, SQUARES_ROUNDING, SQUARES_RESIDUAL, N_SQUARES };

/* Newton's method on one step (newton.c) */
typedef struct {
  PetscBool     fixed_line_search, fixed_max_it; /* the user chose them */
  PetscReal     factor;            /* for the augmentation of nodes that cycle */
  PetscInt      n_changes;         /* of the augmentation in this attempt */
  PetscBool     changed, stale;    /* it is not the scene's; the residual belongs to another one */
  PetscBool     refused_commit;    /* the step converged, and the library refused its commit */
  PetscBool     stopped, monotone; /* this attempt cycled on; its residual fell in every iteration */
  PetscInt      iterations;        /* of the last newton_solve(), all attempts */
  char          cycle[768];        /* the last one found in it, as a sentence */
  char          why[1024];         /* it did not converge */
  char          unsettled[256];    /* forces balance, but this in the contact does not; empty: nothing */
  PetscInt      drowned;           /* a part whose loads the rounding of its own stiffness hides; -1: none */
  PetscReal     violation;         /* its size, and how many iterations it has not changed for */
  PetscInt      n_still;
  struct cJSON *cycles;            /* rank 0: those seen since the last report */
  struct cJSON *state_changes;     /* of the last attempt: nodes, by iteration from the second on; NULL: reported */
} Newton;

/* The attempt that closes bodies which contact alone holds (closing.c) */
typedef struct {
  PetscBool *free;          /* rank 0, per body: the supports leave it free to move */
  PetscInt  *group;         /* rank 0, per body: work space */
  PetscBool  possible;      /* there is such a body, and the scene does not switch this off */
  PetscBool  active;        /* the present attempt is this one */
  PetscBool  cut, ever_cut; /* the last step of Newton's method, any in this attempt */
  PetscReal  shift;         /* of the matrix, over its diagonal, while a body is loose */
  PetscInt   n_uncut;       /* steps since the last one that was cut */
  PetscReal  depth;         /* how far a step may lead into contact, over a facet's edge */
  PetscReal  travelled;     /* by steps that met nothing, since the last one that was cut */
  PetscBool  touched;       /* no body was loose at the last tangent */
  PetscInt   loose;         /* the body that was, at the last tangent; -1: none */
  Vec        displacements; /* 1 in their equations, 0 in those of multipliers */
  Vec        work;
  char       away[256];     /* a loose body moves away from all that it could touch, as a sentence */
} Closing;

typedef struct {
  double bulk_assembly, linear_solve, contact_forces, contact_tangent, total, started;
} Timers;

typedef enum { WRITE_NONE, WRITE_LAST, WRITE_TIMES, WRITE_ALL } WriteWhen;

typedef struct {
  Scene      *scene;
  PetscMPIInt rank;
  Mesh        mesh;
  PetscInt    n_supports, n_loads, n_interfaces, n_probes;
  Support    *supports;
  Load       *loads;
  Interface  *interfaces;
  Probe      *probes;
  PetscInt   *prescribed; /* rank 0: mask of prescribed displacements per mesh vertex */
  Steps       steps;
  WriteWhen   write_vtu, write_csv;
  PetscBool   quiet;
  const char *output_dir;

  /* unknowns.c */
  DM              dm;
  PetscSection    section;
  PetscInt       *original; /* mesh vertex of each of this rank's vertices */
  PetscInt        vStart, vEnd, n_local;
  const PetscInt *equations; /* of each local entry, -1: prescribed */
  PetscInt       *owner;     /* rank 0, per mesh vertex: rank, then the local offset of each field there */
  PetscBool      *ghost;     /* per vertex here: another rank owns it */
  PetscSF         ghosts;    /* from its entries there to those here; NULL on a single rank */
  PetscSF         all_displacements;

  /* bulk.c */
  PetscInt n_cells, *cell_offsets, *cell_dofs, *cell_body,
      *cell_part; /* this rank's cells; cell_dofs: local offset of each corner */
  PetscReal *cell_X, *cell_stiffness; /* coordinates of the corners; stiffness at rest */
  Vec        u_local, f_local, prescribed_local; /* local vectors: state, forces, values of prescribed entries at t */
  Vec        f_external;                         /* local, at t */
  Vec        f_sum;                              /* local: work space of unknowns_sum() */

  SNES      snes;
  Mat       jacobian, pattern; /* the latter: as the former was at the start of the step, without values */
  Newton    newton;
  Closing   closing;
  Cycling  *cycling;
  PetscInt  iterations;                            /* of Newton, spent on the present step, failed attempts included */
  PetscReal t, reference_force, size, stiffness; /* the forces of the last evaluation; of the model */

  /* parts.c */
  PetscInt   n_parts, *mesh_part, *vertex_part; /* of each mesh vertex (rank 0), of each vertex here */
  Part      *parts;
  PetscReal *squares; /* N_SQUARES per part, of the last evaluation */

  /* held.c, rank 0: parts that their supports leave free; bodies so, bodies that nothing holds: their motions in words */
  PetscBool    *loose;
  struct cJSON *held_by_contact, *held_by_nothing;
  char         *held_words; /* what is to be told of held_by_nothing; NULL: nothing, or it was */

  Range *ranges; /* range.c, rank 0: per body */

  char      refusal[1024];                         /* the library's last message, if it refused an evaluation */
  char      inverted[256];                         /* which cell the last attempt at a step has turned inside out */
  Timers    timers;

  struct cJSON *jacobian_tests; /* of the present step (jacobian_test.c); NULL: none */
} Model;

/* plex.c */
PetscErrorCode plex_create(Model *model);
PetscErrorCode plex_label_vertices(DM dm, const char *label, PetscInt n, const PetscInt *vertices,
                                   const PetscInt *values, PetscInt value);
PetscErrorCode plex_label_faces(DM dm, const char *label, const Surface *surface);
PetscErrorCode plex_distribute(Model *model);

/* supports.c */
PetscErrorCode supports_read(Model *model);
PetscErrorCode supports_label(Model *model);
PetscBool supports_agree(const Support *a, const Support *b, PetscReal end, const PetscReal X[3], int component);
PetscErrorCode supports_values(Model *model, PetscReal t); /* into prescribed_local */
PetscErrorCode supports_reactions(Model *model);

/* loads.c */
PetscErrorCode loads_read(Model *model);
PetscErrorCode loads_label(Model *model);
PetscErrorCode loads_assemble(Model *model);
PetscErrorCode loads_values(Model *model, PetscReal t); /* into f_external */

/* unknowns.c: `field` 0 is the displacement, 1 + i the multiplier of interface i */
PetscErrorCode unknowns_create(Model *model);
PetscErrorCode unknowns_gather_create(Model *model, PetscInt n, const PetscInt *n_vertices,
                                      const PetscInt *const *vertices, const PetscInt *fields, PetscSF *sf);
PetscErrorCode unknowns_to_local(Model *model, Vec x); /* into u_local, prescribed entries filled in */
PetscErrorCode unknowns_sum(Model *model, Vec local);  /* into f_sum: what all ranks hold, complete at owned vertices */

/* bulk.c */
PetscErrorCode bulk_create(Model *model);
/* `status` > 0 on every rank if a cell is turned inside out somewhere, named in model->inverted */
PetscErrorCode bulk_forces(Model *model, Vec f_local, PetscInt *status); /* adds, to model->squares, too */
PetscErrorCode bulk_stiffness(Model *model, Mat matrix, PetscInt *status);    /* adds */
PetscErrorCode bulk_extension(Model *model, Vec u_local, Vec f_local, Mat matrix); /* adds to both */
PetscErrorCode bulk_pattern(Model *model, Mat matrix);                        /* adds zeros */

PetscErrorCode symmetry_mask(const Model *model, const Interface *interface, PetscInt *mask);

/* contact_scene.c, contact_setup.c, contact.c: `status` > 0 on every rank if the library refused, with its message in
 * model->refusal */
PetscErrorCode contact_read(Model *model);
PetscErrorCode contact_label(Model *model);
PetscErrorCode contact_agree(Model *model, int32_t refused, PetscInt *status);
PetscErrorCode contact_create(Model *model, PetscInt *status);
PetscErrorCode contact_destroy(Model *model);
PetscErrorCode contact_start(Model *model, Vec x, PetscInt *status);
void           contact_positions(Interface *interface);
PetscErrorCode contact_gather(Model *model, Interface *interface, Vec local);
PetscErrorCode contact_forces(Model *model, Vec f_local, PetscInt *status); /* adds, to model->squares, too */
PetscErrorCode contact_tangent(Model *model, Mat matrix, PetscInt *status);
PetscErrorCode contact_pattern(Model *model, Mat matrix);
PetscErrorCode contact_states_create(const Interface *interface, ContactStates *states); /* rank 0 */
PetscErrorCode contact_scale_augmentation(Model *model, const PetscBool *marked, PetscReal factor);
PetscErrorCode contact_states_destroy(ContactStates *states);
PetscErrorCode contact_tendencies(Model *model, int32_t *state, double *tangential); /* of all interfaces at u_local */
PetscErrorCode contact_commit(Model *model, PetscInt *status);

/* parts.c */
PetscErrorCode parts_label(Model *model);
PetscErrorCode parts_create(Model *model);
PetscErrorCode parts_destroy(Model *model);
PetscErrorCode parts_measure(Model *model);
void           parts_judge(Model *model, PetscReal rtol, PetscReal atol, PetscBool *balance, PetscBool *relative);
void           parts_accept(Model *model);

/* equilibrium.c */
PetscErrorCode equilibrium_judge(Model *model, PetscReal rtol, PetscBool *holds, PetscBool *stuck);
void           equilibrium_restart(Model *model);
void           equilibrium_accept(Model *model);

/* solver.c */
PetscErrorCode solver_create(Model *model);
PetscErrorCode solver_refresh_pattern(Model *model);
PetscErrorCode solver_restore_pattern(Model *model); /* undoes what a failed attempt has added */
PetscErrorCode solver_forget_factors(Model *model);  /* after a linear system that could not be solved */

/* cycling.c: model->cycling, the states of the nodes over Newton's iterations */
PetscErrorCode cycling_create(Model *model);
PetscErrorCode cycling_destroy(Model *model);
PetscErrorCode cycling_restart(Model *model);
PetscErrorCode cycling_record(Model *model, PetscReal norm, PetscInt *period); /* at u_local; 0: no cycle */
PetscErrorCode cycling_change_augmentation(Model *model, PetscInt period, PetscReal factor);
PetscErrorCode cycling_describe(Model *model, PetscInt period, struct cJSON *parent, char sentence[], size_t length);

/* newton.c, after solver_create() */
PetscErrorCode newton_create(Model *model);
PetscErrorCode newton_destroy(Model *model);
PetscErrorCode newton_watch(Model *model, PetscInt iteration, PetscReal norm, SNESConvergedReason *reason);
PetscErrorCode newton_confirm(Model *model, PetscReal *norm);
PetscErrorCode newton_solve(Model *model, Vec start, Vec x, PetscBool *converged);

/* closing.c: bodies that contact alone holds and that do not touch yet */
PetscErrorCode closing_create(Model *model);
PetscErrorCode closing_destroy(Model *model);
PetscErrorCode closing_limit_steps(Model *model, SNESLineSearch line_search);
PetscErrorCode closing_needed(Model *model, Vec start, PetscBool *needed);
void           closing_begin(Model *model, PetscBool active);
PetscBool      closing_settled(const Model *model);
PetscErrorCode closing_shift(Model *model, Mat matrix);

/* held.c: which bodies contact alone must hold, as a sentence; which ones nothing holds */
PetscErrorCode held_create(Model *model);
PetscErrorCode held_destroy(Model *model);
PetscErrorCode held_check(Model *model, const PetscScalar *displacements); /* rank 0: of all vertices */
PetscErrorCode held_settle(Model *model, PetscBool accepted);
PetscErrorCode held_free(const Model *model, const Body *body, PetscBool *is_free); /* rank 0: by its supports */
PetscErrorCode held_describe(const Model *model, char text[], size_t length);

/* range.c: do bodies with the linear material stay where it is right? */
PetscErrorCode range_check(Model *model, const PetscScalar *displacements); /* rank 0: of all vertices */
PetscErrorCode range_report(const Model *model, struct cJSON *root);

/* step_size.c */
void      step_size_start(const Steps *steps, StepSize *size);
PetscReal step_size_next(const Steps *steps, const StepSize *size, PetscReal t);
void      step_size_accept(const Steps *steps, StepSize *size, PetscReal t_last, PetscReal t, const Newton *newton,
                           PetscBool bends);
PetscBool step_size_cut(const Steps *steps, StepSize *size, PetscReal tried); /* false: it is too small now */

/* jacobian_test.c: after solver_create() */
PetscErrorCode jacobian_test_create(Model *model);

/* carry.c: moves x with the supports from their positions at t0 to those at model->t */
PetscErrorCode carry_supports(Model *model, PetscReal t0, Vec x);

/* steps.c: returns the exit code of the program */
PetscErrorCode steps_read(Model *model);
PetscErrorCode steps_run(Model *model, int *exit_code);

/* output.c, counters.c, files.c */
typedef struct Summary Summary;
PetscErrorCode         output_read(Model *model);
PetscErrorCode         summary_create(Model *model, Summary **summary);
PetscErrorCode         summary_step(Model *model, Summary *summary, PetscInt step, PetscBool converged, PetscBool asked,
                                    PetscBool last);
PetscErrorCode         summary_failed_attempt(Model *model, Summary *summary, PetscReal t_last);
PetscErrorCode summary_settle_step(Model *model, Summary *summary, PetscBool accepted); /* the last one */
PetscErrorCode summary_write(Model *model, Summary **summary, Vec last, PetscInt cutbacks, const char *message);
PetscErrorCode uniqueness_check(Model *model, Vec x, struct cJSON *root); /* uniqueness.c: of a node with friction */
PetscErrorCode summary_counters(Model *model, struct cJSON *root); /* what the run and each interface cost */
PetscErrorCode diagnosis_failed(Model *model, struct cJSON *root); /* diagnosis.c: what may be wrong; told and kept */
PetscErrorCode csv_write(Model *model, const Interface *interface, const ContactStates *states, PetscInt step);
PetscErrorCode vtu_write(Model *model, const PetscScalar *displacements, PetscInt step);

/* The library's status as a PETSc error, where a refusal is not something to recover from. */
#define PetscCallStickslip(...)                                                                                        \
  do {                                                                                                                 \
    const int32_t status_of_call = (__VA_ARGS__);                                                                      \
    PetscCheck(status_of_call == 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s", stickslip_last_error_message());  \
  } while (0)
#endif
