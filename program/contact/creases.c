/* Sharp edges of the non-mortar surface: the library lists a node there once for each side (docs/host_edges.md), and each copy has a
 * normal and multipliers of its own. Every rank asks it about the nodes that are at home here, with the facets around them. */
#include "contact/packet.h"
#include "contact/skin.h"

/* What is an edge where the scene does not say: facets of a circle of ten meet at 36 degrees. */
static const PetscReal CREASE_ANGLE = 40;

/* The nodes at home and the facets around them. */
static PetscErrorCode deal(const Mesh *mesh, Interface *interface, ContactPart *part)
{
  const Interface known = *interface;
  PetscInt        n = 0, *received = NULL, *none;
  PetscBool      *middle;
  Side            side;
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(interface->n1, &none, interface->n1, &middle)); /* nothing is known of them yet */
  interface->owner = interface->removed = interface->copies = none;
  interface->middle                                         = middle;
  PetscCall(side_create(interface, 0, &side));
  for (PetscMPIInt first = 0; first < mesh->size; first += RANKS_AT_ONCE) {
    const PetscBool here = (PetscBool)(mesh->rank >= first && mesh->rank < first + RANKS_AT_ONCE);
    PetscInt        m, *mine;
    PetscCall(side_clear(interface, &side));
    for (PetscInt a = 0; a < side.n_nodes && here; a++)
      side.nodes[a] = (PetscInt)1 << (mesh->rank - first);
    PetscCall(side_mark_rings(&side, 1));
    PetscCall(side_deal(mesh, interface, &side, none, first, &m, &mine));
    if (mine) n = m, received = mine;
  }
  PetscCall(side_unpack(n, received, 0, interface, part));
  PetscCall(side_destroy(&side));
  PetscCall(PetscFree(received));
  PetscCall(PetscFree2(none, middle));
  interface->owner   = known.owner;
  interface->removed = known.removed;
  interface->copies  = known.copies;
  interface->middle  = known.middle;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of each corner of the part's facets which copy of its node the facet has. A surface that the library refuses has none: it will
 * be refused where the interface is made. */
static PetscErrorCode ask(const Interface *interface, const ContactPart *part, PetscReal angle, PetscInt copies[])
{
  const PetscInt    d = interface->dimension, n = part->n1, n_facets = part->n_facets[0], n_corners = part->offsets[0][n_facets];
  stickslip_surface surface = {.struct_size = sizeof(surface), .n_nodes = n, .n_facets = n_facets};
  int64_t          *nodes, *offsets, *originals, *copy, count;
  PetscInt         *found;
  double           *place, *x;
  PetscSF           sf;
  int32_t           refused;
  PetscFunctionBegin;
  PetscCall(PetscMalloc5(n_corners, &nodes, n_facets + 1, &offsets, n + n_corners, &originals, n + n_corners, &copy, n, &found));
  PetscCall(PetscMalloc2(3 * n, &place, d * n, &x));
  PetscCall(homes_fetch_create(interface, n, part->nodes, &sf));
  PetscCall(homes_bcast(sf, 3, interface->place, place));
  PetscCall(PetscSFDestroy(&sf));
  for (PetscInt k = 0; k < d * n; k++)
    x[k] = place[3 * (k / d) + k % d];
  for (PetscInt k = 0; k < n_corners; k++)
    nodes[k] = part->facet_nodes[0][k];
  for (PetscInt f = 0; f <= n_facets; f++)
    offsets[f] = part->offsets[0][f];
  surface.coordinates   = x;
  surface.facet_offsets = offsets;
  surface.facet_nodes   = nodes;
  refused = n == 0 || (d == 3 ? stickslip_surface_split_creases : stickslip_lines_split_creases)(
                        &surface, angle * PETSC_PI / 180, 0, n + n_corners, nodes, originals, &count);
  for (PetscInt a = 0; a < n; a++)
    copy[a] = found[a] = 0;
  for (int64_t a = n; a < count && !refused; a++)
    copy[a] = ++found[originals[a]];
  for (PetscInt k = 0; k < n_corners; k++)
    copies[k] = refused ? 0 : (PetscInt)copy[nodes[k]];
  PetscCall(PetscFree5(nodes, offsets, originals, copy, found));
  PetscCall(PetscFree2(place, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is known of the corners of nodes at home, to the ranks that have these facets: face, corner and copy, where it is not the first. */
static PetscErrorCode send(const Mesh *mesh, const Interface *interface, const ContactPart *part, const PetscInt copies[], PetscInt here[])
{
  enum { WIDTH = 3 };
  const Surface *share  = interface->surface[0];
  const PetscInt *nodes = part->nodes;
  PetscInt       *firsts, *packed, *received, n = 0;
  PetscMPIInt    *counts, r = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->size, &firsts));
  PetscCall(PetscCalloc1(mesh->size, &counts));
  PetscCall(PetscMalloc1(WIDTH * part->offsets[0][part->n_facets[0]], &packed));
  PetscCallMPI(MPI_Allgather(&share->first, 1, MPIU_INT, firsts, 1, MPIU_INT, PETSC_COMM_WORLD));
  for (PetscInt f = 0; f < part->n_facets[0]; f++) { /* in the order of their numbers, so of the ranks */
    const PetscInt face = part->facets[0][f], start = part->offsets[0][f];
    while (r + 1 < mesh->size && firsts[r + 1] <= face)
      r++;
    for (PetscInt k = start; k < part->offsets[0][f + 1]; k++) {
      const PetscInt home = nodes[part->facet_nodes[0][k]] - interface->first[0];
      if (!copies[k] || home < 0 || home >= interface->n1) continue;
      packed[n++] = face - firsts[r];
      packed[n++] = k - start;
      packed[n++] = copies[k];
      counts[r] += WIDTH;
    }
  }
  PetscCall(numbers_deal(mesh, counts, packed, &n, &received));
  PetscCall(PetscArrayzero(here, share->offsets[share->n_faces]));
  for (PetscInt k = 0; k < n; k += WIDTH)
    here[share->offsets[received[k]] + received[k + 1]] = received[k + 2];
  PetscCall(PetscFree(received));
  PetscCall(PetscFree(packed));
  PetscCall(PetscFree(counts));
  PetscCall(PetscFree(firsts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode split(const Mesh *mesh, Interface *interface, const PetscInt copies[], PetscInt **nodes)
{
  const PetscInt n_corners = interface->surface[0]->offsets[interface->surface[0]->n_faces];
  PetscInt      *vertices;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n_corners, &vertices));
  PetscCall(PetscSFBcastBegin(interface->corners[0], MPIU_INT, interface->nodes, vertices, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(interface->corners[0], MPIU_INT, interface->nodes, vertices, MPI_REPLACE));
  PetscCall(PetscFree(interface->copies));
  PetscCall(surface_split(mesh, vertices, copies, &interface->share[0], &interface->n1, nodes, &interface->copies));
  PetscCall(PetscFree(vertices));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode creases_split(Scene *scene, const Contact *contact, Interface *interface, PetscInt **nodes)
{
  const Mesh    *mesh      = contact->mesh;
  const Surface *share     = interface->surface[0];
  const PetscInt n_corners = share->offsets[share->n_faces];
  ContactPart    part      = {0};
  PetscReal      angle     = SKIN_CREASE;
  PetscInt      *copies, *here, creased = 0;
  PetscFunctionBegin;
  *nodes = NULL;
  if (!interface->skin) scene_real(scene, interface->name, "crease_angle", &angle);
  if (interface->options.friction == STICKSLIP_FRICTION_TIED) PetscFunctionReturn(PETSC_SUCCESS); /* which way nothing moves does not matter */
  PetscCall(deal(mesh, interface, &part));
  PetscCall(PetscMalloc1(part.offsets[0][part.n_facets[0]], &copies));
  PetscCall(PetscMalloc1(n_corners, &here));
  PetscCall(ask(interface, &part, angle > 0 ? angle : CREASE_ANGLE, copies));
  PetscCall(send(mesh, interface, &part, copies, here));
  for (PetscInt k = 0; k < n_corners; k++)
    creased += here[k] > 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &creased, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  interface->blunted = (PetscBool)(creased && angle == 0);
  if (creased && contact->condensed && angle > 0)
    scene_fail(scene, NULL, "unknowns",
               "'%s' of '%s' has sharp edges: their nodes need multipliers for each side, and without multipliers among the unknowns there is "
               "one. Name the faces that touch alone, or take `unknowns: multipliers`; with `crease_angle: 0` these nodes have one normal "
               "for both sides.",
               share->name, interface->name);
  if (creased && angle > 0) {
    const PetscInt before = interface->n1;
    PetscCall(split(mesh, interface, here, nodes));
    interface->n_copies = interface->n1 - before;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &interface->n_copies, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  }
  PetscCall(PetscFree(copies));
  PetscCall(PetscFree(here));
  PetscCall(parts_destroy(&part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode creases_join(const Mesh *mesh, const Interface *interface, PetscInt owner[])
{
  const PetscInt n = interface->n1;
  PetscInt       n_here, *kept;
  PetscSF        directory;
  PetscFunctionBegin;
  if (!interface->n_copies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(directory_create(mesh, n, interface->nodes, &n_here, &directory));
  PetscCall(PetscMalloc1(n_here, &kept));
  for (PetscInt k = 0; k < n_here; k++)
    kept[k] = PETSC_MAX_INT;
  PetscCall(PetscSFReduceBegin(directory, MPIU_INT, owner, kept, MPI_MIN));
  PetscCall(PetscSFReduceEnd(directory, MPIU_INT, owner, kept, MPI_MIN));
  PetscCall(PetscSFBcastBegin(directory, MPIU_INT, kept, owner, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(directory, MPIU_INT, kept, owner, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&directory));
  PetscCall(PetscFree(kept));
  PetscFunctionReturn(PETSC_SUCCESS);
}
