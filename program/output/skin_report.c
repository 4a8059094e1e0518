/* What general contact has found and done, in words and in summary.json: who touches whom, how much, what was left out and why. */
#include "contact/skin.h"
#include "output/output.h"
#include <cjson/cJSON.h>
#include <stdarg.h>
#include <stdio.h>

enum { SENTENCE = 1024 };

/* Two bodies, or one with itself. */
typedef struct {
  PetscInt  facets, nodes, sticks, slips;
  PetscReal nearest, pressure;
} Touching;

PETSC_ATTRIBUTE_FORMAT(2, 3) static void say(cJSON *sentences, const char *format, ...)
{
  char    sentence[SENTENCE];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(sentence, sizeof(sentence), format, arguments);
  va_end(arguments);
  cJSON_AddItemToArray(sentences, cJSON_CreateString(sentence));
}

static const char *plural(int64_t n)
{
  return n == 1 ? "" : "s";
}

/* What there is between bodies a <= b. */
static PetscErrorCode look_at_pair(const Interface *interface, const SkinFacets *facets, const PetscInt pair[2], Touching *found)
{
  const ContactPart   *part   = &interface->part;
  const ContactStates *states = &interface->states;
  PetscBool           *seen;
  PetscFunctionBegin;
  *found = (Touching){.nearest = PETSC_MAX_REAL};
  PetscCall(PetscCalloc1(part->n1, &seen));
  for (PetscInt f = 0; f < part->n_facets[0]; f++) {
    const int64_t own = facets->body[f], other = facets->partner[f] < 0 ? -1 : facets->body[facets->partner[f]];
    if (facets->side[f] != STICKSLIP_SKIN_NONMORTAR || PetscMin(own, other) != pair[0] || PetscMax(own, other) != pair[1]) continue;
    found->facets++;
    found->nearest = PetscMin(found->nearest, facets->distance[f]);
    for (PetscInt k = part->offsets[0][f]; k < part->offsets[0][f + 1]; k++) {
      const PetscInt a = part->nodes[part->facet_nodes[0][k]];
      PetscReal      pressure = 0;
      if (seen[a] || states->state[a] == STICKSLIP_STATE_GAP || interface->middle[a]) continue;
      seen[a] = PETSC_TRUE;
      for (int i = 0; i < 3; i++)
        pressure -= states->multiplier[3 * a + i] * states->normal[3 * a + i];
      found->nodes++;
      found->sticks += states->state[a] == STICKSLIP_STATE_STICK;
      found->slips += states->state[a] == STICKSLIP_STATE_SLIP;
      found->pressure = PetscMax(found->pressure, pressure);
    }
  }
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void tell_pair(const Body bodies[], const PetscInt pair[2], const Touching *found, cJSON *touching, cJSON *sentences)
{
  const char *one = bodies[pair[0]].name, *two = pair[0] == pair[1] ? "itself" : bodies[pair[1]].name;
  char        rest[SENTENCE / 2] = "no node is in contact";
  cJSON      *json = cJSON_CreateObject(), *names = cJSON_AddArrayToObject(json, "bodies");
  cJSON_AddItemToArray(touching, json);
  for (int k = 0; k < 2; k++)
    cJSON_AddItemToArray(names, cJSON_CreateString(bodies[pair[k]].name));
  cJSON_AddNumberToObject(json, "facets", found->facets);
  cJSON_AddNumberToObject(json, "nearest", (double)found->nearest);
  cJSON_AddNumberToObject(json, "stick", found->sticks);
  cJSON_AddNumberToObject(json, "slip", found->slips);
  cJSON_AddNumberToObject(json, "pressure", (double)found->pressure);
  if (found->nodes)
    snprintf(rest, sizeof(rest), "%d node%s in contact, %d stick and %d slip, the largest pressure is %.4g", (int)found->nodes,
             plural(found->nodes), (int)found->sticks, (int)found->slips, (double)found->pressure);
  say(sentences, "%s and %s: %d facet%s within reach, the nearest %.3g away; %s.", one, two, (int)found->facets, plural(found->facets),
      (double)found->nearest, rest);
}

/* Of each body of the skin whether it has any facet there, and any partner. */
static void find_bodies(const SkinFacets *facets, PetscInt n, PetscBool there[], PetscBool met[])
{
  for (PetscInt f = 0; f < n; f++) {
    there[facets->body[f]] = PETSC_TRUE;
    if (facets->partner[f] >= 0) met[facets->body[f]] = PETSC_TRUE;
  }
}

static PetscErrorCode tell_bodies(const Output *output, const Interface *interface, const PetscBool there[], const PetscBool met[], cJSON *root,
                                  cJSON *sentences)
{
  const Mesh *mesh = output->mesh;
  PetscReal  *force;
  cJSON      *forces = cJSON_AddObjectToObject(root, "forces");
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(3 * mesh->n_bodies, &force));
  for (PetscInt a = 0; a < interface->n1; a++) {
    PetscReal nodal[3];
    contact_vector(interface->dimension, interface->forces, a, nodal);
    for (int i = 0; i < 3; i++)
      force[3 * mesh_body_of(mesh, interface->nodes[a]) + i] -= nodal[i];
  }
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    const PetscReal *f = force + 3 * b;
    if (!there[b]) say(sentences, "%s is no part of it.", mesh->bodies[b].name);
    if (!there[b]) continue;
    cJSON_AddItemToObject(forces, mesh->bodies[b].name, cJSON_CreateDoubleArray(f, 3));
    if (!met[b])
      say(sentences, "Nothing is within reach of %s.", mesh->bodies[b].name);
    else if (f[0] != 0 || f[1] != 0 || f[2] != 0)
      say(sentences, "The force of contact on %s is (%.6g, %.6g, %.6g).", mesh->bodies[b].name, (double)f[0], (double)f[1], (double)f[2]);
  }
  PetscCall(PetscFree(force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void tell_left_out(const Mesh *mesh, const Skin *skin, const stickslip_skin_summary *found, cJSON *sentences)
{
  if (skin->n_left)
    say(sentences, "%d facet%s in planes of symmetry %s left out.", (int)skin->n_left, plural(skin->n_left), skin->n_left == 1 ? "is" : "are");
  for (PetscInt k = 0; k < skin->n_pairs; k++) {
    const SkinPair *pair = &skin->pairs[k];
    if (pair->mu == STICKSLIP_SKIN_APART)
      say(sentences, "%s and %s do not see each other: the scene says so, joins them by an interface, or both are rigid.",
          mesh->bodies[pair->bodies[0]].name, pair->bodies[0] == pair->bodies[1] ? "itself" : mesh->bodies[pair->bodies[1]].name);
  }
  if (found->contradictions)
    say(sentences, "%d pair%s of facets could not be put on different sides, and cannot touch.", (int)found->contradictions,
        plural(found->contradictions));
  if (found->exchanged)
    say(sentences, "Facets in contact have exchanged their sides %d time%s.", (int)found->exchanged, plural(found->exchanged));
  if (found->missed)
    say(sentences, "Facets have met out of reach, and the step was solved again, %d time%s.", (int)found->missed, plural(found->missed));
}

static PetscErrorCode report(const Output *output, const Interface *interface, cJSON *root)
{
  const Mesh            *mesh  = output->mesh;
  stickslip_skin_summary found = {.struct_size = sizeof(found)};
  cJSON                 *sentences, *touching;
  PetscBool             *there, *met;
  SkinFacets             facets;
  PetscFunctionBegin;
  PetscCallStickslip(stickslip_skin_report(interface->part.skin->handle, &found));
  PetscCall(skin_facets(&interface->part, &facets));
  PetscCall(PetscCalloc2(mesh->n_bodies, &there, mesh->n_bodies, &met));
  find_bodies(&facets, interface->part.n_facets[0], there, met);
  cJSON_AddNumberToObject(root, "pieces", (double)found.pieces);
  cJSON_AddNumberToObject(root, "pairs", (double)found.pairs);
  cJSON_AddNumberToObject(root, "contradictions", (double)found.contradictions);
  cJSON_AddNumberToObject(root, "made", (double)found.made);
  cJSON_AddNumberToObject(root, "exchanged", (double)found.exchanged);
  cJSON_AddNumberToObject(root, "missed", (double)found.missed);
  cJSON_AddNumberToObject(root, "facets", interface->part.n_facets[0]);
  cJSON_AddNumberToObject(root, "facets_left_out", interface->skin->n_left);
  touching  = cJSON_AddArrayToObject(root, "touching");
  sentences = cJSON_AddArrayToObject(root, "report");
  say(sentences, "General contact of %d bod%s: %d pair%s of facets may touch in this step, in %d piece%s.", (int)found.bodies,
      found.bodies == 1 ? "y" : "ies", (int)found.pairs, plural(found.pairs), (int)found.pieces, plural(found.pieces));
  for (PetscInt a = 0; a < mesh->n_bodies; a++) {
    for (PetscInt b = a; b < mesh->n_bodies && met[a]; b++) {
      const PetscInt pair[2] = {a, b};
      Touching       one;
      if (!met[b]) continue;
      PetscCall(look_at_pair(interface, &facets, pair, &one));
      if (one.facets) tell_pair(mesh->bodies, pair, &one, touching, sentences);
    }
  }
  PetscCall(tell_bodies(output, interface, there, met, root, sentences));
  tell_left_out(mesh, interface->skin, &found, sentences);
  PetscCall(PetscFree2(there, met));
  PetscCall(skin_facets_destroy(&facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char KEY[] = "general_contact";

/* At the state that has been collected. */
PetscErrorCode skin_report(const Output *output, cJSON *root)
{
  PetscFunctionBegin;
  cJSON_DeleteItemFromObject(root, KEY); /* of an attempt that did not count */
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++) {
    if (output->contact->interfaces[i].part.skin) PetscCall(report(output, &output->contact->interfaces[i], cJSON_AddObjectToObject(root, KEY)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode skin_report_tell(const Output *output, const cJSON *root)
{
  const cJSON *sentence;
  PetscFunctionBegin;
  if (output->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  cJSON_ArrayForEach(sentence, cJSON_GetObjectItem(cJSON_GetObjectItem(root, KEY), "report"))
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s\n", cJSON_GetStringValue(sentence)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
