/* Steps of rigid bodies: how far one of Newton's method may go, and what they take over when one in time is accepted. */
#include "physics/physics.h"

/* how far a body turns at most in a step, in radians */
static PetscErrorCode largest_turn(const Physics *physics, const PetscScalar *step, PetscReal *angle)
{
  PetscFunctionBegin;
  *angle = 0;
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid   = &physics->rigids[r];
    PetscReal    squared = 0;
    for (int i = 0; i < 3 && rigid->owned; i++)
      squared += PetscSqr(PetscRealPart(step[rigid->at[1] + i]) / rigid->length);
    *angle = PetscMax(*angle, PetscSqrtReal(squared));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, angle, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step from u_local, a local vector, whose motions the bodies have: shortened to `fraction` of it, so that no body turns by more than `most`, and given what the
 * bodies' nodes move by. */
PetscErrorCode rigids_step(Physics *physics, PetscReal most, Vec step, PetscReal *fraction)
{
  const PetscBool    refused = physics->rigid_refused;
  const PetscScalar *u, *now;
  PetscScalar       *array;
  PetscReal          angle, *kept;
  Vec                there;
  PetscFunctionBegin;
  *fraction = 1;
  if (!physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(step, &u));
  PetscCall(largest_turn(physics, u, &angle));
  PetscCall(VecRestoreArrayRead(step, &u));
  if (angle > most) *fraction = most / angle;
  PetscCall(VecScale(step, *fraction));
  PetscCall(VecDuplicate(step, &there));
  PetscCall(VecWAXPY(there, 1, physics->u_local, step));
  PetscCall(PetscMalloc1(RIGID_UNKNOWNS * physics->n_rigids, &kept));
  for (PetscInt k = 0; k < RIGID_UNKNOWNS * physics->n_rigids; k++)
    kept[k] = physics->rigids[k / RIGID_UNKNOWNS].motion[k % RIGID_UNKNOWNS];
  PetscCall(rigids_place(physics, there));
  for (PetscInt k = 0; k < RIGID_UNKNOWNS * physics->n_rigids; k++)
    physics->rigids[k / RIGID_UNKNOWNS].motion[k % RIGID_UNKNOWNS] = kept[k];
  physics->rigid_refused = refused;
  PetscCall(PetscFree(kept));
  PetscCall(VecGetArrayRead(there, &u));
  PetscCall(VecGetArrayRead(physics->u_local, &now));
  PetscCall(VecGetArray(step, &array));
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    for (PetscInt k = 0; k < 3 * rigid->n_nodes; k++) {
      const PetscInt at = rigid->dofs[k / 3] + k % 3;
      array[at]         = u[at] - now[at];
    }
  }
  PetscCall(VecRestoreArray(step, &array));
  PetscCall(VecRestoreArrayRead(physics->u_local, &now));
  PetscCall(VecRestoreArrayRead(there, &u));
  PetscCall(VecDestroy(&there));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step to `t` is accepted: the bodies take their rotation over. `last` and `before`, the states from which the next step starts, are
 * told so: what is extrapolated turns on as it has turned. */
PetscErrorCode rigids_accept(Physics *physics, PetscReal t, Vec last, Vec before)
{
  PetscInt first;
  PetscFunctionBegin;
  physics->t_turned = t;
  if (!physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetOwnershipRange(last, &first, NULL));
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    Rigid                 *rigid  = &physics->rigids[r];
    stickslip_rigid_motion motion = rigids_motion(rigid);
    const int32_t          status = stickslip_rigid_turn(&motion);
    PetscCheck(!status, PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s", stickslip_last_error_message());
    for (int k = 0; k < 9; k++)
      rigid->turned[k] = motion.turned[k];
    for (int i = 0; i < 3; i++) {
      const PetscInt equation = rigid->equations[3 + i];
      if (rigid->owned && equation >= 0) {
        PetscCall(VecSetValue(last, equation, 0, INSERT_VALUES));
        PetscCall(VecSetValue(before, equation, -rigid->length * rigid->motion[3 + i], INSERT_VALUES));
      }
      rigid->sum[i] += rigid->motion[3 + i];
      rigid->motion[3 + i] = 0;
    }
  }
  PetscCall(VecAssemblyBegin(last));
  PetscCall(VecAssemblyEnd(last));
  PetscCall(VecAssemblyBegin(before));
  PetscCall(VecAssemblyEnd(before));
  PetscFunctionReturn(PETSC_SUCCESS);
}
