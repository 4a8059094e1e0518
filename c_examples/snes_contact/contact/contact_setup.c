/* Creating and destroying the library's interfaces: surfaces in its arrays, equation numbers, prescribed directions. */
#include "contact/contact.h"

/* of `gathered`, `forces` and `equations` */
static int64_t n_entries(const Interface *interface)
{
  return interface->dimension * ((int64_t)interface->n1 + interface->n2) + (int64_t)interface->components * interface->n1;
}

/* equations of the gathered entries, as the library wants them */
static PetscErrorCode gather_equations(Contact *contact, Interface *interface)
{
  const int64_t n = contact->mesh->rank ? 0 : n_entries(interface);
  PetscInt     *numbers, n_equations;
  Vec           x;
  PetscFunctionBegin;
  PetscCall(DMGetGlobalVector(contact->mesh->dm, &x));
  PetscCall(VecGetSize(x, &n_equations));
  PetscCall(DMRestoreGlobalVector(contact->mesh->dm, &x));
  PetscCall(PetscMalloc1(n, &numbers));
  PetscCall(PetscSFBcastBegin(interface->sf, MPIU_INT, contact->physics->unknowns.equations, numbers, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(interface->sf, MPIU_INT, contact->physics->unknowns.equations, numbers, MPI_REPLACE));
  for (int64_t k = 0; k < n; k++)
    interface->equations[k] = numbers[k] < 0 ? -1 : numbers[k];
  /* No unknowns, but the library must know which there are: numbers beyond all equations. */
  for (int64_t k = 0; k < (int64_t)interface->components * interface->n1 && contact->condensed && n; k++) {
    const PetscInt removed = interface->removed[k / interface->components], i = k % interface->components;
    const PetscBool none = (PetscBool)(interface->components > 1 ? (removed >> i) & 1 : removed == 7);
    MULTIPLIERS_OF(interface, interface->equations)[k] = none ? -1 : n_equations + k;
  }
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_surface(const Contact *contact, const Interface *interface, int side, stickslip_surface *out,
                               int64_t **facet_nodes)
{
  const Surface *surface = interface->surface[side];
  const PetscInt first = side ? interface->n1 : 0, n = side ? interface->n2 : interface->n1,
                 n_corners = surface->offsets[surface->n_faces];
  PetscInt      *local;
  int64_t       *offsets;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n_corners + surface->n_faces + 1, facet_nodes));
  PetscCall(PetscMalloc1(contact->mesh->n_vertices, &local));
  offsets = *facet_nodes + n_corners;
  for (PetscInt k = 0; k < n; k++)
    local[interface->nodes[first + k]] = k;
  for (PetscInt k = 0; k < n_corners; k++)
    (*facet_nodes)[k] = local[surface->vertices[k]];
  for (PetscInt f = 0; f <= surface->n_faces; f++)
    offsets[f] = surface->offsets[f];
  *out               = (stickslip_surface){.struct_size = sizeof(*out)};
  out->n_nodes       = n;
  out->n_facets      = surface->n_faces;
  out->coordinates   = interface->x + interface->dimension * first;
  out->facet_offsets = surface->analytic ? NULL : offsets;
  out->facet_nodes   = surface->analytic ? NULL : *facet_nodes;
  out->equations     = interface->equations + interface->dimension * first;
  if (!side) out->multiplier_equations = MULTIPLIERS_OF(interface, interface->equations);
  PetscCall(PetscFree(local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The directions removed carry no multiplier, and the normal none of them. */
static int32_t set_constraints(const Interface *interface)
{
  int64_t *nodes, n = 0;
  double  *directions;
  int32_t  status;
  const PetscInt d = interface->dimension;
  PetscCallAbort(PETSC_COMM_SELF, PetscCalloc2(2 * interface->n1, &nodes, 2 * d * interface->n1, &directions));
  for (PetscInt a = 0; a < interface->n1; a++) {
    if (interface->removed[a] == 7) continue; /* wholly prescribed: no unknown is left, and the normal stays free */
    for (int i = 0; i < d; i++) {
      if (!(interface->removed[a] & (1 << i))) continue;
      nodes[n]              = a;
      directions[d * n + i] = 1;
      n++;
    }
  }
  status = n ? stickslip_interface_set_constraints(interface->handle, n, nodes, directions) : 0;
  PetscCallAbort(PETSC_COMM_SELF, PetscFree2(nodes, directions));
  return status;
}

/* rank 0: surfaces that lie over each other but are no pair would be passed through without a word. Where any pair has
 * been found there is nothing to ask. A handle of its own is asked, so that the other's counters stay what they are. */
static PetscErrorCode check_facing(const Contact *contact, Scene *scene, PetscBool quiet, Interface *interface)
{
  char                 text[1024];
  stickslip_counters   counters = {.struct_size = sizeof(counters)};
  stickslip_report     report   = {.struct_size = sizeof(report), .text = text, .text_capacity = sizeof(text)};
  stickslip_surface    surfaces[2];
  int64_t             *facet_nodes[2];
  stickslip_interface *asked = NULL;

  PetscFunctionBegin;
  PetscCallStickslip(stickslip_interface_counters(interface->handle, &counters));
  if (counters.pairs_active) PetscFunctionReturn(PETSC_SUCCESS);
  for (int side = 0; side < 2; side++)
    PetscCall(contact_surface(contact, interface, side, &surfaces[side], &facet_nodes[side]));
  PetscCallStickslip(stickslip_interface_create(&surfaces[0], &surfaces[1], &interface->options, &asked));
  PetscCallStickslip(offsets_set(interface, asked, 0));
  PetscCallStickslip(stickslip_interface_report(asked, interface->x, MORTAR_OF(interface, interface->x), &report));
  PetscCallStickslip(stickslip_interface_destroy(&asked));
  for (int side = 0; side < 2; side++)
    PetscCall(PetscFree(facet_nodes[side]));
  if (report.finding == STICKSLIP_FINDING_BEHIND || report.finding == STICKSLIP_FINDING_SAME_WAY)
    scene_fail(scene, interface->name, "mortar", "%s", text);
  if (report.finding != STICKSLIP_FINDING_NONE && !quiet) /* they may meet later */
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "%s: %s\n", interface->name, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_create(Contact *contact, Scene *scene, PetscBool quiet, PetscInt *status)
{
  const Mesh *mesh = contact->mesh;
  char          why[256] = "";
  PetscFunctionBegin;
  *status = 0;
  scene_root_begin(scene);
  if (mesh->rank == 0 && contact->condensed) PetscCall(condensed_check(contact, why, sizeof(why)));
  if (why[0]) scene_fail(scene, NULL, "unknowns", "%s.", why);
  PetscCall(scene_root_end(scene));
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface            *interface = &contact->interfaces[i];
    const PetscInt        counts[3] = {interface->n1, interface->n2, interface->n1}, fields[3] = {0, 0, 1 + i};
    const PetscInt        widths[3] = {interface->dimension, interface->dimension, interface->components};
    const PetscInt *const nodes[3] = {interface->nodes, interface->nodes + interface->n1, interface->nodes};
    int32_t               refused  = 0;
    const int64_t         n        = mesh->rank ? 0 : n_entries(interface);

    PetscCall(unknowns_gather_create(contact->physics, 3, counts, nodes, fields, widths, &interface->sf));
    PetscCall(PetscCalloc5(n, &interface->X, n, &interface->x, n, &interface->gathered, n, &interface->forces, n,
                           &interface->equations));
    PetscCall(PetscCalloc4(n, &interface->lambda, n, &interface->lambda_start, n, &interface->lambda_last, n,
                           &interface->lambda_before));
    PetscCall(PetscCalloc4(n, &interface->host, n, &interface->rows, n, &interface->host_there, n, &interface->x_there));
    PetscCall(gather_equations(contact, interface));
    if (mesh->rank == 0) {
      stickslip_surface surfaces[2];
      int64_t          *facet_nodes[2];
      const PetscInt    d = interface->dimension;
      for (PetscInt k = 0; k < d * (interface->n1 + interface->n2); k++)
        interface->X[k] = mesh->coordinates[3 * interface->nodes[k / d] + k % d];
      contact_positions(interface);
      for (int side = 0; side < 2; side++)
        PetscCall(contact_surface(contact, interface, side, &surfaces[side], &facet_nodes[side]));
      refused = stickslip_interface_create(&surfaces[0], &surfaces[1], &interface->options, &interface->handle);
      if (!refused) refused = set_constraints(interface);
      if (!refused && interface->offsets.any) refused = offsets_create(mesh, interface);
      if (!refused) refused = offsets_set(interface, interface->handle, 0);
      if (!refused && contact->condensed) /* refused at once rather than in the first step */
        refused = stickslip_interface_condensed_multipliers(interface->handle, interface->x, MORTAR_OF(interface, interface->x),
                                                            interface->host, interface->lambda);
      for (int side = 0; side < 2; side++)
        PetscCall(PetscFree(facet_nodes[side]));
    }
    PetscCall(contact_agree(contact, refused, status));
    if (*status) break;
    scene_root_begin(scene);
    if (mesh->rank == 0) PetscCall(check_facing(contact, scene, quiet, interface));
    PetscCall(scene_root_end(scene));
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
    PetscCallStickslip(stickslip_interface_destroy(&interface->handle));
    PetscCall(PetscSFDestroy(&interface->sf));
    PetscCall(PetscFree5(interface->X, interface->x, interface->gathered, interface->forces, interface->equations));
    PetscCall(PetscFree4(interface->lambda, interface->lambda_start, interface->lambda_last, interface->lambda_before));
    PetscCall(PetscFree4(interface->host, interface->rows, interface->host_there, interface->x_there));
    PetscCall(PetscFree3(interface->coo_rows, interface->coo_columns, interface->coo_values));
    PetscCall(offsets_destroy(interface));
    PetscCall(PetscFree(interface->nodes));
    PetscCall(PetscFree(interface->removed));
    PetscCall(PetscFree(interface->middle));
  }
  PetscCall(PetscFree(contact->interfaces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
