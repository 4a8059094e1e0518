"""Bodies that touch in a point or line, or lie apart, closed by a force that nothing but contact opposes. Compared with the
same forces and the closing that they ended with prescribed: then nothing is free."""

import host
from cell import series
from touching import BALANCE, PINNED, SAME, differences
from touching_scenes import SHAPES, SIZE, facet, load, prescribed, stack, touching

GAPS = (0, 1e-3, 0.1, 1, 10, "size")  # in facets; the body's size
FRICTIONS = {"cylinder": 0.3, "ball": 0.3, "cube": 0.3}
FORCES = ("1", "1e-1", "1e-2", "1e-3", "1e-4", "1e-6")  # of the one that makes a contact of a tenth of the radius
# Of a light force the forces of rounding, eps E times an edge for each step, are so much more.
NOISE = 1e-14


def compared(context, scene, shape, force=1.0):
    run = context.solve(scene)
    result = host.outcome(run)
    if result.refusal is not None:
        return result
    reference = context.solve(prescribed(scene, run), name="prescribed")
    exact, reactions = force * load(shape), reference.steps[-1]["reactions"]
    found = run.steps[-1]["interfaces"]["contact"]["force"][2]
    noise = NOISE / force
    result.below("reaction", abs(found - exact) / exact, BALANCE + noise, "the load; rounding")
    pinned = max(abs(reactions[f"pin{probe}"][2]) for probe in scene["probes"]) / exact
    result.below("support of the closing", pinned, PINNED + noise, "it carries nothing; rounding")
    error, states = differences(run, reference, scene["interfaces"])
    result.below("multipliers", error, SAME + noise, "those of the closing prescribed")
    result.below("states", states, 0, "those of the closing prescribed")
    return result


def over_a_gap(shape, base):
    def with_gap(gap):
        facets = SIZE / facet(shape) if gap == "size" else gap
        return lambda context: compared(context, touching(shape, base, facets, FRICTIONS[shape]), shape)

    return with_gap


def pressed(force):
    def run(context):
        scene = touching("cylinder", gap=0.1, friction=0.3)
        scene["press"]["traction"] = [float(force) * value for value in scene["press"]["traction"]]
        return compared(context, scene, "cylinder", float(force))

    return run


def stacked(gap):
    facets = SIZE / facet("cylinder") if gap == "size" else gap
    return lambda context: compared(context, stack((0, facets), 0.3, shape="cylinder"), "cylinder")


def cells():
    for shape in SHAPES:
        for base in ("block", "plane"):
            name = {"block": "a block", "plane": "an analytic plane"}[base]
            quick = (0, "size") if (shape, base) == ("cylinder", "block") else ()
            yield from series(f"{shape} over {name}, gap in facets", GAPS, over_a_gap(shape, base), quick=quick)
    yield from series("slab between cylinder and floor, gap in facets", GAPS, stacked)
    yield from series("cylinder, ever lighter force", FORCES, pressed, quick=("1e-6",))
