/* The linear system of displacements and multipliers (pairs_system.h). */
#include <stdio.h>
#include <stdlib.h>
#include "pairs_system.h"
#ifdef SPOOLES
#include "spooles.h"
#endif
#ifdef PARDISO
#include "pardiso.h"
#endif
#ifdef PASTIX
#include "pastix.h"
#endif

/* Columns of the whole matrix, its diagonal apart: CalculiX' input format 3. Symmetry flag 2: unsymmetric. */
static ITG FORMAT = 3, UNSYMMETRIC = 2;

typedef struct {
  ITG n;
  ITG *count, *first, *rows; /* count and rows of a column, both from 1 as CalculiX has them */
  double *diagonal, *values;
} Columns;

static void *memory(void *old, size_t count, size_t size) {
  void *out = realloc(old, (count ? count : 1) * size);
  if (out) return out;
  printf("*ERROR in stickslip: no memory is left for the matrix\n");
  exit(201);
}

void system_add(System *s, ITG row, ITG column, double value) {
  if (s->count == s->capacity) {
    s->capacity = s->capacity ? 2 * s->capacity : 1024;
    s->rows = memory(s->rows, s->capacity, sizeof *s->rows), s->columns = memory(s->columns, s->capacity, sizeof *s->columns);
    s->values = memory(s->values, s->capacity, sizeof *s->values);
  }
  s->rows[s->count] = row, s->columns[s->count] = column, s->values[s->count++] = value;
}

void system_add_host(System *s, const double *ad, const double *au, const ITG *icol, const ITG *irow, ITG neq, ITG upper, ITG nasym) {
  for (ITG column = 0, k = 0; column < neq; column++) {
    system_add(s, column, column, ad[column]);
    for (ITG end = k + icol[column]; k < end; k++) {
      system_add(s, irow[k] - 1, column, au[k]);
      system_add(s, column, irow[k] - 1, nasym ? au[k + upper] : au[k]);
    }
  }
}

/* The entries' places in order of one of their two numbers, stable. */
static int64_t *ordered(const System *s, const ITG *key, const int64_t *places) {
  int64_t *first = calloc(s->size + 2, sizeof *first), *out = memory(NULL, s->count, sizeof *out);
  for (int64_t k = 0; k < s->count; k++) first[key[k] + 1]++;
  for (ITG i = 0; i < s->size; i++) first[i + 1] += first[i];
  for (int64_t k = 0; k < s->count; k++) {
    const int64_t place = places ? places[k] : k;
    out[first[key[place]]++] = place;
  }
  free(first);
  return out;
}

/* Solvers other than SPOOLES take an entry once, and in order. */
static Columns compress(const System *s) {
  Columns c = {.n = s->size, .count = calloc(s->size, sizeof *c.count), .first = calloc(s->size + 1, sizeof *c.first),
               .rows = memory(NULL, s->count, sizeof *c.rows), .diagonal = calloc(s->size, sizeof(double)),
               .values = memory(NULL, s->count, sizeof(double))};
  int64_t *by_row = ordered(s, s->rows, NULL), *order = ordered(s, s->columns, by_row), n = 0;
  ITG column = -1, row = -1;
  for (int64_t k = 0; k < s->count; k++) {
    const int64_t e = order[k];
    if (s->columns[e] == s->rows[e]) {
      c.diagonal[s->rows[e]] += s->values[e];
    } else if (s->columns[e] == column && s->rows[e] == row) {
      c.values[n - 1] += s->values[e];
    } else {
      column = s->columns[e], row = s->rows[e];
      c.rows[n] = row + 1, c.values[n++] = s->values[e], c.count[column]++;
    }
  }
  c.first[0] = 1;
  for (ITG i = 0; i < c.n; i++) c.first[i + 1] = c.first[i] + c.count[i];
  free(by_row), free(order);
  return c;
}

ITG system_solve(const System *s, double *b, ITG solver) {
  Columns c = compress(s);
  ITG nzs = c.first[c.n] - 1, right_sides = 1, done = 0;
  double shift = 0;
  (void)right_sides, (void)shift, (void)nzs, (void)b;
  switch (solver) {
#ifdef SPOOLES
  case 0:
    spooles(c.diagonal, c.values, NULL, NULL, &shift, b, c.count, c.rows, &c.n, &nzs, &UNSYMMETRIC, &FORMAT, &nzs);
    done = 1;
    break;
#endif
#ifdef PARDISO
  case 7:
    pardiso_main(c.diagonal, c.values, NULL, NULL, &shift, b, c.count, c.rows, &c.n, &nzs, &UNSYMMETRIC, &FORMAT, c.first, &nzs,
                 &right_sides);
    done = 1;
    break;
#endif
#ifdef PASTIX
  case 8:
    pastix_main(c.diagonal, c.values, NULL, NULL, &shift, b, c.count, c.rows, &c.n, &nzs, &UNSYMMETRIC, &FORMAT, c.first, &nzs,
                &right_sides);
    done = 1;
    break;
#endif
  default: break;
  }
  free(c.count), free(c.first), free(c.rows), free(c.diagonal), free(c.values);
  return done;
}

void system_free(System *s) { free(s->rows), free(s->columns), free(s->values); }
