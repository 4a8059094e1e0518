/* The non-mortar side of an interface, cut into parts at its nodes' homes: each rank gets its own (docs/host_parallel.md, "Parts that own
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

static PetscBool carries(const stickslip_method *method)
{
  if (method->weak_coverage > 0) return PETSC_TRUE;
  return (PetscBool)(method->weak_coverage == 0 && method->multiplier_basis == STICKSLIP_BASIS_DUAL);
}

/* The part's nodes, and what comes with them: by interface->owner. */
static PetscErrorCode deal(const Mesh *mesh, Interface *interface)
{
  const PetscInt rings = (carries(&interface->method) ? RINGS_OF_CARRIERS : RINGS) + interface->further_rings;
  PetscInt       n = 0, *received = NULL, *counts;
  Side           side;
  PetscFunctionBegin;
  PetscCall(side_create(interface, 0, &side));
  PetscCall(PetscMalloc1(side.n_nodes, &counts));
  for (PetscMPIInt first = 0; first < mesh->size; first += RANKS_AT_ONCE) {
    PetscInt  m;
    PetscInt *mine;
    PetscCall(side_clear(interface, &side));
    for (PetscInt a = 0; a < side.n_nodes; a++) {
      const PetscInt r = interface->owner[a] - first;
      counts[a] = side.nodes[a] = r >= 0 && r < RANKS_AT_ONCE ? (PetscInt)1 << r : 0;
    }
    PetscCall(side_mark_rings(&side, rings));
    PetscCall(side_deal(mesh, interface, &side, counts, first, &m, &mine));
    if (mine) n = m, received = mine;
  }
  PetscCall(side_unpack(n, received, 0, interface, &interface->part));
  PetscCall(PetscFree(received));
  PetscCall(PetscFree(counts));
  PetscCall(side_destroy(&side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* part->index, and at home the same of each node in its owner's part */
static PetscErrorCode number(const Mesh *mesh, const Interface *interface, PetscSF homes, PetscInt index[])
{
  const ContactPart *part = &interface->part;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < interface->n1 + interface->n2; k++)
    index[k] = -1;
  for (PetscInt a = 0; a < part->n1; a++)
    part->index[a] = part->owner[a] == mesh->rank ? a : -1;
  PetscCall(PetscSFReduceBegin(homes, MPIU_INT, part->index, index, MPI_MAX));
  PetscCall(PetscSFReduceEnd(homes, MPIU_INT, part->index, index, MPI_MAX));
  PetscCall(PetscSFBcastBegin(homes, MPIU_INT, index, part->index, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(homes, MPIU_INT, index, part->index, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The maps between the parts' nodes, and from these to homes. */
static PetscErrorCode create_maps(const Mesh *mesh, Interface *interface)
{
  ContactPart *part = &interface->part;
  PetscInt     n = 0, *leaves, *index;
  PetscSFNode *remote;
  PetscSF      homes;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(interface->n1 + interface->n2, &index));
  PetscCall(homes_fetch_create(interface, part->n1, part->nodes, &homes));
  PetscCall(number(mesh, interface, homes, index));
  PetscCall(PetscSFDestroy(&homes));
  PetscCall(PetscMalloc1(part->n1, &leaves));
  PetscCall(PetscMalloc1(part->n1, &remote));
  for (PetscInt a = 0; a < part->n1; a++) {
    if (part->owner[a] == mesh->rank) continue;
    leaves[n]   = a;
    remote[n++] = (PetscSFNode){.rank = part->owner[a], .index = part->index[a]};
  }
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, &part->owners));
  PetscCall(PetscSFSetGraph(part->owners, part->n1, n, leaves, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscMalloc1(interface->n1, &remote));
  for (PetscInt a = 0; a < interface->n1; a++)
    remote[a] = (PetscSFNode){.rank = interface->owner[a], .index = index[a]};
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, &part->homes));
  PetscCall(PetscSFSetGraph(part->homes, part->n1, interface->n1, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscFree(index));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By interface->owner. */
PetscErrorCode parts_cut(Contact *contact, Interface *interface)
{
  const Mesh  *mesh = contact->mesh;
  ContactPart *part = &interface->part;
  PetscFunctionBegin;
  part->dimension  = interface->dimension;
  part->components = interface->components;
  PetscCall(deal(mesh, interface));
  for (PetscInt a = 0; a < part->n1; a++)
    part->owned[a] = part->owner[a] == mesh->rank ? STICKSLIP_NODE_OWN : STICKSLIP_NODE_ELSEWHERE;
  interface->n_parts = part->n1 > 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &interface->n_parts, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(create_maps(mesh, interface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode parts_destroy(ContactPart *part)
{
  PetscFunctionBegin;
  PetscCall(PetscSFDestroy(&part->owners));
  PetscCall(PetscSFDestroy(&part->homes));
  PetscCall(PetscFree4(part->vertices, part->nodes, part->piece, part->counts));
  PetscCall(PetscFree6(part->owner, part->index, part->removed, part->middle, part->owned, part->copies));
  for (int side = 0; side < 2; side++) {
    PetscCall(PetscFree(part->facets[side]));
    PetscCall(PetscFree(part->offsets[side]));
    PetscCall(PetscFree(part->facet_nodes[side]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
