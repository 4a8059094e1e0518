/* Parts, cut out of the whole surfaces (docs/host_parallel.md, "Parts that own nodes"): the facets around the nodes that a rank works on,
 * those around these, and so on: rings. How many the library needs depends on what it does. */
#include "internal.h"
#include <stdlib.h>
#include <string.h>

/* The library's three, and one for bodies that start in each other by less than a facet. */
enum { RINGS = 4 };
/* The same where nodes carry others: all of them are integrated. */
enum { RINGS_OF_CARRIERS = 12 };
/* Around the mortar facets that come near. */
enum { RINGS_OF_MORTAR = 2 };

/* What is taken of a side. */
typedef struct {
  char *nodes, *facets;
} Marks;

static int carries(const stickslip_method *method)
{
  return method->weak_coverage > 0 || (method->weak_coverage == 0 && method->multiplier_basis != STICKSLIP_BASIS_STANDARD);
}

static void add_ring(const Whole *whole, Marks *marks)
{
  for (int64_t f = 0; f < whole->n_facets; f++)
    for (int64_t k = whole->offsets[f]; k < whole->offsets[f + 1] && !marks->facets[f]; k++)
      marks->facets[f] = marks->nodes[whole->nodes[k]];
  for (int64_t f = 0; f < whole->n_facets; f++)
    for (int64_t k = whole->offsets[f]; k < whole->offsets[f + 1] && marks->facets[f]; k++) marks->nodes[whole->nodes[k]] = 1;
}

static int32_t *marked(int64_t n, const char marks[], int64_t *count)
{
  int32_t *found;
  *count = 0;
  for (int64_t k = 0; k < n; k++) *count += marks[k] != 0;
  found  = allocate(*count, sizeof(*found));
  *count = 0;
  for (int64_t k = 0; k < n; k++)
    if (marks[k]) found[(*count)++] = (int32_t)k;
  return found;
}

/* The part's numbers, in the order of the whole's. */
static void take(const stickslip_mpi_interface *interface, int side, const Marks *marks, Part *part)
{
  const Whole *whole  = &interface->whole[side];
  const int    d      = interface->dimension;
  int32_t     *number = allocate(whole->n_nodes, sizeof(*number));
  int64_t      n      = 0;
  part->nodes[side]  = marked(whole->n_nodes, marks->nodes, &part->n_nodes[side]);
  part->facets[side] = marked(whole->n_facets, marks->facets, &part->n_facets[side]);
  for (int64_t k = 0; k < part->n_nodes[side]; k++) number[part->nodes[side][k]] = (int32_t)k;
  for (int64_t f = 0; f < part->n_facets[side]; f++) {
    const int32_t of = part->facets[side][f];
    n += whole->offsets[of + 1] - whole->offsets[of];
  }
  part->offsets[side]     = allocate(part->n_facets[side] + 1, sizeof(*part->offsets[side]));
  part->facet_nodes[side] = allocate(n, sizeof(*part->facet_nodes[side]));
  n                       = 0;
  for (int64_t f = 0; f < part->n_facets[side]; f++) {
    const int32_t of = part->facets[side][f];
    for (int64_t k = whole->offsets[of]; k < whole->offsets[of + 1]; k++) part->facet_nodes[side][n++] = number[whole->nodes[k]];
    part->offsets[side][f + 1] = n;
  }
  part->x[side]     = allocate(d * part->n_nodes[side], sizeof(double));
  part->force[side] = allocate(d * part->n_nodes[side], sizeof(double));
  free(number);
}

/* Collective. Who has what the nodes of a list are. */
static void exchange_nodes(const stickslip_mpi_interface *interface, int side, int64_t n, const int32_t nodes[], const int32_t here[],
                           Exchange *exchange)
{
  const Whole *whole  = &interface->whole[side];
  int32_t     *owners = allocate(n, sizeof(*owners)), *places = allocate(n, sizeof(*places));
  for (int64_t k = 0; k < n; k++) {
    owners[k] = whole->owners[nodes[k]];
    places[k] = whole->places[nodes[k]];
  }
  exchange_create(interface->comm, n, owners, places, here, exchange);
  free(places);
  free(owners);
}

/* Collective. By interface->worker. */
void cut_nonmortar(const stickslip_mpi_interface *interface, Part *part)
{
  const Whole *whole = &interface->whole[0];
  const int    rings = (carries(&interface->choices) ? RINGS_OF_CARRIERS : RINGS) + interface->method.further_rings;
  Marks        marks = {allocate(whole->n_nodes, 1), allocate(whole->n_facets, 1)};
  int32_t     *worked;
  for (int64_t k = 0; k < whole->n_nodes; k++) marks.nodes[k] = interface->worker[k] == interface->rank;
  for (int r = 0; r < rings; r++) add_ring(whole, &marks);
  take(interface, 0, &marks, part);
  part->lambda = allocate(interface->components * part->n_nodes[0], sizeof(double));
  part->rows   = allocate(interface->components * part->n_nodes[0], sizeof(double));
  part->works  = allocate(part->n_nodes[0], sizeof(*part->works));
  worked       = allocate(part->n_nodes[0], sizeof(*worked));
  for (int64_t k = 0; k < part->n_nodes[0]; k++) {
    if (interface->worker[part->nodes[0][k]] != interface->rank) continue;
    part->works[part->n_worked]  = (int32_t)k;
    worked[part->n_worked++] = part->nodes[0][k];
  }
  exchange_nodes(interface, 0, part->n_nodes[0], part->nodes[0], NULL, &part->copies[0]);
  exchange_nodes(interface, 0, part->n_worked, worked, part->works, &part->worked);
  free(worked);
  free(marks.facets);
  free(marks.nodes);
}

static int meets(const Box *own, const Box boxes[BOXES])
{
  for (int b = 0; b < BOXES; b++) {
    int near = 1;
    for (int i = 0; i < 3; i++) near = near && own->low[i] <= boxes[b].high[i] && own->high[i] >= boxes[b].low[i];
    if (near) return 1;
  }
  return 0;
}

static void mark_near(const stickslip_mpi_interface *interface, const Box boxes[], const double x[], Marks *marks)
{
  const Whole *whole = &interface->whole[1];
  for (int64_t f = 0; f < whole->n_facets; f++) {
    Box own = box_of_nothing();
    for (int64_t k = whole->offsets[f]; k < whole->offsets[f + 1]; k++) {
      double point[3];
      point_of(interface->dimension, x, whole->nodes[k], point);
      box_add(&own, point);
    }
    if (meets(&own, boxes)) marks->facets[f] = 1;
  }
}

/* Collective. The mortar facets that meet the boxes of any place (BOXES each), mortar nodes being at positions[place] there, and rings
 * around them; without places all. whole, output: every part has all. */
void cut_mortar(const stickslip_mpi_interface *interface, const Box *boxes, int n_places, double *const positions[], Part *part, int *whole)
{
  const Whole *side  = &interface->whole[1];
  Marks        marks = {allocate(side->n_nodes, 1), allocate(side->n_facets, 1)};
  const int    none  = part->n_worked == 0;
  if (!none && (n_places == 0 || side->n_facets == 0)) {
    memset(marks.nodes, 1, (size_t)side->n_nodes);
    memset(marks.facets, 1, (size_t)side->n_facets);
  } else if (!none) {
    for (int p = 0; p < n_places; p++) mark_near(interface, boxes + p * BOXES, positions[p], &marks);
    if (!memchr(marks.facets, 1, (size_t)side->n_facets)) marks.facets[0] = 1; /* a surface has a facet; nothing is near any */
    for (int64_t f = 0; f < side->n_facets; f++)
      for (int64_t k = side->offsets[f]; k < side->offsets[f + 1] && marks.facets[f]; k++) marks.nodes[side->nodes[k]] = 1;
    for (int r = 0; r < RINGS_OF_MORTAR; r++) add_ring(side, &marks);
  }
  take(interface, 1, &marks, part);
  *whole = none || part->n_facets[1] == side->n_facets;
  MPI_Allreduce(MPI_IN_PLACE, whole, 1, MPI_INT, MPI_LAND, interface->comm);
  exchange_nodes(interface, 1, part->n_nodes[1], part->nodes[1], NULL, &part->copies[1]);
  free(marks.facets);
  free(marks.nodes);
}
