/* The front of a fluid between the surfaces of interfaces.
 *
 * It comes from the load's own surface and goes from face to face on either side of an interface. A face lets it in if it is at one of its corners
 * already, and if at none of them more presses than the fluid does, surfaces and fluid together: they are open there, or the fluid forces itself
 * between them. Then it presses the whole face, as a pressure that follows its surface. The front stays while Newton's method works, so that the tangent is
 * that of such pressures. At a converged state the fluid goes anew from its source (fluid_advance), and the step is solved again until its front stays:
 * the first time in a step it may go back, then it goes on only. What the two sides know of the pressure between them differs by their meshes. So a face that
 * the fluid has come to and that stays closed at all of its corners is shut for the rest of the step: the other side may keep the fluid out. */
#include "physics/fluid.h"

/* Of the largest pressure of contact: less is an open place's rounding. */
static const PetscReal ROUNDING = 1e-10;
/* By so much of the fluid's pressure surfaces may press each other where it is, and it stays, as long as its pressure does not fall: beside the front they
 * often do a little, and a front that goes back for that comes to rest elsewhere. A pressure that falls is followed at once. */
static const PetscReal HOLDS = 0.5;
/* A face that is under the fluid and presses by more than this part of it at all of its corners has not been opened. */
static const PetscReal SHUT = 0.3;

/* From its source, in `flags`, over the faces that let it in: `most` is what it forces itself against, `stays` against what it stays where it is. */
static PetscErrorCode flood(Physics *physics, const Fluid *fluid, Vec pressure, PetscReal most, PetscReal stays, Vec flags)
{
  const PetscScalar *p, *now;
  PetscScalar       *at;
  PetscInt           more = 1;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayRead(fluid->reached, &now));
  while (more) {
    more = 0;
    PetscCall(VecGetArray(flags, &at));
    for (PetscInt k = 0; k < fluid->n_faces; k++) {
      Face      face;
      if (fluid->shut[k]) continue;
      PetscBool next = PETSC_FALSE, lets = PETSC_TRUE, all = PETSC_TRUE;
      PetscCall(face_look_at(physics, fluid->faces[k], &face));
      for (PetscInt a = 0; a < cell_corners(face.kind); a++) {
        const PetscScalar *flag = at + face.dofs[a];
        const PetscBool    reached = (PetscBool)(PetscRealPart(flag[FLUID_REACHED]) > 0);
        const PetscReal    against = PetscRealPart(now[face.dofs[a] + FLUID_REACHED]) > 0 ? stays : most;
        next = (PetscBool)(next || reached || PetscRealPart(flag[FLUID_SOURCE]) > 0);
        lets = (PetscBool)(lets && PetscRealPart(p[face.dofs[a]]) <= against);
        all  = (PetscBool)(all && reached);
      }
      if (!next || !lets || all) continue;
      for (PetscInt a = 0; a < cell_corners(face.kind); a++)
        at[face.dofs[a] + FLUID_REACHED] = 1;
      more = 1;
    }
    PetscCall(VecRestoreArray(flags, &at));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &more, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
    if (more) PetscCall(fluid_share_flags(physics, flags));
  }
  PetscCall(VecRestoreArrayRead(fluid->reached, &now));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* only where it came from */
static PetscErrorCode dry(const Physics *physics, Vec flags)
{
  PetscScalar *at;
  PetscFunctionBegin;
  PetscCall(VecGetArray(flags, &at));
  for (PetscInt k = 0; k < physics->mesh->n_points; k++) {
    PetscInt offset;
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, physics->mesh->points[k], &offset));
    at[offset + FLUID_REACHED] = 0;
  }
  PetscCall(VecRestoreArray(flags, &at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* To the forces of contact those of the fluid between the surfaces, in the residual's sign. */
static PetscErrorCode add_fluid(Physics *physics, const Load *load, PetscReal pressure, Vec forces)
{
  const Fluid       *fluid = load->fluid;
  const PetscScalar *flags, *u;
  PetscScalar       *to;
  Vec                own;
  PetscFunctionBegin;
  PetscCall(VecDuplicate(forces, &own));
  PetscCall(VecZeroEntries(own));
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  PetscCall(VecGetArrayRead(fluid->reached, &flags));
  PetscCall(VecGetArray(own, &to));
  for (PetscInt k = 0; k < fluid->n_faces; k++) {
    Face      face;
    PetscReal areas[3 * FACE_NODES];
    PetscCall(fluid_face(physics, fluid->faces[k], u, &face, areas));
    for (PetscInt j = 0; j < 3 * face.n && (fluid->named[k] || fluid_presses(load, k, &face, flags)); j++)
      to[face.dofs[j / 3] + j % 3] += pressure * areas[j];
  }
  PetscCall(VecRestoreArray(own, &to));
  PetscCall(VecRestoreArrayRead(fluid->reached, &flags));
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCall(unknowns_share(physics, own));
  PetscCall(VecAXPY(forces, 1, own));
  PetscCall(VecDestroy(&own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where it would come to anew, also where that is less than it is, if it is the first time in the step; else what there is more. */
static PetscErrorCode take(const Physics *physics, Fluid *fluid, Vec anew, PetscBool first, PetscBool *any)
{
  const PetscScalar *there;
  PetscScalar       *at;
  PetscFunctionBegin;
  *any = PETSC_FALSE;
  PetscCall(VecGetArrayRead(anew, &there));
  PetscCall(VecGetArray(fluid->reached, &at));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++) {
    const PetscBool differs = (PetscBool)(PetscRealPart(there[k]) > PetscRealPart(at[k]) || (first && PetscRealPart(there[k]) < PetscRealPart(at[k])));
    if (differs) at[k] = there[k];
    *any = (PetscBool)(*any || differs);
  }
  PetscCall(VecRestoreArray(fluid->reached, &at));
  PetscCall(VecRestoreArrayRead(anew, &there));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Shuts faces under the fluid that contact keeps closed; were there any? */
static PetscErrorCode shut(Physics *physics, const Load *load, PetscReal now, Vec contact, Vec pressure, PetscBool *any)
{
  Fluid             *fluid = load->fluid;
  const PetscScalar *p, *flags;
  PetscFunctionBegin;
  *any = PETSC_FALSE;
  PetscCall(fluid_pressures(physics, fluid, contact, pressure));
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayRead(fluid->reached, &flags));
  for (PetscInt k = 0; k < fluid->n_faces; k++) {
    Face      face;
    PetscBool closed = PETSC_TRUE;
    PetscCall(face_look_at(physics, fluid->faces[k], &face));
    if (!fluid_presses(load, k, &face, flags)) continue;
    for (PetscInt a = 0; a < cell_corners(face.kind); a++)
      closed = (PetscBool)(closed && PetscRealPart(p[face.dofs[a]]) > SHUT * now);
    if (closed) fluid->shut[k] = *any = PETSC_TRUE;
  }
  PetscCall(VecRestoreArrayRead(fluid->reached, &flags));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the fluid would come to anew, with these forces on the vertices. */
static PetscErrorCode go_anew(Physics *physics, const Load *load, PetscReal now, Vec forces, Vec pressure, Vec anew)
{
  Fluid    *fluid = load->fluid;
  PetscReal largest;
  PetscFunctionBegin;
  PetscCall(fluid_pressures(physics, fluid, forces, pressure));
  PetscCall(VecNorm(pressure, NORM_INFINITY, &largest));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  largest = now + ROUNDING * largest;
  PetscCall(VecCopy(fluid->reached, anew));
  PetscCall(dry(physics, anew));
  PetscCall(flood(physics, fluid, pressure, largest, now < fluid->before ? largest : largest + HOLDS * now, anew));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode fluid_advance(Physics *physics, Vec contact, PetscBool first, PetscBool *moved)
{
  PetscFunctionBegin;
  *moved = PETSC_FALSE;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    const Load     *load  = &physics->loads[l];
    Fluid          *fluid = load->fluid;
    const PetscReal now   = PetscMax(0, load->pressure * curve_value(&load->curve, physics->t));
    PetscBool       any, closed = PETSC_FALSE;
    Vec             forces, pressure, anew;
    if (!fluid) continue;
    PetscCall(VecDuplicate(contact, &anew));
    PetscCall(VecDuplicate(contact, &forces));
    PetscCall(VecDuplicate(contact, &pressure));
    PetscCall(VecCopy(contact, forces));
    PetscCall(add_fluid(physics, load, now, forces));
    PetscCall(go_anew(physics, load, now, forces, pressure, anew));
    PetscCall(take(physics, fluid, anew, first, &any));
    if (!any) PetscCall(shut(physics, load, now, contact, pressure, &closed));
    if (closed) {
      PetscCall(go_anew(physics, load, now, forces, pressure, anew));
      PetscCall(take(physics, fluid, anew, PETSC_TRUE, &any));
    }
    *moved     = (PetscBool)(*moved || any || closed);
    fluid->now = now;
    PetscCall(VecDestroy(&anew));
    PetscCall(VecDestroy(&pressure));
    PetscCall(VecDestroy(&forces));
    PetscCall(fluid_measure(physics, load));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
