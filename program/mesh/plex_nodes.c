/* Points of the DMPlex that the nodes of a cell or of a face are. */
#include "mesh/mesh.h"

/* The point in the middle of n vertices: itself, or the edge, face or cell that they span. */
PetscErrorCode plex_amid(DM dm, PetscInt n, const PetscInt points[], PetscInt *point)
{
  PetscInt        n_found;
  const PetscInt *found;
  PetscFunctionBegin;
  *point = points[0];
  if (n == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMPlexGetFullJoin(dm, n, points, &n_found, &found));
  PetscCheck(n_found == 1, PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "%" PetscInt_FMT " points of the mesh have the same %" PetscInt_FMT " vertices", n_found, n);
  *point = found[0];
  PetscCall(DMPlexRestoreJoin(dm, n, points, &n_found, &found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a point's closure: how many nodes there are, and its vertices, in DMPlex's order. */
static PetscErrorCode closure_nodes(const Mesh *mesh, PetscInt point, PetscInt *n, PetscInt vertices[8])
{
  PetscInt *closure = NULL, size, vStart, vEnd, corners = 0;
  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(mesh->dm, 0, &vStart, &vEnd));
  PetscCall(DMPlexGetTransitiveClosure(mesh->dm, point, PETSC_TRUE, &size, &closure));
  *n = 0;
  for (PetscInt k = 0; k < size; k++) {
    const PetscInt p = closure[2 * k];
    *n += mesh->here[p] >= 0;
    if (p >= vStart && p < vEnd) vertices[corners++] = p;
  }
  PetscCall(DMPlexRestoreTransitiveClosure(mesh->dm, point, PETSC_TRUE, &size, &closure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode plex_cell_nodes(const Mesh *mesh, PetscInt cell, PetscInt *n, PetscInt points[])
{
  DMPolytopeType type;
  CellKind       kind;
  PetscFunctionBegin;
  PetscCall(closure_nodes(mesh, cell, n, points));
  PetscCall(DMPlexGetCellType(mesh->dm, cell, &type));
  PetscCall(DMPlexInvertCell(type, points)); /* to VTK's order */
  kind = cell_kind(mesh->dimension, *n);
  for (PetscInt a = cell_corners(kind); a < *n; a++) {
    PetscInt       its[CELL_CORNERS];
    const PetscInt count = cell_node_corners(kind, a, its);
    for (PetscInt k = 0; k < count; k++)
      its[k] = points[its[k]];
    PetscCall(plex_amid(mesh->dm, count, its, &points[a]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode plex_face_nodes(const Mesh *mesh, PetscInt face, PetscInt *n, PetscInt points[])
{
  CellKind kind;
  PetscFunctionBegin;
  PetscCall(closure_nodes(mesh, face, n, points));
  kind = cell_kind(mesh->dimension - 1, *n);
  for (PetscInt a = cell_corners(kind); a < *n; a++) {
    PetscInt       its[CELL_CORNERS];
    const PetscInt count = cell_node_corners(kind, a, its);
    for (PetscInt k = 0; k < count; k++)
      its[k] = points[its[k]];
    PetscCall(plex_amid(mesh->dm, count, its, &points[a]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode plex_labelled(const Mesh *mesh, const char *kind, const char *name, PetscInt *n, PetscInt **points)
{
  const PetscInt *found;
  char            label[2 * NAME_LENGTH];
  IS              is;
  PetscFunctionBegin;
  *n      = 0;
  *points = NULL;
  PetscCall(PetscSNPrintf(label, sizeof(label), "%s.%s", kind, name));
  PetscCall(DMGetStratumIS(mesh->dm, label, 1, &is));
  if (!is) PetscFunctionReturn(PETSC_SUCCESS); /* none on this rank */
  PetscCall(ISGetLocalSize(is, n));
  PetscCall(PetscMalloc1(*n, points));
  PetscCall(ISGetIndices(is, &found));
  PetscCall(PetscArraycpy(*points, found, *n));
  PetscCall(ISRestoreIndices(is, &found));
  PetscCall(ISDestroy(&is));
  PetscFunctionReturn(PETSC_SUCCESS);
}
