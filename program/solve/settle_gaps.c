/* A move of bodies that are laid down (settle.c): gaps and friction by projected Gauss-Seidel over rigid motions. */
#include "solve/settle.h"

/* Sweeps for one move. */
enum { SWEEPS = 1000 };
/* A node that opens or slides by less than this part of a motion's size does not stop it. */
static const PetscReal NOTHING = 1e-6;
/* This part of friction is counted. Where bodies come to rest so, friction has a reserve: what touches sticks, and holds them while they
 * are strained. Where all of it is needed, all slips, and Newton's matrix is nearly singular. */
static const PetscReal COUNTED = 0.5;
/* Normals hold a motion if the squares of what it opens touching nodes by sum up to more than this, a motion's size being 1. */
static const PetscReal HOLDS = 1e-2;

PetscReal settle_dot(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0;
  for (PetscInt k = 0; k < n; k++)
    sum += a[k] * b[k];
  return sum;
}

/* What the free motions move the two points of a gap apart by, along d. */
static void find_row(const Settle *s, const Gap *gap, const PetscReal d[3], PetscReal row[])
{
  for (int side = 0; side < 2; side++) {
    PetscInt  columns[MODES];
    PetscReal values[MODES];
    int       n = 0;
    motions_row(&s->m, gap->part[side], gap->at, d, side ? -1 : 1, columns, values, &n);
    for (PetscInt k = 0; k < s->n; k++) {
      for (int j = 0; j < n; j++)
        row[k] += values[j] * s->m.gram[s->m.n * k + columns[j]];
    }
  }
}

PetscErrorCode settle_forget_gaps(Settle *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(s->gaps));
  PetscCall(PetscFree4(s->open, s->slide, s->opens, s->slides));
  PetscCall(PetscFree2(s->force, s->rub));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two directions across a normal. */
static void tangents(const PetscReal normal[3], PetscReal t[2][3])
{
  int       least = 0;
  PetscReal size  = 0;
  for (int i = 1; i < 3; i++)
    least = PetscAbsReal(normal[i]) < PetscAbsReal(normal[least]) ? i : least;
  for (int i = 0; i < 3; i++) {
    t[0][i] = (i == least) - normal[least] * normal[i];
    size += t[0][i] * t[0][i];
  }
  for (int i = 0; i < 3; i++)
    t[0][i] /= PetscSqrtReal(size);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    t[1][i] = normal[j] * t[0][k] - normal[k] * t[0][j];
  }
}

static PetscReal squared(const Settle *s, const PetscReal row[])
{
  return settle_dot(s->n, row, row);
}

/* Forces of the last move are those that the next one starts from, where the gaps are the same. */
static PetscErrorCode find_rows(Settle *s, PetscInt n_before)
{
  PetscReal *force = s->force, *rub = s->rub;
  PetscFunctionBegin;
  PetscCall(PetscFree4(s->open, s->slide, s->opens, s->slides));
  PetscCall(PetscCalloc4(s->n_gaps * s->n, &s->open, 2 * s->n_gaps * s->n, &s->slide, s->n_gaps, &s->opens, s->n_gaps, &s->slides));
  if (n_before != s->n_gaps) {
    PetscCall(PetscFree2(force, rub));
    PetscCall(PetscCalloc2(s->n_gaps, &s->force, 2 * s->n_gaps, &s->rub));
  }
  for (PetscInt g = 0; g < s->n_gaps; g++) {
    PetscReal t[2][3];
    find_row(s, &s->gaps[g], s->gaps[g].normal, s->open + g * s->n);
    tangents(s->gaps[g].normal, t);
    for (int k = 0; k < 2; k++)
      find_row(s, &s->gaps[g], t[k], s->slide + (2 * g + k) * s->n);
    s->opens[g] = squared(s, s->open + g * s->n);
    for (int k = 0; k < 2; k++)
      s->slides[g] = PetscMax(s->slides[g], squared(s, s->slide + (2 * g + k) * s->n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode settle_find_gaps(Solve *solve, Settle *s)
{
  const PetscMPIInt size     = solve->mesh->size;
  const PetscInt    n_before = s->gaps ? s->n_gaps : -1;
  PetscInt          n    = 0, all = 0;
  PetscMPIInt      *counts, *starts, bytes;
  Gap              *mine;
  PetscFunctionBegin;
  PetscCall(PetscFree(s->gaps));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++)
    all += solve->contact->interfaces[i].part.n1;
  PetscCall(PetscMalloc1(all, &mine));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++)
    PetscCall(held_gaps(solve, &solve->contact->interfaces[i], mine, &n));
  PetscCall(PetscMalloc2(size, &counts, size + 1, &starts));
  bytes = (PetscMPIInt)(n * (PetscInt)sizeof(Gap));
  PetscCallMPI(MPI_Allgather(&bytes, 1, MPI_INT, counts, 1, MPI_INT, PETSC_COMM_WORLD));
  starts[0] = 0;
  for (PetscMPIInt r = 0; r < size; r++)
    starts[r + 1] = starts[r] + counts[r];
  s->n_gaps = starts[size] / (PetscInt)sizeof(Gap);
  PetscCall(PetscMalloc1(s->n_gaps, &s->gaps));
  PetscCallMPI(MPI_Allgatherv(mine, bytes, MPI_BYTE, s->gaps, counts, starts, MPI_BYTE, PETSC_COMM_WORLD));
  PetscCall(find_rows(s, n_before));
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The move by `by` times a row. */
static void add(const Settle *s, PetscReal by, const PetscReal row[])
{
  for (PetscInt k = 0; k < s->n; k++)
    s->move[k] += by * row[k];
}

/* Gap g presses as hard as it must; returns by how much that changes the move. */
static PetscReal press(Settle *s, PetscInt g)
{
  const PetscReal *open = s->open + g * s->n, stiff = s->opens[g], before = s->force[g];
  if (!(stiff > NOTHING * NOTHING)) return 0;
  s->force[g] = PetscMax(0, before - (s->gaps[g].gap + s->depth + settle_dot(s->n, open, s->move)) / stiff);
  add(s, s->force[g] - before, open);
  return PetscAbsReal(s->force[g] - before) * PetscSqrtReal(stiff);
}

/* It holds what slides, as far as friction goes. */
static PetscReal rub(Settle *s, PetscInt g)
{
  const PetscReal *slide = s->slide + 2 * g * s->n, most = (s->rubs ? COUNTED : 0) * s->gaps[g].friction * s->force[g];
  const PetscReal  stiff = s->slides[g];
  PetscReal        wanted[2], size, change = 0;
  if (!(stiff > NOTHING * NOTHING) || (most == 0 && s->rub[2 * g] == 0 && s->rub[2 * g + 1] == 0)) return 0;
  for (int k = 0; k < 2; k++)
    wanted[k] = s->rub[2 * g + k] - settle_dot(s->n, slide + k * s->n, s->move) / stiff;
  size = PetscSqrtReal(settle_dot(2, wanted, wanted));
  for (int k = 0; k < 2; k++) {
    const PetscReal before = s->rub[2 * g + k];
    s->rub[2 * g + k]      = size > most ? wanted[k] * most / size : wanted[k];
    add(s, s->rub[2 * g + k] - before, slide + k * s->n);
    change = PetscMax(change, PetscAbsReal(s->rub[2 * g + k] - before) * PetscSqrtReal(stiff));
  }
  return change;
}

/* From the gaps of now. */
void settle_find_move(Settle *s, PetscReal accuracy)
{
  const PetscReal load = PetscSqrtReal(settle_dot(s->n, s->load, s->load)), more = s->pushed > 0 ? load / s->pushed : 1;
  PetscReal       change = PETSC_MAX_REAL;
  s->pushed = load;
  for (PetscInt k = 0; k < s->n; k++)
    s->move[k] = s->load[k];
  for (PetscInt g = 0; g < s->n_gaps; g++) {
    s->force[g] *= more;
    add(s, s->force[g], s->open + g * s->n);
    for (PetscInt k = 2 * g; k < 2 * g + 2; k++) {
      s->rub[k] *= more;
      add(s, s->rub[k], s->slide + k * s->n);
    }
  }
  for (int sweep = 0; sweep < SWEEPS && change > accuracy; sweep++) {
    change = 0;
    for (PetscInt g = 0; g < s->n_gaps; g++) {
      const PetscReal pressed = press(s, g), rubbed = rub(s, g); /* PetscMax would do it twice */
      change                  = PetscMax(change, PetscMax(pressed, rubbed));
    }
  }
}

PetscErrorCode settle_wants_friction(const Settle *s, PetscBool *wants)
{
  PetscReal *gram, *values;
  PetscBool  friction = PETSC_FALSE;
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(s->n * s->n, &gram, s->n, &values));
  for (PetscInt g = 0; g < s->n_gaps; g++) {
    const PetscReal *open = s->open + g * s->n;
    if (!(s->force[g] > 0)) continue;
    friction = (PetscBool)(friction || s->gaps[g].friction > 0);
    for (PetscInt k = 0; k < s->n * s->n; k++)
      gram[k] += open[k / s->n] * open[k % s->n];
  }
  PetscCall(motions_eigen(s->n, gram, values));
  *wants = (PetscBool)(friction && values[0] < HOLDS);
  PetscCall(PetscFree2(gram, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
