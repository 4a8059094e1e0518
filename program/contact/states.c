/* What the library says of the nodes: their states and results; and the augmentation that single nodes are given. */
#include "contact/contact.h"
#include "physics/dynamics.h"

/* The library's r over E / h; and what inertia adds to it against a rigid body, over rho h / dt^2 of a layer of the mesh: by this a rigid ball
 * that spins on a slab takes 4 iterations a step for 11. Blocks that meet and rub would take more by it. */
static const PetscReal LAYER = 0.9, STOPS = 8;

PetscErrorCode contact_results(const ContactPart *part, double results[])
{
  const PetscInt     n1 = part->n1, d = part->dimension;
  const PetscScalar *lambda = MULTIPLIERS_OF(part, part->gathered);
  stickslip_states   wanted = {.struct_size = sizeof(wanted)};

  PetscFunctionBegin;
  if (!verb_there(part)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc7(n1, &wanted.state, d * n1, &wanted.normal, n1, &wanted.gap, d * n1, &wanted.slip, n1,
                         &wanted.coverage, n1, &wanted.area, n1, &wanted.dissipation));
  PetscCall(PetscCalloc5(n1, &wanted.share, n1, &wanted.worn, n1, &wanted.worn_volume, n1, &wanted.damage, n1, &wanted.bond_loss));
  PetscCallStickslip(verb_states(part, &wanted));
  for (PetscInt a = 0; a < n1; a++) {
    double *r = results + N_RESULTS * a;
    r[RESULT_STATE]  = wanted.state[a];
    contact_vector(d, wanted.normal, a, r + RESULT_NORMAL);
    contact_vector(d, wanted.slip, a, r + RESULT_SLIP);
    if (part->components > 1) contact_vector(d, lambda, a, r + RESULT_MULTIPLIER);
    for (int i = 0; i < 3 && part->components == 1; i++)
      r[RESULT_MULTIPLIER + i] = PetscRealPart(lambda[a]) * r[RESULT_NORMAL + i];
    r[RESULT_GAP]         = wanted.gap[a];
    r[RESULT_COVERAGE]    = wanted.coverage[a];
    r[RESULT_AREA]        = wanted.area[a];
    r[RESULT_DISSIPATION] = wanted.dissipation[a];
    r[RESULT_CLOSED]      = wanted.share[a];
    r[RESULT_LAYER + LAYER_WORN]   = wanted.worn[a];
    r[RESULT_LAYER + LAYER_VOLUME] = wanted.worn_volume[a];
    r[RESULT_LAYER + LAYER_DAMAGE] = wanted.damage[a];
    r[RESULT_LAYER + LAYER_LOSS]   = wanted.bond_loss[a];
  }
  PetscCall(PetscFree7(wanted.state, wanted.normal, wanted.gap, wanted.slip, wanted.coverage, wanted.area,
                       wanted.dissipation));
  PetscCall(PetscFree5(wanted.share, wanted.worn, wanted.worn_volume, wanted.damage, wanted.bond_loss));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the results of the nodes at home in their arrays */
static PetscErrorCode store(const double results[], PetscInt n1, ContactStates *states)
{
  PetscFunctionBegin;
  if (!states->state) {
    PetscCall(PetscMalloc7(n1, &states->state, 3 * n1, &states->normal, n1, &states->gap, 3 * n1, &states->slip, n1,
                           &states->coverage, n1, &states->area, n1, &states->dissipation));
    PetscCall(PetscMalloc3(3 * n1, &states->multiplier, n1, &states->closed, N_LAYER_RESULTS * n1, &states->layer));
  }
  for (PetscInt a = 0; a < n1; a++) {
    const double *r        = results + N_RESULTS * a;
    states->state[a]       = (int32_t)r[RESULT_STATE];
    states->gap[a]         = r[RESULT_GAP];
    states->coverage[a]    = r[RESULT_COVERAGE];
    states->area[a]        = r[RESULT_AREA];
    states->dissipation[a] = r[RESULT_DISSIPATION];
    states->closed[a]      = r[RESULT_CLOSED];
    PetscCall(PetscArraycpy(states->normal + 3 * a, r + RESULT_NORMAL, 3));
    PetscCall(PetscArraycpy(states->multiplier + 3 * a, r + RESULT_MULTIPLIER, 3));
    PetscCall(PetscArraycpy(states->slip + 3 * a, r + RESULT_SLIP, 3));
    PetscCall(PetscArraycpy(states->layer + N_LAYER_RESULTS * a, r + RESULT_LAYER, N_LAYER_RESULTS));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The forces of all parts on each node; copies of a vertex have forces of their own. */
static PetscErrorCode collect_forces(Interface *interface)
{
  const ContactPart *part = &interface->part;
  const PetscInt     d = part->dimension, n = part->n1 + part->n2, n_home = interface->n1 + interface->n2;
  PetscScalar       *one, *sums;
  PetscSF            sf;
  PetscFunctionBegin;
  PetscCall(homes_fetch_create(interface, n, part->nodes, &sf));
  PetscCall(PetscMalloc2(n, &one, n_home, &sums));
  for (PetscInt i = 0; i < d; i++) { /* of one number a node PETSc knows the sum */
    for (PetscInt k = 0; k < n; k++)
      one[k] = part->forces[d * k + i];
    PetscCall(PetscArrayzero(sums, n_home));
    PetscCall(PetscSFReduceBegin(sf, MPIU_SCALAR, one, sums, MPIU_SUM));
    PetscCall(PetscSFReduceEnd(sf, MPIU_SCALAR, one, sums, MPIU_SUM));
    for (PetscInt k = 0; k < n_home; k++)
      interface->forces[d * k + i] = sums[k];
  }
  PetscCall(PetscFree2(one, sums));
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_collect(Contact *contact)
{
  Physics *physics = contact->physics;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface         *interface = &contact->interfaces[i];
    const ContactPart *part      = &interface->part;
    double            *here, *all;
    PetscCall(PetscMalloc2(N_RESULTS * part->n1, &here, N_RESULTS * interface->n1, &all));
    PetscCall(contact_results(part, here));
    PetscCall(parts_collect(part, N_RESULTS, here, all));
    PetscCall(store(all, interface->n1, &interface->states));
    PetscCall(PetscFree2(here, all));
    PetscCall(contact_fetch(interface->sf, physics->u_local, interface->displacements));
    PetscCall(collect_forces(interface));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of a part's nodes: state, and the tangential part of the projected traction */
static PetscErrorCode tendencies(const ContactPart *part, double results[])
{
  const PetscInt   n1 = part->n1, d = part->dimension;
  stickslip_states wanted = {.struct_size = sizeof(wanted)};
  PetscFunctionBegin;
  if (!verb_there(part)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(n1, &wanted.state, d * n1, &wanted.traction, d * n1, &wanted.normal));
  PetscCallStickslip(verb_states(part, &wanted));
  for (PetscInt a = 0; a < n1; a++) {
    double n[3], t[3], p;
    contact_vector(d, wanted.normal, a, n);
    contact_vector(d, wanted.traction, a, t);
    p = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
    /* no multiplier: it acts on nothing */
    results[4 * a] = part->removed[a] == 7 ? STICKSLIP_STATE_GAP : wanted.state[a];
    for (int k = 0; k < 3; k++)
      results[4 * a + 1 + k] = t[k] - p * n[k];
  }
  PetscCall(PetscFree3(wanted.state, wanted.traction, wanted.normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* over the nodes at home of all interfaces, one interface after the other, at u_local: states; tangential parts of the projected
 * tractions */
PetscErrorCode contact_tendencies(Contact *contact, int32_t *state, double *tangential)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface         *interface = &contact->interfaces[i];
    const ContactPart *part      = &interface->part;
    double            *here, *all;
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    PetscCall(PetscMalloc2(4 * part->n1, &here, 4 * interface->n1, &all));
    PetscCall(tendencies(part, here));
    PetscCall(parts_collect(part, 4, here, all));
    for (PetscInt a = 0; a < interface->n1; a++) {
      *state++ = (int32_t)all[4 * a];
      for (int k = 0; k < 3; k++)
        *tangential++ = all[4 * a + 1 + k];
    }
    PetscCall(PetscFree2(here, all));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The augmentation r of an interface's nodes that are marked at home (NULL: of all), times `factor`; `added` over r is added. */
static PetscErrorCode scale_augmentation(const Interface *interface, const PetscBool marked[], PetscReal factor, PetscReal added)
{
  const ContactPart *part   = &interface->part;
  stickslip_states   wanted = {.struct_size = sizeof(wanted)};
  double            *r, *all, *here;
  PetscFunctionBegin;
  PetscCall(PetscMalloc3(part->n1, &r, part->n1, &here, interface->n1, &all));
  for (PetscInt a = 0; a < interface->n1; a++)
    all[a] = !marked || marked[a] ? factor : 1;
  PetscCall(parts_send(part, 1, all, here));
  wanted.augmentation = r;
  if (part->handle) PetscCallStickslip(stickslip_interface_states(part->handle, STATE_OF(part), NULL, &wanted));
  for (PetscInt a = 0; a < part->n1; a++) {
    if (part->owned[a] == STICKSLIP_NODE_OWN) r[a] = r[a] * here[a] + added / r[a];
  }
  PetscCall(parts_share(part, 1, r));
  PetscCall(PetscArraycpy(part->augmentation, r, part->n1));
  if (part->handle) PetscCallStickslip(stickslip_interface_set_augmentation(part->handle, r));
  PetscCall(PetscFree3(r, here, all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The augmentation of the nodes marked (those at home of all interfaces, one after the other) times `factor`. The answer does not
 * depend on it, but where points decide, which keep theirs. */
PetscErrorCode contact_scale_augmentation(Contact *contact, const PetscBool *marked, PetscReal factor)
{
  PetscInt first = 0;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    if (!decision_is_points(&contact->interfaces[i]) && !contact->interfaces[i].skin) /* pieces come and go */
      PetscCall(scale_augmentation(&contact->interfaces[i], marked ? marked + first : NULL, factor, 0));
    first += contact->interfaces[i].n1;
  }
  contact->scaled = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What inertia adds to r, times r, whose h it is: a layer is stiffer in a step than at rest, and by r Newton's method finds the states of nodes that
 * rub. With the masses spread nodes have none. */
static PetscReal inertia(const Contact *contact, const Interface *interface)
{
  const Dynamics *dynamics = contact->physics->dynamics;
  if (!dynamics || dynamics->spread || interface->skin || interface->method.augmentation > 0) return 0;
  return STOPS * interface->density * interface->young * PetscSqr(LAYER / dynamics->dt);
}

/* Back to the scene's, of a step; so it begins. Where inertia adds to that of one interface, those of all are known to the parts, which take them
 * along when they are made anew. */
PetscErrorCode contact_reset_augmentation(Contact *contact)
{
  const PetscBool was_scaled = contact->scaled;
  PetscFunctionBegin;
  contact->scaled = PETSC_FALSE;
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    if (inertia(contact, &contact->interfaces[i]) > 0) contact->scaled = PETSC_TRUE;
  for (PetscInt i = 0; (was_scaled || contact->scaled) && i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    if (decision_is_points(interface)) continue;
    if (interface->part.handle) PetscCallStickslip(stickslip_interface_set_augmentation(interface->part.handle, NULL));
    if (contact->scaled && !interface->skin) PetscCall(scale_augmentation(interface, NULL, 1, inertia(contact, interface)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_states_destroy(ContactStates *states)
{
  PetscFunctionBegin;
  PetscCall(PetscFree7(states->state, states->normal, states->gap, states->slip, states->coverage, states->area,
                       states->dissipation));
  PetscCall(PetscFree3(states->multiplier, states->closed, states->layer));
  PetscFunctionReturn(PETSC_SUCCESS);
}
