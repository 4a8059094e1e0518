/* What a scene says in effect, as a text: two runs of one scene have the same. */
#include "scene/scene_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Where the run goes on and what it writes may change: steps, output, how linear systems are solved. */
static PetscBool may_change(const char *flat)
{
  static const char *const maps[] = {"output_", "steps_", "snes_", "ksp_", "pc_", "mat_"};
  for (size_t k = 0; k < sizeof(maps) / sizeof(maps[0]); k++) {
    if (!strncmp(flat, maps[k], strlen(maps[k]))) return PETSC_TRUE;
  }
  return (PetscBool)(!strcmp(flat, "restart") || !strcmp(flat, "solver"));
}

static int compare(const void *a, const void *b)
{
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

PetscErrorCode scene_effective(const Scene *scene, char **text)
{
  enum { LONGEST = 8192 };
  const char **keys;
  char        *value, name[2 * NAME_LENGTH + 3];
  size_t       used = 0, capacity = 1;
  PetscInt     n = 0;
  PetscBool    set;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(scene->n_asked, &keys));
  PetscCall(PetscMalloc1(LONGEST, &value));
  PetscCall(PetscCalloc1(capacity, text));
  for (PetscInt k = 0; k < scene->n_asked; k++) {
    if (!may_change(scene->asked[k])) keys[n++] = scene->asked[k];
  }
  qsort(keys, (size_t)n, sizeof(*keys), compare);
  for (PetscInt k = 0; k < n; k++) {
    size_t length;
    snprintf(name, sizeof(name), "-%s", keys[k]);
    PetscCall(PetscOptionsGetString(NULL, NULL, name, value, LONGEST, &set));
    if (!set) continue;
    length = strlen(keys[k]) + strlen(value) + 2;
    if (used + length + 1 > capacity) {
      capacity = 2 * capacity + length + 1;
      PetscCall(PetscRealloc(capacity, text));
    }
    used += (size_t)snprintf(*text + used, capacity - used, "%s=%s\n", keys[k], value);
  }
  PetscCall(PetscFree(keys));
  PetscCall(PetscFree(value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the length of a line's key */
static int key_length(const char *line)
{
  return (int)strcspn(line, "=\n");
}

void scene_difference(const char *before, const char *now, char words[], size_t length)
{
  words[0] = 0;
  while (*before || *now) {
    const size_t n = strcspn(before, "\n"), m = strcspn(now, "\n");
    const int    kb = key_length(before), kn = key_length(now);
    const int    start = strncmp(before, now, (size_t)(kb < kn ? kb : kn)), order = !*before ? 1 : !*now ? -1 : start ? start : kb - kn;
    if (*before && *now && n == m && !strncmp(before, now, n)) {
      before += n + (before[n] == '\n');
      now += m + (now[m] == '\n');
      continue;
    }
    if (!order)
      snprintf(words, length, "its %.*s is %.*s, here it is %.*s", kb, before, (int)(n - (size_t)kb) - 1, before + kb + 1,
               (int)(m - (size_t)kn) - 1, now + kn + 1);
    else if (order < 0)
      snprintf(words, length, "its %.*s is not given here", kb, before);
    else
      snprintf(words, length, "it has no %.*s", kn, now);
    for (char *c = words; *c; c++) { /* block.young, not block_young */
      if (*c == '_') {
        *c = '.';
        break;
      }
    }
    return;
  }
}
