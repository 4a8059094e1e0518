"""A press fit of polygons that is turned until it slips, with weights and normals of t_n: a step that slides far measures gaps along chords,
and pressure acts along normals of its start. Such steps are cut back, so that the torque is that of short steps, whatever is asked for."""

import math

import host
from cell import series

MU, OVERLAP, RADIUS = 0.3, 0.1, 5.0
# Elastic up to 8.6 degrees, and slipping from there.
ANGLE = 12.0
# Degrees a step, of which none is short enough where all of it slips.
DEGREES = ("0.5", "1", "2", "4", "6", "12")
# The fit presses as before, at a radius of the polygons that is known to a hundredth; a step may have 2 % of the friction wrong.
OFF = 0.03


def scene(*stages):
    ring = {"type": "box", "polar": True, "young": 1000, "poisson": 0.3, "material": "neo_hooke"}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["shaft", "hub"],
        "shaft": {**ring, "lower": [1, 0], "upper": [RADIUS + OVERLAP / 2, 360], "cells": [4, 24]},
        "hub": {**ring, "lower": [RADIUS - OVERLAP / 2, 0], "upper": [10, 360], "cells": [4, 31]},
        "supports": ["hold", "turn"],
        "hold": {"surface": "hub.xmax", "components": ["x", "y"]},
        "turn": {"surface": "shaft.xmin", "components": ["x", "y"], "rotate": math.radians(ANGLE), "rotate_curve": [1, 0, 2, 1]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "shaft.xmax", "mortar": "hub.xmin", "friction": MU, "decision": "points"},
        "steps": {"stages": [1, 2, *stages]},
        "output": {"vtu": "none", "csv": "last"},
    }


def turned(text):
    def run(context):
        run = context.solve(scene(2, round(ANGLE / float(text))))
        result = host.outcome(run)
        if result.refusal is None:
            table = context.solve(scene(), name="pressed").interface("contact")
            exact = MU * RADIUS * (table["p_lumped"] * table["area_covered"]).sum()
            result.below("torque over mu N R", abs(abs(run.steps[-1]["moments"]["hold"][2]) / exact - 1), OFF, "all of it slips")
        return result

    return run


def cells():
    yield from series("press fit turned, points, degrees a step", DEGREES, turned, quick=("4",))
