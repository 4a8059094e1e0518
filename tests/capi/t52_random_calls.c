/* Random calls with numbers from everywhere in the range of doubles, NULL and crooked pointers, and corrupt histories:
 * whatever comes, the answer is success or a refusal that has written nothing; never a fault of the library. And whatever
 * came before, the answer has the bits, and the words, that a fresh handle gives which has taken nothing but the calls
 * that define its state. */
#include <float.h>

#include "calls.h"

static uint64_t seed = 2024;

static uint64_t draw(uint64_t below) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (seed >> 33) % below;
}

/* a b, without the traps that the product of such numbers would set off. */
static double product(double a, double b) {
  if (isnan(a) || isnan(b)) return NAN;
  if ((isinf(a) && b == 0.0) || (a == 0.0 && isinf(b))) return NAN;
  if (isinf(a) || isinf(b) || (fabs(a) > 1.0 && fabs(b) > DBL_MAX / fabs(a))) {
    return signbit(a) == signbit(b) ? INFINITY : -INFINITY;
  }
  return a * b;
}

static double any_number(double usual) {
  static const double special[] = {0.0,    -0.0,   1.0,    -1.0,  5e-324, -5e-324, 1e-310, 2.2e-308, 1e-160, 1e-80,
                                   1e-16,  1e16,   1e75,   1e80,  1e150,  1e155,   1e300,  1.7e308,  -1e155, -1.7e308,
                                   1e-300, 1e-150, 1e-100, 1e100, -1e100, 1e-12,   0.5,    2.0,      3.0,    1e8};
  switch (draw(40)) {
    case 0: return NAN;
    case 1: return draw(2) ? INFINITY : -INFINITY;
    case 2: return product(usual, 1.0 + 1e-15 * random_number(&seed));
    case 3: return product(usual, special[draw(COUNT(special))]);
    case 4: return random_number(&seed);
    default: return special[draw(COUNT(special))];
  }
}

/* Spoils a few entries; now and then all. */
static void spoil(double *values, int n) {
  if (draw(30) == 0) {
    const double factor = any_number(1.0);
    for (int k = 0; k < n; ++k) values[k] = product(values[k], factor);
  }
  for (uint64_t k = draw(3); k > 0; --k) {
    double *v = values + draw((uint64_t)n);
    *v = any_number(*v);
  }
}

static int64_t any_integer(int64_t usual) {
  static const int64_t special[] = {INT64_MIN, INT64_MAX, -1, 0, 1, 2, 3, 4, 5, 35, 36, 37, 100, (int64_t)1 << 41};
  return draw(12) ? usual : special[draw(COUNT(special))];
}

static const void *any_pointer(const void *usual) {
  switch (draw(40)) {
    case 0: return NULL;
    case 1: return usual ? (const char *)usual + 1 : NULL;
    default: return usual;
  }
}
#define ANY(pointer) ((void *)(uintptr_t)any_pointer(pointer))

/* Success or a refusal with a message, never the library's fault. */
static int succeeded(int32_t status) {
  CHECK(status >= STICKSLIP_OK && status <= STICKSLIP_CONTACT_LOST);
  CHECK((status == STICKSLIP_OK) == (stickslip_last_error_message()[0] == '\0'));
  return status == STICKSLIP_OK;
}

static int64_t successes, refusals;

static void stateless(void) {
  static element good, e;
  if (good.pair.struct_size == 0) element_init(&good);
  e = good;
  e.pair.x1 = e.x1;
  e.pair.x2 = e.x2;
  if (draw(2)) {
    spoil(e.x1, 12);
    spoil(e.x2, 12);
  }
  if (draw(4) == 0) memcpy(e.x2, e.x1, sizeof e.x1);
  spoil(e.w.ab, 16);
  spoil(e.w.dac, 16 * 24);
  spoil(e.traction, 12);
  spoil(e.row_scale, 4);
  spoil(e.sum, 3);
  spoil(e.node.lambda, 3);
  if (draw(4) == 0) spoil(e.node.normal, 3);
  spoil(&e.node.augmentation, 6);
  spoil(e.node.gap_now, 9);
  spoil(e.responses[draw(3)].drow_dnow, 18);
  e.pair.n1 = (int32_t)any_integer(draw(2) ? 3 : 4);
  e.pair.n2 = (int32_t)any_integer(draw(2) ? 3 : 4);
  e.pair.quadrature = (int32_t)any_integer((int64_t)draw(2));
  e.pair.layout = (int32_t)any_integer((int64_t)draw(2));
  e.node.slip = (int32_t)any_integer((int64_t)draw(3));
  e.node.n_directions = (int32_t)any_integer((int64_t)draw(2));
  if (draw(2)) e.node.directions[0] = 1.0;
  if (draw(4) == 0) spoil(e.node.directions, 6);
  e.pair.x1 = any_pointer(e.x1);
  e.pair.x2 = any_pointer(e.x2);
  spoil(e.mass, 16);
  e.facet.n1 = e.pair.n1;
  e.facet.quadrature = e.pair.quadrature;
  e.facet.layout = e.pair.layout;
  e.facet.n_pairs = draw(8) ? 1 : -(int64_t)draw(2);
  e.n2[0] = e.pair.n2;
  e.facet.x1 = e.pair.x1;
  e.facet.n2 = any_pointer(e.n2);
  e.facet.x2 = e.pair.x2;
  const int size = 6 * e.pair.n1 + 3 * e.pair.n2;

  int32_t status;
  switch (draw(15)) {
    case 0:
      status = stickslip_pair_weights(ANY(&e.pair), ANY(e.w_out.ab), ANY(e.w_out.ac), ANY(e.w_out.dab), ANY(e.w_out.dac));
      break;
    case 1: status = stickslip_pair_gap(&e.pair, ANY(e.w.ab), ANY(e.w.ac), ANY(e.gap)); break;
    case 2: status = stickslip_pair_residual(&e.pair, ANY(e.w.ab), e.w.ac, ANY(e.traction), ANY(e.force)); break;
    case 3: {
      const int now = draw(4) > 0, moving = draw(4) > 0, before = draw(4) > 0;
      /* The leading dimension is as large as the buffer allows, or wrong. */
      const int64_t ld = draw(8) ? 36 : (int64_t)draw((uint64_t)(size > 0 && size < 36 ? size : 36));
      status = stickslip_pair_tangent(&e.pair, now ? ANY(e.w.ab) : NULL, now ? ANY(e.w.ac) : NULL,
                                      moving ? ANY(e.w.dab) : NULL, moving ? ANY(e.w.dac) : NULL,
                                      before ? ANY(e.w.ab) : NULL, before ? ANY(e.w.ac) : NULL, ANY(e.traction),
                                      ANY(e.responses), ANY(e.row_scale), ANY(e.k), ld);
      break;
    }
    case 4: {
      status = call_respond(&e);
      if (status != STICKSLIP_OK) response_untouched(&e);
      break;
    }
    case 5: {
      spoil(e.responses[0].row, 3);
      status = stickslip_node_block(ANY(&e.responses[0]), any_number(1.0), (int32_t)draw(3), ANY(e.row), ANY(e.block));
      break;
    }
    case 6: status = stickslip_facet_geometry((int32_t)any_integer(4), ANY(e.x1), ANY(e.normals), ANY(e.areas)); break;
    case 7:
      status = stickslip_facet_dual((int32_t)any_integer(4), ANY(e.x1), ANY(e.mass), ANY(&e.fade), ANY(e.dual_areas),
                                    ANY(e.coefficients));
      break;
    case 8:
      status = stickslip_pair_dual(&e.pair, ANY(e.mass), ANY(e.w.ab), ANY(e.w.ac), ANY(e.dual_ab), ANY(e.dual_ac));
      break;
    case 9: {
      const int before = draw(4) > 0;
      const int64_t ld = draw(8) ? 36 : (int64_t)draw((uint64_t)(size > 0 && size < 36 ? size : 36));
      status = stickslip_facet_tangent(&e.facet, ANY(e.w.ab), ANY(e.w.ac), before ? ANY(e.w.ab) : NULL,
                                       before ? ANY(e.w.ac) : NULL, ANY(e.traction), ANY(e.responses), ANY(e.row_scale),
                                       ANY(e.facet_k), ld);
      break;
    }
    case 10:
      status = stickslip_facet_normal_derivatives((int32_t)any_integer(4), ANY(e.x1), ANY(e.normal_derivatives));
      break;
    case 11:
      /* Mostly with a sum that fits: only one that does is looked into. */
      if (draw(4)) {
        for (int i = 0; i < 3; ++i) e.sum[i] = product(e.node.normal[i], -2.0);
      }
      status = stickslip_node_turn(ANY(&e.node), ANY(e.sum), (int32_t)draw(3), ANY(e.turn), ANY(e.turn + 9),
                                   ANY(e.turn + 18));
      break;
    case 12:
      /* A buffer may hold more than is said, and must not hold less. */
      status = stickslip_pair_begin(ANY(&e.pair), draw(8) ? STATE_SIZE : (int64_t)draw(200), ANY(e.state_out), ANY(e.w_out.ab),
                                    ANY(e.w_out.ac), ANY(e.gap));
      break;
    case 13: {
      const int before = draw(4) > 0;
      switch (draw(3)) {
        case 0: status = stickslip_pair_state_gap(ANY(e.state), ANY(e.w.ab), ANY(e.w.ac), ANY(e.gap)); break;
        case 1: status = stickslip_pair_state_residual(ANY(e.state), ANY(e.traction), ANY(e.force)); break;
        default:
          status = stickslip_pair_state_tangent(ANY(e.state), before ? ANY(e.w.ab) : NULL, before ? ANY(e.w.ac) : NULL,
                                                ANY(e.traction), ANY(e.responses), ANY(e.row_scale), ANY(e.k),
                                                draw(8) ? 36 : (int64_t)draw(36));
          break;
      }
      break;
    }
    default: status = stickslip_node_normal(ANY(e.sum), ANY(e.normal)); break;
  }
  if (succeeded(status)) {
    ++successes;
  } else {
    ++refusals;
    element_untouched(&e);
  }
}

/* A call that defines a handle's state, with its numbers. */
enum { FRICTION, AUGMENTATION, NORMALS, CONSTRAINTS, ROLLBACK, IMPORT, COMMIT, PREVIOUS, USE_NORMALS, OFFSETS, LAW, LAW_STATES, CHANGES, CALLS = 8 };
typedef struct {
  int kind, given;
  int64_t n, nodes[2];
  double values[X1], x1[X1], x2[X2], lambda[X1];
  history imported;
} change;

/* A threshold that remembers how often it was slipped at; refuses where the pressure is large. */
static int32_t host_law(void *user, const stickslip_law_point *point, const double *states, stickslip_law_answer *answer,
                        double *states_after) {
  (void)user;
  answer->threshold = 0.25 * (1.0 + states[0]) - 0.5 * point->normal;
  answer->dthreshold_dnormal = -0.5;
  states_after[0] = states[0] + 1.0;
  return point->normal < -1e6;
}

static int32_t set_law(stickslip_interface *i, const change *c) {
  stickslip_law law = {.struct_size = sizeof law, .kind = (int32_t)c->nodes[0]};
  if (!c->given) return stickslip_interface_set_law(i, NULL);
  if (c->n == 0) return stickslip_interface_set_threshold(i, host_law, NULL, 1);
  if (law.kind == STICKSLIP_LAW_COHESION) law.cohesion = c->values[0];
  if (law.kind == STICKSLIP_LAW_WEAKENING) law.mu_after = c->values[0], law.critical_slip = c->values[1];
  if (law.kind == STICKSLIP_LAW_ORTHOTROPIC) {
    law.mu_across = c->values[0];
    for (int k = 0; k < 3; ++k) law.direction[k] = c->values[1 + k % 2];
  }
  return stickslip_interface_set_law(i, &law);
}

static int32_t apply(stickslip_interface *i, const change *c) {
  const double *values = c->given ? c->values : NULL;
  switch (c->kind) {
    case FRICTION: return stickslip_interface_set_friction(i, c->values);
    case AUGMENTATION: return stickslip_interface_set_augmentation(i, values);
    case NORMALS: return stickslip_interface_set_normals(i, values);
    case CONSTRAINTS: return stickslip_interface_set_constraints(i, c->n, c->nodes, c->values);
    case ROLLBACK: return stickslip_interface_rollback(i);
    case IMPORT:
      return stickslip_interface_history_import(i, c->n, c->imported.integers, c->imported.n_reals, c->imported.reals);
    case LAW: return set_law(i, c);
    case LAW_STATES: return stickslip_interface_set_law_states(i, c->given ? N1 : c->n, c->values);
    case OFFSETS: return stickslip_interface_set_offsets(i, values, NULL);
    case USE_NORMALS: return stickslip_interface_use_normals(i, (int32_t)(c->n - 1));
    case COMMIT: return stickslip_interface_commit(i, c->x1, c->x2, c->lambda, NULL);
    default: return stickslip_interface_set_previous(i, c->x1, c->x2);
  }
}

/* Sums as handles that share an interface might add up to. */
static double total[STICKSLIP_SUMS_PER_NODE * N1];

static int32_t look_residual_sums(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_residual(s->interface, s->x1, s->x2, s->lambda, total, h->force1, h->force2, h->rows);
}
static int32_t look_coo_sums(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_tangent_coo(s->interface, s->x1, s->x2, s->lambda, total, MOST_ENTRIES, h->row_numbers,
                                         h->columns, h->values, &h->count);
}
static int32_t look_count(handle *h) {
  scene *s = &h->s;
  return stickslip_interface_tangent_coo(s->interface, s->x1, s->x2, s->lambda, NULL, 0, NULL, NULL, NULL, &h->count);
}
static int32_t look_start(handle *h) { return stickslip_interface_initial_multipliers(h->s.interface, h->rows); }
static int32_t look_report(handle *h) {
  stickslip_report report;
  memset(&report, 0, sizeof report);
  report.struct_size = sizeof report;
  report.cover = h->state;
  report.fraction = h->rows;
  const int32_t status = stickslip_interface_report(h->s.interface, h->s.x1, h->s.x2, &report);
  if (status == STICKSLIP_OK) h->count = report.finding;
  return status;
}
static int32_t look_diagnosis(handle *h) {
  stickslip_diagnosis d;
  memset(&d, 0, sizeof d);
  d.struct_size = sizeof d;
  d.suspect_nodes = h->row_numbers;
  d.suspect_ratios = h->values;
  d.suspect_capacity = MOST_ENTRIES;
  const int32_t status = stickslip_interface_diagnose(h->s.interface, h->s.x1, h->s.x2, h->s.lambda, NULL, &d);
  if (status == STICKSLIP_OK) h->count = d.suspects;
  return status;
}
static int32_t look_law_states(handle *h) {
  return stickslip_interface_law_states(h->s.interface, MOST_ENTRIES, h->values, &h->count);
}
static int32_t look_history(handle *h) {
  const int32_t status = stickslip_interface_history_size(h->s.interface, &h->row_numbers[0], &h->row_numbers[1]);
  if (status != STICKSLIP_OK) return status;
  return stickslip_interface_history_export(h->s.interface, MOST_ENTRIES, h->columns, MOST_ENTRIES, h->values);
}
static int32_t look_forces(handle *h) { return call_condensed_coo(h, STICKSLIP_CONDENSED_FORCES); }
static int32_t look_elimination(handle *h) { return call_condensed_coo(h, STICKSLIP_CONDENSED_ELIMINATION); }
static int32_t look_constraints(handle *h) { return call_condensed_coo(h, STICKSLIP_CONDENSED_CONSTRAINTS); }

/* By plans. Values go out on success alone: after a refusal they mean nothing. */
static double values[2][UNKNOWNS * UNKNOWNS];
static int32_t look_plan(handle *h) {
  scene *s = &h->s;
  int64_t rows, count;
  int32_t status = stickslip_interface_plan(s->interface, s->x1, s->x2, STICKSLIP_PLAN_ACTIVE, &rows, &count);
  if (status != STICKSLIP_OK) return status;
  CHECK(count <= COUNT(values[0]));
  status = stickslip_interface_plan_values(s->interface, s->x1, s->x2, s->lambda, NULL, count, values[0]);
  if (status != STICKSLIP_OK) return status;
  h->count = count;
  memcpy(h->values, values, (size_t)count * sizeof values[0][0]);
  return stickslip_interface_plan_coo(s->interface, STICKSLIP_ENTRIES_TANGENT, count, h->row_numbers, h->columns);
}
static int32_t look_condensed_plan(handle *h) {
  scene *s = &h->s;
  int64_t rows[2], counts[2];
  int32_t status = stickslip_interface_condensed_plan(s->interface, s->x1, s->x2, STICKSLIP_PLAN_SKIN, rows, counts);
  if (status != STICKSLIP_OK) return status;
  CHECK(counts[0] <= COUNT(values[0]) && counts[1] <= COUNT(values[1]));
  status = stickslip_interface_condensed_values(s->interface, s->x1, s->x2, s->lambda, values[0], values[1]);
  if (status != STICKSLIP_OK) return status;
  h->count = counts[1];
  memcpy(h->csr, values[0], (size_t)counts[0] * sizeof values[0][0]);
  memcpy(h->values, values[1], (size_t)counts[1] * sizeof values[0][0]);
  return stickslip_interface_plan_coo(s->interface, STICKSLIP_ENTRIES_CONSTRAINTS, counts[1], h->row_numbers, h->columns);
}

/* Calls that leave no trace. */
static const interface_call looks[] = {
    call_interface_residual, call_interface_states, call_interface_coo, call_interface_csr, call_interface_sums,
    call_interface_pattern,  look_residual_sums,    look_coo_sums,      look_count,         look_start,
    look_report,             look_diagnosis,        look_history,       look_law_states,    call_carriers,      call_condensed_csr,
    look_forces,             look_elimination,      look_constraints,   call_condensed_multipliers,
    call_condensed_residual, call_condensed_pattern, call_turn_multipliers, look_plan, look_condensed_plan};

#define SAME(member) CHECK(memcmp(&h->member, &fresh.member, sizeof h->member) == 0)

/* What a call has given is what a fresh handle gives. */
static void check_fresh(handle *h, const change *changes, int n, interface_call look, int32_t status) {
  static handle fresh;
  char message[400];
  snprintf(message, sizeof message, "%s", stickslip_last_error_message());
  fresh.s = h->s; /* whose arrays the surfaces point to */
  fresh.s.interface = NULL;
  memcpy(fresh.offsets, h->offsets, sizeof h->offsets);
  memcpy(fresh.csr_columns, h->csr_columns, sizeof h->csr_columns);
  memcpy(fresh.host1, h->host1, sizeof h->host1);
  fresh.states = h->states;
  fresh.states.state = fresh.state;
  fresh.states.normal = fresh.normal;
  handle_fill(&fresh);
  CHECK_OK(stickslip_interface_create(&h->s.nonmortar, &h->s.mortar, &h->s.options, &fresh.s.interface));
  for (int k = 0; k < n; ++k) CHECK_OK(apply(fresh.s.interface, &changes[k]));
  CHECK(look(&fresh) == status);
  CHECK(strncmp(message, stickslip_last_error_message(), sizeof message - 1) == 0);
  SAME(force1);
  SAME(force2);
  SAME(rows);
  SAME(sums);
  SAME(values);
  SAME(row_numbers);
  SAME(columns);
  SAME(count);
  SAME(state);
  SAME(normal);
  SAME(csr);
  CHECK_OK(stickslip_interface_destroy(&fresh.s.interface));
}

/* Any sequence of calls on one handle; `compared` with fresh ones. */
static void sequence(int compared) {
  static handle h;
  static change changes[CALLS];
  int n_changes = 0;
  memset(&h, 0, sizeof h);
  scene *s = &h.s;
  scene_init(s);
  s->method.form = (int32_t)draw(2);
  s->method.weights = (int32_t)draw(4);
  s->method.slip = (int32_t)draw(3);
  s->method.new_contact = (int32_t)draw(2);
  s->method.quadrature = (int32_t)draw(2);
  s->options.friction = (int32_t)draw(STICKSLIP_FRICTION_TRESCA + 1);
  s->method.no_shortcuts = (int32_t)draw(16);
  s->method.weak_coverage = 0.5 * (double)draw(3);
  s->method.multiplier_basis = (int32_t)draw(3);
  s->method.normals = s->method.weights <= STICKSLIP_WEIGHTS_CURRENT ? (int32_t)draw(3) : (int32_t)draw(2);
  if (!has_mu(s->options.friction)) s->options.mu = 0.0;
  if (s->options.friction == STICKSLIP_FRICTION_TRESCA) s->options.shear_limit = 0.5;
  if (draw(2)) spoil(&s->options.mu, 5);
  if (draw(4) == 0) spoil(s->reference1, X1);
  if (draw(4) == 0) spoil(s->reference2, X2);
  if (!succeeded(stickslip_interface_create(&s->nonmortar, &s->mortar, &s->options, &s->interface))) {
    CHECK(s->interface == NULL);
    ++refusals;
    return;
  }
  h.states.struct_size = sizeof h.states;
  h.states.state = h.state;
  h.states.normal = h.normal;
  for (int i = 0; i <= UNKNOWNS; ++i) h.offsets[i] = (int64_t)i * UNKNOWNS;
  for (int i = 0; i < UNKNOWNS * UNKNOWNS; ++i) h.csr_columns[i] = i % UNKNOWNS;
  for (int k = 0; k < COUNT(total); ++k) total[k] = 0.1 * random_number(&seed);

  static scene usual;
  scene_init(&usual);
  for (int calls = CALLS; calls > 0; --calls) {
    /* Now and then where the last call was, whose findings might be taken for its own. */
    if (calls == CALLS || draw(2)) {
      memcpy(s->x1, usual.x1, sizeof s->x1);
      memcpy(s->x2, usual.x2, sizeof s->x2);
      memcpy(s->lambda, usual.lambda, sizeof s->lambda);
      if (draw(2)) scene_slide(s, random_number(&seed));
      if (draw(3) == 0) scene_lift(s, 4.0);
      if (draw(3) == 0) spoil(s->x1, X1);
      if (draw(3) == 0) spoil(s->x2, X2);
      if (draw(2) == 0) spoil(s->lambda, X1);
    }
    handle_fill(&h);
    handle_host(&h);
    if (draw(2) == 0) spoil(h.host1, X1);
    /* Weights of t_n that were left out while the surfaces were apart may be refused when they are asked for. */
    int64_t lengths[2];
    if (!succeeded(stickslip_interface_history_size(s->interface, &lengths[0], &lengths[1]))) {
      ++refusals;
      break;
    }
    history_take(s->interface, &h.before);
    change *c = &changes[n_changes];
    c->kind = (int)draw(2 * CHANGES);
    c->given = draw(3) > 0;
    for (int k = 0; k < X1; ++k) c->values[k] = c->kind == NORMALS ? k % 3 == 2 : 1.0;
    if (c->kind == NORMALS && draw(2)) {
      for (int k = 0; k < X1; ++k) c->values[k] *= -1.0;
    }
    spoil(c->values, c->kind == NORMALS ? X1 : N1);
    c->n = (int64_t)draw(3) + (c->kind == USE_NORMALS);
    for (int k = 0; k < 2; ++k) c->nodes[k] = any_integer(4);
    if (c->kind == LAW) c->nodes[0] = any_integer((int64_t)draw(4));
    memcpy(c->x1, s->x1, sizeof c->x1);
    memcpy(c->x2, s->x2, sizeof c->x2);
    memcpy(c->lambda, s->lambda, sizeof c->lambda);
    if (c->kind == IMPORT) {
      c->imported = h.before;
      for (uint64_t k = draw(4); k > 0; --k) {
        int64_t *i = c->imported.integers + draw((uint64_t)c->imported.n_integers);
        *i = any_integer(*i);
      }
      spoil(c->imported.reals, (int)c->imported.n_reals);
      /* With a checksum that fits, so that what lies behind it is tried; or without. */
      if (draw(4)) history_seal(&c->imported);
      c->n = any_integer(c->imported.n_integers) % COUNT(c->imported.integers);
    }
    int32_t status;
    interface_call look = NULL;
    if (c->kind < CHANGES) {
      status = apply(s->interface, c);
    } else {
      look = looks[draw(COUNT(looks))];
      status = look(&h);
    }
    const int accepted = succeeded(status);
    if (look && compared) check_fresh(&h, changes, n_changes, look, status);
    if (accepted) {
      ++successes;
      n_changes += !look;
    } else {
      ++refusals;
      if (status == STICKSLIP_NOT_FINITE && (look == call_interface_coo || look == look_coo_sums)) FILL(h.values);
      handle_untouched(&h);
    }
  }
  scene_destroy(s);
}

int main(int argc, char **argv) {
  /* More with a number on the command line. */
  const int64_t n = argc > 1 ? atoll(argv[1]) : 20000;
  for (int64_t k = 0; k < n; ++k) {
    stateless();
    if (k % 40 == 0) sequence(k % 160 == 0);
  }
  CHECK(successes > n / 20 && refusals > n / 20);
  return 0;
}
