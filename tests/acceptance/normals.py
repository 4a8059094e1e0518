"""Normals of the current configuration (`normals: current`): what is the same however a motion is split into steps.

The group `normals`; the longer lines are in normals_full.py.
"""

import re

import numpy as np
import turning
from idle import idle_steps, positions
from ironing import COARSE, history
from normals_scenes import dragged_ball
from scene import SCENES, multiplier, write
from slider import reaction, travel

CURRENT = ("-contact_normals", "current")
QUIET = ("-output_vtu", "none", "-output_csv", "none")

# A quarter turn in a bore, in few steps against THIRTY: multipliers and positions over their largest. All nodes slip at the
# end, so that nothing of the path is left but what Newton's tolerance (1e-13 of the forces) leaves: 6e-13 is measured.
BORE_FEW, BORE_MANY, BORE_BOUND = (1, 2, 4), 30, 1e-10
# The turned shaft, stuck: a rigid motion moves nothing against anything, so drift is rounding: 7e-14 of a facet is measured
# after 440 steps. With normals of t_n: 7.6e-6 while turning, 3.8e-9 at rest, in 50 steps.
DRIFT_BOUND = 1e-10
# Degrees in one step. At 15 Newton's method once threw the shaft out of the hub, where nothing touches: in equilibrium, too.
THROWN_OUT = (10, 15, 20)
# The press fit: every node slips, so that R_x and R_z are functions of the position alone. Each step against the one of 4 mm,
# over the force there: 2e-11 is measured, Newton's tolerance after some 1000 steps.
PRESS_STEPS, PRESS_AGAINST, PRESS_BOUND = (2, 1, 50), 4, 1e-9
# What normals of t_n are off by at least in steps of 50 mm: 60 % is measured; if not, the line above could not fail.
PRESS_LAG = 0.1
# Shallow ironing on the coarse mesh: some nodes stick for a while, so the history counts. V and H over V, d = 0.04 against
# d = 0.02 and at the same places: 3e-6 is measured.
IRONING_BOUND = 2e-5
# Without friction an elastic state depends on the position alone: N, 2 N and 4 N steps, the end force over its size: 1e-15
# is measured, and Newton's tolerance of 1e-11 allows no more than this.
SLIDE_BOUND = 1e-9
# A few scenes of those of `normals_full`.
IDLE = ("press_fit", "ball_in_block", "cattaneo_line", "shaft_in_bore", "patch_inclined", "two_blocks")


def normals(verdicts, driver):
    bore(verdicts, driver)
    turned_shaft(verdicts, driver)
    thrown_out(verdicts, driver)
    press_fit(verdicts, driver)
    ironing(verdicts, driver, COARSE, "coarse", (50, 100))
    frictionless(verdicts, driver)
    idle_steps(verdicts, driver, IDLE)


def bore(verdicts, driver):
    ends = {}
    for n in (BORE_MANY, *BORE_FEW):
        run = driver.run("shaft_in_bore", "-steps_stages", f"1,5,2,{n}", label=f"bore_{n}")
        label = f"a quarter turn in a bore in {n} steps"
        verdicts.below(f"{label}: cut-backs", run.summary["cutbacks"], 0, "each step converges")
        table = run.interface("contact")
        verdicts.below(f"{label}: nodes that do not slip", int((table["state"] != "slip").sum()), 0, "all of it slides")
        ends[n] = multiplier(table), positions(table)
        for what, ours, theirs in zip(("multipliers", "positions"), ends[n], ends[BORE_MANY]):
            apart = np.linalg.norm(ours - theirs, axis=1).max() / np.linalg.norm(theirs, axis=1).max()
            if n != BORE_MANY:
                verdicts.below(f"{label}: {what}", apart, BORE_BOUND, f"{BORE_MANY} steps")


def turned_shaft(verdicts, driver):
    for n in (50, 100, 200):
        run = driver.run("turned_shaft", *turning.steps(n), *CURRENT, label=f"turned_{n}")
        label = f"turned by 2 rad in {n} steps"
        verdicts.below(f"{label}: cut-backs", run.summary["cutbacks"], 0, "smooth motion")
        away = sum(step["interfaces"]["contact"][s] for step in run.steps for s in ("gap", "slip"))
        verdicts.below(f"{label}: nodes that do not stick", away, 0, "in any step")
        for when, last in (("while turning", 2 * n), ("at rest", len(run.steps))):
            drift = turning.drift(run, n, last)
            verdicts.below(f"{label}: drift {when}, over a facet", drift, DRIFT_BOUND, "a rigid motion")


def thrown_out(verdicts, driver):
    times = ", ".join(f"{k / 10:g}" for k in range(1, 11))
    scene = driver.output / "thrown_out.yaml"
    text = (SCENES / "turned_shaft.yaml").read_text()
    scene.write_text(re.sub(r"^steps:.*$", f"steps: {{times: [{times}, 2]}}", text, flags=re.MULTILINE))
    for degrees in THROWN_OUT:
        turn = ("-turn_rotate", f"0,0,{float(np.radians(degrees))!r}")
        run = driver.run(scene, *turn, *CURRENT, *QUIET, label=f"thrown_out_{degrees}")
        away = sum(run.steps[-1]["interfaces"]["contact"][s] for s in ("gap", "slip"))
        label = f"turned by {degrees} degrees in one step: nodes that do not stick"
        verdicts.below(label, away, 0, "it stays in its hub")


def press_fit(verdicts, driver):
    def forces(step, *options, label):
        run = driver.run("press_fit", *travel(1000, step), *options, *QUIET, label=f"press_fit_{label}_{step}")
        return {round(s["t"], 6): reaction(s) for s in run.steps if s["t"] > 1 + 1e-6}

    exact = forces(PRESS_AGAINST, *CURRENT, label="current")
    for step in PRESS_STEPS:
        for name, error in zip(("R_x", "R_z"), errors(forces(step, *CURRENT, label="current"), exact)):
            label = f"press fit, steps of {step}: {name}"
            verdicts.below(label, error, PRESS_BOUND, f"steps of {PRESS_AGAINST}, at every place")
    lag = errors(forces(50, label="committed"), exact)[0]
    verdicts.at_least("press fit, steps of 50, normals of t_n: error of R_x", lag, PRESS_LAG, "the lines above can fail")


def errors(ours, theirs):
    """Largest relative difference of each component, at the places of both."""
    common = sorted(set(ours) & set(theirs))
    return np.abs(np.array([ours[k] for k in common]) / np.array([theirs[k] for k in common]) - 1).max(axis=0)


def ironing(verdicts, driver, mesh, name, counts):
    """V and H over the first fifth of the track, in either number of steps."""
    found = []
    for n in counts:
        options = (*mesh, "-steps_stages", f"1,10,1.2,{n}", *CURRENT, *QUIET)
        run = driver.run("shallow_ironing", *options, label=f"ironing_{name}_{n}")
        t, V, H, _ = history(run)
        found.append({round(k, 6): np.array([v, h]) for k, v, h in zip(t, V, H) if k > 1 + 1e-6})
        label = f"shallow ironing, {name}, {n} steps to t = 1.2: cut-backs"
        verdicts.below(label, run.summary["cutbacks"], 0, "each step converges")
    common = sorted(set(found[0]) & set(found[1]))
    apart = np.abs([found[0][k] - found[1][k] for k in common]).max(axis=0) / max(found[1][k][0] for k in common)
    for force, error in zip("VH", apart):
        label = f"shallow ironing, {name}, d = {2 / counts[0]:g} against {2 / counts[1]:g}: {force}, over V"
        verdicts.below(label, error, IRONING_BOUND, f"at {len(common)} places")


def frictionless(verdicts, driver):
    def ball(n):
        scene = write(dragged_ball(2 * n, 0, "current"), driver.output / f"ball_{n}.yaml")
        # Which nodes are hardly covered, and carried by their neighbours, is settled at the start of a step.
        return driver.run(scene, "-contact_weak_coverage", -1, label=f"slide_ball_{n}")

    def slider(n):
        return driver.run("press_fit", *travel(1000, 50 / n), "-contact_friction", 0, *CURRENT, *QUIET, label=f"slide_fit_{n}")

    def die(n):
        steps = ("-steps_stages", f"1,10,1.1,{12 * n}")
        return driver.run("shallow_ironing", *COARSE, *steps, "-contact_friction", 0, *CURRENT, *QUIET, label=f"slide_die_{n}")

    for name, solve in (("press fit", slider), ("shallow ironing", die), ("ball on an arc", ball)):
        ends = {n: solve(n).resultant("contact") for n in (1, 2, 4)}
        for n in (1, 2):
            apart = np.linalg.norm(ends[n] - ends[4]) / np.linalg.norm(ends[4])
            verdicts.below(f"{name} without friction, N / {4 // n} steps: end force", apart, SLIDE_BOUND, "N steps")
