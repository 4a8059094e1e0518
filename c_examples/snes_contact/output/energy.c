/* With `dynamics`: what the time integration keeps, in summary.json by step and as a row of energy.csv, the first one at t = 0. Work
 * and losses are sums from then on. */
#include "output/output.h"
#include "physics/dynamics.h"
#include <cjson/cJSON.h>

/* In the order of the columns; `friction` is the part of what contact takes that the library counts as dissipation. */
enum { KINETIC, STRAIN, EXTERNAL, SUPPORTS, CONTACT, FRICTION, DAMPING, NUMERICAL, GIVEN, STORE, N_SCALARS };
static const char *const NAMES[N_SCALARS] = {"kinetic", "strain", "external_work", "support_work", "contact_work",
                                             "friction_dissipation", "damping", "numerical", "contact_gain", "contact_store"};

/* What contact gives in a step, over the energy of the bodies before or after it, whichever is more, from which on it is told: far above
 * what Newton's method leaves. Bodies that start at rest have all their energy of this step. */
static const PetscReal GAIN = 1e-8;

static void collect(const Dynamics *dynamics, const Balance *balance, PetscReal friction, PetscReal values[N_SCALARS])
{
  const Balance *start = &dynamics->start;
  values[KINETIC]  = balance->kinetic;
  values[STRAIN]   = balance->strain;
  values[EXTERNAL] = balance->external;
  values[SUPPORTS] = balance->supports;
  values[CONTACT]  = balance->contact;
  values[FRICTION] = friction;
  values[DAMPING]  = balance->damping;
  values[GIVEN]    = balance->given;
  values[STORE]    = balance->store;
  /* what has come from nowhere: by rho_inf below 1, or finite strain */
  values[NUMERICAL] = (balance->kinetic - start->kinetic) + (balance->strain - start->strain) - balance->external - balance->supports -
                      balance->contact + balance->damping;
}

static PetscErrorCode write_row(const Output *output, PetscReal t, const Balance *balance, PetscReal friction, PetscBool first)
{
  PetscReal values[N_SCALARS];
  char      path[PETSC_MAX_PATH_LEN];
  FILE     *file;
  PetscFunctionBegin;
  if (output->mesh->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/energy.csv", output->directory));
  file = fopen(path, first ? "w" : "a");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
  if (first) {
    fprintf(file, "t");
    for (int k = 0; k < N_SCALARS; k++)
      fprintf(file, ",%s", NAMES[k]);
    fprintf(file, ",momentum_x,momentum_y,momentum_z,angular_x,angular_y,angular_z\n");
  }
  collect(output->physics->dynamics, balance, friction, values);
  fprintf(file, "%.17g", (double)t);
  for (int k = 0; k < N_SCALARS; k++)
    fprintf(file, ",%.17g", (double)values[k]);
  for (int i = 0; i < 6; i++)
    fprintf(file, ",%.17g", (double)(i < 3 ? balance->momentum[i] : balance->angular[i - 3]));
  fprintf(file, "\n");
  fclose(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode energy_begin(const Output *output)
{
  PetscFunctionBegin;
  if (output->physics->dynamics) PetscCall(write_row(output, 0, &output->physics->dynamics->start, 0, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The file as a text. */
static PetscErrorCode read_rows(const char *path, char **text)
{
  FILE *file = fopen(path, "rb");
  long  size;
  PetscFunctionBegin;
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot read '%s'", path);
  fseek(file, 0, SEEK_END);
  size = ftell(file);
  rewind(file);
  PetscCall(PetscCalloc1(size + 1, text));
  PetscCheck(fread(*text, 1, (size_t)size, file) == (size_t)size, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "cannot read '%s'", path);
  fclose(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode energy_archive(const Output *output, Archive *archive)
{
  char  path[PETSC_MAX_PATH_LEN], *text = NULL;
  FILE *file;
  PetscFunctionBegin;
  if (!output->physics->dynamics) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/energy.csv", output->directory));
  if (!archive->reading && !archive->rank) PetscCall(read_rows(path, &text));
  PetscCall(archive_text(archive, "energy.csv", &text));
  if (archive->reading && !archive->bad && !archive->rank && text) {
    file = fopen(path, "w");
    PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write '%s'", path);
    fputs(text, file);
    fclose(file);
  }
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a converged step, before it is committed. `friction`: up to here, on rank 0 */
PetscErrorCode energy_report(const Output *output, PetscReal friction, cJSON *step)
{
  const Dynamics *dynamics = output->physics->dynamics;
  PetscReal       values[N_SCALARS], store;
  cJSON          *json;
  PetscFunctionBegin;
  if (!dynamics) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(contact_store(output->contact, &store));
  PetscCall(dynamics_measure(output->physics, store));
  json = cJSON_AddObjectToObject(step, "energy");
  collect(dynamics, &dynamics->now, friction, values);
  for (int k = 0; k < N_SCALARS; k++)
    cJSON_AddNumberToObject(json, NAMES[k], values[k]);
  cJSON_AddItemToObject(step, "momentum", cJSON_CreateDoubleArray(dynamics->now.momentum, 3));
  cJSON_AddItemToObject(step, "angular_momentum", cJSON_CreateDoubleArray(dynamics->now.angular, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What may be behind it, and what to do instead. */
static const char *cause_of_gain(const Contact *contact)
{
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    if (decision_is_points(&contact->interfaces[i]))
      return "With `decision: points` it may, whatever the weights: a node's gap is a mean over the facets around it, so that forces are not quite those of "
             "what contact stores (contact_store). `decision: nodes` with `weights: persistent`, their default, gives none; finer facets give less.";
  }
  return "Overlaps at the start do so, and offsets that grow; else it is weights that are found anew after each step on curved surfaces. "
         "`weights: persistent`, the default where it goes with the rest, gives none; finer facets give less.";
}

/* The first time that contact gives energy. */
static PetscErrorCode warn(const Output *output)
{
  Dynamics       *dynamics = output->physics->dynamics;
  const Balance  *before = &dynamics->last, *now = &dynamics->now;
  const PetscReal gain = now->given - before->given, energy = PetscMax(before->kinetic + before->strain, now->kinetic + now->strain);
  PetscFunctionBegin;
  if (dynamics->told || gain <= GAIN * energy) PetscFunctionReturn(PETSC_SUCCESS);
  dynamics->told = PETSC_TRUE;
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "snes_contact: warning: in the step to t = %.6g contact gives the bodies %.2g of their energy. %s All of it: contact_gain in "
                         "energy.csv. See docs/dynamics.md.\n",
                         (double)output->physics->t, (double)(gain / energy), cause_of_gain(output->contact)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step is accepted. */
PetscErrorCode energy_settle(const Output *output)
{
  PetscReal friction = 0;
  PetscFunctionBegin;
  if (!output->physics->dynamics) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++)
    friction += output->contact->interfaces[i].friction_work;
  PetscCall(warn(output));
  PetscCall(write_row(output, output->physics->t, &output->physics->dynamics->now, friction, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
