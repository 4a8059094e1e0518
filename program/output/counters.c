/* What a run cost, for summary.json: seconds by phase, and per interface what the library chose to compute and what it
 * counted. */
#include "output/output.h"
#include <cjson/cJSON.h>
#include <time.h>

/* What one rank has done for an interface, and what it holds of it. */
typedef struct {
  stickslip_counters counters;
  int64_t            bytes, nodes, nodes_held, facets, facets_mortar;
  double             nodes_home, bytes_home, bytes_part, processor;
  char               effects[1024];
} Share;

static PetscErrorCode count(const Interface *interface, Share *share)
{
  const ContactPart *part = &interface->part;
  PetscFunctionBegin;
  *share                      = (Share){.bytes = part->bytes, .nodes_held = part->n1};
  share->counters.struct_size = sizeof(share->counters);
  share->nodes_home           = interface->n1 + interface->n2;
  share->bytes_home           = homes_bytes(interface);
  share->bytes_part           = work_bytes(part);
  share->processor            = part->processor;
  share->facets               = part->n_facets[0];
  share->facets_mortar        = part->n_facets[1];
  for (PetscInt a = 0; a < part->n1; a++)
    share->nodes += part->owned[a] == STICKSLIP_NODE_OWN;
  if (!part->handle) PetscFunctionReturn(PETSC_SUCCESS); /* nothing is owned here, or the library refused to create it */
  PetscCallStickslip(part_counters(part, &share->counters));
  PetscCallStickslip(stickslip_interface_effects(part->handle, share->effects, sizeof(share->effects)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Per rank, where there are several parts: what it has counted and what it holds. Parts overlap, so that their sums are
 * larger than what one rank would count. */
static void add_shares(cJSON *json, PetscMPIInt size, const Share *shares)
{
  cJSON *ranks = cJSON_AddArrayToObject(json, "ranks");
  for (PetscMPIInt r = 0; r < size; r++) {
    const Share *share = &shares[r];
    cJSON       *rank  = cJSON_CreateObject();
    cJSON_AddNumberToObject(rank, "nodes", (double)share->nodes);
    cJSON_AddNumberToObject(rank, "nodes_held", (double)share->nodes_held);
    cJSON_AddNumberToObject(rank, "facets_held", (double)share->facets);
    cJSON_AddNumberToObject(rank, "mortar_facets_held", (double)share->facets_mortar);
    cJSON_AddNumberToObject(rank, "bytes", (double)share->bytes);
    cJSON_AddNumberToObject(rank, "bytes_part", share->bytes_part);
    cJSON_AddNumberToObject(rank, "nodes_home", share->nodes_home);
    cJSON_AddNumberToObject(rank, "bytes_home", share->bytes_home);
    cJSON_AddNumberToObject(rank, "pairs_active", (double)share->counters.pairs_active);
    cJSON_AddNumberToObject(rank, "pairs_integrated", (double)share->counters.pairs_integrated);
    cJSON_AddNumberToObject(rank, "pairs_linearised", (double)share->counters.pairs_linearised);
    cJSON_AddNumberToObject(rank, "seconds",
                            share->counters.seconds_search + share->counters.seconds_integration +
                              share->counters.seconds_assembly);
    cJSON_AddNumberToObject(rank, "processor", share->processor);
    cJSON_AddItemToArray(ranks, rank);
  }
}

/* rank 0: one interface's counters, those of all ranks added; its seconds are added to `sum` */
static void add_counters(const Interface *interface, const char *cover, PetscMPIInt size, const Share *shares,
                         cJSON *parent, stickslip_counters *sum)
{
  cJSON      *json    = NULL;
  double      number  = 0;
  const char *effects = "";

  for (PetscMPIInt r = size - 1; r >= 0; r--)
    if (shares[r].effects[0]) effects = shares[r].effects;
  if (!effects[0]) return;
  json = cJSON_AddObjectToObject(parent, interface->name);
  cJSON_AddStringToObject(json, "effects", effects);
  if (cover[0]) cJSON_AddStringToObject(json, "cover", cover);
#define ADD(member, of)                                                                                                \
  do {                                                                                                                 \
    number = 0;                                                                                                        \
    for (PetscMPIInt r = 0; r < size; r++)                                                                             \
      number += (double)shares[r].of;                                                                                  \
    cJSON_AddNumberToObject(json, #member, number);                                                                    \
  } while (0)
  ADD(multipliers, counters.multipliers);
  ADD(bytes, bytes);
  ADD(pairs_tested, counters.pairs_tested);
  ADD(pairs_clipped, counters.pairs_clipped);
  ADD(pairs_integrated, counters.pairs_integrated);
  ADD(pairs_linearised, counters.pairs_linearised);
  ADD(pairs_reused, counters.pairs_reused);
  ADD(pairs_active, counters.pairs_active);
  ADD(searches, counters.searches);
  ADD(boxes_visited, counters.boxes_visited);
  ADD(nodes_slipping, counters.nodes_slipping);
  ADD(nodes_evaluated, counters.nodes_evaluated);
  ADD(nodes_frictional, counters.nodes_frictional);
  ADD(nodes_frictionless, counters.nodes_frictionless);
  ADD(nodes_new, counters.nodes_new);
  ADD(nodes_tied, counters.nodes_tied);
  ADD(nodes_carried, counters.nodes_carried);
  ADD(nodes_uncovered, counters.nodes_uncovered);
  ADD(nodes_left_out, counters.nodes_left_out);
  ADD(evaluations_apart, counters.evaluations_apart);
  ADD(commits_apart, counters.commits_apart);
  ADD(seconds_search, counters.seconds_search);
  sum->seconds_search += number;
  ADD(seconds_integration, counters.seconds_integration);
  sum->seconds_integration += number;
  ADD(seconds_assembly, counters.seconds_assembly);
  sum->seconds_assembly += number;
  ADD(bytes_part, bytes_part);
  ADD(bytes_home, bytes_home);
  ADD(processor, processor);
#undef ADD
  if (interface->n_parts > 1) {
    cJSON_AddNumberToObject(json, "halo_grown", (double)interface->n_grown);
    cJSON_AddNumberToObject(json, "halo_renewed", (double)interface->n_renewed);
    cJSON_AddNumberToObject(json, "rebalanced", (double)interface->n_rebalanced);
    add_shares(json, size, shares);
  }
}

static PetscErrorCode interface_counters(const Interface *interface, PetscMPIInt rank, cJSON *parent, stickslip_counters *sum)
{
  Share        mine, *shares = NULL;
  ContactCover cover;
  PetscMPIInt  size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  PetscCall(count(interface, &mine));
  /* after the counters, which it adds to; a run that ended beyond what can be computed has none */
  PetscCall(contact_cover(interface, interface->part.handle, rank, &cover, NULL));
  if (rank == 0) PetscCall(PetscMalloc1(size, &shares));
  PetscCallMPI(MPI_Gather(&mine, sizeof(mine), MPI_BYTE, shares, sizeof(mine), MPI_BYTE, 0, PETSC_COMM_WORLD));
  if (rank == 0) add_counters(interface, cover.text, size, shares, parent, sum);
  PetscCall(PetscFree(shares));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode summary_counters(Output *output, cJSON *root)
{
  Contact           *contact = output->contact;
  stickslip_counters sum     = {0};
  PetscLogDouble     now;
  cJSON             *interfaces = cJSON_AddObjectToObject(root, "interfaces"), *seconds;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++)
    PetscCall(interface_counters(&contact->interfaces[i], output->mesh->rank, interfaces, &sum));
  PetscCall(PetscTime(&now));
  if (output->solve->linear.kind == SOLVER_ITERATIVE) {
    const Linear *linear = &output->solve->linear;
    cJSON        *solver = cJSON_AddObjectToObject(root, "linear_solver");
    cJSON_AddNumberToObject(solver, "solves", linear->n_solves);
    cJSON_AddNumberToObject(solver, "iterations", linear->iterations);
    cJSON_AddNumberToObject(solver, "most", linear->most);
    cJSON_AddNumberToObject(solver, "direct", linear->n_direct);
  }
  seconds = cJSON_AddObjectToObject(root, "seconds");
  cJSON_AddNumberToObject(seconds, "search", sum.seconds_search);
  cJSON_AddNumberToObject(seconds, "integration", sum.seconds_integration);
  cJSON_AddNumberToObject(seconds, "contact_assembly", sum.seconds_assembly);
  cJSON_AddNumberToObject(seconds, "contact_forces", contact->seconds_forces);
  cJSON_AddNumberToObject(seconds, "contact_tangent", contact->seconds_tangent);
  cJSON_AddNumberToObject(seconds, "checks", contact->seconds_checks);
  cJSON_AddNumberToObject(seconds, "bulk_assembly", output->physics->seconds);
  cJSON_AddNumberToObject(seconds, "linear_solve", output->solve->seconds);
  cJSON_AddNumberToObject(seconds, "total", now - output->started);
  cJSON_AddNumberToObject(seconds, "processor", (double)clock() / CLOCKS_PER_SEC); /* of this process */
  PetscFunctionReturn(PETSC_SUCCESS);
}
