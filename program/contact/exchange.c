/* What all ranks do for an interface together: agree on what the library refuses; the vectors of a part's nodes from their owners, and
 * back to them. */
#include "contact/contact.h"

/* All ranks learn whether the library refused on any. The first of these says why, in the interface's numbers. */
PetscErrorCode contact_agree(Contact *contact, const Interface *interface, int32_t refused, PetscInt *status)
{
  struct {
    int refuses_not, rank;
  } first = {.refuses_not = !refused, .rank = contact->mesh->rank};
  PetscFunctionBegin;
  *status = refused;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_2INT, MPI_MINLOC, PETSC_COMM_WORLD));
  if (first.refuses_not) PetscFunctionReturn(PETSC_SUCCESS);
  if (contact->mesh->rank == first.rank)
    parts_translate(&interface->part, stickslip_last_error_message(), contact->refusal, sizeof(contact->refusal));
  PetscCallMPI(MPI_Bcast(status, 1, MPIU_INT, first.rank, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(contact->refusal, sizeof(contact->refusal), MPI_CHAR, first.rank, PETSC_COMM_WORLD));
  PetscCheck(*status >= 0, PETSC_COMM_WORLD, PETSC_ERR_LIB, "stickslip is at fault: %s", contact->refusal);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest value of all ranks, and what the rank that has it says of it, so many bytes. */
PetscErrorCode contact_largest(const Mesh *mesh, PetscReal *value, size_t bytes, void *what)
{
  struct {
    double value;
    int    rank;
  } largest = {.value = *value, .rank = mesh->rank};
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE_INT, MPI_MAXLOC, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(what, (PetscMPIInt)bytes, MPI_BYTE, largest.rank, PETSC_COMM_WORLD));
  *value = largest.value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Current positions, from the part's origin. */
void contact_positions(ContactPart *part)
{
  const PetscInt d = part->dimension;
  for (PetscInt k = 0; k < d * (part->n1 + part->n2); k++)
    part->x[k] = part->X[k] - part->origin[k % d] + PetscRealPart(part->gathered[k]);
}

void contact_vector(PetscInt dimension, const PetscScalar vectors[], PetscInt node, PetscReal v[3])
{
  for (int i = 0; i < 3; i++)
    v[i] = i < dimension ? PetscRealPart(vectors[dimension * node + i]) : 0;
}

/* Entries of local vectors, each as its owner has it. */
PetscErrorCode contact_fetch(PetscSF sf, Vec local, PetscScalar *to)
{
  const PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(local, &array));
  PetscCall(PetscSFBcastBegin(sf, MPIU_SCALAR, array, to, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_SCALAR, array, to, MPI_REPLACE));
  PetscCall(VecRestoreArrayRead(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_on_vertices(const Contact *contact, Vec local)
{
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(local));
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    PetscCall(contact_scatter(&contact->interfaces[i].part, contact->interfaces[i].part.forces, local, MPIU_SUM));
  PetscCall(unknowns_share(contact->physics, local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_gather(Contact *contact, Interface *interface, Vec local)
{
  ContactPart *part = &interface->part;
  PetscFunctionBegin;
  PetscCall(contact_fetch(part->sf, local, part->gathered));
  contact_positions(part);
  if (contact->condensed)
    PetscCall(PetscArraycpy(MULTIPLIERS_OF(part, part->gathered), part->lambda, part->components * part->n1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_scatter(const ContactPart *part, const PetscScalar *from, Vec local, MPI_Op operation)
{
  PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArray(local, &array));
  PetscCall(PetscSFReduceBegin(part->sf, MPIU_SCALAR, from, array, operation));
  PetscCall(PetscSFReduceEnd(part->sf, MPIU_SCALAR, from, array, operation));
  PetscCall(VecRestoreArray(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}
