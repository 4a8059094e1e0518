"""Tests with exact answers, coarse: a wave pressed flat, punches, a ball with friction, cylinders that roll, gears. docs/exact.md has finer
meshes; studies/exact makes it."""

import numpy as np

import carter
import gears
import nafems_punch
import punches
import self_similar
import westergaard
from westergaard import DUAL, LIGHT, POINTS, STANDARD, SUB_POINTS

# The wave: means over ten positions of the border within a facet, 5 and 10 facets over the half-width. Light load: what was seen when this
# was written, 1.59 and 0.86 %, 0.95 and 0.55 %, plus 2 % of it for other processors' rounding.
WAVE_BOUNDS = {DUAL: {5: 1.62e-2, 10: 0.875e-2}, POINTS: {5: 0.97e-2, 10: 0.56e-2}}
# Quadratic cells, by their nodes: what the project asks for.
WAVE_BOUNDS[SUB_POINTS] = {5: 0.5e-2, 10: 0.25e-2}
# The error falls a little slower than the facet, whose border decides: with the powers 0.89 and 0.80 from 5 to 10 facets.
WAVE_ORDER = {DUAL: 0.85, POINTS: 0.75, SUB_POINTS: 0.75}
# Of the pressure that closes the last gap, in steps of 0.001: what the project asks for, on 20 facets over the half wave.
CLOSING, CLOSING_FACETS = 0.005, 20
# The sliding punch: pressure in the middle, what the project asks for, on ten facets over the half-width, the outermost halved four times;
# on equal ones it is missed.
PUNCH, PUNCH_MESH = 0.01, (10, 4)
FRICTIONS = (0.2, 0.5, 1.0)
# The rounded punch: loads, what the project asks for, on ten facets over the half-width at four positions of the border.
LOADS, LOAD_POSITIONS = {0.5: 0.005, 0.9: 0.01}, (0, 3, 5, 8)
# NAFEMS: of our displacements on eight times finer quadratic cells (-0.133867, -0.131742): they fall short of the published ones by 0.7 %,
# which no mesh of ours closes.
FINEST, NAFEMS_FACET, NAFEMS = {0.0: -0.133867, 0.1: -0.131742}, 1.0, 0.004
# Spence: the stick radius is its mean part of the contact radius to a facet, as the borders are known to half a facet each.
BALL_FACETS, BALL_STEPS, BALL_FRICTION, SHARE = 20, 40, 0.2, 1.0
# Half as many steps: what the size of steps is worth, in c/a. It is not zero: a node that closes within a step has slipped since its start.
STEPS = 0.05
# Carter: 5 facets over the half-width, steps of a quarter of a facet. Finer ones have 3 % (docs/exact.md); half a facet for the end of stick.
CARTER_FACETS, CARTER_STEPS, CARTER_SHARE, CREEPAGE, END = 5, 80, 0.5, 0.08, 0.5
# Gears: linear facets, 12 a flank. Torques scatter by 0.65 % about 2/3, root mean square, their mean by 0.13 %.
GEAR_FACETS, GEAR_ANGLES, SCATTER, MEAN = 12, 10, 0.008, 0.002


def exact(verdicts, driver):
    waves(verdicts, driver)
    sliding(verdicts, driver)
    rounded(verdicts, driver)


def exact_friction(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    nafems(verdicts, driver)
    spence(verdicts, driver)


def waves(verdicts, driver):
    for element, bounds in WAVE_BOUNDS.items():
        means = []
        for facets, bound in bounds.items():
            count = westergaard.cells(element, facets, LIGHT)
            errors = [westergaard.error(westergaard.solve(driver, element, count, a), a, element) for a in westergaard.half_widths(facets, LIGHT)]
            means.append(np.mean(errors))
            what = f"wave, {element.name}, {facets} facets: pressure, worst {max(errors):.1e}, mean"
            verdicts.below(what, means[-1], bound, "Westergaard")
        verdicts.at_least(f"wave, {element.name}: order", np.log2(means[0] / means[-1]), WAVE_ORDER[element], "measured")
    for element in (STANDARD, DUAL, POINTS):
        closed = westergaard.closing(driver, element, CLOSING_FACETS)
        verdicts.near(f"wave, {element.name}: pressure that closes the last gap", np.inf if closed is None else closed, 1, CLOSING, "Westergaard")


def sliding(verdicts, driver):
    for mu in FRICTIONS:
        punch = punches.Sliding(mu)
        run = driver.run(punch.scene(driver.output, *PUNCH_MESH))
        x, found, exact, _ = punch.pressures(run)
        middle = np.argmin(np.abs(x))
        verdicts.near(f"punch that slides, mu = {mu:g}: pressure in the middle", found[middle], exact[middle], PUNCH, "Johnson 2.8")
        slips = (run.interface(punches.NAME)["state"] == "slip").all()
        verdicts.true(f"punch that slides, mu = {mu:g}: all of it slips", slips, "the formula's assumption")


def rounded(verdicts, driver):
    for flat, bound in LOADS.items():
        for position in LOAD_POSITIONS:
            facets = punches.positions(10)[position]
            run = driver.run(punches.rounded_scene(driver.output, flat, facets))
            verdicts.near(f"rounded punch, b/a = {flat:g}, {facets:g} facets: load", punches.rounded_load(run, flat), 1, bound, "Ciavarella and others")


def nafems(verdicts, driver):
    for mu, finest in FINEST.items():
        run = driver.run(nafems_punch.scene(driver.output, NAFEMS_FACET, mu))
        verdicts.near(f"NAFEMS 2, mu = {mu:g}: displacement", nafems_punch.middle(run)[0], finest, NAFEMS, "finest quadratic mesh")


def spence(verdicts, driver):
    last = []
    for steps in (BALL_STEPS, BALL_STEPS // 2):
        run = driver.run(self_similar.scene(driver.output, BALL_FACETS, BALL_FRICTION, steps))
        radii = self_similar.at_loads(run)
        part = radii[:, 1].sum() / radii[:, 0].sum()
        last.append(part)
        if steps == BALL_STEPS:
            off = np.abs(radii[:, 1] - part * radii[:, 0]).max() * BALL_FACETS
            verdicts.below(f"ball with friction: stick radius at ten loads, {part:.3f} of the contact's, to a facet", off, SHARE, "self-similar")
    verdicts.near("ball with friction: stick radius in half as many steps", last[1], last[0], STEPS, "measured, falls with the step")


def exact_rolling(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    run = driver.run(carter.scene(driver.output, CARTER_FACETS, CARTER_SHARE, CARTER_STEPS))
    _, _, share, creepage = carter.steady(run)
    verdicts.near(f"rolling, Q / (mu P) = {share.mean():.3f}: creepage", creepage.mean(), 1, CREEPAGE, "Carter")
    verdicts.below("rolling: end of stick, in facets", abs(carter.end_of_stick(run)) * CARTER_FACETS, END, "Carter")


def exact_gears(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    ratio = gears.torques(driver.run(gears.scene(driver.output, GEAR_FACETS, GEAR_ANGLES)))[:, 1] / gears.RATIO
    verdicts.near("gears: mean ratio of torques over two pitches", ratio.mean(), 1, MEAN, "as the numbers of teeth")
    verdicts.below("gears: ratio at any angle, root mean square", np.sqrt(((ratio - 1) ** 2).mean()), SCATTER, "as the numbers of teeth")
