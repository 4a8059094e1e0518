/* A body from a converted mesh (converted.h): each rank reads a range of its cells, then the vertices that these have. */
#include "mesh/converted.h"

#if defined(PETSC_HAVE_HDF5) && defined(STICKSLIP_PROGRAM_HDF5) /* PETSc's header includes HDF5's */
  #include <petscviewerhdf5.h>

/* Ends the run of all ranks where any of them has seen that the file is not what -convert has written. */
static PetscErrorCode check(Scene *scene, const char *body, PetscBool damaged)
{
  PetscFunctionBegin;
  PetscCall(scene_fail_first(scene, damaged ? 0 : -1, body, "file",
                             "it is damaged, or something else has written it; write it anew: `stickslip SCENE.yaml -convert FILE.h5`."));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is this one of the whole numbers from 0 on below the end? No not-a-number is. */
static PetscBool is_below(PetscReal value, PetscInt end)
{
  return (PetscBool)(value >= 0 && value < (PetscReal)end && value == PetscFloorReal(value));
}

/* this rank's share, so many numbers, of a vector in the group; to be freed */
static PetscErrorCode read_numbers(Scene *scene, const char *body, PetscViewer viewer, const char *name, PetscInt n, PetscReal **values)
{
  const PetscScalar *array;
  PetscErrorCode     failed;
  Vec                vec;
  PetscFunctionBegin;
  PetscCall(VecCreate(PETSC_COMM_WORLD, &vec));
  PetscCall(VecSetSizes(vec, n, PETSC_DETERMINE));
  PetscCall(VecSetType(vec, VECSTANDARD));
  PetscCall(PetscObjectSetName((PetscObject)vec, name));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  failed = VecLoad(vec, viewer);
  PetscCall(PetscPopErrorHandler());
  PetscCall(check(scene, body, (PetscBool)(failed != 0)));
  PetscCall(PetscMalloc1(n, values));
  PetscCall(VecGetArrayRead(vec, &array));
  PetscCall(PetscArraycpy(*values, array, n));
  PetscCall(VecRestoreArrayRead(vec, &array));
  PetscCall(VecDestroy(&vec));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* from n things the first one of rank r */
static PetscInt first_of(PetscInt n, PetscMPIInt r, PetscMPIInt size)
{
  return (PetscInt)((PetscInt64)n * r / size);
}

/* Of these vertices of the body, numbers increasing: their places, from the ranks that read them. */
static PetscErrorCode read_coordinates(Scene *scene, const char *body, PetscViewer viewer, const Mesh *mesh, PetscInt n_all, PetscInt n,
                                       const PetscInt numbers[], PetscReal coordinates[])
{
  const PetscInt mine = first_of(n_all, mesh->rank + 1, mesh->size) - first_of(n_all, mesh->rank, mesh->size);
  PetscReal     *read;
  MPI_Datatype   vector;
  PetscLayout    layout;
  PetscSF        sf;
  PetscFunctionBegin;
  PetscCall(read_numbers(scene, body, viewer, "coordinates", 3 * mine, &read));
  PetscCall(PetscLayoutCreateFromSizes(PETSC_COMM_WORLD, mine, n_all, 1, &layout));
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, &sf));
  PetscCall(PetscSFSetGraphLayout(sf, layout, n, NULL, PETSC_OWN_POINTER, numbers));
  PetscCallMPI(MPI_Type_contiguous(3, MPIU_REAL, &vector));
  PetscCallMPI(MPI_Type_commit(&vector));
  PetscCall(PetscSFBcastBegin(sf, vector, read, coordinates, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, vector, read, coordinates, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&vector));
  PetscCall(PetscSFDestroy(&sf));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscCall(PetscFree(read));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells of one size after the other: mesh_append() takes one kind at a time. Vertices go with the first. */
static PetscErrorCode append(Mesh *mesh, PetscInt n_cells, PetscInt first, const PetscReal sizes[], const PetscInt cells[],
                             PetscInt n_vertices, const PetscInt numbers[], const PetscReal coordinates[])
{
  PetscInt *relative, *number;
  PetscFunctionBegin;
  PetscCall(PetscMalloc2(CELL_NODES * n_cells, &relative, n_cells, &number));
  for (PetscInt c = 0, at = 0; c < n_cells;) {
    const PetscInt size = (PetscInt)sizes[c], before = c ? n_vertices : 0;
    PetscInt       n    = 0;
    for (; c < n_cells && (PetscInt)sizes[c] == size; c++, n++) {
      number[n] = first + c;
      for (PetscInt k = 0; k < size; k++, at++)
        relative[n * size + k] = cells[at] - before;
    }
    PetscCall(mesh_append(mesh, n_vertices - before, numbers, coordinates, n, number, cell_kind(mesh->dimension, size), relative));
  }
  PetscCall(PetscFree2(relative, number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_surfaces(Scene *scene, PetscViewer viewer, const char *body, PetscInt n_surfaces, PetscInt n_cells, Mesh *mesh)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < n_surfaces; s++) {
    char       key[NAME_LENGTH], name[2 * NAME_LENGTH], *given;
    PetscReal *sums;
    PetscInt   most = 0, first = 0;
    Surface   *surface;
    PetscBool  inner, there, damaged = PETSC_FALSE;
    PetscCall(PetscSNPrintf(key, sizeof(key), "inner_%" PetscInt_FMT, s));
    PetscCall(PetscViewerHDF5HasAttribute(viewer, NULL, key, &there));
    PetscCall(check(scene, body, (PetscBool)!there)); /* -convert writes it after the name */
    PetscCall(PetscSNPrintf(key, sizeof(key), "surface_%" PetscInt_FMT, s));
    PetscCall(PetscViewerHDF5ReadAttribute(viewer, NULL, key, PETSC_STRING, NULL, &given));
    PetscCall(PetscSNPrintf(key, sizeof(key), "inner_%" PetscInt_FMT, s));
    PetscCall(PetscViewerHDF5ReadAttribute(viewer, NULL, key, PETSC_BOOL, NULL, &inner));
    PetscCall(PetscSNPrintf(key, sizeof(key), "faces_%" PetscInt_FMT, s));
    PetscCall(read_numbers(scene, body, viewer, key, n_cells, &sums));
    for (PetscInt c = 0; c < n_cells; c++)
      damaged = (PetscBool)(damaged || !is_below(sums[c], 1 << cell_faces(mesh_cell_kind(mesh, mesh->n_cells - n_cells + c))));
    PetscCall(check(scene, body, damaged));
    for (PetscInt c = 0; c < n_cells; c++) {
      for (PetscInt f = 0; f < 6; f++)
        most += ((PetscInt)sums[c] >> f) & 1;
    }
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s.%s", body, given));
    PetscCall(PetscFree(given));
    PetscCall(mesh_add_surface(mesh, name, most, &surface));
    surface->inner = inner;
    for (PetscInt c = 0; c < n_cells; c++) {
      const PetscInt cell = mesh->n_cells - n_cells + c;
      for (PetscInt f = 0; f < cell_faces(mesh_cell_kind(mesh, cell)); f++) {
        PetscInt vertices[FACE_NODES], n;
        if (!(((PetscInt)sums[c] >> f) & 1)) continue;
        n = cell_face(mesh_cell_kind(mesh, cell), f, mesh->cell_vertices + mesh->cell_offsets[cell], vertices);
        surface_push(surface, n, vertices);
      }
    }
    PetscCall(PetscFree(sums));
    PetscCallMPI(MPI_Exscan(&most, &first, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
    PetscCall(PetscMalloc1(most, &surface->numbers));
    for (PetscInt f = 0; f < most; f++)
      surface->numbers[f] = (mesh->rank ? first : 0) + f;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_body(Scene *scene, PetscViewer viewer, const char *body, const PetscInt counts[4], Mesh *mesh)
{
  const PetscInt first = first_of(counts[2], mesh->rank, mesh->size), n_cells = first_of(counts[2], mesh->rank + 1, mesh->size) - first;
  PetscReal     *sizes, *entries, *coordinates;
  PetscInt       n_entries = 0, n_vertices, *cells, *numbers;
  PetscBool      damaged   = (PetscBool)(counts[1] < 1 || counts[2] < 1 || counts[3] < 0);
  PetscFunctionBegin;
  PetscCall(check(scene, body, damaged));
  PetscCall(read_numbers(scene, body, viewer, "sizes", n_cells, &sizes));
  for (PetscInt c = 0; c < n_cells && !damaged; c++) {
    damaged = (PetscBool)(!is_below(sizes[c], CELL_NODES + 1) || cell_kind(mesh->dimension, (PetscInt)sizes[c]) == CELL_KINDS);
    if (!damaged) n_entries += (PetscInt)sizes[c];
  }
  PetscCall(check(scene, body, damaged));
  PetscCall(read_numbers(scene, body, viewer, "connectivity", n_entries, &entries));
  for (PetscInt k = 0; k < n_entries; k++)
    damaged = (PetscBool)(damaged || !is_below(entries[k], counts[1]));
  PetscCall(check(scene, body, damaged));
  PetscCall(PetscMalloc2(n_entries, &cells, n_entries, &numbers));
  for (PetscInt k = 0; k < n_entries; k++)
    cells[k] = numbers[k] = (PetscInt)entries[k];
  n_vertices = n_entries;
  PetscCall(PetscSortRemoveDupsInt(&n_vertices, numbers));
  for (PetscInt k = 0; k < n_entries; k++)
    PetscCall(PetscFindInt(cells[k], n_vertices, numbers, &cells[k]));
  PetscCall(PetscMalloc1(3 * n_vertices, &coordinates));
  PetscCall(read_coordinates(scene, body, viewer, mesh, counts[1], n_vertices, numbers, coordinates));
  PetscCall(append(mesh, n_cells, first, sizes, cells, n_vertices, numbers, coordinates));
  PetscCall(read_surfaces(scene, viewer, body, counts[3], n_cells, mesh));
  PetscCall(PetscFree(coordinates));
  PetscCall(PetscFree2(cells, numbers));
  PetscCall(PetscFree(sizes));
  PetscCall(PetscFree(entries));
  mesh->n_all_vertices += counts[1];
  mesh->n_all_cells += counts[2];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode converted_create(Scene *scene, const char *body, Mesh *mesh)
{
  static const char *const names[]                  = {"dimension", "vertices", "cells", "surfaces"};
  char                     file[PETSC_MAX_PATH_LEN] = "", path[PETSC_MAX_PATH_LEN], group[NAME_LENGTH + 1];
  PetscInt                 counts[4];
  PetscBool                there = PETSC_FALSE;
  PetscErrorCode           failed;
  PetscViewer              viewer;

  PetscFunctionBegin;
  scene_string_required(scene, body, "file", file, sizeof(file));
  PetscCall(scene_relative_path(scene, file, path, sizeof(path)));
  PetscCall(PetscTestFile(path, 'r', &there));
  if (!there) scene_fail(scene, body, "file", "cannot read '%s'.", path);
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  failed = PetscViewerHDF5Open(PETSC_COMM_WORLD, path, FILE_MODE_READ, &viewer);
  PetscCall(PetscPopErrorHandler());
  if (failed) scene_fail(scene, body, "file", "'%s' is no HDF5 file; `stickslip SCENE.yaml -convert FILE.h5` makes one.", path);
  PetscCall(PetscSNPrintf(group, sizeof(group), "/%s", body));
  PetscCall(PetscViewerHDF5HasGroup(viewer, group, &there));
  if (!there) scene_fail(scene, body, "file", "'%s' has no body '%s'.", path, body);
  PetscCall(PetscViewerHDF5PushGroup(viewer, group));
  for (int k = 0; k < 4; k++) {
    PetscCall(PetscViewerHDF5HasAttribute(viewer, NULL, names[k], &there));
    if (!there) scene_fail(scene, body, "file", "'%s' was not written by -convert: there is no '%s' of '%s'.", path, names[k], body);
    PetscCall(PetscViewerHDF5ReadAttribute(viewer, NULL, names[k], PETSC_INT, NULL, &counts[k]));
  }
  if (counts[0] != mesh->dimension)
    scene_fail(scene, body, "file", "its cells have %d dimensions, those of the scene %d.", (int)counts[0], (int)mesh->dimension);
  PetscCall(read_body(scene, viewer, body, counts, mesh));
  PetscCall(PetscViewerHDF5PopGroup(viewer));
  PetscCall(PetscViewerDestroy(&viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}
#else
PetscErrorCode converted_create(Scene *scene, const char *body, Mesh *mesh)
{
  PetscFunctionBegin;
  (void)mesh;
  scene_fail(scene, body, "type", "hdf5 needs a PETSc built with HDF5, and the headers of HDF5; this program was built without.");
  PetscFunctionReturn(PETSC_SUCCESS);
}
#endif
