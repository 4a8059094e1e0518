/* What a restart file keeps of the contact: t_n, what the parts know of their nodes, the library's history. An interface that is shared out
 * among ranks has no history in the file: its parts are made anew of t_n, as they are when it is shared out between steps. */
#include "contact/contact.h"

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
  PetscCall(archive_ints(archive, "owner", interface->n1, interface->owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of the handle of an interface that one rank has */
static PetscErrorCode archive_history(const Contact *contact, const Interface *interface, Archive *archive, int32_t *refused)
{
  stickslip_interface *handle  = interface->part.handle;
  int64_t              n[2]    = {0, 0}, *integers;
  double              *reals;

  PetscFunctionBegin;
  *refused = 0;
  if (!handle) PetscFunctionReturn(PETSC_SUCCESS);
  if (!archive->reading) *refused = stickslip_interface_history_size(handle, &n[0], &n[1]);
  PetscCall(archive_bytes(archive, "history.sizes", sizeof(n), n));
  if (*refused || archive->fault[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(n[0], &integers, n[1], &reals));
  if (!archive->reading) *refused = stickslip_interface_history_export(handle, n[0], integers, n[1], reals);
  if (!*refused) PetscCall(archive_bytes(archive, "history.integers", (size_t)n[0] * sizeof(*integers), integers));
  if (!*refused) PetscCall(archive_bytes(archive, "history.reals", (size_t)n[1] * sizeof(*reals), reals));
  if (archive->reading && !archive->fault[0]) {
    *refused = offsets_set(interface, handle, contact->t_committed);
    if (!*refused) *refused = stickslip_interface_history_import(handle, n[0], integers, n[1], reals);
  }
  PetscCall(PetscFree2(integers, reals));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reading: where a fault has been found, the parts stay as they are. */
static PetscErrorCode archive_interface(Contact *contact, PetscInt number, Archive *archive)
{
  Interface *interface = &contact->interfaces[number];
  PetscBool  any;
  PetscInt   n, n_parts = interface->n_parts, status = 0;
  int32_t    refused = 0;
  double    *all;

  PetscFunctionBegin;
  PetscCall(archive_numbers(interface, archive));
  PetscCall(archive_ints(archive, "n_parts", 1, &n_parts));
  PetscCall(parts_knowledge(interface, &n, &all));
  PetscCall(archive_reals(archive, "nodes", n, all));
  if (n_parts < 2) PetscCall(archive_history(contact, interface, archive, &refused));
  PetscCall(contact_agree(contact, interface, refused, &status));
  any = (PetscBool)(archive->fault[0] || status);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  if (!archive->reading || any) {
    PetscCall(PetscFree(all));
  } else if (n_parts < 2) {
    PetscCall(parts_hand_out(interface, all));
    PetscCall(contact_gather(contact, interface, contact->committed));
  } else {
    PetscCall(contact_share_out_at_t_n(contact, number, all, &status));
  }
  if (status && !archive->fault[0]) PetscCall(PetscSNPrintf(archive->fault, sizeof(archive->fault), "the library says: %s", contact->refusal));
  contact->refusal[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_archive(Contact *contact, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(archive_reals(archive, "t_committed", 1, &contact->t_committed));
  PetscCall(archive_ints(archive, "n_commits", 1, &contact->n_commits));
  PetscCall(archive_vector(archive, "committed", contact->committed));
  if (archive->reading) PetscCall(VecCopy(contact->committed, contact->physics->u_local));
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    PetscCall(archive_interface(contact, i, archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}
