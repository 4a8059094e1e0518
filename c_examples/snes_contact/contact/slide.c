/* With frozen weights contact is sought, and forces act on the mortar side, where the surfaces were when the weights were made. A
 * step that slides farther than that shows still converges, and is wrong by about the slide. How far it is, the library says
 * (stickslip_equilibrium); what is done about it is said here: steps with `weights: committed` or `persistent` are cut back, for the
 * next commit makes the weights anew. With `weights: reference` none does, and the run is told once. */
#include "contact/contact.h"

/* Over all ranks: the slide over the size of the node's facets, of the last evaluation that was judged; where, on the rank that has it. */
static PetscErrorCode measure(Interface *interface, PetscMPIInt rank)
{
  const stickslip_equilibrium *e    = &interface->equilibrium;
  const ContactPart           *part = &interface->part;
  struct {
    double ratio;
    int    rank;
  } largest = {.ratio = part->handle && e->slide > 0 ? e->slide / e->slide_scale : 0, .rank = rank};
  PetscReal where[5] = {0, 0, 0, e->slide, e->slide_scale};

  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE_INT, MPI_MAXLOC, PETSC_COMM_WORLD));
  interface->slide.ratio = largest.ratio;
  if (!(largest.ratio > interface->slide.most)) PetscFunctionReturn(PETSC_SUCCESS);
  if (largest.rank == rank) contact_vector(part->dimension, part->X, (PetscInt)e->slide_node, where);
  PetscCallMPI(MPI_Bcast(where, 5, MPIU_REAL, largest.rank, PETSC_COMM_WORLD));
  PetscCall(PetscSNPrintf(interface->slide.words, sizeof(interface->slide.words),
                          "%s has slid by %.2g since its weights were made, %.2g times the size of the facets at (%g, %g, %g)",
                          interface->name, (double)where[3], (double)largest.ratio, (double)where[0], (double)where[1],
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
    if (interface->options.weights == STICKSLIP_WEIGHTS_CURRENT) continue;
    PetscCall(measure(interface, contact->mesh->rank));
    if (interface->options.weights == STICKSLIP_WEIGHTS_REFERENCE) continue;
    *slid = PetscMax(*slid, interface->slide.ratio / interface->slide.most);
    if (interface->slide.ratio <= interface->slide.most) continue;
    PetscCall(PetscSNPrintf(why, length,
                            "converged, but %s, where weights of the last step are good for %g times: take shorter steps, "
                            "`weights: current`, or a larger `slide_max`",
                            interface->slide.words, (double)interface->slide.most));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step counts. */
PetscErrorCode slide_accept(Contact *contact)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    Slide     *slide     = &interface->slide;
    if (slide->told || !(slide->ratio > slide->most)) continue;
    slide->told = PETSC_TRUE;
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "snes_contact: warning: at t = %.6g %s. Weights of the reference know no sliding: contact is sought, and "
                           "forces act on the mortar side, where the surfaces were at first. Take `weights: current`, or a larger "
                           "`slide_max` (it is %g) if that is meant.\n",
                           (double)contact->physics->t, slide->words, (double)slide->most));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
