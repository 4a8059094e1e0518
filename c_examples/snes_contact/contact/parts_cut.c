/* Rank 0 cuts an interface into parts and sends each rank its own (docs/plug_in.md, "Parts that own nodes").
 *
 * A part has the facets around its nodes, those around these, and so on: rings. How many the library needs depends on what
 * it does; only what it integrates costs work. The mortar side is there as a whole: without `search_distance` a pair may be
 * any distance apart. */
#include "contact/contact.h"

/* The library's three, and three more for bodies that start that many facets deep in each other (contact_create() looks). Facets
 * beyond the first ring are not integrated. */
enum { RINGS = 3 + PARTS_DEPTH };
/* The same where nodes carry others: all of them are integrated. */
enum { RINGS_OF_CARRIERS = 12 };

/* rank 0: one side of an interface, in the interface's numbers */
typedef struct {
  PetscInt        n_nodes, n_facets;
  const PetscInt *offsets;
  const PetscInt *nodes; /* of each facet */
} Side;

/* What a rank gets, packed: numbers and coordinates. */
typedef struct {
  PetscInt n, capacity, *numbers;
} Packet;

static PetscErrorCode put(Packet *packet, PetscInt n, const PetscInt numbers[])
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

static PetscErrorCode put_one(Packet *packet, PetscInt number)
{
  PetscFunctionBegin;
  PetscCall(put(packet, 1, &number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the next n numbers */
static PetscErrorCode take(Packet *packet, PetscInt n, PetscInt **numbers)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, numbers));
  PetscCall(PetscArraycpy(*numbers, packet->numbers + packet->n, n));
  packet->n += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt take_one(Packet *packet)
{
  return packet->numbers[packet->n++];
}

static PetscErrorCode side_create(const Interface *interface, int which, Side *side)
{
  const Surface  *surface = interface->surface[which];
  static PetscInt none    = 0;
  PetscFunctionBegin;
  *side = (Side){.n_nodes = which ? interface->n2 : interface->n1, .offsets = &none};
  if (surface->analytic) PetscFunctionReturn(PETSC_SUCCESS);
  side->n_facets = surface->n_faces;
  side->offsets  = surface->offsets;
  side->nodes    = surface->vertices;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks so many rings of facets around the nodes marked, and these facets' nodes. */
static PetscErrorCode mark_rings(const Side *side, PetscInt rings, PetscBool nodes[], PetscBool facets[])
{
  PetscBool *met;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(side->n_nodes, &met));
  for (PetscInt ring = 0; ring < rings; ring++) {
    PetscCall(PetscArraycpy(met, nodes, side->n_nodes));
    for (PetscInt f = 0; f < side->n_facets; f++) {
      for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1] && !facets[f]; k++)
        facets[f] = met[side->nodes[k]];
      for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1] && facets[f]; k++)
        nodes[side->nodes[k]] = PETSC_TRUE;
    }
  }
  PetscCall(PetscFree(met));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool carries(const stickslip_options *options)
{
  if (options->weak_coverage > 0) return PETSC_TRUE;
  return (PetscBool)(options->weak_coverage == 0 && options->multiplier_basis == STICKSLIP_BASIS_DUAL);
}

/* rank 0, while parts are cut */
typedef struct {
  const Interface *interface;
  const PetscInt  *owner; /* n1 */
  PetscInt        *index; /* n1: number of each node in its owner's part */
  PetscBool       *counted; /* n2: has a rank before */
  Side             sides[2];
  PetscBool       *nodes[2], *facets[2]; /* of the part at hand */
} Cut;

static PetscErrorCode cut_create(const Interface *interface, const PetscInt owner[], Cut *cut)
{
  PetscFunctionBegin;
  *cut = (Cut){.interface = interface, .owner = owner};
  for (int side = 0; side < 2; side++) {
    PetscCall(side_create(interface, side, &cut->sides[side]));
    PetscCall(PetscMalloc2(cut->sides[side].n_nodes, &cut->nodes[side], cut->sides[side].n_facets, &cut->facets[side]));
  }
  PetscCall(PetscMalloc1(interface->n1, &cut->index));
  PetscCall(PetscCalloc1(interface->n2, &cut->counted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode cut_destroy(Cut *cut)
{
  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) {
    PetscCall(PetscFree2(cut->nodes[side], cut->facets[side]));
  }
  PetscCall(PetscFree(cut->index));
  PetscCall(PetscFree(cut->counted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks what the part of a rank has; returns whether it has anything. */
static PetscErrorCode mark_part(Cut *cut, PetscMPIInt rank, PetscBool *any)
{
  const Interface *interface = cut->interface;
  PetscFunctionBegin;
  *any = PETSC_FALSE;
  for (PetscInt a = 0; a < interface->n1; a++) {
    cut->nodes[0][a] = (PetscBool)(cut->owner[a] == rank);
    *any             = (PetscBool)(*any || cut->nodes[0][a]);
  }
  PetscCall(PetscArrayzero(cut->facets[0], cut->sides[0].n_facets));
  PetscCall(mark_rings(&cut->sides[0], carries(&interface->options) ? RINGS_OF_CARRIERS : RINGS, cut->nodes[0], cut->facets[0]));
  for (PetscInt b = 0; b < interface->n2; b++)
    cut->nodes[1][b] = *any;
  for (PetscInt f = 0; f < cut->sides[1].n_facets; f++)
    cut->facets[1][f] = *any;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The marked facets of a side: how many, their numbers, offsets, nodes in the part's numbers. */
static PetscErrorCode put_facets(const Cut *cut, int which, Packet *packet)
{
  const Side *side = &cut->sides[which];
  PetscInt   *number, n = 0, at = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(side->n_nodes, &number));
  for (PetscInt k = 0; k < side->n_nodes; k++)
    number[k] = cut->nodes[which][k] ? n++ : -1;
  n = 0;
  for (PetscInt f = 0; f < side->n_facets; f++)
    n += cut->facets[which][f];
  PetscCall(put_one(packet, n));
  for (PetscInt f = 0; f < side->n_facets; f++) {
    if (cut->facets[which][f]) PetscCall(put_one(packet, f));
  }
  PetscCall(put_one(packet, 0));
  for (PetscInt f = 0; f < side->n_facets; f++) {
    if (cut->facets[which][f]) PetscCall(put_one(packet, at += side->offsets[f + 1] - side->offsets[f]));
  }
  for (PetscInt f = 0; f < side->n_facets; f++) {
    for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1] && cut->facets[which][f]; k++)
      PetscCall(put_one(packet, number[side->nodes[k]]));
  }
  PetscCall(PetscFree(number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part that is marked, as unpack() has it. */
static PetscErrorCode pack(Cut *cut, PetscMPIInt rank, Packet *packet)
{
  const Interface *interface = cut->interface;
  const PetscInt   n[2]      = {interface->n1, interface->n2};
  PetscInt         counts[2] = {0, 0};
  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) {
    for (PetscInt k = 0; k < n[side]; k++)
      counts[side] += cut->nodes[side][k];
  }
  PetscCall(put(packet, 2, counts));
  PetscCall(put_one(packet, interface->n1));
  for (int side = 0; side < 2; side++) {
    for (PetscInt k = 0; k < n[side]; k++) {
      const PetscInt node = side ? interface->n1 + k : k, vertex = interface->nodes[node];
      const PetscBool counts_here = (PetscBool)(side ? !cut->counted[k] : cut->owner[k] == rank);
      const PetscInt  entry[]     = {vertex, node, interface->part_of[node], counts_here};
      if (!cut->nodes[side][k]) continue;
      PetscCall(put(packet, 4, entry));
      if (side) cut->counted[k] = PETSC_TRUE;
    }
  }
  for (PetscInt a = 0; a < interface->n1; a++) {
    const PetscInt entry[] = {cut->owner[a], cut->index[a], interface->removed[a], interface->middle[a]};
    if (cut->nodes[0][a]) PetscCall(put(packet, 4, entry));
  }
  for (int side = 0; side < 2; side++)
    PetscCall(put_facets(cut, side, packet));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode unpack(Packet *packet, PetscMPIInt rank, ContactPart *part)
{
  PetscInt n;
  PetscFunctionBegin;
  packet->n          = 0;
  part->n1           = take_one(packet);
  part->n2           = take_one(packet);
  part->first_mortar = take_one(packet);
  n                  = part->n1 + part->n2;
  PetscCall(PetscMalloc4(n, &part->vertices, n, &part->nodes, n, &part->piece, n, &part->counts));
  for (PetscInt k = 0; k < n; k++) {
    part->vertices[k] = take_one(packet);
    part->nodes[k]    = take_one(packet);
    part->piece[k]    = take_one(packet);
    part->counts[k]   = take_one(packet);
  }
  PetscCall(PetscMalloc5(part->n1, &part->owner, part->n1, &part->index, part->n1, &part->removed, part->n1, &part->middle,
                         part->n1, &part->owned));
  for (PetscInt a = 0; a < part->n1; a++) {
    part->owner[a]   = take_one(packet);
    part->index[a]   = take_one(packet);
    part->removed[a] = take_one(packet);
    part->middle[a]  = (PetscBool)take_one(packet);
    part->owned[a]   = part->owner[a] == rank ? STICKSLIP_NODE_OWN : STICKSLIP_NODE_ELSEWHERE;
  }
  for (int side = 0; side < 2; side++) {
    part->n_facets[side] = take_one(packet);
    PetscCall(take(packet, part->n_facets[side], &part->facets[side]));
    PetscCall(take(packet, part->n_facets[side] + 1, &part->offsets[side]));
    PetscCall(take(packet, part->offsets[side][part->n_facets[side]], &part->facet_nodes[side]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* n numbers and real numbers from rank 0 to another one, where they are allocated */
static PetscErrorCode transfer(const Mesh *mesh, PetscMPIInt to, Packet *packet)
{
  enum { TAG = 21 };
  PetscFunctionBegin;
  if (to == 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (mesh->rank == 0) {
    PetscCallMPI(MPI_Send(packet->numbers, (PetscMPIInt)packet->n, MPIU_INT, to, TAG, PETSC_COMM_WORLD));
  } else {
    PetscMPIInt n;
    MPI_Status  status;
    PetscCallMPI(MPI_Probe(0, TAG, PETSC_COMM_WORLD, &status));
    PetscCallMPI(MPI_Get_count(&status, MPIU_INT, &n));
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)n, &packet->numbers));
    PetscCallMPI(MPI_Recv(packet->numbers, n, MPIU_INT, 0, TAG, PETSC_COMM_WORLD, MPI_STATUS_IGNORE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The maps between the parts' nodes. */
static PetscErrorCode create_maps(const Interface *interface, const PetscInt owner[], const PetscInt index[],
                                  PetscMPIInt rank, ContactPart *part)
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
    remote[a] = (PetscSFNode){.rank = owner[a], .index = index[a]};
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, &part->whole));
  PetscCall(PetscSFSetGraph(part->whole, part->n1, n, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* owner: rank 0, of the n1 nodes */
PetscErrorCode parts_cut(Contact *contact, PetscInt number, const PetscInt owner[])
{
  const Mesh  *mesh      = contact->mesh;
  Interface   *interface = &contact->interfaces[number];
  ContactPart *part      = &interface->part;
  Packet       packet    = {0};
  Cut          cut       = {0};
  PetscBool    any;
  PetscMPIInt  size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  part->dimension    = interface->dimension;
  part->components   = interface->components;
  interface->n_parts = 0;
  if (mesh->rank == 0) {
    PetscCall(cut_create(interface, owner, &cut));
    for (PetscMPIInt r = 0; r < size; r++) { /* where owners have their nodes */
      PetscInt n = 0;
      PetscCall(mark_part(&cut, r, &any));
      interface->n_parts += any;
      for (PetscInt a = 0; a < interface->n1; a++) {
        if (owner[a] == r) cut.index[a] = n;
        n += cut.nodes[0][a];
      }
    }
    for (PetscMPIInt r = size - 1; r >= 0; r--) { /* its own part stays in the packet */
      packet.n = 0;
      PetscCall(mark_part(&cut, r, &any));
      PetscCall(pack(&cut, r, &packet));
      PetscCall(transfer(mesh, r, &packet));
    }
  } else {
    PetscCall(transfer(mesh, mesh->rank, &packet));
  }
  PetscCallMPI(MPI_Bcast(&interface->n_parts, 1, MPIU_INT, 0, PETSC_COMM_WORLD));
  PetscCall(unpack(&packet, mesh->rank, part));
  PetscCall(create_maps(interface, owner, cut.index, mesh->rank, part));
  PetscCall(PetscFree(packet.numbers));
  if (mesh->rank == 0) PetscCall(cut_destroy(&cut));
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
