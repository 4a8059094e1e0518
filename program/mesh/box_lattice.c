/* Nodes and cells of a structured box, by number, so that any rank can make any of them.
 *
 * Nodes lie on a lattice with `order` steps a cell: 1, or 2 where edges have nodes in their middle. They are numbered along x,
 * then y, then z. A lattice point that no cell uses (of hex20 and quad8: the middles of faces and cells) is no vertex. */
#include "mesh/mesh.h"

/* each corner as its steps along the three axes */
static const int TRIANGLES[2][3][3] = {
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}},
    {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}
};

/* six tetrahedra: one per path from corner (0,0,0) to (1,1,1) along the three axes */
static void split_hexahedron(int tets[6][4][3])
{
  static const int paths[6][3] = {
      {0, 1, 2},
      {1, 2, 0},
      {2, 0, 1},
      {0, 2, 1},
      {2, 1, 0},
      {1, 0, 2}
  };
  for (int p = 0; p < 6; p++) {
    int at[3] = {0, 0, 0};
    for (int k = 0; k < 4; k++) {
      const int node = p >= 3 && (k == 1 || k == 2) ? 3 - k : k; /* odd permutations are left-handed */
      for (int i = 0; i < 3; i++)
        tets[p][node][i] = at[i];
      if (k < 3) at[paths[p][k]] = 1;
    }
  }
}

/* Are all points of the lattice vertices? */
static PetscBool is_full(const Box *box)
{
  return (PetscBool)(box->kind != HEX20 && box->kind != QUAD8);
}

/* Vertices along x, where j and k have so many odd numbers: between nodes only those on edges are there. */
static PetscInt row_length(const Box *box, PetscInt n_odd)
{
  if (is_full(box) || n_odd == 0) return box->layers[0];
  return n_odd == 1 ? (box->layers[0] + 1) / 2 : 0;
}

/* in the first n rows of a layer with k odd or not */
static PetscInt rows_length(const Box *box, PetscInt n, PetscInt k_odd)
{
  return (n + 1) / 2 * row_length(box, k_odd) + n / 2 * row_length(box, 1 + k_odd);
}

/* in the first n layers */
static PetscInt layers_length(const Box *box, PetscInt n)
{
  return (n + 1) / 2 * rows_length(box, box->layers[1], 0) + n / 2 * rows_length(box, box->layers[1], 1);
}

PetscInt box_vertices(const Box *box)
{
  return layers_length(box, box->layers[2]);
}

static PetscInt number_of(const Box *box, const PetscInt at[3])
{
  const PetscInt k_odd = at[2] % 2, n_odd = at[1] % 2 + k_odd;
  return layers_length(box, at[2]) + rows_length(box, at[1], k_odd) + (is_full(box) || n_odd == 0 ? at[0] : at[0] / 2);
}

void box_point(const Box *box, PetscInt number, PetscInt at[3])
{
  PetscInt low[2] = {0, 0}, high[2] = {box->layers[2], box->layers[1]};
  while (high[0] - low[0] > 1) { /* the last layer that begins at or before it, then the last row */
    const PetscInt middle = (low[0] + high[0]) / 2;
    if (layers_length(box, middle) <= number)
      low[0] = middle;
    else
      high[0] = middle;
  }
  number -= layers_length(box, low[0]);
  while (high[1] - low[1] > 1) {
    const PetscInt middle = (low[1] + high[1]) / 2;
    if (rows_length(box, middle, low[0] % 2) <= number)
      low[1] = middle;
    else
      high[1] = middle;
  }
  number -= rows_length(box, low[1], low[0] % 2);
  at[2] = low[0];
  at[1] = low[1];
  at[0] = is_full(box) || at[1] % 2 + at[2] % 2 == 0 ? number : 2 * number;
}

/* A node: the mean of corners, which are given by their steps from the cell's first one. */
static PetscInt node_number(const Box *box, const PetscInt cell[3], PetscInt n, const int *const corners[])
{
  PetscInt at[3];
  for (int i = 0; i < 3; i++) {
    PetscInt steps = 0;
    for (PetscInt c = 0; c < n; c++)
      steps += corners[c][i];
    at[i] = (box->order * cell[i] + box->order * steps / n) % box->layers[i];
  }
  return number_of(box, at);
}

PetscInt box_pieces(const Box *box)
{
  return !cell_is_simplex(box->kind) ? 1 : cell_dimension(box->kind) == 2 ? 2 : 6;
}

void box_cells(const Box *box, PetscInt first, PetscInt end, PetscInt cells[])
{
  static const int hex[8][3] = {
      {0, 0, 0},
      {1, 0, 0},
      {1, 1, 0},
      {0, 1, 0},
      {0, 0, 1},
      {1, 0, 1},
      {1, 1, 1},
      {0, 1, 1}
  };
  const PetscInt  nodes = cell_nodes(box->kind), pieces = box_pieces(box);
  const PetscBool plane = (PetscBool)(cell_dimension(box->kind) == 2);
  int             tets[6][4][3];
  split_hexahedron(tets);
  for (PetscInt h = first; h < end; h++) {
    const PetscInt place[3] = {h % box->n[0], (h / box->n[0]) % box->n[1], h / (box->n[0] * box->n[1])};
    for (PetscInt p = 0; p < pieces; p++) {
      for (PetscInt a = 0; a < nodes; a++) {
        PetscInt       its[CELL_CORNERS];
        const PetscInt count = cell_node_corners(box->kind, a, its);
        const int     *corners[CELL_CORNERS];
        for (PetscInt c = 0; c < count; c++)
          corners[c] = pieces == 1 ? hex[its[c]] : plane ? TRIANGLES[p][its[c]] : tets[p][its[c]];
        *cells++ = node_number(box, place, count, corners);
      }
    }
  }
}
