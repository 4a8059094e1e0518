/* The table of keys as a text: for people, and as the tables of the pages. */
#include "scene/keys.h"
#include "scene/keys_print.h"
#include <stdio.h>
#include <string.h>

enum { WIDTH = 110, INDENT = 24 };

/* Link texts without where they lead, links in parentheses and marks of code left out. */
static void plain(const char *markdown, char text[], size_t length)
{
  size_t used = 0;
  for (const char *at = markdown; *at && used + 1 < length; at++) {
    const char *end = strncmp(at, " ([", 3) ? NULL : strstr(at, "))");
    if (end) {
      at = end + 1;
      continue;
    }
    if (*at == ']' && at[1] == '(') {
      at = strchr(at, ')');
      continue;
    }
    if (*at == '`' || (*at == '[' && strstr(at, "](") && strcspn(at, "]") == (size_t)(strstr(at, "](") - at))) continue;
    text[used++] = *at;
  }
  text[used] = 0;
}

/* Words in lines, a space before each, behind what stands in the first one already. */
static void print_wrapped(const char *text, size_t column)
{
  while (*text) {
    size_t n = strcspn(text, " ");
    if (column + n + 1 > WIDTH) {
      printf("\n%*s", INDENT - 1, "");
      column = INDENT - 1;
    }
    printf(" %.*s", (int)n, text);
    column += n + 1;
    text += n + (text[n] == ' ');
  }
  printf("\n");
}

static void print_row(const Key *key)
{
  char value[512], text[2048], meaning[2048];
  int  column;
  keys_say_value(key, value, sizeof(value));
  column = printf("  %-*s", INDENT - 3, key->key);
  snprintf(text, sizeof(text), "%s%s%s.", value, !key->otherwise[0] ? "" : strcmp(key->otherwise, REQUIRED) ? "; default: " : "; ", key->otherwise);
  plain(text, meaning, sizeof(meaning));
  print_wrapped(meaning, (size_t)column);
  plain(key->meaning, meaning, sizeof(meaning));
  printf("%*s", INDENT - 1, "");
  print_wrapped(meaning, INDENT - 1);
}

bool keys_print(const char *item)
{
  const KeyTable *table;
  for (size_t t = 0; (table = keys_table(t)); t++) {
    if (item[0] && strcmp(table->item, item)) continue;
    printf("%s: %s (%s)\n", table->item, table->title, table->page);
    for (size_t k = 0; k < table->n; k++)
      print_row(&table->keys[k]);
    printf("\n");
  }
  return !item[0] || keys_has_item(item);
}

void keys_print_markdown(void)
{
  const KeyTable *table;
  for (size_t t = 0; (table = keys_table(t)); t++) {
    printf("%s keys %s\n| key | value | default | meaning |\n|---|---|---|---|\n", table->page, table->name);
    for (size_t k = 0; k < table->n; k++) {
      const Key  *key = &table->keys[k];
      const char *code = keys_has_word(key, key->otherwise) || (key->kind == KEY_SWITCH && keys_default(key, &(double){0})) ? "`" : "";
      char        value[512];
      keys_say_value(key, value, sizeof(value));
      printf("| `%s` | %s | %s%s%s | %s |\n", key->key, value, code, key->otherwise, code, key->meaning);
    }
  }
}

void keys_print_items(void)
{
  const KeyTable *table;
  for (size_t t = 0; (table = keys_table(t)); t++) {
    bool before = false;
    for (size_t s = 0; s < t; s++)
      before = before || !strcmp(keys_table(s)->item, table->item);
    if (!before) fprintf(stderr, "%s%s", t ? ", " : "", table->item);
  }
  fprintf(stderr, "\n");
}
