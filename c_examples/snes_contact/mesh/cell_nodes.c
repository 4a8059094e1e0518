/* Which nodes cells and faces have, and which corners each of them is the middle of. */
#include "mesh/cell.h"

const PetscReal CELL_HEX[27][3] = {
    {-1, -1, -1}, /* corners */
    {1,  -1, -1},
    {1,  1,  -1},
    {-1, 1,  -1},
    {-1, -1, 1 },
    {1,  -1, 1 },
    {1,  1,  1 },
    {-1, 1,  1 },
    {0,  -1, -1}, /* edges */
    {1,  0,  -1},
    {0,  1,  -1},
    {-1, 0,  -1},
    {0,  -1, 1 },
    {1,  0,  1 },
    {0,  1,  1 },
    {-1, 0,  1 },
    {-1, -1, 0 },
    {1,  -1, 0 },
    {1,  1,  0 },
    {-1, 1,  0 },
    {-1, 0,  0 }, /* faces */
    {1,  0,  0 },
    {0,  -1, 0 },
    {0,  1,  0 },
    {0,  0,  -1},
    {0,  0,  1 },
    {0,  0,  0 }
};
static const PetscInt TET_EDGES[6][2] = {
    {0, 1},
    {1, 2},
    {0, 2},
    {0, 3},
    {1, 3},
    {2, 3}
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

PetscInt cell_corners(PetscInt nodes)
{
  return nodes == 4 || nodes == 10 ? 4 : 8;
}

PetscInt cell_faces(PetscInt nodes)
{
  return cell_corners(nodes) == 8 ? 6 : 4;
}

PetscInt cell_node_corners(PetscInt nodes, PetscInt node, PetscInt corners[8])
{
  PetscInt n = 0;
  if (cell_corners(nodes) == 4) {
    corners[n++] = node < 4 ? node : TET_EDGES[node - 4][0];
    if (node >= 4) corners[n++] = TET_EDGES[node - 4][1];
    return n;
  }
  for (PetscInt c = 0; c < 8; c++) { /* a coordinate that is 0 is the mean of both */
    const PetscReal *p = CELL_HEX[node], *q = CELL_HEX[c];
    if ((p[0] == 0 || p[0] == q[0]) && (p[1] == 0 || p[1] == q[1]) && (p[2] == 0 || p[2] == q[2])) corners[n++] = c;
  }
  return n;
}

void cell_node_position(PetscInt nodes, PetscInt node, PetscReal xi[3])
{
  PetscInt       corners[8];
  const PetscInt n = cell_node_corners(nodes, node, corners);
  for (int k = 0; k < 3; k++) {
    xi[k] = cell_corners(nodes) == 8 ? CELL_HEX[node][k] : 0;
    for (PetscInt c = 0; c < n && cell_corners(nodes) == 4; c++)
      xi[k] += (corners[c] - 1 == k) / (PetscReal)n;
  }
}

/* the node of a cell in the middle of n of its corners */
static PetscInt node_amid(PetscInt nodes, PetscInt n, const PetscInt corners[])
{
  for (PetscInt node = cell_corners(nodes); node < nodes; node++) {
    PetscInt its[8], shared = 0;
    if (cell_node_corners(nodes, node, its) != n) continue;
    for (PetscInt a = 0; a < n; a++) {
      for (PetscInt b = 0; b < n; b++)
        shared += its[a] == corners[b];
    }
    if (shared == n) return node;
  }
  return -1;
}

PetscInt cell_face(PetscInt nodes, PetscInt face, const PetscInt cell[], PetscInt vertices[FACE_NODES])
{
  const PetscInt *corners = cell_corners(nodes) == 8 ? HEX_FACES[face] : TET_FACES[face];
  const PetscInt  n       = cell_corners(nodes) == 8 ? 4 : 3;
  PetscInt        count   = n;
  for (PetscInt k = 0; k < n; k++)
    vertices[k] = cell[corners[k]];
  if (nodes == cell_corners(nodes)) return count;
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt edge[2] = {corners[k], corners[(k + 1) % n]};
    vertices[count++]      = cell[node_amid(nodes, 2, edge)];
  }
  if (nodes == 27) vertices[count++] = cell[node_amid(nodes, 4, corners)];
  return count;
}

PetscInt face_corners(PetscInt nodes)
{
  return nodes == 3 || nodes == 6 ? 3 : 4;
}

PetscInt face_node_corners(PetscInt nodes, PetscInt node, PetscInt corners[4])
{
  const PetscInt all = face_corners(nodes);
  PetscInt       n   = node < all ? 1 : node < 2 * all ? 2 : 4;
  for (PetscInt k = 0; k < n; k++)
    corners[k] = n == 4 ? k : (node + k) % all;
  return n;
}
