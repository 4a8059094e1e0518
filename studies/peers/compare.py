"""The same problems in other programs, on the same meshes: `make compare`. compare.py --build DIR [--renew].

Errors are of nodal contact forces, which follow from each program's displacements by the same elements; on hexahedra of 20
nodes, of the whole force. A program that
is not installed is left out with a word; one that finds no answer is shown with what it said. Seconds are wall time of
each program's own solution, with whatever linear solver it brings, and include its start: for orders of magnitude.
--renew: puts the table into docs/accuracy.md.
"""

import argparse
import re
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import formulas  # noqa: E402
import friction_checks as friction  # noqa: E402
import half_plane  # noqa: E402
import peers  # noqa: E402
import study_page  # noqa: E402
from scene import Driver, Line, SceneError  # noqa: E402

DOCUMENT = folders.ROOT / "docs" / "accuracy.md"
MARKS = ("<!-- compare -->", "<!-- /compare -->")
HERTZ_FACET = 0.136
# The others take the contact's geometry from the undeformed bodies.
SMALL = ("-contact_weights", "reference")
OURS = ("-output_vtu", "last", "-output_csv", "last", "-output_quiet", "true")


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


def hertz_error(case, displacement):
    nodes, force = contact_forces(case, displacement)
    x, first, group = np.unique(np.round(case.points[nodes, 0], 9), return_index=True, return_inverse=True)
    thickness = np.ptp(case.points[nodes, 1])
    total = np.stack([np.bincount(group, weights=force[:, i]) / thickness for i in range(3)], axis=1)
    half = np.hypot(np.diff(x), np.diff(case.points[nodes][first, 2])) / 2
    line = Line(x, total, np.append(half, 0) + np.append(0, half), np.full(len(x), "slip"))
    hertz = formulas.LineContact(total[:, 2].sum(), friction.LINE_MODULUS, friction.LINE_RADIUS)
    return friction.profile_error(line, line.traction[:, 2], hertz.pressure)


def patch(driver):
    run = driver.run("compare_patch", *OURS)
    on = lambda axis, value: lambda x: np.abs(x[:, axis] - value) < 1e-9
    supports = [(1, on(2, 0), 2, 0.0), ([0, 1], on(0, 0), 0, 0.0), ([0, 1], on(1, 0), 1, 0.0)]
    case = case_of("patch", run, 1000, 0.3, on(2, 0.5), on(2, 0.5), supports, -10.0)
    small = driver.run("compare_patch", *OURS, *SMALL, label="compare_patch_small")
    return "patch test, 3 x 3 on 4 x 5 facets", case, (run, small), patch_error


def hertz(driver):
    options = (*friction.line_mesh(HERTZ_FACET), *friction.FRICTIONLESS)
    run = driver.run("cattaneo_line", *options, *OURS, label="compare_hertz")
    points = run.mesh()[0]
    radius = lambda x, z: np.hypot(x[:, 0], x[:, 2] - z)
    foot = lambda x: (np.abs(radius(x, 8) - 8) < 1e-6) & (np.abs(x[:, 0]) < 1.2) & (x[:, 2] < 1)
    under = lambda x: (np.abs(radius(x, -8) - 8) < 1e-6) & (np.abs(x[:, 0]) < 1.6) & (x[:, 2] > -1)
    top, low = points[:, 2].max(), points[:, 2].min()
    every, at = lambda x: np.ones(len(x), bool), lambda z: lambda x: np.abs(x[:, 2] - z) < 1e-9
    supports = [([0, 1], every, 1, 0.0), (0, at(top), 2, -0.1828), (0, at(top), 0, 0.0), (1, at(low), 2, 0.0),
                (1, at(low), 0, 0.0)]
    case = case_of("hertz", run, 200, 0.3, foot, under, supports)
    small = driver.run("cattaneo_line", *options, *OURS, *SMALL, label="compare_hertz_small")
    return "Hertz, half-cylinders, 5 facets over the half-width", case, (run, small), hertz_error


CALCULIX = [
    ("CalculiX, surface to surface (penalty)", lambda case, folder: peers.calculix(case, folder, "SURFACE TO SURFACE")),
    ("CalculiX, mortar", lambda case, folder: peers.calculix(case, folder, "MORTAR")),
]
PROGRAMS = [
    *CALCULIX,
    ("GetFEM, nodes against faces, augmented Lagrangian", peers.getfem),
    ("Kratos, mortar, augmented Lagrangian", peers.kratos),
]


def rows_of(driver, title, case, ours, programs, error, missing):
    """`ours`: (name, run, its error); `error` of a program's answer. What is not installed goes to `missing`."""
    for name, run, own in ours:
        yield [title, name, f"{own:.1e}", str(run.newton_iterations), f"{run.summary['seconds']['total']:.1f}", ""]
    for name, program in programs:
        try:
            answer = program(case, driver.output / f"{case.name}_{re.sub(r'[^a-z]+', '_', name.lower())}")
        except peers.Missing as what:
            missing.add(str(what))
        except Exception as failure:  # whatever another program does
            yield [title, name, "", "", "", f"{type(failure).__name__}: {failure}".replace("\n", " ")[:110]]
        else:
            yield [title, f"{name}, {answer.version}", f"{error(answer):.1e}", str(answer.iterations),
                   f"{answer.seconds:.1f}", ""]


def linear(driver, make, missing):
    title, case, runs, error = make(driver)
    names = ("stickslip, defaults", "stickslip, small displacements")
    ours = [(name, run, error(case, run.mesh()[2])) for run, name in zip(runs, names)]
    return rows_of(driver, title, case, ours, PROGRAMS, lambda answer: error(case, answer.displacement), missing)


def quadratic(driver, missing):
    found = list(half_plane.runs(driver))
    ours = [(name, run, half_plane.force_error(run.resultant("contact")[2])) for name, run in found]
    case, parabola = half_plane.case_of(found[0][1])
    error = lambda answer: half_plane.force_error(answer.reactions[parabola, 2].sum())
    return rows_of(driver, half_plane.TITLE, case, ours, CALCULIX, error, missing)


def compare(build, renew):
    driver = Driver(build, build / "compare", keep=True)
    driver.output.mkdir(parents=True, exist_ok=True)
    body, missing = [], set()
    for row in (*linear(driver, patch, missing), *linear(driver, hertz, missing), *quadratic(driver, missing)):
        body.append(row)
        print(" | ".join(row), flush=True)
    for what in sorted(missing):
        print(f"left out, not installed: {what}")
    table = study_page.markdown((["problem", "program", "error", "Newton iterations", "seconds", "failure"], body))
    (driver.output / "compare.md").write_text(table + "\n")
    if renew:
        text = DOCUMENT.read_text()
        DOCUMENT.write_text(f"{text.split(MARKS[0])[0]}{MARKS[0]}\n\n{table}\n\n{MARKS[1]}{text.split(MARKS[1])[1]}")
    print((driver.output / "compare.md").resolve())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--renew", action="store_true", help="renew the table in docs/accuracy.md")
    arguments = parser.parse_args()
    try:
        compare(arguments.build, arguments.renew)
    except SceneError as problem:
        print(f"\n{problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
