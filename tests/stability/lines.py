"""Lines, and rows of them, for cases of plane and axisymmetric models."""

import numpy as np

from library import DUAL, STANDARD

# Numbers of the library for the models: plane strain, and axisymmetric.
STRAIN, RING = 1, 2
MODELS = {"strain": {"model": STRAIN, "thickness": 1.0}, "ring": {"model": RING}}
NAMES = {2: "line2", 3: "line3"}
# What meets what: each kind on itself and on the other one.
MET = [(2, 2), (2, 3), (3, 2), (3, 3)]
# Multipliers by their options.
SPACES = {"corner": {"basis": STANDARD}, "sub": {"multiplier_space": 1, "basis": STANDARD}, "dual": {"basis": DUAL}}


def line(n, start=(0.0, 0.0), end=(1.0, 0.0)):
    """A line of n nodes, a middle node in the middle."""
    ends = np.array([start, end], float)
    return ends if n == 2 else np.vstack([ends, ends.mean(axis=0)])


def other_side(x):
    """The same line seen from the other side."""
    return np.vstack([x[1], x[0], x[2:]])


def grid(n, lower=(0.0,), size=1.0, z=0.0, down=False, kind=2):
    """Nodes and lines of a row of n lines; `down`: the normal out of their body points down, the body is above."""
    nodes = np.array([[lower[0] + s, z] for s in np.linspace(0, size, (kind - 1) * n + 1)])
    step = kind - 1
    facets = [[k, k + step, k + 1][:kind] for k in range(0, step * n, step)]
    return nodes, np.array(facets if down else [[b, a, *middle] for a, b, *middle in facets])


def turn(angle):
    """The matrix of a turn in the plane."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])
