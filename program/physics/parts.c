/* The model's parts, connected pieces of mesh that nothing but contact joins, and the forces on each. Whether they balance: balance.c. */
#include "physics/physics.h"

/* A first reference, over E times the square of the part's size: too small to matter. */
static const PetscReal FAINT = 1e-12;

/* The stiffest E of each part, and a first reference; how large it is, only the contact knows. */
static PetscErrorCode measure(Physics *physics)
{
  const Mesh *mesh  = physics->mesh;
  Parts      *parts = &physics->parts;
  PetscReal  *young;
  Extent     *own;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(parts->n, &own));
  PetscCall(PetscCalloc1(parts->n, &young));
  for (PetscInt p = 0; p < parts->n; p++)
    own[p] = extent_of_nothing();
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    extent_add(&own[parts->of_piece[v]], mesh->coordinates + 3 * v);
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt p = parts->of_piece[mesh->cell_vertices[mesh->cell_offsets[c]]];
    young[p]         = PetscMax(young[p], physics->materials[mesh->cell_body[c]].young);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, young, (PetscMPIInt)parts->n, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  for (PetscInt p = 0; p < parts->n; p++) {
    PetscCall(extent_of_all(&own[p]));
    parts->part[p].young = young[p];
    parts->part[p].size  = PetscSqrtReal(extent_diagonal_squared(&own[p]));
    parts->part[p].faint = FAINT * young[p] * extent_diagonal_squared(&own[p]);
  }
  PetscCall(PetscFree(own));
  PetscCall(PetscFree(young));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The least number of all vertices that cells connect with each vertex of the piece: within the piece at once, from piece to
 * piece as often as it changes anywhere. */
static PetscErrorCode connect(const Mesh *mesh, PetscInt least[])
{
  PetscInt *tree;
  PetscBool changed = PETSC_TRUE;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->n_vertices, &tree));
  for (PetscInt v = 0; v < mesh->n_vertices; v++) {
    tree[v]  = v;
    least[v] = mesh->numbers[v];
  }
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    for (PetscInt k = mesh->cell_offsets[c] + 1; k < mesh->cell_offsets[c + 1]; k++)
      trees_join(tree, mesh->cell_vertices[k - 1], mesh->cell_vertices[k]);
  }
  (void)trees_number(mesh->n_vertices, tree);
  while (changed) {
    PetscInt *of_tree;
    changed = PETSC_FALSE;
    PetscCall(PetscMalloc1(mesh->n_vertices, &of_tree)); /* trees are not more than vertices */
    for (PetscInt v = 0; v < mesh->n_vertices; v++)
      of_tree[v] = PETSC_MAX_INT;
    for (PetscInt v = 0; v < mesh->n_vertices; v++)
      of_tree[tree[v]] = PetscMin(of_tree[tree[v]], least[v]);
    for (PetscInt v = 0; v < mesh->n_vertices; v++) {
      changed  = (PetscBool)(changed || least[v] != of_tree[tree[v]]);
      least[v] = of_tree[tree[v]];
    }
    PetscCall(PetscFree(of_tree));
    PetscCall(pieces_unite(mesh, least, MPI_MIN));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  }
  PetscCall(PetscFree(tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Distinct numbers of all ranks, sorted. */
static PetscErrorCode merge(const Mesh *mesh, PetscInt n, const PetscInt mine[], PetscInt *n_all, PetscInt **all)
{
  PetscMPIInt n_mine = (PetscMPIInt)n, *counts, *starts;
  PetscFunctionBegin;
  PetscCall(PetscMalloc2(mesh->size, &counts, mesh->size + 1, &starts));
  PetscCallMPI(MPI_Allgather(&n_mine, 1, MPI_INT, counts, 1, MPI_INT, PETSC_COMM_WORLD));
  starts[0] = 0;
  for (PetscMPIInt r = 0; r < mesh->size; r++)
    starts[r + 1] = starts[r] + counts[r];
  *n_all = starts[mesh->size];
  PetscCall(PetscMalloc1(*n_all, all));
  PetscCallMPI(MPI_Allgatherv(mine, n_mine, MPIU_INT, *all, counts, starts, MPIU_INT, PETSC_COMM_WORLD));
  PetscCall(PetscSortRemoveDupsInt(n_all, *all));
  PetscCall(PetscFree2(counts, starts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before the mesh is distributed: which part each vertex belongs to. Parts are numbered by their first vertices. */
PetscErrorCode parts_label(Physics *physics)
{
  Parts      *parts = &physics->parts;
  const Mesh *mesh  = physics->mesh;
  PetscInt   *part, *firsts, *all, n_firsts = mesh->n_vertices;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->n_vertices, &part));
  PetscCall(connect(mesh, part));
  PetscCall(PetscMalloc1(mesh->n_vertices, &firsts));
  PetscCall(PetscArraycpy(firsts, part, mesh->n_vertices));
  PetscCall(PetscSortRemoveDupsInt(&n_firsts, firsts));
  PetscCall(merge(mesh, n_firsts, firsts, &parts->n, &all));
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    PetscCall(PetscFindInt(part[v], parts->n, all, &part[v]));
  parts->of_piece = part;
  PetscCall(PetscCalloc2(parts->n, &parts->part, N_SQUARES * parts->n, &parts->squares));
  for (PetscInt p = 0; p < parts->n; p++)
    parts->part[p].first = all[p];
  PetscCall(PetscFree(firsts));
  PetscCall(PetscFree(all));
  PetscCall(measure(physics));
  PetscCall(plex_label_vertices(mesh, "part", mesh->n_vertices, NULL, part, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* After it: the part of each vertex here. */
PetscErrorCode parts_create(Physics *physics)
{
  const Mesh *mesh  = physics->mesh;
  Parts      *parts = &physics->parts;
  DMLabel     label;
  PetscFunctionBegin;
  PetscCall(PetscFree(parts->of_piece));
  PetscCall(DMGetLabel(mesh->dm, "part", &label));
  PetscCall(PetscMalloc1(mesh->n_points, &parts->of_vertex));
  for (PetscInt k = 0; k < mesh->n_points; k++)
    PetscCall(DMLabelGetValue(label, mesh->points[k], &parts->of_vertex[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the squares of a local vector's displacement entries to each part's: those of prescribed ones to `prescribed`, of
 * the others to `free`; -1: not wanted. */
PetscErrorCode parts_add_squares(Physics *physics, Vec local, int prescribed, int free)
{
  const Mesh        *mesh     = physics->mesh;
  Parts             *parts    = &physics->parts;
  Unknowns          *unknowns = &physics->unknowns;
  const PetscScalar *f;
  PetscFunctionBegin;
  PetscCall(unknowns_sum(physics, local));
  PetscCall(VecGetArrayRead(physics->f_sum, &f));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscReal *squares = parts->squares + N_SQUARES * parts->of_vertex[k];
    PetscInt   at;
    if (unknowns->ghost[k]) continue;
    PetscCall(PetscSectionGetOffset(unknowns->section, mesh->points[k], &at));
    for (int i = 0; i < 3; i++) {
      const int kind = entry_held(physics, at + i) ? prescribed : free;
      if (kind >= 0) squares[kind] += PetscSqr(PetscAbsScalar(f[at + i]));
    }
  }
  PetscCall(VecRestoreArrayRead(physics->f_sum, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "block", or "block (piece 2 of 3)" where a body is in pieces: parts are numbered as they are met */
PetscErrorCode parts_name(const Physics *physics, PetscInt part, char name[], size_t length)
{
  const Parts   *parts = &physics->parts;
  const PetscInt body  = mesh_body_of(physics->mesh, parts->part[part].first);
  PetscInt       piece = 0, pieces = 0;
  PetscFunctionBegin;
  for (PetscInt p = 0; p < parts->n; p++) {
    if (mesh_body_of(physics->mesh, parts->part[p].first) != body) continue;
    pieces++;
    if (p == part) piece = pieces;
  }
  if (pieces > 1)
    PetscCall(PetscSNPrintf(name, length, "%s (piece %d of %d)", physics->mesh->bodies[body].name, (int)piece, (int)pieces));
  else
    PetscCall(PetscSNPrintf(name, length, "%s", physics->mesh->bodies[body].name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step is accepted. */
void parts_accept(Physics *physics)
{
  Parts *parts = &physics->parts;
  for (PetscInt p = 0; p < parts->n; p++)
    parts->part[p].felt = PetscMax(parts->part[p].felt, parts->part[p].reference);
}
