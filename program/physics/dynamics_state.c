/* What the time integration remembers from step to step: displacements, velocities, smooth forces, balance. An attempt changes none of
 * it; the end of the step is computed beside it (dynamics_balance.c) and put in place when the step is accepted. */
#include "physics/dynamics.h"

/* Velocities at t = 0, of the nodes that have mass: what supports say of theirs goes before what the bodies do. */
static PetscErrorCode start(Physics *physics)
{
  const Cells       *cells = &physics->cells;
  Dynamics          *d     = physics->dynamics;
  const PetscScalar *supported;
  PetscScalar       *v;
  PetscFunctionBegin;
  PetscCall(supports_rates(physics, 0, SUPPORT_VELOCITY, d->v_next));
  PetscCall(supports_rates(physics, 0, SUPPORT_ACCELERATION, d->prescribed));
  PetscCall(VecGetArray(d->v, &v));
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscReal *motion = d->velocity + MOTION_NUMBERS * cells->body[c], *spin = motion + 3;
    if (!d->cells[c].n) continue;
    for (PetscInt k = cells->offsets[c]; k < cells->offsets[c + 1]; k++) {
      PetscReal arm[3];
      for (int i = 0; i < 3; i++)
        arm[i] = cells->X[3 * k + i] - motion[6 + i];
      for (int i = 0; i < 3; i++)
        v[cells->dofs[k] + i] = motion[i] + spin[(i + 1) % 3] * arm[(i + 2) % 3] - spin[(i + 2) % 3] * arm[(i + 1) % 3];
    }
  }
  PetscCall(VecGetArrayRead(d->v_next, &supported));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++) {
    if (d->entries[k] == MASS_PRESCRIBED) v[k] = supported[k];
  }
  PetscCall(VecRestoreArrayRead(d->v_next, &supported));
  PetscCall(VecRestoreArray(d->v, &v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* M a at t = 0: loads, damping, and what bodies are strained by supports that do not begin at 0. Contact has no part in it. */
static PetscErrorCode first_force(Physics *physics, PetscInt *status)
{
  Dynamics          *d    = physics->dynamics;
  const Vec          kept = physics->u_local;
  const BulkStep     step = {.from = d->u, .to = d->u, .rate = d->rate};
  const PetscScalar *v;
  PetscScalar       *f;
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(d->force));
  PetscCall(VecCopy(d->u, d->middle));
  physics->u_local = d->middle;
  PetscCall(loads_values(physics));
  PetscCall(VecAXPY(d->rate, d->stiffness_damping, d->v));
  PetscCall(VecAXPY(d->middle, 1, d->rate)); /* a linear body: f(u) + b f(v) = f(u + b v) */
  PetscCall(bulk_step_forces(physics, &step, d->force, status));
  physics->u_local = kept;
  PetscCall(VecGetArrayRead(d->v, &v));
  PetscCall(VecGetArray(d->force, &f));
  mass_multiply(physics, v, d->mass_damping, f);
  PetscCall(VecRestoreArray(d->force, &f));
  PetscCall(VecRestoreArrayRead(d->v, &v));
  PetscCall(VecAYPX(d->force, -1, physics->f_external));
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { N_VECTORS = 12 };

/* All that it has. */
static void list_vectors(Dynamics *d, Vec *vectors[N_VECTORS])
{
  Vec *const all[N_VECTORS] = {&d->u, &d->v, &d->force, &d->prescribed, &d->v_next, &d->force_next, &d->prescribed_next,
                               &d->middle, &d->work, &d->smooth, &d->impulse, &d->rate};
  for (int k = 0; k < N_VECTORS; k++)
    vectors[k] = all[k];
}

/* An energy that is nothing: of forces too small to be measured by (Part.faint). Bodies at rest have that of rounding, which nothing balances. */
static PetscReal faintest(const Physics *physics)
{
  PetscReal energy = 0;
  for (PetscInt p = 0; p < physics->parts.n; p++) {
    const Part *part = &physics->parts.part[p];
    if (part->young > 0 && part->size > 0) energy += PetscSqr(part->faint) / (part->young * part->size);
  }
  return energy;
}

PetscErrorCode dynamics_create(Scene *scene, Physics *physics)
{
  Dynamics *d = physics->dynamics;
  Vec      *vectors[N_VECTORS];
  PetscInt  status;
  PetscFunctionBegin;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  list_vectors(d, vectors);
  for (int k = 0; k < N_VECTORS; k++) {
    PetscCall(VecDuplicate(physics->u_local, vectors[k]));
    PetscCall(VecZeroEntries(*vectors[k]));
  }
  PetscCall(mass_create(physics));
  if (d->spread) PetscCall(mass_spread(scene, physics));
  PetscCall(dynamics_hold(physics));
  for (PetscInt c = 0; c < physics->cells.n; c++) {
    for (PetscInt r = 0; r < physics->n_rigids; r++)
      if (physics->cells.body[c] == physics->rigids[r].body) physics->rigids[r].part = physics->cells.part[c];
  }
  rigids_start(physics);
  PetscCall(supports_values(physics, 0));
  PetscCall(VecCopy(physics->prescribed_local, d->u));
  PetscCall(start(physics));
  if (d->rho_inf < 1) {
    PetscCall(mass_matrix(physics));
    PetscCall(first_force(physics, &status));
    if (status)
      scene_fail(scene, "dynamics", "rho_inf", "below 1 it asks for accelerations at t = 0, where %s by supports that do not begin at 0.",
                 physics->inverted);
  }
  PetscCall(dynamics_energies(physics, d->u, d->v, PETSC_FALSE, &d->last));
  d->last.largest = faintest(physics) + d->last.kinetic + d->last.strain;
  d->start        = d->last;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step to physics->t, u_local */
PetscErrorCode dynamics_accept(Physics *physics)
{
  Dynamics *d = physics->dynamics;
  PetscFunctionBegin;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCopy(physics->u_local, d->u));
  PetscCall(rigids_accept_inertia(physics, d->dt));
  dynamics_swap(&d->v, &d->v_next);
  dynamics_swap(&d->force, &d->force_next);
  dynamics_swap(&d->prescribed, &d->prescribed_next);
  d->last = d->now;
  d->t_n  = physics->t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode dynamics_destroy(Physics *physics)
{
  Dynamics *d = physics->dynamics;
  Vec      *vectors[N_VECTORS];
  PetscFunctionBegin;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  list_vectors(d, vectors);
  for (int k = 0; k < N_VECTORS; k++)
    PetscCall(VecDestroy(vectors[k]));
  PetscCall(VecDestroy(&d->thermal));
  PetscCall(MatDestroy(&d->matrix));
  PetscCall(KSPDestroy(&d->solver));
  PetscCall(PetscFree(d->velocity));
  PetscCall(mass_destroy(physics));
  PetscCall(PetscFree(d->entries));
  PetscCall(PetscFree(physics->dynamics));
  PetscFunctionReturn(PETSC_SUCCESS);
}
