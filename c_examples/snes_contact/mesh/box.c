/* A structured box of hexahedra, or of six tetrahedra per hexahedron (Kuhn's split, conforming by construction); in the
 * plane a rectangle of quadrilaterals, or of two triangles each. Its sides are the surfaces xmin, xmax, ymin, ymax, zmin,
 * zmax. box_shape.c bends it.
 *
 * Nodes lie on a lattice with `order` steps a cell: 1, or 2 where edges have nodes in their middle. These are bent as the
 * others are, so that edges follow a curved side. A lattice point that no cell uses (of hex20: the middles of faces and
 * cells) is no vertex. */
#include "mesh/mesh.h"

typedef struct {
  CellKind  kind;
  PetscInt  order;
  PetscInt  n[3];      /* cells, each split where they are simplices; 1 along z in the plane */
  PetscInt  layers[3]; /* of lattice points; those of a full circle meet where they began; 1 along z in the plane */
  PetscInt *vertex;    /* of each lattice point its number, -1: none */
  PetscInt *place;     /* of each vertex its lattice point */
  PetscInt  n_vertices, n_cells, *cells;
} Box;

/* Positions along the axes: explicit planes, or equal cells between lower and upper, or fractions of [0,1] for corners. */
static PetscErrorCode read_planes(Scene *scene, const Space *space, const char *body, PetscBool unit, PetscInt n[3],
                                  PetscReal *planes[3])
{
  static const char *const axis_name[] = {"x", "y", "z"};
  PetscReal                lower[3] = {0, 0, 0}, upper[3] = {1, 1, 1};
  const PetscInt           d        = space_dimension(space);
  PetscInt                 cells[3] = {0, 0, 0}, n_explicit = 0, n_given;
  PetscBool                counted;

  PetscFunctionBegin;
  counted = scene_counts(scene, body, "cells", d, cells);
  for (int axis = 0; axis < d; axis++) {
    planes[axis] = NULL;
    if (unit) continue;
    scene_reals(scene, body, axis_name[axis], &n_given, &planes[axis]);
    if (!planes[axis]) continue;
    n_explicit++;
    n[axis] = n_given - 1;
    if (n_given < 2) scene_fail(scene, body, axis_name[axis], "at least two positions are expected.");
    for (PetscInt k = 1; k < n_given; k++) {
      if (planes[axis][k] <= planes[axis][k - 1])
        scene_fail(scene, body, axis_name[axis], "positions must increase; %g does not.", (double)planes[axis][k]);
    }
    if (counted && cells[axis] != n[axis])
      scene_fail(scene, body, "cells", "axis %s has %d cells by its list of positions, but %d here.", axis_name[axis],
                 (int)n[axis], (int)cells[axis]);
  }
  if (n_explicit < d) {
    if (!counted) scene_fail(scene, body, "cells", "this key is missing.");
    if (!unit) {
      if (!space_vector(scene, space, body, "lower", lower)) scene_fail(scene, body, "lower", "this key is missing.");
      if (!space_vector(scene, space, body, "upper", upper)) scene_fail(scene, body, "upper", "this key is missing.");
    }
  }
  for (int axis = 0; axis < d; axis++) {
    if (planes[axis]) continue;
    n[axis] = cells[axis];
    if (n[axis] < 1) scene_fail(scene, body, "cells", "at least one cell per axis is needed.");
    if (upper[axis] <= lower[axis])
      scene_fail(scene, body, "upper", "it must lie above `lower` in %s.", axis_name[axis]);
    PetscCall(PetscMalloc1(n[axis] + 1, &planes[axis]));
    for (PetscInt k = 0; k <= n[axis]; k++)
      planes[axis][k] = (lower[axis] * (n[axis] - k) + upper[axis] * k) / n[axis];
  }
  if (d == 2) { /* z = 0 */
    n[2] = 1;
    PetscCall(PetscCalloc1(2, &planes[2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

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

/* The lattice point of a node: the mean of corners, which are given by their steps from the cell's first one. */
static PetscInt lattice_point(const Box *box, const PetscInt cell[3], PetscInt n, const int *const corners[])
{
  PetscInt at[3];
  for (int i = 0; i < 3; i++) {
    PetscInt steps = 0;
    for (PetscInt c = 0; c < n; c++)
      steps += corners[c][i];
    at[i] = (box->order * cell[i] + box->order * steps / n) % box->layers[i];
  }
  return (at[2] * box->layers[1] + at[1]) * box->layers[0] + at[0];
}

/* lattice points of all cells */
static PetscErrorCode create_cells(Box *box)
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
  const PetscInt  n_hexes = box->n[0] * box->n[1] * box->n[2], nodes = cell_nodes(box->kind);
  const PetscBool plane = (PetscBool)(cell_dimension(box->kind) == 2), split = cell_is_simplex(box->kind);
  const PetscInt  pieces = !split ? 1 : plane ? 2 : 6;
  int             tets[6][4][3];
  PetscInt       *cell;
  PetscFunctionBegin;
  split_hexahedron(tets);
  box->n_cells = pieces * n_hexes;
  PetscCall(PetscMalloc1(nodes * box->n_cells, &box->cells));
  cell = box->cells;
  for (PetscInt h = 0; h < n_hexes; h++) {
    const PetscInt place[3] = {h % box->n[0], (h / box->n[0]) % box->n[1], h / (box->n[0] * box->n[1])};
    for (PetscInt p = 0; p < pieces; p++) {
      for (PetscInt a = 0; a < nodes; a++) {
        PetscInt       its[CELL_CORNERS];
        const PetscInt count = cell_node_corners(box->kind, a, its);
        const int     *corners[CELL_CORNERS];
        for (PetscInt c = 0; c < count; c++)
          corners[c] = !split ? hex[its[c]] : plane ? TRIANGLES[p][its[c]] : tets[p][its[c]];
        *cell++ = lattice_point(box, place, count, corners);
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Vertices in the order of the lattice; the cells get their numbers. */
static PetscErrorCode number_vertices(Box *box)
{
  const PetscInt size = box->layers[0] * box->layers[1] * box->layers[2], n_entries = cell_nodes(box->kind) * box->n_cells;
  PetscFunctionBegin;
  PetscCall(PetscMalloc2(size, &box->vertex, size, &box->place));
  for (PetscInt p = 0; p < size; p++)
    box->vertex[p] = -1;
  for (PetscInt k = 0; k < n_entries; k++)
    box->vertex[box->cells[k]] = 0;
  box->n_vertices = 0;
  for (PetscInt p = 0; p < size; p++) {
    if (box->vertex[p] < 0) continue;
    box->place[box->n_vertices] = p;
    box->vertex[p]              = box->n_vertices++;
  }
  for (PetscInt k = 0; k < n_entries; k++)
    box->cells[k] = box->vertex[box->cells[k]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* between the planes of nodes, half way */
static PetscReal position(const PetscReal planes[], PetscInt order, PetscInt k)
{
  const PetscInt first = k / order;
  return k % order == 0 ? planes[first] : (planes[first] + planes[first + 1]) / 2;
}

/* trilinear map of the eight corners, in VTK's order; in the plane of four, each with d numbers */
static void map_corners(const PetscReal corners[24], PetscInt d, PetscReal x[3])
{
  const PetscReal s[3] = {x[0], x[1], x[2]};
  for (int i = 0; i < d; i++) {
    x[i] = 0;
    for (int a = 0; a < (d == 3 ? 8 : 4); a++) {
      const PetscReal sx = (a % 4 == 1 || a % 4 == 2) ? s[0] : 1 - s[0], sy = (a % 4 >= 2) ? s[1] : 1 - s[1],
                      sz = a >= 4 ? s[2] : 1 - s[2];
      x[i] += sx * sy * sz * corners[d * a + i];
    }
  }
}

/* the faces of the box's cells that lie in one of its six sides */
static PetscErrorCode add_side(Mesh *mesh, const char *body, const Box *box, int side)
{
  static const char *const sides[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  const PetscInt axis = side / 2, level = side % 2 ? box->order * box->n[axis] : 0;
  const PetscInt stride[3] = {1, box->layers[0], box->layers[0] * box->layers[1]};
  const PetscInt first = mesh->n_vertices - box->n_vertices; /* the box was appended last */
  char           name[2 * NAME_LENGTH];
  Surface       *surface;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s.%s", body, sides[side]));
  PetscCall(mesh_add_surface(mesh, name, 2 * box->n[(axis + 1) % 3] * box->n[(axis + 2) % 3],
                             &surface)); /* two triangles per quadrilateral */
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    if (mesh->cell_body[c] != mesh->n_bodies) continue;
    for (PetscInt f = 0; f < cell_faces(box->kind); f++) {
      PetscInt       vertices[FACE_NODES], on_side = 0;
      const PetscInt n_face = cell_face(box->kind, f, mesh->cell_vertices + mesh->cell_offsets[c], vertices);
      for (PetscInt k = 0; k < n_face; k++)
        on_side += (box->place[vertices[k] - first] / stride[axis]) % box->layers[axis] == level;
      if (on_side == n_face) surface_push(surface, n_face, vertices);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode box_create(Scene *scene, const char *body, Mesh *mesh)
{
  static const char *const names[2][6] = {{"hex", "tet", "tet10", "hex20", "hex27", NULL},
                                          {"quad", "tri", "tri6", "quad8", "quad9", NULL}};
  static const CellKind    kinds[2][5] = {{HEX8, TET4, TET10, HEX20, HEX27}, {QUAD4, TRI3, TRI6, QUAD8, QUAD9}};
  const PetscInt           d = mesh->dimension, plane = d == 2;
  PetscReal                corners[24], *planes[3], *coordinates;
  PetscInt                 kind   = 0;
  const PetscBool          mapped = scene_vector(scene, body, "corners", plane ? 8 : 24, corners);
  BoxShape                 shape;
  Box                      box = {0};

  PetscFunctionBegin;
  scene_choice(scene, body, "cell", names[plane], &kind);
  box.kind  = kinds[plane][kind];
  box.order = cell_nodes(box.kind) > cell_corners(box.kind) ? 2 : 1;
  PetscCall(read_planes(scene, &mesh->space, body, mapped, box.n, planes));
  box_shape_read(scene, &mesh->space, body, box.n, planes, &shape);
  for (int axis = 0; axis < 3; axis++)
    box.layers[axis] = axis < d ? box.order * box.n[axis] + !(axis == 1 && shape.closed) : 1;
  PetscCall(create_cells(&box));
  PetscCall(number_vertices(&box));
  PetscCall(PetscMalloc1(3 * box.n_vertices, &coordinates));
  for (PetscInt v = 0; v < box.n_vertices; v++) {
    const PetscInt p = box.place[v], at[3] = {p % box.layers[0], (p / box.layers[0]) % box.layers[1],
                                              p / (box.layers[0] * box.layers[1])};
    PetscReal     *x = coordinates + 3 * v;
    for (int i = 0; i < 3; i++)
      x[i] = position(planes[i], box.order, at[i]);
    if (mapped) map_corners(corners, d, x);
    box_shape_bend(&shape, x);
  }
  PetscCall(mesh_append(mesh, box.n_vertices, coordinates, box.n_cells, box.kind, box.cells));
  for (int side = 0; side < 2 * d; side++) {
    if (side / 2 == 1 && shape.closed) continue; /* a full circle has no ends */
    PetscCall(add_side(mesh, body, &box, side));
  }
  for (int axis = 0; axis < 3; axis++)
    PetscCall(PetscFree(planes[axis]));
  PetscCall(PetscFree2(box.vertex, box.place));
  PetscCall(PetscFree(box.cells));
  PetscCall(PetscFree(coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}
