/* The binding to the contact library. Rank 0 drives it: positions and multipliers of the interface's nodes are gathered
 * there, forces are sent back and added, tangent entries go into the matrix by their equation numbers. */
#include "model.h"

/* PetscCall around it means: the library refused, which the caller handles; the message is kept for the report. */
static PetscErrorCode agree(Model *model, int32_t refused, PetscInt *status)
{
  PetscFunctionBegin;
  *status = refused;
  if (model->rank == 0 && refused) PetscCall(PetscSNPrintf(model->refusal, sizeof(model->refusal), "%s", stickslip_last_error_message()));
  PetscCallMPI(MPI_Bcast(status, 1, MPIU_INT, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(model->refusal, sizeof(model->refusal), MPI_CHAR, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int64_t n_entries(const Interface *interface)
{
  return 3 * (2 * (int64_t)interface->n1 + interface->n2);
}

static void current_coordinates(Interface *interface)
{
  for (PetscInt k = 0; k < 3 * (interface->n1 + interface->n2); k++) interface->x[k] = interface->X[k] + PetscRealPart(interface->gathered[k]);
}

/* The library takes x1, x2 and the multipliers: */
#define STATE_OF(interface) (interface)->x, (interface)->x + 3 * (interface)->n1, (interface)->gathered + 3 * ((interface)->n1 + (interface)->n2)

PetscErrorCode contact_gather(Model *model, Interface *interface, Vec local)
{
  const PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(local, &array));
  PetscCall(PetscSFBcastBegin(interface->sf, MPIU_SCALAR, array, interface->gathered, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(interface->sf, MPIU_SCALAR, array, interface->gathered, MPI_REPLACE));
  PetscCall(VecRestoreArrayRead(local, &array));
  if (model->rank == 0) current_coordinates(interface);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode scatter(Interface *interface, const PetscScalar *from, Vec local, MPI_Op operation)
{
  PetscScalar *array;
  PetscFunctionBegin;
  PetscCall(VecGetArray(local, &array));
  PetscCall(PetscSFReduceBegin(interface->sf, MPIU_SCALAR, from, array, operation));
  PetscCall(PetscSFReduceEnd(interface->sf, MPIU_SCALAR, from, array, operation));
  PetscCall(VecRestoreArray(local, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_forces(Model *model, Vec f_local, PetscReal *squared_norm, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < model->n_interfaces && !*status; i++) {
    Interface *interface = &model->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank == 0) {
      PetscScalar *f1 = interface->forces, *f2 = f1 + 3 * interface->n1, *rows = f2 + 3 * interface->n2;
      refused = stickslip_interface_residual(interface->handle, STATE_OF(interface), NULL, f1, f2, rows);
      for (PetscInt k = 0; k < 3 * (interface->n1 + interface->n2) && !refused; k++) *squared_norm += PetscSqr(PetscAbsScalar(interface->forces[k]));
    }
    PetscCall(agree(model, refused, status));
    if (!*status) PetscCall(scatter(interface, interface->forces, f_local, MPIU_SUM));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode reserve(Interface *interface, int64_t count)
{
  PetscFunctionBegin;
  if (count > interface->coo_capacity) {
    interface->coo_capacity = count + count / 4;
    PetscCall(PetscFree3(interface->coo_rows, interface->coo_columns, interface->coo_values));
    PetscCall(PetscMalloc3(interface->coo_capacity, &interface->coo_rows, interface->coo_capacity, &interface->coo_columns, interface->coo_capacity, &interface->coo_values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode insert(const Interface *interface, int64_t count, const double *values, Mat matrix)
{
  PetscFunctionBegin;
  for (int64_t k = 0; k < count; k++) PetscCall(MatSetValue(matrix, (PetscInt)interface->coo_rows[k], (PetscInt)interface->coo_columns[k], values ? values[k] : 0, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_tangent(Model *model, Mat matrix, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < model->n_interfaces && !*status; i++) {
    Interface *interface = &model->interfaces[i];
    int32_t    refused   = 0;
    int64_t    count     = 0;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank == 0) {
      refused = stickslip_interface_tangent_coo(interface->handle, STATE_OF(interface), NULL, 0, NULL, NULL, NULL, &count);
      if (!refused) {
        PetscCall(reserve(interface, count));
        refused = stickslip_interface_tangent_coo(interface->handle, STATE_OF(interface), NULL, interface->coo_capacity, interface->coo_rows, interface->coo_columns, interface->coo_values, &count);
      }
      if (!refused) PetscCall(insert(interface, count, interface->coo_values, matrix));
    }
    PetscCall(agree(model, refused, status));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_pattern(Model *model, Mat matrix)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < model->n_interfaces; i++) {
    Interface *interface = &model->interfaces[i];
    int64_t    count;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank) continue;
    PetscCallStickslip(stickslip_interface_pattern_coo(interface->handle, interface->x, interface->x + 3 * interface->n1, 0, NULL, NULL, &count));
    PetscCall(reserve(interface, count));
    PetscCallStickslip(stickslip_interface_pattern_coo(interface->handle, interface->x, interface->x + 3 * interface->n1, interface->coo_capacity, interface->coo_rows, interface->coo_columns, &count));
    PetscCall(insert(interface, count, NULL, matrix));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A slightly compressive multiplier on nodes that touch: without it a body held by contact alone starts without support. */
PetscErrorCode contact_start(Model *model, Vec x, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  PetscCall(unknowns_to_local(model, x));
  for (PetscInt i = 0; i < model->n_interfaces && !*status; i++) {
    Interface *interface = &model->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank == 0) refused = stickslip_interface_initial_multipliers(interface->handle, interface->gathered + 3 * (interface->n1 + interface->n2));
    PetscCall(agree(model, refused, status));
    if (!*status) PetscCall(scatter(interface, interface->gathered, model->u_local, MPI_REPLACE));
  }
  PetscCall(DMLocalToGlobalBegin(model->dm, model->u_local, INSERT_VALUES, x));
  PetscCall(DMLocalToGlobalEnd(model->dm, model->u_local, INSERT_VALUES, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_states_create(const Interface *interface, ContactStates *states)
{
  const PetscInt   n1     = interface->n1;
  stickslip_states wanted = {.struct_size = sizeof(wanted)};

  PetscFunctionBegin;
  PetscCall(PetscMalloc7(n1, &states->state, 3 * n1, &states->normal, n1, &states->gap, 3 * n1, &states->slip, n1, &states->coverage, n1, &states->area, n1, &states->dissipation));
  wanted.state       = states->state;
  wanted.normal      = states->normal;
  wanted.gap         = states->gap;
  wanted.slip        = states->slip;
  wanted.coverage    = states->coverage;
  wanted.area        = states->area;
  wanted.dissipation = states->dissipation;
  PetscCallStickslip(stickslip_interface_states(interface->handle, STATE_OF(interface), NULL, &wanted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_states_destroy(ContactStates *states)
{
  PetscFunctionBegin;
  PetscCall(PetscFree7(states->state, states->normal, states->gap, states->slip, states->coverage, states->area, states->dissipation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All interfaces accept the step, or none: what was committed before a refusal is rolled back. */
PetscErrorCode contact_commit(Model *model, PetscInt *status)
{
  PetscInt committed = 0;
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < model->n_interfaces && !*status; i++) {
    Interface *interface = &model->interfaces[i];
    int32_t    refused   = 0;
    PetscCall(contact_gather(model, interface, model->u_local));
    if (model->rank == 0) refused = stickslip_interface_commit(interface->handle, STATE_OF(interface), NULL);
    PetscCall(agree(model, refused, status));
    if (!*status) committed++;
  }
  for (PetscInt i = 0; i < committed && *status && model->rank == 0; i++) PetscCallStickslip(stickslip_interface_rollback(model->interfaces[i].handle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* --- reading and set-up --------------------------------------------------------------------------------------------- */

/* equations of the gathered entries, as the library wants them */
static PetscErrorCode gather_equations(Model *model, Interface *interface)
{
  const int64_t n = model->rank ? 0 : n_entries(interface);
  PetscInt     *numbers;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &numbers));
  PetscCall(PetscSFBcastBegin(interface->sf, MPIU_INT, model->equations, numbers, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(interface->sf, MPIU_INT, model->equations, numbers, MPI_REPLACE));
  for (int64_t k = 0; k < n; k++) interface->equations[k] = numbers[k] < 0 ? -1 : numbers[k];
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode describe_surface(const Model *model, const Interface *interface, int side, stickslip_surface *out, int64_t **facet_nodes)
{
  const Surface *surface = interface->surface[side];
  const PetscInt first = side ? interface->n1 : 0, n = side ? interface->n2 : interface->n1, n_corners = surface->offsets[surface->n_faces];
  PetscInt      *local;
  int64_t       *offsets;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n_corners + surface->n_faces + 1, facet_nodes));
  PetscCall(PetscMalloc1(model->mesh.n_vertices, &local));
  offsets = *facet_nodes + n_corners;
  for (PetscInt k = 0; k < n; k++) local[interface->nodes[first + k]] = k;
  for (PetscInt k = 0; k < n_corners; k++) (*facet_nodes)[k] = local[surface->vertices[k]];
  for (PetscInt f = 0; f <= surface->n_faces; f++) offsets[f] = surface->offsets[f];
  *out = (stickslip_surface){.struct_size = sizeof(*out)};
  out->n_nodes       = n;
  out->n_facets      = surface->n_faces;
  out->coordinates   = interface->X + 3 * first;
  out->facet_offsets = offsets;
  out->facet_nodes   = *facet_nodes;
  out->equations     = interface->equations + 3 * first;
  if (!side) out->multiplier_equations = interface->equations + 3 * (interface->n1 + interface->n2);
  PetscCall(PetscFree(local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Directions in which a node and the whole mortar side are prescribed carry no multiplier, and the normal none of them. */
static int32_t set_constraints(const Interface *interface)
{
  int64_t *nodes, n = 0;
  double  *directions;
  int32_t  status;
  PetscCallAbort(PETSC_COMM_SELF, PetscCalloc2(2 * interface->n1, &nodes, 6 * interface->n1, &directions));
  for (PetscInt a = 0; a < interface->n1; a++) {
    if (interface->removed[a] == 7) continue; /* wholly prescribed: no unknown is left, and the normal stays free */
    for (int i = 0; i < 3; i++) {
      if (!(interface->removed[a] & (1 << i))) continue;
      nodes[n]              = a;
      directions[3 * n + i] = 1;
      n++;
    }
  }
  status = n ? stickslip_interface_set_constraints(interface->handle, n, nodes, directions) : 0;
  PetscCallAbort(PETSC_COMM_SELF, PetscFree2(nodes, directions));
  return status;
}

PetscErrorCode contact_create(Model *model, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < model->n_interfaces && !*status; i++) {
    Interface            *interface = &model->interfaces[i];
    const PetscInt        counts[3] = {interface->n1, interface->n2, interface->n1}, fields[3] = {0, 0, 1 + i};
    const PetscInt *const nodes[3] = {interface->nodes, interface->nodes + interface->n1, interface->nodes};
    int32_t               refused  = 0;
    const int64_t         n        = model->rank ? 0 : n_entries(interface);

    PetscCall(unknowns_gather_create(model, 3, counts, nodes, fields, &interface->sf));
    PetscCall(PetscCalloc5(n, &interface->X, n, &interface->x, n, &interface->gathered, n, &interface->forces, n, &interface->equations));
    PetscCall(gather_equations(model, interface));
    if (model->rank == 0) {
      stickslip_surface surfaces[2];
      int64_t          *facet_nodes[2];
      for (PetscInt k = 0; k < 3 * (interface->n1 + interface->n2); k++) interface->X[k] = model->mesh.coordinates[3 * interface->nodes[k / 3] + k % 3];
      for (int side = 0; side < 2; side++) PetscCall(describe_surface(model, interface, side, &surfaces[side], &facet_nodes[side]));
      refused = stickslip_interface_create(&surfaces[0], &surfaces[1], &interface->options, &interface->handle);
      if (!refused) refused = set_constraints(interface);
      for (int side = 0; side < 2; side++) PetscCall(PetscFree(facet_nodes[side]));
    }
    PetscCall(agree(model, refused, status));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_destroy(Model *model)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < model->n_interfaces; i++) {
    Interface *interface = &model->interfaces[i];
    PetscCallStickslip(stickslip_interface_destroy(&interface->handle));
    PetscCall(PetscSFDestroy(&interface->sf));
    PetscCall(PetscFree5(interface->X, interface->x, interface->gathered, interface->forces, interface->equations));
    PetscCall(PetscFree3(interface->coo_rows, interface->coo_columns, interface->coo_values));
    PetscCall(PetscFree(interface->nodes));
    PetscCall(PetscFree(interface->removed));
  }
  PetscCall(PetscFree(model->interfaces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
