"""A finely meshed rigid cap in a coarse block: it lies deeper behind the block's facets than its own are long. The force
depends neither on how fine the cap is nor on the number of steps, and no commit takes contact away. In a block that is coarser than that
the cap dents facets that do not feel it, and the run says so."""

import host
from cell import series

CELLS = (6, 12, 24, 48, 96, 144)  # of the cap, along each edge, which is 1.2 wide
# Facets of the block over 4: the cap reaches 0.015 behind them and more, a facet and more of the finest caps, and less than what a run is refused with.
# Facets of 0.8 it dents by 0.08.
BLOCK, COARSE = 9, 5
DENTED = "Facets that are coarser than the contact do not feel it"
STEPS = (1, 2, 5, 10, 20, 60)
FINE, SOME = 96, 20
DEPTH = 0.2
# The same run with pairs as deep as the block: both take the same steps, so nothing but the choice of the pairs differs.
SAME_FORCE = 0.01
GENEROUS = ("-contact_search_distance", "3")


def scene(cells, steps, block):
    return {
        "schema": 1,
        "bodies": ["block", "cap"],
        "block": {
            "type": "box",
            "lower": [-2, -2, -2],
            "upper": [2, 2, 0],
            "cells": [block, block, 3],
            "young": 1000,
            "poisson": 0.3,
        },
        "cap": {
            "type": "box",
            "lower": [-0.6, -0.6, 0],
            "upper": [0.6, 0.6, 0.2],
            "cells": [cells, cells, 1],
            "ball": [0, 0, 1],
            "young": 1000,
            "poisson": 0.3,
        },
        "supports": ["ground", "press"],
        "ground": {"surface": "block.zmin", "components": ["x", "y", "z"]},
        "press": {"body": "cap", "components": ["x", "y", "z"], "value": [0, 0, -DEPTH]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "block.zmax", "mortar": "cap.zmin"},
        "steps": {"count": steps},
        "output": {"vtu": "none", "csv": "none"},
    }


def pressed(cells, steps, block=BLOCK):
    def run(context):
        found = context.solve(scene(cells, steps, block))
        result = host.outcome(found)
        if result.refusal is None:
            wanted = context.solve(scene(cells, steps, block), *GENEROUS, name="generous")
            forces, same = ([abs(step["reactions"]["ground"][2]) for step in run.steps] for run in (found, wanted))
            result.below("force", abs(forces[-1] / same[-1] - 1), SAME_FORCE, "that with a search distance")
            falls = any(a > b for a, b in zip(forces, forces[1:]))
            result.true("force falls in no step", not falls, "it is pressed in")
            result.figures["force"] = forces[-1]
        return result

    return run


def cells():
    yield from series("fine cap in coarse facets, cells", CELLS, lambda n: pressed(n, SOME), quick=(24,))
    yield from series("fine cap in coarse facets, steps", STEPS, lambda n: pressed(FINE, n), quick=(2,))
    yield from series("fine cap in facets that do not feel it, cells", CELLS, lambda n: pressed(n, SOME, COARSE), quick=(24,), may_refuse=DENTED)
