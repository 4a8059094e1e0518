"""What does not depend on how a motion is split into steps, for weights and normals are those of now: a press fit, shallow ironing, the
torque of a shaft in its bore. The group `split`: in few steps; `split_fine`: in many, and the ironing, a minute and a half."""

import numpy as np

from ironing import COARSE, history
from scene import write
from slider import after, reaction, travel
from turning import in_a_bore

QUIET = ("-output_vtu", "none", "-output_csv", "none")
# The press fit: every node slips, so that R_x and R_z are functions of the position alone. Over the force there: 7e-12 is measured,
# Newton's tolerance after some thousand steps. `travel` says when it ends; R_x there, in N, from steps of 1 mm.
PRESS_WHOLE, PRESS_FEW, PRESS_MANY, PRESS_BOUND = 1000, (100, 50), (4, 1), 1e-9
PRESS_END, PRESS_DIGITS = 603938.23, 1e-7
# What normals of t_n are off by at least in steps of 50 mm: 28 % is measured at the end, 60 % on the way; if not, the lines above could not fail.
PRESS_LAG = 0.1
# Shallow ironing on the coarse mesh, V and H over V at the same places, against the longest steps. Some nodes stick when the die starts:
# there the history counts, 1e-5 is measured; from 0.5 mm on all slip: 1e-11.
IRONING_LONGEST, IRONING_STEPS = 0.04, (0.02, 0.01, 0.005)
IRONING_START, IRONING_BOUND, IRONING_STARTS = 2e-5, 1e-9, 1.05
# A shaft in a bore, turned far beyond what it sticks: degrees a step, all parts of the whole; its torque against that of the limit, and of
# any steps against others at equal angles: 1e-11 is measured. With normals of t_n it is 0.4 and 0.3 % too high in steps of 1 and 10.
TURNS, TURNED, TURN_LIMIT, TURN_BOUND = (1, 5, 10, 15, 45), 90, 5e-3, 1e-9


def split(verdicts, driver):
    press_fit(verdicts, driver, PRESS_FEW)
    shaft(verdicts, driver)


def split_fine(verdicts, driver):
    press_fit(verdicts, driver, (PRESS_FEW[0], *PRESS_MANY))
    lag(verdicts, driver)
    ironing(verdicts, driver, IRONING_STEPS)


def pressed(driver, step, *options, label):
    """R_x and R_z at every place on the way."""
    run = driver.run("press_fit", *travel(PRESS_WHOLE, step), *options, *QUIET, label=f"press_fit_{label}_{step}")
    return run, {round(s["t"], 6): reaction(s) for s in run.steps if s["t"] > 1 + 1e-6}


def press_fit(verdicts, driver, steps):
    longest = pressed(driver, steps[0], label="now")[1]
    for step in steps:
        run, forces = pressed(driver, step, label="now")
        label = f"press fit, steps of {step}"
        verdicts.below(f"{label}: cut-backs", run.summary["cutbacks"], 0, "each step converges")
        end = reaction(after(PRESS_WHOLE, run))[0]
        verdicts.near(f"{label}: R_x at the end", end, PRESS_END, PRESS_DIGITS, "steps of 1")
        for name, error in zip(("R_x", "R_z"), errors(forces, longest)):
            verdicts.below(f"{label}: {name}", error, PRESS_BOUND, f"steps of {steps[0]}, at every place")


def lag(verdicts, driver):
    """The paper's normals, of the step's start, whatever they lag by."""
    options = ("-contact_normals", "committed", "-contact_lag_max", 1)
    off = errors(pressed(driver, 50, *options, label="committed")[1], pressed(driver, 50, label="now")[1])[0]
    verdicts.at_least("press fit, steps of 50, normals of t_n: error of R_x", off, PRESS_LAG, "what normals of now are for")


def errors(ours, theirs):
    """Largest relative difference of each component, at the places of both."""
    common = sorted(set(ours) & set(theirs))
    return np.abs(np.array([ours[k] for k in common]) / np.array([theirs[k] for k in common]) - 1).max(axis=0)


def ironed(verdicts, driver, d, mesh, name):
    """V and H over the first fifth of the track, 2 mm."""
    options = (*mesh, "-steps_stages", f"1,10,1.2,{round(2 / d)}", *QUIET)
    run = driver.run("shallow_ironing", *options, label=f"ironing_{name}_{d}")
    t, V, H, _ = history(run)
    verdicts.below(f"shallow ironing, {name}, d = {d:g}: cut-backs", run.summary["cutbacks"], 0, "each step converges")
    return {round(k, 6): np.array([v, h]) for k, v, h in zip(t, V, H) if k > 1 + 1e-6}


def ironing(verdicts, driver, steps, mesh=COARSE, name="coarse", longest=IRONING_LONGEST):
    theirs = ironed(verdicts, driver, longest, mesh, name)
    for d in steps:
        ours = ironed(verdicts, driver, d, mesh, name)
        common = sorted(set(ours) & set(theirs))
        apart = np.abs([ours[k] - theirs[k] for k in common]) / max(theirs[k][0] for k in common)
        slides = np.array(common) > IRONING_STARTS + 1e-9
        for force, at_start, then in zip("VH", apart[~slides].max(axis=0), apart[slides].max(axis=0)):
            label = f"shallow ironing, {name}, d = {d:g} against {longest:g}: {force}, over V"
            verdicts.below(f"{label}, as it starts", at_start, IRONING_START, "some nodes stick")
            verdicts.below(f"{label}, then", then, IRONING_BOUND, f"at {int(slides.sum())} places")


def shaft(verdicts, driver):
    found = {}
    for degrees in TURNS:
        path = write(in_a_bore(degrees, TURNED), driver.output / f"bore_{degrees}.yaml")
        run = driver.run(path, "-output_csv", "all", label=f"bore_{degrees}")
        label = f"a shaft turned in its bore, {degrees} degrees a step"
        verdicts.below(f"{label}: cut-backs", run.summary["cutbacks"], 0, "each step converges")
        turned = [k for k, step in enumerate(run.steps, 1) if step["t"] > 1 + 1e-6]
        angle = lambda k: round(TURNED * (run.steps[k - 1]["t"] - 1), 6)
        torques = {angle(k): torque(run, k) for k in turned}
        # The first degrees only bend the shaft.
        off = max(abs(torques[angle(k)] / limit(run, k) - 1) for k in turned if slips(run, k))
        verdicts.below(f"{label}: torque over its limit, off by", off, TURN_LIMIT, "mu N R, all of it slips")
        found[degrees] = torques
    for degrees in TURNS[1:]:
        common = sorted(set(found[degrees]) & set(found[1]))
        apart = max(abs(found[degrees][a] / found[1][a] - 1) for a in common)
        verdicts.below(f"a shaft turned in its bore: torque, {degrees} degrees a step", apart, TURN_BOUND, f"1 degree, at {len(common)} angles")


def torque(run, step):
    return abs(run.steps[step - 1]["moments"]["turn"][2])


def slips(run, step):
    return run.steps[step - 1]["interfaces"]["contact"]["stick"] == 0


def limit(run, step):
    """mu times what presses at each node, times its distance from the axis."""
    table = run.interface("contact", step)
    radius = np.hypot(table["X"] + table["ux"], table["Y"] + table["uy"])
    return 0.3 * (table["p_lumped"] * table["area_covered"]) @ radius
