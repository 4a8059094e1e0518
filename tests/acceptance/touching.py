"""Checks of bodies that touch in a point or line, or not yet, closed by force: cylinder, ball, cube on its corner.

What the aid of closing.c ends with must be the answer of the problem as it is. So the closing that the run found is
prescribed, step by step, at one point under the same forces: nothing is free then, no aid is used, the support must
carry nothing, and multipliers and states must be the same. That comparison starts from the same gap: with friction,
what nodes move along the surface while the gap closes counts as slip in both."""

import re

import numpy as np

from comparisons import multiplier
from scene import write
from touching_scenes import SHAPES, SIZE, facet, load, prescribed, stack, touching

# Newton's method works to 1e-13 of the forces. Multipliers are those over nodal areas, and what a gap of G leaves of
# the digits of positions is eps G / penetration: 1e-11 at the body's size.
SAME = 1e-8
# Reaction against load: sums of nodal forces.
BALANCE = 1e-11
# In facets; the last one is the body's size.
GAPS = (0, 1e-3, 0.1, 1, 10, "size")
# Of what the supports carry instead of the loads, over the force.
PINNED = 1e-8
# Iterations for a body that is pulled away, all eleven attempts with ever shorter steps together: three or four each. Those
# that are tried without a word of it take 25 and more.
FAILING = 5 * 11
# Friction that holds, and one that lets some nodes slip.
FRICTIONS = (0.0, 0.3)
# Of the ring of shrunk_on(), over its height and an angle of 1: four cells through its wall.
SHRUNK = 0.4955
OTHERS = ({"form": "augmented"}, {"row_scale": "none"}, {"weak_coverage": 0.5})


def touching_quick(verdicts, driver):
    for shape in SHAPES:
        closed(verdicts, driver, shape, "block", 0, FRICTIONS[-1])
        closed(verdicts, driver, shape, "plane", 0, FRICTIONS[0])
        closed(verdicts, driver, shape, "block", "size", FRICTIONS[0])
    for number, keys in enumerate(OTHERS):
        closed(verdicts, driver, "cylinder", "block", 1, FRICTIONS[-1], keys, note=f"_{number}")
    closed(verdicts, driver, "ball", "block", 1, FRICTIONS[-1], ranks=2, note="_ranks2")
    stacked(verdicts, driver, (0, 0.5), FRICTIONS[-1], "cylinder")
    stacked(verdicts, driver, (1, 0), FRICTIONS[-1], "cylinder", tied=True)
    switched_off(verdicts, driver)
    pulled_away(verdicts, driver)
    compressed_start(verdicts, driver)


def touching_full(verdicts, driver):
    """Every shape, base, friction and gap; stacks with gaps of both kinds."""
    for shape in SHAPES:
        for base in ("block", "plane"):
            for friction in FRICTIONS:
                for gap in GAPS:
                    closed(verdicts, driver, shape, base, gap, friction)
                for number, keys in enumerate(OTHERS):
                    closed(verdicts, driver, shape, base, 0.1, friction, keys, note=f"_{number}")
    for gaps in ((0, 0), (0, 0.5), (0.5, 0), (0.5, 0.5), (10, 1)):
        for shape in ("cylinder", "ball"):
            for friction in FRICTIONS:
                stacked(verdicts, driver, gaps, friction, shape)


def scaled(gap, shape):
    return SIZE / facet(shape) if gap == "size" else gap


def solve(driver, scene, label, *options, **more):
    return driver.run(write(scene, driver.output / "scenes" / f"{label}.yaml"), *options, label=label, **more)


def closed(verdicts, driver, shape, base, gap, friction, contact=None, ranks=1, note=""):
    """By force, then by the closing that this ended with. Which of its sides a cube's corner will touch with is not known a body's size
    away, where they have nothing opposite: dual multipliers of all three then have one condition for a step."""
    if (shape, gap) == ("cube", "size"):
        contact = {"basis": "standard"} | (contact or {})
    label = f"{shape}_{base}_{gap}_{friction}{note}"
    compared(verdicts, driver, label, touching(shape, base, scaled(gap, shape), friction, contact=contact), shape, ranks)


def stacked(verdicts, driver, gaps, friction, shape, tied=False):
    label = f"stack_{shape}_{gaps[0]}_{gaps[1]}_{friction}" + ("_tied" if tied else "")
    compared(verdicts, driver, label, stack(gaps, friction, tied, shape), shape)


def compared(verdicts, driver, label, scene, shape, ranks=1):
    run = solve(driver, scene, label, ranks=ranks)
    reference = solve(driver, prescribed(scene, run), f"{label}_prescribed", ranks=ranks)
    force = run.steps[-1]["interfaces"]["contact"]["force"][2]
    verdicts.near(f"{label}: reaction", force, load(shape), BALANCE, "the load, which nothing else carries")
    reactions = reference.steps[-1]["reactions"]
    pinned = max(abs(reactions[f"pin{probe}"][2]) for probe in scene["probes"]) / load(shape)
    verdicts.below(f"{label}: support of the closing", pinned, PINNED, "it carries nothing")
    error, states = differences(run, reference, scene["interfaces"])
    verdicts.below(f"{label}: multipliers", error, SAME, "those of the closing prescribed, in every step")
    verdicts.below(f"{label}: states", states, 0, "nodes that differ from it, in all steps")


def differences(run, reference, interfaces):
    """(largest of the multipliers over the largest of them, nodes in another state), over all steps."""
    error, states = 0.0, 0
    for name in interfaces:
        for k in range(1, len(reference.steps) + 1):
            one, two = run.interface(name, k), reference.interface(name, k)
            exact = multiplier(two)
            error = max(error, np.abs(multiplier(one) - exact).max() / np.abs(exact).max())
            states += int(np.sum(one["state"] != two["state"]))
    return error, states


def shrunk_on():
    """A ring that is shrunk onto a rod and stands on a floor, which its own strain lifts it from."""
    rigid = {"type": "rigid", "from": "box", "reference": [0, 0]}
    ring = {"type": "box", "lower": [5, 0], "upper": [7, 2], "cells": [4, 4], "young": 7, "poisson": 0.48}
    return {
        "schema": 1,
        "model": "axisymmetric",
        "bodies": ["ring", "rod", "floor"],
        "ring": ring | {"material": "neo_hooke", "dilatation": "mean"},
        "rod": rigid | {"lower": [4, -2], "upper": [5.02, 6], "cells": [2, 8]},
        "floor": rigid | {"lower": [4.5, -1], "upper": [9, 0], "cells": [4, 1]},
        "supports": ["hold", "base"],
        "hold": {"body": "rod", "components": ["y"]},
        "base": {"body": "floor", "components": ["y"]},
        "interfaces": ["side", "foot"],
        "side": {"nonmortar": "ring.xmin", "mortar": "rod.xmax", "friction": 0.2},
        "foot": {"nonmortar": "ring.ymin", "mortar": "floor.ymax", "friction": 0.2},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "last"},
    }


def compressed_start(verdicts, driver):
    """Nodes that touch start slightly compressed. Where that leads nowhere, a first step starts without."""
    forces = []
    for word in ("true", "false"):
        run = solve(driver, shrunk_on(), f"shrunk_{word}", "-foot_initial_contact", word, "-side_initial_contact", word)
        forces.append(run.steps[-1]["interfaces"]["side"]["force"][0])
        verdicts.below(f"ring shrunk onto a rod, compressed {word}: cut-backs", run.summary["cutbacks"], 0, "none")
    verdicts.near("ring shrunk onto a rod: force", forces[0], forces[1], SAME, "as without compression at the start")
    verdicts.near("ring shrunk onto a rod: force", forces[1], SHRUNK, 1e-3, "of a ring of thick wall, as meshed")


def switched_off(verdicts, driver):
    """Where the run converges without the aid, too, it ends there with the same."""
    scene = touching("ball", "plane", -0.4, FRICTIONS[-1])  # overlaps slightly
    runs = [solve(driver, scene, f"overlap_{word}", "-steps_closing", word) for word in ("true", "false")]
    error, states = differences(*runs, scene["interfaces"])
    verdicts.below("slight overlap: multipliers without the aid", error, SAME, "the same with it")
    verdicts.below("slight overlap: states without the aid", states, 0, "nodes that differ")


def pulled_away(verdicts, driver):
    for shape in SHAPES:
        for base in ("block", "plane"):
            scene = touching(shape, base, 0.1, times=[1.0], down=-1)
            run = solve(driver, scene, f"{shape}_{base}_away", expect=2)
            told = re.search(r"nothing touches upper: the loads move it along \((\S+), (\S+), (\S+)\)", run.text)
            along = [float(value) for value in told.groups()] if told else [0, 0, 0]
            verdicts.near(f"{shape} from {base}: moves along z", along[2], 1, 1e-3, "three digits are told")
            failed = run.summary["failed_attempts"]
            spent = sum(attempt["newton_iterations"] for attempt in failed)
            verdicts.below(f"{shape} from {base}: iterations", spent, FAILING, "nothing is tried that cannot help")
