"""Scenes of plane and axisymmetric models: patches with exact answers, and a block that is a layer of one in space."""

import numpy as np

from library import spaces_in_question

KINDS = ("quad", "tri", "tri6", "quad8", "quad9")
QUADRATIC = ("tri6", "quad8", "quad9")
MODELS = ("plane_strain", "plane_stress", "axisymmetric")
YOUNG, POISSON, PRESSURE = 1000.0, 0.3, 10.0
# A block of 2 under a traction of 20 becomes shorter by this: the size of the displacements, where they are zero, too.
SETTLES = 20 * 2 / YOUNG


def spaces(*kinds):
    """Where multipliers may stand."""
    return spaces_in_question() if any(kind in QUADRATIC for kind in kinds) else ("corner",)


def patch(model, lower, upper, space="corner", *, x=((0, 0.3, 0.7, 1.3, 2), (0, 0.5, 1.1, 2)), inside=1.0, young=(1, 1), poisson=POISSON,
          length=1.0, stress=1.0):
    """Two rectangles, or rings from the radius `inside` on, without friction under a pressure; their sides are free. `x`: the
    planes of nodes of the lower and of the upper one."""
    first = inside if model == "axisymmetric" else 0.0
    places = [[length * (first + p) for p in of] for of in x]
    common = {"type": "box", "poisson": poisson, "small_strain": True}
    scene = {
        "schema": 1,
        "model": model,
        "bodies": ["lower", "upper"],
        "lower": {**common, "cell": lower, "x": places[0], "y": [length * y for y in (0, 0.4, 1)], "young": YOUNG * stress * young[0]},
        "upper": {**common, "cell": upper, "x": places[1], "y": [length * y for y in (1, 1.7, 2)], "young": YOUNG * stress * young[1]},
        "supports": ["ground"],
        "ground": {"surface": "lower.ymin", "components": ["y"]},
        "loads": ["press"],
        "press": {"surface": "upper.ymax", "pressure": PRESSURE * stress},
        "interfaces": ["base"],
        "base": {"nonmortar": "upper.ymin", "mortar": "lower.ymax", "multiplier_space": space},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "last"},
    }
    if model != "axisymmetric":  # a ring is held
        scene["supports"] += ["left"]
        scene["left"] = {"surface": ["lower.xmin", "upper.xmin"], "components": ["x"]}
    return scene


def patch_error(run, model, poisson=POISSON, stress=1.0):
    """Of the multipliers: minus the force over the interface, which the pressure widens."""
    table = run.interface("base")
    strain = PRESSURE / YOUNG * (poisson * (1 + poisson) if model == "plane_strain" else poisson)
    exact = PRESSURE * stress / (1 + strain) ** (2 if model == "axisymmetric" else 1)
    held = table[table["state"] != "none"]
    return np.abs(held["lambda_n"] + exact).max() / exact


def block(friction, plane, steps=6, gap=0.0, over=0.0, round=None):
    """A block pressed and pushed on a rigid floor with an edge, which it hangs over by `over`; in the plane, or one layer. `round`:
    the floor is analytic, of this radius; 0: straight."""
    lift = lambda x, y: [x, y] if plane else [x, 0.0, y]
    up = "y" if plane else "z"
    end = 4.5 - over
    box = lambda low, high, n: {"type": "box", "lower": lift(*low), "upper": [high[0], high[1]] if plane else [high[0], 1.0, high[1]],
                                "cells": [n[0], n[1]] if plane else [n[0], 1, n[1]], "young": YOUNG, "poisson": POISSON}
    scene = {
        "schema": 1,
        "bodies": ["block", "floor"],
        "block": {**box((0, gap), (4, 2 + gap), (12, 6)), "material": "neo_hooke"},
        "floor": box((-0.5, -1), (end, 0), (7, 1)),
        "supports": ["rigid"],
        "rigid": {"body": "floor", "components": ["x", "y"] if plane else ["x", "y", "z"]},
        "loads": ["press", "push"],
        "press": {"surface": f"block.{up}max", "traction": lift(0, -20), "curve": [0, 0, 1, 1]},
        "push": {"surface": "block.xmin", "traction": lift(6, 0), "curve": [1, 0, 2, 1]},
        "interfaces": ["base"],
        "base": {"nonmortar": f"block.{up}min", "mortar": f"floor.{up}max", "friction": friction},
        "steps": {"end": 2, "count": steps},
        "output": {"vtu": "none", "csv": "last"},
    }
    if round is not None:
        point = lift(2.1, -round)
        if round:
            floor = {"shape": "circle" if plane else "cylinder", "radius": round, "point": point}
        else:
            floor = {"shape": "line" if plane else "plane", "point": point}
        if not round or not plane:
            floor["direction"] = [0, 1] if plane else [0, 1, 0] if round else [0, 0, 1]
        scene["floor"] = {"type": "analytic", **floor}
        scene["base"]["mortar"] = "floor.surface"
    if friction * 20 * 4 <= 6 * 2:  # it would slide away
        scene["supports"] += ["held"]
        scene["held"] = {"surface": "block.xmax", "components": ["x"]}
    if plane:
        scene["model"] = "plane_strain"
    else:
        scene["supports"] += ["slice"]
        scene["slice"] = {"body": "block", "components": ["y"]}
    return scene
