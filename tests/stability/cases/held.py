"""Bodies that nothing holds but contact and friction."""

import numpy as np

import host
from cell import series
from comparisons import multiplier
from scenes import check_patch, patch, patch_bound, patch_cell

SLOPE = 0.4  # tangent of the scene `incline`
MARGINS = ("1e-1", "1e-2", "1e-3", "1e-4", "1e-6", "1e-8")
EXCESS = ("1e-1", "1e-2", "1e-3", "1e-4", "1e-5", "1e-6")
SHARES = ("0.5", "0.9", "0.99", "0.999", "0.9999", "0.999999")
FRICTIONS = ("1", "1e-3", "1e-6", "1e-9", "1e-12", "0")
FEW_CUTBACKS = ("-steps_smallest", "0.25")  # shorter steps cannot help
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
        return check_patch(solved, (2.5, 0, -10))

    return run


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
