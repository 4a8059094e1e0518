"""What neither forces nor weighted gaps know of a converged step: pressure along normals of its start, and bodies that overlap within facets
that are coarser than the contact. The answer is right, or the run says why not; never a wrong one without a word."""

import re

import numpy as np

import host
from cell import series

# Bodies turned as one by so much a step, without friction: the shear over the pressure is 0, and what no step may be wrong by is told.
DEGREES = (1, 3, 6, 10, 15, 19)
SHEAR = 0.02
# Cells of the block below a ball, whose contact is 0.17 wide at the end: from 34 facets in it to a tenth of one.
CELLS = (96, 48, 24, 12, 4, 1)
# Two meshes' errors: the same with the roles exchanged.
EXCHANGED = 0.1
# Where the run itself says that its facets do not feel the contact it is an estimate, and no more is asked of it.
TOLD = 0.5
OVERLAP, TURNED = "overlap|although they are .* apart", "has turned within the step"
BODY = {"type": "box", "young": 1000, "poisson": 0.3}


def stack(degrees):
    turn = {"components": ["x", "y"], "rotate": float(np.radians(2 * degrees)), "rotate_curve": [1, 0, 2, 1]}
    body = BODY | {"material": "neo_hooke"}
    scene = {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["up", "dn"],
        "up": body | {"lower": [-0.5, 0], "upper": [0.5, 0.5], "cells": [3, 2]},
        "dn": body | {"lower": [-0.8, -0.5], "upper": [0.8, 0], "cells": [5, 2]},
        "supports": ["ground", "head"],
        "ground": {"surface": "dn.ymin"} | turn,
        "head": {"surface": "up.ymax", "value": [0, -0.01], "curve": [0, 0, 1, 1]} | turn,
        "interfaces": ["contact"],
        "contact": {"nonmortar": "up.ymin", "mortar": "dn.ymax"},
        "steps": {"stages": [1, 2, 2, 2]},
        "output": {"vtu": "none", "csv": "none"},
    }

    def run(context):
        found = context.solve(scene)
        result = host.outcome(found)
        if result.refusal is None:
            worst = 0.0
            for step in found.steps:
                angle = np.radians(2 * degrees) * max(0.0, step["t"] - 1)
                x, y = step["reactions"]["ground"][:2]
                along, across = x * np.cos(angle) + y * np.sin(angle), -x * np.sin(angle) + y * np.cos(angle)
                worst = max(worst, abs(along / across))
            result.below("shear over pressure", worst, SHEAR, "none, for there is no friction")
        return result

    return run


def ball(cells, exchanged=False):
    roles = ["block.ymax", "disc.ymin"]
    one, two = reversed(roles) if exchanged else roles
    return {
        "schema": 1,
        "model": "axisymmetric",
        "bodies": ["disc", "block"],
        "disc": BODY | {"ball": [0, 0.5], "lower": [0, 0], "upper": [0.5, 1], "cells": [6, 12], "small_strain": True},
        "block": BODY | {"lower": [0, -1], "upper": [2, 0], "cells": [cells, max(2, cells // 2)], "small_strain": True},
        "supports": ["ground", "press"],
        "ground": {"surface": "block.ymin", "components": ["y"]},
        "press": {"surface": "disc.ymax", "components": ["y"], "value": [0, -0.05]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": one, "mortar": two},
        "steps": {"count": 4},
        "output": {"vtu": "none", "csv": "none"},
    }


def coarse(cells):
    def run(context):
        found = context.solve(ball(cells))
        result = host.outcome(found)
        if result.refusal is None:
            wanted = context.solve(ball(cells, exchanged=True), name="exchanged")
            forces = [abs(run.steps[-1]["reactions"]["ground"][1]) for run in (found, wanted)]
            told = re.search(OVERLAP, found.text)
            if told:
                result.warnings.append(f"the run tells: {told[0]}")
            bound, reason = (TOLD, "an estimate, as the run says") if told else (EXCHANGED, "that with the roles exchanged")
            result.below("force", abs(forces[0] / forces[1] - 1), bound, reason)
        return result

    return run


def cells():
    yield from series("normals of the step's start, degrees a step", DEGREES, stack, quick=(10,), may_refuse=TURNED)
    yield from series("facets coarser than the contact, cells", CELLS, coarse, quick=(4,), may_refuse=OVERLAP)
