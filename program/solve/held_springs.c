/* What springs hold of the rigid motions of parts (motions.c): one row for each direction in which they resist. */
#include "solve/motions.h"
#include "physics/springs.h"

/* Where its ends' nodes are at u (NULL: undeformed), 3 each, on every rank. */
static PetscErrorCode place_nodes(const Spring *spring, const PetscScalar *u, PetscReal x[])
{
  PetscInt n = 0;
  PetscFunctionBegin;
  for (int e = 0; e < 2; e++) {
    for (PetscInt k = 0; k < spring->ends[e].n; k++, n += 3) {
      const EndNode *node = &spring->ends[e].nodes[k];
      for (int i = 0; i < 3; i++)
        x[n + i] = node->at < 0 ? 0 : node->X[i] + (u ? PetscRealPart(u[node->at + i]) : 0);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, x, (PetscMPIInt)n, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The directions in which it resists, 3 each, and its stiffness in them: the axes of the scene; axial: the line between the ends. */
static int directions(const Physics *physics, const Spring *spring, const PetscReal x[], PetscReal d[9], PetscReal stiffness[3])
{
  int n = 0;
  if (spring->axial) {
    PetscReal squared = 0;
    for (int i = 0; i < 3; i++) {
      d[i] = spring->fixed ? -spring->ends[1].X[i] : 0;
      for (PetscInt k = 0; k < spring->ends[0].n + spring->ends[1].n; k++) {
        const PetscInt other = k - spring->ends[0].n;
        d[i] += (other < 0 ? spring->ends[0].nodes[k].weight : -spring->ends[1].nodes[other].weight) * x[3 * k + i];
      }
      squared += PetscSqr(d[i]);
    }
    for (int i = 0; i < 3 && squared > 0; i++)
      d[i] /= PetscSqrtReal(squared);
    stiffness[0] = spring->stiffness[0];
    return squared > 0;
  }
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3 && spring->stiffness[i] > 0; j++)
      d[3 * n + j] = physics->mesh->rotation[3 * j + i];
    if (spring->stiffness[i] > 0) stiffness[n++] = spring->stiffness[i];
  }
  return n;
}

/* One row: the first end from the second one. */
static void add_ends(const Spring *spring, const PetscReal x[], const PetscReal d[3], PetscReal factor, Motions *m)
{
  PetscInt  columns[MODES * END_NODES];
  PetscReal values[MODES * END_NODES];
  int       n = 0;
  for (int e = 0; e < 2; e++) {
    for (PetscInt k = 0; k < spring->ends[e].n; k++, x += 3)
      motions_row(m, spring->ends[e].nodes[k].part, x, d, (e ? -1 : 1) * factor * spring->ends[e].nodes[k].weight, columns, values, &n);
  }
  motions_constrain(m, n, columns, values);
}

/* A row for each node of the faces on the ground; by stiffness it counts by what the faces here have at the node. */
static PetscErrorCode add_nodes(const Physics *physics, const Spring *spring, const PetscScalar *u, const PetscReal d[3], PetscReal stiffness,
                                Motions *m)
{
  const PetscScalar *coordinates;
  PetscBool         *on;
  PetscReal         *area;
  Vec                vector;
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(physics->unknowns.n_local, &on, physics->unknowns.n_local, &area));
  for (PetscInt k = 0; k < spring->n_faces; k++) {
    const SpringFace *face = &spring->faces[k];
    for (PetscInt a = 0; a < face->n; a++) {
      on[face->dofs[a]] = PETSC_TRUE;
      area[face->dofs[a]] += face->M[face->n * a + a];
    }
  }
  PetscCall(DMGetCoordinatesLocal(physics->mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  for (PetscInt k = 0; k < physics->mesh->n_points; k++) {
    PetscInt  at, columns[MODES];
    PetscReal x[3], values[MODES];
    int       n = 0;
    PetscCall(unknowns_place(physics, k, coordinates, x, &at));
    if (!on[at]) continue;
    for (int i = 0; i < 3 && u; i++)
      x[i] += PetscRealPart(u[at + i]);
    motions_row(m, physics->parts.of_vertex[k], x, d, stiffness > 0 ? PetscSqrtReal(stiffness * area[at]) : 1, columns, values, &n);
    motions_constrain(m, n, columns, values);
  }
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscCall(PetscFree2(on, area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode motions_add_springs(const Physics *physics, Vec u_local, PetscBool by_stiffness, Motions *m)
{
  const Springs     *springs = physics->springs;
  const PetscScalar *u       = NULL;
  PetscReal          x[3 * END_NODES], d[9], stiffness[3];
  PetscFunctionBegin;
  if (!springs) PetscFunctionReturn(PETSC_SUCCESS);
  if (u_local) PetscCall(VecGetArrayRead(u_local, &u));
  for (PetscInt s = 0; s < springs->n; s++) {
    const Spring *spring = &springs->spring[s];
    int           n;
    PetscCall(place_nodes(spring, u, x));
    n = directions(physics, spring, x, d, stiffness);
    for (int k = 0; k < n; k++) {
      if (spring->per_area)
        PetscCall(add_nodes(physics, spring, u, d + 3 * k, by_stiffness ? stiffness[k] : 0, m));
      else if (!physics->mesh->rank)
        add_ends(spring, x, d + 3 * k, by_stiffness ? PetscSqrtReal(stiffness[k]) : 1, m);
    }
  }
  if (u_local) PetscCall(VecRestoreArrayRead(u_local, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
