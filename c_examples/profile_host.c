/* profile_host.c: frictional mortar contact in a code that has no place for multipliers, and a solver without pivoting.
 *
 * The block of block_host.c. The multipliers, which are dual, follow from the displacements in each
 * evaluation: unknowns are displacements alone, and the matrix has no zeros on its diagonal. The solver is what old codes
 * have: LU in a profile, unsymmetric, rows as they come. It needs nothing but the library:
 *
 *   cargo build --release
 *   cc -O2 -Iinclude c_examples/profile_host.c target/release/libstickslip.a -lpthread -ldl -lm -o profile_host
 *   ./profile_host [--current] [--mu MU] [--push P] [FILE]
 *
 * FILE receives the nodal displacements. --current: contact at the present positions (large sliding); else at those of
 * the undeformed bodies. Friction is 0.2, or MU; the push on the left side is 60 per area, or P. Internal forces count
 * positive. At the end it tells the smallest pivot. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>

enum { MX = 20, MY = 1, MZ = 10, FX = 13, FY = 3, STEPS = 20, MAX_ITERATIONS = 25 }; /* elements; foundation's facets */
enum { F1 = MX * MY, F2 = FX * FY, N_ELEMENTS = F1 * MZ, N1 = (MX + 1) * (MY + 1), N2 = (FX + 1) * (FY + 1) };
enum { N_BLOCK = N1 * (MZ + 1), N_NODES = N_BLOCK + N2, N_VALUES = 3 * N_NODES };
static const double YOUNG = 1000, POISSON = 0.3, PRESS = -200, END_TIME = 2;
static double       friction = 0.2, push = 60;

/* Converged: the block's |residual| <= RTOL times its largest |loads| + |reactions| + |contact forces| so far, 2-norms of
 * nodal forces, or below NOISE, the rounding of internal forces when a body moves as a whole; and the contact is in
 * equilibrium, to CONTACT of its own scales. */
static const double RTOL = 2e-11, NOISE = 1e-14, SMALLEST_REFERENCE = 1e-12, CONTACT = 1e-10;
static const double MODEL_SIZE = 6.164414002968976; /* diagonal of the box around both bodies, (5, 2, 3) */

static void stop(const char *why) {
  fprintf(stderr, "profile_host: %s\n", why);
  exit(1);
}

/* ---- mesh: as any code has it, and the two surfaces ------------------------------------------------------------- */
static double  X[3 * N_NODES];                   /* undeformed positions: the block, then the foundation's surface */
static int     element[N_ELEMENTS][8];           /* lower face counter-clockwise from above, then the upper */
static int     surface_node[N1 + N2];            /* nodes of the two surfaces: 1, the non-mortar one, then 2 */
static int64_t facet1[4 * F1], facet2[4 * F2];   /* corners, counted from 0 in each surface; right-hand from outside */
static int64_t offset1[F1 + 1], offset2[F2 + 1]; /* where the corners of a facet begin */

/* Corners of quadrilateral f in a grid with nx of them along x, counter-clockwise from above. */
static void quadrilateral(int f, int nx, int c[4]) {
  c[0] = f / nx * (nx + 1) + f % nx, c[1] = c[0] + 1, c[2] = c[1] + nx + 1, c[3] = c[2] - 1;
}

static void make_surface(int n_facets, int nx, int from_above, int64_t *offsets, int64_t *facets) {
  for (int f = 0; f < n_facets; f++) {
    int corners[4];
    quadrilateral(f, nx, corners);
    for (int c = 0; c < 4; c++) facets[4 * f + c] = corners[from_above ? c : 3 - c];
    offsets[f + 1] = 4 * (f + 1);
  }
}

static void make_mesh(void) {
  for (int v = 0; v < N_BLOCK; v++) {
    X[3 * v] = 4.0 * (v % (MX + 1)) / MX;
    X[3 * v + 1] = 1.0 * (v / (MX + 1) % (MY + 1)) / MY;
    X[3 * v + 2] = 2.0 * (v / N1) / MZ;
  }
  for (int v = 0; v < N2; v++) {
    X[3 * (N_BLOCK + v)] = -0.5 + 5.0 * (v % (FX + 1)) / FX;
    X[3 * (N_BLOCK + v) + 1] = -0.5 + 2.0 * (v / (FX + 1)) / FY;
  }
  for (int e = 0; e < N_ELEMENTS; e++) {
    int corners[4];
    quadrilateral(e % F1, MX, corners);
    for (int c = 0; c < 8; c++) element[e][c] = corners[c % 4] + (e / F1 + c / 4) * N1;
  }
  for (int a = 0; a < N1 + N2; a++) surface_node[a] = a < N1 ? a : N_BLOCK + a - N1; /* N1: the bottom of the block */
  make_surface(F1, MX, 0, offset1, facet1); /* the block is seen from below, the foundation from above */
  make_surface(F2, FX, 1, offset2, facet2);
}

/* ---- unknowns: displacements, numbered plane by plane along x, so that the profile is narrow ---------------------- */
static double  value[N_VALUES], force[N_VALUES]; /* force: the residual; where a value is prescribed, its reaction */
static double  load[N_VALUES];
static int64_t n_equations, equation[N_VALUES];  /* -1: prescribed (to zero in this problem), no equation */

static void number_equations(void) {
  for (int k = 0; k < N_VALUES; k++) equation[k] = -1; /* the foundation is rigid, and y is fixed */
  for (int i = 0; i <= MX; i++)
    for (int v = i; v < N_BLOCK; v += MX + 1)
      for (int k = 0; k < 3; k += 2) equation[3 * v + k] = n_equations++;
}

/* Place, among all nodes' components, of component k of a list of nodes. */
static int at(const int *nodes, int k) {
  return 3 * nodes[k / 3] + k % 3;
}

/* ---- the matrix: each row from its first to its last column, which is compressed sparse rows without gaps ---------- */
static int64_t first[N_VALUES], last[N_VALUES], row_start[N_VALUES + 1], *columns;
static double *entries, smallest_pivot = INFINITY;

static void widen(int64_t row, int64_t column) {
  if (row < 0 || column < 0) return;
  if (column < first[row]) first[row] = column;
  if (column > last[row]) last[row] = column;
}

/* Room for what `widen` was told. What a row has, elimination hands on to the rows below: they end no sooner. */
static void make_profile(void) {
  for (int64_t i = 0; i < n_equations; i++) {
    if (i > 0 && last[i] < last[i - 1]) last[i] = last[i - 1];
    row_start[i + 1] = row_start[i] + last[i] - first[i] + 1;
  }
  columns = realloc(columns, row_start[n_equations] * sizeof *columns);
  entries = realloc(entries, row_start[n_equations] * sizeof *entries);
  if (!columns || !entries) stop("out of memory");
  for (int64_t i = 0; i < n_equations; i++)
    for (int64_t k = row_start[i]; k < row_start[i + 1]; k++) columns[k] = first[i] + k - row_start[i];
}

static double *entry(int64_t row, int64_t column) {
  return entries + row_start[row] + column - first[row];
}

/* x = matrix^-1 x by LU in place, without exchanging rows; the matrix is lost. */
static void solve(double *x) {
  double largest = 0;
  for (int64_t i = 0; i < n_equations; i++) largest = fmax(largest, fabs(*entry(i, i)));
  for (int64_t i = 0; i < n_equations; i++) {
    for (int64_t k = first[i]; k < i; k++) {
      const double *row = entry(k, k), factor = *entry(i, k) / *row;
      double *changed = entry(i, k);
      if (factor == 0) continue;
      for (int64_t j = 1; j <= last[k] - k; j++) changed[j] -= factor * row[j];
      x[i] -= factor * x[k];
    }
    if (!(fabs(*entry(i, i)) > 0)) stop("a pivot is zero; is every body held?");
    smallest_pivot = fmin(smallest_pivot, fabs(*entry(i, i)) / largest);
  }
  for (int64_t i = n_equations - 1; i >= 0; i--) {
    for (int64_t j = i + 1; j <= last[i]; j++) x[i] -= *entry(i, j) * x[j];
    x[i] /= *entry(i, i);
  }
}

/* ---- bulk: linear elastic hexahedra, loads ---------------------------------------------------------------------- */
/* K = int B^T C B dV with 2 x 2 x 2 Gauss points. */
static void element_stiffness(const int *nodes, double K[24][24]) {
  static const double corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                      {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  const double lame = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)), shear = YOUNG / (2 * (1 + POISSON));
  memset(K, 0, 24 * sizeof K[0]);
  for (int q = 0; q < 8; q++) {
    double d[8][3], J[3][3] = {{0}}, adjugate[3][3], g[8][3]; /* dN/dxi, dX/dxi, dN/dX */
    for (int a = 0; a < 8; a++) {
      double N[3];
      for (int k = 0; k < 3; k++) N[k] = 1 + corner[a][k] * corner[q][k] / sqrt(3);
      for (int k = 0; k < 3; k++) d[a][k] = 0.125 * corner[a][k] * N[(k + 1) % 3] * N[(k + 2) % 3];
      for (int i = 0; i < 9; i++) J[i / 3][i % 3] += X[3 * nodes[a] + i / 3] * d[a][i % 3];
    }
    for (int k = 0; k < 9; k++) {
      const int i = k / 3, j = k % 3, i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      adjugate[j][i] = J[i1][j1] * J[i2][j2] - J[i1][j2] * J[i2][j1];
    }
    const double det = J[0][0] * adjugate[0][0] + J[0][1] * adjugate[1][0] + J[0][2] * adjugate[2][0];
    for (int k = 0; k < 24; k++) {
      const int a = k / 3, i = k % 3;
      g[a][i] = (d[a][0] * adjugate[0][i] + d[a][1] * adjugate[1][i] + d[a][2] * adjugate[2][i]) / det;
    }
    for (int k = 0; k < 24 * 24; k++) {
      const int a = k / 24 / 3, i = k / 24 % 3, b = k % 24 / 3, j = k % 24 % 3;
      const double dot = g[a][0] * g[b][0] + g[a][1] * g[b][1] + g[a][2] * g[b][2];
      K[k / 24][k % 24] += det * (lame * g[a][i] * g[b][j] + shear * (g[a][j] * g[b][i] + (i == j) * dot));
    }
  }
}

static void add_bulk(void) {
  double K[24][24];
  for (int e = 0; e < N_ELEMENTS; e++) {
    element_stiffness(element[e], K);
    for (int k = 0; k < 24 * 24; k++) {
      const int row = at(element[e], k / 24), column = at(element[e], k % 24);
      force[row] += K[k / 24][k % 24] * value[column];
      if (equation[row] >= 0 && equation[column] >= 0) *entry(equation[row], equation[column]) += K[k / 24][k % 24];
    }
  }
}

/* A constant traction on a rectangle: a quarter of its force at each corner. */
static void set_loads(double time) {
  const double top = PRESS * fmin(time, 1) * 4 / F1, left = push * fmax(time - 1, 0) * 2 / (MY * MZ);
  memset(load, 0, sizeof load);
  for (int e = 0; e < N_ELEMENTS; e++) {
    for (int c = 0; c < 8; c++) {
      if (e / F1 == MZ - 1 && c >= 4) load[3 * element[e][c] + 2] += top / 4;
      if (e % MX == 0 && (c % 4 == 0 || c % 4 == 3)) load[3 * element[e][c]] += left / 4;
    }
  }
}

/* ---- contact: all that concerns the library --------------------------------------------------------------------- */
static stickslip_interface *contact;
static double x1[3 * (N1 + N2)], rows[3 * (N1 + N2)]; /* of both surfaces, one after the other */
static double *const x2 = x1 + 3 * N1, host[3 * N1], lambda[3 * N1];
static int    starting = 1; /* at the start lambda is given: no force has followed yet from no displacement */

/* Within Newton's method a refusal means: try a smaller load step. This little code has no other steps and stops. */
static void must(int32_t status) {
  if (status != STICKSLIP_OK) stop(stickslip_last_error_message());
}

static void present_positions(void) {
  for (int k = 0; k < 3 * (N1 + N2); k++) x1[k] = X[at(surface_node, k)] + value[at(surface_node, k)];
}

static void create_contact(int small) {
  int64_t equations[3 * (N1 + N2)], multipliers[3 * N1];
  for (int k = 0; k < 3 * (N1 + N2); k++) equations[k] = equation[at(surface_node, k)];
  /* y is fixed on both sides: no multiplier along it. The other numbers are those of no equation here. */
  for (int k = 0; k < 3 * N1; k++) multipliers[k] = k % 3 == 1 ? -1 : n_equations + k;
  present_positions();
  const stickslip_surface block = {.struct_size = sizeof block, .n_nodes = N1, .n_facets = F1, .coordinates = x1,
      .facet_offsets = offset1, .facet_nodes = facet1, .equations = equations, .multiplier_equations = multipliers};
  const stickslip_surface foundation = {.struct_size = sizeof foundation, .n_nodes = N2, .n_facets = F2,
      .coordinates = x2, .facet_offsets = offset2, .facet_nodes = facet2, .equations = equations + 3 * N1};
  stickslip_options options;
  must(stickslip_options_init(&options, sizeof options));
  options.mu = friction;
  options.modulus = YOUNG; /* gives the augmentation its unit; the answer does not depend on it */
  options.small_displacements = small;
  must(stickslip_interface_create(&block, &foundation, &options, &contact));
  must(stickslip_interface_initial_multipliers(contact, lambda));
}

/* The profile of elements, then, since rows of mortar nodes gain columns, that of the condensed matrix. It suffices while
 * the surfaces slide by less than a quarter of a facet. */
static void find_profile(void) {
  int64_t count, *entry_rows, *entry_columns;
  for (int64_t i = 0; i < n_equations; i++) first[i] = last[i] = i;
  for (int e = 0; e < N_ELEMENTS; e++)
    for (int k = 0; k < 24 * 24; k++) widen(equation[at(element[e], k / 24)], equation[at(element[e], k % 24)]);
  make_profile();
  present_positions();
  must(stickslip_interface_condensed_pattern(contact, x1, x2, n_equations, row_start, columns, 0, NULL, NULL, &count));
  entry_rows = malloc(count * sizeof *entry_rows), entry_columns = malloc(count * sizeof *entry_columns);
  if (!entry_rows || !entry_columns) stop("out of memory");
  must(stickslip_interface_condensed_pattern(contact, x1, x2, n_equations, row_start, columns, count, entry_rows,
                                             entry_columns, &count));
  for (int64_t k = 0; k < count; k++) widen(entry_rows[k], entry_columns[k]);
  free(entry_rows), free(entry_columns);
  make_profile();
}

/* Bulk forces and matrix become those of the system without multipliers. */
/* The scale of the constraint rows changes with the covered areas, where the multipliers follow from the displacements. */
static void add_scales(void) {
  const int32_t piece = STICKSLIP_CONDENSED_SCALES;
  int64_t n;
  must(stickslip_interface_condensed_coo(contact, x1, x2, lambda, piece, 0, NULL, NULL, NULL, &n));
  if (n == 0) return; /* frozen weights */
  int64_t *of = malloc(2 * n * sizeof *of);
  double *values = malloc(n * sizeof *values);
  if (!of || !values) stop("out of memory");
  must(stickslip_interface_condensed_coo(contact, x1, x2, lambda, piece, n, of, of + n, values, &n));
  for (int64_t k = 0; k < n; k++) *entry(of[k], of[n + k]) += values[k];
  free(of);
  free(values);
}

static void condense(void) {
  const int given = starting;
  present_positions();
  for (int k = 0; k < 3 * N1; k++) host[k] = force[at(surface_node, k)];
  if (!starting) must(stickslip_interface_condensed_multipliers(contact, x1, x2, host, lambda));
  starting = 0;
  must(stickslip_interface_condensed_residual(contact, x1, x2, lambda, host, rows, rows + 3 * N1));
  must(stickslip_interface_condensed_csr(contact, x1, x2, lambda, n_equations, row_start, columns, entries));
  if (!given) add_scales();
  for (int k = 0; k < 3 * N1; k++) /* instead of the host's rows; reactions stay */
    if (equation[at(surface_node, k)] >= 0) force[at(surface_node, k)] = rows[k];
  for (int k = 3 * N1; k < 3 * (N1 + N2); k++) force[at(surface_node, k)] += rows[k];
}

static int in_equilibrium(void) {
  stickslip_equilibrium e = {.struct_size = sizeof e, .modulus = YOUNG};
  must(stickslip_interface_equilibrium(contact, x1, x2, lambda, NULL, &e));
  return e.gap <= CONTACT * e.gap_scale && e.traction <= CONTACT * e.traction_scale && e.slip <= CONTACT * e.slip_scale;
}

/* ---- Newton ----------------------------------------------------------------------------------------------------- */
static double norm(int n, const double *v) {
  double squares = 0;
  for (int k = 0; k < n; k++) squares += v[k] * v[k];
  return sqrt(squares);
}

/* Residual and matrix. Returns the norm of the forces that do not balance; reference: the forces it is measured by;
 * limit: at and below it they balance. */
static double assemble(double largest_reference, double *reference, double *limit) {
  double squares = 0, reactions = 0, largest = 0;
  for (int k = 0; k < N_VALUES; k++) force[k] = -load[k];
  for (int64_t k = 0; k < row_start[n_equations]; k++) entries[k] = 0;
  add_bulk();
  condense();
  for (int k = 0; k < N_VALUES; k++) {
    if (equation[k] >= 0) squares += force[k] * force[k];
    if (equation[k] < 0 && k < 3 * N_BLOCK) reactions += force[k] * force[k];
    largest = fmax(largest, fabs(value[k]));
  }
  *reference = norm(N_VALUES, load) + sqrt(reactions) + norm(3 * N2, rows + 3 * N1);
  *limit = fmax(RTOL * fmax(*reference, largest_reference), NOISE * YOUNG * MODEL_SIZE * fmin(largest, MODEL_SIZE));
  return sqrt(squares);
}

/* value = value - matrix^-1 force */
static void solve_and_update(void) {
  double step[N_VALUES];
  for (int k = 0; k < N_VALUES; k++)
    if (equation[k] >= 0) step[equation[k]] = force[k];
  solve(step);
  for (int k = 0; k < N_VALUES; k++)
    if (equation[k] >= 0) value[k] -= step[equation[k]];
}

/* ---- load steps, output ----------------------------------------------------------------------------------------- */
static void write_displacements(const char *path) {
  FILE *file = fopen(path, "w");
  if (!file) stop("cannot write the file of displacements");
  fprintf(file, "# X Y Z ux uy uz\n");
  for (int k = 0; k < 6 * N_BLOCK; k++) /* X then u of each node */
    fprintf(file, "%.17g%c", (k % 6 < 3 ? X : value)[k / 6 * 3 + k % 3], k % 6 < 5 ? ' ' : '\n');
  if (fclose(file)) stop("cannot write the file of displacements");
}

int main(int argc, char **argv) {
  double largest_reference = SMALLEST_REFERENCE * YOUNG * MODEL_SIZE * MODEL_SIZE, reference, limit, size, sum[3] = {0};
  int small = 1;
  int word = 1, all = 0;
  for (; word < argc && argv[word][0] == '-'; word++) {
    if (!strcmp(argv[word], "--current")) small = 0;
    else if (!strcmp(argv[word], "--mu") && word + 1 < argc) friction = atof(argv[++word]);
    else if (!strcmp(argv[word], "--push") && word + 1 < argc) push = atof(argv[++word]);
    else stop("usage: [--current] [--mu MU] [--push P] [FILE]");
  }
  make_mesh();
  number_equations();
  create_contact(small);

  for (int step = 1; step <= STEPS; step++) {
    const double time = END_TIME * step / STEPS;
    int32_t state[N1];
    const stickslip_states states = {.struct_size = sizeof states, .state = state};
    int iterations = 0, nodes_in[3] = {0};
    set_loads(time);
    find_profile();
    while (size = assemble(largest_reference, &reference, &limit), !(size <= limit && in_equilibrium())) {
      if (iterations++ == MAX_ITERATIONS) stop("Newton's method does not converge");
      solve_and_update();
    }
    must(stickslip_interface_states(contact, x1, x2, lambda, NULL, &states)); /* the step's own: before the commit */
    must(stickslip_interface_commit(contact, x1, x2, lambda, NULL));
    largest_reference = fmax(largest_reference, reference);
    all += iterations;
    for (int a = 0; a < N1; a++) nodes_in[state[a]]++;
    printf("step %2d  t %.1f  iterations %2d  |r| %.2e  gap %d  stick %d  slip %d\n", step, time, iterations, size,
           nodes_in[STICKSLIP_STATE_GAP], nodes_in[STICKSLIP_STATE_STICK], nodes_in[STICKSLIP_STATE_SLIP]);
  }
  for (int k = 0; k < 3 * N2; k++) sum[k % 3] += rows[3 * N1 + k]; /* an internal force on the foundation */
  const double *left = value + 3 * MZ * N1, *right = left + 3 * MX; /* upper corners of the block */
  printf("force on the block     %14.9f %14.9f %14.9f\n", sum[0], sum[1], sum[2]);
  printf("displacement top left  %14.9f %14.9f %14.9f\n", left[0], left[1], left[2]);
  printf("displacement top right %14.9f %14.9f %14.9f\n", right[0], right[1], right[2]);
  printf("%d iterations, smallest pivot %.1e of the largest diagonal entry\n", all, smallest_pivot);
  if (argc > word) write_displacements(argv[word]);
  return stickslip_interface_destroy(&contact);
}
