/* Facets of curved surfaces are chords: of a ring on a shaft they may stay apart all round where the circles that are meant touch, or
 * overlap by a fit. Nothing is wrong with such a scene but its mesh, so that it is told at the start, with what helps. */
#include "contact/contact.h"

/* Facets that meet under more than twice this angle are two sides of an edge, and no chords of one surface: 30 degrees. */
static const PetscReal SMOOTH = 0.52;
/* Facets that match are apart by less than this part of what the surfaces rise over them: what meshes are written with. */
static const PetscReal TOUCHING = 1e-2;

/* A part of a fit's overlap that chords may take or give and nobody is told. */
static const PetscReal FIT = 0.05;

#define REMEDY "`round` gives facets their shape back, cells of second order have it; finer facets are closer to it.\n"

/* A facet's area vector, of a line its length across it. */
static void area_vector(const ContactPart *part, const double x[], const PetscInt nodes[], PetscInt n, PetscReal area[3])
{
  PetscReal p[4][3], e[3], g[3];
  for (PetscInt k = 0; k < n; k++)
    contact_vector(part->dimension, x, nodes[k], p[k]);
  for (int i = 0; i < 3; i++) { /* of a quadrilateral the diagonals */
    e[i] = n == 4 ? p[2][i] - p[0][i] : p[1][i] - p[0][i];
    g[i] = n == 4 ? p[3][i] - p[1][i] : n == 3 ? p[2][i] - p[0][i] : i == 2;
  }
  for (int i = 0; i < 3; i++)
    area[i] = e[(i + 1) % 3] * g[(i + 2) % 3] - e[(i + 2) % 3] * g[(i + 1) % 3];
}

static PetscReal norm(const PetscReal a[3]) { return PetscSqrtReal(PetscSqr(a[0]) + PetscSqr(a[1]) + PetscSqr(a[2])); }

static PetscReal angle(const PetscReal a[3], const PetscReal b[3])
{
  PetscReal across = 0, along = 0;
  for (int i = 0; i < 3; i++) {
    across += PetscSqr(a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
    along += a[i] * b[i];
  }
  return PetscAtan2Real(PetscSqrtReal(across), along);
}

/* How far a side's surface rises over its facets and dips below them at most, {rise, dip}: a circle over a chord of length h by h theta / 8, theta the
 * angle between the normals at its ends. Facets with mid nodes follow the surface. */
static PetscErrorCode rise_of(const ContactPart *part, int side, PetscReal rise[2])
{
  const double   *x  = side ? MORTAR_OF(part, part->x) : part->x;
  const PetscInt *at = part->offsets[side], n_nodes = side ? part->n2 : part->n1;
  PetscReal      *sums;
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(3 * n_nodes, &sums));
  for (int round = 0; round < 2; round++) {
    for (PetscInt f = 0; f < part->n_facets[side]; f++) {
      const PetscInt *nodes = part->facet_nodes[side] + at[f], n = at[f + 1] - at[f];
      PetscReal       area[3];
      if (n > (part->dimension == 2 ? 2 : 4)) continue;
      area_vector(part, x, nodes, n, area);
      for (PetscInt k = 0; k < n; k++) {
        PetscReal *from = sums + 3 * nodes[k], *to = sums + 3 * nodes[(k + 1) % n], a[3], b[3], length = 0, bend = 0;
        if (!round) {
          for (int i = 0; i < 3; i++)
            from[i] += area[i];
          continue;
        }
        if (angle(area, from) >= SMOOTH || angle(area, to) >= SMOOTH) continue;
        contact_vector(part->dimension, x, nodes[k], a);
        contact_vector(part->dimension, x, nodes[(k + 1) % n], b);
        for (int i = 0; i < 3; i++) {
          length += PetscSqr(b[i] - a[i]);
          bend += (to[i] / norm(to) - from[i] / norm(from)) * (b[i] - a[i]); /* h theta, of the convex side positive */
        }
        if (length > 0) rise[bend < 0] = PetscMax(rise[bend < 0], PetscAbsReal(bend) / 8);
      }
    }
  }
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The least and the largest mean gap of this part's nodes that are covered, the least as its negative. */
static PetscErrorCode measure_gaps(const ContactPart *part, PetscReal gaps[2])
{
  double *results;
  PetscFunctionBegin;
  gaps[0] = gaps[1] = PETSC_MIN_REAL;
  PetscCall(PetscMalloc1(N_RESULTS * part->n1, &results));
  PetscCall(contact_results(part, results));
  for (PetscInt a = 0; a < part->n1 && verb_there(part); a++) {
    const double   *result = results + N_RESULTS * a;
    const PetscReal gap    = result[RESULT_GAP] / result[RESULT_COVERAGE];
    if (part->owned[a] != STICKSLIP_NODE_OWN || !(result[RESULT_COVERAGE] > 0)) continue;
    gaps[0] = PetscMax(gaps[0], -gap);
    gaps[1] = PetscMax(gaps[1], gap);
  }
  PetscCall(PetscFree(results));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Told where all gaps and overlaps are within what the surfaces rise over their facets, and some are open, and of a fit, which is closed all round,
 * what its chords take of it: of a shaft two thirds of their rise, in the mean. A bore's add as much. */
PetscErrorCode chords_tell(const Interface *interface)
{
  const ContactPart *part = &interface->part;
  PetscReal          gaps[2], rise[4] = {0, 0, 0, 0}, both = 0, taken = 0;
  PetscFunctionBegin;
  if (interface->options.friction == STICKSLIP_FRICTION_TIED) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(measure_gaps(part, gaps));
  for (int side = 0; side < (interface->surface[1]->analytic ? 1 : 2); side++) {
    if (interface->offsets.radius[side] == 0) PetscCall(rise_of(part, side, rise + 2 * side));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, gaps, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, rise, 4, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  for (int side = 0; side < 2; side++) {
    const PetscReal *of = rise + 2 * side;
    both += PetscMax(of[0], of[1]);
    taken += 2.0 / 3.0 * (of[0] - of[1]);
  }
  if (gaps[1] > TOUCHING * both && PetscMax(gaps[0], gaps[1]) <= both)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: warning: the facets of %s start with gaps from %.3g to %.3g, and the curved surfaces that are meant rise over them "
                           "by up to %.3g: where these touch the facets may not, so that a fit presses too little, or not at all. %s",
                           interface->name, -(double)gaps[0], (double)gaps[1], (double)both, REMEDY));
  else if (interface->offsets.adjust > 0 && both > 0 && gaps[0] > TOUCHING * both)
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: warning: the nodes of %s are adjusted, and its facets overlap by up to %.3g all the same, for they are chords of "
                           "the curved surfaces that are meant: that presses by itself. %s",
                           interface->name, (double)gaps[0], REMEDY));
  else if (gaps[1] > PETSC_MIN_REAL && gaps[1] < 0 && PetscAbsReal(taken) > FIT * gaps[0])
    PetscCall(PetscFPrintf(PETSC_COMM_WORLD, PETSC_STDERR,
                           "stickslip: warning: the facets of %s start with overlaps from %.3g to %.3g, and the curved surfaces that are meant overlap by "
                           "about %.2g %s: facets are their chords, so that the fit presses some %.0f %% too %s. %s",
                           interface->name, -(double)gaps[1], (double)gaps[0], (double)PetscAbsReal(taken), taken > 0 ? "more" : "less",
                           (double)(100 * PetscAbsReal(taken) / (gaps[0] + taken)), taken > 0 ? "little" : "much", REMEDY));
  PetscFunctionReturn(PETSC_SUCCESS);
}
