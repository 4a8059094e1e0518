/* Multipliers whose conditions may follow from others': of nodes that several surfaces have, and of nodes that supports hold. */
#include "solve/redundant.h"
#include <stdlib.h>

/* Over the longest edge of the mortar side; of an analytic one over the root of a node's area */
static const PetscReal LIKE_GAPS = 1e-4;

PetscBool suspects_may_be(const Interface *interface)
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

int suspects_order(const void *one, const void *two)
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
  return suspects_order(one, two);
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

PetscErrorCode suspects_find(const Contact *contact, PetscInt *n_all, Multiplier **all)
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
    if (suspects_may_be(&contact->interfaces[i])) PetscCall(look_at_home(contact, i, surfaces[i], &n, here));
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
