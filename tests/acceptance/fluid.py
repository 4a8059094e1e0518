"""A pressure that gets between surfaces (`into` of a load): a thin layer under a die that slants, whose pressure grows along it as p = PEAK x, so
that a fluid of pressure P comes to x = P / PEAK and leaks at PEAK, and not before; a lip that is pressed on a plate."""

import math

import numpy as np
from jacobian import whole_matrix
from scene import write

YOUNG, HEIGHT, SLOPE = 100.0, 0.05, 0.001
PEAK = YOUNG * SLOPE / HEIGHT
# The layer carries each place by itself but for its shear, over about its height, which is two facets; the front is at an end of a facet.
FACETS_OFF = 2.0
# Where points decide facets by the front are open in part: one more.
POINTS_OFF = 3.0
# Newton's tolerance of 1e-11 of the largest force.
BALANCE = 1e-9
# Ranks add in another order; the numbers of unknowns differ, too.
RANKS = 1e-9
# The front moves by facets, and the pressure by steps of 0.9 %.
LEAKS = 0.03
CELLS = {"layer": 40, "die": 30}
DENSITY = 1e-6  # waves cross the strip in a ten thousandth of a step
CENTRE = 3.0  # of the ring that the strip becomes
# So many steps up to a tenth above the peak, the first of which presses the die down.
STEPS, LAST = 12, 1.1
CURVE = [0, 0, 1, 0, STEPS, 1]


def box(model, name, low, high, along):
    """A strip from 0 to 1, in an axisymmetric model from CENTRE on, in space a tenth wide."""
    start = CENTRE if model == "axisymmetric" else 0
    wide = [0.1] if model == "solid" else []
    shape = {"lower": [start, low] + [0] * len(wide), "upper": [start + 1, high] + wide, "cells": [along, 2] + [1] * len(wide)}
    return {"type": "box", "young": YOUNG, "poisson": 0} | shape


def wedge(model="plane_strain", cell="", roles=("layer", "die"), contact=None, curve=CURVE, **more):
    axes = ["x", "y", "z"] if model == "solid" else ["x", "y"]
    d = len(axes)
    gradient = [0.0] * d * d
    gradient[d] = -SLOPE
    faces = {"layer": "layer.ymax", "die": "die.ymin"}
    scene = {
        "schema": 1,
        "model": model,
        "bodies": ["layer", "die"],
        "layer": box(model, "layer", 0, HEIGHT, CELLS["layer"]),
        "die": box(model, "die", HEIGHT, 3 * HEIGHT, CELLS["die"]),
        "supports": ["base", "press"],
        "base": {"surface": "layer.ymin", "components": axes},
        "press": {"body": "die", "components": axes, "gradient": gradient, "curve": [0, 0, 1, 1]},
        "loads": ["oil"],
        "oil": {"surface": ["layer.xmin", "die.xmin"], "pressure": LAST * PEAK, "into": "seal", "outlet": ["layer.xmax", "die.xmax"], "curve": curve},
        "interfaces": ["seal"],
        "seal": {"nonmortar": faces[roles[0]], "mortar": faces[roles[1]]} | (contact or {}),
        "steps": {"end": STEPS, "count": STEPS},
        "output": {"vtu": "none", "csv": "all"},
    }
    if model == "axisymmetric":
        scene["press"]["origin"] = [CENTRE, 0]
    for name in CELLS:
        scene[name] |= ({"cell": cell} if cell else {}) | ({"density": DENSITY} if "dynamics" in more else {})
    return scene | more


VARIANTS = {
    "plane": {},
    "triangles": {"cell": "tri"},
    "quad8": {"cell": "quad8"},
    "tri6": {"cell": "tri6"},
    "roles exchanged": {"roles": ("die", "layer")},
    "standard": {"contact": {"basis": "standard"}},
    "points that decide": {"contact": {"decision": "points"}},
    "dynamics": {"dynamics": {"rho_inf": 1, "mass_damping": 50}},
    "condensed": {"unknowns": "displacements"},
    "iterative": {"solver": "iterative"},
    "axisymmetric": {"model": "axisymmetric"},
    "hexahedra": {"model": "solid"},
    "hex20": {"model": "solid", "cell": "hex20"},
    "tet10": {"model": "solid", "cell": "tet10"},
}


def wetted(model, x):
    """Of both sides, up to x."""
    return 2 * {"solid": 0.1 * x, "axisymmetric": 2 * math.pi * x * (CENTRE + x / 2)}.get(model, x)


def fronts(verdicts, driver):
    for name, more in VARIANTS.items():
        run = driver.run(write(wedge(**more), driver.output / "wedge.yaml"), label=name)
        model, off, late = more.get("model", "plane_strain"), 0.0, []
        for step in run.steps:
            oil = step["fluids"]["oil"]
            reached = min(1, oil["pressure"] / PEAK)
            facet = wetted(model, 1) / 2 * (1 / CELLS["layer"] + 1 / CELLS["die"])
            off = max(off, abs(oil["area"] - wetted(model, reached)) / facet)
            late.append(oil["at_outlet"] == (oil["pressure"] >= PEAK * (1 - BALANCE)))
        verdicts.below(f"{name}: front against p / peak", off, POINTS_OFF if "points" in name else FACETS_OFF, "facets, in the worst of the steps")
        verdicts.true(f"{name}: leaks at the peak of the contact's pressure", all(late), "not a step before, not one after")


def balance(verdicts, driver):
    """What holds the layer is what die and fluid press it by: the fluid's force is its pressure times the way from the lower corner to the front,
    turned by a right angle. The front is at one of the nodes, and at the others this is far from true."""
    run = driver.run(write(wedge(), driver.output / "wedge.yaml"), label="balance")
    worst = 0.0
    for k, step in enumerate(run.steps):
        table, pressure, base = run.interface("seal", k + 1), step["fluids"]["oil"]["pressure"], step["reactions"]["base"]
        x, y = table["X"] + table["ux"], HEIGHT + table["uy"]
        left = np.hypot(base[0] + table["fx"].sum() + pressure * y, base[1] + table["fy"].sum() - pressure * x)
        worst = max(worst, left.min() / (PEAK / 2))
    verdicts.below("reaction, die and fluid on the layer", worst, BALANCE, "0, in every step")


def back(verdicts, driver):
    """The pressure falls again: the front follows in the same step."""
    curve = [0, 0, 1, 0, 7, 0.8, STEPS, 0.1]
    run = driver.run(write(wedge(curve=curve), driver.output / "back.yaml"), label="back")
    facet = 1 / CELLS["layer"] + 1 / CELLS["die"]
    off = max(abs(s["fluids"]["oil"]["area"] - 2 * s["fluids"]["oil"]["pressure"] / PEAK) / facet for s in run.steps)
    verdicts.below("up and down: front against p / peak", off, FACETS_OFF, "facets, in the worst of the steps")
    verdicts.true("up and down: never at the outlet", not any(s["fluids"]["oil"]["at_outlet"] for s in run.steps), "0.88 of the peak at most")


def ranks(verdicts, driver):
    scene = write(wedge(), driver.output / "ranks.yaml")
    numbers = lambda run: [v for s in run.steps for v in [s["fluids"]["oil"]["area"], *s["reactions"]["base"]]]
    one = driver.run(scene, "-output_restart_every", 1, "-output_restart_keep", 0, label="one rank")
    for n in (2, 3):
        more = driver.run(scene, label=f"{n} ranks", ranks=n)
        worst = max(abs(a - b) for a, b in zip(numbers(one), numbers(more)))
        verdicts.below(f"{n} ranks: areas and reactions", worst / (PEAK / 2), RANKS, "those of one")
    again = driver.run(scene, "-restart", one.directory / "restart_6.bin", label="restart")
    verdicts.true("restart in the middle", numbers(again)[-12:] == numbers(one)[-12:], "the same bits")


def tangent(verdicts, driver):
    """At large strain: what presses moves and stretches. The die is longer, for where two ends meet weights have a kink."""
    scene = wedge(steps={"end": 6, "count": 6})
    scene["layer"] |= {"material": "neo_hooke", "cells": [8, 1]}
    scene["die"] |= {"material": "neo_hooke", "cells": [6, 1], "lower": [-0.03, HEIGHT], "upper": [1.03, 3 * HEIGHT]}
    run = driver.run(write(scene, driver.output / "tangent.yaml"), "-snes_test_jacobian", "-snes_test_err", 5e-9, label="tangent")
    verdicts.true("tangent: the fluid is between the surfaces", run.steps[-1]["fluids"]["oil"]["area"] > 0.3, "of a length of 1, on both sides")
    whole_matrix(verdicts, "fluid", run)


def lip(around):
    """A soft lip under a plate, with so many facets around; the fluid's pressure goes up to 2.5, from 2.1 on in steps of 0.02."""
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["lip", "plate"],
        "lip": {"type": "box", "polar": True, "lower": [0.7, 10], "upper": [1, 170], "cells": [around // 8, around], "young": 20, "poisson": 0.1,
                "material": "neo_hooke"},
        "plate": {"type": "box", "lower": [-0.8, 1], "upper": [0.8, 1.3], "cells": [5 * around // 4, 3], "young": 2000, "poisson": 0.3},
        "surfaces": ["port", "air"],
        "port": {"of": "lip.xmax", "within": [0.4, 0, 2, 2]},
        "air": {"of": "lip.xmax", "within": [-2, 0, -0.4, 2]},
        "supports": ["base", "press"],
        "base": {"surface": "lip.xmin", "components": ["x", "y"]},
        "press": {"surface": "plate.ymax", "components": ["x", "y"], "value": [0, -0.03], "curve": [0, 0, 1, 1]},
        "loads": ["oil"],
        "oil": {"surface": ["port", "plate.xmax"], "pressure": 2.5, "into": "seal", "outlet": ["air", "plate.xmin"], "curve": [1, 0, 2, 0.84, 3, 1]},
        "interfaces": ["seal"],
        "seal": {"nonmortar": "lip.xmax", "mortar": "plate.ymin"},
        "steps": {"stages": [1, 2, 2, 6, 3, 20]},
        "output": {"vtu": "none", "csv": "none"},
    }


def leaks(verdicts, driver):
    """Where the pressure of contact is none that is known: on a mesh and on one twice as fine."""
    opens = []
    for around in (64, 128):
        run = driver.run(write(lip(around), driver.output / "lip.yaml"), label=f"lip_{around}")
        opens.append(min(s["fluids"]["oil"]["pressure"] for s in run.steps if s["fluids"]["oil"]["at_outlet"]))
    verdicts.below("lip: the pressure at which it opens", abs(opens[0] / opens[1] - 1), LEAKS, "on a mesh twice as fine")


def refused(verdicts, driver):
    tied = {"seal": {"nonmortar": "layer.ymax", "mortar": "die.ymin", "law": "tied"}}
    rigid = {"die": {"type": "rigid", "from": "box", "lower": [0, HEIGHT], "upper": [1, 3 * HEIGHT], "cells": [30, 2], "reference": [0.5, 2 * HEIGHT]}}
    for what, load, says, *more in (
        ("into a tie", {}, "oil.into: 'seal' is tied", tied),
        ("on a rigid side", {"surface": "layer.xmin", "outlet": None}, "is a side of 'seal' and rigid", rigid | {"press": {"body": "die", "components": ["x", "y", "rz"]}}),
        ("without a pressure", {"pressure": None, "traction": [0, 1]}, "oil.into: only a `pressure` gets between surfaces"),
        ("into nothing", {"into": "leak"}, "oil.into: there is no interface 'leak'"),
        ("with an outlet alone", {"into": None}, "oil.outlet: it is of a pressure that gets between surfaces"),
        ("from a surface that is none", {"outlet": "die.top"}, "there is no surface 'die.top'"),
    ):
        scene = wedge() | (more[0] if more else {})
        scene["oil"] = {k: v for k, v in (scene["oil"] | load).items() if v is not None}
        run = driver.run(write(scene, driver.output / "refused.yaml"), label="refused", expect=1)
        verdicts.true(f"a fluid {what}: refused", says in run.text and "PETSC ERROR" not in run.text, f"says: {says}")
    nowhere, untold = "the fluid gets between them nowhere", "no leak would be told"
    for what, load, says in (
        ("from aside", {"surface": "die.ymax"}, [nowhere]),
        ("with an outlet aside", {"outlet": "die.ymax"}, [untold]),
        ("as it is meant", {}, []),
    ):
        scene = wedge()
        scene["oil"] = scene["oil"] | load
        run = driver.run(write(scene, driver.output / "aside.yaml"), label="aside")
        told = [words for words in (nowhere, untold) if words in run.text]
        verdicts.true(f"a fluid {what}: {len(told)} told", told == says, ", ".join(says) or "nothing")


def fluid(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    fronts(verdicts, driver)
    balance(verdicts, driver)
    back(verdicts, driver)
    ranks(verdicts, driver)
    tangent(verdicts, driver)
    leaks(verdicts, driver)
    refused(verdicts, driver)
