"""A block drawn over a floor whose nodes carry the multipliers, over facets that become covered as it comes: all of it slips, and what is
drawn at is mu times what presses, whatever part of the facets under it a step newly covers."""

import host
from cell import series

MU, FACET, TRAVEL = 0.3, 0.2, 1.2
# Facets a step. Beyond what the neighbours of newly covered nodes reach steps are cut back.
FACETS = ("0.25", "0.5", "1", "2", "3", "6")
# Normals are those of the step's start: a facet that the block comes to has not been dented then. Measured 1 % at one facet a step, 1.7 % at
# two, 2.3 % at three; normals of now have 0.4 %.
OFF = 0.025


def scene(facets, basis):
    box = {"type": "box", "young": 1000, "poisson": 0.3, "small_strain": True}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["block", "floor"],
        "block": {**box, "lower": [0, 0], "upper": [1, 0.2], "cells": [5, 2]},
        "floor": {**box, "lower": [-0.5, -0.4], "upper": [4.1, 0], "cells": [23, 2]},
        "supports": ["ground", "draw", "press"],
        "ground": {"surface": "floor.ymin", "components": ["x", "y"]},
        "draw": {"surface": "block.ymax", "components": ["x"], "value": [TRAVEL, 0], "curve": [1, 0, 2, 1]},
        "press": {"surface": "block.ymax", "components": ["y"], "value": [0, -0.005], "curve": [0, 0, 1, 1]},
        "interfaces": ["contact"],
        "contact": {"friction": MU, "nonmortar": "floor.ymax", "mortar": "block.ymin", "basis": basis},
        "steps": {"stages": [1, 2, 2, round(TRAVEL / (facets * FACET))]},
        "output": {"vtu": "none", "csv": "last"},
    }


def slides(basis):
    def case(text):
        def run(context):
            run = context.solve(scene(float(text), basis))
            result = host.outcome(run)
            if result.refusal is None:
                off = 0.0
                for step in run.steps[3:]:  # the first one on the way from stick to slip may not slip everywhere
                    along, across = step["reactions"]["ground"][:2]
                    off = max(off, abs(abs(along / across) / MU - 1))
                result.below("T / (mu N), worst step", off, OFF, "Coulomb, all of it slips")
            return result

        return run

    return case


def cells():
    yield from series("newly covered facets a step, standard", FACETS, slides("standard"), quick=("2",))
    yield from series("newly covered facets a step, dual", FACETS, slides("dual"), quick=("2",))
