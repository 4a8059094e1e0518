/* Two threads that write one variable without a lock: the tool that looks for races must find it, or its silence means
 * nothing. */
#include <pthread.h>
#include <stddef.h>

static int shared;

static void *run(void *argument) {
  (void)argument;
  ++shared;
  return NULL;
}

int main(void) {
  pthread_t threads[2];
  for (int k = 0; k < 2; ++k) {
    if (pthread_create(&threads[k], NULL, run, NULL)) return 1;
  }
  for (int k = 0; k < 2; ++k) pthread_join(threads[k], NULL);
  return shared == 2 ? 0 : 1;
}
