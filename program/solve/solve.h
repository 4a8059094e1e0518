/* How a step is solved: SNES and its matrix, Newton's attempts, cycles, bodies that contact alone holds, and the length
 * of the next step. */
#ifndef STICKSLIP_PROGRAM_SOLVE_H
#define STICKSLIP_PROGRAM_SOLVE_H
#include "contact/contact.h"
#include <petscsnes.h>

typedef struct {
  PetscInt   n_targets;
  PetscReal *targets; /* times to meet */
  PetscBool *asked;   /* for each: the scene names it; else it is a kink of a curve */
  PetscReal  end, smallest; /* step, as a fraction of the largest */
  PetscReal  lever;         /* how many times as far as all else an idle body may be moved: thrown.c */
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

/* The converged states from which a step is taken (first_iterate.c) */
typedef struct {
  Vec       last, before; /* at: */
  PetscReal t_last, t_before;
  PetscBool have_before; /* on the same branch of all curves */
} Past;

/* The states of the nodes over Newton's iterations (cycling.c) */
typedef struct Cycling Cycling;

/* Newton's method on one step (convergence.c, newton.c) */
typedef struct {
  PetscBool     fixed_line_search, fixed_max_it; /* the user chose them */
  PetscBool     goes_on;           /* the step has converged, and is solved again from there (lag.c) */
  PetscReal     factor;            /* for the augmentation of nodes that cycle */
  PetscReal     soft;              /* what this attempt begins with, over the scene's augmentation */
  PetscInt      n_changes;         /* of the augmentation in this attempt */
  PetscBool     gives_up;          /* this attempt, when it has thrown the bodies about and does not come back */
  PetscBool     laid;              /* the step began with laying bodies down (settle.c) */
  PetscBool     begins_soft;       /* the last step converged in the attempt with the softer augmentation */
  PetscBool     threw;             /* an attempt at this step has thrown the bodies about */
  PetscBool     changed, stale;    /* it is not the scene's; the residual belongs to another one */
  PetscBool     refused_commit;    /* the step converged, and does not count: the library refused its commit, or it slid too far */
  PetscReal     slid;              /* how far frozen weights have slid in the converged step, over what is allowed */
  PetscBool     stopped, monotone; /* this attempt cycled on; its residual fell in every iteration */
  PetscInt      iterations;        /* of the last newton_solve(), all attempts */
  char          cycle[768];        /* the last one found in it, as a sentence */
  char          why[1024];         /* it did not converge */
  PetscInt      drowned;           /* a part whose loads the rounding of its own stiffness hides; -1: none */
  char          unsound[768];      /* why the last iterate is not converged, although it looks so (convergence.c); empty: it does not */
  PetscInt      n_unsound;         /* iterates in a row that looked so */
  struct cJSON *cycles;            /* rank 0: those seen since the last report */
  struct cJSON *state_changes;     /* of the last attempt: nodes, by iteration from the second on; NULL: reported */
} Newton;

/* The attempt that closes bodies which contact alone holds (closing.c) */
typedef struct {
  PetscBool *free;          /* per body: the supports leave it free to move */
  PetscInt  *group;         /* rank 0, per body: work space */
  PetscBool  possible;      /* there is such a body, and the scene does not switch this off */
  PetscBool  active;        /* the present attempt is this one */
  PetscBool  cut, ever_cut; /* the last step of Newton's method, any in this attempt */
  PetscReal  shift;         /* of the matrix, over its diagonal, while a body is loose */
  PetscInt   n_uncut;       /* steps since the last one that was cut */
  PetscReal  depth;         /* how far a step may lead into contact, over a facet's edge */
  PetscReal  pressing;      /* the residual that the attempt started with */
  PetscReal  travelled;     /* by steps that met nothing, since the last one that was cut */
  PetscBool  touched, met;  /* no body was loose at the last tangent, at any of this attempt */
  PetscInt   loose;         /* the body that was, at the last tangent; -1: none */
  Vec        displacements; /* 1 in their equations, 0 in those of multipliers */
  Vec        work;
  char       away[256];     /* a loose body moves away from all that it could touch, as a sentence */
} Closing;

/* Motions that something is wrong with: in words, and what is to be told of them, both on rank 0; NULL: nothing, or it was. Were any
 * found; the step of which that was is not accepted yet. */
typedef struct {
  struct cJSON *json;
  char         *words;
  PetscBool     told, unsettled;
} HeldFinding;

/* What the supports leave free (held.c). */
typedef struct {
  PetscBool    *loose;      /* per part: its supports do not hold it */
  struct cJSON *by_contact; /* the motions in words of what contact holds */
  struct cJSON *laid_down;  /* which bodies a step began with moving to where they touch (settle.c); NULL: none */
  HeldFinding   by_nothing, by_springs; /* what nothing holds; what springs hold so softly that it drifts (held_softly.c) */
} Held;

enum { REFUSAL_LENGTH = 256 }; /* of a sentence of refusal.c */

/* Multipliers that are left out, since others do what they do (redundant.c) */
typedef struct Multiplier Multiplier;
typedef struct {
  PetscBool   suspected; /* there are nodes that may have such */
  PetscInt    n, told;   /* of all ranks, interface by interface; so many have been told of */
  Multiplier *multipliers;
} Redundant;

typedef enum { SOLVER_DIRECT, SOLVER_ITERATIVE, SOLVER_AUTO } SolverKind;

/* How linear systems are solved, and how that went (iterative.c) */
typedef struct {
  SolverKind kind;
  char       refusal[REFUSAL_LENGTH]; /* why the direct solver in place of multigrid failed, in this attempt */
  PetscInt   n_solves, n_direct;  /* by iteration; of these, given to the direct solver after all */
  PetscInt   iterations, most; /* of all, of one */
} Linear;

typedef struct Sensitivity Sensitivity; /* sensitivity.h */

typedef struct {
  Mesh     *mesh;
  Physics  *physics;
  Contact  *contact;
  Sensitivity *sensitivity; /* NULL: the scene asks for none */
  PetscBool quiet;   /* no notes */
  PetscBool outside; /* the last residual could not be evaluated */
  Steps     steps;
  SNES      snes;
  Mat       jacobian, pattern; /* the latter: as the former was at the start of the step, without values */
  Newton    newton;
  Closing   closing;
  Cycling  *cycling;
  Linear    linear;
  PetscInt  room, n_raised;     /* workspace that MUMPS is allowed, in per cent; how often it wanted more */
  Held      held;
  Redundant redundant;
  PetscInt  iterations;         /* of Newton, spent on the present step, failed attempts included */
  PetscReal size, stiffness;    /* of the model */
  struct cJSON  *jacobian_tests; /* of the present step (jacobian_test.c); NULL: none */
  PetscReal      least_pivot; /* of a linear solver that exchanges no rows, over the largest; 0: of no such solver */
  PetscLogDouble seconds, started; /* in the linear solver; when it was called last */
  PetscLogDouble told;             /* when progress was told last, or the step began */
} Solve;

/* progress.c: lines while a step takes long; one of both may be NULL */
PetscErrorCode progress_begin(Solve *solve);
PetscErrorCode progress_watch(Solve *solve, SNES snes, KSP krylov);

/* times.c: the times that steps must meet */
PetscErrorCode times_read(Scene *scene, Steps *steps);
PetscErrorCode times_add_kinks(const Physics *physics, Steps *steps);
PetscErrorCode times_destroy(Steps *steps);
PetscBool      times_bend(const Physics *physics, PetscReal t); /* does a load or a support change its rate at t? */

/* refusal.c: why a linear system is not solved, and what to do next */
PetscErrorCode refusal_describe(KSP ksp, char why[], size_t size);
PetscErrorCode refusal_wants_room(KSP ksp, PetscBool *wants);

/* solver.c: SNES with residual and tangent; its options are read last, by solver_configure() */
PetscErrorCode solver_create(Solve *solve);
PetscErrorCode solver_configure(Solve *solve);
PetscErrorCode solver_destroy(Solve *solve);
PetscErrorCode solver_use_matrix(Solve *solve); /* solve->jacobian is another one */
PetscErrorCode solver_refresh_pattern(Solve *solve);
PetscErrorCode solver_restore_pattern(Solve *solve); /* undoes what a failed attempt has added */
PetscErrorCode solver_give_room(Solve *solve, PetscBool *given); /* to a direct solver that asked for more workspace */
PetscErrorCode solver_archive_room(Solve *solve, Archive *archive);
PetscErrorCode solver_forget_factors(Solve *solve);  /* after a linear system that could not be solved */

/* pattern.c: a matrix with room for all that may come; or for what is in `rows`, of those that contact touches */
typedef struct {
  PetscInt  n, *row, *offsets, *columns; /* n rows of this rank */
} PatternRows;
PetscErrorCode pattern_create(Solve *solve, const PatternRows *rows, Mat *matrix);
PetscErrorCode pattern_archive(Solve *solve, Archive *archive); /* of the matrix and of the one at the start of the step */

/* restart.c: `past` and `size` of the next step */
PetscErrorCode solve_archive(Solve *solve, Past *past, StepSize *size, Archive *archive);
PetscErrorCode solve_archive_pattern(Solve *solve, Archive *archive);

/* iterative.c: `solver`; what `auto` means; makes SNES' linear solver one that iterates */
void           iterative_check(Scene *scene, const Solve *solve); /* after held_create() */
PetscErrorCode iterative_read(Scene *scene, Solve *solve); /* after contact_read() */
void           iterative_choose(Solve *solve, PetscInt n_unknowns);
PetscErrorCode iterative_set(Solve *solve, KSP ksp);

/* convergence.c: SNES' convergence test */
/* Has a residual that was `first` thrown the bodies about? */
PetscBool      convergence_throws(PetscReal first, PetscReal norm);
PetscErrorCode convergence_test(SNES snes, PetscInt iteration, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                                SNESConvergedReason *reason, void *solve);

/* cycling.c: solve->cycling */
PetscErrorCode cycling_create(Solve *solve);
PetscErrorCode cycling_destroy(Solve *solve);
PetscErrorCode cycling_restart(Solve *solve);
PetscErrorCode cycling_record(Solve *solve, PetscReal norm, PetscInt *period); /* at u_local; 0: no cycle */
PetscErrorCode cycling_change_augmentation(Solve *solve, PetscInt period, PetscReal factor);
PetscErrorCode cycling_describe(Solve *solve, PetscInt period, struct cJSON *parent, char sentence[], size_t length);

/* turned_start.c */
PetscErrorCode turn_parts(Solve *solve, PetscReal t0, Vec u, PetscBool *turned);

/* turned_on.c: of a first iterate that is extrapolated along lines, the bodies that turn */
PetscErrorCode turn_on(const Solve *solve, const Past *past, PetscReal factor, Vec x);

/* newton.c: creates SNES and all that belongs to it, too */
PetscErrorCode newton_create(Solve *solve);
PetscErrorCode newton_destroy(Solve *solve);
PetscErrorCode newton_solve(Solve *solve, Past *past, Vec x, PetscBool *converged);

/* closing.c: bodies that contact alone holds and that do not touch yet */
PetscErrorCode closing_create(Solve *solve);
void           closing_find(Solve *solve); /* which bodies the supports leave free */
PetscErrorCode closing_destroy(Solve *solve);
PetscErrorCode closing_limit_steps(Solve *solve, SNESLineSearch line_search);
PetscErrorCode closing_needed(Solve *solve, Vec start, PetscBool *needed);
void           closing_begin(Solve *solve, PetscBool active);
PetscBool      closing_settled(const Solve *solve);
PetscErrorCode closing_shift(Solve *solve, Mat matrix);

/* settle.c: where friction must hold what touches nothing at the start of a step, moves that start, `past`, to where it touches */
PetscErrorCode settle_loose(Solve *solve, Past *past);

/* held.c: which bodies contact alone must hold, as a sentence; which ones nothing holds */
PetscErrorCode held_create(Solve *solve); /* and again, with closing_find(), where other supports hold from now on */
PetscErrorCode held_destroy(Solve *solve);
PetscErrorCode held_check(Solve *solve);
PetscErrorCode held_settle(Solve *solve, PetscBool accepted);
PetscErrorCode held_check_springs(Solve *solve); /* held_softly.c: at a converged state, as held_check(); why forces may not balance, as a sentence */
PetscErrorCode held_describe_springs(const Solve *solve, PetscReal rtol, char text[], size_t length);
PetscBool      held_free(const Solve *solve, PetscInt body); /* do the supports leave it free to move? */
PetscErrorCode held_describe(const Solve *solve, char text[], size_t length);

/* thrown.c: has an attempt thrown out a body that contact alone holds? */
PetscErrorCode thrown_check(Solve *solve, Vec last, PetscReal t0, Vec x, PetscBool *thrown, char why[], size_t length);

/* redundant.c: finds more of them at x (NULL: at u_local) and leaves them out from t_n on, so that a step must begin again; their rows */
PetscErrorCode redundant_find(Solve *solve, Vec x, PetscInt *n_found);
PetscErrorCode redundant_begin(Solve *solve, Vec t_n); /* contact has moved since they were found */
PetscErrorCode redundant_residual(const Solve *solve, Vec x, Vec r);
PetscErrorCode redundant_rows(const Solve *solve, Mat matrix);
PetscErrorCode redundant_destroy(Solve *solve);

/* undetermined.c: multipliers that the equations leave open, in words; empty: none */
PetscErrorCode undetermined_find(Solve *solve, char why[], size_t size);

/* step_size.c */
void      step_size_start(const Steps *steps, StepSize *size);
void      step_size_anew(const Steps *steps, StepSize *size);
PetscReal step_size_next(const Steps *steps, const StepSize *size, PetscReal t);
void      step_size_accept(const Steps *steps, StepSize *size, PetscReal t_last, PetscReal t, const Newton *newton,
                           PetscBool bends);
PetscBool step_size_cut(const Steps *steps, StepSize *size, PetscReal tried, const Newton *newton); /* false: it is too small now */

/* jacobian_test.c: after newton_create() */
PetscErrorCode jacobian_test_create(Solve *solve, Scene *scene);

/* first_iterate.c: where a step to physics->t starts, multipliers that are condensed included */
PetscBool      first_iterate_extrapolates(const Solve *solve, const Past *past);
PetscErrorCode first_iterate(Solve *solve, const Past *past, PetscBool extrapolate, Vec x);
#endif
