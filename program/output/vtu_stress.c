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

void vtu_declare_stresses(FILE *file)
{
  vtu_declare(file, "Float64", "stress_xx_yy_zz_xy_yz_xz", 6);
  vtu_declare(file, "Float64", "von_mises", 1);
}

/* What a cell that expands is pressed by; in plane stress nothing presses across. */
static void take_pressure(const Space *space, PetscReal pressure, PetscReal sigma[9])
{
  for (int i = 0; i < (space->kind == SPACE_PLANE_STRESS ? 2 : 3); i++)
    sigma[4 * i] -= pressure;
}

/* displacements and kind of a cell here */
static CellKind look_at(const Physics *physics, const Piece *piece, PetscInt c, PetscReal u[])
{
  const PetscInt first = physics->cells.offsets[c], n = physics->cells.offsets[c + 1] - first;
  for (PetscInt k = 0; k < 3 * n; k++)
    u[k] = PetscRealPart(piece->displacements[3 * piece->connectivity[first + k / 3] + k % 3]);
  return cell_kind(physics->mesh->dimension, n);
}

PetscErrorCode vtu_cell_stresses(FILE *file, const Heat *heat, const Physics *physics, const Piece *piece)
{
  PetscReal *stresses;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(9 * piece->n_cells, &stresses));
  for (PetscInt k = 0; k < piece->n_cells; k++) {
    const PetscInt c = piece->cells[k];
    PetscReal      u[3 * CELL_NODES];
    const CellKind kind    = look_at(physics, piece, c, u);
    const Element  element = bulk_element(physics, c);
    cell_centre_stress(&element, u, stresses + 9 * k);
    if (heat->two_way) {
      PetscReal centre[3], N[CELL_NODES], dN[CELL_NODES][3], push[CELL_NODES];
      cell_centre(kind, centre);
      cell_functions(kind, centre, N, dN);
      PetscCall(expansion_pressures(heat, c, push));
      for (PetscInt a = 0; a < cell_nodes(kind); a++)
        take_pressure(&physics->mesh->space, N[a] * push[a], stresses + 9 * k);
    }
  }
  write(file, piece->n_cells, stresses);
  PetscCall(PetscFree(stresses));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums of stresses and how many there are, 10 a vertex here: those of all ranks. */
static PetscErrorCode add_ranks(const Mesh *mesh, PetscReal sums[])
{
  enum { WIDTH = 10 };
  PetscSF    points;
  PetscReal *mine, *all;
  PetscInt   pEnd;
  PetscFunctionBegin;
  if (mesh->size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMGetPointSF(mesh->dm, &points));
  PetscCall(DMPlexGetChart(mesh->dm, NULL, &pEnd));
  PetscCall(PetscMalloc2(pEnd, &mine, pEnd, &all));
  for (int i = 0; i < WIDTH; i++) {
    PetscCall(PetscArrayzero(mine, pEnd));
    for (PetscInt k = 0; k < mesh->n_points; k++)
      mine[mesh->points[k]] = sums[WIDTH * k + i];
    PetscCall(PetscArraycpy(all, mine, pEnd));
    PetscCall(PetscSFReduceBegin(points, MPIU_REAL, mine, all, MPIU_SUM));
    PetscCall(PetscSFReduceEnd(points, MPIU_REAL, mine, all, MPIU_SUM));
    PetscCall(PetscArraycpy(mine, all, pEnd));
    PetscCall(PetscSFBcastBegin(points, MPIU_REAL, mine, all, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(points, MPIU_REAL, mine, all, MPI_REPLACE));
    for (PetscInt k = 0; k < mesh->n_points; k++)
      sums[WIDTH * k + i] = all[mesh->points[k]];
  }
  PetscCall(PetscFree2(mine, all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mean of the cells around a node, which are of one body. */
PetscErrorCode vtu_nodal_stresses(FILE *file, const Heat *heat, const Physics *physics, const Piece *piece)
{
  const Cells *cells = &physics->cells;
  PetscReal   *sums, *stresses;
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(10 * piece->n_points, &sums, 9 * piece->n_points, &stresses));
  for (PetscInt k = 0; k < piece->n_cells; k++) {
    const PetscInt c = piece->cells[k], first = cells->offsets[c];
    PetscReal      u[3 * CELL_NODES], of_cell[9 * CELL_NODES];
    const CellKind kind    = look_at(physics, piece, c, u);
    const Element  element = bulk_element(physics, c);
    cell_nodal_stresses(&element, u, of_cell);
    if (heat->two_way) {
      PetscReal push[CELL_NODES];
      PetscCall(expansion_pressures(heat, c, push));
      for (PetscInt a = 0; a < cell_nodes(kind); a++)
        take_pressure(&physics->mesh->space, push[a], of_cell + 9 * a);
    }
    for (PetscInt a = 0; a < cell_nodes(kind); a++) {
      PetscReal *sum = sums + 10 * piece->order[piece->connectivity[first + a]];
      for (int i = 0; i < 9; i++)
        sum[i] += of_cell[9 * a + i];
      sum[9]++;
    }
  }
  PetscCall(add_ranks(physics->mesh, sums));
  for (PetscInt k = 0; k < 9 * piece->n_points; k++) {
    const PetscReal *sum = sums + 10 * piece->order[k / 9];
    stresses[k]          = sum[k % 9] / PetscMax(sum[9], 1);
  }
  write(file, piece->n_points, stresses);
  PetscCall(PetscFree2(sums, stresses));
  PetscFunctionReturn(PETSC_SUCCESS);
}
