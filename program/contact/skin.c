/* The library's handle of a skin. It has nodes and copies of them, where the part of an interface has a node for each; and equations of its
 * own, which are the places of the part's entries. */
#include "contact/skin.h"

/* The library's numbers of the part's nodes: first those that are no copies, in their order, then the others. */
static PetscErrorCode number_nodes(ContactPart *part)
{
  SkinPart *skin = part->skin;
  PetscInt *vertices, *known, n = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc3(part->n1, &skin->node, part->n1, &skin->first, part->n1, &skin->opposite));
  PetscCall(PetscMalloc2(part->n1, &vertices, part->n1, &known));
  for (PetscInt a = 0; a < part->n1; a++) {
    if (part->copies[a]) continue;
    vertices[n]    = part->vertices[a];
    known[n]       = n;
    skin->node[n++] = a;
  }
  skin->n_nodes = n;
  PetscCall(PetscSortIntWithArray(n, vertices, known));
  for (PetscInt a = 0; a < part->n1; a++) {
    PetscInt place;
    PetscCall(PetscFindInt(part->vertices[a], n, vertices, &place));
    PetscCheck(place >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a copy without its node");
    skin->first[a] = known[place];
  }
  PetscCall(PetscFree2(vertices, known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Facets by the nodes that they are copies of, and the bodies of these; to be freed. */
static PetscErrorCode describe(const Interface *interface, const Mesh *mesh, stickslip_surface *surface, int64_t **numbers, int64_t **bodies)
{
  const ContactPart *part = &interface->part;
  const SkinPart    *skin = part->skin;
  const PetscInt     d = part->dimension, n_facets = part->n_facets[0], n_corners = part->offsets[0][n_facets];
  int64_t           *equations;
  double            *x;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n_corners + n_facets + 1 + d * skin->n_nodes, numbers));
  PetscCall(PetscMalloc1(n_facets, bodies));
  for (PetscInt k = 0; k < n_corners; k++)
    (*numbers)[k] = skin->first[part->facet_nodes[0][k]];
  for (PetscInt f = 0; f <= n_facets; f++)
    (*numbers)[n_corners + f] = part->offsets[0][f];
  for (PetscInt f = 0; f < n_facets; f++)
    (*bodies)[f] = mesh_body_of(mesh, part->vertices[part->facet_nodes[0][part->offsets[0][f]]]);
  equations = *numbers + n_corners + n_facets + 1;
  x         = skin->x;
  for (PetscInt k = 0; k < d * skin->n_nodes; k++) {
    const PetscInt entry = d * skin->node[k / d] + k % d;
    equations[k]         = part->equations[entry] < 0 ? -1 : k;
    x[k]                 = part->x[entry];
  }
  *surface = (stickslip_surface){.struct_size = sizeof(*surface), .n_nodes = skin->n_nodes, .n_facets = n_facets, .coordinates = x};
  surface->facet_offsets = *numbers + n_corners;
  surface->facet_nodes   = *numbers;
  surface->equations     = equations;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which node of the part each copy of the library's is, and which entry each of its equations. */
static PetscErrorCode number_copies(ContactPart *part)
{
  SkinPart      *skin = part->skin;
  const PetscInt d    = part->dimension;
  PetscInt      *met, *next, *newest;
  int64_t       *originals, *equations, count, multipliers;
  PetscFunctionBegin;
  PetscCallStickslip(stickslip_skin_copies(skin->handle, 0, NULL, NULL, &count, &multipliers));
  PetscCheck(count == part->n1, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the skin has %d copies, and the interface %d nodes", (int)count, (int)part->n1);
  skin->n_copies  = part->n1;
  skin->n_numbers = d * skin->n_nodes + multipliers;
  PetscCall(PetscMalloc2(count, &originals, d * count, &equations));
  PetscCall(PetscMalloc2(count, &skin->copy, skin->n_numbers, &skin->numbers));
  PetscCallStickslip(stickslip_skin_copies(skin->handle, count, originals, equations, &count, &multipliers));
  /* copies of a node are met in the order of their numbers */
  PetscCall(PetscCalloc3(part->n1, &met, part->n1, &next, part->n1, &newest));
  for (PetscInt a = part->n1; a-- > 0;) { /* lists of the copies of a node: `next` of each, by falling nodes of the part */
    next[a]                    = newest[skin->first[a]] - 1;
    newest[skin->first[a]] = a + 1;
  }
  for (PetscInt c = 0; c < count; c++) {
    const PetscInt node = (PetscInt)originals[c];
    PetscInt       a    = newest[node] - 1;
    while (a >= 0 && part->copies[a] != met[node])
      a = next[a];
    PetscCheck(a >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a copy of the skin that is no node of the interface");
    met[node]++;
    skin->copy[c] = a;
  }
  for (PetscInt k = 0; k < d * skin->n_nodes; k++)
    skin->numbers[k] = d * skin->node[k / d] + k % d;
  for (PetscInt k = 0; k < d * count; k++) {
    if (equations[k] >= 0) skin->numbers[equations[k]] = d * part->n1 + d * skin->copy[k / d] + k % d;
  }
  PetscCall(PetscFree3(met, next, newest));
  PetscCall(PetscFree2(originals, equations));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The directions removed carry no multiplier, and the normal none of them. */
static int32_t set_constraints(const ContactPart *part)
{
  const SkinPart *skin = part->skin;
  const PetscInt  d    = part->dimension;
  int64_t        *nodes, n = 0;
  double         *directions;
  int32_t         status;
  PetscCallAbort(PETSC_COMM_SELF, PetscCalloc2(3 * skin->n_nodes, &nodes, 3 * d * skin->n_nodes, &directions));
  for (PetscInt k = 0; k < skin->n_nodes; k++) {
    const PetscInt removed = part->middle[skin->node[k]] ? 0 : part->removed[skin->node[k]];
    for (int i = 0; i < d && removed != 7; i++) {
      if (!(removed & (1 << i))) continue;
      nodes[n]              = k;
      directions[d * n + i] = 1;
      n++;
    }
  }
  status = n ? stickslip_skin_set_constraints(skin->handle, n, nodes, directions) : 0;
  PetscCallAbort(PETSC_COMM_SELF, PetscFree2(nodes, directions));
  return status;
}

/* A body that has left no facet in the skin cannot touch. */
static PetscBool has_facet(const int64_t bodies[], PetscInt n, PetscInt body)
{
  for (PetscInt f = 0; f < n; f++) {
    if (bodies[f] == body) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Of the first configuration, where part->x must be. */
PetscErrorCode skin_part_create(const Contact *contact, Interface *interface, int32_t *refused)
{
  ContactPart      *part = &interface->part;
  const PetscInt    d    = part->dimension;
  SkinPart         *skin;
  stickslip_surface surface;
  int64_t          *numbers, *bodies;
  PetscFunctionBegin;
  PetscCall(PetscNew(&skin));
  part->skin = skin;
  PetscCall(number_nodes(part));
  PetscCall(PetscMalloc5(d * skin->n_nodes, &skin->x, d * part->n1, &skin->lambda, d * skin->n_nodes, &skin->force, d * part->n1,
                         &skin->rows, d * skin->n_nodes, &skin->dx));
  PetscCall(describe(interface, contact->mesh, &surface, &numbers, &bodies));
  skin->n_facets = part->n_facets[0];
  *refused       = stickslip_skin_create(&surface, bodies, d * skin->n_nodes, &interface->options, &skin->handle);
  for (PetscInt k = 0; k < interface->skin->n_pairs && !*refused; k++) {
    const SkinPair *pair = &interface->skin->pairs[k];
    if (has_facet(bodies, skin->n_facets, pair->bodies[0]) && has_facet(bodies, skin->n_facets, pair->bodies[1]))
      *refused = stickslip_skin_set_pair(skin->handle, pair->bodies[0], pair->bodies[1], pair->mu);
  }
  if (!*refused) *refused = set_constraints(part);
  if (!*refused) PetscCall(number_copies(part));
  if (!*refused) PetscCall(skin_look(part));
  PetscCall(PetscFree(numbers));
  PetscCall(PetscFree(bodies));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode skin_part_destroy(ContactPart *part)
{
  SkinPart *skin = part->skin;
  PetscFunctionBegin;
  if (!skin) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallStickslip(stickslip_skin_destroy(&skin->handle));
  PetscCall(PetscFree3(skin->node, skin->first, skin->opposite));
  PetscCall(PetscFree2(skin->copy, skin->numbers));
  PetscCall(PetscFree5(skin->x, skin->lambda, skin->force, skin->rows, skin->dx));
  PetscCall(PetscFree(part->skin));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void skin_point(ContactPart *part)
{
  SkinPart          *skin   = part->skin;
  const PetscInt     d      = part->dimension;
  const PetscScalar *lambda = MULTIPLIERS_OF(part, part->gathered);
  for (PetscInt k = 0; k < d * skin->n_nodes; k++)
    skin->x[k] = part->x[d * skin->node[k / d] + k % d];
  for (PetscInt k = 0; k < d * skin->n_copies; k++)
    skin->lambda[k] = PetscRealPart(lambda[d * skin->copy[k / d] + k % d]);
}

void skin_to_part(const ContactPart *part, PetscInt width, const double copies[], double nodes[])
{
  for (PetscInt k = 0; k < width * part->skin->n_copies; k++)
    nodes[width * part->skin->copy[k / width] + k % width] = copies[k];
}

PetscReal contact_friction(const Mesh *mesh, const Interface *interface, PetscInt a)
{
  const ContactPart *part     = &interface->part;
  const PetscInt     opposite = part->skin ? part->skin->opposite[a] : -1;
  PetscReal          mu       = interface->options.mu;
  PetscInt           own, other;
  if (opposite < 0) return mu;
  own   = mesh_body_of(mesh, part->vertices[a]);
  other = mesh_body_of(mesh, part->vertices[opposite]);
  for (PetscInt k = 0; k < interface->skin->n_pairs; k++) { /* the last word counts */
    const SkinPair *pair = &interface->skin->pairs[k];
    if ((pair->bodies[0] == own && pair->bodies[1] == other) || (pair->bodies[0] == other && pair->bodies[1] == own)) mu = PetscMax(0, pair->mu);
  }
  return mu;
}

PetscErrorCode skin_facets(const ContactPart *part, SkinFacets *facets)
{
  const PetscInt       n   = part->skin->n_facets;
  stickslip_skin_sides out = {.struct_size = sizeof(out)};
  PetscFunctionBegin;
  PetscCall(PetscMalloc5(n, &facets->side, n, &facets->piece, n, &facets->partner, n, &facets->distance, n, &facets->body));
  out.side     = facets->side;
  out.piece    = facets->piece;
  out.partner  = facets->partner;
  out.distance = facets->distance;
  out.body     = facets->body;
  PetscCallStickslip(stickslip_skin_facets(part->skin->handle, &out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode skin_facets_destroy(SkinFacets *facets)
{
  PetscFunctionBegin;
  PetscCall(PetscFree5(facets->side, facets->piece, facets->partner, facets->distance, facets->body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In this run and in those that it goes on from. */
void skin_counts(const ContactPart *part, int64_t counts[SKIN_COUNTS])
{
  stickslip_skin_summary found = {.struct_size = sizeof(found)};
  PetscCallAbort(PETSC_COMM_SELF, stickslip_skin_report(part->skin->handle, &found) ? PETSC_ERR_LIB : PETSC_SUCCESS);
  counts[0] = part->skin->before[0] + found.made;
  counts[1] = part->skin->before[1] + found.exchanged;
  counts[2] = part->skin->before[2] + found.missed;
}

/* Of each node a corner of the facet opposite of the nearest of its facets. */
PetscErrorCode skin_look(ContactPart *part)
{
  SkinFacets facets;
  double    *nearest;
  PetscFunctionBegin;
  PetscCall(skin_facets(part, &facets));
  PetscCall(PetscMalloc1(part->n1, &nearest));
  for (PetscInt a = 0; a < part->n1; a++) {
    part->skin->opposite[a] = -1;
    nearest[a]              = PETSC_MAX_REAL;
  }
  for (PetscInt f = 0; f < part->skin->n_facets; f++) {
    if (facets.partner[f] < 0) continue;
    for (PetscInt k = part->offsets[0][f]; k < part->offsets[0][f + 1]; k++) {
      const PetscInt a = part->facet_nodes[0][k];
      if (facets.distance[f] >= nearest[a]) continue;
      nearest[a]              = facets.distance[f];
      part->skin->opposite[a] = part->facet_nodes[0][part->offsets[0][facets.partner[f]]];
    }
  }
  PetscCall(PetscFree(nearest));
  PetscCall(skin_facets_destroy(&facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode skin_nodes(const Interface *interface, SkinNode **nodes)
{
  const ContactStates *states = &interface->states;
  SkinNode            *home;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(interface->n1, &home));
  PetscCall(PetscMalloc1(interface->part.n1, nodes));
  for (PetscInt a = 0; a < interface->n1; a++) {
    SkinNode *node = &home[a];
    *node          = (SkinNode){.state = states->state[a], .gap = states->gap[a], .coverage = states->coverage[a]};
    PetscCall(PetscArraycpy(node->multiplier, states->multiplier + 3 * a, 3));
    PetscCall(PetscArraycpy(node->normal, states->normal + 3 * a, 3));
    contact_vector(interface->dimension, interface->displacements, a, node->displacement);
  }
  PetscCall(parts_send(&interface->part, sizeof(SkinNode) / sizeof(double), (const double *)home, (double *)*nodes));
  PetscCall(PetscFree(home));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal skin_pressure(const SkinNode *node)
{
  PetscReal pressure = 0;
  for (int i = 0; i < 3; i++)
    pressure -= node->multiplier[i] * node->normal[i];
  return pressure;
}
