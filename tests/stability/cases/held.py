"""Bodies that nothing holds but contact and friction."""

import numpy as np

import host
from cell import series
from comparisons import multiplier
from library import normals_in_question
from scenes import check_patch, patch, patch_bound, patch_cell

SLOPE = 0.4  # tangent of the scene `incline`
MARGINS = ("1e-1", "1e-2", "1e-3", "1e-4", "1e-6", "1e-8")
EXCESS = ("1e-1", "1e-2", "1e-3", "1e-4", "1e-5", "1e-6")
SHARES = ("0.5", "0.9", "0.99", "0.999", "0.9999", "0.999999")
FRICTIONS = ("1", "1e-3", "1e-6", "1e-9", "1e-12", "0")
FEW_CUTBACKS = ("-steps_smallest", "0.25")  # shorter steps cannot help
# Normals of now allow a second answer next to the limit: all nodes slip until the surface has tilted by what friction lacks.
# How well that tilt, of 2e-7, is met; and from which share of the limit on a tilt that small is there.
TILT, NEAR = 1e-2, 0.99999
# what supports do not hold; how many nodes touch, stick and slip is said beside it
FREE = r"is free to move along .*: only contact can hold that"


def slope(margin):
    """A block on a slope, its friction above (or, negative, below) what holds it by this part."""

    def run(context):
        options = ("-base_friction", repr(SLOPE * (1 + float(margin))), *FEW_CUTBACKS)
        run = context.solve("incline", *options, kappa=True)
        result = host.outcome(run)
        if result.refusal is None:
            exact = np.array([0, 0, -10 * np.cos(np.arctan(SLOPE))])
            error = np.linalg.norm(multiplier(run.interface("base")) - exact, axis=1).max() / np.linalg.norm(exact)
            bound = patch_bound(run)
            result.below("multiplier", error, bound, "uniform and exact; max(1e-10, 100 eps kappa)")
            result.figures |= {"patch_error": error, "patch_bound": bound}
        return result

    return run


def sheared(share):
    """A brick held by stick alone, under this share of the shear that friction could carry."""

    def run(context):
        scene = "patch_shear"
        solved = context.solve(scene, "-base_friction", repr(0.25 / float(share)), kappa=True)
        if normals_in_question() == "current" and float(share) > NEAR and all_slip(solved):
            return check_tilt(solved, float(share))
        return check_patch(solved, (2.5, 0, -10))

    return run


def all_slip(run):
    return run.exit_code == host.CONVERGED and (run.interface("base")["state"] == "slip").all()


def check_tilt(run, share):
    """Shear and pressure are 0.25 to 1: friction carries 0.25 / share against a surface that has tilted by the rest."""
    result, table = host.outcome(run), run.interface("base")
    pressed = np.abs(table["fz"])
    tilt = (table["nx"] * pressed).sum() / pressed.sum()
    error = abs(tilt / (np.arctan(0.25 / share) - np.arctan(0.25)) - 1)
    result.below("tilt of the surface, weighted with the pressure", error, TILT, "what friction lacks")
    result.warnings.append("slid to a second answer, all nodes slip")
    return result


def loose(friction):
    """A brick under pressure that friction alone keeps where it is, although nothing draws at it."""
    scene = patch(poisson=0.0, friction=float(friction))
    for name in ("corner2", "side2"):
        del scene[name]
    scene["supports"] = ["bottom"]
    scene["bottom"] = {"body": "lower", "components": ["x", "y", "z"]}
    for name in ("corner1", "side1"):
        del scene[name]
    scene["lower"] |= {"lower": [-1, -1, 0], "upper": [2, 2, 0.5]}  # wherever it drifts, it lies flat on it
    return patch_cell(scene)


def cells():
    yield from series("slope, friction in excess of need", MARGINS, slope, quick=("1e-2", "1e-8"))
    steep = lambda text: slope(f"-{text}")
    yield from series("slope too steep by this part", EXCESS[::-1], steep, quick=("1e-2",), may_refuse=FREE)
    yield from series("held by stick, share of its limit", SHARES, sheared, quick=("0.5", "0.999999"))
    free = lambda text: FREE if float(text) == 0 else None
    yield from series("held by friction of this much", FRICTIONS, loose, quick=("1", "1e-12", "0"), may_refuse=free)
