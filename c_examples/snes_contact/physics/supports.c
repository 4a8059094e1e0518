/* Supports: prescribed displacements of a surface, a whole body, the vertices of a body within a box, or one vertex. */
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

/* Rodrigues: x turned about w by |w| */
static void rotate(const PetscReal w[3], PetscReal x[3])
{
  const PetscReal angle = PetscSqrtReal(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  /* sin a / a and (1 - cos a) / a^2, without cancellation */
  const PetscReal half = PetscSinReal(0.5 * angle), s = angle > 0 ? PetscSinReal(angle) / angle : 1,
                  c = angle > 0 ? 2 * PetscSqr(half / angle) : 0.5;
  PetscReal wx[3], wwx[3];
  for (int i = 0; i < 3; i++)
    wx[i] = w[(i + 1) % 3] * x[(i + 2) % 3] - w[(i + 2) % 3] * x[(i + 1) % 3];
  for (int i = 0; i < 3; i++)
    wwx[i] = w[(i + 1) % 3] * wx[(i + 2) % 3] - w[(i + 2) % 3] * wx[(i + 1) % 3];
  for (int i = 0; i < 3; i++)
    x[i] += s * wx[i] + c * wwx[i];
}

/* at t; X in the axes of the scene file, the result too */
static void prescribed_displacement(const Support *support, PetscReal t, const PetscReal X[3], PetscReal u[3])
{
  const PetscReal factor = curve_value(&support->curve, t), turn = curve_value(&support->rotate_curve, t);
  PetscReal       w[3], x[3];
  for (int i = 0; i < 3; i++) {
    u[i] = support->value[i];
    for (int j = 0; j < 3; j++)
      u[i] += support->gradient[3 * i + j] * (X[j] - support->origin[j]);
    u[i] *= factor;
    x[i] = X[i] - support->origin[i] + u[i];
    w[i] = turn * support->rotate[i];
  }
  if (w[0] == 0 && w[1] == 0 && w[2] == 0) return;
  rotate(w, x);
  for (int i = 0; i < 3; i++)
    u[i] = x[i] - (X[i] - support->origin[i]);
}

/* Do both prescribe the same u_i at X? At times between which both move evenly, and at some in between, where they
 * turn. */
PetscBool supports_agree(const Support *a, const Support *b, PetscReal end, const PetscReal X[3], int i)
{
  const Curve *const curves[] = {&a->curve, &a->rotate_curve, &b->curve, &b->rotate_curve};
  const PetscInt     n_even   = 16;
  for (int c = 0; c <= 4; c++) {
    const PetscInt n = c < 4 ? curves[c]->n : n_even;
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal t = c < 4 ? curves[c]->points[2 * k] : end * (k + 1) / n_even;
      PetscReal       ua[3], ub[3];
      prescribed_displacement(a, t, X, ua);
      prescribed_displacement(b, t, X, ub);
      if (PetscAbsReal(ua[i] - ub[i]) > 1e-12 * PetscMax(PetscAbsReal(ua[i]), PetscAbsReal(ub[i]))) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
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
        if (!supports_agree(support, earlier, physics->end, X, i))
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
    for (PetscInt s = 0; s < physics->n_supports; s++)
      PetscCall(select_vertices(scene, physics, &physics->supports[s]));
    PetscCall(check_overlaps(scene, physics));
    PetscCall(check_analytic(scene, physics));
  }
  PetscCall(scene_root_end(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode supports_label(Physics *physics)
{
  const Mesh *mesh = physics->mesh;
  char        label[2 * NAME_LENGTH];
  PetscFunctionBegin;
  PetscCall(plex_label_vertices(mesh->dm, "prescribed", mesh->n_vertices, NULL, physics->prescribed, 0));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    PetscCall(PetscSNPrintf(label, sizeof(label), "support.%s", physics->supports[s].name));
    PetscCall(
        plex_label_vertices(mesh->dm, label, physics->supports[s].n_vertices, physics->supports[s].vertices, NULL, 1));
    PetscCall(PetscFree(physics->supports[s].vertices));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* calls back for every supported vertex of this rank with the support's displacement there at t */
typedef void (*VertexVisit)(Support *support, const PetscReal u[3], PetscScalar *dofs);

static PetscErrorCode visit(Physics *physics, Vec local, PetscReal t, VertexVisit action)
{
  const Mesh        *mesh = physics->mesh;
  PetscSection       coordinate_section;
  Vec                coordinate_vector;
  const PetscScalar *coordinates;
  PetscScalar       *array;
  char               label[2 * NAME_LENGTH];

  PetscFunctionBegin;
  PetscCall(DMGetCoordinateSection(mesh->dm, &coordinate_section));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &coordinate_vector));
  PetscCall(VecGetArrayRead(coordinate_vector, &coordinates));
  PetscCall(VecGetArray(local, &array));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    Support        *support = &physics->supports[s];
    PetscInt        n;
    const PetscInt *points;
    IS              is;
    PetscCall(PetscSNPrintf(label, sizeof(label), "support.%s", support->name));
    PetscCall(DMGetStratumIS(mesh->dm, label, 1, &is));
    if (!is) continue; /* no such vertex on this rank */
    PetscCall(ISGetLocalSize(is, &n));
    PetscCall(ISGetIndices(is, &points));
    for (PetscInt k = 0; k < n; k++) {
      PetscInt  at, offset;
      PetscReal X[3], u[3];
      PetscCall(PetscSectionGetOffset(coordinate_section, points[k], &at));
      PetscCall(PetscSectionGetOffset(physics->unknowns.section, points[k], &offset));
      for (int i = 0; i < 3; i++) { /* back into the axes of the scene file: Q transposed */
        X[i] = 0;
        for (int j = 0; j < 3; j++)
          X[i] += mesh->rotation[3 * j + i] * PetscRealPart(coordinates[at + j]);
      }
      prescribed_displacement(support, t, X, u);
      mesh_rotate_vector(mesh, u);
      action(support, u, array + offset);
    }
    PetscCall(ISRestoreIndices(is, &points));
    PetscCall(ISDestroy(&is));
  }
  PetscCall(VecRestoreArray(local, &array));
  PetscCall(VecRestoreArrayRead(coordinate_vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void set_values(Support *support, const PetscReal u[3], PetscScalar *dofs)
{
  for (int i = 0; i < 3; i++) {
    if (support->mask & (1 << i)) dofs[i] = u[i];
  }
}

static void add_reactions(Support *support, const PetscReal u[3], PetscScalar *dofs)
{
  (void)u;
  for (int i = 0; i < 3; i++) {
    if (support->mask & (1 << i)) support->reaction[i] += PetscRealPart(dofs[i]);
  }
}

PetscErrorCode supports_values(Physics *physics, PetscReal t)
{
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(physics->prescribed_local)); /* removed multipliers are prescribed to be zero */
  PetscCall(visit(physics, physics->prescribed_local, t, set_values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* from the forces of the last evaluation; a component prescribed by two supports counts in both */
PetscErrorCode supports_reactions(Physics *physics)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < physics->n_supports; s++)
    PetscCall(PetscArrayzero(physics->supports[s].reaction, 3));
  PetscCall(visit(physics, physics->f_local, physics->t, add_reactions));
  for (PetscInt s = 0; s < physics->n_supports; s++)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, physics->supports[s].reaction, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
