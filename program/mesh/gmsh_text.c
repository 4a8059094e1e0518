/* Reads what gmsh_text.h describes. Numbers are taken one after the other, wherever lines end, but for the nodes of an
 * element, which end with its line. */
#include "mesh/gmsh_text.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The rest of the text, and whether all was as expected so far. */
typedef struct {
  char     *at;
  PetscBool good;
} Cursor;

typedef struct {
  int      dimension, tag;
  PetscInt groups, n_groups;
} Entity;

/* what grows while the file is read */
typedef struct {
  GmshText *text;
  Entity   *entities;
  PetscInt  n_entities, *index, n_index; /* index: of each node's tag, -1: none */
  PetscInt  n_node_list, node_room, n_group_list, group_room;
} Reader;

static long whole(Cursor *cursor)
{
  char *end;
  long  value = strtol(cursor->at, &end, 10);
  if (end == cursor->at) cursor->good = PETSC_FALSE;
  cursor->at = end;
  return value;
}

static double real(Cursor *cursor)
{
  char  *end;
  double value = strtod(cursor->at, &end);
  if (end == cursor->at) cursor->good = PETSC_FALSE;
  cursor->at = end;
  return value;
}

/* behind the line "$NAME" */
static Cursor section(char *all, const char *name)
{
  char line[64], *at = all;
  snprintf(line, sizeof(line), "$%s", name);
  while (at && (at = strstr(at, line))) {
    const char end = at[strlen(line)];
    if ((at == all || at[-1] == '\n') && (end == '\n' || end == '\r')) break;
    at++;
  }
  return (Cursor){at ? at + strlen(line) : all, (PetscBool)(at != NULL)};
}

static void *grown(void *array, PetscInt n, PetscInt *room, size_t size)
{
  if (n < *room) return array;
  *room = 2 * *room + 64;
  return realloc(array, size * (size_t)*room);
}

static void read_groups(char *all, GmshText *text)
{
  Cursor     cursor = section(all, "PhysicalNames");
  const long n      = cursor.good ? whole(&cursor) : 0;
  text->groups      = calloc((size_t)(n > 0 ? n : 1), sizeof(GmshGroup));
  for (long k = 0; k < n && cursor.good; k++) {
    GmshGroup *group = &text->groups[text->n_groups];
    char      *from, *to;
    group->dimension = (int)whole(&cursor);
    group->tag       = (int)whole(&cursor);
    from             = strchr(cursor.at, '"');
    to               = from ? strchr(from + 1, '"') : NULL;
    if (!to) return;
    snprintf(group->name, sizeof(group->name), "%.*s", (int)(to - from - 1), from + 1);
    cursor.at = to + 1;
    text->n_groups++;
  }
}

static void add_group(Reader *reader, long tag)
{
  GmshText *text   = reader->text;
  text->group_list = grown(text->group_list, reader->n_group_list, &reader->group_room, sizeof(int));
  text->group_list[reader->n_group_list++] = (int)labs(tag); /* a sign turns a surface: ours look out of their body */
}

/* format 4.1: which groups an entity belongs to */
static PetscBool read_entities(char *all, Reader *reader)
{
  Cursor cursor = section(all, "Entities");
  long   counts[4], total = 0;
  for (int d = 0; d < 4; d++)
    total += counts[d] = whole(&cursor);
  if (!cursor.good) return PETSC_FALSE;
  reader->entities = calloc((size_t)total + 1, sizeof(Entity));
  for (int d = 0; d < 4; d++) {
    for (long k = 0; k < counts[d] && cursor.good; k++) {
      Entity *entity    = &reader->entities[reader->n_entities++];
      entity->dimension = d;
      entity->tag       = (int)whole(&cursor);
      entity->groups    = reader->n_group_list;
      for (int i = 0; i < (d ? 6 : 3); i++)
        (void)real(&cursor); /* a box around it */
      for (long n = whole(&cursor); n > 0 && cursor.good; n--)
        add_group(reader, whole(&cursor));
      entity->n_groups = reader->n_group_list - entity->groups;
      for (long n = d ? whole(&cursor) : 0; n > 0 && cursor.good; n--)
        (void)whole(&cursor); /* what bounds it */
    }
  }
  return cursor.good;
}

static void place_node(Reader *reader, long tag, PetscInt node)
{
  while (tag >= reader->n_index) {
    const PetscInt old = reader->n_index;
    reader->index      = grown(reader->index, old, &reader->n_index, sizeof(PetscInt));
    for (PetscInt k = old; k < reader->n_index; k++)
      reader->index[k] = -1;
  }
  if (tag >= 0) reader->index[tag] = node;
}

static PetscBool read_nodes(char *all, double version, Reader *reader)
{
  GmshText  *text     = reader->text;
  Cursor     cursor   = section(all, "Nodes");
  const int  blocked  = version > 4;
  const long n_blocks = cursor.good && blocked ? whole(&cursor) : 1, n = cursor.good ? whole(&cursor) : 0;
  if (blocked) (void)whole(&cursor), (void)whole(&cursor); /* least and largest tag */
  if (!cursor.good || n < 0) return PETSC_FALSE;
  text->coordinates = malloc(sizeof(PetscReal) * (size_t)(3 * n + 1));
  for (long b = 0; b < n_blocks && cursor.good; b++) {
    const long dimension = blocked ? whole(&cursor) : 0, tag = blocked ? whole(&cursor) : 0,
               parametric = blocked ? whole(&cursor) : 0, count = blocked ? whole(&cursor) : n;
    (void)tag;
    if (!cursor.good || count < 0 || text->n_nodes + count > n) return PETSC_FALSE;
    for (long k = 0; k < count && blocked; k++)
      place_node(reader, whole(&cursor), text->n_nodes + (PetscInt)k);
    for (long k = 0; k < count && cursor.good; k++, text->n_nodes++) {
      if (!blocked) place_node(reader, whole(&cursor), text->n_nodes);
      for (int i = 0; i < 3; i++)
        text->coordinates[3 * text->n_nodes + i] = real(&cursor);
      for (long i = 0; i < dimension && parametric; i++)
        (void)real(&cursor); /* where on its entity */
    }
  }
  return cursor.good;
}

/* dimension of the elements of a type; 3 for those that are not known here */
static int dimension_of(int type)
{
  static const int low[] = {3, 1, 2, 2, 3, 3, 3, 3, 1, 2, 2, 3, 3, 3, 3, 0, 2};
  return type > 0 && type <= GMSH_QUAD8 ? low[type] : type >= 20 && type <= 25 ? 2 : type >= 26 && type <= 28 ? 1 : 3;
}

/* the nodes that end with the line */
static PetscBool read_element(Cursor *cursor, Reader *reader, int type, PetscInt groups, PetscInt n_groups)
{
  GmshText    *text    = reader->text;
  GmshElement *element = &text->elements[text->n_elements++];
  *element = (GmshElement){dimension_of(type), type, reader->n_node_list, 0, groups, n_groups};
  while (cursor->good) {
    long tag;
    while (*cursor->at == ' ' || *cursor->at == '\t' || *cursor->at == '\r')
      cursor->at++;
    if (*cursor->at == '\n' || !*cursor->at) break;
    tag = whole(cursor);
    if (!cursor->good || tag < 0 || tag >= reader->n_index || reader->index[tag] < 0) return PETSC_FALSE;
    text->node_list = grown(text->node_list, reader->n_node_list, &reader->node_room, sizeof(PetscInt));
    text->node_list[reader->n_node_list++] = reader->index[tag];
    element->n_nodes++;
  }
  return cursor->good;
}

static PetscBool read_elements(char *all, double version, Reader *reader)
{
  GmshText  *text     = reader->text;
  Cursor     cursor   = section(all, "Elements");
  const int  blocked  = version > 4;
  const long n_blocks = cursor.good && blocked ? whole(&cursor) : 1, n = cursor.good ? whole(&cursor) : 0;
  if (blocked) (void)whole(&cursor), (void)whole(&cursor); /* least and largest tag */
  if (!cursor.good || n < 0) return PETSC_FALSE;
  text->elements = malloc(sizeof(GmshElement) * (size_t)(n + 1));
  for (long b = 0; b < n_blocks && cursor.good; b++) {
    const long dimension = blocked ? whole(&cursor) : 0, tag = blocked ? whole(&cursor) : 0,
               type = blocked ? whole(&cursor) : 0, count = blocked ? whole(&cursor) : n;
    PetscInt groups = 0, n_groups = 0;
    for (PetscInt k = 0; k < reader->n_entities; k++) {
      if (reader->entities[k].dimension != dimension || reader->entities[k].tag != tag) continue;
      groups   = reader->entities[k].groups;
      n_groups = reader->entities[k].n_groups;
    }
    if (!cursor.good || count < 0 || text->n_elements + count > n) return PETSC_FALSE;
    for (long k = 0; k < count && cursor.good; k++) {
      long own = type;
      (void)whole(&cursor); /* its tag */
      if (!blocked) { /* its type, and tags: the first one is its group's */
        own              = whole(&cursor);
        groups           = reader->n_group_list;
        const long n_tags = whole(&cursor);
        for (long i = 0; i < n_tags && cursor.good; i++) {
          const long its = whole(&cursor);
          if (i == 0) add_group(reader, its);
        }
        n_groups = reader->n_group_list - groups;
      }
      if (!read_element(&cursor, reader, (int)own, groups, n_groups)) return PETSC_FALSE;
    }
  }
  return cursor.good;
}

static char *read_all(const char *path)
{
  FILE *stream = fopen(path, "rb");
  char *all    = NULL;
  long  n;
  if (!stream) return NULL;
  if (!fseek(stream, 0, SEEK_END) && (n = ftell(stream)) >= 0 && !fseek(stream, 0, SEEK_SET)) {
    all = calloc((size_t)n + 1, 1);
    if (all && fread(all, 1, (size_t)n, stream) != (size_t)n) all[0] = 0;
  }
  fclose(stream);
  return all;
}

PetscBool gmsh_text_read(const char *path, GmshText *text)
{
  char     *all     = read_all(path);
  Reader    reader  = {.text = text};
  double    version = 0;
  int       binary  = 1;
  PetscBool good;
  *text = (GmshText){0};
  good  = (PetscBool)(all && sscanf(all, "$MeshFormat %lf %d", &version, &binary) == 2 && !binary &&
                     (version == 4.1 || version == 2.2));
  if (good) read_groups(all, text);
  good = (PetscBool)(good && (version == 2.2 || read_entities(all, &reader)) && read_nodes(all, version, &reader) &&
                     read_elements(all, version, &reader));
  free(reader.entities);
  free(reader.index);
  free(all);
  if (!good) gmsh_text_destroy(text);
  return good;
}

void gmsh_text_destroy(GmshText *text)
{
  free(text->coordinates);
  free(text->elements);
  free(text->groups);
  free(text->node_list);
  free(text->group_list);
  *text = (GmshText){0};
}

PetscBool gmsh_text_in_group(const GmshText *text, const GmshElement *element, const GmshGroup *group)
{
  for (PetscInt k = 0; k < element->n_groups && element->dimension == group->dimension; k++) {
    if (text->group_list[element->groups + k] == group->tag) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}
