"""A rigid ball is pressed on a half-space with friction (Spence): the ratio of the stick radius to the contact radius is
the same at every load, and does not depend on the steps. Nothing else is exact of it: only history and growth are tested."""

import numpy as np

from friction_checks import graded
from scene import write

YOUNG, POISSON = 1.0, 0.3
# Of the largest contact, whose radius is near 1: flat enough for small displacements.
RADIUS = 1000.0
# The block reaches so far; cells grow towards its ends.
FAR, GROWTH, FINE = 30.0, 1.15, 1.2
# Of the last contact radius: below it there are too few facets in the contact.
FIRST = 1 / 3
NAME = "contact"


def times(steps):
    """Ends of steps up to 1: contact radii are equally spaced, and the way goes with their square."""
    return (np.arange(1, steps + 1) / steps) ** 2


def scene(folder, facets, mu, steps, **interface):
    size = 1 / facets
    x, deep = graded(size, FINE, FAR, GROWTH), graded(size, 0, FAR, GROWTH)
    return write(
        {
            "schema": 1,
            "model": "axisymmetric",
            "bodies": ["block", "ball"],
            "block": {"type": "box", "x": x.tolist(), "y": (-deep[::-1]).tolist(), "young": YOUNG, "poisson": POISSON, "small_strain": True},
            "ball": {"type": "analytic", "shape": "circle", "point": [0, RADIUS], "radius": RADIUS},
            "surfaces": ["top"],
            "top": {"of": "block.ymax", "within": [0, -0.1, FINE, 0.1]},
            "supports": ["ground", "press"],
            "ground": {"surface": "block.ymin", "components": ["x", "y"]},
            "press": {"body": "ball", "components": ["x", "y"], "value": [0, -1 / RADIUS], "curve": [0, 0, 1, 1]},
            "interfaces": [NAME],
            NAME: {"nonmortar": "top", "mortar": "ball.surface", "friction": mu, **interface},
            "steps": {"times": times(steps).tolist()},
            "output": {"vtu": "none", "csv": "all", "quiet": True},
        },
        folder / f"spence_{facets}_{mu:g}_{steps}.yaml",
    )


def radii(table):
    """(contact, stick): borders lie halfway between nodes."""
    table = table[np.argsort(table["X"])]
    x = np.append(table["X"], table["X"][-1])
    closed = table["state"] != "gap"
    stick = table["state"] == "stick"
    border = lambda inside: (x[inside.sum() - 1] + x[inside.sum()]) / 2 if inside.any() else 0.0
    return border(closed), border(stick)


def at_loads(run, count=10):
    """(contact, stick) radii at so many loads, those that steps end at: contact radii from FIRST on, equally spaced."""
    steps = len(run.steps)
    chosen = sorted({max(1, round(steps * part)) for part in np.linspace(FIRST, 1, count)})
    return np.array([radii(run.interface(NAME, k)) for k in chosen])
