/* Checks for the ABI's tests: the first failure says where, what and the library's last message, and ends the test.
 * A test that passes prints nothing, so anything on its output came from the library and is a failure too. */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <stickslip.h>

#define CHECK(condition) check_true(!!(condition), __FILE__, __LINE__, #condition)
/* |a - b| <= tolerance; false for NaN. */
#define CHECK_NEAR(a, b, tolerance) check_near((a), (b), (tolerance), __FILE__, __LINE__, #a " = " #b)
#define CHECK_OK(call) check_status((call), STICKSLIP_OK, "", __FILE__, __LINE__, #call)
/* The call is refused with this status, and the message holds this word: the argument at fault. */
#define CHECK_REFUSED(call, status, word) check_status((call), (status), (word), __FILE__, __LINE__, #call)

/* Outputs are filled with a pattern before a call that must not write them. */
#define FILL(object) memset(&(object), 0x5A, sizeof(object))
#define CHECK_UNTOUCHED(object) check_untouched(&(object), sizeof(object), __FILE__, __LINE__, #object)

#define COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))

static inline void check_true(int holds, const char *file, int line, const char *text) {
  if (holds) return;
  fprintf(stderr, "%s:%d: %s does not hold; last message: \"%s\"\n", file, line, text, stickslip_last_error_message());
  exit(1);
}

static inline void check_near(double a, double b, double tolerance, const char *file, int line, const char *text) {
  if (fabs(a - b) <= tolerance) return;
  fprintf(stderr, "%s:%d: %s: %.17g and %.17g differ by %.3g, allowed %.3g; last message: \"%s\"\n", file, line, text,
          a, b, fabs(a - b), tolerance, stickslip_last_error_message());
  exit(1);
}

static inline void check_status(int32_t status, int32_t expected, const char *word, const char *file, int line,
                                const char *text) {
  const char *message = stickslip_last_error_message();
  const int said = expected == STICKSLIP_OK ? message[0] == '\0' : message[0] != '\0' && strstr(message, word) != NULL;
  if (status == expected && said) return;
  fprintf(stderr, "%s:%d: %s\n  gave %d (%s), expected %d (%s)\n  message \"%s\", expected to name \"%s\"\n", file, line,
          text, (int)status, stickslip_status_string(status), (int)expected, stickslip_status_string(expected), message,
          word);
  exit(1);
}

static inline void check_untouched(const void *object, size_t size, const char *file, int line, const char *text) {
  for (size_t k = 0; k < size; ++k) {
    if (((const unsigned char *)object)[k] != 0x5A) {
      fprintf(stderr, "%s:%d: byte %lu of %s was written by a refused call\n", file, line, (unsigned long)k, text);
      exit(1);
    }
  }
}

/* Deterministic numbers in -1..1. */
static inline double random_number(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 33) / (double)(1u << 30) - 1.0;
}

/* NaN if any is NaN. */
static inline double max_abs(const double *v, int n) {
  double largest = 0.0;
  for (int k = 0; k < n; ++k) largest = fabs(v[k]) <= largest ? largest : isnan(largest) ? largest : fabs(v[k]);
  return largest;
}

#endif
