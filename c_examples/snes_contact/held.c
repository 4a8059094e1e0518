/* Which bodies their supports leave free to move, so that contact alone must hold them: the first thing to look at where a
 * step cannot be solved. */
#include "model.h"
#include <petscblaslapack.h>

enum { MODES = 6 };
/* A rigid motion whose prescribed components sum to less than this part of those of a body prescribed as a whole is
 * free: far above rounding, far below what one vertex of a million holds. */
static const PetscReal FREE = 1e-10;

/* rank 0: sums over the prescribed components of a body's vertices of the products of its six rigid motions there,
 * three translations and three rotations about the middle of its vertices, over its size */
static void prescribed_motions(const Model *model, const Body *body, PetscReal gram[MODES * MODES], PetscReal *whole)
{
  PetscReal middle[3] = {0}, squared = 0;
  *whole = body->end_vertex - body->first_vertex;
  for (PetscInt v = body->first_vertex; v < body->end_vertex; v++) {
    for (int i = 0; i < 3; i++)
      middle[i] += model->mesh.coordinates[3 * v + i] / *whole;
  }
  for (PetscInt v = body->first_vertex; v < body->end_vertex; v++) {
    for (int i = 0; i < 3; i++)
      squared += PetscSqr(model->mesh.coordinates[3 * v + i] - middle[i]) / *whole;
  }
  PetscArrayzero(gram, MODES * MODES);
  for (PetscInt v = body->first_vertex; v < body->end_vertex; v++) {
    for (int i = 0; i < 3; i++) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      PetscReal motion[MODES] = {0}; /* component i: of e_i, and of e_j x y and e_k x y */
      if (!(model->prescribed[v] & (1 << i))) continue;
      motion[i]     = 1;
      motion[3 + j] = (model->mesh.coordinates[3 * v + k] - middle[k]) / PetscSqrtReal(squared);
      motion[3 + k] = -(model->mesh.coordinates[3 * v + j] - middle[j]) / PetscSqrtReal(squared);
      for (int m = 0; m < MODES * MODES; m++)
        gram[m] += motion[m / MODES] * motion[m % MODES];
    }
  }
}

/* "move along x, z and turn", or nothing */
static PetscErrorCode free_motions(const Model *model, const Body *body, char text[], size_t length)
{
  PetscReal    gram[MODES * MODES], values[MODES], work[4 * MODES], whole;
  PetscBLASInt n = MODES, n_work = 4 * MODES, info;
  PetscInt     n_free = 0, n_along = 0;
  char         along[16] = "";

  PetscFunctionBegin;
  prescribed_motions(model, body, gram, &whole);
  for (int i = 0; i < 3; i++) {
    char name[8];
    if (gram[(MODES + 1) * i] > 0) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s%c", n_along++ ? ", " : "", 'x' + i));
    PetscCall(PetscStrlcat(along, name, sizeof(along)));
  }
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("N", "U", &n, gram, &n, values, work, &n_work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK's syev failed");
  for (int m = 0; m < MODES; m++)
    n_free += values[m] < FREE * whole;
  PetscCall(PetscSNPrintf(text, length, "%s%s%s%s", n_along ? "move along " : "", along,
                          n_along && n_free > n_along ? " and " : "", n_free > n_along ? "turn" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode held_free(const Model *model, const Body *body, PetscBool *is_free)
{
  char motions[64] = "";
  PetscFunctionBegin;
  if (!body->analytic) PetscCall(free_motions(model, body, motions, sizeof(motions)));
  *is_free = (PetscBool)(motions[0] != 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A sentence for the user, on every rank. */
PetscErrorCode held_describe(const Model *model, char text[], size_t length)
{
  PetscFunctionBegin;
  text[0] = 0;
  for (PetscInt b = 0; b < model->mesh.n_bodies && model->rank == 0; b++) {
    const Body *body = &model->mesh.bodies[b];
    char        motions[64], part[256];
    if (body->analytic) continue;
    PetscCall(free_motions(model, body, motions, sizeof(motions)));
    if (!motions[0]) continue;
    PetscCall(PetscSNPrintf(part, sizeof(part), "%s%s is free to %s", text[0] ? ", " : "By the supports ", body->name,
                            motions));
    PetscCall(PetscStrlcat(text, part, length));
  }
  if (model->rank == 0)
    PetscCall(PetscStrlcat(text,
                           text[0] ? ": only contact can hold that, where bodies touch and as far as friction goes."
                                   : "Every body is held by supports; contact need not hold it.",
                           length));
  PetscCallMPI(MPI_Bcast(text, (PetscMPIInt)length, MPI_CHAR, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
