/* Do supports move apart what is tied? Where they hold both sides, the conditions of the tie are left out (redundant.c), and nothing would
 * notice: the joint would be torn there, and the force of that has no limit as facets become smaller. */
#include "solve/redundant.h"

/* Of displacements: those of two supports that say the same are the same but for rounding. */
static const PetscReal ROUNDED = 1e-9;

/* What supports hold of the mortar side */
typedef struct {
  PetscReal X[3], u[3];
  PetscInt  held; /* mask */
} HeldNode;

static PetscErrorCode gather_held(const Interface *interface, PetscInt *n, HeldNode **all)
{
  HeldNode  *here;
  PetscMPIInt size, mine, *bytes, *offsets;
  PetscInt    count = 0;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(PetscMalloc1(interface->n2 + 1, &here));
  PetscCall(PetscMalloc2(size, &bytes, size + 1, &offsets));
  for (PetscInt k = interface->n1; k < interface->n1 + interface->n2; k++) {
    if (!interface->prescribed[k]) continue;
    contact_vector(interface->dimension, interface->X, k, here[count].X);
    contact_vector(interface->dimension, interface->displacements, k, here[count].u);
    here[count++].held = interface->prescribed[k];
  }
  mine = (PetscMPIInt)(count * (PetscInt)sizeof(*here));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, bytes, 1, MPI_INT, PETSC_COMM_WORLD));
  offsets[0] = 0;
  for (PetscMPIInt r = 0; r < size; r++)
    offsets[r + 1] = offsets[r] + bytes[r];
  *n = offsets[size] / (PetscInt)sizeof(*here);
  PetscCall(PetscMalloc1(*n + 1, all));
  PetscCallMPI(MPI_Allgatherv(here, mine, MPI_BYTE, *all, bytes, offsets, MPI_BYTE, PETSC_COMM_WORLD));
  PetscCall(PetscFree2(bytes, offsets));
  PetscCall(PetscFree(here));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal distance(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]));
}

/* Where displacements vary along a support, those of the two sides differ by no more than those of the mortar side do around there. */
static PetscBool is_torn(const Interface *interface, PetscInt node, int component, PetscInt n, const HeldNode held[])
{
  PetscReal X[3], u[3], nearest = PETSC_MAX_REAL, largest, varies = 0;
  PetscInt  at = -1;
  contact_vector(interface->dimension, interface->X, node, X);
  contact_vector(interface->dimension, interface->displacements, node, u);
  for (PetscInt k = 0; k < n; k++) {
    if (!((held[k].held >> component) & 1) || distance(X, held[k].X) >= nearest) continue;
    nearest = distance(X, held[k].X);
    at      = k;
  }
  if (at < 0 || nearest > interface->longest_edge) return PETSC_FALSE;
  largest = PetscMax(PetscAbsReal(u[component]), PetscAbsReal(held[at].u[component]));
  for (PetscInt k = 0; k < n; k++) {
    if (((held[k].held >> component) & 1) && distance(X, held[k].X) <= 2 * interface->longest_edge)
      varies = PetscMax(varies, PetscAbsReal(held[k].u[component] - held[at].u[component]));
  }
  return (PetscBool)(PetscAbsReal(u[component] - held[at].u[component]) > varies + ROUNDED * largest);
}

/* At u_local, converged; in words, empty: nothing is torn. */
PetscErrorCode torn_find(Solve *solve, char why[], size_t size)
{
  const Redundant *redundant = &solve->redundant;
  PetscInt         first     = redundant->n;
  PetscFunctionBegin;
  for (PetscInt k = 0, next; k < redundant->n; k = next) {
    Interface *interface = &solve->contact->interfaces[redundant->multipliers[k].interface];
    HeldNode *held;
    PetscInt   n = 0;
    PetscCall(contact_fetch(interface->sf, solve->physics->u_local, interface->displacements));
    PetscCall(gather_held(interface, &n, &held));
    for (next = k; next < redundant->n && redundant->multipliers[next].interface == redundant->multipliers[k].interface; next++) {
      const Multiplier *m = &redundant->multipliers[next];
      const PetscInt    a = m->number - interface->first[0];
      if (m->tied && m->held && a >= 0 && a < interface->n1 && is_torn(interface, a, (int)m->component, n, held)) first = PetscMin(first, next);
    }
    PetscCall(PetscFree(held));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPIU_INT, MPI_MIN, PETSC_COMM_WORLD));
  if (first < redundant->n) {
    const Multiplier *m = &redundant->multipliers[first];
    PetscCall(PetscSNPrintf(why, size,
                            "supports move the two sides of '%s' apart along %c at (%g, %g, %g), where they hold both: what is tied cannot follow. "
                            "Let them move both sides alike, or take the nodes of one side out of them",
                            solve->contact->interfaces[m->interface].name, "xyz"[m->component], (double)m->X[0], (double)m->X[1], (double)m->X[2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
