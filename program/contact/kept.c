/* What the surfaces keep of where they are at the start, and may not be meant; it is told by its node and its size.
 *
 * With `weights: conserving` what overlaps at the start of a step counts as closed (docs/formulation 21), and what the surfaces overlap
 * by at t = 0 as well: it presses nothing, and stays. An overlap of the mesh is a fit, or a mistake. Tied surfaces keep the gap between them, however wide: what is tied across it moves as one, as if a rigid body filled it. */
#include "contact/contact.h"

/* What is told, over the longest edge around the node: coordinates of single precision are off by as much on a mesh of a hundred facets. */
static const PetscReal KEPT_TOLD = 1e-5;
/* The gap of tied surfaces that is told, over the same: chords of circles in eight pieces that do not match are as far apart. */
static const PetscReal TIED_TOLD = 0.1;

/* Of the non-mortar facets of the part around each of its nodes. */
static void longest_edges(const ContactPart *part, PetscReal longest[])
{
  for (PetscInt f = 0; f < part->n_facets[0]; f++) {
    const PetscInt n = part->offsets[0][f + 1] - part->offsets[0][f], *nodes = part->facet_nodes[0] + part->offsets[0][f];
    const PetscInt corners = cell_corners(cell_kind(part->dimension - 1, n));
    PetscReal      squared = 0;
    for (PetscInt k = 0; k < corners; k++) {
      PetscReal a[3], b[3];
      contact_vector(part->dimension, part->x, nodes[k], a);
      contact_vector(part->dimension, part->x, nodes[(k + 1) % corners], b);
      squared = PetscMax(squared, PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]));
    }
    for (PetscInt k = 0; k < n; k++)
      longest[nodes[k]] = PetscMax(longest[nodes[k]], PetscSqrtReal(squared));
  }
}

/* The deepest overlap of an interface, or the widest gap either way: over the edges there, and itself; at which node, which is here in the
 * undeformed body */
typedef struct {
  PetscReal part, depth, X[3];
  PetscInt  vertex;
} Overlap;

/* What is tied keeps its gaps with any weights, overlaps and others. */
static PetscBool is_tied(const Interface *interface)
{
  return (PetscBool)(interface->options.friction == STICKSLIP_FRICTION_TIED);
}

/* At the place of the last evaluation, or commit. On every rank. */
static PetscErrorCode measure(const Mesh *mesh, const Interface *interface, Overlap *overlap)
{
  const ContactPart *part = &interface->part;
  double            *results;
  PetscReal         *edges, most = 0;
  PetscFunctionBegin;
  *overlap = (Overlap){0};
  PetscCall(PetscMalloc1(N_RESULTS * part->n1, &results));
  PetscCall(PetscCalloc1(part->n1, &edges));
  PetscCall(contact_results(part, results));
  longest_edges(part, edges);
  for (PetscInt a = 0; a < part->n1 && verb_there(part); a++) {
    const double   *result = results + N_RESULTS * a;
    const PetscReal mean   = result[RESULT_COVERAGE] > 0 ? -result[RESULT_GAP] / result[RESULT_COVERAGE] : 0;
    const PetscReal depth  = is_tied(interface) ? PetscAbsReal(mean) : mean;
    if (part->owned[a] != STICKSLIP_NODE_OWN || depth <= most * edges[a]) continue;
    most     = depth / edges[a];
    *overlap = (Overlap){.part = most, .depth = depth, .vertex = part->vertices[a]};
    contact_vector(part->dimension, part->X, a, overlap->X);
  }
  PetscCall(PetscFree(edges));
  PetscCall(PetscFree(results));
  PetscCall(contact_largest(mesh, &most, sizeof(*overlap), overlap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Offsets are meant, and pull at what is tied. */
static PetscErrorCode tied_tell(const Contact *contact, Interface *interface)
{
  Overlap gap;
  PetscFunctionBegin;
  if (interface->offsets.any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(measure(contact->mesh, interface, &gap));
  if (gap.part <= TIED_TOLD) PetscFunctionReturn(PETSC_SUCCESS);
  interface->tied_gap = gap.depth;
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "stickslip: warning: the surfaces of %s are tied although they are %.3g apart at node %d at (%g, %g, %g), %.2g of the longest "
                         "edge there: they move together as if a rigid body were between them. If they are to touch, correct the meshes, or close gaps "
                         "of the meshes by `adjust`; if only a part of them is to be tied, name a surface that is that part.\n",
                         interface->name, (double)gap.depth, (int)gap.vertex, (double)gap.X[0], (double)gap.X[1], (double)gap.X[2], (double)gap.part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode kept_tell(const Contact *contact, Interface *interface)
{
  Overlap overlap;
  PetscFunctionBegin;
  if (is_tied(interface)) PetscCall(tied_tell(contact, interface));
  if (is_tied(interface) || interface->method.weights != STICKSLIP_WEIGHTS_CONSERVING) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(measure(contact->mesh, interface, &overlap));
  if (overlap.part <= KEPT_TOLD) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "stickslip: warning: the surfaces of %s overlap at the start, by %.3g at node %d at (%g, %g, %g), %.2g of the longest edge "
                         "there. With `weights: conserving` what overlaps counts as closed: it presses nothing, and stays until the node opens. Give a fit "
                         "with an interference `weights: current`, and close an overlap of the meshes by `adjust`.\n",
                         interface->name, (double)overlap.depth, (int)overlap.vertex, (double)overlap.X[0], (double)overlap.X[1], (double)overlap.X[2],
                         (double)overlap.part));
  PetscFunctionReturn(PETSC_SUCCESS);
}
