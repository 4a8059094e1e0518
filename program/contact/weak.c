/* Nodes that are hardly covered, where the scene does not say what becomes of them (`weak_coverage`): their multiplier is a point load
 * without bound at the end of a sliver, and Newton's method loses its way. Their neighbours carry them, and those that a step newly covers
 * under friction (newly.c). With dual multipliers the library does so by itself; with standard ones it cannot, for handles that share sums
 * do not know each other's neighbours. */
#include "contact/contact.h"

/* Nodes covered less than this times their best covered neighbour are carried. In the plane such a node has a third of a facet on the other
 * surface. With more it is better on its own: a block with half a facet over the edge rubbed 9 per cent too much where that was carried, on
 * its own 3; with a tenth of one there is no difference, but for a pressure of three times its neighbours'. */
static const PetscReal WEAK_COVERAGE = 0.05;
/* None that was covered at t_n but for rounding: newly covered ones alone are carried. */
static const PetscReal NONE = 1e-6;
/* Covered up to this counts as wholly covered: rounding, and the rule's error on facets that are no parallelograms. */
static const PetscReal WHOLE = 0.99;

/* What nobody can be carried with (docs/host_edges.md). */
static PetscBool goes_with(const Interface *interface)
{
  const stickslip_method *method = &interface->method;
  if (decision_is_points(interface) || interface->surface[1]->analytic || interface->options.friction == STICKSLIP_FRICTION_TIED) return PETSC_FALSE;
  if (method->weights == STICKSLIP_WEIGHTS_CONSERVING) return PETSC_FALSE;
  return (PetscBool)!(interface->offsets.any && method->normals == STICKSLIP_NORMALS_CURRENT);
}

/* Is any node covered in part at the start? Where the surfaces are apart nothing is sought to tell. */
static PetscErrorCode hangs_over(const ContactPart *part, PetscBool *any)
{
  stickslip_counters counters = {.struct_size = sizeof(counters)};
  stickslip_states   state = {.struct_size = sizeof(state)}, wanted = {.struct_size = sizeof(wanted)};
  PetscFunctionBegin;
  *any = PETSC_FALSE;
  PetscCall(PetscMalloc3(part->n1, &state.state, part->n1, &wanted.coverage, part->n1, &wanted.area));
  if (verb_there(part)) PetscCallStickslip(verb_states(part, &state));
  if (part->handle) PetscCallStickslip(stickslip_interface_counters(part->handle, &counters));
  if (verb_there(part) && !counters.evaluations_apart) PetscCallStickslip(verb_states(part, &wanted));
  for (PetscInt a = 0; a < part->n1 && verb_there(part) && !counters.evaluations_apart; a++) {
    if (part->owned[a] != STICKSLIP_NODE_OWN || part->removed[a] == 7) continue;
    *any = (PetscBool)(*any || (wanted.coverage[a] > 0 && wanted.coverage[a] < WHOLE * wanted.area[a]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscCall(PetscFree3(state.state, wanted.coverage, wanted.area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode weak_choose(Interface *interface, PetscBool created, PetscBool *chosen)
{
  stickslip_method *method = &interface->method;
  const PetscBool    plane   = (PetscBool)(interface->dimension == 2);
  PetscFunctionBegin;
  *chosen = PETSC_FALSE;
  if ((method->weak_coverage != 0 && method->weak_coverage != NONE) || method->multiplier_basis == STICKSLIP_BASIS_DUAL || !goes_with(interface))
    PetscFunctionReturn(PETSC_SUCCESS);
  *chosen = plane;
  if (created && !plane) PetscCall(hangs_over(&interface->part, chosen)); /* in space carrying costs: parts need many rings of facets */
  if (*chosen) method->weak_coverage = WEAK_COVERAGE;
  else if (newly_rubs(&interface->options) && method->weights == STICKSLIP_WEIGHTS_CURRENT) method->weak_coverage = NONE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
