/* A pressure that gets between the surfaces of interfaces, a fluid, and the seal that is to keep it out: where it is and what it presses. How its front
 * moves: fluid_front.c. */
#include "physics/fluid.h"

PetscBool fluid_presses(const Load *load, PetscInt k, const Face *face, const PetscScalar flags[])
{
  if (load->fluid->named[k] || load->fluid->shut[k]) return PETSC_FALSE; /* named: the load itself does */
  for (PetscInt a = 0; a < cell_corners(face->kind); a++) {
    if (!(PetscRealPart(flags[face->dofs[a] + FLUID_REACHED]) > 0)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscErrorCode fluid_share_flags(Physics *physics, Vec flags)
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

/* All nodes of these faces have a flag. */
static PetscErrorCode mark(Physics *physics, PetscInt n, const PetscInt faces[], int flag, Vec flags)
{
  PetscScalar *at;
  PetscFunctionBegin;
  PetscCall(VecGetArray(flags, &at));
  for (PetscInt j = 0; j < n; j++) {
    Face face;
    PetscCall(face_look_at(physics, faces[j], &face));
    for (PetscInt a = 0; a < face.n; a++)
      at[face.dofs[a] + flag] = 1;
  }
  PetscCall(VecRestoreArray(flags, &at));
  PetscCall(fluid_share_flags(physics, flags));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Corners of these faces that have a flag, each face's by itself, of all ranks. */
static PetscErrorCode count_marked(const Physics *physics, PetscInt n, const PetscInt faces[], int flag, Vec flags, PetscInt *marked)
{
  const PetscScalar *at;
  PetscFunctionBegin;
  *marked = 0;
  PetscCall(VecGetArrayRead(flags, &at));
  for (PetscInt j = 0; j < n; j++) {
    Face face;
    PetscCall(face_look_at(physics, faces[j], &face));
    for (PetscInt a = 0; a < cell_corners(face.kind); a++)
      *marked += PetscRealPart(at[face.dofs[a] + flag]) > 0;
  }
  PetscCall(VecRestoreArrayRead(flags, &at));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, marked, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A source that does not touch the sides wets nothing, and an outlet that does not is never reached: told, for it is a mistake. */
static PetscErrorCode tell_apart(Physics *physics, const Load *load)
{
  const Fluid *fluid = load->fluid;
  PetscInt     source, outlet;
  Vec          sides;
  PetscFunctionBegin;
  PetscCall(VecDuplicate(physics->u_local, &sides));
  PetscCall(VecZeroEntries(sides));
  PetscCall(mark(physics, fluid->n_faces, fluid->faces, FLUID_SOURCE, sides));
  PetscCall(count_marked(physics, load->n_faces, load->faces, FLUID_SOURCE, sides, &source));
  PetscCall(count_marked(physics, fluid->n_out, fluid->out, FLUID_SOURCE, sides, &outlet));
  PetscCall(VecDestroy(&sides));
  if (!source)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: warning: the `surface` of '%s' shares no vertex with a side of its interfaces (`into`): the fluid gets between them nowhere.\n", load->name));
  if (fluid->n_outlet_faces && !outlet)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: warning: the `outlet` of '%s' shares no vertex with a side of its interfaces (`into`): no leak would be told.\n", load->name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode fluid_create(Physics *physics, Load *load)
{
  Fluid *fluid = load->fluid;
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
  PetscCall(mark(physics, load->n_faces, load->faces, FLUID_SOURCE, fluid->start));
  PetscCall(VecDuplicate(fluid->start, &fluid->reached));
  PetscCall(VecCopy(fluid->start, fluid->reached));
  PetscCall(tell_apart(physics, load));
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

PetscErrorCode fluid_measure(const Physics *physics, const Load *load)
{
  Fluid             *fluid    = load->fluid;
  PetscReal          pressed = 0;
  PetscInt           out;
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
    if (fluid_presses(load, k, &face, flags)) pressed += PetscSqrtReal(PetscSqr(area[0]) + PetscSqr(area[1]) + PetscSqr(area[2]));
  }
  PetscCall(VecRestoreArrayRead(fluid->reached, &flags));
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &pressed, 1, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscCall(count_marked(physics, fluid->n_out, fluid->out, FLUID_REACHED, fluid->reached, &out));
  fluid->area      = pressed;
  fluid->at_outlet = (PetscBool)(out > 0);
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
