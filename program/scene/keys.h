/* The table of the keys that a scene may have: what each holds, in which unit and range, its default, and what it means.
 *
 * It is the one place for all of that. Readers (scene.h) take range and default from it, and end the run where the program asks for a key
 * that has no row. `stickslip -keys` prints it, and `make keys` writes it into the pages of scenes. A file of keys/ has the rows of one page. */
#ifndef STICKSLIP_PROGRAM_KEYS_H
#define STICKSLIP_PROGRAM_KEYS_H
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* What a key holds. Kinds that one reader reads stand together. */
typedef enum {
  KEY_NUMBER,  /* `holds` is its unit, "" of a plain number */
  KEY_WHOLE,   /* a whole number */
  KEY_NUMBERS, /* several of them, or one or several; `holds` says which, with the unit */
  KEY_CURVE,   /* a factor over time */
  KEY_SWITCH,  /* true or false */
  KEY_WORD,    /* one of the words in `holds` */
  KEY_NAME,    /* a name, or a list of them; `holds` says of what */
  KEY_FILE,    /* a path, relative to the scene's file */
  KEY_MAP,     /* a map of keys: the item of the key's name */
  KEY_LIST     /* a list that declares names, each with a map of its own: items of the key's name */
} KeyKind;

/* The numbers that are allowed. */
typedef struct {
  bool   given, above, below; /* above, below: the bound itself is not allowed */
  double least, most;
} KeyRange;

#define ANY              {false, false, false, 0, 0}
#define FROM(a)          {true, false, false, a, INFINITY}
#define ABOVE(a)         {true, true, false, a, INFINITY}
#define WITHIN(a, b)     {true, false, false, a, b}
#define ABOVE_TO(a, b)   {true, true, false, a, b}
#define FROM_BELOW(a, b) {true, false, true, a, b}
#define BETWEEN(a, b)    {true, true, true, a, b}

#define REQUIRED "required"

typedef struct {
  const char *key;
  KeyKind     kind;
  const char *holds;
  KeyRange    range;
  const char *otherwise; /* a number, true, false or a word: what readers give where the key is missing. Other words say it; "": there is nothing then */
  const char *meaning;   /* Markdown in one line */
} Key;

/* Rows that stand together. */
typedef struct {
  const char *name;  /* of the marks in the page, between which `make keys` writes */
  const char *item;  /* whose keys: of a list that declares names, of a map, or "scene": the top level */
  const char *title; /* for messages and `-keys` */
  const char *page;
  const Key  *keys;
  size_t      n;
} KeyTable;

#define KEY_TABLE(name, item, title, page, rows) {name, item, title, page, rows, sizeof(rows) / sizeof((rows)[0])}
#define KEY_TABLES_END                           {NULL, NULL, NULL, NULL, NULL, 0}

/* all tables, in the order of the pages: NULL behind the last one */
const KeyTable *keys_table(size_t number);
/* the row of an item's key, NULL: there is none; `table`, if it is not NULL, becomes that of the row */
const Key *keys_find(const char *item, const char *key, const KeyTable **table);
bool       keys_has_item(const char *item);

/* The default as a number or a switch (0 or 1); false where it is said in words. */
bool keys_default(const Key *key, double *value);
bool keys_allows(const Key *key, double value);
/* is it one of the words of a KEY_WORD? */
bool keys_has_word(const Key *key, const char *word);
/* "above 0, at most 1" */
void keys_say_range(const KeyRange *range, char words[], size_t length);
/* "[L], above 0" */
void keys_say_value(const Key *key, char words[], size_t length);
#endif
