/* With normals of t_n a pressure acts along those although a step has turned the surface. Where that shows, a converged step is solved again
 * with the normals that it has reached, as the host's own (stickslip_interface_set_normals), and again, until they stay. Each solution
 * begins at the last one and takes few iterations. What the library knows of normals at a place is what a commit there would make of them: it
 * is asked so, and the commit rolled back. */
#include "contact/contact.h"

/* Part of the force of an interface that is wrong by more than its mesh shows: the step is solved again. So it is where a node is as far off
 * as is refused. */
static const PetscReal LAGS = 0.02;
/* What normals may still be wrong by then: friction, which may be a tenth of the pressure, is right to that part. */
static const PetscReal LEFT = 2e-3;

/* Bounds of the part of the way to normals of now that the next ones go. */
static const PetscReal SHORTEST = 0.1, LONGEST = 2;

/* Does the interface take other normals? In dynamics those of t_n are part of what keeps the energy (docs/dynamics.md); where points decide with
 * friction these remember tractions of t_n, and only shorter steps turn them less (slide.c). */
static PetscBool may_be_corrected(const Contact *contact, const Interface *interface)
{
  const stickslip_options *options = &interface->options;
  const stickslip_method  *method  = &interface->method;
  if (decision_is_points(interface) && options->friction != STICKSLIP_FRICTION_NONE) return PETSC_FALSE;
  return (PetscBool)(interface->lag_corrects && !contact->physics->dynamics && options->friction != STICKSLIP_FRICTION_TIED &&
                     method->normals == STICKSLIP_NORMALS_COMMITTED && method->weights != STICKSLIP_WEIGHTS_REFERENCE);
}

/* At a converged state that the interfaces have been judged at. */
PetscErrorCode lag_shows(const Contact *contact, PetscBool *shows)
{
  PetscReal forces[2];
  PetscFunctionBegin;
  *shows = PETSC_FALSE;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface             *interface = &contact->interfaces[i];
    const stickslip_equilibrium *e         = &interface->equilibrium;
    if (!may_be_corrected(contact, interface)) continue;
    forces[0] = verb_there(&interface->part) ? e->lag_force : 0;
    forces[1] = verb_there(&interface->part) ? e->lag_force_scale : 0;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, forces, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
    *shows = (PetscBool)(*shows || forces[0] > LAGS * forces[1] || (verb_there(&interface->part) && e->lag > interface->lag.most * e->traction_scale));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, shows, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is known of a node at home: the normal in use, that of now, and the force that acts there. */
enum { USED, NOW = 3, FORCE = 6, N_KNOWN };

/* Of a part, N_KNOWN numbers a node. Returns the library's status. */
static int32_t find(ContactPart *part, double known[])
{
  const PetscInt   d = part->dimension, n1 = part->n1;
  stickslip_states used = {.struct_size = sizeof(used)}, now = {.struct_size = sizeof(now)};
  int32_t          status;
  PetscCallAbort(PETSC_COMM_SELF, PetscMalloc4(d * n1, &used.normal, d * n1, &used.traction, n1, &used.coverage, d * n1, &now.normal));
  status = stickslip_interface_states(part->handle, STATE_OF(part), NULL, &used);
  if (!status) status = stickslip_interface_commit(part->handle, STATE_OF(part), NULL);
  if (!status) {
    PetscCallStickslip(stickslip_interface_set_normals(part->handle, NULL));
    status = stickslip_interface_states(part->handle, STATE_OF(part), NULL, &now);
    PetscCallStickslip(stickslip_interface_rollback(part->handle));
  }
  for (PetscInt a = 0; a < n1 && !status; a++) {
    double *of = known + N_KNOWN * a, p[3];
    contact_vector(d, used.traction, a, p);
    contact_vector(d, used.normal, a, of + USED);
    contact_vector(d, now.normal, a, of + NOW);
    of[FORCE] = PetscSqrtReal(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) * used.coverage[a];
  }
  PetscCallAbort(PETSC_COMM_SELF, PetscFree4(used.normal, used.traction, used.coverage, now.normal));
  return status;
}

/* From all parts to homes; `refused`: by the library, on any rank. */
static PetscErrorCode collect(Contact *contact, Interface *interface, double known[], PetscInt *refused)
{
  ContactPart *part = &interface->part;
  int32_t      status = 0;
  double      *here;
  PetscFunctionBegin;
  PetscCall(contact_gather(contact, interface, contact->physics->u_local));
  PetscCall(PetscCalloc1(N_KNOWN * part->n1, &here));
  if (part->handle) status = find(part, here);
  PetscCall(contact_agree(contact, interface, status, refused));
  PetscCall(parts_collect(part, N_KNOWN, here, known));
  PetscCall(PetscFree(here));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What normals in use are wrong by, beside the last time's: sums over the nodes, by force. */
typedef struct {
  PetscReal wrong, forces;   /* sums of change times force, of forces */
  PetscReal product, square; /* of the last time's with how it has changed since; of that */
} Change;

static void add_change(const Interface *interface, const double known[], Change *change)
{
  for (PetscInt a = 0; a < interface->n1; a++) {
    const double *of = known + N_KNOWN * a;
    double        size = 0;
    for (int k = 0; k < 3; k++) {
      const double r = of[NOW + k] - of[USED + k], before = interface->lag_change ? interface->lag_change[3 * a + k] : 0;
      size += r * r;
      change->product += of[FORCE] * before * (r - before);
      change->square += of[FORCE] * (r - before) * (r - before);
    }
    change->wrong += of[FORCE] * PetscSqrtReal(size);
    change->forces += of[FORCE];
  }
}

/* The next normals, at homes: by a part of the way. */
static PetscErrorCode move(Interface *interface, const double known[], PetscReal part)
{
  const PetscInt d = interface->dimension;
  PetscFunctionBegin;
  if (!interface->normals) PetscCall(PetscMalloc2(d * interface->n1, &interface->normals, 3 * interface->n1, &interface->lag_change));
  for (PetscInt a = 0; a < interface->n1; a++) {
    const double *of = known + N_KNOWN * a;
    double        next[3], size = 0;
    for (int k = 0; k < 3; k++) {
      interface->lag_change[3 * a + k] = of[NOW + k] - of[USED + k];
      next[k]                          = of[USED + k] + part * (of[NOW + k] - of[USED + k]);
      size += next[k] * next[k];
    }
    for (int k = 0; k < d; k++)
      interface->normals[d * a + k] = next[k] / PetscSqrtReal(size);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of any handle of the interface's part: the normals of the step, from homes. */
PetscErrorCode lag_set(const Interface *interface, stickslip_interface *handle, int32_t *refused)
{
  const ContactPart *part = &interface->part;
  const PetscInt     d    = part->dimension;
  double            *normals;
  PetscFunctionBegin;
  *refused = 0;
  if (!interface->normals) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(d * part->n1, &normals));
  PetscCall(parts_send(part, d, interface->normals, normals));
  PetscCall(parts_share(part, d, normals));
  if (handle) *refused = stickslip_interface_set_normals(handle, normals);
  PetscCall(PetscFree(normals));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At a converged state, on all ranks: what the normals in use are wrong by; and, where that is more than may be left, other ones for what comes, if
 * they `may` `change`. They are those of now
 * but for a factor on the way there, Aitken's: a shaft that friction twists turns back by as much as its normals were behind, and would
 * come and go for ever. */
PetscErrorCode lag_take_normals(Contact *contact, PetscBool may, PetscBool *changed)
{
  Change    change  = {0};
  PetscInt  refused = 0, n = 0;
  double   *known, *of;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    n += contact->interfaces[i].n1;
  PetscCall(PetscMalloc1(N_KNOWN * n, &known));
  of = known;
  for (PetscInt i = 0; i < contact->n_interfaces && !refused; of += N_KNOWN * contact->interfaces[i++].n1) {
    if (!may_be_corrected(contact, &contact->interfaces[i])) continue;
    PetscCall(collect(contact, &contact->interfaces[i], of, &refused));
    add_change(&contact->interfaces[i], of, &change);
  }
  contact->refusal[0] = 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &change, sizeof(change) / sizeof(PetscReal), MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  contact->lag_left = change.forces > 0 ? change.wrong / change.forces : 0;
  *changed          = (PetscBool)(may && !refused && contact->lag_left > LEFT);
  contact->lag_part = contact->lag_part > 0 && change.square > 0 ? -contact->lag_part * change.product / change.square : 1;
  contact->lag_part = PetscMin(LONGEST, PetscMax(SHORTEST, contact->lag_part));
  of = known;
  for (PetscInt i = 0; i < contact->n_interfaces; of += N_KNOWN * contact->interfaces[i++].n1) {
    Interface *interface = &contact->interfaces[i];
    int32_t    status;
    if (!may_be_corrected(contact, interface)) continue;
    if (*changed) PetscCall(move(interface, of, contact->lag_part));
    PetscCall(lag_set(interface, interface->part.handle, &status));
    PetscCheck(!status, PETSC_COMM_SELF, PETSC_ERR_LIB, "stickslip: %s", stickslip_last_error_message());
  }
  PetscCall(PetscFree(known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step is over: normals of t_n from now on. */
PetscErrorCode lag_forget(Contact *contact)
{
  PetscFunctionBegin;
  contact->lag_part = contact->lag_left = 0;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    Interface *interface = &contact->interfaces[i];
    if (!interface->normals) continue;
    PetscCall(PetscFree2(interface->normals, interface->lag_change));
    if (interface->part.handle) PetscCallStickslip(stickslip_interface_set_normals(interface->part.handle, NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
