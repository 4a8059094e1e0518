/* The end of a step: velocities, and what the scheme says of energy and momentum. Work is force times displacement of the step; all
 * forces are those of the residual; inertia of what supports move works with the mean of both velocities, for a jump of the velocity is an
 * impulse that acts while it jumps. So with rho_inf = 1 the sum holds to rounding and Newton's tolerance:
 *
 *   kinetic + strain = those at t = 0 + work of loads, supports and contact - damping. */
#include "physics/dynamics.h"

/* Momentum, and energy of motion: v M v / 2 */
static void add_motion(const Physics *physics, const PetscScalar *u, const PetscScalar *v, Balance *balance)
{
  const Dynamics *d = physics->dynamics;
  for (PetscInt c = 0; c < physics->cells.n; c++) {
    const CellMass *mass = &d->cells[c];
    const PetscInt  n = mass->n, *dofs = mass->dofs;
    for (PetscInt a = 0; a < n; a++) {
      PetscReal p[3] = {0, 0, 0}, x[3];
      for (PetscInt b = 0; b < n; b++) {
        for (int i = 0; i < 3; i++)
          p[i] += mass->m[n * a + b] * PetscRealPart(v[dofs[b] + i]);
      }
      for (int i = 0; i < 3; i++) {
        x[i] = mass->X[3 * a + i] + PetscRealPart(u[dofs[a] + i]);
        balance->kinetic += 0.5 * PetscRealPart(v[dofs[a] + i]) * p[i];
        balance->momentum[i] += p[i];
      }
      for (int i = 0; i < 3; i++)
        balance->angular[i] += x[(i + 1) % 3] * p[(i + 2) % 3] - x[(i + 2) % 3] * p[(i + 1) % 3];
    }
  }
}

static void add_strain(const Physics *physics, const PetscScalar *u, Balance *balance)
{
  const Cells    *cells = &physics->cells;
  const Dynamics *d     = physics->dynamics;
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt first = cells->offsets[c], n = cells->offsets[c + 1] - first;
    const Element  element = bulk_element(physics, c);
    PetscReal      u_cell[3 * CELL_NODES];
    if (!d->cells[c].n) continue;
    for (PetscInt k = 0; k < 3 * n; k++)
      u_cell[k] = PetscRealPart(u[cells->dofs[first + k / 3] + k % 3]);
    balance->strain += cell_energy(&element, u_cell);
  }
}

/* Of all ranks; work is left as it is. */
PetscErrorCode dynamics_energies(Physics *physics, Vec u_local, Vec v_local, PetscBool end, Balance *balance)
{
  const PetscScalar *u, *v;
  PetscReal          all[8];
  Balance            here = {0};
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(u_local, &u));
  PetscCall(VecGetArrayRead(v_local, &v));
  add_motion(physics, u, v, &here);
  add_strain(physics, u, &here);
  rigids_add_motion(physics, physics->dynamics->dt, end, &here.kinetic, here.momentum, here.angular);
  if (physics->springs) PetscCall(springs_energy(physics, u, &here.strain));
  PetscCall(VecRestoreArrayRead(v_local, &v));
  PetscCall(VecRestoreArrayRead(u_local, &u));
  all[0] = here.kinetic;
  all[1] = here.strain;
  for (int i = 0; i < 3; i++)
    all[2 + i] = here.momentum[i], all[5 + i] = here.angular[i];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, 8, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  balance->kinetic = all[0];
  balance->strain  = all[1];
  for (int i = 0; i < 3; i++)
    balance->momentum[i] = all[2 + i], balance->angular[i] = all[5 + i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* v' of the midpoint rule; of what is prescribed it is known */
static PetscErrorCode set_velocity(Physics *physics)
{
  Dynamics          *d = physics->dynamics;
  const PetscScalar *now, *u, *v;
  PetscScalar       *next;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(physics->u_local, &now));
  PetscCall(VecGetArrayRead(d->u, &u));
  PetscCall(VecGetArrayRead(d->v, &v));
  PetscCall(VecGetArray(d->v_next, &next));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++) {
    if (d->entries[k] == MASS_FREE) next[k] = 2 * ((now[k] - u[k]) / d->dt) - v[k];
  }
  PetscCall(VecRestoreArray(d->v_next, &next));
  PetscCall(VecRestoreArrayRead(d->v, &v));
  PetscCall(VecRestoreArrayRead(d->u, &u));
  PetscCall(VecRestoreArrayRead(physics->u_local, &now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The smooth forces at the end, A' = (s - alpha_m A) / (1 - alpha_m), with s out of the residual without contact and inertia. */
static PetscErrorCode set_force(Physics *physics)
{
  Dynamics    *d = physics->dynamics;
  StepView     step;
  PetscScalar *w, *force;
  PetscFunctionBegin;
  PetscCall(dynamics_look(physics, &step));
  PetscCall(VecGetArray(d->work, &w));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    w[k] = dynamics_rate(d, &step, k);
  PetscCall(dynamics_looked(physics, &step));
  PetscCall(VecWAXPY(d->force_next, -1, d->smooth, physics->f_external)); /* both over kappa */
  PetscCall(VecAXPY(d->force_next, d->alpha_m / d->scale - 1 + 2 * d->beta, d->force));
  PetscCall(VecGetArray(d->force_next, &force));
  mass_multiply(physics, w, 1, force);
  PetscCall(VecRestoreArray(d->force_next, &force));
  PetscCall(VecRestoreArray(d->work, &w));
  PetscCall(VecScale(d->force_next, d->scale / (1 - d->alpha_m)));
  PetscCall(VecAXPY(d->force_next, -d->alpha_m / (1 - d->alpha_m), d->force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* v' += (gamma - 2 beta) dt (a' - a), with M (a' - a) = A' - A where no displacement is prescribed */
static PetscErrorCode correct_velocity(Physics *physics)
{
  Dynamics          *d  = physics->dynamics;
  const Mesh        *mesh = physics->mesh;
  const PetscReal    factor = (d->gamma - 2 * d->beta) * d->dt;
  KSPConvergedReason reason;
  const PetscScalar *by, *p;
  PetscScalar       *f, *next;
  Vec                rhs, change;
  Mat                matrix;
  PetscFunctionBegin;
  PetscCall(DMCreateGlobalVector(mesh->dm, &rhs));
  PetscCall(VecDuplicate(rhs, &change));
  PetscCall(VecWAXPY(d->work, -1, d->prescribed_next, d->prescribed)); /* minus the change */
  PetscCall(VecWAXPY(d->middle, -1, d->force, d->force_next));
  PetscCall(VecGetArrayRead(d->work, &p));
  PetscCall(VecGetArray(d->middle, &f));
  mass_multiply(physics, p, 1, f);
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    f[k] = d->entries[k] == MASS_FREE ? f[k] : 0;
  PetscCall(VecRestoreArray(d->middle, &f));
  PetscCall(VecRestoreArrayRead(d->work, &p));
  PetscCall(VecZeroEntries(rhs));
  PetscCall(DMLocalToGlobalBegin(mesh->dm, d->middle, ADD_VALUES, rhs));
  PetscCall(DMLocalToGlobalEnd(mesh->dm, d->middle, ADD_VALUES, rhs));
  if (physics->timed) {
    PetscCall(MatDuplicate(d->matrix, MAT_COPY_VALUES, &matrix));
    PetscCall(timed_identity(physics, matrix));
    PetscCall(KSPSetOperators(d->solver, matrix, matrix));
    PetscCall(MatDestroy(&matrix));
  }
  PetscCall(KSPSolve(d->solver, rhs, change));
  PetscCall(KSPGetConvergedReason(d->solver, &reason));
  PetscCheck(reason > 0 || reason == KSP_DIVERGED_ITS, PETSC_COMM_WORLD, PETSC_ERR_NOT_CONVERGED, "the mass matrix is not solved: %s",
             KSPConvergedReasons[reason]);
  PetscCall(VecZeroEntries(d->work));
  PetscCall(DMGlobalToLocalBegin(mesh->dm, change, INSERT_VALUES, d->work));
  PetscCall(DMGlobalToLocalEnd(mesh->dm, change, INSERT_VALUES, d->work));
  PetscCall(VecGetArrayRead(d->work, &by));
  PetscCall(VecGetArray(d->v_next, &next));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++) {
    if (d->entries[k] == MASS_FREE) next[k] += factor * by[k];
  }
  PetscCall(VecRestoreArray(d->v_next, &next));
  PetscCall(VecRestoreArrayRead(d->work, &by));
  PetscCall(VecDestroy(&change));
  PetscCall(VecDestroy(&rhs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Work over the step: this rank's, of loads, supports, contact */
static PetscErrorCode add_work(Physics *physics, PetscReal work[3])
{
  Dynamics          *d = physics->dynamics;
  const PetscScalar *f, *external, *smooth, *inertia;
  PetscScalar       *w, *forces;
  StepView           step;
  PetscFunctionBegin;
  PetscCall(dynamics_look(physics, &step));
  PetscCall(VecZeroEntries(d->middle));
  PetscCall(VecGetArray(d->work, &w));
  PetscCall(VecGetArray(d->middle, &forces));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    w[k] = dynamics_rate(d, &step, k);
  mass_multiply(physics, w, 1, forces);
  PetscCall(VecRestoreArray(d->middle, &forces));
  PetscCall(VecRestoreArray(d->work, &w));
  PetscCall(VecGetArrayRead(d->middle, &inertia));
  PetscCall(VecGetArrayRead(physics->f_local, &f));
  PetscCall(VecGetArrayRead(physics->f_external, &external));
  PetscCall(VecGetArrayRead(d->smooth, &smooth));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++) {
    const PetscReal moved = step.now[k] - step.u[k];
    if (!d->entries[k]) continue;
    work[0] += external[k] * moved;
    if (d->entries[k] == MASS_PRESCRIBED) work[1] += f[k] * moved + inertia[k] * (d->dt * (step.v[k] + step.v_next[k]) / 2 - moved);
    work[2] += (smooth[k] - external[k] - f[k]) * moved; /* contact gives the residual its forces with a minus */
  }
  PetscCall(VecRestoreArrayRead(d->smooth, &smooth));
  PetscCall(VecRestoreArrayRead(physics->f_external, &external));
  PetscCall(VecRestoreArrayRead(physics->f_local, &f));
  PetscCall(VecRestoreArrayRead(d->middle, &inertia));
  PetscCall(dynamics_looked(physics, &step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Energy that damping takes in the step; this rank's */
static PetscErrorCode add_damping(Physics *physics, PetscReal *gone)
{
  Dynamics          *d = physics->dynamics;
  const Vec          kept = physics->u_local;
  BulkStep           bulk = dynamics_bulk(physics);
  StepView           step;
  PetscScalar       *w, *f;
  PetscInt           status;
  PetscFunctionBegin;
  if (!(d->mass_damping > 0 || d->stiffness_damping > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecZeroEntries(d->work));
  PetscCall(dynamics_look(physics, &step));
  PetscCall(VecGetArray(d->middle, &w));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    w[k] = dynamics_velocity(d, &step, k);
  PetscCall(VecRestoreArray(d->middle, &w));
  if (d->stiffness_damping > 0) {
    bulk.damping_only = PETSC_TRUE;
    PetscCall(VecCopy(d->middle, d->rate));
    PetscCall(VecScale(d->rate, d->stiffness_damping));
    physics->u_local = d->rate; /* which linear bodies take */
    PetscCall(bulk_step_forces(physics, &bulk, d->work, &status));
    physics->u_local = kept;
  }
  PetscCall(VecGetArray(d->middle, &w));
  PetscCall(VecGetArray(d->work, &f));
  mass_multiply(physics, w, d->mass_damping, f);
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    *gone += f[k] * (step.now[k] - step.u[k]) * (d->entries[k] != MASS_NONE);
  PetscCall(VecRestoreArray(d->work, &f));
  PetscCall(VecRestoreArray(d->middle, &w));
  PetscCall(dynamics_looked(physics, &step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a node move that has no mass, of a rigid body that is moved or an analytic surface? Contact does its work then. */
static PetscErrorCode massless_moves(const Physics *physics, PetscBool *moves)
{
  const Dynamics *d = physics->dynamics;
  StepView        step;
  PetscFunctionBegin;
  *moves = PETSC_FALSE;
  PetscCall(dynamics_look(physics, &step));
  for (PetscInt k = 0; k < physics->mesh->n_points && !*moves; k++) {
    const PetscInt r = rigids_of_vertex(physics, physics->mesh->original[k]);
    PetscInt       at;
    if (r >= 0 && physics->rigids[r].inertial) continue;
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, physics->mesh->points[k], &at));
    for (PetscInt i = at; i < at + 3; i++)
      if (d->entries[i] == MASS_NONE && step.now[i] != step.u[i]) *moves = PETSC_TRUE;
  }
  PetscCall(dynamics_looked(physics, &step));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, moves, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By rho_inf below 1; else what Newton's method leaves. */
PetscReal dynamics_numerical(const Dynamics *d, const Balance *balance)
{
  return (balance->kinetic - d->start.kinetic) + (balance->strain - d->start.strain) - balance->external - balance->supports - balance->contact +
         balance->damping;
}

PetscErrorCode dynamics_measure(Physics *physics, PetscReal store, PetscReal friction)
{
  Dynamics *d = physics->dynamics;
  PetscReal work[4] = {0}, gained;
  RigidWork of_rigids = {0};
  PetscBool moves;
  const PetscScalar *external, *forces;
  PetscFunctionBegin;
  PetscCall(add_work(physics, work));
  PetscCall(add_damping(physics, &work[3]));
  PetscCall(VecGetArrayRead(physics->f_external, &external));
  PetscCall(VecGetArrayRead(physics->f_local, &forces));
  rigids_add_work(physics, d->dt, d->mass_damping, external, forces, &of_rigids);
  PetscCall(VecRestoreArrayRead(physics->f_local, &forces));
  PetscCall(VecRestoreArrayRead(physics->f_external, &external));
  work[0] += of_rigids.external;
  work[1] += of_rigids.supports;
  work[2] += of_rigids.contact;
  work[3] += of_rigids.damping;
  PetscCall(set_velocity(physics));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, work, 4, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  if (d->rho_inf < 1) {
    PetscCall(set_force(physics));
    PetscCall(correct_velocity(physics));
  }
  d->now = d->last;
  d->now.external += d->scale * work[0];
  d->now.supports += work[1];
  d->now.contact += work[2];
  PetscCall(massless_moves(physics, &moves));
  d->now.store    = store;
  d->now.friction = friction;
  gained          = work[2] + store - d->last.store;
  if (!moves) d->now.given += PetscMax(gained, 0);
  if (!moves) d->now.lost += PetscMax(-gained - (friction - d->last.friction), 0);
  d->now.damping += work[3];
  PetscCall(dynamics_energies(physics, physics->u_local, d->v_next, PETSC_TRUE, &d->now));
  d->now.largest = PetscMax(d->last.largest, d->now.kinetic + d->now.strain - PetscMax(dynamics_numerical(d, &d->now), 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
