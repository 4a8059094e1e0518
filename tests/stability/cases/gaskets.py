"""Thin soft plates between two flanges that are pressed together by a force: contact alone holds the plate and the upper flange, its
normals along one direction, and friction along the others. Leaves that bend together, held at one end: they open node by node."""

import host
from cell import series

THICKNESS = ("0.5", "0.2", "0.1", "0.05", "0.02", "0.01")  # of the gasket, whose flanges are 2 wide
SOFTNESS = ("1e3", "1e2", "1e1", "1e0", "1e-1", "1e-2")  # its modulus; the flanges have 1e5
GAPS = ("0", "1e-4", "1e-3", "1e-2", "0.1", "0.3")  # on either side of it, before the flange falls
FRICTIONS = ("0.5", "0.2", "0.1", "0.05", "0.02", "0.01")
LEAF_CELLS = (40, 80, 120, 160, 200)  # along each leaf, which is 10 long and 0.2 thick
LEAVES = (2, 3, 4, 5)
# A step ends at 2e-11 of the forces, in each of a few bodies.
BALANCE = 1e-9
# Of all steps of a gasket; leaves open node by node, and each of their nodes may change its mind.
ITERATIONS = 80
# Beside beams without shear: of a leaf's length over its thickness, 50, and of cells as long as they are thick or less.
BENDING = 0.02


def box(lower, upper, cells, young, poisson=0.3):
    return {"type": "box", "lower": lower, "upper": upper, "cells": cells, "young": young, "poisson": poisson}


def gasket(thickness="0.1", young="1e1", gap="0", friction="0.2"):
    """Pressed by 1e-3 of its modulus on each unit of the area, 4."""
    height, apart, modulus = float(thickness), float(gap), float(young)
    low, high = apart, apart + height
    return {
        "schema": 1,
        "bodies": ["lower", "gasket", "upper"],
        "lower": box([-1, -1, -0.5], [1, 1, 0], [4, 4, 2], 1e5),
        "gasket": box([-0.9, -0.9, low], [0.9, 0.9, high], [7, 7, 1], modulus),
        "upper": box([-1, -1, high + apart], [1, 1, high + apart + 0.5], [5, 5, 2], 1e5),
        "supports": ["ground"],
        "ground": {"surface": "lower.zmin", "components": ["x", "y", "z"]},
        "loads": ["press"],
        "press": {"surface": "upper.zmax", "traction": [0, 0, -1e-3 * modulus]},
        "interfaces": ["under", "over"],
        "under": {"nonmortar": "gasket.zmin", "mortar": "lower.zmax", "friction": float(friction)},
        "over": {"nonmortar": "gasket.zmax", "mortar": "upper.zmin", "friction": float(friction)},
        "steps": {"count": 2},
        "output": {"vtu": "none", "csv": "none"},
    }


def pressed(name):
    """The flange's force goes through both faces of the gasket into the ground."""

    def make(severity):
        def run(context):
            scene = gasket(**{name: severity})
            found = context.solve(scene)
            result = host.outcome(found)
            if result.refusal is not None:
                return result
            load = -4 * scene["press"]["traction"][2]
            result.below("reaction", abs(found.steps[-1]["reactions"]["ground"][2] / load - 1), BALANCE, "the load")
            for side, sign in (("under", 1), ("over", -1)):
                result.below(side, abs(sign * found.resultant(side)[2] / load - 1), BALANCE, "the load")
            result.below("iterations", found.newton_iterations, ITERATIONS, "of all steps")
            result.below("cut-backs", found.summary["cutbacks"], 0, "of all steps")
            result.true("what is loose is told", {"gasket", "upper"} <= set(found.summary["held_by_contact"]), "both")
            return result

        return run

    return make


def leaves(cells=40, count=2):
    """Beams on each other, clamped at one end; the upper one is drawn down at the other. No friction: each carries its share."""
    names = [f"leaf{k}" for k in range(count)]
    scene = {"schema": 1, "model": "plane_strain", "bodies": names, "supports": ["clamp"], "loads": ["tip"]}
    for k, name in enumerate(names):
        along = cells - 3 * (k % 2)
        scene[name] = box([0, 0.2 * k], [10, 0.2 * (k + 1)], [along, 1], 1e5, 0.0) | {"cell": "quad8", "small_strain": True}
    scene["clamp"] = {"surface": [f"{name}.xmin" for name in names], "components": ["x", "y"]}
    scene["tip"] = {"surface": f"{names[-1]}.xmax", "traction": [0, -0.5 * count]}
    scene["interfaces"] = [f"between{k}" for k in range(1, count)]
    for k in range(1, count):
        scene[f"between{k}"] = {"nonmortar": f"{names[k]}.ymin", "mortar": f"{names[k - 1]}.ymax"}
    scene |= {"probes": ["end"], "end": {"body": names[-1], "point": [10, 0.2 * count]}}
    return scene | {"steps": {"count": 1}, "output": {"vtu": "none", "csv": "none"}}


def bent(cells=40, count=2):
    """The leaves bend alike but for their tips, each under its share of the force: F l^3 / (3 E I)."""

    def run(context):
        found = context.solve(leaves(cells, count))
        result = host.outcome(found)
        if result.refusal is None:
            exact = -0.1 * 10**3 / (3 * 1e5 * 0.2**3 / 12)
            result.below("deflection", abs(found.steps[-1]["probes"]["end"][1] / exact - 1), BENDING, "of beams")
            result.below("cut-backs", found.summary["cutbacks"], 0, "of all steps")
        return result

    return run


def cells():
    yield from series("gasket between flanges, thickness", THICKNESS, pressed("thickness"), quick=("0.05",))
    yield from series("gasket between flanges, modulus", SOFTNESS, pressed("young"), quick=("1e-1",))
    yield from series("gasket between flanges, gaps", GAPS, pressed("gap"), quick=("1e-3",))
    yield from series("gasket between flanges, friction", FRICTIONS, pressed("friction"))
    yield from series("leaves clamped at one end, cells along each", LEAF_CELLS, lambda n: bent(cells=n), quick=(40,))
    yield from series("leaves clamped at one end, how many", LEAVES, lambda n: bent(count=n), quick=(3,))
