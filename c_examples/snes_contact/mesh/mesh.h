/* The scene's geometry: all bodies in one list of vertices and cells, with named surfaces, on rank 0 only. From it come the
 * distributed DMPlex (plex.c), the contact surfaces, and the files for ParaView. A vertex is any node of a cell, those in
 * the middle of edges, faces and cells too. */
#ifndef SNES_CONTACT_MESH_H
#define SNES_CONTACT_MESH_H
#include "scene/petsc_compat.h"
#include "mesh/cell.h"
#include "scene/space.h"
#include <petscdmplex.h>
#include <petscsf.h>

typedef struct {
  char      name[2 * NAME_LENGTH]; /* "block.zmin", or a name of `surfaces` */
  PetscInt  n_faces;
  PetscInt *offsets;  /* n_faces + 1 */
  PetscInt *vertices; /* of its faces, in the order of cell_face() */
  PetscBool inner;    /* lies inside a body: good for supports only */
  PetscBool analytic; /* a plane, sphere or cylinder, a line or circle, without faces: good for a mortar side only */
  PetscInt  shape;    /* STICKSLIP_SHAPE_... */
  PetscReal radius;
  PetscInt  frame; /* the first of its four vertices, in the plane three */
} Surface;

typedef struct {
  char      name[NAME_LENGTH];
  PetscBool analytic; /* rigid, one cell without stiffness: its frame */
  PetscBool rigid;    /* moves with a reference point, see rigid.c: its first vertex, and the second one beside it */
  PetscInt  first_vertex, end_vertex; /* its range of vertices (rank 0) */
  PetscInt  first_surface, end_surface; /* of those that come with it (rank 0) */
} Body;

typedef struct {
  PetscMPIInt rank;
  Space       space;
  PetscInt    dimension; /* of cells; faces have one less */
  PetscInt   n_bodies;
  Body      *bodies; /* known to every rank; everything below, but for the DMPlex, on rank 0 only */
  PetscInt   n_vertices, n_cells, n_surfaces;
  PetscReal *coordinates;   /* 3 per vertex; in the plane the third is 0 */
  PetscInt  *cell_offsets;  /* n_cells + 1 */
  PetscInt  *cell_vertices; /* in VTK's order */
  PetscInt  *cell_body;
  Surface   *surfaces;
  PetscReal  rotation[9]; /* of the whole scene, row-major; identity unless `frame` says otherwise */
  PetscBool  rotated;
  /* plex.c: each vertex is a point of the DMPlex: one of its vertices, or the edge, face or cell that it is in the middle
   * of. Before the mesh is distributed: of all vertices, on rank 0. Afterwards: of those here, by increasing points. */
  DM        dm;
  PetscInt  n_points, *points;
  PetscInt *original; /* mesh vertex of each vertex here */
  PetscInt *here;     /* of each point: the number of its vertex here, or -1 */
} Mesh;

/* A box along the axes around some points. */
typedef struct {
  PetscReal low[3], high[3];
} Extent;

Extent    extent_of_nothing(void);
void      extent_add(Extent *extent, const PetscReal x[3]);
PetscReal extent_longest(const Extent *extent); /* its longest edge; 0 of nothing */
PetscReal extent_diagonal_squared(const Extent *extent);

PetscErrorCode mesh_create(Scene *scene, Mesh *mesh); /* bodies and surfaces, in the axes of the scene file */
PetscErrorCode mesh_rotate(Mesh *mesh);               /* then into the rotated frame, when all selections are done */
PetscErrorCode mesh_destroy(Mesh *mesh);
void           mesh_rotate_vector(const Mesh *mesh, PetscReal v[3]);
CellKind       mesh_cell_kind(const Mesh *mesh, PetscInt cell);
CellKind       mesh_face_kind(const Mesh *mesh, const Surface *surface, PetscInt face);

const Surface *mesh_surface(Scene *scene, const Mesh *mesh, const char *map, const char *key, const char *name);
PetscInt       mesh_body(Scene *scene, const Mesh *mesh, const char *map, const char *key, const char *name);
PetscInt       mesh_nearest_vertex(Scene *scene, const Mesh *mesh, const char *map);

/* plex.c */
PetscErrorCode plex_create(Mesh *mesh);
PetscErrorCode plex_label_vertices(const Mesh *mesh, const char *label, PetscInt n, const PetscInt *vertices,
                                   const PetscInt *values, PetscInt value);
PetscErrorCode plex_label_faces(const Mesh *mesh, const char *label, const Surface *surface);
PetscErrorCode plex_distribute(Mesh *mesh);
/* plex_nodes.c: the points of the nodes of a cell, in VTK's order, or of a face, as cell_face() has them but turning either
 * way, once the mesh is distributed */
PetscErrorCode plex_amid(DM dm, PetscInt n, const PetscInt points[], PetscInt *point);
PetscErrorCode plex_cell_nodes(const Mesh *mesh, PetscInt cell, PetscInt *n, PetscInt points[]);
PetscErrorCode plex_face_nodes(const Mesh *mesh, PetscInt face, PetscInt *n, PetscInt points[]);

/* trees.c: what belongs together, as trees; at first each entry is its own parent */
void     trees_join(PetscInt parent[], PetscInt a, PetscInt b);
PetscInt trees_number(PetscInt n, PetscInt parent[]); /* from trees to numbers from 0; returns how many there are */

/* for the readers of one body: box.c, gmsh.c, analytic.c. Plane cells may turn either way; mesh_append() turns them. */
void           mesh_turn_cell(const Mesh *mesh, CellKind kind, PetscInt vertices[]);
PetscErrorCode mesh_append(Mesh *mesh, PetscInt n_vertices, const PetscReal *coordinates, PetscInt n_cells,
                           CellKind kind, const PetscInt *cells);
PetscErrorCode mesh_add_surface(Mesh *mesh, const char *name, PetscInt max_faces, Surface **surface);
void           surface_push(Surface *surface, PetscInt n, const PetscInt vertices[]);
PetscErrorCode box_create(Scene *scene, const char *body, Mesh *mesh);
/* How a box is bent (box_shape.c). */
typedef enum { BOX_STRAIGHT, BOX_BALL, BOX_CYLINDER, BOX_POLAR } BoxKind;

typedef struct {
  BoxKind   kind;
  PetscReal centre[3];
  int       axis;   /* along which a cylinder stays straight; -1: none */
  PetscBool closed; /* a full circle: the last layer of vertices along y is the first */
} BoxShape;

void box_shape_read(Scene *scene, const Space *space, const char *body, const PetscInt n[3], PetscReal *const planes[3],
                    BoxShape *shape);
void box_shape_bend(const BoxShape *shape, PetscReal x[3]);

PetscErrorCode gmsh_create(Scene *scene, const char *body, Mesh *mesh);
/* name of a temporary copy of a Gmsh file whose physical surfaces have no signs; "": there are none in the file itself */
PetscErrorCode gmsh_without_signs(const char *path, char copy[], size_t length);
/* gmsh_faults.c: they end the run */
void           gmsh_fail_kind(Scene *scene, const char *body, const char *kind);
void           gmsh_fail_dimension(Scene *scene, const char *body, const char *path, PetscInt dimension);
void           gmsh_fail_volume(Scene *scene, const char *body, const char *path, const char *volume, const char *names,
                                PetscInt dimension);
void           gmsh_fail_nameless(Scene *scene, const char *body, const char *path, PetscInt dimension);
/* `done`: the file is of second order */
PetscErrorCode gmsh_second_create(Scene *scene, const char *body, const char *path, const char *volume, Mesh *mesh,
                                  PetscBool *done);
/* gmsh.c, for gmsh_shell.c: opens the file that body.file names; corners of a cell, in VTK's order; is a label of PETSc's a
 * physical name, with `height` 0 of a cell, 1 of a face? */
PetscErrorCode gmsh_open(Scene *scene, const char *body, PetscInt dimension, char path[], DM *dm);
PetscErrorCode gmsh_corners(DM dm, PetscInt cell, PetscInt *n, PetscInt vertices[8]);
PetscErrorCode gmsh_physical_name(DM dm, PetscInt label, PetscInt height, const char **name, PetscBool *is);
PetscErrorCode analytic_create(Scene *scene, const char *body, Mesh *mesh);
void           analytic_fit(Mesh *mesh);
/* rigid.c, and what it reads surfaces without cells with: gmsh_shell.c, stl.c, orient.c */
PetscBool      rigid_is_analytic(Scene *scene, const char *body);
PetscErrorCode rigid_create(Scene *scene, const char *body, Mesh *mesh);
PetscErrorCode gmsh_shell_create(Scene *scene, const char *body, Mesh *shell);
PetscErrorCode stl_create(Scene *scene, const char *body, Mesh *shell);
PetscErrorCode orient_outward(Scene *scene, const char *body, const Mesh *shell);
#endif
