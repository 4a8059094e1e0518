"""Shallow ironing (shallow_ironing.yaml) against published curves: `ironing` on a coarse mesh, `ironing_full` on its
own. Ironing in three dimensions (ironing_3d.yaml), for which no published figures are at hand: what any solution must
show.

Gives V, the reaction at the die's head that presses it down, and H, the one that draws it along.
"""

import numpy as np

from reference import IRONING
from scene import SCENES

# What every solution must show on the plateau at t = 1.5: published V are 337 to 421, H / V is friction and some
# ploughing.
V_RANGE, RATIO_RANGE = (330, 430), (0.30, 0.38)
# On the plateau V and H should not change. They do as facets of the base pass under the die: with the period of one
# facet, and an amplitude that falls with its length. From step to step less than this, on facets of 0.1.
OSCILLATION_BOUND = 0.01
FACET = 0.1
# The period that a spectrum over 30 to 70 facets can tell.
PERIOD_BOUND = 0.05
# Degree of the smooth trend about which it is: H is smooth to 0.05 %, less than what a polynomial of degree 4 leaves of its trend.
TREND = 8
# Iterations a step, over the whole run.
NEWTON_BOUND = 8
# Within the published curves, widened by how well they can be read off: code_aster's curve and its regression value at
# t = 1 differ by 0.6 %.
BAND_MARGIN = 0.01
# Energy: of the pull, what friction does not dissipate. The normals of the last step lag behind by one step's motion d,
# which adds about d / R of V on the arc of radius R = 0.75: on the coarse mesh 0.066, 0.036 and 0.021 for d = 0.04, 0.02
# and 0.01 (-steps_stages 1,10,1.5,125 and so on).
LAG_BOUND = 0.04

PLATEAU = (1.2, 1.9)
# ironing_3d.yaml: every step converges at once, in this many iterations on the average (with the multiplier along the
# normal of the plane of symmetry left in, 15 and more, and cut-backs). Supports against each other: rounding.
NEWTON_3D_BOUND = 5
BALANCE_BOUND = 1e-10
COARSE_3D = ("-slab_cells", "18,4,5", "-die_file", SCENES.parent / "meshes" / "ironing_tube_coarse.msh",
             "-steps_stages", "1,14,2,40", "-output_vtu", "none")
# Of V, while the die slides: V and H change by less from step to step, on facets of 1/3; coarse: of 1/2.
SMOOTH_3D, SMOOTH_3D_COARSE = 0.01, 0.02
SLIDING_3D = (1.3, 1.9)
COARSE = ("-base_cells", "60,1,15", "-die_file", SCENES.parent / "meshes" / "ironing_die_coarse.msh")
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
    run = driver.run("shallow_ironing", *COARSE, "-steps_stages", "1,10,1.5,250", label="coarse")
    compare(verdicts, "coarse", run, facet=2 * FACET)
    run = driver.run("ironing_3d", *COARSE_3D, label="coarse_3d")
    three_dimensions(verdicts, "three dimensions, coarse", run, SMOOTH_3D_COARSE)
    slippery = driver.run("ironing_3d", *COARSE_3D, "-contact_friction", 0, label="coarse_3d_mu0")
    pulls = [np.interp(1.5, t, H) / np.interp(1.5, t, V) for t, V, H, _ in (history(run), history(slippery))]
    verdicts.within("three dimensions, coarse: H / V that friction adds", pulls[0] - pulls[1], *RATIO_RANGE,
                    "the rest is ploughing")


def ironing_full(verdicts, driver):
    run = driver.run("shallow_ironing", label="full")
    compare(verdicts, "full", run, facet=FACET)
    verdicts.below("full: CPU seconds", run.cpu_seconds, CPU_BOUND, "one core")


def period(x, values):
    """Wave length of the largest oscillation about a smooth trend."""
    rest = values - np.polyval(np.polyfit(x, values, TREND), x)
    amplitude = np.abs(np.fft.rfft(rest * np.hanning(len(rest))))
    return 1 / np.fft.rfftfreq(len(rest), x[1] - x[0])[1:][amplitude[1:].argmax()]


def compare(verdicts, label, run, facet):
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
        on_plateau = (t > PLATEAU[0]) & (t < PLATEAU[1])
        plateau = values[on_plateau]
        step, bound = np.abs(np.diff(plateau)).max() / plateau.mean(), OSCILLATION_BOUND * facet / FACET
        verdicts.below(f"{label}: largest change of {name} in a step, on the plateau", step, bound, "smooth")
        length = period(10 * t[on_plateau], plateau)
        verdicts.near(f"{label}: period of its oscillation", length, facet, PERIOD_BOUND, "a facet of the base")
    verdicts.below(f"{label}: Newton iterations a step", run.newton_iterations / len(run.steps), NEWTON_BOUND, "mean")
    first, last = np.searchsorted(t, (1.3, min(1.7, t[-1])))
    length = 10 * (t[last] - t[first])
    pull = np.trapz(H[first : last + 1], 10 * t[first : last + 1]) / length
    lost = (pull - (work[last] - work[first]) / length) / V[first : last + 1].mean()
    label = f"{label}: pull that friction does not dissipate, over V"
    verdicts.near(label, lost, 0, LAG_BOUND, "lag of normals", scale=1)


def three_dimensions(verdicts, label, run, smooth):
    """V and H of ironing_3d.yaml."""
    t, V, H, work = history(run)
    ground = np.array([step["reactions"]["ground"] for step in run.steps])
    off = max(np.abs(ground[:, 2] - V).max(), np.abs(ground[:, 0] + H).max()) / V.max()
    sliding = (t[1:] > SLIDING_3D[0]) & (t[1:] < SLIDING_3D[1])
    jump = max((np.abs(np.diff(force)) / V[1:])[sliding].max() for force in (V, H))
    ratio = np.interp(1.5, t, H) / np.interp(1.5, t, V)
    verdicts.below(f"{label}: cut-backs", run.summary["cutbacks"], 0, "every step converges at the first attempt")
    mean = run.newton_iterations / len(run.steps)
    verdicts.below(f"{label}: Newton iterations a step", mean, NEWTON_3D_BOUND, "mean")
    verdicts.below(f"{label}: die against ground", off, BALANCE_BOUND, "of V")
    verdicts.below(f"{label}: change of V and H from step to step", jump, smooth, "of V, while all of it slides")
    least = np.diff(work, prepend=0).min()
    verdicts.at_least(f"{label}: least friction work of a step", least, 0, "friction dissipates")
    verdicts.within(f"{label}: H / V at t = 1.5", ratio, *RATIO_RANGE, "friction 0.3 and some ploughing")
