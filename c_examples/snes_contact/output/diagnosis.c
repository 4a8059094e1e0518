/* What a user is told about the contact when a run fails: what the library finds at the last iterate, the worst pairs,
 * and where the matrix may be singular. */
#include "output/output.h"
#include <cjson/cJSON.h>

enum { SUSPECTS_TOLD = 3, SUSPECTS_KEPT = 20 };

/* by STICKSLIP_CAUSE_* */
static const char *const CAUSES[] = {"its rows are weak", "it is hardly covered",
                                     "both sides are prescribed in this direction",
                                     "it sticks and was not in contact before"};

static void add_pair(cJSON *json, const char *name, double value, const int64_t facets[2])
{
  cJSON *pair = cJSON_AddObjectToObject(json, name);
  cJSON_AddNumberToObject(pair, "value", value);
  cJSON_AddNumberToObject(pair, "nonmortar_facet", (double)facets[0]);
  cJSON_AddNumberToObject(pair, "mortar_facet", (double)facets[1]);
}

static cJSON *suspect_json(const Interface *interface, int64_t node, const double *direction, double ratio,
                           const char *cause)
{
  cJSON    *json = cJSON_CreateObject();
  PetscReal X[3];
  contact_vector(interface, interface->X, (PetscInt)node, X);
  cJSON_AddNumberToObject(json, "node", interface->nodes[node]);
  cJSON_AddItemToObject(json, "position", cJSON_CreateDoubleArray(X, 3));
  cJSON_AddItemToObject(json, "direction", cJSON_CreateDoubleArray(direction, 3));
  cJSON_AddNumberToObject(json, "ratio", ratio);
  cJSON_AddStringToObject(json, "cause", cause);
  return json;
}

/* Nodes that come to be covered in the step, or hardly are: which keys help. */
static PetscErrorCode advise_on_coverage(const Interface *interface, const stickslip_diagnosis *d, cJSON *json)
{
  stickslip_counters counters = {.struct_size = sizeof(counters)};
  int64_t            weak     = 0;
  char               advice[512];

  PetscFunctionBegin;
  PetscCallStickslip(stickslip_interface_counters(interface->handle, &counters));
  for (int64_t k = 0; k < PetscMin(d->suspects, SUSPECTS_KEPT); k++)
    weak += d->suspect_causes[k] == STICKSLIP_CAUSE_COVERAGE;
  if (!counters.nodes_new && !weak) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(advice, sizeof(advice),
                          "%d nodes were not covered before this step, %d are hardly covered: %stake as nonmortar the side "
                          "that stays covered, the smaller one (swap `nonmortar` and `mortar`)",
                          (int)counters.nodes_new, (int)weak,
                          interface->options.weak_coverage < 0.5 ?
                            "let their neighbours carry them (`weak_coverage: 0.5`), or " :
                            ""));
  cJSON_AddStringToObject(json, "advice", advice);
  PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "%s: %s\n", interface->name, advice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: at the place of the last evaluation */
static PetscErrorCode diagnose(const Interface *interface, cJSON *parent)
{
  int64_t nodes[SUSPECTS_KEPT];
  int32_t causes[SUSPECTS_KEPT];
  double  directions[3 * SUSPECTS_KEPT], ratios[SUSPECTS_KEPT];
  char    text[1024];
  cJSON  *json, *suspects;

  stickslip_diagnosis d = {.struct_size        = sizeof(d),
                           .suspect_nodes      = nodes,
                           .suspect_directions = directions,
                           .suspect_ratios     = ratios,
                           .suspect_causes     = causes,
                           .suspect_capacity   = SUSPECTS_KEPT,
                           .text               = text,
                           .text_capacity      = sizeof(text)};
  PetscFunctionBegin;
  /* an iterate that the library refuses has been told of already */
  if (stickslip_interface_diagnose(interface->handle, STATE_OF(interface), NULL, &d)) PetscFunctionReturn(PETSC_SUCCESS);
  json = cJSON_AddObjectToObject(parent, interface->name);
  cJSON_AddStringToObject(json, "text", text);
  add_pair(json, "smallest_overlap", d.overlap, d.overlap_facets);
  add_pair(json, "largest_warp", d.warp, d.warp_facets);
  add_pair(json, "steepest_angle", d.angle, d.angle_facets);
  add_pair(json, "largest_error", d.error, d.error_facets);
  cJSON_AddNumberToObject(json, "n_suspects", (double)d.suspects);
  suspects = cJSON_AddArrayToObject(json, "suspects");
  PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                         "%s: %d nodes in gap, %d in stick, %d in slip; smallest overlap %.1e of a facet, largest warp "
                         "%.1e, steepest angle %.2g rad, largest error of the weights %.1e\n",
                         interface->name, (int)d.nodes_gap, (int)d.nodes_stick, (int)d.nodes_slip, d.overlap, d.warp,
                         d.angle, d.error));
  for (int64_t k = 0; k < PetscMin(d.suspects, SUSPECTS_KEPT); k++) {
    PetscReal p[3], e[3];
    contact_vector(interface, interface->X, (PetscInt)nodes[k], p);
    contact_vector(interface, directions, (PetscInt)k, e);
    cJSON_AddItemToArray(suspects, suspect_json(interface, nodes[k], e, ratios[k], CAUSES[causes[k]]));
    if (k < SUSPECTS_TOLD)
      PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                             "%s: the matrix may be singular at node %d at (%g, %g, %g) along (%.3f, %.3f, %.3f): %s\n",
                             interface->name, (int)interface->nodes[nodes[k]], (double)p[0], (double)p[1], (double)p[2], (double)e[0],
                             (double)e[1], (double)e[2],
                             CAUSES[causes[k]]));
  }
  if (d.suspects > SUSPECTS_TOLD)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "%s: and so at %d more, see summary.json\n", interface->name,
                           (int)d.suspects - SUSPECTS_TOLD));
  PetscCall(advise_on_coverage(interface, &d, json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode diagnosis_failed(Output *output, cJSON *root)
{
  Contact *contact = output->contact;
  cJSON   *json    = cJSON_AddObjectToObject(root, "diagnosis");
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces && output->mesh->rank == 0; i++) {
    if (contact->interfaces[i].handle) PetscCall(diagnose(&contact->interfaces[i], json));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
