/* Which rigid motions of the model's parts no constraint feels: the eigenvectors without a value of the sum of the
 * constraints' products. Three translations and three turns about its middle a part, the turns over its size. */
#include "solve/motions.h"
#include <petscblaslapack.h>
#include <string.h>

/* A motion whose constraints sum to less than this part of those of the motion that is held best is free: far above
 * rounding, far below what one vertex of a million holds. */
static const PetscReal FREE = 1e-10;
/* Directions that differ by less than this, in radians, count as one in the words. */
static const PetscReal SLOPE = 1e-2;
/* Components of unit vectors below this are left out of the words. */
static const PetscReal VISIBLE = 1e-3;

/* Of a rigid body's first two vertices the second one has its turns. */
static PetscBool is_turn(const Physics *physics, PetscInt number)
{
  const PetscInt r = rigids_of_vertex(physics, number);
  return (PetscBool)(r >= 0 && number == physics->rigids[r].first_vertex + 1);
}

/* Positions of the vertices that this rank owns, 3 each; of others the part is -1. `at`: in local vectors. */
static PetscErrorCode positions(const Physics *physics, Vec u_local, PetscReal x[], PetscInt part[], PetscInt at[])
{
  const Mesh        *mesh = physics->mesh;
  const PetscScalar *coordinates, *u = NULL;
  Vec                vector;
  PetscFunctionBegin;
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  if (u_local) PetscCall(VecGetArrayRead(u_local, &u));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    part[k] = physics->unknowns.ghost[k] ? -1 : physics->parts.of_vertex[k];
    PetscCall(unknowns_place(physics, k, coordinates, x + 3 * k, &at[k]));
    for (int i = 0; i < 3 && u && !is_turn(physics, mesh->original[k]); i++)
      x[3 * k + i] += PetscRealPart(u[at[k] + i]);
  }
  if (u_local) PetscCall(VecRestoreArrayRead(u_local, &u));
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode sum(PetscInt n, PetscReal values[])
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, (PetscMPIInt)n, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Middle and size of each part. */
static PetscErrorCode measure(PetscInt n_parts, PetscInt n, const PetscReal x[], const PetscInt part[], Motions *m)
{
  PetscReal *count;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(n_parts, &count));
  for (PetscInt k = 0; k < n; k++) {
    if (part[k] < 0) continue;
    count[part[k]]++;
    for (int i = 0; i < 3; i++)
      m->middle[3 * part[k] + i] += x[3 * k + i];
  }
  PetscCall(sum(n_parts, count));
  PetscCall(sum(3 * n_parts, m->middle));
  for (PetscInt k = 0; k < 3 * n_parts; k++)
    m->middle[k] /= count[k / 3];
  for (PetscInt k = 0; k < n; k++) {
    for (int i = 0; i < 3 && part[k] >= 0; i++)
      m->size[part[k]] += PetscSqr(x[3 * k + i] - m->middle[3 * part[k] + i]) / count[part[k]];
  }
  PetscCall(sum(n_parts, m->size));
  for (PetscInt p = 0; p < n_parts; p++)
    m->size[p] = m->size[p] > 0 ? PetscSqrtReal(m->size[p]) : 1;
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode motions_create(const Physics *physics, Vec u_local, const PetscBool *include, Motions *m)
{
  const PetscInt n_parts = physics->parts.n, n_points = physics->mesh->n_points;
  PetscReal     *x;
  PetscInt      *part, *at;
  PetscFunctionBegin;
  *m = (Motions){0};
  PetscCall(PetscCalloc3(n_parts, &m->place, 3 * n_parts, &m->middle, n_parts, &m->size));
  for (PetscInt p = 0; p < n_parts; p++)
    m->place[p] = include[p] ? m->n_parts++ : -1;
  PetscCall(PetscMalloc3(3 * n_points, &x, n_points, &part, n_points, &at));
  PetscCall(positions(physics, u_local, x, part, at));
  PetscCall(measure(n_parts, n_points, x, part, m));
  m->n = MODES * m->n_parts;
  PetscCall(PetscCalloc2(m->n * m->n, &m->gram, m->n, &m->values));
  for (PetscInt k = 0; k < n_points; k++) {
    for (int i = 0; i < 3 && part[k] >= 0; i++) {
      const PetscReal d[3] = {i == 0, i == 1, i == 2};
      PetscInt        columns[MODES];
      PetscReal       values[MODES];
      int             n = 0;
      if (!entry_held(physics, at[k] + i) || rigids_moves(physics, physics->mesh->original[k], i)) continue;
      if (is_turn(physics, physics->mesh->original[k])) {
        static const PetscReal held   = 1;
        const PetscInt         column = MODES * m->place[part[k]] + 3 + i;
        if (m->place[part[k]] >= 0) motions_constrain(m, 1, &column, &held);
        continue;
      }
      motions_row(m, part[k], x + 3 * k, d, 1, columns, values, &n);
      motions_constrain(m, n, columns, values);
    }
  }
  PetscCall(PetscFree3(x, part, at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rings resist their own widening, and a turn out of their plane: what is left moves along the axis. */
void motions_add_rings(const Physics *physics, Motions *m)
{
  static const PetscReal held = 1;
  const PetscInt         kinds[] = {0, 5}; /* along x, about z */
  for (PetscInt k = 0; k < 2 * m->n_parts && physics->mesh->space.kind == SPACE_AXISYMMETRIC; k++) {
    const PetscInt column = MODES * (k / 2) + kinds[k % 2];
    motions_constrain(m, 1, &column, &held);
  }
}

PetscErrorCode motions_sum(Motions *m)
{
  PetscFunctionBegin;
  PetscCall(sum(m->n * m->n, m->gram));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode motions_destroy(Motions *m)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(m->place, m->middle, m->size));
  PetscCall(PetscFree2(m->gram, m->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the motions of a part move a point by along d; nothing where it is none of those that move. Adds `sign` times. */
void motions_row(const Motions *m, PetscInt part, const PetscReal x[3], const PetscReal d[3], PetscReal sign,
                       PetscInt columns[], PetscReal values[], int *n)
{
  if (m->place[part] < 0) return;
  for (int i = 0; i < 3; i++) {
    const int       j = (i + 1) % 3, k = (i + 2) % 3;
    const PetscReal yj = x[j] - m->middle[3 * part + j], yk = x[k] - m->middle[3 * part + k];
    columns[*n]    = MODES * m->place[part] + i;
    values[(*n)++] = sign * d[i];
    columns[*n]    = MODES * m->place[part] + 3 + i;
    values[(*n)++] = sign * (yj * d[k] - yk * d[j]) / m->size[part]; /* (e_i x y) . d */
  }
}

void motions_constrain(Motions *m, int n, const PetscInt columns[], const PetscReal values[])
{
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++)
      m->gram[m->n * columns[i] + columns[j]] += values[i] * values[j];
  }
}

/* Eigenvalues of a symmetric matrix, the least first; it is replaced by its eigenvectors, one a row. */
PetscErrorCode motions_eigen(PetscInt n, PetscReal *gram, PetscReal *values)
{
  PetscBLASInt size, length, info;
  PetscReal   *work;
  PetscFunctionBegin;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(8 * n, &length));
  PetscCall(PetscMalloc1(8 * n, &work));
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &size, gram, &size, values, work, &length, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK's syev failed");
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode motions_find_free(Motions *m, PetscInt *n_free)
{
  PetscFunctionBegin;
  PetscCall(motions_eigen(m->n, m->gram, m->values));
  *n_free = 0;
  while (*n_free < m->n && m->values[*n_free] <= FREE * PetscMax(m->values[m->n - 1], 1))
    (*n_free)++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "x" or "(0.71, 0, -0.71)" */
static void direction_words(PetscReal d[3], char words[], size_t length)
{
  int largest = 0, visible = 0;
  for (int i = 1; i < 3; i++)
    largest = PetscAbsReal(d[i]) > PetscAbsReal(d[largest]) + VISIBLE ? i : largest;
  for (int i = 0; i < 3; i++) {
    d[i] = PetscAbsReal(d[i]) < VISIBLE ? 0 : d[i];
    visible += d[i] != 0;
  }
  for (int i = 0; i < 3 && d[largest] < 0; i++)
    d[i] = -d[i];
  if (visible == 1)
    PetscCallAbort(PETSC_COMM_SELF, PetscSNPrintf(words, length, "%c", 'x' + largest));
  else
    PetscCallAbort(PETSC_COMM_SELF, PetscSNPrintf(words, length, "(%.3g, %.3g, %.3g)", (double)d[0], (double)d[1],
                                                  (double)d[2]));
}

/* Directions that span vectors (n of them, `width` apart), as words: an axis that lies in their span goes by its name. */
static PetscErrorCode span_words(PetscInt n, const PetscReal *vectors, PetscInt width, char words[], size_t length)
{
  PetscReal gram[9] = {0}, values[3], largest;
  PetscInt  rank = 0, axes = 0;
  char      word[64];

  PetscFunctionBegin;
  words[0] = 0;
  for (PetscInt k = 0; k < n; k++) {
    for (int i = 0; i < 9; i++)
      gram[i] += vectors[width * k + i / 3] * vectors[width * k + i % 3];
  }
  PetscCall(motions_eigen(3, gram, values));
  largest = values[2];
  for (int k = 0; k < 3; k++)
    rank += values[k] > SLOPE * SLOPE * PetscMax(largest, SLOPE * SLOPE);
  for (int i = 0; i < 3; i++) {
    PetscReal within = 0;
    for (PetscInt k = 3 - rank; k < 3; k++)
      within += PetscSqr(gram[3 * k + i]);
    axes += within > 1 - VISIBLE;
  }
  for (int i = 0; i < 3; i++) {
    PetscReal within = 0, d[3];
    for (PetscInt k = 3 - rank; k < 3; k++)
      within += PetscSqr(gram[3 * k + i]);
    for (int j = 0; j < 3; j++)
      d[j] = axes == rank ? i == j : gram[3 * i + j];
    if (axes == rank ? within <= 1 - VISIBLE : i < 3 - rank) continue;
    direction_words(d, word, sizeof(word));
    PetscCall(PetscStrlcat(words, words[0] ? ", " : "", length));
    PetscCall(PetscStrlcat(words, word, length));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode motions_words(const Motions *m, PetscInt n_free, PetscInt place, char words[], size_t length)
{
  PetscReal *mine, *gram, *values, *moves;
  PetscInt   n_moves = 0;
  char       along[200], about[200];

  PetscFunctionBegin;
  PetscCall(PetscCalloc4(MODES * n_free, &mine, n_free * n_free, &gram, n_free, &values, 3 * n_free, &moves));
  for (PetscInt k = 0; k < MODES * n_free; k++)
    mine[k] = m->gram[m->n * (k / MODES) + MODES * place + k % MODES];
  for (PetscInt k = 0; k < n_free * n_free; k++) {
    for (int i = 3; i < MODES; i++)
      gram[k] += mine[MODES * (k / n_free) + i] * mine[MODES * (k % n_free) + i];
  }
  PetscCall(motions_eigen(n_free, gram, values)); /* combinations of the motions in which the part does not turn: */
  for (PetscInt c = 0; c < n_free && values[c] <= SLOPE * SLOPE; c++, n_moves++) {
    for (PetscInt k = 0; k < 3 * n_free; k++)
      moves[3 * n_moves + k % 3] += gram[n_free * c + k / 3] * mine[MODES * (k / 3) + k % 3];
  }
  PetscCall(span_words(n_moves, moves, 3, along, sizeof(along)));
  PetscCall(span_words(n_free, mine + 3, MODES, about, sizeof(about)));
  PetscCall(PetscSNPrintf(words, length, "%s%s%s%s%s", along[0] ? "move along " : "", along,
                          along[0] && about[0] ? " and " : "", about[0] ? "turn about " : "", about));
  PetscCall(PetscFree4(mine, gram, values, moves));
  PetscFunctionReturn(PETSC_SUCCESS);
}
