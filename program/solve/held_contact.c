/* What closed contact nodes hold of the rigid motions of parts (motions.c): along the normal and, with friction, across the direction in
 * which they slip; in all directions where they stick or are tied. Positions are those of now. */
#include "solve/held.h"

/* Normals that enclose less than this count as one: a slope of less than a hundredth, as a flat surface has when it is
 * strained, holds nothing. */
static const PetscReal SLOPE = 1e-2;
/* Friction below this part of the pressure is none, but for rounding. */
static const PetscReal NO_FRICTION = 1e-9;

/* Where a node of a part is now. */
static void position_of(const ContactPart *part, PetscInt node, PetscReal x[3])
{
  contact_vector(part->dimension, part->x, node, x);
  for (int i = 0; i < part->dimension; i++)
    x[i] += part->origin[i];
}

/* The model's part of the mortar vertex nearest to node a: a surface may belong to several. Of a skin that of what lies opposite. */
static PetscInt mortar_part(const ContactPart *part, PetscInt a, const PetscReal at[3])
{
  const PetscInt *pieces = part->piece + part->n1, opposite = verb_opposite(part, a);
  PetscInt        piece  = part->n2 ? pieces[0] : part->piece[opposite < 0 ? a : opposite];
  PetscBool       one    = PETSC_TRUE;
  PetscReal       best   = PETSC_MAX_REAL, x[3];
  for (PetscInt k = 1; k < part->n2 && one; k++)
    one = (PetscBool)(pieces[k] == piece);
  for (PetscInt k = 0; k < part->n2 && !one; k++) {
    PetscReal squared = 0;
    position_of(part, part->n1 + k, x);
    for (int i = 0; i < 3; i++)
      squared += PetscSqr(x[i] - at[i]);
    if (squared < best) best = squared, piece = pieces[k];
  }
  return piece;
}

/* Normals that can be told from each other, of all ranks. */
typedef struct {
  PetscInt n;
  double  *normals; /* 3 each */
} Distinct;

/* The first of them that a normal cannot be told from, or -1. */
static PetscInt same_normal(const Distinct *distinct, const double normal[3])
{
  for (PetscInt k = 0; k < distinct->n; k++) {
    PetscReal squared = 0;
    for (int i = 0; i < 3; i++)
      squared += PetscSqr(normal[i] - distinct->normals[3 * k + i]);
    if (squared < SLOPE * SLOPE) return k;
  }
  return -1;
}

static void add_distinct(Distinct *distinct, const double normal[3])
{
  if (same_normal(distinct, normal) >= 0) return;
  for (int i = 0; i < 3; i++)
    distinct->normals[3 * distinct->n + i] = normal[i];
  distinct->n++;
}

/* closed, and owned here, with a multiplier */
static PetscBool holds(const ContactPart *part, PetscInt a, const double *results)
{
  return (PetscBool)(part->owned[a] == STICKSLIP_NODE_OWN && results[N_RESULTS * a + RESULT_STATE] != STICKSLIP_STATE_GAP &&
                     part->removed[a] != 7);
}

/* Of the nodes that slip, on all ranks. */
static PetscErrorCode find_normals(const Mesh *mesh, const ContactPart *part, const double results[], Distinct *all)
{
  Distinct     mine = {0};
  PetscMPIInt *counts, *starts, n, total = 0;
  double      *found;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * part->n1, &mine.normals));
  for (PetscInt a = 0; a < part->n1; a++) {
    if (holds(part, a, results) && results[N_RESULTS * a + RESULT_STATE] != STICKSLIP_STATE_STICK)
      add_distinct(&mine, results + N_RESULTS * a + RESULT_NORMAL);
  }
  n = (PetscMPIInt)(3 * mine.n);
  PetscCall(PetscMalloc2(mesh->size, &counts, mesh->size, &starts));
  PetscCallMPI(MPI_Allgather(&n, 1, MPI_INT, counts, 1, MPI_INT, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0; r < mesh->size; r++) {
    starts[r] = total;
    total += counts[r];
  }
  PetscCall(PetscMalloc1(total, &found));
  PetscCallMPI(MPI_Allgatherv(mine.normals, n, MPI_DOUBLE, found, counts, starts, MPI_DOUBLE, PETSC_COMM_WORLD));
  *all = (Distinct){0};
  PetscCall(PetscMalloc1(total, &all->normals));
  for (PetscInt k = 0; k < total; k += 3)
    add_distinct(all, found + k);
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscFree(found));
  PetscCall(PetscFree(mine.normals));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The direction across which a node slips: friction turns with the direction of slip, so that a motion across it is
 * resisted, as one along it is not. Zero without friction. */
static void across(const PetscReal nu[3], const PetscReal lambda[3], PetscReal d[3])
{
  const PetscReal normal = nu[0] * lambda[0] + nu[1] * lambda[1] + nu[2] * lambda[2];
  PetscReal       t[3], size = 0;
  for (int i = 0; i < 3; i++) {
    t[i] = lambda[i] - normal * nu[i];
    size += t[i] * t[i];
  }
  size = PetscSqrtReal(size);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    d[i] = size > NO_FRICTION * PetscAbsReal(normal) ? (nu[j] * t[k] - nu[k] * t[j]) / size : 0;
  }
}

/* Of the nodes here that are closed at the place of the last evaluation. */
PetscErrorCode motions_add_contact(const Mesh *mesh, const Interface *interface, Motions *m)
{
  const ContactPart *part = &interface->part;
  double            *results;
  Distinct           distinct;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(N_RESULTS * part->n1, &results));
  PetscCall(contact_results(part, results));
  PetscCall(find_normals(mesh, part, results, &distinct));
  for (PetscInt a = 0; a < part->n1; a++) {
    const double   *result = results + N_RESULTS * a, *normal = result + RESULT_NORMAL;
    const PetscInt  piece  = part->piece[a];
    PetscInt        other, columns[2 * MODES];
    PetscReal       values[2 * MODES], turns[3], at[3];
    const PetscBool sticks = (PetscBool)(result[RESULT_STATE] == STICKSLIP_STATE_STICK);
    if (!holds(part, a, results)) continue;
    position_of(part, a, at);
    other = mortar_part(part, a, at);
    across(normal, result + RESULT_MULTIPLIER, turns);
    if (!sticks) normal = distinct.normals + 3 * same_normal(&distinct, normal);
    for (int i = 0; i < (sticks ? 3 : 2); i++) {
      const PetscReal axis[3] = {i == 0, i == 1, i == 2}, *d = sticks ? axis : i == 1 ? turns : normal;
      int             n       = 0;
      if (!sticks && i == 1 && turns[0] == 0 && turns[1] == 0 && turns[2] == 0) continue;
      if (sticks && part->removed[a] & (1 << i)) continue;
      motions_row(m, piece, at, d, 1, columns, values, &n);
      if (other != piece) motions_row(m, other, at, d, -1, columns, values, &n);
      motions_constrain(m, n, columns, values);
    }
  }
  PetscCall(PetscFree(results));
  PetscCall(PetscFree(distinct.normals));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A node that is covered less has no gap worth looking at. */
static const PetscReal COVERED = 1e-3;

/* The mortar vertex nearest to a place of now. */
static PetscInt nearest(const ContactPart *part, const PetscReal at[3])
{
  PetscReal best = PETSC_MAX_REAL, x[3];
  PetscInt  node = part->n1;
  for (PetscInt k = part->n1; k < part->n1 + part->n2; k++) {
    PetscReal squared = 0;
    position_of(part, k, x);
    for (int i = 0; i < 3; i++)
      squared += PetscSqr(x[i] - at[i]);
    if (squared < best) best = squared, node = k;
  }
  return node;
}

PetscErrorCode held_gaps(const Solve *solve, const Interface *interface, Gap gaps[], PetscInt *n)
{
  const ContactPart *part = &interface->part;
  const int32_t      kind = interface->options.friction;
  double            *results;
  PetscFunctionBegin;
  if (kind == STICKSLIP_FRICTION_TIED) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(N_RESULTS * part->n1, &results));
  PetscCall(contact_results(part, results));
  for (PetscInt a = 0; a < part->n1; a++) {
    const double *result = results + N_RESULTS * a;
    Gap          *gap    = &gaps[*n];
    PetscReal     at[3];
    PetscInt      other;
    if (part->owned[a] != STICKSLIP_NODE_OWN || part->removed[a] == 7 || result[RESULT_COVERAGE] < COVERED) continue;
    position_of(part, a, at);
    other = interface->skin ? verb_opposite(part, a) : nearest(part, at);
    if (other < 0 || other == part->n1 + part->n2) continue;
    gap->part[0] = part->piece[a];
    gap->part[1] = part->piece[other];
    for (int i = 0; i < 3; i++) {
      gap->at[i]     = at[i];
      gap->normal[i] = result[RESULT_NORMAL + i];
    }
    gap->gap      = result[RESULT_GAP] / result[RESULT_COVERAGE];
    gap->friction = kind == STICKSLIP_FRICTION_COULOMB ? contact_friction(solve->mesh, interface, a) : 0;
    (*n)++;
  }
  PetscCall(PetscFree(results));
  PetscFunctionReturn(PETSC_SUCCESS);
}
