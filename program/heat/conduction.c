/* The bodies: conduction and storage of heat in each cell, and what flows in through faces. In the undeformed configuration; stored heat by
 * the implicit Euler method.
 *
 * leaves_a = int k dN_a . grad T + c N_a (T - T_n) / dt dV - int N_a q dA */
#include "heat/heat.h"

PetscReal conduction_point(CellKind kind, const Space *space, const PetscReal X[], PetscInt q, PetscReal N[],
                          PetscReal dN[][3], PetscReal *radius)
{
  PetscReal xi[3], weight = cell_quadrature_point(kind, q, xi);
  cell_functions(kind, xi, N, dN);
  weight *= cell_physical_gradients(kind, X, dN);
  *radius = 0;
  for (PetscInt a = 0; a < cell_nodes(kind); a++)
    *radius += N[a] * X[3 * a];
  return weight * space_measure(space, *radius);
}

static void cell_matrices(CellKind kind, const Space *space, const Conductor *of, const PetscReal X[], PetscReal dt,
                          PetscReal K[], PetscReal M[])
{
  const PetscInt n = cell_nodes(kind);
  for (PetscInt k = 0; k < n * n; k++)
    K[k] = M[k] = 0;
  for (PetscInt q = 0; q < cell_quadrature_points(kind); q++) {
    PetscReal       N[CELL_NODES], dN[CELL_NODES][3], radius;
    const PetscReal volume = conduction_point(kind, space, X, q, N, dN, &radius);
    for (PetscInt a = 0; a < n; a++) {
      for (PetscInt b = 0; b < n; b++) {
        for (int i = 0; i < 3; i++)
          K[n * a + b] += volume * of->conductivity * dN[a][i] * dN[b][i];
        M[n * a + b] += volume * of->capacity / dt * N[a] * N[b];
      }
    }
  }
}

PetscErrorCode conduction_cell(const Heat *heat, PetscInt c, CellKind *kind, PetscInt *n, PetscInt at[])
{
  PetscInt nodes[CELL_NODES], cStart;
  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(heat->mesh->dm, 0, &cStart, NULL));
  PetscCall(plex_cell_nodes(heat->mesh, cStart + c, n, nodes));
  *kind = cell_kind(heat->mesh->dimension, *n);
  for (PetscInt a = 0; a < *n; a++)
    PetscCall(PetscSectionGetOffset(heat->section, nodes[a], &at[a]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode add_cells(Heat *heat, PetscReal dt, PetscScalar *leaves, HeatEntries *entries)
{
  const Cells       *cells = &heat->physics->cells;
  const PetscScalar *now, *before;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(heat->now, &now));
  PetscCall(VecGetArrayRead(heat->before, &before));
  for (PetscInt c = 0; c < cells->n; c++) {
    const Conductor *of = &heat->bodies[cells->body[c]];
    PetscReal        K[CELL_NODES * CELL_NODES], M[CELL_NODES * CELL_NODES];
    PetscInt         n, at[CELL_NODES];
    CellKind         kind;
    if (!(of->conductivity > 0)) continue;
    PetscCall(conduction_cell(heat, c, &kind, &n, at));
    cell_matrices(kind, &heat->mesh->space, of, cells->X + 3 * cells->offsets[c], dt, K, M);
    for (PetscInt a = 0; a < n; a++) {
      for (PetscInt b = 0; b < n; b++) {
        /* counted from the cell's first node: gradients of what is common have no rounding */
        leaves[at[a]] += K[n * a + b] * (now[at[b]] - now[at[0]]) + M[n * a + b] * (now[at[b]] - before[at[b]]);
        if (entries)
          PetscCall(entries_add(entries, heat->equations[at[a]], heat->equations[at[b]], K[n * a + b] + M[n * a + b]));
      }
    }
  }
  PetscCall(VecRestoreArrayRead(heat->before, &before));
  PetscCall(VecRestoreArrayRead(heat->now, &now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode conduction_faces(Heat *heat)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < heat->n_supports; k++) {
    HeatSupport *support = &heat->supports[k];
    if (support->flows) PetscCall(plex_labelled(heat->mesh, "heat", support->name, &support->n_faces, &support->faces));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode add_flow(Heat *heat, HeatSupport *support, PetscSection section, const PetscScalar *coordinates,
                               PetscScalar *leaves)
{
  const PetscReal flow[3] = {support->value * curve_value(&support->curve, heat->physics->t), 0, 0};
  PetscFunctionBegin;
  support->heat = 0;
  for (PetscInt f = 0; f < support->n_faces; f++) {
    PetscReal X[3 * FACE_NODES], in[3 * FACE_NODES] = {0};
    PetscInt  n, nodes[FACE_NODES], at;
    PetscCall(plex_face_nodes(heat->mesh, support->faces[f], &n, nodes));
    for (PetscInt a = 0; a < n; a++) {
      PetscCall(PetscSectionGetOffset(section, nodes[a], &at));
      for (int i = 0; i < 3; i++)
        X[3 * a + i] = PetscRealPart(coordinates[at + i]);
    }
    face_traction(cell_kind(heat->mesh->dimension - 1, n), &heat->mesh->space, X, flow, in);
    for (PetscInt a = 0; a < n; a++) {
      PetscCall(PetscSectionGetOffset(heat->section, nodes[a], &at));
      leaves[at] -= in[3 * a];
      support->heat += in[3 * a];
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &support->heat, 1, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode conduction_add(Heat *heat, PetscReal dt, PetscScalar *leaves, HeatEntries *entries)
{
  PetscSection       section;
  Vec                vector;
  const PetscScalar *coordinates;
  PetscFunctionBegin;
  PetscCall(add_cells(heat, dt, leaves, entries));
  PetscCall(DMGetCoordinateSection(heat->mesh->dm, &section));
  PetscCall(DMGetCoordinatesLocal(heat->mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  for (PetscInt k = 0; k < heat->n_supports; k++) {
    if (heat->supports[k].flows) PetscCall(add_flow(heat, &heat->supports[k], section, coordinates, leaves));
  }
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}
