/* With frozen weights contact is sought, and forces act on the mortar side, where the surfaces were when the weights were made. A
 * step that slides farther than that shows still converges, and is wrong by about the slide. How far it is, the library says
 * (stickslip_equilibrium); what is done about it is said here: steps with `weights: committed` or `persistent` are cut back, for the
 * next commit makes the weights anew. With `weights: reference` none does, and the run is told once; so it is where such surfaces
 * have turned (turned.c). */
#include "contact/contact.h"

/* Over all ranks: the slide over the size of the node's facets, of the last evaluation that was judged. */
static PetscErrorCode measure(Interface *interface, const Mesh *mesh)
{
  const stickslip_equilibrium *e        = &interface->equilibrium;
  const ContactPart           *part     = &interface->part;
  Frozen                      *slide    = &interface->slide;
  PetscReal                    where[4] = {0, 0, 0, e->slide}; /* the node, its slide */

  PetscFunctionBegin;
  slide->amount = part->handle && e->slide > 0 ? e->slide / e->slide_scale : 0;
  if (slide->amount > 0) contact_vector(part->dimension, part->X, (PetscInt)e->slide_node, where);
  PetscCall(contact_largest(mesh, &slide->amount, sizeof(where), where));
  PetscCall(PetscSNPrintf(slide->words, sizeof(slide->words),
                          "%s has slid by %.2g since its weights were made, %.2g times the size of the facets at (%g, %g, %g)",
                          interface->name, (double)where[3], (double)slide->amount, (double)where[0], (double)where[1],
                          (double)where[2]));
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
    if (turned_offsets(interface)) PetscCall(turned_measure(interface, contact->mesh));
    if (turned_offsets(interface) || interface->options.weights == STICKSLIP_WEIGHTS_CURRENT) continue;
    PetscCall(measure(interface, contact->mesh));
    if (interface->options.weights == STICKSLIP_WEIGHTS_REFERENCE) {
      PetscCall(turned_measure(interface, contact->mesh));
      continue;
    }
    *slid = PetscMax(*slid, interface->slide.amount / interface->slide.most);
    if (interface->slide.amount <= interface->slide.most) continue;
    PetscCall(PetscSNPrintf(why, length,
                            "converged, but %s, where weights of the last step are good for %g times: take shorter steps, "
                            "`weights: current`, or a larger `slide_max`",
                            interface->slide.words, (double)interface->slide.most));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode tell(PetscReal t, Frozen *frozen, const char *means, const char *instead, const char *key)
{
  PetscFunctionBegin;
  if (frozen->told || !(frozen->amount > frozen->most)) PetscFunctionReturn(PETSC_SUCCESS);
  frozen->told = PETSC_TRUE;
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "snes_contact: warning: at t = %.6g %s. %s %s a larger `%s` (it is %g) if that is meant.\n", (double)t,
                         frozen->words, means, instead, key, (double)frozen->most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step counts. */
PetscErrorCode slide_accept(Contact *contact)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    if (turned_offsets(interface))
      PetscCall(tell(contact->physics->t, &interface->turn,
                     "Offsets of tied surfaces act along the normals that the surfaces had at first, and do not turn with the bodies.",
                     "Mesh the interference or the gap, or take", "turn_max"));
    if (turned_offsets(interface) || interface->options.weights != STICKSLIP_WEIGHTS_REFERENCE) continue;
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
