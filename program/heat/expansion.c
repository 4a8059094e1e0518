/* What warm bodies expand by. Linear ones are pushed apart by forces; those of finite strain grow without stress, cell by cell
 * (physics/cell_points.c). */
#include "heat/heat.h"

static PetscBool swells(const Heat *heat, PetscInt body)
{
  return (PetscBool)(heat->bodies[body].expansion != 0 && heat->physics->materials[body].law->finite);
}

PetscErrorCode expansion_create(Heat *heat)
{
  Physics  *physics = heat->physics;
  PetscBool any     = PETSC_FALSE;
  PetscFunctionBegin;
  PetscCall(VecDuplicate(physics->u_local, &physics->f_thermal));
  PetscCall(VecZeroEntries(physics->f_thermal));
  for (PetscInt b = 0; b < heat->mesh->n_bodies; b++)
    any = (PetscBool)(any || heat->bodies[b].expansion != 0); /* linear bodies that are laid down grow so, too */
  if (any) PetscCall(PetscCalloc1(physics->cells.offsets[physics->cells.n], &physics->cells.swell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* beta = E alpha / (1 - 2 nu), in plane stress E alpha / (1 - nu); 0 of a body that does not expand, and of finite strain. */
static PetscReal stiff_expansion(const Heat *heat, PetscInt c)
{
  const PetscInt  body     = heat->physics->cells.body[c];
  const Material *material = &heat->physics->materials[body];
  const PetscReal twice    = heat->mesh->space.kind == SPACE_PLANE_STRESS ? 1 : 2;
  if (swells(heat, body)) return 0;
  return heat->bodies[body].expansion * material->young / (1 - twice * material->poisson);
}

PetscErrorCode expansion_pressures(const Heat *heat, PetscInt c, PetscReal pressures[])
{
  const PetscReal    beta = heat->physics->mesh->bodies[heat->physics->cells.body[c]].rigid ? 0 : stiff_expansion(heat, c);
  const PetscScalar *now;
  PetscInt           n, at[CELL_NODES];
  CellKind           kind;
  PetscFunctionBegin;
  PetscCall(conduction_cell(heat, c, &kind, &n, at));
  PetscCall(VecGetArrayRead(heat->now, &now));
  for (PetscInt a = 0; a < n; a++)
    pressures[a] = beta * (PetscRealPart(now[at[a]]) - heat->initial);
  PetscCall(VecRestoreArrayRead(heat->now, &now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* f_a = int beta (T - T_0) dN_a dV, in a ring beta (T - T_0) N_a / r along it, too: what free expansion would be pushed by. */
static PetscErrorCode set_forces(Heat *heat)
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
    if (heat->bodies[cells->body[c]].expansion == 0 || swells(heat, cells->body[c])) continue;
    beta = stiff_expansion(heat, c);
    PetscCall(conduction_cell(heat, c, &kind, &n, at));
    for (PetscInt q = 0; q < cell_quadrature_points(kind); q++) {
      PetscReal       N[CELL_NODES], dN[CELL_NODES][3], radius, warmer = 0;
      const PetscReal volume = conduction_point(kind, space, cells->X + 3 * cells->offsets[c], q, N, dN, &radius);
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

static PetscErrorCode set_swell(Heat *heat)
{
  Cells             *cells = &heat->physics->cells;
  const PetscScalar *now;
  PetscFunctionBegin;
  if (!cells->swell) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(heat->now, &now));
  for (PetscInt c = 0; c < cells->n; c++) {
    PetscInt n, at[CELL_NODES];
    CellKind kind;
    if (!swells(heat, cells->body[c])) continue;
    PetscCall(conduction_cell(heat, c, &kind, &n, at));
    for (PetscInt a = 0; a < n; a++)
      cells->swell[cells->offsets[c] + a] = heat->bodies[cells->body[c]].expansion * (PetscRealPart(now[at[a]]) - heat->initial);
  }
  PetscCall(VecRestoreArrayRead(heat->now, &now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode expansion_apply(Heat *heat)
{
  PetscFunctionBegin;
  PetscCall(set_forces(heat));
  PetscCall(set_swell(heat));
  PetscFunctionReturn(PETSC_SUCCESS);
}
