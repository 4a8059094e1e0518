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
  PetscReal X[3]; /* of its first vertex */
} Plane;

static PetscErrorCode mesh_size(const Mesh *mesh, PetscReal *size)
{
  Extent extent = extent_of_nothing();
  PetscFunctionBegin;
  for (PetscInt v = 0; v < mesh->n_vertices; v++)
    extent_add(&extent, mesh->coordinates + 3 * v);
  PetscCall(extent_of_all(&extent));
  *size = extent_longest(&extent);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the place of a support's first vertex, on every rank; `any`: there is one */
static PetscErrorCode first_place(const Mesh *mesh, const Support *support, PetscReal X[3], PetscBool *any)
{
  const PetscInt mine  = support->n_vertices ? mesh->numbers[support->vertices[0]] : PETSC_MAX_INT;
  PetscInt       first = mine;
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPIU_INT, MPI_MIN, PETSC_COMM_WORLD));
  *any = (PetscBool)(first < PETSC_MAX_INT);
  for (int i = 0; i < 3; i++)
    X[i] = *any && mine == first ? mesh->coordinates[3 * support->vertices[0] + i] : PETSC_MIN_REAL;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, X, 3, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the axis of a support that prescribes one component only, evenly */
static int glides_across(const Support *support)
{
  int axis = 0;
  if (support->from_file) return NO_PLANE;
  for (int k = 0; k < 9; k++) {
    if (support->gradient[k] != 0 || support->rotate[k % 3] != 0) return NO_PLANE;
  }
  while (axis < 3 && support->mask != 1 << axis)
    axis++;
  return axis < 3 ? axis : NO_PLANE;
}

static PetscErrorCode find_plane(const Mesh *mesh, const Support *support, PetscReal tolerance, Plane *plane)
{
  const int axis = glides_across(support);
  PetscBool flat;
  PetscFunctionBegin;
  PetscCall(first_place(mesh, support, plane->X, &flat));
  for (PetscInt k = 0; k < support->n_vertices && flat && axis != NO_PLANE; k++)
    flat = (PetscBool)!(PetscAbsReal(mesh->coordinates[3 * support->vertices[k] + axis] - plane->X[axis]) > tolerance);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &flat, 1, MPIU_BOOL, MPI_LAND, PETSC_COMM_WORLD));
  plane->axis = flat ? axis : NO_PLANE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which nodes of an interface a support holds, and how many of each side on all ranks. */
static PetscErrorCode find_held(const Mesh *mesh, const Support *support, const Interface *interface, PetscInt held[],
                                PetscInt counts[2])
{
  PetscInt *here;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(mesh->n_vertices, &here));
  for (PetscInt k = 0; k < support->n_vertices; k++)
    here[support->vertices[k]] = 1;
  PetscCall(PetscSFBcastBegin(interface->pieces, MPIU_INT, here, held, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(interface->pieces, MPIU_INT, here, held, MPI_REPLACE));
  PetscCall(PetscFree(here));
  counts[0] = counts[1] = 0;
  for (PetscInt k = 0; k < interface->n1 + interface->n2; k++)
    counts[k >= interface->n1] += held[k];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, counts, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a wall that holds some of the non-mortar nodes continued by one that holds mortar nodes? */
static PetscErrorCode find_other(const Physics *physics, const Interface *interface, PetscInt wall, const Plane planes[],
                                 PetscReal tolerance, PetscBool *both)
{
  const Plane *plane = &planes[wall];
  PetscInt    *held, counts[2];
  PetscFunctionBegin;
  *both = PETSC_FALSE;
  PetscCall(PetscMalloc1(interface->n1 + interface->n2, &held));
  for (PetscInt t = 0; t < physics->n_supports && !*both; t++) {
    if (planes[t].axis != plane->axis || PetscAbsReal(planes[t].X[plane->axis] - plane->X[plane->axis]) > tolerance) continue;
    if (!supports_agree(physics, &physics->supports[wall], &physics->supports[t], -1, plane->X, plane->axis)) continue;
    PetscCall(find_held(physics->mesh, &physics->supports[t], interface, held, counts));
    *both = (PetscBool)(counts[1] > 0);
  }
  PetscCall(PetscFree(held));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the vertices of the piece: the axes along which supports of one component hold them, as walls without friction do; and how near counts
 * as in one plane. */
PetscErrorCode symmetry_walls(const Physics *physics, PetscInt axes[], PetscReal *tolerance)
{
  PetscFunctionBegin;
  PetscCall(mesh_size(physics->mesh, tolerance));
  *tolerance *= SAME_PLANE;
  PetscCall(PetscArrayzero(axes, physics->mesh->n_vertices));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    const Support *support = &physics->supports[s];
    const int      axis    = glides_across(support);
    for (PetscInt k = 0; k < support->n_vertices && axis != NO_PLANE; k++)
      axes[support->vertices[k]] |= 1 << axis;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* adds to each non-mortar node's mask the normal of the planes of symmetry that it lies in */
PetscErrorCode symmetry_mask(const Physics *physics, const Interface *interface, PetscInt mask[])
{
  const Mesh *mesh = physics->mesh;
  PetscReal   tolerance = 0;
  PetscInt   *held;
  Plane      *planes;

  PetscFunctionBegin;
  PetscCall(mesh_size(mesh, &tolerance));
  tolerance *= SAME_PLANE;
  PetscCall(PetscMalloc2(interface->n1 + interface->n2, &held, physics->n_supports, &planes));
  for (PetscInt s = 0; s < physics->n_supports; s++)
    PetscCall(find_plane(mesh, &physics->supports[s], tolerance, &planes[s]));
  for (PetscInt s = 0; s < physics->n_supports; s++) {
    PetscInt  counts[2];
    PetscBool both;
    if (planes[s].axis == NO_PLANE) continue;
    PetscCall(find_held(mesh, &physics->supports[s], interface, held, counts));
    if (!counts[0] || counts[0] == interface->all[0]) continue; /* a surface that lies in the plane is not cut by it */
    PetscCall(find_other(physics, interface, s, planes, tolerance, &both));
    for (PetscInt a = 0; a < interface->n1 && both; a++)
      mask[a] |= held[a] << planes[s].axis;
  }
  PetscCall(PetscFree2(held, planes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
