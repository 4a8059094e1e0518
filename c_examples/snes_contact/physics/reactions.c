/* Reactions beside those of each support (supports.c): what several supports count that hold the same component of the same vertex, and
 * what is left of one that was let go. */
#include "physics/timed.h"

/* This rank's entries of one support: those that an earlier one holds, too. `first`: the first support of each entry, -1: none yet */
static PetscErrorCode add_shared(const Physics *physics, PetscInt s, const PetscScalar *f, PetscInt first[], PetscBool shared[], PetscReal twice[3])
{
  const Support  *support = &physics->supports[s];
  char            label[2 * NAME_LENGTH];
  const PetscInt *points;
  PetscInt        n, at;
  IS              is;
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(label, sizeof(label), "support.%s", support->name));
  PetscCall(DMGetStratumIS(physics->mesh->dm, label, 1, &is));
  if (!is) PetscFunctionReturn(PETSC_SUCCESS); /* no such vertex on this rank */
  PetscCall(ISGetLocalSize(is, &n));
  PetscCall(ISGetIndices(is, &points));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, points[k], &at));
    for (int i = 0; i < 3; i++) {
      if (!(support->mask & (1 << i))) continue;
      if (first[at + i] < 0) {
        first[at + i] = s;
        continue;
      }
      shared[physics->n_supports * s + first[at + i]] = PETSC_TRUE;
      twice[i] += PetscRealPart(f[at + i]);
    }
  }
  PetscCall(ISRestoreIndices(is, &points));
  PetscCall(ISDestroy(&is));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `shared` (n_supports x n_supports): does a support count forces that this earlier one counts, too? `twice`: what is so counted more
 * than once in the sum of all reactions. Of the last evaluation. */
PetscErrorCode supports_shared(const Physics *physics, PetscBool shared[], PetscReal twice[3])
{
  const PetscInt     n = physics->n_supports;
  const PetscScalar *f;
  PetscInt          *first;
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(shared, n * n));
  PetscCall(PetscArrayzero(twice, 3));
  PetscCall(PetscMalloc1(physics->unknowns.n_local, &first));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    first[k] = -1;
  PetscCall(VecGetArrayRead(physics->f_local, &f));
  for (PetscInt s = 0; s < n; s++) {
    const Support *support = &physics->supports[s];
    if (support->rigid < 0 && !(support->timed && !support->active)) PetscCall(add_shared(physics, s, f, first, shared, twice));
  }
  PetscCall(VecRestoreArrayRead(physics->f_local, &f));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, shared, (PetscMPIInt)(n * n), MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, twice, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The force that is left at physics->t of a support that was let go; false: none */
PetscErrorCode supports_fading(const Physics *physics, const Support *support, PetscReal force[3], PetscBool *fades)
{
  PetscScalar *forces;
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(force, 3));
  *fades = PETSC_FALSE;
  if (!physics->timed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(physics->unknowns.n_local, &forces));
  PetscCall(timed_fading(physics, support, forces, fades));
  for (PetscInt k = 0; k < physics->mesh->n_points; k++) {
    PetscInt at;
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, physics->mesh->points[k], &at));
    for (int i = 0; i < 3; i++)
      force[i] += PetscRealPart(forces[at + i]);
  }
  PetscCall(PetscFree(forces));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
