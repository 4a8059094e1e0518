/* block_host.c: the smallest complete finite element code with frictional mortar contact, to copy from.
 *
 * An elastic block, 4 x 1 x 2, on a rigid foundation whose mesh does not match; plane strain: y is fixed. Ten load
 * steps press it down by 200 per area, ten more push its left side by 60; friction 0.2: scenes/block_bottom_mu02.yaml.
 * Hexahedra, Newton's method with full steps, UMFPACK as linear solver (Debian: libsuitesparse-dev).
 *
 * From the top of the checkout:
 *   cargo build --release
 *   cc -O2 -Iinclude c_examples/block_host.c target/release/libstickslip.a -lumfpack -lpthread -ldl -lm -o block_host
 *   ./block_host [--current] [FILE]
 *
 * FILE receives the nodal displacements. --current: contact at the present positions (large sliding); else at those of
 * the undeformed bodies. Internal forces count positive; multipliers are minus the traction on the block. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include <suitesparse/umfpack.h>

enum { MX = 20, MY = 1, MZ = 10, FX = 13, FY = 3, STEPS = 20, MAX_ITERATIONS = 25 }; /* elements; foundation's facets */
enum { F1 = MX * MY, F2 = FX * FY, N_ELEMENTS = F1 * MZ, N1 = (MX + 1) * (MY + 1), N2 = (FX + 1) * (FY + 1) };
enum { N_BLOCK = N1 * (MZ + 1), N_NODES = N_BLOCK + N2, MULTIPLIERS = 3 * N_NODES, N_VALUES = MULTIPLIERS + 3 * N1 };
static const double YOUNG = 1000, POISSON = 0.3, FRICTION = 0.2, PRESS = -200, PUSH = 60, END_TIME = 2;

/* Converged: the block's |residual| <= RTOL times its largest |loads| + |reactions| + |contact forces| so far, 2-norms of
 * nodal forces, or below NOISE, the rounding of internal forces when a body moves as a whole; and the contact is in
 * equilibrium, to CONTACT of its own scales. */
static const double RTOL = 2e-11, NOISE = 1e-14, SMALLEST_REFERENCE = 1e-12, CONTACT = 1e-10;
static const double MODEL_SIZE = 6.164414002968976; /* diagonal of the box around both bodies, (5, 2, 3) */

static void stop(const char *why) {
  fprintf(stderr, "block_host: %s\n", why);
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

/* ---- unknowns: displacements of all nodes, then multipliers of the non-mortar ones ------------------------------ */
static double  value[N_VALUES], force[N_VALUES]; /* force: the residual; where a value is prescribed, its reaction */
static int64_t n_equations, equation[N_VALUES];  /* -1: prescribed (to zero in this problem), no equation */

static void number_equations(void) {
  for (int k = 0; k < N_VALUES; k++) {
    const int of_foundation = k >= 3 * N_BLOCK && k < MULTIPLIERS, along_y = k % 3 == 1;
    equation[k] = of_foundation || along_y ? -1 : n_equations++; /* y is fixed on both sides: no multiplier along it */
  }
}

/* Place, among all nodes' components, of component k of a list of nodes. */
static int at(const int *nodes, int k) {
  return 3 * nodes[k / 3] + k % 3;
}

/* The matrix: a list of entries; duplicates add up. */
static int64_t n_entries, capacity, *rows, *columns;
static double *entries;

static void reserve(int64_t more) {
  if (n_entries + more <= capacity) return;
  capacity = 2 * (n_entries + more);
  rows = realloc(rows, capacity * sizeof *rows);
  columns = realloc(columns, capacity * sizeof *columns);
  entries = realloc(entries, capacity * sizeof *entries);
  if (!rows || !columns || !entries) stop("out of memory");
}

/* ---- bulk: linear elastic hexahedra, loads ---------------------------------------------------------------------- */
static double load[N_VALUES];

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
    reserve(24 * 24);
    for (int k = 0; k < 24 * 24; k++) {
      const int row = at(element[e], k / 24), column = at(element[e], k % 24);
      force[row] += K[k / 24][k % 24] * value[column];
      if (equation[row] < 0 || equation[column] < 0) continue;
      rows[n_entries] = equation[row], columns[n_entries] = equation[column], entries[n_entries++] = K[k / 24][k % 24];
    }
  }
}

/* A constant traction on a rectangle: a quarter of its force at each corner. */
static void set_loads(double time) {
  const double top = PRESS * fmin(time, 1) * 4 / F1, left = PUSH * fmax(time - 1, 0) * 2 / (MY * MZ);
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
static double  x1[3 * (N1 + N2)], contact_force[3 * (N1 + N2)]; /* of both surfaces, one after the other */
static double *const x2 = x1 + 3 * N1, *const lambda = value + MULTIPLIERS;

/* Within Newton's method a refusal means: try a smaller load step. This little code has no other steps and stops. */
static void must(int32_t status) {
  if (status != STICKSLIP_OK) stop(stickslip_last_error_message());
}

static void present_positions(void) {
  for (int k = 0; k < 3 * (N1 + N2); k++) x1[k] = X[at(surface_node, k)] + value[at(surface_node, k)];
}

static void create_contact(int small) {
  int64_t equations[3 * (N1 + N2)]; /* the library copies what the surfaces point to */
  for (int k = 0; k < 3 * (N1 + N2); k++) equations[k] = equation[at(surface_node, k)];
  present_positions();
  const stickslip_surface block = {.struct_size = sizeof block, .n_nodes = N1, .n_facets = F1, .coordinates = x1,
      .facet_offsets = offset1, .facet_nodes = facet1, .equations = equations,
      .multiplier_equations = equation + MULTIPLIERS};
  const stickslip_surface foundation = {.struct_size = sizeof foundation, .n_nodes = N2, .n_facets = F2,
      .coordinates = x2, .facet_offsets = offset2, .facet_nodes = facet2, .equations = equations + 3 * N1};
  stickslip_options options;
  must(stickslip_options_init(&options, sizeof options));
  options.mu = FRICTION;
  options.modulus = YOUNG; /* gives the augmentation its unit; the answer does not depend on it */
  options.small_displacements = small;
  must(stickslip_interface_create(&block, &foundation, &options, &contact));
  must(stickslip_interface_initial_multipliers(contact, lambda)); /* once: where the first step starts */
}

static void add_contact(void) {
  int64_t count; /* of the tangent's entries; it may change from one evaluation to the next */
  present_positions();
  must(stickslip_interface_residual(contact, x1, x2, lambda, NULL, contact_force, contact_force + 3 * N1,
                                    force + MULTIPLIERS)); /* the multiplier rows, which nothing else adds to */
  for (int k = 0; k < 3 * (N1 + N2); k++) force[at(surface_node, k)] += contact_force[k];
  must(stickslip_interface_tangent_coo(contact, x1, x2, lambda, NULL, 0, NULL, NULL, NULL, &count));
  reserve(count);
  must(stickslip_interface_tangent_coo(contact, x1, x2, lambda, NULL, count, rows + n_entries, columns + n_entries,
                                       entries + n_entries, &count));
  n_entries += count;
}

/* The multiplier rows cannot tell: they are as small as the augmentation. */
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
  memset(force, 0, sizeof force);
  n_entries = 0;
  add_bulk();
  add_contact();
  for (int k = 0; k < N_VALUES; k++) {
    force[k] -= load[k];
    if (equation[k] >= 0 && k < MULTIPLIERS) squares += force[k] * force[k];
    if (equation[k] < 0 && k < 3 * N_BLOCK) reactions += force[k] * force[k];
    if (k < MULTIPLIERS) largest = fmax(largest, fabs(value[k]));
  }
  *reference = norm(N_VALUES, load) + sqrt(reactions) + norm(3 * N1, contact_force);
  *limit = fmax(RTOL * fmax(*reference, largest_reference), NOISE * YOUNG * MODEL_SIZE * fmin(largest, MODEL_SIZE));
  return sqrt(squares);
}

/* value = value - matrix^-1 force */
static void solve_and_update(void) {
  int64_t n = n_equations, *starts = malloc((n + 1) * sizeof *starts), *indices = malloc(n_entries * sizeof *indices);
  double *compressed = malloc(n_entries * sizeof *compressed), residual[N_VALUES], step[N_VALUES];
  void *symbolic = NULL, *numeric = NULL;
  for (int k = 0; k < N_VALUES; k++)
    if (equation[k] >= 0) residual[equation[k]] = force[k];
  if (!starts || !indices || !compressed ||
      umfpack_dl_triplet_to_col(n, n, n_entries, rows, columns, entries, starts, indices, compressed, NULL) ||
      umfpack_dl_symbolic(n, n, starts, indices, compressed, &symbolic, NULL, NULL) ||
      umfpack_dl_numeric(starts, indices, compressed, symbolic, &numeric, NULL, NULL) ||
      umfpack_dl_solve(UMFPACK_A, starts, indices, compressed, step, residual, numeric, NULL, NULL))
    stop("UMFPACK cannot solve; is every body held?");
  for (int k = 0; k < N_VALUES; k++)
    if (equation[k] >= 0) value[k] -= step[equation[k]];
  umfpack_dl_free_symbolic(&symbolic);
  umfpack_dl_free_numeric(&numeric);
  free(starts), free(indices), free(compressed);
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
  const int current = argc > 1 && !strcmp(argv[1], "--current");
  if (argc > 2 + current || (argc > 1 + current && argv[1 + current][0] == '-')) stop("usage: [--current] [FILE]");
  make_mesh();
  number_equations();
  create_contact(!current);

  for (int step = 1; step <= STEPS; step++) {
    const double time = END_TIME * step / STEPS;
    int32_t state[N1];
    const stickslip_states states = {.struct_size = sizeof states, .state = state};
    int iterations = 0, nodes_in[3] = {0};
    set_loads(time);
    while (size = assemble(largest_reference, &reference, &limit), !(size <= limit && in_equilibrium())) {
      if (iterations++ == MAX_ITERATIONS) stop("Newton's method does not converge");
      solve_and_update();
    }
    must(stickslip_interface_states(contact, x1, x2, lambda, NULL, &states)); /* the step's own: before the commit */
    must(stickslip_interface_commit(contact, x1, x2, lambda, NULL));
    largest_reference = fmax(largest_reference, reference);
    for (int a = 0; a < N1; a++) nodes_in[state[a]]++;
    printf("step %2d  t %.1f  iterations %2d  |r| %.2e  gap %d  stick %d  slip %d\n", step, time, iterations, size,
           nodes_in[STICKSLIP_STATE_GAP], nodes_in[STICKSLIP_STATE_STICK], nodes_in[STICKSLIP_STATE_SLIP]);
  }
  for (int k = 0; k < 3 * N1; k++) sum[k % 3] -= contact_force[k]; /* an internal force: minus the one on the block */
  const double *left = value + 3 * MZ * N1, *right = left + 3 * MX; /* upper corners of the block */
  printf("force on the block     %14.9f %14.9f %14.9f\n", sum[0], sum[1], sum[2]);
  printf("displacement top left  %14.9f %14.9f %14.9f\n", left[0], left[1], left[2]);
  printf("displacement top right %14.9f %14.9f %14.9f\n", right[0], right[1], right[2]);
  if (argc > 1 + current) write_displacements(argv[1 + current]);
  return stickslip_interface_destroy(&contact);
}
