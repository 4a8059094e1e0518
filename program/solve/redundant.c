/* Conditions of contact that follow from others, and multipliers that push on nothing that they do not push on as well.
 *
 * Where interfaces share nodes, and where supports hold nodes of both surfaces, two conditions may say the same: then the matrix is
 * singular, and its solution is made of rounding. They are found in value: the forces of all multipliers on what can move
 * are the columns of C, and one is redundant whose column is a combination of others. Only nodes that several
 * surfaces have and nodes that supports hold can be so: a surface's own nodes that are free tell its multipliers apart. So of N = C^T C all
 * others are eliminated, and dependent.c looks at what is left.
 *
 * Forces of the others can be all that they were: displacements do not change when a redundant multiplier is left out, nor does the
 * sum of the reactions. The library's handle is made anew without it; its unknown is zero. */
#include "solve/redundant.h"
#include <stdlib.h>

/* So many multipliers take a second; more are not looked at, and what a step ends with is looked at alone. */
enum { MOST_SUSPECTS = 1000 };

/* An interface's handle with the components that its nodes have now */
static PetscErrorCode renew(Contact *contact, PetscInt number)
{
  PetscInt status, n;
  double  *all;
  PetscFunctionBegin;
  PetscCall(parts_knowledge(&contact->interfaces[number], &n, &all));
  PetscCall(contact_share_out_at_t_n(contact, number, all, &status));
  PetscCheck(!status, PETSC_COMM_WORLD, PETSC_ERR_LIB, "stickslip, of an interface without redundant multipliers: %s", contact->refusal);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The components of a node at home here that has this multiplier, with it or without. */
static void mark(Contact *contact, const Multiplier *multiplier, PetscBool without)
{
  Interface     *interface = &contact->interfaces[multiplier->interface];
  const PetscInt a = multiplier->number - interface->first[0], all = interface->dimension == 3 ? 7 : 3;
  if (a < 0 || a >= interface->n1) return;
  if (without)
    interface->removed[a] |= interface->components > 1 ? 1 << multiplier->component : 7;
  else
    interface->removed[a] = interface->has_been[a];
  if ((interface->removed[a] & all) == all) interface->removed[a] = 7;
}

/* Where there are more than were told of */
static PetscErrorCode tell(Solve *solve)
{
  Redundant *redundant = &solve->redundant;
  PetscFunctionBegin;
  for (PetscInt k = 0, next; k < redundant->n && redundant->n > redundant->told && !solve->quiet; k = next) {
    const Multiplier *first = &redundant->multipliers[k];
    for (next = k + 1; next < redundant->n && redundant->multipliers[next].interface == first->interface; next++)
      ;
    PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                          "%s: %" PetscInt_FMT " multipliers, the first at (%g, %g, %g), are left out: what they ask follows from other "
                          "conditions of contact and from the supports, and what they push others push as well.\n",
                          solve->contact->interfaces[first->interface].name, next - k, (double)first->X[0], (double)first->X[1],
                          (double)first->X[2]));
  }
  redundant->told = PetscMax(redundant->told, redundant->n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Those of a list that are marked join those left out. */
static PetscErrorCode leave_out(Solve *solve, PetscInt n, const Multiplier suspects[], const PetscBool found[], PetscInt *n_found)
{
  Redundant     *redundant = &solve->redundant;
  const PetscInt before    = redundant->n;
  Multiplier    *all;
  PetscFunctionBegin;
  *n_found = 0;
  for (PetscInt k = 0; k < n; k++)
    *n_found += found[k];
  if (!*n_found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(before + *n_found, &all));
  PetscCall(PetscArraycpy(all, redundant->multipliers, before));
  PetscCall(PetscFree(redundant->multipliers));
  redundant->multipliers = all;
  for (PetscInt k = 0; k < n; k++) {
    if (!found[k]) continue;
    all[redundant->n++] = suspects[k];
    mark(solve->contact, &suspects[k], PETSC_TRUE);
  }
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++) {
    PetscBool any = PETSC_FALSE;
    for (PetscInt k = before; k < redundant->n && !any; k++)
      any = (PetscBool)(all[k].interface == i);
    if (any) PetscCall(renew(solve->contact, i));
  }
  qsort(all, (size_t)redundant->n, sizeof(*all), suspects_order);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode redundant_find(Solve *solve, Vec x, PetscInt *n_found)
{
  PetscInt    n;
  Multiplier *suspects;
  PetscBool  *found;
  PetscFunctionBegin;
  *n_found = 0;
  if (solve->contact->condensed || !solve->contact->n_interfaces) PetscFunctionReturn(PETSC_SUCCESS);
  if (x) PetscCall(unknowns_to_local(solve->physics, x));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++)
    PetscCall(contact_gather(solve->contact, &solve->contact->interfaces[i], solve->physics->u_local));
  PetscCall(contact_collect(solve->contact));
  PetscCall(suspects_find(solve->contact, &n, &suspects));
  solve->redundant.suspected = (PetscBool)(n > 0 || solve->redundant.n > 0);
  PetscCall(PetscMalloc1(n, &found));
  if (n && n <= MOST_SUSPECTS) {
    PetscCall(suspects_judge(solve, n, suspects, found));
    PetscCall(leave_out(solve, n, suspects, found, n_found));
    PetscCall(tell(solve));
  }
  PetscCall(PetscFree(found));
  PetscCall(PetscFree(suspects));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is tied stays what it is. Other bodies move, and other nodes are opposite of each other. */
static PetscErrorCode take_back(Solve *solve, PetscBool *any)
{
  Redundant *redundant = &solve->redundant;
  PetscInt   kept      = 0;
  PetscBool *changed;
  PetscFunctionBegin;
  *any = PETSC_FALSE;
  PetscCall(PetscCalloc1(solve->contact->n_interfaces, &changed));
  for (PetscInt k = 0; k < redundant->n; k++) {
    const Multiplier multiplier = redundant->multipliers[k];
    if (multiplier.tied || solve->contact->interfaces[multiplier.interface].frozen) {
      redundant->multipliers[kept++] = multiplier;
      continue;
    }
    mark(solve->contact, &multiplier, PETSC_FALSE);
    changed[multiplier.interface] = *any = PETSC_TRUE;
  }
  redundant->n = kept;
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++) {
    if (changed[i]) PetscCall(renew(solve->contact, i));
  }
  PetscCall(PetscFree(changed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode redundant_begin(Solve *solve, Vec t_n)
{
  PetscInt  n_found;
  PetscBool any;
  PetscFunctionBegin;
  PetscCall(take_back(solve, &any));
  if (any) PetscCall(redundant_find(solve, t_n, &n_found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode redundant_residual(const Solve *solve, Vec x, Vec r)
{
  const Redundant   *redundant = &solve->redundant;
  const PetscScalar *values;
  PetscScalar       *rows;
  PetscInt           first, end;
  PetscFunctionBegin;
  if (!redundant->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetOwnershipRange(r, &first, &end));
  PetscCall(VecGetArrayRead(x, &values));
  PetscCall(VecGetArray(r, &rows));
  for (PetscInt k = 0; k < redundant->n; k++) {
    const PetscInt row = redundant->multipliers[k].equation;
    if (row >= first && row < end) rows[row - first] = solve->stiffness * values[row - first];
  }
  PetscCall(VecRestoreArray(r, &rows));
  PetscCall(VecRestoreArrayRead(x, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode redundant_rows(const Solve *solve, Mat matrix)
{
  const Redundant *redundant = &solve->redundant;
  PetscInt         first, end;
  PetscFunctionBegin;
  PetscCall(MatGetOwnershipRange(matrix, &first, &end));
  for (PetscInt k = 0; k < redundant->n; k++) {
    const PetscInt row = redundant->multipliers[k].equation;
    if (row >= first && row < end) PetscCall(MatSetValue(matrix, row, row, solve->stiffness, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode redundant_destroy(Solve *solve)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(solve->redundant.multipliers));
  solve->redundant = (Redundant){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
