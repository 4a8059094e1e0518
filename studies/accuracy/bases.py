"""Tractions with standard and with dual multipliers: the block's along its contact zone, the ball's over the radius.

bases.py --build DIR [--renew-figures]; `make study` draws it, too. The figure goes to DIR/study/bases.png, and with
--renew-figures to docs/figures.
"""

import argparse
import shutil
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "common"))
import folders  # noqa: E402  (puts the others on the path)
import matplotlib  # noqa: E402

matplotlib.use("Agg")  # no display is needed

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from figures import BLUE, GREY, INK, RED, _save  # noqa: E402
from reference import clamped_block  # noqa: E402
from scene import Driver, SceneError  # noqa: E402
from study_problems import BALL_STEPS, QUIET, ball_pressures  # noqa: E402

BASES = ("standard", "dual")
COUNT = 2 * len(BASES)  # runs
STYLES = {"standard": {"marker": "o", "color": RED, "mfc": "none"}, "dual": {"marker": "o", "color": BLUE}}
FORCES = {"marker": "x", "color": GREY, "linestyle": "none", "markersize": 5}
# Beyond the ball's radius of contact nothing is to be seen.
SHOWN_RADII = 1.25


def solve(driver, scene, interface, *options):
    return {basis: driver.run(scene, f"-{interface}_basis", basis, *QUIET, *options, label=f"bases/{scene}_{basis}")
            for basis in BASES}


def draw_block(axes, runs):
    """Normal and tangential tractions between block and foundation, 20 x 10 elements."""
    lines = {basis: run.line("base") for basis, run in runs.items()}
    x, force = clamped_block()
    for axis, column, sign, name in zip(axes, (2, 0), (1, -1), ("normal", "tangential")):
        for basis, line in lines.items():
            axis.plot(line.x, sign * line.multiplier[:, column], **STYLES[basis], markersize=4.5, linewidth=1,
                      label=f"{basis} multiplier")
        line = lines["standard"]
        axis.plot(line.x, sign * line.traction[:, column], **FORCES, label="standard: nodal force over area")
        axis.plot(x, sign * force[:, column // 2] / line.length, "+", color=INK, markersize=11, zorder=4,
                  label="independent solver, same mesh")
        axis.set_title(f"Block: {name} traction")
        axis.set_xlabel("x along the contact")


def draw_ball(axis, runs):
    """Pressures of all nodes over their distance from the axis."""
    for basis, run in runs.items():
        r, forces, own, hertz = ball_pressures(run.interface("contact"))
        shown = r < SHOWN_RADII * hertz.contact_radius
        r, forces, own = (values[shown] / scale for values, scale in
                          ((r, hertz.contact_radius), (forces, hertz.peak), (own, hertz.peak)))
        axis.plot(r, own, **STYLES[basis], linestyle="none", markersize=4.5, label=f"{basis} multiplier")
        if basis == "standard":
            axis.plot(r, forces, **FORCES, label="standard: nodal force over area")
    fine = np.linspace(0, SHOWN_RADII, 500)
    axis.plot(fine, np.sqrt(np.maximum(1 - fine**2, 0)), color=INK, linewidth=1, zorder=0, label="Hertz")
    axis.set_title("Ball on a block: pressure")
    axis.set_xlabel("distance from the axis over the contact radius")
    axis.set_ylabel("pressure over Hertz' peak")
    axis.legend(frameon=False, fontsize=8)


def draw(driver, folder):
    """Runs the scenes and returns the figure's path."""
    block = solve(driver, "block_zone_mu05", "base")
    ball = solve(driver, "ball_on_block", "contact", *BALL_STEPS)
    figure, axes = plt.subplots(1, 3, figsize=(13.8, 4.2))
    draw_block(axes[:2], block)
    draw_ball(axes[2], ball)
    axes[0].set_ylabel("traction")
    axes[0].legend(frameon=False, fontsize=8)
    figure.tight_layout()
    return _save(figure, folder / "bases.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, required=True, help="CMake's build tree")
    parser.add_argument("--renew-figures", action="store_true", help="renew the figure in docs/figures too")
    arguments = parser.parse_args()
    output = arguments.build / "study"
    output.mkdir(parents=True, exist_ok=True)
    try:
        path = draw(Driver(arguments.build, output, keep=True), output)
    except SceneError as problem:
        print(f"\n{problem}", file=sys.stderr)
        return 1
    if arguments.renew_figures:
        shutil.copy(path, folders.FIGURES / path.name)
    print(path.resolve())
    return 0


if __name__ == "__main__":
    sys.exit(main())
