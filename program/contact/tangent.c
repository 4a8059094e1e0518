/* Entries of the tangent: each rank's part puts its own into the matrix, where they add up. */
#include "contact/contact.h"

static PetscErrorCode reserve(ContactPart *part, int64_t count)
{
  PetscFunctionBegin;
  if (count > part->coo_capacity) {
    part->coo_capacity = count + count / 4;
    PetscCall(PetscFree3(part->coo_rows, part->coo_columns, part->coo_values));
    PetscCall(PetscMalloc3(part->coo_capacity, &part->coo_rows, part->coo_capacity,
                           &part->coo_columns, part->coo_capacity, &part->coo_values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do n entries lie in one column, and in the rows of the n entries at the head of their block? */
static PetscBool repeats(const int64_t *head, const int64_t *rows, const int64_t *columns, PetscInt n)
{
  for (PetscInt i = 0; i < n; i++) {
    if (rows[i] != head[i] || columns[i] != columns[0]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Entries of a plan come row after row, those of a piece block after block, each by columns: one call for a row or a block,
 * which ends where its rows do not repeat. */
static PetscErrorCode insert(Entries entries, PetscBool zero, Mat matrix)
{
  enum { LONGEST = 64 };
  static const double zeros[LONGEST * LONGEST];
  PetscInt            rows[LONGEST], columns[LONGEST], n, m;

  PetscFunctionBegin;
  for (int64_t k = 0; k < entries.n; k += (int64_t)n * m) {
    const int64_t *r = entries.rows + k, *c = entries.columns + k, left = entries.n - k;
    for (n = 0; n < LONGEST && n < left && c[n] == c[0]; n++)
      rows[n] = (PetscInt)r[n];
    for (m = 0; m < LONGEST && n * (m + 1) <= left && (!m || repeats(r, r + n * m, c + n * m, n)); m++)
      columns[m] = (PetscInt)c[n * m];
    PetscCall(MatSetValues(matrix, n, rows, m, columns, zero ? zeros : entries.values + k, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which entries the tangent has here; kept until values lack one. */
static PetscErrorCode plan(const Contact *contact, ContactPart *part, int32_t pairs, int32_t *refused)
{
  PetscFunctionBegin;
  *refused = verb_plan(part, pairs, &part->planned);
  if (*refused || !part->planned) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(reserve(part, part->planned));
  *refused = verb_plan_coo(part);
  if (!*refused) PetscCall(rigid_part_plan(contact, part, part->planned));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which entries the forces of a condensed system have, with pairs that may come: into the arrays, and their number. */
static PetscErrorCode condensed_plan(const Contact *contact, ContactPart *part, int64_t *count)
{
  int64_t rows[2], counts[2];
  PetscFunctionBegin;
  PetscCallStickslip(stickslip_interface_condensed_plan(part->handle, part->x, MORTAR_OF(part, part->x),
                                                        STICKSLIP_PLAN_SKIN, rows, counts));
  *count = counts[0];
  if (*count) { /* with frozen weights forces do not depend on displacements */
    PetscCall(reserve(part, *count));
    PetscCallStickslip(stickslip_interface_plan_coo(part->handle, STICKSLIP_ENTRIES_FORCES, part->coo_capacity,
                                                    part->coo_rows, part->coo_columns));
  }
  PetscCall(rigid_part_plan(contact, part, *count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where pairs have come that the plan does not have, one of the pairs of now takes its place. */
static PetscErrorCode tangent(const Contact *contact, ContactPart *part, int32_t *refused)
{
  PetscFunctionBegin;
  *refused = part->planned ? verb_plan_values(part) : STICKSLIP_MISSING_ENTRY;
  if (*refused == STICKSLIP_MISSING_ENTRY) {
    PetscCall(plan(contact, part, STICKSLIP_PLAN_ACTIVE, refused));
    if (!*refused && part->planned) *refused = verb_plan_values(part); /* where all is prescribed there is none */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int32_t entries(ContactPart *part, int32_t piece, int64_t capacity, int64_t *rows, int64_t *columns,
                       double *values, int64_t *count)
{
  return stickslip_interface_condensed_coo(part->handle, STATE_OF(part), piece, capacity, rows, columns, values,
                                           count);
}

/* What rigid bodies make of the values in the part's array; `force`: these are derivatives of forces, which bodies turn round. The library has
 * just evaluated them. */
static PetscErrorCode rigid_values(const Contact *contact, ContactPart *part, PetscBool force, int32_t *refused)
{
  PetscFunctionBegin;
  if (!part->rigid || *refused) PetscFunctionReturn(PETSC_SUCCESS);
  if (force) *refused = verb_residual(part);
  if (!*refused) PetscCall(rigid_part_values(contact, part, force ? part->forces : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A piece into the arrays as they are; counted first where they turn out too small. */
PetscErrorCode contact_entries(const Contact *contact, ContactPart *part, int32_t piece, Entries *found, int32_t *refused)
{
  int64_t count = 0;
  PetscFunctionBegin;
  *refused = STICKSLIP_BUFFER_TOO_SMALL;
  for (int attempt = 0; attempt < 2 && *refused == STICKSLIP_BUFFER_TOO_SMALL; attempt++) {
    if (attempt || !part->coo_capacity) {
      *refused = entries(part, piece, 0, NULL, NULL, NULL, &count);
      if (*refused) break;
      PetscCall(reserve(part, count));
    }
    *refused = entries(part, piece, part->coo_capacity, part->coo_rows, part->coo_columns,
                       part->coo_values, &count);
  }
  if (!*refused) PetscCall(rigid_part_plan(contact, part, count));
  PetscCall(rigid_values(contact, part, (PetscBool)(piece == STICKSLIP_CONDENSED_FORCES), refused));
  *found = rigid_part_entries(part, count);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a condensed system what the forces depend on the displacements by; condensed_matrix() does the rest. */
PetscErrorCode contact_tangent(Contact *contact, Mat matrix, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  PetscCall(MatSetOption(matrix, MAT_ROW_ORIENTED, PETSC_FALSE)); /* as insert() has them; all ranks must call this */
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface   *interface = &contact->interfaces[i];
    ContactPart *part      = &interface->part;
    int32_t      refused   = 0;
    Entries      found     = {0};
    PetscCall(contact_gather(contact, interface, contact->physics->u_local));
    part->processor -= work_clock();
    if (part->handle && contact->condensed) {
      PetscCall(contact_entries(contact, part, STICKSLIP_CONDENSED_FORCES, &found, &refused));
    } else if (verb_there(part)) {
      PetscCall(tangent(contact, part, &refused));
      PetscCall(rigid_values(contact, part, PETSC_TRUE, &refused));
      found = rigid_part_entries(part, part->planned);
    }
    part->processor += work_clock();
    if (!refused) PetscCall(insert(found, PETSC_FALSE, matrix));
    PetscCall(contact_agree(contact, interface, refused, status));
  }
  PetscCall(MatSetOption(matrix, MAT_ROW_ORIENTED, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With the pairs that may come while the surfaces slide by less than a quarter of a facet. Of a condensed system what is
 * inserted before it is condensed; condensed_matrix() makes a pattern of its own of it. */
PetscErrorCode contact_pattern(Contact *contact, Mat matrix)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    ContactPart *part = &contact->interfaces[i].part;
    int32_t      refused;
    int64_t      count;
    PetscCall(contact_gather(contact, &contact->interfaces[i], contact->physics->u_local));
    if (!verb_there(part)) continue;
    if (contact->condensed) {
      PetscCall(condensed_plan(contact, part, &count));
    } else {
      PetscCall(plan(contact, part, STICKSLIP_PLAN_SKIN, &refused));
      PetscCallStickslip(refused);
      count = part->planned;
    }
    PetscCall(insert(rigid_part_entries(part, count), PETSC_TRUE, matrix));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What plans hold beyond the pairs of now would come into a matrix that has not got it. */
void contact_forget_plans(Contact *contact)
{
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    contact->interfaces[i].part.planned = 0;
}
