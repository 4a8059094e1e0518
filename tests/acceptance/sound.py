"""No run ends well out of balance: faults that are planted in the driver (c_examples/tests/planted_faults.c) are found and named, and tractions
beyond what bodies can carry are. And what is as it should be is not refused."""

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
    "huge": "between the surfaces of base, which their softer body",
}
# A wall of E = 1000 that cannot widen, pressed against one that is held in all: so many times its modulus.
PRESSED = {"carried": (5.0, 0), "more than it can carry": (20.0, 2)}


class Planted(Driver):
    """The driver with a fault."""

    def __init__(self, driver):
        super().__init__(driver.program.parents[1], driver.output)
        self.program = driver.program.parent / "planted_faults"


def sound(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    planted(verdicts, driver)
    carried(verdicts, driver)


def planted(verdicts, driver):
    spoilt = Planted(driver)
    if not spoilt.program.is_file():  # a linker that wraps nothing
        return
    path = write(BLOCKS, driver.output / "blocks.yaml")
    for ranks in (1, 2):
        for fault in (None, *PLANTED):
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
