/* Supports whose displacements stand in a text file: a row `X Y Z ux uy uz` for each vertex, in any order; lines that start
 * with # do not count. So a body follows any field, as that of a coarser model. */
#include "physics/physics.h"
#include <stdio.h>
#include <string.h>

typedef struct {
  PetscReal along; /* by which rows are ordered */
  PetscReal X[3], u[3];
} Row;

typedef struct {
  Row     *rows;
  PetscInt n;
} Table;

/* Of the size of all bodies: files keep at least 7 digits. */
static const PetscReal SAME_VERTEX = 1e-6;

/* The position along a line that lies across no plane or edge of usual meshes, so that few vertices have the same: from
 * the plastic number, whose powers are as far from ratios of small numbers as those of any. */
static PetscReal position_along(const PetscReal X[3])
{
  return X[0] + 0.7548776662466927 * X[1] + 0.5698402909980532 * X[2];
}

static int by_position(const void *a, const void *b)
{
  const PetscReal difference = ((const Row *)a)->along - ((const Row *)b)->along;
  return (difference > 0) - (difference < 0);
}

static PetscErrorCode read_rows(Scene *scene, const char *map, const char *path, Table *table)
{
  char     line[1024];
  PetscInt room = 0;
  FILE    *stream = fopen(path, "r");

  PetscFunctionBegin;
  if (!stream) scene_fail(scene, map, "file", "cannot read '%s'.", path);
  for (PetscInt number = 1; fgets(line, sizeof(line), stream); number++) {
    Row row;
    if (line[0] == '#' || strspn(line, " \t\r\n") == strlen(line)) continue;
    if (sscanf(line, "%lf %lf %lf %lf %lf %lf", &row.X[0], &row.X[1], &row.X[2], &row.u[0], &row.u[1], &row.u[2]) != 6)
      scene_fail(scene, map, "file", "line %d of '%s' is no row of six numbers.", (int)number, path);
    row.along = position_along(row.X);
    if (table->n == room) {
      room = 2 * room + 64;
      PetscCall(PetscRealloc(sizeof(Row) * (size_t)room, &table->rows));
    }
    table->rows[table->n++] = row;
  }
  fclose(stream);
  qsort(table->rows, (size_t)table->n, sizeof(Row), by_position);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the row of the vertex at X; NULL: there is none */
static const Row *row_at(const Table *table, const PetscReal X[3], PetscReal tolerance)
{
  const PetscReal along = position_along(X), reach = 3 * tolerance; /* the factors above add up to less than 3 */
  PetscInt        low = 0, high = table->n;
  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (table->rows[middle].along < along - reach)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < table->n && table->rows[low].along <= along + reach; low++) {
    const Row *row = &table->rows[low];
    if (PetscAbsReal(row->X[0] - X[0]) <= tolerance && PetscAbsReal(row->X[1] - X[1]) <= tolerance &&
        PetscAbsReal(row->X[2] - X[2]) <= tolerance)
      return row;
  }
  return NULL;
}

/* when the support's vertices are known; every rank reads the file */
PetscErrorCode supports_file_read(Scene *scene, const Mesh *mesh, Support *support)
{
  char      file[PETSC_MAX_PATH_LEN] = "", path[PETSC_MAX_PATH_LEN], text[PETSC_MAX_PATH_LEN + 128] = "";
  Table     table                    = {0};
  Extent    extent                   = extent_of_nothing();
  PetscReal tolerance;
  PetscInt  bad = -1;

  PetscFunctionBegin;
  scene_string(scene, support->name, "file", file, sizeof(file));
  if (!file[0]) PetscFunctionReturn(PETSC_SUCCESS);
  support->from_file = PETSC_TRUE;
  PetscCall(scene_relative_path(scene, file, path, sizeof(path)));
  PetscCall(read_rows(scene, support->name, path, &table));
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    extent_add(&extent, mesh->coordinates + 3 * v);
  PetscCall(extent_of_all(&extent));
  tolerance = SAME_VERTEX * extent_longest(&extent);
  PetscCall(PetscCalloc1(3 * mesh->n_vertices, &support->given));
  for (PetscInt k = 0; k < support->n_vertices && bad < 0; k++) {
    const PetscReal *X   = mesh->coordinates + 3 * support->vertices[k];
    const Row       *row = row_at(&table, X, tolerance);
    if (!row) {
      bad = mesh->numbers[support->vertices[k]];
      PetscCall(PetscSNPrintf(text, sizeof(text), "'%s' has no row for the vertex at [%g, %g, %g].", path, (double)X[0],
                              (double)X[1], (double)X[2]));
    }
    for (int i = 0; i < 3 && row; i++)
      support->given[3 * support->vertices[k] + i] = row->u[i];
  }
  PetscCall(scene_fail_first(scene, bad, support->name, "file", text));
  PetscCall(PetscFree(table.rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What files say, from the pieces' vertices to those that are here now. */
PetscErrorCode supports_file_move(Physics *physics)
{
  const Mesh  *mesh = physics->mesh;
  MPI_Datatype vector;
  PetscSF      sf;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Type_contiguous(3, MPIU_REAL, &vector));
  PetscCallMPI(MPI_Type_commit(&vector));
  PetscCall(pieces_fetch_create(mesh, mesh->n_points, mesh->original, &sf));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    Support   *support = &physics->supports[s];
    PetscReal *here;
    if (!support->from_file) continue;
    PetscCall(PetscMalloc1(3 * mesh->n_points, &here));
    PetscCall(PetscSFBcastBegin(sf, vector, support->given, here, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(sf, vector, support->given, here, MPI_REPLACE));
    PetscCall(PetscFree(support->given));
    support->given = here;
  }
  PetscCall(PetscSFDestroy(&sf));
  PetscCallMPI(MPI_Type_free(&vector));
  PetscFunctionReturn(PETSC_SUCCESS);
}
