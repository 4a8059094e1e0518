/* Fluids as the scene has them: `into` and `outlet` of a pressure. */
#include "physics/fluid.h"
#include <string.h>

/* The surfaces of a list of names, or of one. */
static PetscErrorCode find(Scene *scene, const Physics *physics, const char *map, const char *key, PetscInt *n, const Surface ***surfaces)
{
  char   **names;
  PetscInt more;
  PetscFunctionBegin;
  scene_strings(scene, map, key, &more, &names);
  PetscCall(PetscRealloc((size_t)(*n + more) * sizeof(**surfaces), surfaces));
  for (PetscInt k = 0; k < more; k++) {
    const Surface *surface = mesh_surface(scene, physics->mesh, map, key, names[k]);
    if (surface->analytic && !strcmp(key, "outlet"))
      scene_fail(scene, map, key, "'%s' is of an analytic shape, which has no faces that a fluid could come to.", names[k]);
    if (!surface->analytic) (*surfaces)[(*n)++] = surface; /* it does not move by what presses it */
  }
  strings_destroy(more, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of a rigid body, on any rank; its reference point would have to be pressed */
static PetscErrorCode refuse_rigid(Scene *scene, const Physics *physics, const char *load, const char *interface, const Surface *side)
{
  char     text[512];
  PetscInt bad = -1;
  PetscFunctionBegin;
  if (side->n_faces && rigids_of_vertex(physics, physics->mesh->numbers[side->vertices[0]]) >= 0) bad = 0;
  PetscCall(PetscSNPrintf(text, sizeof(text),
                          "'%s' is a side of '%s' and rigid: a pressure presses deformable bodies. Make the side of an analytic shape, or give its body a modulus.",
                          side->name, interface));
  PetscCall(scene_fail_first(scene, bad, load, "into", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What holds together lets nothing between, whatever pulls at it. */
static void refuse_interface(Scene *scene, const char *load, const char *interface)
{
  char law[NAME_LENGTH] = "";
  scene_string(scene, interface, "law", law, sizeof(law));
  if (!strcmp(law, "tied")) scene_fail(scene, load, "into", "'%s' is tied: nothing gets between its sides.", interface);
  if (scene_has(scene, interface, "bond_stiffness"))
    scene_fail(scene, load, "into", "'%s' is bonded, and where a fluid gets into a bond is not modelled.", interface);
}

PetscErrorCode fluid_read(Scene *scene, const Physics *physics, Load *load)
{
  static const char *const sides[] = {"nonmortar", "mortar"};
  char   **into;
  PetscInt n, before;
  Fluid   *fluid;
  PetscFunctionBegin;
  if (!scene_has(scene, load->name, "into")) {
    if (scene_has(scene, load->name, "outlet"))
      scene_fail(scene, load->name, "outlet", "it is of a pressure that gets between surfaces: say `into`, with the names of interfaces.");
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (load->pressure == 0) scene_fail(scene, load->name, "into", "only a `pressure` gets between surfaces.");
  if (load->pressure < 0) scene_fail(scene, load->name, "pressure", "what gets between surfaces (`into`) presses: it is positive.");
  if (scene_has(scene, load->name, "follower") && !load->follows)
    scene_fail(scene, load->name, "follower", "a pressure that gets between surfaces (`into`) follows them: leave this out.");
  load->follows = PETSC_TRUE;
  PetscCall(PetscNew(&fluid));
  load->fluid  = fluid;
  fluid->leaks = -1;
  scene_strings(scene, load->name, "into", &n, &into);
  for (PetscInt i = 0; i < n; i++) {
    for (int side = 0; side < 2; side++) {
      if (!scene_has(scene, into[i], sides[side]))
        scene_fail(scene, load->name, "into", "there is no interface '%s' with a `%s` side; with `contact: all` no fluid gets between the bodies.",
                   into[i], sides[side]);
      refuse_interface(scene, load->name, into[i]);
      before = fluid->n_sides;
      PetscCall(find(scene, physics, into[i], sides[side], &fluid->n_sides, &fluid->sides));
      for (PetscInt k = before; k < fluid->n_sides; k++)
        PetscCall(refuse_rigid(scene, physics, load->name, into[i], fluid->sides[k]));
    }
  }
  strings_destroy(n, &into);
  PetscCall(find(scene, physics, load->name, "outlet", &fluid->n_outlets, &fluid->outlets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode label_faces(const Physics *physics, const char *kind, const char *name, PetscInt n, const Surface *const surfaces[])
{
  char label[2 * NAME_LENGTH];
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(label, sizeof(label), "%s.%s", kind, name));
  PetscCall(plex_label_faces(physics->mesh, label, NULL));
  for (PetscInt k = 0; k < n; k++)
    PetscCall(plex_label_faces(physics->mesh, label, surfaces[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode fluid_label(const Physics *physics, const Load *load)
{
  const Fluid *fluid = load->fluid;
  PetscFunctionBegin;
  if (!fluid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(label_faces(physics, "fluid", load->name, fluid->n_sides, fluid->sides));
  PetscCall(label_faces(physics, "outlet", load->name, fluid->n_outlets, fluid->outlets));
  PetscFunctionReturn(PETSC_SUCCESS);
}
