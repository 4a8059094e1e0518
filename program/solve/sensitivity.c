/* Derivatives of a step's end by parameters, forwards: from those of t_n, with the tangent of the step's end. */
#include "physics/timed.h"
#include "solve/sensitivity.h"

typedef struct {
  const PetscScalar *from;
  PetscScalar       *to;
  PetscInt           number;
} Copying;

static void mark_entry(const Support *support, PetscInt entry, int component, PetscBool owned, void *context)
{
  const Copying *of = context;
  (void)support, (void)component, (void)owned;
  of->to[entry] = of->number;
}

/* Forces on a mortar side that stays are known as a sum (along.c): one support must have all of it. `holders`: local, work space */
static PetscErrorCode check_holders(Scene *scene, const Solve *solve, Vec holders)
{
  const Physics *physics = solve->physics;
  Copying        of      = {0};
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(holders));
  PetscCall(VecGetArray(holders, &of.to));
  for (of.number = 1; of.number <= physics->n_supports; of.number++)
    PetscCall(support_visit(physics, &physics->supports[of.number - 1], mark_entry, &of));
  PetscCall(VecRestoreArray(holders, &of.to));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++) {
    const Interface   *interface = &solve->contact->interfaces[i];
    const ContactPart *part      = &interface->part;
    const PetscInt     d         = part->dimension;
    PetscScalar       *values, *mortar;
    PetscInt           bad = -1;
    PetscCall(PetscMalloc1(d * (part->n1 + part->n2) + part->components * part->n1, &values));
    PetscCall(contact_fetch(part->sf, holders, values));
    mortar = MORTAR_OF(part, values);
    for (PetscInt k = d; k < d * part->n2 && contact_mortar_stays(part); k++) {
      if (mortar[k] != mortar[k % d]) bad = 0;
    }
    PetscCall(PetscFree(values));
    PetscCall(scene_fail_first(scene, bad, interface->name, "mortar",
                               "with `parameters` a mortar side that does not move must be held by one support: how its force is shared "
                               "among several is not known."));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode sensitivity_create(Scene *scene, Solve *solve)
{
  Sensitivity *all = solve->sensitivity;
  PetscFunctionBegin;
  if (!all) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(solve->physics->u_local, &all->forces));
  for (PetscInt p = 0; p < all->n; p++) {
    PetscCall(VecDuplicate(all->forces, &all->parameters[p].last));
    PetscCall(VecDuplicate(all->forces, &all->parameters[p].now));
    PetscCall(VecZeroEntries(all->parameters[p].last));
    PetscCall(PetscCalloc1(3 * solve->physics->n_supports, &all->parameters[p].reactions));
  }
  PetscCall(check_holders(scene, solve, all->forces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void copy_entry(const Support *support, PetscInt entry, int component, PetscBool owned, void *context)
{
  const Copying *of = context;
  (void)support, (void)component, (void)owned;
  of->to[entry] = of->from[entry];
}

/* What the parameter changes of prescribed displacements: a factor on all that a support prescribes. */
static PetscErrorCode prescribed(const Physics *physics, Parameter *parameter)
{
  Copying of;
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(parameter->now));
  if (parameter->kind != PARAMETER_SUPPORT) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(physics->prescribed_local, &of.from));
  PetscCall(VecGetArray(parameter->now, &of.to));
  PetscCall(support_visit(physics, &physics->supports[parameter->number], copy_entry, &of));
  PetscCall(VecRestoreArray(parameter->now, &of.to));
  PetscCall(VecRestoreArrayRead(physics->prescribed_local, &of.from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* dR along the parameter as far as it is known before the system of the step is solved; `now` becomes what is prescribed. */
static PetscErrorCode ask(Solve *solve, Parameter *parameter, Vec forces, PetscInt *status)
{
  Physics         *physics   = solve->physics;
  ContactDirection direction = {.interface = parameter->kind < PARAMETER_YOUNG ? parameter->number : -1, .previous = parameter->last};
  PetscFunctionBegin;
  PetscCall(prescribed(physics, parameter));
  PetscCall(VecZeroEntries(forces));
  switch (parameter->kind) {
  case PARAMETER_FRICTION:
    direction.friction = 1;
    break;
  case PARAMETER_SHEAR_LIMIT:
    direction.shear_limit = 1;
    break;
  case PARAMETER_OFFSET: {
    const Curve *curve = &solve->contact->interfaces[parameter->number].offsets.curve;
    direction.offset   = curve->n ? curve_value(curve, physics->t) : 1;
    break;
  }
  case PARAMETER_YOUNG:
    PetscCall(bulk_per_young(physics, parameter->number, forces));
    break;
  case PARAMETER_LOAD:
    PetscCall(VecAXPY(forces, -curve_value(&physics->loads[parameter->number].curve, physics->t), physics->loads[parameter->number].forces));
    break;
  case PARAMETER_SUPPORT:
    direction.now = parameter->now;
    PetscCall(bulk_along(physics, parameter->now, forces));
    break;
  default:
    break;
  }
  PetscCall(contact_along(solve->contact, &direction, forces, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the unknowns' change dx makes of it: into `now` and `forces`; `largest`: of what cells have of the latter. */
static PetscErrorCode answer(Solve *solve, Parameter *parameter, Vec dx, Vec forces, PetscReal *largest, PetscInt *status)
{
  DM               dm = solve->mesh->dm;
  ContactDirection direction = {.interface = -1, .multipliers = PETSC_TRUE};
  Vec              du, more;
  PetscFunctionBegin;
  PetscCall(DMGetLocalVector(dm, &du));
  PetscCall(DMGetLocalVector(dm, &more));
  PetscCall(VecZeroEntries(du));
  PetscCall(DMGlobalToLocalBegin(dm, dx, INSERT_VALUES, du)); /* touches the equations only */
  PetscCall(DMGlobalToLocalEnd(dm, dx, INSERT_VALUES, du));
  PetscCall(VecZeroEntries(more));
  PetscCall(bulk_along(solve->physics, du, more));
  PetscCall(VecNorm(more, NORM_INFINITY, largest));
  direction.now = du;
  PetscCall(contact_along(solve->contact, &direction, more, status));
  PetscCall(VecAXPY(forces, 1, more));
  PetscCall(VecAXPY(parameter->now, 1, du));
  PetscCall(DMRestoreLocalVector(dm, &more));
  PetscCall(DMRestoreLocalVector(dm, &du));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void add_entry(const Support *support, PetscInt entry, int component, PetscBool owned, void *context)
{
  const Copying *of = context;
  (void)support, (void)owned;
  of->to[component] += of->from[entry]; /* ranks have parts of it, ghosts too */
}

static PetscErrorCode reactions(const Physics *physics, Vec forces, PetscReal reaction[])
{
  Copying of;
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(reaction, 3 * physics->n_supports));
  PetscCall(VecGetArrayRead(forces, &of.from));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    of.to = reaction + 3 * s;
    PetscCall(support_visit(physics, &physics->supports[s], add_entry, &of));
  }
  PetscCall(VecRestoreArrayRead(forces, &of.from));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, reaction, (PetscMPIInt)(3 * physics->n_supports), MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of forces on free displacements nothing is to be left, over the largest of their two parts. */
static PetscErrorCode measure(Solve *solve, PetscReal largest, Vec forces, Vec work)
{
  PetscReal left;
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(work));
  PetscCall(DMLocalToGlobalBegin(solve->mesh->dm, forces, ADD_VALUES, work));
  PetscCall(DMLocalToGlobalEnd(solve->mesh->dm, forces, ADD_VALUES, work));
  PetscCall(VecPointwiseMult(work, work, solve->closing.displacements));
  PetscCall(VecNorm(work, NORM_INFINITY, &left));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  if (largest > 0) solve->sensitivity->imbalance = PetscMax(solve->sensitivity->imbalance, left / largest);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The tangent at the end of the step, ready to solve with: Newton's last one is of the iterate before. */
static PetscErrorCode prepare(Solve *solve, Vec x, KSP *ksp)
{
  PetscFunctionBegin;
  closing_begin(solve, PETSC_FALSE);
  PetscCall(SNESComputeJacobian(solve->snes, x, solve->jacobian, solve->jacobian));
  PetscCall(SNESGetKSP(solve->snes, ksp));
  PetscCall(KSPSetOperators(*ksp, solve->jacobian, solve->jacobian));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode sensitivity_solve(Solve *solve, Vec x, PetscInt *status)
{
  Sensitivity *all = solve->sensitivity;
  DM           dm  = solve->mesh->dm;
  Vec          r, dx;
  KSP          ksp;
  PetscFunctionBegin;
  *status = 0;
  if (!all) PetscFunctionReturn(PETSC_SUCCESS);
  all->imbalance = 0;
  PetscCall(prepare(solve, x, &ksp));
  PetscCall(DMGetGlobalVector(dm, &r));
  PetscCall(DMGetGlobalVector(dm, &dx));
  for (PetscInt p = 0; p < all->n && !*status; p++) {
    Parameter *parameter = &all->parameters[p];
    PetscReal  asked, answered;
    PetscCall(ask(solve, parameter, all->forces, status));
    if (*status) break;
    PetscCall(VecZeroEntries(r));
    PetscCall(DMLocalToGlobalBegin(dm, all->forces, ADD_VALUES, r));
    PetscCall(DMLocalToGlobalEnd(dm, all->forces, ADD_VALUES, r));
    PetscCall(VecZeroEntries(dx));
    PetscCall(redundant_residual(solve, dx, r)); /* what is left out keeps its value */
    PetscCall(VecScale(r, -1));
    PetscCall(VecNorm(r, NORM_INFINITY, &asked));
    PetscCall(KSPSolve(ksp, r, dx));
    PetscCall(answer(solve, parameter, dx, all->forces, &answered, status));
    if (*status) break;
    PetscCall(reactions(solve->physics, all->forces, parameter->reactions));
    PetscCall(measure(solve, PetscMax(asked, answered), all->forces, r));
  }
  PetscCall(DMRestoreGlobalVector(dm, &dx));
  PetscCall(DMRestoreGlobalVector(dm, &r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode sensitivity_accept(Solve *solve)
{
  Sensitivity *all = solve->sensitivity;
  PetscFunctionBegin;
  for (PetscInt p = 0; all && p < all->n; p++)
    PetscCall(VecCopy(all->parameters[p].now, all->parameters[p].last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode sensitivity_archive(Solve *solve, Archive *archive)
{
  Sensitivity *all = solve->sensitivity;
  PetscFunctionBegin;
  for (PetscInt p = 0; all && p < all->n; p++)
    PetscCall(contact_archive_vector(solve->contact, all->parameters[p].name, all->parameters[p].last, archive));
  PetscFunctionReturn(PETSC_SUCCESS);
}
