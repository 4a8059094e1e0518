/* Planes of symmetry: where both bodies glide on one plane, nothing can rub along its normal.
 *
 * A support that prescribes one component only, evenly, of vertices that lie in one plane across that axis is a wall
 * without friction. Where such a wall holds nodes of the non-mortar side, and it or another one in the same plane that
 * moves alike holds nodes of the mortar side, contact has no traction along the plane's normal: its multiplier is no
 * unknown, and the contact's normal lies in the plane.
 *
 * Left in, it would be an unknown that next to nothing decides. The node's own displacement is prescribed, and along a
 * row of nodes the multipliers along the plane's normal can alternate in such a way that the forces on the other nodes
 * vanish; only the strain of the mortar side tells how large they are. The stiffer that is, the closer the matrix comes
 * to a singular one, and Newton's method throws these multipliers from one side of the friction cone to the other.
 *
 * A rim that is held in more than one component is no plane of symmetry: shear can act across it, and the patch test
 * needs all multipliers there. */
#include "contact/contact.h"

/* Vertices this close, relative to the size of the mesh, lie in one plane: mesh files keep at least 7 digits. */
static const PetscReal SAME_PLANE = 1e-6;

enum { NO_PLANE = -1 };

typedef struct {
  int       axis; /* NO_PLANE: the support is no such wall */
  PetscReal position;
} Plane;

static PetscReal mesh_size(const Mesh *mesh)
{
  PetscReal size = 0;
  for (int i = 0; i < 3; i++) {
    PetscReal least = PETSC_MAX_REAL, most = PETSC_MIN_REAL;
    for (PetscInt v = 0; v < mesh->n_vertices; v++) {
      least = PetscMin(least, mesh->coordinates[3 * v + i]);
      most  = PetscMax(most, mesh->coordinates[3 * v + i]);
    }
    size = PetscMax(size, most - least);
  }
  return size;
}

static Plane plane_of(const Mesh *mesh, const Support *support, PetscReal tolerance)
{
  Plane plane = {.axis = NO_PLANE};
  int   axis  = 0;
  if (support->given || !support->n_vertices) return plane;
  for (int k = 0; k < 9; k++) {
    if (support->gradient[k] != 0 || support->rotate[k % 3] != 0) return plane;
  }
  while (axis < 3 && support->mask != 1 << axis)
    axis++;
  if (axis == 3) return plane;
  plane.position = mesh->coordinates[3 * support->vertices[0] + axis];
  for (PetscInt k = 1; k < support->n_vertices; k++) {
    if (PetscAbsReal(mesh->coordinates[3 * support->vertices[k] + axis] - plane.position) > tolerance) return plane;
  }
  plane.axis = axis;
  return plane;
}

/* how many of these nodes; `held` n_vertices of the mesh, all false before and after */
static PetscInt count_held(const Support *support, PetscInt n, const PetscInt *nodes, PetscBool *held)
{
  PetscInt count = 0;
  for (PetscInt k = 0; k < support->n_vertices; k++)
    held[support->vertices[k]] = PETSC_TRUE;
  for (PetscInt a = 0; a < n; a++)
    count += held[nodes[a]];
  for (PetscInt k = 0; k < support->n_vertices; k++)
    held[support->vertices[k]] = PETSC_FALSE;
  return count;
}

/* rank 0: adds to each vertex' mask (all of the mesh) the normal of the planes of symmetry that it lies in */
PetscErrorCode symmetry_mask(const Physics *physics, const Interface *interface, PetscInt *mask)
{
  const Mesh     *mesh      = physics->mesh;
  const PetscReal tolerance = SAME_PLANE * mesh_size(mesh);
  PetscBool      *held;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(mesh->n_vertices, &held));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const Support  *wall  = &physics->supports[s];
    const Plane     plane = plane_of(mesh, wall, tolerance);
    PetscInt        n1;
    PetscBool       both = PETSC_FALSE;
    if (plane.axis == NO_PLANE) continue;
    n1 = count_held(wall, interface->n1, interface->nodes, held);
    if (!n1 || n1 == interface->n1) continue; /* a surface that lies in the plane is not cut by it */
    for (PetscInt t = 0; t < physics->n_supports && !both; t++) {
      const Support *other = &physics->supports[t];
      const Plane    its   = plane_of(mesh, other, tolerance);
      both = its.axis == plane.axis && PetscAbsReal(its.position - plane.position) <= tolerance &&
             supports_agree(physics, wall, other, wall->vertices[0], plane.axis) &&
             count_held(other, interface->n2, interface->nodes + interface->n1, held) > 0;
    }
    for (PetscInt k = 0; k < wall->n_vertices && both; k++)
      mask[wall->vertices[k]] |= 1 << plane.axis;
  }
  PetscCall(PetscFree(held));
  PetscFunctionReturn(PETSC_SUCCESS);
}
