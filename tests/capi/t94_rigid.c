/* Rigid bodies: where a motion puts their nodes, force and moment, the tangent by six unknowns in place of nodes against
 * differences at finite rotations, of either side and of both, in either index base and of lines; what is refused. */
#include "scene.h"

enum { SIX = 6, MOST = UNKNOWNS * UNKNOWNS, NEW = UNKNOWNS + 2 * SIX };

static const double DIFFERENCES = 1e-7; /* of entries against central differences, of the largest of their kind of row */
static const double ROUNDING = 1e-14;
static const double STEP = 1e-6;        /* of the differences: rounding of forces of size 1 gives 1e-10 */

static scene s;
static triplets t;

/* Sides as bodies, with a motion that puts them where the scene has them. */
typedef struct {
  int side; /* 1 or 2 */
  double coordinates[X2], point[3], forces[X2];
  int64_t equations[SIX];
  stickslip_rigid_body body;
  stickslip_rigid_motion motion;
} part;

static void rigid_init(part *p, int side, int64_t first) {
  const double turned[3] = {0.9, -1.4, 0.5}, point[3] = {0.3, -0.2, 0.8};
  const double *x = side == 1 ? s.x1 : s.x2;
  p->side = side;
  p->body = (stickslip_rigid_body){.struct_size = sizeof p->body, .dimension = 3,
      .n_nodes = side == 1 ? N1 : s.mortar.n_nodes,
      .coordinates = p->coordinates, .point = p->point, .node_equations = side == 1 ? s.equations1 : s.equations2,
      .equations = p->equations};
  p->motion = (stickslip_rigid_motion){.struct_size = sizeof p->motion};
  memcpy(p->motion.rotation, turned, sizeof turned);
  CHECK_OK(stickslip_rigid_turn(&p->motion));
  for (int i = 0; i < 3; ++i) {
    p->point[i] = point[i];
    p->motion.displacement[i] = 0.4 - 0.3 * i;
    p->motion.rotation[i] = 0.7 - 0.5 * i;
  }
  for (int i = 0; i < SIX; ++i) p->equations[i] = first + i;
  /* The matrix of the rotation, from where it takes the axes; X = P + R^T (x - P - u). */
  static const double axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, origin[3] = {0, 0, 0};
  stickslip_rigid_motion turn = p->motion;
  memset(turn.displacement, 0, sizeof turn.displacement);
  const stickslip_rigid_body frame = {.struct_size = sizeof frame, .dimension = 3, .n_nodes = 3, .coordinates = axes,
      .point = origin};
  double r[9];
  CHECK_OK(stickslip_rigid_positions(&frame, &turn, r));
  for (int a = 0; a < p->body.n_nodes; ++a) {
    for (int i = 0; i < 3; ++i) {
      p->coordinates[3 * a + i] = p->point[i];
      for (int j = 0; j < 3; ++j)
        p->coordinates[3 * a + i] += r[3 * i + j] * (x[3 * a + j] - p->point[j] - p->motion.displacement[j]);
    }
  }
}

static double *unknown(part *p, int i) { return i < 3 ? p->motion.displacement + i : p->motion.rotation + i - 3; }

static void place(part *p) { CHECK_OK(stickslip_rigid_positions(&p->body, &p->motion, p->side == 1 ? s.x1 : s.x2)); }

/* r: force1, force2, rows, of rigid sides 0; then the resultants. */
static void residual(part *parts, int n, double r[NEW]) {
  for (int k = 0; k < n; ++k) place(&parts[k]);
  memset(r, 0, NEW * sizeof *r);
  scene_residual(&s, r);
  for (int k = 0; k < n; ++k) {
    double *forces = r + (parts[k].side == 1 ? 0 : X1);
    const size_t size = (size_t)(3 * parts[k].body.n_nodes) * sizeof *forces;
    CHECK_OK(stickslip_rigid_resultant(&parts[k].body, &parts[k].motion, forces, r + UNKNOWNS + SIX * k));
    memcpy(parts[k].forces, forces, size);
    memset(forces, 0, size);
  }
}

static double worst_of(const double *v, int n) {
  double worst = 0.0;
  for (int k = 0; k < n; ++k) worst = fmax(worst, fabs(v[k]));
  return worst;
}

/* Forces, moments, multiplier rows. */
static int kind(int k) { return k < X1 + X2 ? 0 : k < UNKNOWNS ? 2 : (k - UNKNOWNS) % SIX < 3 ? 0 : 1; }

/* In place of the mortar facets a surface in closed form, whose frame is the body; 0: the facets. */
static void make_analytic(int shape) {
  const double radius = 5.0, points[4][3] = {{0.4, 0.5, shape == 1 ? 0.0 : -radius}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  if (!shape) return;
  const int axis = shape == 3 ? 2 : 1; /* of a cylinder it lies in the surfaces */
  const int order[4] = {0, axis, axis == 1 ? 2 : 3, axis == 1 ? 3 : 1};
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < 3; ++i) s.reference2[3 * k + i] = points[0][i] + (k ? 2.0 * points[order[k]][i] : 0.0);
    scene_frame(s.reference2 + 3 * k);
  }
  memcpy(s.x2, s.reference2, 12 * sizeof *s.x2);
  s.options.mortar_side = STICKSLIP_MORTAR_ANALYTIC;
  s.options.shape = shape == 1 ? STICKSLIP_SHAPE_PLANE : shape == 2 ? STICKSLIP_SHAPE_SPHERE : STICKSLIP_SHAPE_CYLINDER;
  if (shape > 1) s.options.radius = radius;
  s.mortar.n_nodes = 4;
  s.mortar.n_facets = 0;
  s.mortar.facet_offsets = s.mortar.facet_nodes = NULL;
}

/* What the equations of a frame go with. */
enum { AS_IT_IS, AUGMENTED, DUAL, CARRIED, TIED, NORMALS_OF_NOW, VARIANTS };
static void choose(int variant) {
  if (variant == AUGMENTED) s.method.form = STICKSLIP_FORM_AUGMENTED;
  if (variant == DUAL || variant == NORMALS_OF_NOW) s.method.multiplier_basis = STICKSLIP_BASIS_DUAL;
  if (variant == CARRIED) s.method.weak_coverage = 0.2;
  if (variant == TIED) s.options.friction = STICKSLIP_FRICTION_TIED, s.options.mu = 0.0;
  if (variant == NORMALS_OF_NOW) s.method.normals = STICKSLIP_NORMALS_CURRENT;
}

/* `drops`: the first body has no equation of the displacement along y and of the rotation about z. */
static void check_tangent(int64_t base, int n, const int *sides, int drops, int shape, int32_t weights, int32_t arms, int variant) {
  static double k[NEW][NEW], d[NEW][NEW], plus[NEW], minus[NEW], values[MOST], forces[X1 + X2], lambda[X1];
  static int64_t rows[MOST], columns[MOST];
  static part parts[2];
  stickslip_rigid_body bodies[2];
  stickslip_rigid_motion motions[2];
  scene_init_base(&s, base);
  s.method.weights = weights;
  make_analytic(shape);
  choose(variant);
  scene_create(&s);
  scene_commit(&s);
  scene_slide(&s, 0.03);
  for (int b = 0; b < n; ++b) {
    rigid_init(&parts[b], sides[b], base + UNKNOWNS + SIX * b);
    parts[b].motion.arms = arms;
    if (drops && b == 0) parts[b].equations[1] = parts[b].equations[5] = -1;
  }
  residual(parts, n, plus);
  scene_tangent(&s, &t);
  int at = 0;
  for (int b = 0; b < n; ++b) {
    bodies[b] = parts[b].body, motions[b] = parts[b].motion;
    memcpy(forces + at, parts[b].forces, (size_t)(3 * bodies[b].n_nodes) * sizeof *forces);
    at += (int)(3 * bodies[b].n_nodes);
  }
  stickslip_rigid *rigid = NULL;
  int64_t count = -1;
  CHECK_OK(stickslip_rigid_create(n, bodies, (int32_t)base, t.n, t.rows, t.columns, &rigid, &count));
  CHECK(0 < count && (shape || count < t.n));
  CHECK_REFUSED(stickslip_rigid_coo(rigid, count - 1, rows, columns), STICKSLIP_BUFFER_TOO_SMALL, "capacity");
  CHECK_OK(stickslip_rigid_coo(rigid, count, rows, columns));
  for (int twice = 0; twice < 2; ++twice) CHECK_OK(stickslip_rigid_values(rigid, motions, forces, t.values, values));
  CHECK_OK(stickslip_rigid_destroy(&rigid));
  CHECK(!rigid);
  memset(k, 0, sizeof k);
  for (int64_t e = 0; e < count; ++e) {
    const int64_t i = rows[e] - base, j = columns[e] - base;
    CHECK(0 <= i && i < NEW && 0 <= j && j < NEW);
    CHECK(e == 0 || rows[e - 1] < rows[e] || (rows[e - 1] == rows[e] && columns[e - 1] < columns[e]));
    k[i][j] = values[e];
  }
  /* Central differences, of every unknown that is left. */
  memcpy(lambda, s.lambda, sizeof lambda);
  for (int j = 0; j < NEW; ++j) {
    double *x = j < X1 ? s.x1 + j : j < X1 + X2 ? s.x2 + j - X1 : s.lambda + j - X1 - X2;
    int is_left = j < UNKNOWNS + SIX * n;
    if (j >= UNKNOWNS && is_left) x = unknown(&parts[(j - UNKNOWNS) / SIX], (j - UNKNOWNS) % SIX);
    for (int b = 0; b < n; ++b) {
      if (parts[b].side == 1 && j < X1) is_left = 0;
      if (parts[b].side == 2 && j >= X1 && j < X1 + X2) is_left = 0;
    }
    if (drops && (j == UNKNOWNS + 1 || j == UNKNOWNS + 5)) is_left = 0;
    for (int i = 0; i < NEW; ++i) d[i][j] = 0.0;
    if (!is_left) continue;
    const double kept = *x;
    *x = kept + STEP;
    residual(parts, n, plus);
    *x = kept - STEP;
    residual(parts, n, minus);
    *x = kept;
    for (int i = 0; i < NEW; ++i) {
      if (!(drops && (i == UNKNOWNS + 1 || i == UNKNOWNS + 5))) d[i][j] = (plus[i] - minus[i]) / (2.0 * STEP);
    }
  }
  double largest[3] = {0}, error[3] = {0};
  for (int i = 0; i < NEW; ++i) {
    for (int j = 0; j < NEW; ++j) {
      largest[kind(i)] = fmax(largest[kind(i)], fabs(k[i][j]));
      error[kind(i)] = fmax(error[kind(i)], fabs(k[i][j] - d[i][j]));
    }
  }
  for (int i = 0; i < 3; ++i) {
    CHECK(largest[i] > 0.1);
    CHECK_NEAR(error[i] / largest[i], 0.0, DIFFERENCES);
  }
  /* Forces on both sides cancel. */
  residual(parts, n, plus);
  for (int i = 0; i < 3; ++i) {
    double sum = 0.0;
    for (int a = i; a < X1 + X2; a += 3) sum += plus[a];
    for (int b = 0; b < n; ++b) sum += plus[UNKNOWNS + SIX * b + i];
    CHECK_NEAR(sum, 0.0, ROUNDING * worst_of(plus, NEW));
  }
  scene_destroy(&s);
}

/* In the plane: three numbers; a lever of length 2 along x, turned by a right angle. */
static void check_lines(void) {
  const double x[2] = {3.0, 1.0}, point[2] = {1.0, 1.0}, force[2] = {5.0, 7.0};
  const int64_t nodes[2] = {10, 11}, equations[3] = {0, 1, 2}, rows[3] = {10, 11, 4}, columns[3] = {10, 4, 11};
  const double nodal[3] = {2.0, 3.0, 5.0}, right_angle = acos(0.0);
  const stickslip_rigid_body body = {.struct_size = sizeof body, .dimension = 2, .n_nodes = 1, .coordinates = x,
      .point = point, .node_equations = nodes, .equations = equations};
  stickslip_rigid_motion motion = {.struct_size = sizeof motion, .displacement = {0.5, 0.25, 0.0}};
  double now[3] = {0, 0, 9.0}, resultant[4] = {0, 0, 0, 9.0};
  motion.rotation[2] = right_angle;
  CHECK_OK(stickslip_rigid_positions(&body, &motion, now));
  CHECK_NEAR(now[0], 1.5, ROUNDING);
  CHECK_NEAR(now[1], 3.25, ROUNDING);
  CHECK(now[2] == 9.0);
  CHECK_OK(stickslip_rigid_resultant(&body, &motion, force, resultant));
  CHECK(resultant[0] == 5.0 && resultant[1] == 7.0 && resultant[3] == 9.0);
  CHECK_NEAR(resultant[2], -10.0, 1e-13); /* the arm is (0, 2) */
  stickslip_rigid *rigid = NULL;
  int64_t count, r[32], c[32];
  CHECK_OK(stickslip_rigid_create(1, &body, 0, 3, rows, columns, &rigid, &count));
  CHECK(count == 9 + 3 + 3);
  CHECK_OK(stickslip_rigid_coo(rigid, 32, r, c));
  double values[32], k[5][5] = {{0}};
  CHECK_OK(stickslip_rigid_values(rigid, &motion, force, nodal, values));
  for (int e = 0; e < count; ++e) k[r[e]][c[e]] = values[e];
  /* u = (ux - 2 w, uy), moment -2 fx; the arm turns by -2 in x: -(0 ... ) f = (5, 7): d(-2 fx)/dw of the arm is -2 * 7. */
  const double expected[5][5] = {{2, 0, -4, 0, 0}, {0, 0, 0, 0, 3}, {-4, 0, 8 - 14, 0, 0}, {0}, {0, 5, 0, 0, 0}};
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) CHECK_NEAR(k[i][j], expected[i][j], 1e-13);
  }
  CHECK_OK(stickslip_rigid_destroy(&rigid));
  /* Of a tool that nothing follows the matrix has no entries, and forces on it turn with it all the same. */
  CHECK_OK(stickslip_rigid_create(1, &body, 0, 0, NULL, NULL, &rigid, &count));
  CHECK(count == 9);
  CHECK_OK(stickslip_rigid_coo(rigid, 9, r, c));
  CHECK_OK(stickslip_rigid_values(rigid, &motion, force, NULL, values));
  for (int e = 0; e < count; ++e) CHECK_NEAR(values[e], r[e] == 2 && c[e] == 2 ? -14.0 : 0.0, 1e-13);
  CHECK_OK(stickslip_rigid_destroy(&rigid));
  motion.rotation[0] = 1.0;
  CHECK_REFUSED(stickslip_rigid_positions(&body, &motion, now), STICKSLIP_INVALID_VALUE, "leaves the plane");
}

/* Many steps of turns are one turn; positions stay where a step has left them. */
static void check_turns(void) {
  const double x[3] = {1.0, 2.0, -0.5}, origin[3] = {0.0, 0.0, 0.0}, axis[3] = {2.0 / 7, -3.0 / 7, 6.0 / 7};
  const stickslip_rigid_body body = {.struct_size = sizeof body, .dimension = 3, .n_nodes = 1, .coordinates = x,
      .point = origin};
  stickslip_rigid_motion steps = {.struct_size = sizeof steps}, once = steps;
  double a[3], b[3];
  for (int i = 0; i < 3; ++i) once.rotation[i] = 3.0 * axis[i];
  for (int k = 0; k < 100; ++k) {
    for (int i = 0; i < 3; ++i) steps.rotation[i] = 0.03 * axis[i];
    CHECK_OK(stickslip_rigid_positions(&body, &steps, a));
    CHECK_OK(stickslip_rigid_turn(&steps));
    CHECK(steps.rotation[0] == 0.0 && steps.rotation[1] == 0.0 && steps.rotation[2] == 0.0);
    CHECK_OK(stickslip_rigid_positions(&body, &steps, b));
    for (int i = 0; i < 3; ++i) CHECK_NEAR(a[i], b[i], ROUNDING);
  }
  CHECK_OK(stickslip_rigid_positions(&body, &once, b));
  for (int i = 0; i < 3; ++i) CHECK_NEAR(a[i], b[i], 1e-13);
}

static void check_refusals(void) {
  const double x[6] = {1, 2, 3, 4, 5, 6}, point[3] = {0, 0, 0};
  int64_t nodes[6] = {10, 11, 12, 13, 14, 15}, equations[SIX] = {0, 1, 2, 3, 4, 5}, rows[2] = {10, 0}, columns[2] = {20, 15};
  stickslip_rigid_body body = {.struct_size = sizeof body, .dimension = 3, .n_nodes = 2, .coordinates = x, .point = point,
      .node_equations = nodes, .equations = equations};
  const stickslip_rigid_motion rest = {.struct_size = sizeof rest};
  stickslip_rigid_motion motion = rest;
  stickslip_rigid *rigid = NULL;
  int64_t count = -1;
  double now[6];
  FILL(now);
#define CREATE() stickslip_rigid_create(1, &body, 0, 2, rows, columns, &rigid, &count)
  body.point = NULL;
  CHECK_REFUSED(CREATE(), STICKSLIP_NULL_POINTER, "a rigid body needs a reference point");
  CHECK_REFUSED(stickslip_rigid_positions(&body, &motion, now), STICKSLIP_NULL_POINTER, "reference point");
  body.point = point;
  body.dimension = 4;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "dimension");
  body.dimension = 3;
  body.reserved = 1;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "reserved");
  body.reserved = 0;
  body.struct_size = 8;
  CHECK_REFUSED(CREATE(), STICKSLIP_STRUCT_SIZE, "stickslip_rigid_body");
  body.struct_size = sizeof body;
  nodes[5] = 10;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "10 is that of two components");
  nodes[5] = 3;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "3 of a reference point is in node_equations");
  nodes[5] = -2;
  CHECK_REFUSED(CREATE(), STICKSLIP_INDEX_OUT_OF_RANGE, "node_equations");
  nodes[5] = 15;
  equations[5] = 2;
  CHECK_REFUSED(CREATE(), STICKSLIP_INVALID_VALUE, "2 is that of two unknowns");
  equations[5] = 5;
  columns[0] = -7;
  CHECK_REFUSED(CREATE(), STICKSLIP_INDEX_OUT_OF_RANGE, "columns");
  columns[0] = 20;
  CHECK(!rigid && count == -1);
  motion.arms = 2;
  CHECK_REFUSED(stickslip_rigid_positions(&body, &motion, now), STICKSLIP_INVALID_VALUE, "motion.arms");
  motion.arms = STICKSLIP_RIGID_ARMS_END;
  motion.rotation[1] = 3.2;
  CHECK_REFUSED(stickslip_rigid_positions(&body, &motion, now), STICKSLIP_INVALID_VALUE, "at most pi");
  motion = rest;
  motion.turned[0] = motion.turned[4] = motion.turned[8] = 1.1;
  CHECK_REFUSED(stickslip_rigid_positions(&body, &motion, now), STICKSLIP_INVALID_VALUE, "no rotation");
  CHECK_REFUSED(stickslip_rigid_turn(&motion), STICKSLIP_INVALID_VALUE, "no rotation");
  CHECK(motion.turned[0] == 1.1);
  motion.turned[3] = NAN;
  CHECK_REFUSED(stickslip_rigid_turn(&motion), STICKSLIP_NOT_FINITE, "turned");
  CHECK_UNTOUCHED(now);
  CHECK_OK(CREATE());
  const double nodal[2] = {1.0, INFINITY}, forces[6] = {0};
  double values[100];
  FILL(values);
  CHECK(count <= COUNT(values));
  CHECK_REFUSED(stickslip_rigid_values(rigid, &rest, forces, nodal, values), STICKSLIP_NOT_FINITE, "nodal");
  CHECK_REFUSED(stickslip_rigid_values(rigid, &motion, forces, nodal, values), STICKSLIP_NOT_FINITE, "turned");
  CHECK_UNTOUCHED(values);
  CHECK_OK(stickslip_rigid_destroy(&rigid));
  CHECK_OK(stickslip_rigid_destroy(&rigid));
  CHECK_OK(stickslip_rigid_destroy(NULL));
  CHECK_REFUSED(stickslip_rigid_coo(NULL, 1, rows, columns), STICKSLIP_NULL_POINTER, "rigid");
}

int main(void) {
  static const int one[] = {1}, two[] = {2}, both[] = {2, 1};
  for (int64_t base = 0; base < 2; ++base) {
    for (int32_t weights = STICKSLIP_WEIGHTS_CURRENT; weights <= STICKSLIP_WEIGHTS_COMMITTED; ++weights) {
      check_tangent(base, 1, one, 0, 0, weights, STICKSLIP_RIGID_ARMS_END, AS_IT_IS);
      check_tangent(base, 1, one, 0, 0, weights, STICKSLIP_RIGID_ARMS_MIDDLE, AS_IT_IS);
      for (int shape = 0; shape < 4; ++shape) { /* facets; a plane, a ball, a bar */
        check_tangent(base, 1, two, 0, shape, weights, STICKSLIP_RIGID_ARMS_END, AS_IT_IS);
        check_tangent(base, 2, both, 0, shape, weights, STICKSLIP_RIGID_ARMS_END, AS_IT_IS);
        check_tangent(base, 2, both, 1, shape, weights, STICKSLIP_RIGID_ARMS_END, AS_IT_IS);
        check_tangent(base, 2, both, 1, shape, weights, STICKSLIP_RIGID_ARMS_MIDDLE, AS_IT_IS);
      }
    }
  }
  for (int shape = 1; shape <= 3; ++shape) {
    for (int variant = AS_IT_IS + 1; variant < VARIANTS; ++variant)
      check_tangent(0, 1, two, 0, shape, STICKSLIP_WEIGHTS_CURRENT, STICKSLIP_RIGID_ARMS_END, variant);
  }
  check_lines();
  check_turns();
  check_refusals();
  return 0;
}
