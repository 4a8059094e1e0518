/* What rank 0 knows of an interface's surfaces, and sends to other ranks: whole numbers, packed. */
#include "contact/packet.h"

PetscErrorCode packet_put(Packet *packet, PetscInt n, const PetscInt numbers[])
{
  PetscFunctionBegin;
  if (packet->n + n > packet->capacity) {
    packet->capacity = 2 * (packet->n + n);
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)packet->capacity, &packet->numbers));
  }
  PetscCall(PetscArraycpy(packet->numbers + packet->n, numbers, n));
  packet->n += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode packet_put_one(Packet *packet, PetscInt number)
{
  PetscFunctionBegin;
  PetscCall(packet_put(packet, 1, &number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode packet_take(Packet *packet, PetscInt n, PetscInt **numbers)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, numbers));
  PetscCall(PetscArraycpy(*numbers, packet->numbers + packet->n, n));
  packet->n += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt packet_take_one(Packet *packet)
{
  return packet->numbers[packet->n++];
}

PetscErrorCode packet_transfer(const Mesh *mesh, PetscMPIInt to, Packet *packet)
{
  enum { TAG = 21 };
  PetscFunctionBegin;
  if (mesh->rank == 0 && to != 0) PetscCallMPI(MPI_Send(packet->numbers, (PetscMPIInt)packet->n, MPIU_INT, to, TAG, PETSC_COMM_WORLD));
  if (mesh->rank == to && to != 0) {
    PetscMPIInt n;
    MPI_Status  status;
    PetscCallMPI(MPI_Probe(0, TAG, PETSC_COMM_WORLD, &status));
    PetscCallMPI(MPI_Get_count(&status, MPIU_INT, &n));
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)n, &packet->numbers));
    PetscCallMPI(MPI_Recv(packet->numbers, n, MPIU_INT, 0, TAG, PETSC_COMM_WORLD, MPI_STATUS_IGNORE));
  }
  if (mesh->rank == to) packet->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode side_create(const Interface *interface, int which, Side *side)
{
  const Surface  *surface = interface->surface[which];
  static PetscInt none    = 0;
  PetscFunctionBegin;
  *side = (Side){.which = which, .n_nodes = which ? interface->n2 : interface->n1, .offsets = &none};
  if (!surface->analytic) {
    side->n_facets  = surface->n_faces;
    side->offsets   = surface->offsets;
    side->of_facets = surface->vertices;
  }
  PetscCall(PetscCalloc2(side->n_nodes, &side->nodes, side->n_facets, &side->facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode side_destroy(Side *side)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(side->nodes, side->facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode side_mark_rings(Side *side, PetscInt rings)
{
  PetscBool *met;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(side->n_nodes, &met));
  for (PetscInt ring = 0; ring < rings; ring++) {
    PetscCall(PetscArraycpy(met, side->nodes, side->n_nodes));
    for (PetscInt f = 0; f < side->n_facets; f++) {
      for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1] && !side->facets[f]; k++)
        side->facets[f] = met[side->of_facets[k]];
      for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1] && side->facets[f]; k++)
        side->nodes[side->of_facets[k]] = PETSC_TRUE;
    }
  }
  PetscCall(PetscFree(met));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The marked facets: how many, their numbers, offsets, nodes in the part's numbers. */
static PetscErrorCode pack_facets(const Side *side, Packet *packet)
{
  PetscInt *number, n = 0, at = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(side->n_nodes, &number));
  for (PetscInt k = 0; k < side->n_nodes; k++)
    number[k] = side->nodes[k] ? n++ : -1;
  n = 0;
  for (PetscInt f = 0; f < side->n_facets; f++)
    n += side->facets[f];
  PetscCall(packet_put_one(packet, n));
  for (PetscInt f = 0; f < side->n_facets; f++) {
    if (side->facets[f]) PetscCall(packet_put_one(packet, f));
  }
  PetscCall(packet_put_one(packet, 0));
  for (PetscInt f = 0; f < side->n_facets; f++) {
    if (side->facets[f]) PetscCall(packet_put_one(packet, at += side->offsets[f + 1] - side->offsets[f]));
  }
  for (PetscInt f = 0; f < side->n_facets; f++) {
    for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1] && side->facets[f]; k++)
      PetscCall(packet_put_one(packet, number[side->of_facets[k]]));
  }
  PetscCall(PetscFree(number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode side_pack(const Side *side, const Interface *interface, const PetscBool counts[], Packet *packet)
{
  const PetscInt first = side->which ? interface->n1 : 0;
  PetscInt       n     = 0;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < side->n_nodes; k++)
    n += side->nodes[k];
  PetscCall(packet_put_one(packet, n));
  for (PetscInt k = 0; k < side->n_nodes; k++) {
    const PetscInt entry[] = {interface->nodes[first + k], first + k, interface->part_of[first + k], counts[k]};
    if (side->nodes[k]) PetscCall(packet_put(packet, 4, entry));
  }
  PetscCall(pack_facets(side, packet));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mortar side comes behind the non-mortar one. */
PetscErrorCode side_unpack(Packet *packet, int which, ContactPart *part)
{
  const PetscInt first = which ? part->n1 : 0, n = packet_take_one(packet);
  PetscInt      *vertices, *nodes, *piece, *counts;
  PetscFunctionBegin;
  PetscCall(PetscMalloc4(first + n, &vertices, first + n, &nodes, first + n, &piece, first + n, &counts));
  PetscCall(PetscArraycpy(vertices, part->vertices, first));
  PetscCall(PetscArraycpy(nodes, part->nodes, first));
  PetscCall(PetscArraycpy(piece, part->piece, first));
  PetscCall(PetscArraycpy(counts, part->counts, first));
  PetscCall(PetscFree4(part->vertices, part->nodes, part->piece, part->counts));
  part->vertices = vertices;
  part->nodes    = nodes;
  part->piece    = piece;
  part->counts   = counts;
  for (PetscInt k = first; k < first + n; k++) {
    vertices[k] = packet_take_one(packet);
    nodes[k]    = packet_take_one(packet);
    piece[k]    = packet_take_one(packet);
    counts[k]   = packet_take_one(packet);
  }
  *(which ? &part->n2 : &part->n1) = n;
  part->n_facets[which] = packet_take_one(packet);
  PetscCall(packet_take(packet, part->n_facets[which], &part->facets[which]));
  PetscCall(packet_take(packet, part->n_facets[which] + 1, &part->offsets[which]));
  PetscCall(packet_take(packet, part->offsets[which][part->n_facets[which]], &part->facet_nodes[which]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
