"""Westergaard's wave: error, order, border and closing of each element, over the facets."""

from dataclasses import dataclass

import numpy as np

import westergaard
from westergaard import CORNER, CORNER_POINTS, CORNER_STANDARD, DUAL, POINTS, STANDARD, SUB, SUB_POINTS

ELEMENTS = (STANDARD, DUAL, POINTS, CORNER_STANDARD, CORNER, CORNER_POINTS, SUB, SUB_POINTS)
LOADS = {"light": westergaard.LIGHT, "half": westergaard.HALF}
FACETS = (5, 10, 20)
# Of the elements that reach a tenth of a per cent.
FINE, HALVED, MORE = (DUAL, POINTS, SUB_POINTS), (DUAL, POINTS), {"light": (40,), "half": (40, 80)}
# Over the half wave.
CLOSING = (10, 20, 40)


@dataclass
class Found:
    """Of ten positions of the border."""

    errors: np.ndarray
    area: np.ndarray  # of the border, over the half-width
    fit: np.ndarray
    newton: float
    seconds: float
    unknowns: int


def measure(driver, element, facets, part, times=0):
    rows, count = [], westergaard.cells(element, facets, part)
    for a in westergaard.half_widths(facets, part):
        run = westergaard.solve(driver, element, count, a, westergaard.Halved(times, facets))
        rows.append((westergaard.error(run, a, element), westergaard.border_by_area(run) / a - 1,
                     westergaard.border_by_fit(run, a, element) / a - 1, run.newton_iterations, run.summary["seconds"]["processor"]))
    errors, area, fit, newton, seconds = np.array(rows).T
    return Found(errors, np.abs(area), np.abs(fit), newton.mean(), float(np.median(seconds)), run.summary["unknowns"])


def all_of(driver):
    """{(load, element, facets): Found}"""
    found = {}
    for load, part in LOADS.items():
        for element in ELEMENTS:
            for facets in (*FACETS, *(MORE[load] if element in FINE else ())):
                found[load, element.name, facets] = measure(driver, element, facets, part)
    return found


def order(values):
    """From the coarsest of FACETS to the finest."""
    return np.log(values[0] / values[-1]) / np.log(FACETS[-1] / FACETS[0])


def table(found):
    head = ["load", "element", *(f"{n} facets" for n in FACETS), "order", "border by areas", "order", "border by the fit", "order", "Newton", "seconds"]
    body = []
    for load in LOADS:
        for element in ELEMENTS:
            of = [found[load, element.name, n] for n in FACETS]
            errors, area, fit = ([getattr(f, what).mean() for f in of] for what in ("errors", "area", "fit"))
            body.append([load, element.name, *(f"{100 * f.errors.mean():.2f} ({100 * f.errors.max():.2f})" for f in of), f"{order(errors):.2f}",
                         f"{100 * area[-1]:.2f}", f"{order(area):.2f}", f"{100 * fit[-1]:.3f}", f"{order(fit):.2f}",
                         f"{of[-1].newton:.1f}", f"{of[-1].seconds:.2f}"])
    return head, body


GOALS = (0.05, 0.01, 0.001)


def digits(found):
    """The least facets over the half-width, of those measured, with which the mean, and the worst, of ten positions is within each goal."""
    head = ["load", "element", *(f"{100 * goal:g} %" for goal in GOALS), *(f"{100 * goal:g} %, worst position" for goal in GOALS)]
    body = []
    for load in LOADS:
        for element in ELEMENTS:
            of = sorted((n, f) for (l, name, n), f in found.items() if (l, name) == (load, element.name))
            cells = []
            for of_errors in (np.mean, np.max):
                for goal in GOALS:
                    reached = next(((n, f) for n, f in of if of_errors(f.errors) <= goal), None)
                    best = of_errors(of[-1][1].errors)
                    cells.append(f"{reached[0]} facets, {reached[1].seconds:.2f} s" if reached else f"{100 * best:.2g} % with {of[-1][0]}")
            body.append([load, element.name, *cells])
    return head, body


# Facets over the half-width, of which three around the border are halved so many times.
GRADED, TIMES = (5, 10), (0, 1, 2, 3)


def graded(driver):
    head = ["element", "facets", *(["equal"] + [f"halved {n} times" for n in TIMES[1:]]), "seconds"]
    body = []
    for element in HALVED:
        for facets in GRADED:
            of = [measure(driver, element, facets, westergaard.LIGHT, times) for times in TIMES]
            body.append([element.name, str(facets), *(f"{100 * f.errors.mean():.2f} ({100 * f.errors.max():.2f})" for f in of), f"{of[-1].seconds:.2f}"])
    return head, body


def closing(driver):
    head = ["element", *(f"{n} facets over the half wave" for n in CLOSING)]
    told = lambda pressure: f"above {westergaard.CLOSING[-1]:g}" if pressure is None else f"{pressure:.3f}"
    count = lambda element, n: n // (2 if element.quadratic else 1)
    body = [[element.name, *(told(westergaard.closing(driver, element, count(element, n))) for n in CLOSING)] for element in ELEMENTS]
    return head, body
