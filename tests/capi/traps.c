/* Linked to a test program: traps for invalid operations, division by zero and overflow are on before main starts, as
 * with gfortran's -ffpe-trap=invalid,zero,overflow. */
#define _GNU_SOURCE
#include <fenv.h>

__attribute__((constructor)) static void traps_on(void) {
  feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
}
