/* What the library says of the nodes: their states and results; and the augmentation that single nodes are given. */
#include "contact/contact.h"

/* vectors of the interface, as the library has them, each made of three components where it has two */
static void widen(const Interface *interface, double vectors[])
{
  for (PetscInt a = interface->n1 - 1; a >= 0; a--) {
    PetscReal v[3];
    contact_vector(interface, vectors, a, v);
    for (int i = 0; i < 3; i++)
      vectors[3 * a + i] = v[i];
  }
}

PetscErrorCode contact_states_create(const Interface *interface, ContactStates *states)
{
  const PetscInt     n1     = interface->n1;
  const PetscScalar *lambda = MULTIPLIERS_OF(interface, interface->gathered);
  stickslip_states   wanted = {.struct_size = sizeof(wanted)};

  PetscFunctionBegin;
  PetscCall(PetscMalloc7(n1, &states->state, 3 * n1, &states->normal, n1, &states->gap, 3 * n1, &states->slip, n1,
                         &states->coverage, n1, &states->area, n1, &states->dissipation));
  PetscCall(PetscMalloc1(3 * n1, &states->multiplier));
  wanted.state       = states->state;
  wanted.normal      = states->normal;
  wanted.gap         = states->gap;
  wanted.slip        = states->slip;
  wanted.coverage    = states->coverage;
  wanted.area        = states->area;
  wanted.dissipation = states->dissipation;
  PetscCallStickslip(stickslip_interface_states(interface->handle, STATE_OF(interface), NULL, &wanted));
  widen(interface, states->normal);
  widen(interface, states->slip);
  for (PetscInt a = 0; a < n1; a++) {
    double *vector = states->multiplier + 3 * a;
    if (interface->components > 1) contact_vector(interface, lambda, a, vector);
    for (int i = 0; i < 3 && interface->components == 1; i++)
      vector[i] = PetscRealPart(lambda[a]) * states->normal[3 * a + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0, over the nodes of all interfaces, one interface after the other, at u_local: states; tangential parts of the
 * projected tractions */
PetscErrorCode contact_tendencies(Contact *contact, int32_t *state, double *tangential)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface       *interface = &contact->interfaces[i];
    stickslip_states wanted    = {.struct_size = sizeof(wanted), .state = state, .traction = tangential};
    double          *normal;
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    if (contact->mesh->rank) continue;
    PetscCall(PetscMalloc1(3 * interface->n1, &normal));
    wanted.normal = normal;
    PetscCallStickslip(stickslip_interface_states(interface->handle, STATE_OF(interface), NULL, &wanted));
    widen(interface, tangential);
    widen(interface, normal);
    for (PetscInt a = 0; a < interface->n1; a++, tangential += 3) {
      const double *n = normal + 3 * a, p = tangential[0] * n[0] + tangential[1] * n[1] + tangential[2] * n[2];
      for (int k = 0; k < 3; k++)
        tangential[k] -= p * n[k];
      if (interface->removed[a] == 7) state[a] = STICKSLIP_STATE_GAP; /* no multiplier: it acts on nothing */
    }
    PetscCall(PetscFree(normal));
    state += interface->n1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The augmentation of the nodes marked (rank 0; all interfaces, one after the other) times `factor`; NULL: back to the
 * scene's. The answer does not depend on it. */
PetscErrorCode contact_scale_augmentation(Contact *contact, const PetscBool *marked, PetscReal factor)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces && contact->mesh->rank == 0; i++) {
    Interface       *interface = &contact->interfaces[i];
    stickslip_states wanted    = {.struct_size = sizeof(wanted)};
    double          *r;
    if (!marked) {
      PetscCallStickslip(stickslip_interface_set_augmentation(interface->handle, NULL));
      continue;
    }
    PetscCall(PetscMalloc1(interface->n1, &r));
    wanted.augmentation = r;
    PetscCallStickslip(stickslip_interface_states(interface->handle, STATE_OF(interface), NULL, &wanted));
    for (PetscInt a = 0; a < interface->n1; a++) {
      if (marked[a]) r[a] *= factor;
    }
    PetscCallStickslip(stickslip_interface_set_augmentation(interface->handle, r));
    PetscCall(PetscFree(r));
    marked += interface->n1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_states_destroy(ContactStates *states)
{
  PetscFunctionBegin;
  PetscCall(PetscFree7(states->state, states->normal, states->gap, states->slip, states->coverage, states->area,
                       states->dissipation));
  PetscCall(PetscFree(states->multiplier));
  PetscFunctionReturn(PETSC_SUCCESS);
}
