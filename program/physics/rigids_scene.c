/* Rigid bodies as the scene describes them: mass, what supports prescribe, what loads act on. */
#include "physics/physics.h"
#include <string.h>

/* In the plane a body turns about z alone; a ring moves along its axis alone. */
static PetscInt always_held(SpaceKind kind)
{
  const PetscInt x = 1, z = 4, rx = 8, ry = 16, rz = 32;
  if (kind == SPACE_SOLID) return 0;
  return z | rx | ry | (kind == SPACE_AXISYMMETRIC ? x | rz : 0);
}

PetscErrorCode rigids_read(Scene *scene, Physics *physics)
{
  const Mesh *mesh = physics->mesh;
  PetscFunctionBegin;
  for (PetscInt b = 0; b < mesh->n_bodies; b++)
    physics->n_rigids += mesh->bodies[b].rigid;
  PetscCall(PetscCalloc1(physics->n_rigids, &physics->rigids));
  for (PetscInt b = 0, r = 0; b < mesh->n_bodies; b++) {
    if (!mesh->bodies[b].rigid) continue;
    Rigid *rigid        = &physics->rigids[r++];
    rigid->body         = b;
    rigid->first_vertex = mesh->bodies[b].first_vertex;
    rigid->end_vertex   = mesh->bodies[b].end_vertex;
    rigid->held         = always_held(mesh->space.kind);
    for (int k = 0; k < RIGID_UNKNOWNS; k++)
      rigid->support[k] = -1;
    rigid->part = -1;
    PetscCall(rigids_read_mass(scene, mesh, rigid));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt rigid_called(const Physics *physics, const char *name)
{
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    if (!strcmp(physics->mesh->bodies[physics->rigids[r].body].name, name)) return r;
  }
  return -1;
}

/* Does map.body name one alone? Then `point` is refused. */
PetscBool rigids_names(Scene *scene, const Physics *physics, const char *map)
{
  char name[NAME_LENGTH] = "";
  if (!physics->n_rigids) return PETSC_FALSE;
  scene_string(scene, map, "body", name, sizeof(name));
  if (rigid_called(physics, name) < 0) return PETSC_FALSE;
  scene_fail(scene, map, "point", "'%s' is rigid: force and moment act at its reference point; leave `point` out.", name);
}

/* The rigid body that map.body names; -1: it names none. */
PetscErrorCode rigids_named(Scene *scene, const Physics *physics, const char *map, PetscInt *rigid)
{
  static const char *const not_of_rigid[] = {"within", "point", "gradient", "origin", "file"};
  PetscInt                 n;
  char                   **names;
  PetscFunctionBegin;
  *rigid = -1;
  if (!physics->n_rigids || !scene_has(scene, map, "body")) PetscFunctionReturn(PETSC_SUCCESS);
  scene_strings(scene, map, "body", &n, &names);
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt found = rigid_called(physics, names[k]);
    if (found < 0) continue;
    *rigid = found;
    if (n > 1) scene_fail(scene, map, "body", "'%s' is rigid: a support of it names no other body.", names[k]);
  }
  for (size_t k = 0; k < sizeof(not_of_rigid) / sizeof(not_of_rigid[0]) && *rigid >= 0; k++) {
    if (scene_has(scene, map, not_of_rigid[k]))
      scene_fail(scene, map, not_of_rigid[k], "'%s' is rigid: its reference point moves by `value`, and it turns about that by `rotate`.",
                 names[0]);
  }
  strings_destroy(n, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The support before this one that prescribes the same unknown at one time; NULL: none */
static const Support *prescribes_already(const Physics *physics, PetscInt number, int k)
{
  const Support *support = &physics->supports[number];
  for (PetscInt s = 0; s < number; s++) {
    const Support *other = &physics->supports[s];
    if (other->rigid == support->rigid && ((other->mask | other->turns << 3) & (1 << k)) &&
        PetscMax(other->from, support->from) < PetscMin(other->until, support->until))
      return other;
  }
  return NULL;
}

/* A support of one prescribes what its masks say; one that changes leaves it an unknown. */
void rigids_support(Scene *scene, Physics *physics, PetscInt number)
{
  static const char *const unknowns[] = {"x", "y", "z", "rx", "ry", "rz"};
  const Support *support = &physics->supports[number];
  Rigid         *rigid   = &physics->rigids[support->rigid];
  const PetscInt mask    = support->mask | support->turns << 3;
  for (int k = 0; k < RIGID_UNKNOWNS; k++) {
    const Support *other;
    if (k >= 3 && support->rotate[k - 3] != 0 && !(mask & (1 << k)))
      scene_fail(scene, support->name, "rotate", "%s is not among its components.", unknowns[k]);
    if (!(mask & (1 << k))) continue;
    other = prescribes_already(physics, number, k);
    if (other) scene_fail(scene, support->name, "components", "'%s' prescribes %s of this body already.", other->name, unknowns[k]);
    if (k >= 3 && support->rotate[k - 3] != 0) rigid->turned_by |= 1 << k;
    if (support->timed) continue;
    rigid->support[k] = number;
    rigid->held |= 1 << k;
  }
}

/* What is prescribed of its vertices in the piece. */
void rigids_mark(Physics *physics)
{
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    const Body  *body  = &physics->mesh->bodies[rigid->body];
    for (PetscInt v = body->first_here; v < body->end_here; v++) {
      const PetscInt number  = physics->mesh->numbers[v] - rigid->first_vertex;
      physics->prescribed[v] = number == 0 ? rigid->held & 7 : number == 1 ? rigid->held >> 3 : rigids_node_mask(rigid);
    }
  }
}

/* `force`, `moment`: of rigid bodies alone. */
PetscBool rigids_read_load(Scene *scene, const Physics *physics, Load *load)
{
  const Space    *space  = &physics->mesh->space;
  const PetscBool force  = space_vector(scene, space, load->name, "force", load->force);
  const PetscBool moment = space_turn(scene, space, load->name, "moment", load->moment);
  mesh_rotate_vector(physics->mesh, load->force);
  mesh_rotate_vector(physics->mesh, load->moment);
  return (PetscBool)(force || moment);
}

/* A body under a load that has a force or a moment, or gravity, or that turns. */
void rigids_check_load(Scene *scene, const Physics *physics, const Load *load, const char *body, PetscBool forces,
                       PetscBool gravity, PetscBool spins)
{
  const PetscInt r   = rigid_called(physics, body);
  const char    *key = scene_has(scene, load->name, "moment") ? "moment" : "force";
  if (r < 0 && forces)
    scene_fail(scene, load->name, key, "'%s' is not rigid: a %s acts at the reference point of a rigid body, or is spread over a `surface`%s.", body, key,
               key[0] == 'f' ? ", or acts on the node at a `point`" : "; a moment on a node is none");
  if (r >= 0 && spins) scene_fail(scene, load->name, "centrifugal", "'%s' is rigid, and has no such load.", body);
  if (r >= 0 && gravity && !(physics->rigids[r].mass > 0))
    scene_fail(scene, body, "mass", "'%s' asks for a mass above 0, or a `density`.", load->name);
}
