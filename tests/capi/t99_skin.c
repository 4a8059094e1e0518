/* General contact: two cubes as one skin. Copies, sides, forces, the tangent against differences, steps and their undoing, restarts,
 * pairs that do not see each other, contact that was missed, lines; what is refused. */
#include "skin_scene.h"

/* Of sums of forces, over the sum of their sizes. */
static const double BALANCE = 1e-15;
static const double ROUNDING = 1e-14;
/* Central differences with this step, over the largest entry of a block: rounding 1e-16 / 1e-6, of a multiplier's rows less. */
static const double STEP = 1e-6, DIFFERENCES = 1e-7;

static skin_scene s;

/* What the skin says of its facets. */
static int32_t side[SKIN_FACETS];
static int64_t piece[SKIN_FACETS], partner[SKIN_FACETS], body[SKIN_FACETS];
static double distance[SKIN_FACETS];

static void ask_facets(void) {
  const stickslip_skin_sides out = {.struct_size = sizeof out, .side = side, .piece = piece, .partner = partner,
                                    .distance = distance, .body = body};
  CHECK_OK(stickslip_skin_facets(s.skin, &out));
}

static stickslip_skin_summary report(void) {
  stickslip_skin_summary out = {.struct_size = sizeof out};
  CHECK_OK(stickslip_skin_report(s.skin, &out));
  return out;
}

/* The node that a copy is of, and whether the facet has the copy: one that is of this node and no copy of another face. */
static int64_t originals[SKIN_COPIES], equations[SKIN_LAMBDA];

static void ask_copies(void) {
  int64_t count = -1, multipliers = -1;
  CHECK_OK(stickslip_skin_copies(s.skin, 0, NULL, NULL, &count, &multipliers));
  CHECK(count == SKIN_COPIES && multipliers == SKIN_LAMBDA);
  CHECK_OK(stickslip_skin_copies(s.skin, count, originals, equations, &count, &multipliers));
  CHECK(count == SKIN_COPIES && multipliers == SKIN_LAMBDA);
}

static void check_found(int64_t base) {
  skin_init_base(&s, base);
  skin_create(&s);
  ask_copies();
  int times[SKIN_NODES] = {0};
  for (int a = 0; a < SKIN_COPIES; ++a) {
    CHECK(a >= SKIN_NODES || originals[a] == base + a);
    CHECK(base <= originals[a] && originals[a] < base + SKIN_NODES);
    ++times[originals[a] - base];
    for (int i = 0; i < 3; ++i) CHECK(equations[3 * a + i] == base + SKIN_X + 3 * a + i);
  }
  for (int a = 0; a < SKIN_NODES; ++a) CHECK(times[a] == 3);
  CHECK_REFUSED(stickslip_skin_copies(s.skin, SKIN_COPIES - 1, originals, equations, &(int64_t){0}, &(int64_t){0}),
                STICKSLIP_BUFFER_TOO_SMALL, "copies");
  ask_facets();
  for (int f = 0; f < SKIN_FACETS; ++f) {
    const int touches = f == LOWER_TOP || f == UPPER_BOTTOM;
    CHECK((side[f] != STICKSLIP_SKIN_NONE) == touches);
    CHECK(piece[f] == (side[f] == STICKSLIP_SKIN_NONMORTAR ? 0 : -1));
    CHECK(partner[f] == (touches ? base + (f == LOWER_TOP ? UPPER_BOTTOM : LOWER_TOP) : -1));
    CHECK_NEAR(distance[f], touches ? -SKIN_OVERLAP : 0.0, ROUNDING);
    CHECK(body[f] == s.bodies[f]);
  }
  CHECK(side[LOWER_TOP] != side[UPPER_BOTTOM]);
  /* Nothing is wanted. */
  CHECK_OK(stickslip_skin_facets(s.skin, &(stickslip_skin_sides){.struct_size = sizeof(stickslip_skin_sides)}));
  const stickslip_skin_summary now = report();
  CHECK(now.bodies == 2 && now.pieces == 1 && now.pairs == 1 && now.contradictions == 0);
  CHECK(now.made == 1 && now.exchanged == 0 && now.missed == 0);
  skin_destroy(&s);
  /* What hangs together is one body, numbered from 0. */
  CHECK_OK(stickslip_skin_create(&s.surface, NULL, s.first_multiplier, &s.options, &s.skin));
  ask_facets();
  for (int f = 0; f < SKIN_FACETS; ++f) CHECK(body[f] == f / CUBE_FACETS);
  skin_destroy(&s);
  CHECK_OK(stickslip_skin_destroy(&s.skin));
  CHECK_OK(stickslip_skin_destroy(NULL));
}

/* Forces sum up to nothing, and there are some; copies that touch nothing say that their multipliers are zero. */
static void check_balance(void) {
  double r[SKIN_UNKNOWNS], sum[3] = {0}, size = 0.0;
  stickslip_states states = {.struct_size = sizeof states};
  int32_t state[SKIN_COPIES];
  double coverage[SKIN_COPIES], normal[SKIN_LAMBDA], traction[SKIN_LAMBDA], area[SKIN_COPIES];
  states.state = state, states.coverage = coverage, states.normal = normal, states.traction = traction, states.area = area;
  skin_init_base(&s, 0);
  skin_create(&s);
  skin_residual(&s, r);
  for (int k = 0; k < SKIN_X; ++k) {
    sum[k % 3] += r[k];
    size += fabs(r[k]);
  }
  CHECK(size > 0.1);
  for (int i = 0; i < 3; ++i) CHECK_NEAR(sum[i], 0.0, BALANCE * size);
  CHECK_OK(stickslip_skin_states(s.skin, s.x, s.lambda, &states));
  int covered = 0, closed = 0;
  for (int a = 0; a < SKIN_COPIES; ++a) {
    covered += coverage[a] > 0.0;
    closed += state[a] != STICKSLIP_STATE_GAP;
    if (area[a] > 0.0) {
      CHECK_NEAR(normal[3 * a] * normal[3 * a] + normal[3 * a + 1] * normal[3 * a + 1] + normal[3 * a + 2] * normal[3 * a + 2],
                 1.0, ROUNDING);
      continue;
    }
    CHECK(state[a] == STICKSLIP_STATE_GAP && coverage[a] == 0.0 && max_abs(normal + 3 * a, 3) == 0.0);
    /* A quarter of one facet each. */
    for (int k = 3 * a; k < 3 * a + 3; ++k) CHECK_NEAR(r[SKIN_X + k], -0.25 * s.lambda[k], ROUNDING);
  }
  CHECK(covered == 4 && closed > 0);
  CHECK_OK(stickslip_skin_states(s.skin, s.x, s.lambda, &(stickslip_states){.struct_size = sizeof(stickslip_states)}));
  skin_destroy(&s);
}

static double k[SKIN_UNKNOWNS][SKIN_UNKNOWNS], d[SKIN_UNKNOWNS][SKIN_UNKNOWNS], values[SKIN_PLAN];
static int64_t rows[SKIN_PLAN], columns[SKIN_PLAN];
static int32_t rows32[SKIN_PLAN], columns32[SKIN_PLAN];

/* The tangent by a plan; entries of the same row and column add up. */
static void tangent(int32_t pairs, int64_t base) {
  int64_t count = -1;
  CHECK_OK(stickslip_skin_plan(s.skin, s.x, pairs, &count));
  CHECK(0 < count && count <= SKIN_PLAN);
  CHECK_OK(stickslip_skin_plan_coo(s.skin, count, rows, columns));
  CHECK_OK(stickslip_skin_plan_coo32(s.skin, count, rows32, columns32));
  CHECK_OK(stickslip_skin_plan_values(s.skin, s.x, s.lambda, count, values));
  CHECK_REFUSED(stickslip_skin_plan_coo(s.skin, count - 1, rows, columns), STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  CHECK_REFUSED(stickslip_skin_plan_coo32(s.skin, count - 1, rows32, columns32), STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  CHECK_REFUSED(stickslip_skin_plan_values(s.skin, s.x, s.lambda, count - 1, values), STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  memset(k, 0, sizeof k);
  for (int64_t e = 0; e < count; ++e) {
    const int64_t i = rows[e] - base, j = columns[e] - base;
    CHECK(rows32[e] == rows[e] && columns32[e] == columns[e]);
    CHECK(0 <= i && i < SKIN_UNKNOWNS && 0 <= j && j < SKIN_UNKNOWNS);
    k[i][j] += values[e];
  }
}

static void differences(void) {
  double plus[SKIN_UNKNOWNS], minus[SKIN_UNKNOWNS];
  for (int j = 0; j < SKIN_UNKNOWNS; ++j) {
    double *x = j < SKIN_X ? s.x + j : s.lambda + j - SKIN_X;
    const double kept = *x;
    *x = kept + STEP;
    skin_residual(&s, plus);
    *x = kept - STEP;
    skin_residual(&s, minus);
    *x = kept;
    for (int i = 0; i < SKIN_UNKNOWNS; ++i) d[i][j] = (plus[i] - minus[i]) / (2.0 * STEP);
  }
}

static void check_tangent(int64_t base, int32_t pairs) {
  const int ends[3] = {0, SKIN_X, SKIN_UNKNOWNS};
  skin_init_base(&s, base);
  skin_create(&s);
  CHECK_OK(stickslip_skin_commit(s.skin, s.reference, s.lambda));
  differences();
  tangent(pairs, base);
  for (int p = 0; p < 2; ++p) {
    for (int q = 0; q < 2; ++q) {
      double largest = 0.0, error = 0.0;
      for (int i = ends[p]; i < ends[p + 1]; ++i) {
        for (int j = ends[q]; j < ends[q + 1]; ++j) {
          largest = larger(largest, fabs(d[i][j]));
          error = larger(error, fabs(k[i][j] - d[i][j]));
        }
      }
      CHECK(largest > 1e-3);
      CHECK_NEAR(error / largest, 0.0, DIFFERENCES);
    }
  }
  skin_destroy(&s);
}

/* A commit, its undoing, an export and its import leave the bits of histories and of residuals. */
static void check_steps(void) {
  static history first, second, now;
  static double before[SKIN_UNKNOWNS], after[SKIN_UNKNOWNS], again[SKIN_UNKNOWNS];
  double lambda[SKIN_LAMBDA], kept[SKIN_LAMBDA];
  int64_t count;
  skin_init_base(&s, 0);
  skin_create(&s);
  CHECK_OK(stickslip_skin_initial_multipliers(s.skin, s.lambda));
  int pressed = 0;
  for (int a = 0; a < SKIN_COPIES; ++a) pressed += max_abs(s.lambda + 3 * a, 3) > 0.0;
  CHECK(0 < pressed && pressed <= 4);
  CHECK_REFUSED(stickslip_skin_rollback(s.skin), STICKSLIP_NOTHING_TO_ROLL_BACK, "no commit can be undone");
  CHECK_OK(stickslip_skin_commit(s.skin, s.reference, s.lambda));
  CHECK_REFUSED(stickslip_skin_initial_multipliers(s.skin, lambda), STICKSLIP_INVALID_VALUE, "commit");
  skin_history(s.skin, &first);
  skin_residual(&s, before);

  /* What cannot be closed has no multiplier any more; the rest stays. */
  for (int i = 0; i < SKIN_LAMBDA; ++i) kept[i] = s.lambda[i];
  s.lambda[3 * SKIN_COPIES - 1] += 1.0;
  s.lambda[0] += 1.0;
  CHECK_OK(stickslip_skin_commit(s.skin, s.x, s.lambda));
  CHECK(memcmp(kept, s.lambda, sizeof kept) == 0);
  skin_history(s.skin, &second);
  CHECK(!history_equal(&first, &second));
  skin_move(s.x, 2e-3, 1e-3, -1e-4);
  skin_residual(&s, after);

  CHECK_OK(stickslip_skin_rollback(s.skin));
  skin_history(s.skin, &now);
  CHECK(history_equal(&first, &now));
  CHECK_REFUSED(stickslip_skin_rollback(s.skin), STICKSLIP_NOTHING_TO_ROLL_BACK, "no commit can be undone");
  CHECK_REFUSED(stickslip_skin_plan_values(s.skin, s.x, s.lambda, SKIN_PLAN, values), STICKSLIP_MISSING_ENTRY, "plan");
  skin_residual(&s, again);
  CHECK(memcmp(after, again, sizeof after) != 0);
  skin_move(s.x, -2e-3, -1e-3, 1e-4);

  /* The other sides, and back: the first ones. */
  stickslip_skin_sides sides = {.struct_size = sizeof sides};
  int32_t first_side[SKIN_FACETS], other_side[SKIN_FACETS];
  sides.side = first_side;
  CHECK_OK(stickslip_skin_facets(s.skin, &sides));
  sides.side = other_side;
  for (int back = 0; back < 2; ++back) {
    CHECK_OK(stickslip_skin_exchange(s.skin, s.lambda));
    CHECK_OK(stickslip_skin_facets(s.skin, &sides));
    for (int f = 0; f < SKIN_FACETS; ++f) {
      CHECK(other_side[f] == (back || first_side[f] == STICKSLIP_SKIN_NONE
                                  ? first_side[f]
                                  : STICKSLIP_SKIN_NONMORTAR + STICKSLIP_SKIN_MORTAR - first_side[f]));
    }
  }

  /* Into a fresh handle, and into the same. */
  for (int fresh = 0; fresh < 2; ++fresh) {
    if (fresh) {
      skin_destroy(&s);
      skin_create(&s);
    }
    CHECK_OK(stickslip_skin_history_import(s.skin, second.n_integers, second.integers, second.n_reals, second.reals));
    skin_history(s.skin, &now);
    CHECK(history_equal(&second, &now));
    CHECK_REFUSED(stickslip_skin_rollback(s.skin), STICKSLIP_NOTHING_TO_ROLL_BACK, "no commit can be undone");
    skin_move(s.x, 2e-3, 1e-3, -1e-4);
    skin_residual(&s, again);
    skin_move(s.x, -2e-3, -1e-3, 1e-4);
    for (int i = 0; i < SKIN_UNKNOWNS; ++i) CHECK_NEAR(again[i], after[i], ROUNDING);
  }
  CHECK_OK(stickslip_skin_plan(s.skin, s.x, STICKSLIP_PLAN_ACTIVE, &count));
  CHECK_REFUSED(stickslip_skin_history_export(s.skin, second.n_integers - 1, now.integers, second.n_reals, now.reals),
                STICKSLIP_BUFFER_TOO_SMALL, "n_integers");
  CHECK_REFUSED(stickslip_skin_history_export(s.skin, second.n_integers, now.integers, second.n_reals - 1, now.reals),
                STICKSLIP_BUFFER_TOO_SMALL, "n_reals");
  now = second;
  now.reals[0] += 1.0;
  CHECK_REFUSED(stickslip_skin_history_import(s.skin, now.n_integers, now.integers, now.n_reals, now.reals),
                STICKSLIP_HISTORY_MISMATCH, "changed");
  CHECK_REFUSED(stickslip_skin_history_import(s.skin, 3, now.integers, now.n_reals, now.reals), STICKSLIP_HISTORY_MISMATCH,
                "history");
  /* That of an interface is not a skin's. */
  static scene other;
  scene_init(&other);
  scene_create(&other);
  history_take(other.interface, &now);
  CHECK_REFUSED(stickslip_skin_history_import(s.skin, now.n_integers, now.integers, now.n_reals, now.reals),
                STICKSLIP_HISTORY_MISMATCH, "not a skin's");
  scene_destroy(&other);
  skin_history(s.skin, &now);
  CHECK(history_equal(&second, &now));
  skin_destroy(&s);
}

/* Two bodies that do not see each other have nothing between them, until something else is said. */
static void check_pairs(void) {
  double r[SKIN_UNKNOWNS], first[SKIN_UNKNOWNS], slippery[SKIN_UNKNOWNS];
  skin_init_base(&s, 0);
  skin_create(&s);
  skin_residual(&s, first);
  CHECK_OK(stickslip_skin_set_pair(s.skin, UPPER_BODY, LOWER_BODY, STICKSLIP_SKIN_APART));
  skin_residual(&s, r);
  CHECK(max_abs(r, SKIN_X) == 0.0 && report().pieces == 0 && report().pairs == 0);
  ask_facets();
  for (int f = 0; f < SKIN_FACETS; ++f) CHECK(side[f] == STICKSLIP_SKIN_NONE && partner[f] == -1);
  CHECK_OK(stickslip_skin_set_pair(s.skin, LOWER_BODY, LOWER_BODY, 0.1));
  skin_residual(&s, r);
  CHECK(max_abs(r, SKIN_X) == 0.0);
  CHECK_OK(stickslip_skin_set_pair(s.skin, LOWER_BODY, UPPER_BODY, s.options.mu));
  skin_residual(&s, r);
  CHECK(memcmp(r, first, sizeof r) == 0);
  /* After a commit, so that what is in contact has friction. */
  CHECK_OK(stickslip_skin_commit(s.skin, s.reference, s.lambda));
  skin_residual(&s, first);
  CHECK_OK(stickslip_skin_set_pair(s.skin, LOWER_BODY, UPPER_BODY, 0.0));
  skin_residual(&s, slippery);
  CHECK(memcmp(first, slippery, sizeof first) != 0);
  CHECK_REFUSED(stickslip_skin_set_pair(s.skin, 0, UPPER_BODY, 0.1), STICKSLIP_INVALID_VALUE, "body1 is 0");
  CHECK_REFUSED(stickslip_skin_set_pair(s.skin, UPPER_BODY, 3, 0.1), STICKSLIP_INVALID_VALUE, "body2 is 3");
  CHECK_REFUSED(stickslip_skin_set_pair(s.skin, UPPER_BODY, LOWER_BODY, -0.5), STICKSLIP_INVALID_VALUE, "mu is -0.5");
  CHECK_REFUSED(stickslip_skin_set_pair(s.skin, UPPER_BODY, LOWER_BODY, NAN), STICKSLIP_NOT_FINITE, "mu");
  skin_residual(&s, r);
  CHECK(memcmp(r, slippery, sizeof r) == 0);
  skin_destroy(&s);
}

/* What goes with steps: how far one may go, how multipliers turn with the bodies, directions, the distance from equilibrium. */
static void check_aids(void) {
  double axis[3] = {0.6, -0.8, 0.0}; /* in the surfaces: the smallest turn of the normals is that of the bodies */
  double dx[SKIN_X] = {0}, fraction = -1.0, turned[SKIN_LAMBDA], r[SKIN_UNKNOWNS], with[SKIN_UNKNOWNS], across[6] = {1, 0, 0, 1, 0, 0};
  int64_t fixed[2] = {5, CUBE_NODES}; /* one of either side; the first one sticks */
  skin_init_base(&s, 0);
  skin_create(&s);
  CHECK_OK(stickslip_skin_step_limit(s.skin, s.x, dx, 0.0, &fraction));
  CHECK(fraction == 1.0);
  skin_move(dx, 0.0, 0.0, -2.0);
  CHECK_OK(stickslip_skin_step_limit(s.skin, s.x, dx, 0.5, &fraction));
  CHECK(0.0 < fraction && fraction < 1.0);
  CHECK_REFUSED(stickslip_skin_step_limit(s.skin, s.x, dx, 1.5, &fraction), STICKSLIP_INVALID_VALUE, "penetration");

  /* Multipliers of what may touch turn with the bodies; the others stay. */
  CHECK_OK(stickslip_skin_commit(s.skin, s.reference, s.lambda));
  memcpy(turned, s.lambda, sizeof turned);
  memcpy(s.x, s.reference, sizeof s.x);
  scene_frame(axis);
  for (int a = 0; a < SKIN_NODES; ++a) scene_turn(s.x + 3 * a, axis, 0.1);
  CHECK_OK(stickslip_skin_turn_multipliers(s.skin, s.x, turned));
  double area[SKIN_COPIES];
  const stickslip_states states = {.struct_size = sizeof states, .area = area};
  CHECK_OK(stickslip_skin_states(s.skin, s.x, s.lambda, &states));
  int turning = 0;
  for (int a = 0; a < SKIN_COPIES; ++a) {
    double l[3];
    memcpy(l, s.lambda + 3 * a, sizeof l);
    if (area[a] > 0.0) scene_turn(l, axis, 0.1), ++turning;
    for (int i = 0; i < 3; ++i) CHECK_NEAR(turned[3 * a + i], l[i], ROUNDING);
  }
  CHECK(turning == 4);

  CHECK_OK(stickslip_skin_use_normals(s.skin, STICKSLIP_NORMALS_COMMITTED));
  skin_residual(&s, r);
  CHECK_REFUSED(stickslip_skin_commit(s.skin, s.x, s.lambda), STICKSLIP_INVALID_VALUE, "normals");
  CHECK_OK(stickslip_skin_use_normals(s.skin, STICKSLIP_NORMALS_CURRENT));
  skin_residual(&s, with);
  CHECK(memcmp(r, with, sizeof r) != 0);
  CHECK_REFUSED(stickslip_skin_use_normals(s.skin, STICKSLIP_NORMALS_AUTO), STICKSLIP_INVALID_VALUE, "normals");
  CHECK_REFUSED(stickslip_skin_use_normals(s.skin, 7), STICKSLIP_INVALID_VALUE, "normals");

  for (int n = 0; n < 2; ++n) scene_frame(across + 3 * n);
  skin_residual(&s, r);
  CHECK_OK(stickslip_skin_set_constraints(s.skin, 2, fixed, across));
  skin_residual(&s, with);
  CHECK(memcmp(r, with, sizeof r) != 0);
  CHECK_OK(stickslip_skin_set_constraints(s.skin, 0, NULL, NULL));
  skin_residual(&s, with);
  CHECK(memcmp(r, with, sizeof r) == 0);
  fixed[1] = SKIN_NODES;
  CHECK_REFUSED(stickslip_skin_set_constraints(s.skin, 2, fixed, across), STICKSLIP_INDEX_OUT_OF_RANGE, "nodes[1] is 16");
  /* A copy whose normal is prescribed has no multiplier. */
  for (int n = 0; n < 2; ++n) {
    across[3 * n] = across[3 * n + 1] = 0.0, across[3 * n + 2] = 1.0;
    scene_frame(across + 3 * n);
  }
  fixed[1] = CUBE_NODES;
  CHECK_OK(stickslip_skin_set_constraints(s.skin, 2, fixed, across));
  skin_residual(&s, with);
  CHECK(memcmp(r, with, sizeof r) != 0);
  CHECK_OK(stickslip_skin_set_constraints(s.skin, 0, NULL, NULL));
  skin_residual(&s, with);
  CHECK(memcmp(r, with, sizeof r) == 0);
  /* What is refused has changed nothing, now or at a commit. */
  across[3] = across[4] = across[5] = 0.0;
  CHECK_REFUSED(stickslip_skin_set_constraints(s.skin, 2, fixed, across), STICKSLIP_INVALID_VALUE, "constraint 1 has length 0");
  CHECK_OK(stickslip_skin_set_pair(s.skin, LOWER_BODY, UPPER_BODY, STICKSLIP_SKIN_APART));
  across[0] = NAN;
  CHECK_REFUSED(stickslip_skin_set_constraints(s.skin, 2, fixed, across), STICKSLIP_NOT_FINITE, "directions[0]");
  across[0] = across[1] = across[2] = 0.0;
  CHECK_REFUSED(stickslip_skin_set_constraints(s.skin, 2, fixed, across), STICKSLIP_INVALID_VALUE, "constraint 0 has length 0");
  CHECK_OK(stickslip_skin_set_pair(s.skin, LOWER_BODY, UPPER_BODY, s.options.mu));

  stickslip_equilibrium e = {.struct_size = sizeof e, .modulus = s.options.modulus};
  CHECK_OK(stickslip_skin_equilibrium(s.skin, s.reference, s.lambda, &e));
  CHECK_NEAR(e.gap, SKIN_OVERLAP, 1e-12); /* a gap over an area that is summed up by parts */
  ask_copies();
  ask_facets();
  /* The node is a copy, of the non-mortar facet. */
  CHECK(0 <= e.gap_node && e.gap_node < SKIN_COPIES);
  CHECK((originals[e.gap_node] < CUBE_NODES) == (side[LOWER_TOP] == STICKSLIP_SKIN_NONMORTAR));
  skin_destroy(&s);
}

/* A cube that falls into the other one from where nothing has looked for it. */
static void check_missed(void) {
  static history before, after;
  double r[SKIN_UNKNOWNS];
  skin_init_base(&s, 0);
  skin_move(s.reference, 0.0, 0.0, 3.0);
  skin_create(&s);
  memset(s.lambda, 0, sizeof s.lambda);
  CHECK(report().pieces == 0);
  CHECK_OK(stickslip_skin_commit(s.skin, s.reference, s.lambda));
  skin_history(s.skin, &before);
  skin_move(s.x, 0.0, 0.0, -0.1);
  skin_residual(&s, r);
  CHECK(max_abs(r, SKIN_X) == 0.0);
  CHECK_REFUSED(stickslip_skin_commit(s.skin, s.x, s.lambda), STICKSLIP_CONTACT_LOST, "facets 1 and 6");
  /* The same step is solved with what has been missed. */
  CHECK(report().missed == 1 && report().pieces == 1);
  skin_residual(&s, r);
  CHECK(max_abs(r, SKIN_UNKNOWNS) > 0.0);
  CHECK_OK(stickslip_skin_commit(s.skin, s.x, s.lambda));
  CHECK(report().missed == 1);
  CHECK_OK(stickslip_skin_rollback(s.skin));
  skin_history(s.skin, &after);
  CHECK(after.integers[4] == before.integers[4]); /* as many commits */
  skin_destroy(&s);
}

/* Two squares of four lines each in a plane model: two copies of each corner. */
static void check_lines(void) {
  enum { NODES = 8, COPIES = 16 };
  static const double corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  double x[2 * NODES], force[2 * NODES], lines[2 * COPIES], lambda[2 * COPIES] = {0}, sum[2] = {0}, size = 0.0;
  int64_t offsets[NODES + 1] = {0}, nodes[2 * NODES], displacements[2 * NODES], count, multipliers;
  stickslip_skin *skin = NULL;
  stickslip_options options;
  for (int a = 0; a < NODES; ++a) {
    const int next = a / 4 * 4 + (a + 1) % 4;
    x[2 * a] = corners[a % 4][0] + (a < 4 ? 0.0 : 0.3);
    x[2 * a + 1] = corners[a % 4][1] + (a < 4 ? 0.0 : 1.0 - SKIN_OVERLAP);
    /* The direction, turned from x towards y, points into the body. */
    nodes[2 * a] = a, nodes[2 * a + 1] = next;
    offsets[a + 1] = 2 * (a + 1);
    displacements[2 * a] = 2 * a, displacements[2 * a + 1] = 2 * a + 1;
  }
  CHECK_OK(stickslip_options_init(&options, sizeof options));
  options.model = STICKSLIP_MODEL_PLANE;
  options.modulus = 100.0;
  const stickslip_surface surface = {.struct_size = sizeof surface, .n_nodes = NODES, .n_facets = NODES, .coordinates = x,
                                     .facet_offsets = offsets, .facet_nodes = nodes, .equations = displacements};
  CHECK_OK(stickslip_skin_create(&surface, NULL, 2 * NODES, &options, &skin));
  CHECK_OK(stickslip_skin_copies(skin, 0, NULL, NULL, &count, &multipliers));
  CHECK(count == COPIES && multipliers == 2 * COPIES);
  CHECK_OK(stickslip_skin_initial_multipliers(skin, lambda));
  CHECK_OK(stickslip_skin_residual(skin, x, lambda, force, lines));
  for (int i = 0; i < 2 * NODES; ++i) {
    sum[i % 2] += force[i];
    size += fabs(force[i]);
  }
  CHECK(size > 0.0);
  for (int i = 0; i < 2; ++i) CHECK_NEAR(sum[i], 0.0, BALANCE * size);
  CHECK_OK(stickslip_skin_destroy(&skin));
}

#define CREATE() stickslip_skin_create(&s.surface, s.bodies, s.first_multiplier, &s.options, &skin)
static void check_refusals(void) {
  stickslip_skin *skin;
  double r[SKIN_UNKNOWNS], x[SKIN_X];
  FILL(skin);
  skin_init_base(&s, 0);
  CHECK_REFUSED(stickslip_skin_create(NULL, s.bodies, s.first_multiplier, &s.options, &skin), STICKSLIP_NULL_POINTER, "surface");
  s.options.friction = STICKSLIP_FRICTION_TIED, s.options.mu = 0.0;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "tie surfaces");
  s.options.friction = STICKSLIP_FRICTION_COULOMB;
  s.options.mortar_side = STICKSLIP_MORTAR_RIGID;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "options.mortar_side");
  s.options.mortar_side = STICKSLIP_MORTAR_ANALYTIC;
  CHECK_REFUSED(CREATE(), STICKSLIP_UNSUPPORTED, "options.mortar_side");
  s.options.mortar_side = STICKSLIP_MORTAR_DEFORMABLE;
  s.surface.multiplier_equations = s.equations;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "surface.multiplier_equations");
  s.surface.multiplier_equations = NULL;
  s.options.modulus = 0.0;
  CHECK_REFUSED(CREATE(), STICKSLIP_MISSING_STIFFNESS, "modulus");
  s.options.modulus = 100.0;
  s.first_multiplier = SKIN_X - 1;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "47 is that of a displacement");
  s.first_multiplier = -1;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "first_multiplier");
  s.first_multiplier = INT64_MAX;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "first_multiplier");
  s.first_multiplier = SKIN_X;
  s.nodes[5] = SKIN_NODES;
  CHECK_REFUSED(CREATE(), STICKSLIP_INDEX_OUT_OF_RANGE, "skin: facet 1 names node 16");
  s.nodes[5] = s.nodes[4];
  CHECK_REFUSED(CREATE(), STICKSLIP_DUPLICATE_NODE, "skin: facet 1");
  CHECK_UNTOUCHED(skin);
  skin_init_base(&s, 0);
  skin_create(&s);
  FILL(r);
  memcpy(x, s.x, sizeof x);
  x[4] = NAN;
  CHECK_REFUSED(stickslip_skin_residual(s.skin, x, s.lambda, r, r + SKIN_X), STICKSLIP_NOT_FINITE, "x");
  CHECK_REFUSED(stickslip_skin_residual(NULL, x, s.lambda, r, r + SKIN_X), STICKSLIP_NULL_POINTER, "skin");
  CHECK_REFUSED(stickslip_skin_plan_values(s.skin, s.x, s.lambda, SKIN_PLAN, r), STICKSLIP_MISSING_ENTRY, "plan");
  CHECK_REFUSED(stickslip_skin_plan_coo(s.skin, SKIN_PLAN, rows, columns), STICKSLIP_MISSING_ENTRY, "plan");
  CHECK_REFUSED(stickslip_skin_plan(s.skin, s.x, STICKSLIP_PLAN_ACTIVE_SUMS, rows), STICKSLIP_INVALID_VALUE, "pairs");
  CHECK_UNTOUCHED(r);
  skin_destroy(&s);
}

int main(void) {
  for (int64_t base = 0; base < 2; ++base) {
    check_found(base);
    check_tangent(base, STICKSLIP_PLAN_ACTIVE);
    check_tangent(base, STICKSLIP_PLAN_SKIN);
  }
  check_balance();
  check_steps();
  check_pairs();
  check_aids();
  check_missed();
  check_lines();
  check_refusals();
  return 0;
}
