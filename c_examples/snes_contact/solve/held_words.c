/* Motions of parts, in words. */
#include "solve/held.h"
#include <cjson/cJSON.h>

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

/* Every part's free motions, with `verb` " is free to ": "upper is free to move along x, lower is free to turn about z" */
PetscErrorCode held_words(const Solve *solve, const Motions *m, PetscInt n_free, const char *verb, cJSON *json, char text[], size_t length)
{
  PetscFunctionBegin;
  text[0] = 0;
  for (PetscInt p = 0; p < solve->physics->parts.n && n_free; p++) {
    char name[2 * NAME_LENGTH], words[512], sentence[1024];
    if (m->place[p] < 0) continue;
    PetscCall(motions_words(m, n_free, m->place[p], words, sizeof(words)));
    if (!words[0]) continue;
    part_name(solve, p, name, sizeof(name));
    PetscCall(PetscSNPrintf(sentence, sizeof(sentence), "%s%s%s%s", text[0] ? ", " : "", name, verb, words));
    PetscCall(PetscStrlcat(text, sentence, length));
    if (json) cJSON_AddStringToObject(json, name, words);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
