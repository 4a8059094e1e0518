"""Three pressed rings of few facets against Lame's formulas: which part of the error is whose (docs/cells.md).

rings.py --build DIR [--renew]; the table is printed, and with --renew written into docs/cells.md.
"""

import argparse
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import numpy as np  # noqa: E402

from documents import put_between  # noqa: E402
from offsets import FACETS, INTERFERENCES, RADII, lame, pressures, ring_scene  # noqa: E402
from scene import Driver, write  # noqa: E402

MARKS = ("<!-- rings -->", "<!-- /rings -->")
# Nodes on a circle, over its radius: meshes are of rounding.
ON_CIRCLE = 1e-9
HEAD = ("| facets | multipliers | weights | jump over interference | circle 1 | circle 2 | spread of the pressure |", "|" + "---|" * 7)


def jump(run):
    """By how much the nodes of both sides of the first circle move apart, over the interference: where they match."""
    points, _, _ = run.mesh()
    r = np.hypot(points[:, 0], points[:, 1])
    outward = (run.point_field("displacement")[:, :2] * points[:, :2]).sum(axis=1) / r
    there = np.sort(outward[np.isclose(r, RADII[1], rtol=ON_CIRCLE)])
    inside, outside = np.split(there, 2)
    return (outside.mean() - inside.mean()) / INTERFERENCES[0]


def row(driver, facets, basis, weights, finer=1, swapped=False):
    scene = ring_scene(facets, True, basis)
    scene["output"] = {"csv": "last", "vtu": "last"}
    for name, radius in zip(("first", "second"), RADII[1:]):
        scene[name]["weights"] = weights
        if swapped:
            sides = {"nonmortar": scene[name]["mortar"], "mortar": scene[name]["nonmortar"]}
            scene[name] |= {**sides, "nonmortar_radius": -radius, "mortar_radius": radius}
    for name in ("inner", "middle", "outer"):
        scene[name]["cells"][0] *= finer
    run = driver.run(write(scene, driver.output / "rings.yaml"), label="rings")
    errors = 100 * (pressures(run) / lame() - 1)
    table = run.interface("first")
    pressure = np.hypot(table["fx"], table["fy"]) / table["area_full"]
    moved = f"{jump(run):.4f}" if len(set(facets)) == 1 else ""
    name = " / ".join(str(n) for n in facets) + (f", cells {finer} times finer along the radius" if finer > 1 else "")
    name += ", the outer ring of two is non-mortar" if swapped else ""
    return f"| {name} | {basis} | {weights} | {moved} | {errors[0]:.2f} % | {errors[1]:.2f} % | {100 * pressure.std() / pressure.mean():.1f} % |"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--renew", action="store_true")
    arguments = parser.parse_args()
    driver = Driver(arguments.build, arguments.build / "study" / "rings")
    driver.output.mkdir(parents=True, exist_ok=True)
    rows = [row(driver, [n] * 3, basis, weights) for n in (24, 40) for basis in ("standard", "dual") for weights in ("reference", "current")]
    rows += [row(driver, [m * n for n in FACETS], basis, weights) for m in (1, 2, 4) for basis in ("standard", "dual") for weights in ("reference", "current")]
    rows.append(row(driver, FACETS, "dual", "reference", finer=4))
    rows += [row(driver, FACETS, basis, "current", swapped=True) for basis in ("standard", "dual")]
    table = "\n".join([*HEAD, *rows])
    print(table)
    if arguments.renew:
        put_between(folders.ROOT / "docs" / "cells.md", MARKS, f"\n\n{table}\n\n")


if __name__ == "__main__":
    main()
