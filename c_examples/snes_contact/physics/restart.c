/* What a restart file keeps of the physics, and by what it knows the model. */
#include "physics/physics.h"

static uint64_t digest_curve(uint64_t before, const Curve *curve)
{
  return digest(before, (size_t)(2 * curve->n) * sizeof(*curve->points), curve->points);
}

/* Nodes, cells and equations of this rank; curves, one of which may be the ramp up to the end of the steps. */
PetscErrorCode physics_agree(const Physics *physics, Archive *archive)
{
  const Mesh        *mesh  = physics->mesh;
  const Cells       *cells = &physics->cells;
  uint64_t           nodes = DIGEST, curves = DIGEST;
  const PetscScalar *X;
  PetscInt           n;
  Vec                coordinates;

  PetscFunctionBegin;
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &coordinates));
  PetscCall(VecGetLocalSize(coordinates, &n));
  PetscCall(VecGetArrayRead(coordinates, &X));
  nodes = digest(nodes, (size_t)n * sizeof(*X), X);
  PetscCall(VecRestoreArrayRead(coordinates, &X));
  nodes = digest(nodes, (size_t)mesh->n_points * sizeof(*mesh->original), mesh->original);
  nodes = digest(nodes, (size_t)cells->offsets[cells->n] * sizeof(*cells->dofs), cells->dofs);
  nodes = digest(nodes, (size_t)cells->n * sizeof(*cells->body), cells->body);
  nodes = digest(nodes, (size_t)physics->unknowns.n_local * sizeof(*physics->unknowns.equations), physics->unknowns.equations);
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const Support *support = &physics->supports[s];
    curves                 = digest_curve(digest_curve(curves, &support->curve), &support->rotate_curve);
    if (support->given) curves = digest(curves, 3 * (size_t)mesh->n_points * sizeof(*support->given), support->given);
  }
  for (PetscInt l = 0; l < physics->n_loads; l++)
    curves = digest_curve(curves, &physics->loads[l].curve);
  PetscCall(archive_agree(archive, "mesh", nodes, "it is of another mesh, or of another partition of it"));
  PetscCall(archive_agree(archive, "curves", curves,
                          "its curves, or what files prescribe, are not those of this scene (without a `curve` loads and supports grow up "
                          "to the end of the steps: write the curve down where steps go on beyond it)"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode archive_rigid(Rigid *rigid, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(archive_reals(archive, "rigid.turned", 9, rigid->turned));
  PetscCall(archive_reals(archive, "rigid.motion", RIGID_UNKNOWNS, rigid->motion));
  PetscCall(archive_reals(archive, "rigid.sum", 3, rigid->sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode physics_archive(Physics *physics, Archive *archive)
{
  PetscFunctionBegin;
  if (!physics->ranges) PetscCall(PetscCalloc1(physics->mesh->n_bodies, &physics->ranges));
  PetscCall(archive_reals(archive, "t", 1, &physics->t));
  PetscCall(archive_reals(archive, "t_turned", 1, &physics->t_turned));
  for (PetscInt p = 0; p < physics->parts.n; p++)
    PetscCall(archive_reals(archive, "part.felt", 1, &physics->parts.part[p].felt));
  for (PetscInt b = 0; b < physics->mesh->n_bodies; b++) {
    PetscCall(archive_reals(archive, "range.strain", 1, &physics->ranges[b].strain));
    PetscCall(archive_reals(archive, "range.rotation", 1, &physics->ranges[b].rotation));
    PetscCall(archive_bools(archive, "range.told", 1, &physics->ranges[b].told));
  }
  for (PetscInt r = 0; r < physics->n_rigids; r++)
    PetscCall(archive_rigid(&physics->rigids[r], archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}
