/* What no contact can be, although its equations hold: the two sides do not get the same force, or tractions are beyond what the bodies can
 * carry. */
#include "contact/contact.h"
#include "physics/dynamics.h"

/* What the forces on both sides differ by, over the sum of their sizes: each is a sum over pairs, with the rounding of that. */
static const PetscReal BETWEEN = 1e-6;
/* A sum below this is of numbers that have no digits left: denormal ones, of contact that has opened. */
static const PetscReal DENORMAL = 1e-290;
/* A traction over the modulus of the softer body where it cannot widen: a strain that no body is in, and that an edge of a fine mesh does not
 * reach. Multipliers that nothing feels have no bound at all. */
static const PetscReal STRAIN = 10;

static PetscErrorCode check_between(const Interface *interface, char why[], size_t length)
{
  PetscReal sums[4], left = 0;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(interface->between, sums, 4, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  for (int i = 0; i < 3; i++)
    left = PetscMax(left, PetscAbsReal(sums[i]));
  if (left <= BETWEEN * sums[3] || sums[3] < DENORMAL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(why, length,
                          "%s gives its two sides different forces: %.2g is left of a sum of %.2g. That is a fault of the program: please report it "
                          "with the scene",
                          interface->name, (double)left, (double)sums[3]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What tractions may be beyond those of the body at rest: a node that is stopped in a step far shorter than a wave takes through the body gets its
 * momentum over the step. */
static PetscReal shortness(const Physics *physics, PetscReal modulus)
{
  PetscReal size = 0, density = 0;
  if (!physics->dynamics) return 1;
  for (PetscInt p = 0; p < physics->parts.n; p++)
    size = PetscMax(size, physics->parts.part[p].size);
  for (PetscInt b = 0; b < physics->mesh->n_bodies; b++)
    density = PetscMax(density, physics->materials[b].density);
  return PetscMax(1, size * PetscSqrtReal(density / modulus) / physics->dynamics->dt);
}

/* The equilibrium of the interface has been judged: its scale is the largest traction, of a sliver by its force. */
static PetscErrorCode check_tractions(const Physics *physics, const Interface *interface, char why[], size_t length)
{
  const PetscReal traction = interface->equilibrium.traction_scale;
  PetscFunctionBegin;
  if (interface->confined == PETSC_MAX_REAL || traction <= STRAIN * interface->confined * shortness(physics, interface->confined))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(why, length,
                          "a traction of %.2g between the surfaces of %s, which the softer side, with a modulus of %.2g, cannot carry. Either the "
                          "loads are far beyond it: see the units of loads and moduli. Or some of its conditions push on nothing, or say what others "
                          "say: see whether supports hold nodes of both sides, or another interface has the same nodes; take the other side as "
                          "`nonmortar`, or another `basis`",
                          (double)traction, interface->name, (double)interface->confined));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_sound(Contact *contact, char why[], size_t length)
{
  PetscFunctionBegin;
  why[0] = 0;
  for (PetscInt i = 0; i < contact->n_interfaces && !why[0]; i++) {
    PetscCall(check_tractions(contact->physics, &contact->interfaces[i], why, length));
    if (!why[0]) PetscCall(check_between(&contact->interfaces[i], why, length));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
