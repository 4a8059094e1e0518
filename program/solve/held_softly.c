/* Springs that are so soft beside the bodies, or the loads, that what they alone hold is not held. Along such a motion the matrix has the
 * stiffness of the springs, kappa, and nothing else. Forces balance to a residual and to the rounding of the bodies' own forces only, R
 * (parts.c), so that the motion is known to R / kappa, though every force is right. Beside what the forces F on a body deform it by, F /
 * (E size), that is (R / F) (E size / kappa): rounding times the condition of the matrix. And a motion that is farther than the whole model
 * is large is told, too: no scene means that. */
#include "solve/held.h"
#include <cjson/cJSON.h>

/* A drift of this part of what a body deforms is told: displacements of fewer digits than any mesh gives. */
static const PetscReal DRIFT = 1e-2;
/* How many roundings meet in the sum of all nodal forces on a body. */
static const PetscReal ROUNDINGS = 8;
/* Over the largest stiffness: what is smaller is the rounding of a motion that no spring holds. */
static const PetscReal UNHELD = 1e3 * PETSC_MACHINE_EPSILON;
/* A part takes part in a motion that has more than this of it, which is of size 1 over all parts. */
static const PetscReal TAKES_PART = 1e-3;

/* What is told of motions: how far they are known and moved at most, over deformations and the size of the model; how many are among the
 * first rows of the motions. */
typedef struct {
  PetscReal drift, over, moved;
  PetscInt  n;
} Soft;

/* What springs alone hold: of motion k the stiffness, values[k], and the motion itself, a row of `rows`. */
typedef struct {
  PetscInt   n;
  PetscReal *values, *rows;
} SpringMotions;

/* From motions that supports and contact leave, and the springs' stiffness against all motions: smaller ones are the rounding of the
 * largest. */
static PetscErrorCode find_motions(Motions *m, const Motions *springs, SpringMotions *found)
{
  const PetscInt n = m->n;
  PetscReal     *stiffness;
  PetscFunctionBegin;
  PetscCall(motions_find_free(m, &found->n));
  PetscCall(PetscCalloc2(found->n, &found->values, found->n * n, &found->rows));
  PetscCall(PetscCalloc1(found->n * found->n, &stiffness));
  for (PetscInt a = 0; a < found->n; a++) {
    for (PetscInt b = 0; b < found->n; b++) {
      for (PetscInt k = 0; k < n * n; k++)
        stiffness[found->n * a + b] += m->gram[n * a + k / n] * springs->gram[k] * m->gram[n * b + k % n];
    }
  }
  PetscCall(motions_eigen(found->n, stiffness, found->values));
  for (PetscInt a = 0; a < found->n; a++)
    found->values[a] = PetscMax(found->values[a], PETSC_MACHINE_EPSILON * found->values[found->n - 1]);
  for (PetscInt a = 0; a < found->n; a++) {
    for (PetscInt k = 0; k < found->n * n; k++)
      found->rows[n * a + k % n] += stiffness[found->n * a + k / n] * m->gram[k];
  }
  PetscCall(PetscFree(stiffness));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How much of a motion is that of one part */
static PetscReal share(const Motions *m, const PetscReal row[], PetscInt part)
{
  PetscReal squared = 0;
  for (int i = 0; i < MODES; i++)
    squared += PetscSqr(row[MODES * m->place[part] + i]);
  return PetscSqrtReal(squared);
}

/* What the forces on a part deform it by, about; of what does not deform its size counts. */
static PetscReal deformation(const Part *part, PetscReal size)
{
  const PetscReal force = part->reference / 2; /* which counts each force twice */
  return part->young > 0 && force > 0 ? force / (part->young * size) : size;
}

/* What is not balanced of the forces on a part: the residual, and what rounding makes of the bodies' forces and of all others. */
static PetscReal unbalanced(const Part *part)
{
  return PetscMax(part->residual, part->noise) + ROUNDINGS * PETSC_MACHINE_EPSILON * part->reference;
}

/* Of one motion: how far it is known, and the most that this is of the deformation of a part that takes part. */
static void measure_drift(const Physics *physics, const Motions *m, const PetscReal row[], PetscReal stiffness, PetscReal *drift, PetscReal *over)
{
  PetscReal squared = 0;
  *over             = 0;
  for (PetscInt p = 0; p < physics->parts.n; p++)
    squared += PetscSqr(share(m, row, p) * unbalanced(&physics->parts.part[p]));
  *drift = PetscSqrtReal(squared) / stiffness;
  for (PetscInt p = 0; p < physics->parts.n; p++)
    *over = PetscMax(*over, *drift * share(m, row, p) / deformation(&physics->parts.part[p], m->size[p]));
}

/* How far a motion's parts have moved along it: their middles, from `first`, undeformed */
static PetscReal measure_way(const Physics *physics, const Motions *m, const Motions *first, const PetscReal row[])
{
  PetscReal most = 0;
  for (PetscInt p = 0; p < physics->parts.n; p++) {
    const PetscReal *d     = row + MODES * m->place[p];
    const PetscReal  along = PetscSqrtReal(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    PetscReal        way   = 0;
    for (int i = 0; i < 3; i++)
      way += d[i] * (m->middle[3 * p + i] - first->middle[3 * p + i]);
    if (along > TAKES_PART) most = PetscMax(most, PetscAbsReal(way) / along);
  }
  return most;
}

/* Those that are told become the first rows of m->gram. */
static PetscErrorCode find_soft(const Solve *solve, Motions *m, const Motions *springs, const Motions *first, Soft *soft)
{
  SpringMotions all;
  PetscFunctionBegin;
  *soft = (Soft){0};
  PetscCall(find_motions(m, springs, &all));
  for (PetscInt k = 0; k < all.n; k++) {
    const PetscReal *row   = all.rows + m->n * k;
    const PetscReal  moved = measure_way(solve->physics, m, first, row);
    PetscReal        drift, over;
    measure_drift(solve->physics, m, row, all.values[k], &drift, &over);
    if (!(over > DRIFT) && !(moved > solve->size)) continue;
    if (over > soft->over) soft->over = over, soft->drift = drift;
    soft->moved = PetscMax(soft->moved, moved);
    PetscCall(PetscArraymove(all.rows + m->n * soft->n++, row, m->n));
  }
  PetscCall(PetscArraycpy(m->gram, all.rows, soft->n * m->n));
  PetscCall(PetscFree2(all.values, all.rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: into solve->held.by_springs */
static PetscErrorCode keep(Solve *solve, const Motions *m, const Soft *soft)
{
  HeldFinding *finding = &solve->held.by_springs;
  char         text[2048], known[256] = "", far[256] = "", words[3072];
  PetscFunctionBegin;
  finding->json = cJSON_CreateObject();
  cJSON_AddNumberToObject(finding->json, "t", solve->physics->t);
  cJSON_AddNumberToObject(finding->json, "drift", soft->drift);
  cJSON_AddNumberToObject(finding->json, "over_deformation", soft->over);
  cJSON_AddNumberToObject(finding->json, "moved", soft->moved);
  cJSON_AddNumberToObject(finding->json, "over_model", soft->moved / solve->size);
  PetscCall(held_words(solve, m, soft->n, ": ", cJSON_AddObjectToObject(finding->json, "bodies"), text, sizeof(text)));
  if (soft->over > DRIFT)
    PetscCall(PetscSNPrintf(known, sizeof(known),
                            " How far they move so is known to %.2g only, the rounding of the forces over the springs' stiffness, %.2g times what "
                            "the forces deform them by.",
                            (double)soft->drift, (double)soft->over));
  if (soft->moved > solve->size)
    PetscCall(PetscSNPrintf(far, sizeof(far), " They have moved by %.2g so, %.2g times the size of the whole model.", (double)soft->moved,
                            (double)(soft->moved / solve->size)));
  PetscCall(PetscSNPrintf(words, sizeof(words),
                          "springs alone hold what follows, and they are too soft for it: %s.%s%s Take stiffer springs, or supports.", text,
                          known, far));
  PetscCall(PetscStrallocpy(words, &finding->words));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All motions of all parts at a state: what supports hold of them, before motions_sum(), and the stiffness of springs against them. */
static PetscErrorCode create(const Solve *solve, Vec u_local, PetscBool **every, Motions *m, Motions *springs)
{
  Physics *physics = solve->physics;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(physics->parts.n, every));
  for (PetscInt p = 0; p < physics->parts.n; p++)
    (*every)[p] = PETSC_TRUE;
  PetscCall(motions_create(physics, u_local, *every, m));
  PetscCall(motions_create(physics, u_local, *every, springs));
  PetscCall(PetscArrayzero(springs->gram, springs->n * springs->n)); /* without supports */
  PetscCall(motions_add_springs(physics, u_local, PETSC_TRUE, springs));
  PetscCall(motions_sum(springs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode destroy(PetscBool **every, Motions *m, Motions *springs)
{
  PetscFunctionBegin;
  PetscCall(motions_destroy(m));
  PetscCall(motions_destroy(springs));
  PetscCall(PetscFree(*every));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At a converged state, the place of the last evaluation, before its commit. The first time is told, once the step is accepted. */
PetscErrorCode held_check_springs(Solve *solve)
{
  Physics     *physics = solve->physics;
  HeldFinding *finding = &solve->held.by_springs;
  PetscBool   *every, found = PETSC_FALSE;
  Motions      m, springs, first;
  Soft         soft;
  PetscFunctionBegin;
  if (!physics->springs || physics->dynamics || finding->told || solve->held.by_nothing.told) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(create(solve, physics->u_local, &every, &m, &springs));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++)
    PetscCall(motions_add_contact(solve->mesh, &solve->contact->interfaces[i], &m));
  PetscCall(motions_sum(&m));
  motions_add_rings(physics, &m);
  PetscCall(motions_create(physics, NULL, every, &first));
  if (!solve->mesh->rank) {
    PetscCall(find_soft(solve, &m, &springs, &first, &soft));
    found = (PetscBool)(soft.n > 0);
    if (found) PetscCall(keep(solve, &m, &soft));
  }
  PetscCallMPI(MPI_Bcast(&found, 1, MPIU_BOOL, 0, PETSC_COMM_WORLD));
  finding->told = finding->unsettled = found;
  PetscCall(motions_destroy(&first));
  PetscCall(destroy(&every, &m, &springs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What supports leave to springs that are so soft that a force along it cannot balance to `rtol`: the rounding of what it moves, times the
 * condition of the matrix, is more. A sentence, or nothing. */
PetscErrorCode held_describe_springs(const Solve *solve, PetscReal rtol, char text[], size_t length)
{
  Physics      *physics = solve->physics;
  PetscReal     worst   = 0;
  PetscInt      n_soft  = 0;
  PetscBool    *every;
  char          words[1024];
  Motions       m, springs;
  SpringMotions all;
  PetscFunctionBegin;
  text[0] = 0;
  if (!physics->springs || physics->dynamics) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(create(solve, NULL, &every, &m, &springs));
  PetscCall(motions_sum(&m));
  motions_add_rings(physics, &m);
  PetscCall(find_motions(&m, &springs, &all));
  for (PetscInt k = 0; k < all.n; k++) {
    const PetscReal *row      = all.rows + m.n * k;
    PetscReal        rounding = 0;
    if (!(all.values[k] > UNHELD * all.values[all.n - 1])) continue;
    for (PetscInt p = 0; p < physics->parts.n; p++)
      rounding = PetscMax(rounding, share(&m, row, p) * PETSC_MACHINE_EPSILON * physics->parts.part[p].young * m.size[p] / all.values[k]);
    if (!(rounding > rtol)) continue;
    worst = PetscMax(worst, rounding);
    PetscCall(PetscArraymove(all.rows + m.n * n_soft++, row, m.n));
  }
  PetscCall(PetscArraycpy(m.gram, all.rows, n_soft * m.n));
  PetscCall(held_words(solve, &m, n_soft, ": ", NULL, words, sizeof(words)));
  if (n_soft)
    PetscCall(PetscSNPrintf(text, length,
                            " Springs hold what follows, and they are so soft that rounding is %.2g of a force along it, where rtol is %.2g: %s.",
                            (double)worst, (double)rtol, words));
  PetscCall(PetscFree2(all.values, all.rows));
  PetscCall(destroy(&every, &m, &springs));
  PetscFunctionReturn(PETSC_SUCCESS);
}
