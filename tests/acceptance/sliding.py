"""Checks of frozen weights where surfaces slide or turn: steps of `weights: committed` that slide too far are cut back, `weights: reference`
warns, and neither is converged and wrong without a word (contact/slide.c)."""

import math

import numpy as np

from scene import write

# A block that is drawn along a plate by 1.5, over 13 of its facets, in four steps.
STEPS, TRAVEL = 4, 1.5
# Of the force that presses it, against weights of now: half a facet a step leaves 0.4 per cent, steps of three facets are 7 to 12
# per cent off.
FOLLOWED, LOST = 0.01, 0.05
# No limit, in sizes of facets.
ANY = 1000
QUIET = ("-output_csv", "none", "-output_vtu", "none")
# Turns of two pressed blocks as one, in radians: none told, told, and told to be meant.
TURNS = ((0.02, {}, 0), (0.25, {}, 1), (0.25, {"friction": 0}, 1), (0.25, {"turn_max": 0.3}, 0), (0.25, {"weights": "current"}, 0), (0.25, {"law": "tied"}, 0))
# What is measured is the turn of the node that is most so, which pressure and friction tilt a little; in radians.
TURNED_BOUND = 0.005
SAYS_TURNED = "Weights of the reference know no turn"
SAYS_CUT, SAYS_REFERENCE = "good for 0.5 times", "Weights of the reference know no sliding"
SAYS_OVERLAP = "Frozen weights do not know where the surfaces are"


def drawn(**contact):
    box = {"type": "box", "young": 1000, "poisson": 0.3, "small_strain": True}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["block", "plate"],
        "block": box | {"lower": [0, 0], "upper": [1, 0.5], "cells": [8, 4]},
        "plate": box | {"lower": [-1, -1], "upper": [3, 0], "cells": [25, 5]},
        "supports": ["ground", "grip"],
        "ground": {"surface": "plate.ymin", "components": ["x", "y"]},
        "grip": {"surface": "block.ymax", "components": ["x", "y"], "value": [TRAVEL, -0.01], "curve": [0, 0, 1, 1]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "block.ymin", "mortar": "plate.ymax", "basis": "dual"} | contact,
        "steps": {"count": STEPS},
    }


def turned(angle, **contact):
    box = {"type": "box", "young": 1000, "poisson": 0, "material": "neo_hooke"}
    held = {"components": ["x", "y", "z"], "rotate": [0, angle, 0]}
    return {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": box | {"lower": [0.2, 0.2, 0.5], "upper": [0.8, 0.8, 1], "cells": [3, 3, 1]},
        "lower": box | {"lower": [0, 0, 0], "upper": [1, 1, 0.5], "cells": [4, 4, 1]},
        "supports": ["bottom", "top"],
        "bottom": {"surface": "lower.zmin", **held},
        "top": {"surface": "upper.zmax", **held, "value": [0, 0, -0.01]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "friction": 0.3, "weights": "reference"} | contact,
        "steps": {"count": 3},
    }


def turning(verdicts, driver):
    """Two blocks are pressed on each other and turned as one: with weights of the reference the force keeps the direction that it had."""
    for angle, options, warns in TURNS:
        label = "_".join(["turned", str(angle), *map(str, options.values())])
        if options.get("law") == "tied":
            options = {**options, "friction": 0}
        run = driver.run(write(turned(angle, **options), driver.output / f"{label}.yaml"), *QUIET, label=label)
        said, found = run.text.count(SAYS_TURNED), run.steps[-1]["interfaces"]["contact"].get("turned")
        verdicts.true(f"{label.replace('_', ' ')}: {said} warnings", said == warns, "once, or not at all")
        if options.get("weights") == "current":
            verdicts.true(f"{label.replace('_', ' ')}: not measured", found is None, "weights of now turn with the surfaces")
        elif options.get("law") != "tied":
            verdicts.below(f"{label.replace('_', ' ')}: turn", abs(found - angle), TURNED_BOUND, "as the supports turn them")
        if options == {"friction": 0}:
            force = np.array(run.steps[-1]["interfaces"]["contact"]["force"])
            off = abs(math.atan2(force[0], force[2]) - angle)
            verdicts.at_least(f"{label.replace('_', ' ')}: force off by", off, 0.9 * angle, "what the warning is about: it acts along the first normals")


def sliding(verdicts, driver):
    turning(verdicts, driver)

    def run(label, **contact):
        return driver.run(write(drawn(**contact), driver.output / f"{label}.yaml"), *QUIET, label=label)

    def off(result):
        return abs(result.steps[-1]["reactions"]["ground"][1] / exact - 1)

    exact = run("current", weights="current").steps[-1]["reactions"]["ground"][1]
    for decision in ("nodes", "points"):
        frozen = {"weights": "committed", "decision": decision}
        result = run(decision, **frozen)
        said = [attempt for attempt in result.summary["failed_attempts"] if SAYS_CUT in attempt["why"]]
        verdicts.true(f"decision at {decision}: {len(said)} steps cut for their slide", len(said) > 0, "not converged and wrong")
        verdicts.below(f"decision at {decision}: force, steps cut", off(result), FOLLOWED, f"{len(result.steps)} steps")
        result = run(f"{decision}_any", **frozen, slide_max=ANY, lag_max=ANY)
        if decision == "nodes":
            verdicts.at_least(f"decision at {decision}: force, slides of any length", off(result), LOST, f"slide_max: {ANY}, as asked")
        else:
            verdicts.true(f"decision at {decision}: overlaps are told", SAYS_OVERLAP in result.text, f"slide_max: {ANY}, as asked")
    for label, options, warns in (("reference", {}, 1), ("reference_meant", {"slide_max": ANY}, 0)):
        text = run(label, weights="reference", **options).text
        said = text.count(SAYS_REFERENCE)
        verdicts.true(f"{label.replace('_', ', ')}: {said} warnings", said == warns, "once, or not where it is meant")
        verdicts.true(f"{label.replace('_', ', ')}: overlaps are told", SAYS_OVERLAP in text, "a tenth of the approach")
