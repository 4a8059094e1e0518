/* What a run cost, for summary.json: seconds by phase, and per interface what the library chose to compute and what it
 * counted. */
#include "output/output.h"
#include <cjson/cJSON.h>
#include <time.h>

/* rank 0: one interface's counters; its seconds are added to `sum` */
static PetscErrorCode interface_counters(const Interface *interface, cJSON *parent, stickslip_counters *sum)
{
  stickslip_counters counters = {.struct_size = sizeof(counters)};
  char               effects[1024], cover[1024];
  stickslip_report   report = {.struct_size = sizeof(report), .text = cover, .text_capacity = sizeof(cover)};
  cJSON             *json;

  PetscFunctionBegin;
  if (!interface->handle) PetscFunctionReturn(PETSC_SUCCESS); /* the library refused to create it */
  PetscCallStickslip(stickslip_interface_counters(interface->handle, &counters));
  PetscCallStickslip(stickslip_interface_effects(interface->handle, effects, sizeof(effects)));
  json = cJSON_AddObjectToObject(parent, interface->name);
  cJSON_AddStringToObject(json, "effects", effects);
  /* after the counters, which it adds to; a run that ended beyond what can be computed has none */
  if (!stickslip_interface_report(interface->handle, interface->x, MORTAR_OF(interface, interface->x), &report))
    cJSON_AddStringToObject(json, "cover", cover);
#define ADD(member) cJSON_AddNumberToObject(json, #member, (double)counters.member)
  ADD(multipliers);
  cJSON_AddNumberToObject(json, "bytes", (double)interface->bytes);
  ADD(pairs_tested);
  ADD(pairs_clipped);
  ADD(pairs_integrated);
  ADD(pairs_linearised);
  ADD(pairs_reused);
  ADD(pairs_active);
  ADD(searches);
  ADD(boxes_visited);
  ADD(nodes_slipping);
  ADD(nodes_evaluated);
  ADD(nodes_frictional);
  ADD(nodes_frictionless);
  ADD(nodes_new);
  ADD(nodes_tied);
  ADD(nodes_carried);
  ADD(nodes_uncovered);
  ADD(nodes_left_out);
  ADD(evaluations_apart);
  ADD(commits_apart);
  ADD(seconds_search);
  ADD(seconds_integration);
  ADD(seconds_assembly);
#undef ADD
  sum->seconds_search += counters.seconds_search;
  sum->seconds_integration += counters.seconds_integration;
  sum->seconds_assembly += counters.seconds_assembly;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode summary_counters(Output *output, cJSON *root)
{
  Contact           *contact = output->contact;
  stickslip_counters sum     = {0};
  PetscLogDouble     now;
  cJSON             *interfaces = cJSON_AddObjectToObject(root, "interfaces"), *seconds;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces && output->mesh->rank == 0; i++)
    PetscCall(interface_counters(&contact->interfaces[i], interfaces, &sum));
  PetscCall(PetscTime(&now));
  if (output->solve->linear.kind == SOLVER_ITERATIVE) {
    const Linear *linear = &output->solve->linear;
    cJSON        *solver = cJSON_AddObjectToObject(root, "linear_solver");
    cJSON_AddNumberToObject(solver, "solves", linear->n_solves);
    cJSON_AddNumberToObject(solver, "iterations", linear->iterations);
    cJSON_AddNumberToObject(solver, "most", linear->most);
    cJSON_AddNumberToObject(solver, "direct", linear->n_direct);
  }
  seconds = cJSON_AddObjectToObject(root, "seconds");
  cJSON_AddNumberToObject(seconds, "search", sum.seconds_search);
  cJSON_AddNumberToObject(seconds, "integration", sum.seconds_integration);
  cJSON_AddNumberToObject(seconds, "contact_assembly", sum.seconds_assembly);
  cJSON_AddNumberToObject(seconds, "contact_forces", contact->seconds_forces);
  cJSON_AddNumberToObject(seconds, "contact_tangent", contact->seconds_tangent);
  cJSON_AddNumberToObject(seconds, "bulk_assembly", output->physics->seconds);
  cJSON_AddNumberToObject(seconds, "linear_solve", output->solve->seconds);
  cJSON_AddNumberToObject(seconds, "total", now - output->started);
  cJSON_AddNumberToObject(seconds, "processor", (double)clock() / CLOCKS_PER_SEC); /* of this process */
  PetscFunctionReturn(PETSC_SUCCESS);
}
