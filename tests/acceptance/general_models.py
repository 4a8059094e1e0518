"""Scenes of general contact whose meshes are written here."""

import numpy as np
from plane_mesh import PlaneMesh
from scene import SCENES, write

import yaml

BOX = {"type": "box", "young": 1000, "poisson": 0.3}
NONE = {"vtu": "none", "csv": "none"}


def shipped(name, **more):
    """A scene of the folder as a dict; `more` replaces keys."""
    return {**yaml.safe_load((SCENES / f"{name}.yaml").read_text()), **more}


# A strip that is folded by a half turn: length of its arms, thickness, half the gap between them.
ARM, THICK, GAP = 2.0, 0.2, 0.1
ALONG, AROUND, ACROSS = 24, 12, 3


def strip(folder, contact, steps=12):
    """A folded strip, one arm of which is pressed on the other one and drawn along it by some facets, with friction. `contact`: keys."""
    radius = GAP + THICK / 2
    turn = np.pi * radius
    along = [*np.linspace(0, ARM, ALONG + 1), *(ARM + turn * np.arange(1, AROUND + 1) / AROUND), *(ARM + turn + np.linspace(0, ARM, ALONG + 1)[1:])]
    across = np.linspace(-THICK / 2, THICK / 2, ACROSS + 1)

    def bend(p):
        s, depth = p
        if s <= ARM:
            return [s, -radius - depth]
        if s >= ARM + turn:
            return [2 * ARM + turn - s, radius + depth]
        angle = (s - ARM) / radius - np.pi / 2
        return [ARM + (radius + depth) * np.cos(angle), (radius + depth) * np.sin(angle)]

    mesh = PlaneMesh("quad", along, across, True, bend).write(folder / "strip.msh")
    scene = {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["strip"],
        "strip": {"type": "gmsh", "file": str(mesh), "young": 1000, "poisson": 0.3, "material": "neo_hooke"},
        "surfaces": ["low", "high", "under", "over"],
        "low": {"of": "strip.ymin", "within": [-1, -1, ARM - 0.01, 0]},
        "high": {"of": "strip.ymin", "within": [-1, 0, ARM - 0.01, 1]},
        "under": {"of": "strip.ymax", "within": [-1, -1, ARM - 0.1, 0]},
        "over": {"of": "strip.ymax", "within": [-1, 0, ARM / 2, 1]},
        "supports": ["ground", "press"],
        "ground": {"surface": "under", "components": ["x", "y"]},
        "press": {"surface": "over", "components": ["x", "y"], "value": [0.3, -3 * GAP], "curve": [0, 0, 1, 1]},
        "steps": {"count": steps},
        "output": NONE,
        **contact,
    }
    return write(scene, folder / f"strip_{'all' if 'contact' in contact and contact['contact'] == 'all' else 'named'}.yaml")


def corner(cell, **more):
    """A block between a floor and two walls, whose meshes do not match; from the other sides all is pressed evenly."""
    body = lambda lower, upper, cells: {**BOX, "lower": lower, "upper": upper, "cells": cells, "cell": cell}
    held = lambda surfaces, axis, value=0: {"surface": surfaces, "components": ["xyz"[axis]], "value": [value * (k == axis) for k in range(3)]}
    return {
        "schema": 1,
        "bodies": ["block", "floor", "wall1", "wall2"],
        "block": body([0, 0, 0], [1, 1, 1], [4, 4, 4]),
        "floor": body([-0.6, -0.6, -0.5], [1, 1, 0], [5, 5, 2]),
        "wall1": body([-0.6, -0.6, 0], [0, 1, 1], [2, 5, 3]),
        "wall2": body([0, -0.6, 0], [1, 0, 1], [3, 2, 5]),
        "supports": ["back1", "back2", "ground", "press1", "press2", "press3"],
        "back1": held(["floor.xmin", "wall1.xmin"], 0),
        "back2": held(["floor.ymin", "wall1.ymin", "wall2.ymin"], 1),
        "ground": held(["floor.zmin"], 2),
        "press1": held(["block.xmax", "wall2.xmax", "floor.xmax"], 0, -0.02),
        "press2": held(["block.ymax", "wall1.ymax", "floor.ymax"], 1, -0.02),
        "press3": held(["block.zmax", "wall1.zmax", "wall2.zmax"], 2, -0.02),
        "contact": "all",
        "steps": {"count": 2},
        "output": {"vtu": "last", "csv": "none"},
        **more,
    }


def balls_between_plates():
    """Code_Aster's SSNA102: two balls of radius 10 and 5 between a plate that is held at its rim and one that is pressed down. Axisymmetric, of small
    strain, as there."""
    body = {"type": "box", "young": 200000, "poisson": 0.3, "small_strain": True}
    return {
        "schema": 1,
        "model": "axisymmetric",
        "bodies": ["base", "low", "high", "press"],
        "base": {**body, "lower": [0, 0], "upper": [20, 4], "cells": [64, 16]},
        "low": {**body, "ball": [0, 14], "lower": [0, 4], "upper": [10, 24], "cells": [40, 80]},
        "high": {**body, "ball": [0, 29], "lower": [0, 24], "upper": [5, 34], "cells": [40, 80]},
        "press": {**body, "lower": [0, 34], "upper": [10, 36], "cells": [48, 16]},
        "supports": ["axis", "ground", "push"],
        "axis": {"surface": ["base.xmin", "low.xmin", "high.xmin", "press.xmin"], "components": ["x"]},
        "ground": {"surface": "base.xmax", "components": ["x", "y"]},
        "push": {"surface": "press.ymax", "components": ["y"], "value": [0, -2]},
        "probes": ["foot"],
        "foot": {"body": "base", "point": [0, 0]},
        "contact": "all",
        "steps": {"count": 4},
        "output": NONE,
    }


def sheet(contact):
    """A thin sheet on a plate, and a block over both, pressed down and along; half a facet is between block and plate."""
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["plate", "sheet", "block"],
        "plate": {**BOX, "lower": [0, -0.5], "upper": [2, 0], "cells": [16, 4]},
        "sheet": {**BOX, "lower": [0.4, 0], "upper": [1.6, 0.07], "cells": [8, 1]},
        "block": {**BOX, "lower": [0.1, 0.07], "upper": [1.9, 0.6], "cells": [12, 4]},
        "supports": ["ground", "press"],
        "ground": {"surface": "plate.ymin", "components": ["x", "y"]},
        "press": {"surface": "block.ymax", "components": ["x", "y"], "value": [0.01, -0.02]},
        "steps": {"count": 4},
        "output": NONE,
        **contact,
    }
