/* A division by zero in a program that is linked to traps.c: it must be trapped, or the silence of the others means
 * nothing. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

static void trapped(int signal) {
  (void)signal;
  puts("trapped"); /* and no more is done */
  fflush(stdout);
  _Exit(0);
}

int main(void) {
  volatile double zero = 0.0;
  signal(SIGFPE, trapped);
  zero = 1.0 / zero;
  puts("went on");
  return 1;
}
