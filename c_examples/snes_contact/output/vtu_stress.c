/* Cauchy's stress in a VTU file, at the centres of cells and at nodes. */
#include "output/output.h"

static PetscReal von_mises(const PetscReal s[9])
{
  return PetscSqrtReal(0.5 * (PetscSqr(s[0] - s[4]) + PetscSqr(s[4] - s[8]) + PetscSqr(s[8] - s[0])) +
                       3 * (PetscSqr(s[1]) + PetscSqr(s[5]) + PetscSqr(s[2])));
}

/* n stresses, 9 each: their components, then von Mises' equivalents */
static void write(FILE *file, PetscInt n, const PetscReal *stresses)
{
  vtu_start_array(file, "Float64", "stress_xx_yy_zz_xy_yz_xz", 6);
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal *s = stresses + 9 * k;
    fprintf(file, "%.6g %.6g %.6g %.6g %.6g %.6g\n", (double)s[0], (double)s[4], (double)s[8], (double)s[1], (double)s[5],
            (double)s[2]);
  }
  vtu_end_array(file);
  vtu_start_array(file, "Float64", "von_mises", 1);
  for (PetscInt k = 0; k < n; k++)
    fprintf(file, "%.6g\n", (double)von_mises(stresses + 9 * k));
  vtu_end_array(file);
}

static void nodes_of(const Mesh *mesh, PetscInt c, const PetscScalar *displacements, PetscReal X[], PetscReal u[])
{
  const PetscInt *cell = mesh->cell_vertices + mesh->cell_offsets[c];
  for (PetscInt k = 0; k < 3 * (mesh->cell_offsets[c + 1] - mesh->cell_offsets[c]); k++) {
    X[k] = mesh->coordinates[3 * cell[k / 3] + k % 3];
    u[k] = PetscRealPart(displacements[3 * cell[k / 3] + k % 3]);
  }
}

/* `n_drawn`: cells, and beyond those that are faces of rigid bodies, which have none */
PetscErrorCode vtu_cell_stresses(FILE *file, const Mesh *mesh, const Material *materials, const PetscScalar *displacements,
                                 PetscInt n_drawn)
{
  PetscReal *stresses;
  PetscInt   n = 0;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(9 * n_drawn, &stresses));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    PetscReal X[3 * CELL_NODES], u[3 * CELL_NODES];
    if (mesh->bodies[mesh->cell_body[c]].rigid) continue;
    nodes_of(mesh, c, displacements, X, u);
    cell_centre_stress(mesh_cell_kind(mesh, c), &mesh->space, &materials[mesh->cell_body[c]], X, u, stresses + 9 * n++);
  }
  write(file, n_drawn, stresses);
  PetscCall(PetscFree(stresses));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mean of the cells around a node, which are of one body. */
PetscErrorCode vtu_nodal_stresses(FILE *file, const Mesh *mesh, const Material *materials, const PetscScalar *displacements)
{
  PetscReal *stresses;
  PetscInt  *count;
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(9 * mesh->n_vertices, &stresses, mesh->n_vertices, &count));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt *cell = mesh->cell_vertices + mesh->cell_offsets[c];
    const CellKind  kind = mesh_cell_kind(mesh, c);
    PetscReal       X[3 * CELL_NODES], u[3 * CELL_NODES], of_cell[9 * CELL_NODES];
    if (mesh->bodies[mesh->cell_body[c]].rigid) continue;
    nodes_of(mesh, c, displacements, X, u);
    cell_nodal_stresses(kind, &mesh->space, &materials[mesh->cell_body[c]], X, u, of_cell);
    for (PetscInt k = 0; k < 9 * cell_nodes(kind); k++)
      stresses[9 * cell[k / 9] + k % 9] += of_cell[k];
    for (PetscInt a = 0; a < cell_nodes(kind); a++)
      count[cell[a]]++;
  }
  for (PetscInt k = 0; k < 9 * mesh->n_vertices; k++)
    stresses[k] /= (PetscReal)PetscMax(count[k / 9], 1);
  write(file, mesh->n_vertices, stresses);
  PetscCall(PetscFree2(stresses, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}
