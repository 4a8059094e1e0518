/* What evaluations and steps ask of a part's handle, be it that of two sides or of a skin: the same verbs, which the library has twice. They
 * return the library's status; a part without a handle answers nothing. At the place of now: part->x and part->gathered. */
#include "contact/skin.h"

PetscBool verb_there(const ContactPart *part)
{
  return (PetscBool)(part->handle || part->skin);
}

PetscInt verb_opposite(const ContactPart *part, PetscInt a)
{
  return part->skin ? part->skin->opposite[a] : -1;
}

/* A node's force belongs to the first of its copies, so that each counts once. */
static void take_forces(ContactPart *part)
{
  const SkinPart *skin = part->skin;
  const PetscInt  d    = part->dimension;
  for (PetscInt k = 0; k < d * part->n1; k++)
    part->forces[k] = 0;
  for (PetscInt k = 0; k < d * skin->n_nodes; k++)
    part->forces[d * skin->node[k / d] + k % d] = skin->force[k];
  skin_to_part(part, d, skin->rows, MULTIPLIERS_OF(part, part->forces));
}

int32_t verb_residual(ContactPart *part)
{
  SkinPart *skin = part->skin;
  int32_t   status;
  if (part->handle)
    return stickslip_interface_residual(part->handle, STATE_OF(part), NULL, part->forces, MORTAR_OF(part, part->forces),
                                        MULTIPLIERS_OF(part, part->forces));
  if (!skin) return STICKSLIP_OK;
  skin_point(part);
  status = stickslip_skin_residual(skin->handle, skin->x, skin->lambda, skin->force, skin->rows);
  if (!status) take_forces(part);
  return status;
}

int32_t verb_initial_multipliers(ContactPart *part, double lambda[])
{
  int32_t status;
  if (part->handle) return stickslip_interface_initial_multipliers(part->handle, lambda);
  if (!part->skin) return STICKSLIP_OK;
  status = stickslip_skin_initial_multipliers(part->skin->handle, part->skin->lambda);
  if (!status) skin_to_part(part, part->dimension, part->skin->lambda, lambda);
  return status;
}

int32_t verb_step_limit(ContactPart *part, const double dx[], double depth, double *fraction)
{
  SkinPart      *skin = part->skin;
  const PetscInt d    = part->dimension;
  if (part->handle)
    return stickslip_interface_step_limit(part->handle, part->x, MORTAR_OF(part, part->x), dx, MORTAR_OF(part, dx), depth, fraction);
  if (!skin) return STICKSLIP_OK;
  skin_point(part);
  for (PetscInt k = 0; k < d * skin->n_nodes; k++)
    skin->dx[k] = dx[d * skin->node[k / d] + k % d];
  return stickslip_skin_step_limit(skin->handle, skin->x, skin->dx, depth, fraction);
}

/* One member of the states, from copies to nodes; NULL: it is not wanted. */
static void sort(const ContactPart *part, PetscInt width, double values[], double room[])
{
  if (!values) return;
  PetscCallAbort(PETSC_COMM_SELF, PetscArraycpy(room, values, width * part->n1));
  skin_to_part(part, width, room, values);
}

int32_t verb_states(const ContactPart *of, const stickslip_states *wanted)
{
  ContactPart   *part = (ContactPart *)of; /* the library's arrays are room */
  SkinPart      *skin = part->skin;
  const PetscInt d    = part->dimension, n = part->n1;
  double        *room, *one[] = {wanted->gap, wanted->coverage, wanted->area, wanted->dissipation, wanted->augmentation, wanted->share};
  double        *vectors[]    = {wanted->normal, wanted->traction, wanted->slip};
  stickslip_states of_skin;
  int32_t        status;
  if (part->handle) return stickslip_interface_states(part->handle, STATE_OF(part), NULL, wanted);
  if (!skin) return STICKSLIP_OK;
  skin_point(part);
  of_skin      = *wanted;
  of_skin.worn = of_skin.worn_volume = of_skin.damage = of_skin.bond_loss = NULL; /* of laws that a skin has not */
  status = stickslip_skin_states(skin->handle, skin->x, skin->lambda, &of_skin);
  if (status) return status;
  PetscCallAbort(PETSC_COMM_SELF, PetscMalloc1(d * n, &room));
  for (size_t k = 0; k < sizeof(one) / sizeof(one[0]); k++)
    sort(part, 1, one[k], room);
  for (size_t k = 0; k < sizeof(vectors) / sizeof(vectors[0]); k++)
    sort(part, d, vectors[k], room);
  for (PetscInt c = 0; c < n && wanted->state; c++)
    room[skin->copy[c]] = wanted->state[c];
  for (PetscInt a = 0; a < n && wanted->state; a++)
    wanted->state[a] = (int32_t)room[a];
  PetscCallAbort(PETSC_COMM_SELF, PetscFree(room));
  return status;
}

int32_t verb_equilibrium(ContactPart *part, stickslip_equilibrium *e)
{
  SkinPart *skin = part->skin;
  int64_t  *nodes[] = {&e->gap_node, &e->traction_node, &e->slip_node, &e->slide_node, &e->turn_node, &e->lag_node, &e->penetration_node,
                       &e->apart_node};
  int32_t   status;
  if (part->handle) return stickslip_interface_equilibrium(part->handle, STATE_OF(part), NULL, e);
  if (!skin) return STICKSLIP_OK;
  skin_point(part);
  status = stickslip_skin_equilibrium(skin->handle, skin->x, skin->lambda, e);
  for (size_t k = 0; k < sizeof(nodes) / sizeof(nodes[0]) && !status; k++) {
    if (*nodes[k] >= 0) *nodes[k] = skin->copy[*nodes[k]];
  }
  return status;
}

int32_t verb_plan(ContactPart *part, int32_t pairs, int64_t *count)
{
  int64_t n_rows;
  if (part->handle) return stickslip_interface_plan(part->handle, part->x, MORTAR_OF(part, part->x), pairs, &n_rows, count);
  skin_point(part);
  return stickslip_skin_plan(part->skin->handle, part->skin->x, pairs, count);
}

/* from the library's equations to the host's */
static void translate(const ContactPart *part, int64_t n, int64_t numbers[])
{
  for (int64_t k = 0; k < n; k++)
    numbers[k] = numbers[k] < 0 ? -1 : part->equations[part->skin->numbers[numbers[k]]];
}

int32_t verb_plan_coo(ContactPart *part)
{
  int32_t status;
  if (part->handle)
    return stickslip_interface_plan_coo(part->handle, STICKSLIP_ENTRIES_TANGENT, part->coo_capacity, part->coo_rows, part->coo_columns);
  status = stickslip_skin_plan_coo(part->skin->handle, part->coo_capacity, part->coo_rows, part->coo_columns);
  if (status) return status;
  translate(part, part->planned, part->coo_rows);
  translate(part, part->planned, part->coo_columns);
  return status;
}

int32_t verb_plan_values(ContactPart *part)
{
  if (part->handle) return stickslip_interface_plan_values(part->handle, STATE_OF(part), NULL, part->coo_capacity, part->coo_values);
  skin_point(part);
  return stickslip_skin_plan_values(part->skin->handle, part->skin->x, part->skin->lambda, part->coo_capacity, part->coo_values);
}

int32_t verb_use_normals(ContactPart *part, int32_t normals)
{
  if (part->handle) return stickslip_interface_use_normals(part->handle, normals);
  return part->skin ? stickslip_skin_use_normals(part->skin->handle, normals) : STICKSLIP_OK;
}

int32_t verb_turn_multipliers(ContactPart *part, double lambda[])
{
  SkinPart      *skin = part->skin;
  const PetscInt d    = part->dimension;
  int32_t        status;
  if (part->handle) return stickslip_interface_turn_multipliers(part->handle, part->x, lambda);
  if (!skin) return STICKSLIP_OK;
  skin_point(part);
  for (PetscInt k = 0; k < d * skin->n_copies; k++)
    skin->lambda[k] = lambda[d * skin->copy[k / d] + k % d];
  status = stickslip_skin_turn_multipliers(skin->handle, skin->x, skin->lambda);
  if (!status) skin_to_part(part, d, skin->lambda, lambda);
  return status;
}

/* Of a skin the multipliers may change: into part->gathered. */
int32_t verb_commit(ContactPart *part)
{
  SkinPart *skin = part->skin;
  int32_t   status;
  if (part->handle) return stickslip_interface_commit(part->handle, STATE_OF(part), NULL);
  if (!skin) return STICKSLIP_OK;
  skin_point(part);
  status = stickslip_skin_commit(skin->handle, skin->x, skin->lambda);
  if (!status) skin_to_part(part, part->dimension, skin->lambda, MULTIPLIERS_OF(part, part->gathered));
  if (!status) PetscCallAbort(PETSC_COMM_SELF, skin_look(part));
  if (!status) skin->exchanged = PETSC_FALSE;
  return status;
}

int32_t verb_rollback(ContactPart *part)
{
  int32_t status;
  if (part->handle) return stickslip_interface_rollback(part->handle);
  if (!part->skin) return STICKSLIP_OK;
  status = stickslip_skin_rollback(part->skin->handle);
  if (!status) PetscCallAbort(PETSC_COMM_SELF, skin_look(part));
  return status;
}

/* Of a skin the run's counts come first, which the library has since creation only. */
int32_t verb_history_size(const ContactPart *part, int64_t n[2])
{
  int32_t status;
  if (part->handle) return stickslip_interface_history_size(part->handle, &n[0], &n[1]);
  if (!part->skin) return STICKSLIP_OK;
  status = stickslip_skin_history_size(part->skin->handle, &n[0], &n[1]);
  n[0] += SKIN_COUNTS;
  return status;
}

int32_t verb_history_export(const ContactPart *part, const int64_t n[2], int64_t integers[], double reals[])
{
  if (part->handle) return stickslip_interface_history_export(part->handle, n[0], integers, n[1], reals);
  if (!part->skin) return STICKSLIP_OK;
  skin_counts(part, integers);
  return stickslip_skin_history_export(part->skin->handle, n[0] - SKIN_COUNTS, integers + SKIN_COUNTS, n[1], reals);
}

int32_t verb_history_import(ContactPart *part, const int64_t n[2], const int64_t integers[], const double reals[])
{
  const int64_t own = n[0] - SKIN_COUNTS;
  int64_t       counts[SKIN_COUNTS];
  int32_t       status;
  if (part->handle) return stickslip_interface_history_import(part->handle, n[0], integers, n[1], reals);
  if (!part->skin) return STICKSLIP_OK;
  status = stickslip_skin_history_import(part->skin->handle, PetscMax(own, 0), integers + n[0] - PetscMax(own, 0), n[1], reals);
  if (status) return status;
  skin_counts(part, counts);
  for (int k = 0; k < SKIN_COUNTS; k++)
    part->skin->before[k] += integers[k] - counts[k];
  PetscCallAbort(PETSC_COMM_SELF, skin_look(part));
  return status;
}
