/* Surfaces, bodies and vertices by what the scene calls them, in the axes of the scene file. */
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

void mesh_side_name(const char *interface, const char *key, char name[], size_t length)
{
  snprintf(name, length, "%s.%s", interface, key);
}

const Surface *mesh_side(Scene *scene, const Mesh *mesh, const char *interface, const char *key)
{
  char     name[2 * NAME_LENGTH];
  char   **of;
  PetscInt n;
  scene_strings(scene, interface, key, &n, &of);
  if (n > 1)
    mesh_side_name(interface, key, name, sizeof(name));
  else
    scene_string_required(scene, interface, key, name, sizeof(name));
  strings_destroy(n, &of);
  return mesh_surface(scene, mesh, interface, key, name);
}

PetscInt mesh_body(Scene *scene, const Mesh *mesh, const char *map, const char *key, const char *name)
{
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    if (!strcmp(mesh->bodies[b].name, name)) return b;
  }
  scene_fail(scene, map, key, "there is no body '%s'.", name);
  return -1;
}

PetscInt mesh_body_of(const Mesh *mesh, PetscInt number)
{
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    if (number >= mesh->bodies[b].first_vertex && number < mesh->bodies[b].end_vertex) return b;
  }
  return -1;
}

PetscInt mesh_vertex_here(const Mesh *mesh, PetscInt number)
{
  PetscInt low = 0, high = mesh->n_vertices;
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (mesh->numbers[middle] < number)
      low = middle + 1;
    else
      high = middle;
  }
  return low < mesh->n_vertices && mesh->numbers[low] == number ? low : -1;
}

/* Of all ranks' best vertices the nearest one; of several the first. */
static PetscErrorCode agree(PetscReal best, PetscInt *number, PetscReal X[3], PetscReal *distance)
{
  PetscMPIInt size, rank, speaker;
  PetscReal   least = best;
  PetscInt    first;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  first = best == least && *number >= 0 ? *number : PETSC_MAX_INT;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPIU_INT, MPI_MIN, PETSC_COMM_WORLD));
  speaker = first == *number ? rank : size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &speaker, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(X, 3, MPIU_REAL, speaker, PETSC_COMM_WORLD));
  *number   = first;
  *distance = PetscSqrtReal(least);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* map.body, map.point, map.tolerance -> vertex */
PetscErrorCode mesh_nearest_vertex(Scene *scene, const Mesh *mesh, const char *map, PetscInt *number)
{
  PetscFunctionBegin;
  PetscCall(mesh_vertex_at(scene, mesh, map, "body", "point", number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the same with other keys for body and point */
PetscErrorCode mesh_vertex_at(Scene *scene, const Mesh *mesh, const char *map, const char *body_key, const char *point_key, PetscInt *number)
{
  PetscReal   point[3], X[3] = {0, 0, 0}, tolerance, best = PETSC_MAX_REAL, distance;
  Extent      extent            = extent_of_nothing();
  char        name[NAME_LENGTH] = "";
  const Body *body;
  PetscFunctionBegin;
  scene_string_required(scene, map, body_key, name, sizeof(name));
  body = &mesh->bodies[mesh_body(scene, mesh, map, body_key, name)];
  if (!space_vector(scene, &mesh->space, map, point_key, point)) scene_fail(scene, map, point_key, "this key is missing.");
  *number = -1;
  for (PetscInt v = body->first_here; v < body->end_here; v++) {
    const PetscReal *x       = mesh->coordinates + 3 * v;
    PetscReal        squared = 0;
    for (int i = 0; i < 3; i++)
      squared += PetscSqr(x[i] - point[i]);
    if (squared < best) {
      best    = squared;
      *number = mesh->numbers[v];
      PetscCall(PetscArraycpy(X, x, 3));
    }
    extent_add(&extent, x);
  }
  PetscCall(extent_of_all(&extent));
  PetscCall(agree(best, number, X, &distance));
  tolerance = 1e-6 * extent_longest(&extent);
  scene_real(scene, map, "tolerance", &tolerance);
  if (distance > tolerance)
    scene_fail(scene, map, point_key, "no vertex of '%s' lies within %g of it; the nearest is at [%g, %g, %g].", name,
               (double)tolerance, (double)X[0], (double)X[1], (double)X[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
