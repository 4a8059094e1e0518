/* Loads as the scene describes them: on surfaces, or on bodies. */
#include "physics/fluid.h"
#include <string.h>

static void read_surface_load(Scene *scene, const Mesh *mesh, Load *load)
{
  const PetscBool traction = space_vector(scene, &mesh->space, load->name, "traction", load->traction);
  scene_real(scene, load->name, "pressure", &load->pressure);
  scene_bool(scene, load->name, "follower", &load->follows);
  if (load->follows && traction)
    scene_fail(scene, load->name, "follower", "a traction keeps its direction; a pressure can follow its surface.");
  mesh_rotate_vector(mesh, load->traction);
}

/* In an axisymmetric model a body can turn about its axis alone, in the plane about z. */
static PetscBool read_spin(Scene *scene, const Mesh *mesh, Load *load)
{
  PetscReal *spin = load->acceleration.spin;
  if (mesh->dimension == 3) return scene_vector(scene, load->name, "centrifugal", 3, spin);
  return scene_vector(scene, load->name, "centrifugal", 1, spin + (mesh->space.kind == SPACE_AXISYMMETRIC ? 1 : 2));
}

static PetscErrorCode read_body_load(Scene *scene, const Physics *physics, Load *load)
{
  const Mesh     *mesh     = physics->mesh;
  Acceleration   *of       = &load->acceleration;
  const PetscBool gravity  = space_vector(scene, &mesh->space, load->name, "gravity", of->uniform),
                  spins    = read_spin(scene, mesh, load), forces = rigids_read_load(scene, physics, load);
  PetscInt        n;
  char          **names;

  PetscFunctionBegin;
  if (mesh->space.kind == SPACE_AXISYMMETRIC && of->uniform[0] != 0)
    scene_fail(scene, load->name, "gravity", "in an axisymmetric model it acts along the axis, y: [0, %g].", (double)of->uniform[1]);
  space_vector(scene, &mesh->space, load->name, "origin", of->origin);
  if (scene_has(scene, load->name, "origin") && !spins)
    scene_fail(scene, load->name, "origin", "only of `centrifugal`.");
  if (mesh->space.kind == SPACE_AXISYMMETRIC && of->origin[0] != 0)
    scene_fail(scene, load->name, "origin", "an axisymmetric model turns about its axis; leave it out.");
  if (!gravity && !spins && !forces)
    scene_fail(scene, load->name, "gravity", "say how it loads the body: gravity, or centrifugal; of a rigid body force, or moment.");
  scene_strings(scene, load->name, "body", &n, &names);
  PetscCall(PetscCalloc1(mesh->n_bodies, &load->bodies));
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt b = mesh_body(scene, mesh, load->name, "body", names[k]);
    load->bodies[b]  = PETSC_TRUE;
    rigids_check_load(scene, physics, load, names[k], forces, gravity, spins);
    if (!mesh->bodies[b].rigid && !(physics->materials[b].density > 0))
      scene_fail(scene, names[k], "density", "'%s' asks for one above 0.", load->name);
  }
  strings_destroy(n, &names);
  mesh_rotate_vector(mesh, of->uniform);
  mesh_rotate_vector(mesh, of->spin);
  mesh_rotate_vector(mesh, of->origin);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A force on the node of a body that is nearest to a point. */
static PetscErrorCode read_point_load(Scene *scene, const Mesh *mesh, Load *load)
{
  static const char *const others[] = {"gravity", "centrifugal", "origin", "follower"};
  PetscFunctionBegin;
  if (scene_has(scene, load->name, "moment"))
    scene_fail(scene, load->name, "moment", "a moment on a node: a node does not turn. Spread it over a `surface`, or give it to a rigid body.");
  for (int k = 0; k < 4; k++) {
    if (scene_has(scene, load->name, others[k])) scene_fail(scene, load->name, others[k], "not of a node: leave `point` out.");
  }
  if (!space_vector(scene, &mesh->space, load->name, "force", load->force))
    scene_fail(scene, load->name, "force", "this key is missing, which goes with `point`.");
  if (mesh->space.kind == SPACE_AXISYMMETRIC && load->force[0] != 0)
    scene_fail(scene, load->name, "force", "of a ring it acts along the axis, y: [0, %g].", (double)load->force[1]);
  PetscCall(mesh_nearest_vertex(scene, mesh, load->name, &load->vertex));
  mesh_rotate_vector(mesh, load->force);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A force and a moment at a point, spread over surfaces. */
static void read_remote_load(Scene *scene, const Mesh *mesh, Load *load)
{
  if (mesh->space.kind == SPACE_AXISYMMETRIC)
    scene_fail(scene, load->name, scene_has(scene, load->name, "moment") ? "moment" : "force",
               "a surface of an axisymmetric model has no such load: give its `traction`.");
  if (scene_has(scene, load->name, "follower"))
    scene_fail(scene, load->name, "follower", "a force keeps its direction; a pressure can follow its surface.");
  load->remote = PETSC_TRUE;
  space_vector(scene, &mesh->space, load->name, "force", load->force);
  space_turn(scene, &mesh->space, load->name, "moment", load->moment);
  load->given_point = space_vector(scene, &mesh->space, load->name, "point", load->point);
  mesh_rotate_vector(mesh, load->force);
  mesh_rotate_vector(mesh, load->moment);
  mesh_rotate_vector(mesh, load->point);
}

/* Of surfaces: a traction or a pressure; or a force and a moment. */
static void read_on_surfaces(Scene *scene, const Mesh *mesh, Load *load, PetscBool stressed)
{
  static const char *const others[] = {"surface", "follower", "gravity", "centrifugal", "origin", "point", "curve"};
  const char *remote = scene_has(scene, load->name, "force") ? "force" : scene_has(scene, load->name, "moment") ? "moment" : NULL;
  if (remote && stressed) scene_fail(scene, load->name, remote, "a surface has a traction and a pressure, or a force and a moment; not both in one load.");
  if (!stressed && !remote) {
    for (size_t k = 0; k < sizeof(others) / sizeof(others[0]); k++) /* known keys, one of which may be misspelt */
      (void)scene_has(scene, load->name, others[k]);
    scene_check_unread_of(scene, load->name);
    scene_fail(scene, load->name, "traction",
               "say how it loads: a surface by traction [x, y%s] or pressure (against the outward normal), or by force and moment, a node by "
               "`body`, `point` and force, or a body by gravity or centrifugal, a rigid one by force or moment.",
               mesh->dimension == 3 ? ", z" : "");
  }
  if (remote && !scene_has(scene, load->name, "surface"))
    scene_fail(scene, load->name, remote, "a %s acts on a rigid `body`, or spread over a `surface`%s: name one.", remote,
               remote[0] == 'f' ? ", or on the node of a `body` at a `point`" : "; a moment on a node is none");
  if (remote)
    read_remote_load(scene, mesh, load);
  else
    read_surface_load(scene, mesh, load);
}

static PetscErrorCode read_load(Scene *scene, Physics *physics, Load *load)
{
  const PetscBool traction = scene_has(scene, load->name, "traction");
  const PetscBool pressure = scene_has(scene, load->name, "pressure");

  PetscFunctionBegin;
  load->vertex = -1;
  if (scene_has(scene, load->name, "body")) {
    if (traction || pressure)
      scene_fail(scene, load->name, traction ? "traction" : "pressure", "a load acts on a surface or on a body, not on both.");
    if (scene_has(scene, load->name, "point") && !rigids_names(scene, physics, load->name))
      PetscCall(read_point_load(scene, physics->mesh, load));
    else
      PetscCall(read_body_load(scene, physics, load));
  } else {
    read_on_surfaces(scene, physics->mesh, load, (PetscBool)(traction || pressure));
  }
  PetscCall(curve_read(scene, load->name, "curve", physics->end, &load->curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the last surface of the load so far, if it is of a rigid body */
static PetscErrorCode refuse_rigid(Scene *scene, const Physics *physics, const Load *load, const char *name)
{
  char     text[256];
  PetscInt bad = -1;
  PetscFunctionBegin;
  if (!physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < load->n_surfaces; k++) {
    const Surface *surface = load->surfaces[k];
    if (!surface || strcmp(surface->name, name) || !surface->n_faces) continue;
    if (rigids_of_vertex(physics, physics->mesh->numbers[surface->vertices[0]]) >= 0) bad = 0;
  }
  PetscCall(PetscSNPrintf(text, sizeof(text), "'%s' is rigid: give its body a `force` or a `moment`.", name));
  PetscCall(scene_fail_first(scene, bad, load->name, "surface", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode find_surfaces(Scene *scene, const Physics *physics, Load *load)
{
  const Mesh *mesh = physics->mesh;
  char **list;
  PetscFunctionBegin;
  scene_strings(scene, load->name, "surface", &load->n_surfaces, &list);
  if (!load->n_surfaces) scene_fail(scene, load->name, "surface", "this key is missing.");
  PetscCall(PetscCalloc1(load->n_surfaces, &load->surfaces));
  for (PetscInt k = 0; k < load->n_surfaces; k++) {
    load->surfaces[k] = mesh_surface(scene, mesh, load->name, "surface", list[k]);
    if (load->surfaces[k]->inner)
      scene_fail(scene, load->name, "surface", "'%s' lies inside a body and cannot be loaded.", list[k]);
    PetscCall(refuse_rigid(scene, physics, load, list[k]));
    if (load->surfaces[k]->analytic)
      scene_fail(scene, load->name, "surface", "'%s' is rigid and without faces: it cannot be loaded.", list[k]);
  }
  strings_destroy(load->n_surfaces, &list);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode loads_read(Scene *scene, Physics *physics)
{
  char **names;
  PetscFunctionBegin;
  scene_names(scene, "loads", &physics->n_loads, &names);
  PetscCall(PetscCalloc1(physics->n_loads, &physics->loads));
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    PetscCall(PetscSNPrintf(physics->loads[l].name, NAME_LENGTH, "%s", names[l]));
    PetscCall(read_load(scene, physics, &physics->loads[l]));
  }
  strings_destroy(physics->n_loads, &names);
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    if (!physics->loads[l].bodies && physics->loads[l].vertex < 0) PetscCall(find_surfaces(scene, physics, &physics->loads[l]));
    PetscCall(fluid_read(scene, physics, &physics->loads[l]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
