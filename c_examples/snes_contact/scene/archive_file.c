/* The archives of all ranks in one file, which rank 0 writes and reads: a header, its text, and of each rank size, digest and bytes. */
#include "scene/archive.h"
#include "scene/petsc_compat.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char     ARCHIVE_FORM[24] = "stickslip restart 1";
static const uint32_t ORDER            = 0x01020304; /* other bytes on a machine that turns them round */

typedef struct {
  uint64_t n, digest;
} Chunk;

/* MPI counts in int. */
enum { MOST_AT_ONCE = 1 << 30 };

static PetscErrorCode transfer(PetscMPIInt from, PetscMPIInt to, size_t n, char *bytes)
{
  PetscMPIInt rank;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  for (size_t at = 0; at < n && from != to; at += MOST_AT_ONCE) {
    const int count = (int)(n - at < MOST_AT_ONCE ? n - at : MOST_AT_ONCE);
    if (rank == from) PetscCallMPI(MPI_Send(bytes + at, count, MPI_BYTE, to, 0, PETSC_COMM_WORLD));
    if (rank == to) PetscCallMPI(MPI_Recv(bytes + at, count, MPI_BYTE, from, 0, PETSC_COMM_WORLD, MPI_STATUS_IGNORE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* what each rank has, on rank 0 */
static PetscErrorCode gather(Chunk chunk, Chunk **all, PetscMPIInt *rank, PetscMPIInt *size)
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, size));
  PetscCall(PetscMalloc1(*size, all));
  PetscCallMPI(MPI_Gather(&chunk, sizeof(chunk), MPI_BYTE, *all, sizeof(chunk), MPI_BYTE, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool put(FILE *file, size_t n, const void *bytes)
{
  return (PetscBool)(file && fwrite(bytes, 1, n, file) == n);
}

static PetscBool get(FILE *file, size_t n, void *bytes)
{
  return (PetscBool)(file && fread(bytes, 1, n, file) == n);
}

static uint64_t header_digest(ArchiveHeader header)
{
  header.header_digest = 0;
  return digest(DIGEST, sizeof(header), &header);
}

PetscErrorCode archive_write(const Archive *archive, const char *path, PetscInt step, PetscReal t, const char *text, char fault[],
                             size_t length)
{
  const Chunk   mine = {.n = archive->n, .digest = digest(DIGEST, archive->n, archive->bytes)};
  char          temporary[PETSC_MAX_PATH_LEN + 8];
  ArchiveHeader header;
  PetscMPIInt   rank, size;
  PetscBool     good;
  FILE         *file = NULL;
  Chunk        *all;

  PetscFunctionBegin;
  fault[0] = 0;
  PetscCall(gather(mine, &all, &rank, &size));
  PetscCall(PetscSNPrintf(temporary, sizeof(temporary), "%s.part", path));
  if (rank) {
    PetscCall(transfer(rank, 0, archive->n, archive->bytes));
    PetscCall(PetscFree(all));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  memset(&header, 0, sizeof(header)); /* what lies between its members is written, too */
  memcpy(header.form, ARCHIVE_FORM, sizeof(header.form));
  header.order         = ORDER;
  header.int_bytes     = sizeof(PetscInt);
  header.n_ranks       = size;
  header.step          = step;
  header.t             = t;
  header.n_text        = (int64_t)strlen(text);
  header.text_digest   = digest(DIGEST, strlen(text), text);
  header.header_digest = header_digest(header);
  errno                = 0;
  file                 = fopen(temporary, "wb");
  good                 = (PetscBool)(put(file, sizeof(header), &header) && put(file, strlen(text), text));
  for (PetscMPIInt r = 0; r < size; r++) {
    char *bytes = archive->bytes;
    if (r) {
      PetscCall(PetscMalloc1(all[r].n, &bytes));
      PetscCall(transfer(r, 0, all[r].n, bytes));
    }
    good = (PetscBool)(good && put(file, sizeof(Chunk), &all[r]) && put(file, all[r].n, bytes));
    if (r) PetscCall(PetscFree(bytes));
  }
  good = (PetscBool)(good && !fflush(file) && !fsync(fileno(file)));
  if (file) good = (PetscBool)(!fclose(file) && good);
  good = (PetscBool)(good && !rename(temporary, path));
  if (!good) {
    PetscCall(PetscSNPrintf(fault, length, "%s", errno ? strerror(errno) : "it cannot be written"));
    if (file) (void)remove(temporary);
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: header and text */
static PetscErrorCode read_header(FILE *file, PetscMPIInt size, ArchiveHeader *header, char **text, char fault[], size_t length)
{
  PetscFunctionBegin;
  if (!file) {
    PetscCall(PetscSNPrintf(fault, length, "it cannot be opened: %s", strerror(errno)));
  } else if (!get(file, sizeof(*header), header) || strncmp(header->form, ARCHIVE_FORM, sizeof(header->form))) {
    PetscCall(PetscSNPrintf(fault, length, "it is no restart file that this program writes"));
  } else if (header->order != ORDER || header->int_bytes != sizeof(PetscInt)) {
    PetscCall(PetscSNPrintf(fault, length, "a program or a machine with other numbers has written it"));
  } else if (header->header_digest != header_digest(*header)) {
    PetscCall(PetscSNPrintf(fault, length, "it is damaged"));
  } else if (header->n_ranks != size) {
    PetscCall(PetscSNPrintf(fault, length, "%d ranks have written it, and there are %d: run it on as many", (int)header->n_ranks,
                            (int)size));
  } else {
    PetscCall(PetscCalloc1(header->n_text + 1, text));
    if (!get(file, (size_t)header->n_text, *text))
      PetscCall(PetscSNPrintf(fault, length, "it ends too early"));
    else if (digest(DIGEST, (size_t)header->n_text, *text) != header->text_digest)
      PetscCall(PetscSNPrintf(fault, length, "it is damaged"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0: how much is left */
static PetscErrorCode bytes_left(FILE *file, uint64_t *left)
{
  long here, end;
  PetscFunctionBegin;
  here = ftell(file);
  (void)fseek(file, 0, SEEK_END);
  end = ftell(file);
  (void)fseek(file, here, SEEK_SET);
  *left = end > here ? (uint64_t)(end - here) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rank 0 reads each rank's chunk, and keeps its own or sends it */
static PetscErrorCode deal_out(FILE *file, PetscMPIInt size, Archive *archive, char fault[], size_t length)
{
  PetscFunctionBegin;
  for (PetscMPIInt r = 0; r < size; r++) {
    Chunk    chunk = {0};
    uint64_t left  = 0;
    char    *bytes = NULL;
    if (!fault[0]) {
      const PetscBool there = get(file, sizeof(chunk), &chunk);
      if (there) PetscCall(bytes_left(file, &left));
      if (!there || chunk.n > left) {
        PetscCall(PetscSNPrintf(fault, length, "it ends too early"));
        chunk.n = 0;
      }
      PetscCall(PetscMalloc1(chunk.n, &bytes));
      if (!fault[0] && (!get(file, chunk.n, bytes) || digest(DIGEST, chunk.n, bytes) != chunk.digest))
        PetscCall(PetscSNPrintf(fault, length, "it is damaged"));
    }
    if (r) {
      PetscCallMPI(MPI_Send(&chunk.n, 1, MPI_UINT64_T, r, 0, PETSC_COMM_WORLD));
      PetscCall(transfer(0, r, chunk.n, bytes));
      PetscCall(PetscFree(bytes));
    } else {
      archive->n     = chunk.n;
      archive->bytes = bytes;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode archive_read(const char *path, Archive *archive, ArchiveHeader *header, char **text, char fault[], size_t length)
{
  PetscMPIInt rank, size;
  uint64_t    n, left;
  FILE       *file = NULL;

  PetscFunctionBegin;
  fault[0] = 0;
  *text    = NULL;
  *archive = (Archive){.reading = PETSC_TRUE};
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (rank == 0) {
    file = fopen(path, "rb");
    PetscCall(read_header(file, size, header, text, fault, length));
    PetscCall(deal_out(file, size, archive, fault, length));
    if (!fault[0]) {
      PetscCall(bytes_left(file, &left));
      if (left) PetscCall(PetscSNPrintf(fault, length, "something follows its end"));
    }
    if (file) fclose(file);
  } else {
    PetscCallMPI(MPI_Recv(&n, 1, MPI_UINT64_T, 0, 0, PETSC_COMM_WORLD, MPI_STATUS_IGNORE));
    archive->n = (size_t)n;
    PetscCall(PetscMalloc1(archive->n, &archive->bytes));
    PetscCall(transfer(0, rank, archive->n, archive->bytes));
  }
  PetscCallMPI(MPI_Bcast(fault, (PetscMPIInt)length, MPI_CHAR, 0, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Bcast(header, sizeof(*header), MPI_BYTE, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
