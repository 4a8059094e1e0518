/* Bodies that touch nothing at the start of a step, and that contact must hold by friction: they are laid down first.
 *
 * A pin in its holes is loose in directions that the normals of contact never hold: friction does, once surfaces press on each other.
 * While gaps close, every node that meets has slid by the whole way of its body and slips, so that nothing holds these directions, and
 * Newton's method throws the bodies about. But at the start of the step nothing acts on a body that touches nothing: it may be
 * anywhere. So it is moved, rigid, by what will load it, until contact is in its way. That is the state from which the step starts;
 * slip counts from there. It costs evaluations of the contact, and no matrix, and all gaps of a chain of bodies close together.
 *
 * Each move v of the motions that supports leave free solves
 *   v = t f + sum_i l_i G_i,   l_i >= 0,   g_i + G_i v + depth >= 0,   l_i (g_i + G_i v + depth) = 0,
 * f: the loads, t: so that they would move bodies by a small part of a facet; g_i, G_i: a node's gap, and how motions open it. Found
 * by projected Gauss-Seidel. Then the contact is evaluated at the new place. Where bodies do not come to rest so, or the normals hold
 * them, the step starts from where they were, and closing.c closes the gaps. */
#include "solve/held.h"
#include <cjson/cJSON.h>

/* Moves at most; each is so much of the shortest of the interfaces' longest edges, at most; sweeps for one. */
enum { MOVES = 100, SWEEPS = 400 };
static const PetscReal REACH = 0.02;
/* Where moves go on and on in one direction, within this cosine, they become longer, up to this; and the loads' part in them, by as much. */
static const PetscReal ALIKE = 0.9, FARTHEST = 0.2, EAGER = 32;
/* At rest: a move is shorter than this part of what it would be if nothing stopped it: what is left, friction holds. What sweeps still
 * change, over the reach of a first move: what they leave is a turn, which takes what touches along the surface, and friction keeps it there. */
static const PetscReal REST = 5e-2, SWEPT = 1e-9;
/* How deep touching nodes end, over the edge: about what the loads press them in by, within bounds. */
static const PetscReal DEEPEST = 1e-2, SHALLOWEST = 1e-8;
/* A node that opens by less than this part of a motion's size does not stop it. */
static const PetscReal NOTHING = 1e-6;
/* Normals hold a motion if the squares of what it opens touching nodes by sum up to more than this, a motion's size being 1. */
static const PetscReal HOLDS = 1e-2;

typedef struct {
  Motions    m;
  PetscInt   n;            /* motions that supports leave free, the first rows of m.gram */
  PetscReal *load, *move, *before; /* n: the move that nothing stops; the next one, the last one */
  PetscReal  edge, most, eager, depth; /* the shortest of the interfaces' longest edges; a move's length, at most; `load` over that; of
                                          touching nodes */
  PetscInt   n_gaps;
  Gap       *gaps;         /* of all ranks */
  PetscReal *open, *force; /* n_gaps x n: G; n_gaps: l */
} Settle;

static PetscReal dot(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0;
  for (PetscInt k = 0; k < n; k++)
    sum += a[k] * b[k];
  return sum;
}

/* Adds what the free motions move a point of a part by along d, times `sign`. */
static void add_free_row(const Settle *s, PetscInt part, const PetscReal at[3], const PetscReal d[3], PetscReal sign, PetscReal row[])
{
  PetscInt  columns[MODES];
  PetscReal values[MODES];
  int       n = 0;
  motions_row(&s->m, part, at, d, sign, columns, values, &n);
  for (PetscInt k = 0; k < s->n; k++) {
    for (int j = 0; j < n; j++)
      row[k] += values[j] * s->m.gram[s->m.n * k + columns[j]];
  }
}

/* What loads do to the free motions, or (`along` given) what these move every vertex by: both go over the vertices that are owned here. */
static PetscErrorCode with_vertices(const Solve *solve, const Settle *s, const PetscReal *along, PetscScalar *array, PetscReal *loads)
{
  const Physics     *physics = solve->physics;
  const Mesh        *mesh    = solve->mesh;
  const PetscScalar *coordinates, *u;
  PetscReal         *row;
  Vec                vector;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->n, &row));
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt  number = mesh->original[k], r = rigids_of_vertex(physics, number), part = physics->parts.of_vertex[k];
    const PetscBool finite = physics->materials[mesh_body_of(mesh, number)].law->finite;
    const PetscBool turns = (PetscBool)(r >= 0 && number == physics->rigids[r].first_vertex + 1);
    PetscReal       x[3];
    PetscInt        at;
    if (s->m.place[part] < 0 || (!along && physics->unknowns.ghost[k])) continue;
    PetscCall(unknowns_place(physics, k, coordinates, x, &at));
    for (int i = 0; i < 3 && finite && !turns; i++)
      x[i] += PetscRealPart(u[at + i]);
    for (int i = 0; i < 3; i++) {
      const PetscReal d[3] = {i == 0, i == 1, i == 2};
      PetscCall(PetscArrayzero(row, s->n));
      add_free_row(s, part, x, d, 1, row);
      for (PetscInt j = 0; j < s->n && turns; j++) /* its unknowns are turns, times a length */
        row[j] = physics->rigids[r].length * s->m.gram[s->m.n * j + MODES * s->m.place[part] + 3 + i] / s->m.size[part];
      for (PetscInt j = 0; j < s->n; j++) {
        if (along)
          array[at + i] += along[j] * row[j];
        else
          loads[j] += PetscRealPart(array[at + i]) * row[j];
      }
    }
  }
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At u_local: how strong the loads are, and where they would move the bodies. */
static PetscErrorCode find_load(Solve *solve, Settle *s, PetscReal *pressing)
{
  PetscScalar *f;
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(s->load, s->n));
  PetscCall(unknowns_sum(solve->physics, solve->physics->f_external));
  PetscCall(VecGetArray(solve->physics->f_sum, &f));
  PetscCall(with_vertices(solve, s, NULL, f, s->load));
  PetscCall(VecRestoreArray(solve->physics->f_sum, &f));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->load, (PetscMPIInt)s->n, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  *pressing = PetscSqrtReal(dot(s->n, s->load, s->load));
  for (PetscInt k = 0; k < s->n && *pressing > 0; k++)
    s->load[k] *= s->eager * REACH * s->edge / *pressing;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At u_local; `possible`: motions are free, and something may stop them. */
static PetscErrorCode begin(Solve *solve, Settle *s, PetscBool *possible)
{
  Physics     *physics = solve->physics;
  PetscReal    edge = PETSC_MAX_REAL, young = PETSC_MAX_REAL, pressing;
  PetscFunctionBegin;
  *s = (Settle){0};
  PetscCall(motions_create(physics, physics->u_local, solve->held.loose, &s->m));
  PetscCall(motions_add_springs(physics, physics->u_local, PETSC_FALSE, &s->m));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++) {
    const Interface *interface = &solve->contact->interfaces[i];
    if (interface->options.friction == STICKSLIP_FRICTION_TIED) {
      PetscCall(motions_add_contact(solve->mesh, interface, &s->m));
      continue;
    }
    if (interface->longest_edge > 0) edge = PetscMin(edge, interface->longest_edge);
    if (interface->young > 0) young = PetscMin(young, interface->young);
  }
  PetscCall(motions_sum(&s->m));
  motions_add_rings(physics, &s->m);
  PetscCall(motions_find_free(&s->m, &s->n)); /* the same on every rank */
  PetscCall(PetscCalloc3(s->n, &s->load, s->n, &s->move, s->n, &s->before));
  *possible = (PetscBool)(s->n > 0 && edge < PETSC_MAX_REAL);
  if (!*possible) PetscFunctionReturn(PETSC_SUCCESS);
  s->edge = edge, s->eager = 1, s->most = REACH * edge;
  PetscCall(find_load(solve, s, &pressing));
  *possible = (PetscBool)(pressing > 0);
  s->depth = young < PETSC_MAX_REAL ? pressing / (young * edge) : 0;
  s->depth = PetscMin(DEEPEST * edge, PetscMax(SHALLOWEST * edge, s->depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode forget_gaps(Settle *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(s->gaps));
  PetscCall(PetscFree2(s->open, s->force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode end(Settle *s)
{
  PetscFunctionBegin;
  PetscCall(forget_gaps(s));
  PetscCall(PetscFree3(s->load, s->move, s->before));
  PetscCall(motions_destroy(&s->m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of all ranks, at the place of the last evaluation. */
static PetscErrorCode find_gaps(Solve *solve, Settle *s)
{
  const PetscMPIInt size = solve->mesh->size;
  PetscInt          n    = 0, all = 0;
  PetscMPIInt      *counts, *starts, bytes;
  Gap              *mine;
  PetscFunctionBegin;
  PetscCall(forget_gaps(s));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++)
    all += solve->contact->interfaces[i].part.n1;
  PetscCall(PetscMalloc1(all, &mine));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++)
    PetscCall(held_gaps(solve, &solve->contact->interfaces[i], mine, &n));
  PetscCall(PetscMalloc2(size, &counts, size + 1, &starts));
  bytes = (PetscMPIInt)(n * (PetscInt)sizeof(Gap));
  PetscCallMPI(MPI_Allgather(&bytes, 1, MPI_INT, counts, 1, MPI_INT, PETSC_COMM_WORLD));
  starts[0] = 0;
  for (PetscMPIInt r = 0; r < size; r++)
    starts[r + 1] = starts[r] + counts[r];
  s->n_gaps = starts[size] / (PetscInt)sizeof(Gap);
  PetscCall(PetscMalloc1(s->n_gaps, &s->gaps));
  PetscCallMPI(MPI_Allgatherv(mine, bytes, MPI_BYTE, s->gaps, counts, starts, MPI_BYTE, PETSC_COMM_WORLD));
  PetscCall(PetscCalloc2(s->n_gaps * s->n, &s->open, s->n_gaps, &s->force));
  for (PetscInt g = 0; g < s->n_gaps; g++) {
    for (int side = 0; side < 2; side++)
      add_free_row(s, s->gaps[g].part[side], s->gaps[g].at[side], s->gaps[g].normal, side ? -1 : 1, s->open + g * s->n);
  }
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next move, from the gaps of now. */
static void find_move(Settle *s)
{
  PetscReal change = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < s->n; k++)
    s->move[k] = s->load[k];
  for (int sweep = 0; sweep < SWEEPS && change > SWEPT * REACH * s->edge; sweep++) {
    change = 0;
    for (PetscInt g = 0; g < s->n_gaps; g++) {
      const PetscReal *open = s->open + g * s->n, stiff = dot(s->n, open, open);
      PetscReal        force;
      if (!(stiff > NOTHING * NOTHING)) continue;
      force = PetscMax(0, s->force[g] - (s->gaps[g].gap + s->depth + dot(s->n, open, s->move)) / stiff);
      for (PetscInt k = 0; k < s->n; k++)
        s->move[k] += (force - s->force[g]) * open[k];
      change      = PetscMax(change, PetscAbsReal(force - s->force[g]) * PetscSqrtReal(stiff));
      s->force[g] = force;
    }
  }
}

/* Does it go on in one direction? */
static void look_at_way(Settle *s)
{
  const PetscReal now = dot(s->n, s->move, s->move), before = dot(s->n, s->before, s->before);
  if (dot(s->n, s->move, s->before) > ALIKE * PetscSqrtReal(now * before) && before > 0) {
    if (now > s->most * s->most)
      s->most = PetscMin(FARTHEST * s->edge, 2 * s->most);
    else
      s->eager = PetscMin(EAGER, 2 * s->eager);
  } else {
    s->most  = PetscMax(REACH * s->edge, s->most / 2);
    s->eager = PetscMax(1, s->eager / 2);
  }
}

/* u_local and x by the move, or by as much of it as counts; its length */
static PetscErrorCode make_move(Solve *solve, Settle *s, Vec x, PetscReal *length)
{
  PetscScalar *array;
  Vec          step;
  PetscFunctionBegin;
  look_at_way(s);
  *length = PetscSqrtReal(dot(s->n, s->move, s->move));
  for (PetscInt k = 0; k < s->n; k++) {
    s->before[k] = s->move[k];
    s->move[k] *= PetscMin(1, s->most / *length);
  }
  PetscCall(VecDuplicate(solve->physics->u_local, &step));
  PetscCall(VecZeroEntries(step));
  PetscCall(VecGetArray(step, &array));
  PetscCall(with_vertices(solve, s, s->move, array, NULL));
  PetscCall(VecRestoreArray(step, &array));
  PetscCall(VecAXPY(solve->physics->u_local, 1, step));
  PetscCall(DMLocalToGlobalBegin(solve->mesh->dm, solve->physics->u_local, INSERT_VALUES, x));
  PetscCall(DMLocalToGlobalEnd(solve->mesh->dm, solve->physics->u_local, INSERT_VALUES, x));
  PetscCall(VecDestroy(&step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode evaluate(Solve *solve, Vec x, PetscInt *refused)
{
  PetscFunctionBegin;
  PetscCall(unknowns_to_local(solve->physics, x));
  PetscCall(VecZeroEntries(solve->physics->f_local));
  PetscCall(contact_forces(solve->contact, solve->physics->f_local, refused));
  solve->contact->refusal[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do the normals of the nodes that stop the last move leave a motion to friction? */
static PetscErrorCode wants_friction(const Settle *s, PetscBool *wants)
{
  PetscReal *gram, *values;
  PetscBool  friction = PETSC_FALSE;
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(s->n * s->n, &gram, s->n, &values));
  for (PetscInt g = 0; g < s->n_gaps; g++) {
    const PetscReal *open = s->open + g * s->n;
    if (!(s->force[g] > 0)) continue;
    friction = (PetscBool)(friction || s->gaps[g].friction > 0);
    for (PetscInt k = 0; k < s->n * s->n; k++)
      gram[k] += open[k / s->n] * open[k % s->n];
  }
  PetscCall(motions_eigen(s->n, gram, values));
  *wants = (PetscBool)(friction && values[0] < HOLDS);
  PetscCall(PetscFree2(gram, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Frozen weights keep the surfaces where they were; offsets that change would be those of another time; and what has been in contact
 * may carry something. */
static PetscBool allowed(const Solve *solve)
{
  PetscBool carries = PETSC_FALSE;
  for (PetscInt p = 0; p < solve->physics->parts.n; p++)
    carries = (PetscBool)(carries || (solve->held.loose[p] && solve->physics->parts.part[p].felt > solve->physics->parts.part[p].faint));
  if (carries) return PETSC_FALSE;
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++) {
    const Interface *interface = &solve->contact->interfaces[i];
    const PetscBool  tied      = (PetscBool)(interface->options.friction == STICKSLIP_FRICTION_TIED);
    if (!tied && interface->method.weights != STICKSLIP_WEIGHTS_CURRENT) return PETSC_FALSE;
    if (interface->offsets.any && interface->offsets.curve.n) return PETSC_FALSE;
  }
  return (PetscBool)(solve->closing.possible && !solve->physics->dynamics);
}

/* In words and for the summary: which bodies, how far. */
static PetscErrorCode tell(Solve *solve, PetscReal t0, PetscReal moved)
{
  const Parts *parts = &solve->physics->parts;
  PetscInt     told  = -1;
  char         names[512] = "";
  cJSON       *json, *bodies;
  PetscFunctionBegin;
  cJSON_Delete(solve->held.laid_down);
  solve->held.laid_down = json = cJSON_CreateObject();
  cJSON_AddNumberToObject(json, "t", t0);
  cJSON_AddNumberToObject(json, "moved", moved);
  bodies = cJSON_AddArrayToObject(json, "bodies");
  for (PetscInt p = 0; p < parts->n; p++) {
    const PetscInt body = mesh_body_of(solve->mesh, parts->part[p].first);
    if (!solve->held.loose[p] || body == told) continue;
    told = body;
    PetscCall(PetscStrlcat(names, names[0] ? ", " : "", sizeof(names)));
    PetscCall(PetscStrlcat(names, solve->mesh->bodies[body].name, sizeof(names)));
    cJSON_AddItemToArray(bodies, cJSON_CreateString(solve->mesh->bodies[body].name));
  }
  if (!solve->quiet)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                          "note: at t = %.6g %s touch nothing that holds them, and only friction can hold some of their motions. They are moved, "
                          "without strain, along their loads until they touch, by %.3g at most; slip counts from there\n",
                          (double)t0, names, (double)moved));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At `last`, the state at t0: loads are those of now. */
static PetscErrorCode lay(Solve *solve, PetscReal t0, Vec last, PetscBool *laid)
{
  Settle    s;
  PetscInt  refused = 0;
  PetscReal length;
  PetscReal pressing;
  PetscBool possible = PETSC_FALSE, rests = PETSC_FALSE;
  Vec       x;
  PetscFunctionBegin;
  PetscCall(VecDuplicate(last, &x));
  PetscCall(VecCopy(last, x));
  PetscCall(evaluate(solve, x, &refused));
  PetscCall(begin(solve, &s, &possible));
  for (int k = 0; k < MOVES && possible && !rests && !refused; k++) {
    PetscCall(find_load(solve, &s, &pressing));
    PetscCall(find_gaps(solve, &s));
    find_move(&s);
    PetscCall(make_move(solve, &s, x, &length));
    rests = (PetscBool)(length <= REST * PetscSqrtReal(dot(s.n, s.load, s.load)));
    PetscCall(evaluate(solve, x, &refused));
  }
  if (possible && !refused && rests) PetscCall(wants_friction(&s, laid));
  if (*laid) {
    const PetscReal t = solve->physics->t;
    solve->physics->t = t0;
    PetscCall(contact_commit(solve->contact, x, &refused));
    solve->physics->t = t;
    *laid             = (PetscBool)!refused;
    solve->contact->refusal[0] = 0;
  }
  if (*laid) {
    PetscReal moved;
    PetscCall(VecAXPY(last, -1, x));
    PetscCall(VecNorm(last, NORM_INFINITY, &moved));
    PetscCall(VecCopy(x, last));
    PetscCall(tell(solve, t0, moved));
  }
  PetscCall(end(&s));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before a step is taken from `past`: lays down what is loose there. */
PetscErrorCode settle_loose(Solve *solve, Past *past, PetscBool *laid)
{
  Physics  *physics = solve->physics;
  PetscBool loose;
  PetscFunctionBegin;
  *laid = PETSC_FALSE;
  if (!allowed(solve)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(supports_values(physics, past->t_last));
  PetscCall(closing_needed(solve, past->last, &loose));
  if (loose) PetscCall(lay(solve, past->t_last, past->last, laid));
  PetscCall(supports_values(physics, physics->t));
  if (*laid) past->have_before = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
