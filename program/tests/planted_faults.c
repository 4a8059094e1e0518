/* The driver with a fault that a test plants, to see that it is found: PLANTED_FAULT in the environment says which one. Functions of the driver
 * and of the library are wrapped by the linker, so that there is nothing of this in the driver itself.
 *
 *   drop, double   the force on one mortar node does not reach its body, or does twice
 *   push           a body is out of balance by 1e-5 of its load, behind contact forces that cancel each other
 *   unfelt         the multiplier of one node pushes on nothing
 *   huge           multipliers are said to be a million times what they are */
#include "contact/contact.h"
#include <stdlib.h>
#include <string.h>

/* Of the loads: what a body is pushed by; and how much larger than them contact forces are, which cancel each other. */
static const PetscReal PUSH = 1e-5, CANCELLED = 1e12, HUGE_FACTOR = 1e6;

PetscErrorCode __real_contact_scatter(const ContactPart *part, const PetscScalar *from, Vec local, MPI_Op operation);
PetscErrorCode __wrap_contact_scatter(const ContactPart *part, const PetscScalar *from, Vec local, MPI_Op operation);
PetscErrorCode __real_parts_measure(Physics *physics);
PetscErrorCode __wrap_parts_measure(Physics *physics);
int32_t __real_stickslip_interface_residual(stickslip_interface *handle, const double *x1, const double *x2, const double *lambda, const double *sums,
                                            double *force1, double *force2, double *rows);
int32_t __wrap_stickslip_interface_residual(stickslip_interface *handle, const double *x1, const double *x2, const double *lambda, const double *sums,
                                            double *force1, double *force2, double *rows);
int32_t __real_stickslip_interface_equilibrium(stickslip_interface *handle, const double *x1, const double *x2, const double *lambda,
                                               const double *sums, stickslip_equilibrium *found);
int32_t __wrap_stickslip_interface_equilibrium(stickslip_interface *handle, const double *x1, const double *x2, const double *lambda,
                                               const double *sums, stickslip_equilibrium *found);

static PetscBool planted(const char *fault)
{
  const char *which = getenv("PLANTED_FAULT");
  return (PetscBool)(which && !strcmp(which, fault));
}

/* the first mortar node of the part that a force acts on gets none, or twice as much */
PetscErrorCode __wrap_contact_scatter(const ContactPart *part, const PetscScalar *from, Vec local, MPI_Op operation)
{
  const PetscInt d = part->dimension, n = d * (part->n1 + part->n2) + part->components * part->n1;
  const PetscReal factor = planted("double") ? 2 : 0;
  PetscScalar   *spoilt;
  PetscInt       first = part->n1;
  PetscFunctionBegin;
  if (from != part->forces || operation != MPIU_SUM || !part->n2 || !(planted("drop") || planted("double"))) {
    PetscCall(__real_contact_scatter(part, from, local, operation));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(n, &spoilt));
  PetscCall(PetscArraycpy(spoilt, from, n));
  while (first + 1 < part->n1 + part->n2 && from[d * first + d - 1] == 0) /* along the last axis, that of the test's load */
    first++;
  for (PetscInt i = 0; i < d; i++)
    spoilt[d * first + i] *= factor;
  PetscCall(__real_contact_scatter(part, spoilt, local, operation));
  PetscCall(PetscFree(spoilt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The residual that Newton's method has is right; what is measured is not. */
PetscErrorCode __wrap_parts_measure(Physics *physics)
{
  Parts       *parts = &physics->parts;
  PetscScalar *f;
  PetscReal    loads;
  PetscInt     at = -1;
  PetscFunctionBegin;
  if (planted("push")) {
    PetscCall(VecNorm(physics->f_external, NORM_2, &loads));
    PetscCall(VecGetArray(physics->f_local, &f));
    for (PetscInt k = 0; k < physics->mesh->n_points && at < 0; k++) {
      PetscCall(PetscSectionGetOffset(physics->unknowns.section, physics->mesh->points[k], &at));
      if (physics->unknowns.ghost[k] || entry_held(physics, at)) at = -1;
    }
    if (at >= 0) f[at] += PUSH * loads;
    PetscCall(VecRestoreArray(physics->f_local, &f));
    for (PetscInt p = 0; p < parts->n; p++)
      parts->squares[N_SQUARES * p + SQUARES_CONTACT] += PetscSqr(CANCELLED * loads);
  }
  PetscCall(__real_parts_measure(physics));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of the first node; the tests have no friction, so that a node has one multiplier */
int32_t __wrap_stickslip_interface_residual(stickslip_interface *handle, const double *x1, const double *x2, const double *lambda, const double *sums,
                                            double *force1, double *force2, double *rows)
{
  const int32_t status = __real_stickslip_interface_residual(handle, x1, x2, lambda, sums, force1, force2, rows);
  double       *first  = (double *)lambda, kept = lambda ? lambda[0] : 0, row = rows ? rows[0] : 0;
  int32_t       again;
  if (status || !planted("unfelt") || !lambda) return status;
  *first = 0;
  again  = __real_stickslip_interface_residual(handle, x1, x2, lambda, sums, force1, force2, rows);
  *first = kept;
  if (rows) rows[0] = row;
  return again;
}

int32_t __wrap_stickslip_interface_equilibrium(stickslip_interface *handle, const double *x1, const double *x2, const double *lambda,
                                               const double *sums, stickslip_equilibrium *found)
{
  const int32_t status = __real_stickslip_interface_equilibrium(handle, x1, x2, lambda, sums, found);
  if (planted("huge")) found->traction_scale *= HUGE_FACTOR;
  return status;
}
