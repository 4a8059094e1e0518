/* The library speaks of its constants and options, a scene of keys: what is STICKSLIP_WEIGHTS_CURRENT there is `weights: current` here. */
#include "contact/contact.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* Constants by how their names begin. What follows is the key's value, in capitals. */
static const struct {
  const char *name, *key;
} CONSTANTS[] = {{"STICKSLIP_BASIS_", "basis"},         {"STICKSLIP_DECISION_", "decision"}, {"STICKSLIP_FORM_", "form"},
                 {"STICKSLIP_FRICTION_", "law"},        {"STICKSLIP_INTEGRATION_", "integration"},
                 {"STICKSLIP_NORMALS_", "normals"},     {"STICKSLIP_SLIP_", "slip"},         {"STICKSLIP_SPACE_", "multiplier_space"},
                 {"STICKSLIP_TANGENT_", "tangent"},     {"STICKSLIP_WEIGHTS_", "weights"}};
/* Members of stickslip_options and stickslip_method whose keys have another name. */
static const struct {
  const char *name, *key;
} MEMBERS[] = {{"element_points", "points"}, {"friction", "law"}, {"multiplier_basis", "basis"}};
static const char OPTIONS[] = "options.", METHOD[] = "method.", NO_WEAK_COVERAGE[] = "STICKSLIP_WEAK_COVERAGE_NONE";

static PetscBool begins(const char *text, const char *with)
{
  return (PetscBool)!strncmp(text, with, strlen(with));
}

static const char *end_of_name(const char *name)
{
  while (isalnum((unsigned char)*name) || *name == '_')
    name++;
  return name;
}

/* A key and its value, which stands in capitals up to `end`. */
static void write_constant(const char *key, const char *value, const char *end, char to[], size_t length)
{
  size_t used = (size_t)snprintf(to, length, "`%s: ", key);
  for (; value < end && used + 2 < length; value++)
    to[used++] = (char)tolower((unsigned char)*value);
  snprintf(to + used, length - used, "`");
}

/* The name at `from` as the scene has it: to its end; NULL: it is none of these. */
const char *key_word(const char *from, char to[], size_t length)
{
  const char *end = end_of_name(from);
  if (begins(from, NO_WEAK_COVERAGE)) {
    snprintf(to, length, "`weak_coverage: -1`");
    return end;
  }
  for (size_t k = 0; k < sizeof(CONSTANTS) / sizeof(CONSTANTS[0]); k++) {
    if (!begins(from, CONSTANTS[k].name)) continue;
    write_constant(CONSTANTS[k].key, from + strlen(CONSTANTS[k].name), end, to, length);
    return end;
  }
  if (begins(from, OPTIONS) || begins(from, METHOD)) {
    const char *name = strchr(from, '.') + 1;
    int         n;
    end = end_of_name(name);
    n   = (int)(end - name);
    for (size_t k = 0; k < sizeof(MEMBERS) / sizeof(MEMBERS[0]); k++) {
      if ((size_t)n != strlen(MEMBERS[k].name) || !begins(name, MEMBERS[k].name)) continue;
      snprintf(to, length, "`%s`", MEMBERS[k].key);
      return end;
    }
    snprintf(to, length, "`%.*s`", n, name);
    return end;
  }
  return NULL;
}
