/* An archive in a file, which rank 0 writes and reads: header, text, archive, with digests of all three. */
#include "scene/archive.h"
#include "scene/petsc_compat.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char     FORM[24] = "stickslip restart 1";
static const uint32_t ORDER    = 0x01020304; /* other bytes on a machine that turns them round */

static PetscBool put(FILE *file, size_t n, const void *bytes)
{
  return (PetscBool)(file && fwrite(bytes, 1, n, file) == n);
}

static PetscBool get(FILE *file, size_t n, void *bytes)
{
  return (PetscBool)(file && fread(bytes, 1, n, file) == n);
}

static uint64_t digest_header(const ArchiveHeader *header)
{
  ArchiveHeader copy;
  memcpy(&copy, header, sizeof(copy)); /* with what lies between its members */
  copy.header_digest = 0;
  return digest(DIGEST, sizeof(copy), &copy);
}

PetscErrorCode archive_write(Archive *archive, const char *path, PetscInt step, PetscReal t, const char *text)
{
  const char   *fault = NULL;
  char          temporary[2 * PETSC_MAX_PATH_LEN + 8];
  PetscMPIInt   size;
  ArchiveHeader header;
  PetscBool     good;
  FILE         *file;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (archive->rank == 0) {
    memset(&header, 0, sizeof(header));
    memcpy(header.form, FORM, sizeof(header.form));
    header.order         = ORDER;
    header.int_bytes     = sizeof(PetscInt);
    header.n_ranks       = size;
    header.step          = step;
    header.t             = t;
    header.n_text        = strlen(text);
    header.text_digest   = digest(DIGEST, strlen(text), text);
    header.n             = archive->n;
    header.digest        = digest(DIGEST, archive->n, archive->bytes);
    header.header_digest = digest_header(&header);
    PetscCall(PetscSNPrintf(temporary, sizeof(temporary), "%s.part", path));
    errno = 0;
    file  = fopen(temporary, "wb");
    good  = (PetscBool)(put(file, sizeof(header), &header) && put(file, strlen(text), text) && put(file, archive->n, archive->bytes));
    good  = (PetscBool)(good && !fflush(file) && !fsync(fileno(file)));
    if (file) good = (PetscBool)(!fclose(file) && good);
    good = (PetscBool)(good && !rename(temporary, path));
    if (!good) fault = errno ? strerror(errno) : "it cannot be written";
    if (!good && file) (void)remove(temporary);
  }
  PetscCall(archive_fault(archive, fault));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* so many bytes of a file that has `left`, allocated, with a zero behind; returns what is wrong with them */
static const char *take(FILE *file, uint64_t n, uint64_t expected, uint64_t left, char **bytes)
{
  if (n > left) return "it ends too early";
  if (PetscMalloc1(n + 1, bytes)) return "there is no memory for it";
  if (!get(file, (size_t)n, *bytes)) return "it cannot be read";
  (*bytes)[n] = 0;
  return digest(DIGEST, (size_t)n, *bytes) == expected ? NULL : "it is damaged";
}

static const char *read_all(FILE *file, Archive *archive, ArchiveHeader *header, char **text)
{
  const char *fault;
  long        end;
  uint64_t    left;
  if (!file) return strerror(errno);
  if (!get(file, sizeof(*header), header) || memcmp(header->form, FORM, sizeof(header->form)))
    return "it is no restart file, or one of another version of this program";
  if (header->order != ORDER || header->int_bytes != sizeof(PetscInt)) return "a program or a machine with other numbers has written it";
  if (header->header_digest != digest_header(header)) return "it is damaged";
  if (fseek(file, 0, SEEK_END)) return strerror(errno);
  end = ftell(file);
  if (end < 0 || fseek(file, sizeof(*header), SEEK_SET)) return strerror(errno);
  left  = (uint64_t)end - sizeof(*header);
  fault = take(file, header->n_text, header->text_digest, left, text);
  if (fault) return fault;
  fault = take(file, header->n, header->digest, left - header->n_text, &archive->bytes);
  if (fault) return fault;
  archive->n = (size_t)header->n;
  return left == header->n_text + header->n ? NULL : "something follows its end";
}

PetscErrorCode archive_read(Archive *archive, const char *path, ArchiveHeader *header, char **text)
{
  const char *fault = NULL;
  FILE       *file;

  PetscFunctionBegin;
  *text    = NULL;
  *archive = (Archive){.reading = PETSC_TRUE};
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &archive->rank));
  if (archive->rank == 0) {
    file  = fopen(path, "rb");
    fault = read_all(file, archive, header, text);
    if (file) fclose(file);
  }
  PetscCall(archive_fault(archive, fault));
  PetscCallMPI(MPI_Bcast(header, sizeof(*header), MPI_BYTE, 0, PETSC_COMM_WORLD));
  archive->n_ranks = (PetscMPIInt)header->n_ranks;
  PetscFunctionReturn(PETSC_SUCCESS);
}
