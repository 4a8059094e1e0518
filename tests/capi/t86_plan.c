/* Plans of the tangent: their entries are those of the triplets, in 32 and 64 bits, as triplets and as compressed rows, and
 * so are the values, which are overwritten; with sums; for how long a plan suffices, and what refuses it afterwards. Those of
 * a system without multipliers hold the sums of its pieces. */
#include "scene.h"

enum { MOST = UNKNOWNS * UNKNOWNS };

static scene s;
static triplets t;
static int64_t rows[MOST], columns[MOST], row_list[UNKNOWNS], offsets[UNKNOWNS + 1], csr_columns[MOST];
static int32_t rows32[MOST], columns32[MOST], row_list32[UNKNOWNS], offsets32[UNKNOWNS + 1], csr_columns32[MOST];
static double values[MOST], constraints[MOST], k[MOST], expected[MOST];

/* The plan, its number of entries and, where asked for, of its rows. */
static int64_t plan(int32_t pairs, int64_t *n_rows) {
  int64_t n, count;
  CHECK_OK(stickslip_interface_plan(s.interface, s.x1, s.x2, pairs, &n, &count));
  CHECK(0 < n && n <= UNKNOWNS && n <= count && count <= MOST);
  if (n_rows) *n_rows = n;
  return count;
}

static int32_t fill(const double *sums, int64_t count) {
  for (int e = 0; e < MOST; ++e) values[e] = NAN;
  return stickslip_interface_plan_values(s.interface, s.x1, s.x2, s.lambda, sums, count, values);
}

/* Counted from the base: entries as triplets, ascending and each once, and the same as rows, in 32 bits and 64. */
static void check_entries(int32_t entries, int64_t n_rows, int64_t count) {
  const int64_t base = s.options.index_base;
  CHECK_OK(stickslip_interface_plan_coo(s.interface, entries, count, rows, columns));
  for (int64_t e = 0; e < count; ++e) {
    CHECK(base <= rows[e] && rows[e] < base + UNKNOWNS && base <= columns[e] && columns[e] < base + UNKNOWNS);
    CHECK(e == 0 || rows[e - 1] < rows[e] || (rows[e - 1] == rows[e] && columns[e - 1] < columns[e]));
  }
  CHECK_OK(stickslip_interface_plan_csr(s.interface, entries, count, row_list, offsets, csr_columns));
  CHECK(offsets[0] == base && offsets[n_rows] == base + count);
  for (int64_t i = 0; i < n_rows; ++i) {
    CHECK(offsets[i] < offsets[i + 1] && (i == 0 || row_list[i - 1] < row_list[i]));
    for (int64_t e = offsets[i] - base; e < offsets[i + 1] - base; ++e) CHECK(rows[e] == row_list[i]);
  }
  CHECK(memcmp(columns, csr_columns, (size_t)count * sizeof *columns) == 0);
  CHECK_OK(stickslip_interface_plan_coo32(s.interface, entries, count, rows32, columns32));
  CHECK_OK(stickslip_interface_plan_csr32(s.interface, entries, count, row_list32, offsets32, csr_columns32));
  for (int64_t e = 0; e < count; ++e) {
    CHECK(rows32[e] == rows[e] && columns32[e] == columns[e] && csr_columns32[e] == columns[e]);
  }
  for (int64_t i = 0; i < n_rows; ++i) CHECK(row_list32[i] == row_list[i]);
  for (int64_t i = 0; i <= n_rows; ++i) CHECK(offsets32[i] == offsets[i]);
}

/* `shared`: some nodes have equations of others. */
static void set_up(int64_t base, int32_t form, int32_t weights, int shared) {
  scene_init_base(&s, base);
  s.method.form = form;
  s.method.weights = weights;
  for (int i = 0; i < 3 && shared; ++i) {
    s.equations1[12 + i] = s.equations1[i];
    s.equations2[3 + i] = s.equations1[6 + i];
    s.equations2[30 + i] = s.equations2[15 + i];
  }
  scene_create(&s);
  scene_commit(&s);
}

/* Entries and values are those of the triplets; then with all pairs that may come, which has zeros besides. */
static void check_tangent(int64_t base, int32_t form, int32_t weights, int shared) {
  int64_t n_rows;
  set_up(base, form, weights, shared);
  scene_tangent(&s, &t);
  int64_t count = plan(STICKSLIP_PLAN_ACTIVE, &n_rows);
  CHECK(count == t.n);
  check_entries(STICKSLIP_ENTRIES_TANGENT, n_rows, count);
  CHECK(memcmp(rows, t.rows, (size_t)count * sizeof *rows) == 0);
  CHECK(memcmp(columns, t.columns, (size_t)count * sizeof *columns) == 0);
  CHECK_OK(fill(NULL, count));
  CHECK(memcmp(values, t.values, (size_t)count * sizeof *values) == 0);
  CHECK(isnan(values[count]) || count == MOST);

  memset(expected, 0, sizeof expected);
  triplets_add(&t, base, expected);
  count = plan(STICKSLIP_PLAN_SKIN, &n_rows);
  CHECK(count >= t.n);
  check_entries(STICKSLIP_ENTRIES_TANGENT, n_rows, count);
  CHECK_OK(fill(NULL, count));
  memset(k, 0, sizeof k);
  for (int64_t e = 0; e < count; ++e) k[(rows[e] - base) * UNKNOWNS + columns[e] - base] = values[e];
  CHECK(block_difference(k, expected, 1e-300) <= 1e-14);
  scene_destroy(&s);
}

/* A fifth of a facet, 0.1 here, is within the skin. Further off entries are missing, until the plan is made again. */
static void check_slides(void) {
  set_up(0, STICKSLIP_FORM_MULTIPLIER, STICKSLIP_WEIGHTS_CURRENT, 0);
  const int64_t skin = plan(STICKSLIP_PLAN_SKIN, NULL);
  scene_slide(&s, 0.1);
  CHECK_OK(fill(NULL, skin));
  const int64_t active = plan(STICKSLIP_PLAN_ACTIVE, NULL);
  CHECK_OK(fill(NULL, active));
  scene_slide(&s, 0.6);
  CHECK_REFUSED(fill(NULL, active), STICKSLIP_MISSING_ENTRY, "make it again");
  CHECK_OK(stickslip_interface_plan_coo(s.interface, STICKSLIP_ENTRIES_TANGENT, active, rows, columns));
  scene_tangent(&s, &t);
  const int64_t again = plan(STICKSLIP_PLAN_ACTIVE, NULL);
  CHECK(again == t.n);
  CHECK_OK(fill(NULL, again));
  CHECK(memcmp(values, t.values, (size_t)again * sizeof *values) == 0);
  /* A plan that is refused leaves the older one as it was. */
  double kept[3];
  memcpy(kept, s.x1 + 12, sizeof kept);
  memcpy(s.x1 + 12, s.x1, sizeof kept);
  int64_t n = -1, count = -1;
  CHECK_REFUSED(stickslip_interface_plan(s.interface, s.x1, s.x2, STICKSLIP_PLAN_SKIN, &n, &count),
                STICKSLIP_DEGENERATE_FACET, "facet");
  CHECK(n == -1 && count == -1);
  memcpy(s.x1 + 12, kept, sizeof kept);
  CHECK_OK(fill(NULL, again));
  CHECK(memcmp(values, t.values, (size_t)again * sizeof *values) == 0);
  scene_destroy(&s);
}

/* Sums of all handles may close nodes that this handle's own leave open: such a plan has their entries. */
static void check_sums(void) {
  static double sums[STICKSLIP_SUMS_PER_NODE * N1];
  set_up(0, STICKSLIP_FORM_MULTIPLIER, STICKSLIP_WEIGHTS_CURRENT, 0);
  CHECK_OK(stickslip_interface_sums(s.interface, s.x1, s.x2, sums));
  CHECK_OK(stickslip_interface_tangent_coo(s.interface, s.x1, s.x2, s.lambda, sums, MOST_ENTRIES, t.rows, t.columns,
                                           t.values, &t.n));
  int64_t n_rows;
  const int64_t count = plan(STICKSLIP_PLAN_ACTIVE_SUMS, &n_rows);
  CHECK(count == t.n);
  check_entries(STICKSLIP_ENTRIES_TANGENT, n_rows, count);
  CHECK(memcmp(rows, t.rows, (size_t)count * sizeof *rows) == 0);
  CHECK(memcmp(columns, t.columns, (size_t)count * sizeof *columns) == 0);
  CHECK_OK(fill(sums, count));
  CHECK(memcmp(values, t.values, (size_t)count * sizeof *values) == 0);
  const int64_t skin = plan(STICKSLIP_PLAN_SKIN, NULL);
  CHECK_OK(fill(sums, skin));
  scene_destroy(&s);
}

/* A piece of the condensed matrix, its duplicates added up. */
static void piece(int32_t which, double *to) {
  CHECK_OK(stickslip_interface_condensed_coo(s.interface, s.x1, s.x2, s.lambda, which, MOST_ENTRIES, t.rows, t.columns,
                                             t.values, &t.n));
  memset(to, 0, MOST * sizeof *to);
  triplets_add(&t, s.options.index_base, to);
}

static void check_condensed(int64_t base, int32_t pairs, double slide) {
  static double forces_of_plan[MOST];
  int64_t n_rows[2], counts[2];
  scene_init_base(&s, base);
  s.method.multiplier_basis = STICKSLIP_BASIS_DUAL;
  scene_create(&s);
  if (slide != 0.0) scene_slide(&s, slide);
  scene_commit(&s);
  CHECK_REFUSED(stickslip_interface_condensed_values(s.interface, s.x1, s.x2, s.lambda, values, constraints),
                STICKSLIP_INVALID_VALUE, "there is no plan");
  CHECK_OK(stickslip_interface_condensed_plan(s.interface, s.x1, s.x2, pairs, n_rows, counts));
  for (int e = 0; e < MOST; ++e) forces_of_plan[e] = constraints[e] = NAN;
  CHECK_OK(stickslip_interface_condensed_values(s.interface, s.x1, s.x2, s.lambda, forces_of_plan, constraints));
  const int32_t pieces[2] = {STICKSLIP_CONDENSED_FORCES, STICKSLIP_CONDENSED_CONSTRAINTS};
  const int32_t entries[2] = {STICKSLIP_ENTRIES_FORCES, STICKSLIP_ENTRIES_CONSTRAINTS};
  for (int p = 0; p < 2; ++p) {
    CHECK(0 < counts[p] && counts[p] < MOST);
    check_entries(entries[p], n_rows[p], counts[p]);
    piece(pieces[p], expected);
    memset(k, 0, sizeof k);
    const double *of = p ? constraints : forces_of_plan;
    for (int64_t e = 0; e < counts[p]; ++e) k[(rows[e] - base) * UNKNOWNS + columns[e] - base] = of[e];
    const double largest = max_abs(expected, MOST);
    for (int e = 0; e < MOST; ++e) CHECK_NEAR(k[e], expected[e], 1e-13 * largest);
    CHECK(largest > 0.0 && isnan(of[counts[p]]));
  }
  /* The skin of so small a scene reaches far. */
  scene_slide(&s, slide == 0.0 ? 0.6 : -0.9);
  const int32_t status =
      stickslip_interface_condensed_values(s.interface, s.x1, s.x2, s.lambda, forces_of_plan, constraints);
  CHECK(status == STICKSLIP_MISSING_ENTRY || (pairs == STICKSLIP_PLAN_SKIN && status == STICKSLIP_OK));
  CHECK_OK(stickslip_interface_condensed_plan(s.interface, s.x1, s.x2, pairs, n_rows, counts));
  CHECK_OK(stickslip_interface_condensed_values(s.interface, s.x1, s.x2, s.lambda, forces_of_plan, constraints));
  scene_destroy(&s);
}

static void check_refusals(void) {
  set_up(0, STICKSLIP_FORM_MULTIPLIER, STICKSLIP_WEIGHTS_CURRENT, 0);
  FILL(values), FILL(rows), FILL(columns), FILL(rows32), FILL(columns32), FILL(offsets);
  CHECK_REFUSED(stickslip_interface_plan_values(s.interface, s.x1, s.x2, s.lambda, NULL, MOST, values),
                STICKSLIP_INVALID_VALUE, "there is no plan");
  CHECK_REFUSED(stickslip_interface_plan_coo(s.interface, STICKSLIP_ENTRIES_TANGENT, MOST, rows, columns),
                STICKSLIP_INVALID_VALUE, "there is no plan");
  const int64_t count = plan(STICKSLIP_PLAN_ACTIVE, NULL);
  CHECK_REFUSED(stickslip_interface_plan_values(s.interface, s.x1, s.x2, s.lambda, NULL, count - 1, values),
                STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  CHECK_REFUSED(stickslip_interface_plan_coo(s.interface, STICKSLIP_ENTRIES_TANGENT, count - 1, rows, columns),
                STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  CHECK_REFUSED(stickslip_interface_plan_csr(s.interface, STICKSLIP_ENTRIES_TANGENT, count - 1, rows, offsets, columns),
                STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  CHECK_REFUSED(stickslip_interface_plan_coo(s.interface, STICKSLIP_ENTRIES_FORCES, MOST, rows, columns),
                STICKSLIP_INVALID_VALUE, "there is no plan");
  scene_destroy(&s);

  /* Equations beyond 32 bits. */
  scene_init(&s);
  for (int i = 0; i < X1; ++i) s.multipliers[i] += INT32_MAX;
  scene_create(&s);
  const int64_t many = plan(STICKSLIP_PLAN_ACTIVE, NULL);
  CHECK_REFUSED(stickslip_interface_plan_coo32(s.interface, STICKSLIP_ENTRIES_TANGENT, many, rows32, columns32),
                STICKSLIP_INDEX_OUT_OF_RANGE, "32 bits");
  CHECK_UNTOUCHED(values);
  CHECK_UNTOUCHED(rows);
  CHECK_UNTOUCHED(columns);
  CHECK_UNTOUCHED(offsets);
  CHECK_UNTOUCHED(rows32);
  CHECK_UNTOUCHED(columns32);
  CHECK_OK(stickslip_interface_plan_coo(s.interface, STICKSLIP_ENTRIES_TANGENT, many, rows, columns));
  CHECK(columns[many - 1] > INT32_MAX);
  scene_destroy(&s);
}

/* Threads change no bit. */
static void check_threads(void) {
  static double residual[2][UNKNOWNS], found[2][MOST];
  int64_t count = 0;
  for (int n = 0; n < 2; ++n) {
    scene_init(&s);
    s.method.threads = 2 * n;
    scene_create(&s);
    scene_commit(&s);
    scene_slide(&s, 0.05);
    scene_residual(&s, residual[n]);
    count = plan(STICKSLIP_PLAN_SKIN, NULL);
    CHECK_OK(fill(NULL, count));
    memcpy(found[n], values, (size_t)count * sizeof *values);
    scene_destroy(&s);
  }
  CHECK(memcmp(residual[0], residual[1], sizeof residual[0]) == 0);
  CHECK(memcmp(found[0], found[1], (size_t)count * sizeof *values) == 0);
}

int main(void) {
  for (int64_t base = 0; base < 2; ++base) {
    for (int32_t form = 0; form < 2; ++form) {
      for (int32_t weights = STICKSLIP_WEIGHTS_CURRENT; weights <= STICKSLIP_WEIGHTS_REFERENCE; ++weights) {
        check_tangent(base, form, weights, 0);
        check_tangent(base, form, weights, 1);
      }
    }
    for (int32_t pairs = 0; pairs < 3; ++pairs) {
      check_condensed(base, pairs, 0.0);
      check_condensed(base, pairs, 0.3);
    }
  }
  check_slides();
  check_sums();
  check_refusals();
  check_threads();
  return 0;
}
