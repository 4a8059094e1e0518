/* The bodies' materials from the scene. */
#include "physics/physics.h"

static PetscErrorCode read_material(Scene *scene, const Space *space, const char *body, Material *material)
{
  static const MaterialLaw *const laws[]        = {&MATERIAL_LINEAR, &MATERIAL_ST_VENANT_KIRCHHOFF,
                                                   &MATERIAL_NEO_HOOKE};
  static const char *const        dilatations[] = {"pointwise", "mean", NULL};
  enum { N_LAWS = sizeof(laws) / sizeof(laws[0]) };
  const char                     *law_names[N_LAWS + 1] = {NULL};
  PetscInt                        law = 0, dilatation = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < N_LAWS; k++) law_names[k] = laws[k]->name;
  scene_real_required(scene, body, "young", &material->young);
  scene_real_required(scene, body, "poisson", &material->poisson);
  scene_real(scene, body, "density", &material->density);
  scene_choice(scene, body, "material", law_names, &law);
  scene_choice(scene, body, "dilatation", dilatations, &dilatation);
  if (dilatation && space->kind == SPACE_PLANE_STRESS)
    scene_fail(scene, body, "dilatation", "in plane stress nothing hinders a change of volume; leave the key out.");
  scene_bool(scene, body, "small_strain", &material->small_strain);
  material->law             = laws[law];
  material->mean_dilatation = (PetscBool)dilatation;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode materials_read(Scene *scene, Physics *physics)
{
  const Mesh *mesh = physics->mesh;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(mesh->n_bodies, &physics->materials));
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    const Body *body          = &mesh->bodies[b];
    physics->materials[b].law = &MATERIAL_LINEAR; /* of an analytic or a rigid body: has no cells with stiffness */
    if (!body->analytic && !body->rigid) PetscCall(read_material(scene, &mesh->space, body->name, &physics->materials[b]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
