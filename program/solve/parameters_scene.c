/* What the scene wants to know the influence of. */
#include "physics/springs.h"
#include "physics/dynamics.h"
#include "solve/sensitivity.h"
#include <string.h>

static const char *const KINDS[N_PARAMETER_KINDS] = {"friction", "shear_limit", "offset", "young", "load", "support"};

/* number of the thing of this name, -1: there is none */
static PetscInt find(const Solve *solve, ParameterKind kind, const char *name)
{
  const Physics *physics = solve->physics;
  const Contact *contact = solve->contact;
  switch (kind) {
  case PARAMETER_LOAD:
    for (PetscInt l = 0; l < physics->n_loads; l++) {
      if (!strcmp(physics->loads[l].name, name)) return l;
    }
    return -1;
  case PARAMETER_SUPPORT:
    for (PetscInt s = 0; s < physics->n_supports; s++) {
      if (!strcmp(physics->supports[s].name, name)) return s;
    }
    return -1;
  default:
    for (PetscInt i = 0; i < contact->n_interfaces; i++) {
      if (!strcmp(contact->interfaces[i].name, name)) return i;
    }
    return -1;
  }
}

/* Is a parameter of this kind one of this thing? */
static void check(Scene *scene, const Solve *solve, const Parameter *parameter, const char *of)
{
  const char *key = KINDS[parameter->kind], *name = parameter->name;
  if (parameter->kind == PARAMETER_FRICTION && solve->contact->interfaces[parameter->number].options.friction != STICKSLIP_FRICTION_COULOMB)
    scene_fail(scene, name, key, "'%s' has no Coulomb friction that it could be the coefficient of.", of);
  if (parameter->kind == PARAMETER_SHEAR_LIMIT && solve->contact->interfaces[parameter->number].options.shear_limit == 0)
    scene_fail(scene, name, key, "'%s' has no `shear_limit`.", of);
  if (parameter->kind == PARAMETER_YOUNG && (solve->mesh->bodies[parameter->number].rigid || solve->mesh->bodies[parameter->number].analytic))
    scene_fail(scene, name, key, "'%s' is rigid.", of);
  if (parameter->kind == PARAMETER_SUPPORT) {
    const PetscReal *w = solve->physics->supports[parameter->number].rotate;
    if (w[0] != 0 || w[1] != 0 || w[2] != 0) scene_fail(scene, name, key, "'%s' turns what it holds, which no factor is on.", of);
  }
}

static void read_parameter(Scene *scene, const Solve *solve, Parameter *parameter)
{
  const char *name = parameter->name;
  char        of[NAME_LENGTH];
  if (!strcmp(name, "deviation") || !strcmp(name, "imbalance"))
    scene_fail(scene, NULL, "parameters", "the results have something else that is called '%s'; choose another name.", name);
  parameter->kind = N_PARAMETER_KINDS;
  for (int kind = 0; kind < N_PARAMETER_KINDS; kind++) {
    if (!scene_has(scene, name, KINDS[kind])) continue;
    if (parameter->kind != N_PARAMETER_KINDS)
      scene_fail(scene, name, KINDS[kind], "it is of `%s` already; a parameter is of one thing.", KINDS[parameter->kind]);
    parameter->kind = (ParameterKind)kind;
  }
  if (parameter->kind == N_PARAMETER_KINDS)
    scene_fail(scene, name, NULL, "what is it of? Give `friction`, `shear_limit` or `offset` the name of an interface, `young` that of a body, or "
                                  "`load` or `support` that of one.");
  scene_string_required(scene, name, KINDS[parameter->kind], of, sizeof(of));
  parameter->number = parameter->kind == PARAMETER_YOUNG ? mesh_body(scene, solve->mesh, name, "young", of) : find(solve, parameter->kind, of);
  if (parameter->number < 0)
    scene_fail(scene, name, KINDS[parameter->kind], "there is no %s '%s'.",
               parameter->kind < PARAMETER_YOUNG ? "interface" : KINDS[parameter->kind], of);
  check(scene, solve, parameter, of);
  scene_real(scene, name, "deviation", &parameter->deviation);
}

void sensitivity_refuse(Scene *scene, const Solve *solve, PetscBool wrong, const char *what)
{
  if (solve->sensitivity && wrong) scene_fail(scene, NULL, "parameters", "they do not go with %s yet.", what);
}

/* Models whose residual depends on what is not followed here. The library refuses by name what it has no derivatives of. */
static void refuse_models(Scene *scene, const Solve *solve)
{
  const Physics *physics = solve->physics;
  sensitivity_refuse(scene, solve, (PetscBool)(physics->dynamics != NULL), "`dynamics`");
  sensitivity_refuse(scene, solve, (PetscBool)(physics->springs != NULL), "`springs`");
  sensitivity_refuse(scene, solve, (PetscBool)(physics->n_rigids > 0), "rigid bodies");
  sensitivity_refuse(scene, solve, (PetscBool)(timed_first(physics) != NULL), "supports that hold for a part of the run (`from`, `until`)");
  sensitivity_refuse(scene, solve, loads_follow(physics), "pressures that follow their surface (`follower`)");
  sensitivity_refuse(scene, solve, solve->contact->condensed, "`unknowns: displacements`");
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++) {
    const Interface *interface = &solve->contact->interfaces[i];
    sensitivity_refuse(scene, solve, (PetscBool)(interface->skin != NULL), "`contact: all`");
    sensitivity_refuse(scene, solve, (PetscBool)(interface->method.form == STICKSLIP_FORM_AUGMENTED), "`form: augmented`");
    sensitivity_refuse(scene, solve, (PetscBool)(interface->method.normals == STICKSLIP_NORMALS_COMMITTED && interface->method.weights != STICKSLIP_WEIGHTS_REFERENCE),
                       "`normals: committed`");
  }
}

PetscErrorCode sensitivity_read(Scene *scene, Solve *solve)
{
  Sensitivity *all;
  char       **names;
  PetscInt     n;
  PetscFunctionBegin;
  scene_names(scene, "parameters", &n, &names);
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&all));
  all->n = n;
  PetscCall(PetscCalloc1(n, &all->parameters));
  solve->sensitivity = all;
  for (PetscInt p = 0; p < n; p++) {
    PetscCall(PetscSNPrintf(all->parameters[p].name, NAME_LENGTH, "%s", names[p]));
    read_parameter(scene, solve, &all->parameters[p]);
  }
  strings_destroy(n, &names);
  refuse_models(scene, solve);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode sensitivity_destroy(Solve *solve)
{
  Sensitivity *all = solve->sensitivity;
  PetscFunctionBegin;
  if (!all) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt p = 0; p < all->n; p++) {
    PetscCall(VecDestroy(&all->parameters[p].last));
    PetscCall(VecDestroy(&all->parameters[p].now));
    PetscCall(PetscFree(all->parameters[p].reactions));
  }
  PetscCall(VecDestroy(&all->forces));
  PetscCall(PetscFree(all->parameters));
  PetscCall(PetscFree(solve->sensitivity));
  PetscFunctionReturn(PETSC_SUCCESS);
}
