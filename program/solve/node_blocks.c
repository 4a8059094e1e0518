/* Systems with three rows for every node, as multigrid wants them, of systems that have rows for equations alone. Nodes are
 * those of a rank's own; prescribed components have rows of the identity, and so have those of rigid bodies. */
#include "solve/node_blocks.h"

/* The first local entry of each node that this rank owns, and whether it is a rigid body's. */
static PetscErrorCode own_nodes(const Physics *physics, PetscInt *n, PetscInt **offsets, PetscBool **rigid)
{
  const Mesh *mesh = physics->mesh;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->n_points, offsets));
  PetscCall(PetscMalloc1(mesh->n_points, rigid));
  *n = 0;
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    if (physics->unknowns.ghost[k]) continue;
    (*rigid)[*n] = (PetscBool)(rigids_of_vertex(physics, mesh->original[k]) >= 0);
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, mesh->points[k], &(*offsets)[(*n)++]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Their coordinates, which the cells have. */
static PetscErrorCode fill_coordinates(const Physics *physics, PetscInt n, const PetscInt offsets[], Vec coordinates)
{
  const Cells *cells = &physics->cells;
  PetscInt    *node;
  PetscScalar *x;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(physics->unknowns.n_local + 1, &node));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    node[k] = -1;
  for (PetscInt k = 0; k < n; k++)
    node[offsets[k]] = k;
  PetscCall(VecGetArray(coordinates, &x));
  for (PetscInt k = 0; k < cells->offsets[cells->n]; k++) {
    const PetscInt here = node[cells->dofs[k]];
    for (int i = 0; i < 3 && here >= 0; i++)
      x[3 * here + i] = cells->X[3 * k + i];
  }
  PetscCall(VecRestoreArray(coordinates, &x));
  PetscCall(PetscFree(node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode node_blocks_create(const Physics *physics, Mat like, NodeBlocks *blocks)
{
  PetscInt    n, *offsets, n_rows, first;
  PetscBool  *rigid;
  PetscScalar one = 1;
  PetscFunctionBegin;
  PetscCall(own_nodes(physics, &n, &offsets, &rigid));
  PetscCall(MatGetLocalSize(like, &n_rows, NULL));
  PetscCall(VecCreate(PETSC_COMM_WORLD, &blocks->coordinates));
  PetscCall(VecSetSizes(blocks->coordinates, 3 * n, PETSC_DETERMINE));
  PetscCall(VecSetBlockSize(blocks->coordinates, 3));
  PetscCall(VecSetType(blocks->coordinates, VECSTANDARD));
  PetscCall(fill_coordinates(physics, n, offsets, blocks->coordinates));
  PetscCall(VecDuplicate(blocks->coordinates, &blocks->prescribed));
  PetscCall(VecSet(blocks->prescribed, 1));
  PetscCall(VecGetOwnershipRange(blocks->coordinates, &first, NULL));
  PetscCall(MatCreateAIJ(PETSC_COMM_WORLD, n_rows, 3 * n, PETSC_DETERMINE, PETSC_DETERMINE, 1, NULL, 0, NULL,
                         &blocks->place));
  for (PetscInt k = 0; k < 3 * n; k++) {
    const PetscInt equation = physics->unknowns.equations[offsets[k / 3] + k % 3];
    if (equation < 0 || rigid[k / 3]) continue;
    PetscCall(MatSetValue(blocks->place, equation, first + k, one, INSERT_VALUES));
    PetscCall(VecSetValue(blocks->prescribed, first + k, 0, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(blocks->place, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(blocks->place, MAT_FINAL_ASSEMBLY));
  PetscCall(VecAssemblyBegin(blocks->prescribed));
  PetscCall(VecAssemblyEnd(blocks->prescribed));
  PetscCall(PetscFree(offsets));
  PetscCall(PetscFree(rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode node_blocks_destroy(NodeBlocks *blocks)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&blocks->coordinates));
  PetscCall(VecDestroy(&blocks->prescribed));
  PetscCall(MatDestroy(&blocks->place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The entries of a node's three rows that are above `least` times the largest of them, as columns of nodes and blocks of three by three, row
 * after row within a block. */
typedef struct {
  PetscInt     capacity, n, *columns;
  PetscScalar *values;
} BlockRow;

static PetscErrorCode reserve(BlockRow *row, PetscInt more)
{
  PetscFunctionBegin;
  if (row->n + more <= row->capacity) PetscFunctionReturn(PETSC_SUCCESS);
  row->capacity = 2 * (row->n + more);
  PetscCall(PetscRealloc(sizeof(*row->columns) * row->capacity, &row->columns));
  PetscCall(PetscRealloc(9 * sizeof(*row->values) * row->capacity, &row->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode largest_entry(Mat matrix, PetscInt node, PetscReal *largest)
{
  const PetscScalar *values;
  PetscInt           n;
  PetscFunctionBegin;
  *largest = 0;
  for (int i = 0; i < 3; i++) {
    PetscCall(MatGetRow(matrix, 3 * node + i, &n, NULL, &values));
    for (PetscInt k = 0; k < n; k++)
      *largest = PetscMax(*largest, PetscAbsScalar(values[k]));
    PetscCall(MatRestoreRow(matrix, 3 * node + i, &n, NULL, &values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode read_block_row(Mat matrix, PetscInt node, PetscReal least, BlockRow *row)
{
  const PetscScalar *values;
  const PetscInt    *columns;
  PetscInt           n, place;
  PetscReal          largest;
  PetscFunctionBegin;
  row->n = 0;
  PetscCall(largest_entry(matrix, node, &largest));
  least *= largest;
  for (int i = 0; i < 3; i++) {
    PetscCall(MatGetRow(matrix, 3 * node + i, &n, &columns, &values));
    PetscCall(reserve(row, n + 1));
    for (PetscInt k = 0; k < n; k++) {
      if (PetscAbsScalar(values[k]) > least) row->columns[row->n++] = columns[k] / 3;
    }
    PetscCall(MatRestoreRow(matrix, 3 * node + i, &n, &columns, &values));
    row->columns[row->n++] = node;
    PetscCall(PetscSortRemoveDupsInt(&row->n, row->columns));
  }
  PetscCall(PetscArrayzero(row->values, 9 * row->n));
  for (int i = 0; i < 3; i++) {
    PetscCall(MatGetRow(matrix, 3 * node + i, &n, &columns, &values));
    for (PetscInt k = 0; k < n; k++) {
      if (PetscAbsScalar(values[k]) <= least) continue;
      PetscCall(PetscFindInt(columns[k] / 3, row->n, row->columns, &place));
      row->values[9 * place + 3 * i + columns[k] % 3] = values[k];
    }
    PetscCall(MatRestoreRow(matrix, 3 * node + i, &n, &columns, &values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode squeeze(Mat from, PetscReal least, Mat *to)
{
  PetscInt begin, end, n, *inside, *outside;
  BlockRow row = {0};
  PetscFunctionBegin;
  PetscCall(MatGetOwnershipRange(from, &begin, &end));
  PetscCall(MatGetLocalSize(from, &n, NULL));
  PetscCall(PetscCalloc2(n / 3, &inside, n / 3, &outside));
  for (PetscInt node = begin / 3; node < end / 3; node++) {
    PetscCall(read_block_row(from, node, least, &row));
    for (PetscInt k = 0; k < row.n; k++)
      (row.columns[k] >= begin / 3 && row.columns[k] < end / 3 ? inside : outside)[node - begin / 3]++;
  }
  PetscCall(MatCreate(PETSC_COMM_WORLD, to));
  PetscCall(MatSetSizes(*to, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetBlockSize(*to, 3));
  PetscCall(MatSetType(*to, MATAIJ));
  PetscCall(MatXAIJSetPreallocation(*to, 3, inside, outside, NULL, NULL));
  for (PetscInt node = begin / 3; node < end / 3; node++) {
    PetscCall(read_block_row(from, node, least, &row));
    for (PetscInt k = 0; k < row.n; k++)
      PetscCall(MatSetValuesBlocked(*to, 1, &node, 1, &row.columns[k], row.values + 9 * k, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(*to, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*to, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree2(inside, outside));
  PetscCall(PetscFree(row.columns));
  PetscCall(PetscFree(row.values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* an entry of the diagonal */
static PetscErrorCode typical_entry(Mat matrix, PetscReal *typical)
{
  Vec      diagonal;
  PetscInt n;
  PetscFunctionBegin;
  PetscCall(MatCreateVecs(matrix, &diagonal, NULL));
  PetscCall(MatGetDiagonal(matrix, diagonal));
  PetscCall(VecNorm(diagonal, NORM_1, typical));
  PetscCall(VecGetSize(diagonal, &n));
  *typical /= PetscMax(n, 1);
  PetscCall(VecDestroy(&diagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode node_blocks_matrix(const NodeBlocks *blocks, Mat from, PetscReal least, Mat *to)
{
  PetscReal typical;
  Vec       prescribed;
  PetscFunctionBegin;
  PetscCall(typical_entry(from, &typical));
  PetscCall(squeeze(from, least, to));
  PetscCall(VecDuplicate(blocks->prescribed, &prescribed));
  PetscCall(VecCopy(blocks->prescribed, prescribed));
  PetscCall(VecScale(prescribed, typical));
  PetscCall(MatDiagonalSet(*to, prescribed, ADD_VALUES));
  PetscCall(VecDestroy(&prescribed));
  PetscFunctionReturn(PETSC_SUCCESS);
}
