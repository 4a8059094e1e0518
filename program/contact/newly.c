/* Nodes that a step newly covers have no slip to measure: it would be that since t_n, with the weights of t_n, which they have not. Their
 * neighbours carry them to the end of that step, with friction (weak.c), and their own multipliers begin with the next one. Where that
 * cannot be they act without friction for the step, and carry hardly any pressure, or the step is cut back. */
#include "contact/contact.h"

/* Part of the normal forces of an interface that may act without friction: so much is lacking of what friction holds. */
static const PetscReal WITHOUT_FRICTION = 0.02;
/* A tangential traction below this part of the normal one is rounding: the node has no friction. Friction may be as little itself: what
 * slips with it has all of it, not this part. */
static const PetscReal ROUNDING = 1e-12, OF_FRICTION = 0.01;

PetscBool newly_rubs(const stickslip_options *options)
{
  const PetscBool cone = (PetscBool)(options->friction == STICKSLIP_FRICTION_COULOMB || options->friction == STICKSLIP_FRICTION_TRESCA);
  return (PetscBool)(cone && options->mu > 0);
}

/* Has the node a copy, on another face of a sharp edge or corner, that is in contact, too? Then it has no friction at all, be it new or not. */
static PetscBool has_copy(const ContactPart *part, const int32_t state[], PetscInt a)
{
  for (PetscInt b = 0; b < part->n1; b++) {
    if (b != a && part->vertices[b] == part->vertices[a] && state[b] != STICKSLIP_STATE_GAP) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Adds a part's normal forces to sums[0], to sums[1] those of nodes that slip without friction. */
static PetscErrorCode add_forces(const Mesh *mesh, const Interface *interface, PetscReal sums[2])
{
  const ContactPart *part = &interface->part;
  const PetscInt     n1 = part->n1, d = part->dimension;
  stickslip_states wanted = {.struct_size = sizeof(wanted)};
  PetscReal        pressed = 0;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < part->components * n1; k++)
    pressed = PetscMax(pressed, PetscAbsReal(PetscRealPart(MULTIPLIERS_OF(part, part->gathered)[k])));
  if (!verb_there(part) || !(pressed > 0)) PetscFunctionReturn(PETSC_SUCCESS); /* coverage would be sought */
  PetscCall(PetscMalloc4(n1, &wanted.state, d * n1, &wanted.traction, d * n1, &wanted.normal, n1, &wanted.coverage));
  PetscCallStickslip(verb_states(part, &wanted));
  for (PetscInt a = 0; a < n1; a++) {
    const PetscReal mu = contact_friction(mesh, interface, a), none = PetscMin(ROUNDING, OF_FRICTION * mu);
    double          n[3], t[3], p, across = 0;
    PetscInt        removed = 0;
    contact_vector(d, wanted.normal, a, n);
    contact_vector(d, wanted.traction, a, t);
    p = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
    for (int k = 0; k < 3; k++)
      across = PetscMax(across, PetscAbsReal(t[k] - p * n[k]));
    for (PetscInt k = 0; k < d; k++)
      removed += (part->removed[a] >> k) & 1;
    if (part->owned[a] != STICKSLIP_NODE_OWN || wanted.state[a] == STICKSLIP_STATE_GAP || removed >= d - 1) continue;
    sums[0] += PetscAbsReal(p) * wanted.coverage[a];
    if (mu > 0 && wanted.state[a] == STICKSLIP_STATE_SLIP && across <= none * PetscAbsReal(p) && !has_copy(part, wanted.state, a))
      sums[1] += PetscAbsReal(p) * wanted.coverage[a];
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
    if (!newly_rubs(&interface->options) || interface->method.weights != STICKSLIP_WEIGHTS_CURRENT ||
        interface->method.new_contact != STICKSLIP_NEW_CONTACT_FRICTIONLESS)
      continue;
    PetscCall(add_forces(contact->mesh, interface, sums));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    if (!(sums[1] > WITHOUT_FRICTION * sums[0])) continue;
    PetscCall(PetscSNPrintf(why, length,
                            "converged, but nodes of %s that this step newly covers act without friction in it, and carry %.2g %% of its "
                            "pressure: take shorter steps%s",
                            interface->name, (double)(100 * sums[1] / sums[0]),
                            interface->skin ? "; at an edge whose faces touch different bodies name pairs in `interfaces`"
                                            : ", or as nonmortar the side that stays covered (swap `nonmortar` and `mortar`)"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
