/* Rigid bodies in a part of an interface: numbers for the equations that their nodes have in the library's tangent, and what that tangent
 * becomes by the bodies' own unknowns (docs/formulation 14.4). The forces need nothing here: they are collected where all of them
 * are (physics/rigids.c). */
#include "contact/contact.h"

struct RigidPart {
  PetscInt                n_bodies, n_nodes;
  PetscInt               *which, *nodes; /* of each body: among the physics'; of each node, body by body: in the part */
  double                 *coordinates, *forces;
  int64_t                *numbers, *equations; /* of nodes; of bodies */
  stickslip_rigid_body   *bodies;
  stickslip_rigid_motion *motions;
  stickslip_rigid        *plan;
  int64_t                 count, capacity, *rows, *columns; /* of its outcome */
  double                 *values, *scale;
};

static PetscErrorCode allocate(PetscInt dimension, RigidPart *rigid)
{
  const PetscInt n = dimension * rigid->n_nodes;
  PetscFunctionBegin;
  PetscCall(PetscMalloc4(rigid->n_bodies, &rigid->which, rigid->n_bodies, &rigid->bodies, rigid->n_bodies, &rigid->motions,
                         RIGID_UNKNOWNS * rigid->n_bodies, &rigid->equations));
  PetscCall(PetscMalloc4(rigid->n_nodes, &rigid->nodes, n, &rigid->coordinates, n, &rigid->forces, n, &rigid->numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The body's nodes of this part; their equations are beyond all others', where the node is free to move. */
static void fill_body(const Rigid *body, PetscInt first_number, const ContactPart *part, PetscBool is_frame, RigidPart *rigid)
{
  const PetscInt        d    = part->dimension, mask = is_frame ? 0 : rigids_node_mask(body), first = rigid->n_nodes;
  stickslip_rigid_body *made = &rigid->bodies[rigid->n_bodies];
  int64_t              *own  = rigid->equations + RIGID_UNKNOWNS * rigid->n_bodies;
  for (PetscInt k = 0; k < part->n1 + part->n2; k++) {
    if (part->vertices[k] < body->first_vertex || part->vertices[k] >= body->end_vertex) continue;
    rigid->nodes[rigid->n_nodes] = k;
    for (PetscInt i = 0; i < d; i++) {
      const int64_t number = mask & (1 << i) ? -1 : first_number + (int64_t)d * part->nodes[k] + i;
      rigid->coordinates[d * rigid->n_nodes + i] = part->X[d * k + i];
      rigid->numbers[d * rigid->n_nodes + i] = part->equations[d * k + i] = number;
    }
    rigid->n_nodes++;
  }
  for (int k = 0; k < RIGID_UNKNOWNS && d == 3; k++)
    own[k] = body->equations[k];
  if (d == 2) own[0] = body->equations[0], own[1] = body->equations[1], own[2] = body->equations[5];
  *made = (stickslip_rigid_body){.struct_size = sizeof(*made), .dimension = (int32_t)d, .n_nodes = rigid->n_nodes - first,
                                 .coordinates = rigid->coordinates + d * first, .point = body->point,
                                 .node_equations = rigid->numbers + d * first, .equations = own};
}

static PetscBool moves(const Rigid *body)
{
  for (int k = 0; k < RIGID_UNKNOWNS; k++) {
    if (body->equations[k] >= 0) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Of a part whose nodes have the host's equations; `first_number`: beyond all that there are. Nothing, where no rigid body moves. */
PetscErrorCode rigid_part_create(const Contact *contact, const Interface *interface, PetscInt first_number, ContactPart *part)
{
  const Physics *physics = contact->physics;
  RigidPart     *rigid;
  PetscInt       n_nodes = 0, n_bodies = 0;
  PetscFunctionBegin;
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    PetscInt n = 0;
    for (PetscInt k = 0; k < part->n1 + part->n2 && moves(&physics->rigids[r]); k++)
      n += rigids_of_vertex(physics, part->vertices[k]) == r;
    n_nodes += n;
    n_bodies += n > 0;
  }
  if (!n_bodies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&rigid));
  rigid->n_bodies = n_bodies;
  rigid->n_nodes  = n_nodes;
  PetscCall(allocate(part->dimension, rigid));
  rigid->n_bodies = rigid->n_nodes = 0;
  for (PetscInt r = 0; r < physics->n_rigids; r++) {
    const Rigid   *body   = &physics->rigids[r];
    const PetscInt before = rigid->n_nodes;
    if (!moves(body)) continue;
    rigid->which[rigid->n_bodies] = r;
    fill_body(body, first_number, part, (PetscBool)(interface->options.mortar_side == STICKSLIP_MORTAR_ANALYTIC), rigid);
    if (rigid->n_nodes > before) rigid->n_bodies++;
    if (rigid->n_bodies == n_bodies) break;
  }
  part->rigid = rigid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode destroy_plan(RigidPart *rigid)
{
  PetscFunctionBegin;
  PetscCallStickslip(stickslip_rigid_destroy(&rigid->plan));
  rigid->count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode rigid_part_destroy(ContactPart *part)
{
  RigidPart *rigid = part->rigid;
  PetscFunctionBegin;
  if (!rigid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(destroy_plan(rigid));
  PetscCall(PetscFree4(rigid->which, rigid->bodies, rigid->motions, rigid->equations));
  PetscCall(PetscFree4(rigid->nodes, rigid->coordinates, rigid->forces, rigid->numbers));
  PetscCall(PetscFree4(rigid->rows, rigid->columns, rigid->values, rigid->scale));
  PetscCall(PetscFree(rigid));
  part->rigid = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The unknown that stands for a rotation is it times the body's length, its equation the moment over that. */
static double scale_of(const Physics *physics, const RigidPart *rigid, int64_t equation)
{
  for (PetscInt b = 0; b < rigid->n_bodies; b++) {
    const Rigid *body = &physics->rigids[rigid->which[b]];
    for (int k = 3; k < RIGID_UNKNOWNS; k++) {
      if (body->equations[k] == equation) return 1 / body->length;
    }
  }
  return 1;
}

/* What `count` entries in the part's arrays, the library's, become. There may be none, as of the forces of tied surfaces in a condensed
 * system: these forces turn with the bodies all the same. */
PetscErrorCode rigid_part_plan(const Contact *contact, ContactPart *part, int64_t count)
{
  RigidPart *rigid = part->rigid;
  PetscFunctionBegin;
  if (!rigid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(destroy_plan(rigid));
  PetscCallStickslip(stickslip_rigid_create(rigid->n_bodies, rigid->bodies, 0, count, part->coo_rows, part->coo_columns, &rigid->plan,
                                            &rigid->count));
  if (rigid->count > rigid->capacity) {
    rigid->capacity = rigid->count + rigid->count / 4;
    PetscCall(PetscFree4(rigid->rows, rigid->columns, rigid->values, rigid->scale));
    PetscCall(PetscMalloc4(rigid->capacity, &rigid->rows, rigid->capacity, &rigid->columns, rigid->capacity, &rigid->values,
                           rigid->capacity, &rigid->scale));
  }
  PetscCallStickslip(stickslip_rigid_coo(rigid->plan, rigid->count, rigid->rows, rigid->columns));
  for (int64_t k = 0; k < rigid->count; k++)
    rigid->scale[k] = scale_of(contact->physics, rigid, rigid->rows[k]) * scale_of(contact->physics, rigid, rigid->columns[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the values in the part's array. `forces`, as the part has them at the place of now, turn with the bodies; NULL: the entries are no
 * derivatives of forces. */
PetscErrorCode rigid_part_values(const Contact *contact, ContactPart *part, const PetscScalar *forces)
{
  RigidPart     *rigid = part->rigid;
  const PetscInt d     = part->dimension;
  PetscFunctionBegin;
  if (!rigid || !rigid->plan) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < rigid->n_bodies; b++)
    rigid->motions[b] = rigids_motion(&contact->physics->rigids[rigid->which[b]]);
  for (PetscInt k = 0; k < d * rigid->n_nodes; k++)
    rigid->forces[k] = forces ? PetscRealPart(forces[d * rigid->nodes[k / d] + k % d]) : 0;
  PetscCallStickslip(stickslip_rigid_values(rigid->plan, rigid->motions, rigid->forces, part->coo_values, rigid->values));
  for (int64_t k = 0; k < rigid->count; k++)
    rigid->values[k] *= rigid->scale[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The entries for the host's matrix: the part's `count` own, or what became of them. */
Entries rigid_part_entries(const ContactPart *part, int64_t count)
{
  const RigidPart *rigid = part->rigid;
  if (!rigid) return (Entries){.n = count, .rows = part->coo_rows, .columns = part->coo_columns, .values = part->coo_values};
  return (Entries){.n = rigid->count, .rows = rigid->rows, .columns = rigid->columns, .values = rigid->values};
}
