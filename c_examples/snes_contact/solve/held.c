/* Which parts of the model nothing holds. The rigid motions of all parts (three translations, three turns each) meet two
 * kinds of constraints: prescribed components of vertices, and closed contact nodes: along the normal and, with friction,
 * across the direction in which they slip; in all directions where they stick or are tied. Motions that none of them feels are free: the matrix is singular, and where
 * the parts end along them is arbitrary.
 *
 * Parts that their supports hold by themselves do not move here. The others are asked together, for two may drift as one.
 * Positions are those of now. */
#include "solve/motions.h"
#include "solve/solve.h"
#include <cjson/cJSON.h>

/* Normals that enclose less than this count as one: a slope of less than a hundredth, as a flat surface has when it is
 * strained, holds nothing. */
static const PetscReal SLOPE = 1e-2;
/* Friction below this part of the pressure is none, but for rounding. */
static const PetscReal NO_FRICTION = 1e-9;

/* Rings resist their own widening, and a turn out of their plane: what is left moves along the axis. */
static void add_rings(const Solve *solve, Motions *m)
{
  static const PetscReal held = 1;
  const PetscInt         kinds[] = {0, 5}; /* along x, about z */
  for (PetscInt k = 0; k < 2 * m->n_parts && solve->mesh->space.kind == SPACE_AXISYMMETRIC; k++) {
    const PetscInt column = MODES * (k / 2) + kinds[k % 2];
    motions_constrain(m, 1, &column, &held);
  }
}

/* Of a rigid body's first two vertices the second one has its turns. */
static PetscBool is_turn(const Solve *solve, PetscInt vertex)
{
  const PetscInt r = rigids_of_vertex(solve->physics, vertex);
  return (PetscBool)(r >= 0 && vertex == solve->physics->rigids[r].first_vertex + 1);
}

static void add_supports(const Solve *solve, const PetscReal *x, Motions *m)
{
  for (PetscInt v = 0; v < solve->mesh->n_vertices; v++) {
    for (int i = 0; i < 3; i++) {
      const PetscReal d[3] = {i == 0, i == 1, i == 2};
      PetscInt        columns[MODES];
      PetscReal       values[MODES];
      int             n = 0;
      if (!(solve->physics->prescribed[v] & (1 << i))) continue;
      if (is_turn(solve, v)) {
        motions_turn(m, solve->physics->parts.of_mesh[v], i);
        continue;
      }
      motions_row(m, solve->physics->parts.of_mesh[v], x + 3 * v, d, 1, columns, values, &n);
      motions_constrain(m, n, columns, values);
    }
  }
  add_rings(solve, m);
}

/* The part of the mortar vertex nearest to a node: a surface may belong to several. */
static PetscInt mortar_part(const Solve *solve, const Interface *interface, const PetscReal *x, const PetscReal at[3])
{
  Physics        *physics = solve->physics;
  const PetscInt *nodes   = interface->nodes + interface->n1;
  PetscInt        part    = physics->parts.of_mesh[nodes[0]];
  PetscBool       one     = PETSC_TRUE;
  PetscReal       best    = PETSC_MAX_REAL;
  for (PetscInt k = 1; k < interface->n2 && one; k++)
    one = (PetscBool)(physics->parts.of_mesh[nodes[k]] == part);
  for (PetscInt k = 0; k < interface->n2 && !one; k++) {
    PetscReal squared = 0;
    for (int i = 0; i < 3; i++)
      squared += PetscSqr(x[3 * nodes[k] + i] - at[i]);
    if (squared < best) best = squared, part = physics->parts.of_mesh[nodes[k]];
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

/* of the nodes that are closed at the place of the last evaluation */
static PetscErrorCode add_contact(const Solve *solve, const Interface *interface, const PetscReal *x, Motions *m)
{
  const ContactStates *states = &interface->states;
  PetscInt            *first, n_first = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(interface->n1, &first));
  for (PetscInt a = 0; a < interface->n1; a++) {
    const PetscInt   v  = interface->nodes[a];
    const PetscReal *at = x + 3 * v;
    PetscInt         other, columns[2 * MODES];
    PetscReal        values[2 * MODES], turns[3];
    const PetscBool  sticks = (PetscBool)(states->state[a] == STICKSLIP_STATE_STICK);
    if (states->state[a] == STICKSLIP_STATE_GAP || interface->removed[a] == 7) continue;
    other = mortar_part(solve, interface, x, at);
    across(states->normal + 3 * a, states->multiplier + 3 * a, turns);
    for (int i = 0; i < (sticks ? 3 : 2); i++) {
      const PetscReal axis[3] = {i == 0, i == 1, i == 2},
                     *d       = sticks ? axis : i == 1 ? turns : same_normal(states->normal, first, &n_first, a);
      int n = 0;
      if (!sticks && i == 1 && turns[0] == 0 && turns[1] == 0 && turns[2] == 0) continue;
      if (sticks && interface->removed[a] & (1 << i)) continue;
      motions_row(m, solve->physics->parts.of_mesh[v], at, d, 1, columns, values, &n);
      if (other != solve->physics->parts.of_mesh[v]) motions_row(m, other, at, d, -1, columns, values, &n);
      motions_constrain(m, n, columns, values);
    }
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "block", or "block (piece 2)" where a body is in pieces */
static void part_name(const Solve *solve, PetscInt part, char name[], size_t length)
{
  Physics *physics = solve->physics;
  PetscInt piece   = 0, pieces = 0, v = 0, last = -1;
  while (physics->parts.of_mesh[v] != part)
    v++;
  for (PetscInt b = 0; b < solve->mesh->n_bodies; b++) {
    const Body *body = &solve->mesh->bodies[b];
    if (v < body->first_vertex || v >= body->end_vertex) continue;
    for (PetscInt w = body->first_vertex; w < body->end_vertex; w++) { /* parts are numbered as they are met */
      if (physics->parts.of_mesh[w] <= last) continue;
      last = physics->parts.of_mesh[w];
      pieces++;
      if (last == part) piece = pieces;
    }
    if (pieces > 1)
      PetscCallAbort(PETSC_COMM_SELF, PetscSNPrintf(name, length, "%s (piece %d of %d)", body->name, (int)piece, (int)pieces));
    else
      PetscCallAbort(PETSC_COMM_SELF, PetscSNPrintf(name, length, "%s", body->name));
  }
}

/* Every part's free motions: "upper is free to move along x, lower is free to turn about z" */
static PetscErrorCode describe(const Solve *solve, const Motions *m, PetscInt n_free, cJSON *json, char text[],
                               size_t length)
{
  PetscFunctionBegin;
  text[0] = 0;
  for (PetscInt p = 0; p < solve->physics->parts.n && n_free; p++) {
    char name[2 * NAME_LENGTH], words[512], sentence[1024];
    if (m->place[p] < 0) continue;
    PetscCall(motions_words(m, n_free, m->place[p], words, sizeof(words)));
    if (!words[0]) continue;
    part_name(solve, p, name, sizeof(name));
    PetscCall(PetscSNPrintf(sentence, sizeof(sentence), "%s%s is free to %s", text[0] ? ", " : "", name, words));
    PetscCall(PetscStrlcat(text, sentence, length));
    if (json) cJSON_AddStringToObject(json, name, words);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: by the supports alone; `loose`: which parts they do not hold */
static PetscErrorCode by_supports(const Solve *solve, PetscBool *loose, cJSON *json, char text[], size_t length)
{
  Physics *physics = solve->physics;
  PetscFunctionBegin;
  text[0] = 0;
  for (PetscInt p = 0; p < physics->parts.n; p++) { /* they hold each part by itself */
    Motions    m;
    PetscBool *only;
    PetscInt   n_free;
    char       part[1024];
    PetscCall(PetscCalloc1(physics->parts.n, &only));
    only[p] = PETSC_TRUE;
    PetscCall(motions_create(physics, solve->mesh->coordinates, only, &m));
    add_supports(solve, solve->mesh->coordinates, &m);
    PetscCall(motions_find_free(&m, &n_free));
    PetscCall(describe(solve, &m, n_free, json, part, sizeof(part)));
    loose[p] = (PetscBool)(n_free > 0);
    PetscCall(PetscStrlcat(text, text[0] && part[0] ? ", " : "", length));
    PetscCall(PetscStrlcat(text, part, length));
    PetscCall(motions_destroy(&m));
    PetscCall(PetscFree(only));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode held_free(const Solve *solve, const Body *body, PetscBool *is_free)
{
  PetscFunctionBegin;
  *is_free = PETSC_FALSE;
  for (PetscInt v = body->first_vertex; v < body->end_vertex; v++)
    *is_free = (PetscBool)(*is_free || ((!body->analytic || body->rigid) && solve->held.loose[solve->physics->parts.of_mesh[v]]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A sentence for the user, on every rank: which bodies contact alone must hold. */
PetscErrorCode held_describe(const Solve *solve, char text[], size_t length)
{
  PetscFunctionBegin;
  text[0] = 0;
  if (solve->mesh->rank == 0) {
    PetscBool *loose;
    char       free[1024];
    PetscCall(PetscCalloc1(solve->physics->parts.n, &loose));
    PetscCall(by_supports(solve, loose, NULL, free, sizeof(free)));
    PetscCall(PetscSNPrintf(text, length, "%s%s%s", free[0] ? "By the supports " : "", free,
                            free[0] ? ": only contact can hold that, where bodies touch and as far as friction goes."
                                    : "Every body is held by supports; contact need not hold it."));
    PetscCall(PetscFree(loose));
  }
  PetscCallMPI(MPI_Bcast(text, (PetscMPIInt)length, MPI_CHAR, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0, at the start: notes what contact alone must hold. */
PetscErrorCode held_create(Solve *solve)
{
  char text[1024];
  PetscFunctionBegin;
  if (solve->mesh->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(solve->physics->parts.n, &solve->held.loose));
  solve->held.by_contact = cJSON_CreateObject();
  PetscCall(by_supports(solve, solve->held.loose, solve->held.by_contact, text, sizeof(text)));
  if (text[0] && !solve->quiet)
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "note: by the supports %s; contact must hold that\n", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode held_destroy(Solve *solve)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(solve->held.loose));
  cJSON_Delete(solve->held.by_contact);
  cJSON_Delete(solve->held.by_nothing);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0, at a converged state, before its commit: is something held by nothing at all? The first time is told, once the
 * step is accepted. */
PetscErrorCode held_check(Solve *solve, const PetscScalar *displacements)
{
  const Mesh *mesh    = solve->mesh;
  Physics    *physics = solve->physics;
  PetscReal  *x;
  PetscBool   any = PETSC_FALSE;
  PetscInt    n_free;
  Motions     m;
  char        text[2048];

  PetscFunctionBegin;
  for (PetscInt p = 0; p < physics->parts.n; p++)
    any = (PetscBool)(any || solve->held.loose[p]);
  if (!any || solve->held.by_nothing) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(3 * mesh->n_vertices, &x));
  for (PetscInt k = 0; k < 3 * mesh->n_vertices; k++)
    x[k] = mesh->coordinates[k] + PetscRealPart(displacements[k]);
  PetscCall(motions_create(physics, x, solve->held.loose, &m));
  add_supports(solve, x, &m);
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++)
    PetscCall(add_contact(solve, &solve->contact->interfaces[i], x, &m));
  PetscCall(motions_find_free(&m, &n_free));
  if (n_free) {
    solve->held.by_nothing = cJSON_CreateObject();
    cJSON_AddNumberToObject(solve->held.by_nothing, "t", physics->t);
    PetscCall(describe(solve, &m, n_free, cJSON_AddObjectToObject(solve->held.by_nothing, "bodies"), text,
                       sizeof(text)));
    PetscCall(PetscStrallocpy(text, &solve->held.words));
  }
  PetscCall(motions_destroy(&m));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step of the last check was accepted, or not. */
PetscErrorCode held_settle(Solve *solve, PetscBool accepted)
{
  PetscFunctionBegin;
  if (!solve->held.words) PetscFunctionReturn(PETSC_SUCCESS);
  if (accepted) {
    PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR,
                           "snes_contact: warning: at t = %.6g nothing holds what follows, neither supports nor contact "
                           "nor friction: %s. The matrix is singular, and how far bodies drift so is arbitrary: "
                           "support them, or give contact friction.\n",
                           (double)solve->physics->t, solve->held.words));
  } else {
    cJSON_Delete(solve->held.by_nothing);
    solve->held.by_nothing = NULL;
  }
  PetscCall(PetscFree(solve->held.words));
  PetscFunctionReturn(PETSC_SUCCESS);
}
