/* Where nothing can be extrapolated (the first step, and the one after a kink of a curve), Newton's first iterate is
 * the last state with the supports already moved. A body of finite strain whose cells are smaller than that motion
 * would be turned inside out at its supports. So there the motion of the supports is carried into the bodies of finite
 * strain: by linear elasticity on their undeformed cells, without contact. A prescribed translation moves a whole body,
 * a prescribed linear field strains it homogeneously, and a body without a prescribed motion stays.
 *
 * This chooses where Newton's method starts, not what it solves. */
#include "model.h"

/* Rows without stiffness (multipliers, linear bodies) say zero; the rest gain this much of the largest diagonal entry,
 * for rigid motions that no support prevents. They get no load: the matrix need only be regular. */
static const PetscReal SHIFT = 1e-10;

static PetscErrorCode make_regular(Mat matrix, Vec diagonal)
{
  PetscScalar *d;
  PetscReal    largest;
  PetscInt     n;
  PetscFunctionBegin;
  PetscCall(MatGetDiagonal(matrix, diagonal));
  PetscCall(VecMax(diagonal, NULL, &largest));
  PetscCall(VecGetLocalSize(diagonal, &n));
  PetscCall(VecGetArray(diagonal, &d));
  for (PetscInt k = 0; k < n; k++)
    d[k] += d[k] == 0 ? largest : SHIFT * largest;
  PetscCall(VecRestoreArray(diagonal, &d));
  PetscCall(MatDiagonalSet(matrix, diagonal, INSERT_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode solve(Mat matrix, Vec b, Vec x)
{
  KSP ksp;
  PC  pc;
  PetscFunctionBegin;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)matrix), &ksp));
  PetscCall(KSPSetOptionsPrefix(ksp, "carry_"));
  PetscCall(KSPSetOperators(ksp, matrix, matrix));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSetFromOptions(ksp));
  PetscCall(KSPSolve(ksp, b, x));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The prescribed displacements of `model->t` less those of t0, zero elsewhere; false if nothing moves. */
static PetscErrorCode prescribed_increments(Model *model, PetscReal t0, Vec increments, PetscBool *moves)
{
  PetscReal largest;
  PetscFunctionBegin;
  PetscCall(supports_values(model, t0));
  PetscCall(VecCopy(model->prescribed_local, increments));
  PetscCall(supports_values(model, model->t));
  PetscCall(VecAYPX(increments, -1, model->prescribed_local));
  PetscCall(VecNorm(increments, NORM_INFINITY, &largest));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  *moves = (PetscBool)(largest > 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode carry_supports(Model *model, PetscReal t0, Vec x)
{
  PetscBool finite = PETSC_FALSE, moves;
  Vec       increments, local, b, dx;
  Mat       matrix;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < model->mesh.n_bodies; k++)
    finite = (PetscBool)(finite || model->mesh.bodies[k].material.law->finite);
  if (!finite) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(model->u_local, &increments));
  PetscCall(prescribed_increments(model, t0, increments, &moves));
  if (moves) {
    PetscCall(VecDuplicate(model->u_local, &local));
    PetscCall(VecDuplicate(x, &b));
    PetscCall(VecDuplicate(x, &dx));
    PetscCall(MatDuplicate(model->jacobian, MAT_DO_NOT_COPY_VALUES, &matrix));
    PetscCall(VecZeroEntries(local));
    PetscCall(bulk_extension(model, increments, local, matrix));
    PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    PetscCall(make_regular(matrix, dx));
    PetscCall(VecZeroEntries(b));
    PetscCall(DMLocalToGlobalBegin(model->dm, local, ADD_VALUES, b));
    PetscCall(DMLocalToGlobalEnd(model->dm, local, ADD_VALUES, b));
    PetscCall(solve(matrix, b, dx));
    PetscCall(VecAXPY(x, -1, dx));
    PetscCall(MatDestroy(&matrix));
    PetscCall(VecDestroy(&dx));
    PetscCall(VecDestroy(&b));
    PetscCall(VecDestroy(&local));
  }
  PetscCall(VecDestroy(&increments));
  PetscFunctionReturn(PETSC_SUCCESS);
}
