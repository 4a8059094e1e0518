/* Supports as the scene describes them: of a surface, a whole body, the vertices of a body within a box, or a vertex. */
#include "physics/physics.h"
#include <stdio.h>
#include <string.h>

/* Vertices of rigid bodies are not supported one by one. */
static PetscErrorCode refuse_rigid(Scene *scene, const Physics *physics, const char *name, const PetscInt chosen[])
{
  char     text[512] = "";
  PetscInt bad       = -1;
  PetscFunctionBegin;
  if (!physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < physics->mesh->n_vertices && bad < 0; v++) {
    const PetscInt r    = chosen[v] ? rigids_of_vertex(physics, physics->mesh->numbers[v]) : -1;
    const char    *body = r < 0 ? "" : physics->mesh->bodies[physics->rigids[r].body].name;
    if (r < 0) continue;
    bad = physics->mesh->numbers[v];
    PetscCall(PetscSNPrintf(text, sizeof(text), "'%s' is rigid: support it at its reference point, {body: %s, components: [x, rx, ...]}.",
                            body, body));
  }
  PetscCall(scene_fail_first(scene, bad, name, "surface", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode select_vertices(Scene *scene, Physics *physics, Support *support)
{
  const Mesh *mesh = physics->mesh;
  const char *name = support->name;
  PetscInt    n;
  char      **list;
  PetscReal   box[6];
  PetscInt   *chosen, number;

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
    PetscCall(mesh_nearest_vertex(scene, mesh, name, &number));
    number = mesh_vertex_here(mesh, number);
    if (number >= 0) chosen[number] = PETSC_TRUE;
  } else if (scene_has(scene, name, "body")) {
    const PetscBool within = space_box(scene, &mesh->space, name, "within", box);
    scene_strings(scene, name, "body", &n, &list);
    for (PetscInt k = 0; k < n; k++) {
      const Body *body = &mesh->bodies[mesh_body(scene, mesh, name, "body", list[k])];
      for (PetscInt v = body->first_here; v < body->end_here; v++) {
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
  PetscCall(refuse_rigid(scene, physics, name, chosen));
  PetscCall(pieces_unite(mesh, chosen, MPI_MAX)); /* a vertex here may be on a face of another piece */
  PetscCall(PetscMalloc1(mesh->n_vertices, &support->vertices));
  for (PetscInt v = 0; v < mesh->n_vertices; v++) {
    if (chosen[v]) support->vertices[support->n_vertices++] = v;
  }
  n = support->n_vertices;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  if (!n) scene_fail(scene, name, "within", "no vertex lies in this box.");
  PetscCall(PetscFree(chosen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One support's vertices: prescribed components, of which `first` is the support that prescribes them, 3 a vertex. */
static PetscErrorCode check_overlap(Scene *scene, Physics *physics, PetscInt s, PetscInt first[])
{
  const Mesh    *mesh      = physics->mesh;
  const Support *support   = &physics->supports[s];
  char           text[512] = "";
  PetscInt       bad       = -1;
  PetscFunctionBegin;
  for (PetscInt k = 0; k < support->n_vertices; k++) {
    const PetscInt   v = support->vertices[k];
    const PetscReal *X = mesh->coordinates + 3 * v;
    for (int i = 0; i < 3; i++) {
      const Support *earlier;
      if (!(support->mask & (1 << i))) continue;
      if (!support->timed) physics->prescribed[v] |= 1 << i;
      if (first[3 * v + i] < 0) {
        if (!support->timed) first[3 * v + i] = s;
        continue;
      }
      earlier = &physics->supports[first[3 * v + i]];
      if (bad >= 0 || supports_agree(physics, support, earlier, v, X, i)) continue;
      bad = mesh->numbers[v];
      PetscCall(PetscSNPrintf(text, sizeof(text), "u_%c of the vertex at [%g, %g, %g] is prescribed differently by '%s'.", 'x' + i,
                              (double)X[0], (double)X[1], (double)X[2], earlier->name));
    }
  }
  PetscCall(scene_fail_first(scene, bad, support->name, "components", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two supports may share a vertex and a component only if they say the same. */
static PetscErrorCode check_overlaps(Scene *scene, Physics *physics)
{
  const PetscInt n = 3 * physics->mesh->n_vertices;
  PetscInt      *first;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &first));
  for (PetscInt k = 0; k < n; k++)
    first[k] = -1;
  for (PetscInt s = 0; s < 2 * physics->n_supports; s++) { /* those that hold from start to end first */
    if (physics->supports[s % physics->n_supports].timed == (s >= physics->n_supports)) PetscCall(check_overlap(scene, physics, s % physics->n_supports, first));
  }
  PetscCall(timed_check(scene, physics));
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body without a mesh is rigid: nothing but a support says where it is. */
static PetscErrorCode check_analytic(Scene *scene, const Physics *physics)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < physics->mesh->n_bodies; b++) {
    const Body *body = &physics->mesh->bodies[b];
    PetscInt    bad  = -1;
    char        text[256];
    for (PetscInt v = body->first_here; v < body->end_here && body->analytic && !body->rigid; v++) {
      if (physics->prescribed[v] != 7) bad = v;
    }
    PetscCall(PetscSNPrintf(text, sizeof(text), "an analytic body needs a support: {body: %s, components: [x, y%s]}.",
                            body->name, physics->mesh->dimension == 3 ? ", z" : ""));
    PetscCall(scene_fail_first(scene, bad, body->name, NULL, text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vertices of an axisymmetric model on its axis stay there. No name in a scene has such a character. */
static const char *const ON_AXIS = "on_axis";

/* In a plane or axisymmetric model the third component is zero, and no unknown. */
static void hold_plane(const Mesh *mesh, PetscInt prescribed[])
{
  for (PetscInt v = 0; v < mesh->n_vertices && mesh->dimension == 2; v++)
    prescribed[v] |= 4;
}

static PetscErrorCode hold_axis(const Mesh *mesh, Support *support)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->n_vertices, &support->vertices));
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    const Body *body = &mesh->bodies[b];
    for (PetscInt v = body->first_here; v < body->end_here && !body->analytic && !body->rigid; v++) {
      if (mesh->coordinates[3 * v] == 0) support->vertices[support->n_vertices++] = v;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Along axes; of a rigid body about them, too. */
static void read_components(Scene *scene, const Mesh *mesh, Support *support)
{
  static const char *const names[] = {"x", "y", "z", "rx", "ry", "rz"};
  const SpaceKind kind    = mesh->space.kind;
  const PetscBool rigid   = (PetscBool)(support->rigid >= 0);
  const PetscInt  along   = rigid && kind == SPACE_AXISYMMETRIC ? 2 : (1 << mesh->dimension) - 1;
  const PetscInt  about   = !rigid || kind == SPACE_AXISYMMETRIC ? 0 : mesh->dimension == 3 ? 7 : 4;
  char            allowed[64] = "";
  PetscInt        n;
  char          **given;
  for (int k = 0; k < 6; k++) {
    if ((along | about << 3) & (1 << k))
      snprintf(allowed + strlen(allowed), sizeof(allowed) - strlen(allowed), "%s%s", allowed[0] ? ", " : "", names[k]);
  }
  scene_strings(scene, support->name, "components", &n, &given);
  for (PetscInt c = 0; c < n; c++) {
    int k = 0;
    while (k < 6 && strcmp(given[c], names[k]))
      k++;
    if (k == 6 || !((along | about << 3) & (1 << k)))
      scene_fail(scene, support->name, "components", "'%s' is not allowed; choose from: %s.", given[c], allowed);
    if (k < 3) support->mask |= 1 << k;
    if (k >= 3) support->turns |= 1 << (k - 3);
  }
  strings_destroy(n, &given);
  if (!support->mask && !support->turns)
    scene_fail(scene, support->name, "components", "this key is missing; choose from: %s.", allowed);
  if (mesh->rotated && ((!rigid || support->mask) && support->mask != (1 << mesh->dimension) - 1))
    scene_fail(scene, support->name, "components",
               "in a rotated frame a support must prescribe all of %s (with `value` or `gradient`).",
               mesh->dimension == 3 ? "x, y, z" : "x, y");
  if (mesh->rotated && support->turns && support->turns != about)
    scene_fail(scene, support->name, "components", "in a rotated frame a support must prescribe all turns, or none.");
}

static PetscErrorCode read_support(Scene *scene, Physics *physics, const char *name, PetscInt number)
{
  const Mesh *mesh    = physics->mesh;
  Support    *support = &physics->supports[number];
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(support->name, NAME_LENGTH, "%s", name));
  PetscCall(rigids_named(scene, physics, name, &support->rigid));
  read_components(scene, mesh, support);
  space_vector(scene, &mesh->space, name, "value", support->value);
  space_matrix(scene, &mesh->space, name, "gradient", support->gradient);
  space_turn(scene, &mesh->space, name, "rotate", support->rotate);
  space_vector(scene, &mesh->space, name, "origin", support->origin);
  PetscCall(curve_read(scene, name, "curve", physics->end, &support->curve));
  if (scene_has(scene, name, "rotate_curve"))
    PetscCall(curve_read(scene, name, "rotate_curve", physics->end, &support->rotate_curve));
  else
    PetscCall(curve_copy(&support->curve, &support->rotate_curve));
  PetscCall(timed_read(scene, physics, support));
  if (support->rigid >= 0) rigids_support(scene, physics, number);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode supports_read(Scene *scene, Physics *physics)
{
  const Mesh *mesh = physics->mesh;
  Support    *axis = NULL;
  char      **names;
  PetscInt    n_named;

  PetscFunctionBegin;
  scene_names(scene, "supports", &n_named, &names);
  physics->n_supports = n_named + (mesh->space.kind == SPACE_AXISYMMETRIC);
  PetscCall(PetscCalloc1(physics->n_supports, &physics->supports));
  for (PetscInt s = 0; s < n_named; s++)
    PetscCall(read_support(scene, physics, names[s], s));
  strings_destroy(n_named, &names);
  if (physics->n_supports > n_named) {
    axis        = &physics->supports[n_named];
    axis->mask  = 1;
    axis->rigid = -1;
    PetscCall(PetscSNPrintf(axis->name, NAME_LENGTH, "%s", ON_AXIS));
    PetscCall(curve_ramp(physics->end, &axis->curve));
    PetscCall(curve_copy(&axis->curve, &axis->rotate_curve));
  }
  PetscCall(PetscCalloc1(mesh->n_vertices, &physics->prescribed));
  for (PetscInt s = 0; s < n_named; s++) {
    if (physics->supports[s].rigid >= 0) continue;
    PetscCall(select_vertices(scene, physics, &physics->supports[s]));
    PetscCall(supports_file_read(scene, mesh, &physics->supports[s]));
  }
  if (axis) PetscCall(hold_axis(mesh, axis));
  hold_plane(mesh, physics->prescribed);
  rigids_mark(physics);
  PetscCall(check_overlaps(scene, physics));
  PetscCall(check_analytic(scene, physics));
  PetscFunctionReturn(PETSC_SUCCESS);
}
