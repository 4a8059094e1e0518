/* `-convert FILE.h5`: bodies read from Gmsh files, as one file that all ranks can read (converted.h). */
#include "mesh/converted.h"
#include <string.h>

#if defined(PETSC_HAVE_HDF5) && defined(STICKSLIP_PROGRAM_HDF5) /* PETSc's header includes HDF5's */
  #include <petscviewerhdf5.h>

static PetscErrorCode write_numbers(PetscViewer viewer, const char *name, PetscInt n, const PetscReal *values)
{
  Vec vec;
  PetscFunctionBegin;
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, values, &vec));
  PetscCall(PetscObjectSetName((PetscObject)vec, name));
  PetscCall(VecView(vec, viewer));
  PetscCall(VecDestroy(&vec));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which face of its cell each face of a surface is, into the sums of powers of two. */
static PetscErrorCode mark_faces(const Mesh *mesh, PetscInt first, PetscInt end, const Surface *surface, PetscReal sums[])
{
  PetscInt *keys, *face, n = surface->n_faces; /* by their least two vertices */
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(sums, end - first));
  PetscCall(PetscMalloc2(n, &keys, n, &face));
  for (PetscInt f = 0; f < n; f++) {
    const PetscInt *v = surface->vertices + surface->offsets[f];
    keys[f]           = v[0];
    for (PetscInt k = 1; k < cell_corners(mesh_face_kind(mesh, surface, f)); k++)
      keys[f] = PetscMin(keys[f], v[k]);
    face[f] = f;
  }
  PetscCall(PetscSortIntWithArray(n, keys, face));
  for (PetscInt c = first; c < end; c++) {
    for (PetscInt f = 0; f < cell_faces(mesh_cell_kind(mesh, c)); f++) {
      PetscInt       vertices[FACE_NODES], least, low = 0, high = n;
      const PetscInt n_face = cell_face(mesh_cell_kind(mesh, c), f, mesh->cell_vertices + mesh->cell_offsets[c], vertices);
      least                 = vertices[0];
      for (PetscInt k = 1; k < cell_corners(cell_kind(mesh->dimension - 1, n_face)); k++)
        least = PetscMin(least, vertices[k]);
      while (low < high) {
        const PetscInt middle = low + (high - low) / 2;
        if (keys[middle] < least)
          low = middle + 1;
        else
          high = middle;
      }
      for (; low < n && keys[low] == least; low++) { /* readers take faces from cells, in the order of cell_face() */
        const PetscInt at = surface->offsets[face[low]];
        if (surface->offsets[face[low] + 1] - at == n_face && !memcmp(surface->vertices + at, vertices, sizeof(PetscInt) * (size_t)n_face)) {
          sums[c - first] += (PetscReal)(1 << f);
          break;
        }
      }
    }
  }
  PetscCall(PetscFree2(keys, face));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode write_surfaces(PetscViewer viewer, const Mesh *mesh, const Body *body, PetscInt first, PetscInt end,
                                     PetscInt *n_surfaces)
{
  const size_t length = strlen(body->name);
  PetscReal   *sums;
  char         name[2 * NAME_LENGTH];
  PetscFunctionBegin;
  *n_surfaces = 0;
  PetscCall(PetscMalloc1(end - first, &sums));
  for (PetscInt s = 0; s < mesh->n_surfaces; s++) {
    const Surface *surface = &mesh->surfaces[s];
    const char    *given   = surface->name + length + 1;
    if (strncmp(surface->name, body->name, length) || surface->name[length] != '.') continue;
    PetscCall(mark_faces(mesh, first, end, surface, sums));
    PetscCall(PetscSNPrintf(name, sizeof(name), "faces_%" PetscInt_FMT, *n_surfaces));
    PetscCall(write_numbers(viewer, name, end - first, sums));
    PetscCall(PetscSNPrintf(name, sizeof(name), "surface_%" PetscInt_FMT, *n_surfaces));
    PetscCall(PetscViewerHDF5WriteAttribute(viewer, NULL, name, PETSC_STRING, given));
    PetscCall(PetscSNPrintf(name, sizeof(name), "inner_%" PetscInt_FMT, *n_surfaces));
    PetscCall(PetscViewerHDF5WriteAttribute(viewer, NULL, name, PETSC_BOOL, &surface->inner));
    (*n_surfaces)++;
  }
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode write_body(PetscViewer viewer, const Mesh *mesh, PetscInt b)
{
  const Body    *body       = &mesh->bodies[b];
  const PetscInt n_vertices = body->end_here - body->first_here;
  PetscInt       first = 0, end, n_cells, n_entries, n_surfaces;
  PetscReal     *numbers;

  PetscFunctionBegin;
  while (mesh->cell_body[first] < b)
    first++;
  for (end = first; end < mesh->n_cells && mesh->cell_body[end] == b;)
    end++;
  n_cells   = end - first;
  n_entries = mesh->cell_offsets[end] - mesh->cell_offsets[first];
  PetscCall(PetscViewerHDF5PushGroup(viewer, body->name));
  PetscCall(write_numbers(viewer, "coordinates", 3 * n_vertices, mesh->coordinates + 3 * body->first_here));
  PetscCall(PetscMalloc1(PetscMax(n_cells, n_entries), &numbers));
  for (PetscInt c = 0; c < n_cells; c++)
    numbers[c] = (PetscReal)(mesh->cell_offsets[first + c + 1] - mesh->cell_offsets[first + c]);
  PetscCall(write_numbers(viewer, "sizes", n_cells, numbers));
  for (PetscInt k = 0; k < n_entries; k++)
    numbers[k] = (PetscReal)(mesh->cell_vertices[mesh->cell_offsets[first] + k] - body->first_here);
  PetscCall(write_numbers(viewer, "connectivity", n_entries, numbers));
  PetscCall(PetscFree(numbers));
  PetscCall(write_surfaces(viewer, mesh, body, first, end, &n_surfaces));
  PetscCall(PetscViewerHDF5WriteAttribute(viewer, NULL, "dimension", PETSC_INT, &mesh->dimension));
  PetscCall(PetscViewerHDF5WriteAttribute(viewer, NULL, "vertices", PETSC_INT, &n_vertices));
  PetscCall(PetscViewerHDF5WriteAttribute(viewer, NULL, "cells", PETSC_INT, &n_cells));
  PetscCall(PetscViewerHDF5WriteAttribute(viewer, NULL, "surfaces", PETSC_INT, &n_surfaces));
  PetscCall(PetscViewerHDF5PopGroup(viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode converted_write(Scene *scene, const Mesh *mesh, const char *path)
{
  PetscErrorCode failed;
  PetscViewer    viewer;
  PetscInt       n = 0;
  PetscFunctionBegin;
  if (mesh->size > 1) scene_fail(scene, NULL, NULL, "-convert reads whole files: run it on one rank.");
  for (PetscInt b = 0; b < mesh->n_bodies; b++)
    n += mesh->bodies[b].from_gmsh;
  if (!n) scene_fail(scene, NULL, NULL, "no body of this scene comes from a Gmsh file: there is nothing to convert.");
  if (scene_is_source(scene, path)) scene_fail(scene, NULL, NULL, "-convert would write over '%s', which this scene is read from; name another file.", path);
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  failed = PetscViewerHDF5Open(PETSC_COMM_SELF, path, FILE_MODE_WRITE, &viewer);
  PetscCall(PetscPopErrorHandler());
  if (failed) scene_fail(scene, NULL, NULL, "-convert cannot write '%s': is there such a folder, and may you write in it?", path);
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    if (mesh->bodies[b].from_gmsh) PetscCall(write_body(viewer, mesh, b));
  }
  PetscCall(PetscViewerDestroy(&viewer));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s: %" PetscInt_FMT " bodies; read them by {type: hdf5, file: %s}\n", path, n, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}
#else
PetscErrorCode converted_write(Scene *scene, const Mesh *mesh, const char *path)
{
  PetscFunctionBegin;
  (void)mesh, (void)path;
  scene_fail(scene, NULL, NULL, "-convert needs a PETSc built with HDF5, and the headers of HDF5; this program was built without.");
  PetscFunctionReturn(PETSC_SUCCESS);
}
#endif
