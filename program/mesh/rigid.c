/* A rigid body: surfaces without cells, which move with a reference point.
 *
 * Its first vertex is the reference point, whose displacement is the body's; the second one is at the same place, and what stands
 * for its displacement is the body's rotation (physics/rigid.c). Then come the vertices of its surfaces. Cells without stiffness,
 * each of the first two vertices and two others, make one piece of it in the DMPlex: where a vertex is, there are the first two. */
#include "mesh/mesh.h"

/* Nodes are placed from the reference point, and rounded by its distance. So many sizes of the body away it costs three digits of
 * positions; at ten times as many Newton's method stalls above its tolerance. */
static const PetscReal FAR = 1e3;

/* By map.from: where its surfaces come from. */
enum { FROM_BOX, FROM_GMSH, FROM_STL, FROM_ANALYTIC };
static const char *const FROM[] = {"box", "gmsh", "stl", "analytic", NULL};

static PetscInt read_from(Scene *scene, const char *body)
{
  PetscInt from = FROM_BOX;
  if (!scene_has(scene, body, "from"))
    scene_fail(scene, body, "from", "this key is missing, where its surface comes from; choose from: box, gmsh, stl, analytic.");
  scene_choice(scene, body, "from", FROM, &from);
  return from;
}

PetscBool rigid_is_analytic(Scene *scene, const char *body)
{
  return (PetscBool)(read_from(scene, body) == FROM_ANALYTIC);
}

/* of the shell's vertices, those of its surfaces, from 0; -1: those inside */
static PetscInt number_vertices(const Mesh *shell, PetscInt number[])
{
  PetscInt n = 0;
  for (PetscInt v = 0; v < shell->n_vertices; v++)
    number[v] = -1;
  for (PetscInt s = 0; s < shell->n_surfaces; s++) {
    const Surface *surface = &shell->surfaces[s];
    for (PetscInt k = 0; k <= shell->dimension && surface->analytic; k++)
      number[surface->frame + k] = 0;
    for (PetscInt k = 0; k < surface->offsets[surface->n_faces] && !surface->inner; k++)
      number[surface->vertices[k]] = 0;
  }
  for (PetscInt v = 0; v < shell->n_vertices; v++)
    number[v] = number[v] < 0 ? -1 : n++;
  return n;
}

/* rank 0: is the reference point near enough to the n vertices? A surface in closed form has none but its frame. */
static void check_reference(Scene *scene, const char *body, const PetscReal point[3], const Mesh *shell, const PetscInt number[])
{
  Extent    extent = extent_of_nothing();
  PetscReal size, distance = 0;
  for (PetscInt s = 0; s < shell->n_surfaces; s++) {
    if (shell->surfaces[s].analytic) return;
  }
  for (PetscInt v = 0; v < shell->n_vertices; v++) {
    if (number[v] >= 0) extent_add(&extent, shell->coordinates + 3 * v);
  }
  size = PetscSqrtReal(extent_diagonal_squared(&extent));
  for (int i = 0; i < 3; i++) /* the largest component: a square may overflow */
    distance = PetscMax(distance, PetscMax(point[i] - extent.high[i], extent.low[i] - point[i]));
  if (distance > FAR * size)
    scene_fail(scene, body, "reference", "it lies %.3g times the body's size away from it; at most %g are allowed, for rounding.",
               (double)(distance / size), (double)FAR);
}

/* The first two vertices and n others, in cells. */
static PetscErrorCode append_vertices(Mesh *mesh, const PetscReal point[3], const Mesh *shell, const PetscInt number[], PetscInt n)
{
  const PetscInt n_cells = (n + 1) / 2;
  PetscReal     *coordinates;
  PetscInt      *cells;
  PetscFunctionBegin;
  PetscCall(PetscMalloc2(3 * (n + 2), &coordinates, 4 * n_cells, &cells));
  for (int k = 0; k < 6; k++)
    coordinates[k] = point[k % 3];
  for (PetscInt v = 0; v < shell->n_vertices; v++) {
    if (number[v] >= 0) PetscCall(PetscArraycpy(coordinates + 3 * (2 + number[v]), shell->coordinates + 3 * v, 3));
  }
  for (PetscInt c = 0; c < n_cells; c++) {
    PetscInt      *cell = cells + 4 * c;
    const PetscInt one = 2 + 2 * c, two = 2 + (2 * c + 1) % n; /* of an odd number the last one with the first */
    cell[0] = 0;
    cell[1] = mesh->dimension == 3 ? 1 : one; /* of a quadrilateral corners that are opposite */
    cell[2] = mesh->dimension == 3 ? one : 1;
    cell[3] = two;
  }
  PetscCall(mesh_append(mesh, n + 2, NULL, coordinates, n_cells, NULL, mesh->dimension == 3 ? TET4 : QUAD4, cells));
  PetscCall(PetscFree2(coordinates, cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `first`: the first of the body's vertices in the piece; `frame`: its number */
static PetscErrorCode append_surfaces(Mesh *mesh, const Mesh *shell, const PetscInt number[], PetscInt first, PetscInt frame)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < shell->n_surfaces; s++) {
    const Surface *from = &shell->surfaces[s];
    Surface       *to;
    if (from->inner) continue;
    PetscCall(mesh_add_surface(mesh, from->name, from->n_faces, &to));
    to->analytic = from->analytic;
    to->shape    = from->shape;
    to->radius   = from->radius;
    if (to->analytic) to->frame = frame + number[from->frame];
    for (PetscInt f = 0; f < from->n_faces; f++) {
      const PetscInt at = from->offsets[f], n = from->offsets[f + 1] - at;
      PetscInt       vertices[FACE_NODES];
      for (PetscInt k = 0; k < n; k++)
        vertices[k] = first + number[from->vertices[at + k]];
      surface_push(to, n, vertices);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is drawn, of vertices that are numbered from 0. */
static PetscErrorCode keep_shell(const Mesh *mesh, const Mesh *shell, const PetscInt number[], PetscInt n, Shell *kept)
{
  PetscInt n_faces = 0, size = 0;
  PetscFunctionBegin;
  for (PetscInt s = 0; s < shell->n_surfaces; s++) {
    const Surface *from = &shell->surfaces[s];
    n_faces += from->inner ? 0 : from->n_faces;
    size += from->inner ? 0 : from->offsets[from->n_faces];
  }
  PetscCall(PetscMalloc2(n_faces + 1, &kept->offsets, size, &kept->vertices));
  PetscCall(PetscMalloc1(3 * n, &kept->coordinates));
  PetscCall(PetscArraycpy(kept->coordinates, mesh->coordinates + 3 * (mesh->n_vertices - n), 3 * n));
  kept->n_vertices = n;
  kept->offsets[0] = 0;
  for (PetscInt s = 0; s < shell->n_surfaces; s++) {
    const Surface *from = &shell->surfaces[s];
    for (PetscInt f = 0; f < from->n_faces && !from->inner; f++) {
      const PetscInt at = from->offsets[f], m = from->offsets[f + 1] - at, to = kept->offsets[kept->n_faces];
      for (PetscInt k = 0; k < m; k++)
        kept->vertices[to + k] = number[from->vertices[at + k]];
      kept->offsets[++kept->n_faces] = to + m;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Boxes are made on every rank, for they are made together; what is kept of them, and all else, is on rank 0. */
static PetscErrorCode create_shell(Scene *scene, const char *name, PetscInt from, Mesh *shell, PetscMPIInt rank)
{
  PetscErrorCode (*const create[])(Scene *, const char *, Mesh *) = {box_create, gmsh_shell_create, stl_create, analytic_create};
  PetscFunctionBegin;
  if (from == FROM_BOX) {
    PetscCall(box_create(scene, name, shell));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  scene_root_begin(scene);
  if (rank == 0) PetscCall(create[from](scene, name, shell));
  PetscCall(scene_root_end(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode rigid_create(Scene *scene, Body *body, Mesh *mesh)
{
  const PetscInt from     = read_from(scene, body->name), first = mesh->n_vertices, frame = mesh->n_all_vertices;
  Mesh           shell    = {.size = 1, .space = mesh->space, .dimension = mesh->dimension};
  PetscReal      point[3] = {0, 0, 0};
  PetscInt      *number, n;

  PetscFunctionBegin;
  if (!space_vector(scene, &mesh->space, body->name, "reference", point))
    scene_fail(scene, body->name, "reference",
               "this key is missing: the point that moves with the body, where its forces act and about which it turns.");
  PetscCall(create_shell(scene, body->name, from, &shell, mesh->rank));
  scene_root_begin(scene);
  if (mesh->rank == 0) {
    PetscCall(PetscMalloc1(shell.n_vertices, &number));
    n = number_vertices(&shell, number);
    check_reference(scene, body->name, point, &shell, number);
    PetscCall(append_vertices(mesh, point, &shell, number, n));
    PetscCall(append_surfaces(mesh, &shell, number, first + 2, frame + 2));
    PetscCall(keep_shell(mesh, &shell, number, n, &body->shell));
    PetscCall(PetscFree(number));
  }
  PetscCall(scene_root_end(scene));
  PetscCall(mesh_destroy(&shell));
  PetscFunctionReturn(PETSC_SUCCESS);
}
