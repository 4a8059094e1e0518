/* The temperatures: where they are prescribed, and the linear system of a step at given displacements and tractions. */
#include "heat/heat.h"
#include "physics/dynamics.h"
#include "solve/direct.h"

/* The system is linear: what its solution leaves is rounding, of the heats, and of the entries times the temperatures, of which
 * some hundred add up. */
static const PetscReal LEFT = 1e-8, ROUNDINGS = 1e-13;
/* Temperatures that are found again from the heats that they make, to this part, are determined: a singular matrix finds others. */
static const PetscReal FOUND = 1e-2;

/* Vertices of surfaces with a temperature, and all of bodies without conductivity but for what a tool that stores heat has. */
static PetscErrorCode mark_prescribed(Heat *heat)
{
  const Mesh *mesh = heat->mesh;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->n_points, &heat->support_of));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    heat->support_of[k] = -1;
    for (PetscInt s = 0; s < heat->n_supports; s++) {
      char     label[2 * NAME_LENGTH];
      PetscInt value;
      if (heat->supports[s].flows) continue;
      PetscCall(PetscSNPrintf(label, sizeof(label), "heat.%s", heat->supports[s].name));
      PetscCall(DMGetLabelValue(mesh->dm, label, mesh->points[k], &value));
      if (value > 0) heat->support_of[k] = s;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool is_prescribed(const Heat *heat, PetscInt k)
{
  if (tool_leads(heat, heat->mesh->original[k])) return PETSC_FALSE;
  return (PetscBool)(heat->support_of[k] >= 0 || !(heat->bodies[mesh_body_of(heat->mesh, heat->mesh->original[k])].conductivity > 0));
}

static PetscErrorCode create_section(Heat *heat)
{
  const Mesh    *mesh = heat->mesh;
  const PetscInt first[1] = {0};
  PetscInt       pStart, pEnd;
  PetscFunctionBegin;
  PetscCall(DMClone(mesh->dm, &heat->dm));
  PetscCall(PetscSectionCreate(PETSC_COMM_WORLD, &heat->section));
  PetscCall(DMPlexGetChart(mesh->dm, &pStart, &pEnd));
  PetscCall(PetscSectionSetChart(heat->section, pStart, pEnd));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscCall(PetscSectionSetDof(heat->section, mesh->points[k], 1));
    if (is_prescribed(heat, k)) PetscCall(PetscSectionSetConstraintDof(heat->section, mesh->points[k], 1));
  }
  PetscCall(PetscSectionSetUp(heat->section));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    if (is_prescribed(heat, k)) PetscCall(PetscSectionSetConstraintIndices(heat->section, mesh->points[k], first));
  }
  PetscCall(DMSetLocalSection(heat->dm, heat->section));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode heat_create(Heat *heat)
{
  ISLocalToGlobalMapping mapping;
  PetscFunctionBegin;
  if (!heat->on) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(mark_prescribed(heat));
  PetscCall(create_section(heat));
  PetscCall(DMGetLocalToGlobalMapping(heat->dm, &mapping));
  PetscCall(ISLocalToGlobalMappingGetIndices(mapping, &heat->equations)); /* negative: prescribed */
  PetscCall(tools_create(heat));
  PetscCall(DMCreateLocalVector(heat->dm, &heat->now));
  PetscCall(VecDuplicate(heat->now, &heat->before));
  PetscCall(VecSet(heat->before, heat->initial));
  PetscCall(VecCopy(heat->before, heat->now));
  PetscCall(VecDuplicate(heat->physics->u_local, &heat->wide));
  if (heat->two_way) PetscCall(expansion_create(heat));
  PetscCall(conduction_faces(heat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode heat_destroy(Heat *heat)
{
  PetscFunctionBegin;
  if (heat->dm) {
    ISLocalToGlobalMapping mapping;
    PetscCall(DMGetLocalToGlobalMapping(heat->dm, &mapping));
    PetscCall(ISLocalToGlobalMappingRestoreIndices(mapping, &heat->equations));
  }
  for (PetscInt k = 0; k < heat->n_supports; k++) {
    PetscCall(PetscFree(heat->supports[k].surfaces));
    PetscCall(PetscFree(heat->supports[k].faces));
    PetscCall(PetscFree(heat->supports[k].curve.points));
  }
  PetscCall(tools_destroy(heat));
  PetscCall(PetscFree(heat->supports));
  PetscCall(PetscFree(heat->bodies));
  for (PetscInt i = 0; heat->interfaces && i < heat->contact->n_interfaces; i++)
    PetscCall(PetscFree(heat->interfaces[i].temperatures));
  PetscCall(PetscFree(heat->interfaces));
  PetscCall(PetscFree(heat->support_of));
  PetscCall(VecDestroy(&heat->now));
  PetscCall(VecDestroy(&heat->before));
  PetscCall(VecDestroy(&heat->wide));
  PetscCall(PetscSectionDestroy(&heat->section));
  PetscCall(DMDestroy(&heat->dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode heat_begin(Heat *heat, PetscReal t)
{
  const Mesh  *mesh = heat->mesh;
  PetscScalar *now;
  PetscFunctionBegin;
  if (!heat->on) PetscFunctionReturn(PETSC_SUCCESS);
  heat->turns      = 0;
  heat->refusal[0] = 0;
  PetscCall(VecCopy(heat->before, heat->now));
  if (heat->two_way && heat->physics->dynamics) {
    PetscCall(expansion_apply(heat));
    PetscCall(dynamics_warm(heat->physics));
  }
  PetscCall(VecGetArray(heat->now, &now));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt s = heat->support_of[k];
    PetscInt       at;
    if (s < 0) continue;
    PetscCall(PetscSectionGetOffset(heat->section, mesh->points[k], &at));
    now[at] = heat->initial + (heat->supports[s].value - heat->initial) * curve_value(&heat->supports[s].curve, t);
  }
  PetscCall(VecRestoreArray(heat->now, &now));
  PetscCall(tools_spread(heat));
  if (heat->two_way) PetscCall(expansion_apply(heat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What leaves the vertices with equations; of the supports with a temperature what came in there. `largest`: of a local vertex. */
static PetscErrorCode balance(Heat *heat, PetscReal dt, HeatEntries *entries, Vec global, PetscReal *largest,
                              PetscInt *status)
{
  const Mesh  *mesh = heat->mesh;
  PetscScalar *leaves;
  Vec          local;
  PetscFunctionBegin;
  PetscCall(DMGetLocalVector(heat->dm, &local));
  PetscCall(VecZeroEntries(local));
  PetscCall(VecGetArray(local, &leaves));
  PetscCall(conduction_add(heat, dt, leaves, entries));
  PetscCall(across_add(heat, dt, leaves, entries, status));
  PetscCall(tools_balance(heat, dt, leaves, entries));
  *largest = 0;
  for (PetscInt s = 0; s < heat->n_supports; s++) {
    if (!heat->supports[s].flows) heat->supports[s].heat = 0;
  }
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscInt at;
    PetscCall(PetscSectionGetOffset(heat->section, mesh->points[k], &at));
    *largest = PetscMax(*largest, PetscAbsScalar(leaves[at]));
    if (heat->support_of[k] >= 0) heat->supports[heat->support_of[k]].heat += PetscRealPart(leaves[at]);
  }
  for (PetscInt s = 0; s < heat->n_supports; s++) {
    if (!heat->supports[s].flows)
      PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &heat->supports[s].heat, 1, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscCall(VecRestoreArray(local, &leaves));
  PetscCall(VecZeroEntries(global));
  PetscCall(DMLocalToGlobalBegin(heat->dm, local, ADD_VALUES, global));
  PetscCall(DMLocalToGlobalEnd(heat->dm, local, ADD_VALUES, global));
  PetscCall(DMRestoreLocalVector(heat->dm, &local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode matrix_of(const HeatEntries *entries, Vec like, Mat *matrix)
{
  PetscInt n;
  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(like, &n));
  PetscCall(MatCreate(PETSC_COMM_WORLD, matrix));
  PetscCall(MatSetSizes(*matrix, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*matrix, MATAIJ));
  PetscCall(MatSetPreallocationCOO(*matrix, entries->n, entries->rows, entries->columns));
  PetscCall(MatSetValuesCOO(*matrix, entries->values, INSERT_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the matrix find temperatures again from the heats that they make? */
static PetscErrorCode is_determined(KSP ksp, Mat matrix, Vec like, PetscBool *determined)
{
  Vec                some, heats, found;
  PetscReal          error, size;
  PetscInt           first, n;
  PetscScalar       *values;
  KSPConvergedReason reason;
  PetscFunctionBegin;
  PetscCall(VecDuplicate(like, &some));
  PetscCall(VecDuplicate(like, &heats));
  PetscCall(VecDuplicate(like, &found));
  PetscCall(VecGetOwnershipRange(some, &first, NULL));
  PetscCall(VecGetLocalSize(some, &n));
  PetscCall(VecGetArray(some, &values));
  for (PetscInt k = 0; k < n; k++)
    values[k] = 1 + (PetscReal)((first + k) * 7919 % 101) / 101;
  PetscCall(VecRestoreArray(some, &values));
  PetscCall(MatMult(matrix, some, heats));
  PetscCall(KSPSolve(ksp, heats, found));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCall(VecAXPY(found, -1, some));
  PetscCall(VecNorm(found, NORM_INFINITY, &error));
  PetscCall(VecNorm(some, NORM_INFINITY, &size));
  *determined = (PetscBool)(reason >= 0 && error <= FOUND * size);
  PetscCall(VecDestroy(&some));
  PetscCall(VecDestroy(&heats));
  PetscCall(VecDestroy(&found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far the temperatures are apart, prescribed ones included. */
static PetscErrorCode range_of(const Heat *heat, PetscReal *range)
{
  PetscReal ends[2] = {-heat->initial, heat->initial}, low, high; /* minus the least, the largest */
  PetscInt  n;
  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(heat->now, &n));
  if (n) {
    PetscCall(VecMin(heat->now, NULL, &low));
    PetscCall(VecMax(heat->now, NULL, &high));
    ends[0] = PetscMax(ends[0], -low);
    ends[1] = PetscMax(ends[1], high);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, ends, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  *range = ends[0] + ends[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode heat_solve(Heat *heat, PetscReal dt, PetscReal *change, PetscInt *status)
{
  HeatEntries entries = {0};
  PetscReal   first, last = 0, largest, norm, range = 0, entry, hottest;
  PetscBool   determined = PETSC_FALSE;
  PetscInt    n;
  Vec         leaves, step, x;
  Mat         matrix;
  KSP         ksp;
  PetscFunctionBegin;
  heat->turns++;
  PetscCall(DMCreateGlobalVector(heat->dm, &leaves));
  PetscCall(VecDuplicate(leaves, &step));
  PetscCall(VecDuplicate(leaves, &x));
  PetscCall(balance(heat, dt, &entries, leaves, &first, status));
  PetscCall(VecGetSize(leaves, &n));
  *change        = 0;
  heat->residual = 0;
  if (!*status && n) { /* else all temperatures are given */
    PetscCall(matrix_of(&entries, leaves, &matrix));
    PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
    PetscCall(KSPSetOperators(ksp, matrix, matrix));
    PetscCall(direct_set(ksp));
    PetscCall(is_determined(ksp, matrix, leaves, &determined));
    for (int refine = 0; refine < 2 && determined && !*status; refine++) { /* the second one takes the rounding of the first */
      PetscCall(KSPSolve(ksp, leaves, step));
      PetscCall(VecNorm(step, NORM_INFINITY, &norm));
      *change = PetscMax(*change, norm);
      PetscCall(DMLocalToGlobalBegin(heat->dm, heat->now, INSERT_VALUES, x));
      PetscCall(DMLocalToGlobalEnd(heat->dm, heat->now, INSERT_VALUES, x));
      PetscCall(VecAXPY(x, -1, step));
      PetscCall(DMGlobalToLocalBegin(heat->dm, x, INSERT_VALUES, heat->now));
      PetscCall(DMGlobalToLocalEnd(heat->dm, x, INSERT_VALUES, heat->now));
      PetscCall(tools_spread(heat));
      PetscCall(balance(heat, dt, NULL, leaves, &last, status));
    }
    largest = PetscMax(first, last);
    PetscCall(VecNorm(leaves, NORM_INFINITY, &norm));
    heat->residual = largest > 0 ? norm / largest : 0;
    PetscCall(range_of(heat, &range));
    *change = range > 0 ? *change / range : 0;
    PetscCall(MatNorm(matrix, NORM_INFINITY, &entry));
    PetscCall(VecNorm(x, NORM_INFINITY, &hottest));
    if (!determined || (!*status && !(norm <= LEFT * largest + ROUNDINGS * entry * PetscMax(hottest, range)))) {
      *status = 1;
      PetscCall(PetscSNPrintf(heat->refusal, sizeof(heat->refusal),
                              "the temperatures are not determined: nothing holds those of a body (a temperature, a heat_capacity, a conductance to another body)"));
    }
    PetscCall(KSPDestroy(&ksp));
    PetscCall(MatDestroy(&matrix));
  }
  if (*status && !heat->refusal[0])
    PetscCall(PetscSNPrintf(heat->refusal, sizeof(heat->refusal), "the library says: %s", heat->contact->refusal));
  PetscCall(entries_destroy(&entries));
  PetscCall(VecDestroy(&leaves));
  PetscCall(VecDestroy(&step));
  PetscCall(VecDestroy(&x));
  if (heat->two_way && !*status) PetscCall(expansion_apply(heat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode heat_accept(Heat *heat)
{
  PetscFunctionBegin;
  if (heat->on) PetscCall(VecCopy(heat->now, heat->before));
  PetscFunctionReturn(PETSC_SUCCESS);
}
