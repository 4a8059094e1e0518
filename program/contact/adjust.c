/* What is asked of the library before anything is made of the mesh: `adjust`, gaps and overlaps that the meshes start with are
 * closed before there is any strain; and how far the facets of round sides are off their shapes. Each question is one
 * to both surfaces in whole: where a scene asks it, and then only, rank 0 has them for a moment. */
#include "contact/contact.h"

/* Both sides, in the library's words. */
typedef struct {
  stickslip_surface surfaces[2];
  int64_t          *facet_nodes[2], *facet_offsets[2], *equations;
  double           *x;
  PetscSF           nodes; /* from homes to all nodes */
} Whole;

/* Numbers of all ranks, one after the other, on rank 0. */
static PetscErrorCode gather(const Mesh *mesh, PetscInt n, const PetscInt mine[], PetscInt *n_all, PetscInt **all)
{
  PetscMPIInt *counts;
  PetscInt    *packed;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(mesh->size, &counts));
  counts[0] = (PetscMPIInt)n;
  PetscCall(PetscMalloc1(n, &packed));
  PetscCall(PetscArraycpy(packed, mine, n));
  PetscCall(numbers_deal(mesh, counts, packed, n_all, all));
  PetscCall(PetscFree(packed));
  PetscCall(PetscFree(counts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode gather_facets(const Mesh *mesh, const Surface *surface, Whole *whole, int side)
{
  PetscInt *sizes, *all_sizes, *corners, n_facets, n_corners;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(surface->n_faces, &sizes));
  for (PetscInt f = 0; f < surface->n_faces; f++)
    sizes[f] = surface->offsets[f + 1] - surface->offsets[f];
  PetscCall(gather(mesh, surface->n_faces, sizes, &n_facets, &all_sizes));
  PetscCall(gather(mesh, surface->offsets[surface->n_faces], surface->vertices, &n_corners, &corners));
  PetscCall(PetscMalloc1(n_corners, &whole->facet_nodes[side]));
  PetscCall(PetscMalloc1(n_facets + 1, &whole->facet_offsets[side]));
  whole->facet_offsets[side][0] = 0;
  for (PetscInt f = 0; f < n_facets; f++)
    whole->facet_offsets[side][f + 1] = whole->facet_offsets[side][f] + all_sizes[f];
  for (PetscInt k = 0; k < n_corners; k++)
    whole->facet_nodes[side][k] = corners[k];
  whole->surfaces[side].n_facets      = n_facets;
  whole->surfaces[side].facet_offsets = surface->analytic ? NULL : whole->facet_offsets[side];
  whole->surfaces[side].facet_nodes   = surface->analytic ? NULL : whole->facet_nodes[side];
  PetscCall(PetscFree(sizes));
  PetscCall(PetscFree(all_sizes));
  PetscCall(PetscFree(corners));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode whole_create(const Mesh *mesh, const Interface *interface, Whole *whole)
{
  const PetscInt d = interface->dimension, n = mesh->rank ? 0 : interface->all[0] + interface->all[1];
  PetscInt      *numbers;
  double        *places;
  PetscFunctionBegin;
  *whole = (Whole){0};
  for (int side = 0; side < 2; side++) {
    whole->surfaces[side] = (stickslip_surface){.struct_size = sizeof(stickslip_surface), .n_nodes = interface->all[side]};
    PetscCall(gather_facets(mesh, interface->surface[side], whole, side));
  }
  PetscCall(PetscMalloc2(n, &numbers, 3 * n, &places));
  PetscCall(PetscMalloc2(d * n, &whole->x, d * n, &whole->equations));
  for (PetscInt k = 0; k < n; k++)
    numbers[k] = k;
  PetscCall(homes_fetch_create(interface, n, numbers, &whole->nodes));
  PetscCall(homes_bcast(whole->nodes, 3, interface->place, places));
  for (PetscInt k = 0; k < d * n; k++) {
    whole->x[k]         = places[3 * (k / d) + k % d];
    whole->equations[k] = -1;
  }
  for (int side = 0; side < 2; side++) {
    whole->surfaces[side].coordinates = whole->x + (side && n ? d * interface->all[0] : 0);
    whole->surfaces[side].equations   = whole->equations;
  }
  whole->surfaces[0].multiplier_equations = whole->equations;
  PetscCall(PetscFree2(numbers, places));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode whole_destroy(Whole *whole)
{
  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) {
    PetscCall(PetscFree(whole->facet_nodes[side]));
    PetscCall(PetscFree(whole->facet_offsets[side]));
  }
  PetscCall(PetscFree2(whole->x, whole->equations));
  PetscCall(PetscSFDestroy(&whole->nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: a handle that is asked before there are unknowns */
static void create(Scene *scene, const Interface *interface, const Whole *whole, const char *key, stickslip_interface **handle)
{
  if (stickslip_interface_create(&whole->surfaces[0], &whole->surfaces[1], &interface->options, handle))
    scene_fail(scene, interface->name, key, "%s.", stickslip_last_error_message());
}

/* from rank 0 home, `width` numbers a node */
static PetscErrorCode send_home(const Whole *whole, PetscInt width, const double from[], double to[])
{
  MPI_Datatype node;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)width, MPI_DOUBLE, &node));
  PetscCallMPI(MPI_Type_commit(&node));
  PetscCall(PetscSFReduceBegin(whole->nodes, node, from, to, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(whole->nodes, node, from, to, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What travels of a node: its place, its gap, what was done. */
enum { PLACE, GAP = PLACE + 3, DONE, WIDTH };

/* rank 0: WIDTH a node */
static PetscErrorCode ask_adjust(Scene *scene, const Interface *interface, const Whole *whole, double found[])
{
  const PetscInt       d = interface->dimension, n = interface->all[0];
  stickslip_interface *handle = NULL;
  double              *x, *gaps;
  int32_t             *moved;
  PetscFunctionBegin;
  PetscCall(PetscMalloc3(d * n, &x, n, &gaps, n, &moved));
  create(scene, interface, whole, "adjust", &handle);
  if (stickslip_interface_adjust(handle, interface->offsets.adjust, x, gaps, moved))
    scene_fail(scene, interface->name, "adjust", "%s.", stickslip_last_error_message());
  PetscCallStickslip(stickslip_interface_destroy(&handle));
  for (PetscInt a = 0; a < n; a++) {
    for (PetscInt i = 0; i < 3; i++)
      found[WIDTH * a + PLACE + i] = i < d ? x[d * a + i] : 0;
    found[WIDTH * a + GAP]  = gaps[a];
    found[WIDTH * a + DONE] = moved[a];
  }
  PetscCall(PetscFree3(x, gaps, moved));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of the non-mortar side within the tolerance are put onto the mortar side. */
static PetscErrorCode adjust(Scene *scene, const Mesh *mesh, Interface *interface)
{
  Offsets *offsets = &interface->offsets;
  double  *found, *here;
  Whole    whole;
  PetscFunctionBegin;
  PetscCall(whole_create(mesh, interface, &whole));
  PetscCall(PetscCalloc1(mesh->rank ? 0 : WIDTH * (interface->all[0] + interface->all[1]), &found));
  PetscCall(PetscCalloc1(WIDTH * (interface->n1 + interface->n2), &here));
  PetscCall(PetscMalloc2(interface->n1, &offsets->gaps, interface->n1, &offsets->moved));
  scene_root_begin(scene);
  if (mesh->rank == 0) PetscCall(ask_adjust(scene, interface, &whole, found));
  PetscCall(scene_root_end(scene));
  PetscCall(send_home(&whole, WIDTH, found, here));
  for (PetscInt a = 0; a < interface->n1; a++) {
    for (PetscInt i = 0; i < interface->dimension; i++)
      interface->place[3 * a + i] = here[WIDTH * a + PLACE + i];
    offsets->gaps[a]  = here[WIDTH * a + GAP];
    offsets->moved[a] = (int32_t)here[WIDTH * a + DONE];
  }
  PetscCall(PetscFree(found));
  PetscCall(PetscFree(here));
  PetscCall(whole_destroy(&whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far the facets of a round side are off its shape. */
static PetscErrorCode find_shape(Scene *scene, const Mesh *mesh, Interface *interface, int side)
{
  static const char *const radius_key[] = {"nonmortar_radius", "mortar_radius"};
  Offsets                 *offsets      = &interface->offsets;
  stickslip_interface     *handle       = NULL;
  const PetscInt           first        = side ? interface->n1 : 0, n = side ? interface->n2 : interface->n1;
  double                  *found, *here;
  Whole                    whole;
  PetscFunctionBegin;
  PetscCall(whole_create(mesh, interface, &whole));
  PetscCall(PetscCalloc1(mesh->rank ? 0 : interface->all[0] + interface->all[1], &found));
  PetscCall(PetscCalloc1(interface->n1 + interface->n2, &here));
  scene_root_begin(scene);
  if (mesh->rank == 0) {
    create(scene, interface, &whole, radius_key[side], &handle);
    if (stickslip_interface_shape_offsets(handle, side, offsets->shape, offsets->radius[side], offsets->centre, offsets->axis,
                                          found + (side ? interface->all[0] : 0)))
      scene_fail(scene, interface->name, radius_key[side], "%s.", stickslip_last_error_message());
    PetscCallStickslip(stickslip_interface_destroy(&handle));
  }
  PetscCall(scene_root_end(scene));
  PetscCall(send_home(&whole, 1, found, here));
  PetscCall(PetscArraycpy(offsets->round + first, here + first, n));
  PetscCall(PetscFree(found));
  PetscCall(PetscFree(here));
  PetscCall(whole_destroy(&whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_adjust(Scene *scene, const Mesh *mesh, Interface *interface)
{
  PetscFunctionBegin;
  if (interface->offsets.adjust > 0) PetscCall(adjust(scene, mesh, interface));
  for (int side = 0; side < 2; side++) {
    if (interface->offsets.radius[side] != 0) PetscCall(find_shape(scene, mesh, interface, side));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
