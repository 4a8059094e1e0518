/* A body from a Gmsh file, read by PETSc (one of second order: gmsh_second.c). Names of physical surfaces become surfaces
 * "body.name"; with `volume`, only the cells of that physical volume are taken, so that several bodies may share one
 * file. In a plane model cells are faces for Gmsh, their sides edges: physical surfaces are its volumes, and physical
 * curves its surfaces. */
#include "mesh/mesh.h"
#include <petscdmplex.h>
#include <stdio.h>
#include <string.h>

static PetscErrorCode point_vertices(DM dm, PetscInt point, PetscInt *n, PetscInt vertices[8])
{
  PetscInt *closure = NULL, size, vStart, vEnd;
  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  PetscCall(DMPlexGetTransitiveClosure(dm, point, PETSC_TRUE, &size, &closure));
  *n = 0;
  for (PetscInt k = 0; k < size; k++) {
    if (closure[2 * k] >= vStart && closure[2 * k] < vEnd && *n < 8) vertices[(*n)++] = closure[2 * k];
  }
  PetscCall(DMPlexRestoreTransitiveClosure(dm, point, PETSC_TRUE, &size, &closure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode gmsh_corners(DM dm, PetscInt cell, PetscInt *n, PetscInt vertices[8])
{
  DMPolytopeType type;
  PetscFunctionBegin;
  PetscCall(point_vertices(dm, cell, n, vertices));
  PetscCall(DMPlexGetCellType(dm, cell, &type));
  PetscCall(DMPlexInvertCell(type, vertices)); /* DMPlex and VTK turn around the cell in opposite directions */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* kinds of cells that there is no element for */
static const char *unknown_kind(DMPolytopeType type)
{
  switch (type) {
  case DM_POLYTOPE_TRI_PRISM:
  case DM_POLYTOPE_TRI_PRISM_TENSOR: return "a prism (wedge)";
  case DM_POLYTOPE_PYRAMID: return "a pyramid";
  default: return "a cell of another kind";
  }
}

/* triangle and quadrilateral, tetrahedron and hexahedron */
static const DMPolytopeType TYPES[2][2] = {{DM_POLYTOPE_TRIANGLE, DM_POLYTOPE_QUADRILATERAL},
                                           {DM_POLYTOPE_TETRAHEDRON, DM_POLYTOPE_HEXAHEDRON}};
static const CellKind       KINDS[2][2] = {{TRI3, QUAD4}, {TET4, HEX8}};

static PetscErrorCode append_cells(Scene *scene, const char *body, DM dm, DMLabel volume, PetscInt new_number[],
                                   Mesh *mesh)
{
  const PetscInt     d = mesh->dimension;
  PetscInt           cStart, cEnd, vStart, vEnd, n_vertices = 0, n_cells[2] = {0, 0}, *cells[2];
  PetscReal         *compact;
  const PetscScalar *coordinates;
  Vec                vector;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  PetscCall(
      PetscMalloc3(8 * (cEnd - cStart), &cells[0], 8 * (cEnd - cStart), &cells[1], 3 * (vEnd - vStart), &compact));
  PetscCall(PetscArrayzero(compact, 3 * (vEnd - vStart)));
  PetscCall(DMGetCoordinatesLocal(dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  for (PetscInt c = cStart; c < cEnd; c++) {
    PetscInt       corners[8], n, value = 0, kind;
    DMPolytopeType type;
    if (volume) PetscCall(DMLabelGetValue(volume, c, &value));
    if (value < 0) continue;
    PetscCall(DMPlexGetCellType(dm, c, &type));
    if (type != TYPES[d == 3][0] && type != TYPES[d == 3][1]) gmsh_fail_kind(scene, body, unknown_kind(type));
    kind = type == TYPES[d == 3][1];
    PetscCall(gmsh_corners(dm, c, &n, corners));
    for (PetscInt a = 0; a < n; a++) {
      PetscInt *number = &new_number[corners[a] - vStart];
      if (*number < 0) { /* vertices of other volumes in the file stay out */
        PetscInt     offset, n_coordinates;
        PetscSection section;
        PetscCall(DMGetCoordinateSection(dm, &section));
        PetscCall(PetscSectionGetDof(section, corners[a], &n_coordinates));
        if (n_coordinates != d) /* PETSc keeps curved cells' coordinates elsewhere */
          scene_fail(scene, body, "file",
                     "its cells are of second or higher order: of second order they are read from text of format 4.1 or "
                     "2.2 (`gmsh -%d -order 2 -format msh41`, not binary), of higher order not at all.",
                     (int)d);
        PetscCall(PetscSectionGetOffset(section, corners[a], &offset));
        for (int i = 0; i < d; i++)
          compact[3 * n_vertices + i] = PetscRealPart(coordinates[offset + i]);
        *number = n_vertices++;
      }
      cells[kind][n * n_cells[kind] + a] = *number;
    }
    n_cells[kind]++;
  }
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  /* the vertices go with the first kind; the second one refers to them by numbers relative to its own (empty) block */
  for (PetscInt k = 0; k < cell_nodes(KINDS[d == 3][0]) * n_cells[0]; k++)
    cells[0][k] -= n_vertices;
  PetscCall(mesh_append(mesh, n_vertices, NULL, compact, n_cells[1], NULL, KINDS[d == 3][1], cells[1]));
  PetscCall(mesh_append(mesh, 0, NULL, NULL, n_cells[0], NULL, KINDS[d == 3][0], cells[0]));
  PetscCall(PetscFree3(cells[0], cells[1], compact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* faces of one physical surface, each as a face of a cell of this body */
static PetscErrorCode append_surface(const char *body, DM dm, DMLabel label, const char *label_name, DMLabel volume,
                                     const PetscInt new_number[], PetscInt first, Mesh *mesh)
{
  PetscInt fStart, fEnd, vStart, vEnd, count = 0;
  char     name[2 * NAME_LENGTH];
  Surface *surface = NULL;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(dm, 1, &fStart, &fEnd));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  for (int pass = 0; pass < 2; pass++) { /* count, then fill */
    for (PetscInt f = fStart; f < fEnd; f++) {
      PetscInt        value, n_support, cell = -1, owners = 0, corners[8], on_face[8], vertices[FACE_NODES], n, n_on_face;
      const PetscInt *support;
      CellKind        kind;
      PetscCall(DMLabelGetValue(label, f, &value));
      if (value < 0) continue;
      PetscCall(DMPlexGetSupportSize(dm, f, &n_support));
      PetscCall(DMPlexGetSupport(dm, f, &support));
      for (PetscInt s = 0; s < n_support; s++) {
        PetscInt inside = 0;
        if (volume) PetscCall(DMLabelGetValue(volume, support[s], &inside));
        if (inside < 0) continue;
        if (cell < 0) cell = support[s];
        owners++;
      }
      if (!pass) count += owners > 0;
      if (!pass || !owners) continue;
      if (owners > 1) surface->inner = PETSC_TRUE;
      PetscCall(gmsh_corners(dm, cell, &n, corners));
      PetscCall(point_vertices(dm, f, &n_on_face, on_face));
      for (PetscInt a = 0; a < n; a++)
        corners[a] = first + new_number[corners[a] - vStart];
      for (PetscInt a = 0; a < n_on_face; a++)
        on_face[a] = first + new_number[on_face[a] - vStart];
      kind = cell_kind(mesh->dimension, n);
      mesh_turn_cell(mesh, kind, corners);
      for (PetscInt k = 0; k < cell_faces(kind); k++) { /* which face of the cell is it? */
        const PetscInt n_corners = cell_face(kind, k, corners, vertices);
        PetscInt       shared    = 0;
        for (PetscInt a = 0; a < n_corners; a++) {
          for (PetscInt b = 0; b < n_on_face; b++)
            shared += vertices[a] == on_face[b];
        }
        if (shared != n_corners) continue;
        surface_push(surface, n_corners, vertices);
        break;
      }
    }
    if (!pass && !count) break; /* a name of a volume, or of a surface of another body in the same file */
    if (!pass) {
      PetscCall(PetscSNPrintf(name, sizeof(name), "%s.%s", body, label_name));
      PetscCall(mesh_add_surface(mesh, name, count, &surface));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is this label of PETSc's a physical name? With `height` 0: of a volume, 1: of a surface. */
PetscErrorCode gmsh_physical_name(DM dm, PetscInt l, PetscInt height, const char **name, PetscBool *is)
{
  static const char *const builtin[] = {"celltype", "depth", "Cell Sets", "Face Sets", "Edge Sets", "Vertex Sets"};
  PetscInt                 start, end, value = -1;
  DMLabel                  label;

  PetscFunctionBegin;
  PetscCall(DMGetLabelName(dm, l, name));
  PetscCall(DMGetLabel(dm, *name, &label));
  PetscCall(DMPlexGetHeightStratum(dm, height, &start, &end));
  for (PetscInt p = start; p < end && value < 0; p++)
    PetscCall(DMLabelGetValue(label, p, &value));
  *is = (PetscBool)(value >= 0);
  for (size_t k = 0; k < sizeof(builtin) / sizeof(builtin[0]); k++)
    *is = (PetscBool)(*is && strcmp(*name, builtin[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* all physical names of volumes, or of surfaces, for a message */
static PetscErrorCode list_names(DM dm, PetscInt height, char list[], size_t length)
{
  PetscInt n_labels;
  PetscFunctionBegin;
  list[0] = 0;
  PetscCall(DMGetNumLabels(dm, &n_labels));
  for (PetscInt l = 0; l < n_labels; l++) {
    const char *name;
    PetscBool   is;
    PetscCall(gmsh_physical_name(dm, l, height, &name, &is));
    if (is) snprintf(list + strlen(list), length - strlen(list), "%s%s", list[0] ? ", " : "", name);
  }
  if (!list[0]) snprintf(list, length, "none");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* map.file, a path that can be read */
static PetscErrorCode find_file(Scene *scene, const char *body, char path[])
{
  char      file[PETSC_MAX_PATH_LEN] = "";
  PetscBool exists;
  PetscFunctionBegin;
  scene_string_required(scene, body, "file", file, sizeof(file));
  PetscCall(scene_relative_path(scene, file, path, PETSC_MAX_PATH_LEN));
  PetscCall(PetscTestFile(path, 'r', &exists));
  if (!exists) scene_fail(scene, body, "file", "cannot read '%s'.", path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode gmsh_open(Scene *scene, const char *body, PetscInt dimension, char path[], DM *dm)
{
  char           copy[PETSC_MAX_PATH_LEN];
  PetscErrorCode failed;
  PetscFunctionBegin;
  PetscCall(find_file(scene, body, path));
  PetscCall(PetscOptionsSetValue(NULL, "-dm_plex_gmsh_use_regions", "true")); /* labels by physical name */
  PetscCall(gmsh_without_signs(path, copy, sizeof(copy)));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  failed = DMPlexCreateGmshFromFile(PETSC_COMM_SELF, copy[0] ? copy : path, PETSC_TRUE, dm);
  PetscCall(PetscPopErrorHandler());
  if (copy[0]) (void)remove(copy);
  if (failed)
    scene_fail(scene, body, "file",
               "PETSc cannot read '%s' as a Gmsh mesh (write it as `gmsh -%d -format msh41`, with `-order 1` or, as text, "
               "`-order 2`).",
               path, (int)dimension);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode gmsh_create(Scene *scene, const char *body, Mesh *mesh)
{
  const PetscInt           first     = mesh->n_vertices;
  char                     path[PETSC_MAX_PATH_LEN], volume_name[NAME_LENGTH] = "", names[1024];
  PetscInt                 dimension, n_labels, vStart, vEnd, *new_number;
  PetscBool                done;
  DMLabel                  volume = NULL;
  DM                       dm     = NULL;

  PetscFunctionBegin;
  PetscCall(find_file(scene, body, path));
  scene_string(scene, body, "volume", volume_name, sizeof(volume_name));
  PetscCall(gmsh_second_create(scene, body, path, volume_name, mesh, &done));
  if (done) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(gmsh_open(scene, body, mesh->dimension, path, &dm));
  PetscCall(DMGetDimension(dm, &dimension));
  if (dimension != mesh->dimension) gmsh_fail_dimension(scene, body, path, mesh->dimension);
  if (volume_name[0]) {
    PetscCall(DMGetLabel(dm, volume_name, &volume));
    PetscCall(list_names(dm, 0, names, sizeof(names)));
    if (!volume) gmsh_fail_volume(scene, body, path, volume_name, names, mesh->dimension);
  }
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  PetscCall(PetscMalloc1(vEnd - vStart, &new_number));
  for (PetscInt v = 0; v < vEnd - vStart; v++)
    new_number[v] = -1;
  PetscCall(append_cells(scene, body, dm, volume, new_number, mesh));
  if (mesh->n_vertices == first) scene_fail(scene, body, "volume", "'%s' has no cell in '%s'.", path, volume_name);
  PetscCall(list_names(dm, 1, names, sizeof(names)));
  if (!strcmp(names, "none")) gmsh_fail_nameless(scene, body, path, mesh->dimension);
  PetscCall(DMGetNumLabels(dm, &n_labels));
  for (PetscInt l = 0; l < n_labels; l++) {
    const char *name;
    DMLabel     label;
    PetscBool   is;
    PetscCall(gmsh_physical_name(dm, l, 1, &name, &is));
    if (!is) continue;
    PetscCall(DMGetLabel(dm, name, &label));
    PetscCall(append_surface(body, dm, label, name, volume, new_number, first, mesh));
  }
  PetscCall(PetscFree(new_number));
  PetscCall(DMDestroy(&dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
