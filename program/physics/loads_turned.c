/* A pressure without `follower` is a dead load: it keeps the directions that its surface had at first. Where the surface turns, a
 * part of it acts along the surface as it is now. */
#include "physics/physics.h"
#include <cjson/cJSON.h>

/* A turn beyond this is told [rad]: so much of the pressure acts along the surface then. */
static const PetscReal TURNED_TOLD = 0.1;

/* what a pressure of -1 does to the face: its area vector */
static void area_vector(const Physics *physics, const Face *face, PetscReal sum[3])
{
  PetscReal f[3 * FACE_NODES];
  sum[0] = sum[1] = sum[2] = 0;
  face_pressure(face->kind, &physics->mesh->space, face->X, -face->sign, f, NULL);
  for (PetscInt k = 0; k < 3 * face->n; k++)
    sum[k % 3] += f[k];
}

static PetscReal angle(const PetscReal a[3], const PetscReal b[3])
{
  PetscReal across = 0, along = 0;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    across += PetscSqr(a[j] * b[k] - a[k] * b[j]);
    along += a[i] * b[i];
  }
  return PetscAtan2Real(PetscSqrtReal(across), along);
}

/* The largest angle that a face of the load has turned by, of this rank's. */
static PetscErrorCode measure(const Physics *physics, const Load *load, const PetscScalar *u, PetscReal *turned)
{
  PetscFunctionBegin;
  *turned = 0;
  for (PetscInt k = 0; k < load->n_faces; k++) {
    Face      face;
    PetscReal before[3], now[3];
    PetscCall(face_look_at(physics, load->faces[k], &face));
    area_vector(physics, &face, before);
    face_move(&face, u);
    area_vector(physics, &face, now);
    *turned = PetscMax(*turned, angle(before, now));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At a converged state; the first time that it is much is told. */
PetscErrorCode loads_check_turn(Physics *physics, Vec u_local)
{
  const PetscScalar *u;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(u_local, &u));
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    Load     *load = &physics->loads[l];
    PetscReal turned;
    if (load->follows || load->pressure * curve_value(&load->curve, physics->t) == 0) continue;
    PetscCall(measure(physics, load, u, &turned));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &turned, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
    if (turned > TURNED_TOLD && load->turned <= TURNED_TOLD)
      PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                             "stickslip: warning: at t = %.6g the surface under the pressure '%s' has turned by %.2g radians, and the pressure "
                             "has not: without `follower` it keeps the direction of the undeformed surface, and a part of %.2g of it acts along the "
                             "surface as it is now. Give it `follower: true`, or `traction` in place of `pressure` if that is meant.\n",
                             (double)physics->t, load->name, (double)turned, (double)PetscSinReal(PetscMin(turned, PETSC_PI / 2))));
    load->turned = PetscMax(load->turned, turned);
  }
  PetscCall(VecRestoreArrayRead(u_local, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* per pressure that does not follow and whose surface has turned by much, the angle [rad] */
void loads_report_turn(const Physics *physics, cJSON *root)
{
  cJSON *all = NULL;
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    if (physics->loads[l].turned <= TURNED_TOLD) continue;
    if (!all) all = cJSON_AddObjectToObject(root, "pressures_turned");
    cJSON_AddNumberToObject(all, physics->loads[l].name, physics->loads[l].turned);
  }
}
