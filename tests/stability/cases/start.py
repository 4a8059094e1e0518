"""How bodies are put on each other: deep in each other, apart, held by nothing else."""

import host
from cell import series
from scenes import changed, check_patch, patch, patch_error

FACET = 1 / 4  # the smaller ones
YOUNG, HEIGHT = 1000, 1.0
DEPTHS = (1e-6, 1e-3, 1e-2, 0.1, 0.3, 0.6, 0.99, 1.01)  # in facets
GAPS = (0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1, 10)  # in facets
EXACT = 1e-10  # a linear problem solved to 1e-11
PENETRATION = r"search_distance|penetrat|behind|deeper"


def clamped(lowered, **more):
    """The patch test's bricks, without Poisson effect, held at top and bottom, the upper one lowered by a distance."""
    scene = patch(poisson=0.0)
    scene["upper"] |= {"lower": [0, 0, 0.5 - lowered], "upper": [1, 1, 1 - lowered]}
    scene["supports"], scene["loads"] = ["bottom", "top"], []
    scene["bottom"] = {"surface": "lower.zmin", "components": ["x", "y", "z"]}
    scene["top"] = {"surface": "upper.zmax", "components": ["x", "y", "z"]}
    for name in ("corner1", "side1", "corner2", "side2", "press"):
        del scene[name]
    del scene["loads"]
    return changed(scene, **more)


def penetration(depth):
    def run(context):
        lowered = depth * FACET
        run = context.solve(clamped(lowered), kappa=True)
        pressure = YOUNG * lowered / HEIGHT
        return check_patch(run, (0, 0, -pressure), reason="two springs in a row; max(1e-10, 100 eps kappa)")

    return run


def deeper(depth):
    """The same, told how deep it is."""

    def run(context):
        lowered = depth * FACET
        run = context.solve(clamped(lowered, base={"search_distance": 2 * lowered}), kappa=True)
        return check_patch(run, (0, 0, -YOUNG * lowered / HEIGHT), reason="two springs in a row")

    return run


def lowered_by_support(gap):
    """A body over a gap, lowered through it by its support, in one step."""

    def run(context):
        down = gap * FACET + 0.01
        scene = clamped(
            -gap * FACET, top={"surface": "upper.zmax", "components": ["x", "y", "z"], "value": [0, 0, -down]}
        )
        return check_patch(
            context.solve(scene, kappa=True), (0, 0, -YOUNG * 0.01 / HEIGHT), reason="two springs in a row"
        )

    return run


def dropped(gap):
    """A body over a gap with a load and no support across it: nothing holds it until it lands, all of it at once."""

    def run(context):
        scene = patch(poisson=0.0)
        scene["upper"] |= {"lower": [0, 0, 0.5 + gap * FACET], "upper": [1, 1, 1 + gap * FACET]}
        for name in ("corner2", "side2"):
            scene[name]["point"][2] += gap * FACET
        return check_patch(context.solve(scene))

    return run


def cells():
    far = lambda depth: PENETRATION if depth > 1 else None
    yield from series("initial penetration, in facets", DEPTHS, penetration, quick=(1e-6, 0.99, 1.01), may_refuse=far)
    yield from series("the same with search_distance", (0.3, 0.6, 0.99, 1.2, 1.5, 1.9), deeper)
    yield from series("gap closed by a support, in facets", GAPS, lowered_by_support, quick=(1e-9, 10))
    yield from series("gap closed by a load, in facets", GAPS, dropped, quick=(1e-9, 10))
