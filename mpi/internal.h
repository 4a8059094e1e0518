/* What the files of the library know of each other. */
#ifndef STICKSLIP_MPI_INTERNAL_H
#define STICKSLIP_MPI_INTERNAL_H

#include "stickslip_mpi.h"
#include <stddef.h>

enum { SIDES = 2, BOXES = 32, PLACES = 3, SENTENCE = 1024 };

/* A box; nothing where a low is above its high. */
typedef struct {
  double low[3], high[3];
} Box;

/* A whole surface as every rank knows it: nodes in ascending order of the host's numbers, facets in that of their nodes. So its parts
 * add up what they add up in the same order, whoever gave what. */
typedef struct {
  int64_t  n_nodes, n_facets;
  int64_t *numbers;         /* the host's */
  int32_t *owners, *places; /* of nodes: the rank, and where in its share */
  double  *X;
  int64_t *offsets;
  int32_t *nodes; /* of facets, as indices */
  int64_t  n_own;
  int32_t *own; /* nodes of this rank's share, in its order */
} Whole;

/* Values of nodes between the ranks that own them and those that have copies. */
typedef struct {
  MPI_Comm comm;
  int      n_owners, *owner; /* ranks that own what is copied here, ascending */
  int64_t *copy_starts;      /* of each owner, in `copies` */
  int32_t *copies;           /* places among the nodes here */
  int      n_holders, *holder;
  int64_t *own_starts;
  int32_t *own; /* places in the own share */
} Exchange;

/* What a rank works on: a handle of the library, and its nodes and facets as indices of the whole. */
typedef struct {
  int64_t              n_nodes[SIDES], n_facets[SIDES];
  int32_t             *nodes[SIDES], *facets[SIDES];
  int64_t             *offsets[SIDES], *facet_nodes[SIDES]; /* counted from 0 */
  double              *x[SIDES], *force[SIDES], *lambda, *rows;
  Exchange             copies[SIDES], worked; /* of all nodes; of the non-mortar ones that are worked on here */
  int64_t              n_worked;
  int32_t             *works; /* these, as places in the part */
  stickslip_interface *handle; /* NULL: this rank has no part */
  int                  planned;
} Part;

/* Bounds of vectors, so that the largest of all ranks are those of all. */
typedef struct {
  double high[3], minus_low[3];
} Bounds;

/* Where the part was when it got its mortar facets. */
typedef struct {
  Box     box[BOXES];
  double *own; /* positions of the own mortar nodes there */
} Place;

/* Whether the part has what it may need (halo.c). */
typedef struct {
  int     whole; /* every part has all of the mortar side */
  int     n_places;
  Place   place[PLACES];
  int    *box; /* of each non-mortar facet of the part */
  double *x_t_n;
} Halo;

/* A commit, at the own nodes. */
typedef struct {
  int64_t commits;
  double *x[SIDES], *slip, *offsets[SIDES]; /* offsets of then; NULL: none */
} State;

struct stickslip_mpi_interface {
  MPI_Comm             comm;
  int                  rank, size;
  int                  dimension, components; /* of vectors, of multipliers */
  stickslip_options    options;
  stickslip_method     choices; /* of the options */
  stickslip_mpi_method method;
  Whole                whole[SIDES];
  int64_t             *equations[SIDES], *multipliers; /* of the own nodes */
  double               longest_edge;                   /* of the mortar side */
  int32_t             *worker;                         /* of each non-mortar node: the rank that works on it */
  double               endured;                        /* an imbalance that could not be bettered */
  Part                 part;
  Halo                 halo;
  double              *x[SIDES], *lambda; /* of the own nodes, at the last update */
  double              *friction, *offsets[SIDES]; /* of the own nodes; NULL: none */
  State                t_n, before;
  int                  undoable, native; /* by `before`; by the handles themselves */
  int64_t              renewed, rebalanced;
};

/* Where the interface is: positions of the own nodes. */
typedef struct {
  const double *x[SIDES];
} At;

/* memory.c: never NULL, zeroed */
void *allocate(int64_t n, size_t bytes);
void *copied(const void *from, int64_t n, size_t bytes);

/* agree.c */
int32_t refuse(int32_t status, const char *format, ...);
int32_t refuse_by_library(const stickslip_mpi_interface *interface, int32_t status);
int32_t agree(MPI_Comm comm, int32_t status);
void    accept(void);

/* gather.c: agreed */
int32_t whole_gather(MPI_Comm comm, const stickslip_mpi_share *share, int side, int dimension, Whole *whole);
void    whole_destroy(Whole *whole);
int64_t whole_bytes(const Whole *whole, int dimension);
int64_t whole_find(const Whole *whole, int64_t number);
/* collective; all nodes of the side, from the own ones */
double *whole_values(MPI_Comm comm, const Whole *whole, int width, const double own[]);

/* commit.c */
void state_set(const stickslip_mpi_interface *interface, int64_t commits, const double *x1, const double *x2, const double *slip,
               State *state);
void state_destroy(State *state);
int32_t balance(stickslip_mpi_interface *interface, const double coverage[]);

/* shares.c */
void bisect(int64_t n, int dimension, const double X[], const double weights[], int parts, int32_t part[]);
void shares_first(stickslip_mpi_interface *interface);
int  shares_better(stickslip_mpi_interface *interface, const double coverage[], int32_t **before);

/* exchange.c: all collective among neighbours */
void exchange_create(MPI_Comm comm, int64_t n, const int32_t owners[], const int32_t places[], const int32_t here[], Exchange *exchange);
void exchange_destroy(Exchange *exchange);
void exchange_bring(const Exchange *exchange, int64_t bytes, const void *own, void *copies);
void exchange_give(const Exchange *exchange, int64_t bytes, const void *copies, void *own);
void exchange_add(const Exchange *exchange, int width, const double copies[], double own[]);

/* cut.c, part.c */
void    cut_nonmortar(const stickslip_mpi_interface *interface, Part *part);
void    cut_mortar(const stickslip_mpi_interface *interface, const Box *boxes, int n_places, double *const positions[], Part *part,
                   int *whole);
void    part_bring(const stickslip_mpi_interface *interface, Part *part, const At *at, const double *lambda);
int32_t part_revive(const stickslip_mpi_interface *interface, const State *t_n, Part *part);
void    part_offsets(Part *part, double *const own[SIDES], int32_t *status);
void    part_destroy(Part *part);
int32_t parts_renew(stickslip_mpi_interface *interface, const State *t_n, const At *now);

/* sweep.c, halo.c */
Box  box_of_nothing(void);
int  box_is_nothing(const Box *box);
void box_add(Box *box, const double point[3]);
void point_of(int dimension, const double x[], int64_t node, double point[3]);
void bounds_clear(Bounds *bounds);
void bounds_add(Bounds *bounds, const double to[3], const double from[3]);
/* What a facet of the part may reach: x its nodes now, x_t_n at t_n. */
typedef struct {
  int           dimension, follows; /* normals of now count, too */
  double        distance;           /* of search; 0: any */
  const Part   *part;
  const double *x, *x_t_n;
  const Bounds *mortar, *moved; /* where mortar nodes are; by what they have moved since t_n */
} Sweep;
Box  sweep_facet(const Sweep *sweep, int64_t facet, double margin);
void halo_create(const stickslip_mpi_interface *interface, const Part *part, Halo *halo);
void halo_settle(const stickslip_mpi_interface *interface, const Part *part, const State *t_n, Halo *halo);
void halo_add(const stickslip_mpi_interface *interface, Part *part, const State *t_n, const double *const x[SIDES], Halo *halo);
int  halo_covers(stickslip_mpi_interface *interface, double spare);
void halo_destroy(Halo *halo);
int  is_frozen(const stickslip_mpi_interface *interface);

#endif
