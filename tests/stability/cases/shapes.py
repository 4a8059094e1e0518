"""Analytic shapes that a body passes: what is beside a shape, or behind it, is no contact however long the steps are; shapes
the wrong way round, and radii with the wrong sign, are refused; plane stress over a circle is plane stress over facets."""

import numpy as np

import host
from cell import series

# Lengths of the steps of a shape that passes a wall beside it, over its radius.
STEPS = (0.25, 0.5, 1, 2, 4, 8)
# Heights of the wall below the shape that is pushed against its head, over the shape's radius.
HEIGHTS = (0.5, 1, 2, 4, 8, 16)
# How far the block's face lies in the body of a shape that is the wrong way round, in facets; it is outside below 0.
DEPTHS = (-0.2, 0, 0.2, 1, 4, 16)
FACETS = (8, 12, 16, 24, 48, 96)
# Of a run with forces and one without: rounding of the bodies' own forces.
NOTHING = 1e-9
# Two runs of the same equations, to the tolerance of a step.
SAME = 1e-8
RADIUS = 0.2
WRONG_WAY = r"look the same way"
WRONG_SIGN = r"looks into the body of the shape"
BODY = {"type": "box", "young": 1000, "poisson": 0.3, "material": "neo_hooke"}
ELASTIC = {"type": "box", "young": 1000, "poisson": 0.3}


def plane_wall(cell):
    """A wall at x = 0 that is clamped at its foot, and its face."""
    wall = BODY | {"lower": [0, 0], "upper": [0.3, 1], "cells": [2, 10], "cell": cell}
    return "plane_strain", wall, ("wall.xmin", "wall.ymin")


def solid_wall(cell):
    wall = BODY | {"lower": [0, -0.2, 0], "upper": [0.3, 0.2, 1], "cells": [2, 3, 8], "cell": cell}
    return None, wall, ("wall.xmin", "wall.zmin")


def up(solid, x, z):
    return [x, 0, z] if solid else [x, z]


def shape_of(name, at, solid):
    """A shape of RADIUS about a place, or a large hole whose wall goes through it on the far side."""
    shape = {"type": "analytic", "shape": name, "radius": RADIUS, "point": up(solid, *at)}
    return shape | ({"direction": [0, 1, 0]} if name == "cylinder" else {})


def passing(name, cell):
    """The shape goes past the wall, above its head and beyond it: it never comes closer than a quarter of its radius."""
    solid = name != "circle"

    def make(step):
        model, wall, (face, foot) = (solid_wall if solid else plane_wall)(cell)
        start, way = -1.5, 3.2
        scene = {
            "schema": 1,
            "bodies": ["wall", "shape"],
            "wall": wall,
            "shape": shape_of(name, (start, 1 + 1.25 * RADIUS), solid),
            "supports": ["foot", "drive"],
            "foot": {"surface": foot, "components": ["x", "y", "z"] if solid else ["x", "y"]},
            "drive": {"body": "shape", "components": ["x", "y", "z"] if solid else ["x", "y"], "value": up(solid, way, 0)},
            "interfaces": ["contact"],
            "contact": {"nonmortar": face, "mortar": "shape.surface"},
            "steps": {"count": max(1, round(way / (step * RADIUS)))},
            "output": {"vtu": "none", "csv": "none"},
        } | ({"model": model} if model else {})

        def run(context):
            found = context.solve(scene)
            result = host.outcome(found)
            if result.refusal is None:
                force = max(np.abs(s["interfaces"]["contact"]["force"]).max() for s in found.steps)
                result.below("largest force, over E a^2", force / (1000 * RADIUS**2), NOTHING, "it touches nothing")
            return result

        return run

    return make


def pushed(cell, basis):
    """A disc pushes the head of a wall over; the foot is far beside it. Naming the foot's facets, too, changes nothing."""

    def make(height):
        length = 0.6 + height * RADIUS
        cells = round(length / 0.1)
        near = length - 0.55

        def scene(whole):
            model, wall, _ = plane_wall(cell)
            wall |= {"lower": [0, 1 - length], "upper": [0.15, 1], "cells": [2, cells]}
            return {
                "schema": 1,
                "model": model,
                "bodies": ["wall", "shape"],
                "wall": wall,
                "shape": shape_of("circle", (-0.2001, 0.75), False),
                "surfaces": ["head"],
                "head": {"of": "wall.xmin", "within": [-1, 1 - length + near - 1e-6, 1, 2]},
                "supports": ["foot", "drive"],
                "foot": {"surface": "wall.ymin", "components": ["x", "y"]},
                "drive": {"body": "shape", "components": ["x", "y"], "value": [0.1 * length, 0]},
                "interfaces": ["contact"],
                "contact": {"nonmortar": "wall.xmin" if whole else "head", "mortar": "shape.surface", "basis": basis},
                "steps": {"count": 4},
                "output": {"vtu": "none", "csv": "none"},
            }

        def run(context):
            runs = [context.solve(scene(whole), name=name) for whole, name in ((True, "whole"), (False, "head"))]
            result = host.outcome(runs[0])
            if result.refusal is None:
                whole, head = (np.array(r.steps[-1]["interfaces"]["contact"]["force"]) for r in runs)
                result.below("force, whole face against its head", np.abs(whole / head - 1)[:1].max(), SAME, "the foot is beside it")
            return result

        return run

    return make


def wrong_way(name):
    """A block below a shape whose body is on the block's side: refused before the first step."""
    solid = name in ("plane", "sphere", "cylinder")

    def make(depth):
        size = 0.25
        at = 1 + depth * size
        lid = {"type": "analytic", "shape": name, "point": up(solid, 0.5, at)}
        if name in ("plane", "line"):
            lid["direction"] = up(solid, 0, 1)
        else:
            lid |= {"radius": -6, "point": up(solid, 0.5, at + 6)}
            if depth < 0:  # outside of it the block would be in a bore
                lid |= {"radius": -6.1}
        if name == "cylinder":
            lid["direction"] = [0, 1, 0]
        block = ELASTIC | {"lower": [0, 0, 0] if solid else [0, 0], "upper": [1] * (3 if solid else 2), "cells": [4] * (3 if solid else 2)}
        top, bottom = ("block.zmax", "block.zmin") if solid else ("block.ymax", "block.ymin")
        axes = ["x", "y", "z"] if solid else ["x", "y"]
        scene = {
            "schema": 1,
            "bodies": ["block", "lid"],
            "block": block,
            "lid": lid,
            "supports": ["ground", "press"],
            "ground": {"surface": bottom, "components": axes},
            "press": {"body": "lid", "components": axes, "value": up(solid, 0, -0.06)},
            "interfaces": ["contact"],
            "contact": {"nonmortar": top, "mortar": "lid.surface"},
            "steps": {"count": 2},
            "output": {"vtu": "none", "csv": "none"},
        } | ({} if solid else {"model": "plane_strain"})

        def run(context):
            result = host.outcome(context.solve(scene))
            result.true("refused", False, "the shape's body is on the block's side")
            return result

        return run

    return make


def wrong_sign(side):
    """A ring on a shaft whose polygons do not match, with a radius of the wrong sign on one side."""

    def make(facets):
        signs = {"nonmortar": (-1, -1), "mortar": (1, 1)}[side]
        polar = {"polar": True, "small_strain": True} | ELASTIC
        scene = {
            "schema": 1,
            "model": "plane_stress",
            "bodies": ["shaft", "ring"],
            "shaft": polar | {"lower": [0.5, 0], "upper": [1, 360], "cells": [2, facets]},
            "ring": polar | {"lower": [1, 0], "upper": [1.5, 360], "cells": [2, facets + 4]},
            "supports": ["across"],
            "across": {"body": ["shaft", "ring"], "within": [-9, -1e-6, 9, 1e-6], "components": ["x", "y"]},
            "interfaces": ["fit"],
            "fit": {"nonmortar": "shaft.xmax", "mortar": "ring.xmin", "offset": -0.002, "round": "circle"},
            "steps": {"count": 1},
            "output": {"vtu": "none", "csv": "none"},
        }
        scene["fit"] |= {"nonmortar_radius": signs[0], "mortar_radius": signs[1]}

        def run(context):
            result = host.outcome(context.solve(scene))
            result.true("refused", False, "the facets show on which side their body is")
            return result

        return run

    return make


def flat_circle(cell):
    """A block pressed on a circle in plane stress, against the same in plane strain with the constants that make both alike."""

    def make(radius):
        young, poisson = 1000, 0.3
        constants = {
            "plane_stress": (young, poisson),
            "plane_strain": (young * (1 + 2 * poisson) / (1 + poisson) ** 2, poisson / (1 + poisson)),
        }

        def scene(model):
            e, nu = constants[model]
            block = {"type": "box", "lower": [0, 0], "upper": [1, 1], "cells": [6, 6], "young": e, "poisson": nu, "small_strain": True}
            return {
                "schema": 1,
                "model": model,
                "bodies": ["block", "floor"],
                "block": block | {"cell": cell},
                "floor": {"type": "analytic", "shape": "circle", "point": [0.5, -radius], "radius": radius},
                "supports": ["rest", "press"],
                "rest": {"body": "floor", "components": ["x", "y"]},
                "press": {"surface": "block.ymax", "components": ["x", "y"], "value": [0, -0.01]},
                "interfaces": ["contact"],
                "contact": {"nonmortar": "block.ymin", "mortar": "floor.surface"},
                "steps": {"count": 1},
                "output": {"vtu": "none", "csv": "none"},
            }

        def run(context):
            runs = [context.solve(scene(model), name=model) for model in constants]
            result = host.outcome(runs[0])
            if result.refusal is None:
                stress, strain = (r.steps[-1]["interfaces"]["contact"]["force"][1] for r in runs)
                result.below("force", abs(stress / strain - 1), SAME, "plane strain with other constants")
            return result

        return run

    return make


def cells():
    for name, cell in (("circle", "quad"), ("circle", "quad8"), ("sphere", "hex"), ("cylinder", "hex")):
        quick = (2,) if cell == "quad" else ()
        yield from series(f"{name} passes a wall, {cell}, steps in radii", STEPS, passing(name, cell), quick=quick)
    for cell, basis in (("quad", "standard"), ("quad", "dual"), ("quad8", "standard")):
        case = f"wall pushed over, {cell}, {basis}, foot in radii"
        yield from series(case, HEIGHTS, pushed(cell, basis), quick=(4,) if (cell, basis) == ("quad", "standard") else ())
    for name in ("plane", "line", "sphere", "cylinder", "circle"):
        quick = (0.2,) if name in ("plane", "circle") else ()
        yield from series(f"{name} the wrong way round, facets deep", DEPTHS, wrong_way(name), quick=quick, may_refuse=WRONG_WAY)
    for side in ("nonmortar", "mortar"):
        yield from series(f"{side} radius of the wrong sign, facets", FACETS, wrong_sign(side), quick=(8,), may_refuse=WRONG_SIGN)
    for cell in ("quad", "quad8"):
        case = f"plane stress on a circle, {cell}, radius"
        yield from series(case, (1, 2, 5, 10, 100, 1000), flat_circle(cell), quick=(5,) if cell == "quad" else ())
