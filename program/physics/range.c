/* Do bodies with the material `linear` stay where it is right? Its strain is sym grad u, which is wrong in two ways:
 *
 *   strain    areas and lengths are those of the undeformed body: forces are off by about the strain itself;
 *   rotation  a turn by theta, without any stretch, counts as a strain of 1 - cos(theta): stresses are off by about this
 *             over the largest strain that there is.
 *
 * Both are measured at the centres of the cells: F = R U, strain = max |eigenvalue of U - 1|, theta the angle of R. Cells
 * of which every vertex is prescribed do not count: their stresses act on nothing. */
#include "physics/physics.h"
#include <cjson/cJSON.h>
#include <petscblaslapack.h>

/* Beyond a strain of 3 per cent forces are off by two to three per cent (a roller on a block at 5 per cent: 3 to 4), more
 * than a mesh of ordinary fineness is. */
static const PetscReal STRAIN_LIMIT = 0.03;
/* A strain that a rotation makes may be so much of the largest real one: turns at the rim of a contact are local. */
static const PetscReal ROTATION_SHARE = 0.1;
/* Strains made by rotations below this are not told: what is left of a body that moves without stress is its rounding. */
static const PetscReal FAINT = 1e-8;

/* F = R U: largest |stretch - 1| and the angle of R; a cell turned inside out counts as strained wholly */
static PetscErrorCode decompose(const PetscReal H[9], PetscReal *strain, PetscReal *angle)
{
  PetscReal    F[9], C[9] = {0}, values[3], inverse[9] = {0}, R[9] = {0}, work[24], axial = 0;
  PetscBLASInt n = 3, n_work = 24, info;

  PetscFunctionBegin;
  *strain = *angle = 0;
  for (int k = 0; k < 9; k++)
    F[k] = H[k] + (k % 4 == 0);
  for (int k = 0; k < 27; k++)
    C[k / 3] += F[3 * (k % 3) + k / 9] * F[3 * (k % 3) + k / 3 % 3];
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &n, C, &n, values, work, &n_work, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK's syev failed");
  if (!(values[0] > PETSC_MACHINE_EPSILON)) {
    *strain = 1;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int k = 0; k < 3; k++) { /* row k of C is now an eigenvector */
    const PetscReal stretch = PetscSqrtReal(values[k]);
    *strain                 = PetscMax(*strain, PetscAbsReal(stretch - 1));
    for (int i = 0; i < 9; i++)
      inverse[i] += C[3 * k + i / 3] * C[3 * k + i % 3] / stretch;
  }
  for (int k = 0; k < 27; k++)
    R[k / 3] += F[3 * (k / 9) + k % 3] * inverse[3 * (k % 3) + k / 3 % 3];
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    axial += PetscSqr(R[3 * l + j] - R[3 * j + l]) / 4;
  }
  *angle = PetscAtan2Real(PetscSqrtReal(axial), (R[0] + R[4] + R[8] - 1) / 2);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Relative error of forces to expect. */
static PetscReal expected_error(const Range *range)
{
  const PetscReal turned = 1 - PetscCosReal(range->rotation);
  return PetscMax(range->strain, turned > FAINT ? turned / PetscMax(range->strain, turned) : 0);
}

static PetscBool leaves(const Range *range)
{
  const PetscReal turned = 1 - PetscCosReal(range->rotation);
  return (PetscBool)(range->strain > STRAIN_LIMIT || (turned > FAINT && turned > ROTATION_SHARE * range->strain));
}

static PetscErrorCode warn(Physics *physics, PetscInt b)
{
  const Range *range = &physics->ranges[b];
  PetscFunctionBegin;
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "stickslip: warning: at t = %.6g %s, whose material is linear, is strained by %.2g and turned "
                         "by %.2g degrees: expect errors of about %.2g in its forces. Give it `material: neo_hooke` "
                         "(or st_venant_kirchhoff, where it turns but is hardly strained), or `small_strain: true` "
                         "if the linear theory is meant.\n",
                         (double)physics->t, physics->mesh->bodies[b].name, (double)range->strain,
                         (double)(range->rotation * 180 / PETSC_PI), (double)expected_error(range)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of this rank's cells, into strain and rotation of each body. */
static PetscErrorCode measure(const Physics *physics, Vec u_local, PetscReal largest[])
{
  const Mesh        *mesh  = physics->mesh;
  const Cells       *cells = &physics->cells;
  const PetscScalar *displacements;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(u_local, &displacements));
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt first = cells->offsets[c], n = cells->offsets[c + 1] - first, b = cells->body[c];
    PetscReal      u[3 * CELL_NODES], H[9], strain, rotation;
    PetscBool      held    = PETSC_TRUE;
    const Element  element = bulk_element(physics, c);
    if (mesh->bodies[b].analytic || mesh->bodies[b].rigid || physics->materials[b].law != &MATERIAL_LINEAR) continue;
    for (PetscInt k = 0; k < 3 * n; k++) {
      const PetscInt dof = cells->dofs[first + k / 3] + k % 3;
      u[k]               = PetscRealPart(displacements[dof]);
      held               = (PetscBool)(held && entry_held(physics, dof));
    }
    if (held) continue;
    cell_centre_gradient(&element, u, H);
    PetscCall(decompose(H, &strain, &rotation));
    largest[2 * b]     = PetscMax(largest[2 * b], strain);
    largest[2 * b + 1] = PetscMax(largest[2 * b + 1], rotation);
  }
  PetscCall(VecRestoreArrayRead(u_local, &displacements));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At a converged state: the largest so far; the first time that a body leaves the range is told. */
PetscErrorCode range_check(Physics *physics, Vec u_local)
{
  const PetscInt n = physics->mesh->n_bodies;
  PetscReal     *largest;
  PetscFunctionBegin;
  if (!physics->ranges) PetscCall(PetscCalloc1(n, &physics->ranges));
  PetscCall(PetscCalloc1(2 * n, &largest));
  PetscCall(measure(physics, u_local, largest));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, (PetscMPIInt)(2 * n), MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  for (PetscInt b = 0; b < n; b++) {
    Range *range    = &physics->ranges[b];
    range->strain   = PetscMax(range->strain, largest[2 * b]);
    range->rotation = PetscMax(range->rotation, largest[2 * b + 1]);
    if (physics->materials[b].small_strain || range->told || !leaves(range)) continue;
    range->told = PETSC_TRUE;
    PetscCall(warn(physics, b));
  }
  PetscCall(PetscFree(largest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* per body with the linear material what it was strained and turned by, and whether that is beyond its range */
PetscErrorCode range_report(const Physics *physics, cJSON *root)
{
  cJSON *all;
  PetscFunctionBegin;
  if (!physics->ranges) PetscFunctionReturn(PETSC_SUCCESS);
  all = cJSON_AddObjectToObject(root, "linear_materials");
  for (PetscInt b = 0; b < physics->mesh->n_bodies; b++) {
    const Body  *body  = &physics->mesh->bodies[b];
    const Range *range = &physics->ranges[b];
    cJSON       *json;
    if (body->analytic || body->rigid || physics->materials[b].law != &MATERIAL_LINEAR) continue;
    json = cJSON_AddObjectToObject(all, body->name);
    cJSON_AddNumberToObject(json, "strain", range->strain);
    cJSON_AddNumberToObject(json, "rotation", range->rotation);
    cJSON_AddNumberToObject(json, "expected_error", expected_error(range));
    cJSON_AddBoolToObject(json, "within_range", !leaves(range));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
