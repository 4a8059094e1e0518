"""Shallow ironing (shallow_ironing.yaml) against published curves: `ironing` on a coarse mesh, `ironing_full` on its own.

Gives V, the reaction at the die's head that presses it down, and H, the one that draws it along.
"""

import numpy as np

from reference import IRONING
from scene import SCENES

# What every solution must show on the plateau at t = 1.5: published V are 337 to 421, H / V is friction and some ploughing.
V_RANGE, RATIO_RANGE = (330, 430), (0.30, 0.38)
# A smooth curve: from step to step V and H change by less on the plateau, where they should not change at all.
OSCILLATION_BOUND = 0.01
# Iterations a step, over the whole run.
NEWTON_BOUND = 8
# Within the published curves, widened by what two of them differ by where they are to agree (code_aster's own curve and its
# own regression value at t = 1 differ by 0.6 %) and by the width of a line in the figure.
BAND_MARGIN = 0.01
# Energy: of the pull, what friction does not dissipate. The normals of the last step lag behind by one step's motion
# d = 0.02 on an arc of radius 0.75, which gives d / R = 0.027 of V on an arc that touches all around.
LAG_BOUND = 0.04

PLATEAU = (1.2, 1.9)
CPU_BOUND = 20 * 60  # seconds on one core


def history(run):
    """t, V, H and the work of friction, one entry a step."""
    reactions = [step["reactions"] for step in run.steps]
    return (
        np.array([step["t"] for step in run.steps]),
        -np.array([r["down"][2] for r in reactions]),
        np.array([r["along"][0] for r in reactions]),
        np.array([step["friction_work"] for step in run.steps]),
    )


def ironing(verdicts, driver):
    """60 x 15 and 6 x 3 cells, half of the track."""
    meshes = ("-base_cells", "60,1,15", "-die_file", SCENES.parent / "meshes" / "ironing_die_coarse.msh")
    run = driver.run("shallow_ironing", *meshes, "-steps_stages", "1,10,1.5,250", label="coarse")
    compare(verdicts, "coarse", run)


def ironing_full(verdicts, driver):
    run = driver.run("shallow_ironing", label="full")
    compare(verdicts, "full", run)
    verdicts.below("full: CPU seconds", run.cpu_seconds, CPU_BOUND, "one core")


def compare(verdicts, label, run):
    t, V, H, work = history(run)
    at = lambda values, time: np.interp(time, t, values)
    v, ratio = at(V, 1.5), at(H, 1.5) / at(V, 1.5)
    verdicts.within(f"{label}: V at t = 1.5", v, *V_RANGE, "published: 337 to 421")
    verdicts.within(f"{label}: H / V at t = 1.5", ratio, *RATIO_RANGE, "friction 0.3 and some ploughing")
    for name, values in (("V", V), ("H", H)):
        for k, time in enumerate(IRONING["t"]):
            curves = [curve[name][k] for curve in IRONING["curves"].values()]
            low, high = min(curves) * (1 - BAND_MARGIN), max(curves) * (1 + BAND_MARGIN)
            if time <= t[-1]:
                verdicts.within(f"{label}: {name} at t = {time:g}", at(values, time), low, high, "published curves")
        plateau = values[(t > PLATEAU[0]) & (t < PLATEAU[1])]
        step = np.abs(np.diff(plateau)).max() / plateau.mean()
        verdicts.below(f"{label}: largest change of {name} in a step, on the plateau", step, OSCILLATION_BOUND, "smooth")
    verdicts.below(f"{label}: Newton iterations a step", run.newton_iterations / len(run.steps), NEWTON_BOUND, "mean")
    first, last = np.searchsorted(t, (1.3, min(1.7, t[-1])))
    length = 10 * (t[last] - t[first])
    pull = np.trapz(H[first : last + 1], 10 * t[first : last + 1]) / length
    lost = (pull - (work[last] - work[first]) / length) / V[first : last + 1].mean()
    verdicts.near(f"{label}: pull that friction does not dissipate, over V", lost, 0, LAG_BOUND, "lag of normals", scale=1)
