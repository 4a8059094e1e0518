/* Load curves. */
#include "scene/curve.h"
#include "scene/petsc_compat.h"

/* Nothing happens before the end: meant in other units? Not an error, for a run may end early on purpose. */
static PetscErrorCode note_late_curve(const char *map, const char *key, PetscReal end, const Curve *curve)
{
  const PetscReal *p = curve->points;
  PetscBool        changes = PETSC_FALSE;
  PetscFunctionBegin;
  for (PetscInt k = 1; k < curve->n; k++)
    changes = (PetscBool)(changes || p[2 * k + 1] != p[1]);
  if (changes && p[0] >= end)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: note: %s.%s stays at %g until t = %g, but the last step ends at %g. Are both "
                           "in one unit of time?\n",
                           map, key, (double)p[1], (double)p[0], (double)end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode curve_ramp(PetscReal end, Curve *curve)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(4, &curve->points));
  curve->points[2] = end;
  curve->points[3] = 1;
  curve->n         = 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode curve_read(Scene *scene, const char *map, const char *key, PetscReal end, Curve *curve)
{
  PetscInt n;
  PetscFunctionBegin;
  scene_reals(scene, map, key, &n, &curve->points);
  if (!n) {
    PetscCall(curve_ramp(end, curve));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (n % 2)
    scene_fail(scene, map, key, "pairs [t0, v0, t1, v1, ...] are expected, but there are %d numbers.", (int)n);
  curve->n = n / 2;
  for (PetscInt k = 1; k < curve->n; k++) {
    if (curve->points[2 * k] <= curve->points[2 * k - 2])
      scene_fail(scene, map, key, "times must increase; %g does not.", (double)curve->points[2 * k]);
  }
  PetscCall(note_late_curve(map, key, end, curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode curve_copy(const Curve *from, Curve *to)
{
  PetscFunctionBegin;
  to->n = from->n;
  PetscCall(PetscMalloc1(2 * from->n, &to->points));
  PetscCall(PetscArraycpy(to->points, from->points, 2 * from->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal curve_value(const Curve *curve, PetscReal t)
{
  const PetscReal *p = curve->points;
  if (t <= p[0]) return p[1];
  for (PetscInt k = 1; k < curve->n; k++, p += 2) {
    if (t <= p[2]) return p[1] + (p[3] - p[1]) * ((t - p[0]) / (p[2] - p[0]));
  }
  return p[1];
}

PetscBool curve_same_time(PetscReal a, PetscReal b)
{
  return (PetscBool)(PetscAbsReal(a - b) <= 1e-12 * PetscMax(1, PetscAbsReal(a)));
}

/* from point k to the next one; before the first and from the last on: none */
static PetscReal slope_from(const Curve *curve, PetscInt k)
{
  const PetscReal *p = curve->points + 2 * k;
  return k >= 0 && k + 1 < curve->n ? (p[3] - p[1]) / (p[2] - p[0]) : 0;
}

void curve_slopes(const Curve *curve, PetscReal t, PetscReal slopes[2])
{
  PetscInt k = -1;
  while (k + 1 < curve->n && (curve->points[2 * k + 2] <= t || curve_same_time(t, curve->points[2 * k + 2])))
    k++;
  slopes[1] = slope_from(curve, k);
  slopes[0] = k >= 0 && curve_same_time(t, curve->points[2 * k]) ? slope_from(curve, k - 1) : slopes[1];
}

PetscBool curve_bends(const Curve *curve, PetscReal t)
{
  PetscReal slopes[2];
  curve_slopes(curve, t, slopes);
  return (PetscBool)(PetscAbsReal(slopes[1] - slopes[0]) > 1e-9 * (PetscAbsReal(slopes[1]) + PetscAbsReal(slopes[0])));
}
