/* The table of keys: looking rows up, and saying in words what they hold. */
#include "scene/keys.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A page each. */
extern const KeyTable KEYS_SCENE[], KEYS_BODIES[], KEYS_LOADS[], KEYS_INTERFACE[], KEYS_GENERAL[], KEYS_HEAT[], KEYS_STEPS[], KEYS_OUTPUT[], KEYS_DYNAMICS[];
static const KeyTable *const PAGES[] = {KEYS_SCENE,   KEYS_BODIES, KEYS_LOADS, KEYS_INTERFACE, KEYS_GENERAL,
                                        KEYS_HEAT,    KEYS_STEPS,  KEYS_OUTPUT, KEYS_DYNAMICS};
enum { N_PAGES = sizeof(PAGES) / sizeof(PAGES[0]) };

const KeyTable *keys_table(size_t number)
{
  for (int p = 0; p < N_PAGES; p++) {
    for (const KeyTable *table = PAGES[p]; table->name; table++) {
      if (!number--) return table;
    }
  }
  return NULL;
}

const Key *keys_find(const char *item, const char *key, const KeyTable **found)
{
  const KeyTable *table;
  for (size_t t = 0; (table = keys_table(t)); t++) {
    for (size_t k = 0; k < table->n && !strcmp(table->item, item); k++) {
      if (strcmp(table->keys[k].key, key)) continue;
      if (found) *found = table;
      return &table->keys[k];
    }
  }
  return NULL;
}

bool keys_has_item(const char *item)
{
  const KeyTable *table;
  for (size_t t = 0; (table = keys_table(t)); t++) {
    if (!strcmp(table->item, item)) return true;
  }
  return false;
}

/* the length of the next of some words; 0 at the end */
static size_t next_word(const char **at)
{
  *at += strspn(*at, " ");
  return strcspn(*at, " ");
}

bool keys_has_word(const Key *key, const char *word)
{
  size_t n;
  for (const char *at = key->holds; key->kind == KEY_WORD && (n = next_word(&at)); at += n) {
    if (strlen(word) == n && !strncmp(word, at, n)) return true;
  }
  return false;
}

/* "0.5", "1/1024" */
static bool read_number(const char *text, double *value)
{
  char *end;
  *value = strtod(text, &end);
  if (end == text) return false;
  if (*end == '/') *value /= strtod(end + 1, &end);
  return !*end;
}

bool keys_default(const Key *key, double *value)
{
  if (key->kind == KEY_NUMBER || key->kind == KEY_WHOLE) return read_number(key->otherwise, value);
  *value = !strcmp(key->otherwise, "true");
  return key->kind == KEY_SWITCH && (*value != 0 || !strcmp(key->otherwise, "false"));
}

bool keys_allows(const Key *key, double value)
{
  const KeyRange *range = &key->range;
  if (!range->given) return true;
  return (range->above ? value > range->least : value >= range->least) && (range->below ? value < range->most : value <= range->most);
}

void keys_say_range(const KeyRange *range, char words[], size_t length)
{
  words[0] = 0;
  if (!range->given) return;
  if (isinf(range->most))
    snprintf(words, length, "%s %.6g", range->above ? "above" : "at least", range->least);
  else if (!range->above && !range->below)
    snprintf(words, length, "from %.6g to %.6g", range->least, range->most);
  else
    snprintf(words, length, "%s %.6g, %s %.6g", range->above ? "above" : "at least", range->least, range->below ? "below" : "at most", range->most);
}

static void say_words(const char *at, char words[], size_t length)
{
  size_t n, used = 0;
  while ((n = next_word(&at)) && used < length) {
    const char *next = at + n;
    used += (size_t)snprintf(words + used, length - used, "%s`%.*s`", !used ? "" : next_word(&next) ? ", " : " or ", (int)n, at);
    at += n;
  }
}

void keys_say_value(const Key *key, char words[], size_t length)
{
  static const char *const kinds[] = {"number", "whole number", "", "`[t0, v0, t1, v1, ...]`", "`true` or `false`", "", "", "file", "map", "list of names"};
  char                     range[128];
  keys_say_range(&key->range, range, sizeof(range));
  if (key->kind == KEY_WORD)
    say_words(key->holds, words, length);
  else if (key->kind == KEY_NUMBER && key->holds[0])
    snprintf(words, length, "[%s]%s%s", key->holds, range[0] ? ", " : "", range);
  else
    snprintf(words, length, "%s%s%s", kinds[key->kind][0] ? kinds[key->kind] : key->holds, range[0] ? ", " : "", range);
}
