/* Weights of the reference have normals of the reference, too: the theory of small displacements. Where a surface turns by an angle theta
 * a pressure p goes on acting along its first normal, so that p sin(theta) of it acts along the surface as it is now, as a shear that no
 * law of friction has allowed, and p (1 - cos(theta)) is missing. Both sides turning together makes no difference. How far the non-mortar
 * facets that bear load have turned is measured here; an angle counts by the part that the traction there is of the largest one. Offsets of
 * tied surfaces are along the normals of the reference, too, whatever the weights: of an offset h the part h sin(theta) is along the surface. */
#include "contact/contact.h"

/* Twice the area of a facet times its normal, from its corners; of a line its length times the normal. */
static void facet_normal(PetscInt dimension, PetscInt n, const PetscInt nodes[], const double x[], PetscReal normal[3])
{
  const PetscInt corners = cell_corners(cell_kind(dimension - 1, n));
  PetscReal      first[3], a[3], b[3];
  normal[0] = normal[1] = normal[2] = 0;
  contact_vector(dimension, x, nodes[0], first);
  for (PetscInt k = 1; k < PetscMax(corners - 1, 2); k++) {
    contact_vector(dimension, x, nodes[k], a);
    contact_vector(dimension, x, nodes[PetscMin(k + 1, corners - 1)], b);
    for (int i = 0; i < 3; i++) {
      a[i] -= first[i];
      b[i] = dimension == 2 ? i == 2 : b[i] - first[i];
    }
    for (int i = 0; i < 3; i++)
      normal[i] += a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
  }
}

/* The angle between two vectors, exact where it is small. */
static PetscReal angle_of(const PetscReal a[3], const PetscReal b[3])
{
  PetscReal cross = 0, dot = 0;
  for (int i = 0; i < 3; i++) {
    cross += PetscSqr(a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
    dot += a[i] * b[i];
  }
  return PetscAtan2Real(PetscSqrtReal(cross), dot);
}

/* The largest traction at the nodes of a facet that are closed, over the largest of all. */
static PetscReal load_of(PetscInt n, const PetscInt nodes[], const double results[], PetscReal scale)
{
  PetscReal most = 0;
  for (PetscInt k = 0; k < n; k++) {
    const double *result = results + N_RESULTS * nodes[k], *lambda = result + RESULT_MULTIPLIER;
    if (result[RESULT_STATE] == STICKSLIP_STATE_GAP) continue;
    most = PetscMax(most, PetscSqrtReal(PetscSqr(lambda[0]) + PetscSqr(lambda[1]) + PetscSqr(lambda[2])));
  }
  return scale > 0 ? PetscMin(most / scale, 1) : 0;
}

/* Of this part's facets: the largest, and the first node of the facet. */
static void measure_part(const Interface *interface, const double results[], PetscReal *most, PetscReal where[3])
{
  const ContactPart *part = &interface->part;
  for (PetscInt f = 0; f < part->n_facets[0]; f++) {
    const PetscInt  n = part->offsets[0][f + 1] - part->offsets[0][f], *nodes = part->facet_nodes[0] + part->offsets[0][f];
    const PetscReal load = load_of(n, nodes, results, interface->equilibrium.traction_scale);
    PetscReal       before[3], now[3], turned;
    if (!(load > 0)) continue;
    facet_normal(part->dimension, n, nodes, part->X, before);
    facet_normal(part->dimension, n, nodes, part->x, now);
    turned = load * angle_of(before, now);
    if (turned <= *most) continue;
    *most = turned;
    contact_vector(part->dimension, part->X, nodes[0], where);
  }
}

PetscBool turned_offsets(const Interface *interface)
{
  return (PetscBool)(interface->options.friction == STICKSLIP_FRICTION_TIED && interface->offsets.any);
}

PetscErrorCode turned_measure(Interface *interface, const Mesh *mesh)
{
  const ContactPart *part     = &interface->part;
  Frozen            *turn     = &interface->turn;
  PetscReal          where[3] = {0, 0, 0};
  double            *results;
  PetscFunctionBegin;
  turn->amount = 0;
  if (interface->options.friction == STICKSLIP_FRICTION_TIED && !turned_offsets(interface))
    PetscFunctionReturn(PETSC_SUCCESS); /* it turns with its facets */
  PetscCall(PetscMalloc1(N_RESULTS * part->n1, &results));
  PetscCall(contact_results(part, results));
  if (part->handle) measure_part(interface, results, &turn->amount, where);
  PetscCall(PetscFree(results));
  PetscCall(contact_largest(mesh, &turn->amount, sizeof(where), where));
  PetscCall(PetscSNPrintf(turn->words, sizeof(turn->words),
                          "%s has turned by %.2g radians since its weights were made, at the facet at (%g, %g, %g): %.2g %% of the %s "
                          "there acts along the surface as it is now",
                          interface->name, (double)turn->amount, (double)where[0], (double)where[1], (double)where[2],
                          (double)(100 * PetscSinReal(turn->amount)), turned_offsets(interface) ? "offset" : "pressure"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
