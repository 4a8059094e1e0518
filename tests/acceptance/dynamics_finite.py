"""Dynamics of bodies of finite strain: energy and both momenta of what spins, of large strains, in every space and with every kind of cell; damping
that brakes no turn; the tangent against differences; ranks."""

import csv
import math

import numpy as np

from jacobian import JACOBIAN_BOUND, worst
from scene import write

# Newton's method is asked for rounding, since what it leaves of a thousand steps adds up.
TIGHT = ("-snes_rtol", "1e-14")
# What then is left of a thousand steps.
SPIN_ENERGY, SPIN_MOMENT = 1e-11, 1e-12
# Large strains in few steps: six points leave 4e-12, four would 7e-8.
STRAINED_BOUND = 1e-11
# With rho_inf below 1 energy is not what the scheme lets fall.
GAIN_BOUND = 0.01
# What the driver tells from on.
TOLD = 0.01
# Of an observed order, on two halvings.
ORDER_BOUND = 0.1
# The same run in another way.
SAME_BOUND = 1e-9
# A small vibration over that of the linear material: its strain.
SMALL_BOUND = 1e-4

LAWS = ("st_venant_kirchhoff", "neo_hooke")


def run(driver, name, scene, *options, **more):
    return driver.run(write(scene, driver.output / f"{name}.yaml"), *options, label=more.pop("label", name), **more)


def energy(result):
    with open(result.directory / "energy.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def total(table):
    return table["kinetic"] + table["strain"]


def finite(verdicts, driver):
    spins(verdicts, driver)
    strained(verdicts, driver)
    caught(verdicts, driver)
    damped(verdicts, driver)
    dissipates(verdicts, driver)
    tangents(verdicts, driver)


def spin(model, cells, turn, count, **block):
    """A free block that spins by `turn` in a step: in the plane about its centre, in space about a skew axis while it flies."""
    plane = model != "solid"
    at_rest = {"lower": [-0.1] * 2, "upper": [0.1] * 2, "cells": [cells] * 2, "spin": 3} if plane else \
              {"lower": [-0.1] * 3, "upper": [0.1] * 3, "cells": [cells] * 3, "spin": [1, 2, 2], "velocity": [0.1, 0, 0]}
    return {"schema": 1, "model": model, "bodies": ["block"], "dynamics": {"rho_inf": 1},
            "block": {"type": "box", "young": 1000, "poisson": 0.3, "density": 1, **at_rest, **block},
            "steps": {"count": count, "end": count * turn / 3}, "output": {"vtu": "none", "csv": "none"}}


def kept(verdicts, what, table, energy_bound=SPIN_ENERGY, moment_bound=SPIN_MOMENT):
    """Neither gained nor lost."""
    verdicts.below(f"{what}: energy", np.abs(total(table) / total(table)[0] - 1).max(), energy_bound, "kept")
    verdicts.below(f"{what}: energy from nowhere", np.abs(table["numerical"]).max() / total(table)[0], energy_bound, "none")
    moment = np.array([table[f"angular_{axis}"] for axis in "xyz"])
    verdicts.below(f"{what}: moment of momentum", np.abs(moment - moment[:, :1]).max() / np.linalg.norm(moment[:, 0]), moment_bound, "kept")


# In the plane and in space, linear and quadratic, pointwise and mean, over so many steps.
SPINS = {
    "quad, 100 turns": ("plane_strain", 4, 873, {}),
    "quad, mean, nu 0.49": ("plane_strain", 2, 100, {"dilatation": "mean", "poisson": 0.49}),
    "tri6, plane stress": ("plane_stress", 1, 100, {"cell": "tri6"}),
    "quad9": ("plane_strain", 1, 100, {"cell": "quad9"}),
    "hex": ("solid", 2, 100, {}),
    "tet10, mean": ("solid", 1, 40, {"cell": "tet10", "dilatation": "mean", "poisson": 0.45}),
}


def spins(verdicts, driver):
    """0.72 radians a step."""
    for law in LAWS:
        for name, (model, cells, count, block) in SPINS.items():
            what = f"{law} spins, {name}"
            result = run(driver, "spins", spin(model, cells, 0.72, count, material=law, **block), *TIGHT, label=what.replace(" ", "_").replace(",", ""))
            kept(verdicts, what, energy(result))
    base = energy(run(driver, "spins", spin("solid", 2, 0.72, 20, material="neo_hooke"), label="spins_one_rank"))
    for ranks in (2, 3):
        other = energy(run(driver, "spins", spin("solid", 2, 0.72, 20, material="neo_hooke"), label=f"spins_{ranks}", ranks=ranks))
        verdicts.below(f"a block that spins, {ranks} ranks: momentum, and energies", max(np.abs(other[key] - base[key]).max() for key in ("strain", "kinetic", "angular_x"))
                       / total(base)[0], SAME_BOUND, "as on one rank")


def strained(verdicts, driver):
    """A ring, and a bar in plane stress, that breathe by a third of their size."""
    for law in LAWS:
        for model, velocity in (("axisymmetric", [0, 6]), ("plane_stress", [4, 0])):
            for dilatation in ("pointwise", "mean")[: 1 if model == "plane_stress" else 2]:
                body = {"type": "box", "lower": [1, 0], "upper": [1.4, 1], "cells": [2, 3], "young": 1000, "poisson": 0.3, "density": 1, "material": law,
                        "dilatation": dilatation, "velocity": velocity}
                scene = {"schema": 1, "model": model, "bodies": ["body"], "dynamics": {"rho_inf": 1}, "body": body, "supports": ["held"],
                         "held": {"surface": "body.ymin" if model == "axisymmetric" else "body.xmin", "components": ["x", "y"]},
                         "steps": {"count": 40, "end": 0.4}, "output": {"vtu": "none", "csv": "none"}}
                what = f"{law}, {model}, {dilatation}, large strains"
                table = energy(run(driver, "strained", scene, *TIGHT, label=what.replace(" ", "_").replace(",", "")))
                verdicts.at_least(f"{what}: most of its energy", table["strain"].max() / total(table)[0], 0.5, "is in strains")
                verdicts.below(f"{what}: energy", np.abs(total(table) / total(table)[0] - 1).max(), STRAINED_BOUND, "kept")


def caught(verdicts, driver):
    """Two blocks that an axial spring catches: 85 % of their energy is in strains then. Nothing is gained or
    lost, whatever turns and however long the steps are."""
    box = {"type": "box", "young": 100, "poisson": 0.3, "density": 1, "cells": [2, 2, 2]}
    scene = {"schema": 1, "bodies": ["a", "b"], "a": {**box, "lower": [0, 0, 0], "upper": [1, 1, 1], "velocity": [-1, 0.5, 0]},
             "b": {**box, "lower": [2, 0, 0], "upper": [3, 1, 1], "velocity": [1, -0.5, 0]}, "dynamics": {"rho_inf": 1},
             "springs": ["s"], "s": {"surface": "a.xmax", "to": "b.xmin", "axial": True, "stiffness": 40}, "steps": {"count": 20, "end": 2}, "output": {"vtu": "none", "csv": "none"}}
    for kind, more in (("linear", {"small_strain": True}), *((law, {"material": law}) for law in LAWS)):
        for count in (10, 20):
            these = {**scene, **{name: {**scene[name], **more} for name in "ab"}}
            table = energy(run(driver, "caught", these, "-steps_count", str(count), *TIGHT, label=f"caught_{kind}_{count}"))
            verdicts.at_least(f"caught blocks, {kind}, {count} steps: most of their energy", table["strain"].max() / total(table)[0], 0.8, "is in strains")
            verdicts.below(f"caught blocks, {kind}, {count} steps: energy from nowhere", np.abs(table["numerical"]).max() / total(table)[0], STRAINED_BOUND, "none")


def damped(verdicts, driver):
    """Damping by the stiffness: a small vibration has that of the linear material, a turn has none but that of its stretch, and what damping takes is
    counted."""
    for law in LAWS:
        ends = {}
        for material in (law, "linear"):
            scene = {"schema": 1, "bodies": ["bar"], "bar": {"type": "box", "lower": [0, 0, 0], "upper": [1, 0.2, 0.2], "cells": [4, 1, 1], "young": 4, "poisson": 0.3, "density": 1,
                     "material": material, "velocity": [1e-5, 0, 0]}, "dynamics": {"rho_inf": 1, "stiffness_damping": 0.05}, "supports": ["clamp"],
                     "clamp": {"surface": "bar.xmin", "components": ["x", "y", "z"]}, "steps": {"count": 20, "end": 2}, "output": {"vtu": "none", "csv": "none"}}
            table = energy(run(driver, "vibrates", scene, label=f"vibrates_{law}_{material}"))
            ends[material] = table["damping"][-1] / total(table)[0]
            verdicts.below(f"damped bar, {material}: energy balance", np.abs(table["numerical"]).max() / total(table)[0], SAME_BOUND, "what damping takes is counted")
        verdicts.near(f"damped bar, {law}: what damping takes", ends[law] / ends["linear"], 1, SMALL_BOUND, "as of the linear material")
        for model, cells in (("plane_strain", 4), ("plane_stress", 2), ("solid", 2)):
            scene = spin(model, cells, 0.3, 60, material=law, **({"dilatation": "mean"} if model == "solid" else {}))
            scene["dynamics"]["stiffness_damping"] = 0.01
            table = energy(run(driver, "damped", scene, *TIGHT, label=f"damped_{law}_{model}"))
            moment = np.array([table[f"angular_{axis}"] for axis in "xyz"])
            what = f"damped block that spins, {law}, {model}"
            verdicts.below(f"{what}: moment of momentum", np.abs(moment - moment[:, :1]).max() / np.linalg.norm(moment[:, 0]), SPIN_MOMENT, "damping brakes no turn")
            verdicts.below(f"{what}: energy balance", np.abs(table["numerical"]).max() / total(table)[0], SPIN_ENERGY, "what damping takes is counted")
            verdicts.true(f"{what}: damping takes", 0 < table["damping"][-1] < 1e-3 * total(table)[0] and np.diff(table["damping"]).min() >= 0, "what is in the stretch that begins")


def dissipates(verdicts, driver):
    """The scheme stays one of second order, damped and with rho_inf below 1, where a bar bends by its length; and of a block that spins by a third of a
    radian a step, which gained without end, hardly anything comes."""
    curve = [value for k in range(33) for value in (k / 32, math.sin(3 * k / 32) ** 2)]
    scene = {"schema": 1, "bodies": ["bar"], "bar": {"type": "box", "lower": [0, 0, 0], "upper": [1, 0.2, 0.2], "cells": [4, 1, 1], "young": 4, "poisson": 0.3, "density": 1},
             "dynamics": {"rho_inf": 1}, "supports": ["clamp"], "clamp": {"surface": "bar.xmin", "components": ["x", "y", "z"]},
             "loads": ["pull"], "pull": {"surface": "bar.xmax", "traction": [0.3, 0.3, 0], "curve": curve}, "steps": {"count": 32},
             "probes": ["tip"], "tip": {"body": "bar", "point": [1, 0, 0]}, "output": {"vtu": "none", "csv": "none"}}
    for law in LAWS:
        for rho, damping in ((1, 0), (0.8, 0), (0.5, 0.05)):
            ends = []
            for n in (64, 128, 256):
                result = run(driver, "orders", scene, "-steps_count", str(n), "-bar_material", law, "-dynamics_rho_inf", str(rho), "-dynamics_stiffness_damping", str(damping),
                             label=f"orders_{law}_{rho}_{n}")
                table = energy(result)
                ends.append(np.array([*result.steps[-1]["probes"]["tip"], *(table[f"momentum_{axis}"][-1] for axis in "xyz")]))
            order = math.log2(np.linalg.norm(ends[0] - ends[1]) / np.linalg.norm(ends[1] - ends[2]))
            verdicts.near(f"{law}, rho_inf {rho}, damping {damping}: order in dt", order, 2, ORDER_BOUND, "64, 128, 256 steps")
        block = spin("plane_strain", 4, 0.3, 133, material=law)
        table = energy(run(driver, "dissipates", block, "-dynamics_rho_inf", "0.8", label=f"dissipates_{law}"))
        verdicts.below(f"{law} spins, rho_inf 0.8: a gain", total(table).max() / total(table)[0] - 1, GAIN_BOUND, "0.1 and more by stresses of the mean place")
        told = run(driver, "gains", spin("plane_strain", 4, 0.72, 56, material=law), "-dynamics_rho_inf", "0.9", label=f"gains_{law}", expect=None)
        table = energy(told)
        verdicts.at_least(f"{law} spins by 0.72 a step, rho_inf 0.9: what it gains", table["numerical"].max() / total(table)[0], TOLD, "of its energy: too much")
        verdicts.true(f"{law} spins by 0.72 a step, rho_inf 0.9: it is told", "numerical" in told.summary["energy_told"] and "With rho_inf below 1" in told.text, "with its cause")


def tangents(verdicts, driver):
    """Every iterate of a step in which a body turns, is strained, meets another and is damped. Its facets are no parallelograms any more: with the default rule
    tangents are off by that rule's error, 4e-7 here."""
    block = {"type": "box", "young": 10, "poisson": 0.3, "density": 1}
    scene = {"schema": 1, "bodies": ["upper", "lower"], "upper": {**block, "lower": [0.1, 0.1, 1], "upper": [0.8, 0.9, 1.4], "cells": [2, 1, 1], "velocity": [0.5, 0.2, -0.5], "spin": [0.9, 0.4, 2], "about": [0.4, 0.5, 1]},
             "lower": {**block, "lower": [0, 0, 0.5], "upper": [1, 1, 1], "cells": [2, 2, 1]}, "dynamics": {"rho_inf": 1},
             "supports": ["ground"], "ground": {"surface": "lower.zmin", "components": ["x", "y", "z"]},
             "interfaces": ["c"], "c": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "friction": 0.3, "quadrature": "degree_10"}, "steps": {"times": [0.05, 0.1]}, "output": {"vtu": "none", "csv": "none"}}
    damping = ("-dynamics_stiffness_damping", "0.02", "-dynamics_mass_damping", "0.5")
    for law in LAWS:
        both = ("-upper_material", law, "-lower_material", law)
        for label, options in {"": (), ", mean": ("-upper_dilatation", "mean"), ", damped": damping, ", beside a linear body, damped": ("-lower_material", "linear", *damping), ", rho_inf 0.5, mean, damped": ("-dynamics_rho_inf", "0.5", "-upper_dilatation", "mean", *damping)}.items():
            result = run(driver, "tangents", scene, "-test_jacobian_blocks", *both, *options, label=f"tangents_{law}" + label.replace(" ", "_").replace(",", ""))
            tests = [test for step in result.steps for test in step["jacobian_tests"] if test["switches"] == 0]
            errors = [part["error"] / part["norm"] for test in tests for part in test["blocks"] if part["norm"]]
            verdicts.below(f"tangent, {law}{label}", worst(errors), JACOBIAN_BOUND, f"{len(tests)} iterates against central differences")
