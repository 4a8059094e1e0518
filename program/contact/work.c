/* What the contact of each node costs, for partitions, and how deep the bodies are in each other. */
#include "contact/contact.h"
#include <time.h>

/* of a part's facets, both sides */
static PetscReal shortest_edge(const ContactPart *part)
{
  PetscReal squared = PETSC_MAX_REAL;
  for (int side = 0; side < 2; side++) {
    const double *x = part->X + (side ? part->dimension * part->n1 : 0);
    for (PetscInt f = 0; f < part->n_facets[side]; f++) {
      const PetscInt *nodes = part->facet_nodes[side] + part->offsets[side][f];
      const PetscInt  n     = part->offsets[side][f + 1] - part->offsets[side][f];
      for (PetscInt k = 0; k < n; k++) {
        PetscReal sum = 0;
        for (PetscInt i = 0; i < part->dimension; i++)
          sum += PetscSqr(x[part->dimension * nodes[k] + i] - x[part->dimension * nodes[(k + 1) % n] + i]);
        squared = PetscMin(squared, sum);
      }
    }
  }
  return PetscSqrtReal(squared);
}

/* At the positions of the parts: the mortar facets over each node, and one for the node (at home); how deep the bodies are in
 * each other, in facets; the shortest edge. */
PetscErrorCode work_measure(const Interface *interface, PetscMPIInt rank, double work[], PetscReal *depth, PetscReal *shortest)
{
  const ContactPart *part     = &interface->part;
  ContactCover       cover;
  int64_t           *facets;
  double            *here;

  PetscFunctionBegin;
  *shortest = part->handle ? shortest_edge(part) : PETSC_MAX_REAL;
  PetscCall(PetscCalloc2(part->n1, &facets, part->n1, &here));
  PetscCall(contact_cover(interface, part->handle, rank, &cover, facets));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, shortest, 1, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  *depth = cover.penetration / *shortest;
  for (PetscInt a = 0; a < part->n1; a++)
    here[a] = 1 + (double)facets[a];
  PetscCall(parts_collect(part, 1, here, work));
  PetscCall(PetscFree2(facets, here));
  PetscFunctionReturn(PETSC_SUCCESS);
}

double work_clock(void)
{
  return (double)clock() / CLOCKS_PER_SEC;
}

/* array by array, as contact.h has them */
PetscLogDouble work_bytes(const ContactPart *part)
{
  const PetscLogDouble n1 = part->n1, n = part->n1 + part->n2, entries = part->dimension * n + part->components * n1;
  PetscLogDouble       bytes = entries * 8 * (5 + 4 + 4) + n * 4 * sizeof(PetscInt) + n1 * (6 * sizeof(PetscInt) + 8 * (part->dimension + 2));
  bytes += (PetscLogDouble)part->coo_capacity * (2 * sizeof(int64_t) + sizeof(double));
  for (int side = 0; side < 2; side++) {
    const PetscInt n_facets = part->n_facets[side];
    bytes += (2.0 * n_facets + 1 + (part->offsets[side] ? part->offsets[side][n_facets] : 0)) * sizeof(PetscInt);
  }
  return bytes;
}
