/* The nodes of springs, once the mesh is distributed. */
#include "physics/springs.h"

/* Labels "spring0.name" and "spring1.name" are of the faces at either end. */
static const char *const ENDS[2] = {"spring0", "spring1"};

PetscErrorCode springs_label(Physics *physics)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; physics->springs && s < physics->springs->n; s++) {
    const Spring *spring = &physics->springs->spring[s];
    char          label[2 * NAME_LENGTH];
    for (int e = 0; e < 2; e++) {
      PetscCall(PetscSNPrintf(label, sizeof(label), "%s.%s", ENDS[e], spring->name));
      if (spring->ends[e].surface) PetscCall(plex_label_faces(physics->mesh, label, spring->ends[e].surface));
      for (PetscInt k = 0; k < spring->n_surfaces && spring->per_area && !e; k++)
        PetscCall(plex_label_faces(physics->mesh, label, spring->surfaces[k]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode find_faces(const Physics *physics, Spring *spring)
{
  PetscInt *points;
  PetscFunctionBegin;
  PetscCall(plex_labelled(physics->mesh, ENDS[0], spring->name, &spring->n_faces, &points));
  PetscCall(PetscMalloc1(spring->n_faces, &spring->faces));
  for (PetscInt k = 0; k < spring->n_faces; k++) {
    SpringFace *one = &spring->faces[k];
    Face        face;
    PetscCall(face_look_at(physics, points[k], &face));
    one->n = face.n;
    PetscCall(PetscArraycpy(one->dofs, face.dofs, face.n));
    face_products(face.kind, &physics->mesh->space, face.X, one->M);
  }
  PetscCall(PetscFree(points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Into a local vector: at the first component of each node here the area that it stands for; complete at owned ones. */
static PetscErrorCode weigh_surface(Physics *physics, const Spring *spring, int end, Vec weights)
{
  static const PetscReal along[3] = {1, 0, 0};
  PetscInt               n, *points;
  PetscScalar           *w;
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(weights));
  PetscCall(plex_labelled(physics->mesh, ENDS[end], spring->name, &n, &points));
  PetscCall(VecGetArray(weights, &w));
  for (PetscInt k = 0; k < n; k++) {
    Face      face;
    PetscReal f[3 * FACE_NODES] = {0};
    PetscCall(face_look_at(physics, points[k], &face));
    face_traction(face.kind, &physics->mesh->space, face.X, along, f);
    for (PetscInt a = 0; a < face.n; a++)
      w[face.dofs[a]] += f[3 * a];
  }
  PetscCall(VecRestoreArray(weights, &w));
  PetscCall(PetscFree(points));
  PetscCall(unknowns_sum(physics, weights));
  PetscCall(VecCopy(physics->f_sum, weights));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The end's nodes that this rank owns; `weights` NULL: the vertex. */
static PetscErrorCode own_nodes(const Physics *physics, const SpringEnd *end, const PetscScalar *weights, PetscInt *n, EndNode nodes[])
{
  const Mesh        *mesh = physics->mesh;
  const PetscScalar *coordinates;
  Vec                vector;
  PetscFunctionBegin;
  *n = 0;
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    EndNode  *node = &nodes[*n];
    PetscInt  at;
    PetscReal X[3];
    if (physics->unknowns.ghost[k] || (!weights && mesh->original[k] != end->vertex)) continue;
    PetscCall(unknowns_place(physics, k, coordinates, X, &at));
    if (weights && PetscRealPart(weights[at]) == 0) continue;
    *node = (EndNode){.at = at, .part = physics->parts.of_vertex[k], .weight = weights ? PetscRealPart(weights[at]) : 1};
    for (int i = 0; i < 3; i++) {
      node->X[i]         = X[i];
      node->equations[i] = PetscMax(physics->unknowns.equations[at + i], -1);
    }
    (*n)++;
  }
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Those of all ranks, on each. */
static PetscErrorCode gather(const Physics *physics, PetscInt n, const EndNode nodes[], SpringEnd *end)
{
  const PetscMPIInt ranks = physics->mesh->size, mine = (PetscMPIInt)(n * (PetscInt)sizeof(EndNode));
  PetscMPIInt      *counts, *starts, total = 0;
  PetscReal         sum = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc2(ranks, &counts, ranks, &starts));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, counts, 1, MPI_INT, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0; r < ranks; r++) {
    starts[r] = total;
    total += counts[r];
  }
  end->n = total / (PetscMPIInt)sizeof(EndNode);
  PetscCall(PetscMalloc1(end->n, &end->nodes));
  PetscCallMPI(MPI_Allgatherv(nodes, mine, MPI_BYTE, end->nodes, counts, starts, MPI_BYTE, PETSC_COMM_WORLD));
  for (PetscInt k = 0; k < end->n; k++) {
    const PetscInt first = starts[physics->mesh->rank] / (PetscMPIInt)sizeof(EndNode);
    if (k < first || k >= first + n) end->nodes[k].at = -1;
    sum += end->nodes[k].weight;
  }
  for (PetscInt k = 0; k < end->n; k++) {
    end->nodes[k].weight /= sum;
    for (int i = 0; i < 3; i++)
      end->X[i] += end->nodes[k].weight * end->nodes[k].X[i];
  }
  PetscCall(PetscFree2(counts, starts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode find_nodes(Physics *physics, const Spring *spring, int e, Vec weights, SpringEnd *end)
{
  const PetscScalar *w = NULL;
  EndNode           *nodes;
  PetscInt           n;
  PetscFunctionBegin;
  if (end->vertex < 0) {
    PetscCall(weigh_surface(physics, spring, e, weights));
    PetscCall(VecGetArrayRead(weights, &w));
  }
  PetscCall(PetscMalloc1(physics->mesh->n_points, &nodes));
  PetscCall(own_nodes(physics, end, w, &n, nodes));
  if (w) PetscCall(VecRestoreArrayRead(weights, &w));
  PetscCall(gather(physics, n, nodes, end));
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Its length; and what cannot be. */
static void check(Scene *scene, Spring *spring)
{
  const PetscInt n       = spring->ends[0].n + spring->ends[1].n;
  PetscReal      squared = 0;
  if (n > END_NODES)
    scene_fail(scene, spring->name, "surface",
               "its ends have %d nodes, each of which has all others in its rows: at most %d are allowed; hold a part of the surface (`surfaces`), or a node.",
               (int)n, END_NODES);
  for (int i = 0; i < 3; i++)
    squared += PetscSqr(spring->ends[0].X[i] - spring->ends[1].X[i]);
  if (!spring->axial) return;
  if (spring->length < 0) spring->length = PetscSqrtReal(squared);
  if (!(squared > 0) && (spring->length > 0 || !scene_has(scene, spring->name, "length")))
    scene_fail(scene, spring->name, "axial", "its ends are at one place, so that it has no direction: move one, or give `length: 0`.");
}

PetscErrorCode springs_create(Scene *scene, Physics *physics)
{
  Springs *springs = physics->springs;
  Vec      weights;
  PetscFunctionBegin;
  if (!springs) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(physics->u_local, &springs->forces));
  PetscCall(VecDuplicate(physics->u_local, &weights));
  for (PetscInt s = 0; s < springs->n; s++) {
    Spring *spring = &springs->spring[s];
    for (int e = 0; e < 2; e++) {
      const SpringEnd *end = &spring->ends[e];
      if (end->vertex >= 0 || end->surface) PetscCall(find_nodes(physics, spring, e, weights, &spring->ends[e]));
    }
    if (spring->per_area) PetscCall(find_faces(physics, spring));
    check(scene, spring);
  }
  PetscCall(VecDestroy(&weights));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode springs_destroy(Physics *physics)
{
  Springs *springs = physics->springs;
  PetscFunctionBegin;
  if (!springs) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s < springs->n; s++) {
    for (int e = 0; e < 2; e++)
      PetscCall(PetscFree(springs->spring[s].ends[e].nodes));
    PetscCall(PetscFree(springs->spring[s].surfaces));
    PetscCall(PetscFree(springs->spring[s].faces));
  }
  PetscCall(VecDestroy(&springs->forces));
  PetscCall(PetscFree(springs->spring));
  PetscCall(PetscFree(physics->springs));
  PetscFunctionReturn(PETSC_SUCCESS);
}
