/* Rank 0 cuts the mortar side of an interface, and sends each part the facets that it may need: those that meet its boxes
 * (halo.c), and two rings of facets around them, which say what the surface looks like there. */
#include "contact/packet.h"

enum { RINGS = 2 };

/* rank 0: marks the nodes of facets that meet any of the boxes; x: of the mortar nodes */
static void mark_near(Side *side, const double x[], const Extent boxes[HALO_BOXES])
{
  for (PetscInt f = 0; f < side->n_facets; f++) {
    Extent    own  = extent_of_nothing();
    PetscBool near = PETSC_FALSE;
    for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1]; k++)
      extent_add(&own, x + 3 * side->of_facets[k]);
    for (int b = 0; b < HALO_BOXES && !near; b++) {
      near = PETSC_TRUE;
      for (int i = 0; i < 3; i++)
        near = (PetscBool)(near && own.low[i] <= boxes[b].high[i] && own.high[i] >= boxes[b].low[i]);
    }
    for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1] && near; k++)
      side->nodes[side->of_facets[k]] = PETSC_TRUE;
  }
}

/* Boxes and positions at all places of the halo, on rank 0. */
typedef struct {
  PetscInt  n;
  Extent   *boxes; /* of each rank, HALO_BOXES a place */
  double   *x;     /* 3 n2 a place */
} Gathered;

static PetscErrorCode gather(const Interface *interface, PetscMPIInt rank, PetscMPIInt size, PetscInt n_ends, const Vec ends[],
                             Gathered *all)
{
  const Halo    *halo = &interface->halo;
  const PetscInt n    = interface->n1 + interface->n2;
  Extent        *mine;
  double        *u;
  PetscFunctionBegin;
  all->n = halo->n_places;
  PetscCheck(n_ends == all->n, PETSC_COMM_SELF, PETSC_ERR_PLIB, "places of a halo");
  PetscCall(PetscMalloc2(rank ? 0 : size * all->n * HALO_BOXES, &all->boxes, 3 * interface->n2 * all->n, &all->x));
  PetscCall(PetscMalloc2(all->n * HALO_BOXES, &mine, 3 * n, &u));
  for (PetscInt p = 0; p < all->n; p++) {
    PetscCall(PetscArraycpy(mine + p * HALO_BOXES, halo->place[p].box, HALO_BOXES));
    PetscCall(contact_fetch(interface->sf, ends[p], u));
    for (PetscInt k = 0; k < 3 * interface->n2; k++)
      all->x[3 * interface->n2 * p + k] = interface->X[3 * interface->n1 + k] + u[3 * interface->n1 + k];
  }
  PetscCallMPI(MPI_Gather(mine, (PetscMPIInt)(all->n * HALO_BOXES * (PetscInt)sizeof(Extent)), MPI_BYTE, all->boxes,
                          (PetscMPIInt)(all->n * HALO_BOXES * (PetscInt)sizeof(Extent)), MPI_BYTE, 0, PETSC_COMM_WORLD));
  PetscCall(PetscFree2(mine, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: what rank r needs; returns whether that is all */
static PetscErrorCode mark(Side *side, const Interface *interface, PetscMPIInt r, PetscBool has_nodes, const Gathered *all,
                           PetscBool *whole)
{
  const PetscBool uncut = (PetscBool)(all->n == 0);
  PetscInt        first = 0;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < side->n_nodes; k++)
    side->nodes[k] = (PetscBool)(has_nodes && uncut);
  for (PetscInt f = 0; f < side->n_facets; f++)
    side->facets[f] = (PetscBool)(has_nodes && uncut);
  *whole = PETSC_TRUE;
  if (!has_nodes || uncut) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt p = 0; p < all->n; p++)
    mark_near(side, all->x + 3 * interface->n2 * p, all->boxes + (all->n * r + p) * HALO_BOXES);
  while (first < side->n_nodes && !side->nodes[first])
    first++;
  if (first == side->n_nodes) side->nodes[side->of_facets[0]] = PETSC_TRUE; /* a surface has a facet; nothing is near any */
  PetscCall(side_mark_rings(side, RINGS));
  for (PetscInt f = 0; f < side->n_facets; f++)
    *whole = (PetscBool)(*whole && side->facets[f]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `ends`: of each place of the halo the vector that it begins with. Without places every part has all of the side. */
PetscErrorCode mortar_cut(Contact *contact, Interface *interface, PetscInt n_ends, const Vec ends[])
{
  const Mesh *mesh   = contact->mesh;
  Packet      packet = {0};
  Gathered    all    = {0};
  Side        side;
  PetscBool  *counted, *counts, any = (PetscBool)(interface->part.n1 > 0), *have, whole = PETSC_TRUE;
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(PetscMalloc1(size, &have));
  PetscCallMPI(MPI_Gather(&any, 1, MPIU_BOOL, have, 1, MPIU_BOOL, 0, PETSC_COMM_WORLD));
  PetscCall(gather(interface, mesh->rank, size, n_ends, ends, &all));
  if (mesh->rank == 0) {
    PetscCall(side_create(interface, 1, &side));
    PetscCall(PetscCalloc2(side.n_nodes, &counted, side.n_nodes, &counts));
    for (PetscMPIInt r = size - 1; r >= 0; r--) { /* its own part stays in the packet */
      PetscBool has_all;
      packet.n = 0;
      PetscCall(mark(&side, interface, r, have[r], &all, &has_all));
      whole = (PetscBool)(whole && has_all);
      for (PetscInt k = 0; k < side.n_nodes; k++) { /* once, by any that has the node */
        counts[k]  = (PetscBool)(side.nodes[k] && !counted[k]);
        counted[k] = (PetscBool)(counted[k] || side.nodes[k]);
      }
      PetscCall(side_pack(&side, interface, counts, &packet));
      PetscCall(packet_transfer(mesh, r, &packet));
    }
    PetscCall(PetscFree2(counted, counts));
    PetscCall(side_destroy(&side));
  } else {
    PetscCall(packet_transfer(mesh, mesh->rank, &packet));
  }
  PetscCall(side_unpack(&packet, 1, &interface->part));
  PetscCallMPI(MPI_Bcast(&whole, 1, MPIU_BOOL, 0, PETSC_COMM_WORLD));
  interface->halo.whole = whole;
  PetscCall(PetscFree(packet.numbers));
  PetscCall(PetscFree2(all.boxes, all.x));
  PetscCall(PetscFree(have));
  PetscFunctionReturn(PETSC_SUCCESS);
}
