/* Stateless calls and distinct handles from several threads at once give the bits that one thread gets; messages belong
 * to their thread. Stacks of the threads are small. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>

#include "calls.h"

enum { THREADS = 6, ROUNDS = 20 };

/* Everything one thread computes. */
typedef struct {
  element e;
  scene s;
  triplets t;
  double r[UNKNOWNS];
  stickslip_node_response response;
} work;

static work expected, works[THREADS];

static void compute(work *w) {
  memset(&w->t, 0, sizeof w->t);
  CHECK_OK(call_weights(&w->e));
  CHECK_OK(call_gap(&w->e));
  CHECK_OK(call_residual(&w->e));
  CHECK_OK(call_tangent(&w->e));
  w->response.struct_size = sizeof w->response;
  CHECK_OK(stickslip_node_respond(&w->e.node, &w->response));
  scene_create(&w->s);
  for (int step = 0; step < 2; ++step) {
    scene_residual(&w->s, w->r);
    scene_tangent(&w->s, &w->t);
    scene_commit(&w->s);
  }
  scene_residual(&w->s, w->r);
  scene_destroy(&w->s);
}

static void *run(void *argument) {
  work *w = argument;
  CHECK(stickslip_last_error_message()[0] == '\0');
  for (int round = 0; round < ROUNDS; ++round) {
    compute(w);
    CHECK(memcmp(&w->e.w_out, &expected.e.w_out, sizeof w->e.w_out) == 0);
    CHECK(memcmp(w->e.gap, expected.e.gap, sizeof w->e.gap) == 0);
    CHECK(memcmp(w->e.force, expected.e.force, sizeof w->e.force) == 0);
    CHECK(memcmp(w->e.k, expected.e.k, sizeof w->e.k) == 0);
    CHECK(memcmp(&w->response, &expected.response, sizeof w->response) == 0);
    CHECK(memcmp(w->r, expected.r, sizeof w->r) == 0);
    CHECK(memcmp(&w->t, &expected.t, sizeof w->t) == 0);
    /* Refusals in the midst of others' successes. */
    CHECK_REFUSED(stickslip_node_normal(NULL, w->e.normal), STICKSLIP_NULL_POINTER, "sum");
  }
  return NULL;
}

/* Of a thread. The address sanitizer puts red zones around what it watches, and its build inlines less: frames of the deepest call were
   beyond 256 kB there. What the library takes as it is shipped: stack.c. */
#ifdef __SANITIZE_ADDRESS__
enum { STACK = 512 * 1024 };
#else
enum { STACK = 256 * 1024 };
#endif

int main(void) {
  pthread_t threads[THREADS];
  pthread_attr_t attributes;
  CHECK(pthread_attr_init(&attributes) == 0);
  CHECK(pthread_attr_setstacksize(&attributes, STACK) == 0);
  element_init(&expected.e);
  scene_init(&expected.s);
  compute(&expected);
  for (int k = 0; k < THREADS; ++k) {
    element_init(&works[k].e);
    scene_init(&works[k].s);
  }
  for (int k = 0; k < THREADS; ++k) CHECK(pthread_create(&threads[k], &attributes, run, &works[k]) == 0);
  for (int k = 0; k < THREADS; ++k) CHECK(pthread_join(threads[k], NULL) == 0);
  CHECK(pthread_attr_destroy(&attributes) == 0);
  CHECK(stickslip_last_error_message()[0] == '\0');
  return 0;
}
