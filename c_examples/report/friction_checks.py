"""Scenes with exact answers: Hertz, Cattaneo and Mindlin, torsion, shrink fit, a belt on a drum, a block on a slope.

Each function solves its scenes, adds its comparisons to the Verdicts and returns what the figures need. All are computed
with the forces that the run had, not with those that were wanted.
"""

import numpy as np

import formulas
from reference import fit_hertz

# Half-cylinders with a / R = 0.085 and a ball with a / R = 0.1 are no half-spaces; ten facets over the contact radius.
PEAK_BOUND, WIDTH_BOUND = 0.02, 0.03
# The error of the profile is one of the facets at the rim, where the slope is infinite: it falls at least as the square root
# of h, until the finite bodies' 0.8 % are left.
PROFILE_FALLS = 0.75
# Alternation from node to node: second differences of the error over 4, inside 0.8 of the half-width, of the peak.
ALTERNATION_BOUND = 0.005
# 20 facets over the half-width. Most of what is left is in the one facet in which stick ends.
CATTANEO_BOUND = 0.04
# Other finite element codes on such a mesh: 8 %.
FACETS_OF_STICK = 1.0
SHRINK_BOUND = 0.005
CAPSTAN_BOUND = 0.01
# tan of the slope over mu, on either side.
INCLINE_MARGIN = 1e-6
# The multiplier of a homogeneous state, as in the patch tests: the linear solver's round-off.
INCLINE_BOUND = 1e-11

# The half-cylinders of cattaneo_line.yaml
LINE_MODULUS = formulas.together(*[formulas.plane_modulus(200, 0.3)] * 2)
LINE_RADIUS = 4.0
LINE_MU = 0.2
FRICTIONLESS = ("-contact_law", "none", "-contact_friction", 0, "-steps_times", 1)


def friction(verdicts, driver):
    hertz_line(verdicts, driver)
    cattaneo_line(verdicts, driver)
    shrink_fit(verdicts, driver)
    shrink_fit_out(verdicts, driver)
    capstan(verdicts, driver)
    incline(verdicts, driver)
    torsion_disc(verdicts, driver)


def graded(h, fine, far, growth):
    """Positions from 0: steps of h as far as `fine`, then growing ones to `far`."""
    inner = h * np.arange(round(fine / h) + 1)
    count = 1
    while h * growth * (growth**count - 1) / (growth - 1) < far - inner[-1]:
        count += 1
    steps = growth ** np.arange(1, count + 1)
    return np.append(inner, inner[-1] + np.cumsum(steps * (far - inner[-1]) / steps.sum()))


def both_ways(x):
    return np.append(-x[:0:-1], x)


def numbers(values):
    return ",".join(f"{value:.10g}" for value in values)


def line_mesh(h, ratio=40 / 34):
    """Options that mesh the half-cylinders with facets of h on the upper, h times the ratio on the lower one."""
    options = []
    for body, size, fine, sign in (("upper", h, 0.95, 1), ("lower", ratio * h, 1.1, -1)):
        depth = sign * graded(size, 3 * size, 8, 1.2)
        x = both_ways(graded(size, fine, 8, 1.35))
        options += [f"-{body}_x", numbers(x), f"-{body}_z", numbers(np.sort(depth))]
    return options


def pressing(facets, pushes=4):
    """Times of cattaneo_line and mindlin: contact grows by one facet a step (its width as the root of the travel)."""
    press = (np.arange(1, facets + 1) / facets) ** 2
    return ["-steps_times", numbers(np.append(press, 1 + np.arange(1, pushes + 1) / pushes))]


def profile_error(line, values, exact):
    """Of nodal tractions against a profile: root mean square over that of the profile."""
    reference = formulas.nodal_mean(exact, line.x)
    return np.sqrt((line.length * (values - reference) ** 2).sum() / (line.length * reference**2).sum())


def hertz_line(verdicts, driver, sizes=(0.068, 0.034)):
    """Ten and twenty facets over the half-width 0.68; frictionless, in one step."""
    errors, lines = [], []
    for h in sizes:
        line = driver.run("cattaneo_line", *line_mesh(h), *FRICTIONLESS, label=f"hertz_line_{h:g}").line("contact")
        pressure = line.traction[:, 2]
        hertz = formulas.LineContact(line.force[:, 2].sum(), LINE_MODULUS, LINE_RADIUS)
        name = f"Hertz line, {hertz.half_width / h:.0f} facets"
        verdicts.near(f"{name}: peak pressure", pressure.max(), hertz.peak, PEAK_BOUND, "finite bodies")
        verdicts.near(
            f"{name}: half-width", fit_hertz(line.x, pressure)[1], hertz.half_width, WIDTH_BOUND, "finite bodies"
        )
        inner = pressure[np.abs(line.x) < 0.8 * hertz.half_width]
        error = inner - hertz.pressure(line.x[np.abs(line.x) < 0.8 * hertz.half_width])
        worst = np.abs(np.diff(error, 2)).max() / 4 / hertz.peak
        verdicts.below(f"{name}: alternation from node to node", worst, ALTERNATION_BOUND, "mortar: none")
        errors.append(profile_error(line, pressure, hertz.pressure))
        lines.append((line, hertz))
    for coarse, fine in zip(errors, errors[1:]):
        verdicts.below(f"Hertz line: error of the profile {coarse:.4f}, h / 2 over h", fine / coarse, PROFILE_FALLS, "falls")
    return lines, errors


def cattaneo_line(verdicts, driver, h=0.034, label="cattaneo_line"):
    """Pressed, then drawn: the stick zone and the shear traction after each step of drawing."""
    facets = round(0.68 / h)
    run = driver.run("cattaneo_line", *line_mesh(h), *pressing(facets), label=label)
    name, lines = f"Cattaneo, {facets} facets", []
    for number, step in enumerate(run.steps[facets:], facets + 1):
        line = run.line("contact", number)
        shear = -line.traction[:, 0]
        exact = formulas.LineContact(
            line.force[:, 2].sum(), LINE_MODULUS, LINE_RADIUS, LINE_MU, -line.force[:, 0].sum()
        )
        stick = stick_half_width(line)
        lines.append((line, exact))
        part = f"{name}, drawn by {exact.pull / (LINE_MU * exact.force):.2f}"
        verdicts.near(
            f"{part}: half-width of stick (error in facets)", stick, exact.stick, FACETS_OF_STICK, "in facets", scale=h
        )
    error = profile_error(line, shear, exact.shear)
    verdicts.below(f"{part}: shear traction", error, CATTANEO_BOUND, "root mean square over the contact")
    return run, lines, error


def stick_half_width(line):
    """Where stick ends: half-way to the next node; the mean of both sides."""
    inside = np.flatnonzero(line.state == "stick")
    first, last = inside[0], inside[-1]
    return (line.x[last] + line.x[last + 1] - line.x[first] - line.x[first - 1]) / 4


def shrink_fit(verdicts, driver, cells=60):
    """Frictionless, bore and outside free: Lame's pressure at every node."""
    run = driver.run(
        "shrink_fit", "-shaft_cells", f"{cells // 5},{cells},1", "-hub_cells", f"{cells // 6},{cells},1"
    )
    table = run.interface("contact")
    exact = formulas.shrink_fit_free(0.01, 10, 1, 20, 2e5)
    worst = table["p_lumped"][np.argmax(np.abs(table["p_lumped"] - exact))]
    verdicts.near("shrink fit: pressure, worst node", worst, exact, SHRINK_BOUND, "Lame")
    verdicts.near("shrink fit: steps, the meshes penetrate at first", len(run.steps), 1, 0, "no cut-back")
    return run


def shrink_fit_out(verdicts, driver):
    """Friction 0.1, bore and outside held; pushed out, or turned, until all of it slips."""
    length, b, mu = 20, 10, 0.1
    pressure = formulas.shrink_fit_held(0.01, b, 5, 20, 2e5)
    out = driver.run("shrink_fit_out")
    turned = driver.run("shrink_fit_out", *TURN, label="shrink_fit_turned")
    force = abs(out.steps[-1]["reactions"]["axle"][2])
    table = turned.interface("contact")
    torque = abs((table["X"] * table["fy"] - table["Y"] * table["fx"]).sum())
    grip = mu * pressure * 2 * np.pi * b * length
    verdicts.near("shrink fit pushed out: force", force, grip, SHRINK_BOUND, "mu p 2 pi b L")
    verdicts.near("shrink fit turned: torque", torque, grip * b, SHRINK_BOUND, "mu p 2 pi b^2 L")
    for name, run in (("pushed out", out), ("turned", turned)):
        left = run.steps[-1]["interfaces"]["contact"]["stick"]
        verdicts.below(f"shrink fit {name}: stick nodes", left, 0, "all of it slips")
    return out, turned


TURN = ("-axle_value", "0,0,0", "-axle_gradient", "0,-1e-3,0,1e-3,0,0,0,0,0")


def capstan(verdicts, driver):
    run = driver.run("capstan")
    table = run.interface("contact")
    angle = np.pi - np.arctan2(table["Y"], table["X"])  # from the held end
    width = np.ptp(table["Z"])
    ratio = abs(run.steps[-1]["reactions"]["draw"][1]) / width
    verdicts.near("belt on a drum: T2 / T1, half around", ratio, formulas.belt_tension(np.pi, 0.3), CAPSTAN_BOUND, "Euler")
    middle = np.abs(angle - np.pi / 2) < 0.2  # far from the ends, where the belt bends
    exact = formulas.belt_tension(angle[middle], 0.3)
    worst = np.abs(table["p_lumped"][middle] / exact - 1).max()
    verdicts.below("belt on a drum: pressure about the middle", worst, CAPSTAN_BOUND, "T / R")
    return run


def incline(verdicts, driver):
    slope = 0.4
    run = driver.run("incline")
    table = run.interface("base")
    down, normal = 10 * slope / (1 + slope**2), 10 / (1 + slope**2)
    tangential = np.sqrt(table["lambda_tx"] ** 2 + table["lambda_ty"] ** 2 + table["lambda_tz"] ** 2)
    worst = max(np.abs(-table["lambda_n"] - normal).max(), np.abs(tangential - down).max()) / normal
    verdicts.below("slope, mu a millionth above its tangent: tractions", worst, INCLINE_BOUND, "exact")
    slipping = run.steps[-1]["interfaces"]["base"]["slip"]
    verdicts.below("slope, mu a millionth above its tangent: slip nodes", slipping, 0, "sticks")
    below = slope * (1 - INCLINE_MARGIN)
    driver.run("incline", "-base_friction", below, "-steps_smallest", 1, label="incline_below", expect=2)
    verdicts.true("slope, mu a millionth below its tangent: exit code 2", True, "no state of rest")
    return run


def torsion_disc(verdicts, driver, cells=24):
    run = driver.run("torsion_disc", "-disc_cells", f"{cells},{cells},1")
    table = run.interface("contact")
    torque = abs((table["X"] * table["fy"] - table["Y"] * table["fx"]).sum())
    exact = 2 / 3 * 0.3 * table["fz"].sum()
    verdicts.near(f"disc that is turned, {cells} cells across: torque", torque, exact, 0.01, "2/3 mu F R")
    return run
