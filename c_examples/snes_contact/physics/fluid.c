/* A pressure that gets between the surfaces of interfaces: a fluid, and the seal that is to keep it out.
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

PetscBool fluid_presses(const Load *load, PetscInt k, const Face *face, const PetscScalar flags[])
{
  if (load->fluid->named[k] || load->fluid->shut[k]) return PETSC_FALSE; /* named: the load itself does */
  for (PetscInt a = 0; a < cell_corners(face->kind); a++) {
    if (!(PetscRealPart(flags[face->dofs[a] + FLUID_REACHED]) > 0)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* What any rank has. */
static PetscErrorCode share_flags(Physics *physics, Vec flags)
{
  PetscScalar *at;
  PetscFunctionBegin;
  PetscCall(unknowns_share(physics, flags));
  PetscCall(VecGetArray(flags, &at));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    at[k] = PetscRealPart(at[k]) > 0;
  PetscCall(VecRestoreArray(flags, &at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode fluid_create(Physics *physics, Load *load)
{
  Fluid       *fluid = load->fluid;
  PetscScalar *flags;
  PetscFunctionBegin;
  if (!fluid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(plex_labelled(physics->mesh, "fluid", load->name, &fluid->n_faces, &fluid->faces));
  PetscCall(plex_labelled(physics->mesh, "outlet", load->name, &fluid->n_out, &fluid->out));
  PetscCallMPI(MPI_Allreduce(&fluid->n_out, &fluid->n_outlet_faces, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(PetscCalloc2(fluid->n_faces, &fluid->named, fluid->n_faces, &fluid->shut));
  for (PetscInt k = 0; k < fluid->n_faces; k++) {
    for (PetscInt j = 0; j < load->n_faces; j++)
      fluid->named[k] = (PetscBool)(fluid->named[k] || load->faces[j] == fluid->faces[k]);
  }
  PetscCall(VecDuplicate(physics->u_local, &fluid->start));
  PetscCall(VecZeroEntries(fluid->start));
  PetscCall(VecGetArray(fluid->start, &flags));
  for (PetscInt j = 0; j < load->n_faces; j++) {
    Face face;
    PetscCall(face_look_at(physics, load->faces[j], &face));
    for (PetscInt a = 0; a < face.n; a++)
      flags[face.dofs[a] + FLUID_SOURCE] = 1;
  }
  PetscCall(VecRestoreArray(fluid->start, &flags));
  PetscCall(share_flags(physics, fluid->start));
  PetscCall(VecDuplicate(fluid->start, &fluid->reached));
  PetscCall(VecCopy(fluid->start, fluid->reached));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode fluid_destroy(Load *load)
{
  Fluid *fluid = load->fluid;
  PetscFunctionBegin;
  if (!fluid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(fluid->sides));
  PetscCall(PetscFree(fluid->outlets));
  PetscCall(PetscFree(fluid->faces));
  PetscCall(PetscFree(fluid->out));
  PetscCall(PetscFree2(fluid->named, fluid->shut));
  PetscCall(VecDestroy(&fluid->start));
  PetscCall(VecDestroy(&fluid->reached));
  PetscCall(PetscFree(load->fluid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
    if (more) PetscCall(share_flags(physics, flags));
  }
  PetscCall(VecRestoreArrayRead(fluid->reached, &now));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool fluids_any(const Physics *physics)
{
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    if (physics->loads[l].fluid) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode fluid_begin(Physics *physics)
{
  PetscFunctionBegin;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    Fluid *fluid = physics->loads[l].fluid;
    if (!fluid) continue;
    PetscCall(VecCopy(fluid->start, fluid->reached));
    PetscCall(PetscArrayzero(fluid->shut, fluid->n_faces));
  }
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

/* How much it presses between the surfaces, and whether it is at an outlet. */
static PetscErrorCode measure(const Physics *physics, const Load *load)
{
  Fluid             *fluid    = load->fluid;
  PetscReal          found[2] = {0, 0};
  const PetscScalar *flags, *u;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  PetscCall(VecGetArrayRead(fluid->reached, &flags));
  for (PetscInt k = 0; k < fluid->n_faces; k++) {
    Face      face;
    PetscReal areas[3 * FACE_NODES], area[3] = {0, 0, 0};
    PetscCall(fluid_face(physics, fluid->faces[k], u, &face, areas));
    for (PetscInt j = 0; j < 3 * face.n; j++)
      area[j % 3] += areas[j];
    if (fluid_presses(load, k, &face, flags)) found[0] += PetscSqrtReal(PetscSqr(area[0]) + PetscSqr(area[1]) + PetscSqr(area[2]));
  }
  for (PetscInt k = 0; k < fluid->n_out; k++) {
    Face face;
    PetscCall(face_look_at(physics, fluid->out[k], &face));
    for (PetscInt a = 0; a < cell_corners(face.kind); a++)
      found[1] += PetscRealPart(flags[face.dofs[a] + FLUID_REACHED]);
  }
  PetscCall(VecRestoreArrayRead(fluid->reached, &flags));
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, found, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  fluid->area     = found[0];
  fluid->at_outlet = (PetscBool)(found[1] > 0);
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
    PetscCall(measure(physics, load));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode fluid_accept(Physics *physics, PetscBool quiet)
{
  PetscFunctionBegin;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    Fluid *fluid = physics->loads[l].fluid;
    if (!fluid) continue;
    PetscCall(VecCopy(fluid->reached, fluid->start));
    fluid->before = fluid->now;
    if (!fluid->at_outlet || fluid->leaks >= 0) continue;
    fluid->leaks = physics->t;
    if (!quiet)
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, "note: at t = %.6g, where its pressure is %.6g, `%s` has come to its outlet: the interface leaks\n",
                            (double)physics->t, (double)(physics->loads[l].pressure * curve_value(&physics->loads[l].curve, physics->t)),
                            physics->loads[l].name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void fluid_report(const Physics *physics, cJSON *json)
{
  cJSON *all = NULL;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    const Load *load = &physics->loads[l];
    cJSON      *one;
    if (!load->fluid) continue;
    if (!all) all = cJSON_AddObjectToObject(json, "fluids");
    one = cJSON_AddObjectToObject(all, load->name);
    cJSON_AddNumberToObject(one, "pressure", load->pressure * curve_value(&load->curve, physics->t));
    cJSON_AddNumberToObject(one, "area", load->fluid->area);
    if (load->fluid->n_outlet_faces) cJSON_AddBoolToObject(one, "at_outlet", load->fluid->at_outlet);
  }
}
