/* A structured box of hexahedra, or of six tetrahedra per hexahedron (Kuhn's split, conforming by construction). Its sides
 * are the surfaces xmin, xmax, ymin, ymax, zmin, zmax. box_shape.c bends it. */
#include "mesh/mesh.h"

/* Positions along the axes: explicit planes, or equal cells between lower and upper, or fractions of [0,1] for corners. */
static PetscErrorCode read_planes(Scene *scene, const char *body, PetscBool unit, PetscInt n[3], PetscReal *planes[3])
{
  static const char *const axis_name[] = {"x", "y", "z"};
  PetscReal                lower[3] = {0, 0, 0}, upper[3] = {1, 1, 1};
  PetscInt                 cells[3] = {0, 0, 0}, n_explicit = 0, n_given;
  PetscBool                counted;

  PetscFunctionBegin;
  counted = scene_counts(scene, body, "cells", 3, cells);
  for (int axis = 0; axis < 3; axis++) {
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
  if (n_explicit < 3) {
    if (!counted) scene_fail(scene, body, "cells", "this key is missing.");
    if (!unit) {
      if (!scene_vector(scene, body, "lower", 3, lower)) scene_fail(scene, body, "lower", "this key is missing.");
      if (!scene_vector(scene, body, "upper", 3, upper)) scene_fail(scene, body, "upper", "this key is missing.");
    }
  }
  for (int axis = 0; axis < 3; axis++) {
    if (planes[axis]) continue;
    n[axis] = cells[axis];
    if (n[axis] < 1) scene_fail(scene, body, "cells", "at least one cell per axis is needed.");
    if (upper[axis] <= lower[axis])
      scene_fail(scene, body, "upper", "it must lie above `lower` in %s.", axis_name[axis]);
    PetscCall(PetscMalloc1(n[axis] + 1, &planes[axis]));
    for (PetscInt k = 0; k <= n[axis]; k++)
      planes[axis][k] = (lower[axis] * (n[axis] - k) + upper[axis] * k) / n[axis];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* six tetrahedra: one per path from corner (0,0,0) to (1,1,1) along the three axes */
static PetscInt split_hexahedron(const PetscInt corner[2][2][2], PetscInt tets[24])
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
      tets[4 * p + k] = corner[at[2]][at[1]][at[0]];
      if (k < 3) at[paths[p][k]] = 1;
    }
    if (p >= 3) { /* odd permutations are left-handed */
      const PetscInt swap = tets[4 * p + 1];
      tets[4 * p + 1]     = tets[4 * p + 2];
      tets[4 * p + 2]     = swap;
    }
  }
  return 6;
}

/* the faces of the box's cells that lie in one of its six sides */
static PetscErrorCode add_side(Mesh *mesh, const char *body, const PetscInt n[3], const PetscInt layers[3], int side)
{
  static const char *const sides[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  const PetscInt axis = side / 2, level = side % 2 ? n[axis] : 0, stride[3] = {1, layers[0], layers[0] * layers[1]};
  const PetscInt first = mesh->n_vertices - stride[2] * layers[2]; /* the box was appended last */
  char           name[2 * NAME_LENGTH];
  Surface       *surface;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s.%s", body, sides[side]));
  PetscCall(mesh_add_surface(mesh, name, 2 * n[(axis + 1) % 3] * n[(axis + 2) % 3],
                             &surface)); /* two triangles per quadrilateral */
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt corners = mesh->cell_offsets[c + 1] - mesh->cell_offsets[c];
    if (mesh->cell_body[c] != mesh->n_bodies) continue;
    for (PetscInt f = 0; f < (corners == 8 ? 6 : 4); f++) {
      PetscInt       vertices[4], on_side = 0;
      const PetscInt n_face = cell_face(corners, f, mesh->cell_vertices + mesh->cell_offsets[c], vertices);
      for (PetscInt k = 0; k < n_face; k++)
        on_side += ((vertices[k] - first) / stride[axis]) % layers[axis] == level;
      if (on_side == n_face) surface_push(surface, n_face, vertices);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode box_create(Scene *scene, const char *body, Mesh *mesh)
{
  static const char *const kinds[] = {"hex", "tet", NULL};
  PetscReal                corners[24], *planes[3], *coordinates;
  PetscInt                 kind = 0, n[3] = {0, 0, 0}, layers[3], n_vertices, n_hexes, *cells, count = 0;
  const PetscBool          mapped = scene_vector(scene, body, "corners", 24, corners);
  BoxShape                 shape;

  PetscFunctionBegin;
  scene_choice(scene, body, "cell", kinds, &kind);
  PetscCall(read_planes(scene, body, mapped, n, planes));
  box_shape_read(scene, body, n, planes, &shape);
  for (int axis = 0; axis < 3; axis++) /* of vertices; those of a full circle meet where they began */
    layers[axis] = n[axis] + !(axis == 1 && shape.closed);
  n_vertices = layers[0] * layers[1] * layers[2];
  n_hexes    = n[0] * n[1] * n[2];
  PetscCall(PetscMalloc2(3 * n_vertices, &coordinates, 24 * n_hexes, &cells));
  for (PetscInt v = 0; v < n_vertices; v++) {
    const PetscReal x[3] = {planes[0][v % layers[0]], planes[1][(v / layers[0]) % layers[1]],
                            planes[2][v / (layers[0] * layers[1])]};
    for (int i = 0; i < 3; i++) {
      coordinates[3 * v + i] = mapped ? 0 : x[i];
      for (int a = 0; a < 8 && mapped; a++) { /* trilinear map of the eight corners, in VTK's order */
        const PetscReal sx = (a % 4 == 1 || a % 4 == 2) ? x[0] : 1 - x[0], sy = (a % 4 >= 2) ? x[1] : 1 - x[1],
                        sz = a >= 4 ? x[2] : 1 - x[2];
        coordinates[3 * v + i] += sx * sy * sz * corners[3 * a + i];
      }
    }
    box_shape_bend(&shape, coordinates + 3 * v);
  }
  for (PetscInt h = 0; h < n_hexes; h++) {
    const PetscInt i = h % n[0], j = (h / n[0]) % n[1], k = h / (n[0] * n[1]);
    PetscInt       corner[2][2][2];
    for (int a = 0; a < 8; a++)
      corner[a / 4][(a / 2) % 2][a % 2] =
          ((k + a / 4) * layers[1] + (j + (a / 2) % 2) % layers[1]) * layers[0] + i + a % 2;
    if (kind == 1) {
      count += split_hexahedron((const PetscInt(*)[2][2])corner, cells + 4 * count);
    } else {
      for (int a = 0; a < 8; a++)
        cells[8 * count + a] = corner[a / 4][(a / 2) % 2][(a + (a / 2) % 2) % 2]; /* VTK turns around the quad */
      count++;
    }
  }
  PetscCall(mesh_append(mesh, n_vertices, coordinates, count, kind == 1 ? 4 : 8, cells));
  for (int side = 0; side < 6; side++) {
    if (side / 2 == 1 && shape.closed) continue; /* a full circle has no ends */
    PetscCall(add_side(mesh, body, n, layers, side));
  }
  for (int axis = 0; axis < 3; axis++)
    PetscCall(PetscFree(planes[axis]));
  PetscCall(PetscFree2(coordinates, cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}
