/* Contact that is smaller than the facets around it, at the end of a run: its force is that of a pyramid, at no overlap that a node would show. A
 * disc between two others pressed 32 per cent too hard so, a block on a round one 43, a ball on cells thrice as wide as its contact 16; at points half
 * as hard as it should. Nothing is wrong with such a scene but its mesh, so that it is told. */
#include "contact/contact.h"

/* Nodes that are too few, in the plane and in space: of a facet, of a node and its neighbours. A circle and a ball on two and five press some 10 per cent
 * too hard. */
PetscInt lonely_few(PetscInt dimension) { return dimension == 2 ? 2 : 5; }

/* What is closed. */
typedef struct {
  PetscReal nodes, area, of; /* their number, their area, all nodes */
  PetscReal most[4];         /* of the one that is closed most the place and the area */
  PetscReal wide;            /* how far they reach in the undeformed body */
} Closed;

static PetscErrorCode find_closed(const Interface *interface, const Mesh *mesh, Closed *found)
{
  const ContactStates *states = &interface->states;
  PetscReal            sums[3] = {0, 0, interface->n1}, most = 0;
  Extent               extent = extent_of_nothing();
  PetscFunctionBegin;
  *found = (Closed){.most = {0}};
  for (PetscInt a = 0; a < interface->n1; a++) {
    const PetscReal closed = states->closed[a] * states->coverage[a];
    PetscReal       x[3];
    if (states->state[a] == STICKSLIP_STATE_GAP) continue;
    contact_vector(interface->dimension, interface->X, a, x);
    sums[0]++;
    sums[1] += closed;
    extent_add(&extent, x);
    if (closed <= most) continue;
    most = closed;
    for (int i = 0; i < 3; i++)
      found->most[i] = x[i];
    found->most[3] = states->area[a];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscCall(extent_of_all(&extent));
  PetscCall(contact_largest(mesh, &most, sizeof(found->most), found->most));
  found->nodes = sums[0], found->area = sums[1], found->of = sums[2];
  found->wide = sums[0] > 0 ? PetscSqrtReal(extent_diagonal_squared(&extent)) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal distance(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]));
}

/* The shortest edge of a mortar facet, of all ranks; 0 where the mortar side has the shape that is meant, whatever its facets are. */
static PetscErrorCode shortest_mortar(const Interface *interface, const Mesh *mesh, PetscReal *shortest)
{
  const ContactPart *part = &interface->part;
  const Body        *body = &mesh->bodies[interface->body[1]];
  PetscFunctionBegin;
  *shortest = 0;
  if (interface->skin || body->analytic || body->rigid) PetscFunctionReturn(PETSC_SUCCESS);
  *shortest = PETSC_MAX_REAL;
  for (PetscInt f = 0; f < part->n_facets[1]; f++) {
    const PetscInt *nodes = part->facet_nodes[1] + part->offsets[1][f], n = part->offsets[1][f + 1] - part->offsets[1][f];
    const PetscInt  corners = cell_corners(cell_kind(part->dimension - 1, n));
    for (PetscInt k = 0; k < corners; k++) {
      PetscReal a[3], b[3];
      contact_vector(part->dimension, MORTAR_OF(part, part->X), nodes[k], a);
      contact_vector(part->dimension, MORTAR_OF(part, part->X), nodes[(k + 1) % corners], b);
      *shortest = PetscMin(*shortest, distance(a, b));
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, shortest, 1, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Told where what is closed are few nodes, not all there are, or, where points decide, less than a node has, or lies within any mortar
 * facet. */
PetscErrorCode lonely_tell(const Interface *interface, const Mesh *mesh)
{
  const PetscBool points = decision_is_points(interface);
  Closed          closed;
  PetscReal       mortar;
  char            where[96];
  PetscFunctionBegin;
  PetscCall(find_closed(interface, mesh, &closed));
  PetscCall(shortest_mortar(interface, mesh, &mortar));
  if (closed.nodes == 0 || closed.nodes == closed.of) PetscFunctionReturn(PETSC_SUCCESS);
  if (points && closed.area < closed.most[3]) PetscCall(PetscSNPrintf(where, sizeof(where), "is less than the area of one node"));
  else if (!points && closed.nodes == 1) PetscCall(PetscSNPrintf(where, sizeof(where), "is at one node"));
  else if (!points && closed.nodes <= lonely_few(interface->dimension)) PetscCall(PetscSNPrintf(where, sizeof(where), "is at %d nodes", (int)closed.nodes));
  else if (closed.wide < mortar)
    PetscCall(PetscSNPrintf(where, sizeof(where), "is %.2g wide, less than any mortar facet", (double)closed.wide));
  else PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "stickslip: warning: all that %s carries at the end %s, at (%g, %g, %g) in the undeformed body: the contact is smaller "
                         "than its facets, and its force may be off by tens of per cent. Take facets so fine that several lie in the contact; where a corner slides on a "
                         "face, the face's side as `nonmortar`.\n",
                         interface->name, where, (double)closed.most[0], (double)closed.most[1], (double)closed.most[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
