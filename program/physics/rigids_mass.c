/* Mass of a rigid body, and its moments of inertia about the reference point in the axes of the first configuration: by `density` of what its
 * surface encloses, or by `mass` and `inertia` as the scene gives them. The reference point is the centre of mass: then weight has no
 * moment about it, and the motions of the point and of turning are coupled by nothing.
 *
 * Faces are split into triangles, each of which makes a tetrahedron with the reference point; with corners a, b, c from there and its
 * volume v = a . (b x c) / 6
 *
 *   int dV = v,   int x dV = v (a + b + c) / 4,   int x x^T dV = v (a a^T + b b^T + c c^T + s s^T) / 20,   s = a + b + c,
 *
 * and the inertia is I tr S - S with S = int rho x x^T dV. In the plane edges make triangles in the same way. */
#include "physics/physics.h"

/* How far from the reference point the centre may lie, over the body's size: digits that a user copies from the message. */
static const PetscReal CENTRE = 1e-8;
/* Moments of a body that is thin or given by hand may be this much of the largest below what any body has: rounding. */
static const PetscReal ROUNDING = 1e-10;

enum { MASS, CENTRE_AT, SECOND = CENTRE_AT + 3, SUMS = SECOND + 9 };

typedef struct {
  PetscInt  low, high;
  PetscBool up; /* from low to high */
} Side;

/* Does the shell enclose a volume: is each edge of a face the edge of one other, which goes the other way? In the plane the faces are
 * edges, and their ends meet: the side of an end is that of its vertex with itself. */
static PetscErrorCode encloses(const Shell *shell, PetscInt dimension, PetscBool *closed)
{
  Side    *sides;
  PetscInt n = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(shell->offsets[shell->n_faces], &sides));
  for (PetscInt f = 0; f < shell->n_faces; f++) {
    const PetscInt *v = shell->vertices + shell->offsets[f], m = shell->offsets[f + 1] - shell->offsets[f];
    for (PetscInt k = 0; k < m; k++) {
      const PetscInt a = v[k], b = dimension == 3 ? v[(k + 1) % m] : a;
      sides[n++] = (Side){.low = PetscMin(a, b), .high = PetscMax(a, b), .up = dimension == 3 ? (PetscBool)(a < b) : (PetscBool)(k == 0)};
    }
  }
  PetscCall(PetscTimSort(n, sides, sizeof(*sides), orient_compare, NULL));
  *closed = (PetscBool)(n > 0 && n % 2 == 0);
  for (PetscInt k = 0; k < n && *closed; k += 2)
    *closed = (PetscBool)(!orient_compare(&sides[k], &sides[k + 1], NULL) && sides[k].up != sides[k + 1].up &&
                          (k + 2 == n || orient_compare(&sides[k], &sides[k + 2], NULL)));
  PetscCall(PetscFree(sides));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the simplex of the point and n corners with a volume, all in the axes of the scene. */
static void add_simplex(PetscInt n, const PetscReal corner[3][3], PetscReal volume, PetscReal sums[SUMS])
{
  PetscReal s[3] = {0, 0, 0};
  for (PetscInt k = 0; k < n; k++)
    for (int i = 0; i < 3; i++)
      s[i] += corner[k][i];
  sums[MASS] += volume;
  for (int i = 0; i < 3; i++) {
    sums[CENTRE_AT + i] += volume * s[i] / (PetscReal)(n + 1);
    for (int j = 0; j < 3; j++) {
      PetscReal product = s[i] * s[j];
      for (PetscInt k = 0; k < n; k++)
        product += corner[k][i] * corner[k][j];
      sums[SECOND + 3 * i + j] += volume * product / (PetscReal)((n + 1) * (n + 2));
    }
  }
}

/* Mass, its moments about `point` of first and second order. */
static void add_shell(const Space *space, const Shell *shell, PetscInt dimension, const PetscReal point[3], PetscReal sums[SUMS])
{
  for (PetscInt f = 0; f < shell->n_faces; f++) {
    const PetscInt *v = shell->vertices + shell->offsets[f], m = shell->offsets[f + 1] - shell->offsets[f];
    for (PetscInt t = 0; t < (dimension == 3 ? m - 2 : 1); t++) { /* a fan; of a line itself */
      const PetscInt at[3] = {0, t + 1, t + 2};
      PetscReal      x[3][3], volume, radius = point[0];
      for (PetscInt k = 0; k < dimension; k++)
        for (int i = 0; i < 3; i++)
          x[k][i] = shell->coordinates[3 * v[at[k]] + i] - point[i];
      if (dimension == 3) {
        volume = 0;
        for (int i = 0; i < 3; i++)
          volume += x[0][i] * (x[1][(i + 1) % 3] * x[2][(i + 2) % 3] - x[1][(i + 2) % 3] * x[2][(i + 1) % 3]) / 6;
      } else {
        volume = (x[0][0] * x[1][1] - x[0][1] * x[1][0]) / 2;
        radius += (x[0][0] + x[1][0]) / 3;
      }
      add_simplex(dimension, (const PetscReal(*)[3])x, volume * space_measure(space, radius), sums);
    }
  }
}

/* I tr S - S; in the plane about the third axis. */
static void inertia_of(const PetscReal second[9], PetscReal inertia[9])
{
  const PetscReal trace = second[0] + second[4] + second[8];
  for (int k = 0; k < 9; k++)
    inertia[k] = (k % 4 == 0 ? trace : 0) - second[k];
}

/* Rank 0: what the body's surface encloses, at density 1. */
static PetscErrorCode measure(Scene *scene, const Mesh *mesh, const Body *body, const PetscReal point[3], PetscReal sums[SUMS])
{
  const Shell *shell   = &body->shell;
  PetscReal    largest = 0;
  PetscBool    closed = PETSC_FALSE;
  PetscFunctionBegin;
  for (PetscInt f = 0; f < shell->n_faces; f++) {
    const PetscInt m = shell->offsets[f + 1] - shell->offsets[f];
    if (m > (mesh->dimension == 3 ? 4 : 2))
      scene_fail(scene, body->name, "density", "its faces are quadratic, and what they enclose is not worked out: give `mass` and `inertia`.");
  }
  PetscCall(encloses(shell, mesh->dimension, &closed));
  if (!closed)
    scene_fail(scene, body->name, "density", "its surfaces do not enclose a volume: each edge of a face must be that of one other. Give `mass` "
                                             "and `inertia`.");
  add_shell(&mesh->space, shell, mesh->dimension, point, sums);
  if (sums[MASS] < 0)
    for (int k = 0; k < SUMS; k++)
      sums[k] = -sums[k];
  for (PetscInt v = 0; v < shell->n_vertices; v++)
    for (int i = 0; i < 3; i++)
      largest = PetscMax(largest, PetscAbsReal(shell->coordinates[3 * v + i] - point[i]));
  for (int i = 0; i < 3; i++) {
    sums[CENTRE_AT + i] /= sums[MASS];
    if (mesh->space.kind == SPACE_AXISYMMETRIC && i == 0) sums[CENTRE_AT] = 0; /* of a ring it is on the axis */
  }
  for (int i = 0; i < 3; i++) {
    if (PetscAbsReal(sums[CENTRE_AT + i]) <= CENTRE * largest) continue;
    scene_fail(scene, body->name, "reference", "with `density` it is the centre of mass, which lies at [%.12g, %.12g, %.12g]: move it there.",
               (double)(point[0] + sums[CENTRE_AT]), (double)(point[1] + sums[CENTRE_AT + 1]), (double)(point[2] + sums[CENTRE_AT + 2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a body that is free to turn, in space: is it the inertia of any body? Its moments are those of a positive second moment
 * S = I tr J / 2 - J: no minor around its diagonal is negative. Nor is it that of a rod without thickness, which may turn about its axis for
 * nothing. */
static PetscBool is_of_a_body(const PetscReal J[9])
{
  const PetscReal half = (J[0] + J[4] + J[8]) / 2, a = half - J[0], b = half - J[4], c = half - J[8], slack = ROUNDING * half;
  const PetscReal ab = a * b - J[1] * J[1], bc = b * c - J[5] * J[5], ca = c * a - J[2] * J[2];
  const PetscReal all = a * bc + J[1] * (-J[1] * c - J[5] * J[2]) - J[2] * (J[1] * J[5] + b * J[2]);
  const PetscReal determinant = J[0] * (J[4] * J[8] - J[5] * J[5]) - J[1] * (J[1] * J[8] - J[5] * J[2]) + J[2] * (J[1] * J[5] - J[4] * J[2]);
  return (PetscBool)(half > 0 && a >= -slack && b >= -slack && c >= -slack && ab >= -slack * half && bc >= -slack * half &&
                     ca >= -slack * half && all >= -slack * half * half && determinant > slack * half * half);
}

/* `inertia`, where it is given: a property of the body as its mass is, whether anything asks for it or not. */
static void read_inertia(Scene *scene, const Mesh *mesh, Rigid *rigid)
{
  static const int place[6][2] = {{0, 0}, {4, 4}, {8, 8}, {5, 7}, {2, 6}, {1, 3}};
  const char      *name = mesh->bodies[rigid->body].name;
  PetscReal       *values;
  PetscInt         n;
  scene_reals(scene, name, "inertia", &n, &values);
  if (n && n != (mesh->dimension == 3 ? 3 : 1) && !(mesh->dimension == 3 && n == 6))
    scene_fail(scene, name, "inertia", mesh->dimension == 3 ? "3 numbers are expected, xx, yy, zz, or 6, with yz, zx, xy."
                                                            : "1 number is expected: the body turns about z alone.");
  for (PetscInt k = 0; k < n; k++) {
    const int *at = place[mesh->dimension == 3 ? k : 2];
    rigid->inertia[at[0]] = rigid->inertia[at[1]] = values[k];
  }
  if (n && mesh->dimension == 2) rigid->inertia[0] = rigid->inertia[4] = values[0] / 2;
  if (n) rigid->has_inertia = PETSC_TRUE;
  PetscCallAbort(PETSC_COMM_WORLD, PetscFree(values));
  if (n && !is_of_a_body(rigid->inertia))
    scene_fail(scene, name, "inertia", "no body has it: moments are positive, and none is more than the sum of the two others.");
}

/* `mass` and `inertia`, or `density`, which gives both. Where the scene is turned into a frame this comes before it. */
PetscErrorCode rigids_read_mass(Scene *scene, const Mesh *mesh, Rigid *rigid)
{
  const Body *body    = &mesh->bodies[rigid->body];
  PetscReal   density = 0, point[3] = {0, 0, 0}, sums[SUMS] = {0};
  PetscFunctionBegin;
  scene_real(scene, body->name, "mass", &rigid->mass);
  if (!scene_has(scene, body->name, "density")) {
    read_inertia(scene, mesh, rigid);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  scene_real(scene, body->name, "density", &density);
  if (scene_has(scene, body->name, "mass")) scene_fail(scene, body->name, "density", "there is a `mass` beside it: give one of them.");
  if (scene_has(scene, body->name, "inertia")) scene_fail(scene, body->name, "inertia", "`density` gives it already: leave one out.");
  if (body->analytic) scene_fail(scene, body->name, "density", "its surface is in closed form, and may have no end: give `mass` and `inertia`.");
  (void)space_vector(scene, &mesh->space, body->name, "reference", point);
  scene_root_begin(scene);
  if (mesh->rank == 0) PetscCall(measure(scene, mesh, body, point, sums));
  PetscCall(scene_root_end(scene));
  PetscCallMPI(MPI_Bcast(sums, SUMS, MPIU_REAL, 0, PETSC_COMM_WORLD));
  rigid->mass = density * sums[MASS];
  for (int k = 0; k < 9; k++)
    sums[SECOND + k] *= density;
  inertia_of(sums + SECOND, rigid->inertia);
  rigid->has_inertia = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The axes of the scene are turned into those of a frame. */
static void into_frame(const Mesh *mesh, PetscReal inertia[9])
{
  for (int pass = 0; pass < 2; pass++) { /* columns, then of the transpose the same */
    PetscReal turned[9];
    for (int j = 0; j < 3; j++) {
      PetscReal column[3] = {inertia[j], inertia[3 + j], inertia[6 + j]};
      mesh_rotate_vector(mesh, column);
      for (int i = 0; i < 3; i++)
        turned[3 * j + i] = column[i];
    }
    for (int k = 0; k < 9; k++)
      inertia[k] = turned[k];
  }
}

/* A spin that supports prescribe in part is none: the rest of it would not follow from the moments that act. */
static void check_turning(Scene *scene, const Physics *physics, const Support *support, const Rigid *rigid)
{
  const PetscInt  turns = 7 << 3, held = rigid->held | support->turns << 3;
  const PetscBool turned = (PetscBool)(support->rotate[0] != 0 || support->rotate[1] != 0 || support->rotate[2] != 0);
  const PetscBool caught = (PetscBool)(support->from > 0 && support->turns);
  if ((turned || caught) && (held & turns) != turns)
    scene_fail(scene, support->name, turned ? "rotate" : "from", "'%s' is free to turn in part: with `dynamics` a rigid body is %s in all of its turns, or in none.",
               physics->mesh->bodies[rigid->body].name, turned ? "turned" : "caught");
}

/* With `dynamics`: of a body that is not held in all, what its inertia asks for. */
void rigids_read_inertia(Scene *scene, const Physics *physics, Rigid *rigid)
{
  const PetscInt turns = 7 << 3, all = (1 << RIGID_UNKNOWNS) - 1;
  const char    *name = physics->mesh->bodies[rigid->body].name;
  if (rigid->held == all) return;
  if (!(rigid->mass > 0)) scene_fail(scene, name, "mass", "one above 0 is needed, or `density`: with `dynamics` it moves by its inertia.");
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    if (physics->supports[s].rigid == rigid - physics->rigids) check_turning(scene, physics, &physics->supports[s], rigid);
  }
  if ((rigid->held & turns) != turns || rigid->turned_by) {
    if (!rigid->has_inertia)
      scene_fail(scene, name, "inertia", "this key is missing: it turns, and `dynamics` asks for its moments of inertia, or for `density` in place of "
                                         "`mass`.");
    if (!is_of_a_body(rigid->inertia)) scene_fail(scene, name, "density", "its surface encloses a body without thickness, which may turn for nothing.");
    if (physics->mesh->rotated) into_frame(physics->mesh, rigid->inertia);
  }
  rigid->inertial = PETSC_TRUE;
}
