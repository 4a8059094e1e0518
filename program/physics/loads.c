/* Loads: a traction vector or a pressure on surfaces, or what accelerates bodies, as nodal forces times a curve. Tractions, and
 * pressures that follow nothing, are dead, per reference area; a follower pressure acts on the surface as it is now. */
#include "physics/fluid.h"

PetscErrorCode loads_label(Physics *physics)
{
  char label[2 * NAME_LENGTH];
  PetscFunctionBegin;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    PetscCall(PetscSNPrintf(label, sizeof(label), "load.%s", physics->loads[l].name));
    if (!physics->loads[l].n_surfaces) PetscCall(plex_label_faces(physics->mesh, label, NULL));
    for (PetscInt k = 0; k < physics->loads[l].n_surfaces; k++)
      PetscCall(plex_label_faces(physics->mesh, label, physics->loads[l].surfaces[k]));
    PetscCall(fluid_label(physics, &physics->loads[l]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void add(PetscInt n, const PetscInt dofs[], const PetscReal f[], PetscReal factor, PetscScalar *forces)
{
  for (PetscInt k = 0; k < 3 * n; k++)
    forces[dofs[k / 3] + k % 3] += factor * f[k];
}

static PetscErrorCode add_surfaces(const Physics *physics, const Load *load, PetscScalar *forces)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < load->n_faces; k++) {
    Face      face;
    PetscReal f[3 * FACE_NODES];
    PetscCall(face_look_at(physics, load->faces[k], &face));
    face_pressure(face.kind, &physics->mesh->space, face.X, face.sign * load->pressure, f, NULL);
    face_traction(face.kind, &physics->mesh->space, face.X, load->traction, f);
    add(face.n, face.dofs, f, 1, forces);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void add_bodies(const Physics *physics, const Load *load, PetscScalar *forces)
{
  const Cells *cells = &physics->cells;
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt first = cells->offsets[c], n = cells->offsets[c + 1] - first;
    PetscReal      f[3 * CELL_NODES];
    if (!load->bodies[cells->body[c]] || physics->mesh->bodies[cells->body[c]].rigid) continue;
    cell_body_forces(cell_kind(physics->mesh->dimension, n), &physics->mesh->space,
                     physics->materials[cells->body[c]].density, &load->acceleration, cells->X + 3 * first, f);
    add(n, cells->dofs + first, f, 1, forces);
  }
}

/* by the rank that owns it */
static PetscErrorCode add_to_vertex(const Physics *physics, const Load *load, PetscScalar *forces)
{
  const Mesh *mesh = physics->mesh;
  PetscInt    at;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    if (mesh->original[k] != load->vertex || physics->unknowns.ghost[k]) continue;
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, mesh->points[k], &at));
    for (int i = 0; i < 3; i++)
      forces[at + i] += load->force[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode loads_assemble(Physics *physics)
{
  PetscFunctionBegin;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    Load        *load = &physics->loads[l];
    PetscScalar *forces;
    PetscCall(plex_labelled(physics->mesh, "load", load->name, &load->n_faces, &load->faces));
    PetscCall(VecDuplicate(physics->u_local, &load->forces));
    PetscCall(VecZeroEntries(load->forces));
    PetscCall(fluid_create(physics, load));
    if (load->follows) continue;
    PetscCall(VecGetArray(load->forces, &forces));
    if (load->remote) {
      PetscCall(remote_assemble(physics, load, forces));
    } else if (load->vertex >= 0) {
      PetscCall(add_to_vertex(physics, load, forces));
    } else if (load->bodies) {
      add_bodies(physics, load, forces);
      PetscCall(rigids_load(physics, load, forces));
    } else {
      PetscCall(add_surfaces(physics, load, forces));
    }
    PetscCall(VecRestoreArray(load->forces, &forces));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a face under a pressure that follows it, as it is at u_local: forces into `array`, or derivatives out of the matrix. */
static PetscErrorCode press(Physics *physics, Face *face, PetscReal pressure, const PetscScalar *u, PetscScalar *array, Mat matrix)
{
  PetscReal f[3 * FACE_NODES], K[9 * FACE_NODES * FACE_NODES];
  PetscInt  equations[3 * FACE_NODES];
  PetscFunctionBegin;
  face_move(face, u);
  for (PetscInt j = 0; j < 3 * face->n; j++)
    equations[j] = physics->unknowns.equations[face->dofs[j / 3] + j % 3];
  face_pressure(face->kind, &physics->mesh->space, face->X, -face->sign * pressure, f, matrix ? K : NULL);
  if (array) add(face->n, face->dofs, f, -1, array);
  if (matrix) PetscCall(MatSetValues(matrix, 3 * face->n, equations, 3 * face->n, equations, K, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The faces between surfaces that a fluid presses. */
static PetscErrorCode press_between(Physics *physics, const Load *load, PetscReal pressure, const PetscScalar *u, PetscScalar *array, Mat matrix)
{
  const PetscScalar *flags;
  PetscFunctionBegin;
  if (!load->fluid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(load->fluid->reached, &flags));
  for (PetscInt k = 0; k < load->fluid->n_faces; k++) {
    Face face;
    PetscCall(face_look_at(physics, load->fluid->faces[k], &face));
    if (fluid_presses(load, k, &face, flags)) PetscCall(press(physics, &face, pressure, u, array, matrix));
  }
  PetscCall(VecRestoreArrayRead(load->fluid->reached, &flags));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All pressures that follow their surfaces. */
static PetscErrorCode follow(Physics *physics, PetscScalar *array, Mat matrix)
{
  const PetscScalar *u;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    const Load     *load     = &physics->loads[l];
    const PetscReal pressure = load->pressure * curve_value(&load->curve, physics->t);
    for (PetscInt k = 0; k < load->n_faces && load->follows; k++) {
      Face face;
      PetscCall(face_look_at(physics, load->faces[k], &face));
      PetscCall(press(physics, &face, pressure, u, array, matrix));
    }
    PetscCall(press_between(physics, load, pressure, u, array, matrix));
  }
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool loads_follow(const Physics *physics)
{
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    if (physics->loads[l].follows) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode loads_values(Physics *physics)
{
  PetscScalar *forces;
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(physics->f_external));
  for (PetscInt l = 0; l < physics->n_loads; l++)
    PetscCall(VecAXPY(physics->f_external, curve_value(&physics->loads[l].curve, physics->t), physics->loads[l].forces));
  if (physics->f_thermal) PetscCall(VecAXPY(physics->f_external, 1, physics->f_thermal));
  if (!loads_follow(physics) && !physics->timed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(physics->f_external, &forces));
  PetscCall(timed_forces(physics, forces));
  if (loads_follow(physics)) PetscCall(follow(physics, forces, NULL));
  PetscCall(VecRestoreArray(physics->f_external, &forces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode loads_stiffness(Physics *physics, Mat matrix)
{
  PetscFunctionBegin;
  if (loads_follow(physics)) PetscCall(follow(physics, NULL, matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}
