"""Springs: of surfaces on the ground, between nodes and between surfaces, axial ones under large rotation; on 1 to 3 ranks, across a
restart, in dynamics, beside contact in both forms; and such that are too soft to hold anything."""

import numpy as np

from jacobian import whole_matrix
from ranks import CONDENSED
from restart import BITS, BOX, COSTS, KEEP, pad
from scene import write

# Closed forms: Newton's tolerance of 1e-11, and rounding.
EXACT_BOUND = 1e-9
# Ranks add in another order.
RANKS_BOUND = 1e-11
# What the step in time keeps but for rounding and Newton's tolerance, over hundred steps; of the energy at the start.
ENERGY_BOUND = 1e-9
# Two ways to one answer, each to Newton's tolerance.
FORMS_BOUND = 1e-8
PRESSURE, BED = 3.0, np.array([7.0, 11.0, 40.0])


def springs(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    bed(verdicts, driver)
    rings(verdicts, driver)
    chain(verdicts, driver)
    swing(verdicts, driver)
    rigid_body(verdicts, driver)
    oscillator(verdicts, driver)
    swinging(verdicts, driver)
    soft(verdicts, driver)
    beside_contact(verdicts, driver)
    refused(verdicts, driver)


def bed(verdicts, driver):
    """A block without supports on springs per area, under a uniform traction: it settles evenly, and nothing is called free."""
    traction = np.array([0.7, -0.4, -PRESSURE])
    for cell in ("hex", "tet10"):
        scene = {
            "schema": 1,
            "bodies": ["block"],
            "block": {**BOX, "cell": cell, "poisson": 0, "lower": [0, 0, 0], "upper": [2, 1, 1], "cells": [3, 2, 2], "small_strain": True},
            "springs": ["bed"],
            "bed": {"surface": ["block.zmin"], "stiffness": BED.tolist()},
            "loads": ["press", "against"],
            "press": {"surface": "block.zmax", "traction": [0, 0, float(traction[2])]},
            "against": {"surface": "block.zmin", "traction": [*traction[:2].tolist(), 0]},
            "steps": {"count": 1},
        }
        path = write(scene, driver.output / f"bed_{cell}.yaml")
        forces = []
        for ranks in (1, 2, 3) if cell == "hex" else (1,):
            run = driver.run(path, ranks=ranks, label=f"bed_{cell}_{ranks}")
            points, _, u = run.mesh()
            low = points[:, 2] == 0
            verdicts.below(f"bed of springs, {cell}, {ranks} ranks: settles", np.abs(u[low] - traction / BED).max(), EXACT_BOUND, "traction over stiffness")
            forces.append(run.steps[-1]["springs"]["bed"])
            verdicts.below(f"bed of springs, {cell}, {ranks} ranks: force", np.abs(np.array(forces[-1]) + 2 * traction).max(), EXACT_BOUND, "statics")
            verdicts.true(f"bed of springs, {cell}, {ranks} ranks: held", "free to" not in run.text, "springs hold it")
        verdicts.below(f"bed of springs, {cell}: forces of ranks", np.ptp(forces, axis=0).max(), RANKS_BOUND, "the same")


def rings(verdicts, driver):
    """An axisymmetric disc on a bed: the area is that of the whole ring."""
    outer = 2.0
    scene = {
        "schema": 1,
        "model": "axisymmetric",
        "bodies": ["disc"],
        "disc": {**BOX, "poisson": 0, "cell": "quad8", "lower": [0, 0], "upper": [outer, 1], "cells": [3, 2], "small_strain": True},
        "springs": ["bed"],
        "bed": {"surface": "disc.ymin", "stiffness": [0, 40]},
        "loads": ["press"],
        "press": {"surface": "disc.ymax", "pressure": PRESSURE},
        "steps": {"count": 1},
    }
    run = driver.run(write(scene, driver.output / "rings.yaml"))
    points, _, u = run.mesh()
    verdicts.below("disc on a bed: settles", np.abs(u[points[:, 1] == 0, 1] + PRESSURE / 40).max(), EXACT_BOUND, "pressure over stiffness")
    verdicts.near("disc on a bed: force", run.steps[-1]["springs"]["bed"][1], np.pi * outer**2 * PRESSURE, EXACT_BOUND, "pi R^2 p")


def chain(verdicts, driver):
    """Three blocks in a row, joined by a spring between surfaces and four between corners; the last one is drawn. Mean displacements
    differ by force over stiffness; the middle one rests on a spring to the ground, too."""
    force, link, corner, ground = np.array([2.0, -1.0, 3.0]), 20.0, 8.0, 15.0
    block = lambda k: {**BOX, "poisson": 0, "lower": [2 * k, 0, 0], "upper": [2 * k + 1, 1, 1], "cells": [2, 1, 1], "young": 1e6, "small_strain": True}
    corners = {f"c{y}{z}": [float(y), float(z)] for y in (0, 1) for z in (0, 1)}
    scene = {
        "schema": 1,
        "bodies": ["one", "two", "three"],
        "one": block(0), "two": block(1), "three": block(2),
        "supports": ["wall", "rails"],
        "wall": {"surface": "one.xmin", "components": ["x", "y", "z"]},
        "rails": {"body": ["two", "three"], "components": ["y", "z"]},
        "springs": ["link", "rest", *corners],
        "link": {"surface": "two.xmin", "to": "one.xmax", "stiffness": [link, 0, 0]},
        "rest": {"body": "two", "point": [2.5, 1, 1], "stiffness": [ground, 0, 0]},
        **{name: {"body": "three", "point": [4, *yz], "to": "two", "to_point": [3, *yz], "stiffness": [corner, corner, 0]} for name, yz in corners.items()},
        "loads": ["pull"],
        "pull": {"surface": "three.xmax", "traction": force.tolist()},
        "steps": {"count": 2},
    }
    path = write(scene, driver.output / "chain.yaml")
    exact = {"link": -force[0] * link / (link + ground), "rest": -force[0] * ground / (link + ground), "c00": -force[0] / 4}
    for ranks in (1, 3):
        run = driver.run(path, *(("-snes_test_jacobian",) if ranks == 1 else ()), ranks=ranks, label=f"chain_{ranks}")
        for name, value in exact.items():
            error = abs(run.steps[-1]["springs"][name][0] - value) / force[0]
            # the blocks strain by 1e-6 of what the springs do
            verdicts.below(f"chain of blocks, {ranks} ranks: {name}", error, 1e-4, "springs in a row, of stiff blocks")
        total = run.steps[-1]["springs"]["rest"][0] + run.steps[-1]["reactions"]["wall"][0] + force[0]
        verdicts.below(f"chain of blocks, {ranks} ranks: balance", abs(total), EXACT_BOUND, "statics")
        verdicts.true(f"chain of blocks, {ranks} ranks: held", "free to" not in run.text, "springs hold them")
        if ranks == 1:
            whole_matrix(verdicts, "chain of blocks", run)
    cut = {key: value for key, value in scene.items() if key != "rest" and key not in corners}
    unheld = write({**cut, "springs": ["link"]}, driver.output / "chain_cut.yaml")
    run = driver.run(unheld, expect=2)
    verdicts.true("chain that is cut: says so", "three is free to move along x" in run.text and "two is free" not in run.text, "the last block is free, the others are not")
    restarted(verdicts, driver, path)


def restarted(verdicts, driver, path):
    whole = driver.run(path, *BITS, *KEEP, label="chain_whole")
    again = driver.run(path, *BITS, "-restart", whole.directory / "restart_1.bin", label="chain_again")
    differ = [key for key in whole.summary if key not in COSTS and whole.summary[key] != again.summary.get(key)]
    verdicts.true("chain of blocks, restart: bits", not differ, "; ".join(differ) or "those of the run that goes through")


def swing(verdicts, driver):
    """A stiff block on a rail, drawn along it against an axial spring to a place beside the rail, and one to another block: the line
    between the ends turns by 60 degrees. Statics of now has the force, and the place."""
    stiffness, height, force, length = 5.0, 1.5, 6.0, 1.2
    block = {**BOX, "young": 1e4, "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [1, 1, 1], "material": "neo_hooke"}
    scene = {
        "schema": 1,
        "bodies": ["car", "post"],
        "car": block,
        "post": {**block, "lower": [0, 0, 2.5], "upper": [1, 1, 3.5]},
        "supports": ["rail", "still"],
        "rail": {"body": "car", "components": ["y", "z"]},
        "still": {"body": "post", "components": ["x", "y", "z"]},
        "springs": ["place", "other", "faces"],
        "place": {"body": "car", "point": [0, 0, 1], "to_point": [0, 0, 1 + height], "axial": True, "stiffness": stiffness, "length": length},
        "other": {"body": "car", "point": [0, 1, 1], "to": "post", "to_point": [0, 1, 2.5], "axial": True, "stiffness": stiffness, "length": length},
        "faces": {"surface": "car.zmax", "to": "post.zmin", "axial": True, "stiffness": stiffness, "length": length},
        "loads": ["pull"],
        "pull": {"surface": "car.xmax", "traction": [3 * force, 0, 0]},
        "steps": {"count": 4},
        "probes": ["corner"],
        "corner": {"body": "car", "point": [0, 0, 1]},
    }
    path = write(scene, driver.output / "swing.yaml")
    for ranks in (1, 2):
        run = driver.run(path, *(("-snes_test_jacobian",) if ranks == 1 else ()), ranks=ranks, label=f"swing_{ranks}")
        x = run.steps[-1]["probes"]["corner"][0]
        along = np.array([x, 0, -height])
        size = np.linalg.norm(along)
        exact = -stiffness * (size - length) * along / size
        found = np.array(run.steps[-1]["springs"]["place"])
        verdicts.below(f"axial spring, {ranks} ranks: force", np.abs(found - exact).max() / force, EXACT_BOUND, "along the line of now")
        total = sum(run.steps[-1]["springs"][name][0] for name in scene["springs"])
        verdicts.below(f"axial springs, {ranks} ranks: balance", abs(total + 3 * force) / force, EXACT_BOUND, "statics")
        verdicts.at_least(f"axial spring, {ranks} ranks: turns by", np.degrees(np.arctan2(x, height)), 45, "degrees: far")
        if ranks == 1:
            whole_matrix(verdicts, "axial springs", run)


def rigid_body(verdicts, driver):
    """A rigid block without cells, whose reference point springs hold: one to the ground, and an axial one to a node."""
    force, ground, stiffness, start = np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.0, 0.5]), 4.0, np.array([-0.5, -0.5, 1.5])
    scene = {
        "schema": 1,
        "bodies": ["tool", "block"],
        "tool": {"type": "rigid", "from": "box", "lower": [0, 0, 2], "upper": [1, 1, 3], "cells": [1, 1, 1], "reference": [0.5, 0.5, 2.5]},
        "block": {**BOX, "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [1, 1, 1]},
        "supports": ["still", "turns"],
        "still": {"body": "block", "components": ["x", "y", "z"]},
        "turns": {"body": "tool", "components": ["rx", "ry", "rz"]},
        "springs": ["ground", "line"],
        "ground": {"body": "tool", "stiffness": ground.tolist()},
        "line": {"body": "tool", "to": "block", "to_point": [1, 1, 1], "axial": True, "stiffness": stiffness},
        "loads": ["pull"],
        "pull": {"body": "tool", "force": force.tolist()},
        "steps": {"count": 2},
    }
    path = write(scene, driver.output / "rigid.yaml")
    for ranks in (1, 2):
        run = driver.run(path, *(("-snes_test_jacobian",) if ranks == 1 else ()), ranks=ranks, label=f"rigid_{ranks}")
        u = np.array(run.steps[-1]["rigid"]["tool"]["displacement"])
        line = start + u
        pull = stiffness * (1 - np.linalg.norm(start) / np.linalg.norm(line)) * line
        verdicts.below(f"rigid body on springs, {ranks} ranks", np.abs(force - ground * u - pull).max(), EXACT_BOUND, "statics of now")
        if ranks == 1:
            whole_matrix(verdicts, "rigid body on springs", run)


def oscillator(verdicts, driver):
    """A block on a spring, let go at speed: what it keeps, half of it in the spring."""
    scene = {
        "schema": 1,
        "bodies": ["block"],
        "block": {**BOX, "density": 2.0, "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [2, 1, 1], "small_strain": True, "velocity": [1, 0, 0]},
        "supports": ["rail"],
        "rail": {"body": "block", "components": ["y", "z"]},
        "springs": ["spring"],
        "spring": {"surface": "block.xmin", "stiffness": [50, 0, 0]},
        "dynamics": {"rho_inf": 1},
        "steps": {"end": 0.6, "count": 60},
    }
    run = driver.run(write(scene, driver.output / "oscillator.yaml"))
    energies = [step["energy"] for step in run.steps]
    start = 0.5 * 2.0
    kept = max(abs(e["kinetic"] + e["strain"] - start) for e in energies) / start
    verdicts.below("block on a spring, dynamics: energy", kept, ENERGY_BOUND, "kept, that of the spring among it")
    verdicts.at_least("block on a spring, dynamics: of it in the spring and the block", max(e["strain"] for e in energies) / start, 0.9, "it turns back")


def swinging(verdicts, driver):
    """A car on a rail swings past the place that an axial spring joins it to, at speed; the line between the ends turns by 100 degrees. In
    steps in which it turns by up to 25 degrees energy is kept, and the tangent is exact."""
    speed, mass = 3.0, 2.0
    scene = {
        "schema": 1,
        "bodies": ["car"],
        "car": {**BOX, "density": mass, "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [1, 1, 1], "small_strain": True, "velocity": [speed, 0, 0]},
        "supports": ["rail"],
        "rail": {"body": "car", "components": ["y", "z"]},
        "springs": ["line", "strip"],
        "line": {"surface": "car.xmin", "to_point": [1, 0.5, 1.7], "axial": True, "stiffness": 4, "length": 1},
        "strip": {"body": "car", "point": [1, 1, 1], "to_point": [2, 1, 2], "axial": True, "stiffness": 2},
        "dynamics": {"rho_inf": 1},
        "steps": {"end": 1.5, "count": 12},
        "probes": ["corner"],
        "corner": {"body": "car", "point": [0, 0, 0]},
    }
    path = write(scene, driver.output / "swinging.yaml")
    for ranks in (1, 2):
        run = driver.run(path, *(("-snes_test_jacobian",) if ranks == 1 else ()), ranks=ranks, label=f"swinging_{ranks}")
        energies, start = [step["energy"] for step in run.steps], 0.5 * mass * speed**2
        first = 0.5 * 4 * (np.hypot(1, 1.2) - 1) ** 2
        kept = max(abs(e["kinetic"] + e["strain"] - start - first) for e in energies) / start
        verdicts.below(f"axial springs in dynamics, {ranks} ranks: energy", kept, ENERGY_BOUND, "kept, however far the line turns in a step")
        verdicts.below(f"axial springs in dynamics, {ranks} ranks: numerical", max(abs(e["numerical"]) for e in energies) / start, ENERGY_BOUND, "nothing comes from nowhere")
        verdicts.at_least(f"axial springs in dynamics, {ranks} ranks: way", max(step["probes"]["corner"][0] for step in run.steps), 2.0, "past the place")
        if ranks == 1:
            whole_matrix(verdicts, "axial springs in dynamics", run)


def soft(verdicts, driver):
    """A block that springs alone hold along x: squeezed, it drifts by the rounding of the loads over their stiffness; drawn, it leaves the
    model, or cannot balance its forces at all. Each is told by name, with how much it is, and springs that hold are not."""
    young = 1000.0
    base = {
        "schema": 1,
        "bodies": ["block"],
        "block": {**BOX, "young": young, "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [2, 2, 2], "small_strain": True},
        "supports": ["rail"],
        "rail": {"surface": "block.zmin", "components": ["y", "z"]},
        "springs": ["rest"],
        "loads": ["push"],
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "none"},
    }
    squeeze, draw = {"surface": ["block.xmin", "block.xmax"], "pressure": 1}, {"surface": "block.xmax", "traction": [1, 0, 0]}
    for what, load, part, told, far, code in (
        ("squeezed, springs of 1e-6 E", squeeze, 1e-6, False, False, 0),
        ("squeezed, springs of 1e-14 E", squeeze, 1e-14, True, False, 0),
        ("drawn, springs of 1e-2 E", draw, 1e-2, False, False, 0),
        ("drawn, springs of 1e-4 E", draw, 1e-4, True, True, 0),
        ("drawn, springs of 1e-10 E", draw, 1e-10, False, False, 2),
    ):
        scene = {**base, "push": load, "rest": {"surface": "block.xmin", "stiffness": [part * young, 0, 0]}}
        run = driver.run(write(scene, driver.output / "soft.yaml"), label="soft", expect=code)
        found = run.summary.get("held_by_soft_springs")
        says = "springs alone hold what follows, and they are too soft for it: block: move along x" in run.text
        verdicts.true(f"block {what}: told", says == told == (found is not None), "of the motion, by name" if told else "nothing")
        if told and far:
            verdicts.near(f"block {what}: moved", found["moved"], 1 / (part * young), 1e-2, "force over stiffness")
        elif told:
            moved = abs(run.steps[-1]["springs"]["rest"][0]) / (part * young)
            verdicts.at_least(f"block {what}: known to", found["drift"] / moved, 1, "not less than it is off by, though no force is on it")
    says = "Springs hold what follows, and they are so soft that rounding is" in run.text and "block: move along x" in run.text
    verdicts.true("block drawn, springs of 1e-10 E: why it fails", says, "rounding, by name")
    verdicts.true("block on springs: by what it is held", "held by supports and springs" in run.text, "not by supports alone")


def beside_contact(verdicts, driver):
    """Springs on the contact surfaces themselves: the forms agree."""
    extra = {
        "springs": ["link", "bed"],
        "link": {"surface": "upper.zmin", "to": "lower.zmax", "stiffness": [30, 30, 10]},
        "bed": {"surface": "upper.zmin", "stiffness": [20, 10, 5]},
    }
    tables = {}
    for name, contact, options in (("full", {"basis": "dual"}, ()), ("condensed", {"basis": "dual"}, CONDENSED)):
        scene = {**pad(contact=contact), **extra}
        run = driver.run(write(scene, driver.output / f"beside_{name}.yaml"), *BITS, *options, label=f"beside_{name}")
        tables[name] = run.interface("contact")
    scale = np.abs(tables["full"]["lambda_n"]).max()
    error = np.abs(tables["full"]["lambda_n"] - tables["condensed"]["lambda_n"]).max() / scale
    verdicts.below("springs beside contact: condensed and with multipliers", error, FORMS_BOUND, "the same pressures")


def refused(verdicts, driver):
    base = {
        "schema": 1,
        "bodies": ["block"],
        "block": {**BOX, "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [20, 20, 1]},
        "springs": ["spring"],
        "steps": {"count": 1},
    }
    hold = {"surface": "block.zmin", "stiffness": [1, 1, 1]}
    for what, spring, says in (
        ("without a stiffness", {"surface": "block.zmin"}, "spring.stiffness: this key is missing"),
        ("that pushes apart", {**hold, "stiffness": [1, -1, 1]}, "spring.stiffness: -1 is not allowed; it must be at least 0"),
        ("on nothing", {"stiffness": [1, 1, 1]}, "spring.surface: say what the spring holds"),
        ("of too many nodes", {**hold, "to": "block.zmax"}, "spring.surface: its ends have 882 nodes"),
        ("on itself", {"body": "block", "point": [0, 0, 0], "to": "block", "to_point": [0, 0, 0], "stiffness": [1, 1, 1]}, "both ends are the same"),
        ("from a surface to itself", {**hold, "to": "block.zmin"}, "spring.to: both ends are the same surface"),
        ("without a direction", {"body": "block", "point": [0, 0, 0], "to_point": [0, 0, 0], "axial": True, "stiffness": 1}, "at one place"),
        ("without a second end", {"body": "block", "point": [0, 0, 0], "axial": True, "stiffness": 1}, "spring.to_point: this key is missing"),
        ("with a length of no use", {**hold, "length": 1}, "only of an `axial` spring"),
    ):
        run = driver.run(write({**base, "spring": spring}, driver.output / "refused.yaml"), label="refused", expect=1)
        verdicts.true(f"a spring {what}: refused", says in run.text and "PETSC ERROR" not in run.text, f"says: {says}")
    moving = {**base, "block": {**base["block"], "density": 1}, "dynamics": {"rho_inf": 1, "stiffness_damping": 0.1}, "spring": {"body": "block", "point": [0, 0, 0], "to_point": [0, 0, -1], "axial": True, "stiffness": 1}}
    run = driver.run(write(moving, driver.output / "refused.yaml"), label="refused", expect=1)
    verdicts.true("an axial spring with damping: refused", "spring.axial: `stiffness_damping` of `dynamics` would brake its turns" in run.text, "by name")
