/* Random calls with numbers from everywhere in the range of doubles, NULL and crooked pointers, and corrupt histories:
 * whatever comes, the answer is success or a refusal that has written nothing; never a fault of the library. */
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
  const int size = 6 * e.pair.n1 + 3 * e.pair.n2;

  int32_t status;
  switch (draw(8)) {
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
    default: status = stickslip_node_normal(ANY(e.sum), ANY(e.normal)); break;
  }
  if (succeeded(status)) {
    ++successes;
  } else {
    ++refusals;
    element_untouched(&e);
  }
}

/* Any sequence of calls on one handle. */
static void sequence(void) {
  static handle h;
  static history spoilt;
  memset(&h, 0, sizeof h);
  scene *s = &h.s;
  scene_init(s);
  s->options.form = (int32_t)draw(2);
  s->options.weights = (int32_t)draw(3);
  s->options.slip = (int32_t)draw(3);
  s->options.new_contact = (int32_t)draw(2);
  s->options.quadrature = (int32_t)draw(2);
  s->options.friction = (int32_t)draw(4);
  s->options.no_shortcuts = (int32_t)draw(16);
  s->options.weak_coverage = 0.5 * (double)draw(3);
  if (s->options.friction != STICKSLIP_FRICTION_COULOMB) s->options.mu = 0.0;
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

  static scene usual;
  scene_init(&usual);
  for (uint64_t calls = 6; calls > 0; --calls) {
    memcpy(s->x1, usual.x1, sizeof s->x1);
    memcpy(s->x2, usual.x2, sizeof s->x2);
    memcpy(s->lambda, usual.lambda, sizeof s->lambda);
    if (draw(2)) scene_slide(s, random_number(&seed));
    if (draw(3) == 0) spoil(s->x1, X1);
    if (draw(3) == 0) spoil(s->x2, X2);
    if (draw(2) == 0) spoil(s->lambda, X1);
    handle_fill(&h);
    history_take(s->interface, &h.before);
    double values[X1];
    for (int k = 0; k < X1; ++k) values[k] = 1.0;
    spoil(values, N1);
    int32_t status;
    switch (draw(14)) {
      case 0: status = stickslip_interface_set_friction(s->interface, values); break;
      case 1: status = stickslip_interface_set_augmentation(s->interface, draw(3) ? values : NULL); break;
      case 2: {
        for (int k = 0; k < X1; ++k) values[k] = k % 3 == 2;
        if (draw(2)) spoil(values, X1);
        status = stickslip_interface_set_normals(s->interface, draw(3) ? values : NULL);
        break;
      }
      case 3: {
        const int64_t nodes[2] = {any_integer(4), any_integer(4)};
        status = stickslip_interface_set_constraints(s->interface, (int64_t)draw(3), nodes, values);
        break;
      }
      case 4: status = stickslip_interface_rollback(s->interface); break;
      case 5: {
        spoilt = h.before;
        for (uint64_t k = draw(4); k > 0; --k) {
          int64_t *i = spoilt.integers + draw((uint64_t)spoilt.n_integers);
          *i = any_integer(*i);
        }
        spoil(spoilt.reals, (int)spoilt.n_reals);
        status = stickslip_interface_history_import(s->interface, any_integer(spoilt.n_integers) % COUNT(spoilt.integers),
                                                    spoilt.integers, spoilt.n_reals, spoilt.reals);
        break;
      }
      default: status = evaluations[draw(COUNT(evaluations))](&h); break;
    }
    if (succeeded(status)) {
      ++successes;
    } else {
      ++refusals;
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
    if (k % 40 == 0) sequence();
  }
  CHECK(successes > n / 20 && refusals > n / 20);
  return 0;
}
