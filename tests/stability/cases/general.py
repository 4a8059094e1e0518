"""General contact: plates over each other, of which no pair is named, pressed evenly: the force is that of one column, whatever the reach, the
way within a step, the number of plates and their meshes."""

import host
from cell import series

# The pressure is even on any mesh: what is left is Newton's tolerance.
EVEN = 1e-9
YOUNG, POISSON, HEIGHT = 1000.0, 0.3, 1.0
# A quarter of a facet of 0.2: an overlap of less than a twentieth would be noticed at the start of the step that follows only.
PRESS = 0.05
REACH = 0.05
DROPS = (1, 2, 6, 20, 60)  # the gap over the reach
REACHES = (0.1, 0.5, 2, 8, 32)  # over a plate
PLATES = (2, 3, 5, 9, 17)
RATIOS = (1, 2, 5, 11, 23)  # of facets on either side
SOFTER = (1, 10, 1e3, 1e5, 1e7)  # how much softer every other plate is; none widens, for it would hang over


def column(plates=2, cells=(5, 4), gap=0.0, reach=None, softer=1.0, poisson=POISSON):
    """Plates of 1 x HEIGHT / plates over each other, the upper one a gap away, pressed by PRESS beyond it; and the force. Every other one has
    the second number of cells, and is softer."""
    thick = HEIGHT / plates
    bodies, compliance = {}, 0.0
    for k in range(plates):
        low = k * thick + (gap if k == plates - 1 else 0)
        young = YOUNG / (softer if k % 2 else 1)
        compliance += thick * (1 - poisson**2) / young
        bodies[f"plate{k}"] = {"type": "box", "lower": [0, low], "upper": [1, low + thick], "cells": [cells[k % 2], max(1, round(4 / plates))],
                               "young": young, "poisson": poisson, "small_strain": True}
    names = list(bodies)
    scene = {
        "schema": 1,
        "model": "plane_strain",
        "bodies": names,
        **bodies,
        "supports": ["ground", "press", "middle"],
        "ground": {"surface": "plate0.ymin", "components": ["y"]},
        "press": {"surface": f"{names[-1]}.ymax", "components": ["y"], "value": [0, -PRESS - gap]},
        "middle": {"surface": [f"{name}.xmin" for name in names], "components": ["x"]},
        "contact": "all",
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "none"},
    }
    if reach:
        scene["all"] = {"search_distance": reach}
    return scene, PRESS / compliance


def pressed(**how):
    def run(context):
        scene, force = column(**how)
        found = context.solve(scene)
        result = host.outcome(found)
        if result.refusal is None:
            carried = found.steps[-1]["reactions"]["ground"][1]
            result.below("reaction", abs(carried / force - 1), EVEN, "that of a column")
            touching = [one for one in found.summary["general_contact"]["touching"] if one["slip"] + one["stick"]]
            result.true("who touches whom", len(touching) == len(scene["bodies"]) - 1, "neighbours, and nobody else")
        return result

    return run


def cells():
    yield from series("general: gap closed in a step / reach", DROPS, lambda n: pressed(gap=n * REACH, reach=REACH), quick=(6,))
    yield from series("general: reach / plate", REACHES, lambda n: pressed(plates=4, reach=n * HEIGHT / 4), quick=(8,))
    yield from series("general: plates", PLATES, lambda n: pressed(plates=n), quick=(5,))
    yield from series("general: facets of one side / other's", RATIOS, lambda n: pressed(cells=(4, 4 * n)), quick=(5,))
    yield from series("general: stiffness of one side / other's", SOFTER, lambda n: pressed(plates=3, softer=n, poisson=0.0), quick=(1e3,))
