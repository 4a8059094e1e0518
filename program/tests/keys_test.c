/* The table of keys by itself: what a row must be. Prints the rows that are not; exit code 1 if there is one. */
#include "scene/keys.h"
#include <stdio.h>
#include <string.h>

static int failures = 0, rows = 0;

static void expect(const KeyTable *table, const Key *key, bool holds, const char *what)
{
  if (!holds) printf("%s, %s: %s\n", table->title, key->key, what);
  failures += !holds;
}

/* The same key of an item may stand in several tables: readers take the first row, so that all must say the same. */
static void check_twin(const KeyTable *table, const Key *key)
{
  const Key *first = keys_find(table->item, key->key, NULL);
  expect(table, key, first != NULL, "it is not found");
  if (!first) return;
  expect(table, key, first->kind == key->kind, "another row of it has another kind");
  expect(table, key, first->range.given == key->range.given && first->range.least == key->range.least && first->range.most == key->range.most,
         "another row of it has another range");
  expect(table, key, key->kind == KEY_MAP || !strcmp(first->otherwise, key->otherwise) || !keys_default(first, &(double){0}), "another row of it has another default");
}

static void check_row(const KeyTable *table, const Key *key)
{
  const char *text[] = {key->holds, key->otherwise, key->meaning};
  double      value;
  char        words[512];
  rows++;
  check_twin(table, key);
  for (int k = 0; k < 3; k++)
    expect(table, key, !strpbrk(text[k], "|\n"), "a line or a bar would end its row in a page");
  expect(table, key, key->meaning[0] != 0, "it has no meaning");
  expect(table, key, (key->kind != KEY_WORD && key->kind != KEY_NAME && key->kind != KEY_NUMBERS) || key->holds[0], "what does it hold?");
  expect(table, key, !key->range.given || (key->kind <= KEY_NUMBERS && key->range.least < key->range.most), "its range allows nothing");
  if (keys_default(key, &value) && key->kind != KEY_SWITCH) expect(table, key, keys_allows(key, value), "its default is not allowed");
  if (key->kind == KEY_WORD && key->otherwise[0] && !strchr(key->otherwise, ' ') && strcmp(key->otherwise, REQUIRED))
    expect(table, key, keys_has_word(key, key->otherwise), "its default is none of its words");
  if (key->kind == KEY_SWITCH && !strchr(key->otherwise, ' ')) expect(table, key, keys_default(key, &value), "its default is neither true nor false");
  if (key->kind == KEY_MAP && strcmp(key->key, "all") && strcmp(table->name, "solver") != 0) expect(table, key, keys_has_item(key->key), "the map has no keys");
  if (key->kind == KEY_LIST) expect(table, key, keys_has_item(key->key), "the names have no keys");
  keys_say_value(key, words, sizeof(words));
  expect(table, key, words[0] && strlen(words) + 1 < sizeof(words), "what it holds is not said, or too long");
}

static void check_words(void)
{
  const Key number = {"a", KEY_NUMBER, "L", ABOVE_TO(0, 2), "1/4", "m"}, word = {"b", KEY_WORD, "one two", ANY, "two", "m"};
  double    value  = 0;
  char      words[64];
  keys_say_value(&number, words, sizeof(words));
  failures += strcmp(words, "[L], above 0, at most 2") != 0 || !keys_default(&number, &value) || value != 0.25;
  failures += keys_allows(&number, 0) || !keys_allows(&number, 2) || keys_allows(&number, 2.5);
  keys_say_value(&word, words, sizeof(words));
  failures += strcmp(words, "`one` or `two`") != 0 || keys_has_word(&word, "on") || !keys_has_word(&word, "one") || keys_default(&word, &value);
}

int main(void)
{
  const KeyTable *table;
  for (size_t t = 0; (table = keys_table(t)); t++) {
    for (size_t k = 0; k < table->n; k++)
      check_row(table, &table->keys[k]);
  }
  check_words();
  printf("%d rows, %d faults\n", rows, failures);
  return failures > 0 || rows < 150;
}
