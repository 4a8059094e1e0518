/* The model's parts, connected pieces of mesh that nothing but contact joins, and whether the forces on each balance.
 *
 * A part's residual is compared with twice its own forces, |loads| + |reactions| + |contact forces| (2-norms of nodal forces),
 * the largest so far (at the start: FAINT E size^2), so that an unloaded step is not judged by its own noise. Below the
 * rounding of displacements it balances, too: that alone gives a part that moves without stress its forces
 * (bulk_forces()). Another part's forces count for nothing, however large they are. */
#include "model.h"

/* Rounding may be so much of the forces on a part that has loads. It is nearly balanced in itself: where it is 1e-3 of a
 * load, contact forces are right to 1e-10; where it is as large as the load, they are anything. */
static const PetscReal DROWNED = 1e-3;
/* A force on a part is balanced within it, so that it acts twice. */
static const PetscReal TWICE = 2;
/* A first reference, over E times the square of the part's size: too small to matter. */
static const PetscReal FAINT = 1e-12;

static PetscInt root_of(const PetscInt parent[], PetscInt v)
{
  while (parent[v] != v)
    v = parent[v];
  return v;
}

static void join(PetscInt parent[], PetscInt a, PetscInt b)
{
  a                      = root_of(parent, a);
  b                      = root_of(parent, b);
  parent[PetscMax(a, b)] = PetscMin(a, b); /* a root is the least of its tree */
}

/* rank 0: from trees to numbers from 0, in order of the roots; a parent comes before its children, so that it has its
 * number already */
static PetscInt number_trees(PetscInt n, PetscInt parent[])
{
  PetscInt count = 0;
  for (PetscInt v = 0; v < n; v++)
    parent[v] = parent[v] == v ? count++ : parent[parent[v]];
  return count;
}

static PetscReal diagonal_squared(const Extent *extent)
{
  PetscReal squared = 0;
  for (int i = 0; i < 3; i++)
    squared += PetscSqr(extent->high[i] - extent->low[i]);
  return squared;
}

/* rank 0: the box around a part's vertices, and that around all parts that interfaces join to it; the stiffest E */
static PetscErrorCode measure(Model *model)
{
  const Mesh *mesh = &model->mesh;
  Extent     *own, *whole; /* of each part; of each cluster */
  PetscInt   *cluster;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(model->n_parts, &own, model->n_parts, &whole, model->n_parts, &cluster));
  for (PetscInt p = 0; p < model->n_parts; p++) {
    own[p] = whole[p] = extent_of_nothing();
    cluster[p]        = p;
  }
  for (PetscInt i = 0; i < model->n_interfaces; i++) {
    const Interface *interface = &model->interfaces[i];
    for (PetscInt k = 1; k < interface->n1 + interface->n2; k++)
      join(cluster, model->mesh_part[interface->nodes[0]], model->mesh_part[interface->nodes[k]]);
  }
  (void)number_trees(model->n_parts, cluster);
  for (PetscInt v = 0; v < mesh->n_vertices; v++) {
    const PetscInt p = model->mesh_part[v];
    extent_add(&own[p], mesh->coordinates + 3 * v);
    extent_add(&whole[cluster[p]], mesh->coordinates + 3 * v);
  }
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    Part *part  = &model->parts[model->mesh_part[mesh->cell_vertices[mesh->cell_offsets[c]]]];
    part->young = PetscMax(part->young, mesh->bodies[mesh->cell_body[c]].material.young);
  }
  for (PetscInt p = 0; p < model->n_parts; p++) {
    model->parts[p].reach = PetscSqrtReal(diagonal_squared(&whole[cluster[p]]));
    model->parts[p].faint = FAINT * model->parts[p].young * diagonal_squared(&own[p]);
  }
  PetscCall(PetscFree3(own, whole, cluster));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before the mesh is distributed: which part each vertex belongs to. */
PetscErrorCode parts_label(Model *model)
{
  const Mesh *mesh = &model->mesh;
  PetscInt   *part = NULL;

  PetscFunctionBegin;
  if (model->rank == 0) {
    PetscCall(PetscMalloc1(mesh->n_vertices, &part));
    for (PetscInt v = 0; v < mesh->n_vertices; v++)
      part[v] = v;
    for (PetscInt c = 0; c < mesh->n_cells; c++) {
      for (PetscInt k = mesh->cell_offsets[c] + 1; k < mesh->cell_offsets[c + 1]; k++)
        join(part, mesh->cell_vertices[k - 1], mesh->cell_vertices[k]);
    }
    model->n_parts = number_trees(mesh->n_vertices, part);
  }
  PetscCallMPI(MPI_Bcast(&model->n_parts, 1, MPIU_INT, 0, PETSC_COMM_WORLD));
  model->mesh_part = part;
  PetscCall(PetscCalloc2(model->n_parts, &model->parts, N_SQUARES * model->n_parts, &model->squares));
  if (model->rank == 0) PetscCall(measure(model));
  PetscCallMPI(MPI_Bcast(model->parts, (PetscMPIInt)(sizeof(Part) * (size_t)model->n_parts), MPI_BYTE, 0,
                         PETSC_COMM_WORLD));
  PetscCall(plex_label_vertices(model->dm, "part", model->rank ? 0 : mesh->n_vertices, NULL, part, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After it: the part of each vertex here. */
PetscErrorCode parts_create(Model *model)
{
  DMLabel label;
  PetscFunctionBegin;
  PetscCall(DMGetLabel(model->dm, "part", &label));
  PetscCall(PetscMalloc1(model->vEnd - model->vStart, &model->vertex_part));
  for (PetscInt v = model->vStart; v < model->vEnd; v++)
    PetscCall(DMLabelGetValue(label, v, &model->vertex_part[v - model->vStart]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode parts_destroy(Model *model)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(model->parts, model->squares));
  PetscCall(PetscFree(model->mesh_part));
  PetscCall(PetscFree(model->vertex_part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the squares of a local vector's displacement entries to each part's: those of prescribed ones to `prescribed`, of
 * the others to `free`; -1: not wanted. */
static PetscErrorCode add_squares(Model *model, Vec local, int prescribed, int free)
{
  const PetscScalar *f;
  PetscFunctionBegin;
  PetscCall(unknowns_sum(model, local));
  PetscCall(VecGetArrayRead(model->f_sum, &f));
  for (PetscInt v = model->vStart; v < model->vEnd; v++) {
    PetscReal *squares = model->squares + N_SQUARES * model->vertex_part[v - model->vStart];
    PetscInt   at;
    if (model->ghost[v - model->vStart]) continue;
    PetscCall(PetscSectionGetOffset(model->section, v, &at));
    for (int i = 0; i < 3; i++) {
      const int kind = model->equations[at + i] < 0 ? prescribed : free;
      if (kind >= 0) squares[kind] += PetscSqr(PetscAbsScalar(f[at + i]));
    }
  }
  PetscCall(VecRestoreArrayRead(model->f_sum, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At the end of an evaluation: bulk_forces() and contact_forces() have left their squares in model->squares. */
PetscErrorCode parts_measure(Model *model)
{
  PetscReal sum[N_SQUARES] = {0};
  PetscFunctionBegin;
  PetscCall(add_squares(model, model->f_external, SQUARES_LOADS, SQUARES_LOADS));
  PetscCall(add_squares(model, model->f_local, SQUARES_REACTIONS, SQUARES_RESIDUAL));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, model->squares, (PetscMPIInt)(N_SQUARES * model->n_parts), MPIU_REAL,
                             MPIU_SUM, PETSC_COMM_WORLD));
  for (PetscInt p = 0; p < model->n_parts; p++) {
    const PetscReal *squares = model->squares + N_SQUARES * p;
    for (int k = 0; k < N_SQUARES; k++)
      sum[k] += squares[k];
    model->parts[p].residual  = PetscSqrtReal(squares[SQUARES_RESIDUAL]);
    model->parts[p].noise     = PetscSqrtReal(squares[SQUARES_ROUNDING]);
    model->parts[p].loads     = PetscSqrtReal(squares[SQUARES_LOADS]);
    model->parts[p].reference =
        TWICE * (PetscSqrtReal(squares[SQUARES_LOADS]) + PetscSqrtReal(squares[SQUARES_REACTIONS]) +
                 PetscSqrtReal(squares[SQUARES_CONTACT]));
  }
  model->reference_force = PetscSqrtReal(sum[SQUARES_LOADS]) + PetscSqrtReal(sum[SQUARES_REACTIONS]) +
                           PetscSqrtReal(sum[SQUARES_CONTACT]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do the forces on every part balance? `relative`: to rtol, so that neither noise nor atol was asked. A part that flies
 * off has any rounding that it likes, and nothing that balances its load: then no noise is allowed. One whose loads are
 * below the rounding of its own stiffness has no answer: model->newton.drowned. */
void parts_judge(Model *model, PetscReal rtol, PetscReal atol, PetscBool *balance, PetscBool *relative)
{
  const PetscBool flies = (PetscBool)(model->closing.active && model->closing.loose >= 0);
  *balance = *relative  = PETSC_TRUE;
  model->newton.drowned = -1;
  for (PetscInt p = 0; p < model->n_parts; p++) {
    const Part *part = &model->parts[p];
    if (part->residual <= rtol * PetscMax(part->faint, PetscMax(part->reference, part->felt))) continue;
    *relative = PETSC_FALSE;
    if (!(part->residual <= PetscMax(atol, flies ? 0 : part->noise))) {
      *balance = PETSC_FALSE;
    } else if (part->loads > 0 && part->residual > PetscMax(atol, DROWNED * PetscMax(part->reference, part->felt))) {
      *balance              = PETSC_FALSE;
      model->newton.drowned = p;
    }
  }
}

/* A step is accepted. */
void parts_accept(Model *model)
{
  for (PetscInt p = 0; p < model->n_parts; p++)
    model->parts[p].felt = PetscMax(model->parts[p].felt, model->parts[p].reference);
}
