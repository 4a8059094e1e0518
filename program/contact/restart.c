/* What a restart file keeps of the contact: t_n, what the parts know of their nodes, the library's history. An interface that is shared out
 * among ranks has no history there: its parts are made anew of t_n, as they are when it is shared out between steps. */
#include "contact/contact.h"

/* `width` bytes of each node at home, in the order of their numbers, which is that of the ranks. */
static PetscErrorCode archive_homes(const Contact *contact, const char *name, PetscInt n, size_t width, void *here, Archive *archive)
{
  const PetscMPIInt size = contact->mesh->size, count = (PetscMPIInt)n;
  PetscMPIInt      *counts, *starts;
  MPI_Datatype      node;
  size_t            total = 0;
  char             *all;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(size, &counts, size + 1, &starts));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, PETSC_COMM_WORLD));
  starts[0] = 0;
  for (PetscMPIInt r = 0; r < size; r++)
    starts[r + 1] = starts[r] + counts[r];
  if (contact->mesh->rank == 0) total = width * (size_t)starts[size];
  PetscCall(PetscMalloc1(total, &all));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)width, MPI_BYTE, &node));
  PetscCallMPI(MPI_Type_commit(&node));
  if (!archive->reading) PetscCallMPI(MPI_Gatherv(here, count, node, all, counts, starts, node, 0, PETSC_COMM_WORLD));
  PetscCall(archive_root(archive, name, total, all));
  if (archive->reading && !archive->bad) PetscCallMPI(MPI_Scatterv(all, counts, starts, node, here, count, node, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Type_free(&node));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree2(counts, starts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a local vector: displacements of all vertices by their numbers, to rank 0. */
static PetscErrorCode displacements_create(const Contact *contact, PetscInt *n, PetscSF *sf)
{
  const PetscInt  field = 0, width = 3, n_all = contact->mesh->rank ? 0 : contact->mesh->n_all_vertices;
  const PetscInt *asked;
  PetscInt       *all;
  PetscFunctionBegin;
  *n = width * n_all;
  PetscCall(PetscMalloc1(n_all, &all));
  for (PetscInt k = 0; k < n_all; k++)
    all[k] = k;
  asked = all;
  PetscCall(unknowns_gather_create(contact->physics, 1, &n_all, &asked, NULL, &field, &width, sf));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* values back to the owners of vertices */
static PetscErrorCode put(PetscSF sf, const PetscScalar values[], Vec local)
{
  PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArray(local, &array));
  PetscCall(PetscSFReduceBegin(sf, MPIU_SCALAR, values, array, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(sf, MPIU_SCALAR, values, array, MPI_REPLACE));
  PetscCall(VecRestoreArray(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the multipliers of one interface */
static PetscErrorCode archive_multipliers(Contact *contact, PetscInt number, Vec local, Archive *archive)
{
  const Interface *interface = &contact->interfaces[number];
  const PetscInt   field = 1 + number, width = interface->components, n1 = interface->n1;
  const PetscInt  *asked = interface->nodes, *copies = interface->copies;
  PetscScalar     *values;
  PetscSF          sf;
  PetscFunctionBegin;
  PetscCall(unknowns_gather_create(contact->physics, 1, &n1, &asked, &copies, &field, &width, &sf));
  PetscCall(PetscMalloc1(width * n1, &values));
  PetscCall(contact_fetch(sf, local, values));
  PetscCall(archive_homes(contact, "multipliers", n1, (size_t)width * sizeof(*values), values, archive));
  if (archive->reading && !archive->bad) PetscCall(put(sf, values, local));
  PetscCall(PetscFree(values));
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_archive_vector(Contact *contact, const char *name, Vec local, Archive *archive)
{
  PetscScalar *values;
  PetscInt     n;
  PetscSF      sf;
  PetscFunctionBegin;
  PetscCall(displacements_create(contact, &n, &sf));
  PetscCall(PetscMalloc1(n, &values));
  PetscCall(contact_fetch(sf, local, values));
  PetscCall(archive_root(archive, name, (size_t)n * sizeof(*values), values));
  if (archive->reading && !archive->bad) PetscCall(put(sf, values, local));
  PetscCall(PetscFree(values));
  PetscCall(PetscSFDestroy(&sf));
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    PetscCall(archive_multipliers(contact, i, local, archive));
  if (archive->reading) PetscCall(unknowns_to_ghosts(&contact->physics->unknowns, local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_archive_unknowns(Contact *contact, const char *name, Vec x, Archive *archive)
{
  const DM dm = contact->mesh->dm;
  Vec      local;
  PetscFunctionBegin;
  PetscCall(DMGetLocalVector(dm, &local));
  PetscCall(VecZeroEntries(local));
  PetscCall(DMGlobalToLocalBegin(dm, x, INSERT_VALUES, local));
  PetscCall(DMGlobalToLocalEnd(dm, x, INSERT_VALUES, local));
  PetscCall(contact_archive_vector(contact, name, local, archive));
  if (archive->reading) {
    PetscCall(DMLocalToGlobalBegin(dm, local, INSERT_VALUES, x));
    PetscCall(DMLocalToGlobalEnd(dm, local, INSERT_VALUES, x));
  }
  PetscCall(DMRestoreLocalVector(dm, &local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* numbers of the interface beside its nodes */
static PetscErrorCode archive_numbers(Interface *interface, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(archive_reals(archive, "friction_work", 1, &interface->friction_work));
  PetscCall(archive_reals(archive, "largest_traction", 1, &interface->largest_traction));
  PetscCall(archive_reals(archive, "endured", 1, &interface->endured));
  PetscCall(archive_ints(archive, "n_grown", 1, &interface->n_grown));
  PetscCall(archive_ints(archive, "n_renewed", 1, &interface->n_renewed));
  PetscCall(archive_ints(archive, "n_rebalanced", 1, &interface->n_rebalanced));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Who owns which nodes, if as many ranks go on. */
static PetscErrorCode archive_owners(const Contact *contact, Interface *interface, Archive *archive)
{
  PetscMPIInt size;
  PetscInt   *owner;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(PetscMalloc1(interface->n1, &owner));
  PetscCall(PetscArraycpy(owner, interface->owner, interface->n1));
  PetscCall(archive_homes(contact, "owner", interface->n1, sizeof(*owner), owner, archive));
  if (archive->reading && !archive->bad && archive->n_ranks == size)
    PetscCall(PetscArraycpy(interface->owner, owner, interface->n1));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of an interface that one rank has, what parts would have kept when t_n was settled: slip, and what the law remembers. */
static int32_t find_slip(const Interface *interface, ContactPart *part)
{
  stickslip_states wanted = {.struct_size = sizeof(wanted), .slip = part->slip};
  int32_t          status = 0;
  if (!verb_there(part)) return 0;
  status = verb_states(part, &wanted);
  return status ? status : law_keep(interface, part);
}

/* bytes between the rank that has the handle and rank 0 */
static PetscErrorCode carry(PetscMPIInt rank, PetscMPIInt from, PetscMPIInt to, int64_t n, void *bytes)
{
  enum { MOST = 1 << 30 };
  PetscFunctionBegin;
  for (int64_t at = 0; at < n && from != to; at += MOST) {
    const int count = (int)PetscMin(n - at, MOST);
    if (rank == from) PetscCallMPI(MPI_Send((char *)bytes + at, count, MPI_BYTE, to, 0, PETSC_COMM_WORLD));
    if (rank == to) PetscCallMPI(MPI_Recv((char *)bytes + at, count, MPI_BYTE, from, 0, PETSC_COMM_WORLD, MPI_STATUS_IGNORE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An array of the history, through rank 0. */
static PetscErrorCode archive_array(const Contact *contact, PetscMPIInt owner, const char *name, int64_t n, void *array, Archive *archive)
{
  const PetscMPIInt rank = contact->mesh->rank;
  PetscFunctionBegin;
  if (!archive->reading) PetscCall(carry(rank, owner, 0, 8 * n, array));
  PetscCall(archive_root(archive, name, rank ? 0 : 8 * (size_t)n, array));
  if (archive->reading && !archive->bad) PetscCall(carry(rank, 0, owner, 8 * n, array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of an interface that rank `owner` has. */
static PetscErrorCode archive_history(const Contact *contact, const Interface *interface, PetscMPIInt owner, Archive *archive,
                                      int32_t *refused)
{
  ContactPart    *part   = (ContactPart *)&interface->part;
  const PetscBool handle = verb_there(part);
  int64_t         n[2]   = {0, 0}, *integers;
  double         *reals;

  PetscFunctionBegin;
  if (handle && !archive->reading) *refused = verb_history_size(part, n);
  PetscCallMPI(MPI_Bcast(n, 2, MPI_INT64_T, owner, PETSC_COMM_WORLD));
  PetscCall(archive_bytes(archive, "history.sizes", sizeof(n), n));
  PetscCall(PetscCalloc2(n[0], &integers, n[1], &reals));
  if (handle && !archive->reading && !*refused) *refused = verb_history_export(part, n, integers, reals);
  PetscCall(archive_array(contact, owner, "history.integers", n[0], integers, archive));
  PetscCall(archive_array(contact, owner, "history.reals", n[1], reals, archive));
  if (handle && archive->reading && !archive->bad && interface->n_parts < 2) {
    if (part->handle) *refused = offsets_set(interface, part->handle, contact->t_committed);
    if (!*refused) *refused = verb_history_import(part, n, integers, reals);
  }
  PetscCall(PetscFree2(integers, reals));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A refusal of the library's is a fault. */
static PetscErrorCode refuse(Contact *contact, const Interface *interface, int32_t refused, Archive *archive)
{
  char     text[256];
  PetscInt status;
  PetscFunctionBegin;
  PetscCall(contact_agree(contact, interface, refused, &status));
  if (status) PetscCall(PetscSNPrintf(text, sizeof(text), "the library says of %s: %s", interface->name, contact->refusal));
  PetscCall(archive_fault(archive, status ? text : NULL));
  contact->refusal[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a fault has been found, the parts stay as they are. */
static PetscErrorCode archive_interface(Contact *contact, PetscInt number, Archive *archive)
{
  Interface  *interface = &contact->interfaces[number];
  PetscMPIInt owner     = verb_there(&interface->part) ? contact->mesh->rank : -1;
  PetscInt    n, n_parts = interface->n_parts, status = 0;
  int32_t     refused = 0;
  double     *all;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &owner, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(archive_numbers(interface, archive));
  PetscCall(archive_owners(contact, interface, archive));
  PetscCall(archive_ints(archive, "n_parts", 1, &n_parts));
  if (!archive->reading && n_parts < 2) {
    PetscCall(contact_gather(contact, interface, contact->committed));
    refused = find_slip(interface, &interface->part);
  }
  PetscCall(parts_knowledge(interface, &n, &all));
  PetscCall(archive_homes(contact, "nodes", interface->n1, (size_t)n * sizeof(*all), all, archive));
  if (n_parts < 2) PetscCall(archive_history(contact, interface, owner, archive, &refused));
  PetscCall(refuse(contact, interface, refused, archive));
  if (!archive->reading || archive->bad) {
    PetscCall(PetscFree(all));
  } else if (n_parts < 2 && interface->n_parts < 2) {
    PetscCall(parts_hand_out(interface, all));
    PetscCall(contact_gather(contact, interface, contact->committed));
  } else {
    PetscCall(contact_share_out_at_t_n(contact, number, all, &status));
    PetscCall(refuse(contact, interface, (int32_t)status, archive));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_archive(Contact *contact, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(archive_reals(archive, "t_committed", 1, &contact->t_committed));
  PetscCall(archive_ints(archive, "n_commits", 1, &contact->n_commits));
  PetscCall(contact_archive_vector(contact, "committed", contact->committed, archive));
  if (archive->reading) PetscCall(VecCopy(contact->committed, contact->physics->u_local));
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    PetscCall(archive_interface(contact, i, archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}
