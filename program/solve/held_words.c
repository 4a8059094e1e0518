/* Motions of parts, in words. */
#include "solve/held.h"
#include <cjson/cJSON.h>

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
    PetscCall(parts_name(solve->physics, p, name, sizeof(name)));
    PetscCall(PetscSNPrintf(sentence, sizeof(sentence), "%s%s%s%s", text[0] ? ", " : "", name, verb, words));
    PetscCall(PetscStrlcat(text, sentence, length));
    if (json) cJSON_AddStringToObject(json, name, words);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
