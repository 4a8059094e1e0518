/* A Gmsh file of text, format 4.1 or 2.2, as it is: nodes, elements, and the names of physical groups. */
#ifndef STICKSLIP_PROGRAM_GMSH_TEXT_H
#define STICKSLIP_PROGRAM_GMSH_TEXT_H
#include "scene/petsc_compat.h"

/* Gmsh's numbers of its kinds of elements */
enum {
  GMSH_LINE3     = 8,
  GMSH_TRI6      = 9,
  GMSH_QUAD9     = 10,
  GMSH_TET10     = 11,
  GMSH_HEX27     = 12,
  GMSH_PRISM18   = 13,
  GMSH_PYRAMID14 = 14,
  GMSH_QUAD8     = 16,
  GMSH_HEX20     = 17,
  GMSH_PRISM15   = 18,
  GMSH_PYRAMID13 = 19
};

typedef struct {
  int      dimension, tag;
  char     name[128];
} GmshGroup;

typedef struct {
  int      dimension, type;
  PetscInt nodes, n_nodes;   /* first of its nodes in `node_list`, their number */
  PetscInt groups, n_groups; /* the same of the tags of its physical groups, in `group_list` */
} GmshElement;

typedef struct {
  PetscInt     n_nodes, n_elements, n_groups;
  PetscReal   *coordinates; /* 3 per node */
  GmshElement *elements;
  GmshGroup   *groups;
  PetscInt    *node_list; /* nodes from 0, in the file's order */
  int         *group_list;
} GmshText;

/* false: no such file, or something in it is not as it should be */
PetscBool gmsh_text_read(const char *path, GmshText *text);
void      gmsh_text_destroy(GmshText *text);
PetscBool gmsh_text_in_group(const GmshText *text, const GmshElement *element, const GmshGroup *group);
#endif
