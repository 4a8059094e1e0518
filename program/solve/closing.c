/* Bodies that contact alone holds and that do not touch yet, or in a point: they must be closed by force.
 *
 * As long as no node is in contact, Newton's matrix has no stiffness for their rigid motion: its step is the load over
 * rounding, and surfaces pass through each other. One attempt at a step (newton.c) is made for them, in which
 *   1. every displacement's diagonal entry K_ii of the tangent gains e |K_ii|. The residual has no such term, so that what
 *      converges is a solution of the problem as it is. While a body is loose, see below, e is large, and smaller
 *      after each step that meets nothing, so that the next one is longer. Afterwards it is in proportion to the residual: the first
 *      nodes that touch leave turns and slides free, and a step along them would be as long as rounding makes it;
 *   2. each step is cut to the fraction that stickslip_interface_step_limit() allows: what closes ends in a slight
 *      penetration, from which the next iteration knows that it touches.
 *
 * A body is loose if the supports leave it free to move, no tie and no node in contact joins it, through others or
 * not, to one that they hold, and there is a surface that it could come to touch. */
#include "solve/solve.h"

/* e while a body is loose, how it shrinks, to what, and the least otherwise: a direction of motion that is not made of rounding, and
 * hardly any change of the step. From 1e-13 to 1e-4 all scenes converge, at 1e-2 they do not. */
static const PetscReal LOOSE = 1e-6, SHRINKAGE = 1e-2, LEAST = 1e-10, HELD = 1e-13;
/* In proportion to the residual, where bodies have been laid down: they touch at a few nodes each, which leave them to roll and swing as Newton's
 * method likes. A pin's clearance is a small part of what the loads would roll it by with less; with a hundred times as much it crawls. */
static const PetscReal LAID = 1e-4;
/* How deep a step may lead into contact, over a facet's edge, and by what factor less once a body that touched is loose
 * again: under a small force such a penetration throws it back. */
static const PetscReal DEPTH = 0.1, SHALLOWER = 0.1;
/* Uncut steps that must follow the last one that was cut: the first one may end just below the tolerance, for its start
 * was bad; the next one shows. */
enum { SETTLED = 2 };
/* Uncut steps as long as this many times the model lead away from all that the body could touch. */
static const PetscReal FAR = 10;
/* How far a rigid body may turn in one step, in radians: what it meets is looked for along straight ways. */
static const PetscReal TURN = 0.2;

void closing_find(Solve *solve)
{
  Closing  *closing = &solve->closing;
  PetscBool any     = PETSC_FALSE;
  for (PetscInt b = 0; b < solve->mesh->n_bodies; b++) {
    closing->free[b] = held_free(solve, b);
    any              = (PetscBool)(any || closing->free[b]);
  }
  closing->possible = (PetscBool)(any && solve->contact->n_interfaces && solve->steps.closing);
}

PetscErrorCode closing_create(Solve *solve)
{
  const Mesh  *mesh    = solve->mesh;
  Closing     *closing = &solve->closing;
  PetscScalar *ones;
  Vec          local;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(mesh->n_bodies, &closing->free, mesh->n_bodies, &closing->group));
  closing_find(solve);
  PetscCall(DMCreateGlobalVector(mesh->dm, &closing->displacements));
  PetscCall(VecDuplicate(closing->displacements, &closing->work));
  PetscCall(DMCreateLocalVector(mesh->dm, &local));
  PetscCall(VecZeroEntries(local));
  PetscCall(VecGetArray(local, &ones));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscInt at;
    PetscCall(PetscSectionGetOffset(solve->physics->unknowns.section, mesh->points[k], &at));
    ones[at] = ones[at + 1] = ones[at + 2] = 1;
  }
  PetscCall(VecRestoreArray(local, &ones));
  PetscCall(DMLocalToGlobalBegin(mesh->dm, local, INSERT_VALUES, closing->displacements));
  PetscCall(DMLocalToGlobalEnd(mesh->dm, local, INSERT_VALUES, closing->displacements));
  PetscCall(VecDestroy(&local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode closing_destroy(Solve *solve)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(solve->closing.free, solve->closing.group));
  PetscCall(VecDestroy(&solve->closing.displacements));
  PetscCall(VecDestroy(&solve->closing.work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void join(Closing *closing, PetscInt n, PetscInt a, PetscInt b)
{
  const PetscInt from = closing->group[a], to = closing->group[b];
  for (PetscInt k = 0; k < n; k++) {
    if (closing->group[k] == from) closing->group[k] = to;
  }
}

/* A body that is loose, given which bodies are joined, or -1. */
static PetscInt find_loose(Solve *solve, PetscInt n_joints, const Joint joints[])
{
  Closing       *closing = &solve->closing;
  const PetscInt n       = solve->mesh->n_bodies;

  for (PetscInt b = 0; b < n; b++)
    closing->group[b] = b;
  for (PetscInt k = 0; k < n_joints; k++) {
    if (joints[k].joined) join(closing, n, joints[k].bodies[0], joints[k].bodies[1]);
  }
  for (PetscInt k = 0; k < n_joints; k++) {
    const PetscInt one = joints[k].bodies[0], two = joints[k].bodies[1];
    if (closing->group[one] == closing->group[two]) continue;
    for (int side = 0; side < 2; side++) {
      const PetscInt body = side ? two : one;
      PetscBool      held = PETSC_FALSE;
      for (PetscInt b = 0; b < n; b++)
        held = (PetscBool)(held || (closing->group[b] == closing->group[body] && !closing->free[b]));
      if (!held) return body;
    }
  }
  return -1;
}

/* A body that is loose at u_local, known to every rank, or -1. */
static PetscErrorCode loose_body(Solve *solve, PetscInt *body)
{
  Contact   *contact = solve->contact;
  int32_t   *states;
  double    *tangential;
  Joint     *joints;
  PetscInt   n = 0, n_joints;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    n += contact->interfaces[i].n1;
  PetscCall(PetscMalloc2(n, &states, 3 * n, &tangential));
  PetscCall(contact_tendencies(contact, states, tangential));
  PetscCall(contact_joints(contact, states, &n_joints, &joints));
  *body = find_loose(solve, n_joints, joints);
  PetscCall(PetscFree(joints));
  PetscCall(PetscFree2(states, tangential));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is there a body, at the start of a step, that only this attempt can move into contact? Evaluates the residual there. */
PetscErrorCode closing_needed(Solve *solve, Vec start, PetscBool *needed)
{
  Physics *physics = solve->physics;
  PetscInt status, body = -1;
  PetscFunctionBegin;
  *needed = PETSC_FALSE;
  if (!solve->closing.possible) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(unknowns_to_local(physics, start));
  PetscCall(VecZeroEntries(physics->f_local));
  PetscCall(contact_forces(solve->contact, physics->f_local, &status)); /* does the library take these positions? */
  if (!status) PetscCall(loose_body(solve, &body));
  solve->contact->refusal[0] = 0;
  *needed           = (PetscBool)(body >= 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void closing_begin(Solve *solve, PetscBool active)
{
  Closing *closing = &solve->closing;
  closing->active  = active;
  closing->cut = closing->ever_cut = PETSC_FALSE;
  closing->shift                   = LOOSE;
  closing->depth                   = DEPTH;
  closing->touched = closing->met  = PETSC_FALSE;
  closing->travelled               = 0;
  closing->n_uncut                 = 0;
  closing->loose                   = -1;
  closing->away[0]                 = 0;
}

/* May an iterate that looks converged be taken? */
PetscBool closing_settled(const Solve *solve)
{
  const Closing *closing = &solve->closing;
  return (PetscBool)(!closing->active || !closing->ever_cut || closing->n_uncut >= SETTLED);
}

/* Rigid bodies that touch nothing have no stiffness at all: the model's, where theirs is smaller. */
static PetscErrorCode add_rigid_stiffness(const Solve *solve, Vec diagonal)
{
  PetscScalar *d;
  PetscInt     first;
  PetscFunctionBegin;
  if (!solve->physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetOwnershipRange(diagonal, &first, NULL));
  PetscCall(VecGetArray(diagonal, &d));
  for (PetscInt r = 0; r < solve->physics->n_rigids; r++) {
    const Rigid *rigid = &solve->physics->rigids[r];
    for (int k = 0; k < RIGID_UNKNOWNS && rigid->owned; k++) {
      if (rigid->equations[k] < 0) continue;
      d[rigid->equations[k] - first] = PetscMax(PetscRealPart(d[rigid->equations[k] - first]), solve->stiffness);
    }
  }
  PetscCall(VecRestoreArray(diagonal, &d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* e while no body is loose, at the residual of now. */
static PetscErrorCode held_shift(Solve *solve, PetscReal *shift)
{
  Closing  *closing = &solve->closing;
  PetscInt  iteration;
  PetscReal now;
  Vec       residual;
  PetscFunctionBegin;
  PetscCall(SNESGetFunction(solve->snes, &residual, NULL, NULL));
  PetscCall(VecNorm(residual, NORM_2, &now));
  PetscCall(SNESGetIterationNumber(solve->snes, &iteration));
  if (!iteration) closing->pressing = now;
  *shift = solve->newton.laid ? LAID : LOOSE;
  if (now < closing->pressing) *shift = PetscMax(HELD, *shift * now / closing->pressing);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After the tangent at u_local is assembled. */
PetscErrorCode closing_shift(Solve *solve, Mat matrix)
{
  Closing  *closing  = &solve->closing;
  const Vec diagonal = closing->work;
  PetscReal held = HELD;
  PetscFunctionBegin;
  if (!closing->active) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(held_shift(solve, &held));
  PetscCall(loose_body(solve, &closing->loose));
  if (closing->loose >= 0 && closing->touched) {
    closing->depth *= SHALLOWER;
    closing->shift = LOOSE;
  }
  closing->touched = (PetscBool)(closing->loose < 0);
  closing->met     = (PetscBool)(closing->met || closing->touched);
  PetscCall(MatGetDiagonal(matrix, diagonal));
  PetscCall(VecAbs(diagonal));
  PetscCall(VecPointwiseMult(diagonal, diagonal, closing->displacements));
  PetscCall(add_rigid_stiffness(solve, diagonal));
  PetscCall(VecScale(diagonal, closing->loose >= 0 ? closing->shift : held));
  PetscCall(MatDiagonalSet(matrix, diagonal, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "the ball moves along (0, 0, 1) and meets nothing" */
static PetscErrorCode describe_motion(Solve *solve, PetscInt body, Vec step)
{
  const Mesh        *mesh    = solve->mesh;
  Closing           *closing = &solve->closing;
  const PetscScalar *array;
  const Body        *moving  = &mesh->bodies[body];
  PetscReal          mean[3] = {0, 0, 0}, size;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(step, &array));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt vertex = mesh->original[k];
    PetscInt       at;
    if (solve->physics->unknowns.ghost[k] || vertex < moving->first_vertex || vertex >= moving->end_vertex) continue;
    if (moving->rigid && vertex == moving->first_vertex + 1) continue; /* its turn */
    PetscCall(PetscSectionGetOffset(solve->physics->unknowns.section, mesh->points[k], &at));
    for (int i = 0; i < 3; i++)
      mean[i] += PetscRealPart(array[at + i]);
  }
  PetscCall(VecRestoreArrayRead(step, &array));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mean, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  size = PetscSqrtReal(PetscSqr(mean[0]) + PetscSqr(mean[1]) + PetscSqr(mean[2]));
  for (int i = 0; i < 3; i++)
    mean[i] = PetscAbsReal(mean[i]) < 5e-4 * size ? 0 : mean[i]; /* no minus before what is told as 0 */
  PetscCall(PetscSNPrintf(closing->away, sizeof(closing->away),
                          "%s %s: the loads move it along (%.3f, %.3f, %.3f), and nothing is in its way%s",
                          closing->met ? "Newton's method has lost the contact of" : "nothing touches", mesh->bodies[body].name,
                          (double)(mean[0] / size), (double)(mean[1] / size), (double)(mean[2] / size), closing->met ? " there" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SNES calls it with Newton's direction y, before x - y is looked at. */
static PetscErrorCode limit(SNESLineSearch line_search, Vec x, Vec y, PetscBool *changed, void *context)
{
  Solve    *solve    = context;
  Closing  *closing  = &solve->closing;
  PetscReal fraction = 1, one, length, turned;
  Vec       step;

  PetscFunctionBegin;
  (void)line_search;
  *changed = PETSC_FALSE;
  if (!closing->active) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(unknowns_to_local(solve->physics, x));
  PetscCall(VecDuplicate(solve->physics->u_local, &step));
  PetscCall(VecZeroEntries(step)); /* what is prescribed stays where it is */
  PetscCall(DMGlobalToLocalBegin(solve->mesh->dm, y, INSERT_VALUES, step));
  PetscCall(DMGlobalToLocalEnd(solve->mesh->dm, y, INSERT_VALUES, step));
  PetscCall(VecScale(step, -1));
  PetscCall(rigids_step(solve->physics, TURN, step, &turned));
  if (turned < 1) PetscCall(VecScale(y, turned));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++) {
    PetscCall(contact_step_limit(solve->contact, i, step, closing->depth, &one));
    fraction = PetscMin(fraction, one);
  }
  closing->cut = (PetscBool)(fraction < 1 || turned < 1);
  closing->n_uncut++;
  if (closing->cut) {
    closing->ever_cut = *changed = PETSC_TRUE;
    closing->travelled           = 0;
    closing->n_uncut             = 0;
    PetscCall(VecScale(y, fraction));
  } else if (closing->loose >= 0) {
    closing->shift = PetscMax(LEAST, SHRINKAGE * closing->shift);
    PetscCall(VecPointwiseMult(closing->work, y, closing->displacements));
    PetscCall(VecNorm(closing->work, NORM_INFINITY, &length));
    closing->travelled += length;
    if (closing->travelled > FAR * solve->size) PetscCall(describe_motion(solve, closing->loose, step));
  }
  PetscCall(VecDestroy(&step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode closing_limit_steps(Solve *solve, SNESLineSearch line_search)
{
  PetscFunctionBegin;
  PetscCall(SNESLineSearchSetPreCheck(line_search, limit, solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}
