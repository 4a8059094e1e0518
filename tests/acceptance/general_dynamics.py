"""General contact of bodies with inertia: what named pairs give, energy and momentum kept, nobody passes through, restarts and ranks."""

import numpy as np
from dynamics import energy, total
from general import SAME
from general_models import BOX, NONE, shipped
from ranks import compare
from restart import same_bits
from scene import write

# Two runs of the same problem, sums in another order: Newton's tolerance in each of 60 steps.
SAME_RUN = 1e-9
# What contact gives, and momentum that is lost, over those at the start: rounding and Newton's tolerance.
GAINED = 1e-12
HEAVY = {**BOX, "density": 1}


def general_dynamics(verdicts, driver):
    bars(verdicts, driver)
    for friction in (0, 0.3):
        bounce(verdicts, driver, friction)
    free(verdicts, driver)
    fast(verdicts, driver)
    again(verdicts, driver)


def run(driver, label, scene):
    return driver.run(write(scene, driver.output / "scenes" / f"{label}.yaml"), label=label)


def largest_difference(one, two, *columns):
    """Over the energy at the start."""
    one, two = energy(one), energy(two)
    return max(np.abs(one[key] - two[key]).max() for key in columns) / total(two)[0]


def bars(verdicts, driver):
    named = shipped("two_bars", output=NONE)
    scene = {key: value for key, value in named.items() if key not in ("interfaces", "contact")} | {"contact": "all"}
    whole, pairs = run(driver, "bars", scene), run(driver, "bars_named", named)
    verdicts.below("two bars: energies against a named pair", largest_difference(whole, pairs, "kinetic", "strain", "contact_work"), SAME, "the same roles")
    verdicts.true("two bars: weights", whole.summary["weights"]["all"]["weights"] == "conserving", "those that conserve, as of interfaces")


def thrown(**more):
    """A block that spins is thrown on a base, meets it with a corner, and flies off."""
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["block", "base"],
        "block": {**HEAVY, "lower": [0.2, 0.05], "upper": [0.8, 0.45], "cells": [6, 4], "velocity": [2, -3], "spin": 1.5},
        "base": {**HEAVY, "young": 3000, "lower": [0, -0.5], "upper": [3, 0], "cells": [31, 5]},
        "dynamics": {"rho_inf": 1},
        "supports": ["ground"],
        "ground": {"surface": "base.ymin", "components": ["x", "y"]},
        "steps": {"count": 60, "end": 0.3},
        "output": NONE,
        **more,
    }


def bounce(verdicts, driver, friction):
    """Pieces come and go as it turns."""
    scene = thrown(contact="all", friction=friction)
    sides = {"foot": "block.ymin", "left": "block.xmin", "right": "block.xmax"}
    named = thrown(interfaces=list(sides), **{key: {"nonmortar": face, "mortar": "base.ymax", "friction": friction} for key, face in sides.items()})
    whole, pairs = run(driver, f"bounce_{friction}", scene), run(driver, f"bounce_{friction}_named", named)
    about = f"a block thrown on a base, friction {friction}"
    verdicts.below(f"{about}: energies against named faces", largest_difference(whole, pairs, "kinetic", "strain", "friction_dissipation"), SAME_RUN, "the same roles")
    verdicts.below(f"{about}: what contact gives", energy(whole)["contact_gain"][-1] / total(energy(whole))[0], GAINED, "nothing")
    verdicts.at_least(f"{about}: interfaces made", whole.summary["general_contact"]["made"], 2, "as it turns")


def free(verdicts, driver):
    """Three free blocks of finite strain meet, each with both others: momentum and its moment stay, energy does not grow."""
    body = lambda lower, upper, cells, **more: {**HEAVY, "material": "neo_hooke", "lower": lower, "upper": upper, "cells": cells, **more}
    scene = {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["left", "right", "upper"],
        "left": body([-1.05, 0], [-0.05, 1], [5, 5], velocity=[2, 0], spin=0.5),
        "right": body([0.05, 0], [1.05, 1], [6, 6], velocity=[-2, 0]),
        "upper": body([-0.6, 1.1], [0.6, 1.7], [7, 4], velocity=[0.3, -3]),
        "dynamics": {"rho_inf": 1},
        "contact": "all",
        "steps": {"count": 20, "end": 0.1},
        "output": NONE,
    }
    whole = run(driver, "free", scene)
    table = energy(whole)
    size = total(table)[0]
    for key in ("momentum_x", "momentum_y", "angular_z"):
        verdicts.below(f"three free blocks: {key}, over the energy", np.abs(table[key] - table[key][0]).max() / size, GAINED, "kept")
    verdicts.below("three free blocks: what contact gives", table["contact_gain"][-1] / size, GAINED, "nothing")
    touched = {tuple(sorted(one["bodies"])) for one in whole.summary["general_contact"]["touching"]}
    verdicts.true("three free blocks: who met whom", len(touched) == 3, f"{sorted(touched)}")


def fast(verdicts, driver):
    """Over six times the reach in one step: the same step is solved again, from the same velocities."""
    scene = lambda reach: thrown(contact="all", all={"search_distance": reach}, steps={"count": 12, "end": 0.24}, block={
        **HEAVY, "lower": [0.2, 0.3], "upper": [0.8, 0.7], "cells": [6, 4], "velocity": [2, -18]})
    near, far = run(driver, "fast", scene(0.05)), run(driver, "fast_wide", scene(0.5))
    verdicts.below("a block that meets the base from out of reach: energies", largest_difference(near, far, "kinetic", "strain"), SAME_RUN, "what a large reach gives")
    verdicts.at_least("a block that meets the base from out of reach: steps solved again", near.summary["general_contact"]["missed"], 1, "it is noticed")


def again(verdicts, driver):
    """On from every step, and on several ranks."""
    scene = thrown(contact="all", friction=0.3, steps={"count": 12, "end": 0.06})
    same_bits(verdicts, driver, "a block thrown on a base", scene, (), lambda n: range(1, n))
    scene = {key: value for key, value in scene.items() if key != "output"}
    compare(verdicts, driver, write(scene, driver.output / "scenes" / "ranks_thrown.yaml"), "", (), (2, 3))
