/* Items of an archive: name, size, bytes. */
#include "scene/archive.h"
#include "scene/petsc_compat.h"
#include <string.h>

typedef struct {
  uint64_t name, size;
} ItemHead;

/* FNV-1a */
uint64_t digest(uint64_t before, size_t n, const void *data)
{
  const unsigned char *bytes = data;
  for (size_t k = 0; k < n; k++)
    before = (before ^ bytes[k]) * UINT64_C(1099511628211);
  return before;
}

PetscErrorCode archive_fault(Archive *archive, const char *fault)
{
  PetscMPIInt size, first;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (fault && !archive->bad) PetscCall(PetscSNPrintf(archive->fault, sizeof(archive->fault), "%s", fault));
  first = fault ? archive->rank : size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  if (first == size || archive->bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Bcast(archive->fault, sizeof(archive->fault), MPI_CHAR, first, PETSC_COMM_WORLD));
  archive->bad = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode append(Archive *archive, size_t n, const void *data)
{
  PetscFunctionBegin;
  if (archive->n + n > archive->capacity) {
    archive->capacity = archive->n + n + archive->capacity / 2;
    PetscCall(PetscRealloc(archive->capacity, &archive->bytes));
  }
  if (n) memcpy(archive->bytes + archive->n, data, n);
  archive->n += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The size of the item that is next, which must be of this name. */
static PetscErrorCode next_item(Archive *archive, const char *name, size_t *size)
{
  ItemHead    head;
  char        text[256];
  const char *fault = NULL;
  PetscFunctionBegin;
  *size = 0;
  if (archive->rank == 0 && !archive->bad) {
    PetscCall(PetscSNPrintf(text, sizeof(text), "it does not have '%s' where it belongs", name));
    fault = text;
    if (archive->at + sizeof(head) <= archive->n) {
      memcpy(&head, archive->bytes + archive->at, sizeof(head));
      *size = (size_t)head.size;
      if (head.name == digest(DIGEST, strlen(name), name) && head.size <= archive->n - archive->at - sizeof(head)) fault = NULL;
    }
  }
  PetscCall(archive_fault(archive, fault));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode archive_root(Archive *archive, const char *name, size_t n, void *data)
{
  const ItemHead head = {.name = digest(DIGEST, strlen(name), name), .size = n};
  size_t         size;
  char           text[256];
  const char    *fault = NULL;
  PetscFunctionBegin;
  if (!archive->reading) {
    if (archive->rank) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(append(archive, sizeof(head), &head));
    PetscCall(append(archive, n, data));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(next_item(archive, name, &size));
  if (archive->bad) PetscFunctionReturn(PETSC_SUCCESS);
  if (archive->rank == 0 && size != n) {
    PetscCall(PetscSNPrintf(text, sizeof(text), "its '%s' has %zu bytes where %zu are needed", name, size, n));
    fault = text;
  }
  PetscCall(archive_fault(archive, fault));
  if (archive->bad || archive->rank) PetscFunctionReturn(PETSC_SUCCESS);
  archive->at += sizeof(head);
  if (n) memcpy(data, archive->bytes + archive->at, n);
  archive->at += n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode archive_bytes(Archive *archive, const char *name, size_t n, void *data)
{
  PetscFunctionBegin;
  PetscCall(archive_root(archive, name, n, data));
  if (archive->reading && !archive->bad) PetscCallMPI(MPI_Bcast(data, (PetscMPIInt)n, MPI_BYTE, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode archive_reals(Archive *archive, const char *name, PetscInt n, PetscReal *data)
{
  return archive_bytes(archive, name, (size_t)n * sizeof(*data), data);
}

PetscErrorCode archive_ints(Archive *archive, const char *name, PetscInt n, PetscInt *data)
{
  return archive_bytes(archive, name, (size_t)n * sizeof(*data), data);
}

PetscErrorCode archive_bools(Archive *archive, const char *name, PetscInt n, PetscBool *data)
{
  return archive_bytes(archive, name, (size_t)n * sizeof(*data), data);
}

PetscErrorCode archive_text(Archive *archive, const char *name, char **text)
{
  size_t size = *text ? strlen(*text) + 1 : 0;
  PetscFunctionBegin;
  if (archive->reading) {
    PetscCall(next_item(archive, name, &size));
    if (archive->bad) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(PetscFree(*text));
    if (size) PetscCall(PetscMalloc1(size, text));
  }
  PetscCall(archive_root(archive, name, size, *text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode archive_agree(Archive *archive, const char *name, uint64_t number, const char *fault)
{
  uint64_t there = number;
  PetscFunctionBegin;
  PetscCall(archive_bytes(archive, name, sizeof(there), &there));
  PetscCall(archive_fault(archive, there == number ? NULL : fault));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode archive_destroy(Archive *archive)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(archive->bytes));
  *archive = (Archive){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
