/* Springs as the scene describes them. */
#include "physics/dynamics.h"
#include "physics/springs.h"

/* A surface that can be one's end: of a body with a mesh. */
static const Surface *read_surface(Scene *scene, const Physics *physics, const char *map, const char *key, const char *name)
{
  const Surface *surface = mesh_surface(scene, physics->mesh, map, key, name);
  PetscInt       bad     = -1;
  char           text[256];
  if (surface->inner) scene_fail(scene, map, key, "'%s' lies inside a body: a spring holds a surface, or a node.", name);
  if (surface->analytic) scene_fail(scene, map, key, "'%s' is rigid and without faces: a spring cannot hold it.", name);
  if (surface->n_faces && rigids_of_vertex(physics, physics->mesh->numbers[surface->vertices[0]]) >= 0) bad = 0;
  PetscCallAbort(PETSC_COMM_WORLD, PetscSNPrintf(text, sizeof(text), "'%s' is rigid: name its body, whose reference point the spring holds.", name));
  PetscCallAbort(PETSC_COMM_WORLD, scene_fail_first(scene, bad, map, key, text));
  return surface;
}

/* The reference point of a rigid body, or the node of a body at a point. */
static PetscErrorCode read_node(Scene *scene, const Physics *physics, const char *map, const char *body, const char *point, PetscInt *vertex)
{
  const Mesh *mesh = physics->mesh;
  char        name[NAME_LENGTH];
  PetscInt    b;
  PetscFunctionBegin;
  scene_string_required(scene, map, body, name, sizeof(name));
  b = mesh_body(scene, mesh, map, body, name);
  if (mesh->bodies[b].rigid) {
    if (scene_has(scene, map, point)) scene_fail(scene, map, point, "'%s' is rigid: a spring holds its reference point; leave this out.", name);
    *vertex = mesh->bodies[b].first_vertex;
  } else if (mesh->bodies[b].analytic) {
    scene_fail(scene, map, body, "'%s' moves by a support alone: a spring cannot hold it.", name);
  } else {
    PetscCall(mesh_vertex_at(scene, mesh, map, body, point, vertex));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `surface`, one or a list, per area; or as an end; or a node */
static PetscErrorCode read_first_end(Scene *scene, const Physics *physics, Spring *spring, PetscBool linked)
{
  char   **names;
  PetscInt n;
  PetscFunctionBegin;
  if (!scene_has(scene, spring->name, "surface")) {
    if (!scene_has(scene, spring->name, "body"))
      scene_fail(scene, spring->name, "surface", "say what the spring holds: a `surface`, or the node of a `body` at a `point`.");
    PetscCall(read_node(scene, physics, spring->name, "body", "point", &spring->ends[0].vertex));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (scene_has(scene, spring->name, "body")) scene_fail(scene, spring->name, "body", "a spring holds a surface or a node, not both.");
  scene_strings(scene, spring->name, "surface", &n, &names);
  if (linked && n != 1) scene_fail(scene, spring->name, "surface", "one surface is an end of a spring; several are held by the ground only.");
  PetscCall(PetscCalloc1(n, &spring->surfaces));
  for (PetscInt k = 0; k < n; k++)
    spring->surfaces[k] = read_surface(scene, physics, spring->name, "surface", names[k]);
  spring->ends[0].surface = linked ? spring->surfaces[0] : NULL;
  spring->per_area        = (PetscBool)!linked;
  spring->n_surfaces      = n;
  strings_destroy(n, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `to`: another surface, or with `to_point` a body; `to_point` alone: a place that does not move */
static PetscErrorCode read_second_end(Scene *scene, const Physics *physics, Spring *spring)
{
  const Mesh *mesh = physics->mesh;
  SpringEnd  *end  = &spring->ends[1];
  char        name[2 * NAME_LENGTH] = "";
  PetscBool   surface = PETSC_FALSE;
  PetscFunctionBegin;
  scene_string(scene, spring->name, "to", name, sizeof(name));
  for (PetscInt s = 0; s < mesh->n_surfaces; s++) {
    PetscBool same;
    PetscCall(PetscStrcmp(mesh->surfaces[s].name, name, &same));
    surface = (PetscBool)(surface || same);
  }
  if (surface) {
    if (scene_has(scene, spring->name, "to_point")) scene_fail(scene, spring->name, "to_point", "it is of a body; `to` names a surface.");
    end->surface = read_surface(scene, physics, spring->name, "to", name);
    if (end->surface == spring->ends[0].surface) scene_fail(scene, spring->name, "to", "both ends are the same surface.");
  } else if (name[0]) {
    PetscCall(read_node(scene, physics, spring->name, "to", "to_point", &end->vertex));
  } else if (space_vector(scene, &mesh->space, spring->name, "to_point", end->X)) {
    if (!spring->axial) scene_fail(scene, spring->name, "to_point", "a place is the end of an `axial` spring only; the ground needs none.");
    mesh_rotate_vector(mesh, end->X);
    spring->fixed = PETSC_TRUE;
  } else if (spring->axial) {
    scene_fail(scene, spring->name, "to_point", "this key is missing: where the other end of an axial spring is.");
  }
  if (end->vertex >= 0 && end->vertex == spring->ends[0].vertex) scene_fail(scene, spring->name, "to_point", "both ends are the same node.");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Q diag(stiffness) Q^T, with Q what turns the scene into the model's axes */
static void read_stiffness(Scene *scene, const Mesh *mesh, Spring *spring)
{
  PetscReal *k = spring->stiffness;
  spring->length = -1;
  if (!scene_has(scene, spring->name, "stiffness")) scene_fail(scene, spring->name, "stiffness", "this key is missing.");
  if (spring->axial) {
    scene_real(scene, spring->name, "stiffness", k);
    scene_real(scene, spring->name, "length", &spring->length);
  } else {
    if (scene_has(scene, spring->name, "length")) scene_fail(scene, spring->name, "length", "only of an `axial` spring.");
    space_vector(scene, &mesh->space, spring->name, "stiffness", k);
  }
  if (k[0] + k[1] + k[2] <= 0) scene_fail(scene, spring->name, "stiffness", "it must be positive, at least in one direction.");
  for (int m = 0; m < 9 && !spring->axial; m++) {
    for (int i = 0; i < 3; i++)
      spring->K[m] += mesh->rotation[3 * (m / 3) + i] * k[i] * mesh->rotation[3 * (m % 3) + i];
  }
}

static PetscErrorCode read_spring(Scene *scene, Physics *physics, Spring *spring)
{
  const Mesh     *mesh   = physics->mesh;
  const PetscBool linked = (PetscBool)(scene_has(scene, spring->name, "to") || scene_has(scene, spring->name, "to_point"));
  PetscFunctionBegin;
  spring->ends[0].vertex = spring->ends[1].vertex = -1;
  scene_bool(scene, spring->name, "axial", &spring->axial);
  if (spring->axial && physics->dynamics && physics->dynamics->stiffness_damping > 0)
    scene_fail(scene, spring->name, "axial",
               "`stiffness_damping` of `dynamics` would brake its turns, too: leave that out, or give `stiffness` by components.");
  if (spring->axial && mesh->space.kind == SPACE_AXISYMMETRIC)
    scene_fail(scene, spring->name, "axial", "an axisymmetric model has springs by components only.");
  read_stiffness(scene, mesh, spring);
  PetscCall(read_first_end(scene, physics, spring, (PetscBool)(linked || spring->axial)));
  PetscCall(read_second_end(scene, physics, spring));
  if (mesh->space.kind == SPACE_AXISYMMETRIC && !spring->per_area && spring->stiffness[0] != 0)
    scene_fail(scene, spring->name, "stiffness", "of a ring it acts along the axis, y: [0, %g]; radially give it to a surface.",
               (double)spring->stiffness[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode springs_read(Scene *scene, Physics *physics)
{
  PetscInt n;
  char   **names;
  PetscFunctionBegin;
  scene_names(scene, "springs", &n, &names);
  if (n) {
    PetscCall(PetscNew(&physics->springs));
    physics->springs->n = n;
    PetscCall(PetscCalloc1(n, &physics->springs->spring));
  }
  for (PetscInt s = 0; s < n; s++) {
    PetscCall(PetscSNPrintf(physics->springs->spring[s].name, NAME_LENGTH, "%s", names[s]));
    PetscCall(read_spring(scene, physics, &physics->springs->spring[s]));
  }
  strings_destroy(n, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}
