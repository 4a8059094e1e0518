/* Springs. Between two ends, each the weighted mean of nodes (a node; the nodes of a surface, weights w_a = int N_a dA / A), with q the
 * displacement of the first end from the second one:
 *
 *   F = K q, or along the line between the ends of now F = k (l - L) n;   f_a = w_a F, and -w_b F at the other end.
 *
 * In a step of `dynamics` from q to q', of lengths l and l', an axial one has at the place between them, where forces are taken,
 *
 *   F = k (1 - L / m) d,   m = alpha_f l + (1 - alpha_f) l',   d = alpha_f (line at q) + (1 - alpha_f) (line at q').
 *
 * With alpha_f = 1/2 that is F . (q' - q) = k (l' - L)^2 / 2 - k (l - L)^2 / 2 exactly, for d . (q' - q) = (l'^2 - l^2) / 2 then, and F points
 * along d, so that energy and both momenta are kept, however far the line turns in the step.
 *
 * And of a surface to the ground, K per reference area: f_a = sum_b int N_a N_b dA K u_b. Forces are those on the spring, as of a body's cells. */
#ifndef STICKSLIP_PROGRAM_SPRINGS_H
#define STICKSLIP_PROGRAM_SPRINGS_H
#include "physics/physics.h"

/* Surfaces at the ends of a spring have at most so many nodes in all: each of them has all the others in its rows. */
enum { END_NODES = 300 };

/* A node of an end, on every rank. */
typedef struct {
  PetscInt  equations[3], at, part; /* -1: prescribed; its place in a local vector, where this rank owns it, else -1; of the model */
  PetscReal weight, X[3];
} EndNode;

typedef struct {
  PetscInt       vertex;  /* number; -1: a surface, or a place that nothing moves */
  const Surface *surface; /* of the piece; NULL: none */
  PetscInt       n;
  EndNode       *nodes;
  PetscReal      X[3]; /* its place, undeformed */
} SpringEnd;

/* A face on the ground: its nodes' places in a local vector, int N_a N_b dA */
typedef struct {
  PetscInt  n, dofs[FACE_NODES];
  PetscReal M[FACE_NODES * FACE_NODES];
} SpringFace;

typedef struct {
  char        name[NAME_LENGTH];
  PetscBool   axial, per_area, fixed; /* fixed: an axial one whose second end is a place */
  PetscReal   stiffness[3], K[9];     /* in the axes of the scene; in those of the model. Axial: stiffness[0] */
  PetscReal   length;                 /* axial: unstrained; < 0: that of the undeformed model */
  SpringEnd   ends[2];
  PetscInt    n_surfaces;
  const Surface **surfaces; /* per area: of the piece */
  PetscInt    n_faces;
  SpringFace *faces;
  PetscBool   steps;      /* axial, in a step of `dynamics`: */
  PetscReal   mean, n[3]; /* m; the line's direction at q' */
  PetscReal   force[3], total[3]; /* on its (first) end, at the last evaluation; per area of the faces here. Of all ranks: springs_total() */
} Spring;

struct Springs {
  PetscInt n;
  Spring  *spring;
  Vec      forces; /* local */
};

#endif
