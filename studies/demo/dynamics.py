"""The picture of docs/dynamics.md: a block that swings in a bowl, its energy with both kinds of weights, a wheel that rolls down a slope.

Usage: dynamics.py --build DIR [--to PICTURE]; by default docs/figures/dynamics.png. Half a minute.
"""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import meshio
import numpy as np
from matplotlib.collections import PolyCollection

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "studies/common"), str(ROOT / "tests/acceptance")]
import conserving_scenes as scenes  # noqa: E402
from scene import Driver, write  # noqa: E402

# Steps that are shown, of so many: half a swing, and one turn of the wheel.
SWING, ROLL = range(0, 101, 10), (0, 160, 230, 300)
CELLS, BOWL_STEPS, SECONDS, WHEEL_STEPS, ROLLS = 8, 900, 9.0, 300, 0.6


def solved(driver, folder, name, scene):
    """The folder of a run with all of its steps."""
    path = folder / f"{name}.yaml"
    write(scene, path)
    return driver.run(path, "-output_vtu", "all", "-output_csv", "none", label=name).directory


def draw(axes, path, colour):
    """The bodies of a step, where they are."""
    mesh = meshio.read(path)
    x = (mesh.points + mesh.point_data["displacement"])[:, :2]
    for block in mesh.cells:
        if block.data.shape[1] == 4:
            axes.add_collection(PolyCollection(x[block.data], facecolors=colour, edgecolors="k", linewidths=0.2))


def bowl(axes, folder):
    angle = np.radians(np.linspace(-180, 0, 200))
    axes.plot(np.cos(angle), np.sin(angle), "k", lw=2)
    for k, step in enumerate(SWING):
        if step:
            draw(axes, folder / f"step_{step}.vtu", plt.cm.viridis(k / len(SWING)))
    axes.set(xlim=(-1.1, 1.1), ylim=(-1.1, 0.1), aspect="equal", title="a block in a bowl, every 0.1 s of half a swing")


def wheel(axes, folder):
    for k, step in enumerate(ROLL):
        if step:
            draw(axes, folder / f"step_{step}.vtu", plt.cm.viridis(k / len(ROLL)))
    axes.set(xlim=(-0.5, 1.6), ylim=(-0.25, 1.1), aspect="equal", title="a wheel on a slope (gravity is turned)")


def energy(axes, runs):
    for name, folder in runs.items():
        table = np.genfromtxt(folder / "energy.csv", delimiter=",", names=True)
        held = table["kinetic"] + table["strain"] - table["external_work"]
        axes.plot(table["t"], 100 * held / table["kinetic"].max(), label=f"weights: {name}")
    axes.set(xlabel="s", ylabel="energy gained, % of the most", title="the block's energy, nine seconds")
    axes.legend()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--to", type=Path, default=ROOT / "docs/figures/dynamics.png")
    arguments = parser.parse_args()
    folder = arguments.build / "dynamics"
    folder.mkdir(parents=True, exist_ok=True)
    driver = Driver(arguments.build, folder)
    runs = {
        weights: solved(driver, folder, f"bowl_{weights}", scenes.bowl(CELLS, steps=BOWL_STEPS, end=SECONDS, weights=weights))
        for weights in ("conserving", "current")
    }
    rolled = solved(driver, folder, "wheel", scenes.wheel(CELLS, steps=WHEEL_STEPS, end=ROLLS))
    figure, axes = plt.subplots(1, 3, figsize=(15, 4.2), layout="constrained")
    bowl(axes[0], runs["conserving"])
    energy(axes[1], runs)
    wheel(axes[2], rolled)
    figure.savefig(arguments.to, dpi=110)
    print(f"drawn: {arguments.to}")


if __name__ == "__main__":
    main()
