/* Bodies, surfaces and their selection by name, box or point; all on rank 0, in the axes of the scene file. */
#include "mesh.h"
#include <string.h>

/* faces of a hexahedron and a tetrahedron in VTK's order of corners, right-hand normal outward */
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

PetscInt cell_face(PetscInt corners, PetscInt face, const PetscInt cell[], PetscInt vertices[4])
{
  const PetscInt n = corners == 8 ? 4 : 3;
  for (PetscInt k = 0; k < n; k++)
    vertices[k] = cell[corners == 8 ? HEX_FACES[face][k] : TET_FACES[face][k]];
  return n;
}

PetscErrorCode mesh_append(Mesh *mesh, PetscInt n_vertices, const PetscReal *coordinates, PetscInt n_cells,
                           PetscInt corners, const PetscInt *cells)
{
  const PetscInt used = mesh->n_cells ? mesh->cell_offsets[mesh->n_cells] : 0;
  PetscFunctionBegin;
  PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)(3 * (mesh->n_vertices + n_vertices)), &mesh->coordinates));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(mesh->n_cells + n_cells + 1), &mesh->cell_offsets));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(mesh->n_cells + n_cells), &mesh->cell_body));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)(used + n_cells * corners), &mesh->cell_vertices));
  PetscCall(PetscArraycpy(mesh->coordinates + 3 * mesh->n_vertices, coordinates, 3 * n_vertices));
  for (PetscInt k = 0; k < n_cells * corners; k++)
    mesh->cell_vertices[used + k] = cells[k] + mesh->n_vertices;
  for (PetscInt c = 0; c < n_cells; c++) {
    mesh->cell_offsets[mesh->n_cells + c] = used + c * corners;
    mesh->cell_body[mesh->n_cells + c]    = mesh->n_bodies; /* the body being read */
  }
  mesh->n_cells += n_cells;
  mesh->n_vertices += n_vertices;
  mesh->cell_offsets[mesh->n_cells] = used + n_cells * corners;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mesh_add_surface(Mesh *mesh, const char *name, PetscInt max_faces, Surface **out)
{
  Surface *surface;
  PetscFunctionBegin;
  PetscCall(PetscRealloc(sizeof(Surface) * (size_t)(mesh->n_surfaces + 1), &mesh->surfaces));
  surface = &mesh->surfaces[mesh->n_surfaces++];
  PetscCall(PetscMemzero(surface, sizeof(*surface)));
  PetscCall(PetscSNPrintf(surface->name, sizeof(surface->name), "%s", name));
  PetscCall(PetscMalloc2(max_faces + 1, &surface->offsets, 4 * max_faces, &surface->vertices));
  surface->offsets[0] = 0;
  *out                = surface;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void surface_push(Surface *surface, PetscInt n, const PetscInt vertices[])
{
  PetscInt at = surface->offsets[surface->n_faces++];
  for (PetscInt k = 0; k < n; k++)
    surface->vertices[at + k] = vertices[k];
  surface->offsets[surface->n_faces] = at + n;
}

static const Surface *find_surface(const Mesh *mesh, const char *name)
{
  for (PetscInt s = 0; s < mesh->n_surfaces; s++) {
    if (!strcmp(mesh->surfaces[s].name, name)) return &mesh->surfaces[s];
  }
  return NULL;
}

const Surface *mesh_surface(Scene *scene, const Mesh *mesh, const char *map, const char *key, const char *name)
{
  const Surface *surface    = find_surface(mesh, name);
  char           list[1024] = "";
  if (surface) return surface;
  for (PetscInt s = 0; s < mesh->n_surfaces; s++)
    snprintf(list + strlen(list), sizeof(list) - strlen(list), "%s%s", s ? ", " : "", mesh->surfaces[s].name);
  scene_fail(scene, map, key, "there is no surface '%s'; there are: %s.", name, list);
  return NULL;
}

PetscInt mesh_body(Scene *scene, const Mesh *mesh, const char *map, const char *key, const char *name)
{
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    if (!strcmp(mesh->bodies[b].name, name)) return b;
  }
  scene_fail(scene, map, key, "there is no body '%s'.", name);
  return -1;
}

/* map.body, map.point, map.tolerance -> vertex */
PetscInt mesh_nearest_vertex(Scene *scene, const Mesh *mesh, const char *map)
{
  PetscReal   point[3], tolerance, best = PETSC_MAX_REAL;
  Extent      extent            = extent_of_nothing();
  PetscInt    nearest           = -1;
  char        name[NAME_LENGTH] = "";
  const Body *body;
  scene_string_required(scene, map, "body", name, sizeof(name));
  body = &mesh->bodies[mesh_body(scene, mesh, map, "body", name)];
  if (!scene_vector(scene, map, "point", 3, point)) scene_fail(scene, map, "point", "this key is missing.");
  for (PetscInt v = body->first_vertex; v < body->end_vertex; v++) {
    const PetscReal *x       = mesh->coordinates + 3 * v;
    PetscReal        squared = 0;
    for (int i = 0; i < 3; i++)
      squared += PetscSqr(x[i] - point[i]);
    if (squared < best) best = squared, nearest = v;
    extent_add(&extent, x);
  }
  tolerance = 1e-6 * extent_longest(&extent);
  scene_real(scene, map, "tolerance", &tolerance);
  if (PetscSqrtReal(best) > tolerance) {
    const PetscReal *X = mesh->coordinates + 3 * nearest;
    scene_fail(scene, map, "point", "no vertex of '%s' lies within %g of it; the nearest is at [%g, %g, %g].", name,
               (double)tolerance, (double)X[0], (double)X[1], (double)X[2]);
  }
  return nearest;
}

/* whole faces of `whole` whose centre lies within the box */
static void cut_out(const Mesh *mesh, const Surface *whole, const PetscReal box[6], Surface *part)
{
  part->inner = (PetscBool)(part->inner || whole->inner);
  for (PetscInt f = 0; f < whole->n_faces; f++) {
    const PetscInt n_corners = whole->offsets[f + 1] - whole->offsets[f], *vertices = whole->vertices + whole->offsets[f];
    PetscBool      inside    = PETSC_TRUE;
    for (int i = 0; i < 3; i++) {
      PetscReal centre = 0;
      for (PetscInt a = 0; a < n_corners; a++)
        centre += mesh->coordinates[3 * vertices[a] + i] / n_corners;
      if (centre < box[i] || centre > box[3 + i]) inside = PETSC_FALSE;
    }
    if (inside) surface_push(part, n_corners, vertices);
  }
}

/* `surfaces: [zone]`, zone: {of: block.zmin, within: [lower, upper]}; of one surface or of several */
static PetscErrorCode derived_surfaces(Scene *scene, Mesh *mesh)
{
  PetscInt n;
  char   **names;
  PetscFunctionBegin;
  scene_names(scene, "surfaces", &n, &names);
  for (PetscInt k = 0; k < n; k++) {
    PetscReal box[6];
    PetscInt  n_of, most = 0;
    char    **of;
    Surface  *part;
    scene_strings(scene, names[k], "of", &n_of, &of);
    if (!n_of) scene_fail(scene, names[k], "of", "this key is missing.");
    if (!scene_vector(scene, names[k], "within", 6, box)) scene_fail(scene, names[k], "within", "this key is missing.");
    for (PetscInt i = 0; i < n_of; i++)
      most += mesh_surface(scene, mesh, names[k], "of", of[i])->n_faces;
    PetscCall(mesh_add_surface(mesh, names[k], most, &part));
    for (PetscInt i = 0; i < n_of; i++) {
      const Surface whole = *mesh_surface(scene, mesh, names[k], "of", of[i]);
      cut_out(mesh, &whole, box, part);
    }
    if (!part->n_faces) scene_fail(scene, names[k], "within", "no face of '%s' has its centre in this box.", of[0]);
    strings_destroy(n_of, &of);
  }
  strings_destroy(n, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void check_volumes(Scene *scene, const Mesh *mesh, const char *body, PetscInt first_cell)
{
  for (PetscInt c = first_cell; c < mesh->n_cells; c++) {
    const PetscInt corners   = mesh->cell_offsets[c + 1] - mesh->cell_offsets[c],
                   *vertices = mesh->cell_vertices + mesh->cell_offsets[c];
    PetscReal      X[24];
    for (PetscInt a = 0; a < corners; a++) {
      for (int i = 0; i < 3; i++)
        X[3 * a + i] = mesh->coordinates[3 * vertices[a] + i];
    }
    if (!(cell_smallest_jacobian(corners, X) > 0))
      scene_fail(scene, body, NULL, "cell %d (near [%g, %g, %g]) is turned inside out or flat.", (int)(c - first_cell),
                 (double)X[0], (double)X[1], (double)X[2]);
  }
}

static void read_frame(Scene *scene, Mesh *mesh)
{
  PetscReal degrees[3] = {0, 0, 0}, (*Q)[3] = (PetscReal(*)[3])mesh->rotation;
  for (int i = 0; i < 9; i++)
    mesh->rotation[i] = (i % 4 == 0);
  scene_vector(scene, "frame", "rotate", 3, degrees);
  mesh->rotated = (PetscBool)(degrees[0] != 0 || degrees[1] != 0 || degrees[2] != 0);
  for (int axis = 0; axis < 3; axis++) { /* about x, then y, then z */
    const PetscReal c = PetscCosReal(degrees[axis] * PETSC_PI / 180), s = PetscSinReal(degrees[axis] * PETSC_PI / 180);
    const int       i = (axis + 1) % 3, j = (axis + 2) % 3;
    for (int k = 0; k < 3; k++) {
      const PetscReal qi = Q[i][k], qj = Q[j][k];
      Q[i][k] = c * qi - s * qj;
      Q[j][k] = s * qi + c * qj;
    }
  }
}

PetscErrorCode mesh_create(Scene *scene, Mesh *mesh)
{
  static const char *const types[] = {"box", "gmsh", "analytic", NULL};
  PetscErrorCode (*const create[])(Scene *, const char *, Mesh *) = {box_create, gmsh_create, analytic_create};
  PetscMPIInt              rank;
  PetscInt                 n, *type;
  char                   **names;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(mesh, sizeof(*mesh)));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (!scene_has(scene, NULL, "bodies")) scene_fail(scene, NULL, "bodies", "this key is missing.");
  scene_names(scene, "bodies", &n, &names);
  read_frame(scene, mesh);
  PetscCall(PetscCalloc1(n, &mesh->bodies));
  PetscCall(PetscCalloc1(n, &type));
  for (PetscInt b = 0; b < n; b++) {
    PetscCall(PetscSNPrintf(mesh->bodies[b].name, NAME_LENGTH, "%s", names[b]));
    if (!scene_has(scene, names[b], "type"))
      scene_fail(scene, names[b], "type", "this key is missing; choose from: box, gmsh, analytic.");
    scene_choice(scene, names[b], "type", types, &type[b]);
    mesh->bodies[b].analytic     = (PetscBool)(type[b] == 2);
    mesh->bodies[b].material.law = &MATERIAL_LINEAR; /* of an analytic body: has no cells with stiffness */
    if (!mesh->bodies[b].analytic) PetscCall(material_read(scene, names[b], &mesh->bodies[b].material));
  }
  scene_root_begin(scene);
  for (PetscInt b = 0; b < n && rank == 0; b++) {
    const PetscInt first_cell = mesh->n_cells;
    mesh->bodies[b].first_vertex = mesh->n_vertices;
    PetscCall(create[type[b]](scene, names[b], mesh));
    mesh->bodies[b].end_vertex = mesh->n_vertices;
    check_volumes(scene, mesh, names[b], first_cell);
    mesh->n_bodies++;
  }
  if (rank == 0) {
    analytic_fit(mesh);
    PetscCall(derived_surfaces(scene, mesh));
  }
  PetscCall(scene_root_end(scene));
  mesh->n_bodies = n;
  PetscCall(PetscFree(type));
  strings_destroy(n, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void mesh_rotate_vector(const Mesh *mesh, PetscReal v[3])
{
  const PetscReal *Q = mesh->rotation, w[3] = {v[0], v[1], v[2]};
  if (!mesh->rotated) return;
  for (int i = 0; i < 3; i++)
    v[i] = Q[3 * i] * w[0] + Q[3 * i + 1] * w[1] + Q[3 * i + 2] * w[2];
}

PetscErrorCode mesh_rotate(Mesh *mesh)
{
  PetscFunctionBegin;
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    mesh_rotate_vector(mesh, mesh->coordinates + 3 * v);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mesh_destroy(Mesh *mesh)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < mesh->n_surfaces; s++)
    PetscCall(PetscFree2(mesh->surfaces[s].offsets, mesh->surfaces[s].vertices));
  PetscCall(PetscFree(mesh->surfaces));
  PetscCall(PetscFree(mesh->bodies));
  PetscCall(PetscFree(mesh->coordinates));
  PetscCall(PetscFree(mesh->cell_offsets));
  PetscCall(PetscFree(mesh->cell_vertices));
  PetscCall(PetscFree(mesh->cell_body));
  PetscFunctionReturn(PETSC_SUCCESS);
}
