/* The bodies of the scene, one after the other, and surfaces cut out of theirs, in the axes of the scene file. Boxes and
 * converted meshes are made by all ranks, a piece each; rank 0 reads what is not. */
#include "mesh/converted.h"

/* Vertices this close to the axis, relative to the size of their body, lie on it: some thousand roundings of a place that was
 * bent or turned. A bore may be thinner than any mesh. */
static const PetscReal ON_AXIS = 1e-12;

static PetscInt face_number(const Surface *surface, PetscInt f)
{
  return surface->numbers ? surface->numbers[f] : f;
}

/* whole faces of `whole` whose centre, the mean of their corners, lies within the box; numbered from `first` */
static void cut_out(const Mesh *mesh, const Surface *whole, PetscInt first, const PetscReal box[6], Surface *part)
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
    if (!inside) continue;
    part->numbers[part->n_faces] = first + face_number(whole, f);
    surface_push(part, cell_nodes(kind), vertices);
  }
}

/* beyond the numbers of all faces of a surface */
static PetscErrorCode end_of_numbers(const Surface *surface, PetscInt *end)
{
  PetscFunctionBegin;
  *end = 0;
  for (PetscInt f = 0; f < surface->n_faces; f++)
    *end = PetscMax(*end, face_number(surface, f) + 1);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, end, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What several surfaces, or one, have in a box, as one of that name. */
static PetscErrorCode join(Scene *scene, Mesh *mesh, const char *map, const char *key, PetscInt n, char *const of[], const PetscReal box[6], const char *name)
{
  PetscInt most = 0, first = 0, end, n_faces;
  Surface *part;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; i++) {
    const Surface *whole = mesh_surface(scene, mesh, map, key, of[i]);
    if (whole->analytic) scene_fail(scene, map, key, "'%s' is analytic: it is a surface by itself.", of[i]);
    most += whole->n_faces;
  }
  PetscCall(mesh_add_surface(mesh, name, most, &part));
  PetscCall(PetscMalloc1(most, &part->numbers));
  for (PetscInt i = 0; i < n; i++) {
    const Surface *whole = mesh_surface(scene, mesh, map, key, of[i]);
    cut_out(mesh, whole, first, box, part);
    PetscCall(end_of_numbers(whole, &end));
    first += end;
  }
  n_faces = part->n_faces;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n_faces, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  if (!n_faces) scene_fail(scene, map, "within", "no face of '%s' has its centre in this box.", of[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `surfaces: [zone]`, zone: {of: block.zmin, within: [lower, upper]}; of one surface or of several. A side of an interface that is a list is one, too. */
static PetscErrorCode derived_surfaces(Scene *scene, Mesh *mesh)
{
  static const char *const sides[] = {"nonmortar", "mortar"};
  const PetscReal all[6] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL};
  PetscInt n, n_of;
  char   **names, **of;
  PetscFunctionBegin;
  scene_names(scene, "surfaces", &n, &names);
  for (PetscInt k = 0; k < n; k++) {
    PetscReal       box[6];
    const PetscBool cut = (PetscBool)space_box(scene, &mesh->space, names[k], "within", box);
    scene_strings(scene, names[k], "of", &n_of, &of);
    if (!n_of) scene_fail(scene, names[k], "of", "this key is missing.");
    PetscCall(join(scene, mesh, names[k], "of", n_of, of, cut ? box : all, names[k]));
    strings_destroy(n_of, &of);
  }
  strings_destroy(n, &names);
  scene_strings(scene, NULL, "interfaces", &n, &names);
  for (PetscInt k = 0; k < 2 * n; k++) {
    char name[2 * NAME_LENGTH];
    scene_strings(scene, names[k / 2], sides[k % 2], &n_of, &of);
    mesh_side_name(names[k / 2], sides[k % 2], name, sizeof(name));
    if (n_of > 1) PetscCall(join(scene, mesh, names[k / 2], sides[k % 2], n_of, of, all, name));
    strings_destroy(n_of, &of);
  }
  strings_destroy(n, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode check_volumes(Scene *scene, const Mesh *mesh, const Body *body, PetscInt first_here)
{
  char     text[256] = "";
  PetscInt bad       = -1;
  PetscFunctionBegin;
  for (PetscInt c = first_here; c < mesh->n_cells && bad < 0; c++) {
    const CellKind  kind     = mesh_cell_kind(mesh, c);
    const PetscInt *vertices = mesh->cell_vertices + mesh->cell_offsets[c];
    PetscReal      X[3 * CELL_NODES];
    for (PetscInt a = 0; a < cell_nodes(kind); a++) {
      for (int i = 0; i < 3; i++)
        X[3 * a + i] = mesh->coordinates[3 * vertices[a] + i];
    }
    if (cell_smallest_jacobian(kind, X) > 0) continue;
    bad = mesh->cell_numbers[c] - body->first_cell;
    PetscCall(PetscSNPrintf(text, sizeof(text), "cell %d (near [%g, %g, %g]) is turned inside out or flat.", (int)bad,
                            (double)X[0], (double)X[1], (double)X[2]));
  }
  PetscCall(scene_fail_first(scene, bad, body->name, NULL, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of what is read from files or bent, an axisymmetric body has nodes by rounding beside the axis: they lie on it. */
static PetscErrorCode check_radii(Scene *scene, Mesh *mesh, const Body *body)
{
  Extent    extent = extent_of_nothing();
  PetscReal tolerance;
  char      text[256] = "";
  PetscInt  bad       = -1;
  PetscFunctionBegin;
  for (PetscInt v = body->first_here; v < body->end_here; v++)
    extent_add(&extent, mesh->coordinates + 3 * v);
  PetscCall(extent_of_all(&extent));
  tolerance = ON_AXIS * extent_longest(&extent);
  for (PetscInt v = body->first_here; v < body->end_here; v++) {
    PetscReal *x = mesh->coordinates + 3 * v;
    if (x[0] < -tolerance && bad < 0) {
      bad = mesh->numbers[v];
      PetscCall(PetscSNPrintf(text, sizeof(text), "its vertex at [%g, %g] lies beyond the axis: x is the radius of an axisymmetric model.",
                              (double)x[0], (double)x[1]));
    }
    if (x[0] <= tolerance) x[0] = 0;
  }
  PetscCall(scene_fail_first(scene, bad, body->name, NULL, text));
  PetscFunctionReturn(PETSC_SUCCESS);
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

/* What rank 0 has read of a body: others learn how much that is, and which surfaces there are. */
static PetscErrorCode share_body(Mesh *mesh)
{
  PetscInt counts[3] = {mesh->n_all_vertices, mesh->n_all_cells, mesh->n_surfaces};
  PetscFunctionBegin;
  PetscCallMPI(MPI_Bcast(counts, 3, MPIU_INT, 0, PETSC_COMM_WORLD));
  mesh->n_all_vertices = counts[0];
  mesh->n_all_cells    = counts[1];
  for (PetscInt s = 0, n_here = mesh->n_surfaces; s < counts[2]; s++) {
    Surface about, *surface;
    if (mesh->rank == 0) about = mesh->surfaces[s];
    PetscCallMPI(MPI_Bcast(&about, sizeof(about), MPI_BYTE, 0, PETSC_COMM_WORLD));
    if (s < n_here) continue;
    PetscCall(mesh_add_surface(mesh, about.name, 0, &surface));
    surface->inner    = about.inner;
    surface->analytic = about.analytic;
    surface->shape    = about.shape;
    surface->radius   = about.radius;
    surface->frame    = about.frame;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What it costs to read a whole file on one rank of several. */
static PetscErrorCode tell_cost(Scene *scene, const Mesh *mesh, const Body *body)
{
  PetscBool      quiet = PETSC_FALSE;
  PetscLogDouble bytes = mesh_bytes_of_piece(mesh);
  PetscFunctionBegin;
  scene_bool(scene, "output", "quiet", &quiet);
  if (mesh->size > 1 && !quiet)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                          "note: rank 0 has read all %" PetscInt_FMT " cells of %s, and holds %.3g MB of mesh until it is distributed; "
                          "converted by -convert, each rank reads its piece\n",
                          mesh->n_all_cells - body->first_cell, body->name, bytes / 1e6));
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { BOX, GMSH, ANALYTIC, HDF5, RIGID };

static PetscErrorCode create_body(Scene *scene, Mesh *mesh, PetscInt type, Body *body)
{
  const PetscInt first_cell = mesh->n_cells;
  PetscFunctionBegin;
  body->first_vertex = mesh->n_all_vertices;
  body->first_cell   = mesh->n_all_cells;
  body->first_here   = mesh->n_vertices;
  if (type == BOX || type == HDF5) {
    PetscCall((type == BOX ? box_create : converted_create)(scene, body->name, mesh));
  } else if (type == RIGID) {
    PetscCall(rigid_create(scene, body, mesh));
    PetscCall(share_body(mesh));
  } else {
    scene_root_begin(scene);
    if (mesh->rank == 0 && type == GMSH) PetscCall(gmsh_create(scene, body->name, mesh));
    if (mesh->rank == 0 && type == ANALYTIC) PetscCall(analytic_create(scene, body->name, mesh));
    PetscCall(scene_root_end(scene));
    PetscCall(share_body(mesh));
    if (type == GMSH) PetscCall(tell_cost(scene, mesh, body));
  }
  body->end_vertex = mesh->n_all_vertices;
  body->end_here   = mesh->n_vertices;
  if (!body->rigid) PetscCall(check_volumes(scene, mesh, body, first_cell));
  if (mesh->space.kind == SPACE_AXISYMMETRIC && !body->analytic) PetscCall(check_radii(scene, mesh, body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mesh_create(Scene *scene, Mesh *mesh)
{
  static const char *const types[] = {"box", "gmsh", "analytic", "hdf5", "rigid", NULL}; /* BOX, ... */
  PetscInt                 n, *type;
  char                   **names;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(mesh, sizeof(*mesh)));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &mesh->rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &mesh->size));
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
      scene_fail(scene, names[b], "type", "this key is missing; choose from: box, gmsh, analytic, hdf5, rigid.");
    scene_choice(scene, names[b], "type", types, &type[b]);
    mesh->bodies[b].rigid     = (PetscBool)(type[b] == RIGID);
    mesh->bodies[b].analytic  = (PetscBool)(type[b] == ANALYTIC || (type[b] == RIGID && rigid_is_analytic(scene, names[b])));
    mesh->bodies[b].from_gmsh = (PetscBool)(type[b] == GMSH);
  }
  for (; mesh->n_bodies < n; mesh->n_bodies++)
    PetscCall(create_body(scene, mesh, type[mesh->n_bodies], &mesh->bodies[mesh->n_bodies]));
  PetscCall(analytic_fit(mesh));
  PetscCall(derived_surfaces(scene, mesh));
  PetscCall(pieces_share(mesh));
  mesh->bytes.read = mesh_bytes_of_piece(mesh);
  PetscCall(PetscFree(type));
  strings_destroy(n, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}
