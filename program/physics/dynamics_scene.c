/* `dynamics` of a scene, and how its bodies move at the start. */
#include "physics/dynamics.h"

static void read_motion(Scene *scene, Physics *physics, const char *body, PetscReal motion[MOTION_NUMBERS])
{
  const Mesh     *mesh  = physics->mesh;
  const PetscBool moves = space_vector(scene, &mesh->space, body, "velocity", motion), spins = space_turn(scene, &mesh->space, body, "spin", motion + 3);
  const PetscBool about = space_vector(scene, &mesh->space, body, "about", motion + 6);
  if (about && !spins) scene_fail(scene, body, "about", "only of `spin`: the point that the body turns about at the start.");
  if ((moves || spins) && !physics->dynamics)
    scene_fail(scene, body, moves ? "velocity" : "spin", "only with `dynamics`: a body at rest has none.");
  if (mesh->space.kind == SPACE_AXISYMMETRIC && motion[0] != 0)
    scene_fail(scene, body, "velocity", "a ring moves along its axis, y: [0, %g].", (double)motion[1]);
  for (int k = 0; k < MOTION_NUMBERS; k += 3)
    mesh_rotate_vector(mesh, motion + k);
}

/* Bodies that have mass, or need none. */
static void check_body(Scene *scene, const Physics *physics, PetscInt b)
{
  const Body     *body     = &physics->mesh->bodies[b];
  const Material *material = &physics->materials[b];
  if (body->rigid || body->analytic) return;
  if (!(material->density > 0)) scene_fail(scene, body->name, "density", "`dynamics` asks for one above 0.");
}

/* A rigid body that is not held in all has inertia, and moves at the start. */
static void read_rigid(Scene *scene, Physics *physics, Rigid *rigid)
{
  const Mesh *mesh = physics->mesh;
  const char *name = mesh->bodies[rigid->body].name;
  PetscReal   motion[MOTION_NUMBERS] = {0}, velocity[3], arm[3] = {0};
  rigids_read_inertia(scene, physics, rigid);
  if (!rigid->inertial) return;
  if (physics->dynamics->rho_inf < 1)
    scene_fail(scene, "dynamics", "rho_inf", "'%s' is rigid and free, and turns by a rule that keeps the energy: 1 is expected, not %g.", name,
               (double)physics->dynamics->rho_inf);
  read_motion(scene, physics, name, motion);
  (void)space_vector(scene, &mesh->space, name, "reference", arm);
  mesh_rotate_vector(mesh, arm);
  for (int i = 0; i < 3; i++)
    arm[i] -= motion[6 + i];
  for (int i = 0; i < 3; i++)
    velocity[i] = motion[i] + motion[3 + (i + 1) % 3] * arm[(i + 2) % 3] - motion[3 + (i + 2) % 3] * arm[(i + 1) % 3];
  rigid_inertia_start(rigid, velocity, motion + 3);
}

static void read_scheme(Scene *scene, const Mesh *mesh, Dynamics *dynamics)
{
  static const char *const masses[]  = {"consistent", "spread", NULL};
  PetscInt                 mass      = 0;
  static const char *const damping[] = {"mass_damping", "stiffness_damping"};
  PetscReal *const         values[]  = {&dynamics->mass_damping, &dynamics->stiffness_damping};
  const PetscReal          rho       = dynamics->rho_inf;
  for (int k = 0; k < 2; k++)
    scene_real(scene, "dynamics", damping[k], values[k]);
  scene_choice(scene, "dynamics", "contact_mass", masses, &mass);
  dynamics->spread = (PetscBool)mass;
  if (mass && rho < 1) scene_fail(scene, "dynamics", "contact_mass", "`spread` goes with `rho_inf: 1` only: nodes without mass have no acceleration.");
  if (mass && mesh->size > 1) scene_fail(scene, "dynamics", "contact_mass", "`spread` is for one rank only, not for %d.", (int)mesh->size);
  dynamics->alpha_m = (2 * rho - 1) / (rho + 1);
  dynamics->alpha_f = rho / (rho + 1);
  dynamics->gamma   = 0.5 - dynamics->alpha_m + dynamics->alpha_f;
  dynamics->beta    = PetscSqr(1 - dynamics->alpha_m + dynamics->alpha_f) / 4;
  dynamics->scale   = (1 - dynamics->alpha_m) / (2 * dynamics->beta);
}

/* Once supports are read: what is free is known. */
PetscErrorCode dynamics_read(Scene *scene, Physics *physics)
{
  const Mesh  *mesh = physics->mesh;
  PetscReal    rho  = 1, *motions;
  PetscBool    named = scene_has(scene, "dynamics", "rho_inf");
  PetscFunctionBegin;
  scene_real(scene, "dynamics", "rho_inf", &rho);
  if (!named && (scene_has(scene, "dynamics", "mass_damping") || scene_has(scene, "dynamics", "stiffness_damping") || scene_has(scene, "dynamics", "contact_mass")))
    scene_fail(scene, "dynamics", "rho_inf", "this key is missing: 1 for a scheme that keeps the energy.");
  PetscCall(PetscCalloc1(MOTION_NUMBERS * mesh->n_bodies, &motions));
  if (named) {
    PetscCall(PetscNew(&physics->dynamics));
    physics->dynamics->rho_inf  = rho;
    physics->dynamics->velocity = motions;
    read_scheme(scene, mesh, physics->dynamics);
  }
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    const Body *body = &mesh->bodies[b];
    if (!body->rigid && !body->analytic) read_motion(scene, physics, body->name, motions + MOTION_NUMBERS * b);
    if (named) check_body(scene, physics, b);
  }
  for (PetscInt r = 0; r < physics->n_rigids && named; r++) {
    read_rigid(scene, physics, &physics->rigids[r]);
  }
  if (!named) PetscCall(PetscFree(motions));
  PetscFunctionReturn(PETSC_SUCCESS);
}
