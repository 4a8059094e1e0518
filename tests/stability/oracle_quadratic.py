"""Mortar weights of a pair with quadratic facets by another road than the library's: every pair of linear parts is clipped
and integrated as in oracle.py, with the functions of the whole facets at the points' parent coordinates
(docs/formulation 12.2). Linear facets are their own single part.
"""

from decimal import Decimal
from itertools import product

import numpy as np

from library import CORNERS
from oracle import area, clip, dot, gauss, minus, plane, shapes

# Parts of a facet by its number of nodes: in the order of the nodes, the orientation of the facet.
PARTS = {
    3: [[0, 1, 2]],
    4: [[0, 1, 2, 3]],
    6: [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
    8: [[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 6, 7]],
    9: [[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]],
}
TRIANGLE = [(0, 0), (1, 0), (0, 1)]
SQUARE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
# Weights of the products of a quad8 part and a quad9 part, of degree 3 and 4 in each direction, times a linear function and
# the Jacobian of the collapsed square: exact.
POINTS = 6


def parent_coordinates(n):
    """Of the nodes, as pairs of numbers."""
    corners = TRIANGLE if CORNERS[n] == 3 else SQUARE
    size = len(corners)
    mids = [tuple((a + b) / 2 for a, b in zip(corners[k], corners[(k + 1) % size])) for k in range(size)]
    return {3: corners, 4: corners, 6: corners + mids, 8: corners + mids, 9: corners + mids + [(0, 0)]}[n]


def linear(n, xi):
    """Shape functions of the linear facet on the corners."""
    r, s = xi
    if CORNERS[n] == 3:
        return [1 - r - s, r, s]
    return [(1 + a * r) * (1 + b * s) / 4 for a, b in SQUARE]


def quadratic(n, xi):
    """Shape functions of a facet of n nodes."""
    corners, (r, s) = linear(n, xi), xi
    if n in (3, 4):
        return corners
    if n == 6:
        return [c * (2 * c - 1) for c in corners] + [4 * corners[k] * corners[(k + 1) % 3] for k in range(3)]
    if n == 8:
        mids = [(1 - r * r) * (1 - s) / 2, (1 + r) * (1 - s * s) / 2, (1 - r * r) * (1 + s) / 2, (1 - r) * (1 - s * s) / 2]
        return [corners[k] - (mids[k] + mids[k - 1]) / 2 for k in range(4)] + mids
    along = lambda t, node: t * (t + int(node)) / 2 if node else 1 - t * t
    return [along(r, a) * along(s, b) for a, b in parent_coordinates(9)]


def weights(x1, x2, space, number=Decimal, points=POINTS):
    """n_ab, n_ac as lists: a row for each of the multipliers, at the corners ("corner") or at all nodes ("sub")."""
    x1, x2 = ([[number(c) for c in p] for p in x] for x in (x1, x2))
    sizes = len(x1), len(x2)
    xi = [[[number(c) for c in p] for p in parent_coordinates(n)] for n in sizes]
    rows = CORNERS[sizes[0]] if space == "corner" else sizes[0]
    ab, ac = ([[number(0)] * n for _ in range(rows)] for n in sizes)
    rule = gauss(points, number)
    for one, two in product(PARTS[sizes[0]], PARTS[sizes[1]]):
        point, t1, t2 = plane([x1[k] for k in one])
        flat = lambda x, nodes: [[dot(minus(x[k], point), t1), dot(minus(x[k], point), t2)] for k in nodes]
        y1, y2 = flat(x1, one), flat(x2, two)
        # Whether a pair's facets oppose each other is the search's business: both orientations are taken.
        polygon = clip(y1, y2 if area(y2[0], y2[1], y2[2]) > 0 else y2[::-1])
        for p, q in zip(polygon[1:], polygon[2:]):
            whole = area(polygon[0], p, q)
            for (u, wu), (v, wv) in product(rule, rule):
                l2, l3 = u * (1 - v), u * v
                at = [(1 - l2 - l3) * polygon[0][i] + l2 * p[i] + l3 * q[i] for i in range(2)]
                part = shapes(y1, at)
                inner = [sum(m * xi[0][k][i] for m, k in zip(part, one)) for i in range(2)]
                outer = [sum(m * xi[1][k][i] for m, k in zip(shapes(y2, at), two)) for i in range(2)]
                if space == "corner":
                    test = list(enumerate(linear(sizes[0], inner)))
                else:
                    test = list(zip(one, part))
                for matrix, values in ((ab, quadratic(sizes[0], inner)), (ac, quadratic(sizes[1], outer))):
                    for (a, n), (b, m) in product(test, enumerate(values)):
                        matrix[a][b] += wu * wv * u * whole * n * m
    return ab, ac


def change(x1, x2, space, step):
    """The derivative of n_ab, n_ac while all nodes move by `step` (n1 + n2, 3), by differences of 1e-32 of it."""
    small = Decimal("1e-32")
    n1, sides = len(x1), []
    for sign in (1, -1):
        x = [[Decimal(float(c)) + sign * small * Decimal(float(d)) for c, d in zip(*row)] for row in zip([*x1, *x2], step)]
        sides.append(weights(x[:n1], x[n1:], space))
    return [
        np.array([[float((p - q) / (2 * small)) for p, q in zip(*rows)] for rows in zip(plus, less)])
        for plus, less in zip(*sides)
    ]
