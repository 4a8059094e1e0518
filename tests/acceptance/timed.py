"""Supports that are let go, and such that are activated: what is left of the reaction, where nodes are held, on 1 to 3 ranks, with
automatic steps, beside contact in both forms, across a restart."""

import numpy as np

from jacobian import whole_matrix
from ranks import CONDENSED
from restart import BITS, BOX, COSTS, KEEP, pad
from scene import write

# Closed forms: Newton's tolerance of 1e-11, and rounding.
EXACT_BOUND = 1e-9
# Two ways to one answer, each to Newton's tolerance.
SAME_BOUND = 1e-8
# Ranks add in another order.
RANKS_BOUND = 1e-10
YOUNG, LENGTH, PULL = 1000.0, 2.0, 0.1


def timed(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    let_go(verdicts, driver)
    activated(verdicts, driver)
    automatic(verdicts, driver)
    clamped(verdicts, driver)
    by_contact(verdicts, driver)
    multigrid(verdicts, driver)
    on_multipliers(verdicts, driver)
    refused(verdicts, driver)


def bar(**more):
    """A bar without Poisson's effect whose end is drawn."""
    return {
        "schema": 1,
        "bodies": ["bar"],
        "bar": {**BOX, "young": YOUNG, "poisson": 0, "lower": [0, 0, 0], "upper": [LENGTH, 1, 1], "cells": [4, 2, 1], "small_strain": True},
        "supports": ["wall", "rails", "draw"],
        "wall": {"surface": "bar.xmin", "components": ["x", "y", "z"]},
        "rails": {"body": "bar", "components": ["y", "z"]},
        "draw": {"surface": "bar.xmax", "components": ["x"], "value": [PULL, 0, 0], "curve": [0, 0, 1, 1], "until": 1},
        "steps": {"times": [0.5, 1, 1.25, 1.5, 2]},
        "probes": ["end"],
        "end": {"body": "bar", "point": [LENGTH, 0, 0]},
        **more,
    }


def ends(run):
    return {step["t"]: step["probes"]["end"][0] for step in run.steps}


def let_go(verdicts, driver):
    """Drawn up to t = 1, then let go: the reaction fades up to the next time, over a time that is given, or is gone at once."""
    force = YOUNG * PULL / LENGTH
    for name, fade, factors in (("to the next time", None, (0, 0, 0)), ("over a time", 1.0, (0.75, 0.5, 0)), ("at once", 0.0, (0, 0, 0))):
        scene = bar()
        if fade is not None:
            scene["draw"]["fade"] = fade
        path = write(scene, driver.output / f"let_go_{name.replace(' ', '_')}.yaml")
        for ranks in (1, 2, 3) if fade else (1,):
            run = driver.run(path, *(("-snes_test_jacobian",) if ranks == 1 else ()), ranks=ranks, label=f"let_go_{ranks}")
            found = ends(run)
            exact = {0.5: 0.5, 1: 1, **dict(zip((1.25, 1.5, 2), factors))}
            error = max(abs(found[t] / PULL - f) for t, f in exact.items())
            verdicts.below(f"let go {name}, {ranks} ranks: the end", error, EXACT_BOUND, "as far as the force that is left draws it")
            held, free = run.steps[1]["reactions"]["draw"][0], max(abs(step["reactions"]["draw"][0]) for step in run.steps[2:])
            verdicts.near(f"let go {name}, {ranks} ranks: reaction", held, force, EXACT_BOUND, "while it holds")
            verdicts.near(f"let go {name}, {ranks} ranks: reaction after", free, 0, EXACT_BOUND, "none", scale=force)
            left = {step["t"]: step.get("fading", {}).get("draw", [0.0])[0] for step in run.steps}
            error = max(abs(left[t] / force - f) for t, f in ((1, 0), *zip((1.25, 1.5, 2), factors)))
            verdicts.below(f"let go {name}, {ranks} ranks: what is left of the reaction", error, EXACT_BOUND, "as summary.json has it")
            shares(verdicts, f"let go {name}, {ranks} ranks", run)
            if ranks == 1:
                whole_matrix(verdicts, f"let go {name}", run)


def shares(verdicts, name, run):
    """The rails hold what the wall holds, too: both have its reaction, and the sum of all has it once."""
    first = run.steps[0]
    verdicts.true(f"{name}: which supports share", first["reactions_shared"] == {"rails": ["wall"]}, f"{first['reactions_shared']}")
    apart = np.abs(np.array(first["reactions_total"])).max() / (YOUNG * PULL / LENGTH)
    verdicts.below(f"{name}: sum of all reactions", apart, EXACT_BOUND, "zero without loads, nothing twice")


def activated(verdicts, driver):
    """A bar under a load that grows is held at its end where it is at t = 1, then moved from there; the load that grows goes into the
    support."""
    traction, move = 40.0, -0.01
    scene = bar(
        draw={"surface": "bar.xmax", "components": ["x"], "value": [move, 0, 0], "curve": [1.5, 0, 2, 1], "from": 1},
        loads=["pull"],
        pull={"surface": "bar.xmax", "traction": [traction, 0, 0], "curve": [0, 0, 2, 1]},
    )
    path = write(scene, driver.output / "activated.yaml")
    at_change = 0.5 * traction / YOUNG * LENGTH
    for ranks in (1, 3):
        run = driver.run(path, *(("-snes_test_jacobian",) if ranks == 1 else ()), ranks=ranks, label=f"activated_{ranks}")
        found = ends(run)
        exact = {0.5: at_change / 2, 1: at_change, 1.25: at_change, 1.5: at_change, 2: at_change + move}
        verdicts.below(f"activated, {ranks} ranks: the end", max(abs(found[t] - u) for t, u in exact.items()) / at_change, EXACT_BOUND, "held, then moved")
        reaction = exact[2] / LENGTH * YOUNG - traction
        verdicts.near(f"activated, {ranks} ranks: reaction", run.steps[-1]["reactions"]["draw"][0], reaction, EXACT_BOUND, "what the bar and the load leave")
        if ranks == 1:
            whole_matrix(verdicts, "activated", run)


def automatic(verdicts, driver):
    """A time of change is the end of a step, though nobody asked for it."""
    scene = bar(steps={"end": 2, "automatic": True, "largest": 0.45})
    scene["draw"]["until"], scene["draw"]["fade"] = 1.1, 0.5
    run = driver.run(write(scene, driver.output / "automatic.yaml"))
    times = [step["t"] for step in run.steps]
    verdicts.true("automatic steps: a time of change is met", any(abs(t - 1.1) < 1e-12 for t in times), f"{times}")
    verdicts.below("automatic steps: the end at last", abs(ends(run)[2]) / PULL, EXACT_BOUND, "back")
    scene = bar(steps={"end": 2, "count": 3})
    scene["draw"]["until"] = 1.1
    times = [step["t"] for step in driver.run(write(scene, driver.output / "unasked.yaml")).steps]
    verdicts.true("equal steps: a time of change is met", len(times) == 4 and abs(times[1] - 1.1) < 1e-12, f"{times}")
    # Where the scene does not say a reaction fades in one step, whether `stages` have more, or `automatic` steps have no other end.
    for name, steps, after in (("stages", {"stages": [1, 2, 2, 4]}, 1.25), ("automatic steps", {"end": 2, "automatic": True, "initial": 0.1, "largest": 0.2}, 1.1)):
        run = driver.run(write(bar(steps=steps), driver.output / "one_step.yaml"), label=f"one_step_{name.replace(' ', '_')}")
        left = [step["t"] for step in run.steps if step["t"] > 1 and "fading" in step]
        verdicts.true(f"{name}: it fades in one step", all(t < after - 1e-9 for t in left), f"left at {left}")
        verdicts.below(f"{name}: the end at last", abs(ends(run)[2]) / PULL, EXACT_BOUND, "back")


def clamped(verdicts, driver):
    """A rubber beam is bent by its end and let go; then its end is held where it is, and let go again: it comes back to where it
    began."""
    scene = {
        "schema": 1,
        "bodies": ["beam"],
        "beam": {**BOX, "lower": [0, 0, 0], "upper": [4, 1, 1], "cells": [8, 1, 2], "material": "neo_hooke"},
        "supports": ["foot", "bend", "again"],
        "foot": {"surface": "beam.xmin", "components": ["x", "y", "z"]},
        "bend": {"surface": "beam.xmax", "components": ["x", "z"], "value": [-0.8, 0, 2], "curve": [0, 0, 1, 1], "until": 1, "fade": 1},
        "again": {"surface": "beam.xmax", "components": ["x", "z"], "value": [0, 0, 0.2], "curve": [1.5, 0, 2, 1], "from": 1.5, "until": 2},
        "steps": {"times": [0.25, 0.5, 0.75, 1, 1.25, 1.5, 2, 2.5, 3]},
        "probes": ["end"],
        "end": {"body": "beam", "point": [4, 0, 0]},
    }
    path = write(scene, driver.output / "clamped.yaml")
    runs = [driver.run(path, *BITS, *KEEP, ranks=ranks, label=f"clamped_{ranks}") for ranks in (1, 2)]
    found = {step["t"]: np.array(step["probes"]["end"]) for step in runs[0].steps}
    verdicts.below("rubber beam: moved from where it was", np.abs(found[2] - found[1.5] - [0, 0, 0.2])[[0, 2]].max(), EXACT_BOUND, "while it is held")
    verdicts.at_least("rubber beam: still bent", found[1.5][2], 0.2, "half of the reaction is left")
    verdicts.below("rubber beam: back at last", np.abs(found[3]).max(), SAME_BOUND, "nothing holds it")
    apart = max(np.abs(np.array(a["probes"]["end"]) - b["probes"]["end"]).max() for a, b in zip(*(run.steps for run in runs)))
    verdicts.below("rubber beam: 1 and 2 ranks", apart, RANKS_BOUND, "the same")
    whole = runs[0]
    for step in (3, 4, 6, 7):  # before, at and after a support changes
        again = driver.run(path, *BITS, "-restart", whole.directory / f"restart_{step}.bin", label="clamped_again")
        differ = [key for key in whole.summary if key not in COSTS and whole.summary[key] != again.summary.get(key)]
        verdicts.true(f"rubber beam, restart from step {step}: bits", not differ, "; ".join(differ) or "those of the run that goes through")


def by_contact(verdicts, driver):
    """A pad is pressed on a base by its grip, which is let go; a weight stays, and friction alone holds the pad from then on. The same
    run with the grip's reaction given as a load ends at the same place."""
    parts = dict(
        supports=["ground", "grip"],
        upper={"density": 1},
        grip={"value": [0, 0, -0.01], "curve": [0, 0, 1, 1], "until": 1},
        loads=["weight"],
        weight={"body": "upper", "gravity": [0.5, 0, -9.81], "curve": [0, 0, 1, 1]},
        steps={"times": [0.5, 1, 1.5, 2]},
    )
    tables, dual = {}, {"basis": "dual"}
    for name, contact, options, ranks in (("multipliers", dual, (), 1), ("condensed", dual, CONDENSED, 1), ("two ranks", dual, (), 2)):
        run = driver.run(write(pad(**parts, contact=contact), driver.output / "pad.yaml"), *options, ranks=ranks, label=f"pad_{name.replace(' ', '_')}")
        tables[name] = run.interface("contact")
        weight = 9.81 * 1.0 * 0.8 * 0.5
        force = run.resultant("contact")
        verdicts.below(f"pad that is let go, {name}: force of the base", np.abs(force - [-0.5 / 9.81 * weight, 0, weight]).max() / weight, SAME_BOUND, "its weight")
        verdicts.true(f"pad that is let go, {name}: said", "upper is free to" in run.text, "contact must hold it from then on")
    scale = np.abs(tables["multipliers"]["lambda_n"]).max()
    for name, table in tables.items():
        error = np.abs(table["lambda_n"] - tables["multipliers"]["lambda_n"]).max() / scale
        verdicts.below(f"pad that is let go, {name}: pressures", error, SAME_BOUND, "those with multipliers")
    verdicts.true("pad that is let go: held again", (tables["multipliers"]["state"] == "stick").any(), "some nodes stick")


def multigrid(verdicts, driver):
    """The bar that is let go, and a pad on a base whose contact surface is held as well for a while: by multigrid as by the direct solver."""
    pressed = pad(
        supports=["ground", "grip", "top"],
        upper={"density": 1},
        grip={"value": [0, 0, -0.01], "curve": [0, 0, 1, 1], "until": 1},
        loads=["weight"],
        weight={"body": "upper", "gravity": [0.5, 0, -9.81], "curve": [0, 0, 1, 1]},
        steps={"times": [0.5, 1, 1.5, 2]},
        contact={"basis": "dual"},
    ) | {"top": {"surface": "lower.zmax", "components": ["x", "y", "z"], "until": 1.5}}
    for name, scene, options in (("bar", bar(), ()), ("pad", pressed, CONDENSED)):
        path = write(scene, driver.output / f"multigrid_{name}.yaml")
        direct = driver.run(path, *options, label=f"multigrid_{name}_direct")
        run = driver.run(path, *options, "-solver", "iterative", label=f"multigrid_{name}")
        scale = max(np.abs(step["reactions"][s]).max() for step in direct.steps for s in step["reactions"])
        apart = max(np.abs(np.array(a["reactions"][s]) - b["reactions"][s]).max() for a, b in zip(run.steps, direct.steps) for s in a["reactions"])
        verdicts.below(f"{name}, multigrid: reactions", apart / scale, SAME_BOUND, "those of the direct solver")
        solver = run.summary["linear_solver"]
        verdicts.true(f"{name}, multigrid: solves", solver["direct"] == 0 and solver["most"] <= 40, f"{solver}")


MORE = {"surface": "upper.zmin", "value": [0.2, 0.03, -0.02], "curve": [0, 0, 1, 1, 2, 0.4]}


def on_multipliers(verdicts, driver):
    """The non-mortar side itself is held, as far as the grip goes. To the end of the run that is what a support does that holds from start to end; let go
    earlier a pad without friction, or tied to its base, is where it would be had nothing but its grip ever held it."""
    for law, contact in (("coulomb", {}), ("none", {"law": "none"}), ("tied", {"law": "tied"}), ("augmented", {"form": "augmented"})):
        for components in (["x"], ["x", "y", "z"]):
            runs = {}
            for until in (None, 2, 1, 0):
                scene = pad(supports=["ground", "grip", "more"] if until != 0 else ["ground", "grip"], contact=contact)
                if law in ("none", "tied"):
                    del scene["contact"]["friction"]
                if until != 0:
                    scene["more"] = {**MORE, "components": components, **({"until": until} if until else {})}
                if until != 0 or law in ("none", "tied"):
                    runs[until] = driver.run(write(scene, driver.output / "more.yaml"), "-output_vtu", "none", label=f"more_{law}_{len(components)}_{until}")
            for what, a, b in (("to the end", 2, None), ("let go", 1, 0)):
                if b not in runs:
                    continue
                tables = [runs[k].interface("contact") for k in (a, b)]
                apart = np.abs(tables[0]["lambda_n"] - tables[1]["lambda_n"]).max() / np.abs(tables[1]["lambda_n"]).max()
                verdicts.below(f"nodes with multipliers held {what}, {law}, {''.join(components)}: pressures", apart, SAME_BOUND, "the same")
                moved = [np.array(runs[k].steps[-1]["reactions"]["ground"]) for k in (a, b)]
                verdicts.below(f"nodes with multipliers held {what}, {law}, {''.join(components)}: reactions", np.abs(moved[0] - moved[1]).max() / np.abs(moved[1]).max(), SAME_BOUND, "the same")
    for ranks, options in ((3, ()), (1, ("-solver", "iterative"))):
        scene = pad(supports=["ground", "grip", "more"], more={**MORE, "components": ["x"], "until": 1})
        one, other = (driver.run(write(scene, driver.output / "more_ranks.yaml"), *o, ranks=r, label=f"more_ranks_{r}_{len(o)}").interface("contact") for r, o in ((1, ()), (ranks, options)))
        apart = np.abs(one["lambda_n"] - other["lambda_n"]).max() / np.abs(one["lambda_n"]).max()
        verdicts.below(f"nodes with multipliers held, {ranks} ranks, {' '.join(options) or 'direct'}: pressures", apart, SAME_BOUND, "the same")


def refused(verdicts, driver):
    draw = bar()["draw"]
    on_contact = pad(supports=["ground", "grip", "more"], more={"surface": "upper.zmin", "components": ["x"], "until": 1}, contact={"basis": "dual"})
    for what, scene, says in (
        ("that ends before it begins", bar(draw={**draw, "from": 1, "until": 0.5}), "draw.until: it must be after `from`, 1"),
        ("beyond the run", bar(draw={**draw, "until": 2.5}), "draw.until: the run ends at t = 2, before 2.5"),
        ("after the run", bar(draw={**{k: v for k, v in draw.items() if k != "until"}, "from": 2}), "draw.from: the run ends at t = 2"),
        ("before the run", bar(draw={**draw, "from": -1}), "draw.from: -1 is not allowed; it must be at least 0"),
        ("that fades and stays", bar(draw={**{k: v for k, v in draw.items() if k != "until"}, "fade": 1}), "draw.fade: only with `until`"),
        ("that turns from where it is", bar(draw={**draw, "from": 0.5, "rotate": [1, 0, 0]}), "draw.rotate: a support that is activated"),
        ("on a node of another one", bar(supports=["wall", "rails", "draw", "other"], other=draw), "other.components: 'draw' holds one of its vertices"),
        ("on multipliers that are no unknowns", {**on_contact, "unknowns": "displacements"}, "with `unknowns: displacements` a multiplier is found from its node's row"),
        ("on both sides", {**on_contact, "ground": {"body": "lower", "components": ["x", "y", "z"]}}, "more.until: it holds nodes of 'upper.zmin'"),
    ):
        run = driver.run(write(scene, driver.output / "refused.yaml"), label="refused", expect=1)
        verdicts.true(f"a support {what}: refused", says in run.text and "PETSC ERROR" not in run.text, f"says: {says}")
