"""Interfaces that share nodes, and layers clamped at one wall: conditions that say the same, or nearly."""

import host
from cell import series

YOUNG, POISSON = 1000.0, 0.3
SHORTER = 0.01  # what presses the patch
ROUNDED = 1e-8  # of a patch, over its force
# Of an edge of shared nodes in contact: where multipliers that are left out leave others to pull, contact lets these go, and what is left
# presses a little less evenly: 2.3e-5 of the force at most in these cells, and 2e-3 where a node of one surface gave way to a shared one.
LET_GO = 1e-4
# Clamped layers of like meshes are the merged body but for what the meshes differ by; of unlike ones their stiffness lies between those of the
# two merged bodies, within this.
LIKE, UNLIKE = 1e-4, 0.02
BASES = ("standard", "dual")
LAWS = {"tied": {"law": "tied"}, "frictionless": {"law": "none"}, "friction": {"law": "coulomb", "friction": 0.3}}
# cells along the upper block over those along the lower one, from like meshes to one facet under six
MESHES = ("4:4", "4:2", "6:4", "2:6", "4:3", "6:1")
SPACE_MESHES = ("2x1:2x1", "4x2:2x1", "4x3:6x2", "2x2:6x3", "4x2:3x3", "4x3:1x1")


def box(lower, upper, cells, **more):
    return {"type": "box", "lower": lower, "upper": upper, "cells": cells, "young": YOUNG} | more


def halves(upper, lower, law, basis, cell):
    """A block on a block; the face of the upper one is two surfaces, which share the nodes in its middle."""
    plane = len(upper) == 1
    axes, mid = ("x", "y") if plane else ("x", "y", "z"), 1 - 1e-3
    at = lambda x, z: [x, z] if plane else [x, 0, z]
    far = lambda x, z: [x, z] if plane else [x, 1, z]
    down = axes[-1]
    scene = {
        "schema": 1,
        "bodies": ["lower", "upper"],
        "lower": box(at(0, 0), far(2, 1), [*lower, 1], poisson=POISSON, cell=cell),
        "upper": box(at(0, 1), far(2, 2), [*upper, 1], poisson=POISSON, cell=cell),
        "surfaces": ["left", "right"],
        "left": {"of": f"upper.{down}min", "within": [*at(0, mid), *far(1, 1.001)]},
        "right": {"of": f"upper.{down}min", "within": [*at(1, mid), *far(2, 1.001)]},
        "supports": ["ground", "sides", "press"],
        "ground": {"surface": f"lower.{down}min", "components": [down]},
        "sides": {"surface": ["lower.xmin", "upper.xmin"], "components": ["x"]},
        "press": {"surface": f"upper.{down}max", "components": [down], "value": at(0, -SHORTER)},
        "interfaces": ["a", "b"],
        "a": {"nonmortar": "left", "mortar": f"lower.{down}max", "basis": basis} | LAWS[law],
        "b": {"nonmortar": "right", "mortar": f"lower.{down}max", "basis": basis} | LAWS[law],
        "steps": {"count": 2},
        "output": {"vtu": "none", "csv": "none"},
    }
    if plane:
        return scene | {"model": "plane_strain"}
    scene["supports"].append("back")
    return scene | {"back": {"surface": ["lower.ymin", "upper.ymin"], "components": ["y"]}}


def patches(law, kinds):
    def make(severity):
        upper, lower = ([int(n) for n in side.split("x")] for side in severity.split(":"))
        stiffness = YOUNG / (1 - POISSON**2) if len(upper) == 1 else YOUNG
        exact = SHORTER / 2 * stiffness * 2  # on the area 2

        def run(context):
            for cell in kinds:
                for basis in BASES:
                    whole = context.solve(halves(upper, lower, law, basis, cell), name=f"{cell}_{basis}")
                    result = host.outcome(whole)
                    if result.refusal is not None:
                        return result
                    force = abs(whole.steps[-1]["reactions"]["press"][len(upper)])
                    errors.append((f"{cell}, {basis}: force", abs(force / exact - 1)))
            for what, error in errors:
                result.below(what, error, ROUNDED if law == "tied" or len(upper) == 1 else LET_GO, "a uniform patch")
            return result

        errors = []
        return run

    return make


def layers(cells, law, basis, apart=0.0, shift=0.0):
    """Two layers, clamped at x = 0 and pulled down at their end; `shift`: of the upper one's nodes within."""
    x = [4 * k / cells[0] * (1 + (shift if 0 < k < cells[0] else 0)) for k in range(cells[0] + 1)]
    common = {"type": "box", "young": YOUNG, "poisson": 0, "small_strain": True}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["low", "up"],
        "low": box([0, 0], [4, 1], [cells[1], 1], poisson=0, small_strain=True),
        "up": common | {"x": x, "y": [1, 2]},
        "supports": ["below", "above"],
        "below": {"surface": "low.xmin", "components": ["x", "y"]},
        "above": {"surface": "up.xmin", "components": ["x", "y"], "value": [0, apart]},
        "loads": ["tip"],
        "tip": {"surface": ["low.xmax", "up.xmax"], "traction": [0, -0.1]},
        "interfaces": ["a"],
        "a": {"nonmortar": "up.ymin", "mortar": "low.ymax", "law": law, "basis": basis},
        "probes": ["end"],
        "end": {"body": "up", "point": [4, 2]},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "none"},
    }


def merged(cells):
    scene = layers((cells, cells), "tied", "standard")
    for name in ("up", "above", "a", "interfaces"):
        scene.pop(name)
    below = {"surface": "low.xmin", "components": ["x", "y"]}
    return scene | {
        "bodies": ["low"],
        "low": box([0, 0], [4, 2], [cells, 2], poisson=0, small_strain=True),
        "supports": ["below"],
        "below": below,
        "tip": {"surface": "low.xmax", "traction": [0, -0.1]},
        "end": {"body": "low", "point": [4, 2]},
    }


def bending(run):
    return abs(run.steps[-1]["probes"]["end"][1])


def like(shift):
    def run(context):
        exact = bending(context.solve(merged(10), name="merged"))
        for basis in BASES:
            whole = context.solve(layers((10, 10), "tied", basis, shift=shift), name=basis)
            result = host.outcome(whole)
            if result.refusal is not None:
                return result
            errors.append((f"{basis}: bending", abs(bending(whole) / exact - 1)))
        for what, error in errors:
            result.below(what, error, LIKE + 2 * shift, "the merged body")
        return result

    errors = []
    return run


def unlike(severity):
    cells = [int(n) for n in severity.split(":")]

    def run(context):
        least, most = sorted(bending(context.solve(merged(n), name=f"merged_{n}")) for n in cells)
        for basis in BASES:
            whole = context.solve(layers(cells, "tied", basis), name=basis)
            result = host.outcome(whole)
            if result.refusal is not None:
                return result
            found.append((basis, bending(whole)))
        for basis, bent in found:
            result.below(f"{basis}: beyond the merged bodies", max(least / bent - 1, bent / most - 1, 0), UNLIKE, "of one mesh and of the other")
        return result

    found = []
    return run


def apart(distance):
    def run(context):
        return host.outcome(context.solve(layers((10, 10), "tied", "standard", apart=distance)))

    return run


def cells():
    for law in LAWS:
        yield from series(f"two surfaces share a node, {law}, cells", MESHES, patches(law, ("quad", "quad8")), quick=("4:2",))
        yield from series(f"two surfaces share an edge, {law}, cells", SPACE_MESHES, patches(law, ("hex",)))
    yield from series("layers clamped at one wall, meshes apart by", (0, 1e-9, 1e-7, 1e-5, 1e-3, 1e-2), like, quick=(1e-7,))
    yield from series("layers clamped at one wall, cells", ("10:7", "7:10", "8:4", "4:8", "10:3", "16:3"), unlike, quick=("10:3",))
    yield from series("tied layers, the wall pulled apart by", (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1), apart, may_refuse="apart along y at")
