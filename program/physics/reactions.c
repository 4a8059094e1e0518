/* Reactions beside those of each support (supports.c): what several supports count that hold the same component of the same vertex, and
 * what is left of one that was let go. */
#include "physics/timed.h"

/* What supports before this one hold. */
typedef struct {
  PetscInt           support; /* its number */
  const PetscScalar *f;
  PetscInt          *first; /* of each entry the first support, -1: none yet */
  PetscBool         *shared; /* of this support, by the others */
  PetscReal         *twice;
} Shared;

static void add_shared(const Support *support, PetscInt entry, int component, PetscBool owned, void *context)
{
  Shared *of = context;
  (void)support, (void)owned;
  if (of->first[entry] < 0) {
    of->first[entry] = of->support;
    return;
  }
  of->shared[of->first[entry]] = PETSC_TRUE;
  of->twice[component] += PetscRealPart(of->f[entry]);
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
    Shared         of      = {.support = s, .f = f, .first = first, .shared = shared + n * s, .twice = twice};
    if (support->rigid < 0 && !(support->timed && !support->active)) PetscCall(support_visit(physics, support, add_shared, &of));
  }
  PetscCall(VecRestoreArrayRead(physics->f_local, &f));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, shared, (PetscMPIInt)(n * n), MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, twice, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The force that is left at physics->t of a support that was let go, without the moments of a rigid body; false: none */
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
    if (support->rigid >= 0 && at == physics->rigids[support->rigid].at[1]) continue;
    for (int i = 0; i < 3; i++)
      force[i] += PetscRealPart(forces[at + i]);
  }
  PetscCall(PetscFree(forces));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
