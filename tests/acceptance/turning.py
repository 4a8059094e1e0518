"""A stuck curved interface carried through a finite rotation: a shaft in a hub that turns by 2 rad. Nothing but the
rotation happens, so whatever the shaft's surface moves against it is drift.

With normals of the step's start (`normals: committed`), which turn against the bodies, that is an error of the order of the angle of
one step, there while the hub turns and gone when it rests. What is left then is what adds up. With normals of now there is none: the
group `normals`.
"""

import numpy as np

from scene import write

COMMITTED = ("-contact_normals", "committed")
ANGLE = 2.0  # of the scene
FACET = 2 * np.pi * 5.05 / 24

# While turning, over the facet size: proportional to the angle of a step, 7.5e-6 at 2 / 50.
DRIFT_BOUND = 1e-5
# At rest again: 3.8e-9 after 50 steps, 2.4e-10 after 200: a quarter with halved steps, so a half at most is asked for.
REST_BOUND, SPLIT_BOUND = 1e-8, 0.5
# Slip that the library accumulates in stick is that of rounding.
SLIP_BOUND = 1e-12
# What the measure of slip as printed in the paper does at least, in 100 steps a turn: 2 % of a facet is measured.
PAPER_DRIFT = 0.01
# The moment of friction of a plate that spins: 0.8 % are the mesh's, 0.5 % the chord's in steps of 11 degrees.
MOMENT_BOUND = 0.02
# Torque of friction in a bore: 0.2 % are left of the normals, 1 % is what polygons make as they pass each other.
TORQUE_BOUND = 0.02
# A step ends at 1e-10 of the forces.
RANKS_BOUND = 1e-8
# The mean distance from the middle of a square, over its side.
MEAN_DISTANCE = (np.sqrt(2) + np.log(1 + np.sqrt(2))) / 6


def turning(verdicts, driver):
    rest = {}
    for n in (50, 100, 200):
        run = driver.run("turned_shaft", *steps(n), *COMMITTED, label=f"objective_{n}")
        label = f"turned by 2 rad in {n} steps"
        verdicts.below(f"{label}: cut-backs", run.summary["cutbacks"], 0, "smooth motion")
        away = sum(step["interfaces"]["contact"][s] for step in run.steps for s in ("gap", "slip"))
        verdicts.below(f"{label}: nodes that do not stick", away, 0, "in any step")
        bound = DRIFT_BOUND * 50 / n
        verdicts.below(f"{label}: drift, over a facet", drift(run, n, 2 * n), bound, "as a step's angle")
        rest[n] = drift(run, n, len(run.steps))
        verdicts.below(f"{label}: drift at rest", rest[n], REST_BOUND, "what adds up")
        slip = [np.abs(table_of(run, k)["slip_x"]).max() for k in (n, len(run.steps))]
        verdicts.below(f"{label}: slip, over a facet", abs(slip[1] - slip[0]) / FACET, SLIP_BOUND, "stuck")
    for few, many in ((50, 100), (100, 200)):
        verdicts.below(f"drift at rest, {many} steps over {few}", rest[many] / rest[few], SPLIT_BOUND, "does not grow")

    paper = {n: driver.run("turned_shaft", *steps(n), "-contact_slip", "paper", label=f"paper_{n}") for n in (50, 100)}
    ends = {n: drift(run, 1, len(run.steps)) for n, run in paper.items()}  # it drifts while nothing turns, too
    verdicts.at_least("slip as printed in the paper, 100 steps: drift", ends[100], PAPER_DRIFT, "it does drift")
    verdicts.at_least("slip as printed in the paper: drift, 100 steps over 50", ends[100] / ends[50], 1.2, "and grows")
    corrected(verdicts, driver)
    spinning(verdicts, driver)
    let_go(verdicts, driver)


def in_a_bore(degrees, whole=40, **contact):
    """An oversized shaft is turned in its bore by so much a step, from the first one on slipping; in the end by the whole."""
    body = {"type": "box", "polar": True, "young": 1000, "poisson": 0.3, "material": "neo_hooke"}
    turn = {"rotate": float(np.radians(whole)), "rotate_curve": [1, 0, 2, 1]}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["shaft", "hub"],
        "shaft": body | {"lower": [1, 0], "upper": [5.05, 360], "cells": [4, 24]},
        "hub": body | {"lower": [4.95, 0], "upper": [10, 360], "cells": [4, 31]},
        "supports": ["hold", "turn"],
        "hold": {"surface": "hub.xmax", "components": ["x", "y"]},
        "turn": {"surface": "shaft.xmin", "components": ["x", "y"]} | turn,
        "interfaces": ["contact"],
        "contact": {"nonmortar": "shaft.xmax", "mortar": "hub.xmin", "friction": 0.3, **contact},
        "steps": {"stages": [1, 5, 2, round(whole / degrees)]},
        "output": {"vtu": "none", "csv": "none"},
    }


def corrected(verdicts, driver):
    """Steps that turn a surface by ten degrees with normals of the step's start are solved again with those that they reach."""
    solve = lambda degrees, label, *options, **more: driver.run(
        write(in_a_bore(degrees, basis="standard", normals="committed"), driver.output / "scenes" / f"bore_{label}.yaml"), *options, label=f"bore_{label}", **more)
    torques = lambda run: np.array([step["moments"]["turn"][2] for step in run.steps if step["t"] > 1])
    long, short = solve(10, "long"), torques(solve(1.25, "short"))[-1]
    verdicts.below("a shaft turned by 10 degrees a step: cut-backs", long.summary["cutbacks"], 0, "normals are found anew instead")
    for k, torque in enumerate(torques(long)):
        verdicts.near(f"a shaft turned by 10 degrees, step {k + 1}: torque", torque, short, TORQUE_BOUND, "that of steps of 1.25 degrees")
    two = solve(10, "ranks", ranks=2)
    verdicts.near("a shaft turned by 10 degrees: torque, two ranks", torques(two)[-1], torques(long)[-1], RANKS_BOUND, "one")
    without = solve(10, "without", "-contact_lag_corrected", "false")
    verdicts.at_least("a shaft turned by 10 degrees, not corrected: cut-backs", without.summary["cutbacks"], 5, "else nothing is tested")


def spinning(verdicts, driver):
    """A rigid plate is pressed on a layer and spins on it by 3.1 rad in one step, where slip is a chord of next to nothing: the step is cut
    until the moment is that of friction."""
    side, force, friction = 1.0, 20.0, 0.2
    scene = {
        "schema": 1,
        "bodies": ["top", "layer"],
        "top": {"type": "rigid", "from": "box", "lower": [-0.231, -0.217, 0.5], "upper": [1.2, 1.2, 0.8], "cells": [2, 3, 1],
                "reference": [0.5, 0.5, 0.9]},
        "layer": {"type": "box", "young": 1e5, "poisson": 0.3, "small_strain": True, "lower": [0, 0, 0], "upper": [side, side, 0.5],
                  "cells": [4, 4, 2]},
        "supports": ["base", "spin"],
        "base": {"surface": "layer.zmin", "components": ["x", "y", "z"]},
        "spin": {"body": "top", "components": ["x", "y", "rx", "ry", "rz"], "rotate": [0, 0, 3.1], "curve": [1, 0, 2, 1]},
        "loads": ["press"],
        "press": {"body": "top", "force": [0, 0, -force], "curve": [0, 0, 1, 1]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "layer.zmax", "mortar": "top.zmin", "friction": friction},
        "steps": {"stages": [1, 1, 2, 1]},
        "output": {"vtu": "none", "quiet": True},
    }
    run = driver.run(write(scene, driver.output / "spinning.yaml"), label="spinning")
    verdicts.at_least("a spin by 3.1 rad in one step: cut-backs", run.summary["cutbacks"], 1, "slip is a chord")
    moment = run.steps[-1]["rigid"]["top"]["contact_moment"][2]
    verdicts.near("the moment of friction at its end", abs(moment), friction * force * MEAN_DISTANCE * side, MOMENT_BOUND, "mu N r")


def let_go(verdicts, driver):
    """A rigid plate on two bodies, whose force and moment fall at last: the moment is below what friction holds, and the plate stays. In one
    step it ended 1.8 rad away, where friction along the chord of that way gives the same moment."""
    scene = {
        "schema": 1,
        "bodies": ["upper", "lower", "plate"],
        "upper": {"type": "box", "young": 1000, "poisson": 0.3, "material": "neo_hooke", "lower": [0.03, 0.02, 0], "upper": [1, 0.8, 0.5],
                  "cells": [3, 3, 2]},
        "lower": {"type": "box", "young": 3000, "poisson": 0.3, "material": "neo_hooke", "lower": [-0.5, -0.53, -1], "upper": [1.5, 1.5, 0],
                  "cells": [5, 6, 2]},
        "plate": {"type": "rigid", "from": "box", "lower": [-0.13, -0.17, 0.5], "upper": [1.1, 1.0, 0.7], "cells": [2, 3, 1],
                  "reference": [0.5, 0.4, 0.6]},
        "supports": ["base"],
        "base": {"surface": "lower.zmin", "components": ["x", "y", "z"]},
        "loads": ["press"],
        "press": {"body": "plate", "force": [0, 0, -10], "moment": [0, 0, 0.792], "curve": [0, 0, 1, 1, 2, -0.5]},
        "interfaces": ["below", "above"],
        "below": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "friction": 0.8},
        "above": {"nonmortar": "upper.zmax", "mortar": "plate.zmin", "law": "tresca", "friction": 0.4, "shear_limit": 4.102564102564102},
        "steps": {"times": [0.5, 1, 1.5, 1.625]},
        "output": {"vtu": "none", "quiet": True},
    }
    run = driver.run(write(scene, driver.output / "let_go.yaml"), label="let_go")
    most = max(abs(step["rigid"]["plate"]["rotation"][2]) for step in run.steps)
    verdicts.below("a plate whose moment falls below friction's: its largest turn", most, 0.02, "0.015, under the whole load")


def steps(n):
    """n steps of one in t: the press fit comes to rest until t = 1, turns until t = 2, rests until t = 2.2."""
    return "-steps_count", round(2.2 * n)


def table_of(run, step):
    return run.interface("contact", step)


def positions(run, step):
    table = table_of(run, step)
    return np.stack([table["X"] + table["ux"], table["Y"] + table["uy"]], axis=1)


def drift(run, settled, step):
    """Largest distance of a node of the shaft's surface from where the rotation takes it from the step `settled`."""
    c, s = np.cos(ANGLE), np.sin(ANGLE)
    carried = positions(run, settled) @ np.array([[c, s], [-s, c]])
    return np.linalg.norm(positions(run, step) - carried, axis=1).max() / FACET
