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

/* The entries of a node's three rows that are above `least`, as columns of nodes and blocks of three by three, row after
 * row within a block. */
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

static PetscErrorCode read_block_row(Mat matrix, PetscInt node, PetscReal least, BlockRow *row)
{
  const PetscScalar *values;
  const PetscInt    *columns;
  PetscInt           n, place;
  PetscFunctionBegin;
  row->n = 0;
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

/* The largest entry. */
static PetscErrorCode largest_entry(Mat matrix, PetscReal *largest)
{
  const PetscScalar *values;
  PetscInt           begin, end, n;
  PetscFunctionBegin;
  *largest = 0;
  PetscCall(MatGetOwnershipRange(matrix, &begin, &end));
  for (PetscInt row = begin; row < end; row++) {
    PetscCall(MatGetRow(matrix, row, &n, NULL, &values));
    for (PetscInt k = 0; k < n; k++)
      *largest = PetscMax(*largest, PetscAbsScalar(values[k]));
    PetscCall(MatRestoreRow(matrix, row, &n, NULL, &values));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode node_blocks_squeeze(Mat from, PetscReal least, Mat *to)
{
  PetscInt  begin, end, n, *inside, *outside;
  PetscReal largest;
  BlockRow  row = {0};
  PetscFunctionBegin;
  PetscCall(largest_entry(from, &largest));
  PetscCall(MatGetOwnershipRange(from, &begin, &end));
  PetscCall(MatGetLocalSize(from, &n, NULL));
  PetscCall(PetscCalloc2(n / 3, &inside, n / 3, &outside));
  for (PetscInt node = begin / 3; node < end / 3; node++) {
    PetscCall(read_block_row(from, node, least * largest, &row));
    for (PetscInt k = 0; k < row.n; k++)
      (row.columns[k] >= begin / 3 && row.columns[k] < end / 3 ? inside : outside)[node - begin / 3]++;
  }
  PetscCall(MatCreate(PETSC_COMM_WORLD, to));
  PetscCall(MatSetSizes(*to, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetBlockSize(*to, 3));
  PetscCall(MatSetType(*to, MATAIJ));
  PetscCall(MatXAIJSetPreallocation(*to, 3, inside, outside, NULL, NULL));
  for (PetscInt node = begin / 3; node < end / 3; node++) {
    PetscCall(read_block_row(from, node, least * largest, &row));
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

/* v has no part along the others before it, and length 1; false: it has nothing else. */
static PetscErrorCode orthonormalise(PetscInt n, Vec others[], Vec v, PetscBool *independent)
{
  PetscScalar products[6];
  PetscReal   before, after;
  PetscFunctionBegin;
  PetscCall(VecNorm(v, NORM_2, &before));
  for (int twice = 0; twice < 2; twice++) {
    PetscCall(VecMDot(v, n, others, products));
    for (PetscInt k = 0; k < n; k++)
      products[k] = -products[k];
    PetscCall(VecMAXPY(v, n, products, others));
  }
  PetscCall(VecNorm(v, NORM_2, &after));
  *independent = (PetscBool)(after > PETSC_SQRT_MACHINE_EPSILON * before);
  if (*independent) PetscCall(VecScale(v, 1 / after));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode node_blocks_modes(const NodeBlocks *blocks, Mat constrained, Mat matrix)
{
  MatNullSpace rigid, modes;
  const Vec   *given;
  PetscInt     n, n_kept = 0;
  Vec          kept[6], equations, along;
  PetscFunctionBegin;
  PetscCall(MatNullSpaceCreateRigidBody(blocks->coordinates, &rigid));
  PetscCall(MatNullSpaceGetVecs(rigid, NULL, &n, &given));
  PetscCall(MatCreateVecs(blocks->place, NULL, &equations));
  PetscCall(VecDuplicate(equations, &along));
  for (PetscInt k = 0; k < n; k++) {
    PetscBool independent;
    PetscCall(VecDuplicate(given[k], &kept[n_kept]));
    PetscCall(MatMult(blocks->place, given[k], equations));
    if (constrained) PetscCall(MatMult(constrained, equations, along));
    if (constrained) PetscCall(VecAXPY(equations, -1, along));
    PetscCall(MatMultTranspose(blocks->place, equations, kept[n_kept]));
    PetscCall(orthonormalise(n_kept, kept, kept[n_kept], &independent));
    if (independent) n_kept++;
    else PetscCall(VecDestroy(&kept[n_kept]));
  }
  if (n_kept) { /* else contact holds every node that is free: constraints are all that is left, and multigrid has no modes to know */
    PetscCall(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, n_kept, kept, &modes));
    PetscCall(MatSetNearNullSpace(matrix, modes));
    PetscCall(MatNullSpaceDestroy(&modes));
  }
  for (PetscInt k = 0; k < n_kept; k++)
    PetscCall(VecDestroy(&kept[k]));
  PetscCall(MatNullSpaceDestroy(&rigid));
  PetscCall(VecDestroy(&equations));
  PetscCall(VecDestroy(&along));
  PetscFunctionReturn(PETSC_SUCCESS);
}
