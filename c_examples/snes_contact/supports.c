/* Supports: prescribed displacements of a surface, a whole body, the vertices of a body within a box, or one vertex. */
#include "model.h"
#include <string.h>

static PetscErrorCode select_vertices(Model *model, Support *support)
{
  Scene      *scene = model->scene;
  const Mesh *mesh  = &model->mesh;
  const char *name  = support->name;
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

/* X in the axes of the scene file; the result too */
static void prescribed_displacement(const Support *support, const PetscReal X[3], PetscReal u[3])
{
  for (int i = 0; i < 3; i++) {
    u[i] = support->value[i];
    for (int j = 0; j < 3; j++)
      u[i] += support->gradient[3 * i + j] * (X[j] - support->origin[j]);
  }
}

/* Two supports may share a vertex and a component only if they say the same. */
static PetscErrorCode check_overlaps(Model *model)
{
  PetscInt *first;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * model->mesh.n_vertices, &first));
  for (PetscInt k = 0; k < 3 * model->mesh.n_vertices; k++)
    first[k] = -1;
  for (PetscInt s = 0; s < model->n_supports; s++) {
    const Support *support = &model->supports[s];
    for (PetscInt k = 0; k < support->n_vertices; k++) {
      const PetscInt   v = support->vertices[k];
      const PetscReal *X = model->mesh.coordinates + 3 * v;
      PetscReal        u[3], other[3];
      prescribed_displacement(support, X, u);
      for (int i = 0; i < 3; i++) {
        const Support *earlier;
        if (!(support->mask & (1 << i))) continue;
        model->prescribed[v] |= 1 << i;
        if (first[3 * v + i] < 0) {
          first[3 * v + i] = s;
          continue;
        }
        earlier = &model->supports[first[3 * v + i]];
        prescribed_displacement(earlier, X, other);
        if ((u[i] != 0 || other[i] != 0) && (PetscAbsReal(u[i] - other[i]) > 1e-12 * PetscAbsReal(u[i]) ||
                                             !curve_equal(&support->curve, &earlier->curve)))
          scene_fail(model->scene, support->name, "components",
                     "u_%c of the vertex at [%g, %g, %g] is prescribed differently by '%s'.", 'x' + i, (double)X[0],
                     (double)X[1], (double)X[2], earlier->name);
      }
    }
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body without a mesh is rigid: nothing but a support says where it is. */
static PetscErrorCode check_analytic(const Model *model)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < model->mesh.n_bodies; b++) {
    const Body *body = &model->mesh.bodies[b];
    for (PetscInt v = body->first_vertex; v < body->end_vertex && body->analytic; v++) {
      if (model->prescribed[v] != 7)
        scene_fail(model->scene, body->name, NULL, "an analytic body needs a support: {body: %s, components: [x, y, z]}.",
                   body->name);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode supports_read(Model *model)
{
  Scene *scene = model->scene;
  char **names;

  PetscFunctionBegin;
  scene_names(scene, "supports", &model->n_supports, &names);
  PetscCall(PetscCalloc1(model->n_supports, &model->supports));
  for (PetscInt s = 0; s < model->n_supports; s++) {
    Support *support = &model->supports[s];
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
    if (model->mesh.rotated && support->mask != 7)
      scene_fail(scene, support->name, "components",
                 "in a rotated frame a support must prescribe all of x, y, z (with `value` or `gradient`).");
    scene_vector(scene, support->name, "value", 3, support->value);
    if (scene_vector(scene, support->name, "gradient", 9, support->gradient))
      scene_vector(scene, support->name, "origin", 3, support->origin);
    PetscCall(curve_read(scene, support->name, model->steps.end, &support->curve));
  }
  strings_destroy(model->n_supports, &names);
  scene_root_begin(scene);
  if (model->rank == 0) {
    PetscCall(PetscCalloc1(model->mesh.n_vertices, &model->prescribed));
    for (PetscInt s = 0; s < model->n_supports; s++)
      PetscCall(select_vertices(model, &model->supports[s]));
    PetscCall(check_overlaps(model));
    PetscCall(check_analytic(model));
  }
  PetscCall(scene_root_end(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode supports_label(Model *model)
{
  char label[2 * NAME_LENGTH];
  PetscFunctionBegin;
  PetscCall(plex_label_vertices(model->dm, "prescribed", model->mesh.n_vertices, NULL, model->prescribed, 0));
  for (PetscInt s = 0; s < model->n_supports; s++) {
    PetscCall(PetscSNPrintf(label, sizeof(label), "support.%s", model->supports[s].name));
    PetscCall(
        plex_label_vertices(model->dm, label, model->supports[s].n_vertices, model->supports[s].vertices, NULL, 1));
    PetscCall(PetscFree(model->supports[s].vertices));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* calls back for every supported vertex of this rank with the support's displacement there at factor 1 */
typedef void (*VertexVisit)(Support *support, PetscReal factor, const PetscReal u[3], PetscScalar *dofs);

static PetscErrorCode visit(Model *model, Vec local, PetscReal t, VertexVisit action)
{
  PetscSection       coordinate_section;
  Vec                coordinate_vector;
  const PetscScalar *coordinates;
  PetscScalar       *array;
  char               label[2 * NAME_LENGTH];

  PetscFunctionBegin;
  PetscCall(DMGetCoordinateSection(model->dm, &coordinate_section));
  PetscCall(DMGetCoordinatesLocal(model->dm, &coordinate_vector));
  PetscCall(VecGetArrayRead(coordinate_vector, &coordinates));
  PetscCall(VecGetArray(local, &array));
  for (PetscInt s = 0; s < model->n_supports; s++) {
    Support        *support = &model->supports[s];
    const PetscReal factor  = curve_value(&support->curve, t);
    PetscInt        n;
    const PetscInt *points;
    IS              is;
    PetscCall(PetscSNPrintf(label, sizeof(label), "support.%s", support->name));
    PetscCall(DMGetStratumIS(model->dm, label, 1, &is));
    if (!is) continue; /* no such vertex on this rank */
    PetscCall(ISGetLocalSize(is, &n));
    PetscCall(ISGetIndices(is, &points));
    for (PetscInt k = 0; k < n; k++) {
      PetscInt  at, offset;
      PetscReal X[3], u[3];
      PetscCall(PetscSectionGetOffset(coordinate_section, points[k], &at));
      PetscCall(PetscSectionGetOffset(model->section, points[k], &offset));
      for (int i = 0; i < 3; i++) { /* back into the axes of the scene file: Q transposed */
        X[i] = 0;
        for (int j = 0; j < 3; j++)
          X[i] += model->mesh.rotation[3 * j + i] * PetscRealPart(coordinates[at + j]);
      }
      prescribed_displacement(support, X, u);
      mesh_rotate_vector(&model->mesh, u);
      action(support, factor, u, array + offset);
    }
    PetscCall(ISRestoreIndices(is, &points));
    PetscCall(ISDestroy(&is));
  }
  PetscCall(VecRestoreArray(local, &array));
  PetscCall(VecRestoreArrayRead(coordinate_vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void set_values(Support *support, PetscReal factor, const PetscReal u[3], PetscScalar *dofs)
{
  for (int i = 0; i < 3; i++) {
    if (support->mask & (1 << i)) dofs[i] = factor * u[i];
  }
}

static void add_reactions(Support *support, PetscReal factor, const PetscReal u[3], PetscScalar *dofs)
{
  (void)factor, (void)u;
  for (int i = 0; i < 3; i++) {
    if (support->mask & (1 << i)) support->reaction[i] += PetscRealPart(dofs[i]);
  }
}

PetscErrorCode supports_values(Model *model, PetscReal t)
{
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(model->prescribed_local)); /* removed multipliers are prescribed to be zero */
  PetscCall(visit(model, model->prescribed_local, t, set_values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* from the forces of the last evaluation; a component prescribed by two supports counts in both */
PetscErrorCode supports_reactions(Model *model)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < model->n_supports; s++)
    PetscCall(PetscArrayzero(model->supports[s].reaction, 3));
  PetscCall(visit(model, model->f_local, model->t, add_reactions));
  for (PetscInt s = 0; s < model->n_supports; s++)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, model->supports[s].reaction, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
