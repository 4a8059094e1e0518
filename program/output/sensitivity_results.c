/* How reactions and probes follow the parameters of a scene, for summary.json: derivatives, and standard deviations of parameters that do
 * not know of each other. */
#include "output/output.h"
#include "solve/sensitivity.h"
#include <cjson/cJSON.h>

/* A result of three numbers: its derivative by each parameter */
typedef struct {
  const char *name;
  PetscReal  *slopes; /* 3 a parameter */
} Result;

/* sqrt(sum (dJ/dtheta deviation)^2) */
static void add_deviation(const Sensitivity *all, const Result *result, cJSON *json)
{
  PetscReal v[3] = {0, 0, 0};
  for (int i = 0; i < 3; i++) {
    for (PetscInt p = 0; p < all->n; p++)
      v[i] += PetscSqr(result->slopes[3 * p + i] * all->parameters[p].deviation);
    v[i] = PetscSqrtReal(v[i]);
  }
  cJSON_AddItemToObject(json, result->name, cJSON_CreateDoubleArray(v, 3));
}

/* Results of one kind, `reactions` or `probes`, parameter by parameter. */
static void add_results(const Sensitivity *all, const char *kind, PetscInt n, const Result results[], cJSON *json)
{
  PetscBool any = PETSC_FALSE;
  for (PetscInt p = 0; p < all->n && n; p++) {
    cJSON *of = cJSON_GetObjectItem(json, all->parameters[p].name), *group;
    if (!of) of = cJSON_AddObjectToObject(json, all->parameters[p].name);
    group = cJSON_AddObjectToObject(of, kind);
    for (PetscInt k = 0; k < n; k++)
      cJSON_AddItemToObject(group, results[k].name, cJSON_CreateDoubleArray(results[k].slopes + 3 * p, 3));
    if (all->parameters[p].deviation > 0) any = PETSC_TRUE;
  }
  if (any) {
    cJSON *deviation = cJSON_GetObjectItem(json, "deviation"), *group;
    if (!deviation) deviation = cJSON_AddObjectToObject(json, "deviation");
    group = cJSON_AddObjectToObject(deviation, kind);
    for (PetscInt k = 0; k < n; k++)
      add_deviation(all, &results[k], group);
  }
}

PetscErrorCode sensitivity_report(const Output *output, cJSON *step)
{
  const Sensitivity *all     = output->solve->sensitivity;
  const Physics     *physics = output->physics;
  const PetscInt     n_most  = PetscMax(physics->n_supports, output->n_probes);
  cJSON             *json;
  Result            *results;
  PetscReal         *slopes;
  PetscFunctionBegin;
  if (!all) PetscFunctionReturn(PETSC_SUCCESS);
  json = cJSON_AddObjectToObject(step, "sensitivity");
  PetscCall(PetscMalloc2(n_most, &results, 3 * all->n * n_most, &slopes));
  for (PetscInt k = 0; k < n_most; k++)
    results[k].slopes = slopes + 3 * all->n * k;
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    results[s].name = physics->supports[s].name;
    for (PetscInt p = 0; p < all->n; p++)
      PetscCall(PetscArraycpy(results[s].slopes + 3 * p, all->parameters[p].reactions + 3 * s, 3));
  }
  add_results(all, "reactions", physics->n_supports, results, json);
  for (PetscInt k = 0; k < output->n_probes; k++)
    results[k].name = output->probes[k].name;
  for (PetscInt p = 0; p < all->n; p++) {
    const PetscScalar *du;
    PetscCall(VecGetArrayRead(all->parameters[p].now, &du));
    for (PetscInt k = 0; k < output->n_probes; k++)
      PetscCall(unknowns_displacement(physics, output->probes[k].vertex, du, results[k].slopes + 3 * p));
    PetscCall(VecRestoreArrayRead(all->parameters[p].now, &du));
  }
  add_results(all, "probes", output->n_probes, results, json);
  cJSON_AddNumberToObject(json, "imbalance", all->imbalance);
  PetscCall(PetscFree2(results, slopes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
