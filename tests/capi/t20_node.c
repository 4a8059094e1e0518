/* Stage 2: gap, stick and slip of a node; ties, frictionless and uncovered nodes; derivatives by differences. */
#include "check.h"

#include <stddef.h>

static const double nu[3] = {0.6, 0.0, 0.8};

/* A closed, covered node with sigma_N = -10 and sigma_T = t along y. */
static stickslip_node make_node(double t, double mu) {
  stickslip_node n;
  memset(&n, 0, sizeof n);
  n.struct_size = sizeof n;
  memcpy(n.normal, nu, sizeof nu);
  n.augmentation = 4.0;
  n.mu = mu;
  n.coverage = n.coverage_previous = 1.0;
  n.coverage_min = 1e-8;
  for (int i = 0; i < 3; ++i) n.lambda[i] = -8.0 * nu[i];
  for (int i = 0; i < 3; ++i) n.gap_now[i] = n.gap_previous[i] = -0.5 * nu[i];
  n.gap_previous[1] += 0.25 * t;
  return n;
}

static stickslip_node_response respond(const stickslip_node *n) {
  stickslip_node_response r;
  memset(&r, 0, sizeof r);
  r.struct_size = sizeof r;
  CHECK_OK(stickslip_node_respond(n, &r));
  CHECK(r.struct_size == sizeof r && r.reserved == 0);
  /* The row is -(lambda - p) / r in every state. */
  for (int i = 0; i < 3; ++i) CHECK_NEAR(r.row[i], -(n->lambda[i] - r.traction[i]) / n->augmentation, 1e-14);
  return r;
}

static int32_t state(const stickslip_node *n) { return respond(n).state; }

/* One input of the node, its derivative in the response. */
static void check_derivative(const stickslip_node *node, size_t input, const double *derivative, double factor) {
  const double step = 1e-6;
  for (int j = 0; j < 3; ++j) {
    stickslip_node n = *node;
    double *x = (double *)(void *)((char *)&n + input) + j;
    const double at = *x;
    *x = at + step;
    const stickslip_node_response plus = respond(&n);
    *x = at - step;
    const stickslip_node_response minus = respond(&n);
    for (int i = 0; i < 3; ++i) {
      CHECK_NEAR(derivative[3 * i + j], (plus.row[i] - minus.row[i]) / (2.0 * step), 1e-8);
      /* dp/dg is r times dc/dg. */
      if (factor > 0.0) {
        CHECK_NEAR(factor * derivative[3 * i + j], (plus.traction[i] - minus.traction[i]) / (2.0 * step), 1e-8);
      }
    }
  }
}

int main(void) {
  const double mu = 0.5;

  /* Stick: p = sigma, below mu |sigma_N| = 5. */
  stickslip_node n = make_node(4.0, mu);
  stickslip_node_response r = respond(&n);
  CHECK(r.state == STICKSLIP_STATE_STICK);
  CHECK_NEAR(r.gap_normal, -0.5, 1e-15);
  CHECK_NEAR(r.slip[1], 1.0, 1e-15);
  CHECK_NEAR(r.sigma[0], -6.0, 1e-14);
  CHECK_NEAR(r.sigma[1], 4.0, 1e-14);
  CHECK_NEAR(r.sigma[2], -8.0, 1e-14);
  for (int i = 0; i < 3; ++i) CHECK(r.traction[i] == r.sigma[i]);

  /* Slip: the tangential part is cut to the cone. */
  n = make_node(20.0, mu);
  r = respond(&n);
  CHECK(r.state == STICKSLIP_STATE_SLIP);
  CHECK_NEAR(r.traction[1], 5.0, 1e-14);
  CHECK_NEAR(r.traction[0], -6.0, 1e-14);

  /* Gap: open beyond the multiplier. The row drives lambda to zero. */
  n = make_node(4.0, mu);
  for (int i = 0; i < 3; ++i) n.gap_now[i] = 3.0 * nu[i];
  r = respond(&n);
  CHECK(r.state == STICKSLIP_STATE_GAP && max_abs(r.traction, 3) == 0.0);

  /* On the cone within 1e-12 a node slips; the border of the gap is gap. */
  n = make_node(5.0, mu);
  CHECK(state(&n) == STICKSLIP_STATE_SLIP);
  n = make_node(5.0 * (1.0 - 1e-13), mu);
  CHECK(state(&n) == STICKSLIP_STATE_SLIP);
  n = make_node(5.0 * (1.0 - 1e-10), mu);
  CHECK(state(&n) == STICKSLIP_STATE_STICK);
  n = make_node(0.0, mu);
  memset(n.lambda, 0, sizeof n.lambda);
  memset(n.gap_now, 0, sizeof n.gap_now);
  memset(n.gap_previous, 0, sizeof n.gap_previous);
  CHECK(state(&n) == STICKSLIP_STATE_GAP);

  /* Without friction nothing tangential is carried, with or without a trial traction. */
  for (int moving = 0; moving < 2; ++moving) {
    n = make_node(moving ? 4.0 : 0.0, 0.0);
    r = respond(&n);
    CHECK(r.state == STICKSLIP_STATE_SLIP);
    CHECK_NEAR(r.traction[1], 0.0, 0.0);
    CHECK_NEAR(r.traction[0], -6.0, 1e-14);
  }

  /* The other laws. With a shear limit below mu |sigma_N| = 5 that is the shear; above it mu decides. */
  n = make_node(20.0, mu);
  n.friction = STICKSLIP_FRICTION_TRESCA;
  n.shear_limit = 3.0;
  r = respond(&n);
  CHECK(r.state == STICKSLIP_STATE_SLIP);
  CHECK_NEAR(r.traction[1], 3.0, 1e-14);
  check_derivative(&n, offsetof(stickslip_node, gap_now), r.drow_dnow, n.augmentation);
  n.shear_limit = 6.0;
  CHECK_NEAR(respond(&n).traction[1], 5.0, 1e-14);
  CHECK_REFUSED((n.shear_limit = 0.0, stickslip_node_respond(&n, &r)), STICKSLIP_INVALID_VALUE, "node.shear_limit");
  n = make_node(20.0, 0.0);
  n.friction = STICKSLIP_FRICTION_ROUGH;
  CHECK(state(&n) == STICKSLIP_STATE_STICK);
  n.friction = STICKSLIP_FRICTION_NONE;
  r = respond(&n);
  CHECK(r.state == STICKSLIP_STATE_SLIP && max_abs(r.slip, 3) == 0.0);
  CHECK_NEAR(r.traction[1], 0.0, 0.0);
  /* Tied to the gap 2 nu, 2.5 away. */
  n.friction = STICKSLIP_FRICTION_TIED;
  for (int i = 0; i < 3; ++i) n.gap_committed[i] = 2.0 * nu[i];
  r = respond(&n);
  CHECK(r.state == STICKSLIP_STATE_STICK);
  CHECK_NEAR(r.row[2], -2.5 * nu[2], 1e-15);
  n.friction = 5;
  CHECK_REFUSED(stickslip_node_respond(&n, &r), STICKSLIP_INVALID_VALUE, "node.friction");
  n = make_node(20.0, mu);
  n.friction = STICKSLIP_FRICTION_TIED;
  CHECK_REFUSED(stickslip_node_respond(&n, &r), STICKSLIP_INVALID_VALUE, "node.mu");

  /* A huge coefficient sticks. */
  n = make_node(20.0, 1e6);
  CHECK(state(&n) == STICKSLIP_STATE_STICK);

  /* Uncovered: gap, whatever the multiplier. Uncovered at t_n: no slip history. */
  n = make_node(4.0, mu);
  n.coverage = n.coverage_min;
  CHECK(state(&n) == STICKSLIP_STATE_GAP);
  n = make_node(4.0, mu);
  n.coverage_previous = 0.0;
  r = respond(&n);
  CHECK(r.state == STICKSLIP_STATE_STICK && max_abs(r.slip, 3) == 0.0 && max_abs(r.drow_dprevious, 9) == 0.0);

  /* The three measures of slip: P (g_prev - g_now), P (g_prev - g_committed), P g_prev. */
  n = make_node(4.0, mu);
  n.gap_now[1] = 0.25;
  n.gap_committed[1] = 0.125;
  const double measured[3] = {0.75, 0.875, 1.0};
  for (int32_t slip = 0; slip < 3; ++slip) {
    n.slip = slip;
    CHECK_NEAR(respond(&n).slip[1], measured[slip], 1e-15);
  }

  /* Prescribed along y: nothing tangential is left there, and the row removes the multiplier's part. */
  n = make_node(20.0, mu);
  n.n_directions = 1;
  n.directions[1] = 1.0;
  n.lambda[1] = 2.0;
  r = respond(&n);
  CHECK(r.state == STICKSLIP_STATE_STICK);
  CHECK_NEAR(r.traction[1], 0.0, 0.0);
  CHECK_NEAR(r.row[1], -0.5, 1e-15);

  /* All derivatives, in every state and for every measure. */
  for (int32_t slip = 0; slip < 3; ++slip) {
    for (int k = 0; k < 4; ++k) {
      n = make_node(k == 1 ? 20.0 : 3.0, k == 3 ? 0.0 : mu);
      n.slip = slip;
      n.lambda[0] += 0.3;
      n.lambda[2] -= 0.4;
      n.gap_committed[1] = 0.02;
      if (k == 2) n.gap_now[0] += 30.0;
      r = respond(&n);
      CHECK(r.state == (k == 0 ? STICKSLIP_STATE_STICK : k == 2 ? STICKSLIP_STATE_GAP : STICKSLIP_STATE_SLIP));
      check_derivative(&n, offsetof(stickslip_node, lambda), r.drow_dlambda, 0.0);
      check_derivative(&n, offsetof(stickslip_node, gap_now), r.drow_dnow, n.augmentation);
      check_derivative(&n, offsetof(stickslip_node, gap_previous), r.drow_dprevious, n.augmentation);
      /* dc/dlambda = (dp/dlambda - I) / r. */
      for (int i = 0; i < 9; ++i) {
        CHECK_NEAR(r.drow_dlambda[i], (r.dp_dlambda[i] - (i % 4 == 0 ? 1.0 : 0.0)) / n.augmentation, 1e-15);
      }
    }
  }
  return 0;
}
