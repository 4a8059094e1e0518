/* Creating and destroying the library's interfaces: surfaces in its arrays, equation numbers, prescribed directions. */
#include "contact/contact.h"

/* of `gathered`, `forces` and `equations` */
static PetscInt n_entries(const ContactPart *part)
{
  return part->dimension * (part->n1 + part->n2) + part->components * part->n1;
}

/* equation numbers of the entries that come through `sf`; -1: none */
static PetscErrorCode fetch_equations(const Contact *contact, PetscSF sf, PetscInt n, int64_t equations[])
{
  PetscInt *numbers;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &numbers));
  PetscCall(PetscSFBcastBegin(sf, MPIU_INT, contact->physics->unknowns.equations, numbers, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPIU_INT, contact->physics->unknowns.equations, numbers, MPI_REPLACE));
  for (PetscInt k = 0; k < n; k++)
    equations[k] = numbers[k] < 0 ? -1 : numbers[k];
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where multipliers are no unknowns the library must know which there are, nevertheless: numbers beyond all equations. */
static PetscErrorCode number_multipliers(const Contact *contact, ContactPart *part)
{
  const PetscInt d = part->components;
  PetscInt       n_equations;
  Vec            x;
  PetscFunctionBegin;
  if (!contact->condensed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMGetGlobalVector(contact->mesh->dm, &x));
  PetscCall(VecGetSize(x, &n_equations));
  PetscCall(DMRestoreGlobalVector(contact->mesh->dm, &x));
  for (PetscInt k = 0; k < d * part->n1; k++) {
    const PetscInt  removed = part->removed[k / d], i = k % d;
    const PetscBool none    = (PetscBool)(d > 1 ? (removed >> i) & 1 : removed == 7);
    MULTIPLIERS_OF(part, part->equations)[k] = none ? -1 : n_equations + (int64_t)d * part->nodes[k / d] + i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of rigid bodies: beyond those of multipliers, which have three a node at most. */
static PetscErrorCode number_rigid(const Contact *contact, Interface *interface)
{
  PetscInt n[2] = {0, interface->n1};
  Vec      x;
  PetscFunctionBegin;
  if (!contact->physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMGetGlobalVector(contact->mesh->dm, &x));
  PetscCall(VecGetSize(x, &n[0]));
  PetscCall(DMRestoreGlobalVector(contact->mesh->dm, &x));
  PetscCallMPI(MPI_Bcast(&n[1], 1, MPIU_INT, 0, PETSC_COMM_WORLD));
  PetscCall(rigid_part_create(contact, interface, n[0] + 3 * n[1], &interface->part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A side of a part in the library's words; `numbers`: to be freed. */
static PetscErrorCode describe_surface(const ContactPart *part, int side, stickslip_surface *out, int64_t **numbers)
{
  const PetscInt first = side ? part->n1 : 0, n_facets = part->n_facets[side], n_corners = part->offsets[side][n_facets];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n_corners + n_facets + 1, numbers));
  for (PetscInt k = 0; k < n_corners; k++)
    (*numbers)[k] = part->facet_nodes[side][k];
  for (PetscInt f = 0; f <= n_facets; f++)
    (*numbers)[n_corners + f] = part->offsets[side][f];
  *out               = (stickslip_surface){.struct_size = sizeof(*out)};
  out->n_nodes       = side ? part->n2 : part->n1;
  out->n_facets      = n_facets;
  out->coordinates   = part->x + part->dimension * first;
  out->facet_offsets = n_facets ? *numbers + n_corners : NULL; /* an analytic surface has none */
  out->facet_nodes   = n_facets ? *numbers : NULL;
  out->equations     = part->equations + part->dimension * first;
  if (side) PetscFunctionReturn(PETSC_SUCCESS);
  out->multiplier_equations = MULTIPLIERS_OF(part, part->equations);
  out->owned                = part->owned;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The directions removed carry no multiplier, and the normal none of them. */
static int32_t set_constraints(const ContactPart *part)
{
  int64_t *nodes, n = 0;
  double  *directions;
  int32_t  status;
  const PetscInt d = part->dimension;
  PetscCallAbort(PETSC_COMM_SELF, PetscCalloc2(2 * part->n1, &nodes, 2 * d * part->n1, &directions));
  for (PetscInt a = 0; a < part->n1; a++) {
    if (part->removed[a] == 7) continue; /* wholly prescribed: no unknown is left, and the normal stays free */
    for (int i = 0; i < d; i++) {
      if (!(part->removed[a] & (1 << i))) continue;
      nodes[n]              = a;
      directions[d * n + i] = 1;
      n++;
    }
  }
  status = n ? stickslip_interface_set_constraints(part->handle, n, nodes, directions) : 0;
  PetscCallAbort(PETSC_COMM_SELF, PetscFree2(nodes, directions));
  return status;
}

static PetscErrorCode create_handle(const ContactPart *part, const stickslip_options *options,
                                    stickslip_interface **handle, int32_t *refused)
{
  stickslip_surface surfaces[2];
  int64_t          *numbers[2];
  PetscFunctionBegin;
  for (int side = 0; side < 2; side++)
    PetscCall(describe_surface(part, side, &surfaces[side], &numbers[side]));
  *refused = stickslip_interface_create(&surfaces[0], &surfaces[1], options, handle);
  for (int side = 0; side < 2; side++)
    PetscCall(PetscFree(numbers[side]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
    PetscCall(create_handle(part, &interface->options, &asked, &refused));
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

/* What rank 0 has read and others need, too. */
static PetscErrorCode share_options(Interface *interface)
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Bcast(&interface->options, sizeof(interface->options), MPI_BYTE, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(&interface->young, 1, MPI_DOUBLE, 0, PETSC_COMM_WORLD));
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
  PetscCall(fetch_equations(contact, interface->sf, d * n, interface->equations));
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

/* One rank has all nodes where the library does not know parts. Lines of a plane model are few; they stay together, too. */
static PetscBool must_be_whole(const Contact *contact, const Interface *interface)
{
  return (PetscBool)(interface->dimension == 2 || (contact->condensed && has_middles(contact->mesh, interface)));
}

/* rank 0: who owns which nodes, from what each costs; NULL: one rank owns all */
static PetscErrorCode choose_owners(const Contact *contact, PetscInt number, const double work[], PetscInt owner[])
{
  const Interface *interface = &contact->interfaces[number];
  PetscMPIInt      size;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (PetscInt a = 0; a < interface->n1; a++)
    owner[a] = number % size;
  if (work && !must_be_whole(contact, interface))
    PetscCall(partition_nodes(interface->dimension, interface->n1, interface->X, work, size, owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reference coordinates of a part's nodes, and where its positions count from: far from the origin X + u would round u away.
 * A radius counts from the axis. */
static PetscErrorCode fetch_coordinates(const Contact *contact, Interface *interface)
{
  ContactPart   *part = &interface->part;
  const PetscInt d = part->dimension, n = part->n1 + part->n2;
  MPI_Datatype   node;
  PetscSFNode   *remote;
  PetscSF        sf;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &remote));
  for (PetscInt k = 0; k < n; k++)
    remote[k] = (PetscSFNode){.rank = 0, .index = part->nodes[k]};
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, &sf));
  PetscCall(PetscSFSetGraph(sf, interface->n1 + interface->n2, n, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)d, MPI_DOUBLE, &node));
  PetscCallMPI(MPI_Type_commit(&node));
  PetscCall(PetscSFBcastBegin(sf, node, interface->X, part->X, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, node, interface->X, part->X, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&node));
  PetscCall(offsets_fetch(sf, interface));
  PetscCall(PetscSFDestroy(&sf));
  for (PetscInt i = 0; i < d && contact->mesh->rank == 0; i++)
    part->origin[i] = i == 0 && interface->options.model == STICKSLIP_MODEL_AXISYMMETRIC ? 0 : interface->X[i];
  PetscCallMPI(MPI_Bcast(part->origin, 3, MPI_DOUBLE, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `work`: rank 0, see choose_owners() */
static PetscErrorCode create_part(Contact *contact, PetscInt number, const double work[])
{
  Interface    *interface = &contact->interfaces[number];
  ContactPart  *part      = &interface->part;
  PetscInt     *owner;
  const PetscInt d = interface->dimension;
  PetscInt       n;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(interface->n1, &owner));
  if (contact->mesh->rank == 0) PetscCall(choose_owners(contact, number, work, owner));
  PetscCall(parts_cut(contact, number, owner));
  PetscCall(PetscFree(owner));
  {
    const PetscInt        counts[3] = {part->n1, part->n2, part->n1}, fields[3] = {0, 0, 1 + number};
    const PetscInt        widths[3] = {d, d, part->components};
    const PetscInt *const nodes[3]  = {part->vertices, part->vertices + part->n1, part->vertices};
    PetscCall(unknowns_gather_create(contact->physics, 3, counts, nodes, fields, widths, &part->sf));
  }
  n = n_entries(part);
  PetscCall(PetscCalloc5(n, &part->X, n, &part->x, n, &part->gathered, n, &part->forces, n, &part->equations));
  PetscCall(PetscCalloc4(n, &part->lambda, n, &part->lambda_start, n, &part->lambda_last, n, &part->lambda_before));
  PetscCall(PetscCalloc4(n, &part->host, n, &part->rows, n, &part->host_there, n, &part->x_there));
  PetscCall(fetch_equations(contact, part->sf, n, part->equations));
  PetscCall(number_multipliers(contact, part));
  PetscCall(fetch_coordinates(contact, interface));
  PetscCall(number_rigid(contact, interface));
  contact_positions(part);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode destroy_part(ContactPart *part)
{
  PetscFunctionBegin;
  PetscCallStickslip(stickslip_interface_destroy(&part->handle));
  PetscCall(PetscSFDestroy(&part->sf));
  PetscCall(PetscFree5(part->X, part->x, part->gathered, part->forces, part->equations));
  PetscCall(PetscFree4(part->lambda, part->lambda_start, part->lambda_last, part->lambda_before));
  PetscCall(PetscFree4(part->host, part->rows, part->host_there, part->x_there));
  PetscCall(PetscFree3(part->coo_rows, part->coo_columns, part->coo_values));
  PetscCall(rigid_part_destroy(part));
  PetscCall(parts_destroy(part));
  *part = (ContactPart){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode create_library(Contact *contact, Interface *interface, PetscInt *status)
{
  ContactPart *part    = &interface->part;
  int32_t      refused = 0;
  PetscFunctionBegin;
  if (part->n1) {
    PetscCall(create_handle(part, &interface->options, &part->handle, &refused));
    if (!refused) refused = set_constraints(part);
    if (!refused) refused = offsets_set(interface, part->handle, 0);
    if (!refused && contact->condensed) /* refused at once rather than in the first step */
      refused = stickslip_interface_condensed_multipliers(part->handle, part->x, MORTAR_OF(part, part->x), part->host,
                                                          part->lambda);
  }
  PetscCall(contact_agree(contact, interface, refused, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of a part's facets, both sides */
static PetscReal shortest_edge(const ContactPart *part)
{
  PetscReal squared = PETSC_MAX_REAL;
  for (int side = 0; side < 2; side++) {
    const double *x = part->X + (side ? part->dimension * part->n1 : 0);
    for (PetscInt f = 0; f < part->n_facets[side]; f++) {
      const PetscInt *nodes = part->facet_nodes[side] + part->offsets[side][f];
      const PetscInt  n     = part->offsets[side][f + 1] - part->offsets[side][f];
      for (PetscInt k = 0; k < n; k++) {
        PetscReal sum = 0;
        for (PetscInt i = 0; i < part->dimension; i++)
          sum += PetscSqr(x[part->dimension * nodes[k] + i] - x[part->dimension * nodes[(k + 1) % n] + i]);
        squared = PetscMin(squared, sum);
      }
    }
  }
  return PetscSqrtReal(squared);
}

/* What parts of equally many nodes say at the start, before any has a history: what each node costs (rank 0), and whether the
 * bodies are deeper in each other than the rings of parts allow. */
static PetscErrorCode measure_work(const Interface *interface, PetscMPIInt rank, double work[], PetscBool *deep)
{
  const ContactPart *part     = &interface->part;
  PetscReal          shortest = part->handle ? shortest_edge(part) : PETSC_MAX_REAL;
  ContactCover       cover;
  int64_t           *facets;
  double            *here;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(part->n1, &facets, part->n1, &here));
  PetscCall(contact_cover(interface, part->handle, rank, &cover, facets));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &shortest, 1, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  *deep = (PetscBool)(cover.penetration > PARTS_DEPTH * shortest);
  for (PetscInt a = 0; a < part->n1; a++)
    here[a] = 1 + (double)facets[a]; /* a node without any costs a little, too */
  PetscCall(parts_collect(part, 1, here, work));
  PetscCall(PetscFree2(facets, here));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A part of an interface on every rank, of equal work. */
static PetscErrorCode create_parts(Contact *contact, PetscInt number, PetscInt *status)
{
  Interface *interface = &contact->interfaces[number];
  PetscBool  deep = PETSC_FALSE;
  double    *work;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(interface->n1, &work));
  for (PetscInt a = 0; a < interface->n1; a++)
    work[a] = 1;
  PetscCall(create_part(contact, number, interface->offsets.any ? NULL : work)); /* offsets reach deeper than the rings of parts */
  PetscCall(create_library(contact, interface, status));
  if (!*status && interface->n_parts > 1) {
    PetscCall(measure_work(interface, contact->mesh->rank, work, &deep));
    PetscCall(destroy_part(&interface->part));
    PetscCall(create_part(contact, number, deep ? NULL : work));
    PetscCall(create_library(contact, interface, status));
  }
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_create(Contact *contact, Scene *scene, PetscBool quiet, PetscInt *status)
{
  const Mesh *mesh = contact->mesh;
  char        why[256] = "";
  PetscFunctionBegin;
  *status = 0;
  scene_root_begin(scene);
  if (mesh->rank == 0 && contact->condensed) PetscCall(condensed_check(contact, why, sizeof(why)));
  if (why[0]) scene_fail(scene, NULL, "unknowns", "%s.", why);
  PetscCall(scene_root_end(scene));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    PetscCall(share_options(interface));
    PetscCall(create_whole(contact, interface));
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
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    PetscCall(destroy_part(&interface->part));
    PetscCall(PetscSFDestroy(&interface->sf));
    PetscCall(contact_states_destroy(&interface->states));
    PetscCall(offsets_destroy(interface));
    PetscCall(PetscFree4(interface->X, interface->displacements, interface->forces, interface->equations));
    PetscCall(surfaces_destroy(interface));
    PetscCall(PetscFree(interface->removed));
    PetscCall(PetscFree(interface->middle));
  }
  PetscCall(PetscFree(contact->interfaces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
