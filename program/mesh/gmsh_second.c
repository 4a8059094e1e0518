/* A body from a Gmsh file of second order: tet10, hex20 or hex27, in the plane tri6, quad8 or quad9, with their nodes as they
 * are, on curved edges too. PETSc reads no hex20, and keeps of other curved cells something else than their nodes: so such
 * a file is read here. */
#include "mesh/gmsh_text.h"
#include "mesh/mesh.h"
#include <stdlib.h>
#include <string.h>

/* From Gmsh's order of nodes to VTK's; the first eight (four) are the same. */
static const PetscInt TET10_ORDER[10] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
static const PetscInt HEX_ORDER[27]   = {0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  16, 18,
                                         19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26};

/* a face of a cell by its corners, in increasing order, -1 before those of one with less than four */
typedef struct {
  PetscInt corners[4], cell, face;
} Face;

/* our kind for Gmsh's; CELL_KINDS: there is none */
static CellKind kind_of(int type)
{
  switch (type) {
  case GMSH_LINE3: return LINE3;
  case GMSH_TRI6: return TRI6;
  case GMSH_QUAD8: return QUAD8;
  case GMSH_QUAD9: return QUAD9;
  case GMSH_TET10: return TET10;
  case GMSH_HEX20: return HEX20;
  case GMSH_HEX27: return HEX27;
  default: return CELL_KINDS;
  }
}

static PetscBool is_kind(int type, PetscInt dimension)
{
  return (PetscBool)(kind_of(type) != CELL_KINDS && cell_dimension(kind_of(type)) == dimension);
}

static PetscBool is_second_order(const GmshText *text, PetscInt dimension)
{
  for (PetscInt e = 0; e < text->n_elements; e++) {
    const int type = text->elements[e].type;
    if ((type >= GMSH_TET10 && type <= GMSH_PYRAMID14) || (type >= GMSH_HEX20 && type <= GMSH_PYRAMID13) ||
        (dimension == 2 && is_kind(type, 2)))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscBool is_in(const GmshText *text, const GmshElement *element, PetscInt dimension, const GmshGroup *volume)
{
  return (PetscBool)(element->dimension == dimension && (!volume || gmsh_text_in_group(text, element, volume)));
}

static void check_element(Scene *scene, const char *body, const GmshElement *element, const PetscInt counts[CELL_KINDS + 1])
{
  const int      type = element->type;
  const CellKind kind = kind_of(type);
  if (type == GMSH_PRISM15 || type == GMSH_PRISM18) gmsh_fail_kind(scene, body, "a prism (wedge)");
  if (type == GMSH_PYRAMID13 || type == GMSH_PYRAMID14) gmsh_fail_kind(scene, body, "a pyramid");
  if (kind == CELL_KINDS)
    scene_fail(scene, body, "file",
               "it holds cells of second order and others (Gmsh's type %d); write all of them with `-order 2`.", type);
  if (element->n_nodes != cell_nodes(kind))
    scene_fail(scene, body, "file", "a cell of Gmsh's type %d has %d nodes there, not %d.", type,
               (int)element->n_nodes, (int)cell_nodes(kind));
  if ((counts[HEX20] && counts[HEX27]) || (counts[QUAD8] && counts[QUAD9]))
    scene_fail(scene, body, "file", "it holds cells with the centres of their faces as nodes and without; one kind is expected.");
}

/* Cells of one kind after the other, as mesh_append() takes them: vertices go with the first kind, and the numbers of
 * another one are relative to its empty block. `number`: of each node, -1: not in this body. */
static PetscErrorCode append_cells(Scene *scene, const char *body, const GmshText *text, const GmshGroup *volume,
                                   PetscInt number[], Mesh *mesh)
{
  const PetscInt d                       = mesh->dimension;
  PetscInt       counts[CELL_KINDS + 1] = {0}, n_entries = 0, n_vertices = 0, *cells;
  PetscReal     *coordinates;
  PetscFunctionBegin;
  for (PetscInt e = 0; e < text->n_elements; e++)
    counts[kind_of(text->elements[e].type)] += is_in(text, &text->elements[e], d, volume);
  for (int kind = 0; kind < CELL_KINDS; kind++)
    n_entries += cell_nodes((CellKind)kind) * counts[kind];
  PetscCall(PetscMalloc2(3 * text->n_nodes, &coordinates, n_entries, &cells));
  for (PetscInt n = 0; n < text->n_nodes; n++)
    number[n] = -1;
  for (PetscInt e = 0; e < text->n_elements; e++) {
    const GmshElement *element = &text->elements[e];
    if (!is_in(text, element, d, volume)) continue;
    check_element(scene, body, element, counts);
    for (PetscInt k = 0; k < element->n_nodes; k++) {
      const PetscInt node = text->node_list[element->nodes + k];
      if (number[node] >= 0) continue;
      PetscCall(PetscArraycpy(coordinates + 3 * n_vertices, text->coordinates + 3 * node, 3));
      number[node] = n_vertices++;
    }
  }
  for (int kind = 0, appended = 0; kind < CELL_KINDS; kind++) {
    PetscInt *cell = cells;
    for (PetscInt e = 0; e < text->n_elements && counts[kind]; e++) {
      const GmshElement *element = &text->elements[e];
      if (!is_in(text, element, d, volume) || kind_of(element->type) != (CellKind)kind) continue;
      for (PetscInt k = 0; k < element->n_nodes; k++, cell++) {
        const PetscInt from = d == 2 ? k : kind == TET10 ? TET10_ORDER[k] : HEX_ORDER[k];
        *cell = number[text->node_list[element->nodes + from]] - (appended ? n_vertices : 0);
      }
    }
    if (cell == cells) continue;
    PetscCall(mesh_append(mesh, appended ? 0 : n_vertices, NULL, coordinates, counts[kind], NULL, (CellKind)kind, cells));
    appended = 1;
  }
  PetscCall(PetscFree2(coordinates, cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int by_corners(const void *a, const void *b)
{
  const PetscInt *p = ((const Face *)a)->corners, *q = ((const Face *)b)->corners;
  for (int k = 0; k < 4; k++) {
    if (p[k] != q[k]) return p[k] < q[k] ? -1 : 1;
  }
  return 0;
}

static PetscErrorCode key(PetscInt n, const PetscInt corners[], Face *face)
{
  PetscFunctionBegin;
  for (int k = 0; k < 4; k++)
    face->corners[k] = -1;
  PetscCall(PetscArraycpy(face->corners, corners, n));
  PetscCall(PetscSortInt(4, face->corners));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* all faces of this body's cells, sorted */
static PetscErrorCode list_faces(const Mesh *mesh, PetscInt first_cell, PetscInt *n, Face **faces)
{
  PetscFunctionBegin;
  *n = 0;
  PetscCall(PetscMalloc1(6 * (mesh->n_cells - first_cell), faces));
  for (PetscInt c = first_cell; c < mesh->n_cells; c++) {
    const CellKind kind = mesh_cell_kind(mesh, c);
    for (PetscInt f = 0; f < cell_faces(kind); f++) {
      PetscInt       vertices[FACE_NODES];
      const PetscInt n_face = cell_face(kind, f, mesh->cell_vertices + mesh->cell_offsets[c], vertices);
      Face          *face   = *faces + (*n)++;
      *face                 = (Face){.cell = c, .face = f};
      PetscCall(key(cell_corners(cell_kind(mesh->dimension - 1, n_face)), vertices, face));
    }
  }
  qsort(*faces, (size_t)*n, sizeof(Face), by_corners);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* faces of one physical surface, each as a face of a cell of this body; none for a surface of another body in the file */
static PetscErrorCode append_surface(const char *body, const GmshText *text, const GmshGroup *group,
                                     const PetscInt number[], PetscInt first, PetscInt n_faces, const Face *faces, Mesh *mesh)
{
  Surface *surface = NULL;
  char     name[2 * NAME_LENGTH];
  PetscFunctionBegin;
  for (PetscInt e = 0; e < text->n_elements; e++) {
    const GmshElement *element = &text->elements[e];
    const PetscBool    is_face = is_kind(element->type, mesh->dimension - 1);
    const PetscInt     n       = is_face ? cell_corners(kind_of(element->type)) : 0;
    PetscInt           corners[4], vertices[FACE_NODES], missing = 0, n_face;
    const Face        *found;
    Face               wanted;
    if (!is_face || element->n_nodes != cell_nodes(kind_of(element->type)) || !gmsh_text_in_group(text, element, group)) continue;
    for (PetscInt k = 0; k < n; k++) {
      const PetscInt v = number[text->node_list[element->nodes + k]];
      corners[k]       = first + v;
      missing += v < 0;
    }
    if (missing) continue;
    PetscCall(key(n, corners, &wanted));
    found = bsearch(&wanted, faces, (size_t)n_faces, sizeof(Face), by_corners);
    if (!found) continue;
    if (!surface) {
      PetscCall(PetscSNPrintf(name, sizeof(name), "%s.%s", body, group->name));
      PetscCall(mesh_add_surface(mesh, name, text->n_elements - e, &surface));
    }
    if ((found > faces && !by_corners(found - 1, found)) ||
        (found + 1 < faces + n_faces && !by_corners(found + 1, found)))
      surface->inner = PETSC_TRUE; /* a face of two cells */
    n_face = cell_face(mesh_cell_kind(mesh, found->cell), found->face,
                       mesh->cell_vertices + mesh->cell_offsets[found->cell], vertices);
    surface_push(surface, n_face, vertices);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the names of all groups of this dimension, for a message */
static void list_names(const GmshText *text, int dimension, char list[], size_t length)
{
  list[0] = 0;
  for (PetscInt g = 0; g < text->n_groups; g++) {
    if (text->groups[g].dimension == dimension)
      snprintf(list + strlen(list), length - strlen(list), "%s%s", list[0] ? ", " : "", text->groups[g].name);
  }
  if (!list[0]) snprintf(list, length, "none");
}

PetscErrorCode gmsh_second_create(Scene *scene, const char *body, const char *path, const char *volume_name, Mesh *mesh,
                                  PetscBool *done)
{
  const PetscInt   first = mesh->n_vertices, first_cell = mesh->n_cells;
  const GmshGroup *volume = NULL;
  char             names[1024];
  PetscInt        *number, n_faces;
  Face            *faces;
  GmshText         text;

  PetscFunctionBegin;
  *done = PETSC_FALSE;
  if (!gmsh_text_read(path, &text)) PetscFunctionReturn(PETSC_SUCCESS); /* PETSc says what is wrong */
  *done = is_second_order(&text, mesh->dimension);
  for (PetscInt e = 0; e < text.n_elements && *done && mesh->dimension == 2; e++) {
    if (text.elements[e].dimension == 3) gmsh_fail_dimension(scene, body, path, 2);
  }
  if (*done) {
    for (PetscInt g = 0; g < text.n_groups && volume_name[0]; g++) {
      if (text.groups[g].dimension == mesh->dimension && !strcmp(text.groups[g].name, volume_name)) volume = &text.groups[g];
    }
    list_names(&text, (int)mesh->dimension, names, sizeof(names));
    if (volume_name[0] && !volume) gmsh_fail_volume(scene, body, path, volume_name, names, mesh->dimension);
    PetscCall(PetscMalloc1(text.n_nodes, &number));
    PetscCall(append_cells(scene, body, &text, volume, number, mesh));
    if (mesh->n_cells == first_cell) scene_fail(scene, body, "volume", "'%s' has no cell in '%s'.", path, volume_name);
    list_names(&text, (int)mesh->dimension - 1, names, sizeof(names));
    if (!strcmp(names, "none")) gmsh_fail_nameless(scene, body, path, mesh->dimension);
    PetscCall(list_faces(mesh, first_cell, &n_faces, &faces));
    for (PetscInt g = 0; g < text.n_groups; g++) {
      if (text.groups[g].dimension == mesh->dimension - 1)
        PetscCall(append_surface(body, &text, &text.groups[g], number, first, n_faces, faces, mesh));
    }
    PetscCall(PetscFree(faces));
    PetscCall(PetscFree(number));
  }
  gmsh_text_destroy(&text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
