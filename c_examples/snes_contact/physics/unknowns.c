/* The PetscSection of displacements and multipliers, equation numbers, and maps that bring entries of all ranks to the
 * ranks that ask for them. */
#include "physics/physics.h"

/* Fields of a vertex, which is a point of the DMPlex, follow each other; `mask` bit i set: component i is prescribed
 * (displacement) or removed (multiplier). Returns -1 where the vertex has no such field. */
static PetscErrorCode field_mask(Physics *physics, PetscInt point, PetscInt field, PetscInt *mask)
{
  Unknowns   *unknowns = &physics->unknowns;
  const Mesh *mesh     = physics->mesh;
  const char *label    = field ? unknowns->fields[field - 1].label : "prescribed";
  PetscFunctionBegin;
  PetscCall(DMGetLabelValue(mesh->dm, label, point, mask));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt field_components(const Physics *physics, PetscInt field)
{
  const Unknowns *unknowns = &physics->unknowns;
  return field ? unknowns->fields[field - 1].components : 3;
}

static PetscErrorCode create_section(Physics *physics)
{
  Unknowns      *unknowns = &physics->unknowns;
  const Mesh    *mesh     = physics->mesh;
  const PetscInt n_fields = 1 + unknowns->n_fields;
  PetscInt       pStart, pEnd, mask;
  PetscSection   section;

  PetscFunctionBegin;
  PetscCall(PetscSectionCreate(PETSC_COMM_WORLD, &section));
  PetscCall(PetscSectionSetNumFields(section, n_fields));
  PetscCall(PetscSectionSetFieldName(section, 0, "displacement"));
  for (PetscInt f = 0; f < n_fields; f++) {
    PetscCall(PetscSectionSetFieldComponents(section, f, field_components(physics, f)));
    if (f) PetscCall(PetscSectionSetFieldName(section, f, unknowns->fields[f - 1].name));
  }
  PetscCall(DMPlexGetChart(mesh->dm, &pStart, &pEnd));
  PetscCall(PetscSectionSetChart(section, pStart, pEnd));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt v = mesh->points[k];
    for (PetscInt f = 0; f < n_fields; f++) {
      const PetscInt components = field_components(physics, f);
      PetscCall(field_mask(physics, v, f, &mask));
      if (mask < 0) continue;
      PetscCall(PetscSectionAddDof(section, v, components));
      PetscCall(PetscSectionAddFieldDof(section, v, f, components));
      for (int i = 0; i < components; i++) {
        if (!(mask & (1 << i))) continue;
        PetscCall(PetscSectionAddConstraintDof(section, v, 1));
        PetscCall(PetscSectionAddFieldConstraintDof(section, v, f, 1));
      }
    }
  }
  PetscCall(PetscSectionSetUp(section));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt v = mesh->points[k];
    PetscInt      *all, in_field[3], n_all = 0, first = 0;
    PetscCall(PetscMalloc1(3 * n_fields, &all));
    for (PetscInt f = 0; f < n_fields; f++) {
      const PetscInt components = field_components(physics, f);
      PetscInt       n          = 0;
      PetscCall(field_mask(physics, v, f, &mask));
      if (mask < 0) continue;
      for (int i = 0; i < components; i++) {
        if (!(mask & (1 << i))) continue;
        in_field[n++] = i;
        all[n_all++]  = first + i;
      }
      if (n) PetscCall(PetscSectionSetFieldConstraintIndices(section, v, f, in_field));
      first += components;
    }
    if (n_all) PetscCall(PetscSectionSetConstraintIndices(section, v, all));
    PetscCall(PetscFree(all));
  }
  PetscCall(DMSetLocalSection(mesh->dm, section));
  unknowns->section = section;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0 learns for every mesh vertex which rank owns it, and where its fields lie in that rank's local vector. */
static PetscErrorCode collect_owners(Physics *physics)
{
  Unknowns       *unknowns = &physics->unknowns;
  const Mesh     *mesh     = physics->mesh;
  const PetscInt  n_fields = 1 + unknowns->n_fields, width = 1 + n_fields;
  PetscInt        n_leaves, *mine, *all = NULL, mask;
  const PetscInt *leaves;
  PetscMPIInt     size, n_mine = 0, *counts = NULL, *starts = NULL;
  PetscSF         sf;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(PetscCalloc1(mesh->n_points, &unknowns->ghost));
  PetscCall(DMGetPointSF(mesh->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, NULL, &n_leaves, &leaves, NULL));
  for (PetscInt k = 0; k < n_leaves; k++) {
    const PetscInt p = leaves ? leaves[k] : k;
    if (mesh->here[p] >= 0) unknowns->ghost[mesh->here[p]] = PETSC_TRUE;
  }
  PetscCall(PetscMalloc1(width * mesh->n_points, &mine));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt v = mesh->points[k];
    PetscInt       offset;
    if (unknowns->ghost[k]) continue;
    PetscCall(PetscSectionGetOffset(unknowns->section, v, &offset));
    mine[n_mine++] = mesh->original[k];
    for (PetscInt f = 0; f < n_fields; f++) {
      PetscCall(field_mask(physics, v, f, &mask));
      mine[n_mine++] = mask < 0 ? -1 : offset;
      if (mask >= 0) offset += field_components(physics, f);
    }
  }
  if (mesh->rank == 0) PetscCall(PetscMalloc2(size, &counts, size + 1, &starts));
  PetscCallMPI(MPI_Gather(&n_mine, 1, MPI_INT, counts, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  if (mesh->rank == 0) {
    starts[0] = 0;
    for (PetscMPIInt r = 0; r < size; r++)
      starts[r + 1] = starts[r] + counts[r];
    PetscCall(PetscMalloc1(starts[size], &all));
    PetscCall(PetscMalloc1(width * mesh->n_vertices, &unknowns->owner));
  }
  PetscCallMPI(MPI_Gatherv(mine, n_mine, MPIU_INT, all, counts, starts, MPIU_INT, 0, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0; r < size && mesh->rank == 0; r++) {
    for (PetscInt k = starts[r]; k < starts[r + 1]; k += width) {
      PetscInt *entry = unknowns->owner + width * all[k];
      entry[0]        = r;
      for (PetscInt f = 0; f < n_fields; f++)
        entry[1 + f] = all[k + 1 + f];
    }
  }
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(mine));
  if (size > 1) {
    PetscInt *remote;
    PetscCall(PetscSFCreateRemoteOffsets(sf, unknowns->section, unknowns->section, &remote));
    PetscCall(PetscSFCreateSectionSF(sf, unknowns->section, remote, unknowns->section, &unknowns->ghosts));
    PetscCall(PetscFree(remote));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of vertices of the mesh: which rank owns each, and where its fields lie there. `entries`: 2 + n_fields a vertex. */
static PetscErrorCode look_up(const Physics *physics, PetscInt n, const PetscInt vertices[], PetscInt entries[])
{
  const Unknowns *unknowns = &physics->unknowns;
  const Mesh     *mesh     = physics->mesh;
  MPI_Datatype    entry;
  PetscSFNode    *remote;
  PetscSF         directory;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &remote));
  for (PetscInt k = 0; k < n; k++)
    remote[k] = (PetscSFNode){.rank = 0, .index = vertices[k]};
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, &directory));
  PetscCall(PetscSFSetGraph(directory, mesh->rank ? 0 : mesh->n_vertices, n, NULL, PETSC_OWN_POINTER, remote,
                            PETSC_OWN_POINTER));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)(2 + unknowns->n_fields), MPIU_INT, &entry));
  PetscCallMPI(MPI_Type_commit(&entry));
  PetscCall(PetscSFBcastBegin(directory, entry, unknowns->owner, entries, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(directory, entry, unknowns->owner, entries, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&entry));
  PetscCall(PetscSFDestroy(&directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves on each rank that asks for any: the first components[b] entries of fields[b] of every vertex in vertices[b], block
 * after block. */
PetscErrorCode unknowns_gather_create(Physics *physics, PetscInt n, const PetscInt *n_vertices,
                                      const PetscInt *const *vertices, const PetscInt *fields, const PetscInt *components,
                                      PetscSF *sf)
{
  Unknowns      *unknowns = &physics->unknowns;
  const PetscInt width    = 2 + unknowns->n_fields;
  PetscInt       n_leaves = 0, n_asked = 0, *asked, *entries;
  PetscSFNode   *remote;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < n; b++) {
    n_leaves += components[b] * n_vertices[b];
    n_asked += n_vertices[b];
  }
  PetscCall(PetscMalloc1(n_leaves, &remote));
  PetscCall(PetscMalloc2(n_asked, &asked, width * n_asked, &entries));
  for (PetscInt b = 0, k = 0; b < n; b++) {
    for (PetscInt v = 0; v < n_vertices[b]; v++)
      asked[k++] = vertices[b] ? vertices[b][v] : v;
  }
  PetscCall(look_up(physics, n_asked, asked, entries));
  for (PetscInt b = 0, leaf = 0, k = 0; b < n; b++) {
    for (PetscInt v = 0; v < n_vertices[b]; v++, k++) {
      for (int i = 0; i < components[b]; i++, leaf++) {
        remote[leaf].rank  = entries[width * k];
        remote[leaf].index = entries[width * k + 1 + fields[b]] + i;
      }
    }
  }
  PetscCall(PetscFree2(asked, entries));
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, sf));
  PetscCall(PetscSFSetGraph(*sf, unknowns->n_local, n_leaves, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode unknowns_create(Physics *physics, PetscInt n_fields, Field *fields)
{
  Unknowns              *unknowns     = &physics->unknowns;
  const Mesh            *mesh         = physics->mesh;
  const PetscInt         displacement = 0, three = 3, *every_vertex = NULL;
  ISLocalToGlobalMapping mapping;

  PetscFunctionBegin;
  unknowns->n_fields = n_fields;
  unknowns->fields   = fields;
  PetscCall(create_section(physics));
  PetscCall(PetscSectionGetStorageSize(unknowns->section, &unknowns->n_local));
  PetscCall(DMGetLocalToGlobalMapping(mesh->dm, &mapping));
  PetscCall(ISLocalToGlobalMappingGetIndices(mapping, &unknowns->equations)); /* negative: prescribed */
  PetscCall(collect_owners(physics));
  PetscCall(unknowns_gather_create(physics, 1, &mesh->n_vertices, &every_vertex, &displacement, &three,
                                   &unknowns->all_displacements));
  PetscCall(DMCreateLocalVector(mesh->dm, &physics->u_local));
  PetscCall(VecDuplicate(physics->u_local, &physics->f_local));
  PetscCall(VecDuplicate(physics->u_local, &physics->f_external));
  PetscCall(VecDuplicate(physics->u_local, &physics->f_sum));
  PetscCall(VecDuplicate(physics->u_local, &physics->prescribed_local));
  PetscCall(rigids_create(physics));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode unknowns_to_local(Physics *physics, Vec x)
{
  const Mesh *mesh = physics->mesh;
  PetscFunctionBegin;
  PetscCall(VecCopy(physics->prescribed_local, physics->u_local));
  PetscCall(DMGlobalToLocalBegin(mesh->dm, x, INSERT_VALUES, physics->u_local)); /* touches the equations only */
  PetscCall(DMGlobalToLocalEnd(mesh->dm, x, INSERT_VALUES, physics->u_local));
  PetscCall(rigids_place(physics, physics->u_local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode unknowns_sum(Physics *physics, Vec local)
{
  Unknowns          *unknowns = &physics->unknowns;
  const PetscScalar *mine;
  PetscScalar       *sum;
  PetscFunctionBegin;
  PetscCall(VecCopy(local, physics->f_sum));
  if (!unknowns->ghosts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(local, &mine));
  PetscCall(VecGetArray(physics->f_sum, &sum));
  PetscCall(PetscSFReduceBegin(unknowns->ghosts, MPIU_SCALAR, mine, sum, MPIU_SUM));
  PetscCall(PetscSFReduceEnd(unknowns->ghosts, MPIU_SCALAR, mine, sum, MPIU_SUM));
  PetscCall(VecRestoreArray(physics->f_sum, &sum));
  PetscCall(VecRestoreArrayRead(local, &mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}
