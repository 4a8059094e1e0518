"""Friction from nothing to rough: a block is pressed on a larger one and drawn along it by its top."""

import numpy as np

import host
from cell import series
from comparisons import difference

SLIDES = ("0", "1e-15", "1e-12", "1e-9", "1e-6", "1e-3", "0.1", "0.5")
STICKS = ("1e1", "1e2", "1e3", "1e4", "1e5", "1e6")
DRAWN, PRESSED = 0.05, 0.005
# Forces and multipliers are known to Newton's tolerance, 1e-11 of the forces; what a node's cone adds is the ratio of
# all forces to its own.
NEWTON, NODES = 1e-11, 100
# In steady sliding every node slips along x, as long as the block's edges stay down.
FLAT = 0.1
# Two laws with the same solutions, each to Newton's tolerance.
SAME = 1e-10


def scene(friction, law="coulomb", drawn=DRAWN):
    base = {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "law": law}
    return {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": {
            "type": "box",
            "lower": [0, 0, 0.5],
            "upper": [1, 1, 1],
            "cells": [3, 3, 2],
            "young": 1000,
            "poisson": 0.3,
        },
        "lower": {
            "type": "box",
            "lower": [-1, -1, 0],
            "upper": [2, 2, 0.5],
            "cells": [8, 8, 1],
            "young": 1000,
            "poisson": 0.3,
        },
        "supports": ["bottom", "press", "draw"],
        "bottom": {"body": "lower", "components": ["x", "y", "z"]},
        "press": {"surface": "upper.zmax", "components": ["z"], "value": [0, 0, -PRESSED], "curve": [0, 0, 1, 1]},
        "draw": {"surface": "upper.zmax", "components": ["x", "y"], "value": [drawn, 0, 0], "curve": [1, 0, 2, 1]},
        "interfaces": ["base"],
        "base": base | ({"friction": float(friction)} if law == "coulomb" else {}),
        "steps": {"end": 2, "count": 10},
        "output": {"vtu": "none", "csv": "last"},
    }


def slides(friction):
    def run(context):
        run = context.solve(scene(friction))
        result = host.outcome(run)
        if result.refusal is None:
            mu, force, table = float(friction), run.resultant("base"), run.interface("base")
            tangential = np.linalg.norm([table[f"lambda_t{c}"] for c in "xyz"], axis=0)
            off = np.abs(tangential - mu * np.abs(table["lambda_n"])).max() / np.abs(table["lambda_n"]).max()
            result.below("nodes off the cone, over the largest pressure", off, NODES * NEWTON, "all of them slip")
            if mu <= FLAT:
                excess = abs(np.hypot(force[0], force[1]) - mu * force[2]) / force[2]
                result.below("|T| - mu N over N", excess, NODES * NEWTON, "every node slips along x")
            result.true("friction is against the motion", mu <= 1e-9 or force[0] < 0, "Coulomb")
            if mu <= 1e-12:
                without = context.solve(scene(friction, "none"), name="none")
                result.below("against the frictionless law", difference(run, without), SAME, "mu = 0 is its limit")
        return result

    return run


def sticks(friction):
    def run(context):
        # Where the feet stick on what does not move, displacements are rounding.
        top = {"probes": ["top"], "top": {"body": "upper", "point": [0, 0, 1]}}
        run = context.solve(scene(friction, drawn=DRAWN / 10) | top)
        result = host.outcome(run)
        if result.refusal is None:
            rough = context.solve(scene(friction, "rough", DRAWN / 10) | top, name="rough")
            result.below("against the rough law", difference(run, rough), SAME, "nothing slips in either")
        return result

    return run


def cells():
    yield from series("friction, a block drawn along", SLIDES, slides, quick=("0", "1e-12", "0.5"))
    yield from series("friction, the same block stuck", STICKS, sticks, quick=("1e6",))
