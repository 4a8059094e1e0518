/* What the library finds wrong with an interface, over all its parts, in the interface's numbers. */
#include "contact/contact.h"
#include <stdio.h>
#include <stdlib.h>

/* as STICKSLIP_STATE_..., unknown */
enum { UNKNOWN = -1 };

static void note_pair(const ContactPart *part, double value, const int64_t facets[2], int which, ContactDiagnosis *d)
{
  d->pairs[which].value = value;
  for (int side = 0; side < 2; side++)
    d->pairs[which].facets[side] = facets[side] < 0 || facets[side] >= part->n_facets[side] ? -1 : part->facets[side][facets[side]];
}

/* Of the rank's own nodes: rows of others are not complete here. */
static void note_nodes(const ContactPart *part, const stickslip_diagnosis *found, ContactDiagnosis *d)
{
  for (PetscInt a = 0; a < part->n1; a++) {
    if (part->owned[a] == STICKSLIP_NODE_OWN && !part->middle[a]) d->states[found->state[a]]++;
  }
  for (int64_t k = 0; k < PetscMin(found->suspects, found->suspect_capacity); k++) {
    const PetscInt node    = (PetscInt)found->suspect_nodes[k];
    Suspect       *suspect = &d->suspects[d->n_suspects];
    if (part->owned[node] != STICKSLIP_NODE_OWN) continue;
    d->n_weak += found->suspect_causes[k] == STICKSLIP_CAUSE_COVERAGE;
    if (d->n_suspects++ >= SUSPECTS_KEPT) continue;
    suspect->vertex = part->vertices[node];
    suspect->ratio  = found->suspect_ratios[k];
    suspect->cause  = found->suspect_causes[k];
    contact_vector(part->dimension, part->X, node, suspect->position);
    contact_vector(part->dimension, found->suspect_directions, (PetscInt)k, suspect->direction);
  }
}

/* At the place of the last evaluation. An iterate that the library refuses has been told of already. */
static PetscErrorCode diagnose_part(const ContactPart *part, ContactDiagnosis *d)
{
  const PetscInt      n     = part->n1;
  stickslip_diagnosis found = {.struct_size = sizeof(found), .suspect_capacity = n, .text = d->text, .text_capacity = sizeof(d->text)};
  stickslip_counters  counters = {.struct_size = sizeof(counters)};

  PetscFunctionBegin;
  if (!part->handle) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc5(n, &found.state, n, &found.suspect_nodes, part->dimension * n, &found.suspect_directions, n,
                         &found.suspect_ratios, n, &found.suspect_causes));
  for (PetscInt a = 0; a < n; a++)
    found.state[a] = UNKNOWN;
  if (!stickslip_interface_diagnose(part->handle, STATE_OF(part), NULL, &found)) {
    d->found = PETSC_TRUE;
    note_pair(part, found.overlap, found.overlap_facets, PAIR_OVERLAP, d);
    note_pair(part, found.warp, found.warp_facets, PAIR_WARP, d);
    note_pair(part, found.angle, found.angle_facets, PAIR_ANGLE, d);
    note_pair(part, found.error, found.error_facets, PAIR_ERROR, d);
    note_nodes(part, &found, d);
    PetscCallStickslip(stickslip_interface_counters(part->handle, &counters));
    d->n_new = counters.nodes_new;
  }
  PetscCall(PetscFree5(found.state, found.suspect_nodes, found.suspect_directions, found.suspect_ratios, found.suspect_causes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int worse_first(const void *a, const void *b)
{
  const Suspect *one = a, *two = b;
  return (one->ratio > two->ratio) - (one->ratio < two->ratio);
}

/* Is the pair of `b` worse than that of `a`? */
static PetscBool is_worse(const PairFound *a, const PairFound *b, int which)
{
  if (b->facets[0] < 0 || a->facets[0] < 0) return (PetscBool)(a->facets[0] < 0);
  return (PetscBool)(which == PAIR_OVERLAP ? b->value < a->value : b->value > a->value);
}

/* Into the first one what the others have found. */
static PetscErrorCode merge(PetscMPIInt n, ContactDiagnosis all[])
{
  ContactDiagnosis *d = &all[0];
  Suspect          *suspects;
  PetscInt          n_kept = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(SUSPECTS_KEPT * n, &suspects));
  for (PetscMPIInt r = 0; r < n; r++) {
    for (PetscInt k = 0; k < PetscMin(all[r].n_suspects, SUSPECTS_KEPT) && all[r].found; k++)
      suspects[n_kept++] = all[r].suspects[k];
    if (r == 0 || !all[r].found) continue;
    if (!d->found) {
      *d = all[r];
      continue;
    }
    for (int which = 0; which < N_PAIRS_FOUND; which++) {
      if (is_worse(&d->pairs[which], &all[r].pairs[which], which)) d->pairs[which] = all[r].pairs[which];
    }
    for (int s = 0; s < 3; s++)
      d->states[s] += all[r].states[s];
    d->n_suspects += all[r].n_suspects;
    d->n_weak += all[r].n_weak;
    d->n_new = PetscMax(d->n_new, all[r].n_new); /* of each part, nodes of other ranks too */
  }
  qsort(suspects, (size_t)n_kept, sizeof(*suspects), worse_first);
  PetscCall(PetscArraycpy(d->suspects, suspects, PetscMin(n_kept, SUSPECTS_KEPT)));
  PetscCall(PetscFree(suspects));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode contact_diagnose(const Interface *interface, PetscMPIInt rank, ContactDiagnosis *d)
{
  ContactDiagnosis *all = NULL;
  PetscMPIInt       size;

  PetscFunctionBegin;
  *d = (ContactDiagnosis){.found = PETSC_FALSE};
  PetscCall(diagnose_part(&interface->part, d));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (rank == 0) PetscCall(PetscMalloc1(size, &all));
  PetscCallMPI(MPI_Gather(d, sizeof(*d), MPI_BYTE, all, sizeof(*d), MPI_BYTE, 0, PETSC_COMM_WORLD));
  if (rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(merge(size, all));
  *d = all[0];
  if (interface->n_parts > 1)
    snprintf(d->text, sizeof(d->text), "%d nodes in gap, %d in stick, %d in slip.", (int)d->states[STICKSLIP_STATE_GAP],
             (int)d->states[STICKSLIP_STATE_STICK], (int)d->states[STICKSLIP_STATE_SLIP]);
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}
