/* Multipliers that are left out, since others do what they do. */
#include "output/output.h"
#include "solve/redundant.h"
#include <cjson/cJSON.h>

PetscErrorCode redundant_report(const Output *output, cJSON *root)
{
  const Redundant *redundant = &output->solve->redundant;
  cJSON           *json      = redundant->n ? cJSON_AddObjectToObject(root, "redundant") : NULL;
  PetscFunctionBegin;
  for (PetscInt k = 0, next; k < redundant->n; k = next) {
    const Multiplier *first = &redundant->multipliers[k];
    cJSON            *item;
    for (next = k + 1; next < redundant->n && redundant->multipliers[next].interface == first->interface; next++)
      ;
    item = cJSON_AddObjectToObject(json, output->contact->interfaces[first->interface].name);
    cJSON_AddNumberToObject(item, "multipliers", (double)(next - k));
    cJSON_AddItemToObject(item, "position", cJSON_CreateDoubleArray(first->X, 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
