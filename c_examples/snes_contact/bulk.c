/* The bodies: this rank's cells, their internal forces and stiffness. */
#include "model.h"

/* How many roundings meet in a force: of displacements, gradients and sums, of several cells and points. */
static const PetscReal ROUNDINGS = 2;

/* of a cell at rest: the largest diagonal entry */
static PetscErrorCode cell_stiffness(const Material *material, PetscInt n, const PetscReal X[], PetscReal *stiffness)
{
  const PetscReal at_rest[24] = {0};
  PetscReal       f[24], K[24 * 24];
  PetscBool       inverted;
  PetscFunctionBegin;
  PetscCall(cell_forces(n, material, X, at_rest, f, K, &inverted));
  *stiffness = 0;
  for (PetscInt k = 0; k < 3 * n; k++)
    *stiffness = PetscMax(*stiffness, K[(3 * n + 1) * k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_create(Model *model)
{
  PetscInt           cStart, cEnd, n_corners = 0;
  DMLabel            body;
  PetscSection       coordinate_section;
  Vec                coordinate_vector;
  const PetscScalar *coordinates;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(model->dm, 0, &cStart, &cEnd));
  PetscCall(DMGetLabel(model->dm, "body", &body));
  PetscCall(DMGetCoordinateSection(model->dm, &coordinate_section));
  PetscCall(DMGetCoordinatesLocal(model->dm, &coordinate_vector));
  PetscCall(VecGetArrayRead(coordinate_vector, &coordinates));
  model->n_cells = cEnd - cStart;
  PetscCall(PetscMalloc6(model->n_cells + 1, &model->cell_offsets, 8 * model->n_cells, &model->cell_dofs,
                         model->n_cells, &model->cell_body, model->n_cells, &model->cell_part, 24 * model->n_cells,
                         &model->cell_X, model->n_cells, &model->cell_stiffness));
  model->cell_offsets[0] = 0;
  for (PetscInt c = cStart; c < cEnd; c++) {
    PetscInt      *closure = NULL, size, corners[8], n = 0, at;
    DMPolytopeType type;
    PetscCall(DMPlexGetTransitiveClosure(model->dm, c, PETSC_TRUE, &size, &closure));
    for (PetscInt k = 0; k < size; k++) {
      if (closure[2 * k] >= model->vStart && closure[2 * k] < model->vEnd) corners[n++] = closure[2 * k];
    }
    PetscCall(DMPlexRestoreTransitiveClosure(model->dm, c, PETSC_TRUE, &size, &closure));
    PetscCall(DMPlexGetCellType(model->dm, c, &type));
    PetscCall(DMPlexInvertCell(type, corners)); /* to VTK's order */
    PetscCall(DMLabelGetValue(body, c, &model->cell_body[c - cStart]));
    model->cell_part[c - cStart] = model->vertex_part[corners[0] - model->vStart];
    for (PetscInt a = 0; a < n; a++) {
      PetscCall(PetscSectionGetOffset(model->section, corners[a], &model->cell_dofs[n_corners + a]));
      PetscCall(PetscSectionGetOffset(coordinate_section, corners[a], &at));
      for (int i = 0; i < 3; i++)
        model->cell_X[3 * (n_corners + a) + i] = PetscRealPart(coordinates[at + i]);
    }
    PetscCall(cell_stiffness(&model->mesh.bodies[model->cell_body[c - cStart]].material, n,
                             model->cell_X + 3 * n_corners, &model->cell_stiffness[c - cStart]));
    n_corners += n;
    model->cell_offsets[c - cStart + 1] = n_corners;
  }
  PetscCall(VecRestoreArrayRead(coordinate_vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* displacements of the corners of one cell */
static void cell_displacements(const Model *model, PetscInt c, const PetscScalar *u, PetscReal u_cell[])
{
  for (PetscInt k = model->cell_offsets[c]; k < model->cell_offsets[c + 1]; k++) {
    for (int i = 0; i < 3; i++)
      *u_cell++ = PetscRealPart(u[model->cell_dofs[k] + i]);
  }
}

/* All ranks learn whether this or another one has an inverted cell (c, or -1); model->inverted names the first. */
static PetscErrorCode agree_on_inverted(Model *model, PetscInt c, PetscInt *status)
{
  PetscMPIInt size, first;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  first = c < 0 ? size : model->rank;
  if (size > 1) {
    PetscMPIInt mine = first;
    PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  }
  *status = first < size;
  if (!*status) PetscFunctionReturn(PETSC_SUCCESS);
  if (model->rank == first) {
    const PetscInt n         = model->cell_offsets[c + 1] - model->cell_offsets[c];
    PetscReal      centre[3] = {0, 0, 0};
    for (PetscInt k = 0; k < 3 * n; k++)
      centre[k % 3] += model->cell_X[3 * model->cell_offsets[c] + k] / (PetscReal)n;
    PetscCall(PetscSNPrintf(model->inverted, sizeof(model->inverted),
                            "a cell of '%s' is turned inside out, the one about [%g, %g, %g] in the undeformed body",
                            model->mesh.bodies[model->cell_body[c]].name, (double)centre[0], (double)centre[1],
                            (double)centre[2]));
  }
  PetscCallMPI(MPI_Bcast(model->inverted, sizeof(model->inverted), MPI_CHAR, first, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rounding: a displacement's last digit, times a stiffness, is a force. It is what is left of a body that moves without
 * stress. An iterate that runs away must not loosen the test: a displacement counts up to the size of all that
 * contact may join to the part. */
static PetscReal squared_rounding(const Model *model, PetscInt c, PetscInt n, const PetscReal u_cell[])
{
  PetscReal largest = 0;
  for (PetscInt k = 0; k < 3 * n; k++)
    largest = PetscMax(largest, PetscAbsReal(u_cell[k]));
  return n * PetscSqr(ROUNDINGS * PETSC_MACHINE_EPSILON * PetscMin(largest, model->parts[model->cell_part[c]].reach) *
                      model->cell_stiffness[c]);
}

PetscErrorCode bulk_forces(Model *model, Vec f_local, PetscInt *status)
{
  const PetscScalar *u;
  PetscScalar       *f;
  PetscLogDouble     start, end;
  PetscInt           first_inverted = -1;

  PetscFunctionBegin;
  PetscCall(PetscTime(&start));
  PetscCall(VecGetArrayRead(model->u_local, &u));
  PetscCall(VecGetArray(f_local, &f));
  for (PetscInt c = 0; c < model->n_cells && first_inverted < 0; c++) {
    const PetscInt *dofs = model->cell_dofs + model->cell_offsets[c],
                   n     = model->cell_offsets[c + 1] - model->cell_offsets[c];
    PetscReal u_cell[24], f_cell[24];
    PetscBool inverted;
    cell_displacements(model, c, u, u_cell);
    PetscCall(cell_forces(n, &model->mesh.bodies[model->cell_body[c]].material,
                          model->cell_X + 3 * model->cell_offsets[c], u_cell, f_cell, NULL, &inverted));
    if (inverted) first_inverted = c;
    model->squares[N_SQUARES * model->cell_part[c] + SQUARES_ROUNDING] += squared_rounding(model, c, n, u_cell);
    for (PetscInt a = 0; a < n; a++) {
      for (int i = 0; i < 3; i++)
        f[dofs[a] + i] += f_cell[3 * a + i];
    }
  }
  PetscCall(VecRestoreArray(f_local, &f));
  PetscCall(VecRestoreArrayRead(model->u_local, &u));
  PetscCall(agree_on_inverted(model, first_inverted, status));
  PetscCall(PetscTime(&end));
  model->timers.bulk_assembly += end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K of one cell into the matrix; rows and columns of prescribed displacements, with negative equations, are left out */
static PetscErrorCode insert(const Model *model, PetscInt c, const PetscReal K[], Mat matrix)
{
  const PetscInt *dofs = model->cell_dofs + model->cell_offsets[c],
                 n     = model->cell_offsets[c + 1] - model->cell_offsets[c];
  PetscInt equations[24];
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3 * n; k++)
    equations[k] = model->equations[dofs[k / 3] + k % 3];
  PetscCall(MatSetValues(matrix, 3 * n, equations, 3 * n, equations, K, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_stiffness(Model *model, Mat matrix, PetscInt *status)
{
  const PetscScalar *u;
  PetscLogDouble     start, end;
  PetscInt           first_inverted = -1;

  PetscFunctionBegin;
  PetscCall(PetscTime(&start));
  PetscCall(VecGetArrayRead(model->u_local, &u));
  for (PetscInt c = 0; c < model->n_cells && first_inverted < 0; c++) {
    PetscReal u_cell[24], f_cell[24], K[24 * 24];
    PetscBool inverted;
    cell_displacements(model, c, u, u_cell);
    PetscCall(cell_forces(model->cell_offsets[c + 1] - model->cell_offsets[c],
                          &model->mesh.bodies[model->cell_body[c]].material,
                          model->cell_X + 3 * model->cell_offsets[c], u_cell, f_cell, K, &inverted));
    if (inverted) first_inverted = c;
    PetscCall(insert(model, c, K, matrix));
  }
  PetscCall(VecRestoreArrayRead(model->u_local, &u));
  PetscCall(agree_on_inverted(model, first_inverted, status));
  PetscCall(PetscTime(&end));
  model->timers.bulk_assembly += end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the bodies of finite strain, as if they were linear: stiffness K, and forces K u of the displacements u. */
PetscErrorCode bulk_extension(Model *model, Vec u_local, Vec f_local, Mat matrix)
{
  const Material     likeness = {.young = 1, .poisson = 0.3, .law = &MATERIAL_LINEAR};
  const PetscScalar *u;
  PetscScalar       *f;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(u_local, &u));
  PetscCall(VecGetArray(f_local, &f));
  for (PetscInt c = 0; c < model->n_cells; c++) {
    const PetscInt first = model->cell_offsets[c], n = model->cell_offsets[c + 1] - first;
    PetscReal      u_cell[24], f_cell[24], K[24 * 24];
    PetscBool      inverted;
    if (!model->mesh.bodies[model->cell_body[c]].material.law->finite) continue;
    cell_displacements(model, c, u, u_cell);
    PetscCall(cell_forces(n, &likeness, model->cell_X + 3 * first, u_cell, f_cell, K, &inverted));
    PetscCall(insert(model, c, K, matrix));
    for (PetscInt k = 0; k < 3 * n; k++)
      f[model->cell_dofs[first + k / 3] + k % 3] += f_cell[k];
  }
  PetscCall(VecRestoreArray(f_local, &f));
  PetscCall(VecRestoreArrayRead(u_local, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_pattern(Model *model, Mat matrix)
{
  const PetscReal zeros[24 * 24] = {0};
  PetscFunctionBegin;
  for (PetscInt c = 0; c < model->n_cells; c++)
    PetscCall(insert(model, c, zeros, matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}
