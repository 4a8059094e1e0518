/* Where an interface decides what is closed: at nodes, or at points of its facets, for which the library has to know how stiff the
 * bodies are: 1 / E* = (1 - nu1^2) / E1 + (1 - nu2^2) / E2, as in Hertz' formulas. */
#include "contact/contact.h"

/* `decision`, before what depends on it is read. */
void decision_read(Scene *scene, Interface *interface)
{
  static const char *const decisions[] = {"nodes", "points", NULL};
  PetscInt                 decision    = STICKSLIP_DECISION_NODES;
  scene_choice(scene, interface->name, "decision", decisions, &decision);
  interface->method.decision = (int32_t)decision;
  if (decision == STICKSLIP_DECISION_POINTS && scene_has(scene, interface->name, "augmentation_scale"))
    scene_fail(scene, interface->name, "augmentation_scale",
               "where points decide the answer depends on the modulus; to try another r give it as `augmentation`.");
}

PetscBool decision_is_points(const Interface *interface)
{
  return (PetscBool)(interface->method.decision == STICKSLIP_DECISION_POINTS);
}

/* Facets with nodes in the middle of their edges know no weights of now: unless the scene says which it wants, those of the last commit. */
PetscErrorCode decision_hold(Scene *scene, const Contact *contact, Interface *interface)
{
  stickslip_method *const methods[] = {&interface->method, &interface->otherwise};
  PetscBool               middles;
  PetscFunctionBegin;
  if (!decision_is_points(interface) || scene_has(scene, interface->name, "weights")) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(surfaces_have_middles(contact->mesh, interface, &middles));
  for (int i = 0; i < 2 && middles; i++) {
    if (methods[i]->weights != STICKSLIP_WEIGHTS_CURRENT) continue;
    methods[i]->weights = STICKSLIP_WEIGHTS_COMMITTED;
    if (!scene_has(scene, interface->name, "normals")) methods[i]->normals = STICKSLIP_NORMALS_COMMITTED;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* E / (1 - nu^2), of plane stress E: what a half-space, or a half-plane, of the material resists with, by its small strains. */
static PetscReal half_space(const Space *space, const Material *material)
{
  const PetscReal nu = space->kind == SPACE_PLANE_STRESS ? 0 : material->poisson;
  return material->young / (1 - nu * nu);
}

/* rank by rank: does anything of a side, nodes first to end here, give way? */
static PetscBool gives_way(const Contact *contact, const Interface *interface, int side, PetscInt first, PetscInt end)
{
  const Body *body = &contact->mesh->bodies[interface->body[side]];
  for (PetscInt k = first; k < end && !body->rigid && !body->analytic; k++) {
    if (interface->prescribed[k] != 7) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* The modulus of both bodies, unless the scene has one. */
PetscErrorCode decision_settle(const Contact *contact, Interface *interface)
{
  const PetscInt  n1     = interface->n1;
  const Material *first  = &contact->physics->materials[interface->body[0]], *second = &contact->physics->materials[interface->body[1]];
  PetscBool       way[2] = {PETSC_FALSE, PETSC_FALSE};
  PetscReal       yielding;
  PetscFunctionBegin;
  if (!decision_is_points(interface)) PetscFunctionReturn(PETSC_SUCCESS);
  if (interface->options.modulus > 0) {
    PetscCall(PetscSNPrintf(interface->modulus_from, sizeof(interface->modulus_from), "the scene"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  way[0] = gives_way(contact, interface, 0, 0, n1);
  way[1] = gives_way(contact, interface, 1, n1, n1 + interface->n2);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, way, 2, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  if (!way[0] && !way[1]) way[0] = PETSC_TRUE; /* nothing moves */
  yielding = (way[0] ? 1 / half_space(&contact->mesh->space, first) : 0) + (way[1] ? 1 / half_space(&contact->mesh->space, second) : 0);
  interface->options.modulus = 1 / yielding;
  PetscCall(PetscSNPrintf(interface->modulus_from, sizeof(interface->modulus_from), "%s%s",
                          way[0] && way[1] ? "both bodies" : "the body that gives way",
                          (way[0] && first->law->finite) || (way[1] && second->law->finite) ? ", at small strains" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}
