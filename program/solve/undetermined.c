/* Do the equations say what every multiplier is? Where nothing tells two of them apart, or one pushes on nothing that can move, the matrix is
 * singular, forces balance all the same, and the tractions there are whatever the linear solver left.
 *
 * The last factors J ~ LU of a step find it: b = J z with multipliers z of our choice, and J y = b gives back y = z, but for what
 * is not determined. */
#include "solve/redundant.h"
#include <math.h>

/* z has entries of about 1. What is determined comes back to rounding times the condition of J, some 1e-16 times 1e10 at most. */
static const PetscReal NOT_GIVEN_BACK = 1e-3;

typedef struct {
  PetscInt  multipliers; /* that do not come back */
  PetscReal worst, X[3]; /* how far from it, and at which node */
} Undetermined;

/* the same on every rank and in every run, and different from node to node */
static PetscReal chosen(int64_t equation)
{
  return 1 + 0.5 * sin((double)equation);
}

static PetscInt n_multipliers(const ContactPart *part)
{
  return verb_there(part) ? part->components * part->n1 : 0;
}

static PetscErrorCode choose(const Contact *contact, Vec z)
{
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(z));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const ContactPart *part = &contact->interfaces[i].part;
    for (PetscInt k = 0; k < n_multipliers(part); k++) {
      const int64_t equation = MULTIPLIERS_OF(part, part->equations)[k];
      if (equation >= 0 && part->owned[k / part->components] == STICKSLIP_NODE_OWN)
        PetscCall(VecSetValue(z, (PetscInt)equation, chosen(equation), INSERT_VALUES));
    }
  }
  PetscCall(VecAssemblyBegin(z));
  PetscCall(VecAssemblyEnd(z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y at the multipliers of an interface: those that did not come back, of all ranks */
static PetscErrorCode compare(const Mesh *mesh, const Interface *interface, Vec y, Undetermined *found)
{
  const ContactPart *part = &interface->part;
  const PetscInt     n    = n_multipliers(part);
  PetscInt          *all;
  PetscScalar       *values;
  IS                 is;
  VecScatter         scatter;
  Vec                here;

  PetscFunctionBegin;
  *found = (Undetermined){0};
  PetscCall(PetscMalloc1(n, &all));
  for (PetscInt k = 0; k < n; k++) {
    const int64_t equation = MULTIPLIERS_OF(part, part->equations)[k];
    all[k]                 = equation >= 0 ? (PetscInt)equation : 0;
  }
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, n, all, PETSC_OWN_POINTER, &is));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, n, &here));
  PetscCall(VecScatterCreate(y, is, here, NULL, &scatter));
  PetscCall(VecScatterBegin(scatter, y, here, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, y, here, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetArray(here, &values));
  for (PetscInt k = 0; k < n; k++) {
    const int64_t   equation = MULTIPLIERS_OF(part, part->equations)[k];
    const PetscReal off      = equation >= 0 ? PetscAbsReal(PetscRealPart(values[k]) - chosen(equation)) : 0;
    if (!(off > NOT_GIVEN_BACK) || part->owned[k / part->components] != STICKSLIP_NODE_OWN) continue;
    found->multipliers++;
    if (off <= found->worst) continue;
    found->worst = off;
    contact_vector(part->dimension, part->X, k / part->components, found->X);
  }
  PetscCall(VecRestoreArray(here, &values));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&here));
  PetscCall(ISDestroy(&is));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &found->multipliers, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(contact_largest(mesh, &found->worst, sizeof(found->X), found->X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the interfaces that one with most multipliers left open, in words. */
static PetscErrorCode describe(const Interface *interface, const Undetermined *found, char why[], size_t size)
{
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(why, size,
                          "%" PetscInt_FMT " multipliers of %s, most at (%g, %g, %g), are not determined by the equations: what they push cannot "
                          "move, or other multipliers push it as well. Where interfaces share nodes, make one of them; where supports hold "
                          "nodes of both surfaces, take those of the `nonmortar` side out of the supports, or swap the sides",
                          found->multipliers, interface->name, (double)found->X[0], (double)found->X[1], (double)found->X[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At a converged state, while the factors of its last matrix are there: direct solver, multipliers among the unknowns. */
PetscErrorCode undetermined_find(Solve *solve, char why[], size_t size)
{
  const Contact       *contact = solve->contact;
  const PetscLogDouble seconds = solve->seconds; /* what is measured is the run */
  PetscInt             most = 0;
  PetscBool            direct;
  KSPConvergedReason   reason;
  KSP                  ksp;
  Mat                  J;
  Vec                  z, b, y;

  PetscFunctionBegin;
  why[0] = 0;
  if (!solve->redundant.suspected || !solve->newton.iterations) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetKSP(solve->snes, &ksp));
  PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPPREONLY, &direct));
  if (!direct) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetOperators(ksp, &J, NULL));
  PetscCall(MatCreateVecs(J, &z, &b));
  PetscCall(VecDuplicate(z, &y));
  PetscCall(choose(contact, z));
  PetscCall(MatMult(J, z, b));
  PetscCall(KSPSolve(ksp, b, y));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  for (PetscInt i = 0; i < contact->n_interfaces && reason >= 0; i++) {
    Undetermined found;
    PetscCall(compare(solve->mesh, &contact->interfaces[i], y, &found));
    if (found.multipliers > most) PetscCall(describe(&contact->interfaces[i], &found, why, size));
    most = PetscMax(most, found.multipliers);
  }
  PetscCall(VecDestroy(&z));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&y));
  solve->seconds = seconds;
  PetscFunctionReturn(PETSC_SUCCESS);
}
