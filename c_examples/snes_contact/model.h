/* Everything a run knows, one struct a room. Rooms point one way: each knows those above it in this list. */
#ifndef SNES_CONTACT_MODEL_H
#define SNES_CONTACT_MODEL_H
#include "output/output.h"

typedef struct {
  Scene  *scene;
  Mesh    mesh;
  Physics physics;
  Contact contact;
  Solve   solve;
  Heat    heat;
  Output  output;
} Model;

/* run.c: returns the exit code of the program */
PetscErrorCode run(Model *model, int *exit_code);
#endif
