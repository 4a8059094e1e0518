/* Supports that are let go or activated at a time: `from`, `until`, `fade`.
 *
 * The displacements that such a support prescribes are unknowns from start to end, so that the equations stay those they are. While it
 * holds, their rows say s (u - p) = 0, with a stiffness s; Newton's method starts at u = p, so that they never change in it. The forces
 * that the rows had are the reaction. A support that is activated at T holds each node where it is then, and moves it from there:
 * p(t) = u(T) + (what the support says at t) - (what it says at T). One that is let go leaves its reaction at T as a dead force, which
 * fades linearly: a jump of forces could not be cut into smaller steps. */
#include "physics/timed.h"

PetscErrorCode timed_create(Physics *physics)
{
  PetscBool changed;
  PetscFunctionBegin;
  if (!timed_first(physics)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&physics->timed));
  PetscCall(PetscCalloc1(physics->unknowns.n_local, &physics->timed->held));
  PetscCall(VecDuplicate(physics->u_local, &physics->timed->place));
  PetscCall(VecDuplicate(physics->u_local, &physics->timed->let_go));
  PetscCall(VecDuplicate(physics->u_local, &physics->timed->caught));
  PetscCall(VecZeroEntries(physics->timed->place));
  PetscCall(VecZeroEntries(physics->timed->let_go));
  PetscCall(timed_begin(physics, PETSC_MACHINE_EPSILON * physics->end, &changed)); /* those of the first step */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode timed_destroy(Physics *physics)
{
  Timed *timed = physics->timed;
  PetscFunctionBegin;
  if (!timed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(timed->held));
  PetscCall(VecDestroy(&timed->place));
  PetscCall(VecDestroy(&timed->let_go));
  PetscCall(VecDestroy(&timed->caught));
  PetscCall(PetscFree(physics->timed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool timed_past(PetscReal t, PetscReal time)
{
  return (PetscBool)(t > time && !curve_same_time(t, time));
}

static void hold(const Support *support, PetscInt entry, int component, PetscBool owned, void *context)
{
  (void)support, (void)component, (void)owned;
  ((PetscBool *)context)[entry] = PETSC_TRUE;
}

PetscErrorCode timed_begin(Physics *physics, PetscReal t, PetscBool *changed)
{
  PetscFunctionBegin;
  *changed = PETSC_FALSE;
  if (!physics->timed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(physics->timed->held, physics->unknowns.n_local));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    Support        *support = &physics->supports[s];
    const PetscBool before  = support->active;
    if (!support->timed) continue;
    support->active = (PetscBool)((support->from == 0 || timed_past(t, support->from)) && !timed_past(t, support->until));
    *changed        = (PetscBool)(*changed || before != support->active);
    if (support->active) PetscCall(timed_visit(physics, support, hold, physics->timed->held));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool entry_held(const Physics *physics, PetscInt entry)
{
  return (PetscBool)(physics->unknowns.equations[entry] < 0 || (physics->timed && physics->timed->held[entry]));
}

static void add(const Support *support, PetscInt entry, int component, PetscBool owned, void *context)
{
  EntryCopies *copies = context;
  (void)support, (void)component, (void)owned;
  copies->to[entry] += copies->from[entry];
}

/* Into prescribed_local, which has what supports say: where they found their nodes. */
PetscErrorCode timed_values(Physics *physics)
{
  EntryCopies copies;
  PetscFunctionBegin;
  if (!physics->timed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(physics->timed->place, &copies.from));
  PetscCall(VecGetArray(physics->prescribed_local, &copies.to));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const Support *support = &physics->supports[s];
    if (support->timed && support->active && support->from > 0) PetscCall(timed_visit(physics, support, add, &copies));
  }
  PetscCall(VecRestoreArray(physics->prescribed_local, &copies.to));
  PetscCall(VecRestoreArrayRead(physics->timed->place, &copies.from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void timed_vectors(const Physics *physics, Vec *place, Vec *let_go)
{
  *place  = physics->timed->place;
  *let_go = physics->timed->let_go;
}
