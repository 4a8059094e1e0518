/* What a restart file keeps of the physics, and by what it knows the model: whatever ranks it is on. */
#include "physics/physics.h"

static uint64_t digest_curve(uint64_t before, const Curve *curve)
{
  return digest(before, (size_t)(2 * curve->n) * sizeof(*curve->points), curve->points);
}

/* Curves of a support that moves. */
static uint64_t digest_support(uint64_t before, const Support *support)
{
  PetscBool moves = support->from_file, turns = PETSC_FALSE;
  for (int i = 0; i < 3; i++) {
    moves = (PetscBool)(moves || support->value[i] != 0);
    turns = (PetscBool)(turns || support->rotate[i] != 0);
  }
  for (int k = 0; k < 9; k++)
    moves = (PetscBool)(moves || support->gradient[k] != 0);
  if (moves) before = digest_curve(before, &support->curve);
  return turns ? digest_curve(before, &support->rotate_curve) : before;
}

/* Sums over ranks: of nodes with their places and what files prescribe there; of cells with their nodes. */
static PetscErrorCode digest_mesh(const Physics *physics, uint64_t *sum)
{
  const Mesh        *mesh = physics->mesh;
  const PetscScalar *coordinates;
  PetscInt           first, end, n, nodes[CELL_NODES], at;
  Vec                vector;

  PetscFunctionBegin;
  *sum = 0;
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscReal X[3];
    uint64_t  one;
    if (physics->unknowns.ghost[k]) continue;
    PetscCall(unknowns_place(physics, k, coordinates, X, &at));
    one = digest(digest(DIGEST, sizeof(X), X), sizeof(PetscInt), &mesh->original[k]);
    for (PetscInt s = 0; s < physics->n_supports; s++) {
      if (physics->supports[s].given) one = digest(one, sizeof(X), physics->supports[s].given + 3 * k);
    }
    *sum += one;
  }
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscCall(DMPlexGetHeightStratum(mesh->dm, 0, &first, &end));
  for (PetscInt c = first; c < end; c++) {
    uint64_t one = digest(DIGEST, sizeof(PetscInt), &mesh->original_cell[c - first]);
    PetscCall(plex_cell_nodes(mesh, c, &n, nodes));
    for (PetscInt a = 0; a < n; a++)
      one = digest(one, sizeof(PetscInt), &mesh->original[mesh->here[nodes[a]]]);
    *sum += one;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 1, MPI_UINT64_T, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode physics_agree(const Physics *physics, Archive *archive)
{
  uint64_t mesh, curves = DIGEST;
  PetscFunctionBegin;
  PetscCall(digest_mesh(physics, &mesh));
  for (PetscInt s = 0; s < physics->n_supports; s++)
    curves = digest_support(curves, &physics->supports[s]);
  for (PetscInt l = 0; l < physics->n_loads; l++)
    curves = digest_curve(curves, &physics->loads[l].curve);
  PetscCall(archive_agree(archive, "mesh", mesh, "it is of another mesh, or other files say what is prescribed"));
  PetscCall(archive_agree(archive, "curves", curves,
                          "its curves are others: without a `curve` loads and supports grow up to the end of the steps, so write one where "
                          "steps are to go on beyond it"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode archive_rigid(Rigid *rigid, Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(archive_reals(archive, "rigid.turned", 9, rigid->turned));
  PetscCall(archive_reals(archive, "rigid.motion", RIGID_UNKNOWNS, rigid->motion));
  PetscCall(archive_reals(archive, "rigid.sum", 3, rigid->sum));
  if (!rigid->inertial) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(archive_reals(archive, "rigid.place", 3, rigid->place));
  PetscCall(archive_reals(archive, "rigid.velocity", 3, rigid->velocity));
  PetscCall(archive_reals(archive, "rigid.spin", 3, rigid->spin));
  PetscCall(archive_bools(archive, "rigid.told", 1, &rigid->lag_told));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode physics_archive(Physics *physics, Archive *archive)
{
  PetscFunctionBegin;
  if (!physics->ranges) PetscCall(PetscCalloc1(physics->mesh->n_bodies, &physics->ranges));
  PetscCall(archive_reals(archive, "t", 1, &physics->t));
  PetscCall(archive_reals(archive, "t_turned", 1, &physics->t_turned));
  for (PetscInt p = 0; p < physics->parts.n; p++)
    PetscCall(archive_reals(archive, "part.felt", 1, &physics->parts.part[p].felt));
  for (PetscInt b = 0; b < physics->mesh->n_bodies; b++) {
    PetscCall(archive_reals(archive, "range.strain", 1, &physics->ranges[b].strain));
    PetscCall(archive_reals(archive, "range.rotation", 1, &physics->ranges[b].rotation));
    PetscCall(archive_bools(archive, "range.told", 1, &physics->ranges[b].told));
  }
  PetscCall(laid_archive(physics, archive));
  for (PetscInt r = 0; r < physics->n_rigids; r++)
    PetscCall(archive_rigid(&physics->rigids[r], archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}
