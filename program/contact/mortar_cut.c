/* The mortar side of an interface, cut at its nodes' homes: each part gets the facets that it may need, those that meet its boxes
 * (halo.c), and two rings of facets around them, which say what the surface looks like there. */
#include "contact/packet.h"

enum { RINGS = 2 };

/* Where parts look for mortar facets. */
typedef struct {
  PetscInt   n;     /* places of the halo; 0: every part has all of the side */
  PetscBool *has;   /* of each rank: a part with nodes */
  Extent    *boxes; /* of each rank, HALO_BOXES a place */
  double    *x;     /* of the corners of the facets here, 3 each, a place */
} Near;

/* positions of the corners at one place */
static PetscErrorCode fetch_corners(const Interface *interface, Vec end, double x[])
{
  const PetscInt n = interface->n1 + interface->n2;
  double        *at_home;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * n, &at_home));
  PetscCall(contact_fetch(interface->sf, end, at_home));
  for (PetscInt k = 0; k < 3 * n; k++)
    at_home[k] += interface->X[k];
  PetscCall(homes_bcast(interface->corners[1], 3, at_home, x));
  PetscCall(PetscFree(at_home));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode near_create(const Mesh *mesh, const Interface *interface, const Side *side, PetscInt n_ends, const Vec ends[],
                                  Near *near)
{
  const Halo    *halo  = &interface->halo;
  const PetscInt width = 3 * side->offsets[side->n_facets];
  PetscBool      any   = (PetscBool)(interface->part.n1 > 0);
  Extent        *mine;
  PetscFunctionBegin;
  near->n = n_ends;
  PetscCheck(!n_ends || n_ends == halo->n_places, PETSC_COMM_SELF, PETSC_ERR_PLIB, "places of a halo");
  PetscCall(PetscMalloc3(mesh->size, &near->has, mesh->size * near->n * HALO_BOXES, &near->boxes, width * near->n, &near->x));
  PetscCall(PetscMalloc1(near->n * HALO_BOXES, &mine));
  for (PetscInt p = 0; p < near->n; p++) {
    PetscCall(PetscArraycpy(mine + p * HALO_BOXES, halo->place[p].box, HALO_BOXES));
    PetscCall(fetch_corners(interface, ends[p], near->x + width * p));
  }
  PetscCallMPI(MPI_Allgather(&any, 1, MPIU_BOOL, near->has, 1, MPIU_BOOL, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allgather(mine, (PetscMPIInt)(near->n * HALO_BOXES * (PetscInt)sizeof(Extent)), MPI_BYTE, near->boxes,
                             (PetscMPIInt)(near->n * HALO_BOXES * (PetscInt)sizeof(Extent)), MPI_BYTE, PETSC_COMM_WORLD));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool meets(const Extent *own, const Extent boxes[HALO_BOXES])
{
  for (int b = 0; b < HALO_BOXES; b++) {
    PetscBool near = PETSC_TRUE;
    for (int i = 0; i < 3; i++)
      near = (PetscBool)(near && own->low[i] <= boxes[b].high[i] && own->high[i] >= boxes[b].low[i]);
    if (near) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Marks of the corners of facets: the parts, of ranks from `first` on, with boxes that the facet meets. */
static void mark_near(const Mesh *mesh, const Side *side, const Near *near, PetscMPIInt first)
{
  const PetscInt width = 3 * side->offsets[side->n_facets];
  for (PetscInt f = 0; f < side->n_facets; f++) {
    PetscInt bits = 0;
    for (PetscInt p = 0; p < near->n; p++) {
      Extent own = extent_of_nothing();
      for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1]; k++)
        extent_add(&own, near->x + width * p + 3 * k);
      for (PetscInt r = first; r < PetscMin(first + RANKS_AT_ONCE, mesh->size); r++) {
        if (near->has[r] && meets(&own, near->boxes + (near->n * r + p) * HALO_BOXES)) bits |= (PetscInt)1 << (r - first);
      }
    }
    for (PetscInt k = side->offsets[f]; k < side->offsets[f + 1]; k++)
      side->marks[k] = bits;
  }
}

/* the parts of those ranks that there are */
static PetscInt parts_with_nodes(const Mesh *mesh, const Near *near, PetscMPIInt first)
{
  PetscInt bits = 0;
  for (PetscInt r = first; r < PetscMin(first + RANKS_AT_ONCE, mesh->size); r++) {
    if (near->has[r]) bits |= (PetscInt)1 << (r - first);
  }
  return bits;
}

/* What parts need; returns whether that is all for each of them. */
static PetscErrorCode mark(const Mesh *mesh, const Interface *interface, Side *side, const Near *near, PetscMPIInt first, PetscBool *whole)
{
  const PetscInt parts = parts_with_nodes(mesh, near, first);
  PetscInt       found = 0;
  PetscFunctionBegin;
  PetscCall(side_clear(interface, side));
  for (PetscInt k = 0; k < side->n_nodes && !near->n; k++)
    side->nodes[k] = parts;
  for (PetscInt f = 0; f < side->n_facets && !near->n; f++)
    side->facets[f] = parts;
  if (!near->n) PetscFunctionReturn(PETSC_SUCCESS);
  mark_near(mesh, side, near, first);
  for (PetscInt k = 0; k < side->offsets[side->n_facets]; k++)
    found |= side->marks[k];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPIU_INT, MPI_BOR, PETSC_COMM_WORLD));
  if (interface->surface[1]->first == 0 && side->n_facets) side->marks[0] |= parts & ~found; /* a surface has a facet; nothing is near any */
  PetscCall(PetscSFReduceBegin(side->corners, MPIU_INT, side->marks, side->of_both, MPI_BOR));
  PetscCall(PetscSFReduceEnd(side->corners, MPIU_INT, side->marks, side->of_both, MPI_BOR));
  PetscCall(side_mark_rings(side, RINGS));
  for (PetscInt f = 0; f < side->n_facets; f++)
    *whole = (PetscBool)(*whole && side->facets[f] == parts);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each node once, by any part that has it: bits of those. `counted` nodes have been before. */
static void choose_counting(const Side *side, PetscBool counted[], PetscInt counts[])
{
  for (PetscInt k = 0; k < side->n_nodes; k++) {
    counts[k]  = counted[k] ? 0 : side->nodes[k] & -side->nodes[k];
    counted[k] = (PetscBool)(counted[k] || side->nodes[k]);
  }
}

/* `ends`: of each place of the halo the vector that it begins with. Without places every part has all of the side. */
PetscErrorCode mortar_cut(Contact *contact, Interface *interface, PetscInt n_ends, const Vec ends[])
{
  const Mesh *mesh  = contact->mesh;
  PetscBool   whole = PETSC_TRUE, *counted;
  PetscInt    n = 0, *received = NULL, *counts;
  Side        side;
  Near        near;

  PetscFunctionBegin;
  PetscCall(side_create(interface, 1, &side));
  PetscCall(PetscCalloc2(side.n_nodes, &counted, side.n_nodes, &counts));
  PetscCall(near_create(mesh, interface, &side, n_ends, ends, &near));
  for (PetscMPIInt first = 0; first < mesh->size; first += RANKS_AT_ONCE) {
    PetscInt  m;
    PetscInt *mine;
    PetscCall(mark(mesh, interface, &side, &near, first, &whole));
    choose_counting(&side, counted, counts);
    PetscCall(side_deal(mesh, interface, &side, counts, first, &m, &mine));
    if (mine) n = m, received = mine;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &whole, 1, MPIU_BOOL, MPI_LAND, PETSC_COMM_WORLD));
  interface->halo.whole = whole;
  PetscCall(side_unpack(n, received, 1, interface, &interface->part));
  PetscCall(PetscFree(received));
  PetscCall(PetscFree3(near.has, near.boxes, near.x));
  PetscCall(PetscFree2(counted, counts));
  PetscCall(side_destroy(&side));
  PetscFunctionReturn(PETSC_SUCCESS);
}
