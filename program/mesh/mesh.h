/* The scene's geometry: bodies of vertices and cells, with named surfaces. Each rank reads a piece of it: some cells, their
 * vertices, and their faces on the surfaces. Boxes and converted files are read by all ranks, a range of cells each; other files
 * and analytic bodies by rank 0. What is numbered (vertices, cells, faces of a surface) has the numbers that it has on one rank.
 * Vertices on the border of pieces are in each of them. From the pieces come the distributed DMPlex (plex.c) and the contact
 * surfaces; then they are forgotten. A vertex is any node of a cell, those in the middle of edges, faces and cells too. */
#ifndef STICKSLIP_PROGRAM_MESH_H
#define STICKSLIP_PROGRAM_MESH_H
#include "scene/petsc_compat.h"
#include "mesh/cell.h"
#include "scene/space.h"
#include <petscdmplex.h>
#include <petscsf.h>

typedef struct {
  char      name[2 * NAME_LENGTH]; /* "block.zmin", or a name of `surfaces` */
  PetscInt  n_faces;
  PetscInt *offsets;  /* n_faces + 1 */
  PetscInt *vertices; /* of its faces, in the order of cell_face(): those of the piece; of a surface dealt out, numbers of its own nodes */
  PetscInt *numbers;  /* of its faces; NULL: they follow each other */
  PetscInt  first;    /* of a surface dealt out: number of its first face here */
  PetscBool inner;    /* lies inside a body: good for supports only */
  PetscBool analytic; /* a plane, sphere or cylinder, a line or circle, without faces: good for a mortar side only */
  PetscInt  shape;    /* STICKSLIP_SHAPE_... */
  PetscReal radius;
  PetscInt  frame; /* number of the first of its four vertices, in the plane three */
} Surface;

/* The surfaces of a rigid body, to be drawn: its vertices, and faces by these. */
typedef struct {
  PetscInt   n_vertices, n_faces, *offsets, *vertices;
  PetscReal *coordinates;
} Shell;

typedef struct {
  char      name[NAME_LENGTH];
  PetscBool analytic, from_gmsh;      /* rigid, one cell without stiffness: its frame; from a Gmsh file */
  PetscBool rigid;                    /* moves with a reference point, see rigid.c: its first vertex, and the second one beside it */
  PetscInt  first_vertex, end_vertex; /* numbers of its vertices, known to every rank */
  PetscInt  first_cell;               /* number of its first cell */
  PetscInt  first_here, end_here;     /* its vertices in this rank's piece */
  Shell     shell;                    /* of a rigid body, on rank 0 */
} Body;

/* What a rank holds of the mesh, in bytes: while it is read, and during the run. */
typedef struct {
  PetscLogDouble read, kept;
} MeshBytes;

typedef struct {
  PetscMPIInt rank, size;
  Space       space;
  PetscInt    dimension; /* of cells; faces have one less */
  PetscInt    n_bodies;
  Body       *bodies;
  PetscInt    n_all_vertices, n_all_cells; /* of all ranks */
  /* this rank's piece, up to plex_distribute() and what comes directly after it */
  PetscInt   n_vertices, n_cells, n_surfaces;
  PetscInt  *numbers;       /* of its vertices, increasing */
  PetscReal *coordinates;   /* 3 per vertex; in the plane the third is 0 */
  PetscInt  *cell_numbers;  /* increasing */
  PetscInt  *cell_offsets;  /* n_cells + 1 */
  PetscInt  *cell_vertices; /* in VTK's order */
  PetscInt  *cell_body;
  Surface   *surfaces;      /* the same ones on every rank */
  PetscSF    shared;        /* from the vertices of all pieces to those here that another rank owns */
  PetscInt  *owners;        /* directory: of this rank's range of numbers, the owner's rank and the vertex in its piece */
  PetscReal  rotation[9]; /* of the whole scene, row-major; identity unless `frame` says otherwise */
  PetscBool  rotated;
  /* plex.c: each vertex is a point of the DMPlex: one of its vertices, or the edge, face or cell that it is in the middle
   * of. Before the mesh is distributed: of the piece's vertices. Afterwards: of those here, by increasing points. */
  DM        dm;
  PetscInt  n_points, *points;
  PetscInt *original; /* number of each vertex here */
  PetscInt *here;     /* of each point: the number of its vertex here, or -1 */
  PetscInt *original_cell; /* number of each cell here */
  MeshBytes bytes;
} Mesh;

/* A box along the axes around some points. */
typedef struct {
  PetscReal low[3], high[3];
} Extent;

Extent    extent_of_nothing(void);
void      extent_add(Extent *extent, const PetscReal x[3]);
PetscReal extent_longest(const Extent *extent); /* its longest edge; 0 of nothing */
PetscReal extent_diagonal_squared(const Extent *extent);

PetscErrorCode extent_of_all(Extent *extent); /* of all ranks */

/* bodies.c: bodies and surfaces, in the axes of the scene file */
PetscErrorCode mesh_create(Scene *scene, Mesh *mesh);
/* mesh.c */
PetscErrorCode mesh_rotate(Mesh *mesh); /* into the rotated frame, when all selections are done */
PetscErrorCode mesh_forget_pieces(Mesh *mesh);
PetscErrorCode mesh_destroy(Mesh *mesh);
void           mesh_rotate_vector(const Mesh *mesh, PetscReal v[3]);
CellKind       mesh_cell_kind(const Mesh *mesh, PetscInt cell);
CellKind       mesh_face_kind(const Mesh *mesh, const Surface *surface, PetscInt face);

/* measure.c: bytes of the piece; into mesh->bytes.kept those of the distributed mesh */
PetscLogDouble mesh_bytes_of_piece(const Mesh *mesh);
PetscErrorCode mesh_measure(Mesh *mesh);

/* lookup.c; the nearest vertex is known to every rank, by its number */
const Surface *mesh_surface(Scene *scene, const Mesh *mesh, const char *map, const char *key, const char *name);
/* a side of an interface, `nonmortar` or `mortar`; of a list the surface that they are together, which has this name */
const Surface *mesh_side(Scene *scene, const Mesh *mesh, const char *interface, const char *key);
void           mesh_side_name(const char *interface, const char *key, char name[], size_t length);
PetscInt       mesh_body(Scene *scene, const Mesh *mesh, const char *map, const char *key, const char *name);
PetscErrorCode mesh_nearest_vertex(Scene *scene, const Mesh *mesh, const char *map, PetscInt *number);
PetscErrorCode mesh_vertex_at(Scene *scene, const Mesh *mesh, const char *map, const char *body_key, const char *point_key, PetscInt *number);
PetscInt       mesh_body_of(const Mesh *mesh, PetscInt number);     /* of a vertex */
PetscInt       mesh_vertex_here(const Mesh *mesh, PetscInt number); /* in the piece; -1: it is not */

/* pieces.c: who owns the vertices of the pieces */
PetscErrorCode pieces_share(Mesh *mesh);
/* all copies of a vertex get the least, largest ... of theirs; the owner's */
PetscErrorCode pieces_unite(const Mesh *mesh, PetscInt values[], MPI_Op operation);
PetscErrorCode pieces_copy(const Mesh *mesh, PetscInt width, PetscReal values[]);
/* from the pieces' vertices to those of these numbers, each from its owner */
PetscErrorCode pieces_fetch_create(const Mesh *mesh, PetscInt n, const PetscInt numbers[], PetscSF *sf);
/* from entries that all ranks keep of ranges of numbers, so many here, to those of these numbers */
PetscErrorCode directory_create(const Mesh *mesh, PetscInt n, const PetscInt numbers[], PetscInt *n_here, PetscSF *sf);

/* deal.c: packed one rank after the other, counts[r] for rank r; from all ranks, one after the other */
PetscErrorCode numbers_deal(const Mesh *mesh, const PetscMPIInt counts[], const PetscInt packed[], PetscInt *n, PetscInt **received);

/* shares.c: of a surface of all pieces the faces of this rank's range, and the nodes that are numbered here, as vertices of the mesh: their
 * numbers follow those of the ranks before. The frame of an analytic surface is on rank 0. */
PetscErrorCode surface_share(const Mesh *mesh, const Surface *surface, Surface *share, PetscInt *n_nodes, PetscInt **nodes);
/* the nodes numbered anew where vertices have copies: of each corner here, its vertex and which copy of it the face has; of each node which
 * copy it is */
PetscErrorCode surface_split(const Mesh *mesh, const PetscInt vertices[], const PetscInt copies[], Surface *share, PetscInt *n_nodes,
                             PetscInt **nodes, PetscInt **node_copies);
PetscErrorCode surface_destroy(Surface *surface);

/* outer.c: of the piece the outer faces of the bodies that are wanted, without those of some of the mesh's surfaces */
PetscErrorCode mesh_outer(const Mesh *mesh, const PetscBool wanted[], const PetscBool without[], Surface *outer);

/* plex.c */
PetscErrorCode plex_create(Mesh *mesh);
/* vertices of the piece; `values` per vertex, or NULL for one `value` for all */
PetscErrorCode plex_label_vertices(const Mesh *mesh, const char *label, PetscInt n, const PetscInt *vertices,
                                   const PetscInt *values, PetscInt value);
PetscErrorCode plex_label_faces(const Mesh *mesh, const char *label, const Surface *surface);
PetscErrorCode plex_distribute(Mesh *mesh);
/* plex_nodes.c: the points of the nodes of a cell, in VTK's order, or of a face, as cell_face() has them but turning either
 * way, once the mesh is distributed */
PetscErrorCode plex_amid(DM dm, PetscInt n, const PetscInt points[], PetscInt *point);
PetscErrorCode plex_cell_nodes(const Mesh *mesh, PetscInt cell, PetscInt *n, PetscInt points[]);
PetscErrorCode plex_face_nodes(const Mesh *mesh, PetscInt face, PetscInt *n, PetscInt points[]);
/* this rank's points with the label "kind.name"; the caller frees them */
PetscErrorCode plex_labelled(const Mesh *mesh, const char *kind, const char *name, PetscInt *n, PetscInt **points);

/* trees.c: what belongs together, as trees; at first each entry is its own parent */
void     trees_join(PetscInt parent[], PetscInt a, PetscInt b);
PetscInt trees_number(PetscInt n, PetscInt parent[]); /* from trees to numbers from 0; returns how many there are */

/* mesh.c, for the readers of one body: box.c, gmsh.c, analytic.c. Plane cells may turn either way; mesh_append() turns them.
 * A piece of a body that others have pieces of gives numbers, in the body; else they follow those that there are. */
void           mesh_turn_cell(const Mesh *mesh, CellKind kind, PetscInt vertices[]);
PetscErrorCode mesh_append(Mesh *mesh, PetscInt n_vertices, const PetscInt *numbers, const PetscReal *coordinates,
                           PetscInt n_cells, const PetscInt *cell_numbers, CellKind kind, const PetscInt *cells);
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

/* A structured box (box_lattice.c). */
typedef struct {
  CellKind kind;
  PetscInt order;
  PetscInt n[3];      /* cells, each split where they are simplices; 1 along z in the plane */
  PetscInt layers[3]; /* of lattice points; those of a full circle meet where they began; 1 along z in the plane */
} Box;

PetscInt       box_pieces(const Box *box); /* cells that each hexahedron or quadrilateral is split into */
PetscInt       box_vertices(const Box *box);
void           box_point(const Box *box, PetscInt number, PetscInt at[3]);
/* numbers of the vertices of the cells of hexahedra (quadrilaterals) first to end */
void           box_cells(const Box *box, PetscInt first, PetscInt end, PetscInt cells[]);

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
PetscErrorCode analytic_fit(Mesh *mesh);
/* rigid.c, on every rank, and what it reads surfaces without cells with: gmsh_shell.c, stl.c, orient.c */
PetscBool      rigid_is_analytic(Scene *scene, const char *body);
PetscErrorCode rigid_create(Scene *scene, Body *body, Mesh *mesh);
PetscErrorCode gmsh_shell_create(Scene *scene, const char *body, Mesh *shell);
PetscErrorCode stl_create(Scene *scene, const char *body, Mesh *shell);
/* in PetscTimSort(): of edges, or whatever begins with the numbers of its ends, `low` and `high` */
int            orient_compare(const void *a, const void *b, void *context);
PetscErrorCode orient_outward(Scene *scene, const char *body, const Mesh *shell);
#endif
