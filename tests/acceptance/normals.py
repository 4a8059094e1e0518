"""Normals of the current configuration, the default: what is the same however a motion is split into steps.

The group `normals`; the longer lines are in normals_full.py, the press fit, ironing and a torque in split.py.
"""

import re

import numpy as np
import turning
from idle import idle_steps, positions
from ironing import COARSE
from normals_scenes import dragged_ball
from scene import SCENES, multiplier, write
from slider import travel

QUIET = ("-output_vtu", "none", "-output_csv", "none")

# A quarter turn in a bore, in few steps against THIRTY: multipliers and positions over their largest. All nodes slip at the
# end, so that nothing of the path is left but what Newton's tolerance (1e-13 of the forces) leaves: 6e-13 is measured.
BORE_FEW, BORE_MANY, BORE_BOUND = (1, 2, 4), 30, 1e-10
# The turned shaft, stuck: a rigid motion moves nothing against anything, so drift is rounding: 7e-14 of a facet is measured
# after 440 steps. With normals of t_n: 7.6e-6 while turning, 3.8e-9 at rest, in 50 steps.
DRIFT_BOUND = 1e-10
# Degrees in one step. At 15 Newton's method once threw the shaft out of the hub, where nothing touches: in equilibrium, too.
THROWN_OUT = (10, 15, 20)
# Without friction an elastic state depends on the position alone: N, 2 N and 4 N steps, the end force over its size: 1e-15
# is measured, and Newton's tolerance of 1e-11 allows no more than this.
SLIDE_BOUND = 1e-9
# A few scenes of those of `normals_full`.
IDLE = ("press_fit", "ball_in_block", "cattaneo_line", "shaft_in_bore", "patch_inclined", "two_blocks")


def normals(verdicts, driver):
    bore(verdicts, driver)
    turned_shaft(verdicts, driver)
    thrown_out(verdicts, driver)
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
        run = driver.run("turned_shaft", *turning.steps(n), label=f"turned_{n}")
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
        run = driver.run(scene, *turn, *QUIET, label=f"thrown_out_{degrees}")
        away = sum(run.steps[-1]["interfaces"]["contact"][s] for s in ("gap", "slip"))
        label = f"turned by {degrees} degrees in one step: nodes that do not stick"
        verdicts.below(label, away, 0, "it stays in its hub")


def frictionless(verdicts, driver):
    def ball(n):
        scene = write(dragged_ball(2 * n, 0), driver.output / f"ball_{n}.yaml")
        # Which nodes are hardly covered, and carried by their neighbours, is settled at the start of a step.
        return driver.run(scene, "-contact_weak_coverage", -1, label=f"slide_ball_{n}")

    def slider(n):
        return driver.run("press_fit", *travel(1000, 50 / n), "-contact_friction", 0, *QUIET, label=f"slide_fit_{n}")

    def die(n):
        steps = ("-steps_stages", f"1,10,1.1,{12 * n}")
        return driver.run("shallow_ironing", *COARSE, *steps, "-contact_friction", 0, *QUIET, label=f"slide_die_{n}")

    for name, solve in (("press fit", slider), ("shallow ironing", die), ("ball on an arc", ball)):
        ends = {n: solve(n).resultant("contact") for n in (1, 2, 4)}
        for n in (1, 2):
            apart = np.linalg.norm(ends[n] - ends[4]) / np.linalg.norm(ends[4])
            verdicts.below(f"{name} without friction, N / {4 // n} steps: end force", apart, SLIDE_BOUND, "N steps")
