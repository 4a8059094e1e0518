/* A box along the axes around some points. */
#include "mesh/mesh.h"

Extent extent_of_nothing(void)
{
  const Extent nothing = {{PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, {PETSC_MIN_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL}};
  return nothing;
}

void extent_add(Extent *extent, const PetscReal x[3])
{
  for (int i = 0; i < 3; i++) {
    extent->low[i]  = PetscMin(extent->low[i], x[i]);
    extent->high[i] = PetscMax(extent->high[i], x[i]);
  }
}

PetscReal extent_longest(const Extent *extent)
{
  PetscReal longest = 0;
  for (int i = 0; i < 3 && extent->low[0] <= extent->high[0]; i++)
    longest = PetscMax(longest, extent->high[i] - extent->low[i]);
  return longest;
}

PetscReal extent_diagonal_squared(const Extent *extent)
{
  PetscReal squared = 0;
  for (int i = 0; i < 3; i++)
    squared += PetscSqr(extent->high[i] - extent->low[i]);
  return squared;
}

PetscErrorCode extent_of_all(Extent *extent)
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, extent->low, 3, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, extent->high, 3, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
