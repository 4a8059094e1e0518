"""Nodes and points through the example driver: a part of `make border`. driver_table.py --build DIR [--renew-figures].

The scenes are those of tests/acceptance/points_scenes.py, which `border.py` has without the driver. What has been run is kept in
DIR/border/driver. --renew-figures: the tables of docs/points.md.
"""

import argparse
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import numpy as np  # noqa: E402
import points  # noqa: E402
import study_page  # noqa: E402
from documents import put_between  # noqa: E402
from points_scenes import LAWS, PULL, Corner  # noqa: E402
from scene import Driver, SceneError  # noqa: E402

DOCUMENT = folders.ROOT / "docs" / "points.md"
MARKS = ("<!-- points -->", "<!-- /points -->")
LINES, SHEARS, BALLS, CORNERS, OVER_R = (5, 10, 20, 40), (5, 10, 20), (5, 8), (10, 20, 40), (5, 10, 20)


def per_cent(errors):
    return f"{100 * np.mean(errors):.2g} ({100 * np.max(errors):.2g})"


def accuracy(driver):
    """Errors, and Newton iterations of a load."""
    reference = Corner.reference(driver)
    families = [("Hertz' line", n, points.errors(driver, "plane", n, points.LOADS, LAWS)) for n in LINES]
    families += [("Cattaneo and Mindlin: shear", n, points.errors(driver, "plane", n, points.LOADS, points.SHEARED, PULL)) for n in SHEARS]
    families += [("Corner of a block", n, points.corner_errors(driver, n, points.LOADS, reference)) for n in CORNERS]
    families += [("Ball, rectangles", n, points.errors(driver, "ball", n, points.LOADS, LAWS)) for n in BALLS]
    body = []
    for title, n, found in families:
        of = [found.get(name) for name in LAWS]
        body.append([title, str(n), *(per_cent(f[0]) if f else "-" for f in of), *(f"{f[1] / len(f[0]):.1f}" if f else "-" for f in of)])
    return ["scene", "facets", *LAWS, *(f"iterations: {name}" for name in LAWS)], body


def over_r(driver):
    body = []
    for facets in OVER_R:
        dual, found = points.errors_over_r(driver, facets)
        body.append(["Hertz' line", str(facets), per_cent(dual), *map(per_cent, found.values())])
    return ["scene", "facets", "nodes, dual", *(f"points, r x {factor:g}" for factor in found)], body


def iterations(driver):
    found = points.iterations_of_scenes(driver)
    body = [[scene, *map(str, pair)] for scene, pair in found.items()]
    total = np.sum(list(found.values()), axis=0)
    return ["scene", "nodes, dual", "points"], [*body, ["all", *map(str, total)]]


def report(build, renew):
    driver = Driver(build, build / "border" / "driver", keep=True)
    driver.output.mkdir(parents=True, exist_ok=True)
    tables = [("Errors in per cent, mean and, in brackets, worst; Newton iterations of a load", accuracy(driver)),
              ("Over r, K as it is", over_r(driver)), ("Newton iterations of the scenes without friction", iterations(driver))]
    text = "\n\n".join(f"**{title}**\n\n{study_page.markdown(table)}" for title, table in tables)
    (driver.output / "points.md").write_text(text + "\n")
    if renew:
        put_between(DOCUMENT, MARKS, f"\n\n{text}\n\n")
    print((driver.output / "points.md").resolve())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--renew-figures", action="store_true", help="renew the tables of docs/points.md")
    arguments = parser.parse_args()
    try:
        report(arguments.build, arguments.renew_figures)
    except SceneError as problem:
        print(f"\n{problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
