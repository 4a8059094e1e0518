/* A mistake on purpose, to prove that the sanitizer and valgrind see into the library: an array one number too short. */
#include <stdlib.h>

#include <stickslip.h>

int main(void) {
  double *sum = calloc(2, sizeof *sum), normal[3];
  const int32_t status = stickslip_node_normal(sum, normal);
  free(sum);
  return status == STICKSLIP_PANIC;
}
