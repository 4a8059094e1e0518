/* Interfaces are shared out anew: where surfaces have slid so far that parts may lack mortar facets, and, between steps, where the
 * partition no longer balances the contact that there is. What the parts know goes with their nodes: new handles of the first
 * configuration are given t_n and the slip up to it. */
#include "contact/contact.h"

/* More than this times the mean on one rank, of pairs active: the partition may be worth a change. */
static const double IMBALANCE = 1.2;
/* What a change must save of the largest share, at least. A partition of few facets cannot be even. */
static const double SAVES = 0.1;
/* Between steps parts get new mortar facets where less than this part of the margin is left. */
static const PetscReal SPARE = 0.5;

/* What travels with a node: multipliers of four times, forces of the bodies now and where the last matrix was made, slip, augmentation,
 * what the law remembers. */
static PetscInt width(const Interface *interface)
{
  const ContactPart *part = &interface->part;
  return 4 * part->components + 3 * part->dimension + 1 + interface->n_states;
}

/* to `packed` or from it, n1 nodes */
static void pack(const Interface *interface, double packed[], PetscBool from)
{
  const ContactPart *part = &interface->part;
  const PetscInt     c = part->components, d = part->dimension;
  const struct {
    double  *of;
    PetscInt width;
  } arrays[] = {{part->lambda, c},   {part->lambda_start, c}, {part->lambda_last, c}, {part->lambda_before, c}, {part->host, d},
                {part->host_there, d}, {part->slip, d},       {part->augmentation, 1}, {part->way, interface->n_states}};
  for (PetscInt a = 0; a < part->n1; a++) {
    double *at = packed + width(interface) * a;
    for (size_t k = 0; k < sizeof(arrays) / sizeof(*arrays); k++) {
      for (PetscInt i = 0; i < arrays[k].width; i++, at++) {
        double *value = arrays[k].of + arrays[k].width * a + i;
        if (from)
          *value = *at;
        else
          *at = *value;
      }
    }
  }
}

/* from all parts to homes: `n` numbers here */
PetscErrorCode parts_knowledge(const Interface *interface, PetscInt *n_a_node, double **all)
{
  const ContactPart *part = &interface->part;
  double            *here;
  PetscFunctionBegin;
  *n_a_node = width(interface);
  PetscCall(PetscMalloc1(width(interface) * part->n1, &here));
  PetscCall(PetscMalloc1(width(interface) * interface->n1, all));
  pack(interface, here, PETSC_FALSE);
  PetscCall(parts_collect(part, width(interface), here, *all));
  PetscCall(PetscFree(here));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* and from there to the parts that there are now; frees it */
PetscErrorCode parts_hand_out(const Interface *interface, double *all)
{
  const ContactPart *part = &interface->part;
  double            *here;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(width(interface) * part->n1, &here));
  PetscCall(parts_send(part, width(interface), all, here));
  PetscCall(parts_share(part, width(interface), here));
  pack(interface, here, PETSC_TRUE);
  PetscCall(PetscFree(here));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A local vector of the place where the last matrix was made. */
static PetscErrorCode get_place(Contact *contact, Vec *local)
{
  PetscFunctionBegin;
  PetscCall(DMGetLocalVector(contact->mesh->dm, local));
  PetscCall(VecCopy(contact->physics->prescribed_local, *local));
  PetscCall(DMGlobalToLocalBegin(contact->mesh->dm, contact->place, INSERT_VALUES, *local));
  PetscCall(DMGlobalToLocalEnd(contact->mesh->dm, contact->place, INSERT_VALUES, *local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The new part's handle, as the old one is: t_n and slip, law, offsets, augmentation, normals and friction of the phase. */
static PetscErrorCode revive(Contact *contact, Interface *interface, int32_t *refused)
{
  ContactPart *part = &interface->part;
  PetscFunctionBegin;
  *refused = 0;
  if (part->n1) PetscCall(part_handle(part, &interface->options, &part->handle, refused));
  PetscCall(contact_fetch(part->sf, contact->committed, part->gathered));
  contact_positions(part);
  if (interface->normals) {
    int32_t status;
    PetscCall(lag_set(interface, *refused ? NULL : part->handle, &status));
    if (!*refused) *refused = status;
  }
  if (!part->handle || *refused) PetscFunctionReturn(PETSC_SUCCESS);
  *refused = offsets_set(interface, part->handle, contact->t_committed);
  if (!*refused) *refused = law_set(interface, part->handle);
  if (!*refused && contact->n_commits)
    *refused = stickslip_interface_set_committed(part->handle, part->x, MORTAR_OF(part, part->x), part->slip, contact->n_commits);
  if (!*refused && contact->n_commits) *refused = law_restore(interface, part);
  if (!*refused && interface->offsets.curve.n) *refused = offsets_set(interface, part->handle, contact->physics->t);
  if (!*refused && contact->scaled && !decision_is_points(interface))
    *refused = stickslip_interface_set_augmentation(part->handle, part->augmentation);
  if (!*refused && contact->settles && interface->method.normals == STICKSLIP_NORMALS_CURRENT)
    *refused = stickslip_interface_use_normals(part->handle, STICKSLIP_NORMALS_COMMITTED);
  if (!*refused && contact->sticks) *refused = sticking_set(contact, interface, part->handle);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The positions where the last matrix was made. */
static PetscErrorCode revive_place(Contact *contact, Interface *interface)
{
  ContactPart *part = &interface->part;
  Vec          local;
  PetscFunctionBegin;
  if (!contact->linear) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(get_place(contact, &local));
  PetscCall(contact_fetch(part->sf, local, part->gathered));
  contact_positions(part);
  PetscCall(PetscArraycpy(part->x_there, part->x, part->dimension * (part->n1 + part->n2)));
  PetscCall(DMRestoreLocalVector(contact->mesh->dm, &local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What counts on from the old part. */
static PetscErrorCode carry_counts(const ContactPart *old, ContactPart *new)
{
  stickslip_counters counters = {.struct_size = sizeof(counters)};
  PetscFunctionBegin;
  new->bytes = old->bytes;
  new->processor += old->processor;
  new->spent = old->spent;
  if (!old->handle) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallStickslip(part_counters(old, &counters));
  new->spent = counters;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By interface->owner, with what `n` ways need; `all`: what the parts know, which is freed. Where the library refuses, the parts are
 * those that they were. */
static PetscErrorCode share_out(Contact *contact, PetscInt number, PetscInt n, const Vec ways[][2], double *all, PetscInt *status)
{
  Interface *interface = &contact->interfaces[number], old = *interface;
  int32_t    refused;

  PetscFunctionBegin;
  interface->part = (ContactPart){0};
  halo_forget(&interface->halo);
  interface->offsets.part_nodal = interface->offsets.part_round = interface->offsets.now = NULL;
  PetscCall(part_create(contact, number, n, ways));
  PetscCall(parts_hand_out(interface, all));
  PetscCall(revive(contact, interface, &refused)); /* of the first configuration, where the new part still is */
  PetscCall(revive_place(contact, interface));
  PetscCall(contact_agree(contact, interface, refused, status));
  if (!*status) {
    PetscCall(carry_counts(&old.part, &interface->part));
    PetscCall(contact_gather(contact, interface, contact->committed));
  } else {
    Interface new = *interface;
    *interface    = old;
    old           = new;
  }
  PetscCall(part_destroy(&old.part));
  PetscCall(halo_end(&old.halo));
  PetscCall(PetscFree3(old.offsets.part_nodal, old.offsets.part_round, old.offsets.now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Frozen weights are those of the first configuration; others begin at t_n. `all`: as share_out() has it */
PetscErrorCode contact_share_out_at_t_n(Contact *contact, PetscInt number, double *all, PetscInt *status)
{
  Vec rest;
  PetscFunctionBegin;
  PetscCall(DMGetLocalVector(contact->mesh->dm, &rest));
  PetscCall(VecZeroEntries(rest));
  {
    const Vec ways[1][2] = {{contact->interfaces[number].frozen ? rest : contact->committed, NULL}};
    PetscCall(share_out(contact, number, 1, ways, all, status));
  }
  PetscCall(DMRestoreLocalVector(contact->mesh->dm, &rest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before an interface is evaluated at u_local, or on the way from there to another local vector (NULL: at none): every part has the
 * mortar facets that it may need. */
PetscErrorCode contact_renew(Contact *contact, PetscInt number, Vec to, PetscInt *status)
{
  Interface *interface = &contact->interfaces[number];
  const Vec  way[2]    = {contact->physics->u_local, to};
  Vec        place     = NULL;
  PetscBool  enough    = PETSC_TRUE;
  PetscInt   n;
  double    *all;

  PetscFunctionBegin;
  *status = 0;
  if (!interface->frozen) PetscCall(halo_covers(interface, way, 0, &enough));
  if (enough) PetscFunctionReturn(PETSC_SUCCESS);
  if (contact->linear) PetscCall(get_place(contact, &place));
  {
    const Vec ways[3][2] = {{contact->committed, NULL}, {way[0], way[1]}, {place, NULL}};
    PetscCall(parts_knowledge(interface, &n, &all));
    PetscCall(share_out(contact, number, place ? 3 : 2, ways, all, status));
  }
  if (place) PetscCall(DMRestoreLocalVector(contact->mesh->dm, &place));
  if (!*status) {
    interface->n_grown++;
    interface->grown = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the largest sum of a rank's nodes over the mean of all ranks */
static PetscErrorCode largest_share(const Interface *interface, PetscMPIInt size, const PetscInt owner[], const double work[],
                                    double *largest)
{
  double *sums, all = 0, most = 0;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(size, &sums));
  for (PetscInt a = 0; a < interface->n1; a++)
    sums[owner[a]] += work[a];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, size, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0; r < size; r++) {
    most = PetscMax(most, sums[r]);
    all += sums[r];
  }
  *largest = most * size / all;
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is another partition better for the pairs of now? Then interface->owner is that one. */
static PetscErrorCode choose_again(Contact *contact, Interface *interface, PetscBool *better)
{
  const PetscMPIInt size = contact->mesh->size;
  PetscReal         depth, shortest;
  double           *work, now, then;
  PetscInt         *owner;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(interface->n1, &work, interface->n1, &owner));
  PetscCall(work_measure(interface, contact->mesh->rank, work, &depth, &shortest));
  PetscCall(partition_nodes(PETSC_COMM_WORLD, interface->dimension, interface->n1, interface->first[0], interface->X, work, size, owner));
  PetscCall(creases_join(contact->mesh, interface, owner));
  PetscCall(largest_share(interface, size, interface->owner, work, &now));
  PetscCall(largest_share(interface, size, owner, work, &then));
  *better = (PetscBool)(then < (1 - SAVES) * now);
  PetscCallMPI(MPI_Bcast(better, 1, MPIU_BOOL, 0, PETSC_COMM_WORLD)); /* sums may be rounded otherwise elsewhere */
  if (*better) PetscCall(PetscArraycpy(interface->owner, owner, interface->n1));
  PetscCall(PetscFree2(work, owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Between steps: does the partition still balance the pairs? What could not be bettered is not looked at until it is worse. */
static PetscErrorCode rebalance(Contact *contact, Interface *interface, PetscBool *better)
{
  stickslip_counters counters = {.struct_size = sizeof(counters)};
  double             pairs[2] = {0, 0}, imbalance;
  PetscMPIInt        size;

  PetscFunctionBegin;
  *better = PETSC_FALSE;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (interface->part.handle) PetscCallStickslip(stickslip_interface_counters(interface->part.handle, &counters));
  pairs[0] = pairs[1] = (double)counters.pairs_active;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &pairs[0], 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &pairs[1], 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  imbalance = pairs[1] > 0 ? pairs[0] * size / pairs[1] : 1;
  if (imbalance <= IMBALANCE || imbalance <= interface->endured) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(choose_again(contact, interface, better));
  interface->endured = *better ? 0 : imbalance;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After a step, when t_n is settled. */
PetscErrorCode contact_share_out(Contact *contact)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    const Vec  at[2]     = {contact->committed, NULL};
    PetscBool  better, enough = PETSC_TRUE;
    PetscInt   status, n;
    double    *all;
    if (interface->n_parts < 2) continue;
    PetscCall(rebalance(contact, interface, &better));
    if (!better && !interface->frozen) PetscCall(halo_covers(interface, at, SPARE, &enough));
    if (!better && enough && !interface->grown) continue;
    PetscCall(parts_knowledge(interface, &n, &all));
    PetscCall(contact_share_out_at_t_n(contact, i, all, &status));
    PetscCheck(!status, PETSC_COMM_WORLD, PETSC_ERR_LIB, "stickslip, of an interface that is shared out anew: %s", contact->refusal);
    interface->n_renewed += !better;
    interface->n_rebalanced += better;
    interface->grown = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
