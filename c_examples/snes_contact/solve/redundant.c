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
#include "solve/direct.h"
#include <stdlib.h>

/* So many multipliers take a second; more are not looked at, and what a step ends with is looked at alone. */
enum { MOST_SUSPECTS = 1000 };
/* Over the longest edge of the mortar side; of an analytic one over the root of a node's area */
static const PetscReal LIKE_GAPS = 1e-4;

/* Only these have forces that are a multiplier's times weights. */
static PetscBool may_have(const Interface *interface)
{
  return (PetscBool)(!interface->skin && interface->method.form == STICKSLIP_FORM_MULTIPLIER && !decision_is_points(interface));
}

static PetscBool has_component(const Interface *interface, PetscInt node, PetscInt component)
{
  const PetscInt removed = interface->removed[node];
  return (PetscBool)!(interface->components > 1 ? (removed >> component) & 1 : removed == 7);
}

/* Copies of a node on a crease count as one surface where multipliers are dual and nodes may be carried: the library lets one of them speak
 * for all that have one face opposite, and what is left out here it cannot put together. Which of them is covered does not matter then. */
static PetscBool counts(const Interface *interface, PetscInt node)
{
  const stickslip_method *method     = &interface->method;
  const PetscBool         told_apart = (PetscBool)(method->multiplier_basis == STICKSLIP_BASIS_DUAL &&
                                           method->weak_coverage != STICKSLIP_WEAK_COVERAGE_NONE);
  if (interface->n_copies && told_apart) return (PetscBool)(interface->copies[node] == 0);
  return (PetscBool)(interface->states.coverage[node] > 0);
}

/* In how many surfaces of interfaces each non-mortar node is, where these cover it; one array an interface. */
static PetscErrorCode count_surfaces(const Contact *contact, PetscInt *surfaces[])
{
  PetscInt  n = 0, n_here, at = 0, *nodes, *ones, *sums;
  PetscSF   directory;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    n += contact->interfaces[i].n1 + contact->interfaces[i].n2;
  PetscCall(PetscMalloc2(n, &nodes, n, &ones));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    for (PetscInt k = 0; k < interface->n1 + interface->n2; k++, at++) {
      nodes[at] = interface->nodes[k];
      ones[at]  = k >= interface->n1 || counts(interface, k);
    }
  }
  PetscCall(directory_create(contact->mesh, n, nodes, &n_here, &directory));
  PetscCall(PetscCalloc1(n_here, &sums));
  PetscCall(PetscSFReduceBegin(directory, MPIU_INT, ones, sums, MPI_SUM));
  PetscCall(PetscSFReduceEnd(directory, MPIU_INT, ones, sums, MPI_SUM));
  PetscCall(PetscSFBcastBegin(directory, MPIU_INT, sums, ones, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(directory, MPIU_INT, sums, ones, MPI_REPLACE));
  at = 0;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    PetscCall(PetscMalloc1(interface->n1, &surfaces[i]));
    PetscCall(PetscArraycpy(surfaces[i], ones + at, interface->n1));
    at += interface->n1 + interface->n2;
  }
  PetscCall(PetscSFDestroy(&directory));
  PetscCall(PetscFree(sums));
  PetscCall(PetscFree2(nodes, ones));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int compare(const void *one, const void *two)
{
  const Multiplier *a = one, *b = two;
  if (a->interface != b->interface) return a->interface < b->interface ? -1 : 1;
  if (a->number != b->number) return a->number < b->number ? -1 : 1;
  return (a->component > b->component) - (a->component < b->component);
}

/* Those first that stay: of two floors under a block it is the upper one, which is less open; what supports hold gives way to what is
 * free. Gaps that differ by rounding are like gaps. Of those a node that one surface has stays, be it held along the surface: where it is left
 * out for the sake of one that several have, what is left has to pull there to press evenly. */
static int compare_strength(const void *one, const void *two)
{
  const Multiplier *a = one, *b = two;
  if (a->held != b->held) return a->held ? 1 : -1;
  if (a->steps_open != b->steps_open) return a->steps_open < b->steps_open ? -1 : 1;
  if (a->shared != b->shared) return a->shared ? 1 : -1;
  return compare(one, two);
}

/* of this rank's nodes at home */
static PetscErrorCode look_at_home(const Contact *contact, PetscInt number, const PetscInt surfaces[], PetscInt *n, Multiplier found[])
{
  const Interface *interface = &contact->interfaces[number];
  const PetscReal  edge = interface->longest_edge;
  const PetscInt   c = interface->components, field = 1 + number, all = interface->dimension == 3 ? 7 : 3;
  const PetscInt  *nodes = interface->nodes, *copies = interface->copies;
  int64_t         *equations;
  PetscSF          sf;
  PetscFunctionBegin;
  PetscCall(unknowns_gather_create(contact->physics, 1, &interface->n1, &nodes, &copies, &field, &c, &sf));
  PetscCall(PetscMalloc1(c * interface->n1, &equations));
  PetscCall(contact_equations(contact, sf, c * interface->n1, equations));
  for (PetscInt k = 0; k < c * interface->n1; k++) {
    const PetscInt a = k / c;
    Multiplier    *m = &found[*n];
    if (equations[k] < 0 || !has_component(interface, a, k % c) || !(interface->states.coverage[a] > 0)) continue;
    if (surfaces[a] < 2 && !(interface->prescribed[a] & all)) continue;
    *m = (Multiplier){.equation = (PetscInt)equations[k], .interface = number, .number = homes_number(interface, a), .component = k % c};
    m->coverage = interface->states.coverage[a];
    m->tied     = (PetscBool)(interface->options.friction == STICKSLIP_FRICTION_TIED);
    m->shared   = (PetscBool)(surfaces[a] >= 2);
    m->held     = (PetscBool)(m->tied ? (interface->prescribed[a] >> m->component) & 1 : (interface->prescribed[a] & all) == all);
    if (m->tied) {
      m->steps_open = 0;
    } else { /* what is analytic has no edges */
      const PetscReal step = LIKE_GAPS * (edge > 0 ? edge : PetscSqrtReal(m->coverage));
      m->steps_open        = PetscFloorReal(interface->states.gap[a] / m->coverage / step + 0.5);
    }
    contact_vector(interface->dimension, interface->X, a, m->X);
    (*n)++;
  }
  PetscCall(PetscFree(equations));
  PetscCall(PetscSFDestroy(&sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Those that may be redundant, of all ranks, in order; to be freed. */
static PetscErrorCode find_suspects(const Contact *contact, PetscInt *n_all, Multiplier **all)
{
  PetscInt   **surfaces, n = 0, most = 0;
  Multiplier  *here;
  PetscMPIInt  size, *bytes, *offsets, mine;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    most += contact->interfaces[i].components * contact->interfaces[i].n1;
  PetscCall(PetscMalloc1(contact->n_interfaces, &surfaces));
  PetscCall(PetscMalloc1(most + 1, &here));
  PetscCall(PetscMalloc2(size, &bytes, size + 1, &offsets));
  PetscCall(count_surfaces(contact, surfaces));
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    if (may_have(&contact->interfaces[i])) PetscCall(look_at_home(contact, i, surfaces[i], &n, here));
    PetscCall(PetscFree(surfaces[i]));
  }
  mine = (PetscMPIInt)(n * (PetscInt)sizeof(*here));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, bytes, 1, MPI_INT, PETSC_COMM_WORLD));
  offsets[0] = 0;
  for (PetscMPIInt r = 0; r < size; r++)
    offsets[r + 1] = offsets[r] + bytes[r];
  *n_all = offsets[size] / (PetscInt)sizeof(*here);
  PetscCall(PetscMalloc1(*n_all, all));
  PetscCallMPI(MPI_Allgatherv(here, mine, MPI_BYTE, *all, bytes, offsets, MPI_BYTE, PETSC_COMM_WORLD));
  qsort(*all, (size_t)*n_all, sizeof(**all), compare_strength);
  PetscCall(PetscFree2(bytes, offsets));
  PetscCall(PetscFree(here));
  PetscCall(PetscFree(surfaces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Equations that this rank owns, of displacements and of multipliers */
static PetscErrorCode split(const Solve *solve, IS *displacements, IS *multipliers)
{
  const PetscScalar *is_displacement;
  PetscInt           n, first, counts[2] = {0, 0}, *equations[2];
  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(solve->closing.displacements, &n));
  PetscCall(VecGetOwnershipRange(solve->closing.displacements, &first, NULL));
  PetscCall(PetscMalloc1(n, &equations[0]));
  PetscCall(PetscMalloc1(n, &equations[1]));
  PetscCall(VecGetArrayRead(solve->closing.displacements, &is_displacement));
  for (PetscInt k = 0; k < n; k++) {
    const int kind                  = PetscRealPart(is_displacement[k]) == 0;
    equations[kind][counts[kind]++] = first + k;
  }
  PetscCall(VecRestoreArrayRead(solve->closing.displacements, &is_displacement));
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, counts[0], equations[0], PETSC_OWN_POINTER, displacements));
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, counts[1], equations[1], PETSC_OWN_POINTER, multipliers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* C^T C at u_local, in the order of `multipliers`; NULL: the library refuses */
static PetscErrorCode products(Solve *solve, IS displacements, IS multipliers, Mat *N)
{
  PetscInt status;
  Mat      tangent, C;
  PetscFunctionBegin;
  *N = NULL;
  PetscCall(MatDuplicate(solve->pattern, MAT_DO_NOT_COPY_VALUES, &tangent));
  PetscCall(contact_tangent(solve->contact, tangent, &status));
  PetscCall(MatAssemblyBegin(tangent, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(tangent, MAT_FINAL_ASSEMBLY));
  if (!status) {
    PetscCall(MatCreateSubMatrix(tangent, displacements, multipliers, MAT_INITIAL_MATRIX, &C));
    PetscCall(MatTransposeMatMult(C, C, MAT_INITIAL_MATRIX, PETSC_DEFAULT, N));
    PetscCall(MatDestroy(&C));
  }
  PetscCall(MatDestroy(&tangent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows and columns of N: the suspects', and the others' that cover anything. `order`: of each suspect its number among them, as they lie on
 * the ranks */
static PetscErrorCode divide(Mat N, IS multipliers, PetscInt n, const Multiplier suspects[], PetscInt order[], IS *suspect, IS *others)
{
  const PetscInt    *equations;
  const PetscScalar *values;
  PetscInt           n_mine, first, n_suspects = 0, n_others = 0, before = 0, *rows[2], *suspect_at;
  Vec                diagonal;
  PetscFunctionBegin;
  PetscCall(ISGetLocalSize(multipliers, &n_mine));
  PetscCall(ISGetIndices(multipliers, &equations));
  PetscCall(MatGetOwnershipRange(N, &first, NULL));
  PetscCall(MatCreateVecs(N, &diagonal, NULL));
  PetscCall(MatGetDiagonal(N, diagonal));
  PetscCall(VecGetArrayRead(diagonal, &values));
  PetscCall(PetscMalloc1(n, &rows[0]));
  PetscCall(PetscMalloc1(n_mine, &rows[1]));
  PetscCall(PetscMalloc1(n_mine, &suspect_at));
  for (PetscInt k = 0; k < n_mine; k++)
    suspect_at[k] = -1;
  for (PetscInt k = 0; k < n; k++) {
    PetscInt at;
    order[k] = -1;
    PetscCall(PetscFindInt(suspects[k].equation, n_mine, equations, &at));
    if (at >= 0) suspect_at[at] = k;
  }
  for (PetscInt k = 0; k < n_mine; k++) { /* PETSc wants rows and columns in order */
    if (suspect_at[k] >= 0) {
      order[suspect_at[k]]  = n_suspects;
      rows[0][n_suspects++] = first + k;
    } else if (PetscRealPart(values[k]) > 0) {
      rows[1][n_others++] = first + k;
    }
  }
  PetscCallMPI(MPI_Exscan(&n_suspects, &before, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt k = 0; k < n; k++)
    order[k] = order[k] < 0 ? 0 : order[k] + before;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, order, (PetscMPIInt)n, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, n_suspects, rows[0], PETSC_OWN_POINTER, suspect));
  PetscCall(ISCreateGeneral(PETSC_COMM_WORLD, n_others, rows[1], PETSC_OWN_POINTER, others));
  PetscCall(PetscFree(suspect_at));
  PetscCall(VecRestoreArrayRead(diagonal, &values));
  PetscCall(VecDestroy(&diagonal));
  PetscCall(ISRestoreIndices(multipliers, &equations));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* S <- S - B^T A^-1 B with the others' A: what no combination of them gives */
static PetscErrorCode eliminate_others(Mat N, IS suspects, IS others, Mat S)
{
  Mat A, sparse, B, X, taken;
  KSP ksp;
  PetscFunctionBegin;
  PetscCall(MatCreateSubMatrix(N, others, others, MAT_INITIAL_MATRIX, &A));
  PetscCall(MatCreateSubMatrix(N, others, suspects, MAT_INITIAL_MATRIX, &sparse));
  PetscCall(MatConvert(sparse, MATDENSE, MAT_INITIAL_MATRIX, &B));
  PetscCall(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(direct_set(ksp));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPMatSolve(ksp, B, X));
  PetscCall(MatTransposeMatMult(B, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &taken));
  PetscCall(MatAXPY(S, -1, taken, SAME_NONZERO_PATTERN));
  PetscCall(MatDestroy(&taken));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(MatDestroy(&X));
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&sparse));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A dense matrix on all ranks, its rows and columns in this order; by rows */
static PetscErrorCode gather(Mat S, PetscInt n, const PetscInt order[], PetscReal values[])
{
  PetscFunctionBegin;
  for (PetscInt j = 0; j < n; j++) {
    const PetscScalar *entries;
    VecScatter         scatter;
    Vec                column, all;
    PetscCall(MatDenseGetColumnVecRead(S, order[j], &column));
    PetscCall(VecScatterCreateToAll(column, &scatter, &all));
    PetscCall(VecScatterBegin(scatter, column, all, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterEnd(scatter, column, all, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecGetArrayRead(all, &entries));
    for (PetscInt i = 0; i < n; i++)
      values[n * i + j] = PetscRealPart(entries[order[i]]);
    PetscCall(VecRestoreArrayRead(all, &entries));
    PetscCall(VecScatterDestroy(&scatter));
    PetscCall(VecDestroy(&all));
    PetscCall(MatDenseRestoreColumnVecRead(S, order[j], &column));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which suspects are redundant, at u_local. */
static PetscErrorCode judge(Solve *solve, PetscInt n, const Multiplier suspects[], PetscBool redundant[])
{
  IS         displacements, multipliers, suspect, others;
  PetscInt  *order, n_others;
  PetscReal *values;
  Mat        N, sparse, S;
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(redundant, n));
  PetscCall(split(solve, &displacements, &multipliers));
  PetscCall(products(solve, displacements, multipliers, &N));
  if (N) {
    PetscCall(PetscMalloc2(n, &order, n * n, &values));
    PetscCall(divide(N, multipliers, n, suspects, order, &suspect, &others));
    PetscCall(MatCreateSubMatrix(N, suspect, suspect, MAT_INITIAL_MATRIX, &sparse));
    PetscCall(MatConvert(sparse, MATDENSE, MAT_INITIAL_MATRIX, &S));
    PetscCall(ISGetSize(others, &n_others));
    if (n_others) PetscCall(eliminate_others(N, suspect, others, S));
    PetscCall(gather(S, n, order, values));
    dependent_find(n, suspects, values, redundant);
    PetscCallMPI(MPI_Bcast(redundant, (PetscMPIInt)n, MPIU_BOOL, 0, PETSC_COMM_WORLD)); /* sums may be rounded otherwise elsewhere */
    PetscCall(MatDestroy(&S));
    PetscCall(MatDestroy(&sparse));
    PetscCall(ISDestroy(&suspect));
    PetscCall(ISDestroy(&others));
    PetscCall(PetscFree2(order, values));
    PetscCall(MatDestroy(&N));
  }
  PetscCall(ISDestroy(&displacements));
  PetscCall(ISDestroy(&multipliers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
  qsort(all, (size_t)redundant->n, sizeof(*all), compare);
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
  PetscCall(find_suspects(solve->contact, &n, &suspects));
  solve->redundant.suspected = (PetscBool)(n > 0 || solve->redundant.n > 0);
  PetscCall(PetscMalloc1(n, &found));
  if (n && n <= MOST_SUSPECTS) {
    PetscCall(judge(solve, n, suspects, found));
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
