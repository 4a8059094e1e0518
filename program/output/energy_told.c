/* With `dynamics`: energy that comes from nowhere or goes where nothing takes it, told in the step where it begins, and in summary.json. A step
 * after which the bodies have far more or less than they should does not count. */
#include "output/output.h"
#include "physics/dynamics.h"
#include <cjson/cJSON.h>

/* What contact gives in a step, over the energy of the bodies before or after it, whichever is more, from which on it is told: far above
 * what Newton's method leaves. Bodies that start at rest have all their energy of this step. */
static const PetscReal GAIN = 1e-8;
/* What has come or gone since t = 0, over the most that the bodies had, from which on it is told (again): as much as meshes are off by. */
static const PetscReal TOLD = 0.01;
/* What the time integration may give or take of it: beyond, nothing that is left is the scene's. */
static const PetscReal MOST = 0.5;

static const char *const NAMES[N_ENERGIES] = {"contact_gain", "numerical", "impact"};

/* The time integration may take what it likes where the scene asks it to. */
static PetscReal numerical(const Dynamics *dynamics, const Balance *balance)
{
  const PetscReal value = dynamics_numerical(dynamics, balance);
  return dynamics->rho_inf < 1 ? PetscMax(value, 0) : PetscAbsReal(value);
}

static PetscBool any_at_points(const Contact *contact)
{
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    if (decision_is_points(&contact->interfaces[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool any_found_anew(const Contact *contact)
{
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    if (contact->interfaces[i].method.weights == STICKSLIP_WEIGHTS_CURRENT) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* What may be behind it, and what to do instead. */
static const char *cause(const Output *output, int kind)
{
  if (kind == ENERGY_TIME && output->physics->dynamics->rho_inf < 1)
    return "With rho_inf below 1 bodies of finite strain that turn by much in a step gain energy: take shorter steps, or rho_inf 1, which keeps it.";
  if (kind == ENERGY_TIME)
    return "Energy is kept but for the twelfth power of what a step strains neo-Hooke by, and for what Newton's method leaves: take shorter steps, or a lower "
           "-snes_rtol.";
  if (kind == ENERGY_IMPACT && any_found_anew(output->contact))
    return "Nodes that meet stop each other within a step, and their motion is lost; weights that are found anew take some on curved surfaces, too. See "
           "whether shorter steps and finer facets change it: contact_work and friction_dissipation in energy.csv.";
  if (kind == ENERGY_IMPACT)
    return "Nodes that meet stop each other within a step, and their motion is lost. See whether shorter steps and finer facets change it: contact_work "
           "and friction_dissipation in energy.csv.";
  if (any_at_points(output->contact))
    return "With `decision: points` it may, whatever the weights: a node's gap is a mean over the facets around it, so that forces are not quite those of "
           "what contact stores (contact_store). Finer facets give less. All of it: contact_gain in energy.csv.";
  return "Overlaps at the start do so, and offsets that grow; else it is weights that are found anew after each step, where surfaces slide or turn. Finer "
         "facets give less. `weights: conserving` gives none. All of it: contact_gain in energy.csv.";
}

static PetscErrorCode tell(const Output *output, int kind, const char *what, PetscReal part)
{
  PetscFunctionBegin;
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR, "stickslip: warning: in the step to t = %.6g %s %.2g of their energy. %s See docs/dynamics.md.\n",
                         (double)output->physics->t, what, (double)part, cause(output, kind)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first time that contact gives energy at all; `told`: now */
static PetscErrorCode tell_first(const Output *output, PetscBool *told)
{
  Dynamics       *dynamics = output->physics->dynamics;
  const Balance  *before = &dynamics->last, *now = &dynamics->now;
  const PetscReal gain = now->given - before->given, energy = PetscMax(before->kinetic + before->strain, now->kinetic + now->strain);
  PetscFunctionBegin;
  *told = (PetscBool)(!dynamics->told && gain > GAIN * energy);
  if (!*told) PetscFunctionReturn(PETSC_SUCCESS);
  dynamics->told = PETSC_TRUE;
  PetscCall(tell(output, ENERGY_CONTACT, "contact gives the bodies", gain / energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A loss is compared with the most that the bodies had: while they still get more, as at first what starts from rest does, it is not known what that
 * is. */
static PetscBool waits(const Physics *physics, int kind)
{
  const Dynamics *dynamics = physics->dynamics;
  return (PetscBool)(kind == ENERGY_IMPACT && dynamics->now.largest > dynamics->last.largest && physics->t < physics->end);
}

/* The step is accepted. */
PetscErrorCode energy_tell(const Output *output)
{
  static const char *const WHAT[N_ENERGIES] = {"what contact has given the bodies since t = 0 comes to", "what the time integration has given or taken of the bodies since t = 0 comes to",
                                               "what contact has taken of the bodies since t = 0, beside friction, comes to"};
  Dynamics       *dynamics = output->physics->dynamics;
  const Balance  *now      = &dynamics->now;
  const PetscReal values[N_ENERGIES] = {now->given, numerical(dynamics, now), now->lost};
  PetscBool       first;
  PetscFunctionBegin;
  PetscCall(tell_first(output, &first));
  for (int k = 0; k < N_ENERGIES; k++) {
    EnergyTold *told = &dynamics->energies[k];
    if (told->t > 0 || values[k] <= TOLD * now->largest || waits(output->physics, k)) continue;
    *told = (EnergyTold){.t = output->physics->t, .part = values[k] / now->largest};
    if (k != ENERGY_CONTACT || !first) PetscCall(tell(output, k, WHAT[k], told->part));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a converged step that is measured; `why`: it does not count. `late`: most of that is of the steps before, so that no shorter one helps. */
PetscErrorCode energy_check(const Output *output, PetscBool *late, char why[], size_t length)
{
  const Dynamics *dynamics = output->physics->dynamics;
  PetscFunctionBegin;
  *late = PETSC_FALSE;
  if (!dynamics || numerical(dynamics, &dynamics->now) <= MOST * dynamics->now.largest) PetscFunctionReturn(PETSC_SUCCESS);
  *late = (PetscBool)(numerical(dynamics, &dynamics->last) > MOST / 2 * dynamics->last.largest);
  PetscCall(PetscSNPrintf(why, length, "converged, but the time integration has given or taken %.2g of the energy that the bodies had at most. %s",
                          (double)(numerical(dynamics, &dynamics->now) / dynamics->now.largest), cause(output, ENERGY_TIME)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void energy_summary(const Output *output, cJSON *root)
{
  const Dynamics *dynamics = output->physics->dynamics;
  cJSON          *all      = NULL;
  for (int k = 0; dynamics && k < N_ENERGIES; k++) {
    cJSON *json;
    if (!(dynamics->energies[k].t > 0)) continue;
    if (!all) all = cJSON_AddObjectToObject(root, "energy_told");
    json = cJSON_AddObjectToObject(all, NAMES[k]);
    cJSON_AddNumberToObject(json, "t", dynamics->energies[k].t);
    cJSON_AddNumberToObject(json, "part", dynamics->energies[k].part);
  }
}
