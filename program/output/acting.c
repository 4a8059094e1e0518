/* What acts on the bodies in a step, for summary.json: reactions of supports and their moments, what is left of those that were let go,
 * forces of springs, and of rigid bodies their motion and what acts on them. */
#include "output/output.h"
#include "physics/springs.h"
#include <cjson/cJSON.h>

static cJSON *vector_json(const PetscReal v[3])
{
  return cJSON_CreateDoubleArray(v, 3);
}

static PetscErrorCode add_reactions(Output *output, cJSON *json)
{
  Physics *physics   = output->physics;
  cJSON   *reactions = cJSON_AddObjectToObject(json, "reactions"), *moments;
  PetscFunctionBegin;
  PetscCall(supports_reactions(physics));
  for (PetscInt s = 0; s < physics->n_supports; s++)
    cJSON_AddItemToObject(reactions, physics->supports[s].name, vector_json(physics->supports[s].reaction));
  if (output->mesh->space.kind == SPACE_AXISYMMETRIC) PetscFunctionReturn(PETSC_SUCCESS); /* a ring has none */
  moments = cJSON_AddObjectToObject(json, "moments");
  for (PetscInt s = 0; s < physics->n_supports; s++)
    cJSON_AddItemToObject(moments, physics->supports[s].name, vector_json(physics->supports[s].moment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where several supports hold one component of a vertex each of them has its reaction: which, and the sum of all with nothing twice. */
static PetscErrorCode add_shared(const Physics *physics, cJSON *json)
{
  const PetscInt n    = physics->n_supports;
  cJSON         *all  = NULL, *earlier;
  PetscBool     *shared;
  PetscReal      total[3] = {0, 0, 0}, twice[3];
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n * n, &shared));
  PetscCall(supports_shared(physics, shared, twice));
  for (PetscInt s = 0; s < n; s++) {
    earlier = NULL;
    for (int i = 0; i < 3; i++)
      total[i] += physics->supports[s].reaction[i];
    for (PetscInt k = 0; k < s; k++) {
      if (!shared[n * s + k]) continue;
      if (!all) all = cJSON_AddObjectToObject(json, "reactions_shared");
      if (!earlier) earlier = cJSON_AddArrayToObject(all, physics->supports[s].name);
      cJSON_AddItemToArray(earlier, cJSON_CreateString(physics->supports[k].name));
    }
  }
  for (int i = 0; i < 3; i++)
    total[i] -= twice[i];
  if (all) cJSON_AddItemToObject(json, "reactions_total", vector_json(total));
  PetscCall(PetscFree(shared));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of supports that were let go: what is left of their reactions, a load on the bodies. */
static PetscErrorCode add_fading(const Physics *physics, cJSON *json)
{
  cJSON *all = NULL;
  PetscFunctionBegin;
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    PetscReal force[3];
    PetscBool fades;
    PetscCall(supports_fading(physics, &physics->supports[s], force, &fades));
    if (!fades) continue;
    if (!all) all = cJSON_AddObjectToObject(json, "fading");
    cJSON_AddItemToObject(all, physics->supports[s].name, vector_json(force));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The force of each spring on what it holds, at its first end. */
static PetscErrorCode add_springs(Output *output, cJSON *json)
{
  const Springs *springs = output->physics->springs;
  cJSON         *all;
  PetscFunctionBegin;
  if (!springs) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(springs_total(output->physics));
  all = cJSON_AddObjectToObject(json, "springs");
  for (PetscInt s = 0; s < springs->n; s++)
    cJSON_AddItemToObject(all, springs->spring[s].name, vector_json(springs->spring[s].total));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void add_six(cJSON *json, const char *force, const char *moment, const PetscReal six[RIGID_UNKNOWNS])
{
  cJSON_AddItemToObject(json, force, vector_json(six));
  cJSON_AddItemToObject(json, moment, vector_json(six + 3));
}

/* Of each rigid body: its motion, the sum of the rotation vectors of its steps, what it is turned by, and what acts on it. */
static void add_rigids(Output *output, cJSON *json)
{
  const Physics *physics = output->physics;
  cJSON         *all     = physics->n_rigids ? cJSON_AddObjectToObject(json, "rigid") : NULL;
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    cJSON       *body  = cJSON_AddObjectToObject(all, output->mesh->bodies[rigid->body].name);
    PetscReal    six[RIGID_UNKNOWNS], turned[9];
    for (int k = 0; k < RIGID_UNKNOWNS; k++)
      six[k] = rigid->motion[k] + (k < 3 ? 0 : rigid->sum[k - 3]);
    add_six(body, "displacement", "rotation", six);
    rigids_turned(rigid, turned);
    cJSON_AddItemToObject(body, "turned", cJSON_CreateDoubleArray(turned, 9));
    add_six(body, "contact_force", "contact_moment", rigid->on_body);
    add_six(body, "reaction_force", "reaction_moment", rigid->reaction);
  }
}

PetscErrorCode acting_report(Output *output, cJSON *step)
{
  PetscFunctionBegin;
  PetscCall(add_reactions(output, step));
  PetscCall(add_shared(output->physics, step));
  PetscCall(add_fading(output->physics, step));
  PetscCall(add_springs(output, step));
  add_rigids(output, step);
  PetscFunctionReturn(PETSC_SUCCESS);
}
