/* A rank's part of an interface: its arrays, and the library's handle of it: surfaces in the library's arrays, equation numbers,
 * prescribed directions. */
#include "contact/skin.h"

/* of `gathered`, `forces` and `equations` */
static PetscInt n_entries(const ContactPart *part)
{
  return part->dimension * (part->n1 + part->n2) + part->components * part->n1;
}

/* equation numbers of the entries that come through `sf`; -1: none */
PetscErrorCode contact_equations(const Contact *contact, PetscSF sf, PetscInt n, int64_t equations[])
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

/* Has the k-th multiplier of the part been removed? */
static PetscBool no_multiplier(const ContactPart *part, PetscInt k)
{
  const PetscInt c = part->components, removed = part->removed[k / c];
  return (PetscBool)(c > 1 ? (removed >> k % c) & 1 : removed == 7);
}

/* The library has no multiplier that is removed, be there an unknown or not. Where multipliers are no unknowns it must know which there are,
 * nevertheless: numbers beyond all equations. */
static PetscErrorCode number_multipliers(const Contact *contact, ContactPart *part)
{
  const PetscInt d = part->components;
  PetscInt       n_equations;
  Vec            x;
  PetscFunctionBegin;
  PetscCall(DMGetGlobalVector(contact->mesh->dm, &x));
  PetscCall(VecGetSize(x, &n_equations));
  PetscCall(DMRestoreGlobalVector(contact->mesh->dm, &x));
  for (PetscInt k = 0; k < d * part->n1; k++) {
    int64_t *equation = &MULTIPLIERS_OF(part, part->equations)[k];
    if (no_multiplier(part, k))
      *equation = -1;
    else if (contact->condensed)
      *equation = n_equations + (int64_t)d * part->nodes[k / d] + k % d;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of rigid bodies: beyond those of multipliers, which have three a node at most. */
static PetscErrorCode number_rigid(const Contact *contact, Interface *interface)
{
  PetscInt n;
  Vec      x;
  PetscFunctionBegin;
  if (!contact->physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMGetGlobalVector(contact->mesh->dm, &x));
  PetscCall(VecGetSize(x, &n));
  PetscCall(DMRestoreGlobalVector(contact->mesh->dm, &x));
  PetscCall(rigid_part_create(contact, interface, n + 3 * interface->all[0], &interface->part));
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
static int32_t set_constraints(const ContactPart *part, stickslip_interface *handle)
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
  status = n ? stickslip_interface_set_constraints(handle, n, nodes, directions) : 0;
  PetscCallAbort(PETSC_COMM_SELF, PetscFree2(nodes, directions));
  return status;
}

/* Of the first configuration, where part->x must be. */
PetscErrorCode part_handle(const ContactPart *part, const stickslip_options *options, stickslip_interface **handle,
                           int32_t *refused)
{
  stickslip_surface surfaces[2];
  int64_t          *numbers[2];
  PetscFunctionBegin;
  for (int side = 0; side < 2; side++)
    PetscCall(describe_surface(part, side, &surfaces[side], &numbers[side]));
  *refused = stickslip_interface_create(&surfaces[0], &surfaces[1], options, handle);
  if (!*refused) *refused = set_constraints(part, *handle);
  for (int side = 0; side < 2; side++)
    PetscCall(PetscFree(numbers[side]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a part's positions count from: far from the origin X + u would round u away. A radius counts from the axis. */
static PetscErrorCode share_origin(Interface *interface)
{
  ContactPart   *part  = &interface->part;
  const PetscInt first = 0;
  PetscFunctionBegin;
  PetscCall(homes_coordinates(interface, 1, &first, part->origin));
  if (interface->options.model == STICKSLIP_MODEL_AXISYMMETRIC) part->origin[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Offsets of a part's nodes. */
static PetscErrorCode fetch_offsets(Interface *interface)
{
  PetscSF sf;
  PetscFunctionBegin;
  if (!interface->offsets.any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(homes_fetch_create(interface, interface->part.n1 + interface->part.n2, interface->part.nodes, &sf));
  PetscCall(offsets_fetch(sf, interface));
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the part's two sides need beside themselves, in the first configuration; no handle yet. */
static PetscErrorCode create_arrays(Contact *contact, PetscInt number)
{
  Interface            *interface = &contact->interfaces[number];
  ContactPart          *part      = &interface->part;
  const PetscInt        d = part->dimension, n = n_entries(part);
  const PetscInt        counts[3] = {part->n1, part->n2, part->n1}, fields[3] = {0, 0, 1 + number};
  const PetscInt        widths[3] = {d, d, part->components};
  const PetscInt *const nodes[3]  = {part->vertices, part->vertices + part->n1, part->vertices};
  const PetscInt *const copies[3] = {NULL, NULL, part->copies};

  PetscFunctionBegin;
  PetscCall(unknowns_gather_create(contact->physics, 3, counts, nodes, copies, fields, widths, &part->sf));
  PetscCall(PetscCalloc5(n, &part->X, n, &part->x, n, &part->gathered, n, &part->forces, n, &part->equations));
  PetscCall(PetscCalloc4(n, &part->lambda, n, &part->lambda_start, n, &part->lambda_last, n, &part->lambda_before));
  PetscCall(PetscCalloc4(n, &part->host, n, &part->rows, n, &part->host_there, n, &part->x_there));
  PetscCall(PetscCalloc3(d * part->n1, &part->slip, part->n1, &part->augmentation, interface->n_states * part->n1, &part->way));
  PetscCall(contact_equations(contact, part->sf, n, part->equations));
  PetscCall(number_multipliers(contact, part));
  PetscCall(homes_coordinates(interface, part->n1 + part->n2, part->nodes, part->X));
  PetscCall(number_rigid(contact, interface));
  PetscCall(fetch_offsets(interface));
  PetscCall(share_origin(interface));
  contact_positions(part);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part of every rank, by interface->owner, with what it may need on `n` ways from one local vector to another (or at one). */
PetscErrorCode part_create(Contact *contact, PetscInt number, PetscInt n, const Vec ways[][2])
{
  Interface *interface = &contact->interfaces[number];
  Vec        ends[HALO_PLACES];
  PetscFunctionBegin;
  PetscCall(parts_cut(contact, interface));
  if (interface->uncut || interface->n_parts < 2) n = 0;
  if (n) PetscCall(halo_begin(contact, interface));
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(halo_add(interface, ways[k]));
    ends[k] = ways[k][0];
  }
  PetscCall(mortar_cut(contact, interface, n, ends));
  PetscCall(create_arrays(contact, number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode part_destroy(ContactPart *part)
{
  PetscFunctionBegin;
  PetscCallStickslip(stickslip_interface_destroy(&part->handle));
  PetscCall(skin_part_destroy(part));
  PetscCall(PetscSFDestroy(&part->sf));
  PetscCall(PetscFree5(part->X, part->x, part->gathered, part->forces, part->equations));
  PetscCall(PetscFree4(part->lambda, part->lambda_start, part->lambda_last, part->lambda_before));
  PetscCall(PetscFree4(part->host, part->rows, part->host_there, part->x_there));
  PetscCall(PetscFree3(part->slip, part->augmentation, part->way));
  PetscCall(PetscFree3(part->coo_rows, part->coo_columns, part->coo_values));
  PetscCall(rigid_part_destroy(part));
  PetscCall(parts_destroy(part));
  *part = (ContactPart){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the part's handle has counted, and those before it, of parts that have been shared out anew. */
int32_t part_counters(const ContactPart *part, stickslip_counters *counters)
{
  const stickslip_counters *spent  = &part->spent;
  const int32_t             status = stickslip_interface_counters(part->handle, counters);
  counters->pairs_tested += spent->pairs_tested;
  counters->pairs_clipped += spent->pairs_clipped;
  counters->pairs_integrated += spent->pairs_integrated;
  counters->pairs_linearised += spent->pairs_linearised;
  counters->pairs_reused += spent->pairs_reused;
  counters->searches += spent->searches;
  counters->boxes_visited += spent->boxes_visited;
  counters->seconds_search += spent->seconds_search;
  counters->seconds_integration += spent->seconds_integration;
  counters->seconds_assembly += spent->seconds_assembly;
  counters->nodes_slipping += spent->nodes_slipping;
  counters->nodes_evaluated += spent->nodes_evaluated;
  counters->evaluations_apart += spent->evaluations_apart;
  counters->commits_apart += spent->commits_apart;
  return status;
}
