/* Nodal forces of what acts on a cell or on a face of it. */
#include "physics/element_loads.h"

/* b = uniform - w x (w x (X - origin)) */
static void acceleration_at(const Acceleration *of, const PetscReal X[3], PetscReal b[3])
{
  PetscReal arm[3], w_arm[3];
  for (int i = 0; i < 3; i++)
    arm[i] = X[i] - of->origin[i];
  for (int i = 0; i < 3; i++)
    w_arm[i] = of->spin[(i + 1) % 3] * arm[(i + 2) % 3] - of->spin[(i + 2) % 3] * arm[(i + 1) % 3];
  for (int i = 0; i < 3; i++)
    b[i] = of->uniform[i] - (of->spin[(i + 1) % 3] * w_arm[(i + 2) % 3] - of->spin[(i + 2) % 3] * w_arm[(i + 1) % 3]);
}

void cell_body_forces(CellKind kind, const Space *space, PetscReal density, const Acceleration *acceleration,
                      const PetscReal X[], PetscReal f[])
{
  const PetscInt nodes = cell_nodes(kind);
  for (PetscInt k = 0; k < 3 * nodes; k++)
    f[k] = 0;
  for (PetscInt q = 0; q < cell_quadrature_points(kind); q++) {
    PetscReal N[CELL_NODES], dN[CELL_NODES][3], xi[3], x[3] = {0, 0, 0}, b[3];
    PetscReal mass = density * cell_quadrature_point(kind, q, xi);
    cell_functions(kind, xi, N, dN);
    mass *= cell_physical_gradients(kind, X, dN);
    for (PetscInt k = 0; k < 3 * nodes; k++)
      x[k % 3] += N[k / 3] * X[k];
    acceleration_at(acceleration, x, b);
    for (PetscInt k = 0; k < 3 * nodes; k++)
      f[k] += mass * space_measure(space, x[0]) * N[k / 3] * b[k % 3];
  }
}

/* A point of a face: N, dN/dxi, the two tangents, of which a line's second one is as long as 1 across the plane, and their
 * product; weight and radius. */
typedef struct {
  PetscReal N[FACE_NODES], d[FACE_NODES][3], tangent[2][3], normal[3], weight, radius;
} FacePoint;

static void face_point(CellKind kind, const PetscReal x[], PetscInt q, FacePoint *point)
{
  PetscReal xi[3];
  *point        = (FacePoint){.tangent[1][2] = cell_dimension(kind) == 1};
  point->weight = cell_quadrature_point(kind, q, xi);
  cell_functions(kind, xi, point->N, point->d);
  for (PetscInt a = 0; a < cell_nodes(kind); a++) {
    point->radius += point->N[a] * x[3 * a];
    for (int i = 0; i < 3; i++) {
      point->tangent[0][i] += point->d[a][0] * x[3 * a + i];
      point->tangent[1][i] += point->d[a][1] * x[3 * a + i];
    }
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    point->normal[i] = point->tangent[0][j] * point->tangent[1][k] - point->tangent[0][k] * point->tangent[1][j];
  }
}

void face_pressure(CellKind kind, const Space *space, const PetscReal x[], PetscReal pressure, PetscReal f[],
                   PetscReal K[])
{
  const PetscInt nodes = cell_nodes(kind), n = 3 * nodes;
  for (PetscInt k = 0; k < n; k++)
    f[k] = 0;
  for (PetscInt k = 0; k < n * n && K; k++)
    K[k] = 0;
  for (PetscInt q = 0; q < cell_quadrature_points(kind); q++) {
    FacePoint point;
    PetscReal p;
    face_point(kind, x, q, &point);
    p = -pressure * point.weight * space_measure(space, point.radius);
    for (PetscInt k = 0; k < n; k++)
      f[k] += p * point.N[k / 3] * point.normal[k % 3];
    for (PetscInt b = 0; b < nodes && K; b++) {
      PetscReal along[3]; /* d normal_i / dx_bj = e_ijk along_k */
      for (int k = 0; k < 3; k++)
        along[k] = point.d[b][0] * point.tangent[1][k] - point.d[b][1] * point.tangent[0][k];
      for (PetscInt ai = 0; ai < n; ai++) {
        const int       i   = (int)(ai % 3), j = (i + 1) % 3, k = (i + 2) % 3;
        const PetscReal N_p = p * point.N[ai / 3];
        K[n * ai + 3 * b + j] += N_p * along[k];
        K[n * ai + 3 * b + k] -= N_p * along[j];
        if (space->kind == SPACE_AXISYMMETRIC)
          K[n * ai + 3 * b] += N_p / point.radius * point.N[b] * point.normal[i];
      }
    }
  }
}

/* what a point stands for */
static PetscReal face_area(CellKind kind, const Space *space, const PetscReal X[], PetscInt q, FacePoint *point)
{
  PetscReal squared = 0;
  face_point(kind, X, q, point);
  for (int i = 0; i < 3; i++)
    squared += PetscSqr(point->normal[i]);
  return point->weight * space_measure(space, point->radius) * PetscSqrtReal(squared);
}

void face_traction(CellKind kind, const Space *space, const PetscReal X[], const PetscReal traction[3], PetscReal f[])
{
  for (PetscInt q = 0; q < cell_quadrature_points(kind); q++) {
    FacePoint       point;
    const PetscReal area = face_area(kind, space, X, q, &point);
    for (PetscInt k = 0; k < 3 * cell_nodes(kind); k++)
      f[k] += area * point.N[k / 3] * traction[k % 3];
  }
}

void face_products(CellKind kind, const Space *space, const PetscReal X[], PetscReal M[])
{
  const PetscInt nodes = cell_nodes(kind);
  for (PetscInt k = 0; k < nodes * nodes; k++)
    M[k] = 0;
  for (PetscInt q = 0; q < cell_quadrature_points(kind); q++) {
    FacePoint       point;
    const PetscReal area = face_area(kind, space, X, q, &point);
    for (PetscInt k = 0; k < nodes * nodes; k++)
      M[k] += area * point.N[k / nodes] * point.N[k % nodes];
  }
}
