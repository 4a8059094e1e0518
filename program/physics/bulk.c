/* The bodies: this rank's cells, their internal forces and stiffness. */
#include "physics/physics.h"

/* How many roundings meet in a force: of displacements, gradients and sums, of several cells and points. */
static const PetscReal ROUNDINGS = 2;

/* Cells of rigid bodies have no stiffness; they hold their vertices together. */
static PetscBool is_rigid(const Physics *physics, PetscInt c)
{
  return physics->mesh->bodies[physics->cells.body[c]].rigid;
}

static CellKind kind_of(const Physics *physics, PetscInt c)
{
  return cell_kind(physics->mesh->dimension, physics->cells.offsets[c + 1] - physics->cells.offsets[c]);
}

Element bulk_element(const Physics *physics, PetscInt c)
{
  const Cells   *cells = &physics->cells;
  const PetscInt first = cells->offsets[c];
  return (Element){.kind = kind_of(physics, c), .space = &physics->mesh->space, .material = &physics->materials[cells->body[c]],
                   .X = cells->X + 3 * first, .swell = cells->swell ? cells->swell + first : NULL};
}

/* of a cell at rest: the largest diagonal entry */
static PetscErrorCode cell_stiffness(const Element *element, PetscReal *stiffness)
{
  const PetscReal at_rest[3 * CELL_NODES] = {0};
  const PetscInt  n                       = cell_nodes(element->kind);
  PetscReal       f[3 * CELL_NODES], K[9 * CELL_NODES * CELL_NODES];
  PetscBool       inverted;
  PetscFunctionBegin;
  PetscCall(cell_forces(element, at_rest, f, K, &inverted));
  *stiffness = 0;
  for (PetscInt k = 0; k < 3 * n; k++)
    *stiffness = PetscMax(*stiffness, K[(3 * n + 1) * k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_create(Physics *physics)
{
  const Mesh        *mesh  = physics->mesh;
  Cells             *cells = &physics->cells;
  PetscInt           cStart, cEnd, n_nodes = 0;
  DMLabel            body;
  PetscSection       coordinate_section;
  Vec                coordinate_vector;
  const PetscScalar *coordinates;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &cStart, &cEnd));
  PetscCall(DMGetLabel(mesh->dm, "body", &body));
  PetscCall(DMGetCoordinateSection(mesh->dm, &coordinate_section));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &coordinate_vector));
  PetscCall(VecGetArrayRead(coordinate_vector, &coordinates));
  cells->n = cEnd - cStart;
  PetscCall(PetscMalloc6(cells->n + 1, &cells->offsets, CELL_NODES * cells->n, &cells->dofs,
                         cells->n, &cells->body, cells->n, &cells->part, 3 * CELL_NODES * cells->n,
                         &cells->X, cells->n, &cells->stiffness));
  cells->offsets[0] = 0;
  for (PetscInt c = cStart; c < cEnd; c++) {
    PetscInt nodes[CELL_NODES], n, at;
    PetscCall(plex_cell_nodes(mesh, c, &n, nodes));
    PetscCall(DMLabelGetValue(body, c, &cells->body[c - cStart]));
    cells->part[c - cStart] = physics->parts.of_vertex[mesh->here[nodes[0]]];
    for (PetscInt a = 0; a < n; a++) {
      PetscCall(PetscSectionGetOffset(physics->unknowns.section, nodes[a], &cells->dofs[n_nodes + a]));
      PetscCall(PetscSectionGetOffset(coordinate_section, nodes[a], &at));
      for (int i = 0; i < 3; i++)
        cells->X[3 * (n_nodes + a) + i] = PetscRealPart(coordinates[at + i]);
    }
    cells->offsets[c - cStart + 1] = n_nodes + n;
    if (!is_rigid(physics, c - cStart)) {
      const Element element = bulk_element(physics, c - cStart);
      PetscCall(cell_stiffness(&element, &cells->stiffness[c - cStart]));
    }
    n_nodes += n;
  }
  PetscCall(VecRestoreArrayRead(coordinate_vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* displacements of the nodes of one cell */
static void cell_displacements(const Physics *physics, PetscInt c, const PetscScalar *u, PetscReal u_cell[])
{
  const Cells *cells = &physics->cells;
  for (PetscInt k = cells->offsets[c]; k < cells->offsets[c + 1]; k++) {
    for (int i = 0; i < 3; i++)
      *u_cell++ = PetscRealPart(u[cells->dofs[k] + i]);
  }
}

/* All ranks learn whether this or another one has an inverted cell (c, or -1); physics->inverted names the first. */
static PetscErrorCode agree_on_inverted(Physics *physics, PetscInt c, PetscInt *status)
{
  const Mesh  *mesh  = physics->mesh;
  const Cells *cells = &physics->cells;
  PetscMPIInt  size, first;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  first = c < 0 ? size : mesh->rank;
  if (size > 1) {
    PetscMPIInt mine = first;
    PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  }
  *status = first < size;
  if (!*status) PetscFunctionReturn(PETSC_SUCCESS);
  if (mesh->rank == first) {
    const PetscInt n         = cells->offsets[c + 1] - cells->offsets[c];
    PetscReal      centre[3] = {0, 0, 0};
    for (PetscInt k = 0; k < 3 * n; k++)
      centre[k % 3] += cells->X[3 * cells->offsets[c] + k] / (PetscReal)n;
    PetscCall(PetscSNPrintf(physics->inverted, sizeof(physics->inverted),
                            "a cell of '%s' is turned inside out, the one about [%g, %g, %g] in the undeformed body",
                            mesh->bodies[cells->body[c]].name, (double)centre[0], (double)centre[1],
                            (double)centre[2]));
  }
  PetscCallMPI(MPI_Bcast(physics->inverted, sizeof(physics->inverted), MPI_CHAR, first, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rounding: a displacement's last digit, times a stiffness, is a force. It is what is left of a body that moves without
 * stress. An iterate that runs away must not loosen the test: a displacement counts up to the size of all that
 * contact may join to the part. */
static PetscReal squared_rounding(const Physics *physics, PetscInt c, PetscInt n, const PetscReal u_cell[])
{
  const Cells *cells   = &physics->cells;
  PetscReal    largest = 0;
  for (PetscInt k = 0; k < 3 * n; k++)
    largest = PetscMax(largest, PetscAbsReal(u_cell[k]));
  return n * PetscSqr(ROUNDINGS * PETSC_MACHINE_EPSILON * PetscMin(largest, physics->parts.part[cells->part[c]].reach) *
                      cells->stiffness[c]);
}

/* Displacements that cells are asked at; of a step NULL in statics, and where it has none */
typedef struct {
  const BulkStep    *step;
  const PetscScalar *u, *from, *to, *rate;
} View;

static PetscErrorCode look(const Physics *physics, const BulkStep *step, View *view)
{
  PetscFunctionBegin;
  *view = (View){.step = step};
  PetscCall(VecGetArrayRead(physics->u_local, &view->u));
  if (!step) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(step->from, &view->from));
  PetscCall(VecGetArrayRead(step->to, &view->to));
  if (step->rate) PetscCall(VecGetArrayRead(step->rate, &view->rate));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode looked(const Physics *physics, View *view)
{
  PetscFunctionBegin;
  if (view->rate) PetscCall(VecRestoreArrayRead(view->step->rate, &view->rate));
  if (view->to) PetscCall(VecRestoreArrayRead(view->step->to, &view->to));
  if (view->from) PetscCall(VecRestoreArrayRead(view->step->from, &view->from));
  PetscCall(VecRestoreArrayRead(physics->u_local, &view->u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u_cell: the displacements at u_local. K: NULL: not wanted */
static PetscErrorCode evaluate(const Physics *physics, PetscInt c, const View *view, PetscReal u_cell[], PetscReal f[], PetscReal K[], PetscBool *inverted)
{
  const Element element = bulk_element(physics, c);
  PetscReal     from[3 * CELL_NODES], to[3 * CELL_NODES], rate[3 * CELL_NODES];
  CellStep      of_cell;
  PetscFunctionBegin;
  cell_displacements(physics, c, view->u, u_cell);
  if (!view->step || !element.material->law->finite) {
    PetscCall(cell_forces(&element, u_cell, f, K, inverted));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  cell_displacements(physics, c, view->from, from);
  cell_displacements(physics, c, view->to, to);
  if (view->rate) cell_displacements(physics, c, view->rate, rate);
  of_cell = (CellStep){.from = from, .to = to, .rate = view->rate ? rate : NULL, .alpha_f = view->step->alpha_f, .ahead = view->step->ahead};
  PetscCall(cell_step_forces(&element, &of_cell, view->step->damping_only, f, K, inverted));
  for (PetscInt k = 0; K && k < PetscSqr(3 * cell_nodes(element.kind)); k++)
    K[k] /= view->step->linear;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_step_forces(Physics *physics, const BulkStep *step, Vec f_local, PetscInt *status)
{
  const Cells       *cells = &physics->cells;
  View               view;
  PetscScalar       *f;
  PetscLogDouble     start, end;
  PetscInt           first_inverted = -1;

  PetscFunctionBegin;
  PetscCall(PetscTime(&start));
  PetscCall(look(physics, step, &view));
  PetscCall(VecGetArray(f_local, &f));
  for (PetscInt c = 0; c < cells->n && first_inverted < 0; c++) {
    const PetscInt *dofs = cells->dofs + cells->offsets[c],
                   n     = cells->offsets[c + 1] - cells->offsets[c];
    PetscReal u_cell[3 * CELL_NODES], f_cell[3 * CELL_NODES], *squares = physics->parts.squares + N_SQUARES * cells->part[c];
    PetscBool inverted;
    if (is_rigid(physics, c)) continue;
    PetscCall(evaluate(physics, c, &view, u_cell, f_cell, NULL, &inverted));
    if (inverted) first_inverted = c;
    squares[SQUARES_ROUNDING] += squared_rounding(physics, c, n, u_cell);
    for (PetscInt k = 0; k < 3 * n; k++) {
      f[dofs[k / 3] + k % 3] += f_cell[k];
      squares[SQUARES_CARRIED] += PetscSqr(f_cell[k]);
    }
  }
  PetscCall(VecRestoreArray(f_local, &f));
  PetscCall(looked(physics, &view));
  PetscCall(agree_on_inverted(physics, first_inverted, status));
  if (physics->springs) PetscCall(springs_forces(physics, f_local));
  PetscCall(PetscTime(&end));
  physics->seconds += end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_forces(Physics *physics, Vec f_local, PetscInt *status)
{
  PetscFunctionBegin;
  PetscCall(bulk_step_forces(physics, NULL, f_local, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K of one cell into the matrix; rows and columns of prescribed displacements, with negative equations, are left out */
static PetscErrorCode insert(const Physics *physics, PetscInt c, const PetscReal K[], Mat matrix)
{
  const Cells    *cells = &physics->cells;
  const PetscInt *dofs  = cells->dofs + cells->offsets[c];
  const PetscInt  n     = cells->offsets[c + 1] - cells->offsets[c];
  PetscInt        equations[3 * CELL_NODES];
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3 * n; k++)
    equations[k] = physics->unknowns.equations[dofs[k / 3] + k % 3];
  PetscCall(MatSetValues(matrix, 3 * n, equations, 3 * n, equations, K, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_step_stiffness(Physics *physics, const BulkStep *step, Mat matrix, PetscInt *status)
{
  const Cells   *cells = &physics->cells;
  View           view;
  PetscLogDouble start, end;
  PetscInt       first_inverted = -1;

  PetscFunctionBegin;
  PetscCall(PetscTime(&start));
  PetscCall(look(physics, step, &view));
  for (PetscInt c = 0; c < cells->n && first_inverted < 0; c++) {
    PetscReal u_cell[3 * CELL_NODES], f_cell[3 * CELL_NODES], K[9 * CELL_NODES * CELL_NODES];
    PetscBool inverted;
    if (is_rigid(physics, c)) continue;
    PetscCall(evaluate(physics, c, &view, u_cell, f_cell, K, &inverted));
    if (inverted) first_inverted = c;
    PetscCall(insert(physics, c, K, matrix));
  }
  PetscCall(looked(physics, &view));
  PetscCall(agree_on_inverted(physics, first_inverted, status));
  if (physics->springs) PetscCall(springs_stiffness(physics, matrix));
  PetscCall(PetscTime(&end));
  physics->seconds += end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_stiffness(Physics *physics, Mat matrix, PetscInt *status)
{
  PetscFunctionBegin;
  PetscCall(bulk_step_stiffness(physics, NULL, matrix, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_stiffness_at_rest(Physics *physics, Mat matrix)
{
  const Vec now = physics->u_local;
  PetscInt  status;
  PetscFunctionBegin;
  PetscCall(VecDuplicate(now, &physics->u_local));
  PetscCall(VecZeroEntries(physics->u_local));
  PetscCall(bulk_stiffness(physics, matrix, &status));
  PetscCall(VecDestroy(&physics->u_local));
  physics->u_local = now;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the bodies of finite strain, as if they were linear: stiffness K, and forces K u of the displacements u. */
PetscErrorCode bulk_extension(Physics *physics, Vec u_local, Vec f_local, Mat matrix)
{
  const Cells       *cells    = &physics->cells;
  const Material     likeness = {.young = 1, .poisson = 0.3, .law = &MATERIAL_LINEAR};
  const PetscScalar *u;
  PetscScalar       *f;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(u_local, &u));
  PetscCall(VecGetArray(f_local, &f));
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt first = cells->offsets[c], n = cells->offsets[c + 1] - first;
    Element        element = bulk_element(physics, c);
    PetscReal      u_cell[3 * CELL_NODES], f_cell[3 * CELL_NODES], K[9 * CELL_NODES * CELL_NODES];
    PetscBool      inverted;
    if (!element.material->law->finite) continue;
    element.material = &likeness;
    element.swell    = NULL;
    cell_displacements(physics, c, u, u_cell);
    PetscCall(cell_forces(&element, u_cell, f_cell, K, &inverted));
    PetscCall(insert(physics, c, K, matrix));
    for (PetscInt k = 0; k < 3 * n; k++)
      f[cells->dofs[first + k / 3] + k % 3] += f_cell[k];
  }
  PetscCall(VecRestoreArray(f_local, &f));
  PetscCall(VecRestoreArrayRead(u_local, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_along(Physics *physics, Vec change, Vec f_local)
{
  const Cells       *cells = &physics->cells;
  const PetscScalar *du;
  PetscScalar       *f;
  View               view;
  PetscFunctionBegin;
  PetscCall(look(physics, NULL, &view));
  PetscCall(VecGetArrayRead(change, &du));
  PetscCall(VecGetArray(f_local, &f));
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt *dofs = cells->dofs + cells->offsets[c], n = 3 * (cells->offsets[c + 1] - cells->offsets[c]);
    PetscReal       u_cell[3 * CELL_NODES], f_cell[3 * CELL_NODES], K[9 * CELL_NODES * CELL_NODES];
    PetscBool       inverted;
    if (is_rigid(physics, c)) continue;
    PetscCall(evaluate(physics, c, &view, u_cell, f_cell, K, &inverted));
    cell_displacements(physics, c, du, u_cell);
    for (PetscInt k = 0; k < n * n; k++)
      f[dofs[k / n / 3] + k / n % 3] += K[k] * u_cell[k % n];
  }
  PetscCall(VecRestoreArray(f_local, &f));
  PetscCall(VecRestoreArrayRead(change, &du));
  PetscCall(looked(physics, &view));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_per_young(Physics *physics, PetscInt body, Vec f_local)
{
  const Cells *cells = &physics->cells;
  PetscScalar *f;
  View         view;
  PetscFunctionBegin;
  PetscCall(look(physics, NULL, &view));
  PetscCall(VecGetArray(f_local, &f));
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt *dofs = cells->dofs + cells->offsets[c], n = cells->offsets[c + 1] - cells->offsets[c];
    PetscReal       u_cell[3 * CELL_NODES], f_cell[3 * CELL_NODES];
    PetscBool       inverted;
    if (cells->body[c] != body) continue;
    PetscCall(evaluate(physics, c, &view, u_cell, f_cell, NULL, &inverted));
    for (PetscInt k = 0; k < 3 * n; k++)
      f[dofs[k / 3] + k % 3] += f_cell[k] / physics->materials[body].young;
  }
  PetscCall(VecRestoreArray(f_local, &f));
  PetscCall(looked(physics, &view));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_pattern(Physics *physics, Mat matrix)
{
  static const PetscReal zeros[9 * CELL_NODES * CELL_NODES];
  const Cells           *cells = &physics->cells;
  PetscFunctionBegin;
  for (PetscInt c = 0; c < cells->n; c++) {
    if (!is_rigid(physics, c)) PetscCall(insert(physics, c, zeros, matrix));
  }
  if (physics->springs) PetscCall(springs_pattern(physics, matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}
