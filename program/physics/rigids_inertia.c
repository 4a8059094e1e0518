/* Inertia of rigid bodies with `dynamics` (docs/dynamics.md, docs/formulation 14.7): the energy-momentum rule of Simo and Wong (Int. J. Numer.
 * Meth. Engng 31, 1991). It is the midpoint rule of the bodies that deform, for finite rotations.
 *
 * With theta for the rotation vector of the step, the turn is a Cayley map of tau = 2 tan(|theta| / 2) theta / |theta|: whatever turns
 * with the body has moved by tau x (rho' + rho) / 2, exactly. R turns the body up to t_n, R' = exp[theta] R, J is its inertia in its own
 * axes, W its spin there, pi = R J W its moment of momentum. Then
 *
 *   W' = 2 R^T tau / dt - W,   (pi' - pi) / dt = M,   v' = 2 (u' - u) / dt - v,   m (v' - v) / dt = F,
 *
 * where M has the arms of the middle (STICKSLIP_RIGID_ARMS_MIDDLE). R^T tau = R'^T tau gives tau . (pi' - pi) = dt (W' J W' - W J W) / 2, so that
 * the energy grows by F . (u' - u) + M . tau, which is the work of the nodal forces; without any it is kept, and pi is.
 *
 * Where supports prescribe a motion v' and W' are theirs (`led`): F and M have impulses then, which work with the means of both velocities. */
#include "physics/physics.h"

enum { TURNS = 7 << 3 };
/* Below this angle, squared, series: what they leave out is below rounding. */
static const PetscReal SMALL = 1e-4;
/* How much too slowly a body may turn before that is told, over its turn: a per cent is off by 0.06 radians after a whole turn, which a
 * picture shows. A step of 0.35 radians has it. */
static const PetscReal LAG = 0.01;

static void multiply(const PetscReal a[9], const PetscReal x[3], PetscReal y[3])
{
  for (int i = 0; i < 3; i++)
    y[i] = a[3 * i] * x[0] + a[3 * i + 1] * x[1] + a[3 * i + 2] * x[2];
}

static void multiply_transposed(const PetscReal a[9], const PetscReal x[3], PetscReal y[3])
{
  for (int i = 0; i < 3; i++)
    y[i] = a[i] * x[0] + a[3 + i] * x[1] + a[6 + i] * x[2];
}

static PetscReal dot(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void multiply_matrices(const PetscReal a[9], const PetscReal b[9], PetscReal c[9])
{
  for (int k = 0; k < 9; k++)
    c[k] = a[k / 3 * 3] * b[k % 3] + a[k / 3 * 3 + 1] * b[3 + k % 3] + a[k / 3 * 3 + 2] * b[6 + k % 3];
}

/* [v]: [v] w = v x w */
static void cross_matrix(const PetscReal v[3], PetscReal c[9])
{
  const PetscReal all[9] = {0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0};
  for (int k = 0; k < 9; k++)
    c[k] = all[k];
}

/* tau = g theta, and dtau = (g I + h theta theta^T) dtheta, with h = (dg / dt) / t */
static void cayley(const PetscReal theta[3], PetscReal *g, PetscReal *h)
{
  const PetscReal squared = dot(theta, theta), t = PetscSqrtReal(squared);
  if (squared < SMALL) {
    *g = 1 + squared / 12 * (1 + squared / 10 * (1 + 17 * squared / 168));
    *h = (1 + squared / 5 * (1 + 17 * squared / 112)) / 6;
  } else {
    const PetscReal tangent = PetscTanReal(t / 2);
    *g = 2 * tangent / t;
    *h = (t * (1 + PetscSqr(tangent)) - 2 * tangent) / (t * squared);
  }
}

/* A step of a body, with the motion of now */
typedef struct {
  PetscReal way[3], tau[3], g, h, turned[9];      /* u' - u; R' */
  PetscReal velocity[3], spin[3], pi_n[3], pi[3]; /* v', W'; pi, pi' */
} RigidStep;

static void look(const Rigid *rigid, PetscReal dt, RigidStep *s)
{
  PetscReal own[3], turning[3];
  cayley(rigid->motion + 3, &s->g, &s->h);
  rigids_turned(rigid, s->turned);
  for (int i = 0; i < 3; i++) {
    s->way[i]      = rigid->motion[i] - rigid->place[i];
    s->tau[i]      = s->g * rigid->motion[3 + i];
    s->velocity[i] = rigid->led >> i & 1 ? rigid->rate[i] : 2 * s->way[i] / dt - rigid->velocity[i];
  }
  multiply_transposed(rigid->turned, s->tau, turning);
  multiply_transposed(s->turned, rigid->rate + 3, own);
  for (int i = 0; i < 3; i++)
    s->spin[i] = rigid->led & TURNS ? own[i] : 2 * turning[i] / dt - rigid->spin[i];
  multiply(rigid->inertia, rigid->spin, own);
  multiply(rigid->turned, own, s->pi_n);
  multiply(rigid->inertia, s->spin, own);
  multiply(s->turned, own, s->pi);
}

/* At t = 0: velocity of the reference point and spin along the axes of space. What is held does not turn. */
void rigid_inertia_start(Rigid *rigid, const PetscReal velocity[3], const PetscReal spin[3])
{
  for (int i = 0; i < 3; i++) {
    rigid->velocity[i] = velocity[i];
    rigid->spin[i]     = rigid->held >> (3 + i) & 1 ? 0 : spin[i];
  }
}

/* Of the supports that hold in the step that ends at t. Turns that are held in part are held at rest, and have no rate. */
void rigids_lead(Physics *physics, PetscReal t)
{
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    Rigid *rigid = &physics->rigids[r];
    rigid->led   = 0;
    for (int k = 0; k < RIGID_UNKNOWNS && rigid->inertial; k++) {
      const Support *support = rigid_holder(physics, rigid, k);
      PetscReal      rate[3] = {0, 0, 0};
      if (!support && !(rigid->held >> k & 1)) continue;
      rigid->led |= 1 << k;
      for (int i = 0; i < 3 && support; i++) {
        const int sides = support_sides(physics, support, t);
        PetscReal slopes[2];
        curve_slopes(k < 3 ? &support->curve : &support->rotate_curve, t, slopes);
        rate[i] = (k < 3 ? support->value : support->rotate)[i] * (sides == 2 ? (slopes[0] + slopes[1]) / 2 : slopes[sides]);
      }
      mesh_rotate_vector(physics->mesh, rate);
      rigid->rate[k] = rate[k % 3];
    }
    if ((rigid->led & TURNS) != TURNS) rigid->led &= ~TURNS;
  }
}

void rigids_start(Physics *physics)
{
  rigids_lead(physics, 0);
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    Rigid *rigid = &physics->rigids[r];
    for (int i = 0; i < 3; i++) {
      const Support *support = rigid_holder(physics, rigid, i);
      PetscReal      place[3] = {0, 0, 0};
      for (int j = 0; j < 3 && support; j++)
        place[j] = curve_value(&support->curve, 0) * support->value[j];
      mesh_rotate_vector(physics->mesh, place);
      if (rigid->led >> i & 1) rigid->velocity[i] = rigid->rate[i], rigid->place[i] = place[i];
      if (rigid->led & TURNS)
        rigid->spin[i] = rigid->rate[3 + i]; /* it is not turned yet */
      else if (rigid_holder(physics, rigid, 3 + i))
        rigid->spin[i] = 0;
    }
  }
}

/* 2 M v / dt, what forces are compared with. Of the ranks that own the bodies; so are all that follow. */
void rigids_add_impulse(const Physics *physics, PetscReal dt, PetscScalar *impulse)
{
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    PetscReal    own[3], pi[3];
    if (!rigid->inertial || !rigid->owned) continue;
    multiply(rigid->inertia, rigid->spin, own);
    multiply(rigid->turned, own, pi);
    for (int i = 0; i < 3; i++) {
      impulse[rigid->at[0] + i] += 2 * rigid->mass * rigid->velocity[i] / dt;
      impulse[rigid->at[1] + i] += 2 * pi[i] / (dt * rigid->length);
    }
  }
}

/* Inertia, and with `damping` the forces of C = damping M, at the motion of now */
void rigids_add_inertia(const Physics *physics, PetscReal dt, PetscReal damping, PetscScalar *f)
{
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    RigidStep    s;
    if (!rigid->inertial || !rigid->owned) continue;
    look(rigid, dt, &s);
    for (int i = 0; i < 3; i++) {
      const PetscReal v = rigid->velocity[i];
      f[rigid->at[0] + i] += rigid->mass * ((s.velocity[i] - v) / dt + damping * (s.velocity[i] + v) / 2);
      f[rigid->at[1] + i] += ((s.pi[i] - s.pi_n[i]) / dt + damping * (s.pi[i] + s.pi_n[i]) / 2) / rigid->length;
    }
  }
}

/* d pi' by theta: w x pi' + R' J dW', with the spin w = (I + [tau] / 2) dtau / (1 + tau^2 / 4) and dW' = 2 R^T dtau / dt */
static void moment_derivative(const Rigid *rigid, PetscReal dt, PetscReal k[9])
{
  RigidStep s;
  PetscReal a[9], b[9], c[9], by_tau[9];
  look(rigid, dt, &s);
  cross_matrix(s.tau, a);
  for (int i = 0; i < 9; i++)
    a[i] = ((i % 4 == 0) + a[i] / 2) / (1 + dot(s.tau, s.tau) / 4);
  cross_matrix(s.pi, b);
  multiply_matrices(b, a, c);
  for (int i = 0; i < 9; i++)
    by_tau[i] = -c[i];
  multiply_matrices(s.turned, rigid->inertia, a);
  for (int i = 0; i < 9; i++)
    b[i] = rigid->turned[3 * (i % 3) + i / 3];
  multiply_matrices(a, b, c);
  for (int i = 0; i < 9; i++)
    by_tau[i] += 2 / dt * c[i];
  for (int i = 0; i < 9; i++)
    a[i] = (i % 4 == 0 ? s.g : 0) + s.h * rigid->motion[3 + i / 3] * rigid->motion[3 + i % 3];
  multiply_matrices(by_tau, a, k);
}

/* Their derivatives by u' and theta times the length, into a matrix of the equations. */
PetscErrorCode rigids_insert_inertia(const Physics *physics, PetscReal dt, PetscReal damping, Mat matrix)
{
  const PetscReal rate = 1 / dt + damping / 2;
  PetscFunctionBegin;
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    PetscReal    k[9];
    if (!rigid->inertial || !rigid->owned) continue;
    for (int i = 0; i < 3; i++) {
      if (rigid->equations[i] >= 0) PetscCall(MatSetValue(matrix, rigid->equations[i], rigid->equations[i], rate * 2 / dt * rigid->mass, ADD_VALUES));
    }
    moment_derivative(rigid, dt, k);
    for (int i = 0; i < 9; i++)
      k[i] *= rate / PetscSqr(rigid->length);
    PetscCall(MatSetValues(matrix, 3, rigid->equations + 3, 3, rigid->equations + 3, k, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where that has entries. */
PetscErrorCode rigids_pattern(const Physics *physics, Mat matrix)
{
  static const PetscScalar zeros[RIGID_UNKNOWNS * RIGID_UNKNOWNS];
  PetscFunctionBegin;
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    if (!rigid->inertial || !rigid->owned) continue;
    PetscCall(MatSetValues(matrix, RIGID_UNKNOWNS, rigid->equations, RIGID_UNKNOWNS, rigid->equations, zeros, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest rounding of an inertial force, squared, by the places that it is a difference of: of one body */
PetscReal rigid_rounding(const Rigid *rigid, PetscReal dt)
{
  PetscReal largest = rigid->length;
  for (int i = 0; i < 3; i++)
    largest = PetscMax(largest, PetscAbsReal(rigid->motion[i]));
  return PetscSqr(PETSC_MACHINE_EPSILON * largest * rigid->mass * 2 / PetscSqr(dt));
}

/* Work of the supports that lead a body, by forces of which each rank has its part, and by inertia, which its owner has: force times way,
 * and what inertia works more by the mean of both velocities. Turns that are held at rest in part do none. */
static PetscReal work_of_leading(const Rigid *rigid, PetscReal dt, const PetscScalar *forces, const RigidStep *s)
{
  PetscReal work = 0, own[3], energies[2];
  for (int i = 0; i < 3; i++) {
    const PetscReal v = rigid->velocity[i], w = s->velocity[i];
    if (!(rigid->led >> i & 1)) continue;
    work += PetscRealPart(forces[rigid->at[0] + i]) * s->way[i];
    if (rigid->owned) work += rigid->mass * (w - v) * ((w + v) / 2 - s->way[i] / dt);
  }
  if (!(rigid->led & TURNS)) return work;
  multiply(rigid->inertia, rigid->spin, own);
  energies[0] = dot(rigid->spin, own) / 2;
  multiply(rigid->inertia, s->spin, own);
  energies[1] = dot(s->spin, own) / 2;
  for (int i = 0; i < 3; i++) {
    work += PetscRealPart(forces[rigid->at[1] + i]) * rigid->length * s->tau[i];
    if (rigid->owned) work -= (s->pi[i] - s->pi_n[i]) / dt * s->tau[i];
  }
  return work + (rigid->owned ? energies[1] - energies[0] : 0);
}

/* Work of the step by loads, supports and contact; energy that damping takes. By contact each rank has what its nodes do. */
void rigids_add_work(const Physics *physics, PetscReal dt, PetscReal damping, const PetscScalar *external, const PetscScalar *forces, RigidWork *work)
{
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    RigidStep    s;
    if (!rigid->inertial || rigid->at[0] < 0) continue;
    look(rigid, dt, &s);
    work->supports += work_of_leading(rigid, dt, forces, &s);
    work->contact -= dot(rigid->contact, s.way) + dot(rigid->contact + 3, s.tau); /* contact has what is inside as positive */
    for (int i = 0; i < 3 && rigid->owned; i++) {
      work->external += PetscRealPart(external[rigid->at[0] + i]) * s.way[i] + PetscRealPart(external[rigid->at[1] + i]) * rigid->length * s.tau[i];
      work->damping += damping * (rigid->mass * (s.velocity[i] + rigid->velocity[i]) * s.way[i] + (s.pi[i] + s.pi_n[i]) * s.tau[i]) / 2;
    }
  }
}

/* Energy of motion, momentum, its moment about the origin: at t_n, or with the motion of now at the end of the step */
void rigids_add_motion(const Physics *physics, PetscReal dt, PetscBool end, PetscReal *kinetic, PetscReal momentum[3], PetscReal angular[3])
{
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    PetscReal    own[3], x[3], p[3];
    RigidStep    s = {0};
    if (!rigid->inertial || !rigid->owned) continue;
    if (end) look(rigid, dt, &s);
    const PetscReal *v = end ? s.velocity : rigid->velocity, *spin = end ? s.spin : rigid->spin;
    multiply(rigid->inertia, spin, own);
    *kinetic += (rigid->mass * dot(v, v) + dot(spin, own)) / 2;
    multiply(end ? s.turned : rigid->turned, own, p);
    for (int i = 0; i < 3; i++) {
      angular[i] += p[i];
      momentum[i] += rigid->mass * v[i];
      x[i] = rigid->point[i] + (end ? rigid->motion[i] : rigid->place[i]);
    }
    for (int i = 0; i < 3; i++)
      angular[i] += rigid->mass * (x[(i + 1) % 3] * v[(i + 2) % 3] - x[(i + 2) % 3] * v[(i + 1) % 3]);
  }
}

/* A step turns by |theta| = 2 atan(|tau| / 2) where the spin would make |tau|: too little by |tau|^2 / 12 of it. The first time that this
 * is more than LAG is told: energy and moment of momentum are kept at any step, so that nothing else shows it. */
static PetscErrorCode tell_lag(const Physics *physics, PetscReal dt, const RigidStep *s, Rigid *rigid)
{
  const PetscReal spun = PetscSqrtReal(dot(s->tau, s->tau)), turned = spun / s->g;
  PetscFunctionBegin;
  if (rigid->lag_told || !(spun - turned > LAG * spun)) PetscFunctionReturn(PETSC_SUCCESS);
  rigid->lag_told = PETSC_TRUE;
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "stickslip: warning: in the step to t = %.6g '%s' turns by %.3g radians, and its spin would turn it by %.3g: it turns %.2g %% "
                         "too slowly, for a step makes 2 atan(w dt / 2) of w dt. Take steps of %.2g at most, in which it is %.2g %%. See docs/dynamics.md.\n",
                         (double)physics->t, physics->mesh->bodies[rigid->body].name, (double)turned, (double)spun, (double)(100 * (1 - turned / spun)),
                         (double)(PetscSqrtReal(12 * LAG) / spun * dt), (double)(100 * LAG)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step is accepted; the bodies have not taken their rotation over yet. */
PetscErrorCode rigids_accept_inertia(Physics *physics, PetscReal dt)
{
  PetscFunctionBegin;
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    Rigid    *rigid = &physics->rigids[r];
    RigidStep s;
    if (!rigid->inertial) continue;
    look(rigid, dt, &s);
    PetscCall(tell_lag(physics, dt, &s, rigid));
    for (int i = 0; i < 3; i++) {
      rigid->place[i]    = rigid->motion[i];
      rigid->velocity[i] = s.velocity[i];
      rigid->spin[i]     = s.spin[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
