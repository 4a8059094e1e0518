/* Supports as the scene describes them: of a surface, a whole body, the vertices of a body within a box, or a vertex. */
#include "physics/physics.h"
#include <string.h>

static PetscErrorCode select_vertices(Scene *scene, Physics *physics, Support *support)
{
  const Mesh *mesh = physics->mesh;
  const char *name = support->name;
  PetscInt    n;
  char      **list;
  PetscReal   box[6];
  PetscBool  *chosen;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(mesh->n_vertices, &chosen));
  if (scene_has(scene, name, "surface")) {
    scene_strings(scene, name, "surface", &n, &list);
    for (PetscInt k = 0; k < n; k++) {
      const Surface *surface = mesh_surface(scene, mesh, name, "surface", list[k]);
      for (PetscInt j = 0; j < surface->offsets[surface->n_faces]; j++)
        chosen[surface->vertices[j]] = PETSC_TRUE;
    }
    strings_destroy(n, &list);
  } else if (scene_has(scene, name, "point")) {
    chosen[mesh_nearest_vertex(scene, mesh, name)] = PETSC_TRUE;
  } else if (scene_has(scene, name, "body")) {
    const PetscBool within = scene_vector(scene, name, "within", 6, box);
    scene_strings(scene, name, "body", &n, &list);
    for (PetscInt k = 0; k < n; k++) {
      const Body *body = &mesh->bodies[mesh_body(scene, mesh, name, "body", list[k])];
      for (PetscInt v = body->first_vertex; v < body->end_vertex; v++) {
        chosen[v] = PETSC_TRUE;
        for (int i = 0; i < 3 && within; i++) {
          if (mesh->coordinates[3 * v + i] < box[i] || mesh->coordinates[3 * v + i] > box[3 + i])
            chosen[v] = PETSC_FALSE;
        }
      }
    }
    strings_destroy(n, &list);
  } else {
    scene_fail(scene, name, "surface",
               "say what is supported: a surface, or a body (with point, or within, for a part of it).");
  }
  PetscCall(PetscMalloc1(mesh->n_vertices, &support->vertices));
  for (PetscInt v = 0; v < mesh->n_vertices; v++) {
    if (chosen[v]) support->vertices[support->n_vertices++] = v;
  }
  if (!support->n_vertices) scene_fail(scene, name, "within", "no vertex lies in this box.");
  PetscCall(PetscFree(chosen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two supports may share a vertex and a component only if they say the same. */
static PetscErrorCode check_overlaps(Scene *scene, Physics *physics)
{
  const Mesh *mesh = physics->mesh;
  PetscInt   *first;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * mesh->n_vertices, &first));
  for (PetscInt k = 0; k < 3 * mesh->n_vertices; k++)
    first[k] = -1;
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const Support *support = &physics->supports[s];
    for (PetscInt k = 0; k < support->n_vertices; k++) {
      const PetscInt   v = support->vertices[k];
      const PetscReal *X = mesh->coordinates + 3 * v;
      for (int i = 0; i < 3; i++) {
        const Support *earlier;
        if (!(support->mask & (1 << i))) continue;
        physics->prescribed[v] |= 1 << i;
        if (first[3 * v + i] < 0) {
          first[3 * v + i] = s;
          continue;
        }
        earlier = &physics->supports[first[3 * v + i]];
        if (!supports_agree(physics, support, earlier, v, i))
          scene_fail(scene, support->name, "components",
                     "u_%c of the vertex at [%g, %g, %g] is prescribed differently by '%s'.", 'x' + i, (double)X[0],
                     (double)X[1], (double)X[2], earlier->name);
      }
    }
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body without a mesh is rigid: nothing but a support says where it is. */
static PetscErrorCode check_analytic(Scene *scene, const Physics *physics)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < physics->mesh->n_bodies; b++) {
    const Body *body = &physics->mesh->bodies[b];
    for (PetscInt v = body->first_vertex; v < body->end_vertex && body->analytic; v++) {
      if (physics->prescribed[v] != 7)
        scene_fail(scene, body->name, NULL, "an analytic body needs a support: {body: %s, components: [x, y, z]}.",
                   body->name);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode supports_read(Scene *scene, Physics *physics)
{
  const Mesh *mesh = physics->mesh;
  char      **names;

  PetscFunctionBegin;
  scene_names(scene, "supports", &physics->n_supports, &names);
  PetscCall(PetscCalloc1(physics->n_supports, &physics->supports));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    Support *support = &physics->supports[s];
    PetscInt n;
    char   **components;
    PetscCall(PetscSNPrintf(support->name, NAME_LENGTH, "%s", names[s]));
    scene_strings(scene, support->name, "components", &n, &components);
    for (PetscInt k = 0; k < n; k++) {
      if (strlen(components[k]) != 1 || components[k][0] < 'x' || components[k][0] > 'z')
        scene_fail(scene, support->name, "components", "'%s' is not allowed; choose from: x, y, z.", components[k]);
      support->mask |= 1 << (components[k][0] - 'x');
    }
    strings_destroy(n, &components);
    if (!support->mask) scene_fail(scene, support->name, "components", "this key is missing; choose from: x, y, z.");
    if (mesh->rotated && support->mask != 7)
      scene_fail(scene, support->name, "components",
                 "in a rotated frame a support must prescribe all of x, y, z (with `value` or `gradient`).");
    scene_vector(scene, support->name, "value", 3, support->value);
    scene_vector(scene, support->name, "gradient", 9, support->gradient);
    scene_vector(scene, support->name, "rotate", 3, support->rotate);
    scene_vector(scene, support->name, "origin", 3, support->origin);
    PetscCall(curve_read(scene, support->name, "curve", physics->end, &support->curve));
    if (scene_has(scene, support->name, "rotate_curve"))
      PetscCall(curve_read(scene, support->name, "rotate_curve", physics->end, &support->rotate_curve));
    else
      PetscCall(curve_copy(&support->curve, &support->rotate_curve));
  }
  strings_destroy(physics->n_supports, &names);
  scene_root_begin(scene);
  if (mesh->rank == 0) {
    PetscCall(PetscCalloc1(mesh->n_vertices, &physics->prescribed));
    for (PetscInt s = 0; s < physics->n_supports; s++) {
      PetscCall(select_vertices(scene, physics, &physics->supports[s]));
      PetscCall(supports_file_read(scene, mesh, &physics->supports[s]));
    }
    PetscCall(check_overlaps(scene, physics));
    PetscCall(check_analytic(scene, physics));
  }
  PetscCall(scene_root_end(scene));
  for (PetscInt s = 0; s < physics->n_supports; s++)
    PetscCall(supports_file_share(mesh, &physics->supports[s]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
