"""Thin plates with all faces in the contact: the far sides of both are behind each other by less than a facet is long. Bodies in
front of each other beyond the search distance; surfaces tied across gaps; pressures on bodies that turn."""

import math

import host
from cell import series

# Thicknesses of plates whose facets are half as long as they are wide.
THICK = (0.4, 0.2, 0.1, 0.05, 0.02, 0.01)
WIDE = 1.6
# Gaps over what is searched.
GAPS = (0.5, 1.5, 3, 5, 10, 30)
# Gaps of tied surfaces over the edges of their facets.
TIED = (0.01, 0.05, 0.15, 0.5, 1, 4)
TURNS = (1, 3, 8, 15, 45, 90)  # degrees
# A force that a body has no other support against, to the tolerance of a step.
BALANCE = 1e-9
# A plate under a pressure of a thousandth of E is compressed by about so much of its thickness; at its corners by some times that.
STRAIN = 5e-3
# As a series of springs.
SAME = 1e-9
ELASTIC = {"type": "box", "young": 1000, "poisson": 0.3}


def skin(body, solid):
    sides = ("xmin", "xmax", "ymin", "ymax") + (("zmin", "zmax") if solid else ())
    return {"of": [f"{body}.{side}" for side in sides], "within": [-9] * (3 if solid else 2) + [9] * (3 if solid else 2)}


def plates(solid, swapped):
    """A plate on a wider one that is held from below; the upper one is pressed on it."""

    def make(thick):
        place = (lambda x, z: [x, x, z]) if solid else (lambda x, z: [x, z])
        count = (lambda n: [n, n, 1]) if solid else (lambda n: [n, 1])
        top, bottom = ("zmax", "zmin") if solid else ("ymax", "ymin")
        sides = {"nonmortar": "low", "mortar": "high"} if swapped else {"nonmortar": "high", "mortar": "low"}
        scene = {
            "schema": 1,
            "bodies": ["plate", "coin"],
            "plate": ELASTIC | {"lower": place(-2, 0), "upper": place(2, thick), "cells": count(8)},
            "coin": ELASTIC | {"lower": place(-WIDE / 2, thick), "upper": place(WIDE / 2, 2 * thick), "cells": count(3)},
            "surfaces": ["low", "high"],
            "low": skin("plate", solid),
            "high": skin("coin", solid),
            "supports": ["ground", "guide"],
            "ground": {"surface": f"plate.{bottom}", "components": ["x", "y", "z"] if solid else ["x", "y"]},
            "guide": {"surface": f"coin.{top}", "components": ["x", "y"] if solid else ["x"]},
            "loads": ["weight"],
            "weight": {"surface": f"coin.{top}", "pressure": 1},
            "interfaces": ["contact"],
            "contact": sides,
            "probes": ["head"],
            "head": {"body": "coin", "point": place(WIDE / 2, 2 * thick)},
            "steps": {"count": 1},
            "output": {"vtu": "none", "csv": "none"},
        } | ({} if solid else {"model": "plane_strain"})

        def run(context):
            found = context.solve(scene)
            result = host.outcome(found)
            if result.refusal is None:
                last, up = found.steps[-1], 2 if solid else 1
                weight = WIDE**2 if solid else WIDE
                result.below("force", abs(abs(last["interfaces"]["contact"]["force"][up]) / weight - 1), BALANCE, "the weight")
                sunk = abs(last["probes"]["head"][up]) / (2 * thick)
                result.below("strain of both", sunk, STRAIN, "no more than pressure over stiffness")
            return result

        return run

    return make


def in_front(solid):
    """Two blocks apart, moved together until they press each other by a known amount."""

    def make(gap):
        reach, press, poisson = 0.1, 0.01, 0.0
        place = (lambda z: [0, 0, z]) if solid else (lambda z: [0, z])
        far = (lambda z: [1, 1, z]) if solid else (lambda z: [1, z])
        top, bottom = ("zmax", "zmin") if solid else ("ymax", "ymin")
        axes = ["x", "y", "z"] if solid else ["x", "y"]
        count = lambda n: [n] * (3 if solid else 2)
        box, away = ELASTIC | {"poisson": poisson, "small_strain": True}, gap * reach
        scene = {
            "schema": 1,
            "bodies": ["low", "up"],
            "low": box | {"lower": place(0), "upper": far(1), "cells": count(2)},
            "up": box | {"lower": place(1 + away), "upper": far(2 + away), "cells": count(3)},
            "supports": ["ground", "press"],
            "ground": {"surface": f"low.{bottom}", "components": axes},
            "press": {"surface": f"up.{top}", "components": axes, "value": place(-away - press)},
            "interfaces": ["contact"],
            "contact": {"nonmortar": f"up.{bottom}", "mortar": f"low.{top}", "search_distance": reach},
            "steps": {"count": math.ceil(2 * gap) + 1},
            "output": {"vtu": "none", "csv": "none"},
        } | ({} if solid else {"model": "plane_strain"})

        def run(context):
            found = context.solve(scene)
            result = host.outcome(found)
            if result.refusal is None:
                force = found.steps[-1]["interfaces"]["contact"]["force"][2 if solid else 1]
                result.below("force", abs(force / (1000 * press / 2) - 1), SAME, "two springs in a row")
            return result

        return run

    return make


def tied(gap):
    """Two blocks tied across a gap: told from a tenth of an edge on, and not before."""
    box, edge = ELASTIC | {"poisson": 0.0, "small_strain": True}, 0.25
    scene = {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["low", "up"],
        "low": box | {"lower": [0, 0], "upper": [1, 1], "cells": [4, 4]},
        "up": box | {"lower": [0, 1 + gap * edge], "upper": [1, 2 + gap * edge], "cells": [4, 4]},
        "supports": ["ground"],
        "ground": {"surface": "low.ymin", "components": ["x", "y"]},
        "loads": ["press"],
        "press": {"surface": "up.ymax", "pressure": 1},
        "interfaces": ["joint"],
        "joint": {"nonmortar": "up.ymin", "mortar": "low.ymax", "law": "tied"},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "none"},
    }

    def run(context):
        found = context.solve(scene)
        result = host.outcome(found)
        if result.refusal is None:
            told, summary = "are tied although they are" in found.text, found.steps[-1]["interfaces"]["joint"].get("tied_gap", 0)
            result.true("told on the terminal", told == (gap > 0.1), "from a tenth of an edge on")
            result.below("told in the summary", abs(summary - (gap * edge if gap > 0.1 else 0)), SAME, "the gap")
        return result

    return run


def turned(degrees):
    """A bar under a pressure on its end turns: told from a tenth of a radian on, and not where the pressure follows."""
    bar = ELASTIC | {"lower": [0, 0], "upper": [4, 1], "cells": [4, 1], "material": "neo_hooke"}
    scene = {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["bar", "floor"],
        "bar": bar,
        "floor": ELASTIC | {"lower": [-9, -40], "upper": [9, -30], "cells": [2, 2]},
        "supports": ["turn", "rest"],
        "turn": {"surface": "bar.xmin", "components": ["x", "y"], "rotate": math.radians(degrees)},
        "rest": {"surface": "floor.ymin", "components": ["x", "y"]},
        "loads": ["press"],
        "press": {"surface": "bar.xmax", "pressure": 0.01},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "bar.ymin", "mortar": "floor.ymax"},
        "steps": {"count": max(1, degrees // 5)},
        "output": {"vtu": "none", "csv": "none"},
    }

    def run(context):
        result = None
        for follows in (False, True):
            scene["press"]["follower"] = follows
            found = context.solve(scene, name="follows" if follows else "stays")
            result = result or host.outcome(found)
            if result.refusal is not None:
                return result
            told = found.summary.get("pressures_turned", {}).get("press", 0)
            due = math.radians(degrees) if not follows and math.radians(degrees) > 0.1 else 0
            # The bar bends by the pressure, too.
            result.below(f"angle told, follower {follows}", abs(told - due), 0.02, "the turn of the support")
        return result

    return run


def cells():
    for solid in (False, True):
        space = "space" if solid else "plane"
        for swapped in (False, True):
            case = f"thin plates, all faces, {space}, {'lower' if swapped else 'upper'} non-mortar"
            yield from series(case, THICK, plates(solid, swapped), quick=(0.1,) if solid != swapped else ())
        yield from series(f"in front, {space}, gap over search distance", GAPS, in_front(solid), quick=() if solid else (5,))
    yield from series("tied across a gap, in edges", TIED, tied, quick=(0.05, 1))
    yield from series("a pressure stays, body turns, degrees", TURNS, turned, quick=(3, 45))
