/* Bodies that touch nothing at the start of a step, and that contact must hold by friction: they are laid down first.
 *
 * A pin in its holes is loose in directions that the normals of contact never hold: friction does, once surfaces press on each other.
 * While gaps close, every node that meets has slid by the whole way of its body and slips, so that nothing holds these directions, and
 * Newton's method throws the bodies about. But at the start of the step nothing acts on a body that touches nothing: it may be
 * anywhere. So it is moved, rigid, by what will load it, until contact is in its way. That is the state from which the step starts;
 * slip counts from there. It costs evaluations of the contact, and no matrix, and all gaps of a chain of bodies close together.
 *
 * Each move v of the motions that supports leave free solves
 *   v = t f + sum_i (l_i G_i + q_i T_i),   l_i >= 0,   g_i + G_i v + depth >= 0,   l_i (g_i + G_i v + depth) = 0,
 *   |q_i| <= m l_i,   and where T_i v is not 0, q_i is m l_i against it,
 * f: the loads, t: so that they would move bodies by a small part of a facet; g_i, G_i, T_i: a node's gap, and how motions open it and slide
 * along it; m: half of the friction (settle_gaps.c). Then the contact is evaluated at the new place. Where a load turns a lug about its pin
 * or moves it along, the place of rest without friction is far away, or there is none; with all of the friction everything would slip
 * there. Where bodies do not come to rest so, or the normals hold them, the step starts from where they were, and closing.c closes the
 * gaps. Bodies move as a whole, and turn, whatever their material: laid.c. */
#include "solve/settle.h"
#include <cjson/cJSON.h>

/* Moves at most; each is so much of the shortest of the interfaces' longest edges, at most. */
enum { MOVES = 400, MOVES_WITHOUT_FRICTION = 100 };
static const PetscReal REACH = 0.02;
/* Where moves go on and on in one direction, within this cosine, they become longer, up to this; and the loads' part in them, by as much.
 * Where they turn back the loads' part becomes smaller, as small as HESITANT, and as large as it was only after so many moves in one
 * direction: surfaces of facets are no planes, and long moves over them go to and fro. */
enum { PATIENCE = 16 };
static const PetscReal ALIKE = 0.9, FARTHEST = 0.2, EAGER = 32, HESITANT = 0.125;
/* At rest: so many moves in a row are shorter than this part of what they would be if nothing stopped them: the rest of friction holds what
 * is left. If none are, the last place will do where the last move is shorter than NEARLY of that. What sweeps still change, over the reach
 * of a first move: what they leave is a turn, which takes what touches along the surface, and friction keeps it there. */
enum { RESTS = 2 };
static const PetscReal REST = 2.5e-2, NEARLY = 0.1, SWEPT = 1e-7;
/* In radians: bodies that turn less than this are as the linear material takes them, to a lever's change by this part of it. */
static const PetscReal TURNED = 5e-3;
/* How deep touching nodes end, over the edge: about what the loads press them in by, within bounds. */
static const PetscReal DEEPEST = 1e-2, SHALLOWEST = 1e-8;

/* Of a rigid body's first two vertices the second one has its turns, times a length: which body, or -1. */
static PetscInt turned_by(const Physics *physics, PetscInt k)
{
  const PetscInt number = physics->mesh->original[k], r = rigids_of_vertex(physics, number);
  return r >= 0 && number == physics->rigids[r].first_vertex + 1 ? r : -1;
}

/* A part's share in motions that are given by their sizes: its translation, and its turn. */
static void share(const Settle *s, const PetscReal sizes[], PetscInt part, PetscReal motion[MODES])
{
  PetscCallAbort(PETSC_COMM_SELF, PetscArrayzero(motion, MODES));
  for (PetscInt j = 0; j < s->n; j++) {
    for (int i = 0; i < MODES; i++)
      motion[i] += sizes[j] * s->m.gram[s->m.n * j + MODES * s->m.place[part] + i] / (i < 3 ? 1 : s->m.size[part]);
  }
}

/* x -> R x + d, which turns about a place: R, row by row, and d */
enum { TURN = 12 };
static void rigid_motion(const PetscReal motion[MODES], const PetscReal middle[3], PetscReal rigid[TURN])
{
  const PetscReal *w = motion + 3, angle = PetscSqrtReal(settle_dot(3, w, w));
  const PetscReal  first = angle > 0 ? PetscSinReal(angle) / angle : 1, second = angle > 0 ? 2 * PetscSqr(PetscSinReal(angle / 2) / angle) : 0.5;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int k = 3 - i - j;
      rigid[3 * i + j] = i == j ? 1 + second * (w[i] * w[i] - angle * angle) : second * w[i] * w[j] + ((j - i + 3) % 3 == 1 ? -first : first) * w[k];
    }
  }
  for (int i = 0; i < 3; i++)
    rigid[9 + i] = motion[i] + middle[i] - settle_dot(3, rigid + 3 * i, middle);
}

/* What loads do to the free motions: over the vertices that are owned here. */
static PetscErrorCode add_loads(const Solve *solve, const Settle *s, const PetscScalar *f, PetscReal *loads)
{
  const Physics     *physics = solve->physics;
  const Mesh        *mesh    = solve->mesh;
  const PetscScalar *coordinates, *u;
  Vec                vector;
  PetscFunctionBegin;
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  PetscCall(VecGetArrayRead(physics->u_local, &u));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt part = physics->parts.of_vertex[k], r = turned_by(physics, k);
    PetscReal      x[3], force[MODES] = {0};
    PetscInt       at;
    if (s->m.place[part] < 0 || physics->unknowns.ghost[k]) continue;
    PetscCall(unknowns_place(physics, k, coordinates, x, &at));
    for (int i = 0; i < 3; i++) {
      x[i] += PetscRealPart(u[at + i]) - s->m.middle[3 * part + i];
      force[r < 0 ? i : 3 + i] = PetscRealPart(f[at + i]) * (r < 0 ? 1 : physics->rigids[r].length);
    }
    for (int i = 0; i < 3 && r < 0; i++)
      force[3 + i] = x[(i + 1) % 3] * force[(i + 2) % 3] - x[(i + 2) % 3] * force[(i + 1) % 3];
    for (PetscInt j = 0; j < s->n; j++) {
      for (int i = 0; i < MODES; i++)
        loads[j] += force[i] * s->m.gram[s->m.n * j + MODES * s->m.place[part] + i] / (i < 3 ? 1 : s->m.size[part]);
    }
  }
  PetscCall(VecRestoreArrayRead(physics->u_local, &u));
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All vertices here by the next move, without strain. */
static PetscErrorCode move_vertices(const Solve *solve, Settle *s)
{
  const Physics     *physics = solve->physics;
  const Mesh        *mesh    = solve->mesh;
  const PetscScalar *coordinates;
  PetscScalar       *u;
  PetscReal         *motions, *rigid;
  Vec                vector;
  PetscFunctionBegin;
  PetscCall(PetscMalloc2(MODES * physics->parts.n, &motions, TURN * physics->parts.n, &rigid));
  for (PetscInt p = 0; p < physics->parts.n; p++) {
    if (s->m.place[p] < 0) continue;
    share(s, s->move, p, motions + MODES * p);
    rigid_motion(motions + MODES * p, s->m.middle + 3 * p, rigid + TURN * p);
    for (int i = 0; i < 3; i++)
      s->turned[3 * p + i] += motions[MODES * p + 3 + i];
  }
  PetscCall(DMGetCoordinatesLocal(mesh->dm, &vector));
  PetscCall(VecGetArrayRead(vector, &coordinates));
  PetscCall(VecGetArray(physics->u_local, &u));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt part = physics->parts.of_vertex[k], r = turned_by(physics, k);
    PetscReal      x[3], now[3];
    PetscInt       at;
    if (s->m.place[part] < 0) continue;
    PetscCall(unknowns_place(physics, k, coordinates, x, &at));
    for (int i = 0; i < 3; i++)
      now[i] = x[i] + PetscRealPart(u[at + i]);
    for (int i = 0; i < 3; i++) {
      const PetscReal *row = rigid + TURN * part;
      u[at + i]            = r < 0 ? row[9 + i] + settle_dot(3, row + 3 * i, now) - x[i] :
                                     u[at + i] + physics->rigids[r].length * motions[MODES * part + 3 + i];
    }
  }
  PetscCall(VecRestoreArray(physics->u_local, &u));
  PetscCall(VecRestoreArrayRead(vector, &coordinates));
  PetscCall(PetscFree2(motions, rigid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At u_local: how strong the loads are, and where they would move the bodies. */
static PetscErrorCode find_load(Solve *solve, Settle *s, PetscReal *pressing)
{
  const PetscScalar *f;
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(s->load, s->n));
  PetscCall(unknowns_sum(solve->physics, solve->physics->f_external));
  PetscCall(VecGetArrayRead(solve->physics->f_sum, &f));
  PetscCall(add_loads(solve, s, f, s->load));
  PetscCall(VecRestoreArrayRead(solve->physics->f_sum, &f));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->load, (PetscMPIInt)s->n, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  *pressing = PetscSqrtReal(settle_dot(s->n, s->load, s->load));
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
  *s      = (Settle){0};
  s->rubs = (PetscBool)!physics->n_rigids;
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
  PetscCall(PetscCalloc4(s->n, &s->load, s->n, &s->move, s->n, &s->before, 3 * physics->parts.n, &s->turned));
  *possible = (PetscBool)(s->n > 0 && edge < PETSC_MAX_REAL);
  if (!*possible) PetscFunctionReturn(PETSC_SUCCESS);
  s->edge = edge, s->eager = 1, s->limit = EAGER, s->most = REACH * edge;
  PetscCall(find_load(solve, s, &pressing));
  *possible = (PetscBool)(pressing > 0);
  s->depth = young < PETSC_MAX_REAL ? pressing / (young * edge) : 0;
  s->depth = PetscMin(DEEPEST * edge, PetscMax(SHALLOWEST * edge, s->depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode end(Settle *s)
{
  PetscFunctionBegin;
  PetscCall(settle_forget_gaps(s));
  PetscCall(PetscFree4(s->load, s->move, s->before, s->turned));
  PetscCall(motions_destroy(&s->m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does it go on in one direction? What turned it back is not tried again for a while. */
static void look_at_way(Settle *s)
{
  const PetscReal now = settle_dot(s->n, s->move, s->move), before = settle_dot(s->n, s->before, s->before);
  if (settle_dot(s->n, s->move, s->before) > ALIKE * PetscSqrtReal(now * before) && before > 0) {
    if (++s->n_alike % PATIENCE == 0) s->limit = PetscMin(EAGER, 2 * s->limit);
    if (now > s->most * s->most)
      s->most = PetscMin(FARTHEST * s->edge, 2 * s->most);
    else
      s->eager = PetscMin(s->limit, 2 * s->eager);
  } else {
    s->n_alike = 0;
    s->limit   = PetscMax(1, s->eager / 2);
    s->most    = PetscMax(REACH * s->edge, s->most / 2);
    s->eager   = PetscMax(HESITANT, s->eager / 2);
  }
}

/* u_local and x by the move, or by as much of it as counts; its length */
static PetscErrorCode make_move(Solve *solve, Settle *s, Vec x, PetscReal *length)
{
  PetscFunctionBegin;
  look_at_way(s);
  *length = PetscSqrtReal(settle_dot(s->n, s->move, s->move));
  for (PetscInt k = 0; k < s->n; k++) {
    s->before[k] = s->move[k];
    s->move[k] *= PetscMin(1, s->most / *length);
  }
  PetscCall(move_vertices(solve, s));
  PetscCall(DMLocalToGlobalBegin(solve->mesh->dm, solve->physics->u_local, INSERT_VALUES, x));
  PetscCall(DMLocalToGlobalEnd(solve->mesh->dm, solve->physics->u_local, INSERT_VALUES, x));
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

/* The body's, behind those that are there. */
static PetscErrorCode append_name(const Mesh *mesh, PetscInt body, char names[], size_t length)
{
  PetscFunctionBegin;
  PetscCall(PetscStrlcat(names, names[0] ? ", " : "", length));
  PetscCall(PetscStrlcat(names, mesh->bodies[body].name, length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In words and for the summary: which bodies, how far; `turned`: those that have another law now. */
static PetscErrorCode tell(Solve *solve, PetscReal t0, PetscReal moved, const char *turned)
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
    PetscCall(append_name(solve->mesh, body, names, sizeof(names)));
    cJSON_AddItemToArray(bodies, cJSON_CreateString(solve->mesh->bodies[body].name));
  }
  if (!solve->quiet)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                          "note: at t = %.6g %s touch nothing that holds them, and only friction can hold some of their motions. They are moved, "
                          "without strain, along their loads until they touch, by %.3g at most; slip counts from there%s%s\n",
                          (double)t0, names, (double)moved, turned[0] ? ". What turns, and was linear, has the law of St. Venant and Kirchhoff from there on: " : "",
                          turned));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At `last`, the state at t0: loads are those of now. */
static PetscErrorCode lay(Solve *solve, PetscReal t0, Vec last, PetscBool *laid)
{
  Settle    s;
  PetscInt  refused = 0, n_rest = 0;
  PetscReal length = 0, bound = 0, pressing;
  PetscBool possible = PETSC_FALSE;
  Vec       x;
  PetscFunctionBegin;
  PetscCall(VecDuplicate(last, &x));
  PetscCall(VecCopy(last, x));
  PetscCall(evaluate(solve, x, &refused));
  PetscCall(begin(solve, &s, &possible));
  for (int k = 0; k < (s.rubs ? MOVES : MOVES_WITHOUT_FRICTION) && possible && n_rest < RESTS && !refused; k++) {
    PetscCall(find_load(solve, &s, &pressing));
    PetscCall(settle_find_gaps(solve, &s));
    settle_find_move(&s, SWEPT * REACH * s.edge);
    PetscCall(make_move(solve, &s, x, &length));
    bound  = PetscSqrtReal(settle_dot(s.n, s.load, s.load));
    n_rest = length <= REST * bound ? n_rest + 1 : 0;
    PetscCall(evaluate(solve, x, &refused));
  }
  if (possible && !refused && length <= (s.rubs ? NEARLY : REST) * bound) PetscCall(settle_wants_friction(&s, laid));
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
    char      names[512] = "";
    PetscCall(VecAXPY(last, -1, x));
    PetscCall(VecNorm(last, NORM_INFINITY, &moved));
    PetscCall(VecCopy(x, last));
    for (PetscInt p = 0; p < solve->physics->parts.n; p++) {
      const PetscReal *turned = s.turned + 3 * p;
      if (settle_dot(3, turned, turned) <= PetscSqr(TURNED) || !laid_turn(solve->physics, p)) continue;
      PetscCall(append_name(solve->mesh, mesh_body_of(solve->mesh, solve->physics->parts.part[p].first), names, sizeof(names)));
    }
    PetscCall(tell(solve, t0, moved, names));
  }
  PetscCall(end(&s));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before a step is taken from `past`: lays down what is loose there, by the loads of now. */
PetscErrorCode settle_loose(Solve *solve, Past *past)
{
  Physics  *physics = solve->physics;
  PetscBool loose;
  PetscFunctionBegin;
  solve->newton.laid = PETSC_FALSE;
  if (!allowed(solve)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(loads_values(physics));
  PetscCall(supports_values(physics, past->t_last));
  PetscCall(closing_needed(solve, past->last, &loose));
  if (loose) PetscCall(lay(solve, past->t_last, past->last, &solve->newton.laid));
  PetscCall(supports_values(physics, physics->t));
  if (solve->newton.laid) past->have_before = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
