/* The rows of bad_input.txt, whose head says what they mean. */
#include "bad_rows.h"
#include "check.h"

enum { MOST = 8, LONGEST = 1000 };

/* The row that is carried out, in parts. */
static struct {
  int line, n;
  char text[LONGEST], *calls, *names[MOST], *values[MOST], *words;
  int32_t status;
  const char *function;
  char spoilt[64]; /* the last name, without its index */
} row;
static const bad_host *host;

static void fail(const char *what, const char *which) {
  fprintf(stderr, "%s:%d: %s \"%s\"\n", BAD_INPUT, row.line, what, which);
  exit(1);
}

/* Whatever ends the program, its output says in which row. */
static void say_row(void) {
  if (host != NULL) fprintf(stderr, "%s:%d: in this row, at %s\n", BAD_INPUT, row.line, row.function);
}

/* Cuts off the first part of a list; NULL at the list's end. */
static char *cut(char **list, char between) {
  char *part = *list;
  if (part == NULL) return NULL;
  *list = strchr(part, between);
  if (*list != NULL) *(*list)++ = '\0';
  return part;
}

static int32_t status_named(const char *name) {
#define STATUS(name) {#name, STICKSLIP_##name}
  static const struct {
    const char *name;
    int32_t status;
  } all[] = {STATUS(OK), STATUS(NULL_POINTER), STATUS(STRUCT_SIZE), STATUS(INVALID_SIZE), STATUS(NOT_FINITE),
             STATUS(INDEX_OUT_OF_RANGE), STATUS(DUPLICATE_NODE), STATUS(DEGENERATE_FACET), STATUS(INVALID_VALUE),
             STATUS(MISSING_STIFFNESS), STATUS(UNSUPPORTED), STATUS(UNDEFINED_NORMAL), STATUS(PROJECTION_NOT_CONVEX),
             STATUS(BUFFER_TOO_SMALL), STATUS(MISSING_ENTRY), STATUS(HISTORY_MISMATCH)};
  for (int k = 0; k < COUNT(all); ++k) {
    if (strcmp(all[k].name, name) == 0) return all[k].status;
  }
  fail("no such status:", name);
  return 0;
}

/* The function's own place of this name, or the one of all functions. */
static bad_at *place_named(const char *name, int is_array) {
  char own[LONGEST];
  snprintf(own, sizeof own, "%s:%s", row.function, name);
  bad_at *p = bad_find(own, is_array);
  return p != NULL ? p : bad_find(name, is_array);
}

/* Entries first to last of a place, together or one after the other. */
typedef struct {
  bad_at *p;
  int first, last, together;
} target;

/* The place, and its name without the index. */
static target target_named(const char *text, char name[64]) {
  snprintf(name, 64, "%s", text);
  const char *index = text[strlen(text) - 1] == ']' ? strrchr(text, '[') : NULL;
  if (index != NULL) name[index++ - text] = '\0';
  target t = {place_named(name, index != NULL), 0, 0, 0};
  if (t.p == NULL) fail("nothing has the name", text);
  if (index == NULL) return t;
  t.last = t.p->n - 1;
  if (*index == '*') return t;
  const int numbers = sscanf(index, "%d:%d", &t.first, &t.last);
  t.together = numbers == 2;
  if (numbers == 1) t.last = t.first;
  if (numbers < 1 || t.first < 0 || t.last < t.first || t.last >= t.p->n) fail("no such entry:", text);
  return t;
}

static size_t size_of(const bad_at *p) { return p->type == INT32 ? sizeof(int32_t) : sizeof(int64_t); }

static int64_t integer_of(const char *text, int64_t good) {
  static const struct {
    const char *name;
    int64_t value;
  } limits[] = {{"INT32_MIN", INT32_MIN}, {"INT32_MAX", INT32_MAX}, {"INT64_MIN", INT64_MIN}, {"INT64_MAX", INT64_MAX}};
  for (int k = 0; k < COUNT(limits); ++k) {
    if (strcmp(limits[k].name, text) == 0) return limits[k].value;
  }
  const int relative = strncmp(text, "good", 4) == 0;
  char *end;
  const long long value = strtoll(text + (relative ? 4 : 0), &end, 10);
  if (*text == '\0' || *end != '\0') fail("no integer:", text);
  return relative ? good + value : value;
}

/* Entry k takes a value; the entry lies `step` behind the first one of those that are spoilt together. */
static void assign(bad_at *p, int k, const char *value, int step) {
  char *to = p->at + (size_t)k * size_of(p), *end, name[64];
  const char *from = strchr(value, '@');
  char *pointer;
  int64_t integer = 0;
  double number, other;
  if (p->type == INT32) {
    const int32_t small = (int32_t)integer_of(value, 0);
    memcpy(to, &small, sizeof small);
    p->spoilt |= SPOILT;
    return;
  }
  memcpy(&pointer, to, sizeof pointer);
  memcpy(&integer, to, sizeof integer);
  memcpy(&number, to, sizeof number);
  if (from != NULL) {
    const target t = target_named(from + 1, name);
    if (t.p->type != p->type || t.first + step >= t.p->n) fail("cannot be taken:", value);
    const char *source = t.p->at + (size_t)(t.first + step) * size_of(p);
    memcpy(&other, source, sizeof other);
    number += atof(value) * (other - number);
    memcpy(to, from == value ? source : (char *)&number, sizeof number);
  } else if (p->type == REAL) {
    number = strtod(value, &end);
    if (*value == '\0' || *end != '\0') fail("no number:", value);
    memcpy(to, &number, sizeof number);
  } else if (p->type == INT64) {
    integer = integer_of(value, integer);
    memcpy(to, &integer, sizeof integer);
  } else {
    const bad_at *array = place_named(row.spoilt, 1);
    const int kind = strcmp(value, "null") == 0 ? 0 : strcmp(value, "misaligned") == 0 ? 1 : 2;
    if (kind == 2 && (strcmp(value, "given") != 0 || array == NULL)) fail("no pointer:", value);
    pointer = kind == 0 ? NULL : kind == 1 ? pointer + 1 : array->at;
    memcpy(to, &pointer, sizeof pointer);
  }
  p->spoilt |= strcmp(value, "nan") == 0 ? SPOILT_NAN : strcmp(value, "null") == 0 ? SPOILT_NULL : SPOILT;
}

/* The call as it stands: its status, and the words of its message. */
static void perform(void) {
  char words[LONGEST];
  const int at_first = row.words[0] == '^';
  const char *from = row.words + at_first, *star = strchr(from, '*');
  const int before = star == NULL ? (int)strlen(from) : (int)(star - from);
  snprintf(words, sizeof words, "%.*s%s%s", before, from, star ? row.spoilt : "", star ? star + 1 : "");
  check_status(host->call(row.function), row.status, words, BAD_INPUT, row.line, row.text);
  if (at_first && strncmp(stickslip_last_error_message(), words, strlen(words)) != 0) fail("does not begin so:", words);
}

/* All combinations of the assignments from the k-th on. */
static void spoil(int k) {
  if (k == row.n) {
    perform();
    return;
  }
  char names[LONGEST], values[LONGEST], kept[LONGEST];
  strcpy(names, row.names[k]);
  for (char *name, *list = names; (name = cut(&list, ',')) != NULL;) {
    const target t = target_named(name, row.spoilt);
    const int n = t.together ? t.last - t.first + 1 : 1;
    const size_t size = size_of(t.p);
    CHECK((size_t)n * size <= sizeof kept);
    for (int entry = t.first; entry <= (t.together ? t.first : t.last); ++entry) {
      memcpy(kept, t.p->at + (size_t)entry * size, (size_t)n * size);
      strcpy(values, row.values[k]);
      for (char *value, *rest = values; (value = cut(&rest, ',')) != NULL;) {
        target_named(name, row.spoilt);
        int used = 1;
        for (int step = 0; step < n; ++step) {
          assign(t.p, entry + step, value, step);
          if (t.together && rest != NULL && ++used <= n) value = cut(&rest, ',');
        }
        if (t.together && (rest != NULL || (used != 1 && used != n))) fail("not as many values as entries of", name);
        spoil(k + 1);
        memcpy(t.p->at + (size_t)entry * size, kept, (size_t)n * size);
      }
    }
  }
}

/* Refusals one after the other, or successes; then the good call, which must succeed. */
static void carry_out(char *call, int32_t base) {
  row.function = cut(&call, ':');
  if (call != NULL) base = (int32_t)integer_of(call, 0);
  host->set_up(row.function, base);
  spoil(0);
  if (row.status != STICKSLIP_OK) host->compare();
  check_status(host->call(row.function), STICKSLIP_OK, "", BAD_INPUT, row.line, row.function);
  host->tear_down();
}

/* The line in parts: calls, assignments, status, words. */
static void read_row(char *line) {
  strcpy(row.text, line);
  row.calls = cut(&line, ' ');
  row.n = 0;
  char *part;
  while ((part = cut(&line, ' ')) != NULL && strchr(part, '=') != NULL) {
    if (row.n == MOST) fail("too many assignments:", row.text);
    row.values[row.n] = part;
    row.names[row.n] = cut(&row.values[row.n], '=');
    ++row.n;
  }
  row.status = status_named(part != NULL ? part : "");
  row.words = line != NULL ? line : part + strlen(part);
}

void bad_rows(const char *who, int32_t base, const bad_host *of) {
  FILE *file = fopen(BAD_INPUT, "r");
  char line[LONGEST];
  int rows = 0;
  host = of;
  row.function = "its reading";
  atexit(say_row);
  if (file == NULL) fail("cannot be read:", BAD_INPUT);
  while (fgets(line, sizeof line, file) != NULL) {
    ++row.line;
    line[strcspn(line, "\n")] = '\0';
    if (line[0] == '#' || line[0] == '\0') continue;
    if (strncmp(line, "C  ", 3) != 0 && strncmp(line, "CF ", 3) != 0) fail("no row of C or CF:", line);
    if (strncmp(line, who, strlen(who)) != 0) continue;
    read_row(line + 3);
    for (char *call, *list = row.calls; (call = cut(&list, ',')) != NULL;) carry_out(call, base);
    ++rows;
  }
  fclose(file);
  if (bad_unspoilt() != NULL) fail("no row spoils, with null, misaligned or nan,", bad_unspoilt());
  host = NULL;
  printf("%d rows of bad input\n", rows);
}
