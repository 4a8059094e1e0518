/* What a restart file keeps of the solver: the converged states that the next step starts from, how long it is to be, and what the run has
 * found so far. */
#include "physics/dynamics.h"
#include "physics/fluid.h"
#include "solve/solve.h"
#include <cjson/cJSON.h>
#include <string.h>

/* Steps that have been changed go on from the present time with the length that they begin with. */
static void begin_anew(const Steps *steps, PetscReal t, StepSize *size)
{
  step_size_start(steps, size);
  while (size->next + 1 < steps->n_targets && steps->targets[size->next] <= t)
    size->next++;
  if (!steps->automatic) size->length = size->longest = steps->targets[size->next] - t;
}

static PetscErrorCode archive_size(const Steps *steps, PetscReal t, StepSize *size, Archive *archive)
{
  const PetscReal numbers[] = {steps->smallest, steps->initial, steps->largest, (PetscReal)steps->iterations, (PetscReal)steps->automatic};
  uint64_t        now = digest(digest(DIGEST, (size_t)steps->n_targets * sizeof(*steps->targets), steps->targets), sizeof(numbers), numbers);
  uint64_t        then = now;
  StepSize        kept;
  PetscFunctionBegin;
  memset(&kept, 0, sizeof(kept));
  kept = *size;
  PetscCall(archive_bytes(archive, "steps", sizeof(then), &then));
  PetscCall(archive_bytes(archive, "step_size", sizeof(kept), &kept));
  if (!archive->reading || archive->bad) PetscFunctionReturn(PETSC_SUCCESS);
  if (then == now)
    *size = kept;
  else
    begin_anew(steps, t, size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of motions that something is wrong with, as a text */
static PetscErrorCode archive_finding(const char *told, const char *name, HeldFinding *finding, Archive *archive)
{
  char *text = NULL, *printed = !archive->reading && finding->json ? cJSON_PrintUnformatted(finding->json) : NULL;
  PetscFunctionBegin;
  PetscCall(archive_bools(archive, told, 1, &finding->told));
  if (printed) PetscCall(PetscStrallocpy(printed, &text));
  cJSON_free(printed);
  PetscCall(archive_text(archive, name, &text));
  if (archive->reading && text) {
    cJSON_Delete(finding->json);
    finding->json = cJSON_Parse(text);
  }
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode archive_past(Solve *solve, Past *past, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(archive_reals(archive, "t_last", 1, &past->t_last));
  PetscCall(archive_reals(archive, "t_before", 1, &past->t_before));
  PetscCall(archive_bools(archive, "have_before", 1, &past->have_before));
  if (solve->physics->timed) {
    Vec place, let_go;
    timed_vectors(solve->physics, &place, &let_go);
    PetscCall(contact_archive_vector(solve->contact, "timed.place", place, archive));
    PetscCall(contact_archive_vector(solve->contact, "timed.let_go", let_go, archive));
  }
  for (PetscInt l = 0; l < solve->physics->n_loads; l++) {
    const Load *load = &solve->physics->loads[l];
    char        name[2 * NAME_LENGTH];
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid.%s", load->name));
    if (load->fluid) PetscCall(contact_archive_vector(solve->contact, name, load->fluid->start, archive));
    PetscCall(PetscStrlcat(name, ".leaks", sizeof(name)));
    if (load->fluid) PetscCall(archive_reals(archive, name, 1, &load->fluid->leaks));
    PetscCall(PetscStrlcat(name, ".before", sizeof(name)));
    if (load->fluid) PetscCall(archive_reals(archive, name, 1, &load->fluid->before));
  }
  PetscCall(contact_archive_unknowns(solve->contact, "last", past->last, archive));
  if (past->have_before) PetscCall(contact_archive_unknowns(solve->contact, "before", past->before, archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces of which ranks hold parts: their sum, with the owners. */
static PetscErrorCode archive_sum(Solve *solve, const char *name, Vec local, Archive *archive)
{
  Physics     *physics = solve->physics;
  PetscScalar *forces;
  PetscFunctionBegin;
  PetscCall(unknowns_sum(physics, local));
  PetscCall(contact_archive_vector(solve->contact, name, physics->f_sum, archive));
  if (!archive->reading || archive->bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCopy(physics->f_sum, local));
  PetscCall(VecGetArray(local, &forces));
  for (PetscInt k = 0; k < physics->mesh->n_points; k++) {
    PetscInt at;
    PetscCall(PetscSectionGetOffset(physics->unknowns.section, physics->mesh->points[k], &at));
    for (int i = 0; i < 3 && physics->unknowns.ghost[k]; i++)
      forces[at + i] = 0;
  }
  PetscCall(VecRestoreArray(local, &forces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With `dynamics`: how the bodies move, and the balance so far. */
static PetscErrorCode archive_motion(Solve *solve, Archive *archive)
{
  Dynamics *d = solve->physics->dynamics;
  PetscFunctionBegin;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(archive_reals(archive, "motion.t", 1, &d->t_n));
  PetscCall(archive_bytes(archive, "balance.start", sizeof(d->start), &d->start));
  PetscCall(archive_bytes(archive, "balance", sizeof(d->last), &d->last));
  PetscCall(archive_bools(archive, "balance.told", 1, &d->told));
  PetscCall(archive_bytes(archive, "balance.energies", sizeof(d->energies), d->energies));
  PetscCall(contact_archive_vector(solve->contact, "displacements", d->u, archive));
  PetscCall(contact_archive_vector(solve->contact, "velocities", d->v, archive));
  PetscCall(contact_archive_vector(solve->contact, "accelerations", d->prescribed, archive));
  PetscCall(archive_sum(solve, "smooth forces", d->force, archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode solve_archive(Solve *solve, Past *past, StepSize *size, Archive *archive)
{
  Linear   *linear   = &solve->linear;
  PetscInt *counts[] = {&linear->n_solves, &linear->n_direct, &linear->iterations, &linear->most};
  PetscFunctionBegin;
  PetscCall(archive_past(solve, past, archive));
  PetscCall(archive_motion(solve, archive));
  PetscCall(archive_size(&solve->steps, past->t_last, size, archive));
  PetscCall(archive_finding("held.told", "held.by_nothing", &solve->held.by_nothing, archive));
  PetscCall(archive_finding("held.drift_told", "held.by_springs", &solve->held.by_springs, archive));
  PetscCall(archive_reals(archive, "least_pivot", 1, &solve->least_pivot));
  PetscCall(archive_bools(archive, "begins_soft", 1, &solve->newton.begins_soft));
  for (int k = 0; k < 4; k++)
    PetscCall(archive_ints(archive, "linear", 1, counts[k]));
  PetscCall(solver_archive_room(solve, archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode solve_archive_pattern(Solve *solve, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(pattern_archive(solve, archive));
  if (archive->reading) PetscCall(solver_use_matrix(solve));
  PetscFunctionReturn(PETSC_SUCCESS);
}
