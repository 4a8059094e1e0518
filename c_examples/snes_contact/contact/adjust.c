/* What is asked of the library before anything is made of the mesh: `adjust`, gaps and overlaps that the meshes start with are
 * closed before there is any strain; and how far the facets of round sides are off their shapes. */
#include "contact/contact.h"

/* A side, from coordinates and equations of all nodes; `facet_nodes`: to be freed. */
static PetscErrorCode describe(const Interface *interface, int side, const double *x, const int64_t *equations,
                               stickslip_surface *out, int64_t **facet_nodes)
{
  const Surface *surface = interface->surface[side];
  const PetscInt d = interface->dimension, first = side ? interface->n1 : 0, n = side ? interface->n2 : interface->n1,
                 n_corners = surface->analytic ? 0 : surface->offsets[surface->n_faces];
  int64_t       *offsets;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n_corners + surface->n_faces + 1, facet_nodes));
  offsets = *facet_nodes + n_corners;
  for (PetscInt k = 0; k < n_corners; k++)
    (*facet_nodes)[k] = surface->vertices[k];
  for (PetscInt f = 0; f <= surface->n_faces && !surface->analytic; f++)
    offsets[f] = surface->offsets[f];
  *out               = (stickslip_surface){.struct_size = sizeof(*out)};
  out->n_nodes       = n;
  out->n_facets      = surface->n_faces;
  out->coordinates   = x + d * first;
  out->facet_offsets = surface->analytic ? NULL : offsets;
  out->facet_nodes   = surface->analytic ? NULL : *facet_nodes;
  out->equations     = equations;
  if (!side) out->multiplier_equations = equations;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: a handle that is asked before there are unknowns */
static PetscErrorCode create(Scene *scene, const Interface *interface, const char *key, stickslip_interface **handle)
{
  const PetscInt    d = interface->dimension, n = interface->n1 + interface->n2;
  stickslip_surface surfaces[2];
  int64_t          *facet_nodes[2], *equations;
  double           *x;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(d * n, &x, d * n, &equations));
  for (PetscInt k = 0; k < d * n; k++) {
    x[k]         = interface->place[3 * (k / d) + k % d];
    equations[k] = -1;
  }
  for (int side = 0; side < 2; side++)
    PetscCall(describe(interface, side, x, equations, &surfaces[side], &facet_nodes[side]));
  if (stickslip_interface_create(&surfaces[0], &surfaces[1], &interface->options, handle))
    scene_fail(scene, interface->name, key, "%s.", stickslip_last_error_message());
  for (int side = 0; side < 2; side++)
    PetscCall(PetscFree(facet_nodes[side]));
  PetscCall(PetscFree2(x, equations));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: nodes of the non-mortar side within the tolerance are put onto the mortar side; then the shapes of round sides. */
PetscErrorCode contact_adjust(Scene *scene, Interface *interface)
{
  static const char *const radius_key[] = {"nonmortar_radius", "mortar_radius"};
  Offsets                 *offsets      = &interface->offsets;
  const PetscInt           d            = interface->dimension;
  stickslip_interface     *handle       = NULL;

  PetscFunctionBegin;
  if (offsets->adjust > 0) {
    double *x;
    PetscCall(PetscMalloc1(d * interface->n1, &x));
    PetscCall(PetscMalloc2(interface->n1, &offsets->gaps, interface->n1, &offsets->moved));
    PetscCall(create(scene, interface, "adjust", &handle));
    if (stickslip_interface_adjust(handle, offsets->adjust, x, offsets->gaps, offsets->moved))
      scene_fail(scene, interface->name, "adjust", "%s.", stickslip_last_error_message());
    PetscCallStickslip(stickslip_interface_destroy(&handle));
    for (PetscInt k = 0; k < d * interface->n1; k++)
      interface->place[3 * (k / d) + k % d] = x[k];
    PetscCall(PetscFree(x));
  }
  for (int side = 0; side < 2; side++) {
    if (offsets->radius[side] == 0) continue;
    PetscCall(create(scene, interface, radius_key[side], &handle));
    if (stickslip_interface_shape_offsets(handle, side, offsets->shape, offsets->radius[side], offsets->centre, offsets->axis,
                                          offsets->round + (side ? interface->n1 : 0)))
      scene_fail(scene, interface->name, radius_key[side], "%s.", stickslip_last_error_message());
    PetscCallStickslip(stickslip_interface_destroy(&handle));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
