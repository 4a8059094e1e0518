/* Which parts of the model nothing holds. The rigid motions of all parts (three translations, three turns each) meet two
 * kinds of constraints: prescribed components of vertices and springs, and closed contact nodes: along the normal and, with friction,
 * across the direction in which they slip; in all directions where they stick or are tied. Motions that none of them feels are free: the matrix is singular, and where
 * the parts end along them is arbitrary.
 *
 * Parts that their supports hold by themselves do not move here. The others are asked together, for two may drift as one.
 * Positions are those of now. */
#include "solve/held.h"
#include <cjson/cJSON.h>

static const char IS_FREE[] = " is free to ";

/* By supports and springs alone: what is free of the parts that are chosen; which of these are, in `loose`. */
static PetscErrorCode look(const Solve *solve, const PetscBool *chosen, PetscBool *loose, cJSON *json, char text[], size_t length)
{
  Physics *physics = solve->physics;
  Motions  m;
  PetscInt n_free;
  PetscFunctionBegin;
  PetscCall(motions_create(physics, NULL, chosen, &m));
  PetscCall(motions_add_springs(physics, NULL, PETSC_FALSE, &m));
  PetscCall(motions_sum(&m));
  motions_add_rings(solve->physics, &m);
  PetscCall(motions_find_free(&m, &n_free));
  PetscCall(held_words(solve, &m, n_free, IS_FREE, json, text, length));
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
      if (!interface->skin && interface->body[side] != rigid->body) continue;
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
  const PetscBool springs = (PetscBool)(solve->physics->springs != NULL);
  PetscBool      *loose;
  char            free[1024];
  PetscFunctionBegin;
  text[0] = 0;
  if (solve->physics->dynamics) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(solve->physics->parts.n, &loose));
  PetscCall(by_supports(solve, loose, NULL, free, sizeof(free)));
  PetscCall(PetscSNPrintf(text, length, "%s%s%s", !free[0] ? "" : springs ? "By the supports and springs " : "By the supports ", free,
                          free[0]   ? ": only contact can hold that, where bodies touch and as far as friction goes."
                          : springs ? "Every body is held by supports and springs; contact need not hold it."
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
  cJSON_Delete(solve->held.laid_down);
  cJSON_Delete(solve->held.by_nothing.json);
  cJSON_Delete(solve->held.by_springs.json);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: what neither supports nor contact hold, into by_nothing and words; `found`: there is something */
static PetscErrorCode find_free(Solve *solve, Motions *m, PetscBool *found)
{
  HeldFinding *finding = &solve->held.by_nothing;
  char         text[2048], words[2560];
  PetscInt     n_free;
  PetscFunctionBegin;
  PetscCall(motions_find_free(m, &n_free));
  *found = (PetscBool)(n_free > 0);
  if (!n_free) PetscFunctionReturn(PETSC_SUCCESS);
  finding->json = cJSON_CreateObject();
  cJSON_AddNumberToObject(finding->json, "t", solve->physics->t);
  PetscCall(held_words(solve, m, n_free, IS_FREE, cJSON_AddObjectToObject(finding->json, "bodies"), text, sizeof(text)));
  PetscCall(PetscSNPrintf(words, sizeof(words),
                          "nothing holds what follows, neither supports nor contact nor friction: %s. The matrix is singular, and how far "
                          "bodies drift so is arbitrary: support them, or give contact friction.",
                          text));
  PetscCall(PetscStrallocpy(words, &finding->words));
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
  if (!any || solve->held.by_nothing.told) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(motions_create(physics, physics->u_local, solve->held.loose, &m));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++)
    PetscCall(motions_add_contact(solve->mesh, &solve->contact->interfaces[i], &m));
  PetscCall(motions_add_springs(physics, physics->u_local, PETSC_FALSE, &m));
  PetscCall(motions_sum(&m));
  motions_add_rings(solve->physics, &m);
  if (solve->mesh->rank == 0) PetscCall(find_free(solve, &m, &found));
  PetscCallMPI(MPI_Bcast(&found, 1, MPIU_BOOL, 0, PETSC_COMM_WORLD));
  solve->held.by_nothing.told = solve->held.by_nothing.unsettled = found;
  PetscCall(motions_destroy(&m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step of the last checks was accepted, or not. */
PetscErrorCode held_settle(Solve *solve, PetscBool accepted)
{
  HeldFinding *findings[] = {&solve->held.by_nothing, &solve->held.by_springs};
  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    HeldFinding *finding = findings[k];
    if (!accepted && finding->unsettled) finding->told = PETSC_FALSE;
    finding->unsettled = PETSC_FALSE;
    if (!finding->words) continue;
    if (accepted) {
      PetscCall(PetscFPrintf(PETSC_COMM_SELF, PETSC_STDERR, "stickslip: warning: at t = %.6g %s\n", (double)solve->physics->t, finding->words));
    } else {
      cJSON_Delete(finding->json);
      finding->json = NULL;
    }
    PetscCall(PetscFree(finding->words));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
