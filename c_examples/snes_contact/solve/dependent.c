/* Which multipliers to leave out, in value: where products of their forces have an eigenvalue next to zero, its vector is a change of
 * multipliers that pushes on nothing. One of those that it changes most is left out. What is left then does all that there was: a
 * pressure that is even becomes p (1 - z_A / z_B) at A without B, and is negative nowhere. */
#include "solve/redundant.h"
#include <petscblaslapack.h>

/* Of a condition less than 1e-4 of which is its own, one is left out: meshes that meet to the digits of their files leave
 * 1e-7 to 1e-5, different meshes more than 1e-2. What it would ask of the bodies is less than a facet's error; what it
 * would take to enforce it is a force of 1e4 times all others. */
static const PetscReal OWN_PART = 1e-8; /* squared, as eigenvalues are */
/* What is held cannot follow the other side, and its conditions are surplus: a tenth of one that acts on the other side's free nodes keeps
 * these where they are, and layers clamped at one wall were up to 28 % too stiff. Without them bending is that of the merged mesh
 * within 1 %. Of those that are more their own, as between like meshes, all stay. */
static const PetscReal OWN_PART_HELD = 1e-2; /* squared */
/* So much of a change lies on what is held. */
static const PetscReal MOSTLY = 0.9;
/* Of those that are changed by this part of the largest change what is farther open goes: of two floors under a block it is the lower one. */
static const PetscReal ABOUT = 0.5;
/* What is less than this of the largest change is none. */
static const PetscReal NO_CHANGE = 1e-6;
enum { MOST = 3 }; /* multipliers of a node */

typedef struct {
  PetscInt   n, m;    /* rows; how many changes there are */
  PetscReal *changes; /* n x m, by rows */
} Changes;

static PetscReal product(const Changes *of, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0;
  for (PetscInt j = 0; j < of->m; j++)
    sum += a[j] * b[j];
  return sum;
}

static void take_from(const Changes *of, const PetscReal unit[], PetscReal row[])
{
  const PetscReal along = product(of, unit, row);
  for (PetscInt j = 0; j < of->m; j++)
    row[j] -= along * unit[j];
}

/* A row of length 1; returns its length. */
static PetscReal normalise(const Changes *of, PetscReal row[])
{
  const PetscReal length = PetscSqrtReal(product(of, row, row));
  for (PetscInt j = 0; j < of->m && length > 0; j++)
    row[j] /= length;
  return length;
}

/* Rows `first` to `end` made orthonormal, in `units`; returns the shortest they were: whether they may all go. */
static PetscReal orthonormal(const Changes *of, PetscInt first, PetscInt end, PetscReal units[])
{
  PetscReal shortest = PETSC_MAX_REAL;
  for (PetscInt k = first; k < end; k++) {
    PetscReal *unit = units + of->m * (k - first);
    for (PetscInt j = 0; j < of->m; j++)
      unit[j] = of->changes[of->m * k + j];
    for (PetscInt l = first; l < k; l++)
      take_from(of, units + of->m * (l - first), unit);
    shortest = PetscMin(shortest, normalise(of, unit));
  }
  return shortest;
}

/* Contact turns with its normal, so that the components of a node go together; of tied nodes each goes alone. */
static PetscInt end_of_block(PetscInt n, const Multiplier multipliers[], PetscInt first)
{
  const Multiplier *one = &multipliers[first];
  PetscInt          end = first + 1;
  while (!one->tied && end < n && multipliers[end].interface == one->interface && multipliers[end].number == one->number)
    end++;
  return end;
}

/* How much of a change lies on what is held */
static PetscReal part_held(PetscInt n, const Multiplier multipliers[], const PetscReal vector[])
{
  PetscReal sum = 0;
  for (PetscInt i = 0; i < n; i++)
    sum += multipliers[i].held ? PetscSqr(vector[i]) : 0;
  return sum;
}

/* S becomes eigenvectors, one in n numbers; those come first, `m` of them, that are changes by nothing that counts */
static PetscErrorCode find_changes(PetscInt n, const Multiplier multipliers[], PetscReal S[], PetscInt *m)
{
  PetscReal   *values, best, *work = &best;
  PetscBLASInt size, info, length = -1;
  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscMalloc1(n, &values));
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &size, S, &size, values, work, &length, &info));
  length = (PetscBLASInt)best;
  PetscCall(PetscMalloc1(length, &work));
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &size, S, &size, values, work, &length, &info));
  *m = 0;
  for (PetscInt j = 0; !info && j < n && values[j] < OWN_PART_HELD; j++) {
    if (values[j] >= OWN_PART && part_held(n, multipliers, S + n * j) < MOSTLY) continue;
    PetscCall(PetscArraymove(S + n * (*m)++, S + n * j, n));
  }
  PetscCall(PetscFree(work));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The block that goes next, and by how much it is changed; of like ones that which is farthest open, or the last one. */
static PetscReal next_block(const Changes *of, const Multiplier multipliers[], PetscInt left, const PetscBool dependent[], PetscReal units[],
                            PetscInt *first, PetscInt *end)
{
  PetscReal most = 0, least = 0, gap = PETSC_MIN_REAL;
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt k = 0, next; k < of->n; k = next) {
      PetscReal change;
      next = end_of_block(of->n, multipliers, k);
      if (dependent[k] || next - k > left) continue;
      change = orthonormal(of, k, next, units);
      if (!pass) {
        most = PetscMax(most, change);
      } else if (change >= least && multipliers[k].gap >= gap) {
        gap    = multipliers[k].gap;
        *first = k;
        *end   = next;
      }
    }
    least = ABOUT * most;
  }
  return most;
}

/* One after the other, the block that the changes left over change most */
static PetscErrorCode choose(const Changes *of, const Multiplier multipliers[], PetscBool dependent[])
{
  PetscReal *units, largest = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(MOST * of->m, &units));
  for (PetscInt left = of->m; left > 0;) {
    PetscInt        first = -1, end = -1;
    const PetscReal most = next_block(of, multipliers, left, dependent, units, &first, &end);
    largest              = PetscMax(largest, most);
    if (first < 0 || most <= NO_CHANGE * largest) break;
    (void)orthonormal(of, first, end, units);
    for (PetscInt k = first; k < end; k++) {
      dependent[k] = PETSC_TRUE;
      for (PetscInt i = 0; i < of->n; i++)
        take_from(of, units + of->m * (k - first), of->changes + of->m * i);
    }
    left -= end - first;
  }
  PetscCall(PetscFree(units));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode dependent_find(PetscInt n, const Multiplier multipliers[], PetscReal S[], PetscBool dependent[])
{
  Changes of = {.n = n};
  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; i++) {
    dependent[i] = PETSC_FALSE;
    for (PetscInt j = 0; j < n; j++)
      S[n * i + j] /= multipliers[i].coverage * multipliers[j].coverage;
  }
  PetscCall(find_changes(n, multipliers, S, &of.m));
  if (!of.m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n * of.m, &of.changes));
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt j = 0; j < of.m; j++)
      of.changes[of.m * i + j] = S[n * j + i] / multipliers[i].coverage;
  }
  PetscCall(choose(&of, multipliers, dependent));
  PetscCallMPI(MPI_Bcast(dependent, (PetscMPIInt)n, MPIU_BOOL, 0, PETSC_COMM_WORLD)); /* sums may be rounded otherwise elsewhere */
  PetscCall(PetscFree(of.changes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
