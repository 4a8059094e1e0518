/* Which parts of the model nothing holds. The rigid motions of all parts (three translations, three turns each) meet two
 * kinds of constraints: prescribed components of vertices, and closed contact nodes, along the normal, or in all
 * directions where they stick or are tied. Motions that none of them feels are free: the matrix is singular, and where
 * the parts end along them is arbitrary.
 *
 * Parts that their supports hold by themselves do not move here. The others are asked together, for two may drift as one.
 * Positions are those of now. */
#include "model.h"
#include <cjson/cJSON.h>
#include <petscblaslapack.h>
#include <string.h>

enum { MODES = 6 };
/* A motion whose constraints sum to less than this part of those of the motion that is held best is free: far above
 * rounding, far below what one vertex of a million holds. */
static const PetscReal FREE = 1e-10;
/* Normals that enclose less than this count as one: a slope of less than a hundredth, as a flat surface has when it is
 * strained, holds nothing. */
static const PetscReal SLOPE = 1e-2;
/* Components of unit vectors below this are left out of the words. */
static const PetscReal VISIBLE = 1e-3;

/* rank 0: motions of some parts, [part][translations, turns about its middle by size], and their constraints */
typedef struct {
  PetscInt   n_parts, *place; /* parts that may move; place of each part of the model among them, -1: none */
  PetscReal *middle, *size;   /* 3 per part of the model; of each */
  PetscInt   n;               /* MODES n_parts */
  PetscReal *gram;            /* n x n: sum of the constraints' products; then its eigenvectors, one a row */
  PetscReal *values;          /* its eigenvalues, in increasing order */
} Motions;

/* x: positions of all vertices; `include` of each part */
static PetscErrorCode motions_create(const Model *model, const PetscReal *x, const PetscBool *include, Motions *m)
{
  PetscInt *count;
  PetscFunctionBegin;
  *m = (Motions){0};
  PetscCall(PetscCalloc3(model->n_parts, &m->place, 3 * model->n_parts, &m->middle, model->n_parts, &m->size));
  PetscCall(PetscCalloc1(model->n_parts, &count));
  for (PetscInt p = 0; p < model->n_parts; p++)
    m->place[p] = !include || include[p] ? m->n_parts++ : -1;
  for (PetscInt v = 0; v < model->mesh.n_vertices; v++) {
    const PetscInt p = model->mesh_part[v];
    count[p]++;
    for (int i = 0; i < 3; i++)
      m->middle[3 * p + i] += x[3 * v + i];
  }
  for (PetscInt k = 0; k < 3 * model->n_parts; k++)
    m->middle[k] /= (PetscReal)count[k / 3];
  for (PetscInt v = 0; v < model->mesh.n_vertices; v++) {
    const PetscInt p = model->mesh_part[v];
    for (int i = 0; i < 3; i++)
      m->size[p] += PetscSqr(x[3 * v + i] - m->middle[3 * p + i]) / (PetscReal)count[p];
  }
  for (PetscInt p = 0; p < model->n_parts; p++)
    m->size[p] = m->size[p] > 0 ? PetscSqrtReal(m->size[p]) : 1;
  m->n = MODES * m->n_parts;
  PetscCall(PetscCalloc2(m->n * m->n, &m->gram, m->n, &m->values));
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode motions_destroy(Motions *m)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(m->place, m->middle, m->size));
  PetscCall(PetscFree2(m->gram, m->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the motions of a part move a point by along d; nothing where it is none of those that move. Adds `sign` times. */
static void add_motion(const Motions *m, PetscInt part, const PetscReal x[3], const PetscReal d[3], PetscReal sign,
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

static void add_constraint(Motions *m, int n, const PetscInt columns[], const PetscReal values[])
{
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++)
      m->gram[m->n * columns[i] + columns[j]] += values[i] * values[j];
  }
}

static void add_supports(const Model *model, const PetscReal *x, Motions *m)
{
  for (PetscInt v = 0; v < model->mesh.n_vertices; v++) {
    for (int i = 0; i < 3; i++) {
      const PetscReal d[3] = {i == 0, i == 1, i == 2};
      PetscInt        columns[MODES];
      PetscReal       values[MODES];
      int             n = 0;
      if (!(model->prescribed[v] & (1 << i))) continue;
      add_motion(m, model->mesh_part[v], x + 3 * v, d, 1, columns, values, &n);
      add_constraint(m, n, columns, values);
    }
  }
}

/* The part of the mortar vertex nearest to a node: a surface may belong to several. */
static PetscInt mortar_part(const Model *model, const Interface *interface, const PetscReal *x, const PetscReal at[3])
{
  const PetscInt *nodes = interface->nodes + interface->n1;
  PetscInt        part  = model->mesh_part[nodes[0]];
  PetscBool       one   = PETSC_TRUE;
  PetscReal       best  = PETSC_MAX_REAL;
  for (PetscInt k = 1; k < interface->n2 && one; k++)
    one = (PetscBool)(model->mesh_part[nodes[k]] == part);
  for (PetscInt k = 0; k < interface->n2 && !one; k++) {
    PetscReal squared = 0;
    for (int i = 0; i < 3; i++)
      squared += PetscSqr(x[3 * nodes[k] + i] - at[i]);
    if (squared < best) best = squared, part = model->mesh_part[nodes[k]];
  }
  return part;
}

/* The first of the normals before that a normal cannot be told from, or itself. */
static const double *same_normal(const double *normals, PetscInt *first, PetscInt *n_first, PetscInt a)
{
  for (PetscInt k = 0; k < *n_first; k++) {
    PetscReal squared = 0;
    for (int i = 0; i < 3; i++)
      squared += PetscSqr(normals[3 * a + i] - normals[3 * first[k] + i]);
    if (squared < SLOPE * SLOPE) return normals + 3 * first[k];
  }
  first[(*n_first)++] = a;
  return normals + 3 * a;
}

/* of the nodes that are closed at the place of the last evaluation */
static PetscErrorCode add_contact(const Model *model, const Interface *interface, const PetscReal *x, Motions *m)
{
  ContactStates states;
  PetscInt     *first, n_first = 0;
  PetscFunctionBegin;
  PetscCall(contact_states_create(interface, &states));
  PetscCall(PetscMalloc1(interface->n1, &first));
  for (PetscInt a = 0; a < interface->n1; a++) {
    const PetscInt   v  = interface->nodes[a];
    const PetscReal *at = x + 3 * v;
    PetscInt         other, columns[2 * MODES];
    PetscReal        values[2 * MODES];
    const PetscBool  sticks = (PetscBool)(states.state[a] == STICKSLIP_STATE_STICK);
    if (states.state[a] == STICKSLIP_STATE_GAP || interface->removed[a] == 7) continue;
    other = mortar_part(model, interface, x, at);
    for (int i = 0; i < (sticks ? 3 : 1); i++) {
      const PetscReal axis[3] = {i == 0, i == 1, i == 2},
                     *d       = sticks ? axis : same_normal(states.normal, first, &n_first, a);
      int n = 0;
      if (sticks && interface->removed[a] & (1 << i)) continue;
      add_motion(m, model->mesh_part[v], at, d, 1, columns, values, &n);
      if (other != model->mesh_part[v]) add_motion(m, other, at, d, -1, columns, values, &n);
      add_constraint(m, n, columns, values);
    }
  }
  PetscCall(PetscFree(first));
  PetscCall(contact_states_destroy(&states));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rows of v (n x width) to eigenvectors of v^T v, least value first: the gram matrix is replaced */
static PetscErrorCode eigen(PetscInt n, PetscReal *gram, PetscReal *values)
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

/* The number of free motions, which are the first rows of m->gram. */
static PetscErrorCode find_free(Motions *m, PetscInt *n_free)
{
  PetscFunctionBegin;
  PetscCall(eigen(m->n, m->gram, m->values));
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
    PetscCallAbort(PETSC_COMM_SELF, PetscSNPrintf(words, length, "(%.3g, %.3g, %.3g)", (double)d[0], (double)d[1], (double)d[2]));
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
  PetscCall(eigen(3, gram, values));
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

/* "move along x, z and turn about y", or nothing: what a part does in the free motions */
static PetscErrorCode motion_words(const Motions *m, PetscInt n_free, PetscInt place, char words[], size_t length)
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
  PetscCall(eigen(n_free, gram, values)); /* combinations of the motions in which the part does not turn: */
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

/* "block", or "block (piece 2)" where a body is in pieces */
static void part_name(const Model *model, PetscInt part, char name[], size_t length)
{
  PetscInt piece = 0, pieces = 0, v = 0, last = -1;
  while (model->mesh_part[v] != part)
    v++;
  for (PetscInt b = 0; b < model->mesh.n_bodies; b++) {
    const Body *body = &model->mesh.bodies[b];
    if (v < body->first_vertex || v >= body->end_vertex) continue;
    for (PetscInt w = body->first_vertex; w < body->end_vertex; w++) { /* parts are numbered as their first vertices are */
      if (model->mesh_part[w] <= last) continue;
      last = model->mesh_part[w];
      pieces++;
      if (last == part) piece = pieces;
    }
    PetscCallAbort(PETSC_COMM_SELF, pieces > 1 ? PetscSNPrintf(name, length, "%s (piece %d of %d)", body->name, (int)piece, (int)pieces)
                                               : PetscSNPrintf(name, length, "%s", body->name));
  }
}

/* Every part's free motions: "upper is free to move along x, lower is free to turn about z" */
static PetscErrorCode describe(const Model *model, const Motions *m, PetscInt n_free, cJSON *json, char text[], size_t length)
{
  PetscFunctionBegin;
  text[0] = 0;
  for (PetscInt p = 0; p < model->n_parts && n_free; p++) {
    char name[2 * NAME_LENGTH], words[512], sentence[1024];
    if (m->place[p] < 0) continue;
    PetscCall(motion_words(m, n_free, m->place[p], words, sizeof(words)));
    if (!words[0]) continue;
    part_name(model, p, name, sizeof(name));
    PetscCall(PetscSNPrintf(sentence, sizeof(sentence), "%s%s is free to %s", text[0] ? ", " : "", name, words));
    PetscCall(PetscStrlcat(text, sentence, length));
    if (json) cJSON_AddStringToObject(json, name, words);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: by the supports alone; `loose`: which parts they do not hold */
static PetscErrorCode by_supports(const Model *model, PetscBool *loose, cJSON *json, char text[], size_t length)
{
  PetscFunctionBegin;
  text[0] = 0;
  for (PetscInt p = 0; p < model->n_parts; p++) { /* they hold each part by itself */
    Motions    m;
    PetscBool *only;
    PetscInt   n_free;
    char       part[1024];
    PetscCall(PetscCalloc1(model->n_parts, &only));
    only[p] = PETSC_TRUE;
    PetscCall(motions_create(model, model->mesh.coordinates, only, &m));
    add_supports(model, model->mesh.coordinates, &m);
    PetscCall(find_free(&m, &n_free));
    PetscCall(describe(model, &m, n_free, json, part, sizeof(part)));
    loose[p] = (PetscBool)(n_free > 0);
    PetscCall(PetscStrlcat(text, text[0] && part[0] ? ", " : "", length));
    PetscCall(PetscStrlcat(text, part, length));
    PetscCall(motions_destroy(&m));
    PetscCall(PetscFree(only));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode held_free(const Model *model, const Body *body, PetscBool *is_free)
{
  PetscFunctionBegin;
  *is_free = PETSC_FALSE;
  for (PetscInt v = body->first_vertex; v < body->end_vertex; v++)
    *is_free = (PetscBool)(*is_free || (!body->analytic && model->loose[model->mesh_part[v]]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A sentence for the user, on every rank: which bodies contact alone must hold. */
PetscErrorCode held_describe(const Model *model, char text[], size_t length)
{
  PetscFunctionBegin;
  text[0] = 0;
  if (model->rank == 0) {
    PetscBool *loose;
    char       free[1024];
    PetscCall(PetscCalloc1(model->n_parts, &loose));
    PetscCall(by_supports(model, loose, NULL, free, sizeof(free)));
    PetscCall(PetscSNPrintf(text, length, "%s%s%s", free[0] ? "By the supports " : "", free,
                            free[0] ? ": only contact can hold that, where bodies touch and as far as friction goes."
                                    : "Every body is held by supports; contact need not hold it."));
    PetscCall(PetscFree(loose));
  }
  PetscCallMPI(MPI_Bcast(text, (PetscMPIInt)length, MPI_CHAR, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0, at the start: notes what contact alone must hold. */
PetscErrorCode held_create(Model *model)
{
  char text[1024];
  PetscFunctionBegin;
  if (model->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(model->n_parts, &model->loose));
  model->held_by_contact = cJSON_CreateObject();
  PetscCall(by_supports(model, model->loose, model->held_by_contact, text, sizeof(text)));
  if (text[0] && !model->quiet)
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "note: by the supports %s; contact must hold that\n", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode held_destroy(Model *model)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(model->loose));
  cJSON_Delete(model->held_by_contact);
  cJSON_Delete(model->held_by_nothing);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0, at a converged state, before its commit: the first time that something is held by nothing at all is told. */
PetscErrorCode held_check(Model *model, const PetscScalar *displacements)
{
  PetscReal *x;
  PetscBool  any = PETSC_FALSE;
  PetscInt   n_free;
  Motions    m;
  char       text[2048];

  PetscFunctionBegin;
  for (PetscInt p = 0; p < model->n_parts; p++)
    any = (PetscBool)(any || model->loose[p]);
  if (!any || model->held_by_nothing) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(3 * model->mesh.n_vertices, &x));
  for (PetscInt k = 0; k < 3 * model->mesh.n_vertices; k++)
    x[k] = model->mesh.coordinates[k] + PetscRealPart(displacements[k]);
  PetscCall(motions_create(model, x, model->loose, &m));
  add_supports(model, x, &m);
  for (PetscInt i = 0; i < model->n_interfaces; i++)
    PetscCall(add_contact(model, &model->interfaces[i], x, &m));
  PetscCall(find_free(&m, &n_free));
  if (n_free) {
    model->held_by_nothing = cJSON_CreateObject();
    cJSON_AddNumberToObject(model->held_by_nothing, "t", model->t);
    PetscCall(describe(model, &m, n_free, cJSON_AddObjectToObject(model->held_by_nothing, "bodies"), text, sizeof(text)));
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                           "snes_contact: warning: at t = %.6g nothing holds what follows, neither supports nor contact nor "
                           "friction: %s. The matrix is singular, and how far bodies drift so is arbitrary: support them, or "
                           "give contact friction.\n",
                           (double)model->t, text));
  }
  PetscCall(motions_destroy(&m));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
