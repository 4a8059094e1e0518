/* Heat through the interfaces, by the library. Temperatures, equations and heats of a part's nodes come and go as displacements
 * and forces do, in place of the first component. */
#include "heat/heat.h"

PetscErrorCode heat_widen(const Heat *heat, const PetscScalar *from)
{
  const Mesh  *mesh = heat->mesh;
  PetscScalar *wide;
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(heat->wide));
  PetscCall(VecGetArray(heat->wide, &wide));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscInt to, at;
    PetscCall(PetscSectionGetOffset(heat->physics->unknowns.section, mesh->points[k], &to));
    PetscCall(PetscSectionGetOffset(heat->section, mesh->points[k], &at));
    wide[to] = from[at];
  }
  PetscCall(VecRestoreArray(heat->wide, &wide));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of this rank's part: a number a node, out of the wide vector */
static PetscErrorCode fetch(const Heat *heat, const ContactPart *part, double values[])
{
  const PetscInt d = part->dimension, n = part->n1 + part->n2;
  PetscScalar   *vectors;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(d * n + part->components * part->n1, &vectors));
  PetscCall(contact_fetch(part->sf, heat->wide, vectors));
  for (PetscInt k = 0; k < n; k++)
    values[k] = PetscRealPart(vectors[d * k]);
  PetscCall(PetscFree(vectors));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* adds a number a node of all parts to the temperatures' local vector, where this rank owns the vertex */
static PetscErrorCode give(const Heat *heat, const ContactPart *part, const double values[], PetscScalar *leaves)
{
  const Mesh        *mesh = heat->mesh;
  const PetscInt     d = part->dimension, n = part->n1 + part->n2;
  PetscScalar       *vectors;
  const PetscScalar *wide;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(d * n + part->components * part->n1, &vectors));
  for (PetscInt k = 0; k < n; k++)
    vectors[d * k] = values[k];
  PetscCall(VecZeroEntries(heat->wide));
  PetscCall(contact_scatter(part, vectors, heat->wide, MPIU_SUM));
  PetscCall(PetscFree(vectors));
  PetscCall(VecGetArrayRead(heat->wide, &wide));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscInt from, at;
    if (heat->physics->unknowns.ghost[k]) continue;
    PetscCall(PetscSectionGetOffset(heat->physics->unknowns.section, mesh->points[k], &from));
    PetscCall(PetscSectionGetOffset(heat->section, mesh->points[k], &at));
    leaves[at] += wide[from];
  }
  PetscCall(VecRestoreArrayRead(heat->wide, &wide));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a part: temperatures, equations, heats, n1 + n2 each; of its own nodes flux times area, friction's heat. */
typedef struct {
  double  *temperatures, *numbers, *heats, *flux, *friction, *area;
  int64_t *equations;
} Room;

static PetscErrorCode tangent(const ContactPart *part, const stickslip_heat *law, const Room *room, HeatEntries *entries,
                              int32_t *refused)
{
  int64_t  n = 0, *rows, *columns;
  double  *values;
  PetscFunctionBegin;
  *refused = stickslip_interface_heat_tangent_coo(part->handle, STATE_OF(part), law, room->temperatures,
                                                  room->temperatures + part->n1, room->equations, room->equations + part->n1,
                                                  STICKSLIP_HEAT_TEMPERATURES, 0, NULL, NULL, NULL, &n);
  if (*refused) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(n + 1, &rows, n + 1, &columns, n + 1, &values));
  *refused = stickslip_interface_heat_tangent_coo(part->handle, STATE_OF(part), law, room->temperatures,
                                                  room->temperatures + part->n1, room->equations, room->equations + part->n1,
                                                  STICKSLIP_HEAT_TEMPERATURES, n, rows, columns, values, &n);
  for (int64_t k = 0; k < n && !*refused; k++)
    PetscCall(entries_add(entries, (PetscInt)rows[k], (PetscInt)columns[k], values[k]));
  PetscCall(PetscFree3(rows, columns, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode add_one(Heat *heat, PetscInt i, PetscReal dt, const PetscScalar *temperatures,
                              const PetscScalar *numbers, PetscScalar *leaves, HeatEntries *entries, PetscInt *status)
{
  Contact        *contact   = heat->contact;
  Interface      *interface = &contact->interfaces[i];
  HeatInterface  *of        = &heat->interfaces[i];
  ContactPart    *part      = &interface->part;
  const PetscInt  n         = part->n1 + part->n2;
  stickslip_heat  law       = of->law;
  int32_t         refused   = 0;
  PetscReal       sums[2]   = {0, 0};
  Room            room;
  PetscFunctionBegin;
  if (law.time > 0) law.time = dt;
  PetscCall(contact_gather(contact, interface, heat->physics->u_local));
  PetscCall(PetscMalloc7(n, &room.temperatures, n, &room.numbers, n, &room.heats, n, &room.equations, part->n1, &room.flux,
                         part->n1, &room.friction, part->n1, &room.area));
  PetscCall(PetscArrayzero(room.heats, n));
  PetscCall(heat_widen(heat, temperatures));
  PetscCall(fetch(heat, part, room.temperatures));
  PetscCall(heat_widen(heat, numbers));
  PetscCall(fetch(heat, part, room.numbers));
  for (PetscInt k = 0; k < n; k++)
    room.equations[k] = (int64_t)room.numbers[k];
  if (part->handle) {
    const stickslip_heat_nodes nodes = {.struct_size = sizeof(nodes), .flux = room.flux, .friction = room.friction,
                                        .area = room.area};
    refused = stickslip_interface_heat(part->handle, STATE_OF(part), &law, room.temperatures, room.temperatures + part->n1,
                                       room.heats, room.heats + part->n1, &nodes);
    for (PetscInt a = 0; a < part->n1 && !refused; a++) {
      sums[0] += room.flux[a] * room.area[a];
      sums[1] += room.friction[a];
    }
    if (!refused && entries) PetscCall(tangent(part, &law, &room, entries, &refused));
  }
  PetscCall(contact_agree(contact, interface, refused, status));
  if (!*status) PetscCall(give(heat, part, room.heats, leaves));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  of->across   = sums[0];
  of->friction = sums[1];
  PetscCall(PetscFree7(room.temperatures, room.numbers, room.heats, room.equations, room.flux, room.friction, room.area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode across_add(Heat *heat, PetscReal dt, PetscScalar *leaves, HeatEntries *entries, PetscInt *status)
{
  const PetscScalar *now;
  PetscScalar       *numbers;
  PetscInt           n;
  PetscFunctionBegin;
  *status = 0;
  PetscCall(VecGetLocalSize(heat->now, &n));
  PetscCall(PetscMalloc1(n, &numbers));
  for (PetscInt k = 0; k < n; k++)
    numbers[k] = heat->equations[k] < 0 ? -1 : heat->equations[k];
  tools_number(heat, numbers);
  PetscCall(VecGetArrayRead(heat->now, &now));
  for (PetscInt i = 0; i < heat->contact->n_interfaces && !*status; i++) {
    if (heat->interfaces[i].passes) PetscCall(add_one(heat, i, dt, now, numbers, leaves, entries, status));
  }
  PetscCall(VecRestoreArrayRead(heat->now, &now));
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0 gets the temperatures of all non-mortar nodes. */
PetscErrorCode heat_collect(Heat *heat)
{
  const PetscScalar *now;
  PetscFunctionBegin;
  if (!heat->on) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(heat->now, &now));
  PetscCall(heat_widen(heat, now));
  PetscCall(VecRestoreArrayRead(heat->now, &now));
  for (PetscInt i = 0; i < heat->contact->n_interfaces; i++) {
    const Interface *interface = &heat->contact->interfaces[i];
    HeatInterface   *of        = &heat->interfaces[i];
    const PetscInt   d = interface->dimension, n1 = interface->n1;
    PetscScalar     *vectors;
    PetscCall(PetscMalloc1(d * (n1 + interface->n2), &vectors));
    PetscCall(contact_fetch(interface->sf, heat->wide, vectors));
    if (!of->temperatures) PetscCall(PetscMalloc1(n1, &of->temperatures));
    for (PetscInt a = 0; a < n1; a++)
      of->temperatures[a] = PetscRealPart(vectors[d * a]);
    PetscCall(PetscFree(vectors));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
