/* Surfaces, bodies and vertices by what the scene calls them; on rank 0, in the axes of the scene file. */
#include "mesh/mesh.h"
#include <string.h>

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
  if (!space_vector(scene, &mesh->space, map, "point", point)) scene_fail(scene, map, "point", "this key is missing.");
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
