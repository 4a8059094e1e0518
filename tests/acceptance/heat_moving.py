"""Heat with tools, rigid or in closed form, of a given temperature or with one that follows from what they are given, and heat with
`dynamics`: against closed forms, against meshed bodies, against loads; what friction makes is what supports and tools take."""

import numpy as np

from dynamics import energy, total
from heat import BALANCE_BOUND, COLD, CONDUCTIVITY, DISSIPATION_BOUND, EXACT_BOUND, HOT, TURNS_BOUND, two_bars
from restart import BITS, COSTS, KEEP
from scene import write

# Two ways to one answer, each to Newton's tolerance.
SAME_BOUND = 1e-8
CONTACT = {"conductance_constant": 0.5, "conductance_reach": 1.0}


def heat_moving(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    given(verdicts, driver)
    stores(verdicts, driver)
    rubbed(verdicts, driver)
    expands(verdicts, driver)
    heated(verdicts, driver)
    slides(verdicts, driver)
    refused(verdicts, driver)


def on_tool(kind, **interface):
    """The upper bar alone, which does not widen, on a tool: a plane in closed form that is held, one that is a rigid body, or a rigid block with a mesh."""
    scene = two_bars(poisson=0, **interface)
    plane = {"shape": "plane", "point": [0.5, 0.5, 0], "direction": [0, 0, 1]}
    scene["lower"] = {
        "held": {"type": "analytic", **plane},
        "rigid": {"type": "rigid", "from": "analytic", **plane, "reference": [0.5, 0.5, 0]},
        "meshed": {"type": "rigid", "from": "box", "lower": [-1, -1, -2], "upper": [2, 2, 0], "cells": [5, 3, 3], "reference": [0.5, 0.5, 0]},
    }[kind]
    scene["supports"] = ["floor", "left", "front"]
    scene["floor"] = {"body": "lower", "components": ["x", "y", "z"] + (["rx", "ry", "rz"] if kind != "held" else [])}
    scene["left"], scene["front"] = {"surface": "upper.xmin", "components": ["x"]}, {"surface": "upper.ymin", "components": ["y"]}
    scene["base"]["mortar"] = "lower.zmax" if kind == "meshed" else "lower.surface"
    scene["base"]["weights"] = "current"
    scene["temperatures"] = ["hot"]
    del scene["cold"]
    return scene


def given(verdicts, driver):
    """A bar on a tool of a given temperature, and on one that keeps what it started with."""
    flux = (HOT - COLD / 2) / (1 / CONDUCTIVITY["upper"] + 1 / 0.5)
    for kind in ("held", "rigid"):
        for ranks in (1, 2):
            scene = on_tool(kind, friction=0.3, **CONTACT)
            scene["temperatures"] = ["hot", "cold"]
            scene["cold"] = {"surface": "lower.surface", "value": COLD / 2}
            found = driver.run(write(scene, driver.output / f"given_{kind}.yaml"), ranks=ranks, label=f"given_{kind}_{ranks}").steps[-1]["heat"]
            what = f"tool of a given temperature, {kind}, {ranks} ranks"
            for name, value in (("heat through the interface", found["interfaces"]["base"]["across"]), ("heat in", found["supplied"]["hot"]),
                                ("heat out", -found["supplied"]["cold"]), ("what the tool takes", found["tools"]["lower"]["heat"])):
                verdicts.near(f"{what}: {name}", value / flux, 1, EXACT_BOUND, "closed form")
            verdicts.near(f"{what}: temperature", found["tools"]["lower"]["temperature"], COLD / 2, 0, "as given")
    flux = (HOT - COLD) / (1 / CONDUCTIVITY["upper"] + 1 / 0.5)
    for kind in ("held", "rigid", "meshed"):
        found = driver.run(write(on_tool(kind, **CONTACT), driver.output / f"keeps_{kind}.yaml")).steps[-1]["heat"]
        verdicts.near(f"tool that keeps its temperature, {kind}: what it takes", found["tools"]["lower"]["heat"] / flux, 1, EXACT_BOUND, "closed form")


def stores(verdicts, driver):
    """A bar without capacity on a tool with one: one temperature by the implicit Euler method."""
    capacity, steps = 0.8, 4
    dt, resistance = 1 / steps, 1 / CONDUCTIVITY["upper"] + 1 / 0.5
    for kind in ("held", "rigid", "meshed"):
        scene = on_tool(kind, **CONTACT)
        scene["lower"]["heat_capacity"] = capacity
        scene["steps"] = {"count": steps}
        scene["hot"]["curve"] = [0, 1, 1, 1]
        scene["press"]["curve"] = [0, 1, 1, 1]
        path = write(scene, driver.output / f"stores_{kind}.yaml")
        for ranks in (1, 2, 3):
            run = driver.run(path, *(KEEP + BITS if ranks == 1 else ()), ranks=ranks, label=f"stores_{kind}_{ranks}")
            t, error = COLD, 0
            for step in run.steps:
                t = (capacity / dt * t + HOT / resistance) / (capacity / dt + 1 / resistance)
                error = max(error, abs(step["heat"]["tools"]["lower"]["temperature"] - t) / (HOT - COLD))
            verdicts.below(f"tool that stores heat, {kind}, {ranks} ranks: temperature", error, EXACT_BOUND, "implicit Euler")
            taken = sum(step["heat"]["tools"]["lower"]["heat"] * dt for step in run.steps)
            verdicts.near(f"tool that stores heat, {kind}, {ranks} ranks: all that it took", taken / (capacity * (t - COLD)), 1, EXACT_BOUND, "is what it stores")
            if ranks > 1:
                continue
            again = driver.run(path, *KEEP, *BITS, "-restart", run.directory / "restart_2.bin", label="stores_again")
            differ = [key for key in run.summary if key not in COSTS and run.summary[key] != again.summary.get(key)]
            verdicts.true(f"tool that stores heat, {kind}, restart: bits", not differ, "; ".join(differ) or "those of the run that goes through")


def rubbed(verdicts, driver):
    """A block that is drawn over a tool: the heat of friction is its dissipation, goes where it is told, and is as on the meshed tool."""
    taken = {}
    for kind in ("held", "rigid", "meshed"):
        for share, capacity in ((0.2, 0), (0.7, 0.3)):
            scene = on_tool(kind, friction=0.3, conductance_constant=2.0, conductance_reach=0.1, friction_heat=share, lag_max=1)
            if capacity:
                scene["lower"]["heat_capacity"] = capacity
            scene["supports"] = ["floor", "front", "drag"]
            del scene["left"]
            scene["drag"] = {"surface": "upper.zmax", "components": ["x"], "value": [0.2, 0, 0], "curve": [0, 0, 1, 1]}
            scene["hot"]["value"] = COLD
            scene["steps"] = {"count": 2}
            for name in ("press", "hot"):
                scene[name]["curve"] = [0, 1, 1, 1]
            run = driver.run(write(scene, driver.output / f"rubbed_{kind}_{share}.yaml"))
            work = [0.0, *(step["friction_work"] for step in run.steps)]
            for k, step in enumerate(run.steps):
                made, what = step["heat"]["interfaces"]["base"]["friction"], f"rubbed tool, {kind}, share {share}, step {k + 1}"
                verdicts.near(f"{what}: heat over work", made / ((work[k + 1] - work[k]) * 2), 1, DISSIPATION_BOUND, "the dissipation")
                gone = step["heat"]["tools"]["lower"]["heat"] - sum(step["heat"]["supplied"].values())
                verdicts.near(f"{what}: heat that supports and tool take", gone / made, 1, BALANCE_BOUND, "conserved")
            taken[kind, share] = step["heat"]["tools"]["lower"]["heat"]
            verdicts.near(f"rubbed tool, {kind}, share {share}: what it takes", taken[kind, share] / taken["held", share], 1, SAME_BOUND, "as the others")


def expands(verdicts, driver):
    """A bar that is warmed evenly, and faster and faster swings: expansion pushes its end as a traction would, whatever the scheme."""
    young, expansion, warmer = 1000.0, 1e-4, 50.0
    sides = [f"bar.{axis}{end}" for axis in "xyz" for end in ("min", "max")]
    base = {
        "schema": 1,
        "bodies": ["bar"],
        "bar": {"type": "box", "lower": [0, 0, 0], "upper": [2, 1, 1], "cells": [4, 1, 1], "young": young, "poisson": 0, "small_strain": True, "density": 2},
        "supports": ["wall", "rails"],
        "wall": {"surface": "bar.xmin", "components": ["x"]},
        "rails": {"body": "bar", "components": ["y", "z"]},
        "steps": {"end": 0.2, "count": 20},
        "probes": ["end"],
        "end": {"body": "bar", "point": [2, 0, 0]},
        "output": {"vtu": "none"},
    }
    curve = [0, 0, 0.05, 1, 0.1, 0.2, 0.2, 0.2]
    warmed = {**base, "heat": {"initial": COLD, "coupling": "two_way"}, "temperatures": ["warm"], "warm": {"surface": sides, "value": COLD + warmer, "curve": curve}}
    warmed["bar"] = {**base["bar"], "conductivity": 1.0, "expansion": expansion}
    pulled = {**base, "loads": ["pull"], "pull": {"surface": "bar.xmax", "traction": [young * expansion * warmer, 0, 0], "curve": curve}}
    for name, dynamics in {"rho_inf 1": {"rho_inf": 1}, "rho_inf 0.5": {"rho_inf": 0.5}, "damped": {"rho_inf": 0.8, "stiffness_damping": 1e-3}}.items():
        runs = [driver.run(write({**scene, "dynamics": dynamics}, driver.output / "expands.yaml"), label=f"{what}_{name.replace(' ', '_')}")
                for what, scene in (("warmed", warmed), ("pulled", pulled))]
        ends = [np.array([step["probes"]["end"][0] for step in run.steps]) for run in runs]
        verdicts.below(f"warmed bar, {name}: its end", np.abs(ends[0] - ends[1]).max() / np.abs(ends[1]).max(), TURNS_BOUND, "as under a traction")
        tables = [energy(run) for run in runs]
        apart = np.abs(tables[0]["kinetic"] - tables[1]["kinetic"]).max() / total(tables[1]).max()
        verdicts.below(f"warmed bar, {name}: energy of motion", apart, TURNS_BOUND, "as under a traction")
        if name == "rho_inf 1":
            verdicts.below(f"warmed bar, {name}: energy balance", np.abs(tables[0]["numerical"]).max() / total(tables[0]).max(), TURNS_BOUND, "what pushes works")


def heated(verdicts, driver):
    """The same where temperatures are solved for: a bar of one cell that heat flows into. Its mean temperature pushes, that of both ends of a step by halves, or as
    the scheme has it."""
    young, expansion, times = 1000.0, 1e-4, [0.01 * k for k in range(1, 11)]
    scene = {
        "schema": 1,
        "bodies": ["bar"],
        "bar": {"type": "box", "lower": [0, 0, 0], "upper": [2, 1, 1], "cells": [1, 1, 1], "young": young, "poisson": 0, "small_strain": True, "density": 2,
                "conductivity": 2.0, "heat_capacity": 0.5, "expansion": expansion},
        "supports": ["wall", "rails"],
        "wall": {"surface": "bar.xmin", "components": ["x"]},
        "rails": {"body": "bar", "components": ["y", "z"]},
        "heat": {"initial": COLD, "coupling": "two_way"},
        "flows": ["burner"],
        "burner": {"surface": "bar.xmin", "flow": 100.0, "curve": [0, 1, 0.05, 1, 0.06, 0]},
        "steps": {"times": times},
        "probes": ["start", "end"],
        "start": {"body": "bar", "point": [0, 0, 0]},
        "end": {"body": "bar", "point": [2, 0, 0]},
        "output": {"vtu": "none", "csv": "none"},
    }
    for rho in (1, 0.5):
        scene["dynamics"] = {"rho_inf": rho}
        path = write(scene, driver.output / "heated.yaml")
        whole = driver.run(path, *KEEP, label=f"heated_{rho}")
        warmer = [np.mean(list(step["heat"]["probes"].values())) - COLD for step in whole.steps]
        curve = [0, 0] + [value for pair in zip(times, warmer) for value in pair]
        pulled = {key: value for key, value in scene.items() if key not in ("heat", "flows", "burner")}
        pulled["bar"] = {key: value for key, value in scene["bar"].items() if key not in ("conductivity", "heat_capacity", "expansion")}
        pulled |= {"loads": ["pull"], "pull": {"surface": "bar.xmax", "traction": [young * expansion, 0, 0], "curve": curve}}
        other = driver.run(write(pulled, driver.output / "pulled.yaml"), label=f"heated_pulled_{rho}")
        ends = [np.array([step["probes"]["end"][0] for step in run.steps]) for run in (whole, other)]
        verdicts.below(f"heated bar, rho_inf {rho}: its end", np.abs(ends[0] - ends[1]).max() / np.abs(ends[1]).max(), TURNS_BOUND, "as under a traction")
        verdicts.at_least(f"heated bar, rho_inf {rho}: turns", whole.steps[-1]["heat"]["turns"], 2, "temperatures and displacements in turns")
        again = driver.run(path, *KEEP, "-restart", whole.directory / "restart_4.bin", label="heated_again")
        differ = [key for key in whole.summary if key not in COSTS and whole.summary[key] != again.summary.get(key)]
        verdicts.true(f"heated bar, rho_inf {rho}, restart: bits", not differ, "; ".join(differ) or "those of the run that goes through")


def slides(verdicts, driver):
    """A block that slides on its own until friction has stopped it: what is lost of its motion is heat, in the base, in a tool, and in itself."""
    for kind in ("bodies", "held", "rigid"):
        scene = two_bars(friction=0.3, friction_heat=0.4, conductance_constant=2.0, conductance_reach=0.1, lag_max=1) if kind == "bodies" else on_tool(
            kind, friction=0.3, friction_heat=0.4, conductance_constant=2.0, conductance_reach=0.1, lag_max=1)
        scene["base"]["weights"] = "current"
        scene["dynamics"] = {"rho_inf": 1}
        scene["upper"].update(density=2, velocity=[0.4, 0, 0], heat_capacity=5.0)
        if kind == "bodies":
            scene["lower"].update(density=2, heat_capacity=5.0)
            scene["floor"] = {"surface": "lower.zmin", "components": ["x", "y", "z"]}
        else:
            scene["lower"]["heat_capacity"] = 0.7
        scene["supports"] = ["floor", "front"]
        del scene["left"]
        scene["front"] = {"surface": "upper.ymin", "components": ["y"]}
        del scene["temperatures"], scene["hot"]
        scene.pop("cold", None)
        scene["press"]["curve"] = [0, 1, 1, 1]
        scene["steps"] = {"end": 0.2, "count": 20}
        scene["output"] = {"vtu": "none", "csv": "none"}
        path = write(scene, driver.output / f"slides_{kind}.yaml")
        run = driver.run(path, *KEEP, label=f"slides_{kind}")
        table = energy(run)
        spent = np.diff(table["friction_dissipation"])
        made = np.array([step["heat"]["interfaces"]["base"]["friction"] for step in run.steps]) * 0.01
        slid = spent > 1e-3 * spent.max()
        verdicts.below(f"block that slides, {kind}: heat over dissipation", np.abs(made[slid] / spent[slid] - 1).max(), SAME_BOUND, "of each step in which it slides")
        verdicts.at_least(f"block that slides, {kind}: steps in which it does", float(slid.sum()), 5, "it has a way to go")
        verdicts.below(f"block that slides, {kind}: energy balance", np.abs(table["numerical"]).max() / total(table).max(), SAME_BOUND, "heat is beside it")
        other = driver.run(path, ranks=2, label=f"slides_{kind}_ranks")
        two = np.array([step["heat"]["interfaces"]["base"]["friction"] for step in other.steps]) * 0.01
        verdicts.below(f"block that slides, {kind}: 1 and 2 ranks", np.abs(two - made).max() / made.max(), SAME_BOUND, "the same")
        again = driver.run(path, *KEEP, "-restart", run.directory / "restart_7.bin", label="slides_again")
        differ = [key for key in run.summary if key not in COSTS and run.summary[key] != again.summary.get(key)]
        verdicts.true(f"block that slides, {kind}, restart: bits", not differ, "; ".join(differ) or "those of the run that goes through")


def refused(verdicts, driver):
    stored = on_tool("held", **CONTACT)
    stored["lower"]["heat_capacity"] = 1.0
    for what, changes, says in (
        ("that is given what it follows", {"temperatures": ["hot", "cold"], "cold": {"surface": "lower.surface", "value": COLD}}, "'lower' has a `heat_capacity`"),
        ("with a flow", {"flows": ["burner"], "burner": {"surface": "lower.surface", "flow": 1.0}}, "burner.surface: 'lower.surface' is without faces"),
        ("of negative capacity", {"lower": {**stored["lower"], "heat_capacity": -1.0}}, "lower.heat_capacity: -1 is not allowed; it must be at least 0"),
    ):
        for ranks in (1, 2):
            run = driver.run(write({**stored, **changes}, driver.output / "refused.yaml"), label="refused", expect=1, ranks=ranks)
            verdicts.true(f"a tool {what}, {ranks} ranks: refused", says in run.text and "PETSC ERROR" not in run.text, f"says: {says}")
