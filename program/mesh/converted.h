/* A converted mesh, an HDF5 file: a group for each body, named as it, with
 *
 *   attributes    dimension, vertices, cells, surfaces: how many; surface_K, inner_K: name and kind of the K-th
 *   coordinates   3 a vertex
 *   sizes         number of vertices of each cell
 *   connectivity  vertices of all cells, in VTK's order, from 0 in each body
 *   faces_K       of each cell a sum of 2^f over its faces f (cell_face()) on the K-th surface
 *
 * PETSc writes vectors of real numbers, which hold whole numbers to 2^53. */
#ifndef STICKSLIP_PROGRAM_CONVERTED_H
#define STICKSLIP_PROGRAM_CONVERTED_H
#include "mesh/mesh.h"

/* converted_write.c: of one rank that has read all bodies, those from Gmsh files; converted_read.c: a range of the cells of one */
PetscErrorCode converted_write(Scene *scene, const Mesh *mesh, const char *path);
PetscErrorCode converted_create(Scene *scene, const char *body, Mesh *mesh);
#endif
