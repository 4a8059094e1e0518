/* What belongs together, as a forest: an entry is joined to another, and each tree gets a number. */
#include "mesh/mesh.h"

static PetscInt root_of(const PetscInt parent[], PetscInt v)
{
  while (parent[v] != v)
    v = parent[v];
  return v;
}

void trees_join(PetscInt parent[], PetscInt a, PetscInt b)
{
  a                      = root_of(parent, a);
  b                      = root_of(parent, b);
  parent[PetscMax(a, b)] = PetscMin(a, b); /* a root is the least of its tree */
}

/* Numbers go in order of the roots; a parent comes before its children, so that it has its
 * number already */
PetscInt trees_number(PetscInt n, PetscInt parent[])
{
  PetscInt count = 0;
  for (PetscInt v = 0; v < n; v++)
    parent[v] = parent[v] == v ? count++ : parent[parent[v]];
  return count;
}
