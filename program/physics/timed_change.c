/* Times at which supports change, and what happens then. */
#include "physics/timed.h"

PetscErrorCode timed_catch(Physics *physics)
{
  PetscFunctionBegin;
  if (!physics->timed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(unknowns_sum(physics, physics->f_local));
  PetscCall(VecCopy(physics->f_sum, physics->timed->caught));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void copy(const Support *support, PetscInt entry, int component, PetscBool owned, void *context)
{
  EntryCopies *copies = context;
  (void)support, (void)component, (void)owned;
  copies->to[entry] = copies->from[entry];
}

/* A turn of a rigid body counts from the last step, and has no place that it was found at. */
static void copy_place(const Support *support, PetscInt entry, int component, PetscBool owned, void *context)
{
  if (component < 3) copy(support, entry, component, owned, context);
}

static PetscErrorCode take(Physics *physics, const Support *support, EntryVisit action, Vec from, Vec to)
{
  EntryCopies copies;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(from, &copies.from));
  PetscCall(VecGetArray(to, &copies.to));
  PetscCall(timed_visit(physics, support, action, &copies));
  PetscCall(VecRestoreArray(to, &copies.to));
  PetscCall(VecRestoreArrayRead(from, &copies.from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What those leave that hold no more, and where those find their nodes that hold from now on. */
PetscErrorCode timed_accept(Physics *physics)
{
  Timed    *timed = physics->timed;
  PetscBool changed;
  Vec       apart;
  PetscFunctionBegin;
  if (!timed) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const Support *support = &physics->supports[s];
    if (support->timed && support->active && curve_same_time(physics->t, support->until)) PetscCall(take(physics, support, copy, timed->caught, timed->let_go));
  }
  PetscCall(VecDuplicate(physics->u_local, &apart));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    Support *support = &physics->supports[s];
    if (!support->timed || support->from == 0 || !curve_same_time(physics->t, support->from)) continue;
    support->active = PETSC_TRUE; /* so that prescribed_local has what it says */
    PetscCall(supports_values(physics, physics->t));
    PetscCall(VecWAXPY(apart, -1, physics->prescribed_local, physics->u_local));
    PetscCall(VecAXPY(apart, 1, timed->place));
    PetscCall(take(physics, support, copy_place, apart, timed->place));
  }
  PetscCall(VecDestroy(&apart));
  PetscCall(timed_begin(physics, physics->t, &changed));
  PetscCall(supports_values(physics, physics->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt timed_times(const Physics *physics, PetscReal times[])
{
  PetscInt n = 0;
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const Support *support = &physics->supports[s];
    if (!support->timed) continue;
    times[n++] = support->from;
    times[n++] = support->until;
  }
  return n;
}

PetscBool timed_bend(const Physics *physics, PetscReal t)
{
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const Support *support = &physics->supports[s];
    if (support->timed && (curve_same_time(t, support->from) || curve_same_time(t, support->until) ||
                           (support->until < PETSC_MAX_REAL && curve_same_time(t, support->until + support->fade))))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* A step, and no longer: while it lasts the model has a force that the scene does not name. With inertia there is none: what is let go
 * begins to move, however large the force was. */
void timed_fade(Physics *physics, PetscInt n, const PetscReal times[], PetscReal longest)
{
  if (physics->dynamics) n = 0;
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    Support *support = &physics->supports[s];
    for (PetscInt k = 0; k < n && support->timed && support->fade < 0; k++) {
      if (timed_past(times[k], support->until)) support->fade = PetscMin(times[k] - support->until, longest);
    }
    if (support->timed && support->fade < 0) support->fade = 0; /* it holds up to the end, or is dynamic */
  }
}
