/* How far a part of the model may come: the size of all that interfaces may join to it, through others or not. */
#include "contact/contact.h"

/* rank 0, between parts_label() and parts_create() */
PetscErrorCode reach_measure(Contact *contact)
{
  const Mesh *mesh  = contact->mesh;
  Parts      *parts = &contact->physics->parts;
  Extent     *whole;   /* of each cluster */
  PetscInt   *cluster; /* of each part */

  PetscFunctionBegin;
  if (mesh->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(parts->n, &whole, parts->n, &cluster));
  for (PetscInt p = 0; p < parts->n; p++) {
    whole[p]   = extent_of_nothing();
    cluster[p] = p;
  }
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    for (PetscInt k = 1; k < interface->n1 + interface->n2; k++)
      trees_join(cluster, parts->of_mesh[interface->nodes[0]], parts->of_mesh[interface->nodes[k]]);
  }
  (void)trees_number(parts->n, cluster);
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    extent_add(&whole[cluster[parts->of_mesh[v]]], mesh->coordinates + 3 * v);
  for (PetscInt p = 0; p < parts->n; p++)
    parts->part[p].reach = PetscSqrtReal(extent_diagonal_squared(&whole[cluster[p]]));
  PetscCall(PetscFree2(whole, cluster));
  PetscFunctionReturn(PETSC_SUCCESS);
}
