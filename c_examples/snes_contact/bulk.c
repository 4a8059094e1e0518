/* The bodies: this rank's cells, their internal forces and stiffness. */
#include "model.h"

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
  PetscCall(PetscMalloc4(model->n_cells + 1, &model->cell_offsets, 8 * model->n_cells, &model->cell_dofs,
                         model->n_cells, &model->cell_body, 24 * model->n_cells, &model->cell_X));
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
    for (PetscInt a = 0; a < n; a++) {
      PetscCall(PetscSectionGetOffset(model->section, corners[a], &model->cell_dofs[n_corners + a]));
      PetscCall(PetscSectionGetOffset(coordinate_section, corners[a], &at));
      for (int i = 0; i < 3; i++)
        model->cell_X[3 * (n_corners + a) + i] = PetscRealPart(coordinates[at + i]);
    }
    n_corners += n;
    model->cell_offsets[c - cStart + 1] = n_corners;
  }
  PetscCall(VecRestoreArrayRead(coordinate_vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_forces(Model *model, Vec f_local)
{
  const PetscScalar *u;
  PetscScalar       *f;
  PetscLogDouble     start, end;

  PetscFunctionBegin;
  PetscCall(PetscTime(&start));
  PetscCall(VecGetArrayRead(model->u_local, &u));
  PetscCall(VecGetArray(f_local, &f));
  for (PetscInt c = 0; c < model->n_cells; c++) {
    const PetscInt *dofs = model->cell_dofs + model->cell_offsets[c],
                   n     = model->cell_offsets[c + 1] - model->cell_offsets[c];
    PetscReal u_cell[24], f_cell[24];
    for (PetscInt a = 0; a < n; a++) {
      for (int i = 0; i < 3; i++)
        u_cell[3 * a + i] = PetscRealPart(u[dofs[a] + i]);
    }
    PetscCall(cell_forces(n, &model->mesh.bodies[model->cell_body[c]].material,
                          model->cell_X + 3 * model->cell_offsets[c], u_cell, f_cell, NULL));
    for (PetscInt a = 0; a < n; a++) {
      for (int i = 0; i < 3; i++)
        f[dofs[a] + i] += f_cell[3 * a + i];
    }
  }
  PetscCall(VecRestoreArray(f_local, &f));
  PetscCall(VecRestoreArrayRead(model->u_local, &u));
  PetscCall(PetscTime(&end));
  model->timers.bulk_assembly += end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode bulk_stiffness(Model *model, Mat matrix, PetscBool pattern)
{
  const PetscScalar *u;
  PetscLogDouble     start, end;

  PetscFunctionBegin;
  PetscCall(PetscTime(&start));
  PetscCall(VecGetArrayRead(model->u_local, &u));
  for (PetscInt c = 0; c < model->n_cells; c++) {
    const PetscInt *dofs = model->cell_dofs + model->cell_offsets[c],
                   n     = model->cell_offsets[c + 1] - model->cell_offsets[c];
    PetscReal u_cell[24], f_cell[24], K[24 * 24] = {0};
    PetscInt  equations[24];
    for (PetscInt a = 0; a < n; a++) {
      for (int i = 0; i < 3; i++) {
        u_cell[3 * a + i]    = PetscRealPart(u[dofs[a] + i]);
        equations[3 * a + i] = model->equations[dofs[a] + i];
      }
    }
    if (!pattern)
      PetscCall(cell_forces(n, &model->mesh.bodies[model->cell_body[c]].material,
                            model->cell_X + 3 * model->cell_offsets[c], u_cell, f_cell, K));
    PetscCall(
        MatSetValues(matrix, 3 * n, equations, 3 * n, equations, K, ADD_VALUES)); /* negative equations are left out */
  }
  PetscCall(VecRestoreArrayRead(model->u_local, &u));
  PetscCall(PetscTime(&end));
  model->timers.bulk_assembly += end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}
