/* What a restart file keeps of heat: the temperatures of t_n, and by what it knows curves. */
#include "heat/heat.h"

PetscErrorCode heat_archive(Heat *heat, Archive *archive)
{
  const Mesh        *mesh   = heat->mesh;
  uint64_t           curves = DIGEST;
  const PetscScalar *read, *wide;
  PetscScalar       *before;
  PetscFunctionBegin;
  if (!heat->on) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s < heat->n_supports; s++)
    curves = digest(curves, (size_t)(2 * heat->supports[s].curve.n) * sizeof(PetscReal), heat->supports[s].curve.points);
  PetscCall(archive_agree(archive, "heat.curves", curves,
                          "its curves of heat are others: without a `curve` temperatures and flows grow up to the end of the steps, so write one "
                          "where steps are to go on beyond it"));
  PetscCall(VecGetArrayRead(heat->before, &read));
  PetscCall(heat_widen(heat, read));
  PetscCall(VecRestoreArrayRead(heat->before, &read));
  PetscCall(contact_archive_vector(heat->contact, "temperatures", heat->wide, archive));
  if (!archive->reading || archive->bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(heat->wide, &wide));
  PetscCall(VecGetArray(heat->before, &before));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscInt from, at;
    PetscCall(PetscSectionGetOffset(heat->physics->unknowns.section, mesh->points[k], &from));
    PetscCall(PetscSectionGetOffset(heat->section, mesh->points[k], &at));
    before[at] = wide[from];
  }
  PetscCall(VecRestoreArray(heat->before, &before));
  PetscCall(VecRestoreArrayRead(heat->wide, &wide));
  PetscFunctionReturn(PETSC_SUCCESS);
}
