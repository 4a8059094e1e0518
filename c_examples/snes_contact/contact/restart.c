/* What a restart file keeps of the contact: t_n, what the parts know of their nodes, the library's history. An interface that is shared out
 * among ranks has no history there: its parts are made anew of t_n, as they are when it is shared out between steps. */
#include "contact/contact.h"

/* Displacements of all vertices by their numbers, then the multipliers of each interface's nodes: a local vector on rank 0. */
static PetscErrorCode natural(const Contact *contact, PetscInt *n, PetscSF *sf)
{
  const PetscInt   n_blocks = 1 + contact->n_interfaces;
  const PetscBool  root     = (PetscBool)(contact->mesh->rank == 0);
  PetscInt        *all, *counts, *fields, *widths;
  const PetscInt **vertices;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(root ? contact->mesh->n_all_vertices : 0, &all));
  PetscCall(PetscMalloc4(n_blocks, &counts, n_blocks, &fields, n_blocks, &widths, n_blocks, &vertices));
  counts[0] = root ? contact->mesh->n_all_vertices : 0;
  for (PetscInt k = 0; k < counts[0]; k++)
    all[k] = k;
  fields[0]   = 0;
  widths[0]   = 3;
  vertices[0] = all;
  *n          = 3 * counts[0];
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    counts[1 + i]              = root ? interface->n1 : 0;
    fields[1 + i]              = 1 + i;
    widths[1 + i]              = interface->components;
    vertices[1 + i]            = interface->nodes;
    *n += widths[1 + i] * counts[1 + i];
  }
  PetscCall(unknowns_gather_create(contact->physics, n_blocks, counts, vertices, fields, widths, sf));
  PetscCall(PetscFree4(counts, fields, widths, vertices));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries of vertices that another rank owns. */
static PetscErrorCode copy_to_ghosts(const Unknowns *unknowns, Vec local)
{
  const PetscScalar *from;
  PetscScalar       *to;
  Vec                owned;
  PetscFunctionBegin;
  if (!unknowns->ghosts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(local, &owned));
  PetscCall(VecCopy(local, owned));
  PetscCall(VecGetArrayRead(owned, &from));
  PetscCall(VecGetArray(local, &to));
  PetscCall(PetscSFBcastBegin(unknowns->ghosts, MPIU_SCALAR, from, to, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(unknowns->ghosts, MPIU_SCALAR, from, to, MPI_REPLACE));
  PetscCall(VecRestoreArray(local, &to));
  PetscCall(VecRestoreArrayRead(owned, &from));
  PetscCall(VecDestroy(&owned));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_archive_vector(Contact *contact, const char *name, Vec local, Archive *archive)
{
  PetscScalar *values, *array;
  PetscInt     n;
  PetscSF      sf;
  PetscFunctionBegin;
  PetscCall(natural(contact, &n, &sf));
  PetscCall(PetscMalloc1(n, &values));
  PetscCall(contact_fetch(sf, local, values));
  PetscCall(archive_root(archive, name, (size_t)n * sizeof(*values), values));
  if (archive->reading && !archive->bad) {
    PetscCall(VecGetArray(local, &array));
    PetscCall(PetscSFReduceBegin(sf, MPIU_SCALAR, values, array, MPI_REPLACE));
    PetscCall(PetscSFReduceEnd(sf, MPIU_SCALAR, values, array, MPI_REPLACE));
    PetscCall(VecRestoreArray(local, &array));
    PetscCall(copy_to_ghosts(&contact->physics->unknowns, local));
  }
  PetscCall(PetscFree(values));
  PetscCall(PetscSFDestroy(&sf));
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
  PetscCall(archive_root(archive, "owner", (size_t)interface->n1 * sizeof(*owner), owner));
  if (contact->mesh->rank == 0 && archive->reading && !archive->bad && archive->n_ranks == size)
    PetscCall(PetscArraycpy(interface->owner, owner, interface->n1));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of an interface that one rank has, what parts would have kept when t_n was settled: slip, and what the law remembers. */
static int32_t find_slip(const Interface *interface, ContactPart *part)
{
  stickslip_states wanted = {.struct_size = sizeof(wanted), .slip = part->slip};
  int32_t          status = 0;
  if (!part->handle) return 0;
  status = stickslip_interface_states(part->handle, STATE_OF(part), NULL, &wanted);
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
  stickslip_interface *handle = interface->part.handle;
  int64_t              n[2]   = {0, 0}, *integers;
  double              *reals;

  PetscFunctionBegin;
  if (handle && !archive->reading) *refused = stickslip_interface_history_size(handle, &n[0], &n[1]);
  PetscCallMPI(MPI_Bcast(n, 2, MPI_INT64_T, owner, PETSC_COMM_WORLD));
  PetscCall(archive_bytes(archive, "history.sizes", sizeof(n), n));
  PetscCall(PetscCalloc2(n[0], &integers, n[1], &reals));
  if (handle && !archive->reading && !*refused) *refused = stickslip_interface_history_export(handle, n[0], integers, n[1], reals);
  PetscCall(archive_array(contact, owner, "history.integers", n[0], integers, archive));
  PetscCall(archive_array(contact, owner, "history.reals", n[1], reals, archive));
  if (handle && archive->reading && !archive->bad && interface->n_parts < 2) {
    *refused = offsets_set(interface, handle, contact->t_committed);
    if (!*refused) *refused = stickslip_interface_history_import(handle, n[0], integers, n[1], reals);
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
  PetscMPIInt owner     = interface->part.handle ? contact->mesh->rank : -1;
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
  PetscCall(archive_root(archive, "nodes", contact->mesh->rank ? 0 : (size_t)n * sizeof(*all), all));
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
