/* The surface of a rigid body from an STL file, text or binary. A file has no vertices but the corners of its triangles: those at
 * the same place, to the last digit, are one. */
#include "mesh/mesh.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER = 84, RECORD = 50, MOST_WORDS = 100 };

typedef struct {
  PetscInt   n, capacity; /* corners, three of each triangle */
  PetscReal *x;
} Corners;

static PetscErrorCode push(Corners *corners, const PetscReal x[3])
{
  PetscFunctionBegin;
  if (corners->n == corners->capacity) {
    corners->capacity = 2 * corners->capacity + MOST_WORDS;
    PetscCall(PetscRealloc(sizeof(PetscReal) * (size_t)(3 * corners->capacity), &corners->x));
  }
  PetscCall(PetscArraycpy(corners->x + 3 * corners->n++, x, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_binary(const unsigned char *bytes, PetscInt n, Corners *corners)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3 * n; k++) {
    float     given[3];
    PetscReal x[3];
    memcpy(given, bytes + HEADER + RECORD * (k / 3) + 12 * (1 + k % 3), sizeof(given)); /* after the normal */
    for (int i = 0; i < 3; i++)
      x[i] = (PetscReal)given[i];
    PetscCall(push(corners, x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_text(const char *text, Corners *corners)
{
  PetscFunctionBegin;
  for (const char *at = strstr(text, "vertex"); at; at = strstr(at, "vertex")) {
    PetscReal x[3];
    at += strlen("vertex");
    for (int i = 0; i < 3; i++) {
      char *end;
      x[i] = strtod(at, &end);
      if (end == at) PetscFunctionReturn(PETSC_SUCCESS); /* no multiple of three then, or none at all */
      at = end;
    }
    PetscCall(push(corners, x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_file(const char *path, Corners *corners)
{
  FILE          *file = NULL;
  unsigned char *bytes;
  uint32_t       n    = 0;
  long           size = 0;
  PetscBool      is_file;
  PetscFunctionBegin;
  PetscCall(PetscTestFile(path, 'r', &is_file)); /* no directory, whose size means nothing */
  if (is_file) file = fopen(path, "rb");
  if (!file) PetscFunctionReturn(PETSC_SUCCESS);
  (void)fseek(file, 0, SEEK_END);
  size = ftell(file);
  (void)fseek(file, 0, SEEK_SET);
  PetscCall(PetscCalloc1(size + 1, &bytes));
  if (fread(bytes, 1, (size_t)size, file) != (size_t)size) size = 0;
  fclose(file);
  if (size >= HEADER) memcpy(&n, bytes + HEADER - sizeof(n), sizeof(n));
  if (size >= HEADER && size == HEADER + RECORD * (long)n)
    PetscCall(read_binary(bytes, (PetscInt)n, corners));
  else
    PetscCall(read_text((const char *)bytes, corners));
  PetscCall(PetscFree(bytes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int compare(const void *a, const void *b, void *context)
{
  const PetscReal *x = context, *one = x + 3 * *(const PetscInt *)a, *two = x + 3 * *(const PetscInt *)b;
  for (int i = 0; i < 3; i++) {
    if (one[i] != two[i]) return one[i] < two[i] ? -1 : 1;
  }
  return 0;
}

/* Corners that are one get one number; their places move to the head of the array. Returns how many there are. */
static PetscErrorCode join(Corners *corners, PetscInt vertex[], PetscInt *n)
{
  PetscInt *sorted, *first;
  PetscFunctionBegin;
  PetscCall(PetscMalloc2(corners->n, &sorted, corners->n, &first));
  for (PetscInt k = 0; k < corners->n; k++)
    sorted[k] = k;
  PetscCall(PetscTimSort(corners->n, sorted, sizeof(*sorted), compare, corners->x));
  for (PetscInt k = 0, head = 0; k < corners->n; k++) { /* a stable sort: the first of its place is the head */
    if (compare(&sorted[head], &sorted[k], corners->x)) head = k;
    first[sorted[k]] = sorted[head];
  }
  *n = 0;
  for (PetscInt k = 0; k < corners->n; k++) { /* in the order of the file */
    vertex[k] = first[k] == k ? *n : vertex[first[k]];
    if (first[k] == k) PetscCall(PetscArraymove(corners->x + 3 * (*n)++, corners->x + 3 * k, 3));
  }
  PetscCall(PetscFree2(sorted, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode stl_create(Scene *scene, const char *body, Mesh *shell)
{
  char      file[PETSC_MAX_PATH_LEN] = "", path[PETSC_MAX_PATH_LEN], name[2 * NAME_LENGTH];
  Corners   corners = {0};
  PetscInt *vertex, n = 0;
  Surface  *surface;

  PetscFunctionBegin;
  if (shell->dimension == 2) scene_fail(scene, body, "from", "an STL file is of space; take a box, or a plane Gmsh file.");
  scene_string_required(scene, body, "file", file, sizeof(file));
  PetscCall(scene_relative_path(scene, file, path, sizeof(path)));
  PetscCall(read_file(path, &corners));
  if (!corners.n || corners.n % 3) scene_fail(scene, body, "file", "'%s' cannot be read as an STL file.", path);
  for (PetscInt k = 0; k < 3 * corners.n; k++) {
    if (PetscIsInfOrNanReal(corners.x[k])) scene_fail(scene, body, "file", "'%s' has a corner that is no number.", path);
  }
  PetscCall(PetscMalloc1(corners.n, &vertex));
  PetscCall(join(&corners, vertex, &n));
  PetscCall(mesh_append(shell, n, NULL, corners.x, 0, NULL, TET4, NULL));
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s.surface", body));
  PetscCall(mesh_add_surface(shell, name, corners.n / 3, &surface));
  for (PetscInt k = 0; k < corners.n; k += 3) { /* without those that are a line or a point */
    if (vertex[k] != vertex[k + 1] && vertex[k + 1] != vertex[k + 2] && vertex[k + 2] != vertex[k])
      surface_push(surface, 3, vertex + k);
  }
  if (!surface->n_faces) scene_fail(scene, body, "file", "'%s' has no triangle but lines and points.", path);
  PetscCall(orient_outward(scene, body, shell));
  PetscCall(PetscFree(vertex));
  PetscCall(PetscFree(corners.x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
