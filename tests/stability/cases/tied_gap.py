"""Blocks tied over an open gap, turned as one body: nothing strains, and nothing shifts."""

import numpy as np

import host
from cell import series

DEGREES = (5, 15, 45, 90, 135, 180)
STEP = 10  # degrees at most in one step
# The turn is prescribed with 16 digits, and a step ends at 1e-11 of the forces that turned it; over the largest coordinate.
SHIFT = 1e-8
TOP, AXIS = (1.0, 1.0, 1.7), (0.36, 0.48, 0.8)
PROBES = {"top": TOP, "low": (0.0, 0.0, 1.2)}


def turned(point, angle):
    """Where a turn about the axis through the origin takes a point."""
    axis, x = np.array(AXIS), np.array(point)
    return x * np.cos(angle) + np.cross(axis, x) * np.sin(angle) + axis * axis.dot(x) * (1 - np.cos(angle))


def scene(degrees):
    body = {"young": 1000, "poisson": 0.3, "material": "neo_hooke"}
    return {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": {"type": "box", "lower": [0, 0, 1.2], "upper": [1, 1, 1.7], "cells": [2, 3, 1]} | body,
        "lower": {"type": "box", "lower": [-0.5, -0.5, 0], "upper": [1.5, 1.5, 1], "cells": [4, 3, 2]} | body,
        "supports": ["turn"],
        "turn": {
            "surface": "lower.zmin",
            "components": ["x", "y", "z"],
            "rotate": [float(a * np.radians(degrees)) for a in AXIS],
        },
        "interfaces": ["joint"],
        "joint": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "law": "tied"},
        "steps": {"count": -(-degrees // STEP)},
        "probes": list(PROBES),
        "output": {"vtu": "none", "csv": "last"},
    } | {name: {"body": "upper", "point": list(point)} for name, point in PROBES.items()}


def cells():
    def make(degrees):
        def run(context):
            whole = context.solve(scene(degrees))
            result = host.outcome(whole)
            if result.refusal is None:
                for name, point in PROBES.items():
                    moved = np.add(point, whole.steps[-1]["probes"][name])
                    error = np.abs(moved - turned(point, np.radians(degrees))).max() / max(TOP)
                    result.below(f"shift of {name}", error, SHIFT, "a rigid turn of both")
            return result

        return run

    yield from series("tied over a gap, degrees of turn", DEGREES, make, quick=(15, 90))
