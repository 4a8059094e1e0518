/* A step of the generalised-alpha scheme (Chung and Hulbert 1993) with contact forces at its end (Kane, Repetto, Ortiz and Marsden
 * 1999). With s for all forces but those of contact, s = F - f(u) - C v, and A = M a, where a is the acceleration by s alone:
 *
 *   (1 - alpha_m) A' + alpha_m A = s(t_a, u_a, v_a)                                      at u_a = (1 - alpha_f) u' + alpha_f u
 *   u' = u + dt v + dt^2 ((1/2 - beta) a + beta a' + 1/2 M^-1 r)
 *   v' = v + dt ((1 - gamma) a + gamma a' + M^-1 r)                                      r: contact forces at u'
 *
 * where a prime is the end of the step. Without a' this is, over kappa = (1 - alpha_m) / (2 beta), the residual
 *
 *   (2 / dt^2) M (u' - u - dt v) + (alpha_m / kappa - 1 + 2 beta) A - s / kappa - r = 0
 *
 * and v' = 2 (u' - u) / dt - v + (gamma - 2 beta) dt (a' - a). With rho_inf = 1 all terms of accelerations vanish: the midpoint rule.
 * Why energy does not grow then: docs/dynamics.md. Damping takes the velocity without its last term.
 *
 * Bodies of finite strain have no f(u_a): their forces are of both ends of the step (elasticity_step.c).
 *
 * Where displacements are prescribed v' and a' are what the supports say, and take part with (v' - v) / dt - (gamma - 2 beta) (a' - a) for
 * (2 / dt^2) (u' - u - dt v), which is the same of free ones. */
#include "physics/dynamics.h"

/* How many roundings meet in an inertial force: of a place, and of the sum over a cell. */
static const PetscReal ROUNDINGS = 2;

void dynamics_swap(Vec *a, Vec *b)
{
  const Vec kept = *a;
  *a             = *b;
  *b             = kept;
}

PetscErrorCode dynamics_look(const Physics *physics, StepView *step)
{
  const Dynamics *d = physics->dynamics;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(physics->u_local, &step->now));
  PetscCall(VecGetArrayRead(d->u, &step->u));
  PetscCall(VecGetArrayRead(d->v, &step->v));
  PetscCall(VecGetArrayRead(d->prescribed, &step->a));
  PetscCall(VecGetArrayRead(d->v_next, &step->v_next));
  PetscCall(VecGetArrayRead(d->prescribed_next, &step->a_next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode dynamics_looked(const Physics *physics, StepView *step)
{
  const Dynamics *d = physics->dynamics;
  PetscFunctionBegin;
  PetscCall(VecRestoreArrayRead(d->prescribed_next, &step->a_next));
  PetscCall(VecRestoreArrayRead(d->v_next, &step->v_next));
  PetscCall(VecRestoreArrayRead(d->prescribed, &step->a));
  PetscCall(VecRestoreArrayRead(d->v, &step->v));
  PetscCall(VecRestoreArrayRead(d->u, &step->u));
  PetscCall(VecRestoreArrayRead(physics->u_local, &step->now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where displacements are prescribed v_next and a_next are known when the step begins. */
PetscReal dynamics_rate(const Dynamics *d, const StepView *step, PetscInt k)
{
  const PetscReal moved = step->now[k] - step->u[k], v = step->v[k];
  if (d->entries[k] == MASS_FREE) return 2 * (moved / d->dt - v) / d->dt;
  if (d->entries[k] == MASS_NONE) return 0;
  return (step->v_next[k] - v) / d->dt - (d->gamma - 2 * d->beta) * (step->a_next[k] - step->a[k]);
}

PetscReal dynamics_velocity(const Dynamics *d, const StepView *step, PetscInt k)
{
  const PetscReal moved = step->now[k] - step->u[k], v = step->v[k];
  const PetscReal end = d->entries[k] == MASS_FREE ? 2 * moved / d->dt - v : step->v_next[k];
  return d->entries[k] == MASS_NONE ? 0 : (1 - d->alpha_f) * end + d->alpha_f * v;
}

BulkStep dynamics_bulk(const Physics *physics)
{
  const Dynamics *d = physics->dynamics;
  const PetscReal here = 1 - d->alpha_f, ahead = 2 * d->stiffness_damping / d->dt;
  return (BulkStep){.from = d->u, .to = physics->u_local, .rate = d->stiffness_damping > 0 ? d->rate : NULL, .alpha_f = d->alpha_f,
                    .ahead = here * ahead, .linear = here * (1 + ahead)};
}

/* `middle`: the place of the forces, and `rate`. The former with it where `damped`: of a linear body f(u) + b f(v) = f(u + b v) */
static PetscErrorCode set_middle(Physics *physics, PetscBool damped)
{
  Dynamics    *d = physics->dynamics;
  StepView     step;
  PetscScalar *middle, *rate;
  PetscFunctionBegin;
  PetscCall(dynamics_look(physics, &step));
  PetscCall(VecGetArray(d->middle, &middle));
  PetscCall(VecGetArray(d->rate, &rate));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++) {
    middle[k] = step.u[k] + (1 - d->alpha_f) * (step.now[k] - step.u[k]);
    if (!damped || !(d->stiffness_damping > 0) || !d->entries[k]) continue;
    rate[k] = d->stiffness_damping * dynamics_velocity(d, &step, k);
    middle[k] += rate[k];
  }
  PetscCall(VecRestoreArray(d->rate, &rate));
  PetscCall(VecRestoreArray(d->middle, &middle));
  PetscCall(dynamics_looked(physics, &step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Loads of the middle of the step, over kappa, into f_external; the place is u_local for now. What expands has no curve: a mean of both ends. */
PetscErrorCode dynamics_loads(Physics *physics)
{
  const Dynamics *d = physics->dynamics;
  const PetscReal t = physics->t;
  PetscFunctionBegin;
  physics->t = d->t_n + (1 - d->alpha_f) * d->dt;
  PetscCall(loads_values(physics));
  physics->t = t;
  if (d->thermal) {
    PetscCall(VecAXPY(physics->f_external, -d->alpha_f, physics->f_thermal));
    PetscCall(VecAXPY(physics->f_external, d->alpha_f, d->thermal));
  }
  PetscCall(VecScale(physics->f_external, 1 / d->scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Supports that hold in the step to come: which displacements have inertia of their own, and how what is held is accelerated from the
 * start of the step on. Who is let go keeps the velocity that the support has given him; who is caught loses his in the step. */
PetscErrorCode dynamics_hold(Physics *physics)
{
  Dynamics *d = physics->dynamics;
  PetscFunctionBegin;
  if (!physics->timed) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    if (d->entries[k] != MASS_NONE) d->entries[k] = entry_held(physics, k) ? MASS_PRESCRIBED : MASS_FREE;
  PetscCall(supports_rates(physics, d->t_n, SUPPORT_ACCELERATION, d->prescribed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode dynamics_warm(Physics *physics)
{
  Dynamics *d = physics->dynamics;
  PetscFunctionBegin;
  if (!d->thermal) PetscCall(VecDuplicate(physics->f_thermal, &d->thermal));
  PetscCall(VecCopy(physics->f_thermal, d->thermal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode dynamics_begin(Physics *physics)
{
  Dynamics          *d = physics->dynamics;
  const PetscScalar *v;
  PetscScalar       *impulse;
  PetscFunctionBegin;
  d->dt = physics->t - d->t_n;
  PetscCall(dynamics_hold(physics));
  rigids_lead(physics, physics->t);
  PetscCall(supports_rates(physics, physics->t, SUPPORT_VELOCITY, d->v_next));
  PetscCall(supports_rates(physics, physics->t, SUPPORT_ACCELERATION, d->prescribed_next));
  PetscCall(VecZeroEntries(d->impulse));
  PetscCall(VecGetArrayRead(d->v, &v));
  PetscCall(VecGetArray(d->impulse, &impulse));
  mass_multiply(physics, v, 2 / d->dt, impulse);
  rigids_add_impulse(physics, d->dt, impulse);
  PetscCall(VecRestoreArray(d->impulse, &impulse));
  PetscCall(VecRestoreArrayRead(d->v, &v));
  PetscCall(dynamics_loads(physics));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The last digit of a place, times the largest mass of its cell, over dt^2, to the squares of the parts. */
static void add_rounding(Physics *physics, const PetscScalar *u)
{
  const Cells    *cells = &physics->cells;
  const Dynamics *d     = physics->dynamics;
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt n = d->cells[c].n, *dofs = d->cells[c].dofs;
    PetscReal      largest = 0, mass = 0;
    for (PetscInt a = 0; a < n; a++) {
      mass = PetscMax(mass, d->cells[c].m[(n + 1) * a]);
      for (int i = 0; i < 3; i++)
        largest = PetscMax(largest, PetscAbsScalar(u[dofs[a] + i]));
    }
    physics->parts.squares[N_SQUARES * cells->part[c] + SQUARES_ROUNDING] +=
        (PetscReal)n * PetscSqr(ROUNDINGS * PETSC_MACHINE_EPSILON * largest * mass * 2 / PetscSqr(d->dt));
  }
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    if (!rigid->inertial || !rigid->owned || rigid->part < 0) continue;
    physics->parts.squares[N_SQUARES * rigid->part + SQUARES_ROUNDING] += PetscSqr(ROUNDINGS) * rigid_rounding(rigid, d->dt);
  }
}

/* Inertia and the damping by masses, at u_local */
static PetscErrorCode add_inertia(Physics *physics, Vec f_local)
{
  Dynamics    *d = physics->dynamics;
  StepView     step;
  PetscScalar *w, *f;
  PetscFunctionBegin;
  PetscCall(dynamics_look(physics, &step));
  PetscCall(VecGetArray(d->work, &w));
  PetscCall(VecGetArray(f_local, &f));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++) {
    w[k] = dynamics_rate(d, &step, k);
    if (d->mass_damping > 0) w[k] += d->mass_damping / d->scale * dynamics_velocity(d, &step, k);
  }
  mass_multiply(physics, w, 1, f);
  rigids_add_inertia(physics, d->dt, d->mass_damping, f);
  add_rounding(physics, step.now);
  PetscCall(VecRestoreArray(f_local, &f));
  PetscCall(VecRestoreArray(d->work, &w));
  PetscCall(dynamics_looked(physics, &step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All forces but those of contact and loads, which are in f_external. f_local is zero before. */
PetscErrorCode dynamics_forces(Physics *physics, Vec f_local, PetscInt *status)
{
  Dynamics      *d    = physics->dynamics;
  const BulkStep step = dynamics_bulk(physics);
  PetscFunctionBegin;
  if (loads_follow(physics)) {
    PetscCall(set_middle(physics, PETSC_FALSE));
    dynamics_swap(&physics->u_local, &d->middle);
    PetscCall(dynamics_loads(physics));
    dynamics_swap(&physics->u_local, &d->middle);
  }
  PetscCall(springs_step(physics, d->u, physics->u_local, d->alpha_f));
  PetscCall(set_middle(physics, PETSC_TRUE));
  dynamics_swap(&physics->u_local, &d->middle);
  PetscCall(bulk_step_forces(physics, &step, f_local, status));
  dynamics_swap(&physics->u_local, &d->middle);
  PetscCall(VecScale(f_local, 1 / d->scale));
  PetscCall(add_inertia(physics, f_local));
  if (d->rho_inf < 1) PetscCall(VecAXPY(f_local, d->alpha_m / d->scale - 1 + 2 * d->beta, d->force));
  PetscCall(VecCopy(f_local, d->smooth));
  PetscCall(parts_add_squares(physics, d->impulse, -1, SQUARES_REACTIONS));
  PetscCall(parts_add_squares(physics, d->impulse, -1, SQUARES_CARRIED));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode assemble(Mat matrix)
{
  PetscFunctionBegin;
  PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Their derivatives by u', and what followers differ by, into a matrix that is zero. */
PetscErrorCode dynamics_stiffness(Physics *physics, Mat matrix, PetscInt *status)
{
  Dynamics       *d    = physics->dynamics;
  const PetscReal here = (1 - d->alpha_f) / d->scale;
  const BulkStep  step = dynamics_bulk(physics);
  PetscFunctionBegin;
  PetscCall(springs_step(physics, d->u, physics->u_local, d->alpha_f));
  PetscCall(set_middle(physics, PETSC_TRUE));
  dynamics_swap(&physics->u_local, &d->middle);
  PetscCall(bulk_step_stiffness(physics, &step, matrix, status));
  dynamics_swap(&physics->u_local, &d->middle);
  PetscCall(assemble(matrix));
  PetscCall(MatScale(matrix, 1 + 2 * d->stiffness_damping / d->dt));
  if (loads_follow(physics)) {
    const PetscReal t = physics->t;
    PetscCall(set_middle(physics, PETSC_FALSE));
    physics->t = d->t_n + (1 - d->alpha_f) * d->dt;
    dynamics_swap(&physics->u_local, &d->middle);
    PetscCall(loads_stiffness(physics, matrix));
    dynamics_swap(&physics->u_local, &d->middle);
    physics->t = t;
    PetscCall(assemble(matrix));
  }
  PetscCall(MatScale(matrix, here));
  PetscCall(mass_insert(physics, 2 / PetscSqr(d->dt) + 2 / d->dt * here * d->mass_damping, matrix));
  PetscCall(rigids_insert_inertia(physics, d->dt, d->mass_damping, matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}
