/* The surfaces of an interface, from the pieces of the mesh dealt out to all ranks: faces, nodes, where these are and what is prescribed
 * there. */
#include "contact/skin.h"

/* A vertex has a node of one side only. */
static PetscErrorCode check_apart(Scene *scene, const Mesh *mesh, const Interface *interface)
{
  const PetscInt n = interface->n1 + interface->n2;
  PetscInt       n_here, *sides, *kept;
  PetscBool      apart = PETSC_TRUE;
  PetscSF        directory;
  PetscFunctionBegin;
  PetscCall(directory_create(mesh, n, interface->nodes, &n_here, &directory));
  PetscCall(PetscMalloc1(n, &sides));
  PetscCall(PetscCalloc1(n_here, &kept));
  for (PetscInt k = 0; k < n; k++)
    sides[k] = k < interface->n1 ? 1 : 2;
  PetscCall(PetscSFReduceBegin(directory, MPIU_INT, sides, kept, MPI_BOR));
  PetscCall(PetscSFReduceEnd(directory, MPIU_INT, sides, kept, MPI_BOR));
  for (PetscInt k = 0; k < n_here; k++)
    apart = (PetscBool)(apart && kept[k] != 3);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &apart, 1, MPIU_BOOL, MPI_LAND, PETSC_COMM_WORLD));
  PetscCall(PetscSFDestroy(&directory));
  PetscCall(PetscFree(sides));
  PetscCall(PetscFree(kept));
  if (!apart)
    scene_fail(scene, interface->name, "mortar",
               "the two surfaces share a vertex; contact of a surface with itself is not supported.");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* of either side, which has a node of number 0 somewhere */
static PetscErrorCode find_bodies(const Mesh *mesh, Interface *interface)
{
  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) {
    PetscInt k = side ? interface->n1 : 0, body = -1;
    if (interface->first[side] == 0 && (side ? interface->n2 : interface->n1) > 0) body = mesh_body_of(mesh, interface->nodes[k]);
    PetscCallMPI(MPI_Allreduce(&body, &interface->body[side], 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
    if (interface->skin) interface->body[side] = interface->body[0]; /* which has all bodies */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Three numbers a node, from or to the pieces. */
static PetscErrorCode fetch_places(const Mesh *mesh, Interface *interface)
{
  MPI_Datatype vector;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Type_contiguous(3, MPIU_REAL, &vector));
  PetscCallMPI(MPI_Type_commit(&vector));
  PetscCall(PetscSFBcastBegin(interface->pieces, vector, mesh->coordinates, interface->place, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(interface->pieces, vector, mesh->coordinates, interface->place, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&vector));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each copy of a vertex has been moved along its own normal: the vertex goes all these ways. */
static PetscErrorCode join_ways(const Mesh *mesh, const Interface *interface)
{
  const PetscInt n = interface->n1 + interface->n2;
  PetscReal     *one, *sum;
  PetscFunctionBegin;
  if (!interface->n_copies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(n, &one, mesh->n_vertices, &sum));
  for (int i = 0; i < 3; i++) {
    for (PetscInt v = 0; v < mesh->n_vertices; v++)
      sum[v] = mesh->coordinates[3 * v + i];
    PetscCall(PetscSFBcastBegin(interface->pieces, MPIU_REAL, sum, one, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(interface->pieces, MPIU_REAL, sum, one, MPI_REPLACE));
    for (PetscInt k = 0; k < n; k++)
      one[k] = interface->place[3 * k + i] - one[k];
    PetscCall(PetscSFReduceBegin(interface->pieces, MPIU_REAL, one, sum, MPIU_SUM));
    PetscCall(PetscSFReduceEnd(interface->pieces, MPIU_REAL, one, sum, MPIU_SUM));
    PetscCall(PetscSFBcastBegin(interface->pieces, MPIU_REAL, sum, one, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(interface->pieces, MPIU_REAL, sum, one, MPI_REPLACE));
    for (PetscInt k = 0; k < n; k++)
      interface->place[3 * k + i] = one[k];
  }
  PetscCall(PetscFree2(one, sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode surfaces_move(Contact *contact, const Interface *interface)
{
  Mesh        *mesh = contact->mesh;
  MPI_Datatype vector;
  PetscFunctionBegin;
  PetscCall(join_ways(mesh, interface));
  PetscCallMPI(MPI_Type_contiguous(3, MPIU_REAL, &vector));
  PetscCallMPI(MPI_Type_commit(&vector));
  PetscCall(PetscSFReduceBegin(interface->pieces, vector, interface->place, mesh->coordinates, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(interface->pieces, vector, interface->place, mesh->coordinates, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&vector));
  PetscCall(pieces_copy(mesh, 3, mesh->coordinates));
  /* Interfaces that were read before may have some of these nodes, too. */
  for (PetscInt i = 0; &contact->interfaces[i] <= interface; i++)
    PetscCall(fetch_places(mesh, &contact->interfaces[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The surfaces that the scene names, as all ranks know them. */
static PetscErrorCode find(Scene *scene, const Mesh *mesh, Interface *interface, const Surface *found[2])
{
  static const char *const side_key[] = {"nonmortar", "mortar"};
  PetscFunctionBegin;
  for (int side = 0; side < 2; side++) {
    found[side] = mesh_side(scene, mesh, interface->name, side_key[side]);
    if (found[side]->inner) scene_fail(scene, interface->name, side_key[side], "'%s' lies inside a body.", found[side]->name);
    if (found[side]->analytic && side == 0)
      scene_fail(scene, interface->name, side_key[side], "'%s' is analytic: it can be the mortar side only.", found[side]->name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the vertices of both sides, what there is to know of them here. */
static PetscErrorCode make_nodes(const Mesh *mesh, Interface *interface, PetscInt *const nodes[2])
{
  const PetscInt n = interface->n1 + interface->n2;
  PetscFunctionBegin;
  PetscCall(PetscCalloc4(n, &interface->nodes, 3 * n, &interface->place, n, &interface->prescribed, n, &interface->part_of));
  PetscCall(PetscArraycpy(interface->nodes, nodes[0], interface->n1));
  PetscCall(PetscArraycpy(interface->nodes + interface->n1, nodes[1], interface->n2));
  PetscCall(homes_create(mesh, interface));
  PetscCall(pieces_fetch_create(mesh, n, interface->nodes, &interface->pieces));
  PetscCall(fetch_places(mesh, interface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode forget_nodes(Interface *interface)
{
  PetscFunctionBegin;
  PetscCall(PetscFree4(interface->nodes, interface->place, interface->prescribed, interface->part_of));
  PetscCall(PetscSFDestroy(&interface->pieces));
  PetscCall(homes_destroy(interface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode surfaces_read(Scene *scene, Contact *contact, Interface *interface)
{
  const Mesh    *mesh = contact->mesh;
  PetscInt       none    = 0;
  const Surface  nothing = {.name = "nothing", .offsets = &none}, *found[2];
  TimedSides     sides;
  PetscInt      *nodes[2], *split;
  PetscFunctionBegin;
  if (interface->skin) {
    PetscCall(skin_find(scene, contact, interface));
    found[0] = &interface->skin->outer;
    found[1] = &nothing;
  } else {
    PetscCall(find(scene, mesh, interface, found));
  }
  sides = (TimedSides){interface->name, {found[0], found[1]}, (PetscBool)(interface->components == 1), contact->condensed};
  PetscCall(timed_refuse(scene, contact->physics, &sides));
  for (int side = 0; side < 2; side++) {
    PetscCall(surface_share(mesh, found[side], &interface->share[side], side ? &interface->n2 : &interface->n1, &nodes[side]));
    interface->surface[side] = &interface->share[side];
  }
  PetscCall(PetscCalloc1(interface->n1, &interface->copies));
  PetscCall(make_nodes(mesh, interface, nodes));
  PetscCall(find_bodies(mesh, interface));
  PetscCall(check_apart(scene, mesh, interface));
  PetscCall(creases_split(scene, contact, interface, &split));
  if (split) {
    PetscCall(PetscFree(nodes[0]));
    nodes[0] = split;
    PetscCall(forget_nodes(interface));
    PetscCall(make_nodes(mesh, interface, nodes));
  }
  PetscCall(PetscFree(nodes[0]));
  PetscCall(PetscFree(nodes[1]));
  PetscCall(PetscSFBcastBegin(interface->pieces, MPIU_INT, contact->physics->prescribed, interface->prescribed, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(interface->pieces, MPIU_INT, contact->physics->prescribed, interface->prescribed, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode surfaces_destroy(Interface *interface)
{
  PetscFunctionBegin;
  for (int side = 0; side < 2; side++)
    PetscCall(surface_destroy(&interface->share[side]));
  PetscCall(PetscFree(interface->copies));
  PetscCall(forget_nodes(interface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Facets with nodes in the middle of their edges, on either side: their condensation wants all of them in one handle. */
PetscErrorCode surfaces_have_middles(const Mesh *mesh, const Interface *interface, PetscBool *any)
{
  PetscFunctionBegin;
  *any = PETSC_FALSE;
  for (int side = 0; side < 2; side++) {
    const Surface *surface = interface->surface[side];
    for (PetscInt f = 0; f < surface->n_faces; f++)
      *any = (PetscBool)(*any || surface->offsets[f + 1] - surface->offsets[f] > cell_corners(mesh_face_kind(mesh, surface, f)));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 1, MPIU_BOOL, MPI_LOR, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}
