"""Large sliding of quadratic cells with friction and dual multipliers at the corners: the press fit and ironing in three
dimensions, against the same with linear cells; the press fit without multipliers.

In one layer of cells in plane strain the channel reaches beyond the slider's sides: where both end in one plane and the
surfaces are not parallel, the covered part has a kink in each motion across it (docs/host_quadratic.md)."""

import numpy as np

from condensed import QUIET, SAME, difference
from elevated import elevated
from ironing import COARSE_3D, RATIO_RANGE, history
from scene import SCENES
from slider import PLATEAU_BOUND, balance, travel

MESHES = SCENES.parent / "meshes"
DUAL = ("-contact_basis", "dual")
LINEAR_SLIDER = "18,1,3"
# Cells of the slider: with as many nodes along the contact as the linear ones, and with as many facets. More cut-backs than
# linear cells have: none, but for the last, where the leading edge comes to the ramp.
SLIDERS = (("hex20", "9,1,2", 0), ("tet10", "9,1,2", 0), ("hex27", "9,1,2", 0), ("hex20", "18,1,3", 0), ("tet10", "18,1,3", 1))
# R_x while the slider climbs, the mean of some steps, against twice as many linear cells, which miss those four times as
# many by 3 %: the ramp's corners lie within facets.
RAMP, RAMP_BOUND = slice(20, 30), 0.03
FINE = ("-slider_cells", "36,1,6", "-channel_file", "../meshes/press_fit_fine.msh")
# Ironing: of V and of H on the plateau, against linear cells on the slab, which are a half as long. The linear ones change by
# 4 % from one mesh to the next.
IRONING_BOUND = 0.1
# The die's wall is one layer of cells. Linear ones bend ten times too stiffly; quadratic ones of the same modulus are a thin
# elastic tube, which flattens: another problem.
STIFF_DIE = ("-die_young", "20000")


def quadratic_sliding(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    press_fit(verdicts, driver)
    without_multipliers(verdicts, driver)
    ironing_3d(verdicts, driver)


def channel(driver):
    """Quadratic, and 1.4 times as wide as the slider."""
    widened = lambda points: points * [1, 1.4, 1] - [0, 5, 0]
    return elevated(MESHES / "press_fit_coarse.msh", driver.output / "channel_20.msh", move=widened)


def press_fit(verdicts, driver):
    way = travel(1300, 50)
    linear = driver.run("press_fit", *DUAL, *way, "-slider_cells", LINEAR_SLIDER, *QUIET, label="linear")
    fine = driver.run("press_fit", *DUAL, *way, *FINE, *QUIET, label="fine")
    no_more(verdicts, "press fit, linear", linear, linear)
    for kind, cells, more in SLIDERS:
        slider = ("-slider_cell", kind, "-slider_cells", cells, "-channel_file", str(channel(driver)))
        run = driver.run("press_fit", *DUAL, *way, *slider, *QUIET, label=f"{kind}_{cells.replace(',', 'x')}")
        name = f"press fit, {kind}, {cells} cells"
        no_more(verdicts, name, run, linear, more)
        balance(verdicts, name, run)
        pull, push = pulls(run), pulls(fine)
        verdicts.near(f"{name}: R_x on the ramp", pull[RAMP].mean(), push[RAMP].mean(), RAMP_BOUND, "many linear cells")
        ratio = np.abs(pull / [step["reactions"]["symmetry"][2] for step in run.steps])
        on_the_flat = ratio[10:12].mean()  # before the leading edge comes to the ramp
        verdicts.near(f"{name}: R_x / R_z before the ramp", on_the_flat, 0.1, PLATEAU_BOUND, "Coulomb")


def pulls(run):
    return np.array([step["reactions"]["push"][0] for step in run.steps])


def no_more(verdicts, name, run, linear, more=0):
    cuts, bound = run.summary["cutbacks"], linear.summary["cutbacks"] + more
    reason = f"as with linear cells; {run.newton_iterations} and {linear.newton_iterations} iterations"
    verdicts.below(f"{name}: cut-backs", cuts, bound, reason)


def without_multipliers(verdicts, driver):
    """A slider that is pushed by its top, so that no node of the contact is prescribed."""
    for kind in ("hex20", "tet10"):
        slider = ("-slider_cell", kind, "-slider_cells", "9,1,2", "-channel_file", str(channel(driver)))
        options = (*DUAL, *travel(600, 50), *slider, "-push_surface", "slider.zmax", "-contact_weak_coverage", "0", *QUIET)
        whole = driver.run("press_fit", *options, label=f"{kind}_multipliers")
        small = driver.run("press_fit", *options, "-unknowns", "displacements", label=f"{kind}_displacements")
        reason = f"{whole.newton_iterations} and {small.newton_iterations} iterations"
        verdicts.below(f"press fit, {kind}: condensed against multipliers", difference(small, whole), SAME, reason)


def ironing_3d(verdicts, driver):
    linear = driver.run("ironing_3d", *COARSE_3D, *DUAL, label="ironing_linear")
    no_more(verdicts, "ironing, linear", linear, linear)
    die = elevated(MESHES / "ironing_tube_coarse.msh", driver.output / "die_20.msh")
    cells = ("-slab_cells", "9,2,3")
    runs = {
        "tet10 on hex8": ("-slab_cell", "tet10", *cells),
        "hex20 on hex8": ("-slab_cell", "hex20", *cells),
        "hex20 on hex20": ("-slab_cell", "hex20", *cells, "-die_file", str(die), *STIFF_DIE),
    }
    for name, options in runs.items():
        run = driver.run("ironing_3d", *COARSE_3D, *DUAL, *options, label=f"ironing_{name.replace(' ', '_')}")
        name = f"ironing, {name}"
        no_more(verdicts, name, run, linear)
        (t, V, H, _), (_, v, h, _) = history(run), history(linear)
        at = lambda values: np.interp(1.5, t, values)
        verdicts.near(f"{name}: V at t = 1.5", at(V), at(v), IRONING_BOUND, "linear cells, twice as many")
        verdicts.within(f"{name}: H / V at t = 1.5", at(H) / at(V), *RATIO_RANGE, "friction 0.3 and some ploughing")
