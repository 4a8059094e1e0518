"""What `make study` solves: problems with a known answer, and the settings that are tried on each.

A Setting is what a host would choose: options of the driver, by knob. Each problem has a mesh on which one knob of the
library's default after the other is turned, and others that are tried with the defaults and with the cheapest settings that
still converge. The paper's element is a setting, too.
Errors are relative; `error` is the problem's own for the fronts, `errors` all of them.
"""

import functools
from dataclasses import dataclass, field
from typing import Callable

import numpy as np

import comparisons
import formulas
import friction_checks as friction
from reference import clamped_block
from scene import multiplier

DEFAULT, STANDARD, COMMITTED, PAPER = "default", "standard", "normals_committed", "paper"
# Points a triangle of each rule.
RULES = {"degree_1": 1, "degree_2": 3, "degree_4": 6, "degree_6": 12, "degree_10": 36}
ELEMENTS = (2, 3, 4, 6, 10)
# What the press fit's reactions are compared with: the same meshes with the finest rule, and steps a tenth as
# long, on which the answer does not depend.
PRESS_TRAVEL, PRESS_STEP, PRESS_FINE = 1000, 50, 5
PRESS_STEPS = (100, 50, 25, 10, 5, 2)
# What the block's tractions are compared with: an independent solver's, on this many cells along it. From 0.2 to 3.8 it
# is in contact; a facet of the coarsest mesh is left out at each corner, where the traction is singular.
BLOCK_FINE, BLOCK_INNER = 320, (0.4, 3.6)


@dataclass
class Setting:
    name: str  # unique in a problem; without blanks
    knob: str  # integration, tangent, tolerance, mesh, steps, form, weights, slip, basis, normals, paper
    options: tuple
    label: str = ""  # beside the point in a figure

    @property
    def short(self):
        return self.label or self.name


@dataclass
class Problem:
    name: str
    title: str
    scene: str
    interface: str
    measure: str  # what `error` is, in words
    errors: Callable  # (run, setting, driver) -> {name: value}, the first one for the front
    mesh: Callable  # size -> options
    sizes: tuple  # from coarse to fine; the middle one is where knobs are turned
    middle: int
    options: tuple = ()  # of every run
    only: tuple = ()  # knobs that mean something here; empty: all
    extra: tuple = field(default=())  # further settings
    states: tuple = ()  # (which of the errors says how far states are off, the same in words)

    def settings(self, quick=False):
        sizes, size = self.sizes, self.sizes[self.middle]
        key, mesh = self.interface, self.mesh(self.sizes[self.middle])
        option = lambda name, value: (f"-{key}_{name}", value)
        found = [Setting(DEFAULT, DEFAULT, mesh, "default")]

        def add(knob, name, *options, label="", mesh=mesh):
            if not self.only or knob in (*self.only, PAPER):
                found.append(Setting(name, knob, (*mesh, *options), label))

        for rule, points in RULES.items():
            # The tangent is not that of the coarsest sums: with weights frozen within a step there is none to be had. From one
            # point a patch no mass matrix of a facet follows, and without it no dual multipliers.
            frozen = option("weights", "committed") if points < 6 else ()
            frozen += option("basis", "standard") if points == 1 else ()
            add("integration", f"cells_{points}", *option("quadrature", rule), *frozen, label=f"{points} pts")
        for n in ELEMENTS:
            elements = (*option("integration", "elements"), *option("points", n))
            add("integration", f"elements_{n}", *elements, label=f"el {n}x{n}")
        for n in (3, 6):
            hybrid = (*option("integration", "hybrid"), *option("points", n))
            add("integration", f"hybrid_{n}", *hybrid, label=f"hy {n}x{n}")
        for tangent in ("frozen_weights", "frozen_normals"):
            # What does not converge in so many iterations is no way to save time.
            many = ("-snes_max_it", 60, "-steps_smallest", 0.3)
            add("tangent", tangent, *option("tangent", tangent), *many, label=tangent.replace("_", " "))
        for tolerance in ("1e-3", "1e-5", "1e-8"):
            add("tolerance", f"rtol_{tolerance}", "-snes_rtol", tolerance, label=f"rtol {tolerance}")
        for weights in ("committed", "reference"):
            add("weights", f"weights_{weights}", *option("weights", weights), label=f"{weights} weights")
        add("form", "augmented", *option("form", "augmented"))
        add("normals", COMMITTED, *option("normals", "committed"), label="normals of t_n")
        standard = option("basis", "standard")
        add("basis", STANDARD, *standard)
        add("paper", PAPER, "-method", "paper")
        for other in sizes:
            if other != size:
                add("basis", f"mesh_{other:g}_{STANDARD}", *standard, label=f"mesh {other:g} standard", mesh=self.mesh(other))
                add("mesh", f"mesh_{other:g}", label=f"mesh {other:g}", mesh=self.mesh(other))
            cheap = (*option("integration", "elements"), *option("points", 2), "-snes_rtol", "1e-5")
            add("mesh", f"mesh_{other:g}_cheap", *cheap, label=f"mesh {other:g} cheap", mesh=self.mesh(other))
        found += self.extra
        quick_names = {DEFAULT, "cells_1", "cells_3", "cells_36", "elements_2", "elements_10", "hybrid_3"}
        quick_names |= {"frozen_weights", STANDARD, COMMITTED, PAPER} | {f"mesh_{other:g}" for other in sizes[:-1]}
        return [s for s in found if s.name in quick_names] if quick else found


# --- patch ------------------------------------------------------------------------------------------------------------
def patch_errors(run, setting, driver):
    case = comparisons.PatchCase("patch_distorted", (0, 0, 10))
    deformed = "reference" not in setting.name
    return {"multiplier": comparisons.patch_error(run, case, deformed)}


def patch_mesh(n):
    return ("-upper_cells", f"{n},{n},2", "-lower_cells", f"{round(1.4 * n)},{round(1.4 * n)},2")


# --- Hertz, line ------------------------------------------------------------------------------------------------------
def pressure_errors(line, hertz):
    pressure = line.traction[:, 2]
    return {
        "pressure_l2": friction.profile_error(line, pressure, hertz.pressure),
        "peak": abs(pressure.max() / hertz.peak - 1),
        "half_width": abs(friction.fit_hertz(line.x, pressure)[1] / hertz.half_width - 1),
    }


def open_force(force, state):
    """Largest force of a node in gap, over the largest of all; none passes there."""
    force = np.linalg.norm(np.atleast_2d(force.T).T, axis=1)
    return float(force[state == "gap"].max(initial=0) / force.max())


def line_errors(run, setting, driver):
    line = run.line("contact")
    hertz = formulas.LineContact(line.force[:, 2].sum(), friction.LINE_MODULUS, friction.LINE_RADIUS)
    return {
        **pressure_errors(line, hertz),
        "multiplier": friction.profile_error(line, line.multiplier[:, 2], hertz.pressure),
        "open_force": open_force(line.force, line.state),
    }


# --- Cattaneo and Mindlin ---------------------------------------------------------------------------------------------
def cattaneo_errors(run, setting, driver):
    line = run.line("contact")
    normal, pull = line.force[:, 2].sum(), -line.force[:, 0].sum()
    exact = formulas.LineContact(normal, friction.LINE_MODULUS, friction.LINE_RADIUS, friction.LINE_MU, pull)
    errors = {"shear_l2": friction.shear_error(line, exact), **pressure_errors(line, exact)}
    errors["multiplier"] = friction.profile_error(line, -line.multiplier[:, 0], exact.shear)
    errors["stick_radius"] = abs(friction.stick_half_width(line) / exact.stick - 1)
    return errors


def cattaneo_mesh(h):
    return (*friction.line_mesh(h), *friction.pressing(round(0.68 / h)))


# --- Hertz, ball ------------------------------------------------------------------------------------------------------
BALL_STEPS = ("-steps_count", 1)


def ball_pressures(table):
    """(r, forces over areas, what the multipliers say, formula) of the ball on the block. Areas are those of the last
    step's start: with BALL_STEPS undeformed, as the linear elastic bodies see them."""
    hertz = formulas.PointContact(4 * table["fz"].sum(), friction.formulas.plane_modulus(1000, 0.3) / 2, 1.0)
    area = table["area_full"]
    own = -multiplier(table)[:, 2] * table["area_covered"] / area
    return np.hypot(table["X"], table["Y"]), table["fz"] / area, own, hertz


def ball_errors(run, setting, driver):
    table = run.interface("contact")
    r, pressure, own, hertz = ball_pressures(table)
    area, exact = table["area_full"], hertz.pressure(r)
    inner = r < 0.8 * hertz.contact_radius  # nodes away from the rim, where a nodal mean is not a value
    l2 = lambda values: float(np.sqrt((area * (values - exact) ** 2).sum() / (area * exact**2).sum()))
    return {
        "pressure_l2": l2(pressure),
        "multiplier": l2(own),
        "peak": abs(pressure.max() / hertz.peak - 1),
        "inner": float(np.abs(pressure - exact)[inner].max() / hertz.peak),
        "contact_radius": abs(friction.fit_hertz(r, pressure)[1] / hertz.contact_radius - 1),
        "open_force": open_force(table["fz"], table["state"]),
    }


def ball_mesh(h):
    options = []
    for body, size, far, sign, top in (("ball", h, 1, 1, 0), ("block", 1.16 * h, 1.2, -1, -1)):
        across = friction.numbers(friction.graded(size, 0.16, far, 2.0))
        depth = friction.graded(size, 2 * size, far, 2.0)
        z = np.sort(-1 + sign * depth) if sign > 0 else np.sort(top - depth)
        options += [f"-{body}_x", across, f"-{body}_y", across, f"-{body}_z", friction.numbers(z)]
    return tuple(options)


# --- block ------------------------------------------------------------------------------------------------------------
@functools.cache
def block_reference():
    """(x, force) on a fine mesh, on which every node sticks."""
    return clamped_block(BLOCK_FINE, BLOCK_FINE // 2)


def block_errors(run, setting, driver):
    line, (x, force) = run.line("base"), block_reference()
    # The fine forces as nodal ones of the coarse mesh, whose functions are linear along x.
    share = np.array([np.interp(x, line.x, unit) for unit in np.eye(len(line.x))])
    exact = share @ force / line.length[:, None]
    inner = (line.x > BLOCK_INNER[0] - 1e-9) & (line.x < BLOCK_INNER[1] + 1e-9)
    mean = lambda values: np.average((values**2).sum(axis=1)[inner], weights=line.length[inner])
    l2 = lambda values: float(np.sqrt(mean(values[:, [0, 2]] - exact) / mean(exact)))
    slipping = float(np.mean(line.state != "stick"))
    return {"traction_l2": l2(line.traction), "multiplier": l2(line.multiplier), "slipping": slipping}


def block_mesh(columns):
    return ("-block_cells", f"{columns},1,{columns // 2}", "-floor_cells", f"{columns * 13 // 20},3,1")


# --- press fit --------------------------------------------------------------------------------------------------------
def press_times(step):
    times = [0.25 * k for k in range(1, 5)] + [1 + 0.001 * step * k for k in range(1, round(PRESS_TRAVEL / step) + 1)]
    return ("-steps_times", friction.numbers(times))


def press_steps():
    """Steps of every length with either normals; those of PRESS_STEP are the default and COMMITTED."""
    for step in PRESS_STEPS:
        if step != PRESS_STEP:
            steps = (*press_mesh(18)[:2], *press_times(step))
            yield Setting(f"steps_{step}", "steps", steps, f"steps of {step}")
            yield Setting(f"steps_{step}_{COMMITTED}", "normals", (*steps, "-contact_normals", "committed"), f"{step}, normals of t_n")


def press_mesh(cells):
    return ("-slider_cells", f"{cells},1,{cells // 6}", *press_times(PRESS_STEP))


def pushes(run):
    return {round(s["t"], 6): np.array([s["reactions"]["push"][0], s["reactions"]["symmetry"][2]]) for s in run.steps}


@functools.cache
def press_reference(driver):
    fine = ("-contact_quadrature", "degree_10", *press_times(PRESS_FINE))
    return pushes(driver.run("press_fit", *press_mesh(18)[:2], *fine, *QUIET, label="press_fit/reference"))


def press_errors(run, setting, driver):
    ours, exact = pushes(run), press_reference(driver)
    times = [t for t in ours if t > 1 + 1e-9 and t in exact]
    ours, exact = (np.array([each[t] for t in times]) for each in (ours, exact))
    if len(ours) > 3:
        wave = np.abs(np.diff(ours[:, 0], 2)).max() / 4 / np.abs(ours[:, 0]).max()
    else:
        wave = float("nan")
    return {
        "reactions": float(np.sqrt(((ours - exact) ** 2).sum() / (exact**2).sum())),
        "force_oscillation": float(wave),
    }


QUIET = ("-output_vtu", "none", "-output_csv", "last", "-output_quiet", "true")

OPEN = "largest force of an open node, over the largest of all"

PROBLEMS = [
    Problem("patch", "Patch test on distorted facets", "patch_distorted", "base", "worst nodal multiplier",
            patch_errors, patch_mesh, (3, 5, 8), 1, ("-base_law", "none", "-base_friction", 0),
            only=("integration", "tangent", "tolerance", "form", "mesh", "basis")),
    Problem("hertz_line", "Hertz: half-cylinders", "cattaneo_line", "contact", "pressure, root mean square",
            line_errors, lambda h: tuple(friction.line_mesh(h)), (0.272, 0.136, 0.068, 0.034), 1, friction.FRICTIONLESS,
            only=("integration", "tangent", "tolerance", "form", "mesh", "weights", "basis", "normals"),
            states=("open_force", OPEN)),
    Problem("hertz_ball", "Hertz: ball on block", "ball_on_block", "contact", "pressure, root mean square", ball_errors,
            ball_mesh, (0.05, 0.025, 0.0167), 1, BALL_STEPS,
            only=("integration", "tangent", "tolerance", "mesh", "basis", "normals"), states=("open_force", OPEN)),
    Problem("block", "Block between two corners", "block_zone_mu05", "base", "tractions, root mean square", block_errors,
            block_mesh, (20, 40, 80), 0, ("-steps_count", 4), only=("tolerance", "mesh", "basis"),
            states=("slipping", "part of the nodes that do not stick")),
    Problem("cattaneo", "Cattaneo and Mindlin: shear", "cattaneo_line", "contact", "shear traction, root mean square",
            cattaneo_errors, cattaneo_mesh, (0.136, 0.068, 0.034), 0,
            states=("stick_radius", "error of the half-width of stick"),
            extra=(Setting("slip_paper", "slip", (*cattaneo_mesh(0.136), "-contact_slip", "paper"), "slip as printed"),
                   Setting("slip_increment", "slip", (*cattaneo_mesh(0.136), "-contact_slip", "increment"),
                           "slip increment"),
                   Setting("steps_2", "steps", (*friction.line_mesh(0.136), *friction.pressing(2, 1)), "2+1 steps"),
                   Setting("steps_20", "steps", (*friction.line_mesh(0.136), *friction.pressing(20, 8)),
                           "20+8 steps"))),
    Problem("press_fit", "Press fit: reactions", "press_fit", "contact", "reactions, root mean square", press_errors,
            press_mesh, (18,), 0, only=("integration", "tangent", "tolerance", "form", "weights", "basis", "normals"),
            extra=tuple(press_steps())),
]
