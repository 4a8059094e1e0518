/* What supports that change put into vectors and the matrix: rows u = p while they hold, reactions that fade afterwards. */
#include "physics/timed.h"

/* Those that this rank owns. */
typedef struct {
  PetscInt   n, *equations;
  PetscReal *apart; /* u_local less what it must be */
} HeldEntries;

static PetscErrorCode held_entries(Physics *physics, HeldEntries *held)
{
  const Timed       *timed = physics->timed;
  const PetscScalar *p, *u;
  PetscFunctionBegin;
  held->n = 0;
  PetscCall(PetscMalloc2(physics->unknowns.n_local, &held->equations, physics->unknowns.n_local, &held->apart));
  PetscCall(VecGetArrayRead(physics->prescribed_local, &p));
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  for (PetscInt k = 0; k < physics->mesh->n_points; k++) {
    PetscInt at;
    if (physics->unknowns.ghost[k]) continue;
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, physics->mesh->points[k], &at));
    for (int i = 0; i < 3; i++) {
      if (!timed->held[at + i]) continue;
      held->equations[held->n] = physics->unknowns.equations[at + i];
      held->apart[held->n++]   = PetscRealPart(u[at + i] - p[at + i]);
    }
  }
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCall(VecRestoreArrayRead(physics->prescribed_local, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode put(Physics *physics, Vec to, PetscReal kept, PetscReal factor)
{
  HeldEntries held;
  PetscScalar *array;
  PetscInt     first;
  PetscFunctionBegin;
  PetscCall(held_entries(physics, &held));
  PetscCall(VecGetOwnershipRange(to, &first, NULL));
  PetscCall(VecGetArray(to, &array));
  for (PetscInt k = 0; k < held.n; k++)
    array[held.equations[k] - first] = kept * array[held.equations[k] - first] + factor * held.apart[k];
  PetscCall(VecRestoreArray(to, &array));
  PetscCall(PetscFree2(held.equations, held.apart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode timed_place(Physics *physics, Vec x)
{
  PetscFunctionBegin;
  if (!physics->timed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(unknowns_to_local(physics, x));
  PetscCall(put(physics, x, 1, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode timed_residual(Physics *physics, PetscReal scale, Vec r)
{
  PetscFunctionBegin;
  if (physics->timed) PetscCall(put(physics, r, 0, scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode timed_identity(Physics *physics, Mat matrix)
{
  HeldEntries held;
  PetscFunctionBegin;
  PetscCall(held_entries(physics, &held));
  PetscCall(MatZeroRowsColumns(matrix, held.n, held.equations, 1, NULL, NULL));
  PetscCall(PetscFree2(held.equations, held.apart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode timed_rows(Physics *physics, PetscReal scale, Mat matrix)
{
  HeldEntries held;
  PetscFunctionBegin;
  if (!physics->timed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(held_entries(physics, &held));
  PetscCall(MatSetOption(matrix, MAT_KEEP_NONZERO_PATTERN, PETSC_TRUE));
  PetscCall(MatZeroRows(matrix, held.n, held.equations, scale, NULL, NULL));
  PetscCall(PetscFree2(held.equations, held.apart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  const PetscBool   *held;
  const PetscScalar *let_go;
  PetscScalar       *forces;
  PetscReal          factor;
} Fading;

static void add_fading(const Support *support, PetscInt entry, int component, PetscBool owned, void *context)
{
  Fading *fading = context;
  (void)support, (void)component;
  if (owned && !fading->held[entry]) fading->forces[entry] += fading->factor * fading->let_go[entry];
}

PetscErrorCode timed_fading(const Physics *physics, const Support *support, PetscScalar *forces, PetscBool *fades)
{
  const Timed *timed  = physics->timed;
  Fading       fading = {.held = timed->held, .forces = forces};
  PetscFunctionBegin;
  *fades = PETSC_FALSE;
  if (!support->timed || !timed_past(physics->t, support->until)) PetscFunctionReturn(PETSC_SUCCESS);
  fading.factor = 1 - (support->fade > 0 ? (physics->t - support->until) / support->fade : 1);
  *fades        = (PetscBool)(fading.factor > 0 && !curve_same_time(physics->t, support->until + support->fade));
  if (!*fades) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(timed->let_go, &fading.let_go));
  PetscCall(timed_visit(physics, support, add_fading, &fading));
  PetscCall(VecRestoreArrayRead(timed->let_go, &fading.let_go));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode timed_forces(Physics *physics, PetscScalar *forces)
{
  PetscBool fades;
  PetscFunctionBegin;
  for (PetscInt s = 0; s < physics->n_supports && physics->timed; s++)
    PetscCall(timed_fading(physics, &physics->supports[s], forces, &fades));
  PetscFunctionReturn(PETSC_SUCCESS);
}
