"""Points of the overlaps of two surfaces, with weights and the functions of both sides there: the library's own weights are
sums over them. Lines in any position (docs/formulation 13.1); in space facets in the plane z = 0, triangles or rectangles
along the axes, the non-mortar body above."""

from dataclasses import dataclass

import numpy as np

# Of the unit triangle: exact for products of two linear functions; weights are parts of the area.
TRIANGLE = np.array([[1 / 6, 1 / 6], [2 / 3, 1 / 6], [1 / 6, 2 / 3]])
# A polygon's corner this near to a line is on it, over the size of a facet.
ON_LINE = 1e-12


@dataclass
class Surface:
    """x (n, d) and facets, as the library takes them."""

    x: np.ndarray
    facets: np.ndarray

    @property
    def sizes(self):
        """Lengths of lines, roots of the area of quadrilaterals, of twice that of triangles."""
        corner = self.x[self.facets]
        if corner.shape[1] == 2:
            return np.linalg.norm(corner[:, 1] - corner[:, 0], axis=1)
        quad = corner.shape[1] == 4
        a, b = corner[:, 2] - corner[:, 0], corner[:, 3 if quad else 1] - corner[:, 1 if quad else 0]
        return np.sqrt(np.linalg.norm(np.cross(a, b), axis=1) / (2 if quad else 1))

    @property
    def nodal_sizes(self):
        """Means over the facets of each node."""
        sizes, count = np.zeros(len(self.x)), np.zeros(len(self.x))
        np.add.at(sizes, self.facets, self.sizes[:, None])
        np.add.at(count, self.facets, 1)
        return sizes / count


@dataclass
class Points:
    """One row a point. `gradients`: of `own` along the surface; `axis`: e of the non-mortar facet, into its body."""

    facet: np.ndarray  # non-mortar
    mortar: np.ndarray
    weight: np.ndarray
    own: np.ndarray  # N_B of the non-mortar facet's nodes
    other: np.ndarray  # N_C of the mortar facet's nodes
    gradients: np.ndarray
    axis: np.ndarray


def between(one, two, rule):
    """Of two surfaces at rest. `rule`: Gauss points an overlap and a direction; of triangles there are always three in each
    part of an overlap."""
    places = one.x, one.facets, two.x, two.facets
    if one.x.shape[1] == 2:
        return of_lines(*places, rule)
    return of_rectangles(*places, rule) if one.facets.shape[1] == 4 else of_triangles(*places)


def of_lines(x1, facets1, x2, facets2, rule):
    """Positions may be complex: derivatives by complex steps are exact, and decisions are those of the real parts."""
    share, weight = gauss(rule)
    one, two = x1[facets1], x2[facets2]
    along = one[:, 1] - one[:, 0]
    length = np.sqrt((along**2).sum(axis=1))
    t = along / length[:, None]
    e = np.stack([-t[:, 1], t[:, 0]], axis=1)
    s = ((two[None] - one[:, None, None, 0]) * t[:, None, None]).sum(axis=-1)  # (m1, m2, 2): of c, d from a on
    first, last = (np.where((s[..., 0].real < s[..., 1].real) == ends, s[..., 0], s[..., 1]) for ends in (True, False))
    whole = length[:, None]
    start = np.where(first.real > 0, first, 0)
    end = np.where(last.real < whole.real, last, whole)
    facet, mortar = np.nonzero(end.real > start.real)
    start, end, s, length = start[facet, mortar], end[facet, mortar], s[facet, mortar], length[facet]
    place = start[:, None] + (end - start)[:, None] * share
    own, other = place / length[:, None], (place - s[:, :1]) / (s[:, 1:] - s[:, :1])
    shapes = [np.stack([1 - v, v], axis=-1).reshape(-1, 2) for v in (own, other)]
    every = lambda v: np.repeat(v, rule, axis=0)
    gradients = every(np.stack([-1 / length, 1 / length], axis=1)[:, :, None])
    return Points(every(facet), every(mortar), ((end - start)[:, None] * weight).ravel(), *shapes, gradients, every(e[facet]))


def normals_of_lines(x, facets):
    """Nodal normals into the body: means of the facets', of length 1."""
    along = x[facets[:, 1]] - x[facets[:, 0]]
    along = along / np.linalg.norm(along, axis=1)[:, None]
    total = np.zeros_like(x)
    np.add.at(total, facets, np.stack([-along[:, 1], along[:, 0]], axis=1)[:, None])
    return total / np.linalg.norm(total, axis=1)[:, None]


def of_rectangles(x1, facets1, x2, facets2, rule):
    local, weight = square(rule)
    low, high = ([f(x[facets][:, :, :2], axis=1) for x, facets in ((x1, facets1), (x2, facets2))] for f in (np.min, np.max))
    start, end = np.maximum(low[0][:, None], low[1][None]), np.minimum(high[0][:, None], high[1][None])
    facet, mortar = np.nonzero((end > start).all(axis=-1))
    start, end = start[facet, mortar], end[facet, mortar]
    place = start[:, None] + (end - start)[:, None] * local
    area = (end - start).prod(axis=1)[:, None] * weight
    own, gradients = bilinear(x1[facets1[facet]][:, :, :2], place)
    other, _ = bilinear(x2[facets2[mortar]][:, :, :2], place)
    every = lambda v: np.repeat(v, len(local), axis=0)
    return Points(every(facet), every(mortar), area.ravel(), own, other, gradients, upwards(area.size))


def of_triangles(x1, facets1, x2, facets2):
    one, two = x1[facets1][:, :, :2], x2[facets2][:, ::-1, :2]  # both counterclockwise or both clockwise seen from above
    boxes = [(t.min(axis=1), t.max(axis=1)) for t in (one, two)]
    near = (boxes[0][0][:, None] < boxes[1][1][None]).all(axis=-1) & (boxes[1][0][None] < boxes[0][1][:, None]).all(axis=-1)
    parts, facet, mortar = [], [], []
    for f, m in zip(*np.nonzero(near)):
        polygon = clip(one[f], two[m])
        for k in range(1, len(polygon) - 1):
            parts.append(polygon[[0, k, k + 1]])
            facet.append(f), mortar.append(m)
    parts, facet, mortar = np.array(parts), np.array(facet), np.array(mortar)
    sides = parts[:, 1:] - parts[:, :1]
    place = parts[:, :1] + TRIANGLE @ sides
    area = np.abs(np.linalg.det(sides))[:, None] / 2 * np.full(len(TRIANGLE), 1 / len(TRIANGLE))
    own, gradients = linear(x1[facets1[facet]][:, :, :2], place)
    other, _ = linear(x2[facets2[mortar]][:, :, :2], place)
    every = lambda v: np.repeat(v, len(TRIANGLE), axis=0)
    return Points(every(facet), every(mortar), area.ravel(), own, other, every(gradients), upwards(area.size))


def clip(polygon, triangle):
    """What of a convex polygon is within a triangle (Sutherland and Hodgman); both go around in the same sense."""
    sides = np.roll(triangle, -1, axis=0) - triangle
    sense = np.sign(np.linalg.det(sides[:2]))
    for corner, side in zip(triangle, sides):
        if len(polygon) < 3:
            return polygon[:0]
        inside = sense * (side[0] * (polygon[:, 1] - corner[1]) - side[1] * (polygon[:, 0] - corner[0])) / (side @ side)
        inside[np.abs(inside) < ON_LINE] = 0
        kept = []
        for k in range(len(polygon)):
            a, b = inside[k - 1], inside[k]
            if a * b < 0:
                kept.append(polygon[k - 1] + (polygon[k] - polygon[k - 1]) * a / (a - b))
            if b >= 0:
                kept.append(polygon[k])
        polygon = np.array(kept).reshape(-1, 2)
    return polygon


def bilinear(corners, place):
    """Functions (points, 4) and gradients (points, 4, 2) on rectangles (m, 4, 2) at places (m, n, 2)."""
    middle, half = corners.mean(axis=1, keepdims=True), np.ptp(corners, axis=1)[:, None] / 2
    sign = np.sign(corners - middle)
    factor = (1 + sign[:, None] * ((place - middle) / half)[:, :, None]) / 2  # (m, n, 4, 2)
    slope = sign[:, None] / (2 * half[:, :, None])
    gradients = np.stack([slope[..., 0] * factor[..., 1], slope[..., 1] * factor[..., 0]], axis=-1)
    return factor.prod(axis=-1).reshape(-1, 4), gradients.reshape(-1, 4, 2)


def linear(corners, place):
    """Functions (points, 3) at places (m, n, 2) and gradients (m, 3, 2) on triangles (m, 3, 2)."""
    inverse = np.linalg.inv(np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2))
    gradients = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)
    last = np.einsum("mij,mnj->mni", inverse, place - corners[:, :1])
    return np.concatenate([1 - last.sum(axis=-1, keepdims=True), last], axis=-1).reshape(-1, 3), gradients


def upwards(count):
    return np.tile([0.0, 0.0, 1.0], (count, 1))


def gauss(rule):
    """Places and weights over 0 to 1."""
    x, w = np.polynomial.legendre.leggauss(rule)
    return (x + 1) / 2, w / 2


def square(rule):
    """The same over the unit square."""
    share, weight = gauss(rule)
    return np.stack([g.ravel() for g in np.meshgrid(share, share, indexing="ij")], axis=1), np.outer(weight, weight).ravel()


def hats(surface, function, rule=20):
    """int N_A and int N_A f over facets in the plane z = 0; f of places (..., 2)."""
    local, weight = square(rule)
    corner = surface.x[surface.facets][:, :, :2]
    if corner.shape[1] == 4:
        place = corner.min(axis=1)[:, None] + np.ptp(corner, axis=1)[:, None] * local
        n, area = bilinear(corner, place)[0], np.ptp(corner, axis=1).prod(axis=1)
    else:  # the square with one side in a corner
        weight = 2 * weight * local[:, 0]
        local = np.stack([local[:, 0] * (1 - local[:, 1]), local.prod(axis=1)], axis=1)
        sides = corner[:, 1:] - corner[:, :1]
        place = corner[:, :1] + local @ sides
        n, area = linear(corner, place)[0], np.abs(np.linalg.det(sides)) / 2
    n = n.reshape(len(corner), len(local), -1) * (weight * area[:, None])[:, :, None]
    out = np.zeros((2, len(surface.x)))
    np.add.at(out[0], surface.facets, n.sum(axis=1))
    np.add.at(out[1], surface.facets, (n * function(place)[:, :, None]).sum(axis=1))
    return out


def worst_weight(library, one, two, points):
    """The largest difference of n_AB, n_AC of all pairs from the library's, over the largest weight. Pairs without points
    have to have none in the library either."""
    plane = {"model": 1} if one.x.shape[1] == 2 else {}
    sums = {}
    outer = [points.own[:, :, None] * n[:, None, :] * points.weight[:, None, None] for n in (points.own, points.other)]
    for f, m, ab, ac in zip(points.facet, points.mortar, *outer):
        kept = sums.setdefault((f, m), [0.0, 0.0])
        kept[0], kept[1] = kept[0] + ab, kept[1] + ac
    worst = 0.0
    for f, a in enumerate(one.facets):
        for m, b in enumerate(two.facets):
            theirs = library.weights(one.x[a], two.x[b], **plane)
            worst = max(worst, *(np.abs(t - o).max() for t, o in zip(theirs, sums.get((f, m), (0.0, 0.0)))))
    return worst / max(np.abs(ab).max() for ab, _ in sums.values())
