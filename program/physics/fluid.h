/* A pressure that gets between the surfaces of interfaces, as a fluid does (fluid.c, fluid_front.c, fluid_scene.c). */
#ifndef STICKSLIP_PROGRAM_FLUID_H
#define STICKSLIP_PROGRAM_FLUID_H
#include "physics/physics.h"
#include <cjson/cJSON.h>

/* What is known of a vertex, in a local vector, as its first components: it is of the surface that the load names; the fluid has come to it. */
enum { FLUID_SOURCE, FLUID_REACHED };

/* Faces are this rank's, as points of the DMPlex. */
struct Fluid {
  PetscInt        n_sides, n_outlets; /* of the interfaces; where the fluid must not come: until the mesh is distributed */
  const Surface **sides, **outlets;
  PetscInt        n_faces, *faces, n_out, *out; /* of all sides; of outlets */
  PetscBool      *shut;         /* per face of a side: the fluid does not open it in this step */
  PetscBool      *named;        /* per face of a side: it is of the load's own surface, too, so that the load itself presses it */
  Vec             start, reached; /* FLUID_...: where it is when the step begins; now */
  PetscReal       before, now;    /* its pressure at t_n and now, where it is any */
  PetscReal       area;         /* of what it presses between the surfaces, on both sides and all ranks */
  PetscBool       at_outlet;
  PetscInt        n_outlet_faces; /* of all ranks */
  PetscReal       leaks;        /* when it came to an outlet first; < 0: it has not */
};

/* With the scene, once the load's surfaces are known; with the mesh in pieces; with the mesh distributed. */
PetscErrorCode fluid_read(Scene *scene, const Physics *physics, Load *load);
PetscErrorCode fluid_label(const Physics *physics, const Load *load);
PetscErrorCode fluid_create(Physics *physics, Load *load);
PetscErrorCode fluid_destroy(Load *load);

/* Does it press this face of its sides now? `flags`: of `reached` */
PetscBool fluid_presses(const Load *load, PetscInt k, const Face *face, const PetscScalar flags[]);

PetscBool fluids_any(const Physics *physics);

/* Where the fluid is when a step begins; at a converged state, with the forces of all contact on the vertices, the first time in the
 * step or again: has its front moved? When the step is
 * accepted. */
PetscErrorCode fluid_begin(Physics *physics);
PetscErrorCode fluid_advance(Physics *physics, Vec contact, PetscBool first, PetscBool *moved);
PetscErrorCode fluid_accept(Physics *physics, PetscBool quiet);
void           fluid_report(const Physics *physics, cJSON *json); /* per fluid */

/* Of fluid.c, for its front: flags that any rank has; how much it presses between the surfaces, and whether it is at an outlet */
PetscErrorCode fluid_share_flags(Physics *physics, Vec flags);
PetscErrorCode fluid_measure(const Physics *physics, const Load *load);

/* fluid_pressure.c: what presses the corners of the sides, as first component of `pressure`, at u_local; `forces`: of contact and fluid, shared.
 * A face at u_local, and the areas of its nodes as vectors outwards. */
PetscErrorCode fluid_pressures(Physics *physics, const Fluid *fluid, Vec forces, Vec pressure);
PetscErrorCode fluid_face(const Physics *physics, PetscInt point, const PetscScalar *u, Face *face, PetscReal areas[]);
#endif
