/* A structured box of hexahedra, or of six tetrahedra per hexahedron (Kuhn's split, conforming by construction); in the
 * plane a rectangle of quadrilaterals, or of two triangles each. Its sides are the surfaces xmin, xmax, ymin, ymax, zmin,
 * zmax. box_shape.c bends it: nodes in the middle of edges as the others, so that edges follow a curved side. Each rank makes a
 * range of the cells, in their order; box_lattice.c numbers them and their nodes. */
#include "mesh/mesh.h"

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

/* How many faces the ranks before this one have. */
static PetscErrorCode first_face(PetscInt n, PetscInt *first)
{
  PetscMPIInt rank;
  PetscFunctionBegin;
  *first = 0;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Exscan(&n, first, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  if (rank == 0) *first = 0; /* of which MPI says nothing */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the faces of the last n cells that lie in one of the box's six sides */
static PetscErrorCode add_side(Mesh *mesh, const char *body, const Box *box, int side, PetscInt n_cells)
{
  static const char *const sides[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  const PetscInt axis = side / 2, level = side % 2 ? box->order * box->n[axis] : 0;
  char           name[2 * NAME_LENGTH];
  PetscInt       first;
  Surface       *surface;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s.%s", body, sides[side]));
  PetscCall(mesh_add_surface(mesh, name, PetscMin(n_cells, 2 * box->n[(axis + 1) % 3] * box->n[(axis + 2) % 3]),
                             &surface)); /* two triangles per quadrilateral */
  for (PetscInt c = mesh->n_cells - n_cells; c < mesh->n_cells; c++) {
    for (PetscInt f = 0; f < cell_faces(box->kind); f++) {
      PetscInt       vertices[FACE_NODES], on_side = 0, at[3];
      const PetscInt n_face = cell_face(box->kind, f, mesh->cell_vertices + mesh->cell_offsets[c], vertices);
      for (PetscInt k = 0; k < n_face; k++) {
        box_point(box, mesh->numbers[vertices[k]] - mesh->n_all_vertices, at);
        on_side += at[axis] == level;
      }
      if (on_side == n_face) surface_push(surface, n_face, vertices);
    }
  }
  PetscCall(first_face(surface->n_faces, &first));
  PetscCall(PetscMalloc1(surface->n_faces, &surface->numbers));
  for (PetscInt f = 0; f < surface->n_faces; f++)
    surface->numbers[f] = first + f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's cells, and their vertices; `number`: in the box. */
static PetscErrorCode append_piece(Mesh *mesh, const Box *box, const BoxShape *shape, const PetscReal *corners,
                                   PetscReal *const planes[3], PetscInt *n_cells)
{
  const PetscInt n_hexes = box->n[0] * box->n[1] * box->n[2], nodes = cell_nodes(box->kind);
  const PetscInt first = (PetscInt)((PetscInt64)n_hexes * mesh->rank / mesh->size),
                 end   = (PetscInt)((PetscInt64)n_hexes * (mesh->rank + 1) / mesh->size);
  PetscInt   n_vertices, *cells, *cell_numbers, *numbers;
  PetscReal *coordinates;

  PetscFunctionBegin;
  *n_cells   = box_pieces(box) * (end - first);
  n_vertices = nodes * *n_cells;
  PetscCall(PetscMalloc3(n_vertices, &cells, n_vertices, &numbers, *n_cells, &cell_numbers));
  box_cells(box, first, end, cells);
  PetscCall(PetscArraycpy(numbers, cells, n_vertices));
  PetscCall(PetscSortRemoveDupsInt(&n_vertices, numbers));
  for (PetscInt k = 0; k < nodes * *n_cells; k++)
    PetscCall(PetscFindInt(cells[k], n_vertices, numbers, &cells[k]));
  for (PetscInt c = 0; c < *n_cells; c++)
    cell_numbers[c] = box_pieces(box) * first + c;
  PetscCall(PetscMalloc1(3 * n_vertices, &coordinates));
  for (PetscInt v = 0; v < n_vertices; v++) {
    PetscReal *x = coordinates + 3 * v;
    PetscInt   at[3];
    box_point(box, numbers[v], at);
    for (int i = 0; i < 3; i++)
      x[i] = position(planes[i], box->order, at[i]);
    if (corners) map_corners(corners, mesh->dimension, x);
    box_shape_bend(shape, x);
  }
  PetscCall(mesh_append(mesh, n_vertices, numbers, coordinates, *n_cells, cell_numbers, box->kind, cells));
  PetscCall(PetscFree3(cells, numbers, cell_numbers));
  PetscCall(PetscFree(coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode box_create(Scene *scene, const char *body, Mesh *mesh)
{
  static const char *const names[2][6] = {{"hex", "tet", "tet10", "hex20", "hex27", NULL},
                                          {"quad", "tri", "tri6", "quad8", "quad9", NULL}};
  static const CellKind    kinds[2][5] = {{HEX8, TET4, TET10, HEX20, HEX27}, {QUAD4, TRI3, TRI6, QUAD8, QUAD9}};
  const PetscInt           d = mesh->dimension, plane = d == 2;
  PetscReal                corners[24], *planes[3];
  PetscInt                 kind   = 0, n_cells;
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
  PetscCall(append_piece(mesh, &box, &shape, mapped ? corners : NULL, planes, &n_cells));
  for (int side = 0; side < 2 * d; side++) {
    if (side / 2 == 1 && shape.closed) continue; /* a full circle has no ends */
    PetscCall(add_side(mesh, body, &box, side, n_cells));
  }
  mesh->n_all_vertices += box_vertices(&box);
  mesh->n_all_cells += box_pieces(&box) * box.n[0] * box.n[1] * box.n[2];
  for (int axis = 0; axis < 3; axis++)
    PetscCall(PetscFree(planes[axis]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
