/* Newton's first iterate with `dynamics`: bodies of finite strain that turn. Places that are extrapolated along lines strain what turns by the square
 * of its turn in a step. So the last step's motion of each part is split: that of a rigid body, which goes on as it is, and the rest, which goes on
 * along lines that turn with it.
 *
 * This chooses where Newton's method starts, not what it solves. */
#include "physics/dynamics.h"
#include "solve/solve.h"

/* From this turn in a step on [rad]: below, lines strain by 1e-6. */
static const PetscReal TURNS = 1e-3;
/* Nodes on a line have no turn about it: determinant of the moments of inertia over the cube of their trace. */
static const PetscReal LINE = 1e-9;

/* Of a part's free nodes, as often as cells have them, with x the mean of both places and d the way between them: sums; then the middle of
 * x, the mean way, and the vector tau of the rotation, for which the way is a + tau x (x - middle) */
typedef struct {
  PetscReal n, x[3], d[3], xx[9], xd[9];
} Sums;
enum { SUMS = sizeof(Sums) / sizeof(PetscReal) };
typedef struct {
  PetscReal middle[3], way[3], tau[3], angle;
} Motion;

/* Displacements of the last two states, in local vectors, zero where they are prescribed */
typedef struct {
  const PetscScalar *last, *before;
} States;

/* Place and way of a node in the last step; false: it is held. */
static PetscBool look_at(const Physics *physics, const States *states, PetscInt node, PetscReal x[3], PetscReal d[3])
{
  const Cells   *cells = &physics->cells;
  const PetscInt dof   = cells->dofs[node];
  PetscBool      free  = PETSC_TRUE;
  for (int i = 0; i < 3; i++) {
    const PetscReal last = PetscRealPart(states->last[dof + i]), before = PetscRealPart(states->before[dof + i]);
    x[i] = cells->X[3 * node + i] + (last + before) / 2;
    d[i] = last - before;
    free = (PetscBool)(free && (i >= physics->mesh->dimension || !entry_held(physics, dof + i)));
  }
  return free;
}

static PetscErrorCode add_up(const Physics *physics, const States *states, Sums sums[])
{
  const Cells *cells = &physics->cells;
  PetscFunctionBegin;
  for (PetscInt c = 0; c < cells->n; c++) {
    Sums *sum = &sums[cells->part[c]];
    for (PetscInt k = cells->offsets[c]; k < cells->offsets[c + 1]; k++) {
      PetscReal x[3], d[3];
      if (!look_at(physics, states, k, x, d)) continue;
      sum->n++;
      for (int i = 0; i < 3; i++) {
        sum->x[i] += x[i];
        sum->d[i] += d[i];
        for (int j = 0; j < 3; j++) {
          sum->xx[3 * i + j] += x[i] * x[j];
          sum->xd[3 * i + j] += x[i] * d[j];
        }
      }
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, (PetscMPIInt)(SUMS * physics->parts.n), MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rigid motion that is nearest to the ways; angle 0: it does not turn, or nobody knows how. */
static Motion motion_of(const Sums *sum)
{
  Motion    motion = {.angle = 0};
  PetscReal J[9], C[9], moment[3], det = 0, trace, squared = 0;
  if (sum->n < 2) return motion;
  for (int i = 0; i < 3; i++) {
    motion.middle[i] = sum->x[i] / sum->n;
    motion.way[i]    = sum->d[i] / sum->n;
  }
  for (int k = 0; k < 9; k++)
    C[k] = sum->xx[k] - sum->n * motion.middle[k / 3] * motion.middle[k % 3];
  trace = C[0] + C[4] + C[8];
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    moment[i] = (sum->xd[3 * j + k] - sum->xd[3 * k + j]) - (motion.middle[j] * sum->d[k] - motion.middle[k] * sum->d[j]);
  }
  for (int k = 0; k < 9; k++)
    J[k] = (k % 4 == 0) * trace - C[k];
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) { /* cofactors: J is symmetric */
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      C[3 * i + j] = J[3 * i1 + j1] * J[3 * i2 + j2] - J[3 * i1 + j2] * J[3 * i2 + j1];
    }
  }
  for (int i = 0; i < 3; i++)
    det += J[i] * C[i];
  if (!(det > LINE * trace * trace * trace)) return motion;
  for (int i = 0; i < 3; i++) {
    motion.tau[i] = (C[3 * i] * moment[0] + C[3 * i + 1] * moment[1] + C[3 * i + 2] * moment[2]) / det;
    squared += PetscSqr(motion.tau[i]);
  }
  motion.angle = 2 * PetscAtanReal(PetscSqrtReal(squared) / 2);
  return motion;
}

/* y turned by so much about tau */
static void turn(const Motion *motion, PetscReal angle, const PetscReal y[3], PetscReal turned[3])
{
  const PetscReal length = 2 * PetscTanReal(motion->angle / 2), c = PetscCosReal(angle), s = PetscSinReal(angle);
  PetscReal       n[3], across[3], along = 0;
  for (int i = 0; i < 3; i++) {
    n[i] = motion->tau[i] / length;
    along += n[i] * y[i];
  }
  space_cross(n, y, across);
  for (int i = 0; i < 3; i++)
    turned[i] = c * y[i] + s * across[i] + (1 - c) * along * n[i];
}

/* Displacement of a node after `factor` times the last step */
static void carry_on(const Motion *motion, PetscReal factor, const PetscReal X[3], const PetscReal x[3], const PetscReal d[3], PetscScalar u[3])
{
  PetscReal arm[3], rest[3], from_middle[3], turned[3], turned_rest[3];
  for (int i = 0; i < 3; i++)
    arm[i] = x[i] - motion->middle[i];
  space_cross(motion->tau, arm, rest);
  for (int i = 0; i < 3; i++) {
    rest[i]        = d[i] - motion->way[i] - rest[i];
    from_middle[i] = arm[i] + (d[i] - motion->way[i]) / 2;
  }
  turn(motion, factor * motion->angle, from_middle, turned);
  turn(motion, (1 + factor) / 2 * motion->angle, rest, turned_rest);
  for (int i = 0; i < 3; i++)
    u[i] = motion->middle[i] + (0.5 + factor) * motion->way[i] + turned[i] + factor * turned_rest[i] - X[i];
}

static PetscErrorCode place(const Physics *physics, const States *states, const Sums sums[], PetscReal factor, PetscScalar *u)
{
  const Cells *cells = &physics->cells;
  PetscFunctionBegin;
  for (PetscInt c = 0; c < cells->n; c++) {
    const Motion motion = motion_of(&sums[cells->part[c]]);
    if (!physics->materials[cells->body[c]].law->finite || motion.angle < TURNS || physics->mesh->space.kind == SPACE_AXISYMMETRIC) continue; /* a ring does not turn */
    for (PetscInt k = cells->offsets[c]; k < cells->offsets[c + 1]; k++) {
      PetscReal x[3], d[3];
      if (look_at(physics, states, k, x, d)) carry_on(&motion, factor, cells->X + 3 * k, x, d, u + cells->dofs[k]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x: extrapolated along lines from the last two states, by `factor` times the step between them */
PetscErrorCode turn_on(const Solve *solve, const Past *past, PetscReal factor, Vec x)
{
  const Physics *physics = solve->physics;
  DM             dm      = solve->mesh->dm;
  Vec            last, before, now;
  States         states;
  Sums          *sums;
  PetscScalar   *u;
  PetscFunctionBegin;
  if (!physics->dynamics) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(physics->parts.n, &sums));
  PetscCall(VecDuplicate(physics->u_local, &last));
  PetscCall(VecDuplicate(physics->u_local, &before));
  PetscCall(VecDuplicate(physics->u_local, &now));
  PetscCall(VecZeroEntries(last));
  PetscCall(VecZeroEntries(before));
  PetscCall(VecZeroEntries(now));
  PetscCall(DMGlobalToLocal(dm, past->last, INSERT_VALUES, last));
  PetscCall(DMGlobalToLocal(dm, past->before, INSERT_VALUES, before));
  PetscCall(DMGlobalToLocal(dm, x, INSERT_VALUES, now));
  PetscCall(VecGetArrayRead(last, &states.last));
  PetscCall(VecGetArrayRead(before, &states.before));
  PetscCall(VecGetArray(now, &u));
  PetscCall(add_up(physics, &states, sums));
  PetscCall(place(physics, &states, sums, factor, u));
  mass_follow(physics, states.last, u);
  PetscCall(VecRestoreArray(now, &u));
  PetscCall(VecRestoreArrayRead(before, &states.before));
  PetscCall(VecRestoreArrayRead(last, &states.last));
  PetscCall(DMLocalToGlobal(dm, now, INSERT_VALUES, x));
  PetscCall(VecDestroy(&now));
  PetscCall(VecDestroy(&before));
  PetscCall(VecDestroy(&last));
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}
