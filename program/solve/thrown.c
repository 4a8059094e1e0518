/* A body that contact alone holds and that no load acts on is in equilibrium wherever nothing presses on it. So Newton's method may
 * throw it out of where it was and converge there, with all forces zero: an equilibrium, and not the one that the bodies around it
 * push it to. What tells it from a body that was let go: it has moved further than anything that could have pushed it, by more than
 * `steps: {lever}`, 2 if the scene says nothing: a wedge of 27 degrees from its axis is moved so far.
 *
 * Such an attempt counts as failed (newton.c). From a shorter step the body is followed. */
#include "solve/solve.h"

/* Bodies that an interface holds without pressure: by ties, cohesion, or friction that knows none. */
static PetscErrorCode held_without_pressure(const Solve *solve, PetscBool *held)
{
  const Contact *contact = solve->contact;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    const int32_t    friction  = interface->options.friction;
    const PetscBool  presses   = (PetscBool)((friction == STICKSLIP_FRICTION_COULOMB || friction == STICKSLIP_FRICTION_NONE) &&
                                            interface->law.kind != STICKSLIP_LAW_COHESION);
    for (PetscInt a = 0; a < interface->n1 + interface->n2 && !presses; a++)
      held[mesh_body_of(solve->mesh, interface->nodes[a])] = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, held, (PetscMPIInt)solve->mesh->n_bodies, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Parts that nothing holds, loads or presses, by the forces of the last evaluation. */
static PetscErrorCode find_idle(const Solve *solve, PetscBool *idle, PetscBool *any)
{
  const Parts *parts = &solve->physics->parts;
  PetscReal    faint = 0;
  PetscBool   *held;
  PetscFunctionBegin;
  *any = PETSC_FALSE;
  PetscCall(PetscCalloc1(solve->mesh->n_bodies, &held));
  PetscCall(held_without_pressure(solve, held));
  for (PetscInt p = 0; p < parts->n; p++)
    faint = PetscMax(faint, parts->part[p].faint);
  for (PetscInt p = 0; p < parts->n; p++) {
    const Part *part = &parts->part[p];
    idle[p] = (PetscBool)(solve->held.loose[p] && part->loads == 0 && part->reference <= PetscMax(faint, part->noise) &&
                          !held[mesh_body_of(solve->mesh, part->first)]);
    *any    = (PetscBool)(*any || idle[p]);
  }
  PetscCall(PetscFree(held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far the middle of each part has moved between two states, local vectors, and how far the points of those that are not idle,
 * or what supports move of the others. */
static PetscErrorCode motion(const Solve *solve, const PetscBool *idle, Vec from, Vec to, PetscReal *middle, PetscReal *most)
{
  const Mesh        *mesh = solve->mesh;
  const Parts       *parts = &solve->physics->parts;
  const PetscScalar *u0, *u1;
  PetscReal         *sums;
  PetscFunctionBegin;
  *most = 0;
  PetscCall(PetscCalloc1(4 * parts->n, &sums));
  PetscCall(VecGetArrayRead(from, &u0));
  PetscCall(VecGetArrayRead(to, &u1));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt p = parts->of_vertex[k], r = rigids_of_vertex(solve->physics, mesh->original[k]);
    PetscReal      d[3], squared = 0;
    PetscInt       at;
    if (solve->physics->unknowns.ghost[k]) continue;
    if (r >= 0 && mesh->original[k] == solve->physics->rigids[r].first_vertex + 1) continue; /* its turn */
    PetscCall(PetscSectionGetOffset(solve->physics->unknowns.section, mesh->points[k], &at));
    sums[4 * p + 3]++;
    for (int i = 0; i < 3; i++) {
      d[i] = PetscRealPart(u1[at + i] - u0[at + i]);
      sums[4 * p + i] += d[i];
      /* an idle part's own supports may move it, too */
      if (!idle[p] || entry_held(solve->physics, at + i)) squared += d[i] * d[i];
    }
    *most = PetscMax(*most, PetscSqrtReal(squared));
  }
  PetscCall(VecRestoreArrayRead(to, &u1));
  PetscCall(VecRestoreArrayRead(from, &u0));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, (PetscMPIInt)(4 * parts->n), MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  for (PetscInt p = 0; p < parts->n; p++)
    middle[p] = PetscSqrtReal(PetscSqr(sums[4 * p]) + PetscSqr(sums[4 * p + 1]) + PetscSqr(sums[4 * p + 2])) /
                PetscMax(sums[4 * p + 3], 1);
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has the step from `last`, at t0, thrown a part out to x, where it was evaluated last? Then why it does not count. */
PetscErrorCode thrown_check(Solve *solve, Vec last, PetscReal t0, Vec x, PetscBool *thrown, char why[], size_t length)
{
  Physics   *physics = solve->physics;
  PetscBool *idle, any = PETSC_FALSE;
  PetscReal *middle, most;
  Vec        from;

  PetscFunctionBegin;
  *thrown = PETSC_FALSE;
  for (PetscInt p = 0; p < physics->parts.n; p++)
    any = (PetscBool)(any || solve->held.loose[p]);
  if (!any || !solve->contact->n_interfaces) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(physics->parts.n, &idle, physics->parts.n, &middle));
  PetscCall(find_idle(solve, idle, &any));
  if (any) {
    PetscCall(VecDuplicate(physics->u_local, &from));
    PetscCall(supports_values(physics, t0));
    PetscCall(unknowns_to_local(physics, last));
    PetscCall(VecCopy(physics->u_local, from));
    PetscCall(supports_values(physics, physics->t));
    PetscCall(unknowns_to_local(physics, x));
    PetscCall(motion(solve, idle, from, physics->u_local, middle, &most));
    PetscCall(VecDestroy(&from));
  }
  for (PetscInt p = 0; p < physics->parts.n && any && !*thrown; p++) {
    if (!idle[p] || !(middle[p] > solve->steps.lever * most)) continue;
    *thrown = PETSC_TRUE;
    PetscCall(PetscSNPrintf(why, length,
                            "%s, which nothing loads and contact alone holds, would be moved by %.3g, where nothing presses on it, "
                            "while all else moves by %.3g at most. That is an equilibrium, as any place is where nothing touches it. "
                            "Take shorter steps, so that its contact is kept, or hold it. If it is a slim wedge that is pressed out, as far "
                            "as that in any step, `steps: {lever}` says how many times as far it may go (it is %g)",
                            solve->mesh->bodies[mesh_body_of(solve->mesh, physics->parts.part[p].first)].name, (double)middle[p],
                            (double)most, (double)solve->steps.lever));
  }
  PetscCall(PetscFree2(idle, middle));
  PetscFunctionReturn(PETSC_SUCCESS);
}
