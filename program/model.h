/* Everything a run knows, one struct a room. Rooms point one way: each knows those above it in this list. */
#ifndef STICKSLIP_PROGRAM_MODEL_H
#define STICKSLIP_PROGRAM_MODEL_H
#include "output/output.h"

typedef struct {
  Scene  *scene;
  Mesh    mesh;
  Physics physics;
  Contact contact;
  Solve   solve;
  Heat    heat;
  Output  output;
  char    restart[NAME_LENGTH + PETSC_MAX_PATH_LEN]; /* the file that the run goes on from; empty: none */
  char   *effective;                                 /* rank 0: what the scene says; NULL: nobody asked yet */
} Model;

/* How far a run has come. */
typedef struct {
  Vec       x; /* the iterate */
  Past      past;
  StepSize  size;             /* of the next step */
  PetscInt  step, n_cutbacks; /* steps so far */
  Summary  *summary;
  PetscBool tried;     /* a step has been solved, or tried */
  PetscBool offsets;   /* the last one could not begin: the library refused the offsets of its time */
  PetscBool converged; /* the last attempt had, so that its commit was refused if the library refused */
  PetscBool again;     /* the last one was the second one of its step, for general contact looks for more since */
  PetscBool no_slopes; /* the library has no derivatives by the scene's parameters */
  PetscBool late;      /* it came after energy was wrong already: no shorter step helps */
} Run;

/* restart.c: after a step, if it is due (`last`: the run has ended); and before the first one, if the scene names a file: ends the run
 * where that is no good */
PetscErrorCode restart_write(Model *model, Run *state, PetscBool last);
PetscErrorCode restart_read(Model *model, Run *state);

/* run.c: returns the exit code of the program */
PetscErrorCode run(Model *model, int *exit_code);
#endif
