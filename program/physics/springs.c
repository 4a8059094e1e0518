/* Forces and stiffness of springs (springs.h). */
#include "physics/springs.h"

/* q of each spring with two ends, or one of them and the ground: 3 a spring, the same on all ranks. */
static PetscErrorCode measure(const Springs *springs, const PetscScalar *u, PetscReal q[])
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(q, 3 * springs->n));
  for (PetscInt s = 0; s < springs->n; s++) {
    for (int e = 0; e < 2; e++) {
      const SpringEnd *end = &springs->spring[s].ends[e];
      for (PetscInt k = 0; k < end->n; k++) {
        for (int i = 0; i < 3 && end->nodes[k].at >= 0; i++)
          q[3 * s + i] += (e ? -1 : 1) * end->nodes[k].weight * PetscRealPart(u[end->nodes[k].at + i]);
      }
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, q, (PetscMPIInt)(3 * springs->n), MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The line between the ends; returns its length. */
static PetscReal line_of(const Spring *spring, const PetscReal q[3], PetscReal d[3])
{
  PetscReal squared = 0;
  for (int i = 0; i < 3; i++) {
    d[i] = spring->ends[0].X[i] - spring->ends[1].X[i] + q[i];
    squared += PetscSqr(d[i]);
  }
  return PetscSqrtReal(squared);
}

PetscErrorCode springs_step(Physics *physics, Vec from, Vec to, PetscReal alpha_f)
{
  const Springs     *springs = physics->springs;
  const PetscScalar *u;
  PetscReal         *q, *q_from, d[3];
  PetscFunctionBegin;
  if (!springs) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(3 * springs->n, &q_from, 3 * springs->n, &q));
  PetscCall(VecGetArrayRead(from, &u));
  PetscCall(measure(springs, u, q_from));
  PetscCall(VecRestoreArrayRead(from, &u));
  PetscCall(VecGetArrayRead(to, &u));
  PetscCall(measure(springs, u, q));
  PetscCall(VecRestoreArrayRead(to, &u));
  for (PetscInt s = 0; s < springs->n; s++) {
    Spring         *spring = &springs->spring[s];
    const PetscReal before = line_of(spring, q_from + 3 * s, d), after = line_of(spring, q + 3 * s, d);
    spring->steps          = spring->axial;
    spring->mean           = alpha_f * before + (1 - alpha_f) * after;
    for (int i = 0; i < 3; i++)
      spring->n[i] = after > 0 ? d[i] / after : 0;
  }
  PetscCall(PetscFree2(q_from, q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F, and K = dF/dq unless NULL. Axial: with d the line between the ends of now, l its length, n = d / l,
 * F = k (1 - L / l) d,   K = k (1 - L / l) 1 + k L / l^2 d n^T; in a step of `dynamics` with m for l and n at the end of the step, and K
 * over 1 - alpha_f. */
static void force_of(const Spring *spring, const PetscReal q[3], PetscReal F[3], PetscReal K[9])
{
  PetscReal d[3], length, slack;
  for (int i = 0; i < 3; i++) {
    F[i] = 0;
    for (int j = 0; j < 3; j++)
      F[i] += spring->K[3 * i + j] * q[j];
  }
  if (K) (void)PetscArraycpy(K, spring->K, 9);
  if (!spring->axial) return;
  length = line_of(spring, q, d);
  if (spring->steps) length = spring->mean;
  slack = spring->length > 0 ? spring->length / length : 0; /* without length it is linear */
  for (int i = 0; i < 3; i++) {
    F[i] = spring->stiffness[0] * (1 - slack) * d[i];
    for (int j = 0; j < 3 && K; j++)
      K[3 * i + j] = spring->stiffness[0] * ((1 - slack) * (i == j) + (slack > 0 ? slack * d[i] * (spring->steps ? spring->n[j] : d[j] / length) / length : 0));
  }
}

/* The nodal forces of a face on the ground at u, into f (3 a node) */
static void face_forces(const Spring *spring, const SpringFace *face, const PetscScalar *u, PetscReal f[])
{
  for (PetscInt a = 0; a < face->n; a++) {
    PetscReal mean[3] = {0, 0, 0};
    for (PetscInt b = 0; b < face->n; b++) {
      for (int i = 0; i < 3; i++)
        mean[i] += face->M[face->n * a + b] * PetscRealPart(u[face->dofs[b] + i]);
    }
    for (int i = 0; i < 3; i++)
      f[3 * a + i] = spring->K[3 * i] * mean[0] + spring->K[3 * i + 1] * mean[1] + spring->K[3 * i + 2] * mean[2];
  }
}

static void add_faces(Spring *spring, const PetscScalar *u, PetscScalar *forces)
{
  for (int i = 0; i < 3; i++)
    spring->force[i] = 0;
  for (PetscInt k = 0; k < spring->n_faces; k++) {
    const SpringFace *face = &spring->faces[k];
    PetscReal         f[3 * FACE_NODES];
    face_forces(spring, face, u, f);
    for (PetscInt j = 0; j < 3 * face->n; j++) {
      forces[face->dofs[j / 3] + j % 3] += f[j];
      spring->force[j % 3] -= f[j];
    }
  }
}

static void add_ends(Spring *spring, const PetscReal q[3], PetscScalar *forces)
{
  PetscReal F[3];
  force_of(spring, q, F, NULL);
  for (int e = 0; e < 2; e++) {
    const SpringEnd *end = &spring->ends[e];
    for (PetscInt k = 0; k < end->n; k++) {
      for (int i = 0; i < 3 && end->nodes[k].at >= 0; i++)
        forces[end->nodes[k].at + i] += (e ? -1 : 1) * end->nodes[k].weight * F[i];
    }
  }
  for (int i = 0; i < 3; i++)
    spring->force[i] = -F[i];
}

PetscErrorCode springs_forces(Physics *physics, Vec f_local)
{
  Springs           *springs = physics->springs;
  const PetscScalar *u;
  PetscScalar       *forces;
  PetscReal         *q;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * springs->n, &q));
  PetscCall(VecZeroEntries(springs->forces));
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  PetscCall(VecGetArray(springs->forces, &forces));
  PetscCall(measure(springs, u, q));
  for (PetscInt s = 0; s < springs->n; s++) {
    if (springs->spring[s].per_area)
      add_faces(&springs->spring[s], u, forces);
    else
      add_ends(&springs->spring[s], q + 3 * s, forces);
  }
  PetscCall(VecRestoreArray(springs->forces, &forces));
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCall(VecAXPY(f_local, 1, springs->forces));
  PetscCall(parts_add_squares(physics, springs->forces, SQUARES_CONTACT, SQUARES_CONTACT)); /* of another body, or the ground */
  PetscCall(parts_add_squares(physics, springs->forces, SQUARES_CARRIED, SQUARES_CARRIED));
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode insert_faces(const Physics *physics, const Spring *spring, Mat matrix)
{
  PetscReal K[9 * FACE_NODES * FACE_NODES];
  PetscFunctionBegin;
  for (PetscInt k = 0; k < spring->n_faces; k++) {
    const SpringFace *face = &spring->faces[k];
    const PetscInt    n    = 3 * face->n;
    PetscInt          equations[3 * FACE_NODES];
    for (PetscInt j = 0; j < n; j++)
      equations[j] = physics->unknowns.equations[face->dofs[j / 3] + j % 3];
    for (PetscInt j = 0; j < n * n; j++)
      K[j] = face->M[face->n * (j / n / 3) + j % n / 3] * spring->K[3 * (j / n % 3) + j % n % 3];
    PetscCall(MatSetValues(matrix, n, equations, n, equations, K, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of the nodes that this rank owns. */
static PetscErrorCode insert_ends(const Spring *spring, const PetscReal K[9], Mat matrix)
{
  PetscFunctionBegin;
  for (int e = 0; e < 4; e++) { /* pairs of ends */
    const SpringEnd *rows = &spring->ends[e / 2], *columns = &spring->ends[e % 2];
    const PetscReal  sign = e / 2 == e % 2 ? 1 : -1;
    for (PetscInt a = 0; a < rows->n; a++) {
      for (PetscInt b = 0; b < columns->n && rows->nodes[a].at >= 0; b++) {
        PetscReal block[9];
        for (int k = 0; k < 9; k++)
          block[k] = sign * rows->nodes[a].weight * columns->nodes[b].weight * K[k];
        PetscCall(MatSetValues(matrix, 3, rows->nodes[a].equations, 3, columns->nodes[b].equations, block, ADD_VALUES));
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode springs_stiffness(Physics *physics, Mat matrix)
{
  const Springs     *springs = physics->springs;
  const PetscScalar *u;
  PetscReal         *q, F[3], K[9];
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * springs->n, &q));
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  PetscCall(measure(springs, u, q));
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  for (PetscInt s = 0; s < springs->n; s++) {
    const Spring *spring = &springs->spring[s];
    force_of(spring, q + 3 * s, F, K);
    if (spring->per_area)
      PetscCall(insert_faces(physics, spring, matrix));
    else
      PetscCall(insert_ends(spring, K, matrix));
  }
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Faces have room already, as their cells have. */
PetscErrorCode springs_pattern(Physics *physics, Mat matrix)
{
  static const PetscReal zeros[9] = {0};
  const Springs         *springs  = physics->springs;
  PetscFunctionBegin;
  for (PetscInt s = 0; s < springs->n; s++)
    PetscCall(insert_ends(&springs->spring[s], zeros, matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode springs_total(Physics *physics)
{
  Springs *springs = physics->springs;
  PetscFunctionBegin;
  for (PetscInt s = 0; s < springs->n; s++) {
    Spring   *spring = &springs->spring[s];
    PetscReal sum[3];
    PetscCall(PetscArraycpy(sum, spring->force, 3));
    if (spring->per_area) PetscCallMPI(MPI_Allreduce(spring->force, sum, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    PetscCall(PetscArraycpy(spring->total, sum, 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of one with two ends: F.q / 2, axial k (l - L)^2 / 2 */
static PetscReal energy_of(const Spring *spring, const PetscReal q[3])
{
  PetscReal F[3], d[3];
  if (spring->axial) return 0.5 * spring->stiffness[0] * PetscSqr(line_of(spring, q, d) - spring->length);
  force_of(spring, q, F, NULL);
  return 0.5 * (F[0] * q[0] + F[1] * q[1] + F[2] * q[2]);
}

/* Those with two ends by rank 0 */
PetscErrorCode springs_energy(const Physics *physics, const PetscScalar *u, PetscReal *energy)
{
  const Springs *springs = physics->springs;
  PetscReal     *q;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * springs->n, &q));
  PetscCall(measure(springs, u, q));
  for (PetscInt s = 0; s < springs->n; s++) {
    const Spring *spring = &springs->spring[s];
    if (!physics->mesh->rank) *energy += energy_of(spring, q + 3 * s);
    for (PetscInt k = 0; k < spring->n_faces; k++) {
      PetscReal f[3 * FACE_NODES];
      face_forces(spring, &spring->faces[k], u, f);
      for (PetscInt j = 0; j < 3 * spring->faces[k].n; j++)
        *energy += 0.5 * f[j] * PetscRealPart(u[spring->faces[k].dofs[j / 3] + j % 3]);
    }
  }
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}
