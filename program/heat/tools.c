/* Rigid bodies and surfaces in closed form: tools of one temperature each. A tool with `heat_capacity` has one equation, that of its last
 * vertex, which all of its vertices share:  C (T - T_n) / dt = what its interfaces give it. Others have what they start with, or what the
 * scene says of a surface. (The first vertices of a rigid body are no part of a surface.) */
#include "heat/heat.h"

PetscBool tool_is(const Mesh *mesh, PetscInt body)
{
  return (PetscBool)(mesh->bodies[body].analytic || mesh->bodies[body].rigid);
}

PetscBool tool_leads(const Heat *heat, PetscInt vertex)
{
  const PetscInt body = mesh_body_of(heat->mesh, vertex);
  return (PetscBool)(tool_is(heat->mesh, body) && heat->bodies[body].capacity > 0 && vertex == heat->mesh->bodies[body].end_vertex - 1);
}

/* Its vertices here, and where its equation is. */
static PetscErrorCode find(const Heat *heat, PetscInt body, HeatTool *tool)
{
  const Mesh *mesh = heat->mesh;
  PetscFunctionBegin;
  *tool = (HeatTool){.body = body, .leader = -1, .equation = -1};
  PetscCall(PetscMalloc1(mesh->n_points, &tool->entries));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscInt at;
    if (mesh_body_of(mesh, mesh->original[k]) != body) continue;
    PetscCall(PetscSectionGetOffset(heat->section, mesh->points[k], &at));
    tool->entries[tool->n++] = at;
    if (mesh->original[k] != mesh->bodies[body].end_vertex - 1 || heat->physics->unknowns.ghost[k]) continue;
    tool->leader   = at;
    tool->equation = heat->equations[at];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &tool->equation, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode tools_create(Heat *heat)
{
  const Mesh *mesh = heat->mesh;
  PetscFunctionBegin;
  for (PetscInt b = 0; b < mesh->n_bodies; b++)
    heat->n_tools += tool_is(mesh, b);
  PetscCall(PetscMalloc1(heat->n_tools, &heat->tools));
  for (PetscInt b = 0, n = 0; b < mesh->n_bodies; b++) {
    if (tool_is(mesh, b)) PetscCall(find(heat, b, &heat->tools[n++]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode tools_destroy(Heat *heat)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < heat->n_tools; k++)
    PetscCall(PetscFree(heat->tools[k].entries));
  PetscCall(PetscFree(heat->tools));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void tools_number(const Heat *heat, PetscScalar numbers[])
{
  for (PetscInt k = 0; k < heat->n_tools; k++) {
    const HeatTool *tool = &heat->tools[k];
    for (PetscInt j = 0; j < tool->n && tool->equation >= 0; j++)
      numbers[tool->entries[j]] = tool->equation;
  }
}

/* `leaves` has what the interfaces take from each vertex. */
PetscErrorCode tools_balance(Heat *heat, PetscReal dt, PetscScalar *leaves, HeatEntries *entries)
{
  const PetscScalar *now, *before;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(heat->now, &now));
  PetscCall(VecGetArrayRead(heat->before, &before));
  for (PetscInt k = 0; k < heat->n_tools; k++) {
    HeatTool       *tool   = &heat->tools[k];
    const PetscReal stored = heat->bodies[tool->body].capacity / dt;
    tool->taken = 0;
    for (PetscInt j = 0; j < tool->n; j++)
      tool->taken -= PetscRealPart(leaves[tool->entries[j]]);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &tool->taken, 1, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    if (tool->equation < 0) continue;
    for (PetscInt j = 0; j < tool->n; j++)
      leaves[tool->entries[j]] = 0;
    if (tool->leader < 0) continue;
    leaves[tool->leader] = stored * (now[tool->leader] - before[tool->leader]) - tool->taken;
    if (entries) PetscCall(entries_add(entries, tool->equation, tool->equation, stored));
  }
  PetscCall(VecRestoreArrayRead(heat->before, &before));
  PetscCall(VecRestoreArrayRead(heat->now, &now));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All vertices of a tool that stores heat get the temperature of the last; each tool's is kept for the summary. */
PetscErrorCode tools_spread(Heat *heat)
{
  PetscScalar *now;
  PetscFunctionBegin;
  PetscCall(VecGetArray(heat->now, &now));
  for (PetscInt k = 0; k < heat->n_tools; k++) {
    HeatTool *tool    = &heat->tools[k];
    tool->temperature = tool->leader < 0 ? 0 : PetscRealPart(now[tool->leader]);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &tool->temperature, 1, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    for (PetscInt j = 0; j < tool->n && tool->equation >= 0; j++)
      now[tool->entries[j]] = tool->temperature;
  }
  PetscCall(VecRestoreArray(heat->now, &now));
  PetscFunctionReturn(PETSC_SUCCESS);
}
