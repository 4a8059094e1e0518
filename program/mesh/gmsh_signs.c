/* Signs of physical surfaces and curves in a Gmsh file. `Physical Surface("contact") = {-3};` gives surface 3 the tag -1 where the name
 * has 1, and PETSc finds no name for it. The sign turns the surface round, which says nothing here: faces look out of
 * their body. So it is taken away, in a copy. Format 4.1, as text or binary; older ones write no signs. */
#include "mesh/mesh.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Where reading is, and where the file ends. */
typedef struct {
  char *at, *end;
} Place;

static PetscBool skip(Place *place, size_t bytes)
{
  if ((size_t)(place->end - place->at) < bytes) return PETSC_FALSE;
  place->at += bytes;
  return PETSC_TRUE;
}

static void skip_line(Place *place)
{
  while (place->at < place->end && *place->at != '\n')
    place->at++;
  (void)skip(place, 1);
}

/* the next word of a text; its end is a blank or the file's end */
static char *word(Place *place)
{
  char *start;
  while (place->at < place->end && strchr(" \t\r\n", *place->at))
    place->at++;
  start = place->at;
  while (place->at < place->end && !strchr(" \t\r\n", *place->at))
    place->at++;
  return start;
}

static PetscBool text_signs(Place place)
{
  long      counts[4]; /* of points, curves, surfaces and volumes, a line each */
  PetscBool changed = PETSC_FALSE;
  for (int k = 0; k < 4; k++)
    counts[k] = strtol(word(&place), NULL, 10);
  for (long k = 0; k <= counts[0] && place.at < place.end; k++)
    skip_line(&place); /* of the counts, of points */
  for (long k = 0; k < counts[1] + counts[2] && place.at < place.end; k++) {
    long n;
    for (int i = 0; i < 7; i++) /* its number, a box around it */
      (void)word(&place);
    n = strtol(word(&place), NULL, 10);
    for (long j = 0; j < n && place.at < place.end; j++) {
      char *tag = word(&place);
      if (*tag != '-') continue;
      *tag    = ' ';
      changed = PETSC_TRUE;
    }
    skip_line(&place);
  }
  return changed;
}

/* so many 4-byte integers after their 8-byte number, without signs where asked for */
static PetscBool binary_list(Place *place, PetscBool unsign, PetscBool *changed)
{
  uint64_t n;
  if ((size_t)(place->end - place->at) < sizeof(n)) return PETSC_FALSE;
  memcpy(&n, place->at, sizeof(n));
  place->at += sizeof(n);
  if (n > (uint64_t)(place->end - place->at) / 4) return PETSC_FALSE;
  for (uint64_t k = 0; k < n; k++, place->at += 4) {
    int32_t tag;
    memcpy(&tag, place->at, sizeof(tag));
    if (!unsign || tag >= 0) continue;
    tag = -tag;
    memcpy(place->at, &tag, sizeof(tag));
    *changed = PETSC_TRUE;
  }
  return PETSC_TRUE;
}

static PetscBool binary_signs(Place place)
{
  uint64_t  counts[4];
  PetscBool changed = PETSC_FALSE;
  if (!skip(&place, sizeof(counts))) return PETSC_FALSE;
  memcpy(counts, place.at - sizeof(counts), sizeof(counts));
  for (int dimension = 0; dimension < 3; dimension++) {
    for (uint64_t k = 0; k < counts[dimension]; k++) {
      /* its number, a point or a box, physical tags, what bounds it */
      if (!skip(&place, 4 + 8 * (dimension ? 6 : 3)) ||
          !binary_list(&place, (PetscBool)(dimension > 0), &changed) ||
          (dimension && !binary_list(&place, PETSC_FALSE, &changed)))
        return PETSC_FALSE;
    }
  }
  return changed;
}

/* the file's bytes and a zero; NULL where they cannot be read */
static char *read_file(const char *path, size_t *n)
{
  FILE *stream = fopen(path, "rb");
  char *text   = NULL;
  long  length;
  if (!stream) return NULL;
  if (!fseek(stream, 0, SEEK_END) && (length = ftell(stream)) >= 0 && !fseek(stream, 0, SEEK_SET)) {
    *n   = (size_t)length;
    text = malloc(*n + 1);
    if (text && fread(text, 1, *n, stream) != *n) {
      free(text);
      text = NULL;
    }
    if (text) text[*n] = 0;
  }
  fclose(stream);
  return text;
}

PetscErrorCode gmsh_without_signs(const char *path, char copy[], size_t length)
{
  static const char entities[] = "\n$Entities\n";
  char             *text, *section = NULL;
  size_t            n = 0;
  double            version = 0;
  int               binary = 0, file;
  PetscBool         changed = PETSC_FALSE, written;

  PetscFunctionBegin;
  copy[0] = 0;
  text    = read_file(path, &n);
  if (!text) PetscFunctionReturn(PETSC_SUCCESS); /* PETSc says what is wrong with it */
  if (sscanf(text, "$MeshFormat %lf %d", &version, &binary) == 2 && version > 4.05) {
    for (char *c = text; !section && (c = memchr(c, '\n', n - (size_t)(c - text))); c++) {
      if (n - (size_t)(c - text) > sizeof(entities) && !memcmp(c, entities, sizeof(entities) - 1))
        section = c + sizeof(entities) - 1;
    }
  }
  if (section) {
    const Place place = {section, text + n};
    changed           = binary ? binary_signs(place) : text_signs(place);
  }
  if (changed) {
    char folder[PETSC_MAX_PATH_LEN];
    PetscCall(PetscGetTmp(PETSC_COMM_SELF, folder, sizeof(folder)));
    PetscCall(PetscSNPrintf(copy, length, "%s/stickslip_XXXXXX", folder));
    file    = mkstemp(copy);
    written = (PetscBool)(file >= 0 && write(file, text, n) == (ssize_t)n);
    if (file >= 0) close(file);
    free(text);
    PetscCheck(written, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write a copy of the mesh in %s", folder);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
