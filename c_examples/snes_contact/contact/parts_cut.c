/* Rank 0 cuts the non-mortar side of an interface into parts and sends each rank its own (docs/plug_in.md, "Parts that own
 * nodes").
 *
 * A part has the facets around its nodes, those around these, and so on: rings. How many the library needs depends on what
 * it does; only what it integrates costs work. */
#include "contact/packet.h"

/* The library's three, and one more for bodies that start that many facets deep in each other (contact_setup.c looks). Facets
 * beyond the first ring are not integrated. */
enum { RINGS = 3 + PARTS_DEPTH };
/* The same where nodes carry others: all of them are integrated. */
enum { RINGS_OF_CARRIERS = 12 };

static PetscBool carries(const stickslip_options *options)
{
  if (options->weak_coverage > 0) return PETSC_TRUE;
  return (PetscBool)(options->weak_coverage == 0 && options->multiplier_basis == STICKSLIP_BASIS_DUAL);
}

/* Marks what the part of a rank has; returns whether it has anything. */
static PetscErrorCode mark_part(Side *side, const Interface *interface, PetscMPIInt rank, PetscBool *any)
{
  PetscFunctionBegin;
  *any = PETSC_FALSE;
  for (PetscInt a = 0; a < side->n_nodes; a++) {
    side->nodes[a] = (PetscBool)(interface->owner[a] == rank);
    *any           = (PetscBool)(*any || side->nodes[a]);
  }
  PetscCall(PetscArrayzero(side->facets, side->n_facets));
  PetscCall(side_mark_rings(side, (carries(&interface->options) ? RINGS_OF_CARRIERS : RINGS) + interface->further_rings));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part that is marked, as unpack() has it; `index`: number of each node in its owner's part. */
static PetscErrorCode pack(const Side *side, const Interface *interface, PetscMPIInt rank, const PetscInt index[], Packet *packet)
{
  PetscBool *counts;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(side->n_nodes, &counts));
  for (PetscInt a = 0; a < side->n_nodes; a++)
    counts[a] = (PetscBool)(interface->owner[a] == rank);
  PetscCall(packet_put_one(packet, interface->n1));
  PetscCall(side_pack(side, interface, counts, packet));
  for (PetscInt a = 0; a < side->n_nodes; a++) {
    const PetscInt entry[] = {interface->owner[a], index[a], interface->removed[a], interface->middle[a]};
    if (side->nodes[a]) PetscCall(packet_put(packet, 4, entry));
  }
  PetscCall(PetscFree(counts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode unpack(Packet *packet, PetscMPIInt rank, ContactPart *part)
{
  PetscFunctionBegin;
  part->first_mortar = packet_take_one(packet);
  PetscCall(side_unpack(packet, 0, part));
  PetscCall(PetscMalloc5(part->n1, &part->owner, part->n1, &part->index, part->n1, &part->removed, part->n1, &part->middle,
                         part->n1, &part->owned));
  for (PetscInt a = 0; a < part->n1; a++) {
    part->owner[a]   = packet_take_one(packet);
    part->index[a]   = packet_take_one(packet);
    part->removed[a] = packet_take_one(packet);
    part->middle[a]  = (PetscBool)packet_take_one(packet);
    part->owned[a]   = part->owner[a] == rank ? STICKSLIP_NODE_OWN : STICKSLIP_NODE_ELSEWHERE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The maps between the parts' nodes. */
static PetscErrorCode create_maps(const Interface *interface, const PetscInt index[], PetscMPIInt rank, ContactPart *part)
{
  PetscInt     n = 0, *leaves;
  PetscSFNode *remote;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(part->n1, &leaves));
  PetscCall(PetscMalloc1(part->n1, &remote));
  for (PetscInt a = 0; a < part->n1; a++) {
    if (part->owner[a] == rank) continue;
    leaves[n]   = a;
    remote[n++] = (PetscSFNode){.rank = part->owner[a], .index = part->index[a]};
  }
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, &part->owners));
  PetscCall(PetscSFSetGraph(part->owners, part->n1, n, leaves, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  n = rank ? 0 : interface->n1;
  PetscCall(PetscMalloc1(n, &remote));
  for (PetscInt a = 0; a < n; a++)
    remote[a] = (PetscSFNode){.rank = interface->owner[a], .index = index[a]};
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, &part->whole));
  PetscCall(PetscSFSetGraph(part->whole, part->n1, n, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: how many parts there are, and the number of each node in its owner's */
static PetscErrorCode number(Side *side, Interface *interface, PetscMPIInt size, PetscInt index[])
{
  PetscBool any;
  PetscFunctionBegin;
  for (PetscMPIInt r = 0; r < size; r++) {
    PetscInt n = 0;
    PetscCall(mark_part(side, interface, r, &any));
    interface->n_parts += any;
    for (PetscInt a = 0; a < side->n_nodes; a++) {
      if (interface->owner[a] == r) index[a] = n;
      n += side->nodes[a];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By interface->owner. */
PetscErrorCode parts_cut(Contact *contact, Interface *interface)
{
  const Mesh  *mesh   = contact->mesh;
  ContactPart *part   = &interface->part;
  Packet       packet = {0};
  Side         side;
  PetscInt    *index;
  PetscBool    any;
  PetscMPIInt  size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  part->dimension    = interface->dimension;
  part->components   = interface->components;
  interface->n_parts = 0;
  PetscCall(PetscMalloc1(interface->n1, &index));
  if (mesh->rank == 0) {
    PetscCall(side_create(interface, 0, &side));
    PetscCall(number(&side, interface, size, index));
    for (PetscMPIInt r = size - 1; r >= 0; r--) { /* its own part stays in the packet */
      packet.n = 0;
      PetscCall(mark_part(&side, interface, r, &any));
      PetscCall(pack(&side, interface, r, index, &packet));
      PetscCall(packet_transfer(mesh, r, &packet));
    }
    PetscCall(side_destroy(&side));
  } else {
    PetscCall(packet_transfer(mesh, mesh->rank, &packet));
  }
  PetscCallMPI(MPI_Bcast(&interface->n_parts, 1, MPIU_INT, 0, PETSC_COMM_WORLD));
  PetscCall(unpack(&packet, mesh->rank, part));
  PetscCall(create_maps(interface, index, mesh->rank, part));
  PetscCall(PetscFree(packet.numbers));
  PetscCall(PetscFree(index));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode parts_destroy(ContactPart *part)
{
  PetscFunctionBegin;
  PetscCall(PetscSFDestroy(&part->owners));
  PetscCall(PetscSFDestroy(&part->whole));
  PetscCall(PetscFree4(part->vertices, part->nodes, part->piece, part->counts));
  PetscCall(PetscFree5(part->owner, part->index, part->removed, part->middle, part->owned));
  for (int side = 0; side < 2; side++) {
    PetscCall(PetscFree(part->facets[side]));
    PetscCall(PetscFree(part->offsets[side]));
    PetscCall(PetscFree(part->facet_nodes[side]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
