/* Whether a part has all mortar facets that it may need.
 *
 * When a part gets its mortar facets, at some place, boxes around what its facets sweep are kept, with a margin: it has every facet
 * that met a box there. Later a point p of a mortar facet lies in the sweep of now. It was p - u at that place, u being what it has
 * moved since. The u of all mortar nodes lie in a box, and so does u: sweeps of now, less that box, must lie in the boxes kept. If
 * they do not, the part may lack a facet. Nobody has all mortar nodes; each rank watches its own, and a reduction brings the box. */
#include "internal.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of all mortar nodes: positions; motions since t_n, since each place. */
enum { POSITIONS, SINCE_T_N, SINCE_PLACE, N_BOUNDS = SINCE_PLACE + PLACES };

/* The pairs are those of the first configuration for good. */
int is_frozen(const stickslip_mpi_interface *interface)
{
  const stickslip_options *options = &interface->options;
  return interface->choices.weights == STICKSLIP_WEIGHTS_REFERENCE || options->friction == STICKSLIP_FRICTION_TIED ||
         options->small_displacements;
}

static double margin_of(const stickslip_mpi_interface *interface)
{
  static const double MARGIN = 2; /* longest edges */
  return (interface->method.margin > 0 ? interface->method.margin : MARGIN) * interface->longest_edge;
}

static void bounds_of_all(const stickslip_mpi_interface *interface, const Halo *halo, const State *t_n, const double x[], Bounds of[])
{
  const int d = interface->dimension;
  for (int k = 0; k < N_BOUNDS; k++) bounds_clear(&of[k]);
  for (int64_t k = 0; k < interface->whole[1].n_own; k++) {
    double now[3], then[3];
    point_of(d, x, k, now);
    bounds_add(&of[POSITIONS], now, NULL);
    point_of(d, t_n->x[1], k, then);
    bounds_add(&of[SINCE_T_N], now, then);
    for (int p = 0; p < halo->n_places; p++) {
      point_of(d, halo->place[p].own, k, then);
      bounds_add(&of[SINCE_PLACE + p], now, then);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, of, 6 * N_BOUNDS, MPI_DOUBLE, MPI_MAX, interface->comm);
}

static Sweep sweep_of(const stickslip_mpi_interface *interface, const Part *part, const Halo *halo, const double x[], const Bounds of[])
{
  const stickslip_method *method  = &interface->choices;
  const int               follows = method->normals != STICKSLIP_NORMALS_COMMITTED;
  return (Sweep){.dimension = interface->dimension,
                 .follows   = follows,
                 .distance  = interface->offsets[0] ? 0 : interface->options.search_distance,
                 .part      = part,
                 .x         = x,
                 .x_t_n     = halo->x_t_n,
                 .mortar    = &of[POSITIONS],
                 .moved     = &of[SINCE_T_N]};
}

/* Of the part's non-mortar facets, before it has mortar ones. Neighbouring facets share a box. */
void halo_create(const stickslip_mpi_interface *interface, const Part *part, Halo *halo)
{
  const int     d = interface->dimension;
  const int64_t n = part->n_facets[0];
  double       *centres = allocate(d * n, sizeof(*centres)), *ones = allocate(n, sizeof(*ones));
  int32_t      *box     = allocate(n, sizeof(*box));
  *halo     = (Halo){0};
  halo->box = allocate(n, sizeof(*halo->box));
  for (int64_t f = 0; f < n; f++) {
    const int64_t first = part->offsets[0][f], m = part->offsets[0][f + 1] - first;
    ones[f] = 1;
    for (int64_t k = first; k < first + m; k++)
      for (int i = 0; i < d; i++) {
        const int64_t node = part->nodes[0][part->facet_nodes[0][k]];
        centres[d * f + i] += interface->whole[0].X[d * node + i] / (double)m;
      }
  }
  bisect(n, d, centres, ones, BOXES, box);
  for (int64_t f = 0; f < n; f++) halo->box[f] = box[f];
  halo->x_t_n = allocate(d * part->n_nodes[0], sizeof(*halo->x_t_n));
  free(box);
  free(ones);
  free(centres);
}

/* Collective. There is a new t_n. */
void halo_settle(const stickslip_mpi_interface *interface, const Part *part, const State *t_n, Halo *halo)
{
  exchange_bring(&part->copies[0], interface->dimension * (int64_t)sizeof(double), t_n->x[0], halo->x_t_n);
}

/* Collective. Boxes around the sweeps at a place. */
void halo_add(const stickslip_mpi_interface *interface, Part *part, const State *t_n, const double *const x[SIDES], Halo *halo)
{
  const int d     = interface->dimension;
  Place    *place = &halo->place[halo->n_places];
  double   *here  = allocate(d * part->n_nodes[0], sizeof(*here));
  Bounds    of[N_BOUNDS];
  Sweep     sweep;
  bounds_of_all(interface, halo, t_n, x[1], of);
  exchange_bring(&part->copies[0], d * (int64_t)sizeof(double), x[0], here);
  sweep = sweep_of(interface, part, halo, here, of);
  for (int b = 0; b < BOXES; b++) place->box[b] = box_of_nothing();
  for (int64_t f = 0; f < part->n_facets[0]; f++) {
    const Box swept = sweep_facet(&sweep, f, margin_of(interface));
    if (box_is_nothing(&swept)) continue;
    box_add(&place->box[halo->box[f]], swept.low);
    box_add(&place->box[halo->box[f]], swept.high);
  }
  place->own = copied(x[1], d * interface->whole[1].n_own, sizeof(*place->own));
  halo->n_places++;
  free(here);
}

static int covers(const Sweep *sweep, const Halo *halo, const Place *place, const Bounds *since, double spare)
{
  for (int64_t f = 0; f < sweep->part->n_facets[0]; f++) {
    const Box *box   = &place->box[halo->box[f]];
    const Box  swept = sweep_facet(sweep, f, spare);
    if (box_is_nothing(&swept)) continue;
    for (int i = 0; i < 3; i++)
      if (!(swept.low[i] - since->high[i] >= box->low[i] && swept.high[i] + since->minus_low[i] <= box->high[i])) return 0;
  }
  return 1;
}

/* Collective. Does every part have all that it may need at the last update, with `spare` of its margin left? */
int halo_covers(stickslip_mpi_interface *interface, double spare)
{
  const Halo *halo = &interface->halo;
  Bounds      of[N_BOUNDS];
  Sweep       sweep;
  int         enough = !interface->part.handle;
  if (halo->whole || is_frozen(interface)) return 1;
  bounds_of_all(interface, halo, &interface->t_n, interface->x[1], of);
  sweep = sweep_of(interface, &interface->part, halo, interface->part.x[0], of);
  for (int p = 0; p < halo->n_places && !enough; p++)
    enough = covers(&sweep, halo, &halo->place[p], &of[SINCE_PLACE + p], spare * margin_of(interface));
  MPI_Allreduce(MPI_IN_PLACE, &enough, 1, MPI_INT, MPI_LAND, interface->comm);
  return enough;
}

void halo_destroy(Halo *halo)
{
  for (int p = 0; p < halo->n_places; p++) free(halo->place[p].own);
  free(halo->box);
  free(halo->x_t_n);
  *halo = (Halo){0};
}
