/* Whether the forces on each part balance (parts.c), node by node and as a whole.
 *
 * Node by node: a part's residual is compared with twice its own forces, |loads| + |reactions| + |contact forces| (2-norms of nodal
 * forces), the largest so far (at the start: FAINT E size^2), so that an unloaded step is not judged by its own noise. Below the
 * rounding of displacements it balances, too: that alone gives a part that moves without stress its forces
 * (bulk_forces()). Another part's forces count for nothing, however large they are.
 *
 * Contact forces are no measure of themselves: where conditions say the same twice, multipliers of any size cancel each other, and a
 * residual is small beside them that is as large as the loads. So reactions and contact forces count up to MOST times what
 * the part carries: loads, forces of its cells and springs, momentum over the step. A rigid body carries what any body does that contact may join to it.
 *
 * As a whole: forces of cells have no resultant and no moment. So those of loads, reactions, contact and inertia together are those of the
 * residual where nothing is prescribed. They are compared with what the part carries. */
#include "physics/physics.h"

/* Rounding may be so much of the forces on a part that has loads. It is nearly balanced in itself: where it is 1e-3 of a
 * load, contact forces are right to 1e-10; where it is as large as the load, they are anything. */
static const PetscReal DROWNED = 1e-3;
/* A force on a part is balanced within it, so that it acts twice. */
static const PetscReal TWICE = 2;
/* Where forces balance, contact forces and reactions are no more than three times the forces of the cells there, and loads: a node has
 * eight cells at most. The rest is for parts with little but momentum, whose first step starts from rest. */
static const PetscReal MOST = 100;
/* What is left of forces and moments on a part, over what it carries, and over that times its size. */
static const PetscReal RESULTANT = 1e-6;
/* Rounding of all nodes together, over that node by node (noise): sums of many forces with a sign each. */
static const PetscReal TOGETHER = 10;

static PetscBool is_rigid(const Physics *physics, PetscInt part)
{
  return physics->mesh->bodies[mesh_body_of(physics->mesh, physics->parts.part[part].first)].rigid;
}

static void refer(Physics *physics)
{
  Parts *parts = &physics->parts;
  for (PetscInt p = 0; p < parts->n; p++) {
    Part *part = &parts->part[p];
    for (PetscInt q = 0; q < parts->n && is_rigid(physics, p); q++) {
      if (parts->part[q].cluster == part->cluster && !is_rigid(physics, q)) part->carried = PetscMax(part->carried, parts->part[q].carried);
    }
    part->reference = TWICE * (part->loads + PetscMin(part->exerted, MOST * part->carried));
  }
}

/* Without multipliers among the unknowns contact forces are the forces of the bodies on one side, with their rounding: that of a
 * body which moves apart from a body at rest acts on this one, too, and it has no rounding of its own to be below. */
static void share_noise(Parts *parts)
{
  for (PetscInt g = 0; g < parts->n_groups; g++) {
    PetscReal largest = 0;
    for (PetscInt k = parts->group_starts[g]; k < parts->group_starts[g + 1]; k++)
      largest = PetscMax(largest, PetscSqrtReal(parts->squares[N_SQUARES * parts->grouped[k] + SQUARES_ROUNDING]));
    for (PetscInt k = parts->group_starts[g]; k < parts->group_starts[g + 1]; k++)
      parts->part[parts->grouped[k]].noise = PetscMax(parts->part[parts->grouped[k]].noise, largest);
  }
}

/* At the end of an evaluation: bulk_forces() and contact_forces() have left their squares in parts->squares. */
PetscErrorCode parts_measure(Physics *physics)
{
  Parts    *parts          = &physics->parts;
  PetscReal sum[N_SQUARES] = {0};
  PetscFunctionBegin;
  PetscCall(parts_add_squares(physics, physics->f_external, SQUARES_LOADS, SQUARES_LOADS));
  PetscCall(parts_add_squares(physics, physics->f_local, SQUARES_REACTIONS, SQUARES_RESIDUAL));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, parts->squares, (PetscMPIInt)(N_SQUARES * parts->n), MPIU_REAL,
                             MPIU_SUM, PETSC_COMM_WORLD));
  for (PetscInt p = 0; p < parts->n; p++) {
    const PetscReal *squares = parts->squares + N_SQUARES * p;
    for (int k = 0; k < N_SQUARES; k++)
      sum[k] += squares[k];
    parts->part[p].residual  = PetscSqrtReal(squares[SQUARES_RESIDUAL]);
    parts->part[p].noise     = PetscSqrtReal(squares[SQUARES_ROUNDING]);
    parts->part[p].loads     = PetscSqrtReal(squares[SQUARES_LOADS]);
    parts->part[p].carried   = parts->part[p].loads + PetscSqrtReal(squares[SQUARES_CARRIED]);
    parts->part[p].exerted   = PetscSqrtReal(squares[SQUARES_REACTIONS]) + PetscSqrtReal(squares[SQUARES_CONTACT]);
  }
  share_noise(parts);
  refer(physics);
  parts->reference_force = PetscSqrtReal(sum[SQUARES_LOADS]) + PetscSqrtReal(sum[SQUARES_REACTIONS]) +
                           PetscSqrtReal(sum[SQUARES_CONTACT]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `exact`: no noise is allowed. So it is where a part has left all that it could touch: it has any rounding that it likes, and nothing that
 * balances its load. */
Judgement parts_judge(const Physics *physics, PetscReal rtol, PetscReal atol, PetscBool exact)
{
  Judgement judgement = {.balance = PETSC_TRUE, .relative = PETSC_TRUE, .drowned = -1, .hidden = -1};
  for (PetscInt p = 0; p < physics->parts.n; p++) {
    const Part     *part = &physics->parts.part[p];
    const PetscReal most = PetscMax(part->faint, PetscMax(part->reference, part->felt));
    if (part->residual <= rtol * most) continue;
    judgement.relative = PETSC_FALSE;
    if (!(part->residual <= PetscMax(atol, exact ? 0 : part->noise))) {
      judgement.balance = PETSC_FALSE;
      if (part->residual <= rtol * TWICE * part->exerted) judgement.hidden = p;
    } else if (part->loads > 0 && part->residual > PetscMax(atol, DROWNED * PetscMax(part->reference, part->felt))) {
      judgement.balance = PETSC_FALSE;
      judgement.drowned = p;
    }
  }
  return judgement;
}

PetscErrorCode parts_hidden_words(const Physics *physics, PetscInt number, char why[], size_t length)
{
  const Part *part = &physics->parts.part[number];
  char        name[2 * NAME_LENGTH];
  PetscFunctionBegin;
  PetscCall(parts_name(physics, number, name, sizeof(name)));
  PetscCall(PetscSNPrintf(why, length,
                          "contact forces on '%s' cancel each other: they are %.2g where it carries %.2g, and forces of %.2g do not balance. Conditions say the "
                          "same twice there, as of interfaces that share nodes, or of surfaces that supports hold on both sides: give a node to one of them, "
                          "or take another `basis`",
                          name, (double)part->exerted, (double)part->carried, (double)part->residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums over the nodes of a part: the residual where nothing is prescribed, its moment about the origin, places, and how many. */
typedef struct {
  PetscReal force[3], moment[3], place[3], n;
} Resultant;
enum { RESULTANT_NUMBERS = sizeof(Resultant) / sizeof(PetscReal) };

/* The second vertex of a rigid body has its moment about the first (rigids.c). */
static const Rigid *turned_by(const Physics *physics, PetscInt at)
{
  for (PetscInt r = 0; r < physics->n_rigids; r++)
    if (physics->rigids[r].at[1] == at) return &physics->rigids[r];
  return NULL;
}

static PetscErrorCode add_up(Physics *physics, Resultant sums[])
{
  const Mesh        *mesh = physics->mesh;
  const PetscScalar *f, *u, *coordinates;
  Vec                places;
  PetscFunctionBegin;
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &places));
  PetscCall(unknowns_sum(physics, physics->f_local));
  PetscCall(VecGetArrayRead(places, &coordinates));
  PetscCall(VecGetArrayRead(physics->f_sum, &f));
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    Resultant   *sum = &sums[physics->parts.of_vertex[k]];
    const Rigid *rigid;
    PetscReal    x[3], force[3];
    PetscInt     at;
    if (physics->unknowns.ghost[k]) continue;
    PetscCall(unknowns_place(physics, k, coordinates, x, &at));
    for (int i = 0; i < 3; i++)
      force[i] = entry_held(physics, at + i) ? 0 : PetscRealPart(f[at + i]);
    rigid = turned_by(physics, at);
    for (int i = 0; i < 3 && rigid; i++)
      sum->moment[i] += rigid->length * force[i];
    if (rigid) continue;
    sum->n++;
    for (int i = 0; i < 3; i++) {
      x[i] += PetscRealPart(u[at + i]);
      sum->place[i] += x[i];
      sum->force[i] += force[i];
    }
    for (int i = 0; i < 3; i++)
      sum->moment[i] += x[(i + 1) % 3] * force[(i + 2) % 3] - x[(i + 2) % 3] * force[(i + 1) % 3];
  }
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCall(VecRestoreArrayRead(physics->f_sum, &f));
  PetscCall(VecRestoreArrayRead(places, &coordinates));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, (PetscMPIInt)(RESULTANT_NUMBERS * physics->parts.n), MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Force, and moment about the middle of the nodes over the part's size, whichever is more. */
static PetscReal largest(const Resultant *sum, PetscReal size)
{
  PetscReal force = 0, moment = 0;
  for (int i = 0; i < 3; i++) {
    const int       j = (i + 1) % 3, k = (i + 2) % 3;
    const PetscReal about = sum->moment[i] - (sum->place[j] * sum->force[k] - sum->place[k] * sum->force[j]) / PetscMax(sum->n, 1);
    force += PetscSqr(sum->force[i]);
    moment += PetscSqr(about);
  }
  return PetscMax(PetscSqrtReal(force), size > 0 ? PetscSqrtReal(moment) / size : 0);
}

/* After an evaluation at u_local. What a part carried before counts so far as it cannot have been inflated. */
PetscErrorCode parts_resultants(Physics *physics, char why[], size_t length)
{
  const Parts *parts = &physics->parts;
  Resultant   *sums;
  PetscFunctionBegin;
  why[0] = 0;
  PetscCall(PetscCalloc1(parts->n, &sums));
  PetscCall(add_up(physics, sums));
  for (PetscInt p = 0; p < parts->n && !why[0]; p++) {
    const Part     *part  = &parts->part[p];
    const PetscReal scale = PetscMax(part->faint, PetscMax(part->carried, part->felt / (TWICE * MOST)));
    const PetscReal left  = largest(&sums[p], part->size);
    char            name[2 * NAME_LENGTH];
    if (left <= PetscMax(RESULTANT * scale, TOGETHER * part->noise)) continue;
    PetscCall(parts_name(physics, p, name, sizeof(name)));
    PetscCall(PetscSNPrintf(why, length,
                            "loads, reactions and contact forces on '%s' do not balance as a whole: %.2g is left of them, or as much in moments over its "
                            "size, where it carries %.2g. Lower -snes_rtol and -snes_atol, if they are given",
                            name, (double)left, (double)part->carried));
  }
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}
