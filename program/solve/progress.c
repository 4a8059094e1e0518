/* A line now and then while a step takes long: Newton's iterations, and GMRES' within them. */
#include "solve/solve.h"

/* Seconds between two lines. */
static const PetscLogDouble PAUSE = 30;

/* Of iterations of this kind, if it is time for one. */
static PetscErrorCode tell(Solve *solve, const char *kind, PetscInt iteration, PetscReal norm)
{
  PetscLogDouble now;
  PetscFunctionBegin;
  PetscCall(PetscTime(&now));
  PetscCallMPI(MPI_Bcast(&now, 1, MPI_DOUBLE, 0, PETSC_COMM_WORLD)); /* all ranks by one clock */
  if (now - solve->told < PAUSE) PetscFunctionReturn(PETSC_SUCCESS);
  solve->told = now;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "     t %-10.6g %s iteration %" PetscInt_FMT "  |r| %.2e\n", (double)solve->physics->t, kind,
                        iteration, (double)norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode newton_line(SNES snes, PetscInt iteration, PetscReal norm, void *context)
{
  PetscFunctionBegin;
  (void)snes;
  PetscCall(tell(context, "newton", iteration, norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode krylov_line(KSP ksp, PetscInt iteration, PetscReal norm, void *context)
{
  PetscFunctionBegin;
  (void)ksp;
  PetscCall(tell(context, "linear", iteration, norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode progress_begin(Solve *solve)
{
  PetscFunctionBegin;
  PetscCall(PetscTime(&solve->told));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode progress_watch(Solve *solve, SNES snes, KSP krylov)
{
  PetscFunctionBegin;
  if (solve->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  if (snes) PetscCall(SNESMonitorSet(snes, newton_line, solve, NULL));
  if (krylov) PetscCall(KSPMonitorSet(krylov, krylov_line, solve, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}
