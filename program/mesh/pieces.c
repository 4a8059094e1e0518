/* What pieces of the mesh on several ranks have in common: who owns the vertices that several of them have, and how values come
 * from there. A vertex belongs to the first rank whose piece has it. Of each range of numbers one rank keeps who owns them. */
#include "mesh/mesh.h"

/* of numbers 0 to n, so many a rank */
static PetscInt range_of(const Mesh *mesh)
{
  return PetscMax((mesh->n_all_vertices + mesh->size - 1) / mesh->size, 1);
}

PetscErrorCode directory_create(const Mesh *mesh, PetscInt n, const PetscInt numbers[], PetscInt *n_here, PetscSF *sf)
{
  const PetscInt range = range_of(mesh);
  PetscSFNode   *remote;
  PetscFunctionBegin;
  *n_here = PetscMax(PetscMin(range, mesh->n_all_vertices - range * mesh->rank), 0);
  PetscCall(PetscMalloc1(n, &remote));
  for (PetscInt k = 0; k < n; k++)
    remote[k] = (PetscSFNode){.rank = numbers[k] / range, .index = numbers[k] % range};
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, sf));
  PetscCall(PetscSFSetGraph(*sf, *n_here, n, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank and vertex of the owners of these numbers, 2 each */
static PetscErrorCode look_up(const Mesh *mesh, PetscInt n, const PetscInt numbers[], PetscInt owners[])
{
  PetscInt n_here;
  PetscSF  directory;
  PetscFunctionBegin;
  PetscCall(directory_create(mesh, n, numbers, &n_here, &directory));
  PetscCall(PetscSFBcastBegin(directory, MPIU_2INT, mesh->owners, owners, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(directory, MPIU_2INT, mesh->owners, owners, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* from their owners to vertices of these numbers; `elsewhere`: only those that another rank owns */
static PetscErrorCode create_map(const Mesh *mesh, PetscInt n, const PetscInt numbers[], PetscBool elsewhere, PetscSF *sf)
{
  PetscInt     n_leaves = 0, *owners, *leaves;
  PetscSFNode *remote;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * n, &owners));
  PetscCall(PetscMalloc1(n, &leaves));
  PetscCall(PetscMalloc1(n, &remote));
  PetscCall(look_up(mesh, n, numbers, owners));
  for (PetscInt k = 0; k < n; k++) {
    if (elsewhere && owners[2 * k] == mesh->rank) continue;
    leaves[n_leaves]   = k;
    remote[n_leaves++] = (PetscSFNode){.rank = owners[2 * k], .index = owners[2 * k + 1]};
  }
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, sf));
  PetscCall(PetscSFSetGraph(*sf, mesh->n_vertices, n_leaves, leaves, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscFree(owners));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode pieces_fetch_create(const Mesh *mesh, PetscInt n, const PetscInt numbers[], PetscSF *sf)
{
  PetscFunctionBegin;
  PetscCall(create_map(mesh, n, numbers, PETSC_FALSE, sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode pieces_share(Mesh *mesh)
{
  PetscInt n_here, *mine;
  PetscSF  directory;
  PetscFunctionBegin;
  PetscCall(directory_create(mesh, mesh->n_vertices, mesh->numbers, &n_here, &directory));
  PetscCall(PetscMalloc1(2 * mesh->n_vertices, &mine));
  PetscCall(PetscMalloc1(2 * n_here, &mesh->owners));
  for (PetscInt v = 0; v < mesh->n_vertices; v++) {
    mine[2 * v]     = mesh->rank;
    mine[2 * v + 1] = v;
  }
  for (PetscInt k = 0; k < 2 * n_here; k++)
    mesh->owners[k] = PETSC_MAX_INT;
  PetscCall(PetscSFReduceBegin(directory, MPIU_2INT, mine, mesh->owners, MPI_MINLOC)); /* the least rank, with its vertex */
  PetscCall(PetscSFReduceEnd(directory, MPIU_2INT, mine, mesh->owners, MPI_MINLOC));
  PetscCall(PetscSFDestroy(&directory));
  PetscCall(PetscFree(mine));
  PetscCall(create_map(mesh, mesh->n_vertices, mesh->numbers, PETSC_TRUE, &mesh->shared));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode pieces_unite(const Mesh *mesh, PetscInt values[], MPI_Op operation)
{
  PetscInt *mine;
  PetscFunctionBegin;
  if (mesh->size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(mesh->n_vertices, &mine));
  PetscCall(PetscArraycpy(mine, values, mesh->n_vertices));
  PetscCall(PetscSFReduceBegin(mesh->shared, MPIU_INT, mine, values, operation));
  PetscCall(PetscSFReduceEnd(mesh->shared, MPIU_INT, mine, values, operation));
  PetscCall(PetscArraycpy(mine, values, mesh->n_vertices));
  PetscCall(PetscSFBcastBegin(mesh->shared, MPIU_INT, mine, values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(mesh->shared, MPIU_INT, mine, values, MPI_REPLACE));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode pieces_copy(const Mesh *mesh, PetscInt width, PetscReal values[])
{
  PetscReal   *mine;
  MPI_Datatype vertex;
  PetscFunctionBegin;
  if (mesh->size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)width, MPIU_REAL, &vertex));
  PetscCallMPI(MPI_Type_commit(&vertex));
  PetscCall(PetscMalloc1(width * mesh->n_vertices, &mine));
  PetscCall(PetscArraycpy(mine, values, width * mesh->n_vertices));
  PetscCall(PetscSFBcastBegin(mesh->shared, vertex, mine, values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(mesh->shared, vertex, mine, values, MPI_REPLACE));
  PetscCall(PetscFree(mine));
  PetscCallMPI(MPI_Type_free(&vertex));
  PetscFunctionReturn(PETSC_SUCCESS);
}
