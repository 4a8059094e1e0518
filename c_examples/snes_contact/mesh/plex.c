/* The mesh as one distributed DMPlex: rank 0 builds it with all its labels, PETSc partitions and sends it. */
#include "mesh/mesh.h"

PetscErrorCode plex_create(Mesh *mesh)
{
  DM      dm, interpolated;
  DMLabel body;

  PetscFunctionBegin;
  PetscCall(DMPlexCreate(PETSC_COMM_WORLD, &dm));
  PetscCall(DMSetDimension(dm, 3));
  PetscCall(DMPlexSetChart(dm, 0, mesh->n_cells + mesh->n_vertices));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    PetscCall(DMPlexSetConeSize(dm, c, mesh->cell_offsets[c + 1] - mesh->cell_offsets[c]));
  PetscCall(DMSetUp(dm));
  PetscCall(DMCreateLabel(dm, "celltype"));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt n = mesh->cell_offsets[c + 1] - mesh->cell_offsets[c];
    PetscInt       cone[8];
    for (PetscInt a = 0; a < n; a++)
      cone[a] = mesh->n_cells + mesh->cell_vertices[mesh->cell_offsets[c] + a];
    PetscCall(DMPlexInvertCell(n == 8 ? DM_POLYTOPE_HEXAHEDRON : DM_POLYTOPE_TETRAHEDRON, cone)); /* from VTK's order */
    PetscCall(DMPlexSetCone(dm, c, cone));
    PetscCall(DMPlexSetCellType(dm, c, n == 8 ? DM_POLYTOPE_HEXAHEDRON : DM_POLYTOPE_TETRAHEDRON));
  }
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    PetscCall(DMPlexSetCellType(dm, mesh->n_cells + v, DM_POLYTOPE_POINT));
  PetscCall(DMPlexSymmetrize(dm));
  PetscCall(DMPlexStratify(dm));
  PetscCall(DMSetCoordinateDim(dm, 3));
  PetscCall(DMPlexBuildCoordinatesFromCellList(dm, 3, mesh->coordinates));
  PetscCall(DMPlexInterpolate(dm, &interpolated)); /* adds edges and faces; keeps the numbers of cells and vertices */
  PetscCall(DMDestroy(&dm));
  PetscCall(DMCreateLabel(interpolated, "body"));
  PetscCall(DMGetLabel(interpolated, "body", &body));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    PetscCall(DMLabelSetValue(body, c, mesh->cell_body[c]));
  mesh->dm = interpolated;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `values` per vertex, or NULL for one `value` for all */
PetscErrorCode plex_label_vertices(DM dm, const char *name, PetscInt n, const PetscInt *vertices,
                                   const PetscInt *values, PetscInt value)
{
  DMLabel  label;
  PetscInt vStart;
  PetscFunctionBegin;
  PetscCall(DMCreateLabel(dm, name)); /* on every rank, also where it stays empty */
  PetscCall(DMGetLabel(dm, name, &label));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  for (PetscInt k = 0; k < n; k++)
    PetscCall(DMLabelSetValue(label, vStart + (vertices ? vertices[k] : k), values ? values[k] : value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode plex_label_faces(DM dm, const char *name, const Surface *surface)
{
  DMLabel  label;
  PetscInt vStart;
  PetscFunctionBegin;
  PetscCall(DMCreateLabel(dm, name));
  PetscCall(DMGetLabel(dm, name, &label));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, NULL));
  for (PetscInt f = 0; surface && f < surface->n_faces; f++) {
    const PetscInt  n = surface->offsets[f + 1] - surface->offsets[f];
    PetscInt        vertices[4], n_found;
    const PetscInt *found;
    for (PetscInt k = 0; k < n; k++)
      vertices[k] = vStart + surface->vertices[surface->offsets[f] + k];
    PetscCall(DMPlexGetFullJoin(dm, n, vertices, &n_found, &found));
    PetscCheck(n_found == 1, PETSC_COMM_SELF, PETSC_ERR_PLIB,
               "%" PetscInt_FMT " faces have the vertices of one face of '%s'", n_found, surface->name);
    PetscCall(DMLabelSetValue(label, found[0], 1));
    PetscCall(DMPlexRestoreJoin(dm, n, vertices, &n_found, &found));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Partition, send, and remember for each vertex here which mesh vertex it was on rank 0. */
PetscErrorCode plex_distribute(Mesh *mesh)
{
  DM       distributed = NULL;
  PetscSF  migration   = NULL;
  PetscInt pStart, pEnd, qStart, qEnd, vStart, *number, *received;

  PetscFunctionBegin;
  PetscCall(DMPlexGetChart(mesh->dm, &pStart, &pEnd));
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &vStart, NULL));
  PetscCall(PetscMalloc1(pEnd - pStart, &number));
  for (PetscInt p = pStart; p < pEnd; p++)
    number[p - pStart] = p - vStart;
  PetscCall(DMPlexDistribute(mesh->dm, 0, &migration, &distributed));
  if (distributed) {
    PetscCall(DMPlexGetChart(distributed, &qStart, &qEnd));
    PetscCall(PetscMalloc1(qEnd - qStart, &received));
    PetscCall(PetscSFBcastBegin(migration, MPIU_INT, number, received, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(migration, MPIU_INT, number, received, MPI_REPLACE));
    PetscCall(PetscSFDestroy(&migration));
    PetscCall(PetscFree(number));
    PetscCall(DMDestroy(&mesh->dm));
    mesh->dm = distributed;
    number    = received;
  }
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &mesh->vStart, &mesh->vEnd));
  PetscCall(PetscMalloc1(mesh->vEnd - mesh->vStart, &mesh->original));
  for (PetscInt v = mesh->vStart; v < mesh->vEnd; v++)
    mesh->original[v - mesh->vStart] = number[v];
  PetscCall(PetscFree(number));
  PetscFunctionReturn(PETSC_SUCCESS);
}
