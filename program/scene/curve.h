/* A factor over pseudo-time: piecewise linear, constant outside. */
#ifndef STICKSLIP_PROGRAM_CURVE_H
#define STICKSLIP_PROGRAM_CURVE_H
#include "scene/scene.h"

typedef struct {
  PetscInt   n;
  PetscReal *points; /* t0, v0, t1, v1, ... */
} Curve;

/* map.key; without it a ramp from 0 at t = 0 to 1 at t = end */
PetscErrorCode curve_read(Scene *scene, const char *map, const char *key, PetscReal end, Curve *curve);
PetscErrorCode curve_ramp(PetscReal end, Curve *curve); /* such a ramp */
PetscErrorCode curve_copy(const Curve *from, Curve *to);
PetscReal      curve_value(const Curve *curve, PetscReal t);
void           curve_slopes(const Curve *curve, PetscReal t, PetscReal slopes[2]); /* just before t, just after */
PetscBool      curve_bends(const Curve *curve, PetscReal t); /* has a kink at t */
PetscBool      curve_same_time(PetscReal a, PetscReal b);          /* but for rounding */
#endif
