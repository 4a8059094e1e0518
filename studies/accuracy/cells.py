"""Linear and quadratic cells: which of them make a digit cheaper?

cells.py --build DIR [--renew-figures]; `make study` draws it, too. Two problems with exact answers on any mesh: blocks tied
over facets that do not match, whose solution is smooth, and a rigid parabola pressed into a half-plane, where the rim of the
contact decides. The figure goes to DIR/study/cells.png; with --renew-figures it and the table go to docs.
"""

import argparse
import itertools
import math
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import matplotlib  # noqa: E402

matplotlib.use("Agg")  # no display is needed

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import quadratic_line  # noqa: E402
import quadratic_tied  # noqa: E402
from cell_fields import errors  # noqa: E402
from documents import put_between  # noqa: E402
from figures import BLUE, GREY, INK, RED, _save  # noqa: E402
from scene import Driver, SceneError  # noqa: E402
from study_page import markdown, per_cent  # noqa: E402

DOCUMENT = folders.ROOT / "docs" / "cells.md"
MARKS = ("<!-- cells -->", "<!-- /cells -->")
QUIET = ("-output_quiet", "true")
RUNS = 2
# What a user may want, relative.
GOALS = (0.1, 0.03, 0.01, 0.003, 0.001)
# Half-widths over the coarsest facets: an error goes up and down with the place of the rim in its facet.
HALF_WIDTHS = (3.2, 3.5, 3.8)
# Of the integral of the pressure's error over x.
POINTS = 4001
QUICK = 8  # facets a side
GREEN, ORANGE = "#3a8f5c", "#d0862c"


@dataclass
class Curve:
    cell: str
    space: str
    basis: str
    colour: str
    mark: str

    @property
    def label(self):
        name = {"hex": "hex8", "tet": "tet4"}.get(self.cell, self.cell)
        linear = self.cell in ("hex", "tet")
        return f"{name}, {self.basis}" if linear else f"{name}, {self.space}, {self.basis}"


LINEAR = [Curve("hex", "corner", "standard", GREY, "s"), Curve("hex", "corner", "dual", INK, "s")]
QUADRATIC = [Curve("hex20", "corner", "standard", BLUE, "o"), Curve("hex20", "corner", "dual", RED, "o"),
             Curve("hex20", "sub", "standard", GREEN, "o")]
TETRAHEDRA = [Curve("tet", "corner", "standard", GREY, "^"), Curve("tet10", "corner", "standard", BLUE, "^"),
              Curve("tet10", "sub", "standard", GREEN, "^")]
CURVES = {
    "tied": [*LINEAR[:1], *QUADRATIC, *TETRAHEDRA],
    "line": [*LINEAR, *QUADRATIC, Curve("tet10", "corner", "dual", ORANGE, "^")],
}
# Facets a side; facets per size of the coarsest.
SIZES = {
    "tied": {"hex": (4, 8, 16, 24), "tet": (4, 8, 16, 24), "": (4, 8, 12)},
    "line": {"hex": (2, 4, 8), "": (1, 2, 4)},
}
TITLES = {"strain": "Tied blocks, smooth: strains", "force": "Hertz, line: force", "pressure": "Hertz, line: pressure"}


def sizes_of(problem, curve):
    return SIZES[problem].get(curve.cell, SIZES[problem][""])


COUNT = RUNS * sum(len(sizes_of(problem, curve)) * (len(HALF_WIDTHS) if problem == "line" else 1)
                   for problem, curves in CURVES.items() for curve in curves)


def solve(driver, path, interface, curve):
    """(a run, least processor time of RUNS); of linear cells the corners are all nodes"""
    options = [f"-{interface}_multiplier_space", curve.space] if curve.cell not in ("hex", "tet") else []
    options += [f"-{interface}_basis", curve.basis, *QUIET]
    label = f"cells/{path.stem}_{curve.space}_{curve.basis}"
    runs = [driver.run(path, *options, label=f"{label}/{k}") for k in range(RUNS)]
    return runs[0], min(run.summary["seconds"]["processor"] for run in runs)


@dataclass
class Point:
    error: float
    unknowns: int
    newton: float
    seconds: float


def tied(driver, scenes, curve, facets):
    run, seconds = solve(driver, quadratic_tied.scene(scenes, curve.cell, facets), "base", curve)
    return {"strain": errors(run, quadratic_tied.exact)[0]}, run.summary["unknowns"], run.newton_iterations, seconds


def pressure_error(table, curve, a):
    """Root mean square over that of the pressure. Nodal pressures, linear in between, as one draws them; multipliers at
    every node are drawn themselves."""
    values = -table["lambda_n"] if curve.space == "sub" else table["p_lumped"]
    x, group = np.unique(np.round(table["X"], 9), return_inverse=True)
    nodal = np.bincount(group, weights=values) / np.bincount(group)
    at = np.linspace(0, x[-1], POINTS)
    exact = quadratic_line.PLANE / (2 * quadratic_line.RADIUS) * np.sqrt(np.maximum(a * a - at * at, 0))
    return np.sqrt(((np.interp(at, x, nodal) - exact) ** 2).sum() / (exact**2).sum())


def line(driver, scenes, curve, parts):
    """Root mean squares over the half-widths; means of iterations and seconds."""
    found = []
    for a in HALF_WIDTHS:
        run, seconds = solve(driver, quadratic_line.scene(scenes, curve.cell, a, parts), "contact", curve)
        force = 2 * np.abs(run.resultant("contact")[2]) / quadratic_line.force(a) - 1
        found.append((force, pressure_error(run.interface("contact"), curve, a), run.newton_iterations, seconds))
    force, pressure, newton, seconds = np.array(found).T
    mean = lambda values: float(np.sqrt((values**2).mean()))
    return {"force": mean(force), "pressure": mean(pressure)}, run.summary["unknowns"], newton.mean(), seconds.mean()


@dataclass
class Scenes:
    """Where scene files go that are written for a mesh."""

    output: Path


def measure(driver):
    """{error: {curve's label: [Point of each mesh]}}"""
    scenes = Scenes(driver.output / "cells")
    scenes.output.mkdir(parents=True, exist_ok=True)
    found = {error: {} for error in TITLES}
    for problem, curves in CURVES.items():
        for curve in curves:
            for size in sizes_of(problem, curve):
                values, *costs = {"tied": tied, "line": line}[problem](driver, scenes, curve, size)
                for name, value in values.items():
                    found[name].setdefault(curve.label, []).append(Point(value, *costs))
    return found


def seconds_for(goal, points):
    """In words; between the meshes, as powers."""
    if points[0].error <= goal:
        return f"below {points[0].seconds:.2f} s"
    for coarse, fine in itertools.pairwise(points):
        if fine.error <= goal:
            errors, seconds = ([math.log(getattr(p, name)) for p in (fine, coarse)] for name in ("error", "seconds"))
            return f"{math.exp(np.interp(math.log(goal), errors, seconds)):.2f} s"
    return "not reached"


def table(found):
    head = ["problem", "cells, multipliers", *(per_cent(goal) for goal in GOALS), "finest mesh: error", "unknowns",
            "Newton", "seconds"]
    body = []
    for error, curves in found.items():
        for label, points in curves.items():
            last = points[-1]
            body.append([TITLES[error], label, *(seconds_for(goal, points) for goal in GOALS), per_cent(last.error),
                         str(last.unknowns), f"{last.newton:.0f}", f"{last.seconds:.2f}"])
    return head, body


def draw(driver, folder):
    """Runs all; returns the figure's path and the table."""
    found = measure(driver)
    styles = {curve.label: curve for curves in CURVES.values() for curve in curves}
    figure, axes = plt.subplots(1, len(TITLES), figsize=(14.4, 4.4))
    for axis, (error, curves) in zip(axes, found.items()):
        for label, points in curves.items():
            style = styles[label]
            axis.loglog([p.seconds for p in points], [p.error for p in points], marker=style.mark, color=style.colour,
                        mfc="none" if style.mark == "^" else None, markersize=5, linewidth=1, label=label)
        axis.set_title(TITLES[error])
        axis.set_xlabel("processor time [s]")
        axis.grid(True, which="major", color="#eeeeee", zorder=0)
        axis.legend(frameon=False, fontsize=7)
    axes[0].set_ylabel("error")
    figure.tight_layout()
    return _save(figure, folder / "cells.png"), table(found)


def renew(figure, rows):
    shutil.copy(figure, folders.FIGURES / figure.name)
    put_between(DOCUMENT, MARKS, f"\n\n{markdown(rows)}\n\n")


def quick(driver, verdicts):
    """On coarse meshes: the order that errors must have."""
    scenes = Scenes(driver.output / "cells")
    scenes.output.mkdir(parents=True, exist_ok=True)
    linear, quadratic = (tied(driver, scenes, curve, QUICK)[0]["strain"] for curve in (LINEAR[0], QUADRATIC[0]))
    what = f"tied blocks: quadratic cells beat linear ones, {quadratic:.1e} < {linear:.1e}"
    verdicts.true(what, quadratic < linear, "order")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--renew-figures", action="store_true", help="renew the figure in docs/figures and the table, too")
    arguments = parser.parse_args()
    output = arguments.build / "study"
    output.mkdir(parents=True, exist_ok=True)
    try:
        path, rows = draw(Driver(arguments.build, output, keep=True), output)
    except SceneError as problem:
        print(f"\n{problem}", file=sys.stderr)
        return 1
    if arguments.renew_figures:
        renew(path, rows)
    print(markdown(rows))
    print(path.resolve())
    return 0


if __name__ == "__main__":
    sys.exit(main())
