/* The bodies of the scene, one after the other, and surfaces cut out of theirs. All on rank 0, in the axes of the scene
 * file. */
#include "mesh/mesh.h"

/* Vertices this close to the axis, relative to the size of their body, lie on it: some thousand roundings of a place that was
 * bent or turned. A bore may be thinner than any mesh. */
static const PetscReal ON_AXIS = 1e-12;

/* whole faces of `whole` whose centre, the mean of their corners, lies within the box */
static void cut_out(const Mesh *mesh, const Surface *whole, const PetscReal box[6], Surface *part)
{
  part->inner = (PetscBool)(part->inner || whole->inner);
  for (PetscInt f = 0; f < whole->n_faces; f++) {
    const CellKind kind      = mesh_face_kind(mesh, whole, f);
    const PetscInt n_corners = cell_corners(kind), *vertices = whole->vertices + whole->offsets[f];
    PetscBool      inside   = PETSC_TRUE;
    for (int i = 0; i < 3; i++) {
      PetscReal centre = 0;
      for (PetscInt a = 0; a < n_corners; a++)
        centre += mesh->coordinates[3 * vertices[a] + i] / n_corners;
      if (centre < box[i] || centre > box[3 + i]) inside = PETSC_FALSE;
    }
    if (inside) surface_push(part, cell_nodes(kind), vertices);
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
    if (!space_box(scene, &mesh->space, names[k], "within", box)) scene_fail(scene, names[k], "within", "this key is missing.");
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
    const CellKind  kind     = mesh_cell_kind(mesh, c);
    const PetscInt *vertices = mesh->cell_vertices + mesh->cell_offsets[c];
    PetscReal      X[3 * CELL_NODES];
    for (PetscInt a = 0; a < cell_nodes(kind); a++) {
      for (int i = 0; i < 3; i++)
        X[3 * a + i] = mesh->coordinates[3 * vertices[a] + i];
    }
    if (!(cell_smallest_jacobian(kind, X) > 0))
      scene_fail(scene, body, NULL, "cell %d (near [%g, %g, %g]) is turned inside out or flat.", (int)(c - first_cell),
                 (double)X[0], (double)X[1], (double)X[2]);
  }
}

/* Of what is read from files or bent, an axisymmetric body has nodes by rounding beside the axis: they lie on it. */
static void check_radii(Scene *scene, Mesh *mesh, const char *body, PetscInt first_vertex)
{
  Extent    extent = extent_of_nothing();
  PetscReal tolerance;
  for (PetscInt v = first_vertex; v < mesh->n_vertices; v++)
    extent_add(&extent, mesh->coordinates + 3 * v);
  tolerance = ON_AXIS * extent_longest(&extent);
  for (PetscInt v = first_vertex; v < mesh->n_vertices; v++) {
    PetscReal *x = mesh->coordinates + 3 * v;
    if (x[0] < -tolerance)
      scene_fail(scene, body, NULL, "its vertex at [%g, %g] lies beyond the axis: x is the radius of an axisymmetric model.",
                 (double)x[0], (double)x[1]);
    if (x[0] <= tolerance) x[0] = 0;
  }
}

static void read_frame(Scene *scene, Mesh *mesh)
{
  PetscReal degrees[3] = {0, 0, 0}, (*Q)[3] = (PetscReal(*)[3])mesh->rotation;
  for (int i = 0; i < 9; i++)
    mesh->rotation[i] = (i % 4 == 0);
  space_turn(scene, &mesh->space, "frame", "rotate", degrees);
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
  static const char *const types[] = {"box", "gmsh", "analytic", "rigid", NULL};
  PetscErrorCode (*const create[])(Scene *, const char *, Mesh *) = {box_create, gmsh_create, analytic_create, rigid_create};
  PetscInt                 n, *type;
  char                   **names;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(mesh, sizeof(*mesh)));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &mesh->rank));
  space_read(scene, &mesh->space);
  mesh->dimension = space_dimension(&mesh->space);
  if (!scene_has(scene, NULL, "bodies")) scene_fail(scene, NULL, "bodies", "this key is missing.");
  scene_names(scene, "bodies", &n, &names);
  read_frame(scene, mesh);
  PetscCall(PetscCalloc1(n, &mesh->bodies));
  PetscCall(PetscCalloc1(n, &type));
  for (PetscInt b = 0; b < n; b++) {
    PetscCall(PetscSNPrintf(mesh->bodies[b].name, NAME_LENGTH, "%s", names[b]));
    if (!scene_has(scene, names[b], "type"))
      scene_fail(scene, names[b], "type", "this key is missing; choose from: box, gmsh, analytic, rigid.");
    scene_choice(scene, names[b], "type", types, &type[b]);
    mesh->bodies[b].rigid    = (PetscBool)(type[b] == 3);
    mesh->bodies[b].analytic = (PetscBool)(type[b] == 2 || (type[b] == 3 && rigid_is_analytic(scene, names[b])));
  }
  scene_root_begin(scene);
  for (PetscInt b = 0; b < n && mesh->rank == 0; b++) {
    const PetscInt first_cell = mesh->n_cells;
    mesh->bodies[b].first_vertex  = mesh->n_vertices;
    mesh->bodies[b].first_surface = mesh->n_surfaces;
    PetscCall(create[type[b]](scene, names[b], mesh));
    mesh->bodies[b].end_vertex  = mesh->n_vertices;
    mesh->bodies[b].end_surface = mesh->n_surfaces;
    if (!mesh->bodies[b].rigid) check_volumes(scene, mesh, names[b], first_cell);
    if (mesh->space.kind == SPACE_AXISYMMETRIC && !mesh->bodies[b].analytic)
      check_radii(scene, mesh, names[b], mesh->bodies[b].first_vertex);
    mesh->n_bodies++;
  }
  if (mesh->rank == 0) {
    analytic_fit(mesh);
    PetscCall(derived_surfaces(scene, mesh));
  }
  PetscCall(scene_root_end(scene));
  mesh->n_bodies = n;
  PetscCall(PetscFree(type));
  strings_destroy(n, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}
