/* The tangent against central differences of the residual, block by block: -test_jacobian_blocks.
 *
 * PETSc's own -snes_test_jacobian compares one Frobenius norm, in which the stiffness of the bodies hides errors of
 * the contact. Here each block stands for itself: rows are the forces and the multiplier rows of the nodes in gap,
 * stick and slip, columns the displacements and the multipliers. Beside a block's norm stands that of the contact's
 * own entries.
 *
 * It runs at every Newton iterate, the solution included, before the step is committed. A difference over a kink means
 * nothing, so the evaluations that find a node in another state are counted: where there are any, judge nothing.
 * One rank; 2 n residuals an iterate. Results: lines on stdout, and `jacobian_tests` of each step in summary.json. */
#include "solve/solve.h"
#include <cjson/cJSON.h>

/* Steps: this times the model's size for displacements, times the stiffest E for multipliers. Truncation grows as its
 * square, and fastest where clipped slivers are small or a slip node has little tangential traction; rounding falls as
 * its inverse. In jacobian_states.yaml the worst block errs by 1e-6, 1e-8, 5e-10, 2e-9 at 1e-5, 1e-6, 1e-7, 3e-8. */
static const PetscReal STEP = 1e-7;

/* Kinds of unknowns: a multiplier by the state of its node, STICKSLIP_STATE_..., or a displacement. */
enum { DISPLACEMENT = 3, N_KINDS };

/* What is summed over a block: (J - Jfd)^2, J^2, and the squares of the contact's part of J. */
enum { ERROR, WHOLE, CONTACT, N_SUMS };

typedef struct {
  PetscInt  n;                        /* unknowns */
  PetscInt *kind;                     /* n */
  PetscReal sums[N_SUMS][N_KINDS][2]; /* of squares, by kind of the row and of the column: displacement, multiplier */
  PetscInt  counts[3], switches;      /* nodes by state; evaluations in which one has another state */
} JacobianTest;

/* Kinds of all unknowns, counts of the states at the last evaluation; with `compare`, only whether a state differs. */
static PetscErrorCode look_at_states(Solve *solve, JacobianTest *test, PetscBool compare)
{
  PetscBool differs = PETSC_FALSE;
  PetscFunctionBegin;
  PetscCall(contact_collect(solve->contact));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++) {
    const Interface *interface = &solve->contact->interfaces[i];
    const int64_t   *equations = MULTIPLIERS_OF(&interface->part, interface->part.equations); /* the only one */
    for (PetscInt a = 0; a < interface->n1; a++) {
      if (!compare) test->counts[interface->states.state[a]]++;
      for (int k = 0; k < interface->components; k++) {
        const int64_t equation = equations[interface->components * a + k];
        if (equation < 0) continue;
        if (compare && test->kind[equation] != interface->states.state[a]) differs = PETSC_TRUE;
        if (!compare) test->kind[equation] = interface->states.state[a];
      }
    }
  }
  if (differs) test->switches++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The whole tangent at x, and the contact's part of it, as dense matrices. */
static PetscErrorCode dense_tangents(Solve *solve, Vec x, Mat *all, Mat *contact)
{
  PetscErrorCode (*tangent)(SNES, Vec, Mat, Mat, void *);
  void    *context;
  PetscInt status;
  Mat      sparse;

  PetscFunctionBegin;
  PetscCall(MatDuplicate(solve->jacobian, MAT_DO_NOT_COPY_VALUES, &sparse));
  PetscCall(MatSetOption(sparse, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscCall(SNESGetJacobian(solve->snes, NULL, NULL, &tangent, &context));
  PetscCall(tangent(solve->snes, x, sparse, sparse, context)); /* SNESComputeJacobian() may want to test its own */
  PetscCall(MatConvert(sparse, MATDENSE, MAT_INITIAL_MATRIX, all));
  PetscCall(MatZeroEntries(sparse));
  PetscCall(contact_tangent(solve->contact, sparse, &status));
  PetscCheck(!status, PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s", solve->contact->refusal);
  PetscCall(MatAssemblyBegin(sparse, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(sparse, MAT_FINAL_ASSEMBLY));
  PetscCall(MatConvert(sparse, MATDENSE, MAT_INITIAL_MATRIX, contact));
  PetscCall(MatDestroy(&sparse));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* f = residual at `base` with `step` added to one unknown; counts a change of state. */
static PetscErrorCode perturbed(Solve *solve, JacobianTest *test, Vec base, PetscInt unknown, PetscReal step, Vec x,
                                Vec f)
{
  PetscFunctionBegin;
  PetscCall(VecCopy(base, x));
  PetscCall(VecSetValue(x, unknown, step, ADD_VALUES));
  PetscCall(VecAssemblyBegin(x));
  PetscCall(VecAssemblyEnd(x));
  PetscCall(SNESComputeFunction(solve->snes, x, f));
  PetscCheck(!solve->outside, PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s", solve->contact->refusal);
  PetscCall(look_at_states(solve, test, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode compare_columns(Solve *solve, JacobianTest *test, Vec base)
{
  const PetscScalar *tangent, *contact, *high, *low;
  Mat                all_matrix, contact_matrix;
  Vec                x, f_high, f_low;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(base, &x));
  PetscCall(VecDuplicate(base, &f_high));
  PetscCall(VecDuplicate(base, &f_low));
  PetscCall(dense_tangents(solve, base, &all_matrix, &contact_matrix));
  PetscCall(MatDenseGetArrayRead(all_matrix, &tangent));
  PetscCall(MatDenseGetArrayRead(contact_matrix, &contact));
  for (PetscInt j = 0; j < test->n; j++) {
    const int       column = test->kind[j] != DISPLACEMENT;
    const PetscReal h      = STEP * (column ? solve->stiffness / solve->size : solve->size);
    PetscCall(perturbed(solve, test, base, j, h, x, f_high));
    PetscCall(perturbed(solve, test, base, j, -h, x, f_low));
    PetscCall(VecGetArrayRead(f_high, &high));
    PetscCall(VecGetArrayRead(f_low, &low));
    for (PetscInt i = 0; i < test->n; i++) {
      const PetscScalar entry = tangent[j * test->n + i], difference = (high[i] - low[i]) / (2 * h);
      test->sums[ERROR][test->kind[i]][column] += PetscSqr(PetscAbsScalar(entry - difference));
      test->sums[WHOLE][test->kind[i]][column] += PetscSqr(PetscAbsScalar(entry));
      test->sums[CONTACT][test->kind[i]][column] += PetscSqr(PetscAbsScalar(contact[j * test->n + i]));
    }
    PetscCall(VecRestoreArrayRead(f_high, &high));
    PetscCall(VecRestoreArrayRead(f_low, &low));
  }
  PetscCall(MatDenseRestoreArrayRead(all_matrix, &tangent));
  PetscCall(MatDenseRestoreArrayRead(contact_matrix, &contact));
  PetscCall(MatDestroy(&all_matrix));
  PetscCall(MatDestroy(&contact_matrix));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&f_high));
  PetscCall(VecDestroy(&f_low));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One block: rows of the kinds in the mask (bit k: kind k). */
static PetscErrorCode report_block(const Solve *solve, const JacobianTest *test, const char *rows, int mask, int column,
                                   cJSON *blocks)
{
  static const char *const names[N_SUMS] = {"error", "norm", "contact_norm"};
  const char *const        columns       = column ? "multiplier" : "displacement";
  PetscReal                norms[N_SUMS] = {0};
  cJSON                   *json          = cJSON_CreateObject();

  PetscFunctionBegin;
  cJSON_AddStringToObject(json, "rows", rows);
  cJSON_AddStringToObject(json, "columns", columns);
  for (int s = 0; s < N_SUMS; s++) {
    for (int kind = 0; kind < N_KINDS; kind++) {
      if (mask & (1 << kind)) norms[s] += test->sums[s][kind][column];
    }
    norms[s] = PetscSqrtReal(norms[s]);
    cJSON_AddNumberToObject(json, names[s], norms[s]);
  }
  cJSON_AddItemToArray(blocks, json);
  if (!solve->quiet)
    PetscCall(PetscPrintf(PETSC_COMM_SELF,
                          "       rows %-10s  columns %-12s  |J - Jfd| %.2e  |J| %.2e  of contact %.2e\n", rows,
                          columns, (double)norms[ERROR], (double)norms[WHOLE], (double)norms[CONTACT]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode report(const Solve *solve, const JacobianTest *test, PetscInt iteration)
{
  static const struct {
    const char *name;
    int         mask;
  } rows[] = {
      {"force",      1 << DISPLACEMENT         },
      {"multiplier", (1 << DISPLACEMENT) - 1   },
      {"gap",        1 << STICKSLIP_STATE_GAP  },
      {"stick",      1 << STICKSLIP_STATE_STICK},
      {"slip",       1 << STICKSLIP_STATE_SLIP },
  };
  static const char *const state_names[] = {"gap", "stick", "slip"};
  cJSON                   *json          = cJSON_CreateObject(), *blocks;

  PetscFunctionBegin;
  cJSON_AddNumberToObject(json, "iteration", (double)iteration);
  for (int s = 0; s < 3; s++)
    cJSON_AddNumberToObject(json, state_names[s], (double)test->counts[s]);
  cJSON_AddNumberToObject(json, "switches", (double)test->switches);
  if (!solve->quiet)
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "     iterate %d: %d gap %d stick %d slip, %d evaluations beyond a kink\n",
                          (int)iteration, (int)test->counts[STICKSLIP_STATE_GAP],
                          (int)test->counts[STICKSLIP_STATE_STICK], (int)test->counts[STICKSLIP_STATE_SLIP],
                          (int)test->switches));
  blocks = cJSON_AddArrayToObject(json, "blocks");
  for (size_t r = 0; r < sizeof(rows) / sizeof(rows[0]); r++) {
    for (int column = 0; column < 2; column++)
      PetscCall(report_block(solve, test, rows[r].name, rows[r].mask, column, blocks));
  }
  cJSON_AddItemToArray(solve->jacobian_tests, json);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode monitor(SNES snes, PetscInt iteration, PetscReal norm, void *context)
{
  Solve       *solve = context;
  JacobianTest test  = {0};
  Vec          x, f;

  PetscFunctionBegin;
  (void)norm;
  if (!solve->jacobian_tests) solve->jacobian_tests = cJSON_CreateArray();
  PetscCall(SNESGetSolution(snes, &x));
  PetscCall(VecDuplicate(x, &f));
  PetscCall(VecGetSize(x, &test.n));
  PetscCall(PetscMalloc1(test.n, &test.kind));
  for (PetscInt k = 0; k < test.n; k++)
    test.kind[k] = DISPLACEMENT;
  PetscCall(SNESComputeFunction(snes, x, f));
  PetscCall(look_at_states(solve, &test, PETSC_FALSE));
  PetscCall(compare_columns(solve, &test, x));
  PetscCall(report(solve, &test, iteration));
  PetscCall(SNESComputeFunction(snes, x, f)); /* the model is at the iterate again */
  PetscCall(PetscFree(test.kind));
  PetscCall(VecDestroy(&f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode jacobian_test_create(Solve *solve, Scene *scene)
{
  PetscBool   wanted = PETSC_FALSE;
  PetscMPIInt ranks;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-test_jacobian_blocks", &wanted, NULL));
  if (!wanted) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  if (ranks > 1) scene_fail(scene, NULL, "test_jacobian_blocks", "this test runs on one rank only.");
  if (solve->contact->condensed)
    scene_fail(scene, NULL, "test_jacobian_blocks", "this test looks at multipliers; take 'unknowns: multipliers'.");
  PetscCall(SNESMonitorSet(solve->snes, monitor, solve, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}
