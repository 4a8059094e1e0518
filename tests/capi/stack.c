/* How much stack the calls take: each runs on a thread whose stack is filled with a pattern, and what the pattern has lost
 * is counted. STACK is what the header promises to be enough. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>

#include "kinds.h"

enum { STACK = 128 * 1024, ROOM = 1024 * 1024, PATTERN = 0xA5 };

typedef struct {
  every *c;
  const entry_point *entry;
  int32_t status;
} task;

static void *run(void *argument) {
  task *t = argument;
  t->status = t->entry->call(t->c);
  return NULL;
}

/* The bytes of its stack that a call has written to. The thread's own data, a few kB at the stack's high end, count. */
static long used(task *t, unsigned char *stack) {
  pthread_attr_t attributes;
  pthread_t thread;
  memset(stack, PATTERN, ROOM);
  CHECK(pthread_attr_init(&attributes) == 0);
  CHECK(pthread_attr_setstack(&attributes, stack, ROOM) == 0);
  CHECK(pthread_create(&thread, &attributes, run, t) == 0);
  CHECK(pthread_join(thread, NULL) == 0);
  CHECK(pthread_attr_destroy(&attributes) == 0);
  CHECK(t->status == STICKSLIP_OK);
  long untouched = 0;
  while (untouched < ROOM && stack[untouched] == PATTERN) ++untouched;
  return ROOM - untouched;
}

int main(int argc, char **argv) {
  static every c;
  void *stack;
  long most = 0;
  const char *deepest = "";
  (void)argv;
  CHECK(posix_memalign(&stack, 4096, ROOM) == 0);
  for (int k = 0; k < COUNT(kinds); ++k) {
    set_up(&kinds[k], &c);
    for (int i = 0; i < COUNT(every_call); ++i) {
      if (!belongs(&kinds[k], &every_call[i])) continue;
      task t = {&c, &every_call[i], -1};
      const long bytes = used(&t, stack);
      if (bytes > most) {
        most = bytes;
        deepest = every_call[i].name;
      }
    }
    end(&c);
  }
  free(stack);
  if (argc > 1) printf("%ld bytes: %s\n", most, deepest); /* with any argument, for people */
  CHECK(0 < most && most <= STACK);
  return 0;
}
