"""A shallow arch pushed through by a rigid cylinder: its stiffness changes sign on the way."""

import numpy as np

import host
from cell import series

RADIUS, THICKNESS = 10.0, 0.2
RISES = (4, 6, 8, 10, 12, 15)  # half the arch's angle in degrees
STEPS, REFINED = 10, 4
# The same end by steps a quarter as long: friction is absent, the end is a state of equilibrium on the same branch.
SAME_END = (
    1e-6  # of the travel; normals of the last commit differ by the angle of a step, which the end at rest forgets
)


def scene(half_angle, count):
    a = float(half_angle)
    rise = RADIUS * (1 - np.cos(np.radians(a)))
    travel = 2.2 * rise
    top = RADIUS + THICKNESS / 2
    return {
        "schema": 1,
        "bodies": ["arch", "punch"],
        "arch": {
            "type": "box",
            "polar": True,
            "lower": [RADIUS - THICKNESS / 2, 90 - a, 0],
            "upper": [top, 90 + a, 1],
            "cells": [2, 24, 1],
            "young": 1000,
            "poisson": 0.0,
            "material": "st_venant_kirchhoff",
        },
        "punch": {
            "type": "analytic",
            "shape": "cylinder",
            "point": [0, top + 2, 0],
            "direction": [0, 0, 1],
            "radius": 2,
        },
        "supports": ["ends", "plane", "press"],
        "ends": {"surface": ["arch.ymin", "arch.ymax"], "components": ["x", "y", "z"]},
        "plane": {"surface": ["arch.zmin", "arch.zmax"], "components": ["z"]},
        "press": {"body": "punch", "components": ["x", "y", "z"], "value": [0, -travel, 0], "curve": [0, 0, 1, 1]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "arch.xmax", "mortar": "punch.surface"},
        "steps": {"stages": [1, count, 1.2, 2]},
        "probes": ["crown"],
        "crown": {"body": "arch", "point": [0, RADIUS, 0], "tolerance": 0.5},
        "output": {"vtu": "none", "csv": "last"},
    }


def through(half_angle):
    def run(context):
        coarse = context.solve(scene(half_angle, STEPS))
        result = host.outcome(coarse)
        if result.refusal is None:
            fine = context.solve(scene(half_angle, STEPS * REFINED), name="refined")
            travel = 2.2 * RADIUS * (1 - np.cos(np.radians(half_angle)))
            at = [np.array(run.steps[-1]["probes"]["crown"]) for run in (coarse, fine)]
            result.below(
                "place of the crown", np.abs(at[0] - at[1]).max() / travel, SAME_END, "steps a quarter as long"
            )
            result.figures["crown"] = at[0][1] / travel
        return result

    return run


def cells():
    yield from series("snap-through, half angle in degrees", RISES, through, quick=(6,))
