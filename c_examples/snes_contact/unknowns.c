/* The PetscSection of displacements and multipliers, equation numbers, and the map that brings entries of all ranks to
 * rank 0. */
#include "model.h"

/* Fields of a vertex follow each other; `mask` bit i set: component i is prescribed (displacement) or removed (multiplier).
 * Returns -1 where the vertex has no such field. */
static PetscErrorCode field_mask(Model *model, PetscInt vertex, PetscInt field, PetscInt *mask)
{
  char label[2 * NAME_LENGTH] = "prescribed";
  PetscFunctionBegin;
  if (field) PetscCall(PetscSNPrintf(label, sizeof(label), "multiplier.%s", model->interfaces[field - 1].name));
  PetscCall(DMGetLabelValue(model->dm, label, vertex, mask));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt field_components(const Model *model, PetscInt field)
{
  return field ? model->interfaces[field - 1].components : 3;
}

static PetscErrorCode create_section(Model *model)
{
  const PetscInt n_fields = 1 + model->n_interfaces;
  PetscInt       pStart, pEnd, mask;
  PetscSection   section;

  PetscFunctionBegin;
  PetscCall(PetscSectionCreate(PETSC_COMM_WORLD, &section));
  PetscCall(PetscSectionSetNumFields(section, n_fields));
  PetscCall(PetscSectionSetFieldName(section, 0, "displacement"));
  for (PetscInt f = 0; f < n_fields; f++) {
    PetscCall(PetscSectionSetFieldComponents(section, f, field_components(model, f)));
    if (f) PetscCall(PetscSectionSetFieldName(section, f, model->interfaces[f - 1].name));
  }
  PetscCall(DMPlexGetChart(model->dm, &pStart, &pEnd));
  PetscCall(PetscSectionSetChart(section, pStart, pEnd));
  for (PetscInt v = model->vStart; v < model->vEnd; v++) {
    for (PetscInt f = 0; f < n_fields; f++) {
      const PetscInt components = field_components(model, f);
      PetscCall(field_mask(model, v, f, &mask));
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
  for (PetscInt v = model->vStart; v < model->vEnd; v++) {
    PetscInt *all, in_field[3], n_all = 0, first = 0;
    PetscCall(PetscMalloc1(3 * n_fields, &all));
    for (PetscInt f = 0; f < n_fields; f++) {
      const PetscInt components = field_components(model, f);
      PetscInt       n          = 0;
      PetscCall(field_mask(model, v, f, &mask));
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
  PetscCall(DMSetLocalSection(model->dm, section));
  model->section = section;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rank 0 learns for every mesh vertex which rank owns it, and where its fields lie in that rank's local vector. */
static PetscErrorCode collect_owners(Model *model)
{
  const PetscInt  n_fields = 1 + model->n_interfaces, width = 1 + n_fields;
  PetscInt        n_leaves, *mine, *all = NULL, mask;
  const PetscInt *leaves;
  PetscMPIInt     size, n_mine = 0, *counts = NULL, *starts = NULL;
  PetscSF         sf;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(PetscCalloc1(model->vEnd - model->vStart, &model->ghost));
  PetscCall(DMGetPointSF(model->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, NULL, &n_leaves, &leaves, NULL));
  for (PetscInt k = 0; k < n_leaves; k++) {
    const PetscInt p = leaves ? leaves[k] : k;
    if (p >= model->vStart && p < model->vEnd) model->ghost[p - model->vStart] = PETSC_TRUE;
  }
  PetscCall(PetscMalloc1(width * (model->vEnd - model->vStart), &mine));
  for (PetscInt v = model->vStart; v < model->vEnd; v++) {
    PetscInt offset;
    if (model->ghost[v - model->vStart]) continue;
    PetscCall(PetscSectionGetOffset(model->section, v, &offset));
    mine[n_mine++] = model->original[v - model->vStart];
    for (PetscInt f = 0; f < n_fields; f++) {
      PetscCall(field_mask(model, v, f, &mask));
      mine[n_mine++] = mask < 0 ? -1 : offset;
      if (mask >= 0) offset += field_components(model, f);
    }
  }
  if (model->rank == 0) PetscCall(PetscMalloc2(size, &counts, size + 1, &starts));
  PetscCallMPI(MPI_Gather(&n_mine, 1, MPI_INT, counts, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  if (model->rank == 0) {
    starts[0] = 0;
    for (PetscMPIInt r = 0; r < size; r++)
      starts[r + 1] = starts[r] + counts[r];
    PetscCall(PetscMalloc1(starts[size], &all));
    PetscCall(PetscMalloc1(width * model->mesh.n_vertices, &model->owner));
  }
  PetscCallMPI(MPI_Gatherv(mine, n_mine, MPIU_INT, all, counts, starts, MPIU_INT, 0, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0; r < size && model->rank == 0; r++) {
    for (PetscInt k = starts[r]; k < starts[r + 1]; k += width) {
      PetscInt *entry = model->owner + width * all[k];
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
    PetscCall(PetscSFCreateRemoteOffsets(sf, model->section, model->section, &remote));
    PetscCall(PetscSFCreateSectionSF(sf, model->section, remote, model->section, &model->ghosts));
    PetscCall(PetscFree(remote));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves on rank 0: the entries of fields[b] of every vertex in vertices[b], block after block. */
PetscErrorCode unknowns_gather_create(Model *model, PetscInt n, const PetscInt *n_vertices,
                                      const PetscInt *const *vertices, const PetscInt *fields, PetscSF *sf)
{
  const PetscInt width    = 2 + model->n_interfaces;
  PetscInt       n_leaves = 0;
  PetscSFNode   *remote;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < n && model->rank == 0; b++)
    n_leaves += field_components(model, fields[b]) * n_vertices[b];
  PetscCall(PetscMalloc1(n_leaves, &remote));
  for (PetscInt b = 0, leaf = 0; b < n && model->rank == 0; b++) {
    for (PetscInt k = 0; k < n_vertices[b]; k++) {
      const PetscInt *entry = model->owner + width * (vertices[b] ? vertices[b][k] : k);
      for (int i = 0; i < field_components(model, fields[b]); i++, leaf++) {
        remote[leaf].rank  = entry[0];
        remote[leaf].index = entry[1 + fields[b]] + i;
      }
    }
  }
  PetscCall(PetscSFCreate(PETSC_COMM_WORLD, sf));
  PetscCall(PetscSFSetGraph(*sf, model->n_local, n_leaves, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode unknowns_create(Model *model)
{
  const PetscInt         displacement = 0, *every_vertex = NULL;
  ISLocalToGlobalMapping mapping;

  PetscFunctionBegin;
  PetscCall(create_section(model));
  PetscCall(PetscSectionGetStorageSize(model->section, &model->n_local));
  PetscCall(DMGetLocalToGlobalMapping(model->dm, &mapping));
  PetscCall(ISLocalToGlobalMappingGetIndices(mapping, &model->equations)); /* negative: prescribed */
  PetscCall(collect_owners(model));
  PetscCall(unknowns_gather_create(model, 1, &model->mesh.n_vertices, &every_vertex, &displacement,
                                   &model->all_displacements));
  PetscCall(DMCreateLocalVector(model->dm, &model->u_local));
  PetscCall(VecDuplicate(model->u_local, &model->f_local));
  PetscCall(VecDuplicate(model->u_local, &model->f_external));
  PetscCall(VecDuplicate(model->u_local, &model->f_sum));
  PetscCall(VecDuplicate(model->u_local, &model->prescribed_local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode unknowns_to_local(Model *model, Vec x)
{
  PetscFunctionBegin;
  PetscCall(VecCopy(model->prescribed_local, model->u_local));
  PetscCall(DMGlobalToLocalBegin(model->dm, x, INSERT_VALUES, model->u_local)); /* touches the equations only */
  PetscCall(DMGlobalToLocalEnd(model->dm, x, INSERT_VALUES, model->u_local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode unknowns_sum(Model *model, Vec local)
{
  const PetscScalar *mine;
  PetscScalar       *sum;
  PetscFunctionBegin;
  PetscCall(VecCopy(local, model->f_sum));
  if (!model->ghosts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(local, &mine));
  PetscCall(VecGetArray(model->f_sum, &sum));
  PetscCall(PetscSFReduceBegin(model->ghosts, MPIU_SCALAR, mine, sum, MPIU_SUM));
  PetscCall(PetscSFReduceEnd(model->ghosts, MPIU_SCALAR, mine, sum, MPIU_SUM));
  PetscCall(VecRestoreArray(model->f_sum, &sum));
  PetscCall(VecRestoreArrayRead(local, &mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}
