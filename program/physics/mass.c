/* Consistent masses m_ab = int rho N_a N_b dV of the undeformed cells, of every kind and in every space; the same for each
 * component of a displacement. The rule is exact on straight cells of every kind: with fewer points a tet4 would have the masses of
 * one point, which leave motions without inertia. It is worked once. */
#include "physics/dynamics.h"

enum { ALONG = 5 }; /* Gauss points in each direction: degree 9, where products of quadratic functions in a ring have 8 */

/* Gauss point q of the square or cube; of a simplex, of the square or cube that collapses to it */
static PetscReal mass_point(CellKind kind, const PetscReal place[ALONG], const PetscReal weight[ALONG], PetscInt q, PetscReal xi[3])
{
  const PetscInt d = cell_dimension(kind);
  PetscReal      w = 1, rest = 1;
  for (int k = 0; k < 3; k++, q /= ALONG) {
    xi[k] = 0;
    if (k >= d) continue;
    if (cell_is_simplex(kind)) { /* place: from 0 to what the directions before leave */
      w *= weight[q % ALONG] / 2 * rest;
      xi[k] = (1 + place[q % ALONG]) / 2 * rest;
      rest -= xi[k];
    } else {
      w *= weight[q % ALONG];
      xi[k] = place[q % ALONG];
    }
  }
  return w;
}

/* m: n x n */
static void cell_mass(CellKind kind, const Space *space, PetscReal density, const PetscReal place[ALONG],
                      const PetscReal weight[ALONG], const PetscReal X[], PetscReal m[])
{
  const PetscInt n = cell_nodes(kind), points = cell_dimension(kind) == 2 ? ALONG * ALONG : ALONG * ALONG * ALONG;
  for (PetscInt k = 0; k < n * n; k++)
    m[k] = 0;
  for (PetscInt q = 0; q < points; q++) {
    PetscReal N[CELL_NODES], dN[CELL_NODES][3], xi[3], r = 0;
    PetscReal here = density * mass_point(kind, place, weight, q, xi);
    cell_functions(kind, xi, N, dN);
    here *= cell_physical_gradients(kind, X, dN);
    for (PetscInt a = 0; a < n; a++)
      r += N[a] * X[3 * a];
    here *= space_measure(space, r);
    for (PetscInt k = 0; k < n * n; k++)
      m[k] += here * N[k / n] * N[k % n];
  }
}

static PetscInt nodes_of(const Cells *cells, PetscInt c)
{
  return cells->offsets[c + 1] - cells->offsets[c];
}

/* Masses of this rank's cells, and which entries of a local vector have any. */
PetscErrorCode mass_create(Physics *physics)
{
  const Mesh  *mesh     = physics->mesh;
  const Cells *cells    = &physics->cells;
  Dynamics    *dynamics = physics->dynamics;
  PetscReal    place[ALONG], weight[ALONG];
  PetscInt     size = 0;

  PetscFunctionBegin;
  PetscCall(PetscDTGaussQuadrature(ALONG, -1, 1, place, weight));
  PetscCall(PetscCalloc1(cells->n, &dynamics->cells));
  for (PetscInt c = 0; c < cells->n; c++) {
    const Body *body = &mesh->bodies[cells->body[c]];
    if (body->rigid || body->analytic) continue;
    dynamics->cells[c] = (CellMass){.n = nodes_of(cells, c), .dofs = cells->dofs + cells->offsets[c], .X = cells->X + 3 * cells->offsets[c]};
    size += PetscSqr(nodes_of(cells, c));
  }
  PetscCall(PetscMalloc1(size, &dynamics->mass));
  size = 0;
  PetscCall(PetscCalloc1(physics->unknowns.n_local, &dynamics->entries));
  for (PetscInt c = 0; c < cells->n; c++) {
    CellMass *mass = &dynamics->cells[c];
    if (!mass->n) continue;
    mass->m = dynamics->mass + size;
    size += PetscSqr(mass->n);
    cell_mass(cell_kind(mesh->dimension, mass->n), &mesh->space, physics->materials[cells->body[c]].density, place, weight, mass->X, mass->m);
    for (PetscInt k = 0; k < 3 * nodes_of(cells, c); k++) {
      const PetscInt at     = cells->dofs[cells->offsets[c] + k / 3] + k % 3;
      dynamics->entries[at] = physics->unknowns.equations[at] < 0 ? MASS_PRESCRIBED : MASS_FREE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* f += factor M v, of the cells here; ranks add up */
void mass_multiply(const Physics *physics, const PetscScalar *v, PetscReal factor, PetscScalar *f)
{
  const Cells    *cells    = &physics->cells;
  const Dynamics *dynamics = physics->dynamics;
  for (PetscInt c = 0; c < cells->n; c++) {
    const PetscInt   n = dynamics->cells[c].n, *dofs = dynamics->cells[c].dofs;
    const PetscReal *m = dynamics->cells[c].m;
    for (PetscInt a = 0; a < n; a++) {
      PetscScalar sum[3] = {0, 0, 0};
      for (PetscInt b = 0; b < n; b++) {
        for (int i = 0; i < 3; i++)
          sum[i] += m[n * a + b] * v[dofs[b] + i];
      }
      for (int i = 0; i < 3; i++)
        f[dofs[a] + i] += factor * sum[i];
    }
  }
}

/* Adds factor M to a matrix of the equations. */
PetscErrorCode mass_insert(const Physics *physics, PetscReal factor, Mat matrix)
{
  static PetscReal m[MASS_NODES * MASS_NODES];
  PetscFunctionBegin;
  for (PetscInt c = 0; c < physics->cells.n; c++) {
    const CellMass *mass = &physics->dynamics->cells[c];
    const PetscInt  n    = mass->n;
    for (PetscInt k = 0; k < n * n; k++)
      m[k] = factor * mass->m[k];
    for (int i = 0; i < 3 && n; i++) {
      PetscInt equations[MASS_NODES];
      for (PetscInt a = 0; a < n; a++)
        equations[a] = physics->unknowns.equations[mass->dofs[a] + i];
      PetscCall(MatSetValues(matrix, n, equations, n, equations, m, ADD_VALUES));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode fill(const Physics *physics, Vec like, Mat matrix)
{
  PetscInt first, end;
  PetscFunctionBegin;
  PetscCall(VecGetOwnershipRange(like, &first, &end));
  PetscCall(mass_insert(physics, 1, matrix));
  for (PetscInt row = first; row < end; row++) /* multipliers: zero, and 1 below */
    PetscCall(MatSetValue(matrix, row, row, 0, ADD_VALUES));
  PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The matrix of all equations, those without mass with a 1, and its solver: conjugate gradients. Consistent masses over their own
 * diagonal are within fixed bounds, however fine the mesh is. */
PetscErrorCode mass_matrix(Physics *physics)
{
  static const PetscReal RTOL = 1e-14; /* to rounding: what is solved for goes into the velocities of all steps that follow */
  Dynamics    *dynamics = physics->dynamics;
  PetscScalar *d;
  PetscInt     n;
  Mat          counter;
  Vec          like;
  PC           pc;

  PetscFunctionBegin;
  PetscCall(DMCreateGlobalVector(physics->mesh->dm, &like));
  PetscCall(VecGetLocalSize(like, &n));
  PetscCall(MatCreate(PETSC_COMM_WORLD, &counter));
  PetscCall(MatSetSizes(counter, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(counter, MATPREALLOCATOR));
  PetscCall(MatSetUp(counter));
  PetscCall(fill(physics, like, counter));
  PetscCall(MatCreate(PETSC_COMM_WORLD, &dynamics->matrix));
  PetscCall(MatSetSizes(dynamics->matrix, n, n, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(dynamics->matrix, MATAIJ));
  PetscCall(MatPreallocatorPreallocate(counter, PETSC_TRUE, dynamics->matrix));
  PetscCall(MatDestroy(&counter));
  PetscCall(fill(physics, like, dynamics->matrix));
  PetscCall(MatGetDiagonal(dynamics->matrix, like));
  PetscCall(VecGetArray(like, &d));
  for (PetscInt k = 0; k < n; k++)
    d[k] = d[k] == 0 ? 1 : d[k];
  PetscCall(VecRestoreArray(like, &d));
  PetscCall(MatDiagonalSet(dynamics->matrix, like, INSERT_VALUES));
  PetscCall(VecDestroy(&like));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &dynamics->solver));
  PetscCall(KSPSetOptionsPrefix(dynamics->solver, "mass_"));
  PetscCall(KSPSetOperators(dynamics->solver, dynamics->matrix, dynamics->matrix));
  PetscCall(KSPSetType(dynamics->solver, KSPCG));
  PetscCall(KSPGetPC(dynamics->solver, &pc));
  PetscCall(PCSetType(pc, PCJACOBI));
  PetscCall(KSPSetTolerances(dynamics->solver, RTOL, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode mass_destroy(Physics *physics)
{
  Dynamics *dynamics = physics->dynamics;
  PetscFunctionBegin;
  for (PetscInt c = 0; dynamics->cells && c < physics->cells.n; c++) {
    CellMass *mass = &dynamics->cells[c];
    if (mass->own) PetscCall(PetscFree3(mass->dofs, mass->X, mass->m));
  }
  PetscCall(PetscFree(dynamics->cells));
  PetscCall(PetscFree(dynamics->mass));
  PetscCall(PetscFree(dynamics->bare));
  PetscFunctionReturn(PETSC_SUCCESS);
}
