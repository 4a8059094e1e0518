/* A part's handle, and how a new part takes the place of an old one: made of the first configuration, then put to t_n. */
#include "internal.h"
#include <stdlib.h>
#include <string.h>

static int32_t *owned(const Part *part)
{
  int32_t *found = allocate(part->n_nodes[0], sizeof(*found));
  for (int64_t k = 0; k < part->n_nodes[0]; k++) found[k] = STICKSLIP_NODE_ELSEWHERE;
  for (int64_t k = 0; k < part->n_worked; k++) found[part->works[k]] = STICKSLIP_NODE_OWN;
  return found;
}

/* Collective. Numbers of the own nodes at those of the part. */
static int64_t *numbers_of(const Exchange *copies, int64_t n, int width, const int64_t own[])
{
  int64_t *found = allocate(width * n, sizeof(*found));
  exchange_bring(copies, width * (int64_t)sizeof(*own), own, found);
  return found;
}

static double *values_of(const Exchange *copies, int64_t n, int width, const double own[])
{
  double *found = allocate(width * n, sizeof(*found));
  exchange_bring(copies, width * (int64_t)sizeof(*own), own, found);
  return found;
}

/* Collective. The handle, of the first configuration; not agreed. */
static int32_t create(const stickslip_mpi_interface *interface, Part *part)
{
  const int         d = interface->dimension, base = interface->options.index_base;
  stickslip_surface surface[SIDES] = {{0}};
  int64_t          *equations[SIDES], *nodes[SIDES], *multipliers;
  int32_t          *own = owned(part), status = STICKSLIP_OK;
  double           *X[SIDES];
  multipliers = numbers_of(&part->copies[0], part->n_nodes[0], interface->components, interface->multipliers);
  for (int s = 0; s < SIDES; s++) {
    equations[s] = numbers_of(&part->copies[s], part->n_nodes[s], d, interface->equations[s]);
    nodes[s]     = copied(part->facet_nodes[s], part->offsets[s][part->n_facets[s]], sizeof(**nodes));
    for (int64_t k = 0; k < part->offsets[s][part->n_facets[s]]; k++) nodes[s][k] += base;
    X[s] = allocate(d * part->n_nodes[s], sizeof(**X));
    for (int64_t k = 0; k < part->n_nodes[s]; k++)
      memcpy(X[s] + d * k, interface->whole[s].X + d * (int64_t)part->nodes[s][k], (size_t)d * sizeof(**X));
    surface[s] = (stickslip_surface){.struct_size = sizeof(surface[s]), .n_nodes = part->n_nodes[s], .n_facets = part->n_facets[s],
                                     .coordinates = X[s], .facet_offsets = part->offsets[s], .facet_nodes = nodes[s],
                                     .equations = equations[s]};
    if (!part->n_facets[s]) surface[s].facet_offsets = surface[s].facet_nodes = NULL; /* an analytic side */
  }
  surface[0].multiplier_equations = multipliers;
  surface[0].owned                = own;
  if (part->n_worked) status = stickslip_interface_create(&surface[0], &surface[1], &interface->options, &part->handle);
  for (int s = 0; s < SIDES; s++) {
    free(equations[s]);
    free(nodes[s]);
    free(X[s]);
  }
  free(multipliers);
  free(own);
  return status;
}

/* Collective, not agreed. Offsets of the own nodes; after a refusal nothing but messages. */
void part_offsets(Part *part, double *const own[SIDES], int32_t *status)
{
  double *offsets[SIDES];
  for (int s = 0; s < SIDES; s++) offsets[s] = values_of(&part->copies[s], part->n_nodes[s], 1, own[s]);
  if (part->handle && !*status) *status = stickslip_interface_set_offsets(part->handle, offsets[0], offsets[1]);
  for (int s = 0; s < SIDES; s++) free(offsets[s]);
}

/* Collective, not agreed. Makes the handle and puts it to t_n, with what was set for its nodes. */
int32_t part_revive(const stickslip_mpi_interface *interface, const State *t_n, Part *part)
{
  const int d = interface->dimension;
  int32_t   status = create(interface, part);
  double   *x[SIDES], *slip, *friction = NULL;
  for (int s = 0; s < SIDES; s++) x[s] = values_of(&part->copies[s], part->n_nodes[s], d, t_n->x[s]);
  slip = values_of(&part->copies[0], part->n_nodes[0], d, t_n->slip);
  if (interface->friction) friction = values_of(&part->copies[0], part->n_nodes[0], 1, interface->friction);
  if (part->handle && !status && friction) status = stickslip_interface_set_friction(part->handle, friction);
  if (t_n->offsets[0]) part_offsets(part, t_n->offsets, &status);
  if (part->handle && !status && t_n->commits) status = stickslip_interface_set_committed(part->handle, x[0], x[1], slip, t_n->commits);
  if (interface->offsets[0]) part_offsets(part, interface->offsets, &status);
  for (int s = 0; s < SIDES; s++) free(x[s]);
  free(slip);
  free(friction);
  return status;
}

/* Collective. Positions of the own nodes, and multipliers (NULL: those stay), to the part. */
void part_bring(const stickslip_mpi_interface *interface, Part *part, const At *at, const double *lambda)
{
  for (int s = 0; s < SIDES; s++) exchange_bring(&part->copies[s], interface->dimension * (int64_t)sizeof(double), at->x[s], part->x[s]);
  if (lambda) exchange_bring(&part->copies[0], interface->components * (int64_t)sizeof(double), lambda, part->lambda);
}

void part_destroy(Part *part)
{
  for (int s = 0; s < SIDES; s++) {
    exchange_destroy(&part->copies[s]);
    free(part->nodes[s]);
    free(part->facets[s]);
    free(part->offsets[s]);
    free(part->facet_nodes[s]);
    free(part->x[s]);
    free(part->force[s]);
  }
  exchange_destroy(&part->worked);
  free(part->lambda);
  free(part->rows);
  free(part->works);
  stickslip_interface_destroy(&part->handle);
  *part = (Part){0};
}

/* The places at which a part needs its mortar facets. */
static int places(const stickslip_mpi_interface *interface, const State *t_n, const At *now, const double *const X[SIDES], At at[PLACES])
{
  if (interface->size == 1 || interface->whole[1].n_facets == 0) return 0; /* all of it */
  if (is_frozen(interface)) {
    at[0] = (At){{X[0], X[1]}};
    return 1;
  }
  at[0] = (At){{t_n->x[0], t_n->x[1]}};
  at[1] = *now;
  return now->x[0] == t_n->x[0] ? 1 : 2;
}

/* Collective, agreed. New parts by interface->worker, at t_n, with what evaluations at `now` may need. Where the library refuses, the
 * parts are those that they were. */
int32_t parts_renew(stickslip_mpi_interface *interface, const State *t_n, const At *now)
{
  Part         old_part = interface->part, new_part = {0};
  Halo         old_halo = interface->halo, new_halo;
  const int    d = interface->dimension;
  double      *X[SIDES], *positions[PLACES] = {NULL};
  Box          boxes[PLACES * BOXES];
  At           at[PLACES];
  int          n;
  int32_t      status;
  for (int s = 0; s < SIDES; s++) {
    X[s] = allocate(d * interface->whole[s].n_own, sizeof(**X));
    for (int64_t k = 0; k < interface->whole[s].n_own; k++)
      memcpy(X[s] + d * k, interface->whole[s].X + d * (int64_t)interface->whole[s].own[k], (size_t)d * sizeof(**X));
  }
  cut_nonmortar(interface, &new_part);
  halo_create(interface, &new_part, &new_halo);
  halo_settle(interface, &new_part, t_n, &new_halo);
  n = places(interface, t_n, now, (const double *const *)X, at);
  for (int p = 0; p < n; p++) {
    halo_add(interface, &new_part, t_n, at[p].x, &new_halo);
    memcpy(boxes + p * BOXES, new_halo.place[p].box, sizeof(new_halo.place[p].box));
    positions[p] = whole_values(interface->comm, &interface->whole[1], d, at[p].x[1]);
  }
  cut_mortar(interface, boxes, n, positions, &new_part, &new_halo.whole);
  status = part_revive(interface, t_n, &new_part);
  interface->part = new_part; /* sentences are of this one */
  status          = agree(interface->comm, refuse_by_library(interface, status));
  interface->halo = new_halo;
  if (status) {
    interface->part = old_part;
    interface->halo = old_halo;
    old_part        = new_part;
    old_halo        = new_halo;
  } else {
    interface->native = 0;
    part_bring(interface, &interface->part, now, interface->lambda);
  }
  part_destroy(&old_part);
  halo_destroy(&old_halo);
  for (int p = 0; p < n; p++) free(positions[p]);
  for (int s = 0; s < SIDES; s++) free(X[s]);
  return status;
}
