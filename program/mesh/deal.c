/* Whole numbers that every rank has for every other one. */
#include "mesh/mesh.h"

PetscErrorCode numbers_deal(const Mesh *mesh, const PetscMPIInt counts[], const PetscInt packed[], PetscInt *n, PetscInt **received)
{
  PetscMPIInt *starts, *from, *places, all = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc3(mesh->size, &starts, mesh->size, &from, mesh->size, &places));
  PetscCallMPI(MPI_Alltoall(counts, 1, MPI_INT, from, 1, MPI_INT, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0, at = 0; r < mesh->size; r++) {
    starts[r] = at;
    places[r] = all;
    at += counts[r];
    all += from[r];
  }
  *n = all;
  PetscCall(PetscMalloc1(all, received));
  PetscCallMPI(MPI_Alltoallv(packed, counts, starts, MPIU_INT, *received, from, places, MPIU_INT, PETSC_COMM_WORLD));
  PetscCall(PetscFree3(starts, from, places));
  PetscFunctionReturn(PETSC_SUCCESS);
}
