/* `contact: all` of a scene: the skin of all bodies, or of all but those that `except` names; their friction, by pairs of bodies. */
#include "contact/skin.h"
#include <string.h>

static const char NAME[] = "all", FRICTION[] = "friction", EXCEPT[] = "except";

PetscBool skin_wanted(Scene *scene)
{
  char word[NAME_LENGTH] = "";
  if (!scene_has(scene, NULL, "contact")) return PETSC_FALSE;
  scene_string(scene, NULL, "contact", word, sizeof(word));
  if (strcmp(word, NAME)) scene_fail(scene, NULL, "contact", "'%s' is not known; `contact: all` is general contact of all bodies.", word);
  return PETSC_TRUE;
}

/* A body of the skin by its name, up to `end`; -1: there is none. */
static PetscInt find_body(const Mesh *mesh, const char *name, const char *end)
{
  for (PetscInt b = 0; b < mesh->n_bodies; b++) {
    if (strlen(mesh->bodies[b].name) == (size_t)(end - name) && !strncmp(mesh->bodies[b].name, name, (size_t)(end - name))) return b;
  }
  return -1;
}

static PetscBool find_pair(const Mesh *mesh, const char *words, PetscInt pair[2])
{
  const char *dot = strchr(words, '.');
  pair[0] = pair[1] = -1;
  if (!dot) return PETSC_FALSE;
  pair[0] = find_body(mesh, words, dot);
  pair[1] = find_body(mesh, dot + 1, dot + strlen(dot));
  return (PetscBool)(pair[0] >= 0 && pair[1] >= 0);
}

static PetscErrorCode add_pair(Skin *skin, PetscInt one, PetscInt two, PetscReal mu)
{
  PetscFunctionBegin;
  PetscCall(PetscRealloc(sizeof(SkinPair) * (size_t)(skin->n_pairs + 1), &skin->pairs));
  skin->pairs[skin->n_pairs++] = (SkinPair){{one, two}, mu};
  if (mu > 0) skin->rubs = PetscMax(skin->rubs, mu);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bodies, surfaces and pairs that are left out. */
static PetscErrorCode read_except(Scene *scene, const Mesh *mesh, Skin *skin, PetscBool wanted[], PetscBool without[])
{
  PetscInt n;
  char   **names;
  PetscFunctionBegin;
  scene_strings(scene, NULL, EXCEPT, &n, &names);
  for (PetscInt k = 0; k < n; k++) {
    const char    *name = names[k];
    const PetscInt body = find_body(mesh, name, name + strlen(name));
    PetscInt       pair[2];
    if (body >= 0) {
      wanted[body] = PETSC_FALSE;
    } else if (find_pair(mesh, name, pair)) {
      PetscCall(add_pair(skin, pair[0], pair[1], STICKSLIP_SKIN_APART));
    } else {
      without[mesh_surface(scene, mesh, NULL, EXCEPT, name) - mesh->surfaces] = PETSC_TRUE;
    }
  }
  strings_destroy(n, &names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal coefficient(Scene *scene, const char *map, const char *key, PetscReal otherwise)
{
  PetscReal mu = otherwise;
  scene_real(scene, map, key, &mu);
  return mu;
}

/* One number for all, or a map: of pairs of bodies, and what holds for the others. */
static PetscErrorCode read_friction(Scene *scene, const Mesh *mesh, Interface *interface)
{
  static const char *const laws[] = {"coulomb", "none", "tied", "rough", "tresca", NULL};
  stickslip_options       *options = &interface->options;
  Skin                    *skin    = interface->skin;
  PetscInt                 law     = STICKSLIP_FRICTION_COULOMB;
  PetscFunctionBegin;
  options->mu = coefficient(scene, FRICTION, "default", coefficient(scene, NULL, FRICTION, 0));
  skin->rubs  = PetscMax(skin->rubs, options->mu);
  for (PetscInt a = 0; a < mesh->n_bodies && scene_has_map(FRICTION); a++) {
    for (PetscInt b = 0; b < mesh->n_bodies; b++) {
      char key[2 * NAME_LENGTH];
      PetscCall(PetscSNPrintf(key, sizeof(key), "%s.%s", mesh->bodies[a].name, mesh->bodies[b].name));
      if (scene_has(scene, FRICTION, key)) PetscCall(add_pair(skin, a, b, coefficient(scene, FRICTION, key, 0)));
    }
  }
  scene_choice(scene, NAME, "law", laws, &law);
  if (law == STICKSLIP_FRICTION_TIED)
    scene_fail(scene, NAME, "law", "what is tied is an interface of its own: list it in `interfaces`, beside `contact: all`.");
  if (law == STICKSLIP_FRICTION_TRESCA && !scene_has(scene, NAME, "shear_limit"))
    scene_fail(scene, NAME, "shear_limit", "this key is missing: the law 'tresca' needs it.");
  if (law == STICKSLIP_FRICTION_TRESCA && !(skin->rubs > 0))
    scene_fail(scene, NULL, FRICTION, "the law 'tresca' is friction up to `shear_limit`; without a coefficient above 0 nothing ever comes to it.");
  if (law == STICKSLIP_FRICTION_TRESCA) scene_real(scene, NAME, "shear_limit", &options->shear_limit);
  if (law != STICKSLIP_FRICTION_COULOMB && law != STICKSLIP_FRICTION_TRESCA && skin->rubs > 0)
    scene_fail(scene, NULL, FRICTION, "the law '%s' has no Coulomb coefficient.", laws[law]);
  options->friction = (int32_t)(law == STICKSLIP_FRICTION_COULOMB && skin->rubs == 0 ? STICKSLIP_FRICTION_NONE : law);
  interface->components = interface->dimension; /* the library has vectors, be there friction or not */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode skin_read(Scene *scene, const Contact *contact, Interface *interface)
{
  PetscFunctionBegin;
  if (contact->condensed)
    scene_fail(scene, NULL, "unknowns", "general contact has its multipliers among the unknowns: take `unknowns: multipliers`.");
  PetscCall(PetscNew(&interface->skin));
  PetscCall(PetscSNPrintf(interface->name, sizeof(interface->name), "%s", NAME));
  PetscCall(read_friction(scene, contact->mesh, interface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a face lie in a plane of symmetry? */
static PetscBool is_cut(const Mesh *mesh, PetscInt n, const PetscInt vertices[], const PetscInt axes[], PetscReal tolerance)
{
  for (int i = 0; i < 3; i++) {
    PetscBool in_plane = PETSC_TRUE;
    for (PetscInt k = 0; k < n; k++)
      in_plane = (PetscBool)(in_plane && axes[vertices[k]] >> i & 1 &&
                             PetscAbsReal(mesh->coordinates[3 * vertices[k] + i] - mesh->coordinates[3 * vertices[0] + i]) <= tolerance);
    if (in_plane) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Cuts on planes of symmetry are no faces. */
static void leave_out_cuts(const Mesh *mesh, const PetscInt axes[], PetscReal tolerance, Skin *skin)
{
  Surface *outer = &skin->outer;
  PetscInt n     = outer->n_faces;
  outer->n_faces = 0;
  for (PetscInt f = 0, at = 0, end; f < n; f++, at = end) {
    PetscInt face[FACE_NODES];
    end = outer->offsets[f + 1]; /* surface_push() writes at or before it */
    for (PetscInt k = at; k < end; k++)
      face[k - at] = outer->vertices[k];
    if (is_cut(mesh, end - at, face, axes, tolerance)) {
      skin->n_left++;
      continue;
    }
    outer->numbers[outer->n_faces] = outer->numbers[f];
    surface_push(outer, end - at, face);
  }
}

/* A vertex that is held across a plane: its place along the axis, and its body. */
typedef struct {
  PetscReal place, body;
} Held;

static int by_place(const void *a, const void *b, void *context)
{
  const Held *one = a, *two = b;
  (void)context;
  if (one->place != two->place) return one->place < two->place ? -1 : 1;
  return (one->body > two->body) - (one->body < two->body);
}

/* Those of all ranks, in their order, each place of a body once. To be freed. */
static PetscErrorCode gather_held(const Mesh *mesh, const PetscBool wanted[], const PetscInt axes[], int axis, PetscInt *n, Held **all)
{
  PetscMPIInt *counts, *starts, count, total = 0;
  Held        *mine;
  PetscInt     m = 0;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->n_vertices, &mine));
  for (PetscInt v = 0; v < mesh->n_vertices; v++) {
    const PetscInt body = mesh_body_of(mesh, mesh->numbers[v]);
    if (axes[v] >> axis & 1 && wanted[body]) mine[m++] = (Held){mesh->coordinates[3 * v + axis], body};
  }
  if (m > 1) PetscCall(PetscTimSort(m, mine, sizeof(*mine), by_place, NULL));
  count = 0;
  for (PetscInt k = 0; k < m; k++) {
    if (!count || by_place(&mine[count - 1], &mine[k], NULL)) mine[count++] = mine[k];
  }
  count *= (PetscMPIInt)sizeof(Held);
  PetscCall(PetscMalloc2(mesh->size, &counts, mesh->size, &starts));
  PetscCallMPI(MPI_Allgather(&count, 1, MPI_INT, counts, 1, MPI_INT, PETSC_COMM_WORLD));
  for (PetscMPIInt r = 0; r < mesh->size; r++) {
    starts[r] = total;
    total += counts[r];
  }
  *n = total / (PetscInt)sizeof(Held);
  PetscCall(PetscMalloc1(*n, all));
  PetscCallMPI(MPI_Allgatherv(mine, count, MPI_BYTE, *all, counts, starts, MPI_BYTE, PETSC_COMM_WORLD));
  if (*n > 1) PetscCall(PetscTimSort(*n, *all, sizeof(**all), by_place, NULL));
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where one body alone is held and others pass the plane, contact may rub across it. */
static PetscErrorCode find_symmetry(const Mesh *mesh, const PetscBool wanted[], const PetscInt axes[], PetscReal tolerance, Skin *skin)
{
  PetscInt n_wanted = 0;
  PetscFunctionBegin;
  for (PetscInt b = 0; b < mesh->n_bodies; b++)
    n_wanted += wanted[b];
  PetscCall(PetscCalloc1(mesh->n_vertices, &skin->symmetry));
  for (int i = 0; i < mesh->dimension; i++) {
    PetscInt n = 0;
    Held    *held;
    PetscCall(gather_held(mesh, wanted, axes, i, &n, &held));
    for (PetscInt first = 0, end; first < n; first = end) {
      PetscBool other = (PetscBool)(n_wanted == 1);
      for (end = first; end < n && held[end].place - held[first].place <= tolerance; end++)
        other = (PetscBool)(other || held[end].body != held[first].body);
      for (PetscInt v = 0; v < mesh->n_vertices && other; v++) {
        const PetscReal place = mesh->coordinates[3 * v + i];
        if (axes[v] >> i & 1 && wanted[mesh_body_of(mesh, mesh->numbers[v])] && place >= held[first].place && place <= held[end - 1].place)
          skin->symmetry[v] |= 1 << i;
      }
    }
    PetscCall(PetscFree(held));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is named as an interface is no general contact: these bodies do not see each other. Nor do two rigid ones, between which nothing
 * would give way. */
static PetscErrorCode part_bodies(const Contact *contact, const PetscBool wanted[], Skin *skin)
{
  const Mesh *mesh = contact->mesh;
  PetscFunctionBegin;
  for (PetscInt i = 0; i < contact->n_interfaces; i++) {
    const PetscInt *body = contact->interfaces[i].body;
    if (!contact->interfaces[i].skin && wanted[body[0]] && wanted[body[1]]) PetscCall(add_pair(skin, body[0], body[1], STICKSLIP_SKIN_APART));
  }
  for (PetscInt a = 0; a < mesh->n_bodies; a++) {
    for (PetscInt b = a; b < mesh->n_bodies && mesh->bodies[a].rigid && wanted[a]; b++) {
      if (mesh->bodies[b].rigid && wanted[b]) PetscCall(add_pair(skin, a, b, STICKSLIP_SKIN_APART));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The skin's facets, when all named interfaces are known. */
PetscErrorCode skin_find(Scene *scene, const Contact *contact, Interface *interface)
{
  const Mesh *mesh = contact->mesh;
  Skin       *skin = interface->skin;
  PetscBool  *wanted, *without, any = PETSC_FALSE;
  PetscInt   *axes;
  PetscInt    counts[2];
  PetscReal   tolerance;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->n_bodies, &wanted));
  PetscCall(PetscCalloc2(mesh->n_surfaces, &without, mesh->n_vertices, &axes));
  for (PetscInt b = 0; b < mesh->n_bodies; b++)
    wanted[b] = (PetscBool)!mesh->bodies[b].analytic; /* it has no faces */
  PetscCall(read_except(scene, mesh, skin, wanted, without));
  for (PetscInt b = 0; b < mesh->n_bodies; b++)
    any = (PetscBool)(any || wanted[b]);
  if (!any) scene_fail(scene, NULL, EXCEPT, "no body is left that could touch another one, or itself.");
  PetscCall(part_bodies(contact, wanted, skin));
  PetscCall(mesh_outer(mesh, wanted, without, &skin->outer));
  PetscCall(symmetry_walls(contact->physics, axes, &tolerance));
  PetscCall(pieces_unite(mesh, axes, MPI_BOR)); /* a piece may have a vertex of a support, and no face of it */
  leave_out_cuts(mesh, axes, tolerance, skin);
  PetscCall(find_symmetry(mesh, wanted, axes, tolerance, skin));
  counts[0] = skin->outer.n_faces;
  counts[1] = skin->n_left;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, counts, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  skin->n_left = counts[1];
  if (!counts[0]) scene_fail(scene, NULL, EXCEPT, "no face is left that could touch another one.");
  PetscCall(PetscSNPrintf(skin->outer.name, sizeof(skin->outer.name), "%s", NAME));
  PetscCall(PetscFree(wanted));
  PetscCall(PetscFree2(without, axes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the nodes at home: the normals of planes of symmetry that they lie in. */
PetscErrorCode skin_symmetry(const Interface *interface, PetscInt mask[])
{
  PetscInt *all;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(interface->n1 + interface->n2, &all));
  PetscCall(PetscSFBcastBegin(interface->pieces, MPIU_INT, interface->skin->symmetry, all, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(interface->pieces, MPIU_INT, interface->skin->symmetry, all, MPI_REPLACE));
  PetscCall(PetscArraycpy(mask, all, interface->n1));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode skin_destroy(Interface *interface)
{
  PetscFunctionBegin;
  if (!interface->skin) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(surface_destroy(&interface->skin->outer));
  PetscCall(PetscFree(interface->skin->pairs));
  PetscCall(PetscFree(interface->skin->symmetry));
  PetscCall(PetscFree(interface->skin));
  PetscFunctionReturn(PETSC_SUCCESS);
}
