/* What forces and rows of all interfaces change by along a direction in what they depend on (docs/formulation, 18). */
#include "contact/contact.h"

PetscBool contact_mortar_stays(const ContactPart *part)
{
  const int64_t *equations = MORTAR_OF(part, part->equations);
  for (PetscInt k = 0; k < part->dimension * part->n2; k++) {
    if (equations[k] >= 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The library has no derivatives by places of a mortar side without equations. Where all of it is moved alike, the other side moves back. */
static void move_back(const ContactPart *part, double values[])
{
  const PetscInt d      = part->dimension;
  double        *mortar = MORTAR_OF(part, values);
  for (PetscInt k = d; k < d * part->n2; k++) {
    if (mortar[k] != mortar[k % d]) return;
  }
  for (PetscInt k = 0; k < d * part->n1; k++)
    values[k] -= mortar[k % d];
  for (PetscInt k = d * part->n2; k-- > 0;)
    mortar[k] = 0;
}

/* Values of the part's nodes, in the layout of `gathered`; NULL: of no vector */
static PetscErrorCode fetch(const ContactPart *part, Vec local, double **values)
{
  const PetscInt n = part->dimension * (part->n1 + part->n2) + part->components * part->n1;
  PetscFunctionBegin;
  *values = NULL;
  if (!local) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, values));
  PetscCall(contact_fetch(part->sf, local, *values));
  if (part->n2 && contact_mortar_stays(part)) move_back(part, *values);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const double *unless_zero(PetscInt n, const double values[])
{
  for (PetscInt k = 0; k < n; k++) {
    if (values[k] != 0) return values;
  }
  return NULL;
}

/* the same number for n nodes; NULL: 0 */
static PetscErrorCode constant(PetscInt n, PetscReal value, double **values)
{
  PetscFunctionBegin;
  *values = NULL;
  if (value == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, values));
  for (PetscInt k = 0; k < n; k++)
    (*values)[k] = value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a mortar side without equations the library has no rows. Its forces are what the other side's ask for; where on it they act makes no
 * difference to whoever holds it. */
static void balance_mortar(const ContactPart *part, double change[])
{
  const PetscInt d      = part->dimension;
  double        *mortar = MORTAR_OF(part, change);
  if (!part->n2 || !contact_mortar_stays(part)) return;
  for (PetscInt k = 0; k < d * part->n2; k++)
    mortar[k] = 0;
  for (PetscInt k = 0; k < d * part->n1; k++)
    mortar[k % d] -= change[k];
}

/* Of one part, into `change`, as `forces` */
static PetscErrorCode of_part(const ContactPart *part, const ContactDirection *direction, PetscBool named, double change[], int32_t *refused)
{
  const PetscInt      d = part->dimension, n = d * (part->n1 + part->n2);
  double             *previous, *now, *friction, *offsets, limit = direction->shear_limit;
  stickslip_direction along = {.struct_size = sizeof(along)};
  PetscFunctionBegin;
  PetscCall(fetch(part, direction->previous, &previous));
  PetscCall(fetch(part, direction->now, &now));
  PetscCall(constant(part->n1, named ? direction->friction : 0, &friction));
  PetscCall(constant(part->n1, named ? direction->offset : 0, &offsets));
  if (previous) {
    along.previous1 = unless_zero(d * part->n1, previous);
    along.previous2 = unless_zero(d * part->n2, MORTAR_OF(part, previous));
  }
  if (now) {
    along.now1 = unless_zero(d * part->n1, now);
    along.now2 = unless_zero(d * part->n2, MORTAR_OF(part, now));
  }
  along.friction    = friction;
  along.offsets1    = offsets;
  along.shear_limit = named && limit != 0 ? &limit : NULL;
  *refused          = STICKSLIP_OK;
  if (part->handle)
    *refused = stickslip_interface_sensitivity(part->handle, STATE_OF(part), &along, change, MORTAR_OF(part, change), MULTIPLIERS_OF(part, change));
  if (part->handle && !*refused && now && direction->multipliers) { /* forces are linear in the multipliers, with the weights of now */
    double *more;
    PetscCall(PetscCalloc1(n + part->components * part->n1, &more));
    *refused = stickslip_interface_residual(part->handle, part->x, MORTAR_OF(part, part->x), MULTIPLIERS_OF(part, now), NULL, more,
                                            MORTAR_OF(part, more), MULTIPLIERS_OF(part, more));
    for (PetscInt k = 0; k < n; k++)
      change[k] += more[k];
    PetscCall(PetscFree(more));
  }
  balance_mortar(part, change);
  PetscCall(PetscFree(previous));
  PetscCall(PetscFree(now));
  PetscCall(PetscFree(friction));
  PetscCall(PetscFree(offsets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_along(Contact *contact, const ContactDirection *direction, Vec f_local, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface   *interface = &contact->interfaces[i];
    ContactPart *part      = &interface->part;
    double      *change;
    int32_t      refused = 0;
    PetscCall(PetscCalloc1(part->dimension * (part->n1 + part->n2) + part->components * part->n1, &change));
    PetscCall(of_part(part, direction, (PetscBool)(i == direction->interface), change, &refused));
    PetscCall(contact_agree(contact, interface, refused, status));
    if (!*status) PetscCall(contact_scatter(part, change, f_local, MPIU_SUM));
    PetscCall(PetscFree(change));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
