/* With `dynamics`: what the time integration keeps, in summary.json by step and as a row of energy.csv, the first one at t = 0. Work
 * and losses are sums from then on. */
#include "output/output.h"
#include "physics/dynamics.h"
#include <cjson/cJSON.h>

/* In the order of the columns; `friction` is the part of what contact takes that the library counts as dissipation. */
enum { KINETIC, STRAIN, EXTERNAL, SUPPORTS, CONTACT, FRICTION, DAMPING, NUMERICAL, GIVEN, STORE, N_SCALARS };
static const char *const NAMES[N_SCALARS] = {"kinetic", "strain", "external_work", "support_work", "contact_work",
                                             "friction_dissipation", "damping", "numerical", "contact_gain", "contact_store"};

static void collect(const Dynamics *dynamics, const Balance *balance, PetscReal values[N_SCALARS])
{
  values[KINETIC]  = balance->kinetic;
  values[STRAIN]   = balance->strain;
  values[EXTERNAL] = balance->external;
  values[SUPPORTS] = balance->supports;
  values[CONTACT]  = balance->contact;
  values[FRICTION] = balance->friction;
  values[DAMPING]  = balance->damping;
  values[GIVEN]    = balance->given;
  values[STORE]    = balance->store;
  values[NUMERICAL] = dynamics_numerical(dynamics, balance);
}

static PetscErrorCode write_row(const Output *output, PetscReal t, const Balance *balance, PetscBool first)
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
  collect(output->physics->dynamics, balance, values);
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
  if (output->physics->dynamics) PetscCall(write_row(output, 0, &output->physics->dynamics->start, PETSC_TRUE));
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
  PetscCall(dynamics_measure(output->physics, store, friction));
  json = cJSON_AddObjectToObject(step, "energy");
  collect(dynamics, &dynamics->now, values);
  for (int k = 0; k < N_SCALARS; k++)
    cJSON_AddNumberToObject(json, NAMES[k], values[k]);
  cJSON_AddItemToObject(step, "momentum", cJSON_CreateDoubleArray(dynamics->now.momentum, 3));
  cJSON_AddItemToObject(step, "angular_momentum", cJSON_CreateDoubleArray(dynamics->now.angular, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step is accepted. */
PetscErrorCode energy_settle(const Output *output)
{
  PetscFunctionBegin;
  if (!output->physics->dynamics) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(energy_tell(output));
  PetscCall(write_row(output, output->physics->t, &output->physics->dynamics->now, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
