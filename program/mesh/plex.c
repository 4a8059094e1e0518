/* The mesh as one distributed DMPlex: each rank builds that of its piece with all labels, which share the vertices on their
 * borders; PETSc partitions and sends it. Cells are described by their corners; PETSc adds edges and faces, of which those with a
 * node in their middle are vertices of the mesh, too, with coordinates. */
#include "mesh/mesh.h"

/* in the order of the piece those that are corners; `number` -1: a node in the middle of an edge, a face or a cell */
static PetscInt number_corners(const Mesh *mesh, PetscInt number[])
{
  PetscInt n = 0;
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    number[v] = 0;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt first = mesh->cell_offsets[c], corners = cell_corners(mesh_cell_kind(mesh, c));
    for (PetscInt k = first + corners; k < mesh->cell_offsets[c + 1]; k++)
      number[mesh->cell_vertices[k]] = -1;
  }
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    number[v] = number[v] < 0 ? -1 : n++;
  return n;
}

static DMPolytopeType polytope(CellKind kind)
{
  if (cell_dimension(kind) == 2) return cell_is_simplex(kind) ? DM_POLYTOPE_TRIANGLE : DM_POLYTOPE_QUADRILATERAL;
  return cell_is_simplex(kind) ? DM_POLYTOPE_TETRAHEDRON : DM_POLYTOPE_HEXAHEDRON;
}

/* Corners that another rank owns are points of its. */
static PetscErrorCode share_corners(const Mesh *mesh, const PetscInt number[], DM dm)
{
  PetscInt           n_leaves, n = 0, n_points, *point, *there, *local;
  const PetscInt    *leaves;
  const PetscSFNode *owners;
  PetscSFNode       *remote;
  PetscSF            sf;
  PetscFunctionBegin;
  if (mesh->size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMPlexGetChart(dm, NULL, &n_points));
  PetscCall(PetscMalloc2(mesh->n_vertices, &point, mesh->n_vertices, &there));
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    point[v] = there[v] = number[v] < 0 ? -1 : mesh->n_cells + number[v];
  PetscCall(PetscSFBcastBegin(mesh->shared, MPIU_INT, point, there, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(mesh->shared, MPIU_INT, point, there, MPI_REPLACE));
  PetscCall(PetscSFGetGraph(mesh->shared, NULL, &n_leaves, &leaves, &owners));
  PetscCall(PetscMalloc1(n_leaves, &local));
  PetscCall(PetscMalloc1(n_leaves, &remote));
  for (PetscInt k = 0; k < n_leaves; k++) {
    const PetscInt v = leaves ? leaves[k] : k;
    if (number[v] < 0) continue;
    local[n]    = point[v];
    remote[n++] = (PetscSFNode){.rank = owners[k].rank, .index = there[v]};
  }
  PetscCall(DMGetPointSF(dm, &sf));
  PetscCall(PetscSFSetGraph(sf, n_points, n, local, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscFree2(point, there));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* cells, by their corners, and these corners */
static PetscErrorCode create_linear(const Mesh *mesh, const PetscInt number[], PetscInt n_corners, DM *dm)
{
  PetscReal *coordinates;
  PetscFunctionBegin;
  PetscCall(DMPlexCreate(PETSC_COMM_WORLD, dm));
  PetscCall(DMSetDimension(*dm, mesh->dimension));
  PetscCall(DMPlexSetChart(*dm, 0, mesh->n_cells + n_corners));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    PetscCall(DMPlexSetConeSize(*dm, c, cell_corners(mesh_cell_kind(mesh, c))));
  PetscCall(DMSetUp(*dm));
  PetscCall(DMCreateLabel(*dm, "celltype"));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const CellKind       kind = mesh_cell_kind(mesh, c);
    const PetscInt       n    = cell_corners(kind);
    const DMPolytopeType type = polytope(kind);
    PetscInt             cone[CELL_CORNERS];
    for (PetscInt a = 0; a < n; a++)
      cone[a] = mesh->n_cells + number[mesh->cell_vertices[mesh->cell_offsets[c] + a]];
    PetscCall(DMPlexInvertCell(type, cone)); /* from VTK's order */
    PetscCall(DMPlexSetCone(*dm, c, cone));
    PetscCall(DMPlexSetCellType(*dm, c, type));
  }
  for (PetscInt v = 0; v < n_corners; v++)
    PetscCall(DMPlexSetCellType(*dm, mesh->n_cells + v, DM_POLYTOPE_POINT));
  PetscCall(DMPlexSymmetrize(*dm));
  PetscCall(DMPlexStratify(*dm));
  PetscCall(share_corners(mesh, number, *dm));
  PetscCall(DMSetCoordinateDim(*dm, 3));
  PetscCall(PetscMalloc1(3 * n_corners, &coordinates));
  for (PetscInt v = 0; v < mesh->n_vertices; v++) {
    if (number[v] >= 0) PetscCall(PetscArraycpy(coordinates + 3 * number[v], mesh->coordinates + 3 * v, 3));
  }
  PetscCall(DMPlexBuildCoordinatesFromCellList(*dm, 3, coordinates));
  PetscCall(PetscFree(coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the point of each vertex of the piece */
static PetscErrorCode find_points(Mesh *mesh, const PetscInt number[])
{
  PetscInt vStart;
  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &vStart, NULL));
  mesh->n_points = mesh->n_vertices;
  PetscCall(PetscMalloc1(mesh->n_points, &mesh->points));
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    mesh->points[v] = number[v] < 0 ? -1 : vStart + number[v];
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt *cell = mesh->cell_vertices + mesh->cell_offsets[c];
    const CellKind  kind = mesh_cell_kind(mesh, c);
    for (PetscInt a = cell_corners(kind); a < cell_nodes(kind); a++) {
      PetscInt       its[CELL_CORNERS];
      const PetscInt count = cell_node_corners(kind, a, its);
      if (mesh->points[cell[a]] >= 0) continue;
      for (PetscInt k = 0; k < count; k++)
        its[k] = mesh->points[cell[its[k]]];
      PetscCall(plex_amid(mesh->dm, count, its, &mesh->points[cell[a]]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In place of PETSc's, which are those of the corners: coordinates of all vertices. */
static PetscErrorCode set_coordinates(Mesh *mesh)
{
  PetscInt     pStart, pEnd, n;
  PetscScalar *array;
  PetscSection section;
  Vec          coordinates;
  PetscFunctionBegin;
  PetscCall(DMPlexGetChart(mesh->dm, &pStart, &pEnd));
  PetscCall(PetscSectionCreate(PetscObjectComm((PetscObject)mesh->dm), &section));
  PetscCall(PetscSectionSetNumFields(section, 1));
  PetscCall(PetscSectionSetFieldComponents(section, 0, 3));
  PetscCall(PetscSectionSetChart(section, pStart, pEnd));
  for (PetscInt v = 0; v < mesh->n_points; v++) {
    PetscCall(PetscSectionSetDof(section, mesh->points[v], 3));
    PetscCall(PetscSectionSetFieldDof(section, mesh->points[v], 0, 3));
  }
  PetscCall(PetscSectionSetUp(section));
  PetscCall(PetscSectionGetStorageSize(section, &n));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, n, &coordinates));
  PetscCall(VecSetBlockSize(coordinates, 3));
  PetscCall(VecGetArray(coordinates, &array));
  for (PetscInt v = 0; v < mesh->n_points; v++) {
    PetscInt at;
    PetscCall(PetscSectionGetOffset(section, mesh->points[v], &at));
    for (int i = 0; i < 3; i++)
      array[at + i] = mesh->coordinates[3 * v + i];
  }
  PetscCall(VecRestoreArray(coordinates, &array));
  PetscCall(DMSetCoordinateSection(mesh->dm, 3, section));
  PetscCall(DMSetCoordinatesLocal(mesh->dm, coordinates));
  PetscCall(VecDestroy(&coordinates));
  PetscCall(PetscSectionDestroy(&section));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode plex_create(Mesh *mesh)
{
  DM        dm;
  DMLabel   body;
  PetscInt *number, n_corners;
  PetscBool quadratic;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->n_vertices, &number));
  n_corners = number_corners(mesh, number);
  PetscCall(create_linear(mesh, number, n_corners, &dm));
  PetscCall(DMPlexInterpolate(dm, &mesh->dm)); /* adds edges and faces; keeps the numbers of cells and vertices */
  PetscCall(DMDestroy(&dm));
  PetscCall(find_points(mesh, number));
  PetscCall(PetscFree(number));
  quadratic = (PetscBool)(n_corners < mesh->n_vertices);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &quadratic, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  if (quadratic) PetscCall(set_coordinates(mesh));
  PetscCall(DMCreateLabel(mesh->dm, "body"));
  PetscCall(DMGetLabel(mesh->dm, "body", &body));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    PetscCall(DMLabelSetValue(body, c, mesh->cell_body[c]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `values` per vertex, or NULL for one `value` for all */
PetscErrorCode plex_label_vertices(const Mesh *mesh, const char *name, PetscInt n, const PetscInt *vertices,
                                   const PetscInt *values, PetscInt value)
{
  DMLabel label;
  PetscFunctionBegin;
  PetscCall(DMCreateLabel(mesh->dm, name)); /* on every rank, also where it stays empty */
  PetscCall(DMGetLabel(mesh->dm, name, &label));
  for (PetscInt k = 0; k < n; k++)
    PetscCall(DMLabelSetValue(label, mesh->points[vertices ? vertices[k] : k], values ? values[k] : value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode plex_label_faces(const Mesh *mesh, const char *name, const Surface *surface)
{
  DMLabel label;
  PetscFunctionBegin;
  PetscCall(DMCreateLabel(mesh->dm, name));
  PetscCall(DMGetLabel(mesh->dm, name, &label));
  for (PetscInt f = 0; surface && f < surface->n_faces; f++) {
    const PetscInt first = surface->offsets[f], n = cell_corners(mesh_face_kind(mesh, surface, f));
    PetscInt       corners[4], face;
    for (PetscInt k = 0; k < n; k++)
      corners[k] = mesh->points[surface->vertices[first + k]];
    PetscCall(plex_amid(mesh->dm, n, corners, &face));
    PetscCall(DMLabelSetValue(label, face, 1));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* from each point to those of the distributed mesh */
static PetscErrorCode send(PetscSF migration, PetscInt n, PetscInt **values)
{
  PetscInt *received;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &received));
  PetscCall(PetscSFBcastBegin(migration, MPIU_INT, *values, received, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(migration, MPIU_INT, *values, received, MPI_REPLACE));
  PetscCall(PetscFree(*values));
  *values = received;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Partition, send, and remember which vertices and cells of the mesh are here, and at which points. */
PetscErrorCode plex_distribute(Mesh *mesh)
{
  DM       distributed = NULL;
  PetscSF  migration   = NULL;
  PetscInt pEnd, cEnd, *number, *cell;

  PetscFunctionBegin;
  PetscCall(DMPlexGetChart(mesh->dm, NULL, &pEnd));
  PetscCall(PetscMalloc1(pEnd, &number));
  PetscCall(PetscMalloc1(pEnd, &cell));
  for (PetscInt p = 0; p < pEnd; p++) {
    number[p] = -1;
    cell[p]   = p < mesh->n_cells ? mesh->cell_numbers[p] : -1;
  }
  for (PetscInt v = 0; v < mesh->n_points; v++)
    number[mesh->points[v]] = mesh->numbers[v];
  PetscCall(PetscFree(mesh->points));
  PetscCall(DMPlexDistribute(mesh->dm, 0, &migration, &distributed));
  if (distributed) {
    PetscCall(DMPlexGetChart(distributed, NULL, &pEnd));
    PetscCall(send(migration, pEnd, &number));
    PetscCall(send(migration, pEnd, &cell));
    PetscCall(PetscSFDestroy(&migration));
    PetscCall(DMDestroy(&mesh->dm));
    mesh->dm = distributed;
  }
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, NULL, &cEnd));
  PetscCall(PetscMalloc1(pEnd, &mesh->points));
  PetscCall(PetscMalloc3(pEnd, &mesh->original, pEnd, &mesh->here, cEnd, &mesh->original_cell));
  PetscCall(PetscArraycpy(mesh->original_cell, cell, cEnd));
  mesh->n_points = 0;
  for (PetscInt p = 0; p < pEnd; p++) {
    mesh->here[p] = number[p] < 0 ? -1 : mesh->n_points;
    if (number[p] < 0) continue;
    mesh->points[mesh->n_points]     = p;
    mesh->original[mesh->n_points++] = number[p];
  }
  PetscCall(PetscFree(number));
  PetscCall(PetscFree(cell));
  PetscCall(mesh_measure(mesh));
  PetscFunctionReturn(PETSC_SUCCESS);
}
