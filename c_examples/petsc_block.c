static char help[] = "An elastic block is pressed on a rigid base and pushed along it, with friction.\n\
  -n <6>: elements along x and y; -friction <0.3>; -load <40>: force that presses the top face; -push <0.1>: its way\n\
  along x; -steps <10>: half of them press, half of them push\n\n";
/* How contact by the stickslip library enters a PETSc code: one file to copy from, like PETSc's src/snes/tutorials.
 *
 * The block is a box of 8-node hexahedra of small strain. A dead load presses its top face, then the top face moves
 * along x. Unknowns: 3 displacements a node of the block, then 3 multipliers a node of its bottom face. The base is one
 * large facet without unknowns. One process: the program stickslip (program/) is parallel, and cuts steps back.
 *
 * From the top of the checkout (Debian: petsc-dev):
 *   cargo build --release
 *   mpicc -Iinclude c_examples/petsc_block.c target/release/libstickslip.a $(pkg-config --cflags --libs PETSc) \
 *     -lpthread -ldl -lm -o petsc_block
 *   ./petsc_block -n 8 -friction 0.2 -snes_monitor
 *
 * For a problem of your own:
 *   mesh, material, loads    CreateMesh(), ElementStiffness(), the loops over elements
 *   the surfaces in contact  CreateContact(): coordinates, facets, equation numbers. Surface 1, the non-mortar one, has
 *                            the multipliers: take the softer, the finer or the smaller of the two
 *   a base that deforms      give its nodes unknowns, pass their equations in place of -1; x2 moves, force2 counts
 *   another law              options in CreateContact()
 *   prescribed displacements equation = -1 in CreateMesh(), values in FormFunction() */
#include <petscsnes.h>
#include <stickslip.h>

#if PETSC_VERSION_LT(3, 19, 0) && !defined(PETSC_SUCCESS)
  #define PETSC_SUCCESS 0
#endif
/* The library's status as a PETSc error, where a refusal is nothing to recover from. */
#define PetscCallStickslip(...) \
  PetscCheck(!(__VA_ARGS__), PETSC_COMM_SELF, PETSC_ERR_LIB, "%s", stickslip_last_error_message())
/* Entries in PETSc's integers. */
#if defined(PETSC_USE_64BIT_INDICES)
  #define PLAN_COO stickslip_interface_plan_coo
#else
  #define PLAN_COO stickslip_interface_plan_coo32
#endif
/* Edges of the block; its material; Newton's tolerance, and ten times it for the contact, over scales of its own. */
static const PetscReal SIZE[3] = {2, 2, 1}, YOUNG = 1000, POISSON = 0.3, RTOL = 1e-11, CONTACT_RTOL = 1e-10;
static const double    BASE[12] = {-1, -1, 0, 3, -1, 0, 3, 3, 0, -1, 3, 0}; /* corners, counter-clockwise from above */
/* Full steps find the states of the nodes fastest. Multipliers of nodes that stick have no diagonal: the factorisation
 * must pivot, and MUMPS needs more room for that than it expects. */
static const char *const DEFAULTS[][2] = {{"-snes_linesearch_type", "basic"}, {"-ksp_type", "preonly"},
  {"-pc_type", "lu"}, {"-pc_factor_mat_solver_type", "mumps"}, {"-mat_mumps_icntl_14", "200"}};

typedef struct {
  PetscInt             n[3], n_elements, n1, n_displacements; /* elements along the axes; n1: nodes below */
  PetscReal            friction, load, push;
  PetscReal            pressed, moved, contact[3], reaction[3]; /* the top now; sums of forces on the block */
  PetscReal           *X, *x1, *force1;                  /* nodes at rest; those of the bottom now, contact on them */
  PetscReal            K[24][24];                        /* of every element: all are alike */
  int64_t             *equation;                         /* of each displacement; -1: prescribed */
  stickslip_interface *interface;
  PetscInt             n_elastic;                        /* entries of the matrix from elements and prescribed values, */
  int64_t              n_contact;                        /* and after them those from contact */
  PetscScalar         *values;                           /* of all of them */
} AppCtx;

/* Components of an element's displacements among all: lower face counter-clockwise from above, then the upper. */
static void ElementComponents(const AppCtx *app, PetscInt e, PetscInt at[24])
{
  const PetscInt *n = app->n, i = e % n[0], j = e / n[0] % n[1], k = e / (n[0] * n[1]);
  for (int c = 0; c < 24; c++) {
    const int corner = c / 3 % 4;
    at[c] = 3 * (i + (corner % 3 > 0) + (n[0] + 1) * (j + corner / 2) + app->n1 * (k + c / 12)) + c % 3;
  }
}

/* The first n1 nodes are those of the bottom, the last n1 those of the top. */
static PetscErrorCode CreateMesh(PetscInt n, AppCtx *app)
{
  PetscFunctionBeginUser;
  app->n[0] = app->n[1] = n, app->n[2] = (n + 1) / 2;
  app->n_elements      = n * n * app->n[2];
  app->n1              = (n + 1) * (n + 1);
  app->n_displacements = 3 * app->n1 * (app->n[2] + 1);
  PetscCall(PetscMalloc4(app->n_displacements, &app->X, 3 * app->n1, &app->x1, 3 * app->n1, &app->force1,
                         app->n_displacements, &app->equation));
  for (PetscInt v = 0; 3 * v < app->n_displacements; v++) {
    const PetscInt index[3] = {v % (n + 1), v / (n + 1) % (n + 1), v / app->n1};
    for (int i = 0; i < 3; i++) { /* of the top, z alone is free */
      app->X[3 * v + i]        = SIZE[i] * index[i] / app->n[i];
      app->equation[3 * v + i] = index[2] == app->n[2] && i < 2 ? -1 : 3 * v + i;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K = int B^T C B dV of a box with edges h, 2 x 2 x 2 Gauss points */
static void ElementStiffness(AppCtx *app)
{
  static const PetscReal corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                         {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  const PetscReal h[3]  = {SIZE[0] / app->n[0], SIZE[1] / app->n[1], SIZE[2] / app->n[2]};
  const PetscReal shear = YOUNG / (2 * (1 + POISSON)), lame = 2 * shear * POISSON / (1 - 2 * POISSON);
  for (int q = 0; q < 8; q++) {
    PetscReal g[8][3]; /* dN/dX */
    for (int k = 0; k < 24; k++) {
      const PetscReal *x = corner[k / 3], *xi = corner[q];
      const int        i = k % 3, j = (i + 1) % 3, l = (i + 2) % 3;
      g[k / 3][i] = x[i] * (1 + x[j] * xi[j] / PetscSqrtReal(3)) * (1 + x[l] * xi[l] / PetscSqrtReal(3)) / (4 * h[i]);
    }
    for (int k = 0; k < 24 * 24; k++) {
      const int       a = k / 24 / 3, i = k / 24 % 3, b = k % 24 / 3, j = k % 24 % 3;
      const PetscReal dot = g[a][0] * g[b][0] + g[a][1] * g[b][1] + g[a][2] * g[b][2];
      app->K[k / 24][k % 24] +=
        h[0] * h[1] * h[2] / 8 * (lame * g[a][i] * g[b][j] + shear * (g[a][j] * g[b][i] + (i == j) * dot));
    }
  }
}

/* The library copies what the surfaces point to. lambda: multipliers to start from, once. */
static PetscErrorCode CreateContact(AppCtx *app, PetscScalar *lambda)
{
  const PetscInt    n_facets = app->n[0] * app->n[1];
  const int64_t     base_offsets[2] = {0, 4}, base_nodes[4] = {0, 1, 2, 3};
  const int64_t     none[12] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
  int64_t          *offsets, *nodes, *multipliers;
  PetscInt          at[24];
  stickslip_options options;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n_facets + 1, &offsets, 4 * n_facets, &nodes, 3 * app->n1, &multipliers));
  for (PetscInt f = 0; f <= n_facets; f++) offsets[f] = 4 * f;
  for (PetscInt f = 0; f < n_facets; f++) { /* right-hand order from outside: the bottom is seen from below */
    ElementComponents(app, f, at);
    for (int c = 0; c < 4; c++) nodes[4 * f + c] = at[3 * (3 - c)] / 3;
  }
  for (PetscInt k = 0; k < 3 * app->n1; k++) multipliers[k] = app->n_displacements + k;
  const stickslip_surface block = {.struct_size = sizeof(block), .n_nodes = app->n1, .n_facets = n_facets,
    .coordinates = app->X, .facet_offsets = offsets, .facet_nodes = nodes, .equations = app->equation,
    .multiplier_equations = multipliers};
  const stickslip_surface base = {.struct_size = sizeof(base), .n_nodes = 4, .n_facets = 1, .coordinates = BASE,
    .facet_offsets = base_offsets, .facet_nodes = base_nodes, .equations = none};
  PetscCallStickslip(stickslip_options_init(&options, sizeof(options)));
  options.mu      = app->friction;
  options.modulus = YOUNG; /* gives the augmentation its unit; the answer does not depend on it */
  PetscCallStickslip(stickslip_interface_create(&block, &base, &options, &app->interface));
  PetscCallStickslip(stickslip_interface_initial_multipliers(app->interface, lambda));
  PetscCall(PetscFree3(offsets, nodes, multipliers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The library takes positions, not displacements. Returns the multipliers, which follow the displacements in x. */
static const PetscScalar *Positions(AppCtx *app, const PetscScalar *u)
{
  for (PetscInt k = 0; k < 3 * app->n1; k++) app->x1[k] = app->X[k] + u[k];
  return u + app->n_displacements;
}

/* Internal forces + contact - loads; where a displacement is prescribed, that; then the multiplier rows. */
static PetscErrorCode FormFunction(SNES snes, Vec x, Vec f, void *ctx)
{
  AppCtx            *app = ctx;
  const PetscScalar *u;
  PetscScalar       *r;
  PetscInt           at[24];
  double             force2[12]; /* on the base: no equations */
  PetscFunctionBeginUser;
  PetscCall(VecZeroEntries(f));
  PetscCall(VecGetArrayRead(x, &u));
  PetscCall(VecGetArray(f, &r));
  for (PetscInt e = 0; e < app->n_elements; e++) {
    ElementComponents(app, e, at);
    for (int k = 0; k < 24 * 24; k++) r[at[k / 24]] += app->K[k / 24][k % 24] * u[at[k % 24]];
    for (int c = 4; c < 8 && e / (app->n[0] * app->n[1]) == app->n[2] - 1; c++) /* a quarter to each corner on top */
      r[at[3 * c + 2]] += app->pressed / (4 * app->n[0] * app->n[1]);
  }
  if (stickslip_interface_residual(app->interface, app->x1, BASE, Positions(app, u), NULL, app->force1, force2,
                                   r + app->n_displacements))
    PetscCall(SNESSetFunctionDomainError(snes)); /* the iterate has run away: a smaller step may help */
  for (int i = 0; i < 3; i++) app->contact[i] = app->reaction[i] = 0;
  for (PetscInt k = 0; k < 3 * app->n1; k++) r[k] += app->force1[k], app->contact[k % 3] -= app->force1[k];
  for (PetscInt k = 0; k < app->n_displacements; k++) /* the top: u_x and u_y are what they shall be */
    if (app->equation[k] < 0) app->reaction[k % 3] += r[k], r[k] = app->K[0][0] * (u[k] - (k % 3 ? 0 : app->moved));
  PetscCall(VecRestoreArray(f, &r));
  PetscCall(VecRestoreArrayRead(x, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All entries of the matrix: the elements' and those of contact, of all pairs of facets that may meet while the block slides
 * by less than a quarter of a facet. Entries with a negative row or column are left out, duplicates add up. */
static PetscErrorCode Preallocate(AppCtx *app, Mat P)
{
  PetscInt at[24], *i, *j, n = 0;
  int64_t  n_rows;
  PetscFunctionBeginUser;
  PetscCallStickslip(
    stickslip_interface_plan(app->interface, app->x1, BASE, STICKSLIP_PLAN_SKIN, &n_rows, &app->n_contact));
  const PetscInt most = 24 * 24 * app->n_elements + app->n_displacements + (PetscInt)app->n_contact;
  PetscCall(PetscFree(app->values));
  PetscCall(PetscMalloc1(most, &app->values));
  PetscCall(PetscMalloc2(most, &i, most, &j));
  for (PetscInt e = 0; e < app->n_elements; e++) {
    ElementComponents(app, e, at);
    for (int k = 0; k < 24 * 24; k++, n++)
      i[n] = app->equation[at[k / 24]], j[n] = at[k % 24], app->values[n] = app->K[k / 24][k % 24];
  }
  for (PetscInt k = 0; k < app->n_displacements; k++)
    if (app->equation[k] < 0) i[n] = j[n] = k, app->values[n++] = app->K[0][0];
  PetscCallStickslip(PLAN_COO(app->interface, STICKSLIP_ENTRIES_TANGENT, app->n_contact, i + n, j + n));
  app->n_elastic = n;
  PetscCall(MatSetPreallocationCOO(P, n + (PetscInt)app->n_contact, i, j));
  PetscCall(PetscFree2(i, j));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The values of contact; the elements' stay. Compare with differences: -snes_test_jacobian. */
static PetscErrorCode FormJacobian(SNES snes, Vec x, Mat J, Mat P, void *ctx)
{
  AppCtx            *app    = ctx;
  int32_t            status = STICKSLIP_MISSING_ENTRY;
  const PetscScalar *u, *lambda;
  PetscFunctionBeginUser;
  (void)snes, (void)J; /* J is P */
  PetscCall(VecGetArrayRead(x, &u));
  lambda = Positions(app, u);
  if (app->values)
    status = stickslip_interface_plan_values(app->interface, app->x1, BASE, lambda, NULL, app->n_contact,
                                             app->values + app->n_elastic);
  if (status == STICKSLIP_MISSING_ENTRY) { /* at first, and where the block has slid on */
    PetscCall(Preallocate(app, P));
    status = stickslip_interface_plan_values(app->interface, app->x1, BASE, lambda, NULL, app->n_contact,
                                             app->values + app->n_elastic);
  }
  PetscCallStickslip(status);
  PetscCall(VecRestoreArrayRead(x, &u));
  PetscCall(MatSetValuesCOO(P, app->values, INSERT_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SNES' own test, and then the library's: the multiplier rows are as small as the augmentation, and cannot tell. */
static PetscErrorCode Converged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                                SNESConvergedReason *reason, void *ctx)
{
  AppCtx               *app = ctx;
  stickslip_equilibrium e   = {.struct_size = sizeof(e), .modulus = YOUNG};
  const PetscScalar    *u;
  Vec                   x;
  PetscFunctionBeginUser;
  PetscCall(SNESConvergedDefault(snes, it, xnorm, snorm, fnorm, reason, NULL));
  if (*reason <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetSolution(snes, &x));
  PetscCall(VecGetArrayRead(x, &u));
  PetscCallStickslip(stickslip_interface_equilibrium(app->interface, app->x1, BASE, Positions(app, u), NULL, &e));
  PetscCall(VecRestoreArrayRead(x, &u));
  if (e.gap > CONTACT_RTOL * e.gap_scale || e.traction > CONTACT_RTOL * e.traction_scale ||
      e.slip > CONTACT_RTOL * e.slip_scale)
    *reason = SNES_CONVERGED_ITERATING;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A converged step is reported and committed: friction goes on from there. The states are those before the commit. */
static PetscErrorCode Accept(AppCtx *app, SNES snes, PetscInt step, Vec x)
{
  PetscInt           its;
  int                counts[3] = {0, 0, 0}; /* nodes in gap, stick and slip */
  int32_t           *state;
  const PetscScalar *u, *lambda;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(app->n1, &state));
  PetscCall(VecGetArrayRead(x, &u));
  lambda = Positions(app, u);
  const stickslip_states states = {.struct_size = sizeof(states), .state = state};
  PetscCallStickslip(stickslip_interface_states(app->interface, app->x1, BASE, lambda, NULL, &states));
  PetscCallStickslip(stickslip_interface_commit(app->interface, app->x1, BASE, lambda, NULL));
  PetscCall(VecRestoreArrayRead(x, &u));
  for (PetscInt a = 0; a < app->n1; a++) counts[state[a]]++;
  PetscCall(PetscFree(state));
  PetscCall(SNESGetIterationNumber(snes, &its));
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "step %d: %d iterations, %d gap %d stick %d slip,", (int)step, (int)its,
                        counts[STICKSLIP_STATE_GAP], counts[STICKSLIP_STATE_STICK], counts[STICKSLIP_STATE_SLIP]));
  PetscCall(PetscPrintf(PETSC_COMM_SELF, " load %.12g contact %.12g %.12g reaction %.12g\n", app->pressed,
                        app->contact[2], app->contact[0], app->reaction[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  AppCtx       app = {.friction = 0.3, .load = 40, .push = 0.1};
  PetscInt     n = 6, steps = 10;
  PetscMPIInt  size;
  SNES         snes;
  Mat          J;
  Vec          x;
  PetscScalar *u;
  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(DEFAULTS); k++) /* before the command line, which overrides them */
    PetscCall(PetscOptionsSetValue(NULL, DEFAULTS[k][0], DEFAULTS[k][1]));
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCheck(size == 1, PETSC_COMM_WORLD, PETSC_ERR_WRONG_MPI_SIZE, "This is a uniprocessor example only");
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-n", &n, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-friction", &app.friction, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-load", &app.load, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-push", &app.push, NULL));
  PetscCheck(n > 1 && steps > 1, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE, "-n and -steps are at least 2");
  PetscCall(CreateMesh(n, &app));
  ElementStiffness(&app);
  n = app.n_displacements + 3 * app.n1; /* unknowns */
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, n, &x));
  PetscCall(VecGetArray(x, &u));
  PetscCall(CreateContact(&app, u + app.n_displacements));
  PetscCall(VecRestoreArray(x, &u));
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 0, NULL, &J));
  PetscCall(SNESCreate(PETSC_COMM_SELF, &snes));
  PetscCall(SNESSetFunction(snes, NULL, FormFunction, &app));
  PetscCall(SNESSetJacobian(snes, J, J, FormJacobian, &app));
  PetscCall(SNESSetConvergenceTest(snes, Converged, &app, NULL));
  PetscCall(SNESSetTolerances(snes, 0, RTOL, 0, 25, PETSC_DEFAULT));
  PetscCall(SNESSetErrorIfNotConverged(snes, PETSC_TRUE)); /* a code of your own would try a smaller step */
  PetscCall(SNESSetFromOptions(snes));
  for (PetscInt step = 1; step <= steps; step++) {
    const PetscReal t = 2.0 * step / steps;
    app.pressed       = app.load * PetscMin(t, 1);
    app.moved         = app.push * PetscMax(t - 1, 0);
    PetscCall(SNESSolve(snes, NULL, x));
    PetscCall(Accept(&app, snes, step, x));
  }
  PetscCallStickslip(stickslip_interface_destroy(&app.interface));
  PetscCall(PetscFree4(app.X, app.x1, app.force1, app.equation));
  PetscCall(PetscFree(app.values));
  PetscCall(VecDestroy(&x));
  PetscCall(MatDestroy(&J));
  PetscCall(SNESDestroy(&snes));
  return PetscFinalize();
}
