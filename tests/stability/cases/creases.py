"""A sharp edge inside the non-mortar surface: its nodes have a normal and a multiplier for each side. A body is pressed by its foot
alone, with all of its skin in the contact, and flies against a wall; a body stands in a corner with two faces."""

import numpy as np

import host
from cell import series

PRESSED = 0.01
CELLS = (2, 3, 4, 6, 9, 12)
# The sides lean outwards by so much of the height: edges of 90 to 41 degrees.
LEANS = (0, 0.2, 0.4, 0.6, 0.8, 1.15)
# Of the foot alone: the same equations, and rows that say of further multipliers that they are zero.
SAME = 1e-9
BALANCE = 1e-9
# Sideways momentum: nothing acts along a wall without friction but what follows from normals of the last step on facets that bend.
KEPT = 1e-3
SPEEDS = (0.1, 0.3, 1, 2, 3, 5)
FRICTIONS = (0, 0.01, 0.1, 0.3, 1, 3)
# Forces of a block in a corner against those of two interfaces, of which each node of the corner's edge has two as well. Copies
# that touch together act without friction: what the corner's own strip carries.
STRIP = 0.15


def skin(sides):
    return {"of": sides, "within": [-9] * 3 + [9] * 3}


def pressed(cell, space, friction, n=4, lean=0.0, foot=False, **keys):
    """A block on a stiff floor."""
    lift = lambda x, z: [x, 0, z] if space else [x, z]
    up = "z" if space else "y"
    block = {"type": "box", "cell": cell, "cells": [n, n, n] if space else [n, n], "young": 1000, "poisson": 0.3, "small_strain": True}
    if space:
        block |= {"lower": [0, 0, 0], "upper": [1, 1, 1]}
    else:
        block |= {"corners": [0, 0, 1, 0, 1 + lean, 1, -lean, 1]}
    sides = [f"block.{s}" for s in ("xmin", "xmax", f"{up}min", *(("ymin", "ymax") if space else ()))]
    floor = {"type": "box", "lower": [-2, -2, -1] if space else [-2, -1], "upper": [3, 3, 0] if space else [3, 0],
             "cells": [5, 5, 1] if space else [7, 2], "young": 1e6, "poisson": 0.3, "small_strain": True}
    scene = {
        "schema": 1,
        "bodies": ["block", "floor"],
        "block": block,
        "floor": floor,
        "surfaces": ["skin"],
        "skin": skin(sides) if space else {"of": sides, "within": [-9, -9, 9, 9]},
        "supports": ["ground", "press"],
        "ground": {"surface": f"floor.{up}min", "components": ["x", "y", "z"] if space else ["x", "y"]},
        "press": {"surface": f"block.{up}max", "components": ["x", "y", "z"] if space else ["x", "y"], "value": lift(0, -PRESSED)},
        "interfaces": ["base"],
        "base": {"nonmortar": f"block.{up}min" if foot else "skin", "mortar": f"floor.{up}max", "friction": friction, **keys},
        "steps": {"count": 2},
        "output": {"vtu": "none", "csv": "last"},
    }
    return scene if space else scene | {"model": "plane_strain"}


def against_foot(context, *args, **keys):
    run = context.solve(pressed(*args, **keys))
    result = host.outcome(run)
    if result.refusal is None:
        foot = context.solve(pressed(*args, **keys, foot=True), name="foot")
        force, exact = (r.steps[-1]["interfaces"]["base"]["force"] for r in (run, foot))
        result.below("force", np.abs(np.subtract(force, exact)).max() / np.linalg.norm(exact), SAME, "that of the foot alone")
        reaction = run.steps[-1]["reactions"]["press"]
        result.below("balance", np.abs(np.add(force, reaction)).max() / np.linalg.norm(exact), BALANCE, "statics of the block")
    return result


def flight(speed):
    """A block flies askew against a wall without friction, with all of its skin in the contact."""

    def run(context):
        scene = {
            "schema": 1,
            "model": "plane_strain",
            "bodies": ["block", "floor"],
            "block": {"type": "box", "lower": [0, 0.02], "upper": [1, 1.02], "cells": [4, 4], "young": 1000, "poisson": 0.3,
                      "material": "neo_hooke", "density": 1, "velocity": [speed, -1]},
            "floor": {"type": "analytic", "shape": "line", "point": [0, 0], "direction": [0, 1]},
            "supports": ["hold"],
            "hold": {"body": "floor", "components": ["x", "y"]},
            "surfaces": ["skin"],
            "skin": {"of": ["block.xmin", "block.xmax", "block.ymin", "block.ymax"], "within": [-9, -9, 9, 9]},
            "interfaces": ["base"],
            "base": {"nonmortar": "skin", "mortar": "floor.surface"},
            "dynamics": {"rho_inf": 1},
            "steps": {"end": 0.2, "count": 80},
            "output": {"vtu": "none", "csv": "none"},
        }
        solved = context.solve(scene)
        result = host.outcome(solved)
        if result.refusal is None:
            momentum = solved.steps[-1]["momentum"]
            result.below("sideways momentum", abs(momentum[0] / speed - 1), KEPT, "no force acts along the wall")
            result.true("it comes back", momentum[1] > 0, "the wall throws it back")
        return result

    return run


def corner(friction):
    """Pressed into the corner of a floor and a wall, both in one mortar surface."""

    def scene(one):
        box = {"type": "box", "young": 1e5, "poisson": 0.3}
        base = {"friction": friction}
        both = {"surfaces": ["skin", "corner"], "skin": {"of": ["block.xmin", "block.xmax", "block.ymin", "block.ymax"], "within": [-9, -9, 9, 9]},
                "corner": {"of": ["floor.ymax", "wall.xmax"], "within": [-9, -9, 9, 9]}, "interfaces": ["a"],
                "a": {"nonmortar": "skin", "mortar": "corner", **base}}
        two = {"interfaces": ["a", "b"], "a": {"nonmortar": "block.ymin", "mortar": "floor.ymax", **base},
               "b": {"nonmortar": "block.xmin", "mortar": "wall.xmax", **base}}
        return {
            "schema": 1,
            "model": "plane_strain",
            "bodies": ["block", "floor", "wall"],
            "block": {"type": "box", "lower": [0, 0], "upper": [1, 1], "cells": [4, 4], "young": 1000, "poisson": 0.3},
            "floor": box | {"lower": [-1, -1], "upper": [2, 0], "cells": [7, 2]},
            "wall": box | {"lower": [-1, -0.5], "upper": [0, 2], "cells": [2, 7]},
            "supports": ["ground", "back"],
            "ground": {"surface": "floor.ymin", "components": ["x", "y"]},
            "back": {"surface": "wall.xmin", "components": ["x", "y"]},
            "loads": ["top", "side"],
            "top": {"surface": "block.ymax", "pressure": 10},
            "side": {"surface": "block.xmax", "pressure": 10},
            **(both if one else two),
            "steps": {"count": 2},
            "output": {"vtu": "none", "csv": "last"},
        }

    def run(context):
        solved = context.solve(scene(True))
        result = host.outcome(solved)
        if result.refusal is None:
            two = context.solve(scene(False), name="two")
            found, other = (np.array([r.steps[-1]["reactions"][k][:2] for k in ("ground", "back")]) for r in (solved, two))
            result.below("balance", np.abs(found.sum(axis=0) - 10).max() / 10, 1e-3, "the loads, which turn with the sides by 1e-3")
            strip = SAME if friction == 0 else STRIP
            result.below("reactions", np.abs(found - other).max() / 10, strip, "two interfaces; the corner's strip has no friction")
        return result

    return run


def cells():
    plane = {"": ("quad", False, 0), ", friction": ("quad", False, 0.3), ", triangles": ("tri", False, 0), ", quadratic": ("quad8", False, 0.3)}
    space = {"": ("hex", True, 0), ", tetrahedra, friction": ("tet", True, 0.3), ", quadratic tetrahedra": ("tet10", True, 0)}
    for name, (cell, is_space, friction) in plane.items():
        make = lambda n, c=cell, f=friction: lambda context: against_foot(context, c, False, f, n=n)
        yield from series(f"skin pressed by its foot{name}, cells", CELLS, make, quick=(3,) if name != ", quadratic" else ())
    for name, (cell, is_space, friction) in space.items():
        make = lambda n, c=cell, f=friction: lambda context: against_foot(context, c, True, f, n=n)
        yield from series(f"skin pressed by its foot in space{name}, cells", CELLS[:4] + (7, 8), make, quick=(2,))
    make = lambda lean: lambda context: against_foot(context, "quad", False, 0.3, lean=lean)
    yield from series("skin pressed by its foot, sides lean by", LEANS, make, quick=(0.6,))
    yield from series("skin that flies against a wall, sideways at", SPEEDS, flight, quick=(1,))
    yield from series("skin in a corner, friction", FRICTIONS, corner, quick=(0.3,))
