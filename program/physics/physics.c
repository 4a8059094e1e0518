/* The end of what physics.h declares. */
#include "physics/dynamics.h"
#include "physics/fluid.h"

static PetscErrorCode destroy_unknowns(Unknowns *unknowns)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(unknowns->fields));
  PetscCall(PetscFree(unknowns->owner));
  PetscCall(PetscFree(unknowns->ghost));
  PetscCall(PetscSFDestroy(&unknowns->ghosts));
  PetscCall(PetscSectionDestroy(&unknowns->section));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode physics_destroy(Physics *physics)
{
  Cells *cells = &physics->cells;
  Parts *parts = &physics->parts;

  PetscFunctionBegin;
  if (physics->unknowns.equations) {
    ISLocalToGlobalMapping mapping;
    PetscCall(DMGetLocalToGlobalMapping(physics->mesh->dm, &mapping));
    PetscCall(ISLocalToGlobalMappingRestoreIndices(mapping, &physics->unknowns.equations));
  }
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    PetscCall(PetscFree(physics->supports[s].given));
    PetscCall(PetscFree(physics->supports[s].curve.points));
    PetscCall(PetscFree(physics->supports[s].rotate_curve.points));
  }
  for (PetscInt l = 0; l < physics->n_loads; l++) {
    PetscCall(PetscFree(physics->loads[l].curve.points));
    PetscCall(PetscFree(physics->loads[l].surfaces));
    PetscCall(PetscFree(physics->loads[l].bodies));
    PetscCall(fluid_destroy(&physics->loads[l]));
    PetscCall(PetscFree(physics->loads[l].faces));
    PetscCall(VecDestroy(&physics->loads[l].forces));
  }
  PetscCall(rigids_destroy(physics));
  PetscCall(dynamics_destroy(physics));
  PetscCall(springs_destroy(physics));
  PetscCall(timed_destroy(physics));
  PetscCall(PetscFree(physics->supports));
  PetscCall(PetscFree(physics->loads));
  PetscCall(PetscFree(physics->materials));
  PetscCall(PetscFree(physics->prescribed));
  PetscCall(PetscFree(physics->ranges));
  PetscCall(PetscFree2(parts->part, parts->squares));
  PetscCall(PetscFree(parts->of_piece));
  PetscCall(PetscFree(parts->of_vertex));
  PetscCall(PetscFree(parts->group_starts));
  PetscCall(PetscFree(parts->grouped));
  PetscCall(PetscFree6(cells->offsets, cells->dofs, cells->body, cells->part, cells->X, cells->stiffness));
  PetscCall(PetscFree(cells->swell));
  PetscCall(VecDestroy(&physics->u_local));
  PetscCall(VecDestroy(&physics->f_local));
  PetscCall(VecDestroy(&physics->f_external));
  PetscCall(VecDestroy(&physics->f_thermal));
  PetscCall(VecDestroy(&physics->prescribed_local));
  PetscCall(VecDestroy(&physics->f_sum));
  PetscCall(destroy_unknowns(&physics->unknowns));
  PetscFunctionReturn(PETSC_SUCCESS);
}
