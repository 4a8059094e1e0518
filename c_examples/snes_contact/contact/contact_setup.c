/* Creating and destroying interfaces: who owns which nodes, and what is wrong at the start. */
#include "contact/contact.h"

/* Surfaces that lie over each other but are no pair would be passed through without a word. Where any pair has been found
 * there is nothing to ask. A handle of its own is asked, so that the other's counters stay what they are. The first part that
 * finds a mistake speaks for all. */
static PetscErrorCode check_facing(Scene *scene, PetscBool quiet, const Interface *interface, PetscMPIInt rank)
{
  const ContactPart   *part     = &interface->part;
  stickslip_counters   counters = {.struct_size = sizeof(counters)};
  stickslip_interface *asked    = NULL;
  ContactCover         cover;
  int32_t              refused;

  PetscFunctionBegin;
  if (part->handle) PetscCallStickslip(stickslip_interface_counters(part->handle, &counters));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &counters.pairs_active, 1, MPI_INT64_T, MPI_SUM, PETSC_COMM_WORLD));
  if (counters.pairs_active) PetscFunctionReturn(PETSC_SUCCESS);
  if (part->handle) {
    PetscCall(part_handle(part, &interface->options, &asked, &refused));
    PetscCallStickslip(refused);
    PetscCallStickslip(offsets_set(interface, asked, 0));
  }
  PetscCall(contact_cover(interface, asked, rank, &cover, NULL));
  PetscCallStickslip(stickslip_interface_destroy(&asked));
  if (cover.mistaken) scene_fail(scene, interface->name, "mortar", "%s", cover.text);
  if (cover.finding != STICKSLIP_FINDING_NONE && !quiet) /* they may meet later */
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s: %s\n", interface->name, cover.text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: what is kept of all nodes */
static PetscErrorCode create_whole(Contact *contact, Interface *interface)
{
  const Mesh    *mesh    = contact->mesh;
  const PetscInt d       = interface->dimension, n = interface->n1 + interface->n2;
  const PetscInt zero = 0;
  const PetscInt *nodes = interface->nodes;
  PetscFunctionBegin;
  PetscCall(unknowns_gather_create(contact->physics, 1, &n, &nodes, &zero, &d, &interface->sf));
  PetscCall(PetscCalloc4(d * n, &interface->X, d * n, &interface->displacements, d * n, &interface->forces, d * n,
                         &interface->equations));
  PetscCall(contact_equations(contact, interface->sf, d * n, interface->equations));
  for (PetscInt k = 0; k < n; k++) {
    PetscReal *x = interface->place + 3 * k;
    mesh_rotate_vector(mesh, x);
    for (PetscInt i = 0; i < d; i++)
      interface->X[d * k + i] = x[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Facets with nodes in the middle of their edges, on either side: their condensation wants all of them in one handle. */
static PetscBool has_middles(const Mesh *mesh, const Interface *interface)
{
  for (int side = 0; side < 2; side++) {
    const Surface *surface = interface->surface[side];
    for (PetscInt f = 0; f < surface->n_faces; f++) {
      if (surface->offsets[f + 1] - surface->offsets[f] > cell_corners(mesh_face_kind(mesh, surface, f))) return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

/* rank 0: of the mortar side's facets */
static PetscReal longest_edge(const Interface *interface)
{
  const Surface   *surface = interface->surface[1];
  const PetscReal *x       = interface->place + 3 * interface->n1;
  PetscReal        squared = 0;
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const PetscInt *v = surface->vertices + surface->offsets[f], n = surface->offsets[f + 1] - surface->offsets[f];
    for (PetscInt k = 0; k < n; k++) {
      PetscReal sum = 0;
      for (int i = 0; i < 3; i++)
        sum += PetscSqr(x[3 * v[k] + i] - x[3 * v[(k + 1) % n] + i]);
      squared = PetscMax(squared, sum);
    }
  }
  return PetscSqrtReal(squared);
}

/* What rank 0 has read and others need, too. */
static PetscErrorCode share_options(const Mesh *mesh, Interface *interface)
{
  const stickslip_options *options = &interface->options;
  PetscFunctionBegin;
  if (mesh->rank == 0) {
    interface->longest_edge = longest_edge(interface);
    interface->uncut = (PetscBool)(interface->dimension == 2 || interface->surface[1]->analytic || has_middles(mesh, interface));
  }
  PetscCallMPI(MPI_Bcast(&interface->options, sizeof(interface->options), MPI_BYTE, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(&interface->young, 1, MPI_DOUBLE, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(&interface->longest_edge, 1, MPIU_REAL, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(&interface->uncut, 1, MPIU_BOOL, 0, PETSC_COMM_WORLD));
  interface->frozen = (PetscBool)(options->weights == STICKSLIP_WEIGHTS_REFERENCE || options->friction == STICKSLIP_FRICTION_TIED);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: do parts have pairs as deep, and as far apart, as one rank would? Where offsets open gaps pairs are deeper by the largest
 * of all nodes of a handle; with a search distance they are farther apart, too, so that parts must not differ in it. */
static PetscBool offsets_allow_parts(const Interface *interface)
{
  const Offsets *offsets = &interface->offsets;
  if (!offsets->any || interface->options.search_distance == 0) return PETSC_TRUE;
  return (PetscBool)(!offsets->n_points && offsets->radius[0] == 0 && offsets->radius[1] == 0);
}

/* One rank has all nodes where the library does not know parts, as where points decide. Lines of a plane model are few; they stay together, too. */
static PetscBool must_be_whole(const Contact *contact, const Interface *interface)
{
  return (PetscBool)(interface->dimension == 2 || decision_is_points(interface) || (contact->condensed && has_middles(contact->mesh, interface)) ||
                     !offsets_allow_parts(interface));
}

/* rank 0: who owns which nodes, from what each costs; NULL: one rank owns all */
static PetscErrorCode choose_owners(const Contact *contact, PetscInt number, const double work[])
{
  const Interface *interface = &contact->interfaces[number];
  PetscMPIInt      size;
  PetscFunctionBegin;
  if (contact->mesh->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (PetscInt a = 0; a < interface->n1; a++)
    interface->owner[a] = number % size;
  if (work && !must_be_whole(contact, interface))
    PetscCall(partition_nodes(interface->dimension, interface->n1, interface->X, work, size, interface->owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part's handle, for the first time. */
static PetscErrorCode create_library(Contact *contact, Interface *interface, PetscInt *status)
{
  ContactPart *part    = &interface->part;
  int32_t      refused = 0;
  PetscFunctionBegin;
  if (part->n1) {
    PetscCall(part_handle(part, &interface->options, &part->handle, &refused));
    if (!refused) refused = offsets_set(interface, part->handle, 0);
    if (!refused) refused = law_set(interface, part->handle);
    if (!refused && contact->condensed) /* refused at once rather than in the first step */
      refused = stickslip_interface_condensed_multipliers(part->handle, part->x, MORTAR_OF(part, part->x), part->host,
                                                          part->lambda);
  }
  PetscCall(contact_agree(contact, interface, refused, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: the largest offsets of both sides together, at any time */
static PetscReal largest_offset(const Interface *interface)
{
  const Offsets *offsets = &interface->offsets;
  PetscReal      factor = offsets->curve.n ? 0 : 1, sides[2] = {0, 0};
  if (!offsets->any) return 0;
  for (PetscInt k = 0; k < offsets->curve.n; k++)
    factor = PetscMax(factor, PetscAbsReal(offsets->curve.points[2 * k + 1]));
  for (PetscInt k = 0; k < interface->n1 + interface->n2; k++) {
    PetscReal *side = &sides[k >= interface->n1];
    *side           = PetscMax(*side, factor * PetscAbsReal(offsets->nodal[k]) + PetscAbsReal(offsets->round[k]));
  }
  return sides[0] + sides[1];
}

/* A part has so many rings more, one for each facet that bodies are deep in each other; in facets. Beyond the most they stay on one
 * rank. */
static PetscErrorCode choose_rings(Interface *interface, PetscReal depth, PetscBool *too_deep)
{
  enum { MOST = 24 };
  PetscFunctionBegin;
  PetscCallMPI(MPI_Bcast(&depth, 1, MPIU_REAL, 0, PETSC_COMM_WORLD));
  *too_deep                = (PetscBool)!(depth <= MOST);
  interface->further_rings = *too_deep || depth <= PARTS_DEPTH ? 0 : (PetscInt)PetscCeilReal(depth) - PARTS_DEPTH;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A part of an interface on every rank, of equal work. */
static PetscErrorCode create_parts(Contact *contact, PetscInt number, PetscInt *status)
{
  Interface *interface = &contact->interfaces[number];
  const Vec  start[1][2] = {{contact->committed, NULL}};
  PetscBool  too_deep = PETSC_FALSE;
  PetscReal  depth;
  double    *work;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(interface->n1, &interface->owner));
  PetscCall(PetscMalloc1(interface->n1, &work));
  for (PetscInt a = 0; a < interface->n1; a++)
    work[a] = 1;
  PetscCall(choose_owners(contact, number, work));
  PetscCall(part_create(contact, number, 1, start));
  PetscCall(create_library(contact, interface, status));
  if (!*status && interface->n_parts > 1) {
    PetscReal shortest;
    PetscCall(work_measure(interface, contact->mesh->rank, work, &depth, &shortest));
    if (contact->mesh->rank == 0) depth += largest_offset(interface) / shortest;
    PetscCall(choose_rings(interface, depth, &too_deep));
    PetscCall(part_destroy(&interface->part));
    PetscCall(halo_end(&interface->halo));
    PetscCall(choose_owners(contact, number, too_deep ? NULL : work));
    PetscCall(part_create(contact, number, 1, start));
    PetscCall(create_library(contact, interface, status));
  }
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_create(Contact *contact, Scene *scene, PetscBool quiet, PetscInt *status)
{
  const Mesh *mesh = contact->mesh;
  char        why[256] = "";
  PetscMPIInt size;
  PetscFunctionBegin;
  *status = 0;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  scene_root_begin(scene);
  if (mesh->rank == 0 && contact->condensed) PetscCall(condensed_check(contact, why, sizeof(why)));
  if (why[0]) scene_fail(scene, NULL, "unknowns", "%s.", why);
  PetscCall(scene_root_end(scene));
  PetscCall(DMCreateLocalVector(mesh->dm, &contact->committed));
  PetscCall(VecZeroEntries(contact->committed));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    PetscCall(share_options(mesh, interface));
    PetscCall(create_whole(contact, interface));
    if (size > 1 && !interface->uncut) PetscCall(halo_watch(contact, interface));
    PetscCall(create_parts(contact, i, status));
    if (*status) break;
    PetscCall(check_facing(scene, quiet, interface, mesh->rank));
  }
  if (!*status) PetscCall(condensed_create(contact, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_destroy(Contact *contact)
{
  PetscFunctionBegin;
  PetscCall(condensed_destroy(contact));
  PetscCall(VecDestroy(&contact->committed));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    PetscCall(part_destroy(&interface->part));
    PetscCall(halo_destroy(&interface->halo));
    PetscCall(PetscSFDestroy(&interface->sf));
    PetscCall(contact_states_destroy(&interface->states));
    PetscCall(offsets_destroy(interface));
    PetscCall(PetscFree4(interface->X, interface->displacements, interface->forces, interface->equations));
    PetscCall(PetscFree(interface->owner));
    PetscCall(surfaces_destroy(interface));
    PetscCall(PetscFree(interface->removed));
    PetscCall(PetscFree(interface->middle));
  }
  PetscCall(PetscFree(contact->interfaces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
