"""Effects of loads: springs from hardly any stiffness to almost rigid, springs whose line turns over, supports that are let go or
activated, a face that a rigid body holds, moments that are spread, pressures that follow; each compared with a closed form, with
statics, or with the run that needs no such effect."""

import numpy as np

import host
from cell import series

# Newton's method ends at 1e-11 of the forces; what is compared are means and sums.
EXACT = 1e-8
# A spring that is softer than the body by 1e10 has the rounding of the body's own forces in its displacement.
ROUNDING = 1e-16
# What a step in time of a pressure that follows leaves: a cube of one state, to Newton's tolerance.
CUBE = 1e-8
# A rigid body tied to a face, over multipliers, against the face held by a support: both to Newton's tolerance.
HELD = 1e-7

YOUNG = 1000.0
BOX = {"type": "box", "young": YOUNG, "poisson": 0.3, "small_strain": True}
QUIET = {"csv": "none", "vtu": "none"}


def pad(**more):
    """A block on a base, frictional, pressed by a load."""
    return {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": {**BOX, "lower": [0.1, 0.1, 0], "upper": [1.1, 0.9, 0.5], "cells": [3, 2, 2]},
        "lower": {**BOX, "lower": [-0.5, 0, -0.5], "upper": [2, 1, 0], "cells": [7, 3, 2]},
        "supports": ["ground"],
        "ground": {"surface": "lower.zmin", "components": ["x", "y", "z"]},
        "loads": ["press"],
        "press": {"surface": "upper.zmax", "traction": [0, 0, -10]},
        "interfaces": ["base"],
        "base": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "friction": 0.3},
        "steps": {"count": 2},
        "output": QUIET,
        **more,
    }


def near(result, quantity, found, exact, bound, reason, scale=None):
    size = np.abs(exact).max() if scale is None else scale
    result.below(quantity, np.abs(np.asarray(found) - exact).max() / size, bound, reason)


def bed(factor):
    """A pad that springs alone hold across, over a base; the springs have so many times the stiffness of the pad. They carry what
    friction does not; the base the weight."""

    def run(context):
        scene = pad(springs=["bed"], bed={"surface": "upper.xmin", "stiffness": [factor * YOUNG] * 3}, loads=["press", "push"],
                    push={"surface": "upper.xmax", "traction": [-4, 0.5, 0]})
        solved = context.solve(scene)
        result = host.outcome(solved)
        if result.refusal is None:
            step = solved.steps[-1]
            total = np.array(step["springs"]["bed"]) + step["reactions"]["ground"] + np.array([-4 * 0.8 * 0.5, 0.5 * 0.8 * 0.5, -8.0])
            near(result, "balance of springs, base and loads", total, np.zeros(3), EXACT + ROUNDING * factor, "statics", scale=8.0)
        return result

    return run


def lifted(factor):
    """A block on springs alone, of this part of its own stiffness, and nothing else."""

    def run(context):
        scene = pad(bodies=["upper"], springs=["bed"], bed={"surface": "upper.zmin", "stiffness": [factor * YOUNG] * 3})
        for name in ("lower", "supports", "ground", "base", "interfaces"):
            del scene[name]
        solved = context.solve(scene)
        result = host.outcome(solved)
        if result.refusal is None:
            near(result, "force of the springs", solved.steps[-1]["springs"]["bed"], np.array([0, 0, 8.0]), EXACT + ROUNDING / factor, "the load")
        return result

    return run


def drowns(factor):
    """A block that moves more than thousand times its size is lost in the rounding of its own forces, and the springs are why."""
    return r"Springs hold what follows, and they are so soft that rounding is \S+ of a force along it.*upper: move along x, y, z" if factor < 1e-5 else None


def turned(push):
    """A stiff block on a rail under an axial spring of length 1 from above, pushed so far that its line turns over by up to 89 degrees."""

    def run(context):
        scene = pad(bodies=["upper"], supports=["rail"], rail={"body": "upper", "components": ["y", "z"]}, springs=["line"],
                    line={"body": "upper", "point": [0.1, 0.1, 0.5], "to_point": [0.1, 0.1, 1.5], "axial": True, "stiffness": 2.0},
                    press={"surface": "upper.xmax", "traction": [push, 0, 0]}, probes=["corner"], corner={"body": "upper", "point": [0.1, 0.1, 0.5]},
                    steps={"count": 4})
        for name in ("lower", "ground", "base", "interfaces"):
            del scene[name]
        solved = context.solve(scene)
        result = host.outcome(solved)
        if result.refusal is None:
            x, force = solved.steps[-1]["probes"]["corner"][0], push * 0.8 * 0.5
            near(result, "force along the rail", 2.0 * (1 - 1 / np.hypot(x, 1)) * x, force, EXACT, "the push")
        return result

    return run


def let_go(share):
    """A pad that a grip pushes along the base, with this share of what friction can carry, and lets go: friction holds it."""

    def run(context):
        hold = {"surface": "upper.zmax", "components": ["z"], "value": [0, 0, -0.01], "curve": [0, 0, 1, 1]}
        scene = pad(supports=["ground", "grip"], grip={**hold, "until": 1}, loads=["press", "push"],
                    press={"surface": "upper.zmax", "traction": [0, 0, -10], "curve": [0, 0, 1, 1]},
                    push={"surface": "upper.zmax", "traction": [10 * 0.3 * share, 0, 0], "curve": [1, 0, 2, 0, 3, 1]}, steps={"times": [0.5, 1, 1.5, 2, 3]})
        solved = context.solve(scene)
        result = host.outcome(solved)
        if result.refusal is None:
            near(result, "force of the base", solved.resultant("base"), np.array([-3 * share * 0.4 * 2, 0, 8.0]), EXACT, "loads")
        return result

    return run


def fades(fade):
    """A rubber beam that is bent far and let go within so much time comes back."""

    def run(context):
        scene = {
            "schema": 1,
            "bodies": ["beam"],
            "beam": {**BOX, "lower": [0, 0, 0], "upper": [4, 1, 1], "cells": [8, 1, 2], "material": "neo_hooke"},
            "supports": ["foot", "bend"],
            "foot": {"surface": "beam.xmin", "components": ["x", "y", "z"]},
            "bend": {"surface": "beam.xmax", "components": ["z"], "value": [0, 0, 1.5], "curve": [0, 0, 1, 1], "until": 1, "fade": fade},
            "steps": {"times": [0.25, 0.5, 0.75, 1, 2, 3]},
            "probes": ["end"],
            "end": {"body": "beam", "point": [4, 0, 0]},
            "output": QUIET,
        }
        del scene["beam"]["small_strain"]
        solved = context.solve(scene)
        result = host.outcome(solved)
        if result.refusal is None:
            near(result, "the end", solved.steps[-1]["probes"]["end"], np.zeros(3), EXACT, "where it began", scale=1.5)
        return result

    return run


def caught(size):
    """A falling load is caught by a support that is activated, whatever had moved by then."""

    def run(context):
        scene = pad(supports=["ground", "guide", "catch"], guide={"surface": "upper.ymin", "components": ["y"]},
                    catch={"surface": "upper.zmax", "components": ["x", "z"], "from": 0.5}, press={"surface": "upper.zmax", "traction": [0, 0, -size]},
                    probes=["corner"], corner={"body": "upper", "point": [0.1, 0.1, 0.5]})
        solved = context.solve(scene)
        result = host.outcome(solved)
        if result.refusal is None:
            then, now = (np.array(step["probes"]["corner"])[[0, 2]] for step in (solved.steps[0], solved.steps[-1]))
            near(result, "the corner", now, then, EXACT, "where it was caught")
            step = solved.steps[-1]
            total = sum(np.array(force) for force in step["reactions"].values()) + [0, 0, -0.8 * size]
            near(result, "balance", total, np.zeros(3), EXACT, "statics", scale=0.8 * size)
        return result

    return run


def rigid_face(angle):
    """A rigid plate tied to the end of a rubber bar turns it about its axis: as a support that turns the face."""

    def run(context):
        bar = {**BOX, "lower": [0, 0, 0], "upper": [1, 1, 3], "cells": [2, 2, 4], "material": "neo_hooke"}
        del bar["small_strain"]
        common = {"schema": 1, "supports": ["foot", "turn"], "foot": {"surface": "bar.zmin", "components": ["x", "y", "z"]},
                  "steps": {"count": max(1, int(np.ceil(angle / 0.25)))}, "output": QUIET, "bar": bar}
        turn = {"rotate": [0, 0, angle], "value": [0, 0, 0]}
        held = context.solve({**common, "bodies": ["bar"], "turn": {**turn, "surface": "bar.zmax", "components": ["x", "y", "z"], "origin": [0.5, 0.5, 3]}})
        plate = {"type": "rigid", "from": "box", "lower": [0, 0, 3], "upper": [1, 1, 3.2], "cells": [2, 2, 1], "reference": [0.5, 0.5, 3]}
        tied = context.solve({**common, "bodies": ["bar", "plate"], "plate": plate, "interfaces": ["tie"],
                              "turn": {**turn, "body": "plate", "components": ["x", "y", "z", "rx", "ry", "rz"]},
                              "tie": {"nonmortar": "bar.zmax", "mortar": "plate.zmin", "law": "tied"}})
        result = host.outcome(tied)
        if result.refusal is None and held.exit_code == host.CONVERGED:
            near(result, "moment at the foot", tied.steps[-1]["moments"]["foot"], np.array(held.steps[-1]["moments"]["foot"]), HELD, "as turned by a support")
        return result

    return run


def spread(slenderness):
    """A moment over the end of a beam, whatever its proportions: what its foot feels."""

    def run(context):
        moment = np.array([0.3, 0.2, -0.1])
        scene = {
            "schema": 1,
            "bodies": ["beam"],
            "beam": {**BOX, "young": 1e7, "lower": [0, 0, 0], "upper": [4, 1, slenderness], "cells": [6, 2, 2]},
            "supports": ["foot"],
            "foot": {"surface": "beam.xmin", "components": ["x", "y", "z"]},
            "loads": ["tip"],
            "tip": {"surface": "beam.xmax", "moment": (moment * slenderness**3).tolist()},
            "steps": {"count": 1},
            "output": QUIET,
        }
        solved = context.solve(scene)
        result = host.outcome(solved)
        if result.refusal is None:
            step = solved.steps[-1]
            near(result, "moment at the foot", step["moments"]["foot"], -moment * slenderness**3, EXACT, "statics")
        return result

    return run


def follows(pressure):
    """A cube under a pressure on its surface of now, up to so many times its shear modulus: the same stretch everywhere."""

    def run(context):
        size = pressure * YOUNG / 2.6
        cube = {**BOX, "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [2, 2, 2], "material": "neo_hooke"}
        del cube["small_strain"]
        solved = context.solve({
            "schema": 1,
            "bodies": ["cube"],
            "cube": cube,
            "supports": list("xyz"),
            **{axis: {"surface": f"cube.{axis}min", "components": [axis]} for axis in "xyz"},
            "loads": ["press"],
            "press": {"surface": [f"cube.{axis}max" for axis in "xyz"], "pressure": size, "follower": True},
            "steps": {"count": 4},
            "probes": ["corner"],
            "corner": {"body": "cube", "point": [1, 1, 1]},
            "output": QUIET,
        })
        result = host.outcome(solved)
        if result.refusal is None:
            shear, lame = YOUNG / 2.6, YOUNG * 0.3 / (1.3 * 0.4)
            low, high = 0.02, 1.0
            for _ in range(200):
                s = (low + high) / 2
                low, high = (s, high) if (shear * (s**2 - 1) + 3 * lame * np.log(s)) / s**3 < -size else (low, s)
            near(result, "stretch", 1 + np.array(solved.steps[-1]["probes"]["corner"]), s, CUBE, "closed form")
        return result

    return run


def cells():
    yield from series("springs beside friction, over the block's stiffness", (1e-6, 1e-3, 1, 1e3, 1e6), bed, quick=(1e-3,))
    yield from series("springs alone, over the block's stiffness", (1, 1e-2, 1e-4, 1e-6, 1e-8), lifted, quick=(1e-4,), may_refuse=drowns)
    yield from series("axial spring that turns, push", (0.1, 1, 10, 100, 1000), turned, quick=(10,))
    yield from series("let go on friction, share of its limit", (0.1, 0.5, 0.9, 0.99), let_go, quick=(0.5,))
    yield from series("let go, time of fading", (1, 0.25, 0.05, 0), fades, quick=(0.25,))
    yield from series("caught by a support, load", (1e-3, 1, 10, 100), caught, quick=(10,))
    yield from series("rigid face, turn", (1e-3, 0.1, 0.5, 1, 2), rigid_face, quick=(0.1,))
    yield from series("spread moment, height over width", (1, 0.3, 0.1, 0.03), spread, quick=(0.3,))
    yield from series("pressure that follows, shear moduli", (1e-3, 0.1, 1, 5), follows, quick=(0.1,))
