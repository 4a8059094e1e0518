/* Which mortar facets a part of an interface may need, and whether it still has them.
 *
 * A facet of the part can have a pair only with mortar facets that lie in what it sweeps along its normal, up and down. Without
 * `search_distance` a pair may be any distance apart, so that the sweep ends where the whole mortar side does; with it the
 * library admits what lay within that distance of the facet's plane at t_n. When a part gets its mortar facets, at some place,
 * boxes around the sweeps are kept, with a margin all around: the part has every facet that met a box there.
 *
 * Later a point p of a mortar facet lies in the sweep of now. It was p - u at that place, u being what it has moved since. The u
 * of all mortar nodes lie in a box, and so does u: sweeps of now, less that box, must lie in the boxes kept. If they do not, the
 * part may lack a facet. Nobody has all mortar nodes; each rank watches those at home there. */
#include "contact/contact.h"

/* Margin around sweeps, over the longest edge of the mortar side: the surfaces may slide by so much before parts get new ones. */
static const PetscReal MARGIN = 2;
/* A sweep that runs this much along a plane (cosine) is not ended by it. */
static const PetscReal STEEP = 0.1;

/* Bounds of vectors, so that the largest of all ranks are those of all. */
typedef struct {
  double high[3], minus_low[3];
} Bounds;

static void bounds_clear(Bounds *bounds)
{
  for (int i = 0; i < 3; i++)
    bounds->high[i] = bounds->minus_low[i] = PETSC_MIN_REAL;
}

static void bounds_add(Bounds *bounds, const double to[], const double from[], double sign)
{
  for (int i = 0; i < 3; i++) {
    const double v       = to[i] + sign * from[i];
    bounds->high[i]      = PetscMax(bounds->high[i], v);
    bounds->minus_low[i] = PetscMax(bounds->minus_low[i], -v);
  }
}

/* Of all mortar nodes: positions; motions since t_n, since the first end, since each place. */
enum { POSITIONS, SINCE_T_N, ON_THE_WAY, SINCE_PLACE, N_BOUNDS = SINCE_PLACE + HALO_PLACES };

/* What is known of the interface at one place or on the way from one to another. */
typedef struct {
  PetscInt n_ends;
  double  *x[2];       /* of the part's non-mortar nodes, at either end */
  double  *watched[2]; /* displacements of the nodes that this rank watches */
  Bounds   of[N_BOUNDS];
} View;

/* `ends`: local vectors, the second one may be NULL */
static PetscErrorCode view_create(const Interface *interface, const Vec ends[2], View *view)
{
  const Halo *halo = &interface->halo;
  PetscFunctionBegin;
  *view = (View){.n_ends = ends[1] ? 2 : 1};
  for (int k = 0; k < N_BOUNDS; k++)
    bounds_clear(&view->of[k]);
  for (PetscInt e = 0; e < view->n_ends; e++) {
    PetscCall(PetscMalloc2(3 * interface->part.n1, &view->x[e], 3 * halo->n_watched, &view->watched[e]));
    PetscCall(contact_fetch(halo->nodes, ends[e], view->x[e]));
    PetscCall(contact_fetch(halo->watch, ends[e], view->watched[e]));
    for (PetscInt k = 0; k < 3 * interface->part.n1; k++)
      view->x[e][k] += halo->X[k];
    for (PetscInt k = 0; k < 3 * halo->n_watched; k += 3) {
      bounds_add(&view->of[POSITIONS], view->watched[e] + k, halo->X_watched + k, 1);
      bounds_add(&view->of[SINCE_T_N], view->watched[e] + k, halo->watched_t_n + k, -1);
      bounds_add(&view->of[ON_THE_WAY], view->watched[e] + k, view->watched[0] + k, -1);
      for (PetscInt p = 0; p < halo->n_places; p++)
        bounds_add(&view->of[SINCE_PLACE + p], view->watched[e] + k, halo->place[p].watched + k, -1);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, view->of, 6 * N_BOUNDS, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode view_destroy(View *view)
{
  PetscFunctionBegin;
  for (int e = 0; e < 2; e++)
    PetscCall(PetscFree2(view->x[e], view->watched[e]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  double low, high;
} Interval;

static const Interval ALL = {-PETSC_MAX_REAL, PETSC_MAX_REAL}, NONE = {PETSC_MAX_REAL, -PETSC_MAX_REAL};

/* the t with low <= slope t <= high */
static Interval solve(double slope, double low, double high)
{
  Interval t = {low / slope, high / slope};
  if (slope == 0) return low <= 0 && high >= 0 ? ALL : NONE;
  if (slope < 0) t = (Interval){high / slope, low / slope};
  return t;
}

static Interval both(Interval a, Interval b)
{
  return (Interval){PetscMax(a.low, b.low), PetscMin(a.high, b.high)};
}

static Interval hull(Interval a, Interval b)
{
  return (Interval){PetscMin(a.low, b.low), PetscMax(a.high, b.high)};
}

/* The unit normal of facet f of the part's non-mortar side, whose nodes are at x, and the box around it. */
static void facet_normal(const ContactPart *part, PetscInt f, const double x[], double e[3], Extent *around)
{
  const PetscInt *nodes = part->facet_nodes[0] + part->offsets[0][f], n = part->offsets[0][f + 1] - part->offsets[0][f];
  double          a[3], b[3], length = 0;
  *around = extent_of_nothing();
  for (PetscInt k = 0; k < n; k++)
    extent_add(around, x + 3 * nodes[k]);
  for (int i = 0; i < 3; i++) { /* across its diagonals, as the library has it */
    a[i] = x[3 * nodes[2] + i] - x[3 * nodes[0] + i];
    b[i] = x[3 * nodes[n - 1] + i] - x[3 * nodes[1] + i];
    if (n == 3) b[i] = x[3 * nodes[1] + i] - x[3 * nodes[0] + i];
  }
  for (int i = 0; i < 3; i++) {
    e[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    length += e[i] * e[i];
  }
  for (int i = 0; i < 3; i++)
    e[i] /= PetscSqrtReal(length);
}

/* the range of e . p over a box */
static Interval along(const double e[3], const double low[3], const double high[3])
{
  Interval range = {0, 0};
  for (int i = 0; i < 3; i++) {
    range.low += PetscMin(e[i] * low[i], e[i] * high[i]);
    range.high += PetscMax(e[i] * low[i], e[i] * high[i]);
  }
  return range;
}

/* Where along its normal e, from its points in the box `own`, facet f may find what the library admits: within the distance of the
 * plane that it had at t_n, of which mortar nodes have moved off since; where normals follow the motion, of that of now, too. */
static Interval admitted(const Interface *interface, const View *view, PetscInt f, const double e[3], const Extent *own, PetscReal margin)
{
  const Halo     *halo     = &interface->halo;
  const double    distance = interface->options.search_distance + margin;
  Extent          then;
  double          normal[3], low[3], slope = 0;
  Interval           plane, moved, here, t;
  if (interface->options.search_distance == 0 || interface->offsets.any) return ALL;
  facet_normal(&interface->part, f, halo->x_t_n, normal, &then);
  for (int i = 0; i < 3; i++) {
    low[i] = -view->of[SINCE_T_N].minus_low[i];
    slope += normal[i] * e[i];
  }
  if (PetscAbsReal(slope) < STEEP) return ALL;
  plane = along(normal, then.low, then.high);
  moved = along(normal, low, view->of[SINCE_T_N].high);
  here  = along(normal, own->low, own->high);
  t     = solve(slope, plane.low - distance + moved.low - here.high, plane.high + distance + moved.high - here.low);
  if (interface->method.normals != STICKSLIP_NORMALS_CURRENT) return t;
  plane = along(e, own->low, own->high);
  return hull(t, (Interval){plane.low - plane.high - distance, plane.high - plane.low + distance});
}

/* The box around what facet f sweeps, with a margin; nothing where it finds no mortar facet. */
static void sweep(const Interface *interface, const View *view, PetscInt f, PetscReal margin, Extent *swept)
{
  *swept = extent_of_nothing();
  for (PetscInt end = 0; end < view->n_ends; end++) {
    Extent own;
    double e[3];
    Interval  t;
    facet_normal(&interface->part, f, view->x[end], e, &own);
    t = admitted(interface, view, f, e, &own, margin);
    for (int i = 0; i < 3; i++) {
      const double low = -view->of[POSITIONS].minus_low[i] - margin, high = view->of[POSITIONS].high[i] + margin;
      t = both(t, solve(e[i], low - own.high[i], high - own.low[i]));
    }
    if (!(t.low <= t.high)) continue;
    for (int i = 0; i < 3; i++) {
      swept->low[i]  = PetscMin(swept->low[i], own.low[i] + PetscMin(e[i] * t.low, e[i] * t.high) - margin);
      swept->high[i] = PetscMax(swept->high[i], own.high[i] + PetscMax(e[i] * t.low, e[i] * t.high) + margin);
    }
  }
}

static PetscBool is_nothing(const Extent *extent)
{
  return (PetscBool)!(extent->low[0] <= extent->high[0]);
}

/* Neighbouring facets share a box. */
static PetscErrorCode choose_boxes(Interface *interface)
{
  const ContactPart *part = &interface->part;
  const PetscInt     n    = part->n_facets[0];
  double            *centres, *ones;
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &interface->halo.box));
  PetscCall(PetscCalloc2(3 * n, &centres, n, &ones));
  for (PetscInt f = 0; f < n; f++) {
    ones[f] = 1;
    for (PetscInt k = part->offsets[0][f]; k < part->offsets[0][f + 1]; k++) {
      for (int i = 0; i < 3; i++)
        centres[3 * f + i] += interface->halo.X[3 * part->facet_nodes[0][k] + i] / (part->offsets[0][f + 1] - part->offsets[0][f]);
    }
  }
  PetscCall(partition_nodes(PETSC_COMM_SELF, 3, n, 0, centres, ones, HALO_BOXES, interface->halo.box));
  PetscCall(PetscFree2(centres, ones));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each rank watches the mortar nodes that are at home there. */
PetscErrorCode halo_watch(Contact *contact, Interface *interface)
{
  Halo           *halo  = &interface->halo;
  const PetscInt  field = 0, width = 3;
  const PetscInt *asked = interface->nodes + interface->n1;

  PetscFunctionBegin;
  halo->n_watched = interface->n2;
  PetscCall(PetscMalloc2(3 * halo->n_watched, &halo->X_watched, 3 * halo->n_watched, &halo->watched_t_n));
  PetscCall(PetscArraycpy(halo->X_watched, interface->X + 3 * interface->n1, 3 * halo->n_watched));
  PetscCall(unknowns_gather_create(contact->physics, 1, &halo->n_watched, &asked, NULL, &field, &width, &halo->watch));
  halo->margin = MARGIN * interface->longest_edge;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the part as it is cut now. */
PetscErrorCode halo_begin(Contact *contact, Interface *interface)
{
  Halo              *halo  = &interface->halo;
  const ContactPart *part  = &interface->part;
  const PetscInt     field = 0, width = 3;
  const PetscInt    *asked = part->vertices;
  PetscFunctionBegin;
  PetscCall(unknowns_gather_create(contact->physics, 1, &part->n1, &asked, NULL, &field, &width, &halo->nodes));
  PetscCall(PetscMalloc2(3 * part->n1, &halo->X, 3 * part->n1, &halo->x_t_n));
  PetscCall(homes_coordinates(interface, part->n1, part->nodes, halo->X));
  PetscCall(choose_boxes(interface));
  PetscCall(halo_settle(contact, interface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* contact->committed is t_n. */
PetscErrorCode halo_settle(Contact *contact, Interface *interface)
{
  Halo *halo = &interface->halo;
  PetscFunctionBegin;
  PetscCall(contact_fetch(halo->watch, contact->committed, halo->watched_t_n));
  PetscCall(contact_fetch(halo->nodes, contact->committed, halo->x_t_n));
  for (PetscInt k = 0; k < 3 * interface->part.n1; k++)
    halo->x_t_n[k] += halo->X[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Boxes around the sweeps at a place, or on the way from one to another, as mortar nodes lie at the first of them. */
PetscErrorCode halo_add(Interface *interface, const Vec ends[2])
{
  Halo      *halo = &interface->halo;
  HaloPlace *place = &halo->place[halo->n_places];
  View       view;
  PetscFunctionBegin;
  PetscCheck(halo->n_places < HALO_PLACES, PETSC_COMM_SELF, PETSC_ERR_PLIB, "too many places of a halo");
  PetscCall(view_create(interface, ends, &view));
  for (int b = 0; b < HALO_BOXES; b++)
    place->box[b] = extent_of_nothing();
  for (PetscInt f = 0; f < interface->part.n_facets[0]; f++) {
    Extent *box = &place->box[halo->box[f]], swept;
    sweep(interface, &view, f, halo->margin, &swept);
    if (is_nothing(&swept)) continue;
    for (int i = 0; i < 3; i++) {
      box->low[i]  = PetscMin(box->low[i], swept.low[i] - view.of[ON_THE_WAY].high[i]);
      box->high[i] = PetscMax(box->high[i], swept.high[i] + view.of[ON_THE_WAY].minus_low[i]);
    }
  }
  PetscCall(PetscMalloc1(3 * halo->n_watched, &place->watched));
  PetscCall(PetscArraycpy(place->watched, view.watched[0], 3 * halo->n_watched));
  halo->n_places++;
  PetscCall(view_destroy(&view));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool covers(const Interface *interface, const View *view, const HaloPlace *place, const Bounds *since, PetscReal spare)
{
  for (PetscInt f = 0; f < interface->part.n_facets[0]; f++) {
    const Extent *box = &place->box[interface->halo.box[f]];
    Extent        swept;
    sweep(interface, view, f, spare, &swept);
    if (is_nothing(&swept)) continue;
    for (int i = 0; i < 3; i++) {
      if (!(swept.low[i] - since->high[i] >= box->low[i] && swept.high[i] + since->minus_low[i] <= box->high[i])) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

/* Does every part have all that it may need there, or on the way; with `spare` of its margin left? */
PetscErrorCode halo_covers(const Interface *interface, const Vec ends[2], PetscReal spare, PetscBool *enough)
{
  const Halo *halo = &interface->halo;
  View        view;
  PetscFunctionBegin;
  *enough = PETSC_TRUE;
  if (halo->whole) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(view_create(interface, ends, &view));
  *enough = (PetscBool)!interface->part.n1;
  for (PetscInt p = 0; p < halo->n_places && !*enough; p++)
    *enough = covers(interface, &view, &halo->place[p], &view.of[SINCE_PLACE + p], spare * halo->margin);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, enough, 1, MPIU_BOOL, MPI_LAND, PETSC_COMM_WORLD));
  PetscCall(view_destroy(&view));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a part that another one takes the place of: that one ends it. */
void halo_forget(Halo *halo)
{
  halo->n_places = 0;
  halo->nodes    = NULL;
  halo->X = halo->x_t_n = NULL;
  halo->box             = NULL;
}

/* What belongs to the part as it was cut. */
PetscErrorCode halo_end(Halo *halo)
{
  PetscFunctionBegin;
  for (PetscInt p = 0; p < halo->n_places; p++)
    PetscCall(PetscFree(halo->place[p].watched));
  halo->n_places = 0;
  PetscCall(PetscSFDestroy(&halo->nodes));
  PetscCall(PetscFree2(halo->X, halo->x_t_n));
  PetscCall(PetscFree(halo->box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode halo_destroy(Halo *halo)
{
  PetscFunctionBegin;
  PetscCall(halo_end(halo));
  PetscCall(PetscSFDestroy(&halo->watch));
  PetscCall(PetscFree2(halo->X_watched, halo->watched_t_n));
  PetscFunctionReturn(PETSC_SUCCESS);
}
