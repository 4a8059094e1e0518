/* Whole numbers on their way from rank 0 to the others (packet.c), and one side of an interface in the interface's numbers. */
#ifndef SNES_CONTACT_PACKET_H
#define SNES_CONTACT_PACKET_H
#include "contact/contact.h"

typedef struct {
  PetscInt n, capacity, *numbers;
} Packet;

PetscErrorCode packet_put(Packet *packet, PetscInt n, const PetscInt numbers[]);
PetscErrorCode packet_put_one(Packet *packet, PetscInt number);
PetscErrorCode packet_take(Packet *packet, PetscInt n, PetscInt **numbers); /* the next n, in new memory */
PetscInt       packet_take_one(Packet *packet);
PetscErrorCode packet_transfer(const Mesh *mesh, PetscMPIInt to, Packet *packet); /* from rank 0; then nothing is taken yet */

/* rank 0 */
typedef struct {
  PetscInt        which; /* 0: non-mortar, 1: mortar */
  PetscInt        n_nodes, n_facets;
  const PetscInt *offsets, *of_facets; /* nodes of each facet */
  PetscBool      *nodes, *facets;      /* those marked: of the part at hand */
} Side;

PetscErrorCode side_create(const Interface *interface, int which, Side *side);
PetscErrorCode side_destroy(Side *side);
/* marks so many rings of facets around the nodes marked, and these facets' nodes */
PetscErrorCode side_mark_rings(Side *side, PetscInt rings);
/* the marked nodes: how many, and of each its number in the interface, its vertex, its part of the model, and whether it `counts`
 * (n_nodes); then the marked facets, and to the part what side_pack() has put */
PetscErrorCode side_pack(const Side *side, const Interface *interface, const PetscBool counts[], Packet *packet);
PetscErrorCode side_unpack(Packet *packet, int which, ContactPart *part);
#endif
