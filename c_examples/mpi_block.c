static char help[] = "An elastic block is pressed on a rigid base and pushed along it, with friction, on any number of processes.\n\
  -n <6>: elements along x and y; -friction <0.3>; -load <40>: force that presses the top face; -push <0.1>: its way\n\
  along x; -steps <10>: half of them press, half of them push\n\n";
/* The block of petsc_block.c on many processes: what a parallel host writes for contact with libstickslip_mpi. That is what stands
 * between "contact begins" and "contact ends", and the lines that call it.
 *
 * Nodes lie in planes of constant x; each process has some planes, and the elements that begin there. An unknown's number is that of
 * its plane times app->width, and then 3 displacements a node, from below, and 3 multipliers a node of the bottom. The base is one
 * large facet without unknowns, which process 0 owns.
 *
 *   mpicc -Iinclude -Impi c_examples/mpi_block.c mpi/[a-z]*.c target/release/libstickslip.a $(pkg-config --cflags --libs PETSc) \
 *     -lpthread -ldl -lm -o mpi_block
 *   mpiexec -n 4 ./mpi_block -n 8 -friction 0.2 -snes_monitor */
#include <petscsnes.h>
#include <stickslip_mpi.h>

#if PETSC_VERSION_LT(3, 19, 0) && !defined(PETSC_SUCCESS)
  #define PETSC_SUCCESS 0
#endif
/* The library's status, which is the same on all processes, as a PETSc error, where a refusal is nothing to recover from. */
#define PetscCallContact(...) \
  PetscCheck(!(__VA_ARGS__), PETSC_COMM_WORLD, PETSC_ERR_LIB, "%s", stickslip_mpi_last_error_message())
/* Edges of the block; its material; Newton's tolerance, and ten times it for the contact, over scales of its own. */
static const PetscReal SIZE[3] = {2, 2, 1}, YOUNG = 1000, POISSON = 0.3, RTOL = 1e-11, CONTACT_RTOL = 1e-10;
static const double    BASE[12] = {-1, -1, 0, 3, -1, 0, 3, 3, 0, -1, 3, 0}; /* corners, counter-clockwise from above */
/* Full steps find the states of the nodes fastest. Multipliers of nodes that stick have no diagonal: the factorisation
 * must pivot, and MUMPS needs more room for that than it expects. */
static const char *const DEFAULTS[][2] = {{"-snes_linesearch_type", "basic"}, {"-ksp_type", "preonly"},
  {"-pc_type", "lu"}, {"-pc_factor_mat_solver_type", "mumps"}, {"-mat_mumps_icntl_14", "200"}};

typedef struct {
  PetscInt    n[3], first, planes, width, multipliers; /* elements along the axes; the own planes; unknowns of one, where its multipliers begin */
  PetscMPIInt rank;
  PetscInt    n1, n_facets;          /* of the bottom: own nodes, own facets */
  int64_t    *node, *below, *multiplier, *offsets, *corners; /* numbers of its nodes and unknowns, its facets */
  PetscReal   friction, load, push, pressed, moved, contact[3], reaction[3];
  PetscReal   K[24][24];             /* of every element: all are alike */
  Vec         u, f;                  /* of the own planes, and of the next one as ghosts */
  PetscReal  *X, *x, *lambda, *force, *rows; /* of its nodes: at rest, now, multipliers, what contact says */
  PetscInt    n_elastic;
  int64_t     n_contact;             /* entries of the matrix from elements and prescribed values, and after them from contact */
  PetscScalar *values;
  stickslip_mpi_interface *interface;
} AppCtx;

/* the number of component c of the displacement of node (i, j, k) */
static PetscInt Unknown(const AppCtx *app, PetscInt i, PetscInt j, PetscInt k, PetscInt c)
{
  return i * app->width + 3 * (k * (app->n[1] + 1) + j) + c;
}

/* Unknowns of own element e: lower face counter-clockwise from above, then the upper. Returns whether it is below the top. */
static PetscBool Element(const AppCtx *app, PetscInt e, PetscInt at[24])
{
  const PetscInt *n = app->n, i = app->first + e / (n[1] * n[2]), j = e % n[1], k = e / n[1] % n[2];
  for (int c = 0; c < 24; c++) {
    const int corner = c / 3 % 4;
    at[c] = Unknown(app, i + (corner % 3 > 0), j + corner / 2, k + c / 12, c % 3);
  }
  return (PetscBool)(k == n[2] - 1);
}

static PetscInt Elements(const AppCtx *app)
{
  return (PetscMin(app->first + app->planes, app->n[0]) - app->first) * app->n[1] * app->n[2];
}

/* of the top, x and y are prescribed */
static PetscBool Prescribed(const AppCtx *app, PetscInt unknown)
{
  const PetscInt in_plane = unknown % app->width, top = app->multipliers - 3 * (app->n[1] + 1);
  return (PetscBool)(in_plane >= top && in_plane < app->multipliers && in_plane % 3 < 2);
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

/* What the mesh says of its bottom: numbers of the own nodes, which are any that differ, where they and their unknowns are, and facets,
 * in right-hand order from outside: they are seen from below. */
static PetscErrorCode CreateBottom(AppCtx *app)
{
  const PetscInt across = app->n[1] + 1;
  PetscFunctionBeginUser;
  app->n1       = app->planes * across;
  app->n_facets = (PetscMin(app->first + app->planes, app->n[0]) - app->first) * app->n[1];
  PetscCall(PetscMalloc5(app->n1, &app->node, 3 * app->n1, &app->X, 3 * app->n1, &app->below, app->n_facets + 1, &app->offsets,
                         4 * app->n_facets, &app->corners));
  for (PetscInt k = 0; k < 3 * app->n1; k++) {
    const PetscInt  i = app->first + k / 3 / across, j = k / 3 % across;
    const PetscReal X[3] = {SIZE[0] * i / app->n[0], SIZE[1] * j / app->n[1], 0};
    app->node[k / 3] = i * across + j;
    app->X[k]        = X[k % 3];
    app->below[k]    = Unknown(app, i, j, 0, k % 3);
  }
  for (PetscInt f = 0; f <= app->n_facets; f++) app->offsets[f] = 4 * f;
  for (PetscInt k = 0; k < 4 * app->n_facets; k++)
    app->corners[k] = app->node[0] + k / 4 / app->n[1] * across + k / 4 % app->n[1] + k % 4 / 2 * across + (k % 4 == 1 || k % 4 == 2);
  PetscCall(PetscMalloc5(3 * app->n1, &app->multiplier, 3 * app->n1, &app->x, 3 * app->n1, &app->lambda, 3 * app->n1, &app->force,
                         3 * app->n1, &app->rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* --- contact begins --------------------------------------------------------------------------------------------------- */

/* Multipliers to start from: once, app->lambda. */
static PetscErrorCode CreateContact(AppCtx *app)
{
  static const int64_t offsets[2] = {0, 4}, nodes[4] = {0, 1, 2, 3}, none[12] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
  const stickslip_mpi_share block = {.struct_size = sizeof(block), .n_nodes = app->n1, .nodes = app->node, .coordinates = app->X,
    .equations = app->below, .multiplier_equations = app->multiplier, .n_facets = app->n_facets, .facet_offsets = app->offsets, .facet_nodes = app->corners};
  const stickslip_mpi_share base = {.struct_size = sizeof(base), .n_nodes = app->rank ? 0 : 4, .nodes = nodes, .coordinates = BASE,
    .equations = none, .n_facets = !app->rank, .facet_offsets = offsets, .facet_nodes = nodes};
  stickslip_options options;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 3 * app->n1; k++) app->multiplier[k] = app->below[k] + app->multipliers;
  stickslip_options_init(&options, sizeof(options));
  options.mu = app->friction, options.modulus = YOUNG; /* gives the augmentation its unit; the answer does not depend on it */
  PetscCallContact(stickslip_mpi_interface_create(PETSC_COMM_WORLD, &block, &base, &options, NULL, &app->interface));
  PetscCallContact(stickslip_mpi_interface_initial_multipliers(app->interface, app->lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says where the own nodes are, and adds contact to the residual; where that is refused the iterate has run away. u, f: of the own
 * unknowns, the first of which has the number `shift`. */
static int32_t AddContact(AppCtx *app, PetscInt shift, const PetscScalar *u, PetscScalar *f)
{
  double  on_base[12]; /* no equations */
  int32_t status;
  for (PetscInt k = 0; k < 3 * app->n1; k++) {
    app->x[k]      = app->X[k] + u[app->below[k] - shift];
    app->lambda[k] = u[app->multiplier[k] - shift];
  }
  status = stickslip_mpi_interface_update(app->interface, app->x, BASE, app->lambda);
  if (!status) status = stickslip_mpi_interface_residual(app->interface, app->force, on_base, app->rows);
  for (PetscInt k = 0; k < 3 * app->n1 && !status; k++) {
    f[app->below[k] - shift] += app->force[k];
    f[app->multiplier[k] - shift] = app->rows[k];
  }
  return status;
}

/* --- contact ends ----------------------------------------------------------------------------------------------------- */

/* Internal forces + contact - loads; where a displacement is prescribed, that; then the multiplier rows. */
static PetscErrorCode FormFunction(SNES snes, Vec x, Vec f, void *ctx)
{
  AppCtx            *app = ctx;
  const PetscInt     shift = app->first * app->width;
  const PetscScalar *u;
  PetscScalar       *r;
  PetscInt           at[24];
  Vec                u_local, f_local;
  PetscFunctionBeginUser;
  PetscCall(VecCopy(x, app->u));
  PetscCall(VecGhostUpdateBegin(app->u, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGhostUpdateEnd(app->u, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGhostGetLocalForm(app->u, &u_local));
  PetscCall(VecGhostGetLocalForm(app->f, &f_local));
  PetscCall(VecSet(f_local, 0));
  PetscCall(VecGetArrayRead(u_local, &u));
  PetscCall(VecGetArray(f_local, &r));
  for (PetscInt e = 0; e < Elements(app); e++) {
    const PetscBool top = Element(app, e, at);
    for (int k = 0; k < 24 * 24; k++) r[at[k / 24] - shift] += app->K[k / 24][k % 24] * u[at[k % 24] - shift];
    for (int c = 4; c < 8 && top; c++) r[at[3 * c + 2] - shift] += app->pressed / (4 * app->n[0] * app->n[1]); /* a quarter to each corner */
  }
  PetscCall(VecRestoreArray(f_local, &r));
  PetscCall(VecGhostUpdateBegin(app->f, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(VecGhostUpdateEnd(app->f, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(VecGetArray(f_local, &r));
  if (AddContact(app, shift, u, r)) PetscCall(SNESSetFunctionDomainError(snes)); /* a smaller step may help */
  for (int i = 0; i < 3; i++) app->contact[i] = app->reaction[i] = 0;
  for (PetscInt k = 0; k < 3 * app->n1; k++) app->contact[k % 3] -= app->force[k];
  for (PetscInt k = 0; k < app->planes * app->width; k++)
    if (Prescribed(app, k)) app->reaction[k % app->width % 3] += r[k], r[k] = app->K[0][0] * (u[k] - (k % app->width % 3 ? 0 : app->moved));
  PetscCall(VecRestoreArray(f_local, &r));
  PetscCall(VecRestoreArrayRead(u_local, &u));
  PetscCall(VecGhostRestoreLocalForm(app->f, &f_local));
  PetscCall(VecGhostRestoreLocalForm(app->u, &u_local));
  PetscCall(VecCopy(app->f, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All entries of the matrix: the elements' and those of contact. Entries with a negative row are left out, duplicates add up, and
 * PETSc brings rows of other processes there. */
static PetscErrorCode Preallocate(AppCtx *app, Mat P)
{
  PetscInt at[24], *i, *j, n = 0;
  int64_t *rows, *columns;
  PetscFunctionBeginUser;
  PetscCallContact(stickslip_mpi_interface_plan(app->interface, STICKSLIP_PLAN_SKIN, &app->n_contact)); /* contact */
  const PetscInt most = 24 * 24 * Elements(app) + app->planes * app->width + (PetscInt)app->n_contact;
  PetscCall(PetscFree(app->values));
  PetscCall(PetscMalloc1(most, &app->values));
  PetscCall(PetscMalloc4(most, &i, most, &j, app->n_contact, &rows, app->n_contact, &columns));
  for (PetscInt e = 0; e < Elements(app); e++) {
    (void)Element(app, e, at);
    for (int k = 0; k < 24 * 24; k++, n++) {
      i[n] = Prescribed(app, at[k / 24]) ? -1 : at[k / 24], j[n] = at[k % 24];
      app->values[n] = app->K[k / 24][k % 24];
    }
  }
  for (PetscInt k = 0; k < app->planes * app->width; k++)
    if (Prescribed(app, k)) i[n] = j[n] = app->first * app->width + k, app->values[n++] = app->K[0][0];
  app->n_elastic = n;
  PetscCallContact(stickslip_mpi_interface_plan_coo(app->interface, app->n_contact, rows, columns)); /* contact */
  for (int64_t k = 0; k < app->n_contact; k++, n++) i[n] = (PetscInt)rows[k], j[n] = (PetscInt)columns[k]; /* contact */
  PetscCall(MatSetPreallocationCOO(P, n, i, j));
  PetscCall(PetscFree4(i, j, rows, columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At the place of the last residual. A missing entry is one on all processes: at first, and where the block has slid on. */
static PetscErrorCode FormJacobian(SNES snes, Vec x, Mat J, Mat P, void *ctx)
{
  AppCtx *app    = ctx;
  int32_t status = STICKSLIP_MISSING_ENTRY;
  PetscFunctionBeginUser;
  (void)snes, (void)x, (void)J; /* J is P */
  if (app->values) status = stickslip_mpi_interface_plan_values(app->interface, app->n_contact, app->values + app->n_elastic); /* contact */
  if (status == STICKSLIP_MISSING_ENTRY) {
    PetscCall(Preallocate(app, P));
    status = stickslip_mpi_interface_plan_values(app->interface, app->n_contact, app->values + app->n_elastic); /* contact */
  }
  PetscCallContact(status);
  PetscCall(MatSetValuesCOO(P, app->values, INSERT_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SNES' own test, and then the library's, which says the same on all processes. */
static PetscErrorCode Converged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal snorm, PetscReal fnorm,
                                SNESConvergedReason *reason, void *ctx)
{
  AppCtx               *app = ctx;
  stickslip_equilibrium e   = {.struct_size = sizeof(e), .modulus = YOUNG};
  PetscFunctionBeginUser;
  PetscCall(SNESConvergedDefault(snes, it, xnorm, snorm, fnorm, reason, NULL));
  if (*reason <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallContact(stickslip_mpi_interface_equilibrium(app->interface, &e)); /* contact */
  if (e.gap > CONTACT_RTOL * e.gap_scale || e.traction > CONTACT_RTOL * e.traction_scale || e.slip > CONTACT_RTOL * e.slip_scale)
    *reason = SNES_CONVERGED_ITERATING;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A converged step is reported and committed: friction goes on from there. The states are those before the commit. */
static PetscErrorCode Accept(AppCtx *app, SNES snes, PetscInt step)
{
  PetscInt  its;
  PetscReal sums[9] = {app->contact[0], app->contact[2], app->reaction[0]}; /* then how many are in gap, stick and slip */
  int32_t  *state;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(app->n1, &state));
  const stickslip_states states = {.struct_size = sizeof(states), .state = state};
  PetscCallContact(stickslip_mpi_interface_states(app->interface, &states)); /* contact */
  PetscCallContact(stickslip_mpi_interface_commit(app->interface));          /* contact */
  for (PetscInt a = 0; a < app->n1; a++) sums[3 + state[a]]++;
  PetscCall(PetscFree(state));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 6, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(SNESGetIterationNumber(snes, &its));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "step %d: %d iterations, %d gap %d stick %d slip,", (int)step, (int)its,
                        (int)sums[3 + STICKSLIP_STATE_GAP], (int)sums[3 + STICKSLIP_STATE_STICK], (int)sums[3 + STICKSLIP_STATE_SLIP]));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, " load %.12g contact %.12g %.12g reaction %.12g\n", app->pressed, sums[1], sums[0], sums[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Planes of nodes, and vectors with the next plane as ghosts. */
static PetscErrorCode CreateMesh(PetscInt n, AppCtx *app)
{
  PetscInt all, ghosts, *ghost;
  PetscFunctionBeginUser;
  app->n[0] = app->n[1] = n, app->n[2] = (n + 1) / 2;
  app->multipliers = 3 * (n + 1) * (app->n[2] + 1);
  app->width       = app->multipliers + 3 * (n + 1);
  all              = n + 1;
  app->planes      = PETSC_DECIDE;
  PetscCall(PetscSplitOwnership(PETSC_COMM_WORLD, &app->planes, &all));
  PetscCallMPI(MPI_Scan(&app->planes, &app->first, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  app->first -= app->planes;
  ghosts  = app->first + app->planes <= n && app->planes ? app->width : 0;
  PetscCall(PetscMalloc1(ghosts, &ghost));
  for (PetscInt k = 0; k < ghosts; k++) ghost[k] = (app->first + app->planes) * app->width + k;
  PetscCall(VecCreateGhost(PETSC_COMM_WORLD, app->planes * app->width, PETSC_DETERMINE, ghosts, ghost, &app->u));
  PetscCall(VecDuplicate(app->u, &app->f));
  PetscCall(PetscFree(ghost));
  PetscCall(CreateBottom(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  AppCtx       app = {.friction = 0.3, .load = 40, .push = 0.1};
  PetscInt     n = 6, steps = 10;
  SNES         snes;
  Mat          J;
  Vec          x;
  PetscScalar *u;
  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(DEFAULTS); k++) /* before the command line, which overrides them */
    PetscCall(PetscOptionsSetValue(NULL, DEFAULTS[k][0], DEFAULTS[k][1]));
  PetscCall(PetscInitialize(&argc, &argv, NULL, help));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &app.rank));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-n", &n, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-steps", &steps, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-friction", &app.friction, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-load", &app.load, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-push", &app.push, NULL));
  PetscCheck(n > 1 && steps > 1, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE, "-n and -steps are at least 2");
  PetscCall(CreateMesh(n, &app));
  ElementStiffness(&app);
  PetscCall(CreateContact(&app));
  PetscCall(VecDuplicate(app.u, &x));
  PetscCall(VecGetArray(x, &u));
  for (PetscInt k = 0; k < 3 * app.n1; k++) u[app.multiplier[k] - app.first * app.width] = app.lambda[k];
  PetscCall(VecRestoreArray(x, &u));
  PetscCall(MatCreate(PETSC_COMM_WORLD, &J));
  PetscCall(MatSetSizes(J, app.planes * app.width, app.planes * app.width, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(J, MATAIJ));
  PetscCall(SNESCreate(PETSC_COMM_WORLD, &snes));
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
    PetscCall(Accept(&app, snes, step));
  }
  PetscCallContact(stickslip_mpi_interface_destroy(&app.interface));
  PetscCall(PetscFree5(app.node, app.X, app.below, app.offsets, app.corners));
  PetscCall(PetscFree5(app.multiplier, app.x, app.lambda, app.force, app.rows));
  PetscCall(PetscFree(app.values));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&app.u));
  PetscCall(VecDestroy(&app.f));
  PetscCall(MatDestroy(&J));
  PetscCall(SNESDestroy(&snes));
  return PetscFinalize();
}
