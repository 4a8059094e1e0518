/* The surfaces of a Gmsh file for a rigid body: those of its volumes (gmsh.c), or, where it has none, its surface elements. */
#include "mesh/mesh.h"
#include <petscdmplex.h>

static PetscErrorCode append_vertices(Scene *scene, const char *body, DM dm, Mesh *shell)
{
  PetscInt           vStart, vEnd;
  PetscReal         *compact;
  PetscSection       section;
  Vec                vector;
  const PetscScalar *coordinates;
  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  PetscCall(PetscMalloc1(3 * (vEnd - vStart), &compact));
  for (PetscInt v = vStart; v < vEnd; v++) {
    PetscInt n, at;
    PetscCall(PetscSectionGetDof(section, v, &n));
    if (n != 3) scene_fail(scene, body, "file", "its surface elements are of second or higher order: mesh it with `-order 1`.");
    PetscCall(PetscSectionGetOffset(section, v, &at));
    for (int i = 0; i < 3; i++)
      compact[3 * (v - vStart) + i] = PetscRealPart(coordinates[at + i]);
  }
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscCall(mesh_append(shell, vEnd - vStart, NULL, compact, 0, NULL, TET4, NULL));
  PetscCall(PetscFree(compact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the elements of a physical surface; label NULL: all */
static PetscErrorCode append_surface(const char *body, DM dm, DMLabel label, const char *name, Mesh *shell)
{
  PetscInt cStart, cEnd, vStart, n, corners[8];
  char     full[2 * NAME_LENGTH];
  Surface *surface;
  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  PetscCall(PetscSNPrintf(full, sizeof(full), "%s.%s", body, name));
  PetscCall(mesh_add_surface(shell, full, cEnd - cStart, &surface));
  for (PetscInt c = cStart; c < cEnd; c++) {
    PetscInt value = 0;
    if (label) PetscCall(DMLabelGetValue(label, c, &value));
    if (value < 0) continue;
    PetscCall(gmsh_corners(dm, c, &n, corners));
    for (PetscInt k = 0; k < n; k++)
      corners[k] -= vStart;
    surface_push(surface, n, corners);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode gmsh_shell_create(Scene *scene, const char *body, Mesh *shell)
{
  char     path[PETSC_MAX_PATH_LEN];
  PetscInt dimension, n_labels;
  DM       dm = NULL;
  PetscFunctionBegin;
  PetscCall(PetscOptionsSetValue(NULL, "-dm_plex_gmsh_spacedim", shell->dimension == 3 ? "3" : "2"));
  PetscCall(gmsh_open(scene, body, shell->dimension - 1, path, &dm));
  PetscCall(PetscOptionsClearValue(NULL, "-dm_plex_gmsh_spacedim"));
  PetscCall(DMGetDimension(dm, &dimension));
  if (dimension != 2 || shell->dimension != 3) {
    PetscCall(DMDestroy(&dm));
    PetscCall(gmsh_create(scene, body, shell));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(append_vertices(scene, body, dm, shell));
  PetscCall(DMGetNumLabels(dm, &n_labels));
  for (PetscInt l = 0; l < n_labels; l++) {
    const char *name;
    DMLabel     label;
    PetscBool   is;
    PetscCall(gmsh_physical_name(dm, l, 0, &name, &is));
    if (!is) continue;
    PetscCall(DMGetLabel(dm, name, &label));
    PetscCall(append_surface(body, dm, label, name, shell));
  }
  if (!shell->n_surfaces) PetscCall(append_surface(body, dm, NULL, "surface", shell));
  PetscCall(orient_outward(scene, body, shell));
  PetscCall(DMDestroy(&dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
