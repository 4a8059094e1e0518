/* Results: DIR/summary.json, the progress line, and per step the CSV files of the interfaces and the VTU file. All values
 * of a step belong to the state just before it is committed. */
#include "output/output.h"
#include "physics/fluid.h"
#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

struct Summary {
  cJSON       *root, *steps, *failed_attempts;
  double      *work_before;    /* friction work of each interface before the last step */
  char         said[1024];     /* about the last failed attempt */
  char         progress[1024]; /* of the last step: what its line ends with */
  Vec          state;          /* its, local; until it is settled whether it is accepted */
};

/* with all its digits (cJSON leaves out the last where it thinks that it does not matter): a step can be run again */
static void add_time(cJSON *json, const char *name, PetscReal t)
{
  char text[32];
  snprintf(text, sizeof(text), "%.17g", (double)t);
  cJSON_AddRawToObject(json, name, text);
}

static const char *form_name(const Output *output)
{
  Contact *contact = output->contact;
  int32_t  form    = contact->n_interfaces ? contact->interfaces[0].method.form : STICKSLIP_FORM_MULTIPLIER;
  for (PetscInt i = 1; i < contact->n_interfaces; i++) {
    if (contact->interfaces[i].method.form != form) return "mixed";
  }
  return form == STICKSLIP_FORM_AUGMENTED ? "augmented" : "multiplier";
}

/* What weights are called in a scene, by STICKSLIP_WEIGHTS_... */
static const char *const WEIGHTS[] = {"", "current", "committed", "reference", "", "conserving"};

/* The interfaces that decide at points, with what goes with them whether the scene has said so or not, and what the library takes their bodies' stiffness for. */
static PetscErrorCode add_decisions(const Output *output, cJSON *root)
{
  cJSON *all = NULL;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++) {
    const Interface *interface = &output->contact->interfaces[i];
    cJSON           *json;
    if (!decision_is_points(interface)) continue;
    if (!all) all = cJSON_AddObjectToObject(root, "decisions");
    json = cJSON_AddObjectToObject(all, interface->name);
    cJSON_AddStringToObject(json, "decision", "points");
    cJSON_AddStringToObject(json, "basis", "dual");
    cJSON_AddStringToObject(json, "weights", WEIGHTS[interface->method.weights]);
    cJSON_AddNumberToObject(json, "modulus", interface->options.modulus);
    cJSON_AddStringToObject(json, "modulus_from", interface->modulus_from);
    if (!output->quiet)
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s: decided at points, basis dual, weights %s, modulus %g (from %s)\n", interface->name,
                            WEIGHTS[interface->method.weights], interface->options.modulus, interface->modulus_from));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With `dynamics`: the weights, and why they are not those that conserve. */
static PetscErrorCode add_weights(const Output *output, cJSON *root)
{
  cJSON *all = NULL;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < output->contact->n_interfaces && output->physics->dynamics; i++) {
    const Interface *interface = &output->contact->interfaces[i];
    cJSON           *json;
    if (!all) all = cJSON_AddObjectToObject(root, "weights");
    json = cJSON_AddObjectToObject(all, interface->name);
    cJSON_AddStringToObject(json, "weights", WEIGHTS[interface->method.weights]);
    if (!interface->conserves_not[0]) continue;
    cJSON_AddStringToObject(json, "why", interface->conserves_not);
    if (!output->quiet)
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s: weights %s, for conserving ones are refused: %s\n", interface->name,
                            WEIGHTS[interface->method.weights], interface->conserves_not));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode summary_create(Output *output, Summary **out)
{
  Summary  *summary;
  PetscInt  unknowns;
  PetscReal rtol;
  Vec       x;

  PetscFunctionBegin;
  PetscCall(PetscNew(&summary));
  PetscCall(PetscCalloc1(output->contact->n_interfaces, &summary->work_before));
  PetscCall(DMGetGlobalVector(output->mesh->dm, &x));
  PetscCall(VecGetSize(x, &unknowns));
  PetscCall(DMRestoreGlobalVector(output->mesh->dm, &x));
  PetscCall(SNESGetTolerances(output->solve->snes, NULL, &rtol, NULL, NULL, NULL));
  summary->root = cJSON_CreateObject();
  cJSON_AddNumberToObject(summary->root, "schema", 1);
  cJSON_AddStringToObject(summary->root, "scene", output->scene);
  cJSON_AddStringToObject(summary->root, "form", form_name(output));
  cJSON_AddNumberToObject(summary->root, "rtol", rtol);
  cJSON_AddNumberToObject(summary->root, "unknowns", unknowns);
  PetscCall(add_decisions(output, summary->root));
  PetscCall(add_weights(output, summary->root));
  summary->steps           = cJSON_CreateArray();
  summary->failed_attempts = cJSON_CreateArray();
  if (!output->quiet)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s: %" PetscInt_FMT " unknowns\n", output->scene, unknowns));
  PetscCall(energy_begin(output));
  *out = summary;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode add_closed_area(const Interface *interface, cJSON *json)
{
  double closed = 0;
  PetscFunctionBegin;
  for (PetscInt a = 0; a < interface->n1; a++)
    closed += interface->states.closed[a] * interface->states.coverage[a];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &closed, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  cJSON_AddNumberToObject(json, "closed_area", closed);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* volume worn off [L^3]; work that a bond has lost [F L] */
static PetscErrorCode add_layer(const Interface *interface, cJSON *json)
{
  double sums[2] = {0, 0};
  PetscFunctionBegin;
  for (PetscInt a = 0; a < interface->n1; a++) {
    const double *layer = interface->states.layer + N_LAYER_RESULTS * a;
    sums[0] += layer[LAYER_VOLUME];
    sums[1] += layer[LAYER_LOSS] * interface->states.coverage[a];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  cJSON_AddNumberToObject(json, "worn_volume", sums[0]);
  cJSON_AddNumberToObject(json, "bond_loss", sums[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Force, counts and CSV file of one interface; returns a piece of the progress line. */
static PetscErrorCode interface_results(Output *output, Interface *interface, const double *temperatures, PetscInt step, PetscBool write,
                                        cJSON *parent, double *work, char progress[], size_t length)
{
  PetscInt             counts[3] = {0, 0, 0};
  PetscReal            force[3] = {0, 0, 0}, nodal[3];
  double               dissipation = 0;
  const ContactStates *states = &interface->states;
  cJSON               *json   = cJSON_AddObjectToObject(parent, interface->name);

  PetscFunctionBegin;
  for (PetscInt a = 0; a < interface->n1; a++) {
    if (!interface->middle[a]) counts[states->state[a]]++;
    contact_vector(interface->dimension, interface->forces, a, nodal);
    for (int i = 0; i < 3; i++)
      force[i] -= nodal[i]; /* f1 is an internal force */
    dissipation += states->dissipation[a];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, counts, 3, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &dissipation, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  interface->friction_work += dissipation;
  *work += interface->friction_work;
  if (!interface->skin) cJSON_AddItemToObject(json, "force", cJSON_CreateDoubleArray(force, 3)); /* a skin has both sides */
  cJSON_AddNumberToObject(json, "gap", counts[STICKSLIP_STATE_GAP]);
  cJSON_AddNumberToObject(json, "stick", counts[STICKSLIP_STATE_STICK]);
  cJSON_AddNumberToObject(json, "slip", counts[STICKSLIP_STATE_SLIP]);
  cJSON_AddNumberToObject(json, "overlap", interface->depth);
  cJSON_AddNumberToObject(json, "lag", interface->lag.amount);
  cJSON_AddNumberToObject(json, "lag_force", interface->lag_force);
  if (decision_is_points(interface)) PetscCall(add_closed_area(interface, json));
  if (layer_is_there(interface)) PetscCall(add_layer(interface, json));
  if (!weights_are_of_now(interface)) cJSON_AddNumberToObject(json, "slid", interface->slide.amount);
  if (interface->method.weights == STICKSLIP_WEIGHTS_REFERENCE) cJSON_AddNumberToObject(json, "turned", interface->turn.amount);
  if (interface->tied_gap > 0) cJSON_AddNumberToObject(json, "tied_gap", interface->tied_gap);
  if (write) PetscCall(csv_write(output, interface, states, temperatures, step));
  snprintf(progress, length, "  %s %d gap %d stick %d slip", interface->name, (int)counts[STICKSLIP_STATE_GAP],
           (int)counts[STICKSLIP_STATE_STICK], (int)counts[STICKSLIP_STATE_SLIP]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* f . u of the loads; each rank holds its part of f and the whole of u at its vertices */
static PetscErrorCode external_work(Output *output, PetscReal *work)
{
  Physics           *physics = output->physics;
  const PetscScalar *f, *u;
  PetscFunctionBegin;
  *work = 0;
  PetscCall(VecGetArrayRead(physics->f_external, &f));
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  for (PetscInt k = 0; k < physics->unknowns.n_local; k++)
    *work += 0.5 * PetscRealPart(f[k] * u[k]);
  *work += 0.5 * rigids_work_before(physics, f);
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCall(VecRestoreArrayRead(physics->f_external, &f));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, work, 1, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode add_probes(Output *output, cJSON *json)
{
  cJSON             *probes = cJSON_AddObjectToObject(json, "probes");
  const PetscScalar *u;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(output->physics->u_local, &u));
  for (PetscInt k = 0; k < output->n_probes; k++) {
    PetscReal displacement[3];
    PetscCall(unknowns_displacement(output->physics, output->probes[k].vertex, u, displacement));
    cJSON_AddItemToObject(probes, output->probes[k].name, cJSON_CreateDoubleArray(displacement, 3));
  }
  PetscCall(VecRestoreArrayRead(output->physics->u_local, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool is_due(WriteWhen when, PetscBool asked, PetscBool last)
{
  return (PetscBool)(when == WRITE_ALL || (when == WRITE_TIMES && asked) || (when == WRITE_LAST && last));
}

/* the cycles that Newton's method met since the last report, and the nodes that changed state in its last attempt */
static void add_states(Output *output, cJSON *json)
{
  Newton *newton = &output->solve->newton;
  if (newton->state_changes) cJSON_AddItemToObject(json, "state_changes", newton->state_changes);
  if (newton->cycles) cJSON_AddItemToObject(json, "cycles", newton->cycles);
  newton->cycles = newton->state_changes = NULL;
}

/* Between t_last and physics->t. Its sentence is printed where it differs from the one before: a refusal by the library
 * may come with every attempt. */
PetscErrorCode summary_failed_attempt(Output *output, Summary *summary, PetscReal t_last)
{
  const Newton *newton = &output->solve->newton;
  cJSON        *json   = cJSON_CreateObject();

  PetscFunctionBegin;
  add_time(json, "from", t_last);
  add_time(json, "t", output->physics->t);
  cJSON_AddNumberToObject(json, "newton_iterations", newton->iterations);
  cJSON_AddStringToObject(json, "why", newton->why);
  add_states(output, json);
  cJSON_AddItemToArray(summary->failed_attempts, json);
  if (!output->quiet) {
    const PetscBool again = (PetscBool)!strcmp(summary->said, newton->why);
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "     t %-10.6g %s: %s\n", (double)output->physics->t,
                          newton->refused_commit ? "refused" : "not converged", again ? "as before" : newton->why));
    PetscCall(PetscSNPrintf(summary->said, sizeof(summary->said), "%s", newton->why));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode summary_step(Output *output, Summary *summary, PetscInt step, PetscBool converged, PetscBool asked,
                            PetscBool last)
{
  Physics        *physics = output->physics;
  Contact        *contact = output->contact;
  Solve          *solve   = output->solve;
  const PetscBool csv     = (PetscBool)(converged && is_due(output->write_csv, asked, last));
  const PetscBool vtu     = (PetscBool)(converged && is_due(output->write_vtu, asked, last));
  cJSON          *json    = cJSON_CreateObject(), *interfaces;
  PetscReal      *norms   = NULL, half_fu;
  PetscInt        n_norms = 0;
  double          friction_work = 0;
  char           *progress      = summary->progress; /* what summary_settle_step() prints */

  PetscFunctionBegin;
  PetscCall(SNESGetConvergenceHistory(solve->snes, &norms, NULL, &n_norms));
  add_time(json, "t", physics->t);
  cJSON_AddBoolToObject(json, "converged", converged);
  cJSON_AddNumberToObject(json, "newton_iterations", solve->iterations);
  cJSON_AddItemToObject(json, "residual_norms", cJSON_CreateDoubleArray(norms, (int)n_norms));
  add_states(output, json);
  if (solve->jacobian_tests) cJSON_AddItemToObject(json, "jacobian_tests", solve->jacobian_tests);
  solve->jacobian_tests = NULL;
  cJSON_AddItemToArray(summary->steps, json);
  PetscCall(PetscSNPrintf(progress, sizeof(summary->progress),
                          "%4" PetscInt_FMT " t %-10.6g newton %2" PetscInt_FMT "  |r| %.2e", step, (double)physics->t,
                          solve->iterations, n_norms ? (double)norms[n_norms - 1] : 0.0));
  if (!converged) PetscFunctionReturn(PETSC_SUCCESS);

  cJSON_AddNumberToObject(json, "reference_force", physics->parts.reference_force);
  PetscCall(external_work(output, &half_fu));
  cJSON_AddNumberToObject(json, "external_work_half_fu", half_fu);
  PetscCall(acting_report(output, json));
  PetscCall(contact_collect(contact));
  PetscCall(heat_collect(output->heat));
  interfaces = cJSON_AddObjectToObject(json, "interfaces");
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const size_t used       = strlen(progress);
    summary->work_before[i] = contact->interfaces[i].friction_work;
    PetscCall(interface_results(output, &contact->interfaces[i],
                                output->heat->on ? output->heat->interfaces[i].temperatures : NULL, step, csv, interfaces, &friction_work,
                                progress + used, sizeof(summary->progress) - used));
  }
  PetscCall(add_probes(output, json));
  PetscCall(heat_results(output, json));
  PetscCall(sensitivity_report(output, json));
  if (vtu) PetscCall(vtu_write(output, step));
  if (vtu) PetscCall(vtu_rigids(output, step));
  if (vtu) PetscCall(vtu_skin(output, step));
  PetscCall(held_check(solve));
  PetscCall(held_check_springs(solve));
  cJSON_AddNumberToObject(json, "friction_work", friction_work);
  PetscCall(energy_report(output, friction_work, json));
  fluid_report(physics, json);
  if (last) PetscCall(redundant_report(output, summary->root));
  if (last) PetscCall(skin_report(output, summary->root));
  PetscCall(VecDuplicate(physics->u_local, &summary->state));
  PetscCall(VecCopy(physics->u_local, summary->state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode summary_settle_step(Output *output, Summary *summary, PetscBool accepted)
{
  PetscFunctionBegin;
  if (accepted && !output->quiet) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s\n", summary->progress));
  PetscCall(held_settle(output->solve, accepted));
  if (accepted) PetscCall(energy_settle(output));
  if (accepted) PetscCall(range_check(output->physics, summary->state));
  if (accepted) PetscCall(loads_check_turn(output->physics, summary->state));
  PetscCall(VecDestroy(&summary->state));
  if (accepted) PetscFunctionReturn(PETSC_SUCCESS);
  cJSON_DeleteItemFromArray(summary->steps, cJSON_GetArraySize(summary->steps) - 1);
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++)
    output->contact->interfaces[i].friction_work = summary->work_before[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An array as a text or from one: times keep all their digits. */
static PetscErrorCode archive_array(cJSON **array, const char *name, Archive *archive)
{
  static const char *const times[] = {"t", "from"};
  char                    *text = NULL, *printed = archive->reading || archive->rank ? NULL : cJSON_PrintUnformatted(*array);
  cJSON                   *item;
  PetscFunctionBegin;
  if (printed) PetscCall(PetscStrallocpy(printed, &text));
  cJSON_free(printed);
  PetscCall(archive_text(archive, name, &text));
  if (archive->reading && text) {
    cJSON_Delete(*array);
    *array = cJSON_Parse(text);
    cJSON_ArrayForEach(item, *array) {
      for (int k = 0; k < 2; k++) {
        const cJSON *time = cJSON_GetObjectItem(item, times[k]);
        char         number[32];
        if (!time) continue;
        snprintf(number, sizeof(number), "%.17g", time->valuedouble);
        cJSON_ReplaceItemInObject(item, times[k], cJSON_CreateRaw(number));
      }
    }
  }
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode summary_archive(Summary *summary, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(archive_array(&summary->steps, "steps", archive));
  PetscCall(archive_array(&summary->failed_attempts, "failed_attempts", archive));
  PetscCall(archive_bytes(archive, "said", sizeof(summary->said), summary->said));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `last`: the last converged state */
PetscErrorCode summary_write(Output *output, Summary **summary, Vec last, PetscInt cutbacks, const char *message)
{
  Solve *solve = output->solve;
  char  *text, path[PETSC_MAX_PATH_LEN];
  FILE  *file;

  PetscFunctionBegin;
  cJSON_AddNumberToObject((*summary)->root, "cutbacks", cutbacks);
  if (message[0]) cJSON_AddStringToObject((*summary)->root, "message", message);
  cJSON_AddItemToObject((*summary)->root, "failed_attempts", (*summary)->failed_attempts);
  cJSON_AddItemToObject((*summary)->root, "steps", (*summary)->steps);
  if (solve->held.by_contact && solve->held.by_contact->child)
    cJSON_AddItemReferenceToObject((*summary)->root, "held_by_contact", solve->held.by_contact);
  if (solve->held.laid_down) cJSON_AddItemReferenceToObject((*summary)->root, "laid_down", solve->held.laid_down);
  if (solve->held.by_nothing.json)
    cJSON_AddItemReferenceToObject((*summary)->root, "held_by_nothing", solve->held.by_nothing.json);
  if (solve->held.by_springs.json)
    cJSON_AddItemReferenceToObject((*summary)->root, "held_by_soft_springs", solve->held.by_springs.json);
  if (solve->least_pivot > 0) cJSON_AddNumberToObject((*summary)->root, "least_pivot", solve->least_pivot);
  if (solve->n_raised) cJSON_AddNumberToObject((*summary)->root, "mumps_workspace", solve->room); /* per cent, after it asked */
  PetscCall(range_report(output->physics, (*summary)->root));
  energy_summary(output, (*summary)->root);
  loads_report_turn(output->physics, (*summary)->root);
  PetscCall(summary_counters(output, (*summary)->root));
  PetscCall(summary_holdings(output, (*summary)->root));
  PetscCall(skin_report_tell(output, (*summary)->root));
  if (message[0])
    PetscCall(diagnosis_failed(output, (*summary)->root));
  else
    PetscCall(uniqueness_check(output, last, (*summary)->root));
  if (output->mesh->rank == 0) {
    text = cJSON_Print((*summary)->root);
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/summary.json", output->directory));
    file = fopen(path, "w");
    PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
    fprintf(file, "%s\n", text);
    fclose(file);
    cJSON_free(text);
  }
  cJSON_Delete((*summary)->root);
  PetscCall(PetscFree((*summary)->work_before));
  PetscCall(PetscFree(*summary));
  PetscFunctionReturn(PETSC_SUCCESS);
}
