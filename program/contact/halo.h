/* What the parts of an interface watch, so that each has the mortar facets that it may meet. */
#ifndef STICKSLIP_PROGRAM_HALO_H
#define STICKSLIP_PROGRAM_HALO_H
#include "physics/physics.h"

/* What parts may need of the mortar side, and whether they have it (halo.c). Mortar nodes are dealt out to all ranks, which watch
 * them. */
enum { HALO_BOXES = 32, HALO_PLACES = 3 };

typedef struct {
  double *watched;         /* 3 a node watched: displacements there */
  Extent  box[HALO_BOXES]; /* around what the part's facets sweep, with a margin: it has all mortar facets that met a box there */
} HaloPlace;

typedef struct {
  PetscReal margin;
  PetscInt  n_watched;
  PetscSF   watch;                    /* from the local vectors of all ranks to displacements of the nodes watched */
  double   *X_watched, *watched_t_n;  /* their coordinates, their displacements at t_n */
  /* of the part as it is cut */
  PetscBool whole;                    /* every part has all of the mortar side: there is nothing to look at */
  PetscSF   nodes;                    /* likewise to the part's non-mortar nodes */
  double   *X, *x_t_n;                /* their coordinates, and where they were at t_n */
  PetscInt *box;                      /* of each non-mortar facet */
  PetscInt  n_places;
  HaloPlace place[HALO_PLACES];
} Halo;
#endif
