/* Systems without multipliers: a made-up host with a full matrix takes the step that the system with multipliers takes,
 * be its matrix condensed in place or in pieces, and gets the multipliers back; with carried nodes and without. The pattern
 * has all entries, carriers' weights add up to 1, and a node's own rows are those of the stateless stage. */
#include "scene.h"

enum { N = X1 + X2, FULL = N * N };

/* Steps of two factorisations of one system, relative to the largest entry: the system's condition times rounding. */
static const double SAME = 1e-12;
/* Sums of a few hundred products, relative to the largest entry. */
static const double ROUNDING = 1e-13;

static scene s;
static triplets t;
static double host[FULL], r[N], lambda[X1]; /* the host's own matrix and residual; the multipliers in force */

/* x = k^-1 r; k is spoilt. Gauss with row exchanges. */
static void solve(int n, double *k, const double *right, double *x) {
  memcpy(x, right, (size_t)n * sizeof *x);
  for (int c = 0; c < n; ++c) {
    int pivot = c;
    for (int i = c + 1; i < n; ++i) pivot = fabs(k[i * n + c]) > fabs(k[pivot * n + c]) ? i : pivot;
    CHECK(k[pivot * n + c] != 0.0);
    for (int j = 0; j < n; ++j) {
      const double kept = k[c * n + j];
      k[c * n + j] = k[pivot * n + j];
      k[pivot * n + j] = kept;
    }
    const double kept = x[c];
    x[c] = x[pivot];
    x[pivot] = kept;
    for (int i = c + 1; i < n; ++i) {
      const double factor = k[i * n + c] / k[c * n + c];
      if (factor == 0.0) continue;
      for (int j = c; j < n; ++j) k[i * n + j] -= factor * k[c * n + j];
      x[i] -= factor * x[c];
    }
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) x[i] -= k[i * n + j] * x[j];
    x[i] /= k[i * n + i];
  }
}

/* Worst difference, relative to the largest expected entry. */
static double difference(int n, const double *found, const double *expected) {
  double worst = 0.0;
  for (int k = 0; k < n; ++k) worst = larger(worst, fabs(found[k] - expected[k]));
  return worst / max_abs(expected, n);
}

/* Step, and multipliers after it, of the system with multipliers. */
static void with_multipliers(double du[N], double after[X1]) {
  static double k[UNKNOWNS * UNKNOWNS], right[UNKNOWNS], x[UNKNOWNS];
  memset(k, 0, sizeof k);
  for (int e = 0; e < FULL; ++e) k[e / N * UNKNOWNS + e % N] = host[e];
  scene_tangent(&s, &t);
  triplets_add(&t, 0, k);
  scene_residual(&s, right);
  for (int i = 0; i < N; ++i) right[i] += r[i];
  solve(UNKNOWNS, k, right, x);
  for (int i = 0; i < N; ++i) du[i] = -x[i];
  for (int i = 0; i < X1; ++i) after[i] = lambda[i] - x[N + i];
}

/* m += a piece of the condensed matrix. */
static void add_piece(int32_t piece, double *m) {
  int64_t counted;
  CHECK_OK(stickslip_interface_condensed_coo(s.interface, s.x1, s.x2, lambda, piece, 0, NULL, NULL, NULL, &counted));
  /* Forces at given multipliers do not move with the bodies where weights are frozen. */
  const int moving = piece != STICKSLIP_CONDENSED_FORCES || s.method.weights == STICKSLIP_WEIGHTS_CURRENT;
  CHECK((counted > 0) == moving && counted <= MOST_ENTRIES);
  CHECK_OK(stickslip_interface_condensed_coo(s.interface, s.x1, s.x2, lambda, piece, counted, t.rows, t.columns, t.values,
                                             &t.n));
  CHECK(t.n == counted);
  for (int64_t e = 0; e < t.n; ++e) {
    CHECK(0 <= t.rows[e] && t.rows[e] < N && 0 <= t.columns[e] && t.columns[e] < N);
    m[t.rows[e] * N + t.columns[e]] += t.values[e];
  }
}

/* k becomes the condensed matrix, in place. */
static void condense(double *k) {
  static int64_t offsets[N + 1], columns[FULL];
  for (int i = 0; i <= N; ++i) offsets[i] = i * N;
  for (int e = 0; e < FULL; ++e) columns[e] = e % N;
  CHECK_OK(stickslip_interface_condensed_csr(s.interface, s.x1, s.x2, lambda, N, offsets, columns, k));
}

/* Moves within a step; where `carried`, off the other surface's edge. The multipliers are those in force. */
static void set_up(int carried, int32_t weights) {
  uint64_t seed = 84;
  scene_init(&s);
  s.method.multiplier_basis = STICKSLIP_BASIS_DUAL;
  s.method.weak_coverage = carried ? 0.5 : STICKSLIP_WEAK_COVERAGE_NONE;
  s.method.weights = weights;
  scene_create(&s);
  if (carried) scene_slide(&s, 0.9);
  scene_commit(&s);
  scene_slide(&s, 0.02);
  for (int e = 0; e < FULL; ++e) host[e] = random_number(&seed) + (e % (N + 1) == 0 ? 20.0 : 0.0);
  for (int i = 0; i < N; ++i) r[i] = 0.05 * random_number(&seed);
  CHECK_OK(stickslip_interface_condensed_multipliers(s.interface, s.x1, s.x2, r, lambda));
  memcpy(s.lambda, lambda, sizeof lambda);
}

static void check_step(void) {
  static double in_place[FULL], l[FULL], j[FULL], pieces[FULL], k[FULL];
  double right[N], x[N], du[N], expected[N], after[X1], found[X1], moved[X1];
  with_multipliers(expected, after);

  memcpy(right, r, sizeof right);
  double force2[X2];
  /* The rows may take the place of the host's. */
  CHECK_OK(stickslip_interface_condensed_residual(s.interface, s.x1, s.x2, lambda, right, right, force2));
  for (int i = 0; i < X2; ++i) right[X1 + i] += force2[i];
  memcpy(in_place, host, sizeof host);
  condense(in_place);
  memcpy(k, in_place, sizeof k);
  solve(N, k, right, x);
  for (int i = 0; i < N; ++i) du[i] = -x[i];
  CHECK(difference(N, du, expected) <= SAME);

  memcpy(j, host, sizeof j);
  add_piece(STICKSLIP_CONDENSED_FORCES, j);
  memset(l, 0, sizeof l);
  add_piece(STICKSLIP_CONDENSED_ELIMINATION, l);
  memcpy(pieces, j, sizeof j);
  for (int e = 0; e < FULL; ++e) {
    for (int i = 0; l[e] != 0.0 && i < N; ++i) pieces[e / N * N + i] += l[e] * j[e % N * N + i];
  }
  add_piece(STICKSLIP_CONDENSED_CONSTRAINTS, pieces);
  CHECK(difference(FULL, pieces, in_place) <= ROUNDING);

  for (int i = 0; i < X1; ++i) {
    moved[i] = r[i];
    for (int c = 0; c < N; ++c) moved[i] += j[i * N + c] * du[c];
  }
  CHECK_OK(stickslip_interface_condensed_multipliers(s.interface, s.x1, s.x2, moved, found));
CHECK(difference(X1, found, after) <= SAME);
}

/* m becomes (I + e) m, or m (I + e). */
static void multiply(const double *e, double *m, int from_left) {
  static double before[FULL];
  memcpy(before, m, sizeof before);
  for (int k = 0; k < FULL; ++k) {
    const int row = k / N, column = k % N;
    if (e[k] == 0.0) continue;
    for (int i = 0; i < N; ++i) {
      if (from_left) m[row * N + i] += e[k] * before[column * N + i];
      else m[i * N + column] += e[k] * before[i * N + row];
    }
  }
}

/* The reduced form has the condensed system's step; with frozen weights its constraints are its diagonal's. */
static void check_reduction(int frozen) {
  static double matrix[FULL], rows[FULL], columns[FULL], q[FULL], diagonal[FULL], k[FULL], constraints[FULL];
  double right[N], force2[X2], x[N], v[N], reduced[N], expanded[N];
  memset(rows, 0, sizeof rows);
  memset(columns, 0, sizeof columns);
  memset(q, 0, sizeof q);
  memset(diagonal, 0, sizeof diagonal);
  add_piece(STICKSLIP_CONDENSED_REDUCTION_ROWS, rows);
  add_piece(STICKSLIP_CONDENSED_REDUCTION_COLUMNS, columns);
  add_piece(STICKSLIP_CONDENSED_CONSTRAINED, q);
  add_piece(STICKSLIP_CONDENSED_CONSTRAINT_DIAGONAL, diagonal);
  memcpy(right, r, sizeof right);
  CHECK_OK(stickslip_interface_condensed_residual(s.interface, s.x1, s.x2, lambda, right, right, force2));
  for (int i = 0; i < X2; ++i) right[X1 + i] += force2[i];
  memcpy(matrix, host, sizeof host);
  condense(matrix);
  memcpy(k, matrix, sizeof k);
  solve(N, k, right, x);
  multiply(rows, matrix, 1);
  multiply(columns, matrix, 0);
  for (int i = 0; i < N; ++i) {
    reduced[i] = right[i];
    for (int c = 0; c < N; ++c) reduced[i] += rows[i * N + c] * right[c];
  }
  memcpy(k, matrix, sizeof k);
  solve(N, k, reduced, v);
  for (int i = 0; i < N; ++i) {
    expanded[i] = v[i];
    for (int c = 0; c < N; ++c) expanded[i] += columns[i * N + c] * v[c];
  }
  CHECK(difference(N, expanded, x) <= SAME);
  if (!frozen) return;
  memset(constraints, 0, sizeof constraints);
  for (int e = 0; e < FULL; ++e) {
    for (int i = 0; q[e] != 0.0 && i < N; ++i) constraints[e / N * N + i] += q[e] * matrix[e % N * N + i];
  }
  CHECK(difference(FULL, constraints, diagonal) <= ROUNDING);
}

/* Each node is coupled to itself and to the one after the next. */
static int coupled(int i, int j) { return i / 3 == j / 3 || abs(i - j) == 6; }

/* A sparse host's condensed matrix has no entry that is neither its own nor in the pattern. */
static void check_pattern(void) {
  static int64_t offsets[N + 1], columns[FULL];
  static double k[FULL], values[FULL];
  static char known[FULL];
  int64_t count, n = 0;
  for (int e = 0; e < FULL; ++e) {
    known[e] = (char)coupled(e / N, e % N);
    k[e] = known[e] ? host[e] : 0.0;
    if (known[e]) columns[n] = e % N, values[n++] = k[e];
    offsets[e / N + 1] = n;
  }
  CHECK_REFUSED(stickslip_interface_condensed_csr(s.interface, s.x1, s.x2, lambda, N, offsets, columns, values),
                STICKSLIP_MISSING_ENTRY, "pattern");
  for (int64_t e = 0; e < n; ++e) CHECK(values[e] == 20.0 || fabs(values[e]) <= 21.0); /* nothing was changed */
  CHECK_OK(stickslip_interface_condensed_pattern(s.interface, s.x1, s.x2, N, offsets, columns, 0, NULL, NULL, &count));
  CHECK(0 < count && count <= MOST_ENTRIES);
  CHECK_OK(stickslip_interface_condensed_pattern(s.interface, s.x1, s.x2, N, offsets, columns, count, t.rows, t.columns,
                                                 &t.n));
  CHECK(t.n == count);
  for (int64_t e = 0; e < t.n; ++e) known[t.rows[e] * N + t.columns[e]] = 1;
  condense(k);
  int unknown = 0, all = 0;
  for (int e = 0; e < FULL; ++e) {
    unknown += k[e] != 0.0 && !known[e];
    all += known[e];
  }
  CHECK(unknown == 0 && all < FULL);
}

static void check_carriers(int carried) {
  double sum[N1] = {0};
  CHECK_OK(stickslip_interface_carriers(s.interface, 0, NULL, NULL, NULL, &t.n));
  CHECK((t.n > 0) == carried);
  CHECK_OK(stickslip_interface_carriers(s.interface, MOST_ENTRIES, t.rows, t.columns, t.values, &t.n));
  for (int64_t e = 0; e < t.n; ++e) sum[t.rows[e]] += t.values[e];
  for (int64_t e = 0; e < t.n; ++e) CHECK(sum[t.columns[e]] == 0.0 && (e == 0 || t.rows[e - 1] <= t.rows[e]));
  for (int a = 0; a < N1; ++a) CHECK(sum[a] == 0.0 || fabs(sum[a] - 1.0) <= ROUNDING);
}

/* The stateless stage, from the sums of this handle: W of every node, s c, s. */
static void check_nodes(void) {
  static double l[FULL];
  double sums[STICKSLIP_SUMS_PER_NODE * N1], normal[X1], augmentation[N1], rows1[X1], force2[X2];
  int32_t state[N1], seen[3] = {0};
  stickslip_states states = {.struct_size = sizeof states, .state = state, .normal = normal, .augmentation = augmentation};
  memset(l, 0, sizeof l);
  add_piece(STICKSLIP_CONDENSED_ELIMINATION, l);
  CHECK_OK(stickslip_interface_sums(s.interface, s.x1, s.x2, sums));
  CHECK_OK(stickslip_interface_states(s.interface, s.x1, s.x2, lambda, NULL, &states));
  CHECK_OK(stickslip_interface_condensed_residual(s.interface, s.x1, s.x2, lambda, r, rows1, force2));
  for (int a = 0; a < N1; ++a) {
    const double *of = sums + STICKSLIP_SUMS_PER_NODE * a;
    stickslip_node node = {.struct_size = sizeof node, .augmentation = augmentation[a], .mu = s.options.mu,
                           .coverage = of[0], .coverage_previous = of[4], .coverage_min = 1e-8};
    memcpy(node.lambda, lambda + 3 * a, sizeof node.lambda);
    memcpy(node.normal, normal + 3 * a, sizeof node.normal);
    memcpy(node.gap_now, of + 1, sizeof node.gap_now);
    memcpy(node.gap_previous, of + 5, sizeof node.gap_previous);
    memcpy(node.gap_committed, of + 8, sizeof node.gap_committed);
    stickslip_node_response response = {.struct_size = sizeof response};
    CHECK_OK(stickslip_node_respond(&node, &response));
    double w[9], columns[9], row[3], scale;
    CHECK_OK(stickslip_node_condense(&node, &response, STICKSLIP_LAYOUT_ROW_MAJOR, w, row, &scale));
    CHECK_OK(stickslip_node_condense(&node, &response, STICKSLIP_LAYOUT_COLUMN_MAJOR, columns, NULL, NULL));
    CHECK_NEAR(scale, augmentation[a] * of[0], ROUNDING * scale);
    for (int k = 0; k < 9; ++k) {
      const double expected = l[(3 * a + k / 3) * N + 3 * a + k % 3] + (k % 4 == 0);
      CHECK_NEAR(w[k], expected, ROUNDING);
      CHECK(columns[k] == w[k % 3 * 3 + k / 3]);
    }
    /* With the multipliers in force the forces' rows vanish, and the constraints remain. */
    for (int i = 0; i < 3; ++i) CHECK_NEAR(row[i], rows1[3 * a + i], ROUNDING);
    ++seen[state[a]];
    node.coverage = 0.0;
    CHECK_OK(stickslip_node_condense(&node, &response, STICKSLIP_LAYOUT_ROW_MAJOR, w, row, &scale));
    for (int k = 0; k < 9; ++k) CHECK(w[k] == (k % 4 == 0));
    CHECK(scale == 0.0 && row[0] == 0.0 && row[1] == 0.0 && row[2] == 0.0);
  }
  CHECK(seen[STICKSLIP_STATE_GAP] > 0 && seen[STICKSLIP_STATE_STICK] + seen[STICKSLIP_STATE_SLIP] > 0);
}

int main(void) {
  for (int carried = 0; carried < 2; ++carried) {
    for (int32_t weights = STICKSLIP_WEIGHTS_CURRENT; weights <= STICKSLIP_WEIGHTS_COMMITTED; ++weights) {
      set_up(carried, weights);
      check_step();
      check_reduction(weights == STICKSLIP_WEIGHTS_COMMITTED);
      check_pattern();
      check_carriers(carried);
      if (!carried && weights == STICKSLIP_WEIGHTS_CURRENT) check_nodes();
      scene_destroy(&s);
    }
  }
  return 0;
}
