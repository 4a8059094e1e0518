/* What one rank writes of the mesh: its cells and their vertices, in the order of their numbers, which on one rank is that of the
 * whole mesh; and fields of interfaces, which rank 0 has, where they are written. */
#include "output/output.h"

/* `order`: of n numbers, from the least */
static PetscErrorCode sorted(PetscInt n, const PetscInt numbers[], PetscInt order[])
{
  PetscInt *keys;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &keys));
  PetscCall(PetscArraycpy(keys, numbers, n));
  for (PetscInt k = 0; k < n; k++)
    order[k] = k;
  PetscCall(PetscSortIntWithArray(n, keys, order));
  PetscCall(PetscFree(keys));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode piece_create(const Physics *physics, Piece *piece)
{
  const Mesh        *mesh  = physics->mesh;
  const Cells       *cells = &physics->cells;
  const PetscScalar *coordinates, *u;
  Vec                vector;
  PetscFunctionBegin;
  *piece = (Piece){.n_points = mesh->n_points, .n_cells = cells->n};
  PetscCall(PetscMalloc4(piece->n_points, &piece->order, piece->n_points, &piece->place, piece->n_cells, &piece->cells,
                         cells->offsets[cells->n], &piece->connectivity));
  PetscCall(PetscMalloc2(3 * piece->n_points, &piece->displacements, 3 * piece->n_points, &piece->X));
  PetscCall(sorted(piece->n_points, mesh->original, piece->order));
  PetscCall(sorted(piece->n_cells, mesh->original_cell, piece->cells));
  piece->n_cells = 0;
  for (PetscInt k = 0; k < cells->n; k++) { /* rigid bodies are drawn by their surfaces */
    if (!mesh->bodies[cells->body[piece->cells[k]]].rigid) piece->cells[piece->n_cells++] = piece->cells[k];
  }
  for (PetscInt k = 0; k < piece->n_points; k++)
    piece->place[piece->order[k]] = k;
  for (PetscInt c = 0; c < cells->n; c++) {
    PetscInt n, nodes[CELL_NODES];
    PetscCall(plex_cell_nodes(mesh, c, &n, nodes));
    for (PetscInt a = 0; a < n; a++)
      piece->connectivity[cells->offsets[c] + a] = piece->place[mesh->here[nodes[a]]];
  }
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  for (PetscInt k = 0; k < piece->n_points; k++) {
    PetscInt at;
    PetscCall(unknowns_place(physics, piece->order[k], coordinates, piece->X + 3 * k, &at));
    PetscCall(PetscArraycpy(piece->displacements + 3 * k, u + at, 3));
  }
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode piece_destroy(Piece *piece)
{
  PetscFunctionBegin;
  PetscCall(PetscFree4(piece->order, piece->place, piece->cells, piece->connectivity));
  PetscCall(PetscFree2(piece->displacements, piece->X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From n nodes of each rank to the vertices here that they are. */
static PetscErrorCode create_map(const Mesh *mesh, PetscInt n, const PetscInt nodes[], PetscSF *sf)
{
  PetscInt     n_here, n_leaves = 0, *index, *registered, *mine, *leaves;
  PetscSFNode *remote;
  PetscSF      directory;
  PetscFunctionBegin;
  PetscCall(directory_create(mesh, n, nodes, &n_here, &directory));
  PetscCall(PetscMalloc3(2 * n, &index, 2 * n_here, &registered, 2 * mesh->n_points, &mine)); /* rank, number there */
  for (PetscInt k = 0; k < n; k++) {
    index[2 * k]     = mesh->rank;
    index[2 * k + 1] = k;
  }
  for (PetscInt k = 0; k < 2 * n_here; k++)
    registered[k] = -1;
  PetscCall(PetscSFReduceBegin(directory, MPIU_2INT, index, registered, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(directory, MPIU_2INT, index, registered, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&directory));
  PetscCall(directory_create(mesh, mesh->n_points, mesh->original, &n_here, &directory));
  PetscCall(PetscSFBcastBegin(directory, MPIU_2INT, registered, mine, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(directory, MPIU_2INT, registered, mine, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&directory));
  PetscCall(PetscMalloc1(mesh->n_points, &leaves));
  PetscCall(PetscMalloc1(mesh->n_points, &remote));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    if (mine[2 * k] < 0) continue;
    leaves[n_leaves]   = k;
    remote[n_leaves++] = (PetscSFNode){.rank = mine[2 * k], .index = mine[2 * k + 1]};
  }
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, sf));
  PetscCall(PetscSFSetGraph(*sf, n, n_leaves, leaves, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscFree3(index, registered, mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode piece_fetch(const Physics *physics, const Piece *piece, PetscInt n, const PetscInt nodes[], PetscInt width,
                           const double values[], double none, double at_points[])
{
  const Mesh  *mesh = physics->mesh;
  MPI_Datatype node;
  double      *here;
  PetscSF      sf;
  PetscFunctionBegin;
  PetscCall(create_map(mesh, n, nodes, &sf));
  PetscCall(PetscMalloc1(width * mesh->n_points, &here));
  for (PetscInt k = 0; k < width * mesh->n_points; k++)
    here[k] = none;
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)width, MPI_DOUBLE, &node));
  PetscCallMPI(MPI_Type_commit(&node));
  PetscCall(PetscSFBcastBegin(sf, node, values, here, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, node, values, here, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&node));
  PetscCall(PetscSFDestroy(&sf));
  for (PetscInt k = 0; k < width * mesh->n_points; k++)
    at_points[k] = here[width * piece->order[k / width] + k % width];
  PetscCall(PetscFree(here));
  PetscFunctionReturn(PETSC_SUCCESS);
}
