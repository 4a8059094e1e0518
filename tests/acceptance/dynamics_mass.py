"""`contact_mass: spread`: no mass at non-mortar nodes. Mass, centre and inertia of each body are kept, whatever its cells; it flies as it did; bars pass on
all their energy, with even pressures; a ball that hops loses less; tangent; refusals."""

import numpy as np

from dynamics import EXACT_BOUND, energy, run, total, two_bars
from jacobian import JACOBIAN_BOUND, worst

# Of moments that are the same by algebra: rounding, a few hundred cells.
KEPT_BOUND = 1e-12
# Two bars in steps of a quarter of h / c: what the impact takes of the energy with masses at the nodes, and without. What remains is Newton's tolerance.
TAKEN, NOT_TAKEN = 5e-3, 1e-9
# Steps of h / c: the pressure's scatter over its mean. With masses it alternates by 0.29.
SCATTER = 0.03
# What contact takes in a hop of a ball of facets, over what it takes with masses. Weights by which contact gives nothing, so that it is the impact's.
HOP = 0.2
# A bar on a wall in steps of h / 4c: its speed when it flies back over that before.
BACK = 0.99

KINDS = {"solid": ("hex", "tet", "tet10", "hex20", "hex27"), "plane_strain": ("quad", "tri", "tri6", "quad8", "quad9"), "axisymmetric": ("quad", "tri6")}
SPREAD = ("-dynamics_contact_mass", "spread")


def mass(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    kept(verdicts, driver)
    bars(verdicts, driver)
    wall(verdicts, driver)
    hop(verdicts, driver)
    tangent(verdicts, driver)
    refused(verdicts, driver)


def thrown(model, kind):
    """A body over a floor that it does not meet, thrown up and turning."""
    d = 3 if model == "solid" else 2
    ring = model == "axisymmetric"
    motion = {"velocity": [0, 2]} if ring else {"velocity": [1, 2, 3][:d], "spin": [0.3, 0.2, 0.5] if d == 3 else 0.5, "about": [0.4, 0.2, 0.1][:d]}
    face = "zmin" if d == 3 else "ymin"
    return {"schema": 1, "model": model, "bodies": ["block", "floor"], "dynamics": {"rho_inf": 1},
            "block": {"type": "box", "lower": [0.5, 0, 0][:d], "upper": [1.5, 1, 1][:d], "cells": [2, 3, 3][:d], "cell": kind, "young": 1000, "poisson": 0.3, "density": 2,
                      "small_strain": True, **motion},
            "floor": {"type": "box", "lower": [0.2, -8, -8][:d], "upper": [1.8, 1, -7][:d] if d == 3 else [1.8, -7], "cells": [2] * d, "young": 1000, "poisson": 0.3, "density": 2},
            "supports": ["ground"], "ground": {"surface": f"floor.{face}", "components": ["x", "y", "z"][:d]},
            "loads": ["weight"], "weight": {"body": "block", "gravity": [0, 0, -10] if d == 3 else [0, -10], "curve": [0, 1, 1, 1]},
            "interfaces": ["c"], "c": {"nonmortar": f"block.{face}", "mortar": f"floor.{face[0]}max"}, "steps": {"count": 2, "end": 0.2}, "output": {"vtu": "none", "csv": "none"}}


def kept(verdicts, driver):
    for model, kinds in KINDS.items():
        for kind in kinds:
            scene, what = thrown(model, kind), f"{model}, {kind}"
            whole, spread = (energy(run(driver, "thrown", scene, *options, label=f"thrown_{model}_{kind}_{len(options)}")) for options in ((), SPREAD))
            scale = whole["kinetic"][0]
            off = max(abs(whole[key][0] - spread[key][0]) for key in whole if key[:3] in ("kin", "mom", "ang"))
            verdicts.below(f"{what}: energy, momentum and moment at the start", off / scale, KEPT_BOUND, "mass, centre and inertia are kept")
            if model == "axisymmetric":  # no turn: its flight has no strain
                verdicts.below(f"{what}: strain in flight", spread["strain"].max() / scale, EXACT_BOUND, "its weight goes where its mass does")
            verdicts.below(f"{what}: momentum after a flight", max(abs(whole[key][-1] - spread[key][-1]) for key in ("momentum_y", "momentum_z")) / scale, EXACT_BOUND, "as with masses")


def bars(verdicts, driver):
    ends = {}
    for label, options in {"consistent": (), "spread": SPREAD}.items():
        table = energy(run(driver, "bars", two_bars(), "-steps_count", "560", *options, label=f"bars_{label}"))
        ends[label] = 1 - total(table)[-1] / total(table)[0]
        verdicts.below(f"bars, {label}: momentum", np.abs(table["momentum_x"]).max() / 1e-3, EXACT_BOUND, "none")
    verdicts.at_least("bars, consistent: what the impact takes", ends["consistent"], TAKEN, "of the energy")
    verdicts.below("bars, spread: what the impact takes", abs(ends["spread"]), NOT_TAKEN, "nothing, and it gives nothing")
    result = run(driver, "bars", two_bars(), *SPREAD, label="bars_pressure")
    force = np.array([step["interfaces"]["c"]["force"][0] for step in result.steps]) / 0.01
    t = energy(result)["t"][1:]
    during = (t > 0.2) & (t < 2.0)
    verdicts.below("bars, spread: scatter of the pressure", force[during].std() / 0.1, SCATTER, "rho c v all the time")
    verdicts.near("bars, spread: mean pressure", abs(force[during].mean()) / 0.1, 1, SCATTER, "rho c v")


def wall(verdicts, driver):
    """A bar flies onto a wall, in steps of h / 4c. Waves of linear cells scatter the force, whatever stops the bar: no more than where a support catches it."""
    bar = {"type": "box", "cells": [50, 1, 1], "young": 1, "poisson": 0, "density": 1, "lower": [0, 0, 0], "upper": [1, 0.1, 0.1], "velocity": [0.1, 0, 0]}
    scene = {"schema": 1, "bodies": ["bar"], "bar": bar, "dynamics": {"rho_inf": 1}, "supports": ["hold"], "steps": {"count": 560, "end": 2.8}, "output": {"vtu": "none", "csv": "none"}}
    caught = run(driver, "caught", {**scene, "hold": {"surface": "bar.xmax", "components": ["x"], "from": 0.13}})
    meets = {"bodies": ["bar", "wall"], "wall": {"type": "analytic", "shape": "plane", "point": [1.013, 0, 0], "direction": [-1, 0, 0]},
             "hold": {"body": "wall", "components": ["x", "y", "z"]}, "interfaces": ["c"], "c": {"nonmortar": "bar.xmax", "mortar": "wall.surface"}}
    stopped = run(driver, "wall", {**scene, **meets}, *SPREAD)
    table = energy(stopped)
    during = (table["t"][1:] > 0.5) & (table["t"][1:] < 1.9)  # not at the first front, which a step is too coarse for
    force = np.array([step["interfaces"]["c"]["force"][0] for step in stopped.steps])[during] / 1e-3
    held = np.array([step["reactions"].get("hold", [0])[0] for step in caught.steps])[during] / 1e-3
    verdicts.below("bar on a wall, h / 4c: scatter of the force over that of a bar that a support catches", force.std() / held.std(), 1, f"{force.std():.2g} and {held.std():.2g} of rho c v")
    verdicts.near("bar on a wall, h / 4c: mean force", abs(force.mean()), 1, SCATTER, "rho c v")
    verdicts.within("bar on a wall, h / 4c: speed back", -table["momentum_x"][-1] / table["momentum_x"][0], BACK, 1, "of that before")


def ball():
    """A quarter of a ball of facets that falls on a slab."""
    cube = {"type": "box", "young": 1000, "poisson": 0.3, "density": 1, "small_strain": True}
    places = [0, 0.15, 0.3, 0.5, 0.75, 1]
    return {"schema": 1, "bodies": ["top", "base"], "top": {**cube, "ball": [0, 0, 0], "x": places, "y": places, "z": [-1, -0.85, -0.65, -0.4, 0], "velocity": [0, 0, -1]},
            "base": {**cube, "lower": [0, 0, -1.6], "upper": [1.2, 1.2, -1.01], "cells": [7, 7, 3]}, "dynamics": {"rho_inf": 1},
            "supports": ["ground", "sx", "sy"], "ground": {"surface": "base.zmin", "components": ["x", "y", "z"]},
            "sx": {"surface": ["top.xmin", "base.xmin"], "components": ["x"]}, "sy": {"surface": ["top.ymin", "base.ymin"], "components": ["y"]},
            "interfaces": ["c"], "c": {"nonmortar": "base.zmax", "mortar": "top.zmin"}, "steps": {"count": 240, "end": 0.3}, "output": {"vtu": "none", "csv": "none"}}


def hop(verdicts, driver):
    taken = {}
    for label, options in {"consistent": (), "spread": SPREAD}.items():
        result = run(driver, "hop", ball(), *options, label=f"hop_{label}")
        table = energy(result)
        taken[label] = 1 - total(table)[-1] / total(table)[0]
        verdicts.below(f"ball, {label}: given by contact", table["contact_gain"][-1] / total(table)[0], EXACT_BOUND, "nothing")
        verdicts.at_least(f"ball, {label}: it flies off", table["momentum_z"][-1] / -table["momentum_z"].min(), 0.2, "upwards")
    verdicts.below("ball: what contact takes in a hop, over that with masses", taken["spread"] / taken["consistent"], HOP, f"{taken['consistent']:.2g} and {taken['spread']:.2g}")


def tangent(verdicts, driver):
    scene = thrown("solid", "hex")
    scene["floor"].update(upper=[1.8, 1, -0.01])
    scene["block"].update(velocity=[0.3, 0, -3], material="neo_hooke")
    scene["block"].pop("small_strain")
    result = run(driver, "tangent", {**scene, "steps": {"times": [0.01, 0.02]}}, *SPREAD, "-test_jacobian_blocks")
    tests = [test for step in result.steps for test in step["jacobian_tests"] if test["switches"] == 0]
    errors = [part["error"] / part["norm"] for test in tests for part in test["blocks"] if part["norm"]]
    verdicts.below("tangent, masses spread", worst(errors), JACOBIAN_BOUND, f"{len(tests)} iterates against central differences")


def refused(verdicts, driver):
    scene = two_bars(n=1, count=1)
    for what, options, ranks, words in (
        ("one layer", (), 1, "needs two layers of nodes inside"),
        ("rho_inf below 1", ("-dynamics_rho_inf", "0.9"), 1, "goes with `rho_inf: 1` only"),
        ("two ranks", (), 2, "for one rank only"),
        ("no such masses", ("-dynamics_contact_mass", "lumped"), 1, "consistent"),
    ):
        text = run(driver, "refused", scene, *SPREAD, *options, ranks=ranks, label="refused_" + what.replace(" ", "_"), expect=1).text
        verdicts.true(f"refused, {what}", "contact_mass: " in text and words in text and "PETSC ERROR" not in text, words)
