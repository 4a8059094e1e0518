/* Faces under loads and on springs: which they are, their nodes, and which side of them is outward. */
#include "physics/physics.h"

/* the mean of a point's vertices */
static PetscErrorCode middle(const Mesh *mesh, PetscInt point, PetscSection section, const PetscScalar *coordinates,
                             PetscReal mean[3])
{
  PetscInt *closure = NULL, size, vStart, vEnd, n = 0, at;
  PetscFunctionBegin;
  mean[0] = mean[1] = mean[2] = 0;
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &vStart, &vEnd));
  PetscCall(DMPlexGetTransitiveClosure(mesh->dm, point, PETSC_TRUE, &size, &closure));
  for (PetscInt k = 0; k < size; k++) {
    if (closure[2 * k] < vStart || closure[2 * k] >= vEnd) continue;
    PetscCall(PetscSectionGetOffset(section, closure[2 * k], &at));
    for (int i = 0; i < 3; i++)
      mean[i] += PetscRealPart(coordinates[at + i]);
    n++;
  }
  PetscCall(DMPlexRestoreTransitiveClosure(mesh->dm, point, PETSC_TRUE, &size, &closure));
  for (int i = 0; i < 3; i++)
    mean[i] /= (PetscReal)n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of this rank's mesh */
PetscErrorCode face_look_at(const Physics *physics, PetscInt point, Face *face)
{
  const Mesh        *mesh = physics->mesh;
  PetscInt           nodes[FACE_NODES], at;
  const PetscInt    *cells;
  PetscReal          cell_middle[3], face_middle[3], outward = 0, e1[3], e2[3];
  PetscSection       section;
  Vec                vector;
  const PetscScalar *coordinates;

  PetscFunctionBegin;
  PetscCall(DMGetCoordinateSection(mesh->dm, &section));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  PetscCall(plex_face_nodes(mesh, point, &face->n, nodes));
  for (PetscInt a = 0; a < face->n; a++) {
    PetscCall(PetscSectionGetOffset(section, nodes[a], &at));
    for (int i = 0; i < 3; i++)
      face->X[3 * a + i] = PetscRealPart(coordinates[at + i]);
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, nodes[a], &face->dofs[a]));
  }
  PetscCall(DMPlexGetSupport(mesh->dm, point, &cells));
  PetscCall(middle(mesh, cells[0], section, coordinates, cell_middle));
  PetscCall(middle(mesh, point, section, coordinates, face_middle));
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  for (int i = 0; i < 3; i++) { /* two edges of the triangle 0, 1, 2; or a line, and one across the plane */
    e1[i] = face->X[3 + i] - face->X[i];
    e2[i] = mesh->dimension == 3 ? face->X[6 + i] - face->X[i] : i == 2;
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    outward += (e1[j] * e2[k] - e1[k] * e2[j]) * (face_middle[i] - cell_middle[i]);
  }
  face->kind = cell_kind(mesh->dimension - 1, face->n);
  face->sign = outward > 0 ? 1 : -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void face_move(Face *face, const PetscScalar u[])
{
  for (PetscInt j = 0; j < 3 * face->n; j++)
    face->X[j] += PetscRealPart(u[face->dofs[j / 3] + j % 3]);
}
