/* Which nodes cells and their faces have, and which corners each of them is the middle of. */
#include "mesh/cell.h"

static const struct {
  PetscInt dimension, nodes, corners, faces;
} KINDS[CELL_KINDS] = {
    [LINE2] = {1, 2, 2, 0},  [LINE3] = {1, 3, 2, 0},  [TRI3] = {2, 3, 3, 3},   [TRI6] = {2, 6, 3, 3},
    [QUAD4] = {2, 4, 4, 4},  [QUAD8] = {2, 8, 4, 4},  [QUAD9] = {2, 9, 4, 4},  [TET4] = {3, 4, 4, 4},
    [TET10] = {3, 10, 4, 4}, [HEX8] = {3, 8, 8, 6},   [HEX20] = {3, 20, 8, 6}, [HEX27] = {3, 27, 8, 6},
};

/* corners of a hexahedron [-1,1]^3; its first four are a quadrilateral's, its first two a line's */
static const PetscReal PRODUCT_CORNERS[8][3] = {
    {-1, -1, -1},
    {1,  -1, -1},
    {1,  1,  -1},
    {-1, 1,  -1},
    {-1, -1, 1 },
    {1,  -1, 1 },
    {1,  1,  1 },
    {-1, 1,  1 }
};
/* ends of edges, in the order of the nodes in their middle; the first three are a triangle's, four a quadrilateral's, one
 * a line's */
static const PetscInt SIMPLEX_EDGES[6][2] = {
    {0, 1},
    {1, 2},
    {0, 2},
    {0, 3},
    {1, 3},
    {2, 3}
};
static const PetscInt PRODUCT_EDGES[12][2] = {
    {0, 1},
    {1, 2},
    {2, 3},
    {0, 3},
    {4, 5},
    {5, 6},
    {6, 7},
    {4, 7},
    {0, 4},
    {1, 5},
    {2, 6},
    {3, 7}
};
/* corners of the faces of a hexahedron that a node lies in the middle of */
static const PetscInt HEX_MIDDLES[6][4] = {
    {0, 3, 4, 7},
    {1, 2, 5, 6},
    {0, 1, 4, 5},
    {2, 3, 6, 7},
    {0, 1, 2, 3},
    {4, 5, 6, 7}
};
/* corners of the faces, right-hand normal outward */
static const PetscInt HEX_FACES[6][4] = {
    {0, 3, 2, 1},
    {4, 5, 6, 7},
    {0, 1, 5, 4},
    {1, 2, 6, 5},
    {2, 3, 7, 6},
    {3, 0, 4, 7}
};
static const PetscInt TET_FACES[4][3] = {
    {0, 2, 1},
    {0, 1, 3},
    {1, 2, 3},
    {2, 0, 3}
};

CellKind cell_kind(PetscInt dimension, PetscInt nodes)
{
  int kind = 0;
  while (kind < CELL_KINDS && (KINDS[kind].dimension != dimension || KINDS[kind].nodes != nodes))
    kind++;
  return (CellKind)kind;
}

PetscInt cell_dimension(CellKind kind)
{
  return KINDS[kind].dimension;
}

PetscInt cell_nodes(CellKind kind)
{
  return KINDS[kind].nodes;
}

PetscInt cell_corners(CellKind kind)
{
  return KINDS[kind].corners;
}

PetscInt cell_faces(CellKind kind)
{
  return KINDS[kind].faces;
}

PetscBool cell_is_simplex(CellKind kind)
{
  return (PetscBool)(KINDS[kind].dimension > 1 && KINDS[kind].corners == KINDS[kind].dimension + 1);
}

PetscInt cell_node_corners(CellKind kind, PetscInt node, PetscInt corners[CELL_CORNERS])
{
  static const PetscInt edges[4] = {0, 1, 4, 12}; /* of a product of lines, by dimension */
  const PetscInt        all = KINDS[kind].corners, edge = node - all;
  const PetscInt        face = edge - edges[KINDS[kind].dimension];
  const PetscInt       *its  = NULL;
  PetscInt              n    = 1;
  corners[0] = node;
  if (edge < 0) return n;
  if (cell_is_simplex(kind)) {
    its = SIMPLEX_EDGES[edge], n = 2;
  } else if (face < 0) {
    its = PRODUCT_EDGES[edge], n = 2;
  } else if (KINDS[kind].dimension == 3 && face < 6) {
    its = HEX_MIDDLES[face], n = 4;
  } else {
    n = all; /* of the cell */
  }
  for (PetscInt c = 0; c < n; c++)
    corners[c] = its ? its[c] : c;
  return n;
}

void cell_node_position(CellKind kind, PetscInt node, PetscReal xi[3])
{
  PetscInt       corners[CELL_CORNERS];
  const PetscInt n = cell_node_corners(kind, node, corners);
  for (int k = 0; k < 3; k++) {
    xi[k] = 0;
    for (PetscInt c = 0; c < n && k < KINDS[kind].dimension; c++)
      xi[k] += (cell_is_simplex(kind) ? corners[c] - 1 == k : PRODUCT_CORNERS[corners[c]][k]) / (PetscReal)n;
  }
}

/* the node of a cell in the middle of n of its corners; -1: there is none */
static PetscInt node_amid(CellKind kind, PetscInt n, const PetscInt corners[])
{
  for (PetscInt node = KINDS[kind].corners; node < KINDS[kind].nodes; node++) {
    PetscInt its[CELL_CORNERS], shared = 0;
    if (cell_node_corners(kind, node, its) != n) continue;
    for (PetscInt a = 0; a < n; a++) {
      for (PetscInt b = 0; b < n; b++)
        shared += its[a] == corners[b];
    }
    if (shared == n) return node;
  }
  return -1;
}

PetscInt cell_face(CellKind kind, PetscInt face, const PetscInt cell[], PetscInt vertices[FACE_NODES])
{
  const PetscInt  line[2] = {face, (face + 1) % KINDS[kind].corners};
  const PetscInt *corners = cell_dimension(kind) == 2 ? line : cell_is_simplex(kind) ? TET_FACES[face] : HEX_FACES[face];
  const PetscInt  n       = cell_dimension(kind) == 2 ? 2 : cell_is_simplex(kind) ? 3 : 4;
  PetscInt        count = n, middle;
  for (PetscInt k = 0; k < n; k++)
    vertices[k] = cell[corners[k]];
  for (PetscInt k = 0; k < (n == 2 ? 1 : n) && KINDS[kind].nodes > KINDS[kind].corners; k++) {
    const PetscInt edge[2] = {corners[k], corners[(k + 1) % n]};
    vertices[count++]      = cell[node_amid(kind, 2, edge)];
  }
  middle = n == 4 ? node_amid(kind, 4, corners) : -1;
  if (middle >= 0) vertices[count++] = cell[middle];
  return count;
}
