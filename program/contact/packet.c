/* Nodes and facets of a side, packed at their homes for the parts that have them, and out of the packets of all homes again. */
#include "contact/packet.h"

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

/* Of a node: its number in the interface, its vertex, its part of the model, whether the part counts it; of a non-mortar one which rank
 * owns it, its multiplier's removed components, whether it is in the middle of corners, which copy of its vertex it
 * is. */
enum { WIDTH_MORTAR = 4, WIDTH = 8 };

static int width(int which)
{
  return which ? WIDTH_MORTAR : WIDTH;
}

/* How many, and each of them; then the facets: how many, and of each its number, how many corners it has, their numbers. */
static PetscErrorCode pack(const Interface *interface, const Side *side, const PetscInt counts[], PetscInt bit, Packet *packet)
{
  const Surface *surface  = interface->surface[side->which];
  const PetscInt start    = side->which ? interface->n1 : 0, number = side->which ? interface->all[0] : 0;
  PetscInt       n[2]     = {0, 0};
  PetscFunctionBegin;
  for (PetscInt k = 0; k < side->n_nodes; k++)
    n[0] += (side->nodes[k] & bit) != 0;
  for (PetscInt f = 0; f < side->n_facets; f++)
    n[1] += (side->facets[f] & bit) != 0;
  if (!n[0] && !n[1]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(put(packet, 1, &n[0]));
  for (PetscInt k = 0; k < side->n_nodes; k++) {
    PetscInt entry[WIDTH] = {homes_number(interface, start + k), interface->nodes[start + k], interface->part_of[start + k],
                             (counts[k] & bit) != 0};
    if (!(side->nodes[k] & bit)) continue;
    if (!side->which) {
      entry[4] = interface->owner[k];
      entry[5] = interface->removed[k];
      entry[6] = interface->middle[k];
      entry[7] = interface->copies[k];
      entry[3] = entry[3] && !entry[7]; /* copies of a vertex are one node of the body */
    }
    PetscCall(put(packet, width(side->which), entry));
  }
  PetscCall(put(packet, 1, &n[1]));
  for (PetscInt f = 0; f < side->n_facets; f++) {
    const PetscInt head[2] = {surface->first + f, side->offsets[f + 1] - side->offsets[f]};
    if (!(side->facets[f] & bit)) continue;
    PetscCall(put(packet, 2, head));
    for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1]; k++) {
      const PetscInt corner = number + surface->vertices[k];
      PetscCall(put(packet, 1, &corner));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode side_deal(const Mesh *mesh, const Interface *interface, const Side *side, const PetscInt counts[], PetscMPIInt first,
                         PetscInt *n, PetscInt **received)
{
  const PetscMPIInt end    = (PetscMPIInt)PetscMin(first + RANKS_AT_ONCE, mesh->size);
  Packet            packet = {0};
  PetscMPIInt      *sizes;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(mesh->size, &sizes));
  for (PetscMPIInt r = first; r < end; r++) {
    const PetscInt before = packet.n;
    PetscCall(pack(interface, side, counts, (PetscInt)1 << (r - first), &packet));
    sizes[r] = (PetscMPIInt)(packet.n - before);
  }
  PetscCall(numbers_deal(mesh, sizes, packet.numbers, n, received));
  PetscCall(PetscFree(packet.numbers));
  PetscCall(PetscFree(sizes));
  if (mesh->rank < first || mesh->rank >= end) PetscCall(PetscFree(*received));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many nodes, facets and corners there are in all. */
static void count(PetscInt n, const PetscInt received[], int which, PetscInt n_nodes[1], PetscInt n_facets[1], PetscInt n_corners[1])
{
  *n_nodes = *n_facets = *n_corners = 0;
  for (PetscInt at = 0; at < n;) {
    PetscInt facets;
    *n_nodes += received[at];
    at += 1 + width(which) * received[at];
    facets = received[at++];
    *n_facets += facets;
    for (PetscInt f = 0; f < facets; f++) {
      *n_corners += received[at + 1];
      at += 2 + received[at + 1];
    }
  }
}

/* Room for more nodes behind those that there are. */
static PetscErrorCode reserve(ContactPart *part, PetscInt first, PetscInt n)
{
  PetscInt *vertices, *nodes, *piece, *counts;
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
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode side_unpack(PetscInt n, const PetscInt received[], int which, const Interface *interface, ContactPart *part)
{
  const PetscInt first = which ? part->n1 : 0;
  PetscInt       n_nodes, n_facets, n_corners, node = first, facet = 0, corner = 0;
  PetscFunctionBegin;
  count(n, received, which, &n_nodes, &n_facets, &n_corners);
  *(which ? &part->n2 : &part->n1) = n_nodes;
  part->n_facets[which]            = n_facets;
  part->first_mortar               = interface->all[0];
  PetscCall(reserve(part, first, n_nodes));
  if (!which)
    PetscCall(PetscMalloc6(n_nodes, &part->owner, n_nodes, &part->index, n_nodes, &part->removed, n_nodes, &part->middle, n_nodes,
                           &part->owned, n_nodes, &part->copies));
  PetscCall(PetscMalloc1(n_facets, &part->facets[which]));
  PetscCall(PetscMalloc1(n_facets + 1, &part->offsets[which]));
  PetscCall(PetscMalloc1(n_corners, &part->facet_nodes[which]));
  part->offsets[which][0] = 0;
  for (PetscInt at = 0; at < n;) {
    PetscInt left = received[at++];
    for (; left > 0; left--, node++, at += width(which)) {
      part->nodes[node]    = received[at];
      part->vertices[node] = received[at + 1];
      part->piece[node]    = received[at + 2];
      part->counts[node]   = received[at + 3];
      if (which) continue;
      part->owner[node]   = received[at + 4];
      part->removed[node] = received[at + 5];
      part->middle[node]  = (PetscBool)received[at + 6];
      part->copies[node]  = received[at + 7];
    }
    for (left = received[at++]; left > 0; left--, facet++) {
      part->facets[which][facet]      = received[at++];
      part->offsets[which][facet + 1] = part->offsets[which][facet] + received[at++];
      while (corner < part->offsets[which][facet + 1])
        part->facet_nodes[which][corner++] = received[at++];
    }
  }
  for (PetscInt k = 0; k < n_corners; k++) { /* in the part's numbers, which begin anew on each side */
    PetscInt place;
    PetscCall(PetscFindInt(part->facet_nodes[which][k], n_nodes, part->nodes + first, &place));
    PetscCheck(place >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a facet without its node");
    part->facet_nodes[which][k] = place;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
