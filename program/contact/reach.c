/* How far a part of the model may come: the size of all that interfaces may join to it, through others or not. */
#include "contact/contact.h"

/* A group of parts that an interface joins (physics/parts.c). */
static void add_group(Parts *parts, const PetscBool joined[])
{
  PetscInt *end = &parts->group_starts[parts->n_groups + 1];
  *end          = parts->group_starts[parts->n_groups++];
  for (PetscInt p = 0; p < parts->n; p++) {
    if (joined[p]) parts->grouped[(*end)++] = p;
  }
}

/* The parts that interfaces join: of each part the number of its cluster. */
static PetscErrorCode find_clusters(Contact *contact, PetscInt cluster[])
{
  Parts     *parts = &contact->physics->parts;
  PetscBool *joined;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(parts->n, &joined));
  PetscCall(PetscCalloc1(contact->n_interfaces + 1, &parts->group_starts));
  for (PetscInt p = 0; p < parts->n; p++)
    cluster[p] = p;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    PetscInt   first     = -1;
    PetscCall(PetscSFBcastBegin(interface->pieces, MPIU_INT, parts->of_piece, interface->part_of, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(interface->pieces, MPIU_INT, parts->of_piece, interface->part_of, MPI_REPLACE));
    PetscCall(PetscArrayzero(joined, parts->n));
    for (PetscInt k = 0; k < interface->n1 + interface->n2; k++)
      joined[interface->part_of[k]] = PETSC_TRUE;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, joined, (PetscMPIInt)parts->n, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
    if (contact->condensed) {
      PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(parts->group_starts[parts->n_groups] + parts->n), &parts->grouped));
      add_group(parts, joined);
    }
    for (PetscInt p = 0; p < parts->n; p++) {
      if (!joined[p]) continue;
      if (first < 0) first = p;
      trees_join(cluster, first, p);
    }
  }
  (void)trees_number(parts->n, cluster);
  PetscCall(PetscFree(joined));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* between parts_label() and parts_create() */
PetscErrorCode reach_measure(Contact *contact)
{
  const Mesh *mesh  = contact->mesh;
  Parts      *parts = &contact->physics->parts;
  Extent     *whole;   /* of each cluster */
  PetscInt   *cluster; /* of each part */

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(parts->n, &whole, parts->n, &cluster));
  PetscCall(find_clusters(contact, cluster));
  for (PetscInt p = 0; p < parts->n; p++)
    whole[p] = extent_of_nothing();
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    extent_add(&whole[cluster[parts->of_piece[v]]], mesh->coordinates + 3 * v);
  for (PetscInt p = 0; p < parts->n; p++)
    PetscCall(extent_of_all(&whole[p]));
  for (PetscInt p = 0; p < parts->n; p++) {
    parts->part[p].reach   = PetscSqrtReal(extent_diagonal_squared(&whole[cluster[p]]));
    parts->part[p].cluster = cluster[p];
  }
  PetscCall(PetscFree2(whole, cluster));
  PetscFunctionReturn(PETSC_SUCCESS);
}
