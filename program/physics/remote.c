/* A force F and a moment M at a point p, spread over surfaces so that they do work on the mean motion of these: with the weights
 * w_a = int N_a dA, W their sum, c the mean place and r_a = X_a - c,
 *
 *   mean displacement  sum w_a u_a / W,      mean turn  T^-1 sum w_a r_a x u_a,      T = sum w_a (r_a.r_a 1 - r_a r_a^T),
 *   f_a = w_a (F / W + (T^-1 (M + (p - c) x F)) x r_a).
 *
 * The surfaces may strain as they like. The forces are dead, on the arms of the undeformed body: a step after which a surface with a moment
 * has turned too far is refused. */
#include "physics/physics.h"

/* The moment of forces whose arms have turned by so many radians is off by this part of it at most. */
static const PetscReal TURNED_TOO_FAR = 0.02;

enum { WEIGHT, PLACE, SQUARES = PLACE + 3, TURN = SQUARES + 6, N_SUMS = TURN + 3 };

typedef struct {
  PetscReal weight, middle[3], T[9], turn[3];
} Spread;

/* T w = m; in the plane about z alone */
static void solve(const Physics *physics, const PetscReal T[9], const PetscReal m[3], PetscReal w[3])
{
  PetscReal rows[3][3], determinant = 0;
  if (physics->mesh->dimension == 2) {
    w[0] = w[1] = 0;
    w[2]        = m[2] / T[8];
    return;
  }
  for (int i = 0; i < 3; i++)
    space_cross(T + 3 * ((i + 1) % 3), T + 3 * ((i + 2) % 3), rows[i]);
  for (int i = 0; i < 3; i++)
    determinant += T[i] * rows[0][i];
  for (int i = 0; i < 3; i++)
    w[i] = (rows[0][i] * m[0] + rows[1][i] * m[1] + rows[2][i] * m[2]) / determinant;
}

/* Calls for each node of this rank's faces: its weight in the face, its place from `from`, its dofs. */
typedef void (*NodeVisit)(PetscReal weight, const PetscReal r[3], PetscInt at, void *context);

static PetscErrorCode visit(const Physics *physics, const Load *load, const PetscReal from[3], NodeVisit action, void *context)
{
  static const PetscReal along[3] = {1, 0, 0};
  PetscFunctionBegin;
  for (PetscInt k = 0; k < load->n_faces; k++) {
    Face      face;
    PetscReal f[3 * FACE_NODES] = {0};
    PetscCall(face_look_at(physics, load->faces[k], &face));
    face_traction(face.kind, &physics->mesh->space, face.X, along, f);
    for (PetscInt a = 0; a < face.n; a++) {
      PetscReal r[3];
      for (int i = 0; i < 3; i++)
        r[i] = face.X[3 * a + i] - from[i];
      action(f[3 * a], r, face.dofs[a], context);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscReal          sums[N_SUMS];
  const PetscScalar *u; /* NULL: no turn is wanted */
} Sums;

static void add_sums(PetscReal weight, const PetscReal r[3], PetscInt at, void *context)
{
  static const int pairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  Sums            *all         = context;
  PetscReal        u[3], turn[3];
  all->sums[WEIGHT] += weight;
  for (int i = 0; i < 3; i++)
    all->sums[PLACE + i] += weight * r[i];
  for (int k = 0; k < 6; k++)
    all->sums[SQUARES + k] += weight * r[pairs[k][0]] * r[pairs[k][1]];
  if (!all->u) return;
  for (int i = 0; i < 3; i++)
    u[i] = PetscRealPart(all->u[at + i]);
  space_cross(r, u, turn);
  for (int i = 0; i < 3; i++)
    all->sums[TURN + i] += weight * turn[i];
}

/* Of all ranks, from a place. */
static PetscErrorCode sum(const Physics *physics, const Load *load, const PetscReal from[3], Sums *all)
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(all->sums, N_SUMS));
  PetscCall(visit(physics, load, from, add_sums, all));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all->sums, N_SUMS, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `u`: displacements, or NULL. The middle first, so that arms far from the origin keep their digits. */
static PetscErrorCode measure(const Physics *physics, const Load *load, const PetscScalar *u, Spread *spread)
{
  static const PetscReal origin[3] = {0, 0, 0};
  Sums                   all       = {.u = NULL};
  const PetscReal       *s         = all.sums + SQUARES;
  PetscFunctionBegin;
  PetscCall(sum(physics, load, origin, &all));
  spread->weight = all.sums[WEIGHT];
  for (int i = 0; i < 3; i++)
    spread->middle[i] = all.sums[PLACE + i] / spread->weight;
  all.u = u;
  PetscCall(sum(physics, load, spread->middle, &all));
  {
    const PetscReal T[9] = {s[1] + s[2], -s[3], -s[5], -s[3], s[0] + s[2], -s[4], -s[5], -s[4], s[0] + s[1]};
    PetscCall(PetscArraycpy(spread->T, T, 9));
  }
  solve(physics, spread->T, all.sums + TURN, spread->turn);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The moment about the middle. */
static void moment_of(const Load *load, const Spread *spread, PetscReal moment[3])
{
  PetscReal arm[3];
  for (int i = 0; i < 3; i++)
    arm[i] = load->given_point ? load->point[i] - spread->middle[i] : 0;
  space_cross(arm, load->force, moment);
  for (int i = 0; i < 3; i++)
    moment[i] += load->moment[i];
}

typedef struct {
  PetscReal    force[3], turn[3]; /* F / W, T^-1 times the moment */
  PetscScalar *forces;
} Nodal;

static void add_forces(PetscReal weight, const PetscReal r[3], PetscInt at, void *context)
{
  const Nodal *nodal = context;
  PetscReal    f[3];
  space_cross(nodal->turn, r, f);
  for (int i = 0; i < 3; i++)
    nodal->forces[at + i] += weight * (nodal->force[i] + f[i]);
}

PetscErrorCode remote_assemble(const Physics *physics, const Load *load, PetscScalar *forces)
{
  Nodal     nodal = {.forces = forces};
  Spread    spread;
  PetscReal moment[3];
  PetscFunctionBegin;
  PetscCall(measure(physics, load, NULL, &spread));
  moment_of(load, &spread, moment);
  solve(physics, spread.T, moment, nodal.turn);
  for (int i = 0; i < 3; i++)
    nodal.force[i] = load->force[i] / spread.weight;
  PetscCall(visit(physics, load, spread.middle, add_forces, &nodal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode remote_check(Physics *physics, char why[], size_t length)
{
  PetscFunctionBegin;
  why[0] = 0;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    const Load        *load = &physics->loads[l];
    const PetscScalar *u;
    PetscReal          moment[3], turn;
    Spread             spread;
    if (!load->remote || curve_value(&load->curve, physics->t) == 0) continue;
    PetscCall(VecGetArrayRead(physics->u_local, &u));
    PetscCall(measure(physics, load, u, &spread));
    PetscCall(VecRestoreArrayRead(physics->u_local, &u));
    moment_of(load, &spread, moment);
    turn = PetscSqrtReal(PetscSqr(spread.turn[0]) + PetscSqr(spread.turn[1]) + PetscSqr(spread.turn[2]));
    if ((moment[0] == 0 && moment[1] == 0 && moment[2] == 0) || turn <= TURNED_TOO_FAR) continue;
    PetscCall(PetscSNPrintf(why, length,
                            "the surface of '%s' has turned by %.2g radians: the arms of its spread forces are those of the undeformed body, "
                            "which may turn by %g; load a rigid body that is tied to it",
                            load->name, (double)turn, (double)TURNED_TOO_FAR));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
