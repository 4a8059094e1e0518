"""Supports that change with `dynamics`: what is let go moves on with the velocity that it has, what is caught stops where it is. Against
closed forms, against supports that hold from start to end, on ranks, across a restart, beside contact."""

import math

import numpy as np

from dynamics import ENERGY_BOUND, ORDER_BOUND, energy, total
from jacobian import whole_matrix
from restart import BITS, BOX, COSTS, KEEP, pad
from scene import write

# Closed forms of the scheme: Newton's tolerance of 1e-11 of the forces, and rounding, over 20 steps.
EXACT_BOUND = 1e-9
# Two ways to one answer, each to Newton's tolerance, of which steps add up.
SAME_BOUND = 1e-8
ELASTIC = {**BOX, "density": 2}
GRAVITY = 10.0


def timed_dynamics(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    thrown(verdicts, driver)
    swinging(verdicts, driver)
    orders(verdicts, driver)
    to_the_end(verdicts, driver)
    dropped(verdicts, driver)
    gone_on(verdicts, driver)
    cut_back(verdicts, driver)


def run(driver, name, scene, *options, **more):
    return driver.run(write(scene, driver.output / f"{name}.yaml"), *options, label=more.pop("label", name), **more)


def places(result, name="corner"):
    return {round(step["t"], 9): np.array(step["probes"][name]) for step in result.steps}


def thrown(verdicts, driver):
    """A body is carried along by a support, which lets it go at t = 0.5, where its curve ends: it flies on as fast as it was carried, under its
    weight, until another support catches it at t = 1 and moves it up from t = 1.5 on. Uniform fields, which the scheme follows exactly."""
    speed = np.array([0.6, 0.2, 0.4])
    scene = {
        "schema": 1,
        "bodies": ["block"],
        "block": {**ELASTIC, "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [2, 2, 2]},
        "dynamics": {"rho_inf": 1},
        "supports": ["hand", "catch"],
        "hand": {"body": "block", "components": ["x", "y", "z"], "value": [*(speed / 2)], "curve": [0, 0, 0.5, 1], "until": 0.5},
        "catch": {"body": "block", "components": ["x", "y", "z"], "value": [0, 0, 0.3], "curve": [1.5, 0, 2, 1], "from": 1},
        "loads": ["weight"],
        "weight": {"body": "block", "gravity": [0, 0, -GRAVITY], "curve": [0, 1, 2, 1]},
        "steps": {"end": 2, "count": 20},
        "probes": ["corner"],
        "corner": {"body": "block", "point": [0, 0, 0]},
        "output": {"vtu": "none"},
    }
    mass, fall = 2.0, np.array([0, 0, -GRAVITY])
    caught = speed * 1 + fall / 2 * 0.5**2
    for rho, ranks in ((1, 1), (1, 2), (0.5, 1), (0.5, 2)):
        name = f"thrown, rho_inf {rho}, {ranks} ranks"
        result = run(driver, "thrown", scene, "-dynamics_rho_inf", rho, label=f"thrown_{rho}_{ranks}", ranks=ranks)
        found, table = places(result), energy(result)
        error = 0
        for t, u in found.items():
            exact = speed * t + (fall / 2 * (t - 0.5) ** 2 if t > 0.5 else 0) if t <= 1 else caught + np.array([0, 0, 0.6 * max(t - 1.5, 0)])
            error = max(error, np.abs(u - exact).max())
        verdicts.below(f"{name}: place", error, EXACT_BOUND, "carried, in flight, caught and moved")
        at = {round(step["t"], 9): k + 1 for k, step in enumerate(result.steps)}
        for t, motion in ((0.5, speed), (1, speed + 0.5 * fall), (1.1, 0 * fall), (1.4, 0 * fall), (2, np.array([0, 0, 0.6]))):
            exact = mass * motion @ motion / 2
            verdicts.near(f"{name}: energy of motion at {t}", table["kinetic"][at[t]], exact, EXACT_BOUND, "m v^2 / 2", scale=mass * speed @ speed)
        verdicts.below(f"{name}: energy balance", np.abs(table["numerical"]).max() / total(table).max(), EXACT_BOUND, "the catch has taken what it stopped")
        held = {t: step["reactions"]["catch"][2] for t, step in zip(found, result.steps) if 1.15 < t < 1.45}
        verdicts.near(f"{name}: reaction", min(held.values()), mass * GRAVITY, EXACT_BOUND, "the weight, while it is at rest", scale=mass * GRAVITY)


def swinging(verdicts, driver):
    """A bar of one cell is drawn at its end, evenly, and let go: one mass on one spring, of which the midpoint rule turns (u, v / w) by 2 atan(w dt / 2) in a
    step. Where the reaction fades its work is that of a load."""
    young, density, length, pull, dt = 1000.0, 2.0, 2.0, 0.1, 0.01
    scene = {
        "schema": 1,
        "bodies": ["bar"],
        "bar": {**BOX, "young": young, "poisson": 0, "density": density, "lower": [0, 0, 0], "upper": [length, 1, 1], "cells": [1, 1, 1]},
        "dynamics": {"rho_inf": 1},
        "supports": ["wall", "rails", "draw"],
        "wall": {"surface": "bar.xmin", "components": ["x", "y", "z"]},
        "rails": {"body": "bar", "components": ["y", "z"]},
        "draw": {"surface": "bar.xmax", "components": ["x"], "value": [pull, 0, 0], "curve": [0, 0, 0.1, 1], "until": 0.1},
        "steps": {"end": 0.3, "count": 30},
        "probes": ["end"],
        "end": {"body": "bar", "point": [length, 0, 0]},
        "output": {"vtu": "none"},
    }
    w = math.sqrt(3 * young / density) / length
    angle, speed = 2 * math.atan(w * dt / 2), pull / 0.1
    for name, options, ranks in (("drawn", (), 1), ("drawn, 2 ranks", (), 2), ("drawn, by multigrid", ("-solver", "iterative"), 1)):
        result = run(driver, "swinging", scene, *options, label=name.replace(" ", "_").replace(",", ""), ranks=ranks)
        found = places(result, "end")
        error = 0
        for t, u in found.items():
            k = round(t / dt) - 10
            error = max(error, abs(u[0] - (pull * math.cos(k * angle) + speed / w * math.sin(k * angle) if k > 0 else speed * t)))
        verdicts.below(f"{name} and let go: the end", error / pull, EXACT_BOUND, "the swing of one mass on one spring")
        table = energy(result)
        verdicts.below(f"{name} and let go: energy", np.ptp(total(table)[10:]) / total(table)[10], ENERGY_BOUND, "kept from then on")
    scene["draw"]["fade"] = 0.05
    result = run(driver, "fading", scene, "-snes_test_jacobian")
    table = energy(result)
    verdicts.below("drawn, a reaction that fades: energy balance", np.abs(table["numerical"]).max() / total(table).max(), EXACT_BOUND, "it works as a load does")
    verdicts.at_least("drawn, a reaction that fades: its work", abs(table["external_work"][-1]) / total(table)[10], 0.1, "of the energy of the bar")
    left = [step["fading"]["draw"][0] for step in result.steps[10:14]]
    force = result.steps[9]["reactions"]["draw"][0]
    verdicts.below("drawn, a reaction that fades: what is left", max(abs(f / force - (1 - (k + 1) / 5)) for k, f in enumerate(left)), EXACT_BOUND, "less by a fifth a step")
    whole_matrix(verdicts, "drawn, a reaction that fades", result)


def orders(verdicts, driver):
    """A bar whose end is waved and let go in full motion: displacement and momentum at the end, on three steps. What is let go starts all
    that the mesh can swing with, the fastest by 0.1 radians in the longest of them."""
    wave = [value for k in range(65) for value in (k / 128, math.sin(4 * k / 128) ** 2)]
    scene = {
        "schema": 1,
        "bodies": ["bar"],
        "bar": {**BOX, "young": 4, "density": 1, "lower": [0, 0, 0], "upper": [1, 0.2, 0.2], "cells": [4, 1, 1]},
        "dynamics": {"rho_inf": 1},
        "supports": ["clamp", "hand"],
        "clamp": {"surface": "bar.xmin", "components": ["x", "y", "z"]},
        "hand": {"surface": "bar.xmax", "components": ["x", "y"], "value": [0.1, 0.05, 0], "curve": wave, "until": 0.5},
        "steps": {"count": 32},
        "probes": ["tip"],
        "tip": {"body": "bar", "point": [1, 0, 0]},
        "output": {"vtu": "none", "csv": "none"},
    }
    for rho in (1, 0.5):
        ends = []
        for n in (256, 512, 1024):
            result = run(driver, "orders", scene, "-steps_count", n, "-dynamics_rho_inf", rho, label=f"orders_{rho}_{n}")
            table = energy(result)
            ends.append(np.array([*result.steps[-1]["probes"]["tip"], *(table[f"momentum_{axis}"][-1] for axis in "xyz")]))
        differences = [np.linalg.norm(a - b) for a, b in zip(ends, ends[1:])]
        verdicts.near(f"waved and let go, order in dt, rho_inf {rho}", math.log2(differences[0] / differences[1]), 2, ORDER_BOUND, "256, 512, 1024 steps")


def to_the_end(verdicts, driver):
    """A support that is let go at the end of the run does what one does that holds from start to end: on a face that contact and waves reach, and that turns."""
    wave = [value for k in range(17) for value in (k / 8, math.sin(0.7 * k / 8))]
    block = {**BOX, "density": 0.5}
    moved = pad(
        upper=block,
        lower=block,
        dynamics={"rho_inf": 1},
        grip={"value": [0.2, 0.03, -0.02], "curve": wave, "rotate": [0, 0, 0.05], "rotate_curve": [0, 0, 2, 1]},
        steps={"times": [k / 8 for k in range(1, 17)]},
    )
    for name, options in {
        "rho_inf 1": (),
        "rho_inf 0.6": ("-dynamics_rho_inf", 0.6),
        "damped": ("-dynamics_rho_inf", 0.8, "-dynamics_mass_damping", 0.2, "-dynamics_stiffness_damping", 0.01),
    }.items():
        both = []
        for until in (None, 2):
            scene = pad(**moved) if until is None else pad(**{**moved, "grip": {**moved["grip"], "until": until}})
            both.append(run(driver, "to_the_end", scene, *options, "-output_vtu", "none", label=f"to_the_end_{name.replace(' ', '_')}_{until}"))
        tables = [energy(result) for result in both]
        for column in ("kinetic", "strain", "support_work", "contact_work", "damping"):
            apart = np.abs(tables[0][column] - tables[1][column]).max() / total(tables[0]).max()
            verdicts.below(f"held to the end, {name}: {column}", apart, SAME_BOUND, "as without `until`")
        scale = max(np.abs(step["reactions"]["grip"]).max() for step in both[0].steps)
        apart = max(np.abs(np.array(a["reactions"]["grip"]) - b["reactions"]["grip"]).max() for a, b in zip(*(result.steps for result in both)))
        verdicts.below(f"held to the end, {name}: reactions", apart / scale, SAME_BOUND, "as without `until`")


def falling(start):
    """A block above a base, which falls from t = start on."""
    hold = {"surface": "upper.zmax", "components": ["x", "y", "z"], "until": start}
    scene = pad(
        upper={**BOX, "density": 2, "lower": [0.1, 0.1, 0.005], "upper": [1.1, 0.9, 0.505]},
        lower={**BOX, "density": 2},
        dynamics={"rho_inf": 1},
        contact={"friction": 0.2},
        supports=["ground", "hold"] if start else ["ground"],
        loads=["weight"],
        weight={"body": "upper", "gravity": [0.5, 0, -GRAVITY], "curve": [start, 1, start + 0.1, 1] if not start else [start - 1e-3, 0, start, 1]},
        steps={"times": [round(start + 0.005 * k, 9) for k in range(0 if start else 1, 21)]},
        **({"hold": hold} if start else {}),
    )
    del scene["grip"]
    return scene


def dropped(verdicts, driver):
    """A block that is let go at t = 0.25 falls on a base as the same one does that is free from the start, a quarter later."""
    late, free = (run(driver, f"dropped_{start}", falling(start)) for start in (0.25, 0))
    tables = [energy(late), energy(free)]
    for column in ("kinetic", "strain", "contact_work", "external_work"):
        apart = np.abs(tables[0][column][1:] - tables[1][column]).max() / total(tables[1]).max()
        verdicts.below(f"dropped: {column}", apart, SAME_BOUND, "as of the block that is free from the start")
    verdicts.at_least("dropped: pressed", max(step["interfaces"]["contact"]["force"][2] for step in late.steps), 1, "it meets the base")


def beam(**steps):
    """A rubber beam whose end is bent, let go, caught while it swings, moved and let go again."""
    return {
        "schema": 1,
        "bodies": ["beam"],
        "beam": {**ELASTIC, "lower": [0, 0, 0], "upper": [4, 1, 1], "cells": [8, 1, 2], "material": "neo_hooke"},
        "dynamics": {"rho_inf": 1},
        "supports": ["foot", "bend", "again"],
        "foot": {"surface": "beam.xmin", "components": ["x", "y", "z"]},
        "bend": {"surface": "beam.xmax", "components": ["x", "z"], "value": [-0.2, 0, 1], "curve": [0, 0, 0.4, 1], "until": 0.4, "fade": 0.1},
        "again": {"surface": "beam.xmax", "components": ["x", "z"], "value": [0, 0, 0.2], "curve": [0.7, 0, 0.9, 1], "from": 0.7, "until": 0.9},
        "steps": steps,
        "probes": ["end"],
        "end": {"body": "beam", "point": [4, 0, 0]},
    }


def gone_on(verdicts, driver):
    """From restart files before, at and after each change, with both kinds of schemes."""
    for rho in (1, 0.7):
        path, options = write(beam(end=1.2, count=24), driver.output / "gone_on.yaml"), ("-dynamics_rho_inf", rho, *BITS)
        whole = driver.run(path, *options, *KEEP, label=f"gone_on_{rho}")
        found = places(whole, "end")
        verdicts.below(f"caught, rho_inf {rho}: moved from where it was", np.abs(found[0.9] - found[0.7] - [0, 0, 0.2])[[0, 2]].max(), EXACT_BOUND, "while it is held")
        other = driver.run(path, *options, ranks=3, label=f"gone_on_{rho}_ranks")
        apart = max(np.abs(u - v).max() for u, v in zip(found.values(), places(other, "end").values()))
        verdicts.below(f"caught, rho_inf {rho}: 1 and 3 ranks", apart, SAME_BOUND, "the same")
        for step in (7, 8, 9, 14, 18):
            again = driver.run(path, *options, *KEEP, "-restart", whole.directory / f"restart_{step}.bin", label="gone_on_again")
            differ = [key for key in whole.summary if key not in COSTS and whole.summary[key] != again.summary.get(key)]
            verdicts.true(f"caught, rho_inf {rho}, restart from step {step}: bits", not differ, "; ".join(differ) or "those of the run that goes through")


def cut_back(verdicts, driver):
    """Steps that fail beside a change leave nothing behind: the run that was cut back, and one with the same steps."""
    for rho in (1, 0.7):
        options = ("-snes_max_it", 3, "-dynamics_rho_inf", rho)
        cut = run(driver, "cut", beam(times=[0.2, 0.4, 0.7, 0.9, 1.2], predictor=False), *options, label=f"cut_{rho}")
        again = run(driver, "cut_again", beam(times=[step["t"] for step in cut.steps], predictor=False), *options, label=f"cut_again_{rho}")
        verdicts.true(f"cut back, rho_inf {rho}: steps were", cut.summary["cutbacks"] > 0 and again.summary["cutbacks"] == 0, f"{cut.summary['cutbacks']}")
        for name in ("bend", "again"):
            verdicts.true(f"cut back, rho_inf {rho}: '{name}' ends in time", any(abs(step["t"] - t) < 1e-12 for step in cut.steps for t in ([0.4] if name == "bend" else [0.9])), "a step ends there")
        same = (cut.directory / "energy.csv").read_text() == (again.directory / "energy.csv").read_text()
        verdicts.true(f"cut back, rho_inf {rho}: equal bits", same, f"{len(cut.steps)} steps")
