/* Where an interface decides what is closed: at nodes, or at points of its facets, for which the library has to know how stiff the
 * bodies are: 1 / E* = (1 - nu1^2) / E1 + (1 - nu2^2) / E2, as in Hertz' formulas. */
#include "contact/contact.h"

/* `decision`, before what depends on it is read. */
void decision_read(Scene *scene, Interface *interface)
{
  static const char *const decisions[] = {"nodes", "points", NULL};
  PetscInt                 decision    = STICKSLIP_DECISION_NODES;
  scene_choice(scene, interface->name, "decision", decisions, &decision);
  interface->options.decision = (int32_t)decision;
  if (decision == STICKSLIP_DECISION_POINTS && scene_has(scene, interface->name, "augmentation_scale"))
    scene_fail(scene, interface->name, "augmentation_scale",
               "where points decide the answer depends on the modulus; to try another r give it as `augmentation`.");
}

PetscBool decision_is_points(const Interface *interface)
{
  return (PetscBool)(interface->options.decision == STICKSLIP_DECISION_POINTS);
}

/* E / (1 - nu^2), of plane stress E: what a half-space, or a half-plane, of the material resists with, by its small strains. */
static PetscReal half_space(const Space *space, const Material *material)
{
  const PetscReal nu = space->kind == SPACE_PLANE_STRESS ? 0 : material->poisson;
  return material->young / (1 - nu * nu);
}

/* The stiffest and the softest of the bodies that nodes first to end are of; 0: nothing of the side gives way. */
static void side_moduli(const Contact *contact, const Interface *interface, PetscInt first, PetscInt end, PetscReal moduli[2])
{
  moduli[0] = moduli[1] = 0;
  for (PetscInt k = first; k < end; k++) {
    const PetscInt  body = mesh_body_of(contact->mesh, interface->nodes[k]);
    PetscReal       modulus;
    if (interface->prescribed[k] == 7 || contact->mesh->bodies[body].rigid || contact->mesh->bodies[body].analytic) continue;
    modulus   = half_space(&contact->mesh->space, &contact->physics->materials[body]);
    moduli[0] = PetscMax(moduli[0], modulus);
    moduli[1] = moduli[1] > 0 ? PetscMin(moduli[1], modulus) : modulus;
  }
}

static PetscBool is_finite(const Contact *contact, const Interface *interface)
{
  for (PetscInt k = 0; k < interface->n1 + interface->n2; k++) {
    const PetscInt body = mesh_body_of(contact->mesh, interface->nodes[k]);
    if (contact->physics->materials[body].law->finite) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* rank 0: the modulus of both bodies, unless the scene has one. Of a side of several bodies the stiffest counts: too stiff costs
 * less accuracy than too soft (docs/accuracy.md). */
PetscErrorCode decision_settle(const Contact *contact, Interface *interface)
{
  PetscReal side[2][2], yielding = 0;
  PetscFunctionBegin;
  interface->modulus_from[0] = 0;
  if (!decision_is_points(interface)) PetscFunctionReturn(PETSC_SUCCESS);
  if (interface->options.modulus > 0) {
    PetscCall(PetscSNPrintf(interface->modulus_from, sizeof(interface->modulus_from), "the scene"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  side_moduli(contact, interface, 0, interface->n1, side[0]);
  side_moduli(contact, interface, interface->n1, interface->n1 + interface->n2, side[1]);
  for (int s = 0; s < 2; s++)
    yielding += side[s][0] > 0 ? 1 / side[s][0] : 0;
  interface->options.modulus = yielding > 0 ? 1 / yielding : half_space(&contact->mesh->space, &contact->physics->materials[0]);
  PetscCall(PetscSNPrintf(interface->modulus_from, sizeof(interface->modulus_from), "%s%s%s",
                          side[0][0] > 0 && side[1][0] > 0 ? "both bodies"
                          : yielding > 0                   ? "the body that is not rigid"
                                                           : "the first body, for nothing gives way",
                          side[0][0] > side[0][1] || side[1][0] > side[1][1] ? ", of a side of several the stiffest" : "",
                          is_finite(contact, interface) ? ", at small strains" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}
