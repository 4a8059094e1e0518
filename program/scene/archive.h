/* What a restart file keeps: items one after the other, each with its name and size, on rank 0. The same calls write and read them, so that
 * the two cannot differ. All ranks make them together. */
#ifndef STICKSLIP_PROGRAM_ARCHIVE_H
#define STICKSLIP_PROGRAM_ARCHIVE_H
#include <petscsys.h>
#include <stdint.h>

typedef struct {
  PetscBool   reading, bad;  /* bad, on every rank: an item could not be read, and from then on none is */
  PetscMPIInt rank, n_ranks; /* this one; how many have written the file */
  size_t      n, capacity, at; /* bytes; room for; where the next item is read */
  char       *bytes;
  char        fault[256]; /* on the rank that has found it: what is bad */
} Archive;

/* archive.c: an item of so many bytes, numbers, truth values, the same on all ranks. Where it does not fit, `data` stays. */
PetscErrorCode archive_bytes(Archive *archive, const char *name, size_t n, void *data);
PetscErrorCode archive_reals(Archive *archive, const char *name, PetscInt n, PetscReal *data);
PetscErrorCode archive_ints(Archive *archive, const char *name, PetscInt n, PetscInt *data);
PetscErrorCode archive_bools(Archive *archive, const char *name, PetscInt n, PetscBool *data);
/* one that rank 0 alone has; others give n = 0 */
PetscErrorCode archive_root(Archive *archive, const char *name, size_t n, void *data);
/* of rank 0, too: a text, NULL: none; allocated when it is read, where the one before is freed */
PetscErrorCode archive_text(Archive *archive, const char *name, char **text);
/* a number that must be the same when it is read, else this is the fault */
PetscErrorCode archive_agree(Archive *archive, const char *name, uint64_t number, const char *fault);
/* a fault that this rank has found (NULL: none): all ranks know that there is one, `fault` has that of the first */
PetscErrorCode archive_fault(Archive *archive, const char *fault);
PetscErrorCode archive_destroy(Archive *archive);

/* Any byte that is changed changes it; begins with DIGEST. */
#define DIGEST UINT64_C(14695981039346656037)
uint64_t digest(uint64_t before, size_t n, const void *data);

/* archive_file.c: what a file says before the archive */
typedef struct {
  char     form[24];
  uint32_t order, int_bytes;
  int64_t  n_ranks, step;
  uint64_t n_text, text_digest, n, digest, header_digest;
  double   t;
} ArchiveHeader;

/* `text`, on rank 0, stands beside the header. Writing: to a file beside it, which then takes its place. Reading: the text must be freed.
 * Faults are the archive's. */
PetscErrorCode archive_write(Archive *archive, const char *path, PetscInt step, PetscReal t, const char *text);
PetscErrorCode archive_read(Archive *archive, const char *path, ArchiveHeader *header, char **text);
#endif
