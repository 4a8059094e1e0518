/* Offsets that vary along a surface, and depths that are worn off, slant the surface that is meant against its mesh. Gaps follow them, normals are the
 * mesh's: a foot without friction that a wedge of offsets makes slope by a tenth pushes aside with a tenth of its load. It is told at the end. */
#include "contact/contact.h"

/* A slope that is told, over friction, and where there is none, or much, over a half. */
static const PetscReal TOLD = 0.02, MUCH = 0.5;

/* How far the surface that is meant is from its mesh, at a node of a part. */
static PetscReal height(const Interface *interface, const double result[], PetscReal factor, PetscInt a)
{
  const Offsets *offsets = &interface->offsets;
  return (offsets->n_points ? factor * offsets->part_nodal[a] : 0) - result[RESULT_LAYER + LAYER_WORN];
}

/* The length of its gradient on a facet, by three of its corners, or a line's two ends. */
static PetscReal slope_of(PetscInt dimension, const PetscReal x[3][3], const PetscReal h[3])
{
  PetscReal a[3], b[3], aa = 0, ab = 0, bb = 0, det;
  const PetscReal ha = h[1] - h[0], hb = h[2] - h[0];
  for (int i = 0; i < 3; i++) {
    a[i] = x[1][i] - x[0][i], b[i] = x[2][i] - x[0][i];
    aa += a[i] * a[i], ab += a[i] * b[i], bb += b[i] * b[i];
  }
  if (dimension == 2) return aa > 0 ? PetscAbsReal(ha) / PetscSqrtReal(aa) : 0;
  det = aa * bb - ab * ab;
  return det > 0 ? PetscSqrtReal(PetscMax(0, (ha * ha * bb - 2 * ha * hb * ab + hb * hb * aa) / det)) : 0;
}

/* sums[0]: pressures of the corners of a part's facets; sums[1]: times the slope there; sums[2]: times the friction. */
static PetscErrorCode add_slopes(const Mesh *mesh, const Interface *interface, PetscReal factor, PetscReal sums[3])
{
  const ContactPart *part = &interface->part;
  double            *results;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(N_RESULTS * part->n1, &results));
  PetscCall(contact_results(part, results));
  for (PetscInt f = 0; f < part->n_facets[0]; f++) {
    const PetscInt *nodes = part->facet_nodes[0] + part->offsets[0][f], n = part->offsets[0][f + 1] - part->offsets[0][f];
    const PetscInt  corners = cell_corners(cell_kind(part->dimension - 1, n)), three[3] = {0, 1, corners - 1};
    PetscReal       x[3][3], h[3], slope;
    for (int k = 0; k < 3; k++) {
      contact_vector(part->dimension, part->x, nodes[three[k]], x[k]);
      h[k] = height(interface, results + N_RESULTS * nodes[three[k]], factor, nodes[three[k]]);
    }
    slope = slope_of(part->dimension, x, h);
    for (PetscInt k = 0; k < corners; k++) {
      const PetscInt a = nodes[k];
      const double  *r = results + N_RESULTS * a, *p = r + RESULT_MULTIPLIER;
      const PetscReal weight = PetscSqrtReal(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) * r[RESULT_AREA];
      if (part->owned[a] != STICKSLIP_NODE_OWN || r[RESULT_STATE] == STICKSLIP_STATE_GAP) continue;
      sums[0] += weight;
      sums[1] += weight * slope;
      sums[2] += weight * contact_friction(mesh, interface, a);
    }
  }
  PetscCall(PetscFree(results));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode slopes_tell(const Contact *contact, const Interface *interface)
{
  const Offsets  *offsets = &interface->offsets;
  const PetscReal factor = offsets->curve.n ? curve_value(&offsets->curve, contact->physics->t) : 1;
  PetscReal       sums[3] = {0, 0, 0}, slope, friction;
  PetscFunctionBegin;
  if (interface->skin || (!offsets->n_points && !(interface->layer.wear > 0))) PetscFunctionReturn(PETSC_SUCCESS);
  if (verb_there(&interface->part)) PetscCall(add_slopes(contact->mesh, interface, factor, sums));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  if (!(sums[0] > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  slope    = sums[1] / sums[0];
  friction = sums[2] / sums[0];
  if (!(slope > TOLD * (friction > 0 ? PetscMin(friction, MUCH) : MUCH))) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                         "stickslip: warning: where %s presses, its surface %s slopes against the mesh by %.2g. Pressures act along the mesh's normals "
                         "all the same, so that forces along the surface may be off by %.2g of the pressure. Mesh the shape that is meant, if that counts.\n",
                         interface->name, interface->layer.wear > 0 ? offsets->n_points ? "with offsets and wear" : "as it is worn" : "with offsets",
                         (double)slope, (double)slope));
  PetscFunctionReturn(PETSC_SUCCESS);
}
