/* Which bodies contact joins, or could. */
#include "contact/skin.h"

static void put(PetscInt one, PetscInt two, PetscBool joined, PetscInt *n, Joint joints[])
{
  for (PetscInt k = 0; k < *n; k++) {
    if (joints[k].bodies[0] != one || joints[k].bodies[1] != two) continue;
    joints[k].joined = (PetscBool)(joints[k].joined || joined);
    return;
  }
  joints[(*n)++] = (Joint){{one, two}, joined};
}

/* Bodies whose facets are near each other; and every body of the skin, for all of them may meet. `states`: of the part's nodes. */
static PetscErrorCode near_ones(const ContactPart *part, const double states[], PetscInt *n, Joint joints[])
{
  SkinFacets facets;
  PetscFunctionBegin;
  PetscCall(skin_facets(part, &facets));
  for (PetscInt f = 0; f < part->n_facets[0]; f++) {
    const PetscInt own = (PetscInt)facets.body[f];
    PetscBool      joined = PETSC_FALSE;
    put((PetscInt)facets.body[0], own, PETSC_FALSE, n, joints);
    if (facets.side[f] != STICKSLIP_SKIN_NONMORTAR || facets.partner[f] < 0) continue;
    for (PetscInt k = part->offsets[0][f]; k < part->offsets[0][f + 1]; k++)
      joined = (PetscBool)(joined || states[part->facet_nodes[0][k]] != STICKSLIP_STATE_GAP);
    put(PetscMin(own, (PetscInt)facets.body[facets.partner[f]]), PetscMax(own, (PetscInt)facets.body[facets.partner[f]]), joined, n, joints);
  }
  PetscCall(skin_facets_destroy(&facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* To all ranks from the one that has the skin. `states`: of the nodes at home. */
static PetscErrorCode of_skin(const Interface *interface, const int32_t states[], PetscInt *n, Joint joints[])
{
  const ContactPart *part = &interface->part;
  double            *home, *here;
  PetscInt           found = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc2(interface->n1, &home, part->n1, &here));
  for (PetscInt a = 0; a < interface->n1; a++)
    home[a] = states[a];
  PetscCall(parts_send(part, 1, home, here));
  if (part->skin) PetscCall(near_ones(part, here, &found, joints + *n));
  PetscCallMPI(MPI_Bcast(&found, 1, MPIU_INT, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(joints + *n, (PetscMPIInt)((size_t)found * sizeof(Joint)), MPI_BYTE, 0, PETSC_COMM_WORLD));
  *n += found;
  PetscCall(PetscFree2(home, here));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_joints(const Contact *contact, const int32_t states[], PetscInt *n, Joint **joints)
{
  const PetscInt n_bodies = contact->mesh->n_bodies;
  PetscFunctionBegin;
  *n = 0;
  PetscCall(PetscMalloc1(contact->n_interfaces + n_bodies * (n_bodies + 1), joints));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    PetscBool        joined    = (PetscBool)(interface->options.friction == STICKSLIP_FRICTION_TIED);
    if (interface->skin) {
      PetscCall(of_skin(interface, states, n, *joints));
    } else {
      for (PetscInt a = 0; a < interface->n1; a++)
        joined = (PetscBool)(joined || states[a] != STICKSLIP_STATE_GAP);
      PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &joined, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
      (*joints)[(*n)++] = (Joint){{interface->body[0], interface->body[1]}, joined};
    }
    states += interface->n1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
