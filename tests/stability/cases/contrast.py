"""Stiff on soft where the pressure is not uniform: a block is pressed and drawn on a floor N times as stiff as it."""

import numpy as np

import host
from cases.friction import scene
from cell import series
from comparisons import difference

RATIOS = (1e2, 1e3, 1e4, 1e6, 1e7, 1e8)
FRICTION = 0.3
# The floor gives way by about a part N of what the block does, and everything changes by some times that.
GIVES = 10.0
NEWTON = 1e-9  # beneath it; two runs, each known to 1e-11 of the forces, and to 100 times that at a node
# With the multipliers on the other side, whose facets are as large: the error of either mesh, a third of the body.
MESH = 0.1


def floor(ratio, swapped=False):
    made = scene(FRICTION)
    made["bottom"] = {"surface": "lower.zmin", "components": ["x", "y", "z"]}
    made["lower"]["young"] = 1000.0 * ratio
    if swapped:
        made["base"] |= {"nonmortar": "lower.zmax", "mortar": "upper.zmin", "modulus": 1000}
    return made


def soft_carries(ratio):
    def run(context):
        solved = context.solve(floor(ratio), kappa=True)
        result = host.outcome(solved)
        if result.refusal is None:
            rigid = context.solve(scene(FRICTION), name="rigid")
            error = difference(solved, rigid)
            result.below("against a rigid floor", error, GIVES / ratio + NEWTON, "it gives way by a part N of it")
        return result

    return run


def stiff_carries(ratio):
    def run(context):
        solved = context.solve(floor(ratio, swapped=True), kappa=True)
        result = host.outcome(solved)
        if result.refusal is None:
            other = context.solve(floor(ratio), name="other")
            force, expected = -solved.resultant("base"), other.resultant("base")
            error = np.abs(force - expected).max() / np.linalg.norm(expected)
            result.below("resultant, against the other choice", error, MESH, "the mesh's error")
        return result

    return run


def cells():
    yield from series("soft block carries, floor N times stiffer", RATIOS, soft_carries, quick=(1e6,))
    yield from series(
        "stiff floor carries, N times stiffer",
        RATIOS,
        stiff_carries,
        quick=(1e6,),
        may_refuse=r"not converged.*(states|repeat)",
    )
