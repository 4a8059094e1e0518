/* Carries out the rows of bad_input.txt, for a program in C and for one in Fortran. A program tells where everything
 * lies that can be spoilt, and how to set up, call and compare. */
#ifndef BAD_ROWS_H
#define BAD_ROWS_H

#include <stdint.h>

/* Of a place: a pointer that must not be null, one that may be, one to letters, which are always aligned; numbers. */
typedef enum { NEEDED, OPTIONAL, LETTERS, REAL, INT64, INT32 } bad_type;

/* A pointer or number (n = 0), or an array, named as in the rows. What is named FUNCTION:NAME is NAME in the rows of
 * this function alone. */
void bad_place(const char *name, bad_type type, void *at, int32_t n);

/* A struct of the header by what the library reads of it, NAME.member. KIND is the struct's name without stickslip_; of
 * a node_response it is the argument: answer, response, responses. */
void bad_struct(const char *kind, const char *name, void *at);

/* A place, and with what it was spoilt. */
enum { SPOILT = 1, SPOILT_NULL = 2, SPOILT_NAN = 4 };
typedef struct {
  char name[64];
  bad_type type;
  char *at;
  int n;
  unsigned spoilt;
} bad_at;

/* The place of this name, NULL if there is none. */
bad_at *bad_find(const char *name, int is_array);

/* The name of a place that no row has spoilt as all of its type are to be: a pointer null (unless it may be) and
 * misaligned, a real number NaN. NULL if there is none. */
const char *bad_unspoilt(void);

/* What a program does with a function's name, and with none. */
typedef struct {
  int32_t (*call)(const char *function);
  void (*set_up)(const char *function, int32_t base);
  /* Ends the program if anything was written since set_up, or an interface has changed. */
  void (*compare)(void);
  /* Ends all interfaces. */
  void (*tear_down)(void);
} bad_host;

/* Ends the program at the first row that does not hold, that names something unknown, and if a place was never spoilt.
 * Else prints how many rows there were: those of `who`, "C" or "CF". */
void bad_rows(const char *who, int32_t base, const bad_host *host);

#endif
