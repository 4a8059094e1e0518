/* Nodal tractions: the force of the mortar on a node of the non-mortar side over the node's covered area, or over the
 * whole one where nothing is covered.
 *
 * On quadratic faces a uniform traction has nodal forces of either sign. There the force of a node in the middle of
 * corners goes to these in equal parts, which makes of a corner's force the integral of the traction with the corner's
 * linear function; the middle has the mean of its corners' tractions. */
#include "output/output.h"

/* Of a node at home: how many corners it is in the middle of, 1: it is one, and their numbers in the interface. */
enum { CORNERS = 4, WIDTH = 1 + CORNERS };

static PetscErrorCode find_corners(const Mesh *mesh, const Interface *interface, PetscInt corners[])
{
  const Surface *surface = interface->surface[0];
  PetscInt      *found;
  MPI_Datatype   node;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(WIDTH * surface->offsets[surface->n_faces], &found));
  for (PetscInt f = 0; f < surface->n_faces; f++) {
    const PetscInt *face = surface->vertices + surface->offsets[f];
    const CellKind  kind = mesh_face_kind(mesh, surface, f);
    for (PetscInt k = 0; k < cell_nodes(kind); k++) {
      PetscInt its[CELL_CORNERS], *of = found + WIDTH * (surface->offsets[f] + k);
      of[0] = cell_node_corners(kind, k, its);
      for (PetscInt c = 0; c < of[0]; c++)
        of[1 + c] = face[its[c]];
    }
  }
  PetscCallMPI(MPI_Type_contiguous(WIDTH, MPIU_INT, &node));
  PetscCallMPI(MPI_Type_commit(&node));
  PetscCall(PetscSFReduceBegin(interface->corners[0], node, found, corners, MPI_REPLACE)); /* whichever facet's: they are the same ones */
  PetscCall(PetscSFReduceEnd(interface->corners[0], node, found, corners, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&node));
  PetscCall(PetscFree(found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What travels between a node and its corners: the traction or force, the area. */
enum { AREA = 3, N_VALUES };

/* Adds each middle node's force, and where it has a multiplier of its own its area, to its corners. */
static PetscErrorCode give(const Interface *interface, PetscSF sf, const PetscInt corners[], PetscBool everywhere, double values[])
{
  double *sent;
  PetscInt n = 0;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(CORNERS * N_VALUES * interface->n1, &sent));
  for (PetscInt a = 0; a < interface->n1; a++) {
    const PetscInt count = corners[WIDTH * a];
    for (PetscInt c = 0; c < count && count > 1; c++, n++) {
      for (int i = 0; i < N_VALUES; i++)
        sent[N_VALUES * n + i] = i < AREA || everywhere ? values[N_VALUES * a + i] / (double)count : 0;
    }
  }
  for (PetscInt i = 0; i < N_VALUES; i++) { /* of one at a time: sums of numbers are what PETSc knows */
    double *one, *sums;
    PetscCall(PetscMalloc1(n, &one));
    PetscCall(PetscCalloc1(interface->n1 + interface->n2, &sums));
    for (PetscInt k = 0; k < n; k++)
      one[k] = sent[N_VALUES * k + i];
    for (PetscInt a = 0; a < interface->n1; a++)
      sums[a] = values[N_VALUES * a + i];
    PetscCall(PetscSFReduceBegin(sf, MPI_DOUBLE, one, sums, MPI_SUM));
    PetscCall(PetscSFReduceEnd(sf, MPI_DOUBLE, one, sums, MPI_SUM));
    for (PetscInt a = 0; a < interface->n1; a++)
      values[N_VALUES * a + i] = sums[a];
    PetscCall(PetscFree(one));
    PetscCall(PetscFree(sums));
  }
  PetscCall(PetscFree(sent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* from the corners' homes to the middle nodes: CORNERS at most each, those with more than one */
static PetscErrorCode map_corners(const Interface *interface, const PetscInt corners[], PetscInt *n, PetscSF *sf)
{
  PetscInt *numbers;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(CORNERS * interface->n1, &numbers));
  *n = 0;
  for (PetscInt a = 0; a < interface->n1; a++) {
    const PetscInt count = corners[WIDTH * a];
    for (PetscInt c = 0; c < count && count > 1; c++)
      numbers[(*n)++] = corners[WIDTH * a + 1 + c];
  }
  PetscCall(homes_fetch_create(interface, *n, numbers, sf));
  PetscCall(PetscFree(numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 3 per node at home of the non-mortar side */
PetscErrorCode nodal_tractions(const Mesh *mesh, const Interface *interface, const ContactStates *states,
                               double tractions[])
{
  const PetscBool everywhere = (PetscBool)(interface->method.multiplier_space == STICKSLIP_SPACE_SUB);
  double         *values, *theirs;
  PetscInt       *corners, n = 0, at = 0;
  PetscSF         sf = NULL;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(WIDTH * (interface->n1 + interface->n2), &corners, N_VALUES * (interface->n1 + interface->n2), &values));
  for (PetscInt a = 0; a < interface->n1; a++) {
    double *v = values + N_VALUES * a;
    contact_vector(interface->dimension, interface->forces, a, v);
    for (int i = 0; i < 3; i++)
      v[i] = -v[i];
    v[AREA] = states->coverage[a] > 0 ? states->coverage[a] : states->area[a];
    corners[WIDTH * a] = 1;
  }
  if (interface->middles) {
    PetscCall(find_corners(mesh, interface, corners));
    PetscCall(map_corners(interface, corners, &n, &sf));
    PetscCall(give(interface, sf, corners, everywhere, values));
  }
  for (PetscInt a = 0; a < interface->n1; a++) {
    double *v = values + N_VALUES * a;
    for (int i = 0; i < 3; i++)
      v[i] = tractions[3 * a + i] = corners[WIDTH * a] == 1 ? v[i] / v[AREA] : 0;
  }
  PetscCall(PetscMalloc1(N_VALUES * n, &theirs));
  if (sf) PetscCall(homes_bcast(sf, N_VALUES, values, theirs));
  for (PetscInt a = 0; a < interface->n1 && sf; a++) {
    const PetscInt count = corners[WIDTH * a];
    for (PetscInt c = 0; c < count && count > 1; c++, at++) {
      for (int i = 0; i < 3; i++)
        tractions[3 * a + i] += theirs[N_VALUES * at + i] / (double)count;
    }
  }
  PetscCall(PetscSFDestroy(&sf));
  PetscCall(PetscFree(theirs));
  PetscCall(PetscFree2(corners, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
