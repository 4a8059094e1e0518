/* Surfaces that are not where their meshes are: offsets of the non-mortar nodes, over time, and facets of round sides. */
#include "contact/contact.h"

/* A point of `offset_at` and a node that are farther apart than this, over the interface's size, are two places. */
static const PetscReal SAME_PLACE = 1e-6;

/* The round sides: `round`, `centre`, `axis`, `nonmortar_radius`, `mortar_radius`. */
static void read_round(Scene *scene, const Space *space, Interface *interface)
{
  static const char *const solid[] = {"sphere", "cylinder", NULL}, *const plane[] = {"circle", NULL};
  static const char *const radius_key[] = {"nonmortar_radius", "mortar_radius"};
  const char              *name  = interface->name;
  const PetscBool          flat  = (PetscBool)(space_dimension(space) == 2);
  Offsets                 *round = &interface->offsets;
  PetscInt                 shape = 0;

  for (int side = 0; side < 2; side++) {
    scene_real(scene, name, radius_key[side], &round->radius[side]);
    if (scene_has(scene, name, radius_key[side]) && round->radius[side] == 0)
      scene_fail(scene, name, radius_key[side], "positive: the body is inside; negative: it is around a bore. Zero is neither.");
  }
  if (!scene_has(scene, name, "round")) {
    for (int side = 0; side < 2; side++) {
      if (round->radius[side] != 0)
        scene_fail(scene, name, radius_key[side], "it needs `round: %s`.", flat ? "circle" : "sphere or cylinder");
    }
    return;
  }
  scene_choice(scene, name, "round", flat ? plane : solid, &shape);
  round->shape   = flat || shape ? STICKSLIP_SHAPE_CYLINDER : STICKSLIP_SHAPE_SPHERE;
  round->axis[2] = 1;
  (void)space_vector(scene, space, name, "centre", round->centre);
  if (!flat && round->shape == STICKSLIP_SHAPE_CYLINDER && !space_vector(scene, space, name, "axis", round->axis))
    scene_fail(scene, name, "axis", "this key is missing: the direction of the cylinder's axis.");
  if (round->radius[0] == 0 && round->radius[1] == 0)
    scene_fail(scene, name, "round", "which side is round? Give it its radius: nonmortar_radius, mortar_radius.");
}

PetscErrorCode offsets_read(Scene *scene, const Physics *physics, Interface *interface)
{
  const Space *space   = &physics->mesh->space;
  Offsets     *offsets = &interface->offsets;
  const char  *name    = interface->name;
  PetscFunctionBegin;
  scene_real(scene, name, "offset", &offsets->all);
  scene_reals(scene, name, "offset_at", &offsets->n_points, &offsets->points);
  if (offsets->n_points % (interface->dimension + 1))
    scene_fail(scene, name, "offset_at", "%d numbers a node are expected, its place and its offset.", (int)interface->dimension + 1);
  offsets->n_points /= interface->dimension + 1;
  read_round(scene, space, interface);
  offsets->any = (PetscBool)(offsets->all != 0 || offsets->n_points || offsets->radius[0] != 0 || offsets->radius[1] != 0);
  if (scene_has(scene, name, "offset_curve")) {
    if (offsets->all == 0 && !offsets->n_points)
      scene_fail(scene, name, "offset_curve", "a factor on `offset` or `offset_at`, of which there is none.");
    PetscCall(curve_read(scene, name, "offset_curve", physics->end, &offsets->curve));
  }
  scene_real(scene, name, "adjust", &offsets->adjust);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The node of least number at a point, or -1: none of this rank's. */
static PetscInt node_at(const Interface *interface, const PetscReal point[], PetscReal tolerance_squared)
{
  for (PetscInt a = 0; a < interface->n1; a++) {
    const PetscReal *x = interface->place + 3 * a;
    PetscReal        square = 0;
    for (PetscInt i = 0; i < interface->dimension; i++)
      square += PetscSqr(x[i] - point[i]);
    if (square <= tolerance_squared) return a;
  }
  return -1;
}

/* Which nodes `offset_at` means. */
PetscErrorCode offsets_place(Scene *scene, Interface *interface)
{
  Offsets       *offsets = &interface->offsets;
  const PetscInt d       = interface->dimension;
  Extent         extent  = extent_of_nothing();
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(interface->n1 + interface->n2, &offsets->nodal, interface->n1 + interface->n2, &offsets->round));
  for (PetscInt a = 0; a < interface->n1; a++) {
    offsets->nodal[a] = offsets->all;
    extent_add(&extent, interface->place + 3 * a);
  }
  PetscCall(extent_of_all(&extent));
  for (PetscInt p = 0; p < offsets->n_points; p++) {
    const PetscReal *point = offsets->points + (d + 1) * p;
    const PetscInt   found = node_at(interface, point, PetscSqr(SAME_PLACE) * extent_diagonal_squared(&extent));
    PetscInt         first = found < 0 ? PETSC_MAX_INT : homes_number(interface, found);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPIU_INT, MPI_MIN, PETSC_COMM_WORLD));
    if (first == PETSC_MAX_INT)
      scene_fail(scene, interface->name, "offset_at", "no node of the non-mortar surface is at the place of point %d of the list.",
                 (int)p + 1);
    if (found >= 0 && first == homes_number(interface, found)) offsets->nodal[found] = point[d];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Those of the nodes of a part, through an SF from homes to them. */
PetscErrorCode offsets_fetch(PetscSF sf, Interface *interface)
{
  Offsets       *offsets = &interface->offsets;
  const PetscInt n       = interface->part.n1 + interface->part.n2;
  PetscFunctionBegin;
  if (!offsets->any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3(offsets->part_nodal, offsets->part_round, offsets->now)); /* of a part before */
  PetscCall(PetscMalloc3(n, &offsets->part_nodal, n, &offsets->part_round, n, &offsets->now));
  PetscCall(PetscSFBcastBegin(sf, MPI_DOUBLE, offsets->nodal, offsets->part_nodal, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPI_DOUBLE, offsets->nodal, offsets->part_nodal, MPI_REPLACE));
  PetscCall(PetscSFBcastBegin(sf, MPI_DOUBLE, offsets->round, offsets->part_round, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(sf, MPI_DOUBLE, offsets->round, offsets->part_round, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Those of time t, of any handle of the interface's part. */
int32_t offsets_set(const Interface *interface, stickslip_interface *handle, PetscReal t)
{
  const Offsets     *offsets = &interface->offsets;
  const ContactPart *part    = &interface->part;
  const PetscReal    factor  = offsets->curve.n ? curve_value(&offsets->curve, t) : 1;
  if (!offsets->any) return STICKSLIP_OK;
  for (PetscInt k = 0; k < part->n1 + part->n2; k++)
    offsets->now[k] = factor * offsets->part_nodal[k] + offsets->part_round[k];
  return stickslip_interface_set_offsets(handle, offsets->now, offsets->radius[1] != 0 ? offsets->now + part->n1 : NULL);
}

/* Those of time t, of all interfaces that change with it. */
PetscErrorCode offsets_values(Contact *contact, PetscReal t, PetscInt *status)
{
  PetscFunctionBegin;
  *status = 0;
  for (PetscInt i = 0; i < contact->n_interfaces && !*status; i++) {
    Interface *interface = &contact->interfaces[i];
    int32_t    refused   = 0;
    if (!interface->offsets.any || !interface->offsets.curve.n) continue;
    if (interface->part.handle) refused = offsets_set(interface, interface->part.handle, t);
    interface->part.planned = 0; /* other pairs may meet */
    PetscCall(contact_agree(contact, interface, refused, status));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode offsets_destroy(Interface *interface)
{
  Offsets *offsets = &interface->offsets;
  PetscFunctionBegin;
  PetscCall(PetscFree3(offsets->part_nodal, offsets->part_round, offsets->now));
  PetscCall(PetscFree2(offsets->nodal, offsets->round));
  PetscCall(PetscFree(offsets->points));
  PetscCall(PetscFree(offsets->curve.points));
  PetscCall(PetscFree2(offsets->gaps, offsets->moved));
  PetscFunctionReturn(PETSC_SUCCESS);
}
