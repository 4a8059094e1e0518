/* What presses the corners of the faces that a fluid may come to: the force of contact and fluid on each, along and over its area. Nodes between corners
 * share their force among these, and faces share their area: a constant pressure has its own value there, whatever the shape functions are. */
#include "physics/fluid.h"

PetscErrorCode fluid_face(const Physics *physics, PetscInt point, const PetscScalar *u, Face *face, PetscReal areas[])
{
  PetscFunctionBegin;
  PetscCall(face_look_at(physics, point, face));
  face_move(face, u);
  face_pressure(face->kind, &physics->mesh->space, face->X, -face->sign, areas, NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the nodes of the faces: their areas as vectors, and the number of faces that each is of. */
static PetscErrorCode find_areas(Physics *physics, const Fluid *fluid, Vec areas, Vec count)
{
  const PetscScalar *u;
  PetscScalar       *to, *n;
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(areas));
  PetscCall(VecZeroEntries(count));
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  PetscCall(VecGetArray(areas, &to));
  PetscCall(VecGetArray(count, &n));
  for (PetscInt k = 0; k < fluid->n_faces; k++) {
    Face      face;
    PetscReal of[3 * FACE_NODES];
    PetscCall(fluid_face(physics, fluid->faces[k], u, &face, of));
    for (PetscInt j = 0; j < 3 * face.n; j++)
      to[face.dofs[j / 3] + j % 3] += of[j];
    for (PetscInt j = 0; j < face.n; j++)
      n[face.dofs[j]] += 1;
  }
  PetscCall(VecRestoreArray(count, &n));
  PetscCall(VecRestoreArray(areas, &to));
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCall(unknowns_share(physics, areas));
  PetscCall(unknowns_share(physics, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Vectors of nodes to the corners of the faces: those between corners in equal parts. */
static PetscErrorCode lump(Physics *physics, const Fluid *fluid, Vec count, Vec nodes, Vec corners)
{
  const PetscScalar *from, *n;
  PetscScalar       *to;
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(corners));
  PetscCall(VecGetArrayRead(nodes, &from));
  PetscCall(VecGetArrayRead(count, &n));
  PetscCall(VecGetArray(corners, &to));
  for (PetscInt k = 0; k < fluid->n_faces; k++) {
    Face face;
    PetscCall(face_look_at(physics, fluid->faces[k], &face));
    for (PetscInt j = 0; j < face.n; j++) {
      PetscInt       its[CELL_CORNERS] = {j};
      const PetscInt m                 = j < cell_corners(face.kind) ? 1 : cell_node_corners(face.kind, j, its);
      for (PetscInt i = 0; i < 3 * m; i++)
        to[face.dofs[its[i / 3]] + i % 3] += from[face.dofs[j] + i % 3] / (n[face.dofs[j]] * (PetscReal)m);
    }
  }
  PetscCall(VecRestoreArray(corners, &to));
  PetscCall(VecRestoreArrayRead(count, &n));
  PetscCall(VecRestoreArrayRead(nodes, &from));
  PetscCall(unknowns_share(physics, corners));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode fluid_pressures(Physics *physics, const Fluid *fluid, Vec forces, Vec pressure)
{
  Vec                areas, count, lumped;
  const PetscScalar *a;
  PetscScalar       *p;
  PetscFunctionBegin;
  PetscCall(VecDuplicate(pressure, &areas));
  PetscCall(VecDuplicate(pressure, &count));
  PetscCall(VecDuplicate(pressure, &lumped));
  PetscCall(find_areas(physics, fluid, areas, count));
  PetscCall(lump(physics, fluid, count, areas, lumped));
  PetscCall(lump(physics, fluid, count, forces, pressure));
  PetscCall(VecGetArrayRead(lumped, &a));
  PetscCall(VecGetArray(pressure, &p));
  for (PetscInt k = 0; k < physics->mesh->n_points; k++) {
    PetscReal along = 0, square = 0;
    PetscInt  at;
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, physics->mesh->points[k], &at));
    for (int i = 0; i < 3; i++) {
      along += PetscRealPart(p[at + i] * a[at + i]);
      square += PetscRealPart(a[at + i] * a[at + i]);
    }
    p[at]     = square > 0 ? along / square : 0;
    p[at + 1] = p[at + 2] = 0;
  }
  PetscCall(VecRestoreArray(pressure, &p));
  PetscCall(VecRestoreArrayRead(lumped, &a));
  PetscCall(VecDestroy(&lumped));
  PetscCall(VecDestroy(&count));
  PetscCall(VecDestroy(&areas));
  PetscFunctionReturn(PETSC_SUCCESS);
}
