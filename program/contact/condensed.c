/* A system without multipliers (`unknowns: displacements`): the rows of the non-mortar nodes give the multipliers, and the
 * library says what to multiply and to add. Multipliers stay in the local vectors, as entries that are no unknowns; each
 * interface keeps their values.
 *
 * Newton's iterates are those of the system with multipliers. A step starts with given multipliers: those of the last
 * one, extrapolated as the displacements are, or the library's initial ones. After an iteration the multipliers are
 * those that the linearised rows give for the displacements: those at the place of the last matrix, J du added. So they
 * are a function of the displacements for a line search, too. (To take those that the rows of now give is simpler, and
 * as good where the start is: c_examples/profile_host.c. From an extrapolated start of a body that is nearly
 * incompressible they are far off, and a press fit over an edge takes twice as many iterations.) */
#include "contact/contact.h"

/* The nodes of a side of an interface, of the range of vertices that this rank keeps a directory of. */
static PetscErrorCode list_nodes(const Mesh *mesh, const Interface *interface, int side, int64_t nodes[], int64_t *n)
{
  const PetscInt count = side ? interface->n2 : interface->n1;
  PetscInt       n_here, *ones, *marks;
  PetscSF        directory;
  PetscFunctionBegin;
  PetscCall(directory_create(mesh, count, interface->nodes + (side ? interface->n1 : 0), &n_here, &directory));
  PetscCall(PetscMalloc1(count, &ones));
  PetscCall(PetscCalloc1(n_here, &marks));
  for (PetscInt k = 0; k < count; k++)
    ones[k] = 1;
  PetscCall(PetscSFReduceBegin(directory, MPIU_INT, ones, marks, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(directory, MPIU_INT, ones, marks, MPI_REPLACE));
  for (PetscInt v = 0; v < n_here; v++) {
    if (marks[v]) nodes[(*n)++] = v;
  }
  PetscCall(PetscFree(ones));
  PetscCall(PetscFree(marks));
  PetscCall(PetscSFDestroy(&directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An interface cannot share nodes with another one, where these have multipliers in either. */
PetscErrorCode condensed_check(const Contact *contact, char why[], size_t length)
{
  const Mesh *mesh = contact->mesh;
  int64_t    *offsets[2], *nodes[2], n[2] = {0, 0}, found;
  PetscInt    n_here;
  PetscSF     directory;
  int32_t     status;

  PetscFunctionBegin;
  why[0] = 0;
  if (!contact->n_interfaces) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(directory_create(mesh, 0, NULL, &n_here, &directory));
  PetscCall(PetscSFDestroy(&directory));
  for (int side = 0; side < 2; side++) {
    PetscCall(PetscCalloc2(contact->n_interfaces + 1, &offsets[side], contact->n_interfaces * n_here, &nodes[side]));
    for (PetscInt i = 0; i < contact->n_interfaces; i++) {
      PetscCall(list_nodes(mesh, &contact->interfaces[i], side, nodes[side], &n[side]));
      offsets[side][i + 1] = n[side];
    }
  }
  status = stickslip_crosspoints_find(contact->n_interfaces, offsets[0], nodes[0], offsets[1], nodes[1], 0, NULL, NULL,
                                      NULL, &found);
  PetscCheck(!status, PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s", stickslip_last_error_message());
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT64_T, MPI_SUM, PETSC_COMM_WORLD));
  if (found)
    PetscCall(PetscSNPrintf(why, length,
                            "%" PRId64 " nodes belong to several interfaces, and have a multiplier in one of them: their "
                            "multipliers cannot be condensed; take `unknowns: multipliers`",
                            found));
  for (int side = 0; side < 2; side++)
    PetscCall(PetscFree2(offsets[side], nodes[side]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt n_multipliers(const ContactPart *part)
{
  return part->components * part->n1;
}

/* The initial multipliers are those of the last step before the first one. */
PetscErrorCode condensed_create(Contact *contact, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < contact->n_interfaces && !*status && contact->condensed; i++) {
    Interface   *interface = &contact->interfaces[i];
    ContactPart *part      = &interface->part;
    int32_t      refused   = 0;
    if (part->handle && interface->initial_contact)
      refused = stickslip_interface_initial_multipliers(part->handle, part->lambda_last);
    PetscCall(contact_agree(contact, interface, refused, status));
    PetscCall(parts_share(part, part->components, part->lambda_last));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode condensed_destroy(Contact *contact)
{
  PetscFunctionBegin;
  PetscCall(MatDestroy(&contact->linear));
  PetscCall(VecDestroy(&contact->place));
  PetscCall(reduction_destroy(contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The multipliers that a step starts with: the last ones, and `factor` times what they differ by from those before. */
void condensed_predict(Contact *contact, PetscReal factor)
{
  for (PetscInt i = 0; i < contact->n_interfaces && contact->condensed; i++) {
    ContactPart *part = &contact->interfaces[i].part;
    for (PetscInt k = 0; k < n_multipliers(part); k++)
      part->lambda_start[k] =
        part->lambda_last[k] + factor * (part->lambda_last[k] - part->lambda_before[k]);
  }
}

void condensed_accept(Contact *contact)
{
  for (PetscInt i = 0; i < contact->n_interfaces && contact->condensed; i++) {
    ContactPart *part = &contact->interfaces[i].part;
    for (PetscInt k = 0; k < n_multipliers(part); k++) {
      part->lambda_before[k] = part->lambda_last[k];
      part->lambda_last[k]   = part->lambda[k];
    }
  }
}

/* Each attempt at a step starts alike. */
PetscErrorCode condensed_begin(Contact *contact)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces && contact->condensed; i++)
    PetscCall(PetscArraycpy(contact->interfaces[i].part.lambda, contact->interfaces[i].part.lambda_start,
                            n_multipliers(&contact->interfaces[i].part)));
  PetscCall(MatDestroy(&contact->linear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The multipliers at x, of the rows as they were linearised at `place`. */
static PetscErrorCode update_multipliers(Contact *contact, Vec x, PetscInt *status)
{
  Vec du, f, local;
  PetscFunctionBegin;
  *status = 0;
  if (!contact->linear) PetscFunctionReturn(PETSC_SUCCESS); /* the given ones */
  PetscCall(VecDuplicate(x, &du));
  PetscCall(VecDuplicate(x, &f));
  PetscCall(VecWAXPY(du, -1, contact->place, x));
  PetscCall(MatMult(contact->linear, du, f));
  PetscCall(DMGetLocalVector(contact->mesh->dm, &local));
  PetscCall(VecZeroEntries(local));
  PetscCall(DMGlobalToLocalBegin(contact->mesh->dm, f, INSERT_VALUES, local));
  PetscCall(DMGlobalToLocalEnd(contact->mesh->dm, f, INSERT_VALUES, local));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface   *interface = &contact->interfaces[i];
    ContactPart *part      = &interface->part;
    double      *rows      = part->rows;
    int32_t      refused   = 0;
    PetscCall(contact_fetch(part->sf, local, rows));
    for (PetscInt k = 0; k < part->dimension * part->n1; k++)
      rows[k] += part->host_there[k];
    if (part->handle)
      refused = stickslip_interface_condensed_multipliers(part->handle, part->x_there, MORTAR_OF(part, part->x_there), rows,
                                                          part->lambda);
    PetscCall(contact_agree(contact, interface, refused, status));
    PetscCall(parts_share(part, part->components, part->lambda));
  }
  PetscCall(DMRestoreLocalVector(contact->mesh->dm, &local));
  PetscCall(VecDestroy(&du));
  PetscCall(VecDestroy(&f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multipliers at x; the forces of the bodies, which f_local has so far, and the loads, at the interfaces' nodes. */
PetscErrorCode condensed_eliminate(Contact *contact, Vec x, PetscInt *status)
{
  Physics *physics = contact->physics;
  Vec      host;
  PetscFunctionBegin;
  *status = 0;
  if (!contact->condensed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMGetLocalVector(contact->mesh->dm, &host));
  PetscCall(VecWAXPY(host, -1, physics->f_external, physics->f_local));
  PetscCall(unknowns_sum(physics, host));
  PetscCall(DMRestoreLocalVector(contact->mesh->dm, &host));
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    PetscCall(contact_fetch(contact->interfaces[i].part.sf, physics->f_sum, contact->interfaces[i].part.host));
  PetscCall(update_multipliers(contact, x, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rows are linearised at x. */
static PetscErrorCode keep_rows(Contact *contact, Vec x, Mat J)
{
  PetscFunctionBegin;
  PetscCall(MatDestroy(&contact->linear));
  PetscCall(MatDuplicate(J, MAT_COPY_VALUES, &contact->linear));
  if (!contact->place) PetscCall(VecDuplicate(x, &contact->place));
  PetscCall(VecCopy(x, contact->place));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    ContactPart *part = &contact->interfaces[i].part;
    PetscCall(PetscArraycpy(part->x_there, part->x, part->dimension * (part->n1 + part->n2)));
    PetscCall(PetscArraycpy(part->host_there, part->host, part->dimension * part->n1));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What turns a part's forces, and those of bodies and loads at its own nodes, into its share of the condensed rows. */
static int32_t condense(ContactPart *part)
{
  const PetscInt d = part->dimension, n1 = d * part->n1, n2 = d * part->n2;
  double        *rows = part->rows;
  const int32_t  status =
    stickslip_interface_condensed_residual(part->handle, STATE_OF(part), part->host, rows, rows + n1);
  for (PetscInt k = 0; k < n1 + n2 && !status; k++) {
    const PetscBool own = (PetscBool)(k < n1 && part->owned[k / d] == STICKSLIP_NODE_OWN);
    rows[k] -= part->forces[k] + (own ? part->host[k] : 0);
  }
  return status;
}

/* Makes of the forces' residual that of the system without multipliers. */
PetscErrorCode condensed_residual(Contact *contact, Vec r, PetscInt *status)
{
  Physics *physics = contact->physics;
  PetscFunctionBegin;
  *status = 0;
  if (!contact->condensed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecZeroEntries(physics->f_sum));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(contact, interface, physics->u_local));
    if (interface->part.handle) refused = condense(&interface->part);
    PetscCall(contact_agree(contact, interface, refused, status));
    if (!*status) PetscCall(contact_scatter(&interface->part, interface->part.rows, physics->f_sum, MPIU_SUM));
  }
  PetscCall(rigids_collect(physics, physics->f_sum, PETSC_FALSE));
  PetscCall(DMLocalToGlobalBegin(contact->mesh->dm, physics->f_sum, ADD_VALUES, r));
  PetscCall(DMLocalToGlobalEnd(contact->mesh->dm, physics->f_sum, ADD_VALUES, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* J becomes J + E J + G: E eliminates the multipliers, G has the constraints. */
PetscErrorCode condensed_matrix(Contact *contact, Vec x, Mat J, PetscInt *status)
{
  Mat E = NULL, G = NULL, EJ;
  PetscFunctionBegin;
  *status = 0;
  if (!contact->condensed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(keep_rows(contact, x, J));
  PetscCall(condensed_piece(contact, STICKSLIP_CONDENSED_ELIMINATION, J, &E, status));
  if (!*status) PetscCall(condensed_piece(contact, STICKSLIP_CONDENSED_CONSTRAINTS, J, &G, status));
  if (!*status) PetscCall(reduction_make(contact, J, status));
  if (!*status) {
    PetscCall(MatMatMult(E, J, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &EJ));
    PetscCall(MatAXPY(EJ, 1, G, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatAXPY(J, 1, EJ, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatSetOption(J, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE)); /* it has become another matrix */
    PetscCall(MatDestroy(&EJ));
  }
  PetscCall(MatDestroy(&E));
  PetscCall(MatDestroy(&G));
  PetscFunctionReturn(PETSC_SUCCESS);
}
