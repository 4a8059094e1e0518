/* Which conditions follow from others, in value: Cholesky's method on the products of their forces, multiplier by multiplier. What is left of
 * a diagonal entry is the square of the distance from all that came before. */
#include "solve/redundant.h"

/* A condition of which less than 1e-4 is its own is no condition of its own: meshes that meet to the digits of their files leave
 * 1e-7 to 1e-5 of it, different meshes more than 1e-2. What it would ask of the bodies is less than a facet's error; what it
 * would take to enforce it is a force of 1e4 times all others. */
static const PetscReal OWN_PART = 1e-8; /* squared */
/* What is held cannot follow the other side, and its conditions are surplus: a tenth of one that acts on the other side's free nodes keeps
 * these where they are, and layers clamped at one wall were up to 28 % too stiff. Without them bending is that of the merged mesh
 * within 1 %. Those that are more their own, as between like meshes, stay. */
static const PetscReal OWN_PART_HELD = 1e-2; /* squared */

/* A multiplier's force at its own node is what is covered there, before supports take it. */
static PetscBool is_own(PetscReal left, const Multiplier *multiplier)
{
  return (PetscBool)(left > (multiplier->held ? OWN_PART_HELD : OWN_PART) * PetscSqr(multiplier->coverage));
}

/* Row q out of all rows behind it */
static void eliminate(PetscInt n, PetscInt q, PetscReal S[])
{
  for (PetscInt i = q + 1; i < n; i++) {
    const PetscReal factor = S[n * i + q] / S[n * q + q];
    for (PetscInt j = q + 1; factor != 0 && j < n; j++)
      S[n * i + j] -= factor * S[n * q + j];
  }
}

/* Contact turns with its normal, so that a node's components go together: do all of those from `first` to `end` follow from others? */
static PetscBool whole_node(PetscInt n, PetscInt first, PetscInt end, const Multiplier multipliers[], const PetscReal S[])
{
  for (PetscInt q = first; q < end; q++) {
    if (is_own(S[n * q + q], &multipliers[q])) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

void dependent_find(PetscInt n, const Multiplier multipliers[], PetscReal S[], PetscBool dependent[])
{
  for (PetscInt first = 0, end; first < n; first = end) {
    const Multiplier *one = &multipliers[first];
    PetscBool         whole;
    for (end = first + 1; end < n && multipliers[end].interface == one->interface && multipliers[end].number == one->number; end++)
      ;
    whole = whole_node(n, first, end, multipliers, S);
    for (PetscInt q = first; q < end; q++) {
      const PetscBool own = is_own(S[n * q + q], &multipliers[q]);
      dependent[q]        = (PetscBool)(!own && (one->tied || whole));
      if (own) eliminate(n, q, S);
    }
  }
}
