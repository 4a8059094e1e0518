/* What a converged step may be wrong by although its forces balance and its contact is in equilibrium: bodies that really overlap, or
 * are apart where they press, which the means of gaps over facets do not see, and with normals of t_n a pressure that lags behind the
 * surface, unless lag.c has found others. The library measures it (stickslip_equilibrium); what is done about it is said here. A step
 * that is too far off does not count: it is cut back, for shorter ones turn less. */
#include "contact/contact.h"

/* An overlap, over the library's scale, that is told. The scale is a facet's edge where nothing feels the overlap, which may be all that the
 * bodies have approached by; where it is felt, thirty of them. */
static const PetscReal OVERLAP_TOLD = 0.003;
/* With more no run ends in which the interface never pressed. On its way in a tip dents facets until these feel it, and no shorter step keeps it
 * from that. */
static const PetscReal OVERLAP_END = 0.02;
/* With more no step counts where the interface has pressed before: it has lost its contact. So it is where nodes press so far from
 * anything. */
static const PetscReal OVERLAP_MOST = 0.1;
/* A traction over the modulus that is none. */
static const PetscReal ROUNDED = 1e-12;
/* A lag that is told, of a node over the largest traction or of all nodes over their force; with which no step counts is `lag_max`. */
static const PetscReal LAG_TOLD = 0.01;
/* The step that follows aims below what is allowed by so much: turns are even, what slips is not. */
static const PetscReal LAG_MARGIN = 1.3;

static const char *remedy(const Interface *interface)
{
  if (!weights_are_of_now(interface))
    return "Frozen weights do not know where the surfaces are: take `weights: current`, or shorter steps";
  if (decision_is_points(interface) || interface->surface[1]->analytic || interface->skin) return "Facets that are coarser than the contact do not feel it: take finer ones";
  return "Facets that are coarser than the contact do not feel it: make the side with the finer facets `nonmortar`, mesh both finer, or take "
         "`decision: points`";
}

static PetscErrorCode measure(const Contact *contact, Interface *interface)
{
  const Mesh                  *mesh      = contact->mesh;
  const stickslip_equilibrium *e         = &interface->equilibrium;
  Frozen                      *overlap   = &interface->overlap, *apart = &interface->apart, *lag = &interface->lag;
  PetscReal                    where[4]  = {0, 0, 0, e->penetration}, there[4] = {0, 0, 0, e->apart}, at[4] = {0};
  const PetscReal              traction  = e->traction_scale;
  PetscReal                    force[2];
  PetscFunctionBegin;
  PetscCall(slide_find(interface, mesh, e->penetration > 0 ? e->penetration / e->penetration_scale : 0, e->penetration_node, overlap, where));
  PetscCall(slide_find(interface, mesh, e->apart > 0 ? e->apart / e->apart_scale : 0, e->apart_node, apart, there));
  PetscCall(slide_find(interface, mesh, e->lag > 0 ? e->lag / traction : 0, e->lag_node, lag, at));
  /* What yields overlaps by its law, and the worn surface is not the mesh. */
  if (interface->layer.n_overclosure || interface->layer.wear > 0) overlap->amount = 0;
  interface->depth = where[3];
  force[0]         = verb_there(&interface->part) ? e->lag_force : 0;
  force[1]         = verb_there(&interface->part) ? e->lag_force_scale : 0; /* 0 with the host's normals */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, 2, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  interface->lag_force = interface->normals ? contact->lag_left : force[1] > 0 ? force[0] / force[1] : 0;
  PetscCall(PetscSNPrintf(overlap->words, sizeof(overlap->words), "the bodies of %s overlap by %.2g at (%g, %g, %g)", interface->name,
                          (double)where[3], (double)where[0], (double)where[1], (double)where[2]));
  PetscCall(PetscSNPrintf(apart->words, sizeof(apart->words), "the bodies of %s press each other at (%g, %g, %g) although they are %.2g apart",
                          interface->name, (double)there[0], (double)there[1], (double)there[2], (double)there[3]));
  PetscCall(PetscSNPrintf(lag->words, sizeof(lag->words),
                          "%s has turned within the step so far that %.2g %% of its largest pressure acts along the surface, or off the cone "
                          "of friction, at (%g, %g, %g)",
                          interface->name, (double)(100 * lag->amount), (double)at[0], (double)at[1], (double)at[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What an overlap may be; `last`: the run would end with this step. */
static PetscReal overlap_most(const Interface *interface, PetscBool last)
{
  if (interface->largest_traction > 0) return OVERLAP_MOST;
  if (!last) return PETSC_MAX_REAL;
  return interface->equilibrium.traction_scale > ROUNDED * interface->young ? OVERLAP_MOST : OVERLAP_END;
}

/* At a converged state that the interfaces have been judged at. `why`, where it does not count; `ratio`: at least how many times too
 * long the step was; `late`: no shorter one helps. Weights of the reference are for displacements too small to be seen: what they overlap by is told
 * alone. So it is with `dynamics`: no shorter step stops a tip that dents a facet before that presses. */
PetscErrorCode unseen_check(Contact *contact, PetscBool last, PetscBool *late, PetscReal *ratio, char why[], size_t length)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface      *interface = &contact->interfaces[i];
    const PetscBool told      = (PetscBool)(contact->physics->dynamics || interface->method.weights == STICKSLIP_WEIGHTS_REFERENCE);
    PetscReal       lags;
    PetscCall(measure(contact, interface));
    if (interface->apart.amount > OVERLAP_MOST && !told)
      PetscCall(PetscSNPrintf(why, length, "converged, but %s. %s", interface->apart.words, remedy(interface)));
    if (interface->overlap.amount > overlap_most(interface, last) && !told) {
      PetscCall(PetscSNPrintf(why, length, "converged, but %s. %s", interface->overlap.words, remedy(interface)));
      *late = last;
    }
    lags   = PetscMax(interface->lag.amount, interface->lag_force) / interface->lag.most;
    *ratio = PetscMax(*ratio, LAG_MARGIN * lags);
    if (lags > 1)
      PetscCall(PetscSNPrintf(why, length,
                              "converged, but %s: with normals of the step's start %.2g %% of its force is wrong. Take shorter steps, "
                              "`normals: current` where the model has them, or a larger `lag_max` (it is %g) if that is meant",
                              interface->lag.words, (double)(100 * interface->lag_force), (double)interface->lag.most));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode tell(PetscReal t, Frozen *found, PetscReal most, const char *means)
{
  PetscFunctionBegin;
  if (found->told || !(found->amount > most)) PetscFunctionReturn(PETSC_SUCCESS);
  found->told = PETSC_TRUE;
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR, "stickslip: warning: at t = %.6g %s. %s.\n", (double)t, found->words, means));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step counts. */
PetscErrorCode unseen_accept(Contact *contact)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    PetscCall(tell(contact->physics->t, &interface->overlap, OVERLAP_TOLD, remedy(interface)));
    PetscCall(tell(contact->physics->t, &interface->apart, OVERLAP_TOLD, remedy(interface)));
    PetscCall(tell(contact->physics->t, &interface->lag, LAG_TOLD,
                   "Normals are those of the step's start: shorter steps, or `normals: current` where the model has them, make it less"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The run has come to its end. */
PetscErrorCode unseen_end(const Contact *contact)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    if (interface->options.friction == STICKSLIP_FRICTION_TIED) continue;
    if (interface->largest_traction > 0) {
      PetscCall(lonely_tell(interface, contact->mesh));
      PetscCall(slopes_tell(contact, interface));
      continue;
    }
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: warning: %s never closed: nothing pressed in any step%s.\n", interface->name,
                           interface->overlap.amount > 0 ? ", although its bodies overlap" : ""));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
