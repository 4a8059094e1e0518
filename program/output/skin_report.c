/* What general contact has found and done, in words and in summary.json: who touches whom, how much, what was left out and why. */
#include "contact/skin.h"
#include "output/output.h"
#include <cjson/cJSON.h>
#include <stdarg.h>
#include <stdio.h>

enum { SENTENCE = 1024 };

/* Two bodies, or one with itself. */
typedef struct {
  PetscInt  facets, all, nodes, sticks, slips; /* of all nodes of the facets those that are in contact */
  PetscReal nearest, pressure;
} Touching;

/* A facet that has multipliers, and the bodies that it is between, the smaller number first. */
typedef struct {
  PetscInt pair[2], facet;
} Between;

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

static int by_pair(const void *a, const void *b, void *context)
{
  const Between *one = a, *two = b;
  (void)context;
  for (int k = 0; k < 2; k++) {
    if (one->pair[k] != two->pair[k]) return one->pair[k] < two->pair[k] ? -1 : 1;
  }
  return (one->facet > two->facet) - (one->facet < two->facet);
}

/* Facets that may touch another one, by the bodies that they are between; to be freed. */
static PetscErrorCode find_pairs(const ContactPart *part, const SkinFacets *facets, PetscInt *n, Between **found)
{
  PetscFunctionBegin;
  *n = 0;
  PetscCall(PetscMalloc1(part->n_facets[0], found));
  for (PetscInt f = 0; f < part->n_facets[0]; f++) {
    const PetscInt own = (PetscInt)facets->body[f], other = facets->partner[f] < 0 ? -1 : (PetscInt)facets->body[facets->partner[f]];
    if (facets->side[f] != STICKSLIP_SKIN_NONMORTAR || other < 0) continue;
    (*found)[(*n)++] = (Between){{PetscMin(own, other), PetscMax(own, other)}, f};
  }
  if (*n > 1) PetscCall(PetscTimSort(*n, *found, sizeof(**found), by_pair, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What there is between two bodies; `seen`: of each node the last pair that it was counted for. */
static Touching look_at_pair(const ContactPart *part, const SkinFacets *facets, PetscInt n, const Between between[], const SkinNode nodes[],
                             PetscInt number, PetscInt seen[])
{
  Touching found = {.facets = n, .nearest = PETSC_MAX_REAL};
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt f = between[i].facet;
    found.nearest    = PetscMin(found.nearest, facets->distance[f]);
    for (PetscInt k = part->offsets[0][f]; k < part->offsets[0][f + 1]; k++) {
      const PetscInt a = part->facet_nodes[0][k];
      if (seen[a] == number || part->middle[a]) continue;
      seen[a] = number;
      found.all++;
      if (nodes[a].state == STICKSLIP_STATE_GAP) continue;
      found.nodes++;
      found.sticks += nodes[a].state == STICKSLIP_STATE_STICK;
      found.slips += nodes[a].state == STICKSLIP_STATE_SLIP;
      found.pressure = PetscMax(found.pressure, skin_pressure(&nodes[a]));
    }
  }
  return found;
}

/* Of two bodies: what presses between them is smaller than its facets, see contact/lonely.c. */
static const char LONELY[] = "smaller_than_facets";

static void tell_pair(const Body bodies[], PetscInt dimension, const PetscInt pair[2], const Touching *found, cJSON *touching, cJSON *sentences)
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
  cJSON_AddBoolToObject(json, LONELY, found->nodes && found->nodes <= lonely_few(dimension) && found->nodes < found->all);
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

/* All pairs in the order of their bodies. */
static PetscErrorCode tell_pairs(const Mesh *mesh, const ContactPart *part, const SkinFacets *facets, const SkinNode nodes[], cJSON *touching,
                                 cJSON *sentences)
{
  Between *between;
  PetscInt n, *seen;
  PetscFunctionBegin;
  PetscCall(find_pairs(part, facets, &n, &between));
  PetscCall(PetscMalloc1(part->n1, &seen));
  for (PetscInt a = 0; a < part->n1; a++)
    seen[a] = -1;
  for (PetscInt first = 0, end; first < n; first = end) {
    Touching one;
    for (end = first; end < n && between[end].pair[0] == between[first].pair[0] && between[end].pair[1] == between[first].pair[1];)
      end++;
    one = look_at_pair(part, facets, end - first, between + first, nodes, first, seen);
    tell_pair(mesh->bodies, part->dimension, between[first].pair, &one, touching, sentences);
  }
  PetscCall(PetscFree(between));
  PetscCall(PetscFree(seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The force of contact on each body, 3 each, of all ranks; to be freed. */
static PetscErrorCode sum_forces(const Mesh *mesh, const Interface *interface, PetscReal **force)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(3 * mesh->n_bodies, force));
  for (PetscInt a = 0; a < interface->n1; a++) {
    PetscReal nodal[3];
    contact_vector(interface->dimension, interface->forces, a, nodal);
    for (int i = 0; i < 3; i++)
      (*force)[3 * mesh_body_of(mesh, interface->nodes[a]) + i] -= nodal[i];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, *force, (PetscMPIInt)(3 * mesh->n_bodies), MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void tell_bodies(const Mesh *mesh, const PetscReal force[], const PetscBool there[], const PetscBool met[], cJSON *root,
                        cJSON *sentences)
{
  cJSON *forces = cJSON_AddObjectToObject(root, "forces");
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
}

static void tell_left_out(const Mesh *mesh, const Skin *skin, const stickslip_skin_summary *found, const int64_t counts[], cJSON *sentences)
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
  if (counts[1]) say(sentences, "Facets in contact have exchanged their sides %d time%s.", (int)counts[1], plural(counts[1]));
  if (counts[2]) say(sentences, "Facets have met out of reach, and the step was solved again, %d time%s.", (int)counts[2], plural(counts[2]));
}

/* By the rank that has the skin. */
static PetscErrorCode report(const Mesh *mesh, const Interface *interface, const SkinNode nodes[], const PetscReal force[], cJSON *root)
{
  const ContactPart     *part  = &interface->part;
  stickslip_skin_summary found = {.struct_size = sizeof(found)};
  cJSON                 *sentences, *touching;
  PetscBool             *there, *met;
  SkinFacets             facets;
  int64_t                counts[SKIN_COUNTS];
  PetscFunctionBegin;
  PetscCallStickslip(stickslip_skin_report(part->skin->handle, &found));
  skin_counts(part, counts);
  PetscCall(skin_facets(part, &facets));
  PetscCall(PetscCalloc2(mesh->n_bodies, &there, mesh->n_bodies, &met));
  find_bodies(&facets, part->n_facets[0], there, met);
  cJSON_AddNumberToObject(root, "pieces", (double)found.pieces);
  cJSON_AddNumberToObject(root, "pairs", (double)found.pairs);
  cJSON_AddNumberToObject(root, "contradictions", (double)found.contradictions);
  cJSON_AddNumberToObject(root, "made", (double)counts[0]);
  cJSON_AddNumberToObject(root, "exchanged", (double)counts[1]);
  cJSON_AddNumberToObject(root, "missed", (double)counts[2]);
  cJSON_AddNumberToObject(root, "facets", part->n_facets[0]);
  cJSON_AddNumberToObject(root, "facets_left_out", interface->skin->n_left);
  touching  = cJSON_AddArrayToObject(root, "touching");
  sentences = cJSON_AddArrayToObject(root, "report");
  say(sentences, "General contact of %d bod%s: %d pair%s of facets may touch in this step, in %d piece%s.", (int)found.bodies,
      found.bodies == 1 ? "y" : "ies", (int)found.pairs, plural(found.pairs), (int)found.pieces, plural(found.pieces));
  PetscCall(tell_pairs(mesh, part, &facets, nodes, touching, sentences));
  tell_bodies(mesh, force, there, met, root, sentences);
  tell_left_out(mesh, interface->skin, &found, counts, sentences);
  PetscCall(PetscFree2(there, met));
  PetscCall(skin_facets_destroy(&facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char KEY[] = "general_contact";

/* At the state that has been collected. */
PetscErrorCode skin_report(const Output *output, cJSON *root)
{
  const Mesh *mesh = output->mesh;
  PetscFunctionBegin;
  cJSON_DeleteItemFromObject(root, KEY); /* of an attempt that did not count */
  for (PetscInt i = 0; i < output->contact->n_interfaces; i++) {
    const Interface *interface = &output->contact->interfaces[i];
    SkinNode        *nodes;
    PetscReal       *force;
    if (!interface->skin) continue;
    PetscCall(skin_nodes(interface, &nodes));
    PetscCall(sum_forces(mesh, interface, &force));
    if (interface->part.skin) PetscCall(report(mesh, interface, nodes, force, cJSON_AddObjectToObject(root, KEY)));
    PetscCall(PetscFree(nodes));
    PetscCall(PetscFree(force));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* So many sentences are printed, and so many pairs that are warned of. */
enum { PRINTED = 60, WARNED = 3 };

static PetscErrorCode warn(const cJSON *touching)
{
  const cJSON *one;
  int          n = 0;
  PetscFunctionBegin;
  cJSON_ArrayForEach(one, touching)
  {
    const cJSON *bodies = cJSON_GetObjectItem(one, "bodies");
    if (!cJSON_IsTrue(cJSON_GetObjectItem(one, LONELY)) || n++ >= WARNED) continue;
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: warning: all that %s and %s carry between them at the end is at so few nodes that the contact is smaller than its "
                           "facets, and its force may be off by tens of per cent. Take facets so fine that several lie in the contact.\n",
                           cJSON_GetStringValue(cJSON_GetArrayItem(bodies, 0)), cJSON_GetStringValue(cJSON_GetArrayItem(bodies, 1))));
  }
  if (n > WARNED) PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR, "stickslip: warning: so it is with %d more pairs of bodies.\n", n - WARNED));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode skin_report_tell(const Output *output, const cJSON *root)
{
  const cJSON *sentences = cJSON_GetObjectItem(cJSON_GetObjectItem(root, KEY), "report"), *sentence;
  const int    n         = cJSON_GetArraySize(sentences);
  int          printed   = 0;
  PetscFunctionBegin;
  PetscCall(warn(cJSON_GetObjectItem(cJSON_GetObjectItem(root, KEY), "touching")));
  if (output->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  cJSON_ArrayForEach(sentence, sentences)
  {
    if (printed++ < PRINTED) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s\n", cJSON_GetStringValue(sentence)));
  }
  if (n > PRINTED) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "Of general contact %d more sentences are in summary.json.\n", n - PRINTED));
  PetscFunctionReturn(PETSC_SUCCESS);
}
