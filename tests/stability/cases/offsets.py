"""Surfaces beside their meshes: clearances and interferences of any size over the facets, gaps that are closed at the start, the
pressure uniform whatever the meshes are; a ring on a bar, whose chords are farther off than the interference."""

import numpy as np

import host
from cell import series

# Newton's method ends at 1e-11 of the forces; the pressure of a block whose strain is 1e-2 and its second powers are exact.
UNIFORM = 1e-9
# Of rings of 24 facets, once the chords are corrected: what is left of the gap, of the fourth order in the facets' angle and
# large beside a small interference. Measured 1.0e-2.
RINGS = 1.2e-2

# The stiffness of polygons of 24 facets, and 8 cells along the radius. Measured 6e-3.
POLYGONS = 8e-3

YOUNG, PRESSURE, EDGE = 1000.0, 10.0, 0.25


def blocks(gap, **interface):
    """A block in the plane over another one, meshes `gap` apart."""
    box = {"type": "box", "young": YOUNG, "poisson": 0.3, "small_strain": True}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["upper", "lower"],
        "upper": {**box, "lower": [0, gap], "upper": [1, 1 + gap], "cells": [4, 3]},
        "lower": {**box, "lower": [0, -1], "upper": [1, 0], "cells": [7, 3]},
        "supports": ["floor", "left"],
        "floor": {"surface": "lower.ymin", "components": ["y"]},
        "left": {"surface": ["upper.xmin", "lower.xmin"], "components": ["x"]},
        "loads": ["press"],
        "press": {"surface": "upper.ymax", "pressure": PRESSURE},
        "interfaces": ["base"],
        "base": {"nonmortar": "upper.ymin", "mortar": "lower.ymax", "weights": "reference", **interface},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "last"},
    }


def uniform(context, scene):
    whole = context.solve(scene)
    result = host.outcome(whole)
    if result.refusal is None:
        pressure = whole.interface("base")["p_lumped"]
        result.below("pressure", np.abs(pressure / PRESSURE - 1).max(), UNIFORM, "uniform")
    return result


def closing(size):
    """An interference over an open gap, `size` facets wide."""
    return lambda context: uniform(context, blocks(size * EDGE, offset=-size * EDGE))


def opening(size):
    """A clearance of meshes that overlap by `size` facets."""
    return lambda context: uniform(context, blocks(-size * EDGE, offset=size * EDGE))


def ramped(size):
    """The first with friction and weights of the step."""
    interface = {"offset": -size * EDGE, "friction": 0.3, "weights": "committed"}
    return lambda context: uniform(context, blocks(size * EDGE, **interface))


def adjusted(size):
    """Meshes that are put onto each other."""
    return lambda context: uniform(context, blocks(size * EDGE, adjust=1.01 * size * EDGE))


def tied(size):
    """The same, tied."""
    return lambda context: uniform(context, blocks(-size * EDGE, adjust=1.01 * size * EDGE, law="tied"))


BORE, RADIUS, OUTSIDE, INTERFERENCE = 4.0, 10.0, 20.0, 0.01


def rings(facets):
    """A ring of so many facets on one of a third more, in plane stress, against Lame."""

    def run(context):
        box = {"type": "box", "polar": True, "young": 2e5, "poisson": 0.3, "small_strain": True}
        far = 1.1 * OUTSIDE
        whole = context.solve({
            "schema": 1,
            "model": "plane_stress",
            "bodies": ["shaft", "hub"],
            "shaft": {**box, "lower": [BORE, 0], "upper": [RADIUS, 360], "cells": [8, facets]},
            "hub": {**box, "lower": [RADIUS, 0], "upper": [OUTSIDE, 360], "cells": [8, facets * 4 // 3]},
            "supports": ["across", "along"],
            "across": {"body": ["shaft", "hub"], "within": [-far, -1e-6, far, 1e-6], "components": ["y"]},
            "along": {"body": "shaft", "within": [-1e-6, -far, 1e-6, far], "components": ["x"]},
            "interfaces": ["base"],
            "base": {"nonmortar": "shaft.xmax", "mortar": "hub.xmin", "weights": "reference", "offset": -INTERFERENCE,
                     "round": "circle", "nonmortar_radius": RADIUS, "mortar_radius": -RADIUS},
            "steps": {"count": 1},
            "output": {"vtu": "none", "csv": "last"},
        })
        result = host.outcome(whole)
        if result.refusal is None:
            table = whole.interface("base")
            outward = np.abs((table["fx"] * table["X"] + table["fy"] * table["Y"]) / np.hypot(table["X"], table["Y"])).sum()
            hub = (OUTSIDE**2 + RADIUS**2) / (OUTSIDE**2 - RADIUS**2)
            shaft = (RADIUS**2 + BORE**2) / (RADIUS**2 - BORE**2)
            exact = 2e5 * INTERFERENCE / (RADIUS * (hub + shaft))
            error = abs(outward / (2 * np.pi * RADIUS) / exact - 1)
            result.below("pressure", error, RINGS * (24 / facets) ** 4 + POLYGONS * (24 / facets) ** 2, "Lame; what is left is of the polygons")
        return result

    return run


def cells():
    sizes = (1e-6, 1e-3, 0.1, 0.5, 1, 3, 10)
    yield from series("interference over a gap, facets", sizes, closing, quick=(0.1, 3))
    yield from series("clearance of an overlap, facets", sizes, opening, quick=(0.1, 3))
    yield from series("interference with friction, facets", sizes, ramped, quick=(1,))
    small = (1e-6, 1e-3, 0.03, 0.1, 0.3, 0.9)
    yield from series("adjust over a gap, facets", small, adjusted, quick=(0.1,))
    yield from series("adjust of an overlap, tied, facets", small, tied, quick=(0.1,))
    yield from series("rings of few facets", (12, 24, 48), rings, quick=(24,))
