/* Is the contact in equilibrium? What the library finds, which knows no augmentation and no row scale, interface by
 * interface. */
#include "contact/contact.h"
#include <stdio.h>

/* Part of a scale that a violation may be, over the tolerance of the forces: the rows of the default augmentation, which is
 * a tenth of E / h, would be compared with the forces so. */
static const PetscReal OVER_FORCES = 10;
/* A tighter tolerance of the forces asks no more of the contact: tractions are known to this part then, and the next step
 * of Newton's method would end at rounding. */
static const PetscReal LEAST = 1e-10;
/* A violation that changes by less than this from one iteration to the next, while the forces balance, stays: Newton's
 * method has nothing left to change. */
static const PetscReal STANDS_STILL = 1e-3;
/* Iterations in a row that it must have stood still. */
enum { PATIENCE = 3 };

static PetscBool within(PetscReal tolerance, const stickslip_equilibrium *e)
{
  return (PetscBool)(e->gap <= tolerance * e->gap_scale && e->traction <= tolerance * e->traction_scale &&
                     e->slip <= tolerance * e->slip_scale);
}

/* the worst of the three over what it may be, as a number and in words */
static PetscReal worst(PetscReal tolerance, const Interface *interface, char words[], size_t length)
{
  const stickslip_equilibrium *e        = &interface->equilibrium;
  const ContactPart           *part     = &interface->part;
  const double                 values[] = {e->gap, e->traction, e->slip};
  const double                 scales[] = {e->gap_scale, e->traction_scale, e->slip_scale};
  const int64_t                nodes[]  = {e->gap_node, e->traction_node, e->slip_node};
  static const char *const     names[]  = {"gap", "traction", "slip"};
  PetscReal                    largest  = 0, X[3];
  for (int k = 0; k < 3; k++) {
    const PetscReal ratio = values[k] > 0 ? values[k] / (tolerance * scales[k]) : 0;
    if (!(ratio > largest)) continue;
    largest = ratio;
    contact_vector(part->dimension, part->X, (PetscInt)nodes[k], X);
    snprintf(words, length, "%s: a %s of %.2g that the law forbids, of a scale of %.2g, at node %d at (%g, %g, %g)",
             interface->name, names[k], values[k], scales[k], (int)part->vertices[nodes[k]],
             (double)X[0], (double)X[1], (double)X[2]);
  }
  return largest;
}

/* What the library finds of this part, with tractions compared with the largest of all parts; `refused`: by any. */
static PetscErrorCode measure(Interface *interface, PetscBool *refused)
{
  ContactPart           *part = &interface->part;
  stickslip_equilibrium *e    = &interface->equilibrium;
  PetscReal              found[2] = {0, interface->largest_traction}; /* a refusal, the largest traction */

  PetscFunctionBegin;
  for (int pass = 0; pass < (interface->n_parts > 1 ? 2 : 1); pass++) {
    *e = (stickslip_equilibrium){.struct_size = sizeof(*e), .modulus = interface->young, .least_traction = found[1]};
    if (verb_there(part) && !found[0]) {
      found[0] = verb_equilibrium(part, e) != 0;
      found[1] = e->traction_scale;
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, found, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  }
  e->traction_scale = found[1];
  *refused          = (PetscBool)(found[0] != 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At the place of the last evaluation. `stuck`: it is not, and iterations no longer change that. */
PetscErrorCode equilibrium_judge(Contact *contact, PetscReal rtol, PetscBool *holds, PetscBool *stuck)
{
  const PetscReal tolerance = PetscMax(OVER_FORCES * rtol, LEAST);
  Settling       *settling  = &contact->settling;
  PetscReal       largest   = 0;

  PetscFunctionBegin;
  *holds = PETSC_TRUE;
  *stuck = PETSC_FALSE;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    char       words[256];
    PetscReal  ratio;
    PetscBool  refused = PETSC_FALSE;
    PetscCall(measure(interface, &refused));
    if (refused) *holds = PETSC_FALSE;
    if (refused || !verb_there(&interface->part) || within(tolerance, &interface->equilibrium)) continue;
    *holds = PETSC_FALSE;
    ratio  = worst(tolerance, interface, words, sizeof(words));
    if (ratio <= largest) continue;
    largest = ratio;
    snprintf(settling->unsettled, sizeof(settling->unsettled), "%s", words);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, holds, 1, MPIU_BOOL, MPI_LAND, PETSC_COMM_WORLD));
  if (*holds) {
    settling->unsettled[0] = 0;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(contact_largest(contact->mesh, &largest, sizeof(settling->unsettled), settling->unsettled));
  settling->n_still   = PetscAbsReal(largest - settling->violation) <= STANDS_STILL * largest ? settling->n_still + 1 : 0;
  settling->violation = largest;
  *stuck              = (PetscBool)(settling->n_still >= PATIENCE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An attempt begins, or the forces do not balance. */
void equilibrium_restart(Contact *contact)
{
  contact->settling.unsettled[0] = 0;
  contact->settling.n_still      = 0;
  contact->settling.violation    = 0;
}

/* A step is accepted: its tractions count later on. */
void equilibrium_accept(Contact *contact)
{
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface        = &contact->interfaces[i];
    interface->largest_traction = PetscMax(interface->largest_traction, interface->equilibrium.traction_scale);
  }
}
