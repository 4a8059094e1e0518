/* Which parts of the model nothing holds. The rigid motions of all parts (three translations, three turns each) meet two
 * kinds of constraints: prescribed components of vertices and springs, and closed contact nodes: along the normal and, with friction,
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

/* Where a node of a part is now. */
static void position_of(const ContactPart *part, PetscInt node, PetscReal x[3])
{
  contact_vector(part->dimension, part->x, node, x);
  for (int i = 0; i < part->dimension; i++)
    x[i] += part->origin[i];
}

/* The model's part of the mortar vertex nearest to a node: a surface may belong to several. */
static PetscInt mortar_part(const ContactPart *part, const PetscReal at[3])
{
  const PetscInt *pieces = part->piece + part->n1;
  PetscInt        piece  = pieces[0];
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
static PetscErrorCode add_contact(const Mesh *mesh, const Interface *interface, Motions *m)
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
    other = mortar_part(part, at);
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

/* "block", or "block (piece 2)" where a body is in pieces: parts are numbered as they are met */
static void part_name(const Solve *solve, PetscInt part, char name[], size_t length)
{
  const Parts   *parts = &solve->physics->parts;
  const PetscInt body  = mesh_body_of(solve->mesh, parts->part[part].first);
  PetscInt       piece = 0, pieces = 0;
  for (PetscInt p = 0; p < parts->n; p++) {
    if (mesh_body_of(solve->mesh, parts->part[p].first) != body) continue;
    pieces++;
    if (p == part) piece = pieces;
  }
  if (pieces > 1)
    PetscCallAbort(PETSC_COMM_SELF, PetscSNPrintf(name, length, "%s (piece %d of %d)", solve->mesh->bodies[body].name, (int)piece,
                                                  (int)pieces));
  else
    PetscCallAbort(PETSC_COMM_SELF, PetscSNPrintf(name, length, "%s", solve->mesh->bodies[body].name));
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

/* By supports and springs alone: what is free of the parts that are chosen; which of these are, in `loose`. */
static PetscErrorCode look(const Solve *solve, const PetscBool *chosen, PetscBool *loose, cJSON *json, char text[], size_t length)
{
  Physics *physics = solve->physics;
  Motions  m;
  PetscInt n_free;
  PetscFunctionBegin;
  PetscCall(motions_create(physics, NULL, chosen, &m));
  PetscCall(motions_add_springs(physics, NULL, &m));
  PetscCall(motions_sum(&m));
  add_rings(solve, &m);
  PetscCall(motions_find_free(&m, &n_free));
  PetscCall(describe(solve, &m, n_free, json, text, length));
  for (PetscInt p = 0; p < physics->parts.n; p++) {
    char words[512] = "";
    if (!chosen[p]) continue;
    if (n_free && m.n_parts > 1) PetscCall(motions_words(&m, n_free, m.place[p], words, sizeof(words)));
    loose[p] = (PetscBool)(m.n_parts > 1 ? words[0] != 0 : n_free > 0);
  }
  PetscCall(motions_destroy(&m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `loose`: which parts they do not hold. */
static PetscErrorCode by_supports(const Solve *solve, PetscBool *loose, cJSON *json, char text[], size_t length)
{
  const PetscInt n = solve->physics->parts.n;
  PetscBool     *chosen;
  PetscFunctionBegin;
  text[0] = 0;
  PetscCall(PetscCalloc1(n, &chosen));
  for (PetscInt p = 0; p < n; p++) { /* supports hold each part by itself; springs join them */
    char part[1024];
    chosen[p] = PETSC_TRUE;
    if (solve->physics->springs && p + 1 < n) continue;
    PetscCall(look(solve, chosen, loose, json, part, sizeof(part)));
    PetscCall(PetscStrlcat(text, text[0] && part[0] ? ", " : "", length));
    PetscCall(PetscStrlcat(text, part, length));
    chosen[p] = PETSC_FALSE;
  }
  PetscCall(PetscFree(chosen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool held_free(const Solve *solve, PetscInt body)
{
  const Parts *parts = &solve->physics->parts;
  for (PetscInt p = 0; p < parts->n && (!solve->mesh->bodies[body].analytic || solve->mesh->bodies[body].rigid); p++) {
    if (solve->held.loose[p] && mesh_body_of(solve->mesh, parts->part[p].first) == body) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Is the turn of a rigid body left to contact without friction? */
static PetscBool turns_unheld(const Solve *solve, const Rigid *rigid)
{
  PetscBool free = PETSC_FALSE, touches = PETSC_FALSE;
  for (int k = 3; k < RIGID_UNKNOWNS; k++)
    free = (PetscBool)(free || rigid->equations[k] >= 0);
  for (PetscInt i = 0; i < solve->contact->n_interfaces && free; i++) {
    const Interface *interface = &solve->contact->interfaces[i];
    for (int side = 0; side < 2; side++) {
      if (interface->body[side] != rigid->body) continue;
      touches = PETSC_TRUE;
      free    = (PetscBool)(free && interface->options.friction == STICKSLIP_FRICTION_NONE);
    }
  }
  return (PetscBool)(free && touches);
}

/* Such bodies, in a sentence. */
static PetscErrorCode add_turns(const Solve *solve, char text[], size_t length)
{
  const Physics *physics = solve->physics;
  char           sentence[512];
  PetscFunctionBegin;
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    if (!turns_unheld(solve, &physics->rigids[r])) continue;
    PetscCall(PetscSNPrintf(sentence, sizeof(sentence),
                            " Without friction nothing tells how %s is turned where it is round: prescribe its turns, or give it friction.",
                            solve->mesh->bodies[physics->rigids[r].body].name));
    PetscCall(PetscStrlcat(text, sentence, length));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A sentence for the user: which bodies contact alone must hold. */
PetscErrorCode held_describe(const Solve *solve, char text[], size_t length)
{
  PetscBool *loose;
  char       free[1024];
  PetscFunctionBegin;
  text[0] = 0;
  if (solve->physics->dynamics) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(solve->physics->parts.n, &loose));
  PetscCall(by_supports(solve, loose, NULL, free, sizeof(free)));
  PetscCall(PetscSNPrintf(text, length, "%s%s%s", free[0] ? "By the supports " : "", free,
                          free[0] ? ": only contact can hold that, where bodies touch and as far as friction goes."
                                  : "Every body is held by supports; contact need not hold it."));
  PetscCall(add_turns(solve, text, length));
  PetscCall(PetscFree(loose));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At the start, and where supports change: notes what contact alone must hold. */
PetscErrorCode held_create(Solve *solve)
{
  char text[1024];
  PetscFunctionBegin;
  PetscCall(PetscFree(solve->held.loose));
  cJSON_Delete(solve->held.by_contact);
  PetscCall(PetscCalloc1(solve->physics->parts.n, &solve->held.loose));
  solve->held.by_contact = cJSON_CreateObject();
  if (solve->physics->dynamics) PetscFunctionReturn(PETSC_SUCCESS); /* inertia holds everything */
  PetscCall(by_supports(solve, solve->held.loose, solve->held.by_contact, text, sizeof(text)));
  if (text[0] && !solve->quiet)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "note: by the supports %s; contact must hold that\n", text));
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

/* rank 0: what neither supports nor contact hold, into by_nothing and words; `found`: there is something */
static PetscErrorCode find_free(Solve *solve, Motions *m, PetscBool *found)
{
  Held    *held = &solve->held;
  char     text[2048];
  PetscInt n_free;
  PetscFunctionBegin;
  PetscCall(motions_find_free(m, &n_free));
  *found = (PetscBool)(n_free > 0);
  if (!n_free) PetscFunctionReturn(PETSC_SUCCESS);
  held->by_nothing = cJSON_CreateObject();
  cJSON_AddNumberToObject(held->by_nothing, "t", solve->physics->t);
  PetscCall(describe(solve, m, n_free, cJSON_AddObjectToObject(held->by_nothing, "bodies"), text, sizeof(text)));
  PetscCall(PetscStrallocpy(text, &held->words));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At a converged state, the place of the last evaluation, before its commit: is something held by nothing at all?
 * The first time is told, once the step is accepted. */
PetscErrorCode held_check(Solve *solve)
{
  Physics  *physics = solve->physics;
  PetscBool any = PETSC_FALSE, found = PETSC_FALSE;
  Motions   m;

  PetscFunctionBegin;
  for (PetscInt p = 0; p < physics->parts.n; p++)
    any = (PetscBool)(any || solve->held.loose[p]);
  if (!any || solve->held.told) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(motions_create(physics, physics->u_local, solve->held.loose, &m));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++)
    PetscCall(add_contact(solve->mesh, &solve->contact->interfaces[i], &m));
  PetscCall(motions_add_springs(physics, physics->u_local, &m));
  PetscCall(motions_sum(&m));
  add_rings(solve, &m);
  if (solve->mesh->rank == 0) PetscCall(find_free(solve, &m, &found));
  PetscCallMPI(MPI_Bcast(&found, 1, MPIU_BOOL, 0, PETSC_COMM_WORLD));
  solve->held.told = solve->held.unsettled = found;
  PetscCall(motions_destroy(&m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step of the last check was accepted, or not. */
PetscErrorCode held_settle(Solve *solve, PetscBool accepted)
{
  PetscFunctionBegin;
  if (!accepted && solve->held.unsettled) solve->held.told = PETSC_FALSE;
  solve->held.unsettled = PETSC_FALSE;
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
