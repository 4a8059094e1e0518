/* Derivatives of a residual by positions of t_n and of now, friction, the shear limit and offsets: against central differences, column
 * by column; the matrix and both products against each other; what is refused. */
#include "scene.h"

/* Differences with this step, over the largest entry of a block: rounding 1e-16 / 1e-6 and truncation. */
static const double STEP = 1e-6, DIFFERENCES = 1e-8;
/* Below the smallest block that is not zero, whose largest entry is 0.018: in place of it for those that are. */
static const double SMALLEST = 1e-2;
/* Sums of some hundred products, over their largest. */
static const double ROUNDING = 1e-13;

/* What a residual depends on besides multipliers, one after the other, and where each member begins. */
enum {
  PREVIOUS1 = 0,
  PREVIOUS2 = PREVIOUS1 + X1,
  NOW1 = PREVIOUS2 + X2,
  NOW2 = NOW1 + X1,
  FRICTION = NOW2 + X2,
  SHEAR_LIMIT = FRICTION + N1,
  OFFSETS1 = SHEAR_LIMIT + 1,
  OFFSETS2 = OFFSETS1 + N1,
  DEPENDS = OFFSETS2 + N2
};
static const int members[] = {PREVIOUS1, PREVIOUS2, NOW1, NOW2, FRICTION, SHEAR_LIMIT, OFFSETS1, OFFSETS2, DEPENDS};

typedef struct {
  int32_t friction, slip, weights, normals, basis, integration;
  double shear_limit, slide; /* off the mortar side's edge, so that nodes are carried */
} kind;
static const kind kinds[] = {
    {.slip = STICKSLIP_SLIP_INCREMENT},
    {.slip = STICKSLIP_SLIP_PAPER},
    {.slip = STICKSLIP_SLIP_OBJECTIVE},
    {.normals = STICKSLIP_NORMALS_CURRENT},
    {.weights = STICKSLIP_WEIGHTS_REFERENCE},
    {.basis = STICKSLIP_BASIS_DUAL},
    {.friction = STICKSLIP_FRICTION_TRESCA, .shear_limit = 0.1}, /* some nodes slip at it, others at mu times the pressure */
    {.friction = STICKSLIP_FRICTION_NONE},
    {.friction = STICKSLIP_FRICTION_ROUGH, .integration = STICKSLIP_INTEGRATION_ELEMENTS},
    {.basis = STICKSLIP_BASIS_DUAL, .slide = 0.9},
    {.basis = STICKSLIP_BASIS_DUAL, .slide = 0.9, .normals = STICKSLIP_NORMALS_CURRENT, .slip = STICKSLIP_SLIP_INCREMENT},
};

static scene s;
static double by_hand[UNKNOWNS][DEPENDS], columns[UNKNOWNS][DEPENDS];

static stickslip_gradient gradient_in(double *to) {
  const stickslip_gradient g = {.struct_size = sizeof g, .previous1 = to + PREVIOUS1, .previous2 = to + PREVIOUS2, .now1 = to + NOW1,
                                .now2 = to + NOW2, .friction = to + FRICTION, .shear_limit = to + SHEAR_LIMIT,
                                .offsets1 = to + OFFSETS1, .offsets2 = to + OFFSETS2};
  return g;
}

static stickslip_direction direction_of(const double *v) {
  const stickslip_direction d = {.struct_size = sizeof d, .previous1 = v + PREVIOUS1, .previous2 = v + PREVIOUS2, .now1 = v + NOW1,
                                 .now2 = v + NOW2, .friction = v + FRICTION, .shear_limit = v + SHEAR_LIMIT,
                                 .offsets1 = v + OFFSETS1, .offsets2 = v + OFFSETS2};
  return d;
}

/* A scene of this kind, and its arguments. At t_n the non-mortar side lay flat where it has slid to. */
static void set_up(const kind *k, int64_t base, double *at) {
  scene_init_base(&s, base);
  s.options.friction = k->friction;
  s.options.shear_limit = k->shear_limit;
  s.options.mu = has_mu(k->friction) ? 0.2 : 0.0;
  s.method.slip = k->slip;
  s.method.weights = k->weights;
  s.method.integration = k->integration;
  if (k->slide != 0.0) s.method.weak_coverage = 0.5;
  if (k->normals) s.method.normals = k->normals;
  if (k->basis) s.method.multiplier_basis = k->basis;
  /* Derivatives hold the scale of rows. Differences do not. */
  s.method.row_scale = STICKSLIP_ROW_SCALE_NONE;
  memcpy(at + PREVIOUS2, s.reference2, sizeof s.reference2);
  scene_slide(&s, k->slide);
  memcpy(at + NOW1, s.x1, sizeof s.x1);
  memcpy(at + NOW2, s.x2, sizeof s.x2);
  memcpy(s.x1, s.reference1, sizeof s.x1);
  scene_slide(&s, k->slide);
  memcpy(at + PREVIOUS1, s.x1, sizeof s.x1);
  for (int a = 0; a < N1; ++a) at[FRICTION + a] = s.options.mu;
  at[SHEAR_LIMIT] = k->shear_limit;
  for (int j = OFFSETS1; j < DEPENDS; ++j) at[j] = 1e-3 * (j % 5 - 2);
}

/* A handle that is where the arguments say. */
static void create(const double *at) {
  double r[N1];
  memcpy(s.x1, at + NOW1, sizeof s.x1);
  memcpy(s.x2, at + NOW2, sizeof s.x2);
  s.options.shear_limit = at[SHEAR_LIMIT];
  scene_create(&s);
  for (int a = 0; a < N1; ++a) r[a] = s.method.augmentation;
  CHECK_OK(stickslip_interface_set_augmentation(s.interface, r));
  if (has_mu(s.options.friction)) CHECK_OK(stickslip_interface_set_friction(s.interface, at + FRICTION));
  CHECK_OK(stickslip_interface_set_offsets(s.interface, at + OFFSETS1, at + OFFSETS2));
  CHECK_OK(stickslip_interface_set_committed(s.interface, at + PREVIOUS1, at + PREVIOUS2, NULL, 1));
}

static void residual_at(const double *at, double *r) {
  create(at);
  scene_residual(&s, r);
  scene_destroy(&s);
}

static void sensitivity(const double *v, double *r) {
  const stickslip_direction d = direction_of(v);
  CHECK_OK(stickslip_interface_sensitivity(s.interface, s.x1, s.x2, s.lambda, &d, r, r + X1, r + X1 + X2));
}

static int32_t adjoint(const double *a, const stickslip_gradient *g) {
  return stickslip_interface_adjoint(s.interface, s.x1, s.x2, s.lambda, a, a + X1, a + X1 + X2, g);
}

static int32_t matrix(triplets *t, int64_t capacity) {
  return stickslip_interface_previous_tangent_coo(s.interface, s.x1, s.x2, s.lambda, capacity, t->rows, t->columns, t->values, &t->n);
}

/* Whether an argument is one of these interfaces at all. */
static int is_there(int j) {
  if (j >= FRICTION && j < SHEAR_LIMIT) return has_mu(s.options.friction);
  return j != SHEAR_LIMIT || s.options.friction == STICKSLIP_FRICTION_TRESCA;
}

static void check_differences(double *at, int rows) {
  const int ends[] = {0, X1 + X2, rows};
  double more[UNKNOWNS], less[UNKNOWNS], v[DEPENDS] = {0};
  memset(by_hand, 0, sizeof by_hand);
  for (int j = 0; j < DEPENDS; ++j) {
    if (!is_there(j)) continue;
    const double there = at[j];
    at[j] = there + STEP;
    residual_at(at, more);
    at[j] = there - STEP;
    residual_at(at, less);
    at[j] = there;
    for (int i = 0; i < rows; ++i) by_hand[i][j] = (more[i] - less[i]) / (2.0 * STEP);
  }
  create(at);
  for (int j = 0; j < DEPENDS; ++j) {
    v[j] = 1.0;
    sensitivity(v, more);
    v[j] = 0.0;
    for (int i = 0; i < rows; ++i) columns[i][j] = more[i];
  }
  for (int m = 0; m + 1 < COUNT(members); ++m) {
    double of_all = 0.0;
    for (int p = 0; p < 2; ++p) {
      double error = 0.0, scale = SMALLEST;
      for (int i = ends[p]; i < ends[p + 1]; ++i) {
        for (int j = members[m]; j < members[m + 1]; ++j) {
          error = larger(error, fabs(columns[i][j] - by_hand[i][j]));
          scale = larger(scale, fabs(by_hand[i][j]));
        }
      }
      CHECK(error <= DIFFERENCES * scale);
      of_all = larger(of_all, scale);
    }
    /* By previous2 where nothing slips there is nothing. */
    const int slips = s.options.friction != STICKSLIP_FRICTION_NONE;
    CHECK((of_all > SMALLEST) == (is_there(members[m]) && (slips || members[m] != PREVIOUS2)));
  }
  stickslip_counters counters = {.struct_size = sizeof counters};
  CHECK_OK(stickslip_interface_counters(s.interface, &counters));
  CHECK((counters.nodes_carried > 0) == (s.method.weak_coverage > 0.0));
  scene_destroy(&s);
}

/* Where an unknown's equation stands. */
static int64_t *equation(int64_t unknown) {
  if (unknown < X1) return s.equations1 + unknown;
  return unknown < X1 + X2 ? s.equations2 + unknown - X1 : s.multipliers + unknown - X1 - X2;
}

/* Matrix and products against the columns, in either index base. */
static void check_products(const kind *k, int64_t base, int rows) {
  static triplets t;
  static double dense[UNKNOWNS][DEPENDS];
  double at[DEPENDS], a[UNKNOWNS], v[DEPENDS], r[UNKNOWNS], g[DEPENDS], alone[N1];
  int64_t counted = -1;
  set_up(k, base, at);
  create(at);
  CHECK_OK(stickslip_interface_previous_tangent_coo(s.interface, s.x1, s.x2, s.lambda, 0, NULL, NULL, NULL, &counted));
  CHECK_OK(matrix(&t, MOST_ENTRIES));
  CHECK(counted == t.n && counted > 0);
  memset(dense, 0, sizeof dense);
  for (int64_t e = 0; e < t.n; ++e) {
    const int64_t row = t.rows[e] - base, column = t.columns[e] - base;
    CHECK(0 <= row && row < rows && 0 <= column && column < X1 + X2);
    dense[row][column] += t.values[e];
  }
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < NOW1; ++j) CHECK(fabs(dense[i][j] - columns[i][j]) <= ROUNDING);
  }

  for (int i = 0; i < rows; ++i) a[i] = (7 * i + 3) % 11 - 5.0;
  for (int j = 0; j < DEPENDS; ++j) v[j] = (5 * j + 2) % 7 - 3.0;
  const stickslip_gradient all = gradient_in(g);
  CHECK_OK(adjoint(a, &all));
  for (int j = 0; j < DEPENDS; ++j) {
    double sum = 0.0, size = 1.0;
    for (int i = 0; i < rows; ++i) sum += a[i] * columns[i][j], size += fabs(a[i] * columns[i][j]);
    CHECK(fabs(sum - g[j]) <= ROUNDING * size);
  }
  sensitivity(v, r);
  for (int i = 0; i < rows; ++i) {
    double sum = 0.0, size = 1.0;
    for (int j = 0; j < DEPENDS; ++j) sum += columns[i][j] * v[j], size += fabs(columns[i][j] * v[j]);
    CHECK(fabs(sum - r[i]) <= ROUNDING * size);
  }

  /* One member alone. */
  const stickslip_gradient one = {.struct_size = sizeof one, .friction = alone};
  CHECK_OK(adjoint(a, &one));
  CHECK(memcmp(alone, g + FRICTION, sizeof alone) == 0);

  /* No column and no row of what has no equation; too little room. */
  scene_destroy(&s);
  const int64_t gone = base == 0 ? t.columns[0] : t.rows[0];
  *equation(gone - base) = -1;
  create(at);
  CHECK_OK(matrix(&t, MOST_ENTRIES));
  CHECK(t.n < counted);
  for (int64_t e = 0; e < t.n; ++e) CHECK(t.rows[e] != gone && t.columns[e] != gone);
  CHECK_REFUSED(matrix(&t, t.n - 1), STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  scene_destroy(&s);
}

/* What derivatives do not go with, and what a side that does not move has none of. */
static void check_refusals(void) {
  static triplets t;
  double at[DEPENDS], g[DEPENDS], a[UNKNOWNS] = {0};
  set_up(&kinds[0], 0, at);
  s.method.form = STICKSLIP_FORM_AUGMENTED;
  create(at);
  const stickslip_gradient all = gradient_in(g);
  FILL(g);
  CHECK_REFUSED(matrix(&t, MOST_ENTRIES), STICKSLIP_UNSUPPORTED, "STICKSLIP_FORM_MULTIPLIER");
  CHECK_REFUSED(adjoint(a, &all), STICKSLIP_UNSUPPORTED, "STICKSLIP_FORM_MULTIPLIER");
  CHECK_UNTOUCHED(g);
  scene_destroy(&s);

  /* Of such a tangent all derivatives of weights are missing. They were given without a word, 100 % off. */
  set_up(&kinds[0], 0, at);
  s.method.tangent = STICKSLIP_TANGENT_FROZEN_WEIGHTS;
  create(at);
  CHECK_REFUSED(matrix(&t, MOST_ENTRIES), STICKSLIP_UNSUPPORTED, "STICKSLIP_TANGENT_FROZEN_WEIGHTS");
  scene_destroy(&s);

  set_up(&kinds[0], 0, at);
  s.options.mortar_side = STICKSLIP_MORTAR_RIGID;
  for (int k = 0; k < X2; ++k) s.equations2[k] = -1;
  create(at);
  stickslip_gradient without = all;
  without.now2 = NULL;
  CHECK_REFUSED(adjoint(a, &all), STICKSLIP_UNSUPPORTED, "now");
  CHECK_UNTOUCHED(g);
  CHECK_OK(adjoint(a, &without));
  scene_destroy(&s);
}

int main(void) {
  for (int k = 0; k < COUNT(kinds); ++k) {
    double at[DEPENDS];
    set_up(&kinds[k], 0, at);
    const int rows = X1 + X2 + (kinds[k].friction == STICKSLIP_FRICTION_NONE ? N1 : X1);
    check_differences(at, rows);
    for (int base = 0; base < 2; ++base) check_products(&kinds[k], base, rows);
  }
  check_refusals();
  return 0;
}
