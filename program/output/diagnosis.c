/* What a user is told about the contact when a run fails: what the library finds at the last iterate, the worst pairs,
 * and where the matrix may be singular. */
#include "output/output.h"
#include <cjson/cJSON.h>

enum { SUSPECTS_TOLD = 3 };

/* by STICKSLIP_CAUSE_* */
static const char *const CAUSES[] = {"its rows are weak", "it is hardly covered",
                                     "both sides are prescribed in this direction",
                                     "it sticks and was not in contact before"};

/* by PAIR_... */
static const char *const PAIRS[] = {"smallest_overlap", "largest_warp", "steepest_angle", "largest_error"};

static void add_pair(cJSON *json, const char *name, const PairFound *found)
{
  cJSON *pair = cJSON_AddObjectToObject(json, name);
  cJSON_AddNumberToObject(pair, "value", found->value);
  cJSON_AddNumberToObject(pair, "nonmortar_facet", (double)found->facets[0]);
  cJSON_AddNumberToObject(pair, "mortar_facet", (double)found->facets[1]);
}

static cJSON *suspect_json(const Suspect *suspect)
{
  cJSON *json = cJSON_CreateObject();
  cJSON_AddNumberToObject(json, "node", suspect->vertex);
  cJSON_AddItemToObject(json, "position", cJSON_CreateDoubleArray(suspect->position, 3));
  cJSON_AddItemToObject(json, "direction", cJSON_CreateDoubleArray(suspect->direction, 3));
  cJSON_AddNumberToObject(json, "ratio", suspect->ratio);
  cJSON_AddStringToObject(json, "cause", CAUSES[suspect->cause]);
  return json;
}

/* Nodes that come to be covered in the step, or hardly are: which keys help. */
static PetscErrorCode advise_on_coverage(const Interface *interface, const ContactDiagnosis *d, cJSON *json)
{
  char advice[512];
  PetscFunctionBegin;
  if (!d->n_new && !d->n_weak) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(advice, sizeof(advice),
                          "%d nodes were not covered before this step, %d are hardly covered: %stake as nonmortar the side "
                          "that stays covered, the smaller one (swap `nonmortar` and `mortar`)",
                          (int)d->n_new, (int)d->n_weak,
                          interface->method.weak_coverage < 0.5 ?
                            "let their neighbours carry them (`weak_coverage: 0.5`), or " :
                            ""));
  cJSON_AddStringToObject(json, "advice", advice);
  PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "%s: %s\n", interface->name, advice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: at the place of the last evaluation */
static PetscErrorCode tell(const Interface *interface, const ContactDiagnosis *d, cJSON *parent)
{
  cJSON *json, *suspects;
  PetscFunctionBegin;
  json = cJSON_AddObjectToObject(parent, interface->name);
  cJSON_AddStringToObject(json, "text", d->text);
  for (int which = 0; which < N_PAIRS_FOUND; which++)
    add_pair(json, PAIRS[which], &d->pairs[which]);
  cJSON_AddNumberToObject(json, "n_suspects", (double)d->n_suspects);
  suspects = cJSON_AddArrayToObject(json, "suspects");
  PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                         "%s: %d nodes in gap, %d in stick, %d in slip; smallest overlap %.1e of a facet, largest warp "
                         "%.1e, steepest angle %.2g rad, largest error of the weights %.1e\n",
                         interface->name, (int)d->states[STICKSLIP_STATE_GAP], (int)d->states[STICKSLIP_STATE_STICK],
                         (int)d->states[STICKSLIP_STATE_SLIP], d->pairs[PAIR_OVERLAP].value, d->pairs[PAIR_WARP].value,
                         d->pairs[PAIR_ANGLE].value, d->pairs[PAIR_ERROR].value));
  for (PetscInt k = 0; k < PetscMin(d->n_suspects, SUSPECTS_KEPT); k++) {
    const Suspect *suspect = &d->suspects[k];
    const double  *p = suspect->position, *e = suspect->direction;
    cJSON_AddItemToArray(suspects, suspect_json(suspect));
    if (k < SUSPECTS_TOLD)
      PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                             "%s: the matrix may be singular at node %d at (%g, %g, %g) along (%.3f, %.3f, %.3f): %s\n",
                             interface->name, (int)suspect->vertex, p[0], p[1], p[2], e[0], e[1], e[2],
                             CAUSES[suspect->cause]));
  }
  if (d->n_suspects > SUSPECTS_TOLD)
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "%s: and so at %d more, see summary.json\n", interface->name,
                           (int)d->n_suspects - SUSPECTS_TOLD));
  PetscCall(advise_on_coverage(interface, d, json));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode diagnosis_failed(Output *output, cJSON *root)
{
  Contact *contact = output->contact;
  cJSON   *json    = cJSON_AddObjectToObject(root, "diagnosis");
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    ContactDiagnosis diagnosis;
    PetscCall(contact_diagnose(&contact->interfaces[i], output->mesh->rank, &diagnosis));
    if (diagnosis.found && output->mesh->rank == 0) PetscCall(tell(&contact->interfaces[i], &diagnosis, json));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
