"""Contact that is decided at points: patch tests over stiffness, meshes, the modulus that is told, r, units; a block whose nodes are
covered in part; a body that lifts off on one side, its force by statics; a load that comes and goes. With weights of now the same blocks,
and one that slides over facets in one step, against one that has been there from the start."""

import numpy as np

import host
from cell import series

CONTRASTS = ("1e0", "1e2", "1e4", "1e6", "1e-2", "1e-4", "1e-6")
MESHES = ((3, 4), (2, 20), (20, 2), (12, 13), (1, 7), (7, 1))
SCALES = ("1e0", "1e1", "1e-1", "1e2", "1e-2", "1e4", "1e-4", "1e8", "1e-8")
UNITS = ("1e0", "1e3", "1e-3", "1e6", "1e-6", "1e9", "1e-9")
COVERS = ("5e-1", "1e-1", "1e-2", "1e-4", "1e-6", "1e-8")
TILTS = ("0", "0.1", "0.3", "0.5", "0.7", "0.9")
# The discrete solution is the exact one: Newton's method ends at 1e-11 of the forces, times the contrast of stiffness.
UNIFORM, OF_CONTRAST = 1e-9, 1e-13
# Statics of the converged state: 1e-11 of the forces, with some hundred of them.
STATICS = 1e-9
YOUNG, PRESSURE = 1000.0, 10.0
NOW = ("-contact_weights", "current")
SLIDES = ("0.1", "0.5", "1", "3", "6")
# Normals are those of the last commit: at rest what they lack falls by a factor of 1000 a step, and there are four such steps.
AT_REST = 1e-8
# Eight decades off the right one nothing is left of the gaps beside the multipliers, or the other way round: no answer is allowed.
FAR_OFF, NO_ANSWER = ("1e8", "1e-8"), r"too many iterations|not in equilibrium"
# The matrix may be about standard multipliers or normals of now, which points do not have.
LAW = ("-contact_basis", "dual", "-contact_normals", "committed", "-contact_decision", "points")


def blocks(cells=(3, 4), contrast=1.0, size=1.0, stress=1.0, upper=(0.0, 1.0)):
    """A block over another one, `contrast` times as stiff, the softer of them of the modulus YOUNG: a load of a hundredth of that is one that it
    carries. `size` and `stress`: units of length and of stress; `upper`: where the upper one is along x."""
    box = {"type": "box", "poisson": 0.3, "small_strain": True}
    sides = ["upper", "lower"]
    low, high = (v * size for v in upper)
    return {
        "schema": 1,
        "bodies": sides,
        "upper": {**box, "young": YOUNG * max(1, contrast) * stress, "lower": [low, 0, 0], "upper": [high, size, size],
                  "cells": [cells[0], cells[0], 2]},
        "lower": {**box, "young": YOUNG * max(1, 1 / contrast) * stress, "lower": [0, 0, -size], "upper": [size, size, 0], "cells": [cells[1], cells[1], 2]},
        "supports": ["floor", "left", "front"],
        "floor": {"surface": "lower.zmin", "components": ["z"]},
        "left": {"surface": [f"{side}.xmin" for side in sides], "components": ["x"]},
        "front": {"surface": [f"{side}.ymin" for side in sides], "components": ["y"]},
        "loads": ["press"],
        "press": {"surface": "upper.zmax", "pressure": PRESSURE * stress},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "law": "none", "weights": "reference"},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "last"},
    }


def uniform(scene, *options, pressure=PRESSURE, bound=UNIFORM):
    def run(context):
        run = context.solve(scene, *LAW, *options, kappa=True)
        outcome = host.outcome(run)
        if outcome.refusal is None:
            table = run.interface("contact")
            outcome.below("pressure, worst node", np.abs(table["p_lumped"] / pressure - 1).max(), bound, "uniform")
            outcome.below("multiplier, worst node", np.abs(table["lambda_n"] / -pressure - 1).max(), bound, "uniform")
            outcome.below("part that is open, worst node", np.abs(table["closed"] - 1).max(), UNIFORM, "pressed")
        return outcome

    return run


def contrast(text):
    return uniform(blocks(contrast=float(text)), bound=UNIFORM + OF_CONTRAST * max(float(text), 1 / float(text)))


def meshes(cells):
    return uniform(blocks(cells))


def told(text):
    """The modulus that the scene gives, over the right one: the patch test does not depend on it."""
    right = YOUNG / (1 - 0.3**2) / 2
    return uniform(blocks(), "-contact_modulus", float(text) * right)


def augmentation(text):
    right = YOUNG / (1 - 0.3**2) / 2
    return uniform(blocks(), "-contact_modulus", right, "-contact_augmentation", float(text) * 0.9 * right * 3)


def lengths(text):
    return uniform(blocks(size=float(text)))


def stresses(text):
    return uniform(blocks(stress=float(text)), pressure=PRESSURE * float(text))


def overhang(text):
    """The upper block hangs over the lower one's end by all but this part of its last facets: no node has to be carried, the multiplier
    stays with its neighbours'."""
    cover = float(text)

    def run(context):
        h = 0.25
        scene = blocks((4, 5), upper=(h * (1 - cover), 1 + h * (1 - cover)))
        scene["left"]["surface"] = "lower.xmin"
        scene["supports"].append("guide")
        scene["guide"] = {"surface": "upper.zmax", "components": ["x", "y", "z"], "value": [0, 0, -0.01]}
        del scene["loads"], scene["press"]
        scene["front"]["surface"] = "lower.ymin"
        run = context.solve(scene, *LAW, "-contact_weak_coverage", "-1", kappa=True)
        outcome = host.outcome(run)
        if outcome.refusal is None:
            table = run.interface("contact")
            force, floor = run.resultant("contact")[2], np.array(run.steps[-1]["reactions"]["floor"])[2]
            outcome.below("force against the floor's", abs(force - floor) / abs(floor), STATICS, "statics")
            inside = np.abs(table["lambda_n"][table["area_covered"] > 0.5 * table["area_full"]]).max()
            outcome.below("largest multiplier over that of nodes well covered", np.abs(table["lambda_n"]).max() / inside, 3,
                          "an average does not run away")
            outcome.true("no multiplier pulls", (table["p_lumped"] >= -1e-9 * inside).all(), "contact")
        return outcome

    return run


def now(cells=(3, 4), contrast=1.0):
    """The patch test with weights of now: without lateral strain, so that areas are those of the undeformed blocks."""
    scene = blocks(cells, contrast)
    scene["upper"]["poisson"] = scene["lower"]["poisson"] = 0.0
    return uniform(scene, *NOW, bound=UNIFORM + OF_CONTRAST * max(contrast, 1 / contrast))


def slides(text):
    """Pressed and drawn over so many facets of the base in one step, then at rest."""
    way = 0.25 * float(text)

    def placed(at, drawn):
        box = {"type": "box", "poisson": 0.3, "small_strain": True, "young": YOUNG}
        scene = blocks()
        scene["upper"] = {**box, "lower": [at, 0, 0], "upper": [at + 1, 1, 1], "cells": [3, 3, 2]}
        scene["lower"] = {**box, "lower": [-0.5, 0, -1], "upper": [3, 1, 0], "cells": [14, 4, 2]}
        scene["supports"] = ["floor", "top"]
        scene["floor"] = {"surface": "lower.zmin", "components": ["x", "y", "z"]}
        scene["top"] = {"surface": "upper.zmax", "components": ["x", "y", "z"], "value": [drawn, 0, -0.01], "curve": [0, 0, 1, 1]}
        scene["steps"] = {"count": 5, "end": 5}
        for unused in ("loads", "press", "left", "front"):
            del scene[unused]
        return scene

    def run(context):
        one, other = (context.solve(placed(*about), *LAW, *NOW, name=name)
                      for about, name in (((0, way), "drawn"), ((way, 0), "there")))
        outcome = host.outcome(one)
        if outcome.refusal is None:
            a, b = one.interface("contact"), other.interface("contact")
            largest = np.abs(b["lambda_n"]).max()
            outcome.below("multipliers", np.abs(a["lambda_n"] - b["lambda_n"]).max() / largest, AT_REST, "as of the one that was there")
            outcome.below("forces", np.abs(a["fz"] - b["fz"]).max() / np.abs(b["fz"]).max(), AT_REST, "as of the one that was there")
            floor = np.array(one.steps[-1]["reactions"]["floor"])[2]
            outcome.below("force against the floor's", abs(a["fz"].sum() / floor - 1), STATICS, "statics")
        return outcome

    return run


def tilted(text, *options):
    """The block is pressed with a moment: beyond a sixth of its width it lifts off on one side. Force and moment by statics."""
    share = float(text)

    def run(context):
        scene = blocks((6, 7))
        scene["front"]["surface"] = ["upper.ymin", "lower.ymin"]
        scene["left"]["surface"] = "lower.xmin"
        scene["supports"].append("top")
        # Lowered by 0.01 in the middle, turned so that one side rises by `share` of twice that.
        scene["top"] = {"surface": "upper.zmax", "components": ["x", "z"], "value": [0, 0, -0.01], "origin": [0.5, 0, 1],
                        "gradient": [0, 0, 0, 0, 0, 0, 0.04 * share, 0, 0]}
        del scene["loads"], scene["press"]
        run = context.solve(scene, *LAW, *options, kappa=True)
        outcome = host.outcome(run)
        if outcome.refusal is None:
            table = run.interface("contact")
            floor, moment = (np.array(run.steps[-1][what]["floor"]) for what in ("reactions", "moments"))
            outcome.below("force against the floor's", abs(table["fz"].sum() / floor[2] - 1), STATICS, "statics")
            x = table["X"] + table["ux"]
            scale = np.abs(table["fz"]).sum()
            outcome.true("no node pulls", (table["fz"] >= -1e-6 * scale).all(), "contact")
            outcome.figures["closed"] = float((table["closed"] * table["area_covered"]).sum() / table["area_covered"].sum())
            outcome.true("opens on one side" if share > 0.4 else "closed", (outcome.figures["closed"] < 0.999) == (share > 0.4),
                         "the force is within a third of the width")
            outcome.figures["arm"] = float((x * table["fz"]).sum() / scale)
        return outcome

    return run


def cells():
    yield from series("points, contrast of stiffness", CONTRASTS, contrast, quick=("1e2", "1e-4"))
    yield from series("points, meshes", [f"{a}:{b}" for a, b in MESHES], lambda t: meshes(tuple(map(int, t.split(":")))), quick=("2:20",))
    far_off = lambda text: NO_ANSWER if text in FAR_OFF else None
    yield from series("points, modulus told over the right one", SCALES, told, may_refuse=far_off, quick=("1e-2",))
    yield from series("points, r over its default", SCALES, augmentation, may_refuse=far_off, quick=("1e2",))
    yield from series("points, unit of length", UNITS, lengths, quick=("1e-3",))
    yield from series("points, unit of stress", UNITS, stresses, quick=("1e3",))
    yield from series("points, cover of the last facets", COVERS, overhang, quick=("1e-4",))
    yield from series("points, tilted", TILTS, tilted, quick=("0.9",))
    yield from series("points and weights of now, contrast of stiffness", CONTRASTS, lambda t: now(contrast=float(t)), quick=("1e-4",))
    yield from series("points and weights of now, meshes", [f"{a}:{b}" for a, b in MESHES], lambda t: now(tuple(map(int, t.split(":")))), quick=("2:20",))
    yield from series("points and weights of now, tilted", TILTS, lambda t: tilted(t, *NOW), quick=("0.9",))
    yield from series("points and weights of now, slide in a step over facets", SLIDES, slides, quick=("3",))
