/* Nodes that a step newly covers have no slip to measure: it would be that since t_n, with the weights of t_n, which they have not. Their
 * neighbours carry them to the end of that step, with friction (the library's `weak_coverage`, up to four facets away), and their own
 * multipliers begin with the next one. Where that cannot be they act without friction for the step, and carry hardly any pressure, or
 * the step is cut back. */
#include "contact/contact.h"

/* Part of the best neighbour's coverage below which a node is carried: none that was covered at t_n but for rounding. */
static const PetscReal NONE = 1e-6;
/* Part of the normal forces of an interface that may act without friction: so much is lacking of what friction holds. */
static const PetscReal WITHOUT_FRICTION = 0.02;
/* A tangential traction below this part of the normal one is rounding: the node has no friction. */
static const PetscReal ROUNDING = 1e-12;

static PetscBool rubs(const stickslip_options *options)
{
  return (PetscBool)((options->friction == STICKSLIP_FRICTION_COULOMB && options->mu > 0) || options->friction == STICKSLIP_FRICTION_TRESCA);
}

/* Where the scene says nothing of `weak_coverage`; the library refuses what is left out here, or has a choice of its own. */
void newly_carry(Scene *scene, Interface *interface)
{
  stickslip_options *options = &interface->options;
  if (scene_has(scene, interface->name, "weak_coverage") || !rubs(options) || options->weights != STICKSLIP_WEIGHTS_CURRENT) return;
  if (options->multiplier_basis != STICKSLIP_BASIS_STANDARD || options->mortar_side == STICKSLIP_MORTAR_ANALYTIC) return;
  if (interface->offsets.any && options->normals == STICKSLIP_NORMALS_CURRENT) return;
  options->weak_coverage = NONE;
}

/* Adds a part's normal forces to sums[0], to sums[1] those of nodes that slip without friction. */
static PetscErrorCode add_forces(const ContactPart *part, PetscReal sums[2])
{
  const PetscInt   n1 = part->n1, d = part->dimension;
  stickslip_states wanted = {.struct_size = sizeof(wanted)};
  PetscFunctionBegin;
  if (!part->handle) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc4(n1, &wanted.state, d * n1, &wanted.traction, d * n1, &wanted.normal, n1, &wanted.coverage));
  PetscCallStickslip(stickslip_interface_states(part->handle, STATE_OF(part), NULL, &wanted));
  for (PetscInt a = 0; a < n1; a++) {
    double   n[3], t[3], p, across = 0;
    PetscInt removed = 0;
    contact_vector(d, wanted.normal, a, n);
    contact_vector(d, wanted.traction, a, t);
    p = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
    for (int k = 0; k < 3; k++)
      across = PetscMax(across, PetscAbsReal(t[k] - p * n[k]));
    for (PetscInt k = 0; k < d; k++)
      removed += (part->removed[a] >> k) & 1;
    if (part->owned[a] != STICKSLIP_NODE_OWN || wanted.state[a] == STICKSLIP_STATE_GAP || removed >= d - 1) continue;
    sums[0] += PetscAbsReal(p) * wanted.coverage[a];
    if (wanted.state[a] == STICKSLIP_STATE_SLIP && across <= ROUNDING * PetscAbsReal(p)) sums[1] += PetscAbsReal(p) * wanted.coverage[a];
  }
  PetscCall(PetscFree4(wanted.state, wanted.traction, wanted.normal, wanted.coverage));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At a converged state. `why`, where too much of the pressure has no friction: the step does not count. */
PetscErrorCode newly_check(const Contact *contact, char why[], size_t length)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    PetscReal        sums[2] = {0, 0};
    if (!rubs(&interface->options) || interface->options.weights != STICKSLIP_WEIGHTS_CURRENT ||
        interface->options.new_contact != STICKSLIP_NEW_CONTACT_FRICTIONLESS)
      continue;
    PetscCall(add_forces(&interface->part, sums));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    if (!(sums[1] > WITHOUT_FRICTION * sums[0])) continue;
    PetscCall(PetscSNPrintf(why, length,
                            "converged, but nodes of %s that this step newly covers act without friction in it, and carry %.2g %% of its "
                            "pressure: take shorter steps, or as nonmortar the side that stays covered (swap `nonmortar` and `mortar`)",
                            interface->name, (double)(100 * sums[1] / sums[0])));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
