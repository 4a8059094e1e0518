/* Which conditions follow from others, in value: Cholesky's method on the products of their rows, condition by condition. What is left of a
 * diagonal entry is the square of the distance from all rows before it. */
#include "solve/redundant.h"

/* A condition of which less than 1e-4 is its own is no condition of its own: meshes that meet to the digits of their files leave
 * 1e-7 to 1e-5 of it, different meshes more than 1e-2. What it would ask of the bodies is less than a facet's error; what it
 * would take to enforce it is a force of 1e4 times all others. */
static const PetscReal OWN_PART = 1e-8; /* squared */

/* A multiplier's force at its own node is what is covered there, before supports take it. */
static PetscBool is_own(PetscReal left, const Multiplier *multiplier)
{
  return (PetscBool)(left > OWN_PART * PetscSqr(multiplier->coverage));
}

/* Row q out of all rows behind it, up to `end` */
static void eliminate(PetscInt n, PetscInt q, PetscInt end, PetscReal S[])
{
  for (PetscInt i = q + 1; i < end; i++) {
    const PetscReal factor = S[n * i + q] / S[n * q + q];
    for (PetscInt j = q + 1; factor != 0 && j < end; j++)
      S[n * i + j] -= factor * S[n * q + j];
    S[n * i + q] = 0;
  }
}

static PetscBool same_node(const Multiplier *a, const Multiplier *b)
{
  return (PetscBool)(a->interface == b->interface && a->number == b->number);
}

/* Contact turns with its normal, so that a node's components go together: how many of those from `first` to `end` follow from others? */
static PetscInt count_dependent(PetscInt n, PetscInt first, PetscInt end, const Multiplier multipliers[], const PetscReal S[])
{
  enum { MOST = 3 };
  const PetscInt m = end - first;
  PetscReal      block[MOST * MOST];
  PetscInt       count = 0;
  for (PetscInt i = 0; i < m; i++) {
    for (PetscInt j = 0; j < m; j++)
      block[m * i + j] = S[n * (first + i) + first + j];
  }
  for (PetscInt q = 0; q < m; q++) {
    if (is_own(block[m * q + q], &multipliers[first + q]))
      eliminate(m, q, m, block);
    else
      count++;
  }
  return count;
}

void dependent_find(PetscInt n, const Multiplier multipliers[], PetscReal S[], PetscBool dependent[])
{
  for (PetscInt first = 0, end; first < n; first = end) {
    PetscInt  count;
    PetscBool whole;
    for (end = first + 1; end < n && same_node(&multipliers[first], &multipliers[end]); end++)
      ;
    count = multipliers[first].tied ? 0 : count_dependent(n, first, end, multipliers, S);
    whole = (PetscBool)(count == end - first);
    for (PetscInt q = first; q < end; q++) {
      const PetscBool covered = (PetscBool)(multipliers[q].coverage > 0), own = is_own(S[n * q + q], &multipliers[q]);
      dependent[q] = (PetscBool)(covered && !own && (multipliers[q].tied || whole));
      if (covered && own && !whole) eliminate(n, q, n, S);
    }
  }
}
