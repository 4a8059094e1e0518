/* What a restart file keeps of one rank: items one after the other, each with its name and size. The same calls write and read them, so
 * that the two cannot differ. */
#ifndef SNES_CONTACT_ARCHIVE_H
#define SNES_CONTACT_ARCHIVE_H
#include <petscvec.h>
#include <stdint.h>

typedef struct {
  PetscBool reading;
  size_t    n, capacity, at; /* bytes; room for; where the next item is read */
  char     *bytes;
  char      fault[256]; /* why an item cannot be read: from then on nothing is */
} Archive;

/* archive.c: an item of so many bytes, numbers, truth values. Where it does not fit, `data` stays and archive->fault says why. */
PetscErrorCode archive_bytes(Archive *archive, const char *name, size_t n, void *data);
PetscErrorCode archive_reals(Archive *archive, const char *name, PetscInt n, PetscReal *data);
PetscErrorCode archive_ints(Archive *archive, const char *name, PetscInt n, PetscInt *data);
PetscErrorCode archive_bools(Archive *archive, const char *name, PetscInt n, PetscBool *data);
/* this rank's entries of a vector */
PetscErrorCode archive_vector(Archive *archive, const char *name, Vec vector);
/* a sentence, NULL: none; allocated when it is read, and freed before */
PetscErrorCode archive_text(Archive *archive, const char *name, char **text);
/* a number that must be the same when it is read, else that is the fault */
PetscErrorCode archive_agree(Archive *archive, const char *name, uint64_t number, const char *fault);
PetscErrorCode archive_destroy(Archive *archive);

/* Any byte that is changed changes it; begins with DIGEST. */
#define DIGEST UINT64_C(14695981039346656037)
uint64_t digest(uint64_t before, size_t n, const void *data);

/* archive_file.c: what a file says before the archives of all ranks */
typedef struct {
  char      form[24];  /* ARCHIVE_FORM */
  uint32_t  order, int_bytes;
  int64_t   n_ranks, step, n_text;
  double    t;
  uint64_t  text_digest, header_digest;
} ArchiveHeader;

/* All ranks call these. `text`, on rank 0: of the header. Write: to a file beside it, which then takes its place; `fault`, empty if it is
 * there, says why not. Read: `fault` says on all ranks why it is no good; else `text` must be freed. */
PetscErrorCode archive_write(const Archive *archive, const char *path, PetscInt step, PetscReal t, const char *text, char fault[],
                             size_t length);
PetscErrorCode archive_read(const char *path, Archive *archive, ArchiveHeader *header, char **text, char fault[], size_t length);
#endif
