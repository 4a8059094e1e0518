"""No run ends well out of balance, or with energy from nowhere: faults that are planted in the driver (program/tests/planted_faults.c) are found and named, and tractions
beyond what bodies can carry are, a block that is drawn over facets and must not sink, with dynamics and without, and one that spins. And what is as it should be
is not refused."""

import os

from scene import Driver, write

# Two blocks under a load, frictionless.
BLOCKS = {
    "schema": 1,
    "bodies": ["upper", "lower"],
    "upper": {"type": "box", "lower": [0, 0, 1], "upper": [1, 1, 2], "cells": [3, 3, 2], "young": 1000, "poisson": 0.3, "small_strain": True},
    "lower": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [2, 2, 2], "young": 1000, "poisson": 0.3, "small_strain": True},
    "supports": ["ground", "alongx", "alongy"],
    "ground": {"surface": "lower.zmin", "components": ["z"]},
    "alongx": {"surface": ["lower.xmin", "upper.xmin"], "components": ["x"]},
    "alongy": {"surface": ["lower.ymin", "upper.ymin"], "components": ["y"]},
    "loads": ["press"],
    "press": {"surface": "upper.zmax", "traction": [0, 0, -10]},
    "interfaces": ["base"],
    "base": {"nonmortar": "upper.zmin", "mortar": "lower.zmax"},
    "steps": {"count": 1, "smallest": 0.5},
    "output": {"vtu": "none", "csv": "none"},
}
# What is planted, and what must be said of it.
PLANTED = {
    "drop": "base gives its two sides different forces",
    "double": "base gives its two sides different forces",
    "push": "contact forces on '",
    "unfelt": "not converged beyond t = 0",
    "huge": "between the surfaces of base, which the softer side",
}
# A wall of E = 1000 that cannot widen, pressed against one that is held in all: so many times its modulus.
PRESSED = {"carried": (5.0, 0), "more than it can carry": (20.0, 2)}

# A block that is drawn over a flat elastic floor, pressed by its weight: 0.6 of a facet a step. Statics, where a support draws it.
DRAWN = {
    "schema": 1,
    "model": "plane_strain",
    "bodies": ["block", "floor"],
    "block": {"type": "box", "lower": [0, 0], "upper": [0.4, 0.2], "cells": [4, 2], "young": 1e4, "poisson": 0.3, "density": 20, "small_strain": True},
    "floor": {"type": "box", "lower": [-0.4, -0.4], "upper": [2.6, 0], "cells": [30, 4], "young": 1e4, "poisson": 0.3, "density": 2, "small_strain": True},
    "supports": ["ground", "draw"],
    "ground": {"surface": "floor.ymin", "components": ["x", "y"]},
    "draw": {"surface": "block.ymax", "components": ["x"], "value": [1.5, 0], "curve": [0, 0, 1, 1]},
    "loads": ["weight"],
    "weight": {"body": "block", "gravity": [0, -100], "curve": [0, 1, 9, 1]},
    "interfaces": ["base"],
    "base": {"nonmortar": "block.ymin", "mortar": "floor.ymax"},
    "probes": ["corner"],
    "corner": {"body": "block", "point": [0, 0.2]},
    "steps": {"count": 25},
    "output": {"vtu": "none", "csv": "none"},
}
MOVES = {"block": DRAWN["block"] | {"velocity": [1.5, 0]}, "supports": ["ground"], "dynamics": {"rho_inf": 1}}
SPINS = {
    "schema": 1,
    "model": "plane_strain",
    "bodies": ["block"],
    "block": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1], "cells": [4, 4], "young": 1000, "poisson": 0.3, "density": 1, "material": "neo_hooke",
              "spin": 3, "about": [0, 0]},
    "dynamics": {"rho_inf": 1},
    "output": {"vtu": "none", "csv": "none"},
}
# Of its static depth, 0.01: a block that swings, on coarse facets.
DEPTH = 0.03


class Planted(Driver):
    """The driver with a fault."""

    def __init__(self, driver):
        super().__init__(driver.build, driver.output)
        self.program = driver.program.parent / "planted_faults"


def sound(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    lonely(verdicts, driver)
    planted(verdicts, driver)
    carried(verdicts, driver)
    sinks(verdicts, driver)
    spins(verdicts, driver)


def lonely(verdicts, driver):
    """A block that touches with one corner, tilted, and one that touches with all of its side."""
    for tilt, told in ((0.05, True), (0.0, False)):
        scene = {
            "schema": 1, "model": "plane_strain", "bodies": ["block", "floor"],
            "block": {"type": "box", "corners": [0, 0, 1, tilt, 1, 1, 0, 1], "cells": [8, 4], "young": 1000, "poisson": 0.3},
            "floor": {"type": "box", "lower": [-1, -1], "upper": [2, 0], "cells": [20, 4], "young": 1000, "poisson": 0.3},
            "supports": ["ground", "press"],
            "ground": {"surface": "floor.ymin", "components": ["x", "y"]},
            "press": {"surface": "block.ymax", "components": ["x", "y"], "value": [0, -0.0003]},
            "interfaces": ["contact"], "contact": {"nonmortar": "block.ymin", "mortar": "floor.ymax", "basis": "dual"},
            "steps": {"count": 1}, "output": {"vtu": "none", "csv": "none"},
        }
        run = driver.run(write(scene, driver.output / f"lonely_{tilt}.yaml"))
        verdicts.true(f"tilted by {tilt}: one node carries all, told", ("is at one node" in run.text) == told, "the contact is smaller than a facet")


def planted(verdicts, driver):
    spoilt = Planted(driver)
    if not spoilt.program.is_file():  # a linker that wraps nothing
        return
    path = write(BLOCKS, driver.output / "blocks.yaml")
    for ranks, faults in ((1, PLANTED), (2, ("drop", "push"))):
        for fault in (None, *faults):
            os.environ["PLANTED_FAULT"] = fault or ""
            run = spoilt.run(path, label=f"{fault}_{ranks}", ranks=ranks, expect=2 if fault else 0)
            words = PLANTED.get(fault, "")
            verdicts.true(f"{fault or 'no fault'}, {ranks} ranks", words in run.text, words or "runs")
    del os.environ["PLANTED_FAULT"]


def carried(verdicts, driver):
    for name, (times, code) in PRESSED.items():
        scene = {**BLOCKS, "press": {"surface": "upper.zmax", "traction": [0, 0, -1000 * times]}, "upper": BLOCKS["upper"] | {"poisson": 0},
                 "supports": ["ground", "sides"], "ground": {"body": "lower", "components": ["x", "y", "z"]},
                 "sides": {"body": "upper", "components": ["x", "y"]}}
        del scene["alongx"], scene["alongy"]
        run = driver.run(write(scene, driver.output / f"pressed_{code}.yaml"), expect=code)
        told = "a traction of 2e+04 between the surfaces of base" in run.text
        verdicts.true(f"pressed by {times} times its modulus", told == bool(code), name)


def sinks(verdicts, driver):
    for name, more in (("drawn", {}), ("moves", MOVES)):
        scene = {**DRAWN, **more}
        if "draw" not in scene["supports"]:
            del scene["draw"]
        path = write(scene, driver.output / f"{name}.yaml")
        for weights in ("current", "conserving"):
            run = driver.run(path, "-base_weights", weights, label=f"{name}_{weights}")
            deepest = -min(step["probes"]["corner"][1] for step in run.steps)
            verdicts.below(f"{name}, {weights} weights: depth", deepest, DEPTH, "stays on top")


def spins(verdicts, driver):
    """With rho_inf = 1 energy stays at any step; below it long steps end the run, shorter ones are told of once."""
    for rho, turn, code, told in ((0.8, 1.0, 2, True), (0.9, 0.72, 0, True), (1.0, 0.3, 0, False)):
        scene = {**SPINS, "dynamics": {"rho_inf": rho}, "steps": {"count": 25, "end": 25 * turn / 3}}
        run = driver.run(write(scene, driver.output / f"spins_{turn}.yaml"), label=f"spins_{turn}", expect=code)
        words = "the time integration has given or taken"
        verdicts.true(f"a block spins by {turn} a step", (words in run.text) == told, words if told else "its energy stays")
        verdicts.true(f"a block spins by {turn} a step: summary", ("numerical" in run.summary.get("energy_told", {})) == told, "the same")
