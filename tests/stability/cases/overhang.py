"""A body that hangs over an edge of another one by all but a part of a facet, with default options: a node is covered by next to
nothing, and its multiplier would be a point load without bound."""

import numpy as np

import host
from cell import series

# What the last facet lies on the other body with, in parts of a facet. (With half of one its node has a multiplier of its own in the
# standard basis and is carried in the dual one: another discretisation.)
COVERED = ("0.2", "1e-1", "1e-2", "1e-4", "1e-6", "1e-9", "0")
BALANCE = 1e-9
# The largest pressure against that of the dual basis. At an edge it has no limit on finer meshes, and either basis has another one;
# multipliers at the end of a sliver were 20 to 1000 times as large.
PRESSURE = 3
# Displacements across the surface: either basis lets a facet beside the edge sink in by another part of its size.
SINKS = 0.03
# Of one step; in space with friction at a corner, too, where nodes slip in directions that they have to find.
ITERATIONS = {2: 15, 3: 20}


def scene(covered, friction, cell="quad", n=8, **keys):
    """A slider of 2 facets height on a table that ends below it."""
    end = 1.0 + covered * 4 / n
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["slider", "table"],
        "slider": {"type": "box", "cell": cell, "lower": [-2, 0], "upper": [2, 1], "cells": [n, 2], "young": 1000, "poisson": 0.3},
        "table": {"type": "box", "cell": cell, "lower": [-6, -1], "upper": [end, 0], "cells": [13, 3], "young": 1000, "poisson": 0.3},
        "supports": ["ground", "hold"],
        "ground": {"surface": "table.ymin", "components": ["x", "y"]},
        "hold": {"surface": "slider.xmin", "components": ["x"]},
        "loads": ["weight"],
        "weight": {"surface": "slider.ymax", "pressure": 1},
        "interfaces": ["base"],
        "base": {"nonmortar": "slider.ymin", "mortar": "table.ymax", "friction": friction, **keys},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "last"},
    }


def brick(covered, friction):
    """The same in space, over a corner."""
    box = {"type": "box", "young": 1000, "poisson": 0.3}
    end = 1.0 + covered * 0.5
    return {
        "schema": 1,
        "bodies": ["slider", "table"],
        "slider": box | {"lower": [-1, -1, 0], "upper": [2, 2, 1], "cells": [6, 6, 2]},
        "table": box | {"lower": [-3, -3, -1], "upper": [end, end, 0], "cells": [7, 7, 2]},
        "supports": ["ground", "hold", "side"],
        "ground": {"surface": "table.zmin", "components": ["x", "y", "z"]},
        "hold": {"surface": "slider.xmin", "components": ["x"]},
        "side": {"surface": "slider.ymin", "components": ["y"]},
        "loads": ["weight"],
        "weight": {"surface": "slider.zmax", "pressure": 1},
        "interfaces": ["base"],
        "base": {"nonmortar": "slider.zmin", "mortar": "table.zmax", "friction": friction},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "last"},
    }


def compared(make):
    """With the same by dual multipliers, of which neighbours carry those that are hardly covered since there are any."""

    def with_strip(text):
        def run(context):
            scene = make(float(text))
            solved = context.solve(scene)
            result = host.outcome(solved)
            if result.refusal is None:
                dual = context.solve(scene | {"base": scene["base"] | {"basis": "dual"}}, name="dual")
                table, other = solved.interface("base"), dual.interface("base")
                most = lambda t: np.abs(t["p_lumped"]).max()
                force, reaction = solved.resultant("base"), np.array(solved.steps[-1]["reactions"]["ground"])
                result.below("balance", np.abs(force - reaction).max() / np.linalg.norm(force), BALANCE, "statics of the table")
                result.below("largest pressure, times the dual basis'", most(table) / most(other), PRESSURE, "no point load")
                across = "uz" if "model" not in scene else "uy"
                apart = np.abs(table[across] - other[across]).max() / np.abs(other[across]).max()
                result.below("displacements across the surface", apart, SINKS, "the dual basis")
                result.true("iterations", result.iterations <= ITERATIONS[2 if "model" in scene else 3], "Newton's method knows who is in contact")
            return result

        return run

    return with_strip


def cells():
    for name, friction, more in (("", 0, {}), (", friction", 0.3, {}), (", triangles", 0.3, {"cell": "tri"}), (", finer", 0.3, {"n": 16}),
                                 (", quadratic", 0, {"cell": "quad8"})):
        make = compared(lambda covered, f=friction, m=more: scene(covered, f, **m))
        yield from series(f"hangs over an edge by all but{name}", COVERED, make, quick=("1e-6",) if name != ", finer" else ())
    make = compared(lambda covered: brick(covered, 0.3))
    yield from series("hangs over a corner in space by all but", COVERED, make, quick=("1e-4",))
