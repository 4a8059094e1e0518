/* Newton's first iterate where supports turn a part of the model as a whole and normals follow the motion: the part is turned
 * with its supports. Linear elasticity cannot continue a finite turn into a body (first_iterate.c): it would strain it. From a
 * strained surface a step that turns it by tens of degrees folds facets in its first iteration.
 *
 * This chooses where Newton's method starts, not what it solves. */
#include "solve/solve.h"

/* A part is turned as a whole where this of the largest prescribed motion, at most, is left when it has been turned: rounding. */
static const PetscReal RIGID = 1e-8;

/* u after its part's turn, in the local vector `after`; what then is left at prescribed entries, and what there was. */
static PetscErrorCode turn_all(const Physics *physics, PetscReal t0, const PetscInt support_of[], Vec before, Vec after,
                               PetscReal left[], PetscReal all[])
{
  const Cells       *cells = &physics->cells;
  const PetscScalar *u, *p;
  PetscScalar       *v;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(before, &u));
  PetscCall(VecGetArrayRead(physics->prescribed_local, &p));
  PetscCall(VecGetArray(after, &v));
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt part = cells->part[c];
    if (support_of[part] < 0 || physics->mesh->bodies[cells->body[c]].rigid) continue; /* a rigid body has its own turns */
    for (PetscInt k = cells->offsets[c]; k < cells->offsets[c + 1]; k++) {
      const PetscInt dof = cells->dofs[k];
      PetscReal      x[3];
      for (int i = 0; i < 3; i++)
        x[i] = cells->X[3 * k + i] + PetscRealPart(u[dof + i]);
      supports_turn(&physics->supports[support_of[part]], t0, physics->t, x);
      for (int i = 0; i < 3; i++) {
        v[dof + i] = x[i] - cells->X[3 * k + i];
        if (!entry_held(physics, dof + i)) continue;
        left[part] = PetscMax(left[part], PetscAbsScalar(p[dof + i] - v[dof + i]));
        all[part]  = PetscMax(all[part], PetscAbsScalar(p[dof + i] - u[dof + i]));
      }
    }
  }
  PetscCall(VecRestoreArray(after, &v));
  PetscCall(VecRestoreArrayRead(physics->prescribed_local, &p));
  PetscCall(VecRestoreArrayRead(before, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Puts `after` in place of `u` in the parts that are turned as a whole. */
static PetscErrorCode take(const Physics *physics, const PetscInt support_of[], Vec after, Vec u)
{
  const Cells       *cells = &physics->cells;
  const PetscScalar *from;
  PetscScalar       *to;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(after, &from));
  PetscCall(VecGetArray(u, &to));
  for (PetscInt c = 0; c < cells->n; c++) {
    if (support_of[cells->part[c]] < 0 || physics->mesh->bodies[cells->body[c]].rigid) continue;
    for (PetscInt k = cells->offsets[c]; k < cells->offsets[c + 1]; k++)
      PetscCall(PetscArraycpy(to + cells->dofs[k], from + cells->dofs[k], 3));
  }
  PetscCall(VecRestoreArray(u, &to));
  PetscCall(VecRestoreArrayRead(after, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where one support alone turns anything, parts that no support turns go with it, unless their own supports are against it
 * (below): a body that contact alone holds would be left behind, and from half a turn behind it may be found to stick. */
static void join_free_parts(const Physics *physics, PetscInt support_of[])
{
  PetscInt turning = -1;
  for (PetscInt p = 0; p < physics->parts.n; p++) {
    if (support_of[p] >= 0 && turning >= 0 && support_of[p] != turning) return;
    turning = PetscMax(turning, support_of[p]);
  }
  for (PetscInt p = 0; p < physics->parts.n; p++)
    support_of[p] = turning;
}

/* `u`: local, of x with its prescribed values of t0; those of physics->t are in prescribed_local. */
PetscErrorCode turn_parts(Solve *solve, PetscReal t0, Vec u, PetscBool *turned)
{
  Physics  *physics = solve->physics;
  PetscInt  n = physics->parts.n, *support_of;
  PetscReal *left, *all, most = 0;
  Vec       after;

  PetscFunctionBegin;
  *turned = PETSC_FALSE;
  if (!normals_follow(solve->contact) || solve->mesh->rotated) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc3(n, &support_of, n, &left, n, &all));
  PetscCall(supports_turning(physics, support_of));
  join_free_parts(physics, support_of);
  PetscCall(VecDuplicate(u, &after));
  PetscCall(turn_all(physics, t0, support_of, u, after, left, all));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, left, (PetscMPIInt)n, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, (PetscMPIInt)n, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  for (PetscInt p = 0; p < n; p++)
    most = PetscMax(most, all[p]);
  for (PetscInt p = 0; p < n; p++) {
    if (support_of[p] >= 0 && !(left[p] <= RIGID * most && most > 0)) support_of[p] = -1;
    *turned = (PetscBool)(*turned || support_of[p] >= 0);
  }
  if (*turned) PetscCall(take(physics, support_of, after, u));
  PetscCall(VecDestroy(&after));
  PetscCall(PetscFree3(support_of, left, all));
  PetscFunctionReturn(PETSC_SUCCESS);
}
