"""Supports of rigid bodies that change: pressed, turned and let go, caught, in statics and with inertia, against closed forms, against
supports that hold from start to end, and against loads that hold the same."""

import numpy as np

from dynamics import energy, total
from jacobian import whole_matrix
from restart import BITS, BOX, COSTS, KEEP, pad
from scene import write

# Closed forms: Newton's tolerance of 1e-11 of the forces, and rounding, over 20 steps.
EXACT_BOUND = 1e-9
# Two ways to one answer, each to Newton's tolerance.
SAME_BOUND = 1e-8
GRAVITY = 10.0
BLOCK = {"type": "rigid", "from": "box", "lower": [0, 0, 0], "upper": [1, 2, 3], "cells": [1, 1, 1], "reference": [0.5, 1, 1.5]}


def timed_rigid(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    to_the_end(verdicts, driver)
    pressed(verdicts, driver)
    turned(verdicts, driver)
    thrown(verdicts, driver)
    spun(verdicts, driver)
    moved_in_part(verdicts, driver)
    refused(verdicts, driver)


def run(driver, name, scene, *options, **more):
    return driver.run(write(scene, driver.output / f"{name}.yaml"), *options, label=more.pop("label", name), **more)


def motion(result, body="upper", key="displacement"):
    return {round(step["t"], 9): np.array(step["rigid"][body][key]) for step in result.steps}


def plate(**more):
    """A rigid plate on a base, held but for what `grip` has."""
    rigid = {"type": "rigid", "from": "box", "lower": [0.1, 0.1, 0], "upper": [1.1, 0.9, 0.5], "cells": [3, 2, 1], "reference": [0.6, 0.5, 0.25]}
    scene = pad(supports=["ground", "guide", "grip"], guide={"body": "upper", "components": ["x", "y", "rx", "ry", "rz"]}, **more)
    scene["upper"] = rigid
    return scene


def to_the_end(verdicts, driver):
    """Let go at the end of the run is held from start to end, for all six unknowns, on either side of the interface."""
    curve = [0, 0, 1, 1, 2, 0.4]
    grip = {"body": "upper", "components": ["x", "y", "z", "rx", "ry", "rz"], "value": [0.2, 0.03, -0.02], "curve": curve, "rotate": [0, 0.01, 0.2]}
    swap = {"nonmortar": "lower.zmax", "mortar": "upper.zmin", "friction": 0.3}
    for name, contact in (("non-mortar", {}), ("mortar", swap)):
        both = []
        for until in (None, 2):
            scene = plate(contact=contact)
            scene["supports"], scene["grip"] = ["ground", "grip"], grip if until is None else {**grip, "until": until}
            del scene["guide"]
            both.append(run(driver, "to_the_end", scene, label=f"to_the_end_{name}_{until}"))
        for kind in ("reactions", "moments"):
            scale = max(np.abs(step[kind]["grip"]).max() for step in both[0].steps)
            apart = max(np.abs(np.array(a[kind]["grip"]) - b[kind]["grip"]).max() for a, b in zip(*(result.steps for result in both)))
            verdicts.below(f"rigid {name} side held to the end: {kind}", apart / scale, SAME_BOUND, "as without `until`")


def pressed(verdicts, driver):
    """Pressed by its support, then let go under a weight: it ends as by its weight alone, and the reaction fades as it is told."""
    weight = 5.0
    loads = dict(loads=["weight"], weight={"body": "upper", "force": [0, 0, -weight], "curve": [0, 0, 1, 1]})
    grip = {"body": "upper", "components": ["z"], "value": [0, 0, -0.01], "curve": [0, 0, 1, 1], "until": 1, "fade": 1}
    contact = {"law": "none"}
    alone = plate(contact=contact, **loads)
    held = plate(contact=contact, **loads)
    for scene in (alone, held):
        del scene["contact"]["friction"]
    held["grip"] = grip
    alone["supports"] = ["ground", "guide"]
    del alone["grip"]
    bare = motion(run(driver, "alone", alone))
    for ranks in (1, 2):
        result = run(driver, "pressed", held, *(("-snes_test_jacobian",) if ranks == 1 else ()), label=f"pressed_{ranks}", ranks=ranks)
        found = motion(result)
        verdicts.near(f"plate let go, {ranks} ranks: while it is held", found[1][2], -0.01, EXACT_BOUND, "where it is told")
        verdicts.near(f"plate let go, {ranks} ranks: at the end", found[2][2], bare[2][2], SAME_BOUND, "by its weight alone")
        left, reaction = result.steps[2]["fading"]["grip"][2], result.steps[1]["reactions"]["grip"][2]
        verdicts.near(f"plate let go, {ranks} ranks: what is left", left, reaction / 2, EXACT_BOUND, "half of the reaction")
        verdicts.near(f"plate let go, {ranks} ranks: the base", result.resultant("contact", 2)[2], weight - left, SAME_BOUND, "carries weight and what is left")
        if ranks == 1:
            whole_matrix(verdicts, "plate let go", result)


def turned(verdicts, driver):
    """A plate on a bar is turned, let go over a second, caught on its way back, turned on from there and let go: the bar takes it back to where it began."""
    scene = {
        "schema": 1,
        "bodies": ["bar", "upper"],
        "bar": {**BOX, "lower": [0, 0, 0], "upper": [1, 1, 3], "cells": [2, 2, 3], "material": "neo_hooke"},
        "upper": {"type": "rigid", "from": "box", "lower": [0, 0, 3], "upper": [1, 1, 3.2], "cells": [2, 2, 1], "reference": [0.5, 0.5, 3]},
        "supports": ["foot", "twist", "again"],
        "foot": {"surface": "bar.zmin", "components": ["x", "y", "z"]},
        "twist": {"body": "upper", "components": ["rx", "ry", "rz"], "rotate": [0, 0, 0.8], "curve": [0, 0, 1, 1], "until": 1, "fade": 1},
        "again": {"body": "upper", "components": ["z", "rz"], "value": [0, 0, 0.1], "rotate": [0, 0, 0.2], "curve": [1.5, 0, 2, 1], "from": 1.5, "until": 2},
        "interfaces": ["tie"],
        "tie": {"nonmortar": "bar.zmax", "mortar": "upper.zmin", "law": "tied"},
        "steps": {"times": [0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2, 2.25, 2.5]},
    }
    path = write(scene, driver.output / "turned.yaml")
    whole = driver.run(path, *BITS, *KEEP, label="turned")
    # About z all the way, so that rotation vectors add up.
    angle, place = motion(whole, key="rotation"), motion(whole)
    verdicts.near("turned plate: as told", angle[1][2], 0.8, EXACT_BOUND, "while it is held")
    verdicts.at_least("turned plate: still turned", angle[1.5][2], 0.1, "half of the moment is left")
    verdicts.near("turned plate: turned on from where it was caught", angle[2][2] - angle[1.5][2], 0.2, EXACT_BOUND, "while it is held")
    verdicts.near("turned plate: moved from where it was caught", place[2][2] - place[1.5][2], 0.1, EXACT_BOUND, "while it is held")
    verdicts.below("turned plate: back at last", max(np.abs(angle[2.5]).max(), np.abs(place[2.5]).max()), SAME_BOUND, "nothing holds it")
    other = driver.run(path, *BITS, ranks=2, label="turned_ranks")
    apart = max(np.abs(u - v).max() for u, v in zip(angle.values(), motion(other, key="rotation").values()))
    verdicts.below("turned plate: 1 and 2 ranks", apart, SAME_BOUND, "the same")
    for step in (3, 4, 6, 8):
        again = driver.run(path, *BITS, *KEEP, "-restart", whole.directory / f"restart_{step}.bin", label="turned_again")
        differ = [key for key in whole.summary if key not in COSTS and whole.summary[key] != again.summary.get(key)]
        verdicts.true(f"turned plate, restart from step {step}: bits", not differ, "; ".join(differ) or "those of the run that goes through")


def flying(supports, **maps):
    return {
        "schema": 1,
        "bodies": ["upper"],
        "upper": {**BLOCK, "density": 0.5},
        "dynamics": {"rho_inf": 1},
        "supports": supports,
        "steps": {"end": 2, "count": 20},
        "output": {"vtu": "none", "csv": "none"},
        **maps,
    }


ALL = ["x", "y", "z", "rx", "ry", "rz"]


def thrown(verdicts, driver):
    """Carried along, let go, in flight, caught, moved on: m v^2 / 2, and the weight at rest."""
    speed, fall, mass = np.array([0.6, 0.2, 0.4]), np.array([0, 0, -GRAVITY]), 3.0
    scene = flying(
        ["hand", "catch"],
        hand={"body": "upper", "components": ALL, "value": [*(speed / 2)], "curve": [0, 0, 0.5, 1], "until": 0.5},
        catch={"body": "upper", "components": ALL, "value": [0, 0, 0.3], "curve": [1.5, 0, 2, 1], "from": 1},
        loads=["weight"],
        weight={"body": "upper", "gravity": [*fall], "curve": [0, 1, 2, 1]},
    )
    caught = speed + fall / 2 * 0.5**2
    for ranks in (1, 2):
        result = run(driver, "thrown", scene, label=f"thrown_{ranks}", ranks=ranks)
        error = 0
        for t, u in motion(result).items():
            exact = speed * t + (fall / 2 * (t - 0.5) ** 2 if t > 0.5 else 0) if t <= 1 else caught + np.array([0, 0, 0.6 * max(t - 1.5, 0)])
            error = max(error, np.abs(u - exact).max())
        verdicts.below(f"thrown rigid body, {ranks} ranks: place", error, EXACT_BOUND, "carried, in flight, caught and moved")
        table = energy(result)
        at = {round(step["t"], 9): k + 1 for k, step in enumerate(result.steps)}
        for t, v in ((0.5, speed), (1, speed + 0.5 * fall), (1.1, 0 * fall), (2, np.array([0, 0, 0.6]))):
            verdicts.near(f"thrown rigid body, {ranks} ranks: energy of motion at {t}", table["kinetic"][at[t]], mass * v @ v / 2, EXACT_BOUND, "m v^2 / 2", scale=mass * speed @ speed)
        verdicts.below(f"thrown rigid body, {ranks} ranks: energy balance", np.abs(table["numerical"]).max() / total(table).max(), EXACT_BOUND, "the catch has taken what it stopped")
        verdicts.near(f"thrown rigid body, {ranks} ranks: reaction", result.steps[at[1.3] - 1]["reactions"]["catch"][2], mass * GRAVITY, EXACT_BOUND, "the weight, at rest")


def spun(verdicts, driver):
    """Turned about one of its main axes and let go: it spins on as fast. Then it is caught; where its centre is free, it moves on."""
    rate, mass, speed = 0.4, 3.0, np.array([0, 0, 0.3])
    inertia = mass * (1**2 + 2**2) / 12
    scene = flying(
        ["hand", "catch"],
        hand={"body": "upper", "components": ["rx", "ry", "rz"], "rotate": [0, 0, rate / 2], "curve": [0, 0, 0.5, 1], "until": 0.5},
        catch={"body": "upper", "components": ["rx", "ry", "rz"], "from": 1.5},
    )
    scene["upper"]["velocity"] = [*speed]
    result = run(driver, "spun", scene)
    table = energy(result)
    at = {round(step["t"], 9): k + 1 for k, step in enumerate(result.steps)}
    # The midpoint rule turns by 2 atan(w dt / 2) a step where it spins by w.
    slow = 2 * np.arctan(rate * 0.1 / 2) / 0.1
    angle = motion(result, key="rotation")
    error = max(abs(turn[2] - (rate * t if t <= 0.5 else rate * 0.5 + slow * (min(t, 1.5) - 0.5))) for t, turn in angle.items())
    verdicts.below("spun: angle", error, EXACT_BOUND, "turned, spinning, caught")
    verdicts.below("spun: place", max(np.abs(u - speed * t).max() for t, u in motion(result).items()), EXACT_BOUND, "v t")
    for t, spin in ((0.3, rate), (0.5, rate), (1.5, rate), (1.6, 0), (2, 0)):
        exact = mass * speed @ speed / 2 + inertia * spin**2 / 2
        verdicts.near(f"spun: energy of motion at {t}", table["kinetic"][at[t]], exact, EXACT_BOUND, "of centre and spin")
    verdicts.below("spun: energy balance", np.abs(table["numerical"]).max() / total(table).max(), EXACT_BOUND, "supports have turned and caught it")


def moved_in_part(verdicts, driver):
    """Moved along x by a support from start to end, with a kink, and free to fall: the support works what it moves with."""
    scene = flying(
        ["slide"],
        slide={"body": "upper", "components": ["x", "rx", "ry", "rz"], "value": [1, 0, 0], "curve": [0, 0, 1, 0.4, 2, 1.6]},
        loads=["weight"],
        weight={"body": "upper", "gravity": [0, 0, -GRAVITY], "curve": [0, 1, 2, 1]},
    )
    result = run(driver, "in_part", scene)
    table = energy(result)
    for t, u in motion(result).items():
        if t in (1, 2):
            exact = np.array([0.4 * t if t <= 1 else 1.6, 0, -GRAVITY / 2 * t**2])
            verdicts.below(f"moved in part: place at {t}", np.abs(u - exact).max() / GRAVITY, EXACT_BOUND, "moved, and falling")
            speed = 0.8 if t == 1 else 1.2
            verdicts.near(f"moved in part: energy of motion at {t}", table["kinetic"][round(10 * t)], 3 / 2 * (speed**2 + (GRAVITY * t) ** 2), EXACT_BOUND, "the mean speed at the kink")
    verdicts.below("moved in part: energy balance", np.abs(table["numerical"]).max() / total(table).max(), EXACT_BOUND, "impulses work with the mean velocity")


def refused(verdicts, driver):
    half = {"body": "upper", "components": ["rz"], "rotate": [0, 0, 0.2], "until": 1}
    grip = {"body": "upper", "components": ["z"], "value": [0, 0, -0.01]}
    for what, scene, says in (
        ("that turns a free body in part", flying(["half"], half=half), "half.rotate: 'upper' is free to turn in part"),
        ("that catches it in part", flying(["half"], half={"body": "upper", "components": ["rz"], "from": 1}), "half.from: 'upper' is free to turn in part"),
        ("of what another one holds", {**plate(), "supports": ["ground", "grip", "guide"], "grip": grip, "guide": {**grip, "until": 1}}, "guide.components: 'grip' prescribes z of this body already"),
    ):
        result = driver.run(write(scene, driver.output / "refused.yaml"), label="refused", expect=1)
        verdicts.true(f"a support {what}: refused", says in result.text and "PETSC ERROR" not in result.text, f"says: {says}")
