/* Where an interface's nodes are at home: each rank keeps a range of the numbers of either side, as the surfaces were dealt out
 * (mesh/shares.c), and what is known of these nodes. Parts and others fetch it from there. */
#include "contact/contact.h"

/* n1 and n2 are known */
PetscErrorCode homes_create(const Mesh *mesh, Interface *interface)
{
  const PetscInt n[2] = {interface->n1, interface->n2};
  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) {
    PetscInt *starts;
    PetscCall(PetscMalloc1(mesh->size + 1, &starts));
    starts[0] = 0;
    PetscCallMPI(MPI_Allgather(&n[side], 1, MPIU_INT, starts + 1, 1, MPIU_INT, PETSC_COMM_WORLD));
    for (PetscMPIInt r = 0; r < mesh->size; r++)
      starts[r + 1] += starts[r];
    interface->starts[side] = starts;
    interface->first[side]  = starts[mesh->rank];
    interface->all[side]    = starts[mesh->size];
  }
  for (int side = 0; side < 2; side++) {
    const Surface *surface = interface->surface[side];
    const PetscInt n_corners = surface->analytic ? 0 : surface->offsets[surface->n_faces];
    PetscInt      *numbers;
    PetscCall(PetscMalloc1(n_corners, &numbers));
    for (PetscInt k = 0; k < n_corners; k++)
      numbers[k] = surface->vertices[k] + (side ? interface->all[0] : 0);
    PetscCall(homes_fetch_create(interface, n_corners, numbers, &interface->corners[side]));
    PetscCall(PetscFree(numbers));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode homes_destroy(Interface *interface)
{
  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) {
    PetscCall(PetscFree(interface->starts[side]));
    PetscCall(PetscSFDestroy(&interface->corners[side]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt homes_number(const Interface *interface, PetscInt k)
{
  return k < interface->n1 ? interface->first[0] + k : interface->all[0] + interface->first[1] + k - interface->n1;
}

/* the rank that a node is at home on, and its place among those there */
static PetscSFNode home_of(const Interface *interface, PetscMPIInt size, PetscInt number)
{
  const int       side   = number >= interface->all[0];
  const PetscInt *starts = interface->starts[side], k = number - (side ? interface->all[0] : 0);
  PetscMPIInt     low = 0, high = size; /* starts[low] <= k < starts[high] */
  while (high - low > 1) {
    const PetscMPIInt middle = (low + high) / 2;
    if (starts[middle] <= k)
      low = middle;
    else
      high = middle;
  }
  return (PetscSFNode){.rank = low, .index = k - starts[low] + (side ? interface->starts[0][low + 1] - interface->starts[0][low] : 0)};
}

PetscErrorCode homes_fetch_create(const Interface *interface, PetscInt n, const PetscInt numbers[], PetscSF *sf)
{
  PetscMPIInt  size;
  PetscSFNode *remote;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(PetscMalloc1(n, &remote));
  for (PetscInt k = 0; k < n; k++)
    remote[k] = home_of(interface, size, numbers[k]);
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, sf));
  PetscCall(PetscSFSetGraph(*sf, interface->n1 + interface->n2, n, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode homes_bcast(PetscSF sf, PetscInt width, const double from[], double to[])
{
  MPI_Datatype node;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)width, MPI_DOUBLE, &node));
  PetscCallMPI(MPI_Type_commit(&node));
  PetscCall(PetscSFBcastBegin(sf, node, from, to, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, node, from, to, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reference coordinates of the interface's nodes of these numbers. */
PetscErrorCode homes_coordinates(const Interface *interface, PetscInt n, const PetscInt numbers[], double X[])
{
  PetscSF sf;
  PetscFunctionBegin;
  PetscCall(homes_fetch_create(interface, n, numbers, &sf));
  PetscCall(homes_bcast(sf, interface->dimension, interface->X, X));
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscLogDouble homes_bytes(const Interface *interface)
{
  const PetscLogDouble vector = interface->dimension * 8.0, n1 = interface->n1, n = interface->n1 + interface->n2;
  /* nodes, place, prescribed, part_of; X, displacements, forces, equations; removed, middle, owner, copies; states */
  PetscLogDouble       bytes = n * (3 * sizeof(PetscInt) + 3 * sizeof(PetscReal) + 4 * vector) + n1 * 4 * sizeof(PetscInt);
  if (interface->states.state) bytes += n1 * (4 + 8 * (3 * 3 + 4));
  for (int side = 0; side < 2; side++) {
    const Surface *surface = interface->surface[side];
    if (surface->analytic) continue;
    bytes += (surface->n_faces + 1.0) * sizeof(PetscInt);
    bytes += (PetscLogDouble)surface->offsets[surface->n_faces] * (sizeof(PetscInt) + sizeof(PetscSFNode)); /* with where they are at home */
  }
  return bytes;
}
