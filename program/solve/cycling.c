/* Which nodes change state for ever? Newton's method on contact goes from one guess of the nodal states (gap, stick,
 * slip) to the next. Where it comes back to an earlier guess while the residual does not fall, it will do so again
 * and again.
 *
 * The states of all non-mortar nodes are kept for the last iterations. Slip one way and slip back are two
 * states: slip that turns round in every iteration is the commonest cycle of all under a large augmentation. A cycle
 * of period p is found when the last p sets of states, CONVINCING of them where it is longer than that, repeat those p iterations before, no
 * shorter period does, and the residual has not fallen below FALLING of what it was p iterations ago. Each rank keeps the nodes that are at home there, and all
 * agree. */
#include "solve/solve.h"
#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

enum { SHORTEST = 2, LONGEST = 16, CONVINCING = 4, WINDOW = LONGEST + CONVINCING, NODES_IN_SENTENCE = 4 };
/* A quadratic or even a linear convergence at a useful pace falls faster; a cycle on linear pieces does not fall at
 * all. */
static const PetscReal FALLING = 0.5;

/* by STICKSLIP_STATE_*, and beyond: */
enum { SLIP_BACK = 3 };
static const char *const STATE_NAMES[] = {"gap", "stick", "slip", "slip back"};

struct Cycling {
  PetscInt  n_nodes, n; /* non-mortar nodes of all interfaces at home here; sets of states since cycling_restart() */
  int32_t  *states;     /* WINDOW x n_nodes; iteration k in row k % WINDOW */
  double   *tangential; /* 3 n_nodes: tangential tractions of the last iteration */
  double   *first;      /* 3 n_nodes: those of its first slip since cycling_restart(), or 0 */
  PetscReal norms[WINDOW];
};

PetscErrorCode cycling_create(Solve *solve)
{
  Cycling *cycling;
  PetscFunctionBegin;
  PetscCall(PetscNew(&cycling));
  for (PetscInt i = 0; i < solve->contact->n_interfaces; i++)
    cycling->n_nodes += solve->contact->interfaces[i].n1;
  PetscCall(PetscMalloc3(WINDOW * cycling->n_nodes, &cycling->states, 3 * cycling->n_nodes, &cycling->tangential,
                         3 * cycling->n_nodes, &cycling->first));
  solve->cycling = cycling;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode cycling_destroy(Solve *solve)
{
  PetscFunctionBegin;
  if (!solve->cycling) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3(solve->cycling->states, solve->cycling->tangential, solve->cycling->first));
  PetscCall(PetscFree(solve->cycling));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode cycling_restart(Solve *solve)
{
  PetscFunctionBegin;
  solve->cycling->n = 0;
  PetscCall(PetscArrayzero(solve->cycling->first, 3 * solve->cycling->n_nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void tell_slip_from_slip_back(const Cycling *cycling, int32_t *states)
{
  for (PetscInt node = 0; node < cycling->n_nodes; node++) {
    const double *now   = cycling->tangential + 3 * node;
    double       *first = cycling->first + 3 * node, dot = 0;
    if (states[node] != STICKSLIP_STATE_SLIP) continue;
    for (int k = 0; k < 3; k++)
      dot += now[k] * first[k];
    if (dot < 0) states[node] = SLIP_BACK;
    if (dot == 0) memcpy(first, now, 3 * sizeof(*first));
  }
}

/* the states `back` iterations ago */
static const int32_t *row(const Cycling *cycling, PetscInt back)
{
  return cycling->states + (cycling->n - 1 - back) % WINDOW * cycling->n_nodes;
}

/* with period 1 up to LONGEST, of all nodes */
static PetscErrorCode find_repeats(const Cycling *cycling, PetscBool repeats[LONGEST + 1])
{
  PetscFunctionBegin;
  repeats[0] = PETSC_TRUE;
  for (PetscInt period = 1; period <= LONGEST; period++) {
    const PetscInt sets = PetscMin(period, CONVINCING);
    repeats[period]     = (PetscBool)(cycling->n >= period + sets);
    for (PetscInt back = 0; back < sets && repeats[period]; back++)
      repeats[period] = (PetscBool)!memcmp(row(cycling, back), row(cycling, back + period), (size_t)cycling->n_nodes * sizeof(int32_t));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, repeats, LONGEST + 1, MPIU_BOOL, MPI_LAND, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode find_period(const Cycling *cycling, PetscInt *period)
{
  PetscBool repeats[LONGEST + 1];
  PetscFunctionBegin;
  PetscCall(find_repeats(cycling, repeats));
  *period = 0;
  for (PetscInt p = SHORTEST; p <= LONGEST && !repeats[1] && !*period; p++) { /* with 1 the states stand still */
    if (repeats[p] && cycling->norms[(cycling->n - 1) % WINDOW] > FALLING * cycling->norms[(cycling->n - 1 - p) % WINDOW]) *period = p;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* nodes whose state differs from that of the iteration before, for the report */
static PetscErrorCode count_changes(Solve *solve)
{
  const Cycling *cycling = solve->cycling;
  PetscInt       changes = 0;
  PetscFunctionBegin;
  for (PetscInt node = 0; node < cycling->n_nodes; node++)
    changes += row(cycling, 0)[node] != row(cycling, 1)[node];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &changes, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  cJSON_AddItemToArray(solve->newton.state_changes, cJSON_CreateNumber(changes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode cycling_record(Solve *solve, PetscReal norm, PetscInt *period)
{
  Cycling *cycling = solve->cycling;
  int32_t *states  = cycling->states + cycling->n % WINDOW * cycling->n_nodes;
  PetscFunctionBegin;
  PetscCall(contact_tendencies(solve->contact, states, cycling->tangential));
  tell_slip_from_slip_back(cycling, states);
  cycling->norms[cycling->n % WINDOW] = norm;
  cycling->n++;
  if (cycling->n > 1) PetscCall(count_changes(solve));
  PetscCall(find_period(cycling, period));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool node_changes(const Cycling *cycling, PetscInt node, PetscInt span)
{
  for (PetscInt back = 1; back < span; back++) {
    if (row(cycling, back)[node] != row(cycling, 0)[node]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* A node that changes state, on its way to rank 0. */
typedef struct {
  PetscReal X[3];
  PetscInt  interface, node, states[LONGEST]; /* the last of which is that of now */
} Change;

/* Those here; `found` is to be freed. */
static PetscErrorCode list_changes(const Solve *solve, PetscInt span, PetscInt *n, Change **found)
{
  const Contact *contact = solve->contact;
  const Cycling *cycling = solve->cycling;
  PetscInt       node    = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(cycling->n_nodes, found));
  *n = 0;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const Interface *interface = &contact->interfaces[i];
    for (PetscInt a = 0; a < interface->n1; a++, node++) {
      Change change = {.interface = i, .node = interface->nodes[a]};
      if (!node_changes(cycling, node, span)) continue;
      contact_vector(interface->dimension, interface->X, a, change.X);
      for (PetscInt back = span - 1; back >= 0; back--)
        change.states[span - 1 - back] = row(cycling, back)[node];
      (*found)[(*n)++] = change;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From all ranks, one after the other, on rank 0. */
static PetscErrorCode gather_changes(const Mesh *mesh, PetscInt n, const Change mine[], PetscInt *n_all, Change **all)
{
  const PetscMPIInt bytes = (PetscMPIInt)(n * (PetscInt)sizeof(Change));
  PetscMPIInt      *counts, *starts, total = 0;
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(mesh->size, &counts, mesh->size, &starts));
  PetscCallMPI(MPI_Gather(&bytes, 1, MPI_INT, counts, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0; r < mesh->size; r++) {
    starts[r] = total;
    total += counts[r];
  }
  *n_all = total / (PetscInt)sizeof(Change);
  PetscCall(PetscMalloc1(*n_all, all));
  PetscCallMPI(MPI_Gatherv(mine, bytes, MPI_BYTE, *all, counts, starts, MPI_BYTE, 0, PETSC_COMM_WORLD));
  PetscCall(PetscFree2(counts, starts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "node 7 at (0, 0, 1): stick, slip" */
static void add_to_sentence(const Contact *contact, const Change *change, PetscInt span, char *sentence, size_t length)
{
  size_t used = strlen(sentence);
  snprintf(sentence + used, length - used, "%s %s node %d at (%g, %g, %g):", used ? ";" : "", contact->interfaces[change->interface].name,
           (int)change->node, (double)change->X[0], (double)change->X[1], (double)change->X[2]);
  for (PetscInt k = 0; k < span; k++) {
    used = strlen(sentence);
    snprintf(sentence + used, length - used, " %s%s", STATE_NAMES[change->states[k]], k < span - 1 ? "," : "");
  }
}

static cJSON *node_json(const Contact *contact, const Change *change, PetscInt span)
{
  cJSON *json = cJSON_CreateObject(), *states;
  cJSON_AddStringToObject(json, "interface", contact->interfaces[change->interface].name);
  cJSON_AddNumberToObject(json, "node", change->node);
  cJSON_AddItemToObject(json, "position", cJSON_CreateDoubleArray(change->X, 3));
  states = cJSON_AddArrayToObject(json, "states");
  for (PetscInt k = 0; k < span; k++)
    cJSON_AddItemToArray(states, cJSON_CreateString(STATE_NAMES[change->states[k]]));
  return json;
}

/* rank 0, which has all of them */
static void describe(const Solve *solve, PetscInt period, PetscInt span, PetscInt n, const Change changes[], cJSON *parent, char sentence[],
                     size_t length)
{
  const Contact *contact  = solve->contact;
  cJSON         *nodes    = cJSON_CreateArray();
  PetscInt       changing = 0;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    for (PetscInt k = 0; k < n; k++) {
      if (changes[k].interface != i) continue;
      if (changing++ < NODES_IN_SENTENCE) add_to_sentence(contact, &changes[k], span, sentence, length);
      cJSON_AddItemToArray(nodes, node_json(contact, &changes[k], span));
    }
  }
  if (changing > NODES_IN_SENTENCE) {
    const size_t used = strlen(sentence);
    snprintf(sentence + used, length - used, "; and %d more", (int)(changing - NODES_IN_SENTENCE));
  }
  if (changing)
    cJSON_AddItemToObject(parent, period ? "cycling" : "unsettled", nodes);
  else
    cJSON_Delete(nodes);
  if (period) cJSON_AddNumberToObject(parent, "period", period);
}

PetscErrorCode cycling_describe(Solve *solve, PetscInt period, cJSON *parent, char sentence[], size_t length)
{
  const PetscInt span = period ? period : PetscMin(solve->cycling->n, LONGEST);
  Change        *mine, *all;
  PetscInt       n = 0, n_all;

  PetscFunctionBegin;
  sentence[0] = 0;
  if (span < 2) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(list_changes(solve, span, &n, &mine));
  PetscCall(gather_changes(solve->mesh, n, mine, &n_all, &all));
  if (solve->mesh->rank == 0) describe(solve, period, span, n_all, all, parent, sentence, length);
  PetscCall(PetscFree(mine));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The augmentation of the nodes that change state, times `factor`. */
PetscErrorCode cycling_change_augmentation(Solve *solve, PetscInt period, PetscReal factor)
{
  Cycling   *cycling = solve->cycling;
  PetscBool *marked;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(cycling->n_nodes, &marked));
  for (PetscInt node = 0; node < cycling->n_nodes; node++)
    marked[node] = node_changes(cycling, node, period);
  PetscCall(contact_scale_augmentation(solve->contact, marked, factor));
  PetscCall(PetscFree(marked));
  PetscFunctionReturn(PETSC_SUCCESS);
}
