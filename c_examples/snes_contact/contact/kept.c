/* What the surfaces keep of where they are at the start, and may not be meant; it is told by its node and its size.
 *
 * With `weights: persistent` what overlaps at the start of a step counts as closed (docs/formulation.md 4.9), and what the surfaces overlap
 * by at t = 0 as well: it presses nothing, and stays. A step leaves overlaps of the second order behind, which are meant; one of the mesh
 * is a fit, or a mistake. Tied surfaces keep the gap between them, however wide: what is tied across it moves as one, as if a rigid body
 * filled it. */
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

/* The deepest overlap of this part's nodes over the edges there, or the widest gap either way; `what`: its place, its size, the node's
 * number */
static PetscErrorCode measure(const ContactPart *part, PetscBool either, PetscReal *most, PetscReal what[5])
{
  double    *results;
  PetscReal *edges;
  PetscFunctionBegin;
  if (!part->handle) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(N_RESULTS * part->n1, &results));
  PetscCall(PetscCalloc1(part->n1, &edges));
  PetscCall(contact_results(part, results));
  longest_edges(part, edges);
  for (PetscInt a = 0; a < part->n1; a++) {
    const double   *result = results + N_RESULTS * a;
    const PetscReal mean   = result[RESULT_COVERAGE] > 0 ? -result[RESULT_GAP] / result[RESULT_COVERAGE] : 0;
    const PetscReal depth  = either ? PetscAbsReal(mean) : mean;
    if (part->owned[a] != STICKSLIP_NODE_OWN || depth <= *most * edges[a]) continue;
    *most = depth / edges[a];
    contact_vector(part->dimension, part->X, a, what);
    what[3] = depth;
    what[4] = (PetscReal)part->vertices[a];
  }
  PetscCall(PetscFree(edges));
  PetscCall(PetscFree(results));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of an interface over all ranks. */
static PetscErrorCode measure_all(const Contact *contact, const Interface *interface, PetscReal *most, PetscReal what[5])
{
  PetscFunctionBegin;
  PetscCall(measure(&interface->part, (PetscBool)(interface->options.friction == STICKSLIP_FRICTION_TIED), most, what));
  PetscCall(contact_largest(contact->mesh, most, 5 * sizeof(*what), what));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Offsets are meant, and pull at what is tied. */
static PetscErrorCode tied_tell(const Contact *contact, Interface *interface)
{
  PetscReal most = 0, what[5] = {0};
  PetscFunctionBegin;
  if (interface->offsets.any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(measure_all(contact, interface, &most, what));
  if (most <= TIED_TOLD) PetscFunctionReturn(PETSC_SUCCESS);
  interface->tied_gap = what[3];
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "snes_contact: warning: the surfaces of %s are tied although they are %.3g apart at node %d at (%g, %g, %g), %.2g of the longest "
                         "edge there: they move together as if a rigid body were between them. If they are to touch, correct the meshes, or close gaps "
                         "of the meshes by `adjust`; if only a part of them is to be tied, name a surface that is that part.\n",
                         interface->name, (double)what[3], (int)what[4], (double)what[0], (double)what[1], (double)what[2], (double)most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode kept_tell(const Contact *contact, Interface *interface)
{
  PetscReal most = 0, what[5] = {0};
  PetscFunctionBegin;
  if (interface->options.friction == STICKSLIP_FRICTION_TIED) { /* what is tied keeps its gaps with any weights */
    PetscCall(tied_tell(contact, interface));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (interface->options.weights != STICKSLIP_WEIGHTS_PERSISTENT) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(measure_all(contact, interface, &most, what));
  if (most <= KEPT_TOLD) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "snes_contact: warning: the surfaces of %s overlap at the start, by %.3g at node %d at (%g, %g, %g), %.2g of the longest edge "
                         "there. With `weights: persistent`%s what overlaps counts as closed: it presses nothing, and stays until the node opens. Give a fit "
                         "with an interference `weights: current`, and close an overlap of the meshes by `adjust`.\n",
                         interface->name, (double)what[3], (int)what[4], (double)what[0], (double)what[1], (double)what[2], (double)most,
                         contact->physics->dynamics ? ", the default with `dynamics`," : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}
