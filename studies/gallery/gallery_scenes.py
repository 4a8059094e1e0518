"""The entries of the gallery: how each is solved and compared, and what is drawn of it."""

from dataclasses import dataclass, field
from typing import Callable

import numpy as np

import comparisons
import formulas
import friction_checks as friction
import gallery_figures as figures
import ironing
import offsets
import plane
import slider
import turning
from gallery_figures import View
from reference import IRONING


@dataclass
class Entry:
    name: str
    title: str
    text: str
    minutes: float  # on one core of a desktop
    solve: Callable  # (verdicts, driver) -> what draw needs
    draw: Callable  # (that, folder) -> paths of the figures
    committed: tuple = field(default=())  # names of figures that the repository holds


def moving(name, run, view, folder, caption, frames=24, pictures=4, shown=None):
    """The three that every scene gets: forces on the deformed surface after the step `shown` (default: the last), a
    strip, an animation. Only steps that have a .vtu (sections) or a .csv (maps)."""
    pattern = "step_*.vtu" if view.kind != "map" else f"interface_{view.interface}_*.csv"
    there = sorted(int(path.stem.rpartition("_")[2]) for path in run.directory.glob(pattern))
    shown = shown or there[-1]
    chosen = lambda count: sorted({there[round(k)] for k in np.linspace(0, len(there) - 1, min(count, len(there)))})
    return [
        figures.surface(run, view, folder / f"{name}_forces.png", shown, caption(run.steps[shown - 1]["t"])),
        figures.strip(run, view, folder / f"{name}_strip.png", chosen(pictures), caption),
        figures.animation(run, view, folder / f"{name}.gif", chosen(frames), caption),
    ]


def at(word):
    return lambda t: f"{word} {t:g}"


# --- Hertz ------------------------------------------------------------------------------------------------------------
HERTZ_SIZES = (0.136, 0.068, 0.034, 0.017)  # 5 to 40 facets over the half-width


def hertz_line(verdicts, driver):
    lines, errors = friction.hertz_line(verdicts, driver, HERTZ_SIZES[1:3])
    coarsest, finest = (friction.hertz_profile(driver, h) for h in (HERTZ_SIZES[0], HERTZ_SIZES[-1]))
    return [coarsest[:2], *lines, finest[:2]], [coarsest[2], *errors, finest[2]]


def draw_hertz_line(solved, folder):
    lines, errors = solved
    line, hertz = lines[2]
    fine = np.linspace(-1, 1, 801) * hertz.half_width
    series = [("20 facets over the half-width", line.x, line.traction[:, 2], fine, hertz.pressure(fine))]
    return [
        figures.profile(series, folder / "hertz_line.png", "x", "pressure", "Hertz, line contact"),
        figures.convergence(
            HERTZ_SIZES, {"pressure": errors}, folder / "hertz_line_error.png", "facet", "error of the profile"
        ),
    ]


def hertz_ball(verdicts, driver):
    return [friction.hertz_ball(verdicts, driver, facets) for facets in (5, 10)]


def draw_hertz_ball(solved, folder):
    series = []
    for facets, (run, hertz) in zip((5, 10), solved):
        table = run.interface("contact")
        r, pressure = np.hypot(table["X"], table["Y"]), table["fz"] / table["area_full"]
        near = r < 1.3 * hertz.contact_radius
        fine = np.linspace(0, hertz.contact_radius, 400)
        series.append((f"{facets} facets over the radius", r[near], pressure[near], fine, hertz.pressure(fine)))
    return [figures.profile(series, folder / "hertz_ball.png", "r", "pressure", "Hertz, ball on a plane: every node")]


def ring_ball(verdicts, driver):
    return plane.plane_ball(verdicts, driver), driver.run("ring_ball", "-output_vtu", "all", label="ring_ball_seen")


def draw_ring_ball(solved, folder):
    runs, seen = solved
    series = []
    for name, run in zip(("rings", "a quarter in space"), runs):
        table, solid = run.interface("contact"), name != "rings"
        hertz = formulas.PointContact(run.resultant("contact")[2] * 4 if solid else run.resultant("contact")[1],
                                      formulas.plane_modulus(1000, 0.3) / 2, 1.0)
        r = np.hypot(table["X"], table["Y"] if solid else 0)
        near = r < 1.3 * hertz.contact_radius
        fine = np.linspace(0, hertz.contact_radius, 400)
        series.append((name, r[near], table["p_lumped"][near], fine, hertz.pressure(fine)))
    view = View("contact", (0, 0.45, -1.3, -0.85), 0.08, (5.5, 5.5), "plane", magnify=1.0)
    return [
        figures.surface(seen, view, folder / "ring_ball_forces.png", title="a ball of rings on a block"),
        figures.profile(series, folder / "ring_ball.png", "r", "pressure", "Hertz, ball on a block of its material"),
    ]


# --- Cattaneo, Mindlin ------------------------------------------------------------------------------------------------
CATTANEO_SIZES = (0.068, 0.034, 0.017)


def cattaneo(verdicts, driver):
    run, lines, error = friction.cattaneo_line(verdicts, driver)
    coarse, fine = (friction.shear_error(*friction.cattaneo_run(driver, h)[1][-1]) for h in CATTANEO_SIZES[::2])
    errors = [coarse, error, fine]
    seen = driver.run("cattaneo_line", "-output_vtu", "all", label="cattaneo_seen")
    return run, lines, errors, seen


def cattaneo_profile(lines, path):
    series = []
    for line, exact in lines:
        fine = np.linspace(-1, 1, 2001) * exact.half_width
        label = f"drawn by {exact.pull / (exact.mu * exact.force):.2f} of what slides"
        near = np.abs(line.x) < 1.1 * exact.half_width
        series.append((label, line.x[near], -line.traction[near, 0], fine, exact.shear(fine)))
    return figures.profile(series, path, "x", "shear traction", "Cattaneo and Mindlin, line contact")


def draw_cattaneo(solved, folder):
    run, lines, errors, seen = solved
    pulls = [-step["interfaces"]["contact"]["force"][0] / 0.1 for step in run.steps]
    press = [step["interfaces"]["contact"]["force"][2] / 0.1 for step in run.steps]
    times = [step["t"] for step in run.steps]
    view = View("contact", (-1.3, 1.3, -0.55, 0.75), 0.4)
    return [
        cattaneo_profile(lines, folder / "cattaneo.png"),
        figures.history(
            [("force", times, press), ("pull", times, pulls)], folder / "cattaneo_history.png", "time",
            "per unit thickness",
        ),
        figures.convergence(
            CATTANEO_SIZES, {"shear traction": errors}, folder / "cattaneo_error.png", "facet", "error of the profile"
        ),
        *moving("cattaneo", seen, view, folder, at("t =")),
    ]


def mindlin(verdicts, driver):
    return friction.mindlin(verdicts, driver, facets=6, steps=(6, 5, 10))


def draw_mindlin(solved, folder):
    run, curve = solved
    pull, travel, exact = np.array(curve).T
    curves = [("computed", np.append(0, 1e3 * travel), np.append(0, pull))]
    references = [("Mindlin, Deresiewicz", np.append(0, 1e3 * exact), np.append(0, pull), "s--")]
    view = View("contact", (-0.07, 0.07, -0.005, 0.075), 0.02, (6.4, 4.2), kind="map")
    return [
        figures.history(
            curves, folder / "mindlin.png", "travel / 1000", "pull / (mu F)", references, "A ball drawn there and back"
        ),
        *moving("mindlin", run, view, folder, at("friction on half of the contact, t =")),
    ]


# --- torsion ----------------------------------------------------------------------------------------------------------
def torsion(verdicts, driver):
    return friction.torsion(verdicts, driver, friction.TORSION_FINE)


def draw_torsion(run, folder):
    turned = [k for k, step in enumerate(run.steps, 1) if step["t"] >= 1]
    angle = np.array([friction.TORSION_ANGLE * (run.steps[k - 1]["t"] - 1) for k in turned])
    torque = np.array([abs(friction.moment(run, k)) for k in turned])
    contact = friction.point_contact(run, friction.TORSION_MODULUS, mu=friction.TORSION_MU)
    stiff = contact.turning_stiffness(friction.TORSION_SHEAR)
    knee = contact.torque / stiff
    references = [
        ("16/3 G a^3", [0, knee], [0, contact.torque], "--"),
        ("3 pi / 16 mu F a", [0, angle[-1]], [contact.torque] * 2, ":"),
    ]
    view = View("contact", (-0.07, 0.07, -0.07, 0.07), 0.02, (5, 5.2), kind="map")
    return [
        figures.history(
            [("computed", angle, torque)], folder / "torsion.png", "angle", "torque", references, "Torsion"
        ),
        *moving("torsion", run, view, folder, at("friction on the block, t =")),
    ]


def disc(verdicts, driver):
    return friction.torsion_disc(verdicts, driver)


def draw_disc(run, folder):
    view = View("contact", (-1.15, 1.15, -1.15, 1.15), 0.2, (5, 5.2), kind="map")
    return moving("torsion_disc", run, view, folder, at("friction on the disc, t ="))


# --- fit, belt, slope -------------------------------------------------------------------------------------------------
SHRINK_CELLS = (20, 60, 180)  # around; no node of one body meets one of the other


def shrink(verdicts, driver):
    runs = [friction.shrink_fit_run(driver, cells) for cells in SHRINK_CELLS]
    exact = formulas.shrink_fit_free(0.01, 10, 1, 20, 2e5)
    errors = [np.abs(run.interface("contact")["p_lumped"] / exact - 1).max() for run in runs]
    run = friction.shrink_fit(verdicts, driver, SHRINK_CELLS[-1])
    return run, errors, friction.shrink_fit_out(verdicts, driver)


def draw_shrink(solved, folder):
    run, errors, (out, turned) = solved
    times = [step["t"] for step in out.steps]
    table = run.interface("contact")
    angle = np.degrees(np.arctan2(table["Y"], table["X"]))
    exact = formulas.shrink_fit_free(0.01, 10, 1, 20, 2e5)
    grip = 0.1 * formulas.shrink_fit_held(0.01, 10, 5, 20, 2e5) * 2 * np.pi * 10 * 20
    view = View("contact", (-11.5, 11.5, -11.5, 11.5), 1.5, (5, 5.2), kind="map")
    return [
        figures.profile(
            [("180 cells around", angle, table["p_lumped"], [-180, 180], [exact] * 2)], folder / "shrink_fit.png",
            "degrees", "pressure", "Shrink fit: every node, and Lame",
        ),
        figures.convergence(
            [1 / cells for cells in SHRINK_CELLS], {"worst node": errors}, folder / "shrink_fit_error.png",
            "1 / cells around", "error of the pressure",
        ),
        figures.history(
            [("computed", times, [abs(step["reactions"]["axle"][2]) for step in out.steps])],
            folder / "shrink_fit_out.png", "time", "force on the axle",
            [("mu p 2 pi b L", [times[0], times[-1]], [grip] * 2, "--")], "Pushed out of a shrink fit",
        ),
        *moving("shrink_fit_turned", turned, view, folder, at("t =")),
    ]


def rings(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    return offsets.rings(verdicts, driver)


def draw_rings(runs, folder):
    series = []
    for label, name in (("offsets of the circles", "standard"), ("chords as they are", "chords")):
        table = runs[name].interface("first")
        angle = np.degrees(np.arctan2(table["Y"], table["X"]))
        series.append((label, angle, table["p_lumped"], [-180, 180], [offsets.lame()[0]] * 2))
    title = "Inner circle of three rings: every node, and Lame"
    return [figures.profile(series, folder / "rings.png", "degrees", "pressure", title)]


def draw_capstan(run, folder):
    table = run.interface("contact")
    table = table[table["Z"] < 1e-9]
    angle = np.pi - np.arctan2(table["Y"], table["X"])
    fine = np.linspace(0, np.pi, 200)
    exact = formulas.belt_tension(fine, 0.3)
    series = [("pressure times radius", np.degrees(angle), table["p_lumped"], np.degrees(fine), exact)]
    view = View("contact", (-1.6, 1.6, -0.1, 1.6), 0.25, (7, 4), kind="map")
    return [
        figures.profile(series, folder / "capstan.png", "degrees from the held end", "tension / T1", "Belt on a drum"),
        figures.surface(run, view, folder / "capstan_forces.png"),
    ]


# --- the paper's block ------------------------------------------------------------------------------------------------
def block(verdicts, driver):
    run = driver.run("block_bottom_mu02", "-output_vtu", "all", label="block")
    comparisons.block_resultants(verdicts, "block, bottom, mu = 0.2", run)
    comparisons.block_slip(verdicts, "block, bottom, mu = 0.2", run)
    return run


def draw_block(run, folder):
    times = [step["t"] for step in run.steps]
    force = lambda k, sign: [sign * step["interfaces"]["base"]["force"][k] for step in run.steps]
    view = View("base", (-0.5, 4.6, -1.0, 2.2), 0.7)
    return [
        figures.history(
            [("normal", times, force(2, 1)), ("tangential", times, force(0, -1))], folder / "block_history.png", "time",
            "force",
        ),
        *moving("block", run, view, folder, at("t =")),
    ]


# --- the paper's slider -----------------------------------------------------------------------------------------------
def press_fit(verdicts, driver):
    options = (*slider.travel(1300, 25), "-output_vtu", "all")
    coarse = driver.run("press_fit", *options, label="press_fit_coarse")
    runs = [coarse, driver.run("press_fit", *options, *slider.FINE, label="press_fit_fine")]
    for name, run in zip(("press fit", "press fit, finer mesh"), runs):
        slider.no_cutback(verdicts, name, run)
        slider.balance(verdicts, name, run)
        slider.work(verdicts, name, run)
        slider.alternation(verdicts, name, run)
    return runs


def slider_curves(run, name):
    moved = [1000 * (step["t"] - 1) for step in run.steps if step["t"] >= 1]
    forces = np.array([slider.reaction(step) for step in run.steps if step["t"] >= 1]) / 1000
    return [(f"R_x{name}", moved, forces[:, 0]), (f"R_z{name}", moved, forces[:, 1])]


def at_the_corners(run):
    """The step at 800 mm, with the slider over both."""
    return step_at(run, 800)


def step_at(run, distance):
    """The first one that ends there or beyond."""
    return next(k for k, step in enumerate(run.steps, 1) if step["t"] > 1 + 0.001 * distance - 0.001)


def moved_by(t):
    return f"moved by {max(0, 1000 * (t - 1)):.0f} mm"


def draw_press_fit(runs, folder):
    coarse, fine = runs
    view = View("contact", (-40, 1940, -10, 470), 110, (9, 3), normal_only=True)
    (pull, press), (fine_pull, _) = slider_curves(coarse, ", 18 x 3"), slider_curves(fine, ", 36 x 6")
    marks = [("mu R_z, 18 x 3", press[1], slider.MU * press[2], "--")]
    return [
        figures.history(
            [pull, fine_pull], folder / "press_fit_history.png", "travel [mm]", "reaction [kN]", marks, "Press fit"
        ),
        *moving("press_fit", fine, view, folder, moved_by, frames=36, shown=at_the_corners(fine)),
    ]


def draw_slider(run, folder):
    """The coarse one by itself, for the demonstration."""
    view = View("contact", (-40, 1490, -10, 470), 110, (8, 3), normal_only=True)
    return moving("press_fit", run, view, folder, moved_by, shown=at_the_corners(run))


def press_fit_3d(verdicts, driver):
    run = driver.run("press_fit_3d", "-output_vtu", "all")
    slider.no_cutback(verdicts, "press fit, 3D", run)
    slider.work(verdicts, "press fit, 3D", run)
    return run


def draw_press_fit_3d(run, folder):
    section = View("contact", (-40, 1940, -10, 470), 110, (9, 3), normal_only=True)
    curves = slider_curves(run, "")
    return [
        figures.history(curves, folder / "press_fit_3d_history.png", "travel [mm]", "reaction of a quarter [kN]"),
        *moving("press_fit_3d", run, section, folder, moved_by),
    ]


def drop_off(verdicts, driver):
    """Two meshes off the sharp edge and off the rounded one; the last is shown."""
    runs = []
    for across, high in ((18, 3), (36, 6)):
        runs.append(slider.drop_off(verdicts, driver, (across, high), 25, slider.of_facets(across, 25)))
        seen = ("-output_vtu", "all")
        runs.append(slider.drop_off(verdicts, driver, (across, high), 25, slider.DROP_BOUND, slider.ROUNDED, seen))
    return runs


def draw_drop_off(runs, folder):
    names = ("sharp, 18 x 3", "rounded, 18 x 3", "sharp, 36 x 6", "rounded, 36 x 6")
    curves = []
    for run, name in zip(runs, names):
        _, (_, moved, force) = slider_curves(run, "")
        curves.append((name, *np.array([(x, f) for x, f in zip(moved, force) if x >= 1000]).T))
    view = View("contact", (1000, 2580, -10, 520), 110, (9, 3.2), normal_only=True)
    return [
        figures.history(
            [curves[2], curves[3]], folder / "drop_off.png", "travel [mm]", "R_z [kN]",
            [(*curves[0], ":"), (*curves[1], "--")], "Off the end of the channel",
        ),
        *moving("drop_off", runs[-1], view, folder, moved_by, frames=36, shown=step_at(runs[-1], 1500)),
    ]


# --- a shaft that is carried round ------------------------------------------------------------------------------------
def turned_shaft(verdicts, driver):
    runs = [driver.run("turned_shaft", *turning.steps(50), *slip, label=f"turned_{n}") for n, slip in SLIPS.items()]
    turned, rest = (turning.drift(runs[0], 50, step) for step in (100, 110))
    verdicts.below("turned by 2 rad: drift, over a facet", turned, turning.DRIFT_BOUND, "stuck")
    verdicts.below("turned by 2 rad: drift, at rest", rest, turning.REST_BOUND, "what adds up")
    return runs


SLIPS = {"objective": (), "paper": ("-contact_slip", "paper")}


def draw_turned_shaft(runs, folder):
    curves = []
    for name, run in zip(("objective", "as printed in the paper"), runs):
        settled, numbers = turning.positions(run, 1), range(2, len(run.steps) + 1)
        times = [run.steps[k - 1]["t"] for k in numbers]
        drifts = []
        for k, t in zip(numbers, times):
            angle = turning.ANGLE * min(max(t - 1, 0), 1)
            c, s = np.cos(angle), np.sin(angle)
            away = turning.positions(run, k) - settled @ np.array([[c, s], [-s, c]])
            drifts.append(np.log10(np.linalg.norm(away, axis=1).max() / turning.FACET + 1e-16))
        curves.append((name, times, drifts))
    view = View("contact", (-7, 7, -7, 7), 1.5, (5, 5.2), kind="map")
    return [
        figures.history(curves, folder / "turned_shaft.png", "time", "log10 of the drift over a facet", (), "Stuck"),
        *moving("turned_shaft", runs[0], view, folder, at("t =")),
    ]


# --- ironing ----------------------------------------------------------------------------------------------------------
def shallow_ironing(verdicts, driver):
    run = driver.run("shallow_ironing")
    ironing.compare(verdicts, "full", run, facet=ironing.FACET)
    coarse = (*ironing.COARSE, "-steps_stages", "1,10,2,200", "-output_vtu", "all", "-output_csv", "all")
    return run, driver.run("shallow_ironing", *coarse, label="shallow_ironing_seen")


def draw_shallow_ironing(solved, folder):
    run, seen = solved
    t, press, pull, _ = ironing.history(run)
    published = []
    for (name, curve), style in zip(IRONING["curves"].items(), ("s:", "o:", "^:", "v:", "D:")):
        published.append((f"{name}", IRONING["t"], curve["V"], style))
        published.append(("_", IRONING["t"], curve["H"], style))
    view = View("contact", (-0.3, 12.3, 2.0, 6.2), 0.9, (8, 3.2))
    return [
        figures.history(
            [("V, presses", t, press), ("H, draws", t, pull)], folder / "shallow_ironing_history.png", "time",
            "reaction of the die [N]", published, "Shallow ironing and published curves",
        ),
        *moving("shallow_ironing", seen, view, folder, at("t ="), frames=40, shown=len(seen.steps) // 2),
    ]


def ironing_3d(verdicts, driver):
    run = driver.run("ironing_3d", "-output_vtu", "all", "-output_csv", "all")
    ironing.three_dimensions(verdicts, "ironing, 3D", run, ironing.SMOOTH_3D)
    return run


def draw_ironing_3d(run, folder):
    t, press, pull, _ = ironing.history(run)
    curves = [("V, presses", t, press), ("H, draws", t, pull)]
    view = View("contact", (-0.5, 9.7, -0.2, 6.2), 0.9, (8, 5))
    return [
        figures.history(curves, folder / "ironing_3d_history.png", "time", "reaction of a half of the die"),
        *moving("ironing_3d", run, view, folder, at("t ="), frames=40, shown=len(run.steps) // 2),
    ]


ENTRIES = [
    Entry("hertz_line", "Hertz: line contact", "Two half-cylinders pressed together, meshes that do not match.", 0.3,
          hertz_line, draw_hertz_line),
    Entry("hertz_ball", "Hertz: ball on a plane", "A quarter of an elastic ball on a plane without a mesh.", 0.5,
          hertz_ball, draw_hertz_ball),
    Entry("ring_ball", "Hertz: ball on a block, axisymmetric", "As a plane model of rings, and as a quarter in space.", 1.0,
          ring_ball, draw_ring_ball),
    Entry("cattaneo", "Cattaneo and Mindlin: line contact drawn", "The half-cylinders, one drawn along the other: slip "
          "at the rims. The profile's error is mostly in the one facet in which stick ends, and so depends on where in "
          "that facet it ends.", 1.0, cattaneo, draw_cattaneo, ("cattaneo.png",)),
    Entry("mindlin", "Mindlin and Deresiewicz: ball drawn there and back", "Hysteresis below full sliding.", 8.0,
          mindlin, draw_mindlin),
    Entry("torsion", "Lubkin: torsion of a point contact", "A block turned under a rigid ball until all of the contact "
          "slips, on a mesh with an edge of its facets at the contact's radius. How much that matters, the stiffness on "
          "one moved by half a facet shows.", 5.0, torsion, draw_torsion),
    Entry("torsion_disc", "Torsion of a flat disc", "Uniform pressure; the torque is 2/3 mu F R.", 0.1, disc,
          draw_disc),
    Entry("shrink_fit", "Shrink fit", "A hub that is too narrow for its shaft, from meshes that penetrate at the "
          "start; then pushed out, or turned.", 1.0, shrink, draw_shrink),
    Entry("rings", "Three rings of few facets", "Shrunk onto each other, of 24, 30 and 38 facets, turning under pressure. "
          "The chords are farther from the circles than the interferences are; offsets give the circles back. Nodes "
          "scatter around the mean, which is Lame's.", 0.1, rings, draw_rings),
    Entry("capstan", "Belt on a drum", "Euler's formula, half around.", 0.1, friction.capstan, draw_capstan),
    Entry("block", "Block pushed along a foundation", "The paper's first example, contact along the whole bottom.", 0.1,
          block, draw_block),
    Entry("press_fit", "Press fit: a slider in a narrowing channel", "The paper's second example: pressure on a soft "
          "slider that is pushed up a ramp, 25 mm a step. On the plateau R_x is mu R_z.", 1.0, press_fit,
          draw_press_fit, ("press_fit_forces.png",)),
    Entry("press_fit_3d", "Press fit in three dimensions", "A slider of finite width; the section in its plane of "
          "symmetry.", 2.0, press_fit_3d, draw_press_fit_3d),
    Entry("drop_off", "Drop-off: the slider leaves the channel", "Off a sharp edge, at which the mortar surface ends, "
          "R_z rises now and then on its way down, as facets bent over the edge leave it; off one rounded by a facet of "
          "the slider or two it falls in every step.", 2.0, drop_off, draw_drop_off),
    Entry("turned_shaft", "A shaft carried round by friction", "Stuck in a hub that turns by 2 rad: no slip with the "
          "objective measure.", 0.5, turned_shaft, draw_turned_shaft),
    Entry("ironing_3d", "Ironing in three dimensions", "Half a tube, thin and stiff, lies across a soft slab, is "
          "pressed into it by almost half of the slab's height and drawn along it; the section in the plane of "
          "symmetry.", 1.0, ironing_3d, draw_ironing_3d),
    Entry("shallow_ironing", "Shallow ironing", "A die pressed into a softer base and drawn along it in 500 steps. The "
          "pictures are of a mesh and steps twice as coarse.", 20.0, shallow_ironing, draw_shallow_ironing),
]
