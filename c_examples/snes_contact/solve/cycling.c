/* Which nodes change state for ever? Newton's method on contact goes from one guess of the nodal states (gap, stick,
 * slip) to the next. Where it comes back to an earlier guess while the residual does not fall, it will do so again
 * and again.
 *
 * The states of all non-mortar nodes are kept for the last 2 LONGEST iterations. Slip one way and slip back are two
 * states: slip that turns round in every iteration is the commonest cycle of all under a large augmentation. A cycle
 * of period p is found when the last p sets of states repeat the p before them, no shorter period does, and the
 * residual has not fallen below FALLING of what it was p iterations ago. All on rank 0; the period is told to every
 * rank. */
#include "solve/solve.h"
#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

enum { SHORTEST = 2, LONGEST = 4, WINDOW = 2 * LONGEST, NODES_IN_SENTENCE = 4 };
/* A quadratic or even a linear convergence at a useful pace falls faster; a cycle on linear pieces does not fall at
 * all. */
static const PetscReal FALLING = 0.5;

/* by STICKSLIP_STATE_*, and beyond: */
enum { SLIP_BACK = 3 };
static const char *const STATE_NAMES[] = {"gap", "stick", "slip", "slip back"};

struct Cycling {
  PetscInt  n_nodes, n; /* non-mortar nodes of all interfaces; sets of states since cycling_restart() */
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
  for (PetscInt i = 0; i < solve->contact->n_interfaces && solve->mesh->rank == 0; i++)
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

static PetscBool repeats(const Cycling *cycling, PetscInt period)
{
  if (cycling->n < 2 * period) return PETSC_FALSE;
  for (PetscInt back = 0; back < period; back++) {
    if (memcmp(row(cycling, back), row(cycling, back + period), (size_t)cycling->n_nodes * sizeof(int32_t)))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscInt find_period(const Cycling *cycling)
{
  if (repeats(cycling, 1)) return 0; /* the states stand still */
  for (PetscInt period = SHORTEST; period <= LONGEST; period++) {
    if (repeats(cycling, period) && cycling->norms[(cycling->n - 1) % WINDOW] >
                                        FALLING * cycling->norms[(cycling->n - 1 - period) % WINDOW])
      return period;
  }
  return 0;
}

/* nodes whose state differs from that of the iteration before, for the report */
static void count_changes(Solve *solve)
{
  const Cycling *cycling = solve->cycling;
  PetscInt       changes = 0;
  for (PetscInt node = 0; node < cycling->n_nodes; node++)
    changes += row(cycling, 0)[node] != row(cycling, 1)[node];
  cJSON_AddItemToArray(solve->newton.state_changes, cJSON_CreateNumber(changes));
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
  if (solve->mesh->rank == 0 && cycling->n > 1) count_changes(solve);
  *period = solve->mesh->rank == 0 ? find_period(cycling) : 0;
  PetscCallMPI(MPI_Bcast(period, 1, MPIU_INT, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool node_changes(const Cycling *cycling, PetscInt node, PetscInt span)
{
  for (PetscInt back = 1; back < span; back++) {
    if (row(cycling, back)[node] != row(cycling, 0)[node]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* "node 7 at (0, 0, 1): stick, slip" */
static void add_to_sentence(const Interface *interface, PetscInt a, const Cycling *cycling, PetscInt node,
                            PetscInt span, char *sentence, size_t length)
{
  PetscReal X[3];
  size_t    used = strlen(sentence);
  contact_vector(interface->dimension, interface->X, a, X);
  snprintf(sentence + used, length - used, "%s %s node %d at (%g, %g, %g):", used ? ";" : "", interface->name,
           (int)interface->nodes[a], (double)X[0], (double)X[1], (double)X[2]);
  for (PetscInt back = span - 1; back >= 0; back--) {
    used = strlen(sentence);
    snprintf(sentence + used, length - used, " %s%s", STATE_NAMES[row(cycling, back)[node]], back ? "," : "");
  }
}

static cJSON *node_json(const Interface *interface, PetscInt a, const Cycling *cycling, PetscInt node, PetscInt span)
{
  cJSON    *json = cJSON_CreateObject(), *states;
  PetscReal X[3];
  contact_vector(interface->dimension, interface->X, a, X);
  cJSON_AddStringToObject(json, "interface", interface->name);
  cJSON_AddNumberToObject(json, "node", interface->nodes[a]);
  cJSON_AddItemToObject(json, "position", cJSON_CreateDoubleArray(X, 3));
  states = cJSON_AddArrayToObject(json, "states");
  for (PetscInt back = span - 1; back >= 0; back--)
    cJSON_AddItemToArray(states, cJSON_CreateString(STATE_NAMES[row(cycling, back)[node]]));
  return json;
}

PetscErrorCode cycling_describe(Solve *solve, PetscInt period, cJSON *parent, char sentence[], size_t length)
{
  Contact       *contact = solve->contact;
  const Cycling *cycling = solve->cycling;
  const PetscInt span    = period ? period : PetscMin(cycling->n, LONGEST);
  PetscInt       node    = 0, changing = 0;
  cJSON         *nodes;

  PetscFunctionBegin;
  sentence[0] = 0;
  if (solve->mesh->rank || span < 2) PetscFunctionReturn(PETSC_SUCCESS);
  nodes = cJSON_CreateArray();
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    for (PetscInt a = 0; a < contact->interfaces[i].n1; a++, node++) {
      if (!node_changes(cycling, node, span)) continue;
      if (changing++ < NODES_IN_SENTENCE)
        add_to_sentence(&contact->interfaces[i], a, cycling, node, span, sentence, length);
      cJSON_AddItemToArray(nodes, node_json(&contact->interfaces[i], a, cycling, node, span));
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
