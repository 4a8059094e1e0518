/* The bodies: conduction and storage of heat in each cell, what flows in through faces, and what cells expand by. In the
 * undeformed configuration, as the linear material is; stored heat by the implicit Euler method.
 *
 * leaves_a = int k dN_a . grad T + c N_a (T - T_n) / dt dV - int N_a q dA */
#include "heat/heat.h"

/* Gradients at a Gauss point of a cell, N, and the volume that it stands for. */
static PetscReal at_point(CellKind kind, const Space *space, const PetscReal X[], PetscInt q, PetscReal N[],
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
    const PetscReal volume = at_point(kind, space, X, q, N, dN, &radius);
    for (PetscInt a = 0; a < n; a++) {
      for (PetscInt b = 0; b < n; b++) {
        for (int i = 0; i < 3; i++)
          K[n * a + b] += volume * of->conductivity * dN[a][i] * dN[b][i];
        M[n * a + b] += volume * of->capacity / dt * N[a] * N[b];
      }
    }
  }
}

/* of this rank's cell: its kind, and where its temperatures lie in a local vector */
static PetscErrorCode look_at_cell(const Heat *heat, PetscInt c, CellKind *kind, PetscInt *n, PetscInt at[])
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
    PetscCall(look_at_cell(heat, c, &kind, &n, at));
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

/* beta = E alpha / (1 - 2 nu), in plane stress E alpha / (1 - nu); 0 of a body that does not expand. */
static PetscReal stiff_expansion(const Heat *heat, PetscInt c)
{
  const PetscInt  body     = heat->physics->cells.body[c];
  const Material *material = &heat->physics->materials[body];
  const PetscReal twice    = heat->mesh->space.kind == SPACE_PLANE_STRESS ? 1 : 2;
  return heat->bodies[body].expansion * material->young / (1 - twice * material->poisson);
}

PetscErrorCode expansion_pressures(const Heat *heat, PetscInt c, PetscReal pressures[])
{
  const PetscReal    beta = heat->physics->mesh->bodies[heat->physics->cells.body[c]].rigid ? 0 : stiff_expansion(heat, c);
  const PetscScalar *now;
  PetscInt           n, at[CELL_NODES];
  CellKind           kind;
  PetscFunctionBegin;
  PetscCall(look_at_cell(heat, c, &kind, &n, at));
  PetscCall(VecGetArrayRead(heat->now, &now));
  for (PetscInt a = 0; a < n; a++)
    pressures[a] = beta * (PetscRealPart(now[at[a]]) - heat->initial);
  PetscCall(VecRestoreArrayRead(heat->now, &now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* f_a = int beta (T - T_0) dN_a dV, in a ring beta (T - T_0) N_a / r along it, too: what free expansion would be pushed by. */
PetscErrorCode expansion_forces(Heat *heat)
{
  Physics           *physics = heat->physics;
  const Cells       *cells   = &physics->cells;
  const Space       *space   = &heat->mesh->space;
  const PetscScalar *now;
  PetscScalar       *forces;
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(physics->f_thermal));
  PetscCall(VecGetArrayRead(heat->now, &now));
  PetscCall(VecGetArray(physics->f_thermal, &forces));
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt *dofs = cells->dofs + cells->offsets[c];
    PetscInt        n, at[CELL_NODES];
    PetscReal       beta;
    CellKind        kind;
    if (heat->bodies[cells->body[c]].expansion == 0) continue;
    beta = stiff_expansion(heat, c);
    PetscCall(look_at_cell(heat, c, &kind, &n, at));
    for (PetscInt q = 0; q < cell_quadrature_points(kind); q++) {
      PetscReal       N[CELL_NODES], dN[CELL_NODES][3], radius, warmer = 0;
      const PetscReal volume = at_point(kind, space, cells->X + 3 * cells->offsets[c], q, N, dN, &radius);
      for (PetscInt a = 0; a < n; a++)
        warmer += N[a] * (PetscRealPart(now[at[a]]) - heat->initial);
      for (PetscInt a = 0; a < n; a++) {
        const PetscReal push = volume * beta * warmer;
        for (int i = 0; i < 3; i++)
          forces[dofs[a] + i] += push * dN[a][i];
        if (space->kind == SPACE_AXISYMMETRIC) forces[dofs[a]] += push * N[a] / radius;
      }
    }
  }
  PetscCall(VecRestoreArray(physics->f_thermal, &forces));
  PetscCall(VecRestoreArrayRead(heat->now, &now));
  PetscFunctionReturn(PETSC_SUCCESS);
}
