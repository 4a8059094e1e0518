/* Heat of a step in summary.json: what came in at supports and flows, what crossed each interface and what friction made there,
 * temperatures of the probes; and how the step was solved. */
#include "output/output.h"
#include <cjson/cJSON.h>

PetscErrorCode heat_results(const Output *output, cJSON *step)
{
  const Heat *heat = output->heat;
  cJSON      *json, *of;
  PetscFunctionBegin;
  if (!heat->on) PetscFunctionReturn(PETSC_SUCCESS);
  json = cJSON_AddObjectToObject(step, "heat");
  cJSON_AddNumberToObject(json, "turns", (double)heat->turns);
  cJSON_AddNumberToObject(json, "residual", heat->residual);
  of = cJSON_AddObjectToObject(json, "supplied");
  for (PetscInt s = 0; s < heat->n_supports; s++)
    cJSON_AddNumberToObject(of, heat->supports[s].name, heat->supports[s].heat);
  of = cJSON_AddObjectToObject(json, "interfaces");
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++) {
    cJSON *one;
    if (!heat->interfaces[i].passes) continue;
    one = cJSON_AddObjectToObject(of, output->contact->interfaces[i].name);
    cJSON_AddNumberToObject(one, "across", heat->interfaces[i].across);
    cJSON_AddNumberToObject(one, "friction", heat->interfaces[i].friction);
  }
  of = heat->n_tools ? cJSON_AddObjectToObject(json, "tools") : NULL;
  for (PetscInt k = 0; k < heat->n_tools; k++) {
    cJSON *one = cJSON_AddObjectToObject(of, output->mesh->bodies[heat->tools[k].body].name);
    if (heat->tools[k].equation >= 0 || output->mesh->bodies[heat->tools[k].body].analytic) /* others have one at each node */
      cJSON_AddNumberToObject(one, "temperature", heat->tools[k].temperature);
    cJSON_AddNumberToObject(one, "heat", heat->tools[k].taken);
  }
  of = cJSON_AddObjectToObject(json, "probes");
  for (PetscInt k = 0; k < output->n_probes; k++) {
    PetscReal temperature;
    PetscCall(heat_temperature(heat, output->probes[k].vertex, &temperature));
    cJSON_AddNumberToObject(of, output->probes[k].name, temperature);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
