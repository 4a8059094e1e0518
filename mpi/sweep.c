/* What a non-mortar facet may reach. It can have a pair only with mortar facets that lie in what it sweeps along its normal, up and
 * down. Without search_distance a pair may be any distance apart, so that the sweep ends where the whole mortar side does; with it
 * the library admits what lay within that distance of the facet's plane at t_n. */
#include "internal.h"
#include <float.h>
#include <math.h>

/* A sweep that runs this much along a plane (cosine) is not ended by it. */
static const double STEEP = 0.1;

Box box_of_nothing(void)
{
  return (Box){{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
}

int box_is_nothing(const Box *box)
{
  return !(box->low[0] <= box->high[0]);
}

void box_add(Box *box, const double point[3])
{
  for (int i = 0; i < 3; i++) {
    box->low[i]  = fmin(box->low[i], point[i]);
    box->high[i] = fmax(box->high[i], point[i]);
  }
}

/* Lines lie in the plane z = 0. */
void point_of(int dimension, const double x[], int64_t node, double point[3])
{
  point[2] = 0;
  for (int i = 0; i < dimension; i++) point[i] = x[dimension * node + i];
}

void bounds_clear(Bounds *bounds)
{
  for (int i = 0; i < 3; i++) bounds->high[i] = bounds->minus_low[i] = -DBL_MAX;
}

/* to - from; from NULL: to */
void bounds_add(Bounds *bounds, const double to[3], const double from[3])
{
  for (int i = 0; i < 3; i++) {
    const double v       = to[i] - (from ? from[i] : 0);
    bounds->high[i]      = fmax(bounds->high[i], v);
    bounds->minus_low[i] = fmax(bounds->minus_low[i], -v);
  }
}

typedef struct {
  double low, high;
} Interval;

static const Interval ALL = {-DBL_MAX, DBL_MAX}, NONE = {DBL_MAX, -DBL_MAX};

/* the t with low <= slope t <= high */
static Interval solve(double slope, double low, double high)
{
  if (slope == 0) return low <= 0 && high >= 0 ? ALL : NONE;
  return slope < 0 ? (Interval){high / slope, low / slope} : (Interval){low / slope, high / slope};
}

static Interval both(Interval a, Interval b)
{
  return (Interval){fmax(a.low, b.low), fmin(a.high, b.high)};
}

static Interval hull(Interval a, Interval b)
{
  return (Interval){fmin(a.low, b.low), fmax(a.high, b.high)};
}

/* corners of a facet with so many nodes */
static int64_t corners(int dimension, int64_t n)
{
  return dimension == 2 ? 2 : n == 3 || n == 6 ? 3 : 4;
}

/* The unit normal of a facet whose nodes are at x, across its diagonals as the library has it, and the box around the facet. */
static void facet_normal(const Sweep *sweep, int64_t f, const double x[], double e[3], Box *around)
{
  const int64_t  first = sweep->part->offsets[0][f], n = sweep->part->offsets[0][f + 1] - first, c = corners(sweep->dimension, n);
  const int64_t *nodes = sweep->part->facet_nodes[0] + first;
  double         p[4][3], a[3], b[3], length = 0;
  *around = box_of_nothing();
  for (int64_t k = 0; k < n; k++) {
    double point[3];
    point_of(sweep->dimension, x, nodes[k], point);
    box_add(around, point);
    for (int i = 0; i < 3 && k < c; i++) p[k][i] = point[i];
  }
  for (int i = 0; i < 3; i++) {
    a[i] = c == 2 ? p[1][i] - p[0][i] : p[2][i] - p[0][i];
    b[i] = c == 2 ? i == 2 : c == 3 ? p[1][i] - p[0][i] : p[3][i] - p[1][i];
  }
  for (int i = 0; i < 3; i++) {
    e[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    length += e[i] * e[i];
  }
  for (int i = 0; i < 3; i++) e[i] /= sqrt(length);
}

/* the range of e . p over a box */
static Interval range(const double e[3], const double low[3], const double high[3])
{
  Interval found = {0, 0};
  for (int i = 0; i < 3; i++) {
    found.low += fmin(e[i] * low[i], e[i] * high[i]);
    found.high += fmax(e[i] * low[i], e[i] * high[i]);
  }
  return found;
}

/* Where along its normal e, from its points in the box `own`, the facet may find what the library admits: within the distance of the
 * plane that it had at t_n, of which mortar nodes have moved off since; where normals follow the motion, of that of now, too. */
static Interval admitted(const Sweep *sweep, int64_t f, const double e[3], const Box *own, double margin)
{
  const double distance = sweep->distance + margin;
  Box          then;
  double       normal[3], low[3], slope = 0;
  Interval     plane, moved, here, t;
  if (sweep->distance == 0) return ALL;
  facet_normal(sweep, f, sweep->x_t_n, normal, &then);
  for (int i = 0; i < 3; i++) {
    low[i] = -sweep->moved->minus_low[i];
    slope += normal[i] * e[i];
  }
  if (fabs(slope) < STEEP) return ALL;
  plane = range(normal, then.low, then.high);
  moved = range(normal, low, sweep->moved->high);
  here  = range(normal, own->low, own->high);
  t     = solve(slope, plane.low - distance + moved.low - here.high, plane.high + distance + moved.high - here.low);
  if (!sweep->follows) return t;
  plane = range(e, own->low, own->high);
  return hull(t, (Interval){plane.low - plane.high - distance, plane.high - plane.low + distance});
}

/* The box around what the facet sweeps, with a margin; nothing where it finds no mortar facet. */
Box sweep_facet(const Sweep *sweep, int64_t f, double margin)
{
  Box      own, swept = box_of_nothing();
  double   e[3];
  Interval t;
  facet_normal(sweep, f, sweep->x, e, &own);
  t = admitted(sweep, f, e, &own, margin);
  for (int i = 0; i < 3; i++) {
    const double low = -sweep->mortar->minus_low[i] - margin, high = sweep->mortar->high[i] + margin;
    t = both(t, solve(e[i], low - own.high[i], high - own.low[i]));
  }
  if (!(t.low <= t.high)) return swept;
  for (int i = 0; i < 3; i++) {
    swept.low[i]  = own.low[i] + fmin(e[i] * t.low, e[i] * t.high) - margin;
    swept.high[i] = own.high[i] + fmax(e[i] * t.low, e[i] * t.high) + margin;
  }
  return swept;
}
