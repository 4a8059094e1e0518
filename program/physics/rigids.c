/* Rigid bodies: where a motion puts their nodes, and what the forces on these are at the reference point (docs/formulation 14, by
 * the library). Their nodes are prescribed entries of the local vectors, which follow the body's own six unknowns.
 *
 * These are the displacements of two vertices (mesh/rigid.c). That of the first is the reference point's, [L]. The second has the
 * rotation vector of the step times the body's length, [L] too; its equation is the moment over that length, a force. So norms and
 * tolerances need not know of rotations. After a step the body has taken its rotation over, and the vector is zero. */
#include "physics/physics.h"

enum { FIRST = 2 }; /* of a body's vertices, the first that moves with it */

/* The motion by the six numbers of now, in the library's words. */
stickslip_rigid_motion rigids_motion(const Rigid *rigid)
{
  stickslip_rigid_motion motion = {.struct_size = sizeof(motion)};
  if (rigid->inertial) motion.arms = STICKSLIP_RIGID_ARMS_MIDDLE; /* so that its moment works what its forces do (rigids_inertia.c) */
  for (int i = 0; i < 3; i++) {
    motion.displacement[i] = rigid->motion[i];
    motion.rotation[i]     = rigid->motion[3 + i];
  }
  for (int k = 0; k < 9; k++)
    motion.turned[k] = rigid->turned[k];
  return motion;
}

/* Its nodes here, from the reference point. */
static stickslip_rigid_body body_of(const Rigid *rigid)
{
  static const double  origin[3] = {0, 0, 0};
  stickslip_rigid_body body      = {.struct_size = sizeof(body), .dimension = 3, .n_nodes = rigid->n_nodes,
                                    .coordinates = rigid->arms, .point = origin};
  return body;
}

/* Nodes of the body on this rank, and the two vertices of its unknowns. */
static PetscErrorCode find_nodes(Physics *physics, Rigid *rigid, const PetscScalar *coordinates, PetscSection section)
{
  const Mesh *mesh = physics->mesh;
  PetscReal   point[3] = {0, 0, 0}, squared = 0;
  PetscFunctionBegin;
  rigid->at[0] = rigid->at[1] = -1;
  for (int pass = 0; pass < 2; pass++) { /* the reference point first */
    rigid->n_nodes = 0;
    for (PetscInt k = 0; k < mesh->n_points; k++) {
      const PetscInt number = mesh->original[k] - rigid->first_vertex;
      PetscInt       dof, at;
      if (number < 0 || mesh->original[k] >= rigid->end_vertex) continue;
      PetscCall(PetscSectionGetOffset(physics->unknowns.section, mesh->points[k], &dof));
      PetscCall(PetscSectionGetOffset(section, mesh->points[k], &at));
      if (number < FIRST) {
        rigid->at[number] = dof;
        if (number == 0) rigid->owned = (PetscBool)!physics->unknowns.ghost[k];
        for (int i = 0; i < 3; i++)
          point[i] = PetscRealPart(coordinates[at + i]);
        continue;
      }
      if (pass) {
        PetscReal arm = 0;
        for (int i = 0; i < 3; i++) {
          rigid->arms[3 * rigid->n_nodes + i] = PetscRealPart(coordinates[at + i]) - point[i];
          arm += PetscSqr(rigid->arms[3 * rigid->n_nodes + i]);
        }
        squared                      = PetscMax(squared, arm);
        rigid->dofs[rigid->n_nodes] = dof;
      }
      rigid->n_nodes++;
    }
    if (!pass) PetscCall(PetscMalloc2(3 * rigid->n_nodes, &rigid->arms, rigid->n_nodes, &rigid->dofs));
  }
  rigid->length = PetscSqrtReal(squared);
  for (int i = 0; i < 3; i++)
    rigid->point[i] = rigid->owned ? point[i] : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &rigid->length, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, rigid->point, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Once there are unknowns. */
PetscErrorCode rigids_create(Physics *physics)
{
  const Mesh        *mesh = physics->mesh;
  const PetscScalar *coordinates;
  PetscSection       section;
  Vec                vector;
  PetscFunctionBegin;
  if (!physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMGetCoordinateSection(mesh->dm, &section));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    Rigid *rigid = &physics->rigids[r];
    PetscCall(find_nodes(physics, rigid, coordinates, section));
    for (int k = 0; k < RIGID_UNKNOWNS; k++)
      rigid->equations[k] = rigid->owned ? physics->unknowns.equations[rigid->at[k / 3] + k % 3] : -1;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, rigid->equations, RIGID_UNKNOWNS, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
    for (int k = 0; k < RIGID_UNKNOWNS; k++)
      rigid->equations[k] = rigid->equations[k] < 0 ? -1 : rigid->equations[k];
    for (int k = 0; k < 9; k++)
      rigid->turned[k] = k % 4 == 0;
  }
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode rigids_destroy(Physics *physics)
{
  PetscFunctionBegin;
  for (PetscInt r = 0; r < physics->n_rigids; r++)
    PetscCall(PetscFree2(physics->rigids[r].arms, physics->rigids[r].dofs));
  PetscCall(PetscFree(physics->rigids));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The support that prescribes an unknown now; NULL: none */
const Support *rigid_holder(const Physics *physics, const Rigid *rigid, int k)
{
  if (rigid->support[k] >= 0) return &physics->supports[rigid->support[k]];
  for (PetscInt s = 0; s < physics->n_supports && physics->timed; s++) {
    const Support *support = &physics->supports[s];
    if (support->timed && support->active && support->rigid == rigid - physics->rigids && ((support->mask | support->turns << 3) & (1 << k))) return support;
  }
  return NULL;
}

/* What is prescribed at t, into a local vector. The rotation is that since the last step. */
PetscErrorCode rigids_prescribe(Physics *physics, PetscReal t, Vec local)
{
  PetscScalar *array;
  PetscFunctionBegin;
  if (!physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(local, &array));
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    for (int k = 0; k < RIGID_UNKNOWNS && rigid->at[0] >= 0; k++) {
      const Support *support = rigid_holder(physics, rigid, k);
      PetscReal      v[3]    = {0, 0, 0};
      for (int i = 0; i < 3 && support; i++) {
        if (k < 3)
          v[i] = curve_value(&support->curve, t) * support->value[i];
        else
          v[i] = rigid->length * support->rotate[i] *
                 (curve_value(&support->rotate_curve, t) - curve_value(&support->rotate_curve, physics->t_turned));
      }
      mesh_rotate_vector(physics->mesh, v);
      if (support || rigid->held & (1 << k)) array[rigid->at[k / 3] + k % 3] = v[k % 3];
    }
  }
  PetscCall(VecRestoreArray(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The motions that a local vector has, for all ranks. */
static PetscErrorCode read_motions(Physics *physics, const PetscScalar *array)
{
  PetscReal *all;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(RIGID_UNKNOWNS * physics->n_rigids, &all));
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    for (int k = 0; k < RIGID_UNKNOWNS && rigid->owned; k++)
      all[RIGID_UNKNOWNS * r + k] = PetscRealPart(array[rigid->at[k / 3] + k % 3]) / (k < 3 ? 1 : rigid->length);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, (PetscMPIInt)(RIGID_UNKNOWNS * physics->n_rigids), MPIU_REAL, MPIU_SUM,
                             PETSC_COMM_WORLD));
  for (PetscInt k = 0; k < RIGID_UNKNOWNS * physics->n_rigids; k++)
    physics->rigids[k / RIGID_UNKNOWNS].motion[k % RIGID_UNKNOWNS] = all[k];
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Displacements of the nodes in the motion of now; where the library refuses it, they stay. */
static PetscErrorCode place(Physics *physics, const Rigid *rigid, PetscScalar *array)
{
  static const double          any[3] = {0, 0, 0};
  stickslip_rigid_body         body   = body_of(rigid);
  const stickslip_rigid_motion motion = rigids_motion(rigid);
  double                      *x;
  PetscFunctionBegin;
  if (!rigid->n_nodes) body.n_nodes = 1, body.coordinates = any; /* so that all ranks refuse, or none */
  PetscCall(PetscMalloc1(3 * (rigid->n_nodes + 1), &x));
  if (stickslip_rigid_positions(&body, &motion, x)) {
    PetscCall(PetscSNPrintf(physics->inverted, sizeof(physics->inverted), "the rigid body '%s' cannot move so in one step: %s",
                            physics->mesh->bodies[rigid->body].name, stickslip_last_error_message()));
    physics->rigid_refused = PETSC_TRUE;
  } else {
    for (PetscInt k = 0; k < 3 * rigid->n_nodes; k++)
      array[rigid->dofs[k / 3] + k % 3] = x[k] - rigid->arms[k];
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode rigids_place(Physics *physics, Vec local)
{
  PetscScalar *array;
  PetscFunctionBegin;
  if (!physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  physics->rigid_refused = PETSC_FALSE;
  PetscCall(VecGetArray(local, &array));
  PetscCall(read_motions(physics, array));
  for (PetscInt r = 0; r < physics->n_rigids; r++)
    PetscCall(place(physics, &physics->rigids[r], array));
  PetscCall(VecRestoreArray(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The forces on nodes become those of the two vertices. What other ranks add, they add to theirs. */
PetscErrorCode rigids_collect(Physics *physics, Vec f_local, PetscBool keep)
{
  const PetscBool ring = (PetscBool)(physics->mesh->space.kind == SPACE_AXISYMMETRIC);
  PetscScalar    *f;
  double         *forces;
  PetscFunctionBegin;
  if (!physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(f_local, &f));
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    Rigid                       *rigid  = &physics->rigids[r];
    const stickslip_rigid_body   body   = body_of(rigid);
    const stickslip_rigid_motion motion = rigids_motion(rigid);
    double                       sum[RIGID_UNKNOWNS];
    if (rigid->at[0] < 0) continue;
    PetscCall(PetscMalloc1(3 * rigid->n_nodes + 1, &forces));
    for (PetscInt k = 0; k < 3 * rigid->n_nodes; k++) {
      PetscScalar *entry = &f[rigid->dofs[k / 3] + k % 3];
      forces[k]          = PetscRealPart(*entry);
      *entry             = 0;
    }
    if (physics->rigid_refused || stickslip_rigid_resultant(&body, &motion, forces, sum))
      PetscCall(PetscArrayzero(sum, RIGID_UNKNOWNS)); /* what is not finite ends the attempt by itself */
    for (int k = 0; k < RIGID_UNKNOWNS; k++) {
      if (ring && k != 1) sum[k] = 0; /* of a ring radial forces have no sum */
      f[rigid->at[k / 3] + k % 3] += sum[k] / (k < 3 ? 1 : rigid->length);
      if (keep) rigid->contact[k] = sum[k];
    }
    PetscCall(PetscFree(forces));
  }
  PetscCall(VecRestoreArray(f_local, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a load at factor 1: force, moment and weight at the reference points, once each. */
PetscErrorCode rigids_load(const Physics *physics, const Load *load, PetscScalar *forces)
{
  PetscFunctionBegin;
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    if (!load->bodies || !load->bodies[rigid->body] || !rigid->owned) continue;
    for (int i = 0; i < 3; i++) {
      forces[rigid->at[0] + i] += load->force[i] + rigid->mass * load->acceleration.uniform[i];
      forces[rigid->at[1] + i] += load->moment[i] / rigid->length;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At the end of an evaluation: what contact and supports do to the bodies, on every rank. */
PetscErrorCode rigids_reactions(Physics *physics)
{
  const PetscScalar *f;
  PetscFunctionBegin;
  if (!physics->n_rigids) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(physics->f_local, &f));
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    Rigid *rigid = &physics->rigids[r];
    for (int k = 0; k < RIGID_UNKNOWNS; k++) {
      const PetscReal scale = k < 3 ? 1 : rigid->length;
      const PetscBool held  = (PetscBool)(rigid->held >> k & 1 || rigid_holder(physics, rigid, k));
      rigid->reaction[k]    = rigid->at[0] >= 0 && held ? scale * PetscRealPart(f[rigid->at[k / 3] + k % 3]) : 0;
      rigid->on_body[k]     = -rigid->contact[k]; /* contact has what is inside as positive */
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, rigid->reaction, RIGID_UNKNOWNS, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, rigid->on_body, RIGID_UNKNOWNS, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    for (int k = 0; k < RIGID_UNKNOWNS; k++) {
      const Support *holder  = rigid_holder(physics, rigid, k);
      Support       *support = holder ? &physics->supports[holder - physics->supports] : NULL;
      if (support && k < 3) support->reaction[k] = rigid->reaction[k];
      if (support && k >= 3) support->moment[k - 3] = rigid->reaction[k];
    }
  }
  PetscCall(VecRestoreArrayRead(physics->f_local, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Work of the moments that a load's rotations of this step leave out: those of the steps before. This rank's. */
PetscReal rigids_work_before(const Physics *physics, const PetscScalar *f_external)
{
  PetscReal work = 0;
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid *rigid = &physics->rigids[r];
    for (int i = 0; i < 3 && rigid->owned; i++)
      work += PetscRealPart(f_external[rigid->at[1] + i]) * rigid->length * rigid->sum[i];
  }
  return work;
}

/* Displacements of points that move with the body, from their places at the start. */
PetscErrorCode rigids_displacements(const Rigid *rigid, PetscInt n, const PetscReal X[], PetscScalar u[])
{
  const stickslip_rigid_motion motion = rigids_motion(rigid);
  const stickslip_rigid_body   body   = {.struct_size = sizeof(body), .dimension = 3, .n_nodes = n, .coordinates = X, .point = rigid->point};
  PetscFunctionBegin;
  PetscCheck(!stickslip_rigid_positions(&body, &motion, u), PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s",
             stickslip_last_error_message());
  for (PetscInt k = 0; k < 3 * n; k++)
    u[k] -= X[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the body is turned by now, row by row: where it takes the axes. */
void rigids_turned(const Rigid *rigid, PetscReal turned[9])
{
  static const double    axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, origin[3] = {0, 0, 0};
  stickslip_rigid_body   body    = {.struct_size = sizeof(body), .dimension = 3, .n_nodes = 3, .coordinates = axes, .point = origin};
  stickslip_rigid_motion motion  = rigids_motion(rigid);
  double                 x[9]    = {0};
  for (int i = 0; i < 3; i++)
    motion.displacement[i] = 0;
  (void)stickslip_rigid_positions(&body, &motion, x); /* of a motion that it has placed before */
  for (int k = 0; k < 9; k++)
    turned[k] = x[3 * (k % 3) + k / 3];
}

PetscInt rigids_of_vertex(const Physics *physics, PetscInt vertex)
{
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    if (vertex >= physics->rigids[r].first_vertex && vertex < physics->rigids[r].end_vertex) return r;
  }
  return -1;
}

/* Components of a node that are prescribed: the displacement is, and so are the turns across it, to zero. A turn by an angle has the
 * third one among the causes of its component, too, which then may not be free. */
PetscInt rigids_node_mask(const Rigid *rigid)
{
  const PetscInt turns = 7 << 3;
  PetscInt       mask  = 0;
  if (rigid->turned_by && (rigid->held & turns) != turns) return 0;
  for (int i = 0; i < 3; i++) {
    const PetscInt all = 1 << i | 1 << (3 + (i + 1) % 3) | 1 << (3 + (i + 2) % 3);
    if ((rigid->held & all) == all) mask |= 1 << i;
  }
  return mask;
}

/* Is a component of a vertex that has no equation free to move with its body, nevertheless? */
PetscBool rigids_moves(const Physics *physics, PetscInt vertex, int component)
{
  const PetscInt r = rigids_of_vertex(physics, vertex);
  if (r < 0 || vertex < physics->rigids[r].first_vertex + FIRST) return PETSC_FALSE;
  return (PetscBool)!(rigids_node_mask(&physics->rigids[r]) >> component & 1);
}
