/* Laws in place of Coulomb's: a host's function that says what Coulomb says, with states; its bad answers; from which thread it is
 * called, and what it may not do; the library's own. */
#include <pthread.h>

#include "scene.h"

/* Two ways to the same number. */
static const double SAME_NUMBER = 1e-13;

/* What the function of the host knows. */
typedef struct {
  pthread_t thread;
  stickslip_interface *interface;
  int64_t base, calls, last;
  int wrong, within; /* what is wrong with the answers; whether the library was asked from within */
  int32_t status;
} host;

/* Coulomb's law; it remembers how far the node has slipped, and how often it was closed. */
static int32_t coulomb(void *user, const stickslip_law_point *point, const double *states, stickslip_law_answer *answer,
                       double *states_after) {
  host *h = user;
  ++h->calls;
  CHECK(pthread_equal(h->thread, pthread_self()));
  CHECK(point->struct_size == sizeof *point && answer->struct_size == sizeof *answer);
  CHECK(point->node >= h->base && point->node < N1 + h->base);
  CHECK(point->normal <= 0.0 && point->mu == 0.7 && answer->threshold != answer->threshold);
  CHECK(states_after[0] == states[0] && states_after[1] == states[1]);
  h->last = point->node;
  answer->threshold = -point->mu * point->normal;
  answer->dthreshold_dnormal = -point->mu;
  states_after[0] += sqrt(point->slip[0] * point->slip[0] + point->slip[1] * point->slip[1] + point->slip[2] * point->slip[2]);
  states_after[1] += 1.0;
  switch (h->wrong) {
    case 1: answer->threshold = (double)NAN; break;
    case 2: answer->threshold = -1.0; break;
    case 3: answer->dthreshold_dnormal = 0.1; break;
    case 4: answer->dthreshold_dslip[2] = (double)INFINITY; break;
    case 5: return 77;
    case 6: states_after[1] = (double)NAN; break;
    default: break;
  }
  if (h->within) { /* no interface may be used from within; a stateless call may */
    double normal[3] = {0.0, 0.0, -1.0}, unit[3];
    h->status = stickslip_interface_rollback(h->interface);
    CHECK(strstr(stickslip_last_error_message(), "within a law"));
    CHECK_OK(stickslip_node_normal(normal, unit));
  }
  return 0;
}

typedef struct {
  double force1[X1], force2[X2], rows[X1], values[MOST_ENTRIES];
  int64_t row[MOST_ENTRIES], column[MOST_ENTRIES], count;
} answers;

static int32_t evaluate(scene *s, answers *a) {
  const int32_t status = stickslip_interface_residual(s->interface, s->x1, s->x2, s->lambda, NULL, a->force1, a->force2, a->rows);
  if (status) return status;
  return stickslip_interface_tangent_coo(s->interface, s->x1, s->x2, s->lambda, NULL, MOST_ENTRIES, a->row, a->column, a->values,
                                         &a->count);
}

static double apart(const double *a, const double *b, int64_t n) {
  double most = 0.0, scale = 0.0;
  for (int64_t k = 0; k < n; ++k) {
    most = fmax(most, fabs(a[k] - b[k]));
    scale = fmax(scale, fabs(b[k]));
  }
  return most / scale;
}

static void check_same(const answers *a, const answers *b) {
  CHECK(a->count == b->count);
  CHECK(apart(a->force1, b->force1, X1) <= SAME_NUMBER && apart(a->force2, b->force2, X2) <= SAME_NUMBER);
  CHECK(apart(a->rows, b->rows, X1) <= SAME_NUMBER && apart(a->values, b->values, a->count) <= SAME_NUMBER);
}

int main(void) {
  static scene plain, own;
  static answers a, b;
  double states[2 * N1], before[2 * N1];
  int64_t count = -1;

  for (int base = 0; base < 2; ++base) {
    host h = {.thread = pthread_self(), .base = base};
    scene_init_base(&plain, base);
    scene_init_base(&own, base);
    own.method.threads = 3;
    scene_create(&plain);
    scene_create(&own);
    h.interface = own.interface;
    CHECK_OK(stickslip_interface_set_threshold(own.interface, coulomb, &h, 2));
    CHECK_OK(evaluate(&plain, &a));
    CHECK_OK(evaluate(&own, &b));
    check_same(&a, &b);
    CHECK(h.calls > 0 && h.calls <= N1); /* residual and tangent of one point ask once */
    CHECK_OK(stickslip_interface_law_states(own.interface, 0, NULL, &count));
    CHECK(count == 2 * N1);
    CHECK_REFUSED(stickslip_interface_law_states(own.interface, count - 1, states, &count), STICKSLIP_BUFFER_TOO_SMALL, "states");
    CHECK_OK(stickslip_interface_law_states(own.interface, count, states, &count));
    for (int k = 0; k < 2 * N1; ++k) CHECK(states[k] == 0.0);

    /* The states of closed nodes move on with a commit, and back. */
    const double slid = 0.004;
    for (int step = 0; step < 2; ++step) {
      CHECK_OK(stickslip_interface_commit(own.interface, own.x1, own.x2, own.lambda, NULL));
      CHECK_OK(stickslip_interface_commit(plain.interface, plain.x1, plain.x2, plain.lambda, NULL));
      memcpy(before, states, sizeof before);
      CHECK_OK(stickslip_interface_law_states(own.interface, count, states, &count));
      int closed = 0;
      for (int k = 0; k < N1; ++k) closed += states[2 * k + 1] == before[2 * k + 1] + 1.0;
      CHECK(closed > 0);
      for (int k = 0; k < X1; ++k) own.x1[k] = plain.x1[k] += slid;
      CHECK_OK(evaluate(&plain, &a));
      CHECK_OK(evaluate(&own, &b));
      check_same(&a, &b);
    }
    CHECK_OK(stickslip_interface_rollback(own.interface));
    CHECK_OK(stickslip_interface_rollback(plain.interface));
    memcpy(states, before, sizeof before);
    CHECK_OK(stickslip_interface_law_states(own.interface, count, before, &count));
    CHECK(memcmp(states, before, sizeof before) == 0);

    /* Bad answers name the node, and change nothing. */
    CHECK_OK(evaluate(&own, &a));
    static const int32_t refusals[] = {0, STICKSLIP_NOT_FINITE, STICKSLIP_INVALID_VALUE, STICKSLIP_INVALID_VALUE,
                                       STICKSLIP_NOT_FINITE, STICKSLIP_INVALID_VALUE, STICKSLIP_NOT_FINITE};
    for (h.wrong = 1; h.wrong <= 6; ++h.wrong) {
      own.lambda[0] += 1e-9; /* another point: it is asked again */
      CHECK_REFUSED(evaluate(&own, &b), refusals[h.wrong], "non-mortar node");
      CHECK_REFUSED(stickslip_interface_commit(own.interface, own.x1, own.x2, own.lambda, NULL), refusals[h.wrong], "host's law");
      CHECK_OK(stickslip_interface_law_states(own.interface, count, before, &count));
      CHECK(memcmp(states, before, sizeof before) == 0);
    }
    h.wrong = 0;
    memcpy(own.lambda, plain.lambda, sizeof own.lambda);
    CHECK_OK(evaluate(&own, &b));
    CHECK(memcmp(a.values, b.values, (size_t)a.count * sizeof *a.values) == 0);

    h.within = 1;
    own.lambda[0] += 1e-9;
    CHECK_OK(evaluate(&own, &b));
    CHECK(h.status == STICKSLIP_INVALID_VALUE);
    h.within = 0;

    /* Coulomb's law comes back, and asks nobody. */
    CHECK_OK(stickslip_interface_set_law(own.interface, NULL));
    CHECK_OK(stickslip_interface_law_states(own.interface, 0, NULL, &count));
    CHECK(count == 0);
    h.calls = 0;
    memcpy(own.lambda, plain.lambda, sizeof own.lambda);
    CHECK_OK(evaluate(&own, &b));
    CHECK_OK(evaluate(&plain, &a));
    check_same(&b, &a);
    CHECK(h.calls == 0);

    CHECK_REFUSED(stickslip_interface_set_threshold(own.interface, NULL, &h, 0), STICKSLIP_NULL_POINTER, "threshold");
    CHECK_REFUSED(stickslip_interface_set_threshold(own.interface, coulomb, &h, -1), STICKSLIP_INVALID_SIZE, "at most 1024");
    CHECK_REFUSED(stickslip_interface_set_threshold(own.interface, coulomb, &h, STICKSLIP_LAW_MAX_STATES + 1),
                  STICKSLIP_INVALID_SIZE, "at most 1024");
    CHECK_REFUSED(stickslip_interface_set_threshold(own.interface, coulomb, &h, INT64_MAX), STICKSLIP_INVALID_SIZE, "at most 1024");
    scene_destroy(&plain);
    scene_destroy(&own);
  }

  /* The library's laws: no cohesion is Coulomb's; each other one is not, and says so. */
  scene_init(&plain);
  scene_create(&plain);
  CHECK_OK(evaluate(&plain, &a));
  stickslip_law law = {.struct_size = sizeof law, .kind = STICKSLIP_LAW_COHESION};
  CHECK_OK(stickslip_interface_set_law(plain.interface, &law));
  CHECK_OK(evaluate(&plain, &b));
  check_same(&b, &a);
  static const stickslip_law laws[] = {
      {.struct_size = sizeof law, .kind = STICKSLIP_LAW_COHESION, .cohesion = 0.1},
      {.struct_size = sizeof law, .kind = STICKSLIP_LAW_WEAKENING, .mu_after = 0.2, .critical_slip = 0.01},
      {.struct_size = sizeof law, .kind = STICKSLIP_LAW_ORTHOTROPIC, .mu_across = 0.2, .direction = {1.0, 2.0, 3.0}},
      {.struct_size = sizeof law, .kind = STICKSLIP_LAW_RATE, .mu_after = 0.1, .critical_rate = 0.01, .time = 1.0},
  };
  static const char *const words[] = {"cohesion", "falls to", "orthotropic", "rate of slip"};
  for (int k = 0; k < 4; ++k) {
    char text[2048];
    CHECK_OK(stickslip_interface_set_law(plain.interface, &laws[k]));
    CHECK_OK(evaluate(&plain, &b));
    CHECK(apart(b.rows, a.rows, X1) > 1e-3);
    CHECK_OK(stickslip_interface_effects(plain.interface, text, sizeof text));
    CHECK(strstr(text, words[k]));
  }

  /* What lies between the surfaces: each part of it changes the rows, is told, and leaves nothing behind. */
  CHECK_OK(stickslip_interface_set_law(plain.interface, NULL));
  static const double overclosure[] = {0.0, 1e-3}, pressure[] = {0.0, 1.0};
  static const stickslip_layer layers[] = {
      {.struct_size = sizeof layers[0], .n_overclosure = 2, .overclosure = overclosure, .pressure = pressure},
      {.struct_size = sizeof layers[0], .wear = 0.1},
      {.struct_size = sizeof layers[0], .bond_stiffness = 10.0, .bond_strength = 0.1, .bond_toughness = 0.01, .bond_shear = 1.0},
  };
  static const char *const parts[] = {"yields", "wears", "bonded"};
  static const int64_t remembered[] = {0, 2, 4};
  for (int k = 0; k < 3; ++k) {
    char text[2048];
    int64_t count;
    double worn[N1], damage[N1];
    const stickslip_states out = {.struct_size = sizeof out, .worn = worn, .damage = damage};
    CHECK_OK(stickslip_interface_set_layer(plain.interface, &layers[k]));
    CHECK_OK(evaluate(&plain, &b));
    CHECK(apart(b.rows, a.rows, X1) > 1e-6);
    CHECK_OK(stickslip_interface_effects(plain.interface, text, sizeof text));
    CHECK(strstr(text, parts[k]));
    CHECK_OK(stickslip_interface_law_states(plain.interface, 0, NULL, &count));
    CHECK(count == remembered[k] * N1);
    CHECK_OK(stickslip_interface_states(plain.interface, plain.x1, plain.x2, plain.lambda, NULL, &out));
    for (int n = 0; n < N1; ++n) CHECK(worn[n] >= 0.0 && damage[n] >= 0.0 && damage[n] <= 1.0);
  }
  CHECK_OK(stickslip_interface_set_layer(plain.interface, NULL));
  CHECK_OK(evaluate(&plain, &b));
  check_same(&b, &a);
  scene_destroy(&plain);
  return 0;
}
