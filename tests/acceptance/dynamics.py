"""Implicit dynamics: masses of every kind of cell, free flight and turns, orders of convergence, energy in impacts, two bars against the
closed form, a block on an incline, rigid bodies that tumble, bounce and roll, the tangent against differences, ranks and solvers,
rollback, refusals."""

import csv
import math

import numpy as np

from jacobian import JACOBIAN_BOUND, worst
from scene import write

# What a step adds to the energy where nothing loads the bodies, over all of it: the issue's bound; rounding is 1e-13.
ENERGY_BOUND = 1e-8
# Newton's tolerance is 1e-11 of the forces, and 40 steps add up.
EXACT_BOUND = 1e-9
# Bars: a contact lasts from 2 L / c on, with rho c v; the mass of the nodes that meet is half a cell's, 1 % of a bar.
BAR_BOUND = 0.02
INCLINE_BOUND = 1e-6
# Of an observed order, on three halvings.
ORDER_BOUND = 0.1
# Steps in which contact gives energy, and those in which the energy grows: the same but for what Newton leaves of the others.
GIVEN_BOUND = 1e-6
# The same run in another way.
SAME_BOUND = 1e-9
# A turn of one radian in 20 steps: energy and the moment of momentum are kept, of any material.
TURN_BOUND = 1e-9

ELASTIC = {"young": 1000, "poisson": 0.3, "density": 2}


def dynamics(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    flight(verdicts, driver)
    turn(verdicts, driver)
    orders(verdicts, driver)
    supported(verdicts, driver)
    jump(verdicts, driver)
    bars(verdicts, driver)
    bounces(verdicts, driver)
    layer(verdicts, driver)
    turning(verdicts, driver)
    incline(verdicts, driver)
    top(verdicts, driver)
    thrown(verdicts, driver)
    rolling(verdicts, driver)
    tangents(verdicts, driver)
    rolled_back(verdicts, driver)
    overlap_at_the_start(verdicts, driver)
    spins_too_fast(verdicts, driver)
    inertia_unasked(verdicts, driver)
    refused(verdicts, driver)


def run(driver, name, scene, *options, **more):
    return driver.run(write(scene, driver.output / f"{name}.yaml"), *options, label=more.pop("label", name), **more)


def energy(result):
    """energy.csv: columns by name."""
    with open(result.directory / "energy.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def total(table):
    return table["kinetic"] + table["strain"]


def growth(table):
    """The largest growth in a step, over the energy at the start."""
    e = total(table)
    return np.diff(e).max() / e[0]


# --- without contact ----------------------------------------------------------------------------------------------------
SOLIDS = ("hex", "tet", "tet10", "hex20", "hex27")
PLANES = ("quad", "tri", "tri6", "quad8", "quad9")


def flight(verdicts, driver):
    """A body thrown up: mass, momentum, and a parabola that the scheme follows exactly."""
    cases = [(kind, "solid", 3) for kind in SOLIDS]
    cases += [(kind, model, 2) for model in ("plane_strain", "plane_stress", "axisymmetric") for kind in PLANES]
    for kind, model, d in cases:
        name = f"{kind}, {model}"
        low, high = [0.5, 0, 0][:d], [1.5, 1, 1][:d]
        thrown, gravity = ([0, 2, 0][:d] if d == 2 else [1, 2, 3]), ([0, -10] if d == 2 else [0, 0, -10])
        scene = {"schema": 1, "model": model, "bodies": ["block"], "dynamics": {"rho_inf": 0.8},
                 "block": {"type": "box", "lower": low, "upper": high, "cells": [2] * d, "cell": kind, **ELASTIC, "velocity": thrown},
                 "loads": ["weight"], "weight": {"body": "block", "gravity": gravity, "curve": [0, 1, 1, 1]},
                 "steps": {"count": 10}, "probes": ["corner"], "corner": {"body": "block", "point": low}, "output": {"vtu": "none"}}
        result = run(driver, "flight", scene, label="flight_" + name.replace(" ", "_").replace(",", ""))
        table = energy(result)
        mass = 2 * (math.pi * (1.5**2 - 0.5**2) if model == "axisymmetric" else 1)
        there = np.array(result.steps[-1]["probes"]["corner"])[:d]
        verdicts.below(f"flight, {name}: momentum at the start", abs(table["momentum_y"][0] / (2 * mass) - 1), EXACT_BOUND, "mass times velocity")
        if model != "axisymmetric" or kind.startswith("quad"):
            verdicts.below(f"flight, {name}: place", np.abs(there - (np.array(thrown) + np.array(gravity) / 2)).max(), EXACT_BOUND, "v t + g t^2 / 2")
            verdicts.below(f"flight, {name}: energy", np.abs(table["numerical"]).max() / total(table)[0], EXACT_BOUND, "that of the throw and of the weight")


def turn(verdicts, driver):
    """A body of finite strain that turns by a radian: what is kept (dynamics_finite.py has more)."""
    scene = {"schema": 1, "bodies": ["block"], "dynamics": {"rho_inf": 1},
             "block": {"type": "box", "lower": [-1, -0.5, -0.5], "upper": [1, 0.5, 0.5], "cells": [4, 2, 2], **ELASTIC, "material": "neo_hooke",
                       "spin": [0.2, 0.3, 1], "velocity": [1, 0, 0]},
             "steps": {"count": 20}, "output": {"vtu": "none"}}
    table = energy(run(driver, "turn", scene))
    for kind, scale in (("momentum", 4), ("angular", 2)):
        change = max(np.abs(table[f"{kind}_{axis}"] - table[f"{kind}_{axis}"][0]).max() for axis in "xyz")
        verdicts.below(f"turn: {kind}", change / scale, TURN_BOUND, "kept")
    verdicts.below("turn: energy", np.abs(total(table) / total(table)[0] - 1).max(), TURN_BOUND, "kept")


def orders(verdicts, driver):
    """A clamped bar under a load that changes in time: displacement and velocity at the end, on four steps."""
    curve = [value for k in range(33) for value in (k / 32, math.sin(3 * k / 32) ** 2)]
    scene = {"schema": 1, "bodies": ["bar"], "bar": {"type": "box", "lower": [0, 0, 0], "upper": [1, 0.2, 0.2], "cells": [4, 1, 1], "young": 4, "poisson": 0.3, "density": 1},
             "dynamics": {"rho_inf": 1}, "supports": ["clamp"], "clamp": {"surface": "bar.xmin", "components": ["x", "y", "z"]},
             "loads": ["pull"], "pull": {"surface": "bar.xmax", "traction": [0.3, 0.1, 0], "curve": curve}, "steps": {"count": 32},
             "probes": ["tip"], "tip": {"body": "bar", "point": [1, 0, 0]}, "output": {"vtu": "none"}}
    for label, options in {"rho_inf 1": (), "rho_inf 0.8": ("-dynamics_rho_inf", "0.8"), "rho_inf 0": ("-dynamics_rho_inf", "0"),
                           "damped": ("-dynamics_stiffness_damping", "0.05", "-dynamics_mass_damping", "0.3"),
                           "damped, rho_inf 0.5": ("-dynamics_rho_inf", "0.5", "-dynamics_stiffness_damping", "0.05", "-dynamics_mass_damping", "0.3")}.items():
        ends = []
        for n in (32, 64, 128, 256):
            result = run(driver, "orders", scene, "-steps_count", str(n), *options, label=f"orders_{label.replace(' ', '_').replace(',', '')}_{n}")
            table = energy(result)
            ends.append(np.array([*result.steps[-1]["probes"]["tip"], *(table[f"momentum_{axis}"][-1] for axis in "xyz")]))
        differences = [np.linalg.norm(a - b) for a, b in zip(ends, ends[1:])]
        verdicts.near(f"order in dt, {label}", math.log2(differences[-2] / differences[-1]), 2, ORDER_BOUND, "64, 128, 256 steps")


def moved_bar(n, **clamp):
    """A bar whose clamp moves."""
    return {"schema": 1, "bodies": ["bar"], "bar": {"type": "box", "lower": [0, 0, 0], "upper": [1, 0.2, 0.2], "cells": [3, 1, 1], "young": 0.05, "poisson": 0.3, "density": 1},
            "dynamics": {"rho_inf": 1}, "supports": ["clamp"], "clamp": {"surface": "bar.xmin", "components": ["x", "y", "z"], **clamp}, "steps": {"count": n},
            "probes": ["tip"], "tip": {"body": "bar", "point": [1, 0, 0]}, "output": {"vtu": "none", "csv": "none"}}


def supported(verdicts, driver):
    """Supports that move smoothly, and ones that begin away from 0, so that the bar is strained and pulled from the first moment on."""
    fine = 128
    wave = [value for k in range(fine + 1) for value in (k / fine, math.sin(2 * k / fine + 0.3))]
    turn = {"rotate": [0, 0, 0.7], "origin": [0, 0.5, 0], "rotate_curve": [0, 0, 1, 1]}
    start, wave = ({"value": [0.1, 0.03, 0], "curve": curve} for curve in ([0, 1, 1, 1], wave))
    for case, clamp, rhos in (("away from 0", start, (0.5,)), ("a wave", wave, (1, 0.5)), ("a turn", turn, (1,))):
        for rho in rhos:
            ends = []
            for n in (fine // 4, fine // 2, fine):
                result = run(driver, "supported", moved_bar(n, **clamp), "-dynamics_rho_inf", str(rho), label=f"supported_{case.replace(' ', '_')}_{rho}_{n}")
                table = energy(result)
                ends.append(np.array([*result.steps[-1]["probes"]["tip"], *(table[f"momentum_{axis}"][-1] for axis in "xyz")]))
            differences = [np.linalg.norm(a - b) for a, b in zip(ends, ends[1:])]
            verdicts.near(f"order in dt, {case}, rho_inf {rho}", math.log2(differences[0] / differences[1]), 2, ORDER_BOUND, "32, 64, 128 steps")
            if rho == 1:
                verdicts.below(f"energy balance, {case}", np.abs(table["numerical"]).max() / total(table).max(), EXACT_BOUND, "work of supports counted")


def jump(verdicts, driver):
    """A whole body is moved from the first moment on, in the middle of the run faster, and then held: its supports have worked what it moves with."""
    scene = moved_bar(8, value=[0.4, 0, 0], curve=[0, 0, 0.25, 0.25, 0.5, 1, 1, 1])
    del scene["clamp"]["surface"]
    scene["clamp"]["body"] = "bar"
    table = energy(run(driver, "jump", scene))
    mass = 0.04
    for k, speed in ((0, 0.4), (1, 0.4), (3, 1.2), (5, 0)):
        verdicts.below(f"moved body: energy after step {k}", abs(table["kinetic"][k] - mass * speed**2 / 2), EXACT_BOUND, "m v^2 / 2")
    verdicts.below("moved body: energy balance", np.abs(table["numerical"]).max() / total(table).max(), EXACT_BOUND, "impulses work with the mean velocity")


# --- impacts ------------------------------------------------------------------------------------------------------------
def two_bars(n=50, count=140, **c):
    bar = {"type": "box", "cells": [n, 1, 1], "young": 1, "poisson": 0, "density": 1}
    return {"schema": 1, "bodies": ["left", "right"], "left": {**bar, "lower": [0, 0, 0], "upper": [1, 0.1, 0.1], "velocity": [0.1, 0, 0]},
            "right": {**bar, "lower": [1.013, 0, 0], "upper": [2.013, 0.1, 0.1], "velocity": [-0.1, 0, 0]}, "dynamics": {"rho_inf": 1},
            "interfaces": ["c"], "c": {"nonmortar": "left.xmax", "mortar": "right.xmin", **c}, "steps": {"count": count, "end": 2.8},
            "output": {"vtu": "none", "csv": "none"}}


def bars(verdicts, driver):
    """E = rho = A = 1 (the area scaled): contact for 2 L / c = 2 with the force rho c v A = 0.1 A; then each bar flies as the other did."""
    result = run(driver, "bars", two_bars())
    table, area = energy(result), 0.01
    force = np.array([step["interfaces"]["c"]["force"][0] for step in result.steps]) / area
    t = table["t"][1:]
    on = t[np.abs(force) > 1e-9]
    during = (t > 0.2) & (t < 2.0)
    left = np.array([step["interfaces"]["c"]["force"][0] for step in result.steps]).sum() * (t[1] - t[0]) / area
    verdicts.near("bars: duration of contact", (on[-1] - on[0] + t[1] - t[0]) / 2, 1, BAR_BOUND, "2 L / c")
    verdicts.near("bars: mean force", abs(force[during].mean()) / 0.1, 1, BAR_BOUND, "rho c v")
    verdicts.near("bars: velocity after", (abs(left) - 0.1) / 0.1, 1, BAR_BOUND, "minus the one before")
    verdicts.below("bars: growth of energy", growth(table), ENERGY_BOUND, "in any step")
    verdicts.below("bars: energy balance", np.abs(table["numerical"]).max() / total(table)[0], EXACT_BOUND, "work of contact counted")
    verdicts.below("bars: momentum", np.abs(table["momentum_x"]).max() / 1e-3, EXACT_BOUND, "none")
    base = total(table)[-1]
    for label, options, ranks in (("two ranks", (), 2), ("three ranks", (), 3), ("iterative", ("-solver", "iterative"), 1),
                                  ("augmented", ("-c_form", "augmented"), 1)):
        other = energy(run(driver, "bars", two_bars(), *options, label=f"bars_{label.replace(' ', '_')}", ranks=ranks))
        verdicts.below(f"bars, {label}: energy", abs(total(other)[-1] / base - 1), SAME_BOUND, "as on one rank, directly")
    condensed = [energy(run(driver, "bars_dual", two_bars(basis="dual"), *options, label=f"bars_dual_{k}")) for k, options in
                 enumerate(((), ("-unknowns", "displacements"), ("-unknowns", "displacements", "-solver", "iterative")))]
    for label, other in zip(("condensed", "condensed, iterative"), condensed[1:]):
        verdicts.below(f"bars, {label}: energy", abs(total(other)[-1] / total(condensed[0])[-1] - 1), SAME_BOUND, "as with multipliers")


def bounces(verdicts, driver):
    """A block and a ball thrown on an elastic base, without loads: the energy never grows."""
    cube = {"type": "box", "young": 1000, "poisson": 0.3, "density": 1, "small_strain": True}
    ball = {"ball": [0, 0, 0], "x": [0, 0.1, 0.2, 0.4, 0.7, 1], "y": [0, 0.1, 0.2, 0.4, 0.7, 1], "z": [-1, -0.9, -0.7, -0.4, 0], "velocity": [0, 0, -1]}
    cases = {
        "block": ({"lower": [0.2, 0.2, 1.02], "upper": [0.7, 0.8, 1.5], "cells": [3, 3, 3], "velocity": [0.3, 0.2, -1]},
                  {"lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [4, 4, 3]}, [], "base.zmax", "top.zmin", {"friction": 0.3}),
        "ball": (ball, {"lower": [0, 0, -1.6], "upper": [1.2, 1.2, -1.01], "cells": [7, 7, 3]}, ["sx", "sy"], "base.zmax", "top.zmin", {}),
    }
    for name, (top, base, more, nonmortar, mortar, interface) in cases.items():
        scene = {"schema": 1, "bodies": ["top", "base"], "top": {**cube, **top}, "base": {**cube, **base}, "dynamics": {"rho_inf": 1},
                 "supports": ["ground", *more], "ground": {"surface": "base.zmin", "components": ["x", "y", "z"]},
                 "interfaces": ["c"], "c": {"nonmortar": nonmortar, "mortar": mortar, **interface},
                 "steps": {"count": 60, "end": 0.3}, "output": {"vtu": "none", "csv": "none"}}
        for axis in "xy":
            if f"s{axis}" in more:
                scene[f"s{axis}"] = {"surface": [f"top.{axis}min", f"base.{axis}min"], "components": [axis]}
        table = energy(run(driver, f"bounce_{name}", scene))
        touched = table["contact_work"].min() < 0
        verdicts.true(f"bouncing {name}: it touches", touched and table["momentum_z"][-1] > -table["momentum_z"].max() , f"contact work {table['contact_work'].min():.3g}")
        verdicts.below(f"bouncing {name}: growth of energy", growth(table), ENERGY_BOUND, "in any step")
        verdicts.below(f"bouncing {name}: energy balance", np.abs(table["numerical"]).max() / total(table)[0], EXACT_BOUND, "all work counted")
        verdicts.below(f"bouncing {name}: given by contact", table["contact_gain"][-1] / total(table)[0], ENERGY_BOUND, "nothing")
    told = run(driver, "bounce_ball", scene, "-c_weights", "current", label="bounce_ball_current")
    table = energy(told)
    verdicts.at_least("bouncing ball, weights found anew: growth of energy", growth(table), ENERGY_BOUND, "what the warning is about")
    verdicts.true("bouncing ball, weights found anew: a warning", "contact gives the bodies" in told.text, "of what is measured")
    verdicts.near("bouncing ball, weights found anew: given by contact", table["contact_gain"][-1] / np.diff(total(table)).clip(0).sum(), 1, GIVEN_BOUND, "growth of energy")


def layer(verdicts, driver):
    """Where points decide K stores energy: what it gives back is no gain, and what contact gives beyond it is told with its cause."""
    cube = {"type": "box", "young": 1000, "poisson": 0.3, "density": 1, "small_strain": True}
    scene = {"schema": 1, "bodies": ["top", "base"], "top": {**cube, "lower": [0.2, 0.2, 1.02], "upper": [0.7, 0.8, 1.4], "cells": [2, 2, 2], "velocity": [0, 0, -1]},
             "base": {**cube, "lower": [0, 0, 0.4], "upper": [1, 1, 1], "cells": [3, 3, 2]}, "dynamics": {"rho_inf": 1},
             "supports": ["ground"], "ground": {"surface": "base.zmin", "components": ["x", "y", "z"]}, "interfaces": ["c"],
             "c": {"nonmortar": "base.zmax", "mortar": "top.zmin", "law": "none", "decision": "points", "basis": "dual", "weights": "reference"},
             "steps": {"count": 24, "end": 0.12}, "output": {"vtu": "none", "csv": "none"}}
    result = run(driver, "layer", scene)
    table = energy(result)
    store, given = table["contact_store"], table["contact_gain"]
    verdicts.at_least("points: what is stored", store.max() / total(table)[0], 1e-3, "by K")
    verdicts.below("points: energy beyond the first", total(table).max() / total(table)[0] - 1, ENERGY_BOUND, "never")
    grown = np.diff(total(table) + store).clip(0).sum()
    verdicts.near("points: given by contact", given[-1] / grown, 1, GIVEN_BOUND, "what bodies and store together gain")
    verdicts.true("points: a warning", "With `decision: points` it may" in result.text and "found anew" not in result.text, "of the right cause")
    still = energy(run(driver, "layer", {**scene, "c": {"nonmortar": "base.zmax", "mortar": "top.zmin", "law": "none"}}, label="layer_nodes"))
    verdicts.below("nodes: what is stored", np.abs(still["contact_store"]).max(), 0, "nothing")


SPHERE = {"ball": [0, 0, 0], "lower": [-0.5] * 3, "upper": [0.5] * 3}
SLAB = {"type": "box", "young": 200, "poisson": 0.3, "density": 1, "small_strain": True, "lower": [-0.8, -0.5, -0.8], "upper": [0.9, 0.5, -0.51], "cells": [11, 6, 2]}


def turning(verdicts, driver):
    """A soft ball that spins is thrown askew on a slab, so that it slides and rolls: contact gives no energy, in whatever it has of finite strain."""
    scene = {"schema": 1, "bodies": ["ball", "slab"], "slab": SLAB, "dynamics": {"rho_inf": 1},
             "ball": {"type": "box", **SPHERE, "cells": [4, 4, 4], "young": 200, "poisson": 0.3, "density": 1, "material": "neo_hooke",
                      "velocity": [1, 0.2, -1], "spin": [0, 4, 3]},
             "supports": ["ground"], "ground": {"surface": "slab.zmin", "components": ["x", "y", "z"]},
             "interfaces": ["c"], "c": {"nonmortar": "slab.zmax", "mortar": "rim", "friction": 0.02}, "surfaces": ["rim"],
             "rim": {"of": [f"ball.{axis}{end}" for axis in "xyz" for end in ("min", "max")], "within": [-9, -9, -9, 9, 9, 9]},
             "steps": {"count": 50, "end": 0.25}, "output": {"vtu": "none", "csv": "none"}}
    result = run(driver, "turning", scene)
    table = energy(result)
    verdicts.at_least("a ball that spins: friction", table["friction_dissipation"][-1] / total(table)[0], 0.01, "it slides")
    verdicts.at_least("a ball that spins: it flies off", table["momentum_z"][-1] / -table["momentum_z"][0], 0.3, "upwards")
    verdicts.below("a ball that spins: given by contact", table["contact_gain"][-1] / total(table)[0], ENERGY_BOUND, "nothing")
    verdicts.below("a ball that spins: work of contact", np.diff(table["contact_work"]).max() / total(table)[0], ENERGY_BOUND, "never positive")
    told = run(driver, "turning", scene, "-c_weights", "committed", label="turning_committed")
    verdicts.true("a ball that spins, overlaps parted: a warning", "contact gives the bodies" in told.text, "of what is measured")


# --- rigid bodies -------------------------------------------------------------------------------------------------------
# Of a rule of second order whose equations Newton's method solves to 1e-11.
RIGID_BOUND = 1e-9


def top(verdicts, driver):
    """A brick that tumbles about its middle axis: energy, moment of momentum, and where it points, against many steps."""
    brick = {"type": "rigid", "from": "box", "lower": [-1, -0.5, -0.25], "upper": [1, 0.5, 0.25], "cells": [1, 1, 1], "reference": [0, 0, 0],
             "density": 3, "velocity": [1, 0, 0.5], "spin": [0.3, 4, 0.1]}
    scene = {"schema": 1, "bodies": ["brick"], "brick": brick, "dynamics": {"rho_inf": 1}, "steps": {"count": 1}, "output": {"vtu": "none"}}
    mass, inertia = 3.0, np.diag([1 + 0.25, 4 + 0.25, 4 + 1]) / 4
    spin = np.array(brick["spin"])
    ends = []
    for n in (80, 160, 320):
        result = run(driver, "top", scene, "-steps_count", str(n), "-steps_end", "2", label=f"top_{n}")
        table, six = energy(result), result.steps[-1]["rigid"]["brick"]
        ends.append(np.array(six["turned"]))
        verdicts.near(f"top, {n} steps: energy at the start", table["kinetic"][0], (mass * 1.25 + spin @ inertia @ spin) / 2, RIGID_BOUND, "of a brick")
        verdicts.below(f"top, {n} steps: energy", np.abs(total(table) / total(table)[0] - 1).max(), RIGID_BOUND, "kept at any step")
        change = max(np.abs(table[f"angular_{axis}"] - table[f"angular_{axis}"][0]).max() for axis in "xyz")
        verdicts.below(f"top, {n} steps: moment of momentum", change / np.linalg.norm(inertia @ spin), RIGID_BOUND, "kept at any step")
        verdicts.below(f"top, {n} steps: place", np.abs(np.array(six["displacement"]) - [2, 0, 1]).max(), RIGID_BOUND, "it flies straight on")
    errors = [np.linalg.norm(a - b) for a, b in zip(ends, ends[1:])]
    verdicts.at_least("top: it tumbles", np.abs(ends[-1].reshape(3, 3) @ [0, 1, 0] - [0, 1, 0]).max(), 0.5, "about no axis of its own")
    verdicts.near("top: order in dt", math.log2(errors[0] / errors[1]), 2, ORDER_BOUND, "80, 160, 320 steps")


def thrown_ball(**more):
    """A rigid ball of facets that spins and falls on an elastic slab."""
    return {"schema": 1, "bodies": ["ball", "slab"], "slab": SLAB, "dynamics": {"rho_inf": 1},
            "ball": {"type": "rigid", "from": "box", **SPHERE, "cells": [4, 4, 4], "reference": [0, 0, 0], "density": 2, "velocity": [0.5, 0.1, -1], "spin": [0, 6, 2]},
            "supports": ["ground"], "ground": {"surface": "slab.zmin", "components": ["x", "y", "z"]},
            "interfaces": ["c"], "c": {"nonmortar": "slab.zmax", "mortar": "rim", "friction": 0.3}, "surfaces": ["rim"],
            "rim": {"of": [f"ball.{axis}{end}" for axis in "xyz" for end in ("min", "max")], "within": [-9, -9, -9, 9, 9, 9]},
            "steps": {"count": 60, "end": 0.3}, "output": {"vtu": "none", "csv": "none"}, **more}


def thrown(verdicts, driver):
    table = energy(run(driver, "thrown", thrown_ball()))
    verdicts.at_least("rigid ball: it flies off", table["momentum_z"][-1] / -table["momentum_z"][0], 0.3, "upwards")
    verdicts.at_least("rigid ball: friction", table["friction_dissipation"][-1] / total(table)[0], 0.01, "it slides and rolls")
    verdicts.below("rigid ball: growth of energy", growth(table), ENERGY_BOUND, "in any step")
    verdicts.below("rigid ball: given by contact", table["contact_gain"][-1] / total(table)[0], ENERGY_BOUND, "nothing")
    verdicts.below("rigid ball: energy balance", np.abs(table["numerical"]).max() / total(table)[0], EXACT_BOUND, "all work counted")
    two = energy(run(driver, "thrown", thrown_ball(), label="thrown_2", ranks=2))
    verdicts.below("rigid ball, two ranks: energy", abs(total(two)[-1] / total(table)[-1] - 1), SAME_BOUND, "as on one")


ROLLING_BOUND = 0.01
# A shape that moves freely has weights of now, whose forces are no gradients of the gaps that they close: 4e-5 here.
SHAPE_GAIN = 1e-4


def rolling(verdicts, driver):
    """A rigid cylinder rolls down a layer that is stiff beside its weight, gravity turned: 2/3 g sin."""
    angle, g, radius, mass = math.radians(20), 9.81, 0.5, 2.0
    scene = {"schema": 1, "bodies": ["roll", "layer"],
             "roll": {"type": "rigid", "from": "analytic", "shape": "cylinder", "point": [0, 0, radius], "direction": [0, 1, 0], "radius": radius,
                      "reference": [0, 0, radius], "mass": mass, "inertia": [1, mass * radius**2 / 2, 1]},
             "layer": {"type": "box", "young": 1e5, "poisson": 0.3, "density": 1, "small_strain": True, "lower": [-0.2, -0.1, -0.1], "upper": [0.5, 0.1, 0], "cells": [40, 1, 2]},
             "dynamics": {"rho_inf": 1, "stiffness_damping": 2e-3}, "supports": ["ground", "guide"], "ground": {"surface": "layer.zmin", "components": ["x", "y", "z"]},
             "guide": {"body": "roll", "components": ["y", "rx", "rz"]}, "loads": ["weight"],
             "weight": {"body": "roll", "gravity": [g * math.sin(angle), 0, -g * math.cos(angle)], "curve": [0, 1, 10, 1]},
             "interfaces": ["c"], "c": {"nonmortar": "layer.zmax", "mortar": "roll.surface", "friction": 0.8, "new_contact": "friction"}, "steps": {"count": 160, "end": 0.4},
             "output": {"vtu": "none", "csv": "none"}}
    result = run(driver, "rolling", scene)
    table = energy(result)
    at = lambda k: np.array([*result.steps[k]["rigid"]["roll"]["displacement"], *result.steps[k]["rigid"]["roll"]["rotation"]])
    way, turn = (at(-1) - at(39))[0], (at(-1) - at(39))[4]
    t = np.array([step["t"] for step in result.steps])
    x = np.array([at(k)[0] for k in range(len(t))])
    slope = 2 * np.polyfit(t[40:], x[40:], 2)[0]
    verdicts.near("a cylinder rolls down: acceleration", slope / (g * math.sin(angle)), 2 / 3, ROLLING_BOUND, "2/3 g sin")
    verdicts.near("a cylinder rolls down: its turn", turn * radius / way, 1, ROLLING_BOUND, "the way over the radius")
    verdicts.below("a cylinder rolls down: given by contact", table["contact_gain"][-1] / table["kinetic"].max(), SHAPE_GAIN, "a shape that moves freely")
    why = result.summary["weights"]["c"]
    said = why["weights"] == "current" and "whose frame has equations" in why["why"] and why["why"] in result.text
    verdicts.true("a cylinder rolls down: weights that do not conserve, and why", said, "told at the start, and in summary.json")


# --- friction -----------------------------------------------------------------------------------------------------------
ANGLE, MU, GRAVITY = math.radians(30), 0.3, 9.81


def incline(verdicts, driver):
    """A block slides down a plane, gravity turned instead of it; damping ends its shaking."""
    scene = {"schema": 1, "bodies": ["block", "ground"], "block": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 0.5], "cells": [3, 2, 2], "young": 1e4, "poisson": 0.3, "density": 1},
             "ground": {"type": "analytic", "shape": "plane", "point": [0, 0, 0], "direction": [0, 0, 1]},
             "dynamics": {"rho_inf": 1, "stiffness_damping": 0.01}, "supports": ["still"], "still": {"body": "ground", "components": ["x", "y", "z"]},
             "loads": ["weight"], "weight": {"body": "block", "gravity": [GRAVITY * math.sin(ANGLE), 0, -GRAVITY * math.cos(ANGLE)], "curve": [0, 1, 10, 1]},
             "interfaces": ["c"], "c": {"nonmortar": "block.zmin", "mortar": "ground.surface", "friction": MU},
             "steps": {"count": 200, "end": 2}, "probes": ["corner"], "corner": {"body": "block", "point": [0, 0, 0]}, "output": {"vtu": "none", "csv": "none"}}
    table = energy(run(driver, "incline", scene))
    p, t = table["momentum_x"] / 0.5, table["t"]
    slope = (p[-1] - p[-21]) / (t[-1] - t[-21])
    verdicts.near("incline: acceleration", slope / (GRAVITY * (math.sin(ANGLE) - MU * math.cos(ANGLE))), 1, INCLINE_BOUND, "g (sin - mu cos)")
    held = run(driver, "incline", scene, "-c_friction", "0.7", label="incline_sticks")
    crept = np.abs(np.array(held.steps[-1]["probes"]["corner"]) - held.steps[-21]["probes"]["corner"]).max()
    verdicts.below("incline: it sticks", crept, INCLINE_BOUND, "mu above tan: no creep in a tenth of the time")


# --- the driver ---------------------------------------------------------------------------------------------------------
def tangents(verdicts, driver):
    block = {"type": "box", "young": 10, "poisson": 0.3, "density": 1}
    scene = {"schema": 1, "bodies": ["upper", "lower"], "upper": {**block, "lower": [0.1, 0.1, 1], "upper": [0.8, 0.9, 1.4], "cells": [2, 2, 1], "velocity": [0.5, 0.2, -0.5], "spin": [0.2, 0.1, 0], "about": [0.4, 0.5, 1]},
             "lower": {**block, "lower": [0, 0, 0.5], "upper": [1, 1, 1], "cells": [3, 3, 1]}, "dynamics": {"rho_inf": 1},
             "supports": ["ground"], "ground": {"surface": "lower.zmin", "components": ["x", "y", "z"]},
             "loads": ["press"], "press": {"surface": "upper.zmax", "pressure": 0.5, "follower": True},
             "interfaces": ["c"], "c": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "friction": 0.3}, "steps": {"times": [0.05, 0.1]}, "output": {"vtu": "none", "csv": "none"}}
    for label, options in {"rho_inf 1": (), "rho_inf 0.5, neo-Hooke": ("-dynamics_rho_inf", "0.5", "-upper_material", "neo_hooke"),
                           "damped": ("-dynamics_stiffness_damping", "0.02", "-dynamics_mass_damping", "0.5")}.items():
        result = run(driver, "tangents", scene, "-test_jacobian_blocks", *options, label="tangents_" + label.replace(" ", "_").replace(",", ""))
        tests = [test for step in result.steps for test in step["jacobian_tests"] if test["switches"] == 0]
        errors = [block["error"] / block["norm"] for test in tests for block in test["blocks"] if block["norm"]]
        verdicts.below(f"tangent, {label}", worst(errors), JACOBIAN_BOUND, f"{len(tests)} iterates against central differences")


    result = run(driver, "tangents_rigid", thrown_ball(steps={"times": [0.01, 0.02, 0.03]}), "-test_jacobian_blocks")
    tests = [test for step in result.steps for test in step["jacobian_tests"] if test["switches"] == 0]
    errors = [block["error"] / block["norm"] for test in tests for block in test["blocks"] if block["norm"]]
    verdicts.below("tangent, a rigid ball", worst(errors), JACOBIAN_BOUND, f"{len(tests)} iterates against central differences")


def rolled_back(verdicts, driver):
    """Steps that fail leave nothing behind: the run that was cut back, and one with the same steps."""
    scene = two_bars(n=6, count=4)
    scene["left"]["material"] = scene["right"]["material"] = "neo_hooke"
    cut = run(driver, "cut", scene, "-snes_max_it", "3", "-left_velocity", "0.5,0,0", "-steps_predictor", "false")
    del scene["steps"]
    scene["steps"] = {"times": [step["t"] for step in cut.steps], "predictor": False}
    again = run(driver, "cut_again", scene, "-snes_max_it", "3", "-left_velocity", "0.5,0,0")
    verdicts.true("rollback: steps were cut back", cut.summary["cutbacks"] > 0 and again.summary["cutbacks"] == 0, f"{cut.summary['cutbacks']}")
    same = (cut.directory / "energy.csv").read_text() == (again.directory / "energy.csv").read_text()
    verdicts.true("rollback: equal bits", same, f"{len(cut.steps)} steps")


def overlap_at_the_start(verdicts, driver):
    """Bars at rest that overlap: conserving weights leave it, which is told; weights of now part it, and what that gives is measured by what the
    bodies have afterwards, for before they have nothing."""
    scene = two_bars(n=3, count=2)
    del scene["left"]["velocity"], scene["right"]["velocity"]
    for ranks in (1, 2):
        for lower, told in ((0.99, True), (1, False), (1 - 1e-7, False)):
            scene["right"].update(lower=[lower, 0, 0], upper=[lower + 1, 0.1, 0.1])
            kept = run(driver, "overlap", scene, ranks=ranks, label=f"overlap_{ranks}_{lower}")
            verdicts.true(f"overlap of {1 - lower:.2g} at the start, {ranks} ranks", ("c overlap at the start, by 0.01 at node" in kept.text) == told, "told" if told else "rounding")
    scene["right"].update(lower=[0.99, 0, 0], upper=[1.99, 0.1, 0.1])
    parted = run(driver, "overlap", scene, "-c_weights", "current", label="overlap_parted")
    verdicts.true("an overlap parted from rest: a warning", "contact gives the bodies 1 of their energy" in parted.text, "all of it")
    verdicts.true("an overlap parted from rest: no other", "overlap at the start" not in parted.text, "weights of now press")


def spins_too_fast(verdicts, driver):
    """A brick that spins about an axis of its own: a step of a radian makes 2 atan(1/2) of it, which is told; one of a third of a radian is not."""
    scene = {"schema": 1, "bodies": ["brick"], "brick": {**BRICK, "spin": [0, 0, 1]}, "dynamics": {"rho_inf": 1}, "steps": {"count": 1, "end": 2}, "output": {"vtu": "none"}}
    for count, told in ((2, True), (6, False)):
        result = run(driver, "spins", scene, "-steps_count", str(count), label=f"spins_{count}")
        turn = 2 * math.atan(1 / count)
        verdicts.near(f"a brick that spins, {count} steps: its turn", np.arctan2(*np.array(result.steps[0]["rigid"]["brick"]["turned"])[[3, 0]]), turn, RIGID_BOUND, "2 atan(w dt / 2)")
        words = f"turns {100 * (1 - turn * count / 2):.2g} % too slowly"
        verdicts.true(f"a brick that spins, {count} steps: a warning", result.text.count("too slowly") == told and (words in result.text) == told, words if told else "none")


def inertia_unasked(verdicts, driver):
    """Mass and inertia are properties of a rigid body: they may stand where nothing asks for them, and are looked at there, too."""
    brick = {**{key: value for key, value in BRICK.items() if key != "density"}, "mass": 1, "inertia": [1, 1, 1]}
    still = {"supports": ["still"], "still": {"body": "brick", "components": ["x", "y", "z", "rx", "ry", "rz"]}}
    for label, more in (("statics", {}), ("held in all", {"dynamics": {"rho_inf": 1}})):
        scene = {"schema": 1, "bodies": ["brick"], "brick": brick, **still, **more, "steps": {"count": 1}, "output": {"vtu": "none"}}
        run(driver, "unasked", scene, label=f"unasked_{label.replace(' ', '_')}")
        scene["brick"] = {**brick, "inertia": [1, 1, 3]}
        text = run(driver, "unasked", scene, label=f"unasked_{label.replace(' ', '_')}_bad", expect=1).text
        verdicts.true(f"inertia where nothing asks for it, {label}", "brick.inertia: no body has it" in text, "taken, and one that no body has refused")


BRICK = {"type": "rigid", "from": "box", "lower": [0, 0, 5], "upper": [1, 1, 6], "cells": [1, 1, 1], "reference": [0.5, 0.5, 5.5], "density": 1}
WITH_BRICK = {"bodies": ["left", "right", "brick"]}
REFUSED = {
    "rho_inf": ({"dynamics": {"rho_inf": 1.5}}, "dynamics.rho_inf"),
    "damping without the scheme": ({"dynamics": {"rho_inf": None, "mass_damping": 1}}, "dynamics.rho_inf"),
    "negative damping": ({"dynamics": {"rho_inf": 1, "mass_damping": -1}}, "dynamics.mass_damping"),
    "velocity in statics": ({"dynamics": None, "left": {"velocity": [1, 0, 0]}}, "left.velocity"),
    "point without spin": ({"left": {"about": [0, 0, 0]}}, "left.about"),
    "no density": ({"left": {"density": None}}, "left.density"),
    "cells inside out at the start": ({"dynamics": {"rho_inf": 0.5}, "left": {"material": "neo_hooke"}, "supports": ["s"],
                                       "s": {"surface": "left.xmin", "components": ["x"], "value": [2, 0, 0], "curve": [0, 1, 1, 1]}}, "dynamics.rho_inf"),
    "no mass of a rigid body": ({**WITH_BRICK, "brick": {**BRICK, "density": None}}, "brick.mass"),
    "no inertia of a rigid body": ({**WITH_BRICK, "brick": {**BRICK, "density": None, "mass": 1}}, "brick.inertia"),
    "mass and density": ({**WITH_BRICK, "brick": {**BRICK, "mass": 1}}, "brick.density"),
    "an inertia that no body has": ({**WITH_BRICK, "brick": {**BRICK, "density": None, "mass": 1, "inertia": [1, 1, 3]}}, "brick.inertia"),
    "a reference point beside the centre": ({**WITH_BRICK, "brick": {**BRICK, "reference": [0.5, 0.5, 5]}}, "brick.reference"),
    "a rigid body turned in part": ({**WITH_BRICK, "brick": BRICK, "supports": ["push"], "push": {"body": "brick", "components": ["rx"], "rotate": [1, 0, 0]}}, "push.rotate"),
    "rho_inf of a free rigid body": ({**WITH_BRICK, "brick": BRICK, "dynamics": {"rho_inf": 0.9}}, "dynamics.rho_inf"),
}


def refused(verdicts, driver):
    for name, (changes, key) in REFUSED.items():
        scene = two_bars(n=2, count=1)
        for map_, values in changes.items():
            if values is None:
                del scene[map_]
            elif isinstance(values, dict):
                scene[map_] = {k: v for k, v in {**scene.get(map_, {}), **values}.items() if v is not None}
            else:
                scene[map_] = values
        if name == "velocity in statics":
            del scene["right"]["velocity"]
        done = run(driver, "refused_" + name.replace(" ", "_"), scene, expect=1)
        verdicts.true(f"refused, {name}", f"{key}:" in done.text and "PETSC ERROR" not in done.text, key)
    scene = two_bars(n=2, count=1)
    scene["c"] = {**scene["c"], "weights": "conserving", "offset": 0.1}
    done = run(driver, "refused_offsets", scene, expect=3)
    taken = run(driver, "offsets", two_bars(n=2, count=1, offset=-0.01))
    why = taken.summary["weights"]["c"]
    verdicts.true("offsets: weights of now, and why", why["weights"] == "current" and "offsets" in why["why"], "the default asks the library")
    plain = run(driver, "plain", two_bars(n=2, count=1)).summary["weights"]["c"]
    verdicts.true("by default weights conserve", plain == {"weights": "conserving"}, "nothing is to be said")
    verdicts.true("refused, weights with offsets", "`weights: conserving`" in done.text and "offsets" in done.text, "the library's sentence")
