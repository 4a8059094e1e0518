/* Supports: prescribed displacements over time, and the reactions to them. */
#include "physics/physics.h"

/* Rodrigues: x turned about w by |w| */
static void rotate(const PetscReal w[3], PetscReal x[3])
{
  const PetscReal angle = PetscSqrtReal(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  /* sin a / a and (1 - cos a) / a^2, without cancellation */
  const PetscReal half = PetscSinReal(0.5 * angle), s = angle > 0 ? PetscSinReal(angle) / angle : 1,
                  c = angle > 0 ? 2 * PetscSqr(half / angle) : 0.5;
  PetscReal wx[3], wwx[3];
  space_cross(w, x, wx);
  space_cross(w, wx, wwx);
  for (int i = 0; i < 3; i++)
    x[i] += s * wx[i] + c * wwx[i];
}

/* before it is turned */
static void at_factor_one(const Support *support, PetscInt vertex, const PetscReal X[3], PetscReal u[3])
{
  for (int i = 0; i < 3; i++) {
    u[i] = support->value[i] + (support->from_file ? support->given[3 * vertex + i] : 0);
    for (int j = 0; j < 3; j++)
      u[i] += support->gradient[3 * i + j] * (X[j] - support->origin[j]);
  }
}

/* at t; X of a vertex of `given`, in the axes of the scene file, the result too */
static void prescribed_displacement(const Support *support, PetscReal t, PetscInt vertex, const PetscReal X[3],
                                    PetscReal u[3])
{
  const PetscReal factor = curve_value(&support->curve, t), turn = curve_value(&support->rotate_curve, t);
  PetscReal       w[3], x[3];
  at_factor_one(support, vertex, X, u);
  for (int i = 0; i < 3; i++) {
    u[i] *= factor;
    x[i] = X[i] - support->origin[i] + u[i];
    w[i] = turn * support->rotate[i];
  }
  if (w[0] == 0 && w[1] == 0 && w[2] == 0) return;
  rotate(w, x);
  for (int i = 0; i < 3; i++)
    u[i] = x[i] - (X[i] - support->origin[i]);
}

/* Its velocity or its acceleration (`twice`): of x = R (X - origin + f b), with R about a fixed axis and f along straight lines. Where a
 * curve has a kink, the mean of before and after: so a jump of the velocity lies half in either step. `sides`: 0 for before alone, 1 for
 * after alone, 2 for both. */
static void prescribed_rate(const Support *support, PetscReal t, int sides, PetscBool twice, PetscInt vertex, const PetscReal X[3],
                            PetscReal rate[3])
{
  const PetscReal factor = curve_value(&support->curve, t), turn = curve_value(&support->rotate_curve, t);
  PetscReal       slopes[2], turns[2], w[3], b[3], x[3];
  curve_slopes(&support->curve, t, slopes);
  curve_slopes(&support->rotate_curve, t, turns);
  at_factor_one(support, vertex, X, b);
  for (int i = 0; i < 3; i++) {
    x[i]    = X[i] - support->origin[i] + factor * b[i];
    w[i]    = turn * support->rotate[i];
    rate[i] = 0;
  }
  rotate(w, x);
  rotate(w, b);
  for (int side = 0; side < 2; side++) {
    const PetscReal share = sides == 2 ? 0.5 : side == sides;
    PetscReal       spin[3], moving[3], turning[3], again[3], bent[3];
    for (int i = 0; i < 3; i++) {
      spin[i]   = turns[side] * support->rotate[i];
      moving[i] = slopes[side] * b[i];
    }
    space_cross(spin, x, turning);
    for (int i = 0; i < 3; i++)
      again[i] = 2 * moving[i] + turning[i];
    space_cross(spin, again, bent);
    for (int i = 0; i < 3; i++)
      rate[i] += share * (twice ? bent[i] : moving[i] + turning[i]);
  }
}

/* Do both prescribe the same u_i at a vertex, before it is turned into another frame? At times between which both move evenly,
 * and at some in between, where they turn. */
PetscBool supports_agree(const Physics *physics, const Support *a, const Support *b, PetscInt vertex, const PetscReal X[3], int i)
{
  const Curve *const curves[] = {&a->curve, &a->rotate_curve, &b->curve, &b->rotate_curve};
  const PetscInt     n_even   = 16;
  for (int c = 0; c <= 4; c++) {
    const PetscInt n = c < 4 ? curves[c]->n : n_even;
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal t = c < 4 ? curves[c]->points[2 * k] : physics->end * (k + 1) / n_even;
      PetscReal       ua[3], ub[3];
      prescribed_displacement(a, t, vertex, X, ua);
      prescribed_displacement(b, t, vertex, X, ub);
      if (PetscAbsReal(ua[i] - ub[i]) > 1e-12 * PetscMax(PetscAbsReal(ua[i]), PetscAbsReal(ub[i]))) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

PetscErrorCode supports_label(Physics *physics)
{
  const Mesh *mesh = physics->mesh;
  char        label[2 * NAME_LENGTH];
  PetscFunctionBegin;
  for (PetscInt v = 0; v < mesh->n_vertices && physics->n_rigids; v++) { /* nodes of rigid bodies have no unknowns of their own */
    const PetscInt r = rigids_of_vertex(physics, mesh->numbers[v]);
    if (r >= 0 && mesh->numbers[v] >= physics->rigids[r].first_vertex + 2) physics->prescribed[v] = 7;
  }
  PetscCall(plex_label_vertices(mesh, "prescribed", mesh->n_vertices, NULL, physics->prescribed, 0));
  PetscCall(PetscFree(physics->prescribed));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    PetscCall(PetscSNPrintf(label, sizeof(label), "support.%s", physics->supports[s].name));
    PetscCall(
        plex_label_vertices(mesh, label, physics->supports[s].n_vertices, physics->supports[s].vertices, NULL, 1));
    PetscCall(PetscFree(physics->supports[s].vertices));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int support_sides(const Physics *physics, const Support *support, PetscReal t)
{
  if (t <= 0 || (support->timed && curve_same_time(t, support->from))) return 1;
  return t >= physics->end || (support->timed && curve_same_time(t, support->until)) ? 0 : 2;
}

/* A supported vertex of this rank: its place from the support's origin, the support's displacement or its rate there, its displacement
 * of now, and its entries of a local vector. */
typedef struct {
  PetscReal    arm[3], u[3], now[3];
  PetscScalar *dofs;
} SupportedVertex;

typedef void (*VertexVisit)(Support *support, const SupportedVertex *vertex);

static PetscErrorCode visit(Physics *physics, Vec local, PetscReal t, SupportMotion motion, VertexVisit action)
{
  const Mesh        *mesh = physics->mesh;
  PetscSection       coordinate_section;
  Vec                coordinate_vector;
  const PetscScalar *coordinates, *now;
  PetscScalar       *array;

  PetscFunctionBegin;
  PetscCall(DMGetCoordinateSection(mesh->dm, &coordinate_section));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &coordinate_vector));
  PetscCall(VecGetArrayRead(coordinate_vector, &coordinates));
  PetscCall(VecGetArrayRead(physics->u_local, &now));
  PetscCall(VecGetArray(local, &array));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    Support  *support = &physics->supports[s];
    PetscInt  n, *points;
    if (support->timed && !support->active) continue;
    PetscCall(plex_labelled(mesh, "support", support->name, &n, &points));
    for (PetscInt k = 0; k < n; k++) {
      PetscInt        at, offset;
      PetscReal       X[3];
      SupportedVertex vertex;
      PetscCall(PetscSectionGetOffset(coordinate_section, points[k], &at));
      PetscCall(PetscSectionGetOffset(physics->unknowns.section, points[k], &offset));
      for (int i = 0; i < 3; i++) { /* back into the axes of the scene file: Q transposed */
        X[i] = 0;
        for (int j = 0; j < 3; j++)
          X[i] += mesh->rotation[3 * j + i] * PetscRealPart(coordinates[at + j]);
      }
      if (motion == SUPPORT_PLACE)
        prescribed_displacement(support, t, mesh->here[points[k]], X, vertex.u);
      else
        prescribed_rate(support, t, support_sides(physics, support, t), (PetscBool)(motion == SUPPORT_ACCELERATION), mesh->here[points[k]], X, vertex.u);
      mesh_rotate_vector(mesh, vertex.u);
      for (int i = 0; i < 3; i++) {
        vertex.arm[i] = X[i] - support->origin[i];
        vertex.now[i] = PetscRealPart(now[offset + i]);
      }
      mesh_rotate_vector(mesh, vertex.arm);
      vertex.dofs = array + offset;
      action(support, &vertex);
    }
    PetscCall(PetscFree(points));
  }
  PetscCall(VecRestoreArray(local, &array));
  PetscCall(VecRestoreArrayRead(physics->u_local, &now));
  PetscCall(VecRestoreArrayRead(coordinate_vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void set_values(Support *support, const SupportedVertex *vertex)
{
  for (int i = 0; i < 3; i++) {
    if (support->mask & (1 << i)) vertex->dofs[i] = vertex->u[i];
  }
}

static void add_reactions(Support *support, const SupportedVertex *vertex)
{
  PetscReal force[3];
  for (int i = 0; i < 3; i++) {
    force[i] = support->mask & (1 << i) ? PetscRealPart(vertex->dofs[i]) : 0;
    support->reaction[i] += force[i];
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    support->moment[i] += (vertex->arm[j] + vertex->now[j]) * force[k] - (vertex->arm[k] + vertex->now[k]) * force[j];
  }
}

PetscErrorCode supports_values(Physics *physics, PetscReal t)
{
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(physics->prescribed_local)); /* removed multipliers are prescribed to be zero */
  PetscCall(visit(physics, physics->prescribed_local, t, SUPPORT_PLACE, set_values));
  PetscCall(rigids_prescribe(physics, t, physics->prescribed_local));
  PetscCall(timed_values(physics));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode supports_rates(Physics *physics, PetscReal t, SupportMotion motion, Vec local)
{
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(local));
  PetscCall(visit(physics, local, t, motion, set_values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* from the forces of the last evaluation; a component prescribed by two supports counts in both */
PetscErrorCode supports_reactions(Physics *physics)
{
  PetscFunctionBegin;
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    PetscCall(PetscArrayzero(physics->supports[s].reaction, 3));
    PetscCall(PetscArrayzero(physics->supports[s].moment, 3));
  }
  PetscCall(visit(physics, physics->f_local, physics->t, SUPPORT_PLACE, add_reactions));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, physics->supports[s].reaction, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, physics->supports[s].moment, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  }
  PetscCall(rigids_reactions(physics));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void supports_turn(const Support *support, PetscReal t0, PetscReal t, PetscReal x[3])
{
  const PetscReal turn = curve_value(&support->rotate_curve, t) - curve_value(&support->rotate_curve, t0);
  PetscReal       w[3];
  for (int i = 0; i < 3; i++) {
    w[i] = turn * support->rotate[i];
    x[i] -= support->origin[i];
  }
  rotate(w, x);
  for (int i = 0; i < 3; i++)
    x[i] += support->origin[i];
}

PetscErrorCode supports_turning(const Physics *physics, PetscInt support_of[])
{
  const Mesh *mesh = physics->mesh;
  PetscFunctionBegin;
  for (PetscInt p = 0; p < physics->parts.n; p++)
    support_of[p] = -1;
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const PetscReal *w = physics->supports[s].rotate;
    PetscInt         n, *points;
    if ((w[0] == 0 && w[1] == 0 && w[2] == 0) || (physics->supports[s].timed && !physics->supports[s].active)) continue;
    PetscCall(plex_labelled(mesh, "support", physics->supports[s].name, &n, &points));
    for (PetscInt k = 0; k < n; k++)
      support_of[physics->parts.of_vertex[mesh->here[points[k]]]] = s;
    PetscCall(PetscFree(points));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, support_of, (PetscMPIInt)physics->parts.n, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
