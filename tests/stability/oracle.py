"""Mortar weights of a pair (paper (13)) by another road than the library's: Sutherland and Hodgman's clipping in
decimal arithmetic of 90 digits, exact products of Gauss points, derivatives by differences with a step of 1e-32 facets.

Inputs are exactly the doubles given. For triangles and parallelograms the weights are exact. For other quadrilaterals
the number of Gauss points decides; then floating point (`number=float`) is enough.
"""

from decimal import Decimal, getcontext
from functools import cache

import numpy as np

getcontext().prec = 90
STEP = Decimal("1e-32")  # of the facet; differences lose (1e-32 / crossing angle)^2, and 1e-90 / 1e-32 to rounding


def dot(a, b):
    return sum((x * y for x, y in zip(a, b)), start=a[0] * 0)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def root(value):
    return value.sqrt() if isinstance(value, Decimal) else value**0.5


def unit(a):
    length = root(dot(a, a))
    return [x / length for x in a]


def plane(x):
    """Point, two tangents: the auxiliary plane of the non-mortar facet."""
    n = len(x)
    point = [sum(p[i] for p in x) / n for i in range(3)]
    w = cross(minus(x[1], x[0]), minus(x[2], x[0])) if n == 3 else cross(minus(x[2], x[0]), minus(x[3], x[1]))
    e = unit(w)
    t1 = unit(minus(minus(x[1], x[0]), [dot(minus(x[1], x[0]), e) * c for c in e]))
    return point, t1, cross(e, t1)


def area(p, q, r):
    """Twice the signed area."""
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def clip(subject, window):
    """The part of a convex polygon inside another one (both counter-clockwise)."""
    for a, b in zip(window, window[1:] + window[:1]):
        if not subject:
            return []
        inside, out = [area(a, b, p) for p in subject], []
        for k, (p, d) in enumerate(zip(subject, inside)):
            q, e = subject[k - 1], inside[k - 1]
            if (d > 0 and e < 0) or (d < 0 and e > 0):
                s = e / (e - d)
                out.append([q[0] + s * (p[0] - q[0]), q[1] + s * (p[1] - q[1])])
            if d >= 0:
                out.append(p)
        subject = out
    return subject


def shapes(y, q):
    """Shape functions of the facet with projected nodes y at the point q of the plane."""
    if len(y) == 3:
        whole = area(*y)
        return [area(y[1], y[2], q) / whole, area(y[2], y[0], q) / whole, area(y[0], y[1], q) / whole]
    a, b = q[0] * 0, q[0] * 0
    for _ in range(60):  # Newton's method, until nothing changes; one step where the facet is a parallelogram
        n = [(1 - a) * (1 - b) / 4, (1 + a) * (1 - b) / 4, (1 + a) * (1 + b) / 4, (1 - a) * (1 + b) / 4]
        da = [-(1 - b) / 4, (1 - b) / 4, (1 + b) / 4, -(1 + b) / 4]
        db = [-(1 - a) / 4, -(1 + a) / 4, (1 + a) / 4, (1 - a) / 4]
        r = [q[i] - sum(m * p[i] for m, p in zip(n, y)) for i in range(2)]
        j = [[sum(m * p[i] for m, p in zip(d, y)) for d in (da, db)] for i in range(2)]
        det = j[0][0] * j[1][1] - j[0][1] * j[1][0]
        step = (r[0] * j[1][1] - r[1] * j[0][1]) / det, (j[0][0] * r[1] - j[1][0] * r[0]) / det
        a, b = a + step[0], b + step[1]
        if max(map(abs, step)) < (Decimal("1e-80") if isinstance(a, Decimal) else 1e-15):
            break
    return [(1 - a) * (1 - b) / 4, (1 + a) * (1 - b) / 4, (1 + a) * (1 + b) / 4, (1 - a) * (1 + b) / 4]


@cache
def gauss(points, number):
    """Points and weights on 0..1, in the number's precision: a rule that is rounded differs by its rounding times the speed
    of the overlap's vertices, which is one over the crossing angle."""
    found = []
    for start in np.polynomial.legendre.leggauss(points)[0]:
        x = number(start)
        for _ in range(4 if number is Decimal else 0):  # Newton's method doubles the digits
            x -= legendre(points, x)[0] / legendre(points, x)[1]
        found.append(((1 + x) / 2, 1 / ((1 - x * x) * legendre(points, x)[1] ** 2)))
    return found


def legendre(n, x):
    """P_n and its derivative."""
    before, now = x * 0 + 1, x
    for k in range(2, n + 1):
        before, now = now, ((2 * k - 1) * x * now - (k - 1) * before) / k
    return now, n * (x * now - before) / (x * x - 1)


def weights(x1, x2, number=Decimal, points=4):
    """n_ab, n_ac as lists, row A. `points` a side of a triangle, collapsed from a square: 4 are exact for affine
    facets and for their derivatives, which have one degree more."""
    x1, x2 = ([[number(c) for c in p] for p in x] for x in (x1, x2))
    point, t1, t2 = plane(x1)
    y1, y2 = ([[dot(minus(p, point), t1), dot(minus(p, point), t2)] for p in x] for x in (x1, x2))
    polygon = clip(y1, y2[::-1])  # the mortar facet looks the other way
    ab = [[number(0)] * len(x1) for _ in x1]
    ac = [[number(0)] * len(x2) for _ in x1]
    rule = gauss(points, number)
    for p, q in zip(polygon[1:], polygon[2:]):
        whole = area(polygon[0], p, q)
        for u, wu in rule:
            for v, wv in rule:
                l2, l3 = u * (1 - v), u * v
                l1 = 1 - l2 - l3
                at = [l1 * polygon[0][i] + l2 * p[i] + l3 * q[i] for i in range(2)]
                w = wu * wv * u * whole
                n, m = shapes(y1, at), shapes(y2, at)
                for a in range(len(x1)):
                    for b in range(len(x1)):
                        ab[a][b] += w * n[a] * n[b]
                    for c in range(len(x2)):
                        ac[a][c] += w * n[a] * m[c]
    return ab, ac


def as_floats(matrices):
    return [np.array([[float(v) for v in row] for row in matrix]) for matrix in matrices]


def derivatives(x1, x2):
    """dn_ab, dn_ac as arrays (row A, column, unknown of x1, x2)."""
    x = [[Decimal(float(c)) for c in p] for p in [*x1, *x2]]
    n1, n = len(x1), 3 * len(x)
    out = [np.zeros((n1, m, n)) for m in (n1, len(x2))]
    step = STEP * Decimal(float(np.abs(np.subtract(x1[1], x1[0])).max()))
    for k in range(n):
        node, i = divmod(k, 3)
        sides = []
        for sign in (1, -1):
            x[node][i] += sign * step
            sides.append(weights(x[:n1], x[n1:]))
            x[node][i] -= sign * step
        for array, plus, less in zip(out, *sides):
            array[:, :, k] = [[float((p - q) / (2 * step)) for p, q in zip(*rows)] for rows in zip(plus, less)]
    return out
