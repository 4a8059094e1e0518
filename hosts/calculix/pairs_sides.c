/* Surfaces of pairs, and the unknowns of their nodes (pairs_pair.h). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "pairs_pair.h"

static ITG values_per_node;
static PairsNumbers now;

void pairs_stop(const char *what, const char *why) {
  printf("*ERROR in stickslip: %s: %s\n", what, why);
  FORTRAN(stop, ());
}

void pairs_must(const char *what, int32_t status) {
  if (status != STICKSLIP_OK) pairs_stop(what, stickslip_last_error_message());
}

void *pairs_zeros(size_t count, size_t size) {
  void *out = calloc(count ? count : 1, size);
  if (!out) pairs_stop("memory", "there is none left");
  return out;
}

/* CalculiX' faces have the library's order: corners in right-hand order seen from outside, then mid nodes. */
static const ITG HEX[6][8] = {{4, 3, 2, 1, 11, 10, 9, 12}, {5, 6, 7, 8, 13, 14, 15, 16}, {1, 2, 6, 5, 9, 18, 13, 17},
                              {2, 3, 7, 6, 10, 19, 14, 18}, {3, 4, 8, 7, 11, 20, 15, 19}, {4, 1, 5, 8, 12, 17, 16, 20}};
static const ITG TET[4][6] = {{1, 3, 2, 7, 6, 5}, {1, 2, 4, 5, 9, 8}, {2, 3, 4, 6, 10, 9}, {1, 4, 3, 8, 10, 7}};
static const ITG WEDGE[5][8] = {{1, 3, 2, 9, 8, 7}, {4, 5, 6, 10, 11, 12}, {1, 2, 5, 4, 7, 14, 10, 13},
                                {2, 3, 6, 5, 8, 15, 11, 14}, {3, 1, 4, 6, 9, 13, 12, 15}};

/* Nodes of a face, of which the first `corners` are corners. */
static ITG face_nodes(const PairsModel *m, ITG element, ITG face, ITG *nodes, ITG *corners) {
  const char *kind = m->lakon + 8 * element;
  const ITG *local = NULL, *all = m->kon + m->ipkon[element], linear = kind[3] == '8' || kind[3] == '6' || kind[3] == '4';
  /* Sections that CalculiX turns into bricks of one element's thickness would have two multipliers for one displacement. */
  if (strchr("AES", kind[6]) && kind[6] != ' ' && kind[6] != '\0') pairs_stop("surface", "plane and axisymmetric elements have no pairs");
  *corners = 4;
  if (kind[3] == '8' || kind[3] == '2') local = HEX[face];
  else if (kind[3] == '4' || !strncmp(kind + 3, "10", 2)) local = TET[face], *corners = 3;
  else if (kind[3] == '6' || !strncmp(kind + 3, "15", 2)) local = WEDGE[face], *corners = face < 2 ? 3 : 4;
  else pairs_stop("surface", "faces of C3D4, C3D6, C3D8, C3D10, C3D15 and C3D20 alone are known");
  ITG n = linear ? *corners : 2 * *corners;
  for (ITG k = 0; k < n; k++) nodes[k] = all[local[k] - 1];
  return n;
}

void pairs_read_side(const PairsModel *m, const char *label, Side *side) {
  ITG set = 0;
  while (set < m->nset && strncmp(m->set + 81 * set, label, 81)) set++;
  if (set == m->nset) pairs_stop("a surface of *CONTACT PAIR, TYPE=STICKSLIP that no *SURFACE, TYPE=ELEMENT defines", label);
  const ITG first = m->istartset[set] - 1, last = m->iendset[set], most = last - first;
  ITG nodes[FACE_NODES], corners, highest = 0;
  side->offsets = pairs_zeros(most + 1, sizeof *side->offsets), side->facets = pairs_zeros(FACE_NODES * most, sizeof *side->facets);
  side->nodes = pairs_zeros(FACE_NODES * most, sizeof *side->nodes), side->corner = pairs_zeros(FACE_NODES * most, 1);
  for (ITG i = first; i < last; i++) {
    const ITG n = face_nodes(m, m->ialset[i] / 10 - 1, m->ialset[i] % 10 - 1, nodes, &corners);
    for (ITG k = 0; k < n; k++)
      if (nodes[k] > highest) highest = nodes[k];
  }
  ITG *number = pairs_zeros(highest + 1, sizeof *number); /* from 1 */
  for (ITG i = first; i < last; i++) {
    const ITG n = face_nodes(m, m->ialset[i] / 10 - 1, m->ialset[i] % 10 - 1, nodes, &corners);
    int64_t *facet = side->facets + side->offsets[side->n_facets];
    for (ITG k = 0; k < n; k++) {
      if (!number[nodes[k]]) side->nodes[side->n_nodes] = nodes[k], number[nodes[k]] = ++side->n_nodes;
      facet[k] = number[nodes[k]] - 1;
      if (k < corners) side->corner[facet[k]] = 1;
    }
    side->n_facets++, side->offsets[side->n_facets] = side->offsets[side->n_facets - 1] + n;
  }
  free(number);
  const size_t values = DIM * side->n_nodes;
  side->reference = pairs_zeros(values, sizeof(double)), side->x = pairs_zeros(values, sizeof(double));
  side->force = pairs_zeros(values, sizeof(double)), side->equations = pairs_zeros(values, sizeof *side->equations);
  for (size_t k = 0; k < values; k++) side->x[k] = side->reference[k] = m->co[DIM * (side->nodes[k / DIM] - 1) + k % DIM];
}

void pairs_number(PairsNumbers numbers, ITG per_node) { now = numbers, values_per_node = per_node; }

void pairs_positions(Side *side, const double *v) {
  for (ITG k = 0; k < DIM * side->n_nodes; k++)
    side->x[k] = side->reference[k] + v[values_per_node * (side->nodes[k / DIM] - 1) + k % DIM + 1];
}

ITG pairs_terms(ITG node, ITG direction, ITG *unknown, double *factor) {
  const ITG own = now.nactdof[values_per_node * (node - 1) + direction];
  ITG n = 0;
  if (own > 0) {
    unknown[0] = own - 1, factor[0] = 1;
    return 1;
  }
  if (own == 0 || own % 2 == 0) return 0; /* prescribed */
  ITG index = now.ipompc[(-own - 1) / 2] - 1;
  const double dependent = now.coefmpc[index];
  for (index = now.nodempc[3 * index + 2]; index != 0; index = now.nodempc[3 * (index - 1) + 2]) {
    const ITG *term = now.nodempc + 3 * (index - 1);
    const ITG active = now.nactdof[values_per_node * (term[0] - 1) + term[1]];
    if (active <= 0) continue;
    if (n == PAIRS_MOST_TERMS) pairs_stop("a multiple point constraint of a contact node", "it has too many terms");
    unknown[n] = active - 1, factor[n++] = -now.coefmpc[index - 1] / dependent;
  }
  return n;
}
