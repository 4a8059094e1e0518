/* Temperatures to look at. */
#include "heat/heat.h"

PetscErrorCode heat_of_vertices(const Heat *heat, PetscReal temperatures[])
{
  const Mesh        *mesh = heat->mesh;
  const PetscScalar *now;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(heat->now, &now));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscInt at;
    PetscCall(PetscSectionGetOffset(heat->section, mesh->points[k], &at));
    temperatures[k] = PetscRealPart(now[at]);
  }
  PetscCall(VecRestoreArrayRead(heat->now, &now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode heat_temperature(const Heat *heat, PetscInt number, PetscReal *temperature)
{
  const Mesh *mesh = heat->mesh;
  PetscReal  *all;
  PetscFunctionBegin;
  *temperature = 0;
  PetscCall(PetscMalloc1(mesh->n_points, &all));
  PetscCall(heat_of_vertices(heat, all));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    if (!heat->physics->unknowns.ghost[k] && mesh->original[k] == number) *temperature = all[k];
  }
  PetscCall(PetscFree(all));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, temperature, 1, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
