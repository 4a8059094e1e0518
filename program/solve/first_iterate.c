/* Newton's first iterate: extrapolated from the last two states, or the last state with the supports already moved.
 *
 * The second one serves where nothing can be extrapolated (the first step, and the one after a kink of a curve), and
 * where full steps have failed from the first one (newton.c). A body of finite strain whose cells are smaller than that
 * motion would be turned inside out at its supports. So there the motion of the supports is continued into the bodies
 * of finite strain: by linear elasticity on their undeformed cells, without contact. A prescribed translation moves a
 * whole body, a prescribed linear field strains it homogeneously, and a body without a prescribed motion stays.
 *
 * With `dynamics` what turns is extrapolated along arcs (turned_on.c). Where normals follow the motion and supports turn a part as a whole, it is turned with them first (turned_start.c).
 *
 * This chooses where Newton's method starts, not what it solves. */
#include "solve/solve.h"
#include "solve/direct.h"

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

static PetscErrorCode solve_linear(Mat matrix, Vec b, Vec x)
{
  KSP ksp;
  PetscFunctionBegin;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)matrix), &ksp));
  PetscCall(KSPSetOptionsPrefix(ksp, "first_"));
  PetscCall(KSPSetOperators(ksp, matrix, matrix));
  PetscCall(direct_set(ksp));
  PetscCall(KSPSetFromOptions(ksp));
  PetscCall(KSPSolve(ksp, b, x));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is left to move: the prescribed displacements of `solve->physics->t` less those of u, zero elsewhere. u: local, of x at
 * t0, its parts turned where supports turn them. False if nothing is left. */
static PetscErrorCode prescribed_increments(Solve *solve, PetscReal t0, Vec x, Vec increments, PetscBool *moves)
{
  Physics           *physics = solve->physics;
  PetscBool          turned;
  PetscReal          largest;
  PetscScalar       *left;
  const PetscScalar *p;
  Vec                u;
  PetscFunctionBegin;
  PetscCall(VecDuplicate(physics->u_local, &u));
  PetscCall(supports_values(physics, t0));
  PetscCall(unknowns_to_local(physics, x));
  PetscCall(VecCopy(physics->u_local, u));
  PetscCall(supports_values(physics, physics->t));
  PetscCall(turn_parts(solve, t0, u, &turned));
  if (turned) {
    PetscCall(DMLocalToGlobalBegin(solve->mesh->dm, u, INSERT_VALUES, x));
    PetscCall(DMLocalToGlobalEnd(solve->mesh->dm, u, INSERT_VALUES, x));
  }
  PetscCall(VecCopy(u, increments));
  PetscCall(VecGetArray(increments, &left));
  PetscCall(VecGetArrayRead(physics->prescribed_local, &p));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    left[k] = entry_held(physics, k) ? p[k] - left[k] : 0;
  for (PetscInt r = 0; r < physics->n_rigids; r++) { /* nodes that follow their body's unknowns */
    for (PetscInt k = 0; k < 3 * physics->rigids[r].n_nodes; k++)
      left[physics->rigids[r].dofs[k / 3] + k % 3] = 0;
  }
  PetscCall(VecRestoreArrayRead(physics->prescribed_local, &p));
  PetscCall(VecRestoreArray(increments, &left));
  PetscCall(VecDestroy(&u));
  PetscCall(VecNorm(increments, NORM_INFINITY, &largest));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  *moves = (PetscBool)(largest > 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves x with the supports from their positions at t0 to those at physics->t. */
static PetscErrorCode move_supports(Solve *solve, PetscReal t0, Vec x)
{
  const Mesh *mesh    = solve->mesh;
  Physics    *physics = solve->physics;
  PetscBool   finite  = PETSC_FALSE, moves;
  Vec         increments, local, b, dx;
  Mat         matrix;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < mesh->n_bodies; k++)
    finite = (PetscBool)(finite || physics->materials[k].law->finite);
  if (!finite) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(physics->u_local, &increments));
  PetscCall(prescribed_increments(solve, t0, x, increments, &moves));
  if (moves) {
    PetscCall(VecDuplicate(physics->u_local, &local));
    PetscCall(VecDuplicate(x, &b));
    PetscCall(VecDuplicate(x, &dx));
    PetscCall(MatDuplicate(solve->jacobian, MAT_DO_NOT_COPY_VALUES, &matrix));
    PetscCall(VecZeroEntries(local));
    PetscCall(bulk_extension(physics, increments, local, matrix));
    PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    PetscCall(make_regular(matrix, dx));
    PetscCall(VecZeroEntries(b));
    PetscCall(DMLocalToGlobalBegin(mesh->dm, local, ADD_VALUES, b));
    PetscCall(DMLocalToGlobalEnd(mesh->dm, local, ADD_VALUES, b));
    PetscCall(timed_rows(physics, solve->stiffness, matrix));
    PetscCall(solve_linear(matrix, b, dx));
    PetscCall(VecAXPY(x, -1, dx));
    PetscCall(MatDestroy(&matrix));
    PetscCall(VecDestroy(&dx));
    PetscCall(VecDestroy(&b));
    PetscCall(VecDestroy(&local));
  }
  PetscCall(VecDestroy(&increments));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool first_iterate_extrapolates(const Solve *solve, const Past *past)
{
  return (PetscBool)(solve->steps.predictor && past->have_before);
}

PetscErrorCode first_iterate(Solve *solve, const Past *past, PetscBool extrapolate, Vec x)
{
  const PetscReal factor = extrapolate ? (solve->physics->t - past->t_last) / (past->t_last - past->t_before) : 0;
  PetscFunctionBegin;
  PetscCall(VecCopy(past->last, x));
  if (extrapolate) {
    PetscCall(VecAXPY(x, factor, past->last));
    PetscCall(VecAXPY(x, -factor, past->before));
    PetscCall(turn_on(solve, past, factor, x));
  } else {
    PetscCall(move_supports(solve, past->t_last, x));
  }
  PetscCall(timed_place(solve->physics, x));
  condensed_predict(solve->contact, factor);
  /* What is extrapolated turns as it has turned. */
  if (!extrapolate) PetscCall(normals_turn_multipliers(solve->contact, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
