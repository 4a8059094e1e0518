"""A body that hangs over the edge of another one: by almost nothing, by almost a facet, with a corner."""

import numpy as np

import host
from cell import series

PRESSED = 0.005
COVERED = ("0.9", "1e-1", "1e-2", "1e-3", "1e-4", "1e-6", "1e-9", "1e-12")
OVERHANGS = ("1e-1", "1e-2", "1e-4", "1e-6", "1e-9", "1e-12", "1e-15")
# Sum of the interface's and the supports' forces: Newton's tolerance is 1e-11 of the forces.
BALANCE = 1e-9
# A row of nodes hardly covered is a condition more on the strip, as if the facet beside it were stuck to the edge: an
# error of the size of a facet, here a third of the body, in the local field; the resultant feels this much of it.
STRIP = 0.1
# Below coverage_min = 1e-8 of its area (which is some c^2 for a strip of c facets) a node is open as if there were no
# strip.
DROPPED = 7e-5
# Where nodes covered to less than this count as uncovered, none of that happens.
COVERAGE_MIN = 1e-3
# Where nodes covered to less than this of their best covered neighbour are carried by their neighbours.
WEAK_COVERAGE = 0.5
# What an overhang d moves: some times d over the facet's size.
SLOPE = 20.0


def scene(x_end, turn=False, **keys):
    """An elastic block pressed down on a brick that ends at x_end."""
    box = {"type": "box", "cells": [3, 3, 2], "young": 1000, "poisson": 0.3}
    upper = box | {"lower": [0, 0, 0.5], "upper": [1, 1, 1]}
    if turn:  # a corner points along x, its tip at 1
        h = 0.5
        square = [[1 - 2 * h, 0.5], [1 - h, 0.5 - h], [1, 0.5], [1 - h, 0.5 + h]]
        upper = box | {"corners": [c for z in (0.5, 1) for x, y in square for c in (x, y, z)]}
    return {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": upper,
        "lower": box | {"lower": [-1, -1, 0], "upper": [x_end, 2, 0.5], "cells": [5, 7, 2]},
        "supports": ["bottom", "press"],
        "bottom": {"surface": "lower.zmin", "components": ["x", "y", "z"]},
        "press": {"surface": "upper.zmax", "components": ["x", "y", "z"], "value": [0, 0, -PRESSED]},
        "interfaces": ["base"],
        "base": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "friction": 0.3, **keys},
        "steps": {"count": 1, "smallest": 0.25},
        "output": {"vtu": "none", "csv": "last"},
    }


def check(run):
    result = host.outcome(run)
    if result.refusal is None:
        force, reaction = run.resultant("base"), np.array(run.steps[-1]["reactions"]["press"])
        result.below(
            "balance", np.abs(force + reaction).max() / np.linalg.norm(force), BALANCE, "statics of the upper body"
        )
        table = run.interface("base")
        pull = table["lambda_n"].max() / np.abs(table["lambda_n"]).max()
        result.below("pull", max(pull, 0.0), BALANCE, "a multiplier never pulls")
    return result


def strip(**keys):
    """All but one row of facets lies on the brick, and of that row this part; `keys` of the interface."""

    def make(text):
        c = float(text)

        def run(context):
            without = context.solve(scene(2 / 3, weights="reference"), name="without")
            solved = context.solve(scene(2 / 3 + c / 3, **keys), kappa=True)
            result = check(solved)
            if result.refusal is None:
                change = abs(solved.resultant("base")[2] / without.resultant("base")[2] - 1)
                none = c <= DROPPED and keys == {"weights": "reference"}  # in large sliding the edge moves
                bound = 10 * max(c, 1e-10) if none else max(STRIP, c)
                result.below("resultant against none of the row", change, bound, "the strip is that small")
                result.figures["change"] = change
            return result

        return run

    return make


def corner(text):
    """The corner of a block that is turned by 45 degrees hangs over the edge by this much."""
    d = float(text)

    def run(context):
        on = context.solve(scene(1.0, turn=True), name="on")
        solved = context.solve(scene(1.0 - d, turn=True), kappa=True)
        result = check(solved)
        if result.refusal is None:
            table, other = solved.interface("base"), on.interface("base")
            vectors = lambda t: np.stack([t["ux"], t["uy"], t["uz"]], axis=1)
            error = np.abs(vectors(table) - vectors(other)).max() / PRESSED
            result.below("displacements, against the corner on the edge", error, SLOPE * d + 1e-9, "continuous")
        return result

    return run


def cells():
    frozen = strip(weights="reference")
    yield from series("drop-off, small sliding, part of a row", COVERED, frozen, quick=("1e-1", "1e-12"))
    yield from series("drop-off, large sliding, part of a row", COVERED, strip(), quick=("1e-3",))
    mild = strip(coverage_min=COVERAGE_MIN)
    yield from series("drop-off, the same with coverage_min 1e-3", COVERED, mild, quick=("1e-3", "1e-12"))
    carried = strip(weak_coverage=WEAK_COVERAGE)
    yield from series("drop-off, the same with weak_coverage 0.5", COVERED, carried, quick=("1e-3",))
    yield from series("corner over an edge, by", OVERHANGS, corner, quick=("1e-2", "1e-12"))
