/* With frozen weights contact is sought, and forces act on the mortar side, where the surfaces were when the weights were made. A
 * step that slides farther than that shows still converges, and is wrong by about the slide. With weights of the reference normals are of
 * then, too: where a surface turns, this part of the pressure acts as a shear. How far either is, the library says
 * (stickslip_equilibrium); what is done about it is said here: steps with `weights: committed` are cut back, for the
 * next commit makes the weights anew. With `weights: reference` none does, and the run is told once. */
#include "contact/contact.h"

/* Of what friction holds, that a step may have wrong where points slip: the pressure acts along the normals of the step's start, and where
 * these have turned by theta since, theta / mu of the friction is the pressure's. */
static const PetscReal FRICTION_OFF = 0.02;

PetscBool weights_are_of_now(const Interface *interface)
{
  const int32_t weights = interface->method.weights;
  return (PetscBool)(weights == STICKSLIP_WEIGHTS_CURRENT || weights == STICKSLIP_WEIGHTS_CONSERVING);
}

/* Over all ranks, of the last evaluation that was judged: what a part has found, and where[0:3], the node. */
PetscErrorCode slide_find(const Interface *interface, const Mesh *mesh, double found, int64_t node, Frozen *frozen, PetscReal where[4])
{
  const ContactPart *part = &interface->part;
  PetscFunctionBegin;
  frozen->amount = verb_there(part) && found > 0 ? found : 0;
  if (frozen->amount > 0) contact_vector(part->dimension, part->X, (PetscInt)node, where);
  PetscCall(contact_largest(mesh, &frozen->amount, 4 * sizeof(*where), where));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The slide over the size of the node's facets. */
static PetscErrorCode measure_slide(Interface *interface, const Mesh *mesh)
{
  const stickslip_equilibrium *e        = &interface->equilibrium;
  Frozen                      *slide    = &interface->slide;
  PetscReal                    where[4] = {0, 0, 0, e->slide};
  PetscFunctionBegin;
  PetscCall(slide_find(interface, mesh, e->slide > 0 ? e->slide / e->slide_scale : 0, e->slide_node, slide, where));
  PetscCall(PetscSNPrintf(slide->words, sizeof(slide->words),
                          "%s has slid by %.2g since its weights were made, %.2g times the size of the facets at (%g, %g, %g)",
                          interface->name, (double)where[3], (double)slide->amount, (double)where[0], (double)where[1],
                          (double)where[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tied, with offsets: these act along the first normals, whatever the weights. */
static PetscBool turned_offsets(const Interface *interface)
{
  return (PetscBool)(interface->options.friction == STICKSLIP_FRICTION_TIED && interface->offsets.any);
}

static PetscErrorCode measure_turn(Interface *interface, const Mesh *mesh)
{
  const stickslip_equilibrium *e        = &interface->equilibrium;
  Frozen                      *turn     = &interface->turn;
  PetscReal                    where[4] = {0};
  PetscFunctionBegin;
  PetscCall(slide_find(interface, mesh, e->turn, e->turn_node, turn, where));
  PetscCall(PetscSNPrintf(turn->words, sizeof(turn->words),
                          "%s has turned by %.2g radians since its weights were made, at (%g, %g, %g): %.2g %% of the %s there acts along "
                          "the surface as it is now",
                          interface->name, (double)turn->amount, (double)where[0], (double)where[1], (double)where[2],
                          (double)(100 * PetscSinReal(turn->amount)), turned_offsets(interface) ? "offset" : "pressure"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* There weights of now are refused. */
static PetscBool decides_at_points_with_friction(const Interface *interface)
{
  return (PetscBool)(decision_is_points(interface) && interface->options.friction != STICKSLIP_FRICTION_NONE);
}

/* Where points slip: has the surface turned too far in the step? */
static PetscErrorCode check_friction(Interface *interface, const Mesh *mesh, PetscReal *slid, char why[], size_t length)
{
  const PetscReal most = FRICTION_OFF * interface->options.mu;
  PetscFunctionBegin;
  PetscCall(measure_turn(interface, mesh));
  if (most > 0) *slid = PetscMax(*slid, interface->turn.amount / most);
  if (most > 0 && interface->turn.amount > most)
    PetscCall(PetscSNPrintf(why, length, "converged, but %s, which is %.2g %% of what friction holds: take shorter steps", interface->turn.words,
                            (double)(100 * interface->turn.amount / interface->options.mu)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At a converged state: how far weights of the last step have slid, over what is allowed. `why`, where that is too far: the step does
 * not count. */
PetscErrorCode slide_check(Contact *contact, PetscReal *slid, char why[], size_t length)
{
  PetscFunctionBegin;
  *slid = 0;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    if (turned_offsets(interface)) {
      PetscCall(measure_turn(interface, contact->mesh));
      continue;
    }
    if (weights_are_of_now(interface)) continue;
    PetscCall(measure_slide(interface, contact->mesh));
    if (interface->method.weights == STICKSLIP_WEIGHTS_REFERENCE) {
      PetscCall(measure_turn(interface, contact->mesh));
      continue;
    }
    if (decides_at_points_with_friction(interface)) PetscCall(check_friction(interface, contact->mesh, slid, why, length));
    *slid = PetscMax(*slid, interface->slide.amount / interface->slide.most);
    if (interface->slide.amount <= interface->slide.most) continue;
    PetscCall(PetscSNPrintf(why, length,
                            "converged, but %s, where weights of the last step are good for %g times: take shorter steps, "
                            "%sor a larger `slide_max`",
                            interface->slide.words, (double)interface->slide.most,
                            decides_at_points_with_friction(interface) ? "" : "`weights: current`, "));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode tell(PetscReal t, Frozen *frozen, const char *means, const char *instead, const char *key)
{
  PetscFunctionBegin;
  if (frozen->told || !(frozen->amount > frozen->most)) PetscFunctionReturn(PETSC_SUCCESS);
  frozen->told = PETSC_TRUE;
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "stickslip: warning: at t = %.6g %s. %s %s a larger `%s` (it is %g) if that is meant.\n", (double)t,
                         frozen->words, means, instead, key, (double)frozen->most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step counts. */
PetscErrorCode slide_accept(Contact *contact)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    if (turned_offsets(interface)) {
      PetscCall(tell(contact->physics->t, &interface->turn,
                     "Offsets of tied surfaces act along the normals that the surfaces had at first, and do not turn with the bodies.",
                     "Mesh the interference or the gap, or take", "turn_max"));
      continue;
    }
    if (interface->method.weights != STICKSLIP_WEIGHTS_REFERENCE) continue;
    PetscCall(tell(contact->physics->t, &interface->slide,
                   "Weights of the reference know no sliding: contact is sought, and forces act on the mortar side, where the surfaces "
                   "were at first.",
                   "Take `weights: current`, or", "slide_max"));
    PetscCall(tell(contact->physics->t, &interface->turn,
                   "Weights of the reference know no turn: pressure acts along the normals that the surfaces had at first.",
                   "Take `weights: current`, or", "turn_max"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
