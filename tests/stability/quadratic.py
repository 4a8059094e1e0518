"""Quadratic facets and grids of them, for cases of the matrix."""

import numpy as np

from library import CORNERS

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
TRIANGLE = SQUARE[[0, 1, 3]]
NAMES = {3: "tri3", 4: "quad4", 6: "tri6", 8: "quad8", 9: "quad9"}
KINDS = (6, 8, 9)


def facet(n):
    """A facet of n nodes on the unit square or on half of it; mid nodes lie in the middle."""
    corners = TRIANGLE if CORNERS[n] == 3 else SQUARE
    if n == len(corners):
        return corners.copy()
    mids = (corners + np.roll(corners, -1, axis=0)) / 2
    return np.concatenate([corners, mids, corners.mean(axis=0, keepdims=True)])[:n]


def other_side(x):
    """The same facet seen from below: its nodes the other way round."""
    corners = CORNERS[len(x)]
    order = [0, *range(corners - 1, 0, -1)]
    if len(x) > corners:
        order += [corners + k for k in range(corners - 1, -1, -1)] + list(range(2 * corners, len(x)))
    return x[order]


def grid(n, kind, lower=(0.0, 0.0), size=1.0, z=0.0, down=False):
    """Nodes and facets of n x n squares; tri6: two each. `down`: the normal points down."""
    t = np.linspace(0, size, 2 * n + 1)
    nodes = np.array([[lower[0] + x, lower[1] + y, z] for y in t for x in t])
    at = lambda i, j: j * (2 * n + 1) + i
    square = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    halves = [[0, 1, 2, 4, 5, 8], [0, 2, 3, 8, 6, 7]]
    facets = []
    for i in range(0, 2 * n, 2):
        for j in range(0, 2 * n, 2):
            here = np.array([at(i + a, j + b) for a, b in square])
            facets += [here[half] for half in halves] if kind == 6 else [here[:kind]]
    if down:
        facets = [other_side(f) for f in facets]
    used = np.unique(np.concatenate(facets))
    number = np.full(len(nodes), -1)
    number[used] = np.arange(len(used))
    return nodes[used], [number[f] for f in facets]

