/* Creating and destroying interfaces: who owns which nodes, and what is wrong at the start. */
#include "contact/skin.h"

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

/* what is kept of the nodes at home */
static PetscErrorCode create_homes(Contact *contact, Interface *interface)
{
  const Mesh    *mesh    = contact->mesh;
  const PetscInt d       = interface->dimension, n = interface->n1 + interface->n2;
  const PetscInt zero = 0;
  const PetscInt *nodes = interface->nodes;
  PetscFunctionBegin;
  PetscCall(unknowns_gather_create(contact->physics, 1, &n, &nodes, NULL, &zero, &d, &interface->sf));
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

/* of the mortar side's facets on all ranks, of a skin of all */
static PetscErrorCode longest_edge(const Interface *interface, PetscReal *longest)
{
  const int      side    = interface->skin ? 0 : 1;
  const Surface *surface = interface->surface[side];
  double        *x;
  PetscFunctionBegin;
  *longest = 0;
  PetscCall(PetscMalloc1(3 * (surface->analytic ? 0 : surface->offsets[surface->n_faces]), &x));
  PetscCall(homes_bcast(interface->corners[side], 3, interface->place, x));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const PetscInt first = surface->offsets[f], n = surface->offsets[f + 1] - first;
    for (PetscInt k = 0; k < n; k++) {
      PetscReal sum = 0;
      for (int i = 0; i < 3; i++)
        sum += PetscSqr(x[3 * (first + k) + i] - x[3 * (first + (k + 1) % n) + i]);
      *longest = PetscMax(*longest, PetscSqrtReal(sum));
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, longest, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the surfaces ask of parts. */
static PetscErrorCode look_at_surfaces(const Mesh *mesh, Interface *interface)
{
  const stickslip_options *options = &interface->options;
  const stickslip_method  *method  = &interface->method;
  PetscFunctionBegin;
  PetscCall(longest_edge(interface, &interface->longest_edge));
  PetscCall(surfaces_have_middles(mesh, interface, &interface->middles));
  interface->uncut  = (PetscBool)(interface->dimension == 2 || interface->skin || interface->surface[1]->analytic || interface->middles);
  interface->frozen = (PetscBool)(method->weights == STICKSLIP_WEIGHTS_REFERENCE || options->friction == STICKSLIP_FRICTION_TIED);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do parts have pairs as deep, and as far apart, as one rank would? Where offsets open gaps pairs are deeper by the largest
 * of all nodes of a handle; with a search distance they are farther apart, too, so that parts must not differ in it. */
static PetscBool offsets_allow_parts(const Interface *interface)
{
  const Offsets *offsets = &interface->offsets;
  if (!offsets->any || interface->options.search_distance == 0) return PETSC_TRUE;
  return (PetscBool)(!offsets->n_points && offsets->radius[0] == 0 && offsets->radius[1] == 0);
}

/* One rank has all nodes where the library does not know parts, as of a skin, and where points remember what nobody brings to
 * another rank. Lines of a plane model are few; they stay together, too. */
static PetscBool must_be_whole(const Contact *contact, const Interface *interface)
{
  const PetscBool remembers = (PetscBool)(decision_is_points(interface) && interface->options.friction != STICKSLIP_FRICTION_NONE);
  return (PetscBool)(interface->dimension == 2 || interface->skin || remembers || (contact->condensed && interface->middles) ||
                     !offsets_allow_parts(interface));
}

/* Who owns which nodes, from what each costs; `whole`: one rank owns all. */
static PetscErrorCode choose_owners(const Contact *contact, PetscInt number, PetscBool whole, const double work[])
{
  const Interface  *interface = &contact->interfaces[number];
  const PetscMPIInt size      = contact->mesh->size;
  PetscFunctionBegin;
  for (PetscInt a = 0; a < interface->n1; a++)
    interface->owner[a] = interface->skin ? 0 : number % size; /* rank 0 tells of a skin */
  if (!whole && !must_be_whole(contact, interface))
    PetscCall(partition_nodes(PETSC_COMM_WORLD, interface->dimension, interface->n1, interface->first[0], interface->X, work, size,
                              interface->owner));
  PetscCall(creases_join(contact->mesh, interface, interface->owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part's handle, for the first time. */
static PetscErrorCode create_library(Contact *contact, Interface *interface, PetscInt *status)
{
  ContactPart *part    = &interface->part;
  int32_t      refused = 0;
  PetscBool    condenses = PETSC_FALSE; /* it is that which was refused */
  PetscFunctionBegin;
  if (part->n1 && interface->skin) {
    PetscCall(skin_part_create(contact, interface, &refused));
  } else if (part->n1) {
    PetscCall(part_handle(part, &interface->options, &part->handle, &refused));
    if (!refused) refused = offsets_set(interface, part->handle, 0);
    if (!refused) refused = law_set(interface, part->handle);
    if (!refused && contact->condensed) { /* refused at once rather than in the first step */
      refused   = stickslip_interface_condensed_multipliers(part->handle, part->x, MORTAR_OF(part, part->x), part->host,
                                                            part->lambda);
      condenses = (PetscBool)(refused != 0);
    }
  }
  PetscCall(contact_agree(contact, interface, refused, status));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &condenses, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  if (condenses) PetscCall(PetscStrlcat(contact->refusal, " (asked for by `unknowns: displacements` of the scene)", sizeof(contact->refusal)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest offsets of both sides together, at any time. */
static PetscErrorCode largest_offset(const Interface *interface, PetscReal *largest)
{
  const Offsets *offsets = &interface->offsets;
  PetscReal      factor = offsets->curve.n ? 0 : 1, sides[2] = {0, 0};
  PetscFunctionBegin;
  for (PetscInt k = 0; k < offsets->curve.n; k++)
    factor = PetscMax(factor, PetscAbsReal(offsets->curve.points[2 * k + 1]));
  for (PetscInt k = 0; k < interface->n1 + interface->n2 && offsets->any; k++) {
    PetscReal *side = &sides[k >= interface->n1];
    *side           = PetscMax(*side, factor * PetscAbsReal(offsets->nodal[k]) + PetscAbsReal(offsets->round[k]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sides, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  *largest = sides[0] + sides[1];
  PetscFunctionReturn(PETSC_SUCCESS);
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
  PetscBool  too_deep = PETSC_FALSE, weak;
  PetscReal  depth;
  double    *work;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(interface->n1, &interface->owner));
  PetscCall(PetscMalloc1(interface->n1, &work));
  for (PetscInt a = 0; a < interface->n1; a++)
    work[a] = 1;
  PetscCall(choose_owners(contact, number, PETSC_FALSE, work));
  PetscCall(weak_choose(interface, PETSC_FALSE, &weak));
  PetscCall(part_create(contact, number, 1, start));
  PetscCall(create_library(contact, interface, status));
  if (!*status) PetscCall(weak_choose(interface, PETSC_TRUE, &weak));
  if (!*status && (interface->n_parts > 1 || weak)) {
    PetscReal shortest, offset = 0;
    PetscCall(work_measure(interface, contact->mesh->rank, work, &depth, &shortest));
    PetscCall(largest_offset(interface, &offset));
    depth += offset / shortest;
    PetscCall(choose_rings(interface, depth, &too_deep));
    PetscCall(part_destroy(&interface->part));
    PetscCall(halo_end(&interface->halo));
    PetscCall(choose_owners(contact, number, too_deep, work));
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
  if (contact->condensed) PetscCall(condensed_check(contact, why, sizeof(why)));
  if (why[0]) scene_fail(scene, NULL, "unknowns", "%s.", why);
  PetscCall(DMCreateLocalVector(mesh->dm, &contact->committed));
  PetscCall(VecZeroEntries(contact->committed));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    PetscCall(look_at_surfaces(mesh, interface));
    PetscCall(create_homes(contact, interface));
    if (size > 1 && !interface->uncut) PetscCall(halo_watch(contact, interface));
    PetscCall(create_parts(contact, i, status));
    if (*status && conserving_yields(contact, interface)) {
      PetscCall(part_destroy(&interface->part));
      PetscCall(halo_end(&interface->halo));
      PetscCall(PetscFree(interface->owner));
      PetscCall(create_parts(contact, i, status));
    }
    if (*status) break;
    if (!interface->skin) PetscCall(check_facing(scene, quiet, interface, mesh->rank));
    if (interface->blunted && !quiet)
      PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                            "%s: '%s' has sharp edges, and with `crease_angle: 0` their nodes have one normal for both sides: forces are wrong "
                            "where one side touches alone.\n",
                            interface->name, interface->surface[0]->name));
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
    PetscCall(skin_destroy(interface));
    PetscCall(PetscFree4(interface->X, interface->displacements, interface->forces, interface->equations));
    PetscCall(PetscFree(interface->owner));
    PetscCall(surfaces_destroy(interface));
    PetscCall(PetscFree2(interface->removed, interface->has_been));
    PetscCall(PetscFree(interface->middle));
  }
  PetscCall(PetscFree(contact->interfaces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
