/* `adjust`: gaps and overlaps that the meshes start with are closed before there is any strain. */
#include "contact/contact.h"

/* rank 0, before anything is made of the mesh: nodes of the non-mortar side within the tolerance are put onto the mortar side. */
PetscErrorCode contact_adjust(Scene *scene, Contact *contact, Interface *interface)
{
  Mesh                *mesh    = contact->mesh;
  Offsets             *offsets = &interface->offsets;
  const PetscInt       d       = interface->dimension;
  const int64_t        n       = d * ((int64_t)interface->n1 + interface->n2) + (int64_t)interface->components * interface->n1;
  stickslip_surface    surfaces[2];
  int64_t             *facet_nodes[2];
  stickslip_interface *handle = NULL;
  double              *x;

  PetscFunctionBegin;
  if (offsets->adjust == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(n, &interface->x, n, &interface->equations, d * interface->n1, &x));
  for (PetscInt k = 0; k < d * (interface->n1 + interface->n2); k++)
    interface->x[k] = mesh->coordinates[3 * interface->nodes[k / d] + k % d];
  for (int64_t k = 0; k < n; k++)
    interface->equations[k] = -1;
  for (int side = 0; side < 2; side++)
    PetscCall(contact_surface(contact, interface, side, &surfaces[side], &facet_nodes[side]));
  PetscCall(PetscMalloc2(interface->n1, &offsets->gaps, interface->n1, &offsets->moved));
  if (stickslip_interface_create(&surfaces[0], &surfaces[1], &interface->options, &handle) ||
      stickslip_interface_adjust(handle, offsets->adjust, x, offsets->gaps, offsets->moved))
    scene_fail(scene, interface->name, "adjust", "%s.", stickslip_last_error_message());
  PetscCallStickslip(stickslip_interface_destroy(&handle));
  for (PetscInt k = 0; k < d * interface->n1; k++)
    mesh->coordinates[3 * interface->nodes[k / d] + k % d] = x[k];
  for (int side = 0; side < 2; side++)
    PetscCall(PetscFree(facet_nodes[side]));
  PetscCall(PetscFree3(interface->x, interface->equations, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
