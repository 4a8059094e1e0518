"""The entries of the gallery with exact answers of docs/exact.md, and of fluids."""

import numpy as np

import carter
import exact
import formulas
import gallery_figures as figures
import gears
import westergaard
from gallery_figures import View
from gallery_scenes import Entry, at, moving

SEEN = ("-output_vtu", "all", "-output_csv", "all")


def wave(verdicts, driver):
    exact.waves(verdicts, driver)
    half_width = westergaard.half_widths(10, westergaard.LIGHT)[7]  # the worst position for nodes
    count = westergaard.cells(westergaard.DUAL, 10, westergaard.LIGHT)
    elements = (westergaard.DUAL, westergaard.POINTS)
    return half_width, [(element, westergaard.solve(driver, element, count, half_width)) for element in elements]


def draw_wave(solved, folder):
    half_width, runs = solved
    fine, series = np.linspace(0, half_width, 400), []
    for element, run in runs:
        x, found, _, _ = westergaard.pressures(run, half_width, element)
        near = x < 1.3 * half_width
        series.append((element.name, x[near], found[near], fine, westergaard.WAVE.pressure(fine, half_width)))
    return [figures.profile(series, folder / "wave.png", "x", "pressure", "A wave pressed flat, 10 facets over the half-width")]


def rolling(verdicts, driver):
    exact.exact_rolling(verdicts, driver)
    return driver.run(carter.scene(driver.output, 10, 0.5, 80), *SEEN, label="rolling_seen")


def draw_rolling(run, folder):
    way, _, _, creepage = carter.rolled(run).T
    table = run.interface(carter.NAME)
    table = table[np.argsort(table["X"] + table["ux"])]
    x = table["X"] + table["ux"]
    along, across = run.steps[-1]["interfaces"][carter.NAME]["force"][:2]
    exact_line = formulas.LineContact(across, carter.MODULUS, carter.RADIUS / 2, carter.MU, along)
    a, c = exact_line.half_width, exact_line.stick
    fine, middle = np.linspace(-a, a, 801), (x[table["state"] != "gap"].min() + x[table["state"] != "gap"].max()) / 2
    shear = carter.MU * exact_line.peak * (formulas.ellipse(fine, a) - c / a * formulas.ellipse(fine + a - c, c))  # leading at the left
    near = np.abs(x - middle) < 1.2 * a
    series = [("10 facets over the half-width", (x - middle)[near], np.abs(table["t_lumped_x"][near]), fine, shear)]
    view = View(carter.NAME, (-2.5, 2.5, -1.8, 1.8), 0.7, (6.4, 5), "plane")
    return [
        figures.history([("computed", way, creepage)], folder / "rolling_history.png", "way over the half-width", "creepage over Carter's"),
        figures.profile(series, folder / "rolling.png", "x", "shear traction", "Two cylinders that roll, Q = mu P / 2"),
        *moving("rolling", run, view, folder, at("t =")),
    ]


def gear_pair(verdicts, driver):
    exact.exact_gears(verdicts, driver)
    return driver.run(gears.scene(driver.output, 24, 20), *SEEN, label="gears_seen")


def draw_gears(run, folder):
    turned, ratio = gears.torques(run).T
    view = View(gears.NAME, (7.2, 13, -3, 3), 0.8, (5.5, 5.7), "plane")
    return [
        figures.history([("computed", turned, 100 * (ratio / gears.RATIO - 1))], folder / "gears_history.png", "turned by, pitches", "error of T_A / T_B [%]"),
        *moving("gears", run, view, folder, at("t =")),
    ]


def o_ring(verdicts, driver):
    run = driver.run("o_ring", *SEEN)
    areas = [step["fluids"]["oil"]["area"] for step in run.steps]
    verdicts.true("O-ring: tight", not run.steps[-1]["fluids"]["oil"]["at_outlet"], "the fluid presses it against the wall")
    verdicts.true("O-ring: the fluid comes on as it presses more", areas[-1] > areas[3], "since the ring is squeezed")
    return run


def draw_o_ring(run, folder):
    view = View("above", (-1.55, 1.5, -1.55, 1.55), 0.5, (4.6, 4.6), "plane")
    return moving("o_ring", run, view, folder, lambda t: f"fluid at {max(0, 8 * (t - 1)):g}", pictures=3)


ENTRIES = [
    Entry("wave", "Westergaard: a wave pressed flat", "Periodic, so that nothing is finite: the test of the border of a contact. The border lies where nodes "
          "that decide are worst.", 0.5, wave, draw_wave),
    Entry("rolling", "Carter: two cylinders that roll", "One drives the other by half of what slides: stick at the leading edge, slip behind, and one lags "
          "behind.", 3.0, rolling, draw_rolling),
    Entry("o_ring", "An O-ring in its groove", "Squeezed, then pressed by a fluid, which gets between ring and groove as far as it can.", 0.2, o_ring, draw_o_ring,
          ("o_ring_strip.png",)),
    Entry("gears", "Involute gears", "Torques as the numbers of teeth at every angle.", 2.0, gear_pair, draw_gears),
]
