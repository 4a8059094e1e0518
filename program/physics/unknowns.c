/* The PetscSection of displacements and multipliers, equation numbers, and maps that bring entries of all ranks to the
 * ranks that ask for them. */
#include "physics/physics.h"

/* Fields of a vertex, which is a point of the DMPlex, follow each other; `mask` bit i set: component i is prescribed
 * (displacement) or removed (multiplier), -1: the vertex has no such field. `copies`: how many follow each other, all with this mask. */
static PetscErrorCode field_mask(Physics *physics, PetscInt point, PetscInt field, PetscInt *mask, PetscInt *copies)
{
  Unknowns   *unknowns = &physics->unknowns;
  const Mesh *mesh     = physics->mesh;
  const char *label    = field ? unknowns->fields[field - 1].label : "prescribed";
  PetscFunctionBegin;
  PetscCall(DMGetLabelValue(mesh->dm, label, point, mask));
  *copies = 1;
  if (field == 0 || *mask < 0) PetscFunctionReturn(PETSC_SUCCESS);
  *copies = 1 + *mask / FIELD_COPY;
  *mask %= FIELD_COPY;
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
  PetscInt       pStart, pEnd, mask, copies;
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
      PetscCall(field_mask(physics, v, f, &mask, &copies));
      if (mask < 0) continue;
      PetscCall(PetscSectionAddDof(section, v, copies * components));
      PetscCall(PetscSectionAddFieldDof(section, v, f, copies * components));
      for (PetscInt i = 0; i < copies * components; i++) {
        if (!(mask & (1 << i % components))) continue;
        PetscCall(PetscSectionAddConstraintDof(section, v, 1));
        PetscCall(PetscSectionAddFieldConstraintDof(section, v, f, 1));
      }
    }
  }
  PetscCall(PetscSectionSetUp(section));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt v = mesh->points[k];
    PetscInt      *all, *in_field, n_all = 0, first = 0, n_dofs;
    PetscCall(PetscSectionGetDof(section, v, &n_dofs));
    PetscCall(PetscMalloc2(n_dofs, &all, n_dofs, &in_field));
    for (PetscInt f = 0; f < n_fields; f++) {
      const PetscInt components = field_components(physics, f);
      PetscInt       n          = 0;
      PetscCall(field_mask(physics, v, f, &mask, &copies));
      if (mask < 0) continue;
      for (PetscInt i = 0; i < copies * components; i++) {
        if (!(mask & (1 << i % components))) continue;
        in_field[n++] = i;
        all[n_all++]  = first + i;
      }
      if (n) PetscCall(PetscSectionSetFieldConstraintIndices(section, v, f, in_field));
      first += copies * components;
    }
    if (n_all) PetscCall(PetscSectionSetConstraintIndices(section, v, all));
    PetscCall(PetscFree2(all, in_field));
  }
  PetscCall(DMSetLocalSection(mesh->dm, section));
  unknowns->section = section;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of ranges of vertices one rank each learns which rank owns them, and where their fields lie in that rank's local vector. */
static PetscErrorCode register_owners(Physics *physics)
{
  Unknowns       *unknowns = &physics->unknowns;
  const Mesh     *mesh     = physics->mesh;
  const PetscInt  n_fields = 1 + unknowns->n_fields, width = 1 + n_fields;
  PetscInt        n_leaves, n_here, n_mine = 0, *mine, *numbers, mask, copies;
  const PetscInt *leaves;
  MPI_Datatype    entry;
  PetscSF         sf, directory;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(mesh->n_points, &unknowns->ghost));
  PetscCall(DMGetPointSF(mesh->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, NULL, &n_leaves, &leaves, NULL));
  for (PetscInt k = 0; k < n_leaves; k++) {
    const PetscInt p = leaves ? leaves[k] : k;
    if (mesh->here[p] >= 0) unknowns->ghost[mesh->here[p]] = PETSC_TRUE;
  }
  PetscCall(PetscMalloc2(width * mesh->n_points, &mine, mesh->n_points, &numbers));
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    const PetscInt v = mesh->points[k];
    PetscInt       offset, *e = mine + width * n_mine;
    if (unknowns->ghost[k]) continue;
    PetscCall(PetscSectionGetOffset(unknowns->section, v, &offset));
    numbers[n_mine++] = mesh->original[k];
    *e++              = mesh->rank;
    for (PetscInt f = 0; f < n_fields; f++) {
      PetscCall(field_mask(physics, v, f, &mask, &copies));
      *e++ = mask < 0 ? -1 : offset;
      if (mask >= 0) offset += copies * field_components(physics, f);
    }
  }
  PetscCall(directory_create(mesh, n_mine, numbers, &n_here, &directory));
  PetscCall(PetscMalloc1(width * n_here, &unknowns->owner));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)width, MPIU_INT, &entry));
  PetscCallMPI(MPI_Type_commit(&entry));
  PetscCall(PetscSFReduceBegin(directory, entry, mine, unknowns->owner, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(directory, entry, mine, unknowns->owner, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&entry));
  PetscCall(PetscSFDestroy(&directory));
  PetscCall(PetscFree2(mine, numbers));
  if (mesh->size > 1) {
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
  MPI_Datatype    entry;
  PetscInt        n_here;
  PetscSF         directory;

  PetscFunctionBegin;
  PetscCall(directory_create(physics->mesh, n, vertices, &n_here, &directory));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)(2 + unknowns->n_fields), MPIU_INT, &entry));
  PetscCallMPI(MPI_Type_commit(&entry));
  PetscCall(PetscSFBcastBegin(directory, entry, unknowns->owner, entries, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(directory, entry, unknowns->owner, entries, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&entry));
  PetscCall(PetscSFDestroy(&directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves on each rank that asks for any: the first components[b] entries of fields[b] of every vertex in vertices[b], block
 * after block. `copies`: which copy of the field each vertex of a block asks for; NULL: the first, of all blocks or of one. */
PetscErrorCode unknowns_gather_create(Physics *physics, PetscInt n, const PetscInt *n_vertices,
                                      const PetscInt *const *vertices, const PetscInt *const *copies, const PetscInt *fields,
                                      const PetscInt *components, PetscSF *sf)
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
      asked[k++] = vertices[b][v];
  }
  PetscCall(look_up(physics, n_asked, asked, entries));
  for (PetscInt b = 0, leaf = 0, k = 0; b < n; b++) {
    const PetscInt width_of_copy = field_components(physics, fields[b]);
    for (PetscInt v = 0; v < n_vertices[b]; v++, k++) {
      const PetscInt copy = copies && copies[b] ? copies[b][v] : 0;
      for (int i = 0; i < components[b]; i++, leaf++) {
        remote[leaf].rank  = entries[width * k];
        remote[leaf].index = entries[width * k + 1 + fields[b]] + copy * width_of_copy + i;
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
  Unknowns              *unknowns = &physics->unknowns;
  const Mesh            *mesh     = physics->mesh;
  ISLocalToGlobalMapping mapping;

  PetscFunctionBegin;
  unknowns->n_fields = n_fields;
  unknowns->fields   = fields;
  PetscCall(create_section(physics));
  PetscCall(PetscSectionGetStorageSize(unknowns->section, &unknowns->n_local));
  PetscCall(DMGetLocalToGlobalMapping(mesh->dm, &mapping));
  PetscCall(ISLocalToGlobalMappingGetIndices(mapping, &unknowns->equations)); /* negative: prescribed */
  PetscCall(register_owners(physics));
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

PetscErrorCode unknowns_to_ghosts(const Unknowns *unknowns, Vec local)
{
  const PetscScalar *from;
  PetscScalar       *to;
  Vec                owned;
  PetscFunctionBegin;
  if (!unknowns->ghosts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(local, &owned));
  PetscCall(VecCopy(local, owned));
  PetscCall(VecGetArrayRead(owned, &from));
  PetscCall(VecGetArray(local, &to));
  PetscCall(PetscSFBcastBegin(unknowns->ghosts, MPIU_SCALAR, from, to, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(unknowns->ghosts, MPIU_SCALAR, from, to, MPI_REPLACE));
  PetscCall(VecRestoreArray(local, &to));
  PetscCall(VecRestoreArrayRead(owned, &from));
  PetscCall(VecDestroy(&owned));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode unknowns_share(Physics *physics, Vec local)
{
  PetscFunctionBegin;
  PetscCall(unknowns_sum(physics, local));
  PetscCall(VecCopy(physics->f_sum, local));
  PetscCall(unknowns_to_ghosts(&physics->unknowns, local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode unknowns_displacement(const Physics *physics, PetscInt number, const PetscScalar *local, PetscReal u[3])
{
  const Unknowns *unknowns = &physics->unknowns;
  const Mesh     *mesh     = physics->mesh;
  PetscFunctionBegin;
  u[0] = u[1] = u[2] = 0;
  for (PetscInt k = 0; k < mesh->n_points; k++) {
    PetscInt at;
    if (unknowns->ghost[k] || mesh->original[k] != number) continue;
    PetscCall(PetscSectionGetOffset(unknowns->section, mesh->points[k], &at));
    for (int i = 0; i < 3; i++)
      u[i] = PetscRealPart(local[at + i]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, u, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode unknowns_place(const Physics *physics, PetscInt k, const PetscScalar *coordinates, PetscReal X[3], PetscInt *at)
{
  const Mesh  *mesh = physics->mesh;
  PetscSection section;
  PetscInt     offset;
  PetscFunctionBegin;
  PetscCall(DMGetCoordinateSection(mesh->dm, &section));
  PetscCall(PetscSectionGetOffset(section, mesh->points[k], &offset));
  PetscCall(PetscSectionGetOffset(physics->unknowns.section, mesh->points[k], at));
  for (int i = 0; i < 3; i++)
    X[i] = PetscRealPart(coordinates[offset + i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
