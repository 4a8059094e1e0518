/* Heat across an interface: what is conserved, equal temperatures, friction's heat, the tangent against differences, one node. */
#include "scene.h"

/* Sums of some hundred products, over their largest. */
static const double ROUNDING = 1e-13;
/* Differences with this step, over the largest entry. */
static const double STEP = 1e-6, DIFFERENCES = 1e-6;

static double t1[N1], t2[N2];

static void heat_of(scene *s, const stickslip_heat *heat, double *sides) {
  CHECK_OK(stickslip_interface_heat(s->interface, s->x1, s->x2, s->lambda, heat, t1, t2, sides, sides + N1, NULL));
}

static double sum(const double *v, int n) {
  double all = 0.0;
  for (int k = 0; k < n; ++k) all += v[k];
  return all;
}

int main(void) {
  static scene s;
  static double values[MOST_ENTRIES], matrix[N1 + N2][UNKNOWNS + N1 + N2];
  static int64_t rows[MOST_ENTRIES], columns[MOST_ENTRIES], e1[N1], e2[N2];
  double sides[N1 + N2], more[N1 + N2], less[N1 + N2], dissipation[N1], friction[N1], flux[N1], jump[N1], conductance[N1], area[N1];
  int64_t count = -1, counted = -1;
  const stickslip_heat heat = {.struct_size = sizeof heat, .contact = 2.0, .pressure = 0.5, .exponent = 0.95, .constant = 0.3,
                               .gas = 0.1, .gas_gap = 0.2, .reach = 10.0, .share = 0.3, .time = 0.25};

  for (int base = 0; base < 2; ++base) {
    scene_init_base(&s, base);
    scene_create(&s);
    for (int a = 0; a < N1; ++a) t1[a] = 20.0 + 0.3 * a, e1[a] = base + UNKNOWNS + a;
    for (int c = 0; c < N2; ++c) t2[c] = 25.0 - 0.7 * c, e2[c] = base + UNKNOWNS + N1 + c;

    /* All that the bodies get is what friction makes, node by node as the states report it. */
    stickslip_states states = {.struct_size = sizeof states, .dissipation = dissipation};
    const stickslip_heat_nodes nodes = {.struct_size = sizeof nodes, .conductance = conductance, .flux = flux, .jump = jump,
                                        .friction = friction, .area = area};
    CHECK_OK(stickslip_interface_states(s.interface, s.x1, s.x2, s.lambda, NULL, &states));
    CHECK_OK(stickslip_interface_heat(s.interface, s.x1, s.x2, s.lambda, &heat, t1, t2, sides, sides + N1, &nodes));
    double made = 0.0;
    for (int a = 0; a < N1; ++a) {
      CHECK(fabs(friction[a] - dissipation[a] / heat.time) <= ROUNDING * fabs(friction[a]));
      CHECK(fabs(flux[a] - conductance[a] * jump[a]) <= ROUNDING * fabs(flux[a]));
      made += friction[a];
    }
    CHECK(made != 0.0 && fabs(sum(sides, N1 + N2) + made) <= ROUNDING * (fabs(sum(sides, N1)) + fabs(sum(sides + N1, N2))));

    /* The tangent against differences by temperatures and by a position. */
    CHECK_OK(stickslip_interface_heat_tangent_coo(s.interface, s.x1, s.x2, s.lambda, &heat, t1, t2, e1, e2, STICKSLIP_HEAT_ALL, 0,
                                                  NULL, NULL, NULL, &counted));
    CHECK_OK(stickslip_interface_heat_tangent_coo(s.interface, s.x1, s.x2, s.lambda, &heat, t1, t2, e1, e2, STICKSLIP_HEAT_ALL,
                                                  MOST_ENTRIES, rows, columns, values, &count));
    CHECK(count == counted && count > 0);
    memset(matrix, 0, sizeof matrix);
    double largest = 0.0;
    for (int64_t k = 0; k < count; ++k) {
      matrix[rows[k] - base - UNKNOWNS][columns[k] - base] += values[k];
      largest = fmax(largest, fabs(values[k]));
    }
    double *const of[] = {&s.x1[3 * 4 + 1], &s.x2[3 * 5], &s.lambda[3 * 4], &t1[4], &t2[5]};
    const int at[] = {3 * 4 + 1, X1 + 3 * 5, X1 + X2 + 3 * 4, UNKNOWNS + 4, UNKNOWNS + N1 + 5};
    for (int k = 0; k < 5; ++k) {
      const double there = *of[k];
      *of[k] = there + STEP;
      heat_of(&s, &heat, more);
      *of[k] = there - STEP;
      heat_of(&s, &heat, less);
      *of[k] = there;
      for (int i = 0; i < N1 + N2; ++i) {
        CHECK(fabs((more[i] - less[i]) / (2.0 * STEP) - matrix[i][at[k]]) <= DIFFERENCES * largest);
      }
    }
    /* Columns of temperatures alone; rows without an equation are left out. */
    int64_t alone = -1, fewer = -1;
    CHECK_OK(stickslip_interface_heat_tangent_coo(s.interface, s.x1, s.x2, s.lambda, &heat, t1, t2, e1, e2,
                                                  STICKSLIP_HEAT_TEMPERATURES, MOST_ENTRIES, rows, columns, values, &alone));
    CHECK(alone > 0 && alone < count);
    for (int64_t k = 0; k < alone; ++k) CHECK(values[k] == matrix[rows[k] - base - UNKNOWNS][columns[k] - base]);
    e1[4] = -1;
    CHECK_OK(stickslip_interface_heat_tangent_coo(s.interface, s.x1, s.x2, s.lambda, &heat, t1, t2, e1, e2,
                                                  STICKSLIP_HEAT_TEMPERATURES, 0, NULL, NULL, NULL, &fewer));
    CHECK(fewer < alone);
    CHECK_REFUSED(stickslip_interface_heat_tangent_coo(s.interface, s.x1, s.x2, s.lambda, &heat, t1, t2, e1, e2,
                                                       STICKSLIP_HEAT_TEMPERATURES, fewer - 1, rows, columns, values, &count),
                  STICKSLIP_BUFFER_TOO_SMALL, "capacity");

    /* Equal temperatures without friction: nothing. */
    stickslip_heat still = heat;
    still.time = 0.0;
    for (int a = 0; a < N1; ++a) t1[a] = 21.3;
    for (int c = 0; c < N2; ++c) t2[c] = 21.3;
    heat_of(&s, &still, sides);
    for (int k = 0; k < N1 + N2; ++k) CHECK(sides[k] == 0.0);

    /* A node alone says the same as the handle. */
    for (int c = 0; c < N2; ++c) t2[c] = 20.3;
    stickslip_heat constant = {.struct_size = sizeof constant, .constant = 3.0, .reach = 10.0};
    CHECK_OK(stickslip_interface_heat(s.interface, s.x1, s.x2, s.lambda, &constant, t1, t2, sides, sides + N1, &nodes));
    for (int a = 0; a < N1; ++a) {
      double both[2], slopes[2 * STICKSLIP_HEAT_SLOPES], h;
      if (area[a] == 0.0) continue;
      CHECK_OK(stickslip_node_heat(&constant, area[a], 0.0, 0.0, area[a], 0.0, both, slopes, &h));
      CHECK(h == 3.0 && both[0] == both[1] && fabs(both[0] - flux[a]) <= ROUNDING && slopes[0] == h / area[a]);
      CHECK_OK(stickslip_node_heat(&constant, area[a], 0.0, 0.0, area[a], 0.0, both, NULL, NULL));
    }
    scene_destroy(&s);
  }
  return 0;
}
