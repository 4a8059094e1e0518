"""Mortar weights of a pair of lines by another road than the library's: intervals and Gauss points in decimal arithmetic of 90
digits, derivatives by differences (docs/formulation 13.2). Inputs are exactly the doubles given, and the weights are exact.
"""

from decimal import Decimal
from itertools import product

import numpy as np

from oracle import dot, gauss, minus, unit

PI = Decimal("3.1415926535897932384626433832795028841971693993751058209749445923078164062862089986280348253421")
# Parts of a line by its number of nodes: the ends come first, then the middle. Parent coordinates of the nodes.
PARTS = {2: [(0, 1)], 3: [(0, 2), (2, 1)]}
PLACES = (-1, 1, 0)
# Exact: a linear and a quadratic function times the radius have degree 4.
POINTS = 3
# Of differences, over the length that moves.
STEP = Decimal("1e-32")


def functions(n, xi):
    """Shape functions of a line of n nodes."""
    if n == 2:
        return [(1 - xi) / 2, (1 + xi) / 2]
    return [xi * (xi - 1) / 2, xi * (xi + 1) / 2, 1 - xi * xi]


def weights(x1, x2, space, ring):
    """n_ab, n_ac as lists, of a thickness of 1 or (`ring`) of an axisymmetric model."""
    x1, x2 = ([[Decimal(c) for c in p] for p in x] for x in (x1, x2))
    rows = 2 if space == "corner" else len(x1)
    ab, ac = ([[Decimal(0)] * len(x) for _ in range(rows)] for x in (x1, x2))
    for one, two in product(PARTS[len(x1)], PARTS[len(x2)]):
        (a, b), (c, d) = [x1[k] for k in one], [x2[k] for k in two]
        t = unit(minus(b, a))
        end, s_c, s_d = (dot(minus(p, a), t) for p in (b, c, d))
        low, high = max(Decimal(0), min(s_c, s_d)), min(end, max(s_c, s_d))
        for place, weight in gauss(POINTS, Decimal) if high > low else ():
            s = low + place * (high - low)
            part, other = s / end, (s - s_c) / (s_d - s_c)
            xi1, xi2 = (PLACES[k] + (PLACES[m] - PLACES[k]) * q for (k, m), q in ((one, part), (two, other)))
            rho = 2 * PI * (a[0] + (b[0] - a[0]) * part) if ring else 1
            test = list(enumerate(functions(2, xi1))) if space == "corner" else list(zip(one, (1 - part, part)))
            for matrix, values in ((ab, functions(len(x1), xi1)), (ac, functions(len(x2), xi2))):
                for (row, n), (column, m) in product(test, enumerate(values)):
                    matrix[row][column] += weight * (high - low) * rho * n * m
    return ab, ac


def change(x1, x2, space, ring, step):
    """The derivative of n_ab, n_ac while all nodes move by `step` (n1 + n2, 2)."""
    size = Decimal(float(np.abs(np.subtract(x1[1], x1[0])).max())) * STEP
    n1, sides = len(x1), []
    for sign in (1, -1):
        x = [[Decimal(float(c)) + sign * size * Decimal(float(d)) for c, d in zip(*row)] for row in zip([*x1, *x2], step)]
        sides.append(weights(x[:n1], x[n1:], space, ring))
    return [
        np.array([[float((p - q) / (2 * size)) for p, q in zip(*rows)] for rows in zip(plus, less)])
        for plus, less in zip(*sides)
    ]
