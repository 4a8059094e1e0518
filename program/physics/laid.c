/* Bodies that a step began with laying down (solve/settle.c). They are moved as a whole, and turned. The linear material tells no turn from a
 * strain, and a load keeps its first lever there, so that nothing brings a body that hangs on an edge to rest. From there on such a body has
 * the law of St. Venant and Kirchhoff, which is the linear one where strains are small, and knows turns. */
#include "physics/physics.h"

static PetscBool turn(Physics *physics, PetscInt body)
{
  Material *material = &physics->materials[body];
  if (material->law != &MATERIAL_LINEAR || physics->mesh->bodies[body].rigid) return PETSC_FALSE;
  material->law = &MATERIAL_ST_VENANT_KIRCHHOFF;
  return PETSC_TRUE;
}

PetscBool laid_turn(Physics *physics, PetscInt part)
{
  return turn(physics, mesh_body_of(physics->mesh, physics->parts.part[part].first));
}

PetscErrorCode laid_archive(Physics *physics, Archive *archive)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < physics->mesh->n_bodies; b++) {
    PetscBool turns = (PetscBool)(physics->materials[b].law == &MATERIAL_ST_VENANT_KIRCHHOFF);
    PetscCall(archive_bools(archive, "body.turns", 1, &turns));
    if (turns) (void)turn(physics, b);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
