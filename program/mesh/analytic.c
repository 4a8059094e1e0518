/* A rigid body without a mesh: a plane, a sphere or a cylinder for the mortar side of interfaces; in the plane a straight line
 * or a circle. It moves with a frame of four points, in the plane of three, which the library sees as the mortar nodes; here
 * they are the corners of a tetrahedron or a triangle without stiffness, so that supports, reactions and output treat them
 * like those of any body. Its only surface is `body.surface`. */
#include "mesh/mesh.h"

/* a unit vector across d, and the third one of a right-handed triple; d is made a unit vector too */
static void complete(PetscReal d[3], PetscReal e[3], PetscReal f[3])
{
  int       least = 0;
  PetscReal norm  = PetscSqrtReal(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), across = 0;
  for (int i = 0; i < 3; i++) {
    d[i] /= norm;
    if (PetscAbsReal(d[i]) < PetscAbsReal(d[least])) least = i;
  }
  for (int i = 0; i < 3; i++) {
    e[i] = (i == least) - d[least] * d[i];
    across += e[i] * e[i];
  }
  for (int i = 0; i < 3; i++)
    e[i] /= PetscSqrtReal(across);
  for (int i = 0; i < 3; i++)
    f[i] = d[(i + 1) % 3] * e[(i + 2) % 3] - d[(i + 2) % 3] * e[(i + 1) % 3];
}

PetscErrorCode analytic_create(Scene *scene, const char *body, Mesh *mesh)
{
  /* by STICKSLIP_SHAPE_... */
  static const char *const solid[] = {"plane", "sphere", "cylinder", NULL}, *const plane[] = {"line", "circle", NULL};
  static const PetscInt    cell[4]   = {0, 1, 2, 3};
  const PetscBool          flat      = (PetscBool)(mesh->dimension == 2);
  PetscReal                point[3]  = {0, 0, 0}, d[3] = {0, !!flat, !flat}, e[3], f[3], radius = 0, frame[12];
  PetscInt                 shape     = 0;
  const PetscBool          directed  = space_vector(scene, &mesh->space, body, "direction", d);
  char                     name[2 * NAME_LENGTH];
  Surface                 *surface;

  PetscFunctionBegin;
  if (!scene_has(scene, body, "shape"))
    scene_fail(scene, body, "shape", "this key is missing; choose from: %s.", flat ? "line, circle" : "plane, sphere, cylinder");
  scene_choice(scene, body, "shape", flat ? plane : solid, &shape);
  if (!space_vector(scene, &mesh->space, body, "point", point)) scene_fail(scene, body, "point", "this key is missing.");
  if (!directed && shape != 1) scene_fail(scene, body, "direction", "this key is missing.");
  if (flat && shape == 1 && scene_has(scene, body, "direction")) scene_fail(scene, body, "direction", "a circle has none.");
  if (d[0] == 0 && d[1] == 0 && d[2] == 0) scene_fail(scene, body, "direction", "a vector of some length is expected.");
  if (shape == 0 && scene_has(scene, body, "radius")) scene_fail(scene, body, "radius", "a %s has none.", flat ? plane[0] : solid[0]);
  if (shape != 0) scene_real_required(scene, body, "radius", &radius);
  if (shape != 0 && radius == 0)
    scene_fail(scene, body, "radius", "positive: the body is inside; negative: it is around a cavity. Zero is neither.");

  complete(d, e, f);
  for (int i = 0; i < 3 && flat; i++) /* the third point in the plane, to the left of the second */
    e[i] = i == 0 ? -d[1] : i == 1 ? d[0] : 0;
  for (int i = 0; i < 3; i++) {
    frame[i]     = point[i];
    frame[3 + i] = point[i] + d[i];
    frame[6 + i] = point[i] + e[i];
    frame[9 + i] = point[i] + f[i];
  }
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s.surface", body));
  PetscCall(mesh_add_surface(mesh, name, 0, &surface));
  surface->analytic = PETSC_TRUE;
  surface->shape    = shape;
  surface->radius   = radius;
  surface->frame    = mesh->n_all_vertices;
  PetscCall(mesh_append(mesh, mesh->dimension + 1, NULL, frame, 1, NULL, flat ? TRI3 : TET4, cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Once all bodies are read: frames as long as the meshed bodies are large, planes and cylinders with their point where these
 * are. A frame that is short, or far away, turns by rounding, which moves the surface under them. */
PetscErrorCode analytic_fit(Mesh *mesh)
{
  Extent    extent = extent_of_nothing();
  PetscReal size;
  PetscFunctionBegin;
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    const Body *body = &mesh->bodies[b];
    for (PetscInt v = body->first_here; v < body->end_here && !body->analytic; v++)
      extent_add(&extent, mesh->coordinates + 3 * v);
  }
  PetscCall(extent_of_all(&extent));
  size = extent_longest(&extent);
  if (size == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s < mesh->n_surfaces; s++) {
    const Surface *surface = &mesh->surfaces[s];
    const PetscInt first   = surface->analytic ? mesh_vertex_here(mesh, surface->frame) : -1;
    PetscReal     *frame   = mesh->coordinates + 3 * first, along = 0, axes[9];
    if (first < 0) continue;
    for (int k = 0; k < 3 * mesh->dimension; k++)
      axes[k] = frame[3 + k] - frame[k % 3];
    for (int i = 0; i < 3; i++)
      along += axes[i] * ((extent.low[i] + extent.high[i]) / 2 - frame[i]);
    for (int i = 0; i < 3; i++) {
      const PetscReal away = (extent.low[i] + extent.high[i]) / 2 - frame[i];
      if (surface->shape == 0) frame[i] += away - along * axes[i]; /* across the normal */
      if (surface->shape == 2) frame[i] += along * axes[i];        /* along the axis */
    }
    for (int k = 0; k < 3 * mesh->dimension; k++)
      frame[3 + k] = frame[k % 3] + PetscMax(size, PetscAbsReal(surface->radius)) * axes[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
