"""The same problems in other programs, on the same meshes: `make compare`. compare.py --build DIR [--only NAME ...] [--renew].

Errors are of nodal contact forces, which follow from each program's displacements by the same elements; on hexahedra of 20
nodes, of the whole force. Hertz' line has ten loads, which move the border of the contact through a facet; its pressure is
compared with Hertz' formula and with fine meshes (fine_line.py), of the theory that each program has and of the deformed
bodies. A program that is not installed is left out with a word; one that finds no answer is shown with what it said. Seconds are wall time of
each program's own solution, with whatever linear solver it brings, and include its start: for orders of magnitude.
What has been run is kept. Tests with exact answers are those of exact_tests.py. --renew: puts the tables, those that were asked for,
into docs/other_programs.md, and the figure, if all tests with exact answers were.
"""

import argparse
import re
import shutil
import sys
from itertools import chain
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import exact_tests  # noqa: E402
import exact_tests_figure  # noqa: E402
import fine_line  # noqa: E402
import formulas  # noqa: E402
import friction_checks as friction  # noqa: E402
import half_plane  # noqa: E402
import peers  # noqa: E402
import study_page  # noqa: E402
from documents import put_between  # noqa: E402
from scene import Driver, Line, SceneError  # noqa: E402

DOCUMENT = folders.ROOT / "docs" / "other_programs.md"
LINE = "line"
MARKS = ("<!-- compare -->", "<!-- /compare -->")
# Over the half-width that the scene's own load has, and how far that one presses.
FACETS, HALF_WIDTH, TRAVEL = (5, 10, 20), 0.68, 0.1828
# They move the border through one facet.
LOADS = 10
# The whole load in one step takes minutes each.
LEFT_OUT = {(20, "stickslip, points")}
# The others take the contact's geometry from the undeformed bodies.
SMALL = ("-contact_weights", "reference")
POINTS = ("-contact_decision", "points")
# Normals of the last step, whatever they lag by.
LAGGING = ("-contact_normals", "committed", "-contact_lag_max", 1, "-contact_lag_corrected", "false")
PAPER = ("-method", "paper", *LAGGING)
# Points with weights of the last step: the load is taken in four steps.
STEPPED = ("-contact_weights", "committed", "-steps_times", "0.25,0.5,0.75,1")
LAWS = {
    "stickslip, defaults": (),
    "stickslip, normals of the last step": LAGGING,
    "stickslip, the paper's element": PAPER,
    "stickslip, points": POINTS,
    "stickslip, small displacements": SMALL,
    "stickslip, small displacements, standard": (*SMALL, "-contact_basis", "standard"),
    "stickslip, small displacements, points": (*SMALL, *POINTS),
}
HERTZ_LAWS = {**LAWS, "stickslip, points, four steps": (*STEPPED, *POINTS)}
# What each takes for the contact's geometry on Hertz' line, as fine_line.py has it. The forces tell: their direction is that of
# the normals, and how far they act from each other along x on the two sides says which points touch, to three digits.
# In four steps normals are undeformed where nothing touched before the last one.
DEFORMED = "current"
THEORIES = {
    "stickslip, defaults": "current",
    "stickslip, normals of the last step": "start",
    "stickslip, the paper's element": "start",
    "stickslip, points": "current",
    "stickslip, small displacements": "non-mortar",
    "stickslip, small displacements, standard": "non-mortar",
    "stickslip, small displacements, points": "non-mortar",
    "stickslip, points, four steps": "current",
    "CalculiX, surface to surface (penalty)": "mortar",
    "CalculiX, mortar": "non-mortar",
    "GetFEM, nodes against faces, augmented Lagrangian": "mortar",
    "Kratos, mortar, augmented Lagrangian": "current",
}
OURS = ("-output_vtu", "last", "-output_csv", "last", "-output_quiet", "true")


CALCULIX = [
    ("CalculiX, surface to surface (penalty)", lambda case, folder: peers.calculix(case, folder, "SURFACE TO SURFACE")),
    ("CalculiX, mortar", lambda case, folder: peers.calculix(case, folder, "MORTAR")),
]
PROGRAMS = [
    *CALCULIX,
    ("GetFEM, nodes against faces, augmented Lagrangian", peers.getfem),
    ("Kratos, mortar, augmented Lagrangian", peers.kratos),
]


def case_of(name, run, young, poisson, foot, opposite, supports, traction=0.0):
    """The mesh of a finished run; `foot`, `opposite`: nodes of the faces in contact; `supports`: (body, where,
    component, value); `traction` along z on the top."""
    points, kinds, _ = run.mesh()
    cells, bodies = kinds["hexahedron"], run.cell_bodies()
    bodies = bodies - bodies.min()
    fixed = []
    for body, where, component, value in supports:
        nodes = np.unique(cells[np.isin(bodies, body)])
        fixed.append((nodes[where(points[nodes])], component, value))
    faces = lambda body, on: peers.faces_on(cells, points, bodies, body, on(points))
    loads = np.zeros_like(points)
    case = peers.Case(name, points, cells, bodies, young, poisson, fixed, loads, faces(0, foot), faces(1, opposite))
    if traction:
        top = points[:, 2].max()
        loads[:, 2] = traction * shares(case, faces(0, lambda x: np.abs(x[:, 2] - top) < 1e-9))
    return case


def shares(case, faces):
    """int N_A over flat or bilinear faces, per node."""
    area = np.zeros(len(case.points))
    for cell, face in faces:
        nodes = case.cells[cell][list(peers.FACES[face])]
        x = case.points[nodes]
        for s, t in np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) / np.sqrt(3):
            n = np.array([(1 - s) * (1 - t), (1 + s) * (1 - t), (1 + s) * (1 + t), (1 - s) * (1 + t)]) / 4
            ds = np.array([-(1 - t), 1 - t, 1 + t, -(1 + t)]) / 4
            dt = np.array([-(1 - s), -(1 + s), 1 + s, 1 - s]) / 4
            area[nodes] += n * np.linalg.norm(np.cross(ds @ x, dt @ x))
    return area


def contact_forces(case, displacement):
    """(nodes of the non-mortar side, force on them)."""
    nodes = np.unique([case.cells[cell][list(peers.FACES[face])] for cell, face in case.nonmortar])
    return nodes, peers.internal_forces(case, displacement)[nodes]


def patch_error(case, displacement):
    nodes, force = contact_forces(case, displacement)
    exact = 10 * shares(case, case.nonmortar)[nodes]
    return np.abs(force[:, 2] - exact).max() / exact.max()


def hertz_line(case, displacement):
    """The non-mortar side seen along x, as scene.py's `Run.line`"""
    nodes, force = contact_forces(case, displacement)
    x, first, group = np.unique(np.round(case.points[nodes, 0], 9), return_index=True, return_inverse=True)
    thickness = np.ptp(case.points[nodes, 1])
    total = np.stack([np.bincount(group, weights=force[:, i]) / thickness for i in range(3)], axis=1)
    half = np.hypot(np.diff(x), np.diff(case.points[nodes][first, 2])) / 2
    return Line(x, total, np.append(half, 0) + np.append(0, half), np.full(len(x), "slip"))


class Yardsticks:
    """Errors of Hertz' line at equal force, against his formula and fine meshes; `apart`: the most that two of these differ"""

    def __init__(self, folder):
        self.fine, self.coarser = (fine_line.FineLine(folder, facets) for facets in (fine_line.FACETS, fine_line.FACETS // 2))
        self.apart = 0.0

    def errors(self, case, displacement, theory):
        """(against Hertz' formula, against the fine mesh of `theory`, against that of the deformed bodies)"""
        line = hertz_line(case, displacement)
        force = line.force[:, 2].sum()
        hertz = formulas.LineContact(force, friction.LINE_MODULUS, friction.LINE_RADIUS)
        own, deformed = (self.against(line, force, of) for of in (theory, DEFORMED))
        return friction.profile_error(line, line.traction[:, 2], hertz.pressure), own, deformed

    def against(self, line, force, theory):
        # The fine mesh's pressure is over lengths along x, tractions are over those along the facets.
        flat = np.append(np.diff(line.x) / 2, 0) + np.append(0, np.diff(line.x) / 2)
        fine, coarser = (formulas.nodal_mean(of.profile(theory, force), line.x) * flat / line.length
                         for of in (self.fine, self.coarser))
        mean = lambda values: np.sqrt((line.length * values**2).sum() / (line.length * fine**2).sum())
        self.apart = max(self.apart, mean(coarser - fine))
        return mean(line.traction[:, 2] - fine)


def folder_of(driver, case, name):
    return driver.output / f"{case.name}_{re.sub(r'[^a-z]+', '_', name.lower())}"


def said(failure):
    return f"{type(failure).__name__}: {failure}".replace("\n", " ")[:110]


def rows_of(driver, title, case, ours, programs, error, missing):
    """`ours`: (name, run, its error); `error` of a program's answer. What is not installed goes to `missing`."""
    for name, run, own in ours:
        yield [title, name, f"{own:.1e}", str(run.newton_iterations), f"{run.summary['seconds']['total']:.1f}", ""]
    for name, program in programs:
        try:
            answer = peers.kept(program, case, folder_of(driver, case, name))
        except peers.Missing as what:
            missing.add(str(what))
        except Exception as failure:  # whatever another program does
            yield [title, name, "", "", "", said(failure)]
        else:
            yield [title, f"{name}, {answer.version}", f"{error(answer):.1e}", str(answer.iterations),
                   f"{answer.seconds:.1f}", ""]


def patch_rows(driver, missing):
    runs = {law: driver.run("compare_patch", *OURS, *of, label=f"compare_patch_{k}") for k, (law, of) in enumerate(LAWS.items())}
    on = lambda axis, value: lambda x: np.abs(x[:, axis] - value) < 1e-9
    supports = [(1, on(2, 0), 2, 0.0), ([0, 1], on(0, 0), 0, 0.0), ([0, 1], on(1, 0), 1, 0.0)]
    case = case_of("patch", next(iter(runs.values())), 1000, 0.3, on(2, 0.5), on(2, 0.5), supports, -10.0)
    ours = [(law, run, patch_error(case, run.mesh()[2])) for law, run in runs.items()]
    error = lambda answer: patch_error(case, answer.displacement)
    return rows_of(driver, "patch test, 3 x 3 on 4 x 5 facets", case, ours, PROGRAMS, error, missing)


def laws_of(facets, laws=HERTZ_LAWS):
    return [law for law in laws if (facets, law) not in LEFT_OUT]


def hertz_case(driver, facets, travel, name, laws=HERTZ_LAWS):
    """(case, runs of our laws by name) of the half-cylinders pressed together by `travel`; `laws`: options by name."""
    h = HALF_WIDTH / facets
    options = (*friction.line_mesh(h), *friction.FRICTIONLESS, "-press_value", f"0,0,{-travel:.10g}", *OURS)
    runs = {law: driver.run("cattaneo_line", *options, *of, label=f"{name}_{k}")
            for k, (law, of) in enumerate(laws.items()) if law in laws_of(facets, laws)}
    first = next(iter(runs.values()))
    points = first.mesh()[0]
    radius = lambda x, z: np.hypot(x[:, 0], x[:, 2] - z)
    foot = lambda x: (np.abs(radius(x, 8) - 8) < 1e-6) & (np.abs(x[:, 0]) < 1.2) & (x[:, 2] < 1)
    under = lambda x: (np.abs(radius(x, -8) - 8) < 1e-6) & (np.abs(x[:, 0]) < 1.6) & (x[:, 2] > -1)
    top, low = points[:, 2].max(), points[:, 2].min()
    every, at = lambda x: np.ones(len(x), bool), lambda z: lambda x: np.abs(x[:, 2] - z) < 1e-9
    supports = [([0, 1], every, 1, 0.0), (0, at(top), 2, -travel), (0, at(top), 0, 0.0), (1, at(low), 2, 0.0),
                (1, at(low), 0, 0.0)]
    return case_of(name, first, 200, 0.3, foot, under, supports), runs


def mean_row(facets, name, theory, found, failures):
    """`found`: (errors, iterations, seconds) of each load that has an answer."""
    failed = f"{len(failures)} of {LOADS}: {failures[0]}" if failures else ""
    if not found:
        return [str(facets), name, "", "", theory, "", "", "", failed]
    errors, iterations, seconds = (np.array(column) for column in zip(*found))
    hertz, own, deformed = (f"{100 * each.mean():.2g} ({100 * each.max():.2g})" for each in errors.T)
    return [str(facets), name, hertz, own, theory, deformed, f"{iterations.mean():.1f}", f"{seconds.mean():.1f}", failed]


def hertz_rows(driver, missing, yardsticks):
    """Hertz' line: a row for each number of facets and each program, means over the loads."""
    for facets in FACETS:
        cases = []
        for k, wide in enumerate((facets - 0.5 + np.arange(LOADS) / LOADS) / facets):
            # The travel goes with the square of the half-width, nearly.
            cases.append(hertz_case(driver, facets, TRAVEL * wide**2, f"hertz_{facets}_{k}"))
        for law in laws_of(facets):
            errors = lambda case, run: yardsticks.errors(case, run.mesh()[2], THEORIES[law])
            runs = [(case, runs[law]) for case, runs in cases]
            found = [(errors(case, r), r.newton_iterations, r.summary["seconds"]["total"]) for case, r in runs]
            yield mean_row(facets, law, THEORIES[law], found, [])
        for name, program in PROGRAMS:
            found, failures, version = [], [], ""
            for case, _ in cases:
                try:
                    answer = peers.kept(program, case, folder_of(driver, case, name))
                except peers.Missing as what:
                    missing.add(str(what))
                    break
                except Exception as failure:  # whatever another program does
                    failures.append(said(failure))
                else:
                    version = f", {answer.version}"
                    errors = yardsticks.errors(case, answer.displacement, THEORIES[name])
                    found.append((errors, answer.iterations, answer.seconds))
            if found or failures:
                yield mean_row(facets, name + version, THEORIES[name], found, failures)


def quadratic(driver, missing):
    found = list(half_plane.runs(driver))
    ours = [(name, run, half_plane.force_error(run.resultant("contact")[2])) for name, run in found]
    case, parabola = half_plane.case_of(found[0][1])
    error = lambda answer: half_plane.force_error(answer.reactions[parabola, 2].sum())
    return rows_of(driver, half_plane.TITLE, case, ours, CALCULIX, error, missing)


def collected(rows):
    """Prints rows as they come."""
    body = []
    for row in rows:
        body.append(row)
        print(" | ".join(row), flush=True)
    return body


def line(driver, missing):
    """Tables of the patch test and of Hertz' contact."""
    single = collected(chain(patch_rows(driver, missing), quadratic(driver, missing)))
    yardsticks = Yardsticks(driver.output)
    means = collected(hertz_rows(driver, missing, yardsticks))
    tables = [(["problem", "program", "error", "Newton iterations", "seconds", "failure"], single),
              (["facets", "program", "error in per cent against Hertz' formula, mean (worst)",
                "against a fine mesh of its own theory", "its theory", "against a fine mesh, deformed bodies",
                "Newton iterations", "seconds", "failure"], means)]
    titles = "**One load**", f"**Hertz' line, {LOADS} loads that move the border through a facet**"
    text = "\n\n".join(f"{title}\n\n{study_page.markdown(table)}" for title, table in zip(titles, tables))
    return text + (f"\n\nFine meshes of {fine_line.FACETS // 2} and {fine_line.FACETS} facets over the half-width differ by "
                   f"{100 * yardsticks.apart:.2g} % at most.")


def compare(build, only, renew):
    driver = Driver(build, build / "compare", keep=True)
    driver.output.mkdir(parents=True, exist_ok=True)
    missing, drawn = set(), {}
    for name in only:
        if name == LINE:
            text, marks = line(driver, missing), MARKS
        else:
            found, drawn[name] = exact_tests.table(driver, name, missing, said)
            text, marks = study_page.markdown(found), tuple(f"<!-- {end}compare {name} -->" for end in ("", "/"))
        file = driver.output / f"compare_{name}.md"
        file.write_text(text + "\n")
        print(file.resolve())
        if renew:
            put_between(DOCUMENT, marks, f"\n\n{text}\n\n")
    if set(drawn) == set(exact_tests.TESTS):
        path = exact_tests_figure.draw(drawn, driver.output / "other_programs.png")
        print(path.resolve())
        if renew:
            shutil.copy(path, folders.FIGURES / path.name)
    for what in sorted(missing):
        print(f"left out, not installed: {what}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    names = (LINE, *exact_tests.TESTS)
    parser.add_argument("--only", nargs="+", choices=names, default=names, metavar="NAME", help=", ".join(names))
    parser.add_argument("--renew", action="store_true", help="renew tables in docs/other_programs.md, and its figure")
    arguments = parser.parse_args()
    try:
        compare(arguments.build, arguments.only, arguments.renew)
    except SceneError as problem:
        print(f"\n{problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
